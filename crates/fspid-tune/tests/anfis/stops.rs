//! Why learning ends.

use fspid_tune::anfis::{Curve, Order, Plan, Stop, grid};

use crate::anfis::{axis, learned, samples};

#[test]
fn learning_ends_at_the_error_that_is_enough() {
    let data = samples(0.0, 3.0, 31, |x| libm::sin(2.0 * x));
    let start = grid(&[axis("x", 0.0, 3.0, 3)], &["y"], Curve::Gaussian, Order::One);
    let free = learned(&start, &data, &Plan { epochs: 40, ..Plan::default() });
    let enough = free.best().training;
    let found = learned(&start, &data, &Plan { epochs: 40, enough, ..Plan::default() });
    assert_eq!((found.stop, found.best), (Stop::Enough, free.best));
    assert!(found.best > 3 && found.history == free.history[..=free.best]);
}

#[test]
fn learning_ends_where_the_rows_that_judge_find_nothing_better() {
    // A line, and beside it a number that belongs to no x: more sets learn it by heart.
    let noise = |x: f64| libm::sin(1e4 * x * x);
    let data = samples(0.0, 1.0, 40, |x| x + 0.3 * noise(x));
    let start = grid(&[axis("x", 0.0, 1.0, 6)], &["y"], Curve::Gaussian, Order::One);
    let plan = Plan { epochs: 200, validation_share: 0.4, patience: 10, ..Plan::default() };
    let found = learned(&start, &data, &plan);
    assert_eq!(found.stop, Stop::Patience);
    assert_eq!(found.history.len(), found.best + 11);
    let (best, last) = (found.best(), found.history[found.history.len() - 1]);
    assert!(best.validation <= last.validation && last.training <= best.training, "{found:?}");
}

#[test]
fn learning_ends_where_nothing_that_moves_changes_the_error() {
    // One set alone fires with its whole share wherever it lies.
    let mut start = grid(&[axis("x", 0.0, 1.0, 2)], &["y"], Curve::Gaussian, Order::One);
    start.blocks[0].rules.truncate(1);
    let data = samples(0.0, 1.0, 11, |x| x * x);
    let found = learned(&start, &data, &Plan::default());
    assert_eq!((found.stop, found.history.len()), (Stop::Flat, 1));
}

#[test]
fn learning_ends_where_the_step_has_become_short() {
    let data = samples(0.0, 1.0, 31, |x| libm::sin(9.0 * x));
    let start = grid(&[axis("x", 0.0, 1.0, 3)], &["y"], Curve::Gaussian, Order::Zero);
    let plan = Plan { epochs: 2000, step: 0.5, least_step: 0.3, ..Plan::default() };
    let found = learned(&start, &data, &plan);
    assert_eq!(found.stop, Stop::ShortStep);
    assert!(found.history[found.history.len() - 1].step < 0.3);
}
