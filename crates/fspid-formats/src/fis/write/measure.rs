//! How far the answers of two systems lie apart.

use fspid_fuzzy::system::{Parts, System};

/// Most questions that are asked.
const MOST: usize = 500;
/// Most rules that are asked in all; ten questions are asked in any case.
const MOST_RULES: usize = 2_000_000;

/// How many questions are asked about a system.
pub(super) fn questions(parts: &Parts) -> u32 {
    let rules: usize = parts.blocks.iter().map(|block| block.rules.len()).sum();
    let questions = (MOST_RULES / rules.max(1)).clamp(10, MOST);
    u32::try_from(questions).unwrap_or(10)
}

/// For each output the largest difference of answers, and how many questions one of the two did
/// not answer. Questions are spread evenly over the ranges of the inputs; they are always the same.
pub(super) fn differences(one: &Parts, other: &Parts, questions: u32) -> Option<Vec<(f64, u32)>> {
    let systems = [System::new(one.clone()).ok()?, System::new(other.clone()).ok()?];
    let [mut first, mut second] = systems.each_ref().map(System::workspace);
    let [one, other] = &systems;
    let mut worst = vec![(0.0_f64, 0); one.parts().outputs.len()];
    for number in 1..=questions {
        let question = question(other.parts(), number);
        let answers = (one.evaluate(&question, &mut first), other.evaluate(&question, &mut second));
        let (Ok(left), Ok(right)) = answers else { continue };
        for ((left, right), (largest, without)) in left.iter().zip(right).zip(&mut worst) {
            match (left.value, right.value) {
                (Some(left), Some(right)) => *largest = largest.max((left - right).abs()),
                (None, None) => {}
                _ => *without += 1,
            }
        }
    }
    Some(worst)
}

/// The `number`th point: multiples of the roots of primes, modulo 1.
fn question(parts: &Parts, number: u32) -> Vec<f64> {
    let share = |index: u32| (f64::from(number) * spread(index)).fract();
    let inputs = parts.inputs.iter().zip(0..);
    let value = inputs.map(|(input, index)| {
        let (lower, span) = input.universe.map_or((-1.0, 2.0), |u| (u.lower, u.span()));
        lower + share(index) * span
    });
    value.collect()
}

/// Irrational steps that differ from input to input.
fn spread(index: u32) -> f64 {
    0.618_033_988_749_894_9 * f64::from(index + 1) + 0.414_213_562_373_095 * f64::from(index)
}
