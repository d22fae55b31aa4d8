//! What holds for every system: exact answers against many samples, and no allocation.

use fspid_fuzzy::system::{Defuzzifier, Parts, Sampling, SetReading};

use crate::system::build::{answers, system};
use crate::system::random::Random;

fn asked(parts: &Parts, defuzzifier: Defuzzifier) -> Parts {
    let mut parts = parts.clone();
    parts.outputs[0].defuzzifier = defuzzifier;
    parts
}

#[test]
fn exact_answers_agree_with_many_samples() {
    let mut random = Random(8);
    for n in 0..120 {
        let parts = random.system(n % 3 == 0);
        let inputs = random.point(&parts);
        let universe = parts.outputs[0].universe.expect("bounded");
        for method in [Defuzzifier::Centroid, Defuzzifier::Bisector] {
            let exact = answers(&system(asked(&parts, method(Sampling::Exact))), &inputs)[0];
            let many = method(Sampling::Midpoint(40_000));
            let many = answers(&system(asked(&parts, many)), &inputs)[0];
            let (Some(exact_value), Some(many)) = (exact.value, many.value) else { continue };
            assert!(universe.contains(exact_value) && exact.error_bound < 1e-10, "{n}: {exact:?}");
            let error = (exact_value - many).abs();
            // A jump costs half a cell of its height; a bisector in a valley more.
            assert!(error < 2e-3, "{n}, {:?}: {exact_value} {many}", method(Sampling::Exact));
        }
    }
}

#[test]
fn maxima_lie_in_order_and_have_the_highest_grade() {
    let mut random = Random(9);
    for n in 0..120 {
        let parts = random.system(n % 3 == 0);
        let inputs = random.point(&parts);
        let ask = |method: Defuzzifier| answers(&system(asked(&parts, method)), &inputs)[0].value;
        let found = [
            Defuzzifier::SmallestOfMaximum(Sampling::Exact),
            Defuzzifier::MeanOfMaximum(Sampling::Exact),
            Defuzzifier::LargestOfMaximum(Sampling::Exact),
        ]
        .map(ask);
        let [Some(smallest), Some(mean), Some(largest)] = found else {
            assert_eq!(found, [None; 3]);
            continue;
        };
        assert!(smallest <= mean + 1e-6 && mean <= largest + 1e-6, "{n}: {found:?}");
        let mean = asked(&parts, Defuzzifier::MeanOfMaximum(Sampling::Exact));
        let bound = answers(&system(mean), &inputs)[0].error_bound;
        assert!(bound < 1e-5, "{n}: {bound:e}");
        let many = Sampling::Trapezoid(20_001);
        let [first, last] =
            [Defuzzifier::SmallestOfMaximum(many), Defuzzifier::LargestOfMaximum(many)].map(ask);
        // Samples find no more than the whole does.
        let (first, last) = (first.expect("an area"), last.expect("an area"));
        assert!(
            smallest <= first + 2e-3 && last <= largest + 2e-3,
            "{n}: {found:?} {first} {last}"
        );
    }
}

#[test]
fn an_evaluation_allocates_nothing_in_any_mode() {
    let mut random = Random(10);
    let samplings = [
        Sampling::Exact,
        Sampling::Endpoints(101),
        Sampling::Midpoint(100),
        Sampling::Trapezoid(101),
        Sampling::LeftEnd(100),
        Sampling::Vertices(31),
    ];
    let methods = [
        Defuzzifier::Centroid,
        Defuzzifier::Bisector,
        Defuzzifier::SmallestOfMaximum,
        Defuzzifier::MeanOfMaximum,
        Defuzzifier::LargestOfMaximum,
    ];
    for n in 0..20 {
        let parts = random.system(n % 4 == 0);
        for method in samplings.into_iter().flat_map(|s| methods.map(|m| m(s))) {
            let general = system(asked(&parts, method));
            // A clone is as good as the original.
            let mut workspace = general.workspace().clone();
            for _ in 0..20 {
                let inputs = random.point(&parts);
                let counted = allocation_counter::measure(|| {
                    general.evaluate(&inputs, &mut workspace).expect("allowed");
                    general.outline(0, &mut workspace);
                });
                assert_eq!(counted.count_total, 0, "{n} {method:?}");
            }
        }
    }
    let weighted = Defuzzifier::WeightedAverage(SetReading::InverseTsukamoto);
    let parts = asked(&random.system(false), weighted);
    let general = system(parts.clone());
    let (mut workspace, inputs) = (general.workspace(), random.point(&parts));
    let counted = allocation_counter::measure(|| {
        general.evaluate(&inputs, &mut workspace).expect("allowed");
    });
    assert_eq!(counted.count_total, 0);
}
