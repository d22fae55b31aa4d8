//! All plants of a box of parameters, sampled: between the corners of what is linear in them, and a rest of second order.
//!
//! Entries that lie between bounds each on its own hold far more matrices than a box of parameters makes. With
//! $H = [A\ B; 0\ 0]\ t$ and the slopes of its entries between bounds over the box, by the mean value theorem
//!
//! $$ e^{H(p)} \in e^{H(m)} + \sum_i D_i (p_i - m_i), \qquad
//!    \exp \begin{pmatrix} H & \partial_i H \cr 0 & H \end{pmatrix} =
//!    \begin{pmatrix} e^H & D_i \cr 0 & e^H \end{pmatrix} $$
//!
//! with m the middle of the box and $D_i$ enclosed over it. The middles of the $D_i$ make a matrix that is linear in the
//! parameters, so that the corners of the box span it; what is left of each $D_i$ is as wide as the box, and what it adds
//! is of second order.
//!
//! # Source
//! For the derivative of the exponential by a block, C. F. Van Loan, IEEE Trans. Automatic Control 23 (1978) 395.

use fspid_numeric::scalar::{Dual, Interval};
use fspid_sim::loop_model::SampledPlant;

use super::error::{NotProved, positive};
use super::exponential::{exponential, held};
use super::matrix::IntervalMatrix;
use super::plant::{ContinuousPlant, LagOf, printed, side_by_side};
use crate::caps::MOST_PARAMETERS;

/// A number with its slopes by the parameters, all between bounds.
pub type Sloped = Dual<Interval, MOST_PARAMETERS>;

/// From the numbers of a box to a plant and its actuator.
pub type MakesPlant<'a> = dyn Fn(&[Sloped]) -> Result<ContinuousPlant<Sloped>, NotProved> + 'a;

/// A matrix row by row.
type Rows = Vec<Vec<Interval>>;

/// The plants of a box, each with its actuator: rows are over states and command.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantSet {
    /// The plant in the middle of the box.
    pub middle: Rows,
    /// All plants of the box, entry by entry.
    pub all: Rows,
    /// By each parameter: slopes of all entries over the box.
    pub slopes: Vec<Rows>,
    /// How far each parameter is from its middle, at most.
    pub reach: Vec<f64>,
    /// Row from states to pitch rate, of all plants.
    pub pitch_rate: Vec<Interval>,
    /// True for an actuator that is where it is commanded; its deflection is then a state that remembers the command.
    pub without_lag: bool,
}

impl PlantSet {
    /// The plants of a box of numbers, by a function that makes a plant of numbers.
    ///
    /// # Errors
    /// That of the function.
    pub fn of(numbers: &[Interval], plant: &MakesPlant<'_>) -> Result<Self, NotProved> {
        let middles: Vec<Interval> =
            numbers.iter().map(|it| Interval::point(it.midpoint())).collect();
        let fixed: Vec<Sloped> = middles.iter().map(|&it| Sloped::fixed(it)).collect();
        let moving = numbers.iter().enumerate();
        let moving: Vec<Sloped> = moving.map(|(index, &it)| Sloped::variable(it, index)).collect();
        let (one, all) = (plant(&fixed)?, plant(&moving)?);
        let values = |rows: &[Vec<Sloped>]| -> Rows {
            rows.iter().map(|row| row.iter().map(|it| it.value).collect()).collect()
        };
        let (one, rows) = (rows_of(&one), rows_of(&all));
        let slope = |index: usize| -> Rows {
            let by = |row: &Vec<Sloped>| row.iter().map(|it| it.derivative[index]).collect();
            rows.iter().map(by).collect()
        };
        let reach = numbers.iter().map(|&it| from_middle(it));
        let mut pitch_rate: Vec<Interval> = all.pitch_rate.iter().map(|it| it.value).collect();
        pitch_rate.resize(rows.len(), Interval::ZERO);
        Ok(Self {
            middle: values(&one),
            all: values(&rows),
            slopes: (0..numbers.len()).map(slope).collect(),
            reach: reach.collect(),
            pitch_rate,
            without_lag: matches!(all.lag, LagOf::None),
        })
    }

