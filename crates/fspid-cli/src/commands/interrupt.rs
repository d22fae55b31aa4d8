//! Ctrl-C, SIGTERM, and memory that has grown too large: long work stops where it can go on, and says how.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use fspid_study::shell;

use crate::exit::{self, Failure, note};

/// What is told of work that ends at once and says nothing else.
const ENDED: &str = "interrupted";

/// Whether the user wants to stop.
static ASKED: AtomicBool = AtomicBool::new(false);
/// Since when, to be told from what is only heard twice.
static SINCE: Mutex<Option<Instant>> = Mutex::new(None);
/// A key that is held down, and a terminal that closes, which is told by the system and by a shell, ask once. Who presses again
/// after this does not want to wait for what is given back or kept.
const PATIENCE: Duration = Duration::from_millis(500);
/// What is told where work ends at once; None where it stops by itself once it is asked to.
static AT_ONCE: Mutex<Option<String>> = Mutex::new(None);

/// Ctrl-C ends the program as every failure does, in words and as JSON, unless a command says otherwise; so do SIGTERM
/// and a terminal that closes.
pub(crate) fn listen() {
    ends_with(ENDED.to_owned());
    // Where it cannot be heard, the program ends as any other does.
    #[cfg(unix)]
    let _ = signals::listen();
    #[cfg(windows)]
    let _ = ctrlc::set_handler(|| heard(true));
}

#[cfg(unix)]
mod signals {
    use std::io;
    use std::sync::Arc;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::flag;
    use signal_hook::iterator::Signals;

    /// Hears every signal that asks the program to end.
    ///
    /// A terminal that closes is left alone where whoever started the program ignores it, as `nohup` does. The others are
    /// heard all the same: what starts a program in the background ignores Ctrl-C for it, and has no other way to stop it
    /// that keeps what it did.
    ///
    /// What it starts does not inherit this, as it would signals that are held back.
    pub(super) fn listen() -> io::Result<()> {
        // A file that grows beyond the limit of the shell is an error where it is written, as a full disk is; the signal
        // that comes with it would end the program there, with nothing told and its new file left.
        flag::register(SIGXFSZ, Arc::default())?;
        let mut signals = Signals::new([SIGINT, SIGTERM])?;
        if !ignores(SIGHUP) {
            signals.handle().add_signal(SIGHUP)?;
        }
        std::thread::Builder::new().name("signals".into()).spawn(move || {
            for signal in signals.forever() {
                super::heard(signal == SIGINT);
            }
        })?;
        Ok(())
    }

    /// Whether whoever started the program ignores a signal, as Linux tells it. Where nobody tells it may be so.
    fn ignores(signal: i32) -> bool {
        let told = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = told.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
            .is_none_or(|mask| mask >> (signal - 1) & 1 == 1)
    }
}

/// Somebody wants the program to end: at the keys, or from elsewhere.
fn heard(at_the_keys: bool) {
    // Off the line of the progress.
    note("");
    let waited = asked_for();
    stop("; Ctrl-C again ends at once", at_the_keys && waited >= PATIENCE);
}

/// Stops as Ctrl-C does, for a reason that is told; where that was asked for already, at once.
pub(crate) fn ask(reason: String) {
    note("");
    exit::stops_for(reason);
    stop("", asked());
}

/// Since when somebody wants to stop.
fn asked_for() -> Duration {
    let mut since = SINCE.lock().unwrap_or_else(PoisonError::into_inner);
    since.get_or_insert_with(Instant::now).elapsed()
}

fn stop(hint: &str, insists: bool) {
    let at_once = AT_ONCE.lock().ok().and_then(|told| told.clone());
    let Some(told) = at_once.or_else(|| insists.then(|| ENDED.to_owned())) else {
        if ASKED.swap(true, Ordering::Relaxed) {
            return;
        }
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

/// Ctrl-C is told to [`asked`] from here on; another one, half a second later, ends the program at once.
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
