//! Work limits for the propagation of reachable sets, shared by search and re-check.

use std::num::NonZero;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use super::flights::{Beginning, Landed, Ready, Set, Way};
use super::joined::Joined;
use super::remembers;
use super::sample::{Flight, Stop};
use super::terminal::Terminal;
use crate::certificate::{Certificate, Claim};
use crate::description::LoopDescription;
use crate::gain_set::GainSet;

/// Longest flight of a set, s, and in samples.
const LONGEST_S: f64 = 400.0;
pub(super) const MOST_SAMPLES: usize = 40_000;
/// Most work of a re-check, in samples of gains that stand still, and how many of these one of gains that move takes: some
/// seconds. A search may take so many times as much.
const MOST_CHECKED: usize = 280_000;
const MOVING: usize = 6;
/// The same where they remember: some dozens of sets of half a minute, each of them flown with hundreds of unknowns.
const MOST_CHECKED_REMEMBERED: usize = 16 * MOST_CHECKED;
const SEARCHED: usize = 6;

/// Sets of flights of a loop with its forms near rest.
#[derive(Clone)]
pub(super) struct Flights<'a> {
    ready: Ready<'a>,
    longest: usize,
    /// Work of a sample.
    each: usize,
    /// Work so far, and the most.
    pub(super) flown: usize,
    pub(super) most: usize,
    /// None of several jobs side by side may take much more than its share.
    pub(super) paced: bool,
    pub(super) stops: fn() -> bool,
    /// Nobody waits for them any more.
    pub(super) halted: Arc<AtomicBool>,
    /// As many as that may fly side by side.
    pub(super) threads: usize,
}

impl<'a> Flights<'a> {
    /// For a check.
    pub(super) fn of(
        certificate: &'a Certificate,
        model: &LoopModel<Interval>,
        set: &GainSet,
        terminal: &Terminal,
        system: Option<&'a System>,
    ) -> Option<Self> {
        let description = &certificate.description;
        let forms = [terminal, &common(certificate, terminal)];
        let ready = Ready::of(description, model, set, forms, system).ok()??;
        let dt_s = description.controller.config().dt_s;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let longest = ((LONGEST_S / dt_s) as usize).min(MOST_SAMPLES);
        let (flown, most) = (0, most_checked(description));
        let each = match &description.controller {
            Controller::Fixed(_) => 1,
            Controller::SelfTuning(_) => MOVING,
        };
        let stops = crate::solve::never;
        let halted = Arc::new(AtomicBool::new(false));
        let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
        let paced = false;
        Some(Self { ready, longest, each, flown, most, paced, stops, halted, threads })
    }

    /// The same on another thread, which is told when to stop by `halted` alone.
    pub(super) fn another(&self) -> Self {
        Self { stops: crate::solve::never, ..self.clone() }
    }

    /// For a search, which may take a part of all that searches may.
    pub(super) fn searching(self, part: f64, stops: fn() -> bool) -> Self {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "below the most"
        )]
        let most = (part * (SEARCHED * self.most) as f64) as usize;
        Self { most, stops, paced: true, ..self }
    }

    /// Of gains that remember, how long a rest has to last, s.
    pub(super) fn rests_s(&self) -> Option<f64> {
        self.ready.rests_s()
    }

    /// At rest, before anything is commanded.
    pub(super) fn begun(&mut self, from: Beginning) -> Flight {
        self.ready.begun(from)
    }

    /// Forgets what gains of other sets were, so that a check has the numbers of the search.
    pub(super) fn forget(&mut self) {
        self.ready.forget();
    }

    /// Flies on from a sample to another.
    pub(super) fn until(
        &mut self,
        way: &Way<'_>,
        flight: Flight,
        [from, to]: [usize; 2],
    ) -> Result<Flight, Stop> {
        let left = self.left()?;
        if to.saturating_sub(from) > left {
            return Err(Stop::Work);
        }
        let flown = self.ready.until(way, flight, from..to);
        self.flown +=
            flown.as_ref().map_or_else(|(_, samples)| *samples, |_| to - from) * self.each;
        flown.map_err(|(stop, _)| stop)
    }

    /// Flies on from a sample to where it has landed.
    pub(super) fn landed(
        &mut self,
        way: &Way<'_>,
        flight: Flight,
        from: usize,
    ) -> Result<Landed, Stop> {
        let left = self.left()?;
        // Before the last change nothing has landed.
        if way.commands.last_change().saturating_sub(from) > left {
            return Err(Stop::Work);
        }
        let most = from.max(way.commands.last_change()).saturating_add(self.longest);
        let most = most.min(from.saturating_add(left));
        let landed = self.ready.landed(way, flight, from..most);
        self.flown +=
            landed.as_ref().map_or_else(|(_, samples)| *samples, |it| it.flown) * self.each;
        landed.map_err(|(stop, _)| stop)
    }

    /// What sets at the same sample have come to, as one.
    pub(super) fn joined(&self, sets: &[&Set]) -> Option<Joined> {
        self.ready.joined(sets)
    }

    /// How far the pitch angles of a set are apart, beside what set-point and load make of them, rad.
    pub(super) fn apart_rad(&self, flight: &Flight) -> f64 {
        self.ready.apart_rad(flight)
    }

    /// The gains of a set, each as a share of what it can reach.
    pub(super) fn gains_of_reach(&self, flight: &Flight) -> [Interval; 3] {
        self.ready.gains_of_reach(flight)
    }

    /// True where who asked does not wait any more.
    pub(super) fn is_stopped(&self) -> bool {
        self.halted.load(Ordering::Relaxed) || (self.stops)()
    }

    /// Samples that may still be flown: one flight may go beyond the most work by its own length, and no further.
    fn left(&self) -> Result<usize, Stop> {
        if self.is_stopped() {
            return Err(Stop::Lost);
        }
        if self.flown > self.most {
            return Err(Stop::Work);
        }
        Ok(((self.most - self.flown) / self.each).max(self.longest))
    }
}

impl Landed {
    /// The later, and whatever acted in one of them.
    pub(super) fn worse(self, other: Self) -> Self {
        Self {
            flown: self.flown + other.flown,
            samples: self.samples.max(other.samples),
            limited: self.limited || other.limited,
        }
    }
}

/// Most work of a re-check.
pub(super) fn most_checked(description: &LoopDescription) -> usize {
    if remembers(description) { MOST_CHECKED_REMEMBERED } else { MOST_CHECKED }
}

/// A form that falls for all gains, for the ball around what is told apart: that of the claim, where it is one for all gains
/// and has a rate. Gains that stand still are those near rest.
fn common(certificate: &Certificate, terminal: &Terminal) -> Terminal {
    match (&certificate.claim, &certificate.description.controller) {
        (Claim::CommonQuadratic { form, rate }, Controller::SelfTuning(_)) if *rate < 1.0 => {
            Terminal { form: form.clone(), rate: *rate, ..terminal.clone() }
        }
        _ => terminal.clone(),
    }
}

#[cfg(test)]
mod tests;
