//! The sampled plant from printed coefficients, with proof.

use fspid_lti::Matrix;
use fspid_numeric::scalar::{Interval, Scalar};
use fspid_sim::actuator::Lag;
use fspid_sim::loop_model::SampledPlant;
use fspid_sim::{ElevatorSign, LinearPlant};

use super::driven::driven;
use super::error::{NotProved, positive};
use super::exponential::{exponential, held};
use super::matrix::IntervalMatrix;

/// A matrix row by row.
type Rows<T> = Vec<Vec<T>>;

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

/// A plant in continuous time and its actuator, in numbers of any kind: intervals, or intervals with slopes.
///
/// $$ \dot x = A x + b \delta, \qquad \theta = x_1, \qquad \dot\theta = r^T x + r_\delta \delta $$
///
/// with the elevator $\delta$ counted as the command is.
#[derive(Clone, Debug, PartialEq)]
pub struct ContinuousPlant<T> {
    /// A row by row; the pitch angle is the first state.
    pub by_states: Vec<Vec<T>>,
    /// b.
    pub by_elevator: Vec<T>,
    /// r, and behind it $r_\delta$.
    pub pitch_rate: Vec<T>,
    /// The actuator.
    pub lag: LagOf<T>,
}

/// [`ActuatorLag`] in numbers of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LagOf<T> {
    /// At once.
    None,
    /// $1 / \tau$, 1/s: plants are nearly linear in it.
    First(T),
    /// $\omega_n$, rad/s, and ζ.
    Second(T, T),
}

/// A plant over a time, see [`PrintedPlant::over`].
#[derive(Clone, Debug)]
pub(crate) struct Passed {
    pub(crate) follow: IntervalMatrix,
    pub(crate) by_command: Vec<Interval>,
    pub(crate) ramp: Vec<Interval>,
}

/// A number that arithmetic has rounded up to nine times, each by a share of $2^{-53}$ at most, over the number itself.
pub const ROUNDED: Interval = Interval::between(1.0 - 1e-15, 1.0 + 1e-15);

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
        self.enclosed()?.sampled(self.dt_s)
    }

    /// The plant in continuous time, in the observability form.
    fn enclosed(&self) -> Result<ContinuousPlant<Interval>, NotProved> {
        let enclose = |values: &[f64]| values.iter().map(|&value| printed(value)).collect();
        let (numerator, denominator): (Vec<_>, Vec<_>) =
            (enclose(self.numerator), enclose(self.denominator));
        let lag = LagOf::printed(self.lag)?;
        Ok(ContinuousPlant::of_transfer_function(&numerator, &denominator, self.elevator_sign, lag))
    }

    /// $e^{A t} B$ over the plant's own states, for every time t from 0 to one sample: what an impulse of the elevator, in
    /// the sense of the command, leaves of itself.
    ///
    /// # Errors
    /// As [`sampled`](Self::sampled).
    pub fn impulse_within_sample(&self) -> Result<Vec<Interval>, NotProved> {
        LinearPlant::new(self.numerator, self.denominator, self.elevator_sign)?;
        let dt_s = printed(positive("sample period, s", self.dt_s)?);
        let ContinuousPlant { by_states, by_elevator, .. } = self.enclosed()?;
        let column: Vec<[Interval; 1]> = by_elevator.into_iter().map(|h| [h]).collect();
        let a = IntervalMatrix::from_rows(&by_states)?;
        let motion = exponential(&a.scaled(Interval::ZERO.hull(dt_s)))?;
        Ok(motion.product(&IntervalMatrix::from_rows(&column)?)?.entries().collect())
    }

    /// A matrix E over the plant's own states with which every disturbance w that moves as it likes over a sample adds
    /// $E u$, $|u|^2 \le \int w^2$, see [`driven`]; at the elevator in the sense of the command, or by a numerator over
    /// the denominator with a leading 1, highest power of s first, of as many coefficients as the plant has states.
    ///
    /// # Errors
    /// As [`sampled`](Self::sampled) and [`driven`]; [`NotProved::Number`] for a numerator of another length.
    pub fn driven(&self, numerator: Option<&[f64]>) -> Result<Matrix, NotProved> {
        LinearPlant::new(self.numerator, self.denominator, self.elevator_sign)?;
        let dt_s = printed(positive("sample period, s", self.dt_s)?);
        let ContinuousPlant { by_states, by_elevator, .. } = self.enclosed()?;
        let column = match numerator {
            None => by_elevator,
            Some(numerator) if numerator.len() == by_states.len() => {
                let leading = printed(self.denominator.first().copied().unwrap_or(0.0));
                let rest = self.denominator.iter().skip(1);
                let alpha: Vec<Interval> = rest.map(|&it| printed(it) / leading).collect();
                let numerator: Vec<Interval> = numerator.iter().map(|&it| printed(it)).collect();
                markov_parameters(&numerator, Interval::ONE, &alpha)
            }
            Some(numerator) => {
                let what = "coefficients of a gust's numerator";
                let found = numerator.len() as f64;
                return Err(NotProved::Number { what, found, allowed: "as many as states" });
            }
        };
        let column: Vec<[Interval; 1]> = column.into_iter().map(|h| [h]).collect();
        driven(&IntervalMatrix::from_rows(&by_states)?, &IntervalMatrix::from_rows(&column)?, dt_s)
    }

    /// True where the elevator moves the pitch rate at once, so that a rate sensor sees what is added to it.
    #[must_use]
    pub fn moves_rate_at_once(&self) -> bool {
        self.numerator.len() + 1 >= self.denominator.len()
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
        let (a, b) = self.enclosed()?.with_actuator();
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
}

