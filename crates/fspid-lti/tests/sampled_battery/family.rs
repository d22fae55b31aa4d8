//! Loops of a family by the quick way and by the careful one.

use crate::sampled_battery::Outcome;
use crate::sampled_battery::factored::{FactorSection, Factored};
use crate::sampled_battery::families::random_loop;
use crate::support::Random;
use fspid_lti::{
    Complex, LoopFamily, LtiError, Matrix, SampledLoop, SampledMargins, SeriesControl, Stability,
};

/// Plants of each kind, and gains of each plant.
const PLANTS: usize = 60;
const GAINS: usize = 8;
/// Largest relative difference of a margin. Most agree to 10⁻⁸; in slow loops the careful way itself loses
/// digits at low frequency, where sums of errors are states at its output.
const ALLOWED: f64 = 1e-4;
/// In rad per sample; a little more, since both ways know it to some digits.
const SLOW: f64 = 1.1e-6;
/// The quick way answers where the disk margin is not below this one.
const SMALL_DISK: f64 = 0.1;
/// How far beyond the limit of stability the quick way is asked: further than the limit is known.
const BESIDE: [f64; 3] = [1e-2, 1e-3, 2e-4];

/// A random plant behind a PID controller that sums errors and takes their difference.
struct Tuned {
    plant: Factored,
}

impl Tuned {
    fn family(&self) -> Result<LoopFamily, LtiError> {
        let (rows, b, c) = self.plant.parts();
        let by_gain = vec![vec![1.0], vec![1.0, 1.0, 1.0], vec![1.0, -1.0]];
        let control = SeriesControl::new(vec![-1.0, 0.0], by_gain)?;
        let a = Matrix::from_rows(&rows)?;
        LoopFamily::new(&a, &b, [&vec![0.0; b.len()], &c], control, self.plant.dt_s)
    }

    /// The loop with some gains: the controller as one more section, kp + ki (1 + ζ)/ζ + kd ζ/(1 + ζ).
    fn in_series(&self, [kp, ki, kd]: [f64; 3]) -> SampledLoop {
        let mut open = self.plant.clone();
        let lead = kp + ki + kd;
        open.gain *= lead;
        let numerator = [ki / lead, (kp + 2.0 * ki) / lead, 1.0];
        open.sections.insert(0, FactorSection::new(numerator, [0.0, 1.0, 1.0], 2));
        open.realised()
    }
}

fn random_gains(random: &mut Random) -> [f64; 3] {
    let kp = random.uniform(0.1, 2.0);
    let [ki, kd] =
        [(-9.0, -1.0), (-3.0, 3.0)].map(|(low, high)| kp * libm::exp(random.uniform(low, high)));
    [kp, ki, kd]
}

/// Whether a mode of the loop is one of those that the quick way leaves to the careful one.
fn is_slow(open: &SampledLoop) -> Result<bool, LtiError> {
    let distance = |pole: &Complex| fspid_lti::modulus(*pole - 1.0);
    Ok(open.closed_poles()?.iter().any(|pole| distance(pole) < SLOW))
}

/// How many loops were stable with a disk margin that is not small, and how many of them got an answer.
#[derive(Default)]
struct Tally {
    pairs: usize,
    fit: usize,
    answered: usize,
    /// By how much a peak was lower, or a disk larger, than in full, at most.
    better: f64,
}

