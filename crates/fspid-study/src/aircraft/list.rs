//! The aircraft that the program carries.

use fspid_aircraft::data::{AircraftData, ModelData};
use fspid_data::AIRCRAFT_CLASSES;
use serde_json::{Value, json};

use super::table::table;
use fspid_scenario::file::{aircraft, aircraft_names};

/// All of them.
#[derive(Clone, Debug, PartialEq)]
pub struct List(Vec<AircraftData>);

/// Lists the aircraft that the program carries.
#[must_use]
pub fn list() -> List {
    List(aircraft_names().into_iter().filter_map(aircraft).collect())
}

/// What can be asked of an aircraft, in a word.
pub(super) const fn kind(model: &ModelData) -> &'static str {
    match model {
        ModelData::Derivatives(_) => "derivatives",
        ModelData::Linear(_) => "linear",
        ModelData::Forces(_) => "tables",
    }
}

/// The class of an aircraft that the program carries.
fn class(name: &str) -> Option<&'static str> {
    let holds = |kinds: &[&[&str]]| kinds.iter().any(|files| files.contains(&name));
    AIRCRAFT_CLASSES.iter().find(|(_, kinds)| holds(kinds)).map(|(class, _)| *class)
}

impl List {
    /// A line an aircraft.
    #[must_use]
    pub fn text(&self) -> String {
        let row = |data: &AircraftData| {
            let class = class(&data.name).unwrap_or("-");
            vec![format!("{:16} {class:10} {:12} {}", data.name, kind(&data.model), data.title)]
        };
        let rows: Vec<Vec<String>> = self.0.iter().map(row).collect();
        let heading = format!("{:16} {:10} {:12} {}", "name", "class", "known by", "what it is");
        table(&[&heading], &rows)
    }

    /// Name, class, kind, title and source of each.
    #[must_use]
    pub fn json(&self) -> Value {
        let entry = |data: &AircraftData| {
            json!({
                "name": data.name, "class": class(&data.name), "known_by": kind(&data.model),
                "title": data.title, "source": data.source,
            })
        };
        json!({ "aircraft": self.0.iter().map(entry).collect::<Vec<_>>() })
    }
}
