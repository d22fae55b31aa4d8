//! Certificates in words.

use fspid_diagnostics::digits::to_six_decimals;
use fspid_numeric::scalar::Interval;
use fspid_proof::{Bearing, BoundedRate, Certificate, Claim, Outcome, Rechecked, Verdict};
use fspid_sim::Controller;

use super::scope::{Told, asked_in_words};
use super::told::at_most;
use super::{Certification, Certified, DisturbanceAnswer};

impl Certification {
    /// The answer of `certify --format text`.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!("{}: stability while the gains move\n", self.scenario);
        for certified in &self.results {
            push(&mut out, certified);
        }
        out
    }
}

fn push(out: &mut String, certified: &Certified) {
    let plant = match certified.from_s {
        0.0 => String::new(),
        from_s => format!(", plant from {} s on", to_six_decimals(from_s)),
    };
    let name = format!("{}{plant}", certified.controller);
    match &certified.outcome {
        Err(reason) => out.push_str(&format!("\n{name}\n  NOT PROVABLE: {reason}\n")),
        Ok(outcome) => {
            out.push_str(&format!("\n{name}\n  {}\n", headline(certified, outcome)));
            push_outcome(out, certified, outcome);
            // A proved one is among what the certificate says.
            if let Some(family) = certified.family.as_ref().filter(|it| !it.is_proved()) {
                out.push_str(&format!("  family             {}\n", family.text()));
            }
            let trouble = certified.disturbances.as_ref().and_then(DisturbanceAnswer::trouble);
            if let Some(reason) = trouble {
                out.push_str(&format!("  disturbances       NOT BOUNDED: {reason}\n"));
            }
            if let Some(nonlinear) = certified.nonlinear.as_ref().filter(|it| !it.is_proved()) {
                out.push_str(&format!("  nonlinear          {}\n", nonlinear.text()));
            }
        }
    }
}

fn headline(certified: &Certified, outcome: &Outcome) -> String {
    match (&outcome.verdict, &outcome.instead) {
        (Verdict::Proved(certificate, _), _) => match (certified.trouble(), &certified.around) {
            (Some(trouble), _) => format!(
                "NOT PROVED as it flies: {trouble}; proved is the pitch loop alone: {}",
                sentence(certificate)
            ),
            (None, None) => format!("PROVED: {}", sentence(certificate)),
            (None, Some(_)) => {
                format!("PROVED for the pitch loop alone: {}", sentence(certificate))
            }
        },
        (Verdict::Refuted(certificate, rechecked), _) => {
            let bearing = certificate.bearing(rechecked);
            format!("{}: {}; {bearing}", refuted(bearing), sentence(certificate))
        }
        (Verdict::Open, Some((certificate, _))) => format!(
            "OPEN for what the scenario asks ({}): neither proved nor refuted; proved is less: {}",
            asked_in_words(outcome.asked),
            sentence(certificate)
        ),
        (Verdict::Open, None) => {
            "OPEN: neither proved nor refuted; do not call this loop proved".to_owned()
        }
    }
}

/// True of a loop whose gains do not move.
pub(super) fn is_fixed(certificate: &Certificate) -> bool {
    matches!(certificate.description.controller, Controller::Fixed(_))
}

/// What an outcome has a certificate of.
pub(super) fn found(outcome: &Outcome) -> Option<(&Certificate, &Rechecked)> {
    match &outcome.verdict {
        Verdict::Proved(certificate, rechecked) | Verdict::Refuted(certificate, rechecked) => {
            Some((certificate, rechecked))
        }
        Verdict::Open => {
            outcome.instead.as_ref().map(|(certificate, rechecked)| (certificate, rechecked))
        }
    }
}

/// What is refuted, in capitals.
pub(super) fn refuted(bearing: Bearing) -> &'static str {
    match bearing {
        Bearing::GrowsStandingStill => "REFUTED FOR GAINS THAT STAND STILL",
        Bearing::GrowsInSomeOrder => "REFUTED FOR GAINS THAT MOVE IN ANY ORDER",
        Bearing::Grows
        | Bearing::Stable
        | Bearing::PitchLoopStable
        | Bearing::OtherScale { .. }
        | Bearing::RateNotKept => "REFUTED",
    }
}

/// What a claim says.
pub(super) fn sentence(certificate: &Certificate) -> String {
    match &certificate.claim {
        Claim::CommonQuadratic { .. } if is_fixed(certificate) => {
            "stable with its gains, which are fixed".to_owned()
        }
        Claim::CommonQuadratic { .. } => {
            "stable for every gain that the controller can have, however fast the gains move".to_owned()
        }
        Claim::SProcedure { .. } => {
            "stable with gains that the law ties to error and change, as it does in flight".to_owned()
        }
        Claim::BoundedRate(_) => {
            "stable for every gain that the controller can have, as long as gains move no faster than stated"
                .to_owned()
        }
        Claim::FrozenGrowth { .. } | Claim::SequenceGrowth { .. } if is_fixed(certificate) => {
            "unstable with its gains, which are fixed".to_owned()
        }
        Claim::FrozenGrowth { input: [0.0, 0.0], .. } => {
            "unstable with the gains that it has at rest".to_owned()
        }
        Claim::FrozenGrowth { input: [error, change], .. } => format!(
            "unstable with gains that the supervisor produces at error {error:.4}, change {change:.4}, if they stand still"
        ),
        Claim::SequenceGrowth { inputs, .. } => format!(
            "a sequence of {} samples of gains, all of which the supervisor can produce, lets the loop grow",
            inputs.len()
        ),
    }
}

