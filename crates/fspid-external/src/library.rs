//! A shared library with the functions of `fspid_external.h`: where their C is called.
#![allow(unsafe_code, reason = "calling C is; every call says why it may be made")]

use std::ffi::c_void;
use std::path::Path;

use fspid_sim::core::{Faults, Gains, Sample, Step};
use libloading::{Library, Symbol};

/// `FSPID_EXTERNAL_VERSION` of the header.
pub(crate) const VERSION: u32 = 1;
/// Most memory that a controller may ask for, in bytes: no controller needs it, and a wrong number is refused.
const MOST_BYTES: usize = 1 << 24;

/// What memory holds before it is reset: no number as a float of any size, and no zero as a whole number, so that a
/// controller which never writes what it reads does not fly as if it had.
const UNWRITTEN: u8 = 0xff;
/// What stands behind it, and has to stay there, in bytes: a cache line.
const GUARD: u8 = 0xc3;
const GUARD_BYTES: usize = 64;
/// In place of a status of FMI: the guard was written to.
pub(crate) const OVERRAN: i32 = i32::MIN;

/// `fspid_external_sample` of the header.
#[repr(C)]
struct CSample {
    setpoint_rad: f64,
    measurement_rad: f64,
    rate_rad_s: f64,
}

/// `fspid_external_answer` of the header.
#[repr(C)]
struct CAnswer {
    command_rad: f64,
    kp: f64,
    ki: f64,
    kd: f64,
    saturated: u32,
    faults: u32,
}

type Version = unsafe extern "C" fn() -> u32;
type Period = unsafe extern "C" fn() -> f64;
type StateBytes = unsafe extern "C" fn() -> usize;
type Reset = unsafe extern "C" fn(*mut c_void);
type Answer = unsafe extern "C" fn(*mut c_void, *const CSample, *mut CAnswer);

/// Names of the functions, in the order of the header.
const NAMES: [&str; 5] = [
    "fspid_external_version",
    "fspid_external_period_s",
    "fspid_external_state_bytes",
    "fspid_external_reset",
    "fspid_external_step",
];

/// What is wrong with a library, and what would be right.
pub(crate) type Refusal = (String, String);

/// A controller of a library, with its memory.
pub(crate) struct LibraryController {
    step: Answer,
    state: Memory,
    pub(crate) period_s: f64,
    /// Functions are called for as long as it is loaded.
    _library: Library,
}

impl LibraryController {
    /// Loads a library and takes its controller to rest.
    pub(crate) fn load(path: &Path) -> Result<Self, Refusal> {
        // SAFETY: what runs while it is loaded is the user's own code, in a process that has nothing else to lose.
        let library = unsafe { Library::new(path) }.map_err(|error| {
            let allowed = "a shared library for this machine: cc -shared -fPIC … -o controller.so";
            (format!("cannot be loaded: {}", words(&error)), allowed.to_owned())
        })?;
        require_all(&library)?;
        let [version, period, bytes, reset, step] = NAMES;
        let version: Version = function(&library, version)?;
        // SAFETY: the header says that it takes nothing and answers a number; the same holds of the next two.
        let found = unsafe { version() };
        if found != VERSION {
            let reason = format!("is of version {found} of fspid_external.h");
            let allowed = format!("version {VERSION}; build it with the header of this fspid");
            return Err((reason, allowed));
        }
        let period: Period = function(&library, period)?;
        // SAFETY: as above.
        let period_s = unsafe { period() };
        let bytes: StateBytes = function(&library, bytes)?;
        // SAFETY: as above.
        let bytes = unsafe { bytes() };
        if bytes > MOST_BYTES {
            let reason = format!("asks for {bytes} bytes of memory");
            return Err((reason, format!("{MOST_BYTES} bytes at most")));
        }
        let mut state = Memory::new(bytes);
        let reset: Reset = function(&library, reset)?;
        // SAFETY: the memory has the bytes that the controller asked for, and nobody else's.
        unsafe { reset(state.pointer()) };
        if !state.is_whole() {
            let reason =
                format!("writes in `{}` beyond the {bytes} bytes that it asks for", NAMES[3]);
            return Err((reason, format!("as many bytes as it writes, from `{}`", NAMES[2])));
        }
        let step = function(&library, step)?;
        Ok(Self { step, state, period_s, _library: library })
    }

