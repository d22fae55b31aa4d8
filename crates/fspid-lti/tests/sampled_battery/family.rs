//! Loops of a family by the quick way and by the careful one.

use crate::factored::Factored;
use crate::families::random_loop;
use crate::support::Random;
use fspid_lti::{
    LoopFamily, LtiError, Matrix, SampledLoop, SampledMargins, SeriesControl, Stability,
};

/// A plant behind a PID controller, open at the command: outputs for kp, ki, kd.
struct Tuned {
    a: Matrix,
    b: Vec<f64>,
    fixed: Vec<f64>,
    by_gain: Vec<Vec<f64>>,
    dt_s: f64,
    plant: Factored,
}

impl Tuned {
    /// The controller remembers the sum of all errors and the last one.
    fn new(plant: &Factored, rate: f64) -> Self {
        let (rows, mut b, c) = plant.parts();
        let order = rows.len();
        let (sum, last) = (order, order + 1);
        let mut rows: Vec<Vec<f64>> = rows
            .into_iter()
            .map(|mut row| {
                row.resize(order + 2, 0.0);
                row
            })
            .collect();
        let mut output = c;
        output.resize(order + 2, 0.0);
        let mut with_sum = output.clone();
        with_sum[sum] = 1.0;
        rows.extend([with_sum.clone(), output.clone()]);
        b.resize(order + 2, 0.0);
        let mut change = output.clone();
        change[last] = -1.0;
        let fixed: Vec<f64> = output
            .iter()
            .enumerate()
            .map(|(state, value)| if state % 2 == 0 { rate * value } else { 0.0 })
            .collect();
        let a = Matrix::from_rows(&rows).expect("finite");
        Self {
            a,
            b,
            fixed,
            by_gain: vec![output, with_sum, change],
            dt_s: plant.dt_s,
            plant: plant.clone(),
        }
    }

    fn family(&self) -> Result<LoopFamily, LtiError> {
        let (rows, b, c) = self.plant.parts();
        let control = SeriesControl::new(
            vec![-1.0, 0.0],
            vec![vec![1.0], vec![1.0, 1.0, 1.0], vec![1.0, -1.0]],
        )?;
        // The rate of a test is a part of the output.
        let fixed: Vec<f64> = self.fixed[..b.len()].to_vec();
        LoopFamily::new((&Matrix::from_rows(&rows)?, &b), [&fixed, &c], control, self.plant.dt_s)
    }

    fn open(&self, gains: [f64; 3]) -> Result<SampledLoop, LtiError> {
        let entry = |state: usize| {
            let parts = self.by_gain.iter().zip(gains).map(|(row, gain)| gain * row[state]);
            parts.fold(self.fixed[state], |sum, part| sum + part)
        };
        let c = (0..self.b.len()).map(entry).collect();
        SampledLoop::new(self.a.clone(), self.b.clone(), c, self.dt_s)
    }
}

#[derive(Default, Debug)]
struct Tally {
    pairs: usize,
    stable: usize,
    answered: usize,
    mute: usize,
    worst: f64,
    optimistic: usize,
    pessimistic: usize,
}

#[test]
fn explore() -> Result<(), LtiError> {
    for kind in 0..6 {
        let mut tally = Tally::default();
        let seed: u64 = std::env::var("SEED").map_or(100, |s| s.parse().unwrap());
        let count: usize = std::env::var("COUNT").map_or(150, |s| s.parse().unwrap());
        let mut random = Random(seed + kind as u64);
        for index in 0..count {
            let plant = random_loop(kind, &mut random);
            let tuned =
                Tuned::new(&plant, if index % 3 == 0 { random.uniform(0.0, 1.0) } else { 0.0 });
            let family = tuned.family()?;
            for _ in 0..10 {
                let kp = random.uniform(0.1, 2.0);
                let ki = kp * libm::exp(random.uniform(-9.0, -1.0));
                let kd = kp * libm::exp(random.uniform(-3.0, 3.0));
                compare(index, &tuned, &family, [kp, ki, kd], &mut tally)?;
            }
        }
        println!("{kind}: {tally:?}");
    }
    Ok(())
}

fn compare(
    index: usize,
    tuned: &Tuned,
    family: &LoopFamily,
    gains: [f64; 3],
    tally: &mut Tally,
) -> Result<(), LtiError> {
    tally.pairs += 1;
    let full = tuned.open(gains)?.margins()?;
    if matches!(full, Stability::Stable(_)) {
        tally.stable += 1;
    }
    let Some(quick) = family.margins(&gains) else {
        if let Stability::Stable(full) = &full
            && full.disk.size > 0.1
        {
            tally.mute += 1;
            if std::env::var("VERBOSE").is_ok() {
                println!("{index}: no answer though {} {}", full.disk.size, full.spectral_radius);
            }
        }
        return Ok(());
    };
    tally.answered += 1;
    let Stability::Stable(full) = full else {
        println!("FALSE SAFE {index} {gains:?} {quick:?} {full:?}");
        return Ok(());
    };
    for (what, quick, full) in differences(&quick, &full) {
        let (quick, full): (f64, f64) = (quick, full);
        let off = if quick == full { 0.0 } else { (quick - full) / full.abs().max(1e-300) };
        tally.worst = tally.worst.max(off.abs());
        if !(off.abs() < 1e-6) {
            if off > 0.0 {
                tally.optimistic += 1
            } else {
                tally.pessimistic += 1
            }
            if what != "radius" {
                let open = tuned.open(gains)?;
                for w in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.0, 3.0] {
                    let z = crate::factored::zeta(w);
                    let exact = crate::dense::quotient_of(tuned.plant.at(z));
                    let control = (z + 1.0) / z * gains[1] + gains[0] + z / (z + 1.0) * gains[2];
                    let exact = exact * control;
                    let full = open.at(w / open.dt_s());
                    let quick = family.at(&gains, w / open.dt_s());
                    println!(
                        "   {index} {w} full {:e} other {:e}",
                        fspid_lti::modulus(full - exact) / fspid_lti::modulus(exact),
                        fspid_lti::modulus(quick - exact) / fspid_lti::modulus(exact)
                    );
                }
            }
            println!("{index} {what} quick {quick} full {full} {gains:?}");
        }
    }
    Ok(())
}

/// Each number as a margin, larger is safer.
fn differences(quick: &SampledMargins, full: &SampledMargins) -> Vec<(&'static str, f64, f64)> {
    let both = |of: fn(&SampledMargins) -> f64| (of(quick), of(full));
    let all: [(&'static str, fn(&SampledMargins) -> f64); 9] = [
        ("gain low", |m| m.gain_low.map_or(f64::INFINITY, |l| 1.0 / l.factor)),
        ("gain high", |m| m.gain_high.map_or(f64::INFINITY, |l| l.factor)),
        ("phase", |m| m.phase_margin.map_or(f64::INFINITY, |c| c.phase_margin_rad.abs())),
        ("delay", |m| m.delay_margin_s.unwrap_or(f64::INFINITY)),
        ("disk", |m| m.disk.size),
        ("modulus", |m| m.modulus_margin),
        ("1/Mt", |m| 1.0 / m.complementary_peak.value),
        ("radius", |m| m.spectral_radius),
        ("crossovers", |m| m.crossovers.len() as f64),
    ];
    all.into_iter()
        .map(|(what, of)| {
            let (quick, full) = both(of);
            (what, quick, full)
        })
        .collect()
}
