//! The laws that every membership function obeys.

use super::*;
use std::vec::Vec;

/// Every member's example, and parameters at the edge of what each allows.
fn samples() -> Vec<(ShapeKind, Vec<f64>)> {
    let examples = ShapeKind::ALL.iter().map(|&kind| (kind, kind.example().to_vec()));
    let edges = EDGES.iter().map(|&(kind, params)| (kind, params.to_vec()));
    examples.chain(edges).collect()
}

const INF: f64 = f64::INFINITY;
const EDGES: &[(ShapeKind, &[f64])] = &[
    (ShapeKind::Arc, &[2.0, -1.0]),
    (ShapeKind::Arc, &[-5e307, 5e307]),
    (ShapeKind::Bell, &[0.0, -2.0, 0.25]),
    (ShapeKind::Bell, &[1.0, 1e-308, -3.0]),
    (ShapeKind::Bell, &[1.0, 1.0, 1e308]),
    (ShapeKind::Concave, &[3.0, 1.0]),
    (ShapeKind::Concave, &[0.0, 5e-324]),
    (ShapeKind::Cosine, &[1e308, 1e-300]),
    (ShapeKind::Gaussian, &[0.0, 5e-324]),
    (ShapeKind::Gaussian, &[-1e308, 1e308]),
    (ShapeKind::GaussianProduct, &[1.0, 0.5, -1.0, 2.0]),
    (ShapeKind::LinearS, &[1.0, 1.0]),
    (ShapeKind::LinearZ, &[1.0, 1.0]),
    (ShapeKind::Pi, &[-1.0, 2.0, 1.0, 3.0]),
    (ShapeKind::Pi, &[0.0, 0.0, 1.0, 1.0]),
    (ShapeKind::Points, &[0.5, 0.3]),
    (ShapeKind::Points, &[-1.0, 0.0, -1.0, 1.0, 0.0, 0.2, 0.0, 0.6, 0.5, 0.4]),
    (ShapeKind::Ramp, &[2.0, -1.0]),
    (ShapeKind::Ramp, &[0.0, 5e-324]),
    (ShapeKind::Rectangle, &[0.25, 0.25]),
    (ShapeKind::Rectangle, &[-INF, 0.5]),
    (ShapeKind::Rectangle, &[0.5, INF]),
    (ShapeKind::SemiEllipse, &[-8e307, 8e307]),
    (ShapeKind::Sigmoid, &[1.0, -1e308]),
    (ShapeKind::Sigmoid, &[1.0, 1e-300]),
    (ShapeKind::SigmoidDifference, &[0.0, 1.0, 1.0, -2.0]),
    (ShapeKind::SigmoidProduct, &[0.0, -1e308, 1.0, 1e308]),
    (ShapeKind::SmoothS, &[2.0, 1.0]),
    (ShapeKind::SmoothS, &[1.0, 1.0]),
    (ShapeKind::SmoothZ, &[2.0, 1.0]),
    (ShapeKind::SmoothZ, &[-8e307, 8e307]),
    (ShapeKind::Spike, &[0.0, 5e-324]),
    (ShapeKind::Spike, &[1.0, -2.0]),
    (ShapeKind::Step, &[0.5, -1.0]),
    (ShapeKind::Trapezoid, &[-INF, -INF, 1.0, 2.0]),
    (ShapeKind::Trapezoid, &[-INF, 0.5, 1.0, 2.0]),
    (ShapeKind::Trapezoid, &[-1.0, 0.5, INF, INF]),
    (ShapeKind::Trapezoid, &[-1.0, 0.5, 1.0, INF]),
    (ShapeKind::Trapezoid, &[-1.0, -1.0, 1.0, 1.0]),
    (ShapeKind::Trapezoid, &[-2.0, 2.0, 1.0, 4.0]),
    (ShapeKind::Trapezoid, &[-2.0, 2.0, 1.0, 1.0]),
    (ShapeKind::Trapezoid, &[-INF, 2.0, 1.0, 3.0]),
    (ShapeKind::Trapezoid, &[-8e307, 8e307, -8e307, 8e307]),
    (ShapeKind::Triangle, &[0.0, 0.0, 1.0]),
    (ShapeKind::Triangle, &[0.0, 1.0, 1.0]),
];

