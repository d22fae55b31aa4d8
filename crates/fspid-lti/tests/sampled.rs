//! Sampled loops against the handbook's numbers, closed forms and themselves.

use crate::support;

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use fspid_lti::{
    Complex, DiskMargin, FineMatrix, LtiError, Matrix, SampledLoop, SampledMargins, Stability,
    TransferFunction, modulus, quotient, zero_order_hold,
};
use support::Random;

type Outcome = Result<(), LtiError>;

const RAD_DEG: f64 = 180.0 / PI;

/// A continuous system, held and sampled, after a delay of whole samples.
fn sampled(
    system: &TransferFunction,
    dt_s: f64,
    delay_samples: usize,
) -> Result<SampledLoop, LtiError> {
    let model = system.to_state_space();
    let (held, input) = zero_order_hold(model.a(), model.b(), dt_s)?;
    let (states, order) = (model.states(), model.states() + delay_samples);
    let mut a = Matrix::zeros(order, order);
    let (mut b, mut c) = (vec![0.0; order], vec![0.0; order]);
    for row in 0..states {
        for column in 0..states {
            a.set(row, column, held.get(row, column).expect("inside"))?;
        }
        c[row] = model.c().get(0, row).expect("inside");
        let entry = input.get(row, 0).expect("inside");
        if delay_samples == 0 { b[row] = entry } else { a.set(row, states, entry)? }
    }
    for row in states + 1..order {
        a.set(row - 1, row, 1.0)?;
    }
    if delay_samples > 0 {
        b[order - 1] = 1.0;
    }
    SampledLoop::new(a, b, c, dt_s)
}

/// The paper's 747 with its servo, sign reversed, and proportional control.
fn b747(gain: f64) -> Result<TransferFunction, LtiError> {
    let plant = TransferFunction::new(
        &[1.69144, 0.84341, 0.0099096],
        &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
    )?;
    plant.series(&TransferFunction::new(&[10.0 * gain], &[1.0, 10.0])?)
}

fn stable(open: &SampledLoop) -> Result<Box<SampledMargins>, LtiError> {
    match open.margins()? {
        Stability::Stable(margins) => Ok(margins),
        Stability::Unstable { spectral_radius, .. } => {
            Err(LtiError::UnstableLoop { spectral_radius })
        }
    }
}

/// Gain margin in dB and phase margin in degrees.
fn in_print(margins: &SampledMargins) -> (f64, f64) {
    let gain = margins.gain_high.expect("a sampled loop has a limit").factor;
    let phase = margins.phase_margin.expect("a crossover").phase_margin_rad;
    (20.0 * libm::log10(gain), RAD_DEG * phase)
}

/// One state: $L = k/(z - a)$.
fn first_order(a: f64, k: f64) -> SampledLoop {
    let a = Matrix::from_rows(&[[a]]).expect("one entry");
    SampledLoop::new(a, vec![1.0], vec![k], 0.1).expect("a loop")
}

#[test]
fn a_sampled_plant_has_the_margins_of_the_documentation() -> Outcome {
    let open = sampled(&TransferFunction::new(&[2.0], &[1.0, 3.0, 2.0, 0.0])?, 0.05, 0)?;
    let found = stable(&open)?;
    let high = found.gain_high.expect("a limit");
    assert!((high.factor - 2.79).abs() < 5.1e-3, "{high:?}");
    assert!((high.omega_rad_s - 1.364).abs() < 5.1e-4, "{high:?}");
    let crossover = found.phase_margin.expect("a crossover");
    assert!((RAD_DEG * crossover.phase_margin_rad - 31.5).abs() < 5.1e-2, "{crossover:?}");
    assert!((crossover.omega_rad_s - 0.749).abs() < 5.1e-4, "{crossover:?}");
    assert_eq!((found.gain_low, found.crossovers.len()), (None, 1));
    Ok(())
}

