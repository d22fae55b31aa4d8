//! Why a change that no vector finds changes nothing, where that can be shown.

mod equality;

use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Controller, fuzzy::Defuzzifier};
use fspid_numeric::Real;

use super::normal::normal;
use super::ranges::{self, Known, Memory, Ranges, above, rounded};
use super::{Finding, Subject};
use crate::interpret::Branch;
use crate::program::{Expression, Precision, Program, Statement, Value, each_expression};

/// A program and what is known of it.
pub(super) struct Judge<'a> {
    program: &'a Program,
    memory: Option<Memory>,
    ranges: Option<Ranges<'a>>,
    normal: Vec<Vec<Statement>>,
    /// Without what is known of numbers.
    plain: Vec<Vec<Statement>>,
    is_mirrored: bool,
    has_halves: bool,
    /// The weaker of two neighbouring grades is always below a half.
    is_below_half: bool,
}

const UNREAD: &str = "nothing reads what it changes";
const INTERVALS: &str =
    "intervals: the same answer to every sample from every memory that the code writes";

impl<'a> Judge<'a> {
    pub(super) fn new<R: Real>(subject: &Subject<'a, R>) -> Self {
        let program = subject.program;
        let memory = ranges::memory(program);
        let ranges = memory.as_ref().map(|memory| ranges::facts(program, memory));
        let normal_form = ranges.as_ref().map(|ranges| normal(program, ranges));
        Self {
            program,
            normal: normal_form.unwrap_or_default(),
            plain: normal(program, &Ranges::none(program)),
            memory,
            ranges,
            is_mirrored: is_mirrored(program),
            has_halves: has_halves(subject.controller),
            is_below_half: is_below_half(subject.controller, program.precision),
        }
    }

    /// Why a change answers the same bits for ever, from a reset on, with the numbers of the design.
    pub(super) fn reason(
        &self,
        finding: &Finding,
        changed: &Program,
        lines: &[&str],
    ) -> Option<&'static str> {
        if self.is_same(changed, &normal(changed, &Ranges::none(changed)), &self.plain) {
            return Some(UNREAD);
        }
        if let Some(memory) = &self.memory {
            let known = ranges::facts(changed, memory);
            if self.is_same(changed, &normal(changed, &known), &self.normal) {
                return Some(INTERVALS);
            }
        }
        let compares = matches!(finding.mutant.change.as_str(), "<= for <" | "< for <=");
        if compares
            && let Some(ranges) = &self.ranges
            && equality::is_the_same(self.program, changed, ranges)
        {
            return Some("both ways answer the same bits where the two sides are equal");
        }
        self.argued(finding, lines)
    }

    /// True where the bodies are the same and every number that still stands in them is.
    fn is_same(
        &self,
        changed: &Program,
        normal: &[Vec<Statement>],
        original: &[Vec<Statement>],
    ) -> bool {
        let both = self.program.configuration.iter().zip(&changed.configuration);
        let mut moved = both.filter(|(a, b)| a.value != b.value).map(|(a, _)| &a.name);
        let text = || format!("{original:?}");
        normal == original && moved.all(|name| !text().contains(&format!("\"{name}\"")))
    }

    /// What follows from what the code is about, each with its condition.
    fn argued(&self, finding: &Finding, lines: &[&str]) -> Option<&'static str> {
        let (element, change) = (finding.mutant.element.as_str(), finding.mutant.change.as_str());
        let line = finding.lines.first().map_or(0, |(line, _)| *line);
        let text = lines.get(line.wrapping_sub(1)).copied().unwrap_or_default();
        let above = &lines[line.saturating_sub(3)..line.min(lines.len())];
        let asks_guard = |it: &&str| it.contains("setpoint_rad") && it.contains("guard_rad)");
        let numbers = self.program.function("lower_set").is_some();
        let turned =
            change == "the other sign" && (element == "sign" || numbers && element == "spacing");
        let from_centres = element == "fill_grades" && change == "+ for -"
            || element == "warp" && change == "negated" && text.contains("-warped : warped");
        let weaker = matches!(change, "no magnitude" | "or for and")
            || change == "left out" && text.trim() == "return;";
        Some(match element {
            _ if turned && self.program.function("softsign").is_some() => {
                "a network answers both inputs turned as it answers them"
            }
            _ if self.is_mirrored && (turned || from_centres) => {
                "every rule concludes what the rule for both inputs turned concludes, and sets lie as far on both sides"
            }
            "set_sigma" if change == "the other sign" => "it divides what is squared next",
            "lower_set" if change == "< for <=" => {
                "at a centre its own set has all of the weight, reckoned from either side"
            }
            "track" if weaker && above.iter().any(asks_guard) => {
                "the step behind it asks the same and holds such a sample with the same fault"
            }
            "infer" if change == "< for <=" && text.contains("->range") => {
                "the end of the range is moved onto itself"
            }
            "warp" if change == "<= for <" && text.contains("-warped : warped") => {
                "both are zeros there, and distances from centres do not show their sign"
            }
            "exponential" if text.contains("part_8 = ") && change.starts_with("a thousandth") => {
                "a power of two is made of two others, whose product is exact however it is split"
            }
            "reset" if self.is_begun(text) => {
                "read only where a sample has been good, which has written it"
            }
            "centroid"
                if self.has_halves
                    && self.is_below_half
                    && text.contains("height = ")
                    && is_above(finding) =>
            {
                "at every number about half way, the weaker of two neighbouring grades is below a half"
            }
            "centroid"
                if self.has_halves && text.contains("height = ") && is_half(change, finding) =>
            {
                "two labels are never both stronger than a half by more than rounding, where the overlap is flat"
            }
            _ => return None,
        })
    }

    /// True for a member that is read only where a sample has been good.
    fn is_begun(&self, line: &str) -> bool {
        let name = line.trim().strip_prefix("state->").and_then(|it| it.split(' ').next());
        let Some(name) = name else { return false };
        let text = format!("{:?}", self.program.functions);
        let read = format!("Read(Member(State, \"{name}\"))");
        let guarded = format!("Select(Read(Member(State, \"started\")), {read}");
        text.matches(&read).count() == text.matches(&guarded).count()
    }

    /// Why a branch never goes one of its ways.
    pub(super) fn one_way(&self, branch: &Branch) -> Option<String> {
        let held = branch.held > 0;
        let ranges = self.ranges.as_ref()?;
        let mut found = Vec::new();
        for function in self.program.functions.iter().filter(|it| it.name == branch.function) {
            each_expression(&function.body, &mut |value| {
                if *value == branch.condition {
                    found.push(value);
                }
            });
        }
        let always = |it: &Expression| match ranges.of(it) {
            Some(Known::Truth(truth)) => {
                truth.constant() == Some(held) || branch.held + branch.failed == 0
            }
            None => true,
            _ => false,
        };
        let nowhere = branch.held + branch.failed == 0;
        let shown = !found.is_empty()
            && found.iter().all(|it| always(it) && (!nowhere || ranges.of(it).is_none()));
        if shown {
            return Some(format!("cannot: {}", self.why(found.first()?)));
        }
        let half = self.has_halves
            && branch.function == "centroid"
            && format!("{:?}", branch.condition).contains("\"lower\"");
        half.then(|| {
            "cannot by more than rounding: two labels are never both stronger than a half"
                .to_owned()
        })
    }

    /// What a comparison is between.
    fn why(&self, asked: &Expression) -> String {
        let Some(ranges) = &self.ranges else { return String::new() };
        let side = |it: &Expression| match ranges.of(it) {
            Some(Known::Real(it)) => format!("{:.6e} to {:.6e}", it.low, it.high),
            Some(Known::Whole([low, high])) => format!("{low} to {high}"),
            _ => "never asked".to_owned(),
        };
        match asked {
            Expression::Binary(_, left, right)
                if matches!(ranges.of(left), Some(Known::Real(_) | Known::Whole(_))) =>
            {
                format!("{} stands against {}", side(left), side(right))
            }
            _ => "intervals of what is asked within".to_owned(),
        }
    }
}

