//! The same bits on every machine, at every optimisation level.
//!
//! The digests are not accuracies: they change with any change of an algorithm, and only then. Whoever changes one says
//! so under "Numbers" in the changelog. A digest that differs between two machines is a defect.

use crate::support;

use fspid_lti::{
    Complex, LtiError, Mode, Polynomial, SampledLoop, Stability, continuous_pole, eigenvalues,
    zero_order_hold,
};
use support::{matrix, numbers, rows};

/// Fowler, Noll and Vo's hash of the bits of all numbers (FNV-1a, 64 bits).
struct Digest(u64);

impl Digest {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn add_all(&mut self, values: &[Complex]) {
        values
            .iter()
            .for_each(|value| [value.re, value.im].into_iter().for_each(|part| self.add(part)));
    }
}

#[test]
fn roots_and_modes_have_the_same_bits_everywhere() -> Result<(), LtiError> {
    let mut digest = Digest::new();
    for row in rows(include_str!("data/roots.csv")) {
        let roots = Polynomial::new(&numbers(row[1]))?.roots()?;
        digest.add_all(&roots);
        for root in roots {
            let mode = Mode::of_pole(root)?;
            digest.add(mode.natural_frequency_rad_s);
            digest.add(mode.damping_ratio);
            digest.add_all(&[continuous_pole(root, 0.02)?]);
        }
    }
    assert_eq!(digest.0, 0x1ca4_28b4_1946_76a0, "{:#x}", digest.0);
    Ok(())
}

#[test]
fn eigenvalues_have_the_same_bits_everywhere() -> Result<(), LtiError> {
    let mut digest = Digest::new();
    for row in rows(include_str!("data/eigenvalues.csv")) {
        digest.add_all(&eigenvalues(&matrix(row[1].parse().expect("a number"), &numbers(row[2])))?);
    }
    assert_eq!(digest.0, 0xb91d_6e11_8c6d_a99f, "{:#x}", digest.0);
    Ok(())
}

#[test]
fn sampled_systems_have_the_same_bits_everywhere() -> Result<(), LtiError> {
    let mut digest = Digest::new();
    for row in rows(include_str!("data/sampled.csv")) {
        let states = row[1].parse().expect("a number");
        let (a, b) = (matrix(states, &numbers(row[3])), matrix(states, &numbers(row[4])));
        let (a, b) = zero_order_hold(&a, &b, numbers(row[2])[0])?;
        a.data().iter().chain(b.data()).for_each(|&value| digest.add(value));
    }
    assert_eq!(digest.0, 0x632e_bc02_4719_ff38, "{:#x}", digest.0);
    Ok(())
}

#[test]
fn margins_of_sampled_loops_have_the_same_bits_everywhere() -> Result<(), LtiError> {
    let mut digest = Digest::new();
    for row in rows(include_str!("data/margins.csv")) {
        let b = numbers(row[3]);
        let a = matrix(b.len(), &numbers(row[2]));
        let open = SampledLoop::new(a, b, numbers(row[4]), numbers(row[1])[0])?;
        digest.add_all(&open.zeros()?);
        open.real_crossings()?.into_iter().for_each(|omega| digest.add(omega));
        match open.margins()? {
            Stability::Unstable { poles, .. } => digest.add_all(&poles),
            Stability::Stable(found) => {
                let limits = [found.gain_low, found.gain_high].into_iter().flatten();
                limits.for_each(|limit| digest.add(limit.factor));
                found.crossovers.iter().for_each(|at| digest.add(at.phase_margin_rad));
                for peak in [found.sensitivity_peak, found.complementary_peak] {
                    digest.add(peak.value);
                    digest.add(peak.omega_rad_s);
                }
                digest.add(found.disk.size);
                digest.add(found.spectral_radius);
            }
        }
    }
    assert_eq!(digest.0, 0xdfc6_ea82_25f1_f9ea, "{:#x}", digest.0);
    Ok(())
}