#[test]
fn sampling_and_delay_decide_the_margins_of_the_747_as_in_the_handbook() -> Outcome {
    let nearly_continuous = in_print(&*stable(&sampled(&b747(2.0)?, 1e-4, 0)?)?);
    assert!((nearly_continuous.0 - 7.51).abs() < 5.1e-3, "{nearly_continuous:?}");
    assert!((nearly_continuous.1 - 18.08).abs() < 5.1e-3, "{nearly_continuous:?}");
    // Printed 5.64 dB; 15.2 deg in one place and 15.3 deg in another. 80 digits give 15.2212.
    let at_20_hz = in_print(&*stable(&sampled(&b747(2.0)?, 0.05, 0)?)?);
    assert!((at_20_hz.0 - 5.64).abs() < 5.1e-3, "{at_20_hz:?}");
    assert!((at_20_hz.1 - 15.2212).abs() < 5.1e-5, "{at_20_hz:?}");
    let late = stable(&sampled(&b747(2.0)?, 0.1, 1)?)?;
    let (gain_db, phase_deg) = in_print(&late);
    assert!((gain_db - 0.2).abs() < 5.1e-2 && (phase_deg - 0.9).abs() < 5.1e-2, "{late:?}");
    assert!(late.sensitivity_peak.value > 75.0 && late.disk.size < 0.0133, "{late:?}");
    Ok(())
}

#[test]
fn the_747_at_gains_5_and_10_is_unstable_and_has_no_margins() -> Outcome {
    // A grid called these disk margins of 0.015 and 0.196, and another tool phase margins above 230 deg.
    for (gain, dt_s) in [(5.0, 0.01), (5.0, 0.05), (10.0, 0.01), (10.0, 0.05)] {
        let open = sampled(&b747(gain)?, dt_s, 0)?;
        let Stability::Unstable { poles, spectral_radius } = open.margins()? else {
            panic!("gain {gain} has no margins");
        };
        assert!(poles.len() == 2 && spectral_radius > 1.0, "{poles:?}");
        assert!((modulus(poles[0]) - spectral_radius).abs() < 1e-15);
        let refused = Err(LtiError::UnstableLoop { spectral_radius });
        assert_eq!(open.peak_sensitivity(), refused);
        assert_eq!(open.peak_complementary(), refused);
        assert!(open.disk_margin(0.0).is_err() && open.bandwidth_rad_s().is_none());
    }
    Ok(())
}

#[test]
fn ends_of_disks_are_those_of_the_documentation() {
    let half = DiskMargin::ends(0.5, 0.0);
    assert!((half.0[1] - 1.6667).abs() < 5.1e-5 && (half.0[0] * half.0[1] - 1.0).abs() < 1e-15);
    assert!((RAD_DEG * half.1 - 28.0725).abs() < 5.1e-5);
    let skewed = DiskMargin::ends(0.6, 0.75);
    assert!((skewed.0[0] - 0.6066).abs() < 5.1e-5 && (skewed.0[1] - 2.2632).abs() < 5.1e-5);
    assert!((RAD_DEG * skewed.1 - 34.2267).abs() < 5.1e-5);
    for (skew, low, high) in [(-0.5, 0.3684, 1.9231), (0.0, 0.4545, 2.2), (0.5, 0.52, 2.7143)] {
        let ([found_low, found_high], _) = DiskMargin::ends(0.75, skew);
        assert!((found_low - low).abs() < 5.1e-5, "{skew}: {found_low}");
        assert!((found_high - high).abs() < 5.1e-5, "{skew}: {found_high}");
    }
    // 6 dB need 2/3 and give 36.9 deg; 45 deg need 0.828 and give 7.66 dB.
    let (six, phase) = DiskMargin::ends(2.0 / 3.0, 0.0);
    assert!((six[1] - 2.0).abs() < 1e-15 && (RAD_DEG * phase - 36.9).abs() < 5.1e-2);
    let (gain, phase) = DiskMargin::ends(2.0 * (2.0_f64.sqrt() - 1.0), 0.0);
    assert!((RAD_DEG * phase - 45.0).abs() < 1e-13);
    assert!((20.0 * libm::log10(gain[1]) - 7.66).abs() < 5.1e-3);
}

#[test]
fn large_disks_hold_all_gains_and_then_all_phases() {
    let (gain, phase) = DiskMargin::ends(2.0, 0.0);
    assert!(gain[0].abs() < 1e-15 && gain[1].is_infinite());
    assert!((phase - FRAC_PI_2).abs() < 1e-15);
    let (gain, phase) = DiskMargin::ends(5.0, 0.0);
    assert!(gain[0].abs() < 1e-15 && gain[1].is_infinite() && phase > FRAC_PI_2 && phase < PI);
    assert!((DiskMargin::ends(2.0, 1.0).1 - PI).abs() < 1e-15);
    assert!((DiskMargin::ends(4.0, -0.6).1 - PI).abs() < 1e-15);
}

