//! How much has been done to read a text: characters passed and names looked at.
//!
//! Tests hold this against the length of the text. A clock would tell how busy the machine is as
//! well; work is the same on every machine. Outside of tests nothing is counted.

#[cfg(test)]
std::thread_local! {
    static DONE: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// Counts work, which tests hold to be linear in the length of a text.
#[inline]
pub(crate) fn add(_more: usize) {
    #[cfg(test)]
    DONE.set(DONE.get() + _more as u64);
}

/// What `action` does, and how much that is.
#[cfg(test)]
pub(crate) fn of<T>(action: impl FnOnce() -> T) -> (T, u64) {
    let before = DONE.get();
    let answer = action();
    (answer, DONE.get() - before)
}

#[cfg(test)]
mod tests;
