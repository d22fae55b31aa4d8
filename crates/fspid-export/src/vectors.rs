//! Drawn samples, good and bad ones, and what a controller answers to them; those of systems are in `systems`.
//!
//! Set-points jump by up to 0.6 rad, the pitch follows with noise. Which of a controller's limits and rules this reaches is
//! not measured here.

use fspid_core::{Controller, Sample, State, Step};
use fspid_numeric::Real;

use crate::Angles;

/// A sample and its answer, in the units of the export.
#[derive(Clone, Debug, PartialEq)]
pub struct Vector<R> {
    /// What goes in: the members of the sample in their order, of a controller always with the rate.
    pub sample: Vec<R>,
    /// The reals that come out, in the order of the answer's members.
    pub answer: Vec<R>,
    /// The truths and bytes that come out, behind the reals: of a controller, whether the command was cut, and its faults.
    pub marks: Vec<u8>,
}

/// What a controller answers to `count` samples that are drawn from a seed, from a reset on.
#[must_use]
pub fn vectors<R: Real>(
    controller: &Controller<R>,
    angles: Angles,
    seed: u64,
    count: usize,
) -> Vec<Vector<R>> {
    let radians = angles.radians().map_or(R::ONE, R::from_f64);
    let per_radian = angles.per_radian().map_or(R::ONE, R::from_f64);
    let mut state = State::new();
    let answered = |sample: Sample<R>| {
        let Sample { setpoint_rad, measurement_rad, rate_rad_s } = sample;
        let given = [setpoint_rad, measurement_rad, rate_rad_s].map(|value| value * per_radian);
        let [setpoint_rad, measurement_rad, rate_rad_s] = given.map(|value| value * radians);
        let sample = Sample { setpoint_rad, measurement_rad, rate_rad_s };
        let Step { command_rad, gains, saturated, faults } = controller.step(&mut state, sample);
        Vector {
            sample: given.to_vec(),
            answer: vec![command_rad * per_radian, gains.kp, gains.ki, gains.kd],
            marks: vec![u8::from(saturated), faults.bits()],
        }
    };
    samples(seed, count).into_iter().map(answered).collect()
}

/// Numbers that are the same in each run.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    /// From 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn around(&mut self, size: f64) -> f64 {
        (2.0 * self.unit() - 1.0) * size
    }

    pub(crate) fn bad(&mut self) -> f64 {
        const BAD: [f64; 8] =
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 3e38, -3e38, 1e30, -0.0, 1e-40];
        BAD[(self.unit() * 8.0) as usize % 8]
    }
}

/// A set-point that jumps, a pitch that follows it with noise, and now and then something that is no pitch.
pub fn samples<R: Real>(seed: u64, count: usize) -> Vec<Sample<R>> {
    let mut draw = Draw(seed);
    let (mut setpoint, mut pitch) = (0.0, 0.0);
    let mut samples = Vec::with_capacity(count);
    for _ in 0..count {
        if draw.unit() < 0.02 {
            setpoint = draw.around(0.6);
        }
        let before = pitch;
        pitch += 0.08 * (setpoint - pitch) + draw.around(0.01);
        let rate = (pitch - before) / 0.01;
        let mut values = [setpoint, pitch, rate];
        if draw.unit() < 0.02 {
            values[(draw.unit() * 3.0) as usize % 3] = draw.bad();
        }
        if draw.unit() < 0.01 {
            values[1] = draw.around(4.0);
        }
        let [setpoint_rad, measurement_rad, rate_rad_s] = values.map(R::from_f64);
        samples.push(Sample { setpoint_rad, measurement_rad, rate_rad_s });
    }
    samples
}
