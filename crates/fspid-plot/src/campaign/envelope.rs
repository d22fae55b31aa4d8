//! Bands of many responses over time: a panel each, with a middle, a nominal and the worst lines.

use super::areas::{self, abscissa, fitted, name_abscissa, ordinate};
use crate::axis::{Axis, extent, short_number};
use crate::cursor;
use crate::page::{self, EDGE, LABEL_PX};
use crate::plot::TICK_PX;
use crate::style::{Role, SeriesStyle};
use crate::svg::{Anchor, Canvas, Font, Paint, Rect, Svg, polyline_data};
use crate::text::{escape, text_width, unmarked};
use crate::thin;

/// Bands of responses, one panel below the other on the same abscissa.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopeFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name and unit of the abscissa.
    pub x_label: String,
    /// Name and unit of the ordinate.
    pub y_label: String,
    /// Ends of the abscissa; `None` takes those of everything that is drawn. What lies beyond is cut.
    pub x_range: Option<(f64, f64)>,
    /// Panels from top to bottom.
    pub panels: Vec<EnvelopePanel>,
    /// Width of the figure (px); the height follows from the panels.
    pub width_px: f64,
}

/// Responses of one controller. All lists belong to the same abscissas; numbers that are not finite interrupt
/// bands and lines.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopePanel {
    /// Name of the controller.
    pub name: String,
    /// How they are coloured.
    pub style: SeriesStyle,
    /// Abscissas.
    pub x: Vec<f64>,
    /// Bands from the widest to the narrowest.
    pub bands: Vec<EnvelopeBand>,
    /// The middle of the responses.
    pub median: Vec<f64>,
    /// The response with nominal numbers; may be empty.
    pub nominal: Vec<f64>,
    /// Single responses: the worst ones.
    pub worst: Vec<Vec<f64>>,
    /// What was commanded; may be empty.
    pub setpoint: Vec<f64>,
    /// Ends of the ordinate; `None` takes those of everything that is drawn in any panel. What lies beyond is cut.
    pub y_range: Option<(f64, f64)>,
}

/// Between what a share of the responses lies.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopeBand {
    /// Which share, such as "5 to 95 %".
    pub name: String,
    /// Lower end at each abscissa.
    pub lower: Vec<f64>,
    /// Upper end at each abscissa.
    pub upper: Vec<f64>,
}

/// Height of a panel with its name (px).
const NAME: f64 = 20.0;
const PANEL: f64 = 150.0;
const GAP: f64 = 12.0;
/// Shades of the bands from the widest to the narrowest.
const SHADES: [f64; 3] = [0.18, 0.3, 0.45];

