//! A controller's sample, and what a small change of what it sees and remembers makes of it.

use fspid_core::{AntiWindup, Faults, Gains, IntegralForm, PidConfig, Sample, State};

use super::gains::GainSlopes;
use crate::controller::Controller;

/// Faults that hold the command and the whole memory.
const HOLDING: [Faults; 3] = [Faults::NOT_FINITE, Faults::IMPLAUSIBLE, Faults::OVERFLOW];

/// What cut the command of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// Nothing.
    Free,
    /// A limit: it does not move.
    Limit,
    /// The slew limit: it moves with the last command.
    Slew,
}

/// What a controller did at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Done {
    pub(super) error_rad: f64,
    /// Since the last good sample; 0 at the first.
    pub(super) change_rad: f64,
    /// There was a good sample before.
    pub(super) has_last: bool,
    pub(super) gains: Gains<f64>,
    /// Set-point, weighted, less measurement, rad.
    proportional_rad: f64,
    derivative_rad_s: f64,
    /// Memory of the integral with this sample's error in it.
    wound: f64,
    /// Command before the limits less that behind them, rad.
    excess_rad: f64,
    pub(super) cut: Cut,
    /// The sample was not used: command and memory stood still.
    pub(super) held: bool,
    /// The supervisor refused its inputs: the gains stood still.
    pub(super) gains_held: bool,
}

/// A controller that is flown beside the one of the flight, bit for bit, and looked into.
pub(super) struct Twin<'a> {
    controller: &'a Controller,
    memory: State<f64>,
    last_error_rad: Option<f64>,
}

impl<'a> Twin<'a> {
    pub(super) fn new(controller: &'a Controller) -> Self {
        Self { controller, memory: State::new(), last_error_rad: None }
    }

    pub(super) fn step(&mut self, sample: Sample<f64>) -> Done {
        let before = self.memory;
        // Faults of this sample only.
        self.memory.take_faults();
        let step = self.controller.step(&mut self.memory, sample);
        let (config, gains) = (self.controller.config(), step.gains);
        let held = HOLDING.iter().any(|fault| step.faults.contains(*fault));
        let error_rad = sample.setpoint_rad - sample.measurement_rad;
        let wound = before.integral()
            + match config.integral {
                IntegralForm::Bumpless => gains.ki * error_rad * config.dt_s,
                IntegralForm::Literal => error_rad,
            };
        let weight = config.setpoint_weights.proportional;
        let mut done = Done {
            error_rad,
            change_rad: self.last_error_rad.map_or(0.0, |last_rad| error_rad - last_rad),
            has_last: self.last_error_rad.is_some(),
            gains,
            proportional_rad: weight * sample.setpoint_rad - sample.measurement_rad,
            derivative_rad_s: self.memory.derivative_rad_s(),
            wound,
            excess_rad: 0.0,
            cut: cut(config, step.saturated, step.command_rad),
            held,
            gains_held: step.faults.contains(Faults::OUT_OF_RANGE),
        };
        if step.saturated {
            done.excess_rad = done.free_rad(config, sample.rate_rad_s) - step.command_rad;
        }
        if !held {
            self.last_error_rad = Some(error_rad);
        }
        done
    }
}

/// Which limit cut a command.
#[allow(clippy::float_cmp, reason = "a command that a limit cut is the limit itself")]
fn cut(config: &PidConfig<f64>, saturated: bool, command_rad: f64) -> Cut {
    let at_limit = config
        .limits
        .is_some_and(|limits| command_rad == limits.lower() || command_rad == limits.upper());
    match (saturated, at_limit) {
        (false, _) => Cut::Free,
        (true, true) => Cut::Limit,
        (true, false) => Cut::Slew,
    }
}

/// Where the controller's memory stands in the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Places {
    pub(super) integral: Option<usize>,
    pub(super) derivative: Option<usize>,
    pub(super) previous: Option<usize>,
    pub(super) last_command: Option<usize>,
    /// The first of the three gains.
    pub(super) gains: Option<usize>,
    /// All states.
    pub(super) size: usize,
}

impl Places {
    fn zeros(&self) -> Vec<f64> {
        vec![0.0; self.size]
    }

    /// The row of one state; zeros of one that is not there.
    fn unit(&self, place: Option<usize>) -> Vec<f64> {
        let mut row = self.zeros();
        if let Some(entry) = place.and_then(|place| row.get_mut(place)) {
            *entry = 1.0;
        }
        row
    }

