//! Samples that go to the places where something may be wrong, drawn ones behind them, and what a controller answers;
//! those of systems are in `systems`.
//!
//! Directed are: every rule at the centres of its sets and between them, both ends of every limit, wind-up and the way
//! out of it, dead zone, guard, numbers that are none, memories that nobody has written, taking over. Drawn are
//! set-points that jump by up to 0.6 rad and a pitch that follows with noise. What of a program they reach is counted by
//! [`Machine::branches`](crate::interpret::Machine::branches), what they find by the evidence of an export.

mod directed;
mod drawn;
mod telling;

use fspid_core::{Controller, Faults, Previous, Sample, State, Step};
use fspid_numeric::Real;

use crate::Angles;
use crate::compose::GAINS;
use crate::program::{Part, Program};
pub(crate) use drawn::Draw;
pub use drawn::samples;
pub use telling::{Stretch, telling};

/// Of the samples of an export, whether of a controller or of a fuzzy system.
pub(crate) const SEED: u64 = 1;

/// What is done with a controller at a vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event<R> {
    /// A step.
    Step,
    /// It begins anew, then a step.
    Reset,
    /// It is told to hold, with the fault of a sample that is not finite.
    Hold,
    /// Another commands, in the unit of the export.
    Track(R),
    /// The faults are read and cleared, then a step.
    Faults,
    /// A number of the memory, in SI units, is written over, then a step.
    Memory(Remembered, R),
}

impl<R: Real> Event<R> {
    /// Its name in tables.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Reset => "reset",
            Self::Hold => "hold",
            Self::Track(_) => "track",
            Self::Faults => "faults",
            Self::Memory(Remembered::Command, _) => "command_rad",
            Self::Memory(Remembered::Integral, _) => "integral",
            Self::Memory(Remembered::Gain(gain), _) => GAINS[*gain],
            Self::Memory(Remembered::Derivative, _) => "derivative_rad_s",
            Self::Memory(Remembered::Model, _) => "model_rad",
            Self::Memory(Remembered::ModelRate, _) => "model_rad_s",
        }
    }

    /// Its number in programs.
    #[must_use]
    pub const fn number(&self) -> u8 {
        match self {
            Self::Step => 0,
            Self::Reset => 1,
            Self::Hold => 2,
            Self::Track(_) => 3,
            Self::Faults => 4,
            Self::Memory(Remembered::Command, _) => 5,
            Self::Memory(Remembered::Integral, _) => 6,
            Self::Memory(Remembered::Gain(gain), _) => 7 + *gain as u8,
            Self::Memory(Remembered::Derivative, _) => 10,
            Self::Memory(Remembered::Model, _) => 11,
            Self::Memory(Remembered::ModelRate, _) => 12,
        }
    }

    /// The number that comes with it; 0 where none does.
    #[must_use]
    pub fn given(&self) -> R {
        match *self {
            Self::Track(value) | Self::Memory(_, value) => value,
            Self::Step | Self::Reset | Self::Hold | Self::Faults => R::ZERO,
        }
    }
}

/// A member of the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remembered {
    /// The last command.
    Command,
    /// The integral.
    Integral,
    /// A gain: 0 for kp, 1 for ki, 2 for kd.
    Gain(usize),
    /// The filtered derivative, rad/s.
    Derivative,
    /// Where the reference model is, rad.
    Model,
    /// Its rate, rad/s.
    ModelRate,
}

impl Remembered {
    /// All of them.
    const ALL: [Self; 8] = [
        Self::Command,
        Self::Integral,
        Self::Gain(0),
        Self::Gain(1),
        Self::Gain(2),
        Self::Derivative,
        Self::Model,
        Self::ModelRate,
    ];
}

/// The members of a program's memory that [events](Event) write over, each with the number of its event. What asks a
/// program in another language has to do them all.
pub(crate) fn written_over(program: &Program) -> impl Iterator<Item = (u8, &'static str)> {
    let events = Remembered::ALL.into_iter().map(|which| Event::Memory(which, 0.0));
    let members = events.map(|event| (event.number(), event.name()));
    members
        .filter(|(_, name)| program.members(Part::State).iter().any(|member| member.name == *name))
}

/// What is done, a sample and its answer, in the units of the export.
#[derive(Clone, Debug, PartialEq)]
pub struct Vector<R> {
    /// What is done; a fuzzy system only steps.
    pub event: Event<R>,
    /// What goes in: the members of the sample in their order, of a controller always with the rate.
    pub sample: Vec<R>,
    /// The reals that come out, in the order of the answer's members.
    pub answer: Vec<R>,
    /// The truths and bytes that come out, behind the reals: of a controller, whether the command was cut, and its faults.
    pub marks: Vec<u8>,
}

