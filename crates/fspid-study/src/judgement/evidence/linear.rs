//! The linear loops of a controller: one for each plant that lasts.

use fspid_lti::Mode;
use fspid_sim::{
    Doubt, EarlyEnd, EndCause, NamedController, Outcome, RestPoint, Scenario, SimError,
};

use crate::analysis::{
    Analysis, Margins, PlantLoop, Question, RestLoop, asked_plants, decibels, held_at_rest,
};
use crate::flight::ControllerResult;
use crate::judgement::{Case, CasePlace, NotEvaluated, PlantAt};
use crate::metrics::Absent;
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::Requirement;
use fspid_scenario::units::degrees;

/// A controller's loop with a plant that lasts.
#[derive(Debug)]
pub(super) struct PlantEvidence {
    /// Which plant, where there are several.
    pub(super) at: Option<PlantAt>,
    /// The loop at the gains at rest.
    pub(super) at_rest: PlantLoop,
}

impl PlantEvidence {
    pub(super) fn place(&self) -> CasePlace {
        CasePlace { plant: self.at, ..CasePlace::default() }
    }

    /// The loops of all rests, each with its place.
    fn rests(&self) -> impl Iterator<Item = (&RestLoop, CasePlace)> {
        let several = !self.at_rest.others.is_empty();
        self.at_rest
            .rests()
            .map(move |rest| (rest, CasePlace { rest: several.then_some(rest.at), ..self.place() }))
    }
}

/// An aircraft that comes to be and has no linear model.
pub(super) const CHANGED: Absent = Absent::Undecided(Doubt::ChangedAircraft);

/// Why there are no margins, and where.
pub(super) fn with_place(reason: Absent, place: CasePlace) -> NotEvaluated {
    match reason {
        Absent::Unstable { spectral_radius } => {
            NotEvaluated::Unstable { place: Box::new(place), spectral_radius }
        }
        reason => NotEvaluated::Absent(reason),
    }
}

/// Refuses a controller that does not hold one of its plants at rest. Where there is no linear loop, there is nothing
/// but the flight.
pub(super) fn require_stability(
    scenario: &Scenario,
    named: &NamedController,
) -> Result<(), NotEvaluated> {
    let Ok(held) = held_at_rest(scenario, &named.controller) else {
        return Ok(());
    };
    let several = held.len() > 1;
    for (index, held) in held.into_iter().enumerate() {
        let plant = several.then_some(PlantAt { index, from_s: held.from_s });
        match held.verdict {
            // Not decided by the loop: the flight tells.
            Ok(()) | Err(Absent::Undecided(Doubt::OneSide { .. } | Doubt::DeadZone { .. })) => {}
            Err(reason) => {
                let rest = (held.at != RestPoint::TRIM).then_some(held.at);
                return Err(with_place(reason, CasePlace { plant, rest, ..CasePlace::default() }));
            }
        }
    }
    Ok(())
}

/// The loops of a controller with every plant of its scenario; with maps of frozen gains where they have points.
pub(super) fn loops(
    scenario: &Scenario,
    named: &NamedController,
    map_points: usize,
) -> Result<Vec<PlantEvidence>, NotEvaluated> {
    // In full, so that a replay with these gains as fixed ones gives the same bits.
    let question = Question { map_points, every_point_in_full: true, ..Question::default() };
    let alone =
        Scenario { controllers: vec![named.clone()], externals: Vec::new(), ..scenario.clone() };
    let analysed = Analysis::of_scenario(&alone, question)?.loops.pop();
    let analysed = analysed.ok_or(NotEvaluated::Linear(SimError::NotLinear))?;
    if let Some(reason) = analysed.absent {
        return Err(NotEvaluated::Absent(reason));
    }
    if asked_plants(scenario)?.iter().any(|asked| asked.plant.is_none()) {
        return Err(NotEvaluated::Absent(CHANGED));
    }
    let several = analysed.plants.len() > 1;
    let evidence = |(index, at_rest): (usize, PlantLoop)| {
        let at = PlantAt { index, from_s: at_rest.from_s };
        PlantEvidence { at: several.then_some(at), at_rest }
    };
    Ok((0..).zip(analysed.plants).map(evidence).collect())
}

/// A measure of the loops at rest: a case for each plant and each rest.
pub(super) fn cases(
    loops: &[PlantEvidence],
    (result, has_modes): (&ControllerResult, bool),
    requirement: &Requirement,
) -> Result<Vec<Case>, NotEvaluated> {
    let mut cases = Vec::new();
    if requirement.measure == Measure::Stable {
        cases.extend(diverged(result).into_iter().chain(growing_mode(result)));
        if cases.is_empty() {
            require_decided(result)?;
        }
        // What outer loops hold is no pitch loop by itself, whose throttle stays.
        if has_modes && cases.is_empty() && result.at_rest.unstable.is_none() {
            refuse_doubt(result, |_| true)?;
            return Ok(vec![Case { value: 1.0, place: CasePlace::default() }]);
        }
    } else {
        refuse_doubt(result, Doubt::is_of_limits)?;
    }
    cases.extend(rest_cases(loops, requirement)?);
    Ok(cases)
}

