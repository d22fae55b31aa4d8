//! FMUs for co-simulation, FMI 2.0 and 3.0: where their C is called.
#![allow(unsafe_code, reason = "calling C is; every call says why it may be made")]

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr::{null, null_mut};

use libloading::Library;

use crate::description::{Description, Version};
use crate::library::{Refusal, function, words};

/// The worst status with which there is an answer: a warning.
const WARNING: c_int = 1;
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

enum Calls {
    Two(Two),
    Three(Three),
}

/// An instance, stepping.
pub(crate) struct Fmu {
    calls: Calls,
    instance: Instance,
    /// Functions and callbacks are called for as long as the instance lives.
    _kept: (Library, Box<Callbacks>, [CString; 3]),
}

/// Texts that live as long as an instance: its name, token and folder of resources.
fn texts(description: &Description, folder: &Path) -> Result<[CString; 3], Refusal> {
    let resources = folder.join("resources");
    let resources = match description.version {
        Version::Two => format!("file://{}", resources.display()),
        Version::Three => format!("{}/", resources.display()),
    };
    let text = |text: &str| {
        CString::new(text).map_err(|_| ("has a zero in a text".to_owned(), "a text".to_owned()))
    };
    Ok([text("controller")?, text(&description.token)?, text(&resources)?])
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
        Ok(Self { calls, instance, _kept: kept })
    }

    /// Sets one real.
    pub(crate) fn set(&mut self, reference: u32, value: f64) -> Result<(), Failure> {
        // SAFETY: the instance lives; both arrays have the one entry that is said, and live through the call. The same
        // holds of the next three.
        ok(unsafe {
            match &self.calls {
                Calls::Two(two) => (two.set_real)(self.instance, &reference, 1, &value),
                Calls::Three(three) => (three.set_real)(self.instance, &reference, 1, &value, 1),
            }
        })
    }

    /// Asks for a real.
    pub(crate) fn real(&mut self, reference: u32) -> Result<f64, Failure> {
        let mut value = f64::NAN;
        // SAFETY: as in `set`.
        ok(unsafe {
            match &self.calls {
                Calls::Two(two) => (two.get_real)(self.instance, &reference, 1, &mut value),
                Calls::Three(three) => {
                    (three.get_real)(self.instance, &reference, 1, &mut value, 1)
                }
            }
        })?;
        Ok(value)
    }

    /// Asks for a whole number.
    pub(crate) fn whole(&mut self, reference: u32) -> Result<i32, Failure> {
        let mut value = 0;
        // SAFETY: as in `set`.
        ok(unsafe {
            match &self.calls {
                Calls::Two(two) => (two.get_integer)(self.instance, &reference, 1, &mut value),
                Calls::Three(three) => {
                    (three.get_integer)(self.instance, &reference, 1, &mut value, 1)
                }
            }
        })?;
        Ok(value)
    }

    /// Asks for a truth.
    pub(crate) fn truth(&mut self, reference: u32) -> Result<bool, Failure> {
        let (mut whole, mut truth) = (0, false);
        // SAFETY: as in `set`.
        ok(unsafe {
            match &self.calls {
                Calls::Two(two) => (two.get_boolean)(self.instance, &reference, 1, &mut whole),
                Calls::Three(three) => {
                    (three.get_boolean)(self.instance, &reference, 1, &mut truth, 1)
                }
            }
        })?;
        Ok(truth || whole != 0)
    }

    /// Goes from a time on by a step, s.
    pub(crate) fn step(&mut self, time_s: f64, step_s: f64) -> Result<(), Failure> {
        let (mut event, mut over, mut early, mut reached_s) = (false, false, false, 0.0);
        // SAFETY: the instance lives, and what is written to lives through the call.
        ok(unsafe {
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
        })
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
