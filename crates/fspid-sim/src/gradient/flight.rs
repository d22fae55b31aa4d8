//! Forward simulation and adjoint backward pass of a group of flights.

use fearless_simd::dispatch;
use fspid_numeric::InstructionSet;

use super::SEGMENT;
use super::law::{Laws, MEMORY, ROW, Row, Structure};
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
    /// The controllers' memory, and room for what they see.
    row: Row<W>,
}

/// What the way back needs of samples: nothing of the plants, which are linear.
#[derive(Clone, Debug)]
struct Passed<const W: usize> {
    rows: Vec<Row<W>>,
    /// Samples in which a rate limit holds a lane, the first first.
    held: Vec<(usize, Held)>,
}

impl<const W: usize> Passed<W> {
    fn clear(&mut self) {
        self.rows.clear();
        self.held.clear();
    }
}

/// What comes from outside, sample by sample; nothing where no lane has any.
#[derive(Clone, Debug)]
struct Signal<const W: usize>(Vec<Lanes<W>>);

impl<const W: usize> Signal<W> {
    fn new(
        prepared: &[&Prepared],
        rows: usize,
        column: impl Fn(&Prepared) -> Option<&[f64]>,
    ) -> Self {
        let mut all = Vec::new();
        for (lane, values) in prepared.iter().map(|it| column(it)).enumerate() {
            let Some(values) = values else { continue };
            all.resize(rows, [0.0; W]);
            for (place, value) in all.iter_mut().zip(values) {
                place[lane] = *value;
            }
        }
        Self(all)
    }

    #[inline(always)]
    fn at(&self, k: usize) -> Lanes<W> {
        self.0.get(k).copied().unwrap_or([0.0; W])
    }
}

