//! The fuzzy supervisor as figures and tables.

use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::{
    Defuzzifier, Grid, Increments, Label, OutOfRange, Output, RuleTable, Supervisor,
};

use fspid_page::number;
use fspid_page::page::Figure;
use fspid_plot::{Mark, SEVEN, Surface, SurfaceKind, memberships};

/// Nodes of a gain surface along each input.
const NODES: u32 = 31;
/// Points of a membership curve.
const POINTS: u32 = 400;

/// The increments and how they are called.
const NAMES: [(Output, &str, &str); 3] = [
    (Output::DeltaKp, "kp", "\u{394}k_{p}"),
    (Output::DeltaKi, "ki", "\u{394}k_{i}"),
    (Output::DeltaKd, "kd", "\u{394}k_{d}"),
];

/// Equally spaced values over the range.
fn nodes(range: f64, count: u32) -> Vec<f64> {
    let last = f64::from(count - 1);
    (0..count).map(|k| range * (2.0 * f64::from(k) / last - 1.0)).collect()
}

/// The paper's supervisor with this table; `None` for a range that no supervisor may have.
pub fn exact(table: &RuleTable, range: f64) -> Option<Supervisor<f64>> {
    Supervisor::new(table, range, Defuzzifier::Exact, OutOfRange::Clamp).ok()
}

/// Fig. 4: input sets from the supervisor itself, output sets from their definition; none for a network.
pub fn sets(prefix: &str, supervisor: &Supervisor<f64>) -> Vec<Figure> {
    if supervisor.network().is_some() {
        return Vec::new();
    }
    let range = supervisor.range();
    let grid = nodes(range, POINTS + 1);
    let curve = |index: usize| {
        let grade = |x: f64| supervisor.grades(x).get(index).copied().unwrap_or(f64::NAN);
        grid.iter().map(|&x| (x, grade(x))).collect::<Vec<_>>()
    };
    let inputs = SEVEN.iter().enumerate().map(|(n, label)| ((*label).to_owned(), curve(n)));
    let spacing = range / 3.0;
    let outputs = SEVEN.iter().zip(-3_i8..).map(|(label, steps)| {
        let centre = f64::from(steps) * spacing;
        let corners = [centre - spacing, centre, centre + spacing];
        let points = corners.into_iter().filter(|x| x.abs() <= range * (1.0 + 1e-9));
        let grade = |x: f64| (x, ShapeKind::Triangle.grade(&corners, x));
        ((*label).to_owned(), points.map(grade).collect())
    });
    let input_label = "error e, change of error ec [supervisor units]";
    let output_label = "increments \u{394}k_{p}, \u{394}k_{i}, \u{394}k_{d} [supervisor units]";
    let shapes = match supervisor.numbers() {
        None => "Gaussian sets, neighbours cross at a grade of 0.5",
        Some(_) => "triangles from neighbour to neighbour",
    };
    let inputs = Figure::new(
        format!("{prefix}-inputs"),
        memberships("Input sets of the supervisor", input_label, inputs.collect()),
        format!(
            "Membership functions of both inputs: seven {shapes} (half range {}). Computed by the supervisor \
             that flies.",
            number::exact(range)
        ),
    );
    if supervisor.numbers().is_some() {
        // Numbers have no sets.
        return vec![inputs];
    }
    vec![
        inputs,
        Figure::new(
            format!("{prefix}-outputs"),
            memberships("Output sets of the supervisor", output_label, outputs.collect()),
            "Membership functions of the three outputs: seven triangles, cut off at the ends of the range.",
        ),
    ]
}

/// A cell without its counterpart: row, column, label, and the counterpart's row, column and label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OddCell {
    /// Which gain.
    pub output: Output,
    /// The cell: labels of the error and of its change.
    pub at: (Label, Label),
    /// What it says.
    pub found: Label,
    /// The cell opposite to it.
    pub opposite: (Label, Label),
    /// What that one says.
    pub there: Label,
}

/// Cells that break the symmetry of their grid. For kp and ki: opposite inputs have opposite labels.
/// For kd: opposite changes have the same label.
pub fn odd_cells(table: &RuleTable) -> Vec<OddCell> {
    let mut odd = Vec::new();
    for output in Output::ALL {
        let grid = table.grid(output);
        for error in Label::ALL {
            for change in Label::ALL {
                let (opposite, expected) = counterpart(grid, output, error, change);
                let found = grid.at(error, change);
                if found != expected {
                    let there = grid.at(opposite.0, opposite.1);
                    odd.push(OddCell { output, at: (error, change), found, opposite, there });
                }
            }
        }
    }
    odd
}

