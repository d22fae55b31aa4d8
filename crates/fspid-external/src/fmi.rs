//! FMUs for co-simulation, FMI 2.0 and 3.0: where their C is called.
#![allow(unsafe_code, reason = "calling C is; every call says why it may be made")]

use std::ffi::{CString, c_char, c_int, c_void};
use std::os::unix::ffi::OsStrExt as _;
use std::path::Path;
use std::ptr::{null, null_mut};

use libloading::Library;

use crate::description::{Description, Version};
use crate::library::{Refusal, function, words};

/// The worst status with which there is an answer: a warning.
const WARNING: c_int = 1;
/// A step that was not done whole.
const DISCARD: c_int = 2;
/// Behind this status an instance can only be freed, and behind the next nothing is left that may be called.
const ERROR: c_int = 3;
const FATAL: c_int = 4;
/// `fmi2CoSimulation`.
const CO_SIMULATION: c_int = 1;

type Instance = *mut c_void;
type Status = c_int;

/// A status that ends a flight.
pub(crate) type Failure = c_int;

fn ok(status: Status) -> Result<(), Failure> {
    if (0..=WARNING).contains(&status) { Ok(()) } else { Err(status) }
}

/// `fmi2CallbackFunctions`.
#[repr(C)]
struct Callbacks {
    logger: unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char),
    allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free: unsafe extern "C" fn(*mut c_void),
    step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    environment: *mut c_void,
}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

/// Logging is off; what is told all the same is passed over. The arguments that vary are never looked at.
unsafe extern "C" fn silent(
    _: *mut c_void,
    _: *const c_char,
    _: c_int,
    _: *const c_char,
    _: *const c_char,
) {
}

unsafe extern "C" fn silent_three(_: *mut c_void, _: c_int, _: *const c_char, _: *const c_char) {}

struct Two {
    set_real: unsafe extern "C" fn(Instance, *const u32, usize, *const f64) -> Status,
    get_real: unsafe extern "C" fn(Instance, *const u32, usize, *mut f64) -> Status,
    get_integer: unsafe extern "C" fn(Instance, *const u32, usize, *mut c_int) -> Status,
    get_boolean: unsafe extern "C" fn(Instance, *const u32, usize, *mut c_int) -> Status,
    do_step: unsafe extern "C" fn(Instance, f64, f64, c_int) -> Status,
}

type StepThree = unsafe extern "C" fn(
    Instance,
    f64,
    f64,
    bool,
    *mut bool,
    *mut bool,
    *mut bool,
    *mut f64,
) -> Status;

struct Three {
    set_real: unsafe extern "C" fn(Instance, *const u32, usize, *const f64, usize) -> Status,
    get_real: unsafe extern "C" fn(Instance, *const u32, usize, *mut f64, usize) -> Status,
    get_integer: unsafe extern "C" fn(Instance, *const u32, usize, *mut i32, usize) -> Status,
    get_boolean: unsafe extern "C" fn(Instance, *const u32, usize, *mut bool, usize) -> Status,
    do_step: StepThree,
}

/// What an instance is left with. Libraries that lack them fly as well.
struct Leaving {
    terminate: Option<unsafe extern "C" fn(Instance) -> Status>,
    free: Option<unsafe extern "C" fn(Instance)>,
}

impl Leaving {
    fn of(library: &Library, version: Version) -> Self {
        let [terminate, free] = match version {
            Version::Two => ["fmi2Terminate", "fmi2FreeInstance"],
            Version::Three => ["fmi3Terminate", "fmi3FreeInstance"],
        };
        Self { terminate: function(library, terminate).ok(), free: function(library, free).ok() }
    }
}

enum Calls {
    Two(Two),
    Three(Three),
}

/// An instance, stepping.
pub(crate) struct Fmu {
    calls: Calls,
    instance: Instance,
    leaving: Leaving,
    /// The worst status so far.
    worst: Status,
    /// Functions and callbacks are called for as long as the instance lives.
    _kept: (Library, Box<Callbacks>, [CString; 3]),
}

/// Texts that live as long as an instance: its name, token and folder of resources.
fn texts(description: &Description, folder: &Path) -> Result<[CString; 3], Refusal> {
    let resources = folder.join("resources");
    let resources = match description.version {
        Version::Two => uri(&resources),
        Version::Three => format!("{}/", resources.display()),
    };
    let text = |text: &str| {
        CString::new(text).map_err(|_| ("has a zero in a text".to_owned(), "a text".to_owned()))
    };
    Ok([text("controller")?, text(&description.token)?, text(&resources)?])
}

