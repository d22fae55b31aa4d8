//! Why a term was not concluded: which rules could, and what each of them lacks.

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{
    Antecedent, Firing, Membership, RuleBlock, Statement, System, Variable, Workspace,
};

use fspid_diagnostics::known_words;
use fspid_scenario::supervisor::Refused;

/// A rule that could conclude the term.
#[derive(Clone, Debug, PartialEq)]
pub struct Lack {
    /// Block and position of the rule.
    pub rule: [usize; 2],
    /// Whether the rule and its block are switched on.
    pub enabled: bool,
    /// Strength of its antecedent times its weight.
    pub strength: f64,
    /// The strength with which it acts.
    pub acting: f64,
    /// Every statement of its antecedent, with its grade.
    pub statements: Vec<(Statement, f64)>,
    /// Which of them holds the strength down; `None` for a rule without a condition.
    pub limit: Option<usize>,
}

/// Why a term was not concluded.
#[derive(Clone, Debug, PartialEq)]
pub struct WhyNot {
    /// Position of the output.
    pub output: usize,
    /// Position of the term.
    pub term: usize,
    /// The rules that could conclude it, the strongest first.
    pub rules: Vec<Lack>,
}

/// The positions of `output=term`.
pub(super) fn conclusion(system: &System, text: &str) -> Result<(usize, usize), Refused> {
    let outputs = &system.parts().outputs;
    let names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
    let Some((output, term)) = text.split_once('=') else {
        let example = names.first().copied().unwrap_or("output");
        return Err(Refused::one(format!("`{text}` is no OUTPUT=TERM, such as {example}=…")));
    };
    let output = position("output", output.trim(), &names)?;
    let terms = outputs.get(output).map_or(&[][..], |output| &output.terms);
    let terms: Vec<&str> = terms.iter().map(|term| term.name.as_str()).collect();
    Ok((output, position("term", term.trim(), &terms)?))
}

fn position(what: &str, name: &str, known: &[&str]) -> Result<usize, Refused> {
    let found = known.iter().position(|known| *known == name);
    found.ok_or_else(|| {
        Refused::one(format!("there is no {what} `{name}`{}", known_words(name, known)))
    })
}

/// Why a term was not concluded in the last evaluation.
pub(super) fn why_not(
    system: &System,
    (output, term): (usize, usize),
    workspace: &mut Workspace,
) -> WhyNot {
    let parts = system.parts();
    let firings: Vec<Firing> = system.firings(workspace).collect();
    let concludes = |consequent: &fspid_fuzzy::system::Consequent| {
        consequent.output == output && consequent.term == term
    };
    let mut rules = Vec::new();
    for (number, block) in parts.blocks.iter().enumerate() {
        for (index, rule) in block.rules.iter().enumerate() {
            if !rule.consequents.iter().any(concludes) {
                continue;
            }
            let firing = firings.iter().find(|f| [f.block, f.rule] == [number, index]);
            let mut grader =
                Grader { system, block, at: [number, index], workspace, found: Vec::new() };
            let (_, limit) = grader.antecedent(&rule.antecedent);
            rules.push(Lack {
                rule: [number, index],
                enabled: firing.is_some(),
                strength: firing.map_or(0.0, |firing| firing.strength),
                acting: firing.map_or(0.0, |firing| firing.acting),
                statements: grader.found,
                limit,
            });
        }
    }
    rules.sort_by(|a, b| b.acting.total_cmp(&a.acting).then(b.strength.total_cmp(&a.strength)));
    WhyNot { output, term, rules }
}

/// Grades the statements of one rule.
struct Grader<'a> {
    system: &'a System,
    block: &'a RuleBlock,
    /// Block and position of the rule.
    at: [usize; 2],
    workspace: &'a mut Workspace,
    found: Vec<(Statement, f64)>,
}

impl Grader<'_> {
    /// The grade of an antecedent, and the statement that holds it down: of an *and* the lowest
    /// part, of an *or* the highest.
    fn antecedent(&mut self, antecedent: &Antecedent) -> (f64, Option<usize>) {
        match antecedent {
            Antecedent::Always => (1.0, None),
            Antecedent::Is(statement) => {
                let grade = self.statement(statement);
                self.found.push((statement.clone(), grade));
                (grade, Some(self.found.len() - 1))
            }
            Antecedent::Not(part) => {
                let (grade, limit) = self.antecedent(part);
                (1.0 - grade, limit)
            }
            Antecedent::All(parts) => {
                let graded: Vec<_> = parts.iter().map(|part| self.antecedent(part)).collect();
                let joined = graded.iter().map(|part| part.0);
                let joined = joined.reduce(|a, b| self.block.and.apply(a, b)).unwrap_or(1.0);
                let lowest = graded.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
                (joined, lowest.and_then(|part| part.1))
            }
            Antecedent::Any(parts) => {
                let graded: Vec<_> = parts.iter().map(|part| self.antecedent(part)).collect();
                let joined = graded.iter().map(|part| part.0);
                let joined = joined.reduce(|a, b| self.block.or.apply(a, b)).unwrap_or(1.0);
                let highest = graded.into_iter().rev().max_by(|a, b| a.0.total_cmp(&b.0));
                (joined, highest.and_then(|part| part.1))
            }
        }
    }

    fn statement(&mut self, statement: &Statement) -> f64 {
        let grade = match (statement.variable, statement.term) {
            (_, None) => 1.0,
            (Variable::Input(input), Some(term)) => self.of_input(input, term),
            (Variable::Output(output), Some(term)) => self.of_output(output, term),
        };
        statement.hedges.iter().rev().fold(grade, |grade, hedge: &Hedge| hedge.apply(grade))
    }

    fn of_input(&self, input: usize, term: usize) -> f64 {
        let inputs = self.workspace.variables();
        let part = self.system.parts().inputs.get(input).filter(|part| part.enabled);
        let set = part.and_then(|part| part.terms.get(term)).map(|term| &term.membership);
        let (Some(set), Some(&x)) = (set, inputs.get(input)) else { return 0.0 };
        let parameters = if let Membership::Shape { params, .. } = set { params.len() } else { 0 };
        let mut room = vec![0.0; parameters.max(inputs.len() + 1)];
        set.grade(x, inputs, &mut room)
    }

    /// How strongly the rules before have concluded a term.
    fn of_output(&mut self, output: usize, term: usize) -> f64 {
        let Some(part) = self.system.parts().outputs.get(output) else { return 0.0 };
        let concluded = self.system.contributions(output, self.workspace);
        let before = concluded
            .iter()
            .filter(|found| found.term == term && [found.origin[0], found.origin[1]] < self.at);
        before.fold(0.0, |joined, found| part.aggregation.apply(joined, found.degree))
    }
}
