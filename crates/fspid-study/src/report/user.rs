//! The report of a user's own scenario: verdict first.

use fspid_core::{GainCoupling, InputSets, SecondInput, SelfTuner};
use fspid_diagnostics::digits::to_six_decimals;
use fspid_fuzzy::UNITS;
use fspid_sim::{Controller, EarlyEnd, EndCause, Plant};
use serde::Serialize;

use super::supervisor;
use super::traces::{Drawing, fails, is_cut_short};
use super::{command, measures, settings};
use crate::metrics::{EdgeMetrics, Verdict};
use crate::report::templates::render;
use crate::simulation::{ControllerResult, Simulation};
use fspid_page::context;
use fspid_page::number::{capital, fixed, measured, sentence, significant, with_sign};
use fspid_page::page::{self, Cell, Figure, PageSection, PageTable};
use fspid_plot::{SurfaceKind, Svg};
use fspid_scenario::file::{Setting, Study};

#[derive(Clone, Copy)]
struct User<'a> {
    study: &'a Study,
    simulation: &'a Simulation,
}

/// The page.
pub(super) fn report(
    study: &Study,
    simulation: &Simulation,
    further: Option<PageSection>,
) -> String {
    let user = User { study, simulation };
    let mut sections = vec![user.verdicts(), user.responses(), user.measures()];
    sections.extend(further);
    sections.extend(user.tuning());
    sections.extend([user.settings(), user.provenance()]);
    let context = context! {
        title => format!("{}: flight report", simulation.scenario),
        heading => simulation.scenario,
        lead => render("user", context! { part => "lead" }),
        style => page::style(),
        sections,
        verdict_first => true,
        version => env!("CARGO_PKG_VERSION"),
    };
    render("page", context)
}

/// How a controller did, at a glance.
#[derive(Serialize)]
struct Outcome {
    name: String,
    class: &'static str,
    word: String,
    detail: String,
}

/// How the time responses are drawn.
pub(super) fn drawing<'a>(study: &'a Study, simulation: &'a Simulation) -> Drawing<'a> {
    Drawing {
        title: &simulation.scenario,
        scenario: &study.scenario,
        simulation,
        only: &[],
        detailed: true,
        width_px: 720.0,
    }
}

fn outcome(result: &ControllerResult) -> Outcome {
    let verdict = result.verdict();
    // Nobody knows what a longer flight of it comes to: the reason stands below, among the warnings.
    let is_undecided = result.at_rest.undecided.is_some();
    let (class, word) = match verdict {
        Verdict::Settled if is_undecided => ("fair", "! Settled, stability undecided".to_owned()),
        Verdict::Flown if is_undecided => ("fair", "! Flown, stability undecided".to_owned()),
        Verdict::Settled => ("good", "\u{2713} Settled".to_owned()),
        Verdict::Flown => ("good", "\u{2713} Flown".to_owned()),
        Verdict::NotSettled { .. } => ("fair", "! Not settled".to_owned()),
        Verdict::LeftRange(_) => ("bad", "\u{2717} LEFT THE RANGE OF ITS DATA".to_owned()),
        Verdict::EndedEarly(_) | Verdict::Unstable { .. } | Verdict::ModeNeverBegan { .. } => {
            ("bad", format!("\u{2717} {}", verdict.kind().to_uppercase()))
        }
    };
    let detail = match verdict {
        Verdict::EndedEarly(EarlyEnd { at_s, cause: EndCause::Diverged }) => format!(
            "The pitch angle left every reasonable range at t = {} s. Nothing can be measured in this flight.",
            fixed(at_s, 3)
        ),
        Verdict::EndedEarly(EarlyEnd { at_s, cause: EndCause::HitGround }) => format!(
            "The aircraft came down to the ground at t = {} s, where the flight ends. Nothing can be measured in it.",
            fixed(at_s, 3)
        ),
        Verdict::EndedEarly(_) => format!(
            "{}, where the flight ends. Nothing can be measured in it.",
            capital(&verdict.to_string())
        ),
        Verdict::Unstable { spectral_radius, .. } => format!(
            "{}, whatever the window shows; a spectral radius below 1 would be stable, and this one is {}. Nothing \
             can be measured in this flight.",
            capital(&verdict.to_string()),
            fixed(spectral_radius, 6)
        ),
        Verdict::ModeNeverBegan { .. } => format!(
            "{}: what it waits for did not come in this flight, which is not the one that the scenario describes.",
            capital(&verdict.to_string())
        ),
        Verdict::Flown => "There was no step in the command to measure against.".to_owned(),
        Verdict::Settled | Verdict::NotSettled { .. } => {
            format!("{}. {}", capital(&verdict.to_string()), first_step(result))
        }
        Verdict::LeftRange(_) => format!(
            "The flight {verdict}. It fails, because nobody knows how the aircraft flies there: its measures are of \
             data that do not hold."
        ),
    };
    Outcome { name: result.name.clone(), class, word, detail }
}

