//! The controllers of a group, forwards and backwards.

use fspid_core::equations::{
    AntiWindupKind, GainNumbers, Memory, PidEquations, PidNumbers, PidStructure, TunerEquations,
    TunerNumbers, TunerStructure,
};
use fspid_core::fuzzy::{OutOfRange, Supervisor};
use fspid_core::{Fspid, Gains, IntegralForm, Sample};
use fspid_numeric::Scalar;

use super::network::FlownNetwork;
use super::numbers::{
    CELLS, CELLS_AT, GAIN, GAINS_AT, NUMBERS, PID, SETS_AT, TUNER, TUNER_AT, WEIGHTS_AT, numbers,
    sets,
};
use super::program::{Program, Recorded};
use crate::batch::Refusal;
use crate::controller::Controller;

/// Numbers of [`Memory`].
pub(super) const MEMORY: usize = Memory::<f64>::COUNT;
/// What a controller sees: set-point, pitch, pitch rate.
const SAMPLE: usize = 3;
/// What a sample begins with: the memory, and what is seen.
pub(super) const ROW: usize = MEMORY + SAMPLE;
/// [`ROW`] numbers of each lane.
pub(super) type Row<const W: usize> = [[f64; W]; ROW];
/// What its supervisor adds to each gain, before any factor.
const DELTAS: usize = 3;
/// Numbers that stand still through a flight.
const STILL: usize = PID + TUNER + 3 * GAIN;
/// Inputs of the way to the supervisor that change, and of the way from it.
const BEFORE: usize = ROW;
const BEHIND: usize = ROW + DELTAS;

/// Numbers in a row, one after the other; zero where the row has ended.
fn each_of<S: Scalar>(numbers: &[S]) -> impl FnMut() -> S {
    let mut numbers = numbers.iter().copied();
    move || numbers.next().unwrap_or(Scalar::zero())
}

fn memory_of<S: Scalar>(numbers: &[S]) -> Memory<S> {
    Memory::from_each(each_of(numbers))
}

fn sample_of<S: Scalar>(numbers: &[S]) -> Sample<S> {
    let mut next = each_of(numbers);
    Sample { setpoint_rad: next(), measurement_rad: next(), rate_rad_s: next() }
}

fn pid_of<S: Scalar>(structure: PidStructure, numbers: &[S]) -> PidEquations<S> {
    PidEquations { structure, numbers: PidNumbers::from_each(each_of(numbers)) }
}

fn tuner_of<S: Scalar>(structure: TunerStructure, still: &[S]) -> TunerEquations<S> {
    let numbers = TunerNumbers::from_each(each_of(&still[TUNER_AT..]));
    TunerEquations { structure, numbers, gains: gains_of(still) }
}

fn gains_of<S: Scalar>(still: &[S]) -> [GainNumbers<S>; 3] {
    [0, 1, 2].map(|gain| GainNumbers::from_each(each_of(&still[GAINS_AT + GAIN * gain..])))
}

fn row<S: Copy>(memory: &Memory<S>) -> Vec<S> {
    let mut row = Vec::with_capacity(MEMORY);
    memory.map(|number| row.push(*number));
    row
}

/// No option: what a first sample needs, which is the same with all of them.
const PLAIN: PidStructure = PidStructure {
    integral: IntegralForm::Bumpless,
    anti_windup: AntiWindupKind::None,
    coupled: false,
    feeds_forward: false,
    limited: false,
};

/// What a group of controllers has in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Structure {
    pid: PidStructure,
    tuner: Option<TunerStructure>,
}

