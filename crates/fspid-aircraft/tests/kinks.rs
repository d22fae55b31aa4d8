//! Kinks of an aircraft's data at a trim, and where a pitch that is held leads.

use fspid_aircraft::aerodynamics::increment::Increment;
use fspid_aircraft::aerodynamics::mach_table::{MachRow, MachTable};
use fspid_aircraft::aerodynamics::varied::VariedModel;
use fspid_aircraft::data::{DerivativeData, Laws};
use fspid_aircraft::{
    AirMotion, Aircraft, Controls, Environment, Flow, ForceModel, Loads, Travel, Trim, TrimTarget,
    Validity,
};

use fspid_aircraft::trim::{Held, Path, Power};

use crate::support::derivative_data;

const NAVION: &str = "navion";

fn target(data: &DerivativeData) -> TrimTarget {
    let airspeed_m_s = data.reference.airspeed_m_s;
    TrimTarget { airspeed_m_s, altitude_m: data.reference.altitude_m, flight_path_rad: 0.0 }
}

fn trimmed<M: ForceModel>(aircraft: &Aircraft<M>, target: TrimTarget) -> Trim {
    aircraft.trim(target).expect("it is held")
}

/// The Navion with a corner of a coefficient at a Mach number.
fn with_corner(
    data: &DerivativeData,
    mach: f64,
    set: impl Fn(&mut Increment),
) -> Aircraft<VariedModel> {
    let row = |mach: f64, is_set: bool| {
        let mut increment = Increment::default();
        if is_set {
            set(&mut increment);
        }
        MachRow { mach, increment }
    };
    let rows = vec![row(0.5 * mach, false), row(mach, false), row(1.5 * mach, true)];
    let table = MachTable::new(rows).expect("rising");
    let model = data.varied_model(Laws::default(), vec![], (Some(table), None)).expect("a model");
    Aircraft::new(data.mass_properties(), model, Environment::STANDARD).expect("a body")
}

#[test]
fn smooth_aircraft_have_no_kink_wherever_they_are_trimmed() {
    for name in [NAVION, "b747-cruise-low", "cessna-172", "learjet-24", "aerosonde", "zagi"] {
        let data = derivative_data(name);
        let model = data.force_model(Laws::default());
        let aircraft = Aircraft::new(data.mass_properties(), model, Environment::STANDARD);
        let aircraft = aircraft.expect("a body");
        let mut held = 0;
        for share in [0.8, 0.9, 1.0, 1.1, 1.3] {
            let target = target(&data);
            let target = TrimTarget { airspeed_m_s: share * target.airspeed_m_s, ..target };
            if let Ok(trim) = aircraft.trim(target) {
                held += 1;
                assert!(!aircraft.has_kink_at(&trim), "{name} {share}");
            }
        }
        assert!(held > 0, "{name}");
    }
}

#[test]
fn a_corner_at_the_trim_is_a_kink_and_one_a_centimetre_a_second_beside_it_is_none() {
    let data = derivative_data(NAVION);
    // Slow, so that there is an angle of attack for derivatives to go with.
    let target = TrimTarget { airspeed_m_s: 45.0, ..target(&data) };
    let model = data.force_model(Laws::default());
    let plain = Aircraft::new(data.mass_properties(), model, Environment::STANDARD);
    let mach = plain.expect("a body").flow(&target.state(0.0), &AirMotion::STILL).mach();
    let corners: [fn(&mut Increment); 3] = [
        |it| it.longitudinal.drag.reference = 0.05,
        |it| it.longitudinal.pitch.alpha = 0.2,
        |it| it.longitudinal.lift.reference = 0.2,
    ];
    for (number, corner) in corners.into_iter().enumerate() {
        // Half the width of a difference is 4.5e-4 m/s.
        for (beside_m_s, is_kink) in [(0.0, true), (3e-4, true), (-3e-4, true), (0.01, false)] {
            let by = 1.0 + beside_m_s / target.airspeed_m_s;
            let kinked = with_corner(&data, mach * by, corner);
            let trim = trimmed(&kinked, target);
            assert!(trim.point.alpha_rad > 0.01);
            assert_eq!(kinked.has_kink_at(&trim), is_kink, "{number} {beside_m_s}");
        }
    }
}

/// Drag over the mass in m/s^2 of what is so much faster, m/s.
type Drag = fn(f64) -> f64;

/// An aircraft with a drag of its own around an airspeed.
struct Dragged<M> {
    of: M,
    mass_kg: f64,
    airspeed_m_s: f64,
    drag_m_s2: Drag,
}

impl<M: ForceModel> ForceModel for Dragged<M> {
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
        let mut loads = self.of.loads(flow, controls);
        let faster_m_s = flow.airspeed_m_s - self.airspeed_m_s;
        loads.force_n.x -= self.mass_kg * (self.drag_m_s2)(faster_m_s);
        loads
    }

    fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
        self.of.loads_per_alpha_rate(flow)
    }

    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        self.of.thrust_n(flow, controls)
    }

    fn validity(&self) -> &Validity {
        self.of.validity()
    }

    fn travel(&self) -> &Travel {
        self.of.travel()
    }
}

