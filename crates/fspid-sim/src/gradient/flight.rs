//! Flights of a group forwards and backwards.

use fearless_simd::dispatch;
use fspid_numeric::InstructionSet;

use super::SEGMENT;
use super::law::{Laws, MEMORY, Structure};
use super::numbers::NUMBERS;
use super::plant::{Held, Lane, Plants};
use super::price::{Flown, Slopes};
use super::seeing::Seeing;
use crate::batch::{Entrant, Refusal};
use crate::controller::Controller;
use crate::error::SimError;
use crate::propagation::DIVERGED_RAD;
use crate::scenario::Prepared;
use crate::timing::Timing;

/// The gradients of up to `W` flights with respect to every number of their controllers, as
/// [`numbers`](super::numbers()) has them; none for a flight that diverges, or in which a sample is held. `price` is
/// shown each flight by its place and answers what a little more of each of its samples costs.
///
/// # Errors
/// [`Refusal`] for flights that have no gradient here, or that differ in their structure.
pub fn differentiate_prices<const W: usize>(
    instructions: InstructionSet,
    flights: &[Entrant<'_>],
    mut price: impl FnMut(usize, &Flown) -> Slopes,
) -> Result<Vec<Option<Vec<f64>>>, Refusal> {
    differentiated::<W>(instructions, flights, &mut price)
}

/// What a little more of each sample of a flight costs.
type Price<'a> = dyn FnMut(usize, &Flown) -> Slopes + 'a;

// Built once for all prices.
fn differentiated<const W: usize>(
    instructions: InstructionSet,
    flights: &[Entrant<'_>],
    price: &mut Price<'_>,
) -> Result<Vec<Option<Vec<f64>>>, Refusal> {
    let mut group = Group::<W>::new(flights)?;
    let flown = dispatch!(instructions.level(), _simd => group.flown(price));
    // A part of a sample whose matrix cannot be computed ends all lanes: coefficients near overflow.
    Ok(flown.unwrap_or_else(|_| vec![None; flights.len()]))
}

/// What flights must have in common to be differentiated side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    order: usize,
    timing: Timing,
    structure: Structure,
}

impl Kind {
    /// The kind of a flight.
    ///
    /// # Errors
    /// [`Refusal`] for one that has no gradient.
    pub fn of(flight: &Entrant<'_>) -> Result<Self, Refusal> {
        let lane = Lane::of(0, flight.prepared)?;
        Seeing::<1>::check(0, flight.prepared)?;
        Laws::<1>::check(0, flight.controller)?;
        let structure = Structure::of(flight.controller);
        Ok(Self { order: lane.propagator.order(), timing: flight.prepared.timing, structure })
    }
}

type Lanes<const W: usize> = [f64; W];

/// Where plant and controller are at a sample.
#[derive(Clone, Debug)]
struct State<const W: usize> {
    plant: Vec<Lanes<W>>,
    memory: [Lanes<W>; MEMORY],
}

/// What the way back needs of a sample: nothing of the plant, which is linear.
#[derive(Clone, Debug)]
struct Passed<const W: usize> {
    memory: [Lanes<W>; MEMORY],
    sample: [Lanes<W>; 3],
    held: Vec<Held>,
}

struct Group<'a, const W: usize> {
    prepared: Vec<&'a Prepared>,
    rows: usize,
    plants: Plants<'a, W>,
    laws: Laws<'a, W>,
    seeing: Seeing<W>,
    /// Largest set-point and pitch that are believed, and the largest rate where one is used.
    guard: [Lanes<W>; 3],
    /// Commands and elevators of all samples.
    commands: Vec<Lanes<W>>,
    elevators: Vec<Lanes<W>>,
    /// Room for the states of the next sample.
    room: Vec<Lanes<W>>,
    lost: [bool; W],
}

