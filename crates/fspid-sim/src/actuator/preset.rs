//! Actuators of aircraft and books, by name.

use fspid_numeric::units::DEGREE_RAD;

use super::{Actuator, Lag};
use crate::error::SimError;

/// A named actuator. Travel is given nose up positive: trailing edge up before trailing edge down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    /// Name in files.
    pub name: &'static str,
    /// Where its numbers come from; A and a number is an assumption in `docs/paper/assumptions.md`.
    pub source: &'static str,
    /// Natural frequency, rad/s, and damping; damping 0 is first order, frequency 0 no lag.
    lag: (f64, f64),
    /// Least and most travel, deg.
    travel_deg: Option<(f64, f64)>,
    /// Rate limit, deg/s.
    rate_deg_s: Option<f64>,
    play_rad: f64,
    bias_rad: f64,
}

const PLAIN: Preset = Preset {
    name: "ideal",
    source: "by definition",
    lag: (0.0, 0.0),
    travel_deg: None,
    rate_deg_s: None,
    play_rad: 0.0,
    bias_rad: 0.0,
};

impl Preset {
    /// Every preset.
    pub const ALL: &[Self] = &[
        PLAIN,
        Self { name: "paper", source: "arXiv 1510.02588: 10/(s + 10)", lag: (10.0, 0.0), ..PLAIN },
        Self {
            name: "f16-stabilator",
            source: "NASA TP-1538 and its descendants: 20.2/(s + 20.2)",
            lag: (20.2, 0.0),
            travel_deg: Some((-25.0, 25.0)),
            rate_deg_s: Some(60.0),
            ..PLAIN
        },
        Self {
            name: "b747-elevator",
            source: "A31",
            lag: (15.0, 0.0),
            travel_deg: Some((-17.0, 23.0)),
            rate_deg_s: Some(37.0),
            ..PLAIN
        },
        Self {
            name: "b747-jsbsim",
            source: "JSBSim, aircraft B747: travel only",
            travel_deg: Some((-10.03, 20.05)),
            ..PLAIN
        },
        Self {
            name: "navion-jsbsim",
            source: "JSBSim, aircraft L17: travel only",
            travel_deg: Some((-17.19, 20.05)),
            ..PLAIN
        },
        Self {
            name: "c172-jsbsim",
            source: "JSBSim, aircraft c172x",
            lag: (60.0, 0.0),
            travel_deg: Some((-19.5, 19.5)),
            play_rad: 0.05,
            bias_rad: 0.002,
            ..PLAIN
        },
        Self {
            name: "light-autopilot",
            source: "A25",
            lag: (7.5, 0.0),
            travel_deg: Some((-20.0, 20.0)),
            rate_deg_s: Some(10.0),
            ..PLAIN
        },
        Self { name: "second-order", source: "A26", lag: (35.0, 0.7), ..PLAIN },
    ];

    /// The preset with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|preset| preset.name == name)
    }

    /// The actuator.
    ///
    /// # Errors
    /// None for the presets there are: their numbers are allowed, as a test shows.
    pub fn actuator(&self) -> Result<Actuator, SimError> {
        let actuator = Actuator::new(self.lag()?).with_play(self.play_rad)?;
        let mut actuator = actuator.with_bias(self.bias_rad)?;
        if let Some((least, most)) = self.travel_deg {
            actuator = actuator.with_travel(least * DEGREE_RAD, most * DEGREE_RAD)?;
        }
        if let Some(limit) = self.rate_deg_s {
            actuator = actuator.with_rate_limit(limit * DEGREE_RAD)?;
        }
        Ok(actuator)
    }

    fn lag(&self) -> Result<Lag, SimError> {
        match self.lag {
            (0.0, _) => Ok(Lag::NONE),
            (frequency_rad_s, 0.0) => Lag::first_order(1.0 / frequency_rad_s),
            (frequency_rad_s, damping) => Lag::second_order(frequency_rad_s, damping),
        }
    }
}