    /// The answer to a sample, or [`OVERRAN`]. A command that the controller does not write is NaN.
    pub(crate) fn step(&mut self, sample: &Sample<f64>) -> Result<Step<f64>, i32> {
        let Sample { setpoint_rad, measurement_rad, rate_rad_s } = *sample;
        let sample = CSample { setpoint_rad, measurement_rad, rate_rad_s };
        let (kp, ki, kd, saturated, faults) = (0.0, 0.0, 0.0, 0, 0);
        let mut answer = CAnswer { command_rad: f64::NAN, kp, ki, kd, saturated, faults };
        // SAFETY: the memory is the one that was reset; sample and answer live through the call and have the layout of
        // the header; the library is loaded for as long as `self` is.
        unsafe { (self.step)(self.state.pointer(), &sample, &mut answer) };
        if !self.state.is_whole() {
            return Err(OVERRAN);
        }
        let CAnswer { command_rad, kp, ki, kd, saturated, faults } = answer;
        Ok(Step {
            command_rad,
            gains: Gains { kp, ki, kd },
            saturated: saturated != 0,
            faults: Faults::from_bits((faults & 0xff) as u8),
        })
    }
}

/// The memory of a controller, as from `malloc` aligned for every type of C, and a guard behind it.
struct Memory {
    blocks: Vec<u128>,
    bytes: usize,
}

impl Memory {
    fn new(bytes: usize) -> Self {
        let mut all = vec![UNWRITTEN; bytes];
        all.resize((bytes + GUARD_BYTES).next_multiple_of(size_of::<u128>()), GUARD);
        let block = |block: &[u8]| u128::from_ne_bytes(block.try_into().unwrap_or_default());
        Self { blocks: all.chunks_exact(size_of::<u128>()).map(block).collect(), bytes }
    }

    fn pointer(&mut self) -> *mut c_void {
        self.blocks.as_mut_ptr().cast()
    }

    /// True as long as nobody wrote behind it.
    fn is_whole(&self) -> bool {
        let first = self.bytes / size_of::<u128>();
        let behind = self.blocks.iter().skip(first).flat_map(|block| block.to_ne_bytes());
        behind.skip(self.bytes % size_of::<u128>()).all(|byte| byte == GUARD)
    }
}

/// Refuses a library that lacks functions, all of them named.
fn require_all(library: &Library) -> Result<(), Refusal> {
    let lacks = |name: &&&str| {
        // SAFETY: the address is looked at and not called.
        unsafe { library.get::<*const c_void>(name.as_bytes()) }.is_err()
    };
    let missing: Vec<&str> = NAMES.iter().filter(lacks).copied().collect();
    if missing.is_empty() {
        return Ok(());
    }
    let reason = format!("has no function {}", missing.join(", "));
    Err((reason, "the five functions that fspid_external.h declares".to_owned()))
}

/// The function of that name; who calls it says that it is of this type.
pub(crate) fn function<F: Copy>(library: &Library, name: &str) -> Result<F, Refusal> {
    // SAFETY: the type is that of the function in its header, which the library says that it keeps to.
    let found: Result<Symbol<'_, F>, _> = unsafe { library.get(name.as_bytes()) };
    found.map(|symbol| *symbol).map_err(|error| (words(&error), format!("a function {name}")))
}

/// What the loader of the system says.
pub(crate) fn words(error: &libloading::Error) -> String {
    let source = std::error::Error::source(error);
    source.map_or_else(|| error.to_string(), ToString::to_string)
}
