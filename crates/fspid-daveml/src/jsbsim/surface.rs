//! What the flight control system says of the surfaces: their stops, and positions that are scaled to other units.

use std::collections::{BTreeMap, BTreeSet};

use fspid_numeric::units::RADIAN_DEG;

use crate::expression::Expression;
use crate::finding::{Findings, Origin};
use crate::formula::parse;
use crate::jsbsim::reach::{Untold, reach};
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
    let mut stop = |surface: &str| stop(root, surface, findings);
    Stops { elevator: stop("elevator"), aileron: stop("left-aileron"), rudder: stop("rudder") }
}

/// Stops of one surface, deg: where the component that makes its position ends.
fn stop(root: Element<'_, '_>, surface: &str, findings: &mut Findings) -> (f64, f64) {
    let rad = format!("fcs/{surface}-pos-rad");
    let deg = format!("fcs/{surface}-pos-deg");
    // Both are the same position, so that a second maker of either takes it from the first.
    let makers = parts(root).flat_map(|part| {
        let made = made(part);
        let units = [(&rad, RADIAN_DEG), (&deg, 1.0)];
        units
            .into_iter()
            .filter_map(move |(name, unit)| made.contains(name).then_some((part, unit)))
    });
    let found = match makers.collect::<Vec<_>>().as_slice() {
        [] => None,
        [(part, unit)] => match reach(root, *part) {
            Ok(ends) => ends.map(|(min, max)| (*part, min * unit, max * unit)),
            Err(Untold { at, message }) => {
                let expected = "a component with ends that are numbers";
                findings.problem(at, &rad, message, expected);
                return ASSUMED_DEG;
            }
        },
        [_, (part, _), ..] => {
            let message = "a second component of the flight control system makes it, or makes it in other units, and the \
                           last one counts";
            findings.problem(part.origin(), &rad, message, "one component");
            return ASSUMED_DEG;
        }
    };
    match found {
        Some((part, min, max)) if !(min < max) => {
            let message = format!("it stays at {min} deg whatever is commanded");
            findings.problem(part.origin(), &rad, message, "two ends that are apart");
            ASSUMED_DEG
        }
        // To a millionth of a degree: gains such as 0.01745 have no more.
        Some((_, min, max)) if min >= -90.0 && max <= 90.0 => {
            ((min * 1e6).round() / 1e6, (max * 1e6).round() / 1e6)
        }
        _ => {
            let (min, max) = ASSUMED_DEG;
            let message = format!("no range of {rad} is found: {min} to {max} deg are assumed");
            findings.note(Origin(None), message);
            ASSUMED_DEG
        }
    }
}

/// Every element of the flight control system.
pub(super) fn parts<'a, 'i>(root: Element<'a, 'i>) -> impl Iterator<Item = Element<'a, 'i>> {
    let systems = root.elements().filter(|part| matches!(part.name(), "flight_control" | "system"));
    systems.flat_map(Element::descendants)
}

/// The ends of a child as they are written, of which the first may be the larger; `None` where they are not numbers.
pub(super) fn ends(part: Element<'_, '_>, name: &str) -> Option<(f64, f64)> {
    let ends = part.child(name)?;
    let end =
        |name: &str| ends.child(name)?.prose().parse::<f64>().ok().filter(|it| it.is_finite());
    end("min").zip(end("max"))
}

/// True for what has both ends; JSBSim leaves out what has one.
pub(super) fn is_whole(ends: Element<'_, '_>) -> bool {
    ends.child("min").is_some() && ends.child("max").is_some()
}

/// The domain of a scale, -1 to 1 where none is whole; `None` where its ends are not numbers.
pub(super) fn domain(part: Element<'_, '_>) -> Option<(f64, f64)> {
    match part.child("domain").filter(|domain| is_whole(*domain)) {
        Some(_) => ends(part, "domain"),
        None => Some((-1.0, 1.0)),
    }
}

/// True for a scale that takes what is above 0 to its upper end, and what is below to its lower.
pub(super) fn is_zero_centered(part: Element<'_, '_>) -> bool {
    let word = part.child("zero_centered").map(Element::prose);
    word.is_none_or(|word| matches!(word.as_str(), "1" | "true"))
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
pub(super) fn made(part: Element<'_, '_>) -> BTreeSet<String> {
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
    if !is_zero_centered(part) {
        let word = part.prose_of("zero_centered");
        return Err(format!("<zero_centered> of its <aerosurface_scale> is {word}"));
    }
    let slopes = domain(part).zip(ends(part, "range")).map(|(domain, range)| {
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
