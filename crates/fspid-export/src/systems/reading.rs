//! Numbers read off an outline, as `output/joined.rs` of `fspid-fuzzy`.

use fspid_fuzzy::system::Defuzzifier;

use super::library::{Library, called, least};
use super::outputs::{cell, repeat};
use super::polygon::{PIECE, Room, counted, is_less, real};
use super::put;
use crate::program::{
    Argument, Expression, Function, Kind, Operator, Parameter, Precision, Statement, element,
    local, number, whole,
};

/// As in `joined.rs`: areas that differ by this fraction count as halves of the same size, and grades as equally high.
const SLACK: f64 = 16.0 * f64::EPSILON;

/// A column of the piece at hand.
fn piece(column: i32) -> Expression {
    cell("pieces", local("piece"), PIECE, column)
}

fn set(name: &str, value: Expression) -> Statement {
    Statement::set(name, value)
}

/// For each piece there is.
fn each(room: Room, body: Vec<Statement>) -> Statement {
    let there_is = is_less(local("piece"), local("count"));
    repeat("piece", room.pieces, vec![Statement::when(there_is, body)])
}

/// An outline in `pieces`.
pub(super) struct Outline {
    pub(super) room: Room,
    /// The value that says how many pieces there are.
    pub(super) count: String,
    /// The middle of the universe.
    pub(super) middle: Expression,
    pub(super) precision: Precision,
}

impl Outline {
    /// Reads the number off it; answers which.
    pub(super) fn read(
        self,
        library: &mut Library,
        body: &mut Vec<Statement>,
        method: Defuzzifier,
    ) -> &'static str {
        let Self { room, count, middle, precision } = self;
        let (function, how) = match method {
            Defuzzifier::Bisector(_) => (bisector(room), "the bisector"),
            Defuzzifier::SmallestOfMaximum(_) => (maximum(room, 0), "the smallest of maximum"),
            Defuzzifier::MeanOfMaximum(_) => (maximum(room, 1), "the mean of maximum"),
            Defuzzifier::LargestOfMaximum(_) => (maximum(room, 2), "the largest of maximum"),
            _ => (centroid(room), "the centroid"),
        };
        let name = function.name;
        if !library.functions.iter().any(|known| known.name == name) {
            library.functions.push(function);
        }
        let top = || element("pieces", room.top());
        let least = number(least(precision)).at_most(top());
        let has_height = least.and(top().at_most(number(precision.largest())));
        let mut given = vec![Argument::Array("pieces".to_owned()), Argument::Value(local(&count))];
        if !matches!(method, Defuzzifier::Bisector(_)) {
            given.push(Argument::Value(middle));
        }
        given.push(Argument::Array("found".to_owned()));
        body.push(Statement::when(has_height, vec![Statement::Call(name, given)]));
        how
    }
}

fn parameters(room: Room) -> Vec<Parameter> {
    let found = Parameter { name: "found", kind: Kind::Reals(2), written: true };
    vec![room.parameter("pieces", false), counted("count"), real("middle"), found]
}

fn scale(room: Room) -> Statement {
    Statement::real("scaled", called("scale", [element("pieces", room.top())]))
}

/// Grades at both ends, scaled.
fn grades() -> [Statement; 3] {
    [
        Statement::real("begin", piece(2) * local("scaled")),
        Statement::real("ending", piece(3) * local("scaled")),
        Statement::real("width", piece(1) - piece(0)),
    ]
}

fn half_sum() -> Expression {
    number(0.5) * local("begin") + number(0.5) * local("ending")
}

fn found(value: Expression) -> Vec<Statement> {
    vec![put("found", 0, number(1.0)), put("found", 1, value)]
}

fn centroid(room: Room) -> Function {
    let off = |column| number(0.5) * (piece(column) - local("middle"));
    let tilt = local("width") * (local("ending") - local("begin")) / number(12.0);
    let mut one: Vec<Statement> = grades().into();
    one.extend([
        set("area", local("area") + local("width") * half_sum()),
        Statement::real("centre", off(0) + off(1)),
        Statement::real("tilt", tilt),
        set(
            "moment",
            local("moment") + local("width") * (local("centre") * half_sum() + local("tilt")),
        ),
    ]);
    Function {
        name: "read_centroid",
        doc: "Centre of gravity under the outline.",
        parts: &[],
        parameters: parameters(room),
        answers: None,
        body: vec![
            scale(room),
            Statement::real("area", number(0.0)),
            Statement::real("moment", number(0.0)),
            each(room, one),
            Statement::when(
                number(0.0).less(local("area")),
                found(local("middle") + local("moment") / local("area")),
            ),
        ],
    }
}

fn bisector(room: Room) -> Function {
    let mut one: Vec<Statement> = grades().into();
    one.push(set("area", local("area") + local("width") * half_sum()));
    let from = |turned| {
        let mut given = vec![Argument::Array("pieces".to_owned())];
        given.extend(["count", "scaled", "area"].map(|name| Argument::Value(local(name))));
        given.push(Argument::Value(number(turned)));
        Expression::Call("halfway", given)
    };
    let mut parameters = parameters(room);
    parameters.retain(|parameter| parameter.name != "middle");
    Function {
        name: "read_bisector",
        doc: "The point that halves the area under the outline, from the left and from the right.",
        parts: &[],
        parameters,
        answers: None,
        body: vec![
            scale(room),
            Statement::real("area", number(0.0)),
            each(room, one),
            Statement::when(
                number(0.0).less(local("area")),
                vec![
                    Statement::real("from_left", from(0.0)),
                    Statement::real("from_right", from(1.0)),
                    put("found", 0, number(1.0)),
                    put(
                        "found",
                        1,
                        number(0.5) * local("from_left") + number(0.5) * local("from_right"),
                    ),
                ],
            ),
        ],
    }
}

