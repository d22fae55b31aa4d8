//! Mass, moments of inertia and centre of mass: of the empty aircraft, points of mass and fuel.

use crate::document::{Document, Variable};
use crate::finding::Findings;
use crate::jsbsim::metrics::{self, Metrics};
use crate::jsbsim::{answer, required, unit};
use crate::xml::element::Element;

/// Largest product of inertia with the right axis, as a part of the largest moment, that goes without a note.
const LOPSIDED: f64 = 1e-9;

/// A rigid body: slugs, feet, and the inertia about its centre of mass.
#[derive(Clone, Copy, Default)]
pub(super) struct Mass {
    slugs: f64,
    /// Centre of mass from the aerodynamic reference point: forward, right, down.
    pub(super) centre_ft: [f64; 3],
    /// Moments about the forward, right and down axes.
    moments: [f64; 3],
    /// Products $\int xy$, $\int yz$ and $\int zx$ over the mass.
    products: [f64; 3],
}

/// Mass at a place in feet.
struct Point {
    slugs: f64,
    place_ft: [f64; 3],
}

pub(super) fn read(root: Element<'_, '_>, metrics: &Metrics, findings: &mut Findings) -> Mass {
    let Some(part) = required(root, "mass_balance", findings) else { return Mass::default() };
    let mut points = vec![empty(part, findings)];
    for element in part.elements().filter(|it| it.name() == "pointmass") {
        if let Some(form) = element.child("form") {
            form.leave_out("the mass is taken as a point", findings);
        }
        for name in ["weight", "location"] {
            if element.child(name).is_none() {
                let message = format!("no <{name}>");
                let expected = "<weight> and <location>";
                findings.problem(element.origin(), element.name(), message, expected);
            }
        }
        points.push(point(element, "weight", findings));
    }
    points.extend(fuel(root, findings));
    let slugs: f64 = points.iter().map(|point| point.slugs).sum();
    let centre_ft = [0, 1, 2].map(|axis| {
        let moment: f64 = points.iter().map(|it| it.slugs * at(it.place_ft, axis)).sum();
        moment / slugs
    });
    let (mut moments, mut products) = own(part, findings);
    for Point { slugs, place_ft } in points {
        let [x, y, z] = [0, 1, 2].map(|axis| at(place_ft, axis) - at(centre_ft, axis));
        let added = [y * y + z * z, x * x + z * z, x * x + y * y];
        moments.iter_mut().zip(added).for_each(|(sum, square)| *sum += slugs * square);
        let added = [x * y, y * z, z * x];
        products.iter_mut().zip(added).for_each(|(sum, product)| *sum += slugs * product);
    }
    let centre_ft = [0, 1, 2].map(|axis| at(centre_ft, axis) - at(metrics.reference_ft, axis));
    symmetric(Mass { slugs, centre_ft, moments, products }, part, findings)
}

fn at(place: [f64; 3], axis: usize) -> f64 {
    place.get(axis).copied().unwrap_or_default()
}

/// The empty aircraft as a point; its own inertia is [`own`].
fn empty(part: Element<'_, '_>, findings: &mut Findings) -> Point {
    let centre = metrics::place(part, "CG", findings);
    let pounds = part.child("emptywt").map_or(0.0, |it| unit::number(it, unit::WEIGHT, findings));
    let good = centre.is_some() && pounds > 0.0;
    if !good {
        let expected = "<emptywt> above 0 and <location name=\"CG\">";
        let message = "the weight of the empty aircraft or its place is missing";
        findings.problem(part.origin(), "mass_balance", message, expected);
    }
    let place_ft = centre.map_or([0.0; 3], |it| unit::place_ft(it, findings));
    Point { slugs: pounds / unit::SLUG_LB, place_ft }
}

/// A mass that an element says.
fn point(element: Element<'_, '_>, weight: &str, findings: &mut Findings) -> Point {
    let pounds = element.child(weight).map_or(0.0, |it| unit::number(it, unit::WEIGHT, findings));
    if pounds < 0.0 {
        findings.problem(element.origin(), element.name(), "a negative mass", "0 or more");
    }
    let place = element.child("location");
    let place_ft = place.map_or([0.0; 3], |it| unit::place_ft(it, findings));
    Point { slugs: pounds / unit::SLUG_LB, place_ft }
}

