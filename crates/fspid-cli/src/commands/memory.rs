//! `--max-memory`: what a command may take, asked before its flights and watched while it works.

use std::num::NonZero;
use std::str::FromStr;
use std::sync::OnceLock;
use std::thread;
use std::time::Duration;

use fspid_study::memory::{MIB, Needed, available_bytes, mebibytes, resident_bytes};

use super::interrupt;
use crate::exit::Failure;

/// How often the memory of the program is looked at.
const TICK: Duration = Duration::from_millis(20);
/// Work that stops by itself may take so much more until it has; then it is ended.
const TO_STOP: f64 = 1.25;

/// What the program may take; None where nobody says.
static MOST: OnceLock<u64> = OnceLock::new();

/// A size of memory, as it is written on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size(u64);

/// Endings of a size, and how many bytes they are.
const UNITS: [(&str, f64); 4] =
    [("GiB", 1024.0 * MIB as f64), ("MiB", MIB as f64), ("GB", 1e9), ("MB", 1e6)];
/// Neither is of any use: less than the program itself, and more than any machine has.
const LEAST: f64 = MIB as f64;
const MOST_BYTES: f64 = 1024.0 * 1024.0 * 1024.0 * MIB as f64;

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = UNITS.iter().find_map(|(unit, bytes)| Some((text.strip_suffix(unit)?, bytes)));
        let bytes =
            parts.and_then(|(number, unit)| Some(number.trim().parse::<f64>().ok()? * unit));
        match bytes {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "between the least and the most"
            )]
            Some(bytes) if (LEAST..=MOST_BYTES).contains(&bytes) => Ok(Self(bytes as u64)),
            _ => Err("a size is a number and MiB, GiB, MB or GB, such as 512MiB or 1.5GB, from 1MiB to 1048576GiB".to_owned()),
        }
    }
}

/// The program may take so much, from here on.
pub(crate) fn allow(most: Option<Size>) {
    let Some(Size(most)) = most else { return };
    if MOST.set(most).is_ok() {
        // Ends with the program.
        thread::spawn(move || watch(most));
    }
}

/// Stops the work when the program has grown too large, and ends it where it goes on growing.
fn watch(most: u64) {
    let mut allowed = most;
    // Where the system does not tell, the estimate is all there is.
    while let Some(bytes) = resident_bytes() {
        if bytes > allowed {
            interrupt::ask(format!(
                "the program has grown to {} of memory, and --max-memory allows {}",
                mebibytes(bytes),
                mebibytes(most)
            ));
            allowed = (most as f64 * TO_STOP) as u64;
        }
        thread::sleep(TICK);
    }
}

/// So many threads; of 0 as many as the machine has.
pub(crate) fn threads(asked: usize) -> usize {
    let of_machine = || thread::available_parallelism().map_or(1, NonZero::get);
    if asked == 0 { of_machine() } else { asked }
}

/// Refuses flights that ask for more than the program may take, or than the machine has left.
pub(crate) fn asked(needed: Needed) -> Result<(), Failure> {
    const LESS: &str = "a shorter flight, a longer sample period, and less at once or kept (threads, controllers, cases, candidates, runs of a shard) take less";
    let needed = needed.with_program();
    let allowed = match MOST.get() {
        Some(most) => Some((*most, "--max-memory allows")),
        None => available_bytes().map(|bytes| (bytes, "this machine has no more left than")),
    };
    match allowed {
        Some((most, who)) if needed.bytes() > most => {
            let most = mebibytes(most);
            let instead = if MOST.get().is_some() { "" } else { "; --max-memory SIZE allows it" };
            Err(Failure::input(format_args!("{needed}; {who} {most}: {LESS}{instead}")))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_a_number_and_its_unit() {
        let bytes = |text: &str| text.parse::<Size>().map(|Size(bytes)| bytes);
        assert_eq!(bytes("512MiB"), Ok(512 << 20));
        assert_eq!(bytes("1.5 GiB"), Ok(3 << 29));
        assert_eq!(bytes("2GB"), Ok(2_000_000_000));
        for wrong in [
            "", "512", "MiB", "-1GiB", "0MiB", "nanGiB", "infGB", "1e300GiB", "1kB", "64M", "2 gib",
        ] {
            assert!(bytes(wrong).is_err_and(|told| told.contains("512MiB")), "{wrong}");
        }
    }
}
