//! An answer as a page: a card for each loop, then what is claimed of it, in the words of the text and in tables.

mod tables;

use fspid_page::analysis::{
    AnalysisPage, Chapter, DataTable, Datum, Item, Provenance, Standing, Verdict as Card,
};
use fspid_proof::{FamilyVerdict, Verdict};
use fspid_scenario::file::Study;
use fspid_study::{report, shell};

use super::certificate_files::{CertificateFile, NotWritable};
use super::scope::NOT_IN_CLAIM;
use super::text::Line;
use super::{Certification, Certified, FamilyAnswer, Question, digest};

/// What a page is about beside the answer.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// What was certified.
    pub study: &'a Study,
    /// What was asked.
    pub question: Question<'a>,
    /// The folder that the certificates are written into, where they are.
    pub folder: Option<&'a str>,
}

impl Subject<'_> {
    /// The command, as a shell takes it, with these options behind those of the question; FILE is the scenario.
    fn command(&self, options: &str) -> String {
        let options = self.question.options() + options;
        report::command("certify", self.study, &options)
    }

    /// Who is left out, for it has no equations.
    fn left_out(&self) -> Vec<String> {
        let externals =
            self.study.scenario.externals.iter().filter(|_| self.question.only.is_none());
        externals
            .map(|named| {
                format!(
                    "Controller {} is left out: an external controller has no equations here.",
                    named.name
                )
            })
            .collect()
    }

    /// The frame of a page: everything but what was found.
    pub(super) fn page(&self, options: &str) -> AnalysisPage {
        let name = &self.study.scenario.name;
        AnalysisPage {
            title: format!("{name}: certificates"),
            heading: name.clone(),
            lead: LEAD.to_owned(),
            warnings: self.study.warnings.clone(),
            beside: self.left_out(),
            provenance: Provenance {
                command: self.command(options),
                digest: self.study.digest.clone(),
                further: Vec::new(),
            },
            ..AnalysisPage::default()
        }
    }
}

const LEAD: &str = "Stability while the gains move: proved, refuted, or open, of each controller with each plant that lasts. What is proved was re-checked in interval arithmetic; a certificate is a file from whose numbers alone that is done again.";

impl Certification {
    /// The answer of `certify --report`: one HTML file without any outside reference, with the words of the text.
    ///
    /// # Errors
    /// [`NotWritable`] of the first certificate that could not be read again.
    pub fn page(&self, subject: Subject<'_>) -> Result<String, NotWritable> {
        let files = self.certificate_files()?;
        let mut chapters: Vec<Chapter> = self.results.iter().map(Certified::chapter).collect();
        chapters.push(files_chapter(&files, subject));
        let verdicts = self.results.iter().map(Certified::card).collect();
        Ok(AnalysisPage { verdicts, chapters, ..subject.page("") }.render())
    }
}

impl Certified {
    fn card(&self) -> Card {
        let headline = self.headline();
        // What was asked beside stability and is not proved, lest a good word stand alone.
        let beside = self.lines().into_iter().filter(|line| !self.is_proved() && is_beside(line));
        let beside = beside.map(|(about, sentence)| format!("; {about} {sentence}"));
        Card {
            standing: self.standing(),
            word: headline.word,
            name: self.name(),
            detail: headline.detail + &beside.collect::<String>() + ".",
        }
    }

    fn standing(&self) -> Standing {
        let is_refuted = matches!(
            &self.family,
            Some(FamilyAnswer::Verdict { verdict, .. }) if matches!(**verdict, FamilyVerdict::Refuted { .. })
        );
        match &self.outcome {
            _ if self.is_proved() => Standing::Good,
            Ok(outcome) if matches!(outcome.verdict, Verdict::Refuted(..)) => Standing::Bad,
            Ok(outcome) if matches!(outcome.verdict, Verdict::Proved(..)) => {
                let is_flown_apart = self.family.as_ref().is_some_and(|it| it.not_held().is_some());
                match is_refuted || is_flown_apart || self.trouble().is_some() {
                    true => Standing::Bad,
                    false => Standing::Fair,
                }
            }
            Ok(_) | Err(_) => Standing::Fair,
        }
    }

    fn chapter(&self) -> Chapter {
        let name = self.name();
        Chapter { id: format!("loop-{name}"), title: name, items: self.items() }
    }

    /// What is said of the loop: its verdict, numbers, sentences, and what the claim does not speak of.
    pub(super) fn items(&self) -> Vec<Item> {
        let mut items = vec![Item::Text(format!("{}.", self.headline()))];
        items.extend(tables::of(self).into_iter().map(Item::Table));
        let (mut told, mut left_out) = (Vec::new(), Vec::new());
        let mut about_now = "";
        for (about, sentence) in self.lines() {
            // Nothing stands before a sentence that is about the same as the one above it.
            about_now = if about.is_empty() { about_now } else { about };
            match about_now {
                NOT_IN_CLAIM => left_out.push(sentence),
                about => told.push((about, sentence)),
            }
        }
        if !told.is_empty() {
            items.push(Item::Table(sentences(told)));
        }
        if !left_out.is_empty() {
            items.push(Item::Heading("Not in this claim".to_owned()));
            items.push(Item::List(left_out));
        }
        items
    }
}

/// True of what stands in the text below the headline where something that was asked beside stability is not proved.
fn is_beside((about, sentence): &Line) -> bool {
    matches!(*about, "family" | "disturbances" | "nonlinear")
        && ["OPEN", "REFUTED", "NOT BOUNDED", "NOT PROVED"]
            .iter()
            .any(|word| sentence.starts_with(word))
}

fn sentences(told: Vec<Line>) -> DataTable {
    let row = |(about, sentence): Line| vec![Datum::Text(about.to_owned()), Datum::Text(sentence)];
    DataTable {
        caption: "The claim in sentences, as the program says them.".to_owned(),
        head: ["about", "what is said"].map(str::to_owned).to_vec(),
        rows: told.into_iter().map(row).collect(),
        cards: true,
    }
}

/// The certificates, and how each is checked.
pub(super) fn files_chapter(files: &[CertificateFile], subject: Subject<'_>) -> Chapter {
    let folder = subject.folder.map_or("DIR".to_owned(), shell::word);
    let row = |file: &CertificateFile| {
        vec![Datum::Text(file.name.clone()), Datum::Code(digest::of_text(&file.text))]
    };
    let table = DataTable {
        caption: "Certificates, with the SHA-256 of each file.".to_owned(),
        head: ["file", "SHA-256"].map(str::to_owned).to_vec(),
        rows: files.iter().map(row).collect(),
        cards: true,
    };
    let check = |file: &CertificateFile| {
        let name = shell::word(&file.name);
        // In the order in which they were set: what is set in all cases comes last.
        let sets = file.set.iter().chain(&subject.study.overrides);
        let sets: String = sets.map(|it| format!(" --set {}", shell::word(it))).collect();
        format!("fspid certify --check {folder}/{name} --against FILE{sets}")
    };
    let checks: Vec<String> = files.iter().map(check).collect();
    let written = match subject.folder {
        Some(_) => "They were written beside this page",
        None => "--out DIR in the same command writes them",
    };
    let items = match files.is_empty() {
        true => {
            vec![Item::Text("There is none: nothing is proved, and nothing refuted.".to_owned())]
        }
        false => vec![
            Item::Table(table),
            Item::Text(format!(
                "{written}. Each is proved anew from its numbers alone, and held against what the scenario flies, by:"
            )),
            Item::Code(checks.join("\n")),
        ],
    };
    Chapter { id: "certificates".to_owned(), title: "Certificates".to_owned(), items }
}
