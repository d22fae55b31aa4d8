//! The envelope as CSV: a line a point.

use super::Envelope;
use super::point::{Point, loop_at, reason};
use crate::aircraft::facts::key;
use crate::rows::quoted;
use fspid_scenario::aircraft::units::Kind;

impl Envelope {
    /// A line a point: where, whether it can be flown or why not, and every quantity with its unit in the heading; with an
    /// autopilot whether its loop is stable, unstable or undecided, and why it is not stable or has no margin.
    #[must_use]
    pub fn csv(&self) -> String {
        let units = self.units;
        let first = [
            key("airspeed", Kind::Speed, units),
            key("altitude", Kind::Length, units),
            "flyable".to_owned(),
            "reason".to_owned(),
        ];
        let columns = self.columns();
        let more = columns.iter().map(|column| key(column.key, column.kind, units));
        let of_loop: &[&str] =
            if self.autopilot.is_some() { &["loop_stability", "loop_reason"] } else { &[] };
        let of_loop = of_loop.iter().map(|key| (*key).to_owned());
        let mut csv = first.into_iter().chain(more).chain(of_loop).collect::<Vec<_>>().join(",");
        csv.push('\n');
        for point in &self.points {
            csv.push_str(&self.line(point));
            csv.push('\n');
        }
        csv
    }

    fn line(&self, point: &Point) -> String {
        let units = self.units;
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:?}"));
        let mut cells = vec![
            number(Some(units.told(Kind::Speed, point.target.airspeed_m_s))),
            number(Some(units.told(Kind::Length, point.target.altitude_m))),
            point.flight.is_ok().to_string(),
            quoted(&reason(point, units).unwrap_or_default()),
        ];
        let columns = self.columns();
        let told = columns
            .iter()
            .map(|column| number(column.of(point).map(|value| units.told(column.kind, value))));
        cells.extend(told);
        if self.autopilot.is_some() {
            let found = loop_at(point);
            let why = found.and_then(|it| it.reason.as_deref()).unwrap_or_default();
            cells.push(found.map_or("", |it| it.stability.word()).to_owned());
            cells.push(quoted(why));
        }
        cells.join(",")
    }
}
