//! The page of `fspid certify`: sound, with every sentence and number of the answer, and the same each time.

use std::path::Path;

use fspid_certify::{Cases, Certification, CertifiedCases, Effort, Question, Subject, check_text};
use fspid_scenario::file::Template;
use serde_json::Value;

use crate::as_read::as_read;
use crate::sound::assert_sound;

fn effort() -> Effort {
    Effort { halvings: 0, largest_factor: 1.0, ..Effort::default() }
}

fn template(path: &str, set: &[&str]) -> Template {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    Template::load(&path, &set).unwrap_or_else(|error| panic!("{error}"))
}

fn question(effort: &Effort) -> Question<'_> {
    Question { only: None, disturbances: false, family: false, nonlinear: false, effort }
}

fn answered(template: &Template, question: Question<'_>) -> (Certification, String) {
    let found = Certification::answering(template, question, &mut |_| {}).expect("it is linear");
    let subject = Subject { study: template.study(), question, folder: None };
    let page = found.page(subject).expect("certificates can be written");
    assert_sound(&page);
    (found, page)
}

/// Every sentence of the text stands in the page.
fn assert_says_all(page: &str, text: &str) {
    /// Width of what a sentence is about.
    const ABOUT: usize = 21;
    let page = as_read(page);
    for line in text.lines().skip(1).filter(|line| line.starts_with("  ")) {
        let is_sentence =
            line.get(ABOUT - 1..ABOUT) == Some(" ") && !line[2..].starts_with("PROVED");
        let sentence = if is_sentence { &line[ABOUT..] } else { &line[2..] };
        assert!(page.contains(sentence.trim()), "{sentence}");
    }
}

/// The number beside what it is, in a table of a page.
fn number_beside(page: &str, what: &str) -> f64 {
    let (_, rest) = page.split_once(&format!("<th scope=\"row\">{what}</th>")).expect(what);
    let (_, rest) = rest.split_once("data-label=\"value\">").expect("a value");
    rest.split_once("</td>").expect("closed").0.parse().expect("a number")
}

#[test]
fn a_page_of_steps_through_limits_has_every_sentence_and_every_number_of_the_answer() {
    let (template, effort) = (template("scenarios/limits.toml", &[]), effort());
    let asked = Question { only: Some("none"), disturbances: true, ..question(&effort) };
    let (found, page) = answered(&template, asked);
    assert_says_all(&page, &found.text());
    assert!(page.contains(">every, while no limit acts</td>"), "no range without its condition");
    let answer = found.json();
    let scope = &answer["controllers"][0]["scope"];
    for (what, key) in [
        ("steps of the set-point from rest, up to", "steps_within_deg"),
        ("steps of a load at once, up to", "steps_load_within_deg"),
        ("no limit acts any more after a step by", "steps_limited_until_s"),
        ("flights as commanded, set-point up to", "flights_setpoint_within_deg"),
        ("no limit acts any more in those flights from", "flights_limited_until_s"),
    ] {
        let value = scope[key].as_f64().expect(key);
        assert!((number_beside(&page, what) - value).abs() < 1e-6, "{what}: {value}");
    }
    let pitch_deg = scope["pitch_within_deg"].as_f64().expect("limits are covered");
    let told = number_beside(&page, "pitch angle off rest from which no limit acts, up to");
    assert!(told <= pitch_deg && told > 0.99 * pitch_deg, "{told} {pitch_deg}");
    let gains = answer["controllers"][0]["gains"].as_object().expect("gains");
    for end in gains.values().filter_map(Value::as_array).flatten().filter_map(Value::as_f64) {
        let told = fspid_page::number::significant(end, 6);
        assert!(page.contains(&format!(">{told}</td>")), "{told}");
    }
    let file = &found.certificate_files().expect("written")[0];
    assert!(
        page.contains(&format!("--check DIR/{} --against FILE", file.name).replace('/', "&#x2f;"))
    );
    let command = "fspid certify FILE --controller none --disturbances --report OUT.html";
    assert!(page.contains(command), "{command}");
}

/// Bytes of a page come from the answer alone.
#[test]
fn two_pages_of_an_answer_have_the_same_bytes_and_names_stay_text() {
    let hostile = "controller[]={ name = \"<b onload='x'>&</h2>\", kind = \"pid\", kp = 2.0, ki = 0.5, kd = 1.0 }";
    let set = [hostile, "name=\"<script>1</script>\""];
    let (template, effort) = (template("scenarios/747-pitch-step.toml", &set), effort());
    let asked = Question { only: Some("<b onload='x'>&</h2>"), ..question(&effort) };
    let [(found, one), (_, other)] = [(), ()].map(|()| answered(&template, asked));
    assert!(one == other);
    assert_says_all(&one, &found.text());
    assert!(one.matches("<script").count() == 1 && !one.contains("<b onload"));
    assert!(one.contains("\u{2713} PROVED") && !one.contains("verdict bad"));
}

