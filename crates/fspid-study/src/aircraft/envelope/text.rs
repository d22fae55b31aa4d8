//! The envelope for people: how much of it can be flown, what stands in the way, and the ends of every quantity.

use std::collections::BTreeMap;

use super::Envelope;
use super::column::Column;
use super::point::{Point, doubles_s, loop_at};
use crate::aircraft::condition::AirChoice;
use crate::aircraft::table::table;
use crate::analysis::Stability;
use fspid_scenario::aircraft::number::significant;
use fspid_scenario::aircraft::quantity;
use fspid_scenario::aircraft::units::Kind;

impl Envelope {
    /// A summary; the points themselves are in the CSV and in the drawings.
    #[must_use]
    pub fn text(&self) -> String {
        let rows: Vec<Vec<String>> =
            self.columns().into_iter().filter_map(|column| self.ends(column)).collect();
        let headings = ["quantity", "least", "unit", "at", "most", "at"];
        let mut out = format!(
            "{}\n{}\n{} of {} points can be flown\n{}\n{}",
            self.title,
            self.where_in_words(),
            self.points.iter().filter(|point| point.flight.is_ok()).count(),
            self.points.len(),
            self.growth_in_words(),
            table(&headings, &rows),
        );
        out.push_str(&self.obstacles());
        out.push_str(&self.loop_in_words());
        out
    }

    fn where_in_words(&self) -> String {
        let ends = |kind, values: &[f64]| {
            let end = |value: Option<&f64>| value.map(|value| quantity(self.units, kind, *value));
            let (first, last) = (end(values.first()), end(values.last()));
            format!("{} to {}", first.unwrap_or_default(), last.unwrap_or_default())
        };
        let air = match self.air {
            AirChoice::Standard => "standard atmosphere",
            AirChoice::Source => "density of the source everywhere",
        };
        let speeds = ends(Kind::Speed, &self.speeds_m_s);
        let altitudes = ends(Kind::Length, &self.altitudes_m);
        format!("level flight at {speeds}, {altitudes}; {air}")
    }

    /// At how many points the aircraft leaves its trim by itself; nothing where it does so nowhere.
    fn growth_in_words(&self) -> String {
        let held = self.points.iter().filter_map(|point| point.flight.as_ref().ok());
        let times: Vec<f64> = held.filter_map(doubles_s).collect();
        let Some(fastest_s) = times.iter().copied().min_by(f64::total_cmp) else {
            return String::new();
        };
        let (points, fastest_s) = (times.len(), significant(fastest_s, 3));
        format!(
            "a longitudinal motion grows by itself at {points} of them, at the fastest to double in {fastest_s} s\n"
        )
    }

    /// Least and most of a quantity, with the points where they are.
    fn ends(&self, column: &Column) -> Option<Vec<String>> {
        let known = || self.points.iter().filter_map(|p| Some((column.of(p)?, p)));
        let least = known().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let most = known().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let value = |si| significant(self.units.told(column.kind, si), 6);
        let unit = match self.units.of(column.kind).symbol {
            "" => "-",
            symbol => symbol,
        };
        let [low, high] = [least, most].map(|(si, point)| (value(si), self.place(point)));
        Some(vec![column.name.to_owned(), low.0, unit.to_owned(), low.1, high.0, high.1])
    }

    fn place(&self, point: &Point) -> String {
        let speed = quantity(self.units, Kind::Speed, point.target.airspeed_m_s);
        format!("{speed}, {}", quantity(self.units, Kind::Length, point.target.altitude_m))
    }

    /// Which limits stand in the way, and at how many points.
    fn obstacles(&self) -> String {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for failure in self.points.iter().filter_map(|point| point.flight.as_ref().err()) {
            let names = failure.limits.iter().map(|limit| limit.quantity.name());
            let none = failure.limits.is_empty().then_some("no balance of forces");
            for name in names.chain(none) {
                *counts.entry(name).or_default() += 1;
            }
        }
        let lines = counts.iter().map(|(name, count)| format!("  {name}: {count} point(s)\n"));
        match counts.is_empty() {
            true => String::new(),
            false => format!("\nlimits in the way\n{}", lines.collect::<String>()),
        }
    }

    fn loop_in_words(&self) -> String {
        let Some(autopilot) = &self.autopilot else { return String::new() };
        let flown = self.points.iter().filter_map(loop_at).count();
        let others = [Stability::Unstable, Stability::Undecided].map(|it| (it, self.loops(it)));
        let others = others.iter().filter(|(_, count)| *count > 0);
        let others: String =
            others.map(|(it, count)| format!(", {} at {count}", it.word())).collect();
        let stable = self.loops(Stability::Stable);
        let (words, whose) = (autopilot.words(), autopilot.whose());
        let firsts = self.first_reasons();
        format!("\n{words}\n  stable at {stable} of {flown} points{others}\n{firsts}  {whose}\n")
    }

    /// The first point that is undecided, and the first that is stable without a margin, with why.
    fn first_reasons(&self) -> String {
        let mut all = String::new();
        for (stability, what) in [
            (Stability::Undecided, "undecided first"),
            (Stability::Stable, "stable without a gain margin first"),
        ] {
            let mut reasons = self.points.iter().filter_map(|point| {
                let found = loop_at(point).filter(|it| it.stability == stability)?;
                Some((point, found.reason.as_ref()?))
            });
            if let Some((point, reason)) = reasons.next() {
                all.push_str(&format!("  {what} at {}: {reason}\n", self.place(point)));
            }
        }
        all
    }
}
