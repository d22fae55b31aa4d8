//! Every shipped aircraft flies, and moves as its source or its kind says.

use fspid_aircraft::data::Laws;
use fspid_aircraft::{
    Aircraft, AircraftMode, Environment, Trim, TrimTarget, Validity, VelocityForm,
    longitudinal_modes,
};

use crate::support;

use fspid_aircraft::aerodynamics::derivatives::DerivativeModel;
use support::{DEG_RAD, derivative_data, short_period_and_phugoid, with_derivatives};

fn trimmed(name: &str, airspeed_m_s: f64) -> (Aircraft<DerivativeModel>, Trim) {
    let data = derivative_data(name);
    let environment = data.reference_environment();
    let aircraft = data.aircraft(Laws::default(), environment).expect("an aircraft");
    let altitude_m = data.reference.altitude_m;
    let trim = aircraft.trim(TrimTarget { airspeed_m_s, altitude_m, flight_path_rad: 0.0 });
    (aircraft, trim.unwrap_or_else(|failure| panic!("{name}: {failure}")))
}

fn modes(name: &str) -> Vec<AircraftMode> {
    let (aircraft, trim) = trimmed(name, derivative_data(name).reference.airspeed_m_s);
    let system = aircraft.linearise(&trim).longitudinal(VelocityForm::Components).expect("finite");
    longitudinal_modes(&system).expect("four states")
}

#[test]
fn every_aircraft_is_trimmed_at_its_reference_without_moving_a_control() {
    for name in with_derivatives() {
        let (_, trim) = trimmed(name, derivative_data(name).reference.airspeed_m_s);
        let moved = [trim.point.alpha_rad, trim.point.elevator_rad, trim.point.throttle - 1.0];
        assert!(moved.iter().all(|value| value.abs() < 1e-12), "{name}: {moved:?}");
    }
}

/// The ranges of assumption A24: level flight in the standard atmosphere, at the lowest speed near the ground and at the highest
/// speed where the reference is, is within all of them.
#[test]
fn every_aircraft_flies_level_at_its_lowest_and_at_its_highest_speed() {
    let mut refused = Vec::new();
    // Two of the 747 have ranges that are wider than their angles of attack and Mach numbers.
    let narrower = |name: &&str| !["b747-approach", "b747-cruise-low"].contains(name);
    for name in with_derivatives().filter(narrower) {
        let data = derivative_data(name);
        let aircraft = data.aircraft(Laws::default(), Environment::STANDARD).expect("an aircraft");
        let Validity { airspeed_m_s, mach, altitude_m, .. } = data.validity;
        let sound_m_s = Environment::STANDARD.air_at(data.reference.altitude_m).speed_of_sound_m_s;
        let fastest_m_s = 0.999 * airspeed_m_s.max.min(mach.max * sound_m_s);
        for (airspeed_m_s, altitude_m) in [
            (1.001 * airspeed_m_s.min, altitude_m.min.max(0.0)),
            (fastest_m_s, data.reference.altitude_m),
        ] {
            let target = TrimTarget { airspeed_m_s, altitude_m, flight_path_rad: 0.0 };
            refused.extend(aircraft.trim(target).err().map(|failure| format!("{name}: {failure}")));
        }
    }
    assert!(refused.is_empty(), "{refused:#?}");
}

/// A neutral point behind the centre of gravity by 3 to 50 % of the chord, an elevator that turns the nose down and lifts, a
/// radius of gyration in pitch of half a chord to two: what a slip of a sign or of a unit would break.
#[test]
fn every_aircraft_has_the_stability_the_elevator_and_the_inertia_of_an_aircraft() {
    for name in with_derivatives() {
        let data = derivative_data(name);
        let (lift, pitch) = (data.longitudinal.lift, data.longitudinal.pitch);
        let margin = -pitch.alpha / lift.alpha;
        assert!((0.03..0.5).contains(&margin), "{name}: {margin}");
        assert!(pitch.elevator < 0.0 && lift.elevator > 0.0, "{name}");
        assert!((3.0..7.0).contains(&lift.alpha) && pitch.pitch_rate < 0.0, "{name}");
        let radius_m = libm::sqrt(data.inertia.iy_kg_m2 / data.mass_kg());
        let chords = radius_m / data.geometry.chord_m;
        assert!((0.5..2.1).contains(&chords), "{name}: {chords}");
        // What the source prints as lift carries the weight, within what thrust and rounding take of it.
        let scale_n = 0.5
            * data.reference.density_kg_m3
            * data.reference.airspeed_m_s
            * data.reference.airspeed_m_s
            * data.geometry.area_m2;
        let share = lift.reference * scale_n / data.weight_n;
        assert!((0.93..1.05).contains(&share), "{name}: {share}");
    }
}

