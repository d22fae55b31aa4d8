//! Which way a variable counts, by the words of its file.

use crate::model::Port;

/// Words of files for variables that count the other way than a flight does, by the names of the standard. Everything else counts as it
/// does here: airspeeds, angles and rates nose up, right wing down and nose right, the wind from the right, elevators trailing edge
/// down, forces forward, right and down.
///
/// Words as NASA's files have them, abbreviated and written out. Aileron and rudder are not among them: files give them by what they do
/// or by where an edge goes, of one side or of both.
const TURNED: [(&str, &[&str]); 13] = [
    ("angleOfAttack", NOSE_DOWN),
    ("angleOfAttackRate", NOSE_DOWN),
    ("angleOfSideslip", &["anr", "nose right", "lt", "left", "wind in left ear", "wind from left"]),
    ("bodyAngularRate_Roll", LEFT_WING_DOWN),
    ("bodyAngularRate_Pitch", NOSE_DOWN),
    ("bodyAngularRate_Yaw", NOSE_LEFT),
    ("elevatorDeflection", &["teu", "trailing edge up"]),
    ("aeroBodyForceCoefficient_X", &["aft", "back", "backward"]),
    ("aeroBodyForceCoefficient_Y", &["lt", "left"]),
    ("aeroBodyForceCoefficient_Z", &["up"]),
    ("aeroBodyMomentCoefficient_Roll", LEFT_WING_DOWN),
    ("aeroBodyMomentCoefficient_Pitch", NOSE_DOWN),
    ("aeroBodyMomentCoefficient_Yaw", NOSE_LEFT),
];
const NOSE_DOWN: &[&str] = &["and", "nose down"];
const NOSE_LEFT: &[&str] = &["anl", "nose left"];
const LEFT_WING_DOWN: &[&str] = &["lwd", "left wing down", "left roll"];

/// 1, or -1 of a variable that says that it counts the other way.
pub(super) fn sign(port: &Port) -> f64 {
    let words = port.sign.to_ascii_lowercase();
    let words = words.trim().trim_start_matches('+').trim_start_matches("aircraft ");
    let is_turned = |(name, turned): &(&str, &[&str])| {
        name.eq_ignore_ascii_case(&port.name) && turned.contains(&words)
    };
    if TURNED.iter().any(is_turned) { -1.0 } else { 1.0 }
}
