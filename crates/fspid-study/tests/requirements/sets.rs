//! Ready sets: complete, sourced, and the numbers of the handbook.

use fspid_aircraft::qualities::{Category, Level, cap_level};
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::{Confidence, Requirement, SET_NAMES, set};

use crate::requirements::{JUMBO, study, verified, written};

/// The requirements of a set under choices such as `level = 2`.
fn lines(name: &str, choices: &str) -> Vec<Requirement> {
    let text = format!("{JUMBO}\n[[requirement]]\nset = \"{name}\"\n{choices}");
    study(&text, &[]).requirements
}

#[test]
fn every_set_says_what_it_is_and_every_line_where_it_is_from_and_how_sure() {
    let names =
        ["mil-f-9490d", "mil-f-8785c", "ctms", "mil-f-9490d-altitude", "rvsm", "ac-25.1329"];
    assert_eq!(SET_NAMES, names);
    for name in SET_NAMES {
        let set = set(name).unwrap_or_else(|| panic!("{name} cannot be read"));
        assert_eq!(set.name, name);
        assert!(set.title.len() > 20 && set.source.len() > 10 && set.notes.len() > 50, "{name}");
        let lines = lines(name, "");
        assert!(lines.len() >= 2, "{name}");
        for line in lines {
            assert!(line.id.starts_with(&format!("{name}/")), "{}", line.id);
            let origin = &line.origin;
            assert_eq!(origin.set.as_deref(), Some(name));
            assert!(origin.clause.is_some() && origin.source.is_some(), "{}", line.id);
            assert!(origin.confidence.is_some(), "{}", line.id);
        }
    }
}

/// A table of the standard that was recalled stays marked so.
#[test]
fn no_line_of_a_standard_that_was_not_at_hand_claims_to_have_been_read() {
    for name in ["mil-f-9490d", "mil-f-8785c"] {
        for choices in ["", "air = \"turbulent\"", "speed = \"limit\"", "level = 2", "level = 3"] {
            if choices.starts_with("level") != (name == "mil-f-8785c") && !choices.is_empty() {
                continue;
            }
            for line in lines(name, choices) {
                let confidence = line.origin.confidence.expect("every line has one");
                assert!(
                    !matches!(confidence, Confidence::Read | Confidence::Quoted | Confidence::Own),
                    "{}",
                    line.id
                );
            }
        }
    }
    assert!(
        lines("mil-f-9490d", "").iter().all(|l| l.origin.confidence == Some(Confidence::Recalled))
    );
}

/// What a set asks, in the order of its lines: measure, least, most.
type Asked = (Measure, Option<f64>, Option<f64>);

fn asked(name: &str, choices: &str) -> Vec<Asked> {
    lines(name, choices).iter().map(|line| (line.measure, line.least, line.most)).collect()
}

#[test]
fn the_margins_are_those_of_the_table_by_speed_and_band() {
    use Measure::{GainMargin, PhaseMargin};
    let margins = |speed: &str| -> Vec<Asked> {
        let choices = format!("speed = \"{speed}\"\nfirst_aeroelastic_mode_hz = 2.5\n");
        let is_margin =
            |asked: &Asked| [GainMargin, PhaseMargin, Measure::Stable].contains(&asked.0);
        asked("mil-f-9490d", &choices).into_iter().filter(is_margin).collect()
    };
    let row = |db: f64, deg: f64| [(GainMargin, Some(db), None), (PhaseMargin, Some(deg), None)];
    assert_eq!(margins("normal"), [row(4.5, 30.0), row(6.0, 45.0), row(8.0, 60.0)].concat());
    assert_eq!(margins("limit"), [row(3.0, 20.0), row(4.5, 30.0), row(6.0, 45.0)].concat());
    assert_eq!(margins("below"), [(GainMargin, Some(6.0), None)]);
    assert_eq!(margins("beyond"), [(Measure::Stable, Some(1.0), None)]);
}

