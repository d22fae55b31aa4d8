//! Derivatives that vary in flight, against the same aircraft loaded and written otherwise.

use fspid_aircraft::aerodynamics::increment::{Configuration, Increment};
use fspid_aircraft::aerodynamics::mach_table::{MachRow, MachTable};
use fspid_aircraft::aerodynamics::varied::{Deployed, VariedModel};
use fspid_aircraft::data::{DerivativeData, GroundData, Laws, Loading, Moment};
use fspid_aircraft::{
    AirMotion, Aircraft, Controls, Environment, EulerAngles, ForceModel, FuelledBody, Instant,
    Quaternion, RigidState, Vector3,
};

use crate::support::derivative_data;

const NAME: &str = "navion";
const ATTITUDE: EulerAngles = EulerAngles { phi_rad: 0.1, theta_rad: 0.05, psi_rad: 0.2 };

fn state() -> RigidState {
    RigidState {
        position_ned_m: Vector3::new(0.0, 0.0, -5.0),
        velocity_body_m_s: Vector3::new(52.0, 1.5, 3.0),
        attitude: Quaternion::from_euler(ATTITUDE),
        rates_rad_s: Vector3::new(0.05, -0.08, 0.03),
    }
}

const CONTROLS: Controls =
    Controls { elevator_rad: -0.05, aileron_rad: 0.03, rudder_rad: -0.02, throttle: 1.1 };

fn instant<M: ForceModel>(aircraft: &Aircraft<M>) -> Instant {
    aircraft.instant(&state(), &CONTROLS, &AirMotion::STILL)
}

fn assert_alike(one: &Instant, other: &Instant) {
    let parts = |it: &Instant| {
        let Instant { loads, accelerations, .. } = it;
        let (turn, moved) = (accelerations.angular_rad_s2, accelerations.velocity_rate_body_m_s2);
        [loads.force_n, loads.moment_n_m, turn, moved].map(Vector3::to_array).concat()
    };
    for (a, b) in parts(one).into_iter().zip(parts(other)) {
        assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{one:?}\n{other:?}");
    }
}

fn varied(data: &DerivativeData, deployed: Vec<Deployed>) -> Aircraft<VariedModel> {
    let model = data.varied_model(Laws::default(), deployed, (None, None)).expect("a model");
    Aircraft::new(data.mass_properties(), model, Environment::STANDARD).expect("a body")
}

/// Half of the fuel is gone from a tank ahead: as if it had been loaded so from the start.
#[test]
fn an_aircraft_with_less_fuel_is_that_of_its_loading() {
    let data = derivative_data(NAME).loaded(Loading { cg_mac: Some(0.31), ..Loading::default() });
    let data = data.expect("the data have a centre of gravity");
    let (full_kg, left_kg, tank_mac) = (160.0, 70.0, 0.05);
    let chord_m = data.geometry.chord_m;
    let body = FuelledBody::new(data.mass_properties(), full_kg, (tank_mac - 0.31) * chord_m);
    let body = body.expect("a body");
    let flown = varied(&data, vec![]);
    let now = flown.model().at(&flown, std::iter::empty(), Some((&body, left_kg)));

    // By hand: two masses on a line.
    let mass_kg = data.mass_kg();
    let empty_kg = mass_kg - full_kg;
    let empty_mac = (mass_kg * 0.31 - full_kg * tank_mac) / empty_kg;
    let of = |fuel_kg: f64| {
        let total_kg = empty_kg + fuel_kg;
        let cg_mac = (empty_kg * empty_mac + fuel_kg * tank_mac) / total_kg;
        let arm = |mac: f64| (mac - cg_mac) * chord_m;
        let square = |value: f64| value * value;
        let apart = empty_kg * square(arm(empty_mac)) + fuel_kg * square(arm(tank_mac));
        (total_kg, cg_mac, apart)
    };
    let ((_, _, full), (left_mass_kg, cg_mac, left)) = (of(full_kg), of(left_kg));
    let loading = Loading {
        mass_kg: Some(left_mass_kg),
        cg_mac: Some(cg_mac),
        pitch: Some(Moment::Inertia(data.inertia.iy_kg_m2 - full + left)),
        yaw: Some(Moment::Inertia(data.inertia.iz_kg_m2 - full + left)),
        ..Loading::default()
    };
    let loaded = derivative_data(NAME).loaded(loading).expect("known");
    let loaded = loaded.aircraft(Laws::default(), Environment::STANDARD).expect("flies");
    assert_alike(&instant(&now), &instant(&loaded));
    assert!((now.mass().mass_kg - left_mass_kg).abs() < 1e-9);
}

