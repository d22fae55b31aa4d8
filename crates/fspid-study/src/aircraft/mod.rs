//! Aircraft for people: what is known of them, trim, linear models, modes and where their equations lead.
//!
//! One function per verb; each answers in text and JSON. The mathematics is `fspid-aircraft`'s; here are names, files,
//! units and words. Without a unit, a number is in the chosen [`Units`](fspid_scenario::aircraft::Units).

mod check;
mod condition;
mod derive;
mod envelope;
mod facts;
mod import;
mod import_jsbsim;
mod import_simulator;
mod limits;
mod linearise;
mod list;
mod load;
mod loading;
mod modes;
mod parse;
mod plant_file;
mod polynomial;
mod qualities;
mod show;
mod state_model;
mod table;
mod tables;
mod trim;

pub use fspid_aircraft::VelocityForm;
pub use fspid_aircraft::qualities::{Category, Class};

pub use check::{CheckedAircraft, check};
pub use condition::{AirChoice, DragChoice, Flight, Question, ThrustChoice, flight};

pub use derive::{Derivation, derive};
pub use envelope::{Envelope, EnvelopeQuestion, envelope};
pub use import::{ImportFailure, Imported, import};
pub use import_jsbsim::{JsbsimImport, import_jsbsim, is_jsbsim};
pub use import_simulator::{NoModel, SimulatorModel, import_simulator};
pub use linearise::{Linear, linearise};
pub use list::{List, list};
pub use load::load;
pub use loading::LoadingQuestion;
pub use modes::{Modes, modes};
pub use qualities::{Judged, QualitiesQuestion, qualities};
pub use show::{Show, show};
pub use trim::{Trimmed, trim};

/// Why an answer about an aircraft has no trim.
const NO_TRIM: &str = "the aircraft is known by a linear model alone, which has no trim";
