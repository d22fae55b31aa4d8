//! Tuners to ask about, and numbers to ask with.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};
use fspid_core::{
    ControllerSetting, GainLimits, Gains, Law, Limits, Sample, SelfTuner, TunerSettings,
};
use fspid_proof::gain_set::GainCell;

pub(crate) const PRINTED: &str = include_str!("../../../../data/rule-tables/printed.toml");
pub(crate) const MIRRORED: &str = include_str!("../../../../data/rule-tables/mirrored.toml");
pub(crate) const NOMINAL: Gains<f64> = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
pub(crate) const SCALE: Gains<f64> = Gains { kp: 0.2, ki: 0.05, kd: 0.1 };
pub(crate) const PERIOD_S: f64 = 0.01;

pub(crate) fn supervisor(table: &str, range: f64, out_of_range: OutOfRange) -> Supervisor<f64> {
    with_centroid(table, range, Defuzzifier::Exact, out_of_range)
}

pub(crate) fn with_centroid(
    table: &str,
    range: f64,
    rule: Defuzzifier,
    out_of_range: OutOfRange,
) -> Supervisor<f64> {
    let grids: Vec<&str> = table.split("\"\"\"").collect();
    let table = RuleTable::parse([grids[1], grids[3], grids[5]]).expect("a shipped table");
    Supervisor::new(&table, range, rule, out_of_range).expect("allowed")
}

pub(crate) fn settings() -> TunerSettings<f64> {
    TunerSettings { output_scale: SCALE, ..TunerSettings::literal() }
}

pub(crate) fn tuner(supervisor: Supervisor<f64>, settings: TunerSettings<f64>) -> SelfTuner<f64> {
    SelfTuner::new(NOMINAL, supervisor, settings).expect("allowed")
}

/// The paper's rules over a range of 5.
pub(crate) fn paper(settings: TunerSettings<f64>) -> SelfTuner<f64> {
    tuner(supervisor(PRINTED, 5.0, OutOfRange::Clamp), settings)
}

pub(crate) fn leaking(leakage_per_s: f64) -> Law<f64> {
    Law::Accumulating { leakage_per_s }
}

pub(crate) fn limits() -> GainLimits<f64> {
    let between =
        |lower, upper| Limits::new(ControllerSetting::GainLimits, lower, upper).expect("in order");
    GainLimits { kp: between(1.5, 2.6), ki: between(0.4, 10.0), kd: between(0.0, 1.2) }
}

/// A sample with this error.
pub(crate) fn error(error_rad: f64) -> Sample<f64> {
    Sample { setpoint_rad: error_rad, measurement_rad: 0.0, rate_rad_s: 0.0 }
}

pub(crate) fn array(gains: Gains<f64>) -> [f64; 3] {
    [gains.kp, gains.ki, gains.kd]
}

/// Whether the inputs are the cell's.
pub(crate) fn around(cell: &GainCell, [error, change]: [f64; 2]) -> bool {
    let holds = |[lower, upper]: [f64; 2], x: f64| lower <= x && x <= upper;
    holds(cell.error, error) && holds(cell.change, change)
}

/// Whether the gains are the cell's.
pub(crate) fn inside(cell: &GainCell, gains: Gains<f64>) -> bool {
    cell.gains.iter().zip(array(gains)).all(|(bounds, gain)| bounds.contains(gain))
}

/// Numbers from -1 to 1, the same at each run (Steele, Lea and Flood, OOPSLA 2014).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub(crate) fn point(&mut self, reach: f64) -> [f64; 2] {
        [reach * self.number(), reach * self.number()]
    }
}
