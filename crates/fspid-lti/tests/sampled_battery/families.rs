//! Random loops of several kinds.

use crate::sampled_battery::factored::{FactorSection, Factored, zeta};
use crate::support::Random;
use fspid_lti::modulus;

pub(crate) fn random_loop(kind: usize, random: &mut Random) -> Factored {
    match kind {
        0 => aircraft(random),
        1 => anywhere(random),
        2 => lightly_damped(random),
        3 => integrators(random),
        4 => delayed(random),
        _ => unstable(random),
    }
}

fn whole(random: &mut Random, low: usize, beyond: usize) -> usize {
    random.uniform(low as f64, beyond as f64) as usize
}

/// Between two ends, evenly in the logarithm.
fn spread(random: &mut Random, low: f64, high: f64) -> f64 {
    low * libm::exp(random.uniform(0.0, libm::log(high / low)))
}

fn chance(random: &mut Random, share: f64) -> bool {
    random.uniform(0.0, 1.0) < share
}

/// 1/(ζ − root), or (ζ − zero)/(ζ − root); both roots as distances from z = 1.
fn real(root: f64, zero: Option<f64>) -> FactorSection {
    let numerator = zero.map_or([1.0, 0.0, 0.0], |zero| [-zero, 1.0, 0.0]);
    FactorSection::new(numerator, [-root, 1.0, 0.0], 1)
}

/// Coefficients of a pair of roots of a size and a damping ratio about z = 1, as a sampled mode has them:
/// ζ² − 2 (r cos φ − 1) ζ + (r² − 2 r cos φ + 1).
fn pair(radius: f64, angle_rad: f64) -> [f64; 3] {
    let (sin, cos) = libm::sincos(angle_rad);
    let (re, im) = (radius * cos - 1.0, radius * sin);
    [re * re + im * im, -2.0 * re, 1.0]
}

/// A pair of poles with no zeros, one, or two.
fn resonance(random: &mut Random, pole: [f64; 3], numerator: [f64; 3]) -> FactorSection {
    let numerator = match whole(random, 0, 3) {
        0 => [1.0, 0.0, 0.0],
        1 => [random.uniform(0.0, 1.0) * pole[0].sqrt(), 1.0, 0.0],
        _ => numerator,
    };
    FactorSection::new(numerator, pole, 2)
}

/// Gain chosen so that |L| is near 1 at a frequency within the band of the modes.
fn with_gain(mut open: Factored, angle_rad: f64, random: &mut Random) -> Factored {
    // No zeros at all in the last section, so that nothing passes at once.
    let last = open.sections.len() - 1;
    let section = &mut open.sections[last];
    section.numerator = [1.0, 0.0, 0.0];
    let value = open.at(zeta(angle_rad));
    let size = modulus(value.over) / modulus(value.under);
    let sign = if chance(random, 0.1) { -1.0 } else { 1.0 };
    open.gain = if size > 0.0 { sign * random.uniform(0.3, 1.2) / size } else { 0.1 };
    open
}

fn open(sections: Vec<FactorSection>, delay: usize, dt_s: f64) -> Factored {
    Factored { sections, gain: 1.0, delay, dt_s }
}

/// Slow and fast modes sampled quickly, a servo, perhaps an integrator, a few samples of delay.
fn aircraft(random: &mut Random) -> Factored {
    let dt_s = spread(random, 1e-3, 1e-1);
    let mut sections = vec![];
    for _ in 0..whole(random, 1, 3) {
        let (omega, damping) = (spread(random, 0.05, 10.0), spread(random, 0.02, 0.9));
        let radius = libm::exp(-damping * omega * dt_s);
        let pole = pair(radius, omega * dt_s * (1.0 - damping * damping).sqrt());
        let zero = spread(random, 0.05, 10.0) * dt_s;
        sections.push(resonance(random, pole, [zero * zero, zero, 1.0]));
    }
    if chance(random, 0.5) {
        sections.push(real(0.0, Some(libm::expm1(-spread(random, 0.05, 2.0) * dt_s))));
    }
    sections.push(real(libm::expm1(-spread(random, 2.0, 30.0) * dt_s), None));
    let delay = whole(random, 0, 5);
    let crossover = spread(random, 0.1, 8.0) * dt_s;
    with_gain(open(sections, delay, dt_s), crossover.min(3.0), random)
}

