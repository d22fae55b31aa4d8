//! How far a surface goes: what the component that makes its position makes of the largest commands.
//!
//! # Source
//! Positions that JSBSim 1.3.3 shows for commands of -1 and 1: a `<clipto>` acts last, and counts where it has both ends
//! and they are in order; a `<domain>` clips nothing.

use crate::finding::Origin;
use crate::jsbsim::surface::{domain, ends, is_whole, is_zero_centered, made, parts};
use crate::xml::element::Element;

/// Most components behind each other that are followed.
const MAX_FOLLOWED: usize = 8;

/// Two ends, the smaller first.
type Ends = (f64, f64);

/// Why nobody can tell how far a surface goes, and where the file says it.
pub(super) struct Untold {
    pub(super) at: Origin,
    pub(super) message: String,
}

/// Ends of what a component makes, in its own units; `None` where nothing in it and before it ends it.
pub(super) fn reach(root: Element<'_, '_>, part: Element<'_, '_>) -> Result<Option<Ends>, Untold> {
    followed(root, part, MAX_FOLLOWED)
}

fn followed(
    root: Element<'_, '_>,
    part: Element<'_, '_>,
    left: usize,
) -> Result<Option<Ends>, Untold> {
    let clip = clip(part)?;
    let Some(left) = left.checked_sub(1) else { return Ok(clip) };
    let free = match part.name() {
        "aerosurface_scale" => scaled(root, part, left)?,
        // What lags comes to rest at what enters it.
        "lag_filter" | "actuator" => entering(root, part, left)?,
        "pure_gain" => {
            let entering = entering(root, part, left)?;
            entering.zip(gain(part)).map(|((min, max), gain)| in_order(gain * min, gain * max))
        }
        _ => None,
    };
    Ok(match (free, clip) {
        (Some((min, max)), Some((low, high))) => {
            Some((min.max(low).min(high), max.max(low).min(high)))
        }
        (free, clip) => free.or(clip),
    })
}

/// Ends of an `<aerosurface_scale>` before its clip: its range, where what enters it goes as far as its domain.
fn scaled(
    root: Element<'_, '_>,
    part: Element<'_, '_>,
    left: usize,
) -> Result<Option<Ends>, Untold> {
    let Some((range, gain)) = ends(part, "range").zip(gain(part)) else { return Ok(None) };
    let untold = |message: String| Untold { at: part.origin(), message };
    let wrong =
        || untold("the ends of its <aerosurface_scale> are no numbers that can be used".to_owned());
    let domain = domain(part).ok_or_else(wrong)?;
    let entering = entering(root, part, left)?;
    let is_usual = (domain.0 + 1.0).abs() < 1e-9 && (domain.1 - 1.0).abs() < 1e-9;
    let Some((min, max)) = entering.or(is_usual.then_some((-1.0, 1.0))) else {
        let (down, up) = domain;
        return Err(untold(format!(
            "the <domain> of its <aerosurface_scale> is {down} to {up}, and nothing says how far goes what enters it"
        )));
    };
    let is_centered = is_zero_centered(part);
    let at = |entering: f64| match (is_centered, entering < 0.0) {
        (true, true) => entering * range.0 / domain.0,
        (true, false) => entering * range.1 / domain.1,
        (false, _) => range.0 + (entering - domain.0) * (range.1 - range.0) / (domain.1 - domain.0),
    };
    let (one, other) = (gain * at(min), gain * at(max));
    if one.is_finite() && other.is_finite() { Ok(Some(in_order(one, other))) } else { Err(wrong()) }
}

/// Ends of the only input of a component.
fn entering(
    root: Element<'_, '_>,
    part: Element<'_, '_>,
    left: usize,
) -> Result<Option<Ends>, Untold> {
    let inputs: Vec<_> = part.elements().filter(|it| it.name() == "input").collect();
    let [input] = inputs.as_slice() else { return Ok(None) };
    let text = input.prose();
    let (is_turned, name) =
        text.strip_prefix('-').map_or((false, text.as_str()), |name| (true, name.trim()));
    let ends = if name.ends_with("-cmd-norm") {
        Some((-1.0, 1.0))
    } else {
        let makers: Vec<_> = parts(root).filter(|it| made(*it).contains(name)).collect();
        match makers.as_slice() {
            [maker] => followed(root, *maker, left)?,
            _ => None,
        }
    };
    Ok(ends.map(|(min, max)| if is_turned { (-max, -min) } else { (min, max) }))
}

/// The ends of a `<clipto>`.
fn clip(part: Element<'_, '_>) -> Result<Option<Ends>, Untold> {
    let Some(clip) = part.child("clipto").filter(|clip| is_whole(*clip)) else { return Ok(None) };
    match ends(part, "clipto") {
        Some((min, max)) => Ok((min <= max).then_some((min, max))),
        None => {
            let message = "the ends of its <clipto> are no numbers".to_owned();
            Err(Untold { at: clip.origin(), message })
        }
    }
}

/// The gain of a component; `None` where it is no number.
fn gain(part: Element<'_, '_>) -> Option<f64> {
    part.child("gain").map_or(Some(1.0), |gain| gain.prose().parse::<f64>().ok())
}

fn in_order(one: f64, other: f64) -> Ends {
    (one.min(other), one.max(other))
}
