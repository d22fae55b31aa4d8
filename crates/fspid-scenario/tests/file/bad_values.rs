//! Every number of the format, replaced by everything that it must not be.

use std::collections::BTreeSet;

use fspid_scenario::file;
use serde_json::Value;

use crate::file::schema::as_json;
use crate::file::text;

/// Set-points that take the place of the one in the file with every key.
const SETPOINTS: [&str; 6] = [
    "kind = \"step\"\namplitude_deg = 1.0\nat_s = 0.5\n",
    "kind = \"square\"\namplitude_deg = 1.0\nat_s = 0.5\nhalf_period_s = 2.0\nbipolar = true\n",
    "kind = \"doublet\"\namplitude_deg = 1.0\nat_s = 0.5\nwidth_s = 2.0\n",
    "kind = \"ramp\"\namplitude_deg = 1.0\nat_s = 0.5\nwidth_s = 2.0\n",
    "kind = \"sine\"\namplitude_deg = 1.0\nat_s = 0.5\nfrequency_hz = 2.0\n",
    "kind = \"table\"\ntime_s = [0.0, 1.0]\nvalue_deg = [1.0, 2.0]\ninterpolation = \"linear\"\n",
];

/// Limit, wing and fuel of the flying file, in every unit; joined to its inertia.
const VARIATIONS: [[&str; 4]; 3] = [
    ["most_airspeed_m_s = 90.0", "wing_height_m = 1.5", "on_board_kg = 100.0", "flow_kg_s = 0.01"],
    ["most_airspeed_kt = 170.0", "wing_height_ft = 5.0", "on_board_lb = 200.0", "flow_lb_h = 80.0"],
    [
        "most_airspeed_ft_s = 300.0",
        "wing_height_m = 1.5",
        "on_board_kg = 100.0",
        "specific_kg_n_s = 2e-5",
    ],
];

/// Inertia of the flying file: in every unit, and by radii.
const INERTIAS: [&str; 3] = [
    "ix_kg_m2 = 1400.0\niy_kg_m2 = 4000.0\niz_kg_m2 = 4700.0\nixz_kg_m2 = 10.0\n",
    "ix_slug_ft2 = 1000.0\niy_slug_ft2 = 3000.0\niz_slug_ft2 = 3500.0\nixz_slug_ft2 = 8.0\n",
    "ix_gyration_m = 1.1\niy_gyration_m = 1.8\niz_gyration_m = 2.0\n",
];

/// Speed, altitude, wind and inertia of the flying file: every unit and every kind.
const FLIGHTS: [[&str; 4]; 8] = [
    [
        "airspeed_m_s = 54.0",
        "altitude_m = 300.0",
        "kind = \"steady\"\nspeed_m_s = 5.0\nfrom_deg = 30.0\nup_m_s = 0.5\n",
        INERTIAS[0],
    ],
    [
        "airspeed_kt = 104.0",
        "altitude_ft = 1000.0",
        "kind = \"steady\"\nspeed_kt = 10.0\nfrom_deg = 30.0\nup_m_s = 0.5\n",
        INERTIAS[1],
    ],
    [
        "airspeed_ft_s = 176.0",
        "altitude_m = 300.0",
        "kind = \"log-shear\"\nw20_m_s = 5.0\nfrom_deg = 30.0\nroughness_m = 0.6\n",
        INERTIAS[2],
    ],
    [
        "airspeed_m_s = 54.0",
        "altitude_m = 300.0",
        "kind = \"log-shear\"\nw20_kt = 10.0\nfrom_deg = 30.0\nroughness_m = 0.6\n",
        INERTIAS[0],
    ],
    [
        "airspeed_m_s = 54.0",
        "altitude_m = 300.0",
        "kind = \"microburst\"\noutflow_m_s = 8.0\nradius_m = 600.0\npeak_height_m = 40.0\nnorth_m = 700.0\neast_m = 50.0\n",
        INERTIAS[0],
    ],
    [
        "airspeed_m_s = 54.0",
        "altitude_m = 300.0",
        "kind = \"table\"\ntime_s = [0.0, 5.0]\nnorth_m_s = [1.0, 2.0]\neast_m_s = [1.0, 2.0]\n",
        INERTIAS[0],
    ],
    [
        "airspeed_m_s = 54.0",
        "altitude_m = 300.0",
        "kind = \"table\"\ndistance_m = [0.0, 50.0]\nforward_m_s = [1.0, 2.0]\nright_m_s = [1.0, 2.0]\n",
        INERTIAS[0],
    ],
    [
        "airspeed_m_s = 54.0",
        "altitude_m = 300.0",
        "kind = \"table\"\nheight_m = [0.0, 500.0]\nup_m_s = [1.0, 2.0]\n",
        INERTIAS[0],
    ],
];

