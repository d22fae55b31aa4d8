//! The discrete controllers against formulas, and single precision against double.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]
#![allow(
    clippy::disallowed_methods,
    reason = "formulas to compare with, within a tolerance; nothing that flies"
)]

use crate::common;

use std::f64::consts::PI;

use common::{NOMINAL, Random, T, error, fspid, gains, pid};
use fspid_core::{
    Derivative, Gains, InputScale, IntegralForm, Law, PidConfig, State, TunerSettings,
};
use fspid_numeric::Real;

fn config(filter_s: f64) -> PidConfig<f64> {
    PidConfig { derivative: Derivative { filter_s }, ..PidConfig::sampled_every(T) }
}

/// A complex number, as much of one as this needs.
#[derive(Clone, Copy, Debug)]
struct Complex(f64, f64);

impl Complex {
    fn over(self, other: Self) -> Self {
        let size = other.0 * other.0 + other.1 * other.1;
        let (re, im) = (self.0 * other.0 + self.1 * other.1, self.1 * other.0 - self.0 * other.1);
        Self(re / size, im / size)
    }
}

/// $C(z) = k_p + k_i T \frac{z}{z-1} + k_d \frac{z - 1}{(T_f + T) z - T_f}$ at
/// $z = e^{2 \pi j / n}$.
fn transfer_function(n: u32, filter_s: f64) -> Complex {
    let (im, re) = (2.0 * PI / f64::from(n)).sin_cos();
    let integral = Complex(re, im).over(Complex(re - 1.0, im));
    let filter = Complex((filter_s + T) * re - filter_s, (filter_s + T) * im);
    let derivative = Complex(re - 1.0, im).over(filter);
    let Gains { kp, ki, kd } = NOMINAL;
    Complex(kp + ki * T * integral.0 + kd * derivative.0, ki * T * integral.1 + kd * derivative.1)
}

/// The gain and phase of the controller at `n` samples a period, from its answer to a cosine: its
/// Fourier coefficient over one period after the filter's start has died away. The constant that
/// the integral starts with is orthogonal to it.
fn measured(n: u32, filter_s: f64) -> Complex {
    let (controller, mut state) = (pid(NOMINAL, config(filter_s)), State::new());
    let angle = |k: u32| 2.0 * PI * f64::from(k % n) / f64::from(n);
    let mut sum = Complex(0.0, 0.0);
    let settled = 3000 / n * n;
    for k in 0..settled + n {
        let command_rad = controller.step(&mut state, error(angle(k).cos())).command_rad;
        if k >= settled {
            sum.0 += command_rad * angle(k).cos();
            sum.1 -= command_rad * angle(k).sin();
        }
    }
    let scale = 2.0 / f64::from(n);
    Complex(scale * sum.0, scale * sum.1)
}

#[test]
fn the_frequency_response_is_that_of_the_z_transfer_function() {
    for filter_s in [0.0, 0.05, 0.2] {
        for n in [3, 4, 10, 100, 1000] {
            let (ours, theirs) = (measured(n, filter_s), transfer_function(n, filter_s));
            // The slower filter has died away to (20/21)^3000, below 1e-63: what remains is the
            // rounding of a few thousand samples of a number below 200, averaged.
            let distance = (ours.0 - theirs.0).hypot(ours.1 - theirs.1);
            assert!(distance < 1e-12, "{n} samples, Tf {filter_s}: {ours:?} {theirs:?}");
        }
    }
}

/// A pulse at the second sample: the integral keeps ki·T, the filtered derivative answers 1/(Tf+T)
/// and swings back as $-T \rho^{j-1} / (T_f+T)^2$ with $\rho = T_f / (T_f + T)$.
#[test]
fn the_answer_to_a_pulse_is_the_closed_form() {
    let filter_s = 0.05;
    let (controller, mut state) = (pid(NOMINAL, config(filter_s)), State::new());
    let Gains { kp, ki, kd } = NOMINAL;
    let rho = filter_s / (filter_s + T);
    assert_eq!(controller.step(&mut state, error(0.0)).command_rad, 0.0);
    for j in 0..60 {
        let pulse = if j == 0 { 1.0 } else { 0.0 };
        let command_rad = controller.step(&mut state, error(pulse)).command_rad;
        let derivative = match j {
            0 => 1.0 / (filter_s + T),
            _ => -T * rho.powi(j - 1) / (filter_s + T).powi(2),
        };
        let expected = kp * pulse + ki * T + kd * derivative;
        // A few roundings of numbers below 20.
        assert!((command_rad - expected).abs() < 1e-14, "{j}: {command_rad} {expected}");
    }
}

/// $e = k T$ from zero: $u_k = k_p k T + k_i T^2 k (k + 1) / 2 + k_d$.
#[test]
fn the_answer_to_a_ramp_is_the_closed_form() {
    let (controller, mut state) = (pid(NOMINAL, config(0.0)), State::new());
    let Gains { kp, ki, kd } = NOMINAL;
    for k in 0..500_u32 {
        let k = f64::from(k);
        let command_rad = controller.step(&mut state, error(k * T)).command_rad;
        let derivative = if k > 0.0 { kd } else { 0.0 };
        let expected = kp * k * T + ki * T * T * k * (k + 1.0) / 2.0 + derivative;
        // Differences of numbers below 5, each rounded to 9e-16, over T; and 500 additions.
        assert!((command_rad - expected).abs() < 1e-12, "{k}: {command_rad} {expected}");
    }
}

/// The largest difference of the commands of a flight in single and in double precision.
fn distance_of_precisions(law: Option<Law<f64>>) -> f64 {
    fn commands<R: Real>(law: Option<Law<f64>>) -> Vec<f64> {
        let number = R::from_f64;
        let mut config = PidConfig::sampled_every(number(T));
        config.derivative.filter_s = number(0.05);
        config.integral = IntegralForm::Bumpless;
        let settings = TunerSettings {
            input_scale: InputScale { error_per_rad: number(10.0), change_per_rad: number(2.0) },
            output_scale: gains(Gains { kp: 0.2, ki: 0.05, kd: 0.1 }),
            law: match law {
                Some(Law::Accumulating { leakage_per_s }) => {
                    Law::Accumulating { leakage_per_s: number(leakage_per_s) }
                }
                _ => Law::Memoryless,
            },
            ..TunerSettings::literal()
        };
        let (fixed, tuned) = (pid(gains(NOMINAL), config), fspid(settings, config));
        let mut state = State::new();
        let step = |sample| match law {
            None => fixed.step(&mut state, sample),
            Some(_) => tuned.step(&mut state, sample),
        };
        Random(6)
            .samples(1000)
            .into_iter()
            .map(step)
            .map(|step| step.command_rad.to_f64())
            .collect()
    }
    let (single, double) = (commands::<f32>(law), commands::<f64>(law));
    let distances = single.iter().zip(&double).map(|(s, d)| (s - d).abs());
    distances.fold(0.0, f64::max)
}

#[test]
fn single_precision_is_near_double_precision() {
    let unit = f64::from(f32::EPSILON);
    // Set-point, measurement and error, below 0.3, are rounded to an eighth of a unit each; over
    // Tf + T = 0.06 s that is up to 13 units in the derivative, which the filter keeps for six
    // samples, mostly cancelling. The drifting gains and the integral add less.
    let tolerance = 50.0 * unit;
    let leakage_per_s = 0.1;
    for law in [None, Some(Law::Memoryless), Some(Law::Accumulating { leakage_per_s })] {
        let distance = distance_of_precisions(law);
        assert!(distance > 0.0 && distance < tolerance, "{law:?}: {distance:e}");
    }
}
