//! One controller with every plant that it has to hold.

use super::rank::{judged, rank, rank_without_margins};
use fspid_core::Gains;
use fspid_lti::{Complex, SampledLoop, SampledMargins};
use fspid_sim::aircraft::AfterBurning;
use fspid_sim::loop_model::{BreakPoint, SampledPlant};
use fspid_sim::stability::{doubt_beyond, doubt_when_flown};
use fspid_sim::{
    Controller, Doubt, LinearPlant, NamedController, Rest, RestPoint, Scenario, Side, SimError,
};

use super::Question;
use super::ages;
use super::answer::{Margins, poor_in_words};
use super::at_rest::keeps_its_gains;
use super::equilibrium::{Equilibrium, equilibrium};
use super::flights::Flights;
use super::frozen::{Frozen, FrozenGains, FrozenMap, FrozenPoint, FrozenReach};
use super::modes::AnalysedMode;
use super::stability::{Stability, of_stand};
use crate::metrics::Absent;

/// A controller's loop with a plant, at one rest of the scenario and on one side of the kinks that the rules have there.
#[derive(Clone, Debug)]
pub struct RestLoop {
    /// What is held while the loop rests.
    pub at: RestPoint,
    /// The gains, and with them what a held command adds to the gain on the error.
    pub gains: Gains<f64>,
    /// The open loop.
    pub open: SampledLoop,
    /// All that is known of a stable loop whose margins are proved.
    pub sampled: Option<Box<SampledMargins>>,
    /// Poles of the closed loop in the z-plane.
    pub closed_poles: Vec<Complex>,
    /// Margins in the units of answers.
    pub margins: Result<Margins, Absent>,
}

/// A controller's loop with one plant.
#[derive(Clone, Debug)]
pub struct PlantLoop {
    /// From when the plant is that one, s.
    pub from_s: f64,
    /// Of the rests that the scenario holds the one with the smallest disk margin.
    pub worst: RestLoop,
    /// The other rests, where they differ: those of gains that multiply a constant and move.
    pub others: Vec<RestLoop>,
    /// Of each margin the worst of all rests.
    pub margins: Result<Margins, Absent>,
    /// The gains of a self-tuning controller, standing still, where they were asked for and something bounds them.
    pub frozen: Option<Frozen>,
}

/// A controller's loop, at the gains that it has at rest.
#[derive(Clone, Debug)]
pub struct AnalysedLoop {
    /// Name of the controller.
    pub name: String,
    /// The gains at rest.
    pub equilibrium: Equilibrium,
    /// One for each plant that lasts; none where gains drift without end or there is no loop to break.
    pub plants: Vec<PlantLoop>,
    /// Why there is none.
    pub absent: Option<Absent>,
    /// What flights say, if they were asked for.
    pub flights: Option<Flights>,
    /// The modes of an autopilot, with everything that they engage around this controller.
    pub modes: Vec<AnalysedMode>,
    /// Why it is undecided whether what flies holds at rest, for all that its loops and modes say: as its flights are told.
    pub doubt: Option<Doubt>,
}

impl AnalysedLoop {
    pub(super) fn of(
        scenario: &Scenario,
        named: &NamedController,
        question: Question,
    ) -> Result<Self, SimError> {
        let controller = &named.controller;
        let equilibrium = equilibrium(controller);
        let name = named.name.clone();
        let flights = question.flies().then(|| Flights::of(scenario, controller)).transpose()?;
        let none = |reason| Self {
            name: named.name.clone(),
            equilibrium,
            plants: Vec::new(),
            absent: Some(reason),
            flights: flights.clone(),
            modes: Vec::new(),
            doubt: None,
        };
        let Some(gains) = equilibrium.gains() else {
            return Ok(none(Absent::Undecided(Doubt::DriftingGains)));
        };
        if question.point == BreakPoint::Rate && controller.config_at(gains).rate_gain_s == 0.0 {
            return Ok(none(Absent::NoRateLoop));
        }
        let mut plants = Vec::new();
        for AskedPlant { from_s, plant, is_reached } in asked_plants(scenario)? {
            let Some(plant) = &plant else { continue };
            let mut found = PlantLoop::of(scenario, plant, controller, gains, question.point)?;
            if keeps_its_gains(controller) {
                found.doubt_where(Doubt::KeptGains, |_| true);
            } else if !is_reached {
                let is_unstable = |it: &_| matches!(it, Err(Absent::Unstable { .. }));
                found.doubt_where(Doubt::ChangedAircraft, is_unstable);
            }
            let frozen = Frozen::of(scenario, plant, controller, gains, question)?;
            plants.push(PlantLoop { from_s, frozen, ..found });
        }
        let modes = AnalysedMode::all(scenario, controller, gains)?;
        let doubt = doubt_beyond(scenario, controller, gains)?.map(|it| it.doubt);
        Ok(Self { name, equilibrium, plants, absent: None, flights, modes, doubt })
    }

