//! What a supervisor saw at a sample, and what each of its rules did to each gain.

use fspid_core::equations::{Memory, TunerEquations};
use fspid_core::{Gains, Sample, SelfTuner};
use fspid_fuzzy::LABEL_COUNT;
use fspid_fuzzy::system::{Parts, System};

use crate::fuzzy_system::explain;

/// A supervisor at one sample.
#[derive(Clone, Debug)]
pub struct Fuzzy {
    /// Error and what is seen beside it, in the supervisor's units and with its sign.
    pub seen: [f64; 2],
    /// The same as its even sets see them.
    pub warped: [f64; 2],
    /// Grade of each label of both; zeros for a network, which has none.
    pub grades: [[f64; LABEL_COUNT]; 2],
    /// What it adds to each gain, scaled.
    pub increments: Gains<f64>,
    /// Rules that fire, the strongest first; none for a network.
    pub rules: Vec<Fired>,
}

/// A rule that fires.
#[derive(Clone, Debug)]
pub struct Fired {
    /// Place of the error's label, and of the label beside it, from NB.
    pub cell: [usize; 2],
    /// How strongly.
    pub strength: f64,
    /// The rule in words.
    pub words: String,
    /// What it adds to `kp`, `ki`, `kd`.
    pub added: [Option<Increment>; 3],
}

/// What a rule has in the increment of a gain.
#[derive(Clone, Debug)]
pub struct Increment {
    /// What it concludes.
    pub term: String,
    /// Its part of the increment, scaled: those of all rules sum to it.
    pub added: Option<f64>,
}

impl Fuzzy {
    /// What the supervisor of a tuner makes of a sample; none within the dead zone, and of inputs that it refuses.
    pub(super) fn of(
        tuner: &SelfTuner<f64>,
        equations: &TunerEquations<f64>,
        before: &Memory<f64>,
        sample: &Sample<f64>,
    ) -> Option<Self> {
        let error_rad = sample.setpoint_rad - sample.measurement_rad;
        let second_rad = equations.second_rad(before, sample);
        if equations.is_silent(error_rad, second_rad) {
            return None;
        }
        let seen = equations.seen(error_rad, second_rad);
        let increments = tuner.increments_where_seen(seen[0], seen[1])?;
        let (sets, supervisor) = (tuner.settings().input_sets, tuner.supervisor());
        let range = supervisor.range();
        let warp = |centres: Option<fspid_core::SetCentres<f64>>, input| {
            centres.map_or(input, |centres| centres.warp(input, range))
        };
        let warped = [warp(sets.error, seen[0]), warp(sets.change, seen[1])];
        let rules = match Parts::try_from(supervisor) {
            Ok(parts) => fired(&System::new(parts).ok()?, warped, tuner.settings().output_scale)?,
            // A network has none.
            Err(_) => Vec::new(),
        };
        let grades = warped.map(|input| supervisor.grades(input));
        Some(Self { seen, warped, grades, increments, rules })
    }
}

fn fired(system: &System, at: [f64; 2], scale: Gains<f64>) -> Option<Vec<Fired>> {
    let named = system.parts().inputs.iter().zip(at);
    let values: Vec<String> =
        named.map(|(input, value)| format!("{}={value:?}", input.name)).collect();
    let explanation = explain(system, &values, None).ok()?;
    let rule = |firing: &fspid_fuzzy::system::Firing| Fired {
        cell: [firing.rule / LABEL_COUNT, firing.rule % LABEL_COUNT],
        strength: firing.strength,
        words: explanation.rule_in_words(firing.block, firing.rule),
        added: [(0, scale.kp), (1, scale.ki), (2, scale.kd)].map(|(output, scale)| {
            let (term, share) = explanation.conclusion(output, firing.rule)?;
            Some(Increment { term: term.to_owned(), added: share.map(|share| scale * share) })
        }),
    };
    Some(explanation.rules.iter().map(rule).collect())
}