/// A grid over the usual part of the line, and the far ends of it.
fn places() -> impl Iterator<Item = f64> {
    let grid = (-1000..=1000).map(|i| f64::from(i) / 128.0);
    let far = [5e-324, 1e-300, 1e-17, 1e17, 1e154, 1e300, 1e308, f64::MAX, INF];
    grid.chain(far).chain(far.map(|x| -x))
}

/// A relative step that the line's far ends still feel.
fn beside(x: f64, side: f64) -> f64 {
    x + side * (1e-9 * x.abs()).max(1e-9)
}

fn vertices(kind: ShapeKind, params: &[f64]) -> Vec<Vertex> {
    let mut all = Vec::new();
    kind.vertices(params, &mut |vertex| all.push(vertex));
    all
}

#[test]
fn every_example_and_every_edge_is_allowed() {
    for (kind, params) in samples() {
        assert_eq!(kind.check(&params), Ok(()), "{} {params:?}", kind.name());
    }
}

#[test]
fn every_member_grades_within_zero_and_one_everywhere() {
    for (kind, params) in samples() {
        for x in places() {
            let grade = kind.grade(&params, x);
            assert!((0.0..=1.0).contains(&grade), "{} {params:?} at {x}: {grade}", kind.name());
        }
    }
}

#[test]
fn every_member_grades_nan_with_zero_or_nan() {
    for (kind, params) in samples() {
        let grade = kind.grade(&params, f64::NAN);
        assert!(grade == 0.0 || grade.is_nan(), "{} {params:?}: {grade}", kind.name());
    }
}

#[test]
fn only_a_set_without_any_end_holds_nan() {
    assert_eq!(ShapeKind::Rectangle.grade(&[-INF, INF], f64::NAN), 1.0);
    assert_eq!(ShapeKind::Trapezoid.grade(&[-INF, -INF, INF, INF], f64::NAN), 1.0);
}

#[test]
fn every_example_reaches_one() {
    for kind in ShapeKind::ALL {
        let top = places().map(|x| kind.grade(kind.example(), x)).fold(0.0, f64::max);
        assert!(top > 0.999, "{} tops at {top}", kind.name());
    }
}

#[test]
fn every_member_refuses_bad_parameters_by_name() {
    for kind in ShapeKind::ALL {
        for (index, param) in kind.params().iter().enumerate() {
            for bad in [f64::NAN, INF, -INF, 0.0, -1.0, 1.5] {
                let mut params = kind.example().to_vec();
                params[index] = bad;
                let refused = matches!(kind.check(&params),
                    Err(FuzzyError::Parameter { name, .. }) if name == param.name);
                if !param.range.allows(bad) {
                    assert!(refused, "{} {} {bad}", kind.name(), param.name);
                }
            }
        }
        assert!(kind.check(&[]).is_err(), "{} without parameters", kind.name());
        let mut more = kind.example().to_vec();
        more.push(0.0);
        assert!(kind.check(&more).is_err(), "{} with one parameter too many", kind.name());
    }
}

