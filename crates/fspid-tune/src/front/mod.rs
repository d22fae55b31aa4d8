//! Fronts in place of points: every controller tuned alike at a ladder of efforts, and compared along the whole of it.
//!
//! A contest compares controllers that were allowed the same mean travel of the elevator; whoever chooses that travel may
//! choose the winner. Here one contest is held for each rung of a ladder of travels, in a folder of its own, and of each
//! controller, case and seed the error is a curve over the travel that its flights took on average. Curves are compared at
//! equal travel over the range that both have, all along it at once ([`Band`]).

mod band;
mod curves;
mod joint;
mod json;
mod over_travel;
mod page;
mod standing;
mod text;

use std::path::Path;

use fspid_diagnostics::digits::counted;
use fspid_scenario::measure::Measure;
use fspid_study::memory::Needed;
use fspid_study::output;
use fspid_study::shell::word;
use serde_json::Value;

pub use band::{Band, Cases, Travel, Unsuccessful};
pub use over_travel::Line;
pub use standing::{Dominance, FrontBar, Missing};

use crate::contest::{Contest, Judged, Options, Outcome, Progress, Then};
use crate::crew::Crew;
use crate::error::TuneError;
use crate::limit::NearLimit;
use crate::source::{Source, in_commands};

/// A ladder that nobody gave: shares of the limit that the scenario has.
const LADDER: [f64; 5] = [0.5, 0.7, 1.0, 1.4, 2.0];

/// A travel as people write one: its folder is called by it.
fn rounded_deg(travel_deg: f64) -> f64 {
    libm::round(1e6 * travel_deg) / 1e6
}

/// A contest for each rung of a ladder.
#[derive(Clone, Debug)]
pub struct Front {
    source: Source,
    /// Mean travel that is allowed, deg, with the contest that allows it.
    rungs: Vec<(f64, Contest)>,
}

/// Who is told where the limits are, and asked whether to go on.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// Is told.
    pub told: &'a dyn Fn(&str),
    /// Is asked.
    pub stop: fn() -> bool,
}

/// What came of a rung.
#[derive(Clone, Debug, PartialEq)]
pub struct Rung {
    /// Mean travel that was allowed, deg.
    pub travel_deg: f64,
    /// The contest.
    pub outcome: Outcome,
    /// How near its best designs come to the limit.
    pub near: NearLimit,
}

/// What came of a front.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontOutcome {
    /// The rungs, by travel.
    pub rungs: Vec<Rung>,
    /// The controllers, each but the one compared with, beside that one; none of a controller that is not tuned.
    pub bands: Vec<Band>,
    /// Words of the command that makes all of it again.
    pub command: String,
}

impl Front {
    /// Reads and checks; nothing is flown. Without travels, a ladder around the scenario's limit.
    ///
    /// # Errors
    /// As [`Contest::new`]; a scenario whose tuning does not limit the mean travel of the elevator.
    pub fn new(
        source: &Source,
        options: &Options,
        travels_deg: Option<&[f64]>,
    ) -> Result<Self, TuneError> {
        let template = source.template()?;
        let limits = template.study().tuning.iter().flat_map(|it| &it.limits).enumerate();
        let mut travel = limits.filter(|(_, it)| it.measure == Measure::ElevatorTravel);
        let Some((place, most)) = travel.next().and_then(|(at, it)| Some((at, it.most?))) else {
            let problem = "a front changes how far the elevator may go on average: it needs [[tuning.limit]] with measure = \"elevator_travel_deg\" and most";
            let path = source.path.display().to_string();
            let problems = vec![problem.to_owned()];
            return Err(TuneError::Contest { path, problems, wrong_cases: Vec::new() });
        };
        let around: Vec<f64> = LADDER.iter().map(|share| rounded_deg(share * most)).collect();
        let mut travels = travels_deg.map_or(around, <[f64]>::to_vec);
        travels.sort_by(f64::total_cmp);
        travels.dedup_by(|one, other| (*one - *other).abs() <= 0.0);
        let rung = |travel_deg: f64| {
            let mut source = source.clone();
            source.overrides.push(format!("tuning.limit[{place}].most={travel_deg}"));
            Ok((travel_deg, Contest::new(&source, options)?))
        };
        let rungs = travels.into_iter().map(rung).collect::<Result<_, TuneError>>()?;
        Ok(Self { source: source.clone(), rungs })
    }

