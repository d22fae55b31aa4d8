//! Sets of flights side by side, as many as there are processors.
//!
//! What comes out is what one after the other would have come to: a set counts as flown where those before it have ended and
//! left work for it, whichever was ready first, and of several that are given up the first says why.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use super::sample::Stop;
use super::work::Flights;

/// How often it is asked whether anybody still waits.
const ASKS: Duration = Duration::from_millis(2);

/// So many times its share of the work that is left a job of a search may take.
const UNEVEN: usize = 3;

/// What has come of the jobs so far.
struct Board<Answer> {
    /// With the work that each has taken.
    answers: Vec<Option<(Result<Answer, Stop>, usize)>>,
    /// Of these, from the first on, all are there and have been added up.
    counted: usize,
    /// Work of what was there before and of those that are counted, and the most before one begins.
    flown: usize,
    most: usize,
    /// Why it ends before all are counted.
    ended: Option<Stop>,
}

impl<Answer> Board<Answer> {
    fn tell(&mut self, job: usize, answer: Result<Answer, Stop>, flown: usize) {
        self.answers[job] = Some((answer, flown));
        while self.ended.is_none() {
            let Some(Some((answer, flown))) = self.answers.get(self.counted) else { break };
            if self.flown > self.most {
                self.ended = Some(Stop::Work);
                break;
            }
            // What was given up has taken its work too.
            self.flown += flown;
            match answer {
                Err(stop) => self.ended = Some(*stop),
                Ok(_) => self.counted += 1,
            }
        }
    }
}

fn locked<T>(board: &Mutex<T>) -> MutexGuard<'_, T> {
    board.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Most work after one of so many jobs. Where one of a search takes much more than its share, all together would take more than
/// there is, and a search has others to try.
fn most_of_each(own: &Flights<'_>, jobs: usize) -> usize {
    let left = own.most.saturating_sub(own.flown);
    let each = own.flown + left.saturating_mul(UNEVEN) / jobs.max(1);
    if own.paced { own.most.min(each) } else { own.most }
}

/// Does all jobs; their answers in their order. `own` has then flown what those have that count.
///
/// # Errors
/// The first job that was given up, or that all before it had left no work for.
pub(super) fn side_by_side<'a, Job: Sync, Answer: Send>(
    own: &mut Flights<'a>,
    jobs: &[Job],
    work: impl Fn(&mut Flights<'a>, &Job) -> Result<Answer, Stop> + Sync,
) -> Result<Vec<Answer>, Stop> {
    let (begun, most) = (own.flown, own.most);
    own.most = most_of_each(own, jobs.len());
    let board = Board {
        answers: jobs.iter().map(|_| None).collect(),
        counted: 0,
        flown: begun,
        most,
        ended: None,
    };
    let (board, next) = (Mutex::new(board), AtomicUsize::new(0));
    let fly = |flights: &mut Flights<'a>| {
        while !flights.is_stopped() {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = jobs.get(place) else { break };
            // Each begins with as much work as every other, whoever does it.
            flights.flown = begun;
            let answer = work(flights, job);
            let mut board = locked(&board);
            board.tell(place, answer, flights.flown - begun);
            if board.ended.is_some() {
                flights.halted.store(true, Ordering::Relaxed);
            }
        }
    };
    let others = own.threads.min(jobs.len()).saturating_sub(1);
    let crew: Vec<Flights<'a>> = (0..others).map(|_| own.another()).collect();
    thread::scope(|scope| {
        let fly = &fly;
        let others: Vec<_> =
            crew.into_iter().map(|mut flights| scope.spawn(move || fly(&mut flights))).collect();
        fly(own);
        // Whoever asked may stop waiting while the others still fly; only this thread can ask.
        while !others.iter().all(thread::ScopedJoinHandle::is_finished) {
            if own.is_stopped() {
                own.halted.store(true, Ordering::Relaxed);
            }
            thread::sleep(ASKS);
        }
        for other in others {
            other.join().unwrap_or_else(|panic| resume_unwind(panic));
        }
    });
    own.halted.store(false, Ordering::Relaxed);
    own.most = most;
    let Board { answers, counted, flown, ended, .. } =
        board.into_inner().unwrap_or_else(PoisonError::into_inner);
    own.flown = flown;
    if ended.is_some() || counted < jobs.len() {
        return Err(ended.unwrap_or(Stop::Lost));
    }
    answers.into_iter().flatten().map(|(answer, _)| answer).collect()
}

#[cfg(test)]
mod tests {
    use fspid_core::{ControllerSetting, Derivative, Limits, Pid, PidConfig};
    use fspid_sim::Controller;
    use fspid_sim::actuator::Actuator;

    use super::*;
    use crate::description::LoopDescription;
    use crate::gain_set::GainSet;
    use crate::steps::commands::Commands;
    use crate::steps::flights::{Beginning, Landed, Patch, Way};
    use crate::steps::tests::navion::{GAINS, navion, proved};

