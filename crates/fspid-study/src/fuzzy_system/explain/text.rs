//! An explanation for people.

use super::Explanation;
use super::share::{Basis, Shares};
use super::why_not::{Lack, WhyNot};
use crate::fuzzy_system::{answer, words};

/// Most rules that are listed.
const MOST: usize = 20;
/// Shares below this are only counted.
const SMALL: f64 = 5e-5;

impl Explanation<'_> {
    /// The answers, the rules by strength, and the share of each in every output.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = self.asked.text();
        self.rules_in_words(&mut out);
        for (index, shares) in self.shares.iter().enumerate() {
            self.shares_in_words(index, shares, &mut out);
        }
        if let Some(why_not) = &self.why_not {
            self.why_not_in_words(why_not, &mut out);
        }
        out
    }

    /// A rule in words.
    fn rule(&self, block: usize, rule: usize) -> String {
        let parts = self.system().parts();
        let found = parts.blocks.get(block).and_then(|block| block.rules.get(rule));
        found.map_or(String::new(), |rule| words::rule(rule, parts))
    }

    fn rule_name(&self, block: usize, rule: usize) -> String {
        words::name(self.system().parts(), block, rule)
    }

    fn rules_in_words(&self, out: &mut String) {
        if self.rules.is_empty() {
            out.push_str("\nno rule fires\n");
            return;
        }
        out.push_str("\nrules by strength\n");
        for firing in self.rules.iter().take(MOST) {
            let name = self.rule_name(firing.block, firing.rule);
            let text = self.rule(firing.block, firing.rule);
            let idle =
                if firing.acting > 0.0 { "" } else { "  (left out by the block's activation)" };
            let strength = grade(firing.strength);
            out.push_str(&format!("  {strength}  {name}: {text}{idle}\n"));
        }
        let more = self.rules.len().saturating_sub(MOST);
        if more > 0 {
            out.push_str(&format!("  and {more} more\n"));
        }
    }

    fn shares_in_words(&self, index: usize, shares: &Shares, out: &mut String) {
        let Some(output) = self.system().parts().outputs.get(index) else { return };
        let (name, what) = (&output.name, kind_of(shares.basis));
        out.push_str(&format!("\nshares in {name}{what}\n"));
        let shown = |part: f64| part.abs() >= SMALL;
        for share in shares.list.iter().filter(|share| shown(share.part)) {
            let [block, rule, _] = share.of.origin;
            let term = output.terms.get(share.of.term).map_or("", |term| &term.name);
            let (part, contribution) = (100.0 * share.part, share.contribution);
            let rule = self.rule_name(block, rule);
            let contribution =
                contribution.map_or("no number".to_owned(), |it| format!("{it:+.6}"));
            out.push_str(&format!("  {part:6.2} %  {contribution:>9}  {rule}: {term}\n"));
        }
        let small = shares.list.iter().filter(|share| !shown(share.part)).count();
        if small > 0 {
            out.push_str(&format!("  and {small} that fire without a part of at least 0.005 %\n"));
        }
        if let Some(sum) = shares.sum {
            out.push_str(&format!("  100.00 %  {sum:+.6}  together\n"));
            self.difference(index, sum, out);
        }
    }

    /// Why the answer is not what the shares sum to, where it is not.
    fn difference(&self, index: usize, sum: f64, out: &mut String) {
        let output = self.system().parts().outputs.get(index);
        let answer = self.asked.workspace().answers().get(index);
        let (Some(output), Some(value)) = (output, answer.and_then(|answer| answer.value)) else {
            return;
        };
        if (value - sum).abs() <= 1e-9 * value.abs().max(1.0) {
            return;
        }
        let why = match self.asked.workspace().interval(index) {
            Some(_) => {
                "is the middle of an interval; the shares are those of the upper sets".into()
            }
            None => format!("is computed by {}", answer::rule(output)),
        };
        out.push_str(&format!("  the answer, {value:.6}, {why}\n"));
    }

    fn why_not_in_words(&self, why_not: &WhyNot, out: &mut String) {
        let output = self.system().parts().outputs.get(why_not.output);
        let term = output.and_then(|output| output.terms.get(why_not.term));
        let (output, term) =
            (output.map_or("", |output| &output.name), term.map_or("", |term| &term.name));
        out.push_str(&format!("\nwhy not {output} = {term}\n"));
        if why_not.rules.is_empty() {
            out.push_str("  no rule concludes it\n");
        }
        for lack in why_not.rules.iter().take(MOST) {
            self.lack_in_words(lack, out);
        }
        let more = why_not.rules.len().saturating_sub(MOST);
        if more > 0 {
            out.push_str(&format!("  and {more} weaker rules\n"));
        }
    }

    fn lack_in_words(&self, lack: &Lack, out: &mut String) {
        let [block, rule] = lack.rule;
        let (name, text) = (self.rule_name(block, rule), self.rule(block, rule));
        out.push_str(&format!("  {}  {name}: {text}\n", grade(lack.strength)));
        if !lack.enabled {
            out.push_str("            it is switched off\n");
        } else if lack.acting <= 0.0 && lack.strength > 0.0 {
            out.push_str("            the block's activation leaves it out\n");
        }
        for (index, (statement, found)) in lack.statements.iter().enumerate() {
            let text = words::statement(statement, self.system().parts());
            let limit = if lack.limit == Some(index) { "  <- holds it down" } else { "" };
            out.push_str(&format!("            {}  {text}{limit}\n", grade(*found)));
        }
    }
}

/// A grade in eight characters; one that six decimals would hide, as a power of ten.
fn grade(grade: f64) -> String {
    if grade > 0.0 && grade < 5e-7 { format!("{grade:8.1e}") } else { format!("{grade:.6}") }
}

fn kind_of(basis: Basis) -> String {
    match basis {
        Basis::Outline => {
            ": part of the area, and what it adds to the centre of gravity".to_owned()
        }
        Basis::Grid(cells) => {
            format!(
                ": part of the area, and what it adds to the centre of gravity, on {cells} cells"
            )
        }
        Basis::Weights => ": part of the weight, and what it adds to the answer".to_owned(),
        Basis::Aggregated => {
            ": the conclusions are joined so that no part belongs to one rule alone".to_owned()
        }
    }
}
