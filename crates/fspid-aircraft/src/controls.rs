//! What a pilot or autopilot moves.

/// Positions of the control surfaces and the throttle.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Controls {
    /// Elevator, trailing edge down positive: nose down.
    pub elevator_rad: f64,
    /// Aileron, with the sign of the model's source; see its data.
    pub aileron_rad: f64,
    /// Rudder, with the sign of the model's source; see its data.
    pub rudder_rad: f64,
    /// Throttle, in the measure of the model: fraction of full thrust, or multiple of a reference thrust.
    pub throttle: f64,
}

/// How many numbers [`Controls`] are.
pub const CONTROLS: usize = 4;

impl Controls {
    /// Elevator, aileron, rudder, throttle: the order of the inputs of a linear model.
    #[must_use]
    pub const fn to_array(self) -> [f64; CONTROLS] {
        [self.elevator_rad, self.aileron_rad, self.rudder_rad, self.throttle]
    }

    /// The inverse of [`Controls::to_array`].
    #[must_use]
    pub const fn from_array(values: [f64; CONTROLS]) -> Self {
        let [elevator_rad, aileron_rad, rudder_rad, throttle] = values;
        Self { elevator_rad, aileron_rad, rudder_rad, throttle }
    }
}
