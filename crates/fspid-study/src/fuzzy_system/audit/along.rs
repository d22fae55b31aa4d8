//! Findings about an output along one input.

use fspid_fuzzy::audit::{AlongInput, Statement};

use super::number::{between, percent, short};
use super::{Audit, Finding, Mark, finding};

pub(super) fn finding_of(audit: &Audit<'_>, input: usize, along: &AlongInput) -> Finding {
    let monotone = &along.monotone;
    let way = if monotone.rises { "rises" } else { "falls" };
    let (mark, first) = match &monotone.statement {
        Statement::Proved => (Mark::Holds, format!("{way} throughout")),
        Statement::Open => (Mark::Open, format!("not proved whether it {way} throughout")),
        Statement::Refuted(found) => {
            let (from, to) = (audit.point(&found.from), audit.point(&found.to));
            let (share, worst) = (percent(monotone.wrong_share), between(monotone.worst));
            let sentence = format!(
                "goes the wrong way on {share} of the range, by a slope of up to {worst}; for example it changes by {} from {from} to {to}",
                between(found.change)
            );
            (Mark::Broken, sentence)
        }
    };
    let slopes = format!(
        "slopes {} to {}, at rest {}; sector {} to {}",
        lower(along.least_slope.bounds),
        upper(along.most_slope.bounds),
        between(along.slope_at_rest),
        lower(along.sector[0].bounds),
        upper(along.sector[1].bounds)
    );
    finding(mark, format!("along {}", audit.input(input)), format!("{first}; {slopes}"))
}

/// The proved lower end of bounds, as one number.
fn lower(bounds: [f64; 2]) -> String {
    short(bounds[0])
}

/// The proved upper end of bounds, as one number.
fn upper(bounds: [f64; 2]) -> String {
    short(bounds[1])
}
