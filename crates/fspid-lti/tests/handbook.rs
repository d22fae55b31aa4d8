//! The two aeroplanes of the paper, against numbers computed independently and by hand.

use fspid_lti::{Complex, LtiError, Mode, TransferFunction, eigenvalues, modulus};

type Outcome = Result<(), LtiError>;

/// 747 with the signs of the paper: a positive elevator lowers the nose.
fn b747() -> Result<TransferFunction, LtiError> {
    TransferFunction::new(
        &[-1.69144, -0.84341, -0.0099096],
        &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
    )
}

fn navion() -> Result<TransferFunction, LtiError> {
    TransferFunction::new(&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.0])
}

fn servo() -> Result<TransferFunction, LtiError> {
    TransferFunction::new(&[10.0], &[1.0, 10.0])
}

/// The handbook prints eight decimals.
const PRINTED: f64 = 5.1e-9;

fn assert_roots(found: &[Complex], expected: &[(f64, f64)], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (root, &(re, im)) in found.iter().zip(expected) {
        assert!(
            modulus(root - Complex::new(re, im)) < 1.5 * tolerance,
            "{root} is not {re} {im:+}j"
        );
    }
}

#[test]
fn the_747_has_the_poles_zeros_and_gain_of_the_handbook() -> Outcome {
    let plant = b747()?;
    let poles = [
        (-0.58323513, -1.09720321),
        (-0.58323513, 1.09720321),
        (-0.00227987, -0.06861410),
        (-0.00227987, 0.06861410),
    ];
    assert_roots(&plant.poles()?, &poles, PRINTED);
    assert_roots(&plant.zeros()?, &[(-0.48659413, 0.0), (-0.01204017, 0.0)], PRINTED);
    assert!((plant.dc_gain()? + 1.36175125).abs() < PRINTED);
    Ok(())
}

#[test]
fn the_747_has_the_short_period_and_the_phugoid_of_the_handbook() -> Outcome {
    let poles = b747()?.poles()?;
    let (short_period, phugoid) = (Mode::of_pole(poles[0])?, Mode::of_pole(poles[2])?);
    assert!((short_period.natural_frequency_rad_s - 1.24258525).abs() < PRINTED);
    assert!((short_period.damping_ratio - 0.46937233).abs() < PRINTED);
    assert!((phugoid.natural_frequency_rad_s - 0.06865197).abs() < PRINTED);
    assert!((phugoid.damping_ratio - 0.03320908).abs() < PRINTED);
    Ok(())
}

#[test]
fn the_navion_short_period_is_the_one_of_the_handbook_beside_a_free_integrator() -> Outcome {
    let plant = navion()?;
    let poles = plant.poles()?;
    let mode = Mode::of_pole(poles[0])?;
    assert!((mode.natural_frequency_rad_s - 3.5974).abs() < 5e-5);
    assert!((mode.damping_ratio - 0.6905).abs() < 5e-5);
    assert_eq!(poles[2], Complex::new(0.0, 0.0));
    assert!((plant.zeros()?[0].re + 1.9247).abs() < 5e-5);
    assert_eq!(plant.dc_gain(), Err(LtiError::InfiniteDcGain { integrators: 1 }));
    Ok(())
}

#[test]
fn the_complete_navion_has_the_modes_that_nelson_prints() -> Outcome {
    let denominator = [1.0, 5.0126, 13.177826, 0.670174, 0.59409];
    let plant = TransferFunction::new(&[-11.730435, -23.10585, -1.173743], &denominator)?;
    let poles = [
        (-2.489251, -2.601127),
        (-2.489251, 2.601127),
        (-0.017049, -0.213405),
        (-0.017049, 0.213405),
    ];
    assert_roots(&plant.poles()?, &poles, 5.1e-7);
    assert_roots(&plant.zeros()?, &[(-1.917554, 0.0), (-0.052181, 0.0)], 5.1e-7);
    Ok(())
}