    /// True if its matrices fit together, for so many parameters.
    #[must_use]
    pub fn fits(&self, parameters: usize) -> bool {
        let states = self.middle.len();
        let square =
            |rows: &Rows| rows.len() == states && rows.iter().all(|row| row.len() == states + 1);
        states > 1
            && [&self.middle, &self.all].into_iter().chain(&self.slopes).all(square)
            && [self.slopes.len(), self.reach.len()] == [parameters; 2]
            && self.pitch_rate.len() == states
            && self.reach.iter().all(|it| *it >= 0.0 && it.is_finite())
    }

    /// True if the plant in the middle is one of all.
    #[must_use]
    pub fn holds_its_middle(&self) -> bool {
        let pairs = self.all.iter().flatten().zip(self.middle.iter().flatten());
        pairs.into_iter().all(|(all, middle)| all.encloses(*middle))
    }

    /// True if every plant of another is one of these, with its slopes.
    #[must_use]
    pub fn encloses(&self, other: &Self) -> bool {
        let row = |own: &Vec<Interval>, other: &Vec<Interval>| {
            own.len() == other.len() && own.iter().zip(other).all(|(own, it)| own.encloses(*it))
        };
        let all = |own: &Rows, other: &Rows| {
            own.len() == other.len() && own.iter().zip(other).all(|(own, other)| row(own, other))
        };
        all(&self.middle, &other.middle)
            && all(&self.all, &other.all)
            && self.slopes.len() == other.slopes.len()
            && self.slopes.iter().zip(&other.slopes).all(|(own, other)| all(own, other))
            && self.reach.iter().zip(&other.reach).all(|(own, other)| own >= other)
            && row(&self.pitch_rate, &other.pitch_rate)
            && self.without_lag == other.without_lag
    }

    /// Sampled plants between which those of the box lie, each with the rest of second order.
    ///
    /// # Errors
    /// As [`ContinuousPlant::sampled`].
    pub fn sampled(&self, dt_s: f64) -> Result<Vec<SampledPlant<Interval>>, NotProved> {
        self.sampled_within(dt_s, &[])
    }

    /// The same where entries may be off by these magnitudes, row by row over states and command; what is not told is not
    /// off. See [`off_by_moving`](Self::off_by_moving).
    ///
    /// # Errors
    /// As [`ContinuousPlant::sampled`].
    pub fn sampled_within(
        &self,
        dt_s: f64,
        off: &[f64],
    ) -> Result<Vec<SampledPlant<Interval>>, NotProved> {
        let dt_s = printed(positive("sample period, s", dt_s)?);
        let states = self.middle.len();
        let (a, b) = split(&self.middle);
        let (phi, gamma) =
            held(&IntervalMatrix::from_rows(&a)?, &IntervalMatrix::from_rows(&b)?, dt_s)?;
        let mut around = side_by_side(&phi, &gamma);
        for (entry, &off) in around.iter_mut().zip(off) {
            *entry = *entry + Interval::between(-off, off);
        }
        let mut linear = Vec::new();
        for (slopes, &reach) in self.slopes.iter().zip(&self.reach) {
            if reach <= 0.0 {
                continue;
            }
            let derivative = self.derivative(slopes, dt_s)?;
            let reach = Interval::point(reach);
            let both = Interval::between(-reach.upper(), reach.upper());
            for (entry, it) in around.iter_mut().zip(&derivative) {
                let rest = *it - Interval::point(it.midpoint());
                *entry = *entry + rest * both;
            }
            let middles = derivative.iter().map(|it| Interval::point(it.midpoint()) * reach);
            linear.push(middles.collect::<Vec<_>>());
        }
        let corner = |number: usize| {
            let mut rows = around.clone();
            for (side, by) in linear.iter().enumerate() {
                for (entry, by) in rows.iter_mut().zip(by) {
                    *entry = if number >> side & 1 == 0 { *entry - *by } else { *entry + *by };
                }
            }
            if self.without_lag {
                let by_command = rows.len() - 1;
                rows[by_command - states..].fill(Interval::ZERO);
                rows[by_command] = Interval::ONE;
            }
            SampledPlant { states, rows, rate: self.pitch_rate.clone() }
        };
        Ok((0..1_usize << linear.len()).map(corner).collect())
    }

