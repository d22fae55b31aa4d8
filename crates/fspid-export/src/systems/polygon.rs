//! The outline of cut or scaled sets with straight sides, as `output/outline` of `fspid-fuzzy`.
//!
//! Tables that lie flat in arrays: `active` has the lines of a cell that fire, `edges` these between two cuts, `pieces`
//! the outline so far, with the highest grade behind its last row.

mod functions;

use fspid_fuzzy::system::{Cell, Join, Output, Way};
use fspid_numeric::Real;

use super::outputs::{flat, plus, repeat};
use super::{Composer, Trouble, count_of, reading};
use crate::compose::precision_of;
use crate::program::{
    Argument, Expression, Kind, Operator, Parameter, Part, Statement, Value, element, local,
    member_element, number, whole,
};
use functions::{add_piece, grade_at, highest, join_cell, line_that_fires, place_between, summed};

/// Columns of `active`: grades at the ends of the cell, strength, from where to where it cuts, whose it is.
const ACTIVE: i32 = 6;
/// Columns of `edges`: grades at both ends, whose it is, 1 where it is cut.
const EDGE: i32 = 4;
/// Columns of `pieces`: both ends, grades there, whose it is, 1 where it is cut.
pub(super) const PIECE: i32 = 6;

/// How much room outlines need.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Room {
    /// Lines that may fire in a cell.
    pub(super) lines: usize,
    /// Pieces of an outline.
    pub(super) pieces: usize,
}

impl Room {
    pub(super) fn lines(self) -> i32 {
        count_of(self.lines)
    }

    fn arrays(self) -> [(&'static str, usize); 4] {
        let [active, edge, piece] = [ACTIVE, EDGE, PIECE].map(|width| width as usize);
        [
            ("active", active * self.lines),
            ("edges", edge * self.lines),
            ("cuts", self.lines + 1),
            ("pieces", piece * self.pieces + 1),
        ]
    }

    /// The place of the highest grade.
    pub(super) fn top(self) -> Expression {
        whole(PIECE * count_of(self.pieces))
    }

    pub(super) fn parameter(self, name: &'static str, written: bool) -> Parameter {
        let count = self.arrays().into_iter().find(|(array, _)| *array == name);
        Parameter { name, kind: Kind::Reals(count.map_or(0, |(_, count)| count)), written }
    }
}

pub(super) fn real(name: &'static str) -> Parameter {
    Parameter { name, kind: Kind::Real, written: false }
}

pub(super) fn counted(name: &'static str) -> Parameter {
    Parameter { name, kind: Kind::Whole, written: false }
}

/// Wholes compare as reals do.
pub(super) fn is_less(left: Expression, right: Expression) -> Expression {
    left.less(right)
}

pub(super) fn equal(left: Expression, right: Expression) -> Expression {
    Expression::binary(Operator::Equal, left, right)
}

fn set(name: &str, value: Expression) -> Statement {
    Statement::set(name, value)
}

fn array(name: &str) -> Argument {
    Argument::Array(name.to_owned())
}

fn values<const N: usize>(names: [&str; N]) -> Vec<Argument> {
    names.into_iter().map(|name| Argument::Value(local(name))).collect()
}

/// The slots of a cell: actor and line, term by term.
fn slots(one: &Cell, actors: &[usize]) -> Vec<(usize, [f64; 2])> {
    let about = |term| (0..actors.len()).filter(move |&actor| actors[actor] == term);
    one.lines.iter().flat_map(|line| about(line.term).map(|actor| (actor, line.grade))).collect()
}

impl<R: Real> Composer<'_, R> {
    fn terms_of_actors(&self, output: usize) -> Vec<usize> {
        self.system.actors(output).iter().map(|actor| actor.term).collect()
    }

    /// Declares what outlines need, if any output has one, and adds the functions that walk over them.
    pub(super) fn polygons(&mut self) {
        let mut room = Room::default();
        let mut joins = Vec::new();
        for (index, output) in self.system.parts().outputs.iter().enumerate() {
            let way = self.system.way(index).filter(|_| output.enabled);
            if let Some(Way::Sampled(_)) = way {
                room.pieces = room.pieces.max(super::sampled::pieces(output.defuzzifier));
            }
            let Some(Way::Polygon { cells, join, .. }) = way else { continue };
            let actors = self.terms_of_actors(index);
            let counts: Vec<usize> = cells.iter().map(|it| slots(it, &actors).len()).collect();
            room.lines = room.lines.max(counts.iter().copied().max().unwrap_or(0)).max(1);
            // Between neighbouring cuts, of which each line has at most one, each line is on top at most once.
            room.pieces = room.pieces.max(counts.iter().map(|m| m * (m + 1)).sum()).max(1);
            joins.push(join);
        }
        self.room = room;
        if room.pieces == 0 {
            return;
        }
        // What is not read in the end is removed again.
        let declare = |(name, count): (&str, usize)| Statement::Array(name.to_owned(), count);
        self.body.extend(room.arrays().into_iter().filter(|(_, count)| *count > 0).map(declare));
        self.library.square_root::<R>();
        self.library.functions.push(reading::halfway(room));
        let largest = precision_of::<R>().largest();
        let functions = &mut self.library.functions;
        functions.extend([place_between(), line_that_fires(room, largest), grade_at()]);
        functions.push(add_piece(room));
        if joins.contains(&Join::Maximum) {
            functions.push(highest(room));
            functions.push(join_cell("join_highest", "add_highest", room));
        }
        if joins.contains(&Join::Sum) {
            functions.push(summed(room, false));
            functions.push(join_cell("join_sum", "add_sum", room));
        }
        if joins.contains(&Join::BoundedSum) {
            functions.push(summed(room, true));
            functions.push(join_cell("join_bounded_sum", "add_bounded_sum", room));
        }
        self.scale_function();
    }

