//! Aircraft: trimmed, linearised, their modes.

use fspid::scenario::aircraft::Units;
use fspid::study::aircraft::{Question, VelocityForm, check, linearise, list, modes, show, trim};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::error;

/// The aircraft that fspid carries.
#[pyfunction]
pub(crate) fn aircraft_list() -> Answer {
    let found = list();
    Answer::new(found.text(), &found.json(), true)
}

/// What is asked of an aircraft: what, its name or file, speed, altitude, angle of climb.
#[pyfunction]
pub(crate) fn aircraft(
    py: Python<'_>,
    what: &str,
    name: &str,
    speed: Option<&str>,
    altitude: Option<&str>,
    climb_angle: Option<&str>,
) -> PyResult<Answer> {
    let question = Question { aircraft: name, speed, altitude, climb_angle, ..Question::default() };
    let answer = py.detach(|| match what {
        "show" => show(name, Units::Si).map(|it| Answer::new(it.text(), &it.json(), true)),
        "check" => check(name).map(|it| Answer::new(it.text(), &it.json(), true)),
        "trim" => trim(&question).map(|it| Answer::new(it.text(), &it.json(), true)),
        "modes" => modes(&question).map(|it| Answer::new(it.text(), &it.json(), true)),
        "components" | "speed-and-angle" => {
            let form = match what {
                "components" => VelocityForm::Components,
                _ => VelocityForm::SpeedAndAngle,
            };
            linearise(&question, form).map(|it| {
                let plant = vec![("plant.toml".to_owned(), it.plant_file())];
                Answer::new(it.text(), &it.json(), true).with_files(plant)
            })
        }
        _ => trim(&question).map(|it| Answer::new(it.text(), &it.json(), true)),
    });
    answer.map_err(|found| error::input(py, found))
}
