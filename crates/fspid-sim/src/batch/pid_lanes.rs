//! The controllers of all lanes.

use super::samples::{FAR, Samples};
use fspid_core::equations::{AntiWindupKind, Memory, PidEquations, PidNumbers, PidStructure};
use fspid_core::{Faults, GainCoupling, Gains, IntegralForm, PidConfig, Sample, Step};
use fspid_numeric::InstructionSet;

use super::gains::SelfTuners;
use super::lane::{Lanes, Mask, NO, YES, all, mask};
use super::memory::Memories;
use super::refusal::Refusal;
use crate::controller::Controller;

/// Which samples are answered side by side, and what of them.
#[derive(Clone, Debug)]
struct Admission<const W: usize> {
    /// 1 where the pitch rate is used, else 0.
    uses_rate: Lanes<W>,
    guard_rad: Lanes<W>,
    /// Largest error whose rate is not far.
    steep_rad: Lanes<W>,
}

impl<const W: usize> Admission<W> {
    const PARKED: Self = Self { uses_rate: [0.0; W], guard_rad: [FAR; W], steep_rad: [FAR; W] };

    fn load(&mut self, lane: usize, controller: &Controller) {
        let config = controller.config();
        self.uses_rate[lane] = if controller.uses_rate() { 1.0 } else { 0.0 };
        self.guard_rad[lane] = config.guard.limit_rad();
        self.steep_rad[lane] = FAR * config.dt_s.min(1.0);
    }

    fn park(&mut self, lane: usize) {
        self.uses_rate[lane] = 0.0;
        (self.guard_rad[lane], self.steep_rad[lane]) = (FAR, FAR);
    }

    /// The rates as they are used: zero where they are not.
    #[inline(always)]
    fn used_rate_rad_s(&self, rate_rad_s: &Lanes<W>) -> Lanes<W> {
        let mut used_rad_s = *rate_rad_s;
        for lane in 0..W {
            used_rad_s[lane] = if self.uses_rate[lane] == 0.0 { 0.0 } else { rate_rad_s[lane] };
        }
        used_rad_s
    }

    /// Which samples are believed and so small that nothing comes near overflow.
    #[inline(always)]
    fn believed(&self, samples: Samples<'_, W>) -> Mask<W> {
        let mut believed = [NO; W];
        for lane in 0..W {
            let Sample { setpoint_rad, measurement_rad, rate_rad_s } = samples.of(lane);
            let error_rad = setpoint_rad - measurement_rad;
            let small = (setpoint_rad.abs() <= self.guard_rad[lane])
                & (measurement_rad.abs() <= self.guard_rad[lane])
                & (rate_rad_s.abs() <= self.guard_rad[lane])
                & (error_rad.abs() <= self.steep_rad[lane]);
            believed[lane] = mask(small);
        }
        believed
    }
}

/// The equations of a lane that answers zeros by zeros.
fn parked() -> PidEquations<f64> {
    PidEquations::new(&PidConfig::sampled_every(1.0), Gains::ZERO, GainCoupling::NONE)
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
    admission: Admission<W>,
    structure: PidStructure,
    numbers: PidNumbers<Lanes<W>>,
    /// Gains of controllers that have no tuner.
    fixed: [Lanes<W>; 3],
    tuners: Option<SelfTuners<W>>,
    memories: Memories<W>,
    next: Memories<W>,
    pub(super) steps: Steps<W>,
}

impl<'a, const W: usize> Controllers<'a, W> {
    pub(super) fn new(
        singles: Vec<&'a Controller>,
        instructions: InstructionSet,
    ) -> Result<Self, Refusal> {
        let parked = parked();
        let first = singles.first();
        let tuners = first.and_then(|controller| match controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => Some(SelfTuners::new(fspid, instructions)),
        });
        let structure = first.map_or(parked.structure, |first| first.equations().structure);
        let mut all = Self {
            admission: Admission::PARKED,
            structure,
            numbers: parked.numbers.map(|&number| [number; W]),
            fixed: [[0.0; W]; 3],
            tuners,
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
        let PidEquations { structure, numbers } = *controller.equations();
        let PidStructure { integral, anti_windup, coupled, feeds_forward, limited } = structure;
        if integral != self.structure.integral {
            return Err(differs("the form of its integral"));
        }
        if anti_windup != self.structure.anti_windup {
            return Err(differs("its anti-windup"));
        }
        // A product that is 0 would turn a command of -0 around.
        if feeds_forward != self.structure.feeds_forward {
            return Err(differs("whether its set-point is fed forward"));
        }
        // Where nothing is coupled the factors are 0, where nothing limits the limits are infinite.
        self.structure.coupled |= coupled;
        self.structure.limited |= limited;
        match (controller, &mut self.tuners) {
            (Controller::Fixed(_), None) => {}
            (Controller::SelfTuning(fspid), Some(tuners)) => {
                if let Some(what) = tuners.difference(fspid) {
                    return Err(differs(what));
                }
                tuners.load(lane, fspid);
            }
            _ => return Err(differs("its kind of controller")),
        }
        self.admission.load(lane, controller);
        self.numbers.put(numbers, |column, number| column[lane] = number);
        let Gains { kp, ki, kd } = controller.nominal();
        self.fix(lane, [kp, ki, kd]);
        self.memories.has_previous[lane] = NO;
        Ok(())
    }

