//! Batches answer bit by bit what single inferences answer, whatever the machine's vectors.

use crate::common;

use common::{RANGES_F32, RANGES_F64, RULES, Random, tables};
use fspid_fuzzy::{
    Answers, BatchError, Defuzzifier, Increments, Inference, InferenceError, LABEL_COUNT, Network,
    NumberTable, OutOfRange, Supervisor,
};
use fspid_numeric::{InstructionSet, Real};

/// Arrays for answers, filled with what no supervisor answers.
struct Places<R> {
    gains: [Vec<R>; 3],
    flags: [Vec<bool>; 2],
}

impl<R: Real> Places<R> {
    fn new(length: usize) -> Self {
        let unanswered = vec![R::from_f64(1e9); length];
        Self {
            gains: [unanswered.clone(), unanswered.clone(), unanswered],
            flags: [vec![true; length], vec![true; length]],
        }
    }

    fn answers(&mut self) -> Answers<'_, R> {
        let [kp, ki, kd] = &mut self.gains;
        let [clamped, underflowed] = &mut self.flags;
        Answers { kp, ki, kd, clamped, underflowed }
    }

    fn at(&self, index: usize) -> Inference<R> {
        let [kp, ki, kd] = self.gains.each_ref().map(|gains| gains[index]);
        let [clamped, underflowed] = self.flags.each_ref().map(|flags| flags[index]);
        Inference { delta: Increments { kp, ki, kd }, clamped, underflowed }
    }
}

fn bits<R: Real>(inference: Inference<R>) -> ([u64; 3], bool, bool) {
    let Inference { delta: Increments { kp, ki, kd }, clamped, underflowed } = inference;
    ([kp, ki, kd].map(|gain| gain.to_f64().to_bits()), clamped, underflowed)
}

/// Not by `==`: what was refused may be no number.
fn same_refusal(a: InferenceError, b: InferenceError) -> bool {
    (a.input, a.found.to_bits(), a.range) == (b.input, b.found.to_bits(), b.range)
}

/// Asks by each instruction set and compares with single inferences; answers how many were compared
/// and how many batches were refused.
fn compare<R: Real>(supervisor: &Supervisor<R>, error: &[R], change: &[R]) -> (usize, usize) {
    let singly: Vec<_> = error.iter().zip(change).map(|(&e, &c)| supervisor.infer(e, c)).collect();
    let first_refused = singly.iter().position(Result::is_err);
    let (mut compared, mut refused) = (0, 0);
    for set in InstructionSet::available() {
        let mut places = Places::new(error.len());
        let answer = supervisor.infer_many_by(set, error, change, places.answers());
        match (answer, first_refused.map(|index| (index, singly[index]))) {
            (Ok(()), None) => {}
            (Err(BatchError::Refused { index, error }), Some((first, Err(single)))) => {
                assert!(index == first && same_refusal(error, single), "{set}: {index} {first}");
                refused += 1;
            }
            (answer, single) => panic!("{set}: {answer:?}, one by one {single:?}"),
        }
        for (index, single) in singly.iter().enumerate().take(first_refused.unwrap_or(usize::MAX)) {
            let single = single.expect("before the first refused");
            assert_eq!(bits(places.at(index)), bits(single), "{set}, {index} of {}", error.len());
            compared += 1;
        }
    }
    (compared, refused)
}

/// Batches of all lengths to 40 with inputs of every kind; in every second only numbers.
fn compare_lengths<R: Real>(supervisor: &Supervisor<R>, random: &mut Random) -> (usize, usize) {
    let (policy, range) = (supervisor.out_of_range(), supervisor.range());
    let (mut compared, mut refused) = (0, 0);
    for length in 0..=40 {
        let mut inputs = || -> Vec<R> {
            let numbers = |_| loop {
                let input = random.input(range);
                let wanted = policy != OutOfRange::Error || input.abs() <= range;
                if length % 2 == 0 || (input.is_finite() && wanted) {
                    return input;
                }
            };
            (0..length).map(numbers).collect()
        };
        let counts = compare(supervisor, &inputs(), &inputs());
        (compared, refused) = (compared + counts.0, refused + counts.1);
    }
    (compared, refused)
}

