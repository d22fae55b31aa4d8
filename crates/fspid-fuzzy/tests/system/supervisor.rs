//! The paper's supervisor as a general system.

use fspid_fuzzy::system::{Parts, System};
use fspid_fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};

const PRINTED: &str = include_str!("../../../../data/rule-tables/printed.toml");
pub(crate) const TABLES: [(&str, &str); 2] = [
    ("printed", PRINTED),
    ("mirrored", include_str!("../../../../data/rule-tables/mirrored.toml")),
];

fn supervisor(range: f64, defuzzifier: Defuzzifier) -> Supervisor<f64> {
    let parts: Vec<&str> = PRINTED.split("\"\"\"").collect();
    let table = RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table");
    Supervisor::new(&table, range, defuzzifier, OutOfRange::Clamp).expect("allowed")
}

#[test]
fn the_paper_s_supervisor_answers_the_same_bits_as_a_general_system() {
    let rules = [
        Defuzzifier::Exact,
        Defuzzifier::Endpoints(101),
        Defuzzifier::Midpoint(100),
        Defuzzifier::Trapezoid(101),
        Defuzzifier::LeftEnd(100),
        Defuzzifier::Vertices(26),
    ];
    for (range, rule) in [5.0, 40.0, 0.3].into_iter().flat_map(|r| rules.map(|d| (r, d))) {
        let fixed = supervisor(range, rule);
        let general = System::new(Parts::try_from(&fixed).expect("rules")).expect("allowed");
        let mut workspace = general.workspace();
        for n in 0..400 {
            let error = range * libm::sin(f64::from(n) * 0.37) * 1.2;
            let change = range * libm::cos(f64::from(n) * 0.73 + 1.0);
            let delta = fixed.infer(error, change).expect("finite").delta;
            let answers = general.evaluate(&[error, change], &mut workspace).expect("finite");
            let values: Vec<_> = answers.iter().map(|a| a.value.expect("rules fire")).collect();
            assert_eq!(values, [delta.kp, delta.ki, delta.kd], "{range} {rule} {error} {change}");
        }
    }
}
