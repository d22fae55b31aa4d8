//! An aircraft of which only a linear model is known, flown where that holds.

use fspid_aircraft::data::{LinearCondition, LinearData, LinearElevator};
use fspid_aircraft::{Environment, TrimTarget};
use fspid_sim::{ElevatorSign, LinearPlant};

use super::flight;
use super::flown::{Flown, Way};
use super::judged;
use crate::file::aircraft::unit_size;
use crate::file::spec::flight as keys;
use crate::file::spec::flight::ModelWord;
use crate::keyed::{Key, Section};
use crate::units::FOOT_M;
use fspid_diagnostics::{Report, digits::without_zeros};

/// How far an airspeed may be from that of the model, as a share of it: the dynamic pressure changes by 1 %, less than
/// the derivatives of any source are good for, and speeds rounded to whole knots fit in above 100 kt.
const AIRSPEED_SHARE: f64 = 0.005;
/// How far an altitude may be from that of the model: 200 ft, over which the density of the air changes by 1 % at most.
const ALTITUDE_M: f64 = 200.0 * FOOT_M;

/// The linear model at its condition, or at that of the scenario where its file has none.
pub(super) fn flown(
    report: &mut Report,
    (part, key): (&Section, Key<str>),
    model: &LinearData,
) -> Option<Flown> {
    fits(report, part)?;
    let target = flight::target(part)?;
    match model.condition {
        Some(condition) => holds(report, part, (target, condition))?,
        None => assume(report, (part, key), target),
    }
    flight::check_ground(report, part, target);
    let plant = plant(report, (part, key), model)?;
    let way = flight::way(part, target, &Environment::STANDARD)?;
    let way = Way { span_m: model.span_m, assumed: model.condition.is_none(), ..way };
    Some(Flown { plant: plant.into(), way: Some(way), derivatives: None })
}

/// Refuses what a linear model cannot do.
fn fits(report: &mut Report, part: &Section) -> Option<()> {
    let before = report.count();
    if part.get(keys::MODEL) == Some(ModelWord::Nonlinear) {
        let message =
            "only a linear model of the aircraft is known; it has no forces to fly nonlinear";
        part.wrong(report, keys::MODEL, message, "\"linear\", or leave it out");
    }
    if part.get(keys::CLIMB_ANGLE_DEG).is_some_and(|angle_deg| angle_deg != 0.0) {
        let message = "only a linear model of the aircraft is known, which holds in level flight";
        part.wrong(report, keys::CLIMB_ANGLE_DEG, message, "0, or leave it out");
    }
    flight::refuse_laws(
        report,
        part,
        "only a linear model of the aircraft is known, which says it itself",
    );
    let message =
        "only a linear model of the aircraft is known, and its file says no air of its own";
    flight::refuse_own_air(report, part, message);
    (report.count() == before).then_some(())
}

/// Refuses another condition than that of the model.
fn holds(
    report: &mut Report,
    part: &Section,
    (target, condition): (TrimTarget, LinearCondition),
) -> Option<()> {
    let before = report.count();
    let message =
        "only a linear model of the aircraft is known, which holds at one flight condition";
    let off_m_s = (target.airspeed_m_s - condition.airspeed_m_s).abs();
    // Both written so that NaN fails.
    if !(off_m_s <= AIRSPEED_SHARE * condition.airspeed_m_s) {
        let key = flight::airspeed_key(part);
        let allowed = format!("{}, or within 0.5 % of it", in_unit(key, condition.airspeed_m_s));
        part.wrong(report, key, message, allowed);
    }
    if !((target.altitude_m - condition.altitude_m).abs() <= ALTITUDE_M) {
        let key = flight::altitude_key(part);
        let allowed = format!("{}, or within 200 ft of it", in_unit(key, condition.altitude_m));
        part.wrong(report, key, message, allowed);
    }
    (report.count() == before).then_some(())
}

/// A value in the unit of a key, to the four decimals that say more than any source.
fn in_unit(key: Key<f64>, value_si: f64) -> String {
    let (size, unit) = (unit_size(key.unit()), key.unit());
    format!("{} {unit}", without_zeros(&format!("{:.4}", value_si / size)))
}

fn assume(report: &mut Report, (part, key): (&Section, Key<str>), target: TrimTarget) {
    let TrimTarget { airspeed_m_s, altitude_m, .. } = target;
    report.warn(format!(
        "{}: {:?} is a linear model without a flight condition; {airspeed_m_s:.1} m/s and {altitude_m:.0} m are an \
         assumption, from which the dynamic pressure follows and nothing else; it flies in calm air alone",
        part.path(key),
        part.get(key).unwrap_or_default(),
    ));
}

/// From elevator, and from gusts where the data tell how they act, to pitch.
fn plant(
    report: &mut Report,
    place: (&Section, Key<str>),
    model: &LinearData,
) -> Option<LinearPlant> {
    let transfer = judged(report, place, model.theta_over_elevator())?;
    let gusts = judged(report, place, model.theta_over_gusts())?;
    let sign = match model.elevator {
        LinearElevator::NoseDownPositive => ElevatorSign::NoseDownPositive,
        LinearElevator::NoseUpPositive => ElevatorSign::NoseUpPositive,
    };
    let [numerator, denominator] =
        [transfer.numerator(), transfer.denominator()].map(|part| part.coefficients());
    let plant = judged(report, place, LinearPlant::new(numerator, denominator, sign))?;
    match gusts {
        Some(gusts) => judged(report, place, plant.with_gusts(gusts.each_ref().map(Vec::as_slice))),
        None => Some(plant),
    }
}
