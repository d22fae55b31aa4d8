//! A campaign: rows of measures as they are flown, then what all of them say.

use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use fspid_campaign::report::{self, Envelope};
use fspid_campaign::sample::Sampling;
use fspid_campaign::summary::{self, Summary, SummarySettings};
use fspid_campaign::table::{Cell, ColumnTable, Reader};
use fspid_campaign::{
    CampaignError, Folder, Question, Range, Shards, USUAL_RUNS, USUAL_SEED, local, rows,
};
use fspid_diagnostics::digits::grouped;
use fspid_scenario::count::RUNS;
use fspid_scenario::measure::Measure;
use serde_json::{Value, json};

use super::asked::counted;
use super::job::Job;
use super::rest::Rest;
use super::task::{Ended, Task};
use crate::answer::Refusal;
use crate::request::Fields;

/// Measures of rows where nobody asks for others.
const MEASURES: [&str; 4] = [
    Measure::Overshoot.name(),
    Measure::SettlingTime.name(),
    Measure::ErrorIntegral.name(),
    Measure::LargestCommand.name(),
];
/// Shards of a campaign, of which each is told when it is there.
const SHARDS: u64 = 64;
/// Most runs of a shard.
const MOST_OF_SHARD: u64 = 2048;
/// How often it is told how far it is.
const TICK: Duration = Duration::from_millis(200);
/// Most rows that are told; of more, the summary tells.
const MOST_ROWS: usize = 50_000;
/// Runs whose responses are flown again for the first envelope; each further one has so many times as many.
const FIRST_ENVELOPE: u64 = 20;
const LARGER: u64 = 5;
/// Most runs and most instants of an envelope.
const MOST_OF_ENVELOPE: u64 = 400;
const MOST_INSTANTS: usize = 250;

/// The options of `fspid campaign run`, and which measures are told.
#[derive(Clone, Debug)]
pub(super) struct Campaign {
    pub(super) overrides: Vec<String>,
    runs: u64,
    seed: u64,
    sampling: Sampling,
    measures: Vec<String>,
}

impl Campaign {
    pub(super) fn read(options: &mut Fields) -> Result<Self, Refusal> {
        let sampling =
            options.text("sampling")?.unwrap_or_else(|| Sampling::Random.name().to_owned());
        let known: Vec<&str> = rows::measure_names().map(|(name, _)| name).collect();
        let unknown = |what: &str, word: &str, known: &[&str]| {
            let known = fspid_diagnostics::known_words(word, known);
            Refusal::wrong(format_args!("there is no {what} `{word}`{known}"))
        };
        let mut measures = options.texts("measures")?;
        if let Some(word) = measures.iter().find(|it| !known.contains(&it.as_str())) {
            return Err(unknown("measure", word, &known));
        }
        if measures.is_empty() {
            measures = MEASURES.map(str::to_owned).to_vec();
        }
        Ok(Self {
            overrides: options.texts("set")?,
            runs: counted(options, "runs", RUNS)?.unwrap_or(USUAL_RUNS),
            seed: options.whole("seed")?.unwrap_or(USUAL_SEED),
            sampling: Sampling::from_name(&sampling)
                .ok_or_else(|| unknown("sampling", &sampling, &Sampling::NAMES))?,
            measures,
        })
    }

    /// Runs that are held in memory together.
    pub(super) fn runs_of_shard(&self) -> u64 {
        self.runs.div_ceil(SHARDS).clamp(1, MOST_OF_SHARD)
    }

    pub(super) fn work(&self, task: &Task<'_>) -> Result<Value, Ended> {
        let folder = Folder::new(&task.folder);
        let question = Question {
            scenario: &task.source.path,
            overrides: &task.source.overrides,
            runs: self.runs,
            seed: self.seed,
            sampling: self.sampling,
            shards: Shards::Of(self.runs_of_shard()),
        };
        let campaign = fspid_campaign::plan(&question, &folder)?;
        folder.put_plan(campaign.plan())?;
        task.tell(
            "begun",
            &json!({ "runs": self.runs, "seed": self.seed, "measures": self.measures }),
        );
        let mut teller = Teller {
            task,
            folder: &folder,
            measures: &self.measures,
            rows: 0,
            rest: Rest::new(),
            next_envelope: FIRST_ENVELOPE,
            runs: self.runs,
        };
        let progress = &task.job.campaign;
        ticking(task.job, self.runs, || {
            local::run_here(&folder, &campaign, progress, &mut |range| teller.tell(range))
        })?;
        let summary = Summary::of(&folder.merged_path(), SummarySettings::default());
        let summary = summary.map_err(Ended::failed)?;
        tell_envelopes(task, &folder.merged_path(), &summary, MOST_OF_ENVELOPE);
        Ok(json!({ "text": summary::text(&summary), "json": summary::json(&summary) }))
    }
}

/// Works, and tells meanwhile how far it is: a shard of slow flights can take a minute.
fn ticking<T>(job: &Job, runs: u64, work: impl FnOnce() -> T) -> T {
    let mut told = None;
    let mut tell = move || {
        let progress = &job.campaign;
        let now = (progress.flown() + progress.found(), progress.failed());
        if told.replace(now) != Some(now) {
            job.progress(now.0, runs, &format!("runs, {} flights failed", grouped(now.1)));
        }
    };
    thread::scope(|scope| {
        // Dropped when the work ends, in whatever way.
        let (work_goes_on, ended) = mpsc::channel::<()>();
        let ticks = scope.spawn(move || {
            while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                tell();
            }
            tell();
        });
        let done = work();
        drop(work_goes_on);
        // What it told is told before what comes next.
        let _ = ticks.join();
        done
    })
}