    fn fix(&mut self, lane: usize, gains: [f64; 3]) {
        for (column, gain) in self.fixed.iter_mut().zip(gains) {
            column[lane] = gain;
        }
    }

    /// Makes a lane one that answers zeros by zeros.
    pub(super) fn park(&mut self, lane: usize) {
        self.admission.park(lane);
        self.numbers.put(parked().numbers, |column, number| column[lane] = number);
        self.fix(lane, [0.0; 3]);
        if let Some(tuners) = &mut self.tuners {
            tuners.park(lane);
        }
        self.memories.park(lane);
    }

    /// One sample, as [`Controller::step`] in each lane.
    #[inline(always)]
    pub(super) fn step(&mut self, samples: Samples<'_, W>) {
        let used_rad_s = self.admission.used_rate_rad_s(samples.rate_rad_s);
        let samples = Samples { rate_rad_s: &used_rad_s, ..samples };
        let mut plain = self.admitted(samples);
        let gains = match &self.tuners {
            None => self.fixed,
            Some(tuners) => {
                tuners.advance(&self.memories, samples, &mut self.next, &mut plain);
                tuners.gains(&self.memories, samples, &mut plain)
            }
        };
        self.regulate(samples, &gains, &mut plain);
        self.steps.command_rad = self.next.numbers.command_rad;
        self.steps.gains = gains;
        self.steps.faults = self.memories.faults;
        self.next.has_previous = self.memories.has_previous;
        self.next.faults = self.memories.faults;
        if !all(&plain) {
            self.step_one_by_one(samples, &plain);
        }
        std::mem::swap(&mut self.memories, &mut self.next);
    }

    /// Which lanes can be answered side by side.
    #[inline(always)]
    fn admitted(&self, samples: Samples<'_, W>) -> Mask<W> {
        let mut plain = self.admission.believed(samples);
        for lane in 0..W {
            plain[lane] &= self.memories.has_previous[lane];
        }
        plain
    }

    /// The equations of all lanes, in a loop of its own for each structure, without cases in it. (No
    /// closures: one that is called from many places is not inlined, and then has no vectors.)
    #[inline(always)]
    fn regulate(&mut self, samples: Samples<'_, W>, gains: &[Lanes<W>; 3], plain: &mut Mask<W>) {
        use AntiWindupKind::{BackCalculation, Clamping, Conditional, None};
        match self.structure.anti_windup {
            None => self.regulate_with(None, samples, gains, plain),
            Clamping => self.regulate_with(Clamping, samples, gains, plain),
            Conditional => self.regulate_with(Conditional, samples, gains, plain),
            BackCalculation => self.regulate_with(BackCalculation, samples, gains, plain),
        }
    }

    #[inline(always)]
    fn regulate_with(
        &mut self,
        anti_windup: AntiWindupKind,
        samples: Samples<'_, W>,
        gains: &[Lanes<W>; 3],
        plain: &mut Mask<W>,
    ) {
        let (bumpless, literal) = (IntegralForm::Bumpless, IntegralForm::Literal);
        let structure = PidStructure { anti_windup, ..self.structure };
        let of = |integral| PidStructure { integral, ..structure };
        match structure.integral {
            IntegralForm::Bumpless => self.regulate_as(of(bumpless), samples, gains, plain),
            IntegralForm::Literal => self.regulate_as(of(literal), samples, gains, plain),
        }
    }

    /// From gains to commands, into the next memories; strikes lanes out of `plain` that come near
    /// overflow.
    #[allow(clippy::float_cmp, reason = "any cut is a cut")]
    #[inline(always)]
    fn regulate_as(
        &mut self,
        structure: PidStructure,
        samples: Samples<'_, W>,
        [kp, ki, kd]: &[Lanes<W>; 3],
        plain: &mut Mask<W>,
    ) {
        // In full, so that nothing is forgotten that a controller remembers.
        let Memory {
            command_rad,
            integral,
            derivative_rad_s,
            error_rad,
            derivative_input_rad,
            kp: next_kp,
            ki: next_ki,
            kd: next_kd,
            // The tuners have been here.
            model_rad: _,
            model_rad_s: _,
        } = &mut self.next.numbers;
        for lane in 0..W {
            let numbers = self.numbers.map(|column| column[lane]);
            let (equations, memory) = (PidEquations { structure, numbers }, self.memories.at(lane));
            let sample = samples.of(lane);
            let gains = Gains { kp: kp[lane], ki: ki[lane], kd: kd[lane] };
            let free = equations.free(&memory, &sample, &gains);
            let regulated = equations.regulated(&memory, &free, gains.ki);
            let clear = (free.derivative_input_rad.abs() <= self.admission.steep_rad[lane])
                & (free.command_rad.abs() <= FAR)
                & (free.wound.abs() <= FAR)
                & (regulated.integral.abs() <= FAR);
            plain[lane] &= mask(clear);
            self.steps.saturated[lane] = mask(regulated.excess_rad != 0.0);
            command_rad[lane] = regulated.command_rad;
            integral[lane] = regulated.integral;
            derivative_rad_s[lane] = free.derivative_rad_s;
            derivative_input_rad[lane] = free.derivative_input_rad;
            error_rad[lane] = free.error_rad;
        }
        (*next_kp, *next_ki, *next_kd) = (*kp, *ki, *kd);
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
