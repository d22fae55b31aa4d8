//! What the data figures share: title, legend and axis labels around the plot areas.

use super::axis::Axis;
use super::gaps;
use super::sign::Sign;
use super::style::{Role, SeriesStyle};
use super::svg::{Anchor, Canvas, Font, Paint, Rect};
use super::text::text_width;

pub(super) use super::text::{LABEL_PX, TITLE_PX};

/// Free edge around a figure (px).
pub(super) const EDGE: f64 = 14.0;

const LEGEND_ROW: f64 = 18.0;
const SWATCH: f64 = 30.0;

/// A figure's width within sane bounds (px).
pub(super) fn sane_width(width_px: f64) -> f64 {
    if width_px.is_finite() { width_px.clamp(320.0, 2400.0) } else { 720.0 }
}

/// Lines of `text` at `size` that are at most `width` px wide where spaces allow it.
pub(super) fn wrap(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Room for a line of the title, by the widths of [`text_width`]: titles are bold, and up to an eighth wider (px).
pub(super) fn title_room(width: f64) -> f64 {
    (width - 2.0 * EDGE) / 1.125
}

/// Height that the title needs at the top of a figure (px).
pub(super) fn title_height(title: &str, width: f64) -> f64 {
    let lines = wrap(title, TITLE_PX, title_room(width)).len();
    if lines == 0 { EDGE } else { EDGE + lines as f64 * (TITLE_PX + 4.0) + 6.0 }
}

/// Writes the title at the upper left corner.
pub(super) fn title(canvas: &mut Canvas, title: &str) {
    let lines = wrap(title, TITLE_PX, title_room(canvas.width()));
    for (n, line) in lines.iter().enumerate() {
        let y = EDGE + TITLE_PX * 0.85 + n as f64 * (TITLE_PX + 4.0);
        canvas.text(EDGE, y, line, Font::new(TITLE_PX, Anchor::Start).bold());
    }
}

/// What a legend entry shows before its name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Swatch {
    Line {
        style: SeriesStyle,
        marked: bool,
    },
    Band,
    Area(SeriesStyle),
    Reference,
    /// A sign that marks single points.
    Sign(Sign, Role),
    /// A hatched area.
    Hatched,
    /// A full line in ink: an outline, a path.
    Outline,
    /// A thick line that divides what meets a requirement from what does not.
    Divide,
    /// A line of the grid.
    Grid,
    /// No sign: what is named is nowhere in the picture.
    Nothing,
}

/// A name and the swatch that stands for it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) swatch: Swatch,
}

/// Entries set in rows, to be drawn above a plot area.
#[derive(Debug, Clone, Default)]
pub(super) struct Legend {
    rows: Vec<Vec<(f64, Entry)>>,
}

impl Legend {
    /// Sets `entries` in rows of at most `width` px.
    pub(super) fn set(entries: Vec<Entry>, width: f64) -> Self {
        let mut rows: Vec<Vec<(f64, Entry)>> = Vec::new();
        let mut x = f64::INFINITY;
        for entry in entries.into_iter().filter(|entry| !entry.name.is_empty()) {
            let needed = SWATCH + 6.0 + text_width(&entry.name, LABEL_PX) + 18.0;
            if x + needed > width + 18.0 {
                rows.push(Vec::new());
                x = 0.0;
            }
            if let Some(row) = rows.last_mut() {
                row.push((x, entry));
            }
            x += needed;
        }
        Self { rows }
    }

    /// Height of the legend with the gap below it (px).
    pub(super) fn height(&self) -> f64 {
        if self.rows.is_empty() { 0.0 } else { self.rows.len() as f64 * LEGEND_ROW + 4.0 }
    }

    /// Draws the legend with its upper left corner at (`left`, `top`).
    pub(super) fn draw(&self, canvas: &mut Canvas, left: f64, top: f64) {
        for (n, row) in self.rows.iter().enumerate() {
            let y = top + (n as f64 + 0.5) * LEGEND_ROW;
            for (x, entry) in row {
                if let Swatch::Line { style, .. } = entry.swatch {
                    canvas.begin_marked(&format!("data-entry=\"{}\"", style.key()));
                }
                swatch(canvas, left + x, y, entry.swatch);
                canvas.text(
                    left + x + SWATCH + 6.0,
                    y + 4.2,
                    &entry.name,
                    Font::new(LABEL_PX, Anchor::Start),
                );
                if matches!(entry.swatch, Swatch::Line { .. }) {
                    canvas.end();
                }
            }
        }
    }
}