#[test]
fn bands_meet_at_six_hundredths_of_a_hertz_and_at_the_aeroelastic_mode() {
    let bands = |choices: &str| -> Vec<(Option<f64>, Option<f64>)> {
        let gains = lines("mil-f-9490d", choices);
        let gains = gains.iter().filter(|line| line.measure == Measure::GainMargin);
        gains.map(|line| (line.conditions.from_hz, line.conditions.to_hz)).collect()
    };
    let (low, mode) = (Some(0.06), Some(2.5));
    let elastic = "first_aeroelastic_mode_hz = 2.5";
    assert_eq!(bands(elastic), [(None, low), (low, mode), (mode, None)]);
    // A rigid aircraft has no mode above which anything could be asked.
    assert_eq!(bands(""), [(None, low), (low, None)]);
}

#[test]
fn the_air_decides_which_lines_of_attitude_hold_are_asked() {
    let of_hold = |choices: &str| -> Vec<Asked> {
        let all = asked("mil-f-9490d", choices);
        let kinds = [Measure::FinalErrorAngle, Measure::RecoveryTime, Measure::RmsError];
        all.into_iter().filter(|asked| kinds.contains(&asked.0)).collect()
    };
    let smooth =
        [(Measure::FinalErrorAngle, None, Some(0.5)), (Measure::RecoveryTime, None, Some(5.0))];
    assert_eq!(of_hold(""), smooth);
    assert_eq!(of_hold("air = \"smooth\""), smooth);
    assert_eq!(of_hold("air = \"turbulent\""), [(Measure::RmsError, None, Some(5.0))]);
    let damping = asked("mil-f-9490d", "").into_iter().find(|a| a.0 == Measure::ModeDamping);
    assert_eq!(damping, Some((Measure::ModeDamping, Some(0.3), None)));
}

#[test]
fn the_web_course_asks_for_its_four_numbers_at_a_step_of_two_tenths_of_a_radian() {
    let lines = lines("ctms", "");
    let numbers: Vec<Asked> = lines.iter().map(|l| (l.measure, l.least, l.most)).collect();
    assert_eq!(
        numbers,
        [
            (Measure::Overshoot, None, Some(10.0)),
            (Measure::RiseTime, None, Some(2.0)),
            (Measure::SettlingTime, None, Some(10.0)),
            (Measure::FinalError, None, Some(2.0)),
        ]
    );
    for line in &lines {
        let step_rad = line.conditions.step_deg.expect("a size").to_radians();
        assert!((step_rad - 0.2).abs() < 1e-15, "{step_rad}");
        assert_eq!(line.origin.confidence, Some(Confidence::Read));
    }
}

#[test]
fn phugoid_and_delay_are_those_of_the_handbook_at_every_level() {
    let of = |level: i32, measures: [Measure; 4]| -> Vec<Asked> {
        let all = asked("mil-f-8785c", &format!("level = {level}"));
        all.into_iter().filter(|asked| measures.contains(&asked.0)).collect()
    };
    let [swings, creeps] =
        [Measure::PhugoidOscillationDoubling, Measure::PhugoidDivergenceDoubling];
    let measures = [Measure::PhugoidDamping, swings, creeps, Measure::EquivalentDelay];
    let delay = |most: f64| (Measure::EquivalentDelay, None, Some(most));
    assert_eq!(of(1, measures), [(Measure::PhugoidDamping, Some(0.04), None), delay(0.10)]);
    assert_eq!(of(2, measures), [(Measure::PhugoidDamping, Some(0.0), None), delay(0.20)]);
    let level_3 = [(swings, Some(55.0), None), (creeps, Some(6.0), None), delay(0.25)];
    assert_eq!(of(3, measures), level_3);
}

