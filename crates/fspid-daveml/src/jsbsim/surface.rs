//! What the flight control system says of the surfaces: their stops, and positions that are scaled to other units.

use std::collections::{BTreeMap, BTreeSet};

use fspid_numeric::units::RADIAN_DEG;

use crate::data::parse;
use crate::expression::Expression;
use crate::finding::{Findings, Origin};
use crate::xml::element::Element;

/// Stops of a surface whose file has none, deg: wide enough for most, and said in a note.
const ASSUMED_DEG: (f64, f64) = (-25.0, 25.0);

/// Stops of the surfaces, deg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stops {
    /// Elevator, trailing edge down positive.
    pub elevator: (f64, f64),
    /// Left aileron.
    pub aileron: (f64, f64),
    /// Rudder.
    pub rudder: (f64, f64),
}

impl Default for Stops {
    fn default() -> Self {
        Self { elevator: ASSUMED_DEG, aileron: ASSUMED_DEG, rudder: ASSUMED_DEG }
    }
}

pub(super) fn stops(root: Element<'_, '_>, findings: &mut Findings) -> Stops {
    let mut stop = |surface: &str| {
        let rad = format!("fcs/{surface}-pos-rad");
        let deg = format!("fcs/{surface}-pos-deg");
        let scale = [(rad.as_str(), RADIAN_DEG), (deg.as_str(), 1.0)];
        let found = scale.iter().find_map(|&(name, unit)| {
            parts(root).find_map(|part| makes(part, name).then(|| range(part, "range", unit))?)
        });
        // To a millionth of a degree: gains such as 0.01745 have no more.
        let rounded = |value: f64| (value * 1e6).round() / 1e6;
        found.map(|(min, max)| (rounded(min), rounded(max))).unwrap_or_else(|| {
            let (min, max) = ASSUMED_DEG;
            let message = format!("no range of {rad} is found: {min} to {max} deg are assumed");
            findings.note(Origin(None), message);
            ASSUMED_DEG
        })
    };
    Stops { elevator: stop("elevator"), aileron: stop("left-aileron"), rudder: stop("rudder") }
}

/// Every element of the flight control system.
fn parts<'a, 'i>(root: Element<'a, 'i>) -> impl Iterator<Item = Element<'a, 'i>> {
    let systems = root.elements().filter(|part| matches!(part.name(), "flight_control" | "system"));
    systems.flat_map(Element::descendants)
}

/// True for a component that makes a property.
fn makes(part: Element<'_, '_>, property: &str) -> bool {
    part.elements().any(|child| child.name() == "output" && child.prose() == property)
}

/// The ends of a child as they are written, of which the first may be the larger; `None` where they are not numbers.
fn ends(part: Element<'_, '_>, name: &str) -> Option<(f64, f64)> {
    let ends = part.child(name)?;
    let end =
        |name: &str| ends.child(name)?.prose().parse::<f64>().ok().filter(|it| it.is_finite());
    end("min").zip(end("max"))
}

/// The ends of a child, times its gain and in order; `None` where they are not numbers or not apart.
fn range(part: Element<'_, '_>, name: &str, unit: f64) -> Option<(f64, f64)> {
    let (one, other) = ends(part, name)?;
    let gain = part.child("gain").map_or(Some(1.0), |gain| gain.prose().parse::<f64>().ok())?;
    let (one, other) = (one * gain * unit, other * gain * unit);
    let (min, max) = (one.min(other), one.max(other));
    (min < max && min >= -90.0 && max <= 90.0).then_some((min, max))
}

/// What an `<aerosurface_scale>` makes of a surface's angle, or why that is not known here.
pub(super) type Scaled = Result<Expression, String>;

/// Properties that an `<aerosurface_scale>` makes of a surface's angle, by name.
///
/// With ends of different size, what is above 0 goes with the upper ends, and what is below with the lower, as
/// `zero_centered` says and as is usual.
pub(super) fn scaled(root: Element<'_, '_>) -> BTreeMap<String, Scaled> {
    let mut found = BTreeMap::new();
    for part in parts(root).filter(|part| part.name() == "aerosurface_scale") {
        let input = part.child("input").map(Element::prose).unwrap_or_default();
        let is_surface = ["elevator", "left-aileron", "right-aileron", "rudder"]
            .iter()
            .any(|it| input == format!("fcs/{it}-pos-rad") || input == format!("fcs/{it}-pos-deg"));
        if is_surface {
            let formula = scale(part, &input);
            found.extend(made(part).into_iter().map(|name| (name, formula.clone())));
        }
    }
    for (name, formula) in &mut found {
        let makers = parts(root).filter(|part| made(*part).contains(name)).count();
        if makers > 1 {
            *formula = Err(format!("{makers} components of the flight control system make it"));
        }
    }
    found
}

/// Properties that a component makes: its outputs, and the one of its own name.
fn made(part: Element<'_, '_>) -> BTreeSet<String> {
    let outputs = part.elements().filter(|it| it.name() == "output").map(Element::prose);
    let mut made: BTreeSet<_> = outputs.collect();
    if part.child("input").is_some() {
        made.extend(part.attribute("name").map(|name| match name.contains('/') {
            true => name.to_owned(),
            false => format!("fcs/{}", name.trim().to_lowercase().replace(' ', "-")),
        }));
    }
    made
}

/// The formula of one `<aerosurface_scale>`.
fn scale(part: Element<'_, '_>, input: &str) -> Scaled {
    for name in ["gain", "clipto"] {
        if part.child(name).is_some() {
            return Err(format!("its <aerosurface_scale> has <{name}>, which is not known here"));
        }
    }
    if let Some(word) = part.child("zero_centered").map(Element::prose)
        && !matches!(word.as_str(), "1" | "true")
    {
        return Err(format!("<zero_centered> of its <aerosurface_scale> is {word}"));
    }
    // JSBSim has -1 and 1 for a domain that is not whole.
    let is_whole = |it: &Element<'_, '_>| it.child("min").is_some() && it.child("max").is_some();
    let domain = match part.child("domain").filter(is_whole) {
        Some(_) => ends(part, "domain"),
        None => Some((-1.0, 1.0)),
    };
    let slopes = domain.zip(ends(part, "range")).map(|(domain, range)| {
        // Each end belongs to the one of its name, whichever is the larger: a range from 1 to -1 turns the sign.
        (range.0 / domain.0, range.1 / domain.1)
    });
    let wrong = || "the ends of its <aerosurface_scale> are no numbers that can be used".to_owned();
    let (down, up) =
        slopes.filter(|(down, up)| down.is_finite() && up.is_finite()).ok_or_else(wrong)?;
    let text =
        format!("plus(times({up:?}, max({input}, 0.0)), times({down:?}, min({input}, 0.0)))");
    parse(&text).map_err(|_| wrong())
}
