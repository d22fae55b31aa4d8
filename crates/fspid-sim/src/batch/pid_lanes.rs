//! The controllers of all lanes.

use fspid_core::{AntiWindup, Faults, GainCoupling, Gains, IntegralForm, PidConfig, Sample, Step};
use fspid_numeric::InstructionSet;

use super::gains::SelfTuners;
use super::lane::{Lanes, Mask, NO, YES, all, limited, mask, numbers};
use super::memory::Memories;
use super::refusal::Refusal;
use crate::controller::Controller;

/// Numbers up to this are far from overflow: products and quotients that a sample makes of them stay
/// below the bounds at which a single controller holds its output (above 10²⁸⁹). Beyond it a lane is
/// answered by a single controller.
pub(super) const FAR: f64 = 1e200;

numbers! {
    /// One flight's numbers of a controller.
    PidLane,
    /// Those of all lanes.
    PidLanes:
    dt_s,
    rate_gain_s,
    /// 1 where the pitch rate is used, else 0.
    uses_rate,
    /// Set-point weights.
    proportional,
    derivative,
    /// What follows the gains, by how much per unit.
    weight_per_kp,
    rate_gain_per_kd,
    filter_s,
    /// Filter and sample period together.
    filter_and_dt_s,
    lower_rad,
    upper_rad,
    /// Largest change of the command in a sample.
    slew_rad,
    guard_rad,
    /// Largest error whose rate is not far.
    steep_rad,
    /// Limits of the integral term.
    term_lower_rad,
    term_upper_rad,
    tracking_s,
    fixed_kp,
    fixed_ki,
    fixed_kd,
}

impl PidLane {
    /// One that answers zeros by zeros.
    const PARKED: Self = Self {
        dt_s: 1.0,
        rate_gain_s: 0.0,
        uses_rate: 0.0,
        proportional: 1.0,
        derivative: 1.0,
        weight_per_kp: 0.0,
        rate_gain_per_kd: 0.0,
        filter_s: 0.0,
        filter_and_dt_s: 1.0,
        lower_rad: f64::NEG_INFINITY,
        upper_rad: f64::INFINITY,
        slew_rad: f64::INFINITY,
        guard_rad: FAR,
        steep_rad: FAR,
        term_lower_rad: f64::NEG_INFINITY,
        term_upper_rad: f64::INFINITY,
        tracking_s: 1.0,
        fixed_kp: 0.0,
        fixed_ki: 0.0,
        fixed_kd: 0.0,
    };

    fn new(controller: &Controller) -> Self {
        let (config, gains) = (controller.config(), controller.nominal());
        let filter_s = config.derivative.filter_s;
        let mut one = Self {
            dt_s: config.dt_s,
            rate_gain_s: config.rate_gain_s,
            uses_rate: if controller.uses_rate() { 1.0 } else { 0.0 },
            proportional: config.setpoint_weights.proportional,
            derivative: config.setpoint_weights.derivative,
            filter_s,
            filter_and_dt_s: filter_s + config.dt_s,
            guard_rad: config.guard.limit_rad(),
            steep_rad: FAR * config.dt_s.min(1.0),
            fixed_kp: gains.kp,
            fixed_ki: gains.ki,
            fixed_kd: gains.kd,
            ..Self::PARKED
        };
        if let Controller::SelfTuning(fspid) = controller {
            let gain_coupling = fspid.tuner().settings().gain_coupling;
            one.weight_per_kp = gain_coupling.setpoint_weight;
            one.rate_gain_per_kd = gain_coupling.rate_gain;
        }
        if let Some(limits) = config.limits {
            (one.lower_rad, one.upper_rad) = (limits.lower(), limits.upper());
        }
        if let Some(slew_rad_s) = config.slew_rad_s {
            one.slew_rad = slew_rad_s * config.dt_s;
        }
        match config.anti_windup {
            AntiWindup::Clamping(limits) => {
                (one.term_lower_rad, one.term_upper_rad) = (limits.lower(), limits.upper());
            }
            AntiWindup::BackCalculation { tracking_s } => one.tracking_s = tracking_s,
            AntiWindup::None | AntiWindup::Conditional => {}
        }
        one
    }
}

/// What all lanes see at a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples<'a, const W: usize> {
    pub(super) setpoint_rad: &'a Lanes<W>,
    pub(super) measurement_rad: &'a Lanes<W>,
    pub(super) rate_rad_s: &'a Lanes<W>,
}