    /// The contests, each with the mean travel that it allows, deg.
    pub fn contests(&self) -> impl Iterator<Item = (f64, &Contest)> {
        self.rungs.iter().map(|(travel_deg, contest)| (*travel_deg, contest))
    }

    /// Memory that its flights hold at once on so many threads, with all contests.
    #[must_use]
    pub fn needed(&self, threads: usize) -> Needed {
        let each = self.contests().map(|(_, contest)| contest.needed(threads));
        each.fold(Needed::for_flights(0, threads), Needed::and)
    }

    /// What is allowed and probably not meant, each once.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let Some((_, contest)) = self.rungs.first() else {
            return Vec::new();
        };
        let mut warnings = contest.warnings();
        if contest.seeds() < joint::FEWEST_SEEDS {
            warnings.push(format!(
                "a front of {} claims nothing: it takes {} or more",
                counted(contest.seeds(), "seed"),
                joint::FEWEST_SEEDS
            ));
        }
        warnings
    }

    /// Holds all contests, each in a folder of its own below the given one, where what is there already is not searched
    /// again; asks for the limit, and writes `front.json` and `front.html`. `tell` is told the place of the rung, too.
    ///
    /// # Errors
    /// As [`Contest::hold`].
    pub fn hold(
        &self,
        folder: &Path,
        crew: Crew<'_>,
        tell: &mut dyn FnMut(usize, &Progress) -> Then,
        asked: Asked<'_>,
    ) -> Result<FrontOutcome, TuneError> {
        let mut rungs = Vec::with_capacity(self.rungs.len());
        for (place, (travel_deg, contest)) in self.rungs.iter().enumerate() {
            let folder = folder.join(format!("travel-{travel_deg}-deg"));
            let outcome = contest.hold(&folder, crew, &mut |progress| tell(place, progress))?;
            let near = contest.near_limit(&outcome, asked.told, asked.stop)?;
            rungs.push(Rung { travel_deg: *travel_deg, outcome, near });
        }
        let judged: Vec<&Judged> = rungs.iter().map(|rung| &rung.outcome.judged).collect();
        let bands = band::all(&judged);
        let command = self.command(folder, &rungs);
        let outcome = FrontOutcome { rungs, bands, command };
        output::write(&folder.join("front.json"), format!("{:#}\n", outcome.json()))?;
        output::write(&folder.join("front.html"), page::page(&outcome))?;
        Ok(outcome)
    }

    fn command(&self, folder: &Path, held: &[Rung]) -> String {
        let mut words = vec![format!("fspid contest {}", word(&in_commands(&self.source.path)))];
        words.extend(self.source.overrides.iter().map(|it| format!("--set {}", word(it))));
        let travels: Vec<String> = self.rungs.iter().map(|(deg, _)| deg.to_string()).collect();
        let efforts = held.first().map_or(&[][..], |it| it.outcome.setting.efforts.as_slice());
        if let Some(effort) = efforts.first() {
            words.push(format!("--seeds {} --budget {}", efforts.len(), effort.budget));
        }
        words.push(format!("--front travel={}", travels.join(",")));
        words.push(format!("--out {}", word(&in_commands(folder))));
        words.join(" ")
    }
}

impl FrontOutcome {
    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        text::text(self)
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> Value {
        json::json(self)
    }

    /// Error over travel, of each controller and, last, the limit; none where no case is common to all.
    #[must_use]
    pub fn lines(&self) -> Vec<Line> {
        over_travel::lines(self)
    }

    /// Name of the controller that the others are compared with.
    #[must_use]
    pub fn against(&self) -> &str {
        let judged = self.rungs.first().map(|rung| &rung.outcome.judged);
        let name = judged.and_then(|it| it.contestants.get(it.against)).map(|it| it.name.as_str());
        name.unwrap_or_default()
    }
}
