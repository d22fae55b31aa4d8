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
        let Way::Polygon { join, cells, scales, middle } = way else {
            return Err(super::outputs::VERTICES);
        };
        let actors = self.terms_of_actors(index);
        let none = u8::try_from(actors.len()).map_err(|_| {
            Trouble::Said(
                "more than 255 conclusions differ by more than their strength",
                "possible is maximum as aggregation",
            )
        })?;
        let (room, name) = (self.room, self.names.outputs[index].clone());
        self.body.push(Statement::set_element("levels", whole(i32::from(none)), number(0.0)));
        let (mut owners, mut grades, mut scaled) = (Vec::new(), Vec::new(), Vec::new());
        for one in cells {
            let mut slots = slots(one, &actors);
            slots.resize(room.lines, (usize::from(none), [0.0; 2]));
            owners.extend(slots.iter().map(|(actor, _)| u8::try_from(*actor).unwrap_or(none)));
            grades.extend(slots.iter().flat_map(|(_, grade)| *grade));
            scaled.extend(slots.iter().map(|(actor, _)| scales.get(*actor) == Some(&true)));
        }
        let mut corners: Vec<f64> = cells.iter().map(|it| it.x[0]).collect();
        corners.extend(cells.last().map(|it| it.x[1]));
        let mut table = |what: &str, doc: &str, value| {
            let called = self.member(&format!("{what} {index}"), &format!("{name}_{what}"));
            self.configuration.add(&called, doc, value);
            called
        };
        let corners =
            table("corners", "Where the sets of the output have corners.", Value::Reals(corners));
        let owners = table(
            "owners",
            "Whose a line between two corners is, corner by corner; one more than there are is nobody's.",
            Value::Bytes(owners),
        );
        let lines = table("lines", "Grades of these lines at both corners.", Value::Reals(grades));
        let is_scaled = match (scaled.contains(&true), scaled.contains(&false)) {
            // Slots that are nobody's never fire.
            (true, _) if scales.iter().all(|&it| it) => number(1.0),
            (true, true) => {
                let bytes = scaled.iter().map(|&it| u8::from(it)).collect();
                let called = table(
                    "scaled",
                    "1 where product scales a line, 0 where minimum cuts it.",
                    Value::Bytes(bytes),
                );
                Expression::ToReal(Box::new(member_element(
                    Part::Configuration,
                    &called,
                    local("line"),
                )))
            }
            _ => number(0.0),
        };
        let read = |member: &str, index| member_element(Part::Configuration, member, index);
        let level = element("levels", read(&owners, local("line")));
        let owner = Expression::ToReal(Box::new(read(&owners, local("line"))));
        let mut given = values(["from", "to"]);
        given.extend([
            Argument::Value(read(&lines, flat(local("line"), 2, 0))),
            Argument::Value(read(&lines, flat(local("line"), 2, 1))),
            Argument::Value(local("level")),
            Argument::Value(is_scaled),
            Argument::Value(owner),
            array("active"),
            Argument::Value(local("firing")),
        ]);
        let slot = vec![
            Statement::Let("line".into(), Kind::Whole, {
                let first =
                    Expression::binary(Operator::Multiply, local("cell"), whole(room.lines()));
                Expression::binary(Operator::Add, first, local("slot"))
            }),
            Statement::real("level", level),
            Statement::when(
                number(0.0).less(local("level")),
                vec![Statement::Call("add_line", given), set("firing", plus("firing", 1))],
            ),
        ];
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
            Statement::real("from", read(&corners, local("cell"))),
            Statement::real("to", read(&corners, plus("cell", 1))),
            Statement::Let("firing".into(), Kind::Whole, whole(0)),
            repeat("slot", room.lines, slot),
            set(&count, Expression::Call(joined, given)),
        ];
        self.body.push(Statement::Let(count.clone(), Kind::Whole, whole(0)));
        self.body.push(Statement::set_element("pieces", room.top(), number(0.0)));
        self.body.push(repeat("cell", cells.len(), body));
        let peaks = self.member(&format!("middle {index}"), &format!("{name}_middle"));
        let middle = self.configuration.real(
            &peaks,
            "Middle of the range, about which moments are taken.",
            *middle,
        );
        let how = reading::read(
            &mut self.library,
            &mut self.body,
            output.defuzzifier,
            room,
            &count,
            middle,
            precision_of::<R>(),
        );
        Ok(format!("{how} of a polygon, in closed form, for all its sets are straight-sided"))
    }
}
