//! Certificates in words.

use std::fmt;

use fspid_diagnostics::digits::to_six_decimals;
use fspid_numeric::scalar::Interval;
use fspid_proof::{Bearing, BoundedRate, Certificate, Claim, Outcome, Rechecked, Verdict};
use fspid_sim::Controller;

use super::scope::{NOT_IN_CLAIM, Told, asked_in_words};
use super::told::at_most;
use super::{Certification, Certified, DisturbanceAnswer, FamilyAnswer};

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

/// A sentence, behind what it is about.
pub(super) type Line = (&'static str, String);

/// Writes lines below each other, what they are about in a column.
pub(super) fn push_lines(out: &mut String, lines: impl IntoIterator<Item = Line>) {
    for (about, sentence) in lines {
        out.push_str(&format!("  {about:<18} {sentence}\n"));
    }
}

fn push(out: &mut String, certified: &Certified) {
    out.push_str(&format!("\n{}\n  {}\n", certified.name(), certified.headline()));
    push_lines(out, certified.lines());
}

/// The verdict on a loop: a word in capitals, and what it is about.
pub(super) struct Headline {
    pub(super) word: String,
    pub(super) detail: String,
}

impl fmt::Display for Headline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.word, self.detail)
    }
}

impl Certified {
    /// The controller, and from when on the plant is the one of the answer.
    pub(super) fn name(&self) -> String {
        match self.from_s {
            0.0 => self.controller.clone(),
            from_s => {
                format!("{}, plant from {} s on", self.controller, to_six_decimals(from_s))
            }
        }
    }

    pub(super) fn headline(&self) -> Headline {
        match &self.outcome {
            Err(reason) => Headline { word: "NOT PROVABLE".to_owned(), detail: reason.to_string() },
            Ok(outcome) => headline(self, outcome),
        }
    }

    /// What is told of the loop below its headline.
    pub(super) fn lines(&self) -> Vec<Line> {
        let Ok(outcome) = &self.outcome else { return Vec::new() };
        let mut lines = outcome_lines(outcome);
        // A proved one is among what the certificate says, whose last sentences are of what is not in its claim.
        match self.family.as_ref().and_then(FamilyAnswer::beside_the_claim) {
            Some((NOT_IN_CLAIM, it)) if lines.iter().any(|(about, _)| *about == NOT_IN_CLAIM) => {
                lines.push(("", it));
            }
            Some(line) if self.family.as_ref().is_some_and(|it| it.not_held().is_some()) => {
                lines.insert(0, line);
            }
            line => lines.extend(line),
        }
        let trouble = self.disturbances.as_ref().and_then(DisturbanceAnswer::trouble);
        lines.extend(trouble.map(|reason| ("disturbances", format!("NOT BOUNDED: {reason}"))));
        let nonlinear = self.nonlinear.as_ref().filter(|it| !it.is_proved());
        lines.extend(nonlinear.map(|it| ("nonlinear", it.text())));
        lines
    }
}

