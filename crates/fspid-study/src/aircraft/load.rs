//! An aircraft by its name, or from a file of the same form.

use std::path::Path;

use fspid_aircraft::data::AircraftData;

use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::file::{self, STANDARD_INPUT, aircraft_names, read_regular};

/// The aircraft of a name that the program carries, or of a `.toml` file.
///
/// # Errors
/// [`AircraftFailure`]: a name that is not known, a file that cannot be read or is wrong.
pub fn load(name: &str) -> Result<AircraftData, AircraftFailure> {
    load_at(name, None)
}

/// As [`load`], an aircraft of tables with its centre of gravity at a share of its chord.
pub(super) fn load_at(name: &str, cg_mac: Option<f64>) -> Result<AircraftData, AircraftFailure> {
    if let Some(data) = file::aircraft(name) {
        return Ok(data);
    }
    let path = Path::new(name);
    let is_file = name == STANDARD_INPUT
        || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    if !is_file {
        return Err(AircraftFailure::unknown(name, &aircraft_names()));
    }
    let text = text(path)?;
    file::parse_aircraft_at(&text, name, (path.parent(), cg_mac)).map_err(AircraftFailure::Problems)
}

/// The text of a file.
pub(super) fn text(path: &Path) -> Result<String, AircraftFailure> {
    let unreadable = |reason| AircraftFailure::unreadable(path, reason);
    let bytes = read_regular(path).map_err(unreadable)?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        unreadable(format!("not UTF-8 from byte {at} on"))
    })
}
