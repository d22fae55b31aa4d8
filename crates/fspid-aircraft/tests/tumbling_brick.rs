//! A brick that tumbles without moments: NASA's check case 2, and what the misprint of the paper does to it.

use fspid_aircraft::integrate::dormand_prince::{DormandPrince, Tolerance};
use fspid_aircraft::integrate::rk4;
use fspid_aircraft::{MassProperties, RIGID_STATES, RigidState, Vector3};

use crate::support;

use support::{DEG_RAD, FOOT_M, SLUG_KG};

const NASA: &str = include_str!("data/nesc_case02_sim01_rates.csv");

fn brick() -> MassProperties {
    let slug_ft2 = SLUG_KG * FOOT_M * FOOT_M;
    MassProperties {
        mass_kg: 0.155_404_754 * SLUG_KG,
        ix_kg_m2: 0.001_894_220 * slug_ft2,
        iy_kg_m2: 0.006_211_019 * slug_ft2,
        iz_kg_m2: 0.007_194_665 * slug_ft2,
        ixz_kg_m2: 0.0,
        engine_kg_m2_s: 0.0,
    }
}

fn start() -> RigidState {
    RigidState { rates_rad_s: DEG_RAD * Vector3::new(10.0, 20.0, 30.0), ..RigidState::AT_REST }
}

fn rate(_: f64, state: &[f64; RIGID_STATES]) -> [f64; RIGID_STATES] {
    let state = RigidState::from_array(state);
    state.rate(&state.accelerations(&brick(), 9.80665, Vector3::ZERO, Vector3::ZERO))
}

/// States at whole multiples of a time, by values between the steps of the adaptive method.
fn flown(every_s: f64, count: usize) -> Vec<RigidState> {
    let tolerance =
        Tolerance { relative: 1e-13, absolute: 1e-13, step_max_s: 0.01, ..Tolerance::default() };
    let end_s = every_s * count as f64 + 1e-9;
    let mut steps = DormandPrince::new(rate, (0.0, end_s), start().to_array(), tolerance)
        .expect("well posed")
        .map(|step| step.expect("a brick does not diverge"))
        .peekable();
    (0..=count)
        .map(|index| {
            let time_s = every_s * index as f64;
            while steps.next_if(|step| step.end_s() < time_s).is_some() {}
            RigidState::from_array(&steps.peek().expect("not after the end").at(time_s))
        })
        .collect()
}

fn nasa() -> Vec<[f64; 4]> {
    let rows = NASA.lines().filter(|line| !line.starts_with(['#', 't']));
    rows.map(|line| {
        let mut values = line.split(',').map(|value| value.parse().expect("a number"));
        core::array::from_fn(|_| values.next().expect("four columns"))
    })
    .collect()
}

#[test]
fn body_rates_are_those_of_nasa_to_a_billionth_of_a_degree_per_second() {
    let nasa = nasa();
    assert_eq!(nasa.len(), 301);
    let mut worst = 0.0_f64;
    for (state, [_, p, q, r]) in flown(0.1, 300).iter().zip(nasa) {
        let difference = (1.0 / DEG_RAD) * state.rates_rad_s - Vector3::new(p, q, r);
        let size = difference.to_array().into_iter().map(f64::abs).fold(0.0, f64::max);
        worst = worst.max(size);
    }
    println!("worst difference {worst:.3e} deg/s");
    assert!(worst < 1e-9, "{worst} deg/s");
}

