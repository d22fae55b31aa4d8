//! The nonlinear aircraft near its trim: of which scenarios something is asked, and what the answer says.

use fspid_aircraft::enclosure::MotionNumbers;
use fspid_diagnostics::digits::to_six_decimals;
use fspid_numeric::scalar::Interval;
use fspid_proof::{
    Begun, Certificate, CheckedNonlinear, Claim, Effort, Nonlinear, NonlinearVerdict, NotProvable,
    Outcome, Reach, Rechecked, Verdict, prove_nonlinear,
};
use fspid_scenario::file::{FlownDerivatives, Study};
use fspid_scenario::units::{FOOT_M, degrees};
use fspid_sim::Plant;
use fspid_sim::aircraft::Forces;
use serde_json::{Value, json};

use super::told::at_most;

/// Heights above and below the trim over which the air is enclosed, the first that is proved and whose flights come nearer to
/// the trim than they may begin: without one the air has
/// everywhere the density of the trim. Chosen, not derived: nothing that was tried is proved over 30 m (decision 58).
const HEIGHTS_M: [f64; 2] = [10.0, 0.0];

/// What came of the nonlinear aircraft.
#[derive(Clone, Debug)]
pub enum NonlinearAnswer {
    /// Proved or open.
    Verdict(Box<NonlinearVerdict>, Box<Certificate>),
    /// No question can be asked.
    None(NoNonlinear),
    /// The loop around the linear model is not proved, so that nothing is asked of the nonlinear one.
    LinearNotProved,
}

/// Why no question can be asked of the nonlinear aircraft.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoNonlinear {
    /// What flies is a linear plant.
    #[error("what flies is a linear plant; an [aircraft] with model = \"nonlinear\" is asked for")]
    Linear,
    /// What flies is another simulator.
    #[error("what flies is another simulator, whose equations are not known")]
    OtherSimulator,
    /// Something is added to the derivatives.
    #[error(
        "configurations, fuel, Mach rows or the ground add to the aircraft's derivatives, and are not enclosed"
    )]
    Varied,
    /// The forces are no derivatives.
    #[error("the aircraft's forces are tables or formulas, and only derivatives are enclosed")]
    NoDerivatives,
    /// Outer loops move set-point and throttle.
    #[error(
        "outer loops move the set-point and may move the throttle, which stand still in the claim"
    )]
    OuterLoops,
    /// Numbers that are none, of a trim beyond the atmosphere.
    #[error("the trim has no finite numbers")]
    NoNumbers,
}

impl NonlinearAnswer {
    /// True if something is proved of the nonlinear aircraft.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        matches!(self, Self::Verdict(verdict, _) if matches!(**verdict, NonlinearVerdict::Proved(..)))
    }

    /// The answer in a line, with what is proved but not of what nothing is said.
    pub(super) fn in_short(&self) -> String {
        match self {
            Self::Verdict(verdict, certificate) => match &**verdict {
                NonlinearVerdict::Proved(claim, checked) => {
                    format!("PROVED: {}", in_short(certificate, claim, checked))
                }
                NonlinearVerdict::Open(_) => self.text(),
            },
            Self::None(_) | Self::LinearNotProved => self.text(),
        }
    }

    /// The answer in capitals, and why.
    pub(super) fn text(&self) -> String {
        match self {
            Self::LinearNotProved => {
                "OPEN: the loop around the linear model is not proved".to_owned()
            }
            Self::None(reason) => format!("OPEN: {reason}"),
            Self::Verdict(verdict, certificate) => match &**verdict {
                NonlinearVerdict::Proved(claim, checked) => {
                    format!("PROVED: {}", sentence(certificate, claim, checked))
                }
                NonlinearVerdict::Open(reason) => format!("OPEN: {reason}"),
            },
        }
    }
}

