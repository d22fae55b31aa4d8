//! Examples of publications, and the paper's supervisor as a system of Takagi and Sugeno.

use fspid_fuzzy::system::{Parts, System};
use fspid_fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_scenario::file::rule_table;
use fspid_tune::anfis::{Curve, Data, Order, Plan, grid, learn_beside, sugeno};

use crate::anfis::{answer, axis, learned};

/// Jang's example 2: (1 + √x + 1/y + z^-1.5)² at every place of a cube of evenly spaced points.
fn cube(first: f64, count: u32) -> Data {
    let mut data = Data::new(3, 1);
    for index in 0..count.pow(3) {
        let at = |k: u32| first + f64::from(k);
        let (x, y, z) = (at(index / count / count), at(index / count % count), at(index % count));
        let sum = 1.0 + x.sqrt() + 1.0 / y + 1.0 / (z * z.sqrt());
        data.push(&[x, y, z], &[sum * sum]).expect("finite");
    }
    data
}

/// Mean of the error over the answer, per cent.
fn percentage_error(parts: &Parts, data: &Data) -> f64 {
    let error = |row: fspid_tune::anfis::DataRow<'_>| {
        ((answer(parts, row.inputs) - row.outputs[0]) / row.outputs[0]).abs()
    };
    100.0 * data.rows().map(error).sum::<f64>() / data.len() as f64
}

/// Jang (1993), example 2: two bells an input, 8 rules, 50 numbers, 216 rows to learn from and 125 to check, 200 epochs.
/// He prints errors of 0.043 % and 1.066 %; the earlier models that he compares with have 0.59 % and 2.1 % at best.
/// Ours: 0.033 % and 0.22 %. His steps are measured in the inputs' own unit and his least squares are recursive, so that
/// the way is another one.
#[test]
fn jangs_three_inputs_are_learned_as_well_as_he_prints() {
    let (training, checking) = (cube(1.0, 6), cube(1.5, 5));
    let axes = ["x", "y", "z"].map(|name| axis(name, 1.0, 6.0, 2));
    let start = grid(&axes, &["output"], Curve::Bell, Order::One);
    let plan = Plan { epochs: 200, ..Plan::default() };
    let found = learn_beside(&start, &training, None, &plan).expect("it is learned");
    let errors =
        (percentage_error(&found.parts, &training), percentage_error(&found.parts, &checking));
    assert!(errors.0 < 0.043 && errors.1 < 1.066, "{errors:?}");
    // Our own, for whoever changes the way.
    assert!((errors.0 - 0.033).abs() < 0.001 && (errors.1 - 0.219).abs() < 0.002, "{errors:?}");
}

/// sin(x)/x · sin(y)/y on 11 by 11 points of [-10, 10]², Jang's example 1. The package `anfis` for R prints 0.01916307
/// for five Gaussian sets an input after 10 epochs.
#[test]
fn the_product_of_two_sincs_is_learned_as_well_as_another_tool_does() {
    let sinc = |x: f64| if x.abs() > 0.0 { libm::sin(x) / x } else { 1.0 };
    let mut data = Data::new(2, 1);
    for index in 0..121 {
        let (x, y) = (f64::from(index / 11 * 2 - 10), f64::from(index % 11 * 2 - 10));
        data.push(&[x, y], &[sinc(x) * sinc(y)]).expect("finite");
    }
    let axes = |terms| [axis("x", -10.0, 10.0, terms), axis("y", -10.0, 10.0, terms)];
    let five = grid(&axes(5), &["z"], Curve::Gaussian, Order::One);
    let found = learned(&five, &data, &Plan { epochs: 10, ..Plan::default() });
    assert!(found.best().training < 0.019_163_07, "{:?}", found.best());
    // Jang's own structure, of which he prints a curve without numbers.
    let four = grid(&axes(4), &["z"], Curve::Bell, Order::One);
    let found = learned(&four, &data, &Plan { epochs: 100, ..Plan::default() });
    let (first, last) = (found.history[0].training, found.best().training);
    assert!(last < 0.3 * first, "{first} to {last}");
}

#[test]
fn the_papers_supervisor_is_taught_to_a_system_of_numbers() {
    let table = rule_table("printed").expect("it is carried");
    let supervisor = Supervisor::new(&table, 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let teacher = Parts::try_from(&supervisor.expect("allowed")).expect("rules");
    let data = Data::taught(&teacher, &[15, 15]).expect("a teacher");
    // Other points, so that what was learned by heart does not count.
    let between = Data::taught(&teacher, &[22, 22]).expect("a teacher");
    for (order, most) in [(Order::Zero, 0.12), (Order::One, 0.07)] {
        let start = sugeno(&teacher, order);
        let plan = Plan { epochs: 8, ..Plan::default() };
        let found = learn_beside(&start, &data, Some(&between), &plan).expect("it is learned");
        let (first, best) = (found.history[0], found.best());
        assert!(best.validation <= first.validation, "{first:?} to {best:?}");
        assert!(best.validation < Some(most), "{best:?}");
        assert_eq!(found.parts.outputs.len(), 3);
        assert!(System::new(found.parts).is_ok());
    }
}
