//! What the tests of the supervisor's bits share: rule tables and inputs of every kind.

use fspid_fuzzy::{Defuzzifier, Grid, LABEL_COUNT, Label, RuleTable};
use fspid_numeric::Real;

/// Splitmix64 (Steele, Lea and Flood 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Between -1 and 1.
    pub(crate) fn unit(&mut self) -> f64 {
        2.0 * ((self.word() >> 11) as f64 / 9_007_199_254_740_992.0) - 1.0
    }

    /// An input for a supervisor with this half range: inside, near the ends, on peaks and where
    /// sets cross, far outside, tiny, and what is no finite number.
    pub(crate) fn input<R: Real>(&mut self, range: R) -> R {
        let full = range.to_f64();
        let value = match self.word() % 16 {
            0..=6 => full * self.unit(),
            7..=9 => full * (self.word() % 29) as f64 / 12.0 - full * 14.0 / 12.0,
            10..=12 => 10.0 * full * self.unit(),
            13 => full * self.unit().signum() * (1.0 + f64::EPSILON * (self.word() % 5) as f64),
            14 => full * self.unit() * power_of_two(self.word() % 121),
            _ => self.special(),
        };
        R::from_f64(value)
    }

    fn special(&mut self) -> f64 {
        let values = [0.0, f64::from_bits(1), 1e-40, f64::MIN_POSITIVE, 1e38, 1e300, f64::MAX];
        let none = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        let pick = self.word() as usize % 64;
        none.get(pick).copied().unwrap_or(values[pick % values.len()] * self.unit().signum())
    }
}

/// 2^-60 to 2^60.
fn power_of_two(step: u64) -> f64 {
    f64::from_bits((1023 + step - 60) << 52)
}

pub(crate) const RULES: [Defuzzifier; 4] = [
    Defuzzifier::Exact,
    Defuzzifier::Endpoints(101),
    Defuzzifier::Midpoint(100),
    Defuzzifier::Trapezoid(7),
];

/// Half ranges: the paper's, ones that no binary fraction meets, and nearly the limits.
pub(crate) const RANGES_F64: [f64; 4] = [5.0, 1.0 / 3.0, 3e-100, 7e99];
pub(crate) const RANGES_F32: [f32; 4] = [5.0, 1.0 / 3.0, 3e-12, 7e11];

/// The printed and the mirrored rules, rules without any order, and one label everywhere.
pub(crate) fn tables() -> [RuleTable; 4] {
    let mut random = Random(7);
    let mut scrambled = || {
        let row = [Label::ZO; LABEL_COUNT];
        Grid::new(
            [row; LABEL_COUNT]
                .map(|row| row.map(|_| Label::ALL[(random.word() % LABEL_COUNT as u64) as usize])),
        )
    };
    let scrambled = RuleTable::new([scrambled(), scrambled(), scrambled()]);
    let alone = |label| Grid::new([[label; LABEL_COUNT]; LABEL_COUNT]);
    let alone = RuleTable::new([alone(Label::NB), alone(Label::PS), alone(Label::PB)]);
    [shipped(PRINTED), shipped(MIRRORED), scrambled, alone]
}

const PRINTED: &str = include_str!("../../../../data/rule-tables/printed.toml");
const MIRRORED: &str = include_str!("../../../../data/rule-tables/mirrored.toml");

/// The three grids of a rule-table file: the texts between triple quotes.
fn shipped(file: &str) -> RuleTable {
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table")
}
