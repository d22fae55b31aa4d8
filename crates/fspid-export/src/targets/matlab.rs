//! MATLAB: the controller as a function, and the supervisor alone as a `.fis`, with what that loses.

use fspid_core::Controller;
use fspid_core::fuzzy::{Defuzzifier, Supervisor};
use fspid_formats::{WriteOptions, fis};
use fspid_fuzzy::system::Parts;
use fspid_numeric::Real;

use super::{Flown, Source, Written};
use crate::compose::Refusal;
use crate::file::File;
use crate::program::Program;
use crate::table::infer;
use crate::vectors::Draw;
use crate::write;

/// Samples of a centre of gravity in MATLAB's Fuzzy Logic Toolbox, where nothing else is asked for.
const SAMPLES: u32 = 101;
/// Inputs that the loss is measured of.
const MEASURED: u32 = 20_000;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Result<Written, Refusal> {
    let Source { program, heading, vectors, .. } = source;
    let prefix = &function(source.prefix, program)?;
    let Flown { controller, .. } = source.flown.as_ref().ok_or(Refusal::NoController)?;
    let mut files = vec![
        File::text(format!("{prefix}.m"), write::matlab(program, prefix, heading)),
        File::text(format!("{prefix}_check.m"), write::matlab_harness(program, prefix)),
        File::text(format!("{prefix}_words.csv"), write::words(program, vectors)),
    ];
    let mut notes = Vec::new();
    if let Ok(Controller::SelfTuning(fspid)) = controller.rounded::<f64>() {
        let supervisor = fspid.tuner().supervisor();
        let (text, told) = system(supervisor);
        files.extend(text.map(|text| File::text(format!("{prefix}.fis"), text)));
        notes.extend(told);
    }
    Ok(Written { files, notes })
}

/// Refuses a name that is longer than MATLAB's are.
pub(super) fn short(prefix: &str) -> Result<(), Refusal> {
    // `namelengthmax`, with room for `_controller_check`.
    const MOST: usize = 63 - 17;
    if prefix.len() > MOST { Err(Refusal::LongName { most: MOST }) } else { Ok(()) }
}

/// A name that a function file may have: no word of the language, and nothing that the code here calls or that is often
/// called beside it.
fn function(prefix: &str, program: &Program) -> Result<String, Refusal> {
    const TAKEN: &str = "break case catch classdef continue else elseif end for function global if otherwise parfor \
        persistent return spmd switch try while arguments enumeration events import methods properties \
        abs ans bitor char choose class configuration double eps error exit false fclose fis fopen fprintf fread i inf int32 \
        isequal j logical nan numel pi pow2 printf single size sprintf str2double struct true typecast uint32 uint8 zeros \
        answer answered different dlmread do isa k nargin numbers numel rows sample same until endif endfunction endwhile endswitch \
        unwind_protect end_try_catch ceil clear clc close cos disp exp eye feedback figure filter fix floor fuzzy gain hold input length load log lqr max \
        mean min mod ones plot pid pidtune plant quit rand round save sign sim sin sqrt ss state step sum tan tf title who";
    short(prefix)?;
    let is_own = program.functions.iter().any(|function| function.name == prefix);
    let is_taken = is_own || TAKEN.split_whitespace().any(|word| word == prefix);
    Ok(if is_taken { format!("{prefix}_controller") } else { prefix.to_owned() })
}

/// The supervisor as a `.fis`, and what there is to say of it.
fn system(supervisor: &Supervisor<f64>) -> (Option<String>, Vec<String>) {
    let sampled = as_sampled(supervisor);
    let parts = match Parts::try_from(sampled.as_ref().unwrap_or(supervisor)) {
        Ok(parts) => parts,
        Err(no_rules) => return (None, vec![format!("no .fis: {no_rules}")]),
    };
    let written = match fis::write(&parts, WriteOptions { lossy: true }) {
        Ok(written) => written,
        Err(problems) => return (None, vec![format!("no .fis: {problems}")]),
    };
    let mut notes: Vec<String> = written.notes.iter().map(|it| format!("the .fis: {it}")).collect();
    notes.push(match sampled {
        None => "the .fis has rules that conclude numbers: nothing is sampled, and it is off by rounding alone".to_owned(),
        Some(sampled) => loss(supervisor, &sampled),
    });
    (Some(written.text), notes)
}

/// The same supervisor with the centre of gravity that MATLAB samples; nothing where rules conclude numbers.
fn as_sampled(supervisor: &Supervisor<f64>) -> Option<Supervisor<f64>> {
    let table = supervisor.table()?;
    let rule = Defuzzifier::Endpoints(SAMPLES);
    Supervisor::new(&table, supervisor.range(), rule, supervisor.out_of_range()).ok()
}

fn loss(exact: &Supervisor<f64>, sampled: &Supervisor<f64>) -> String {
    let (mut draw, mut most, mut sum) = (Draw(3), [0.0_f64; 3], [0.0_f64; 3]);
    for _ in 0..MEASURED {
        let [error, change] = [(); 2].map(|()| draw.around(exact.range()));
        let (one, other) = (infer(exact, error, change), infer(sampled, error, change));
        for k in 0..3 {
            let off = (one[k] - other[k]).abs();
            most[k] = most[k].max(off);
            sum[k] += off * off;
        }
    }
    let told = |k: usize| {
        let rms = libm::sqrt(sum[k] / f64::from(MEASURED));
        format!("{} {:.5} ({rms:.5} rms)", ["kp", "ki", "kd"][k], most[k])
    };
    format!(
        "the .fis samples its centre of gravity at {SAMPLES} points, as MATLAB does: increments are off by at most {}, {}, {} of {MEASURED} drawn inputs within {}",
        told(0),
        told(1),
        told(2),
        exact.range()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `end.m` could not be read, and `pid.m` hid the toolbox's; the check of one that was called `rows` did not run.
    #[test]
    fn a_name_that_matlab_has_taken_is_another_one_and_a_long_one_is_refused() {
        let program = Program {
            precision: crate::program::Precision::Double,
            configuration: Vec::new(),
            state: Vec::new(),
            sample: Vec::new(),
            answer: Vec::new(),
            functions: Vec::new(),
        };
        let named = |prefix: &str| function(prefix, &program);
        let words = |text: &str| -> Vec<String> {
            let code: String = text
                .lines()
                .map(|line| line.split('\'').step_by(2).collect::<String>() + "\n")
                .collect();
            let words = code.split(|it: char| !(it.is_alphanumeric() || "_.".contains(it)));
            let words = words.map(|word| word.split('.').next().unwrap_or_default());
            let is_name = |word: &&str| word.starts_with(char::is_alphabetic);
            words.filter(is_name).map(str::to_owned).collect()
        };
        // What its check calls or assigns would be the export itself, or hide it.
        let harness = write::matlab_harness(&program, "pitch");
        let all = words(&harness);
        assert!(all.len() > 40, "{all:?}");
        for word in all.iter().filter(|word| !word.starts_with("pitch")) {
            assert_eq!(named(word), Ok(format!("{word}_controller")), "{harness}");
        }
        for taken in ["end", "for", "true", "abs", "double", "pi", "pid", "zeros", "bitor"] {
            assert_eq!(named(taken), Ok(format!("{taken}_controller")));
        }
        assert_eq!(named("fspid"), Ok("fspid".to_owned()));
        assert_eq!(named(&"a".repeat(47)), Err(Refusal::LongName { most: 46 }));
    }
}