impl<T: Scalar> ContinuousPlant<T> {
    /// The observability form of a transfer function, coefficients with the highest power of s first: pitch angle and its
    /// derivatives, less what the elevator adds to them at once.
    #[must_use]
    pub fn of_transfer_function(
        numerator: &[T],
        denominator: &[T],
        elevator_sign: ElevatorSign,
        lag: LagOf<T>,
    ) -> Self {
        let leading = denominator.first().copied().unwrap_or(T::zero());
        let alpha: Vec<T> = denominator.iter().skip(1).map(|&it| it / leading).collect();
        let sign = T::constant(elevator_sign.per_nose_up());
        let markov = markov_parameters(numerator, leading, &alpha);
        let by_elevator: Vec<T> = markov.into_iter().map(|h| sign * h).collect();
        let by_states = companion(&alpha);
        // θ' is the second state and what the elevator adds to it; of a plant of order 1 it is its only equation.
        let mut pitch_rate = vec![T::zero(); alpha.len()];
        match pitch_rate.get_mut(1) {
            Some(second) => *second = T::one(),
            None => pitch_rate.clone_from_slice(&by_states[0]),
        }
        pitch_rate.push(by_elevator[0]);
        Self { by_states, by_elevator, pitch_rate, lag }
    }

    /// The normal form of a transfer function $b (s^m + r_{m-1} s^{m-1} + \dots + r_0) / (s^n + \dots + \alpha_0)$,
    /// coefficients with the highest power of s first: pitch angle and its derivatives below the $(n - m)$th, then w with its
    /// derivatives below the mth, where
    ///
    /// $$ w^{(m)} + r_{m-1} w^{(m-1)} + \dots + r_0 w = \theta, \qquad
    ///    w^{(n)} + \alpha_{n-1} w^{(n-1)} + \dots + \alpha_0 w = b \delta $$
    ///
    /// b and each α enter once and linearly; in the observability form they enter as products, which a family pays for.
    /// `None` for a numerator whose first coefficient may be 0, as `may_vanish` says, or that is none.
    ///
    /// # Source
    /// A. Isidori, *Nonlinear Control Systems*, 3rd edition, section 4.3, for linear systems.
    #[must_use]
    pub fn in_normal_form(
        numerator: &[T],
        denominator: &[T],
        (elevator_sign, lag): (ElevatorSign, LagOf<T>),
        may_vanish: impl Fn(&T) -> bool,
    ) -> Option<Self> {
        let (&leading, alpha) = denominator.split_first()?;
        let (&effect, zeros) = numerator.split_first()?;
        let (order, inner) = (alpha.len(), zeros.len());
        if may_vanish(&leading) || may_vanish(&effect) || inner >= order {
            return None;
        }
        let outer = order - inner;
        // Lowest power first.
        let alpha: Vec<T> = alpha.iter().rev().map(|&it| it / leading).collect();
        let zeros: Vec<T> = zeros.iter().rev().map(|&it| it / effect).collect();
        let unit = |place: usize| -> Vec<T> {
            (0..order).map(|at| if at == place { T::one() } else { T::zero() }).collect()
        };
        let less = |row: &mut Vec<T>, factor: T, other: &[T]| {
            row.iter_mut().zip(other).for_each(|(it, other)| *it = *it - factor * *other);
        };
        // Derivatives of w over the states.
        let mut w: Vec<Vec<T>> = (0..inner).map(|power| unit(outer + power)).collect();
        for power in inner..order {
            let mut row = unit(power - inner);
            for (index, &zero) in zeros.iter().enumerate() {
                less(&mut row, zero, &w[index + power - inner].clone());
            }
            w.push(row);
        }
        let mut last = vec![T::zero(); order];
        for (power, &alpha) in alpha.iter().enumerate() {
            less(&mut last, alpha, &w[power]);
        }
        for (index, &zero) in zeros.iter().enumerate() {
            less(&mut last, -zero, &w[index + outer]);
        }
        let mut by_states: Vec<Vec<T>> = (1..outer).map(unit).collect();
        by_states.push(last);
        by_states.extend((1..inner).map(|power| w[power].clone()));
        if inner > 0 {
            by_states.push(w[inner].clone());
        }
        let mut by_elevator = vec![T::zero(); order];
        by_elevator[outer - 1] = T::constant(elevator_sign.per_nose_up()) * effect / leading;
        let mut pitch_rate = by_states[0].clone();
        pitch_rate.push(by_elevator[0]);
        Some(Self { by_states, by_elevator, pitch_rate, lag })
    }