impl<const W: usize> Samples<'_, W> {
    fn of(&self, lane: usize) -> Sample<f64> {
        Sample {
            setpoint_rad: self.setpoint_rad[lane],
            measurement_rad: self.measurement_rad[lane],
            rate_rad_s: self.rate_rad_s[lane],
        }
    }
}

/// What all lanes answer to it, as [`Step`].
#[derive(Clone, Debug)]
pub(super) struct Steps<const W: usize> {
    pub(super) command_rad: Lanes<W>,
    pub(super) gains: [Lanes<W>; 3],
    pub(super) saturated: Mask<W>,
    pub(super) faults: [Faults; W],
}

/// The controllers of all lanes and their memories.
#[derive(Clone, Debug)]
pub(super) struct Controllers<'a, const W: usize> {
    singles: Vec<&'a Controller>,
    numbers: PidLanes<W>,
    form: IntegralForm,
    /// Whose numbers mean nothing.
    anti_windup: AntiWindup<f64>,
    tuners: Option<SelfTuners<W>>,
    /// Whether something follows the gains in some lane.
    follows: bool,
    memories: Memories<W>,
    next: Memories<W>,
    pub(super) steps: Steps<W>,
}

impl<'a, const W: usize> Controllers<'a, W> {
    pub(super) fn new(
        singles: Vec<&'a Controller>,
        instructions: InstructionSet,
    ) -> Result<Self, Refusal> {
        let first = singles.first().map(|controller| *controller.config());
        let first = first.unwrap_or_else(|| PidConfig::sampled_every(1.0));
        let tuners = singles.first().and_then(|controller| match controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => Some(SelfTuners::new(fspid.tuner(), instructions)),
        });
        let mut all = Self {
            numbers: PidLanes::same(PidLane::PARKED),
            form: first.integral,
            anti_windup: first.anti_windup,
            tuners,
            follows: false,
            memories: Memories::at_rest(),
            next: Memories::at_rest(),
            steps: Steps {
                command_rad: [0.0; W],
                gains: [[0.0; W]; 3],
                saturated: [NO; W],
                faults: [Faults::NONE; W],
            },
            singles,
        };
        for lane in 0..all.singles.len() {
            all.load(lane)?;
        }
        Ok(all)
    }

    fn load(&mut self, lane: usize) -> Result<(), Refusal> {
        let differs = |what| Refusal::Differs { flight: lane, what };
        let controller = self.singles[lane];
        let config = controller.config();
        if config.integral != self.form {
            return Err(differs("the form of its integral"));
        }
        if std::mem::discriminant(&config.anti_windup) != std::mem::discriminant(&self.anti_windup)
        {
            return Err(differs("its anti-windup"));
        }
        match (controller, &mut self.tuners) {
            (Controller::Fixed(_), None) => {}
            (Controller::SelfTuning(fspid), Some(tuners)) => {
                if let Some(what) = tuners.difference(fspid.tuner()) {
                    return Err(differs(what));
                }
                tuners.load(lane, fspid.tuner(), config.dt_s);
                self.follows |= fspid.tuner().settings().gain_coupling != GainCoupling::NONE;
            }
            _ => return Err(differs("its kind of controller")),
        }
        self.numbers.set(lane, PidLane::new(controller));
        self.memories.has_previous[lane] = NO;
        Ok(())
    }

    /// Makes a lane one that answers zeros by zeros.
    pub(super) fn park(&mut self, lane: usize) {
        self.numbers.set(lane, PidLane::PARKED);
        if let Some(tuners) = &mut self.tuners {
            tuners.park(lane);
        }
        let mut rest = Memories::<1>::at_rest().state(0);
        rest.faults = Faults::NONE;
        self.memories.set(lane, &rest);
    }

    /// One sample, as [`Controller::step`] in each lane.
    #[inline(always)]
    pub(super) fn step(&mut self, samples: Samples<'_, W>) {
        let (mut plain, error_rad) = self.admitted(samples);
        let gains = match &self.tuners {
            None => [self.numbers.fixed_kp, self.numbers.fixed_ki, self.numbers.fixed_kd],
            Some(tuners) => tuners.gains(&self.memories, samples, &error_rad, &mut plain),
        };
        self.regulate(samples, &error_rad, gains, &mut plain);
        if let Some(tuners) = &self.tuners {
            tuners.advance(&self.memories, samples, &mut self.next, &mut plain);
        }
        self.steps.command_rad = self.next.command_rad;
        self.steps.gains = self.next.gains;
        if !all(&plain) {
            self.step_one_by_one(samples, &plain);
        }
        std::mem::swap(&mut self.memories, &mut self.next);
    }

    /// The errors, and which lanes can be answered side by side.
    #[inline(always)]
    fn admitted(&self, samples: Samples<'_, W>) -> (Mask<W>, Lanes<W>) {
        let n = &self.numbers;
        let (mut plain, mut error_rad) = (self.memories.has_previous, [0.0; W]);
        for lane in 0..W {
            let setpoint_rad = samples.setpoint_rad[lane];
            let measurement_rad = samples.measurement_rad[lane];
            let rate_rad_s = used_rate(n.uses_rate[lane], samples.rate_rad_s[lane]);
            error_rad[lane] = setpoint_rad - measurement_rad;
            let believed = (setpoint_rad.abs() <= n.guard_rad[lane])
                & (measurement_rad.abs() <= n.guard_rad[lane])
                & (rate_rad_s.abs() <= n.guard_rad[lane])
                & (error_rad[lane].abs() <= n.steep_rad[lane]);
            plain[lane] &= mask(believed);
        }
        (plain, error_rad)
    }

    /// As `PidConfig::step`, into the next memories; strikes lanes out of `plain` that come near overflow.
    #[inline(always)]
    fn regulate(
        &mut self,
        samples: Samples<'_, W>,
        error_rad: &Lanes<W>,
        gains: [Lanes<W>; 3],
        plain: &mut Mask<W>,
    ) {
        let (n, before, next) = (&self.numbers, &self.memories, &mut self.next);
        let [kp, ki, kd] = &gains;
        let (mut weight, mut rate_gain_s) = (n.proportional, n.rate_gain_s);
        if self.follows {
            for lane in 0..W {
                weight[lane] += n.weight_per_kp[lane] * (kp[lane] - n.fixed_kp[lane]);
                rate_gain_s[lane] += n.rate_gain_per_kd[lane] * (kd[lane] - n.fixed_kd[lane]);
            }
        }
        let wound = wound(self.form, before, ki, error_rad, &n.dt_s);
        let mut term_rad = unclamped(self.form, ki, &wound, &n.dt_s);
        if matches!(self.anti_windup, AntiWindup::Clamping(_)) {
            for lane in 0..W {
                term_rad[lane] =
                    limited(term_rad[lane], n.term_lower_rad[lane], n.term_upper_rad[lane]);
            }
        }
        let mut excess_rad = [0.0; W];
        for lane in 0..W {
            let setpoint_rad = samples.setpoint_rad[lane];
            let measurement_rad = samples.measurement_rad[lane];
            let rate_rad_s = used_rate(n.uses_rate[lane], samples.rate_rad_s[lane]);
            let proportional_rad = kp[lane] * (weight[lane] * setpoint_rad - measurement_rad);
            let input_rad = n.derivative[lane] * setpoint_rad - measurement_rad;
            let difference_rad = input_rad - before.derivative_input_rad[lane];
            let derivative_rad_s = (n.filter_s[lane] * before.derivative_rad_s[lane]
                + difference_rad)
                / n.filter_and_dt_s[lane];
            let free_rad = proportional_rad + term_rad[lane] + kd[lane] * derivative_rad_s
                - rate_gain_s[lane] * rate_rad_s;
            let (last_rad, slew_rad) = (before.command_rad[lane], n.slew_rad[lane]);
            let slewed_rad = limited(free_rad, last_rad - slew_rad, last_rad + slew_rad);
            let command_rad = limited(slewed_rad, n.lower_rad[lane], n.upper_rad[lane]);
            excess_rad[lane] = free_rad - command_rad;
            let clear = (input_rad.abs() <= n.steep_rad[lane])
                & (free_rad.abs() <= FAR)
                & (wound[lane].abs() <= FAR);
            plain[lane] &= mask(clear);
            next.command_rad[lane] = command_rad;
            next.derivative_rad_s[lane] = derivative_rad_s;
            next.derivative_input_rad[lane] = input_rad;
            self.steps.saturated[lane] = mask(excess_rad[lane] != 0.0);
        }
        next.error_rad = *error_rad;
        next.integral = wound;
        self.unwind(ki, &excess_rad, plain);
        self.next.gains = gains;
        self.next.has_previous = self.memories.has_previous;
        self.next.faults = self.memories.faults;
        self.steps.faults = self.memories.faults;
    }

    /// As `Integrator::unwound` on the wound integrals in the next memories.
    #[allow(clippy::float_cmp, reason = "any cut is a cut")]
    #[inline(always)]
    fn unwind(&mut self, ki: &Lanes<W>, excess_rad: &Lanes<W>, plain: &mut Mask<W>) {
        let n = &self.numbers;
        let Memories { integral, error_rad, .. } = &mut self.next;
        let literal = self.form == IntegralForm::Literal;
        match self.anti_windup {
            AntiWindup::None => return,
            AntiWindup::Clamping(_) => {
                let term_rad = unclamped(self.form, ki, integral, &n.dt_s);
                for lane in 0..W {
                    let (lower, upper) = (n.term_lower_rad[lane], n.term_upper_rad[lane]);
                    let kept_rad = limited(term_rad[lane], lower, upper);
                    let memory = memory_of(literal, kept_rad, ki[lane], n.dt_s[lane]);
                    let cut = mask(kept_rad != term_rad[lane]) & mask(memory.is_finite());
                    integral[lane] = if cut == YES { memory } else { integral[lane] };
                }
            }
            AntiWindup::Conditional => {
                for lane in 0..W {
                    let (excess_rad, drive) = (excess_rad[lane], ki[lane] * error_rad[lane]);
                    let further_out = (mask(excess_rad > 0.0) & mask(drive > 0.0))
                        | (mask(excess_rad < 0.0) & mask(drive < 0.0));
                    let before = self.memories.integral[lane];
                    integral[lane] = if further_out == YES { before } else { integral[lane] };
                }
            }
            AntiWindup::BackCalculation { .. } => {
                for lane in 0..W {
                    let shift_rad = excess_rad[lane] * n.dt_s[lane] / n.tracking_s[lane];
                    let shift = memory_of(literal, shift_rad, ki[lane], n.dt_s[lane]);
                    let moves = mask(ki[lane] != 0.0) & mask(shift.is_finite());
                    let moved = integral[lane] - shift;
                    integral[lane] = if moves == YES { moved } else { integral[lane] };
                }
            }
        }
        for lane in 0..W {
            plain[lane] &= mask(integral[lane].abs() <= FAR);
        }
    }

    /// The sample anew in lanes that are not plain, as a single flight's.
    #[cold]
    #[inline(never)]
    fn step_one_by_one(&mut self, samples: Samples<'_, W>, plain: &Mask<W>) {
        for (lane, controller) in self.singles.iter().enumerate() {
            if plain[lane] == YES {
                continue;
            }
            let mut state = self.memories.state(lane);
            let step = controller.step(&mut state, samples.of(lane));
            self.next.set(lane, &state);
            let Step { command_rad, gains: Gains { kp, ki, kd }, saturated, faults } = step;
            self.steps.command_rad[lane] = command_rad;
            for (place, gain) in self.steps.gains.iter_mut().zip([kp, ki, kd]) {
                place[lane] = gain;
            }
            self.steps.saturated[lane] = mask(saturated);
            self.steps.faults[lane] = faults;
        }
    }
}