    /// Everything stands still.
    fn held(&self) -> Rows {
        let one = [self.integral, self.derivative, self.previous, self.last_command];
        let gains = self.gains.into_iter().flat_map(|first| first..first + 3);
        let all = one.into_iter().flatten().chain(gains);
        let memory = all.map(|place| (place, self.unit(Some(place)))).collect();
        Rows { command: self.unit(self.last_command), memory }
    }
}

/// Rows from the state before a sample to what the controller makes of it.
pub(super) struct Rows {
    pub(super) command: Vec<f64>,
    /// Next memory, each with its place.
    pub(super) memory: Vec<(usize, Vec<f64>)>,
}

/// Rows over the whole state that enter a controller.
pub(super) struct Inputs<'a> {
    /// Seen pitch and seen rate by state.
    pub(super) pitch: &'a [f64],
    pub(super) rate: &'a [f64],
    pub(super) slopes: GainSlopes,
}

impl Done {
    /// The command before any limit, rad.
    fn free_rad(&self, config: &PidConfig<f64>, rate_rad_s: f64) -> f64 {
        let rate_rad_s = if config.rate_gain_s == 0.0 { 0.0 } else { rate_rad_s };
        self.gains.kp * self.proportional_rad
            + self.term_rad(config).0
            + self.gains.kd * self.derivative_rad_s
            - config.rate_gain_s * rate_rad_s
    }

    /// The integral's term of the command, rad, and whether its own limits hold it.
    fn term_rad(&self, config: &PidConfig<f64>) -> (f64, bool) {
        let term_rad = match config.integral {
            IntegralForm::Bumpless => self.wound,
            IntegralForm::Literal => self.gains.ki * config.dt_s * self.wound,
        };
        match config.anti_windup {
            AntiWindup::Clamping(limits) => {
                let kept_rad = limits.clamp(term_rad);
                (kept_rad, (kept_rad - term_rad).abs() > 0.0)
            }
            _ => (term_rad, false),
        }
    }

    /// The small-signal equations of `PidConfig::step`: with $e = -y$ and gains that move,
    ///
    /// $$ \partial u = k_p \partial e + p \partial k_p + \partial I + k_d \partial d +
    /// d \partial k_d - K_r \partial q $$
    /// $$ \partial I = \partial I_{k-1} + T (k_i \partial e + e \partial k_i) $$
    ///
    /// (bumpless; of the literal form $\partial I = T (k_i \partial S + S \partial k_i)$), p being
    /// what the proportional term acts on. A command that is cut moves with its limit, and the memory
    /// as the anti-windup moves it.
    pub(super) fn rows(
        &self,
        config: &PidConfig<f64>,
        places: &Places,
        inputs: &Inputs<'_>,
    ) -> Rows {
        if self.held {
            return places.held();
        }
        let error = scaled(inputs.pitch, -1.0);
        let change = match (self.has_last, places.previous) {
            (true, Some(_)) => sum(&[(1.0, &error), (-1.0, &places.unit(places.previous))]),
            _ => places.zeros(),
        };
        let gains = self.gain_rows(places, inputs, (&error, &change));
        let [by_kp, by_ki, by_kd] = &gains;
        let time_s = config.derivative.filter_s + config.dt_s;
        let derivative = match self.has_last {
            true => sum(&[
                (config.derivative.filter_s / time_s, &places.unit(places.derivative)),
                (1.0 / time_s, &change),
            ]),
            false => places.zeros(),
        };
        let before = places.unit(places.integral);
        let (wound, term) = self.integral_rows(config, (&error, by_ki), &before);
        let free = sum(&[
            (self.gains.kp, &error),
            (1.0, &term),
            (self.gains.kd, &derivative),
            (-config.rate_gain_s, inputs.rate),
            (self.proportional_rad, by_kp),
            (self.derivative_rad_s, by_kd),
        ]);
        let command = match self.cut {
            Cut::Free => free.clone(),
            Cut::Limit => places.zeros(),
            Cut::Slew => places.unit(places.last_command),
        };
        let excess = sum(&[(1.0, &free), (-1.0, &command)]);
        let kept = self.unwound_row(config, (&before, &wound), (&excess, by_ki));
        let mut memory = Vec::new();
        memory.extend(places.integral.map(|place| (place, kept)));
        memory.extend(places.derivative.map(|place| (place, derivative)));
        memory.extend(places.previous.map(|place| (place, error)));
        memory.extend(places.last_command.map(|place| (place, command.clone())));
        memory.extend(places.gains.into_iter().flat_map(|first| first..).zip(gains));
        Rows { command, memory }
    }