fn swatch(canvas: &mut Canvas, x: f64, y: f64, swatch: Swatch) {
    let end = x + SWATCH;
    match swatch {
        Swatch::Line { style, marked } => {
            let paint = Paint::line(style.role(), style.width()).dashed(style.dash());
            canvas.line((x, y), (end, y), &paint);
            if marked {
                marker(canvas, (x + SWATCH / 2.0, y), style);
            }
        }
        Swatch::Band => {
            canvas.rect(x, y - 4.0, SWATCH, 8.0, &Paint::face(Role::Band).opacity(0.45))
        }
        Swatch::Area(style) => {
            canvas.rect(x, y - 4.5, SWATCH, 9.0, &Paint::face(style.role()).opacity(0.35));
            canvas.line((x, y - 4.5), (end, y - 4.5), &Paint::line(style.role(), 2.0));
        }
        Swatch::Reference => {
            canvas.line((x, y), (end, y), &Paint::line(Role::Ink, 1.0).dashed("6 3"))
        }
        Swatch::Sign(sign, role) => sign.draw(canvas, (x + SWATCH / 2.0, y), role),
        Swatch::Outline => canvas.line((x, y), (end, y), &Paint::line(Role::Ink, 1.7)),
        Swatch::Nothing => {}
        Swatch::Divide => canvas.line((x, y), (end, y), &Paint::line(Role::Ink, 2.8)),
        Swatch::Grid => canvas.line((x, y), (end, y), &Paint::line(Role::Grid, 1.4)),
        Swatch::Hatched => {
            let area = Rect { x: x + 4.0, y: y - 6.0, width: SWATCH - 4.0, height: 12.0 };
            canvas.begin_clip(area);
            gaps::hatch_boldly(canvas, area);
            canvas.end();
            canvas.rect(area.x, area.y, area.width, area.height, &Paint::line(Role::Ink, 0.6));
        }
    }
}

/// The marker of `style`, as in the plot area.
fn marker(canvas: &mut Canvas, (x, y): (f64, f64), style: SeriesStyle) {
    let (s, paint) = (3.4, Paint::face(style.role()));
    match style.marker() {
        1 => canvas.rect(x - s, y - s, 2.0 * s, 2.0 * s, &paint),
        2 => canvas.polyline(
            &[(x, y - 1.02 * s), (x - s, y + 0.68 * s), (x + s, y + 0.68 * s)],
            true,
            &paint,
        ),
        3 => canvas.polyline(
            &[(x, y - 1.3 * s), (x + 1.3 * s, y), (x, y + 1.3 * s), (x - 1.3 * s, y)],
            true,
            &paint,
        ),
        _ => canvas.circle((x, y), s, &paint),
    }
}

/// Room that the widest tick label of `axis` takes (px).
pub(super) fn tick_room(axis: &Axis) -> f64 {
    axis.ticks()
        .iter()
        .map(|tick| text_width(&tick.label, super::plot::TICK_PX))
        .fold(14.0, f64::max)
        + 15.0
}

/// Writes a label that reads upwards, centred at `middle`, its last line ending at `right`.
pub(super) fn upright_label(canvas: &mut Canvas, right: f64, middle: f64, lines: &[String]) {
    let font = Font::new(LABEL_PX, Anchor::Middle).turned(-90.0);
    let all = lines.join(" ");
    for (n, line) in lines.iter().enumerate() {
        let x = right - (lines.len() - 1 - n) as f64 * (LABEL_PX + 3.0);
        canvas.axis_text((x, middle), line, font, ("y", &all));
    }
}

/// Writes a label that reads across, centred at `middle`, with its baseline at `y`.
pub(super) fn level_label(canvas: &mut Canvas, middle: f64, y: f64, label: &str) {
    canvas.axis_text((middle, y), label, Font::new(LABEL_PX, Anchor::Middle), ("x", label));
}

/// Width of an upright label of that many lines (px).
pub(super) fn upright_room(lines: usize) -> f64 {
    lines as f64 * (LABEL_PX + 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_breaks_into_rows_instead_of_leaving_the_figure() {
        let entry = |n| Entry { name: format!("controller number {n}"), swatch: Swatch::Band };
        let legend = Legend::set((0..7).map(entry).collect(), 400.0);
        assert!(legend.rows.len() >= 3);
        assert!(Legend::set(Vec::new(), 400.0).height() < 1e-9);
    }

    #[test]
    fn a_title_that_is_bold_ends_within_the_figure() {
        // As wide as the widths say it ends before the edge of a figure of 500 px, and drawn in bold behind it.
        let long = "navion: loop of PID, sampled every 0.01 s, without limits, at its gains";
        assert!(text_width(long, TITLE_PX) < 500.0 - EDGE);
        let lines = (title_height(long, 500.0) - EDGE - 6.0) / (TITLE_PX + 4.0);
        assert!((lines - 2.0).abs() < 1e-9, "{lines}");
    }

    #[test]
    fn long_labels_are_wrapped_at_spaces() {
        assert_eq!(wrap("pitch angle [deg]", 12.0, 70.0), ["pitch angle", "[deg]"]);
        assert!(wrap("", 12.0, 70.0).is_empty());
    }
}
