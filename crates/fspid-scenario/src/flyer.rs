//! An aircraft that flies, of derivatives and of tables alike.

use fspid_aircraft::aerodynamics::varied::Deployed;
use fspid_aircraft::data::{AircraftData, GroundData, Laws, ModelData};
use fspid_aircraft::{Aircraft, AircraftError, Environment};
use fspid_sim::aircraft::Forces;

/// The aircraft in the standard atmosphere, or in the air of its source; laws are for derivatives only.
pub fn flyer(
    data: &AircraftData,
    laws: Laws,
    in_own_air: bool,
) -> Result<Aircraft<Forces>, AircraftError> {
    let environment = match in_own_air {
        true => data.reference_environment()?,
        false => data.standard_environment(),
    };
    match &data.model {
        ModelData::Forces(data) => {
            Aircraft::new(data.mass, Forces::Other(data.forces.clone()), environment)
        }
        _ => of_derivatives(data, laws, environment),
    }
}

/// The same with what is added to its derivatives in flight: configurations, by how far they are out, and the effect of a
/// ground at an altitude, m. Its table over Mach number is always there.
///
/// # Errors
/// An aircraft without derivatives; numbers that no aircraft has.
pub fn varied_flyer(
    data: &AircraftData,
    laws: Laws,
    in_own_air: bool,
    added: (Vec<Deployed>, Option<(GroundData, f64)>),
) -> Result<Aircraft<Forces>, AircraftError> {
    let environment = match in_own_air {
        true => data.reference_environment()?,
        false => data.standard_environment(),
    };
    with(data, laws, environment, added)
}

fn with(
    data: &AircraftData,
    laws: Laws,
    environment: Environment,
    (deployed, ground): (Vec<Deployed>, Option<(GroundData, f64)>),
) -> Result<Aircraft<Forces>, AircraftError> {
    // Judges the numbers.
    let mass = *data.aircraft(laws, environment)?.mass();
    let effects = (data.variations.mach.clone(), ground);
    let model = data.derivatives()?.varied_model(laws, deployed, effects)?;
    Aircraft::new(mass, Forces::from(model), environment)
}

fn of_derivatives(
    data: &AircraftData,
    laws: Laws,
    environment: Environment,
) -> Result<Aircraft<Forces>, AircraftError> {
    if data.variations.mach.is_some() {
        return with(data, laws, environment, (Vec::new(), None));
    }
    let aircraft = data.aircraft(laws, environment)?;
    Aircraft::new(*aircraft.mass(), Forces::from(*aircraft.model()), environment)
}
