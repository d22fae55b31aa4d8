//! One sample of the nonlinear motion: matrices between which every one of them lies, as long as it stays in a box.
//!
//! By the mean value theorem the motion from the trim is $\dot x(t) = A(t) x(t)$ with x over plant, actuator and the held
//! command, as long as x stays in the box, where
//!
//! $$ A(t) = A_0 + \sum_i \tfrac{1}{2} x_i(t) A_i + R(t), \qquad |x_i| \le r_i, \quad |R| \le \hat R $$
//!
//! with r the reach of the box, $A_i$ the middles of the enclosed second derivatives and $\hat R$ what their widths leave.
//! Of a sample, what is of first order in $\tfrac{1}{2} x_i A_i$ is, but for how $x_i$ moves around its mean within the
//! sample, the mean times $L_i = \int_0^T e^{A_0 (T - s)} A_i e^{A_0 s} ds$; all else is bounded with the magnitudes of
//! entries:
//!
//! $$ \Phi \in e^{A_0 T} + \sum_i \tfrac{1}{2} \bar x_i L_i + [-W, W], \qquad
//!    W = L_{|A_0|}(\hat R) + \sum_i \frac{T^2}{4} d_i e^{|A_0| T} |A_i A_0 - A_0 A_i| e^{|A_0| T} +
//!    \left( e^{(|A_0| + D) T} - e^{|A_0| T} - L_{|A_0|}(D) \right) $$
//!
//! with $D = \sum_i \tfrac{1}{2} r_i |A_i| + \hat R$ and $d_i \ge |\tfrac{1}{2} (x_i - \bar x_i)|$ from how fast $x_i$ can move
//! in the box. A loop's matrix is affine in its sampled plant, so that the corners of the means $\bar x$ span all of them.
//!
//! # Source
//! For the integral by a block exponential, C. F. Van Loan, IEEE Trans. Automatic Control 23 (1978) 395.

use fspid_aircraft::enclosure::{MOTION, MotionNumbers, MotionOver};
use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::SampledPlant;

use crate::check::{ActuatorLag, ContinuousPlant, IntervalMatrix, LagOf, NotProved};
use crate::check::{exponential, held, printed};
use crate::description::LoopDescription;

/// Place of the elevator among what the motion depends on; of an actuator's deflection among the states.
const ELEVATOR: usize = 4;

/// Number of the density, behind those of the motion.
pub(super) const DENSITY: usize = MOTION;

/// A matrix row by row.
type Rows = Vec<Vec<Interval>>;

/// How far everything may be from the trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// θ, q, V, α and elevator: rad, rad/s, m/s, rad, rad.
    pub motion: [f64; MOTION],
    /// The command that arrives at the actuator, rad.
    pub command_rad: f64,
}

impl Reach {
    /// True for sides that are finite and above 0.
    pub(crate) fn is_allowed(&self) -> bool {
        let all = self.motion.iter().chain([&self.command_rad]);
        all.into_iter().all(|it| *it > 0.0 && it.is_finite())
    }

    /// What the widths of a row's entries come to over the box; the rate of an actuator of second order has no side.
    pub(super) fn blur_of(&self, row: &[Interval]) -> f64 {
        let Some((command, own)) = row.split_last() else { return 0.0 };
        let sides = own.iter().zip(self.motion).map(|(it, side)| it.radius() * side);
        sides.sum::<f64>() + command.radius() * self.command_rad
    }

    /// All sides times a factor.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        let Self { motion, command_rad } = self;
        Self { motion: motion.map(|it| factor * it), command_rad: factor * command_rad }
    }
}

/// Everything that a sample may make of a state in the box.
pub(crate) struct Transition {
    /// Plants between which the one of every sample lies, by the bits of their numbers: of each side, below or above.
    pub(crate) corners: Vec<SampledPlant<Interval>>,
    /// Which number of the motion each side is.
    pub(crate) sides: Vec<usize>,
    /// Rows over states and arriving command, of θ, q, V, α and elevator: where none is too large, none is within a sample.
    pub(crate) within: [[Vec<Interval>; MOTION]; 2],
    /// How far each state may be off at the end of a sample by what is not told apart, at most about.
    pub(crate) blurs: Vec<f64>,
    /// How far air of another density than the trim's takes each state in a sample, wherever it begins.
    pub(crate) drifts: Vec<Interval>,
}

/// The motion in continuous time, rows and columns over states and command; that of the command is 0.
struct Motion {
    /// $A_0$.
    middle: Rows,
    /// Half the reach times each $A_i$, with the number i; only those that are there.
    moved: Vec<(usize, Rows)>,
    /// $\hat R$.
    rest: Rows,
    /// States of plant and actuator.
    states: usize,
    lag: LagOf<Interval>,
    /// Rates at the trim in air of another density, in magnitude.
    driven: Vec<Interval>,
}

