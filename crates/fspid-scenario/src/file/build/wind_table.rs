//! Winds of rows: in the scenario, or in a file of their own.

use std::collections::BTreeSet;

use fspid_diagnostics::{Report, Span};
use fspid_sim::air::{Along, TableRow, WindTable};

use super::rad;
use crate::file::files::Files;
use crate::file::spec::air as keys;
use crate::keyed::{Key, Section};
use crate::units::{FOOT_M, KNOT_M_S};

/// The table of a wind that is one.
pub(super) fn table(
    report: &mut Report,
    files: &mut Files<'_>,
    part: &Section,
) -> Option<WindTable> {
    match part.get(keys::WIND_FILE) {
        Some(name) => of_file(report, files, (part, name)),
        None => of_lists(report, part),
    }
}

/// What the rows go by, and in which unit: name of the column, and what one of it is in m or s.
const AXES: [(&str, Along, f64); 5] = [
    ("time_s", Along::Time, 1.0),
    ("distance_m", Along::Distance, 1.0),
    ("distance_ft", Along::Distance, FOOT_M),
    ("height_m", Along::Height, 1.0),
    ("height_ft", Along::Height, FOOT_M),
];
/// Units of speeds, as names end in them, and what one of it is in m/s.
const SPEED_UNITS: [(&str, f64); 3] = [("_m_s", 1.0), ("_kt", KNOT_M_S), ("_ft_s", FOOT_M)];
/// Directions of the air in the order of [`velocity`], and the speed of a wind that comes from somewhere.
const DIRECTIONS: [&str; 6] = ["north", "east", "up", "forward", "right", "speed"];
const FROM: &str = "from_deg";
/// Place of the speed among the directions.
const SPEED: usize = 5;
/// Most problems that are told of one file.
const MOST_PROBLEMS: usize = 20;

const COLUMNS: &str = "one of time_s, distance_m, distance_ft, height_m, height_ft; then north, east, up, forward, right in _m_s, _kt or _ft_s, or a speed in one of these with from_deg in place of north and east";

/// A row from its velocities to the north, to the east, up, forward and to the right, m/s.
fn row(at: f64, [north, east, up, forward, right]: [f64; 5]) -> TableRow {
    // Plus zero, so that calm air does not fall by -0.
    TableRow { at, earth_m_s: [north, east, 0.0 - up], body_m_s: [forward, right, 0.0] }
}

/// The table whose rows stand in the scenario.
fn of_lists(report: &mut Report, part: &Section) -> Option<WindTable> {
    let given = |key: &&Key<[f64]>| part.given(key.name);
    let axis = keys::AXES.iter().position(|key| part.given(key.name))?;
    let along = [Along::Time, Along::Distance, Along::Height].get(axis).copied()?;
    let at = part.numbers(*keys::AXES.get(axis)?)?;
    let mut sound = true;
    for (index, pair) in at.windows(2).enumerate() {
        if let [before, after] = pair
            && !(after > before)
        {
            let message = format!("number {} is not above the one before, {before:?}", index + 2);
            part.wrong(report, *keys::AXES.get(axis)?, message, "numbers that rise");
            sound = false;
            break;
        }
    }
    if keys::VELOCITIES.iter().filter(given).count() == 0 {
        let names: Vec<&str> = keys::VELOCITIES.iter().map(|key| key.name.as_str()).collect();
        let message = "missing key; a table of winds has a velocity";
        part.problem(report, keys::NORTH_M_S, message, names.join(", "));
        return None;
    }
    let mut velocities = vec![[0.0; 5]; at.len()];
    for (place, key) in keys::VELOCITIES.iter().enumerate() {
        let Some(values) = part.numbers(*key) else { continue };
        if values.len() != at.len() {
            let message = format!("{} numbers for {} rows", values.len(), at.len());
            part.wrong(report, *key, message, format!("{} numbers", at.len()));
            sound = false;
        }
        for (velocity, value) in velocities.iter_mut().zip(values) {
            if let Some(part) = velocity.get_mut(place) {
                *part = value;
            }
        }
    }
    let rows = at.into_iter().zip(velocities).map(|(at, velocity)| row(at, velocity)).collect();
    if sound { WindTable::new(along, rows).ok() } else { None }
}

