//! What a job may take in memory: estimated before it begins, measured while it works.
//!
//! A job is a thread of this process, so that the system bounds none of them by itself. What is asked for at once, the flights
//! in the air, is known beforehand; what grows, such as the candidates of a search, is measured. Memory that was given back
//! may stay with the process: a job is charged with what the process has grown by since it began.

use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use fspid_scenario::file::Study;
use fspid_study::memory::{Needed, mebibytes, resident_bytes};

use super::asked::Work;
use super::job::Job;
use super::task::Ended;

/// How often the memory of the process is looked at.
const TICK: Duration = Duration::from_millis(50);

/// Refuses a job whose flights alone take more than it may have at once.
pub(super) fn check(work: &Work, study: &Study, most: u64) -> Result<(), Ended> {
    let flights = Needed::for_flights(study.scenario.timing.rows(), rayon::current_num_threads());
    let needed = match work {
        // A proof flies nothing, and asks for no more than its states.
        Work::Certify(_) | Work::Check(_) => return Ok(()),
        Work::Contest(_) => flights,
        Work::Tune(tune) => flights.with_candidates(tune.population()),
        Work::Campaign(campaign) => {
            let controllers = study.scenario.flyers().count() as u64;
            flights.with_rows(campaign.runs_of_shard().saturating_mul(controllers))
        }
    };
    if needed.bytes() <= most {
        return Ok(());
    }
    Err(Ended::failed(format_args!(
        "{needed}; a job may take {} here, the command line what its machine has left: a shorter flight, a longer sample period or a smaller population takes less",
        mebibytes(most)
    )))
}

/// Why a job was ended whose memory has grown so far.
pub(super) fn too_large(most: u64) -> Ended {
    Ended::failed(format_args!(
        "the server's memory has grown by more than {} while this job worked, which is all that a job may take here; the command line has no limit of its own. What other jobs took meanwhile counts too",
        mebibytes(most)
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