struct Group<'a, const W: usize> {
    prepared: Vec<&'a Prepared>,
    rows: usize,
    /// Most samples between two states that are kept, and most samples of lanes that a rate limit holds there.
    segment: usize,
    setpoint_rad: Signal<W>,
    at_servo: Signal<W>,
    at_elevator: Signal<W>,
    at_measurement: Signal<W>,
    /// Samples between a command and its arrival; one number where it is that of all lanes.
    delay_samples: [usize; W],
    shared_delay: Option<usize>,
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
        let mut delay_samples = [prepared.first().map_or(0, |it| it.delay_samples); W];
        for (delay, prepared) in delay_samples.iter_mut().zip(&prepared) {
            *delay = prepared.delay_samples;
        }
        Ok(Self {
            rows,
            segment: SEGMENT,
            setpoint_rad: Signal::new(&prepared, rows, |it| Some(&it.setpoint_rad)),
            at_servo: Signal::new(&prepared, rows, |it| it.at_servo.as_deref()),
            at_elevator: Signal::new(&prepared, rows, |it| it.at_elevator.as_deref()),
            at_measurement: Signal::new(&prepared, rows, |it| it.at_measurement.as_deref()),
            shared_delay: delay_samples
                .iter()
                .all(|it| *it == delay_samples[0])
                .then_some(delay_samples[0]),
            delay_samples,
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

    /// The command that arrives at the servo at a sample.
    #[inline(always)]
    fn arriving(&self, k: usize) -> Lanes<W> {
        let mut arriving = self.at_servo.at(k);
        if let Some(delay) = self.shared_delay {
            let sent = k.checked_sub(delay).map_or([0.0; W], |sent| self.commands[sent]);
            for lane in 0..W {
                arriving[lane] += sent[lane];
            }
            return arriving;
        }
        for (lane, delay) in self.delay_samples.iter().enumerate() {
            if let Some(sent) = k.checked_sub(*delay) {
                arriving[lane] += self.commands[sent][lane];
            }
        }
        arriving
    }

    /// Puts what controllers see at a sample into its row.
    #[inline(always)]
    fn look(&mut self, k: usize, State { plant, row }: &mut State<W>) {
        let elevator_rad = self.plants.elevator_rad(plant, &self.at_elevator.at(k));
        self.elevators[k] = elevator_rad;
        let rate_rad_s = self.plants.rate_rad_s(plant, &elevator_rad);
        let [mut measurement_rad, rate_rad_s] = self.seeing.look(k, [plant[0], rate_rad_s]);
        let added = self.at_measurement.at(k);
        for lane in 0..W {
            measurement_rad[lane] += added[lane];
        }
        row[MEMORY..].copy_from_slice(&[self.setpoint_rad.at(k), measurement_rad, rate_rad_s]);
    }

    fn start(&mut self) -> State<W> {
        let plant = vec![[0.0; W]; self.plants.states()];
        let mut state = State { plant, row: [[0.0; W]; ROW] };
        self.look(0, &mut state);
        self.laws.first(&mut state.row);
        state
    }

    /// One sample: the state at the next one, and what there was at this one.
    #[inline(always)]
    fn pass(
        &mut self,
        k: usize,
        state: &mut State<W>,
        passed: &mut Passed<W>,
    ) -> Result<(), SimError> {
        self.look(k, state);
        passed.rows.push(state.row);
        self.laws.step(&mut state.row);
        self.commands[k] = state.row[0];
        let (command, disturbance) = (self.arriving(k), self.at_elevator.at(k));
        let mut next = std::mem::take(&mut self.room);
        next.resize(state.plant.len(), [0.0; W]);
        let held = |it| passed.held.push((k, it));
        self.plants.advance((&mut next, held), &state.plant, &command, &disturbance)?;
        self.plants.add_air(k, &mut next);
        self.room = std::mem::replace(&mut state.plant, next);
        Ok(())
    }

    /// Finds flights that are lost at a sample.
    #[inline(always)]
    fn watch(&mut self, theta_rad: &Lanes<W>, row: &Row<W>) {
        for lane in 0..W {
            self.lost[lane] |= !(theta_rad[lane].abs() <= DIVERGED_RAD);
        }
        for (seen, most) in row[MEMORY..].iter().zip(&self.guard) {
            for lane in 0..W {
                self.lost[lane] |= !(seen[lane].abs() <= most[lane]);
            }
        }
    }

    // Inlined with all below it, so that its loops are compiled for each set of instructions.
    #[inline(always)]
    fn flown(&mut self, price: &mut Price<'_>) -> Result<Vec<Option<Vec<f64>>>, SimError> {
        let (mut kept, room) = (Vec::<(usize, State<W>)>::new(), self.segment.min(self.rows));
        let mut passed = Passed { rows: Vec::with_capacity(room), held: Vec::new() };
        let mut state = self.start();
        for k in 0..self.rows {
            if k == 0 || passed.rows.len().max(passed.held.len()) >= self.segment {
                kept.push((k, state.clone()));
                passed.clear();
            }
            let theta_rad = state.plant[0];
            self.pass(k, &mut state, &mut passed)?;
            if let Some(row) = passed.rows.last() {
                self.watch(&theta_rad, row);
            }
        }
        let slopes: Vec<Slopes> = self
            .seen()
            .iter()
            .enumerate()
            .map(|(lane, seen)| match self.lost[lane] {
                true => Slopes::default(),
                false => price(lane, seen),
            })
            .collect();
        self.back((kept, passed), &slopes)?;
        let laws =
            std::mem::replace(&mut self.laws, Laws::new(&[]).map_err(|_| SimError::NotLinear)?);
        let each = laws.gradients().into_iter().enumerate().map(|(lane, gradient)| {
            let is_finite = gradient.iter().all(|it| it.is_finite());
            (is_finite && !self.lost[lane]).then(|| gradient[..NUMBERS].to_vec())
        });
        Ok(each.collect())
    }

    /// The flights as they were flown.
    fn seen(&self) -> Vec<Flown> {
        let columns = [self.seeing.theta_rad(), &self.elevators, &self.commands];
        let [theta_rad, elevator_rad, command_rad] = columns.map(by_lane);
        let columns = theta_rad.into_iter().zip(elevator_rad).zip(command_rad);
        let flown = self.prepared.iter().zip(columns);
        let flown = flown.map(|(prepared, ((theta_rad, elevator_rad), command_rad))| Flown {
            setpoint_rad: prepared.setpoint_rad.clone(),
            theta_rad,
            elevator_rad,
            command_rad,
        });
        flown.collect()
    }

    /// All samples, the last first. What passed in the last segment is known; the others are flown again.
    #[inline(always)]
    fn back(
        &mut self,
        (kept, mut passed): (Vec<(usize, State<W>)>, Passed<W>),
        slopes: &[Slopes],
    ) -> Result<(), SimError> {
        let mut worth = Worth::<W>::new(self.plants.states(), self.rows);
        let mut to = self.rows;
        for (from, mut state) in kept.into_iter().rev() {
            if to < self.rows {
                passed.clear();
                for k in from..to {
                    self.pass(k, &mut state, &mut passed)?;
                }
            }
            for (k, row) in (from..to).zip(&passed.rows).rev() {
                let first = passed.held.partition_point(|(at, _)| *at < k);
                self.back_sample(k, (row, &passed.held[first..]), slopes, &mut worth);
                passed.held.truncate(first);
            }
            to = from;
        }
        self.laws.back_first(&self.setpoint_rad.at(0), &worth.row);
        Ok(())
    }

    #[inline(always)]
    fn back_sample(
        &mut self,
        k: usize,
        (row, held): (&Row<W>, &[(usize, Held)]),
        slopes: &[Slopes],
        worth: &mut Worth<W>,
    ) {
        let [by_theta, by_elevator, by_command] = slopes_at(slopes, k);
        self.laws.evaluate(row);
        let command = self.arriving(k);
        let of_command = self.plants.back(&worth.plant, &command, held, &mut worth.before);
        std::mem::swap(&mut worth.plant, &mut worth.before);
        self.back_arriving(k, &of_command, &mut worth.commands);
        let commanded = worth.commands[k];
        for lane in 0..W {
            worth.row[0][lane] += commanded[lane] + by_command[lane];
        }
        self.laws.back(&mut worth.row);
        let [theta, rate] = self.seeing.back(k, [worth.row[MEMORY + 1], worth.row[MEMORY + 2]]);
        for lane in 0..W {
            worth.plant[0][lane] += theta[lane] + by_theta[lane];
        }
        self.plants.back_seen(&mut worth.plant, &rate, &by_elevator);
    }

    /// Hands what arrived at a sample back to when it was sent.
    #[inline(always)]
    fn back_arriving(&self, k: usize, worth: &Lanes<W>, commands: &mut [Lanes<W>]) {
        if let Some(delay) = self.shared_delay {
            let Some(sent) = k.checked_sub(delay) else { return };
            for lane in 0..W {
                commands[sent][lane] += worth[lane];
            }
            return;
        }
        for (lane, delay) in self.delay_samples.iter().enumerate() {
            if let Some(sent) = k.checked_sub(*delay) {
                commands[sent][lane] += worth[lane];
            }
        }
    }
}

/// What a little more of a sample's pitch, elevator and command costs.
#[inline(always)]
fn slopes_at<const W: usize>(slopes: &[Slopes], k: usize) -> [Lanes<W>; 3] {
    let mut at = [[0.0; W]; 3];
    for (lane, slopes) in slopes.iter().enumerate() {
        let columns = [&slopes.theta_rad, &slopes.elevator_rad, &slopes.command_rad];
        for (place, column) in at.iter_mut().zip(columns) {
            place[lane] = column.get(k).copied().unwrap_or(0.0);
        }
    }
    at
}

/// A column for each lane; some rows at a time, which stay in the nearest memory while all lanes read them.
fn by_lane<const W: usize>(rows: &[Lanes<W>]) -> Vec<Vec<f64>> {
    let mut lanes = vec![Vec::with_capacity(rows.len()); W];
    for some in rows.chunks(64) {
        for (lane, column) in lanes.iter_mut().enumerate() {
            column.extend(some.iter().map(|row| row[lane]));
        }
    }
    lanes
}

/// What everything is worth on the way back.
struct Worth<const W: usize> {
    plant: Vec<Lanes<W>>,
    before: Vec<Lanes<W>>,
    row: Row<W>,
    commands: Vec<Lanes<W>>,
}

impl<const W: usize> Worth<W> {
    fn new(states: usize, rows: usize) -> Self {
        Self {
            plant: vec![[0.0; W]; states],
            before: vec![[0.0; W]; states],
            row: [[0.0; W]; ROW],
            commands: vec![[0.0; W]; rows],
        }
    }
}

#[cfg(test)]
mod tests {
    use fspid_core::{Gains, Pid, PidConfig};

    use super::super::Weights;
    use super::*;
    use crate::signal::{Profile, Shape};
    use crate::{Actuator, ElevatorSign, LinearPlant, Scenario, Timing};

    #[test]
    fn a_flight_of_many_segments_has_the_gradient_of_one_to_the_bit() {
        let plant = LinearPlant::new(
            &[11.7304, 22.578],
            &[1.0, 4.9676, 12.941, 0.1],
            ElevatorSign::NoseUpPositive,
        );
        // Noise that holds the servo at its rate limit, now and then, in every segment.
        let noise = Profile::new(0.1, Shape::Noise { at_s: 0.05, seed: 3 }).expect("allowed");
        let timing = Timing::new(0.01, 4.0).expect("allowed");
        let servo = Actuator::first_order(0.1).and_then(|it| it.with_delay(2));
        let servo = servo.and_then(|it| it.with_rate_limit(0.6)).expect("allowed");
        let scenario = Scenario {
            actuator: servo,
            ..Scenario::new("segments", plant.expect("a plant"), timing, noise)
        };
        let prepared = scenario.prepare().expect("flies");
        let gains = Gains { kp: 1.0, ki: 0.3, kd: 0.1 };
        let config = PidConfig::sampled_every(0.01);
        let controller = Controller::Fixed(Pid::new(gains, config).expect("allowed"));
        let flight = Entrant { prepared: &prepared, controller: &controller };
        let weights = Weights { iae_rad_s: 1.0, ise_rad2_s: 3.0, travel_rad: 0.05 };
        let of = |segment: usize| {
            let mut group = Group::<2>::new(&[flight]).expect("differentiable");
            group.segment = segment;
            group.flown(&mut |_, flown| weights.of(flown, 0.01).1).expect("finite")
        };
        let whole = of(SEGMENT);
        let kp = whole[0].as_ref().expect("it flies")[super::super::numbers::GAINS_AT];
        assert!(kp.abs() > 1e-3, "{kp}");
        for segment in [1, 7, 50, 400, 401] {
            assert_eq!(of(segment), whole, "{segment}");
        }
    }
}
