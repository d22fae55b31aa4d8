//! The response of a linear plant to gusts and turbulence that vary within one sample.
//!
//! A sample is flown with the air held as it is at its beginning, which is what a trace shows, and by superposition what the
//! change since then adds is computed apart, once for all controllers:
//!
//! $$ \dot y = A y + E \left( g(t) - g(t_k) \right), \qquad y(t_k) = 0, \qquad x(t_{k+1}) \mathrel{+}= y(t_{k+1}) $$
//!
//! The sample is cut where the air is not smooth (times of the turbulence's grid, corners of gusts) and into parts of no
//! more than 10 ms. On a part the air is the polynomial of fourth degree through five equidistant points, and the solution
//! of that is a power series, summed to rounding; the error falls with the sixth power of the part.

use crate::actuated::Actuated;
use crate::air::{Grid, Piece, Wind};
use crate::error::SimError;
use crate::math::dot;
use crate::propagation::Propagation;
use crate::scenario::Stage;
use crate::surroundings::{TurbulenceWalk, Weather};
use crate::timing::Timing;

/// Points of a part.
const NODES: usize = 5;
/// Largest norm of A times a part.
const PART: f64 = 0.5;
/// Terms of the series: 0.5^20 / 20! is below 10⁻²⁴.
const TERMS: u32 = 20;
/// Parts shorter than this, s, are rounding.
const SHORTEST_S: f64 = 1e-12;

/// How a plant answers to the air.
#[derive(Clone, Debug)]
pub(crate) struct PlantAir {
    /// Rows over the states, then over the three gusts.
    rows: Vec<Vec<f64>>,
    norm_1_s: f64,
}

impl PlantAir {
    /// Of the plant's matrix and its input columns.
    pub(crate) fn new(a: &[f64], by_gust: &[Vec<f64>; 3]) -> Self {
        let order = by_gust[0].len();
        let row = |i: usize| {
            let mut row = a[i * order..(i + 1) * order].to_vec();
            row.extend(by_gust.iter().map(|column| column[i]));
            row
        };
        let rows: Vec<Vec<f64>> = (0..order).map(row).collect();
        let sum = |row: &Vec<f64>| row[..order].iter().map(|entry| entry.abs()).sum::<f64>();
        let norm_1_s = rows.iter().map(sum).fold(0.0, f64::max);
        Self { rows, norm_1_s }
    }

    /// The states after a part in which the air is a polynomial of the share of the part.
    fn advance(&self, states: &mut [f64], air: &[[f64; 3]; NODES], length_s: f64) {
        let (mut term, mut next) = (states.to_vec(), vec![0.0; states.len()]);
        for order in 0..TERMS {
            let driven = air.get(order as usize).copied().unwrap_or_default();
            let step_s = length_s / f64::from(order + 1);
            for (next, row) in next.iter_mut().zip(&self.rows) {
                let (by_state, by_air) = row.split_at(term.len());
                *next = step_s * (dot(by_state, &term) + dot(by_air, &driven));
            }
            std::mem::swap(&mut term, &mut next);
            states.iter_mut().zip(&term).for_each(|(state, term)| *state += term);
        }
    }
}

/// The polynomial of rising powers through values at 0, 1/4, 1/2, 3/4 and 1.
fn powers(values: &[[f64; 3]; NODES]) -> [[f64; 3]; NODES] {
    // Lagrange's basis written out, times 3.
    const BASIS: [[f64; NODES]; NODES] = [
        [3.0, 0.0, 0.0, 0.0, 0.0],
        [-25.0, 48.0, -36.0, 16.0, -3.0],
        [70.0, -208.0, 228.0, -112.0, 22.0],
        [-80.0, 288.0, -384.0, 224.0, -48.0],
        [32.0, -128.0, 192.0, -128.0, 32.0],
    ];
    BASIS.map(|row| {
        let sum =
            |part: usize| row.iter().zip(values).map(|(b, value)| b * value[part]).sum::<f64>();
        std::array::from_fn(|part| sum(part) / 3.0)
    })
}

/// What is added to the plant's states over each sample, one row a sample; `None` where the air is the same all through
/// every sample.
pub(crate) fn responses(
    weather: &Weather,
    timing: Timing,
    gusts: &[[f64; 3]],
    stages: &[Stage],
) -> Result<Option<Vec<Vec<f64>>>, SimError> {
    let grid = Grid::new(timing.dt_s());
    let held = weather.turbulence.is_none() || grid.holds_through_samples();
    if weather.winds.is_empty() && held {
        return Ok(None);
    }
    let (turbulence, corners_s) = (weather.walk()?, corners_s(weather));
    let mut walk = Walk { weather, turbulence, corners_s, timing, grid };
    let mut stages = stages.iter().peekable();
    let mut plant = None;
    let mut rows = Vec::with_capacity(gusts.len());
    for (k, gust) in gusts.iter().enumerate() {
        while let Some(next) = stages.next_if(|next| next.from <= k) {
            plant = plant_air(&next.propagation);
        }
        let Some(plant) = plant else {
            return Ok(None);
        };
        rows.push(walk.sample(plant, k, gust));
    }
    Ok(Some(rows))
}

