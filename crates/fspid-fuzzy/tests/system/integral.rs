//! Outputs whose sets are curved, or joined by norms that bend them: certified integrals.

use fspid_fuzzy::Formula;
use fspid_fuzzy::membership::ShapeKind::{self, Gaussian};
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{Defuzzifier, Membership, Parts, SNorm, Sampling, Source};
use fspid_numeric::Scalar;

use crate::system::build::{answers, graded, output, sets, shape, system, triangle, value};

const EXACT: Sampling = Sampling::Exact;

fn bells() -> Vec<Membership> {
    [[-2.0, 0.8], [0.5, 0.6], [2.5, 1.1]].map(|params| shape(Gaussian, &params)).into()
}

fn asked(terms: Vec<Membership>, method: Defuzzifier) -> Parts {
    let mut parts = graded(output(-5.0, 5.0, sets(terms)));
    parts.outputs[0].defuzzifier = method;
    parts
}

#[test]
fn a_lone_bell_in_the_middle_answers_its_centre_with_a_narrow_bound() {
    for method in [Defuzzifier::Centroid(EXACT), Defuzzifier::Bisector(EXACT)] {
        for strength in [1.0, 0.4, 1e-9, 1e-300] {
            let parts = asked(vec![shape(Gaussian, &[0.0, 0.7])], method);
            let answer = answers(&system(parts), &[strength])[0];
            let found = answer.value.expect("an area");
            assert!(found.abs() <= answer.error_bound, "{method:?} {strength} {answer:?}");
            assert!(answer.error_bound < 1e-11 && answer.source == Source::Rules, "{answer:?}");
        }
    }
}

#[test]
fn a_cut_bell_is_highest_between_the_places_of_its_cut() {
    // 0.5 = exp(-z²/2).
    let reach = 0.7 * (2.0 * std::f64::consts::LN_2).sqrt();
    let known = [
        (Defuzzifier::SmallestOfMaximum(EXACT), 1.0 - reach),
        (Defuzzifier::MeanOfMaximum(EXACT), 1.0),
        (Defuzzifier::LargestOfMaximum(EXACT), 1.0 + reach),
    ];
    for (method, expected) in known {
        let parts = asked(vec![shape(Gaussian, &[1.0, 0.7])], method);
        let answer = answers(&system(parts), &[0.5])[0];
        let error = (answer.value.expect("an area") - expected).abs();
        assert!(error <= answer.error_bound + 1e-13 && error < 1e-12, "{method:?} {answer:?}");
    }
}

#[test]
fn a_full_bell_is_highest_at_its_centre() {
    for method in
        [Defuzzifier::SmallestOfMaximum, Defuzzifier::MeanOfMaximum, Defuzzifier::LargestOfMaximum]
    {
        let parts = asked(vec![shape(Gaussian, &[1.234, 0.7])], method(EXACT));
        let answer = answers(&system(parts), &[1.0])[0];
        let error = (answer.value.expect("an area") - 1.234).abs();
        assert!(error <= answer.error_bound + 1e-15 && error < 1e-7, "{answer:?}");
    }
}

#[test]
fn every_norm_and_shape_agrees_with_many_midpoints() {
    let strengths = [0.83, 0.47, 0.21];
    for kind in ShapeKind::ALL {
        if kind.example().len() > 8 || *kind == ShapeKind::Singleton {
            continue;
        }
        let terms = || {
            vec![
                shape(*kind, kind.example()),
                shape(Gaussian, &[-1.0, 0.6]),
                triangle(-3.0, 1.0, 2.0),
            ]
        };
        for method in [Defuzzifier::Centroid, Defuzzifier::Bisector] {
            let exact = answers(&system(asked(terms(), method(EXACT))), &strengths)[0];
            let many = value(asked(terms(), method(Sampling::Midpoint(20_000))), &strengths);
            let error = exact.value.expect("an area") - many;
            // A jump costs the midpoints half a cell.
            assert!(error.abs() < 1e-3 && exact.error_bound < 1e-9, "{kind:?} {exact:?} {many}");
        }
    }
    for implication in TNormKind::ALL {
        for aggregation in SNormKind::ALL {
            let with = |sampling| {
                let mut parts = asked(bells(), Defuzzifier::Centroid(sampling));
                parts.blocks[0].implication = (*implication).into();
                parts.outputs[0].aggregation = (*aggregation).into();
                answers(&system(parts), &strengths)[0]
            };
            let (exact, many) = (with(EXACT), with(Sampling::Midpoint(20_000)));
            // A drastic product leaves nothing with an area.
            assert_eq!(exact.value.is_some(), many.value.is_some(), "{exact:?} {many:?}");
            let error = (exact.value.zip(many.value)).map_or(0.0, |(a, b)| (a - b).abs());
            assert!(error < 1e-3, "{implication:?} {aggregation:?}: {exact:?} {many:?}");
            assert!(exact.error_bound < 1e-12, "{implication:?} {aggregation:?}: {exact:?}");
        }
    }
}

