//! The bits of the supervisor's answers, as recorded before it was made fast.
//!
//! Stored flights, claims and reports depend on the last bit of each increment. So a change that
//! moves one here is not an optimisation: it needs a line under **Numbers** in the changelog.

use crate::common;

use common::{RANGES_F32, RANGES_F64, RULES, Random, tables};
use fspid_fuzzy::{Defuzzifier, Inference, InferenceError, OutOfRange, Supervisor};
use fspid_numeric::{Real, Scalar};

/// Hashes of all answers: a row for each rule of [`RULES`], a column for each policy.
type Recorded = [[u64; 3]; 4];

const RECORDED_F64: Recorded = [
    [0x82FD_BCA3_764E_BC10, 0xF683_0C3B_1D27_EFB4, 0x3FC0_9E82_4E47_9378],
    [0x8306_9611_BEA3_D4BA, 0xF09A_3A43_6971_9ABE, 0x52FB_A42B_8454_2FE2],
    [0xF5C2_D361_1E48_3953, 0x1E6F_F1EB_ABC1_4304, 0xDAE4_8813_6746_81CB],
    [0xF36C_15A0_BF83_8567, 0xA0AE_4E9B_820F_B26B, 0x6593_93E3_B0C5_48B2],
];
const RECORDED_EXP: (u64, u64) = (0x77DC_5AB4_6CEB_D997, 0xEDDC_A873_C431_2474);
const RECORDED_F32: Recorded = [
    [0xA7B9_BB1F_D7DA_16FA, 0x2091_2D1B_F0C4_9174, 0x8562_1393_FA10_E6E5],
    [0x9F89_00CC_4FAA_54F4, 0x943D_7E34_FD7B_EFF3, 0x2BB6_83AD_3CC6_C836],
    [0x7372_CE1E_A022_3F46, 0xCECA_E069_6263_66E9, 0xC228_4DF4_B210_EB6E],
    [0x0066_E18B_4F29_62D6, 0xEE20_A365_D381_9DBD, 0x7019_1C8E_D71E_F300],
];

#[test]
fn answers_in_double_precision_have_the_recorded_bits() {
    assert_recorded(recorded(RANGES_F64), RECORDED_F64);
}

#[test]
fn answers_in_single_precision_have_the_recorded_bits() {
    assert_recorded(recorded(RANGES_F32), RECORDED_F32);
}

fn assert_recorded(found: Recorded, recorded: Recorded) {
    assert!(found == recorded, "found {found:#018x?}");
}

#[test]
fn exponentials_have_the_recorded_bits() {
    let mut random = Random(2);
    let (mut double, mut single) = (Hash::START, Hash::START);
    for _ in 0..200_000 {
        let unit = random.unit();
        for span in [1.0, 100.0, 800.0] {
            double.add_number(Scalar::exp(span * unit));
            single.add_number(Scalar::exp((span * unit) as f32));
        }
    }
    assert_eq!((double.0, single.0), RECORDED_EXP, "{:#x} {:#x}", double.0, single.0);
}

#[test]
fn the_recorded_inputs_are_of_every_kind() {
    let mut random = Random(1510);
    let (mut clamped, mut underflowed, mut refused, mut plain) = (0, 0, 0, 0);
    for table in tables() {
        for policy in OutOfRange::ALL {
            let rule = Defuzzifier::Exact;
            let supervisor = Supervisor::new(&table, 5.0, rule, policy).expect("allowed");
            for _ in 0..5000 {
                match supervisor.infer(random.input(5.0), random.input(5.0)) {
                    Ok(Inference { clamped: true, .. }) => clamped += 1,
                    Ok(Inference { underflowed: true, .. }) => underflowed += 1,
                    Ok(_) => plain += 1,
                    Err(_) => refused += 1,
                }
            }
        }
    }
    assert!(clamped > 5000 && underflowed > 500 && refused > 5000 && plain > 5000);
}

fn recorded<R: Real>(ranges: [R; 4]) -> Recorded {
    RULES.map(|rule| OutOfRange::ALL.map(|policy| hash_of_answers(ranges, rule, policy)))
}

fn hash_of_answers<R: Real>(ranges: [R; 4], rule: Defuzzifier, policy: OutOfRange) -> u64 {
    let inputs = if rule == Defuzzifier::Exact { 5000 } else { 200 };
    let mut random = Random(1510);
    let mut hash = Hash::START;
    for table in tables() {
        for range in ranges {
            let supervisor = Supervisor::new(&table, range, rule, policy).expect("allowed");
            for _ in 0..inputs {
                let (error, change) = (random.input(range), random.input(range));
                add_answer(&mut hash, supervisor.infer(error, change));
            }
        }
    }
    hash.0
}

fn add_answer<R: Real>(hash: &mut Hash, answer: Result<Inference<R>, InferenceError>) {
    match answer {
        Ok(Inference { delta, clamped, underflowed }) => {
            hash.add(u64::from(clamped) + 2 * u64::from(underflowed));
            hash.add_number(delta.kp);
            hash.add_number(delta.ki);
            hash.add_number(delta.kd);
        }
        Err(InferenceError { input, found, range }) => {
            hash.add(input.len() as u64);
            hash.add_number(found);
            hash.add_number(range);
        }
    }
}

/// FNV-1a over words.
#[derive(Clone, Copy)]
struct Hash(u64);

impl Hash {
    const START: Self = Self(0xCBF2_9CE4_8422_2325);

    fn add(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }

    /// A number by its bits; all that are not numbers count as one.
    fn add_number<R: Real>(&mut self, number: R) {
        let number = number.to_f64();
        self.add(if number.is_nan() { f64::NAN } else { number }.to_bits());
    }
}
