#![doc = include_str!("README.md")]
//!
//! No features, no dependencies. Not here: any reader of these texts (`fspid-scenario`), and `designs/`, which are for
//! people and tests.
#![no_std]

/// A text by its name.
pub type Named = (&'static str, &'static str);

macro_rules! texts {
    ($folder:literal, $ending:literal: $($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!($folder, "/", $name, $ending)))),*]
    };
}

/// Linear plants.
pub const PLANTS: [Named; 5] = texts![
    "plants", ".toml":
    "b747-paper", "navion-paper", "b747-short-period", "navion-full", "ctms-pitch",
];

/// Rule tables.
pub const RULE_TABLES: [Named; 2] = texts!["rule-tables", ".toml": "printed", "mirrored"];

/// Aircraft.
pub const AIRCRAFT: [Named; 23] = texts![
    "aircraft", ".toml":
    "navion", "b747-approach", "b747-cruise-low", "b747-cruise-high", "cessna-172", "etkin-747",
    "ctms-transport", "cessna-310", "beech-99", "beaver", "twin-otter", "dc-8-approach",
    "dc-8-cruise", "jetstar", "learjet-24", "citation-500", "convair-880", "aerosonde", "zagi",
    "skywalker-x8", "ultra-stick-25e", "anaconda", "mini-mutt",
];

/// Classes of aircraft, and the files of each kind of aircraft in them: propeller aircraft of up to 12 500 lb, jets that carry
/// people, unmanned aircraft of up to 25 kg.
pub const AIRCRAFT_CLASSES: [(&str, &[&[&str]]); 3] = [
    (
        "light",
        &[
            &["navion"],
            &["cessna-172"],
            &["cessna-310"],
            &["beech-99"],
            &["beaver"],
            &["twin-otter"],
        ],
    ),
    (
        "transport",
        &[
            &["b747-approach", "b747-cruise-low", "b747-cruise-high", "etkin-747"],
            &["dc-8-approach", "dc-8-cruise"],
            &["convair-880"],
            &["jetstar"],
            &["learjet-24"],
            &["citation-500"],
            &["ctms-transport"],
        ],
    ),
    (
        "uav",
        &[
            &["aerosonde"],
            &["zagi"],
            &["skywalker-x8"],
            &["ultra-stick-25e"],
            &["anaconda"],
            &["mini-mutt"],
        ],
    ),
];

/// Sets of requirements.
pub const REQUIREMENTS: [Named; 6] = texts!["requirements", ".toml": "mil-f-9490d", "mil-f-8785c", "ctms", "mil-f-9490d-altitude", "rvsm", "ac-25.1329"];

/// Scenarios of the paper, found by `fspid reproduce --identify`; their names are paths below `paper/`.
pub const PAPER: [Named; 17] = texts![
    "paper", "":
    "own/figure-5.toml",
    "own/figure-6.toml",
    "own/figure-8a.toml",
    "own/figure-8b.toml",
    "own/figure-9.toml",
    "shared/figure-5.toml",
    "shared/figure-6.toml",
    "shared/figure-8a.toml",
    "shared/figure-8b.toml",
    "shared/figure-9.toml",
    "disturbance/abrupt-elevator.toml",
    "disturbance/abrupt-measurement.toml",
    "disturbance/abrupt-servo.toml",
    "disturbance/continuous-elevator.toml",
    "disturbance/continuous-measurement.toml",
    "disturbance/continuous-servo.toml",
    "long-term-change.toml",
];

/// How the parameters in [`PAPER`] were found, JSON.
pub const IDENTIFICATION: &str = include_str!("paper/identification.json");

/// The status that each claim of the paper has reached, TOML.
pub const STATUSES: &str = include_str!("paper/statuses.toml");

/// What is wrong or contradictory in the paper, Markdown.
pub const ERRATA: &str = include_str!("documents/errata.md");

/// What the paper leaves open and what stands in its place, Markdown.
pub const ASSUMPTIONS: &str = include_str!("documents/assumptions.md");

// A checkout that cannot make symbolic links has the path of the document in its place.
const _: () = assert!(
    ERRATA.len() > 100 && ASSUMPTIONS.len() > 100,
    "data/documents are symbolic links: `git config core.symlinks true`, then check out again"
);