#[test]
fn a_slope_that_changes_within_the_width_of_its_differences_is_no_kink_where_it_changes_steadily() {
    let data = derivative_data(NAVION);
    let target = TrimTarget { airspeed_m_s: 45.0, ..target(&data) };
    // Over the width of 4.5e-4 m/s the first two come to slopes that differ by 9e-3 and 9e-4 1/s.
    let drags: [(Drag, bool); 6] = [
        (|faster| 10.0 * faster * faster, false),
        (|faster| -faster * faster, false),
        (|faster| 0.01 * faster.abs(), true),
        (|faster| -1e-3 * faster.abs(), true),
        (|faster| 1e-5 * faster.abs(), false),
        (|faster| 0.01 * faster.abs() + 0.1 * faster * faster, true),
    ];
    for (number, (drag_m_s2, is_kink)) in drags.into_iter().enumerate() {
        let mass = data.mass_properties();
        let model = Dragged {
            of: data.force_model(Laws::default()),
            mass_kg: mass.mass_kg,
            airspeed_m_s: target.airspeed_m_s,
            drag_m_s2,
        };
        let aircraft = Aircraft::new(mass, model, Environment::STANDARD).expect("a body");
        let trim = trimmed(&aircraft, target);
        assert_eq!(aircraft.has_kink_at(&trim), is_kink, "{number}");
    }
}

#[test]
fn a_pitch_that_is_held_in_a_climb_leads_to_the_climb_that_has_the_same_throttle() {
    let data = derivative_data(NAVION);
    let model = data.force_model(Laws::default());
    let aircraft = Aircraft::new(data.mass_properties(), model, Environment::STANDARD);
    let aircraft = aircraft.expect("a body");
    let climb = TrimTarget { flight_path_rad: 0.05, ..target(&data) };
    let trim = trimmed(&aircraft, climb);
    // Steps of 0.02 rad: one, three and four of them.
    for by_rad in [-0.019, 0.045, -0.07] {
        let there = aircraft.at_held_pitch(&trim, by_rad).expect("there is such a flight");
        let pitch_rad = |it: &Trim| it.point.alpha_rad + it.target.flight_path_rad;
        assert!((pitch_rad(&there) - pitch_rad(&trim) - by_rad).abs() < 1e-12);
        let again = trimmed(&aircraft, there.target);
        assert!((again.point.throttle - trim.point.throttle).abs() < 1e-6, "{by_rad}");
    }
}

#[test]
fn a_pitch_that_is_held_leads_to_the_flight_that_has_the_same_throttle() {
    for name in [NAVION, "cessna-172", "aerosonde"] {
        let data = derivative_data(name);
        let model = data.force_model(Laws::default());
        let aircraft = Aircraft::new(data.mass_properties(), model, Environment::STANDARD);
        let aircraft = aircraft.expect("a body");
        let trim = trimmed(&aircraft, target(&data));
        for by_deg in [-4.0_f64, -1.0, 0.0, 0.5] {
            let by_rad = by_deg.to_radians();
            let Some(there) = aircraft.at_held_pitch(&trim, by_rad) else {
                assert!(by_deg.abs() > 1.0, "{name} {by_deg}");
                continue;
            };
            let theta_rad = there.point.alpha_rad + there.target.flight_path_rad;
            let before_rad = trim.point.alpha_rad + trim.target.flight_path_rad;
            assert!((theta_rad - before_rad - by_rad).abs() < 1e-12);
            let again = trimmed(&aircraft, there.target);
            assert!((again.point.throttle - trim.point.throttle).abs() < 1e-6, "{name} {by_deg}");
            assert!((again.point.alpha_rad - there.point.alpha_rad).abs() < 1e-8);
            let faster = there.target.airspeed_m_s - trim.target.airspeed_m_s;
            assert!(faster * by_deg <= 1e-9, "{name}: {faster} m/s with the nose {by_deg} deg up");
        }
        for nowhere in [1.5, -1.5, f64::NAN, f64::INFINITY] {
            assert_eq!(aircraft.at_held_pitch(&trim, nowhere), None, "{name} {nowhere}");
        }
    }
}

/// What a trim finds and what is held on the way from another trim is one flight.
#[test]
fn what_is_held_leads_to_the_trim_that_has_it() {
    let data = derivative_data(NAVION);
    let model = data.force_model(Laws::default());
    let aircraft = Aircraft::new(data.mass_properties(), model, Environment::STANDARD);
    let aircraft = aircraft.expect("a body");
    let trim = trimmed(&aircraft, target(&data));
    let TrimTarget { airspeed_m_s, altitude_m, .. } = trim.target;
    let there = TrimTarget {
        airspeed_m_s: airspeed_m_s + 6.0,
        altitude_m: altitude_m + 400.0,
        flight_path_rad: -0.03,
    };
    let asked = trimmed(&aircraft, there);
    let powers = [Power::Throttle(asked.point.throttle), Power::Airspeed(there.airspeed_m_s)];
    let paths = [
        Path::Pitch(asked.point.alpha_rad - 0.03),
        Path::FlightPath(-0.03),
        Path::VerticalSpeed(there.airspeed_m_s * libm::sin(-0.03)),
        Path::Airspeed(there.airspeed_m_s),
    ];
    for power in powers {
        for path in paths {
            let found =
                aircraft.at_held(&trim, &Held { power, path, altitude_m: there.altitude_m });
            // An airspeed that both hold says nothing of the path.
            if matches!((power, path), (Power::Airspeed(_), Path::Airspeed(_))) {
                assert_eq!(found, None);
                continue;
            }
            let found = found.unwrap_or_else(|| panic!("{power:?} {path:?}"));
            assert!((found.target.airspeed_m_s - there.airspeed_m_s).abs() < 1e-6);
            assert!((found.target.flight_path_rad + 0.03).abs() < 1e-8);
            assert!((found.point.throttle - asked.point.throttle).abs() < 1e-8);
            assert!((found.point.alpha_rad - asked.point.alpha_rad).abs() < 1e-8);
        }
    }
}