#[test]
fn a_lag_has_the_limits_that_can_be_worked_out_by_hand() -> Outcome {
    // The pole is a − k: stable for k between −(1 − a) and 1 + a.
    let found = stable(&first_order(0.5, 0.75))?;
    let high = found.gain_high.expect("a limit");
    assert!((high.factor - 2.0).abs() < 1e-15 && (high.omega_rad_s - 10.0 * PI).abs() < 1e-13);
    assert_eq!(found.gain_low, None);
    assert!((found.spectral_radius - 0.25).abs() < 1e-15);
    // S = (z − a)/(z − a + k) is 1.5/0.75 at −1, T = k/(z − a + k) is 0.75/0.75 there.
    assert!((found.sensitivity_peak.value - 2.0).abs() < 1e-14);
    assert!((found.complementary_peak.value - 1.0).abs() < 1e-14);
    assert!((found.modulus_margin - 0.5).abs() < 1e-14);
    // |z − 1/2| = 3/4 where cos ωT = (1 + 1/4 − 9/16)/1.
    let crossover = found.phase_margin.expect("a crossover");
    assert!((crossover.omega_rad_s * 0.1 - libm::acos(0.6875)).abs() < 1e-15);
    let lag = found.delay_margin_s.expect("a crossover");
    assert!((lag * crossover.omega_rad_s - crossover.phase_margin_rad).abs() < 1e-15);
    Ok(())
}

#[test]
fn a_dead_time_of_whole_samples_up_to_the_delay_margin_is_borne_and_no_more() -> Outcome {
    let plant = b747(1.0)?;
    let dt_s = 0.005;
    let room = stable(&sampled(&plant, dt_s, 0)?)?.delay_margin_s.expect("a crossover");
    let samples = libm::floor(room / dt_s) as usize;
    assert!(samples > 90, "the test needs many states: {samples}");
    let last = stable(&sampled(&plant, dt_s, samples)?)?;
    let rest = last.delay_margin_s.expect("a crossover");
    assert!((rest + samples as f64 * dt_s - room).abs() < 1e-9, "{rest} {room}");
    assert!(stable(&sampled(&plant, dt_s, samples + 1)?).is_err());
    Ok(())
}

