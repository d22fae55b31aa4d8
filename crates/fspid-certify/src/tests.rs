//! Certificates that are edited, hostile, of another loop, or about nothing that flies.

use std::path::Path;
use std::sync::OnceLock;

use fspid_proof::{Bearing, Claim, Verdict};
use serde_json::{Value, json};

use super::{
    Answer, Certification, CheckedFile, Effort, Seal, check_text, check_text_until,
    file::{Read, read, resealed},
    from_text, scope_in_short, to_text,
};
use fspid_scenario::file::{self, Study};

/// No largest output scale is asked for: the verdict alone.
fn effort() -> Effort {
    Effort { halvings: 0, largest_factor: 1.0, ..Effort::default() }
}

pub(super) fn load(path: &str, overrides: &[&str]) -> Study {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    file::load(&path, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

fn design(overrides: &[&str]) -> Study {
    load("data/designs/b747-paper.toml", overrides)
}

pub(super) fn certified(study: &Study) -> Certification {
    Certification::of(study, Some("FSPID"), &effort()).expect("certified")
}

pub(super) fn written(certification: &Certification) -> String {
    let [one] = certification.results.as_slice() else { panic!("one loop") };
    to_text(one.certificate().expect("a certificate"), &one.origin)
}

/// The certificate of a shipped design, written now.
fn good() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| written(&certified(&design(&[]))))
}

fn good_value() -> Value {
    serde_json::from_str(good()).expect("JSON")
}

pub(super) fn checked(text: &str) -> CheckedFile {
    check_text(text).unwrap_or_else(|error| panic!("{error}"))
}

/// A refutation of gains that stand still: the 747 at 2.4 times the output scale.
fn refuted() -> &'static Certification {
    static FOUND: OnceLock<Certification> = OnceLock::new();
    FOUND.get_or_init(|| {
        let scaled = [
            "controller.FSPID.supervisor.output_scale.kp=0.48",
            "controller.FSPID.supervisor.output_scale.ki=0.12",
            "controller.FSPID.supervisor.output_scale.kd=0.24",
        ];
        certified(&load("scenarios/747-pitch-step.toml", &scaled))
    })
}

/// Paths of everything in a value, itself first; of long lists the first two.
fn places(value: &Value) -> Vec<String> {
    let mut places = vec![String::new()];
    let below = |places: &mut Vec<String>, step: &str, value: &Value| {
        places.extend(self::places(value).into_iter().map(|rest| format!("/{step}{rest}")));
    };
    match value {
        Value::Object(map) => {
            map.iter().for_each(|(key, value)| below(&mut places, key, value));
        }
        Value::Array(values) => {
            let some = values.iter().enumerate().take(2);
            some.for_each(|(place, value)| below(&mut places, &place.to_string(), value));
        }
        _ => {}
    }
    places
}

fn hostile() -> Vec<Value> {
    let mut nested = json!([]);
    for _ in 0..100 {
        nested = json!([nested]);
    }
    vec![
        json!(null),
        json!(true),
        json!(""),
        json!("NaN"),
        json!("none"),
        json!("exact"),
        json!("x".repeat(100_000)),
        json!("\u{0}\u{202e}"),
        json!("midpoint:4000000000"),
        json!("midpoint:1000000"),
        json!(0),
        json!(-0.0),
        json!(-1),
        json!(0.5),
        json!(1),
        json!(95),
        json!(10_000),
        json!(u64::MAX),
        json!(i64::MIN),
        json!(5e-324),
        json!(1e-30),
        json!(1e30),
        json!(f64::MAX),
        json!([]),
        json!([0.0, 0.0]),
        json!(vec![1.0; 33]),
        json!(vec![0.5; 100_000]),
        json!(vec![vec![0.0; 300]; 300]),
        json!({}),
        nested,
    ]
}

#[test]
fn a_delay_of_ten_thousand_samples_is_refused_before_anything_is_computed() {
    // It used to take 6.6 GB: the loop was enclosed before the form was looked at.
    for (pointer, large) in [("/loop/actuator/delay_samples", 10_000), ("/divisions", 1000)] {
        let mut value = good_value();
        *value.pointer_mut(pointer).expect("there") = json!(large);
        let text = value.to_string();
        let used = allocation_counter::measure(|| {
            let refused = check_text(&text).expect_err("too large").to_string();
            let path = pointer.trim_start_matches('/').replace('/', ".");
            assert!(refused.starts_with(&format!("{path}: found {large}; allowed")), "{refused}");
        });
        assert!(used.bytes_max < 1 << 20, "{used:?}");
    }
}

