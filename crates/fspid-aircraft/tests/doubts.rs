//! Slips of unit and sign in an aircraft's data are told; what aircraft have is not.

use crate::support;

use fspid_aircraft::data::DerivativeData;
use support::{aircraft, derivative_data, names};

#[test]
fn no_carried_aircraft_raises_a_doubt() {
    for name in names() {
        assert_eq!(aircraft(name).doubts(), Vec::<String>::new(), "{name}");
    }
}

/// Each slip, and the beginning of the only sentence that it raises.
#[test]
fn every_slip_raises_its_own_doubt_and_no_other() {
    type Slip = fn(&mut DerivativeData);
    let slips: [(Slip, &str); 11] = [
        (|it| it.longitudinal.lift.reference *= 2.0, "lift at the reference is"),
        (|it| it.reference.altitude_m = 6000.0, "the density of the reference is"),
        (|it| it.reference.mach = 0.5, "the Mach number of the reference is"),
        (|it| it.inertia.iy_kg_m2 *= 1e-4, "iy and the weight make"),
        (|it| it.longitudinal.lift.alpha /= 57.3, "lift by alpha is"),
        (|it| it.longitudinal.pitch.alpha *= -1.0, "pitch by alpha is"),
        (|it| it.longitudinal.pitch.pitch_rate = 0.0, "pitch by pitch_rate is"),
        (|it| it.longitudinal.pitch.elevator *= -1.0, "pitch by elevator is"),
        (|it| it.lateral.as_mut().expect("lateral").roll.roll_rate *= -1.0, "roll by roll_rate is"),
        (|it| it.lateral.as_mut().expect("lateral").yaw.yaw_rate *= -1.0, "yaw by yaw_rate is"),
        (|it| it.lateral.as_mut().expect("lateral").yaw.beta *= -1.0, "yaw by beta is"),
    ];
    for (slip, beginning) in slips {
        let mut data = derivative_data("navion");
        slip(&mut data);
        let doubts = data.doubts();
        assert_eq!(doubts.len(), 1, "{beginning}: {doubts:?}");
        assert!(doubts[0].starts_with(beginning), "{doubts:?}");
    }
}
