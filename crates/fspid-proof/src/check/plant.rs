//! The sampled plant from printed coefficients, with proof.

use fspid_numeric::scalar::Interval;
use fspid_sim::actuator::Lag;
use fspid_sim::loop_model::SampledPlant;
use fspid_sim::{ElevatorSign, LinearPlant};

use super::error::{NotProved, positive};
use super::exponential::{exponential, held};
use super::matrix::IntervalMatrix;

/// A matrix row by row.
type Rows = Vec<Vec<Interval>>;

/// How an actuator follows its command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActuatorLag {
    /// At once; the deflection is a state that remembers the last command.
    None,
    /// $\tau \dot \delta = v - \delta$.
    First {
        /// τ, s.
        time_constant_s: f64,
    },
    /// $\ddot \delta = \omega_n^2 (v - \delta) - 2 \zeta \omega_n \dot \delta$.
    Second {
        /// $\omega_n$, rad/s.
        natural_frequency_rad_s: f64,
        /// ζ.
        damping: f64,
    },
}

/// A plant and its actuator as they are printed: every number stands for all decimals that round to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedPlant<'a> {
    /// Numerator of the transfer function from elevator to pitch angle, highest power of s first.
    pub numerator: &'a [f64],
    /// Denominator, highest power of s first.
    pub denominator: &'a [f64],
    /// Which way the elevator is counted.
    pub elevator_sign: ElevatorSign,
    /// The actuator.
    pub lag: ActuatorLag,
    /// Sample period, s.
    pub dt_s: f64,
}

/// A plant over a time, see [`PrintedPlant::over`].
#[derive(Clone, Debug)]
pub(crate) struct Passed {
    pub(crate) follow: IntervalMatrix,
    pub(crate) by_command: Vec<Interval>,
    pub(crate) ramp: Vec<Interval>,
}

/// All decimals that a printed number can stand for, and then some: from the float below it to the one
/// above. Zero is zero.
#[must_use]
pub fn printed(value: f64) -> Interval {
    if value == 0.0 {
        return Interval::ZERO;
    }
    Interval::new(value.next_down(), value.next_up()).unwrap_or(Interval::ENTIRE)
}

