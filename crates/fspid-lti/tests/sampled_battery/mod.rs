//! Thousands of random sampled loops, each checked by other means than those that found its margins.
//!
//! The loops are products of short polynomials, so that their response is known without a matrix; stability is told by
//! the growth of powers of the closed loop's matrix, margins by a grid of 2400 frequencies with local refinement. No
//! loop may be called stable that is not, and no margin may be larger than the grid finds.

mod dense;
mod factored;
mod families;
mod family;
use crate::support;

use dense::{Dense, closed_matrix, distance, growth, quotient_of};
use factored::Factored;
use families::random_loop;
use fspid_lti::{LtiError, Peak, SampledMargins, Stability, modulus};
use support::Random;

type Outcome = Result<(), LtiError>;

/// Loops of each kind.
const LOOPS: usize = 400;
/// A loop may be refused from a radius of 1 − 10⁻⁹ on; this near to the circle both radii are known to as much again.
const SURELY_STABLE: f64 = 1.0 - 2e-9;
/// Largest relative difference from the values of the factored form: rounding of 10⁻¹² and less, with room.
const ALLOWED: f64 = 1e-10;
/// Of two peaks that differ by less than 10⁻⁹ either may be taken for the highest.
const ALLOWED_PEAK: f64 = 2e-9;
/// Two poles that meet are known to half of the digits.
const ALLOWED_RADIUS: f64 = 1e-7;
/// How far beside a limit the powers of the matrix are asked, and how near to it the next test goes.
const BESIDE: f64 = 1e-5;

#[test]
fn loops_of_aircraft_have_no_better_margins_than_a_dense_grid_finds() -> Outcome {
    battery(0, 1, [150, 150])
}

#[test]
fn loops_with_poles_anywhere_have_no_better_margins_than_a_dense_grid_finds() -> Outcome {
    battery(1, 2, [100, 200])
}

#[test]
fn lightly_damped_loops_have_no_better_margins_than_a_dense_grid_finds() -> Outcome {
    battery(2, 3, [70, 250])
}

#[test]
fn loops_with_several_integrators_have_no_better_margins_than_a_dense_grid_finds() -> Outcome {
    battery(3, 4, [200, 100])
}

#[test]
fn loops_with_long_dead_times_have_no_better_margins_than_a_dense_grid_finds() -> Outcome {
    battery(4, 5, [200, 80])
}

#[test]
fn loops_around_unstable_plants_have_no_better_margins_than_a_dense_grid_finds() -> Outcome {
    battery(5, 6, [150, 150])
}

/// Random loops of one kind; so many must be stable and so many not, or the test would say nothing.
fn battery(kind: usize, seed: u64, [stable_least, unstable_least]: [usize; 2]) -> Outcome {
    let mut random = Random(seed);
    let (mut stable, mut unstable) = (0, 0);
    for index in 0..LOOPS {
        let open = random_loop(kind, &mut random);
        match verdict(&open)? {
            None => unstable += 1,
            Some(found) => {
                stable += 1;
                let dense = Dense::new(&open);
                assert_peaks(index, &open, &dense, &found);
                assert_crossovers(index, &open, &dense, &found);
                assert_limits(index, &open, &dense, &found);
                beside_the_limit(&open, &found, &mut random)?;
            }
        }
    }
    assert!(stable >= stable_least && unstable >= unstable_least, "{stable} and {unstable}");
    Ok(())
}

/// The margins of a loop, if it is stable, after a check of that by powers of its matrix.
fn verdict(open: &Factored) -> Result<Option<Box<SampledMargins>>, LtiError> {
    let radius = growth(&closed_matrix(open, 1.0));
    let near = |found: f64| (found - radius).abs() < ALLOWED_RADIUS * radius;
    match open.realised().margins()? {
        Stability::Stable(found) => {
            assert!(radius < 1.0, "called stable with a radius of {radius}: {open:?}");
            assert!(near(found.spectral_radius), "{} {radius}", found.spectral_radius);
            Ok(Some(found))
        }
        Stability::Unstable { spectral_radius, .. } => {
            assert!(radius > SURELY_STABLE, "called unstable with {radius}: {open:?}");
            assert!(near(spectral_radius), "{spectral_radius} {radius}");
            Ok(None)
        }
    }
}

/// A peak is reached where it is said to be, and nothing on the grid is higher.
fn assert_peaks(index: usize, open: &Factored, dense: &Dense<'_>, found: &SampledMargins) {
    let disk = Peak { value: 1.0 / found.disk.size, omega_rad_s: found.disk.omega_rad_s };
    let peaks = [(found.sensitivity_peak, 1.0), (found.complementary_peak, 0.0), (disk, 0.5)];
    for (peak, centre) in peaks {
        let there = distance(open.at_angle(peak.omega_rad_s * open.dt_s), centre);
        assert!((there / peak.value - 1.0).abs() < ALLOWED, "{index}: {peak:?} is {there}");
        let lower = dense.peak(centre);
        assert!(peak.value > lower * (1.0 - ALLOWED_PEAK), "{index}: {peak:?} below {lower}");
    }
}

