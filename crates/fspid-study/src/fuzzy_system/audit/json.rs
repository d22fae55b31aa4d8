//! An audit for programs: findings in sentences, and every proved number.

use fspid_fuzzy::audit::{AlongInput, Extreme, OutputSurface, Statement, Symmetry};
use serde_json::{Map, Value, json};

use super::{Audit, Mark};
use crate::json::{finite_all, merged, present};

impl Audit<'_> {
    /// The audit as JSON. Every pair of numbers is a proved lower and upper bound; one that is `"infinite"` or
    /// `"-infinite"` says that none was proved.
    #[must_use]
    pub fn json(&self) -> Value {
        let parts = self.system.parts();
        let chapters: Map<String, Value> = self
            .chapters()
            .into_iter()
            .map(|chapter| {
                let findings = chapter.findings.into_iter().map(|found| {
                    json!({ "mark": mark(found.mark), "about": found.about, "sentence": found.sentence })
                });
                (chapter.title, findings.collect())
            })
            .collect();
        let outputs = parts.outputs.iter().zip(&self.surface.outputs);
        let outputs: Map<String, Value> =
            outputs.map(|(output, found)| (output.name.clone(), self.output(found))).collect();
        json!({
            "system": parts.name,
            "domain": self.named(&self.surface.domain),
            "rest": self.named(&self.surface.rest),
            "findings": chapters,
            "outputs": outputs,
            "rules": {
                "count": self.rules.rules,
                "contradictions": self.rules.contradictions.len(),
                "duplicates": self.rules.duplicates.len(),
                "redundant": self.rules.redundant.len(),
            },
            "boxes": self.surface.boxes,
        })
    }

    /// Something for each input, by its name.
    fn named<T: serde::Serialize>(&self, list: &[T]) -> Value {
        let inputs = self.system.parts().inputs.iter().zip(list);
        Value::Object(inputs.map(|(input, found)| (input.name.clone(), json!(found))).collect())
    }

    fn output(&self, found: &OutputSurface) -> Value {
        let along: Map<String, Value> = found
            .along
            .iter()
            .enumerate()
            .map(|(input, along)| (self.input(input).to_owned(), self.along(along)))
            .collect();
        json!({
            "least": self.extreme(&found.least),
            "most": self.extreme(&found.most),
            "at_rest": finite_all(&found.at_rest),
            "coverage": {
                "least": self.extreme(&found.coverage.least),
                "everywhere": statement(&found.coverage.statement),
            },
            "may_fall_back": found.may_fall_back,
            "along": along,
            "odd": self.symmetry(&found.odd),
            "even": self.symmetry(&found.even),
        })
    }

    fn extreme(&self, extreme: &Extreme) -> Value {
        json!({ "bounds": finite_all(&extreme.bounds), "at": self.named(&extreme.at), "settled": extreme.settled })
    }

    fn symmetry(&self, symmetry: &Symmetry) -> Value {
        json!({
            "departure": self.extreme(&symmetry.departure),
            "holds": statement(&symmetry.statement),
        })
    }

    fn along(&self, along: &AlongInput) -> Value {
        let monotone = &along.monotone;
        let counterexample = match &monotone.statement {
            Statement::Refuted(found) => Some(json!({
                "from": self.named(&found.from), "to": self.named(&found.to), "change": finite_all(&found.change),
            })),
            Statement::Proved | Statement::Open => None,
        };
        merged([
            json!({
                "least_slope": finite_all(&along.least_slope.bounds),
                "most_slope": finite_all(&along.most_slope.bounds),
                "lipschitz": finite_all(&along.lipschitz),
                "slope_at_rest": finite_all(&along.slope_at_rest),
                "sector": along.sector.iter().map(|end| finite_all(&end.bounds)).collect::<Vec<_>>(),
                "rises": monotone.rises,
                "monotone": statement(&monotone.statement),
                "wrong_share": monotone.wrong_share,
                "wrong_slope": finite_all(&monotone.worst),
            }),
            present(json!({ "counterexample": counterexample })),
        ])
    }
}

const fn mark(mark: Mark) -> &'static str {
    match mark {
        Mark::Holds => "holds",
        Mark::Worth => "worth-knowing",
        Mark::NotMeant => "not-meant",
        Mark::Open => "open",
    }
}

const fn statement<W>(statement: &Statement<W>) -> &'static str {
    match statement {
        Statement::Proved => "proved",
        Statement::Refuted(_) => "refuted",
        Statement::Open => "open",
    }
}
