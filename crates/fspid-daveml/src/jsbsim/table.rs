//! Tables of one to three axes; beyond their ends the values at the ends are held, as JSBSim does.

use crate::document::{Breakpoints, Extrapolate, FunctionInput, GridTable, Mention, TableFunction};
use crate::expression::Expression;
use crate::jsbsim::class::Class;
use crate::jsbsim::property::{ALPHA, BETA, Builder, Term, named};
use crate::xml::element::{Element, number};

/// Names of the axes in the order of a grid: a row of values follows along the last.
const AXES: [&str; 3] = ["table", "row", "column"];

/// An axis of a table: its name, the variable that enters it, where its values stand.
struct Axis {
    name: &'static str,
    variable: String,
    points: Vec<f64>,
}

impl Builder<'_> {
    /// A variable that is read off a table, named after the function that it stands in.
    pub(super) fn table(&mut self, element: Element<'_, '_>, owner: &str) -> Option<Term> {
        let id = format!("{owner}.table-{}", self.document.tables.len() + 1);
        let entered = self.entered(element)?;
        let class = self
            .judged(element, Class::function(&entered.iter().map(|it| it.2).collect::<Vec<_>>()))?;
        let names: Vec<_> = entered.iter().map(|(name, ..)| *name).collect();
        let (points, values) = match names.as_slice() {
            ["row"] => self.line(element),
            ["row", "column"] => self.sheet(sheets(element).first().copied()?),
            ["table", "row", "column"] => self.sheets(element),
            _ => {
                let expected = "one <independentVar>, or row and column, or row, column and table";
                let message = format!("its axes are {}", names.join(", "));
                self.findings.problem(element.origin(), "table", message, expected);
                None
            }
        }?;
        let axes = entered.into_iter().zip(points);
        let axes = axes.map(|((name, variable, _), points)| {
            // What is held is no angle of the flight.
            let is_held = self.is_held(&variable);
            let (variable, scale) = if is_held { (variable, 1.0) } else { in_radians(variable) };
            let points = points.into_iter().map(|point| scale * point).collect();
            Axis { name, variable, points }
        });
        self.keep(element, &id, axes.collect(), values);
        self.add(named(&id, &id, "nd"), class);
        Some(Term { formula: Expression::Variable { id, origin: element.origin() }, class })
    }

    /// The variables that enter a table, in the order of a grid.
    fn entered(&mut self, element: Element<'_, '_>) -> Option<Vec<(&'static str, String, Class)>> {
        element.only(&["name"], self.findings);
        for part in element.children(self.findings) {
            if !matches!(part.name(), "independentVar" | "tableData" | "description") {
                part.refuse("table", "independentVar, tableData", self.findings);
                return None;
            }
        }
        if sheets(element).is_empty() {
            let message = "a table without values";
            self.findings.problem(element.origin(), "table", message, "<tableData>");
            return None;
        }
        let mut found = Vec::new();
        for part in element.elements().filter(|part| part.name() == "independentVar") {
            let lookup = part.attribute("lookup").unwrap_or("row");
            let Some(name) = AXES.iter().find(|name| **name == lookup) else {
                let message = "no axis of a table";
                self.findings.problem(part.origin(), lookup, message, "row, column, table");
                return None;
            };
            let term = self.property(&part.prose(), part.origin());
            match term {
                Some(Term { formula: Expression::Variable { id, .. }, class }) => {
                    found.push((*name, id, class));
                }
                Some(_) => {
                    let message = "this cannot enter a table";
                    self.findings.problem(part.origin(), &part.prose(), message, "a property");
                }
                None => {}
            }
        }
        let all = element.elements().filter(|part| part.name() == "independentVar").count();
        found.sort_by_key(|(name, ..)| AXES.iter().position(|it| it == name));
        (found.len() == all).then_some(found)
    }

    /// Two columns: where, and what.
    fn line(&mut self, element: Element<'_, '_>) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let data = sheets(element).first().copied()?;
        let rows = self.rows(data)?;
        let pairs: Vec<_> = rows.iter().flatten().copied().collect();
        if pairs.len() % 2 != 0 {
            let message = format!("the number of numbers is {}", pairs.len());
            self.findings.problem(data.origin(), "tableData", message, "two in each line");
            return None;
        }
        let (pairs, _) = pairs.as_chunks::<2>();
        let (points, values) = pairs.iter().map(|&[point, value]| (point, value)).unzip();
        Some((vec![points], values))
    }

    /// A line of places along the columns, then lines that begin with their place.
    fn sheet(&mut self, data: Element<'_, '_>) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let rows = self.rows(data)?;
        let (columns, rows) = rows.split_first()?;
        let width = columns.len();
        let mut points = Vec::with_capacity(rows.len());
        let mut values = Vec::with_capacity(rows.len().saturating_mul(width));
        for row in rows {
            let (point, row) = row.split_first()?;
            if row.len() != width {
                let message = format!("the line of {point} has {} values", row.len());
                self.findings.problem(data.origin(), "tableData", message, width.to_string());
                return None;
            }
            points.push(*point);
            values.extend(row);
        }
        Some((vec![points, columns.clone()], values))
    }

    /// Sheets, each with its place; all with the same lines and columns.
    fn sheets(&mut self, element: Element<'_, '_>) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let (mut places, mut grid, mut values) = (Vec::new(), None, Vec::new());
        for data in sheets(element) {
            places.push(data.number("breakPoint", self.findings)?);
            let (points, sheet) = self.sheet(data)?;
            if *grid.get_or_insert_with(|| points.clone()) != points {
                let message = "its places differ from those of the first <tableData>";
                let expected =
                    "the same rows and columns in each; interpolate those that are missing";
                self.findings.problem(data.origin(), "tableData", message, expected);
                return None;
            }
            values.extend(sheet);
        }
        let mut points = vec![places];
        points.extend(grid?);
        Some((points, values))
    }

    /// The numbers of each line that has any.
    fn rows(&mut self, data: Element<'_, '_>) -> Option<Vec<Vec<f64>>> {
        let text = data.text();
        let mut rows = Vec::new();
        for line in text.lines().filter(|line| !line.trim().is_empty()) {
            let words = line.split_whitespace();
            let row: Option<Vec<f64>> =
                words.map(|word| number(word, data.origin(), self.findings)).collect();
            rows.push(row?);
        }
        if rows.is_empty() {
            let message = "a table without numbers";
            self.findings.problem(data.origin(), "tableData", message, "lines of numbers");
            return None;
        }
        Some(rows)
    }

    fn keep(&mut self, element: Element<'_, '_>, id: &str, axes: Vec<Axis>, values: Vec<f64>) {
        let mention = |id: &str| Mention { id: id.to_owned(), origin: element.origin() };
        let mut function = TableFunction {
            name: id.to_owned(),
            output: mention(id),
            table: mention(id),
            origin: element.origin(),
            ..TableFunction::default()
        };
        let mut table = GridTable {
            id: id.to_owned(),
            values,
            origin: element.origin(),
            ..GridTable::default()
        };
        for Axis { name, variable, points } in axes {
            let axis = format!("{id}.{name}");
            table.breakpoints.push(mention(&axis));
            function.inputs.push(FunctionInput {
                variable: mention(&variable),
                min: None,
                max: None,
                extrapolate: Extrapolate::Neither,
            });
            self.document.breakpoints.push(Breakpoints {
                id: axis,
                values: points,
                origin: element.origin(),
                ..Breakpoints::default()
            });
        }
        self.document.tables.push(table);
        self.document.functions.push(function);
    }
}

/// The angle of a flight for one in degrees, so that the ends of its tables bound the flight, and what one degree is.
fn in_radians(variable: String) -> (String, f64) {
    use fspid_numeric::units::DEGREE_RAD as RADIANS;
    match variable.as_str() {
        "aero/alpha-deg" => (ALPHA.to_owned(), RADIANS),
        "aero/beta-deg" => (BETA.to_owned(), RADIANS),
        _ => (variable, 1.0),
    }
}

/// The parts of a table with numbers.
fn sheets<'a, 'i>(element: Element<'a, 'i>) -> Vec<Element<'a, 'i>> {
    element.elements().filter(|part| part.name() == "tableData").collect()
}
