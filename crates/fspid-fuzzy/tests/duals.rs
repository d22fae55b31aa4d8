//! Derivatives of every membership function against differences of sixth order.

use fspid_fuzzy::membership::ShapeKind;
use fspid_numeric::scalar::{Base, Dual, Interval, Scalar};

/// Sixth-order central difference.
fn difference(function: impl Fn(f64) -> f64, at: f64, step: f64) -> f64 {
    let pair = |k: f64| function(at + k * step) - function(at - k * step);
    (45.0 * pair(1.0) - 9.0 * pair(2.0) + pair(3.0)) / (60.0 * step)
}

/// The derivative of a grade with respect to input `which`: 0 is `x`, the others the parameters.
fn derivative<S: Base>(kind: ShapeKind, inputs: &[S], which: usize) -> Dual<S, 1> {
    let lift = |(index, &value)| {
        if index == which { Dual::variable(value, 0) } else { Dual::fixed(value) }
    };
    let lifted: Vec<_> = inputs.iter().enumerate().map(lift).collect();
    kind.grade(&lifted[1..], lifted[0])
}

/// Inputs of the example of a kind at points spread over its interesting part.
fn points(kind: ShapeKind) -> impl Iterator<Item = Vec<f64>> {
    (0..400).map(move |i| {
        let x = -4.0 + 0.020_07 * f64::from(i);
        [x].into_iter().chain(kind.example().iter().copied()).collect()
    })
}

#[test]
fn derivatives_of_every_shape_match_differences_off_the_kinks() {
    for kind in ShapeKind::ALL {
        let (mut compared, mut kinks) = (0, 0);
        for inputs in points(*kind) {
            for which in 0..inputs.len() {
                let grade = |value| {
                    let mut moved = inputs.clone();
                    moved[which] = value;
                    kind.grade(&moved[1..], moved[0])
                };
                let (coarse, fine) = (
                    difference(grade, inputs[which], 2e-3),
                    difference(grade, inputs[which], 1e-3),
                );
                // Two steps disagree where a kink, also one of a higher derivative, is near; right
                // on a kink they agree, but the slopes to either side do not.
                let at = inputs[which];
                let bend = (grade(at + 1e-6) - 2.0 * grade(at) + grade(at - 1e-6)) / 1e-6;
                let near = !((coarse - fine).abs() <= 1e-9 * fine.abs().max(1.0));
                if near || bend.abs() > 1e-4 {
                    kinks += 1;
                    continue;
                }
                let exact = derivative(*kind, &inputs, which).derivative[0];
                let name = kind.name();
                assert!(
                    (exact - fine).abs() < 1e-8 * fine.abs().max(1.0),
                    "{name} {inputs:?} {which}: {exact} {fine}"
                );
                compared += 1;
            }
        }
        assert!(kinks * 5 < compared, "{}: {kinks} kinks, {compared} compared", kind.name());
    }
}

#[test]
fn the_value_of_a_dual_has_the_bits_of_the_float() {
    for kind in ShapeKind::ALL {
        for inputs in points(*kind) {
            let value = derivative(*kind, &inputs, 0).value;
            assert_eq!(value.to_bits(), kind.grade(&inputs[1..], inputs[0]).to_bits());
        }
    }
}

#[test]
fn derivatives_over_boxes_hold_those_of_their_points() {
    for kind in ShapeKind::ALL {
        for (inputs, width) in points(*kind).zip([0.0, 1e-3, 0.05, 0.7].into_iter().cycle()) {
            let mut boxes: Vec<_> = inputs.iter().map(|&value| Interval::point(value)).collect();
            boxes[0] = Interval::between(inputs[0], inputs[0] + width);
            for which in 0..inputs.len() {
                let enclosure = derivative(*kind, &boxes, which).derivative[0];
                for share in [0.0, 0.1, 0.5, 0.77, 1.0] {
                    let mut point = inputs.clone();
                    point[0] = boxes[0].lower() + share * (boxes[0].upper() - boxes[0].lower());
                    if !boxes[0].contains(point[0]) {
                        continue;
                    }
                    let slope = derivative(*kind, &point, which).derivative[0];
                    let name = kind.name();
                    assert!(
                        enclosure.contains(slope),
                        "{name} {boxes:?} {which}: {enclosure:?} {slope}"
                    );
                }
            }
        }
    }
}

#[test]
fn an_interval_over_a_kink_has_the_slopes_of_both_sides() {
    let over = |lower, upper| Dual::<_, 1>::variable(Interval::between(lower, upper), 0);
    let both = Interval::between(-1.0, 1.0);
    let rising = [Interval::ONE];
    assert_eq!(over(-1.0, 2.0).abs().derivative, [both]);
    assert_eq!(over(0.0, 0.0).abs().derivative, [both]);
    // Only touched: the side inside counts.
    assert_eq!(over(0.0, 2.0).abs().derivative, rising);
    let half = Dual::constant(0.5);
    assert_eq!(over(0.0, 1.0).smaller(half).derivative, [Interval::UNIT]);
    assert_eq!(over(0.0, 0.4).smaller(half).derivative, rising);
    assert_eq!(over(0.6, 1.0).larger(half).derivative, rising);
    assert_eq!(over(0.0, 0.4).if_less(half, over(0.0, 0.4), half).derivative, rising);
}

#[test]
fn an_infinite_slope_does_not_poison_what_does_not_move() {
    let [x, p] = Dual::variables([0.0, 4.0]);
    assert_eq!(x.abs().pow(p).derivative.map(f64::to_bits), [0; 2]);
    assert_eq!((x * x).sqrt().derivative[1].to_bits(), 0);
    let three = Dual::<f64, 1>::variable(-3.0, 0);
    assert!((three.pow(Dual::constant(2.0)).derivative[0] + 6.0).abs() < 1e-12);
}

#[test]
fn the_slope_of_a_power_in_its_exponent_is_bounded_over_boxes() {
    let [x, p] = Dual::variables([Interval::UNIT, Interval::point(4.0)]);
    let slope = x.pow(p).derivative[1];
    assert!(slope.contains(0.0) && slope.contains(-0.0919) && slope.lower() > -0.1, "{slope:?}");
}

/// A function with its derivative in closed form.
type Known = (fn(Dual<f64, 1>) -> Dual<f64, 1>, fn(f64) -> f64);

#[test]
fn every_function_has_its_textbook_derivative() {
    let known: [Known; 13] = [
        (Scalar::exp, libm::exp),
        (Scalar::ln, |x| 1.0 / x),
        (Scalar::sqrt, |x| 0.5 / libm::sqrt(x)),
        (Scalar::sin, libm::cos),
        (Scalar::cos, |x| -libm::sin(x)),
        (Scalar::tan, |x| 1.0 / (libm::cos(x) * libm::cos(x))),
        (Scalar::asin, |x| 1.0 / libm::sqrt(1.0 - x * x)),
        (Scalar::acos, |x| -1.0 / libm::sqrt(1.0 - x * x)),
        (Scalar::atan, |x| 1.0 / (1.0 + x * x)),
        (Scalar::sinh, libm::cosh),
        (Scalar::cosh, libm::sinh),
        (Scalar::tanh, |x| 1.0 - libm::tanh(x) * libm::tanh(x)),
        (Scalar::floor, |_| 0.0),
    ];
    for (index, (function, slope)) in known.into_iter().enumerate() {
        for x in [0.05, 0.3, 0.77, 0.99] {
            let ours = function(Dual::variable(x, 0)).derivative[0];
            assert!((ours - slope(x)).abs() <= 1e-12 * slope(x).abs(), "{index} at {x}: {ours}");
        }
    }
}
