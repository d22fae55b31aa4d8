//! Running the check cases of a model.

use core::fmt;

use crate::model::Model;

/// How far a variable on the way may be off where its check case says no tolerance: this part of its size, or of 1.
const INTERNAL_TOLERANCE: f64 = 1e-6;

/// A check case with its variables found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ResolvedShot {
    pub(crate) name: String,
    pub(crate) inputs: Vec<f64>,
    pub(crate) internals: Vec<ResolvedSignal>,
    pub(crate) outputs: Vec<ResolvedSignal>,
}

/// What a variable should be.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ResolvedSignal {
    pub(crate) slot: usize,
    pub(crate) value: f64,
    pub(crate) tolerance: Option<f64>,
}

/// What came out of the check cases of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckReport {
    /// One for each check case, in the order of the file.
    pub shots: Vec<ShotReport>,
}

/// What came out of a check case.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotReport {
    /// Name of the check case.
    pub name: String,
    /// Variables on the way, then outputs.
    pub deviations: Vec<Deviation>,
}

/// What a variable should be in a check case, and what it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// Identifier of the variable.
    pub variable: String,
    /// Units of the values.
    pub units: String,
    /// What the file says.
    pub expected: f64,
    /// What the model answers.
    pub found: f64,
    /// How far it may be off.
    pub tolerance: f64,
    /// True for an output, false for a variable on the way.
    pub output: bool,
}

impl Deviation {
    /// Deviation as a multiple of the tolerance: up to 1 is good. Infinite for NaN.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        let distance = (self.found - self.expected).abs();
        if distance <= 0.0 {
            0.0
        } else if distance.is_finite() {
            distance / self.tolerance
        } else {
            f64::INFINITY
        }
    }

    /// Whether the deviation is within its tolerance.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.ratio() <= 1.0
    }
}

impl fmt::Display for Deviation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { variable, units, expected, found, tolerance, .. } = self;
        write!(f, "{variable} is {found} {units}, expected {expected} ± {tolerance}")
    }
}

impl ShotReport {
    /// Whether every variable is within its tolerance.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.deviations.iter().all(Deviation::passed)
    }

    /// The largest deviation relative to its tolerance.
    #[must_use]
    pub fn worst(&self) -> Option<&Deviation> {
        self.deviations.iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
    }
}

impl CheckReport {
    /// Whether every check case passed; also true without any.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.shots.iter().all(ShotReport::passed)
    }

    /// The largest deviation relative to its tolerance, with the name of its check case.
    #[must_use]
    pub fn worst(&self) -> Option<(&str, &Deviation)> {
        let worst = self.shots.iter().filter_map(|shot| Some((shot.name.as_str(), shot.worst()?)));
        worst.max_by(|a, b| a.1.ratio().total_cmp(&b.1.ratio()))
    }
}

impl fmt::Display for CheckReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let passed = self.shots.iter().filter(|shot| shot.passed()).count();
        write!(f, "{passed} of {} check cases passed", self.shots.len())?;
        if let Some((shot, worst)) = self.worst() {
            let ratio = rounded(worst.ratio());
            write!(f, "; largest deviation {ratio} of its tolerance: {worst} (`{shot}`)")?;
        }
        Ok(())
    }
}

/// Three digits.
fn rounded(ratio: f64) -> String {
    if (1e-3..1e3).contains(&ratio) { format!("{ratio:.3}") } else { format!("{ratio:.0e}") }
}

impl Model {
    /// Runs every check case of the file.
    #[must_use]
    pub fn check(&self) -> CheckReport {
        CheckReport { shots: self.shots.iter().map(|shot| self.run_shot(shot)).collect() }
    }

    fn run_shot(&self, shot: &ResolvedShot) -> ShotReport {
        let mut values = vec![f64::NAN; self.variables.len()];
        let computed = self.evaluate_all(&shot.inputs, &mut values);
        debug_assert!(computed.is_ok(), "a check case has a value for each input");
        let internals = shot.internals.iter().map(|signal| self.deviation(signal, &values, false));
        let outputs = shot.outputs.iter().map(|signal| self.deviation(signal, &values, true));
        ShotReport { name: shot.name.clone(), deviations: internals.chain(outputs).collect() }
    }

    fn deviation(&self, signal: &ResolvedSignal, values: &[f64], output: bool) -> Deviation {
        let port = self.variables.get(signal.slot);
        let assumed = INTERNAL_TOLERANCE * signal.value.abs().max(1.0);
        Deviation {
            variable: port.map(|port| port.id.clone()).unwrap_or_default(),
            units: port.map(|port| port.units.clone()).unwrap_or_default(),
            expected: signal.value,
            found: values.get(signal.slot).copied().unwrap_or(f64::NAN),
            tolerance: signal.tolerance.unwrap_or(assumed),
            output,
        }
    }
}
