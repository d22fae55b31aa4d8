//! The plane of $z$ with the unit circle and lines of equal damping and frequency, whole and near 1.

use super::chart::{self, Chart};
use super::clip::Point;
use crate::axis::short_number;
use crate::page::{self, EDGE, Entry, Legend, Swatch};
use crate::plot::TICK_PX;
use crate::sign::Sign;
use crate::style::Role;
use crate::svg::{Canvas, Paint, Svg};
use crate::text::text_width;

/// Side of a panel (px): one alone, or one of two.
const ALONE: f64 = 430.0;
const PAIRED: f64 = 296.0;
/// Room left of a panel for its numbers and name (px).
const LEFT: f64 = EDGE + 62.0;
/// Room of a panel of a pair, with what is left and right of it (px).
const COLUMN: f64 = 62.0 + PAIRED + 14.0;

/// How far the whole plane reaches to each side at least; twice as far to show unstable poles.
const WHOLE: f64 = 1.25;
/// Poles within this distance of 1 ask for a panel of their own.
const NEAR_ONE: f64 = 0.3;

/// What a figure in the plane of $z$ needs.
pub(super) struct ZPlane<'a> {
    pub(super) title: &'a str,
    pub(super) legend: Vec<Entry>,
    /// Sample period (s); the grid is left out where it makes no sense.
    pub(super) dt_s: f64,
    /// Poles that shall be told apart: where most are near 1, a second panel shows those.
    pub(super) poles: Vec<Point>,
    /// What screen readers say.
    pub(super) description: String,
}

impl ZPlane<'_> {
    /// Draws the panels; `draw` adds the data to each.
    pub(super) fn render(self, draw: impl Fn(&mut Canvas, &mut Chart)) -> Svg {
        let close = close_up(&self.poles);
        let side = if close.is_some() { PAIRED } else { ALONE };
        let width = if close.is_some() { EDGE + 2.0 * COLUMN } else { LEFT + ALONE + EDGE + 8.0 };
        let mut entries = self.legend;
        let name = "damping ratio, natural frequency [rad/s]".to_owned();
        entries.push(Entry { name, swatch: Swatch::Grid });
        let legend = Legend::set(entries, width - LEFT - EDGE);
        let legend_top = page::title_height(self.title, width);
        let top = legend_top + legend.height() + 8.0;
        let mut canvas = Canvas::new(width, top + side + 48.0);
        page::title(&mut canvas, self.title);
        legend.draw(&mut canvas, LEFT, legend_top);
        let farthest = self.poles.iter().map(|(x, y)| libm::hypot(*x, *y)).fold(0.0, f64::max);
        let windows = [Some(((0.0, 0.0), (1.15 * farthest).clamp(WHOLE, 2.0 * WHOLE))), close];
        for (n, (centre, reach)) in windows.into_iter().flatten().enumerate() {
            let corner = (LEFT + n as f64 * COLUMN, top);
            let mut chart = Chart::new(chart::square(corner, side, centre, reach));
            let grid = grid(&mut canvas, &mut chart, self.dt_s, reach);
            draw(&mut canvas, &mut chart);
            name_grid(&mut canvas, &mut chart, &grid);
            chart.bare_axes(&mut canvas);
            let where_ = if n == 0 { "" } else { ", near 1" };
            let name = |part: &str| format!("{part} part of z{where_}");
            chart.name_axes(&mut canvas, &name("real"), &name("imaginary"));
        }
        canvas.finish(self.title, &self.description)
    }
}

/// The window that shows the poles near 1, if these are most of them.
fn close_up(poles: &[Point]) -> Option<(Point, f64)> {
    let known: Vec<f64> = poles
        .iter()
        .map(|(x, y)| libm::hypot(x - 1.0, *y))
        .filter(|distance| distance.is_finite())
        .collect();
    let near: Vec<f64> = known.iter().copied().filter(|distance| *distance < NEAR_ONE).collect();
    let farthest = near.iter().copied().fold(0.0, f64::max);
    // Below a thousandth the numbers on the axes would say nothing.
    let reach = (farthest * 1.15).max(1e-3);
    (near.len() > 1 && near.len() * 2 >= known.len()).then_some(((1.0 - 0.55 * reach, 0.0), reach))
}