/// The numbers of the aircraft that a study flies, where the claim can speak of it.
pub(super) fn numbers(study: &Study, height_m: f64) -> Result<MotionNumbers, NoNonlinear> {
    let scenario = &study.scenario;
    let aircraft = match &scenario.plant {
        Plant::Aircraft(plant) => plant.aircraft(),
        Plant::External(_) => return Err(NoNonlinear::OtherSimulator),
        _ => return Err(NoNonlinear::Linear),
    };
    if scenario.autopilot.is_some() {
        return Err(NoNonlinear::OuterLoops);
    }
    match aircraft.model() {
        Forces::Derivatives(_) => {}
        Forces::Varied(_) => return Err(NoNonlinear::Varied),
        _ => return Err(NoNonlinear::NoDerivatives),
    }
    let FlownDerivatives { data, laws, environment, target } =
        study.derivatives.as_ref().ok_or(NoNonlinear::NoDerivatives)?;
    let numbers = MotionNumbers::of(data, *laws, (*environment, height_m), *target);
    let finite = numbers.density_kg_m3.is_finite() && numbers.mass_kg.is_finite();
    finite.then_some(numbers).ok_or(NoNonlinear::NoNumbers)
}

/// Heights that are tried beside a linear claim: where that has no form for all gains, the nonlinear aircraft hardly has one,
/// and is asked in the air that asks least.
fn heights(claim: &Claim) -> &'static [f64] {
    let at = if matches!(claim, Claim::BoundedRate(_)) { HEIGHTS_M.len() - 1 } else { 0 };
    &HEIGHTS_M[at..]
}

/// Who proves, and knows what was asked before: cases that differ in what is commanded alone have one aircraft.
#[derive(Clone, Debug, Default)]
pub(super) struct Prove {
    known: Vec<(Certificate, MotionNumbers, NonlinearVerdict)>,
}

impl Prove {
    fn of(
        &mut self,
        certificate: &Certificate,
        aircraft: &MotionNumbers,
        effort: &Effort,
    ) -> Result<NonlinearVerdict, NotProvable> {
        let mut known = self.known.iter();
        if let Some((.., found)) = known.find(|it| it.0 == *certificate && it.1 == *aircraft) {
            return Ok(found.clone());
        }
        let found = prove_nonlinear(certificate, aircraft, effort)?;
        self.known.push((certificate.clone(), *aircraft, found.clone()));
        Ok(found)
    }
}

/// Certifies the nonlinear aircraft beside the verdict of its linear loop, whose certificate then speaks of both.
///
/// # Errors
/// [`NotProvable`] where the effort was stopped.
pub(super) fn certified(
    study: &Study,
    outcome: &mut Outcome,
    prove: &mut Prove,
    effort: &Effort,
) -> Result<NonlinearAnswer, NotProvable> {
    let Verdict::Proved(certificate, rechecked) = &outcome.verdict else {
        return Ok(match numbers(study, 0.0) {
            Ok(_) => NonlinearAnswer::LinearNotProved,
            Err(none) => NonlinearAnswer::None(none),
        });
    };
    let mut verdict = None;
    for height_m in heights(&certificate.claim) {
        let aircraft = match numbers(study, *height_m) {
            Ok(aircraft) => aircraft,
            Err(none) => return Ok(NonlinearAnswer::None(none)),
        };
        let found = prove.of(certificate, &aircraft, effort)?;
        let ends = comes_nearer(&found);
        // What is proved of several densities is kept where it is not of one.
        if verdict.is_none() || matches!(found, NonlinearVerdict::Proved(..)) {
            verdict = Some(found);
        }
        if ends {
            break;
        }
    }
    let Some(verdict) = verdict else { return Ok(NonlinearAnswer::LinearNotProved) };
    let answer = NonlinearAnswer::Verdict(Box::new(verdict.clone()), Box::new(certificate.clone()));
    if let NonlinearVerdict::Proved(claim, checked) = verdict {
        let whole = Certificate { nonlinear: Some(*claim), ..certificate.clone() };
        let rechecked = Rechecked { nonlinear: Some(checked), ..rechecked.clone() };
        outcome.verdict = Verdict::Proved(whole, rechecked);
    }
    Ok(answer)
}

/// True for a proof whose flights end nearer to the trim than they may begin.
fn comes_nearer(found: &NonlinearVerdict) -> bool {
    let NonlinearVerdict::Proved(_, CheckedNonlinear { remains, pitch_within_rad, .. }) = found
    else {
        return false;
    };
    let [pitch_rad, ..] = remains;
    pitch_rad < pitch_within_rad
}

