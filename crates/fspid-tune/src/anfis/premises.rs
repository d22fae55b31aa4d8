//! The backward pass: positions and widths of the input sets, downhill.

use fspid_fuzzy::membership::Range;
use fspid_fuzzy::system::{GradientError, Membership, Parameter, Parts, System};

use super::data::Data;
use super::error::AnfisError;

/// How often the move of an input is halved before its sets stay where they are. A billionth of a move is none.
const HALVINGS: u32 = 30;

/// A number that moves, with the size that it is measured by.
#[derive(Clone, Copy, Debug)]
struct Mover {
    parameter: Parameter,
    /// Span of the input for places and widths, 1 over it for slopes, 1 for numbers without unit.
    size: f64,
}

/// What is learned by gradient descent.
#[derive(Clone, Debug)]
pub(super) struct Premises {
    /// For each input what moves of its sets.
    inputs: Vec<Vec<Mover>>,
    /// For each input its terms from left to right, those that have a place.
    orders: Vec<Vec<usize>>,
}

/// Errors of the answers and their slopes.
#[derive(Clone, Debug)]
pub(super) struct Slopes {
    /// Squared errors, summed over outputs and rows.
    pub(super) squared_error: f64,
    /// Slope of that sum with respect to everything that moves, per its size, input after input.
    slopes: Vec<f64>,
}

impl Slopes {
    /// Length of the steepest slope.
    pub(super) fn norm(&self) -> f64 {
        self.slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt()
    }
}

impl Premises {
    /// Those of a system, to be learned from such data.
    pub(super) fn of(parts: &Parts, data: &Data) -> Self {
        let mut inputs = vec![Vec::new(); parts.inputs.len()];
        for parameter in parts.parameters() {
            let Parameter::InputShape { input, .. } = parameter else { continue };
            if let (Some(list), Some(size)) = (inputs.get_mut(input), size(parts, data, parameter))
            {
                list.push(Mover { parameter, size });
            }
        }
        let orders = parts.inputs.iter().map(|input| {
            let place = |(term, found): (usize, &fspid_fuzzy::system::Term)| {
                place(&found.membership).map(|place| (term, place))
            };
            let mut places: Vec<_> = input.terms.iter().enumerate().filter_map(place).collect();
            places.sort_by(|one, other| one.1.total_cmp(&other.1));
            places.into_iter().map(|(term, _)| term).collect()
        });
        Self { inputs, orders: orders.collect() }
    }

    /// True where there is nothing to move.
    pub(super) fn is_empty(&self) -> bool {
        self.inputs.iter().all(Vec::is_empty)
    }

    /// Errors and slopes over the data.
    ///
    /// $$ \frac{\partial}{\partial p} \sum_k (y_k - t_k)^2 = \sum_k 2 (y_k - t_k) \frac{\partial y_k}{\partial p} $$
    ///
    /// # Errors
    /// A row that the system refuses or does not cover; answers without derivatives.
    pub(super) fn slopes(&self, system: &System, data: &Data) -> Result<Slopes, AnfisError> {
        let differentiator = system.differentiator();
        let all = differentiator.parameters();
        let movers: Vec<&Mover> = self.inputs.iter().flatten().collect();
        let positions: Vec<Option<usize>> = movers
            .iter()
            .map(|mover| all.iter().position(|&parameter| parameter == mover.parameter))
            .collect();
        let mut workspace = system.workspace();
        let mut found = Slopes { squared_error: 0.0, slopes: vec![0.0; movers.len()] };
        for row in data.rows() {
            for (output, target) in row.outputs.iter().enumerate() {
                let gradient = differentiator.gradient(row.inputs, output, &mut workspace);
                let gradient = gradient.map_err(|reason| match reason {
                    GradientError::NoAnswer => AnfisError::NotCovered { row: row.number },
                    GradientError::Input(reason) => AnfisError::Input { row: row.number, reason },
                    reason => AnfisError::Gradient { row: row.number, reason },
                })?;
                let error = gradient.value - target;
                found.squared_error += error * error;
                for ((slope, position), mover) in
                    found.slopes.iter_mut().zip(&positions).zip(&movers)
                {
                    let by = position.and_then(|position| gradient.parameters.get(position));
                    *slope += 2.0 * error * by.copied().unwrap_or(0.0) * mover.size;
                }
            }
        }
        Ok(found)
    }

    /// The parts with their sets moved downhill by `length`, measured in the sizes of what moves.
    ///
    /// $$ \Delta p = -k s_p g_p / \lVert g \rVert $$
    ///
    /// with the slope $g_p$ per size $s_p$. The sets of an input that would break a rule go half as far, and half again:
    /// a set stays a set, a width or slope keeps its sign, and terms stay in their order from left to right.
    pub(super) fn moved(&self, parts: &Parts, slopes: &Slopes, length: f64) -> Parts {
        let factor = -length / slopes.norm();
        let mut moved = parts.clone();
        let mut slopes = slopes.slopes.iter();
        for (index, movers) in self.inputs.iter().enumerate() {
            let steps: Vec<f64> =
                movers.iter().zip(&mut slopes).map(|(mover, g)| factor * g * mover.size).collect();
            self.move_input(&mut moved, parts, index, &steps);
        }
        moved
    }

