//! Which flights are alike, as far as their pitch, elevator and gains can tell.
//!
//! Not by their bits: a plant whose numbers differ in their ninth digit flies with other bits, and is no other plant.

/// Pitch, elevator and the three gains.
const COLUMNS: usize = 5;
/// Differences that make another flight, as a share of the largest number of their column. Rounding and numbers that are written
/// with nine digits stay far below; aircraft, loadings and servos that anybody tells apart are far above.
const OTHER: f64 = 1e-6;
/// Most samples that a sketch keeps.
const KEPT: usize = 64;

/// What a flight shows at each sample.
#[derive(Clone, Debug, Default)]
pub(super) struct Trace {
    samples: Vec<[f64; COLUMNS]>,
}

/// A few samples of a trace, from which most flights are told apart without the others.
#[derive(Clone, Debug, Default)]
pub(super) struct Sketch {
    samples: Vec<[f64; COLUMNS]>,
    /// Samples of the whole trace.
    count: usize,
    /// The largest number of each column of the whole trace.
    sizes: [f64; COLUMNS],
}

impl Trace {
    pub(super) fn push(&mut self, sample: [f64; COLUMNS]) {
        self.samples.push(sample);
    }

    pub(super) fn sketch(&self) -> Sketch {
        let count = self.samples.len();
        let apart = count.div_ceil(KEPT).max(1);
        // The last ones, where what has grown is largest.
        let kept = self.samples.iter().rev().step_by(apart).copied();
        Sketch { samples: kept.collect(), count, sizes: sizes(&self.samples) }
    }

    /// Whether the flights are alike at every sample.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let sizes = larger(sizes(&self.samples), sizes(&other.samples));
        are_alike(&self.samples, &other.samples, sizes)
    }
}

impl Sketch {
    /// Whether the flights may be alike; true for all that are.
    pub(super) fn may_be_like(&self, other: &Self) -> bool {
        self.count == other.count
            && are_alike(&self.samples, &other.samples, larger(self.sizes, other.sizes))
    }
}

fn sizes(samples: &[[f64; COLUMNS]]) -> [f64; COLUMNS] {
    let most = |sizes, sample: &[f64; COLUMNS]| larger(sizes, sample.map(f64::abs));
    samples.iter().fold([0.0; COLUMNS], most)
}

fn larger(one: [f64; COLUMNS], other: [f64; COLUMNS]) -> [f64; COLUMNS] {
    let mut most = one;
    most.iter_mut().zip(other).for_each(|(most, other)| *most = most.max(other));
    most
}

fn are_alike(some: &[[f64; COLUMNS]], others: &[[f64; COLUMNS]], sizes: [f64; COLUMNS]) -> bool {
    let is_near = |(one, other): (&[f64; COLUMNS], &[f64; COLUMNS])| {
        let both = one.iter().zip(other).zip(sizes);
        // Written so that NaN is another flight.
        both.into_iter().all(|((one, other), size)| (one - other).abs() <= OTHER * size)
    };
    some.len() == others.len() && some.iter().zip(others).all(is_near)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(of: impl Fn(f64) -> [f64; COLUMNS]) -> Trace {
        Trace { samples: (0..1000).map(|sample| of(f64::from(sample))).collect() }
    }

    #[test]
    fn flights_are_alike_to_a_millionth_of_their_size_at_every_sample() {
        let of = |scale: f64| trace(move |at| [scale * libm::sin(at), 1e-9 * at, 3.0, 0.0, at]);
        for (scale, is_alike) in [(1.0, true), (1.0 + 5e-7, true), (1.0 + 3e-6, false)] {
            assert_eq!(of(1.0).is_like(&of(scale)), is_alike, "{scale}");
            assert_eq!(of(1.0).sketch().may_be_like(&of(scale).sketch()), is_alike, "{scale}");
        }
        // One sample is enough, also one that no sketch keeps.
        let mut other = of(1.0);
        other.samples[500][2] += 1e-3;
        assert!(!of(1.0).is_like(&other));
        other.samples[500][2] = f64::NAN;
        assert!(!of(1.0).is_like(&other));
        other.samples.pop();
        assert!(!of(1.0).sketch().may_be_like(&other.sketch()));
        // Nothing is small beside nothing.
        let still = trace(|_| [0.0; COLUMNS]);
        assert!(still.is_like(&still) && !still.is_like(&trace(|_| [1e-300; COLUMNS])));
    }
}
