//! The report of an audit.

use serde::Serialize;

use crate::fuzzy_system::{Audit, Chapter, Mark, SliceQuestion, slice};
use crate::report::templates::render;
use fspid_page::context;
use fspid_page::page::{self, Cell, Figure, PageSection, PageTable};

/// What stands about an output beside its findings.
#[derive(Serialize)]
struct Line {
    class: &'static str,
    sign: &'static str,
    about: String,
    sentence: String,
}

/// The report: a verdict, then a section about the rules and one about each output.
pub(super) fn report(audit: &Audit<'_>) -> String {
    let parts = audit.system().parts();
    let name = if parts.name.is_empty() { "fuzzy system" } else { &parts.name };
    let chapters = audit.chapters();
    let mut sections = vec![summary(&chapters)];
    for (index, chapter) in chapters.iter().enumerate() {
        sections.push(section(audit, index, chapter));
    }
    let context = context! {
        title => format!("{name}: audit"),
        heading => name,
        lead => render("audit", context! { part => "lead", description => parts.description }),
        style => page::style(),
        sections,
        verdict_first => true,
        version => env!("CARGO_PKG_VERSION"),
    };
    render("page", context)
}

/// How many findings of each kind, and those that are probably not meant.
fn summary(chapters: &[Chapter]) -> PageSection {
    let marks = [Mark::Holds, Mark::Worth, Mark::NotMeant, Mark::Open];
    let head =
        ["about", "\u{2713} holds", "! worth knowing", "\u{2717} probably not meant", "? open"];
    let mut table = PageTable::new("Findings by kind.", &head);
    for chapter in chapters {
        let of = |mark| chapter.findings.iter().filter(|found| found.mark == mark).count();
        let mut row = vec![Cell::text(&chapter.title)];
        row.extend(marks.map(|mark| Cell::number(of(mark).to_string())));
        table.push(row);
    }
    let worst: Vec<Line> = chapters
        .iter()
        .flat_map(|chapter| {
            let broken = chapter.findings.iter().filter(|found| found.mark == Mark::NotMeant);
            broken.map(|found| Line {
                class: class(found.mark),
                sign: found.mark.sign(),
                about: format!("{}, {}", chapter.title, found.about),
                sentence: found.sentence.clone(),
            })
        })
        .collect();
    PageSection::of(
        "summary",
        "Summary",
        render("audit", context! { part => "summary", table, worst }),
    )
}

const fn class(mark: Mark) -> &'static str {
    match mark {
        Mark::Holds => "good",
        Mark::Worth | Mark::Open => "fair",
        Mark::NotMeant => "bad",
    }
}

fn section(audit: &Audit<'_>, index: usize, chapter: &Chapter) -> PageSection {
    let lines: Vec<Line> = chapter
        .findings
        .iter()
        .map(|found| Line {
            class: class(found.mark),
            sign: found.mark.sign(),
            about: found.about.clone(),
            sentence: found.sentence.clone(),
        })
        .collect();
    let figure = index.checked_sub(1).and_then(|_| drawing(audit, index, &chapter.title));
    let title = if index == 0 { "Rules as written".to_owned() } else { chapter.title.clone() };
    PageSection::of(
        id(index),
        &title,
        render("audit", context! { part => "findings", lines, figure }),
    )
}

/// Ids of sections, which the page needs as constants; further outputs share the last.
const fn id(index: usize) -> &'static str {
    match index {
        0 => "rules",
        1 => "output-1",
        2 => "output-2",
        3 => "output-3",
        4 => "output-4",
        5 => "output-5",
        6 => "output-6",
        _ => "output-more",
    }
}

/// The surface or curve of the output.
fn drawing(audit: &Audit<'_>, index: usize, output: &str) -> Option<Figure> {
    let question = SliceQuestion { output: Some(output), ..SliceQuestion::default() };
    let slice = slice(audit.system(), &question).ok()?;
    let fixed = slice.fixed_in_words();
    let (_, svg) = slice.figures().into_iter().next()?;
    let rest = if fixed.is_empty() { String::new() } else { format!(" with {fixed}") };
    let caption = format!("{output} over its inputs{rest}: in space, and as a map.");
    Some(Figure::new(format!("surface-{index}"), svg, caption))
}