/// Damping ratios with a line of their own.
const DAMPING: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// The unit circle and the places of equal damping and equal natural frequency of
/// $s = -\zeta\omega + j\omega\sqrt{1-\zeta^2}$ under $z = e^{sT}$.
///
/// Returns the frequencies that have a line (rad/s), and their angles on the circle (rad).
fn grid(canvas: &mut Canvas, chart: &mut Chart, dt_s: f64, reach: f64) -> Vec<(f64, f64)> {
    let thin = Paint::line(Role::Grid, 0.9);
    let far = [(-9.0, 0.0), (9.0, 0.0)];
    chart.quiet_line(canvas, far.into_iter(), &thin);
    chart.quiet_line(canvas, far.map(|(x, y)| (y, x)).into_iter(), &thin);
    // A wide panel shows all of the plane, a close-up only its low frequencies.
    let top = if reach > 1.0 { std::f64::consts::PI } else { (reach * 1.6).min(3.0) };
    for zeta in DAMPING {
        for side in [1.0, -1.0] {
            chart.quiet_line(canvas, of_damping(zeta, side), &thin);
        }
    }
    let step = step(top / dt_s / 6.0);
    let usable = dt_s > 0.0 && step.is_finite() && step > 0.0;
    let count = if usable { ((top / dt_s / step) as usize).min(12) } else { 0 };
    let named = (1..=count).map(|n| (n as f64 * step, n as f64 * step * dt_s)).collect::<Vec<_>>();
    for (_, angle) in &named {
        for side in [1.0, -1.0] {
            chart.quiet_line(canvas, of_frequency(*angle, side), &thin);
        }
    }
    let circle = Paint::line(Role::Ink, 1.1);
    chart.line(canvas, super::nyquist::circle((0.0, 0.0), 1.0), &circle);
    named
}

/// Writes damping ratios along their lines and frequencies outside of the circle.
fn name_grid(canvas: &mut Canvas, chart: &mut Chart, frequencies: &[(f64, f64)]) {
    for &(frequency, turn) in frequencies {
        let way = (libm::cos(turn), libm::sin(turn));
        let Some(at) = chart.visible(way.0, way.1) else { continue };
        let text = short_number(frequency);
        let half = text_width(&text, TICK_PX) / 2.0;
        let places = [4.0, 9.0, 15.0]
            .map(|gap| (at.0 + (half + gap) * way.0, at.1 - (TICK_PX * 0.6 + gap) * way.1));
        chart.labels.put_first(canvas, &places, &text);
    }
    for zeta in DAMPING {
        let along = of_damping(zeta, 1.0).filter_map(|(x, y)| chart.visible(x, y));
        let mut places: Vec<(usize, Point)> = along.enumerate().step_by(3).collect();
        // Near 1 the lines crowd, near the origin they end: begin between and go outwards.
        let middle = places.len() * 2;
        places.sort_by_key(|(n, _)| n.abs_diff(middle));
        let places: Vec<Point> = places.into_iter().map(|(_, at)| at).collect();
        chart.labels.put_first(canvas, &places, &short_number(zeta));
    }
}

/// From $z = 1$ along a damping ratio up to the negative real axis.
fn of_damping(zeta: f64, side: f64) -> impl Iterator<Item = Point> + Clone {
    let root = (1.0 - zeta * zeta).sqrt();
    (0..=120).map(move |n| {
        // Steps that grow, so that a close-up of z = 1 is smooth too.
        let part = f64::from(n) / 120.0;
        let turn = std::f64::consts::PI * part * part * part;
        let radius = libm::exp(-zeta / root * turn);
        (radius * libm::cos(turn), side * radius * libm::sin(turn))
    })
}

/// Along a natural frequency times the sample period (rad), from the circle to the real axis.
fn of_frequency(omega_dt: f64, side: f64) -> impl Iterator<Item = Point> + Clone {
    (0..=48).map(move |n| {
        let angle = std::f64::consts::FRAC_PI_2 * f64::from(n) / 48.0;
        let radius = libm::exp(-omega_dt * libm::sin(angle));
        let turn = omega_dt * libm::cos(angle);
        (radius * libm::cos(turn), side * radius * libm::sin(turn))
    })
}

/// The smallest of 1, 2 and 5 times a power of ten that is at least `raw`.
fn step(raw: f64) -> f64 {
    let exponent = libm::floor(libm::log10(raw));
    let base = libm::exp10(exponent);
    let lead = [1.0, 2.0, 5.0, 10.0].into_iter().find(|lead| lead * base >= raw * 0.999);
    lead.map_or(f64::NAN, |lead| lead * base)
}

