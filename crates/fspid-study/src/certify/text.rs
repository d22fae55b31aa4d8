//! Certificates in words.

use std::fmt::Write as _;

use fspid_fuzzy::scalar::Interval;
use fspid_proof::{
    BoundedRate, Certificate, Claim, Kept, Outcome, Range, Rechecked, Scope, Verdict,
};

use super::{Certification, Certified, CheckedFile};
use crate::metrics::short;
use crate::units::degrees;

impl Certification {
    /// The answer of `certify --format text`.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!("{}: stability while the gains move\n", self.scenario);
        for certified in &self.results {
            push(&mut out, certified);
        }
        out.push_str("\nNot in these proofs:\n");
        for sentence in &self.left_out {
            line(&mut out, format_args!("  {sentence}"));
        }
        out
    }
}

fn push(out: &mut String, certified: &Certified) {
    let plant = match certified.from_s {
        0.0 => String::new(),
        from_s => format!(", plant from {} s on", short(from_s)),
    };
    let name = format!("{}{plant}", certified.controller);
    match &certified.outcome {
        Err(reason) => line(out, format_args!("\n{name}\n  NOT PROVABLE: {reason}")),
        Ok(outcome) => {
            line(out, format_args!("\n{name}\n  {}", headline(outcome)));
            push_outcome(out, certified, outcome);
        }
    }
}

fn headline(outcome: &Outcome) -> String {
    match &outcome.verdict {
        Verdict::Proved(certificate, _) => format!("PROVED: {}", sentence(&certificate.claim)),
        Verdict::Refuted(certificate, _) => format!("REFUTED: {}", sentence(&certificate.claim)),
        Verdict::Open if outcome.instead.is_some() => format!(
            "OPEN for the set-points and loads of this scenario, {}: neither proved nor refuted; proved for less",
            range_text(outcome.asked)
        ),
        Verdict::Open => {
            "OPEN: neither proved nor refuted; do not call this loop proved".to_owned()
        }
    }
}

/// What a claim says.
fn sentence(claim: &Claim) -> String {
    match claim {
        Claim::AnySpeed { .. } => {
            "stable for every gain that the controller can have, however fast the gains move".to_owned()
        }
        Claim::Tied { .. } => {
            "stable with gains that the law ties to error and change, as it does in flight".to_owned()
        }
        Claim::BoundedRate(_) => {
            "stable for every gain that the controller can have, as long as gains move no faster than stated"
                .to_owned()
        }
        Claim::FrozenGrowth { input: [error, change], .. } => format!(
            "unstable with gains that the supervisor really produces, standing still: those at error {error:.4}, change {change:.4}"
        ),
        Claim::SequenceGrowth { inputs, .. } => format!(
            "a sequence of {} samples of gains, all of which the supervisor can produce, lets the loop grow. This refutes arbitrary motion of the gains, not the flown loop",
            inputs.len()
        ),
    }
}

fn push_outcome(out: &mut String, certified: &Certified, outcome: &Outcome) {
    let [kp, ki, kd] = outcome.bounds.map(range);
    line(out, format_args!("  gains              kp {kp}, ki {ki}, kd {kd}"));
    let dt_s = match certified.certificate() {
        Some(certificate) => certificate.description.controller.shell().dt_s,
        None => f64::NAN,
    };
    if let Verdict::Proved(certificate, rechecked) | Verdict::Refuted(certificate, rechecked) =
        &outcome.verdict
    {
        push_claim(out, certificate, dt_s);
        push_scope(out, &certificate.scope(rechecked));
        push_rechecked(out, rechecked);
    }
    if let Some((certificate, rechecked)) = &outcome.instead {
        line(out, format_args!("  proved instead     {}", sentence(&certificate.claim)));
        push_scope(out, &certificate.scope(rechecked));
    }
    push_largest(out, outcome);
    push_limits(out, certified, outcome);
}

/// For which set-points and loads, and what remains.
fn push_scope(out: &mut String, scope: &Scope) {
    let text = match (scope.any_setpoint, scope.any_load) {
        (true, true) => "any constant set-point, any constant load".to_owned(),
        (true, false) => {
            format!("any constant set-point; loads within ±{} deg", deg(scope.range.load_rad))
        }
        (false, true) => format!(
            "constant set-points within ±{} deg, any constant load",
            deg(scope.range.setpoint_rad)
        ),
        (false, false) => range_text(scope.range),
    };
    line(out, format_args!("  set-points         {text}"));
    if scope.rest_error_rad > 0.0 {
        let error = deg(scope.rest_error_rad);
        line(
            out,
            format_args!("  error at rest      up to {error} deg stay: there is no integral"),
        );
    }
    if scope.remains_rad > 0.0 {
        let remains = deg(scope.remains_rad);
        line(
            out,
            format_args!("  remains            the pitch angle ends within {remains} deg of rest"),
        );
    }
}

fn range_text(range: Range) -> String {
    format!(
        "constant set-points within ±{} deg, constant loads within ±{} deg of elevator",
        deg(range.setpoint_rad),
        deg(range.load_rad)
    )
}

