//! Where $1 + N(A, \omega) L(\omega)$ vanishes: rectangles that may hold a zero, made smaller until
//! the function turns around them or stays away from zero.

use std::collections::BTreeMap;

use fspid_lti::{Complex, modulus};

use super::{LimitedPath, OpenLoop, Search};

/// Amplitudes a decade.
const AMPLITUDES: f64 = 10.0;
/// Frequencies a decade at which describing functions are computed roughly; between them they are
/// taken to be straight in the logarithm of the frequency.
const COLUMNS: f64 = 8.0;
/// Frequencies a decade at which the open loop is computed at least.
const FREQUENCIES: f64 = 40.0;
/// Largest change of the open loop's logarithm from one frequency to the next.
const LARGEST_CHANGE: f64 = 0.2;
/// Halvings of a step of frequency to keep it below that.
const MOST_HALVINGS: u32 = 14;
/// Open loops smaller than this need a describing function well above 1.
const LEAST_GAIN: f64 = 0.8;
/// Error of rough describing functions, relative.
const ROUGH: f64 = 0.1;
/// A function that is straight over a cell changes from its middle to its corners by as much as it
/// has at its middle if it vanishes anywhere in the cell; this leaves room for one that is bent.
const BENT: f64 = 1.5;
/// As straight as this, relative to what it changes by, a function is solved for its zero.
const STRAIGHT: f64 = 0.05;
/// How far outside of a cell, in halves of its widths from its middle, its zero is still looked for.
const OUTSIDE: f64 = 1.5;
/// Steps of the solution; each leaves a tenth or so of the error.
const STEPS: usize = 20;
/// Of the function: small enough.
const SOLVED: f64 = 1e-7;
/// How far a fair solution and an exact one may lie apart in the logarithms.
const WANDER: f64 = 0.1;
/// Halvings of a cell after which a zero is taken to be in its middle …
const SPLITS: u32 = 14;
/// … if the function is no larger there.
const UNSOLVED: f64 = 0.1;
/// Describing functions this near 1 are those of a path that does not limit.
const UNLIMITED: f64 = 1e-4;

/// A solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Zero {
    pub(super) amplitude_rad: f64,
    pub(super) frequency_rad_s: f64,
    /// True where the mapping from (A, ω) keeps its sense of turning.
    pub(super) turns_forward: bool,
}

/// Describing functions of a path over amplitudes and frequencies, computed where they are asked for.
pub(super) struct DescribingTable<'a> {
    path: &'a LimitedPath,
    search: Search,
    /// Logarithms of the amplitudes.
    amplitudes: Vec<f64>,
    columns: BTreeMap<i32, Vec<Complex>>,
}

impl<'a> DescribingTable<'a> {
    pub(super) fn new(path: &'a LimitedPath, search: Search) -> Self {
        let (least, most) = search.amplitude_rad;
        let amplitudes = spaced(libm::log(least), libm::log(most), AMPLITUDES);
        Self { path, search, amplitudes, columns: BTreeMap::new() }
    }

    fn column(&mut self, index: i32) -> &[Complex] {
        let (path, amplitudes) = (self.path, &self.amplitudes);
        self.columns.entry(index).or_insert_with(|| {
            let frequency_rad_s = libm::exp10(f64::from(index) / COLUMNS);
            let one = Complex::new(1.0, 0.0);
            let at = |amplitude: &f64| path.roughly(libm::exp(*amplitude), frequency_rad_s);
            amplitudes.iter().map(|amplitude| at(amplitude).unwrap_or(one)).collect()
        })
    }

    /// Describing functions at a frequency, amplitude by amplitude.
    fn at(&mut self, log_frequency: f64) -> Vec<Complex> {
        let place = log_frequency / std::f64::consts::LN_10 * COLUMNS;
        let whole = place.floor();
        #[allow(clippy::cast_possible_truncation, reason = "some hundred, and the cast saturates")]
        let index = whole as i32;
        let lower = self.column(index).to_vec();
        let upper = self.column(index + 1);
        let between = |(low, high): (Complex, &Complex)| low + (high - low) * (place - whole);
        lower.into_iter().zip(upper).map(between).collect()
    }

