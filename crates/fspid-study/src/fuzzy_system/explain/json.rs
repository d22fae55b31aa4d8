//! An explanation for programs.

use serde_json::{Map, Value, json};

use super::Explanation;
use super::share::{Basis, Share, Shares};
use super::why_not::{Lack, WhyNot};
use crate::fuzzy_system::words;

impl Explanation<'_> {
    /// The answers, the rules by strength, and the share of each in every output. Blocks and rules
    /// are numbered from 1.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut whole = self.asked.json();
        let rules = self.rules.iter().map(|firing| {
            let mut rule = self.rule_json([firing.block, firing.rule]);
            rule["strength"] = json!(firing.strength);
            rule["acting"] = json!(firing.acting);
            rule
        });
        whole["rules"] = rules.collect();
        let outputs = self.system().parts().outputs.iter().zip(&self.shares).enumerate();
        let shares: Map<String, Value> = outputs
            .map(|(index, (output, shares))| (output.name.clone(), self.shares_json(index, shares)))
            .collect();
        whole["shares"] = Value::Object(shares);
        if let Some(why_not) = &self.why_not {
            whole["why_not"] = self.why_not_json(why_not);
        }
        whole
    }

    fn rule_json(&self, [block, rule]: [usize; 2]) -> Value {
        let parts = self.system().parts();
        let found = parts.blocks.get(block).and_then(|block| block.rules.get(rule));
        let text = found.map_or(String::new(), |rule| words::rule(rule, parts));
        let name = found.map_or("", |rule| rule.name.as_str());
        let mut value = json!({ "block": block + 1, "rule": rule + 1, "text": text });
        if !name.is_empty() {
            value["name"] = json!(name);
        }
        value
    }

    fn term(&self, output: usize, term: usize) -> &str {
        let output = self.system().parts().outputs.get(output);
        output.and_then(|output| output.terms.get(term)).map_or("", |term| &term.name)
    }

    fn shares_json(&self, output: usize, shares: &Shares) -> Value {
        let basis = match shares.basis {
            Basis::Outline => "outline",
            Basis::Grid(_) => "grid",
            Basis::Weights => "weights",
            Basis::Joined => "joined",
        };
        let one = |share: &Share| {
            let [block, rule, _] = share.of.origin;
            let part = if shares.basis == Basis::Weights { "weight_share" } else { "area_share" };
            json!({
                "block": block + 1, "rule": rule + 1, "term": self.term(output, share.of.term),
                "degree": share.of.degree, part: share.part, "contribution": share.contribution,
            })
        };
        let polygon = shares.pieces.iter().flat_map(|piece| {
            [0, 1].map(|end: usize| [piece.x.get(end).copied(), piece.grade.get(end).copied()])
        });
        let list: Vec<Value> = shares.list.iter().map(one).collect();
        let mut value = json!({ "basis": basis, "sum": shares.sum, "rules": list });
        if self.asked.workspace().interval(output).is_some() {
            value["of"] = json!("upper sets");
        }
        if shares.basis == Basis::Outline {
            value["polygon"] = json!(polygon.collect::<Vec<_>>());
        }
        value
    }

    fn why_not_json(&self, why_not: &WhyNot) -> Value {
        let parts = self.system().parts();
        let one = |lack: &Lack| {
            let statements = lack.statements.iter().enumerate().map(|(index, (found, grade))| {
                let text = words::statement(found, parts);
                json!({ "text": text, "grade": grade, "limits": lack.limit == Some(index) })
            });
            let mut rule = self.rule_json(lack.rule);
            rule["enabled"] = json!(lack.enabled);
            rule["strength"] = json!(lack.strength);
            rule["acting"] = json!(lack.acting);
            rule["statements"] = statements.collect();
            rule
        };
        json!({
            "output": parts.outputs.get(why_not.output).map(|output| &output.name),
            "term": self.term(why_not.output, why_not.term),
            "rules": why_not.rules.iter().map(one).collect::<Vec<_>>(),
        })
    }
}