impl Structure {
    /// Of a controller, with everything in it that does nothing by its numbers: what is zero has a slope as well, and more
    /// controllers are alike.
    pub(super) fn of(controller: &Controller) -> Self {
        let tuner = match controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => Some(fspid.tuner_equations().structure),
        };
        let pid = controller.equations().structure;
        Self {
            pid: PidStructure { coupled: true, feeds_forward: true, limited: true, ..pid },
            tuner,
        }
    }

    /// What a supervisor would see, in its units.
    fn before(self) -> Program {
        Program::record([BEFORE, BEFORE + STILL], |inputs| {
            let Some(structure) = self.tuner else { return Vec::new() };
            let (memory, sample) = (memory_of(inputs), sample_of(&inputs[MEMORY..]));
            let equations = tuner_of(structure, &inputs[BEFORE..]);
            let [error_rad, second_rad] = equations.inputs(&memory, &sample);
            let seen = equations.seen(error_rad, second_rad);
            seen.into_iter().chain([error_rad, second_rad]).collect()
        })
    }

    /// The next memory.
    fn behind(self) -> Program {
        Program::record([BEHIND, BEHIND + STILL], |inputs| {
            let (memory, sample) = (memory_of(inputs), sample_of(&inputs[MEMORY..]));
            let (deltas, still) = (&inputs[MEMORY + SAMPLE..], &inputs[BEHIND..]);
            let pid = pid_of(self.pid, still);
            let (gains, model) = self.gains((&memory, &sample), deltas, still);
            let free = pid.free(&memory, &sample, &gains);
            let regulated = pid.regulated(&memory, &free, gains.ki);
            row(&Memory {
                command_rad: regulated.command_rad,
                integral: regulated.integral,
                derivative_rad_s: free.derivative_rad_s,
                error_rad: free.error_rad,
                derivative_input_rad: free.derivative_input_rad,
                kp: gains.kp,
                ki: gains.ki,
                kd: gains.kd,
                model_rad: model[0],
                model_rad_s: model[1],
            })
        })
    }

    /// The gains of a sample, and the reference model at the next one.
    fn gains(
        self,
        (memory, sample): (&Memory<Recorded>, &Sample<Recorded>),
        deltas: &[Recorded],
        still: &[Recorded],
    ) -> (Gains<Recorded>, [Recorded; 2]) {
        let numbers = gains_of(still);
        let Some(structure) = self.tuner else {
            let [kp, ki, kd] = numbers.map(|it| it.nominal);
            return (Gains { kp, ki, kd }, [Scalar::zero(); 2]);
        };
        let equations = tuner_of(structure, still);
        let before = [memory.kp, memory.ki, memory.kd];
        let [kp, ki, kd] = [0, 1, 2].map(|gain| {
            let scaled = numbers[gain].scale * deltas[gain];
            let free = equations.free_gain(&numbers[gain], before[gain], scaled);
            numbers[gain].limited(free)
        });
        let model = equations.next_model(memory, sample);
        (Gains { kp, ki, kd }, [model.pitch_rad, model.rate_rad_s])
    }
}

/// A lane's supervisor with what is needed to know its slopes.
#[derive(Clone, Copy, Debug)]
struct Rules<'a> {
    fspid: &'a Fspid<f64>,
    /// Centres of the small and the medium sets of both inputs.
    sets: [[f64; 2]; 2],
    zone: [f64; 2],
}

/// What an input of the rules comes to.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    /// Number of the lower set next to it, 0 to 5, and how far it is on the way to the upper one.
    lower: usize,
    share: f64,
    /// Change of that way with the input, and with the centres of the small and the medium sets.
    by_input: f64,
    by_sets: [f64; 2],
}

impl Place {
    /// Of an input in the supervisor's units; in spacings of the sets as [`NumberTable`] has them.
    ///
    /// [`NumberTable`]: fspid_core::fuzzy::NumberTable
    fn of(input: f64, range: f64, [small, medium]: [f64; 2], bends: bool) -> Self {
        let (part, third) = (input.abs() / range, 1.0 / 3.0);
        // In parts of the range, as `SetCentres::warp`.
        let (warped, by_part, by_sets) = if !(part < 1.0) {
            (1.0, 0.0, [0.0; 2])
        } else if !bends {
            (part, 1.0, [0.0; 2])
        } else if part <= small {
            (third * part / small, third / small, [-third * part / (small * small), 0.0])
        } else if part <= medium {
            let width = medium - small;
            let by = [(part - medium), small - part].map(|it| third * it / (width * width));
            (third + third * (part - small) / width, third / width, by)
        } else {
            let width = 1.0 - medium;
            let by = third * (part - 1.0) / (width * width);
            (third + third + third * (part - medium) / width, third / width, [0.0, by])
        };
        let sign = if input < 0.0 { -1.0 } else { 1.0 };
        let at = 3.0 + 3.0 * sign * warped;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 6")]
        let lower = (at as usize).min(5);
        Self {
            lower,
            share: at - lower as f64,
            by_input: 3.0 * by_part / range,
            by_sets: by_sets.map(|by| 3.0 * sign * by),
        }
    }
}

