//! A controller's loop at equilibrium: its gains there, its stability, and whether constant loads are rejected.

use fspid_core::{Gains, Law};
use fspid_diagnostics::digits::to_six_decimals;
use fspid_sim::load::{ConstantLoad, constant_load};
use fspid_sim::stability::{GrowthAtRest, Undecided, Unstable, doubt_when_flown, growth_at_rest};
use fspid_sim::{Controller, Doubt, NamedController, Plant, RestPoint, Scenario, SimError};

use super::equilibrium::{Equilibrium, added_at_rest, equilibrium};
use fspid_scenario::units::degrees;

/// What is held at a rest, in words.
#[must_use]
pub fn held_in_words(at: RestPoint) -> String {
    let [setpoint_deg, load_deg] =
        [at.setpoint_rad, at.load_rad].map(|rad| to_six_decimals(degrees(rad)));
    let load = match at.load_rad == 0.0 {
        true => String::new(),
        false => format!(" and loads take {load_deg} deg of command"),
    };
    format!("while the set-point is held at {setpoint_deg} deg{load}")
}

/// Where the gains are when error and change are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RestGains {
    /// Fixed ones.
    Fixed(Gains<f64>),
    /// What the rules make of the nominal ones.
    Tuned(Gains<f64>),
    /// Wherever they have come to: an accumulating law without leakage keeps them.
    Kept,
    /// Nowhere: an accumulating law without leakage and without limits moves them for ever.
    Drifting,
    /// Unknown: the controller is a program without equations.
    Unknown,
}

impl RestGains {
    /// Of a controller.
    #[must_use]
    pub fn of(controller: &Controller) -> Self {
        if keeps_its_gains(controller) {
            return Self::Kept;
        }
        match equilibrium(controller) {
            Equilibrium::Fixed(gains) => Self::Fixed(gains),
            Equilibrium::AtRest(gains) => Self::Tuned(gains),
            Equilibrium::Drifts { .. } => Self::Drifting,
        }
    }

    /// The gains, where one set of them is the controller's at rest.
    #[must_use]
    pub fn gains(&self) -> Option<Gains<f64>> {
        match self {
            Self::Fixed(gains) | Self::Tuned(gains) => Some(*gains),
            Self::Kept | Self::Drifting | Self::Unknown => None,
        }
    }

    /// Why nothing is known of the loop at rest where a self-tuner has no gains there.
    #[must_use]
    pub fn doubt(&self) -> Option<Doubt> {
        match self {
            Self::Kept => Some(Doubt::KeptGains),
            Self::Drifting => Some(Doubt::DriftingGains),
            Self::Fixed(_) | Self::Tuned(_) | Self::Unknown => None,
        }
    }
}

/// True for an accumulating law without leakage that moves a gain in flight and does not move it at rest.
pub(super) fn keeps_its_gains(controller: &Controller) -> bool {
    let Controller::SelfTuning(fspid) = controller else {
        return false;
    };
    let settings = fspid.tuner().settings();
    let Law::Accumulating { leakage_per_s } = settings.law else {
        return false;
    };
    let (scale, per_s) = (settings.output_scale, added_at_rest(fspid.tuner()));
    let moves = [(scale.kp, per_s.kp), (scale.ki, per_s.ki), (scale.kd, per_s.kd)];
    !(leakage_per_s > 0.0) && moves.iter().any(|(scale, per_s)| scale.abs() > 0.0 && *per_s == 0.0)
}

/// A controller's loop at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct AtRest {
    /// The gains that the file says: fixed or nominal; zeros where they are unknown.
    pub nominal: Gains<f64>,
    /// The gains at rest.
    pub gains: RestGains,
    /// The first plant and set-point around which the loop grows; none for a stable loop and where there are no gains
    /// to ask with.
    pub unstable: Option<Unstable>,
    /// Where that is not decided, and why.
    pub undecided: Option<Undecided>,
    /// What a constant load at the servo does; none for a loop that is unstable or has no gains at rest, and where it
    /// was not asked.
    pub load: Option<ConstantLoad>,
    /// Why stability or load could not be asked, although there are gains at rest.
    pub not_asked: Option<SimError>,
}

impl AtRest {
    /// The same with what the controller's flight says of it, flown here for who has not flown it; as it is where it is unstable or
    /// undecided already, and of another simulator's aircraft, which nobody starts for this.
    #[must_use]
    pub fn as_flown(self, scenario: &Scenario, named: &NamedController) -> Self {
        let is_own = !matches!(scenario.plant, Plant::External(_));
        let is_open = is_own && self.unstable.is_none() && self.undecided.is_none();
        let doubt = is_open.then(|| doubt_when_flown(scenario, named)).flatten();
        self.doubted(doubt)
    }

    /// Whether the loop is stable at rest, in a word: stable, unstable or undecided; none where it could not be asked.
    #[must_use]
    pub fn stability_word(&self) -> Option<&'static str> {
        match (self.unstable, self.undecided) {
            (Some(_), _) => Some("unstable"),
            (None, Some(_)) => Some("undecided"),
            (None, None) => {
                self.gains.gains().filter(|_| self.not_asked.is_none()).map(|_| "stable")
            }
        }
    }

    /// The same of a flight that leaves it in doubt, of which small motions at rest say nothing; as it is without a doubt.
    #[must_use]
    pub fn doubted(self, doubt: Option<Doubt>) -> Self {
        match doubt {
            Some(doubt) => Self { undecided: Some(Undecided::at_trim(doubt)), ..self },
            None => self,
        }
    }

    /// Of a controller without equations, of which nothing can be asked.
    #[must_use]
    pub fn unknown() -> Self {
        let (unstable, undecided, load, not_asked) = (None, None, None, None);
        let (nominal, gains) = (Gains::ZERO, RestGains::Unknown);
        Self { nominal, gains, unstable, undecided, load, not_asked }
    }

    /// Gains and stability, which every flight is asked. What cannot be asked says why, and the flight is flown.
    #[must_use]
    pub fn stability(scenario: &Scenario, controller: &Controller) -> Self {
        let (nominal, gains) = (controller.nominal(), RestGains::of(controller));
        let found =
            gains.gains().map(|gains| growth_at_rest(scenario, controller, gains)).transpose();
        let (found, not_asked) = match found {
            Ok(found) => (found.unwrap_or_default(), None),
            Err(reason) => (GrowthAtRest::default(), Some(reason)),
        };
        let GrowthAtRest { certain: unstable, undecided } = found;
        let undecided = undecided.or(gains.doubt().map(Undecided::at_trim));
        Self { nominal, gains, unstable, undecided, load: None, not_asked }
    }

    /// The same, and what a constant load does.
    #[must_use]
    pub fn of(scenario: &Scenario, controller: &Controller) -> Self {
        let at_rest = Self::stability(scenario, controller);
        let asked = at_rest.gains.gains();
        let Some(gains) =
            asked.filter(|_| at_rest.unstable.is_none() && at_rest.not_asked.is_none())
        else {
            return at_rest;
        };
        match constant_load(scenario, gains, &controller.config_at(gains)) {
            Ok(load) => Self { load, ..at_rest },
            Err(reason) => Self { not_asked: Some(reason), ..at_rest },
        }
    }
}
