//! Bounds of what disturbances do to loops that are proved for gains of a bounded rate, attacked twice: flown, with what
//! the law itself makes of them, and in the loop's own equations with gains that are moved against it, within what the law
//! reaches and as fast as it may, and with the worst disturbance for that motion.

use std::sync::OnceLock;

use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_proof::{
    Asked, BoundedRate, Certificate, Claim, DisturbanceBound, Extent, LoopDescription, Rechecked,
    Verdict, bound_disturbances, certify, ways_of,
};
use fspid_sim::Scenario;

use super::disturbed::{at_rest, attack_of, bounded};
use super::drawn::{self, Dice};
use super::flown::quick;
use super::worst::{SAMPLES, corners, motion, share};

/// The scenario of this number is proved at a bounded rate, and no faster.
const SEED: u64 = 160;

fn scenario() -> Scenario {
    at_rest(&mut Dice::new(SEED), drawn::structured)
}

/// With bounds of every kind; it takes seconds.
fn moving() -> &'static (Certificate, Rechecked) {
    static FOUND: OnceLock<(Certificate, Rechecked)> = OnceLock::new();
    FOUND.get_or_init(|| bounded(&scenario()).expect("bounded"))
}

/// The same without bounds.
fn proved() -> Certificate {
    let scenario = scenario();
    let plant = scenario.plant.linear().expect("linear");
    let controller = &scenario.controllers[0].controller;
    let description = LoopDescription::of(&scenario, plant, controller).expect("provable");
    let asked = Asked::of(&scenario, plant, &description);
    let outcome = certify(&description, &asked, &quick()).expect("provable");
    let Verdict::Proved(certificate, _) = outcome.verdict else { panic!("proved") };
    certificate
}

fn claim_of(certificate: &Certificate) -> &BoundedRate {
    let Claim::BoundedRate(claim) = &certificate.claim else { panic!("of a bounded rate") };
    claim
}

#[test]
fn no_motion_of_the_gains_within_their_rate_makes_more_of_a_disturbance_than_is_bounded() {
    let (certificate, rechecked) = moving();
    assert!(rechecked.keeps_to_the_rate);
    let corners = corners(certificate);
    let mut dice = Dice::new(7);
    // Standing still at a corner, from corner to corner without a stop, and resonances of some periods.
    let stays = [SAMPLES, SAMPLES, SAMPLES, SAMPLES, 1, 1, 1, 5, 20, 60];
    let motions: Vec<Vec<Gains<f64>>> = stays
        .into_iter()
        .map(|stay| motion(certificate, &corners, stay, &mut || dice.part()))
        .collect();
    let mut nearest = [0.0_f64; 2];
    for bound in &rechecked.disturbed {
        for gains in &motions {
            let share = share(certificate, bound, gains);
            assert!(share <= 1.0, "{bound:?}: {share} of it");
            let place = usize::from(bound.extent == Extent::Peak);
            nearest[place] = nearest[place].max(share);
        }
    }
    assert!(nearest[0] > 0.7 && nearest[1] > 0.3, "{nearest:?}");
}

#[test]
fn no_flight_goes_beyond_what_is_bounded_of_gains_at_a_bounded_rate() {
    let largest = attack_of(Dice::new(SEED), &scenario(), moving());
    assert!(largest[0] > 0.3 && largest[1] > 0.1, "{largest:?}");
}

#[test]
fn bounds_that_are_lowered_or_whose_form_is_another_do_not_hold() {
    let (certificate, _) = moving();
    let by_energy = certificate.disturbances.iter().find(|it| it.extent == Extent::Energy);
    let by_peak = certificate.disturbances.iter().find(|it| it.extent == Extent::Peak);
    let own = [by_energy.expect("one").clone(), by_peak.expect("one").clone()];
    let with = |change: &dyn Fn(&mut DisturbanceBound)| {
        own.clone().map(|mut bound| {
            change(&mut bound);
            Certificate { disturbances: vec![bound], ..certificate.clone() }.check().is_ok()
        })
    };
    assert_eq!(with(&|_| {}), [true, true]);
    assert_eq!(with(&|bound| bound.gain *= 0.9), [false, false]);
    assert_eq!(with(&|bound| bound.form = bound.form.scaled(0.5)), [false, false]);
    // Without what the gains add, or with the opposite of it, it is the form of no bound that was found.
    assert_eq!(with(&|bound| bound.by_gain = None), [false, false]);
    assert_eq!(
        with(&|bound| if let Some(by_gain) = &mut bound.by_gain {
            by_gain.iter_mut().for_each(|it| *it = it.scaled(-8.0));
        }),
        [false, false]
    );
    assert_eq!(
        with(&|bound| if let Some(by_gain) = &mut bound.by_gain {
            by_gain[0] = Matrix::identity(2);
        }),
        [false, false]
    );
}

#[test]
fn a_form_that_moves_with_a_gain_whose_rate_is_not_kept_bounds_nothing() {
    let certificate = proved();
    let claim = claim_of(&certificate);
    // Gains at half the rate that the law is known to keep to: the claim does not hold of it, nor a bound.
    let slower = BoundedRate { changes: claim.changes.map(|it| 0.5 * it), ..claim.clone() };
    let claim = Claim::BoundedRate(slower);
    let slower = Certificate { claim, level: None, steps: None, ..certificate.clone() };
    let alone = slower;
    assert!(!alone.check().expect("falls").keeps_to_the_rate);
    let scenario = scenario();
    let ways = ways_of(scenario.plant.linear().expect("linear"));
    let refused = bound_disturbances(&alone, &ways, &quick()).expect_err("not kept").to_string();
    assert!(refused.contains("not shown to keep"), "{refused}");
    let (bounded, _) = moving();
    let forged = Certificate { disturbances: bounded.disturbances.clone(), ..alone.clone() };
    let refused = forged.check().expect_err("not kept").to_string();
    assert!(refused.contains("not shown to keep to the rate in every flight"), "{refused}");
    let forged = Certificate { level: Some(1e-6), ..alone };
    let refused = forged.check().expect_err("not kept").to_string();
    assert!(refused.contains("a level of a law that is not shown to keep"), "{refused}");
}