    /// Doubts a loop that holds at rest where its flight does not, as the flight's own answer does.
    pub(super) fn doubt_flight(&mut self, scenario: &Scenario, named: &NamedController) {
        if self.stability() == Stability::Stable {
            self.doubt = doubt_when_flown(scenario, named);
        }
    }

    /// The plant with the smallest disk margin; an unstable one before all others.
    #[must_use]
    pub fn worst(&self) -> Option<&PlantLoop> {
        let rank = |plant: &PlantLoop| rank(&plant.margins);
        self.plants.iter().min_by(|one, other| rank(one).total_cmp(&rank(other)))
    }

    /// The worst of all frozen gains over all plants, with the time from which the plant is that one.
    #[must_use]
    pub fn worst_frozen(&self) -> Option<(f64, &FrozenPoint)> {
        let worst = self.plants.iter().filter_map(|plant| {
            let map = plant.map()?;
            Some((plant.from_s, &map.worst))
        });
        worst.min_by(|one, other| rank(&one.1.margins).total_cmp(&rank(&other.1.margins)))
    }

    /// The worst gains that an accumulating law may come to, over all plants.
    #[must_use]
    pub fn worst_within_reach(&self) -> Option<&FrozenGains> {
        let worst = self.plants.iter().filter_map(|plant| Some(&plant.reach()?.worst));
        worst.min_by(|one, other| rank(&one.margins).total_cmp(&rank(&other.margins)))
    }

    /// Whether every plant is held at rest, with everything around it too; undecided where there is none to hold.
    #[must_use]
    pub fn stability(&self) -> Stability {
        match self.plants.as_slice() {
            [] => Stability::Undecided,
            plants => {
                let alone = plants.iter().map(PlantLoop::stability);
                Stability::of_all(alone.chain([self.around()]))
            }
        }
    }

    /// Whether what stands around the loops is held at rest.
    pub(super) fn around(&self) -> Stability {
        match self.doubt {
            Some(_) => Stability::Undecided,
            None => Stability::of_all(self.modes.iter().map(AnalysedMode::stability)),
        }
    }

    /// How many modes of the autopilot grow for certain.
    #[must_use]
    pub fn growing_modes(&self) -> usize {
        let growing = self.modes.iter().filter(|mode| mode.stability() == Stability::Unstable);
        if self.doubt.is_some() { 0 } else { growing.count() }
    }

    /// Margins with the worst plant.
    ///
    /// # Errors
    /// Why there are none.
    pub fn margins(&self) -> Result<Margins, Absent> {
        match (self.worst(), self.absent) {
            (Some(plant), _) => plant.margins,
            (None, Some(reason)) => Err(reason),
            (None, None) => Err(Absent::NotFinite),
        }
    }

    /// True for a loop that is held with every plant, and whose margins are poor with one of them.
    #[must_use]
    pub fn has_poor_margins(&self) -> bool {
        let mut margins = self.plants.iter().map(|plant| plant.margins);
        self.is_held() && margins.any(|margins| margins.is_ok_and(|it| it.are_poor()))
    }

