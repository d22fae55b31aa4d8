//! The answer as a page: the verdict, a table for each controller, and what is to be known of its numbers.

use fspid_diagnostics::digits;
use fspid_page::analysis::{
    AnalysisPage, Chapter, DataTable, Datum, Item, Provenance, Standing, Verdict,
};

use super::Verification;
use super::text::{FAILED_FLIGHTS, cells};
use crate::judgement::Judgement;
use crate::report::command;
use crate::shell;

/// Lines that the card of the verdict names; the tables below it have all.
const NAMED: usize = 6;
/// Headings of a controller's table.
const HEAD: [&str; 8] = [
    "requirement",
    "verdict",
    "measure",
    "set, clause",
    "found",
    "limit",
    "room to the limit",
    "worst case, or why there is none",
];

impl Verification {
    /// The answer of `verify --report`: one HTML file without any outside reference, with the words of the text.
    #[must_use]
    pub fn page(&self) -> String {
        let name = self.study.scenario.name.clone();
        let mut chapters = vec![self.tables(), self.flights()];
        chapters.push(chapter("asked", "What is asked", self.asked()));
        let notes = self.notes();
        chapters.extend((!notes.is_empty()).then(|| chapter("notes", "Notes", notes)));
        chapters.push(self.again());
        AnalysisPage {
            title: format!("{name}: requirements"),
            heading: name,
            lead: LEAD.to_owned(),
            verdicts: vec![self.card()],
            warnings: self.study.warnings.clone(),
            chapters,
            provenance: Provenance {
                command: self.command(),
                digest: self.study.digest.clone(),
                further: Vec::new(),
            },
            ..AnalysisPage::default()
        }
        .render()
    }

    fn card(&self) -> Verdict {
        let of = |is_found: bool| {
            let unmet = self.judgements.iter();
            unmet.filter(move |it| !it.met && it.found.is_ok() == is_found)
        };
        let mut detail: Vec<String> = Vec::new();
        detail.extend(named("Not met", of(true)));
        detail.extend(named("Not evaluated, and so not met", of(false)));
        let flights: Vec<String> = self.failed_flights.iter().map(|it| it.who()).collect();
        if !flights.is_empty() {
            detail.push(format!("{FAILED_FLIGHTS}: {}.", flights.join("; ")));
        }
        if detail.is_empty() {
            detail.push(
                "Every requirement is met, and no flight of which something is required failed by itself."
                    .to_owned(),
            );
        }
        // A requirement that is met says nothing of what is not required, and a good word stood alone.
        if !self.undecided.is_empty() {
            let names = self.undecided.join(", ");
            detail.push(format!(
                "It is undecided whether the loop is stable of {names}: see the notes."
            ));
        }
        Verdict {
            standing: match (self.all_met(), self.undecided.is_empty()) {
                (true, true) => Standing::Good,
                (true, false) => Standing::Fair,
                (false, _) => Standing::Bad,
            },
            word: self.word().to_owned(),
            name: self.counted(),
            detail: detail.join(" "),
        }
    }

    /// A table for each controller, in the order in which they are judged.
    fn tables(&self) -> Chapter {
        let mut names: Vec<&str> = Vec::new();
        for judgement in &self.judgements {
            if !names.contains(&judgement.controller.as_str()) {
                names.push(&judgement.controller);
            }
        }
        let tables = names.into_iter().map(|name| {
            let own = self.judgements.iter().filter(|it| it.controller == name);
            let own: Vec<&Judgement> = own.collect();
            let met = own.iter().filter(|it| it.met).count();
            let caption = format!("{name}: {met} of {} met", own.len());
            let rows = own.into_iter().map(row).collect();
            let head = HEAD.map(str::to_owned).to_vec();
            Item::Table(DataTable { caption, head, rows, cards: true })
        });
        let items = tables.collect();
        Chapter { id: "requirements".to_owned(), title: "Requirements".to_owned(), items }
    }

