//! The constant operating conditions of a scenario: set-points, loads and sensor offsets that last, and so define the loop's
//! equilibria.

use fspid_core::PidConfig;

use crate::plant::LinearPlant;
use crate::scenario::Scenario;
use crate::sensor::Sensor;
use crate::signal::{Disturbance, Entry, Shape, extremes_from};

/// The set-points and loads that a scenario holds, each as far as it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steady {
    /// Least and largest set-point, rad from the trim; the trim itself lies between them.
    pub setpoint_rad: [f64; 2],
    /// Largest load, rad of elevator, without a sign: disturbances at servo and elevator together, but for noise.
    pub load_rad: f64,
    /// Bias of the actuator, rad, without a sign.
    pub bias_rad: f64,
    /// Largest offset of the measured pitch, rad, without a sign: bias, and disturbances but for noise.
    pub offset_rad: f64,
    /// Largest offset of the measured rate, rad/s, without a sign.
    pub rate_offset_rad_s: f64,
    /// What the pitch sensor shows of a radian of pitch.
    pub pitch_scale: f64,
}

impl Scenario {
    /// The set-points and loads of the scenario: where one of them moves, the furthest that it goes. In all time:
    /// where a flight ends is no property of the loop.
    ///
    /// The load is the largest that anything in the loop has to hold: the controller that of servo and elevator together, the
    /// servo that of the elevator alone, which one at the servo that is its opposite takes off the controller and not off it.
    #[must_use]
    pub fn steady(&self) -> Steady {
        let together = self.steady_while(Counted::Always);
        let at_elevator = self.furthest(&[Entry::Elevator], Counted::Always);
        Steady { load_rad: together.load_rad.max(at_elevator), ..together }
    }

    /// The same of what the loop can come to rest under: loads that stay from some time on to the end of the flight, and
    /// set-points but for sines. Around a shorter pulse or a sine of a load no loop rests, nor around loads that others take off
    /// again within the flight.
    #[must_use]
    pub fn resting(&self) -> Steady {
        let setpoint_rad =
            if self.setpoint.is_sine() { [0.0; 2] } else { self.setpoint.ends_rad() };
        Steady { setpoint_rad, ..self.steady_while(self.at_the_end()) }
    }

    fn at_the_end(&self) -> Counted {
        Counted::AtTheEnd { end_s: self.timing.end_s() }
    }

    /// Least and largest load of what the loop can come to rest under, with its sign: the command, rad and nose up positive, that
    /// disturbances, biases and offsets of the pitch sensor ask for, each as far as it goes; zero lies between them.
    #[must_use]
    pub fn resting_loads_rad(&self, plant: &LinearPlant) -> [f64; 2] {
        let counted = self.at_the_end();
        let ends = |entries: &[Entry]| self.ends(entries, counted);
        let with = |[least, most]: [f64; 2], constant: f64| {
            [least + constant.min(0.0), most + constant.max(0.0)]
        };
        let sensor = self.surroundings.pitch_sensor;
        let scale = 1.0 + sensor.map_or(0.0, |it| it.model().scale_error);
        let at_the_elevator =
            with(ends(&[Entry::Servo, Entry::Elevator]), self.actuator.bias_rad());
        let seen = with(ends(&[Entry::Measurement]), sensor.as_ref().map_or(0.0, Sensor::bias));
        let per_seen = 1.0 / (scale * plant.steady_gain());
        let mut asked = [0.0; 2];
        for (ends, factor) in [(at_the_elevator, -1.0), (seen, -per_seen)] {
            let [one, other] = ends.map(|end| if end == 0.0 { 0.0 } else { factor * end });
            asked = [asked[0] + one.min(other), asked[1] + one.max(other)];
        }
        asked
    }

    /// Set-point that stays when the flight has ended, rad from the trim; 0 of one that swings.
    pub(crate) fn held_at_the_end_rad(&self) -> f64 {
        let (setpoint_rad, _) = self.setpoint.sampled(self.timing);
        let last = setpoint_rad.last().copied().unwrap_or(0.0);
        if self.setpoint.is_sine() { 0.0 } else { last }
    }

    /// Least and largest set-point that the pitch loop can be given where the autopilot's modes move pitch, rad from the trim:
    /// what they command is added to the scenario's own.
    #[must_use]
    pub fn commanded_rad(&self) -> Option<[f64; 2]> {
        let [lower, upper] = self.autopilot.as_ref()?.pitch_rad()?;
        let [least, most] = self.setpoint.ends_rad();
        Some([least + lower, most + upper])
    }

