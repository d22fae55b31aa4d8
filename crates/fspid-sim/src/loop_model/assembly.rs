//! Assembles the loop's one-sample transition matrix from plant, delay queues and controller.

use fspid_core::equations::{Memory, PidEquations};
use fspid_core::{AntiWindup, Gains, PidConfig, Sample};
use fspid_numeric::Scalar;
use fspid_numeric::scalar::{Base, Dual};

use super::{BreakPoint, Followers, Gathered, LoopModel, LoopSettings, Sensing};

/// Where the parts of the state stand; a part that is not there has no place.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    plant: usize,
    queue: usize,
    pitch: usize,
    rate: usize,
    pub(super) integral: Option<usize>,
    pub(super) derivative: Option<usize>,
    pub(super) previous: Option<usize>,
    gathered: Option<usize>,
    size: usize,
}

impl Layout {
    pub(super) fn size(&self) -> usize {
        self.size
    }

    fn pitch_from(&self) -> usize {
        self.plant + self.queue
    }

    fn rate_from(&self) -> usize {
        self.pitch_from() + self.pitch
    }

    pub(super) fn names(&self) -> Vec<String> {
        let numbered = |what: &str, count: usize| -> Vec<String> {
            (1..=count).map(|number| format!("{what} {number}")).collect()
        };
        let mut names = numbered("plant", self.plant);
        names.extend(numbered("command on its way", self.queue));
        names.extend(numbered("pitch before", self.pitch));
        names.extend(numbered("rate before", self.rate));
        names.extend(self.integral.map(|_| "integral".to_owned()));
        names.extend(self.derivative.map(|_| "derivative".to_owned()));
        names.extend(self.previous.map(|_| "last sample".to_owned()));
        names.extend(self.gathered.map(|_| "gains".to_owned()));
        names
    }
}

/// A loop with its gains, taken apart at the command, the seen pitch and the seen rate.
#[derive(Clone, Debug)]
pub(super) struct Assembly<T> {
    pub(super) layout: Layout,
    /// Next state by state, with command, seen pitch and seen rate at zero.
    free: Vec<Vec<T>>,
    /// Next state by command.
    by_command: Vec<T>,
    /// Next memory of the controller by seen pitch, and by seen rate.
    memory_by_pitch: Vec<T>,
    memory_by_rate: Vec<T>,
    /// Seen pitch and seen rate by state.
    pitch: Vec<T>,
    rate: Vec<T>,
    /// Command by memory, by seen pitch, by seen rate.
    own_command: Vec<T>,
    command_by_pitch: T,
    command_by_rate: T,
    term_by_integral: T,
}

/// A loop that is broken: next state by state and by the signal that enters, and what comes back.
#[derive(Clone, Debug)]
pub(super) struct OpenLoop<T> {
    pub(super) matrix: Vec<Vec<T>>,
    pub(super) entry: Vec<T>,
    pub(super) exit: Vec<T>,
}

/// Everything from the command to what is seen.
pub(super) struct OpenPlant<T> {
    /// Next state by state, with the command at zero and with the command of the rate loop.
    pub(super) matrix: Vec<Vec<T>>,
    pub(super) matrix_with_rate: Vec<Vec<T>>,
    /// Next state by command.
    pub(super) by_command: Vec<T>,
    /// Seen pitch, and what comes back through the seen rate, by state.
    pub(super) pitch: Vec<T>,
    pub(super) by_rate: Vec<T>,
}

/// The controller at one sample: its command and next memory, by memory (over the state) and by seen
/// pitch; the rate only enters the command and what is gathered.
struct ControllerRows<T> {
    command: Vec<T>,
    command_by_pitch: T,
    command_by_rate: T,
    /// The integral's term of the command by its memory.
    term_by_integral: T,
    /// Place in the state, next value by state, by seen pitch.
    memory: Vec<(usize, Vec<T>, T)>,
    /// What is gathered, by seen rate.
    gathered_by_rate: T,
}

impl<T: Base> LoopModel<T> {
    pub(super) fn layout(&self) -> Layout {
        let settings = &self.settings;
        let plant = self.plant.states;
        let queue = settings.delay_samples;
        let pitch = settings.pitch.remembered();
        let rate = if self.uses_rate() { settings.rate.remembered() } else { 0 };
        let mut size = plant + queue + pitch + rate;
        let mut place = |there: bool| {
            there.then(|| {
                size += 1;
                size - 1
            })
        };
        let memory = settings.memory;
        let integral = place(memory.integral);
        let derivative = place(memory.derivative);
        let previous = place(memory.previous);
        let gathered = place(self.gathered.is_some());
        Layout { plant, queue, pitch, rate, integral, derivative, previous, gathered, size }
    }

