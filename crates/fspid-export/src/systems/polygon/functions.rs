//! The functions that walk over a cell: lines that fire, edges between cuts, pieces of the outline.

use super::super::outputs::{cell, flat, plus, repeat};
use super::{ACTIVE, EDGE, PIECE, Room, array, counted, equal, is_less, real, set, values};
use crate::program::{
    Argument, Expression, Function, Kind, Parameter, Statement, element, local, number, whole,
};

/// Whose a sum of several is.
const NOBODY: f64 = -1.0;

/// Where a line has a grade between those at its ends.
pub(super) fn place_between() -> Function {
    let width = || local("to") - local("from");
    let (begin, end, grade) = (|| local("begin"), || local("ending"), || local("grade"));
    let rising = local("from") + width() * ((grade() - begin()) / (end() - begin()));
    let falling = local("to") - width() * ((grade() - end()) / (begin() - end()));
    Function {
        name: "place_between",
        doc: "Where a line has a grade between those at its ends; counted from its lower end, so that small grades keep \
              their digits.",
        parts: &[],
        parameters: ["from", "to", "begin", "ending", "grade"].map(real).into(),
        answers: Some(Kind::Real),
        body: vec![
            Statement::real("place", number(0.0)),
            Statement::If(
                begin().less(end()),
                vec![set("place", rising), set("place", local("place").smaller(local("to")))],
                vec![set("place", falling), set("place", local("place").larger(local("from")))],
            ),
            Statement::Return(Some(local("place"))),
        ],
    }
}

fn placed(grade: Expression) -> Expression {
    let mut given = values(["from", "to", "begin", "ending"]);
    given.push(Argument::Value(grade));
    Expression::Call("place_between", given)
}

/// Adds a line that fires to `active`: `Active::new`.
pub(super) fn line_that_fires(room: Room, never: f64) -> Function {
    let row = |column, value| {
        Statement::set_element("active", flat(local("slot"), ACTIVE, column), value)
    };
    let above = |grade: &str| local("strength").less(local(grade));
    let mut parameters: Vec<Parameter> =
        ["from", "to", "begin", "ending", "strength", "scaled", "owner"].map(real).into();
    parameters.extend([room.parameter("active", true), counted("slot")]);
    let scale = |grade: &str| local(grade) * local("strength");
    Function {
        name: "add_line",
        doc: "Adds a line that fires: product scales it, minimum cuts it where it is above the strength.",
        parts: &[],
        parameters,
        answers: None,
        body: vec![
            row(3, number(never)),
            row(4, number(never)),
            row(5, local("owner")),
            Statement::when(
                number(0.5).less(local("scaled")),
                vec![
                    row(0, scale("begin")),
                    row(1, scale("ending")),
                    row(2, number(never)),
                    Statement::Return(None),
                ],
            ),
            row(0, local("begin")),
            row(1, local("ending")),
            row(2, local("strength")),
            Statement::If(
                above("begin"),
                vec![
                    row(3, local("from")),
                    Statement::If(
                        above("ending"),
                        vec![row(4, local("to"))],
                        vec![row(4, placed(local("strength")))],
                    ),
                ],
                vec![Statement::when(
                    above("ending"),
                    vec![row(3, placed(local("strength"))), row(4, local("to"))],
                )],
            ),
        ],
    }
}

/// The grade of a line at a place where it is not cut, or just so: `Active::at`.
pub(super) fn grade_at() -> Function {
    let (x, strength) = (|| local("x"), || local("strength"));
    let answer = |condition, value: Expression| {
        Statement::when(condition, vec![Statement::Return(Some(value))])
    };
    let sum = local("begin") * (local("to") - x()) + local("ending") * (x() - local("from"));
    let is_cut = equal(x(), local("cut_from")).or(equal(x(), local("cut_to")));
    Function {
        name: "grade_at",
        doc: "Grade of a line at a place where it is not cut, or just so.",
        parts: &[],
        parameters: ["x", "from", "to", "begin", "ending", "strength", "cut_from", "cut_to"]
            .map(real)
            .into(),
        answers: Some(Kind::Real),
        body: vec![
            answer(equal(x(), local("from")), local("begin").smaller(strength())),
            answer(equal(x(), local("to")), local("ending").smaller(strength())),
            answer(is_cut, strength()),
            Statement::real("grade", sum / (local("to") - local("from"))),
            Statement::Return(Some(local("grade").smaller(strength()))),
        ],
    }
}