impl EnvelopeFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let width = page::sane_width(self.width_px);
        let (x, ys) = self.axes(width);
        let ticks = ys.iter().map(page::tick_room).fold(0.0, f64::max);
        let left = EDGE + page::upright_room(1) + ticks;
        let plot = width - left - EDGE - 8.0;
        let shown = areas::title(&self.title, width);
        let top = page::title_height(&shown, width);
        let legend = Key::of(self);
        let rows = legend.rows(plot);
        let count = self.panels.len().max(1) as f64;
        let bottom = top + rows.len() as f64 * 18.0 + count * (NAME + PANEL + GAP) - GAP;
        let mut canvas = Canvas::new(width, bottom + 50.0);
        page::title(&mut canvas, &shown);
        legend.draw(&mut canvas, (left, top), &rows);
        let mut y_top = top + rows.len() as f64 * 18.0;
        for (n, (panel, y)) in self.panels.iter().zip(&ys).enumerate() {
            let area = Rect { x: left, y: y_top + NAME, width: plot, height: PANEL };
            let last = n + 1 == self.panels.len();
            abscissa(&mut canvas, area, &x, last);
            ordinate(&mut canvas, area, y);
            let name = escape(&unmarked(&panel.name));
            let place = cursor::panel(area, &x, y);
            canvas.begin_marked(&format!("{place} data-name=\"{name}\""));
            Drawing { area, x: &x, y }.panel(&mut canvas, panel);
            canvas.end();
            let font = Font::new(LABEL_PX, Anchor::Start).bold();
            canvas.rect(left, y_top + 3.0, 3.0, 14.0, &Paint::face(panel.style.role()));
            canvas.text(left + 7.0, y_top + 14.2, &fitted(&panel.name, LABEL_PX, plot - 8.0), font);
            let label = page::wrap(&self.y_label, LABEL_PX, PANEL + 8.0);
            let label = [fitted(&label.join(" "), LABEL_PX, PANEL + NAME)];
            page::upright_label(&mut canvas, EDGE + LABEL_PX, area.y + PANEL / 2.0, &label);
            if last {
                name_abscissa(&mut canvas, area, &self.x_label);
            }
            y_top += NAME + PANEL + GAP;
        }
        canvas.finish(&self.title, &self.describe())
    }

    /// The abscissa, and the ordinate of each panel.
    fn axes(&self, width: f64) -> (Axis, Vec<Axis>) {
        let times = self.panels.iter().flat_map(|panel| panel.x.iter().copied());
        let ticks = (width / 90.0) as usize;
        let x = Axis::fixed(self.x_range, ticks)
            .unwrap_or_else(|| Axis::linear(extent(times), 0.0, ticks));
        let found = extent(self.panels.iter().flat_map(EnvelopePanel::values));
        let y = |panel: &EnvelopePanel| {
            Axis::fixed(panel.y_range, 5).unwrap_or_else(|| Axis::linear(found, 0.05, 5))
        };
        (x, self.panels.iter().map(y).collect())
    }

    fn describe(&self) -> String {
        let mut text = format!("Bands of {} over {}.", self.y_label, self.x_label);
        for panel in &self.panels {
            text.push_str(&format!(" {}:", panel.name));
            for band in &panel.bands {
                let ends = extent(band.lower.iter().chain(&band.upper).copied());
                let (lo, hi) = ends.unwrap_or((f64::NAN, f64::NAN));
                let (lo, hi) = (short_number(lo), short_number(hi));
                text.push_str(&format!(" {} from {lo} to {hi};", band.name));
            }
        }
        text
    }
}

impl EnvelopePanel {
    fn values(&self) -> impl Iterator<Item = f64> + '_ {
        let bands = self.bands.iter().flat_map(|band| band.lower.iter().chain(&band.upper));
        let lines = self.worst.iter().flatten().chain(&self.nominal).chain(&self.setpoint);
        bands.chain(&self.median).chain(lines).copied()
    }
}

struct Drawing<'a> {
    area: Rect,
    x: &'a Axis,
    y: &'a Axis,
}

impl Drawing<'_> {
    fn panel(&self, canvas: &mut Canvas, panel: &EnvelopePanel) {
        let role = panel.style.role();
        canvas.begin_clip(self.area);
        for (n, band) in panel.bands.iter().enumerate() {
            let opacity = SHADES.get(n).copied().unwrap_or(SHADES[SHADES.len() - 1]);
            let d = self.band(&panel.x, band);
            if !d.is_empty() {
                canvas.begin_curve("band", &band.name);
                canvas.path(&d, &Paint::face(role).opacity(opacity));
                canvas.end();
            }
        }
        self.line(canvas, (&panel.x, &panel.setpoint), ("set-point", &setpoint_paint()));
        for worst in &panel.worst {
            self.line(canvas, (&panel.x, worst), ("worst", &worst_paint()));
        }
        let median = Paint::line(role, 2.2);
        self.line(canvas, (&panel.x, &panel.median), ("median", &median));
        self.line(canvas, (&panel.x, &panel.nominal), ("nominal", &nominal_paint()));
        canvas.end();
    }

    /// The outline of a band, in as many parts as it has gaps and one.
    fn band(&self, x: &[f64], band: &EnvelopeBand) -> String {
        let both = x.iter().zip(band.lower.iter().zip(&band.upper));
        let points: Vec<_> = both.map(|(x, (lower, upper))| (*x, *lower, *upper)).collect();
        let whole = |p: &(f64, f64, f64)| p.0.is_finite() && p.1.is_finite() && p.2.is_finite();
        let mut d = String::new();
        for run in points.split(|point| !whole(point)) {
            let mut outline = self.thinned(run.iter().map(|p| (p.0, p.1)));
            outline.extend(self.thinned(run.iter().map(|p| (p.0, p.2))).into_iter().rev());
            if outline.len() > 2 {
                d.push_str(&polyline_data(&outline, true));
            }
        }
        d
    }

    /// Points on the canvas without those that nobody would miss.
    fn thinned(&self, points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
        let placed = points.map(|(x, y)| self.place(x, y));
        thin::runs(placed, (1.0, 1.0), false).concat()
    }

    fn line(&self, canvas: &mut Canvas, (x, y): (&[f64], &[f64]), (name, paint): (&str, &Paint)) {
        let placed = x.iter().zip(y).map(|(x, y)| self.place(*x, *y));
        let runs = thin::runs(placed, (1.0, 1.0), false);
        if runs.is_empty() {
            return;
        }
        canvas.begin_curve("line", name);
        for run in runs {
            canvas.polyline(&run, false, paint);
        }
        canvas.end();
    }

    /// Far outside is as good as outside, and keeps numbers short.
    fn place(&self, x: f64, y: f64) -> (f64, f64) {
        let a = self.area;
        let near = |part: f64| if part.is_nan() { part } else { part.clamp(-9.0, 10.0) };
        let (across, up) = (near(self.x.fraction(x)), near(self.y.fraction(y)));
        // Tenths of a pixel: nobody sees more, and a line is a fifth shorter.
        let tenths = |v: f64| libm::round(10.0 * v) / 10.0;
        (tenths(a.x + across * a.width), tenths(a.y + (1.0 - up) * a.height))
    }
}

