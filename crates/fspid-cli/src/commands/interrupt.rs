//! Ctrl-C: long work stops where it can go on, and says how.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use fspid_study::shell;

use crate::exit::{Failure, note};

/// Whether the user wants to stop.
static ASKED: AtomicBool = AtomicBool::new(false);
/// What is told where work ends at once, because what is whole stays.
static AT_ONCE: Mutex<Option<String>> = Mutex::new(None);

/// Ctrl-C is told to [`asked`] from here on; a second one ends the program at once.
pub(crate) fn watch() {
    // Where it cannot be watched, the program ends as any other does.
    let _ = ctrlc::set_handler(|| {
        let told = AT_ONCE.lock().ok().and_then(|told| told.clone());
        if let Some(told) = &told {
            note(format_args!("\nfspid: {told}"));
        }
        if told.is_some() || ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(Failure::INTERRUPTED));
        }
        note("\nstopping after this generation; Ctrl-C again ends at once");
    });
}

/// Ctrl-C ends the program at once, after these words.
pub(crate) fn ends_with(words: String) {
    if let Ok(mut told) = AT_ONCE.lock() {
        *told = Some(words);
    }
    watch();
}

/// True once the user has asked to stop.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// The command as a shell takes it.
pub(crate) fn command() -> String {
    let words = std::env::args_os().skip(1);
    let words = words.map(|word| shell::word(&word.to_string_lossy()));
    std::iter::once("fspid".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}
