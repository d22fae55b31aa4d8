//! Panels that are refined until the bound of their integrals is small enough.

use super::gauss::{remainder, rule};
use super::panel::Panel;
use super::piece::change;
use super::{Curve, Moments, Span};
use crate::scalar::Interval;

/// Panels that wait for their turn. A refinement adds at most two, and the next one to be looked at
/// is at most half as wide, so that this holds all halvings down to neighbouring floats.
const WAITING: usize = 128;
/// No panel is asked to be better than this share of the tolerance, so that a few short ones around
/// kinks need not be shorter still.
const LEAST_SHARE: f64 = 1.0 / 64.0;
/// Panels no wider than this many of their bounds' last places are not refined.
const NARROWEST: f64 = 8.0;

/// The sum over the panels so far, and how well the rest has to be done.
pub(super) struct Work<'a, C> {
    pub(super) curve: &'a C,
    /// The error allowed for the whole area.
    pub(super) tolerance: f64,
    /// Width of the whole domain.
    pub(super) width: f64,
    /// Panels that may still be looked at.
    pub(super) panels_left: u32,
    pub(super) sum: Moments,
}

/// A stack of panels without a heap.
struct Waiting {
    panels: [Span; WAITING],
    count: usize,
}

impl Waiting {
    /// Room for what a refinement adds.
    const fn has_room(&self) -> bool {
        self.count + 3 <= WAITING
    }

    fn push(&mut self, span: Span) {
        if span.lower < span.upper {
            self.panels[self.count] = span;
            self.count += 1;
        }
    }

    fn pop(&mut self) -> Option<Span> {
        self.count = self.count.checked_sub(1)?;
        Some(self.panels[self.count])
    }
}

impl<C: Curve> Work<'_, C> {
    /// Adds the integrals over a span.
    pub(super) fn add(&mut self, span: Span) {
        let mut waiting = Waiting { panels: [span; WAITING], count: 0 };
        waiting.push(span);
        while let Some(panel) = waiting.pop() {
            let last_chance = self.panels_left == 0 || !waiting.has_room() || is_narrow(panel);
            self.panels_left = self.panels_left.saturating_sub(1);
            match self.integrals(panel, last_chance) {
                Some(integrals) => self.sum = self.sum + integrals,
                None => self.refine(panel, &mut waiting),
            }
        }
    }

    /// The integrals over a panel, if they are good enough or cannot be made better.
    fn integrals(&self, panel: Span, last_chance: bool) -> Option<Moments> {
        let enclosed = panel.enclosed(self.curve.at(panel.hull()));
        if last_chance || self.suffices(panel, enclosed) {
            return Some(enclosed);
        }
        None
    }

    /// True if the share of the panel in the error is small enough.
    fn suffices(&self, panel: Span, error: Moments) -> bool {
        let share = ((panel.upper - panel.lower) / self.width).max(LEAST_SHARE);
        let allowed = 0.5 * share * self.tolerance;
        error.area.radius() <= allowed && error.moment.radius() <= 0.5 * allowed * self.width
    }

    /// Integrates a smooth panel, or splits it: around a change of piece if one is found, else in the
    /// middle.
    fn refine(&mut self, panel: Span, waiting: &mut Waiting) {
        if let Some([left, right]) = change(self.curve, panel)
            && (left > panel.lower || right < panel.upper)
        {
            let mut sides = [(panel.lower, left), (right, panel.upper)];
            // The shorter one comes last and is looked at first, so that few panels wait.
            sides.sort_unstable_by(|one, other| (other.1 - other.0).total_cmp(&(one.1 - one.0)));
            for (lower, upper) in sides.into_iter().chain([(left, right)]) {
                waiting.push(Span { lower, upper, ..panel });
            }
            return;
        }
        if let Some(integrals) = self.smooth(panel) {
            self.sum = self.sum + integrals;
            return;
        }
        let middle = panel.hull().midpoint();
        waiting.push(Span { lower: middle, ..panel });
        waiting.push(Span { upper: middle, ..panel });
    }

    /// The integrals by the rule, if the remainder on the panel is small enough.
    fn smooth(&self, panel: Span) -> Option<Moments> {
        let function = self.curve.at(Panel::variable(panel.lower, panel.upper));
        let enclosed = panel.enclosed(function.range());
        if self.suffices(panel, enclosed) {
            return Some(enclosed);
        }
        let [before, last] = function.last_two()?;
        let error = remainder(panel, before, last);
        self.suffices(panel, error).then(|| rule(self.curve, panel) + error)
    }
}

/// True if a panel has hardly any floats inside.
fn is_narrow(panel: Span) -> bool {
    let bound = Interval::between(panel.lower, panel.upper).magnitude();
    panel.upper - panel.lower <= NARROWEST * (bound.next_up() - bound)
}
