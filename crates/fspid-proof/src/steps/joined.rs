//! Sets of flights that have come to the same sample, joined to one.
//!
//! What they have in common is told apart: of every number what it moves by with the set-point and with the load, the same for
//! all, and beside it whatever it may still be. A load that is all but made up for leaves little of that, so that what comes
//! next need not be flown for each set anew. Every flight of the sets is in the joined one; what it forgets is what else its
//! numbers share. A set that is flown on alone forgets nothing.

use fspid_numeric::scalar::Interval;

use super::affine::{Affine, raised};
use super::commands::Commands;
use super::flights::{Patch, Set};
use super::sample::{Flight, Flown, LOAD, OWN, SETPOINT};
use super::tuned::Tuned;

/// A number of a joined set.
#[derive(Clone, Copy, Debug)]
struct Number {
    /// By the set-point and by the load.
    slopes: [f64; 2],
    left: Interval,
}

/// Joined sets at a sample.
#[derive(Clone, Debug)]
pub(super) struct Joined {
    /// States, the command before, and what a tuner remembers.
    numbers: Vec<Number>,
    limited: bool,
}

/// States, the command before, and what a tuner remembers.
fn numbers<'a>(flown: &'a Flown<'_>, flight: &'a Flight) -> impl Iterator<Item = Affine> + 'a {
    let values = flight.values.iter().zip(&flown.reach).map(|(value, reach)| {
        let mut value = value.clone();
        value.of_ball = raised(value.of_ball + reach * flight.ball, 3);
        value
    });
    let remembered = flight.tuned.iter().flat_map(Tuned::each).cloned();
    values.chain([flight.last.clone()]).chain(remembered)
}

/// By how much a number moves with one that is known by a symbol.
fn slope(of: &Affine, by: &Affine, symbol: usize) -> Option<f64> {
    let (over, under) = (of.parts.of(symbol), by.parts.of(symbol));
    (under > 0.0).then(|| over / under)
}

impl Joined {
    /// Sets with the boxes that they are of; nothing where there are none.
    pub(super) fn of(flown: &Flown<'_>, sets: &[&Set]) -> Option<Self> {
        let (_, one) = sets.first()?;
        let count = numbers(flown, one).count();
        let slopes = slopes(flown, sets, count);
        let mut left: Vec<Option<Interval>> = vec![None; count];
        for (patch, flight) in sets {
            let [setpoint, load] = patch.unknowns();
            for ((number, slopes), left) in numbers(flown, flight).zip(&slopes).zip(&mut left) {
                let [by_setpoint, by_load] = slopes.map(|slope| Interval::point(-slope));
                let apart = Affine::sum([
                    (Interval::ONE, &number),
                    (by_setpoint, &setpoint),
                    (by_load, &load),
                ]);
                let range = apart.range();
                *left = Some(left.map_or(range, |before| before.hull(range)));
            }
        }
        let numbers = slopes.into_iter().zip(left);
        let numbers = numbers.map(|(slopes, left)| Some(Number { slopes, left: left? }));
        let limited = sets.iter().any(|(_, flight)| flight.limited);
        Some(Self { numbers: numbers.collect::<Option<_>>()?, limited })
    }

    /// The flights of a box of it, of which `like` is one that has as many numbers, just before a sample.
    pub(super) fn flight(
        &self,
        like: &Flight,
        commands: &Commands,
        patch: Patch,
        sample: usize,
    ) -> Flight {
        let [setpoint, load] = patch.unknowns();
        let mut symbols = OWN;
        let mut number = |Number { slopes, left }: &Number| {
            let [by_setpoint, by_load] = slopes.map(Interval::point);
            let middle = Affine::constant(Interval::point(left.midpoint()));
            let whole =
                Affine::sum([(by_setpoint, &setpoint), (by_load, &load), (Interval::ONE, &middle)]);
            let radius = (*left - Interval::point(left.midpoint())).magnitude();
            whole.and_noise(radius, &mut || {
                symbols += 1;
                symbols - 1
            })
        };
        let mut numbers = self.numbers.iter().map(&mut number);
        let values: Vec<Affine> = numbers.by_ref().take(like.values.len()).collect();
        let last = numbers.next().unwrap_or_default();
        let tuned = like.tuned.as_ref().map(|tuned| {
            let mut tuned = tuned.clone();
            for (place, remembered) in tuned.each_mut().zip(numbers) {
                *place = remembered;
            }
            tuned
        });
        Flight {
            values,
            last,
            setpoint: setpoint.times(commands.setpoint.before(sample)),
            risen: Affine::default(),
            load: load.times(commands.at_elevator.before(sample)),
            at_servo: load.times(commands.at_servo.before(sample)),
            tuned,
            ball: 0.0,
            symbols,
            limited: self.limited,
        }
    }
}

/// The flights of a box among those of a set, which forget nothing: where the unknown of the set-point, or of the load, was
/// $\xi = (x - c) / r$ of the whole, x is now the number of the part. What has just risen is told anew at each sample.
///
/// A box may reach beyond the set: what it holds there is of no flight, and of those in both it leaves none out.
pub(super) fn narrowed((whole, flight): &Set, part: Patch) -> Flight {
    let mut flight = flight.clone();
    for (symbol, whole, part) in
        [(SETPOINT, whole.setpoint, part.setpoint), (LOAD, whole.load, part.load)]
    {
        let [whole, part] = [whole, part].map(|ends| Affine::unknown(ends, symbol));
        let radius = whole.parts.of(symbol);
        if whole == part || radius == 0.0 {
            continue;
        }
        let middle = Affine::constant(Interval::point(whole.centre));
        let per = Interval::ONE / Interval::point(radius);
        let unknown = Affine::sum([(per, &part), (-per, &middle)]);
        let Flight { values, last, setpoint, load, at_servo, tuned, .. } = &mut flight;
        let own = values.iter_mut().chain([last, setpoint, load, at_servo]);
        for value in own.chain(tuned.iter_mut().flat_map(Tuned::each_mut)) {
            *value = value.with(symbol, &unknown);
        }
    }
    flight
}

/// Of each number what it moves by with set-point and load: the mean of the sets, by the widths of their boxes.
fn slopes(flown: &Flown<'_>, sets: &[&Set], count: usize) -> Vec<[f64; 2]> {
    let mut sums = vec![[[0.0_f64; 2]; 2]; count];
    for (patch, flight) in sets {
        let unknowns = patch.unknowns();
        for (number, sums) in numbers(flown, flight).zip(&mut sums) {
            for (axis, symbol) in [(0, SETPOINT), (1, LOAD)] {
                let Some(within) = slope(&number, &unknowns[axis], symbol) else { continue };
                let weight = unknowns[axis].radius();
                sums[axis][0] += weight * within;
                sums[axis][1] += weight;
            }
        }
    }
    let mean = |[sum, weight]: [f64; 2]| if weight > 0.0 { sum / weight } else { 0.0 };
    sums.into_iter().map(|sums| sums.map(mean)).collect()
}