    pub(super) fn assembly(&self, gains: Gains<T>) -> Assembly<T> {
        let layout = self.layout();
        let size = layout.size;
        let zeros = || vec![T::zero(); size];
        let pitch = seen(&self.settings.pitch, &unit(0, size), layout.pitch_from());
        let mut rate = zeros();
        if self.uses_rate() {
            let mut now = zeros();
            now[..layout.plant].copy_from_slice(&self.plant.rate);
            rate = seen(&self.settings.rate, &now, layout.rate_from());
        }
        let mut free = vec![zeros(); size];
        let mut by_command = zeros();
        self.place_plant(&layout, &mut free, &mut by_command);
        self.place_queues(&layout, &mut free, &mut by_command);

        let controller = self.controller(gains, &layout);
        let (mut memory_by_pitch, mut memory_by_rate) = (zeros(), zeros());
        if let Some(place) = layout.gathered {
            memory_by_rate[place] = controller.gathered_by_rate;
        }
        for (place, by_state, by_seen_pitch) in controller.memory {
            free[place] = by_state;
            memory_by_pitch[place] = by_seen_pitch;
        }
        Assembly {
            layout,
            free,
            by_command,
            memory_by_pitch,
            memory_by_rate,
            pitch,
            rate,
            own_command: controller.command,
            command_by_pitch: controller.command_by_pitch,
            command_by_rate: controller.command_by_rate,
            term_by_integral: controller.term_by_integral,
        }
    }

    fn place_plant(&self, layout: &Layout, free: &mut [Vec<T>], by_command: &mut [T]) {
        let states = layout.plant;
        for (place, row) in self.plant.rows.chunks_exact(states + 1).enumerate() {
            let (by_state, by_arriving) = row.split_at(states);
            free[place][..states].copy_from_slice(by_state);
            // The oldest command of the queue arrives, or this sample's own.
            if layout.queue > 0 {
                free[place][states] = by_arriving[0];
            } else {
                by_command[place] = by_arriving[0];
            }
        }
    }

    fn place_queues(&self, layout: &Layout, free: &mut [Vec<T>], by_command: &mut [T]) {
        for place in 0..layout.queue {
            let row = layout.plant + place;
            if place + 1 == layout.queue {
                by_command[row] = T::one();
            } else {
                free[row][row + 1] = T::one();
            }
        }
        for place in 0..layout.pitch {
            let row = layout.pitch_from() + place;
            let from = if place == 0 { 0 } else { row - 1 };
            free[row][from] = T::one();
        }
        for place in 0..layout.rate {
            let row = layout.rate_from() + place;
            if place == 0 {
                free[row][..layout.plant].copy_from_slice(&self.plant.rate);
            } else {
                free[row][row - 1] = T::one();
            }
        }
    }

    /// The controller's own equations with the set-point at zero and no limit at work, derived by what it
    /// sees and remembers; and, where there is a change gain g, $u + g (c - c_{k-1})$.
    fn controller(&self, gains: Gains<T>, layout: &Layout) -> ControllerRows<T> {
        let places = [layout.integral, layout.derivative, layout.previous];
        // A part of the memory that is left away is one that no gain lets out.
        let ki = if layout.integral.is_some() { gains.ki } else { T::zero() };
        let kd = if layout.previous.is_some() { gains.kd } else { T::zero() };
        let slopes = Slopes::at_rest(&self.settings, Gains { ki, kd, ..gains });
        let row = |slope: &Slope<T>| {
            let mut row = vec![T::zero(); layout.size];
            for (place, by) in places.into_iter().zip(&slope.derivative[REMEMBERED..]) {
                if let Some(place) = place {
                    row[place] = *by;
                }
            }
            row
        };
        let Slopes { command, memory, term_by_integral } = slopes;
        let mut rows = ControllerRows {
            command: row(&command),
            command_by_pitch: command.derivative[PITCH],
            command_by_rate: command.derivative[RATE],
            term_by_integral,
            memory: Vec::new(),
            gathered_by_rate: T::zero(),
        };
        for (place, next) in places.into_iter().zip(&memory) {
            rows.memory.extend(place.map(|place| (place, row(next), next.derivative[PITCH])));
        }
        if let Some(previous) = layout.previous {
            rows.command[previous] = rows.command[previous] - self.change_gain;
            rows.command_by_pitch = rows.command_by_pitch - self.change_gain;
        }
        if let (Some(place), Some(gathered)) = (layout.gathered, &self.gathered) {
            rows.gather(gathered, place, layout);
        }
        rows
    }
}