/// What a source prints: frequency and damping of the short period and of the phugoid, and how near these must come.
struct Printed {
    name: &'static str,
    modes: [f64; 4],
    /// As parts of the printed numbers.
    within: [f64; 4],
}

/// Teper, NASA CR-96008, section XI, conditions 8001 and 8003. Mulder and others, lecture notes AE3202: eigenvalues
/// -0.039161 ± 0.037971j and -0.00029107 ± 0.0066006j by c/V of the Citation, V/c = 29.624 1/s. University of Minnesota, linear
/// model of the Ultra Stick 25e at 17 m/s, whose engine turns with the speed: its phugoid is another.
const PRINTED: [Printed; 4] = [
    Printed {
        name: "dc-8-approach",
        modes: [1.619, 0.522, 0.1635, 0.0606],
        within: [0.002, 0.002, 0.002, 0.04],
    },
    Printed {
        name: "dc-8-cruise",
        modes: [3.15, 0.342, 0.0243, 0.241],
        within: [0.003, 0.003, 0.01, 0.06],
    },
    Printed {
        name: "citation-500",
        modes: [1.6159, 0.71794, 0.19573, 0.04405],
        within: [0.002, 0.002, 0.002, 0.01],
    },
    Printed {
        name: "ultra-stick-25e",
        modes: [15.4, 0.76, 0.66, 0.24],
        within: [0.05, 0.04, 0.15, 1.0],
    },
];

#[test]
fn modes_are_those_that_the_sources_print() {
    for Printed { name, modes: printed, within } in PRINTED {
        let found = short_period_and_phugoid(&modes(name));
        for ((found, printed), within) in found.iter().zip(printed).zip(within) {
            assert!((found / printed - 1.0).abs() < within, "{name}: {found} is not {printed}");
        }
    }
}

/// Gryte and others: level at 18 m/s with 0.0308 rad and elevons at 0.0370 rad. Tjee and Mulder's polynomials balance at 7.24 deg.
#[test]
fn the_reference_of_the_flying_wing_has_the_angle_of_the_printed_trim() {
    let alpha_rad = derivative_data("skywalker-x8").reference.alpha_rad;
    assert!((alpha_rad - 0.0308).abs() < 0.0005, "{alpha_rad}");
    let alpha_rad = derivative_data("beaver").reference.alpha_rad;
    assert!((alpha_rad / DEG_RAD - 7.24).abs() < 1e-9);
}

/// The short period of a small unmanned aircraft is as fast as its size says, six times that of a transport.
#[test]
fn the_short_periods_of_the_classes_lie_apart() {
    let frequency = |name: &str| {
        let poles: Vec<_> = modes(name).iter().map(|mode| mode.pole).collect();
        poles.iter().map(|pole| libm::hypot(pole.re, pole.im)).fold(0.0, f64::max)
    };
    for name in ["aerosonde", "zagi", "skywalker-x8", "ultra-stick-25e", "anaconda", "mini-mutt"] {
        assert!((8.0..16.0).contains(&frequency(name)), "{name}: {}", frequency(name));
    }
    for name in ["navion", "cessna-172", "cessna-310", "beech-99", "beaver", "twin-otter"] {
        assert!((3.0..8.0).contains(&frequency(name)), "{name}: {}", frequency(name));
    }
    let transports = ["b747-approach", "b747-cruise-low", "dc-8-approach", "dc-8-cruise"];
    for name in
        transports.into_iter().chain(["jetstar", "learjet-24", "citation-500", "convair-880"])
    {
        assert!((0.7..3.3).contains(&frequency(name)), "{name}: {}", frequency(name));
    }
}
