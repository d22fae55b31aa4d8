//! Marks: `{ tune = [0.1, 10.0], scale = "log" }` in place of a number, `{ tune = "rules", ... }` in place
//! of a grid of rules, `{ tune = "numbers", ... }` in place of a grid of numbers. A mark flies as its start; it is taken out of the document before the check.

use fspid_fuzzy::{Grid, LABEL_COUNT, Label, NumberGrid};

use crate::file::Template;
use crate::file::setting::named_step;
use crate::keyed::check::{FIXED, grid_text, number_grid};
use crate::keyed::document::{Item, Member, Value};
use crate::setting_path::{NewValue, SettingPath, bare};
use crate::tuning::{Free, Monotone, TunableGrid, TunableNumber, TunableNumbers, TunableParameter};
use fspid_diagnostics::{Problems, Report, Span, nearest};
use fspid_optimise::Scale;

/// The key that makes a table a mark.
pub(super) const KEY: &str = "tune";
/// The key of the value that a mark flies as.
pub(super) const START: &str = "start";
/// Words for the scale.
const SCALES: [(Scale, &str); 2] = [(Scale::Linear, "linear"), (Scale::Logarithmic, "log")];
const NUMBER_KEYS: [&str; 3] = [KEY, "scale", START];
const GRID_KEYS: [&str; 6] = [KEY, START, "reach", "symmetric", "at_rest", "monotone"];
const NUMBERS_KEYS: [&str; 4] = [KEY, START, "reach", "symmetric"];
/// How many labels a cell may move, unless the mark says.
const USUAL_REACH: u8 = 2;

/// JSON Schemas of the two kinds of marks.
pub(crate) fn schemas() -> serde_json::Value {
    let scales = SCALES.map(|(_, name)| name);
    let orders = Monotone::NAMES.map(|(_, name)| name);
    serde_json::json!({
        "mark": {
            "description": "A number that `fspid tune` may choose; it flies as its start.",
            "type": "object",
            "properties": {
                KEY: { "description": "[lower, upper]", "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
                "scale": { "description": "How it is spread.", "type": "string", "enum": scales, "default": "linear" },
                "start": { "description": "Where the search begins; the middle if left out.", "type": "number" },
            },
            "required": [KEY],
            "additionalProperties": false,
        },
        "rules": {
            "description": "A grid of rules whose labels `fspid tune` may choose.",
            "type": "object",
            "properties": {
                KEY: { "const": "rules" },
                "start": { "description": "Seven lines of seven labels.", "type": "string" },
                "reach": { "description": "How many labels a cell may move.", "type": "integer", "minimum": 1, "maximum": 6, "default": USUAL_REACH },
                "symmetric": { "description": "Opposite error and change have the same answer.", "type": "boolean", "default": true },
                "at_rest": { "description": "The label of no error and no change.", "type": "string", "enum": Label::ALL.map(Label::name) },
                "monotone": { "description": "How labels run from the middle outwards.", "type": "string", "enum": orders, "default": "no" },
            },
            "required": [KEY, "start"],
            "additionalProperties": false,
        },
        "numbers": {
            "description": "A grid of numbers that `fspid tune` may choose.",
            "type": "object",
            "properties": {
                KEY: { "const": "numbers" },
                "start": {
                    "description": "Seven lists of seven numbers.", "type": "array", "minItems": 7, "maxItems": 7,
                    "items": { "type": "array", "items": { "type": "number" }, "minItems": 7, "maxItems": 7 },
                },
                "reach": { "description": "How far a cell may move, in the units of the range.", "type": "number", "exclusiveMinimum": 0 },
                "symmetric": { "description": "Opposite error and change have the same answer.", "type": "boolean", "default": true },
            },
            "required": [KEY, "start", "reach"],
            "additionalProperties": false,
        },
    })
}

/// Takes the marks out of a document and leaves their starts.
pub(crate) fn take(report: &mut Report, document: &mut Item) -> Vec<TunableParameter> {
    let mut marks = Vec::new();
    let mut walk = Walk { report, marks: &mut marks, controller: None };
    walk.inside(document, "");
    // Tables know their keys in alphabetical order only.
    marks.sort_by_key(|mark| (mark.bytes.start, mark.path.text().to_owned()));
    marks
}

struct Walk<'a> {
    report: &'a mut Report,
    marks: &'a mut Vec<TunableParameter>,
    /// Name of the controller that is walked through.
    controller: Option<String>,
}

