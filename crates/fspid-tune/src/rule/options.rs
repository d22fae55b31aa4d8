//! What may be asked of a rule.

use fspid_core::PidConfig;
use fspid_numeric::units::DEGREE_RAD;

use super::{Form, Rule, RuleError};

/// Which kind of process a model is fitted to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProcessKind {
    /// Integrating where the plant has a pole at the origin; else the kind that fits better.
    #[default]
    Auto,
    /// A lag: it comes to rest at a steady state.
    Lag,
    /// An integrator: it comes to a steady rate.
    Integrating,
}

impl ProcessKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Lag, Self::Integrating];

    /// Name in options and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Lag => "lag",
            Self::Integrating => "integrating",
        }
    }

    /// The kind with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// Poles that `pole-placement` puts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoleOptions {
    /// Damping of the pair, above 0 and below 1.
    pub damping: f64,
    /// Undamped frequency of the pair, rad/s; if none half the ultimate frequency for `pid`, a fifth for `pi`.
    pub frequency_rad_s: Option<f64>,
    /// Distance of the third pole (`pid`) from the origin over that frequency.
    pub third: f64,
}

/// Weights of the cost of `lqr`, over squares of the command:
/// $J = \sum T (w_e \theta^2 + w_q q^2 + w_I (\int \theta)^2 + w_u u^2)$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LqrOptions {
    /// Of the pitch error, 1/rad².
    pub error: f64,
    /// Of the pitch rate, s²/rad².
    pub rate: f64,
    /// Of the integral of the error, 1/(rad s)².
    pub integral: f64,
    /// Of the command, 1/rad²; above 0.
    pub command: f64,
}

/// The experiment of `autotune-relay`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelayOptions {
    /// Command to either side, rad.
    pub amplitude_rad: f64,
    /// Error at which the relay switches, to either side, rad; 0 for none.
    pub hysteresis_rad: f64,
    /// Longest experiment, s.
    pub longest_s: f64,
    /// Rule for the ultimate point: `ziegler-nichols` or `tyreus-luyben`.
    pub then: Rule,
}

/// What is asked of a rule; a rule reads what concerns it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Terms of the controller; the rule's own default if none.
    pub form: Option<Form>,
    /// Everything of the controller but its gains: limits, anti-windup, set-point weights, rate loop. A plain one if
    /// none. With a rate gain the rule tunes the pitch loop around the closed rate loop.
    pub config: Option<PidConfig<f64>>,
    /// Filter of the derivative: time constant Td/N with this N. Only where the configuration has no filter of its own.
    pub filter_divisor: f64,
    /// Which kind of process a model is fitted to.
    pub process: ProcessKind,
    /// Time constant that the closed loop shall have: tau_c of `simc`, lambda of `lambda`, s. The rule's default if
    /// none.
    pub closed_loop_s: Option<f64>,
    /// Natural frequency of the ITAE polynomial, rad/s; what the dead time allows if none.
    pub itae_rad_s: Option<f64>,
    /// For `pole-placement`.
    pub poles: PoleOptions,
    /// For `lqr`.
    pub lqr: LqrOptions,
    /// For `autotune-relay`.
    pub relay: RelayOptions,
}

impl Default for Options {
    /// A derivative filter of Td/10 (2 to 20 are usual, Åström and Hägglund), poles damped like a Butterworth pair, a
    /// degree of pitch error as dear as a degree of command and as an integral of two degree seconds, a relay of 1 deg
    /// with a hysteresis of a fiftieth of it.
    fn default() -> Self {
        Self {
            form: None,
            config: None,
            filter_divisor: 10.0,
            process: ProcessKind::Auto,
            closed_loop_s: None,
            itae_rad_s: None,
            poles: PoleOptions {
                damping: core::f64::consts::FRAC_1_SQRT_2,
                frequency_rad_s: None,
                third: 1.0,
            },
            lqr: LqrOptions { error: 1.0, rate: 0.0, integral: 0.25, command: 1.0 },
            relay: RelayOptions {
                amplitude_rad: DEGREE_RAD,
                hysteresis_rad: 0.02 * DEGREE_RAD,
                longest_s: 600.0,
                then: Rule::TyreusLuyben,
            },
        }
    }
}

