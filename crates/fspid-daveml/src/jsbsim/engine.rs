//! An engine of a constant largest thrust, which stands for those of the file.

use crate::document::{Document, Role, Variable};
use crate::finding::{Findings, Origin};
use crate::formula::parse;
use crate::jsbsim::answer;
use crate::jsbsim::body::Mass;
use crate::xml::element::Element;

/// The model of the engine: its thrust goes with the throttle, forward, through the centre of mass.
///
/// Loads of an engine are about the moment reference centre; those of a thrust $T$ through a point $d$ from it are
/// $(0,\ d_z T,\ -d_y T)$, and $d_y = 0$.
pub(super) fn propulsion(
    root: Element<'_, '_>,
    thrust_lbf: Option<f64>,
    mass: &Mass,
    findings: &mut Findings,
) -> Option<Document> {
    let Some(thrust_lbf) = thrust_lbf else {
        let message = "engines are no tables and are left out: without a thrust to stand for them it glides, and cannot be \
                       trimmed in level flight";
        findings.note(Origin(None), message);
        return None;
    };
    if !(thrust_lbf > 0.0 && thrust_lbf.is_finite()) {
        let message = format!("a thrust of {thrust_lbf} lbf");
        findings.problem(root.origin(), "thrust", message, "a number above 0");
        return None;
    }
    let message = format!(
        "one engine of at most {thrust_lbf} lbf, the same at every speed and height, stands for those of the file; it pulls \
         forward through the centre of mass"
    );
    findings.note(Origin(None), message);
    let [_, _, down_ft] = mass.centre_ft;
    let made = |id: &str, (name, units): (&str, &str), formula: &str| Variable {
        initial: None,
        formula: parse(formula).ok(),
        ..answer(id, (name, units), 0.0)
    };
    let throttle = Variable {
        id: "throttle".to_owned(),
        name: "powerLeverAngle".to_owned(),
        units: "frac".to_owned(),
        roles: vec![Role::Control],
        ..Variable::default()
    };
    let (force, moment) = ("lbf", "ftlbf");
    let variables = vec![
        throttle,
        made("thrust", ("thrustBodyForce_X", force), &format!("times({thrust_lbf:?}, throttle)")),
        answer("right", ("thrustBodyForce_Y", force), 0.0),
        answer("down", ("thrustBodyForce_Z", force), 0.0),
        answer("roll", ("thrustBodyMoment_Roll", moment), 0.0),
        made("pitch", ("thrustBodyMoment_Pitch", moment), &format!("times({down_ft:?}, thrust)")),
        answer("yaw", ("thrustBodyMoment_Yaw", moment), 0.0),
    ];
    Some(Document { variables, ..Document::default() })
}