/// Appends a piece, or prolongs the last one: `AggregatedSet::push`. Answers how many there are.
pub(super) fn add_piece(room: Room) -> Function {
    let mut parameters: Vec<Parameter> =
        ["left", "right", "begin", "ending", "owner", "cut"].map(real).into();
    parameters.extend([room.parameter("pieces", true), counted("count"), counted("first")]);
    let last = |column| cell("pieces", plus("count", -1), PIECE, column);
    let put = |row: Expression, column, value| {
        Statement::set_element("pieces", flat(row, PIECE, column), value)
    };
    let meets = equal(last(1), local("left")).and(equal(last(3), local("begin")));
    let same = equal(last(4), local("owner")).and(equal(last(5), local("cut")));
    let straight = is_less(local("first"), local("count")).or(number(0.5).less(local("cut")));
    let continues = meets.and(same).and(number(-0.5).less(local("owner"))).and(straight);
    let columns = ["left", "right", "begin", "ending", "owner", "cut"];
    let mut append: Vec<Statement> = columns
        .into_iter()
        .zip(0..)
        .map(|(name, column)| put(local("count"), column, local(name)))
        .collect();
    append.push(Statement::Return(Some(plus("count", 1))));
    let top = || element("pieces", room.top());
    let mut body = vec![
        Statement::real("higher", local("begin").larger(local("ending"))),
        Statement::when(
            local("left")
                .less(local("right"))
                .negated()
                .or(number(0.0).less(local("higher")).negated()),
            vec![Statement::Return(Some(local("count")))],
        ),
        Statement::when(
            top().less(local("higher")),
            vec![Statement::set_element("pieces", room.top(), local("higher"))],
        ),
        Statement::when(
            is_less(whole(0), local("count")),
            vec![Statement::when(
                continues,
                vec![
                    put(plus("count", -1), 1, local("right")),
                    put(plus("count", -1), 3, local("ending")),
                    Statement::Return(Some(local("count"))),
                ],
            )],
        ),
    ];
    body.extend(append);
    Function {
        name: "add_piece",
        doc: "Appends a straight piece of the outline, or prolongs the last one where it goes straight on.",
        parts: &[],
        parameters,
        answers: Some(Kind::Whole),
        body,
    }
}

/// What the functions that join edges are given.
fn joining(room: Room) -> Vec<Parameter> {
    let mut parameters = vec![real("from"), real("to"), counted("firing")];
    parameters.push(room.parameter("edges", false));
    parameters.extend([room.parameter("pieces", true), counted("count"), counted("first")]);
    parameters
}

fn edge(row: &str, column: i32) -> Expression {
    cell("edges", local(row), EDGE, column)
}

fn pushed(
    left: Expression,
    right: Expression,
    grades: [Expression; 2],
    row: [Expression; 2],
) -> Expression {
    let [begin, end] = grades;
    let [owner, cut] = row;
    let mut given: Vec<Argument> =
        [left, right, begin, end, owner, cut].into_iter().map(Argument::Value).collect();
    given.push(array("pieces"));
    given.extend(values(["joined", "first"]));
    Expression::Call("add_piece", given)
}

/// Whether the edge in `slot` is the first to cross the current one from below: `next_crossing`.
fn look() -> Vec<Statement> {
    let (this, now) = (|column| edge("slot", column), |column| edge("current", column));
    let share = local("below") / (local("below") + local("above"));
    let earlier = local("t").less(local("soonest"));
    let steeper = local("t").at_most(local("soonest")).and(edge("next", 1).less(this(1)));
    let sooner = local("crosses").negated().or(earlier).or(steeper);
    vec![
        Statement::real("above", this(1) - now(1)),
        Statement::when(
            number(0.0).less(local("above")),
            vec![
                Statement::real("below", now(0) - this(0)),
                set("below", local("below").larger(number(0.0))),
                Statement::real("t", share),
                Statement::when(
                    sooner,
                    vec![
                        set("soonest", local("t")),
                        set("next", local("slot")),
                        set("crosses", Expression::Truth(true)),
                    ],
                ),
            ],
        ),
    ]
}