fn compare_all<R: Real>(ranges: [R; 4]) {
    let mut random = Random(40);
    let (mut compared, mut refused) = (0, 0);
    for (rule, table) in RULES.into_iter().zip(tables()) {
        for policy in OutOfRange::ALL {
            for range in ranges {
                let supervisor = Supervisor::new(&table, range, rule, policy).expect("allowed");
                let counts = compare_lengths(&supervisor, &mut random);
                (compared, refused) = (compared + counts.0, refused + counts.1);
            }
        }
    }
    assert!(compared > 20_000 && refused > 100, "{compared} compared, {refused} refused");
}

/// The same with rules that conclude numbers.
fn compare_all_numbers<R: Real>(ranges: [R; 4]) {
    let mut random = Random(41);
    let (mut compared, mut refused) = (0, 0);
    for range in ranges {
        for policy in OutOfRange::ALL {
            let mut cell = |_| range * R::from_f64(random.unit());
            let grids = [[[R::ZERO; LABEL_COUNT]; LABEL_COUNT]; 3];
            let grids = grids.map(|grid| grid.map(|row| row.map(&mut cell)));
            let table = NumberTable::new(grids).expect("finite");
            let supervisor = Supervisor::of_numbers(&table, range, policy).expect("allowed");
            let counts = compare_lengths(&supervisor, &mut random);
            (compared, refused) = (compared + counts.0, refused + counts.1);
        }
    }
    assert!(compared > 5_000 && refused > 25, "{compared} compared, {refused} refused");
}

/// The same with networks.
fn compare_all_networks<R: Real>(ranges: [R; 4]) {
    let mut random = Random(43);
    let (mut compared, mut refused) = (0, 0);
    for range in ranges {
        for policy in OutOfRange::ALL {
            let mut weight = |_| R::from_f64(4.0 * random.unit());
            let rows = [[R::ZERO; 8]; 6].map(|row| row.map(&mut weight));
            let network = Network::new(rows).expect("allowed");
            let supervisor = Supervisor::of_network(&network, range, policy).expect("allowed");
            let counts = compare_lengths(&supervisor, &mut random);
            (compared, refused) = (compared + counts.0, refused + counts.1);
        }
    }
    assert!(compared > 5_000 && refused > 25, "{compared} compared, {refused} refused");
}

#[test]
fn a_batch_of_a_network_has_the_bits_and_flags_of_single_inferences() {
    compare_all_networks(RANGES_F64);
    compare_all_networks(RANGES_F32);
}

#[test]
fn a_batch_of_numbers_has_the_bits_and_flags_of_single_inferences() {
    compare_all_numbers(RANGES_F64);
    compare_all_numbers(RANGES_F32);
}

#[test]
fn a_batch_of_any_length_has_the_bits_and_flags_of_single_inferences() {
    compare_all(RANGES_F64);
}

#[test]
fn a_batch_in_single_precision_has_the_bits_and_flags_of_single_inferences() {
    compare_all(RANGES_F32);
}

fn supervisor(policy: OutOfRange) -> Supervisor<f64> {
    let [printed, ..] = tables();
    Supervisor::new(&printed, 5.0, Defuzzifier::Exact, policy).expect("allowed")
}

#[test]
fn a_long_batch_by_the_widest_vectors_has_the_bits_of_single_inferences() {
    let mut random = Random(3);
    let mut inputs = || -> Vec<f64> { (0..100_003).map(|_| 6.0 * random.unit()).collect() };
    let (error, change) = (inputs(), inputs());
    let supervisor = supervisor(OutOfRange::Evaluate);
    let mut places = Places::new(error.len());
    assert_eq!(supervisor.infer_many(&error, &change, places.answers()), Ok(()));
    for (index, (&error, &change)) in error.iter().zip(&change).enumerate() {
        let single = supervisor.infer(error, change).expect("finite");
        assert_eq!(bits(places.at(index)), bits(single), "{index}");
    }
}

