//! What holds for the figures of loop analysis; what holds for every figure is in the tests of the crate.

use super::*;
use crate::tests::Draw;
use crate::text::text_width;
use crate::{Series, SeriesStyle, Svg};

/// A loop with an integrator, a lag and a delay: $L = K e^{-0.1 s} / (s (1 + s/2))$.
fn curve(name: &str, style: usize, gain: f64, count: usize) -> LoopCurve {
    let point = |n: usize| {
        let w = 0.01 * 6000_f64.powf(n as f64 / (count - 1).max(1) as f64);
        let size = gain / (w * (1.0 + w * w / 4.0).sqrt());
        let phase = -std::f64::consts::FRAC_PI_2 - (w / 2.0).atan() - 0.1 * w;
        LoopPoint { frequency_rad_s: w, real: size * phase.cos(), imaginary: size * phase.sin() }
    };
    let points = (0..count).map(point).collect();
    LoopCurve { name: name.to_owned(), style: SeriesStyle::Numbered(style), points }
}

fn bode(curves: Vec<LoopCurve>) -> BodeFigure {
    let mark = |frequency_rad_s, margin| MarginMark { curve: 0, frequency_rad_s, margin };
    BodeFigure {
        title: "Open loop".to_owned(),
        curves,
        margins: vec![
            mark(0.91, Margin::PhaseDeg(60.3)),
            mark(4.1, Margin::GainDb(19.4)),
            mark(1e9, Margin::GainDb(1.0)),
        ],
        nyquist_rad_s: Some(62.83),
        width_px: 720.0,
    }
}

fn nyquist(curves: Vec<LoopCurve>) -> NyquistFigure {
    let disk = |gain_min, gain_max| MarginDisk {
        name: format!("disk from {gain_min} to {gain_max}"),
        curve: 0,
        gain_min,
        gain_max,
    };
    let disks = vec![disk(0.5, 2.0), disk(-1.0, 3.0), disk(0.9, f64::INFINITY)];
    NyquistFigure { title: "Nyquist".to_owned(), curves, disks, reach: 2.0 }
}

fn nichols(curves: Vec<LoopCurve>) -> NicholsFigure {
    NicholsFigure {
        title: "Nichols".to_owned(),
        curves,
        contours_db: CLOSED_LOOP_DB.to_vec(),
        exclusion: Some(Exclusion::boxed("6 dB and 45 deg", 6.0, 45.0)),
        width_px: 720.0,
    }
}

fn sensitivity(curves: Vec<LoopCurve>) -> SensitivityFigure {
    let peak = |transfer, frequency_rad_s, peak_db| PeakMark {
        curve: 0,
        transfer,
        frequency_rad_s,
        peak_db,
    };
    SensitivityFigure {
        title: "Sensitivities".to_owned(),
        curves,
        peaks: vec![peak(Transfer::Sensitivity, 2.0, 1.9), peak(Transfer::Complementary, 0.7, 0.1)],
        disk_margins: vec![(0, 1.1), (7, 0.2)],
        nyquist_rad_s: Some(62.83),
        width_px: 720.0,
    }
}

fn locus(count: usize) -> RootLocus {
    let sample = |n: usize| {
        let factor = 0.01 + 2.0 * n as f64 / count.max(1) as f64;
        let (re, im) = (0.9 - 0.1 * factor, 0.3 * factor);
        LocusSample { factor, poles: vec![(re, -im), (0.2 * factor, 0.0), (re, im)] }
    };
    RootLocus {
        title: "Root locus".to_owned(),
        dt_s: 0.05,
        samples: (0..count).map(sample).collect(),
        poles_at_one: vec![(0.8, 0.3), (0.8, -0.3), (0.2, 0.0)],
        open_poles: vec![(0.9, 0.0), (0.9, 0.0), (0.0, 0.0)],
        open_zeros: vec![(-3.7, 0.0), (-0.2, 0.0), (3.0, 4.0)],
        crossings: vec![Crossing { factor: 1.96, at: (0.7, 0.59) }],
    }
}

fn poles(closed_poles: Vec<(f64, f64)>) -> PoleZeroMap {
    PoleZeroMap {
        title: "Poles".to_owned(),
        dt_s: 0.01,
        open_poles: vec![(1.0, 0.0), (0.99, 0.0)],
        open_zeros: vec![(0.98, 0.0)],
        closed_poles,
    }
}

