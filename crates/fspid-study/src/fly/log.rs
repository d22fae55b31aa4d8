//! What is told to people, bounded, and what is counted.

use std::fmt;

use fspid_core::Faults;

/// Most lines about which something is told; all together stay below the 4 KiB that every pipe
/// holds, so that a client that never reads them is not stopped.
const MOST_TOLD: u64 = 16;

/// Most bytes of why a controller was lost: one that cannot be started says why at any length.
const MOST_OF_A_LOSS: usize = 200;

/// What happened on a line, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Samples that were answered.
    pub commands: u64,
    /// Of these, those whose `dt_s` was not the controller's period.
    pub slips: u64,
    /// Of these, those that could not be used: the command was held.
    pub held: u64,
    /// Of these, those at which the controller met another fault.
    pub faults: u64,
    /// Flights in which the controller, a program, was lost.
    pub lost: u64,
    /// New starts.
    pub resets: u64,
}

impl Summary {
    /// True if every sample came in time and could be used.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.slips + self.held + self.faults + self.lost == 0
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { commands, slips, held, faults, lost, resets } = self;
        write!(f, "commands {commands}, slips {slips}, held {held}, other faults {faults}")?;
        if *lost > 0 {
            write!(f, ", controller lost {lost}")?;
        }
        write!(f, ", resets {resets}")
    }
}

/// Notes by line, and the summary.
#[derive(Clone, Debug, Default)]
pub(super) struct Log {
    pub(super) summary: Summary,
    line: u64,
    told: u64,
    rate_is_told: bool,
    notes: Vec<String>,
}

impl Log {
    /// Everything that follows is about the next line.
    pub(super) fn next_line(&mut self) {
        self.line += 1;
    }

    /// Notes since the last call.
    pub(super) fn take(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    pub(super) fn slip(&mut self, dt_s: f64, period_s: f64) {
        self.summary.slips += 1;
        if self.summary.slips == 1 {
            let counted = "this and what follows is counted, and computed with that period";
            self.note(&format!("dt_s is {dt_s:?} and the period {period_s:?}; {counted}"));
        }
    }

    pub(super) fn held(&mut self, reason: &str) {
        self.summary.held += 1;
        self.tell(&format!("{reason}; the command was held"));
    }

    /// The first is told whatever was told before it.
    pub(super) fn lost(&mut self, what: &str) {
        const HOW: &str = "its last command is held until a reset starts it anew";
        let ends = (0..=MOST_OF_A_LOSS).rev().find(|at| what.is_char_boundary(*at));
        let text = ends.and_then(|at| what.get(..at)).unwrap_or(what);
        self.summary.lost += 1;
        match self.summary.lost {
            1 => self.note(&format!("{text}; {HOW}")),
            _ => self.tell(text),
        }
    }

    pub(super) fn fault(&mut self, fault: Faults) {
        self.summary.faults += 1;
        self.tell(&fault.to_string());
    }

    /// Told once; what a program does with a rate is not known.
    pub(super) fn estimated_rate(&mut self, time_constant_s: f64, is_external: bool) {
        if !self.rate_is_told {
            let how = format!("a filter of {time_constant_s:?} s estimates it");
            let needs = if is_external { "may need" } else { "needs" };
            self.note(&format!("no pitch rate, which this controller {needs}; {how}"));
        }
        self.rate_is_told = true;
    }

    fn tell(&mut self, text: &str) {
        self.told += 1;
        if self.told <= MOST_TOLD {
            self.note(text);
        }
        if self.told == MOST_TOLD {
            self.note("what else is wrong is counted and no longer told");
        }
    }

    fn note(&mut self, text: &str) {
        self.notes.push(format!("line {}: {text}", self.line));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_happens_what_is_told_fits_into_the_smallest_pipe() {
        let mut log = Log { line: u64::MAX - 2000, ..Log::default() };
        let longest = format!("`{}…` is not a number", "\u{10ffff}".repeat(40));
        for _ in 0..1000 {
            log.next_line();
            log.slip(-f64::MAX, f64::MIN_POSITIVE);
            log.estimated_rate(f64::MIN_POSITIVE, true);
            log.held(&longest);
            log.fault(Faults::OUT_OF_RANGE);
            log.lost(&"\u{10ffff}".repeat(9999));
        }
        let told = log.take();
        // The period, the rate and the first loss beside those that are counted, and that no more are told.
        assert_eq!(told.len(), 3 + 16 + 1);
        assert!(told.iter().map(|note| note.len() + 1).sum::<usize>() < 4000);
        assert_eq!(log.summary.held + log.summary.faults, 2000);
        assert!(log.take().is_empty());
    }
}
