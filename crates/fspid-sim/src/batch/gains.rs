//! The gains of all lanes' self-tuning controllers.

use fspid_core::fuzzy::{Answers, Inference, OutOfRange, Supervisor};
use fspid_core::{
    Change, ErrorSign, Gains, InputSets, Law, ModelState, ReferenceModel, SecondInput, SelfTuner,
};
use fspid_numeric::InstructionSet;

use super::lane::{Lanes, Mask, NO, YES, limited, mask, numbers};
use super::memory::Memories;
use super::pid_lanes::{FAR, Samples};

numbers! {
    /// One flight's numbers of a self-tuner.
    Tuner,
    /// Those of all lanes.
    Tuners:
    /// 1 or -1.
    sign,
    error_per_rad,
    change_per_rad,
    /// The difference of the error over this is its change: the sample period or 1.
    change_divisor,
    /// Below zero without a dead zone.
    zone_error_rad,
    zone_change_rad,
    leakage_per_s,
    dt_s,
    nominal_kp,
    nominal_ki,
    nominal_kd,
    scale_kp,
    scale_ki,
    scale_kd,
    lower_kp,
    lower_ki,
    lower_kd,
    upper_kp,
    upper_ki,
    upper_kd,
}

impl Tuner {
    /// One that answers zeros by zeros.
    pub(super) const PARKED: Self = Self {
        sign: 1.0,
        error_per_rad: 0.0,
        change_per_rad: 0.0,
        change_divisor: 1.0,
        zone_error_rad: -1.0,
        zone_change_rad: -1.0,
        leakage_per_s: 0.0,
        dt_s: 1.0,
        nominal_kp: 0.0,
        nominal_ki: 0.0,
        nominal_kd: 0.0,
        scale_kp: 0.0,
        scale_ki: 0.0,
        scale_kd: 0.0,
        lower_kp: f64::NEG_INFINITY,
        lower_ki: f64::NEG_INFINITY,
        lower_kd: f64::NEG_INFINITY,
        upper_kp: f64::INFINITY,
        upper_ki: f64::INFINITY,
        upper_kd: f64::INFINITY,
    };

    fn new(tuner: &SelfTuner<f64>, dt_s: f64) -> Self {
        let settings = tuner.settings();
        let Gains { kp: nominal_kp, ki: nominal_ki, kd: nominal_kd } = tuner.nominal();
        let Gains { kp: scale_kp, ki: scale_ki, kd: scale_kd } = settings.output_scale;
        let mut one = Self {
            sign: match settings.error_sign {
                ErrorSign::SetpointMinusMeasurement => 1.0,
                ErrorSign::MeasurementMinusSetpoint => -1.0,
            },
            error_per_rad: settings.input_scale.error_per_rad,
            change_per_rad: settings.input_scale.change_per_rad,
            change_divisor: if settings.change == Change::Rate { dt_s } else { 1.0 },
            dt_s,
            nominal_kp,
            nominal_ki,
            nominal_kd,
            scale_kp,
            scale_ki,
            scale_kd,
            ..Self::PARKED
        };
        if let Some(zone) = settings.dead_zone {
            (one.zone_error_rad, one.zone_change_rad) = (zone.error_rad, zone.change_rad);
        }
        if let Law::Accumulating { leakage_per_s } = settings.law {
            one.leakage_per_s = leakage_per_s;
        }
        if let Some(limits) = settings.gain_limits {
            (one.lower_kp, one.upper_kp) = (limits.kp.lower(), limits.kp.upper());
            (one.lower_ki, one.upper_ki) = (limits.ki.lower(), limits.ki.upper());
            (one.lower_kd, one.upper_kd) = (limits.kd.lower(), limits.kd.upper());
        }
        one
    }
}

/// What the supervisor sees beside the error, without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Second {
    Change,
    Rate,
    ModelError,
}

impl Second {
    fn of(tuner: &SelfTuner<f64>) -> Self {
        match tuner.settings().second_input {
            SecondInput::Change => Self::Change,
            SecondInput::Rate => Self::Rate,
            SecondInput::ModelError(_) => Self::ModelError,
        }
    }
}

/// A model that stays at rest.
const STILL: ReferenceModel<f64> = ReferenceModel { bandwidth_rad_s: 0.0, damping: 0.0 };

/// Self-tuners of all lanes, around one supervisor, or around one of each lane whose numbers alone differ.
#[derive(Clone, Debug)]
pub(super) struct SelfTuners<const W: usize> {
    supervisor: Supervisor<f64>,
    /// Where rules conclude numbers, each lane has its own: candidates of a search fly side by side.
    own: Option<Box<[Supervisor<f64>; W]>>,
    instructions: InstructionSet,
    accumulates: bool,
    second_input: Second,
    /// Whether sets are uneven in some lane.
    bends: bool,
    /// Where the sets of each lane's inputs lie.
    sets: [InputSets<f64>; W],
    models: [ReferenceModel<f64>; W],
    /// Inputs of the supervisor beyond this are answered one by one.
    farthest: f64,
    numbers: Tuners<W>,
}

