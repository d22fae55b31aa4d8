//! Grades of intervals: every grade of every point of a box, parameters included.

use fspid_fuzzy::membership::ShapeKind;
use fspid_numeric::scalar::Interval;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn repeatable() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        cases: 1000,
        ..ProptestConfig::default()
    }
}

/// The point that lies at `share` of the way through the interval.
fn inside(interval: Interval, share: f64) -> f64 {
    (interval.lower() + share * (interval.upper() - interval.lower()))
        .clamp(interval.lower(), interval.upper())
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn the_grade_of_a_box_holds_every_grade_of_its_points(
        centre in -3.0..3.0_f64, size in prop_oneof![Just(0.0), 0.0..0.01_f64, 0.0..4.0_f64],
        shares in prop::collection::vec(0.0..=1.0_f64, 16), spread in prop_oneof![Just(0.0), 0.0..0.02_f64],
    ) {
        let x = Interval::between(centre, centre + size);
        for kind in ShapeKind::ALL {
            let params: Vec<_> = kind.example().iter().map(|p| Interval::between(p - spread * p.abs(), p + spread * p.abs())).collect();
            let image = kind.grade(&params, x);
            for share in &shares {
                let sampled: Vec<_> = params.iter().zip(shares.iter().rev()).map(|(p, &at)| inside(*p, at)).collect();
                if kind.check(&sampled).is_err() {
                    continue;
                }
                let point = inside(x, *share);
                let grade = kind.grade(&sampled, point);
                prop_assert!(image.contains(grade), "{} {x:?}: {image:?}, {point} {grade}", kind.name());
            }
        }
    }
}
