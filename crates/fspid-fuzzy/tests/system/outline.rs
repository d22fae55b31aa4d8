//! AggregatedSet sets as polygons, and what is read off them.

use fspid_fuzzy::norm::TNormKind;
use fspid_fuzzy::system::{Defuzzifier, Parts, Sampling, Source};
use fspid_fuzzy::{OutOfRange, RuleTable, Supervisor};

use crate::system::build::{
    answers, block, graded, grades, is, output, parts, rule, sets, system, then, triangle, value,
};

const PRINTED: &str = include_str!("../../../../data/rule-tables/printed.toml");
const MIRRORED: &str = include_str!("../../../../data/rule-tables/mirrored.toml");

const EXACT: Sampling = Sampling::Exact;

fn paper(table: &str, range: f64) -> Parts {
    let grids: Vec<&str> = table.split("\"\"\"").collect();
    let table = RuleTable::parse([grids[1], grids[3], grids[5]]).expect("a shipped table");
    let rule = fspid_fuzzy::Defuzzifier::Exact;
    Parts::try_from(&Supervisor::new(&table, range, rule, OutOfRange::Evaluate).expect("allowed"))
        .expect("rules")
}

#[test]
fn the_outline_of_the_paper_s_supervisor_has_the_reference_centroids() {
    let data = include_str!("../data/supervisor.csv");
    let mut worst = 0.0_f64;
    for row in data.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>()) {
        let number = |column: usize| row[column].parse::<f64>().expect("a number");
        let range = number(1);
        let table = if row[0] == "printed" { PRINTED } else { MIRRORED };
        let general = system(paper(table, range));
        let mut workspace = general.workspace();
        general.evaluate(&[number(3), number(4)], &mut workspace).expect("finite");
        for index in 0..3 {
            let joined = general.outline(index, &mut workspace).expect("triangles");
            let error = joined.centroid().expect("an area") - number(5 + index);
            assert!(error.abs() < 1e-14 * range, "{row:?}: {error:e}");
            worst = worst.max(error.abs() / range);
        }
    }
    println!("worst error of the outline's centroid, in ranges: {worst:.2e}");
}

/// Two triangles that cross, cut at 0.8 and 0.3.
fn two() -> Parts {
    graded(output(0.0, 4.0, sets(vec![triangle(0.0, 1.0, 2.0), triangle(1.0, 2.0, 3.0)])))
}

#[test]
fn an_outline_tells_whose_each_piece_is_and_where_it_is_cut() {
    let general = system(two());
    let mut workspace = general.workspace();
    general.evaluate(&[0.8, 0.3], &mut workspace).expect("allowed");
    let joined = general.outline(0, &mut workspace).expect("triangles");
    let expected = [
        ([0.0, 0.8], [0.0, 0.8], 0, false),
        ([0.8, 1.2], [0.8, 0.8], 0, true),
        ([1.2, 1.7], [0.8, 0.3], 0, false),
        ([1.7, 2.7], [0.3, 0.3], 1, true),
        ([2.7, 3.0], [0.3, 0.0], 1, false),
    ];
    assert_eq!(joined.pieces().len(), expected.len(), "{joined:?}");
    for (piece, (x, grade, conclusion, cut)) in joined.pieces().iter().zip(expected) {
        for (found, wanted) in piece.x.iter().chain(&piece.grade).zip(x.iter().chain(&grade)) {
            assert!((found - wanted).abs() < 1e-15, "{piece:?}");
        }
        assert_eq!((piece.conclusion, piece.cut), (Some(conclusion), cut));
        assert_eq!(general.origin(conclusion), Some([0, conclusion, 0]));
    }
    assert_eq!(joined.top(), 0.8);
    assert!((joined.area() - (0.32 + 0.32 + 0.275 + 0.3 + 0.045)).abs() < 1e-15);
}

