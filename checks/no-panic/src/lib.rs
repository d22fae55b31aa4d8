//! Everything that runs in flight or builds it, exported, with a panic handler that calls a function
//! which does not exist. The linker drops what cannot be reached; if the handler is still there, a
//! panic can be reached and the link fails. `check.sh` links it, and once more with a panic, which
//! must fail.
#![no_std]

use core::panic::PanicInfo;

use fspid_core::fuzzy::{
    Defuzzifier, FuzzyError, Inference, InferenceError, Network, NetworkRow, NumberGrid, NumberTable, OutOfRange,
    RuleTable, Supervisor,
};
use fspid_core::{
    ConfigError, Fspid, Gains, Pid, Sample, SelfTuner, PidConfig, State, Step, TunerSettings,
};

unsafe extern "C" {
    safe fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    a_panic_can_be_reached()
}

/// Exports steps, inference and construction for each type of number.
macro_rules! export {
    ($(
        $real:ty: $pid:ident $fspid:ident $infer:ident,
        $new_pid:ident $new_fspid:ident $new_supervisor:ident $new_numbers:ident $new_network:ident;
    )*) => { $(
        #[unsafe(no_mangle)]
        pub extern "Rust" fn $pid(
            controller: &Pid<$real>, state: &mut State<$real>, sample: Sample<$real>,
        ) -> Step<$real> {
            controller.step(state, sample)
        }

        #[unsafe(no_mangle)]
        pub extern "Rust" fn $fspid(
            controller: &Fspid<$real>, state: &mut State<$real>, sample: Sample<$real>,
        ) -> Step<$real> {
            controller.step(state, sample)
        }

        #[unsafe(no_mangle)]
        pub extern "Rust" fn $infer(
            supervisor: &Supervisor<$real>, error: $real, change: $real,
        ) -> Result<Inference<$real>, InferenceError> {
            supervisor.infer(error, change)
        }

        #[unsafe(no_mangle)]
        pub extern "Rust" fn $new_pid(
            gains: Gains<$real>, config: PidConfig<$real>,
        ) -> Result<Pid<$real>, ConfigError> {
            Pid::new(gains, config)
        }

        #[unsafe(no_mangle)]
        pub extern "Rust" fn $new_fspid(
            nominal: Gains<$real>,
            supervisor: Supervisor<$real>,
            settings: TunerSettings<$real>,
            config: PidConfig<$real>,
        ) -> Result<Fspid<$real>, ConfigError> {
            Fspid::new(SelfTuner::new(nominal, supervisor, settings)?, config)
        }

        #[unsafe(no_mangle)]
        pub extern "Rust" fn $new_supervisor(
            table: &RuleTable, range: $real, defuzzifier: Defuzzifier, policy: OutOfRange,
        ) -> Result<Supervisor<$real>, FuzzyError> {
            Supervisor::new(table, range, defuzzifier, policy)
        }

        #[unsafe(no_mangle)]
        pub extern "Rust" fn $new_numbers(
            grids: &[NumberGrid<$real>; 3], range: $real, policy: OutOfRange,
        ) -> Result<Supervisor<$real>, FuzzyError> {
            Supervisor::of_numbers(&NumberTable::new(*grids)?, range, policy)
        }

        #[unsafe(no_mangle)]
        pub extern "Rust" fn $new_network(
            rows: &[NetworkRow<$real>; 6], range: $real, policy: OutOfRange,
        ) -> Result<Supervisor<$real>, FuzzyError> {
            Supervisor::of_network(&Network::new(*rows)?, range, policy)
        }
    )* };
}

export! {
    f64: pid_step_f64 fspid_step_f64 infer_f64,
        new_pid_f64 new_fspid_f64 new_supervisor_f64 new_numbers_f64 new_network_f64;
    f32: pid_step_f32 fspid_step_f32 infer_f32,
        new_pid_f32 new_fspid_f32 new_supervisor_f32 new_numbers_f32 new_network_f32;
}

/// Shows that the check can fail.
#[cfg(feature = "with-panic")]
#[unsafe(no_mangle)]
pub extern "Rust" fn indexed(values: &[f64], index: usize) -> f64 {
    values[index]
}
