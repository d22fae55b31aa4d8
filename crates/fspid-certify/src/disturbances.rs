//! Bounds of what disturbances do, in sentences and for programs.

use fspid_proof::{AirPart, Disturbed, Extent, LeftOut, Quantity, Scope, Way};
use serde_json::{Value, json};

use fspid_scenario::units::degrees;
use fspid_study::json::merged;

use super::scope::told_deg;
use super::told::{at_least, at_most};

/// What came of looking for bounds of a loop.
#[derive(Clone, Debug)]
pub enum DisturbanceAnswer {
    /// They are in its certificate.
    Bounded,
    /// There are none, and why.
    NotBounded(String),
}

impl DisturbanceAnswer {
    pub(super) fn is_bounded(&self) -> bool {
        matches!(self, Self::Bounded)
    }

    /// Why there is none.
    pub(super) fn trouble(&self) -> Option<&str> {
        match self {
            Self::Bounded => None,
            Self::NotBounded(reason) => Some(reason),
        }
    }
}

/// A unit of what disturbs, in words, and how many of it are one of SI.
fn unit(way: &Way) -> (&'static str, f64) {
    match way {
        Way::Elevator => ("deg", degrees(1.0)),
        Way::Air { part: AirPart::Forward | AirPart::Vertical, .. } => ("m/s", 1.0),
        Way::Air { part: AirPart::Turning, .. } => ("deg/s", degrees(1.0)),
    }
}

/// What disturbs, in words.
fn named(way: &Way, at_servo: bool) -> &'static str {
    match way {
        Way::Elevator if at_servo => "a disturbance at the servo or the elevator",
        Way::Elevator => "a disturbance at the elevator",
        Way::Air { part: AirPart::Forward, .. } => "a gust along the body axis",
        Way::Air { part: AirPart::Vertical, .. } => "a gust across the body axis",
        Way::Air { part: AirPart::Turning, .. } => "air that turns in pitch",
    }
}

/// Degrees per unit of what disturbs.
fn degrees_per_unit(one: &Disturbed) -> f64 {
    degrees(one.per_unit) / unit(&one.way).1
}

/// A bound of what a disturbance does, as the cells of a table: what disturbs, by which measure, what is bounded, by how much
/// at most, and up to which size no limit acts.
pub(super) fn cells(one: &Disturbed) -> [String; 5] {
    let (word, per) = unit(&one.way);
    let (measure, root) = match one.extent {
        Extent::Peak => ("peak", ""),
        Extent::Energy => ("energy (L2)", " times the root of a second"),
    };
    let at_servo = one.at_servo && one.extent == Extent::Peak;
    let unlimited = match one.unlimited_up_to.filter(|most| most.is_finite()) {
        Some(most) => format!("{} {word}{root}", at_least(most * per)),
        None => "\u{2013}".to_owned(),
    };
    [
        named(&one.way, at_servo).to_owned(),
        measure.to_owned(),
        bounded(one.quantity).to_owned(),
        format!("{} deg per {word}", at_most(degrees_per_unit(one))),
        unlimited,
    ]
}

const fn bounded(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Pitch => "the pitch angle",
        Quantity::Command => "the command",
        Quantity::Limits => "a limit",
    }
}

/// One sentence for each way and measure; `moving` says how gains move.
pub(super) fn sentences(scope: &Scope, moving: &str) -> Vec<String> {
    let mut told = Vec::new();
    let mut rest = &scope.disturbed[..];
    while let [first, ..] = rest {
        let same = rest.iter().take_while(|it| it.way == first.way && it.extent == first.extent);
        let (group, later) = rest.split_at(same.count());
        told.push(sentence(scope, group, moving));
        rest = later;
    }
    if scope.disturbed.len() > 1 && !told.is_empty() {
        let words = "disturbances together do no more than the sum of what each does";
        told.push(words.to_owned());
    }
    let is_straight =
        |it: &Disturbed| matches!(&it.way, Way::Air { part, .. } if *part != AirPart::Turning);
    if scope.disturbed.iter().any(is_straight) {
        told.push(AXES.to_owned());
    }
    told
}

/// What gusts along other axes are. Before E-198 those along the body were told as gusts along the path, and those across it as
/// vertical ones, which do up to some percent more.
const AXES: &str = "the body axis is the one that the aircraft's angle of attack is measured from: in level flight a vertical gust is one \
                    across it times the cosine of that angle and one along it times the sine, a gust along the flight path the other way round";

