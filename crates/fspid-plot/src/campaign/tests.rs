//! What holds for the figures of campaigns; what holds for every figure is in the tests of the crate.

use super::*;
use crate::analysis::tests::text_boxes;
use crate::tests::Draw;
use crate::{SeriesStyle, Svg};

/// Names that somebody might give to break a page.
const NAMES: [&str; 6] = [
    "FSPID",
    "CPID, same nominal gains",
    "<script>alert(1)</script> & \"quotes\" '",
    "a name that is so long that no figure has room for it, which happens when names are sentences",
    "飛行制御システムの名前がとても長い場合でも図からはみ出してはいけない 🛩🛩🛩",
    "k_{p and ^{ without an end",
];

fn name(n: usize) -> String {
    NAMES[n % NAMES.len()].to_owned()
}

fn intervals(rows: usize, series: usize) -> IntervalFigure {
    let mark = |row: usize, column: usize, n: usize| {
        let value = 0.3 * (1.0 + row as f64) / (1.0 + n as f64) - 0.5 * column as f64;
        IntervalMark {
            column,
            style: SeriesStyle::Numbered(n),
            value,
            lower: value - 0.1,
            upper: value + 0.2,
        }
    };
    let row = |row: usize| IntervalRow {
        name: name(row),
        words: format!("{} %, at most {}", row, name(row + 2)),
        marks: (0..2).flat_map(|column| (0..series).map(move |n| mark(row, column, n))).collect(),
    };
    let column = |label: &str| IntervalColumn { label: label.to_owned(), range: None, stems: true };
    IntervalFigure {
        title: "Share of the variance".to_owned(),
        columns: vec![column("share [%]"), column("rank correlation")],
        rows: (0..rows).map(row).collect(),
        series: (0..series).map(|n| (name(n), SeriesStyle::Numbered(n))).collect(),
        width_px: 720.0,
    }
}

fn distribution(rows: usize, bins: usize) -> DistributionFigure {
    let row = |n: usize| DistributionRow {
        name: name(n),
        words: format!("median 17.2 %, 5 to 95 %: 11.3 to 26.1 %, {}", name(n + 1)),
        style: SeriesStyle::Numbered(n),
        edges: (0..=bins).map(|edge| (n + edge) as f64).collect(),
        counts: (0..bins).map(|bin| (bin * (bins - bin)) as u64).collect(),
        of: 1000,
        quantiles: Some([0.1, 0.3, 0.5, 0.6, 0.9].map(|part| n as f64 + part * bins as f64)),
    };
    let limit = |at, most| LimitLine { at, name: format!("at most {at}"), most };
    DistributionFigure {
        title: "Overshoot".to_owned(),
        x_label: "overshoot [%]".to_owned(),
        rows: (0..rows).map(row).collect(),
        limits: vec![limit(bins as f64 * 1.2, true), limit(1e9, true), limit(-1e9, false)],
        width_px: 720.0,
    }
}

fn envelope(panels: usize, samples: usize) -> EnvelopeFigure {
    let line = |shift: f64| (0..samples).map(|k| shift + (k as f64 * 0.01).sin()).collect();
    let band = |name: &str, by: f64| EnvelopeBand {
        name: name.to_owned(),
        lower: line(-by),
        upper: line(by),
    };
    let panel = |n: usize| EnvelopePanel {
        name: name(n),
        style: SeriesStyle::Numbered(n),
        x: (0..samples).map(|k| k as f64 * 0.01).collect(),
        bands: vec![band("all", 0.9), band("5 to 95 %", 0.5), band("25 to 75 %", 0.2)],
        median: line(0.0),
        nominal: line(0.05),
        worst: vec![line(0.9), line(-0.9)],
        setpoint: vec![0.5; samples],
        y_range: None,
    };
    EnvelopeFigure {
        title: "Pitch".repeat(60),
        x_label: "time [s]".to_owned(),
        y_label: "pitch angle [deg]".to_owned(),
        x_range: None,
        panels: (0..panels).map(panel).collect(),
        width_px: 720.0,
    }
}

fn scatter(points: usize) -> RunScatter {
    let at = |n: usize, by: f64| ((n as f64 * by).sin() + 1.0, (n as f64 * 1.7 * by).cos() - 7.0);
    RunScatter {
        title: format!("Runs of {} and {}", name(points), "word".repeat(60)),
        x_label: name(3),
        y_label: name(2),
        ranges: [None, None],
        passed: (0..points).map(|n| at(n, 0.37)).collect(),
        failed: (0..points / 3).map(|n| at(n, 0.91)).collect(),
        names: [format!("{points} runs that did not fail"), "runs that failed".to_owned()],
        runs: [(0..points as u64).collect(), Vec::new()],
    }
}