/// Its measures; where a load is among what they measure, that goes first, so that nobody takes them for the step's own.
fn first_step(result: &ControllerResult) -> String {
    let first = result.metrics.first_step();
    let from_s = result.metrics.edges.first().and_then(EdgeMetrics::measured_with_load_from_s);
    let load = from_s.map_or(String::new(), |from_s| {
        format!(", with what disturbs from {} s on in it", to_six_decimals(from_s))
    });
    format!(
        "First step{load}: rise time {}, overshoot {}, settling time {}.",
        with_unit(first.rise_time_s, 3, "s"),
        with_unit(first.overshoot_pct, 2, "%"),
        with_unit(first.settling_time_s, 3, "s")
    )
}

fn with_unit(value: crate::metrics::Measured, decimals: usize, unit: &str) -> String {
    let text = measured(value, decimals);
    if value.is_ok() { format!("{text} {unit}") } else { format!("absent ({text})") }
}

impl User<'_> {
    fn verdicts(self) -> PageSection {
        let outcomes: Vec<Outcome> = self.simulation.results.iter().map(outcome).collect();
        let met = self.simulation.requirements_met();
        let context = context! {
            part => "verdicts",
            outcomes,
            warnings => self.warnings(),
            beside => self.beside(),
            requirements => (!self.simulation.judgements.is_empty()).then(|| self.requirements()),
            met,
        };
        PageSection::of("verdict", "Verdict", render("user", context))
    }

    /// Those of the file, and what may be wrong with flights beside their verdicts.
    fn warnings(self) -> Vec<String> {
        let own = self.simulation.failed_own_flights.iter();
        let own = own.map(|it| format!("{} fails: {}.", it.who(), it.failures.join("; ")));
        let of = |result: &ControllerResult| {
            let name = result.name.clone();
            result.notes().into_iter().map(move |words| sentence(&format!("{name}: {words}")))
        };
        let notes = self.simulation.results.iter().flat_map(of);
        self.study.warnings.iter().cloned().chain(own).chain(notes).collect()
    }

    /// Facts beside the verdicts: gains at rest, what nobody asked.
    fn beside(self) -> Vec<String> {
        let gains = self.simulation.results.iter().filter_map(|result| {
            Some(format!("{}: {}.", result.name, result.at_rest.gains_in_words()?))
        });
        let note = self.simulation.range_rule.note().map(|note| format!("{}.", capital(note)));
        gains.chain(note).collect()
    }

    fn requirements(self) -> PageTable {
        let head = ["controller", "requirement", "worst value", "verdict"];
        let mut table = PageTable::new("Requirements: the worst case counts.", &head).in_cards();
        for judgement in &self.simulation.judgements {
            let requirement = &judgement.requirement;
            let verdict =
                if judgement.met { ("met", "\u{2713} met") } else { ("unmet", "\u{2717} NOT MET") };
            table.push(vec![
                Cell::text(&judgement.controller),
                Cell::text(format!(
                    "{} {}",
                    requirement.measure.name(),
                    requirement.limits_in_words()
                )),
                Cell {
                    class: if judgement.found.is_ok() { "number" } else { "absent" },
                    ..Cell::text(judgement.value_in_words())
                },
                Cell { class: verdict.0, ..Cell::text(verdict.1) },
            ]);
        }
        table
    }

    fn responses(self) -> PageSection {
        let drawing = drawing(self.study, self.simulation);
        let ended = self.simulation.results.iter().filter(|result| is_cut_short(result));
        let ended: Vec<&str> = ended.map(|result| result.name.as_str()).collect();
        let leaving = drawing.leaving();
        let aircraft = match &self.study.scenario.plant {
            Plant::Linear(_) => "",
            Plant::Aircraft(_) => {
                " Pitch counts from the trim; the elevator is the whole deflection."
            }
            Plant::External(_) => {
                " Pitch counts from the trim; the elevator is the whole deflection, as the simulator has it at each sample."
            }
        };
        let part = |(n, (words, svg)): (usize, (String, Svg))| match n {
            0 => {
                let caption = format!("{words}{aircraft}{}", drawing.spikes());
                Figure::new("responses-figure", svg, caption)
            }
            _ => Figure::new(format!("responses-{}", n + 1), svg, words),
        };
        let figures: Vec<Figure> = drawing.parts().into_iter().enumerate().map(part).collect();
        PageSection::of(
            "responses",
            "Time responses",
            render("user", context! { part => "responses", figures, leaving, ended }),
        )
    }

    fn measures(self) -> PageSection {
        let has_steps = self.simulation.results.iter().any(|it| !it.metrics.edges.is_empty());
        let failed = self.simulation.results.iter().any(fails);
        let steps =
            || measures::table("Every step of the command, for every controller.", self.simulation);
        let context = context! {
            part => "measures",
            steps => (has_steps || failed).then(steps),
            integrals => measures::integrals("Whole flights: integrals of the error, and effort.", self.simulation),
        };
        PageSection::of("measures", "Measures", render("user", context))
    }

    /// One part for each self-tuning controller; no section without one.
    fn tuning(self) -> Option<PageSection> {
        let controllers = &self.study.scenario.controllers;
        let parts: Vec<Tuning> =
            controllers.iter().enumerate().filter_map(|(n, c)| tuning(n, c)).collect();
        (!parts.is_empty()).then(|| {
            PageSection::of(
                "tuning",
                "Self-tuning",
                render("user", context! { part => "tuning", parts }),
            )
        })
    }

    fn settings(self) -> PageSection {
        let settings = &self.study.settings;
        let is_plant = |setting: &Setting| setting.table == "plant";
        let context = context! {
            part => "settings",
            is_plant => settings.iter().any(is_plant),
            flight => settings::of_flight(settings),
            controllers => settings::of_controllers(settings),
            derived => settings::derived(&self.study.derived_gains),
        };
        PageSection::of("settings", "Settings", render("user", context))
    }

    fn provenance(self) -> PageSection {
        let context = context! {
            part => "provenance",
            version => env!("CARGO_PKG_VERSION"),
            command => command("simulate", self.study, ""),
            digest => self.study.digest,
        };
        PageSection::of("provenance", "Provenance", render("user", context))
    }
}

