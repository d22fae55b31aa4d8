//! Numbers read off samples.

use fspid_fuzzy::membership::ShapeKind::Trapezoid;
use fspid_fuzzy::norm::TNormKind;
use fspid_fuzzy::system::{Defuzzifier, Parts, Sampling};
use fspid_fuzzy::{OutOfRange, RuleTable, Supervisor};

use crate::system::build::{graded, output, sets, shape, system, triangle, value};

/// The set of MATLAB's example *Defuzzification Methods*: three scaled trapezoids over [-10, 10].
fn example(method: Defuzzifier) -> Parts {
    let corners = [[-10.0, -8.0, -2.0, 2.0], [-5.0, -3.0, 2.0, 4.0], [2.0, 3.0, 8.0, 9.0]];
    let terms = corners.map(|corners| shape(Trapezoid, &corners));
    let mut parts = graded(output(-10.0, 10.0, sets(terms.into())));
    parts.blocks[0].implication = TNormKind::AlgebraicProduct.into();
    parts.outputs[0].defuzzifier = method;
    parts
}

const STRENGTHS: [f64; 3] = [0.9, 0.5, 0.1];

#[test]
fn endpoints_take_the_maximum_nearest_to_and_farthest_from_zero_as_matlab_documents() {
    let sampling = Sampling::Endpoints(201);
    let known = [
        (Defuzzifier::SmallestOfMaximum(sampling), -2.0),
        (Defuzzifier::MeanOfMaximum(sampling), -5.0),
        (Defuzzifier::LargestOfMaximum(sampling), -8.0),
    ];
    for (method, expected) in known {
        let found = value(example(method), &STRENGTHS);
        assert!((found - expected).abs() < 1e-12, "{method:?}: {found}");
    }
}

#[test]
fn other_rules_take_the_leftmost_and_the_rightmost_maximum() {
    let rules =
        [Sampling::Exact, Sampling::Trapezoid(201), Sampling::LeftEnd(200), Sampling::Vertices(21)];
    for sampling in rules {
        let smallest = value(example(Defuzzifier::SmallestOfMaximum(sampling)), &STRENGTHS);
        let largest = value(example(Defuzzifier::LargestOfMaximum(sampling)), &STRENGTHS);
        assert!(
            (smallest + 8.0).abs() < 1e-12 && (largest + 2.0).abs() < 1e-12,
            "{sampling}: {smallest} {largest}"
        );
    }
}

#[test]
fn the_centroid_of_a_trapezoid_is_the_one_that_matlab_prints() {
    let mut parts =
        graded(output(-10.0, 10.0, sets(vec![shape(Trapezoid, &[-10.0, -8.0, -4.0, 7.0])])));
    parts.outputs[0].defuzzifier = Defuzzifier::Centroid(Sampling::Endpoints(201));
    assert!((value(parts, &[1.0]) + 3.2857).abs() < 0.5e-4);
}

#[test]
fn the_bisector_of_endpoints_is_the_first_sample_at_which_the_sum_reaches_half() {
    // Grades 0, 1/2, 1, 1/2, 0 at 0, …, 4: half of 2 is reached at the third.
    let mut parts = graded(output(0.0, 4.0, sets(vec![triangle(0.0, 2.0, 4.0)])));
    for (sampling, expected) in [
        (Sampling::Endpoints(5), 2.0),
        (Sampling::Trapezoid(5), 2.0),
        (Sampling::Vertices(5), 2.0),
        // Cells of heights 1/4, 3/4, 3/4, 1/4.
        (Sampling::Midpoint(4), 2.0),
        // Cells of heights 0, 1/2, 1, 1/2: half a unit into the third.
        (Sampling::LeftEnd(4), 2.5),
    ] {
        parts.outputs[0].defuzzifier = Defuzzifier::Bisector(sampling);
        assert_eq!(value(parts.clone(), &[1.0]), expected, "{sampling}");
    }
}

#[test]
fn many_samples_tend_to_the_exact_value_of_every_method() {
    let strengths = [0.83, 0.47, 0.21];
    let method = [
        Defuzzifier::Centroid,
        Defuzzifier::Bisector,
        Defuzzifier::SmallestOfMaximum,
        Defuzzifier::MeanOfMaximum,
        Defuzzifier::LargestOfMaximum,
    ];
    let terms =
        sets(vec![triangle(0.0, 2.0, 4.0), triangle(1.0, 5.0, 6.0), triangle(5.0, 7.0, 7.0)]);
    for method in method {
        let with = |sampling| {
            let mut parts = graded(output(0.0, 7.0, terms.clone()));
            parts.outputs[0].defuzzifier = method(sampling);
            value(parts, &strengths)
        };
        let exact = with(Sampling::Exact);
        let n = 20_000;
        for sampling in [
            Sampling::Endpoints(n),
            Sampling::Midpoint(n),
            Sampling::Trapezoid(n),
            Sampling::LeftEnd(n),
            Sampling::Vertices(n),
        ] {
            let found = with(sampling);
            assert!((found - exact).abs() < 1e-3, "{sampling}: {found} {exact}");
        }
    }
}

/// A term that nothing concludes, so that the terms are no partition and the general path is taken.
fn general(mut parts: Parts) -> Parts {
    for out in &mut parts.outputs {
        let mut spare = out.terms[0].clone();
        spare.name = "spare".to_string();
        out.terms.push(spare);
    }
    parts
}

#[test]
fn the_general_path_has_the_reference_answers_in_every_mode() {
    let data = include_str!("../data/supervisor.csv");
    let rules = [
        fspid_fuzzy::Defuzzifier::Exact,
        fspid_fuzzy::Defuzzifier::Endpoints(101),
        fspid_fuzzy::Defuzzifier::Midpoint(100),
        fspid_fuzzy::Defuzzifier::Midpoint(1000),
        fspid_fuzzy::Defuzzifier::Trapezoid(101),
    ];
    let rows: Vec<Vec<&str>> = data.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let mut worst = 0.0_f64;
    for (table, text) in crate::system::supervisor::TABLES {
        let grids: Vec<&str> = text.split("\"\"\"").collect();
        let grids = RuleTable::parse([grids[1], grids[3], grids[5]]).expect("a shipped table");
        for (mode, rule) in rules.into_iter().enumerate() {
            let about = |row: &&Vec<&str>| row[0] == table;
            let mut range = f64::NAN;
            let mut both = None;
            for row in rows.iter().filter(about) {
                let number = |column: usize| row[column].parse::<f64>().expect("a number");
                if number(1) != range {
                    range = number(1);
                    let supervisor = Supervisor::new(&grids, range, rule, OutOfRange::Evaluate);
                    let partition = Parts::try_from(&supervisor.expect("allowed")).expect("rules");
                    both = Some([system(partition.clone()), system(general(partition))]);
                }
                for system in both.iter().flatten() {
                    let mut workspace = system.workspace();
                    let answers = system.evaluate(&[number(3), number(4)], &mut workspace);
                    for (output, answer) in answers.expect("finite").iter().enumerate() {
                        let expected = number(5 + 3 * mode + output);
                        let error = (answer.value.expect("rules fire") - expected).abs() / range;
                        assert!(error < 1e-13, "{rule} {row:?}: {error:e}");
                        worst = worst.max(error);
                    }
                }
            }
        }
    }
    println!("worst error over all modes, in ranges: {worst:.2e}");
}