#[test]
fn a_form_of_another_size_is_refused_before_the_loop_is_enclosed() {
    let mut value = good_value();
    value["loop"]["actuator"]["delay_samples"] = json!(60);
    let text = resealed(&value).expect("a shape");
    let used = allocation_counter::measure(|| {
        let told = checked(&text).text();
        assert!(told.contains("DOES NOT HOLD: claim.form: 8 rows; the loop asks for 68"), "{told}");
        assert!(told.contains("claim.form: 8 columns; the loop asks for 68"), "{told}");
    });
    assert!(used.count_total < 5000 && used.bytes_max < 1 << 20, "{used:?}");
}

/// Checks a certificate with every hostile value at a place: with so many allocations and so much memory.
fn attack(whole: &Value, pointer: &str, values: &[Value], most_count: u64) {
    for value in values {
        let mut edited = whole.clone();
        *edited.pointer_mut(pointer).expect("there") = value.clone();
        let text = resealed(&edited).unwrap_or_else(|| edited.to_string());
        let used = allocation_counter::measure(|| {
            let _ = check_text(&text).map(|checked| (checked.text(), checked.json()));
        });
        let most_bytes = (64 << 20) + 20 * text.len() as u64;
        let found = value.to_string();
        let found = found.get(..40).unwrap_or(&found);
        assert!(used.bytes_max < most_bytes, "{pointer} = {found}: {used:?}");
        assert!(used.count_total < most_count, "{pointer} = {found}: {used:?}");
    }
}

#[test]
fn no_value_anywhere_makes_a_check_large() {
    let honest = allocation_counter::measure(|| assert!(checked(good()).holds()));
    let most_count = 40 * honest.count_total;
    for pointer in [
        "/divisions",
        "/output_factor",
        "/loop/sample_period_s",
        "/loop/actuator/delay_samples",
        "/loop/rate_sensing/samples",
        "/controller/tuner/defuzzifier",
        "/controller/tuner/range",
        "/claim/rate",
    ] {
        attack(&good_value(), pointer, &hostile(), most_count);
    }
    // Everywhere, of a claim that is lost at its first inequality and with some of the values, one in turn but in the long
    // checks, so that the test is over soon.
    let some = [json!(null), json!("NaN"), json!(-1), json!(f64::MAX), json!(vec![0.5; 100_000])];
    let each = if std::env::var_os("FSPID_LONG_TESTS").is_some() { some.len() } else { 1 };
    let mut lost = good_value();
    lost["claim"]["rate"] = json!(1e-3);
    lost["divisions"] = json!(2);
    let mut values = some.into_iter().cycle();
    for pointer in places(&lost).iter().filter(|pointer| *pointer != "/claim/rate") {
        let values: Vec<_> = values.by_ref().take(each).collect();
        attack(&lost, pointer, &values, most_count);
    }
}

#[test]
fn every_edit_is_told_names_and_digests_too() {
    let whole = good_value();
    for pointer in places(&whole).into_iter().filter(|pointer| !pointer.is_empty()) {
        let mut removed = whole.clone();
        let (parent, key) = pointer.rsplit_once('/').expect("a path");
        match removed.pointer_mut(parent).expect("there") {
            Value::Object(map) => drop(map.remove(key)),
            Value::Array(values) => drop(values.remove(key.parse::<usize>().expect("a place"))),
            _ => continue,
        }
        let mut changed = vec![removed];
        let other = match whole.pointer(&pointer).expect("there") {
            Value::Number(number) => json!(number.as_f64().expect("a float") * 0.75 + 0.25),
            Value::String(text) => json!(format!("{text} ")),
            Value::Null => json!(1.0),
            _ => json!(null),
        };
        let mut edited = whole.clone();
        *edited.pointer_mut(&pointer).expect("there") = other.clone();
        if whole.pointer(&pointer) != Some(&other) {
            changed.push(edited);
        }
        for value in changed {
            // A broken seal holds nothing, whatever the inequalities say; that is tested above.
            let is_whole = |read: Read| matches!(read.seal, Seal::Whole);
            let whole = read(&value.to_string()).is_ok_and(is_whole);
            assert!(!whole, "{pointer} was edited and the certificate is whole");
        }
    }
    let named = good().replace("747 pitch hold, proved", "A320 pitch hold, proved");
    assert_eq!(checked(&named).answer(), Answer::Edited);
    let told = checked(&named).text();
    assert!(told.contains("content_digest is") && !told.contains("\nHOLDS"), "{told}");
    let mut zero = good_value();
    zero["origin"]["digest"] = json!("0".repeat(64));
    let refused = check_text(&resealed(&zero).expect("a shape")).expect_err("no digest");
    assert!(
        refused.to_string().starts_with("origin.digest: found a text of 64 characters; allowed"),
        "{refused}"
    );
}