/// Poles and zeros anywhere in and around the unit circle.
fn anywhere(random: &mut Random) -> Factored {
    let mut sections = vec![];
    for _ in 0..whole(random, 0, 4) {
        let pole = pair(random.uniform(0.0, 1.0), random.uniform(0.1, 3.0));
        let zero = pair(random.uniform(0.0, 1.3), random.uniform(0.1, 3.0));
        sections.push(resonance(random, pole, zero));
    }
    for _ in 0..whole(random, 1, 4) {
        let zero = chance(random, 0.5).then(|| random.uniform(-2.2, 0.2));
        sections.push(real(random.uniform(-1.95, -0.01), zero));
    }
    let crossover = random.uniform(0.1, 3.1);
    with_gain(open(sections, 0, 1.0), crossover, random)
}

/// Narrow resonances that cross the gain of 1 several times.
fn lightly_damped(random: &mut Random) -> Factored {
    let mut sections = vec![];
    for _ in 0..whole(random, 1, 4) {
        let angle_rad = spread(random, 0.02, 2.8);
        let pole = pair(1.0 - spread(random, 1e-5, 1e-2), angle_rad);
        let zero = pair(1.0 - spread(random, 1e-4, 1e-1), angle_rad * random.uniform(0.8, 1.25));
        sections.push(resonance(random, pole, zero));
    }
    sections.push(real(-random.uniform(0.01, 0.9), None));
    let crossover = spread(random, 0.02, 2.8);
    with_gain(open(sections, whole(random, 0, 2), 0.02), crossover, random)
}

/// Two or three integrators with leads: stable between two gains, if at all.
fn integrators(random: &mut Random) -> Factored {
    let dt_s = spread(random, 1e-2, 1.0);
    let crossover = random.uniform(0.05, 0.8);
    let mut sections = vec![];
    for _ in 0..whole(random, 1, 3) {
        sections.push(real(0.0, Some(-crossover * random.uniform(0.1, 0.6))));
    }
    sections.push(real(0.0, None));
    if chance(random, 0.5) {
        sections.push(real(-random.uniform(0.3, 1.0), None));
    }
    with_gain(open(sections, whole(random, 0, 2), dt_s), crossover, random)
}

/// A slow plant behind many samples of dead time.
fn delayed(random: &mut Random) -> Factored {
    let delay = whole(random, 3, 21);
    let slow = spread(random, 0.05, 2.0) / delay as f64;
    let mut sections = vec![real(-slow, None)];
    if chance(random, 0.5) {
        sections.insert(0, real(0.0, Some(-slow * random.uniform(0.3, 2.0))));
    }
    if chance(random, 0.3) {
        let pole = pair(1.0 - spread(random, 1e-3, 1e-1), random.uniform(0.1, 2.0));
        sections.insert(0, FactorSection::new([1.0, 0.0, 0.0], pole, 2));
    }
    let crossover = random.uniform(0.05, 2.0) / delay as f64;
    with_gain(open(sections, delay, 0.01), crossover, random)
}

/// One pole or a pair outside the circle, to be held by feedback.
fn unstable(random: &mut Random) -> Factored {
    let growth = spread(random, 1e-3, 0.2);
    let mut sections = vec![];
    if chance(random, 0.4) {
        let angle_rad = random.uniform(0.3, 2.0) * growth;
        let pole = pair(1.0 + 0.3 * growth, angle_rad);
        sections.push(FactorSection::new([growth * random.uniform(0.2, 2.0), 1.0, 0.0], pole, 2));
    } else {
        sections.push(real(growth, Some(-growth * random.uniform(0.1, 3.0))));
    }
    if chance(random, 0.5) {
        sections.push(real(-random.uniform(0.2, 1.0), None));
    } else {
        sections.push(real(0.0, None));
    }
    let crossover = growth * random.uniform(1.5, 8.0);
    with_gain(open(sections, whole(random, 0, 2), 0.05), crossover.min(2.5), random)
}
