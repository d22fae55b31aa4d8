//! Samples that no sensor should show, through every structure of controller, and what must hold whatever they are.
//!
//! What is held against a controller stands in [`Found`]; every count but those of samples must stay 0.

use fspid_core::{Controller, Faults, Sample, State};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::{Conclusions, DT_S, Structure, TunerStructure, controller};
use fspid_core::fuzzy::{Defuzzifier, OutOfRange};
use fspid_core::{AntiWindup, IntegralForm, Law, Limits, ReferenceModel, SecondInput};

/// Samples that one controller sees before another is drawn.
const A_CONTROLLER: u64 = 2_000;
/// Good samples lie within this, rad and rad/s, and with that within every guard that is drawn: a good one is answered,
/// whatever came before.
const GOOD_RAD: f64 = 0.45;
/// Faults that hold the command.
const HELD: [Faults; 3] = [Faults::NOT_FINITE, Faults::IMPLAUSIBLE, Faults::OVERFLOW];
/// Rounding of a command that the slew limit has cut.
const ROUNDING: f64 = 1e-12;

/// What came of so many samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Controllers that were drawn.
    pub controllers: u64,
    /// Samples that they saw.
    pub samples: u64,
    /// Samples that they held.
    pub held: u64,
    /// Commands that are not finite.
    pub not_finite: u64,
    /// Held samples that changed the command or anything that is remembered.
    pub remembered: u64,
    /// Good samples after a bad one that were not answered at once.
    pub late: u64,
    /// Commands beyond the limits.
    pub beyond: u64,
    /// Commands that moved by more than the slew limit allows in a sample.
    pub jumped: u64,
}

impl Found {
    /// True where nothing was found.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        [self.not_finite, self.remembered, self.late, self.beyond, self.jumped] == [0; 5]
    }

    fn add(&mut self, other: Self) {
        let Self { controllers, samples, held, not_finite, remembered, late, beyond, jumped } =
            other;
        self.controllers += controllers;
        self.samples += samples;
        self.held += held;
        self.not_finite += not_finite;
        self.remembered += remembered;
        self.late += late;
        self.beyond += beyond;
        self.jumped += jumped;
    }
}

/// Every structure that a controller can have: each option that is a kind and no number.
#[must_use]
pub fn structures() -> Vec<Structure> {
    let limits = Limits::new(fspid_core::ControllerSetting::OutputLimits, -0.3, 0.3).ok();
    let clamping = limits.map(AntiWindup::Clamping);
    let kinds = [
        Some(AntiWindup::None),
        clamping,
        Some(AntiWindup::Conditional),
        Some(AntiWindup::BackCalculation { tracking_s: 0.5 }),
    ];
    let tuners: Vec<Option<TunerStructure>> =
        core::iter::once(None).chain(tuners().into_iter().map(Some)).collect();
    let mut all = Vec::new();
    for integral in [IntegralForm::Bumpless, IntegralForm::Literal] {
        for anti_windup in kinds.into_iter().flatten() {
            for feeds_forward in [false, true] {
                all.extend(tuners.iter().map(|&tuner| Structure {
                    integral,
                    anti_windup,
                    feeds_forward,
                    tuner,
                }));
            }
        }
    }
    all
}

fn tuners() -> Vec<TunerStructure> {
    let model = ReferenceModel { bandwidth_rad_s: 1.0, damping: 0.8 };
    let mut all = Vec::new();
    for second_input in [SecondInput::Change, SecondInput::Rate, SecondInput::ModelError(model)] {
        for law in [Law::Memoryless, Law::Accumulating { leakage_per_s: 0.1 }] {
            for (conclusions, defuzzifier) in [
                (Conclusions::Labels, Defuzzifier::Exact),
                (Conclusions::Labels, Defuzzifier::Endpoints(101)),
                (Conclusions::Numbers, Defuzzifier::Exact),
                (Conclusions::Network, Defuzzifier::Exact),
            ] {
                all.extend(OutOfRange::ALL.map(|out_of_range| TunerStructure {
                    second_input,
                    law,
                    conclusions,
                    defuzzifier,
                    out_of_range,
                }));
            }
        }
    }
    all
}

/// As many samples as are asked, or some more: every structure sees as many.
#[must_use]
pub fn attack(seed: u64, samples: u64) -> Found {
    let structures = structures();
    let mut found = Found::default();
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let random = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config::default(), random);
    let each = (samples / structures.len() as u64).clamp(1, A_CONTROLLER);
    let mut round = 0;
    while found.samples < samples {
        for (place, structure) in structures.iter().enumerate() {
            let Ok(drawn) = controller(*structure).new_tree(&mut runner) else { continue };
            let seed = seed ^ ((round * structures.len() + place) as u64).wrapping_mul(MIXED);
            found.add(one(&drawn.current(), seed, each));
        }
        round += 1;
    }
    found
}

