//! Random systems, the same ones each time.

use fspid_fuzzy::membership::ShapeKind::{Gaussian, Trapezoid};
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{Antecedent, Conclusion, Membership, Parts};

use crate::system::build::{block, input, is, output, parts, rule, sets, shape, then};

/// Numbers by Knuth's linear congruential generator.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        let Self(state) = self;
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + self.unit() * (upper - lower)
    }

    fn trapezoid(&mut self, lower: f64, upper: f64) -> Membership {
        let slack = 0.2 * (upper - lower);
        let mut corners = [0.0; 4].map(|_: f64| self.between(lower - slack, upper + slack));
        corners.sort_by(f64::total_cmp);
        match self.below(5) {
            0 => corners[1] = corners[0],
            1 => corners[3] = corners[2],
            2 => corners[2] = corners[1],
            _ => {}
        }
        shape(Trapezoid, &corners)
    }

    fn gaussian(&mut self, lower: f64, upper: f64) -> Membership {
        let sigma = (upper - lower) * self.between(0.05, 0.3);
        shape(Gaussian, &[self.between(lower, upper), sigma])
    }

    /// Two inputs, one output, two to six rules with one or two statements.
    pub(crate) fn system(&mut self, curved: bool) -> Parts {
        let (lower, upper) = (self.between(-9.0, 0.0), self.between(1.0, 9.0));
        let inputs = (0..2).map(|_| {
            let terms = (0..3).map(|_| self.gaussian(lower, upper)).collect();
            input(lower, upper, terms)
        });
        let inputs = inputs.collect();
        let terms = 2 + self.below(4);
        let terms = (0..terms).map(|_| {
            if curved && self.below(2) == 0 {
                self.gaussian(lower, upper)
            } else {
                self.trapezoid(lower, upper)
            }
        });
        let terms: Vec<Conclusion> = sets(terms.collect());
        let count = terms.len();
        let rules = (0..2 + self.below(5)).map(|_| {
            let both = vec![is(0, self.below(3)), is(1, self.below(3))];
            let antecedent = match self.below(3) {
                0 => Antecedent::All(both),
                1 => Antecedent::Any(both),
                _ => is(self.below(2), self.below(3)),
            };
            rule(antecedent, then(0, self.below(count)))
        });
        let rules = block(rules.collect());
        let mut parts = parts(inputs, vec![output(lower, upper, terms)], vec![rules]);
        parts.blocks[0].implication =
            [TNormKind::Minimum, TNormKind::AlgebraicProduct][self.below(2)].into();
        let joins = [SNormKind::Maximum, SNormKind::UnboundedSum, SNormKind::BoundedSum];
        parts.outputs[0].aggregation = joins[self.below(3)].into();
        parts
    }

    /// A point in the universes of both inputs.
    pub(crate) fn point(&mut self, parts: &Parts) -> Vec<f64> {
        let universes: Vec<_> = parts.inputs.iter().filter_map(|input| input.universe).collect();
        universes.iter().map(|universe| self.between(universe.lower, universe.upper)).collect()
    }
}
