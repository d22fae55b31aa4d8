//! Scores on the disk, so that a search that was interrupted goes on where it was.
//!
//! The search is a function of its seed and of the scores, so that the scores are all that is kept: begun again, it asks for
//! the same points in the same order, and those that were flown are read. A part is whole or not there.

use std::path::Path;

use fspid_study::output;

use super::chains::LimitState;
use super::point::{Point, Shape};
use super::target::Target;
use crate::error::CampaignError;
use crate::folder::Folder;
use crate::table::Digest;

/// The first line of a part.
const HEAD: &str = "fspid rare scores 1";

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
}

impl<'a> Record<'a> {
    pub(super) fn new(target: Target<'a>, folder: Option<&'a Folder>, id: &'a str) -> Self {
        let part = target.part();
        Self { target, folder, id, part, parts: 0 }
    }

    pub(super) fn target(&self) -> &Target<'a> {
        &self.target
    }

    fn part_scores(&mut self, points: &[Point]) -> Result<Vec<f64>, CampaignError> {
        let number = self.parts;
        self.parts += 1;
        let Some(folder) = self.folder else { return self.target.scores(points) };
        let path = folder.flights_path().join(format!("{number:06}.scores"));
        let head = format!("{HEAD}\n{}\n{}\n", self.id, digest(points));
        if path.exists() {
            let scores = read(&path, &head, points.len())?;
            self.target.found(points.len() as u64);
            return Ok(scores);
        }
        let scores = self.target.scores(points)?;
        let lines: String = scores.iter().map(|score| format!("{score:?}\n")).collect();
        let written = output::write(&path, format!("{head}{lines}end\n"));
        written.map_err(|error| CampaignError::from(error).of_writing(&path))?;
        Ok(scores)
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
            scores.extend(self.part_scores(points)?);
        }
        Ok(scores)
    }
}

/// The scores of a part that is whole and of these points.
fn read(path: &Path, head: &str, count: usize) -> Result<Vec<f64>, CampaignError> {
    let foreign =
        |reason: &str| CampaignError::Foreign { path: path.to_owned(), reason: reason.to_owned() };
    let text = fspid_scenario::file::read_text(path)?;
    let Some(rest) = text.strip_prefix(head) else {
        return Err(foreign("it is not of these flights"));
    };
    let Some(lines) = rest.strip_suffix("end\n") else { return Err(foreign("its end is missing")) };
    let scores: Option<Vec<f64>> =
        lines.lines().map(|line| line.parse().ok().filter(|it: &f64| it.is_finite())).collect();
    match scores {
        Some(scores) if scores.len() == count => Ok(scores),
        _ => Err(foreign("it does not hold a number for each flight")),
    }
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