fn map(count: usize) -> GainMap {
    let nodes: Vec<f64> = (0..count).map(|n| n as f64 - 4.0).collect();
    let cell = |x: &f64, y: &f64| match x + y {
        sum if sum > 6.0 => MapCell::Unstable,
        sum if sum < -6.0 => MapCell::Unbounded,
        sum => MapCell::Value(8.0 - sum),
    };
    GainMap {
        title: "Gain margin".to_owned(),
        x_label: "error e [deg]".to_owned(),
        y_label: "change ec [deg/s]".to_owned(),
        quantity: "gain margin [dB]".to_owned(),
        cells: nodes.iter().map(|y| nodes.iter().map(|x| cell(x, y)).collect()).collect(),
        xs: nodes.clone(),
        ys: nodes,
        scale: None,
        required: Some((6.0, "6 dB".to_owned())),
        worst: Some(MapPoint { at: (4.0, 4.0), name: "unstable at the corner".to_owned() }),
        equilibrium: Some(MapPoint { at: (0.0, 0.0), name: "8 dB".to_owned() }),
        flown: (0..200).map(|n| (3.0 - 0.01 * f64::from(n), 0.02 * f64::from(n) - 3.0)).collect(),
    }
}

fn surface(count: usize) -> GainSurface {
    let map = map(count);
    let gains = map.ys.iter().map(|y| map.xs.iter().map(|x| 2.0 + 0.1 * x * y).collect()).collect();
    GainSurface { map, gain_label: "k_{p}".to_owned(), gains }
}

fn series(name: &str, y: impl Fn(f64) -> f64, count: u32) -> Series {
    let x: Vec<f64> = (0..count).map(|n| f64::from(n) * 0.05).collect();
    let y = x.iter().map(|t| y(*t)).collect();
    Series { name: name.to_owned(), style: SeriesStyle::Numbered(0), x, y, stairs: false }
}

fn radius(count: u32) -> RadiusFigure {
    RadiusFigure {
        title: "Spectral radius".to_owned(),
        x_label: "time [s]".to_owned(),
        radii: vec![series("gains frozen", |t| 0.99 + 0.02 * (-t).exp(), count)],
        below: vec![series("k_{p}", |t| 2.0 + t.sin(), count)],
        below_label: "gains".to_owned(),
        width_px: 720.0,
    }
}

fn gain_set(count: usize) -> GainSet {
    let states = [CellState::Proved, CellState::Proved, CellState::Open, CellState::Refuted];
    let cell = |n: usize| {
        let at = |step: usize| (n / step % 22) as f64 * 0.05;
        let lower = [1.0 + at(1), 0.2 + at(22), 0.5 + at(484)];
        GainCell { lower, upper: lower.map(|gain| gain + 0.05), state: states[n % 4] }
    };
    GainSet {
        title: "Gains".to_owned(),
        labels: ["k_{p}", "k_{i} [1/s]", "k_{d} [s]"].map(str::to_owned),
        cells: (0..count).map(cell).collect(),
        hull: (0..count).map(|n| cell(n).lower).collect(),
        nominal: Some([1.2, 0.3, 0.6]),
        equilibrium: Some([1.3, 0.4, 0.5]),
        unstable: vec![[2.0, 1.0, 0.5]],
        flown: (0..count)
            .map(|n| [1.2, 0.3, 0.5].map(|gain| gain + 0.5 * (n as f64 * 0.001).sin()))
            .collect(),
    }
}

/// One figure of each kind with usual data of about `count` points.
fn each(count: usize) -> Vec<Svg> {
    let curves = || vec![curve("FSPID", 0, 0.9, count), curve("CPID", 1, 4.0, count)];
    let nodes = count.min(300);
    vec![
        bode(curves()).render(),
        nyquist(curves()).render(),
        nichols(curves()).render(),
        sensitivity(curves()).render(),
        locus(count.min(3_000)).render(),
        poles(vec![(0.99, 0.02), (0.99, -0.02), (0.2, 0.0)]).render(),
        map(nodes).render(),
        surface(nodes).render(),
        radius(count as u32).render(),
        gain_set(count.min(10_000)).render(),
    ]
}

/// Figures with ordinary data.
pub(crate) fn ordinary() -> Vec<Svg> {
    [0, 1, 2, 9, 200].into_iter().flat_map(each).collect()
}