/// The table of a file.
fn of_file(
    report: &mut Report,
    files: &mut Files<'_>,
    (part, name): (&Section, &str),
) -> Option<WindTable> {
    for key in keys::VELOCITIES.iter().filter(|key| part.given(key.name)) {
        part.problem(report, *key, "not together with `file`", "velocities in the file alone");
    }
    let text = files.read(name).map_err(|reason| {
        let allowed = "a readable CSV file, its path relative to the scenario's folder";
        part.wrong(report, keys::WIND_FILE, format!("cannot be read: {reason}"), allowed);
    });
    let text = text.ok()?;
    files.digest(&text);
    let source = report.add_source(Some(name.to_owned()), &text);
    let mut reading = Reading { report, source, path: part.path(keys::WIND_FILE), problems: 0 };
    reading.table(&text)
}

/// What a column of a file is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// What the rows go by, and its unit.
    At(Along, f64),
    /// A speed in a direction, and its unit.
    Speed(usize, f64),
    /// Where a wind comes from.
    From,
}

fn column(name: &str) -> Option<Column> {
    if name == FROM {
        return Some(Column::From);
    }
    if let Some((_, along, unit)) = AXES.iter().find(|(known, ..)| *known == name) {
        return Some(Column::At(*along, *unit));
    }
    SPEED_UNITS.iter().find_map(|(end, unit)| {
        let direction = name.strip_suffix(end)?;
        let place = DIRECTIONS.iter().position(|known| *known == direction)?;
        Some(Column::Speed(place, *unit))
    })
}

/// A file that is read, with what is wrong in it.
struct Reading<'a> {
    report: &'a mut Report,
    source: usize,
    path: String,
    problems: usize,
}

