//! The supervisor: sets, rules, surfaces, and what it adds at rest.

use crate::report::templates::render;
use fspid_fuzzy::{Output, RuleTable};

use crate::report::Paper;
use fspid_page::context;
use fspid_page::number::{significant, with_sign};
use fspid_page::page::{Cell, Figure, PageSection, PageTable, TableRow};
use fspid_plot::SurfaceKind;
use fspid_scenario::file;
use fspid_study::report::supervisor::{self, Marks, OddCell};

/// Half ranges that the paper names.
const RANGES: [f64; 2] = [5.0, 40.0];

/// The tables that are compared.
const TABLES: [&str; 2] = ["printed", "mirrored"];

/// The supervisor.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let (Some(printed), Some(mirrored)) =
        (file::rule_table("printed"), file::rule_table("mirrored"))
    else {
        // Both are part of the program.
        return PageSection::of(
            "supervisor",
            "The fuzzy supervisor",
            render("failed", context! {}),
        );
    };
    let (sets, maps, views, mirrored_maps) = pictures(&printed, &mirrored);
    let tables = supervisor::rule_tables("table-3", "printed table", &printed, Marks::Paper);
    let mirrored_tables =
        supervisor::rule_tables("mirrored", "mirrored table", &mirrored, Marks::None);
    let figures: Vec<Figure> = [&sets, &tables, &mirrored_tables, &maps, &views, &mirrored_maps]
        .into_iter()
        .flatten()
        .cloned()
        .collect();
    let context = context! {
        sets, tables, mirrored_tables, maps, views, mirrored_maps,
        odd => odd(&printed),
        at_rest => at_rest(),
        in_flight => in_flight(paper),
    };
    PageSection::of("supervisor", "The fuzzy supervisor", render("supervisor", context))
        .with_figures(figures)
}

type Pictures = (Vec<Figure>, Vec<Figure>, Vec<Figure>, Vec<Figure>);

fn pictures(printed: &RuleTable, mirrored: &RuleTable) -> Pictures {
    let [range, _] = RANGES;
    let surfaces = |prefix: &str, name: &str, table: &RuleTable, kind| {
        supervisor::exact(table, range).map_or_else(Vec::new, |supervisor| {
            supervisor::surfaces(prefix, name, &supervisor, &[kind])
        })
    };
    let sets = supervisor::exact(printed, range);
    (
        sets.map_or_else(Vec::new, |supervisor| supervisor::sets("figure-4", &supervisor)),
        surfaces("surface-printed", "printed table", printed, SurfaceKind::Map),
        surfaces("surface-printed", "printed table", printed, SurfaceKind::View),
        surfaces("surface-mirrored", "mirrored table", mirrored, SurfaceKind::Map),
    )
}

/// Cells of the printed table without their counterpart, one line each.
fn odd(printed: &RuleTable) -> PageTable {
    let caption = "Cells of the printed table that break the symmetry of their gain. For kp and ki, opposite inputs \
                   should have opposite labels; for kd, opposite changes should have the same label.";
    let mut table =
        PageTable::new(caption, &["gain", "cell (e, ec)", "holds", "counterpart (e, ec)", "holds"]);
    for OddCell { output, at, found, opposite, there } in supervisor::odd_cells(printed) {
        // Both of a pair are odd: one line for the two.
        if (at.0.index(), at.1.index()) > (opposite.0.index(), opposite.1.index()) {
            continue;
        }
        let gain = match output {
            Output::DeltaKp => "kp",
            Output::DeltaKi => "ki",
            Output::DeltaKd => "kd",
        };
        table.push(vec![
            Cell::text(gain),
            Cell::text(format!("({}, {})", at.0, at.1)),
            Cell::text(found.name()),
            Cell::text(format!("({}, {})", opposite.0, opposite.1)),
            Cell::text(there.name()),
        ]);
    }
    table
}

/// What each supervisor adds at zero error and no change.
fn at_rest() -> PageTable {
    let caption = "What the supervisor answers at rest (error and change zero), in supervisor units: exact centroid.";
    let mut table =
        PageTable::new(caption, &["rule table, half range", "\u{394}kp", "\u{394}ki", "\u{394}kd"]);
    for name in TABLES {
        for range in RANGES {
            let answer = file::rule_table(name)
                .and_then(|rules| supervisor::exact(&rules, range))
                .and_then(|supervisor| supervisor::at_rest(&supervisor));
            let mut cells = vec![Cell::text(format!("{name}, {range}"))];
            cells.extend(
                answer.into_iter().flatten().map(|value| Cell::number(with_sign(value, 4))),
            );
            table.push(cells);
        }
    }
    table
}

/// Nominal gains of every flown FSPID, and its gains at rest.
fn in_flight(paper: &Paper<'_>) -> PageTable {
    let caption = "Gains of every flown FSPID: nominal, and at rest after the output factors and the floor at zero \
                   (A12). kp has no unit, ki is in 1/s, kd in s.";
    let head = ["figure, fit, controller", "kp", "ki", "kd", "kp", "ki", "kd"];
    let mut table = PageTable::new(caption, &head)
        .grouped(&[("", 1), ("nominal", 3), ("at rest", 3)])
        .in_cards();
    for flown in &paper.reproduction.figures {
        for named in &flown.study.scenario.controllers {
            let fspid_sim::Controller::SelfTuning(fspid) = &named.controller else {
                continue;
            };
            let (nominal, rest) = (fspid.tuner().nominal(), fspid.tuner().gains_at_rest());
            let name = format!("{}, {}, {}", flown.figure.id, flown.fit.name(), named.name);
            let mut cells = vec![Cell::text(name)];
            let gains = [nominal.kp, nominal.ki, nominal.kd, rest.kp, rest.ki, rest.kd];
            cells.extend(gains.map(|gain| Cell::number(significant(gain, 4))));
            table.push(TableRow::from(cells));
        }
    }
    table
}