impl Rules<'_> {
    fn supervisor(&self) -> &Supervisor<f64> {
        self.fspid.tuner().supervisor()
    }

    fn places(&self, [error, second]: [f64; 2]) -> [Place; 2] {
        let (range, sets) = (self.supervisor().range(), self.fspid.tuner().settings().input_sets);
        [
            Place::of(error, range, self.sets[0], sets.error.is_some()),
            Place::of(second, range, self.sets[1], sets.change.is_some()),
        ]
    }

    /// True where the supervisor stays silent.
    fn is_silent(&self, [error_rad, second_rad]: [f64; 2]) -> bool {
        (error_rad.abs() <= self.zone[0]) & (second_rad.abs() <= self.zone[1])
    }

    /// The network with these numbers of a controller; nothing where there are rules.
    fn network<'n>(&self, numbers: &'n [f64]) -> Option<FlownNetwork<'n>> {
        let supervisor = self.supervisor();
        let weights = &numbers[WEIGHTS_AT..];
        supervisor.network().map(|_| FlownNetwork { weights, range: supervisor.range() })
    }

    /// What the rules add to each gain, before any factor.
    fn deltas(&self, seen: [f64; 2], numbers: &[f64]) -> [f64; 3] {
        if let Some(network) = self.network(numbers) {
            return network.deltas(seen);
        }
        let cells = &numbers[CELLS_AT..SETS_AT];
        let [row, column] = self.places(seen);
        [0, 1, 2].map(|gain| {
            let cell =
                |i: usize, j: usize| cells[CELLS * gain + 7 * (row.lower + i) + column.lower + j];
            let along = |i: usize| (1.0 - column.share) * cell(i, 0) + column.share * cell(i, 1);
            (1.0 - row.share) * along(0) + row.share * along(1)
        })
    }

    /// Hands what the increments are worth to what is seen, to the cells and to the places of the sets, or to the weights;
    /// answers the first.
    fn back(
        &self,
        seen: [f64; 2],
        worth: [f64; 3],
        numbers: &[f64],
        gradient: &mut [f64],
    ) -> [f64; 2] {
        if let Some(network) = self.network(numbers) {
            return network.back(seen, worth, &mut gradient[WEIGHTS_AT..]);
        }
        let [row, column] = self.places(seen);
        let cells = &numbers[CELLS_AT..SETS_AT];
        let (mut by_row, mut by_column) = (0.0, 0.0);
        for (gain, worth) in worth.into_iter().enumerate() {
            let at = |i: usize, j: usize| CELLS * gain + 7 * (row.lower + i) + column.lower + j;
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 0), at(1, 1)];
            let (r, s) = (row.share, column.share);
            by_row += worth * ((1.0 - s) * (cells[c] - cells[a]) + s * (cells[d] - cells[b]));
            by_column += worth * ((1.0 - r) * (cells[b] - cells[a]) + r * (cells[d] - cells[c]));
            let grades = [(1.0 - r) * (1.0 - s), (1.0 - r) * s, r * (1.0 - s), r * s];
            for (place, grade) in [a, b, c, d].into_iter().zip(grades) {
                gradient[CELLS_AT + place] += worth * grade;
            }
        }
        for (input, (place, by)) in [(row, by_row), (column, by_column)].into_iter().enumerate() {
            for (set, by_set) in place.by_sets.into_iter().enumerate() {
                gradient[SETS_AT + 2 * input + set] += by * by_set;
            }
        }
        [by_row * row.by_input, by_column * column.by_input]
    }
}

/// What the controllers of a group are differentiated with.
#[derive(Clone, Debug)]
pub(super) struct Laws<'a, const W: usize> {
    before: Program,
    behind: Program,
    before_values: Vec<[f64; W]>,
    before_worth: Vec<[f64; W]>,
    behind_values: Vec<[f64; W]>,
    behind_worth: Vec<[f64; W]>,
    rules: Vec<Rules<'a>>,
    numbers: Vec<[f64; NUMBERS]>,
    /// Of cells, places of sets and weights; the others are what the programs have summed up.
    gradients: Vec<[f64; NUMBERS]>,
}

