//! Two quantities against each other, a sign for each thing that has both: error against activity.

use super::areas::{self, abscissa, fitted, name_abscissa, ordinate, sign};
use super::scatter::SIDE;
use crate::axis::{Axis, extent, short_number};
use crate::cursor;
use crate::page::{self, EDGE, Entry, LABEL_PX, Legend, Swatch};
use crate::sign::Sign;
use crate::style::SeriesStyle;
use crate::svg::{Canvas, Paint, Rect, Svg};
use crate::text::{escape, num, unmarked};

/// Two quantities against each other.
#[derive(Debug, Clone, PartialEq)]
pub struct TradeFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name and unit along the abscissa.
    pub x_label: String,
    /// Name and unit along the ordinate.
    pub y_label: String,
    /// Whose points they are, in the order in which they are drawn.
    pub series: Vec<TradeSeries>,
}

/// Points of one thing; a point that is not finite is not drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct TradeSeries {
    /// Name in the legend.
    pub name: String,
    /// How its points are drawn.
    pub style: SeriesStyle,
    /// The points.
    pub points: Vec<(f64, f64)>,
    /// True for a line through them in place of a sign for each.
    pub is_joined: bool,
    /// How far off a line may be: abscissa, with the lower and upper end there; empty where that is not known.
    pub band: Vec<(f64, [f64; 2])>,
}

/// Width of the plot area (px), wider than high so that the legend has room.
const WIDTH: f64 = 560.0;
/// Shade of bands, so that lines and other bands are seen through them.
const SHADE: f64 = 0.13;

impl TradeFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let ends = |it: &TradeSeries| {
            let each = it.band.iter().flat_map(|(x, ends)| ends.map(|end| (*x, end)));
            it.points.iter().copied().chain(each).collect::<Vec<_>>()
        };
        let all = || self.series.iter().flat_map(ends);
        let shown = || all().filter(|(x, y)| x.is_finite() && y.is_finite());
        let x = Axis::linear(extent(shown().map(|point| point.0)), 0.06, 7);
        let y = Axis::linear(extent(shown().map(|point| point.1)), 0.06, 6);
        let left = EDGE + page::upright_room(1) + page::tick_room(&y);
        let width = left + WIDTH + 30.0;
        let entries = self.series.iter().map(|it| Entry {
            name: fitted(&it.name, LABEL_PX, WIDTH / 2.0),
            swatch: match it.is_joined {
                true => Swatch::Line { style: it.style, marked: false },
                false => Swatch::Sign(sign(it.style), it.style.role()),
            },
        });
        let legend = Legend::set(entries.collect(), WIDTH);
        let title_text = areas::title(&self.title, width);
        let title = page::title_height(&title_text, width);
        let top = title + legend.height() + 2.0;
        let mut canvas = Canvas::new(width, top + SIDE + 50.0);
        page::title(&mut canvas, &title_text);
        legend.draw(&mut canvas, left, title);
        let area = Rect { x: left, y: top, width: WIDTH, height: SIDE };
        abscissa(&mut canvas, area, &x, true);
        ordinate(&mut canvas, area, &y);
        let place = |(px, py): &(f64, f64)| {
            (area.x + x.fraction(*px) * WIDTH, area.y + (1.0 - y.fraction(*py)) * SIDE)
        };
        for series in self.series.iter().filter(|it| it.band.len() > 1) {
            let outline: Vec<(f64, f64)> = series.outline().iter().map(place).collect();
            canvas.path(&closed(&outline), &Paint::face(series.style.role()).opacity(SHADE));
        }
        canvas.begin_marked(&cursor::panel(area, &x, &y));
        for series in &self.series {
            series.draw(&mut canvas, place);
        }
        canvas.end();
        name_abscissa(&mut canvas, area, &self.x_label);
        let label = [fitted(&self.y_label, LABEL_PX, SIDE)];
        page::upright_label(&mut canvas, EDGE + LABEL_PX, area.y + SIDE / 2.0, &label);
        canvas.finish(&self.title, &self.describe())
    }

    fn describe(&self) -> String {
        let mut text = format!("{} over {}.", self.y_label, self.x_label);
        for series in &self.series {
            let points = series.points.iter();
            let points: Vec<String> = points
                .map(|(x, y)| format!("{} at {}", short_number(*y), short_number(*x)))
                .collect();
            text.push_str(&format!(" {}: {}.", series.name, points.join(", ")));
            if let (Some((from, [a, b])), Some((to, [c, d]))) =
                (series.band.first(), series.band.last())
            {
                let [from, a, b, to, c, d] = [from, a, b, to, c, d].map(|it| short_number(*it));
                text.push_str(&format!(" Its band: {a} to {b} at {from}, {c} to {d} at {to}."));
            }
        }
        text
    }
}

impl TradeSeries {
    /// Draws its line or its signs, of what is finite.
    fn draw(&self, canvas: &mut Canvas, place: impl Fn(&(f64, f64)) -> (f64, f64)) {
        let finite = self.points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
        let places: Vec<(f64, f64)> = finite.map(place).collect();
        let told: Vec<String> =
            places.iter().map(|at| format!("{} {}", num(at.0), num(at.1))).collect();
        let name = escape(&unmarked(&self.name));
        canvas.begin_marked(&format!("data-at=\"{}\" data-name=\"{name}\"", told.join(" ")));
        let (style, role) = (self.style, self.style.role());
        if self.is_joined {
            let paint = Paint::line(role, style.width()).dashed(style.dash());
            canvas.polyline(&places, false, &paint);
        } else {
            for at in places {
                match sign(style) {
                    // A dot is for lines; alone it would be the smallest of all signs.
                    Sign::Dot => canvas.circle(at, 4.2, &Paint::face(role)),
                    other => other.draw(canvas, at, role),
                }
            }
        }
        canvas.end();
    }

    /// Along the lower ends of the band and back along the upper ones, of what is finite.
    fn outline(&self) -> Vec<(f64, f64)> {
        let finite =
            |(x, ends): &&(f64, [f64; 2])| x.is_finite() && ends.iter().all(|it| it.is_finite());
        let there = self.band.iter().filter(finite);
        let lower = there.clone().map(|(x, ends)| (*x, ends[0]));
        lower.chain(there.rev().map(|(x, ends)| (*x, ends[1]))).collect()
    }
}

/// A closed path through places.
fn closed(places: &[(f64, f64)]) -> String {
    let steps = places
        .iter()
        .enumerate()
        .map(|(n, (x, y))| format!("{}{} {}", if n == 0 { 'M' } else { 'L' }, num(*x), num(*y)));
    let path: String = steps.collect();
    if path.is_empty() { path } else { path + "Z" }
}