impl<const W: usize> SelfTuners<W> {
    pub(super) fn new(tuner: &SelfTuner<f64>, instructions: InstructionSet) -> Self {
        let supervisor = *tuner.supervisor();
        let refuses = supervisor.out_of_range() == OutOfRange::Error;
        Self {
            supervisor,
            own: supervisor.numbers().map(|_| Box::new([supervisor; W])),
            instructions,
            accumulates: matches!(tuner.settings().law, Law::Accumulating { .. }),
            second_input: Second::of(tuner),
            bends: false,
            sets: [InputSets::EVEN; W],
            models: [STILL; W],
            farthest: if refuses { supervisor.range() } else { FAR },
            numbers: Tuners::same(Tuner::PARKED),
        }
    }

    /// What keeps a tuner out of this group.
    pub(super) fn difference(&self, tuner: &SelfTuner<f64>) -> Option<&'static str> {
        let accumulates = matches!(tuner.settings().law, Law::Accumulating { .. });
        if accumulates != self.accumulates {
            return Some("the law of its gains");
        }
        if Second::of(tuner) != self.second_input {
            return Some("what its supervisor sees");
        }
        let (one, other) = (&self.supervisor, tuner.supervisor());
        let only_numbers_differ = one.numbers().is_some()
            && other.numbers().is_some()
            && one.range().to_bits() == other.range().to_bits()
            && one.out_of_range() == other.out_of_range();
        (!only_numbers_differ && one != other).then_some("its supervisor")
    }

    pub(super) fn load(&mut self, lane: usize, tuner: &SelfTuner<f64>, dt_s: f64) {
        self.numbers.set(lane, Tuner::new(tuner, dt_s));
        if let Some(own) = &mut self.own {
            own[lane] = *tuner.supervisor();
        }
        let settings = tuner.settings();
        self.sets[lane] = settings.input_sets;
        self.bends |= !settings.input_sets.are_even();
        if let SecondInput::ModelError(model) = settings.second_input {
            self.models[lane] = model;
        }
    }

    pub(super) fn park(&mut self, lane: usize) {
        self.numbers.set(lane, Tuner::PARKED);
        (self.sets[lane], self.models[lane]) = (InputSets::EVEN, STILL);
    }

    /// The gains for errors as the loops have them; strikes lanes out of `plain` that have to be
    /// answered one by one.
    #[inline(always)]
    pub(super) fn gains(
        &self,
        memories: &Memories<W>,
        samples: Samples<'_, W>,
        error_rad: &Lanes<W>,
        plain: &mut Mask<W>,
    ) -> [Lanes<W>; 3] {
        let n = &self.numbers;
        let (mut error, mut change, mut silent) = ([0.0; W], [0.0; W], [NO; W]);
        let seconds_rad = self.seconds_rad(memories, samples, error_rad);
        for lane in 0..W {
            let change_rad = seconds_rad[lane];
            let in_zone = (error_rad[lane].abs() <= n.zone_error_rad[lane])
                & (change_rad.abs() <= n.zone_change_rad[lane]);
            let seen_error = n.sign[lane] * (n.error_per_rad[lane] * error_rad[lane]);
            let seen_change = n.sign[lane] * (n.change_per_rad[lane] * change_rad);
            let near = (seen_error.abs() <= self.farthest) & (seen_change.abs() <= self.farthest);
            // In the dead zone nobody is asked, and a lane that is not plain must not be.
            let ask = mask(near) & plain[lane] & !mask(in_zone);
            error[lane] = if ask == YES { seen_error } else { 0.0 };
            change[lane] = if ask == YES { seen_change } else { 0.0 };
            silent[lane] = mask(in_zone);
            plain[lane] &= mask(near) | mask(in_zone);
        }
        if self.bends {
            self.bend(&mut error, &mut change);
        }
        let increments = self.inferred(&error, &change, plain);
        self.by_law(&memories.gains, increments, &silent)
    }

    /// What is seen beside the errors.
    #[inline(always)]
    fn seconds_rad(
        &self,
        memories: &Memories<W>,
        samples: Samples<'_, W>,
        error_rad: &Lanes<W>,
    ) -> Lanes<W> {
        let mut seconds_rad = [0.0; W];
        for lane in 0..W {
            seconds_rad[lane] = match self.second_input {
                Second::Change => {
                    (error_rad[lane] - memories.error_rad[lane]) / self.numbers.change_divisor[lane]
                }
                Second::Rate => -samples.rate_rad_s[lane],
                Second::ModelError => memories.model_rad[lane] - samples.measurement_rad[lane],
            };
        }
        seconds_rad
    }

    /// Inputs as the even sets see them.
    #[inline(never)]
    fn bend(&self, error: &mut Lanes<W>, change: &mut Lanes<W>) {
        let range = self.supervisor.range();
        for lane in 0..W {
            let InputSets { error: of_error, change: of_change } = self.sets[lane];
            error[lane] = of_error.map_or(error[lane], |places| places.warp(error[lane], range));
            change[lane] =
                of_change.map_or(change[lane], |places| places.warp(change[lane], range));
        }
    }

    /// The reference models at the next sample, into the next memories; strikes lanes out of `plain`
    /// whose model comes near overflow.
    #[inline(always)]
    pub(super) fn advance(
        &self,
        before: &Memories<W>,
        samples: Samples<'_, W>,
        next: &mut Memories<W>,
        plain: &mut Mask<W>,
    ) {
        if self.second_input != Second::ModelError {
            return;
        }
        for lane in 0..W {
            let now = ModelState {
                pitch_rad: before.model_rad[lane],
                rate_rad_s: before.model_rad_s[lane],
            };
            let dt_s = self.numbers.dt_s[lane];
            let ModelState { pitch_rad, rate_rad_s } =
                self.models[lane].next(now, samples.setpoint_rad[lane], dt_s);
            (next.model_rad[lane], next.model_rad_s[lane]) = (pitch_rad, rate_rad_s);
            plain[lane] &= mask((pitch_rad.abs() <= FAR) & (rate_rad_s.abs() <= FAR));
        }
    }

    #[inline(always)]
    fn inferred(&self, error: &Lanes<W>, change: &Lanes<W>, plain: &mut Mask<W>) -> [Lanes<W>; 3] {
        if let Some(own) = &self.own {
            return interpolated(own, error, change, plain);
        }
        let [mut kp, mut ki, mut kd] = [[0.0; W]; 3];
        let (mut clamped, mut underflowed) = ([false; W], [false; W]);
        let answers = Answers {
            kp: &mut kp,
            ki: &mut ki,
            kd: &mut kd,
            clamped: &mut clamped,
            underflowed: &mut underflowed,
        };
        let answer = self.supervisor.infer_many_by(self.instructions, error, change, answers);
        if answer.is_err() {
            // No input is refused that is near; were one, a single flight's step would tell.
            *plain = [NO; W];
        }
        for lane in 0..W {
            plain[lane] &= mask(!underflowed[lane]);
        }
        [kp, ki, kd]
    }

    /// As `SelfTuner::gains` behind the supervisor.
    #[inline(always)]
    fn by_law(
        &self,
        previous: &[Lanes<W>; 3],
        increments: [Lanes<W>; 3],
        silent: &Mask<W>,
    ) -> [Lanes<W>; 3] {
        let n = &self.numbers;
        let mut gains = increments;
        let scales = [&n.scale_kp, &n.scale_ki, &n.scale_kd];
        let nominals = [&n.nominal_kp, &n.nominal_ki, &n.nominal_kd];
        let lowers = [&n.lower_kp, &n.lower_ki, &n.lower_kd];
        let uppers = [&n.upper_kp, &n.upper_ki, &n.upper_kd];
        for gain in 0..3 {
            let values = &mut gains[gain];
            for lane in 0..W {
                let scaled = scales[gain][lane] * values[lane];
                values[lane] = if silent[lane] == YES { 0.0 } else { scaled };
            }
            if self.accumulates {
                for lane in 0..W {
                    let before = previous[gain][lane];
                    let pull = n.leakage_per_s[lane] * (before - nominals[gain][lane]);
                    values[lane] = before + (values[lane] - pull) * n.dt_s[lane];
                }
            } else {
                for lane in 0..W {
                    values[lane] += nominals[gain][lane];
                }
            }
            for lane in 0..W {
                let free = values[lane];
                let kept = limited(free, lowers[gain][lane], uppers[gain][lane]);
                // What is far or no number stays so, for the regulator to see.
                values[lane] = if free.abs() <= FAR { kept } else { f64::NAN };
            }
        }
        gains
    }
}

/// What the numbers of each lane answer.
#[inline(never)]
fn interpolated<const W: usize>(
    supervisors: &[Supervisor<f64>; W],
    error: &Lanes<W>,
    change: &Lanes<W>,
    plain: &mut Mask<W>,
) -> [Lanes<W>; 3] {
    let [mut kp, mut ki, mut kd] = [[0.0; W]; 3];
    for lane in 0..W {
        match supervisors[lane].infer(error[lane], change[lane]) {
            Ok(Inference { delta, .. }) => {
                (kp[lane], ki[lane], kd[lane]) = (delta.kp, delta.ki, delta.kd);
            }
            // No input is refused that is near; were one, a single flight's step would tell.
            Err(_) => plain[lane] = NO,
        }
    }
    [kp, ki, kd]
}
