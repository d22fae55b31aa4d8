//! Winds of rows, in the scenario and in files.

use std::fs;

use fspid_scenario::file;
use fspid_study::simulation::Simulation;

use crate::flying::{NAVION, apart, column, flown, largest};

const QUIET: [&str; 2] = ["setpoint.amplitude_deg=0.0", "loop.duration_s=20.0"];

fn with(wind: &str) -> String {
    format!("{NAVION}[wind]\nkind = \"table\"\n{wind}\n")
}

/// The problems of a scenario whose table is in a file with these lines.
fn problems(csv: &str) -> String {
    let folder = tempfile::tempdir().expect("made");
    fs::write(folder.path().join("wind.csv"), csv).expect("written");
    let path = folder.path().join("scenario.toml");
    fs::write(&path, with("file = \"wind.csv\"")).expect("written");
    file::load(&path, &[]).expect_err(csv).to_string()
}

fn of_file(csv: &str) -> fspid_sim::Trace {
    let folder = tempfile::tempdir().expect("made");
    fs::write(folder.path().join("wind.csv"), csv).expect("written");
    let path = folder.path().join("scenario.toml");
    fs::write(&path, with("file = \"wind.csv\"")).expect("written");
    let study = file::load(&path, &QUIET.map(str::to_owned)).unwrap_or_else(|why| panic!("{why}"));
    Simulation::of(&study).expect("it flies").results.remove(0).trace
}

#[test]
fn a_table_of_one_wind_is_a_steady_wind() {
    let table = with("height_m = [0.0, 1000.0]\nnorth_m_s = [-8.0, -8.0]\nup_m_s = [0.5, 0.5]");
    let steady = "[wind]\nkind = \"steady\"\nspeed_m_s = 8.0\nup_m_s = 0.5\n";
    let (table, steady) = (flown(&table, &QUIET), flown(&format!("{NAVION}{steady}"), &QUIET));
    for name in ["north_m", "altitude_m", "airspeed_m_s", "air_forward_m_s", "air_down_m_s"] {
        assert!(apart(column(&table, name), column(&steady, name)) < 1e-9, "{name}");
    }
    // An updraught carries it along, whose drift it is trimmed in.
    let climbed = column(&table, "altitude_m")[2000] - column(&table, "altitude_m")[0];
    assert!((climbed - 10.0).abs() < 0.05, "{climbed}");
}

/// A headwind that grows at a constant rate: a_x felt through the air is the rate, by which the airspeed begins to grow.
#[test]
fn a_headwind_that_grows_adds_to_the_airspeed_at_its_rate() {
    let trace = flown(&with("time_s = [1.0, 11.0]\nnorth_m_s = [0.0, -20.0]"), &QUIET);
    let speed = column(&trace, "airspeed_m_s");
    assert!((speed[100] - speed[0]).abs() < 1e-9);
    // 2 m/s² over a tenth of a second, before drag answers.
    assert!((speed[110] - speed[100] - 0.2).abs() < 2e-3, "{}", speed[110] - speed[100]);
    assert!(column(&trace, "energy_height_m")[300] > column(&trace, "energy_height_m")[0] + 5.0);
}

/// Dense rows of a logarithm are the logarithm, but for what straight lines leave of it.
#[test]
fn a_profile_of_many_rows_is_the_wind_that_it_was_made_of() {
    let shear =
        "[wind]\nkind = \"log-shear\"\nw20_m_s = 8.0\nfrom_deg = 30.0\nroughness_m = 0.6096\n";
    let step = ["setpoint.amplitude_deg=3.0", "loop.duration_s=10.0"];
    let shear = flown(&format!("{NAVION}{shear}"), &step);
    let ratio = |height_m: f64| (height_m / 0.6096).ln() / (6.096_f64 / 0.6096).ln();
    let heights: Vec<f64> = (0..200).map(|index| 250.0 + f64::from(index)).collect();
    let list = |values: Vec<f64>| {
        format!("[{}]", values.iter().map(|it| format!("{it:?}")).collect::<Vec<_>>().join(", "))
    };
    let along =
        |share: f64| list(heights.iter().map(|it| -8.0 * ratio(it.min(304.8)) * share).collect());
    let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
    let rows = format!(
        "height_m = {}\nnorth_m_s = {}\neast_m_s = {}",
        list(heights.clone()),
        along(cosine),
        along(sine)
    );
    let table = flown(&with(&rows), &step);
    // The second derivative of the profile over a row of 1 m at 300 m: 8 / ln 10 / 300² / 8.
    assert!(apart(column(&shear, "air_forward_m_s"), column(&table, "air_forward_m_s")) < 1e-2);
    assert!(apart(&shear.theta_rad, &table.theta_rad) < 1e-4);
}