/// Why the motion over a box is not enclosed.
fn no_motion() -> NotProved {
    let allowed = "a box around a trim that is found, in which every force has bounds";
    NotProved::Number { what: "motion over the box", found: f64::NAN, allowed }
}

impl Transition {
    /// The samples of an aircraft in a loop, up to so far from its trim.
    pub(crate) fn of(
        description: &LoopDescription,
        aircraft: &MotionNumbers,
        reach: &Reach,
    ) -> Result<Self, NotProved> {
        let over = aircraft.over(reach.motion).ok_or_else(no_motion)?;
        let motion = Motion::of(description, &over, reach)?;
        let dt_s = printed(description.controller.config().dt_s);
        let sizes = magnitudes(&motion.middle);
        let off = motion.off();
        let bounds = zip(&sizes, &off, |own, off| (own + off).upper_point());
        // All words, those without and those of first order in what is off.
        let all = grown(&bounds, dt_s)?;
        let (own, first) = with_slope(&sizes, &off, dt_s)?;
        let left = motion.left([&sizes, &bounds, &own], (reach, dt_s))?;
        let words = zip(&zip(&all, &own, |a, b| a - b), &first, |a, b| a - b);
        let wide = zip(&words, &left, |words, left| {
            let size = words.upper().max(0.0) + left.upper();
            Interval::between(-size.next_up(), size.next_up())
        });
        let around = zip(&motion.around(dt_s)?, &wide, |a, b| a + b);
        let turned: Vec<Rows> = motion
            .moved
            .iter()
            .map(|(_, by)| Ok(with_slope(&motion.middle, by, dt_s)?.1))
            .collect::<Result<_, NotProved>>()?;
        let corner = |number: usize| {
            let signed = turned.iter().enumerate().fold(around.clone(), |sum, (side, by)| {
                let plus = number >> side & 1 == 1;
                zip(&sum, by, |sum, by| if plus { sum + by } else { sum - by })
            });
            motion.sampled(signed)
        };
        let corners = (0..1_usize << turned.len()).map(corner).collect();
        let blurs = wide[..motion.states].iter().map(|row| motion.size_of(row, reach)).collect();
        let sides = motion.moved.iter().map(|(number, _)| *number).collect();
        let drifts = motion.drifts(&bounds, dt_s)?;
        let within = motion.within(&bounds, &all, (&motion.around(dt_s)?, dt_s));
        Ok(Self { corners, sides, within, blurs, drifts })
    }
}

/// A number from above, without width.
trait UpperPoint {
    fn upper_point(self) -> Interval;
}

impl UpperPoint for Interval {
    fn upper_point(self) -> Interval {
        Interval::point(self.upper().max(0.0))
    }
}

fn zip(one: &Rows, other: &Rows, each: impl Fn(Interval, Interval) -> Interval) -> Rows {
    let row = |(one, other): (&Vec<Interval>, &Vec<Interval>)| {
        one.iter().zip(other).map(|(&one, &other)| each(one, other)).collect()
    };
    one.iter().zip(other).map(row).collect()
}

fn magnitudes(rows: &Rows) -> Rows {
    zip(rows, rows, |it, _| Interval::point(it.magnitude()))
}

fn matrix(rows: &Rows) -> Result<IntervalMatrix, NotProved> {
    Ok(IntervalMatrix::from_rows(rows)?)
}

fn rows(matrix: &IntervalMatrix) -> Rows {
    let entries: Vec<Interval> = matrix.entries().collect();
    entries.chunks(matrix.columns().max(1)).map(<[Interval]>::to_vec).collect()
}

/// $e^{A T}$.
fn grown(a: &Rows, dt_s: Interval) -> Result<Rows, NotProved> {
    Ok(rows(&exponential(&matrix(a)?.scaled(dt_s))?))
}

/// $e^{A T}$ and $\int_0^T e^{A (T - s)} B e^{A s} ds$, by one exponential of a block.
fn with_slope(a: &Rows, by: &Rows, dt_s: Interval) -> Result<(Rows, Rows), NotProved> {
    let size = a.len();
    let mut whole = vec![vec![Interval::ZERO; 2 * size]; 2 * size];
    for (place, (a, by)) in a.iter().zip(by).enumerate() {
        whole[place][..size].copy_from_slice(a);
        whole[size + place][size..].copy_from_slice(a);
        whole[place][size..].copy_from_slice(by);
    }
    let whole = grown(&whole, dt_s)?;
    let part =
        |from: usize| whole[..size].iter().map(|row| row[from..from + size].to_vec()).collect();
    Ok((part(0), part(size)))
}

