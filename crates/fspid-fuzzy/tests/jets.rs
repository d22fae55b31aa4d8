//! Taylor polynomials against series from the textbook.

use fspid_fuzzy::membership::ShapeKind;
use fspid_numeric::scalar::{Dual, Interval, Jet, Scalar};

/// Number of coefficients in these tests.
const COUNT: usize = 9;

type Polynomial = Jet<Interval, COUNT>;

/// `COUNT` coefficients as quotients of whole numbers.
type Series = [(f64, f64); COUNT];

/// A function by its name, with its series at a point.
type Known = (&'static str, f64, fn(Polynomial) -> Polynomial, Series);

/// Functions with their series at 0 or 1.
const KNOWN: [Known; 14] = [
    (
        "exp",
        0.0,
        Scalar::exp,
        [
            (1., 1.),
            (1., 1.),
            (1., 2.),
            (1., 6.),
            (1., 24.),
            (1., 120.),
            (1., 720.),
            (1., 5040.),
            (1., 40320.),
        ],
    ),
    (
        "ln",
        1.0,
        Scalar::ln,
        [
            (0., 1.),
            (1., 1.),
            (-1., 2.),
            (1., 3.),
            (-1., 4.),
            (1., 5.),
            (-1., 6.),
            (1., 7.),
            (-1., 8.),
        ],
    ),
    (
        "sqrt",
        1.0,
        Scalar::sqrt,
        [
            (1., 1.),
            (1., 2.),
            (-1., 8.),
            (1., 16.),
            (-5., 128.),
            (7., 256.),
            (-21., 1024.),
            (33., 2048.),
            (-429., 32768.),
        ],
    ),
    (
        "sin",
        0.0,
        Scalar::sin,
        [
            (0., 1.),
            (1., 1.),
            (0., 1.),
            (-1., 6.),
            (0., 1.),
            (1., 120.),
            (0., 1.),
            (-1., 5040.),
            (0., 1.),
        ],
    ),
    (
        "cos",
        0.0,
        Scalar::cos,
        [
            (1., 1.),
            (0., 1.),
            (-1., 2.),
            (0., 1.),
            (1., 24.),
            (0., 1.),
            (-1., 720.),
            (0., 1.),
            (1., 40320.),
        ],
    ),
    (
        "tan",
        0.0,
        Scalar::tan,
        [
            (0., 1.),
            (1., 1.),
            (0., 1.),
            (1., 3.),
            (0., 1.),
            (2., 15.),
            (0., 1.),
            (17., 315.),
            (0., 1.),
        ],
    ),
    (
        "asin",
        0.0,
        Scalar::asin,
        [
            (0., 1.),
            (1., 1.),
            (0., 1.),
            (1., 6.),
            (0., 1.),
            (3., 40.),
            (0., 1.),
            (15., 336.),
            (0., 1.),
        ],
    ),
    (
        "atan",
        0.0,
        Scalar::atan,
        [
            (0., 1.),
            (1., 1.),
            (0., 1.),
            (-1., 3.),
            (0., 1.),
            (1., 5.),
            (0., 1.),
            (-1., 7.),
            (0., 1.),
        ],
    ),
    (
        "sinh",
        0.0,
        Scalar::sinh,
        [
            (0., 1.),
            (1., 1.),
            (0., 1.),
            (1., 6.),
            (0., 1.),
            (1., 120.),
            (0., 1.),
            (1., 5040.),
            (0., 1.),
        ],
    ),
    (
        "cosh",
        0.0,
        Scalar::cosh,
        [
            (1., 1.),
            (0., 1.),
            (1., 2.),
            (0., 1.),
            (1., 24.),
            (0., 1.),
            (1., 720.),
            (0., 1.),
            (1., 40320.),
        ],
    ),
    (
        "tanh",
        0.0,
        Scalar::tanh,
        [
            (0., 1.),
            (1., 1.),
            (0., 1.),
            (-1., 3.),
            (0., 1.),
            (2., 15.),
            (0., 1.),
            (-17., 315.),
            (0., 1.),
        ],
    ),
    (
        "1/x",
        1.0,
        |x| Polynomial::one() / x,
        [
            (1., 1.),
            (-1., 1.),
            (1., 1.),
            (-1., 1.),
            (1., 1.),
            (-1., 1.),
            (1., 1.),
            (-1., 1.),
            (1., 1.),
        ],
    ),
    (
        "x^6",
        1.0,
        |x| x.pow(Polynomial::constant(6.0)),
        [
            (1., 1.),
            (6., 1.),
            (15., 1.),
            (20., 1.),
            (15., 1.),
            (6., 1.),
            (1., 1.),
            (0., 1.),
            (0., 1.),
        ],
    ),
    (
        "x^-1.5",
        1.0,
        |x| x.pow(Polynomial::constant(-1.5)),
        [
            (1., 1.),
            (-3., 2.),
            (15., 8.),
            (-35., 16.),
            (315., 128.),
            (-693., 256.),
            (3003., 1024.),
            (-6435., 2048.),
            (109_395., 32768.),
        ],
    ),
];

#[test]
fn every_function_has_its_textbook_series() {
    for (name, at, function, series) in KNOWN {
        let ours = function(Jet::variable(Interval::point(at)));
        for (k, (coefficient, (above, below))) in ours.coefficients().iter().zip(series).enumerate()
        {
            let exact = Interval::point(above) / Interval::point(below);
            let overlap = coefficient.intersection(exact).is_some();
            assert!(
                overlap && coefficient.width() < 1e-13,
                "{name} {k}: {coefficient:?} {exact:?}"
            );
        }
    }
}

#[test]
fn series_over_an_interval_hold_those_of_its_points() {
    for (name, at, function, _) in KNOWN {
        let wide = function(Jet::variable(Interval::between(at, at + 0.25)));
        for share in [0.0, 0.02, 0.1, 0.25] {
            let thin = function(Jet::variable(Interval::point(at + share)));
            for (outer, inner) in wide.coefficients().iter().zip(thin.coefficients()) {
                assert!(outer.encloses(*inner), "{name} {share}: {outer:?} {inner:?}");
            }
        }
    }
}

#[test]
fn the_arcs_of_sine_and_cosine_make_a_quarter_turn_at_every_order() {
    let x = Jet::<f64, 7>::variable(0.3);
    let [sum, quarter] =
        [(x.asin() + x.acos()).coefficients().to_vec(), [core::f64::consts::FRAC_PI_2].to_vec()];
    assert!((sum[0] - quarter[0]).abs() < 1e-15 && sum[1..].iter().all(|c| c.abs() < 1e-14));
    let one = (x.cosh().square() - x.sinh().square()).coefficients().to_vec();
    assert!((one[0] - 1.0).abs() < 1e-15 && one[1..].iter().all(|c| c.abs() < 1e-14));
    let also = (x.exp().ln() - x).coefficients().to_vec();
    assert!(also.iter().all(|c| c.abs() < 1e-14));
    // An exponent that varies: x^x = e^(x ln x).
    let power = (x.pow(x) - (x * x.ln()).exp()).coefficients().to_vec();
    assert!(power.iter().all(|c| c.abs() < 1e-12));
}

#[test]
fn the_second_coefficient_of_every_shape_is_its_derivative() {
    for kind in ShapeKind::ALL {
        for i in 0..300 {
            let x = -3.0 + 0.020_07 * f64::from(i);
            let params: Vec<_> =
                kind.example().iter().map(|&p| Jet::<f64, 4>::constant(p)).collect();
            let dual: Vec<_> =
                kind.example().iter().map(|&p| Dual::<f64, 1>::constant(p)).collect();
            let jet = kind.grade(&params, Jet::variable(x));
            let slope = kind.grade(&dual, Dual::variable(x, 0)).derivative[0];
            let ours = jet.coefficients()[1];
            assert!(
                (ours - slope).abs() <= 1e-11 * slope.abs().max(1.0),
                "{} {x}: {ours} {slope}",
                kind.name()
            );
        }
    }
}

#[test]
fn a_kink_inside_leaves_nothing_known_of_the_slopes() {
    let x = Polynomial::variable(Interval::between(-1.0, 2.0));
    for kinked in [x.abs(), x.smaller(Jet::zero()), x.floor(), x.if_less(Jet::zero(), x, -x)] {
        for function in
            [kinked, kinked.exp() + x, kinked * kinked, kinked.atan() / Jet::constant(3.0)]
        {
            assert!(
                function.coefficients()[1..].iter().all(|c| *c == Interval::ENTIRE),
                "{function:?}"
            );
            assert!(function.value().is_bounded());
        }
    }
    let beside = Polynomial::variable(Interval::between(0.0, 0.5));
    assert_eq!((beside.abs(), beside.floor()), (beside, Polynomial::zero()));
}
