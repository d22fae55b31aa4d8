//! What a job may take in memory: estimated before it begins, measured while it works.
//!
//! A job is a thread of this process, so that the system bounds none of them by itself. What is asked for at once, the flights
//! in the air, is known beforehand; what grows, such as the candidates of a search, is measured. Memory that was given back
//! may stay with the process: a job is charged with what the process has grown by since it began.

use std::fs;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use fspid_diagnostics::digits::grouped;
use fspid_scenario::file::Study;

use super::asked::Work;
use super::job::Job;
use super::task::Ended;

/// Bytes that a sample of a flight takes on each thread that flies: eight lanes of a batch in rows of floats. Measured as 293
/// in campaigns and 304 in tunings.
const BYTES_OF_SAMPLE: u64 = 320;
/// Bytes that a candidate of a generation takes, with its flights' answers.
const BYTES_OF_CANDIDATE: u64 = 1024;
/// Bytes of a run and controller of a shard until it is written: 100 measures and more, in columns and as a file.
const BYTES_OF_RUN: u64 = 4096;
/// How often the memory of the process is looked at.
const TICK: Duration = Duration::from_millis(50);
const MIB: u64 = 1024 * 1024;

/// Refuses a job whose flights alone take more than it may have at once.
pub(super) fn check(work: &Work, study: &Study, most: u64) -> Result<(), Ended> {
    let samples = study.scenario.timing.rows() as u64;
    let threads = rayon::current_num_threads() as u64;
    let needed = needed(work, samples, threads);
    if needed <= most {
        return Ok(());
    }
    Err(Ended::failed(format_args!(
        "flights of {} samples on {threads} threads, with what is held beside them, would take some {} MiB of memory; a job may take {} MiB here, the command line has no limit: a shorter flight, a longer sample period or a smaller population takes less",
        grouped(samples),
        grouped(needed.div_ceil(MIB)),
        grouped(most / MIB)
    )))
}

/// Bytes that are held at once, whatever else grows. A proof flies nothing, and asks for no more than its states.
fn needed(work: &Work, samples: u64, threads: u64) -> u64 {
    let flights = samples.saturating_mul(threads).saturating_mul(BYTES_OF_SAMPLE);
    match work {
        Work::Certify(_) => 0,
        Work::Contest(_) => flights,
        Work::Tune(tune) => {
            flights.saturating_add(tune.population().saturating_mul(BYTES_OF_CANDIDATE))
        }
        Work::Campaign(campaign) => {
            flights.saturating_add(campaign.runs_of_shard().saturating_mul(BYTES_OF_RUN))
        }
    }
}

/// Why a job was ended whose memory has grown so far.
pub(super) fn too_large(most: u64) -> Ended {
    Ended::failed(format_args!(
        "the server's memory has grown by more than {} MiB while this job worked, which is all that a job may take here; the command line has no limit. What other jobs took meanwhile counts too",
        grouped(most / MIB)
    ))
}

/// Works, and has the job stopped once the process has grown by more than it may.
pub(super) fn watched<T>(job: &Job, most: u64, work: impl FnOnce() -> T) -> T {
    // Where the system does not tell, the estimate is all there is.
    let Some(before) = resident_bytes() else { return work() };
    let has_grown = || resident_bytes().is_some_and(|now| now.saturating_sub(before) > most);
    thread::scope(|scope| {
        // Dropped when the work ends, in whatever way.
        let (work_goes_on, ended) = mpsc::channel::<()>();
        scope.spawn(move || {
            while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                if has_grown() {
                    job.outgrow();
                    return;
                }
            }
        });
        let done = work();
        drop(work_goes_on);
        done
    })
}

/// Memory that the process has now; none where the system does not tell it so.
fn resident_bytes() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
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
}