/// Tells what a shard holds.
struct Teller<'a> {
    task: &'a Task<'a>,
    folder: &'a Folder,
    measures: &'a [String],
    /// Rows told so far.
    rows: usize,
    /// When the next summary of what there is may be made.
    rest: Rest,
    next_envelope: u64,
    runs: u64,
}

impl Teller<'_> {
    fn tell(&mut self, range: Range) -> Result<(), CampaignError> {
        if self.task.is_stopped() {
            return Err(CampaignError::Stopped);
        }
        if self.rows < MOST_ROWS {
            let path = self.folder.shard_path(range);
            let names = [rows::RUN, rows::CONTROLLER, rows::VERDICT].into_iter();
            let names: Vec<&str> = names.chain(self.measures.iter().map(String::as_str)).collect();
            let reader = Reader::open(path)?;
            for table in reader.columns(&names)? {
                let table = table?;
                self.rows += table.rows();
                self.task.tell(
                    "rows",
                    &json!({ "columns": names, "rows": listed(&table, names.len()) }),
                );
            }
        }
        if let Some(began) = self.rest.is_over() {
            self.tell_spread();
            self.rest.begin(began);
        }
        Ok(())
    }

    /// Tells what the runs say that there are. What goes wrong with that goes wrong with all of them in the end, and is told
    /// there.
    fn tell_spread(&mut self) {
        let settings = SummarySettings { incomplete: true, ..SummarySettings::default() };
        let Ok(summary) = Summary::of(self.folder.path(), settings) else { return };
        let mut told = summary::json(&summary);
        self.shorten(&mut told);
        self.task.tell("spread", &told);
        let runs = summary.head.runs;
        if runs >= self.next_envelope && runs < self.runs {
            self.next_envelope = runs.saturating_mul(LARGER);
            let most = runs.min(MOST_OF_ENVELOPE);
            tell_envelopes(self.task, self.folder.path(), &summary, most);
        }
    }

    /// Of a summary that more follow: the measures that were asked for, and nothing that is the same in all of them.
    fn shorten(&self, told: &mut Value) {
        let Some(told) = told.as_object_mut() else { return };
        let kept = ["runs", "planned_runs", "controllers", "notes"];
        told.retain(|key, _| kept.contains(&key.as_str()));
        let controllers = told.get_mut("controllers").and_then(Value::as_array_mut);
        for controller in controllers.into_iter().flatten().filter_map(Value::as_object_mut) {
            controller.remove("sensitivities");
            let measures = controller.get_mut("measures").and_then(Value::as_array_mut);
            let is_asked = |it: &Value| self.measures.iter().any(|name| it["name"] == **name);
            measures.into_iter().for_each(|measures| measures.retain(is_asked));
        }
    }
}

/// Tells what pitch does in the first runs, flown again; or why that is not known.
fn tell_envelopes(task: &Task<'_>, path: &Path, summary: &Summary, most: u64) {
    let settings = SummarySettings { incomplete: true, ..SummarySettings::default() };
    let told = match report::envelopes(path, summary, settings, most) {
        Ok(found) => {
            let controllers: Vec<Value> = found.controllers.iter().map(envelope).collect();
            json!({ "runs": found.runs, "left_out": found.left_out, "controllers": controllers })
        }
        Err(reason) => json!({ "reason": reason }),
    };
    task.tell("envelope", &told);
}

/// One controller's, at fewer instants: null where no flight is any more.
fn envelope(found: &Envelope) -> Value {
    let panel = &found.panel;
    let every = panel.x.len().div_ceil(MOST_INSTANTS).max(1);
    // Nobody sees more than four digits after the point, and JSON would have seventeen.
    let short = |value: &f64| value.is_finite().then(|| (value * 1e4).round() / 1e4);
    let few = |values: &[f64]| values.iter().step_by(every).map(short).collect::<Vec<_>>();
    let bands = panel.bands.iter().map(
        |band| json!({ "name": band.name, "lower": few(&band.lower), "upper": few(&band.upper) }),
    );
    let worst = panel.worst.iter().zip(&found.worst);
    let worst = worst.map(|(curve, run)| json!({ "run": run, "pitch_deg": few(curve) }));
    json!({
        "name": panel.name,
        "time_s": few(&panel.x),
        "setpoint_deg": few(&panel.setpoint),
        "bands": bands.collect::<Vec<_>>(),
        "median": few(&panel.median),
        "nominal": few(&panel.nominal),
        "worst": worst.collect::<Vec<_>>(),
        "ended_early": found.ended,
    })
}

/// The cells of a table, row by row; null where a flight has no such measure.
fn listed(table: &ColumnTable, columns: usize) -> Vec<Vec<Value>> {
    let cell = |row, column| match table.cell(row, column) {
        // JSON has no other numbers, and null says something else.
        Some(Cell::Float(value)) if !value.is_finite() => value.to_string().into(),
        Some(Cell::Float(value)) => value.into(),
        Some(Cell::Integer(value)) => value.into(),
        Some(Cell::Text(value)) => value.into(),
        Some(Cell::Boolean(value)) => value.into(),
        Some(Cell::Absent) | None => Value::Null,
    };
    (0..table.rows()).map(|row| (0..columns).map(|column| cell(row, column)).collect()).collect()
}