#[test]
fn a_share_of_a_configuration_is_that_share_of_its_increments() {
    let data = derivative_data(NAME);
    let mut increment = Increment::default();
    increment.longitudinal.lift.reference = 0.4;
    increment.longitudinal.drag.alpha = 0.1;
    increment.longitudinal.pitch.elevator = -0.2;
    increment.longitudinal.pitch.alpha_rate = -1.0;
    increment.lateral.roll.aileron = -0.05;
    let configuration = Configuration {
        name: "flaps".to_owned(),
        increment,
        most_airspeed_m_s: f64::INFINITY,
        source: "made up".to_owned(),
    };
    let deployed = |share| vec![Deployed { configuration: configuration.clone(), share }];
    let flown = varied(&data, deployed(0.0));
    let [none, half, all] =
        [0.0, 0.5, 1.0].map(|share| instant(&flown.model().at(&flown, [share].into_iter(), None)));
    let plain = data.aircraft(Laws::default(), Environment::STANDARD).expect("flies");
    assert_alike(&none, &instant(&plain));
    assert_alike(&all, &instant(&varied(&data, deployed(1.0))));
    // Loads are linear but for what the angle of attack's rate does with them.
    let middle = 0.5 * (none.loads.force_n + all.loads.force_n);
    assert!((half.loads.force_n - middle).norm() < 1e-3 * all.loads.force_n.norm());
}

#[test]
fn mach_number_and_the_ground_come_with_the_flow() {
    let data = derivative_data(NAME);
    let row = |mach: f64, drag: f64| {
        let mut increment = Increment::default();
        increment.longitudinal.drag.reference = drag;
        MachRow { mach, increment }
    };
    let table = MachTable::new(vec![row(0.1, 0.0), row(0.3, 0.02)]).expect("rising");
    let ground = GroundData { wing_height_m: 1.0, induced_drag_factor: Some(0.05) };
    let model = data.varied_model(Laws::default(), vec![], (Some(table), Some((ground, 0.0))));
    let model = model.expect("a model");
    let plain = data.force_model(Laws::default());
    let aircraft = Aircraft::new(data.mass_properties(), model, Environment::STANDARD);
    let aircraft = aircraft.expect("a body");
    let flow = aircraft.flow(&state(), &AirMotion::STILL);
    let found = aircraft.model().loads(&flow, &CONTROLS).force_n;
    let without = plain.loads(&flow, &CONTROLS).force_n;
    let scale_n = flow.dynamic_pressure_pa() * data.geometry.area_m2;
    let thrust_n = plain.thrust_n(&flow, &CONTROLS);
    let (sin, cos) = libm::sincos(flow.alpha_rad);
    let lift = ((without.x - thrust_n) * sin - without.z * cos) / scale_n;
    let spans = 16.0 * 6.0 / data.geometry.span_m;
    let square = spans * spans;
    let phi = square / (1.0 + square) + 1.0 / 257.0;
    let drag = 0.02 * (flow.mach() - 0.1) / 0.2 - (1.0 - phi) * 0.05 * lift * lift;
    let expected = without - (drag * scale_n) * Vector3::new(cos, 0.0, sin);
    assert!((found - expected).norm() < 1e-9 * expected.norm(), "{found:?} {expected:?}");
    let validity = aircraft.model().validity();
    assert!((validity.mach.min - 0.1).abs() < 1e-15 && (validity.mach.max - 0.3).abs() < 1e-15);
}
