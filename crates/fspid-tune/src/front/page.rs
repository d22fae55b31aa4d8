//! The page of a front: error over travel, and differences along it with their bands.

use fspid_page::analysis::{Chapter, DataTable, Datum, Item, Picture, Standing, Verdict};
use fspid_page::campaign::CampaignPage;
use fspid_plot::{LineFigure, LinePanel, Series, SeriesStyle, Svg, TradeFigure, TradeSeries};

use super::joint::{CONFIDENCE, DRAWS, FEWEST_CASES, FEWEST_SEEDS, PLACES};
use super::text::{beside_limits, change_pct, headline, nothing_allowed_at, share, whole};
use super::{Dominance, FrontOutcome, over_travel};

pub(super) fn page(outcome: &FrontOutcome) -> String {
    let name = match outcome.rungs.first().map(|rung| rung.outcome.setting.scenario.trim()) {
        None | Some("") => "Scenario without a name".to_owned(),
        Some(name) => name.to_owned(),
    };
    let is_decided = outcome.bands.iter().any(|band| band.dominance == Dominance::Dominates);
    let word = if is_decided { "Decided" } else { "Not decided" };
    CampaignPage {
        title: format!("{name}: front"),
        heading: format!("{name}: who wins along the front"),
        lead: "Every controller tuned alike at a ladder of efforts, and compared at equal travel all along it.".to_owned(),
        commands: outcome.command.clone(),
        verdicts: vec![Verdict {
            standing: if is_decided { Standing::Good } else { Standing::Fair },
            word: word.to_owned(),
            name: format!("compared with {}", outcome.against()),
            detail: headline(outcome),
        }],
        answer: answer(outcome),
        notes: notes(),
        chapters: vec![Chapter {
            id: "rungs".to_owned(),
            title: "The contests of the rungs".to_owned(),
            items: vec![Item::List(
                outcome
                    .rungs
                    .iter()
                    .map(|rung| {
                        let deg = rung.travel_deg;
                        format!("{deg} deg: travel-{deg}-deg/contest.html beside this page")
                    })
                    .collect(),
            )],
        }],
        ..CampaignPage::default()
    }
    .render()
}

fn answer(outcome: &FrontOutcome) -> Vec<Item> {
    let over = "Error over travel. A line goes through a controller's means at each effort, over its tunings and over the cases that have a limit and of which nobody lost a flight on any rung; its band says how far cases and tunings leave that open, everywhere at once and for all lines together, without how hard a case is for everybody. Who is better is decided by the differences below. The lowest line is the limit at the travel of the best design of the controller that the others are compared with; at its corners nobody gets below it.";
    let along = format!(
        "Change of the error from {} at equal travel, %, from the least to the most travel that both have in a case. All bands hold together and everywhere at once, at {:.0} %: below 0 everywhere is better on the whole front, where the signed ranks of the cases say so too and nothing bars it.",
        outcome.against(),
        100.0 * CONFIDENCE
    );
    let picture = |name: &str, svg, caption: String| {
        Item::Figure(Picture { name: name.to_owned(), svg, caption })
    };
    let mut items = Vec::new();
    match error_over_travel(outcome) {
        Some(svg) => items.push(picture("front", svg, over.to_owned())),
        None => items.push(Item::Warning("No case has a limit and a flight of everybody on every rung, so that there is no common curve to draw.".to_owned())),
    }
    if !outcome.bands.iter().all(|band| band.ends[0].is_empty()) {
        items.push(picture("along", differences(outcome), along));
    }
    items.push(Item::Table(standings(outcome)));
    let said = nothing_allowed_at(outcome).into_iter().chain(beside_limits(outcome));
    items.push(Item::List(outcome.bands.iter().map(whole).chain(said).collect()));
    items
}