/// Speed and altitude of the file that another simulator flies.
const CONDITIONS: [[&str; 2]; 5] = [
    ["mach = 0.65", "altitude_ft = 20000.0"],
    ["calibrated_kt = 300.0", "altitude_m = 6000.0"],
    ["airspeed_m_s = 200.0", "altitude_m = 6000.0"],
    ["airspeed_kt = 400.0", "altitude_m = 6000.0"],
    ["airspeed_ft_s = 674.0", "altitude_m = 6000.0"],
];

/// Distance, altitude of the antenna, and targets of the file with an autopilot, in every unit.
const GUIDED: [[&str; 5]; 3] = [
    [
        "distance_m = 6000.0",
        "antenna_altitude_m = 1.0",
        "altitude_m = 310.0",
        "airspeed_m_s = 55.0",
        "vertical_speed_m_s = 0.5",
    ],
    [
        "distance_ft = 20000.0",
        "antenna_altitude_ft = 3.0",
        "altitude_ft = 1020.0",
        "airspeed_kt = 105.0",
        "vertical_speed_ft_min = 100.0",
    ],
    [
        "distance_nmi = 3.0",
        "antenna_altitude_m = 1.0",
        "altitude_m = 310.0",
        "airspeed_ft_s = 180.0",
        "vertical_speed_m_s = 0.5",
    ],
];

/// The supervisor that becomes a network, and the network.
const NETWORK: [&str; 2] = [
    "supervisor.table = \"printed\"\nsupervisor.range = 5.0\nsupervisor.second_input",
    "supervisor.network.error = [1.5, -2.0, 0.5, 3.0, 1.0, -0.5, 2.5, 0.25]
supervisor.network.change = [0.5, 1.0, -1.5, 0.25, 2.0, 1.25, -0.75, 3.0]
supervisor.network.offset = [0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0, 0.25]
supervisor.network.delta_kp = [0.2, -0.1, 0.3, 0.15, -0.25, 0.05, 0.1, -0.2]
supervisor.network.delta_ki = [0.1, 0.2, -0.3, 0.25, 0.15, -0.05, 0.3, 0.35]
supervisor.network.delta_kd = [-0.2, 0.1, 0.4, -0.15, 0.25, 0.45, -0.1, 0.05]
supervisor.range = 5.0\nsupervisor.second_input",
];

/// The files with every key, once for each set-point, and once for each speed, altitude and wind.
pub(crate) fn texts() -> Vec<String> {
    let whole = text("crates/fspid-scenario/tests/scenarios/every-key.toml");
    let flying = text("crates/fspid-scenario/tests/scenarios/every-key-aircraft.toml");
    let commands = SETPOINTS.map(|setpoint| {
        let text = whole.replace(SETPOINTS[0], setpoint);
        if setpoint == SETPOINTS[1] { text.replace(NETWORK[0], NETWORK[1]) } else { text }
    });
    let varied = |text: String, of: [&str; 4]| {
        let parts = VARIATIONS[0].into_iter().zip(of);
        parts.fold(text, |text, (from, to)| text.replace(from, to))
    };
    let variations = VARIATIONS.into_iter().cycle();
    // The many increments of a configuration in the first alone: each number is a flight to be trimmed.
    let short = without_increments(&flying);
    let flights = FLIGHTS.into_iter().zip(variations).enumerate();
    let flights = flights.map(|(index, (flight, variations))| {
        let parts = FLIGHTS[0].into_iter().zip(flight);
        let text = if index == 0 { flying.clone() } else { short.clone() };
        let text = parts.fold(text, |text, (from, to)| text.replace(from, to));
        varied(text, variations)
    });
    let last = varied(short.clone(), VARIATIONS[1]);
    let last = last.replace("flow_lb_h = 80.0", "specific_lb_lbf_h = 0.5");
    let flights = flights.chain([last]);
    let simulated = text("crates/fspid-scenario/tests/scenarios/every-key-simulator.toml");
    let simulated = CONDITIONS.map(|condition| {
        let parts = CONDITIONS[0].into_iter().zip(condition);
        parts.fold(simulated.clone(), |text, (from, to)| text.replace(from, to))
    });
    let guided = text("crates/fspid-scenario/tests/scenarios/every-key-autopilot.toml");
    let guided = GUIDED.map(|units| {
        let parts = GUIDED[0].into_iter().zip(units);
        let text = parts.fold(guided.clone(), |text, (from, to)| text.replace(from, to));
        if units == GUIDED[1] { text.replace(NETWORK[0], NETWORK[1]) } else { text }
    });
    commands.into_iter().chain(flights).chain(simulated).chain(guided).collect()
}

