#![doc = include_str!("../README.md")]
//!
//! No features. Not here: anything that a scenario of one's own needs.

mod claim;
pub mod disturbance;
mod figures;
pub mod identify;
mod judge;
mod model;
mod qualitative;
mod reading;
mod recorded;
pub mod report;

pub use claim::{CLAIMS, Claim, Printed, Quantity, Reading, Status};
pub use figures::{FIGURES, Fit, FlownFigure, Library, PaperFigure, Stored};
pub use judge::JudgedClaim;
pub use qualitative::JudgedStatement;
pub use recorded::{Fallen, fallen, recorded_toml};

use fspid_sim::SimError;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use self::disturbance::Sweep;
use self::identify::Record;
use self::qualitative::Evidence;
use fspid_scenario::file::{self, Problems};
use fspid_study::metrics::Measured;
use fspid_study::simulation::Simulation;

/// Why the paper could not be flown: a stored scenario is wrong, which no shipped one is.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// A stored scenario has problems.
    #[error(transparent)]
    Problems(#[from] Problems),
    /// A stored scenario cannot be flown.
    #[error(transparent)]
    Flight(#[from] SimError),
    /// Something the program should carry is not there.
    #[error("the program carries no {0}")]
    Missing(&'static str),
}

/// The scenario of the long-term change.
const LONG_TERM: &str = "long-term-change.toml";
/// Shares of the elevator's effectiveness that claim S2 is judged with.
const EFFECTIVENESS: [f64; 4] = [0.5, 0.7, 1.4, 2.0];

/// The setting that leaves this share of the short-period model's numerator (assumption A22).
fn weakened(share: f64) -> String {
    let [b1, b0] = [11.7304, 22.578].map(|coefficient| share * coefficient);
    format!("plant_change[0].numerator=[{b1:?}, {b0:?}]")
}

/// The paper, flown and judged.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// Every figure with numbers, under both fits.
    pub figures: Vec<FlownFigure>,
    /// The sweeps of Fig. 7.
    pub sweeps: Vec<Sweep>,
    /// The flight of the long-term change as it is stored.
    pub long_term: Simulation,
    /// The same with other changes: share of the elevator's effectiveness that is left, and flight.
    pub long_term_shares: Vec<(f64, Simulation)>,
    /// Every number of the paper.
    pub claims: Vec<JudgedClaim>,
    /// Every claim in words.
    pub statements: Vec<JudgedStatement>,
    /// How the parameters were found.
    pub record: Record,
    /// SHA-256 of all scenarios, in order.
    pub digest: String,
}

impl Reproduction {
    /// Flies and judges the stored scenarios.
    ///
    /// # Errors
    /// [`ReproduceError`] if the program was built with scenarios that are wrong.
    pub fn stored() -> Result<Self, ReproduceError> {
        let record = Record::from_json(fspid_data::IDENTIFICATION)
            .ok_or(ReproduceError::Missing("record of its identification"))?;
        Self::of(&Library::stored(), record)
    }

    /// Flies and judges these scenarios.
    ///
    /// # Errors
    /// [`ReproduceError`] if one of them is wrong or missing.
    pub fn of(library: &Library, record: Record) -> Result<Self, ReproduceError> {
        let mut figures = Vec::new();
        for fit in Fit::ALL {
            for figure in FIGURES {
                let study = library.figure(fit, figure.id)?;
                let simulation = Simulation::of_window(&study)?;
                figures.push(FlownFigure { figure: *figure, fit, study, simulation });
            }
        }
        let sweeps = disturbance::sweep(library)?;
        let long_term = Simulation::of_window(&library.study(LONG_TERM, &[])?)?;
        let mut long_term_shares = Vec::new();
        for share in EFFECTIVENESS {
            let study = library.study(LONG_TERM, &[weakened(share)])?;
            long_term_shares.push((share, Simulation::of_window(&study)?));
        }
        let printed =
            file::rule_table("printed").ok_or(ReproduceError::Missing("printed rule table"))?;
        let evidence = Evidence {
            figures: &figures,
            sweeps: &sweeps,
            long_term: &long_term_shares,
            printed: &printed,
        };
        let statements = evidence.judge();
        let claims = judge::judge(&figures);
        let digest = digest(library);
        Ok(Self {
            figures,
            sweeps,
            long_term,
            long_term_shares,
            claims,
            statements,
            record,
            digest,
        })
    }

    /// The figure under a fit.
    #[must_use]
    pub fn figure(&self, fit: Fit, id: &str) -> Option<&FlownFigure> {
        self.figures.iter().find(|flown| flown.fit == fit && flown.figure.id == id)
    }

    /// Id and status of every claim, numbers first.
    pub fn statuses(&self) -> impl Iterator<Item = (&'static str, Status)> + '_ {
        let numbers = self.claims.iter().map(|judged| (judged.claim.id, judged.status));
        numbers.chain(self.statements.iter().map(|judged| (judged.id, judged.status)))
    }

    /// How many claims have this status.
    #[must_use]
    pub fn count(&self, status: Status) -> usize {
        self.statuses().filter(|(_, of)| *of == status).count()
    }

    /// How many of the paper's numbers come out with parameters of each figure's own, and with one set for all figures
    /// of a range.
    #[must_use]
    pub fn numbers_reproduced(&self) -> [usize; 2] {
        let count = |of: fn(&JudgedClaim) -> Status| {
            self.claims.iter().filter(|judged| of(judged) == Status::Reproduced).count()
        };
        [count(|judged| judged.status), count(|judged| judged.shared_status)]
    }

    /// `claims.json`: one entry per number and statement.
    #[must_use]
    pub fn claims_json(&self) -> Value {
        let numbers = self.claims.iter().map(number_json);
        let statements = self.statements.iter().map(statement_json);
        numbers.chain(statements).collect()
    }
}

fn measured(value: Measured) -> Value {
    value.map_or_else(|reason| json!(reason.to_string()), |value| json!(value))
}

fn number_json(judged: &JudgedClaim) -> Value {
    json!({
        "id": judged.claim.id,
        "quantity": judged.claim.quantity,
        "paper": judged.claim.paper.value(),
        "ours": measured(judged.ours),
        "shared": measured(judged.shared),
        "unit": judged.claim.unit,
        "status": judged.status.name(),
        "shared_status": judged.shared_status.name(),
        "assumptions": judged.assumptions,
        "note": judged.note,
    })
}

fn statement_json(judged: &JudgedStatement) -> Value {
    json!({
        "id": judged.id,
        "quantity": judged.paper,
        "paper": judged.paper,
        "ours": judged.ours,
        "unit": "",
        "status": judged.status.name(),
        "assumptions": judged.assumptions,
        "note": judged.note,
    })
}

fn digest(library: &Library) -> String {
    let mut hash = Sha256::new();
    for stored in library.scenarios() {
        hash.update(stored.name.as_bytes());
        hash.update([0]);
        hash.update(stored.text.as_bytes());
        hash.update([0]);
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