    /// Which margins are poor, in words, of a loop that [`Self::has_poor_margins`].
    pub(crate) fn poor_margins_in_words(&self) -> Option<&'static str> {
        let margins: Vec<Margins> =
            self.plants.iter().filter_map(|plant| plant.margins.ok()).collect();
        poor_in_words(&margins).filter(|_| self.has_poor_margins())
    }

    /// True if every plant is held with margins that are proved, at rest and at every gain of the map.
    #[must_use]
    pub fn is_held(&self) -> bool {
        let held =
            |plant: &PlantLoop| plant.margins.is_ok() && plant.map().is_none_or(FrozenMap::is_held);
        !self.plants.is_empty()
            && self.plants.iter().all(held)
            && self.growing_modes() == 0
            && self.doubt.is_none()
    }
}

impl RestLoop {
    fn of(at: RestPoint, gains: Gains<f64>, open: SampledLoop) -> Result<Self, SimError> {
        let closed_poles = open.closed_poles()?;
        let judged = judged(&open)?;
        let margins = judged.as_deref().map(Margins::of).map_err(|reason| *reason);
        Ok(Self { at, gains, open, sampled: judged.ok(), closed_poles, margins })
    }

    /// The loops of a rest, one for each side of its kinks.
    fn all(
        scenario: &Scenario,
        plant: &LinearPlant,
        rest: &Rest,
        controller: &Controller,
        point: BreakPoint,
    ) -> Result<Vec<Self>, SimError> {
        let mut has_changing_ages = false;
        let mut of_side = |side: &Side| {
            let model = side.model(scenario, plant, controller)?;
            has_changing_ages |= model.has_changing_ages();
            let open = model.sharpened(scenario, plant)?.open(side.gains, point)?;
            Self::of(rest.at, side.gains, open)
        };
        let mut sides =
            rest.sides.iter().map(&mut of_side).collect::<Result<Vec<Self>, SimError>>()?;
        // Whether a rest holds is said of all its sides at once, as flights and requirements are told it.
        match verdict_of(scenario, plant, rest, controller)? {
            Err(reason) => {
                if let (true, Some(first)) =
                    (sides.iter().all(|it| it.margins.is_ok()), sides.first_mut())
                {
                    first.margins = Err(reason);
                }
                for side in sides.iter_mut().filter(|it| it.margins.is_err()) {
                    side.margins = Err(reason);
                }
            }
            // Margins are of the largest age, which does not stay.
            Ok(()) => {
                let asked = ages::Asked { scenario, plant, rest, controller };
                for side in &mut sides {
                    side.margins = match side.margins {
                        Err(Absent::Unstable { spectral_radius }) => {
                            Err(Absent::OldestAge { spectral_radius })
                        }
                        Ok(margins) if has_changing_ages && point == BreakPoint::Command => {
                            asked.borne(margins)?
                        }
                        other => other,
                    };
                }
            }
        }
        Ok(sides)
    }
}

impl PlantLoop {
    /// The loop with a plant from the beginning on, without gains that stand still.
    fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        controller: &Controller,
        gains: Gains<f64>,
        point: BreakPoint,
    ) -> Result<Self, SimError> {
        let mut found = Vec::new();
        for rest in Rest::all(scenario, plant, controller, gains) {
            found.extend(RestLoop::all(scenario, plant, &rest, controller, point)?);
        }
        found.sort_by(|one, other| rank(&one.margins).total_cmp(&rank(&other.margins)));
        let mut rests = found.into_iter();
        let worst = rests.next().ok_or(SimError::NotLinear)?;
        let others: Vec<RestLoop> = rests.collect();
        let margins =
            others.iter().fold(worst.margins, |worst, rest| match (worst, rest.margins) {
                (Ok(worst), Ok(other)) => Ok(worst.or_worse(&other)),
                (reason @ Err(_), _) | (Ok(_), reason) => reason,
            });
        Ok(Self { from_s: 0.0, worst, others, margins, frozen: None })
    }

    /// What is said of a plant that a flight need not come to, or of gains that it need not have: nothing is unstable for certain,
    /// or known at all.
    fn doubt_where(&mut self, doubt: Doubt, is_doubted: fn(&Result<Margins, Absent>) -> bool) {
        let rests = core::iter::once(&mut self.worst).chain(&mut self.others);
        let margins = rests.map(|rest| &mut rest.margins).chain([&mut self.margins]);
        for margins in margins.filter(|it| is_doubted(it)) {
            *margins = Err(Absent::Undecided(doubt));
        }
    }

    /// Every gain of a law without memory, standing still.
    #[must_use]
    pub fn map(&self) -> Option<&FrozenMap> {
        match &self.frozen {
            Some(Frozen::OfInputs(map)) => Some(map),
            Some(Frozen::WithinReach(_)) | None => None,
        }
    }

    /// The gains that an accumulating law may come to, standing still.
    #[must_use]
    pub fn reach(&self) -> Option<&FrozenReach> {
        match &self.frozen {
            Some(Frozen::WithinReach(reach)) => Some(reach),
            Some(Frozen::OfInputs(_)) | None => None,
        }
    }

    /// Every rest, the worst first.
    pub fn rests(&self) -> impl Iterator<Item = &RestLoop> {
        core::iter::once(&self.worst).chain(&self.others)
    }

    /// Whether the loop is stable at rest.
    #[must_use]
    pub fn stability(&self) -> Stability {
        Stability::of(&self.margins)
    }

    /// The same, at rest and at every gain of its map.
    #[must_use]
    pub fn stability_at_every_gain(&self) -> Stability {
        let frozen = self.map().map(FrozenMap::stability);
        Stability::of_all(frozen.into_iter().chain([self.stability()]))
    }
}