/// What a proved claim says, with everything that it does not speak of.
pub(super) fn sentence(
    certificate: &Certificate,
    claim: &Nonlinear,
    checked: &CheckedNonlinear,
) -> String {
    format!(
        "the equations of motion themselves: a flight that begins in the certified ellipsoid{begun}, so {stays}, at samples and between them, meets no limit, {comes}{decay}; {conditions}",
        begun = begun(claim.begun, checked),
        stays = stays(&claim.reach, checked),
        comes = comes(checked),
        decay = decay(certificate, claim),
        conditions = conditions(&air(&claim.aircraft)),
    )
}

/// A proved claim in a line, where what it does not speak of is said once for many of them.
fn in_short(certificate: &Certificate, claim: &Nonlinear, checked: &CheckedNonlinear) -> String {
    format!(
        "a flight that begins{begun}{stays}, {comes}{decay}; in still air {air}",
        begun = begun_and(claim.begun, checked),
        stays = stays(&claim.reach, checked),
        comes = comes(checked),
        decay = decay(certificate, claim),
        air = air(&claim.aircraft),
    )
}

/// What a flight has to begin with beside the ellipsoid, and the gains that it then has; nothing where it may have any gains.
fn begun(begun: Begun, checked: &CheckedNonlinear) -> String {
    if begun == Begun::Anyhow {
        return String::new();
    }
    let range = |(name, gain): (&str, &Interval)| {
        let [least, most] = [digits(gain.lower(), libm::floor), digits(gain.upper(), libm::ceil)];
        format!("{name} {least} to {most}")
    };
    let gains: Vec<String> =
        ["kp", "ki", "kd"].into_iter().zip(&checked.gains).map(range).collect();
    format!(" with the controller just reset, whose gains then lie within {}", gains.join(", "))
}

/// The same before what else it begins with.
pub(super) fn begun_and(reset_or_not: Begun, checked: &CheckedNonlinear) -> String {
    match begun(reset_or_not, checked) {
        nothing if nothing.is_empty() => " ".to_owned(),
        something => format!("{something}, "),
    }
}

/// Four digits of a number, rounded to where more is said to be possible than is.
fn digits(value: f64, rounded: fn(f64) -> f64) -> String {
    if value.abs() <= f64::MIN_POSITIVE {
        return "0".to_owned();
    }
    let last = (libm::floor(libm::log10(value.abs())) as i32 - 3).min(0);
    let tens = libm::pow(10.0, f64::from(-last));
    let shown = format!("{:.*}", usize::try_from(-last).unwrap_or(0), rounded(value * tens) / tens);
    let trimmed = if last < 0 { shown.trim_end_matches('0').trim_end_matches('.') } else { &shown };
    trimmed.to_owned()
}

/// How far a flight may begin from the trim, and which box it then does not leave.
pub(super) fn stays(reach: &Reach, checked: &CheckedNonlinear) -> String {
    let Reach { motion, command_rad } = *reach;
    let [pitch, rate, speed_m_s, alpha, elevator] = motion;
    let [pitch, rate, alpha, elevator, command] =
        [pitch, rate, alpha, elevator, command_rad].map(|it| above(degrees(it)));
    let begins = below(degrees(checked.pitch_within_rad), 3);
    let speed = format!("{} m/s ({} ft/s)", above(speed_m_s), above(speed_m_s / FOOT_M));
    format!(
        "with the pitch angle up to {begins} deg off and nothing else, stays within {pitch} deg of pitch, {rate} deg/s of pitch rate, {speed} of airspeed, {alpha} deg of angle of attack and {elevator} deg of elevator from the trim (commands within {command} deg)"
    )
}

/// How fast it comes there; nothing where no rate is proved.
fn decay(certificate: &Certificate, claim: &Nonlinear) -> String {
    let dt_s = certificate.description.controller.config().dt_s;
    match claim.rate {
        rate if rate < 1.0 => {
            let time_s = at_most(-dt_s / libm::log(rate));
            format!(" at least as fast as with a time constant of {time_s} s")
        }
        _ => String::new(),
    }
}

/// Under which conditions all that is so, and of what nothing is said.
pub(super) fn conditions(air: &str) -> String {
    format!(
        "so with the set-point at the trim, no load, sensors without bias, wings level, the throttle of the trim, still air {air}, above the ground; the steps in which a simulation integrates are not covered, and all else here is about the linear model"
    )
}