impl Motion {
    fn of(
        description: &LoopDescription,
        over: &MotionOver,
        reach: &Reach,
    ) -> Result<Self, NotProved> {
        let lag = LagOf::printed(ActuatorLag::from(description.actuator.lag()))?;
        let per_command = Interval::point(description.elevator_sign.per_nose_up());
        let square = |rows: &[[Interval; MOTION]; 4], lag| {
            let plant = ContinuousPlant {
                by_states: rows.iter().map(|row| row[..4].to_vec()).collect(),
                by_elevator: rows.iter().map(|row| per_command * row[4]).collect(),
                pitch_rate: Vec::new(),
                lag,
            };
            let (a, b) = plant.with_actuator();
            let mut rows: Rows = a.into_iter().zip(b).map(|(row, by)| [row, by].concat()).collect();
            rows.push(vec![Interval::ZERO; rows.len() + 1]);
            rows
        };
        let middle = square(&over.slopes, lag);
        let states = middle.len() - 1;
        let mut rest = zip(&middle, &middle, |_, _| Interval::ZERO);
        let mut moved = Vec::new();
        for (number, &reach) in reach.motion.iter().enumerate() {
            let half = Interval::point(0.5) * Interval::point(reach);
            let mut by = square(&over.bends.map(|row| row.map(|by| by[number])), lag);
            // The actuator does not bend.
            by[ELEVATOR..].iter_mut().for_each(|row| row.fill(Interval::ZERO));
            let centre = |it: Interval| Interval::point(it.midpoint());
            rest = zip(&rest, &by, |rest, it| {
                rest + half * Interval::point((it - centre(it)).magnitude())
            });
            by = zip(&by, &by, |it, _| half * centre(it));
            if by.iter().flatten().any(|entry| *entry != Interval::ZERO) {
                moved.push((number, by));
            }
        }
        let mut by = square(&over.slopes_by_density, lag);
        by[ELEVATOR..].iter_mut().for_each(|row| row.fill(Interval::ZERO));
        rest = zip(&rest, &by, |rest, it| rest + Interval::point(it.radius()));
        by = zip(&by, &by, |it, _| Interval::point(it.midpoint()));
        if by.iter().flatten().any(|entry| *entry != Interval::ZERO) {
            moved.push((DENSITY, by));
        }
        let driven = over.rates_by_density.iter().map(|it| Interval::point(it.magnitude()));
        let still = core::iter::repeat_n(Interval::ZERO, states - over.rates_by_density.len());
        Ok(Self { middle, moved, rest, states, lag, driven: driven.chain(still).collect() })
    }

    /// What is of first order and not told apart: that of $\hat R$, and how numbers move around their means.
    fn left(
        &self,
        [sizes, bounds, grown]: [&Rows; 3],
        (reach, dt_s): (&Reach, Interval),
    ) -> Result<Rows, NotProved> {
        let (_, mut left) = with_slope(sizes, &self.rest, dt_s)?;
        let (middle, grown) = (matrix(&self.middle)?, matrix(&magnitudes(grown))?);
        let quarter = Interval::point(0.25) * dt_s * dt_s;
        for (number, by) in &self.moved {
            // `by` has half the reach in it, of which this is the share that may move within a sample.
            let share = Interval::point(self.moves(*number, bounds, (reach, dt_s)));
            let by = matrix(by)?;
            let turned = by.product(&middle)?.difference(&middle.product(&by)?)?;
            let turned = matrix(&magnitudes(&rows(&turned)))?;
            let sandwiched = grown.product(&turned)?.product(&grown)?.scaled(quarter * share);
            left = zip(&left, &rows(&sandwiched), |sum, it| sum + it);
        }
        Ok(left)
    }

    /// How large a row is over the box; the rate of an actuator of second order has no side.
    fn size_of(&self, row: &[Interval], reach: &Reach) -> f64 {
        let command = row[self.states].magnitude() * reach.command_rad;
        let sides = row.iter().take(self.states).zip(reach.motion);
        sides.map(|(it, side)| it.magnitude() * side).sum::<f64>() + command
    }

    /// How far a number may be from its mean over a sample, as a share of its reach: at most all of both.
    fn moves(&self, number: usize, bounds: &Rows, (reach, dt_s): (&Reach, Interval)) -> f64 {
        let own = self.lag != LagOf::None;
        match (self.lag, number) {
            // A held command stands still; of an actuator of second order the rate has no side of the box.
            (LagOf::None, ELEVATOR) => return 0.0,
            (LagOf::Second(..), ELEVATOR) => return 2.0,
            // How fast the density changes is not asked.
            (_, DENSITY) => return 2.0,
            _ => {}
        }
        let sides = reach.motion.iter().enumerate().filter(|(place, _)| own || *place != ELEVATOR);
        let along = sides.chain([(self.states, &reach.command_rad)]);
        let rate = along.fold(Interval::ZERO, |sum, (column, side)| {
            sum + bounds[number][column] * Interval::point(*side)
        });
        (rate * dt_s / Interval::point(reach.motion[number])).upper().min(2.0)
    }

