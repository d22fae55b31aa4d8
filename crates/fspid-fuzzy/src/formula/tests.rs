//! Formulas: what they mean, what is refused, and what abuse costs.

use super::*;
use proptest::prelude::*;
use std::format;
use std::string::{String, ToString};

fn value(text: &str) -> f64 {
    Formula::parse(text, &[]).unwrap_or_else(|error| panic!("{text}: {error}")).evaluate(&[])
}

fn refusal(text: &str) -> FormulaError {
    Formula::parse(text, &["x", "ambient"]).expect_err(text)
}

#[test]
fn operators_hold_as_tightly_as_in_mathematics() {
    for (text, expected) in [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("8 - 4 - 2", 2.0),
        ("8 / 4 / 2", 1.0),
        ("7 % 4 * 2", 6.0),
        ("-7 % 4", -3.0),
        ("2 ^ 3 ^ 2", 512.0),
        ("-2 ^ 2", -4.0),
        ("~2 ^ 2", 4.0),
        ("2 ^ -1", 0.5),
        ("2 ^ -1 * 4", 2.0),
        ("3 * -2", -6.0),
        ("3 - -2", 5.0),
        ("+ + 3", 3.0),
        ("2 * +3 - - - 1", 5.0),
        ("1 or 0 and 0", 1.0),
        ("2 and 3", 1.0),
        ("0 or 0", 0.0),
        ("!0 + 1", 2.0),
        ("not 3", 0.0),
        ("not 0 and 1", 1.0),
        (".5 + 1. + 1.5e1 + 2E-1 + 1e+0", 17.7),
    ] {
        assert!((value(text) - expected).abs() < 1e-12, "{text} is {}", value(text));
    }
}

#[test]
fn functions_are_what_they_are_called() {
    for (text, expected) in [
        ("abs(-2) + fabs(-1)", 3.0),
        ("sqrt(16)", 4.0),
        ("exp(1)", core::f64::consts::E),
        ("log(exp(2))", 2.0),
        ("log10(1000)", 3.0),
        ("log1p(0)", 0.0),
        ("sin(pi / 2) + cos(0) + tan(0)", 2.0),
        ("asin(1) - pi / 2", 0.0),
        ("acos(0) - pi / 2", 0.0),
        ("4 * atan(1) - pi", 0.0),
        ("sinh(1) - (exp(1) - exp(-1)) / 2", 0.0),
        ("cosh(1) - (exp(1) + exp(-1)) / 2", 0.0),
        ("tanh(1) - sinh(1) / cosh(1)", 0.0),
        ("asinh(sinh(2)) + asinh(sinh(-2))", 0.0),
        ("acosh(cosh(2))", 2.0),
        ("atanh(tanh(0.5))", 0.5),
        ("floor(-1.5)", -2.0),
        ("ceil(-1.5)", -1.0),
        ("round(2.5)", 3.0),
        ("round(-2.5)", -3.0),
        ("round(0.49999999999999994)", 0.0),
        ("sign(-3) + sign(0) + 2 * sign(9)", 1.0),
        ("min(1, 2) + 10 * max(1, 2)", 21.0),
        ("pow(2, 10)", 1024.0),
        ("fmod(-7, 4)", -3.0),
        ("gt(2, 1) + gt(1, 1)", 1.0),
        ("ge(1, 1) + ge(0, 1)", 1.0),
        ("lt(1, 2) + lt(1, 1)", 1.0),
        ("le(1, 1) + le(2, 1)", 1.0),
        ("eq(1, 1) + eq(1, 2) + eq(2, 1)", 1.0),
        ("neq(1, 1) + neq(1, 2)", 1.0),
        ("4 * atan2(1, 1) - pi", 0.0),
        ("atan2(0, -1) - pi", 0.0),
        ("atan2(-1, 0) + pi / 2", 0.0),
        ("4 * atan2(-1, -1) + 3 * pi", 0.0),
        ("atan2(0, 0)", 0.0),
    ] {
        assert!((value(text) - expected).abs() < 1e-14, "{text} is {}", value(text));
    }
}

#[test]
fn every_function_is_known_and_takes_its_arguments() {
    for &(name, function) in FUNCTIONS {
        let arguments = ["0.5", "0.5"][..function.arguments()].join(",");
        assert!(Formula::parse(&format!("{name}({arguments})"), &[]).is_ok(), "{name}");
        let error = refusal(&format!("1 + {name}({arguments}, 1, 1)"));
        let found = function.arguments() + 2;
        let expected = function.arguments();
        let kind = FormulaErrorKind::Arguments { function: name, found, expected };
        assert_eq!(error, FormulaError { position: 4, kind });
    }
    assert_eq!(Formula::functions().count(), FUNCTIONS.len());
}

