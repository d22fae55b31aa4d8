//! How often the intervals of rare failures hold probabilities that are known: `checks/rare/intervals.sh`.

#![allow(clippy::print_stdout, reason = "a table for people")]

#[allow(dead_code, unreachable_pub, reason = "a test asks more of them")]
#[path = "../tests/rare/cases.rs"]
mod cases;

use cases::Case;
use fspid_campaign::rare::{Interval, Known, importance, subset};

/// Points of each question: the flights that `campaign rare` flies if nobody says.
const POINTS: u64 = 50_000;

/// What became of some seeds.
#[derive(Default)]
struct Tally {
    given: u64,
    /// The interval is above the probability, or below it.
    above: u64,
    below: u64,
    half_width: f64,
    estimates: f64,
    /// No interval, but a bound; and bounds that do not hold.
    bounded: u64,
    wrong_bounds: u64,
}

impl Tally {
    fn take(&mut self, known: Known, probability: f64) {
        match known {
            Known::Within(Interval { estimate, low, high, .. }) => {
                self.given += 1;
                self.above += u64::from(low > probability);
                self.below += u64::from(high < probability);
                self.half_width += 0.5 * libm::log(high / low);
                self.estimates += estimate / probability;
            }
            Known::Below { most, .. } => {
                self.bounded += 1;
                self.wrong_bounds += u64::from(most < probability);
            }
        }
    }

    fn line(&self, name: &str, probability: f64) -> String {
        let given = self.given.max(1) as f64;
        let held = self.given - self.above - self.below;
        format!(
            "{name:28} {probability:7.0e}  {held:4} of {:4} = {:5.1} %  above {:3} below {:3}  factor {:4.2}  mean {:5.3}  bounds {:3}, wrong {:2}",
            self.given,
            100.0 * held as f64 / given,
            self.above,
            self.below,
            libm::exp(self.half_width / given),
            self.estimates / given,
            self.bounded,
            self.wrong_bounds
        )
    }
}

type Answer = fn(&mut Case, u64) -> Known;

fn main() {
    let seeds = std::env::args().nth(1).and_then(|it| it.parse().ok()).unwrap_or(100);
    let methods: [(&str, Answer); 2] = [
        ("subset", |case, seed| {
            let Ok(found) = subset(case, seed, POINTS);
            found.known
        }),
        ("importance", |case, seed| {
            let Ok(found) = importance(case, seed, POINTS);
            found.known
        }),
    ];
    let cases: [fn(f64) -> Case; 7] = [
        |probability| cases::linear(5, probability),
        |probability| cases::linear(100, probability),
        cases::circle,
        cases::two_sided,
        cases::two_regions,
        cases::lag_in_noise,
        cases::lag_and_number,
    ];
    for (method, answer) in methods {
        println!("{method}, {seeds} seeds, {POINTS} points each");
        let (mut held, mut given) = (0, 0);
        for case in cases {
            for exponent in [3, 5, 7, 9] {
                let mut tally = Tally::default();
                let probability = libm::pow(10.0, -f64::from(exponent));
                let name = case(probability).name;
                // Noise of air is drawn as it is by importance sampling: nothing rare is found.
                if method == "importance" && name.contains("lag") {
                    continue;
                }
                for seed in 0..seeds {
                    let mut case = case(probability);
                    tally.take(answer(&mut case, seed), case.probability);
                }
                println!("{}", tally.line(name, probability));
                held += tally.given - tally.above - tally.below;
                given += tally.given;
            }
        }
        println!("{method}: {held} of {given} = {:.2} %\n", 100.0 * held as f64 / given as f64);
    }
}