#[test]
fn parameters_that_do_not_go_together_are_refused_by_name() {
    let wrong: &[(ShapeKind, &[f64], &str)] = &[
        (ShapeKind::Arc, &[1.0, 1.0], "end"),
        (ShapeKind::Concave, &[1.0, 1.0], "end"),
        (ShapeKind::LinearS, &[1.0, 0.0], "shoulder"),
        (ShapeKind::LinearS, &[-1e308, 1e308], "shoulder"),
        (ShapeKind::LinearZ, &[1.0, 0.0], "foot"),
        (ShapeKind::Pi, &[1.0, 0.0, 2.0, 3.0], "left_top"),
        (ShapeKind::Pi, &[0.0, 1.0, 3.0, 2.0], "right_foot"),
        (ShapeKind::Points, &[1.0, 0.5, 0.0, 0.5], "at"),
        (ShapeKind::Ramp, &[1.0, 1.0], "end"),
        (ShapeKind::Ramp, &[1e308, -1e308], "end"),
        (ShapeKind::Rectangle, &[1.0, 0.0], "end"),
        (ShapeKind::Rectangle, &[INF, INF], "start"),
        (ShapeKind::Rectangle, &[-INF, -INF], "end"),
        (ShapeKind::SemiEllipse, &[1.0, 1.0], "end"),
        (ShapeKind::SmoothS, &[-1e308, 1e308], "shoulder"),
        (ShapeKind::SmoothZ, &[1e308, -1e308], "foot"),
        (ShapeKind::Trapezoid, &[1.0, 0.0, 2.0, 3.0], "left_top"),
        (ShapeKind::Trapezoid, &[0.0, 1.0, 3.0, 2.0], "right_foot"),
        (ShapeKind::Trapezoid, &[0.0, INF, 3.0, 4.0], "left_top"),
        (ShapeKind::Trapezoid, &[0.0, 1.0, -INF, 2.0], "right_top"),
        (ShapeKind::Trapezoid, &[0.0, 1.0, -2.0, 0.0], "right_foot"),
        (ShapeKind::Triangle, &[0.0, -1.0, 1.0], "peak"),
        (ShapeKind::Triangle, &[0.0, 1.0, 0.5], "right"),
        (ShapeKind::Triangle, &[0.0, 0.0, 0.0], "right"),
    ];
    for &(kind, params, expected) in wrong {
        let found = match kind.check(params) {
            Err(FuzzyError::Parameter { name, .. }) => name,
            other => panic!("{} {params:?}: {other:?}", kind.name()),
        };
        assert_eq!(found, expected, "{} {params:?}", kind.name());
    }
}

/// The straight lines between the vertices, at a place that is not one.
fn interpolated(vertices: &[Vertex], x: f64) -> f64 {
    let after = vertices.iter().position(|vertex| vertex.x > x);
    match after {
        Some(0) => vertices[0].grade,
        None => vertices[vertices.len() - 1].grade,
        Some(after) => {
            let (left, right) = (vertices[after - 1], vertices[after]);
            let share = (0.5 * x - 0.5 * left.x) / (0.5 * right.x - 0.5 * left.x);
            left.grade + share * (right.grade - left.grade)
        }
    }
}

#[test]
fn vertices_say_the_same_as_the_grade() {
    for (kind, params) in samples().into_iter().filter(|(kind, _)| kind.is_piecewise_linear()) {
        let vertices = vertices(kind, &params);
        assert!(!vertices.is_empty(), "{} {params:?}", kind.name());
        for x in places().filter(|x| vertices.iter().all(|vertex| vertex.x != *x)) {
            let error = kind.grade(&params, x) - interpolated(&vertices, x);
            assert!(error.abs() < 1e-14, "{} {params:?} at {x}: {error}", kind.name());
        }
    }
}

#[test]
fn vertices_ascend_and_the_grade_at_each_is_one_of_theirs() {
    for (kind, params) in samples().into_iter().filter(|(kind, _)| kind.is_piecewise_linear()) {
        let vertices = vertices(kind, &params);
        assert!(vertices.is_sorted_by(|a, b| a.x <= b.x), "{} {params:?}", kind.name());
        for vertex in &vertices {
            let grade = kind.grade(&params, vertex.x);
            let among = vertices.iter().filter(|other| other.x == vertex.x);
            let agrees = among.clone().any(|other| (other.grade - grade).abs() < 1e-14);
            assert!(agrees, "{} {params:?} at {}: {grade}", kind.name(), vertex.x);
        }
    }
}

/// A curve that is smooth between its corners has no slope that jumps there.
#[test]
fn there_are_no_kinks_between_the_corners() {
    for kind in ShapeKind::ALL {
        let params = kind.example();
        let mut corners = Vec::new();
        kind.corners(params, &mut |x| corners.push(x));
        let step = 1.0 / 4096.0;
        for x in (-12000..12000).map(|i| f64::from(i) * step + 0.3 * step) {
            if corners.iter().any(|corner| (corner - x).abs() < 2.0 * step) {
                continue;
            }
            let [left, here, right] = [x - step, x, x + step].map(|x| kind.grade(params, x));
            let bend = (left - here) + (right - here);
            // An arc's slope is infinite at its end: curvature there up to (16 steps)^(-3/2).
            assert!(bend.abs() < 2e-3, "{} bends by {bend} at {x}", kind.name());
        }
    }
}

