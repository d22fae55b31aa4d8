//! Bounds of disturbances in certificates: flown through gusts, edited, of another aircraft.

use std::path::Path;
use std::sync::OnceLock;

use fspid_proof::{AirPart, Disturbed, Extent, Quantity, Verdict, Way};
use fspid_sim::simulate;
use serde_json::{Value, json};

use super::{Answer, Certification, Effort, check_text, file::resealed, to_text};
use fspid_scenario::file::{self, Study};

fn effort() -> Effort {
    Effort { halvings: 0, largest_factor: 1.0, ..Effort::default() }
}

fn gust(overrides: &[&str]) -> Study {
    let path = "../../scenarios/gallery/one-minus-cosine.toml";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let overrides = ["aircraft.model=linear"].iter().chain(overrides);
    let overrides: Vec<String> = overrides.map(|text| (*text).to_owned()).collect();
    file::load(&path, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

fn bounded() -> &'static (Certification, String) {
    static FOUND: OnceLock<(Certification, String)> = OnceLock::new();
    FOUND.get_or_init(|| {
        let study = gust(&[]);
        let found = Certification::of(&study, None, &effort())
            .and_then(|it| it.with_disturbances(&study, &effort(), &mut |_| {}))
            .expect("certified");
        let [one] = found.results.as_slice() else { panic!("one loop") };
        let text = to_text(one.certificate().expect("a certificate"), &one.origin);
        (found, text)
    })
}

fn disturbed() -> &'static [Disturbed] {
    let outcome = bounded().0.results[0].outcome.as_ref().expect("provable");
    let Verdict::Proved(_, rechecked) = &outcome.verdict else { panic!("proved") };
    &rechecked.disturbed
}

fn sealed(value: &Value) -> String {
    resealed(value).unwrap_or_else(|| value.to_string())
}

/// The peak of the pitch angle by that of one motion of the air, rad.
fn per_unit(part: AirPart) -> f64 {
    let is_asked = |it: &&Disturbed| {
        matches!(&it.way, Way::Air { part: own, .. } if *own == part)
            && (it.quantity, it.extent) == (Quantity::Pitch, Extent::Peak)
    };
    disturbed().iter().find(is_asked).expect("bounded").per_unit
}

#[test]
fn gusts_of_every_length_move_the_pitch_angle_by_no_more_than_is_bounded() {
    let mut nearest = 0.0_f64;
    for gradient_m in [8.0, 15.0, 30.0, 60.0, 100.0] {
        for up_m_s in [6.0, -9.0] {
            let gradient = format!("gust[0].gradient_m={gradient_m}");
            let up = format!("gust[0].up_m_s={up_m_s}");
            let flight = simulate(&gust(&[&gradient, &up]).scenario).expect("flies");
            let angles = flight.traces[0].theta_rad.iter();
            let flown_rad = angles.fold(0.0_f64, |most, it| most.max(it.abs()));
            // The air turns as it rises: the slope of one minus cosine is the largest halfway.
            let size = f64::abs(up_m_s);
            let turning_rad_s = size * core::f64::consts::PI / (2.0 * gradient_m);
            let most_rad =
                per_unit(AirPart::Vertical) * size + per_unit(AirPart::Turning) * turning_rad_s;
            assert!(flown_rad <= most_rad, "{gradient_m} m: {flown_rad} of {most_rad}");
            nearest = nearest.max(flown_rad / most_rad);
        }
    }
    // A gust is short, and its two parts are bounded as if each chose its own worst time.
    assert!(nearest > 0.05, "{nearest}");
}

/// What a sine of wind did to the pitch angle by its energy: a certificate that bounds gusts along and across the body axis, of a Navion
/// whose trim has 7.0 deg of angle of attack, and a flight straight up and down the wind.
#[test]
fn gusts_of_other_axes_do_what_those_along_and_across_the_body_axis_do_together() {
    const CALM: &str = "schema = 1\nname = \"slow\"\n[aircraft]\nname = \"navion\"\nairspeed_kt = 70.0\naltitude_ft = 1000.0\nmodel = \"linear\"\n\
        [actuator]\ntime_constant_s = 0.1\n[loop]\nsample_period_s = 0.01\nduration_s = 250.0\n[setpoint]\nkind = \"step\"\namplitude_deg = 0.0\nat_s = 1.0\n\
        [[controller]]\nname = \"PID\"\nkind = \"pid\"\nkp = 0.82\nki = 0.43\nkd = 0.165\nderivative_filter_s = 0.05\n";
    let study = file::parse(CALM, "calm", None, &[]).unwrap_or_else(|error| panic!("{error}"));
    let found = Certification::of(&study, None, &effort())
        .and_then(|it| it.with_disturbances(&study, &effort(), &mut |_| {}))
        .expect("certified");
    let Verdict::Proved(_, rechecked) =
        &found.results[0].outcome.as_ref().expect("provable").verdict
    else {
        panic!("proved")
    };
    let gain = |wanted: AirPart| {
        let is_asked = |it: &&Disturbed| {
            matches!(&it.way, Way::Air { part, .. } if *part == wanted)
                && (it.quantity, it.extent) == (Quantity::Pitch, Extent::Energy)
        };
        rechecked.disturbed.iter().find(is_asked).expect("bounded").per_unit
    };
    let [along, across] = [gain(AirPart::Forward), gain(AirPart::Vertical)];
    // 60 cycles at the frequency of which the loop makes the most, from 1 s on.
    let (frequency_rad_s, step_s) = (1.7545, 0.05);
    let count = (60.0 * core::f64::consts::TAU / frequency_rad_s / step_s) as usize;
    let times_s: Vec<f64> = (0..=count).map(|n| 1.0 + step_s * n as f64).collect();
    let up_m_s: Vec<f64> =
        times_s.iter().map(|time_s| (frequency_rad_s * (time_s - 1.0)).sin()).collect();
    let pairs = || up_m_s.windows(2);
    let energy: f64 =
        pairs().map(|it| step_s * (it[0] * it[0] + it[0] * it[1] + it[1] * it[1]) / 3.0).sum();
    let wind =
        format!("[wind]\nkind = \"table\"\ntime_s = {times_s:?}\nup_m_s = {up_m_s:?}\n[loop]");
    let windy = CALM.replace("[loop]", &wind);
    let windy = file::parse(&windy, "windy", None, &[]).unwrap_or_else(|error| panic!("{error}"));
    let flight = simulate(&windy.scenario).expect("flies");
    let squares: f64 = flight.traces[0].theta_rad.iter().map(|it| it * it).sum();
    let flown = (squares * 0.01 / energy).sqrt();
    assert!(
        flown > across,
        "a vertical gust is not the one across the body axis: {flown} {across}"
    );
    let (sine, cosine) = 7.0_f64.to_radians().sin_cos();
    assert!(flown <= cosine * across + sine * along, "{flown} of {across} and {along}");
    let told = found.text();
    assert!(
        told.contains("in level flight a vertical gust is one across it times the cosine"),
        "{told}"
    );
    assert!(!told.contains("as the file says that the plant feels them"), "{told}");
}

