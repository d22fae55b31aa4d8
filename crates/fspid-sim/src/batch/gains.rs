//! The gains of all lanes' self-tuning controllers.

use fspid_core::equations::{
    GainNumbers, LawKind, SecondInputKind, TunerEquations, TunerNumbers, TunerStructure,
};
use fspid_core::fuzzy::{Answers, Inference, OutOfRange, Supervisor};
use fspid_core::{Fspid, Gains, InputSets, ModelState, TunerSettings};
use fspid_numeric::InstructionSet;

use super::lane::{Lanes, Mask, NO, YES, mask};
use super::memory::Memories;
use super::samples::{FAR, Samples};

/// The equations of a lane that answers zeros by zeros.
fn parked() -> TunerEquations<f64> {
    let silent = TunerSettings { output_scale: Gains::ZERO, ..TunerSettings::literal() };
    TunerEquations::new(&silent, Gains::ZERO, 1.0)
}

/// Self-tuners of all lanes, around one supervisor, or around one of each lane whose numbers alone differ.
#[derive(Clone, Debug)]
pub(super) struct SelfTuners<const W: usize> {
    supervisor: Supervisor<f64>,
    /// Where rules conclude numbers, and of networks, each lane has its own: candidates of a search fly side by side.
    own: Option<Box<[Supervisor<f64>; W]>>,
    instructions: InstructionSet,
    structure: TunerStructure,
    numbers: TunerNumbers<Lanes<W>>,
    gains: [GainNumbers<Lanes<W>>; 3],
    /// Whether sets are uneven in some lane.
    bends: bool,
    /// Where the sets of each lane's inputs lie.
    sets: [InputSets<f64>; W],
    /// Inputs of the supervisor beyond this are answered one by one.
    farthest: f64,
}

impl<const W: usize> SelfTuners<W> {
    pub(super) fn new(fspid: &Fspid<f64>, instructions: InstructionSet) -> Self {
        let supervisor = *fspid.tuner().supervisor();
        let refuses = supervisor.out_of_range() == OutOfRange::Error;
        let TunerEquations { numbers, gains, .. } = parked();
        Self {
            supervisor,
            own: (!supervisor.has_labels()).then(|| Box::new([supervisor; W])),
            instructions,
            structure: fspid.tuner_equations().structure,
            numbers: numbers.map(|&number| [number; W]),
            gains: gains.map(|gain| gain.map(|&number| [number; W])),
            bends: false,
            sets: [InputSets::EVEN; W],
            farthest: if refuses { supervisor.range() } else { FAR },
        }
    }