/// The flying qualities of `fspid aircraft qualities` and the set must not differ.
#[test]
fn the_boxes_of_damping_and_cap_are_those_that_aircraft_are_judged_by() {
    let levels = [Level::One, Level::Two, Level::Three];
    for (category, word) in Category::ALL.into_iter().zip(["A", "B", "C"]) {
        for (number, level) in (1..=3).zip(levels) {
            let asked = asked("mil-f-8785c", &format!("level = {number}\ncategory = \"{word}\""));
            let of = |measure: Measure| asked.iter().find(|asked| asked.0 == measure).copied();
            let (_, zeta, zeta_most) = of(Measure::ShortPeriodDamping).expect("at every level");
            let zeta = zeta.expect("a lower bound");
            let cap = of(Measure::ControlAnticipation);
            assert_eq!(cap.is_none(), number == 3, "level 3 asks for damping alone");
            // A corner of the box belongs to the level, and a hair beyond it does not.
            let (low, high) = match cap {
                Some((_, Some(low), Some(high))) => (low, high),
                _ => (0.0, 1e6),
            };
            assert_eq!(cap_level(zeta, low, category), level, "{word} {number}");
            assert_eq!(cap_level(zeta, high, category), level, "{word} {number}");
            assert!(cap_level(zeta * 0.999_999, low, category) > level, "{word} {number}");
            if let Some(most) = zeta_most {
                assert_eq!(cap_level(most, low, category), level, "{word} {number}");
                assert!(cap_level(most * 1.000_001, low, category) > level, "{word} {number}");
            }
            if cap.is_some() {
                assert!(cap_level(zeta, low * 0.999_999, category) > level, "{word} {number}");
                assert!(cap_level(zeta, high * 1.000_001, category) > level, "{word} {number}");
            }
        }
    }
}

#[test]
fn a_set_twice_at_different_levels_gets_ids_of_its_own() {
    let twice = format!(
        "{JUMBO}\n[[requirement]]\nset = \"mil-f-8785c\"\n[[requirement]]\nset = \"mil-f-8785c\"\nlevel = 2\n"
    );
    let requirements = study(&twice, &[]).requirements;
    let mut ids: Vec<&str> = requirements.iter().map(|r| r.id.as_str()).collect();
    assert!(ids.contains(&"mil-f-8785c/cap") && ids.contains(&"mil-f-8785c/cap-2"), "{ids:?}");
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), requirements.len());
}

#[test]
fn a_set_s_own_step_is_flown_only_where_the_command_has_none_of_its_size() {
    let size_deg = 0.2_f64.to_degrees();
    let amplitude = format!("setpoint.amplitude_deg={size_deg}");
    // Down by half of it first, so that the way back up is a step of the size.
    let doublet = format!("setpoint.amplitude_deg={}", -0.5 * size_deg);
    let flown = |set: &[&str]| {
        let (_folder, path) = written(JUMBO);
        let verification = verified(&path, &[&["ctms", "loop.duration_s=20"], set].concat(), &[]);
        let steps = verification.judgements.iter().map(|it| it.own_step_deg);
        let steps: Vec<Option<f64>> = steps.collect();
        assert_eq!(steps.len(), 8);
        assert!(steps.iter().all(|step| *step == steps[0]), "{steps:?}");
        steps[0]
    };
    assert_eq!(flown(&["setpoint.amplitude_deg=5"]), Some(size_deg));
    assert_eq!(flown(&[&amplitude]), None);
    assert_eq!(flown(&[&amplitude, "setpoint.at_s=19.99"]), None);
    // At the last sample nothing can answer it.
    assert_eq!(flown(&[&amplitude, "setpoint.at_s=20"]), Some(size_deg));
    let width = ["setpoint.kind=doublet", "setpoint.width_s=6"];
    assert_eq!(flown(&[&width[..], &[doublet.as_str()]].concat()), None);
    assert_eq!(flown(&[&width[..], &[amplitude.as_str()]].concat()), None);
    assert_eq!(flown(&[&width[..], &["setpoint.amplitude_deg=5"]].concat()), Some(size_deg));
}
