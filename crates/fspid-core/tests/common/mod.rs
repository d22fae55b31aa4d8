//! What several tests need: the shipped rules, samples, and numbers that are random but the same.

#![allow(dead_code, reason = "each test file uses its own part")]

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};
use fspid_core::{Fspid, Gains, Pid, PidConfig, Sample, SelfTuner, State, TunerSettings};
use fspid_numeric::Real;

const PRINTED: &str = include_str!("../../../../data/rule-tables/printed.toml");

/// Sample period of most tests, s.
pub(crate) const T: f64 = 0.01;
pub(crate) const NOMINAL: Gains<f64> = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };

/// The paper's Table 3 as printed: the texts between triple quotes.
pub(crate) fn printed() -> RuleTable {
    let parts: Vec<&str> = PRINTED.split("\"\"\"").collect();
    RuleTable::parse([parts[1], parts[3], parts[5]]).expect("the shipped table")
}

/// The printed rules over [-5, 5].
pub(crate) fn supervisor<R: Real>(out_of_range: OutOfRange) -> Supervisor<R> {
    let range = R::from_f64(5.0);
    Supervisor::new(&printed(), range, Defuzzifier::Exact, out_of_range).expect("allowed")
}

pub(crate) fn tuner<R: Real>(settings: TunerSettings<R>) -> SelfTuner<R> {
    let supervisor = supervisor(OutOfRange::Clamp);
    SelfTuner::new(gains(NOMINAL), supervisor, settings).expect("allowed")
}

/// The same gains in another precision.
pub(crate) fn gains<R: Real>(of: Gains<f64>) -> Gains<R> {
    Gains { kp: R::from_f64(of.kp), ki: R::from_f64(of.ki), kd: R::from_f64(of.kd) }
}

/// A sample of set-point, measurement and rate.
pub(crate) fn sample<R: Real>(setpoint: f64, measurement: f64, rate: f64) -> Sample<R> {
    Sample {
        setpoint_rad: R::from_f64(setpoint),
        measurement_rad: R::from_f64(measurement),
        rate_rad_s: R::from_f64(rate),
    }
}

/// A sample at which the error is `error`.
pub(crate) fn error<R: Real>(error: R) -> Sample<R> {
    Sample { setpoint_rad: error, measurement_rad: R::ZERO, rate_rad_s: R::ZERO }
}

pub(crate) fn pid<R: Real>(gains: Gains<R>, config: PidConfig<R>) -> Pid<R> {
    Pid::new(gains, config).expect("allowed settings")
}

pub(crate) fn fspid<R: Real>(settings: TunerSettings<R>, config: PidConfig<R>) -> Fspid<R> {
    Fspid::new(tuner(settings), config).expect("allowed settings")
}

/// The integral's term of the command that `state` remembers: the answer to a zero error of a
/// controller that has nothing but `ki` and no limits. Works on a copy.
pub(crate) fn integral_term<R: Real>(state: &State<R>, ki: R, config: PidConfig<R>) -> R {
    let mut bare = PidConfig::sampled_every(config.dt_s);
    bare.integral = config.integral;
    let only_ki = Gains { ki, ..Gains::ZERO };
    let mut copy = *state;
    pid(only_ki, bare).step(&mut copy, error(R::ZERO)).command_rad
}

/// SplitMix64 (Steele, Lea and Flood, 2014): the same numbers on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [-1, 1).
    pub(crate) fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A flight without a plant: a set-point that jumps now and then, a measurement and a rate
    /// that wander.
    pub(crate) fn samples<R: Real>(&mut self, count: usize) -> Vec<Sample<R>> {
        let (mut setpoint, mut measurement) = (0.1, 0.0);
        let mut next = |k: usize| {
            if k % 50 == 49 {
                setpoint = 0.2 * self.signed();
            }
            measurement += 0.01 * self.signed();
            sample(setpoint, measurement, self.signed())
        };
        (0..count).map(&mut next).collect()
    }
}
