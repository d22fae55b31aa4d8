//! The facts of the paper's surfaces by name.

use std::sync::OnceLock;

use fspid_fuzzy::Defuzzifier;
use fspid_fuzzy::audit::{
    AlongInput, RuleEffect, Statement, SurfaceAudit, SurfaceOptions, surface,
};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::norm::TNormKind;
use fspid_fuzzy::system::{self, Conclusion, Membership, SetReading, System};

use super::{MIRRORED, PRINTED, parts, system};

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
    static SYSTEM: OnceLock<System> = OnceLock::new();
    let system = SYSTEM.get_or_init(|| system(PRINTED));
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
fn no_point_of_the_paper_s_surfaces_lies_outside_of_the_proved_bounds() {
    let step = 1e-6;
    for n in 0..600 {
        let fraction = |factor: f64| (f64::from(n) * factor).fract() * 9.99 - 4.995;
        let point = [fraction(0.618_033_988_7), fraction(0.414_213_562_4)];
        for (output, proved) in printed().outputs.iter().enumerate() {
            let here = value(&point, output);
            assert!(proved.least.bounds[0] <= here && here <= proved.most.bounds[1]);
            for (input, along) in proved.along.iter().enumerate() {
                let mut next = point;
                next[input] += step;
                let slope = (value(&next, output) - here) / step;
                assert!(along.least_slope.bounds[0] <= slope + 1e-6, "{point:?} {slope}");
                assert!(slope <= along.most_slope.bounds[1] + 1e-6, "{point:?} {slope}");
                let axis = [[point[0], 0.0], [0.0, point[1]]][input];
                let chord = (value(&axis, output) - value(&[0.0; 2], output)) / axis[input];
                let [least, most] = &along.sector;
                assert!(least.bounds[0] <= chord + 1e-9 && chord <= most.bounds[1] + 1e-9);
            }
        }
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

#[test]
fn a_hole_in_the_rules_shows_as_a_point_where_little_fires() {
    let mut parts = parts(PRINTED, Defuzzifier::Exact);
    parts.blocks[0].rules[24].enabled = false;
    let audit = surface(&System::new(parts).expect("a sound system"), &few()).expect("universes");
    let coverage = &audit.outputs[KP].coverage;
    let [lower, upper] = coverage.least.bounds;
    // At the centre of the missing cell the neighbours fire to 1/16.
    assert!(lower <= 0.0625 && 0.0625 <= upper + 1e-12, "{coverage:?}");
    assert!(lower > 0.0 && coverage.least.at.iter().all(|x| x.abs() < 0.1), "{coverage:?}");
}

#[test]
fn a_rule_that_repeats_another_has_no_effect_and_a_term_out_of_reach_is_dead() {
    let mut parts = parts(PRINTED, Defuzzifier::Exact);
    let mut weaker = parts.blocks[0].rules[8].clone();
    weaker.weight = 0.5;
    parts.blocks[0].rules.push(weaker);
    let mut far = parts.inputs[0].terms[6].clone();
    let (kind, params) = (ShapeKind::Triangle, vec![6.0, 7.0, 8.0]);
    far.membership = Membership::Shape { kind, params, height: 1.0 };
    far.name = "far".into();
    parts.inputs[0].terms.push(far);
    let audit = surface(&System::new(parts).expect("a sound system"), &few()).expect("universes");
    let last = audit.rules.last().expect("fifty rules");
    assert!(matches!(last, RuleEffect::None { rule } if rule.rule == 49), "{last:?}");
    assert_eq!(audit.terms[0][7].highest.bounds, [0.0; 2]);
    assert!(audit.terms[0][6].highest.bounds[0] > 0.9);
}

/// Little work, for questions that are settled early.
fn few() -> SurfaceOptions {
    SurfaceOptions { boxes: 300, ..SurfaceOptions::default() }
}

/// $y = \tfrac12 (x_0 + x_1)$ exactly, from product rules over complementary ramps.
fn bilinear() -> System {
    let mut parts = parts(PRINTED, Defuzzifier::Exact);
    for input in &mut parts.inputs {
        input.terms.truncate(2);
        for (term, params) in input.terms.iter_mut().zip([[5.0, -5.0], [-5.0, 5.0]]) {
            let (kind, params) = (ShapeKind::Ramp, params.to_vec());
            term.membership = Membership::Shape { kind, params, height: 1.0 };
        }
    }
    parts.outputs.truncate(1);
    let output = &mut parts.outputs[0];
    output.defuzzifier = system::Defuzzifier::WeightedAverage(SetReading::Tsukamoto);
    output.terms.truncate(3);
    for (term, place) in output.terms.iter_mut().zip([-5.0, 0.0, 5.0]) {
        term.conclusion = Conclusion::Constant(place);
    }
    let block = &mut parts.blocks[0];
    block.and = TNormKind::AlgebraicProduct.into();
    let cells = [(0, 0), (0, 1), (7, 1), (8, 2)];
    let rules = [0, 1, 7, 8].map(|rule| block.rules[rule].clone());
    block.rules = rules.into();
    for (rule, (_, term)) in block.rules.iter_mut().zip(cells) {
        rule.consequents.truncate(1);
        rule.consequents[0].term = term;
    }
    System::new(parts).expect("a sound system")
}

#[test]
fn a_plane_made_of_product_rules_is_proved_monotone_with_its_slopes() {
    let options =
        SurfaceOptions { boxes: 9_000, slope_tolerance: 2e-3, ..SurfaceOptions::default() };
    let audit = surface(&bilinear(), &options).expect("universes are known");
    let plane = &audit.outputs[0];
    for (extreme, value) in [(&plane.least, -5.0), (&plane.most, 5.0)] {
        assert!(extreme.settled && extreme.bounds.iter().all(|b| (b - value).abs() < 1e-6));
    }
    for along in &plane.along {
        assert_eq!(along.monotone.statement, Statement::Proved, "{along:?}");
        assert!(along.monotone.rises && along.monotone.wrong_share == [0.0; 2]);
        assert!(along.lipschitz[1] < 0.55 && along.lipschitz[0] > 0.499, "{along:?}");
        assert!(along.sector.iter().all(|end| (end.bounds[0] - 0.5).abs() < 2e-3));
    }
    assert!(plane.odd.departure.bounds[1] < 2e-3);
    assert_eq!(plane.exchange[0].1.statement, Statement::Proved);
}

#[test]
fn sampled_centroids_are_bounded_as_they_are_computed() {
    let parts = parts(PRINTED, Defuzzifier::Endpoints(101));
    let system = System::new(parts).expect("a sound system");
    let audit = surface(&system, &few()).expect("universes are known");
    let mut workspace = system.workspace();
    for (output, proved) in audit.outputs.iter().enumerate() {
        let corners = [[-5.0, -5.0], [5.0, 5.0], [5.0, -5.0], [0.0, 0.0]];
        for point in corners {
            let answers = system.evaluate(&point, &mut workspace).expect("finite");
            let here = answers[output].value.expect("rules fire");
            assert!(
                proved.least.bounds[0] <= here + 1e-12 && here <= proved.most.bounds[1] + 1e-12
            );
        }
        // The largest answer of this rule is 4.36, not the 4.44 of the centroid itself.
        assert!(proved.most.bounds[1] < 4.5 && proved.least.bounds[0] > -4.5);
    }
}

/// It used to be said of such a rule that it does nothing, because another is always stronger; but
/// without it the shares of all the others are larger.
#[test]
fn a_rule_that_takes_a_share_of_the_strength_is_never_said_to_have_no_effect() {
    let mut parts = parts(PRINTED, Defuzzifier::Exact);
    let mut weaker = parts.blocks[0].rules[8].clone();
    weaker.weight = 0.5;
    parts.blocks[0].rules.push(weaker);
    parts.blocks[0].activation = system::Activation::Proportional;
    let audit = surface(&System::new(parts).expect("a sound system"), &few()).expect("universes");
    let none = audit.rules.iter().find(|rule| matches!(rule, RuleEffect::None { .. }));
    assert_eq!(none, None);
}
