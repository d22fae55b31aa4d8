//! Maps of an envelope: the same as point by point, in the same order, whoever computes them.

use std::num::NonZeroUsize;

use fspid_aircraft::aerodynamics::derivatives::DerivativeModel;
use fspid_aircraft::data::Laws;
use fspid_aircraft::envelope::{EnvelopeGrid, EnvelopeRow, Evenly, one_thread};
use fspid_aircraft::qualities::{CommandPath, PitchModel, Qualities};
use fspid_aircraft::{Aircraft, Environment, Linearisation, ModeName};
use fspid_lti::{FrequencyResponse, LtiError, TransferFunction};

use crate::support;

use support::{FOOT_M, derivative_data};

fn b747(environment: Environment) -> Aircraft<DerivativeModel> {
    derivative_data("b747-cruise-low").aircraft(Laws::default(), environment).expect("an aircraft")
}

fn servo() -> TransferFunction {
    TransferFunction::new(&[10.0], &[1.0, 10.0]).expect("a servo")
}

/// Slow enough to stall and fast enough to leave the derivatives.
fn grid() -> EnvelopeGrid {
    let path = CommandPath { servo: Some(servo()), delay_s: 0.05 };
    EnvelopeGrid {
        path,
        ..EnvelopeGrid::even(
            Evenly { first: 60.0, last: 300.0, count: 9 },
            Evenly { first: 0.0, last: 12_000.0, count: 5 },
        )
    }
}

/// Gain margin of proportional control with gain 1 behind the servo.
fn gain_margin(linear: &Linearisation) -> Option<f64> {
    let found = || -> Result<Option<f64>, LtiError> {
        let plant = linear.theta_over_elevator().map_err(|_| LtiError::Feedthrough)?.negated();
        let margins = FrequencyResponse::new(plant.series(&servo())?, 0.0)?.margins()?;
        Ok(margins.gain_margin())
    };
    found().ok().flatten()
}

fn map(threads: usize) -> Vec<EnvelopeRow<Option<f64>>> {
    let threads = NonZeroUsize::new(threads).expect("some");
    b747(Environment::STANDARD).envelope(&grid(), threads, gain_margin)
}

#[test]
fn a_map_does_not_depend_on_the_number_of_threads() {
    let one = map(1);
    assert_eq!(one.len(), 45);
    for threads in [2, 3, 7, 200] {
        // Text holds every digit, and compares infinities and reasons too.
        assert_eq!(format!("{one:?}"), format!("{:?}", map(threads)));
    }
}

#[test]
fn rows_come_altitude_by_altitude_and_have_flights_and_reasons() {
    let rows = map(2);
    let targets: Vec<_> = grid().targets().collect();
    assert!(rows.iter().zip(&targets).all(|(row, target)| row.target == *target));
    assert_eq!((targets[9].airspeed_m_s, targets[9].altitude_m), (60.0, 3_000.0));
    let flights = rows.iter().filter(|row| row.flight.is_ok()).count();
    assert!(flights > 5 && flights < 40, "{flights}");
    for row in rows.iter().filter(|row| row.flight.is_err()) {
        let reason = row.flight.as_ref().expect_err("filtered").to_string();
        assert!(reason.contains("no trim at"), "{reason}");
    }
}

#[test]
fn a_point_is_what_trim_and_linearisation_alone_would_give() {
    let aircraft = b747(Environment::STANDARD);
    for row in map(2) {
        let Ok(flight) = row.flight else { continue };
        let linear = aircraft.linearise(&aircraft.trim(row.target).expect("it flew before"));
        assert_eq!(flight.linear, linear);
        assert_eq!(flight.beside, gain_margin(&linear));
        let gravity_m_s2 = aircraft.environment().gravity_m_s2;
        let model = PitchModel::of(&linear, gravity_m_s2).expect("a plant").behind(grid().path);
        assert_eq!(flight.qualities, Ok(Qualities::of(&model, grid().category)));
    }
}

#[test]
fn at_the_reference_the_map_has_the_printed_modes_and_the_load_of_the_derivatives() {
    let environment = derivative_data("b747-cruise-low").reference_environment();
    let speed_m_s = 673.0 * FOOT_M;
    let altitude_m = derivative_data("b747-cruise-low").reference.altitude_m;
    let grid = EnvelopeGrid::even(
        Evenly { first: speed_m_s, last: speed_m_s, count: 1 },
        Evenly { first: altitude_m, last: altitude_m, count: 1 },
    );
    let rows = b747(environment).envelope(&grid, one_thread(), |_| ());
    let flight = rows[0].flight.as_ref().expect("the reference");
    let modes = flight.longitudinal.as_ref().expect("four poles");
    assert_eq!([modes[0].name, modes[1].name], [ModeName::ShortPeriod, ModeName::Phugoid]);
    let found = flight.qualities.as_ref().expect("a plant").short_period.expect("a stable pair");
    assert!((found.mode.natural_frequency_rad_s - 1.24124).abs() < 5.1e-6, "{found:?}");
    assert!((found.mode.damping_ratio - 0.46824).abs() < 5.1e-6, "{found:?}");
    // In level flight the lift is the weight: n/α is nearly (CLα + CD)/CL = 4.425/0.40.
    assert!((found.load_per_alpha_g_rad - 11.06).abs() < 0.11 * 11.06, "{found:?}");
    assert_eq!(flight.lateral.as_ref().expect("four poles").len(), 3);
}

#[test]
fn an_empty_grid_has_no_rows() {
    let grid = EnvelopeGrid::even(
        Evenly { first: 60.0, last: 300.0, count: 0 },
        Evenly { first: 0.0, last: 12_000.0, count: 5 },
    );
    let threads = NonZeroUsize::new(2).expect("some");
    assert!(b747(Environment::STANDARD).envelope(&grid, threads, |_| ()).is_empty());
}
