//! What holds for the figures of every report: names of axes in one style, curves that a script can read.

use crate::common;

use std::path::Path;

use common::{code, fspid, text};

/// Commands that write reports, in this order in one folder, and where their figures are.
const REPORTS: [(&str, &str); 9] = [
    ("init pitch.toml", ""),
    ("simulate pitch.toml --report flight.html", "flight.html"),
    ("analyse pitch.toml --report loop.html", "loop.html"),
    ("init --template fuzzy-system tip.toml", ""),
    ("audit tip.toml --report audit.html", "audit.html"),
    ("init --template campaign campaign.toml", ""),
    ("campaign run campaign.toml --runs 40 --quiet --out run", ""),
    ("campaign report run --out campaign.html", "campaign.html"),
    ("reproduce --out paper", "paper/report.html"),
];

fn reports(folder: &Path) -> Vec<(&'static str, String)> {
    let run = |(command, page): &(&str, &'static str)| {
        let arguments: Vec<&str> = command.split(' ').collect();
        let output = fspid(&arguments, folder);
        assert!(code(&output) < 2, "{command}: {}", text(&output.stderr));
        let html = std::fs::read_to_string(folder.join(page)).unwrap_or_default();
        (*page, html)
    };
    REPORTS.iter().map(run).filter(|(page, _)| !page.is_empty()).collect()
}

/// What stands in every attribute of that name.
fn values<'a>(html: &'a str, attribute: &str) -> Vec<&'a str> {
    let start = format!(" {attribute}=\"");
    // What follows the last figure is the script, which speaks of attributes too.
    let figures = html.rsplit_once("<script>").map_or(html, |(before, _)| before);
    let rest = figures.split(start.as_str()).skip(1);
    rest.filter_map(|rest| rest.split('"').next()).collect()
}

/// Names of the axes, the whole name for every line of a longer one.
fn axis_names<'a>(html: &'a str, axis: &str) -> Vec<&'a str> {
    let start = format!(" data-axis=\"{axis}\" data-label=\"");
    let rest = html.split(start.as_str()).skip(1);
    rest.filter_map(|rest| rest.split('"').next()).filter(|name| !name.is_empty()).collect()
}

/// A name, or a name and its unit in brackets: once, last, and not in any other way.
fn is_named_well(label: &str) -> bool {
    let (name, unit) = match label.strip_suffix(']') {
        Some(rest) => match rest.rsplit_once(" [") {
            Some((name, unit)) => (name, Some(unit)),
            None => return false,
        },
        None => (label, None),
    };
    const UNITS: [&str; 12] = [
        "deg",
        "rad",
        "s",
        "1/s",
        "deg/s",
        "rad/s",
        "%",
        "dB",
        "m",
        "m/s",
        "supervisor units",
        "deg s",
    ];
    let tells_in_another_way = UNITS
        .iter()
        .any(|unit| name.ends_with(&format!("({unit})")) || name.ends_with(&format!(", {unit}")));
    !name.is_empty()
        && !name.contains(['[', ']'])
        && unit.is_none_or(|unit| !unit.is_empty() && !unit.contains(['[', ']']))
        && !tells_in_another_way
}

#[test]
fn every_axis_of_every_report_names_its_unit_once_in_brackets() {
    let folder = tempfile::tempdir().expect("a folder");
    for (page, html) in reports(folder.path()) {
        let labels = ["x", "y"].map(|axis| axis_names(&html, axis)).concat();
        assert!(labels.len() > 1, "{page} names no axis");
        for label in labels {
            assert!(is_named_well(label), "{page}: {label}");
        }
        for panel in values(&html, "data-panel") {
            let numbers: Vec<f64> = panel.split(' ').filter_map(|it| it.parse().ok()).collect();
            assert_eq!(numbers.len(), 4, "{page}: {panel}");
        }
        for axis in [values(&html, "data-x"), values(&html, "data-y")].concat() {
            let ends: Vec<f64> = axis.split(' ').filter_map(|it| it.parse().ok()).collect();
            assert!(matches!(ends.as_slice(), [low, high] if low < high), "{page}: {axis}");
        }
    }
}

#[test]
fn units_in_round_brackets_or_after_a_comma_are_found() {
    for good in ["time [s]", "kp", "ratio of costs (below 1: FSPID better)", "air, downward [m/s]"]
    {
        assert!(is_named_well(good), "{good}");
    }
    for bad in ["time (s)", "time, s", "time [s] [s]", "[s]", "time []"] {
        assert!(!is_named_well(bad), "{bad}");
    }
}