#[test]
fn squares_and_cubes_exist_for_numbers_below_zero() {
    let formula = Formula::parse("x^2 + x^3 + pow(x, 2)", &["x"]).unwrap();
    assert_eq!(formula.evaluate(&[-1.5]), 2.25 - 3.375 + 2.25);
}

#[test]
fn variables_go_by_their_index_and_hide_functions_and_constants() {
    let formula = Formula::parse("e - 2 * ec.rate + pi * größe", &["e", "ec.rate", "pi", "größe"]);
    let formula = formula.unwrap();
    assert_eq!(formula.evaluate(&[10.0, 1.0, 100.0, 0.5]), 58.0);
    assert!((0..4).all(|variable| formula.uses(variable)) && !formula.uses(4));
    assert_eq!(formula.text(), "e - 2 * ec.rate + pi * größe");
    assert!(formula.evaluate(&[1.0_f64]).is_nan());
    let hidden = Formula::parse("max + 1", &["max"]).unwrap();
    assert_eq!(hidden.evaluate(&[1.0]), 2.0);
}

#[test]
fn a_refusal_says_where_and_what_was_expected() {
    for (text, position, words) in [
        ("", 0, "the formula ends; expected is a number, a name, a function or a bracket"),
        ("  1 +", 5, "the formula ends"),
        ("x + foo", 4, "unknown name \"foo\"; known are x, ambient, pi, abs, "),
        ("x y", 2, "unexpected \"y\"; expected is an operator or the end"),
        ("2x", 1, "unexpected \"x\""),
        ("x + * 2", 4, "unexpected \"*\"; expected is a number"),
        ("(x + 1", 0, "never closed"),
        ("1 + min(x, (2", 11, "never closed"),
        ("x + 1)", 5, "unexpected \")\""),
        ("()", 1, "unexpected \")\""),
        ("x, 1", 1, "unexpected \",\""),
        ("(x, 1)", 2, "unexpected \",\""),
        ("min(x)", 0, "min has 1 arguments; expected are 2"),
        ("1 + sin(x, x)", 4, "sin has 2 arguments; expected are 1"),
        ("sin x", 4, "unexpected \"x\"; expected is \"(\" after the name of a function"),
        ("sin()", 4, "unexpected \")\""),
        ("x = 1", 2, "'=' means nothing"),
        ("3 × x", 2, "'×' means nothing"),
        ("x \u{0} 1", 2, "means nothing"),
        ("1.2.3", 0, "\"1.2.3\" is not a finite number"),
        ("1 + 1e999", 4, "\"1e999\" is not a finite number"),
        (".", 0, "\".\" is not a finite number"),
        ("x and and x", 6, "unexpected \"and\""),
        ("x not x", 2, "unexpected \"not\""),
    ] {
        let error = refusal(text);
        assert_eq!(error.position, position, "{text}: {error}");
        assert!(error.to_string().contains(words), "{text}: {error}");
    }
}

#[test]
fn abuse_is_refused_where_it_begins_to_be_one() {
    let nested = |count: usize| format!("{}x{}", "(".repeat(count), ")".repeat(count));
    assert!(Formula::parse(&nested(64), &["x"]).is_ok());
    let kind = |text: &str| refusal(text).kind;
    assert_eq!(refusal(&nested(65)), FormulaErrorKind::TooDeep.at(64));
    assert_eq!(refusal(&"(".repeat(60_000)), FormulaErrorKind::TooDeep.at(64));
    assert_eq!(kind(&"(".repeat(100_000)), FormulaErrorKind::TooLong { found: 100_000 });
    assert_eq!(kind(&"-".repeat(60_000)), FormulaErrorKind::TooDeep);
    assert_eq!(kind(&"sin(".repeat(10_000)), FormulaErrorKind::TooDeep);
    assert_eq!(kind(&"2^".repeat(30_000)), FormulaErrorKind::TooDeep);
    assert_eq!(kind(&"1+".repeat(30_000)), FormulaErrorKind::TooManyParts);
    assert_eq!(kind(&"min(1,".repeat(10_000)), FormulaErrorKind::TooDeep);
    let digits = "1".repeat(400);
    assert_eq!(kind(&digits), FormulaErrorKind::Number { found: digits.clone() });
}

#[test]
fn a_formula_as_large_as_allowed_is_computed() {
    let sum = format!("1{}", "+1".repeat(511));
    assert_eq!(value(&sum), 512.0);
    assert_eq!(refusal(&format!("{sum}+1")).kind, FormulaErrorKind::TooManyParts);
    let tower = format!("1{}", "^1".repeat(63));
    assert_eq!(value(&tower), 1.0);
    assert_eq!(value(&format!("{}1", " ".repeat(MAX_BYTES - 1))), 1.0);
}