/// A file with invented numbers held, without a word that nobody computed them.
#[test]
fn bounds_of_a_file_say_that_how_the_plant_feels_the_air_is_the_file_s_word() {
    let mut checked = check_text(&bounded().1).expect("a certificate");
    let words = "as the file says that the plant feels them; that this plant does is computed by --against SCENARIO";
    assert!(checked.text().contains(words), "{}", checked.text());
    checked.compare(&gust(&[])).expect("linear");
    assert!(!checked.text().contains(words), "{}", checked.text());
}

#[test]
fn bounds_are_read_again_and_compared_with_the_air_that_flies() {
    let text = &bounded().1;
    let mut checked = check_text(text).expect("a certificate");
    assert_eq!(checked.result.as_ref().expect("holds").disturbed, disturbed());
    checked.compare(&gust(&[])).expect("linear");
    assert_eq!(checked.answer(), Answer::Holds);
    let told = checked.text();
    for words in [
        "from rest, a gust across the body axis of at most 1 m/s, however it changes, moves the pitch angle by at most",
        "from rest, the L2 gain of a gust along the body axis of any shape is at most",
        "disturbances together do no more than the sum of what each does",
        "Moving air counts by the bounds above, from rest, as gusts along the body axis, gusts across it through the angle of attack, turning in pitch; any other motion of it is left out.",
    ] {
        assert!(told.contains(words), "{told}");
    }
    // Fixed gains do not move.
    assert!(!told.contains("with gains moving"), "{told}");
    let bounds = checked.json()["scope"]["disturbances"].clone();
    assert_eq!(bounds.as_array().map(Vec::len), Some(16));
    assert_eq!(bounds[2]["enters"], "elevator");
    assert_eq!(bounds[2]["unit"], "deg");
}

#[test]
fn a_gust_that_acts_in_another_way_is_told_with_its_place() {
    let mut value: Value = serde_json::from_str(&bounded().1).expect("JSON");
    let bounds = value["disturbances"].as_array_mut().expect("bounds");
    let vertical = bounds.iter_mut().find(|it| it["enters"] == "vertical-gust").expect("one");
    let weaker = vertical["numerator"].as_array().expect("numbers").iter();
    let weaker: Vec<f64> = weaker.map(|it| 0.5 * it.as_f64().expect("a number")).collect();
    vertical["numerator"] = json!(weaker);
    let mut checked = check_text(&sealed(&value)).expect("a certificate");
    checked.compare(&gust(&[])).expect("linear");
    // What is proved of a gust that is half as strong is proved; it is not the one that flies.
    assert!(checked.result.is_ok() && checked.answer() == Answer::AnotherLoop);
    let against = checked.against.expect("compared");
    let [one] = against.differences.as_slice() else { panic!("{against:?}") };
    assert!(one.path.starts_with("disturbances[") && one.path.ends_with("].numerator"));
}

#[test]
fn what_does_not_fit_together_is_refused_by_name() {
    let with = |change: &dyn Fn(&mut Value)| {
        let mut value: Value = serde_json::from_str(&bounded().1).expect("JSON");
        change(&mut value["disturbances"][0]);
        match check_text(&sealed(&value)) {
            Ok(checked) => checked.result.expect_err("refused").to_string(),
            Err(refused) => refused.to_string(),
        }
    };
    assert!(with(&|it| it["numerator"] = json!([1.0])).contains("a numerator at the elevator"));
    assert!(with(&|it| it["enters"] = json!("vertical-gust")).contains("without a numerator"));
    assert!(with(&|it| it["enters"] = json!("aileron")).contains("\"vertical-gust\""));
    assert!(with(&|it| it["decay"] = json!(0.5)).contains("decay is 1 of an energy"));
    assert!(with(&|it| it["gain"] = json!(-1.0)).contains("numbers above 0"));
    assert!(with(&|it| it["form"] = json!([[1.0]])).contains("disturbances.form"));
    // This loop is proved however fast its gains move; forms of its bounds do not.
    let moved = with(&|it| it["by_gain"] = json!([it["form"], it["form"], it["form"]]));
    assert!(moved.contains("a form moves with the gains where the claim is about their rate"));
    assert!(with(&|it| it["by_gain"] = json!([it["form"]])).contains("by_gain"));
}