/// What there is to say about a self-tuning controller.
#[derive(Serialize)]
struct Tuning {
    name: String,
    law: &'static str,
    accumulating: bool,
    structure: Vec<String>,
    sets: Vec<Figure>,
    tables: Vec<Figure>,
    maps: Vec<Figure>,
    at_rest: PageTable,
}

fn tuning(index: usize, named: &fspid_sim::NamedController) -> Option<Tuning> {
    let Controller::SelfTuning(fspid) = &named.controller else {
        return None;
    };
    let supervisor = fspid.tuner().supervisor();
    let prefix = |what: &str| format!("tuning-{}-{what}", index + 1);
    let law = fspid.tuner().settings().law.name();
    Some(Tuning {
        name: named.name.clone(),
        accumulating: law == "accumulating",
        structure: structure(fspid.tuner()),
        law,
        sets: supervisor::sets(&prefix("sets"), supervisor),
        tables: supervisor::rules(&prefix("rules"), &named.name, supervisor),
        maps: supervisor::surfaces(
            &prefix("surface"),
            &named.name,
            supervisor,
            &[SurfaceKind::Map],
        ),
        at_rest: at_rest(fspid, supervisor),
    })
}

/// What differs from a supervisor of rules that sees the error and its change through even sets.
fn structure(tuner: &SelfTuner<f64>) -> Vec<String> {
    let (settings, mut sentences) = (tuner.settings(), Vec::new());
    if tuner.supervisor().network().is_some() {
        sentences.push(format!(
            "The supervisor is a network of {UNITS} hidden units: it has no rules and no sets, adds nothing at rest, and \
             answers a fall as a rise. Its surfaces show all that it answers."
        ));
    }
    let instead = "What tables and figures call change of error is this.";
    match settings.second_input {
        SecondInput::Change => {}
        SecondInput::Rate => sentences.push(format!(
            "Beside the error the supervisor sees the measured pitch rate with its sign turned. {instead}"
        )),
        SecondInput::ModelError(model) => sentences.push(format!(
            "Beside the error the supervisor sees how far the pitch is behind a reference model of second \
             order with {} rad/s and a damping of {}. {instead}",
            significant(model.bandwidth_rad_s, 4),
            significant(model.damping, 4)
        )),
    }
    let InputSets { error, change } = settings.input_sets;
    for (centres, input) in [(error, "error"), (change, settings.second_input.beside())] {
        sentences.extend(centres.map(|centres| {
            format!(
                "The small and the medium sets of the {input} have their centres at {} and {} of the range; \
                 figures show it transformed, so that they are even.",
                significant(centres.small(), 4),
                significant(centres.medium(), 4)
            )
        }));
    }
    let GainCoupling { setpoint_weight, rate_gain } = settings.gain_coupling;
    for (factor, what, gain) in
        [(setpoint_weight, "set-point weight", "kp"), (rate_gain, "rate gain", "kd")]
    {
        if factor != 0.0 {
            let factor = significant(factor, 4);
            sentences.push(format!("The {what} moves by {factor} per unit of {gain}."));
        }
    }
    sentences
}

fn at_rest(fspid: &fspid_core::Fspid<f64>, supervisor: &fspid_fuzzy::Supervisor<f64>) -> PageTable {
    let caption = "At rest, with error and change zero. The last column is what the gains become after one second \
                   under an accumulating law, and at once under a memoryless one.";
    let adds = match supervisor.network() {
        Some(_) => "network adds, supervisor units",
        None => "rules add, supervisor units",
    };
    let head = ["gain", adds, "nominal gain", "gain at rest"];
    let mut table = PageTable::new(caption, &head);
    let (nominal, rest) = (fspid.tuner().nominal(), fspid.tuner().gains_at_rest());
    let added = supervisor::at_rest(supervisor).unwrap_or([f64::NAN; 3]);
    let rows = [
        ("kp", added[0], nominal.kp, rest.kp),
        ("ki [1/s]", added[1], nominal.ki, rest.ki),
        ("kd [s]", added[2], nominal.kd, rest.kd),
    ];
    for (name, added, nominal, rest) in rows {
        table.push(vec![
            Cell::text(name),
            Cell::number(with_sign(added, 4)),
            Cell::number(significant(nominal, 4)),
            Cell::number(significant(rest, 4)),
        ]);
    }
    table
}
