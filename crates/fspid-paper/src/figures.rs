//! The figures of the paper as scenarios, once with parameters of their own and once with one
//! supervisor for all figures of a range.

use fspid_scenario::file::{self, Problems};
use fspid_study::simulation::Simulation;

/// Which scale factors a figure is flown with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// The figure's own.
    Own,
    /// One supervisor for Figs 5 and 6, one for Figs 8 and 9.
    Shared,
}

impl Fit {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Own, Self::Shared];

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Shared => "shared",
        }
    }
}

/// A figure of the paper that shows flights.
#[derive(Clone, Copy, Debug)]
pub struct PaperFigure {
    /// Number in the paper.
    pub id: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// Numbers of the assumptions it rests on.
    pub assumptions: &'static [&'static str],
}

/// What every fitted flight rests on.
macro_rules! resting_on {
    ($($more:literal),*) => {
        &["A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10", "A11", "A12", "A13", $($more,)*
          "A18", "A20", "A21", "A23"]
    };
}

/// The full model with the rate-gyro loop.
const WITH_GYRO: &[&str] = resting_on!["A15", "A19"];
/// The full model without it.
const WITHOUT_GYRO: &[&str] = resting_on!["A15"];
/// The short-period model.
const SHORT_PERIOD: &[&str] = resting_on![];
/// The short-period model under the disturbances of Fig. 7.
pub(super) const DISTURBED: &[&str] = resting_on!["A16", "A17"];
/// The short-period model whose elevator weakens.
pub(super) const WEAKENED: &[&str] = resting_on!["A22"];
/// What the full model without the rate-gyro loop says about damping.
pub(super) const DAMPING: &[&str] = WITHOUT_GYRO;

/// The figures with numbers, in the paper's order.
#[rustfmt::skip] // a table: one row a figure
pub const FIGURES: &[PaperFigure] = &[
    PaperFigure { id: "5", title: "Fig. 5: PC, CPID and FSPID with the rate-gyro loop, full model", assumptions: WITH_GYRO },
    PaperFigure { id: "6", title: "Fig. 6: without the rate-gyro loop, full model", assumptions: WITHOUT_GYRO },
    PaperFigure { id: "8a", title: "Fig. 8a: slow tuning, short-period model", assumptions: SHORT_PERIOD },
    PaperFigure { id: "8b", title: "Fig. 8b: tuning with overshoot, short-period model", assumptions: SHORT_PERIOD },
    PaperFigure { id: "9", title: "Fig. 9: tracking, short-period model", assumptions: SHORT_PERIOD },
];

/// A scenario text and where it belongs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stored {
    /// File name below `data/paper` (or the folder of an identification).
    pub name: String,
    /// The scenario.
    pub text: String,
}

/// All scenarios of a reproduction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Library(Vec<Stored>);

impl Library {
    /// The scenarios shipped with the program.
    #[must_use]
    pub fn stored() -> Self {
        let stored = |(name, text): &(&str, &str)| Stored {
            name: (*name).to_owned(),
            text: (*text).to_owned(),
        };
        Self(fspid_data::PAPER.iter().map(stored).collect())
    }

    /// These scenarios.
    #[must_use]
    pub fn new(scenarios: Vec<Stored>) -> Self {
        Self(scenarios)
    }

    /// All scenarios.
    #[must_use]
    pub fn scenarios(&self) -> &[Stored] {
        &self.0
    }

    /// The text of the scenario with this name; empty if there is none, which no reader accepts.
    fn text(&self, name: &str) -> &str {
        self.0.iter().find(|stored| stored.name == name).map_or("", |stored| &stored.text)
    }

    /// Reads a scenario, with values set as on the command line.
    ///
    /// # Errors
    /// [`Problems`] of the text.
    pub fn study(&self, name: &str, overrides: &[String]) -> Result<file::Study, Problems> {
        file::parse(self.text(name), name, None, overrides)
    }

    /// Reads the scenario of a figure.
    ///
    /// # Errors
    /// [`Problems`] of the text.
    pub fn figure(&self, fit: Fit, id: &str) -> Result<file::Study, Problems> {
        self.study(&format!("{}/figure-{id}.toml", fit.name()), &[])
    }
}

/// A figure that has been flown.
#[derive(Clone, Debug)]
pub struct FlownFigure {
    /// Which.
    pub figure: PaperFigure,
    /// With which scale factors.
    pub fit: Fit,
    /// The scenario.
    pub study: file::Study,
    /// Its flights.
    pub simulation: Simulation,
}