    fn move_input(&self, moved: &mut Parts, from: &Parts, index: usize, steps: &[f64]) {
        let Some(movers) = self.inputs.get(index) else { return };
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            for (mover, step) in movers.iter().zip(steps) {
                if let Some(value) = from.parameter(mover.parameter) {
                    moved.set_parameter(mover.parameter, value + share * step);
                }
            }
            if self.is_allowed(moved, from, index) {
                return;
            }
            share *= 0.5;
        }
        if let (Some(place), Some(input)) = (moved.inputs.get_mut(index), from.inputs.get(index)) {
            place.clone_from(input);
        }
    }

    /// True if the sets of an input are sets of the same kind in the same order; sides that would cross are put
    /// together first.
    fn is_allowed(&self, moved: &mut Parts, from: &Parts, index: usize) -> bool {
        let (Some(input), Some(before), Some(order)) =
            (moved.inputs.get_mut(index), from.inputs.get(index), self.orders.get(index))
        else {
            return false;
        };
        let mut terms = input.terms.iter_mut().zip(&before.terms);
        if !terms.all(|(term, before)| is_set(&mut term.membership, &before.membership)) {
            return false;
        }
        let places = order.iter().map(|&term| place(&input.terms.get(term)?.membership));
        let places: Option<Vec<f64>> = places.collect();
        let old = |term: &usize| before.terms.get(*term).and_then(|term| place(&term.membership));
        // Terms in one place from the start have no order to be kept.
        places.is_some_and(|places| {
            places.windows(2).zip(order.windows(2)).all(|(places, terms)| {
                let [left, right] = terms else { return true };
                let apart = old(left) < old(right);
                !apart || matches!(places, [left, right] if left < right)
            })
        })
    }
}

/// What a parameter of an input is measured by; `None` for one that does not move.
fn size(parts: &Parts, data: &Data, parameter: Parameter) -> Option<f64> {
    let Parameter::InputShape { input, term, index } = parameter else { return None };
    let variable = parts.inputs.get(input).filter(|variable| variable.enabled)?;
    let Membership::Shape { kind, .. } = &variable.terms.get(term)?.membership else {
        return None;
    };
    let names = kind.params();
    let param = names.get(index % names.len().max(1))?;
    let is_finite = parts.parameter(parameter)?.is_finite();
    // Grades and directions are no places, and a foot at infinity stays there.
    if matches!(param.range, Range::Grade | Range::Sign) || !is_finite {
        return None;
    }
    let span = match variable.universe {
        Some(universe) => universe.span(),
        None => spread(data, input),
    };
    Some(match param.unit {
        "variable" => span,
        "1/variable" => 1.0 / span,
        _ => 1.0,
    })
}

/// Largest less smallest value of an input in the data; 1 where all are the same.
fn spread(data: &Data, input: usize) -> f64 {
    let values = data.rows().filter_map(|row| row.inputs.get(input).copied());
    let (least, most) = values
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| (x.min(least), x.max(most)));
    if most > least { most - least } else { 1.0 }
}

/// Where a set lies: the mean of its finite places.
fn place(membership: &Membership) -> Option<f64> {
    let Membership::Shape { kind, params, .. } = membership else { return None };
    let is_place = |range| matches!(range, Range::Finite | Range::Extended);
    let places = kind.params().iter().cycle().zip(params);
    let places = places.filter(|(param, value)| {
        param.unit == "variable" && is_place(param.range) && value.is_finite()
    });
    let (count, sum) =
        places.fold((0_u32, 0.0), |(count, sum), (_, place)| (count + 1, sum + place));
    (count > 0).then(|| sum / f64::from(count))
}

/// True for parameters that make a set of the same kind as before.
fn is_set(membership: &mut Membership, before: &Membership) -> bool {
    let (Membership::Shape { kind, params, .. }, Membership::Shape { params: old, .. }) =
        (membership, before)
    else {
        return true;
    };
    let names = kind.params();
    let are_places = names.iter().all(|param| {
        param.unit == "variable" && matches!(param.range, Range::Finite | Range::Extended)
    });
    if are_places && kind.check(params).is_err() {
        pool(params);
    }
    let mut signs = names.iter().cycle().zip(params.iter().zip(old));
    let keep = signs.all(|(param, (new, old))| {
        !matches!(param.range, Range::NonZero) || new.signum().total_cmp(&old.signum()).is_eq()
    });
    keep && kind.check(params).is_ok()
}

/// The nearest numbers in ascending order: neighbours that would cross meet in their middle.
///
/// # Source
/// Pooling adjacent violators: M. Ayer and others, An empirical distribution function for sampling with incomplete
/// information, Ann. Math. Statist. 26 (1955) 641.
fn pool(values: &mut [f64]) {
    let mut blocks: Vec<(f64, usize)> = Vec::with_capacity(values.len());
    for &value in values.iter() {
        let mut block = (value, 1);
        while let Some(&(last, count)) = blocks.last()
            && last > block.0
        {
            blocks.pop();
            let total = count + block.1;
            block = ((last * count as f64 + block.0 * block.1 as f64) / total as f64, total);
        }
        blocks.push(block);
    }
    let pooled = blocks.into_iter().flat_map(|(value, count)| std::iter::repeat_n(value, count));
    for (place, value) in values.iter_mut().zip(pooled) {
        *place = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_that_cross_meet_in_the_middle_and_others_stay() {
        let mut values = [1.0, 3.0, 2.0, 5.0];
        pool(&mut values);
        assert_eq!(values, [1.0, 2.5, 2.5, 5.0]);
        let mut values = [3.0, 2.0, 1.0];
        pool(&mut values);
        assert_eq!(values, [2.0; 3]);
        let mut values = [f64::NEG_INFINITY, 0.0, 1.0, f64::INFINITY];
        pool(&mut values);
        assert_eq!(values, [f64::NEG_INFINITY, 0.0, 1.0, f64::INFINITY]);
    }
}
