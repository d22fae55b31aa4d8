//! Aircraft parameters that vary during a flight: deployment of configurations (flaps, gear) and fuel mass.

use fspid_aircraft::aerodynamics::varied::{Deployed, VariedModel};
use fspid_aircraft::{Consumption, Departure, FuelledBody, Quantity, Range};

use crate::error::{SimError, positive};

/// Most configurations of a flight.
pub const MOST_CONFIGURATIONS: usize = 8;

/// A configuration that moves in flight, at a constant rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConfigurationChange {
    /// When it begins, s.
    pub at_s: f64,
    /// How long it takes, s.
    pub takes_s: f64,
    /// How far out it then is, 0 to 1.
    pub to: f64,
}

/// How far out one configuration is, over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Deployment {
    start: f64,
    changes: Vec<ConfigurationChange>,
}

/// Fuel on board and how it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fuel {
    /// The aircraft's body with it.
    pub body: FuelledBody,
    /// How much the engine takes.
    pub consumption: Consumption,
}

/// Time-varying quantities in a flight of a [`VariedModel`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changing {
    /// One for each configuration of the model, in its order.
    deployments: Vec<Deployment>,
    fuel: Option<Fuel>,
}

impl Deployment {
    /// From where it is at the start through changes in order of time, of which none begins before the one before has
    /// ended.
    ///
    /// # Errors
    /// [`SimError::Number`] for a deployment that is not from 0 to 1, for a time below zero, for a change that takes no
    /// time, and for two at once.
    pub fn new(start: f64, changes: Vec<ConfigurationChange>) -> Result<Self, SimError> {
        let mut free_s = 0.0;
        for to in changes.iter().map(|change| change.to).chain([start]) {
            if !(0.0..=1.0).contains(&to) {
                let what = "deployment of a configuration";
                return Err(SimError::Number { what, found: to, allowed: "0 to 1" });
            }
        }
        for change in &changes {
            positive("time that a configuration takes, s", change.takes_s)?;
            // Written so that NaN is refused.
            if !(change.at_s >= free_s) {
                let allowed = "not before the change before it has ended";
                let what = "begin of a change of a configuration, s";
                return Err(SimError::Number { what, found: change.at_s, allowed });
            }
            free_s = change.at_s + change.takes_s;
        }
        Ok(Self { start, changes })
    }

    /// How far out it is at a time, s.
    #[must_use]
    pub fn share(&self, time_s: f64) -> f64 {
        let mut share = self.start;
        for &ConfigurationChange { at_s, takes_s, to } in &self.changes {
            if time_s <= at_s {
                return share;
            }
            let part = (time_s - at_s) / takes_s;
            if part < 1.0 {
                return share + part * (to - share);
            }
            share = to;
        }
        share
    }

    /// Times at which it begins and ceases to move, s.
    fn corners_s(&self) -> impl Iterator<Item = f64> + '_ {
        self.changes.iter().flat_map(|change| [change.at_s, change.at_s + change.takes_s])
    }
}

impl Fuel {
    /// What is left of it, kg.
    #[must_use]
    pub fn left_kg(&self, burnt_kg: f64) -> f64 {
        (self.body.full_kg() - burnt_kg).max(0.0)
    }

    /// A tank that is empty.
    pub(crate) fn departure(&self, burnt_kg: f64) -> Option<Departure> {
        let allowed = Range { min: 0.0, max: self.body.full_kg() };
        let is_dry = burnt_kg >= self.body.full_kg();
        is_dry.then_some(Departure { quantity: Quantity::Fuel, value: 0.0, allowed })
    }
}

impl Changing {
    /// The changes of a flight: a deployment for each configuration of the model, and its fuel.
    ///
    /// # Errors
    /// [`SimError::Number`] for another number of deployments than the model has configurations, or for too many.
    pub fn new(
        model: &VariedModel,
        deployments: Vec<Deployment>,
        fuel: Option<Fuel>,
    ) -> Result<Self, SimError> {
        let found = deployments.len();
        if found != model.deployed().len() {
            let allowed = "one for each configuration of the model";
            let what = "number of deployments";
            return Err(SimError::Number { what, found: found as f64, allowed });
        }
        if found > MOST_CONFIGURATIONS {
            let what = "number of configurations of a flight";
            return Err(SimError::Number { what, found: found as f64, allowed: "up to 8" });
        }
        Ok(Self { deployments, fuel })
    }

    /// Those of a model that stays as it is at the start.
    pub(crate) fn none_of(model: &VariedModel) -> Self {
        let stays = |one: &Deployed| Deployment { start: one.share, changes: Vec::new() };
        Self { deployments: model.deployed().iter().map(stays).collect(), fuel: None }
    }