fn headline(certified: &Certified, outcome: &Outcome) -> Headline {
    let (word, detail) = match (&outcome.verdict, &outcome.instead) {
        (Verdict::Proved(certificate, _), _) => match (certified.trouble(), &certified.around) {
            (Some(trouble), _) => (
                "NOT PROVED as it flies".to_owned(),
                format!("{trouble}; proved is the pitch loop alone: {}", sentence(certificate)),
            ),
            (None, None) => {
                // What was asked beside it is told below.
                let word = if certified.is_proved() { "PROVED" } else { "PROVED IN PART" };
                (word.to_owned(), sentence(certificate))
            }
            (None, Some(_)) => {
                ("PROVED for the pitch loop alone".to_owned(), sentence(certificate))
            }
        },
        (Verdict::Refuted(certificate, rechecked), _) => {
            let bearing = certificate.bearing(rechecked);
            (refuted(bearing).to_owned(), format!("{}; {bearing}", sentence(certificate)))
        }
        (Verdict::Open, Some((certificate, _))) => (
            format!("OPEN for what the scenario asks ({})", asked_in_words(outcome.asked)),
            format!("neither proved nor refuted; proved is less: {}", sentence(certificate)),
        ),
        (Verdict::Open, None) => (
            "OPEN".to_owned(),
            "neither proved nor refuted; do not call this loop proved".to_owned(),
        ),
    };
    Headline { word, detail }
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

fn outcome_lines(outcome: &Outcome) -> Vec<Line> {
    let mut lines = Vec::new();
    lines.extend(outcome.open_because.as_ref().map(|it| ("open because", it.to_string())));
    lines.push(gains_line(outcome.bounds, found(outcome).map(|(_, rechecked)| rechecked)));
    if let Some((certificate, rechecked)) = found(outcome) {
        lines.extend(claim_lines(certificate, Some(rechecked)));
        lines.push(rechecked_line(rechecked));
    }
    lines.extend(largest(outcome).map(|text| ("output scale", text)));
    if let Some((certificate, rechecked)) = found(outcome) {
        lines.extend(Told::of(certificate, rechecked).sentences());
    }
    lines
}

/// What is said of bounds of gains within which the law does not reach every combination.
pub(super) const GAINS_REACHED: &str = "not every combination of these: those that the law reaches";

/// Between which values each gain lies, with what the re-check of a claim found of them.
pub(super) fn gains_line(bounds: [Interval; 3], rechecked: Option<&Rechecked>) -> Line {
    let [kp, ki, kd] = bounds.map(range);
    let reached = match rechecked.is_some_and(|rechecked| rechecked.gains_are_reached) {
        true => format!(" ({GAINS_REACHED})"),
        false => String::new(),
    };
    ("gains", format!("kp {kp}, ki {ki}, kd {kd}{reached}"))
}

/// How fast each gain may move; half the width of its box or more in a sample is as it likes.
fn speed_line(claim: &BoundedRate, dt_s: f64) -> Line {
    let speed = |gain: usize| {
        let ([lower, upper], change) = (claim.ends[gain], claim.changes[gain]);
        if !(change < 1.0) {
            return "as it likes".to_owned();
        }
        format!("{:.4} /s", change * 0.5 * (upper - lower) / dt_s)
    };
    let [kp, ki, kd] = [speed(0), speed(1), speed(2)];
    ("gains move", format!("at most kp {kp}, ki {ki}, kd {kd}"))
}

/// What is claimed, with what its re-check found where it holds.
pub(super) fn claim_lines(certificate: &Certificate, rechecked: Option<&Rechecked>) -> Vec<Line> {
    let dt_s = certificate.description.controller.config().dt_s;
    let remains = rechecked.is_some_and(|rechecked| rechecked.remains_rad > 0.0);
    match &certificate.claim {
        Claim::CommonQuadratic { rate, .. } | Claim::SProcedure { rate, .. } => {
            vec![rate_line(*rate, dt_s, remains)]
        }
        Claim::BoundedRate(claim) => {
            vec![rate_line(claim.rate, dt_s, remains), speed_line(claim, dt_s)]
        }
        Claim::FrozenGrowth { factor, .. } => {
            vec![("growth", format!("by a factor of at least {factor:.6} a sample"))]
        }
        Claim::SequenceGrowth { factor, .. } => {
            let factor =
                format!("by a factor of at least {factor:.6} each time the sequence is repeated");
            vec![("growth", factor)]
        }
    }
}

fn rate_line(rate: f64, dt_s: f64, remains: bool) -> Line {
    if !(rate < 1.0) {
        return ("decay", "proved without a rate".to_owned());
    }
    let time_s = time_constant_s(rate, dt_s);
    let down = if remains { ", down to what remains," } else { "" };
    let decay = format!(
        "every deviation falls{down} at least as fast as with a time constant of {time_s} s ({rate:.8} a sample)"
    );
    ("decay", decay)
}

/// The time constant of a decay per sample, as it is told, s.
pub(super) fn time_constant_s(rate: f64, dt_s: f64) -> String {
    at_most(-dt_s / libm::log(rate))
}

pub(super) fn rechecked_line(rechecked: &Rechecked) -> Line {
    let boxes = match rechecked.cells {
        1 => "one box".to_owned(),
        cells => format!("{cells} boxes"),
    };
    let inequalities = rechecked.inequalities;
    let text = format!("{inequalities} inequalities over {boxes} of gains, in interval arithmetic");
    ("re-check", text)
}

/// How much larger the effect of the supervisor may be.
fn largest(outcome: &Outcome) -> Option<String> {
    let largest = &outcome.largest;
    // What is proved beside it may be for less.
    let asked = if outcome.instead.is_some() { "for what the scenario asks, it " } else { "" };
    Some(match (largest.proved, largest.not_proved) {
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
        _ => return None,
    })
}

pub(super) fn range(bounds: Interval) -> String {
    format!("{:.4} to {:.4}", bounds.lower(), bounds.upper())
}