    /// What keeps a tuner out of this group.
    pub(super) fn difference(&self, fspid: &Fspid<f64>) -> Option<&'static str> {
        let TunerStructure { second_input, law } = fspid.tuner_equations().structure;
        if law != self.structure.law {
            return Some("the law of its gains");
        }
        if second_input != self.structure.second_input {
            return Some("what its supervisor sees");
        }
        let (one, other) = (&self.supervisor, fspid.tuner().supervisor());
        let are_alike = one.numbers().is_some() && other.numbers().is_some()
            || one.network().is_some() && other.network().is_some();
        let only_numbers_differ = are_alike
            && one.range().to_bits() == other.range().to_bits()
            && one.out_of_range() == other.out_of_range();
        (!only_numbers_differ && one != other).then_some("its supervisor")
    }

    pub(super) fn load(&mut self, lane: usize, fspid: &Fspid<f64>) {
        self.set(lane, fspid.tuner_equations());
        if let Some(own) = &mut self.own {
            own[lane] = *fspid.tuner().supervisor();
        }
        self.sets[lane] = fspid.tuner().settings().input_sets;
        self.bends |= !self.sets[lane].are_even();
    }

    fn set(&mut self, lane: usize, equations: &TunerEquations<f64>) {
        self.numbers.put(equations.numbers, |column, number| column[lane] = number);
        for (columns, gain) in self.gains.iter_mut().zip(equations.gains) {
            columns.put(gain, |column, number| column[lane] = number);
        }
    }

    pub(super) fn park(&mut self, lane: usize) {
        self.set(lane, &parked());
        self.sets[lane] = InputSets::EVEN;
    }

    /// The equations of one lane.
    #[inline(always)]
    fn at(&self, structure: TunerStructure, lane: usize) -> TunerEquations<f64> {
        TunerEquations {
            structure,
            numbers: self.numbers.map(|column| column[lane]),
            gains: self.gains.each_ref().map(|gain| gain.map(|column| column[lane])),
        }
    }

    /// The gains for errors as the loops have them; strikes lanes out of `plain` that have to be
    /// answered one by one.
    #[inline(always)]
    pub(super) fn gains(
        &self,
        memories: &Memories<W>,
        samples: Samples<'_, W>,
        plain: &mut Mask<W>,
    ) -> [Lanes<W>; 3] {
        let (mut error, mut second, mut silent) = ([0.0; W], [0.0; W], [NO; W]);
        for lane in 0..W {
            let (equations, sample) = (self.at(self.structure, lane), samples.of(lane));
            let error_rad = sample.setpoint_rad - sample.measurement_rad;
            let second_rad = equations.second_rad(&memories.at(lane), &sample);
            let in_zone = equations.is_silent(error_rad, second_rad);
            let [seen_error, seen_second] = equations.seen(error_rad, second_rad);
            let near = (seen_error.abs() <= self.farthest) & (seen_second.abs() <= self.farthest);
            // In the dead zone nobody is asked, and a lane that is not plain must not be.
            let ask = mask(near) & plain[lane] & !mask(in_zone);
            error[lane] = if ask == YES { seen_error } else { 0.0 };
            second[lane] = if ask == YES { seen_second } else { 0.0 };
            silent[lane] = mask(in_zone);
            plain[lane] &= mask(near) | mask(in_zone);
        }
        if self.bends {
            self.bend(&mut error, &mut second);
        }
        let increments = self.inferred(&error, &second, plain);
        match self.structure.law {
            LawKind::Memoryless => self.by_law(LawKind::Memoryless, memories, increments, &silent),
            LawKind::Accumulating => {
                self.by_law(LawKind::Accumulating, memories, increments, &silent)
            }
        }
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
        if self.structure.second_input != SecondInputKind::ModelError {
            return;
        }
        for lane in 0..W {
            let equations = self.at(self.structure, lane);
            let model = equations.next_model(&before.at(lane), &samples.of(lane));
            let ModelState { pitch_rad, rate_rad_s } = model;
            (next.numbers.model_rad[lane], next.numbers.model_rad_s[lane]) =
                (pitch_rad, rate_rad_s);
            plain[lane] &= mask((pitch_rad.abs() <= FAR) & (rate_rad_s.abs() <= FAR));
        }
    }

    #[inline(always)]
    fn inferred(&self, error: &Lanes<W>, change: &Lanes<W>, plain: &mut Mask<W>) -> [Lanes<W>; 3] {
        if let Some(own) = &self.own {
            return one_by_one(own, error, change, plain);
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

    /// The gains that follow from increments, by a law that the compiler knows.
    #[inline(always)]
    fn by_law(
        &self,
        law: LawKind,
        memories: &Memories<W>,
        increments: [Lanes<W>; 3],
        silent: &Mask<W>,
    ) -> [Lanes<W>; 3] {
        let (mut gains, structure) = (increments, TunerStructure { law, ..self.structure });
        let before = [&memories.numbers.kp, &memories.numbers.ki, &memories.numbers.kd];
        for ((values, before), numbers) in gains.iter_mut().zip(before).zip(&self.gains) {
            // Loops so short that each becomes vectors.
            for lane in 0..W {
                let scaled = numbers.scale[lane] * values[lane];
                values[lane] = if silent[lane] == YES { 0.0 } else { scaled };
            }
            for lane in 0..W {
                let (equations, gain) = (self.at(structure, lane), numbers.map(|it| it[lane]));
                values[lane] = equations.free_gain(&gain, before[lane], values[lane]);
            }
            for lane in 0..W {
                let (free, gain) = (values[lane], numbers.map(|it| it[lane]));
                let kept = gain.limited(free);
                // What is far or no number stays so, for the regulator to see.
                values[lane] = if free.abs() <= FAR { kept } else { f64::NAN };
            }
        }
        gains
    }
}

/// What the supervisor of each lane answers.
#[inline(never)]
fn one_by_one<const W: usize>(
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