#[test]
fn every_place_of_a_vector_names_itself_when_it_is_refused() {
    let refusing = supervisor(OutOfRange::Error);
    for length in 1..=33 {
        for index in 0..length {
            for (bad, policy) in [
                (f64::NAN, OutOfRange::Clamp),
                (f64::NEG_INFINITY, OutOfRange::Evaluate),
                (5.000_001, OutOfRange::Error),
            ] {
                let (mut error, change) = (vec![1.0; length], vec![-2.0; length]);
                // The last one is refused too, but it is not the first.
                (error[length - 1], error[index]) = (bad, bad);
                let mut places = Places::new(length);
                let answer = supervisor(policy).infer_many(&error, &change, places.answers());
                let Err(BatchError::Refused { index: found, error }) = answer else {
                    panic!("{bad} at {index} of {length}: {answer:?}");
                };
                assert_eq!((found, error.input), (index, "error"));
                let expected = refusing.infer(1.0, -2.0).expect("inside");
                assert!((0..index).all(|before| bits(places.at(before)) == bits(expected)));
            }
        }
    }
}

#[test]
fn arrays_of_different_lengths_are_refused_by_name_and_nothing_is_answered() {
    let supervisor = supervisor(OutOfRange::Clamp);
    for (wrong, what) in
        ["change", "kp", "ki", "kd", "clamped", "underflowed"].into_iter().enumerate()
    {
        for found in [0, 2, 4] {
            let length = |array: usize| if array == wrong { found } else { 3 };
            let change = vec![0.0; length(0)];
            let mut places = Places {
                gains: [1, 2, 3].map(|array| vec![1e9; length(array)]),
                flags: [4, 5].map(|array| vec![true; length(array)]),
            };
            let answer = supervisor.infer_many(&[0.0; 3], &change, places.answers());
            assert_eq!(answer, Err(BatchError::Length { what, found, expected: 3 }));
            assert!(places.gains.iter().flatten().all(|gain| gain.to_bits() == 1e9_f64.to_bits()));
        }
    }
    let message = BatchError::Length { what: "kp", found: 2, expected: 3 }.to_string();
    assert_eq!(message, "kp has a length of 2; allowed is that of error, 3");
}

#[test]
fn a_refusal_says_which_inputs_and_why() {
    let mut places = Places::new(2);
    let refusing = supervisor(OutOfRange::Error);
    let answer = refusing.infer_many(&[0.0, 1.0], &[0.0, 5.5], places.answers());
    let message = answer.expect_err("outside").to_string();
    assert_eq!(message, "inputs 1: change is 5.5; allowed is -5.0 to 5.0");
}

#[test]
fn an_empty_batch_is_answered() {
    let answer = supervisor(OutOfRange::Error).infer_many(&[], &[], Places::new(0).answers());
    assert_eq!(answer, Ok(()));
}

#[test]
fn a_batch_allocates_nothing() {
    let supervisor = supervisor(OutOfRange::Evaluate);
    let (error, change) = ([4.0, 40.0, 2.0, 1.0, 6.0], [1.0, 2.0, -3.0, 0.0, 5.0]);
    let (mut kp, mut ki, mut kd) = ([0.0; 5], [0.0; 5], [0.0; 5]);
    let (mut clamped, mut underflowed) = ([false; 5], [false; 5]);
    let counted = allocation_counter::measure(|| {
        let (clamped, underflowed) = (&mut clamped, &mut underflowed);
        let answers = Answers { kp: &mut kp, ki: &mut ki, kd: &mut kd, clamped, underflowed };
        assert!(supervisor.infer_many(&error, &change, answers).is_ok());
    });
    assert_eq!(counted.count_total, 0);
    assert_eq!(underflowed, [false, true, false, false, false]);
}

#[test]
fn the_best_instruction_set_is_the_last_of_those_available() {
    let names: Vec<_> = InstructionSet::available().map(InstructionSet::name).collect();
    assert_eq!(names.last(), Some(&InstructionSet::best().name()));
}

proptest::proptest! {
    #[test]
    fn any_numbers_are_answered_as_one_by_one(
        inputs in proptest::collection::vec((proptest::num::f64::ANY, -9.0_f64..9.0), 0..20)
    ) {
        let (error, change): (Vec<_>, Vec<_>) = inputs.into_iter().unzip();
        for policy in OutOfRange::ALL {
            compare(&supervisor(policy), &error, &change);
            compare(&supervisor(policy), &change, &error);
        }
    }
}