/// Largest real part of a closed-loop pole of gain times loop under unit feedback.
fn rightmost(open_loop: &TransferFunction, gain: f64) -> Result<Complex, LtiError> {
    let closed = open_loop.denominator().sum(&open_loop.numerator().scaled(gain)?)?;
    Ok(closed.roots()?.into_iter().fold(Complex::new(f64::NEG_INFINITY, 0.0), |best, root| {
        if root.re >= best.re { root } else { best }
    }))
}

/// Gain in 1 to 10 at which the fast pair crosses the axis, by bisection, and its frequency in rad/s.
fn neutral_gain(open_loop: &TransferFunction) -> Result<(f64, f64), LtiError> {
    let (mut stable, mut unstable) = (1.0, 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (stable + unstable);
        if rightmost(open_loop, middle)?.re < 0.0 { stable = middle } else { unstable = middle }
    }
    Ok((stable, rightmost(open_loop, unstable)?.im))
}

#[test]
fn the_p_loops_of_both_aeroplanes_lose_stability_at_the_gains_of_the_handbook() -> Outcome {
    let (gain, frequency_rad_s) = neutral_gain(&b747()?.negated().series(&servo()?)?)?;
    assert!(
        (gain - 4.750).abs() < 5e-4 && (frequency_rad_s - 2.929).abs() < 5e-4,
        "{gain} {frequency_rad_s}"
    );
    let (gain, frequency_rad_s) = neutral_gain(&navion()?.series(&servo()?)?)?;
    assert!(
        (gain - 4.005).abs() < 5e-4 && (frequency_rad_s - 6.327).abs() < 5e-4,
        "{gain} {frequency_rad_s}"
    );
    Ok(())
}

#[test]
fn at_the_neutral_gain_the_loop_is_minus_one_on_the_imaginary_axis() -> Outcome {
    let open_loop = navion()?.series(&servo()?)?;
    let (gain, frequency_rad_s) = neutral_gain(&open_loop)?;
    let value = gain * open_loop.at(Complex::new(0.0, frequency_rad_s));
    assert!(modulus(value + 1.0) < 1e-12, "{value}");
    Ok(())
}

#[test]
fn without_the_sign_reversal_no_positive_gain_stabilises_the_747() -> Outcome {
    let open_loop = b747()?.series(&servo()?)?;
    for (gain, re, im) in [(0.1, 0.0265, 0.060), (0.5, 0.320, 0.0), (5.0, 2.13, 0.0)] {
        let root = rightmost(&open_loop, gain)?;
        assert!((root.re - re).abs() < 5e-3 && (root.im - im).abs() < 5e-4, "{gain} {root}");
    }
    Ok(())
}

#[test]
fn the_states_are_the_pitch_angle_and_the_pitch_rate() -> Outcome {
    // A step of the elevator moves neither x1 = theta nor x2 = q at once, because h0 = h1 = 0; it moves x2' by h2.
    let model = b747()?.to_state_space();
    assert_eq!(model.c().data(), [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(model.a().get(0, 1), Some(1.0));
    assert_eq!(model.b().data()[..2], [0.0, -1.69144]);
    assert_eq!(model.d().data(), [0.0]);
    Ok(())
}

#[test]
fn the_state_space_form_has_the_poles_and_the_frequency_response_of_the_transfer_function()
-> Outcome {
    for plant in [
        b747()?,
        navion()?,
        b747()?.series(&servo()?)?,
        TransferFunction::new(&[2.0, 3.0], &[4.0, 5.0])?,
    ] {
        let model = plant.to_state_space();
        for (pole, value) in plant.poles()?.iter().zip(eigenvalues(model.a())?) {
            assert!(modulus(pole - value) < 1e-12, "{pole} {value}");
        }
        // The Laurent series, summed far outside the poles.
        let markov = plant.markov_parameters(60);
        let s = Complex::new(0.0, 100.0);
        let series = markov.iter().rev().fold(Complex::new(0.0, 0.0), |sum, h| sum / s + h);
        assert!(
            modulus(series - plant.at(s)) < 1e-13 * modulus(series),
            "{series} {}",
            plant.at(s)
        );
    }
    Ok(())
}
