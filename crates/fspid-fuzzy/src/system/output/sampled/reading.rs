//! Numbers read off samples.
//!
//! | | endpoints:N | midpoint:N, left-end:N | trapezoid:N, vertices:N |
//! | --- | --- | --- | --- |
//! | samples stand for | themselves | a cell of equal height | straight lines between them |
//! | bisector | first sample at which the sum reaches half | point in the cell | point under the line |
//! | smallest, largest | by magnitude | first, last | first, last |
//!
//! The mean of maximum is that of the samples of highest grade.
//!
//! # Source
//! Endpoints: MATLAB's documentation of `defuzz`; in its example *Defuzzification Methods* a set with
//! its plateau from -8 to -2 has -2 for the smallest of maximum and -8 for the largest.

use super::super::super::defuzzifier::{Defuzzifier, Sampling};
use super::super::joined::{Piece, bisector, centroid};
use super::Sampled;

impl Sampled {
    pub(super) fn read(&self, method: Defuzzifier, joined: &[f64]) -> Option<f64> {
        let top = joined.iter().copied().fold(0.0, f64::max);
        if !(top >= f64::MIN_POSITIVE) {
            return None;
        }
        let highest = (0..).zip(joined).filter(|&(_, &grade)| grade >= top);
        let mut highest = highest.map(|(n, _)| self.place(n));
        match method {
            Defuzzifier::Centroid(_) => self.centroid(joined),
            Defuzzifier::Bisector(_) => self.bisector(joined),
            Defuzzifier::MeanOfMaximum(_) => mean(highest),
            Defuzzifier::SmallestOfMaximum(_) if self.by_magnitude() => {
                highest.reduce(|best, x| if x.abs() < best.abs() { x } else { best })
            }
            Defuzzifier::LargestOfMaximum(_) if self.by_magnitude() => {
                highest.reduce(|best, x| if x.abs() > best.abs() { x } else { best })
            }
            Defuzzifier::SmallestOfMaximum(_) => highest.next(),
            Defuzzifier::LargestOfMaximum(_) => highest.last(),
            Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_) => None,
        }
    }

    fn by_magnitude(&self) -> bool {
        matches!(self.sampling, Sampling::Endpoints(_))
    }

    /// $\sum w_n x_n \mu(x_n) / \sum w_n \mu(x_n)$, in which the end samples of the trapezoidal rule
    /// weigh half.
    fn centroid(&self, joined: &[f64]) -> Option<f64> {
        let (mut area, mut moment) = (0.0_f64, 0.0_f64);
        let (middle, halved) = (self.middle(), matches!(self.sampling, Sampling::Trapezoid(_)));
        for (n, &grade) in (0..).zip(joined) {
            let is_end = n == 0 || n + 1 == self.count;
            let grade = if halved && is_end { 0.5 * grade } else { grade };
            area += grade;
            moment += (self.place(n) - middle) * grade;
        }
        (area > 0.0).then(|| middle + moment / area)
    }

    fn bisector(&self, joined: &[f64]) -> Option<f64> {
        match self.sampling {
            Sampling::Endpoints(_) => {
                let half = 0.5 * joined.iter().sum::<f64>();
                let mut below = 0.0_f64;
                let reached = joined.iter().position(|&grade| {
                    below += grade;
                    below >= half
                })?;
                u32::try_from(reached).ok().map(|n| self.place(n))
            }
            Sampling::Trapezoid(_) => {
                let cells =
                    joined.array_windows().enumerate().map(|(n, &grade): (_, &[f64; 2])| {
                        let n = n as u32;
                        Piece::plain([self.place(n), self.place(n + 1)], grade)
                    });
                bisector(cells)
            }
            _ => bisector(joined.iter().enumerate().map(|(n, &grade)| {
                let edge = |n: f64| self.lower + n * (self.upper - self.lower) / self.cells;
                Piece::plain([edge(n as f64), edge(n as f64 + 1.0)], [grade; 2])
            })),
        }
    }

    fn middle(&self) -> f64 {
        0.5 * self.lower + 0.5 * self.upper
    }
}

/// Numbers read off a line with these corners.
pub(super) fn of_corners(method: Defuzzifier, corners: &[[f64; 2]]) -> Option<f64> {
    let top = corners.iter().fold(0.0, |top: f64, corner| top.max(corner[1]));
    if !(top >= f64::MIN_POSITIVE) {
        return None;
    }
    let mut highest = corners.iter().filter(|corner| corner[1] >= top).map(|corner| corner[0]);
    let pieces = corners
        .array_windows()
        .map(|&[from, to]: &[[f64; 2]; 2]| Piece::plain([from[0], to[0]], [from[1], to[1]]));
    match method {
        Defuzzifier::Centroid(_) => {
            let ends = (corners.first()?, corners.last()?);
            centroid(pieces, 0.5 * ends.0[0] + 0.5 * ends.1[0])
        }
        Defuzzifier::Bisector(_) => bisector(pieces),
        Defuzzifier::SmallestOfMaximum(_) => highest.next(),
        Defuzzifier::MeanOfMaximum(_) => mean(highest),
        Defuzzifier::LargestOfMaximum(_) => highest.next_back(),
        Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_) => None,
    }
}

fn mean(places: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0_f64, 0.0_f64);
    for place in places {
        (sum, count) = (sum + place, count + 1.0);
    }
    (count > 0.0).then(|| sum / count)
}