/// The opposite cell, and what its label asks of this one.
fn counterpart(
    grid: &Grid,
    output: Output,
    error: Label,
    change: Label,
) -> ((Label, Label), Label) {
    let opposite = match output {
        Output::DeltaKp | Output::DeltaKi => (error.mirrored(), change.mirrored()),
        Output::DeltaKd => (error, change.mirrored()),
    };
    let there = grid.at(opposite.0, opposite.1);
    (opposite, if output == Output::DeltaKd { there } else { there.mirrored() })
}

/// Cells that the paper prints with a double slash before the kd label (erratum E7).
const DOUBLE_SLASHES: [(Label, Label); 3] =
    [(Label::NB, Label::PB), (Label::PB, Label::NB), (Label::PB, Label::NM)];

/// The three grids of a table with their odd cells marked.
pub fn rule_tables(prefix: &str, name: &str, table: &RuleTable, marks: Marks) -> Vec<Figure> {
    let odd = odd_cells(table);
    let figure = |(output, letter, symbol): (Output, &str, &str)| {
        let grid = table.grid(output);
        let label = |row: &Label, column: &Label| grid.at(*row, *column).name().to_owned();
        let cells = Label::ALL
            .iter()
            .map(|row| Label::ALL.iter().map(|column| label(row, column)).collect());
        let drawn = fspid_plot::RuleTable {
            title: format!("Rules for {symbol}, {name}"),
            row_header: "error e".to_owned(),
            column_header: "change of error ec".to_owned(),
            labels: SEVEN.map(str::to_owned).to_vec(),
            cells: cells.collect(),
            shades: Vec::new(),
            marked: if marks == Marks::None { Vec::new() } else { marked(output, &odd, marks) },
        };
        let plain = symbol.replace("_{", "").replace('}', "");
        let caption =
            format!("{plain} of the {name} for each label of the error and of its change.");
        Figure::new(format!("{prefix}-{letter}"), drawn.render(), caption)
    };
    NAMES.into_iter().map(figure).collect()
}

/// The rules of a supervisor, labels or numbers; none for a network.
pub fn rules(prefix: &str, name: &str, supervisor: &Supervisor<f64>) -> Vec<Figure> {
    if let Some(table) = supervisor.table() {
        return rule_tables(prefix, name, &table, Marks::None);
    }
    let Some(table) = supervisor.numbers() else {
        return Vec::new();
    };
    let figure = |(output, letter, symbol): (Output, &str, &str)| {
        let grid = table.grid(output);
        let drawn = fspid_plot::RuleTable {
            title: format!("Rules for {symbol}, {name}"),
            row_header: "error e".to_owned(),
            column_header: "change of error ec".to_owned(),
            labels: SEVEN.map(str::to_owned).to_vec(),
            cells: grid
                .iter()
                .map(|row| row.iter().map(|n| number::significant(*n, 3)).collect())
                .collect(),
            shades: grid.iter().map(|row| row.map(|n| n / supervisor.range()).to_vec()).collect(),
            marked: Vec::new(),
        };
        let plain = symbol.replace("_{", "").replace('}', "");
        let caption = format!(
            "{plain} of {name} in supervisor units at the centres of the sets; interpolated in between (Takagi and \
             Sugeno)."
        );
        Figure::new(format!("{prefix}-{letter}"), drawn.render(), caption)
    };
    NAMES.into_iter().map(figure).collect()
}

/// What is marked in a rule table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marks {
    /// Nothing.
    None,
    /// Cells without their counterpart, and cells that the paper prints oddly.
    Paper,
}

fn marked(output: Output, odd: &[OddCell], _marks: Marks) -> Vec<Mark> {
    let reason = match output {
        Output::DeltaKp | Output::DeltaKi => "opposite cell lacks the opposite label",
        Output::DeltaKd => "opposite change has another label",
    };
    let mark = |(error, change): (Label, Label), reason: &str| Mark {
        row: error.index(),
        column: change.index(),
        reason: reason.to_owned(),
    };
    let of_output = odd.iter().filter(|cell| cell.output == output);
    let mut marks: Vec<Mark> = of_output.map(|cell| mark(cell.at, reason)).collect();
    if output == Output::DeltaKd {
        marks.extend(DOUBLE_SLASHES.map(|cell| mark(cell, "printed with a double slash (E7)")));
    }
    marks
}

/// One of the three increments.
fn component(delta: Increments<f64>, output: Output) -> f64 {
    match output {
        Output::DeltaKp => delta.kp,
        Output::DeltaKi => delta.ki,
        Output::DeltaKd => delta.kd,
    }
}