/// Figures of numbers that no loop has.
pub(crate) fn odd(draw: &mut Draw) -> Vec<Svg> {
    let mut curves: Vec<LoopCurve> = Vec::new();
    for _ in 0..2 {
        let style = SeriesStyle::Numbered((draw.next() * 20.0) as usize);
        let numbers = draw.list(30);
        let point = |part: &[f64]| LoopPoint {
            frequency_rad_s: part[0],
            real: part[1],
            imaginary: part[2],
        };
        let points = numbers.chunks_exact(3).map(point).collect();
        curves.push(LoopCurve { name: "a <b> & \"c\"".to_owned(), style, points });
    }
    let mut found = odd_loops(draw, &curves);
    found.extend(odd_poles(draw));
    found.extend(odd_gains(draw));
    found
}

fn pairs(draw: &mut Draw) -> Vec<(f64, f64)> {
    draw.list(6).into_iter().zip(draw.list(6)).collect()
}

fn triples(draw: &mut Draw) -> Vec<[f64; 3]> {
    draw.list(12).chunks_exact(3).map(|part| [part[0], part[1], part[2]]).collect()
}

fn odd_poles(draw: &mut Draw) -> [Svg; 2] {
    let samples =
        (0..4).map(|_| LocusSample { factor: draw.mixed(), poles: pairs(draw) }).collect();
    let plane = RootLocus {
        title: "odd".to_owned(),
        dt_s: draw.mixed(),
        samples,
        poles_at_one: pairs(draw),
        open_poles: pairs(draw),
        open_zeros: pairs(draw),
        crossings: vec![Crossing { factor: draw.odd(), at: (draw.mixed(), draw.odd()) }],
    };
    [plane.render(), PoleZeroMap { dt_s: draw.odd(), ..poles(pairs(draw)) }.render()]
}

fn odd_gains(draw: &mut Draw) -> [Svg; 4] {
    let cells = (0..4).map(|_| draw.list(5).into_iter().map(MapCell::Value).collect()).collect();
    let map = GainMap {
        xs: draw.list(5),
        ys: draw.list(5),
        cells,
        scale: draw.range(),
        required: Some((draw.odd(), "so much".to_owned())),
        flown: pairs(draw),
        ..map(0)
    };
    let drawn = map.render();
    let gains = (0..4).map(|_| draw.list(5)).collect();
    let surface = GainSurface { map, gains, gain_label: "k_{p".to_owned() };
    let (radii, below) = (vec![draw.series(), draw.series()], vec![draw.series()]);
    let radius = RadiusFigure { radii, below, width_px: draw.mixed() * 200.0, ..radius(0) };
    let boxes = triples(draw).into_iter().zip(triples(draw));
    let cell = |(lower, upper)| GainCell { lower, upper, state: CellState::Open };
    let set = GainSet {
        cells: boxes.map(cell).collect(),
        hull: triples(draw),
        unstable: triples(draw),
        flown: triples(draw),
        nominal: triples(draw).first().copied(),
        ..gain_set(0)
    };
    [drawn, surface.render(), radius.render(), set.render()]
}

fn odd_loops(draw: &mut Draw, curves: &[LoopCurve]) -> Vec<Svg> {
    let nyquist_rad_s = Some(draw.odd());
    let mark =
        MarginMark { curve: 1, frequency_rad_s: draw.mixed(), margin: Margin::GainDb(draw.odd()) };
    let turned = MarginMark { margin: Margin::PhaseDeg(draw.odd()), ..mark };
    let bode = BodeFigure { margins: vec![mark, turned], nyquist_rad_s, ..bode(curves.to_vec()) };
    let disk = MarginDisk {
        name: "disk".to_owned(),
        curve: 9,
        gain_min: draw.mixed(),
        gain_max: draw.mixed(),
    };
    let plane =
        NyquistFigure { disks: vec![disk], reach: draw.mixed(), ..nyquist(curves.to_vec()) };
    let corners = draw.list(4).into_iter().zip(draw.list(4)).collect();
    let chart = NicholsFigure {
        contours_db: draw.list(5),
        exclusion: Some(Exclusion { name: "odd".to_owned(), corners }),
        ..nichols(curves.to_vec())
    };
    let peaks = vec![PeakMark {
        curve: 0,
        transfer: Transfer::Sensitivity,
        frequency_rad_s: draw.mixed(),
        peak_db: draw.odd(),
    }];
    let disk_margins = vec![(0, draw.odd()), (1, draw.mixed())];
    let over =
        SensitivityFigure { peaks, disk_margins, nyquist_rad_s, ..sensitivity(curves.to_vec()) };
    vec![bode.render(), plane.render(), chart.render(), over.render()]
}