/// Whether a plant that lasts is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Held {
    /// From when the plant is that one, s.
    pub(crate) from_s: f64,
    /// The rest at which it is held worst.
    pub(crate) at: RestPoint,
    /// Why it is not.
    pub(crate) verdict: Result<(), Absent>,
}

impl Held {
    /// The smaller, the worse.
    fn rank(&self) -> f64 {
        match self.verdict {
            Ok(()) => 0.0,
            Err(reason) => rank_without_margins(reason),
        }
    }
}

/// Whether a controller holds each plant at its gains at rest: what [`AnalysedLoop`] says of it, without margins. None
/// where there are no gains at rest, or any may be.
pub(crate) fn held_at_rest(
    scenario: &Scenario,
    controller: &Controller,
) -> Result<Vec<Held>, SimError> {
    let at_rest = equilibrium(controller).gains().filter(|_| !keeps_its_gains(controller));
    let Some(gains) = at_rest else { return Ok(Vec::new()) };
    let plants = asked_plants(scenario)?.into_iter().filter(|it| it.is_reached);
    let plants = plants.filter_map(|it| Some((it.from_s, it.plant?)));
    let held = plants.map(|(from_s, plant)| {
        let mut worst: Option<Held> = None;
        for rest in Rest::all(scenario, &plant, controller, gains) {
            let verdict = verdict_of(scenario, &plant, &rest, controller)?;
            let found = Held { from_s, at: rest.at, verdict };
            if worst.is_none_or(|worst| found.rank() < worst.rank()) {
                worst = Some(found);
            }
        }
        worst.ok_or(SimError::NotLinear)
    });
    held.collect()
}

/// Whether a rest holds.
pub(super) fn verdict_of(
    scenario: &Scenario,
    plant: &LinearPlant,
    rest: &Rest,
    controller: &Controller,
) -> Result<Result<(), Absent>, SimError> {
    if plant.is_between_slopes() {
        return Ok(Err(Absent::Undecided(Doubt::Kink)));
    }
    let sampled = SampledPlant::of(scenario, plant)?;
    Ok(of_stand(rest.stand(scenario, &sampled, controller)?))
}

/// A plant that loops and airframes are asked with.
#[derive(Clone, Debug)]
pub(crate) struct AskedPlant {
    /// From when on it stands, s.
    pub(crate) from_s: f64,
    /// The plant; none of an aircraft of later that has no trim at the speed and altitude of the start.
    pub(crate) plant: Option<LinearPlant>,
    /// Whether the flight comes to it for certain: not to an empty tank whose engine burns by its thrust.
    pub(crate) is_reached: bool,
}

