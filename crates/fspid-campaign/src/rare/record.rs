//! Scores on the disk, so that a search that was interrupted goes on where it was.
//!
//! The search is a function of its seed and of the scores, so that the scores are all that is kept: begun again, it asks for
//! the same points in the same order, and those that were flown are read. A part is whole or not there.

use std::path::Path;

use fspid_study::output;

use super::chains::LimitState;
use super::point::{Point, Shape};
use super::target::{Scored, Target};
use crate::error::CampaignError;
use crate::folder::Folder;
use crate::table::Digest;

/// The first line of a part.
const HEAD: &str = "fspid rare scores 2";
/// Behind the score of a flight of which nobody can tell whether its loop is stable at rest.
const UNDECIDED: &str = " undecided";

/// Flights with what is known of them.
pub(super) struct Record<'a> {
    target: Target<'a>,
    /// Where scores are kept, if anywhere.
    folder: Option<&'a Folder>,
    /// What names the question.
    id: &'a str,
    /// Points of a part.
    part: usize,
    parts: u64,
    undecided: u64,
}

impl<'a> Record<'a> {
    pub(super) fn new(target: Target<'a>, folder: Option<&'a Folder>, id: &'a str) -> Self {
        let part = target.part();
        Self { target, folder, id, part, parts: 0, undecided: 0 }
    }

    pub(super) fn target(&self) -> &Target<'a> {
        &self.target
    }

    /// Flights so far, read ones too, that do not fail and are of a loop of which nobody can tell whether it is stable at rest.
    pub(super) const fn undecided(&self) -> u64 {
        self.undecided
    }

    fn part_scored(&mut self, points: &[Point]) -> Result<Vec<Scored>, CampaignError> {
        let number = self.parts;
        self.parts += 1;
        let Some(folder) = self.folder else { return self.target.scored(points) };
        let path = folder.flights_path().join(format!("{number:06}.scores"));
        let head = format!("{HEAD}\n{}\n{}\n", self.id, digest(points));
        if path.exists() {
            let scored = read(&path, &head, points.len())?;
            self.target.found(points.len() as u64);
            return Ok(scored);
        }
        let scored = self.target.scored(points)?;
        let lines: String = scored.iter().map(line).collect();
        let written = output::write(&path, format!("{head}{lines}end\n"));
        written.map_err(|error| CampaignError::from(error).of_writing(&path))?;
        Ok(scored)
    }
}

impl LimitState for Record<'_> {
    type Error = CampaignError;

    fn shape(&self) -> Shape {
        self.target.shape()
    }

    fn scores(&mut self, points: &[Point]) -> Result<Vec<f64>, CampaignError> {
        let mut scores = Vec::with_capacity(points.len());
        for points in points.chunks(self.part) {
            let scored = self.part_scored(points)?;
            self.undecided += scored.iter().filter(|it| it.is_undecided).count() as u64;
            scores.extend(scored.iter().map(|it| it.score));
        }
        Ok(scores)
    }
}

/// The scores of a part that is whole and of these points.
fn read(path: &Path, head: &str, count: usize) -> Result<Vec<Scored>, CampaignError> {
    let foreign =
        |reason: &str| CampaignError::Foreign { path: path.to_owned(), reason: reason.to_owned() };
    let text = fspid_scenario::file::read_text(path)?;
    let Some(rest) = text.strip_prefix(head) else {
        return Err(foreign("it is not of these flights"));
    };
    let Some(lines) = rest.strip_suffix("end\n") else { return Err(foreign("its end is missing")) };
    match lines.lines().map(scored).collect::<Option<Vec<Scored>>>() {
        Some(scored) if scored.len() == count => Ok(scored),
        _ => Err(foreign("it does not hold a number for each flight")),
    }
}

fn line(Scored { score, is_undecided }: &Scored) -> String {
    format!("{score:?}{}\n", if *is_undecided { UNDECIDED } else { "" })
}

/// The flight of a line; none where it is damaged.
fn scored(line: &str) -> Option<Scored> {
    let (score, is_undecided) = match line.strip_suffix(UNDECIDED) {
        Some(score) => (score, true),
        None => (line, false),
    };
    let score = score.parse().ok().filter(|it: &f64| it.is_finite())?;
    Some(Scored { score, is_undecided })
}

/// What names points: every bit of them.
fn digest(points: &[Point]) -> Digest {
    let text: Vec<String> = points
        .iter()
        .map(|point| {
            let normals = point.normals.iter().map(|it| format!("{:x} ", it.to_bits()));
            let seeds = point.seeds.iter().map(|it| format!("s{it:x} "));
            let terms = point.airs.iter().flat_map(|air| {
                air.terms.iter().map(|(seed, weight)| format!("a{seed:x} {:x} ", weight.to_bits()))
            });
            normals.chain(seeds).chain(terms).collect()
        })
        .collect();
    Digest::of_texts(text.iter().map(String::as_str))
}
