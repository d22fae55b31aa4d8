//! Reachable sets of a step of the set-point or load from equilibrium, at any time.

use super::commands::Commands;
use super::crew::side_by_side;
use super::flights::{Beginning, Landed, Patch, Way};
use super::sample::Stop;
use super::sweep::Sweep;
use super::terminal::Terminal;
use super::work::{Flights, most_checked};
use super::{Checked, Search, given_up, is_odd, remembers, sees_loads_at_once};
use crate::caps::MOST_PIECES;
use crate::certificate::Certificate;
use crate::scope::Range;

/// Where a search begins: with a box of such a share of the set-points.
const BEGINS: f64 = 0.25;
/// The narrowest box that is flown, as a share of the set-points that are asked for.
const NARROWEST: f64 = 1.0 / 2048.0;

/// Steps from rest that end at their set-point, limits acting on the way.
///
/// From rest at the trim without a load, a step of the set-point by up to `setpoint_rad` and at the same sample one of a load
/// at the elevator by up to `load_rad`, either way, both of which then stay. Gains that remember begin at the nominal ones, or
/// at those that a long rest has brought them to, from wherever they were ([`Stepped::rested_s`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    /// Largest step, rad.
    pub setpoint_rad: f64,
    /// Largest load, rad of elevator.
    pub load_rad: f64,
    /// Near rest.
    pub terminal: Terminal,
    /// Where boxes end along the set-points, rad; from the first to the last.
    pub ends: Vec<f64>,
    /// Parts that the loads are flown in.
    pub loads: usize,
}

/// Proved result for steps from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stepped {
    /// Largest step, rad.
    pub setpoint_rad: f64,
    /// Largest load, rad of elevator.
    pub load_rad: f64,
    /// Sets of flights.
    pub sets: usize,
    /// No limit acts any more after so long, s.
    pub settled_s: f64,
    /// In some flight a limit may act.
    pub limited: bool,
    /// Of gains that remember, how long a rest has to last before a step that is not at the controller's first sample, s: they
    /// are then at those of rest, but for a thousandth of the way.
    pub rested_s: Option<f64>,
}

/// Boxes of set-points, each flown with all loads.
struct Boxes<'a> {
    flights: Flights<'a>,
    /// Where steps begin.
    beginnings: &'static [Beginning],
    load_rad: f64,
    loads: usize,
}

impl Boxes<'_> {
    /// Flies all loads of pieces of set-points, the first sample being the controller's own or not.
    fn pieces(&mut self, setpoints: impl IntoIterator<Item = [f64; 2]>) -> Result<Landed, Stop> {
        let Self { flights, beginnings, load_rad, loads } = self;
        let at = |part: usize| *load_rad * (2.0 * part as f64 / *loads as f64 - 1.0);
        let loads = (0..*loads).map(|part| [at(part), at(part + 1)]);
        let patches = setpoints
            .into_iter()
            .flat_map(|setpoint| loads.clone().map(move |load| Patch { setpoint, load }));
        let sets: Vec<(Patch, Beginning)> =
            patches.flat_map(|patch| beginnings.iter().map(move |from| (patch, *from))).collect();
        let commands = Commands::step();
        let landed = side_by_side(flights, &sets, |flights, &(patch, from)| {
            let way = Way { commands: &commands, patch, from };
            let begun = flights.begun(from);
            flights.landed(&way, begun, 0)
        })?;
        Ok(landed.into_iter().fold(Landed::default(), Landed::worse))
    }

    /// Boxes from zero outwards to one side, as far as they are flown within the work of a re-check.
    fn side(&mut self, to: f64, allowed: usize) -> Vec<f64> {
        let mut ends = vec![0.0];
        let (mut sweep, mut of_check) = (Sweep::over([0.0, to], BEGINS), 0);
        while !sweep.is_over() && ends.len() < MOST_PIECES / 2 {
            let [from, next] = sweep.piece();
            let before = self.flights.flown;
            if self.pieces([[from.min(next), from.max(next)]]).is_ok() {
                of_check += self.flights.flown - before;
                if of_check > allowed {
                    break;
                }
                ends.push(sweep.flown());
            } else if sweep.given_up() < NARROWEST * to.abs()
                || self.flights.flown > self.flights.most
            {
                break;
            }
        }
        ends
    }
}

/// Where steps are flown from: a controller that remembers nothing does not know its first sample.
fn beginnings(certificate: &Certificate) -> &'static [Beginning] {
    let remembers = certificate.description.settings().memory.previous;
    let both = &[Beginning::Rest, Beginning::Controller];
    if remembers { both } else { &both[..1] }
}

