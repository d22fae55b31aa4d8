//! What must stay the same, or change along, when a system is written differently.

use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, Membership, Parts, Sampling, SetReading, Universe,
};

use crate::system::build::{answers, system};
use crate::system::random::Random;

const SAMPLINGS: [Sampling; 6] = [
    Sampling::Exact,
    Sampling::Endpoints(101),
    Sampling::Midpoint(100),
    Sampling::Trapezoid(101),
    Sampling::LeftEnd(100),
    Sampling::Vertices(31),
];

const METHODS: [fn(Sampling) -> Defuzzifier; 5] = [
    Defuzzifier::Centroid,
    Defuzzifier::Bisector,
    Defuzzifier::SmallestOfMaximum,
    Defuzzifier::MeanOfMaximum,
    Defuzzifier::LargestOfMaximum,
];

fn ask(parts: &Parts, inputs: &[f64]) -> Option<f64> {
    answers(&system(parts.clone()), inputs)[0].value
}

/// Every place in a system moved by a function of its own; all shapes here have places only, but for
/// the width of a Gaussian, which is `scaled`.
fn moved(mut parts: Parts, place: impl Fn(f64) -> f64, scaled: impl Fn(f64) -> f64) -> Parts {
    let universe = |u: &mut Option<Universe>| {
        *u = u.map(|u| {
            let (a, b) = (place(u.lower), place(u.upper));
            Universe { lower: a.min(b), upper: a.max(b) }
        });
    };
    let membership = |membership: &mut Membership| {
        let Membership::Shape { params, .. } = membership else { return };
        if let [centre, sigma] = params.as_mut_slice() {
            (*centre, *sigma) = (place(*centre), scaled(*sigma));
        } else {
            params.iter_mut().for_each(|x| *x = place(*x));
            params.sort_by(f64::total_cmp);
        }
    };
    for input in &mut parts.inputs {
        universe(&mut input.universe);
        input.terms.iter_mut().for_each(|term| membership(&mut term.membership));
    }
    for output in &mut parts.outputs {
        universe(&mut output.universe);
        for term in &mut output.terms {
            let Conclusion::Set { membership: set, .. } = &mut term.conclusion else { continue };
            membership(set);
        }
    }
    parts
}

/// Calls with random systems in every mode and random inputs.
fn everywhere(seed: u64, curved: bool, mut check: impl FnMut(&Parts, &[f64], String)) {
    let mut random = Random(seed);
    for n in 0..25 {
        let mut parts = random.system(curved);
        for (sampling, method) in SAMPLINGS.into_iter().flat_map(|s| METHODS.map(|m| (s, m))) {
            parts.outputs[0].defuzzifier = method(sampling);
            let inputs = random.point(&parts);
            check(&parts, &inputs, format!("system {n}, {:?}, {inputs:?}", method(sampling)));
        }
    }
}

#[test]
fn scaling_all_ranges_by_eight_scales_the_answer_bit_for_bit() {
    let times_8 = |x: f64| 8.0 * x;
    for curved in [false, true] {
        everywhere(1, curved, |parts, inputs, place| {
            let large = moved(parts.clone(), times_8, times_8);
            let inputs_8: Vec<f64> = inputs.iter().copied().map(times_8).collect();
            assert_eq!(ask(parts, inputs).map(times_8), ask(&large, &inputs_8), "{place}");
        });
    }
}

#[test]
fn translating_an_output_translates_its_answer() {
    // By a power of two, so that corners are rounded but little.
    let by = 64.0;
    everywhere(2, false, |parts, inputs, place| {
        if parts.outputs[0].defuzzifier.sampling() != Some(Sampling::Exact) {
            return;
        }
        let there = moved(parts.clone(), |x| x + by, |sigma| sigma);
        let inputs_there: Vec<f64> = inputs.iter().map(|x| x + by).collect();
        let (here, there) = (ask(parts, inputs), ask(&there, &inputs_there));
        assert_eq!(here.is_some(), there.is_some(), "{place}");
        let error = here.zip(there).map_or(0.0, |(here, there)| (there - by - here).abs());
        // The last places of 64 and a bisector at a shallow end.
        assert!(error < 1e-6, "{place}: {error:e}");
    });
}

