//! Figures of campaigns; their numbers stand for those of a few thousand flights.

use fspid_plot::{
    DistributionFigure, DistributionRow, EnvelopeBand, EnvelopeFigure, EnvelopePanel,
    IntervalColumn, IntervalFigure, IntervalMark, IntervalRow, LimitLine, RunScatter, SeriesStyle,
    ShareCell, ShareMap, Svg,
};

const CONTROLLERS: [&str; 2] = ["CPID", "FSPID"];

/// One figure of each kind.
pub(crate) fn figures() -> Vec<(&'static str, Svg)> {
    vec![
        ("campaign-failing", failing().render()),
        ("campaign-influence", influence().render()),
        ("campaign-overshoot", overshoot().render()),
        ("campaign-pitch", pitch().render()),
        ("campaign-runs", runs().render()),
        ("campaign-map", map().render()),
    ]
}

fn mark(column: usize, n: usize, [value, lower, upper]: [f64; 3]) -> IntervalMark {
    IntervalMark { column, style: SeriesStyle::Numbered(n), value, lower, upper }
}

fn failing() -> IntervalFigure {
    let row = |n: usize, ends: [f64; 3], words: &str| IntervalRow {
        name: CONTROLLERS[n].to_owned(),
        words: words.to_owned(),
        marks: vec![mark(0, n, ends)],
    };
    IntervalFigure {
        title: "Probability that a flight fails".to_owned(),
        columns: vec![IntervalColumn {
            label: "probability [%]".to_owned(),
            ..IntervalColumn::default()
        }],
        rows: vec![
            row(0, [4.1, 3.6, 4.7], "4.10 % (3.6 to 4.7 %)"),
            row(1, [0.0, 0.0, 0.06], "none of 5000: at most 0.06 %"),
        ],
        series: Vec::new(),
        width_px: 720.0,
    }
}

fn influence() -> IntervalFigure {
    let row = |name: &str, marks: [[f64; 4]; 2]| IntervalRow {
        name: name.to_owned(),
        words: String::new(),
        marks: marks
            .into_iter()
            .enumerate()
            .flat_map(|(n, [share, error, rank, half])| {
                let shares = mark(0, n, [share, share - error, share + error]);
                [shares, mark(1, n, [rank, rank - half, rank + half])]
            })
            .collect(),
    };
    let column =
        |label: &str, range| IntervalColumn { label: label.to_owned(), range, stems: true };
    IntervalFigure {
        title: "What the overshoot depends on".to_owned(),
        columns: vec![
            column("share of the variance [%]", Some((0.0, 100.0))),
            column("rank correlation", Some((-1.0, 1.0))),
        ],
        rows: vec![
            row("servo_time_constant_s", [[61.0, 3.0, 0.78, 0.02], [48.0, 3.0, 0.66, 0.02]]),
            row("elevator_effectiveness", [[22.0, 2.0, -0.44, 0.03], [31.0, 3.0, -0.52, 0.03]]),
            row("short_period_damping", [[9.0, 2.0, -0.29, 0.04], [12.0, 2.0, -0.33, 0.03]]),
            row("short_period_stiffness", [[1.0, 1.0, 0.02, 0.04], [0.5, 1.0, -0.01, 0.04]]),
        ],
        series: (0..2).map(|n| (CONTROLLERS[n].to_owned(), SeriesStyle::Numbered(n))).collect(),
        width_px: 720.0,
    }
}

fn overshoot() -> DistributionFigure {
    let row = |n: usize, middle: f64, spread: f64, words: &str| {
        let edges: Vec<f64> =
            (0..=30).map(|k| middle + spread * (f64::from(k) / 5.0 - 2.4)).collect();
        let bell = |x: f64| 900.0 * (-(x - 0.2 * x.abs()).powi(2)).exp();
        let counts = (0..30).map(|k| bell(f64::from(k) / 5.0 - 2.3) as u64).collect();
        let quantiles = [-1.3, -0.5, 0.05, 0.6, 1.7].map(|part| middle + spread * part);
        DistributionRow {
            name: CONTROLLERS[n].to_owned(),
            words: words.to_owned(),
            style: SeriesStyle::Numbered(n),
            edges,
            counts,
            of: 5000,
            quantiles: Some(quantiles),
        }
    };
    DistributionFigure {
        title: "Overshoot".to_owned(),
        x_label: "overshoot [%]".to_owned(),
        rows: vec![
            row(0, 28.0, 4.0, "median 28.2, 5 to 95 %: 22.8 to 34.8"),
            row(1, 18.0, 3.0, "median 18.1, 5 to 95 %: 14.1 to 23.1"),
        ],
        limits: vec![LimitLine { at: 35.0, name: "at most 35 %".to_owned(), most: true }],
        width_px: 720.0,
    }
}

