//! Formulas of functions.

use core::f64::consts::PI;

use fspid_numeric::units::{DEGREE_RAD, RADIAN_DEG};

use crate::expression::{Expression, Function, One, Two};
use crate::jsbsim::class::{Class, Refusal, Share};
use crate::jsbsim::property::{Builder, Term};
use crate::xml::element::Element;

/// What may stand inside of a function.
const KNOWN: &str = "product, sum, difference, quotient, value, property, table, pow, abs, min, max, sin, cos, tan, asin, \
                     acos, atan, atan2, exp, ln, log10, sqrt, floor, ceil, pi, toradians, todegrees";

/// Elements whose operands are handed to a function as they are.
const FUNCTIONS: [(&str, Function); 17] = [
    ("abs", Function::One(One::Abs)),
    ("acos", Function::One(One::Arccos)),
    ("asin", Function::One(One::Arcsin)),
    ("atan", Function::One(One::Arctan)),
    ("atan2", Function::Two(Two::Arctan2)),
    ("ceil", Function::One(One::Ceiling)),
    ("cos", Function::One(One::Cos)),
    ("exp", Function::One(One::Exp)),
    ("floor", Function::One(One::Floor)),
    ("ln", Function::One(One::Ln)),
    ("log10", Function::One(One::Log)),
    ("max", Function::Fold(Two::Max)),
    ("min", Function::Fold(Two::Min)),
    ("pow", Function::Two(Two::Power)),
    ("sin", Function::One(One::Sin)),
    ("sqrt", Function::One(One::Root)),
    ("tan", Function::One(One::Tan)),
];

impl Builder<'_> {
    /// The formula of an element; `None` after a problem was told.
    pub(super) fn expression(&mut self, element: Element<'_, '_>, owner: &str) -> Option<Term> {
        match element.name() {
            "value" | "v" => {
                let formula = Expression::Number(element.single(self.findings));
                Some(Term { formula, class: Class::default() })
            }
            "pi" => Some(Term { formula: Expression::Number(PI), class: Class::default() }),
            "property" | "p" => {
                element.only(&[], self.findings);
                self.property(&element.prose(), element.origin())
            }
            "table" | "t" => self.table(element, owner),
            "product" => {
                let terms = self.operands(element, owner)?;
                self.product(element, terms)
            }
            "sum" => {
                let terms = self.operands(element, owner)?;
                self.applied(element, Function::Fold(Two::Add), terms, Class::sum)
            }
            "difference" => {
                let terms = self.operands(element, owner)?;
                self.difference(element, terms)
            }
            "quotient" => {
                let terms = self.operands(element, owner)?;
                let class = |classes: &[Class]| match classes {
                    [top, bottom] => Class::quotient(*top, *bottom),
                    _ => Ok(Class::default()),
                };
                self.applied(element, Function::Two(Two::Divide), terms, class)
            }
            "toradians" => self.scaled(element, owner, DEGREE_RAD),
            "todegrees" => self.scaled(element, owner, RADIAN_DEG),
            name => match FUNCTIONS.iter().find(|(known, _)| *known == name) {
                Some(&(_, function)) => {
                    let terms = self.operands(element, owner)?;
                    self.applied(element, function, terms, Class::function)
                }
                None => {
                    element.refuse("function", KNOWN, self.findings);
                    None
                }
            },
        }
    }

    /// Every operand of an element, all of them looked at so that every problem is told.
    fn operands(&mut self, element: Element<'_, '_>, owner: &str) -> Option<Vec<Term>> {
        let children = element.children(self.findings);
        let parts = children.into_iter().filter(|child| is_part(*child));
        let terms: Vec<_> = parts.map(|child| self.expression(child, owner)).collect();
        terms.into_iter().collect()
    }

    fn applied(
        &mut self,
        element: Element<'_, '_>,
        function: Function,
        terms: Vec<Term>,
        class: impl Fn(&[Class]) -> Result<Class, Refusal>,
    ) -> Option<Term> {
        if let Some(expected) = function.refuses(terms.len()) {
            let message = format!("the number of operands is {}", terms.len());
            self.findings.problem(element.origin(), element.name(), message, expected);
            return None;
        }
        let classes: Vec<_> = terms.iter().map(|term| term.class).collect();
        let class = self.judged(element, class(&classes))?;
        let operands = terms.into_iter().map(|term| term.formula).collect();
        Some(Term { formula: Expression::Apply(function, operands), class })
    }

    pub(super) fn judged(
        &mut self,
        element: Element<'_, '_>,
        class: Result<Class, Refusal>,
    ) -> Option<Class> {
        let told = |(message, expected): Refusal| {
            self.findings.problem(element.origin(), element.name(), message, expected);
        };
        class.map_err(told).ok()
    }

    /// A product without the dynamic pressure, which is 1.
    fn product(&mut self, element: Element<'_, '_>, terms: Vec<Term>) -> Option<Term> {
        let classes: Vec<_> = terms.iter().map(|term| term.class).collect();
        let class = self.judged(element, Class::product(&classes))?;
        let plain = |term: &Term| term.class.pressure && term.formula == Expression::Number(1.0);
        let mut factors: Vec<_> =
            terms.into_iter().filter(|term| !plain(term)).map(|term| term.formula).collect();
        let formula = match factors.len() {
            0 => Expression::Number(1.0),
            1 => factors.remove(0),
            _ => Expression::Apply(Function::Fold(Two::Multiply), factors),
        };
        Some(Term { formula, class })
    }

    /// The first less all others.
    fn difference(&mut self, element: Element<'_, '_>, mut terms: Vec<Term>) -> Option<Term> {
        if terms.len() > 2 {
            let others = terms.split_off(1);
            let sum = self.applied(element, Function::Fold(Two::Add), others, Class::sum)?;
            terms.push(sum);
        }
        // One operand alone is itself: the minus of one operand is the standard's, not JSBSim's.
        let function = if terms.len() == 1 { Function::Fold(Two::Add) } else { Function::Minus };
        self.applied(element, function, terms, Class::sum)
    }

    fn scaled(&mut self, element: Element<'_, '_>, owner: &str, factor: f64) -> Option<Term> {
        let mut terms = self.operands(element, owner)?;
        terms.push(Term { formula: Expression::Number(factor), class: Class::default() });
        self.applied(element, Function::Fold(Two::Multiply), terms, Class::product)
    }

    /// True where a function is nothing but proportional to the rate of the angle of attack.
    pub(super) fn rests(&self, id: &str) -> bool {
        self.class(id).rate == Share::Proportional
    }
}

/// False for what only describes.
pub(super) fn is_part(element: Element<'_, '_>) -> bool {
    !matches!(element.name(), "description" | "documentation" | "note")
}