impl Search<'_> {
    /// The largest steps of a proved loop, up to those of its range, that are found to end at their set-point.
    pub(crate) fn steps(&self) -> Option<Steps> {
        let Self { certificate, model, set, terminal, system, stops } = self;
        let description = &certificate.description;
        let Range { setpoint_rad, load_rad } = certificate.range;
        // Sets of both are as many as those of one times those of the other; gains that remember need narrow ones.
        let load_rad = if remembers(description) { 0.0 } else { load_rad };
        if !(setpoint_rad > 0.0) || sees_loads_at_once(model, load_rad) {
            return None;
        }
        let flights = Flights::of(certificate, model, set, terminal, system.as_ref())?;
        let flights = flights.searching(0.5, *stops);
        let loads = if load_rad > 0.0 { 2 } else { 1 };
        let odd = is_odd(description);
        let most_checked = most_checked(description);
        let allowed = if odd { most_checked } else { most_checked / 2 };
        let mut boxes = Boxes { flights, beginnings: beginnings(certificate), load_rad, loads };
        let up = boxes.side(setpoint_rad, allowed);
        let reached = up.last().copied().unwrap_or(0.0);
        boxes.flights.most += boxes.flights.flown;
        let down = match odd {
            true => vec![0.0],
            false => boxes.side(-reached, allowed),
        };
        let most = match odd {
            true => reached,
            false => reached.min(-down.last().copied().unwrap_or(0.0)),
        };
        if !(most > 0.0) || stops() {
            return None;
        }
        let below = down.into_iter().rev().map(|end| end.max(-most));
        let mut ends: Vec<f64> =
            below.chain(up.into_iter().skip(1).map(|end| end.min(most))).collect();
        ends.dedup_by(|one, other| one.to_bits() == other.to_bits());
        Some(Steps { setpoint_rad: most, load_rad, terminal: terminal.clone(), ends, loads })
    }
}