#[test]
fn corners_are_finite_or_where_the_parameters_are_not() {
    for (kind, params) in samples() {
        kind.corners(&params, &mut |x| {
            assert!(x.is_finite(), "{} {params:?}: {x}", kind.name());
        });
    }
}

#[test]
fn the_inverse_finds_the_place_of_a_grade() {
    let mut invertible = Vec::new();
    for (kind, params) in samples() {
        if kind.inverse(&params, 0.5).is_none() {
            continue;
        }
        invertible.push(kind.name());
        for grade in (1..64).map(|k| f64::from(k) / 64.0) {
            let x = kind.inverse(&params, grade).unwrap();
            let [left, right] = [-1.0, 1.0].map(|side| kind.grade(&params, beside(x, side)));
            let between = left.min(right) - 1e-9 <= grade && grade <= left.max(right) + 1e-9;
            assert!(between, "{} {params:?}: {grade} at {x}", kind.name());
        }
    }
    invertible.dedup();
    let expected =
        ["arc", "concave", "linear-s", "linear-z", "ramp", "sigmoid", "smooth-s", "smooth-z"];
    invertible.sort_unstable();
    invertible.dedup();
    assert_eq!(invertible, expected);
}

#[test]
fn the_inverse_of_the_grade_of_a_place_is_the_place() {
    for kind in ShapeKind::ALL {
        let params = kind.example();
        for x in (-31..=31).map(|i| f64::from(i) / 32.0) {
            if let Some(back) = kind.inverse(params, kind.grade(params, x)) {
                assert!((back - x).abs() < 1e-14, "{}: {x} came back as {back}", kind.name());
            }
        }
    }
}

#[test]
fn names_are_unique_and_of_lower_case_words() {
    for kind in ShapeKind::ALL {
        assert_eq!(ShapeKind::from_name(kind.name()), Some(*kind));
        let words =
            |text: &str, dash: u8| text.bytes().all(|b| b == dash || b.is_ascii_lowercase());
        assert!(words(kind.name(), b'-'), "{}", kind.name());
        for param in kind.params() {
            assert!(words(param.name, b'_') && param.name != "x", "{}", param.name);
        }
    }
}

#[test]
fn the_ends_of_crisp_sets_belong_to_them() {
    let grades = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| ShapeKind::Rectangle.grade(&[1.0, 3.0], x));
    assert_eq!(grades, [0.0, 1.0, 1.0, 1.0, 0.0]);
    let up = [0.0, 1.0, 2.0].map(|x| ShapeKind::Step.grade(&[1.0, 1.0], x));
    let down = [0.0, 1.0, 2.0].map(|x| ShapeKind::Step.grade(&[1.0, -1.0], x));
    assert_eq!((up, down), ([0.0, 1.0, 1.0], [1.0, 1.0, 0.0]));
    let point = [0.0, 1.0, 2.0].map(|x| ShapeKind::Singleton.grade(&[1.0], x));
    assert_eq!(point, [0.0, 1.0, 0.0]);
}

/// MATLAB documents `linsmf` as 1 and `linzmf` as 0 at a jump.
#[test]
fn a_linear_step_without_width_rises_and_falls_as_documented() {
    let rising = [0.0, 1.0, 2.0].map(|x| ShapeKind::LinearS.grade(&[1.0, 1.0], x));
    let falling = [0.0, 1.0, 2.0].map(|x| ShapeKind::LinearZ.grade(&[1.0, 1.0], x));
    assert_eq!((rising, falling), ([0.0, 1.0, 1.0], [1.0, 0.0, 0.0]));
}

#[test]
fn crossed_tops_meet_below_one() {
    let trapezoid = vertices(ShapeKind::Trapezoid, &[0.0, 3.0, 2.0, 4.0]);
    assert_eq!(trapezoid.len(), 3);
    assert!((trapezoid[1].x - 2.4).abs() < 1e-15 && (trapezoid[1].grade - 0.8).abs() < 1e-15);
    let crossed = places().map(|x| ShapeKind::GaussianProduct.grade(&[1.0, 1.0, -1.0, 1.0], x));
    assert!((crossed.fold(0.0, f64::max) - Scalar::exp(-1.0_f64)).abs() < 1e-15);
}
