//! Area, span and chord of reference, and where the loads act.

use crate::finding::Findings;
use crate::jsbsim::required;
use crate::jsbsim::unit::{self, Units};
use crate::xml::element::Element;

/// Properties that `<metrics>` makes: element, property, its name in the standard (empty if it has none), units, and the
/// units of the file.
const ROWS: [(&str, &str, &str, &str, Units); 8] = [
    ("wingarea", AREA, "referenceWingArea", "ft2", unit::AREA),
    ("wingspan", SPAN, "referenceWingSpan", "ft", unit::LENGTH),
    ("chord", CHORD, "referenceWingChord", "ft", unit::LENGTH),
    ("htailarea", "metrics/Sh-sqft", "", "ft2", unit::AREA),
    ("htailarm", "metrics/lh-ft", "", "ft", unit::LENGTH),
    ("vtailarea", "metrics/Sv-sqft", "", "ft2", unit::AREA),
    ("vtailarm", "metrics/lv-ft", "", "ft", unit::LENGTH),
    ("wing_incidence", "metrics/iw-rad", "", "rad", unit::ANGLE),
];

pub(super) const AREA: &str = "metrics/Sw-sqft";
pub(super) const SPAN: &str = "metrics/bw-ft";
pub(super) const CHORD: &str = "metrics/cbarw-ft";

/// What `<metrics>` says.
#[derive(Default)]
pub(super) struct Metrics {
    /// Property, name in the standard, units, value.
    pub(super) values: Vec<(&'static str, &'static str, &'static str, f64)>,
    /// The aerodynamic reference point: forward, right, down, ft.
    pub(super) reference_ft: [f64; 3],
}

pub(super) fn read(root: Element<'_, '_>, findings: &mut Findings) -> Metrics {
    let Some(part) = required(root, "metrics", findings) else { return Metrics::default() };
    let mut metrics = Metrics::default();
    for (name, property, standard, units, file_units) in ROWS {
        let found = part.child(name).map(|it| (it, unit::number(it, file_units, findings)));
        match found {
            Some((element, value)) if !standard.is_empty() && !(value > 0.0) => {
                let message = format!("<{name}> is {value}");
                findings.problem(element.origin(), name, message, "a number above 0");
            }
            Some((_, value)) => metrics.values.push((property, standard, units, value)),
            None if !standard.is_empty() => {
                let expected = "<wingarea>, <wingspan> and <chord>";
                findings.problem(part.origin(), "metrics", format!("no <{name}>"), expected);
            }
            None => {}
        }
    }
    match place(part, "AERORP", findings) {
        Some(place) => metrics.reference_ft = unit::place_ft(place, findings),
        None => {
            let message = "nothing says where the loads of the air act";
            let expected = "<location name=\"AERORP\">";
            findings.problem(part.origin(), "metrics", message, expected);
        }
    }
    metrics
}

/// The place of that name; JSBSim takes the last of several, so that a second one is refused.
pub(super) fn place<'a, 'i>(
    part: Element<'a, 'i>,
    name: &str,
    findings: &mut Findings,
) -> Option<Element<'a, 'i>> {
    let mut places = part
        .elements()
        .filter(|it| it.name() == "location" && it.optional("name").eq_ignore_ascii_case(name));
    let found = places.next();
    if let Some(second) = places.next() {
        let message = "a second place of this name, of which JSBSim takes the last";
        findings.problem(second.origin(), name, message, "one place of each name");
    }
    found
}
