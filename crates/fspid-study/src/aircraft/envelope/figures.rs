//! The envelope as drawings: a map a quantity, or a curve where there is only one altitude or speed.

use super::Envelope;
use super::column::Column;
use super::point::{Point, loop_at, short_period};
use crate::analysis::Stability;
use fspid_plot::{LineFigure, LinePanel, Series, SeriesStyle, Surface, Svg, Tiles};
use fspid_scenario::aircraft::units::{Kind, Units};

/// What a hatched place means.
const MISSING: &str = "no trim there; the CSV says why";
/// The same where a loop is asked for a number.
const NO_NUMBER: &str = "no trim there, or no loop that is known to have one; the CSV says why";

impl Envelope {
    /// A drawing for each quantity, with its name.
    #[must_use]
    pub fn figures(&self) -> Vec<(&'static str, Svg)> {
        let columns = self.columns().into_iter().filter(|column| column.drawn);
        let known = columns.filter(|column| self.points.iter().any(|p| column.of(p).is_some()));
        let drawn = known.map(|column| (column.key, self.figure(column)));
        drawn.chain(self.levels()).chain(self.stability()).collect()
    }

    fn figure(&self, column: &Column) -> Svg {
        match (self.speeds_m_s.as_slice(), self.altitudes_m.as_slice()) {
            (_, [_]) => self.curve(column, Kind::Speed, &self.speeds_m_s),
            ([_], _) => self.curve(column, Kind::Length, &self.altitudes_m),
            _ => self.map(column),
        }
    }

    fn title(&self, name: &str) -> String {
        format!("{}: {name}", self.name)
    }

    fn told(&self, kind: Kind, values: &[f64]) -> Vec<f64> {
        values.iter().map(|value| self.units.told(kind, *value)).collect()
    }

    fn values(&self, column: &Column) -> Vec<f64> {
        let value = |point: &Point| column.of(point).unwrap_or(f64::NAN);
        self.told(column.kind, &self.points.iter().map(value).collect::<Vec<_>>())
    }

    fn rows<T: Clone>(&self, values: &[T]) -> Vec<Vec<T>> {
        values.chunks(self.speeds_m_s.len().max(1)).map(<[T]>::to_vec).collect()
    }

    fn map(&self, column: &Column) -> Svg {
        let surface = Surface {
            title: self.title(column.name),
            x_label: label("true airspeed", Kind::Speed, self.units),
            y_label: label("altitude", Kind::Length, self.units),
            z_label: label(column.name, column.kind, self.units),
            xs: self.told(Kind::Speed, &self.speeds_m_s),
            ys: self.told(Kind::Length, &self.altitudes_m),
            values: self.rows(&self.values(column)),
            limit: None,
        };
        surface.map_with_gaps(if column.needs_autopilot { NO_NUMBER } else { MISSING })
    }

    fn curve(&self, column: &Column, kind: Kind, nodes: &[f64]) -> Svg {
        let series = Series {
            name: String::new(),
            style: SeriesStyle::Numbered(0),
            x: self.told(kind, nodes),
            y: self.values(column),
            stairs: false,
        };
        let along = if kind == Kind::Speed { "true airspeed" } else { "altitude" };
        let panel = LinePanel {
            y_label: label(column.name, column.kind, self.units),
            x_label: label(along, kind, self.units),
            series: vec![series],
            ..LinePanel::default()
        };
        LineFigure { title: self.title(column.name), panels: vec![panel], width_px: 720.0 }.render()
    }

    /// Where the loop of the autopilot is stable.
    fn stability(&self) -> Option<(&'static str, Svg)> {
        let autopilot = self.autopilot.as_ref()?;
        let class = |point: &Point| {
            Some(match loop_at(point)?.stability {
                Stability::Stable => 0,
                Stability::Undecided => 1,
                Stability::Unstable => 2,
            })
        };
        let names = [("+", "stable"), ("?", "undecided; the CSV says why"), ("!", "unstable")];
        let tiles = self.tiles(&autopilot.words(), &names, class);
        Some(("loop_stability", tiles.render()))
    }

    /// Levels by the control anticipation parameter.
    fn levels(&self) -> Option<(&'static str, Svg)> {
        let class = |point: &Point| {
            let found = short_period(point.flight.as_ref().ok()?)?.cap_level;
            Some(found.level as usize)
        };
        let names =
            [("1", "level 1"), ("2", "level 2"), ("3", "level 3"), ("worse", "worse than level 3")];
        let category = self.category;
        let name = format!(
            "level by the control anticipation parameter, category {category:?} (MIL-STD-1797A)"
        );
        self.points
            .iter()
            .any(|point| class(point).is_some())
            .then(|| ("cap_level", self.tiles(&name, &names, class).render()))
    }

    fn tiles(
        &self,
        name: &str,
        names: &[(&str, &str)],
        class: impl Fn(&Point) -> Option<usize>,
    ) -> Tiles {
        let classes: Vec<Option<usize>> = self.points.iter().map(class).collect();
        let owned = |(sign, name): &(&str, &str)| ((*sign).to_owned(), (*name).to_owned());
        Tiles {
            title: self.title(name),
            x_label: label("true airspeed", Kind::Speed, self.units),
            y_label: label("altitude", Kind::Length, self.units),
            xs: self.told(Kind::Speed, &self.speeds_m_s),
            ys: self.told(Kind::Length, &self.altitudes_m),
            classes: self.rows(&classes),
            names: names.iter().map(owned).collect(),
            missing: MISSING.to_owned(),
        }
    }
}

/// Name and unit of an axis.
fn label(name: &str, kind: Kind, units: Units) -> String {
    match units.of(kind).symbol {
        "" => name.to_owned(),
        symbol => format!("{name} [{symbol}]"),
    }
}
