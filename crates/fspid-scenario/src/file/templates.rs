//! Files to begin with, one a row: each checks, runs, and says in its comments what to do with it.

/// A file to begin with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Starter {
    /// Its name.
    pub name: &'static str,
    /// What it is, in a line.
    pub about: &'static str,
    /// What is in it.
    pub text: &'static str,
    /// What to do with it, with FILE in place of its name.
    pub command: &'static str,
}

/// Every file to begin with; the first one where none is named.
pub const STARTERS: [Starter; 9] = [
    Starter {
        name: "pitch-hold",
        about: "a pitch command flown by a PID and a self-tuning PID",
        text: include_str!("starter.toml"),
        command: "fspid simulate FILE --report report.html",
    },
    Starter {
        name: "aircraft-in-turbulence",
        about: "an aircraft with six degrees of freedom holds its pitch in gusts",
        text: include_str!("templates/aircraft-in-turbulence.toml"),
        command: "fspid simulate FILE --report report.html",
    },
    Starter {
        name: "aircraft",
        about: "an aircraft of your own, from its derivatives",
        text: include_str!("templates/aircraft.toml"),
        command: "fspid check FILE",
    },
    Starter {
        name: "requirements",
        about: "what a loop must meet, judged with the worst case",
        text: include_str!("templates/requirements.toml"),
        command: "fspid verify FILE",
    },
    Starter {
        name: "campaign",
        about: "one flight a thousand times with numbers drawn anew",
        text: include_str!("templates/campaign.toml"),
        command: "fspid campaign run FILE --runs 1000 --out robust",
    },
    Starter {
        name: "tuning",
        about: "free numbers that a search chooses",
        text: include_str!("templates/tuning.toml"),
        command: "fspid tune FILE --out design.toml",
    },
    Starter {
        name: "contest",
        about: "controllers tuned alike and judged on what nobody was tuned on",
        text: include_str!("templates/contest.toml"),
        command: "fspid contest FILE --out who --seeds 3",
    },
    Starter {
        name: "rule-table",
        about: "the rules of a supervisor, as three grids of words",
        text: include_str!("templates/rule-table.toml"),
        command: "fspid infer FILE --range 5 --error 1 --change -2",
    },
    Starter {
        name: "fuzzy-system",
        about: "inputs, outputs and rules of a fuzzy system of any kind",
        text: include_str!("templates/fuzzy-system.toml"),
        command: "fspid infer FILE --input service=7 --input food=8",
    },
];

/// The file to begin with of that name.
#[must_use]
pub fn starter_named(name: &str) -> Option<&'static Starter> {
    STARTERS.iter().find(|starter| starter.name == name)
}
