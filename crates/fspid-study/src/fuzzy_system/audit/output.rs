//! Findings about one output.

use fspid_fuzzy::audit::{Direction, GridAudit, OutputSurface, Statement, Symmetry};

use super::number::{between, between_about, short};
use super::{Audit, Finding, Mark, along, count, finding, first_few};

pub(super) fn findings(audit: &Audit<'_>, index: usize) -> Vec<Finding> {
    let mut all = Vec::new();
    if let Some(surface) = audit.surface.outputs.get(index) {
        all.push(values(audit, index, surface));
        all.push(coverage(audit, surface));
        let unit = (surface.most.bounds[1] - surface.least.bounds[0]).abs();
        all.push(at_rest(audit, surface, unit));
        for (input, found) in surface.along.iter().enumerate() {
            let meant = labels_go_one_way(audit, index, input);
            all.extend(along::findings_of(audit, input, found, meant, unit));
        }
        all.push(symmetry(audit, surface));
    }
    if let Some(rules) = audit.rules.outputs.get(index) {
        all.extend(unused(audit, index, &rules.uses));
        if let Some(grid) = &rules.grid {
            all.push(cells(audit, grid));
            all.extend(labels(audit, grid));
        }
    }
    all
}

fn values(audit: &Audit<'_>, index: usize, surface: &OutputSurface) -> Finding {
    let (least, most) = (&surface.least, &surface.most);
    let of = audit.system.parts().outputs.get(index).and_then(|output| output.universe);
    let of = of.map(|u| format!(" of the range {} to {}", short(u.lower), short(u.upper)));
    let sentence = format!(
        "{} at {} up to {} at {}{}",
        between(least.bounds),
        audit.point(&least.at),
        between(most.bounds),
        audit.point(&most.at),
        of.unwrap_or_default()
    );
    let mark = if least.settled && most.settled { Mark::Holds } else { Mark::Open };
    finding(mark, "values", sentence)
}

fn coverage(audit: &Audit<'_>, surface: &OutputSurface) -> Finding {
    let least = &surface.coverage.least;
    let (mark, sentence) = match &surface.coverage.statement {
        Statement::Proved => (
            Mark::Holds,
            format!(
                "some rule fires everywhere, the strongest nowhere below {}; least at {}",
                short(least.bounds[0]),
                audit.point(&least.at)
            ),
        ),
        Statement::Refuted(at) => (Mark::NotMeant, format!("no rule fires at {}", audit.point(at))),
        Statement::Open => (Mark::Open, "not proved whether some rule fires everywhere".to_owned()),
    };
    let fallback = if surface.may_fall_back && mark != Mark::NotMeant {
        "; the fallback may answer in places"
    } else {
        ""
    };
    finding(mark, "coverage", format!("{sentence}{fallback}"))
}

/// True where the labels of the rule grid go one way along an input without exception.
fn labels_go_one_way(audit: &Audit<'_>, output: usize, input: usize) -> bool {
    let grid = audit.rules.outputs.get(output).and_then(|rules| rules.grid.as_ref());
    let axis = grid.and_then(|grid| grid.labels.as_ref()?.along.get(input));
    axis.is_some_and(|axis| axis.exceptions.is_empty() && axis.direction != Direction::Constant)
}

fn at_rest(audit: &Audit<'_>, surface: &OutputSurface, unit: f64) -> Finding {
    let rest = audit.point(&audit.surface.rest);
    let sentence = format!("{} at {rest}", between_about(surface.at_rest, unit));
    finding(Mark::Worth, "at rest", sentence)
}

/// The nearer one of odd and even symmetry.
fn symmetry(audit: &Audit<'_>, surface: &OutputSurface) -> Finding {
    let is_odd = surface.odd.departure.bounds[0] <= surface.even.departure.bounds[0];
    let (name, nearer) = if is_odd { ("odd", &surface.odd) } else { ("even", &surface.even) };
    let (mark, sentence) = match &nearer.statement {
        Statement::Proved => (Mark::Holds, format!("the surface is {name} about its middle")),
        Statement::Refuted(_) => {
            (Mark::Worth, format!("the surface is not {name}: {}", departure(audit, nearer)))
        }
        Statement::Open => {
            let departure = departure(audit, nearer);
            (Mark::Open, format!("not proved whether the surface is {name}: {departure}"))
        }
    };
    finding(mark, "symmetry", sentence)
}

