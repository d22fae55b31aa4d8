//! What holds for every figure, whatever goes in.

use std::sync::OnceLock;

use super::*;

const ODD: [f64; 12] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    1e300,
    -1e300,
    5e-324,
    1e-12,
    1.0 + f64::EPSILON,
];

/// Numbers from zero to one that are the same in each run.
pub(super) struct Draw(pub(super) u64);

impl Draw {
    pub(super) fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn odd(&mut self) -> f64 {
        ODD[(self.next() * ODD.len() as f64) as usize % ODD.len()]
    }

    pub(super) fn mixed(&mut self) -> f64 {
        if self.next() < 0.5 { self.odd() } else { self.next() * 10.0 - 5.0 }
    }

    pub(super) fn list(&mut self, most: usize) -> Vec<f64> {
        let count = (self.next() * (most + 1) as f64) as usize;
        (0..count).map(|_| self.mixed()).collect()
    }

    pub(super) fn range(&mut self) -> Option<(f64, f64)> {
        (self.next() < 0.4).then(|| (self.mixed(), self.mixed()))
    }

    pub(super) fn series(&mut self) -> Series {
        Series {
            name: ["", "FSPID", "a <b> & \"c\"", "k_{p"][(self.next() * 4.0) as usize % 4]
                .to_owned(),
            style: SeriesStyle::Numbered((self.next() * 20.0) as usize),
            x: self.list(6),
            y: self.list(6),
            stairs: self.next() < 0.5,
        }
    }

    fn line(&mut self) -> LineFigure {
        let panels = (self.next() * 4.0) as usize;
        LineFigure {
            title: "odd".to_owned(),
            panels: (0..panels)
                .map(|_| LinePanel {
                    y_label: "y [deg]".to_owned(),
                    x_label: "x [s]".to_owned(),
                    series: (0..2).map(|_| self.series()).collect(),
                    bands: vec![Band {
                        label: "band".to_owned(),
                        lower: self.mixed(),
                        upper: self.mixed(),
                    }],
                    x_range: self.range(),
                    beginnings: vec![self.mixed(), self.mixed()],
                    y_range: self.range(),
                })
                .collect(),
            width_px: self.mixed() * 200.0,
        }
    }

    fn ratio(&mut self) -> RatioFigure {
        RatioFigure {
            title: "odd".to_owned(),
            x_label: "x".to_owned(),
            y_label: "y".to_owned(),
            series: (0..3).map(|_| self.series()).collect(),
            log_x: self.next() < 0.5,
            log_y: self.next() < 0.5,
            reference: Some((self.mixed(), "one".to_owned())),
            width_px: 720.0,
        }
    }

    fn surface(&mut self) -> Surface {
        let rows = (self.next() * 5.0) as usize;
        Surface {
            title: "odd".to_owned(),
            x_label: "x".to_owned(),
            y_label: "y".to_owned(),
            z_label: "z".to_owned(),
            xs: self.list(5),
            ys: self.list(5),
            values: (0..rows).map(|_| self.list(5)).collect(),
            limit: (self.next() < 0.3).then(|| self.mixed()),
        }
    }
}

fn table() -> RuleTable {
    RuleTable {
        title: "rules".to_owned(),
        row_header: "e".to_owned(),
        column_header: "ec".to_owned(),
        labels: SEVEN.map(str::to_owned).to_vec(),
        cells: vec![vec!["PB".to_owned(), "??".to_owned()], Vec::new()],
        shades: Vec::new(),
        marked: vec![
            Mark { row: 0, column: 1, reason: "not a label".to_owned() },
            Mark { row: 90, column: 90, reason: "outside".to_owned() },
        ],
    }
}

fn sine(n: u32, phase: f64) -> LineFigure {
    let x: Vec<f64> = (0..n).map(|k| f64::from(k) * 1e-3).collect();
    let y = x.iter().map(|t| (t + phase).sin()).collect();
    let series =
        vec![Series { name: "s".to_owned(), style: SeriesStyle::Numbered(0), x, y, stairs: false }];
    let panel = LinePanel { series, ..LinePanel::default() };
    LineFigure { title: "sine".to_owned(), panels: vec![panel], width_px: 720.0 }
}

/// One of each kind, ordinary and odd; drawn once for all tests.
fn gallery() -> &'static [Svg] {
    static GALLERY: OnceLock<Vec<Svg>> = OnceLock::new();
    GALLERY.get_or_init(draw_gallery)
}