impl Reading<'_> {
    fn wrong(&mut self, (start, end): (usize, usize), message: String, allowed: &str) {
        self.problems += 1;
        if self.problems <= MOST_PROBLEMS {
            let place = Span { source: self.source, start, end };
            self.report.missing(place, &self.path, message, allowed);
        }
    }

    fn table(&mut self, text: &str) -> Option<WindTable> {
        let mut lines = lines(text);
        let Some(heading) = lines.next() else {
            self.wrong((0, 0), "the file has no line".to_owned(), COLUMNS);
            return None;
        };
        let (along, columns) = self.columns(&heading)?;
        let mut rows: Vec<TableRow> = Vec::new();
        for line in lines {
            if rows.len() >= WindTable::MOST_ROWS {
                let message = format!("more than {} rows", WindTable::MOST_ROWS);
                self.wrong((line.start, line.end()), message, "a table that is thinned out");
                return None;
            }
            let Some(row) = self.row(&line, &columns) else { continue };
            if let Some(before) = rows.last()
                && !(row.at > before.at)
            {
                let message = "the row is not above the one before".to_owned();
                self.wrong((line.start, line.end()), message, "rows in rising order");
            }
            rows.push(row);
        }
        if self.problems == 0 && rows.len() < 2 {
            let message = format!("{} rows", rows.len());
            self.wrong((heading.start, heading.end()), message, "two rows or more");
        }
        if self.problems == 0 { WindTable::new(along, rows).ok() } else { None }
    }

    /// What the columns are.
    fn columns(&mut self, heading: &Line<'_>) -> Option<(Along, Vec<Column>)> {
        let before = self.problems;
        let (mut columns, mut names) = (Vec::new(), BTreeSet::new());
        for (place, name) in heading.cells() {
            match column(name) {
                None => self.wrong(place, format!("no column is called `{name}`"), COLUMNS),
                Some(_) if !names.insert(name) => {
                    self.wrong(place, format!("`{name}` stands twice"), "each column once");
                }
                Some(column) => columns.push(column),
            }
        }
        if self.problems > before {
            return None;
        }
        let whole = (heading.start, heading.end());
        let axes = columns.iter().filter_map(|column| match column {
            Column::At(along, _) => Some(*along),
            Column::Speed(..) | Column::From => None,
        });
        let axes: Vec<Along> = axes.collect();
        let speeds: Vec<usize> = columns
            .iter()
            .filter_map(|column| match column {
                Column::Speed(place, _) => Some(*place),
                Column::At(..) | Column::From => None,
            })
            .collect();
        let has_from = columns.contains(&Column::From);
        let twice = speeds
            .iter()
            .enumerate()
            .any(|(at, place)| speeds.iter().skip(at + 1).any(|it| it == place));
        let mixed = has_from && speeds.iter().any(|place| *place < 2);
        let message = match axes.as_slice() {
            [] => "no column says what the rows go by",
            [_, _, ..] => "two columns say what the rows go by",
            _ if speeds.is_empty() => "no column is a velocity",
            _ if has_from != speeds.contains(&SPEED) => "a speed and from_deg go together",
            _ if mixed => "a speed with from_deg stands in place of north and east",
            _ if twice => "a direction stands twice, in two units",
            [along] => return Some((*along, columns)),
        };
        self.wrong(whole, message.to_owned(), COLUMNS);
        None
    }

    fn row(&mut self, line: &Line<'_>, columns: &[Column]) -> Option<TableRow> {
        let cells: Vec<_> = line.cells().collect();
        if cells.len() != columns.len() {
            let message = format!("{} cells under {} columns", cells.len(), columns.len());
            self.wrong((line.start, line.end()), message, "a number for each column");
            return None;
        }
        let (mut at, mut speeds, mut from_rad) = (0.0, [0.0; 6], None);
        let before = self.problems;
        for ((place, cell), column) in cells.into_iter().zip(columns) {
            let Some(value) = cell.parse::<f64>().ok().filter(|value| value.is_finite()) else {
                let shown: String = cell.chars().take(40).collect();
                self.wrong(place, format!("`{shown}` is no finite number"), "a finite number");
                continue;
            };
            match column {
                Column::At(_, unit) => at = value * unit,
                Column::Speed(place, unit) => {
                    if let Some(speed) = speeds.get_mut(*place) {
                        *speed = value * unit;
                    }
                }
                Column::From => from_rad = Some(rad(value)),
            }
        }
        if self.problems > before {
            return None;
        }
        let [mut north, mut east, up, forward, right, speed] = speeds;
        if let Some(from_rad) = from_rad {
            // The air moves away from where the wind comes from.
            let (sine, cosine) = libm::sincos(from_rad);
            (north, east) = (-speed * cosine, -speed * sine);
        }
        Some(row(at, [north, east, up, forward, right]))
    }
}

/// A line of a file and where it begins.
struct Line<'a> {
    start: usize,
    text: &'a str,
}

impl<'a> Line<'a> {
    fn end(&self) -> usize {
        self.start + self.text.len()
    }

    /// Its cells, each with where it stands.
    fn cells(&self) -> impl Iterator<Item = ((usize, usize), &'a str)> {
        let mut start = self.start;
        self.text.split(',').map(move |cell| {
            let here = start + (cell.len() - cell.trim_start().len());
            start += cell.len() + 1;
            let cell = cell.trim();
            ((here, here + cell.len()), cell)
        })
    }
}

/// Lines that say something: no empty ones, and no remarks behind `#`.
fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut start = 0;
    let all = text.split('\n').map(move |line| {
        let here = start;
        start += line.len() + 1;
        let bare = line.trim_start_matches('\u{feff}');
        Line { start: here + (line.len() - bare.len()), text: bare.trim_end() }
    });
    all.filter(|line| !line.text.is_empty() && !line.text.trim_start().starts_with('#'))
}