impl<T: Base> ControllerRows<T> {
    /// What gains that remember make of a constant part of the command, as a state and in the command.
    fn gather(&mut self, gathered: &Gathered<T>, place: usize, layout: &Layout) {
        let Gathered { keeps, by_error, by_change, by_rate } = *gathered;
        let mut row = vec![T::zero(); layout.size];
        row[place] = keeps;
        // The error is the seen pitch with its sign turned.
        let mut by_pitch = -by_error;
        if let Some(previous) = layout.previous {
            row[previous] = -by_change;
            by_pitch = by_pitch - by_change;
        }
        for (command, by_state) in self.command.iter_mut().zip(&row) {
            *command = *command + *by_state;
        }
        self.command_by_pitch = self.command_by_pitch + by_pitch;
        self.command_by_rate = self.command_by_rate - by_rate;
        self.gathered_by_rate = -by_rate;
        self.memory.push((place, row, by_pitch));
    }
}

/// What the controller sees and remembers: pitch, rate, integral, derivative, last sample.
const INPUTS: usize = 5;
const PITCH: usize = 0;
const RATE: usize = 1;
/// The first that is remembered.
const REMEMBERED: usize = 2;

/// A number of the controller and how it moves with each of them.
type Slope<T> = Dual<T, INPUTS>;

/// The controller at rest.
struct Slopes<T> {
    command: Slope<T>,
    /// Next integral, derivative and last sample.
    memory: [Slope<T>; INPUTS - REMEMBERED],
    /// The integral's term of the command by its memory.
    term_by_integral: T,
}

impl<T: Base> Slopes<T> {
    fn at_rest(settings: &LoopSettings, gains: Gains<T>) -> Self {
        let no_limit = PidConfig { anti_windup: AntiWindup::None, ..settings.config };
        let Followers { coupling, nominal } = settings.followers;
        let equations = PidEquations::new(&no_limit, nominal, coupling).lifted();
        let [measurement_rad, rate_rad_s, integral, derivative_rad_s, last_rad] =
            Slope::variables([T::zero(); INPUTS]);
        let sample = Sample { setpoint_rad: Slope::zero(), measurement_rad, rate_rad_s };
        let Gains { kp, ki, kd } = gains;
        let gains = Gains { kp: Slope::fixed(kp), ki: Slope::fixed(ki), kd: Slope::fixed(kd) };
        let memory = Memory {
            integral,
            derivative_rad_s,
            error_rad: last_rad,
            derivative_input_rad: last_rad,
            ..equations.at_first(&sample, &gains)
        };
        let free = equations.free(&memory, &sample, &gains);
        let term_rad = equations.unclamped_rad(integral, gains.ki);
        Self {
            command: free.command_rad,
            memory: [free.wound, free.derivative_rad_s, free.derivative_input_rad],
            term_by_integral: term_rad.derivative[REMEMBERED],
        }
    }
}

impl<T: Base> Assembly<T> {
    /// Command by state, through pitch and rate where these loops are closed.
    fn command_through(&self, pitch: bool, rate: bool) -> Vec<T> {
        let by_pitch = if pitch { self.command_by_pitch } else { T::zero() };
        let by_rate = if rate { self.command_by_rate } else { T::zero() };
        let seen = self.pitch.iter().zip(&self.rate);
        let rows = self.own_command.iter().zip(seen);
        rows.map(|(own, (y, q))| *own + by_pitch * *y + by_rate * *q).collect()
    }

    /// Command by state.
    pub(super) fn command(&self) -> Vec<T> {
        self.command_through(true, true)
    }

    /// Next state by state with the command at zero, the memory of what is seen where these loops are closed.
    fn remembering(&self, pitch: bool, rate: bool) -> Vec<Vec<T>> {
        let zeros = vec![T::zero(); self.layout.size];
        let by_pitch = if pitch { &self.memory_by_pitch } else { &zeros };
        let by_rate = if rate { &self.memory_by_rate } else { &zeros };
        with(&with(&self.free, by_pitch, &self.pitch), by_rate, &self.rate)
    }

    pub(super) fn closed(&self) -> Vec<Vec<T>> {
        with(&self.remembering(true, true), &self.by_command, &self.command())
    }

