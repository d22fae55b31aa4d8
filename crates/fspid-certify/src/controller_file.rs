//! The controller of a certificate's loop: radians and supervisor units, nothing left to defaults.

use fspid_core::{
    AntiWindup, Change, ControllerSetting, DeadZone, Derivative, ErrorSign, Fspid, GainCoupling,
    GainLimits, Gains, Guard, InputScale, InputSets, IntegralForm, Law, Limits, Pid, PidConfig,
    ReferenceModel, SecondInput, SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};
use fspid_fuzzy::{
    Defuzzifier, Label, Network, NetworkRow, NumberGrid, NumberTable, OutOfRange, Output,
    RuleTable, Supervisor,
};
use fspid_sim::Controller;
use serde::{Deserialize, Serialize};

/// Most samples of a defuzzifier: its surface is enclosed, and a million of them took 800 MB.
const MOST_SAMPLED: u32 = 10_000;

/// A controller as written.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ControllerFile {
    gains: GainsFile,
    rate_gain_s: f64,
    setpoint_weights: [f64; 2],
    /// Left out where it is zero, as in certificates from before there was one.
    #[serde(default, skip_serializing_if = "is_zero")]
    feedforward: f64,
    derivative_filter_s: f64,
    integral: IntegralFile,
    anti_windup: AntiWindupFile,
    output_limits_rad: Option<Ends>,
    slew_limit_rad_s: Option<f64>,
    sample_guard_rad: f64,
    /// None for fixed gains.
    tuner: Option<TunerFile>,
}

fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