fn pitch() -> EnvelopeFigure {
    let time: Vec<f64> = (0..=600).map(|k| f64::from(k) * 0.02).collect();
    let panel = |n: usize, damping: f64| {
        let response = |by: f64| -> Vec<f64> {
            let (a, w) = (damping * (1.0 - 0.4 * by), 1.4 + 0.2 * by);
            time.iter()
                .map(|t| 1.0 - (-a * t).exp() * ((w * t).cos() + a / w * (w * t).sin()))
                .collect()
        };
        let band = |name: &str, by: f64| {
            let (one, other) = (response(-by), response(by));
            let ends = |pick: fn(f64, f64) -> f64| {
                one.iter().zip(&other).map(|(a, b)| pick(*a, *b)).collect()
            };
            EnvelopeBand { name: name.to_owned(), lower: ends(f64::min), upper: ends(f64::max) }
        };
        EnvelopePanel {
            name: CONTROLLERS[n].to_owned(),
            style: SeriesStyle::Numbered(n),
            x: time.clone(),
            bands: vec![band("all", 2.0), band("5 to 95 %", 1.2), band("25 to 75 %", 0.5)],
            median: response(0.05),
            nominal: response(0.0),
            worst: vec![response(2.0), response(1.9)],
            setpoint: vec![1.0; time.len()],
            y_range: None,
        }
    };
    EnvelopeFigure {
        title: "Pitch of 400 flights".to_owned(),
        x_label: "time [s]".to_owned(),
        y_label: "pitch angle [deg]".to_owned(),
        x_range: None,
        panels: vec![panel(0, 0.5), panel(1, 0.9)],
        width_px: 720.0,
    }
}

/// Points of a low-discrepancy sequence of Kronecker's.
fn points(count: u32) -> Vec<(f64, f64)> {
    let part = |n: u32, by: f64| (f64::from(n) * by).fract();
    (0..count)
        .map(|n| (0.05 + 0.15 * part(n, 0.754_877_666), 0.5 + part(n, 0.569_840_290)))
        .collect()
}

fn fails((servo_s, effectiveness): (f64, f64)) -> bool {
    servo_s * 4.0 - effectiveness * 0.3 > 0.35
}

fn runs() -> RunScatter {
    let (failed, passed): (Vec<_>, Vec<_>) = points(1200).into_iter().partition(|at| fails(*at));
    RunScatter {
        title: "Flights of CPID".to_owned(),
        x_label: "servo_time_constant_s".to_owned(),
        y_label: "elevator_effectiveness".to_owned(),
        ranges: [None, None],
        names: [format!("{} did not fail", passed.len()), format!("{} failed", failed.len())],
        passed,
        failed,
        runs: [Vec::new(), Vec::new()],
    }
}

fn map() -> ShareMap {
    let edges = |from: f64, width: f64| (0..=8).map(|n| from + width * f64::from(n)).collect();
    let mut cells = vec![vec![ShareCell::default(); 8]; 8];
    for at in points(5000) {
        let (column, row) = (((at.0 - 0.05) / 0.018_75) as usize, ((at.1 - 0.5) * 8.0) as usize);
        // A corner that no run reached.
        if let Some(cell) =
            cells.get_mut(row).and_then(|row| row.get_mut(column)).filter(|_| row + column > 1)
        {
            cell.runs += 1;
            cell.counted += u64::from(fails(at));
        }
    }
    ShareMap {
        title: "Share of the flights of CPID that failed".to_owned(),
        x_label: "servo_time_constant_s".to_owned(),
        y_label: "elevator_effectiveness".to_owned(),
        quantity: "flights that failed".to_owned(),
        most_pct: None,
        x_edges: edges(0.05, 0.018_75),
        y_edges: edges(0.5, 0.125),
        cells,
    }
}
