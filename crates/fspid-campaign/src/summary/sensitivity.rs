//! What failing and measures depend on.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::SummaryError;
use super::data::{Influence, Sensitivity, SensitivityTarget};
use super::source::Source;
use crate::rows::PARAMETER;
use crate::statistics::rank::{Correlation, ranks, spearman_of_ranks};
use crate::statistics::share::{Classes, Share};
use crate::table::Values;

/// What was drawn for the first runs.
pub(super) struct Factors {
    factors: Vec<Factor>,
    all: u64,
    used: usize,
}

/// What was drawn of one parameter.
struct Factor {
    name: String,
    /// Numbers, or numbers of texts in the order in which they first came; NaN where nothing was drawn.
    values: Vec<f64>,
    is_text: bool,
    texts: Texts,
}

/// Which flights have a value, and the parameters of those ready for comparison.
///
/// Most measures are missing in the same flights, and what a parameter's ranks and classes are depends on the
/// flights alone.
struct Selection {
    present: Vec<bool>,
    factors: Vec<Ready>,
}

/// A parameter, for some flights.
struct Ready {
    /// Which of those flights have a number of it; `None` for all.
    drawn: Option<Vec<bool>>,
    ranks: Option<Vec<f64>>,
    classes: Option<Classes>,
}

/// The selections of one controller that are likely to come again.
#[derive(Default)]
pub(super) struct Selections {
    all: Option<Arc<Selection>>,
    last: Option<Arc<Selection>>,
}

/// Numbers for texts: the same number for the same text.
#[derive(Default)]
struct Texts(BTreeMap<String, f64>);

impl Texts {
    fn number(&mut self, text: &str) -> f64 {
        if let Some(number) = self.0.get(text) {
            return *number;
        }
        let number = self.0.len() as f64;
        self.0.insert(text.to_owned(), number);
        number
    }
}

impl Factors {
    /// Reads the parameters of the first runs; all controllers of a run have the same.
    pub(super) fn read(source: &Source) -> Result<Self, SummaryError> {
        let used = source.runs.min(source.first_runs);
        let parameters = &source.head.parameters;
        let factors = parameters.iter().map(|it| Factor::read(source, &it.name, used));
        let factors = factors.collect::<Result<_, _>>()?;
        Ok(Self { factors, all: source.head.runs, used })
    }

    /// With what was drawn for later runs.
    pub(super) fn append(&mut self, later: Self) {
        self.used += later.used;
        self.factors.iter_mut().zip(later.factors).for_each(|(mine, theirs)| mine.append(theirs));
    }

    /// The same, of so many runs in all.
    pub(super) fn of_runs(self, all: u64) -> Self {
        Self { all, ..self }
    }

    /// What a column depends on, given for the runs that were read, NaN where a flight has none of it.
    pub(super) fn sensitivity(
        &self,
        selections: &mut Selections,
        of: SensitivityTarget,
        column: &[f64],
    ) -> Sensitivity {
        let present: Vec<bool> = column.iter().map(|value| value.is_finite()).collect();
        let selection = selections.of(present, self);
        let values: Vec<f64> = column.iter().copied().filter(|value| value.is_finite()).collect();
        let value_ranks = ranks(&values);
        let influences = self.factors.par_iter().zip(&selection.factors).map(|(factor, ready)| {
            let correlation = ready.correlation(&values, &value_ranks);
            let share = ready.share(&values);
            let p = ready.chance(&values, &value_ranks);
            Influence { parameter: factor.name.clone(), correlation, share, p }
        });
        Sensitivity {
            of,
            used: values.len() as u64,
            runs_used: self.used as u64,
            runs: self.all,
            influences: influences.collect(),
        }
    }
}

impl Factor {
    fn read(source: &Source, name: &str, runs: usize) -> Result<Self, SummaryError> {
        let of_run = source.controllers().max(1);
        let (mut values, mut texts, mut is_text) =
            (Vec::with_capacity(runs), Texts::default(), false);
        let mut row = 0;
        let column = format!("{PARAMETER}{name}");
        for cells in source.files.column(&column)? {
            let cells = cells?;
            is_text = matches!(cells, Values::Text(_));
            let first = (0..cells.len()).filter(|index| (row + index) % of_run == 0);
            match &cells {
                Values::Float(cells) => values.extend(first.map(|index| number(cells, index))),
                Values::Integer(cells) => values.extend(first.map(|index| number(cells, index))),
                Values::Boolean(cells) => values.extend(first.map(|index| number(cells, index))),
                Values::Text(cells) => values.extend(first.map(|index| {
                    let text = cells.get(index).and_then(Option::as_deref);
                    text.map_or(f64::NAN, |text| texts.number(text))
                })),
            }
            row += cells.len();
            if values.len() >= runs {
                break;
            }
        }
        values.truncate(runs);
        Ok(Self { name: name.to_owned(), values, is_text, texts })
    }