#[test]
fn rates_and_angles_have_the_digits_of_the_handbook() {
    let printed = [
        (5, [-16.93949, 9.63194, 33.40663], [43.85835, 2.22519, 182.2129]),
        (10, [-2.41890, -23.55257, 28.12859], [-65.97725, 3.74448, 355.68139]),
        (20, [-5.42273, 22.71593, 28.60828], [4.22159, 4.06910, 713.63621]),
        (30, [12.61839, -17.39747, 31.11959], [-56.02598, -3.81027, 1075.70231]),
    ];
    let states = flown(5.0, 6);
    for (time_s, rates, angles) in printed {
        let state = states[time_s / 5];
        let found = state.rates_rad_s.to_array().map(|rate| rate / DEG_RAD);
        for (found, printed) in found.into_iter().zip(rates) {
            assert!((found - printed).abs() < 5.01e-6, "{time_s} s: {found} is not {printed}");
        }
        let euler = state.euler();
        let found = [euler.phi_rad, euler.theta_rad, euler.psi_rad].map(|angle| angle / DEG_RAD);
        for (found, printed) in found.into_iter().zip(angles) {
            // Full turns do not count; the first printed heading has four decimals.
            let off = libm::remainder(found - printed, 360.0).abs();
            assert!(
                off < if time_s == 5 { 5.01e-5 } else { 5.01e-6 },
                "{time_s} s: {found} {printed}"
            );
        }
    }
}

#[test]
fn energy_and_momentum_stay_as_they_are_without_forces() {
    let brick = brick();
    let free = |_: f64, state: &[f64; RIGID_STATES]| {
        let state = RigidState::from_array(state);
        state.rate(&state.accelerations(&brick, 0.0, Vector3::ZERO, Vector3::ZERO))
    };
    let first = RigidState { velocity_body_m_s: Vector3::new(3.0, -2.0, 1.0), ..start() };
    let (energy, turning) = (first.kinetic_energy_j(&brick), first.angular_momentum_ned(&brick));
    let mut state = first.to_array();
    for index in 0..15_000 {
        state = rk4::step(free, f64::from(index) * 0.002, &state, 0.002);
    }
    let last = RigidState::from_array(&state);
    assert!((last.kinetic_energy_j(&brick) / energy - 1.0).abs() < 1e-11);
    assert!((last.angular_momentum_ned(&brick) - turning).norm() < 1e-10 * turning.norm());
    assert!((last.velocity_ned_m_s() - first.velocity_ned_m_s()).norm() < 1e-9);
}

/// Table 2 of the paper as printed, r q for r p in pitch, solved for the rates without moments.
fn misprinted(_: f64, rates: &[f64; 3]) -> [f64; 3] {
    let MassProperties { ix_kg_m2: ix, iy_kg_m2: iy, iz_kg_m2: iz, .. } = brick();
    let [p, q, r] = *rates;
    [(iy - iz) / ix * q * r, (iz - ix) / iy * r * q, (ix - iy) / iz * p * q]
}

fn misprinted_after(seconds: i32) -> Vector3 {
    let first = start().rates_rad_s.to_array();
    let steps = 0..1000 * seconds;
    let last = steps
        .fold(first, |rates, index| rk4::step(misprinted, f64::from(index) * 0.001, &rates, 0.001));
    Vector3::from(last)
}

#[test]
fn the_printed_pitching_moment_makes_energy_out_of_nothing() {
    let energy = |rates| brick().rotational_energy_j(rates);
    let first = energy(start().rates_rad_s);
    let after_1_s = misprinted_after(1);
    for (found, printed) in after_1_s.to_array().into_iter().zip([3.4131, 30.8249, 28.2474]) {
        assert!((found / DEG_RAD - printed).abs() < 5.01e-5, "{}", found / DEG_RAD);
    }
    assert!((energy(after_1_s) / first - 1.27).abs() < 5e-3, "{}", energy(after_1_s) / first);
    let after_3_s = energy(misprinted_after(3)) / first;
    assert!((after_3_s - 5.15).abs() < 5e-3, "{after_3_s}");
}

#[test]
fn after_one_second_the_mended_rates_are_those_of_the_handbook() {
    let rates = flown(1.0, 1)[1].rates_rad_s.to_array();
    for (found, printed) in rates.into_iter().zip([4.25884, 23.11994, 28.37982]) {
        assert!((found / DEG_RAD - printed).abs() < 5.01e-6, "{}", found / DEG_RAD);
    }
}
