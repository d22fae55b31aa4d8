//! A step allocates nothing: counted by an allocator around the system's.
//!
//! That neither this crate nor `fspid-fuzzy` can name the heap (`no_std` without `alloc`) already
//! says so; this would also notice a feature or a dependency that changes it.

use crate::common;

use common::{NOMINAL, Random, T, fspid, pid};
use fspid_core::{AntiWindup, ControllerSetting, Law, Limits, PidConfig, State, TunerSettings};

#[test]
fn building_a_controller_and_stepping_it_allocates_nothing() {
    let samples = Random(7).samples::<f64>(1000);
    let settings =
        TunerSettings { law: Law::Accumulating { leakage_per_s: 0.1 }, ..TunerSettings::literal() };
    let mut config = PidConfig::sampled_every(T);
    config.limits = Limits::new(ControllerSetting::OutputLimits, -0.5, 0.5).ok();
    config.slew_rad_s = Some(1.0);
    config.anti_windup = AntiWindup::BackCalculation { tracking_s: 1.0 };
    let tuned = fspid(settings, config);

    let mut saturated = 0;
    let steps = allocation_counter::measure(|| {
        let fixed = pid(NOMINAL, config);
        let (mut state_fixed, mut state_tuned) = (State::new(), State::new());
        for &sample in &samples {
            saturated += u32::from(fixed.step(&mut state_fixed, sample).saturated);
            saturated += u32::from(tuned.step(&mut state_tuned, sample).saturated);
        }
    });
    assert_eq!(steps.count_total, 0);
    assert!(saturated > 0, "the run takes the limited branches, too");
}

#[test]
fn the_counter_sees_an_allocation() {
    let vector = allocation_counter::measure(|| drop(std::hint::black_box(vec![1_u8])));
    assert_eq!(vector.count_total, 1);
}