/// The flying file without the rows of its second configuration.
fn without_increments(text: &str) -> String {
    let (before, rest) = text.split_once("[configuration.lift]").expect("a configuration");
    let (_, behind) = rest.split_once("[[configuration_change]]").expect("a change");
    format!("{before}[[configuration_change]]{behind}")
}

/// A controller whose file is not here: a text with it is never good, but its numbers are asked.
const EXTERNAL: &str = "\n[[controller]]\nname = \"own\"\nkind = \"external\"\nlibrary = \"own.so\"\nanswer_limit_s = 1.0\n";

const LAW: &str = "\n[[controller]]\nname = \"law\"\nkind = \"external\"\ncontrol_law = \"own.dml\"\n\n[[controller.input]]\nname = \"one\"\nvalue = 1.0\nat_s = 1.0\n\n[[controller.input]]\nname = \"two\"\nadded = 1.0\n";

const FMU: &str = "[simulator]\nkind = \"fmu\"\nfile = \"own.fmu\"\nanswer_limit_s = 1.0\ntrim_elevator_deg = -2.0\n\n";

/// A number in the file: its line, what stands before it, and whether it is in a list.
struct Number {
    line: usize,
    head: String,
    in_list: bool,
}

fn numbers(text: &str) -> Vec<Number> {
    let number = |(index, line): (usize, &str)| {
        let (key, value) = line.split_once(" = ")?;
        let in_list = value.starts_with('[');
        let first = value.trim_matches(['[', ']']).split(',').next()?;
        first.parse::<f64>().ok()?;
        let head = format!("{key} = ");
        Some(Number { line: index, head, in_list })
    };
    text.lines().enumerate().filter_map(number).collect()
}

fn with(text: &str, number: &Number, value: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let rest = lines[number.line].split_once(", ").map_or("]", |(_, rest)| rest);
    let changed = match number.in_list {
        true => format!("{}[{value}, {rest}", number.head),
        false => format!("{}{value}", number.head),
    };
    lines[number.line] = &changed;
    lines.join("\n")
}

/// The path without list positions, with the kind of each table that has one.
fn normalised(path: &str, document: &Value) -> String {
    let mut at = document;
    let mut words = Vec::new();
    for step in path.split('.') {
        let (name, index) = step.split_once('[').unwrap_or((step, ""));
        at = &at[name];
        if let (Ok(index), true) = (index.trim_end_matches(']').parse::<usize>(), at.is_array()) {
            at = &at[index];
        }
        let kind = at.get("kind").and_then(Value::as_str);
        words.push(kind.map_or(name.to_owned(), |kind| format!("{name}:{kind}")));
    }
    words.join(".")
}

/// The paths of all numbers in the schema, in the same form.
fn in_schema(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    let kind = schema["properties"]["kind"]["const"].as_str();
    let path = kind.map_or(path.to_owned(), |kind| format!("{path}:{kind}"));
    // A number, or a mark in its place.
    let plain = |schema: &Value| match &schema["anyOf"] {
        Value::Array(two) if two.iter().any(|one| one["$ref"].is_string()) => two[0].clone(),
        _ => schema.clone(),
    };
    let (schema, items) = (&plain(schema), &plain(&schema["items"]));
    if ["number", "integer"].iter().any(|word| schema["type"] == *word || items["type"] == *word) {
        found.insert(path.clone());
    }
    for (key, property) in schema["properties"].as_object().into_iter().flatten() {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        in_schema(property, &path, found);
    }
    schema["oneOf"].as_array().into_iter().flatten().for_each(|one| in_schema(one, &path, found));
    if items.is_object() {
        in_schema(items, &path, found);
    }
}