/// Where the rate is not used it is zero.
#[inline(always)]
fn used_rate(uses_rate: f64, rate_rad_s: f64) -> f64 {
    if uses_rate == 0.0 { 0.0 } else { rate_rad_s }
}

/// As `Integrator::wound`.
#[inline(always)]
fn wound<const W: usize>(
    form: IntegralForm,
    before: &Memories<W>,
    ki: &Lanes<W>,
    error_rad: &Lanes<W>,
    dt_s: &Lanes<W>,
) -> Lanes<W> {
    let mut wound = before.integral;
    match form {
        IntegralForm::Bumpless => {
            for lane in 0..W {
                wound[lane] += ki[lane] * error_rad[lane] * dt_s[lane];
            }
        }
        IntegralForm::Literal => {
            for lane in 0..W {
                wound[lane] += error_rad[lane];
            }
        }
    }
    wound
}

/// As `Integrator::unclamped_rad`.
#[inline(always)]
fn unclamped<const W: usize>(
    form: IntegralForm,
    ki: &Lanes<W>,
    memory: &Lanes<W>,
    dt_s: &Lanes<W>,
) -> Lanes<W> {
    let mut term_rad = *memory;
    if form == IntegralForm::Literal {
        for lane in 0..W {
            term_rad[lane] = ki[lane] * memory[lane] * dt_s[lane];
        }
    }
    term_rad
}

/// As `Integrator::memory_of`; not finite where there is none.
#[inline(always)]
fn memory_of(literal: bool, term_rad: f64, ki: f64, dt_s: f64) -> f64 {
    if literal { term_rad / (ki * dt_s) } else { term_rad }
}
