//! Certified cases as a page: a card for each controller, all cases in a table, and a section for each.

use fspid_page::analysis::{
    AnalysisPage, Chapter, DataTable, Datum, Item, Standing, Verdict as Card,
};
use fspid_study::shell;

use super::answer::{NOBODY, told};
use super::{CertifiedCase, CertifiedCases};
use crate::certificate_files::NotWritable;
use crate::page::{Subject, files_chapter};

impl CertifiedCases {
    /// The answer of `certify --cases --report`: one HTML file without any outside reference, with a section for each case.
    ///
    /// # Errors
    /// [`NotWritable`] of the first certificate that could not be read again.
    pub fn page(&self, subject: Subject<'_>) -> Result<String, NotWritable> {
        let files = self.certificate_files()?;
        let mut chapters = vec![self.table()];
        chapters.extend(self.everywhere());
        chapters.extend(self.cases.iter().map(section));
        chapters.push(files_chapter(&files, subject));
        let steps = if subject.question.effort.long_flights { " --steps" } else { "" };
        let frame = subject.page(&format!(" --cases {}{steps}", self.which.name()));
        let verdicts = self.controllers().into_iter().map(|name| self.card(name)).collect();
        Ok(AnalysisPage { verdicts, chapters, ..frame }.render())
    }

    fn card(&self, controller: &str) -> Card {
        let is_proved = self.not_proved(controller).next().is_none();
        let headline = self.verdict(controller);
        Card {
            standing: if is_proved { Standing::Good } else { Standing::Bad },
            word: headline.word,
            name: controller.to_owned(),
            detail: headline.detail + ".",
        }
    }

    /// Every loop of every case in a row.
    fn table(&self) -> Chapter {
        let mut rows = Vec::new();
        for case in &self.cases {
            if case.has_nobody() {
                rows.push(vec![
                    Datum::Text(case.change.name.clone()),
                    Datum::Text(String::new()),
                    Datum::Unmet("not proved".to_owned()),
                    Datum::Text(NOBODY.to_owned()),
                ]);
            }
            for certified in &case.certification.results {
                let verdict = match certified.is_proved() {
                    true => Datum::Met("proved".to_owned()),
                    false => Datum::Unmet("not proved".to_owned()),
                };
                rows.push(vec![
                    Datum::Text(case.change.name.clone()),
                    Datum::Text(certified.name()),
                    verdict,
                    Datum::Text(told(certified)),
                ]);
            }
        }
        let table = DataTable {
            caption: format!("{} {}.", self.cases.len(), self.which.words()),
            head: ["case", "controller", "verdict", "what is said"].map(str::to_owned).to_vec(),
            rows,
            cards: true,
        };
        Chapter {
            id: "cases".to_owned(),
            title: "All cases".to_owned(),
            items: vec![Item::Table(table)],
        }
    }

    /// What holds in every case, and what some claim does not speak of.
    fn everywhere(&self) -> Option<Chapter> {
        let mut items = Vec::new();
        for name in self.controllers() {
            let told = self.in_every_case_in_words(name).into_iter();
            let told: Vec<String> = told.map(|(about, it)| format!("{about}: {it}")).collect();
            if !told.is_empty() {
                items.push(Item::Heading(name.to_owned()));
                items.push(Item::List(told));
            }
        }
        let left_out: Vec<String> = self.left_out().iter().map(ToString::to_string).collect();
        if !left_out.is_empty() {
            items.push(Item::Heading("Not in these claims".to_owned()));
            items.push(Item::List(left_out));
        }
        let title = "In every case".to_owned();
        (!items.is_empty()).then(|| Chapter { id: "everywhere".to_owned(), title, items })
    }
}

/// What was found at one case.
fn section(case: &CertifiedCase) -> Chapter {
    let CertifiedCase { change, certification } = case;
    let set = change.set.iter().map(|it| format!("--set {}", shell::word(it)));
    let set = set.collect::<Vec<_>>().join(" ");
    let mut items = Vec::new();
    items.extend((!set.is_empty()).then_some(Item::Code(set)));
    items.extend(case.has_nobody().then(|| Item::Text(format!("{NOBODY}."))));
    for certified in &certification.results {
        items.push(Item::Heading(certified.name()));
        items.extend(certified.items());
    }
    Chapter { id: format!("case-{}", change.name), title: change.name.clone(), items }
}
