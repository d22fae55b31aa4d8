//! `[System]`: what holds for every variable and rule.

use fspid_fuzzy::system::{Conclusion, Defuzzifier, Input, Output, SetReading};
use fspid_fuzzy::{SNormKind, TNormKind};

use super::keys::{Keys, NO_TYPE_2, SYSTEM};
use super::output::Method;
use super::source::{Entry, Source};
use super::value;
use super::variable::told;
use crate::fis::word::{
    DEFUZZIFIERS, ENGINES, Engine, MATLAB, REDUCERS, S_NORMS, T_NORMS, Word, look_up,
};
use crate::report::{Report, wrong};
use fspid_diagnostics::Problem;

/// `[System]`, read.
pub(super) struct Header<'a> {
    keys: Keys<'a>,
    pub(super) name: String,
    engine: Engine,
    pub(super) and: TNormKind,
    pub(super) or: SNormKind,
    pub(super) implication: TNormKind,
    aggregation: SNormKind,
    defuzzifier: Defuzzifier,
}

const UNKNOWN: &str = "unknown method; functions of one's own are never run";

/// What is assumed where a method is missing: implication, aggregation, defuzzifier.
type Assumed = ((&'static str, TNormKind), (&'static str, SNormKind), (&'static str, Defuzzifier));
const MAMDANI: Assumed = (
    ("min", TNormKind::Minimum),
    ("max", SNormKind::Maximum),
    ("centroid", Defuzzifier::Centroid(MATLAB)),
);
const SUGENO: Assumed = (
    ("prod", TNormKind::AlgebraicProduct),
    ("sum", SNormKind::UnboundedSum),
    ("wtaver", Defuzzifier::WeightedAverage(SetReading::Tsukamoto)),
);

impl<'a> Header<'a> {
    pub(super) fn of(source: &Source<'a>, report: &mut Report) -> Self {
        let section = source.system.values().next();
        let keys = section.map(|section| Keys::of(section, SYSTEM, report)).unwrap_or_default();
        if section.is_none() {
            report.whole("there is no section `[System]`");
        }
        let name = keys.get("Name").and_then(|entry| report.keep(value::word(entry.value)));
        let engine = engine(&keys, report);
        let sugeno = engine == Engine::Sugeno;
        let (implication, aggregation, method) = if sugeno { SUGENO } else { MAMDANI };
        let mut header = Self {
            name: name.unwrap_or_default(),
            engine,
            and: chosen(&keys, "AndMethod", T_NORMS, ("min", TNormKind::Minimum), report),
            or: chosen(&keys, "OrMethod", S_NORMS, ("max", SNormKind::Maximum), report),
            implication: chosen(&keys, "ImpMethod", T_NORMS, implication, report),
            aggregation: chosen(&keys, "AggMethod", S_NORMS, aggregation, report),
            defuzzifier: chosen(&keys, "DefuzzMethod", DEFUZZIFIERS, method, report),
            keys,
        };
        header.agree(report);
        if sugeno {
            header.weigh(report);
        }
        header
    }

    /// MATLAB multiplies and adds in a Sugeno system, whatever is written.
    fn weigh(&mut self, report: &mut Report) {
        let ((_, product), (_, sum), _) = SUGENO;
        let written =
            [("ImpMethod", self.implication != product), ("AggMethod", self.aggregation != sum)];
        for (key, _) in written.into_iter().filter(|(_, differs)| *differs) {
            if let Some(entry) = self.keys.get(key) {
                report.note(entry.place, format!("`{key}` has no effect in a Sugeno system"));
            }
        }
        (self.implication, self.aggregation) = (product, sum);
    }

    /// What the outputs need to know.
    pub(super) fn method(&self, inputs: usize) -> Method {
        let Self { engine, aggregation, defuzzifier, .. } = *self;
        Method { engine, aggregation, defuzzifier, inputs }
    }

    /// Refuses a defuzzifier that is not one of the type.
    fn agree(&self, report: &mut Report) {
        let weighs = self.defuzzifier.sampling().is_none();
        let Some(entry) = self.keys.get("DefuzzMethod") else { return };
        let expected = match (self.engine, weighs) {
            (Engine::Mamdani, true) => "`centroid`, `bisector`, `mom`, `lom` or `som`",
            (Engine::Sugeno, false) => "`wtaver` or `wtsum`",
            _ => return,
        };
        let word = report.keep(value::word(entry.value)).unwrap_or_default();
        report.problem(entry.value.place(), &word, "does not go with `Type`", expected);
    }

    /// Notes numbers in the file that are not what was found.
    pub(super) fn counted(&self, inputs: usize, outputs: usize, rules: usize, report: &mut Report) {
        told(&self.keys, "NumInputs", inputs, "inputs", report);
        told(&self.keys, "NumOutputs", outputs, "outputs", report);
        told(&self.keys, "NumRules", rules, "rules", report);
    }

    /// Says how the system will answer.
    pub(super) fn explained(&self, inputs: &[Input], outputs: &[Output], report: &mut Report) {
        report.note_whole(match self.defuzzifier.sampling() {
            Some(sampling) => format!(
                "answers by MATLAB's rule: {} over samples ({sampling}), the middle of the range where no rule \
                 fires, inputs outside their range as they are",
                self.defuzzifier.name()
            ),
            None => "answers by MATLAB's rule: the middle of the range where no rule fires, inputs outside \
                     their range as they are"
                .into(),
        });
        let matters = interval(inputs, outputs);
        if let Some(entry) = self.keys.get("TypeRedMethod") {
            let reducer = reducer(entry, matters, report);
            report.keep(reducer);
        } else if matters {
            report.note_whole("`TypeRedMethod` is missing; `Karnik-Mendel` is assumed");
        }
    }
}

/// True if some set or number of the system is an interval.
fn interval(inputs: &[Input], outputs: &[Output]) -> bool {
    let conclusions = outputs.iter().flat_map(|output| &output.terms).map(|term| &term.conclusion);
    inputs.iter().flat_map(|input| &input.terms).any(|term| term.lower.is_some())
        || conclusions.into_iter().any(|found| {
            matches!(found, Conclusion::Interval(_) | Conclusion::Set { lower: Some(_), .. })
        })
}

fn reducer(entry: Entry, matters: bool, report: &mut Report) -> Result<(), Problem> {
    let word = value::word(entry.value)?;
    if !matters {
        report.note(entry.place, "without interval sets type reduction has no effect");
        return Ok(());
    }
    let message = "this type reduction is not computed here and would answer other numbers";
    look_up(REDUCERS, entry.value, &word, message)?;
    report.note(entry.place, "type reduction ends at the same two points for every such iteration");
    Ok(())
}

fn engine(keys: &Keys, report: &mut Report) -> Engine {
    let Some(entry) = keys.get("Type") else {
        report.note_whole("`Type` is missing; `mamdani` is assumed");
        return Engine::Mamdani;
    };
    let engine = value::word(entry.value).and_then(|word| {
        if word.to_ascii_lowercase().ends_with("type2") {
            return Err(wrong(entry.value.place(), &word, NO_TYPE_2, ""));
        }
        look_up(ENGINES, entry.value, &word, "unknown type of system")
    });
    report.keep(engine).map_or(Engine::Open, |word| word.means)
}

/// The meaning of a key's word, or the `default` with a note where there is none.
fn chosen<T: Copy>(
    keys: &Keys,
    key: &str,
    table: &'static [Word<T>],
    (default, means): (&str, T),
    report: &mut Report,
) -> T {
    let word = keys.get(key).and_then(|entry| {
        let word = report.keep(value::word(entry.value))?;
        let missing = word.is_empty() || word.eq_ignore_ascii_case("none");
        (!missing).then(|| report.keep(look_up(table, entry.value, &word, UNKNOWN)))
    });
    if word.is_none() {
        report.note_whole(format!("`{key}` is missing; `{default}` is assumed"));
    }
    word.flatten().map_or(means, |word| word.means)
}