fn setpoint_paint() -> Paint {
    Paint::line(Role::Ink, 1.5).dashed("1.5 3.5")
}

fn worst_paint() -> Paint {
    Paint::line(Role::Ink, 0.8)
}

fn nominal_paint() -> Paint {
    Paint::line(Role::Ink, 1.6).dashed("6 3")
}

/// What the shades and lines mean; the same for all panels.
struct Key {
    entries: Vec<(String, Option<Paint>, f64)>,
}

/// Width of a swatch with its gap (px).
const SWATCH: f64 = 32.0;

impl Key {
    fn of(figure: &EnvelopeFigure) -> Self {
        let mut entries = Vec::new();
        let bands = figure.panels.iter().map(|panel| panel.bands.as_slice());
        let bands = bands.max_by_key(|bands| bands.len()).unwrap_or(&[]);
        for (n, band) in bands.iter().enumerate() {
            // Shades lie over one another.
            let shades = SHADES.iter().take(n + 1);
            let seen = 1.0 - shades.map(|shade| 1.0 - shade).product::<f64>();
            entries.push((band.name.clone(), None, seen));
        }
        let any = |list: fn(&EnvelopePanel) -> bool| figure.panels.iter().any(list);
        let lines = [
            (any(|p| !p.median.is_empty()), "median", Paint::line(Role::Ink, 2.6)),
            (any(|p| !p.nominal.is_empty()), "nominal", nominal_paint()),
            (any(|p| !p.worst.is_empty()), "worst flights", worst_paint()),
            (any(|p| !p.setpoint.is_empty()), "commanded", setpoint_paint()),
        ];
        let shown = lines.into_iter().filter(|(there, ..)| *there);
        entries.extend(shown.map(|(_, name, paint)| (name.to_owned(), Some(paint), 1.0)));
        Self { entries }
    }

    /// Entries in rows of at most `width` px, each with its place.
    fn rows(&self, width: f64) -> Vec<Vec<(f64, usize)>> {
        let mut rows: Vec<Vec<(f64, usize)>> = Vec::new();
        let mut x = f64::INFINITY;
        for (n, (name, ..)) in self.entries.iter().enumerate() {
            let needed = SWATCH + text_width(name, TICK_PX) + 14.0;
            if x + needed > width {
                rows.push(Vec::new());
                x = 0.0;
            }
            if let Some(row) = rows.last_mut() {
                row.push((x, n));
            }
            x += needed;
        }
        rows
    }

    fn draw(&self, canvas: &mut Canvas, (left, top): (f64, f64), rows: &[Vec<(f64, usize)>]) {
        for (n, row) in rows.iter().enumerate() {
            let y = top + n as f64 * 18.0 + 8.0;
            for (x, index) in row {
                let Some((name, paint, shade)) = self.entries.get(*index) else { continue };
                let from = left + x;
                match paint {
                    Some(paint) => canvas.line((from, y), (from + 26.0, y), paint),
                    None => {
                        let paint = Paint::face(Role::Ink).opacity(*shade);
                        canvas.rect(from, y - 5.0, 26.0, 10.0, &paint);
                    }
                }
                let font = Font::new(TICK_PX, Anchor::Start);
                canvas.text(from + SWATCH, y + 4.0, name, font);
            }
        }
    }
}
