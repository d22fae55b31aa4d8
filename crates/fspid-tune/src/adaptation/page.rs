//! The page: what the win is made of, then what that rests on.

use fspid_campaign::Plan;
use fspid_diagnostics::digits::counted;
use fspid_page::analysis::{Chapter, DataTable, Datum, Item, Picture, Standing as Colour, Verdict};
use fspid_page::campaign::CampaignPage;
use fspid_plot::{
    IntervalColumn, IntervalFigure, IntervalMark, IntervalRow, SeriesStyle, Svg, TradeFigure,
    TradeSeries,
};
use fspid_study::shell::word;

use super::answer::{Answer, PlantRow};
use super::draws::Estimate;
use super::text::{UNDEFINED, broken, change, gains, known, lost, moved, name, share, unstable};
use super::treatment::Treatment;

impl Answer {
    /// The page as one HTML file.
    #[must_use]
    pub fn page(&self) -> String {
        let scenario = match self.scenario.trim() {
            "" => "Scenario without a name",
            name => name,
        };
        CampaignPage {
            title: format!("{scenario}: adaptation"),
            heading: format!("{scenario}: does {} adapt?", self.controller),
            lead: self.detail(),
            facts: self.facts(),
            commands: self.command(),
            verdicts: vec![self.verdict()],
            answer: self.answer_items(),
            notes: self.notes(),
            chapters: vec![self.treatments(), self.movement(), self.plants_chapter()],
        }
        .render()
    }

    fn verdict(&self) -> Verdict {
        let adapts = self.helps(Treatment::AsItIs);
        let (word, standing) = match (self.is_told(), &self.barred, adapts) {
            (false, _, _) => ("Open", Colour::Fair),
            (true, Some(_), _) => ("No win", Colour::Bad),
            (true, None, true) => ("Adapts", Colour::Good),
            (true, None, false) => ("Not shown to adapt", Colour::Fair),
        };
        let detail = format!("{} {}", self.headline(), self.detail());
        Verdict { standing, word: word.to_owned(), name: self.controller.clone(), detail }
    }

    fn facts(&self) -> Vec<(String, String)> {
        let fact = |what: &str, value: String| (what.to_owned(), value);
        let (seeds, seed, budget) = self.effort;
        vec![
            fact("self-tuner", self.controller.clone()),
            fact(
                "compared with",
                self.against.clone().unwrap_or("its own nominal gains".to_owned()),
            ),
            fact("flights", format!("{} of {}", self.flights, counted(self.plants.len(), "plant"))),
            fact(
                "in the win",
                format!("{} of {}", self.kept, counted(self.plants_kept(), "plant")),
            ),
            fact("shuffles of each flight", format!("{seeds}, seeds from {seed} on")),
            fact("candidates for each plant", budget.to_string()),
            fact("digest of the scenario", self.digest.clone()),
            fact("by", Plan::this_program()),
        ]
    }

    /// The command that makes it again.
    #[must_use]
    pub fn command(&self) -> String {
        let (seeds, seed, budget) = self.effort;
        let mut words = vec![format!("fspid adaptation {}", word(&self.file))];
        words.push(format!("--controller {}", word(&self.controller)));
        words.extend(self.against.iter().map(|it| format!("--against {}", word(it))));
        words.extend(self.overrides.iter().map(|it| format!("--set {}", word(it))));
        words.push(format!("--seeds {seeds} --seed {seed} --budget {budget}"));
        words.extend(self.runs.map(|runs| format!("--runs {runs}")));
        words.join(" ")
    }

    fn answer_items(&self) -> Vec<Item> {
        let rows = self.steps.iter().map(|step| {
            let (_, words) = self.called(step);
            vec![
                Datum::Text(words.to_owned()),
                number(step.iae, change),
                number(step.share, share),
                number(step.travel, change),
            ]
        });
        let (what, whole) = (self.made_of(), self.whole());
        let caption = format!(
            "{what}, one thing after the other; shares are of the logarithm of the ratio, and add up. A share below zero makes it worse."
        );
        let of_whole = format!("share of the {whole}");
        let head = ["what comes in", "IAE", &of_whole, "travel of the elevator"];
        let sure = match self.steps.iter().any(|it| it.iae.is_some_and(|it| it.interval.is_some()))
        {
            true => ", with 95 % over plants and seeds",
            false => "",
        };
        let shares = format!(
            "Change of the IAE as one thing after the other comes in, left of 0 is better{sure}."
        );
        vec![
            Item::Heading(what),
            picture("steps", self.steps_figure(), &shares),
            Item::Table(table(&caption, &head, rows.collect())),
        ]
    }

    fn steps_figure(&self) -> Svg {
        let rows = self.steps.iter().map(|step| IntervalRow {
            name: self.called(step).1.to_owned(),
            words: step.share.map_or(String::new(), |it| share(Estimate { interval: None, ..it })),
            marks: marks(step.iae, step.travel),
        });
        interval_figure("What comes in changes", rows.collect())
    }

