//! Leaving the range of an aircraft's data, in words.

use fspid_aircraft::Departure;
use fspid_sim::Exit;

use fspid_scenario::units::degrees;

/// How the sentence begins.
pub const LEFT_RANGE: &str = "left the range of its model";

/// When, for how long and by which limit a flight left the range of its model, in words.
#[must_use]
pub fn left_validity(exit: &Exit) -> String {
    let Departure { quantity, value, allowed } = exit.departure;
    let (factor, unit) = match quantity.unit() {
        "rad" => (degrees(1.0), "deg"),
        unit => (1.0, unit),
    };
    let text = format!(
        "{LEFT_RANGE} at t = {:.2} s, outside for {:.2} s: {} {:.4} {unit}, trusted {:.4} to {:.4} {unit}",
        exit.at_s,
        exit.outside_s,
        quantity.name(),
        factor * value,
        factor * allowed.min,
        factor * allowed.max,
    );
    text.trim_end().replace("  ", " ")
}