/// Spreads the numbers of a counter: splitmix64.
const MIXED: u64 = 0x9e37_79b9_7f4a_7c15;

struct Drawn(u64);

impl Drawn {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(MIXED);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ bits >> 31
    }

    fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        values[(self.bits() % values.len() as u64) as usize]
    }

    /// Between -1 and 1.
    fn number(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn good(&mut self) -> Sample<f64> {
        Sample {
            setpoint_rad: GOOD_RAD * self.number(),
            measurement_rad: GOOD_RAD * self.number(),
            rate_rad_s: GOOD_RAD * self.number(),
        }
    }

    /// A number that a broken sensor may show, of a controller that believes up to a limit.
    fn bad(&mut self, limit: f64) -> f64 {
        let special = [
            f64::NAN,
            -f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            3e38,
            -3e38,
            f64::MAX,
            f64::MIN,
            f64::MIN_POSITIVE,
            5e-324,
            -5e-324,
            0.0,
            -0.0,
            limit,
            -limit,
            limit.next_up(),
            limit.next_down(),
            1e-310,
        ];
        match self.bits() % 4 {
            0 => f64::from_bits(self.bits()),
            1 => limit * self.number(),
            _ => self.one_of(&special),
        }
    }

    /// The next sample, after those that were.
    fn next(&mut self, before: &[Sample<f64>], limit: f64) -> (Sample<f64>, bool) {
        let good = self.good();
        match self.bits() % 8 {
            0 | 1 => {
                let mut sample = good;
                let broken = 1 + self.bits() % 7;
                if broken & 1 != 0 {
                    sample.setpoint_rad = self.bad(limit);
                }
                if broken & 2 != 0 {
                    sample.measurement_rad = self.bad(limit);
                }
                if broken & 4 != 0 {
                    sample.rate_rad_s = self.bad(limit);
                }
                (sample, false)
            }
            // Stuck or repeated, and late.
            2 => (before.last().copied().unwrap_or(good), false),
            3 if !before.is_empty() => {
                (before[(self.bits() % before.len() as u64) as usize], false)
            }
            _ => (good, true),
        }
    }
}

/// How many of the last samples may come once more.
const LATE: usize = 16;

fn one(controller: &Controller<f64>, seed: u64, samples: u64) -> Found {
    let mut drawn = Drawn(seed);
    let mut found = Found { controllers: 1, samples, ..Found::default() };
    let limit = controller.config().guard.limit_rad();
    let mut state = State::new();
    let mut before: Vec<Sample<f64>> = Vec::with_capacity(LATE);
    for _ in 0..samples {
        let (sample, is_good) = drawn.next(&before, limit);
        let was = state;
        let step = controller.step(&mut state, sample);
        let faults = state.take_faults();
        let held = HELD.iter().any(|&fault| faults.contains(fault));
        found.held += u64::from(held);
        found.not_finite += u64::from(!step.command_rad.is_finite());
        found.late += u64::from(held && is_good);
        if held {
            found.remembered +=
                u64::from(!is_same(&was, &state) || !is_command(&was, step.command_rad));
        } else {
            let config = controller.config();
            let within = |limits: Limits<f64>| {
                limits.lower() <= step.command_rad && step.command_rad <= limits.upper()
            };
            found.beyond += u64::from(!config.limits.is_none_or(within));
            let moved_rad = (step.command_rad - was.command_rad).abs();
            let slow = |slew: f64| moved_rad <= slew * DT_S * (1.0 + ROUNDING) + ROUNDING;
            found.jumped += u64::from(!config.slew_rad_s.is_none_or(slow));
        }
        if before.len() == LATE {
            before.remove(0);
        }
        before.push(sample);
    }
    found
}

fn is_command(was: &State<f64>, command_rad: f64) -> bool {
    was.command_rad.to_bits() == command_rad.to_bits()
}

/// Whether nothing was remembered of a sample, to the bit.
fn is_same(was: &State<f64>, is: &State<f64>) -> bool {
    let bits = |state: &State<f64>| {
        [state.command_rad, state.integral, state.derivative_rad_s].map(f64::to_bits)
    };
    bits(was) == bits(is) && was.previous == is.previous
}
