//! The square root, rounded correctly by sums and products alone: the bits that IEEE 754 asks of every machine.

use crate::program::{Expression, Function, Kind, Parameter, Precision, Statement, local, number};

/// Halvings of exponents: powers of two that bring any normal number near 1.
fn powers(precision: Precision) -> Vec<i32> {
    let first = match precision {
        Precision::Single => 64,
        Precision::Double => 512,
    };
    std::iter::successors(Some(first), |power| (*power > 1).then_some(power / 2)).collect()
}

fn two_to(exponent: i32) -> Expression {
    number(f64::from(exponent).exp2())
}

/// Brings `name`, above 0, into [1, 2), and multiplies `factor` by the powers of two that this takes.
fn normalised(name: &str, factor: &str, precision: Precision) -> Vec<Statement> {
    let times = |exponent: i32| {
        let by = |name: &str| Statement::set(name, local(name) * two_to(exponent));
        vec![by(name), by(factor)]
    };
    let up = |power: &i32| Statement::when(local(name).less(two_to(1 - power)), times(*power));
    let down = |power: &i32| {
        let large = two_to(*power).at_most(local(name));
        Statement::when(large, times(-power))
    };
    let powers = powers(precision);
    powers.iter().map(up).chain(powers.iter().map(down)).collect()
}

/// The function `scale`: the power of two that brings a number of the normal range into [1, 2).
pub(super) fn scale(precision: Precision) -> Function {
    let mut body =
        vec![Statement::real("height", local("top")), Statement::real("factor", number(1.0))];
    body.extend(normalised("height", "factor", precision));
    let least = number(super::library::least(precision));
    body.push(Statement::Return(Some(local("factor").larger(least))));
    Function {
        name: "scale",
        doc: "The power of two that brings the highest grade into [1, 2), so that weak rules keep their digits.",
        parts: &[],
        parameters: vec![Parameter { name: "top", kind: Kind::Real, written: false }],
        answers: Some(Kind::Real),
        body,
    }
}

/// The function `square_root`.
///
/// Newton's steps come within a unit in the last place; the exact square of that (Veltkamp's and Dekker's splitting, 1971)
/// then says on which side of the middles between neighbours the root lies. With $m$ in [1, 4), $y$ in [1, 2) and $u$ the
/// unit in the last place, the root lies above $y + u/2$ where $m - y^2 > y u$, and below $y - u/2$ where
/// $m - y^2 \le -y u$: both sides are multiples of $u^2$, so that the rest, $u^2/4$, decides nothing else.
pub(super) fn function(precision: Precision) -> Function {
    let (unit, split) = match precision {
        Precision::Single => (f64::from(f32::EPSILON), 4097.0),
        Precision::Double => (f64::EPSILON, 134_217_729.0),
    };
    let (y, square, rest) = (|| local("root"), || local("power"), || local("rest"));
    let mut body = vec![
        Statement::when(
            number(0.0).less(local("x")).negated(),
            vec![Statement::Return(Some(
                // The root of 0 is 0 with its sign; of others there is none.
                Expression::binary(crate::program::Operator::Equal, local("x"), number(0.0))
                    .select(local("x"), (local("x") - local("x")) / (local("x") - local("x"))),
            ))],
        ),
        Statement::when(
            local("x").at_most(number(precision.largest())).negated(),
            vec![Statement::Return(Some(local("x")))],
        ),
        Statement::real("part", local("x")),
        Statement::real("back", number(1.0)),
    ];
    body.extend(quartered(precision));
    body.push(Statement::real("root", number(0.5) + number(0.5) * local("part")));
    body.push(Statement::repeat(
        "turn",
        // From within 1/4: 3e-2, 5e-4, 1e-7, 7e-15, below a unit.
        6,
        vec![Statement::set("root", number(0.5) * (y() + local("part") / y()))],
    ));
    body.extend([
        Statement::real("spread", number(split) * y()),
        Statement::real("high", local("spread") - (local("spread") - y())),
        Statement::real("low", y() - local("high")),
        Statement::real("power", y() * y()),
        Statement::real(
            "lost",
            ((local("high") * local("high") - square())
                + number(2.0) * (local("high") * local("low")))
                + local("low") * local("low"),
        ),
        Statement::real("rest", (local("part") - square()) - local("lost")),
        Statement::real("middle", y() * number(unit)),
        Statement::If(
            local("middle").less(rest()),
            vec![Statement::set("root", y() + number(unit))],
            vec![Statement::when(
                rest().at_most(-local("middle")),
                vec![Statement::set("root", y() - number(unit))],
            )],
        ),
        Statement::Return(Some(y() * local("back"))),
    ]);
    Function {
        name: "square_root",
        doc: "The square root, rounded correctly: the same bits on every machine.",
        parts: &[],
        parameters: vec![Parameter { name: "x", kind: Kind::Real, written: false }],
        answers: Some(Kind::Real),
        body,
    }
}

/// Brings `part` into [1, 4) by powers of 4, and `back` to the power of 2 that its root has to be multiplied by.
fn quartered(precision: Precision) -> Vec<Statement> {
    let times = |power: i32| {
        vec![
            Statement::set("part", local("part") * two_to(power)),
            Statement::set("back", local("back") * two_to(-power / 2)),
        ]
    };
    let even: Vec<i32> = powers(precision).into_iter().filter(|power| power % 2 == 0).collect();
    // Below the normal range first, by one more power.
    let up = |power: &i32| Statement::when(local("part").less(two_to(2 - power)), times(*power));
    let down = |power: &i32| Statement::when(two_to(*power).at_most(local("part")), times(-power));
    let below = match precision {
        Precision::Single => (-126, 24),
        Precision::Double => (-1022, 54),
    };
    let below = Statement::when(local("part").less(two_to(below.0)), times(below.1));
    std::iter::once(below).chain(even.iter().map(up)).chain(even.iter().map(down)).collect()
}