/// The same of the loops alone.
pub(super) fn rest_cases(
    loops: &[PlantEvidence],
    requirement: &Requirement,
) -> Result<Vec<Case>, NotEvaluated> {
    let rests = loops.iter().flat_map(PlantEvidence::rests);
    let cases = rests.map(|(rest, place)| of_rest(rest, place, requirement));
    let cases: Vec<Result<Case, NotEvaluated>> = cases.collect();
    if requirement.measure == Measure::Stable {
        // What grows at one rest is known, whatever is undecided at another.
        let grows = |case: &&Case| !(case.value >= 1.0);
        let growing: Vec<Case> = cases.iter().flatten().filter(grows).cloned().collect();
        if !growing.is_empty() {
            return Ok(growing);
        }
    }
    cases.into_iter().collect()
}

/// A flight that diverged is no flight of a stable loop.
fn diverged(result: &ControllerResult) -> Option<Case> {
    match result.trace.outcome {
        Outcome::EndedEarly(EarlyEnd { at_s, cause: EndCause::Diverged }) => {
            Some(Case { value: 0.0, place: CasePlace { at_s: Some(at_s), ..CasePlace::default() } })
        }
        // What hits the ground may be stable: the flight fails by itself.
        Outcome::EndedEarly(_) | Outcome::Completed | Outcome::ModeNeverBegan { .. } => None,
    }
}

/// Refuses a flight of which it is not known whether what is no loop of a plant holds: an aircraft of later, a long mode.
pub(super) fn require_decided(result: &ControllerResult) -> Result<(), NotEvaluated> {
    refuse_doubt(result, Doubt::is_beyond_the_loop)
}

/// The same of what is proved of all gains that a controller may have.
pub(super) fn require_decided_but_for_gains(result: &ControllerResult) -> Result<(), NotEvaluated> {
    refuse_doubt(result, |it| it.is_beyond_the_loop() && !it.is_of_gains_without_rest())
}

fn refuse_doubt(
    result: &ControllerResult,
    is_refused: impl FnOnce(Doubt) -> bool,
) -> Result<(), NotEvaluated> {
    match result.at_rest.undecided.map(|it| it.doubt) {
        Some(doubt) if is_refused(doubt) => Err(NotEvaluated::Absent(Absent::Undecided(doubt))),
        _ => Ok(()),
    }
}

/// An autopilot's mode that grows is part of no loop with a plant.
fn growing_mode(result: &ControllerResult) -> Option<Case> {
    let unstable = result.at_rest.unstable.filter(|unstable| unstable.mode.is_some())?;
    let spectral_radius = Some(unstable.spectral_radius);
    Some(Case { value: 0.0, place: CasePlace { spectral_radius, ..CasePlace::default() } })
}

fn of_rest(
    rest: &RestLoop,
    place: CasePlace,
    requirement: &Requirement,
) -> Result<Case, NotEvaluated> {
    if requirement.measure == Measure::Stable {
        return stable(rest, place);
    }
    let margins = rest.margins.map_err(|reason| with_place(reason, place))?;
    require_sampled(rest, requirement)?;
    match requirement.measure {
        Measure::ModeDamping => mode_damping(rest, place, requirement),
        Measure::PhaseMargin if requirement.conditions.has_band() => {
            phase_margin_in_band(rest, place, requirement)
        }
        Measure::GainMargin | Measure::GainMarginLow | Measure::GainMarginHigh
            if requirement.conditions.has_band() =>
        {
            gain_margin_in_band(rest, place, &margins, requirement)
        }
        Measure::GainCrossover => {
            let value = margins.gain_crossover_rad_s.ok_or(NotEvaluated::NoCrossover)?;
            Ok(Case { value, place })
        }
        measure => {
            let (value, frequency_rad_s) = of_margins(measure, &margins);
            Ok(Case { value, place: CasePlace { frequency_rad_s, ..place } })
        }
    }
}

fn stable(rest: &RestLoop, place: CasePlace) -> Result<Case, NotEvaluated> {
    match rest.margins {
        // Whether it is stable is known without margins.
        Ok(_)
        | Err(
            Absent::NotProved { .. } | Absent::OldestAge { .. } | Absent::AgesAsTheyCome { .. },
        ) => Ok(Case { value: 1.0, place }),
        Err(Absent::Unstable { spectral_radius }) => {
            let place = CasePlace { spectral_radius: Some(spectral_radius), ..place };
            Ok(Case { value: 0.0, place })
        }
        Err(reason) => Err(NotEvaluated::Absent(reason)),
    }
}

