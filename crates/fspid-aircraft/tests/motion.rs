//! The enclosed nonlinear motion in pitch against the equations that fly.

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::data::{DerivativeData, Laws, Loading};
use fspid_aircraft::enclosure::{MOTION, MotionNumbers};
use fspid_aircraft::{
    AirMotion, Aircraft, Environment, EulerAngles, ForceModel, Quaternion, RigidState, Trim,
    TrimTarget, Vector3,
};
use fspid_numeric::scalar::Interval;

use crate::support::{derivative_data, with_derivatives};

const LAWS: [Laws; 2] = [
    Laws { drag: DragLaw::Linear, thrust: ThrustLaw::Constant },
    Laws { drag: DragLaw::Polar, thrust: ThrustLaw::WithSpeed },
];
/// Sides of the boxes: θ, q, V over that of the trim, α, elevator.
const REACH: [f64; MOTION] = [0.1, 0.2, 0.05, 0.05, 0.08];

/// Numbers in -1..1 that differ.
fn draw(number: u32) -> f64 {
    let golden = 0.618_033_988_749_895 * f64::from(number);
    2.0 * (golden - libm::floor(golden)) - 1.0
}

/// Rates of θ, q, V, α of the aircraft that flies, with the throttle of its trim.
fn flown<M: ForceModel>(aircraft: &Aircraft<M>, trim: &Trim, at: [f64; MOTION]) -> [f64; 4] {
    let [theta_rad, q, speed, alpha, elevator_rad] = at;
    let [u, w] = [speed * libm::cos(alpha), speed * libm::sin(alpha)];
    let state = RigidState {
        velocity_body_m_s: Vector3::new(u, 0.0, w),
        attitude: Quaternion::from_euler(EulerAngles { theta_rad, phi_rad: 0.0, psi_rad: 0.0 }),
        rates_rad_s: Vector3::new(0.0, q, 0.0),
        ..trim.state
    };
    let controls = fspid_aircraft::Controls { elevator_rad, ..trim.controls };
    let instant = aircraft.instant(&state, &controls, &AirMotion::STILL);
    let rate = instant.accelerations.velocity_rate_body_m_s2;
    let along = (u * rate.x + w * rate.z) / speed;
    [q, instant.accelerations.angular_rad_s2.y, along, instant.alpha_rate_rad_s]
}

fn each(mut told: impl FnMut(&str, &DerivativeData, Laws, TrimTarget)) {
    for name in with_derivatives() {
        let mut data = derivative_data(name);
        if data.reference.cg_mac.is_some() {
            let loading = Loading { cg_mac: Some(0.27), ..Loading::default() };
            data = data.loaded(loading).expect("a loading");
        }
        for laws in LAWS {
            let target = TrimTarget {
                airspeed_m_s: 1.03 * data.reference.airspeed_m_s,
                altitude_m: data.reference.altitude_m,
                flight_path_rad: -0.02,
            };
            told(name, &data, laws, target);
        }
    }
}

#[test]
fn the_rates_are_those_of_every_aircraft_that_flies_also_far_from_its_trim() {
    let mut compared = 0;
    each(|name, data, laws, target| {
        let aircraft = data.aircraft(laws, Environment::STANDARD).expect("an aircraft");
        let Ok(trim) = aircraft.trim(target) else { return };
        let numbers = MotionNumbers::of(data, laws, (Environment::STANDARD, 0.0), target);
        let thrust = numbers.trim().expect("a trim").thrust_n.midpoint();
        let theta = trim.state.euler().theta_rad;
        let centre =
            [theta, 0.0, target.airspeed_m_s, trim.point.alpha_rad, trim.controls.elevator_rad];
        for number in 0..20_u32 {
            let at: [f64; MOTION] = core::array::from_fn(|i| {
                let unit = if i == 2 { target.airspeed_m_s } else { 1.0 };
                centre[i]
                    + 3.0 * REACH[i] * unit * draw(7 * number + 3 * u32::try_from(i).expect("few"))
            });
            let (own, flown) = (numbers.rates(thrust, at), flown(&aircraft, &trim, at));
            for (row, (own, flown)) in own.into_iter().zip(flown).enumerate() {
                // The trim of the simulator is a float near the enclosed one.
                assert!(
                    (own - flown).abs() < 1e-8 * (1.0 + flown.abs()),
                    "{name} {row}: {own} {flown}"
                );
                compared += 1;
            }
        }
    });
    assert!(compared > 2000, "{compared}");
}

/// Everywhere in the box the slopes lie in $J(0) + \sum p_i H_i$, and the way of the rates from the trim in what the mean
/// of the slopes, with half of that, makes of the way to the point.
#[test]
fn slopes_and_rates_anywhere_in_a_box_are_enclosed_by_those_at_the_trim_and_the_bends() {
    each(|name, data, laws, target| {
        let numbers = MotionNumbers::of(data, laws, (Environment::STANDARD, 0.0), target);
        let mut reach = REACH;
        reach[2] *= target.airspeed_m_s;
        let Some(over) = numbers.over(reach) else { return };
        let centre = numbers.at_trim(&over.trim);
        let at_trim = numbers.rates(over.trim.thrust_n, centre);
        for number in 0..10_u32 {
            let way: [f64; MOTION] = core::array::from_fn(|i| {
                reach[i] * draw(11 * number + 5 * u32::try_from(i).expect("few"))
            });
            let at = core::array::from_fn(|i| centre[i] + Interval::point(way[i]));
            let (slopes, rates) =
                (numbers.slopes(&over.trim, at), numbers.rates(over.trim.thrust_n, at));
            for row in 0..4 {
                let mut gone = at_trim[row];
                for column in 0..MOTION {
                    let bent = |share: f64| {
                        let each = over.bends[row][column].iter().zip(way);
                        each.fold(over.slopes[row][column], |sum, (bend, way)| {
                            sum + *bend * Interval::point(share * way)
                        })
                    };
                    let middle = slopes[row][column].midpoint();
                    assert!(bent(1.0).contains(middle), "{name} {row} {column}");
                    gone = gone + bent(0.5) * Interval::point(way[column]);
                }
                assert!(gone.contains(rates[row].midpoint()), "{name} {row}: {gone:?}");
            }
        }
    });
}
