//! Margins of loops whose sensors have clocks of their own: what they allow the loop has to bear over all ages as they come.

use fspid_scenario::file::{Study, parse};
use fspid_study::analysis::{AnalysedLoop, Analysis, Margins, Question, Stability};
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