    /// Walks over the cells of an output and reads its number off the outline.
    pub(super) fn polygon(
        &mut self,
        index: usize,
        output: &Output,
        way: &Way,
    ) -> Result<String, Trouble> {
        let Way::Polygon { join, cells, middle, .. } = way else {
            return Err(super::outputs::VERTICES);
        };
        let tables = self.tables(index, way)?;
        let room = self.room;
        let joined = match join {
            Join::Maximum => "join_highest",
            Join::Sum => "join_sum",
            Join::BoundedSum => "join_bounded_sum",
        };
        let count = format!("pieces_{index}");
        let mut given = values(["from", "to", "firing"]);
        given.extend(["active", "edges", "cuts", "pieces"].map(array));
        given.push(Argument::Value(local(&count)));
        let body = vec![
            Statement::real("from", read(&tables.corners, local("cell"))),
            Statement::real("to", read(&tables.corners, plus("cell", 1))),
            Statement::Let("firing".into(), Kind::Whole, whole(0)),
            repeat("slot", room.lines, tables.slot(room)),
            set(&count, Expression::Call(joined, given)),
        ];
        self.body.push(Statement::Let(count.clone(), Kind::Whole, whole(0)));
        self.body.push(Statement::set_element("pieces", room.top(), number(0.0)));
        self.body.push(repeat("cell", cells.len(), body));
        let name = format!("{}_middle", self.names.outputs[index]);
        let called = self.member(&format!("middle {index}"), &name);
        let doc = "Middle of the range, about which moments are taken.";
        let middle = self.configuration.real(&called, doc, *middle);
        let outline = reading::Outline { room, count, middle, precision: precision_of::<R>() };
        let how = outline.read(&mut self.library, &mut self.body, output.defuzzifier);
        Ok(format!("{how} of a polygon, in closed form, for all its sets are straight-sided"))
    }

    /// Corners and lines of an output as members of the configuration.
    fn tables(&mut self, index: usize, way: &Way) -> Result<Tables, Trouble> {
        let Way::Polygon { cells, scales, .. } = way else { return Err(super::outputs::VERTICES) };
        let actors = self.terms_of_actors(index);
        let none = u8::try_from(actors.len()).map_err(|_| TOO_MANY)?;
        self.body.push(Statement::set_element("levels", whole(i32::from(none)), number(0.0)));
        let mut all = Vec::new();
        for one in cells {
            let mut slots = slots(one, &actors);
            slots.resize(self.room.lines, (usize::from(none), [0.0; 2]));
            all.extend(slots);
        }
        let mut corners: Vec<f64> = cells.iter().map(|it| it.x[0]).collect();
        corners.extend(cells.last().map(|it| it.x[1]));
        let owners = all.iter().map(|(actor, _)| u8::try_from(*actor).unwrap_or(none)).collect();
        let grades = all.iter().flat_map(|(_, grade)| *grade).collect();
        let scaled: Vec<u8> =
            all.iter().map(|(actor, _)| u8::from(scales.get(*actor) == Some(&true))).collect();
        let corners =
            self.table(index, "corners", "Where its sets have corners.", Value::Reals(corners));
        let owners = self.table(
            index,
            "owners",
            "Whose a line between two corners is, corner by corner; one more than there are is nobody's.",
            Value::Bytes(owners),
        );
        let lines = self.table(
            index,
            "lines",
            "Grades of these lines at both corners.",
            Value::Reals(grades),
        );
        // Slots that are nobody's never fire.
        let scaled = match (scales.contains(&true), scales.contains(&false)) {
            (true, true) => {
                let doc = "1 where product scales a line, 0 where minimum cuts it.";
                let called = self.table(index, "scaled", doc, Value::Bytes(scaled));
                Expression::ToReal(Box::new(read(&called, local("line"))))
            }
            (all_are, _) => number(f64::from(u8::from(all_are))),
        };
        Ok(Tables { corners, owners, lines, scaled })
    }

    fn table(&mut self, index: usize, what: &str, doc: &str, value: Value) -> String {
        let name = format!("{}_{what}", self.names.outputs[index]);
        let called = self.member(&format!("{what} {index}"), &name);
        self.configuration.add(&called, doc, value);
        called
    }
}

const TOO_MANY: Trouble = Trouble::Said(
    "more than 255 conclusions differ by more than their strength",
    "possible is maximum as aggregation",
);

/// Members of the configuration that hold an output's cells.
struct Tables {
    corners: String,
    owners: String,
    lines: String,
    /// 1 where product scales the line at hand.
    scaled: Expression,
}

fn read(member: &str, index: Expression) -> Expression {
    member_element(Part::Configuration, member, index)
}

impl Tables {
    /// A slot of the cell at hand: its line is added where it fires.
    fn slot(&self, room: Room) -> Vec<Statement> {
        let line = || local("line");
        let owner = read(&self.owners, line());
        let mut given = values(["from", "to"]);
        given.extend(
            [
                read(&self.lines, flat(line(), 2, 0)),
                read(&self.lines, flat(line(), 2, 1)),
                local("level"),
                self.scaled.clone(),
                Expression::ToReal(Box::new(owner.clone())),
            ]
            .map(Argument::Value),
        );
        given.extend([array("active"), Argument::Value(local("firing"))]);
        let first = Expression::binary(Operator::Multiply, local("cell"), whole(room.lines()));
        let add = vec![Statement::Call("add_line", given), set("firing", plus("firing", 1))];
        vec![
            Statement::Let(
                "line".into(),
                Kind::Whole,
                Expression::binary(Operator::Add, first, local("slot")),
            ),
            Statement::real("level", element("levels", owner)),
            Statement::when(number(0.0).less(local("level")), add),
        ]
    }
}