    /// Every solution for an open loop.
    pub(super) fn zeros(&mut self, open: &OpenLoop) -> Vec<Zero> {
        let mut zeros = Zeros::new(self.path, open);
        for pair in frequencies(open, self.search.frequency_rad_s).windows(2) {
            let [(from, first), (to, second)] = *pair else {
                continue;
            };
            let gain = modulus(first).max(modulus(second));
            if gain < LEAST_GAIN {
                continue;
            }
            let (first_column, second_column) = (self.at(from), self.at(to));
            let columns = first_column.windows(2).zip(second_column.windows(2));
            for ((near, far), log) in columns.zip(self.amplitudes.windows(2)) {
                let one = |factor: &Complex| modulus(factor - 1.0) < UNLIMITED;
                // Without a limit no amplitude differs from another.
                if near.iter().chain(far).all(one) {
                    continue;
                }
                let corners = [
                    one_plus(near[0], first),
                    one_plus(near[1], first),
                    one_plus(far[1], second),
                    one_plus(far[0], second),
                ];
                let middle: Complex = corners.iter().sum::<Complex>() * 0.25;
                let size = corners.iter().map(|value| modulus(value - 1.0)).fold(0.0, f64::max);
                if may_vanish(&corners, middle, ROUGH * size) {
                    zeros.search(Cell { amplitude: (log[0], log[1]), frequency: (from, to) });
                }
            }
        }
        zeros.found
    }
}

fn one_plus(factor: Complex, returned: Complex) -> Complex {
    factor * returned + 1.0
}

/// False where a function is too far from zero for what it does over a cell.
fn may_vanish(corners: &[Complex; 4], middle: Complex, error: f64) -> bool {
    let spread = corners.iter().map(|corner| modulus(corner - middle)).fold(0.0, f64::max);
    // Written so that NaN stays away.
    modulus(middle) <= BENT * spread + error
}

/// A rectangle of the plane of the logarithms of amplitude and frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    amplitude: (f64, f64),
    frequency: (f64, f64),
}

impl Cell {
    /// Corners in the order in which the amplitude leads.
    fn corners(&self) -> [(f64, f64); 4] {
        let ((low, high), (from, to)) = (self.amplitude, self.frequency);
        [(low, from), (high, from), (high, to), (low, to)]
    }

    fn middle(&self) -> (f64, f64) {
        let ((low, high), (from, to)) = (self.amplitude, self.frequency);
        (0.5 * (low + high), 0.5 * (from + to))
    }

    /// A point of the cell, x and y from -1 to 1.
    fn at(&self, x: f64, y: f64) -> (f64, f64) {
        let ((low, high), (from, to)) = (self.amplitude, self.frequency);
        let (amplitude, frequency) = self.middle();
        (amplitude + 0.5 * x * (high - low), frequency + 0.5 * y * (to - from))
    }

    /// Both halves, cut across the amplitudes or across the frequencies.
    fn halves(&self, across_amplitudes: bool) -> [Self; 2] {
        let ((low, high), (from, to)) = (self.amplitude, self.frequency);
        let (middle, between) = self.middle();
        if across_amplitudes {
            [
                Self { amplitude: (low, middle), ..*self },
                Self { amplitude: (middle, high), ..*self },
            ]
        } else {
            [
                Self { frequency: (from, between), ..*self },
                Self { frequency: (between, to), ..*self },
            ]
        }
    }
}

/// Looks for solutions, first fairly, then exactly.
struct Zeros<'a> {
    path: &'a LimitedPath,
    open: &'a OpenLoop,
    found: Vec<Zero>,
    /// Values at points by their bits: every corner belongs to several cells.
    known: BTreeMap<(u64, u64), Option<Complex>>,
}

impl<'a> Zeros<'a> {
    fn new(path: &'a LimitedPath, open: &'a OpenLoop) -> Self {
        Self { path, open, found: Vec::new(), known: BTreeMap::new() }
    }

    /// Fairly, at logarithms of amplitude and frequency.
    fn value(&mut self, (amplitude, frequency): (f64, f64)) -> Option<Complex> {
        let key = (amplitude.to_bits(), frequency.to_bits());
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let (amplitude_rad, frequency_rad_s) = (libm::exp(amplitude), libm::exp(frequency));
        let factor = self.path.fairly(amplitude_rad, frequency_rad_s);
        let response = self.open.at(frequency_rad_s);
        let value = factor.zip(response).map(|(n, response)| one_plus(n, response.returned));
        self.known.insert(key, value);
        value
    }