impl PrintedPlant<'_> {
    /// The plant over one sample, its command held, with the states that simulations use: those of the
    /// observability form (pitch angle first), then the deflection, then its rate where the lag is of
    /// second order.
    ///
    /// # Errors
    /// [`NotProved::Plant`] for coefficients that make no strictly proper transfer function,
    /// [`NotProved::Number`] for a constant that is not finite and positive, [`NotProved::Unbounded`]
    /// for a plant that grows beyond the range of floats within a sample.
    pub fn sampled(&self) -> Result<SampledPlant<Interval>, NotProved> {
        LinearPlant::new(self.numerator, self.denominator, self.elevator_sign)?;
        let dt_s = printed(positive("sample period, s", self.dt_s)?);
        let alpha = self.monic_denominator();
        let sign = Interval::point(self.elevator_sign.per_nose_up());
        let by_elevator: Vec<Interval> =
            self.markov_parameters(&alpha).into_iter().map(|h| sign * h).collect();
        let a = companion(&alpha);
        let rate = self.rate_row(&a, &by_elevator);
        let (a, b) = self.with_actuator(a, &by_elevator)?;
        let (phi, gamma) =
            held(&IntervalMatrix::from_rows(&a)?, &IntervalMatrix::from_rows(&b)?, dt_s)?;
        let (states, mut rows) = (rate.len(), side_by_side(&phi, &gamma));
        if self.lag == ActuatorLag::None {
            // The remembered deflection is the command.
            let by_command = rows.len() - 1;
            rows[by_command - states..].fill(Interval::ZERO);
            rows[by_command] = Interval::ONE;
        }
        Ok(SampledPlant { states, rows, rate })
    }

    /// $e^{A t} B$ over the plant's own states, for every time t from 0 to one sample: what an impulse of the elevator, in
    /// the sense of the command, leaves of itself.
    ///
    /// # Errors
    /// As [`sampled`](Self::sampled).
    pub fn impulse_within_sample(&self) -> Result<Vec<Interval>, NotProved> {
        LinearPlant::new(self.numerator, self.denominator, self.elevator_sign)?;
        let dt_s = printed(positive("sample period, s", self.dt_s)?);
        let alpha = self.monic_denominator();
        let sign = Interval::point(self.elevator_sign.per_nose_up());
        let markov = self.markov_parameters(&alpha);
        let column: Vec<[Interval; 1]> = markov.into_iter().map(|h| [sign * h]).collect();
        let a = IntervalMatrix::from_rows(&companion(&alpha))?;
        let motion = exponential(&a.scaled(Interval::ZERO.hull(dt_s)))?;
        Ok(motion.product(&IntervalMatrix::from_rows(&column)?)?.entries().collect())
    }

    /// The plant over a time with a lag of first order: states at its end by states and by a command that is held, and
    /// what a deflection that runs at 1 rad/s adds to states that begin at rest. Rows are over plant and deflection.
    ///
    /// # Errors
    /// As [`sampled`](Self::sampled); [`NotProved::Number`] for another lag.
    pub(crate) fn over(&self, time_s: Interval) -> Result<Passed, NotProved> {
        let ActuatorLag::First { .. } = self.lag else {
            let what = "order of the lag";
            return Err(NotProved::Number { what, found: 0.0, allowed: "1" });
        };
        let alpha = self.monic_denominator();
        let sign = Interval::point(self.elevator_sign.per_nose_up());
        let by_elevator: Vec<Interval> =
            self.markov_parameters(&alpha).into_iter().map(|h| sign * h).collect();
        let (a, b) = self.with_actuator(companion(&alpha), &by_elevator)?;
        let (follow, by_command) =
            held(&IntervalMatrix::from_rows(&a)?, &IntervalMatrix::from_rows(&b)?, time_s)?;
        // The deflection is what it was and the held rate makes of it.
        let mut ramp = a;
        let mut by_rate = vec![vec![Interval::ZERO]; ramp.len()];
        if let (Some(row), Some(rate)) = (ramp.last_mut(), by_rate.last_mut()) {
            row.fill(Interval::ZERO);
            *rate = vec![Interval::ONE];
        }
        let (_, ramp) = held(
            &IntervalMatrix::from_rows(&ramp)?,
            &IntervalMatrix::from_rows(&by_rate)?,
            time_s,
        )?;
        let column = |matrix: &IntervalMatrix| matrix.entries().collect();
        Ok(Passed { by_command: column(&by_command), ramp: column(&ramp), follow })
    }

    /// $a_{n-1} \dots a_0$ of the monic denominator.
    fn monic_denominator(&self) -> Vec<Interval> {
        let mut coefficients = self.denominator.iter().map(|&value| printed(value));
        let leading = coefficients.next().unwrap_or(Interval::ZERO);
        coefficients.map(|value| value / leading).collect()
    }

    /// $h_1 \dots h_n$, with $h_0 = 0$ and
    ///
    /// $$ h_k = \beta_k - \sum_{i=1}^{k-1} \alpha_i h_{k-i} $$
    fn markov_parameters(&self, alpha: &[Interval]) -> Vec<Interval> {
        let leading = printed(self.denominator.first().copied().unwrap_or(0.0));
        let offset = self.denominator.len() - self.numerator.len();
        let mut markov: Vec<Interval> = Vec::with_capacity(alpha.len());
        for k in 1..=alpha.len() {
            let given = k.checked_sub(offset).and_then(|i| self.numerator.get(i));
            let beta = given.map_or(Interval::ZERO, |&value| printed(value) / leading);
            let past = alpha.iter().zip(markov.iter().rev());
            markov.push(past.fold(beta, |rest, (&alpha, &h)| rest - alpha * h));
        }
        markov
    }

    /// Row from states to pitch rate: θ' is the second state and what the elevator adds to it at once;
    /// of a plant of order 1 it is its only equation.
    fn rate_row(&self, a: &[Vec<Interval>], by_elevator: &[Interval]) -> Vec<Interval> {
        let order = a.len();
        let mut rate = vec![Interval::ZERO; order];
        match rate.get_mut(1) {
            Some(second) => *second = Interval::ONE,
            None => rate.clone_from_slice(&a[0]),
        }
        rate.push(by_elevator[0]);
        if matches!(self.lag, ActuatorLag::Second { .. }) {
            rate.push(Interval::ZERO);
        }
        rate
    }

    /// Rows of state matrix and input of plant and actuator. Without a lag the elevator is the command,
    /// and the deflection does not move by itself.
    fn with_actuator(
        &self,
        mut a: Rows,
        by_elevator: &[Interval],
    ) -> Result<(Rows, Rows), NotProved> {
        let order = a.len();
        let (own, by_command) = self.lag.rows()?;
        let states = order + own.len();
        let mut b = vec![vec![Interval::ZERO]; states];
        b[states - 1] = vec![by_command];
        for ((row, b), &h) in a.iter_mut().zip(&mut b).zip(by_elevator) {
            row.resize(states, Interval::ZERO);
            if self.lag == ActuatorLag::None {
                *b = vec![h];
            } else {
                row[order] = h;
            }
        }
        for by_own in own {
            let mut row = vec![Interval::ZERO; states];
            row[order..].copy_from_slice(&by_own);
            a.push(row);
        }
        Ok((a, b))
    }
}

