//! One bad sample, shown to `fspid-core` and to other PID controllers in Rust, each with the same gains, period and limits.
//!
//! A controller flies a servo-like plant beside a twin that sees every sample as it is. One measurement of the first is spoiled. What
//! is told: whether its commands stay finite, after how many samples they are again, how far the command of the spoiled sample is
//! from that of the sample before, and how far the two are apart two seconds later.

use std::process::ExitCode;
use std::time::Duration;

use discrete_pid::pid::{FuncPidController, PidConfigBuilder, PidContext};
use discrete_pid::time::SecondsF64;
use fspid_core::{
    AntiWindup, ControllerSetting, Gains, Limits, Pid as Fspid, PidConfig, Sample, State,
};
use oxictl::core::signal::{Feedback, Setpoint};
use oxictl::core::traits::Controller as _;

/// Sample period, s.
const DT_S: f64 = 0.02;
/// Gains of all: of the error, its integral a second, its derivative times a second.
const GAINS: [f64; 3] = [1.0, 0.4, 0.2];
/// Limit of the command of all, rad.
const LIMIT_RAD: f64 = 0.35;
/// Lag of the derivative where a controller has one, s.
const LAG_S: f64 = 0.02;
/// Set-point of the flights, rad.
const SETPOINT_RAD: f64 = 0.1;
/// Samples before the spoiled one, at most, and after it.
const BEFORE: u64 = 400;
const AFTER: usize = 100;
/// Flights of each kind of bad sample.
const FLIGHTS: u64 = 2_000;

/// Something that answers samples.
trait Flies {
    fn step(&mut self, measurement_rad: f64, rate_rad_s: f64) -> f64;
}

struct Ours {
    controller: Fspid<f64>,
    state: State<f64>,
}

impl Flies for Ours {
    fn step(&mut self, measurement_rad: f64, rate_rad_s: f64) -> f64 {
        let sample = Sample { setpoint_rad: SETPOINT_RAD, measurement_rad, rate_rad_s };
        self.controller.step(&mut self.state, sample).command_rad
    }
}

impl Flies for pid::Pid<f64> {
    fn step(&mut self, measurement_rad: f64, _: f64) -> f64 {
        self.next_control_output(measurement_rad).output
    }
}

struct DiscretePid {
    controller: FuncPidController<f64>,
    context: PidContext<SecondsF64, f64>,
    time_s: f64,
}

impl Flies for DiscretePid {
    fn step(&mut self, measurement_rad: f64, _: f64) -> f64 {
        self.time_s += DT_S;
        let now = SecondsF64(self.time_s);
        let (command, context) =
            self.controller.compute(self.context, measurement_rad, SETPOINT_RAD, now, None);
        self.context = context;
        command
    }
}

struct Oxictl(oxictl::pid::Pid<f64>);

impl Flies for Oxictl {
    fn step(&mut self, measurement_rad: f64, _: f64) -> f64 {
        self.0.update(&Setpoint::new(SETPOINT_RAD), &Feedback::new(measurement_rad), DT_S).value()
    }
}

const NAMES: [&str; 4] = ["fspid-core", "pid 4.0.0", "discrete_pid 0.3.0", "oxictl 0.1.1"];

fn new(name: &str) -> Box<dyn Flies> {
    let [kp, ki, kd] = GAINS;
    match name {
        "fspid-core" => {
            let limits = Limits::new(ControllerSetting::OutputLimits, -LIMIT_RAD, LIMIT_RAD);
            let config = PidConfig {
                limits: Some(limits.expect("a range")),
                anti_windup: AntiWindup::Conditional,
                ..PidConfig::sampled_every(DT_S)
            };
            let controller = Fspid::new(Gains { kp, ki, kd }, config).expect("a controller");
            Box::new(Ours { controller, state: State::new() })
        }
        "pid 4.0.0" => {
            // Its integral and derivative are per sample.
            let mut controller = pid::Pid::new(SETPOINT_RAD, LIMIT_RAD);
            controller.p(kp, LIMIT_RAD).i(ki * DT_S, LIMIT_RAD).d(kd / DT_S, LIMIT_RAD);
            Box::new(controller)
        }
        "discrete_pid 0.3.0" => {
            let config = PidConfigBuilder::default()
                .kp(kp)
                .ki(ki)
                .kd(kd)
                .filter_tc(LAG_S)
                .sample_time(Duration::from_secs_f64(DT_S))
                .output_limits(-LIMIT_RAD, LIMIT_RAD)
                .use_derivative_on_measurement(true)
                .build();
            Box::new(DiscretePid {
                controller: FuncPidController::new(config.expect("a controller")),
                context: PidContext::new_uninit(),
                time_s: 0.0,
            })
        }
        _ => {
            let controller = oxictl::pid::PidConfig::pid(kp, ki, kd);
            Box::new(Oxictl(controller.with_limits(-LIMIT_RAD, LIMIT_RAD).build()))
        }
    }
}