fn refuse(text: &str, number: &Number, value: &str) -> String {
    let bad = with(text, number, value);
    let Err(problems) = file::parse(&bad, "bad.toml", None, &[]) else {
        panic!("{}{value} was accepted", number.head);
    };
    let key = number.head.trim_end_matches(" = ");
    let at_line = |problem: &&file::Problem| {
        problem.line_and_column().0 == number.line + 1 && problem.path.contains(key)
    };
    let found = problems.list.iter().find(at_line);
    let found = found
        .unwrap_or_else(|| panic!("{}{value}, line {}: {problems}", number.head, number.line + 1));
    assert!(
        !found.message.is_empty() && !found.found.is_empty() && !found.allowed.is_empty(),
        "{problems}"
    );
    found.path.clone()
}

#[test]
fn the_file_with_every_key_is_good() {
    for text in texts() {
        let study = file::parse(&text, "every-key.toml", None, &[]);
        let study = study.unwrap_or_else(|problems| panic!("{problems}"));
        assert!(study.warnings.is_empty(), "{:?}", study.warnings);
        assert_eq!(crate::file::schema::fault(&file::schema(), &as_json(&text), ""), None);
    }
}

#[test]
fn every_number_refuses_what_is_no_finite_number_at_its_own_line() {
    let values =
        ["-nan", "inf", "-inf", "1e999", "-1e999", "\"1.0\"", "true", "[]", "{}", "2026-11-20"];
    // By night each, by day three of them in turn.
    let is_long = std::env::var_os("FSPID_LONG_TESTS").is_some();
    let each = if is_long { values.len() } else { 3 };
    let mut bad = values.into_iter().cycle();
    let mut covered = BTreeSet::new();
    let external = texts().swap_remove(0) + EXTERNAL + LAW;
    // As little: its file is not here either.
    let whole = text("crates/fspid-scenario/tests/scenarios/every-key-simulator.toml");
    let (before, rest) = whole.split_once("[simulator]").expect("a simulator");
    let (_, behind) = rest.split_once("[loop]").expect("a loop");
    let fmu = format!("{before}{FMU}[loop]{behind}");
    for text in texts().into_iter().chain([external, fmu]) {
        let document = as_json(&text);
        for number in numbers(&text) {
            // A key that another text has had all of it is asked once more.
            let path = normalised(&refuse(&text, &number, "nan"), &document);
            if !covered.insert(path) {
                continue;
            }
            for value in bad.by_ref().take(each) {
                refuse(&text, &number, value);
            }
        }
    }
    let mut all = BTreeSet::new();
    in_schema(&file::schema(), "", &mut all);
    let missed: Vec<&String> = all.difference(&covered).collect();
    assert!(missed.is_empty(), "numbers that no bad value was tried on: {missed:?}");
    assert!(all.len() > 90, "{}", all.len());
}

#[test]
fn every_number_refuses_what_lies_outside_its_range() {
    let mut covered = BTreeSet::new();
    let mut refused = 0;
    for text in texts() {
        let document = as_json(&text);
        for number in numbers(&text) {
            // A key that another text has had all of it is not asked again.
            let path = normalised(&refuse(&text, &number, "nan"), &document);
            if covered.insert(path) {
                refused += refused_outside(&text, &number);
            }
        }
    }
    assert!(refused > 500, "{refused}");
}

/// How many of some values the schema, which is the second opinion on what is in range, does not allow: each is refused.
fn refused_outside(text: &str, number: &Number) -> usize {
    let outside = |value: &&&str| {
        let bad = as_json(&with(text, number, value));
        crate::file::schema::fault(&crate::file::schema::SCHEMA, &bad, "").is_some()
    };
    let outside: Vec<_> = ["-1", "0", "-1e-9", "1e301"].iter().filter(outside).collect();
    outside.iter().for_each(|value| drop(refuse(text, number, value)));
    outside.len()
}

#[test]
fn whole_numbers_refuse_fractions_and_what_does_not_fit() {
    let text = &texts()[0];
    let whole = ["schema = ", "delay_samples = ", "seed = "];
    let numbers = numbers(text);
    let numbers: Vec<&Number> =
        numbers.iter().filter(|number| whole.contains(&number.head.as_str())).collect();
    assert_eq!(numbers.len(), 4);
    for number in numbers {
        for value in
            ["1.5", "-1", "1e3", "99999999999999999999", "170141183460469231731687303715884105728"]
        {
            refuse(text, number, value);
        }
    }
}
