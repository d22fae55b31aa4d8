//! What the supervisor sees of a loop's state.

use fspid_core::{Change, Fspid};
use fspid_numeric::scalar::Base;
use fspid_sim::loop_model::LoopModel;

/// Rows from the state to what the supervisor sees of error and change, but for the sign that both share.
pub(crate) fn input_rows<T: Base>(model: &LoopModel<T>, fspid: &Fspid<f64>) -> [Vec<T>; 2] {
    let settings = fspid.tuner().settings();
    let time_s = match settings.change {
        Change::Rate => T::constant(model.settings().config.dt_s),
        Change::Delta => T::one(),
    };
    let by_error = T::constant(settings.input_scale.error_per_rad);
    let by_change = T::constant(settings.input_scale.change_per_rad) / time_s;
    let [error, change] = model.error_rows();
    let scaled = |row: Vec<T>, factor: T| row.into_iter().map(|entry| factor * entry).collect();
    [scaled(error, by_error), scaled(change, by_change)]
}
