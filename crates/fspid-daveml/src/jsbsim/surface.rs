//! What the flight control system says of the surfaces: their stops, and positions that are scaled to other units.

use std::collections::BTreeMap;

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
        let scale = [(rad.as_str(), 180.0 / core::f64::consts::PI), (deg.as_str(), 1.0)];
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

/// The ends of a child, times its gain; `None` where they are not numbers or not apart.
fn range(part: Element<'_, '_>, name: &str, unit: f64) -> Option<(f64, f64)> {
    let ends = part.child(name)?;
    let end =
        |name: &str| ends.child(name)?.prose().parse::<f64>().ok().filter(|it| it.is_finite());
    let gain = part.child("gain").map_or(Some(1.0), |gain| gain.prose().parse::<f64>().ok())?;
    let [one, other] = ["min", "max"].map(end);
    let (one, other) = (one? * gain * unit, other? * gain * unit);
    let (min, max) = (one.min(other), one.max(other));
    (min < max && min >= -90.0 && max <= 90.0).then_some((min, max))
}

/// Properties that an `<aerosurface_scale>` makes of a surface's angle, by name.
///
/// With ends of different size, what is above 0 goes with the upper ends, and what is below with the lower, as
/// `zero_centered` says and as is usual.
pub(super) fn scaled(root: Element<'_, '_>) -> BTreeMap<String, Expression> {
    let scales = parts(root).filter(|part| part.name() == "aerosurface_scale");
    let mut found = BTreeMap::new();
    for part in scales {
        let input = part.child("input").map(Element::prose).unwrap_or_default();
        let surface = ["elevator", "left-aileron", "right-aileron", "rudder"]
            .iter()
            .any(|it| input == format!("fcs/{it}-pos-rad") || input == format!("fcs/{it}-pos-deg"));
        let centred = part.child("zero_centered").is_none_or(|it| it.prose() != "false");
        if !surface || !centred || part.child("gain").is_some() {
            continue;
        }
        let domain = range(part, "domain", 1.0).unwrap_or((-1.0, 1.0));
        let Some(range) = range(part, "range", 1.0) else { continue };
        if !(domain.0 < 0.0 && domain.1 > 0.0) {
            continue;
        }
        let (down, up) = (range.0 / domain.0, range.1 / domain.1);
        let text =
            format!("plus(times({up:?}, max({input}, 0.0)), times({down:?}, min({input}, 0.0)))");
        let Ok(formula) = parse(&text) else { continue };
        for output in part.elements().filter(|it| it.name() == "output") {
            found.entry(output.prose()).or_insert_with(|| formula.clone());
        }
    }
    found
}
