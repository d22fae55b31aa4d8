//! What cannot be learned, and how it is told.

use fspid_fuzzy::system::Parts;
use fspid_fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_scenario::file::rule_table;
use fspid_tune::anfis::{AnfisError, Curve, Data, Order, Plan, grid, learn, sugeno};

use crate::anfis::{axis, samples};

fn start() -> Parts {
    grid(&[axis("x", 0.0, 1.0, 2)], &["y"], Curve::Triangle, Order::One)
}

fn read(table: &str) -> Result<Data, AnfisError> {
    Data::read(&start(), &mut table.as_bytes())
}

#[test]
fn a_table_is_read_by_the_names_of_its_columns() {
    let data = read("y,other,x\n1.5,a,0.25\n\n-2,b,1e-1\n").expect("a table");
    let rows: Vec<(f64, f64)> = data.rows().map(|row| (row.inputs[0], row.outputs[0])).collect();
    assert_eq!(rows, [(0.25, 1.5), (0.1, -2.0)]);
}

#[test]
fn numbers_that_are_not_finite_are_refused_with_their_lines() {
    let error = read("x,y\n0.5,1\nNaN,1\n0.5,\n1,-inf\n").expect_err("three lines are wrong");
    let AnfisError::Table { problems } = &error else { panic!("{error}") };
    assert_eq!(problems.len(), 3, "{problems:?}");
    assert!(problems[0].starts_with("3: x is NaN; allowed is a finite number"), "{problems:?}");
    assert!(problems[1].starts_with("4: y is ``"), "{problems:?}");
    assert!(problems[2].starts_with("5: y is -inf"), "{problems:?}");
    let mut data = Data::new(1, 1);
    let refused = data.push(&[0.0], &[f64::NAN]);
    assert!(matches!(refused, Err(AnfisError::NotFinite { row: 1, .. })));
    let refused = data.push(&[0.0, 1.0], &[1.0]);
    assert_eq!(refused, Err(AnfisError::Width { row: 1, found: 3, needed: 2 }));
}

#[test]
fn a_table_without_a_column_is_refused_by_its_heading() {
    let error = read("x,z\n0.5,1\n").expect_err("no y").to_string();
    assert!(error.contains("1: the heading is `x,z`; it must name the columns x and y"), "{error}");
    let missing = Data::load(&start(), std::path::Path::new("not-there.csv"));
    let error = missing.expect_err("no file").to_string();
    assert!(error.starts_with("not-there.csv: "), "{error}");
}

#[test]
fn a_system_whose_conclusions_are_sets_is_refused_until_they_are_replaced() {
    let table = rule_table("printed").expect("it is carried");
    let supervisor = Supervisor::new(&table, 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let parts = Parts::try_from(&supervisor.expect("allowed")).expect("rules");
    let data = Data::taught(&parts, &[3, 3]).expect("a teacher");
    let refused = learn(&parts, &data, &Plan::default()).expect_err("sets").to_string();
    assert!(refused.starts_with("output `delta_kp`: its conclusions are not joined"), "{refused}");
    let plan = Plan { premises: false, ..Plan::default() };
    assert!(learn(&sugeno(&parts, Order::Zero), &data, &plan).is_ok());
}

#[test]
fn a_row_that_no_rule_covers_is_named_by_its_number() {
    let data = samples(0.0, 3.0, 4, |x| x);
    let refused = learn(&start(), &data, &Plan::default());
    // The set at 1 ends at 2, where its grade is 0.
    assert_eq!(refused, Err(AnfisError::NotCovered { row: 3 }));
    let mut strict = start();
    strict.inputs[0].out_of_range = OutOfRange::Error;
    let refused = learn(&strict, &data, &Plan::default()).expect_err("out of range").to_string();
    assert!(refused.starts_with("data row 3: "), "{refused}");
}

#[test]
fn data_that_do_not_fit_and_plans_that_make_no_sense_are_refused() {
    let refused = |data: &Data, plan: &Plan| learn(&start(), data, plan).expect_err("refused");
    let good = samples(0.0, 1.0, 11, |x| x);
    assert_eq!(
        refused(&Data::new(1, 1), &Plan::default()),
        AnfisError::NoData { what: "learn from" }
    );
    let wide = refused(&Data::new(2, 1), &Plan::default());
    assert_eq!(wide, AnfisError::Width { row: 1, found: 3, needed: 2 });
    let plans = [
        Plan { epochs: 0, ..Plan::default() },
        Plan { step: f64::NAN, ..Plan::default() },
        Plan { step: 0.0, ..Plan::default() },
        Plan { regularisation: 0.0, ..Plan::default() },
        Plan { enough: -1.0, ..Plan::default() },
        Plan { validation_share: 1.0, ..Plan::default() },
        Plan { patience: 0, ..Plan::default() },
    ];
    for plan in plans {
        let error = refused(&good, &plan);
        assert!(matches!(error, AnfisError::Plan { .. } | AnfisError::Count(_)), "{error}");
    }
    let mut huge = Data::new(1, 1);
    for k in 0..9 {
        huge.push(&[0.1 * f64::from(k)], &[1e300 * f64::from(k * k)]).expect("finite");
    }
    let error = refused(&huge, &Plan::default());
    assert!(matches!(error, AnfisError::Overflow), "{error}");
}

#[test]
fn a_grid_needs_universes_and_at_least_two_points_an_input() {
    let mut teacher = start();
    let wrong = Data::taught(&teacher, &[1]).expect_err("one point").to_string();
    assert!(wrong.contains("allowed are 1 counts of at least 2"), "{wrong}");
    assert!(matches!(Data::taught(&teacher, &[2, 2]), Err(AnfisError::Grid { .. })));
    assert!(matches!(Data::taught(&teacher, &[2_000_000]), Err(AnfisError::Grid { .. })));
    teacher.inputs[0].universe = None;
    let wrong = Data::taught(&teacher, &[3]);
    assert_eq!(wrong, Err(AnfisError::NoUniverse { input: "x".to_owned() }));
}

#[test]
fn a_share_that_leaves_no_row_to_learn_from_is_told_with_the_rows() {
    for (share, rows) in [(0.999, 41), (0.5, 1)] {
        let mut data = Data::new(1, 1);
        for k in 0..rows {
            data.push(&[f64::from(k) / 41.0], &[1.0]).expect("finite");
        }
        let plan = Plan { validation_share: share, ..Plan::default() };
        let refused = learn(&start(), &data, &plan).expect_err("none is left").to_string();
        let told = format!("of {rows} row(s) a share of {share} judges");
        assert!(refused.starts_with(&told), "{refused}");
    }
    let none = learn(&start(), &Data::new(1, 1), &Plan::default()).expect_err("no rows");
    assert_eq!(none, AnfisError::NoData { what: "learn from" });
}
