//! Membership functions.

use fspid_fuzzy::membership::ShapeKind;

/// How a tool's parameters become ours.
#[derive(Clone, Copy, Debug)]
enum Order {
    /// They are the same.
    Same,
    /// The tool's parameter number i is ours with this position.
    Permuted(&'static [usize]),
    /// Half of our second parameter, then our first.
    HalfWidthFirst,
    /// The second parameter is `inf` for our 1 and `-inf` for our -1.
    Direction,
}

/// A membership function in a tool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToolShape {
    pub(crate) kind: ShapeKind,
    pub(crate) word: &'static str,
    order: Order,
}

const fn row(kind: ShapeKind, word: &'static str, order: Order) -> ToolShape {
    ToolShape { kind, word, order }
}

/// Classes of fuzzylite.
///
/// # Source
/// Documentation of fuzzylite's terms: parameters in the order of their description.
pub(crate) const FUZZYLITE: &[ToolShape] = &[
    row(ShapeKind::Arc, "Arc", Order::Same),
    row(ShapeKind::Bell, "Bell", Order::Same),
    row(ShapeKind::Step, "Binary", Order::Direction),
    row(ShapeKind::Concave, "Concave", Order::Same),
    row(ShapeKind::Cosine, "Cosine", Order::Same),
    row(ShapeKind::Points, "Discrete", Order::Same),
    row(ShapeKind::Gaussian, "Gaussian", Order::Same),
    row(ShapeKind::GaussianProduct, "GaussianProduct", Order::Same),
    row(ShapeKind::Pi, "PiShape", Order::Same),
    row(ShapeKind::Ramp, "Ramp", Order::Same),
    row(ShapeKind::Rectangle, "Rectangle", Order::Same),
    row(ShapeKind::SemiEllipse, "SemiEllipse", Order::Same),
    row(ShapeKind::Sigmoid, "Sigmoid", Order::Same),
    // Left, rising, falling, right.
    row(ShapeKind::SigmoidDifference, "SigmoidDifference", Order::Permuted(&[0, 1, 3, 2])),
    row(ShapeKind::SigmoidProduct, "SigmoidProduct", Order::Permuted(&[0, 1, 3, 2])),
    row(ShapeKind::Spike, "Spike", Order::Same),
    row(ShapeKind::SmoothS, "SShape", Order::Same),
    row(ShapeKind::Trapezoid, "Trapezoid", Order::Same),
    row(ShapeKind::Triangle, "Triangle", Order::Same),
    row(ShapeKind::SmoothZ, "ZShape", Order::Same),
];

/// Words of jFuzzyLogic.
///
/// # Source
/// Documentation of jFuzzyLogic; the cosine asked of jFuzzyLogic 3.3 itself: `COSINE 3 4` is 1 at 4, 0.5 at 5.5, 0 at 7.
pub(crate) const JFUZZYLOGIC: &[ToolShape] = &[
    row(ShapeKind::Triangle, "TRIAN", Order::Same),
    row(ShapeKind::Trapezoid, "TRAPE", Order::Same),
    row(ShapeKind::Gaussian, "GAUSS", Order::Same),
    row(ShapeKind::GaussianProduct, "GAUSS2", Order::Same),
    // Width, slope, centre.
    row(ShapeKind::Bell, "GBELL", Order::Permuted(&[1, 2, 0])),
    // Slope before centre, as in MATLAB.
    row(ShapeKind::Sigmoid, "SIGM", Order::Permuted(&[1, 0])),
    row(ShapeKind::SigmoidDifference, "DSIGM", Order::Permuted(&[1, 0, 3, 2])),
    row(ShapeKind::Cosine, "COSINE", Order::HalfWidthFirst),
];

/// A list of points, in every dialect of FCL.
pub(crate) const POINTS: ToolShape = row(ShapeKind::Points, "points", Order::Same);

