//! What figures of campaigns share: grids without a library, words cut to their room, signs of series.

use crate::axis::Axis;
use crate::page::{self, LABEL_PX, TITLE_PX};
use crate::plot::TICK_PX;
use crate::sign::Sign;
use crate::style::{Role, SeriesStyle};
use crate::svg::{Anchor, Canvas, Font, Paint, Rect};
use crate::text::text_width;

/// The sign of a numbered series where points are marked.
pub(super) const fn sign(style: SeriesStyle) -> Sign {
    match style.marker() {
        1 => Sign::Square,
        2 => Sign::Triangle,
        3 => Sign::Diamond,
        _ => Sign::Dot,
    }
}

/// As much of `text` as fits into `width` px, with an ellipsis where some is left out.
pub(super) fn fitted(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let room = width - text_width("\u{2026}", size);
    let mut used = 0.0;
    let kept = text.chars().take_while(|c| {
        used += text_width(c.encode_utf8(&mut [0; 4]), size);
        used <= room
    });
    let mut short: String = kept.collect();
    short.truncate(short.trim_end().len());
    short.push('\u{2026}');
    short
}

/// A title in which every word fits into a line of a figure of that width.
pub(super) fn title(text: &str, width: f64) -> String {
    let words = text.split_whitespace().map(|word| fitted(word, TITLE_PX, page::title_room(width)));
    words.collect::<Vec<_>>().join(" ")
}

/// Room that the longest of some texts takes, but at most `most` (px).
pub(super) fn room<'a>(texts: impl Iterator<Item = &'a str>, size: f64, most: f64) -> f64 {
    texts.map(|text| text_width(text, size)).fold(0.0, f64::max).min(most)
}

/// Upright grid lines with their ticks and numbers below `area`.
pub(super) fn abscissa(canvas: &mut Canvas, area: Rect, x: &Axis, named: bool) {
    let bottom = area.y + area.height;
    for tick in x.ticks() {
        let at = area.x + tick.at * area.width;
        canvas.line((at, area.y), (at, bottom), &Paint::line(Role::Grid, 0.7));
        canvas.line((at, bottom), (at, bottom + 4.0), &Paint::line(Role::Ink, 1.0));
        if named {
            let font = Font::new(TICK_PX, Anchor::Middle);
            canvas.text(at, bottom + 4.0 + TICK_PX, &tick.label, font);
        }
    }
    canvas.line((area.x, bottom), (area.x + area.width, bottom), &Paint::line(Role::Ink, 1.0));
}

/// Level grid lines with their ticks and numbers left of `area`.
pub(super) fn ordinate(canvas: &mut Canvas, area: Rect, y: &Axis) {
    for tick in y.ticks() {
        let at = area.y + (1.0 - tick.at) * area.height;
        canvas.line((area.x, at), (area.x + area.width, at), &Paint::line(Role::Grid, 0.7));
        canvas.line((area.x - 4.0, at), (area.x, at), &Paint::line(Role::Ink, 1.0));
        let font = Font::new(TICK_PX, Anchor::End);
        canvas.text(area.x - 7.0, at + TICK_PX * 0.36, &tick.label, font);
    }
    let ends = [(area.x, area.y), (area.x, area.y + area.height)];
    canvas.line(ends[0], ends[1], &Paint::line(Role::Ink, 1.0));
}

/// The name of an abscissa below the numbers of `area`.
pub(super) fn name_abscissa(canvas: &mut Canvas, area: Rect, label: &str) {
    let words = fitted(label, LABEL_PX, canvas.width() - 24.0);
    let half = text_width(&words, LABEL_PX) / 2.0 + 4.0;
    // A name longer than its axis must not leave the picture.
    let most = (canvas.width() - half).max(half);
    let x = (area.x + area.width / 2.0).clamp(half, most);
    page::level_label(canvas, x, area.y + area.height + 36.0, &words);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_too_long_end_with_an_ellipsis_within_their_room() {
        assert_eq!(fitted("short", 12.0, 200.0), "short");
        for text in ["a very long name of a controller indeed", "日本語の長い名前です、とても長い"]
        {
            let short = fitted(text, 12.0, 80.0);
            assert!(short.ends_with('\u{2026}') && text_width(&short, 12.0) <= 80.0, "{short}");
        }
    }
}
