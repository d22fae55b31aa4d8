//! Membership functions against published definitions evaluated with 40 digits by `oracles/`.

use fspid_fuzzy::membership::ShapeKind;

/// Two roundings of a number up to 1.
const TOLERANCE: f64 = 5e-16;
/// Roundings of parameters and places in single precision, at slopes up to 5.
const SINGLE_TOLERANCE: f64 = 4e-6;
/// A few roundings of the exponent of a tail, which reaches 700.
const TAIL_TOLERANCE: f64 = 1e-12;

struct MembershipRow {
    kind: ShapeKind,
    params: Vec<f64>,
    x: f64,
    grade: f64,
}

fn rows() -> Vec<MembershipRow> {
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let row = |line: &str| {
        let columns: Vec<&str> = line.split(',').collect();
        MembershipRow {
            kind: ShapeKind::from_name(columns[0]).expect("a known shape"),
            params: columns[1].split(' ').map(number).collect(),
            x: number(columns[2]),
            grade: number(columns[3]),
        }
    };
    include_str!("data/membership.csv").lines().skip(1).map(row).collect()
}

#[test]
fn every_shape_is_compared() {
    for kind in ShapeKind::ALL {
        let of_kind = rows().iter().filter(|row| row.kind == *kind).count();
        assert!(of_kind >= 20, "{}: {of_kind} rows", kind.name());
    }
}

#[test]
fn every_grade_agrees_with_the_published_definition() {
    let mut worst = (0.0, "");
    for MembershipRow { kind, params, x, grade } in rows() {
        assert_eq!(kind.check(&params), Ok(()), "{} {params:?}", kind.name());
        let error = (kind.grade(&params, x) - grade).abs();
        assert!(error <= TOLERANCE, "{} {params:?} at {x}: {error:e}", kind.name());
        if error > worst.0 {
            worst = (error, kind.name());
        }
    }
    println!("largest error {:e} ({})", worst.0, worst.1);
}

/// Small grades count: a rule that fires to 1e-200 may be the only one. The difference of two
/// sigmoids is the exception, whose tails cancel in its definition.
#[test]
fn tails_agree_in_proportion() {
    let not_cancelling = |row: &MembershipRow| row.kind != ShapeKind::SigmoidDifference;
    for row in rows().into_iter().filter(not_cancelling) {
        let found = row.kind.grade(&row.params, row.x);
        let error = (found - row.grade).abs();
        let tolerance = TAIL_TOLERANCE * row.grade + f64::MIN_POSITIVE;
        assert!(error <= tolerance, "{} {:?} at {}: {found:e}", row.kind.name(), row.params, row.x);
    }
}

/// In single precision, a few of its own roundings.
#[test]
fn single_precision_is_near() {
    for MembershipRow { kind, params, x, grade } in rows() {
        #[allow(clippy::cast_possible_truncation, reason = "single precision is what is asked")]
        let narrow = |value: f64| value as f32;
        let params: Vec<f32> = params.iter().map(|&p| narrow(p)).collect();
        let found = f64::from(kind.grade(&params, narrow(x)));
        assert!(
            (found - grade).abs() < SINGLE_TOLERANCE,
            "{} {params:?} at {x}: {found}",
            kind.name()
        );
    }
}