/// What is added by the bound that asks whether a half is reached, and not by the half that is taken there.
fn is_half(change: &str, finding: &Finding) -> bool {
    let raised = |text: &str| text.contains("lower < 0.5005");
    change == "always the first"
        || change == "a thousandth more" && finding.lines.iter().all(|(_, text)| raised(text))
}

/// True for a change of what is taken where the weaker of two is not below a half.
fn is_above(finding: &Finding) -> bool {
    let bound = "lower < 0.5f";
    finding.lines.iter().all(|(_, text)| text.contains(bound) && text.contains("? lower :"))
}

/// Numbers on either side of half way that are asked.
const ASKED_ABOUT_HALF: usize = 400;

/// True where at half way between two centres, and at the numbers about it, one of both grades is below one half. Farther
/// away one of them is lower by more than rounding.
fn is_below_half<R: Real>(controller: &Controller<R>, precision: Precision) -> bool {
    let Controller::SelfTuning(fspid) = controller else { return false };
    let supervisor = fspid.tuner().supervisor();
    if !supervisor.has_labels() {
        return false;
    }
    let centres = supervisor.sets().map(|[centre, _]| centre.to_f64());
    centres.windows(2).enumerate().all(|(set, pair)| {
        let half_way = rounded(precision, 0.5 * (pair[0] + pair[1]));
        [1.0, -1.0].into_iter().all(|sign| {
            let mut input = sign * half_way;
            (0..ASKED_ABOUT_HALF).all(|_| {
                let grades = supervisor.grades(R::from_f64(sign * input));
                input = above(precision, input);
                grades[set].to_f64().min(grades[set + 1].to_f64()) < 0.5
            })
        })
    })
}

/// True where every rule concludes what the rule for both inputs turned concludes, and centres lie likewise.
pub(super) fn is_mirrored(program: &Program) -> bool {
    let tables = program.configuration.iter().filter(|it| it.is_rules());
    let are_mirrored = tables.map(|it| &it.value).all(|value| match value {
        Value::Bytes(cells) => cells.iter().eq(cells.iter().rev()),
        Value::Reals(cells) => cells.iter().eq(cells.iter().rev()),
        Value::Real(_) | Value::Byte(_) | Value::Truth(_) => false,
    });
    let centres = program.configuration.iter().find(|it| it.name == "set_centres");
    let lie_alike = centres.is_none_or(|it| match &it.value {
        Value::Reals(centres) => {
            centres.iter().zip(centres.iter().rev()).all(|(a, b)| a + b == 0.0)
        }
        _ => false,
    });
    are_mirrored && lie_alike
}

/// True where Gaussian sets cross at one half and labels overlap in closed form.
fn has_halves<R: Real>(controller: &Controller<R>) -> bool {
    let Controller::SelfTuning(fspid) = controller else { return false };
    let supervisor = fspid.tuner().supervisor();
    let [[first, sigma], [second, _], ..] = supervisor.sets().map(|it| it.map(|it| it.to_f64()));
    let half_way = 0.5 * (second - first) / sigma;
    supervisor.has_labels()
        && supervisor.defuzzifier() == Defuzzifier::Exact
        && supervisor.out_of_range() != OutOfRange::Evaluate
        && (libm::exp(-0.5 * half_way * half_way) - 0.5).abs() < 1e-5
}