    fn steady_while(&self, counted: Counted) -> Steady {
        let biased = |sensor: &Option<Sensor>| sensor.as_ref().map_or(0.0, Sensor::bias).abs();
        Steady {
            setpoint_rad: self.setpoint.ends_rad(),
            load_rad: self.furthest(&[Entry::Servo, Entry::Elevator], counted),
            bias_rad: self.actuator.bias_rad().abs(),
            offset_rad: self.furthest(&[Entry::Measurement], counted)
                + biased(&self.surroundings.pitch_sensor),
            rate_offset_rad_s: biased(&self.surroundings.rate_sensor),
            pitch_scale: 1.0
                + self.surroundings.pitch_sensor.map_or(0.0, |it| it.model().scale_error),
        }
    }

    /// Largest magnitude of the disturbances that enter at some places, noise left out.
    fn furthest(&self, entries: &[Entry], counted: Counted) -> f64 {
        let [least, most] = self.ends(entries, counted);
        least.abs().max(most)
    }

    /// Least and largest sum of the disturbances that enter at some places, noise left out; zero lies between them.
    fn ends(&self, entries: &[Entry], counted: Counted) -> [f64; 2] {
        let entering = self.disturbances.iter().filter(|one| entries.contains(&one.entry()));
        let parts = entering.map(Disturbance::part).filter(|(_, shape)| counted.counts(shape));
        let parts: Vec<(f64, &Shape)> = parts.collect();
        extremes_from(counted.begin_s(), &parts)
    }
}

/// When disturbances are counted.
#[derive(Clone, Copy, Debug)]
enum Counted {
    Always,
    /// From the end of the flight on: those alone that stay there from some time of the flight on.
    AtTheEnd {
        end_s: f64,
    },
}

impl Counted {
    fn counts(self, shape: &Shape) -> bool {
        match self {
            Self::Always => true,
            Self::AtTheEnd { end_s } => stays(shape, end_s),
        }
    }

    const fn begin_s(self) -> f64 {
        match self {
            Self::Always => f64::NEG_INFINITY,
            Self::AtTheEnd { end_s } => end_s,
        }
    }
}

/// True for what begins within a flight and stays from some time on to its end.
fn stays(shape: &Shape, end_s: f64) -> bool {
    let begins = shape.starts_s() <= end_s;
    begins
        && match *shape {
            Shape::Step { .. } | Shape::Ramp { .. } => true,
            Shape::Pulse { at_s, width_s } => at_s + width_s > end_s,
            Shape::Doublet { at_s, width_s } => at_s + 2.0 * width_s > end_s,
            Shape::Square { at_s, half_period_s, .. } => at_s + half_period_s > end_s,
            Shape::Sine { .. } | Shape::Noise { .. } => false,
        }
}

impl LinearPlant {
    /// Pitch per elevator, nose up positive, where both stand still; infinite for a plant that integrates.
    #[must_use]
    pub fn steady_gain(&self) -> f64 {
        let transfer_function = self.transfer_function();
        let last = |values: &[f64]| values.last().copied().unwrap_or(0.0);
        let by_elevator = last(transfer_function.numerator().coefficients())
            / last(transfer_function.denominator().coefficients());
        self.elevator_sign().per_nose_up() * by_elevator
    }
}

impl Steady {
    /// The largest command, rad, that holds the plant beside what the set-point alone asks for.
    ///
    /// An offset of what is seen is a pitch that is off by as much as shows so, and one of the seen rate a command.
    #[must_use]
    pub fn load_with_offsets_rad(&self, plant: &LinearPlant, config: &PidConfig<f64>) -> f64 {
        let of_offset = self.offset_rad / (self.pitch_scale * plant.steady_gain()).abs();
        let of_offset = if self.offset_rad == 0.0 { 0.0 } else { of_offset };
        self.load_rad
            + self.bias_rad
            + of_offset
            + (config.rate_gain_s * self.rate_offset_rad_s).abs()
    }

    /// The largest set-point in magnitude, rad.
    #[must_use]
    pub fn largest_setpoint_rad(&self) -> f64 {
        let [least, most] = self.setpoint_rad;
        least.abs().max(most)
    }
}
