//! A linear plant behind an actuator in continuous time, and what it becomes over a sample.
//!
//! $$ \dot x = A x + s B (\delta + d) + E g, \qquad \dot \delta = \frac{v - \delta}{\tau} \ \text{ or } \
//! \ddot \delta = \omega_n^2 (v - \delta) - 2 \zeta \omega_n \dot \delta \ \text{ or } \ \dot \delta = \rho $$
//!
//! States are those of the plant, the deflection and, by legs, its rate; inputs are the command v or the rate ρ, the
//! disturbance at the elevator and, by legs, three gusts.

use fspid_lti::StateSpace;

use crate::actuator::Lag;
use crate::error::SimError;
use crate::law::Law;
use crate::plant::LinearPlant;

/// How states, elevator and gusts enter the states of a plant.
#[derive(Clone, Debug)]
pub(crate) struct Generator {
    /// Rows over the states of the plant, flat.
    pub(crate) a: Vec<f64>,
    /// The elevator nose up, in the sense of the command.
    by_elevator: Vec<f64>,
    /// For an actuator that is followed by legs, which has its rate as one more state.
    by_gust: Option<[Vec<f64>; 3]>,
}

impl Generator {
    pub(crate) fn of(plant: &LinearPlant) -> Self {
        Self::new(plant, &plant.state_space())
    }

    /// What 64 bits leave out of the entries of [`of`](Self::of).
    pub(crate) fn of_rest(plant: &LinearPlant) -> Self {
        Self::new(plant, &plant.transfer_function().state_space_rest())
    }

    fn new(plant: &LinearPlant, model: &StateSpace) -> Self {
        let sign = plant.elevator_sign().per_nose_up();
        let by_elevator = model.b().data().iter().map(|b| sign * b).collect();
        Self { a: model.a().data().to_vec(), by_elevator, by_gust: None }
    }

    /// The same for an actuator that is followed by legs, in air that enters by these columns.
    pub(crate) fn by_legs(self, by_gust: [Vec<f64>; 3]) -> Self {
        Self { by_gust: Some(by_gust), ..self }
    }

    /// The same in calm air, for a servo that is one system with the plant.
    pub(crate) fn in_calm_air(&self) -> Self {
        Self { by_gust: None, ..self.clone() }
    }

    /// States of the plant.
    pub(crate) fn order(&self) -> usize {
        self.by_elevator.len()
    }

    /// The law while the actuator follows by its lag.
    pub(crate) fn follow(&self, lag: Lag, dt_s: f64) -> Result<Law, SimError> {
        let mut rows = self.rows(lag);
        let (place, input) = (self.order(), rows.len());
        let [by_deflection, by_rate, by_target] = lag.coefficients();
        match (lag.order(), &mut rows[place..]) {
            (1, [deflection, ..]) => {
                (deflection[place], deflection[input]) = (by_deflection, by_target);
            }
            (2, [deflection, rate]) => {
                deflection[place + 1] = 1.0;
                (rate[place], rate[place + 1]) = (by_deflection, by_rate);
                rate[input] = by_target;
            }
            _ => {}
        }
        // Without a lag the deflection only remembers its command.
        Law::new(&rows, (lag.order() == 0).then_some(place), dt_s)
    }

    /// The law while the deflection moves at a constant rate.
    pub(crate) fn ramp(&self, dt_s: f64) -> Result<Law, SimError> {
        // Any lag: the elevator is the deflection.
        let mut rows = self.rows_of(self.order());
        let input = rows.len();
        rows[self.order()][input] = 1.0;
        Law::new(&rows, None, dt_s)
    }

    /// Rows of the plant, those of deflection and rate still zero.
    pub(crate) fn rows(&self, lag: Lag) -> Vec<Vec<f64>> {
        // Without a lag the elevator is the command, the first input.
        let at_once = if lag.order() == 0 { self.states() } else { self.order() };
        self.rows_of(at_once)
    }

    fn rows_of(&self, elevator: usize) -> Vec<Vec<f64>> {
        let (order, states) = (self.order(), self.states());
        let inputs = if self.by_gust.is_some() { 5 } else { 2 };
        let mut rows = vec![vec![0.0; states + inputs]; states];
        for (i, row) in rows.iter_mut().take(order).enumerate() {
            row[..order].copy_from_slice(&self.a[i * order..(i + 1) * order]);
            row[elevator] = self.by_elevator[i];
            row[states + 1] = self.by_elevator[i];
            for (place, column) in self.by_gust.iter().flatten().enumerate() {
                row[states + 2 + place] = column[i];
            }
        }
        rows
    }

    fn states(&self) -> usize {
        self.order() + if self.by_gust.is_some() { 2 } else { 1 }
    }

    /// From all states to the pitch rate: θ' is the second state and what the elevator adds to it at once; of a plant of
    /// order 1 it is its only equation.
    pub(crate) fn rate_row(&self) -> Vec<f64> {
        let order = self.order();
        let mut row = vec![0.0; self.states()];
        match row.get_mut(1) {
            Some(rate) if order > 1 => *rate = 1.0,
            _ => row[..order].copy_from_slice(&self.a),
        }
        row[order] = self.by_elevator.first().copied().unwrap_or(0.0);
        row
    }
}
