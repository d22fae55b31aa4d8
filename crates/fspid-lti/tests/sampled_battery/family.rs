//! Loops of a family by the quick way and by the careful one.

use crate::Outcome;
use crate::factored::{Factored, Section};
use crate::families::random_loop;
use crate::support::Random;
use fspid_lti::{
    LoopFamily, LtiError, Matrix, SampledLoop, SampledMargins, SeriesControl, Stability,
};

/// Plants of each kind, and gains of each plant.
const PLANTS: usize = 60;
const GAINS: usize = 8;
/// Largest relative difference of a margin: the battery finds the careful values to 10⁻¹⁰.
const ALLOWED: f64 = 1e-8;
/// The quick way answers where the disk margin is not below this one.
const SMALL_DISK: f64 = 0.1;
/// How far beside the limit of stability the verdicts are compared.
const BESIDE: [f64; 5] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10];

/// Random plants behind a PID controller that sums errors and takes their difference.
struct Tuned {
    plant: Factored,
    /// A part of the plant's states that comes back without the controller.
    fixed: Vec<f64>,
}

impl Tuned {
    fn random(kind: usize, share: f64, random: &mut Random) -> Self {
        let plant = random_loop(kind, random);
        let (_, _, c) = plant.parts();
        let fixed = c.iter().map(|value| share * random.uniform(0.0, 1.0) * value).collect();
        Self { plant, fixed }
    }

    fn family(&self) -> Result<LoopFamily, LtiError> {
        let (rows, b, c) = self.plant.parts();
        let by_gain = vec![vec![1.0], vec![1.0, 1.0, 1.0], vec![1.0, -1.0]];
        let control = SeriesControl::new(vec![-1.0, 0.0], by_gain)?;
        let a = Matrix::from_rows(&rows)?;
        LoopFamily::new((&a, &b), [&self.fixed, &c], control, self.plant.dt_s)
    }

    /// The loop with some gains: the controller as one more section, kp + ki (1 + ζ)/ζ + kd ζ/(1 + ζ).
    fn in_series(&self, [kp, ki, kd]: [f64; 3]) -> SampledLoop {
        let mut open = self.plant.clone();
        let lead = kp + ki + kd;
        open.gain *= lead;
        let numerator = [ki / lead, (kp + 2.0 * ki) / lead, 1.0];
        open.sections.insert(0, Section::new(numerator, [0.0, 1.0, 1.0], 2));
        open.realised()
    }

    /// The same as rows that are added up, with what comes back without the controller: first the last output is
    /// remembered, then the sum of those before.
    fn side_by_side(&self, [kp, ki, kd]: [f64; 3]) -> Result<SampledLoop, LtiError> {
        let (mut rows, mut b, c) = self.plant.parts();
        let order = rows.len();
        rows.extend([c.clone(), vec![0.0; order + 2]]);
        for row in &mut rows {
            row.resize(order + 2, 0.0);
        }
        (rows[order + 1][order], rows[order + 1][order + 1]) = (1.0, 1.0);
        b.resize(order + 2, 0.0);
        let own = c.iter().zip(&self.fixed).map(|(c, fixed)| fixed + (kp + ki + kd) * c);
        let output = own.chain([ki - kd, ki]).collect();
        SampledLoop::new(Matrix::from_rows(&rows)?, b, output, self.plant.dt_s)
    }
}

fn random_gains(random: &mut Random) -> [f64; 3] {
    let kp = random.uniform(0.1, 2.0);
    let [ki, kd] =
        [(-9.0, -1.0), (-3.0, 3.0)].map(|(low, high)| kp * libm::exp(random.uniform(low, high)));
    [kp, ki, kd]
}

/// How many loops were stable with a disk margin that is not small, and how many of them got an answer.
#[derive(Default)]
struct Tally {
    pairs: usize,
    fit: usize,
    answered: usize,
}