fn map(side: usize) -> ShareMap {
    let edges: Vec<f64> = (0..=side).map(|n| 0.05 + n as f64 * 0.01).collect();
    let cell = |n: usize| ShareCell { runs: (n % 7) as u64 * 50, counted: (n % 5) as u64 * 10 };
    ShareMap {
        title: "Share of runs that failed".to_owned(),
        x_label: "servo time constant [s]".to_owned(),
        y_label: name(3),
        quantity: "runs that failed".to_owned(),
        most_pct: None,
        x_edges: edges.clone(),
        y_edges: edges,
        cells: (0..side).map(|i| (0..side).map(|j| cell(i * side + j)).collect()).collect(),
    }
}

fn trade(series: usize, points: usize) -> TradeFigure {
    let at = |n: usize, k: usize| (20.0 + (n * 7 + k) as f64, 3.0 + ((n + 3 * k) % 11) as f64);
    let one = |n: usize| TradeSeries {
        name: name(n),
        style: SeriesStyle::Numbered(n),
        points: (0..points).map(|k| at(n, k)).collect(),
        is_joined: n == 1,
        band: (0..points).map(|k| (at(n, k).0, [2.0, 15.0])).filter(|_| n == 1).collect(),
    };
    TradeFigure {
        title: format!("Error against {}", name(3)),
        x_label: name(3),
        y_label: name(2),
        series: (0..series).map(one).collect(),
    }
}

fn each(count: usize) -> Vec<Svg> {
    vec![
        intervals(count, 2).render(),
        intervals(3, count).render(),
        distribution(count, 20).render(),
        distribution(2, count).render(),
        envelope(count, 50).render(),
        envelope(2, count).render(),
        scatter(count).render(),
        map(count).render(),
        trade(count, 5).render(),
        trade(2, count).render(),
    ]
}

/// Figures with ordinary data.
pub(crate) fn ordinary() -> Vec<Svg> {
    [0, 1, 2, 12].into_iter().flat_map(each).collect()
}

/// Figures of numbers that no campaign has.
pub(crate) fn odd(draw: &mut Draw) -> Vec<Svg> {
    let mut figure = intervals(3, 2);
    for mark in figure.rows.iter_mut().flat_map(|row| &mut row.marks) {
        (mark.value, mark.lower, mark.upper) = (draw.mixed(), draw.mixed(), draw.mixed());
        mark.column = (draw.next() * 3.0) as usize;
    }
    figure.columns[0].range = draw.range();
    figure.width_px = draw.mixed() * 200.0;
    let mut found = vec![figure.render()];
    let mut figure = distribution(2, 5);
    for row in &mut figure.rows {
        row.edges = draw.list(6);
        row.counts = vec![u64::MAX, 0, 3];
        row.of = 0;
        row.quantiles = Some([(); 5].map(|()| draw.mixed()));
    }
    for limit in &mut figure.limits {
        limit.at = draw.mixed();
    }
    found.push(figure.render());
    let mut figure = envelope(2, 8);
    figure.x_range = draw.range();
    for panel in &mut figure.panels {
        panel.x = draw.list(8);
        panel.median = draw.list(8);
        panel.y_range = draw.range();
        panel.worst = vec![draw.list(8), draw.list(8)];
        for band in &mut panel.bands {
            (band.lower, band.upper) = (draw.list(8), draw.list(8));
        }
    }
    found.push(figure.render());
    let pairs =
        |draw: &mut Draw| draw.list(8).into_iter().zip(draw.list(8)).collect::<Vec<(f64, f64)>>();
    let ranges = [draw.range(), draw.range()];
    found.push(
        RunScatter { passed: pairs(draw), failed: pairs(draw), ranges, ..scatter(0) }.render(),
    );
    found.push(
        ShareMap {
            most_pct: Some(draw.mixed()),
            x_edges: draw.list(5),
            y_edges: draw.list(5),
            ..map(4)
        }
        .render(),
    );
    let mut figure = trade(3, 0);
    figure.series.iter_mut().for_each(|series| series.points = pairs(draw));
    found.push(figure.render());
    found
}

