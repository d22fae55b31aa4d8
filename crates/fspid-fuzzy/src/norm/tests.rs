//! The laws that norms obey, for each member of the lists.

use super::*;
use std::vec::Vec;

/// Grades whose sums and differences are exact, and some that are not.
fn grades() -> Vec<f64> {
    let eighths = (0..=8).map(|k| f64::from(k) / 8.0);
    eighths.chain([5e-324, 1e-300, 1e-17, 0.1, 1.0 / 3.0, 0.7, 1.0 - 1e-16]).collect()
}

fn pairs() -> Vec<(f64, f64)> {
    grades().iter().flat_map(|&a| grades().into_iter().map(move |b| (a, b))).collect()
}

#[test]
fn every_norm_stays_within_zero_and_one() {
    for (a, b) in pairs() {
        for kind in TNormKind::ALL {
            assert!((0.0..=a.min(b)).contains(&kind.apply(a, b)), "{} {a} {b}", kind.name());
        }
        for kind in SNormKind::ALL.iter().filter(|&&kind| kind != SNormKind::UnboundedSum) {
            assert!((a.max(b)..=1.0).contains(&kind.apply(a, b)), "{} {a} {b}", kind.name());
        }
        assert_eq!(SNormKind::UnboundedSum.apply(a, b), a + b);
    }
}

#[test]
fn every_norm_commutes_to_the_last_bit() {
    for (a, b) in pairs() {
        for kind in TNormKind::ALL {
            assert_eq!(kind.apply(a, b), kind.apply(b, a), "{} {a} {b}", kind.name());
        }
        for kind in SNormKind::ALL {
            assert_eq!(kind.apply(a, b), kind.apply(b, a), "{} {a} {b}", kind.name());
        }
    }
}

#[test]
fn one_is_nothing_to_an_and_and_zero_is_nothing_to_an_or() {
    for a in grades() {
        for kind in TNormKind::ALL {
            assert_eq!(kind.apply(a, 1.0), a, "{}", kind.name());
            assert_eq!(kind.apply(a, 0.0), 0.0, "{}", kind.name());
        }
        for kind in SNormKind::ALL {
            assert_eq!(kind.apply(a, 0.0), a, "{}", kind.name());
        }
        for kind in SNormKind::ALL.iter().filter(|&&kind| kind != SNormKind::UnboundedSum) {
            assert_eq!(kind.apply(a, 1.0), 1.0, "{}", kind.name());
        }
    }
}

/// Rounding may turn a rise by less than this around.
const ROUNDING: f64 = 4e-16;

#[test]
fn every_norm_grows_with_its_arguments() {
    for (a, b) in pairs() {
        for larger in grades().into_iter().filter(|&larger| larger >= a) {
            for kind in TNormKind::ALL {
                let grows = kind.apply(larger, b) >= kind.apply(a, b) - ROUNDING;
                assert!(grows, "{} {a} to {larger}, {b}", kind.name());
            }
            for kind in SNormKind::ALL {
                let grows = kind.apply(larger, b) >= kind.apply(a, b) - ROUNDING;
                assert!(grows, "{} {a} to {larger}, {b}", kind.name());
            }
        }
    }
}

/// On eighths the norms that jump see exact sums.
#[test]
fn every_norm_is_associative() {
    let eighths = || (0..=8).map(|k| f64::from(k) / 8.0);
    for a in eighths() {
        for b in eighths() {
            for c in eighths() {
                for kind in TNormKind::ALL {
                    let left = kind.apply(kind.apply(a, b), c);
                    let right = kind.apply(a, kind.apply(b, c));
                    assert!((left - right).abs() < 1e-15, "{} {a} {b} {c}", kind.name());
                }
                for kind in SNormKind::ALL {
                    let left = kind.apply(kind.apply(a, b), c);
                    let right = kind.apply(a, kind.apply(b, c));
                    assert!((left - right).abs() < 1e-15, "{} {a} {b} {c}", kind.name());
                }
            }
        }
    }
}

#[test]
fn each_t_norm_and_its_dual_are_mirror_images() {
    let duals = [
        ("minimum", "maximum"),
        ("algebraic-product", "algebraic-sum"),
        ("bounded-difference", "bounded-sum"),
        ("drastic-product", "drastic-sum"),
        ("einstein-product", "einstein-sum"),
        ("hamacher-product", "hamacher-sum"),
        ("nilpotent-minimum", "nilpotent-maximum"),
    ];
    for (kind, names) in TNormKind::ALL.iter().zip(duals) {
        assert_eq!((kind.name(), kind.dual().name()), names);
        for a in (0..=8).map(|k| f64::from(k) / 8.0) {
            for b in (0..=8).map(|k| f64::from(k) / 8.0) {
                let mirrored = 1.0 - kind.apply(1.0 - a, 1.0 - b);
                let error = (kind.dual().apply(a, b) - mirrored).abs();
                assert!(error < 1e-15, "{} {a} {b}", kind.name());
            }
        }
    }
}

/// Each of the textbook formulas, written as in the textbook.
#[test]
fn every_norm_is_the_textbook_formula() {
    for (a, b) in [(0.3_f64, 0.6_f64), (0.75, 0.5), (0.9, 0.05), (0.2, 0.2)] {
        let sum = a + b;
        let textbook = [
            a.min(b),
            a * b,
            (sum - 1.0).max(0.0),
            0.0,
            a * b / (2.0 - (sum - a * b)),
            a * b / (sum - a * b),
            if sum > 1.0 { a.min(b) } else { 0.0 },
        ];
        for (kind, expected) in TNormKind::ALL.iter().zip(textbook) {
            assert!((kind.apply(a, b) - expected).abs() < 2e-16, "{} {a} {b}", kind.name());
        }
        let textbook = [
            a.max(b),
            sum - a * b,
            sum.min(1.0),
            1.0,
            sum / (1.0 + a * b),
            (sum - 2.0 * a * b) / (1.0 - a * b),
            if sum < 1.0 { a.max(b) } else { 1.0 },
            sum / sum.max(1.0),
            sum,
        ];
        for (kind, expected) in SNormKind::ALL.iter().zip(textbook) {
            assert!((kind.apply(a, b) - expected).abs() < 3e-16, "{} {a} {b}", kind.name());
        }
    }
}

#[test]
fn the_quotients_that_would_be_zero_by_zero_have_their_limits() {
    assert_eq!(TNormKind::HamacherProduct.apply(0.0, 0.0), 0.0);
    assert_eq!(SNormKind::HamacherSum.apply(1.0, 1.0), 1.0);
    assert_eq!(TNormKind::HamacherProduct.apply(1e-200, 1e-200), 0.5e-200);
}

#[test]
fn names_are_unique_and_found_again() {
    for kind in TNormKind::ALL {
        assert_eq!(TNormKind::from_name(kind.name()), Some(*kind));
    }
    for kind in SNormKind::ALL {
        assert_eq!(SNormKind::from_name(kind.name()), Some(*kind));
    }
}