fn sentence(scope: &Scope, group: &[Disturbed], moving: &str) -> String {
    let Some(first) = group.first() else { return String::new() };
    let (word, _) = unit(&first.way);
    let each = group.iter().map(|one| (bounded(one.quantity), at_most(degrees_per_unit(one))));
    let each: Vec<(&str, String)> = each.collect();
    let limits = limits(scope, group, word);
    match first.extent {
        Extent::Peak => {
            let moved = each.iter().map(|(what, by)| format!("{what} by at most {by} deg"));
            let moved: Vec<String> = moved.collect();
            let beside = match degrees(scope.remains_rad) {
                0.0 => "",
                _ => ", beside what remains without it",
            };
            format!(
                "from rest, {} of at most 1 {word}, however it changes, moves {}{beside}, in proportion to its size{moving}{limits}",
                named(&first.way, first.at_servo),
                moved.join(" and ")
            )
        }
        Extent::Energy => {
            let gains = each.iter().map(|(what, by)| format!("{by} deg per {word} to {what}"));
            let gains: Vec<String> = gains.collect();
            format!(
                "from rest, the L2 gain of {} of any shape is at most {}{moving}{limits}",
                named(&first.way, false),
                gains.join(" and ")
            )
        }
    }
}

/// Up to which disturbance no limit acts: the best that one of the bounds shows.
fn limits(scope: &Scope, group: &[Disturbed], word: &str) -> String {
    if scope.limits.is_empty() {
        return String::new();
    }
    let most = group.iter().filter_map(|one| Some(one.unlimited_up_to? * unit(&one.way).1));
    let root = match group.first().map(|one| one.extent) {
        Some(Extent::Energy) => " times the root of a second",
        _ => "",
    };
    match most.reduce(f64::max) {
        Some(most) => format!("; no limit acts up to {} {word}{root}", at_least(most)),
        None => "; LIMITS ARE NOT COVERED".to_owned(),
    }
}

/// What is left out, beside bounds.
pub(super) fn left_out(one: LeftOut, scope: Option<&Scope>) -> String {
    let disturbed = scope.map_or(&[][..], |scope| &scope.disturbed);
    let enters = |part: AirPart| {
        disturbed.iter().any(|it| matches!(&it.way, Way::Air { part: own, .. } if *own == part))
    };
    let air = AirPart::ALL.into_iter().filter(|part| enters(*part));
    let air: Vec<&str> = air.map(words_of).collect();
    let elevator = disturbed.iter().find(|it| it.way == Way::Elevator);
    match (one, elevator) {
        (LeftOut::MovingAir, _) if !air.is_empty() => format!(
            "Moving air counts by the bounds above, from rest, as {}; any other motion of it is left out.",
            air.join(", ")
        ),
        (LeftOut::Disturbances, Some(one)) => format!(
            "Disturbances that move count by the bounds above, from rest, where they enter at {}; elsewhere they count while they stand still, as loads.",
            if one.at_servo { "the servo or the elevator" } else { "the elevator" }
        ),
        (LeftOut::MovingSetpoint, _) if scope.is_some_and(|it| it.ended.is_some()) => {
            "Set-points and loads that move otherwise than in the lines above are left out."
                .to_owned()
        }
        (LeftOut::MovingSetpoint, _) if !disturbed.is_empty() => {
            "Apart from the lines on disturbances the claim is about constant set-points and loads: it says nothing of the time while they move."
                .to_owned()
        }
        (LeftOut::Disturbances, None) if scope.is_some_and(|it| it.ended.is_some()) => {
            "Disturbances that move otherwise than in the lines above count while they stand still, as loads."
                .to_owned()
        }
        _ => one.to_string(),
    }
}

const fn words_of(part: AirPart) -> &'static str {
    match part {
        AirPart::Forward => "gusts along the body axis",
        AirPart::Vertical => "gusts across it through the angle of attack",
        AirPart::Turning => "turning in pitch",
    }
}

/// For programs.
pub(super) fn in_json(scope: &Scope) -> Value {
    let each = scope.disturbed.iter().map(|one| {
        let (word, per) = unit(&one.way);
        let most = one.unlimited_up_to.filter(|most| most.is_finite());
        json!({
            "enters": one.way.name(),
            // Of an energy at the servo no size is known up to which no limit acts.
            "at_servo_too": one.at_servo && (one.extent == Extent::Peak || most.is_none()),
            "unit": word,
            "bounds": one.quantity.name(),
            "measured_by": one.extent.name(),
            "deg_per_unit": told_deg(one.per_unit) / per,
            "no_limit_acts_up_to": most.map(|most| most * per),
        })
    });
    merged([json!({ "disturbances": each.collect::<Vec<_>>() })])
}