    fn exactly(&self, (amplitude, frequency): (f64, f64)) -> Option<Complex> {
        let (amplitude_rad, frequency_rad_s) = (libm::exp(amplitude), libm::exp(frequency));
        let response = self.open.at(frequency_rad_s)?;
        let factor = self.path.describing_function(amplitude_rad, frequency_rad_s)?;
        Some(one_plus(factor, response.returned))
    }

    fn values(&mut self, cell: &Cell) -> Option<[Complex; 4]> {
        let [a, b, c, d] = cell.corners();
        Some([self.value(a)?, self.value(b)?, self.value(c)?, self.value(d)?])
    }

    fn search(&mut self, cell: Cell) {
        if let Some(corners) = self.values(&cell) {
            self.split(cell, &corners, SPLITS);
        }
    }

    /// Looks for zeros in a cell, whose corners have these values.
    fn split(&mut self, cell: Cell, corners: &[Complex; 4], left: u32) {
        let Some(middle) = self.value(cell.middle()) else {
            return;
        };
        if !may_vanish(corners, middle, 0.0) {
            return;
        }
        if let Some(plane) = Plane::through(corners, middle) {
            self.solve(&cell, &plane);
            return;
        }
        let [a, b, c, d] = *corners;
        if left == 0 {
            let sense = turns(corners);
            if sense != 0 && modulus(middle) <= UNSOLVED {
                self.add(cell.middle(), sense > 0);
            }
            return;
        }
        // Across what changes it more.
        let by_amplitude = modulus(b - a) + modulus(c - d);
        let by_frequency = modulus(d - a) + modulus(c - b);
        let across_amplitudes = by_amplitude >= by_frequency;
        let halves = cell.halves(across_amplitudes);
        let [_, p, q, r] = halves[0].corners();
        let [Some(p), Some(q), Some(r)] = [p, q, r].map(|corner| self.value(corner)) else {
            return;
        };
        let values = if across_amplitudes {
            [[a, p, q, d], [p, b, c, q]]
        } else {
            [[a, b, q, r], [r, q, c, d]]
        };
        for (half, corners) in halves.into_iter().zip(&values) {
            self.split(half, corners, left - 1);
        }
    }

    /// Goes from the middle of a cell to the zero of a function that is nearly a plane there: first
    /// fairly, and from there exactly, as far as that leads.
    fn solve(&mut self, cell: &Cell, plane: &Plane) {
        let inside = |x: f64, y: f64| f64::max(x.abs(), y.abs()) <= OUTSIDE;
        let Some(fair) = plane.zero((0.0, 0.0), inside, |x, y| self.value(cell.at(x, y))) else {
            return;
        };
        let start = cell.at(fair.0, fair.1);
        let near = |x: f64, y: f64| {
            let (amplitude, frequency) = cell.at(x, y);
            f64::max((amplitude - start.0).abs(), (frequency - start.1).abs()) <= WANDER
        };
        let exact = plane.zero(fair, near, |x, y| self.exactly(cell.at(x, y)));
        let found = exact.map_or(start, |(x, y)| cell.at(x, y));
        self.add(found, plane.turns_forward());
    }

    /// Adds a zero that is not known yet.
    fn add(&mut self, (amplitude, frequency): (f64, f64), turns_forward: bool) {
        let (amplitude_rad, frequency_rad_s) = (libm::exp(amplitude), libm::exp(frequency));
        let zero = Zero { amplitude_rad, frequency_rad_s, turns_forward };
        if !self.found.iter().any(|known| known.is_as(&zero)) {
            self.found.push(zero);
        }
    }
}

/// A function $m + p x + q y$ over a cell, x and y from -1 to 1 along amplitude and frequency.
struct Plane {
    p: Complex,
    q: Complex,
}

impl Plane {
    /// The plane through the values of a function; `None` unless it is nearly one, and nowhere near
    /// edgewise.
    fn through(corners: &[Complex; 4], middle: Complex) -> Option<Self> {
        let [a, b, c, d] = *corners;
        let (p, q) = ((b + c - a - d) * 0.25, (c + d - a - b) * 0.25);
        let bent = modulus((a + b + c + d) * 0.25 - middle);
        let twisted = modulus((a - b + c - d) * 0.25);
        let plane = Self { p, q };
        let smallest = plane.turn().abs() / modulus(p).max(modulus(q));
        // Written so that NaN is no plane.
        (bent.max(twisted) <= STRAIGHT * smallest).then_some(plane)
    }

