//! A controller that flies without the others of its scenario.

use fspid_scenario::tuning::TunableParameter;

/// Who flies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flyer<'a> {
    /// Name of the controller.
    pub(crate) controller: &'a str,
    /// Places that get other values in flight; none where the scenario flies as its marks start.
    pub(crate) free: &'a [TunableParameter],
}