impl Walk<'_> {
    fn inside(&mut self, item: &mut Item, path: &str) {
        match &mut item.value {
            Value::Table(members) => {
                for member in members {
                    let inner = match path {
                        "" => bare(&member.name),
                        path => format!("{path}.{}", bare(&member.name)),
                    };
                    self.visit(&mut member.item, &inner);
                }
            }
            Value::Array(items) => {
                for (index, item) in items.iter_mut().enumerate() {
                    let inner = format!("{path}{}", named_step(name_of(item), index));
                    if path == "controller" {
                        self.controller = Some(name_of(item).to_owned());
                    }
                    self.visit(item, &inner);
                }
                if path == "controller" {
                    self.controller = None;
                }
            }
            _ => {}
        }
    }

    fn visit(&mut self, item: &mut Item, path: &str) {
        let Value::Table(members) = &item.value else {
            return self.inside(item, path);
        };
        if !members.iter().any(|member| member.name == KEY) {
            return self.inside(item, path);
        }
        if !self.report.text(item.place).starts_with('{') {
            let allowed = "{ tune = [lower, upper] } in braces after the `=`";
            self.report.missing(item.place, path, "a mark in a table of its own", allowed);
        }
        let mark = Fields { report: self.report, members, place: item.place, path };
        let root = path.split(['.', '[']).next().unwrap_or_default();
        if FIXED.contains(&root) {
            mark.report.missing(item.place, path, "nothing can be tuned here", "a value");
        }
        let Some(free) = mark.free() else {
            item.value = stand_in(members, item.place);
            return;
        };
        item.value = match &free {
            Free::Numbers(numbers) => rows(&numbers.start, item.place),
            Free::Number(number) => Value::Float(number.start),
            Free::Grid(grid) => Value::Text(grid_text(&grid.start)),
        };
        if let Some(path) = SettingPath::parse(path) {
            let bytes =
                if item.place.source == 0 { item.place.start..item.place.end } else { 0..0 };
            self.marks.push(TunableParameter {
                path,
                free,
                controller: self.controller.clone(),
                bytes,
            });
        }
    }
}

/// What stands where a mark is wrong: a value of the kind that is meant, so that the mark's problem is the only
/// one. The start says it, or else the word behind `tune`.
fn stand_in(members: &[Member], place: Span) -> Value {
    let of = |key: &str| members.iter().find(|it| it.name == key).map(|it| &it.item.value);
    let is_list = |item: &Item| matches!(item.value, Value::Array(_));
    let is_word = |known: &str| matches!(of(KEY), Some(Value::Text(word)) if word == known);
    match of("start") {
        Some(Value::Array(start)) if start.iter().any(is_list) => {
            rows(&[[0.0; LABEL_COUNT]; LABEL_COUNT], place)
        }
        Some(Value::Text(start)) if Grid::parse(start).is_ok() => rest(),
        _ if is_word("numbers") => rows(&[[0.0; LABEL_COUNT]; LABEL_COUNT], place),
        _ if is_word("rules") => rest(),
        _ => Value::Float(1.0),
    }
}

/// A grid of rules that conclude nothing.
fn rest() -> Value {
    let line = [Label::ZO.name(); LABEL_COUNT].join(" ");
    Value::Text([line.as_str(); LABEL_COUNT].join("\n"))
}

/// A grid of numbers as a list of lists.
fn rows(grid: &NumberGrid<f64>, place: Span) -> Value {
    let item = |value| Item { place, value };
    let row = |row: &[f64; LABEL_COUNT]| {
        item(Value::Array(row.iter().map(|number| item(Value::Float(*number))).collect()))
    };
    Value::Array(grid.iter().map(row).collect())
}

fn name_of(item: &Item) -> &str {
    let Value::Table(members) = &item.value else {
        return "";
    };
    match members.iter().find(|member| member.name == "name").map(|member| &member.item.value) {
        Some(Value::Text(name)) => name,
        _ => "",
    }
}

/// The keys of a mark.
struct Fields<'a> {
    report: &'a mut Report,
    members: &'a [Member],
    place: Span,
    path: &'a str,
}