/// What a controller answers to `count` samples, from a reset on, with nothing but steps.
#[must_use]
pub fn vectors<R: Real>(
    controller: &Controller<R>,
    angles: Angles,
    seed: u64,
    count: usize,
) -> Vec<Vector<R>> {
    flown(Flight::new(controller, angles, false, count), seed)
}

/// The same with every [event](Event) among the steps.
#[must_use]
pub fn eventful<R: Real>(
    controller: &Controller<R>,
    angles: Angles,
    seed: u64,
    count: usize,
) -> Vec<Vector<R>> {
    flown(Flight::new(controller, angles, true, count), seed)
}

fn flown<R: Real>(mut flight: Flight<'_, R>, seed: u64) -> Vec<Vector<R>> {
    let count = flight.count;
    // Few samples are no reason to draw none.
    flight.count = count - count / 4;
    directed::fly(&mut flight);
    flight.count = count;
    drawn::fly(&mut flight, seed);
    flight.vectors
}

/// A controller and what it has answered.
struct Flight<'a, R> {
    controller: &'a Controller<R>,
    angles: Angles,
    has_events: bool,
    count: usize,
    state: State<R>,
    vectors: Vec<Vector<R>>,
}

impl<'a, R: Real> Flight<'a, R> {
    fn new(controller: &'a Controller<R>, angles: Angles, has_events: bool, count: usize) -> Self {
        let vectors = Vec::with_capacity(count);
        Self { controller, angles, has_events, count, state: State::new(), vectors }
    }

    fn is_full(&self) -> bool {
        self.vectors.len() >= self.count
    }

    /// A step with a sample in radians.
    fn step(&mut self, sample: [f64; 3]) {
        self.event(Event::Step, sample);
    }

    /// As before the first sample, where there are events; a step follows.
    fn reset(&mut self, sample: [f64; 3]) {
        self.event(if self.has_events { Event::Reset } else { Event::Step }, sample);
    }

    /// An event, where there are events, with a sample in radians.
    fn event(&mut self, event: Event<R>, sample: [f64; 3]) {
        let per_radian = self.angles.per_radian().map_or(R::ONE, R::from_f64);
        let sample = sample.map(|value| R::from_f64(value) * per_radian);
        if self.has_events || event == Event::Step {
            self.again(event, sample);
        }
    }

    /// Another commands, rad.
    fn track(&mut self, command_rad: f64, sample: [f64; 3]) {
        let per_radian = self.angles.per_radian().map_or(R::ONE, R::from_f64);
        self.event(Event::Track(R::from_f64(command_rad) * per_radian), sample);
    }

    /// An event, with a sample in the unit of the export.
    fn again(&mut self, event: Event<R>, given: [R; 3]) {
        if self.is_full() {
            return;
        }
        let radians = self.angles.radians().map_or(R::ONE, R::from_f64);
        let per_radian = self.angles.per_radian().map_or(R::ONE, R::from_f64);
        let [setpoint_rad, measurement_rad, rate_rad_s] = given.map(|it| it * radians);
        let sample = Sample { setpoint_rad, measurement_rad, rate_rad_s };
        let (controller, state) = (self.controller, &mut self.state);
        match event {
            Event::Step | Event::Hold | Event::Track(_) => {}
            Event::Reset => *state = State::new(),
            Event::Faults => {
                state.take_faults();
            }
            Event::Memory(Remembered::Command, value) => state.command_rad = value,
            Event::Memory(Remembered::Integral, value) => state.integral = value,
            Event::Memory(Remembered::Derivative, value) => state.derivative_rad_s = value,
            Event::Memory(which, value) => {
                if let Some(Previous { gains, model, .. }) = &mut state.previous {
                    let [kp, ki, kd] = [&mut gains.kp, &mut gains.ki, &mut gains.kd];
                    match which {
                        Remembered::Gain(gain) => *[kp, ki, kd][gain] = value,
                        Remembered::Model => model.pitch_rad = value,
                        _ => model.rate_rad_s = value,
                    }
                }
            }
        }
        let step = match event {
            Event::Hold => controller.hold(state, Faults::NOT_FINITE),
            Event::Track(command) => controller.track(state, sample, command * radians),
            _ => controller.step(state, sample),
        };
        let Step { command_rad, gains, saturated, faults } = step;
        self.vectors.push(Vector {
            event,
            sample: given.to_vec(),
            answer: vec![command_rad * per_radian, gains.kp, gains.ki, gains.kd],
            marks: vec![u8::from(saturated), faults.bits()],
        });
    }
}