fn notes() -> Vec<String> {
    vec![
        format!("Bands: the mean ± its error times a quantile of the largest deviation along the front. The error at each place is that of a contest, with a part for cases and one for the seeds of each controller, and Student's distribution by its degrees of freedom; the quantile comes of {DRAWS} draws of deviations that move along the front as cases and seeds do, with Bonferroni's correction for the number of controllers."),
        "The signed ranks of the cases have to agree at every place, as in a contest, with a case of which one loses more flights as its largest defeat: with n cases no p-value is below 2^(1\u{2212}n). Weights of cases count in means and in no test.".to_owned(),
        "Barred from being better: a controller all of whose flights fail, whose tunings found nothing allowed, or less often than those of the other, of which one is unstable at rest or undecided, or that loses more or, significantly by the signed ranks of the cases, fails more than the other, at an effort or over all of them.".to_owned(),
        format!("Assumed: cases and seeds are like draws of those that matter, and between two efforts error over travel is near a straight line in logarithms. With fewer than {FEWEST_SEEDS} seeds or {FEWEST_CASES} cases without lost flights and with a common range of travel, there is no band and nothing is claimed."),
    ]
}

fn error_over_travel(outcome: &FrontOutcome) -> Option<Svg> {
    let lines = over_travel::lines(outcome);
    let series = lines.into_iter().enumerate().map(|(place, line)| TradeSeries {
        name: line.controller.unwrap_or_else(|| "limit, proved".to_owned()),
        style: SeriesStyle::Numbered(place),
        points: line.points,
        is_joined: line.is_tuned,
        band: line.band,
    });
    let series: Vec<TradeSeries> = series.collect();
    let figure = TradeFigure {
        title: "Error over travel".to_owned(),
        x_label: "mean elevator travel [deg]".to_owned(),
        y_label: "mean IAE [deg s]".to_owned(),
        series,
    };
    (!figure.series.is_empty()).then(|| figure.render())
}

fn differences(outcome: &FrontOutcome) -> Svg {
    let panels = outcome.bands.iter().filter(|band| !band.ends[0].is_empty()).map(|band| {
        let line = |name: String, style, values: &[f64]| Series {
            name,
            style,
            x: (0..PLACES).map(share).collect(),
            y: values.iter().map(|it| change_pct(*it)).collect(),
            stairs: false,
        };
        let [lower, upper] = &band.ends;
        let ends = SeriesStyle::Numbered(1);
        LinePanel {
            y_label: format!("change of IAE [%], {}", band.name),
            x_label: "along the common range of travel [%]".to_owned(),
            series: vec![
                line("no change".to_owned(), SeriesStyle::Setpoint, &[0.0; PLACES]),
                line("mean".to_owned(), SeriesStyle::Numbered(0), &band.middle),
                line(format!("{:.0} %, everywhere at once", 100.0 * CONFIDENCE), ends, lower),
                line(String::new(), ends, upper),
            ],
            ..LinePanel::default()
        }
    });
    LineFigure {
        title: format!("Change of the error from {}", outcome.against()),
        panels: panels.collect(),
        width_px: 760.0,
    }
    .render()
}

fn standings(outcome: &FrontOutcome) -> DataTable {
    let head = [
        "controller",
        "standing",
        "cases",
        "lost cases",
        "lost",
        "failed",
        "unstable at rest",
        "undecided",
    ];
    let row = |band: &super::Band| {
        let [own, against] = band.flights;
        let both = |one: u64, other: u64| Datum::Number(format!("{one}, {other}"));
        vec![
            Datum::Text(band.name.clone()),
            Datum::Text(band.dominance.words().to_owned()),
            Datum::Number(format!("{} of {}", band.cases.compared, band.cases.of())),
            Datum::Number(band.cases.lost.to_string()),
            both(own.lost, against.lost),
            both(own.failed, against.failed),
            both(own.unstable, against.unstable),
            both(own.undecided, against.undecided),
        ]
    };
    DataTable {
        caption: format!(
            "Fronts beside that of {}; flights of all efforts, its own and of the one compared with",
            outcome.against()
        ),
        head: head.map(str::to_owned).to_vec(),
        rows: outcome.bands.iter().map(row).collect(),
        cards: true,
    }
}
