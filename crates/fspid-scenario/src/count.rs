//! Every count that somebody may choose, with its least and most: one table for the command line, scenarios, Python and
//! the libraries. A count is held against it before memory is asked for or a thread begun.
//!
//! Not here: seeds and numbers of runs or shards, which name one of many and of which every one is as good; counts within
//! a file, whose keys carry their own.

use std::error::Error;
use std::fmt;

/// A count with its least and most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count {
    /// What is counted, as a sentence begins.
    pub what: &'static str,
    /// The options that ask for it, each behind its command.
    pub options: &'static [&'static str],
    /// The least that is allowed.
    pub least: u64,
    /// The most that is allowed.
    pub most: u64,
    /// Why no more.
    pub because: &'static str,
}

/// A count that is not allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CountError {
    /// What is counted, and its limits.
    pub count: Count,
    /// What was given.
    pub found: String,
}

impl fmt::Display for CountError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {}; {}", self.count.what, self.found, self.count.allowed())
    }
}

impl Error for CountError {}

impl Count {
    /// What is allowed, in words.
    #[must_use]
    pub fn allowed(&self) -> String {
        format!("allowed is a whole number from {} to {}", self.least, self.most)
    }

    /// True for what is allowed.
    #[must_use]
    pub fn allows(&self, found: u64) -> bool {
        (self.least..=self.most).contains(&found)
    }

    /// Refuses what is not allowed.
    ///
    /// # Errors
    /// [`CountError`] with what was found and what is allowed.
    pub fn check<N: TryInto<u64> + Copy + ToString>(self, found: N) -> Result<(), CountError> {
        match found.try_into() {
            Ok(number) if self.allows(number) => Ok(()),
            _ => Err(CountError { count: self, found: found.to_string() }),
        }
    }
}

macro_rules! counts {
    ($($name:ident: $what:literal, $options:expr, $least:literal to $most:literal, $because:literal;)*) => {
        $(
            #[doc = concat!("Limits of ", $what, ": ", $because, ".")]
            pub const $name: Count = Count {
                what: $what, options: &$options, least: $least, most: $most, because: $because,
            };
        )*

        /// Every count.
        pub static COUNTS: &[Count] = &[$($name),*];
    };
}

counts! {
    THREADS: "the number of threads",
        ["campaign run --threads", "campaign shard --threads", "campaign search --threads", "campaign rare --threads", "tune --threads", "contest --threads", "adaptation --threads", "bench --threads"],
        0 to 1024, "more than any machine has stall it; 0 is as many as it has";
    RUNS: "the number of runs", ["campaign run --runs", "campaign plan --runs", "adaptation --runs"],
        1 to 1_000_000_000, "an assumption: hours to weeks of flights";
    SHARD_RUNS: "the number of runs in a shard", ["campaign run --shard-runs", "campaign plan --shard-runs"],
        1 to 65_536, "a shard is in memory until it is written, some 100 MB";
    TASKS: "the number of tasks", ["campaign run --tasks"],
        1 to 1_000_000, "an assumption: clusters take shorter arrays of jobs";
    EXACT_ROWS: "the number of rows that are sorted", ["campaign report --exact-rows"],
        0 to 1_000_000_000, "a column of them is 8 GB";
    FLIGHTS: "the number of flights", ["campaign search --budget"],
        1 to 10_000_000, "an assumption: hours of flights";
    RARE_FLIGHTS: "the number of flights", ["campaign rare --flights"],
        1000 to 100_000_000, "of fewer no interval can be made; the most are hours of flights, whose scores are some gigabytes";
    BUDGET: "the budget", ["tune --budget", "contest --budget", "adaptation --budget"],
        1 to 10_000_000, "each candidate is kept with its costs, some 300 bytes";
    POPULATION: "the population", ["tune --population"],
        2 to 1_000_000, "a generation is flown and held in memory together";
    SEEDS: "the number of seeds", ["contest --seeds", "adaptation --seeds", "reproduce --seeds"],
        1 to 1000, "each is a search of its own, and all are listed";
    EPOCHS: "the number of epochs", ["learn --epochs"],
        1 to 1_000_000, "an assumption; each is kept and told";
    PATIENCE: "the patience", ["learn --patience"],
        1 to 1_000_000, "there are no more epochs";
    TAUGHT_POINTS: "the number of points along an input", ["learn --points"],
        2 to 1_000_000, "the whole grid is held in memory, and has no more";
    NODES: "the number of nodes", ["surface --nodes"],
        2 to 1001, "a surface is drawn with the square of it";
    BOXES: "the number of boxes", ["audit --boxes"],
        1 to 100_000_000, "each box that is open is held in memory, and each question takes them anew";
    SAMPLES: "the number of samples", ["export --samples"],
        1 to 1_000_000, "each stands in the text of the vectors";
    TABLE_POINTS: "the number of points along an input", ["export --points"],
        7 to 127, "a table of more takes over 200 KB of a flight computer";
    MAP_POINTS: "the number of points along a map", ["analyse --map"],
        0 to 201, "a map has the square of it, each with its margins";
    ENVIRONMENTS: "the number of environments", [],
        1 to 65_536, "an assumption; each holds a flight and its controller";
}

/// The count that an option of a command asks for, such as `--seeds` of `contest`.
#[must_use]
pub fn of_option(command: &str, option: &str) -> Option<Count> {
    let asks =
        |it: &&str| it.strip_prefix(command).and_then(|it| it.strip_prefix(" --")) == Some(option);
    COUNTS.iter().copied().find(|count| count.options.iter().any(&asks))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_count_refuses_what_lies_beyond_its_ends_and_says_what_is_allowed() {
        for count in COUNTS {
            assert!(count.least < count.most, "{}", count.what);
            assert!(count.check(count.least).is_ok() && count.check(count.most).is_ok());
            let wrong = [count.most + 1, u64::MAX].into_iter().chain(count.least.checked_sub(1));
            for found in wrong {
                let told = count.check(found).map_err(|error| error.to_string());
                let expected = format!("{} is {found}; {}", count.what, count.allowed());
                assert_eq!(told, Err(expected));
            }
            assert!(count.check(-1_i64).is_err(), "{}", count.what);
        }
    }

    #[test]
    fn the_guide_states_every_count() {
        let page = include_str!("../../../docs/guide/limits.md");
        for count in COUNTS {
            let options: Vec<String> = count.options.iter().map(|it| format!("`{it}`")).collect();
            let row = format!(
                "| {} | {} | {} | {} | {} |\n",
                count.what,
                options.join(", "),
                count.least,
                count.most,
                count.because
            );
            assert!(page.contains(&row), "the page lacks\n{row}");
        }
        let rows = page.lines().filter(|line| line.starts_with("| the ")).count();
        assert_eq!(rows, COUNTS.len(), "the page has rows that are no longer in the table");
    }
}