#[test]
fn straight_sets_joined_by_quadrature_agree_with_their_polygon() {
    // The same sets as points, of which one has a curved neighbour that concludes nothing.
    let straight = || vec![triangle(-4.0, -1.0, 0.0), triangle(-2.0, 0.0, 3.0)];
    let curved = || [straight(), vec![shape(Gaussian, &[0.0, 1.0])]].concat();
    for (implication, aggregation) in [
        (TNormKind::Minimum, SNormKind::Maximum),
        (TNormKind::AlgebraicProduct, SNormKind::Maximum),
        (TNormKind::Minimum, SNormKind::UnboundedSum),
        (TNormKind::Minimum, SNormKind::BoundedSum),
        (TNormKind::AlgebraicProduct, SNormKind::NormalizedSum),
    ] {
        for method in [
            Defuzzifier::Centroid,
            Defuzzifier::Bisector,
            Defuzzifier::SmallestOfMaximum,
            Defuzzifier::MeanOfMaximum,
            Defuzzifier::LargestOfMaximum,
        ] {
            for strengths in [[0.9, 0.8, 0.0], [0.3, 0.7, 0.0], [1.0, 1.0, 0.0], [0.6, 0.6, 0.0]] {
                let with = |terms: Vec<Membership>, inputs: &[f64]| {
                    let mut parts = asked(terms, method(EXACT));
                    parts.blocks[0].implication = implication.into();
                    parts.outputs[0].aggregation = aggregation.into();
                    answers(&system(parts), inputs)[0]
                };
                let (polygon, integral) =
                    (with(straight(), &strengths[..2]), with(curved(), &strengths));
                let error =
                    (polygon.value.expect("an area") - integral.value.expect("an area")).abs();
                assert!(
                    error <= integral.error_bound + 1e-13 && error < 1e-7,
                    "{implication:?} {aggregation:?} {:?} {strengths:?}: {polygon:?} {integral:?}",
                    method(EXACT)
                );
            }
        }
    }
}

#[test]
fn sets_and_norms_written_as_formulas_are_integrated_too() {
    let bump = Formula::parse("exp(-(x - a) * (x - a))", &["x", "a"]).expect("a formula");
    let mut parts = asked(
        vec![Membership::Formula { formula: bump, height: 0.5 }],
        Defuzzifier::Centroid(EXACT),
    );
    let both = Formula::parse("a + b - a * b", &["a", "b"]).expect("a formula");
    parts.outputs[0].aggregation = SNorm::Formula(both);
    let answer = answers(&system(parts), &[0.7])[0];
    let found = answer.value.expect("an area");
    // Symmetric about the input, but for the universe's ends, where it is below e^(-18).
    assert!((found - 0.7).abs() < 1e-7 && answer.error_bound < 1e-10, "{answer:?}");
    assert!(Scalar::exp(-18.0_f64) < 1e-7);
}

/// "1.55, the rules gave no number; the output's default" of a plain set: its enclosure of minus infinity was not known to be one.
#[test]
fn a_shoulder_that_begins_at_infinity_is_integrated() {
    let shoulder = [f64::NEG_INFINITY, 0.2, 0.2, 0.8];
    let ends = shape(ShapeKind::Trapezoid, &shoulder);
    let mirrored = shape(ShapeKind::Trapezoid, &[-0.8, -0.2, -0.2, f64::INFINITY]);
    for (set, range, sign) in [(ends, [0.0, 2.0], 1.0), (mirrored, [-2.0, 0.0], -1.0)] {
        let mut parts =
            graded(output(range[0], range[1], sets(vec![set, shape(Gaussian, &[sign, 0.3])])));
        parts.outputs[0].defuzzifier = Defuzzifier::Centroid(EXACT);
        let answer = answers(&system(parts), &[1.0, 0.0])[0];
        // A rectangle of 0.2 and a triangle of 0.6: areas 0.2 and 0.3, at 0.1 and 0.4.
        let error = (answer.value.expect("an area") - sign * 0.28).abs();
        assert!(error < 1e-12 && answer.error_bound < 1e-12, "{answer:?}");
        assert_eq!(answer.source, Source::Rules);
    }
}