#[test]
fn all_problems_are_told_at_once_with_their_paths() {
    let mut value = good_value();
    value["loop"]["actuator"]["delay_samples"] = json!(10_000);
    value["claim"]["rate"] = json!(1.5);
    value["claim"]["form"][2][3] = json!("NaN");
    value["controller"]["gain"] = json!(1.0);
    value["origin"].as_object_mut().expect("keys").remove("scenario");
    let text =
        value.to_string().replacen("\"rate_gain_s\"", "\"kd\":1,\"kd\":2,\"rate_gain_s\"", 1);
    let refused = check_text(&text).expect_err("wrong").to_string();
    let expected = [
        "controller.kd: stands more than once",
        "origin.scenario: is missing",
        "loop.actuator.delay_samples: found 10000; allowed are whole numbers from 0 to 128",
        "controller.kd: is not a key of a certificate",
        "controller.gain: is not a key of a certificate",
        "claim.rate: found 1.5; allowed are numbers above 0, up to 1.0",
        "claim.form[2][3]: found \"NaN\"; allowed are finite numbers up to 1e150 in magnitude",
    ];
    assert_eq!(refused.lines().collect::<Vec<_>>(), expected);
}

#[test]
fn a_claim_about_another_output_scale_is_no_proof_of_the_flown_loop() {
    // `output_factor: 0` used to make every certificate hold: of gains that stand still.
    for factor in [0.0, 0.5, 1.0_f64.next_up(), 1.0_f64.next_down()] {
        let mut value = good_value();
        value["output_factor"] = json!(factor);
        let checked = checked(&resealed(&value).expect("a shape"));
        if checked.result.is_err() {
            continue;
        }
        assert_eq!(checked.answer(), Answer::SaysNothing(Bearing::OtherScale { factor }));
        assert!(!checked.holds());
        let (told, json) = (checked.text(), checked.json());
        assert!(told.contains("NO PROOF OF THE FLOWN LOOP") && !told.contains("HOLDS"), "{told}");
        assert_eq!(json["holds"], false, "{json}");
        assert_eq!(json["bearing"], "nothing-other-output-scale", "{json}");
    }
}

#[test]
fn a_frozen_refutation_says_that_the_flown_loop_may_still_settle() {
    let certification = refuted();
    let [one] = certification.results.as_slice() else { panic!("one loop") };
    let certificate = one.certificate().expect("a refutation");
    assert!(matches!(certificate.claim, Claim::FrozenGrowth { .. }), "{:?}", certificate.claim);
    let sentence = "this refutes gains that stand still; in flight the gains move on, and the flown loop may still settle";
    let told = certification.text();
    assert!(
        told.contains("REFUTED FOR GAINS THAT STAND STILL") && told.contains(sentence),
        "{told}"
    );
    let json = certification.json();
    assert_eq!(json["controllers"][0]["bearing_in_words"], sentence, "{json}");
    let checked = checked(&written(certification));
    assert_eq!(checked.answer(), Answer::Refutes(Bearing::GrowsStandingStill));
    let told = checked.text();
    assert!(told.contains(sentence) && !told.contains("HOLDS"), "{told}");
    assert_eq!(checked.json()["holds"], false);
}

#[test]
fn the_loop_that_is_refuted_standing_still_settles_in_flight() {
    let scaled = [
        "controller.FSPID.supervisor.output_scale.kp=0.48",
        "controller.FSPID.supervisor.output_scale.ki=0.12",
        "controller.FSPID.supervisor.output_scale.kd=0.24",
        "loop.duration_s=400",
    ];
    for amplitude in ["setpoint.amplitude_deg=1", "setpoint.amplitude_deg=60"] {
        let study = load("scenarios/747-pitch-step.toml", &[&scaled[..], &[amplitude]].concat());
        let simulation = fspid_study::simulation::Simulation::of(&study).expect("it flies");
        let result = simulation.result("FSPID").expect("it was flown");
        assert!(result.metrics.first_step().settling_time_s.is_ok(), "{amplitude}");
    }
}

