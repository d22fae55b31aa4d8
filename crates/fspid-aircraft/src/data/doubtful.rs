//! Data that no aircraft is likely to have: a slip of unit, sign or digit, told and not refused, because canards, tailless and
//! unstable aircraft are aircraft too.

use super::{AircraftData, DerivativeData, ModelData};
use crate::aerodynamics::derivatives::Lateral;
use crate::atmosphere::Air;
use crate::validity::Range;

/// Lift of the reference may differ from the weight by this share of it: sources print it up to 6 % apart (DC-8).
const LIFT: f64 = 0.1;
/// Density may differ from that of the standard atmosphere by this share: a day 50 K from the standard.
const DENSITY: f64 = 0.2;
/// Mach number may differ from that of airspeed and standard atmosphere by this share.
const MACH: f64 = 0.1;
/// Lift by angle of attack, per radian: from a delta wing to the $2 \pi$ of a thin section, with room on both sides.
const LIFT_SLOPE: Range = Range { min: 1.0, max: 10.0 };
/// Radius of gyration as a share of the span: the carried aircraft have 0.1 to 0.3 about each axis.
const GYRATION: Range = Range { min: 0.03, max: 1.0 };

impl AircraftData {
    /// Sentences about numbers that are hardly meant; none of aircraft of tables and of linear models.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        match &self.model {
            ModelData::Derivatives(data) => data.doubts(),
            ModelData::Linear(_) | ModelData::Forces(_) => Vec::new(),
        }
    }
}

impl DerivativeData {
    /// Sentences about numbers that are hardly meant, each with what was found and what to look at.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        let mut doubts = self.doubts_of_reference();
        doubts.extend(self.doubts_of_mass());
        doubts.extend(self.doubts_of_pitch());
        doubts.extend(self.lateral.iter().flat_map(doubts_of_lateral));
        doubts
    }

    fn doubts_of_reference(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        let reference = &self.reference;
        let scale_n = self.dynamic_pressure_pa() * self.geometry.area_m2;
        let lift_n = scale_n * self.longitudinal.lift.reference;
        if !is_within(lift_n, self.weight_n, LIFT) {
            doubts.push(format!(
                "lift at the reference is {lift_n:.4} N and the weight {:.4} N: one of lift, weight, area, airspeed and density is wrong; it flies with the lift that carries the weight",
                self.weight_n
            ));
        }
        let Ok(air) = Air::standard(reference.altitude_m) else { return doubts };
        if !is_within(reference.density_kg_m3, air.density_kg_m3, DENSITY) {
            doubts.push(format!(
                "the density of the reference is {:.4} kg/m³; at its altitude of {:.0} m the standard atmosphere has {:.4} kg/m³",
                reference.density_kg_m3, reference.altitude_m, air.density_kg_m3
            ));
        }
        let mach = reference.airspeed_m_s / air.speed_of_sound_m_s;
        if !is_within(reference.mach, mach, MACH) {
            doubts.push(format!(
                "the Mach number of the reference is {:.4}; its airspeed in the standard atmosphere is Mach {mach:.4}",
                reference.mach
            ));
        }
        doubts
    }

    fn doubts_of_mass(&self) -> Vec<String> {
        let mass_kg = self.weight_n / self.reference.gravity_m_s2;
        let span_m = self.geometry.span_m;
        let axes = [
            ("ix", self.inertia.ix_kg_m2),
            ("iy", self.inertia.iy_kg_m2),
            ("iz", self.inertia.iz_kg_m2),
        ];
        let radii = axes.map(|(axis, inertia_kg_m2)| (axis, (inertia_kg_m2 / mass_kg).sqrt()));
        let odd = radii.into_iter().filter(|(_, radius_m)| !GYRATION.contains(*radius_m / span_m));
        odd.map(|(axis, radius_m)| {
            format!(
                "{axis} and the weight make a radius of gyration of {radius_m:.4} m beside a span of {span_m:.4} m: are the units of both right? Usual is 0.1 to 0.3 of the span"
            )
        })
        .collect()
    }

    fn doubts_of_pitch(&self) -> Vec<String> {
        let (lift, pitch) = (&self.longitudinal.lift, &self.longitudinal.pitch);
        let mut doubts = Vec::new();
        if !LIFT_SLOPE.contains(lift.alpha) {
            doubts.push(format!(
                "lift by alpha is {}: usual are {} to {} per radian; is it per degree?",
                lift.alpha, LIFT_SLOPE.min, LIFT_SLOPE.max
            ));
        }
        if pitch.alpha >= 0.0 {
            doubts.push(format!(
                "pitch by alpha is {}: nothing turns the nose back, the aircraft is unstable; a stable one has a number below 0",
                pitch.alpha
            ));
        }
        if pitch.pitch_rate >= 0.0 {
            doubts.push(format!(
                "pitch by pitch_rate is {}: nothing damps the pitch; a tail makes it negative",
                pitch.pitch_rate
            ));
        }
        if pitch.elevator >= 0.0 {
            doubts.push(format!(
                "pitch by elevator is {}: its trailing edge down does not lower the nose, as that of a tail or an elevon does; a canard's is above 0",
                pitch.elevator
            ));
        }
        doubts
    }
}

fn doubts_of_lateral(lateral: &Lateral) -> Vec<String> {
    let Lateral { roll, yaw, .. } = lateral;
    let rows = [
        (roll.roll_rate >= 0.0, "roll by roll_rate", roll.roll_rate, "nothing damps the roll"),
        (yaw.yaw_rate >= 0.0, "yaw by yaw_rate", yaw.yaw_rate, "nothing damps the yaw"),
        (yaw.beta < 0.0, "yaw by beta", yaw.beta, "the nose turns away from the wind"),
    ];
    let odd = rows.into_iter().filter(|(is_odd, ..)| *is_odd);
    odd.map(|(_, what, value, why)| format!("{what} is {value}: {why}; is its sign right?"))
        .collect()
}

/// True for a value that differs from another by no more than a share of that.
fn is_within(value: f64, usual: f64, share: f64) -> bool {
    (value - usual).abs() <= share * usual.abs()
}
