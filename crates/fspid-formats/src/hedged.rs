//! Fuzzy sets raised to a power or turned round: what a hedge in a conclusion makes of its set in the
//! tools that let it act on the set (MATLAB's negation, Octave, FML), not on the rule's strength.

use fspid_fuzzy::Formula;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::Membership;

use crate::number::written;

/// The set to a power, then one minus it if `negated`; nothing for sets that no formula is known for.
pub(crate) fn set(
    membership: &Membership,
    power: Option<f64>,
    negated: bool,
) -> Option<Membership> {
    let Membership::Shape { kind, params, height } = membership else { return None };
    if *height < 1.0 {
        return None;
    }
    if let (ShapeKind::Gaussian, &[centre, sigma], Some(power), false) =
        (*kind, &params[..], power, negated)
    {
        // A power of a bell is a narrower bell.
        let params = vec![centre, sigma / power.sqrt()];
        kind.check(&params).ok()?;
        return Some(Membership::Shape { kind: *kind, params, height: 1.0 });
    }
    let mut text = expression(*kind, params)?;
    if let Some(power) = power {
        text = format!("({text})^{}", written(power));
    }
    if negated {
        text = format!("1 - ({text})");
    }
    let formula = Formula::parse(&text, &["x"]).ok()?;
    Some(Membership::Formula { formula, height: 1.0 })
}

/// The grade of a shape as a formula in `x`.
fn expression(kind: ShapeKind, params: &[f64]) -> Option<String> {
    let n = |number: f64| format!("({})", written(number));
    Some(match (kind, params) {
        (ShapeKind::Triangle, &[a, b, c]) => between(&rise(a, b), &fall(b, c)),
        (ShapeKind::Trapezoid, &[a, b, c, d]) => between(&rise(a, b), &fall(c, d)),
        (ShapeKind::Singleton, &[at]) => format!("eq(x, {})", n(at)),
        (ShapeKind::Rectangle, &[a, b]) => format!("ge(x, {}) * le(x, {})", n(a), n(b)),
        (ShapeKind::LinearS, &[foot, shoulder]) => between(&rise(foot, shoulder), "1"),
        (ShapeKind::LinearZ, &[shoulder, foot]) => between("1", &fall(shoulder, foot)),
        (ShapeKind::Gaussian, &[c, s]) => format!("exp(-0.5 * ((x - {}) / {})^2)", n(c), n(s)),
        (ShapeKind::GaussianProduct, &[l, sl, r, sr]) => format!(
            "exp(-0.5 * (max(0, ({} - x) / {})^2 + max(0, (x - {}) / {})^2))",
            n(l),
            n(sl),
            n(r),
            n(sr)
        ),
        (ShapeKind::Bell, &[c, w, s]) => {
            format!("1 / (1 + abs((x - {}) / {})^{})", n(c), n(w), n(2.0 * s))
        }
        (ShapeKind::Sigmoid, &[c, s]) => sigmoid(c, s),
        (ShapeKind::SigmoidDifference, &[a, s, b, t]) => {
            format!("abs({} - {})", sigmoid(a, s), sigmoid(b, t))
        }
        (ShapeKind::SigmoidProduct, &[a, s, b, t]) => {
            format!("{} * {}", sigmoid(a, s), sigmoid(b, t))
        }
        (ShapeKind::SmoothS, &[foot, shoulder]) => smooth(&rise(foot, shoulder)),
        (ShapeKind::SmoothZ, &[shoulder, foot]) => smooth(&fall(shoulder, foot)),
        (ShapeKind::Pi, &[a, b, c, d]) => {
            format!("({}) * ({})", smooth(&rise(a, b)), smooth(&fall(c, d)))
        }
        _ => return None,
    })
}

/// Up from 0 to 1, unlimited; a jump where the ends are one.
fn rise(from: f64, to: f64) -> String {
    let [f, t] = [from, to].map(|end| format!("({})", written(end)));
    match (from.is_finite(), from < to) {
        (false, _) => "1".into(),
        (true, true) => format!("(x - {f}) / ({t} - {f})"),
        (true, false) => format!("ge(x, {t})"),
    }
}

/// Down from 1 to 0, unlimited.
fn fall(from: f64, to: f64) -> String {
    let [f, t] = [from, to].map(|end| format!("({})", written(end)));
    match (to.is_finite(), from < to) {
        (false, _) => "1".into(),
        (true, true) => format!("({t} - x) / ({t} - {f})"),
        (true, false) => format!("le(x, {f})"),
    }
}

fn between(rise: &str, fall: &str) -> String {
    format!("max(0, min(1, min({rise}, {fall})))")
}

/// Two parabolas that meet in the middle of a slope.
fn smooth(slope: &str) -> String {
    let t = format!("max(0, min(1, {slope}))");
    format!("lt({t}, 0.5) * 2 * ({t})^2 + ge({t}, 0.5) * (1 - 2 * (1 - {t})^2)")
}

/// The parameters are those of the shape: slope and centre in its own order.
fn sigmoid(centre: f64, slope: f64) -> String {
    format!("1 / (1 + exp(({}) * (x - ({}))))", written(-slope), written(centre))
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [ShapeKind; 15] = [
        ShapeKind::Triangle,
        ShapeKind::Trapezoid,
        ShapeKind::Singleton,
        ShapeKind::Rectangle,
        ShapeKind::LinearS,
        ShapeKind::LinearZ,
        ShapeKind::Gaussian,
        ShapeKind::GaussianProduct,
        ShapeKind::Bell,
        ShapeKind::Sigmoid,
        ShapeKind::SigmoidDifference,
        ShapeKind::SigmoidProduct,
        ShapeKind::SmoothS,
        ShapeKind::SmoothZ,
        ShapeKind::Pi,
    ];

    #[test]
    fn a_set_to_a_power_is_the_power_of_its_grades() {
        for kind in KINDS {
            let params = kind.example().to_vec();
            let shape = Membership::Shape { kind, params: params.clone(), height: 1.0 };
            for (power, negated) in [(Some(2.0), false), (Some(0.5), true), (None, true)] {
                let found = set(&shape, power, negated).expect("a set");
                for step in -400..=400_i32 {
                    let x = f64::from(step) / 64.0;
                    let grade = kind.grade(&params, x).powf(power.unwrap_or(1.0));
                    let wanted = if negated { 1.0 - grade } else { grade };
                    let got = found.grade(x, &[], &mut [0.0; 8]);
                    // The formula may take its steps in another order: some units in the last place.
                    let error = (got - wanted).abs();
                    assert!(error < 1e-14, "{} {x}: {got} for {wanted}", kind.name());
                }
            }
        }
    }

    #[test]
    fn sides_that_never_end_and_sets_of_no_width_have_a_formula_too() {
        let infinite = [f64::NEG_INFINITY, f64::NEG_INFINITY, 0.0, 1.0];
        for (kind, params) in [
            (ShapeKind::Trapezoid, infinite.to_vec()),
            (ShapeKind::Triangle, vec![0.0, 0.0, 1.0]),
            (ShapeKind::SmoothS, vec![1.0, 1.0]),
        ] {
            let shape = Membership::Shape { kind, params: params.clone(), height: 1.0 };
            let found = set(&shape, Some(2.0), false).expect("a set");
            for x in [-7.0, -0.25, 0.0, 0.5, 1.0, 1.5] {
                let (got, grade) = (found.grade(x, &[], &mut [0.0; 8]), kind.grade(&params, x));
                assert!((got - grade * grade).abs() < 1e-15, "{} {x}", kind.name());
            }
        }
    }
}