#[test]
fn a_check_says_what_the_proof_said_of_its_scope() {
    let study = design(&[]);
    let certification = certified(&study);
    let [proof, check] = [certification.text(), checked(good()).text()];
    let about = ["holds for", "remains", "limits", "not in this claim", ""];
    let scope = |text: &str| -> Vec<String> {
        let heads: Vec<String> = about.iter().map(|it| format!("  {it:<18} ")).collect();
        let is_one = |line: &&str| heads.iter().any(|head| line.starts_with(head.as_str()));
        text.lines().filter(is_one).map(str::to_owned).collect()
    };
    assert_eq!(scope(&proof), scope(&check), "{proof}\n{check}");
    assert!(scope(&check).len() >= 5, "{check}");
    for word in ["set-point", "none acts", "Rounding"] {
        assert!(check.contains(word), "{check}");
    }
    let [proof, check] = [certification.json()["controllers"][0].clone(), checked(good()).json()];
    assert_eq!(proof["scope"], check["scope"]);
    let sentences = check["scope"]["sentences"].as_array().expect("sentences");
    let told = checked(good()).text();
    assert!(sentences.iter().all(|it| told.contains(it.as_str().expect("text"))), "{told}");
}

/// A step of 1 deg, and a proportional controller of 3.5287 on a plant that needs 0.73436 of elevator for each of pitch.
#[test]
fn an_error_that_stays_is_told_in_sentences_in_numbers_and_in_a_cell_of_a_table() {
    let study = load("scenarios/747-pitch-step.toml", &[]);
    let certification = Certification::of(&study, Some("PC"), &effort()).expect("certified");
    let told = "REST IS SEEN UP TO 0.172259 deg FROM THE SET-POINT, at set-points up to 1 deg";
    assert!(certification.text().contains(told), "{}", certification.text());
    let off_deg = &certification.json()["controllers"][0]["scope"]["rest_error_deg"];
    assert!((off_deg.as_f64().expect("a number") - 0.172_259_0).abs() < 1e-7, "{off_deg}");
    let Ok(outcome) = &certification.results[0].outcome else { panic!("an answer") };
    let Verdict::Proved(certificate, rechecked) = &outcome.verdict else { panic!("proved") };
    let cell = scope_in_short(certificate, rechecked);
    assert!(cell.contains("every constant set-point") && cell.contains(told), "{cell}");
}

#[test]
fn what_a_certificate_says_of_its_scope_cannot_be_taken_away() {
    for key in ["range", "not_in_this_claim", "limits", "level", "content_digest"] {
        let mut value = good_value();
        value.as_object_mut().expect("keys").remove(key);
        assert!(!check_text(&value.to_string()).is_ok_and(|it| it.holds()), "{key}");
    }
    // Taken away with care, it says so in words.
    let mut value = good_value();
    value.as_object_mut().expect("keys").remove("level");
    let text = resealed(&value).expect("a shape");
    let refused = check_text(&text).expect_err("limits and level do not fit").to_string();
    assert!(refused.starts_with("limits: says \"none-acts-within-the-level\""), "{refused}");
    value["limits"] = json!("left-out");
    let told = checked(&resealed(&value).expect("a shape")).text();
    assert!(told.contains("SATURATION IS NOT COVERED"), "{told}");
}

#[test]
fn a_dispersion_is_said_to_be_left_out() {
    let text = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/designs/b747-paper.toml"),
    );
    let text = text.expect("readable")
        + "\n[[dispersion]]\npath = \"controller.FSPID.nominal.kp\"\ndistribution = \"uniform\"\nlower = 3.9\nupper = 4.1\n";
    let study = file::parse(&text, "dispersed.toml", None, &[]).unwrap_or_else(|it| panic!("{it}"));
    let certification = certified(&study);
    let nominal = "nominal";
    assert!(certification.text().contains(nominal), "{}", certification.text());
    let written = written(&certification);
    assert!(written.contains("\"dispersions\""), "{written}");
    let checked = checked(&written);
    assert!(checked.holds() && checked.text().contains(nominal), "{}", checked.text());
    let said = checked.json()["scope"]["not_in_this_claim"].to_string();
    assert!(said.contains("\"dispersions\""), "{said}");
    // A certificate of the scenario without it does not speak for the one with it.
    let mut plain = self::checked(good());
    plain.compare(&study).expect("comparable");
    let told = plain.text();
    assert!(told.contains("not_in_this_claim: certified nothing, flown \"dispersions\""), "{told}");
    assert_eq!(plain.answer(), Answer::AnotherLoop);
}