/// The upper envelope of edges: start on the highest and change to whichever crosses first.
pub(super) fn highest(room: Room) -> Function {
    let (this, now) = (|column| edge("slot", column), |column| edge("current", column));
    let higher = now(0).less(this(0)).or(now(0).at_most(this(0)).and(now(1).less(this(1))));
    let along = |t: &str| {
        let inside = local("from") + (local("to") - local("from")) * local(t);
        local(t).less(number(1.0)).select(inside, local("to"))
    };
    let leaving = now(0) * (number(1.0) - local("stop")) + now(1) * local("stop");
    let turn = vec![
        set("crosses", Expression::Truth(false)),
        set("next", local("current")),
        set("soonest", number(1.0)),
        firing(room, look()),
        set("stop", local("crosses").select(local("soonest").larger(local("start")), number(1.0))),
        set("grade_there", leaving),
        set(
            "joined",
            pushed(
                along("start"),
                along("stop"),
                [local("grade_here"), local("grade_there")],
                [now(2), now(3)],
            ),
        ),
        set("current", local("next")),
        set("start", local("stop")),
        set("grade_here", local("grade_there")),
    ];
    // Where none crosses, the last one has been followed to the end.
    let turn = vec![Statement::when(local("crosses"), turn)];
    let whole_of = |name: &str, value| Statement::Let(name.to_owned(), Kind::Whole, value);
    Function {
        name: "add_highest",
        doc: "The upper envelope of lines: start on the highest and change to whichever crosses first.",
        parts: &[],
        parameters: joining(room),
        answers: Some(Kind::Whole),
        body: vec![
            whole_of("joined", local("count")),
            whole_of("current", whole(0)),
            firing(room, vec![Statement::when(higher, vec![set("current", local("slot"))])]),
            Statement::real("start", number(0.0)),
            Statement::real("stop", number(1.0)),
            Statement::real("grade_here", now(0)),
            Statement::real("grade_there", now(0)),
            Statement::real("soonest", number(1.0)),
            whole_of("next", local("current")),
            Statement::Let("crosses".into(), Kind::Truth, Expression::Truth(true)),
            repeat("turn", room.lines, turn),
            Statement::Return(Some(local("joined"))),
        ],
    }
}

/// The sum of edges, cut off at 1 if it is bounded.
pub(super) fn summed(room: Room, bounded: bool) -> Function {
    let one = || number(1.0);
    let mut body = vec![
        Statement::Let("joined".into(), Kind::Whole, local("count")),
        Statement::real("begin", number(0.0)),
        Statement::real("ending", number(0.0)),
        repeat(
            "slot",
            room.lines,
            vec![Statement::when(
                is_less(local("slot"), local("firing")),
                vec![
                    set("begin", local("begin") + edge("slot", 0)),
                    set("ending", local("ending") + edge("slot", 1)),
                ],
            )],
        ),
        Statement::real("owner", number(NOBODY)),
        Statement::real("cut", number(0.0)),
        Statement::when(
            equal(local("firing"), whole(1)),
            vec![set("owner", element("edges", whole(2))), set("cut", element("edges", whole(3)))],
        ),
    ];
    let whose = || [local("owner"), local("cut")];
    if bounded {
        let ends = || [local("begin"), local("ending")];
        let [below, above] =
            [ends().map(|grade| grade.less(one())), ends().map(|grade| one().less(grade))]
                .map(|[begin, end]| begin.or(end));
        let [begin, end] = ends().map(|grade| grade.smaller(one()));
        let halves = vec![
            Statement::real("middle", placed(one())),
            set("joined", pushed(local("from"), local("middle"), [begin.clone(), one()], whose())),
            set("joined", pushed(local("middle"), local("to"), [one(), end.clone()], whose())),
        ];
        let whole_line = set("joined", pushed(local("from"), local("to"), [begin, end], whose()));
        body.push(Statement::If(below.and(above), halves, vec![whole_line]));
    } else {
        let grades = [local("begin"), local("ending")];
        body.push(set("joined", pushed(local("from"), local("to"), grades, whose())));
    }
    body.push(Statement::Return(Some(local("joined"))));
    Function {
        name: if bounded { "add_bounded_sum" } else { "add_sum" },
        doc: if bounded { "The sum of lines, at most 1." } else { "The sum of lines." },
        parts: &[],
        parameters: joining(room),
        answers: Some(Kind::Whole),
        body,
    }
}

