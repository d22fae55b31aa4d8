//! Flights of a group forwards and backwards.

use fearless_simd::dispatch;
use fspid_numeric::InstructionSet;

use super::SEGMENT;
use super::law::{Laws, MEMORY};
use super::numbers::NUMBERS;
use super::plant::{Held, Plants};
use crate::batch::{Entrant, Refusal};
use crate::controller::Controller;
use crate::error::SimError;
use crate::propagation::{DIVERGED_RAD, Propagation};
use crate::propagator::Propagator;
use crate::scenario::Prepared;

/// What a flight costs: the sum of these times what it has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weights {
    /// Of $T \sum |r_k - \theta_k|$, rad s.
    pub iae_rad_s: f64,
    /// Of $T \sum (r_k - \theta_k)^2$, rad² s.
    pub ise_rad2_s: f64,
    /// Of the elevator's travel $\sum |\delta_k - \delta_{k-1}|$, rad.
    pub travel_rad: f64,
}

/// A flight's costs and what every number of its controller is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Differentiated {
    /// $T \sum |r_k - \theta_k|$, rad s.
    pub iae_rad_s: f64,
    /// $T \sum (r_k - \theta_k)^2$, rad² s.
    pub ise_rad2_s: f64,
    /// The elevator's travel, rad.
    pub travel_rad: f64,
    /// Derivative of the weighted sum by each number, as [`numbers`](super::numbers()) has them.
    pub gradient: Vec<f64>,
}

