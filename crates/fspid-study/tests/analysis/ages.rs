//! Margins of loops whose sensors have clocks of their own: what they allow the loop has to bear over all ages as they come.

use fspid_scenario::file::{Study, parse};
use fspid_study::analysis::{AnalysedLoop, Analysis, Frozen, Margins, Question, Stability};
use fspid_study::metrics::Absent;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A structural mode at 24 rad/s behind MEMS sensors in a loop of 50 Hz.
const MODE: &str = include_str!("../data/mode_behind_a_sensor_with_a_clock.toml");

fn study(set: &[String]) -> Study {
    parse(MODE, "mode.toml", None, set).unwrap_or_else(|problems| panic!("{problems}"))
}

fn analysed(set: &[String]) -> AnalysedLoop {
    let mut found = Analysis::of(&study(set), Question::default()).expect("analysed");
    found.loops.remove(0)
}

fn margins(set: &[String]) -> Result<Margins, Absent> {
    analysed(set).plants[0].margins
}

/// The same with all gains so much larger.
fn with_gain(set: &[String], gain_db: f64) -> Vec<String> {
    let factor = libm::pow(10.0, gain_db / 20.0);
    let gains = [("kp", 0.142), ("ki", 0.127), ("kd", 0.037), ("rate_gain", 0.423)];
    let scaled = gains.map(|(key, gain)| format!("controller.C.{key}={:?}", factor * gain));
    set.iter().cloned().chain(scaled).collect()
}

/// PASS at 21 dB, of a loop that 2.5 dB make unstable: margins were those of 2 samples of age, where half a sample lies.
#[test]
fn a_sensor_that_is_read_twice_a_sample_has_the_margins_of_its_true_age() {
    let told = margins(&[]).expect("stable");
    let [_, more_db] = told.gain_margin_db;
    assert!(more_db > 1.5 && more_db < 2.5, "{more_db}");
    assert_eq!(analysed(&with_gain(&[], more_db - 0.1)).stability(), Stability::Stable);
    assert_eq!(analysed(&with_gain(&[], more_db + 0.1)).stability(), Stability::Unstable);
}

/// Margins with the largest age were told of loops that over all their ages bear a tenth of them.
#[test]
fn no_margin_is_told_that_the_ages_as_they_come_do_not_bear() {
    let mut random = ChaCha8Rng::seed_from_u64(81);
    let mut draw = |least: f64, most: f64| {
        least + (most - least) * f64::from(random.next_u32()) / f64::from(u32::MAX)
    };
    let (mut told, mut refused) = (0, 0);
    for _ in 0..60 {
        let thousandths = |value: f64| libm::round(value * 1e3) / 1e3;
        let (pitch_s, rate_s) = (thousandths(draw(0.012, 0.09)), thousandths(draw(0.012, 0.09)));
        let set = [
            format!("sensor.pitch.period_s={pitch_s:?}"),
            format!("sensor.rate.period_s={rate_s:?}"),
            format!("sensor.pitch.delay_s={:?}", thousandths(draw(0.0, 0.04))),
            format!("sensor.rate.delay_s={:?}", thousandths(draw(0.0, 0.04))),
        ];
        match margins(&set) {
            Ok(margins) => {
                for end_db in margins.gain_margin_db {
                    let within_db = 0.95 * end_db.clamp(-40.0, 40.0);
                    let stands = analysed(&with_gain(&set, within_db)).stability();
                    assert_ne!(stands, Stability::Unstable, "{within_db} of {end_db} dB: {set:?}");
                }
                told += 1;
            }
            Err(Absent::AgesAsTheyCome { .. }) => {
                assert_eq!(analysed(&set).stability(), Stability::Stable);
                refused += 1;
            }
            Err(_) => {}
        }
    }
    assert!(told > 5 && refused > 3, "{told}, {refused}");
}

/// A self-tuner around a mode at 50 Hz, behind a sensor that is read every 0.03 s: twelve of its 81 frozen gains are unstable over the ages
/// as they come, and all of them held with the largest. `frozen_stable` was a PASS, and a flight with those gains diverged.
const TUNED: &str = "schema = 1\nname = \"x\"\n[plant]\n\
    numerator = [-1.7864381099092428, 17.864381099092427, 26.84467714000462]\n\
    denominator = [0.0025, 0.017672501692979087, 1.0410050637434138, 3.1102609050776255, 4.126022788599066, 0.0]\n\
    elevator_sign = \"nose-up-positive\"\n[actuator]\ntime_constant_s = 0\ndelay_samples = 1\n\
    [loop]\nsample_period_s = 0.02\nduration_s = 20\n[sensor]\npreset = \"ideal\"\npitch = { period_s = 0.03 }\n\
    [setpoint]\nkind = \"step\"\namplitude_deg = 1.0\n[[controller]]\nname = \"c\"\n";

#[test]
fn frozen_gains_that_the_ages_as_they_come_do_not_bear_do_not_hold() {
    let tuner = "kind = \"fspid\"\nnominal = { kp = 0.348173, ki = 0.282375, kd = 0.261224 }\nderivative_on = \"measurement\"\n\
        supervisor = { table = \"mirrored\", range = 5.0, error_scale = 1.0, change_scale = 0.2, output_scale = { kp = 0.02, ki = 0.004, kd = 0.01 } }\n";
    let of = |controller: &str| {
        let text = format!("{TUNED}{controller}");
        let study =
            parse(&text, "tuned", None, &[]).unwrap_or_else(|problems| panic!("{problems}"));
        Analysis::of(&study, Question::default()).expect("analysed").loops.remove(0)
    };
    let tuned = of(tuner);
    let Some(Frozen::OfInputs(map)) = tuned.plants[0].frozen.as_ref() else { panic!("a map") };
    let unstable = map.unstable();
    assert!((6..=24).contains(&unstable), "{unstable}");
    assert_eq!(map.stability(), Stability::Unstable);
    // Each verdict is that of a controller that has these gains for good.
    for point in map.all().step_by(7).chain([&map.worst]) {
        let [kp, ki, kd] = [point.gains.kp, point.gains.ki, point.gains.kd];
        let fixed = of(&format!(
            "kind = \"pid\"\nkp = {kp:?}\nki = {ki:?}\nkd = {kd:?}\nderivative_on = \"measurement\"\n"
        ));
        assert_eq!(fixed.stability(), point.stability(), "{kp} {ki} {kd}");
    }
}