/// The address of a folder as RFC 3986 writes it: what has a meaning there, or is no letter, by its number.
fn uri(folder: &Path) -> String {
    use std::fmt::Write as _;
    let mut text = "file://".to_owned();
    for byte in folder.as_os_str().as_bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'/' | b'-' | b'.' | b'_' | b'~' => {
                text.push(char::from(*byte));
            }
            // Writing into a text cannot fail.
            _ => drop(write!(text, "%{byte:02X}")),
        }
    }
    text
}

impl Fmu {
    /// Loads the library of an FMU that is unpacked in a folder, and takes an instance to time 0.
    pub(crate) fn load(
        path: &Path,
        description: &Description,
        folder: &Path,
    ) -> Result<Self, Refusal> {
        // SAFETY: what runs while it is loaded is the user's own code, in a process that has nothing else to lose.
        let library = unsafe { Library::new(path) }.map_err(|error| {
            let allowed = "an FMU with a library for this machine".to_owned();
            (format!("cannot be loaded: {}", words(&error)), allowed)
        })?;
        let environment = null_mut();
        let callbacks =
            Callbacks { logger: silent, allocate: calloc, free, step_finished: None, environment };
        let kept = (library, Box::new(callbacks), texts(description, folder)?);
        let (calls, instance) = match description.version {
            Version::Two => two(&kept)?,
            Version::Three => three(&kept)?,
        };
        let leaving = Leaving::of(&kept.0, description.version);
        Ok(Self { calls, instance, leaving, worst: 0, _kept: kept })
    }

    /// What a status means, kept for the end.
    fn ok(&mut self, status: Status) -> Result<(), Failure> {
        // A status that the standard has not is as bad as any.
        self.worst = if (0..=FATAL).contains(&status) { self.worst.max(status) } else { FATAL };
        ok(status)
    }

    /// Sets one real.
    pub(crate) fn set(&mut self, reference: u32, value: f64) -> Result<(), Failure> {
        // SAFETY: the instance lives; both arrays have the one entry that is said, and live through the call. The same
        // holds of the next three.
        let status = unsafe {
            match &self.calls {
                Calls::Two(two) => (two.set_real)(self.instance, &reference, 1, &value),
                Calls::Three(three) => (three.set_real)(self.instance, &reference, 1, &value, 1),
            }
        };
        self.ok(status)
    }

    /// Asks for a real.
    pub(crate) fn real(&mut self, reference: u32) -> Result<f64, Failure> {
        let mut value = f64::NAN;
        // SAFETY: as in `set`.
        let status = unsafe {
            match &self.calls {
                Calls::Two(two) => (two.get_real)(self.instance, &reference, 1, &mut value),
                Calls::Three(three) => {
                    (three.get_real)(self.instance, &reference, 1, &mut value, 1)
                }
            }
        };
        self.ok(status)?;
        Ok(value)
    }

    /// Asks for a whole number.
    pub(crate) fn whole(&mut self, reference: u32) -> Result<i32, Failure> {
        let mut value = 0;
        // SAFETY: as in `set`.
        let status = unsafe {
            match &self.calls {
                Calls::Two(two) => (two.get_integer)(self.instance, &reference, 1, &mut value),
                Calls::Three(three) => {
                    (three.get_integer)(self.instance, &reference, 1, &mut value, 1)
                }
            }
        };
        self.ok(status)?;
        Ok(value)
    }

    /// Asks for a truth.
    pub(crate) fn truth(&mut self, reference: u32) -> Result<bool, Failure> {
        let (mut whole, mut truth) = (0, false);
        // SAFETY: as in `set`.
        let status = unsafe {
            match &self.calls {
                Calls::Two(two) => (two.get_boolean)(self.instance, &reference, 1, &mut whole),
                Calls::Three(three) => {
                    (three.get_boolean)(self.instance, &reference, 1, &mut truth, 1)
                }
            }
        };
        self.ok(status)?;
        Ok(truth || whole != 0)
    }