impl Tally {
    /// No loop may be answered that is not stable, and no answer may differ.
    fn compare(
        &mut self,
        quick: Option<SampledMargins>,
        careful: &Stability,
        what: &dyn Fn() -> String,
    ) {
        self.pairs += 1;
        let fits = matches!(careful, Stability::Stable(found) if found.disk.size >= SMALL_DISK);
        self.fit += usize::from(fits);
        let Some(quick) = quick else { return };
        let Stability::Stable(careful) = careful else {
            panic!("called stable: {}: {careful:?}", what());
        };
        self.answered += usize::from(fits);
        for ((name, quick), (_, careful)) in numbers(&quick).into_iter().zip(numbers(careful)) {
            let same = quick == careful || (quick - careful).abs() <= ALLOWED * careful.abs();
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

#[test]
fn explore() -> Outcome {
    let seed: u64 = std::env::var("SEED").map_or(100, |s| s.parse().unwrap());
    let count: usize = std::env::var("COUNT").map_or(150, |s| s.parse().unwrap());
    for kind in 0..6 {
        for share in [0.0, 1.0] {
            let mut random = Random(seed + kind as u64);
            let mut worst = [0.0_f64; 10];
            let mut bad = 0;
            let mut tally = Tally::default();
            for index in 0..count {
                let tuned = Tuned::random(kind, share, &mut random);
                let family = tuned.family()?;
                for _ in 0..GAINS {
                    let gains = random_gains(&mut random);
                    let open = if share > 0.0 {
                        tuned.side_by_side(gains)?
                    } else {
                        tuned.in_series(gains)
                    };
                    let careful = open.margins()?;
                    let quick = family.margins(&gains);
                    tally.pairs += 1;
                    let fits = matches!(&careful, Stability::Stable(found) if found.disk.size >= SMALL_DISK);
                    tally.fit += usize::from(fits);
                    let Some(quick) = quick else { continue };
                    let Stability::Stable(careful) = careful else {
                        println!("FALSE SAFE {kind} {index} {gains:?}");
                        continue;
                    };
                    tally.answered += 1;
                    let (q2, careful2) = (&quick, &careful);
                    let pairs = numbers(&quick).into_iter().zip(numbers(&careful));
                    for (at, ((name, quick), (_, careful))) in pairs.enumerate() {
                        let off = if quick == careful {
                            0.0
                        } else {
                            (quick - careful).abs() / careful.abs()
                        };
                        worst[at] = worst[at].max(off);
                        if !(off < ALLOWED) {
                            bad += 1;
                            println!("{kind} {share} {index} {gains:?} {name} {quick} {careful}");
                            if share == 0.0 && name == "gain high" {
                                let [kp, ki, kd] = gains;
                                for f in [
                                    0.3116,
                                    0.31160571386946695,
                                    0.31161,
                                    0.312032,
                                    0.3120326692651509,
                                    0.312033,
                                    0.3122,
                                ] {
                                    let z = crate::factored::zeta(f * open.dt_s());
                                    let exact = crate::dense::quotient_of(tuned.plant.at(z))
                                        * ((z + 1.0) / z * ki + kp + z / (z + 1.0) * kd);
                                    println!(
                                        "   {f} exact {exact} quick {} careful {} {}",
                                        family.at(&gains, f),
                                        open.at(f),
                                        -1.0 / exact.re
                                    );
                                }
                                println!("{:?}", tuned.plant);
                            }
                            if name == "disk" || name == "Mt" {
                                println!(
                                    "    {:?} {:?}  / {:?} {:?}",
                                    q2.disk,
                                    q2.complementary_peak,
                                    careful2.disk,
                                    careful2.complementary_peak
                                );
                            }
                        }
                    }
                }
            }
            println!(
                "{kind} {share}: pairs {} fit {} answered {} bad {bad} {}",
                tally.pairs,
                tally.fit,
                tally.answered,
                worst.map(|w| format!("{w:.0e}")).join(" ")
            );
        }
    }
    Ok(())
}
