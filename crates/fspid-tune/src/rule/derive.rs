//! From a process to gains, rule by rule.

use fspid_core::{Derivative, Gains, PidConfig, SetpointWeights};
use fspid_sim::Scenario;

use super::formula::{self, Computed};
use super::isa::Isa;
use super::model::{Fit, FittedModel, Model};
use super::process::Process;
use super::ultimate::UltimatePoint;
use super::{
    Derived, Form, Given, Identified, Options, ProcessKind, Rule, RuleError, lqr, place, relay,
};

/// Frequency of placed poles over the ultimate frequency, unless another is asked for. Without a derivative nothing
/// damps a pair near the short period: two gains can only hold a slow one.
const POLES: f64 = 0.5;
const POLES_PI: f64 = 0.2;
/// Filter of the derivative of placed poles over their period per radian: the filter is in the equations, so that it
/// has to be known before the gains.
const PLACED_FILTER: f64 = 0.1;

/// A process, its ultimate point if there is one, and what is asked.
struct Work<'a> {
    scenario: &'a Scenario,
    process: Process,
    ultimate: Result<UltimatePoint, RuleError>,
    rule: Rule,
    form: Form,
    options: &'a Options,
}

pub(super) fn derive(
    scenario: &Scenario,
    rule: Rule,
    options: &Options,
) -> Result<Derived, RuleError> {
    let form = options.form_of(rule)?;
    let mut own = *options;
    if rule == Rule::Lqr {
        // It gives the rate gain itself, for a plant without one.
        own.config = own.config.map(|config| PidConfig { rate_gain_s: 0.0, ..config });
    }
    let process = Process::of(scenario, &own)?;
    process.require_sign()?;
    let ultimate = UltimatePoint::of(&process);
    let work = Work { scenario, process, ultimate, rule, form, options };
    match rule {
        Rule::ZieglerNichols | Rule::TyreusLuyben => work.by_ultimate_point(),
        Rule::Simc | Rule::Lambda | Rule::Amigo | Rule::Itae => work.by_model(),
        Rule::PolePlacement => work.by_poles(),
        Rule::Lqr => work.by_cost(),
        Rule::AutotuneRelay => work.by_relay(),
    }
}

