//! A flight in six degrees of freedom against one by equations that were written elsewhere (`oracles/make_six_dof.py`).

use std::path::PathBuf;

use fspid_scenario::file;

const THEIRS: &str = include_str!("../data/six_dof/flight.csv");

/// A column, its unit, and how close it has to be.
type Column = (&'static str, fn(f64) -> f64, f64);

/// A pitch step in a turn in a steady wind that rises, with a lagging engine and servo: quaternion and 10 ms here, Euler
/// angles and 0.5 ms there. Both are of order four, and differ by what 10 ms leave over.
#[test]
fn a_turn_in_a_wind_is_the_flight_of_other_equations() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/six_dof");
    let study = file::load(&folder.join("flight.toml"), &[]).expect("a scenario");
    let trace = fspid_sim::simulate(&study.scenario).expect("it flies").traces.remove(0);
    let deg = f64::to_degrees;
    let columns: [Column; 9] = [
        ("north_m", |it| it, 1e-6),
        ("east_m", |it| it, 1e-6),
        ("altitude_m", |it| it, 1e-6),
        ("airspeed_m_s", |it| it, 1e-7),
        ("bank_rad", deg, 1e-6),
        ("attitude_rad", deg, 1e-6),
        ("heading_rad", deg, 1e-6),
        ("q_rad_s", deg, 1e-6),
        ("throttle", |it| it, 1e-9),
    ];
    let mut seconds = 0;
    for (second, line) in THEIRS.lines().skip(1).enumerate() {
        let theirs: Vec<f64> =
            line.split(',').skip(1).map(|it| it.parse().expect("a number")).collect();
        for ((name, unit, close), theirs) in columns.iter().zip(&theirs) {
            let column = match *name {
                "q_rad_s" => &trace.q_rad_s[..],
                name => trace.column(name).expect("there"),
            };
            let ours = unit(column[100 * second]);
            assert!((ours - theirs).abs() < *close, "{name} at {second} s: {ours}, not {theirs}");
        }
        seconds += 1;
    }
    assert_eq!(seconds, 41);
}