/// A rigid body and a bending mode near half the sample rate: g/(s (s + a)) + r/(s² + 2 ζ ω s + ω²).
fn bending(random: &mut Random, dt_s: f64) -> Result<TransferFunction, LtiError> {
    let (a, g) = (random.uniform(0.5, 5.0), random.uniform(0.5, 3.0));
    let damping = libm::pow(10.0, random.uniform(-2.5, -1.0));
    let omega = random.uniform(0.6, 1.5) * PI / dt_s;
    let sign = if random.uniform(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
    let r = sign * libm::pow(10.0, random.uniform(-1.0, 2.0)) * damping * omega * omega * 0.2;
    let [damper, spring] = [2.0 * damping * omega, omega * omega];
    TransferFunction::new(
        &[g + r, g * damper + r * a, g * spring],
        &[1.0, a + damper, a * damper + spring, a * spring, 0.0],
    )
}

/// The same loop with its input late by a part of a sample, on a straight line between two samples.
fn late(system: &TransferFunction, dt_s: f64, part: f64) -> Result<SampledLoop, LtiError> {
    let model = system.to_state_space();
    let (held, input) = zero_order_hold(model.a(), model.b(), dt_s)?;
    let states = model.states();
    let mut a = Matrix::zeros(states + 1, states + 1);
    let (mut b, mut c) = (vec![0.0; states + 1], vec![0.0; states + 1]);
    for row in 0..states {
        for column in 0..states {
            a.set(row, column, held.get(row, column).expect("inside"))?;
        }
        c[row] = model.c().get(0, row).expect("inside");
        let entry = input.get(row, 0).expect("inside");
        b[row] = (1.0 - part) * entry;
        a.set(row, states, part * entry)?;
    }
    b[states] = 1.0;
    SampledLoop::new(a, b, c, dt_s)
}

/// Crossovers alone promised 2.8 samples to a loop that one sample makes unstable.
#[test]
fn no_delay_margin_is_longer_than_the_first_delay_that_makes_the_loop_unstable() -> Outcome {
    let dt_s = 0.02;
    let mut random = Random(96);
    let (mut told, mut beyond) = (0, 0);
    for _ in 0..8000 {
        let plant = bending(&mut random, dt_s)?;
        let open = sampled(&plant, dt_s, 0)?;
        if !(open.at(open.nyquist_rad_s()).re > 1.0 + 1e-6) {
            continue;
        }
        let Ok(found) = stable(&open) else { continue };
        let margin_s = found.delay_margin_s.expect("a limit");
        assert!(stable(&sampled(&plant, dt_s, 1)?).is_err() && margin_s < dt_s, "{margin_s}");
        // As flights have it: stable up to it at every part of a sample, whatever it is that ends it.
        for share in [0.1, 0.3, 0.5, 0.7, 0.9, 0.999] {
            let part = share * margin_s / dt_s;
            assert!(stable(&late(&plant, dt_s, part)?).is_ok(), "{part} of {margin_s} s");
        }
        let crossovers = found.crossovers.iter().map(|at| at.delay_s);
        let least_s = crossovers.fold(f64::INFINITY, f64::min);
        if margin_s < least_s {
            let part = 1.001 * margin_s / dt_s;
            assert!(stable(&late(&plant, dt_s, part)?).is_err(), "{part} of {margin_s} s");
        }
        told += 1;
        beyond += usize::from(least_s > dt_s);
    }
    assert!(told >= 100 && beyond >= 5, "{told} {beyond}");
    Ok(())
}

#[test]
fn a_loop_with_three_integrators_is_stable_between_two_gains() -> Outcome {
    let a = Matrix::from_rows(&[[1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]])?;
    let open = SampledLoop::new(a, vec![0.0, 0.0, 1.0], vec![0.0012, 0.05, 0.6], 1.0)?;
    let found = stable(&open)?;
    let (low, high) = (found.gain_low.expect("below"), found.gain_high.expect("above"));
    // ζ³ + k (0.6 ζ² + 0.05 ζ + 0.0012) has its roots on |1 + ζ| = 1 for these factors.
    for (limit, beside) in [(low, -1e-6), (high, 1e-6)] {
        let [inside, outside] = [1.0 - beside, 1.0 + beside].map(|step| {
            let poles = open.closed_poles_at(limit.factor * step).expect("poles");
            poles.into_iter().map(modulus).fold(0.0, f64::max)
        });
        assert!(inside < 1.0 && outside > 1.0, "{limit:?}: {inside} {outside}");
    }
    assert!(low.factor < 1.0 && high.factor > 1.0 && low.omega_rad_s < high.omega_rad_s);
    Ok(())
}

#[test]
fn nothing_is_unknown_about_a_loop_without_gain() -> Outcome {
    let open = first_order(0.5, 0.0);
    let found = stable(&open)?;
    assert_eq!((found.gain_low, found.gain_high, found.phase_margin), (None, None, None));
    assert_eq!((found.delay_margin_s, found.crossovers.len()), (None, 0));
    assert!((found.sensitivity_peak.value - 1.0).abs() < 1e-15);
    assert!(found.complementary_peak.value.abs() < 1e-15 && (found.disk.size - 2.0).abs() < 1e-14);
    assert_eq!((open.zeros()?, open.bandwidth_rad_s()), (vec![], None));
    assert!(stable(&first_order(1.0, 0.0)).is_err(), "an integrator that nothing holds");
    Ok(())
}

#[test]
fn a_radius_within_a_billionth_of_one_counts_as_unstable() -> Outcome {
    assert!(stable(&first_order(1.0, 1e-8)).is_ok());
    assert!(stable(&first_order(1.0, 1e-10)).is_err());
    Ok(())
}

#[test]
fn the_value_is_that_of_the_matrices_as_given() -> Outcome {
    let mut random = Random(3);
    for order in [1, 2, 5, 9, 30] {
        let mut entries = || (0..order).map(|_| random.uniform(-0.6, 0.6)).collect::<Vec<f64>>();
        let rows: Vec<Vec<f64>> = (0..order).map(|_| entries()).collect();
        let (b, c) = (entries(), entries());
        let open = SampledLoop::new(Matrix::from_rows(&rows)?, b.clone(), c.clone(), 0.02)?;
        for omega in [0.0, 0.3, 20.0, 157.0] {
            let (sin, cos) = libm::sincos(0.02 * omega);
            // (zI − A)(x + jy) = b as real equations of twice the size.
            let real = Matrix::from_rows(
                &(0..2 * order)
                    .map(|i| {
                        let block = |j: usize| match (i < order, j < order) {
                            (true, true) | (false, false) => {
                                let own = if i == j { cos } else { 0.0 };
                                own - rows[i % order][j % order]
                            }
                            (top, _) if i % order == j % order => {
                                if top {
                                    -sin
                                } else {
                                    sin
                                }
                            }
                            _ => 0.0,
                        };
                        (0..2 * order).map(block).collect::<Vec<f64>>()
                    })
                    .collect::<Vec<Vec<f64>>>(),
            )?;
            let right: Vec<[f64; 1]> =
                (0..2 * order).map(|i| [b.get(i).copied().unwrap_or(0.0)]).collect();
            let x = real.solve(&Matrix::from_rows(&right)?)?;
            let sum = |from: usize| {
                c.iter().enumerate().map(|(i, c)| c * x.data()[from + i]).sum::<f64>()
            };
            let expected = Complex::new(sum(0), sum(order));
            let off = modulus(open.at(omega) - expected);
            assert!(off < 1e-12 * (1.0 + modulus(expected)), "{order} {omega}: {off}");
            assert!(
                (open.gain(omega) - modulus(expected)).abs() < 1e-11 * (1.0 + modulus(expected))
            );
        }
    }
    Ok(())
}

#[test]
fn the_phase_of_a_delay_falls_without_jumps_over_many_turns() -> Outcome {
    let lag = TransferFunction::new(&[1.0], &[1.0, 1.0])?;
    let open = sampled(&lag, 0.01, 40)?;
    let omegas: Vec<f64> = (0..=30).map(|k| 10.0 * f64::from(k)).collect();
    let shown = open.bode(&omegas);
    let undelayed = sampled(&lag, 0.01, 0)?;
    for (&omega, &(gain, phase)) in omegas.iter().zip(&shown) {
        assert!((gain / undelayed.gain(omega) - 1.0).abs() < 1e-10, "{omega}");
        let expected = undelayed.phase_rad(omega) - 0.4 * omega;
        assert!((phase - expected).abs() < 1e-9, "{omega}: {phase} {expected}");
    }
    assert!(shown[30].1 < -19.0 * TAU, "{:?}", shown[30]);
    assert_eq!(open.bode(&[]), vec![]);
    Ok(())
}

#[test]
fn a_phase_that_turns_late_between_two_frequencies_is_followed_there() -> Outcome {
    // Between 1 and 3.5 rad/s: hardly any turn up to the middle, more than half a circle behind it.
    let resonance = TransferFunction::new(&[1.0], &[1.0, 0.02, 9.0])?;
    let open = sampled(&resonance, 0.1, 1)?;
    let ends = [1.0, 3.5];
    let fine: Vec<f64> = (0..=2500).map(|k| 1.0 + 1e-3 * f64::from(k)).collect();
    let (rough, followed) = (open.bode(&ends), open.bode(&fine));
    assert!(followed[2500].1 - followed[0].1 < -PI, "{:?}", followed[2500]);
    for (rough, followed) in rough.iter().zip([followed[0], followed[2500]]) {
        assert!((rough.1 - followed.1).abs() < 1e-12, "{rough:?} {followed:?}");
    }
    Ok(())
}

#[test]
fn across_a_pole_without_damping_the_phase_jumps_by_half_a_turn() -> Outcome {
    // 1/(z² − 2 z cos θ + 1): real but for a sample of delay, which is half a radian between the two.
    let cosine = libm::cos(0.5);
    let a = Matrix::from_rows(&[[0.0, 1.0], [-1.0, 2.0 * cosine]])?;
    let open = SampledLoop::new(a, vec![0.0, 1.0], vec![1.0, 0.0], 1.0)?;
    let shown = open.bode(&[0.25, 0.75]);
    let jump = shown[1].1 - shown[0].1 + 0.5;
    assert!((jump.abs() - PI).abs() < 1e-9, "{shown:?}");
    Ok(())
}

#[test]
fn the_change_of_another_loop_is_refused_with_its_entry() -> Outcome {
    let open = || {
        let a = Matrix::from_rows(&[[0.9, 0.1], [-0.2, 0.8]])?;
        SampledLoop::new(a, vec![0.0, 1.0], vec![1.0, 0.0], 0.05)
    };
    let fine = |high: Matrix| {
        let low = Matrix::zeros(high.rows(), high.columns());
        FineMatrix::new(high, low)
    };
    let changed = |of_states: f64, of_input: f64| {
        let states = Matrix::from_rows(&[[-0.1, 0.1], [-0.2 + of_states, -0.2]])?;
        let input = Matrix::from_rows(&[[0.0], [1.0 + of_input]])?;
        open()?.with_change(fine(states)?, fine(input)?)
    };
    assert!(changed(0.0, 0.0).is_ok() && changed(1e-12, 1e-12).is_ok());
    for (found, entry) in [(changed(1e-8, 0.0), 2), (changed(0.0, 1e-8), 1)] {
        let is_told = matches!(found, Err(LtiError::OtherLoop { index, .. }) if index == entry);
        assert!(is_told, "{found:?}");
    }
    Ok(())
}

#[test]
fn integrators_lag_by_a_quarter_turn_each_at_low_frequency() -> Outcome {
    for (integrators, lag) in [(1, -FRAC_PI_2), (2, -PI)] {
        let mut denominator = vec![1.0];
        denominator.resize(integrators + 1, 0.0);
        let open = sampled(&TransferFunction::new(&[1.0], &denominator)?, 0.01, 0)?;
        assert!((open.phase_rad(1e-3) - lag).abs() < 1e-4, "{}", open.phase_rad(1e-3));
    }
    Ok(())
}

#[test]
fn poles_and_zeros_belong_to_the_loop_and_move_with_the_gain() -> Outcome {
    // (z − 0.3)/((z − 0.9)(z − 0.5)) after two samples.
    let a = Matrix::from_rows(&[
        [0.0, 1.0, 0.0, 0.0],
        [-0.45, 1.4, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [0.0; 4],
    ])?;
    let open = SampledLoop::new(a, vec![0.0, 0.0, 0.0, 1.0], vec![-0.3, 1.0, 0.0, 0.0], 0.1)?;
    let zeros = open.zeros()?;
    assert!(zeros.len() == 1 && modulus(zeros[0] - 0.3) < 1e-14, "{zeros:?}");
    let poles = open.open_poles()?;
    assert!(modulus(poles[3] - 0.9) < 1e-14 && modulus(poles[2] - 0.5) < 1e-14, "{poles:?}");
    for factor in [0.1, 1.0, 7.0] {
        for pole in open.closed_poles_at(factor)? {
            // 1 + k L = 0.
            let value = (pole - 0.3) * factor + pole * pole * (pole - 0.9) * (pole - 0.5);
            assert!(modulus(value) < 1e-12, "{factor}: {pole} {value}");
        }
    }
    assert_eq!(open.closed_poles()?, open.closed_poles_at(1.0)?);
    let closed = SampledLoop::new(open.closed_matrix(), vec![0.0; 4], vec![0.0; 4], 0.1)?;
    for (one, other) in closed.open_poles()?.iter().zip(open.closed_poles()?) {
        assert!(modulus(one - other) < 1e-9, "{one} {other}");
    }
    Ok(())
}

/// $\sum c_k / (z - p_k)$ with a factor on its input.
fn sum_of_poles(poles: [f64; 3], parts: [f64; 3], factor: f64) -> SampledLoop {
    let [one, two, three] = poles;
    let a = Matrix::from_rows(&[[one, 0.0, 0.0], [0.0, two, 0.0], [0.0, 0.0, three]]);
    SampledLoop::new(a.expect("a matrix"), vec![factor; 3], parts.to_vec(), 0.1).expect("a loop")
}

#[test]
fn parts_that_cancel_but_for_rounding_make_no_zero() -> Outcome {
    // 0.1 + 0.2 - 0.3 is not 0 in floating point. However small the input is.
    for factor in [1.0, 1e-9, 1e-20] {
        let one = sum_of_poles([0.5, 0.6, 0.7], [0.1, 0.2, -0.3], factor).zeros()?;
        assert!(one.len() == 1 && modulus(one[0] - 0.55) < 1e-12, "{factor}: {one:?}");
        let none = sum_of_poles([0.1, 0.2, 0.3], [0.1, -0.2, 0.1], factor).zeros()?;
        assert!(none.is_empty(), "{factor}: {none:?}");
        let two = sum_of_poles([0.5, 0.6, 0.7], [0.1, 0.2, -0.3 + 1e-14], factor).zeros()?;
        assert_eq!(two.len(), 2, "{factor}: {two:?}");
        let nothing = sum_of_poles([0.5, 0.5, 0.5], [0.1, 0.2, -0.3], factor).zeros()?;
        assert!(nothing.is_empty(), "{factor}: {nothing:?}");
    }
    Ok(())
}

#[test]
fn crossings_of_any_level_and_of_the_real_axis_are_found() -> Outcome {
    let open = sampled(&b747(1.0)?, 0.02, 1)?;
    for level in [0.01, 0.3, 1.2, 1.3, 20.0] {
        for omega in open.gain_crossings(level)? {
            assert!((open.gain(omega) / level - 1.0).abs() < 1e-11, "{level}: {omega}");
        }
    }
    // The phugoid's resonance: up through 3 and down again.
    assert_eq!(open.gain_crossings(3.0)?.len(), 2);
    assert!(open.gain_crossings(1e6)?.is_empty());
    let real = open.real_crossings()?;
    assert!(real[0].abs() < 1e-15 && (real[real.len() - 1] - open.nyquist_rad_s()).abs() < 1e-12);
    for &omega in &real {
        let value = open.at(omega);
        assert!(value.im.abs() < 1e-11 * modulus(value), "{omega}: {value}");
    }
    for level in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = open.gain_crossings(level);
        let what = "gain to be crossed";
        assert!(
            matches!(found, Err(LtiError::NotPositive { what: told, .. }) if told == what),
            "{level}: {found:?}"
        );
    }
    Ok(())
}

#[test]
fn at_its_bandwidth_a_closed_loop_passes_three_decibels_less_than_at_rest() -> Outcome {
    let open = sampled(&b747(2.0)?, 0.02, 0)?;
    let omega = open.bandwidth_rad_s().expect("it falls");
    let closed = |omega: f64| {
        let value = open.at(omega);
        modulus(quotient(value, value + 1.0))
    };
    let fall_db = 20.0 * libm::log10(closed(omega) / closed(0.0));
    assert!((fall_db + 3.0).abs() < 1e-11, "{fall_db}");
    let level = closed(0.0) * libm::pow(10.0, -0.15);
    assert!((1..200).all(|k| closed(omega * f64::from(k) / 200.0) > level));
    Ok(())
}

#[test]
fn what_is_no_loop_is_refused_by_name() {
    let two = || Matrix::identity(2);
    let build = |a: Matrix, b: Vec<f64>, c: Vec<f64>, dt_s: f64| {
        SampledLoop::new(a, b, c, dt_s).map_err(|error| match error {
            LtiError::Shape { what, .. }
            | LtiError::NotFinite { what, .. }
            | LtiError::Empty { what }
            | LtiError::NotPositive { what, .. } => what,
            _ => "another error",
        })
    };
    assert!(build(two(), vec![1.0; 2], vec![1.0; 2], 0.1).is_ok());
    assert_eq!(build(Matrix::zeros(0, 0), vec![], vec![], 0.1), Err("state matrix"));
    assert_eq!(build(Matrix::zeros(1, 2), vec![1.0], vec![1.0], 0.1), Err("state matrix"));
    assert_eq!(build(two(), vec![1.0], vec![1.0; 2], 0.1), Err("input vector"));
    assert_eq!(build(two(), vec![1.0; 2], vec![f64::NAN, 1.0], 0.1), Err("output vector"));
    for dt_s in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let found = build(two(), vec![1.0; 2], vec![1.0; 2], dt_s);
        assert_eq!(found, Err("sample period in seconds"));
    }
}

#[test]
fn a_place_of_the_z_plane_gives_the_value_of_the_difference_equation() -> Outcome {
    let open = sampled(&b747(2.0)?, 0.05, 3)?;
    for omega_rad_s in [0.01, 0.3, 2.0, 30.0] {
        let (sine, cosine) = libm::sincos(omega_rad_s * open.dt_s());
        let (on_circle, wanted) = (open.at_z(Complex::new(cosine, sine)), open.at(omega_rad_s));
        assert!(modulus(on_circle - wanted) < 1e-9 * modulus(wanted), "{omega_rad_s}");
    }
    // T/(z - 1) behind two samples of delay, off the circle.
    let integrator = sampled(&TransferFunction::new(&[1.0], &[1.0, 0.0])?, 0.05, 2)?;
    let z = Complex::new(0.6, 0.3);
    let wanted = quotient(Complex::new(0.05, 0.0), z * z * (z - 1.0));
    assert!(modulus(integrator.at_z(z) - wanted) < 1e-15, "{}", integrator.at_z(z));
    Ok(())
}
