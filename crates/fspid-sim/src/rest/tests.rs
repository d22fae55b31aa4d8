//! What a held command adds, against the controller that flies: one sample beside rest.

use core::f64::consts::PI;

use fspid_core::{
    Change, ErrorSign, Fspid, GainCoupling, Gains, InputScale, IntegralForm, Law, PidConfig,
    ReferenceModel, Sample, SecondInput, SelfTuner, State, TunerSettings, paper,
};
use fspid_fuzzy::{Defuzzifier, OutOfRange, Supervisor};

use super::{Holding, RestPoint, Side, slopes};

pub(super) const DT_S: f64 = 0.02;
const RANGE: f64 = 5.0;
pub(super) const LEAKAGE_PER_S: f64 = 4.0;
/// Beside rest by so much, in the supervisor's units.
pub(super) const BESIDE: f64 = 1e-6;

/// A linear congruence, for numbers that are the same each time.
pub(super) struct Dice(pub(super) u64);

impl Dice {
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    pub(super) fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        values[(self.between(0.0, values.len() as f64) as usize).min(values.len() - 1)]
    }
}

pub(super) fn supervisor() -> Supervisor<f64> {
    Supervisor::new(&paper::rules(), RANGE, Defuzzifier::Exact, OutOfRange::Clamp).expect("allowed")
}

pub(super) fn controller(dice: &mut Dice) -> Fspid<f64> {
    let model = ReferenceModel { bandwidth_rad_s: 1.5, damping: 0.8 };
    let settings = TunerSettings {
        error_sign: dice
            .one_of(&[ErrorSign::SetpointMinusMeasurement, ErrorSign::MeasurementMinusSetpoint]),
        law: dice.one_of(&[Law::Memoryless, Law::Accumulating { leakage_per_s: LEAKAGE_PER_S }]),
        second_input: dice.one_of(&[
            SecondInput::Change,
            SecondInput::Rate,
            SecondInput::ModelError(model),
        ]),
        change: dice.one_of(&[Change::Rate, Change::Delta]),
        input_scale: InputScale {
            error_per_rad: dice.between(10.0, 60.0),
            change_per_rad: dice.between(5.0, 40.0),
        },
        output_scale: Gains {
            kp: dice.between(-0.3, 0.3),
            ki: dice.between(-0.1, 0.1),
            kd: dice.between(-0.1, 0.1),
        },
        gain_coupling: GainCoupling {
            setpoint_weight: dice.one_of(&[0.0, 0.5]),
            rate_gain: dice.one_of(&[0.0, 2.0]),
        },
        ..TunerSettings::literal()
    };
    let mut config = PidConfig::sampled_every(DT_S);
    config.setpoint_weights.proportional = dice.between(0.0, 1.3);
    config.feedforward = dice.one_of(&[0.0, 0.6, -0.6]);
    config.derivative.filter_s = dice.one_of(&[0.0, 0.05]);
    config.rate_gain_s = 1.5;
    config.integral = dice.one_of(&[IntegralForm::Bumpless, IntegralForm::Literal]);
    let nominal = Gains { kp: 1.2, ki: 0.4, kd: 0.3 };
    let tuner = SelfTuner::new(nominal, supervisor(), settings).expect("allowed");
    Fspid::new(tuner, config).expect("allowed")
}

/// A sample beside rest.
pub(super) struct Moved {
    pub(super) error_rad: f64,
    pub(super) last_error_rad: f64,
    pub(super) rate_off_rad_s: f64,
}

impl Moved {
    /// What the linear loop on a side adds to the command there.
    pub(super) fn command_rad(&self, side: &Side, config: &PidConfig<f64>) -> f64 {
        let Self { error_rad, last_error_rad, rate_off_rad_s } = *self;
        let change_rad = error_rad - last_error_rad;
        let by_derivative = side.gains.kd / (config.derivative.filter_s + DT_S);
        let gathered = side.gathered.map_or(0.0, |it| {
            it.by_error * error_rad + it.by_change * change_rad - it.by_rate * rate_off_rad_s
        });
        (side.gains.kp + side.gains.ki * DT_S + by_derivative) * error_rad
            + side.change_gain * change_rad
            - (config.rate_gain_s + side.rate_gain_s) * rate_off_rad_s
            + gathered
    }
}