impl<'a, const W: usize> Laws<'a, W> {
    /// Refuses a controller that has no gradient.
    pub(super) fn check(flight: usize, controller: &Controller) -> Result<(), Refusal> {
        match controller {
            Controller::Fixed(_) => Ok(()),
            Controller::SelfTuning(fspid) => rules_of(flight, fspid).map(|_| ()),
        }
    }

    pub(super) fn new(controllers: &[&'a Controller]) -> Result<Self, Refusal> {
        let first = controllers.first().map(|it| Structure::of(it));
        let structure = first.unwrap_or(Structure { pid: PLAIN, tuner: None });
        let (mut rules, mut all) = (Vec::new(), Vec::new());
        for (flight, controller) in controllers.iter().enumerate() {
            if Structure::of(controller) != structure {
                return Err(Refusal::Differs { flight, what: "the structure of its controller" });
            }
            if let Controller::SelfTuning(fspid) = controller {
                rules.push(rules_of(flight, fspid)?);
            }
            all.push(numbers(controller));
        }
        let (before, behind) = (structure.before(), structure.behind());
        let mut laws = Self {
            before_values: before.room(),
            before_worth: before.room(),
            behind_values: behind.room(),
            behind_worth: behind.room(),
            before,
            behind,
            rules,
            gradients: vec![[0.0; NUMBERS]; all.len()],
            numbers: all,
        };
        laws.put_still();
        Ok(laws)
    }

    fn put_still(&mut self) {
        let mut still = [[0.0; W]; STILL];
        for (lane, numbers) in self.numbers.iter().enumerate() {
            for (place, number) in still.iter_mut().zip(numbers) {
                place[lane] = *number;
            }
        }
        // Lanes without a flight divide by nothing.
        for lane in self.numbers.len()..W {
            still.iter_mut().for_each(|place| place[lane] = 1.0);
        }
        self.before.put(&mut self.before_values, BEFORE, &still);
        self.before.run_still(&mut self.before_values);
        self.behind.put(&mut self.behind_values, BEHIND, &still);
        self.behind.run_still(&mut self.behind_values);
    }

    /// Puts the memory with which the first sample is answered before what is seen there.
    pub(super) fn first(&self, row: &mut Row<W>) {
        for (lane, numbers) in self.numbers.iter().enumerate() {
            let sample = Sample {
                setpoint_rad: row[MEMORY][lane],
                measurement_rad: row[MEMORY + 1][lane],
                rate_rad_s: row[MEMORY + 2][lane],
            };
            let nominal = |gain: usize| numbers[GAINS_AT + GAIN * gain];
            let nominal = Gains { kp: nominal(0), ki: nominal(1), kd: nominal(2) };
            let mut memory = row.iter_mut();
            pid_of(PLAIN, numbers).at_first(&sample, &nominal).map(|number| {
                if let Some(place) = memory.next() {
                    place[lane] = *number;
                }
            });
        }
    }

    /// Hands what the first memory is worth to the numbers that it is made of; the rest is seen.
    pub(super) fn back_first(&mut self, setpoint_rad: &[f64; W], worth: &Row<W>) {
        for (lane, gradient) in self.gradients.iter_mut().enumerate() {
            // c r - y
            gradient[5] += worth[4][lane] * setpoint_rad[lane];
            for gain in 0..3 {
                gradient[GAINS_AT + GAIN * gain] += worth[5 + gain][lane];
            }
        }
    }

    /// Puts the next memory, whose first number is the command, in the place of the one before.
    #[inline(always)]
    pub(super) fn step(&mut self, row: &mut Row<W>) {
        self.evaluate(row);
        for (output, place) in row.iter_mut().take(MEMORY).enumerate() {
            *place = self.behind.output(&self.behind_values, output);
        }
    }

    /// Every value of the equations at a sample, which the way back goes by.
    #[inline(always)]
    pub(super) fn evaluate(&mut self, row: &Row<W>) {
        self.behind.put(&mut self.behind_values, 0, row);
        if !self.rules.is_empty() {
            self.before.put(&mut self.before_values, 0, row);
            self.before.run(&mut self.before_values);
            let deltas = self.deltas();
            self.behind.put(&mut self.behind_values, ROW, &deltas);
        }
        self.behind.run(&mut self.behind_values);
    }

    /// What the supervisors add to each gain, before any factor.
    #[inline(always)]
    fn deltas(&self) -> [[f64; W]; DELTAS] {
        let parts: [[f64; W]; 4] =
            [0, 1, 2, 3].map(|output| self.before.output(&self.before_values, output));
        let mut deltas = [[0.0; W]; DELTAS];
        for (lane, rules) in self.rules.iter().enumerate() {
            let [error, second, error_rad, second_rad] = parts.map(|it| it[lane]);
            if !rules.is_silent([error_rad, second_rad]) {
                let of_lane = rules.deltas([error, second], &self.numbers[lane]);
                for (delta, of_lane) in deltas.iter_mut().zip(of_lane) {
                    delta[lane] = of_lane;
                }
            }
        }
        deltas
    }

    /// Hands what the next memory is worth back: to the memory before and to what was seen. The sample must be the one
    /// that was evaluated last.
    #[inline(always)]
    pub(super) fn back(&mut self, worth: &mut Row<W>) {
        for (output, worth) in worth.iter().take(MEMORY).enumerate() {
            self.behind.credit(&mut self.behind_worth, output, worth);
        }
        self.behind.back(&self.behind_values, &mut self.behind_worth);
        for (input, place) in worth.iter_mut().enumerate() {
            *place = self.behind.take(&mut self.behind_worth, input);
        }
        if self.rules.is_empty() {
            return;
        }
        let deltas = [0, 1, 2].map(|delta| self.behind.take(&mut self.behind_worth, ROW + delta));
        self.back_rules(&deltas);
        self.before.back(&self.before_values, &mut self.before_worth);
        for (input, place) in worth.iter_mut().enumerate() {
            let more = self.before.take(&mut self.before_worth, input);
            for lane in 0..W {
                place[lane] += more[lane];
            }
        }
    }

    fn back_rules(&mut self, deltas: &[[f64; W]; DELTAS]) {
        let parts: [[f64; W]; 4] =
            [0, 1, 2, 3].map(|output| self.before.output(&self.before_values, output));
        let mut seen = [[0.0; W]; 2];
        for (lane, rules) in self.rules.iter().enumerate() {
            let [error, second, error_rad, second_rad] = parts.map(|it| it[lane]);
            if rules.is_silent([error_rad, second_rad]) {
                continue;
            }
            let worth = deltas.map(|it| it[lane]);
            let of_lane =
                rules.back([error, second], worth, &self.numbers[lane], &mut self.gradients[lane]);
            (seen[0][lane], seen[1][lane]) = (of_lane[0], of_lane[1]);
        }
        self.before.credit(&mut self.before_worth, 0, &seen[0]);
        self.before.credit(&mut self.before_worth, 1, &seen[1]);
    }

    /// The gradients of all lanes, at the end of a flight backwards.
    pub(super) fn gradients(mut self) -> Vec<[f64; NUMBERS]> {
        self.before.back_still(&self.before_values, &mut self.before_worth);
        self.behind.back_still(&self.behind_values, &mut self.behind_worth);
        for number in 0..STILL {
            let before = self.before.take(&mut self.before_worth, BEFORE + number);
            let behind = self.behind.take(&mut self.behind_worth, BEHIND + number);
            for (lane, gradient) in self.gradients.iter_mut().enumerate() {
                gradient[number] += before[lane] + behind[lane];
            }
        }
        for gradient in &mut self.gradients {
            for (place, of_gain) in super::numbers::NOMINAL {
                gradient[of_gain] += gradient[place];
                gradient[place] = 0.0;
            }
        }
        self.gradients
    }
}

/// The rules of a self-tuner that can be differentiated.
fn rules_of(flight: usize, fspid: &Fspid<f64>) -> Result<Rules<'_>, Refusal> {
    let supervisor = fspid.tuner().supervisor();
    if supervisor.has_labels() {
        return Err(Refusal::Part { flight, what: "rules that conclude labels" });
    }
    if supervisor.out_of_range() == OutOfRange::Error {
        return Err(Refusal::Part {
            flight,
            what: "a supervisor that refuses inputs beyond its range",
        });
    }
    let numbers = &fspid.tuner_equations().numbers;
    let zone = [numbers.zone_error_rad, numbers.zone_change_rad];
    Ok(Rules { fspid, sets: sets(fspid), zone })
}