/// Boxes of the upright and of the vertical texts of a figure: left, top, right, bottom.
pub(crate) fn text_boxes(svg: &str) -> Vec<([f64; 4], String)> {
    let attribute = |tag: &str, name: &str| -> Option<f64> {
        tag.split(&format!(" {name}=\"")).nth(1)?.split('"').next()?.parse().ok()
    };
    let mut down = vec![0.0];
    let mut found = Vec::new();
    for part in svg.split('<') {
        let here = *down.last().unwrap();
        if part.starts_with("g ") {
            let shift =
                part.split("translate(").nth(1).and_then(|rest| rest.split([' ', ')']).nth(1));
            down.push(here + shift.map_or(0.0, |y| y.parse::<f64>().unwrap()));
        } else if part.starts_with("/g") {
            down.pop();
        } else if let Some((tag, text)) =
            part.split_once('>').filter(|(tag, _)| tag.starts_with("text "))
        {
            let (x, y) = (attribute(tag, "x").unwrap(), attribute(tag, "y").unwrap() + here);
            let size = attribute(tag, "font-size").unwrap();
            let text = &text
                .replace("&lt;", "<")
                .replace("&gt;", ">")
                .replace("&quot;", "\"")
                .replace("&amp;", "&");
            let width = text_width(text, size);
            let start = if tag.contains("\"middle\"") {
                0.5
            } else {
                f64::from(u8::from(tag.contains("\"end\"")))
            };
            let (before, after) = (width * start, width * (1.0 - start));
            if tag.contains("rotate(-90") {
                found.push((
                    [x - 0.8 * size, y - after, x + 0.2 * size, y + before],
                    text.to_owned(),
                ));
            } else if !tag.contains("rotate") {
                found.push((
                    [x - before, y - 0.8 * size, x + after, y + 0.2 * size],
                    text.to_owned(),
                ));
            }
        }
    }
    found
}

#[test]
fn all_words_stand_inside_of_the_picture() {
    for svg in ordinary() {
        let text = svg.as_str();
        let size = text.split("viewBox=\"0 0 ").nth(1).unwrap().split('"').next().unwrap();
        let (width, height) = size.split_once(' ').unwrap();
        let (width, height): (f64, f64) = (width.parse().unwrap(), height.parse().unwrap());
        let boxes = text_boxes(text);
        assert!(boxes.len() > 4);
        for ([left, top, right, bottom], words) in boxes {
            let inside = left >= 0.0 && top >= 0.0 && right <= width && bottom <= height;
            assert!(inside, "{words}: {left} {top} {right} {bottom} in {width} x {height}");
        }
    }
}

#[test]
fn many_points_make_small_files() {
    for svg in each(100_000) {
        let size = svg.as_str().len();
        assert!(size < 420_000, "{size}: {}", &svg.as_str()[..300]);
    }
}

#[test]
fn values_far_outside_reach_no_path() {
    let mut far = curve("far", 0, 1e12, 300);
    far.points[150].real = 1e300;
    far.points[151].imaginary = -1e250;
    let curves = vec![far];
    let figures = [
        bode(curves.clone()).render(),
        nyquist(curves.clone()).render(),
        nichols(curves.clone()).render(),
        sensitivity(curves).render(),
        poles(vec![(1e200, 0.0), (0.0, -1e9)]).render(),
    ];
    for svg in figures {
        let numbers = svg.as_str().split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next());
        for d in numbers {
            let longest = d.split(|c: char| !c.is_ascii_digit()).map(str::len).max();
            assert!(longest.unwrap_or(0) < 6, "{d}");
        }
    }
}

#[test]
fn a_bode_figure_writes_each_margin_and_the_nyquist_frequency() {
    let svg = bode(vec![curve("FSPID", 0, 0.9, 300)]).render();
    let text = svg.as_str();
    for words in
        [">PM 60.3\u{b0} at 0.91 rad/s<", ">GM 19.4 dB at 4.1 rad/s<", ">Nyquist 62.8 rad/s<"]
    {
        assert!(text.contains(words), "{words}");
    }
    // The margin at a frequency that no curve reaches is not drawn.
    assert!(!text.contains(">GM 1 dB"));
    assert!(text.contains("gain margin 19.4 dB at 4.1 rad/s"));
}

#[test]
fn a_disk_that_holds_no_gain_of_one_is_not_drawn() {
    let svg = nyquist(vec![curve("FSPID", 0, 0.9, 300)]).render();
    assert!(svg.as_str().contains(">disk from 0.5 to 2<"));
    assert!(!svg.as_str().contains(">disk from -1 to 3<"));
}