#[test]
fn units_of_columns_are_read_from_their_names() {
    let si = of_file(
        "time_s,north_m_s,east_m_s,up_m_s\n0,0,0,0\n# a remark\n\n10,-5.144444444444445,0,3.048\n",
    );
    let other =
        of_file("\u{feff}time_s, up_ft_s, speed_kt, from_deg\r\n0,0,0,0\r\n10, 10.0, 10, 360\r\n");
    for name in ["air_forward_m_s", "air_down_m_s", "altitude_m"] {
        assert!(apart(column(&si, name), column(&other, name)) < 1e-9, "{name}");
    }
    assert!(largest(column(&si, "air_down_m_s")) > 3.0);
    let feet = of_file("height_ft,forward_kt\n0,10\n3280.839895013123,10\n");
    assert!((column(&feet, "air_forward_m_s")[50] - 10.0 * 1852.0 / 3600.0).abs() < 1e-9);
}

#[test]
fn what_is_wrong_with_a_file_is_told_with_its_line() {
    let good = "time_s,up_m_s\n0,1\n1,2\n";
    for (csv, told) in [
        (
            good.replace("1,2", "0,2"),
            "wind.csv:3:1: wind.file: the row is not above the one before",
        ),
        (good.replace("1,2", "1,NaN"), "wind.csv:3:3: wind.file: `NaN` is no finite number"),
        (good.replace("1,2", "1"), "wind.csv:3:1: wind.file: 1 cells under 2 columns"),
        (good.replace("up_m_s", "up"), "wind.csv:1:8: wind.file: no column is called `up`"),
        (good.replace("time_s", "east_kt"), "no column says what the rows go by"),
        (good.replace("up_m_s", "height_m"), "two columns say what the rows go by"),
        (good.replace("up_m_s", "time_s"), "`time_s` stands twice"),
        (good.replace("up_m_s", "speed_kt"), "a speed and from_deg go together"),
        ("time_s,up_m_s,up_kt\n0,1,1\n1,1,1\n".to_owned(), "a direction stands twice"),
        ("time_s\n0\n1\n".to_owned(), "no column is a velocity"),
        ("time_s,up_m_s\n0,1\n".to_owned(), "wind.csv:1:1: wind.file: 1 rows"),
        (String::new(), "the file has no line"),
    ] {
        let found = problems(&csv);
        assert!(found.contains(told), "{told}: {found}");
    }
    let many: String = (0..10_001).map(|row| format!("{row},1\n")).collect();
    assert!(
        problems(&format!("time_s,up_m_s\n{many}"))
            .contains("wind.csv:10002:1: wind.file: more than 10000 rows")
    );
    // All at once, and not without end.
    let two = problems("time_s,up_m_s\n0,a\n1,b\n");
    assert!(two.contains("`a`") && two.contains("`b`"), "{two}");
    let hostile: String = (0..9_000).map(|_| "x,y\n").collect();
    assert!(problems(&format!("time_s,up_m_s\n{hostile}")).len() < 6000);
}

#[test]
fn what_is_wrong_with_lists_is_told_and_a_file_needs_a_folder() {
    for (wind, told) in [
        ("time_s = [0.0, 1.0]", "a table of winds has a velocity"),
        ("time_s = [0.0, 0.0]\nup_m_s = [1.0, 1.0]", "number 2 is not above the one before"),
        ("time_s = [0.0, 1.0]\nup_m_s = [1.0, 1.0, 2.0]", "3 numbers for 2 rows"),
        ("time_s = [0.0, 1.0]\nheight_m = [0.0, 1.0]\nup_m_s = [1.0, 1.0]", "not together with"),
        ("up_m_s = [1.0, 1.0]", "missing"),
        ("file = \"wind.csv\"", "not in a folder, so it cannot refer to files"),
        ("file = \"wind.csv\"\nup_m_s = [1.0, 1.0]", "not together with `file`"),
    ] {
        let problems = file::parse(&with(wind), "a.toml", None, &[]).expect_err(wind).to_string();
        assert!(problems.contains(told), "{told}: {problems}");
    }
}

/// What a scenario refers to is part of what it is.
#[test]
fn another_table_is_another_scenario() {
    let folder = tempfile::tempdir().expect("made");
    let path = folder.path().join("scenario.toml");
    fs::write(&path, with("file = \"wind.csv\"")).expect("written");
    let digest = |csv: &str| {
        fs::write(folder.path().join("wind.csv"), csv).expect("written");
        file::load(&path, &[]).expect("read").digest
    };
    let one = digest("time_s,up_m_s\n0,1\n1,2\n");
    assert_eq!(one, digest("time_s,up_m_s\n0,1\n1,2\n"));
    assert_ne!(one, digest("time_s,up_m_s\n0,1\n1,3\n"));
}