fn deg(angle_rad: f64) -> String {
    short(degrees(angle_rad))
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
    line(out, format_args!("  gains move         at most kp {kp}, ki {ki}, kd {kd}"));
}

fn push_claim(out: &mut String, certificate: &Certificate, dt_s: f64) {
    match &certificate.claim {
        Claim::AnySpeed { rate, .. } | Claim::Tied { rate, .. } => push_rate(out, *rate, dt_s),
        Claim::BoundedRate(claim) => {
            push_rate(out, claim.rate, dt_s);
            push_speed(out, claim, dt_s);
        }
        Claim::FrozenGrowth { factor, .. } => {
            line(
                out,
                format_args!("  growth             by a factor of at least {factor:.6} a sample"),
            );
        }
        Claim::SequenceGrowth { factor, .. } => {
            line(
                out,
                format_args!(
                    "  growth             by a factor of at least {factor:.6} each time the sequence is repeated"
                ),
            );
        }
    }
}

fn push_rate(out: &mut String, rate: f64, dt_s: f64) {
    if rate < 1.0 {
        let time_s = -dt_s / libm::log(rate);
        line(
            out,
            format_args!(
                "  decay              every deviation falls at least as fast as with a time constant of {time_s:.2} s ({rate:.8} a sample)"
            ),
        );
    } else {
        out.push_str("  decay              proved without a rate\n");
    }
}

fn push_rechecked(out: &mut String, rechecked: &Rechecked) {
    line(
        out,
        format_args!(
            "  re-check           {} inequalities over {} boxes of gains, in interval arithmetic",
            rechecked.inequalities, rechecked.cells
        ),
    );
}

fn push_largest(out: &mut String, outcome: &Outcome) {
    let largest = &outcome.largest;
    let text = match (largest.proved, largest.not_proved) {
        (proved, Some(above)) if proved > 0.0 => format!(
            "can be proved up to {} times the supervisor's output scale (not for {})",
            short(proved),
            short(above)
        ),
        (proved, None) if proved > 1.0 => {
            format!("can be proved for {} times the supervisor's output scale", short(proved))
        }
        (_, Some(above)) => format!("not proved even for {} of it", short(above)),
        _ => return,
    };
    line(out, format_args!("  output scale       {text}"));
}

fn push_limits(out: &mut String, certified: &Certified, outcome: &Outcome) {
    if certified.limits.is_empty() {
        return;
    }
    let limits = certified.limits.join(", ");
    let text = match (outcome.pitch_within_rad, outcome.limits_left_out) {
        (Some(pitch_rad), _) => format!(
            "with a pitch angle off by up to {:.3} deg, all else at rest, none acts: {limits}",
            degrees(pitch_rad)
        ),
        (None, Some(reason)) => format!("SATURATION IS NOT COVERED: {limits}; {reason}"),
        (None, None) => format!("SATURATION IS NOT COVERED: {limits}"),
    };
    line(out, format_args!("  limits             {text}"));
}

fn range(bounds: Interval) -> String {
    format!("{:.4} to {:.4}", bounds.lower(), bounds.upper())
}

impl CheckedFile {
    /// The answer of `certify --check`.
    #[must_use]
    pub fn text(&self) -> String {
        let origin = &self.origin;
        let mut out = format!(
            "{} of \"{}\": {}\n",
            origin.controller,
            origin.scenario,
            sentence(&self.certificate.claim)
        );
        let dt_s = self.certificate.description.controller.shell().dt_s;
        push_claim(&mut out, &self.certificate, dt_s);
        if (self.certificate.output_factor - 1.0).abs() > 0.0 {
            let factor = self.certificate.output_factor;
            line(
                &mut out,
                format_args!("  output scale       {factor} times that of the controller"),
            );
        }
        match &self.result {
            Ok(rechecked) => {
                push_rechecked(&mut out, rechecked);
                push_kept(&mut out, &self.certificate, rechecked);
                let [kp, ki, kd] = rechecked.bounds.map(range);
                line(&mut out, format_args!("  gains              kp {kp}, ki {ki}, kd {kd}"));
                out.push_str("HOLDS\n");
            }
            Err(doubt) => line(&mut out, format_args!("DOES NOT HOLD: {doubt}")),
        }
        out
    }
}

/// Whether the law of the loop keeps its gains to the rate that is claimed.
fn push_kept(out: &mut String, certificate: &Certificate, rechecked: &Rechecked) {
    if !matches!(certificate.claim, Claim::BoundedRate(_)) {
        return;
    }
    let kept = match rechecked.kept {
        Some(Kept::Everywhere) => "in every flight",
        Some(Kept::WithinLevel) => "in flights that begin near enough to rest",
        None => "not shown: this is no proof of the flown loop",
    };
    line(out, format_args!("  law keeps to this  {kept}"));
}

/// Writing to a string cannot fail.
fn line(out: &mut String, text: std::fmt::Arguments<'_>) {
    let _ = writeln!(out, "{text}");
}
