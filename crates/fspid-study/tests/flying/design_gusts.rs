//! The sweep of discrete gusts of CS 25.341.

use fspid_aircraft::Air;
use fspid_scenario::file;
use fspid_sim::air::{FullCycle, Wind};

use crate::flying::{NAVION, column, flown, largest, study};

const FOOT_M: f64 = 0.3048;

/// A 747 at 20 000 ft in a case of 33 gradient distances, which are 10 ft apart.
fn text(more: &str) -> String {
    let text = NAVION.replace(
        "name = \"navion\"\nairspeed_ft_s = 176.0",
        "name = \"b747-cruise-low\"\nairspeed_ft_s = 673.0",
    );
    let text = text.replace("altitude_ft = 1000.0", "altitude_ft = 20000.0");
    format!("{text}[[gust]]\nkind = \"cs-25.341\"\ngradients = 33\nat_s = 1.0\n{more}\n")
}

fn gust(more: &str) -> FullCycle {
    let weather = study(&text(more), &[]).scenario.surroundings.weather.expect("a gust");
    match weather.winds.as_slice() {
        [Wind::FullCycle(gust)] => *gust,
        other => panic!("{other:?}"),
    }
}

/// The regulation's numbers at 20 000 ft, which are speeds of equivalent airspeed, and both signs.
#[test]
fn design_gusts_are_those_of_the_regulation_at_their_altitude() {
    let ratio = Air::standard(6096.0).expect("air").density_kg_m3 / 1.225;
    for (gradient_ft, speed_ft_s) in [(30.0, 27.51), (100.0, 33.62), (200.0, 37.74), (350.0, 41.43)]
    {
        let place = ((gradient_ft - 30.0) / 10.0) as u32;
        for (case, sign) in [(2 * place + 1, 1.0), (2 * place + 2, -1.0)] {
            let gust = gust(&format!("case = {case}"));
            assert!((gust.gradient_m / FOOT_M - gradient_ft).abs() < 1e-9, "{gust:?}");
            let up_ft_s = -gust.amplitude_m_s[2] * ratio.sqrt() / FOOT_M;
            assert!((up_ft_s - sign * speed_ft_s).abs() < 0.006, "{case}: {up_ft_s}");
            assert!((gust.start_m - 673.0 * FOOT_M).abs() < 1e-9);
        }
    }
    let whole = gust("case = 1").amplitude_m_s[2];
    assert!((gust("case = 1\nalleviation = 0.8").amplitude_m_s[2] - 0.8 * whole).abs() < 1e-12);
}

#[test]
fn a_case_beyond_the_sweep_is_refused_with_how_many_there_are() {
    let told = file::parse(&text("case = 67"), "a.toml", None, &[]).expect_err("67 of 66");
    let told = told.to_string();
    assert!(told.contains("gust[0].case") && told.contains("1 to 66"), "{told}");
    let told = file::parse(&text("case = 1\nup_m_s = 3.0"), "a.toml", None, &[]);
    assert!(told.expect_err("a speed of its own").to_string().contains("up_m_s"));
}

#[test]
fn an_aircraft_meets_the_gust_of_its_case() {
    let quiet = ["setpoint.amplitude_deg=0.0"];
    let trace = flown(&text("case = 65"), &quiet);
    let met = largest(column(&trace, "air_down_m_s"));
    assert!((met - gust("case = 65").amplitude_m_s[2].abs()).abs() < 0.01, "{met}");
    assert!(largest(column(&trace, "load_factor")) > 1.3);
}