fn draw_gallery() -> Vec<Svg> {
    let mut draw = Draw(7);
    let mut all =
        vec![diagrams::aircraft_axes(), diagrams::pitch_loop(), diagrams::self_tuning_pid()];
    all.extend([table().render(), RuleTable::default().render(), sine(2_000, 0.0).render()]);
    for _ in 0..150 {
        all.push(draw.line().render());
        all.push(draw.ratio().render());
        all.push(draw.surface().render(SurfaceKind::Map));
        all.push(draw.surface().render(SurfaceKind::View));
        let points = draw.list(8).into_iter().zip(draw.list(8)).collect();
        all.push(memberships(
            "odd",
            "x",
            vec![("NB".to_owned(), points), ("PB".to_owned(), Vec::new())],
        ));
    }
    for _ in 0..40 {
        all.extend(analysis::tests::odd(&mut draw));
    }
    all.extend(analysis::tests::ordinary());
    for _ in 0..40 {
        all.extend(campaign::tests::odd(&mut draw));
    }
    all.extend(campaign::tests::ordinary());
    all
}

/// Checks nesting, quoting and escapes; returns all ids.
pub(super) fn ids_of_well_formed(svg: &str) -> Vec<String> {
    let mut open: Vec<&str> = Vec::new();
    let mut ids = Vec::new();
    for (n, part) in svg.split('<').enumerate() {
        if n == 0 {
            assert_eq!(part, "", "text before the root");
            continue;
        }
        let (tag, text) = part.split_once('>').expect("a tag without end");
        for entity in text.split('&').skip(1).chain(tag.split('&').skip(1)) {
            assert!(
                ["amp;", "lt;", "gt;", "quot;"].iter().any(|known| entity.starts_with(known)),
                "{entity}"
            );
        }
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
            continue;
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        ids.extend(
            tag.split(" id=\"")
                .skip(1)
                .filter_map(|rest| rest.split('"').next())
                .map(str::to_owned),
        );
        if !tag.ends_with('/') {
            open.push(tag.split(' ').next().unwrap_or(""));
        } else {
            assert!(text.trim().is_empty());
        }
    }
    assert!(open.is_empty(), "{open:?}");
    ids
}

#[test]
fn every_figure_is_well_formed_and_its_ids_are_unique() {
    for svg in gallery() {
        let mut ids = ids_of_well_formed(svg.as_str());
        let count = ids.len();
        ids.sort();
        ids.dedup();
        assert_eq!(ids.len(), count);
        assert!(ids.iter().all(|id| id.starts_with("fig-")));
    }
}

#[test]
fn no_figure_contains_nan_or_infinity_or_a_negative_zero() {
    for svg in gallery() {
        let text = svg.as_str();
        assert!(!text.contains("NaN") && !text.contains("inf\""), "{text}");
        assert!(
            !text.contains(">-0<") && !text.contains(">\u{2212}0<") && !text.contains("\"-0\"")
        );
        assert!(!text.contains(">\u{2212}0.0<"));
    }
}

#[test]
fn every_figure_speaks_to_screen_readers_and_needs_nothing_from_outside() {
    for svg in gallery() {
        let text = svg.as_str();
        assert!(text.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
        for needed in ["viewBox=\"0 0 ", "role=\"img\"", "<title id=", "<desc id="] {
            assert!(text.contains(needed), "{needed}");
        }
        assert!(!text.contains("href") && !text.contains("url(http") && !text.contains("<script"));
        assert!(!text.contains("role:"), "a colour token was left over");
    }
}

#[test]
fn the_same_input_gives_the_same_bytes_and_other_input_other_ids() {
    assert_eq!(gallery(), draw_gallery());
    let (one, two) = (sine(100, 0.0).render(), sine(100, 0.5).render());
    let shared: Vec<String> = ids_of_well_formed(one.as_str());
    assert!(ids_of_well_formed(two.as_str()).iter().all(|id| !shared.contains(id)));
}

#[test]
fn a_hundred_thousand_samples_make_a_small_file_that_keeps_its_peak() {
    let clean = sine(100_000, 0.0).render();
    assert!(clean.as_str().len() < 40_000, "{}", clean.as_str().len());
    let mut noisy = sine(100_000, 0.0);
    let mut draw = Draw(1);
    for y in &mut noisy.panels[0].series[0].y {
        *y += draw.next();
    }
    let svg = noisy.render();
    assert!(svg.as_str().len() < 80_000, "{}", svg.as_str().len());
}

#[test]
fn a_series_is_named_once_although_two_panels_show_it() {
    let mut figure = sine(100, 0.0);
    figure.panels[0].series[0].name = "the only name".to_owned();
    figure.panels.push(figure.panels[0].clone());
    let svg = figure.render();
    assert_eq!(svg.as_str().matches(">the only name<").count(), 1);
}

#[test]
fn marked_cells_carry_a_letter_and_a_footnote() {
    let svg = table().render();
    assert!(svg.as_str().contains("not a label"));
    assert!(svg.as_str().contains("font-size=\"75%\">a</tspan>"));
}

#[test]
fn the_page_style_knows_every_colour_that_figures_use() {
    let style = page_style();
    for svg in gallery() {
        for rest in svg.as_str().split("var(").skip(1) {
            let name = rest.split(',').next().unwrap_or("");
            assert!(style.contains(&format!("{name}:")), "{name}");
        }
    }
}
