//! Flights that wait for actions: environments of Gymnasium, one by one and many at once.

mod many;
mod one;
mod setting;

pub(crate) use many::Environments;
pub(crate) use one::Environment;