impl From<Lag> for ActuatorLag {
    fn from(lag: Lag) -> Self {
        match (lag.time_constant_s(), lag.second_order_parameters()) {
            (Some(time_constant_s), _) => Self::First { time_constant_s },
            (None, Some((natural_frequency_rad_s, damping))) => {
                Self::Second { natural_frequency_rad_s, damping }
            }
            (None, None) => Self::None,
        }
    }
}

impl ActuatorLag {
    /// Derivatives of the actuator's states by these states, and of the last of them by the command.
    fn rows(self) -> Result<(Rows, Interval), NotProved> {
        match self {
            Self::None => Ok((vec![vec![Interval::ZERO]], Interval::ZERO)),
            Self::First { time_constant_s } => {
                let time_s = printed(positive("time constant, s", time_constant_s)?);
                let by_command = Interval::ONE / time_s;
                Ok((vec![vec![-by_command]], by_command))
            }
            Self::Second { natural_frequency_rad_s, damping } => {
                let wn = printed(positive("natural frequency, rad/s", natural_frequency_rad_s)?);
                let damping = printed(positive("damping ratio", damping)?);
                let stiffness = wn * wn;
                let by_rate = -(Interval::point(2.0) * damping * wn);
                let deflection = vec![Interval::ZERO, Interval::ONE];
                Ok((vec![deflection, vec![-stiffness, by_rate]], stiffness))
            }
        }
    }
}

/// The companion matrix of a monic denominator, last row last.
fn companion(alpha: &[Interval]) -> Rows {
    let order = alpha.len();
    let entry = |row: usize, column: usize| match row + 1 {
        next if next == order => -alpha[order - 1 - column],
        next if next == column => Interval::ONE,
        _ => Interval::ZERO,
    };
    (0..order).map(|row| (0..order).map(|column| entry(row, column)).collect()).collect()
}

/// Rows by state and by command, one after the other.
fn side_by_side(phi: &IntervalMatrix, gamma: &IntervalMatrix) -> Vec<Interval> {
    let states = phi.columns().max(1);
    let by_state: Vec<Interval> = phi.entries().collect();
    let rows = by_state.chunks(states).zip(gamma.entries());
    rows.flat_map(|(row, by_command)| row.iter().copied().chain([by_command])).collect()
}