impl Steps {
    /// Proves the claim anew.
    pub(crate) fn proved(&self, checked: Checked<'_>) -> Result<Stepped, &'static str> {
        let Checked { certificate, model, set, stops } = checked;
        checked.allowed(self.load_rad)?;
        self.fits(certificate)?;
        let system = super::system(&certificate.description);
        let mut flights = Flights::of(certificate, model, set, &self.terminal, system.as_ref())
            .ok_or("steps: the loop near rest is not enclosed")?;
        flights.stops = stops;
        let rested_s = flights.rests_s();
        let (load_rad, loads) = (self.load_rad, self.loads);
        let mut boxes = Boxes { flights, beginnings: beginnings(certificate), load_rad, loads };
        let setpoints = self.ends.windows(2).map(|pair| [pair[0], pair[1]]);
        let worst = boxes.pieces(setpoints).map_err(given_up)?;
        Ok(Stepped {
            setpoint_rad: self.setpoint_rad,
            load_rad: self.load_rad,
            sets: self.loads * (self.ends.len() - 1),
            settled_s: worst.samples as f64 * certificate.description.controller.config().dt_s,
            limited: worst.limited,
            rested_s,
        })
    }

    /// Whether the boxes fill the steps, and the steps lie in the range that the claim near rest is made for.
    fn fits(&self, certificate: &Certificate) -> Result<(), &'static str> {
        let range = Range { setpoint_rad: self.setpoint_rad, load_rad: self.load_rad };
        if !range.is_allowed() || !certificate.range.covers(range) {
            return Err("steps: beyond the range of the claim");
        }
        let rising = self.ends.windows(2).all(|pair| pair[0] < pair[1]);
        let first = if is_odd(&certificate.description) { 0.0 } else { -self.setpoint_rad };
        let filled = self.ends.first().is_some_and(|end| *end <= first)
            && self.ends.last().is_some_and(|end| *end >= self.setpoint_rad);
        if !rising || !filled {
            return Err("steps: the boxes do not fill the steps");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::steps::tests::allowed::{Found, jumping, limited, uneven};

    const SMALL: Range = Range { setpoint_rad: 0.01, load_rad: 0.001 };

    fn boxes(found: &Found, load_rad: f64, loads: usize) -> Boxes<'_> {
        Boxes { flights: found.flights(), beginnings: &[Beginning::Rest], load_rad, loads }
    }

    /// Whether a small step is flown with all loads up to one, in two parts.
    fn flies(found: &Found, load_rad: f64) -> bool {
        boxes(found, load_rad, 2).pieces([[0.0, 1e-3]]).is_ok()
    }

    #[test]
    fn loads_are_flown_from_the_largest_one_way_to_the_largest_the_other_way() {
        // A servo that holds 0.25 rad one way and 0.35 the other: loads beyond are not flown, whichever way it is.
        for mirrored in [false, true] {
            let found = Found::of(uneven(mirrored), SMALL);
            assert!(flies(&found, 0.2) && !flies(&found, 0.28), "{mirrored}");
        }
    }

    fn steps(found: &Found, ends: &[f64]) -> Steps {
        let terminal = found.search().terminal.clone();
        Steps { setpoint_rad: 0.01, load_rad: 0.001, terminal, ends: ends.to_vec(), loads: 2 }
    }

    #[test]
    fn boxes_fill_both_sides_but_where_one_stands_for_both() {
        let found = Found::of(uneven(false), SMALL);
        let fits = |ends: &[f64]| steps(&found, ends).fits(&found.certificate);
        for good in [&[-0.01, 0.01][..], &[-0.01, 0.0, 0.01], &[-0.02, 0.004, 0.02]] {
            assert_eq!(fits(good), Ok(()), "{good:?}");
        }
        let one_side: [&[f64]; 3] = [&[0.0, 0.01], &[0.01, 0.02], &[-0.01, 0.0]];
        let ragged: [&[f64]; 4] =
            [&[-0.01, 0.0, 0.0, 0.01], &[-0.01, 0.02, 0.01], &[-0.009, 0.01], &[-0.01, f64::NAN]];
        for bad in one_side.into_iter().chain(ragged) {
            assert_eq!(fits(bad), Err("steps: the boxes do not fill the steps"), "{bad:?}");
        }
        let odd = Found::of(limited(), SMALL);
        assert_eq!(steps(&odd, &[0.0, 0.01]).fits(&odd.certificate), Ok(()));
        assert!(steps(&odd, &[0.001, 0.01]).fits(&odd.certificate).is_err());
    }

    #[test]
    fn steps_are_found_and_proved_with_a_box_for_each_side_that_is_its_own() {
        for (description, least) in [(uneven(false), -0.01), (limited(), 0.0)] {
            let found = Found::of(description, SMALL);
            let steps = found.search().steps().expect("found");
            let [first, last] = [steps.ends[0], steps.ends[steps.ends.len() - 1]];
            assert!((first - least).abs() <= 0.0 && (last - 0.01).abs() <= 0.0, "{:?}", steps.ends);
            assert_eq!(steps.loads, 2);
            let proved = steps.proved(found.checked()).expect("proved");
            assert_eq!(proved.sets, 2 * (steps.ends.len() - 1));
            // Seconds, and not samples: a set is near its rest after eight of them at the earliest.
            assert!(proved.settled_s >= 0.16 && proved.settled_s < 1.0, "{proved:?}");
        }
        let unloaded = Found::of(limited(), Range { load_rad: 0.0, ..SMALL });
        assert_eq!(unloaded.search().steps().expect("found").loads, 1);
    }

    #[test]
    fn no_step_is_found_where_none_is_flown_or_a_load_is_seen_at_once() {
        let mut found = Found::of(uneven(false), SMALL);
        found.certificate.range = Range { load_rad: 0.28, ..SMALL };
        assert_eq!(found.search().steps(), None);
        let found = Found::of(jumping(), SMALL);
        assert_eq!(found.search().steps(), None);
    }

    #[test]
    fn a_side_is_flown_outwards_within_the_work_of_a_check() {
        let found = Found::of(limited(), SMALL);
        let all = boxes(&found, 0.001, 1).side(0.01, usize::MAX);
        assert!(all.len() > 3 && (all[all.len() - 1] - 0.01).abs() <= 0.0, "{all:?}");
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]), "{all:?}");
        let mut each = boxes(&found, 0.001, 1);
        let work = all.windows(2).take(2).map(|pair| {
            let before = each.flights.flown;
            each.pieces([[pair[0], pair[1]]]).expect("flown");
            each.flights.flown - before
        });
        let work: Vec<usize> = work.collect();
        let within = |allowed: usize| boxes(&found, 0.001, 1).side(0.01, allowed).len() - 1;
        let of_counts = [work[0] - 1, work[0], work[0] + work[1] - 1, work[0] + work[1]];
        assert_eq!(of_counts.map(within), [0, 1, 1, 2]);
    }

    #[test]
    fn a_box_that_is_not_flown_is_halved_down_to_the_narrowest() {
        let found = Found::of(uneven(false), SMALL);
        let mut search = boxes(&found, 0.28, 1);
        assert_eq!(search.side(0.01, usize::MAX).len(), 1);
        let mut each = boxes(&found, 0.28, 1);
        // From a quarter to twice the narrowest, each half as wide as the one before.
        for halves in 0..10 {
            let width = 0.01 * BEGINS / f64::from(1 << halves);
            assert!(each.pieces([[0.0, width]]).is_err());
        }
        assert_eq!(search.flights.flown, each.flights.flown);
    }
}