    fn board(jobs: usize, most: usize) -> Board<char> {
        let answers = (0..jobs).map(|_| None).collect();
        Board { answers, counted: 0, flown: 0, most, ended: None }
    }

    #[test]
    fn the_first_set_that_is_given_up_says_why_whichever_was_ready_first() {
        let mut board = board(3, 100);
        board.tell(2, Err(Stop::Travel), 1);
        board.tell(1, Err(Stop::Guard), 1);
        assert_eq!(board.ended, None, "the first is not there yet");
        board.tell(0, Ok('a'), 1);
        assert_eq!((board.ended, board.flown), (Some(Stop::Guard), 2), "with its own work");
    }

    #[test]
    fn a_set_for_which_those_before_it_left_no_work_is_given_up_though_it_was_ready_first() {
        let mut board = board(3, 10);
        board.tell(2, Ok('c'), 1);
        board.tell(0, Ok('a'), 10);
        assert_eq!((board.ended, board.flown), (None, 10), "the last may go beyond the most");
        board.tell(1, Ok('b'), 1);
        assert_eq!((board.ended, board.flown, board.counted), (Some(Stop::Work), 11, 2));
    }

    /// The Navion with a PID behind a servo of 20 deg/s.
    fn limited() -> LoopDescription {
        let limits = Limits::new(ControllerSetting::OutputLimits, -0.35, 0.35).expect("allowed");
        let config = PidConfig {
            derivative: Derivative { filter_s: 0.05 },
            limits: Some(limits),
            ..PidConfig::sampled_every(0.02)
        };
        let servo = Actuator::first_order(0.1).and_then(|servo| servo.with_rate_limit(0.35));
        let pid = Pid::new(GAINS, config).expect("allowed");
        navion(servo.expect("allowed"), Controller::Fixed(pid))
    }

    #[test]
    fn on_any_number_of_threads_sets_come_to_the_same_and_take_the_same_work() {
        let description = limited();
        let certificate = proved(&description);
        let terminal = &certificate.steps.as_ref().expect("steps are proved").terminal;
        let model = description.enclosed().expect("enclosed");
        let set = GainSet::fixed(GAINS);
        let commands = Commands::step();
        let flown = |largest_rad: &[f64], threads: usize, most: usize| {
            let flights = Flights::of(&certificate, &model, &set, terminal, None);
            let mut flights = flights.expect("enclosed");
            (flights.threads, flights.most) = (threads, most);
            let landed = side_by_side(&mut flights, largest_rad, |flights, largest_rad| {
                let patch = Patch { setpoint: [0.9 * largest_rad, *largest_rad], load: [0.0; 2] };
                let from = Beginning::Controller;
                let begun = flights.begun(from);
                flights.landed(&Way { commands: &commands, patch, from }, begun, 0)
            });
            (landed, flights.flown)
        };
        let fly = [0.05, 0.01, 0.04, 0.02, 0.03, 0.001];
        let guarded = [0.01, 0.04, 4.0, 0.02, 0.03, 9.0];
        let all = usize::MAX / 2;
        for (largest_rad, most, flies) in
            [(fly, all, true), (fly, 700, false), (guarded, all, false)]
        {
            let alone: (Result<Vec<Landed>, Stop>, usize) = flown(&largest_rad, 1, most);
            for threads in [2, 3, 8] {
                assert_eq!(flown(&largest_rad, threads, most), alone, "{threads} threads");
            }
            assert_eq!(alone.0.is_ok(), flies, "{most}: {alone:?}");
        }
        // A re-check may spend all on one set, a search three times its share.
        let mut flights =
            Flights::of(&certificate, &model, &set, terminal, None).expect("enclosed");
        flights.flown = 1000;
        for (paced, most, jobs, allowed) in [
            (false, 7000, 30, 7000),
            (true, 7000, 30, 1600),
            (true, 7000, 2, 7000),
            // Nothing is left.
            (true, 900, 1, 900),
        ] {
            (flights.paced, flights.most) = (paced, most);
            assert_eq!(most_of_each(&flights, jobs), allowed, "{paced} {most}");
            let _ = side_by_side(&mut flights, &vec![(); jobs], |_, ()| Ok(()));
            assert_eq!((flights.flown, flights.most), (1000, most));
        }
    }

    #[test]
    fn jobs_that_nobody_waits_for_any_more_are_no_answer() {
        let description = limited();
        let certificate = proved(&description);
        let terminal = &certificate.steps.as_ref().expect("steps are proved").terminal;
        let model = description.enclosed().expect("enclosed");
        let set = GainSet::fixed(GAINS);
        let flights = Flights::of(&certificate, &model, &set, terminal, None);
        let mut flights = flights.expect("enclosed").searching(1.0, || true);
        // Another thread may have begun before this one asks: what it does then lasts until it is told.
        let all = side_by_side(&mut flights, &[1, 2, 3], |flights, job| {
            while !flights.is_stopped() {
                thread::sleep(ASKS);
            }
            Ok(*job)
        });
        assert_eq!(all, Err(Stop::Lost));
    }
}
