//! What rules that conclude numbers answer over a box, and how steeply: the bilinear interpolation of their numbers.

use fspid_fuzzy::{NumberTable, Output};
use fspid_numeric::scalar::Interval;

/// The outermost set, in spacings.
const LAST: i8 = 3;

/// Numbers at the centres of even sets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbers<'a> {
    pub(super) table: &'a NumberTable<f64>,
    /// Half range of the inputs.
    pub(super) range: f64,
}

impl Numbers<'_> {
    /// All answers over inputs as the even sets see them, but for the rounding of the supervisor's own sums.
    ///
    /// Between neighbouring centres the answer is linear along either input, so that over a box it is largest and
    /// smallest where a border of the box or a line through centres meets another.
    pub(super) fn over(&self, asked: [Interval; 2]) -> [Interval; 3] {
        let [errors, changes] = asked.map(|side| self.places(side));
        Output::ALL.map(|output| {
            let pairs =
                errors.iter().flat_map(|error| changes.iter().map(move |change| (error, change)));
            let answers = pairs.map(|(error, change)| self.at(output, *error, *change));
            answers.reduce(Interval::hull).unwrap_or(Interval::ENTIRE)
        })
    }

    /// Least and largest slope of each output along error and change, per unit of the range, as the even sets see the
    /// inputs; beyond the range answers are level.
    pub(super) fn slopes(&self) -> [[Interval; 2]; 3] {
        let spacing = Interval::point(self.range) / Interval::point(3.0);
        Output::ALL.map(|output| {
            let grid = self.table.grid(output);
            let mut slopes = [Interval::ZERO; 2];
            let steeper = |slope: &mut Interval, from: f64, to: f64| {
                let found = (Interval::point(to) - Interval::point(from)) / spacing;
                *slope = slope.hull(found);
            };
            for (row, next) in grid.iter().zip(grid.iter().skip(1)) {
                row.iter().zip(next).for_each(|(from, to)| steeper(&mut slopes[0], *from, *to));
            }
            for row in grid {
                row.iter()
                    .zip(row.iter().skip(1))
                    .for_each(|(from, to)| steeper(&mut slopes[1], *from, *to));
            }
            slopes
        })
    }

    /// The ends of a side and the centres between them, in spacings: each the centre below and the way to the next.
    fn places(&self, side: Interval) -> Vec<(usize, Interval)> {
        let spacing = Interval::point(self.range) / Interval::point(3.0);
        let end = |value: f64| {
            let last = f64::from(LAST);
            let place = Interval::point(value) / spacing;
            Interval::between(place.lower().clamp(-last, last), place.upper().clamp(-last, last))
        };
        let [lower, upper] = [end(side.lower()), end(side.upper())];
        let mut places = Vec::new();
        for step in -LAST..=LAST {
            let centre = f64::from(step);
            let index = (step + LAST) as usize;
            // An end that may lie on either side of a centre lies in both cells.
            if lower.lower() <= centre && centre <= upper.upper() {
                places.push((index.min(5), if index < 6 { Interval::ZERO } else { Interval::ONE }));
            }
            for end in [lower, upper] {
                let way = end - Interval::point(centre);
                if let Some(part) = way.intersection(Interval::UNIT).filter(|_| index < 6) {
                    places.push((index, part));
                }
            }
        }
        places
    }

    pub(super) fn at(
        &self,
        output: Output,
        (row, down): (usize, Interval),
        (column, across): (usize, Interval),
    ) -> Interval {
        let grid = self.table.grid(output);
        let number = |row: usize, column: usize| {
            grid.get(row)
                .and_then(|row| row.get(column))
                .map_or(Interval::ENTIRE, |it| Interval::point(*it))
        };
        let between = |from: Interval, to: Interval, way: Interval| from + way * (to - from);
        let along = |row| between(number(row, column), number(row, column + 1), across);
        let (from, to) = (along(row), along(row + 1));
        between(from, to, down)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> NumberTable<f64> {
        let grid = |seed: usize| {
            let number = |row: usize, column: usize| {
                ((row * 5 + column * 11 + seed) % 13) as f64 / 13.0 - 0.5
            };
            core::array::from_fn(|row| core::array::from_fn(|column| number(row, column)))
        };
        NumberTable::new([grid(1), grid(4), grid(9)]).unwrap()
    }

    #[test]
    fn answers_within_a_box_lie_in_what_is_said_of_it_and_reach_its_ends() {
        let table = table();
        let supervisor =
            fspid_fuzzy::Supervisor::of_numbers(&table, 2.0, fspid_fuzzy::OutOfRange::Clamp)
                .unwrap();
        let numbers = Numbers { table: &table, range: 2.0 };
        for (error, change) in
            [([-0.3, 0.9], [0.1, 0.2]), ([-2.0, 2.0], [-2.0, 2.0]), ([0.5, 0.5], [-1.9, 2.0])]
        {
            let told = numbers.over([error, change].map(|[a, b]| Interval::between(a, b)));
            let mut found = [Interval::ENTIRE; 3];
            for i in 0..=60 {
                for j in 0..=60 {
                    let at =
                        |[from, to]: [f64; 2], n: i32| from + (to - from) * f64::from(n) / 60.0;
                    let delta = supervisor.infer(at(error, i), at(change, j)).unwrap().delta;
                    for ((found, value), told) in
                        found.iter_mut().zip([delta.kp, delta.ki, delta.kd]).zip(told)
                    {
                        assert!(told.lower() - 1e-12 <= value && value <= told.upper() + 1e-12);
                        *found = if found.is_bounded() {
                            found.hull(Interval::point(value))
                        } else {
                            Interval::point(value)
                        };
                    }
                }
            }
            for (told, found) in told.iter().zip(found) {
                assert!(told.width() < found.width() + 0.05, "{told:?} {found:?}");
            }
        }
    }
}