    /// $\operatorname{Im} \bar p q$: how x turns into y.
    fn turn(&self) -> f64 {
        self.p.re * self.q.im - self.p.im * self.q.re
    }

    fn turns_forward(&self) -> bool {
        self.turn() > 0.0
    }

    /// Where a function that is nearly this plane vanishes, while it is looked for where `allowed`.
    fn zero(
        &self,
        (mut x, mut y): (f64, f64),
        allowed: impl Fn(f64, f64) -> bool,
        mut value: impl FnMut(f64, f64) -> Option<Complex>,
    ) -> Option<(f64, f64)> {
        for _ in 0..STEPS {
            let here = value(x, y)?;
            if modulus(here) <= SOLVED {
                return Some((x, y));
            }
            let (step_x, step_y) = self.step(here);
            (x, y) = (x + step_x, y + step_y);
            // NaN is nowhere allowed.
            if !allowed(x, y) {
                return None;
            }
        }
        None
    }

    /// What takes a value to zero: $p x + q y = -v$.
    fn step(&self, value: Complex) -> (f64, f64) {
        let turn = self.turn();
        let x = (self.q.re * value.im - self.q.im * value.re) / turn;
        let y = (self.p.im * value.re - self.p.re * value.im) / turn;
        (x, y)
    }
}

impl Zero {
    /// The same cycle found from two cells is one.
    fn is_as(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-3;
        self.turns_forward == other.turns_forward
            && near(self.amplitude_rad, other.amplitude_rad)
            && near(self.frequency_rad_s, other.frequency_rad_s)
    }
}

/// How often a function turns around zero on the way around a cell.
fn turns(corners: &[Complex; 4]) -> i32 {
    let next = corners.iter().cycle().skip(1);
    let turned = |(from, to): (&Complex, &Complex)| {
        let turned = to * from.conj();
        libm::atan2(turned.im, turned.re)
    };
    let angle: f64 = corners.iter().zip(next).map(turned).sum();
    #[allow(clippy::cast_possible_truncation, reason = "between -2 and 2")]
    let turns = (angle / std::f64::consts::TAU).round() as i32;
    turns
}

/// Logarithms from one to another, at least so many a decade.
fn spaced(from: f64, to: f64, a_decade: f64) -> Vec<f64> {
    let steps = ((to - from) / std::f64::consts::LN_10 * a_decade).ceil().max(1.0);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at least 1, and the cast saturates"
    )]
    let count = steps as u32;
    (0..=count).map(|step| from + (to - from) * f64::from(step) / steps).collect()
}

/// Logarithms of frequencies so close that the open loop changes little from one to the next, and the
/// open loop there; poles are left out.
fn frequencies(open: &OpenLoop, (least, most): (f64, f64)) -> Vec<(f64, Complex)> {
    let at = |log_frequency: f64| {
        open.at(libm::exp(log_frequency)).map(|response| (log_frequency, response.returned))
    };
    let base = spaced(libm::log(least), libm::log(most), FREQUENCIES);
    let mut points: Vec<(f64, Complex)> = Vec::new();
    for point in base.into_iter().filter_map(at) {
        if let Some(&before) = points.last() {
            halve(&at, [before, point], MOST_HALVINGS, &mut points);
        }
        points.push(point);
    }
    points
}

/// Adds the points between two.
fn halve(
    at: &impl Fn(f64) -> Option<(f64, Complex)>,
    [from, to]: [(f64, Complex); 2],
    left: u32,
    points: &mut Vec<(f64, Complex)>,
) {
    let turned = to.1 * from.1.conj();
    let angle = libm::atan2(turned.im, turned.re).abs();
    let growth = (libm::log(modulus(to.1)) - libm::log(modulus(from.1))).abs();
    // Where there is nearly no loop, its angle does not matter.
    let small = modulus(from.1).max(modulus(to.1)) < 0.5 * LEAST_GAIN;
    if left == 0 || small || angle.max(growth) <= LARGEST_CHANGE {
        return;
    }
    if let Some(middle) = at(0.5 * (from.0 + to.0)) {
        halve(at, [from, middle], left - 1, points);
        points.push(middle);
        halve(at, [middle, to], left - 1, points);
    }
}
