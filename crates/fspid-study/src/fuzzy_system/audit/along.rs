//! Findings about an output along one input.

use fspid_fuzzy::audit::{AlongInput, Statement};

use super::number::{about, between, between_about, percent};
use super::{Audit, Finding, Mark, finding};

/// Whether the output goes one way along an input, and the slopes.
pub(super) fn findings_of(
    audit: &Audit<'_>,
    input: usize,
    along: &AlongInput,
    meant: bool,
    unit: f64,
) -> [Finding; 2] {
    let name = audit.input(input);
    let (mark, way) = direction(audit, along, meant);
    let slope = unit / audit.span(input);
    let slopes = format!(
        "from {} to {}, at rest {}; seen from rest the output lies in the sector from {} to {}",
        lower(along.least_slope.bounds, slope),
        upper(along.most_slope.bounds, slope),
        between_about(along.slope_at_rest, slope),
        lower(along.sector[0].bounds, slope),
        upper(along.sector[1].bounds, slope)
    );
    let settled = along.least_slope.settled && along.most_slope.settled;
    let of_slopes = if settled { Mark::Holds } else { Mark::Open };
    [
        finding(mark, format!("along {name}"), way),
        finding(of_slopes, format!("slopes along {name}"), slopes),
    ]
}

/// `meant` says that the labels go one way without exception.
fn direction(audit: &Audit<'_>, along: &AlongInput, meant: bool) -> (Mark, String) {
    let monotone = &along.monotone;
    let way = if monotone.rises { "rises" } else { "falls" };
    let found = match &monotone.statement {
        Statement::Proved => return (Mark::Holds, format!("{way} throughout")),
        Statement::Open => return (Mark::Open, format!("not proved whether it {way} throughout")),
        Statement::Refuted(found) => found,
    };
    let (from, to) = (audit.point(&found.from), audit.point(&found.to));
    let (share, worst) = (percent(monotone.wrong_share), between(monotone.worst));
    let other = if monotone.rises { "falls" } else { "rises" };
    let change = between(found.change);
    let sentence = format!(
        "{way} for the most part, but {other} on {share} of the range, with a slope of up to {worst}; for example by {change} from {from} to {to}"
    );
    match meant {
        true => (Mark::NotMeant, format!("{sentence}; the labels go one way without exception")),
        false => (Mark::Worth, sentence),
    }
}

/// The proved lower end of bounds, as one number.
fn lower(bounds: [f64; 2], scale: f64) -> String {
    about(bounds[0], scale)
}

/// The proved upper end of bounds, as one number.
fn upper(bounds: [f64; 2], scale: f64) -> String {
    about(bounds[1], scale)
}