/// The fuel that is in the tanks at the start.
fn fuel(root: Element<'_, '_>, findings: &mut Findings) -> Vec<Point> {
    let Some(part) = root.child("propulsion") else { return Vec::new() };
    if part.attribute("file").is_some() {
        part.leave_out("it is in a file of its own, and its fuel is no part of the mass", findings);
    }
    let tanks = part.elements().filter(|it| it.name() == "tank");
    let points: Vec<_> = tanks.map(|tank| filled(tank, findings)).collect();
    let pounds = points.iter().map(|point| point.slugs).sum::<f64>() * unit::SLUG_LB;
    if pounds > 0.0 {
        let message = format!("{pounds:.0} lb of fuel stay in the tanks, each a point");
        findings.note(part.origin(), message);
    }
    points
}

/// What is in a tank, at its place.
fn filled(tank: Element<'_, '_>, findings: &mut Findings) -> Point {
    // With each of these JSBSim has another centre of mass or inertia than that of a point.
    for name in ["drain_location", "grain_config", "inertia_factor"] {
        if let Some(part) = tank.child(name) {
            part.refuse("tank", "<location>, at which the contents are a point", findings);
        }
    }
    let point = point(tank, "contents", findings);
    let pounds = point.slugs * unit::SLUG_LB;
    let capacity = tank.child("capacity").filter(|_| pounds > 0.0);
    let capacity_lb = capacity.map_or(0.0, |it| unit::number(it, unit::WEIGHT, findings));
    // Units are rounded in JSBSim, so that a full tank may be so in one unit and not in another.
    if pounds > capacity_lb * (1.0 + 1e-6) {
        let message = format!(
            "its contents of {pounds:.2} lb are more than its capacity of {capacity_lb:.2} lb"
        );
        findings.problem(tank.origin(), tank.name(), message, "a capacity for the contents");
    }
    point
}

/// Inertia of the empty aircraft about its own centre of mass.
///
/// Files have the element of the matrix in forward, right and down for `ixz`, which is the negative of the product, and the
/// products for `ixy` and `iyz`; all with the other sign where `negated_crossproduct_inertia` is false.
fn own(part: Element<'_, '_>, findings: &mut Findings) -> ([f64; 3], [f64; 3]) {
    let turned = part.optional("negated_crossproduct_inertia").eq_ignore_ascii_case("false");
    let sign = if turned { -1.0 } else { 1.0 };
    let mut inertia =
        |name: &str| part.child(name).map_or(0.0, |it| unit::number(it, unit::INERTIA, findings));
    let moments = ["ixx", "iyy", "izz"].map(&mut inertia);
    let [xy, yz, xz] = ["ixy", "iyz", "ixz"].map(&mut inertia);
    (moments, [sign * xy, sign * yz, -sign * xz])
}

/// The body without what is right or left of its plane of symmetry.
fn symmetric(mass: Mass, part: Element<'_, '_>, findings: &mut Findings) -> Mass {
    let [xy, yz, zx] = mass.products;
    let [forward, right, down] = mass.centre_ft;
    let most = mass.moments.iter().fold(0.0_f64, |most, moment| most.max(moment.abs()));
    if xy.abs().max(yz.abs()) > LOPSIDED * most || right.abs() > LOPSIDED {
        let message = format!(
            "the body is flown as symmetric: products of inertia with the right axis of {xy:.3} and {yz:.3} slug ft² and a \
             centre of mass {right:.4} ft to the right are left out"
        );
        findings.note(part.origin(), message);
    }
    Mass { centre_ft: [forward, 0.0, down], products: [0.0, 0.0, zx], ..mass }
}

impl Mass {
    /// The model of the body.
    pub(super) fn document(&self) -> Document {
        let [x, y, z] = self.centre_ft;
        let [roll, pitch, yaw] = self.moments;
        let [_, _, zx] = self.products;
        let inertia = "slugft2";
        let rows: [(&str, &str, &str, f64); 8] = [
            ("mass", "totalMass", "slug", self.slugs),
            ("ixx", "bodyMomentOfInertia_Roll", inertia, roll),
            ("iyy", "bodyMomentOfInertia_Pitch", inertia, pitch),
            ("izz", "bodyMomentOfInertia_Yaw", inertia, yaw),
            ("izx", "bodyProductOfInertia_ZX", inertia, zx),
            ("forward", "bodyPositionOfCmWrtMrc_X", "ft", x),
            ("right", "bodyPositionOfCmWrtMrc_Y", "ft", y),
            ("down", "bodyPositionOfCmWrtMrc_Z", "ft", z),
        ];
        let variables: Vec<Variable> =
            rows.map(|(id, name, units, value)| answer(id, (name, units), value)).into();
        Document { variables, ..Document::default() }
    }
}
