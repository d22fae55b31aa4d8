//! What all requirements of files have, and the files of ready sets.

use super::Conditions;
use super::keys::{self, SET_FILE};
use super::set::{RequirementSet, SetLine};
use crate::keyed::{Key, KeyName, Section, check, document};
use crate::measure::Measure;
use fspid_diagnostics::{Problems, Report};

/// The limits; a measure that is 1 or 0 has its own.
pub(crate) fn limits(
    report: &mut Report,
    section: &Section,
    measure: Measure,
) -> (Option<f64>, Option<f64>) {
    let (least, most) = (section.get(keys::LEAST), section.get(keys::MOST));
    let written = section.given(keys::LEAST) || section.given(keys::MOST);
    check_signs(report, section, Some(measure));
    if measure.is_yes_or_no() {
        check_yes(report, section, (least, most));
        return (Some(1.0), None);
    }
    // A limit that is written wrongly is told already, and so is a table with an unknown key.
    if !written && section.sound {
        let message = "missing key; a requirement has a limit";
        section.problem(report, keys::MOST, message, "`least`, `most` or both");
    }
    if let (Some(least), Some(most)) = (least, most)
        && most < least
    {
        section.wrong(report, keys::MOST, "below `least`", format!("{least:?} or above"));
    }
    (least, most)
}

/// Refuses limits by which what is asked for, which is 1, were missed or its opposite met.
fn check_yes(report: &mut Report, section: &Section, (least, most): (Option<f64>, Option<f64>)) {
    let allowed = "no limit, or `least = 1`: the answer is yes, which is 1, or no, which is 0";
    if least.is_some_and(|least| least - 1.0 != 0.0) {
        section.wrong(report, keys::LEAST, "a limit of a question", allowed);
    }
    if most.is_some() {
        section.wrong(report, keys::MOST, "a limit of a question", allowed);
    }
}

/// Refuses limits below 0 of what never is; of a measure that nobody knows as well.
pub(crate) fn check_signs(report: &mut Report, section: &Section, measure: Option<Measure>) {
    if measure.is_some_and(Measure::is_signed) {
        return;
    }
    for key in [keys::LEAST, keys::MOST] {
        if section.get(key).is_some_and(|limit| limit < 0.0) {
            section.wrong(report, key, "out of range", "a finite number, 0 or above");
        }
    }
}

/// What counts, in whatever air.
pub(crate) fn conditions(section: &Section) -> Conditions {
    Conditions {
        step_deg: section.get(keys::STEP_DEG),
        within_deg: section.get(keys::WITHIN_DEG),
        from_s: section.get(keys::FROM_S),
        to_s: section.get(keys::TO_S),
        from_hz: section.get(keys::FROM_HZ),
        to_hz: section.get(keys::TO_HZ),
        target_ft: section.get(keys::TARGET_FT),
        target_m: section.get(keys::TARGET_M),
        air: None,
    }
}

/// Refuses conditions that the measure cannot be asked under, and those that do not go together.
pub(crate) fn check_conditions(
    report: &mut Report,
    section: &Section,
    measure: Measure,
    conditions: &Conditions,
) {
    let are_asked = keys::CONDITIONS.iter().map(|key| key.name()).chain([keys::AIR.name]);
    let is_given = |key: &KeyName| section.entries.iter().any(|it| it.name == *key && it.given);
    for key in are_asked.filter(|key| is_given(key) && !measure.takes(key.as_str())) {
        let owners = Measure::ALL.into_iter().filter(|measure| measure.takes(key.as_str()));
        let owners: Vec<&str> = owners.map(Measure::name).collect();
        let message = format!("says nothing about `{}`", measure.name());
        let allowed = format!("with {}", owners.join(", "));
        section.wrong(report, key, message, allowed);
    }
    if measure == Measure::RecoveryTime && conditions.within_deg.is_none() {
        let message = "missing key; it goes with `recovery_time_s`";
        let allowed = "a finite number above 0, in deg";
        section.problem(report, keys::WITHIN_DEG, message, allowed);
    }
    if measure == Measure::AltitudeOvershoot && conditions.target_altitude_m().is_none() {
        let message = "missing key; it goes with `altitude_overshoot_ft`";
        section.problem(report, keys::TARGET_FT, message, "a finite number, in ft; or target_m");
    }
    check_target(report, section);
    if conditions.from_s.is_some() && conditions.step_deg.is_some() {
        let message = "not together with `step_deg`, from which the time counts";
        section.wrong(report, keys::FROM_S, message, "one of the two");
    }
    check_order(report, section, [keys::FROM_S, keys::TO_S]);
    check_order(report, section, [keys::FROM_HZ, keys::TO_HZ]);
}