impl Fields<'_> {
    fn member(&self, name: &str) -> Option<&Item> {
        self.members.iter().find(|member| member.name == name).map(|member| &member.item)
    }

    fn free(self) -> Option<Free> {
        let before = self.report.count();
        let mut fields = self;
        let free = match fields.member(KEY).map(|item| &item.value) {
            Some(Value::Text(word)) if word == "numbers" => {
                fields.check_keys(&NUMBERS_KEYS);
                fields.numbers().map(|numbers| Free::Numbers(Box::new(numbers)))
            }
            Some(Value::Text(_)) => {
                fields.check_keys(&GRID_KEYS);
                fields.grid().map(Free::Grid)
            }
            _ => {
                fields.check_keys(&NUMBER_KEYS);
                fields.number().map(Free::Number)
            }
        };
        free.filter(|_| fields.report.count() == before)
    }

    fn check_keys(&mut self, known: &[&str]) {
        for member in self.members.iter().filter(|it| !known.contains(&it.name.as_str())) {
            let meant = nearest(&member.name, known).map(|it| format!("; did you mean `{it}`?"));
            let message = format!("unknown key of a mark{}", meant.unwrap_or_default());
            self.report.missing(member.place, self.path, message, known.join(", "));
        }
    }

    fn wrong(&mut self, key: &str, message: &str, allowed: &str) {
        let place = self.member(key).map_or(self.place, |item| item.place);
        self.report.value(place, &format!("{}.{key}", self.path), message, allowed);
    }

    fn number(&mut self) -> Option<TunableNumber> {
        const BOUNDS: &str = "[lower, upper], two finite numbers with lower below upper";
        let bounds = match self.member(KEY).map(|item| &item.value) {
            Some(Value::Array(items)) => items.iter().map(number_of).collect::<Option<Vec<f64>>>(),
            _ => None,
        };
        let Some([lower, upper]) = bounds.as_deref() else {
            self.wrong(KEY, "no bounds", BOUNDS);
            return None;
        };
        let (lower, upper) = (*lower, *upper);
        if !(lower < upper && (upper - lower).is_finite()) {
            self.wrong(KEY, "the bounds hold no number between them", BOUNDS);
            return None;
        }
        let scale = self.word("scale", &SCALES, Scale::Linear)?;
        if scale == Scale::Logarithmic && !(lower > 0.0) {
            self.wrong(
                "scale",
                "a logarithmic scale needs bounds above 0",
                "\"linear\", or a lower bound above 0",
            );
            return None;
        }
        let start = match self.member("start") {
            None => scale.between(lower, upper, 0.5),
            Some(item) => match number_of(item) {
                Some(start) if (lower..=upper).contains(&start) => start,
                _ => {
                    self.wrong(
                        "start",
                        "not within the bounds",
                        &format!("{lower:?} to {upper:?}"),
                    );
                    return None;
                }
            },
        };
        Some(TunableNumber { lower, upper, scale, start })
    }

    /// The word of a key, or the default.
    fn word<T: Copy>(&mut self, key: &str, known: &[(T, &str)], default: T) -> Option<T> {
        let Some(item) = self.member(key) else {
            return Some(default);
        };
        let found = match &item.value {
            Value::Text(text) => known.iter().find(|(_, name)| name == text),
            _ => None,
        };
        if found.is_none() {
            let allowed: Vec<String> = known.iter().map(|(_, it)| format!("\"{it}\"")).collect();
            self.wrong(key, "unknown word", &allowed.join(", "));
        }
        found.map(|(value, _)| *value)
    }

    fn grid(&mut self) -> Option<TunableGrid> {
        self.word(KEY, &[((), "rules"), ((), "numbers")], ())?;
        let start = self.start_grid()?;
        let reach = |value: &Value| match value {
            Value::Integer(_, Some(reach @ 1..=6)) => Some(*reach as u8),
            _ => None,
        };
        let reach = self.of_kind("reach", reach, USUAL_REACH, "a whole number from 1 to 6")?;
        let symmetric = self.symmetric()?;
        let labels = Label::ALL.map(|label| (Some(label), label.name()));
        let at_rest = self.word("at_rest", &labels, None)?;
        let monotone = self.word("monotone", &Monotone::NAMES, Monotone::No)?;
        let mark = TunableGrid { start, reach, symmetric, at_rest, monotone };
        if !mark.start_is_allowed() {
            let allowed = "a grid that is symmetric, at rest and monotone as the mark asks";
            self.wrong("start", "the grid does not keep what is asked of it", allowed);
            return None;
        }
        Some(mark)
    }

    fn symmetric(&mut self) -> Option<bool> {
        let truth = |value: &Value| match value {
            Value::Boolean(truth) => Some(*truth),
            _ => None,
        };
        self.of_kind("symmetric", truth, true, "true or false")
    }

    fn numbers(&mut self) -> Option<TunableNumbers> {
        let start = self.start_numbers();
        let reach = self.reach();
        let symmetric = self.symmetric();
        let mark = TunableNumbers { start: start?, reach: reach?, symmetric: symmetric? };
        if !mark.start_is_allowed() {
            let message = "cell (i, j) is not cell (6 - i, 6 - j) everywhere";
            self.wrong("start", message, "a symmetric grid, or symmetric = false");
            return None;
        }
        Some(mark)
    }

    /// How far numbers move.
    fn reach(&mut self) -> Option<f64> {
        let reach = self.member("reach").map(number_of);
        match reach {
            Some(Some(reach)) if reach > 0.0 => Some(reach),
            found => {
                let message = if found.is_some() { "wrong value" } else { "missing key" };
                self.wrong("reach", message, "a number above 0, in the units of the range");
                None
            }
        }
    }

    fn start_numbers(&mut self) -> Option<NumberGrid<f64>> {
        let Some(start) = self.members.iter().find(|member| member.name == "start") else {
            self.wrong("start", "missing key", number_grid::ALLOWED);
            return None;
        };
        let path = format!("{}.start", self.path);
        let cells = number_grid::check(self.report, &start.item, &path)?;
        let mut grid = [[0.0; LABEL_COUNT]; LABEL_COUNT];
        for (cell, (number, _)) in grid.as_flattened_mut().iter_mut().zip(cells) {
            *cell = number;
        }
        Some(grid)
    }

    fn start_grid(&mut self) -> Option<Grid> {
        const GRID: &str = "seven lines of seven labels out of NB NM NS ZO PS PM PB";
        let Some(Value::Text(text)) = self.member("start").map(|item| &item.value) else {
            let message = self.member("start").map_or("missing key", |_| "no grid of labels");
            self.wrong("start", message, GRID);
            return None;
        };
        let grid = Grid::parse(text);
        if let Err(error) = &grid {
            self.wrong("start", &error.to_string(), "");
        }
        grid.ok()
    }

    /// The value of a key as `read` takes it, or the default where the key is left out.
    fn of_kind<T>(
        &mut self,
        key: &str,
        read: impl Fn(&Value) -> Option<T>,
        default: T,
        allowed: &str,
    ) -> Option<T> {
        let Some(item) = self.member(key) else {
            return Some(default);
        };
        let found = read(&item.value);
        if found.is_none() {
            self.wrong(key, "wrong value", allowed);
        }
        found
    }
}

fn number_of(item: &Item) -> Option<f64> {
    match item.value {
        Value::Float(number) | Value::Integer(number, _) if number.is_finite() => Some(number),
        _ => None,
    }
}

impl Template {
    /// Tries each mark alone at the ends of what may stand there, so that no search begins that its bounds
    /// make wrong.
    ///
    /// # Errors
    /// Everything that is wrong then, each at its mark.
    pub fn check_marks(&self) -> Result<(), Problems> {
        let mut report = self.report();
        for mark in &self.study().tunable_parameters {
            let wrong = mark.ends().into_iter().find_map(|end| {
                let problems = self.with(&[(&mark.path, end.clone())]).err()?;
                Some((end, problems.first_in_a_line()))
            });
            if let Some((end, problem)) = wrong {
                let path = mark.path.text();
                let message = match end {
                    NewValue::Rows(_) => format!("an end of its reach is not allowed: {problem}"),
                    end => format!("{end} is not allowed: {problem}"),
                };
                let allowed = "bounds within what the scenario allows";
                report.missing(self.place_of(path), path, message, allowed);
            }
        }
        report.finish(self.name()).map(|_| ())
    }
}