impl<'a, const W: usize> Group<'a, W> {
    fn new(flights: &[Entrant<'a>]) -> Result<Self, Refusal> {
        if flights.len() > W {
            return Err(Refusal::TooMany { found: flights.len(), most: W });
        }
        let lanes = flights.iter().enumerate();
        let lanes: Vec<Lane<'a>> = lanes
            .map(|(flight, entrant)| Lane::of(flight, entrant.prepared))
            .collect::<Result<_, _>>()?;
        let prepared: Vec<&Prepared> = flights.iter().map(|it| it.prepared).collect();
        let timing = prepared.first().map(|it| it.timing);
        let differs = |flight, what| Err(Refusal::Differs { flight, what });
        let orders = || lanes.iter().map(|it| it.propagator.order());
        if let Some(flight) = orders().position(|order| Some(order) != orders().next()) {
            return differs(flight, "the order of its plant");
        }
        if let Some(flight) = prepared.iter().position(|it| Some(it.timing) != timing) {
            return differs(flight, "its timing");
        }
        let controllers: Vec<&Controller> = flights.iter().map(|it| it.controller).collect();
        let mut guard = [[f64::INFINITY; W]; 3];
        for (lane, controller) in controllers.iter().enumerate() {
            let limit = controller.config().guard.limit_rad();
            (guard[0][lane], guard[1][lane]) = (limit, limit);
            guard[2][lane] = if controller.uses_rate() { limit } else { f64::INFINITY };
        }
        let rows = timing.map_or(0, |it| it.rows());
        Ok(Self {
            rows,
            plants: Plants::new(lanes),
            laws: Laws::new(&controllers)?,
            seeing: Seeing::new(&prepared, rows)?,
            guard,
            commands: vec![[0.0; W]; rows],
            elevators: vec![[0.0; W]; rows],
            room: Vec::new(),
            lost: [false; W],
            prepared,
        })
    }

    /// A signal at a sample; zero where there is none.
    #[inline(always)]
    fn at(&self, k: usize, column: impl Fn(&'a Prepared) -> &'a [f64]) -> Lanes<W> {
        let mut values = [0.0; W];
        for (value, prepared) in values.iter_mut().zip(&self.prepared) {
            *value = column(prepared).get(k).copied().unwrap_or(0.0);
        }
        values
    }

    fn disturbance(&self, k: usize) -> Lanes<W> {
        self.at(k, |it| it.at_elevator.as_deref().unwrap_or_default())
    }

    /// The command that arrives at the servo at a sample.
    #[inline(always)]
    fn arriving(&self, k: usize) -> Lanes<W> {
        let mut arriving = self.at(k, |it| it.at_servo.as_deref().unwrap_or_default());
        for (lane, prepared) in self.prepared.iter().enumerate() {
            if let Some(sent) = k.checked_sub(prepared.delay_samples) {
                arriving[lane] += self.commands[sent][lane];
            }
        }
        arriving
    }

    /// What controllers see at a sample.
    #[inline(always)]
    fn look(&mut self, k: usize, plant: &[Lanes<W>]) -> [Lanes<W>; 3] {
        let elevator_rad = self.plants.elevator_rad(plant, &self.disturbance(k));
        self.elevators[k] = elevator_rad;
        let rate_rad_s = self.plants.rate_rad_s(plant, &elevator_rad);
        let [mut measurement_rad, rate_rad_s] = self.seeing.look(k, [plant[0], rate_rad_s]);
        let added = self.at(k, |it| it.at_measurement.as_deref().unwrap_or_default());
        for lane in 0..W {
            measurement_rad[lane] += added[lane];
        }
        let setpoint_rad = self.at(k, |it| &it.setpoint_rad);
        [setpoint_rad, measurement_rad, rate_rad_s]
    }

    fn start(&mut self) -> State<W> {
        let plant = vec![[0.0; W]; self.plants.states()];
        let sample = self.look(0, &plant);
        State { memory: self.laws.first(&sample), plant }
    }

    /// One sample: the state at the next one, and what there was at this one.
    #[inline(always)]
    fn pass(&mut self, k: usize, state: &mut State<W>) -> Result<Passed<W>, SimError> {
        let sample = self.look(k, &state.plant);
        let (memory, mut held) = (state.memory, Vec::new());
        state.memory = self.laws.step(&memory, &sample);
        self.commands[k] = state.memory[0];
        let (command, disturbance) = (self.arriving(k), self.disturbance(k));
        let mut next = std::mem::take(&mut self.room);
        next.resize(state.plant.len(), [0.0; W]);
        self.plants.advance((&mut next, &mut held), &state.plant, &command, &disturbance)?;
        self.plants.add_air(k, &mut next);
        self.room = std::mem::replace(&mut state.plant, next);
        Ok(Passed { memory, sample, held })
    }

    /// Finds flights that are lost at a sample.
    #[inline(always)]
    fn watch(&mut self, theta_rad: &Lanes<W>, sample: &[Lanes<W>; 3]) {
        for lane in 0..W {
            let near = (theta_rad[lane].abs() <= DIVERGED_RAD)
                & sample.iter().zip(&self.guard).all(|(it, most)| it[lane].abs() <= most[lane]);
            self.lost[lane] |= !near;
        }
    }

    // Inlined with all below it, so that its loops are compiled for each set of instructions.
    #[inline(always)]
    fn flown(&mut self, price: &mut Price<'_>) -> Result<Vec<Option<Vec<f64>>>, SimError> {
        let mut kept = Vec::with_capacity(self.rows / SEGMENT + 1);
        let mut state = self.start();
        for k in 0..self.rows {
            if k.is_multiple_of(SEGMENT) {
                kept.push(state.clone());
            }
            let theta_rad = state.plant[0];
            let passed = self.pass(k, &mut state)?;
            self.watch(&theta_rad, &passed.sample);
        }
        let mut slopes = vec![[[0.0; W]; 3]; self.rows];
        for lane in (0..self.prepared.len()).filter(|lane| !self.lost[*lane]) {
            put_slopes(&mut slopes, lane, &price(lane, &self.seen(lane)));
        }
        self.back(kept, &slopes)?;
        let laws =
            std::mem::replace(&mut self.laws, Laws::new(&[]).map_err(|_| SimError::NotLinear)?);
        let each = laws.gradients().into_iter().enumerate().map(|(lane, gradient)| {
            let is_finite = gradient.iter().all(|it| it.is_finite());
            (is_finite && !self.lost[lane]).then(|| gradient[..NUMBERS].to_vec())
        });
        Ok(each.collect())
    }

    /// A lane as it was flown.
    fn seen(&self, lane: usize) -> Flown {
        let column = |values: &[Lanes<W>]| values.iter().map(|it| it[lane]).collect();
        Flown {
            setpoint_rad: self.prepared[lane].setpoint_rad.clone(),
            theta_rad: column(self.seeing.theta_rad()),
            elevator_rad: column(&self.elevators),
            command_rad: column(&self.commands),
        }
    }

    /// All samples, the last first.
    #[inline(always)]
    fn back(&mut self, kept: Vec<State<W>>, slopes: &[[Lanes<W>; 3]]) -> Result<(), SimError> {
        let mut worth = Worth::<W>::new(self.plants.states(), self.rows);
        let mut passed: Vec<Passed<W>> = Vec::new();
        for (segment, mut state) in kept.into_iter().enumerate().rev() {
            let from = segment * SEGMENT;
            passed.clear();
            for k in from..(from + SEGMENT).min(self.rows) {
                passed.push(self.pass(k, &mut state)?);
            }
            for (place, at) in passed.iter().enumerate().rev() {
                let k = from + place;
                self.back_sample(k, at, &slopes[k], &mut worth);
            }
        }
        let setpoint_rad = self.at(0, |it| &it.setpoint_rad);
        self.laws.back_first(&setpoint_rad, &worth.memory);
        Ok(())
    }

    #[inline(always)]
    fn back_sample(
        &mut self,
        k: usize,
        at: &Passed<W>,
        [by_theta, by_elevator, by_command]: &[Lanes<W>; 3],
        worth: &mut Worth<W>,
    ) {
        // The values of the recorded equations at this sample.
        self.laws.step(&at.memory, &at.sample);
        let command = self.arriving(k);
        let of_command = self.plants.back(&worth.plant, &command, &at.held, &mut worth.before);
        std::mem::swap(&mut worth.plant, &mut worth.before);
        for (lane, prepared) in self.prepared.iter().enumerate() {
            if let Some(sent) = k.checked_sub(prepared.delay_samples) {
                worth.commands[sent][lane] += of_command[lane];
            }
        }
        let commanded = worth.commands[k];
        for lane in 0..W {
            worth.memory[0][lane] += commanded[lane] + by_command[lane];
        }
        let (memory, sample) = self.laws.back(&worth.memory);
        worth.memory = memory;
        let [theta, rate] = self.seeing.back(k, [sample[1], sample[2]]);
        for lane in 0..W {
            worth.plant[0][lane] += theta[lane] + by_theta[lane];
        }
        self.plants.back_seen(&mut worth.plant, &rate, by_elevator);
    }
}

/// Puts the slopes of a lane by pitch, elevator and command beside those of the others.
fn put_slopes<const W: usize>(lanes: &mut [[Lanes<W>; 3]], lane: usize, slopes: &Slopes) {
    let columns = [&slopes.theta_rad, &slopes.elevator_rad, &slopes.command_rad];
    for (column, values) in columns.into_iter().enumerate() {
        for (row, value) in lanes.iter_mut().zip(values) {
            row[column][lane] = *value;
        }
    }
}

/// What everything is worth on the way back.
struct Worth<const W: usize> {
    plant: Vec<Lanes<W>>,
    before: Vec<Lanes<W>>,
    memory: [Lanes<W>; MEMORY],
    commands: Vec<Lanes<W>>,
}

impl<const W: usize> Worth<W> {
    fn new(states: usize, rows: usize) -> Self {
        Self {
            plant: vec![[0.0; W]; states],
            before: vec![[0.0; W]; states],
            memory: [[0.0; W]; MEMORY],
            commands: vec![[0.0; W]; rows],
        }
    }
}
