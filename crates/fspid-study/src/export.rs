//! A controller of a study in another language: which one is meant, if it can leave, and what its code is called.

use fspid_diagnostics::digits::to_six_decimals;
use fspid_diagnostics::listed;
use fspid_export::program::Precision;
use fspid_export::{Angles, Export, LoopWord, Request, Target, export_called, prefix, prefixes};
use fspid_scenario::file::{Study, known_words};
use fspid_scenario::tuning::TunableParameter;
use fspid_scenario::units::degrees;
use fspid_sim::stability::Unstable;
use fspid_sim::{Controller, ElevatorSign, NamedController, Plant};

use crate::analysis::AtRest;
use crate::metrics::Verdict;

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The controller's name; may be left out where there is only one.
    pub controller: Option<&'a str>,
    /// In which language.
    pub target: Target,
    /// With which digits; those that the target's users expect if left out.
    pub precision: Option<Precision>,
    /// In which unit angles go in and come out.
    pub angles: Angles,
    /// How many samples the vectors have.
    pub samples: usize,
    /// How many points a table has along each input.
    pub points: usize,
    /// What names in the code begin with; made of the controller's name if left out.
    pub prefix: Option<&'a str>,
    /// Data for a review is asked for, which C has.
    pub evidence: bool,
}

impl Question<'_> {
    /// Samples of the vectors where nobody asks for another number.
    pub const SAMPLES: u32 = 20_000;

    /// What is asked for where nothing but the target is said.
    #[must_use]
    pub const fn of(target: Target) -> Self {
        Self {
            controller: None,
            target,
            precision: None,
            angles: Angles::Radians,
            samples: Self::SAMPLES as usize,
            points: fspid_export::table::POINTS,
            prefix: None,
            evidence: false,
        }
    }
}

/// Why there is no export.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// Several fly, and none is named.
    #[error("--controller NAME is missing; the scenario flies {flown}")]
    NoName {
        /// Those that fly.
        flown: String,
    },
    /// Nobody has that name.
    #[error("there is no controller `{name}`{known}")]
    Unknown {
        /// The name.
        name: String,
        /// The known ones, in words.
        known: String,
    },
    /// Numbers of it are still to be found.
    #[error(
        "{path} is marked for tuning; `fspid tune FILE --out design.toml` writes a design, which can be exported"
    )]
    NotTuned {
        /// Where the first of them is.
        path: String,
    },
    /// It cannot be said in that language, or not with those digits.
    #[error(transparent)]
    Export(#[from] fspid_export::ExportError),
}

/// The controller of a study that is meant.
///
/// # Errors
/// [`ExportError`]: none of that name, several and no name, one with numbers that are still to be tuned.
pub fn chosen<'a>(
    study: &'a Study,
    name: Option<&str>,
) -> Result<&'a NamedController, ExportError> {
    let controllers = &study.scenario.controllers;
    let names: Vec<&str> = controllers.iter().map(|named| named.name.as_str()).collect();
    let found = match (name, controllers.as_slice()) {
        (None, [only]) => only,
        (None, _) => return Err(ExportError::NoName { flown: listed(&names) }),
        (Some(name), all) => all.iter().find(|named| named.name == name).ok_or_else(|| {
            ExportError::Unknown { name: name.to_owned(), known: known_words(name, &names) }
        })?,
    };
    tuned(study, &found.name)?;
    Ok(found)
}

/// Refuses a controller that is not tuned yet.
fn tuned(study: &Study, name: &str) -> Result<(), ExportError> {
    let free = |mark: &&TunableParameter| mark.controller().is_none_or(|it| it == name);
    match study.tunable_parameters.iter().find(free) {
        None => Ok(()),
        Some(mark) => Err(ExportError::NotTuned { path: mark.path.text().to_owned() }),
    }
}

/// The controller in another language, with vectors that show that it answers alike.
///
/// # Errors
/// As [`chosen`], and what the language has no words for.
pub fn export(study: &Study, asked: &Question<'_>) -> Result<Export, ExportError> {
    let named = chosen(study, asked.controller)?;
    let request = Request {
        name: &named.name,
        target: asked.target,
        precision: asked.precision.unwrap_or(asked.target.usual_precision()),
        angles: asked.angles,
        samples: asked.samples,
        points: asked.points,
        digest: &study.digest,
        elevator: elevator_in_words(study, &named.controller, asked.angles),
        its_loop: Some(loop_in_words(study, named)),
        evidence: asked.evidence,
    };
    let called = asked.prefix.map_or_else(|| called(study, &named.name), str::to_owned);
    Ok(export_called(&named.controller, &request, &called)?)
}

/// What is known of a controller's loop: whether it is stable, at rest and by its flight. Whether the flight is good is not said.
fn loop_in_words(study: &Study, named: &NamedController) -> LoopWord {
    let at_rest = AtRest::of(&study.scenario, &named.controller);
    let at_rest = at_rest.as_flown(&study.scenario, named);
    let is_in_doubt = at_rest.stability_word() != Some("stable");
    let words = match at_rest.unstable {
        _ if !is_in_doubt => "stable at rest".to_owned(),
        Some(Unstable { spectral_radius, doubling_s, .. }) => {
            Verdict::Unstable { spectral_radius, doubling_s }.to_string()
        }
        None => at_rest
            .undecided_in_words()
            .or_else(|| at_rest.not_asked_in_words())
            .unwrap_or_else(|| "stability at rest could not be asked".to_owned()),
    };
    LoopWord { words, is_in_doubt }
}

