//! Memory: what flights ask for at once, what this process has, and what the machine has left for it.
//!
//! What is held at once is known before a flight begins: its samples on every thread, and what is kept beside them. What grows
//! with the work, such as the boxes of a proof, is not; for that the process is looked at while it works
//! ([`resident_bytes`]).

use std::fmt;
use std::fs;

use fspid_diagnostics::digits::{counted, grouped};
use fspid_sim::{Plant, Scenario};

/// Bytes that a sample of a flight takes on each thread that flies: eight lanes of a batch in rows of floats. Measured as 293
/// in campaigns and 304 in tunings (`checks/memory`).
const BYTES_OF_SAMPLE: u64 = 320;
/// Bytes that a candidate of a generation takes, with its flights' answers.
const BYTES_OF_CANDIDATE: u64 = 1024;
/// Bytes of a row of a shard until it is written, one controller's measures of a run, in columns and as a file. Measured as
/// 1400 to 2000.
const BYTES_OF_ROW: u64 = 2048;
/// Bytes of a case for each controller: its scenario, read and checked. Measured as 109 000 to 117 000 in five contests.
const BYTES_OF_CASE: u64 = 120_000;
/// Bytes that a sample of a trace takes for each controller, kept and judged, and more where it is written, as text or in a
/// report. Measured as 73 and 112.
const BYTES_OF_TRACE: [u64; 2] = [88, 120];
/// The same of an aircraft with all that it shows. Measured as 257 and 340.
const BYTES_OF_AIRCRAFT_TRACE: [u64; 2] = [280, 360];
/// Bytes that the program takes by itself.
const BYTES_OF_PROGRAM: u64 = 24 * MIB;
/// Flights that a thread flies side by side.
const LANES: u64 = 8;
/// 2²⁰ bytes.
pub const MIB: u64 = 1024 * 1024;

/// What flights hold at once.
#[derive(Clone, Copy, Debug)]
pub struct Needed {
    samples: u64,
    threads: u64,
    /// Of each sample on each thread.
    of_sample: u64,
    /// Beside the samples.
    beside: u64,
}

impl Needed {
    /// Flights that are judged and forgotten, side by side on each thread.
    #[must_use]
    pub fn for_flights(samples: usize, threads: usize) -> Self {
        let (samples, threads) = (samples as u64, threads.max(1) as u64);
        Self { samples, threads, of_sample: BYTES_OF_SAMPLE, beside: 0 }
    }

    /// The same where there are no more than so many flights, so that some threads have none.
    #[must_use]
    pub fn of_at_most(self, flights: u64) -> Self {
        Self { threads: self.threads.min(flights.div_ceil(LANES)).max(1), ..self }
    }

    /// The flights of a scenario, one after the other, whose traces are kept and perhaps written.
    #[must_use]
    pub fn for_traces(scenario: &Scenario, is_written: bool) -> Self {
        let [kept, written] = match scenario.plant {
            Plant::Linear(_) => BYTES_OF_TRACE,
            Plant::Aircraft(_) | Plant::External(_) => BYTES_OF_AIRCRAFT_TRACE,
        };
        let controllers = scenario.flyers().count() as u64;
        let of_sample = (kept + if is_written { written } else { 0 }) * controllers;
        Self { samples: scenario.timing.rows() as u64, threads: 1, of_sample, beside: 0 }
    }

    /// And what others need that fly before or after: the longer flights, and everything that is kept.
    #[must_use]
    pub fn and(self, others: Self) -> Self {
        Self { samples: self.samples.max(others.samples), ..self.with(others.beside) }
    }

    /// And cases that are read for flights.
    #[must_use]
    pub fn with_cases(self, cases: usize) -> Self {
        self.with(BYTES_OF_CASE.saturating_mul(cases as u64))
    }

    /// And candidates that are kept with their flights' answers.
    #[must_use]
    pub fn with_candidates(self, candidates: u64) -> Self {
        self.with(candidates.saturating_mul(BYTES_OF_CANDIDATE))
    }

