//! What the map and the surfaces of margins share: which cell is worse, and which colour it has.

use super::gain_map::{GainMap, MapCell};
use crate::axis::{Axis, with_minus};
use crate::page;
use crate::plot::TICK_PX;
use crate::style::{Rgb, Role, sequential};
use crate::svg::{Anchor, Canvas, Font, Paint, Rect};
use crate::text::text_width;

/// The worse of two cells: unstable, then the smaller margin; unknown only where nothing is known.
pub(super) fn worse(a: MapCell, b: MapCell) -> MapCell {
    let rank = |cell: MapCell| match cell {
        MapCell::Unstable => (0, 0.0),
        MapCell::Value(value) => (1, value),
        MapCell::Unbounded => (2, 0.0),
        MapCell::Unknown => (3, 0.0),
    };
    let ((kind_a, value_a), (kind_b, value_b)) = (rank(a), rank(b));
    if kind_a < kind_b || (kind_a == kind_b && value_a <= value_b) { a } else { b }
}

/// The same map with at most `most` nodes each way; a node becomes the worst of those it stands for.
pub(super) fn coarse(map: &GainMap, most: usize) -> GainMap {
    let by = |count: usize| count.div_ceil(most).max(1);
    let (across, down) = (by(map.xs.len()), by(map.ys.len()));
    if across == 1 && down == 1 {
        return map.clone();
    }
    let middle = |group: &[f64]| group.iter().sum::<f64>() / group.len() as f64;
    let xs: Vec<f64> = map.xs.chunks(across).map(middle).collect();
    let ys: Vec<f64> = map.ys.chunks(down).map(middle).collect();
    let cell = |i: usize, j: usize| {
        let rows = i * down..(i * down + down).min(map.ys.len());
        let columns = j * across..(j * across + across).min(map.xs.len());
        rows.flat_map(|i| columns.clone().map(move |j| map.cell(i, j)))
            .fold(MapCell::Unknown, worse)
    };
    let cells = (0..ys.len()).map(|i| (0..xs.len()).map(|j| cell(i, j)).collect()).collect();
    GainMap { xs, ys, cells, ..map.clone() }
}

/// Colours of the margins: light is good, dark is bad, so that it also reads in grey.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grading {
    axis: Axis,
}

/// Shades of the scale; more would not be told apart and make large files.
const SHADES: f64 = 48.0;
/// Part of the scale of colours that is used: its lightest end is too near to white.
const FROM: f64 = 0.06;
const TO: f64 = 0.94;

impl Grading {
    /// The scale of a map.
    pub(super) fn of(map: &GainMap) -> Self {
        let asked = Axis::fixed(map.scale, 8);
        Self { axis: asked.unwrap_or_else(|| Axis::linear(map.extent(), 0.0, 8)) }
    }

    /// The colour of a cell; none for what has no margin.
    pub(super) fn colour(self, cell: MapCell) -> Option<Rgb> {
        match cell {
            MapCell::Value(value) => Some(shade(self.axis.fraction(value))),
            MapCell::Unbounded => Some(shade(1.0)),
            MapCell::Unstable | MapCell::Unknown => None,
        }
    }

    /// A margin with as many digits as the scale has and one more.
    pub(super) fn number(self, value: f64) -> String {
        let decimals = if self.axis.step() >= 5.0 {
            0
        } else if self.axis.step() >= 0.2 {
            1
        } else {
            2
        };
        let text = format!("{value:.decimals$}");
        let is_zero = text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.');
        with_minus(if is_zero { text.trim_start_matches('-') } else { &text })
    }

    /// The colour bar with its numbers, its name and the line of what is required.
    pub(super) fn bar(self, canvas: &mut Canvas, r: Rect, name: &str, required: Option<f64>) {
        let slices = SHADES as usize;
        let height = r.height / SHADES;
        for n in 0..slices {
            let y = r.y + r.height - (n + 1) as f64 * height;
            let colour = shade((n as f64 + 0.5) / SHADES);
            // Each slice reaches under the one below it, so that no seam shows.
            let over = if n == 0 { 0.0 } else { 0.6 };
            canvas.rect(r.x, y, r.width, height + over, &Paint::face(Role::Fixed(colour)));
        }
        canvas.rect(r.x, r.y, r.width, r.height, &Paint::line(Role::Ink, 0.8));
        let mut widest = 0.0_f64;
        for tick in self.axis.ticks() {
            let y = r.y + (1.0 - tick.at) * r.height;
            let end = r.x + r.width;
            canvas.line((end, y), (end + 4.0, y), &Paint::line(Role::Ink, 1.0));
            let font = Font::new(TICK_PX, Anchor::Start);
            canvas.text(end + 7.0, y + TICK_PX * 0.36, &tick.label, font);
            widest = widest.max(text_width(&tick.label, TICK_PX));
        }
        let part = required.map_or(-1.0, |value| self.axis.fraction(value));
        if (0.0..=1.0).contains(&part) {
            let y = r.y + (1.0 - part) * r.height;
            canvas.line((r.x - 4.0, y), (r.x + r.width + 4.0, y), &Paint::line(Role::Ink, 2.6));
        }
        let x = r.x + r.width + 24.0 + widest;
        page::upright_label(canvas, x, r.y + r.height / 2.0, &[name.to_owned()]);
    }
}

/// The colour at a part of the scale, 1 being good.
fn shade(part: f64) -> Rgb {
    let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
    let step = libm::floor(part * SHADES).min(SHADES - 1.0);
    sequential(TO - (TO - FROM) * (step + 0.5) / SHADES)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(count: usize) -> GainMap {
        let nodes: Vec<f64> = (0..count).map(|n| n as f64).collect();
        GainMap {
            title: String::new(),
            x_label: String::new(),
            y_label: String::new(),
            quantity: String::new(),
            cells: vec![vec![MapCell::Value(3.0); count]; count],
            xs: nodes.clone(),
            ys: nodes,
            scale: None,
            required: None,
            worst: None,
            equilibrium: None,
            flown: Vec::new(),
        }
    }

    #[test]
    fn one_unstable_node_among_thousands_is_not_lost() {
        let mut fine = map(200);
        fine.cells[117][63] = MapCell::Unstable;
        let coarse = coarse(&fine, 64);
        assert!(coarse.xs.len() <= 64 && coarse.cells.len() <= 64);
        assert_eq!(coarse.all().filter(|cell| *cell == MapCell::Unstable).count(), 1);
    }

    #[test]
    fn the_smaller_margin_is_worse_and_what_is_unknown_hides_nothing() {
        assert_eq!(worse(MapCell::Value(2.0), MapCell::Value(1.0)), MapCell::Value(1.0));
        assert_eq!(worse(MapCell::Unknown, MapCell::Unbounded), MapCell::Unbounded);
        assert_eq!(worse(MapCell::Value(-1e9), MapCell::Unstable), MapCell::Unstable);
    }

    #[test]
    fn a_better_margin_is_lighter() {
        let mut two = map(2);
        two.cells[0][0] = MapCell::Value(9.0);
        let grading = Grading::of(&two);
        let light = |value| {
            let colour = grading.colour(MapCell::Value(value)).unwrap();
            colour.iter().map(|channel| u32::from(*channel)).sum::<u32>()
        };
        assert!(light(9.0) > light(6.0) && light(6.0) > light(3.0));
        assert_eq!(grading.colour(MapCell::Unstable), None);
        assert_eq!(grading.number(-0.001), "0.0");
    }
}