#[test]
fn a_held_command_adds_what_the_flown_controller_answers_beside_rest() {
    let mut dice = Dice(14);
    let mut kinks = 0;
    for round in 0..200 {
        let fspid = controller(&mut dice);
        let setpoint_rad = dice.between(-20.0, 20.0) * PI / 180.0;
        let rate_rad_s = dice.one_of(&[0.0, 0.02, -0.03]);
        let at_rest = Sample { setpoint_rad, measurement_rad: setpoint_rad, rate_rad_s };
        let mut state = State::new();
        // The reference model comes to rest.
        for _ in 0..3000 {
            fspid.step(&mut state, at_rest);
        }
        state.integral = match fspid.config().integral {
            IntegralForm::Bumpless => dice.between(-0.2, 0.2),
            IntegralForm::Literal => dice.between(-20.0, 20.0),
        };
        let held_rad = fspid.step(&mut { state }, at_rest).command_rad;
        let holding = held_by(&fspid);
        let leakage_per_s = holding.leakage_per_s;
        let at = RestPoint { setpoint_rad, load_rad: held_rad };
        let rest = holding.with_error(at, rate_rad_s, 0.0);
        kinks += usize::from(rest.sides.len() > 1);

        let [per_error, beside] = holding.seen_per_unit();
        let error_rad = dice.between(-1.0, 1.0) * BESIDE / per_error.abs();
        let second = dice.between(-1.0, 1.0) * BESIDE / beside.abs();
        let (mut last_error_rad, mut rate_off_rad_s, mut second_seen) = (0.0, 0.0, second);
        match fspid.tuner().settings().second_input {
            SecondInput::Change => last_error_rad = error_rad - second,
            SecondInput::Rate => rate_off_rad_s = -second,
            SecondInput::ModelError(_) => second_seen = error_rad,
        }
        let mut before = state;
        if let Some(previous) = &mut before.previous {
            previous.error_rad = last_error_rad;
        }
        let flown = fspid.step(
            &mut before,
            Sample {
                measurement_rad: setpoint_rad - error_rad,
                rate_rad_s: rate_rad_s + rate_off_rad_s,
                ..at_rest
            },
        );
        let direction = slopes::direction([per_error * error_rad, beside * second_seen]);
        let side = rest.sides[rest.of_direction[direction]];
        let config = fspid.config_at(gains_of(&holding, rate_rad_s));
        let moved = Moved { error_rad, last_error_rad, rate_off_rad_s };
        let expected = moved.command_rad(&side, &config);
        assert_eq!(side.gathered.map(|it| it.keeps), leakage_per_s.map(|by| 1.0 - by * DT_S));
        let found = flown.command_rad - held_rad;
        // Values near 1 are known to 10⁻¹⁶, and sides whose slopes differ by 10⁻⁴ are one.
        let allowed = 2e-4 * (side.gains.kp.abs() * error_rad.abs() + expected.abs()) + 2e-13;
        assert!((found - expected).abs() <= allowed, "{round}: {found} {expected} {side:?}");
    }
    assert!(kinks > 50, "{kinks}");
}

/// What a self-tuner holds with everything at zero.
fn held_by(fspid: &Fspid<f64>) -> Holding<'_> {
    let remembers = fspid.tuner().settings().law != Law::Memoryless;
    let leakage_per_s = remembers.then_some(LEAKAGE_PER_S);
    let holding = Holding { fspid, command_per_pitch: 0.0, gains: Gains::ZERO, leakage_per_s };
    Holding { gains: holding.gains_at([0.0; 2]), ..holding }
}

/// With everything at rest, a seen rate included.
fn gains_of(holding: &Holding<'_>, rate_rad_s: f64) -> Gains<f64> {
    holding.gains_at(holding.seen(0.0, rate_rad_s))
}