#[test]
fn what_is_refuted_or_not_provable_looks_like_neither_proved_nor_good() {
    let set = ["controller.PC.kp=-3.5", "controller.CPID.kp=-2.0"];
    let (template, effort) = (template("scenarios/747-pitch-step.toml", &set), effort());
    let asked = Question { only: Some("CPID"), ..question(&effort) };
    let (found, page) = answered(&template, asked);
    assert_says_all(&page, &found.text());
    assert!(found.text().contains("REFUTED") && page.contains("\u{2717} REFUTED"));
    assert!(!page.contains("verdict good"));
}

#[test]
fn a_family_has_its_box_in_a_table_and_what_it_lacks_on_the_card() {
    const DRAWN: &str = "dispersion[]={ name = \"servo\", path = \"actuator.time_constant_s\", distribution = \"uniform\", lower = 0.05, upper = 0.12 }";
    let (template, effort) = (template("scenarios/747-pitch-step.toml", &[DRAWN]), effort());
    let asked = Question { only: Some("CPID"), family: true, ..question(&effort) };
    let (found, page) = answered(&template, asked);
    assert_says_all(&page, &found.text());
    assert!(page.contains("The box of the family") && page.contains("actuator.time_constant_s"));
    assert_eq!(page.contains("verdict good"), found.all_proved());
}

/// They stood there as if every combination of them were meant, of which the law reaches a part.
#[test]
fn gains_of_which_the_law_does_not_reach_every_combination_are_told_so() {
    const TOLD: &str = "(not every combination of these: those that the law reaches)";
    let set = ["aircraft.name=navion", "aircraft.airspeed_ft_s=120", "setpoint.amplitude_deg=0"];
    let effort = effort();
    for (path, set, only, is_told) in [
        ("data/designs/learned/light-six.toml", &set[..], "FSPID", true),
        ("scenarios/747-pitch-step.toml", &[][..], "CPID", false),
    ] {
        let template = template(path, set);
        let asked = Question { only: Some(only), ..question(&effort) };
        let (found, page) = answered(&template, asked);
        let (text, answer) = (found.text(), found.json());
        assert_eq!(answer["controllers"][0]["every_combination_of_gains"], !is_told, "{text}");
        let checked = check_text(&found.certificate_files().expect("written")[0].text);
        let checked = checked.expect("a certificate");
        assert_eq!(checked.json()["every_combination_of_gains"], !is_told);
        for said in [text, as_read(&page), checked.text()] {
            assert_eq!(said.contains(TOLD), is_told, "{said}");
        }
    }
}

#[test]
fn a_page_of_cases_has_a_section_for_each() {
    let (path, effort) = ("scenarios/747-pitch-step.toml", effort());
    let choice = "dispersion[]={ name = \"delay\", path = \"actuator.delay_samples\", distribution = \"choice\", values = [0, 2] }";
    let template = template(path, &[choice]);
    let set = [choice.to_owned()];
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    let asked = Question { only: Some("CPID"), ..question(&effort) };
    let source = (file.as_path(), set.as_slice());
    let study = template.study();
    let found = CertifiedCases::answering(source, study, Cases::Choices, asked, &mut |_| {});
    let found = found.expect("cases");
    let page = found.page(Subject { study, question: asked, folder: Some("proofs") });
    let page = page.expect("certificates can be written");
    assert_sound(&page);
    let read = as_read(&page);
    for case in found.cases() {
        assert!(read.contains(&format!(". {}</h2>", case.change.name)), "{}", case.change.name);
    }
    for line in found.text().lines().filter(|line| line.starts_with("  ")) {
        let sentence = line.split_once(": ").map_or(line, |(_, sentence)| sentence);
        let sentence = sentence.trim_start_matches("  not in this claim  ");
        assert!(read.contains(sentence), "{sentence}");
    }
    assert!(read.contains("--cases choices") && read.contains("--check proofs/"), "commands");
    // A certificate is held against the scenario with what its case sets.
    for delay in [0, 2] {
        assert!(read.contains(&format!("--set actuator.delay_samples={delay}")), "{delay}");
    }
}
