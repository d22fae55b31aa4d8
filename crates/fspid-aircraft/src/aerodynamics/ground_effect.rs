//! The ground below a wing: less drag due to lift.

use crate::error::AircraftError;

/// Drag due to lift near the ground.
///
/// $$ \Delta C_D = -(1 - \varphi) k C_L^2, \qquad
///    \varphi(h) = \frac{(16 h / b)^2}{1 + (16 h / b)^2} + \frac{1}{257}, \quad h < b $$
///
/// with the height $h$ of the wing above the ground and the span $b$; from one span upwards $\varphi = 1$. The second
/// summand is what the formula leaves at one span, $1 - \varphi(b)$: it joins both without a jump and is below 0.4 % of
/// the drag due to lift. The ground acts on drag alone here: what it does to lift, to the slope of lift and to the
/// pitching moment depends on the wing and the tail, and no formula for them is known to this program.
///
/// # Source
/// B. W. McCormick, Aerodynamics, Aeronautics, and Flight Mechanics, on the drag due to lift in ground effect (recalled
/// and found again on the pages of a public calculator; the book was not at hand). The second summand is ours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundEffect {
    span_m: f64,
    /// Altitude at which the wing would touch the ground, m.
    zero_altitude_m: f64,
    /// $k$.
    induced_drag_factor: f64,
}

/// The formula's factor at one span is 256/257.
const LEFT_AT_ONE_SPAN: f64 = 1.0 / 257.0;

impl GroundEffect {
    /// The effect on a wing of a span, `wing_height_m` above the ground when the aircraft's altitude is that of the ground.
    ///
    /// # Errors
    /// A span or a factor $k$ that is not above zero, a height below zero, an altitude that is not finite.
    pub fn new(
        span_m: f64,
        wing_height_m: f64,
        ground_altitude_m: f64,
        induced_drag_factor: f64,
    ) -> Result<Self, AircraftError> {
        AircraftError::unless_positive("span in m", span_m)?;
        AircraftError::unless_positive("factor of the drag due to lift", induced_drag_factor)?;
        AircraftError::unless_finite("altitude of the ground in m", ground_altitude_m)?;
        // Written so that NaN is refused.
        if !(wing_height_m >= 0.0 && wing_height_m.is_finite()) {
            let (what, value) = ("height of the wing in m", wing_height_m);
            return Err(AircraftError::Outside { what, value, min: 0.0, max: f64::INFINITY });
        }
        let zero_altitude_m = ground_altitude_m - wing_height_m;
        Ok(Self { span_m, zero_altitude_m, induced_drag_factor })
    }

    /// $\varphi$: what is left of the drag due to lift at an altitude of the aircraft; 1 from one span upwards.
    #[must_use]
    pub fn factor(&self, altitude_m: f64) -> f64 {
        let spans = ((altitude_m - self.zero_altitude_m) / self.span_m).max(0.0);
        if spans >= 1.0 {
            return 1.0;
        }
        let square = 256.0 * spans * spans;
        square / (1.0 + square) + LEFT_AT_ONE_SPAN
    }

    /// The increment of the drag coefficient at an altitude and a lift coefficient.
    #[must_use]
    pub fn drag(&self, altitude_m: f64, lift: f64) -> f64 {
        -(1.0 - self.factor(altitude_m)) * self.induced_drag_factor * lift * lift
    }

    /// Altitude of the aircraft below which there is an effect, m.
    #[must_use]
    pub fn upper_altitude_m(&self) -> f64 {
        self.zero_altitude_m + self.span_m
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "exactly 1 is asked for")]
mod tests {
    use super::*;

    fn effect() -> GroundEffect {
        GroundEffect::new(10.0, 2.0, 100.0, 0.05).expect("a wing")
    }

    /// At h/b = 1/16 the formula has one half; the wing is 2 m higher than the altitude says.
    #[test]
    fn a_sixteenth_of_a_span_up_half_of_the_drag_due_to_lift_is_left() {
        let altitude_m = 100.0 - 2.0 + 10.0 / 16.0;
        assert!((effect().factor(altitude_m) - (0.5 + 1.0 / 257.0)).abs() < 1e-15);
        let drag = effect().drag(altitude_m, 1.2);
        assert!((drag + (0.5 - 1.0 / 257.0) * 0.05 * 1.44).abs() < 1e-15, "{drag}");
    }

    #[test]
    fn there_is_no_effect_from_one_span_upwards_and_no_jump_there() {
        let top_m = effect().upper_altitude_m();
        assert_eq!(top_m, 108.0);
        for above_m in [0.0, 1e-6, 1.0, 1e6] {
            assert_eq!(effect().factor(top_m + above_m), 1.0);
            assert_eq!(effect().drag(top_m + above_m, 1.0), 0.0);
        }
        assert!((effect().factor(top_m - 1e-9) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn nearer_to_the_ground_less_is_left_and_below_it_no_less() {
        let factors = (0..=80).map(|step| effect().factor(98.0 + 0.125 * f64::from(step)));
        assert!(factors.clone().zip(factors.skip(1)).all(|(low, high)| low < high));
        assert_eq!(effect().factor(50.0), effect().factor(98.0));
    }

    #[test]
    fn wings_that_cannot_be_are_refused() {
        for (span_m, height_m, ground_m, factor) in [
            (0.0, 1.0, 0.0, 0.05),
            (10.0, -1.0, 0.0, 0.05),
            (10.0, f64::NAN, 0.0, 0.05),
            (10.0, 1.0, f64::INFINITY, 0.05),
            (10.0, 1.0, 0.0, -0.05),
        ] {
            assert!(GroundEffect::new(span_m, height_m, ground_m, factor).is_err());
        }
    }
}
