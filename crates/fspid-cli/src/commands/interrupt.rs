//! Ctrl-C, and memory that has grown too large: long work stops where it can go on, and says how.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use fspid_study::shell;

use crate::exit::{self, Failure, note};

/// What is told of work that ends at once and says nothing else.
const ENDED: &str = "interrupted";

/// Whether the user wants to stop.
static ASKED: AtomicBool = AtomicBool::new(false);
/// What is told where work ends at once; None where it stops by itself once it is asked to.
static AT_ONCE: Mutex<Option<String>> = Mutex::new(None);

/// Ctrl-C ends the program as every failure does, in words and as JSON, unless a command says otherwise.
pub(crate) fn listen() {
    ends_with(ENDED.to_owned());
    hold_back_full_files();
    // Where it cannot be heard, the program ends as any other does.
    let _ = ctrlc::set_handler(heard);
}

/// A file that grows beyond the limit of the shell is an error where it is written, as a full disk is; the signal that
/// comes with it would end the program there, with nothing told and its new file left.
fn hold_back_full_files() {
    #[cfg(unix)]
    {
        use nix::sys::signal::{SigSet, Signal};
        let mut held = SigSet::empty();
        held.add(Signal::SIGXFSZ);
        // Threads that begin later have it from this one.
        let _ = held.thread_block();
    }
}

fn heard() {
    // Off the line of the progress.
    note("");
    stop("; Ctrl-C again ends at once");
}

/// Stops as Ctrl-C does, for a reason that is told.
pub(crate) fn ask(reason: String) {
    note("");
    exit::stops_for(reason);
    stop("");
}

fn stop(hint: &str) {
    let at_once = AT_ONCE.lock().ok().and_then(|told| told.clone());
    let again = || ASKED.swap(true, Ordering::Relaxed).then(|| ENDED.to_owned());
    let Some(told) = at_once.or_else(again) else {
        note(format_args!(
            "stopping{}{hint}",
            exit::reason().map_or(String::new(), |it| format!(": {it}"))
        ));
        return;
    };
    let failure = Failure::interrupted(told);
    failure.tell();
    std::process::exit(i32::from(failure.code()));
}

/// Ctrl-C is told to [`asked`] from here on; a second one ends the program at once.
pub(crate) fn watch() {
    set(None);
}

/// Ctrl-C ends the program at once, with these words.
pub(crate) fn ends_with(words: String) {
    set(Some(words));
}

fn set(words: Option<String>) {
    if let Ok(mut told) = AT_ONCE.lock() {
        *told = words;
    }
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