/// The gain is 1 where it is said to be, and every place at which it is so on the grid is among them.
fn assert_crossovers(index: usize, open: &Factored, dense: &Dense<'_>, found: &SampledMargins) {
    for crossover in &found.crossovers {
        let gain = modulus(quotient_of(open.at_angle(crossover.omega_rad_s * open.dt_s)));
        assert!((gain - 1.0).abs() < 10.0 * ALLOWED, "{index}: gain {gain} at {crossover:?}");
    }
    let known = dense.crossovers();
    for &(angle, margin) in &known {
        let near = found.crossovers.iter().any(|crossover| {
            (crossover.omega_rad_s * open.dt_s / angle - 1.0).abs() < 1e-6
                && (crossover.phase_margin_rad - margin).abs() < 1e-6
        });
        assert!(near, "{index}: {angle} {margin} is missing in {:?}", found.crossovers);
    }
    let nearest = known.iter().map(|known| known.1.abs()).fold(f64::INFINITY, f64::min);
    let phase = found.phase_margin.map_or(f64::INFINITY, |at| at.phase_margin_rad.abs());
    assert!(phase <= nearest + 1e-6, "{index}: {phase} beyond {nearest}");
    let turn = core::f64::consts::TAU;
    let lag = |&(angle, margin): &(f64, f64)| {
        (if margin < 0.0 { margin + turn } else { margin }) / angle * open.dt_s
    };
    let least = known.iter().map(lag).fold(f64::INFINITY, f64::min);
    let delay = found.delay_margin_s.unwrap_or(f64::INFINITY);
    assert!(delay <= least * (1.0 + 1e-6), "{index}: {delay} s beyond {least}");
    // With a gain of 1 and more at half the sample rate it is less than a sample, whatever crossovers say.
    let turns = !(modulus(quotient_of(open.at_angle(core::f64::consts::PI))) < 1.0 - 1e-8);
    assert!(!turns || delay < open.dt_s * (1.0 + 1e-6), "{index}: {delay} s");
    if known.len() == found.crossovers.len() && !known.is_empty() {
        let same = turns || (delay / least - 1.0).abs() < 1e-6;
        assert!(same, "{index}: {delay} s instead of {least}");
        assert!((phase - nearest).abs() < 1e-6, "{index}: {phase} instead of {nearest}");
    }
}

/// No crossing of the real axis on the grid is nearer to −1 than a limit, and the limits are what they are called.
fn assert_limits(index: usize, open: &Factored, dense: &Dense<'_>, found: &SampledMargins) {
    let factors = dense.factors();
    let up = factors.iter().copied().filter(|&factor| factor > 1.0).fold(f64::INFINITY, f64::min);
    let down = factors.iter().copied().filter(|&factor| factor < 1.0).fold(0.0, f64::max);
    let high = found.gain_high.map_or(f64::INFINITY, |limit| limit.factor);
    let low = found.gain_low.map_or(0.0, |limit| limit.factor);
    assert!(high <= up * (1.0 + ALLOWED), "{index}: {high} beyond {up}");
    assert!(low >= down * (1.0 - ALLOWED), "{index}: {low} beyond {down}");
    let [disk_low, disk_high] = found.disk.gain;
    assert!(disk_low >= low * (1.0 - 1e-7) && disk_high <= high * (1.0 + 1e-7), "{index}");
    for (limit, outward) in [(found.gain_low, -BESIDE), (found.gain_high, BESIDE)] {
        let Some(limit) = limit else { continue };
        let [before, after] = [-outward, outward]
            .map(|share| growth(&closed_matrix(open, limit.factor * (1.0 + share))));
        assert!(before < 1.0 && after > 1.0, "{index}: {limit:?} {before} {after}");
    }
}

/// The same loop with its gain moved close to a limit, and a little beyond it.
fn beside_the_limit(open: &Factored, found: &SampledMargins, random: &mut Random) -> Outcome {
    for limit in [found.gain_low, found.gain_high].into_iter().flatten() {
        let share = libm::pow(10.0, random.uniform(-7.0, -2.0));
        for side in [-1.0, 1.0] {
            let moved = limit.factor * (1.0 + side * share);
            let near = Factored { gain: open.gain * moved, ..open.clone() };
            let Some(margins) = verdict(&near)? else { continue };
            let limits = [margins.gain_low, margins.gain_high].into_iter().flatten();
            let nearest = limits.map(|own| (own.factor - 1.0).abs()).fold(f64::INFINITY, f64::min);
            // 1/(1 ± share) is share from 1, to its square; the limit itself is known to 10⁻⁹.
            let allowed = share * (1.0 + 2.0 * share) + 1e-9;
            assert!(nearest <= allowed, "{nearest} instead of {share}: {near:?}");
            assert!(margins.sensitivity_peak.value > 0.5 / allowed, "{margins:?}");
        }
    }
    Ok(())
}
