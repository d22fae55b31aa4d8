//! How far the answers of two systems lie apart.

use fspid_fuzzy::system::{Parts, System, Workspace};

/// Most questions that are spread over the ranges.
const MOST: usize = 500;
/// Most rules that these questions ask in all; ten questions are asked in any case.
const MOST_RULES: usize = 2_000_000;
/// Steps of a climb are halved so often.
const HALVINGS: usize = 12;
/// The first steps of a climb, by the range of an input: no further than the next questions are.
const FIRST_STEP: f64 = 0.05;

/// What is known of one output of two systems.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Difference {
    /// Largest difference that was found.
    pub(crate) largest: f64,
    /// How many questions one of the two did not answer.
    pub(crate) unanswered: u32,
}

/// How many questions are spread over the ranges of a system.
pub(crate) fn questions(parts: &Parts) -> u32 {
    let rules: usize = parts.blocks.iter().map(|block| block.rules.len()).sum();
    let questions = (MOST_RULES / rules.max(1)).clamp(10, MOST);
    u32::try_from(questions).unwrap_or(10)
}

/// For each output how far the answers lie apart: at questions that are spread evenly over the ranges of the inputs, always
/// the same ones, and from the worst of them upwards, along one input after the other. None if a system cannot be built.
///
/// What is found is no bound: the worst may lie elsewhere.
pub(crate) fn differences(one: &Parts, other: &Parts) -> Option<Vec<Difference>> {
    let systems = [System::new(one.clone()).ok()?, System::new(other.clone()).ok()?];
    let mut pair = Pair { rooms: systems.each_ref().map(System::workspace), systems: &systems };
    let mut found = vec![(Difference::default(), None); one.outputs.len()];
    for number in 1..=questions(one) {
        let question = question(other, number);
        for ((difference, worst), apart) in found.iter_mut().zip(pair.apart(&question)) {
            match apart {
                Apart::By(apart) if apart > difference.largest => {
                    (difference.largest, *worst) = (apart, Some(question.clone()));
                }
                Apart::By(_) => {}
                Apart::OneAlone => difference.unanswered += 1,
            }
        }
    }
    let climbed = found.into_iter().enumerate().map(|(output, (difference, worst))| {
        let largest = worst.map_or(0.0, |at| pair.climbed(output, at, difference.largest));
        Difference { largest, ..difference }
    });
    Some(climbed.collect())
}

/// How far the answers to one question lie apart.
#[derive(Clone, Copy)]
enum Apart {
    By(f64),
    /// One of the two does not answer.
    OneAlone,
}

struct Pair<'a> {
    systems: &'a [System; 2],
    rooms: [Workspace; 2],
}

impl Pair<'_> {
    /// By output; nothing where a question is refused.
    fn apart(&mut self, question: &[f64]) -> Vec<Apart> {
        let ([one, other], [left, right]) = (self.systems, &mut self.rooms);
        let answers = (one.evaluate(question, left), other.evaluate(question, right));
        let (Ok(one), Ok(other)) = answers else { return Vec::new() };
        let apart = one.iter().zip(other).map(|(one, other)| match (one.value, other.value) {
            (Some(one), Some(other)) => Apart::By((one - other).abs()),
            (None, None) => Apart::By(0.0),
            _ => Apart::OneAlone,
        });
        apart.collect()
    }

    /// The largest difference of an output that steps from a question lead to, which are halved where none leads upwards.
    fn climbed(&mut self, output: usize, mut at: Vec<f64>, mut largest: f64) -> f64 {
        let ends: Vec<_> = ranges(self.systems[1].parts()).collect();
        let steps = core::iter::successors(Some(FIRST_STEP), |step| Some(0.5 * step));
        for step in steps.take(HALVINGS) {
            for (input, &(lower, upper)) in ends.iter().enumerate() {
                for way in [-step, step] {
                    let mut next = at.clone();
                    let Some(place) = next.get_mut(input) else { continue };
                    *place = (*place + way * (upper - lower)).clamp(lower, upper);
                    if let Some(&Apart::By(apart)) = self.apart(&next).get(output)
                        && apart > largest
                    {
                        (largest, at) = (apart, next);
                    }
                }
            }
        }
        largest
    }
}