#[test]
fn every_field_that_flies_otherwise_is_told_with_both_values() {
    let mut same = checked(good());
    same.compare(&design(&[])).expect("comparable");
    assert!(same.holds(), "{}", same.text());
    assert!(same.text().ends_with("HOLDS, AND IS WHAT FLIES\n"), "{}", same.text());
    let changes = [
        "controller.FSPID.nominal.kp=4.5",
        "actuator.time_constant_s=0.2",
        "name=\"another\"",
        "setpoint.amplitude_deg=170",
    ];
    let mut other = checked(good());
    other.compare(&design(&changes)).expect("comparable");
    let told = other.text();
    for expected in [
        "origin.scenario: certified \"747 pitch hold, proved\", flown \"another\"",
        "controller.gains.kp: certified 4.0, flown 4.5",
        "loop.actuator.lag.time_constant_s: certified 0.1, flown 0.2",
        "the scenario's text has changed: digest certified",
        "DOES NOT HOLD FOR THIS SCENARIO",
    ] {
        assert!(told.contains(expected), "{expected}\n{told}");
    }
    // The claim holds of its own loop: the first line does not say otherwise.
    let first = told.lines().next().expect("a line");
    assert!(first.contains(": a claim that DOES NOT HOLD FOR THIS SCENARIO: "), "{first}");
    assert_eq!(other.json()["against"]["same"], false);
    assert!(other.json()["against"]["differences"].as_array().is_some_and(|it| it.len() >= 3));
}

#[test]
fn a_scenario_without_the_certified_controller_is_told() {
    let mut value = good_value();
    value["origin"]["controller"] = json!("Autopilot");
    let mut checked = checked(&resealed(&value).expect("a shape"));
    checked.compare(&design(&[])).expect("comparable");
    let told = checked.text();
    assert!(told.contains("origin.controller: certified Autopilot, flown "), "{told}");
    assert_eq!(checked.answer(), Answer::AnotherLoop);
}

#[test]
fn a_check_that_nobody_waits_for_any_more_proves_nothing() {
    let checked = check_text_until(good(), || true).expect("a certificate");
    assert_eq!(checked.answer(), Answer::NotProved);
    assert!(!checked.holds() && check_text_until(good(), || false).expect("one").holds());
}

#[test]
fn layout_and_digits_of_a_certificate_do_not_matter() {
    let compact = good_value().to_string();
    assert!(checked(&compact).holds());
    let digits = good().replace("\"output_factor\": 1.0", "\"output_factor\": 1.000");
    assert_eq!(checked(&digits).seal, Seal::Whole);
    let (certificate, origin) = from_text(good()).expect("a certificate");
    assert_eq!(to_text(&certificate, &origin), good());
}

#[test]
fn what_the_servo_cannot_hold_is_open_and_said_to_be_so() {
    let study = design(&["setpoint.amplitude_deg=60"]);
    let certification = Certification::of(&study, Some("PID"), &effort()).expect("certified");
    assert!(!certification.all_proved());
    let told = certification.text();
    for part in [
        "OPEN for what the scenario asks (constant set-points up to 60 deg",
        "proved is less: stable with its gains, which are fixed",
        "open because       rest at 60.00 deg needs 44.06 deg, and the servo's command limit is at 15.00 deg",
        "none acts where the pitch angle begins up to",
    ] {
        assert!(told.contains(part), "{part}\n{told}");
    }
    let json = certification.json();
    let one = &json["controllers"][0];
    assert_eq!(one["asked"]["setpoint_within_deg"], 60.0, "{one}");
    assert!(one["open_because"].as_str().is_some_and(|it| it.contains("44.06")), "{one}");
    // Said once: in the scope.
    assert!(one.get("limits").is_none() && one.get("pitch_within_deg").is_none(), "{one}");
    assert!(one["scope"]["pitch_within_deg"].is_number(), "{one}");
    // The certificate of the design does not speak for it, although its inequalities hold for every set-point.
    let mut shipped = checked(good());
    shipped.compare(&study).expect("comparable");
    assert_eq!(shipped.answer(), Answer::AnotherLoop);
    assert!(shipped.text().contains("range.setpoint_rad: certified"), "{}", shipped.text());
}

