//! Learning from data: known systems are found again, published examples are as good as published, bad data are refused.
#![allow(clippy::float_cmp, reason = "the same bits are asked for")]

mod examples;
mod recovery;
mod refused;
mod rules_kept;
mod stops;

use fspid_fuzzy::system::{Parameter, Parts, System, Universe};
use fspid_tune::anfis::{Axis, Curve, Data, DataRow, Learned, Order, Plan, grid, learn};

fn axis(name: &str, lower: f64, upper: f64, terms: usize) -> Axis {
    Axis { name: name.to_owned(), universe: Universe { lower, upper }, terms }
}

fn learned(start: &Parts, data: &Data, plan: &Plan) -> Learned {
    learn(start, data, plan).unwrap_or_else(|error| panic!("{error}"))
}

/// A system of two inputs with conclusions that no formula repeats.
fn teacher(curve: Curve) -> Parts {
    let axes = [axis("x", -1.0, 1.0, 3), axis("y", 0.0, 4.0, 2)];
    let mut parts = grid(&axes, &["z"], curve, Order::One);
    for (index, parameter) in parts.parameters().into_iter().enumerate() {
        if let Parameter::Constant { .. } | Parameter::Coefficient { .. } = parameter {
            parts.set_parameter(parameter, libm::sin(1.0 + 3.7 * index as f64));
        }
    }
    parts
}

/// Rows of a function on an even grid over one input.
fn samples(lower: f64, upper: f64, count: u32, function: impl Fn(f64) -> f64) -> Data {
    let mut data = Data::new(1, 1);
    for k in 0..count {
        let x = lower + (upper - lower) * f64::from(k) / f64::from(count - 1);
        data.push(&[x], &[function(x)]).expect("finite");
    }
    data
}

/// The first answer of a system.
fn answer(parts: &Parts, inputs: &[f64]) -> f64 {
    let system = System::new(parts.clone()).expect("what was learned is a system");
    let mut workspace = system.workspace();
    let answers = system.evaluate(inputs, &mut workspace).expect("finite inputs");
    answers[0].value.expect("a rule fires")
}

/// The error of an epoch, worked out from the answers themselves.
fn root_mean_square(parts: &Parts, data: &Data) -> f64 {
    let square = |row: DataRow<'_>| {
        let error = answer(parts, row.inputs) - row.outputs[0];
        error * error
    };
    (data.rows().map(square).sum::<f64>() / data.len() as f64).sqrt()
}