    /// And rows that are kept until they are written: one for each controller of a run.
    #[must_use]
    pub fn with_rows(self, rows: u64) -> Self {
        self.with(rows.saturating_mul(BYTES_OF_ROW))
    }

    /// And the program that flies them.
    #[must_use]
    pub fn with_program(self) -> Self {
        self.with(BYTES_OF_PROGRAM)
    }

    fn with(self, bytes: u64) -> Self {
        Self { beside: self.beside.saturating_add(bytes), ..self }
    }

    /// All of it.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let Self { samples, threads, of_sample, beside } = self;
        samples.saturating_mul(*threads).saturating_mul(*of_sample).saturating_add(*beside)
    }
}

/// What is asked for, in words.
impl fmt::Display for Needed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let threads = counted(usize::try_from(self.threads).unwrap_or(usize::MAX), "thread");
        write!(
            f,
            "flights of {} samples on {threads}, with what is held beside them, would take some {} of memory",
            grouped(self.samples),
            mebibytes(self.bytes())
        )
    }
}

/// Bytes as people are told, such as `1 024 MiB`, never less than there are.
#[must_use]
pub fn mebibytes(bytes: u64) -> String {
    format!("{} MiB", grouped(bytes.div_ceil(MIB)))
}

/// Memory that the process has now; none where the system does not tell it so.
#[must_use]
pub fn resident_bytes() -> Option<u64> {
    told_by("/proc/self/status", "VmRSS:")
}

/// Memory that the machine, or the group of processes that this one belongs to, can still give; none where the system does
/// not tell it so.
#[must_use]
pub fn available_bytes() -> Option<u64> {
    let of_machine = told_by("/proc/meminfo", "MemAvailable:")?;
    Some(of_group().map_or(of_machine, |bytes| bytes.min(of_machine)))
}

/// What the outermost group of a container has left (control groups, version 2).
fn of_group() -> Option<u64> {
    let number = |name: &str| {
        let text = fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?;
        text.trim().parse::<u64>().ok()
    };
    // The maximum is the word `max` where there is none.
    Some(number("memory.max")?.saturating_sub(number("memory.current")?))
}

/// A number of kibibytes that the system writes behind a word of a file.
fn told_by(file: &str, word: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(word))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn the_memory_of_the_process_grows_by_what_it_takes() {
        let before = resident_bytes().expect("Linux tells");
        let taken = vec![1_u8; 256 << 20];
        let after = resident_bytes().expect("Linux tells");
        assert_eq!(taken.iter().map(|byte| u64::from(*byte)).sum::<u64>(), 256 << 20);
        assert!(after > before + (200 << 20), "{before} {after}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_machine_has_some_memory_left() {
        assert!(available_bytes().expect("Linux tells") > MIB);
    }

    #[test]
    fn flights_take_their_samples_on_each_thread_that_has_some() {
        let flights = Needed::for_flights(1000, 16);
        assert_eq!(flights.bytes(), 1000 * 16 * 320);
        assert_eq!(flights.of_at_most(17).bytes(), 1000 * 3 * 320);
        assert_eq!(flights.of_at_most(0).bytes(), 1000 * 320);
        assert_eq!(flights.of_at_most(u64::MAX).bytes(), flights.bytes());
        let shorter = Needed::for_flights(10, 16).with_cases(7);
        assert_eq!(flights.with_cases(2).and(shorter).bytes(), 1000 * 16 * 320 + 9 * 120_000);
        assert_eq!(
            Needed::for_flights(0, 0).with_rows(3).with_candidates(5).bytes(),
            3 * 2048 + 5 * 1024
        );
        assert_eq!(Needed::for_flights(usize::MAX, 1024).with_program().bytes(), u64::MAX);
    }

    #[test]
    fn what_is_needed_is_told_in_mebibytes() {
        let told = Needed::for_flights(10_000_001, 2).to_string();
        assert_eq!(
            told,
            "flights of 10 000 001 samples on 2 threads, with what is held beside them, would take some 6 104 MiB of memory"
        );
    }
}