    /// How far out each configuration is at a time, s.
    pub fn shares(&self, time_s: f64) -> impl Iterator<Item = f64> + '_ {
        self.deployments.iter().map(move |deployment| deployment.share(time_s))
    }

    /// Fuel, if any is burnt.
    #[must_use]
    pub fn fuel(&self) -> Option<&Fuel> {
        self.fuel.as_ref()
    }

    /// True where nothing changes after the start.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.fuel.is_none() && self.deployments.iter().all(|one| one.changes.is_empty())
    }

    /// Times from which on configurations stand where a change has brought them, s, in rising order.
    #[must_use]
    pub(crate) fn ended_s(&self) -> Vec<f64> {
        let changes = self.deployments.iter().flat_map(|one| &one.changes);
        let mut all: Vec<f64> = changes.map(|change| change.at_s + change.takes_s).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// Times at which something begins and ceases to move, s, in rising order.
    #[must_use]
    pub fn corners_s(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self.deployments.iter().flat_map(Deployment::corners_s).collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

/// What a sample shows of it: a number for each column that traces have of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    values: [f64; MOST_SHOWN],
    count: usize,
}

/// Configurations, mass, fuel, and what the ground leaves.
const MOST_SHOWN: usize = MOST_CONFIGURATIONS + 3;

/// Names of the columns of configurations, in their order.
pub const DEPLOYMENT_COLUMNS: [&str; MOST_CONFIGURATIONS] = [
    "deployment_1",
    "deployment_2",
    "deployment_3",
    "deployment_4",
    "deployment_5",
    "deployment_6",
    "deployment_7",
    "deployment_8",
];

impl Shown {
    /// Names of what flights of a model with these changes show.
    pub(crate) fn names(model: &VariedModel, changing: &Changing) -> Vec<&'static str> {
        let mut names: Vec<_> =
            DEPLOYMENT_COLUMNS.into_iter().take(changing.deployments.len()).collect();
        names.extend(changing.fuel().into_iter().flat_map(|_| ["mass_kg", "fuel_kg"]));
        names.extend(model.effects().ground.map(|_| "ground_effect"));
        names
    }

    /// What is shown at a time and an altitude with that much fuel burnt; the mass is that of the moment.
    pub(crate) fn of(
        model: &VariedModel,
        changing: &Changing,
        [time_s, altitude_m]: [f64; 2],
        [mass_kg, burnt_kg]: [f64; 2],
    ) -> Self {
        let fuel = changing.fuel().map(|fuel| [mass_kg, fuel.left_kg(burnt_kg)]);
        let ground = model.effects().ground.map(|ground| ground.factor(altitude_m));
        let all = changing.shares(time_s).chain(fuel.into_iter().flatten()).chain(ground);
        let mut shown = Self { values: [0.0; MOST_SHOWN], count: 0 };
        for (place, value) in shown.values.iter_mut().zip(all) {
            *place = value;
            shown.count += 1;
        }
        shown
    }

    /// The numbers, in the order of the names.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        self.values.get(..self.count).unwrap_or_default()
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "numbers that are chosen so that nothing is rounded")]
mod tests {
    use super::*;

    fn change(at_s: f64, takes_s: f64, to: f64) -> ConfigurationChange {
        ConfigurationChange { at_s, takes_s, to }
    }

    #[test]
    fn a_configuration_moves_at_a_constant_rate_from_where_it_is() {
        let changes = vec![change(2.0, 4.0, 1.0), change(6.0, 2.0, 0.5)];
        let deployment = Deployment::new(0.0, changes).expect("one after the other");
        for (time_s, share) in
            [(0.0, 0.0), (2.0, 0.0), (3.0, 0.25), (6.0, 1.0), (7.0, 0.75), (8.0, 0.5), (1e9, 0.5)]
        {
            assert_eq!(deployment.share(time_s), share, "{time_s}");
        }
        assert_eq!(deployment.corners_s().collect::<Vec<_>>(), [2.0, 6.0, 6.0, 8.0]);
    }

    #[test]
    fn changes_that_cannot_be_are_refused() {
        for (start, changes) in [
            (1.5, vec![]),
            (f64::NAN, vec![]),
            (0.0, vec![change(0.0, 1.0, -0.1)]),
            (0.0, vec![change(0.0, 0.0, 1.0)]),
            (0.0, vec![change(-1.0, 1.0, 1.0)]),
            (0.0, vec![change(f64::NAN, 1.0, 1.0)]),
            (0.0, vec![change(0.0, 2.0, 1.0), change(1.9, 1.0, 0.0)]),
        ] {
            assert!(Deployment::new(start, changes.clone()).is_err(), "{start} {changes:?}");
        }
    }
}
