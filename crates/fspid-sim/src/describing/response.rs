//! The open loop without limits at a frequency.

use fspid_core::{Gains, Shell};
use fspid_lti::{Complex, modulus, quotient};

use crate::error::SimError;
use crate::loop_model::{LoopModel, LoopSettings, Memory};
use crate::math::sin_cos;
use crate::plant::LinearPlant;
use crate::scenario::Scenario;

/// Frequencies a decade at which gain crossovers are looked for.
const CROSSOVER_POINTS: i32 = 120;
/// Decades below half the sampling rate in which they are looked for.
const CROSSOVER_DECADES: i32 = 6;
/// Halvings that find one to the last bit.
const HALVINGS: usize = 60;

/// The open loop of a sampled loop at frozen gains without limits, broken at the command with every
/// other loop closed.
#[derive(Clone, Debug)]
pub struct OpenLoop {
    matrix: Vec<Vec<f64>>,
    entry: Vec<f64>,
    exit: Vec<f64>,
    /// Of the command, kept out of the matrix.
    delay_samples: usize,
    /// Where the deflection stands in the state; the pitch angle comes first.
    deflection: usize,
    dt_s: f64,
}

/// What a command $\cos \omega t$ of amplitude 1 makes around the open loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// The open loop $L(e^{j \omega T})$: what comes back as a command, sign changed.
    pub returned: Complex,
    /// Pitch angle, rad/rad.
    pub pitch: Complex,
    /// Deflection of the elevator in the sense of the command, rad/rad.
    pub deflection: Complex,
}

impl OpenLoop {
    /// The open loop of a plant of the scenario with these gains.
    ///
    /// # Errors
    /// [`SimError`] where the plant cannot be sampled.
    pub fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        shell: &Shell<f64>,
        gains: Gains<f64>,
    ) -> Result<Self, SimError> {
        let model = LoopModel::of(scenario, plant, shell, Memory::of_gains(gains, shell))?;
        let delay_samples = model.settings().delay_samples;
        let settings = LoopSettings { delay_samples: 0, ..model.settings().clone() };
        let parts = LoopModel::new(model.plant().clone(), settings).parts(gains);
        Ok(Self {
            matrix: parts.matrix,
            entry: parts.by_command,
            exit: parts.command,
            delay_samples,
            deflection: plant.order(),
            dt_s: shell.dt_s,
        })
    }

    /// Sample period, s.
    #[must_use]
    pub fn dt_s(&self) -> f64 {
        self.dt_s
    }

    /// Half the sampling rate, rad/s.
    #[must_use]
    pub fn nyquist_rad_s(&self) -> f64 {
        std::f64::consts::PI / self.dt_s
    }

    /// The response at a frequency, rad/s; `None` at a pole.
    #[must_use]
    pub fn at(&self, frequency_rad_s: f64) -> Option<Response> {
        let turn = |samples: f64| {
            let (sine, cosine) = sin_cos(frequency_rad_s * self.dt_s * samples);
            Complex::new(cosine, sine)
        };
        let state = resolvent(&self.matrix, &self.entry, turn(1.0))?;
        let late = turn(-(self.delay_samples as f64));
        let returned: Complex = self.exit.iter().zip(&state).map(|(by, x)| x * -by).sum();
        let part = |place: usize| state.get(place).copied().unwrap_or_default() * late;
        let response = Response {
            returned: returned * late,
            pitch: part(0),
            deflection: part(self.deflection),
        };
        let parts = [response.returned, response.pitch, response.deflection];
        parts.iter().all(|part| part.is_finite()).then_some(response)
    }

    /// Where the open loop has gain 1, rad/s, in order; from a millionth of half the sampling rate on.
    #[must_use]
    pub fn gain_crossovers_rad_s(&self) -> Vec<f64> {
        let above = |frequency_rad_s: f64| {
            let response = self.at(frequency_rad_s);
            response.map_or(f64::INFINITY, |response| modulus(response.returned)) > 1.0
        };
        let steps = CROSSOVER_POINTS * CROSSOVER_DECADES;
        let point = |step: i32| {
            let decades = f64::from(step - steps) / f64::from(CROSSOVER_POINTS);
            self.nyquist_rad_s() * libm::exp10(decades)
        };
        let mut crossovers = Vec::new();
        for step in 0..steps {
            let (mut from, mut to) = (point(step), point(step + 1));
            let before = above(from);
            if before == above(to) {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (from + to);
                *(if above(middle) == before { &mut from } else { &mut to }) = middle;
            }
            crossovers.push(0.5 * (from + to));
        }
        crossovers
    }
}

/// $(z I - A)^{-1} b$ by elimination with row exchanges; `None` where z is an eigenvalue.
fn resolvent(matrix: &[Vec<f64>], entry: &[f64], z: Complex) -> Option<Vec<Complex>> {
    let size = entry.len();
    let mut rows: Vec<Vec<Complex>> = matrix
        .iter()
        .zip(entry)
        .enumerate()
        .map(|(place, (row, by))| {
            let mut row: Vec<Complex> = row.iter().map(|value| Complex::from(-value)).collect();
            row[place] += z;
            row.push(Complex::from(*by));
            row
        })
        .collect();
    for column in 0..size {
        let pivot = (column..size).fold(column, |best, row| {
            let larger = rows[row][column].norm_sqr() > rows[best][column].norm_sqr();
            if larger { row } else { best }
        });
        rows.swap(column, pivot);
        let (done, below) = rows.split_at_mut(column + 1);
        let top = &done[column];
        if !(top[column].norm_sqr() > 0.0) {
            return None;
        }
        for row in below {
            let factor = quotient(row[column], top[column]);
            if factor.norm_sqr() > 0.0 {
                for (value, above) in row.iter_mut().zip(top).skip(column) {
                    *value -= factor * above;
                }
            }
        }
    }
    let mut state = vec![Complex::default(); size];
    for column in (0..size).rev() {
        let row = &rows[column];
        let known: Complex = (column + 1..size).map(|other| row[other] * state[other]).sum();
        state[column] = quotient(row[size] - known, row[column]);
    }
    Some(state)
}