/// The plants that last, and at the end of a flight that burns fuel the aircraft with what is left of it.
pub(crate) fn asked_plants(scenario: &Scenario) -> Result<Vec<AskedPlant>, SimError> {
    let reached = |(from_s, plant)| AskedPlant { from_s, plant, is_reached: true };
    let from_s = scenario.timing.end_s();
    let burnt = scenario.plant.aircraft().and_then(|aircraft| aircraft.after_burning(from_s));
    let burnt =
        burnt.map(|AfterBurning { plant, is_reached }| AskedPlant { from_s, plant, is_reached });
    Ok(standing_plants(scenario)?.into_iter().map(reached).chain(burnt).collect())
}

/// The plants that last, an aircraft's linear model at its trim in its place, with the time from which each does, s.
///
/// # Errors
/// [`SimError`] where an aircraft has no linear model.
pub fn lasting_plants(scenario: &Scenario) -> Result<Vec<(f64, LinearPlant)>, SimError> {
    let standing = standing_plants(scenario)?.into_iter();
    Ok(standing.filter_map(|(at, plant)| Some((at, plant?))).collect())
}

/// The same, none in place of an aircraft of later that has no trim.
fn standing_plants(scenario: &Scenario) -> Result<Vec<(f64, Option<LinearPlant>)>, SimError> {
    scenario.plant.require_equations()?;
    match scenario.plant.aircraft() {
        Some(aircraft) => aircraft.lasting(),
        None => {
            let linear = scenario.lasting_plants().into_iter();
            Ok(linear.map(|(from_s, plant)| (from_s, Some(plant.clone()))).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use fspid_core::Gains;

    use super::*;
    use fspid_scenario::file;

    /// A loop that one rest leaves undecided and another makes unstable used to be called undecided.
    #[test]
    fn what_is_known_to_be_unstable_is_worse_than_all_that_is_not_known() {
        let unstable = |spectral_radius| Absent::Unstable { spectral_radius };
        let worst_first = [
            unstable(f64::NAN),
            unstable(2.0),
            unstable(1.0),
            Absent::Undecided(Doubt::OneSide { spectral_radius: 2.0 }),
            Absent::NotProved { order: 100 },
        ];
        let ranks: Vec<f64> = worst_first.into_iter().map(rank_without_margins).collect();
        assert!(ranks.windows(2).all(|two| two[0] < two[1]), "{ranks:?}");
        let rounding = Absent::Undecided(Doubt::Rounding { spectral_radius: 1.0 });
        assert!(ranks[4] < 0.0 && rank_without_margins(rounding) < -1.0);
        let held = |verdict| Held { from_s: 0.0, at: RestPoint::TRIM, verdict }.rank();
        assert!(held(Err(unstable(1.1))) < held(Err(worst_first[3])));
        assert!(held(Err(worst_first[3])) < held(Ok(())));
    }

    const STEP: &str = include_str!("../../../../scenarios/plant-change.toml");

    #[test]
    fn a_loop_is_held_where_it_has_margins_and_not_for_the_same_reason_where_it_has_none() {
        let mut unstable = 0;
        for factor in [0.01, 1.0, 10.0, 100.0] {
            let study = file::parse(STEP, "change.toml", None, &[]).expect("a scenario");
            for named in &study.scenario.controllers {
                let gains = named.controller.nominal();
                let scaled = Gains { kp: gains.kp * factor, ..gains };
                let pid =
                    fspid_core::Pid::new(scaled, *named.controller.config()).expect("allowed");
                let fixed = NamedController {
                    name: named.name.clone(),
                    controller: Controller::Fixed(pid),
                };
                for named in [named, &fixed] {
                    let question = Question { map_points: 0, ..Question::default() };
                    let analysed =
                        AnalysedLoop::of(&study.scenario, named, question).expect("a loop");
                    let plants = analysed.plants.iter().map(|plant| Held {
                        from_s: plant.from_s,
                        at: plant.worst.at,
                        verdict: plant.margins.map(|_| ()),
                    });
                    let held = held_at_rest(&study.scenario, &named.controller).expect("a loop");
                    assert!(held.iter().copied().eq(plants), "{held:?}");
                    unstable += held.iter().filter(|held| held.verdict.is_err()).count();
                }
            }
        }
        assert!(unstable > 0, "no loop was unstable");
    }
}
