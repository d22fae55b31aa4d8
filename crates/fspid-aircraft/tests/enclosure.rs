//! Enclosed linear models against those of the flown equations.

use fspid_aircraft::data::{DerivativeData, Laws, Loading, Moment};
use fspid_aircraft::enclosure::{EnclosedFlight, EnclosedModel};
use fspid_aircraft::{Environment, TrimTarget, VelocityForm};
use fspid_numeric::scalar::Interval;

use crate::support;

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use support::{derivative_data, with_derivatives};

const LAWS: [Laws; 2] = [
    Laws { drag: DragLaw::Linear, thrust: ThrustLaw::Constant },
    Laws { drag: DragLaw::Polar, thrust: ThrustLaw::WithSpeed },
];

/// Rows over θ, q, V, α and the elevator, by differences of the equations that fly.
fn flown(data: &DerivativeData, laws: Laws, target: TrimTarget) -> Option<[[f64; 5]; 4]> {
    let aircraft = data.aircraft(laws, Environment::STANDARD).expect("an aircraft");
    let trim = aircraft.trim(target).ok()?;
    let system = aircraft.linearise(&trim).longitudinal(VelocityForm::SpeedAndAngle);
    let system = system.expect("finite");
    // V, α, q, θ there.
    let places = [3, 2, 0, 1];
    Some(places.map(|row: usize| {
        let by_state = |column: usize| system.a().get(row, places[column]).expect("an entry");
        let by_elevator = system.b().get(row, 0).expect("an entry");
        [by_state(0), by_state(1), by_state(2), by_state(3), by_elevator]
    }))
}

/// Differences of the equations are that near to their derivatives, of the largest entry of a row.
const DIFFERENCED: f64 = 2e-8;

fn holds(model: &EnclosedModel<Interval>, rows: &[[f64; 5]; 4], what: &str) {
    for (place, row) in rows.iter().enumerate() {
        let largest = row.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        let own = model.by_states[place].iter().chain([&model.by_elevator[place]]);
        for (column, (own, value)) in own.zip(row).enumerate() {
            let off = (own.lower() - value).max(value - own.upper());
            let off = off / largest;
            assert!(
                off < DIFFERENCED,
                "{what}, row {place}, column {column}: {value} not in {own:?}"
            );
        }
    }
}

#[test]
fn at_one_condition_the_enclosure_is_the_linear_model_of_every_aircraft() {
    for name in with_derivatives() {
        let data = derivative_data(name);
        for laws in LAWS {
            for (speed, climb_rad) in [(1.0, 0.0), (0.97, 0.04), (1.05, -0.03)] {
                let target = TrimTarget {
                    airspeed_m_s: speed * data.reference.airspeed_m_s,
                    altitude_m: data.reference.altitude_m,
                    flight_path_rad: climb_rad,
                };
                let Some(rows) = flown(&data, laws, target) else { continue };
                let enclosed =
                    EnclosedFlight::<Interval>::of(&data, laws, Environment::STANDARD, target);
                let model = enclosed.model().expect("a trim");
                holds(&model, &rows, &format!("{name} {laws:?} {speed} {climb_rad}"));
                let widest = model.by_states.iter().flatten().map(|it| it.radius());
                assert!(widest.fold(0.0, f64::max) < 1e-6, "{name}: {model:?}");
            }
        }
    }
}

/// Numbers in 0..1 that differ.
fn share(number: u32) -> f64 {
    let golden = 0.618_033_988_749_895 * f64::from(number);
    golden - libm::floor(golden)
}

#[test]
fn every_flight_in_a_box_lies_in_the_enclosure_of_the_box() {
    let ranges = |centre: f64, part: f64| [centre * (1.0 - part), centre * (1.0 + part)];
    for name in ["navion", "b747-cruise-low", "aerosonde"] {
        let data = derivative_data(name);
        let [mass, speed] =
            [ranges(data.mass_kg(), 0.04), ranges(1.02 * data.reference.airspeed_m_s, 0.02)];
        let altitude = [data.reference.altitude_m, data.reference.altitude_m + 300.0];
        let radius = ranges(libm::sqrt(data.inertia.iy_kg_m2 / data.mass_kg()), 0.03);
        let slope = ranges(data.longitudinal.pitch.alpha, -0.03);
        let target =
            TrimTarget { airspeed_m_s: speed[0], altitude_m: altitude[0], flight_path_rad: 0.0 };
        let mut enclosed =
            EnclosedFlight::<Interval>::of(&data, LAWS[1], Environment::STANDARD, target);
        let between = |[from, to]: [f64; 2]| Interval::between(from, to);
        enclosed.mass_kg = between(mass);
        enclosed.inertia = Moment::Gyration(between(radius));
        enclosed.airspeed_m_s = between(speed);
        enclosed.altitude_m = between(altitude);
        enclosed.longitudinal.pitch.alpha = between(slope);
        enclosed.aft_chords = Interval::between(-0.02, 0.01);
        let model = enclosed.model().expect("a trim");
        for number in 0..40 {
            let at =
                |[from, to]: [f64; 2], which: u32| from + (to - from) * share(7 * number + which);
            let mut member = data;
            member.reference.cg_mac = Some(0.25);
            member.longitudinal.pitch.alpha = at(slope, 1);
            let member = member
                .loaded(Loading {
                    mass_kg: Some(at(mass, 2)),
                    cg_mac: Some(0.25 + at([-0.02, 0.01], 3)),
                    pitch: Some(Moment::Gyration(at(radius, 4))),
                    ..Loading::default()
                })
                .expect("a loading");
            let target = TrimTarget {
                airspeed_m_s: at(speed, 5),
                altitude_m: at(altitude, 6),
                flight_path_rad: 0.0,
            };
            let rows = flown(&member, LAWS[1], target).expect("a trim");
            holds(&model, &rows, &format!("{name}, member {number}"));
        }
    }
}

#[test]
fn a_box_with_flights_that_cannot_be_trimmed_has_no_model() {
    let data = derivative_data("navion");
    let target = TrimTarget { airspeed_m_s: 50.0, altitude_m: 0.0, flight_path_rad: 0.0 };
    let mut enclosed =
        EnclosedFlight::<Interval>::of(&data, LAWS[0], Environment::STANDARD, target);
    enclosed.airspeed_m_s = Interval::between(5.0, 60.0);
    assert!(enclosed.model().is_none());
    enclosed.airspeed_m_s = Interval::between(50.0, 60.0);
    enclosed.longitudinal.pitch.elevator = Interval::between(-0.5, 0.5);
    assert!(enclosed.model().is_none());
}