impl Tally {
    /// No loop may be answered that is not stable, and no answer may differ.
    fn compare(
        &mut self,
        quick: Option<SampledMargins>,
        careful: &Stability,
        slow: bool,
        what: &dyn Fn() -> String,
    ) {
        self.pairs += 1;
        let fits =
            !slow && matches!(careful, Stability::Stable(found) if found.disk.size >= SMALL_DISK);
        self.fit += usize::from(fits);
        let Some(quick) = quick else { return };
        let Stability::Stable(careful) = careful else {
            panic!("called stable: {}: {careful:?}", what());
        };
        self.answered += usize::from(fits);
        // The quick way must not promise more than the careful one.
        let better = [
            careful.sensitivity_peak.value / quick.sensitivity_peak.value,
            careful.complementary_peak.value / quick.complementary_peak.value,
            quick.disk.size / careful.disk.size,
        ];
        self.better = better.into_iter().map(|share| share - 1.0).fold(self.better, f64::max);
        for ((name, quick), (_, careful)) in numbers(&quick).into_iter().zip(numbers(careful)) {
            let infinite = quick.is_infinite() && careful.is_infinite();
            let same = infinite || (quick - careful).abs() <= ALLOWED * careful.abs();
            assert!(same, "{}: {name} {quick} instead of {careful}", what());
        }
    }
}

fn numbers(found: &SampledMargins) -> [(&'static str, f64); 10] {
    let or_infinite = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
    let phase = |of: fn(&fspid_lti::SampledCrossover) -> f64| {
        or_infinite(found.phase_margin.as_ref().map(of))
    };
    [
        ("gain low", or_infinite(found.gain_low.map(|limit| limit.factor))),
        ("gain high", or_infinite(found.gain_high.map(|limit| limit.factor))),
        ("limit", or_infinite(found.gain_high.map(|limit| limit.omega_rad_s))),
        ("crossovers", found.crossovers.len() as f64),
        ("phase", phase(|crossover| crossover.phase_margin_rad)),
        ("crossover", phase(|crossover| crossover.omega_rad_s)),
        ("delay", or_infinite(found.delay_margin_s)),
        ("disk", found.disk.size),
        ("Ms", found.sensitivity_peak.value),
        ("Mt", found.complementary_peak.value),
    ]
}

/// Every pair of a random plant and random gains.
fn pairs(mut look: impl FnMut(&LoopFamily, &Tuned, [f64; 3]) -> Outcome) -> Outcome {
    for kind in 0..6 {
        let mut random = Random(100 + kind as u64);
        for _ in 0..PLANTS {
            let tuned = Tuned { plant: random_loop(kind, &mut random) };
            let family = tuned.family()?;
            for _ in 0..GAINS {
                look(&family, &tuned, random_gains(&mut random))?;
            }
        }
    }
    Ok(())
}

#[test]
fn the_quick_way_answers_as_the_careful_one_and_no_unstable_loop() -> Outcome {
    let mut tally = Tally::default();
    pairs(|family, tuned, gains| {
        // Where rounding hides the answer from the careful way, there is nothing to compare with.
        let open = tuned.in_series(gains);
        let Ok(careful) = open.margins() else { return Ok(()) };
        let what = || format!("{gains:?} with {:?}", tuned.plant);
        tally.compare(family.margins(&gains), &careful, is_slow(&open)?, &what);
        Ok(())
    })?;
    assert!(tally.pairs > 5 * PLANTS * GAINS, "{}", tally.pairs);
    // Not vacuous: many loops are stable with room, and nearly all of those get an answer.
    assert!(tally.fit > tally.pairs / 5, "{} of {}", tally.fit, tally.pairs);
    // 3e-12 is found: rounding.
    assert!(tally.better < 1e-9, "{}", tally.better);
    assert!(100 * tally.answered > 99 * tally.fit, "{} of {}", tally.answered, tally.fit);
    Ok(())
}

#[test]
fn the_quick_way_says_nothing_of_gains_just_beyond_the_limit() -> Outcome {
    let mut limits = 0;
    pairs(|family, tuned, gains| {
        let Ok(Stability::Stable(careful)) = tuned.in_series(gains).margins() else {
            return Ok(());
        };
        let Some(limit) = careful.gain_high else { return Ok(()) };
        limits += 1;
        for beside in BESIDE {
            let beyond = gains.map(|gain| gain * limit.factor * (1.0 + beside));
            assert!(family.margins(&beyond).is_none(), "{beyond:?} with {:?}", tuned.plant);
        }
        Ok(())
    })?;
    assert!(limits > 100, "{limits}");
    Ok(())
}