fn plant_air(propagation: &Propagation) -> Option<&PlantAir> {
    match propagation {
        Propagation::ByLegs(actuated) => Some(Actuated::air(actuated)),
        _ => None,
    }
}

/// Times at which an aircraft on its course meets corners of the winds.
fn corners_s(weather: &Weather) -> Vec<f64> {
    let course = &weather.course;
    let corners = weather.winds.iter().map(Wind::corners);
    let times = corners.flat_map(|corners| {
        let along = corners.distance_m.into_iter().map(|at_m| at_m / course.airspeed_m_s);
        let up = corners.height_m.into_iter().filter_map(|at_m| course.time_at_height_s(at_m));
        along.chain(up).chain(corners.time_s).collect::<Vec<f64>>()
    });
    let mut times: Vec<f64> = times.filter(|time_s| time_s.is_finite()).collect();
    times.sort_by(f64::total_cmp);
    times
}

/// The air along a course.
struct Walk<'a> {
    weather: &'a Weather,
    turbulence: Option<TurbulenceWalk>,
    corners_s: Vec<f64>,
    timing: Timing,
    grid: Grid,
}

impl Walk<'_> {
    fn sample(&mut self, plant: &PlantAir, k: usize, gust: &[f64; 3]) -> Vec<f64> {
        let mut states = vec![0.0; plant.rows.len()];
        for piece in self.grid.pieces(k) {
            let turbulence = self.turbulence.as_mut().map(|walk| walk.at(piece.tick));
            let still = turbulence.unwrap_or_default();
            let base: [f64; 3] = std::array::from_fn(|part| still[part] - gust[part]);
            self.piece(&mut states, plant, k, &piece, base);
        }
        states
    }

    /// A part of one tick, cut at corners.
    fn piece(&self, states: &mut [f64], plant: &PlantAir, k: usize, piece: &Piece, base: [f64; 3]) {
        let sample_s = self.timing.time_s(k);
        let (begin_s, end_s) = (sample_s + piece.from_s, sample_s + piece.from_s + piece.length_s);
        let first = self.corners_s.partition_point(|time_s| *time_s <= begin_s + SHORTEST_S);
        let later = self.corners_s.get(first..).unwrap_or_default().iter().copied();
        let mut from_s = begin_s;
        for to_s in later.take_while(|time_s| *time_s < end_s - SHORTEST_S).chain([end_s]) {
            let parts = (plant.norm_1_s * (to_s - from_s) / PART).ceil().max(1.0);
            let length_s = (to_s - from_s) / parts;
            let mut index = 0.0;
            while index < parts {
                self.part(states, plant, from_s + index * length_s, length_s, base);
                index += 1.0;
            }
            from_s = to_s;
        }
    }

    fn part(
        &self,
        states: &mut [f64],
        plant: &PlantAir,
        from_s: f64,
        length_s: f64,
        base: [f64; 3],
    ) {
        let values: [[f64; 3]; NODES] = std::array::from_fn(|node| {
            let wind = self.weather.wind_change(from_s + 0.25 * node as f64 * length_s);
            std::array::from_fn(|part| wind[part] + base[part])
        });
        let still = |values: &[f64]| values.iter().all(|value| *value == 0.0);
        if still(states) && values.iter().all(|value| still(value)) {
            return;
        }
        plant.advance(states, &powers(&values), length_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_give_the_values_back() {
        let values: [[f64; 3]; NODES] = std::array::from_fn(|node| {
            [node as f64, libm::sin(node as f64), 1.0 / (1.0 + node as f64)]
        });
        let powers = powers(&values);
        for (node, expected) in values.iter().enumerate() {
            let share = 0.25 * node as f64;
            let at =
                |part: usize| powers.iter().rev().fold(0.0, |sum, row| sum * share + row[part]);
            for (part, expected) in expected.iter().enumerate() {
                assert!((at(part) - expected).abs() < 1e-13, "{node} {part}");
            }
        }
    }

    /// x' = -x + g with g = t³ over 0.3 s: x = t³ - 3 t² + 6 t - 6 + 6 e^-t.
    #[test]
    fn a_polynomial_of_the_air_is_answered_exactly() {
        let plant = PlantAir::new(&[-1.0], &[vec![1.0], vec![0.0], vec![0.0]]);
        let t: f64 = 0.3;
        let mut states = [0.0];
        let values: [[f64; 3]; NODES] = std::array::from_fn(|node| {
            let at = 0.25 * node as f64 * t;
            [at * at * at, 5.0, -7.0]
        });
        plant.advance(&mut states, &powers(&values), t);
        let expected = t * t * t - 3.0 * t * t + 6.0 * t - 6.0 + 6.0 * libm::exp(-t);
        assert!((states[0] - expected).abs() < 1e-15, "{} {expected}", states[0]);
    }
}