/// The range of each input, [-1, 1] where there is none.
fn ranges(parts: &Parts) -> impl Iterator<Item = (f64, f64)> {
    parts.inputs.iter().map(|it| it.universe.map_or((-1.0, 1.0), |all| (all.lower, all.upper)))
}

/// The `number`th point: multiples of irrational steps, modulo 1.
fn question(parts: &Parts, number: u32) -> Vec<f64> {
    let share = |index: u32| (f64::from(number) * spread(index)).fract();
    let ranges = ranges(parts).zip(0..);
    ranges.map(|((lower, upper), index)| lower + share(index) * (upper - lower)).collect()
}

/// Steps of the inputs of which no sum of whole multiples is whole, so that the points do not lie on a few planes: by roots of
/// different primes, of 5 and 2 for the first two inputs.
fn spread(index: u32) -> f64 {
    match index {
        0 | 1 => {
            0.618_033_988_749_894_9 * f64::from(index + 1)
                + 0.414_213_562_373_095 * f64::from(index)
        }
        _ => root_of_prime(index as usize - 2),
    }
}

/// What the square root of the `place`th prime but 2 and 5 has beyond a whole number.
fn root_of_prime(place: usize) -> f64 {
    let is_prime = |number: &u32| (2..*number).all(|part| !number.is_multiple_of(part));
    let prime = (3_u32..).filter(|number| *number != 5 && is_prime(number)).nth(place);
    f64::from(prime.unwrap_or(3)).sqrt().fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The grade of a triangle that is a quarter wide to either side, over [0, 1].
    fn triangle(centre: f64) -> Parts {
        let text = format!(
            "[System]\nName='s'\nType='sugeno'\nVersion=2.0\nNumInputs=1\nNumOutputs=1\nNumRules=2\nAndMethod='prod'\n\
             OrMethod='max'\nImpMethod='prod'\nAggMethod='sum'\nDefuzzMethod='wtsum'\n\n[Input1]\nName='x'\nRange=[0 1]\n\
             NumMFs=2\nMF1='near':'trimf',[{} {centre} {}]\nMF2='any':'trapmf',[-1 -1 2 2]\n\n[Output1]\nName='y'\nRange=[0 1]\n\
             NumMFs=2\nMF1='one':'constant',[1]\nMF2='none':'constant',[0]\n\n[Rules]\n1, 1 (1) : 1\n2, 2 (1) : 1\n",
            centre - 0.25,
            centre + 0.25
        );
        crate::fis::read(&text).expect("a system").parts
    }

    /// Any three neighbouring inputs used to lie on parallel planes, so that a box of a hundredth of the ranges had no question.
    #[test]
    fn questions_of_several_inputs_are_spread_over_the_ranges_and_not_over_planes() {
        for [one, two, three] in [[0, 1, 2], [1, 2, 3], [4, 6, 9]] {
            let shares = |number: u32| {
                [one, two, three].map(|index| (f64::from(number) * spread(index)).fract())
            };
            // Boxes of an eighth of the ranges to each side would hold a 512th of 5120 points each.
            let mut held = [0_u32; 512];
            for number in 1..=5120 {
                let place = shares(number).map(|share| (8.0 * share) as usize);
                held[64 * place[0] + 8 * place[1] + place[2]] += 1;
            }
            let [least, most] = [held.iter().min(), held.iter().max()];
            assert!(
                least >= Some(&2) && most <= Some(&25),
                "{one} {two} {three}: {least:?} {most:?}"
            );
        }
    }

    #[test]
    fn the_largest_difference_is_that_at_a_peak_which_no_question_meets() {
        // It falls to either side of the peaks.
        let found = differences(&triangle(0.5), &triangle(0.75)).expect("two systems");
        assert!((found[0].largest - 1.0).abs() < 1e-4 && found[0].unanswered == 0, "{found:?}");
    }
}
