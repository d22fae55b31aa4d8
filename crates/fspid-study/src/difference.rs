//! A loop that was watched, less its model: how far apart they are where both are known.

/// Values at ascending times; what is not finite is not known.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Ascending (s).
    pub time_s: &'a [f64],
    /// One for each time; a list that is shorter ends there.
    pub values: &'a [f64],
}

impl Curve<'_> {
    /// The value on the straight line between both samples around a time; NaN outside of the curve.
    #[must_use]
    pub fn at(&self, time_s: f64) -> f64 {
        let count = self.time_s.len().min(self.values.len());
        let (times, values) = (&self.time_s[..count], &self.values[..count]);
        let (Some(first), Some(last)) = (times.first(), times.last()) else { return f64::NAN };
        if !(*first..=*last).contains(&time_s) {
            return f64::NAN;
        }
        let low = times.partition_point(|time| *time <= time_s) - 1;
        let Some(next) = times.get(low + 1) else { return values[low] };
        let part = (time_s - times[low]) / (next - times[low]);
        values[low] + part * (values[low + 1] - values[low])
    }
}

/// How far apart two curves are, in their own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The largest one, with its sign; the last of several.
    pub largest: f64,
    /// When that is (s).
    pub at_s: f64,
    /// Root of the mean of the squares.
    pub rms: f64,
    /// How many differences are known.
    pub count: usize,
}

impl Difference {
    /// Of differences at some times; `None` where none is finite.
    #[must_use]
    pub fn of(time_s: &[f64], differences: &[f64]) -> Option<Self> {
        let known = || time_s.iter().zip(differences).filter(|(_, value)| value.is_finite());
        let count = known().count();
        let (at_s, largest) = known().fold((f64::NAN, 0.0_f64), |most, (time, value)| {
            if value.abs() >= most.1.abs() { (*time, *value) } else { most }
        });
        let squares: f64 = known().map(|(_, value)| value * value).sum();
        let rms = (squares / count as f64).sqrt();
        (count > 0).then_some(Self { largest, at_s, rms, count })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_samples_a_curve_is_straight_and_outside_it_is_not_known() {
        let curve = Curve { time_s: &[0.0, 1.0, 3.0], values: &[2.0, 4.0, 0.0] };
        assert_eq!([0.0, 0.5, 1.0, 2.5, 3.0].map(|at| curve.at(at)), [2.0, 3.0, 4.0, 1.0, 0.0]);
        assert!(curve.at(-0.1).is_nan() && curve.at(3.1).is_nan() && curve.at(f64::NAN).is_nan());
        assert!(Curve { time_s: &[], values: &[] }.at(0.0).is_nan());
        // A flight that ended early has fewer values.
        assert!(Curve { values: &[2.0, 4.0], ..curve }.at(1.5).is_nan());
    }

    #[test]
    fn rms_and_largest_are_of_what_is_known_alone() {
        let found = Difference::of(&[0.0, 1.0, 2.0, 3.0], &[3.0, f64::NAN, -4.0, 0.0]).unwrap();
        assert_eq!((found.largest, found.at_s, found.count), (-4.0, 2.0, 3));
        assert_eq!(found.rms, (25.0_f64 / 3.0).sqrt());
        assert_eq!(Difference::of(&[0.0], &[f64::NAN]), None);
        assert_eq!(Difference::of(&[0.0], &[0.0]).map(|none| none.rms), Some(0.0));
    }
}