/// Brackets cost nothing but time; the time is far below this even unoptimised.
#[test]
fn abuse_is_refused_before_the_rest_is_read() {
    // Where each is given up: what stands behind that place is never looked at.
    for (text, position) in [
        ("(".repeat(100_000), MAX_BYTES),
        ("(".repeat(65_000), MAX_DEPTH),
        ("-".repeat(65_000), MAX_DEPTH),
        ("1+".repeat(32_000), MAX_PARTS + 1),
    ] {
        let error = Formula::parse(&text, &[]).unwrap_err();
        assert!(error.position <= position, "{error}: at byte {}", error.position);
    }
}

/// A formula as a tree, to be printed and computed apart from the parser.
#[derive(Clone, Debug)]
enum Tree {
    Number(f64),
    X,
    Minus(std::boxed::Box<Tree>),
    Sine(std::boxed::Box<Tree>),
    Pair(char, std::boxed::Box<[Tree; 2]>),
    Smaller(std::boxed::Box<[Tree; 2]>),
}

impl Tree {
    fn evaluate(&self, x: f64) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::X => x,
            Self::Minus(tree) => -tree.evaluate(x),
            Self::Sine(tree) => libm::sin(tree.evaluate(x)),
            Self::Smaller(pair) => Scalar::smaller(pair[0].evaluate(x), pair[1].evaluate(x)),
            Self::Pair(sign, pair) => {
                let [a, b] = [pair[0].evaluate(x), pair[1].evaluate(x)];
                match sign {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    '/' => a / b,
                    _ => libm::pow(a, b),
                }
            }
        }
    }

    const fn strength(&self) -> u8 {
        match self {
            Self::Pair('+' | '-', _) => 3,
            Self::Pair('*' | '/', _) => 4,
            Self::Minus(_) => 5,
            Self::Pair(..) => 6,
            _ => 9,
        }
    }

    /// With no bracket that is not needed.
    fn print(&self) -> String {
        let inside = |tree: &Self, least: u8| {
            if tree.strength() >= least { tree.print() } else { format!("({})", tree.print()) }
        };
        match self {
            Self::Number(value) => format!("{value:?}"),
            Self::X => "x".into(),
            Self::Minus(tree) => format!("-{}", inside(tree, 5)),
            Self::Sine(tree) => format!("sin({})", tree.print()),
            Self::Smaller(pair) => format!("min({},{})", pair[0].print(), pair[1].print()),
            Self::Pair(sign, pair) => {
                let own = self.strength();
                let sides = if *sign == '^' { (own + 1, own - 1) } else { (own, own + 1) };
                format!("{} {sign} {}", inside(&pair[0], sides.0), inside(&pair[1], sides.1))
            }
        }
    }
}

fn trees() -> impl Strategy<Value = Tree> {
    // No 2 and no 3, whose powers are products here.
    let leaf = prop_oneof![
        (0.0..100.0_f64).prop_map(Tree::Number),
        (1e-9..1e-7_f64).prop_map(Tree::Number),
        Just(Tree::X),
    ];
    leaf.prop_recursive(6, 64, 2, |inner| {
        let pair = (inner.clone(), inner.clone()).prop_map(|(a, b)| std::boxed::Box::new([a, b]));
        let sign = prop_oneof![Just('+'), Just('-'), Just('*'), Just('/'), Just('^')];
        prop_oneof![
            inner.clone().prop_map(|tree| Tree::Minus(tree.into())),
            inner.prop_map(|tree| Tree::Sine(tree.into())),
            (sign, pair.clone()).prop_map(|(sign, pair)| Tree::Pair(sign, pair)),
            pair.prop_map(Tree::Smaller),
        ]
    })
}

proptest! {
    #[test]
    fn what_is_printed_is_read_back_as_the_same_formula(tree in trees(), x in -10.0..10.0_f64) {
        let text = tree.print();
        let formula = Formula::parse(&text, &["x"]).unwrap();
        let (found, expected) = (formula.evaluate(&[x]), tree.evaluate(x));
        prop_assert!(found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan()),
            "{}: {} for {}", text, found, expected);
        prop_assert_eq!(&Formula::parse(formula.text(), &["x"]).unwrap(), &formula);
    }

    #[test]
    fn no_text_is_too_strange_to_be_answered(text in "\\PC{0,40}") {
        let _ = Formula::parse(&text, &["x"]);
    }

    #[test]
    fn no_mixture_of_parts_is_too_strange_to_be_answered(
        parts in proptest::collection::vec(
            proptest::sample::select(&["(", ")", ",", "-", "+", "^", "min", "sin", "x", "2", "!", "and", " "][..]),
            0..60,
        )
    ) {
        let text = parts.concat();
        match Formula::parse(&text, &["x"]) {
            Ok(formula) => {
                let _ = formula.evaluate(&[1.5]);
            }
            Err(error) => prop_assert!(error.position <= text.len()),
        }
    }
}