fn departure(audit: &Audit<'_>, symmetry: &Symmetry) -> String {
    let (size, at) = (between(symmetry.departure.bounds), audit.point(&symmetry.departure.at));
    format!("opposite points differ by up to {size}, at {at}")
}

/// Terms that no rule concludes.
fn unused(audit: &Audit<'_>, output: usize, uses: &[usize]) -> Option<Finding> {
    let none = uses.iter().enumerate().filter(|(_, uses)| **uses == 0);
    let none: Vec<String> =
        none.map(|(term, _)| audit.output_term(output, term).to_owned()).collect();
    let few = (!none.is_empty()).then(|| first_few(none.into_iter()))?;
    Some(finding(Mark::Worth, "unused terms", format!("no rule concludes {few}")))
}

fn cells(audit: &Audit<'_>, grid: &GridAudit) -> Finding {
    let list = |cells: &[Vec<usize>]| first_few(cells.iter().map(|cell| audit.cell(cell)));
    if !grid.holes.is_empty() {
        let of = format!("{} of {} cells", grid.holes.len(), grid.cells);
        return finding(
            Mark::NotMeant,
            "table",
            format!("{of} have no rule: {}", list(&grid.holes)),
        );
    }
    if !grid.ambiguous.is_empty() {
        let of = format!("{} of {} cells", grid.ambiguous.len(), grid.cells);
        let list = list(&grid.ambiguous);
        return finding(Mark::Worth, "table", format!("{of} have more than one label: {list}"));
    }
    finding(Mark::Holds, "table", format!("each of the {} cells has one label", grid.cells))
}

/// Direction and symmetry of the labels.
fn labels(audit: &Audit<'_>, grid: &GridAudit) -> Vec<Finding> {
    let Some(labels) = &grid.labels else { return Vec::new() };
    let mut all = Vec::new();
    for (input, axis) in labels.along.iter().enumerate() {
        let way = match axis.direction {
            Direction::Constant => "stay as they are along",
            Direction::Rising => "rise along",
            Direction::Falling => "fall along",
        };
        let name = audit.input(input);
        let exceptions = axis.exceptions.len();
        let but = match exceptions {
            0 => "without exception".to_owned(),
            n => {
                let cells = axis.exceptions.iter().map(|pair| {
                    let [from, to] = &pair.cells;
                    format!("from {} to {}", audit.cell(from), audit.cell(to))
                });
                format!("but for {n} of {} steps: {}", axis.neighbours, first_few(cells))
            }
        };
        let jump = format!("largest step {}", count(axis.largest_jump, "label"));
        let mark = if exceptions == 0 { Mark::Holds } else { Mark::Worth };
        all.push(finding(
            mark,
            format!("labels along {name}"),
            format!("{way} {name} {but}; {jump}"),
        ));
    }
    let broken =
        |pairs: &fspid_fuzzy::audit::PairAudit| pairs.violations.len() + pairs.own_images.len();
    let is_odd = broken(&labels.odd) <= broken(&labels.even);
    let (name, nearer) = if is_odd { ("odd", &labels.odd) } else { ("even", &labels.even) };
    let (mark, sentence) = if nearer.holds() {
        (Mark::Holds, format!("the labels are {name}: opposite cells agree"))
    } else {
        let cells = nearer.violations.iter().map(|[one, _]| audit.cell(one));
        let own = match nearer.own_images.len() {
            0 => String::new(),
            n => format!("; and {n} in the middle"),
        };
        let (n, pairs) = (nearer.violations.len(), nearer.pairs);
        let cells = if n > 0 { format!(": {}", first_few(cells)) } else { String::new() };
        (
            Mark::Worth,
            format!("{n} of {pairs} opposite pairs of cells break {name} symmetry{cells}{own}"),
        )
    };
    all.push(finding(mark, "labels mirrored", sentence));
    all
}
