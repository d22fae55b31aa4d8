//! An aircraft that flies, of derivatives and of tables alike.

use fspid_aircraft::data::{AircraftData, Laws, ModelData};
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

fn of_derivatives(
    data: &AircraftData,
    laws: Laws,
    environment: Environment,
) -> Result<Aircraft<Forces>, AircraftError> {
    let aircraft = data.aircraft(laws, environment)?;
    Aircraft::new(*aircraft.mass(), Forces::from(*aircraft.model()), environment)
}
