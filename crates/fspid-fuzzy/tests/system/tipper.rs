//! The two tippers that toolboxes show, against the numbers that they print.

use fspid_fuzzy::membership::ShapeKind::{Gaussian, Trapezoid};
use fspid_fuzzy::system::{Antecedent, Defuzzifier, Parts, Sampling};

use crate::system::build::{
    answers, block, input, is, output, parts, rule, sets, shape, system, then, triangle,
};

/// MATLAB's `tipper.fis`: service and food in, tip out.
pub(crate) fn matlab(sampling: Sampling) -> Parts {
    let gaussian = |centre| shape(Gaussian, &[centre, 1.5]);
    let service = input(0.0, 10.0, [0.0, 5.0, 10.0].map(gaussian).into());
    let trapezoid = |corners: &[f64]| shape(Trapezoid, corners);
    let [rancid, delicious] = [[0.0, 0.0, 1.0, 3.0], [7.0, 9.0, 10.0, 10.0]];
    let food = input(0.0, 10.0, vec![trapezoid(&rancid), trapezoid(&delicious)]);
    let tips = [[0.0, 5.0, 10.0], [10.0, 15.0, 20.0], [20.0, 25.0, 30.0]];
    let mut tip = output(0.0, 30.0, sets(tips.map(|[a, b, c]| triangle(a, b, c)).into()));
    tip.defuzzifier = Defuzzifier::Centroid(sampling);
    let rules = vec![
        rule(Antecedent::Any(vec![is(0, 0), is(1, 0)]), then(0, 0)),
        rule(is(0, 1), then(0, 1)),
        rule(Antecedent::Any(vec![is(0, 2), is(1, 1)]), then(0, 2)),
    ];
    parts(vec![service, food], vec![tip], vec![block(rules)])
}

/// The tutorial of scikit-fuzzy: quality and service in, tip out.
fn tutorial(sampling: Sampling) -> Parts {
    let words = || {
        input(
            0.0,
            10.0,
            vec![triangle(0.0, 0.0, 5.0), triangle(0.0, 5.0, 10.0), triangle(5.0, 10.0, 10.0)],
        )
    };
    let tips = [[0.0, 0.0, 13.0], [0.0, 13.0, 25.0], [13.0, 25.0, 25.0]];
    let mut tip = output(0.0, 25.0, sets(tips.map(|[a, b, c]| triangle(a, b, c)).into()));
    tip.defuzzifier = Defuzzifier::Centroid(sampling);
    let rules = vec![
        rule(Antecedent::Any(vec![is(0, 0), is(1, 0)]), then(0, 0)),
        rule(is(1, 1), then(0, 1)),
        rule(Antecedent::Any(vec![is(1, 2), is(0, 2)]), then(0, 2)),
    ];
    parts(vec![words(), words()], vec![tip], vec![block(rules)])
}

fn tip(parts: Parts, inputs: [f64; 2]) -> f64 {
    answers(&system(parts), &inputs)[0].value.expect("rules fire")
}

#[test]
fn matlab_s_tipper_answers_as_its_documentation_prints_and_as_it_truly_is() {
    let printed = [
        ([2.0, 1.0], 7.0169, 7.0151),
        ([4.0, 5.0], 14.4585, 14.4530),
        ([7.0, 8.0], 20.3414, 20.3445),
    ];
    for (inputs, sampled, exact) in printed {
        let found = tip(matlab(Sampling::Endpoints(101)), inputs);
        assert!((found - sampled).abs() < 0.5e-4, "{inputs:?}: {found}");
        let found = tip(matlab(Sampling::Exact), inputs);
        assert!((found - exact).abs() < 0.5e-4, "{inputs:?}: {found}");
    }
}

#[test]
fn scikit_fuzzy_s_tutorial_answers_as_it_prints_as_it_truly_is_and_as_matlab_would() {
    let inputs = [6.5, 9.8];
    let known = [
        (Sampling::Vertices(26), 19.847_607_361_963_192, 1e-12),
        (Sampling::Exact, 19.857_759, 0.5e-6),
        (Sampling::Endpoints(101), 19.9525, 0.5e-4),
    ];
    for (sampling, expected, tolerance) in known {
        let found = tip(tutorial(sampling), inputs);
        assert!((found - expected).abs() < tolerance, "{sampling}: {found}");
    }
}
