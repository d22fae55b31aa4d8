//! Units of JSBSim's files, turned into feet, pounds and slugs.

use fspid_numeric::units::{DEGREE_RAD, FOOT_M, POUND_KG, STANDARD_GRAVITY_M_S2};

use crate::finding::Findings;
use crate::xml::element::Element;

/// Feet in one metre.
const METRE_FT: f64 = 1.0 / FOOT_M;

/// Pounds in one kilogram, as of mass and, under standard gravity, of weight.
const KILOGRAM_LB: f64 = 1.0 / POUND_KG;

/// Standard gravity in ft/s²: pounds of weight in one slug.
pub(super) const SLUG_LB: f64 = STANDARD_GRAVITY_M_S2 / FOOT_M;

/// Units of one kind; the first is meant where none is said.
pub(super) type Units = &'static [(&'static str, f64)];

pub(super) const AREA: Units = &[("FT2", 1.0), ("M2", METRE_FT * METRE_FT)];
pub(super) const LENGTH: Units = &[("FT", 1.0), ("M", METRE_FT), ("IN", 1.0 / 12.0)];
/// Places, which are in inches where nothing is said.
pub(super) const PLACE: Units = &[("IN", 1.0 / 12.0), ("FT", 1.0), ("M", METRE_FT)];
pub(super) const ANGLE: Units = &[("RAD", 1.0), ("DEG", DEGREE_RAD)];
pub(super) const WEIGHT: Units = &[("LBS", 1.0), ("KG", KILOGRAM_LB), ("SLUG", SLUG_LB)];
/// One kg m² is that many pounds of mass times feet squared, 1/32.174 of them slug ft².
pub(super) const INERTIA: Units =
    &[("SLUG*FT2", 1.0), ("KG*M2", KILOGRAM_LB * METRE_FT * METRE_FT / SLUG_LB)];

/// The number of an element in the units of this reader.
pub(super) fn number(element: Element<'_, '_>, units: Units, findings: &mut Findings) -> f64 {
    element.single(findings) * factor(element, units, findings)
}

/// What one unit of an element is.
fn factor(element: Element<'_, '_>, units: Units, findings: &mut Findings) -> f64 {
    let Some(name) = element.attribute("unit") else { return units.first().map_or(1.0, |it| it.1) };
    let found = units.iter().find(|(unit, _)| unit.eq_ignore_ascii_case(name.trim()));
    found.map(|&(_, factor)| factor).unwrap_or_else(|| {
        let known = units.iter().map(|(unit, _)| *unit).collect::<Vec<_>>().join(", ");
        findings.problem(element.origin(), name, "this unit is not known here", known);
        1.0
    })
}

/// A place in JSBSim's structural frame (aft, right, up; inches by default) as forward, right and down in ft.
pub(super) fn place_ft(location: Element<'_, '_>, findings: &mut Findings) -> [f64; 3] {
    let scale = factor(location, PLACE, findings);
    let mut along = |name: &str| location.child(name).map_or(0.0, |it| it.single(findings));
    let [aft, right, up] = [along("x"), along("y"), along("z")];
    [-aft * scale, right * scale, -up * scale]
}