    /// Rows of the three gains.
    fn gain_rows(
        &self,
        places: &Places,
        inputs: &Inputs<'_>,
        (error, change): (&[f64], &[f64]),
    ) -> [Vec<f64>; 3] {
        let slopes = if self.gains_held { GainSlopes::HELD } else { inputs.slopes };
        std::array::from_fn(|gain| {
            let last = places.unit(places.gains.map(|first| first + gain));
            sum(&[
                (slopes.by_error[gain], error),
                (slopes.by_change[gain], change),
                (slopes.by_gain[gain], &last),
            ])
        })
    }

    /// Rows of the integral's memory with this sample in it, and of its term.
    fn integral_rows(
        &self,
        config: &PidConfig<f64>,
        (error, by_ki): (&[f64], &[f64]),
        before: &[f64],
    ) -> (Vec<f64>, Vec<f64>) {
        let (dt_s, ki) = (config.dt_s, self.gains.ki);
        let (wound, term) = match config.integral {
            IntegralForm::Bumpless => {
                let wound =
                    sum(&[(1.0, before), (ki * dt_s, error), (self.error_rad * dt_s, by_ki)]);
                (wound.clone(), wound)
            }
            IntegralForm::Literal => {
                let wound = sum(&[(1.0, before), (1.0, error)]);
                let term = sum(&[(ki * dt_s, &wound), (dt_s * self.wound, by_ki)]);
                (wound, term)
            }
        };
        let (_, clamped) = self.term_rad(config);
        (wound, if clamped { vec![0.0; term.len()] } else { term })
    }

    /// Row of the memory that is kept, as `Integrator::unwound` keeps it.
    fn unwound_row(
        &self,
        config: &PidConfig<f64>,
        (before, wound): (&[f64], &[f64]),
        (excess, by_ki): (&[f64], &[f64]),
    ) -> Vec<f64> {
        let (dt_s, ki) = (config.dt_s, self.gains.ki);
        match config.anti_windup {
            AntiWindup::None => wound.to_vec(),
            AntiWindup::Clamping(_) => match (self.term_rad(config), config.integral) {
                ((_, false), _) => wound.to_vec(),
                ((_, true), IntegralForm::Bumpless) => vec![0.0; wound.len()],
                // The memory is the limit over ki T.
                ((kept_rad, true), IntegralForm::Literal) => {
                    finite(scaled(by_ki, -kept_rad / (ki * ki * dt_s)), wound)
                }
            },
            AntiWindup::Conditional => {
                let drive = ki * self.error_rad;
                let further_out = (self.excess_rad > 0.0 && drive > 0.0)
                    || (self.excess_rad < 0.0 && drive < 0.0);
                if further_out { before.to_vec() } else { wound.to_vec() }
            }
            AntiWindup::BackCalculation { .. } if ki == 0.0 => wound.to_vec(),
            AntiWindup::BackCalculation { tracking_s } => match config.integral {
                IntegralForm::Bumpless => sum(&[(1.0, wound), (-dt_s / tracking_s, excess)]),
                IntegralForm::Literal => {
                    let by_excess = -1.0 / (ki * tracking_s);
                    let by_gain = self.excess_rad / (ki * ki * tracking_s);
                    finite(sum(&[(1.0, wound), (by_excess, excess), (by_gain, by_ki)]), wound)
                }
            },
        }
    }

    /// True where nothing but the linear controller with these gains acted.
    pub(super) fn is_free(&self, config: &PidConfig<f64>) -> bool {
        self.cut == Cut::Free && !self.held && !self.gains_held && !self.term_rad(config).1
    }
}

/// The first row, or the second where a gain was too small for the first to be finite.
fn finite(row: Vec<f64>, otherwise: &[f64]) -> Vec<f64> {
    if row.iter().all(|entry| entry.is_finite()) { row } else { otherwise.to_vec() }
}

fn scaled(row: &[f64], by: f64) -> Vec<f64> {
    row.iter().map(|entry| by * entry).collect()
}

/// A sum of rows with factors; a factor of 0 adds nothing.
fn sum(terms: &[(f64, &[f64])]) -> Vec<f64> {
    let size = terms.first().map_or(0, |(_, row)| row.len());
    let mut total = vec![0.0; size];
    for (factor, row) in terms {
        if *factor != 0.0 {
            for (entry, value) in total.iter_mut().zip(*row) {
                *entry += factor * value;
            }
        }
    }
    total
}