    fn treatments(&self) -> Chapter {
        let rows = self.rows.iter().map(|row| IntervalRow {
            name: name(self, row),
            words: match row.lost {
                0 => String::new(),
                lost => format!("{lost} lost"),
            },
            marks: marks(row.iae, row.travel),
        });
        let figure = interval_figure("Difference from the flights as they are", rows.collect());
        let told = self.rows.iter().map(|row| {
            vec![
                Datum::Text(name(self, row)),
                number(row.iae, change),
                number(row.travel, change),
                Datum::Number(lost(row)),
                Datum::Number(broken(row)),
                Datum::Number(unstable(row)),
            ]
        });
        let head = ["flown", "IAE", "travel", "lost", "breaks a requirement", "unstable at rest"];
        let caption = "The same flights with something else in the place of the supervisor's gains, beside them as they are (geometric mean of the ratios).";
        let items = vec![
            picture(
                "flown",
                figure,
                "Everything behind the gains is the same: what follows them, limits, servo, sensors, air.",
            ),
            Item::Table(table(caption, &head, told.collect())),
        ];
        chapter("flown", "The same flights, treated", items)
    }

    fn movement(&self) -> Chapter {
        let mut items = vec![
            Item::List(self.moved.iter().map(moved).collect()),
            Item::Heading("What the mean gains follow".to_owned()),
            Item::Text("Slopes are of logarithms: per cent of the gain for a per cent of the other. A self-tuner that adapts wholly has the slope 1 with the best gain of the plant.".to_owned()),
            Item::List(self.follows()),
        ];
        let names = ["kp", "ki", "kd"];
        let pictures = names.into_iter().enumerate().filter_map(|(gain, name)| {
            let svg = self.gain_figure(gain, name)?;
            let caption = format!("{name} of each plant over the effectiveness of its elevator: the mean of its flights, and the best.");
            Some(Picture { name: format!("follows-{name}"), svg, caption })
        });
        let pictures: Vec<Picture> = pictures.collect();
        if !pictures.is_empty() {
            items.push(Item::Figures(pictures));
        }
        chapter("gains", "How the gains move, and what they follow", items)
    }

    fn gain_figure(&self, gain: usize, name: &str) -> Option<Svg> {
        let parts = |it: fspid_core::Gains<f64>| [it.kp, it.ki, it.kd][gain];
        let points = |of: &dyn Fn(&PlantRow) -> Option<f64>| -> Vec<(f64, f64)> {
            self.plants.iter().filter_map(|it| Some((it.effectiveness_1_s2?, of(it)?))).collect()
        };
        let means = points(&|it| Some(parts(it.mean)));
        let best = points(&|it| it.best.map(parts));
        (means.len() > 1).then(|| {
            let series = |name: &str, place, points| TradeSeries {
                name: name.to_owned(),
                style: SeriesStyle::Numbered(place),
                points,
                is_joined: false,
                band: Vec::new(),
            };
            TradeFigure {
                title: format!("{name} of each plant"),
                x_label: "effectiveness of the elevator [1/s²]".to_owned(),
                y_label: name.to_owned(),
                series: vec![series("mean of its flights", 0, means), series("best", 1, best)],
            }
            .render()
        })
    }

    fn plants_chapter(&self) -> Chapter {
        let rows = self.plants.iter().map(|row| {
            let mut cells = vec![
                Datum::Text(row.name.clone()),
                Datum::Number(row.flights.to_string()),
                Datum::Number(row.kept.to_string()),
                Datum::Number(known(row.effectiveness_1_s2)),
                Datum::Number(known(row.airspeed_m_s)),
            ];
            cells.extend(gains(row).into_iter().flatten().map(Datum::Number));
            cells
        });
        let head = [
            "first case of the plant",
            "flights",
            "in the win",
            "effectiveness [1/s²]",
            "airspeed [m/s]",
            "kp, mean",
            "kp, best",
            "ki, mean",
            "ki, best",
            "kd, mean",
            "kd, best",
        ];
        let caption = "A plant is an aircraft at a condition with its actuator. The best gains have the least IAE at no more travel than the flights as they are, and break nothing that these keep.";
        let items = vec![Item::Table(table(caption, &head, rows.collect()))];
        chapter("plants", "The plants", items)
    }
}

fn number(found: Option<Estimate>, of: fn(Estimate) -> String) -> Datum {
    found.map_or_else(|| Datum::Absent(UNDEFINED.to_owned()), |it| Datum::Number(of(it)))
}

fn marks(iae: Option<Estimate>, travel: Option<Estimate>) -> Vec<IntervalMark> {
    let mark = |(column, found): (usize, Option<Estimate>)| {
        let percent = found?.map(|it| 100.0 * (it - 1.0));
        let [lower, upper] = percent.interval.unwrap_or([percent.value; 2]);
        let style = SeriesStyle::Numbered(0);
        Some(IntervalMark { column, style, value: percent.value, lower, upper })
    };
    [iae, travel].into_iter().enumerate().filter_map(mark).collect()
}

fn interval_figure(title: &str, rows: Vec<IntervalRow>) -> Svg {
    let column = |label: &str| IntervalColumn { label: label.to_owned(), range: None, stems: true };
    IntervalFigure {
        title: title.to_owned(),
        columns: vec![column("IAE [%]"), column("elevator travel [%]")],
        rows,
        series: Vec::new(),
        width_px: 760.0,
    }
    .render()
}

fn table(caption: &str, head: &[&str], rows: Vec<Vec<Datum>>) -> DataTable {
    let head = head.iter().map(|it| (*it).to_owned()).collect();
    DataTable { caption: caption.to_owned(), head, rows, cards: true }
}

fn picture(name: &str, svg: Svg, caption: &str) -> Item {
    Item::Figure(Picture { name: name.to_owned(), svg, caption: caption.to_owned() })
}

fn chapter(id: &str, title: &str, items: Vec<Item>) -> Chapter {
    Chapter { id: id.to_owned(), title: title.to_owned(), items }
}