    /// What entries of sampled plants are off at most where their numbers move within the sample, by no more than `most` each
    /// from where they are at its begin, inside boxes that together hold all that is between.
    ///
    /// With $H(s)$ of the numbers at a time in the sample, X its transition matrix and $H_0 = H(0)$
    ///
    /// $$ X(t) - e^{H_0 t} = \int_0^t e^{H_0 (t - s)} (H(s) - H_0) X(s) \ ds, \qquad
    ///    |X(t) - e^{H_0 t}| \le e^{|H| t} \Big( t \sum_i |\partial_i H| \ d_i \Big) e^{|H| t} $$
    ///
    /// entry by entry, with magnitudes over all boxes and $d_i$ the most that a number is off: neither transition has an entry
    /// larger than that of $e^{|H| t}$, as the terms of their series say.
    ///
    /// # Errors
    /// As [`ContinuousPlant::sampled`].
    pub fn off_by_moving(sets: &[&Self], most: &[f64], dt_s: f64) -> Result<Vec<f64>, NotProved> {
        let dt_s = printed(positive("sample period, s", dt_s)?);
        let states = sets.first().map_or(0, |set| set.all.len());
        let size = states + 1;
        let largest = |of: &dyn Fn(&Self) -> Interval| {
            Interval::point(sets.iter().map(|set| of(set).magnitude()).fold(0.0, f64::max))
        };
        let mut sizes = vec![vec![Interval::ZERO; size]; size];
        let mut moved = sizes.clone();
        for (row, column) in (0..states).flat_map(|row| (0..size).map(move |column| (row, column)))
        {
            sizes[row][column] = dt_s * largest(&|set| set.all[row][column]);
            for (number, &most) in most.iter().enumerate() {
                let slope = largest(&|set| set.slopes[number][row][column]);
                moved[row][column] = moved[row][column] + dt_s * slope * Interval::point(most);
            }
        }
        let transition = exponential(&IntervalMatrix::from_rows(&sizes)?)?;
        let moved = IntervalMatrix::from_rows(&moved)?;
        let off = transition.product(&moved)?.product(&transition)?;
        Ok(off.entries().take(states * size).map(Interval::magnitude).collect())
    }

    /// Slopes of the sampled plant by one parameter, enclosed over the box.
    fn derivative(&self, slopes: &Rows, dt_s: Interval) -> Result<Vec<Interval>, NotProved> {
        let states = self.all.len();
        let size = states + 1;
        let mut whole = vec![vec![Interval::ZERO; 2 * size]; 2 * size];
        for (place, (all, slopes)) in self.all.iter().zip(slopes).enumerate() {
            for column in 0..size {
                let (entry, slope) = (dt_s * all[column], dt_s * slopes[column]);
                whole[place][column] = entry;
                whole[size + place][size + column] = entry;
                whole[place][size + column] = slope;
            }
        }
        let moved = exponential(&IntervalMatrix::from_rows(&whole)?)?;
        let places = (0..states).flat_map(|row| (0..size).map(move |column| (row, size + column)));
        Ok(places.map(|(row, column)| moved.get(row, column).unwrap_or(Interval::ENTIRE)).collect())
    }
}

/// How far a number may be from its middle.
pub(crate) fn from_middle(number: Interval) -> f64 {
    (number - Interval::point(number.midpoint())).magnitude()
}

/// Rows over states and command.
fn rows_of(plant: &ContinuousPlant<Sloped>) -> Vec<Vec<Sloped>> {
    let (a, b) = plant.with_actuator();
    a.into_iter().zip(b).map(|(row, by_command)| [row, by_command].concat()).collect()
}

fn split(rows: &Rows) -> (Rows, Rows) {
    let states = rows.len();
    rows.iter().map(|row| (row[..states].to_vec(), row[states..].to_vec())).unzip()
}