    /// Goes from a time on by a step, s.
    pub(crate) fn step(&mut self, time_s: f64, step_s: f64) -> Result<(), Failure> {
        let (mut event, mut over, mut early, mut reached_s) = (false, false, false, 0.0);
        // SAFETY: the instance lives, and what is written to lives through the call.
        let status = unsafe {
            match &self.calls {
                Calls::Two(two) => (two.do_step)(self.instance, time_s, step_s, 1),
                Calls::Three(three) => (three.do_step)(
                    self.instance,
                    time_s,
                    step_s,
                    true,
                    &mut event,
                    &mut over,
                    &mut early,
                    &mut reached_s,
                ),
            }
        };
        self.ok(status)?;
        // It wants to end, or stands somewhere on the way to the next sample: there is no answer of that sample.
        if over || early { Err(DISCARD) } else { Ok(()) }
    }
}

impl Drop for Fmu {
    /// Leaves the instance as the standard asks.
    fn drop(&mut self) {
        let Leaving { terminate, free } = &self.leaving;
        // SAFETY: the instance lives, and what its worst status forbids is not called.
        unsafe {
            if let Some(terminate) = terminate.filter(|_| self.worst < ERROR) {
                let _ = terminate(self.instance);
            }
            if let Some(free) = free.filter(|_| self.worst < FATAL) {
                free(self.instance);
            }
        }
    }
}

type Kept = (Library, Box<Callbacks>, [CString; 3]);

fn begun(instance: Instance, steps: &[(&str, Status)]) -> Result<(), Refusal> {
    let allowed = || "an FMU whose instance begins at 0 s".to_owned();
    if instance.is_null() {
        return Err(("makes no instance".to_owned(), allowed()));
    }
    let failed = steps.iter().find(|(_, status)| ok(*status).is_err());
    failed.map_or(Ok(()), |(name, status)| {
        Err((format!("{name} answers status {status}"), allowed()))
    })
}

fn two(
    (library, callbacks, [name, token, resources]): &Kept,
) -> Result<(Calls, Instance), Refusal> {
    type Instantiate = unsafe extern "C" fn(
        *const c_char,
        c_int,
        *const c_char,
        *const c_char,
        *const Callbacks,
        c_int,
        c_int,
    ) -> Instance;
    type SetUp = unsafe extern "C" fn(Instance, c_int, f64, f64, c_int, f64) -> Status;
    type Enter = unsafe extern "C" fn(Instance) -> Status;
    let instantiate: Instantiate = function(library, "fmi2Instantiate")?;
    let set_up: SetUp = function(library, "fmi2SetupExperiment")?;
    let enter: Enter = function(library, "fmi2EnterInitializationMode")?;
    let exit: Enter = function(library, "fmi2ExitInitializationMode")?;
    // SAFETY: the types are those of the standard; texts and callbacks live as long as the instance.
    let instance = unsafe {
        let (name, token, resources) = (name.as_ptr(), token.as_ptr(), resources.as_ptr());
        instantiate(name, CO_SIMULATION, token, resources, &raw const **callbacks, 0, 0)
    };
    begun(instance, &[])?;
    // SAFETY: the instance lives, and the calls come in the order of the standard.
    let steps = unsafe {
        [
            ("fmi2SetupExperiment", set_up(instance, 0, 0.0, 0.0, 0, 0.0)),
            ("fmi2EnterInitializationMode", enter(instance)),
            ("fmi2ExitInitializationMode", exit(instance)),
        ]
    };
    begun(instance, &steps)?;
    let calls = Two {
        set_real: function(library, "fmi2SetReal")?,
        get_real: function(library, "fmi2GetReal")?,
        get_integer: function(library, "fmi2GetInteger")?,
        get_boolean: function(library, "fmi2GetBoolean")?,
        do_step: function(library, "fmi2DoStep")?,
    };
    Ok((Calls::Two(calls), instance))
}