#[test]
fn methods_read_the_polygon_exactly() {
    let with = |method| {
        let mut parts = two();
        parts.outputs[0].defuzzifier = method;
        value(parts, &[0.8, 0.3])
    };
    // Half of 1.26 is reached 0.63 - 0.32 into the plateau of height 0.8.
    assert!((with(Defuzzifier::Bisector(EXACT)) - (0.8 + 0.31 / 0.8)).abs() < 1e-14);
    assert!((with(Defuzzifier::SmallestOfMaximum(EXACT)) - 0.8).abs() < 1e-15);
    assert!((with(Defuzzifier::MeanOfMaximum(EXACT)) - 1.0).abs() < 1e-15);
    assert!((with(Defuzzifier::LargestOfMaximum(EXACT)) - 1.2).abs() < 1e-15);
}

#[test]
fn product_tilts_the_sets_and_they_cross_where_they_must() {
    let mut parts = two();
    parts.blocks[0].implication = TNormKind::AlgebraicProduct.into();
    let general = system(parts);
    let mut workspace = general.workspace();
    general.evaluate(&[0.8, 0.4], &mut workspace).expect("allowed");
    let joined = general.outline(0, &mut workspace).expect("triangles");
    // 0.8 (2 - x) = 0.4 (x - 1) at x = 5/3.
    let places: Vec<f64> = joined.pieces().iter().map(|piece| piece.x[1]).collect();
    for (found, wanted) in places.iter().zip([1.0, 5.0 / 3.0, 2.0, 3.0]) {
        assert!((found - wanted).abs() < 1e-15, "{joined:?}");
    }
}

#[test]
fn the_bisector_of_two_equal_islands_lies_half_way_between_them() {
    let islands = sets(vec![triangle(0.0, 1.0, 2.0), triangle(6.0, 7.0, 8.0)]);
    let mut parts = graded(output(-1.0, 9.0, islands));
    parts.outputs[0].defuzzifier = Defuzzifier::Bisector(EXACT);
    for strength in [1.0, 0.7, 0.3, 1e-3, 1e-200] {
        assert!((value(parts.clone(), &[strength; 2]) - 4.0).abs() < 1e-13, "{strength}");
    }
}

#[test]
fn strengths_of_any_size_keep_their_digits() {
    for strength in [1e-300, 1e-200, 1e-30, 1e-9] {
        let found = value(two(), &[strength, strength]);
        assert!((found - 1.5).abs() < 4.0 * strength + 1e-15, "{strength}: {found}");
        // A hundred times weaker: the two plateaus weigh 2 : 0.01 apart from the overlap.
        let found = value(two(), &[strength, strength / 128.0]);
        let expected = (2.0 * 1.0 + 2.5 / 128.0) / (2.0 + 1.0 / 128.0);
        assert!(
            (found - expected).abs() < 4.0 * strength + 1e-15,
            "{strength}: {found} {expected}"
        );
    }
}

#[test]
fn sets_are_cut_off_by_the_universe() {
    // Half a triangle: a third of the way from its peak.
    let half = graded(output(1.0, 2.0, sets(vec![triangle(0.0, 1.0, 2.0)])));
    assert!((value(half, &[1.0]) - 4.0 / 3.0).abs() < 1e-15);
    let outside = graded(output(5.0, 6.0, sets(vec![triangle(0.0, 1.0, 2.0)])));
    let answer = answers(&system(outside), &[1.0])[0];
    assert_eq!((answer.value, answer.source), (None, Source::Nothing));
}

#[test]
fn a_jump_at_a_shoulder_is_part_of_the_polygon() {
    let shoulder = graded(output(0.0, 3.0, sets(vec![triangle(1.0, 1.0, 3.0)])));
    assert!((value(shoulder, &[1.0]) - 5.0 / 3.0).abs() < 1e-15);
}

#[test]
fn the_strongest_of_several_rules_owns_a_set() {
    let rules = (0..3).map(|n| rule(is(n, 0), then(0, 0))).collect();
    let one = output(0.0, 2.0, sets(vec![triangle(0.0, 1.0, 2.0)]));
    let general = system(parts(grades(3), vec![one], vec![block(rules)]));
    let mut workspace = general.workspace();
    general.evaluate(&[0.2, 0.6, 0.6], &mut workspace).expect("allowed");
    let joined = general.outline(0, &mut workspace).expect("triangles");
    assert!(joined.pieces().iter().all(|piece| piece.conclusion == Some(1)));
    assert_eq!(joined.top(), 0.6);
}
