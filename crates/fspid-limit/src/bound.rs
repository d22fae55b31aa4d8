//! A lower bound that holds whatever the multipliers are, by weak duality in intervals.

use fspid_numeric::scalar::Interval;

use crate::drift::Drift;
use crate::error::LimitError;
use crate::measure::Measure;
use crate::question::Question;

/// Numbers that a bound is made of. Any make a bound that holds; those of a solver make one that is near.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Multipliers {
    /// Of the error at each sample, $g_k$.
    pub error: Vec<f64>,
    /// Of the change of what counts as travel from the sample before to each, $\zeta_k$.
    pub travel: Vec<f64>,
    /// Of the change of the deflection from each sample to the next, where it is limited.
    pub change: Vec<f64>,
    /// Of the deflection at each sample, where there are stops: positive for the upper one.
    pub stop: Vec<f64>,
}

/// What no history of commands of a question gets below within a travel, rad: proved for every sampled plant that the
/// scenario's numbers can mean, in exact arithmetic. Not below 0.
///
/// # Errors
/// [`LimitError::GrowsTooFast`] where rounding cannot be bounded.
pub fn prove(
    question: &Question,
    measure: Measure,
    travel_rad: f64,
    multipliers: &Multipliers,
) -> Result<f64, LimitError> {
    let drift = Drift::of(&question.plant.a, question.rows)?;
    let multipliers = allowed(question, measure, multipliers);
    let sums = Sums::of(question, &multipliers, &drift);
    let budget = spent(question, travel_rad, &multipliers, &sums.open);
    let whole = sums.fixed + sums.commanded + own(question, measure, &multipliers) - budget;
    Ok(whole.lower().max(0.0))
}

fn at(values: &[f64], k: usize) -> f64 {
    values.get(k).copied().unwrap_or(0.0)
}

fn point(values: &[f64], k: usize) -> Interval {
    Interval::point(at(values, k))
}

fn sum(terms: impl Iterator<Item = Interval>) -> Interval {
    terms.fold(Interval::ZERO, |sum, term| sum + term)
}

/// Multipliers that the measure allows, and none where nothing is to be multiplied.
fn allowed(question: &Question, measure: Measure, given: &Multipliers) -> Multipliers {
    let (rows, counted) = (question.rows, &question.counted);
    let finite = |value: f64| if value.is_finite() { value } else { 0.0 };
    let padded = |values: &[f64]| (0..rows).map(|k| finite(at(values, k))).collect::<Vec<f64>>();
    let mut error = padded(&given.error);
    match measure {
        Measure::Iae => {
            error.iter_mut().for_each(|g| *g = g.clamp(-question.dt_s, question.dt_s));
        }
        Measure::Ise => {}
        Measure::Peak => {
            let whole = sum(error.iter().map(|g| Interval::point(g.abs()))).upper();
            if whole > 1.0 {
                // Down by more than the division rounds up.
                let scale = (1.0 / whole) * (1.0 - 1e-12);
                error.iter_mut().for_each(|g| *g *= scale);
            }
        }
    }
    let begins = counted.first + usize::from(!counted.from_rest);
    let inside = |k: usize| k >= begins && k < counted.end;
    let travel = padded(&given.travel).into_iter().enumerate();
    let travel = travel.map(|(k, it)| if inside(k) { it } else { 0.0 }).collect();
    let change = match question.most_change_rad {
        Some(_) => padded(&given.change),
        None => vec![0.0; rows],
    };
    let stop = match question.stops() {
        Some(_) => padded(&given.stop),
        None => vec![0.0; rows],
    };
    Multipliers { error, travel, change, stop }
}

/// What the multipliers cost and bring by themselves, whatever is commanded.
fn own(question: &Question, measure: Measure, multipliers: &Multipliers) -> Interval {
    let (counted, setpoint) = (&question.counted, &question.inflow.setpoint_rad);
    let error = &multipliers.error;
    let commanded = sum((0..question.rows).map(|k| point(error, k) * point(setpoint, k)));
    let squares = match measure {
        Measure::Ise => {
            let four_dt = Interval::point(4.0) * Interval::point(question.dt_s);
            sum(error.iter().map(|&g| Interval::point(g) * Interval::point(g) / four_dt))
        }
        Measure::Iae | Measure::Peak => Interval::ZERO,
    };
    let offset = |k: usize| Interval::point(counted.offset(k));
    let moved = |k: usize| if k > counted.first { offset(k) - offset(k - 1) } else { offset(k) };
    let travel = &multipliers.travel;
    let offsets = sum((counted.first..counted.end).map(|k| point(travel, k) * moved(k)));
    let rate = Interval::point(question.most_change_rad.unwrap_or(0.0));
    let changes = sum(multipliers.change.iter().map(|it| Interval::point(it.abs()) * rate));
    let (least, most) = question.stops().unwrap_or((0.0, 0.0));
    let stops = sum(multipliers
        .stop
        .iter()
        .map(|&it| Interval::point(it) * Interval::point(if it > 0.0 { most } else { least })));
    commanded - squares + offsets - changes - stops
}