fn three((library, _, [name, token, resources]): &Kept) -> Result<(Calls, Instance), Refusal> {
    type Log = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);
    type Instantiate = unsafe extern "C" fn(
        *const c_char,
        *const c_char,
        *const c_char,
        bool,
        bool,
        bool,
        bool,
        *const u32,
        usize,
        *mut c_void,
        Log,
        *const c_void,
    ) -> Instance;
    type Enter = unsafe extern "C" fn(Instance, bool, f64, f64, bool, f64) -> Status;
    type Exit = unsafe extern "C" fn(Instance) -> Status;
    let instantiate: Instantiate = function(library, "fmi3InstantiateCoSimulation")?;
    let enter: Enter = function(library, "fmi3EnterInitializationMode")?;
    let exit: Exit = function(library, "fmi3ExitInitializationMode")?;
    // SAFETY: the types are those of the standard; the texts live as long as the instance.
    let instance = unsafe {
        let (name, token, resources) = (name.as_ptr(), token.as_ptr(), resources.as_ptr());
        let (environment, log): (_, Log) = (null_mut(), silent_three);
        let off = false;
        instantiate(name, token, resources, off, off, off, off, null(), 0, environment, log, null())
    };
    begun(instance, &[])?;
    // SAFETY: the instance lives, and the calls come in the order of the standard.
    let steps = unsafe {
        [
            ("fmi3EnterInitializationMode", enter(instance, false, 0.0, 0.0, false, 0.0)),
            ("fmi3ExitInitializationMode", exit(instance)),
        ]
    };
    begun(instance, &steps)?;
    let calls = Three {
        set_real: function(library, "fmi3SetFloat64")?,
        get_real: function(library, "fmi3GetFloat64")?,
        get_integer: function(library, "fmi3GetInt32")?,
        get_boolean: function(library, "fmi3GetBoolean")?,
        do_step: function(library, "fmi3DoStep")?,
    };
    Ok((Calls::Three(calls), instance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variables::Variable;

    #[test]
    fn a_folder_is_written_as_an_address() {
        assert_eq!(uri(Path::new("/tmp/a b#ü%")), "file:///tmp/a%20b%23%C3%BC%25");
    }

    /// An FMU of version 3.0 that notes how it is left; its fourth step ends as it is told.
    const NOTING: &str = r#"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
typedef int S;
static int steps;
static void note(const char *word) { FILE *f = fopen(NOTES, "a"); fputs(word, f); fclose(f); }
void *fmi3InstantiateCoSimulation(void) { return &steps; }
S fmi3EnterInitializationMode(void) { return 0; }
S fmi3ExitInitializationMode(void) { return 0; }
S fmi3SetFloat64(void) { return 0; }
S fmi3GetFloat64(void) { return 0; }
S fmi3GetInt32(void) { return 0; }
S fmi3GetBoolean(void) { return 0; }
S fmi3DoStep(void *i, double t, double h, bool n, bool *event, bool *over, bool *early, double *last)
{
    if (++steps == 4) { FOURTH; }
    return 0;
}
S fmi3Terminate(void *i) { note("terminated "); return 0; }
void fmi3FreeInstance(void *i) { note("freed"); }
"#;

    /// The status of the fourth step, and how the instance was left.
    fn fourth(does: &str) -> (Option<Failure>, String) {
        let folder = tempfile::tempdir().expect("a folder");
        let (source, library) = (folder.path().join("f.c"), folder.path().join("f.so"));
        let notes = folder.path().join("notes");
        std::fs::write(&source, NOTING).expect("a file");
        let built = std::process::Command::new("cc")
            .args(["-shared", "-fPIC", &format!("-DNOTES={notes:?}"), &format!("-DFOURTH={does}")])
            .args([&source, Path::new("-o"), &library])
            .status();
        assert!(built.is_ok_and(|status| status.success()));
        let description = Description {
            version: Version::Three,
            identifier: "f".to_owned(),
            token: "t".to_owned(),
            period_s: 0.0,
            inputs: [None; 3],
            command: Variable { reference: 1, unit: 1.0 },
            gains: [None; 3],
            saturated: None,
            faults: None,
        };
        let mut fmu = Fmu::load(&library, &description, folder.path()).expect("it begins");
        for k in 0..3 {
            fmu.step(f64::from(k), 1.0).expect("a step");
        }
        let status = fmu.step(3.0, 1.0).err();
        drop(fmu);
        (status, std::fs::read_to_string(notes).unwrap_or_default())
    }

    #[test]
    fn a_step_that_is_not_whole_is_no_answer_and_an_instance_is_left_as_the_standard_asks() {
        for (does, status, left) in [
            ("", None, "terminated freed"),
            ("*over = true", Some(DISCARD), "terminated freed"),
            ("*early = true", Some(DISCARD), "terminated freed"),
            ("return 3", Some(ERROR), "freed"),
            ("return 4", Some(FATAL), ""),
        ] {
            assert_eq!(fourth(does), (status, left.to_owned()), "{does}");
        }
    }
}