    /// With the values of later runs, whose texts get the numbers that they have here.
    fn append(&mut self, later: Self) {
        let mut names: Vec<(f64, String)> =
            later.texts.0.into_iter().map(|(text, number)| (number, text)).collect();
        names.sort_by(|one, other| one.0.total_cmp(&other.0));
        let here: Vec<f64> = names.iter().map(|(_, text)| self.texts.number(text)).collect();
        let value = |value: f64| match later.is_text {
            true if value.is_finite() => here.get(value as usize).copied().unwrap_or(f64::NAN),
            _ => value,
        };
        self.is_text |= later.is_text;
        self.values.extend(later.values.into_iter().map(value));
    }

    /// The parameter of the flights that are present.
    fn ready(&self, present: &[bool]) -> Ready {
        let values = selected(&self.values, present);
        let is_drawn: Vec<bool> = values.iter().map(|value| value.is_finite()).collect();
        let all = is_drawn.iter().all(|&drawn| drawn);
        let values = if all { values } else { selected(&values, &is_drawn) };
        Ready {
            ranks: (!self.is_text).then(|| ranks(&values)),
            classes: self.classes(&values),
            drawn: (!all).then_some(is_drawn),
        }
    }

    /// Classes of nearly the same value, or of the same text.
    fn classes(&self, values: &[f64]) -> Option<Classes> {
        let classes = Classes::of(values)?;
        // More texts than classes would be put together by their order, which means nothing.
        let most = values.len().isqrt();
        let has_room = |highest: f64| distinct(values, highest as usize + 1) <= most;
        let highest = values.iter().copied().reduce(|a, b| if b > a { b } else { a });
        (!self.is_text || highest.is_some_and(has_room)).then_some(classes)
    }
}

/// How many of the numbers 0, 1, … up to below `most` occur.
fn distinct(values: &[f64], most: usize) -> usize {
    let mut seen = vec![false; most];
    for value in values {
        if let Some(seen) = seen.get_mut(*value as usize) {
            *seen = true;
        }
    }
    seen.iter().filter(|&&seen| seen).count()
}

/// A cell as a number; NaN if there is none.
fn number<T: Copy + IntoNumber>(cells: &[Option<T>], index: usize) -> f64 {
    cells.get(index).copied().flatten().map_or(f64::NAN, IntoNumber::into_number)
}

/// What a cell is as a number.
trait IntoNumber {
    fn into_number(self) -> f64;
}

impl IntoNumber for f64 {
    fn into_number(self) -> f64 {
        self
    }
}

impl IntoNumber for i64 {
    fn into_number(self) -> f64 {
        self as f64
    }
}

impl IntoNumber for bool {
    fn into_number(self) -> f64 {
        f64::from(u8::from(self))
    }
}

fn selected(values: &[f64], present: &[bool]) -> Vec<f64> {
    let pairs = values.iter().zip(present);
    pairs.filter(|(_, present)| **present).map(|(value, _)| *value).collect()
}

impl Selections {
    /// The selection of the flights that are present, from memory if it was the last one or that of all flights.
    fn of(&mut self, present: Vec<bool>, factors: &Factors) -> Arc<Selection> {
        let kept = [&self.all, &self.last].into_iter().flatten();
        if let Some(same) = kept.into_iter().find(|kept| kept.present == present) {
            return Arc::clone(same);
        }
        let place =
            if present.iter().all(|&present| present) { &mut self.all } else { &mut self.last };
        // The old one is dropped before the new one is made.
        *place = None;
        let ready = factors.factors.par_iter().map(|factor| factor.ready(&present)).collect();
        let selection = Arc::new(Selection { present, factors: ready });
        *place = Some(Arc::clone(&selection));
        selection
    }
}

