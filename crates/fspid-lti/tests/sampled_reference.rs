//! Margins of sampled loops against polynomials in cos ωT of 80 digits: `oracles/make_margins.py`.

use crate::support;

use fspid_lti::{
    Complex, GainLimit, LtiError, Peak, SampledLoop, SampledMargins, Stability, modulus,
};
use support::{complex_numbers, matrix, numbers, rows};

type Outcome = Result<(), LtiError>;

/// Largest relative difference; the worst found is 3e-12, of a lower limit of the gain beside three integrators, and
/// the usual one 1e-14.
const ALLOWED: f64 = 1e-10;
/// Zeros are eigenvalues: 3e-12 is found, and half of the digits where two coincide.
const ALLOWED_ZERO: f64 = 1e-10;
const ALLOWED_DOUBLE_ZERO: f64 = 1e-7;
const DOUBLE_ZERO: &str = "triple-integrator-conditional";

/// A loop and its row of the table.
struct Reference {
    name: &'static str,
    open: SampledLoop,
    fields: Vec<&'static str>,
}

impl Reference {
    fn all() -> impl Iterator<Item = Self> {
        rows(include_str!("data/margins.csv")).map(|fields| {
            let b = numbers(fields[3]);
            let a = matrix(b.len(), &numbers(fields[2]));
            let dt_s = fields[1].parse().expect("a period");
            let open = SampledLoop::new(a, b, numbers(fields[4]), dt_s).expect("a loop");
            Self { name: fields[0], open, fields }
        })
    }

    fn margins(&self) -> Result<Option<Box<SampledMargins>>, LtiError> {
        match self.open.margins()? {
            Stability::Stable(margins) => Ok(Some(margins)),
            Stability::Unstable { .. } => Ok(None),
        }
    }

    #[track_caller]
    fn assert_near(&self, found: &[f64], field: usize) {
        let expected = numbers(self.fields[field]);
        assert_eq!(found.len(), expected.len(), "{} field {field}: {found:?}", self.name);
        for (found, expected) in found.iter().zip(expected) {
            let difference =
                (found - expected).abs() / if expected == 0.0 { 1.0 } else { expected.abs() };
            assert!(difference < ALLOWED, "{} field {field}: {found} is not {expected}", self.name);
        }
    }
}

fn limit(limit: Option<GainLimit>) -> Vec<f64> {
    limit.map_or(vec![], |limit| vec![limit.factor, limit.omega_rad_s])
}

fn peak(peak: Peak) -> Vec<f64> {
    vec![peak.value, peak.omega_rad_s]
}

#[test]
fn loops_are_stable_where_the_roots_of_their_polynomials_lie_inside() -> Outcome {
    let mut stable = 0;
    for reference in Reference::all() {
        let radius = match reference.open.margins()? {
            Stability::Stable(margins) => {
                assert_eq!(reference.fields[5], "1", "{}", reference.name);
                stable += 1;
                margins.spectral_radius
            }
            Stability::Unstable { spectral_radius, poles } => {
                assert_eq!(reference.fields[5], "0", "{}", reference.name);
                assert!(!poles.is_empty() && poles.iter().all(|&pole| modulus(pole) > 0.999));
                spectral_radius
            }
        };
        reference.assert_near(&[radius], 6);
    }
    assert_eq!(stable, 42);
    Ok(())
}

#[test]
fn limits_crossovers_and_dead_times_are_those_of_the_reference() -> Outcome {
    for reference in Reference::all() {
        let Some(found) = reference.margins()? else { continue };
        reference.assert_near(&limit(found.gain_low), 7);
        reference.assert_near(&limit(found.gain_high), 8);
        let expected = complex_numbers(reference.fields[9]);
        assert_eq!(found.crossovers.len(), expected.len(), "{}", reference.name);
        for (crossover, expected) in found.crossovers.iter().zip(expected) {
            let off =
                libm::remainder(crossover.phase_margin_rad - expected.im, core::f64::consts::TAU);
            assert!(off.abs() < ALLOWED, "{} {crossover:?} {expected}", reference.name);
            assert!((crossover.omega_rad_s / expected.re - 1.0).abs() < ALLOWED, "{expected}");
            let lag = crossover.delay_s * crossover.omega_rad_s;
            let off = libm::remainder(lag - expected.im, core::f64::consts::TAU);
            assert!(
                lag > 0.0 && off.abs() < ALLOWED,
                "{} {crossover:?} {expected}",
                reference.name
            );
        }
        reference.assert_near(found.delay_margin_s.as_slice(), 10);
    }
    Ok(())
}

#[test]
fn peaks_disks_and_bandwidths_are_those_of_the_reference() -> Outcome {
    for reference in Reference::all() {
        let Some(found) = reference.margins()? else { continue };
        let open = &reference.open;
        reference.assert_near(&peak(found.sensitivity_peak), 11);
        reference.assert_near(&peak(found.complementary_peak), 12);
        assert_eq!(found.sensitivity_peak, open.peak_sensitivity()?);
        assert_eq!(found.complementary_peak, open.peak_complementary()?);
        assert!((found.modulus_margin * found.sensitivity_peak.value - 1.0).abs() < 1e-15);
        reference.assert_near(&[found.disk.size, found.disk.omega_rad_s], 13);
        assert_eq!(found.disk, open.disk_margin(0.0)?);
        reference.assert_near(&[open.disk_margin(0.5)?.size], 14);
        reference.assert_near(&[open.disk_margin(-1.0)?.size], 15);
        reference.assert_near(open.bandwidth_rad_s().as_slice(), 16);
    }
    Ok(())
}

#[test]
fn poles_zeros_and_real_values_are_those_of_the_reference() -> Outcome {
    for reference in Reference::all() {
        let (open, name) = (&reference.open, reference.name);
        reference.assert_near(&open.real_crossings()?, 17);
        let poles = complex_numbers(reference.fields[18]);
        let worst = worst_distance(&open.closed_poles()?, &poles);
        assert!(worst < ALLOWED, "{name}: a pole is off by {worst}");
        let allowed = if name == DOUBLE_ZERO { ALLOWED_DOUBLE_ZERO } else { ALLOWED_ZERO };
        let worst = worst_distance(&open.zeros()?, &complex_numbers(reference.fields[19]));
        assert!(worst < allowed, "{name}: a zero is off by {worst}");
    }
    Ok(())
}

/// Largest distance between two sets, each element matched with the nearest one left over; relative beyond the circle.
fn worst_distance(found: &[Complex], expected: &[Complex]) -> f64 {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    let mut rest = found.to_vec();
    let mut worst: f64 = 0.0;
    for &value in expected {
        let distance = |candidate: Complex| modulus(candidate - value);
        let nearest =
            (0..rest.len()).min_by(|&i, &j| distance(rest[i]).total_cmp(&distance(rest[j])));
        let nearest = rest.swap_remove(nearest.expect("the sets are equally large"));
        worst = worst.max(distance(nearest) / modulus(value).max(1.0));
    }
    worst
}
