//! Data for a review of an export in C: what each part of the design is in the code, and which vector fails without it.
//!
//! Nothing here qualifies anything. Every change of the program that [`mutants`] lists is run by the interpreter against
//! the vectors; the same changes are written as lines of the C, so that a script does it with a compiler too.

mod equivalent;
mod mutants;
mod normal;
mod pack;
mod proof;
mod ranges;
mod run;
mod scripts;

use std::collections::BTreeMap;

use fspid_core::Controller;
use fspid_numeric::Real;
use sha2::{Digest, Sha256};

use crate::export::LoopWord;
use crate::file::File;
use crate::program::Program;
use crate::vectors::Vector;
use crate::write::{self, Heading};
use equivalent::Judge;
use mutants::Mutant;

/// What the evidence is about.
pub(crate) struct Subject<'a, R> {
    pub(crate) program: &'a Program,
    pub(crate) controller: &'a Controller<R>,
    pub(crate) prefix: &'a str,
    pub(crate) heading: &'a Heading<'a>,
    pub(crate) vectors: &'a [Vector<R>],
    /// What is known of the loop.
    pub(crate) its_loop: Option<&'a LoopWord>,
    /// The files of the export.
    pub(crate) code: &'a [File],
}

/// A change of the program, and what found it.
struct Finding {
    mutant: Mutant,
    /// Lines of the source that it changes, from 1, with what they then say.
    lines: Vec<(usize, String)>,
    /// The first vector with another answer, from 1.
    vector: Option<usize>,
    /// Why there can be none, where that is shown.
    equivalent: Option<&'static str>,
}

/// So many vectors, the directed ones and the first of those that are drawn, are asked for each change; the script asks
/// for all. More take longer and were not seen to find more.
pub(super) const ASKED: usize = 9000;

/// The files of a pack.
pub(crate) fn files<R: Real>(subject: &Subject<'_, R>) -> Vec<File> {
    let base = run::run(subject.program, subject.vectors);
    let judge = Judge::new(subject);
    let findings = findings(subject, &judge);
    let mut files: Vec<File> = subject
        .code
        .iter()
        .map(|file| File { name: format!("code/{}", file.name), bytes: file.bytes.clone() })
        .collect();
    files.push(File::text("code.sha256", digests(&files)));
    let code = files.len();
    files.extend(pack::tables(&findings));
    files.push(File::text("coverage.csv", pack::coverage(subject, &judge, &base.branches)));
    files.extend(proof::files(subject));
    files.extend(scripts::files(subject));
    // But for the page, whose first line the script writes.
    files.push(File::text("pack.sha256", digests(&files[code..])));
    files.push(File::text("README.md", pack::front(subject, &judge, &findings, &base)));
    files
}

/// Files as they were written, as `sha256sum -c` reads them.
fn digests(files: &[File]) -> String {
    let mut lines: Vec<String> = files
        .iter()
        .map(|file| {
            let digest = Sha256::digest(&file.bytes);
            let digits: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
            format!("{digits}  {}\n", file.name)
        })
        .collect();
    lines.sort_unstable();
    lines.concat()
}

