//! What a script reads under the cursor where a drawing has no curves: bins, cells of maps, points.
//!
//! All of it is in `data-` attributes of groups that draw nothing, or that hold what is drawn anyway: without a
//! script a figure is the same picture.

use super::axis::{Axis, with_minus};
use super::svg::{Canvas, Rect};
use super::text::{escape, num, unmarked};

/// Steps of a level that is written in two letters, 0-9 and a-z.
const LEVELS: f64 = 1295.0;
/// Two letters for a level that is not there.
const NO_LEVEL: &str = "..";

/// Where a panel is and what its axes span.
pub(super) fn panel(area: Rect, x: &Axis, y: &Axis) -> String {
    let Rect { x: left, y: top, width, height } = area;
    let place = [left, top, width, height].map(num).join(" ");
    format!("data-panel=\"{place}\" data-x=\"{}\" data-y=\"{}\"", x.data(), y.data())
}

/// Cells that can be read: those of a map, or the bins of a histogram.
pub(super) struct Cells<'a> {
    /// Whose they are; empty where the figure has no others.
    pub(super) name: &'a str,
    /// What the words say, with its unit; may be empty.
    pub(super) quantity: &'a str,
    /// Nodes of the columns, or their ends, which are one more.
    pub(super) columns: &'a [f64],
    /// The same of the rows; none where there is one row.
    pub(super) rows: &'a [f64],
}

impl Cells<'_> {
    /// Words for each cell, row by row from below.
    pub(super) fn worded(
        &self,
        canvas: &mut Canvas,
        panel: &str,
        words: impl Iterator<Item = String>,
    ) {
        let mut last = String::new();
        let mut told = Vec::new();
        for word in words {
            // Neighbours are often the same: a word that is left out is the one before.
            told.push(if word == last { String::new() } else { escape(&word.replace(';', ",")) });
            last = word;
        }
        self.mark(canvas, panel, &format!("data-cells=\"{}\"", told.join(";")));
    }

    /// A value for each cell in so many steps between two ends: as finely as anybody reads a colour, in two letters.
    pub(super) fn graded(
        &self,
        canvas: &mut Canvas,
        panel: &str,
        (lo, hi): (f64, f64),
        values: impl Iterator<Item = f64>,
    ) {
        // A surface that is level has one value, and that is its lower end.
        let span = if hi > lo { hi - lo } else { 1.0 };
        let told: String = values.map(|value| letters((value - lo) / span)).collect();
        let data = format!("data-levels=\"{lo:e} {hi:e}\" data-cells=\"{told}\"");
        self.mark(canvas, panel, &data);
    }

    fn mark(&self, canvas: &mut Canvas, panel: &str, cells: &str) {
        let mut data = panel.to_owned();
        for (key, text) in [("name", self.name), ("quantity", self.quantity)] {
            if !text.is_empty() {
                data.push_str(&format!(" data-{key}=\"{}\"", escape(&unmarked(text))));
            }
        }
        for (key, ends) in [("columns", self.columns), ("rows", self.rows)] {
            if !ends.is_empty() {
                data.push_str(&format!(" data-{key}=\"{}\"", numbers(ends)));
            }
        }
        canvas.begin_marked(&format!("{data} {cells}"));
        canvas.end();
    }
}

/// A part of the way from the lower to the upper end.
fn letters(part: f64) -> String {
    if !part.is_finite() {
        return NO_LEVEL.to_owned();
    }
    let step = libm::round(part.clamp(0.0, 1.0) * LEVELS) as u32;
    [step / 36, step % 36].iter().filter_map(|digit| char::from_digit(*digit, 36)).collect()
}

/// Ends of cells in five digits of what they span, as people read them.
fn numbers(ends: &[f64]) -> String {
    let size =
        ends.iter().filter(|end| end.is_finite()).fold(0.0, |most: f64, end| most.max(end.abs()));
    let (first, last) = (ends.first().copied(), ends.last().copied());
    let span = first.zip(last).map_or(0.0, |(first, last)| (last - first).abs());
    let span = if span.is_finite() && span > 0.0 { span } else { size };
    let decimals = 4.0 - libm::floor(libm::log10(span));
    let written = |end: &f64| match decimals {
        _ if !end.is_finite() => "0".to_owned(),
        places if (0.0..=12.0).contains(&places) && size < 1e9 => {
            let text = format!("{end:.*}", places as usize);
            let text = text.trim_end_matches('0').trim_end_matches('.');
            if matches!(text, "-0" | "") { "0".to_owned() } else { text.to_owned() }
        }
        places if places < 0.0 && size < 1e9 => format!("{end:.0}"),
        _ => format!("{end:.5e}"),
    };
    ends.iter().map(|end| with_minus(&written(end))).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_cells_have_the_digits_that_their_span_needs_and_no_more() {
        assert_eq!(numbers(&[0.0, 0.25, 0.5]), "0 0.25 0.5");
        assert_eq!(numbers(&[-100.0, 1.0 / 3.0, 200.0]), "\u{2212}100 0.33 200");
        assert_eq!(numbers(&[1e12, 2e12]), "1.00000e12 2.00000e12");
        assert_eq!(numbers(&[120_000.0, 460_000.0]), "120000 460000");
        assert_eq!(numbers(&[f64::NAN]), "0");
    }

    #[test]
    fn a_level_is_two_letters_and_what_is_not_there_has_none() {
        assert_eq!([0.0, 1.0, 0.5].map(letters), ["00", "zz", "i0"]);
        assert_eq!(letters(f64::NAN), NO_LEVEL);
        assert_eq!(letters(7.0), "zz");
    }

    #[test]
    fn a_level_surface_has_its_value_everywhere() {
        let mut canvas = Canvas::new(10.0, 10.0);
        let cells = Cells { name: "", quantity: "", columns: &[0.0, 1.0], rows: &[0.0] };
        cells.graded(&mut canvas, "", (3.0, 3.0), [3.0, f64::NAN].into_iter());
        let svg = canvas.finish("", "").into_string();
        assert!(svg.contains("data-levels=\"3e0 3e0\"") && svg.contains("data-cells=\"00..\""));
    }

    #[test]
    fn a_word_that_is_the_one_before_is_left_out_and_none_breaks_out_of_its_attribute() {
        let axis = Axis::linear(Some((0.0, 2.0)), 0.0, 5);
        let area = Rect { x: 1.0, y: 2.0, width: 3.0, height: 4.0 };
        let mut canvas = Canvas::new(10.0, 10.0);
        let cells = Cells { name: "a \"b\"", quantity: "", columns: &[0.0, 1.0, 2.0], rows: &[] };
        let words = ["3; <x>", "3; <x>"].map(str::to_owned);
        cells.worded(&mut canvas, &panel(area, &axis, &axis), words.into_iter());
        let svg = canvas.finish("", "").into_string();
        assert!(svg.contains(
            "<g data-panel=\"1 2 3 4\" data-x=\"0e0 2e0\" data-y=\"0e0 2e0\" data-name=\"a &quot;b&quot;\" \
             data-columns=\"0 1 2\" data-cells=\"3, &lt;x&gt;;\">\n</g>"
        ));
    }
}