    /// $e^{A_0 T}$; what is held is scaled apart from the states.
    fn around(&self, dt_s: Interval) -> Result<Rows, NotProved> {
        let own = self.middle[..self.states].iter();
        let (a, b): (Rows, Rows) =
            own.map(|row| (row[..self.states].to_vec(), row[self.states..].to_vec())).unzip();
        let (phi, gamma) = held(&matrix(&a)?, &matrix(&b)?, dt_s)?;
        let beside = rows(&phi).into_iter().zip(rows(&gamma));
        let mut around: Rows = beside.map(|(row, by)| [row, by].concat()).collect();
        around.push(vec![Interval::ZERO; self.states + 1]);
        around[self.states][self.states] = Interval::ONE;
        Ok(around)
    }

    /// D, from above.
    fn off(&self) -> Rows {
        let moved = self.moved.iter().map(|(_, by)| by);
        moved.fold(self.rest.clone(), |sum, by| {
            zip(&sum, by, |sum, by| (sum + Interval::point(by.magnitude())).upper_point())
        })
    }

    /// What rates at the trim make of each state in a sample: $\int_0^T e^{(|A_0| + D) s} ds \ |w|$.
    fn drifts(&self, bounds: &Rows, dt_s: Interval) -> Result<Vec<Interval>, NotProved> {
        let own: Rows =
            bounds[..self.states].iter().map(|row| row[..self.states].to_vec()).collect();
        let by: Rows = self.driven.iter().map(|it| vec![*it]).collect();
        let (_, moved) = held(&matrix(&own)?, &matrix(&by)?, dt_s)?;
        Ok(moved.entries().map(|it| Interval::point(it.magnitude())).collect())
    }

    fn sampled(&self, mut rows: Rows) -> SampledPlant<Interval> {
        let states = self.states;
        rows.truncate(states);
        if self.lag == LagOf::None {
            // The remembered deflection is the command.
            rows[states - 1].fill(Interval::ZERO);
            rows[states - 1][states] = Interval::ONE;
        }
        let unit = |place: usize| if place == 1 { Interval::ONE } else { Interval::ZERO };
        SampledPlant { states, rows: rows.concat(), rate: (0..states).map(unit).collect() }
    }

    /// Rows of what the motion depends on at both ends of a sample, as the mean value theorem has them:
    ///
    /// $$ \Phi(t) \in I + t [A_0 - D, A_0 + D] \pm (e^{(|A_0| + D) t} - I - (|A_0| + D) t) $$
    ///
    /// At every matrix of the middle the size of a row at a state is convex in t, and so is what the words of second order
    /// add to it at most, which are powers of t: where the sum is small enough at 0, without words, and at T, it is between.
    /// A lag of first order bends as nothing else and is known in whole: it stays between where it is and where it is told
    /// to go, and comes closer.
    fn within(
        &self,
        bounds: &Rows,
        all: &Rows,
        (around, dt_s): (&Rows, Interval),
    ) -> [[Vec<Interval>; MOTION]; 2] {
        let sizes = magnitudes(&self.middle);
        let unit = |row, column| if row == column { Interval::ONE } else { Interval::ZERO };
        let entry = |row: usize, column: usize| {
            let off = (bounds[row][column] - sizes[row][column]).magnitude();
            let slope = self.middle[row][column] + Interval::between(-off, off);
            let first = unit(row, column) + dt_s * bounds[row][column];
            let words = (all[row][column] - first).upper().max(0.0);
            unit(row, column) + dt_s * slope + Interval::between(-words, words)
        };
        let rows = |entry: &dyn Fn(usize, usize) -> Interval| -> [Vec<Interval>; MOTION] {
            core::array::from_fn(|row| (0..=self.states).map(|column| entry(row, column)).collect())
        };
        let mut ends = [rows(&unit), rows(&entry)];
        match self.lag {
            // The elevator is the command that arrives, at once.
            LagOf::None => {
                for end in &mut ends {
                    end[ELEVATOR].fill(Interval::ZERO);
                    end[ELEVATOR][self.states] = Interval::ONE;
                }
            }
            LagOf::First(_) => ends[1][ELEVATOR].clone_from(&around[ELEVATOR]),
            LagOf::Second(..) => {}
        }
        ends
    }
}
