//! Audits the paper's supervisor and prints what was proved, with the time it took.

use fspid_fuzzy::audit::{self, SurfaceOptions};
use fspid_fuzzy::system::{Parts, System};
use fspid_fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};

fn main() {
    let text = include_str!("../../../data/rule-tables/printed.toml");
    let grids: Vec<&str> = text.split("\"\"\"").collect();
    let table = RuleTable::parse([grids[1], grids[3], grids[5]]).expect("a shipped table");
    let supervisor =
        Supervisor::new(&table, 5.0, Defuzzifier::Exact, OutOfRange::Clamp).expect("allowed");
    let system = System::new(Parts::from(&supervisor)).expect("sound");
    let begin = std::time::Instant::now();
    let rules = audit::rule_base(&system);
    println!(
        "{} rules, {} contradictions, {:?}",
        rules.rules,
        rules.contradictions.len(),
        begin.elapsed()
    );
    let options = SurfaceOptions {
        boxes: std::env::args().nth(1).map_or(20_000, |b| b.parse().expect("a number")),
        ..SurfaceOptions::default()
    };
    let audit = audit::surface(&system, &options).expect("universes are known");
    for output in &audit.outputs {
        println!("value {:?} to {:?}, at rest {:?}", output.least, output.most, output.at_rest);
        println!("coverage {:?}", output.coverage);
        for along in &output.along {
            println!(
                "  slope {:?}\n        {:?}\n  lipschitz {:?} rest {:?}",
                along.least_slope, along.most_slope, along.lipschitz, along.slope_at_rest
            );
            println!("  {:?}", along.monotone);
            println!("  sector {:?}", along.sector);
        }
        println!("odd {:?}\neven {:?}\nexchange {:?}", output.odd, output.even, output.exchange);
    }
    println!(
        "{:?}",
        audit
            .rules
            .iter()
            .map(|r| matches!(r, audit::RuleEffect::Leads { .. }))
            .filter(|l| *l)
            .count()
    );
    println!("{} boxes, {:?}", audit.boxes, begin.elapsed());
}