/// For each line that fires.
fn firing(room: Room, inside: Vec<Statement>) -> Statement {
    let fires = is_less(local("slot"), local("firing"));
    repeat("slot", room.lines, vec![Statement::when(fires, inside)])
}

fn active(column: i32) -> Expression {
    cell("active", local("slot"), ACTIVE, column)
}

/// What lies between one cut and the next.
fn stretch(join: &'static str, room: Room) -> Vec<Statement> {
    let put =
        |column, value| Statement::set_element("edges", flat(local("slot"), EDGE, column), value);
    let at = |x: &str| {
        let mut given = values([x, "from", "to"]);
        given.extend((0..5).map(|column| Argument::Value(active(column))));
        Expression::Call("grade_at", given)
    };
    let is_cut = active(3).at_most(local("left")).and(local("right").at_most(active(4)));
    let edge = vec![
        put(2, active(5)),
        Statement::If(
            is_cut,
            vec![put(0, active(2)), put(1, active(2)), put(3, number(1.0))],
            vec![put(0, at("left")), put(1, at("right")), put(3, number(0.0))],
        ),
    ];
    let mut given = values(["left", "right", "firing"]);
    given.extend([array("edges"), array("pieces")]);
    given.extend(values(["joined", "count"]));
    vec![
        Statement::real("right", element("cuts", local("cut"))),
        Statement::when(
            local("left").less(local("right")),
            vec![
                firing(room, edge),
                set("joined", Expression::Call(join, given)),
                set("left", local("right")),
            ],
        ),
    ]
}

/// Joins what fires in a cell, between one cut and the next: `Outline::join_cell`.
pub(super) fn join_cell(name: &'static str, join: &'static str, room: Room) -> Function {
    let lines = room.lines();
    let inside = |place: Expression| local("from").less(place.clone()).and(place.less(local("to")));
    let cut = |column| {
        let place = Statement::set_element("cuts", local("slot"), active(column));
        Statement::when(inside(active(column)), vec![place])
    };
    let (this, next) = (element("cuts", local("cut")), element("cuts", plus("cut", 1)));
    let swap = vec![
        Statement::real("larger", this.clone()),
        Statement::set_element("cuts", local("cut"), next.clone()),
        Statement::set_element("cuts", plus("cut", 1), local("larger")),
    ];
    let mut body = vec![
        Statement::Let("joined".into(), Kind::Whole, local("count")),
        Statement::when(
            equal(local("firing"), whole(0)),
            vec![Statement::Return(Some(local("joined")))],
        ),
        repeat(
            "slot",
            room.lines + 1,
            vec![Statement::set_element("cuts", local("slot"), local("to"))],
        ),
        firing(room, vec![cut(3), cut(4)]),
    ];
    if lines > 1 {
        let pass =
            Statement::repeat("cut", lines - 1, vec![Statement::when(next.less(this), swap)]);
        body.push(Statement::Remark("Cuts from left to right.".into()));
        body.push(Statement::repeat("turn", lines - 1, vec![pass]));
    }
    body.extend([
        Statement::real("left", local("from")),
        repeat("cut", room.lines + 1, stretch(join, room)),
        Statement::Return(Some(local("joined"))),
    ]);
    let mut parameters = vec![real("from"), real("to"), counted("firing")];
    parameters.push(room.parameter("active", false));
    parameters.extend(["edges", "cuts", "pieces"].map(|name| room.parameter(name, true)));
    parameters.push(counted("count"));
    Function {
        name,
        doc: "Joins what fires between two corners: between the cuts every line is straight.",
        parts: &[],
        parameters,
        answers: Some(Kind::Whole),
        body,
    }
}
