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
        vec![Statement::set("root", number(0.5) * (local("root") + local("part") / local("root")))],
    ));
    body.extend(corrected(precision));
    Function {
        name: "square_root",
        doc: "The square root, rounded correctly: the same bits on every machine.",
        parts: &[],
        parameters: vec![Parameter { name: "x", kind: Kind::Real, written: false }],
        answers: Some(Kind::Real),
        body,
    }
}

/// Moves `root` to the neighbour that is nearer to the root of `part`, if one is, and answers it.
fn corrected(precision: Precision) -> Vec<Statement> {
    let (unit, split) = match precision {
        Precision::Single => (f64::from(f32::EPSILON), 4097.0),
        Precision::Double => (f64::EPSILON, 134_217_729.0),
    };
    let (y, square, rest) = (|| local("root"), || local("power"), || local("rest"));
    vec![
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
    ]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compose::precision_of;
    use crate::interpret::{Cell, Machine};
    use crate::program::{Member, Part, Program, Value, member};
    use crate::vectors::Draw;
    use fspid_numeric::Real;

    /// A program whose `infer` answers what a function of `x` does.
    fn asks(function: Function) -> Program {
        let call = super::super::library::called(function.name, [member(Part::Sample, "x")]);
        let real = |name: &str| Member {
            name: name.to_owned(),
            doc: String::new(),
            value: Value::Real(0.0),
        };
        let infer = Function {
            name: "infer",
            doc: "",
            parts: &[Part::Sample, Part::Answer],
            parameters: Vec::new(),
            answers: None,
            body: vec![Statement::set_member(Part::Answer, "y", call)],
        };
        Program {
            precision: Precision::Double,
            configuration: Vec::new(),
            state: Vec::new(),
            sample: vec![real("x")],
            answer: vec![real("y")],
            functions: vec![function, infer],
        }
    }

    fn answers<R: Real>(machine: &mut Machine<'_, R>, x: R) -> R {
        machine.set(Part::Sample, "x", Cell::Real(x));
        machine.run("infer");
        match machine.member(Part::Answer, "y") {
            Some(Cell::Real(y)) => *y,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_square_root_has_the_bits_of_ieee_754_in_both_precisions() {
        let double = asks(function(precision_of::<f64>()));
        let single = asks(function(precision_of::<f32>()));
        let mut double = Machine::<f64>::new(&double);
        let mut single = Machine::<f32>::new(&single);
        let mut draw = Draw(1);
        for k in 0..20_000_u64 {
            let bits = (draw.unit() * (1_u64 << 53) as f64) as u64 * 1023 + k;
            // Every exponent, and mantissas near the ends, where roots lie near the middles.
            let x = f64::from_bits(if k % 3 == 0 { bits | 0x000F_FFFF_FFFF_FF00 } else { bits });
            if x >= 0.0 && x.is_finite() {
                assert_eq!(answers(&mut double, x).to_bits(), libm::sqrt(x).to_bits(), "{x:e}");
            }
            let x = f32::from_bits((bits >> 20) as u32 & 0x7F7F_FFFF);
            assert_eq!(answers(&mut single, x).to_bits(), libm::sqrtf(x).to_bits(), "{x:e}");
        }
        for x in
            [0.0, -0.0, f64::from_bits(1), f64::MIN_POSITIVE, 1.0, 4.0, f64::MAX, f64::INFINITY]
        {
            assert_eq!(answers(&mut double, x).to_bits(), libm::sqrt(x).to_bits(), "{x:e}");
        }
        assert!(answers(&mut double, -1.0).is_nan() && answers(&mut double, f64::NAN).is_nan());
    }

    #[test]
    fn a_scale_brings_every_normal_number_between_one_and_two() {
        let program = asks(scale(Precision::Double));
        let mut machine = Machine::<f64>::new(&program);
        for exponent in -1022..1023 {
            let x = 1.7 * f64::from(exponent).exp2();
            assert!((1.0..2.0).contains(&(x * answers(&mut machine, x))), "{x:e}");
        }
    }
}