/// Lower and upper end; `null` for an open one.
type Ends = [Option<f64>; 2];

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GainsFile {
    kp: f64,
    ki: f64,
    kd: f64,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum IntegralFile {
    Bumpless,
    Literal,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
enum AntiWindupFile {
    None,
    Clamping { limits_rad: Ends },
    Conditional,
    BackCalculation { tracking_s: f64 },
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TunerFile {
    error_sign: SignFile,
    change: ChangeFile,
    error_per_rad: f64,
    change_per_rad: f64,
    output_scale: GainsFile,
    law: LawFile,
    gain_limits: Option<[Ends; 3]>,
    dead_zone: Option<[f64; 2]>,
    range: f64,
    defuzzifier: String,
    out_of_range: String,
    /// None where rules conclude numbers, and for a network.
    rules: Option<RulesFile>,
    /// What the rules conclude in place of labels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    numbers: Option<NumbersFile>,
    /// What stands in the place of rules.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    network: Option<NetworkFile>,
    /// None for the change of the error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    second_input: Option<SecondInputFile>,
    /// Small and medium centres of the error's sets, shares of the range; none for even ones.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    error_set_centres: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    change_set_centres: Option<[f64; 2]>,
    /// None where nothing follows the gains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    gain_coupling: Option<CouplingFile>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
enum SecondInputFile {
    Rate,
    ModelError { bandwidth_rad_s: f64, damping: f64 },
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CouplingFile {
    setpoint_weight_per_kp: f64,
    rate_gain_per_kd: f64,
}

/// Seven rows of seven numbers for each gain.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct NumbersFile {
    delta_kp: NumberGrid<f64>,
    delta_ki: NumberGrid<f64>,
    delta_kd: NumberGrid<f64>,
}

/// A weight of each hidden unit in each row.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct NetworkFile {
    error: NetworkRow<f64>,
    change: NetworkRow<f64>,
    offset: NetworkRow<f64>,
    delta_kp: NetworkRow<f64>,
    delta_ki: NetworkRow<f64>,
    delta_kd: NetworkRow<f64>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum SignFile {
    SetpointMinusMeasurement,
    MeasurementMinusSetpoint,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ChangeFile {
    Rate,
    Delta,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
enum LawFile {
    Memoryless,
    Accumulating { leakage_per_s: f64 },
}

/// Seven rows of seven labels for each gain, as in the files of rule tables.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RulesFile {
    delta_kp: Vec<String>,
    delta_ki: Vec<String>,
    delta_kd: Vec<String>,
}

fn said<E: std::fmt::Display>(what: &'static str) -> impl Fn(E) -> String {
    move |error| format!("{what}: {error}")
}

fn ends(limits: &Limits<f64>) -> Ends {
    [limits.lower(), limits.upper()].map(|end| end.is_finite().then_some(end))
}

fn limits(what: ControllerSetting, [lower, upper]: Ends) -> Result<Limits<f64>, String> {
    let lower = lower.unwrap_or(f64::NEG_INFINITY);
    let upper = upper.unwrap_or(f64::INFINITY);
    Limits::new(what, lower, upper).map_err(|error| error.to_string())
}

impl GainsFile {
    pub(super) fn of(gains: Gains<f64>) -> Self {
        Self { kp: gains.kp, ki: gains.ki, kd: gains.kd }
    }

    pub(super) fn build(self) -> Gains<f64> {
        Gains { kp: self.kp, ki: self.ki, kd: self.kd }
    }
}

impl ControllerFile {
    pub(super) fn of(controller: &Controller) -> Self {
        let config = controller.config();
        let weights = config.setpoint_weights;
        Self {
            gains: GainsFile::of(controller.nominal()),
            rate_gain_s: config.rate_gain_s,
            setpoint_weights: [weights.proportional, weights.derivative],
            feedforward: config.feedforward,
            derivative_filter_s: config.derivative.filter_s,
            integral: match config.integral {
                IntegralForm::Bumpless => IntegralFile::Bumpless,
                IntegralForm::Literal => IntegralFile::Literal,
            },
            anti_windup: match &config.anti_windup {
                AntiWindup::None => AntiWindupFile::None,
                AntiWindup::Clamping(limits) => {
                    AntiWindupFile::Clamping { limits_rad: ends(limits) }
                }
                AntiWindup::Conditional => AntiWindupFile::Conditional,
                AntiWindup::BackCalculation { tracking_s } => {
                    AntiWindupFile::BackCalculation { tracking_s: *tracking_s }
                }
            },
            output_limits_rad: config.limits.as_ref().map(ends),
            slew_limit_rad_s: config.slew_rad_s,
            sample_guard_rad: config.guard.limit_rad(),
            tuner: match controller {
                Controller::Fixed(_) => None,
                Controller::SelfTuning(fspid) => Some(TunerFile::of(fspid.tuner())),
            },
        }
    }

    pub(super) fn build(&self, dt_s: f64) -> Result<Controller, String> {
        let [proportional, derivative] = self.setpoint_weights;
        let config = PidConfig {
            rate_gain_s: self.rate_gain_s,
            setpoint_weights: SetpointWeights { proportional, derivative },
            feedforward: self.feedforward,
            derivative: Derivative { filter_s: self.derivative_filter_s },
            integral: match self.integral {
                IntegralFile::Bumpless => IntegralForm::Bumpless,
                IntegralFile::Literal => IntegralForm::Literal,
            },
            anti_windup: self.anti_windup.build()?,
            limits: self
                .output_limits_rad
                .map(|ends| limits(ControllerSetting::OutputLimits, ends))
                .transpose()?,
            slew_rad_s: self.slew_limit_rad_s,
            guard: Guard::new(self.sample_guard_rad).map_err(|error| error.to_string())?,
            ..PidConfig::sampled_every(dt_s)
        };
        let gains = self.gains.build();
        match &self.tuner {
            None => {
                Pid::new(gains, config).map(Controller::Fixed).map_err(|error| error.to_string())
            }
            Some(tuner) => Fspid::new(tuner.build(gains)?, config)
                .map(Controller::SelfTuning)
                .map_err(|error| error.to_string()),
        }
    }
}

impl AntiWindupFile {
    fn build(&self) -> Result<AntiWindup<f64>, String> {
        Ok(match *self {
            Self::None => AntiWindup::None,
            Self::Clamping { limits_rad } => {
                AntiWindup::Clamping(limits(ControllerSetting::AntiWindupLimits, limits_rad)?)
            }
            Self::Conditional => AntiWindup::Conditional,
            Self::BackCalculation { tracking_s } => AntiWindup::BackCalculation { tracking_s },
        })
    }
}

impl TunerFile {
    fn of(tuner: &SelfTuner<f64>) -> Self {
        let (settings, supervisor) = (tuner.settings(), tuner.supervisor());
        Self {
            error_sign: match settings.error_sign {
                ErrorSign::SetpointMinusMeasurement => SignFile::SetpointMinusMeasurement,
                ErrorSign::MeasurementMinusSetpoint => SignFile::MeasurementMinusSetpoint,
            },
            change: match settings.change {
                Change::Rate => ChangeFile::Rate,
                Change::Delta => ChangeFile::Delta,
            },
            error_per_rad: settings.input_scale.error_per_rad,
            change_per_rad: settings.input_scale.change_per_rad,
            output_scale: GainsFile::of(settings.output_scale),
            law: match settings.law {
                Law::Memoryless => LawFile::Memoryless,
                Law::Accumulating { leakage_per_s } => LawFile::Accumulating { leakage_per_s },
            },
            gain_limits: settings
                .gain_limits
                .as_ref()
                .map(|limits| [&limits.kp, &limits.ki, &limits.kd].map(ends)),
            dead_zone: settings.dead_zone.map(|zone| [zone.error_rad, zone.change_rad]),
            range: supervisor.range(),
            defuzzifier: supervisor.defuzzifier().to_string(),
            out_of_range: supervisor.out_of_range().name().to_owned(),
            rules: supervisor.table().as_ref().map(RulesFile::of),
            numbers: supervisor.numbers().map(NumbersFile::of),
            network: supervisor.network().map(NetworkFile::of),
            second_input: SecondInputFile::of(settings.second_input),
            error_set_centres: settings.input_sets.error.map(centres),
            change_set_centres: settings.input_sets.change.map(centres),
            gain_coupling: CouplingFile::of(settings.gain_coupling),
        }
    }

    fn build(&self, nominal: Gains<f64>) -> Result<SelfTuner<f64>, String> {
        let settings = TunerSettings {
            error_sign: match self.error_sign {
                SignFile::SetpointMinusMeasurement => ErrorSign::SetpointMinusMeasurement,
                SignFile::MeasurementMinusSetpoint => ErrorSign::MeasurementMinusSetpoint,
            },
            change: match self.change {
                ChangeFile::Rate => Change::Rate,
                ChangeFile::Delta => Change::Delta,
            },
            input_scale: InputScale {
                error_per_rad: self.error_per_rad,
                change_per_rad: self.change_per_rad,
            },
            output_scale: self.output_scale.build(),
            law: match self.law {
                LawFile::Memoryless => Law::Memoryless,
                LawFile::Accumulating { leakage_per_s } => Law::Accumulating { leakage_per_s },
            },
            gain_limits: self.gain_limits.map(gain_limits).transpose()?,
            dead_zone: self
                .dead_zone
                .map(|[error_rad, change_rad]| DeadZone { error_rad, change_rad }),
            second_input: self.second_input.map_or(SecondInput::Change, SecondInputFile::build),
            input_sets: InputSets {
                error: self.error_set_centres.map(set_centres).transpose()?,
                change: self.change_set_centres.map(set_centres).transpose()?,
            },
            gain_coupling: self.gain_coupling.map_or(GainCoupling::NONE, CouplingFile::build),
        };
        SelfTuner::new(nominal, self.supervisor()?, settings).map_err(said("tuner"))
    }

    fn supervisor(&self) -> Result<Supervisor<f64>, String> {
        let policies = OutOfRange::ALL.into_iter();
        let policy = policies.clone().find(|policy| policy.name() == self.out_of_range);
        let policy = policy.ok_or_else(|| {
            let known: Vec<&str> = policies.map(OutOfRange::name).collect();
            format!("out_of_range: \"{}\"; allowed are {}", self.out_of_range, known.join(", "))
        })?;
        let defuzzifier: Defuzzifier = self.defuzzifier.parse().map_err(said("defuzzifier"))?;
        if samples(defuzzifier).is_some_and(|samples| samples > MOST_SAMPLED) {
            return Err(format!(
                "defuzzifier: \"{}\"; allowed are up to {MOST_SAMPLED} samples",
                self.defuzzifier
            ));
        }
        let built = match (&self.rules, &self.numbers, &self.network) {
            (Some(rules), None, None) => {
                Supervisor::new(&rules.build()?, self.range, defuzzifier, policy)
            }
            (None, Some(numbers), None) => {
                Supervisor::of_numbers(&numbers.build()?, self.range, policy)
            }
            (None, None, Some(network)) => {
                Supervisor::of_network(&network.build()?, self.range, policy)
            }
            (None, None, None) => {
                return Err("rules: none, and no numbers or network in their place".to_owned());
            }
            _ => {
                let told = "rules, numbers and network: one of them is what answers";
                return Err(told.to_owned());
            }
        };
        built.map_err(said("supervisor"))
    }
}

/// How many samples a defuzzifier takes; `None` for the exact one.
fn samples(defuzzifier: Defuzzifier) -> Option<u32> {
    match defuzzifier {
        Defuzzifier::Exact => None,
        Defuzzifier::Endpoints(count)
        | Defuzzifier::Midpoint(count)
        | Defuzzifier::Trapezoid(count)
        | Defuzzifier::LeftEnd(count)
        | Defuzzifier::Vertices(count) => Some(count),
    }
}

fn gain_limits([kp, ki, kd]: [Ends; 3]) -> Result<GainLimits<f64>, String> {
    let limits = |ends| limits(ControllerSetting::GainLimits, ends);
    Ok(GainLimits { kp: limits(kp)?, ki: limits(ki)?, kd: limits(kd)? })
}

fn centres(centres: SetCentres<f64>) -> [f64; 2] {
    [centres.small(), centres.medium()]
}

fn set_centres([small, medium]: [f64; 2]) -> Result<SetCentres<f64>, String> {
    SetCentres::new(small, medium).map_err(|error| error.to_string())
}

impl SecondInputFile {
    fn of(second_input: SecondInput<f64>) -> Option<Self> {
        match second_input {
            SecondInput::Change => None,
            SecondInput::Rate => Some(Self::Rate),
            SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping }) => {
                Some(Self::ModelError { bandwidth_rad_s, damping })
            }
        }
    }

    fn build(self) -> SecondInput<f64> {
        match self {
            Self::Rate => SecondInput::Rate,
            Self::ModelError { bandwidth_rad_s, damping } => {
                SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping })
            }
        }
    }
}

impl CouplingFile {
    fn of(coupling: GainCoupling<f64>) -> Option<Self> {
        let GainCoupling { setpoint_weight, rate_gain } = coupling;
        let file = Self { setpoint_weight_per_kp: setpoint_weight, rate_gain_per_kd: rate_gain };
        (coupling != GainCoupling::NONE).then_some(file)
    }

    fn build(self) -> GainCoupling<f64> {
        let Self { setpoint_weight_per_kp, rate_gain_per_kd } = self;
        GainCoupling { setpoint_weight: setpoint_weight_per_kp, rate_gain: rate_gain_per_kd }
    }
}

impl NumbersFile {
    fn of(table: &NumberTable<f64>) -> Self {
        let [delta_kp, delta_ki, delta_kd] = Output::ALL.map(|output| *table.grid(output));
        Self { delta_kp, delta_ki, delta_kd }
    }

    fn build(&self) -> Result<NumberTable<f64>, String> {
        let Self { delta_kp, delta_ki, delta_kd } = self;
        NumberTable::new([*delta_kp, *delta_ki, *delta_kd]).map_err(said("numbers"))
    }
}

impl NetworkFile {
    fn of(network: &Network<f64>) -> Self {
        let [error, change, offset, delta_kp, delta_ki, delta_kd] = *network.rows();
        Self { error, change, offset, delta_kp, delta_ki, delta_kd }
    }

    fn build(&self) -> Result<Network<f64>, String> {
        let Self { error, change, offset, delta_kp, delta_ki, delta_kd } = self;
        let rows = [*error, *change, *offset, *delta_kp, *delta_ki, *delta_kd];
        Network::new(rows).map_err(said("network"))
    }
}

impl RulesFile {
    fn of(table: &RuleTable) -> Self {
        let rows = |output: Output| -> Vec<String> {
            let row = |error: Label| {
                let labels = Label::ALL.map(|change| table.grid(output).at(error, change).name());
                labels.join(" ")
            };
            Label::ALL.map(row).to_vec()
        };
        let [delta_kp, delta_ki, delta_kd] = Output::ALL.map(rows);
        Self { delta_kp, delta_ki, delta_kd }
    }

    fn build(&self) -> Result<RuleTable, String> {
        let texts = [&self.delta_kp, &self.delta_ki, &self.delta_kd].map(|rows| rows.join("\n"));
        RuleTable::parse(texts.each_ref().map(String::as_str)).map_err(said("rules"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_that_conclude_numbers_are_written_with_all_that_they_are_tied_to_and_read_again() {
        let zeros = format!("[{}]", ["[0, 0.5, 0, 0, 0, 0, -1]"; 7].join(", "));
        let numbers = format!(
            "numbers = {{ delta_kp = {zeros}, delta_ki = {zeros}, delta_kd = {zeros} }}\n\
             second_input = \"error-and-model-error\"\n\
             model = {{ bandwidth_rad_s = 2.0, damping = 0.7 }}\n\
             error_set_centres = [0.2, 0.5] #"
        );
        let follows = "gain_coupling = { setpoint_weight_per_kp = 0.1, rate_gain_per_kd = 2.0 }";
        let text = fspid_scenario::file::starter()
            .replace("table = \"mirrored\" ", &numbers)
            .replace("law = \"memoryless\" ", &format!("{follows}\nlaw = \"memoryless\" "));
        let study = fspid_scenario::file::parse(&text, "mine.toml", None, &[]).expect("a scenario");
        let controllers = &study.scenario.controllers;
        let is_tuned = |it: &Controller| matches!(it, Controller::SelfTuning(_));
        let tuned = controllers.iter().find(|it| is_tuned(&it.controller)).expect("one");
        let mut file = ControllerFile::of(&tuned.controller);
        let dt_s = study.scenario.timing.dt_s();
        assert_eq!(file.build(dt_s).as_ref(), Ok(&tuned.controller));
        if let Some(tuner) = &mut file.tuner {
            tuner.numbers = None;
        }
        let told = file.build(dt_s).expect_err("nothing is concluded");
        assert_eq!(told, "rules: none, and no numbers or network in their place");
    }

    #[test]
    fn a_network_is_written_with_its_weights_and_read_again_and_others_are_refused() {
        let rows = ["error", "change", "offset", "delta_kp", "delta_ki", "delta_kd"];
        let rows = rows.map(|row| format!("{row} = [0.5, -1, 0.25, 2, 0.1, 0.3, -0.7, 1]"));
        let network = format!("network = {{ {} }} #", rows.join(", "));
        let text = fspid_scenario::file::starter().replace("table = \"mirrored\" ", &network);
        let study = fspid_scenario::file::parse(&text, "mine.toml", None, &[]).expect("a scenario");
        let controller = &study.scenario.controllers[1].controller;
        let (mut file, dt_s) = (ControllerFile::of(controller), study.scenario.timing.dt_s());
        assert_eq!(file.build(dt_s).as_ref(), Ok(controller));
        let weight = |file: &mut ControllerFile, weight: f64| {
            let network = file.tuner.as_mut().and_then(|tuner| tuner.network.as_mut());
            network.expect("a network").delta_ki[3] = weight;
        };
        weight(&mut file, 1.5);
        assert_ne!(file.build(dt_s).as_ref(), Ok(controller));
        weight(&mut file, -2e6);
        let told = file.build(dt_s).expect_err("too large");
        assert!(
            told.starts_with("network: delta_ki: the weight of unit 4 is -2000000.0"),
            "{told}"
        );
        if let Some(tuner) = &mut file.tuner {
            tuner.numbers = Some(NumbersFile {
                delta_kp: [[0.0; 7]; 7],
                delta_ki: [[0.0; 7]; 7],
                delta_kd: [[0.0; 7]; 7],
            });
        }
        let told = file.build(dt_s).expect_err("two things answer");
        assert_eq!(told, "rules, numbers and network: one of them is what answers");
    }
}