/// Where a flight ends.
pub(super) fn comes(checked: &CheckedNonlinear) -> String {
    let [pitch, _, speed_m_s, ..] = checked.remains;
    if pitch > 0.0 {
        let pitch = above(degrees(pitch));
        format!(
            "and comes to within {pitch} deg of pitch and {} m/s of airspeed of the trim",
            above(speed_m_s)
        )
    } else {
        "and comes to rest at the trim".to_owned()
    }
}

/// Which air is in the claim.
pub(super) fn air(aircraft: &MotionNumbers) -> String {
    let MotionNumbers { height_m, density_kg_m3, densities_kg_m3, .. } = aircraft;
    if *height_m > 0.0 {
        format!(
            "of any density from {} to {} kg/m³, as it has within {} m above and below the trim (the height by the word of the certificate; --against computes it) and for as long as the flight is there",
            to_six_decimals(densities_kg_m3.min),
            to_six_decimals(densities_kg_m3.max),
            to_six_decimals(*height_m),
        )
    } else {
        format!(
            "that has everywhere the density of the trim ({} kg/m³)",
            to_six_decimals(*density_kg_m3)
        )
    }
}

/// Rounded up to two decimals, so that what is said to be kept is.
fn above(value: f64) -> String {
    format!("{:.2}", libm::ceil(100.0 * value) / 100.0)
}

/// Rounded down to so many decimals, so that what is said is not more than what is proved.
fn below(value: f64, decimals: i32) -> String {
    let tens = libm::pow(10.0, f64::from(decimals));
    to_six_decimals(libm::floor(value * tens) / tens)
}

/// A proved claim for programs.
pub(super) fn proved_in_json(reach: &Reach, begun: Begun, checked: &CheckedNonlinear) -> Value {
    let [kp, ki, kd] = checked.gains.map(|gain| [gain.lower(), gain.upper()]);
    let Reach { motion, command_rad } = *reach;
    let [pitch, rate, speed_m_s, alpha, elevator] = motion;
    json!({
        "verdict": "proved",
        "begins_with": match begun {
            Begun::Anyhow => "any-gains",
            Begun::Reset => "reset",
        },
        "begins_within_deg": degrees(checked.pitch_within_rad),
        "gains_near_trim": { "kp": kp, "ki": ki, "kd": kd },
        "box": {
            "pitch_deg": degrees(pitch),
            "pitch_rate_deg_s": degrees(rate),
            "airspeed_m_s": speed_m_s,
            "alpha_deg": degrees(alpha),
            "elevator_deg": degrees(elevator),
            "command_deg": degrees(command_rad),
        },
    })
}

/// That nothing is proved, for programs.
pub(super) fn open_in_json() -> Value {
    json!({
        "verdict": "open",
        "begins_with": null,
        "begins_within_deg": null,
        "gains_near_trim": null,
        "box": null,
    })
}

/// The answer for programs.
pub(super) fn in_json(answer: &NonlinearAnswer) -> Value {
    let found = match answer {
        NonlinearAnswer::Verdict(verdict, _) => match &**verdict {
            NonlinearVerdict::Proved(claim, checked) => {
                Some(proved_in_json(&claim.reach, claim.begun, checked))
            }
            NonlinearVerdict::Open(_) => None,
        },
        NonlinearAnswer::None(_) | NonlinearAnswer::LinearNotProved => None,
    };
    let mut found = found.unwrap_or_else(open_in_json);
    found["in_words"] = answer.text().into();
    found
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn bounds_of_gains_are_told_in_four_digits_and_never_narrower_than_they_are() {
        let told = |value| [digits(value, libm::floor), digits(value, libm::ceil)];
        assert_eq!(told(0.825_752_94), ["0.8257", "0.8258"]);
        assert_eq!(told(2.228_289e-4), ["0.0002228", "0.0002229"]);
        assert_eq!(told(-0.165_01), ["-0.1651", "-0.165"]);
        assert_eq!(told(12_345.6), ["12345", "12346"]);
        assert_eq!(told(0.3), ["0.3", "0.3"]);
        assert_eq!(told(0.0), ["0", "0"]);
    }
}