impl Ready {
    fn correlation(&self, values: &[f64], value_ranks: &[f64]) -> Option<Correlation> {
        let mine = self.ranks.as_ref()?;
        match &self.drawn {
            None => spearman_of_ranks(mine, value_ranks),
            Some(drawn) => spearman_of_ranks(mine, &ranks(&selected(values, drawn))),
        }
    }

    fn share(&self, values: &[f64]) -> Option<Share> {
        let classes = self.classes.as_ref()?;
        match &self.drawn {
            None => classes.share_of(values),
            Some(drawn) => classes.share_of(&selected(values, drawn)),
        }
    }

    fn chance(&self, values: &[f64], value_ranks: &[f64]) -> Option<f64> {
        let classes = self.classes.as_ref()?;
        match &self.drawn {
            None => classes.chance_of(value_ranks),
            Some(drawn) => classes.chance_of(&ranks(&selected(values, drawn))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{rank::spearman, share::first_order};

    fn factor(values: Vec<f64>, is_text: bool) -> Factor {
        Factor { name: "x".to_owned(), values, is_text, texts: Texts::default() }
    }

    fn factors(factor: Factor) -> Factors {
        let used = factor.values.len();
        Factors { factors: vec![factor], all: used as u64, used }
    }

    fn of(factors: &Factors, column: &[f64]) -> Sensitivity {
        factors.sensitivity(&mut Selections::default(), SensitivityTarget::Failure, column)
    }

    #[test]
    fn flights_without_a_value_or_without_a_number_of_the_parameter_are_left_out_as_pairs() {
        let x: Vec<f64> = (0..100)
            .map(|run| if run % 7 == 0 { f64::NAN } else { f64::from(run * 37 % 101) })
            .collect();
        let y: Vec<f64> = (0..100)
            .map(|run| if run % 5 == 0 { f64::NAN } else { f64::from(run * run % 89) })
            .collect();
        let pairs: Vec<(f64, f64)> = x
            .iter()
            .copied()
            .zip(y.iter().copied())
            .filter(|(x, y)| !x.is_nan() && !y.is_nan())
            .collect();
        let (left, right): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        let found = of(&factors(factor(x, false)), &y);
        assert_eq!(found.used, 80);
        let influence = &found.influences[0];
        assert_eq!(influence.correlation, spearman(&left, &right));
        assert_eq!(influence.share, first_order(&left, &right));
        assert!(influence.share.is_some());
    }

    #[test]
    fn a_selection_from_memory_says_the_same_as_a_new_one() {
        let x = factors(factor((0..64).map(|run| f64::from(run * 29 % 61)).collect(), false));
        let whole: Vec<f64> = (0..64).map(|run| f64::from(run * 3 % 17)).collect();
        let mut holed = whole.clone();
        holed[5] = f64::NAN;
        let mut other = whole.clone();
        other[6] = f64::NAN;
        let mut selections = Selections::default();
        for column in [&whole, &holed, &holed, &whole, &other, &holed] {
            let found = x.sensitivity(&mut selections, SensitivityTarget::Failure, column);
            assert_eq!(found, of(&x, column));
        }
    }

    #[test]
    fn texts_have_a_share_but_no_ranks_and_too_many_texts_have_neither() {
        let few: Vec<f64> = (0..100).map(|run| f64::from(run % 4)).collect();
        let y: Vec<f64> = few.iter().map(|class| if *class < 2.0 { 1.0 } else { 5.0 }).collect();
        let found = of(&factors(factor(few, true)), &y);
        assert_eq!(found.influences[0].correlation, None);
        let share = found.influences[0].share.expect("a share");
        assert!(share.fraction > 1.0 - 1e-12 && share.classes == 4, "{share:?}");
        let many: Vec<f64> = (0..100).map(|run| f64::from(run % 50)).collect();
        assert_eq!(of(&factors(factor(many.clone(), true)), &y).influences[0].share, None);
        assert!(of(&factors(factor(many, false)), &y).influences[0].share.is_some());
    }

    #[test]
    fn what_never_varies_depends_on_nothing() {
        let x = factors(factor((0..50).map(f64::from).collect(), false));
        let influence = &of(&x, &[0.0; 50]).influences[0];
        assert_eq!((influence.correlation, influence.share), (None, None));
        let influence = &of(&x, &[f64::NAN; 50]).influences[0];
        assert_eq!((influence.correlation, influence.share), (None, None));
    }
}
