//! The facts of the paper's surfaces by name.

use std::sync::OnceLock;

use fspid_fuzzy::audit::{
    AlongInput, RuleEffect, Statement, SurfaceAudit, SurfaceOptions, surface,
};

use super::{MIRRORED, PRINTED, system};

const KP: usize = 0;
const KI: usize = 1;
const KD: usize = 2;

/// As much work as a test may take; the example asks for more.
fn options() -> SurfaceOptions {
    SurfaceOptions { boxes: 9_000, ..SurfaceOptions::default() }
}

/// Asked once for all tests.
fn printed() -> &'static SurfaceAudit {
    static AUDIT: OnceLock<SurfaceAudit> = OnceLock::new();
    AUDIT.get_or_init(|| surface(&system(PRINTED), &options()).expect("universes are known"))
}

fn along(output: usize, input: usize) -> &'static AlongInput {
    &printed().outputs[output].along[input]
}

fn holds([lower, upper]: [f64; 2], value: f64) -> bool {
    lower <= value && value <= upper
}

#[test]
fn the_paper_s_extremes_are_proved_to_a_millionth() {
    let known = [
        [-4.234089847555, 4.444385106649],
        [-4.444274913314, 4.444274913314],
        [-4.234089847408, 3.902748775224],
    ];
    for (output, [least, most]) in printed().outputs.iter().zip(known) {
        for (extreme, value) in [(&output.least, least), (&output.most, most)] {
            let [lower, upper] = extreme.bounds;
            assert!(extreme.settled && upper - lower < 1e-6, "{extreme:?}");
            assert!(holds([lower - 1e-9, upper + 1e-9], value), "{value} {extreme:?}");
        }
    }
}

#[test]
fn the_paper_s_supervisor_is_biased_at_rest() {
    let known = [0.216500696638, 0.0, -1.666610153842];
    for (output, value) in printed().outputs.iter().zip(known) {
        let [lower, upper] = output.at_rest;
        assert!(upper - lower < 1e-9 && holds([lower - 1e-12, upper + 1e-12], value));
    }
}

#[test]
fn some_rule_fires_to_one_half_everywhere() {
    for output in &printed().outputs {
        let [lower, upper] = output.coverage.least.bounds;
        assert!(lower > 0.5 - 1e-8 && upper < 0.5 + 1e-8, "{:?}", output.coverage);
        assert_eq!(output.coverage.statement, Statement::Proved);
        // Half way between two centres.
        let gaps = output.coverage.least.at.iter().map(|x| (x * 0.6 + 3.0).fract());
        assert!(gaps.into_iter().all(|gap| (gap - 0.5).abs() < 1e-6));
    }
}

#[test]
fn the_steepest_sampled_slopes_lie_below_the_proved_lipschitz_constants() {
    // Largest slopes among samples, as the reference tells them to three digits.
    let sampled = [[1.2235, 1.2235], [1.2235, 1.2235], [3.065, 3.249]];
    for (output, slopes) in [KP, KI, KD].into_iter().zip(sampled) {
        for (input, slope) in slopes.into_iter().enumerate() {
            let [found, proved] = along(output, input).lipschitz;
            assert!(proved >= slope && found >= slope - 0.01, "{output} {input}: {found} {proved}");
            assert!(proved <= 1.5 * slope, "{output} {input}: {proved}");
        }
    }
}

#[test]
fn monotone_labels_do_not_make_a_monotone_surface() {
    let known = [
        (KP, 0, false, 0.5936, 0.058),
        (KP, 1, false, 0.5936, 0.060),
        (KI, 0, true, 0.5936, 0.067),
        (KI, 1, true, 0.5515, 0.066),
    ];
    for (output, input, rises, worst, share) in known {
        let monotone = &along(output, input).monotone;
        assert_eq!(monotone.rises, rises);
        assert!(holds(monotone.wrong_share, share), "{:?}", monotone.wrong_share);
        let [lower, upper] = monotone.worst;
        assert!(lower > worst - 1e-2 && upper < worst + 5e-2, "{:?}", monotone.worst);
        let Statement::Refuted(example) = &monotone.statement else { panic!("{monotone:?}") };
        let [from, to] = [&example.from, &example.to].map(|point| value(point, output));
        assert!(if rises { to < from } else { to > from }, "{example:?}");
        assert!(example.from[input] < example.to[input]);
    }
}

fn value(point: &[f64], output: usize) -> f64 {
    let system = system(PRINTED);
    let mut workspace = system.workspace();
    let answers = system.evaluate(point, &mut workspace).expect("finite");
    answers[output].value.expect("rules fire")
}

#[test]
fn the_paper_s_surfaces_depart_from_oddness_by_1_51_and_1_31() {
    for (output, departure) in [(KP, 1.5125), (KI, 1.3065)] {
        let odd = &printed().outputs[output].odd;
        let [lower, upper] = odd.departure.bounds;
        assert!(lower < departure && departure < upper && upper - lower < 2e-3, "{odd:?}");
        let Statement::Refuted(point) = &odd.statement else { panic!("{odd:?}") };
        let opposite: Vec<f64> = point.iter().map(|x| -x).collect();
        assert!((value(point, output) + value(&opposite, output)).abs() > 1.3);
    }
}

#[test]
fn every_rule_of_the_paper_leads_somewhere_and_every_term_is_reached() {
    let audit = printed();
    assert_eq!(audit.rules.len(), 49);
    for effect in &audit.rules {
        let RuleEffect::Leads { changes, .. } = effect else { panic!("{effect:?}") };
        assert!(changes.iter().flatten().any(|change| change.abs() > 1e-3), "{effect:?}");
    }
    assert!(audit.terms.iter().flatten().all(|term| term.highest.bounds[0] > 0.999));
}

#[test]
fn the_mirrored_table_is_proved_even_and_refuted_to_be_odd() {
    let options = SurfaceOptions { boxes: 60, ..SurfaceOptions::default() };
    let audit = surface(&system(MIRRORED), &options).expect("universes are known");
    for output in &audit.outputs {
        assert_eq!(output.even.statement, Statement::Proved);
        assert!(matches!(output.odd.statement, Statement::Refuted(_)), "{:?}", output.odd);
    }
}

#[test]
fn a_smaller_budget_makes_wider_bounds_and_says_so() {
    let options = SurfaceOptions { boxes: 20, ..SurfaceOptions::default() };
    let audit = surface(&system(PRINTED), &options).expect("universes are known");
    let (rough, fine) = (&audit.outputs[KP], &printed().outputs[KP]);
    assert!(!rough.most.settled);
    assert!(rough.most.bounds[0] <= fine.most.bounds[1]);
    assert!(fine.most.bounds[0] <= rough.most.bounds[1]);
    assert!(rough.most.bounds[1] - rough.most.bounds[0] > 1e-6);
    assert!(matches!(rough.along[0].monotone.statement, Statement::Refuted(_) | Statement::Open));
}