impl Options {
    /// The form, if the rule has it.
    pub(super) fn form_of(&self, rule: Rule) -> Result<Form, RuleError> {
        let by = if rule == Rule::AutotuneRelay { self.relay.then } else { rule };
        let form = self.form.or(by.forms().first().copied()).unwrap_or(Form::Pid);
        if by.forms().contains(&form) {
            return Ok(form);
        }
        let allowed = by.forms().iter().map(|form| form.name()).collect::<Vec<_>>().join(", ");
        Err(RuleError::Form { rule: by.name(), found: form.name(), allowed })
    }

    /// Every number within what is allowed, whether the rule reads it or not.
    pub(super) fn check(&self) -> Result<(), RuleError> {
        const POSITIVE: &str = "a number above 0";
        let above = |what, found: f64| require(what, found, found > 0.0, POSITIVE);
        above("filter_divisor", self.filter_divisor)?;
        for (what, found) in [
            ("closed_loop_s", self.closed_loop_s),
            ("itae_rad_s", self.itae_rad_s),
            ("frequency of the poles, rad/s", self.poles.frequency_rad_s),
        ] {
            found.map_or(Ok(()), |found| above(what, found))?;
        }
        let damping = self.poles.damping;
        require(
            "damping of the poles",
            damping,
            damping > 0.0 && damping < 1.0,
            "above 0 and below 1",
        )?;
        above("third pole over their frequency", self.poles.third)?;
        let LqrOptions { error, rate, integral, command } = self.lqr;
        above("weight of the error", error)?;
        above("weight of the integral", integral)?;
        above("weight of the command", command)?;
        require("weight of the rate", rate, rate >= 0.0, "0 or above")?;
        self.relay.check()
    }
}

impl RelayOptions {
    fn check(&self) -> Result<(), RuleError> {
        const POSITIVE: &str = "a number above 0";
        let (amplitude, hysteresis) = (self.amplitude_rad, self.hysteresis_rad);
        require("amplitude of the relay, rad", amplitude, amplitude > 0.0, POSITIVE)?;
        require("hysteresis of the relay, rad", hysteresis, hysteresis >= 0.0, "0 or above")?;
        let good = self.longest_s > 0.0 && self.longest_s <= 1e5;
        require("longest experiment, s", self.longest_s, good, "above 0, up to 100000")?;
        if matches!(self.then, Rule::ZieglerNichols | Rule::TyreusLuyben) {
            return Ok(());
        }
        Err(RuleError::RelayRule { found: self.then.name() })
    }
}

fn require(
    what: &'static str,
    found: f64,
    good: bool,
    allowed: &'static str,
) -> Result<(), RuleError> {
    // Infinity is above 0, and no number to compute with.
    if good && found.is_finite() { Ok(()) } else { Err(RuleError::Number { what, found, allowed }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_out_of_range_are_refused_by_name() {
        let refused = |change: fn(&mut Options, f64)| {
            for bad in [-1.0, f64::NAN, f64::INFINITY] {
                let mut options = Options::default();
                change(&mut options, bad);
                assert!(matches!(options.check(), Err(RuleError::Number { .. })), "{options:?}");
            }
        };
        assert_eq!(Options::default().check(), Ok(()));
        refused(|options, bad| options.filter_divisor = bad);
        refused(|options, bad| options.closed_loop_s = Some(bad));
        refused(|options, bad| options.itae_rad_s = Some(bad));
        refused(|options, bad| options.poles.damping = bad);
        refused(|options, bad| options.poles.frequency_rad_s = Some(bad));
        refused(|options, bad| options.poles.third = bad);
        refused(|options, bad| options.lqr.command = bad);
        refused(|options, bad| options.lqr.rate = bad);
        refused(|options, bad| options.relay.hysteresis_rad = bad);
        refused(|options, bad| options.relay.longest_s = bad);
        let mut options = Options::default();
        options.relay.then = Rule::Lqr;
        assert_eq!(options.check(), Err(RuleError::RelayRule { found: "lqr" }));
    }

    #[test]
    fn forms_that_a_rule_was_not_published_for_are_refused_with_those_it_was() {
        let options = Options { form: Some(Form::P), ..Options::default() };
        assert_eq!(options.form_of(Rule::ZieglerNichols), Ok(Form::P));
        let refused = options.form_of(Rule::AutotuneRelay).expect_err("not in Tyreus and Luyben");
        let sentence = "tyreus-luyben has no form p; it has pid, pi";
        assert_eq!(refused.to_string(), sentence);
    }
}