impl Work<'_> {
    fn by_ultimate_point(self) -> Result<Derived, RuleError> {
        let ultimate = self.ultimate.clone()?;
        let warnings = ultimate.warnings(&self.process);
        let given = by_ultimate(self.rule, &ultimate, self.form);
        let identified = Identified { ultimate: Some(ultimate), ..Identified::default() };
        self.finished(given, identified, warnings)
    }

    fn by_relay(self) -> Result<Derived, RuleError> {
        let exact = self.ultimate.clone().ok();
        let experiment = relay::experiment(self.scenario, self.options.relay)?;
        let mut warnings = experiment.warnings(self.scenario, exact.as_ref());
        warnings.extend(experiment.ultimate.warnings(&self.process));
        let given = by_ultimate(self.options.relay.then, &experiment.ultimate, self.form);
        let relay = Some(experiment);
        let identified = Identified { ultimate: exact, relay, ..Identified::default() };
        self.finished(given, identified, warnings)
    }

    fn by_model(self) -> Result<Derived, RuleError> {
        self.process.require_model(self.rule.name())?;
        let ultimate = self.ultimate.clone()?;
        let fitted = self.fitted(&ultimate)?;
        let mut warnings = ultimate.warnings(&self.process);
        warnings.extend(fitted.warnings());
        let (model, asked) = (&fitted.model, self.options.closed_loop_s);
        let given = match (self.rule, model) {
            (Rule::Simc, _) => formula::simc(model, asked),
            (Rule::Lambda, _) => formula::lambda(model, self.form, asked),
            (Rule::Amigo, _) => formula::amigo(model, self.form),
            (_, Model::Lag { gain, time_s, dead_s }) => {
                formula::rovira([*gain, *time_s, *dead_s], self.form)
            }
            _ => formula::graham_lathrop(model, self.form, self.options.itae_rad_s),
        };
        if self.rule == Rule::Simc && self.form == Form::Pid && given.isa.td_s == 0.0 {
            warnings.push(
                "no second time constant fits the process: these are the gains of the pi rule"
                    .to_owned(),
            );
        }
        let (ultimate, model) = (Some(ultimate), Some(fitted));
        let identified = Identified { ultimate, model, ..Identified::default() };
        self.finished(given, identified, warnings)
    }

    /// The model that the rule uses.
    fn fitted(&self, ultimate: &UltimatePoint) -> Result<FittedModel, RuleError> {
        let (fit, kind) = (Fit::of(&self.process, ultimate), self.options.process);
        let first = || fit.first_order(kind);
        match (self.rule, self.form) {
            (Rule::Simc, Form::Pid) => fit.second_order(kind),
            // The polynomial of third order needs the second time constant; a lag is Rovira's.
            (Rule::Itae, Form::Pid) => match first()? {
                FittedModel { model: Model::Integrator { .. }, .. } => {
                    fit.second_order(ProcessKind::Integrating)
                }
                lag => Ok(lag),
            },
            _ => first(),
        }
    }

    fn by_poles(self) -> Result<Derived, RuleError> {
        let omega = match (self.options.poles.frequency_rad_s, &self.ultimate) {
            (Some(omega), _) => omega,
            (None, Ok(ultimate)) => {
                let share = if self.form == Form::Pid { POLES } else { POLES_PI };
                share * ultimate.frequency_rad_s()
            }
            (None, Err(error)) => return Err(error.clone()),
        };
        let base = self.process.config;
        let own = base.derivative.filter_s;
        let filter_s = if own > 0.0 { own } else { PLACED_FILTER / omega };
        let (gains, poles) =
            place::placed(&self.process, self.options.poles, self.form, omega, filter_s)?;
        let filtered = self.form == Form::Pid && own == 0.0;
        let filter_s = if filtered { filter_s } else { own };
        let config = PidConfig {
            // No zero of the controller in the answer to the set-point: the poles alone shape it.
            setpoint_weights: SetpointWeights { proportional: 0.0, derivative: 0.0 },
            derivative: Derivative { filter_s },
            ..base
        };
        let given = Given { setpoint_weights: true, derivative_filter: filtered, rate_gain: false };
        let ultimate = self.ultimate.ok();
        let identified = Identified { ultimate, poles: Some(poles), ..Identified::default() };
        let formula = "C(z) P(z) = -1 at each of the poles".to_owned();
        let warnings = Vec::new();
        Ok(Derived { form: self.form, gains, config, given, identified, formula, warnings })
    }

    fn by_cost(self) -> Result<Derived, RuleError> {
        let weights = self.options.lqr;
        let ultimate = self.ultimate.as_ref().ok().copied();
        let fitted = match ultimate.as_ref() {
            Some(point) => {
                Some(Fit::of(&self.process, point).second_order(ProcessKind::Integrating)?)
            }
            None => None,
        };
        let mut starts = Vec::new();
        if let Some(fitted) = &fitted {
            starts.push(lqr::state_feedback(&fitted.model, weights)?);
        }
        starts.extend(ultimate.map(|point| lqr::calm_start(point.gain)));
        starts.extend(lqr::damped_starts());
        let ([kp, ki, rate_gain_s], search) = lqr::least_cost(&self.process, weights, &starts)?;
        let config = PidConfig {
            rate_gain_s,
            // The set-point enters through the integral alone, as in state feedback with an integral.
            setpoint_weights: SetpointWeights { proportional: 0.0, derivative: 0.0 },
            ..self.process.config
        };
        let given = Given { setpoint_weights: true, derivative_filter: false, rate_gain: true };
        let search = Some(search);
        let identified = Identified { ultimate, model: fitted, search, ..Identified::default() };
        let formula = format!(
            "least sum of T ({} theta^2 + {} q^2 + {} (int theta)^2 + {} u^2) after a pitch error of 1 rad",
            weights.error, weights.rate, weights.integral, weights.command
        );
        let (gains, warnings) = (Gains { kp, ki, kd: 0.0 }, Vec::new());
        Ok(Derived { form: self.form, gains, config, given, identified, formula, warnings })
    }

    /// Gains of a formula, with set-point weight and filter.
    fn finished(
        self,
        given: Computed,
        identified: Identified,
        mut warnings: Vec<String>,
    ) -> Result<Derived, RuleError> {
        warnings.extend(given.warnings);
        let base = self.process.config;
        let Isa { td_s, .. } = given.isa;
        let filtered = td_s > 0.0 && base.derivative.filter_s == 0.0;
        let derivative = if filtered {
            Derivative::from_isa(td_s, self.options.filter_divisor)?
        } else {
            base.derivative
        };
        let setpoint_weights = match given.setpoint_weight {
            // Where a rule weighs the set-point, its derivative acts on the measurement.
            Some(proportional) => SetpointWeights { proportional, derivative: 0.0 },
            None => base.setpoint_weights,
        };
        Ok(Derived {
            form: self.form,
            gains: given.isa.gains()?,
            config: PidConfig { setpoint_weights, derivative, ..base },
            given: Given {
                setpoint_weights: given.setpoint_weight.is_some(),
                derivative_filter: filtered,
                rate_gain: false,
            },
            identified,
            formula: given.formula.to_owned(),
            warnings,
        })
    }
}

fn by_ultimate(rule: Rule, point: &UltimatePoint, form: Form) -> Computed {
    match rule {
        Rule::ZieglerNichols => formula::ziegler_nichols(point, form),
        _ => formula::tyreus_luyben(point, form),
    }
}