/// The row of a word, in any case.
pub(crate) fn of_word(rows: &'static [ToolShape], word: &str) -> Option<&'static ToolShape> {
    rows.iter().find(|row| row.word.eq_ignore_ascii_case(word))
}

/// The row of a shape.
pub(crate) fn of_kind(rows: &'static [ToolShape], kind: ShapeKind) -> Option<&'static ToolShape> {
    rows.iter().find(|row| row.kind == kind)
}

impl ToolShape {
    /// Our parameters from the tool's. Too few or too many stay so, for the check to find.
    pub(crate) fn ours(&self, theirs: Vec<f64>) -> Vec<f64> {
        match self.order {
            Order::Permuted(places) if places.len() == theirs.len() => {
                let mut ours = theirs.clone();
                for (&place, their) in places.iter().zip(theirs) {
                    ours.get_mut(place).into_iter().for_each(|our| *our = their);
                }
                ours
            }
            Order::HalfWidthFirst => match theirs[..] {
                [half, centre] => vec![centre, 2.0 * half],
                _ => theirs,
            },
            Order::Direction => second(theirs, direction),
            Order::Same | Order::Permuted(_) => theirs,
        }
    }

    /// The tool's parameters from ours.
    pub(crate) fn theirs(&self, ours: &[f64]) -> Vec<f64> {
        match self.order {
            Order::Same => ours.to_vec(),
            Order::Permuted(places) => {
                places.iter().filter_map(|&place| ours.get(place).copied()).collect()
            }
            Order::HalfWidthFirst => match *ours {
                [centre, width] => vec![0.5 * width, centre],
                _ => ours.to_vec(),
            },
            Order::Direction => second(ours.to_vec(), |sign| sign * f64::INFINITY),
        }
    }
}

fn second(mut params: Vec<f64>, change: impl Fn(f64) -> f64) -> Vec<f64> {
    params.get_mut(1).into_iter().for_each(|param| *param = change(*param));
    params
}

/// Anything but an infinity stays, for the check to find.
fn direction(found: f64) -> f64 {
    if found.is_infinite() { found.signum() } else { found }
}

/// True if the first of the two steps of a sigmoid difference is nowhere below the second: jFuzzyLogic cuts its `DSIGM`
/// at 0, where ours has the magnitude.
pub(crate) fn needs_no_cut(kind: ShapeKind, params: &[f64]) -> bool {
    match *params {
        [left, left_slope, right, right_slope] if kind == ShapeKind::SigmoidDifference => {
            let alike = left_slope.total_cmp(&right_slope).is_eq();
            alike && if left_slope > 0.0 { left <= right } else { left >= right }
        }
        _ => true,
    }
}

/// The same membership function by another name that fuzzylite has, if it has none for `kind` itself.
pub(crate) fn alias(kind: ShapeKind, params: &[f64]) -> Option<(ShapeKind, Vec<f64>)> {
    match (kind, params) {
        (ShapeKind::LinearS, &[foot, shoulder]) if foot < shoulder => {
            Some((ShapeKind::Ramp, vec![foot, shoulder]))
        }
        (ShapeKind::LinearS, &[_, shoulder]) => Some((ShapeKind::Step, vec![shoulder, 1.0])),
        (ShapeKind::LinearZ, &[shoulder, foot]) if shoulder < foot => {
            Some((ShapeKind::Ramp, vec![foot, shoulder]))
        }
        (ShapeKind::Singleton, &[value]) => Some((ShapeKind::Rectangle, vec![value, value])),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_of_every_shape_come_back_from_each_tool() {
        for row in FUZZYLITE.iter().chain(JFUZZYLOGIC) {
            let ours = row.kind.example();
            assert_eq!(row.ours(row.theirs(ours)), ours, "{}", row.word);
        }
    }

    #[test]
    fn the_order_of_parameters_is_the_tool_s() {
        let theirs = |rows, word| {
            let row = of_word(rows, word).unwrap();
            let ours: Vec<f64> = (1..=row.kind.params().len()).map(|n| n as f64).collect();
            row.theirs(&ours)
        };
        assert_eq!(theirs(FUZZYLITE, "gaussian"), [1.0, 2.0], "mean, deviation");
        assert_eq!(theirs(FUZZYLITE, "bell"), [1.0, 2.0, 3.0], "centre, width, slope");
        assert_eq!(theirs(FUZZYLITE, "SigmoidProduct"), [1.0, 2.0, 4.0, 3.0]);
        assert_eq!(theirs(FUZZYLITE, "binary"), [1.0, f64::INFINITY]);
        assert_eq!(theirs(JFUZZYLOGIC, "gbell"), [2.0, 3.0, 1.0], "width, slope, centre");
        assert_eq!(theirs(JFUZZYLOGIC, "sigm"), [2.0, 1.0], "slope, centre");
        assert_eq!(theirs(JFUZZYLOGIC, "cosine"), [1.0, 1.0], "half the width, centre");
        let cosine = of_word(JFUZZYLOGIC, "COSINE").unwrap();
        assert_eq!(cosine.ours(vec![3.0, 4.0]), [4.0, 6.0], "centre, width");
    }

    #[test]
    fn every_shape_has_a_fuzzylite_class_or_another_name_for_the_same() {
        for &kind in ShapeKind::ALL {
            let named = of_kind(FUZZYLITE, kind).is_some();
            assert!(named || alias(kind, kind.example()).is_some(), "{}", kind.name());
        }
    }

    #[test]
    fn another_name_is_the_same_function() {
        for kind in [ShapeKind::LinearS, ShapeKind::LinearZ, ShapeKind::Singleton] {
            let (other, params) = alias(kind, kind.example()).unwrap();
            assert_eq!(other.check(&params), Ok(()));
            for x in (-30..=30).map(|n| f64::from(n) / 10.0) {
                assert_eq!(kind.grade(kind.example(), x), other.grade(&params, x), "{x}");
            }
        }
    }
}