/// `reached` of `joined.rs`, from either side.
pub(super) fn halfway(room: Room) -> Function {
    let turned = || number(0.5).less(local("turned"));
    let from_right = {
        let less = Expression::binary(Operator::Multiply, local("walked"), whole(-1));
        let last = Expression::binary(Operator::Add, local("count"), whole(-1));
        Expression::binary(Operator::Add, last, less)
    };
    let column = |left, right| turned().select(piece(right), piece(left));
    let slack = || local("area") * number(SLACK);
    let one = vec![
        Statement::when(turned(), vec![set("piece", from_right)]),
        Statement::real("from", column(0, 1)),
        Statement::real("to", column(1, 0)),
        Statement::real("begin", column(2, 3) * local("scaled")),
        Statement::real("ending", column(3, 2) * local("scaled")),
        Statement::real("width", local("to") - local("from")),
        Statement::real("own", (local("width") * half_sum()).magnitude()),
        // The end of the piece, unless the half is reached before it.
        set("place", local("to")),
        set("reached", (local("left") - slack()).at_most(local("own"))),
        Statement::when((local("left") + slack()).less(local("own")), distance()),
        set("left", local("left") - local("own")),
    ];
    let open = is_less(local("walked"), local("count")).and(local("reached").negated());
    let walk = vec![
        Statement::Let("piece".into(), Kind::Whole, local("walked")),
        Statement::when(open, one),
    ];
    let mut parameters = vec![room.parameter("pieces", false), counted("count")];
    parameters.extend(["scaled", "area", "turned"].map(real));
    Function {
        name: "halfway",
        doc: "Where half of the area under the outline is reached, from the left, or turned from the right.",
        parts: &[],
        parameters,
        answers: Some(Kind::Real),
        body: vec![
            Statement::real("left", number(0.5) * local("area")),
            Statement::real("place", number(0.0)),
            Statement::Let("reached".into(), Kind::Truth, Expression::Truth(false)),
            repeat("walked", room.pieces, walk),
            Statement::Return(Some(local("place"))),
        ],
    }
}

/// Within the piece: after $d = 2a / (y_0 + \sqrt{y_0^2 + 2 k a})$.
fn distance() -> Vec<Statement> {
    let (begin, end) = (|| local("begin"), || local("ending"));
    let root = begin() * begin() + number(2.0) * local("slope") * local("left");
    vec![
        Statement::real("slope", (end() - begin()) / local("width").magnitude()),
        Statement::real("under", root),
        set("under", local("under").larger(number(0.0))),
        Statement::real(
            "along",
            number(2.0) * local("left") / (begin() + called("square_root", [local("under")])),
        ),
        Statement::If(
            local("from").less(local("to")),
            vec![
                set("place", local("from") + local("along")),
                set("place", local("place").smaller(local("to"))),
            ],
            vec![
                set("place", local("from") - local("along")),
                set("place", local("place").larger(local("to"))),
            ],
        ),
    ]
}

/// `AggregatedSet::maximum`: the smallest, the mean or the largest of the points of highest grade.
fn maximum(room: Room, which: usize) -> Function {
    let is_top = |grade: Expression| local("least_top").at_most(grade);
    let point = |x: i32, grade: i32| {
        let anew = local("any").negated().or(local("last").less(piece(x)));
        let count = vec![
            set("points", local("points") + number(1.0)),
            set("sum", local("sum") + (piece(x) - local("middle"))),
        ];
        Statement::when(
            is_top(piece(grade)),
            vec![
                Statement::when(anew, count),
                Statement::when(local("any").negated(), vec![set("first", piece(x))]),
                set("last", piece(x)),
                set("any", Expression::Truth(true)),
            ],
        )
    };
    let off = |column| number(0.5) * (piece(column) - local("middle"));
    let flat = vec![
        Statement::real("width", piece(1) - piece(0)),
        set("length", local("length") + local("width")),
        Statement::real("centre", off(0) + off(1)),
        set("moment", local("moment") + local("width") * local("centre")),
    ];
    let one = vec![
        point(0, 2),
        point(1, 3),
        Statement::when(is_top(piece(2)).and(is_top(piece(3))), flat),
    ];
    let mut body =
        vec![Statement::real("least_top", element("pieces", room.top()) * number(1.0 - SLACK))];
    let zeros = ["first", "last", "length", "moment", "points", "sum"];
    body.extend(zeros.map(|name| Statement::real(name, number(0.0))));
    body.push(Statement::Let("any".into(), Kind::Truth, Expression::Truth(false)));
    body.push(each(room, one));
    let (name, value) = match which {
        0 => ("read_smallest", local("first")),
        2 => ("read_largest", local("last")),
        _ => ("read_mean", local("mean")),
    };
    let by_length = number(0.0).less(local("length"));
    body.push(Statement::real(
        "mean",
        by_length.select(local("moment") / local("length"), local("sum") / local("points")),
    ));
    body.push(set("mean", local("middle") + local("mean")));
    body.push(set("mean", super::firing::clamped(local("mean"), local("first"), local("last"))));
    body.push(Statement::when(local("any"), found(value)));
    Function {
        name,
        doc: "A point of highest grade: the smallest, the mean by length or number, or the largest.",
        parts: &[],
        parameters: parameters(room),
        answers: None,
        body,
    }
}