/// The values of an attribute, in their order.
fn attributes<'a>(svg: &'a str, name: &str) -> Vec<&'a str> {
    let begin = format!(" {name}=\"");
    svg.split(begin.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

#[test]
fn every_run_of_a_scatter_that_is_drawn_has_its_number() {
    let mut figure = scatter(30);
    figure.runs = [(0..30).map(|n| 3 * n).collect(), vec![7, 9]];
    figure.ranges = [Some((0.0, 1.0)), None];
    let svg = figure.render().into_string();
    let told = attributes(&svg, "data-runs");
    let drawn = figure.passed.iter().filter(|at| at.0 < 1.02).count();
    assert!(drawn < 30 && told[0].split(' ').count() == drawn, "{drawn}: {told:?}");
    // Each is told as its distance from the one before.
    let runs: Vec<i64> = told[0]
        .split(' ')
        .scan(0, |run, step| {
            *run += step.parse::<i64>().unwrap();
            Some(*run)
        })
        .collect();
    let expected = figure.passed.iter().zip(0_i64..).filter(|(at, _)| at.0 < 1.02);
    assert_eq!(runs, expected.map(|(_, n)| 3 * n).collect::<Vec<_>>());
    let nameless = RunScatter { runs: [Vec::new(), Vec::new()], ..figure }.render().into_string();
    assert!(attributes(&nameless, "data-runs").is_empty());
}

#[test]
fn every_box_and_every_bin_can_be_read() {
    let share = map(4);
    let svg = share.render().into_string();
    let cells = attributes(&svg, "data-cells");
    assert_eq!(cells[0].split(';').count(), 16);
    assert!(cells[0].starts_with("no runs;10 of 50, 20 %;20 of 100, 20 %"), "{}", cells[0]);
    assert_eq!(attributes(&svg, "data-columns"), ["0.05 0.06 0.07 0.08 0.09"]);
    for svg in ordinary() {
        let text = svg.as_str();
        let columns = attributes(text, "data-columns");
        let cells = attributes(text, "data-cells");
        assert_eq!(columns.len(), cells.len());
        if attributes(text, "data-rows").is_empty() {
            for (ends, cells) in columns.iter().zip(cells) {
                assert_eq!(ends.split(' ').count(), cells.split(';').count() + 1);
            }
        }
    }
}

#[test]
fn bands_and_lines_of_an_envelope_have_the_names_that_are_read() {
    let mut found = ordinary().into_iter().map(|svg| svg.into_string());
    let svg = found.rfind(|svg| svg.contains("data-curve=\"band\"")).unwrap();
    let names = attributes(&svg, "data-name");
    assert!(names.contains(&"median"), "{names:?}");
}

#[test]
fn all_words_stand_inside_of_the_picture_whatever_they_are() {
    for svg in ordinary() {
        let text = svg.as_str();
        let size = text.split("viewBox=\"0 0 ").nth(1).unwrap().split('"').next().unwrap();
        let (width, height) = size.split_once(' ').unwrap();
        let (width, height): (f64, f64) = (width.parse().unwrap(), height.parse().unwrap());
        for ([left, top, right, bottom], words) in text_boxes(text) {
            let inside = left >= 0.0 && top >= 0.0 && right <= width && bottom <= height;
            assert!(inside, "{words}: {left} {top} {right} {bottom} in {width} x {height}");
        }
    }
}

#[test]
fn no_word_covers_another() {
    for svg in ordinary() {
        let boxes = text_boxes(svg.as_str());
        for (n, (one, words)) in boxes.iter().enumerate() {
            for (other, others) in &boxes[..n] {
                let apart = one[0] >= other[2] || other[0] >= one[2];
                let clear = one[1] >= other[3] - 2.0 || other[1] >= one[3] - 2.0;
                assert!(apart || clear, "\"{words}\" covers \"{others}\": {one:?} {other:?}");
            }
        }
    }
}

#[test]
fn figures_of_many_runs_stay_small() {
    let sizes = [scatter(2000).render(), envelope(2, 5001).render(), map(24).render()];
    for (svg, most) in sizes.iter().zip([220_000, 120_000, 160_000]) {
        assert!(svg.as_str().len() < most, "{}: {}", svg.as_str().len(), &svg.as_str()[..200]);
    }
}

#[test]
fn a_limit_far_away_is_named_at_the_edge_and_does_not_squeeze_the_data() {
    let mut one = distribution(1, 20);
    one.limits.remove(0);
    let svg = one.render();
    let text = svg.as_str();
    assert!(text.contains(">at most 1000000000 \u{25b8}<"), "{text}");
    assert!(text.contains(">\u{25c2} at most -1000000000<"));
    assert!(text.contains(">20<"), "the axis shows the data");
}

#[test]
fn a_box_without_runs_is_hatched_and_not_painted_as_one_without_failures() {
    let mut one = map(2);
    one.cells = vec![vec![ShareCell { runs: 5, counted: 0 }, ShareCell::default()]];
    let text = one.render().into_string();
    assert!(text.contains(">no runs<") && text.contains(">0 %<") && text.contains(">of 5<"));
    assert_eq!(text.matches(" %<").count(), 1);
    one.cells = vec![vec![ShareCell { runs: 5, counted: 5 }; 2]; 2];
    assert!(!one.render().as_str().contains(">no runs<"));
}

#[test]
fn a_share_that_is_not_nought_is_not_written_as_nought() {
    let mut one = map(1);
    one.cells = vec![vec![ShareCell { runs: 1_000_000, counted: 1 }]];
    let text = one.render().into_string();
    assert!(text.contains(">&lt;0.1 %<") && text.contains(">of 1000k<"), "{text}");
}

#[test]
fn an_interval_on_the_axis_of_another_column_is_not_drawn() {
    let mut one = intervals(1, 1);
    let marks = |figure: &IntervalFigure| figure.render().as_str().matches("<circle").count();
    let before = marks(&one);
    one.rows[0].marks.iter_mut().for_each(|mark| mark.column = 7);
    assert_eq!(marks(&one) + 2, before);
}
