//! Crossing and mutation of real coordinates within [0, 1]: simulated binary crossover (Deb and
//! Agrawal, Complex Systems 9, 1995) and polynomial mutation (Deb and Goyal, Computer Science and
//! Informatics 26, 1996), both in the form that knows the sides.

use super::random::Random;

/// How far children lie from their parents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variation {
    /// Distribution index of the crossover: larger is closer.
    pub(super) crossover_index: f64,
    /// Distribution index of the mutation.
    pub(super) mutation_index: f64,
    /// Share of the pairs that are crossed.
    pub(super) crossover: f64,
}

impl Variation {
    /// Two children of two parents.
    pub(super) fn children(self, random: &mut Random, a: &[f64], b: &[f64]) -> [Vec<f64>; 2] {
        let (mut first, mut second) = (a.to_vec(), b.to_vec());
        if random.unit() < self.crossover {
            for j in 0..first.len() {
                if random.unit() < 0.5 {
                    self.cross(random, &mut first[j], &mut second[j]);
                }
            }
        }
        for child in [&mut first, &mut second] {
            self.mutate(random, child);
            // A copy would be evaluated for nothing.
            if child == a || child == b {
                self.mutate_one(random, child);
            }
        }
        [first, second]
    }

    fn cross(self, random: &mut Random, a: &mut f64, b: &mut f64) {
        let (u, swapped) = (random.unit(), random.unit() < 0.5);
        let (low, high) = (a.min(*b), a.max(*b));
        let gap = high - low;
        if !(gap > 1e-14) {
            return;
        }
        let down = 0.5 * (low + high - self.spread(u, 1.0 + 2.0 * low / gap) * gap);
        let up = 0.5 * (low + high + self.spread(u, 1.0 + 2.0 * (1.0 - high) / gap) * gap);
        let (down, up) = (down.clamp(0.0, 1.0), up.clamp(0.0, 1.0));
        (*a, *b) = if swapped { (up, down) } else { (down, up) };
    }

    /// Spread factor β of the children where the side lies at spread `limit`.
    fn spread(self, u: f64, limit: f64) -> f64 {
        let power = 1.0 / (self.crossover_index + 1.0);
        let alpha = 2.0 - libm::pow(limit, -(self.crossover_index + 1.0));
        if u * alpha <= 1.0 {
            libm::pow(u * alpha, power)
        } else {
            libm::pow(1.0 / (2.0 - u * alpha), power)
        }
    }

    /// Moves one coordinate.
    pub(super) fn mutate_one(self, random: &mut Random, point: &mut [f64]) {
        let place = random.below(point.len());
        if let Some(x) = point.get_mut(place) {
            *x = (*x + self.step(random.unit(), *x)).clamp(0.0, 1.0);
        }
    }

    /// Moves one coordinate in the mean.
    fn mutate(self, random: &mut Random, point: &mut [f64]) {
        let share = 1.0 / point.len().max(1) as f64;
        for x in point.iter_mut() {
            if random.unit() < share {
                *x = (*x + self.step(random.unit(), *x)).clamp(0.0, 1.0);
            }
        }
    }

    fn step(self, u: f64, x: f64) -> f64 {
        let (index, power) = (self.mutation_index + 1.0, 1.0 / (self.mutation_index + 1.0));
        if u < 0.5 {
            libm::pow(2.0 * u + (1.0 - 2.0 * u) * libm::pow(1.0 - x, index), power) - 1.0
        } else {
            1.0 - libm::pow(2.0 * (1.0 - u) + (2.0 * u - 1.0) * libm::pow(x, index), power)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const USUAL: Variation =
        Variation { crossover_index: 15.0, mutation_index: 20.0, crossover: 1.0 };

    #[test]
    fn far_from_the_sides_children_lie_about_the_middle_of_their_parents() {
        for member in 0..1000 {
            let (mut a, mut b) = (0.499, 0.501);
            USUAL.cross(&mut Random::of(1, 1, member), &mut a, &mut b);
            // The sides are 500 gaps away: what they take away is 500^-16.
            assert!((a + b - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_mutation_reaches_both_sides_and_leaves_neither() {
        for x in [0.0, 0.2, 1.0] {
            assert!((x + USUAL.step(0.0, x)).abs() < 1e-15);
            assert!((x + USUAL.step(1.0, x) - 1.0).abs() < 1e-15);
            assert!(USUAL.step(0.5, x).abs() < 1e-15);
        }
    }
}