/// What is wrong with a sample.
const KINDS: [(&str, fn(f64) -> f64); 7] = [
    ("NaN", |_| f64::NAN),
    ("infinity", |_| f64::INFINITY),
    ("1.8e308", |_| f64::MAX),
    ("3e38", |_| 3e38),
    ("the sign bit flipped", |shown| -shown),
    ("the top bit of the exponent flipped", |shown| f64::from_bits(shown.to_bits() ^ 1 << 62)),
    ("denormal", |_| 5e-324),
];

/// An integrator of rate with some lag: enough that loops settle and commands matter.
struct Plant {
    pitch_rad: f64,
    rate_rad_s: f64,
}

impl Plant {
    fn fly(&mut self, command_rad: f64) {
        self.rate_rad_s += DT_S * (2.0 * command_rad - 1.5 * self.rate_rad_s);
        self.pitch_rad += DT_S * self.rate_rad_s;
    }
}

/// Of one controller and one kind of bad sample, the worst of all flights.
#[derive(Default)]
struct Worst {
    not_finite: u64,
    /// Flights in which no later command was finite.
    dead: u64,
    jump_rad: f64,
    apart_rad: f64,
}

impl Worst {
    /// The plant flies by the twin, so that both see the same samples but one.
    fn flight(&mut self, name: &str, spoil: fn(f64) -> f64, before: u64) {
        let (mut twin, mut hurt) = (new(name), new(name));
        let mut plant = Plant { pitch_rad: 0.0, rate_rad_s: 0.0 };
        let mut last_rad = 0.0;
        for _ in 0..before {
            let command_rad = twin.step(plant.pitch_rad, plant.rate_rad_s);
            last_rad = hurt.step(plant.pitch_rad, plant.rate_rad_s);
            plant.fly(command_rad);
        }
        let twins_rad = twin.step(plant.pitch_rad, plant.rate_rad_s);
        let hurt_rad = hurt.step(spoil(plant.pitch_rad), plant.rate_rad_s);
        plant.fly(twins_rad);
        self.not_finite += u64::from(!hurt_rad.is_finite());
        if hurt_rad.is_finite() {
            self.jump_rad = self.jump_rad.max((hurt_rad - last_rad).abs());
        }
        let (mut finite, mut apart_rad) = (0, 0.0);
        for _ in 0..AFTER {
            let command_rad = twin.step(plant.pitch_rad, plant.rate_rad_s);
            let hurt_rad = hurt.step(plant.pitch_rad, plant.rate_rad_s);
            finite += usize::from(hurt_rad.is_finite());
            self.not_finite += u64::from(!hurt_rad.is_finite());
            apart_rad = (hurt_rad - command_rad).abs();
            plant.fly(command_rad);
        }
        self.dead += u64::from(finite == 0);
        if finite > 0 {
            self.apart_rad = self.apart_rad.max(apart_rad);
        }
    }
}

fn main() -> ExitCode {
    println!(
        "| one bad measurement | controller | commands that are no number | never again one | largest jump at it, deg | apart after {AFTER} samples, deg |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: |");
    let mut is_clean = true;
    for (kind, spoil) in KINDS {
        for name in NAMES {
            let mut worst = Worst::default();
            for flight in 0..FLIGHTS {
                worst.flight(name, spoil, 1 + flight % BEFORE);
            }
            println!(
                "| {kind} | {name} | {} of {} | {} of {FLIGHTS} flights | {:.2} | {} |",
                worst.not_finite,
                FLIGHTS * (AFTER as u64 + 1),
                worst.dead,
                worst.jump_rad.to_degrees(),
                if worst.dead == FLIGHTS {
                    "no number".into()
                } else {
                    format!("{:.4}", worst.apart_rad.to_degrees())
                },
            );
            is_clean &= name != NAMES[0] || worst.not_finite == 0;
        }
    }
    if is_clean { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