/// What the travel costs, with what is open between samples: a change of the deflection may bring $\eta_k$ of itself more
/// than the lag's, so that the price of travel has to be above $|\zeta_k| + \eta_k$ everywhere.
fn spent(
    question: &Question,
    travel_rad: f64,
    multipliers: &Multipliers,
    open: &[Interval],
) -> Interval {
    let counted = &question.counted;
    let none = Interval::ZERO;
    let before = |k: usize| k.checked_sub(1).and_then(|k| open.get(k)).copied().unwrap_or(none);
    let price = |(k, it): (usize, &f64)| (Interval::point(it.abs()) + before(k)).upper();
    let price = multipliers.travel.iter().enumerate().map(price).fold(0.0, f64::max);
    let allowed = Interval::point(travel_rad.max(0.0)) + Interval::point(counted.more_rad);
    // What counts moves by its offset as well.
    let offsets = (1..question.rows).map(|k| {
        let moved = Interval::point(counted.offset(k)) - Interval::point(counted.offset(k - 1));
        before(k) * Interval::point(moved.magnitude())
    });
    Interval::point(price) * allowed + sum(offsets)
}

/// What the adjoint recursion makes of the commands and of everything that enters.
struct Sums {
    /// By what enters and by commands that were given before.
    fixed: Interval,
    /// The least that commands within their limits can make of their parts.
    commanded: Interval,
    /// By how much more than by the lag a change of the deflection in each sample may act, for its size; empty where
    /// nothing but the lag moves it.
    open: Vec<Interval>,
}

impl Sums {
    fn of(question: &Question, multipliers: &Multipliers, drift: &Drift) -> Self {
        let plant = &question.plant;
        let a: Vec<Interval> = plant.a.entries().collect();
        let (mut fixed, mut open) = (Interval::ZERO, Vec::new());
        // A target at the last sample moves nothing but itself.
        let last = question.rows.saturating_sub(1);
        let mut commanded = match last < question.delay() {
            true => Interval::ZERO,
            false => least(directly(question, multipliers, last), question.target_at(last)),
        };
        let mut adjoint = vec![0.0; plant.states];
        let mut apart = Interval::ZERO;
        for k in (0..question.rows.saturating_sub(1)).rev() {
            // From the state at k + 1.
            let (next, left_over) = back(question, multipliers, &a, &adjoint, k + 1);
            apart = drift.grown(apart, drift.norm(left_over.into_iter()));
            adjoint = next;
            let enclosed: Vec<Interval> = adjoint
                .iter()
                .enumerate()
                .map(|(place, &value)| {
                    let share = drift.share(place, apart);
                    Interval::point(value) + Interval::between(-share, share)
                })
                .collect();
            let along = |column: &[Interval]| {
                sum(enclosed.iter().zip(column).map(|(value, by)| *value * *by))
            };
            fixed = fixed + along(&question.entering(k));
            let price = along(&plant.by_target) + directly(question, multipliers, k);
            match question.before_rad.get(k) {
                Some(&target) => fixed = fixed + price * Interval::point(target),
                None => commanded = commanded + least(price, question.target_at(k)),
            }
            if let Some(between) = &question.between {
                let steepest = Interval::point(along(&between.response).magnitude());
                open.push(steepest * Interval::point(between.apart_s));
            }
        }
        open.reverse();
        Self { fixed, commanded, open }
    }
}

/// $p_k = q_k + A^T p_{k+1}$: in floats, and how far each entry may be from it.
fn back(
    question: &Question,
    multipliers: &Multipliers,
    a: &[Interval],
    adjoint: &[f64],
    k: usize,
) -> (Vec<f64>, Vec<f64>) {
    let states = adjoint.len();
    let entry = |place: usize| {
        let by_next =
            (0..states).map(|row| a[row * states + place] * Interval::point(adjoint[row]));
        sum(by_next) + on_state(question, multipliers, k, place)
    };
    let whole: Vec<Interval> = (0..states).map(entry).collect();
    let middles: Vec<f64> = whole.iter().map(|it| it.midpoint()).collect();
    let apart = |(it, &middle): (&Interval, &f64)| (*it - Interval::point(middle)).magnitude();
    let left_over = whole.iter().zip(&middles).map(apart).collect();
    (middles, left_over)
}

/// The factor of a state at a sample.
fn on_state(question: &Question, multipliers: &Multipliers, k: usize, place: usize) -> Interval {
    let Multipliers { error, travel, change, stop } = multipliers;
    let mut factor = Interval::ZERO;
    if place == 0 {
        factor = factor - point(error, k);
    }
    if question.counted.state == Some(place) {
        factor = factor + point(travel, k) - point(travel, k + 1);
    }
    if place == question.plant.deflection {
        let before = k.checked_sub(1).map_or(Interval::ZERO, |before| point(change, before));
        let after = if k + 1 < question.rows { point(change, k) } else { Interval::ZERO };
        factor = factor + before - after + point(stop, k);
    }
    factor
}

/// The factor of a target where its own way counts.
fn directly(question: &Question, multipliers: &Multipliers, k: usize) -> Interval {
    let counted = &question.counted;
    if counted.state.is_some() || k < counted.first || k >= counted.end {
        return Interval::ZERO;
    }
    let after = if k + 1 < counted.end { at(&multipliers.travel, k + 1) } else { 0.0 };
    point(&multipliers.travel, k) - Interval::point(after)
}

/// The least product with a number between two.
fn least(price: Interval, (low, high): (f64, f64)) -> Interval {
    let one = price * Interval::point(low);
    let other = price * Interval::point(high);
    Interval::point(one.lower().min(other.lower()))
}
