//! Which way a variable counts, by the words of its file.

use crate::flight::error::FlightError;
use crate::model::Port;

/// Variables by the names of the standard that count one way here, the words for that way, and those for the other.
struct Way {
    names: &'static [&'static str],
    ours: &'static [&'static str],
    turned: &'static [&'static str],
}

/// Words as NASA's files have them, abbreviated and written out. Aileron and rudder are not among them: files give them by what they do
/// or by where an edge goes, of one side or of both.
const WAYS: [Way; 8] = [
    Way {
        names: &[
            "angleOfAttack",
            "angleOfAttackRate",
            "bodyAngularRate_Pitch",
            "aeroBodyMomentCoefficient_Pitch",
            "thrustBodyMoment_Pitch",
        ],
        ours: &["anu", "nose up"],
        turned: &["and", "nose down"],
    },
    Way {
        names: &["angleOfSideslip"],
        ours: &["rt", "right", "wind in right ear", "wind from right", "anl", "nose left"],
        turned: &["lt", "left", "wind in left ear", "wind from left", "anr", "nose right"],
    },
    Way {
        names: &["bodyAngularRate_Roll", "aeroBodyMomentCoefficient_Roll", "thrustBodyMoment_Roll"],
        ours: &["rwd", "right wing down", "right roll"],
        turned: &["lwd", "left wing down", "left roll"],
    },
    Way {
        names: &["bodyAngularRate_Yaw", "aeroBodyMomentCoefficient_Yaw", "thrustBodyMoment_Yaw"],
        ours: &["anr", "nose right"],
        turned: &["anl", "nose left"],
    },
    Way {
        names: &["elevatorDeflection"],
        ours: &["ted", "trailing edge down"],
        turned: &["teu", "trailing edge up"],
    },
    Way {
        names: &["aeroBodyForceCoefficient_X", "thrustBodyForce_X", "bodyPositionOfCmWrtMrc_X"],
        ours: &["fwd", "forward"],
        turned: &["aft", "back", "backward"],
    },
    Way {
        names: &["aeroBodyForceCoefficient_Y", "thrustBodyForce_Y", "bodyPositionOfCmWrtMrc_Y"],
        ours: &["rt", "right"],
        turned: &["lt", "left"],
    },
    Way {
        names: &["aeroBodyForceCoefficient_Z", "thrustBodyForce_Z", "bodyPositionOfCmWrtMrc_Z"],
        ours: &["dwn", "down"],
        turned: &["up"],
    },
];

/// 1, or -1 of a variable that says that it counts the other way.
///
/// # Errors
/// Words that are not known for a variable that can count either way: taken as ours they could turn a loop round.
pub(super) fn sign(port: &Port) -> Result<f64, FlightError> {
    let words = port.sign.to_ascii_lowercase();
    let words = words.trim().trim_start_matches('+').trim_start_matches("aircraft ");
    let is_own = |way: &&Way| way.names.iter().any(|name| name.eq_ignore_ascii_case(&port.name));
    match WAYS.iter().find(is_own) {
        Some(way) if way.turned.contains(&words) => Ok(-1.0),
        Some(way) if !words.is_empty() && !way.ours.contains(&words) => Err(FlightError::Sign {
            name: port.name.clone(),
            found: port.sign.clone(),
            ours: way.ours.join(", "),
            turned: way.turned.join(", "),
        }),
        _ => Ok(1.0),
    }
}
