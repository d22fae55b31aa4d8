//! An explanation as a drawing for each output.

use std::collections::BTreeMap;

use fspid_fuzzy::system::{Conclusion, Membership, Output, Universe};

use super::share::{Share, Shares};
use super::{Basis, Explanation};
use crate::fuzzy_system::words;
use fspid_plot::{ConclusionFigure, Part, Svg};

/// Rules that are drawn each in a colour of its own.
const OWN_COLOUR: usize = 6;
/// Smallest part that has a colour of its own.
const SEEN: f64 = 5e-4;
/// Points of a curved set.
const POINTS: u32 = 200;

impl Explanation<'_> {
    /// A drawing for each output, with the output's name: the sets, what each rule has in the
    /// joined one, and the answer.
    #[must_use]
    pub fn figures(&self) -> Vec<(&str, Svg)> {
        let outputs = self.system().parts().outputs.iter().zip(&self.shares);
        let answers = self.asked.workspace().answers();
        outputs
            .zip(answers)
            .map(|((output, shares), answer)| {
                let range = output.universe.filter(|_| shares.basis != Basis::Weights);
                let figure = ConclusionFigure {
                    title: format!("{} at {}", output.name, self.inputs_in_words()),
                    x_label: output.name.clone(),
                    range: range.map(|Universe { lower, upper }| (lower, upper)),
                    sets: range.map_or_else(Vec::new, |range| self.sets(output, range)),
                    parts: self.parts(output, shares),
                    answer: answer.value,
                };
                (output.name.as_str(), figure.render())
            })
            .collect()
    }

    fn inputs_in_words(&self) -> String {
        let inputs = self.system().parts().inputs.iter().zip(self.asked.workspace().inputs());
        let pairs: Vec<String> =
            inputs.map(|(input, value)| format!("{} = {value}", input.name)).collect();
        pairs.join(", ")
    }

    /// The sets of an output as lines.
    fn sets(&self, output: &Output, range: Universe) -> Vec<(String, Vec<(f64, f64)>)> {
        let inputs = self.asked.workspace().variables();
        let drawn = output.terms.iter().filter_map(|term| match &term.conclusion {
            Conclusion::Set { membership, .. } => {
                Some((term.name.clone(), line(membership, range, inputs)))
            }
            _ => None,
        });
        drawn.collect()
    }

    fn parts(&self, output: &Output, shares: &Shares) -> Vec<Part> {
        if shares.list.is_empty() {
            let pieces = shares.pieces.iter().map(|piece| (piece.x, piece.grade)).collect();
            let name = "all rules together".to_owned();
            return vec![Part { name, pieces, stems: Vec::new() }];
        }
        let mut pieces: BTreeMap<usize, Vec<_>> = BTreeMap::new();
        for piece in &shares.pieces {
            let own = pieces.entry(piece.conclusion.unwrap_or(usize::MAX)).or_default();
            own.push((piece.x, piece.grade));
        }
        let mut part = |share: &Share| Part {
            name: self.share_in_words(output, share),
            pieces: pieces.remove(&share.of.conclusion).unwrap_or_default(),
            stems: share.of.value.map(|value| (value, share.of.degree)).into_iter().collect(),
        };
        let with_a_part = shares.list.iter().filter(|share| share.part > 0.0);
        let is_seen = |share: &&Share| share.part >= SEEN;
        let own = with_a_part.clone().filter(is_seen).take(OWN_COLOUR).count();
        let mut all: Vec<Part> = with_a_part.map(&mut part).collect();
        let others = all.split_off(own);
        if !others.is_empty() {
            let plural = if others.len() == 1 { "" } else { "s" };
            let name = format!("{} other rule{plural}", others.len());
            let (pieces, stems): (Vec<_>, Vec<_>) =
                others.into_iter().map(|part| (part.pieces, part.stems)).unzip();
            all.push(Part { name, pieces: pieces.concat(), stems: stems.concat() });
        }
        all
    }

    fn share_in_words(&self, output: &Output, share: &Share) -> String {
        let [block, rule, _] = share.of.origin;
        let term = output.terms.get(share.of.term).map_or("", |term| &term.name);
        let name = words::name(self.system().parts(), block, rule);
        format!("{name}: {term}, {:.1} %", 100.0 * share.part)
    }
}

/// A set as a line: through its corners, or through many points if it is curved.
fn line(membership: &Membership, range: Universe, inputs: &[f64]) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    if let Membership::Shape { kind, params, height } = membership
        && kind.is_piecewise_linear()
    {
        kind.vertices(params, &mut |vertex| points.push((vertex.x, vertex.grade * height)));
        let level = |point: Option<&(f64, f64)>| point.map_or(0.0, |point| point.1);
        let (first, last) = (level(points.first()), level(points.last()));
        points.insert(0, (range.lower.min(points.first().map_or(range.lower, |p| p.0)), first));
        points.push((range.upper.max(points.last().map_or(range.upper, |p| p.0)), last));
        return points;
    }
    let parameters =
        if let Membership::Shape { params, .. } = membership { params.len() } else { 0 };
    let mut room = vec![0.0; parameters.max(inputs.len() + 1)];
    for n in 0..=POINTS {
        let x = range.lower + range.span() * (f64::from(n) / f64::from(POINTS));
        points.push((x, membership.grade(x, inputs, &mut room)));
    }
    points
}