#[test]
fn a_refutation_says_nothing_of_set_points_that_move() {
    let told = refuted().text();
    assert!(!told.contains("constant set-points"), "{told}");
}

#[test]
fn a_pitch_loop_is_not_called_proved_where_the_outer_loops_around_it_grow() {
    // Its third mode doubles in 0.58 s; the pitch loop inside is held.
    let grows = load("crates/fspid-scenario/tests/scenarios/every-key-autopilot.toml", &[]);
    let found = Certification::of(&grows, None, &effort()).expect("certified");
    assert!(!found.all_proved(), "{}", found.text());
    let told = found.text();
    assert!(
        told.contains("NOT PROVED as it flies: UNSTABLE with the outer loops of mode"),
        "{told}"
    );
    let answer = found.json();
    assert_eq!(answer["controllers"][0]["verdict"], json!("not proved as it flies"));
    assert_eq!(answer["controllers"][0]["bearing"], json!("pitch-loop-stable"));
    assert_eq!(answer["controllers"][0]["outer_loops"]["held"], json!(false));

    let held = load("scenarios/gallery/turn.toml", &[]);
    let found = Certification::of(&held, None, &effort()).expect("certified");
    assert!(found.text().contains("PROVED for the pitch loop alone: "), "{}", found.text());
    assert!(!found.text().contains("the flown loop is stable"), "{}", found.text());
    for certified in found.results.iter().filter(|it| it.is_proved()) {
        let text = to_text(certified.certificate().expect("a certificate"), &certified.origin);
        assert_eq!(checked(&text).bearing(), Some(Bearing::PitchLoopStable));
    }
}

#[test]
fn the_requirement_of_a_proof_is_not_met_where_outer_loops_grow() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fspid-scenario/tests/scenarios");
    let text = std::fs::read_to_string(folder.join("every-key-autopilot.toml")).expect("a file");
    let text = format!("{text}\n[[requirement]]\nmeasure = \"certified\"\n");
    let study = file::parse(&text, "autopilot.toml", Some(&folder), &[]).expect("a scenario");
    let flown = fspid_study::simulation::Simulation::of(&study).expect("flown");
    // A pitch loop that is proved, which alone would be a value of 1.
    let [judgement] = flown.judgements.as_slice() else { panic!("one requirement") };
    assert!(!judgement.met && judgement.found.as_ref().is_ok_and(|case| case.value == 0.0));
}

/// Whether `FSPID` of a learned design is proved around the trim at a flight condition, and its certificate holds.
fn is_proved_at(design: &str, condition: [String; 3]) {
    let [name, speed, altitude] = &condition;
    let path = format!("data/designs/learned/{design}.toml");
    let study = load(&path, &[name, speed, altitude, "setpoint.amplitude_deg=0"]);
    let found = certified(&study);
    assert!(found.all_proved(), "{condition:?}: {}", found.text());
    assert!(checked(&written(&found)).holds(), "{condition:?}");
}

#[test]
fn the_learned_self_tuner_of_six_light_aircraft_is_proved_around_the_trim_where_it_was_tuned() {
    // Three of the twelve: the slowest, the fastest and the one that is proved with the least room.
    for (name, speed, altitude) in
        [("navion", 120, 0), ("beech-99", 450, 20000), ("twin-otter", 165, 0)]
    {
        is_proved_at(
            "light-six",
            [
                format!("aircraft.name={name}"),
                format!("aircraft.airspeed_ft_s={speed}"),
                format!("aircraft.altitude_ft={altitude}"),
            ],
        );
    }
}

#[test]
fn the_learned_self_tuner_of_six_small_unmanned_aircraft_is_proved_around_the_trim_where_it_was_tuned()
 {
    // Two of the twelve: the slowest and the fastest.
    for (name, speed, altitude) in [("zagi", 14, 100), ("aerosonde", 33, 1500)] {
        is_proved_at(
            "uav-six",
            [
                format!("aircraft.name={name}"),
                format!("aircraft.airspeed_m_s={speed}"),
                format!("aircraft.altitude_m={altitude}"),
            ],
        );
    }
}