    /// Rows of state matrix and input of plant and actuator. Without a lag the elevator is the command,
    /// and the deflection does not move by itself.
    pub(crate) fn with_actuator(&self) -> (Rows<T>, Rows<T>) {
        let mut a = self.by_states.clone();
        let order = a.len();
        let (own, by_command) = self.lag.rows();
        let states = order + own.len();
        let mut b = vec![vec![T::zero()]; states];
        b[states - 1] = vec![by_command];
        for ((row, b), &h) in a.iter_mut().zip(&mut b).zip(&self.by_elevator) {
            row.resize(states, T::zero());
            if matches!(self.lag, LagOf::None) {
                *b = vec![h];
            } else {
                row[order] = h;
            }
        }
        for by_own in own {
            let mut row = vec![T::zero(); states];
            row[order..].copy_from_slice(&by_own);
            a.push(row);
        }
        (a, b)
    }
}

impl ContinuousPlant<Interval> {
    /// The plant over one sample, its command held: own states, then the deflection, then its rate where the lag is of
    /// second order.
    ///
    /// # Errors
    /// [`NotProved::Number`] for a period that is not finite and positive, [`NotProved::Unbounded`] for a plant that may
    /// grow beyond the range of floats within a sample.
    pub fn sampled(&self, dt_s: f64) -> Result<SampledPlant<Interval>, NotProved> {
        let dt_s = printed(positive("sample period, s", dt_s)?);
        let (a, b) = self.with_actuator();
        let (phi, gamma) =
            held(&IntervalMatrix::from_rows(&a)?, &IntervalMatrix::from_rows(&b)?, dt_s)?;
        let mut rate = self.pitch_rate.clone();
        rate.resize(a.len(), Interval::ZERO);
        let (states, mut rows) = (a.len(), side_by_side(&phi, &gamma));
        if self.lag == LagOf::None {
            // The remembered deflection is the command.
            let by_command = rows.len() - 1;
            rows[by_command - states..].fill(Interval::ZERO);
            rows[by_command] = Interval::ONE;
        }
        Ok(SampledPlant { states, rows, rate })
    }
}

/// $h_1 \dots h_n$ of a monic denominator, with $h_0 = 0$ and
///
/// $$ h_k = \beta_k - \sum_{i=1}^{k-1} \alpha_i h_{k-i} $$
fn markov_parameters<T: Scalar>(numerator: &[T], leading: T, alpha: &[T]) -> Vec<T> {
    let offset = (alpha.len() + 1).saturating_sub(numerator.len());
    let mut markov: Vec<T> = Vec::with_capacity(alpha.len());
    for k in 1..=alpha.len() {
        let given = k.checked_sub(offset).and_then(|i| numerator.get(i));
        let beta = given.map_or(T::zero(), |&value| value / leading);
        let past = alpha.iter().zip(markov.iter().rev());
        markov.push(past.fold(beta, |rest, (&alpha, &h)| rest - alpha * h));
    }
    markov
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

impl LagOf<Interval> {
    /// The lag as it is printed.
    ///
    /// # Errors
    /// [`NotProved::Number`] for a constant that is not finite and positive.
    pub fn printed(lag: ActuatorLag) -> Result<Self, NotProved> {
        let enclosed = |what, value| positive(what, value).map(printed);
        Ok(match lag {
            ActuatorLag::None => Self::None,
            ActuatorLag::First { time_constant_s } => {
                Self::First(Interval::ONE / enclosed("time constant, s", time_constant_s)?)
            }
            ActuatorLag::Second { natural_frequency_rad_s, damping } => Self::Second(
                enclosed("natural frequency, rad/s", natural_frequency_rad_s)?,
                enclosed("damping ratio", damping)?,
            ),
        })
    }
}

impl<T: Scalar> LagOf<T> {
    /// Derivatives of the actuator's states by these states, and of the last of them by the command.
    fn rows(&self) -> (Rows<T>, T) {
        match *self {
            Self::None => (vec![vec![T::zero()]], T::zero()),
            Self::First(by_command) => (vec![vec![-by_command]], by_command),
            Self::Second(wn, damping) => {
                let stiffness = wn * wn;
                let by_rate = -(T::constant(2.0) * damping * wn);
                let deflection = vec![T::zero(), T::one()];
                (vec![deflection, vec![-stiffness, by_rate]], stiffness)
            }
        }
    }
}

/// The companion matrix of a monic denominator, last row last.
fn companion<T: Scalar>(alpha: &[T]) -> Rows<T> {
    let order = alpha.len();
    let entry = |row: usize, column: usize| match row + 1 {
        next if next == order => -alpha[order - 1 - column],
        next if next == column => T::one(),
        _ => T::zero(),
    };
    (0..order).map(|row| (0..order).map(|column| entry(row, column)).collect()).collect()
}

/// Rows by state and by command, one after the other.
pub(super) fn side_by_side(phi: &IntervalMatrix, gamma: &IntervalMatrix) -> Vec<Interval> {
    let states = phi.columns().max(1);
    let by_state: Vec<Interval> = phi.entries().collect();
    let rows = by_state.chunks(states).zip(gamma.entries());
    rows.flat_map(|(row, by_command)| row.iter().copied().chain([by_command])).collect()
}