/// For which elevator a controller was designed: the way that it turns, and who limits it. None where another simulator has
/// an elevator of its own.
fn elevator_in_words(study: &Study, controller: &Controller, angles: Angles) -> Option<String> {
    let scenario = &study.scenario;
    let sign = match &scenario.plant {
        Plant::Linear(plant) => plant.elevator_sign(),
        Plant::Aircraft(_) => ElevatorSign::NoseDownPositive,
        Plant::External(_) => return None,
    };
    let command = format!("command_{}", angles.unit());
    let turns = match sign {
        ElevatorSign::NoseDownPositive => format!(
            "whose elevator is positive trailing edge down, which turns the nose down: elevator = -{command}"
        ),
        ElevatorSign::NoseUpPositive => {
            format!("whose elevator is positive where it turns the nose up: elevator = {command}")
        }
    };
    let not_here = match controller.config().limits {
        Some(_) => "",
        None => ", not here",
    };
    let actuator = &scenario.actuator;
    let limited = actuator.travel_rad().or(actuator.command_limits_rad()).map(|(least, most)| {
        let [least, most] = [least, most].map(|it| to_six_decimals(degrees(it)));
        format!("travel beyond {least} to {most} deg of command is cut there{not_here}")
    });
    let limited = limited.unwrap_or_else(|| "no travel is cut there".to_owned());
    Some(format!("Designed for an aircraft {turns}; {limited}."))
}

/// What its code is called, which no other controller of the scenario is.
fn called(study: &Study, name: &str) -> String {
    let names: Vec<&str> = study.scenario.controllers.iter().map(|it| it.name.as_str()).collect();
    let mut all = names.iter().zip(prefixes(&names)).filter(|(it, _)| **it == name);
    all.next().map_or_else(|| prefix(name), |(_, own)| own)
}

#[cfg(test)]
mod tests {
    use fspid_scenario::file;

    use super::*;

    const DESIGN: &str = r#"
schema = 1
name = "a design"
[plant]
numerator = [-36.11]
denominator = [1.0, 5.3, 24.7]
elevator_sign = "nose-down-positive"
[actuator]
time_constant_s = 0.05
position_limit_deg = 25.0
[loop]
sample_period_s = 0.01
duration_s = 1.0
[setpoint]
kind = "step"
amplitude_deg = 5.0
at_s = 0.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.5
ki = 0.5
kd = 0.15
"#;

    fn exported(target: Target, set: &[&str]) -> Export {
        let set: Vec<String> = set.iter().map(|&it| it.to_owned()).collect();
        let study = file::parse(DESIGN, "design.toml", None, &set).expect("a design");
        export(&study, &Question { samples: 3, ..Question::of(target) }).expect("it can leave")
    }

    #[test]
    fn what_is_not_known_to_hold_leaves_with_a_warning() {
        let warned = |set: &[&str]| {
            let notes = exported(Target::C, set).notes;
            notes.into_iter().find(|it| it.starts_with("warning: of the loop of this scenario: "))
        };
        assert_eq!(warned(&[]), None);
        let unstable = warned(&["controller.PID.kp=40.0"]).expect("it is unstable");
        assert!(unstable.contains("unstable at rest (doubles every"), "{unstable}");
        let slow = [
            "plant.denominator=[1.0, 5.3, -24.7]",
            "setpoint.amplitude_deg=60.0",
            "controller.PID.kp=4.0",
        ];
        let undecided = warned(&slow).expect("it takes more than there is");
        assert!(undecided.contains("undecided"), "{undecided}");
    }

    /// The text of every file without what marks a comment and where lines are broken.
    fn said(export: &Export) -> Vec<(String, String)> {
        let plain = |bytes: &[u8]| {
            let text = String::from_utf8_lossy(bytes).into_owned();
            let words = text
                .split_whitespace()
                .filter(|word| !["*", "//", "--", "//!", "(*", "*)"].contains(word));
            words.collect::<Vec<_>>().join(" ")
        };
        export.files.iter().map(|file| (file.name.clone(), plain(&file.bytes))).collect()
    }

    /// "Nose up is positive" alone was all that an integrator had.
    #[test]
    fn code_says_for_which_elevator_it_was_designed() {
        let told = "Designed for an aircraft whose elevator is positive trailing edge down, which turns the nose down: elevator = -command_rad; travel beyond -25 to 25 deg of command is cut there, not here.";
        let names = [
            (Target::C, &[".h", ".ino"][..]),
            (Target::Lua, &[".lua"]),
            (Target::Rust, &[".rs"]),
            (Target::StructuredText, &[".st"]),
        ];
        for (target, ends) in names {
            let files = said(&exported(target, &[]));
            for end in ends {
                let mut own = files.iter().filter(|(name, _)| name.ends_with(end));
                let found = own.any(|(_, text)| text.contains(told));
                let all: Vec<&String> = files.iter().map(|(name, _)| name).collect();
                assert!(found, "{target:?} {end} of {all:?}");
            }
        }
    }

    #[test]
    fn the_other_sign_and_own_limits_are_told_as_they_are() {
        let told = |set: &[&str]| said(&exported(Target::C, set))[0].1.clone();
        let up =
            told(&["plant.elevator_sign=nose-up-positive", "actuator.position_limit_deg=20.0"]);
        let words = "whose elevator is positive where it turns the nose up: elevator = command_rad; travel beyond -20 to 20 deg of command is cut there, not here.";
        assert!(up.contains(words), "{up}");
        let own = told(&["controller.PID.output_limits_deg=[-15.0, 15.0]"]);
        assert!(own.contains("is cut there.") && !own.contains("not here"), "{own}");
    }
}
