//! What is true of a system, in sentences: its rules as written, and its surfaces with proof.

mod along;
mod json;
mod number;
mod output;
mod rules;
mod text;

use fspid_fuzzy::audit::{
    RuleBaseAudit, RulePosition, SurfaceAudit, SurfaceOptions, rule_base, surface,
};
use fspid_fuzzy::system::System;

use super::answer::named;
use super::slice::spans;
use super::words;
use fspid_scenario::count;
use fspid_scenario::supervisor::Refused;

/// Where to look, and how hard.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Question<'a> {
    /// Ranges of inputs in place of those of the file, `name=lower..upper`.
    pub spans: &'a [String],
    /// Inputs at rest, `name=value`; 0, or the middle of a range without 0, if left out.
    pub rest: &'a [String],
    /// Most boxes that are looked at for each single question.
    pub boxes: Option<u64>,
}

/// A system and what is true of it.
#[derive(Clone, Debug)]
pub struct Audit<'a> {
    system: &'a System,
    /// The rules as written.
    pub rules: RuleBaseAudit,
    /// The surfaces.
    pub surface: SurfaceAudit,
}

/// How a finding is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A property that rule tables should have, proved.
    Holds,
    /// Worth knowing.
    Worth,
    /// Probably not meant.
    NotMeant,
    /// Neither proved nor refuted within the budget.
    Open,
}

impl Mark {
    /// A sign for it; the sentence always says the same in words.
    #[must_use]
    pub const fn sign(self) -> &'static str {
        match self {
            Self::Holds => "\u{2713}",
            Self::Worth => "!",
            Self::NotMeant => "\u{2717}",
            Self::Open => "?",
        }
    }
}

/// Something that is true of a system, in a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// How it is meant.
    pub mark: Mark,
    /// What it is about: `values`, `coverage`, `along error`, …
    pub about: String,
    /// The sentence.
    pub sentence: String,
}

/// Findings about the rules, or about one output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chapter {
    /// `rules`, or the name of the output.
    pub title: String,
    /// The findings.
    pub findings: Vec<Finding>,
}

/// Most rules of a system that is audited: the pairs of 10 000 are 50 million, those of 300 000 are 45 000 million.
const MOST_RULES: usize = 10_000;

/// Looks at a system.
///
/// # Errors
/// [`Refused`] with everything that is wrong with the question.
pub fn audit<'a>(system: &'a System, question: &Question<'_>) -> Result<Audit<'a>, Refused> {
    let mut problems = Vec::new();
    let boxes = question.boxes.map_or(Ok(()), |boxes| count::BOXES.check(boxes));
    problems.extend(boxes.err().map(|error| error.to_string()));
    let rules: usize = system.parts().blocks.iter().map(|block| block.rules.len()).sum();
    if rules > MOST_RULES {
        problems.push(format!(
            "{rules} rules: each is compared with every other and enclosed in every box, which takes hours; allowed are up to {MOST_RULES}"
        ));
    }
    let domain = domain(system, question, &mut problems);
    let rest = rest(system, question, &domain, &mut problems);
    if !problems.is_empty() {
        return Err(Refused::all(problems));
    }
    let mut options = SurfaceOptions { domain: Some(domain), rest, ..SurfaceOptions::default() };
    options.boxes = question.boxes.unwrap_or(options.boxes);
    let surface = surface(system, &options).map_err(|error| Refused::one(error.to_string()))?;
    Ok(Audit { system, rules: rule_base(system), surface })
}

fn domain(system: &System, question: &Question<'_>, problems: &mut Vec<String>) -> Vec<[f64; 2]> {
    let found = spans(system, question.spans, problems);
    found.into_iter().map(|span| [span.lower, span.upper]).collect()
}

/// The inputs at rest, if any is given.
fn rest(
    system: &System,
    question: &Question<'_>,
    domain: &[[f64; 2]],
    problems: &mut Vec<String>,
) -> Option<Vec<f64>> {
    let given = named(system, question.rest, problems);
    let own = |[lower, upper]: [f64; 2]| {
        if (lower..=upper).contains(&0.0) { 0.0 } else { 0.5 * lower + 0.5 * upper }
    };
    let filled = given.iter().zip(domain).map(|(value, ends)| value.unwrap_or_else(|| own(*ends)));
    given.iter().any(Option::is_some).then(|| filled.collect())
}

impl<'a> Audit<'a> {
    /// The system that was looked at.
    #[must_use]
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// Everything that is worth saying: about the rules, then about each output.
    #[must_use]
    pub fn chapters(&self) -> Vec<Chapter> {
        let mut chapters =
            vec![Chapter { title: "rules".to_owned(), findings: rules::findings(self) }];
        for (index, output) in self.system.parts().outputs.iter().enumerate() {
            let findings = output::findings(self, index);
            chapters.push(Chapter { title: output.name.clone(), findings });
        }
        chapters
    }

    fn rule(&self, at: RulePosition) -> String {
        words::name(self.system.parts(), at.block, at.rule)
    }

    fn input(&self, index: usize) -> &str {
        self.system.parts().inputs.get(index).map_or("", |input| &input.name)
    }

    fn input_term(&self, input: usize, term: usize) -> &str {
        let input = self.system.parts().inputs.get(input);
        input.and_then(|input| input.terms.get(term)).map_or("", |term| &term.name)
    }

    fn output_term(&self, output: usize, term: usize) -> &str {
        let output = self.system.parts().outputs.get(output);
        output.and_then(|output| output.terms.get(term)).map_or("", |term| &term.name)
    }

    /// How long the range of an input is.
    fn span(&self, input: usize) -> f64 {
        self.surface.domain.get(input).map_or(1.0, |[lower, upper]| upper - lower)
    }

    /// A point: `error = 4.167, change = 4.556`.
    fn point(&self, at: &[f64]) -> String {
        let inputs = self.system.parts().inputs.iter().zip(at);
        let pairs: Vec<String> =
            inputs.map(|(input, x)| format!("{} = {}", input.name, number::short(*x))).collect();
        pairs.join(", ")
    }

    /// A cell of a rule grid: `error PB, change NB`.
    fn cell(&self, terms: &[usize]) -> String {
        let pair = |(input, term): (usize, &usize)| {
            format!("{} {}", self.input(input), self.input_term(input, *term))
        };
        terms.iter().enumerate().map(pair).collect::<Vec<_>>().join(", ")
    }
}

/// The first few of many, joined: `a; b; and 12 more`.
fn first_few(all: impl ExactSizeIterator<Item = String>) -> String {
    const FEW: usize = 4;
    let more = all.len().saturating_sub(FEW);
    let mut shown: Vec<String> = all.take(FEW).collect();
    if more > 0 {
        shown.push(format!("and {more} more"));
    }
    shown.join("; ")
}

/// A number with its thing: `1 rule`, `2 rules`.
fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// A finding.
fn finding(mark: Mark, about: impl Into<String>, sentence: impl Into<String>) -> Finding {
    Finding { mark, about: about.into(), sentence: sentence.into() }
}