#[test]
fn a_mirrored_system_has_the_mirrored_answer() {
    everywhere(3, false, |parts, inputs, place| {
        let defuzzifier = match parts.outputs[0].defuzzifier {
            Defuzzifier::SmallestOfMaximum(s) => Defuzzifier::LargestOfMaximum(s),
            Defuzzifier::LargestOfMaximum(s) => Defuzzifier::SmallestOfMaximum(s),
            other => other,
        };
        // Left ends become right ends; the first sample at half becomes the last.
        let lopsided = matches!(defuzzifier.sampling(), Some(Sampling::LeftEnd(_)))
            || matches!(defuzzifier, Defuzzifier::Bisector(Sampling::Endpoints(_)));
        // Smallest and largest by magnitude stay what they are.
        let by_magnitude = matches!(defuzzifier.sampling(), Some(Sampling::Endpoints(_)));
        if lopsided || by_magnitude && !matches!(defuzzifier, Defuzzifier::Centroid(_)) {
            return;
        }
        let mut mirrored = moved(parts.clone(), |x| -x, |sigma| sigma);
        mirrored.outputs[0].defuzzifier = defuzzifier;
        let inputs_there: Vec<f64> = inputs.iter().map(|x| -x).collect();
        let (here, there) = (ask(parts, inputs), ask(&mirrored, &inputs_there));
        assert_eq!(here.is_some(), there.is_some(), "{place}");
        let error = here.zip(there).map_or(0.0, |(here, there)| (here + there).abs());
        // Samples on a jump may fall on its other side by a rounding.
        let allowed = if defuzzifier.sampling() == Some(Sampling::Exact) { 1e-9 } else { 0.3 };
        assert!(error < allowed, "{place}: {error:e}");
    });
}

#[test]
fn the_order_of_rules_does_not_matter() {
    everywhere(4, true, |parts, inputs, place| {
        let mut turned = parts.clone();
        turned.blocks[0].rules.reverse();
        let (one, other) = (ask(parts, inputs), ask(&turned, inputs));
        if parts.outputs[0].aggregation == SNormKind::Maximum.into() {
            assert_eq!(one, other, "{place}");
        }
        let error = one.zip(other).map_or(0.0, |(one, other)| (one - other).abs());
        assert!(error < 1e-6, "{place}: {error:e}");
    });
}

#[test]
fn a_duplicated_rule_changes_nothing_under_maximum() {
    everywhere(5, true, |parts, inputs, place| {
        let mut parts = parts.clone();
        parts.outputs[0].aggregation = SNormKind::Maximum.into();
        let once = ask(&parts, inputs);
        let again = parts.blocks[0].rules[0].clone();
        parts.blocks[0].rules.push(again);
        assert_eq!(once, ask(&parts, inputs), "{place}");
    });
}

#[test]
fn a_rule_split_in_equal_copies_changes_nothing_where_strengths_add_up() {
    everywhere(6, false, |parts, inputs, place| {
        let mut parts = parts.clone();
        parts.outputs[0].aggregation = SNormKind::UnboundedSum.into();
        parts.blocks[0].implication = TNormKind::AlgebraicProduct.into();
        let whole = ask(&parts, inputs);
        let mut quarter = parts.blocks[0].rules[0].clone();
        quarter.weight = 0.25;
        parts.blocks[0].rules.splice(..1, [(); 4].map(|()| quarter.clone()));
        let split = ask(&parts, inputs);
        let error = whole.zip(split).map_or(0.0, |(whole, split)| (whole - split).abs());
        assert!(error < 1e-6 && whole.is_some() == split.is_some(), "{place}: {error:e}");
    });
    let mut random = Random(60);
    for _ in 0..50 {
        let mut parts = random.system(false);
        parts.outputs[0].defuzzifier = Defuzzifier::WeightedAverage(SetReading::default());
        for term in &mut parts.outputs[0].terms {
            term.conclusion = Conclusion::Constant(random.unit());
        }
        let inputs = random.point(&parts);
        let whole = ask(&parts, &inputs);
        let mut half = parts.blocks[0].rules[0].clone();
        half.weight = 0.5;
        parts.blocks[0].rules.splice(..1, [half.clone(), half]);
        let split = ask(&parts, &inputs);
        let error = whole.zip(split).map_or(0.0, |(whole, split)| (whole - split).abs());
        assert!(error < 1e-14, "{inputs:?}: {error:e}");
    }
}

#[test]
fn a_weight_of_nought_equals_removal_bit_for_bit() {
    everywhere(7, true, |parts, inputs, place| {
        let (mut weightless, mut without) = (parts.clone(), parts.clone());
        weightless.blocks[0].rules[0].weight = 0.0;
        without.blocks[0].rules.remove(0);
        assert_eq!(ask(&weightless, inputs), ask(&without, inputs), "{place}");
    });
}
