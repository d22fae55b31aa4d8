//! Turns of an aircraft in moving air.

use crate::flying::result;

const TURN: &str = include_str!("../../../../scenarios/gallery/turn.toml");

/// With the speed over the ground in the yaw damper the bank was off by 4.7 deg.
#[test]
fn a_steady_wind_carries_a_turn_along_and_changes_nothing_about_it() {
    let banks = |speed_m_s: f64| {
        let wind =
            format!("wind={{ kind = \"steady\", speed_m_s = {speed_m_s:?}, from_deg = 0.0 }}");
        let trace = result(TURN, &["mode[1].target.heading_deg=179.0", &wind]).trace;
        trace.column("bank_rad").expect("an aircraft's").to_vec()
    };
    let off = banks(20.0).into_iter().zip(banks(0.001)).map(|(one, other)| (one - other).abs());
    let most_rad = off.fold(0.0, f64::max);
    assert!(most_rad < 1e-6, "{most_rad} rad");
}
