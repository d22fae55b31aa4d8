//! Merging of reachable sets at a common sample into one enclosing set.
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

#[cfg(test)]
mod tests {
    use fspid_sim::Scenario;

    use super::*;
    use crate::description::LoopDescription;
    use crate::gain_set::GainSet;
    use crate::rest::drawn::{self, Dice};
    use crate::steps::flights::{Beginning, begun};
    use crate::steps::flown::flown;

    /// A drawn loop; one that remembers has numbers of its tuner as well.
    fn described(drawn: fn(&mut Dice) -> Scenario, seed: u64) -> LoopDescription {
        let scenario = drawn(&mut Dice::new(seed));
        let plant = scenario.plant.linear().expect("linear");
        LoopDescription::of(&scenario, plant, &scenario.controllers[0].controller).expect("of it")
    }

    /// With a ball that reaches.
    fn with_loop(description: &LoopDescription, asks: impl FnOnce(&Flown<'_>)) {
        let model = description.enclosed().expect("enclosed");
        let set = GainSet::fixed(description.controller.nominal());
        let mut flown = flown(description, &model, &set, None).expect("flown");
        flown.reach = (0..flown.layout.size).map(|place| 0.1 + 0.01 * place as f64).collect();
        asks(&flown);
    }

    /// A set whose numbers move so much with set-point and load, with more of their own up to `left`, and a ball.
    fn set(flown: &Flown<'_>, patch: Patch, slopes: [f64; 2], [left, ball]: [f64; 2]) -> Set {
        let [setpoint, load] = patch.unknowns();
        let mut flight = Flight { ball, ..begun(flown, Beginning::Rest) };
        let mut symbols = flight.symbols;
        let mut place = 0.0;
        let Flight { values, last, tuned, .. } = &mut flight;
        let all = values.iter_mut().chain([last]);
        for number in all.chain(tuned.iter_mut().flat_map(Tuned::each_mut)) {
            place += 1.0;
            let [by_setpoint, by_load] = slopes.map(|slope| Interval::point(slope * place));
            let middle = Affine::constant(Interval::point(0.3 * place));
            let terms = [(by_setpoint, &setpoint), (by_load, &load), (Interval::ONE, &middle)];
            *number = Affine::sum(terms).and_noise(left, &mut || {
                symbols += 1;
                symbols - 1
            });
        }
        flight.symbols = symbols;
        (patch, flight)
    }

    /// Everything that a number may be at a set-point and a load.
    fn at(number: &Affine, patch: Patch, known: [f64; 2]) -> Interval {
        let mut number = number.clone();
        for ((symbol, unknown), value) in
            [SETPOINT, LOAD].into_iter().zip(patch.unknowns()).zip(known)
        {
            let radius = unknown.parts.of(symbol);
            if radius > 0.0 {
                let share = Affine::constant(Interval::point((value - unknown.centre) / radius));
                number = number.with(symbol, &share);
            }
        }
        number.range()
    }

    const ONE: Patch = Patch { setpoint: [0.1, 0.2], load: [-0.02, -0.02] };
    const OTHER: Patch = Patch { setpoint: [0.2, 0.5], load: [-0.02, -0.02] };

    #[test]
    fn what_is_joined_holds_every_flight_of_its_sets() {
        let drawn: [fn(&mut Dice) -> Scenario; 2] =
            [drawn::with_limits, drawn::remembering_with_limits];
        for (seed, drawn) in drawn.into_iter().enumerate() {
            let description = described(drawn, seed as u64);
            with_loop(&description, |flown| {
                let beside = Patch { load: [-0.02, 0.03], ..OTHER };
                let sets = [
                    set(flown, ONE, [1.5, 0.4], [0.01, 0.5]),
                    set(flown, OTHER, [2.0, -0.7], [0.002, 0.0]),
                    set(flown, beside, [-0.3, 0.9], [0.0, 0.1]),
                ];
                let each: Vec<&Set> = sets.iter().collect();
                let joined = Joined::of(flown, &each).expect("three");
                let whole = Patch { setpoint: [0.1, 0.5], load: [-0.02, 0.03] };
                let flight = joined.flight(&sets[0].1, &Commands::step(), whole, 3);
                for (patch, of_set) in &sets {
                    for share in [0.0, 0.3, 1.0] {
                        let known = [patch.setpoint, patch.load].map(|[a, b]| a + share * (b - a));
                        for (one, all) in numbers(flown, of_set).zip(numbers(flown, &flight)) {
                            let [one, all] = [at(&one, *patch, known), at(&all, whole, known)];
                            let slack = Interval::between(-1e-12, 1e-12);
                            assert!((all + slack).encloses(one), "{known:?}: {one:?} {all:?}");
                        }
                    }
                }
            });
        }
    }

    #[test]
    fn a_number_of_a_joined_set_moves_with_the_set_point_as_those_of_its_sets_and_has_an_unknown_of_its_own()
     {
        let description = described(drawn::remembering_with_limits, 1);
        with_loop(&description, |flown| {
            let sets =
                [set(flown, ONE, [1.0, 5.0], [0.0; 2]), set(flown, OTHER, [2.0, 5.0], [0.0; 2])];
            let joined = Joined::of(flown, &[&sets[0], &sets[1]]).expect("two");
            // By the widths of their boxes, 0.1 and 0.3; a load that is known says nothing.
            for (place, number) in joined.numbers.iter().enumerate() {
                let [by_setpoint, by_load] = number.slopes;
                let expected = 1.75 * (place + 1) as f64;
                assert!((by_setpoint - expected).abs() < 1e-9, "{place}: {by_setpoint}");
                assert!(by_load.abs() <= 0.0, "{place}: {by_load}");
            }
            let flight = joined.flight(&sets[0].1, &Commands::step(), ONE.hull(&OTHER), 3);
            let mut before = OWN - 1;
            let own = flight.values.iter().chain([&flight.last]);
            let own = own.chain(flight.tuned.iter().flat_map(Tuned::each));
            for (value, number) in own.zip(&joined.numbers) {
                let parts = value.parts.each().iter().enumerate().skip(OWN);
                let mut there = parts.filter(|(_, part)| part.abs() > 0.0);
                let (symbol, radius) = there.next().expect("somewhat is left");
                assert!(there.next().is_none() && symbol == before + 1, "{symbol} {before}");
                let off = (radius - number.left.radius()).abs();
                assert!(off <= 1e-9 * radius, "{radius} {:?}", number.left);
                before = symbol;
            }
            assert_eq!(flight.symbols, before + 1);
        });
    }

    #[test]
    fn the_whole_of_a_set_is_the_set_to_the_bit() {
        let description = described(drawn::with_limits, 0);
        with_loop(&description, |flown| {
            let wide = Patch { load: [-0.03, 0.05], ..ONE };
            for patch in [wide, ONE] {
                let whole = set(flown, patch, [1.0 / 3.0, 0.7], [0.01, 0.0]);
                assert_eq!(narrowed(&whole, patch).values, whole.1.values);
            }
        });
    }
}