/// Draws a sign at each point of each group and writes how often it is there, where that is more than once.
pub(super) fn signs(canvas: &mut Canvas, chart: &mut Chart, groups: &[(&[Point], Sign, Role)]) {
    let whole = chart.frame.x.hi > 0.98 * WHOLE;
    let mut multiple = Vec::new();
    for &(points, sign, role) in groups {
        for (at, count) in gathered(points) {
            let seen = chart.sign(canvas, at, sign, role);
            if !seen && whole {
                beyond(canvas, chart, at, sign, role);
            } else if count > 1 {
                multiple.push((at, count));
            }
        }
    }
    // Labels last: they keep off every sign.
    for (at, count) in multiple {
        chart.label(canvas, at, &format!("{count}\u{d7}"), Role::Ink);
    }
}

/// A sign at the edge of the whole plane and an arrow to where its point is.
fn beyond(canvas: &mut Canvas, chart: &mut Chart, (x, y): Point, sign: Sign, role: Role) {
    let reach = chart.frame.x.hi;
    let largest = x.abs().max(y.abs());
    if !(largest > reach && largest < 1e100) {
        return;
    }
    let at = |part: f64| (x / largest * reach * part, y / largest * reach * part);
    chart.sign(canvas, at(0.92), sign, role);
    let (inner, tip) =
        (chart.frame.place(at(0.9).0, at(0.9).1), chart.frame.place(at(0.99).0, at(0.99).1));
    let length = chart::distance(inner, tip).max(1e-9);
    chart::head(canvas, tip, ((tip.0 - inner.0) / length, (tip.1 - inner.1) / length), role);
    let text = if y.abs() < SAME {
        short_number(x)
    } else {
        format!(
            "{} {} {}j",
            short_number(x),
            if y < 0.0 { "\u{2212}" } else { "+" },
            short_number(y.abs())
        )
    };
    chart.label(canvas, at(0.92), &text, Role::Ink);
}

/// Multiple poles, as those of a delay, come apart by rounding; nearer than this they are one.
const SAME: f64 = 1e-4;

fn gathered(points: &[Point]) -> Vec<(Point, usize)> {
    let mut found: Vec<(Point, usize)> = Vec::new();
    for &at in points.iter().take(MOST_POINTS) {
        match found.iter_mut().find(|(other, _)| chart::distance(*other, at) < SAME) {
            Some((_, count)) => *count += 1,
            None => found.push((at, 1)),
        }
    }
    found
}

/// Signs of one kind that a figure shows; no loop of ours has as many poles.
const MOST_POINTS: usize = 200;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_panel_shows_poles_that_crowd_near_one() {
        let slow = [(0.99, 0.01), (0.99, -0.01), (0.999, 0.0), (0.0, 0.0)];
        let ((x, y), reach) = close_up(&slow).unwrap();
        assert!(x < 1.0 && y.abs() < 1e-12 && reach > 0.014 && reach < 0.03);
        assert!(close_up(&[(0.2, 0.0), (0.99, 0.0)]).is_none());
        assert!(close_up(&[]).is_none());
        assert!(close_up(&[(f64::NAN, 0.0)]).is_none());
    }

    #[test]
    fn lines_of_the_grid_are_where_the_exponential_puts_them() {
        // zeta = 0.5 at a quarter turn: radius exp(-pi/2 / sqrt(3)).
        let seen = of_damping(0.5, 1.0).min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).unwrap();
        assert!((seen.1 - (-std::f64::consts::FRAC_PI_2 / 3_f64.sqrt()).exp()).abs() < 0.02);
        let ends: Vec<Point> = of_frequency(1.0, 1.0).collect();
        assert!((ends[0].0 - 1_f64.cos()).abs() < 1e-12);
        assert!((ends[48].0 - (-1_f64).exp()).abs() < 1e-12 && ends[48].1.abs() < 1e-12);
    }

    #[test]
    fn steps_of_frequency_are_round() {
        for (raw, wanted) in [(0.9, 1.0), (1.0, 1.0), (13.0, 20.0), (0.03, 0.05), (6.0, 10.0)] {
            assert!((step(raw) - wanted).abs() < 1e-9 * wanted);
        }
        assert!(!step(f64::NAN).is_finite() && !(step(0.0) > 0.0));
    }

    #[test]
    fn a_pole_that_is_there_twice_is_counted() {
        let found = gathered(&[(0.0, 0.0), (0.5, 0.0), (1e-6, -1e-6), (f64::NAN, 0.0)]);
        assert_eq!(found.len(), 3);
        assert_eq!(found[0].1, 2);
    }
}
