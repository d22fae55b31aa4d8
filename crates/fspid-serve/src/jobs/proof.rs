//! What all work on proofs shares: that it stops where its job does.

use std::cell::RefCell;

use super::task::{Stopping, Task};

thread_local! {
    /// The job that this thread works on. A search for a proof and a check ask a plain function whether they shall stop, and
    /// stay on the thread that they began on.
    static STOPPING: RefCell<Option<Stopping>> = const { RefCell::new(None) };
}

/// Whether the job of this thread shall stop.
pub(super) fn stops() -> bool {
    STOPPING.with_borrow(|stopping| stopping.as_ref().is_some_and(Stopping::is_asked))
}

/// Does work that asks [`stops`].
pub(super) fn stopped_with<T>(task: &Task<'_>, work: impl FnOnce() -> T) -> T {
    STOPPING.replace(Some(task.stopping.clone()));
    let done = work();
    STOPPING.replace(None);
    done
}