/// What the supervisor adds at each pair of inputs, a row for each error, as rule tables have it.
fn answers(supervisor: &Supervisor<f64>, axis: &[f64]) -> Vec<Vec<Option<Increments<f64>>>> {
    let row = |error: &f64| {
        let delta = |change: &f64| supervisor.infer(*error, *change).ok().map(|i| i.delta);
        axis.iter().map(delta).collect()
    };
    axis.iter().map(row).collect()
}

/// How fine a surface is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fineness {
    /// As in reports.
    Report,
    /// For a surface that turns under a hand: as much as is drawn in a moment, the centres of the sets among it.
    Moving,
}

impl Fineness {
    const fn nodes(self) -> u32 {
        match self {
            Self::Report => NODES,
            Self::Moving => 25,
        }
    }
}

/// A gain over the inputs of a supervisor, called `name`.
#[must_use]
pub fn surface_of(
    name: &str,
    supervisor: &Supervisor<f64>,
    output: Output,
    fineness: Fineness,
) -> Surface {
    let axis = nodes(supervisor.range(), fineness.nodes());
    surface(name, output, &axis, &answers(supervisor, &axis), supervisor.range())
}

fn surface(
    name: &str,
    output: Output,
    axis: &[f64],
    answers: &[Vec<Option<Increments<f64>>>],
    range: f64,
) -> Surface {
    let symbol = NAMES.iter().find(|it| it.0 == output).map_or("", |it| it.2);
    let value =
        |delta: &Option<Increments<f64>>| delta.map_or(f64::NAN, |delta| component(delta, output));
    Surface {
        title: format!("{symbol}, {name}"),
        x_label: "change of error ec".to_owned(),
        y_label: "error e".to_owned(),
        z_label: symbol.to_owned(),
        xs: axis.to_vec(),
        ys: axis.to_vec(),
        values: answers.iter().map(|row| row.iter().map(value).collect()).collect(),
        limit: Some(range),
    }
}

/// The three gain surfaces: maps, and views in space if asked for.
pub fn surfaces(
    prefix: &str,
    name: &str,
    supervisor: &Supervisor<f64>,
    kinds: &[SurfaceKind],
) -> Vec<Figure> {
    let (range, axis) = (supervisor.range(), nodes(supervisor.range(), NODES));
    let answers = answers(supervisor, &axis);
    let mut figures = Vec::new();
    for (output, letter, symbol) in NAMES {
        let surface = surface(name, output, &axis, &answers, range);
        let plain = symbol.replace("_{", "").replace('}', "");
        for kind in kinds {
            let (word, how) = match kind {
                SurfaceKind::Map => {
                    ("map", "lines of equal value: dashed where negative, thick at zero")
                }
                SurfaceKind::View => ("view", "the same, seen in space"),
                SurfaceKind::Relief => ("relief", "in space and as a map"),
            };
            let caption = format!("{plain} in supervisor units over both inputs; {how}.");
            figures.push(Figure::new(
                format!("{prefix}-{letter}-{word}"),
                surface.render(*kind),
                caption,
            ));
        }
    }
    figures
}

/// What a supervisor adds at rest: kp, ki, kd.
pub fn at_rest(supervisor: &Supervisor<f64>) -> Option<[f64; 3]> {
    let delta = supervisor.infer(0.0, 0.0).ok()?.delta;
    Some([delta.kp, delta.ki, delta.kd])
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_scenario::file::rule_table;

    #[test]
    fn the_mirrored_table_has_no_odd_cell_left_by_its_own_symmetry() {
        let printed = rule_table("printed").expect("shipped");
        let odd = odd_cells(&printed);
        let kp: Vec<_> = odd.iter().filter(|cell| cell.output == Output::DeltaKp).collect();
        // An odd cell and its opposite come together.
        assert!(!kp.is_empty() && kp.len() % 2 == 0, "{kp:?}");
        assert!(kp.iter().any(|cell| cell.at == (Label::NB, Label::PS)), "{kp:?}");
    }

    #[test]
    fn at_rest_the_printed_table_raises_kp_and_lowers_kd_in_proportion_to_its_range() {
        let printed = rule_table("printed").expect("shipped");
        let five = exact(&printed, 5.0).and_then(|s| at_rest(&s)).expect("an answer");
        let forty = exact(&printed, 40.0).and_then(|s| at_rest(&s)).expect("an answer");
        for (small, large) in five.into_iter().zip(forty) {
            assert!((8.0 * small - large).abs() < 1e-9);
        }
        assert!((five[0] - 0.2165).abs() < 1e-4 && (five[2] + 1.6666).abs() < 1e-4, "{five:?}");
    }
}