/// A measure of margins, and the frequency that it belongs to.
pub(super) fn of_margins(measure: Measure, margins: &Margins) -> (f64, Option<f64>) {
    let [low_db, high_db] = margins.gain_margin_db;
    let [low_rad_s, high_rad_s] = margins.phase_crossover_rad_s;
    match measure {
        Measure::GainMarginLow => (-low_db, low_rad_s),
        Measure::GainMarginHigh => (high_db, high_rad_s),
        Measure::GainMargin | Measure::FrozenGainMargin if -low_db < high_db => {
            (-low_db, low_rad_s)
        }
        Measure::GainMargin | Measure::FrozenGainMargin => (high_db, high_rad_s),
        Measure::DelayMargin => (margins.delay_margin_s, None),
        Measure::DiskMargin | Measure::FrozenDiskMargin => {
            (margins.disk_margin, Some(margins.disk_rad_s))
        }
        Measure::SensitivityPeak => {
            (margins.sensitivity_peak, Some(margins.sensitivity_peak_rad_s))
        }
        // The phase margin, and nothing else comes here.
        _ => (margins.phase_margin_deg, margins.gain_crossover_rad_s),
    }
}

/// Refuses a band that starts at or beyond half the sample rate: no frequency of the loop is in it, which is no margin.
fn require_sampled(rest: &RestLoop, requirement: &Requirement) -> Result<(), NotEvaluated> {
    let ends_hz = 0.5 / rest.open.dt_s();
    match requirement.conditions.from_hz.filter(|from_hz| *from_hz >= ends_hz) {
        Some(from_hz) => Err(NotEvaluated::BeyondSampling { from_hz, ends_hz }),
        None => Ok(()),
    }
}

/// The least phase margin of the crossovers whose frequency counts; infinite where there is none.
fn phase_margin_in_band(
    rest: &RestLoop,
    place: CasePlace,
    requirement: &Requirement,
) -> Result<Case, NotEvaluated> {
    let found = rest.sampled.as_ref().ok_or(NotEvaluated::Absent(Absent::NotFinite))?;
    let without_end = Case { value: f64::INFINITY, place };
    let counted =
        found.crossovers.iter().filter(|at| requirement.conditions.in_band(at.omega_rad_s));
    let cases = counted.map(|at| {
        let place = CasePlace { frequency_rad_s: Some(at.omega_rad_s), ..place };
        Case { value: degrees(at.phase_margin_rad.abs()), place }
    });
    Ok(cases.min_by(|one, other| one.value.total_cmp(&other.value)).unwrap_or(without_end))
}

/// Of a factor: how much nearer to 1 than the limit it may be and still be the limit itself.
const SAME_FACTOR: f64 = 1e-9;

/// How far the gain may change at the frequencies that count and at which the loop is real and negative, the least of
/// them, dB; infinite where there is none.
///
/// Between the two ends of the gain margin poles may touch the limit of stability and turn back; these are no limits.
fn gain_margin_in_band(
    rest: &RestLoop,
    place: CasePlace,
    margins: &Margins,
    requirement: &Requirement,
) -> Result<Case, NotEvaluated> {
    let [low_db, high_db] = margins.gain_margin_db;
    let open = &rest.open;
    let crossings = open.real_crossings().map_err(|error| NotEvaluated::Linear(error.into()))?;
    let mut least = Case { value: f64::INFINITY, place };
    for omega_rad_s in crossings {
        let factor_db = decibels(-1.0 / open.at(omega_rad_s).re);
        // NaN for a positive value of the loop, where no factor above 0 makes an oscillation.
        let falls = factor_db <= low_db * (1.0 - SAME_FACTOR) && factor_db > f64::NEG_INFINITY;
        let rises = factor_db >= high_db * (1.0 - SAME_FACTOR) && factor_db < f64::INFINITY;
        let counts = match requirement.measure {
            Measure::GainMarginLow => falls,
            Measure::GainMarginHigh => rises,
            _ => falls || rises,
        };
        let is_less = factor_db.abs() < least.value;
        if counts && is_less && requirement.conditions.in_band(omega_rad_s) {
            let place = CasePlace { frequency_rad_s: Some(omega_rad_s), ..place };
            least = Case { value: factor_db.abs(), place };
        }
    }
    Ok(least)
}

/// Damping of the least damped mode whose frequency counts; poles at 0 die at once and are none.
fn mode_damping(
    rest: &RestLoop,
    place: CasePlace,
    requirement: &Requirement,
) -> Result<Case, NotEvaluated> {
    let dt_s = rest.open.dt_s();
    let poles = rest.closed_poles.iter();
    let modes = poles.filter_map(|&pole| Mode::of_sampled_pole(pole, dt_s).ok());
    let counted = modes.filter(|mode| requirement.conditions.in_band(mode.natural_frequency_rad_s));
    let least = counted.min_by(|one, other| one.damping_ratio.total_cmp(&other.damping_ratio));
    let mode = least.ok_or(NotEvaluated::NoMode)?;
    let frequency_rad_s = Some(mode.natural_frequency_rad_s);
    Ok(Case { value: mode.damping_ratio, place: CasePlace { frequency_rad_s, ..place } })
}
