#![doc = include_str!("../README.md")]
//!
//! # Without any file
//!
//! ```
//! use fspid::core::paper;
//! use fspid::prelude::*;
//!
//! // Pitch per elevator of a short period with its integrator; angles in radians, times in seconds.
//! let plant = LinearPlant::new(&[1.151, 0.1774], &[1.0, 0.739, 0.921, 0.0], ElevatorSign::NoseUpPositive)?;
//! let supervisor = Supervisor::new(&paper::rules().mirrored(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp)?;
//! let nominal = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
//! let tuner = SelfTuner::new(nominal, supervisor, TunerSettings {
//!     input_scale: InputScale { error_per_rad: 60.0, change_per_rad: 12.0 },
//!     output_scale: Gains { kp: 0.05, ki: 0.01, kd: 0.01 },
//!     ..TunerSettings::literal()
//! })?;
//! let controller = Fspid::new(tuner, PidConfig::sampled_every(0.01))?;
//! let setpoint = Profile::new(5.0_f64.to_radians(), Shape::Step { at_s: 0.0 })?;
//! let scenario = Scenario::new("five degrees", plant, Timing::new(0.01, 40.0)?, setpoint)
//!     .with_controller("FSPID", Controller::SelfTuning(controller));
//! let study = Study::of(scenario);
//!
//! let simulation = Simulation::of(&study)?;
//! println!("{}", simulation.text());
//! assert!(simulation.results[0].metrics.verdict.is_good());
//! let analysis = Analysis::of(&study, Question::default())?;
//! assert!(analysis.all_held());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is where
//!
//! | module | what it is |
//! | --- | --- |
//! | [`core`](mod@core) | controllers that can fly; `no_std`, no heap, `step` cannot fail |
//! | [`fuzzy`] | the supervisor, general fuzzy systems, audits |
//! | [`sim`] | the sampled closed loop: scenario in, trace out |
//! | [`scenario`] | scenarios, fuzzy systems and requirements as text, and what is true of them |
//! | [`study`] | measures, verdicts, margins, reports |
//! | [`certify`] | proofs of stability as files that are checked anew |
//! | [`campaign`], [`tune`] | many flights; searches, classical rules, contests |
//! | [`limit`] | how good any controller could be |
//! | [`export`] | a controller in other languages, with the same bits |
//! | [`external`] | controllers that are programs, flown in a process beside |
//! | [`optimise`], [`plot`], [`page`] | optimisers, figures as SVG, pages of HTML: free of flights |
//! | [`lti`], [`aircraft`], [`proof`], [`numeric`] | linear systems, aircraft, proofs, numbers |
//!
//! No features. Not here: the program and its arguments (`fspid-cli`), and firmware, which wants `fspid-core` alone.

pub use fspid_aircraft as aircraft;
pub use fspid_campaign as campaign;
pub use fspid_certify as certify;
pub use fspid_core as core;
pub use fspid_export as export;
pub use fspid_external as external;
pub use fspid_fuzzy as fuzzy;
pub use fspid_limit as limit;
pub use fspid_lti as lti;
pub use fspid_numeric as numeric;
pub use fspid_optimise as optimise;
pub use fspid_page as page;
pub use fspid_plot as plot;
pub use fspid_proof as proof;
pub use fspid_scenario as scenario;
pub use fspid_sim as sim;
pub use fspid_study as study;
pub use fspid_tune as tune;

/// What most programs need: `use fspid::prelude::*;`.
pub mod prelude {
    pub use fspid_certify::Certification;
    pub use fspid_core::{
        AntiWindup, ConfigError, ControllerSetting, Derivative, Fspid, GainLimits, Gains,
        InputScale, Law, Limits, Pid, PidConfig, Sample, SelfTuner, SetpointWeights, State,
        TunerSettings,
    };
    pub use fspid_fuzzy::{
        Defuzzifier, FuzzyError, Grid, Label, OutOfRange, RuleTable, Supervisor,
    };
    pub use fspid_scenario::file::{Study, load, parse};
    pub use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
    pub use fspid_sim::{
        Actuator, Controller, ElevatorSign, LinearPlant, NamedController, Outcome, Plant, Scenario,
        SimError, Timing, Trace, simulate,
    };
    pub use fspid_study::analysis::{Analysis, Question};
    pub use fspid_study::metrics::{FlightMetrics, Verdict};
    pub use fspid_study::simulation::Simulation;
}