fn push_outcome(out: &mut String, certified: &Certified, outcome: &Outcome) {
    if let Some(reason) = &outcome.open_because {
        out.push_str(&format!("  open because       {reason}\n"));
    }
    let [kp, ki, kd] = outcome.bounds.map(range);
    out.push_str(&format!("  gains              kp {kp}, ki {ki}, kd {kd}\n"));
    let dt_s = match certified.certificate() {
        Some(certificate) => certificate.description.controller.config().dt_s,
        None => f64::NAN,
    };
    if let Some((certificate, rechecked)) = found(outcome) {
        push_claim(out, certificate, Some(rechecked), dt_s);
        push_rechecked(out, rechecked);
    }
    push_largest(out, outcome);
    if let Some((certificate, rechecked)) = found(outcome) {
        Told::of(certificate, rechecked).push(out);
    }
}

/// How fast each gain may move; half the width of its box or more in a sample is as it likes.
fn push_speed(out: &mut String, claim: &BoundedRate, dt_s: f64) {
    let speed = |gain: usize| {
        let ([lower, upper], change) = (claim.ends[gain], claim.changes[gain]);
        if !(change < 1.0) {
            return "as it likes".to_owned();
        }
        format!("{:.4} /s", change * 0.5 * (upper - lower) / dt_s)
    };
    let [kp, ki, kd] = [speed(0), speed(1), speed(2)];
    out.push_str(&format!("  gains move         at most kp {kp}, ki {ki}, kd {kd}\n"));
}

/// What is claimed, with what its re-check found where it holds.
pub(super) fn push_claim(
    out: &mut String,
    certificate: &Certificate,
    rechecked: Option<&Rechecked>,
    dt_s: f64,
) {
    let remains = rechecked.is_some_and(|rechecked| rechecked.remains_rad > 0.0);
    match &certificate.claim {
        Claim::CommonQuadratic { rate, .. } | Claim::SProcedure { rate, .. } => {
            push_rate(out, *rate, dt_s, remains);
        }
        Claim::BoundedRate(claim) => {
            push_rate(out, claim.rate, dt_s, remains);
            push_speed(out, claim, dt_s);
        }
        Claim::FrozenGrowth { factor, .. } => {
            out.push_str(&format!(
                "  growth             by a factor of at least {factor:.6} a sample\n"
            ));
        }
        Claim::SequenceGrowth { factor, .. } => {
            out.push_str(&format!(
                "  growth             by a factor of at least {factor:.6} each time the sequence is repeated\n"
            ));
        }
    }
}

fn push_rate(out: &mut String, rate: f64, dt_s: f64, remains: bool) {
    if rate < 1.0 {
        let time_s = at_most(-dt_s / libm::log(rate));
        let down = if remains { ", down to what remains," } else { "" };
        out.push_str(&format!(
            "  decay              every deviation falls{down} at least as fast as with a time constant of {time_s} s ({rate:.8} a sample)\n"
        ));
    } else {
        out.push_str("  decay              proved without a rate\n");
    }
}

pub(super) fn push_rechecked(out: &mut String, rechecked: &Rechecked) {
    let boxes = match rechecked.cells {
        1 => "one box".to_owned(),
        cells => format!("{cells} boxes"),
    };
    out.push_str(&format!(
        "  re-check           {} inequalities over {boxes} of gains, in interval arithmetic\n",
        rechecked.inequalities
    ));
}

fn push_largest(out: &mut String, outcome: &Outcome) {
    let largest = &outcome.largest;
    // What is proved beside it may be for less.
    let asked = if outcome.instead.is_some() { "for what the scenario asks, it " } else { "" };
    let text = match (largest.proved, largest.not_proved) {
        (proved, Some(above)) if proved > 0.0 => format!(
            "{asked}can be proved up to {} times the supervisor's output scale (not for {})",
            to_six_decimals(proved),
            to_six_decimals(above)
        ),
        (proved, None) if proved > 1.0 => {
            format!(
                "{asked}can be proved for {} times the supervisor's output scale",
                to_six_decimals(proved)
            )
        }
        (_, Some(above)) => {
            format!("{asked}is not proved even for {} of it", to_six_decimals(above))
        }
        _ => return,
    };
    out.push_str(&format!("  output scale       {text}\n"));
}

pub(super) fn range(bounds: Interval) -> String {
    format!("{:.4} to {:.4}", bounds.lower(), bounds.upper())
}