    fn flights(&self) -> Chapter {
        let failed = self.failed_in_words();
        let items = match failed.is_empty() {
            true => vec![Item::Text(
                "None: no flight of which something is required failed by itself.".to_owned(),
            )],
            false => failed.into_iter().map(Item::Warning).collect(),
        };
        Chapter { id: "flights".to_owned(), title: FAILED_FLIGHTS.to_owned(), items }
    }

    /// What was typed behind the file, but for the page.
    fn options(&self) -> String {
        let option = |name: &str, value: &String| format!(" --{name} {}", shell::word(value));
        let sets = self.added.sets.iter().map(|it| option("set", it));
        let files = self.added.requirement_files.iter();
        sets.chain(files.map(|it| option("requirements", it))).collect()
    }

    fn command(&self) -> String {
        command("verify", &self.study, &self.options())
    }

    /// How the numbers are had again, and where the flights can be seen.
    fn again(&self) -> Chapter {
        let again = self.command().replace(" --report OUT.html", " --replay DIR");
        let items = vec![
            Item::Text(
                "A scenario of its own for each line, that gives its number again:".to_owned(),
            ),
            Item::Code(again),
            Item::Text("The flights themselves, as figures, with their measures:".to_owned()),
            Item::Code(command("simulate", &self.study, "")),
        ];
        Chapter { id: "again".to_owned(), title: "How to look closer".to_owned(), items }
    }
}

const LEAD: &str = "Requirements judged: what was found, its limit, and where the worst case is. A value that equals its limit meets it; what could not be evaluated is not met. Each number is in the unit beside it.";

fn chapter(id: &str, title: &str, sentences: Vec<String>) -> Chapter {
    let items = vec![Item::List(sentences)];
    Chapter { id: id.to_owned(), title: title.to_owned(), items }
}

/// Lines by name, the first of them; none where there are none.
fn named<'a>(what: &str, lines: impl Iterator<Item = &'a Judgement>) -> Option<String> {
    let all: Vec<String> =
        lines.map(|it| format!("{} of {}", it.requirement.id, it.controller)).collect();
    let more = match all.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let first: Vec<&str> = all.iter().take(NAMED).map(String::as_str).collect();
    (!all.is_empty()).then(|| format!("{what}: {}{more}.", first.join(", ")))
}

fn row(judgement: &Judgement) -> Vec<Datum> {
    let requirement = &judgement.requirement;
    let [_, id, _, _, _, found, limit, worst] = cells(judgement);
    let verdict = match (&judgement.found, judgement.met) {
        (_, true) => Datum::Met("met".to_owned()),
        (Ok(_), false) => Datum::Unmet("NOT MET".to_owned()),
        (Err(_), false) => Datum::Unmet("NOT EVALUATED".to_owned()),
    };
    let found = match &judgement.found {
        Ok(_) => Datum::Number(found),
        Err(_) => Datum::Absent(found),
    };
    let origin = &requirement.origin;
    let from: Vec<&str> =
        [&origin.set, &origin.clause].into_iter().flatten().map(String::as_str).collect();
    vec![
        Datum::Text(id),
        verdict,
        Datum::Text(requirement.measure.name().to_owned()),
        Datum::Text(from.join(", ")),
        found,
        Datum::Number(limit),
        room(judgement),
        Datum::Text(worst),
    ]
}

/// How far the number is inside of the nearer limit, below 0 outside, in the unit of the measure; nothing where there is no
/// such distance.
fn room(judgement: &Judgement) -> Datum {
    let requirement = &judgement.requirement;
    let slack = judgement.found.as_ref().ok().map(|case| requirement.slack(case.value));
    let slack = slack.filter(|it| it.is_finite() && !requirement.measure.is_yes_or_no());
    let Some(slack) = slack else { return Datum::Absent("\u{2013}".to_owned()) };
    let number = digits::shortest(digits::rounded(slack, 3));
    Datum::Number(format!("{number} {}", requirement.measure.unit()).trim_end().to_owned())
}