#[test]
fn unstable_closed_loop_poles_are_called_so() {
    let stable = poles(vec![(0.5, 0.0)]).render();
    assert!(!stable.as_str().contains("UNSTABLE"));
    for outside in [(1.2, 0.0), (1.0, 0.0), (f64::NAN, 0.0)] {
        let svg = poles(vec![(0.5, 0.0), outside]).render();
        assert!(svg.as_str().contains("UNSTABLE"), "{outside:?}");
        assert!(svg.as_str().contains("1 of these not inside the unit circle"));
    }
}

#[test]
fn zeros_beyond_the_picture_are_named_at_its_edge() {
    let svg = locus(50).render();
    assert!(svg.as_str().contains(">\u{2212}3.7<"));
    assert!(svg.as_str().contains(">3 + 4j<"));
    assert!(svg.as_str().contains(">2\u{d7}<"), "a double pole");
    assert!(svg.as_str().contains(">\u{d7}1.96<"), "the factor of the crossing");
}

#[test]
fn lines_of_equal_damping_and_frequency_are_named() {
    let text = poles(vec![(0.5, 0.0)]).render().into_string();
    for words in [">0.1<", ">0.9<", ">100<", ">200<"] {
        assert!(text.contains(words), "{words}");
    }
    // Without a sample period there are no frequencies.
    let without = PoleZeroMap { dt_s: 0.0, ..poles(vec![(0.5, 0.0)]) }.render();
    assert!(!without.as_str().contains(">100<"));
}

#[test]
fn a_map_counts_what_is_unstable_and_what_meets_the_requirement() {
    let svg = map(9).render();
    let text = svg.as_str();
    assert!(text.contains("unstable at 3 of 81 nodes"), "{text}");
    // x + y up to 2 meets 6 dB: all but the 21 nodes above that diagonal.
    assert!(text.contains(">6 dB required: met at 60 of 81 nodes<"));
    assert!(text.contains(">UNSTABLE with the gains frozen there<"));
    assert!(text.contains(">\u{221e}<"));
    // A map that is too fine to be drawn as it is counts all of its nodes nevertheless.
    let dense = map(200);
    let unstable = dense.all().filter(|cell| *cell == MapCell::Unstable).count();
    let words = format!("unstable at {unstable} of 40000 nodes");
    assert!(dense.render().as_str().contains(&words), "{words}");
    assert!(dense.render().as_str().contains(" of 40000 nodes<"));
    // Where all or none is as required there is no line, and none is explained.
    let thick = |map: &GainMap| map.render().as_str().matches("stroke-width=\"2.8\"").count();
    assert!(thick(&map(9)) > 0);
    for required in [-100.0, 100.0] {
        let mut one = map(9);
        one.cells.iter_mut().flatten().for_each(|cell| *cell = MapCell::Value(3.0));
        one.required = Some((required, "so much".to_owned()));
        assert_eq!(thick(&one), 0);
        assert!(one.render().as_str().contains(">so much required: met at "));
    }
    let mut fine = map(9);
    fine.cells[8].truncate(6);
    fine.cells[7].truncate(8);
    assert!(!fine.render().as_str().contains(">UNSTABLE"));
}

#[test]
fn every_face_at_an_unstable_node_is_crossed_out() {
    let mut one = surface(5);
    for row in &mut one.map.cells {
        row.fill(MapCell::Value(3.0));
    }
    let crosses =
        |figure: &GainSurface| figure.render().as_str().matches("stroke-width=\"1.1\"").count();
    assert_eq!(crosses(&one), 0);
    one.map.cells[2][2] = MapCell::Unstable;
    assert_eq!(crosses(&one), 4);
}

#[test]
fn the_greatest_radius_is_written_with_five_decimals_and_the_time_above_one_is_shaded() {
    let svg = radius(100).render();
    assert!(svg.as_str().contains(">1.01000 at 0<"));
    assert!(svg.as_str().contains(">not below 1<"));
    let calm = RadiusFigure { radii: vec![series("calm", |_| 0.999, 50)], ..radius(50) };
    assert!(!calm.render().as_str().contains(">not below 1<"));
}

#[test]
fn boxes_are_counted_by_what_is_known_of_them() {
    let svg = gain_set(8).render();
    for words in [
        ">4 boxes proved<",
        ">2 boxes open<",
        ">2 boxes REFUTED standing still<",
        ">UNSTABLE when frozen<",
    ] {
        assert!(svg.as_str().contains(words), "{words}");
    }
}