/// Refuses two targets.
pub(crate) fn check_target(report: &mut Report, section: &Section) {
    if section.given(keys::TARGET_FT) && section.given(keys::TARGET_M) {
        section.wrong(report, keys::TARGET_M, "not together with `target_ft`", "one of the two");
    }
}

/// Refuses an end that is not after its beginning.
fn check_order(report: &mut Report, section: &Section, [from, to]: [Key<f64>; 2]) {
    if let (Some(first), Some(last)) = (section.get(from), section.get(to))
        && !(last > first)
    {
        let message = format!("not above `{}`", from.name);
        section.wrong(report, to, message, format!("above {first:?}"));
    }
}

/// Reads a set from its file.
///
/// # Errors
/// Everything that is wrong with it.
pub(super) fn requirement_set(text: &str, name: &str) -> Result<RequirementSet, Problems> {
    let mut report = Report::default();
    let section = document::read(&mut report, None, text)
        .and_then(|item| check::table(&mut report, &SET_FILE, &item, ""));
    if let Some(section) = &section {
        section.sections(keys::LINE).iter().for_each(|line| check_line(&mut report, line));
    }
    report.finish(name)?;
    section.as_ref().and_then(set_of).ok_or_else(|| Problems::new(name, Vec::new(), 0))
}

fn check_line(report: &mut Report, line: &Section) {
    if let Some(measure) = line.get(keys::MEASURE) {
        limits(report, line, measure);
        // Who asks for a set chooses its target.
        let chosen = Conditions { target_m: Some(0.0), ..conditions(line) };
        check_conditions(report, line, measure, &chosen);
    }
}

fn set_of(section: &Section) -> Option<RequirementSet> {
    let text = |key| section.get::<str>(key).unwrap_or_default().to_owned();
    let lines = section.sections(keys::LINE).iter().map(line).collect::<Option<Vec<_>>>()?;
    Some(RequirementSet {
        name: text(keys::SET_NAME),
        title: text(keys::TITLE),
        source: text(keys::SET_SOURCE),
        notes: text(keys::NOTES),
        lines,
    })
}

fn line(section: &Section) -> Option<SetLine> {
    let measure = section.get(keys::LINE_MEASURE)?;
    let least = section.get(keys::LEAST).or_else(|| measure.is_yes_or_no().then_some(1.0));
    let text = |key| section.get::<str>(key).map(str::to_owned);
    Some(SetLine {
        id: text(keys::LINE_ID)?,
        measure,
        least,
        most: section.get(keys::MOST),
        conditions: Conditions { air: section.get(keys::LINE_AIR), ..conditions(section) },
        clause: text(keys::LINE_CLAUSE)?,
        source: text(keys::LINE_SOURCE)?,
        confidence: section.get(keys::LINE_CONFIDENCE)?,
        note: text(keys::NOTE),
        level: section.get(keys::LINE_LEVEL),
        category: text(keys::LINE_CATEGORY),
        speed: text(keys::LINE_SPEED),
        below_aeroelastic_mode: section.get(keys::BELOW_AEROELASTIC_MODE).unwrap_or(false),
        above_aeroelastic_mode: section.get(keys::ABOVE_AEROELASTIC_MODE).unwrap_or(false),
    })
}