/// Every change, asked for on all processors.
fn findings<R: Real>(subject: &Subject<'_, R>, judge: &Judge<'_>) -> Vec<Finding> {
    let all = mutants::all(subject.program);
    let text = |program: &Program| write::c(program, subject.prefix, subject.heading).source;
    let original = text(subject.program);
    let rows: Vec<&str> = original.lines().collect();
    let count = std::thread::available_parallelism().map_or(1, usize::from);
    let asked = &subject.vectors[..subject.vectors.len().min(ASKED)];
    let answered = |mutant: &Mutant| {
        let program = mutant.of(subject.program);
        let changed = text(&program);
        let lines = original.lines().zip(changed.lines()).zip(1..);
        let lines = lines.filter(|((before, after), _)| before != after);
        let lines: Vec<_> = lines.map(|((_, after), line)| (line, after.to_owned())).collect();
        let vector = run::first_different(&program, asked);
        let mut finding = Finding { mutant: mutant.clone(), lines, vector, equivalent: None };
        if vector.is_none() && !finding.lines.is_empty() {
            finding.equivalent = judge.reason(&finding, &program, &rows);
        }
        finding
    };
    let mut findings = BTreeMap::new();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..count)
            .map(|first| {
                let (all, answered) = (&all, &answered);
                scope.spawn(move || {
                    let own = all.iter().enumerate().skip(first).step_by(count);
                    own.map(|(index, mutant)| (index, answered(mutant))).collect::<Vec<_>>()
                })
            })
            .collect();
        for thread in threads {
            // A change that is lost would look like one that nobody has made.
            findings.extend(thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
    });
    findings.into_values().filter(|finding| !finding.lines.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use fspid_core::fuzzy::{Defuzzifier, Network, NumberTable, OutOfRange, Supervisor};
    use fspid_core::{
        AntiWindup, Change, ControllerSetting, Fspid, GainLimits, Gains, Law, Limits, Pid,
        PidConfig, SelfTuner, TunerSettings,
    };

    use super::*;
    use crate::Angles;
    use crate::interpret::{Cell, Machine};
    use crate::program::Part;
    use crate::vectors::eventful;

    const GAINS: Gains<f32> = Gains { kp: 1.1, ki: 0.6, kd: 0.3 };

    fn config() -> PidConfig<f32> {
        let mut config = PidConfig::sampled_every(0.01);
        config.derivative.filter_s = 0.05;
        config.limits = Limits::new(ControllerSetting::OutputLimits, -0.3, 0.35).ok();
        config.anti_windup = AntiWindup::BackCalculation { tracking_s: 0.5 };
        config
    }

    fn tuned(supervisor: Supervisor<f32>) -> Controller<f32> {
        let settings = TunerSettings { change: Change::Delta, ..TunerSettings::literal() };
        let tuner = SelfTuner::new(GAINS, supervisor, settings).expect("allowed");
        Controller::SelfTuning(Fspid::new(tuner, config()).expect("allowed"))
    }

    fn with_labels() -> Controller<f32> {
        let rules = fspid_core::paper::rules();
        let clamp = OutOfRange::Clamp;
        tuned(Supervisor::new(&rules, 2.0, Defuzzifier::Exact, clamp).expect("allowed"))
    }

    fn with_numbers() -> Controller<f32> {
        // No two neighbours are the same, and no two inputs turned conclude the same.
        let number = |cell: usize| 0.1 + 0.003 * ((cell * 37) % 49) as f32;
        let grid = |first: usize| {
            std::array::from_fn(|row| {
                std::array::from_fn(|column| number(first + 7 * row + column))
            })
        };
        let numbers = NumberTable::new([grid(0), grid(5), grid(11)]).expect("finite");
        tuned(Supervisor::of_numbers(&numbers, 2.0, OutOfRange::Clamp).expect("allowed"))
    }

    fn with_network() -> Controller<f32> {
        // No weight is another one, and none is small.
        let weight = |row: usize, unit: usize| {
            let size = 0.3 + 0.05 * ((row * 8 + unit) * 29 % 48) as f32;
            if (row + unit).is_multiple_of(2) { size } else { -size }
        };
        let rows = std::array::from_fn(|row| std::array::from_fn(|unit| weight(row, unit)));
        let network = Network::new(rows).expect("allowed");
        tuned(Supervisor::of_network(&network, 2.0, OutOfRange::Clamp).expect("allowed"))
    }

    /// What is asked about the changes of a controller that are chosen.
    fn asked(
        controller: &Controller<f32>,
        vectors: &[Vector<f32>],
        is_chosen: impl Fn(&Mutant) -> bool,
        answer: impl Fn(&Judge<'_>, &Finding, &Program, &[&str]) -> bool,
    ) -> Vec<String> {
        let program = crate::program(controller, Angles::Radians).expect("nothing is refused");
        let heading = Heading {
            name: "FSPID",
            digest: "0",
            precision: program.precision,
            angles: Some(Angles::Radians),
            elevator: None,
        };
        let subject = Subject {
            program: &program,
            controller,
            prefix: "fspid",
            its_loop: None,
            heading: &heading,
            vectors,
            code: &[],
        };
        let judge = Judge::new(&subject);
        let source = write::c(&program, "fspid", &heading).source;
        let rows: Vec<&str> = source.lines().collect();
        let mut named = Vec::new();
        for mutant in mutants::all(&program).into_iter().filter(is_chosen) {
            let changed = mutant.of(&program);
            let text = write::c(&changed, "fspid", &heading).source;
            let lines = source.lines().zip(text.lines()).zip(1..);
            let lines = lines.filter(|((before, after), _)| before != after);
            let lines = lines.map(|((_, after), line)| (line, after.to_owned())).collect();
            let vector = run::first_different(&changed, vectors);
            let finding = Finding { mutant, lines, vector, equivalent: None };
            if answer(&judge, &finding, &changed, &rows) {
                named.push(format!("{} {}", finding.mutant.element, finding.mutant.change));
            }
        }
        named
    }

    #[test]
    fn every_rule_and_every_number_of_a_design_is_found_when_it_is_changed_or_shown_to_do_nothing()
    {
        for controller in [with_labels(), with_numbers(), with_network()] {
            let vectors = eventful(&controller, Angles::Radians, 1, ASKED);
            let left = asked(
                &controller,
                &vectors,
                |it| it.is_design,
                |judge, finding, changed, rows| {
                    finding.vector.is_none() && judge.reason(finding, changed, rows).is_none()
                },
            );
            assert!(left.is_empty(), "not told apart: {left:?}");
        }
    }

    /// Limits with one end were taken for limits, and a proof was hoped for.
    #[test]
    fn gains_that_accumulate_are_hoped_to_be_proved_only_between_two_ends() {
        let first_line = |most: f32| {
            let clamp = OutOfRange::Clamp;
            let rules =
                Supervisor::new(&fspid_core::paper::rules(), 2.0, Defuzzifier::Exact, clamp)
                    .expect("allowed");
            let within = Limits::new(ControllerSetting::OutputLimits, 0.1, most).expect("in order");
            let settings = TunerSettings {
                law: Law::Accumulating { leakage_per_s: 0.5 },
                gain_limits: Some(GainLimits { kp: within, ki: within, kd: within }),
                ..TunerSettings::literal()
            };
            let tuner = SelfTuner::new(GAINS, rules, settings).expect("allowed");
            let fspid = Fspid::new(tuner, config()).expect("allowed");
            let controller = Controller::SelfTuning(fspid);
            let program = crate::program(&controller, Angles::Radians).expect("nothing is refused");
            let (precision, angles) = (program.precision, Some(Angles::Radians));
            let heading = Heading { name: "FSPID", digest: "0", precision, angles, elevator: None };
            proof::first_line(&Subject {
                program: &program,
                controller: &controller,
                prefix: "fspid",
                its_loop: None,
                heading: &heading,
                vectors: &[],
                code: &[],
            })
        };
        assert!(first_line(2.0).starts_with("Not proved yet:"));
        assert!(first_line(f32::INFINITY).starts_with("Not proved: gains that accumulate"));
    }

    #[test]
    fn what_a_vector_finds_is_never_said_to_change_nothing() {
        let pid = Controller::Fixed(Pid::new(GAINS, config()).expect("allowed"));
        // Steps alone: what others write into the memory is what some guards are for.
        let steps = crate::vectors::vectors(&pid, Angles::Radians, 1, 3000);
        let wrong = asked(
            &pid,
            &steps,
            |_| true,
            |judge, finding, changed, rows| {
                finding.vector.is_some() && judge.reason(finding, changed, rows).is_some()
            },
        );
        assert!(wrong.is_empty(), "found, and said to change nothing: {wrong:?}");
    }

    #[test]
    fn what_is_remembered_stays_within_the_bounds_that_intervals_found() {
        for controller in [with_labels(), with_numbers(), with_network()] {
            let program = crate::program(&controller, Angles::Radians).expect("nothing is refused");
            let memory = ranges::memory(&program).expect("bounded");
            let mut machine = Machine::<f32>::new(&program);
            machine.run("reset");
            for sample in crate::vectors::samples::<f32>(5, 3000) {
                machine.set(Part::Sample, "setpoint_rad", Cell::Real(sample.setpoint_rad));
                machine.set(Part::Sample, "measurement_rad", Cell::Real(sample.measurement_rad));
                machine.run("step");
                for member in &program.state {
                    let Some(Cell::Real(value)) = machine.member(Part::State, &member.name) else {
                        continue;
                    };
                    let holds = memory.holds(&member.name, f64::from(*value));
                    assert!(holds, "{} is {value}", member.name);
                }
            }
        }
    }
}
