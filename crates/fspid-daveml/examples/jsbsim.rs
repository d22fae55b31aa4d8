//! Loads of a JSBSim aircraft at given states: `cargo run --example jsbsim -- FILE.xml [--set NAME=VALUE …] < states`
//!
//! The first line answered is mass (slug), Ixx, Iyy, Izz, Izx (slug ft²) and the centre of mass from the aerodynamic
//! reference point, forward and down (ft). Each state is a line of airspeed (ft/s), alpha, beta (rad), p, q, r (rad/s), Mach,
//! altitude (ft), density (slug/ft³), elevator, left aileron, rudder (rad), rate of alpha (rad/s); answered are forces in lbf
//! and moments in ft lbf along the body's axes, about the centre of mass.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example that is run by hand")]

use std::io::{self, BufRead};
use std::process::ExitCode;

use fspid_aircraft::{Air, Controls, Flow, ForceModel, Loads, Vector3};
use fspid_daveml::flight::TableForces;
use fspid_daveml::jsbsim::{Assumptions, read};

const FOOT_M: f64 = 0.3048;
const POUND_N: f64 = 4.448_221_615_260_5;

fn main() -> ExitCode {
    match answer() {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::from(2)
        }
    }
}

fn answer() -> Result<(), String> {
    let mut words = std::env::args().skip(1);
    let path = words.next().ok_or("which file?")?;
    let held = words.filter_map(|word| {
        let (name, value) = word.split_once('=')?;
        Some((name.to_owned(), value.parse().ok()?))
    });
    let assumptions = Assumptions { held: held.collect(), thrust_lbf: None };
    let text = std::fs::read_to_string(&path).map_err(|error| error.to_string())?;
    let aircraft = read(&text, &assumptions).map_err(|problems| problems.to_string())?;
    let (body, forces) = aircraft.flies().map_err(|error| error.to_string())?;
    let slug_kg = POUND_N / FOOT_M;
    let inertia = slug_kg * FOOT_M * FOOT_M;
    let mass = body.mass;
    println!(
        "{:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        mass.mass_kg / slug_kg,
        mass.ix_kg_m2 / inertia,
        mass.iy_kg_m2 / inertia,
        mass.iz_kg_m2 / inertia,
        mass.ixz_kg_m2 / inertia,
        body.centre_of_mass_m.x / FOOT_M,
        body.centre_of_mass_m.z / FOOT_M,
    );
    for line in io::stdin().lock().lines() {
        let line = line.map_err(|error| error.to_string())?;
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|it| it.parse().ok()).collect();
        let state: [f64; 13] = numbers.try_into().map_err(|_| "13 numbers in each line")?;
        let Loads { force_n, moment_n_m } = loads(&forces, state);
        let [x, y, z] = force_n.to_array().map(|value| value / POUND_N);
        let [l, m, n] = moment_n_m.to_array().map(|value| value / (POUND_N * FOOT_M));
        println!("{x:?} {y:?} {z:?} {l:?} {m:?} {n:?}");
    }
    Ok(())
}

#[allow(clippy::disallowed_methods, reason = "an example may use the platform's functions")]
fn loads(forces: &TableForces, state: [f64; 13]) -> Loads {
    let [v_ft_s, alpha, beta, p, q, r, mach, h_ft, density, elevator, aileron, rudder, rate] =
        state;
    let velocity = v_ft_s
        * FOOT_M
        * Vector3::new(alpha.cos() * beta.cos(), beta.sin(), alpha.sin() * beta.cos());
    let air = Air::with_density(density * POUND_N / FOOT_M.powi(4), v_ft_s * FOOT_M / mach);
    let flow = Flow::new(velocity, Vector3::new(p, q, r), h_ft * FOOT_M, air);
    let controls = Controls {
        elevator_rad: elevator,
        aileron_rad: aileron,
        rudder_rad: rudder,
        ..Controls::default()
    };
    forces.loads(&flow, &controls).plus(forces.loads_per_alpha_rate(&flow).scaled(rate))
}