    pub(super) fn broken(&self, point: BreakPoint) -> OpenLoop<T> {
        match point {
            BreakPoint::Command => OpenLoop {
                matrix: self.remembering(true, true),
                entry: self.by_command.clone(),
                exit: self.command(),
            },
            BreakPoint::Pitch => {
                let own = self.memory_by_pitch.iter().zip(&self.by_command);
                OpenLoop {
                    matrix: with(
                        &self.remembering(false, true),
                        &self.by_command,
                        &self.command_through(false, true),
                    ),
                    entry: own.map(|(own, by)| *own + self.command_by_pitch * *by).collect(),
                    exit: self.pitch.clone(),
                }
            }
            BreakPoint::Rate => {
                let own = self.memory_by_rate.iter().zip(&self.by_command);
                OpenLoop {
                    matrix: with(
                        &self.remembering(true, false),
                        &self.by_command,
                        &self.command_through(true, false),
                    ),
                    entry: own.map(|(own, by)| *own + self.command_by_rate * *by).collect(),
                    exit: self.rate.clone(),
                }
            }
        }
    }

    /// The loop broken at the command, and what comes back through the seen pitch with the controller's memory, and through
    /// the seen rate.
    pub(super) fn ways(&self) -> (OpenLoop<T>, [Vec<T>; 2]) {
        let by_rate = self.rate.iter().map(|rate| self.command_by_rate * *rate).collect();
        (self.broken(BreakPoint::Command), [self.command_through(true, false), by_rate])
    }

    /// What is between command and seen signals, for a loop without memory of its controller.
    pub(super) fn plant(self) -> OpenPlant<T> {
        let by_rate = self.rate.iter().map(|rate| -(self.command_by_rate * *rate)).collect();
        let returned = self.command_through(false, true);
        OpenPlant {
            matrix_with_rate: with(&self.free, &self.by_command, &returned),
            matrix: self.free,
            by_command: self.by_command,
            by_rate,
            pitch: self.pitch,
        }
    }

    pub(super) fn command_by_seen(&self) -> [T; 2] {
        [self.command_by_pitch, self.command_by_rate]
    }

    pub(super) fn arriving(&self) -> Vec<T> {
        match self.layout.queue {
            0 => self.command(),
            _ => unit(self.layout.plant, self.layout.size),
        }
    }

    pub(super) fn integral_term(&self) -> Vec<T> {
        let Some(place) = self.layout.integral else {
            return vec![T::zero(); self.layout.size];
        };
        let by_pitch = self.memory_by_pitch[place];
        let next = self.free[place].iter().zip(&self.pitch);
        next.map(|(own, pitch)| self.term_by_integral * (*own + by_pitch * *pitch)).collect()
    }

    pub(super) fn pitch_off(&self, pitch: T, scale: f64) -> Vec<T> {
        let layout = &self.layout;
        let mut state = vec![T::zero(); layout.size];
        state[0] = pitch;
        state[layout.pitch_from()..layout.rate_from()].fill(pitch);
        if let Some(previous) = layout.previous {
            state[previous] = -(T::constant(scale) * pitch);
        }
        state
    }

    pub(super) fn error_rows(&self) -> [Vec<T>; 2] {
        let error: Vec<T> = self.pitch.iter().map(|y| -*y).collect();
        let mut change = vec![T::zero(); error.len()];
        if let Some(previous) = self.layout.previous {
            change.clone_from(&error);
            // With the set-point at zero the last derivative input is the last error.
            change[previous] = change[previous] - T::one();
        }
        [error, change]
    }
}

/// A matrix with an outer product added.
fn with<T: Scalar>(rows: &[Vec<T>], column: &[T], row: &[T]) -> Vec<Vec<T>> {
    let added = |(entries, by): (&Vec<T>, &T)| -> Vec<T> {
        entries.iter().zip(row).map(|(entry, value)| *entry + *by * *value).collect()
    };
    rows.iter().zip(column).map(added).collect()
}

fn unit<T: Scalar>(place: usize, size: usize) -> Vec<T> {
    (0..size).map(|column| if column == place { T::one() } else { T::zero() }).collect()
}

/// What a sensor shows, by state, of a quantity that is `now` and was at the places from `before` on.
fn seen<T: Scalar>(sensing: &Sensing, now: &[T], before: usize) -> Vec<T> {
    let aged = |samples: usize| match samples {
        0 => now.to_vec(),
        _ => unit(before + samples - 1, now.len()),
    };
    let scale = T::constant(sensing.scale);
    let newer = aged(sensing.samples);
    if sensing.part == 0.0 {
        return newer.into_iter().map(|value| scale * value).collect();
    }
    let part = T::constant(sensing.part);
    let older = aged(sensing.samples + 1);
    let between = newer.into_iter().zip(older).map(|(new, old)| new + part * (old - new));
    between.map(|value| scale * value).collect()
}