/// Costs of up to `W` flights and their gradients; none for a flight that diverges, or in which a sample is held.
///
/// # Errors
/// [`Refusal`] for flights that have no gradient here, or that differ in their structure.
pub fn differentiate<const W: usize>(
    flights: &[Entrant<'_>],
    weights: &[Weights],
) -> Result<Vec<Option<Differentiated>>, Refusal> {
    differentiate_by::<W>(InstructionSet::best(), flights, weights)
}

/// [`differentiate`] by instructions of choice: the bits are the same.
///
/// # Errors
/// As [`differentiate`].
pub fn differentiate_by<const W: usize>(
    instructions: InstructionSet,
    flights: &[Entrant<'_>],
    weights: &[Weights],
) -> Result<Vec<Option<Differentiated>>, Refusal> {
    let mut group = Group::<W>::new(flights, weights)?;
    let flown = dispatch!(instructions.level(), _simd => group.flown());
    // A part of a sample whose matrix cannot be computed ends all lanes: coefficients near overflow.
    Ok(flown.unwrap_or_else(|_| vec![None; flights.len()]))
}

type Lanes<const W: usize> = [f64; W];

/// Where plant and controller are at a sample.
#[derive(Clone, Debug)]
struct State<const W: usize> {
    plant: Vec<Lanes<W>>,
    memory: [Lanes<W>; MEMORY],
    elevator_rad: Lanes<W>,
}

/// What the way back needs of a sample: of the plant its pitch, as it is linear in all else.
#[derive(Clone, Debug)]
struct Passed<const W: usize> {
    memory: [Lanes<W>; MEMORY],
    sample: [Lanes<W>; 3],
    theta_rad: Lanes<W>,
    elevator_rad: Lanes<W>,
    held: Vec<Held>,
}

struct Group<'a, const W: usize> {
    prepared: Vec<&'a Prepared>,
    rows: usize,
    dt_s: f64,
    plants: Plants<'a, W>,
    laws: Laws<'a, W>,
    weights: [Lanes<W>; 3],
    /// Largest set-point and pitch that are believed, and the largest rate where one is used.
    guard: [Lanes<W>; 3],
    /// Commands of all samples.
    commands: Vec<Lanes<W>>,
    /// Room for the states of the next sample.
    room: Vec<Lanes<W>>,
    lost: [bool; W],
    costs: [Lanes<W>; 3],
}

impl<'a, const W: usize> Group<'a, W> {
    fn new(flights: &[Entrant<'a>], weights: &[Weights]) -> Result<Self, Refusal> {
        if flights.len() > W {
            return Err(Refusal::TooMany { found: flights.len(), most: W });
        }
        let propagators = flights.iter().enumerate();
        let propagators: Vec<&Propagator> = propagators
            .map(|(flight, entrant)| propagator(flight, entrant.prepared))
            .collect::<Result<_, _>>()?;
        let prepared: Vec<&Prepared> = flights.iter().map(|it| it.prepared).collect();
        let timing = prepared.first().map(|it| it.timing);
        let differs = |flight, what| Err(Refusal::Differs { flight, what });
        let orders = || propagators.iter().map(|it| it.order());
        if let Some(flight) = orders().position(|order| Some(order) != orders().next()) {
            return differs(flight, "the order of its plant");
        }
        if let Some(flight) = prepared.iter().position(|it| Some(it.timing) != timing) {
            return differs(flight, "its timing");
        }
        let controllers: Vec<&Controller> = flights.iter().map(|it| it.controller).collect();
        let mut lanes = [[0.0; W]; 3];
        for (lane, it) in weights.iter().take(flights.len()).enumerate() {
            let Weights { iae_rad_s, ise_rad2_s, travel_rad } = *it;
            for (place, weight) in lanes.iter_mut().zip([iae_rad_s, ise_rad2_s, travel_rad]) {
                place[lane] = weight;
            }
        }
        let mut guard = [[f64::INFINITY; W]; 3];
        for (lane, controller) in controllers.iter().enumerate() {
            let limit = controller.config().guard.limit_rad();
            (guard[0][lane], guard[1][lane]) = (limit, limit);
            guard[2][lane] = if controller.uses_rate() { limit } else { f64::INFINITY };
        }
        let rows = timing.map_or(0, |it| it.rows());
        Ok(Self {
            rows,
            dt_s: timing.map_or(1.0, |it| it.dt_s()),
            plants: Plants::new(propagators),
            laws: Laws::new(&controllers)?,
            weights: lanes,
            guard,
            commands: vec![[0.0; W]; rows],
            room: Vec::new(),
            lost: [false; W],
            costs: [[0.0; W]; 3],
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

    /// What the controllers see at a sample, and the elevator there.
    #[inline(always)]
    fn look(&self, k: usize, plant: &[Lanes<W>]) -> ([Lanes<W>; 3], Lanes<W>) {
        let elevator_rad = self.plants.elevator_rad(plant, &self.disturbance(k));
        let rate_rad_s = self.plants.rate_rad_s(plant, &elevator_rad);
        let mut measurement_rad = self.at(k, |it| it.at_measurement.as_deref().unwrap_or_default());
        for lane in 0..W {
            measurement_rad[lane] += plant[0][lane];
        }
        let setpoint_rad = self.at(k, |it| &it.setpoint_rad);
        ([setpoint_rad, measurement_rad, rate_rad_s], elevator_rad)
    }

    fn start(&self) -> State<W> {
        let plant = vec![[0.0; W]; self.plants.states()];
        let (sample, elevator_rad) = self.look(0, &plant);
        State { memory: self.laws.first(&sample), plant, elevator_rad }
    }

    /// One sample: the state at the next one, and what there was at this one.
    #[inline(always)]
    fn pass(&mut self, k: usize, state: &mut State<W>) -> Result<Passed<W>, SimError> {
        let (sample, elevator_rad) = self.look(k, &state.plant);
        let (memory, theta_rad, mut held) = (state.memory, state.plant[0], Vec::new());
        state.elevator_rad = elevator_rad;
        state.memory = self.laws.step(&memory, &sample);
        self.commands[k] = state.memory[0];
        let (command, disturbance) = (self.arriving(k), self.disturbance(k));
        let mut next = std::mem::take(&mut self.room);
        next.resize(state.plant.len(), [0.0; W]);
        self.plants.advance((&mut next, &mut held), &state.plant, &command, &disturbance)?;
        self.room = std::mem::replace(&mut state.plant, next);
        Ok(Passed { memory, sample, theta_rad, elevator_rad, held })
    }

    /// Adds what a sample costs, and finds flights that are lost there.
    #[inline(always)]
    fn count(&mut self, k: usize, passed: &Passed<W>, before: &Lanes<W>) {
        let Passed { sample, theta_rad, elevator_rad, .. } = passed;
        for lane in 0..W {
            let error_rad = sample[0][lane] - theta_rad[lane];
            self.costs[0][lane] += error_rad.abs();
            self.costs[1][lane] += error_rad * error_rad;
            let moved_rad = elevator_rad[lane] - before[lane];
            self.costs[2][lane] += if k == 0 { 0.0 } else { moved_rad.abs() };
            let near = (theta_rad[lane].abs() <= DIVERGED_RAD)
                & sample.iter().zip(&self.guard).all(|(it, most)| it[lane].abs() <= most[lane]);
            self.lost[lane] |= !near;
        }
    }

    fn flown(&mut self) -> Result<Vec<Option<Differentiated>>, SimError> {
        let mut kept = Vec::with_capacity(self.rows / SEGMENT + 1);
        let (mut state, mut before) = (self.start(), [0.0; W]);
        for k in 0..self.rows {
            if k.is_multiple_of(SEGMENT) {
                kept.push(state.clone());
            }
            let passed = self.pass(k, &mut state)?;
            self.count(k, &passed, &before);
            before = passed.elevator_rad;
        }
        self.back(kept)?;
        let laws =
            std::mem::replace(&mut self.laws, Laws::new(&[]).map_err(|_| SimError::NotLinear)?);
        let gradients = laws.gradients();
        let each = gradients.into_iter().enumerate().map(|(lane, gradient)| {
            let [iae, ise, travel_rad] = self.costs.map(|it| it[lane]);
            let is_finite = gradient.iter().all(|it| it.is_finite());
            (is_finite && !self.lost[lane]).then(|| Differentiated {
                iae_rad_s: iae * self.dt_s,
                ise_rad2_s: ise * self.dt_s,
                travel_rad,
                gradient: gradient[..NUMBERS].to_vec(),
            })
        });
        Ok(each.collect())
    }

    /// All samples, the last first.
    fn back(&mut self, kept: Vec<State<W>>) -> Result<(), SimError> {
        let mut worth = Worth::<W>::new(self.plants.states(), self.rows);
        let (mut passed, mut after): (Vec<Passed<W>>, Option<Lanes<W>>) = (Vec::new(), None);
        for (segment, mut state) in kept.into_iter().enumerate().rev() {
            let from = segment * SEGMENT;
            // What was kept has the elevator of the sample before.
            let first_before = (from > 0).then_some(state.elevator_rad);
            passed.clear();
            for k in from..(from + SEGMENT).min(self.rows) {
                passed.push(self.pass(k, &mut state)?);
            }
            for (place, at) in passed.iter().enumerate().rev() {
                let k = from + place;
                let last = place.checked_sub(1).and_then(|last| passed.get(last));
                let before = last.map_or(first_before, |it| Some(it.elevator_rad));
                self.back_sample(k, at, (before, after), &mut worth);
                after = Some(at.elevator_rad);
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
        (before, after): (Option<Lanes<W>>, Option<Lanes<W>>),
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
            worth.memory[0][lane] += commanded[lane];
        }
        let (memory, sample) = self.laws.back(&worth.memory);
        worth.memory = memory;
        let mut elevator = [0.0; W];
        for lane in 0..W {
            let here = at.elevator_rad[lane];
            let sign = |other: Option<Lanes<W>>| {
                other.map_or(0.0, |it| {
                    let moved = here - it[lane];
                    if moved > 0.0 {
                        1.0
                    } else if moved < 0.0 {
                        -1.0
                    } else {
                        0.0
                    }
                })
            };
            elevator[lane] = self.weights[2][lane] * (sign(before) + sign(after));
            let error_rad = at.sample[0][lane] - at.theta_rad[lane];
            let sign = if error_rad > 0.0 {
                1.0
            } else if error_rad < 0.0 {
                -1.0
            } else {
                0.0
            };
            let by_error = self.weights[0][lane] * sign + 2.0 * self.weights[1][lane] * error_rad;
            worth.plant[0][lane] += sample[1][lane] - self.dt_s * by_error;
        }
        self.plants.back_seen(&mut worth.plant, &sample[2], &elevator);
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

/// The only plant of a flight, if it has a gradient here.
fn propagator(flight: usize, prepared: &Prepared) -> Result<&Propagator, Refusal> {
    let refused = |what| Err(Refusal::Part { flight, what });
    if prepared.has_sensors() {
        return refused("a sensor");
    }
    let [stage] = prepared.stages.as_slice() else {
        return refused("a plant that changes");
    };
    match &stage.propagation {
        Propagation::AsOne(propagator) if propagator.servo.is_at_once() => {
            refused("a servo without lag")
        }
        Propagation::AsOne(propagator) => Ok(propagator),
        Propagation::ByLegs(_) => refused("an actuator or gusts"),
        Propagation::Aircraft(_) => refused("a nonlinear aircraft"),
        Propagation::External(_) => refused("another simulator"),
    }
}
