//! Names and texts of what the program carries.

use fspid_data::{AIRCRAFT, PLANTS, RULE_TABLES};

/// Names of the plants that the program carries.
#[must_use]
pub fn plant_names() -> Vec<&'static str> {
    PLANTS.iter().map(|(name, _)| *name).collect()
}

/// Names of the rule tables that the program carries.
#[must_use]
pub fn rule_table_names() -> Vec<&'static str> {
    RULE_TABLES.iter().map(|(name, _)| *name).collect()
}

/// The text of a plant by its name.
pub(crate) fn plant_text(name: &str) -> Option<&'static str> {
    let known = PLANTS.iter().find(|(known, _)| *known == name);
    known.map(|(_, text)| *text)
}

/// The text of a rule table by its name.
pub(crate) fn rule_table_text(name: &str) -> Option<&'static str> {
    let known = RULE_TABLES.iter().find(|(known, _)| *known == name);
    known.map(|(_, text)| *text)
}

/// Names of the aircraft that the program carries.
#[must_use]
pub fn aircraft_names() -> Vec<&'static str> {
    AIRCRAFT.iter().map(|(name, _)| *name).collect()
}

/// The text of an aircraft by its name.
pub(crate) fn aircraft_text(name: &str) -> Option<&'static str> {
    let known = AIRCRAFT.iter().find(|(known, _)| *known == name);
    known.map(|(_, text)| *text)
}
