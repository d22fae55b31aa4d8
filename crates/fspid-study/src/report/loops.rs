//! The report of `fspid analyse`: verdicts, margins, figures.

use super::command;
use crate::analysis::figures::{
    LoopFigures, MapQuantity, gain_map, gain_surface, pole_zero, radius_figure, root_locus,
};
use crate::analysis::{
    AnalysedLoop, Analysis, Equilibrium, FrozenMap, FrozenReach, Margins, PlantLoop, Stability,
};
use fspid_diagnostics::digits::to_six_decimals;
use fspid_page::analysis::{
    AnalysisPage, Chapter, DataTable, Datum, Item, Picture, Provenance, Standing, Verdict,
};
use fspid_page::number::{fixed, significant};
use fspid_plot::{LineFigure, LinePanel, Series, SeriesStyle, Svg};
use fspid_scenario::file::Study;
use fspid_sim::SimError;

/// Beyond this a step response has run away.
const RUN_AWAY: f64 = 10.0;

/// The page.
///
/// # Errors
/// Eigenvalues that are not found.
pub(super) fn report(study: &Study, analysis: &Analysis) -> Result<String, SimError> {
    let point = analysis.question.point.name();
    let mut chapters = vec![margins(analysis)];
    chapters.extend(responses(analysis));
    chapters.push(step(study)?);
    for found in &analysis.loops {
        chapters.extend(poles(found)?);
        chapters.extend(frozen(study, found));
        chapters.extend(flights(found));
    }
    let page = AnalysisPage {
        title: format!("{}: loop analysis", analysis.scenario),
        heading: analysis.scenario.clone(),
        lead: format!(
            "Linear analysis of the sampled loop, broken at the {point}, the others closed. Exact zero-order hold, actuator, delays and the controller as it is implemented; frequencies in rad/s."
        ),
        verdicts: analysis.loops.iter().map(verdict).collect(),
        warnings: study.warnings.clone(),
        beside: analysis.left_out.clone(),
        requirements: None,
        chapters,
        provenance: Provenance {
            command: command("analyse", study, &format!(" --broken-at {point}")),
            digest: study.digest.clone(),
            further: Vec::new(),
        },
    };
    Ok(page.render())
}

fn verdict(found: &AnalysedLoop) -> Verdict {
    let frozen = found.plants.iter().filter_map(PlantLoop::map);
    let frozen = Stability::of_all(frozen.map(FrozenMap::stability));
    let within_reach = found.plants.iter().filter_map(PlantLoop::reach);
    let within_reach = Stability::of_all(within_reach.map(FrozenReach::stability));
    let (standing, word) = match (found.stability(), found.margins()) {
        _ if found.absent.is_some() => (Standing::Fair, "No margins"),
        (Stability::Unstable, _) => (Standing::Bad, "UNSTABLE"),
        (Stability::Undecided, _) => (Standing::Bad, "UNDECIDED"),
        (Stability::Stable, _) if frozen != Stability::Stable => {
            (Standing::Bad, "Stable at rest, not at every gain")
        }
        (Stability::Stable, Err(_)) => (Standing::Fair, "Stable, no margins proved"),
        (Stability::Stable, Ok(_)) if within_reach != Stability::Stable => {
            (Standing::Fair, "Stable at rest, perhaps not at every gain")
        }
        (Stability::Stable, Ok(_)) if found.has_poor_margins() => {
            (Standing::Fair, "Stable, poor margins")
        }
        (Stability::Stable, Ok(_)) => (Standing::Good, "Stable"),
    };
    let detail = match found.margins() {
        Err(reason) => format!("{reason}."),
        Ok(margins) => {
            let around = around(found);
            let of = if around.is_some() { "Of the pitch loop alone, at rest" } else { "At rest" };
            let margins = format!(
                "{of}: gain margin {} dB, phase margin {} deg, disk margin {}.{}",
                decimal(margins.smaller_gain_margin_db(), 2),
                decimal(margins.phase_margin_deg, 1),
                fixed(margins.disk_margin, 3),
                of_frozen(found)
            );
            around.into_iter().chain([margins]).collect::<Vec<_>>().join(" ")
        }
    };
    Verdict { standing, word: word.to_owned(), name: found.name.clone(), detail }
}

/// What stands in the way although the pitch loop alone may be stable; none where nothing does.
fn around(found: &AnalysedLoop) -> Option<String> {
    if let Some(doubt) = found.doubt {
        return Some(format!("Nobody can tell: {doubt}."));
    }
    let growing = found.modes.iter().filter(|mode| mode.stability() == Stability::Unstable);
    let names: Vec<&str> = growing.map(|mode| mode.name.as_str()).collect();
    (!names.is_empty())
        .then(|| format!("With its outer loops it grows in mode {}.", names.join("; ")))
}

fn of_frozen(found: &AnalysedLoop) -> String {
    let worst = found.worst_frozen().map(|(_, worst)| &worst.margins);
    let looked_at = found.worst().and_then(PlantLoop::map).map_or(0, |map| map.points.len());
    let reach = found.worst_within_reach().map(|worst| &worst.margins);
    let disk = |margins: &Margins| fixed(margins.disk_margin, 3);
    match (worst, reach) {
        (Some(Ok(margins)), _) => {
            format!(
                " Of the {looked_at} gains on the map, frozen, and those searched about the worst of them the worst has a disk margin of {}.",
                disk(margins)
            )
        }
        (Some(Err(reason)), _) => {
            format!(" A frozen gain of its supervisor does not hold: {reason}.")
        }
        (None, Some(Ok(margins))) => format!(
            " Of the frozen gains looked at within its law's reach the worst has a disk margin of {}.",
            disk(margins)
        ),
        (None, Some(Err(reason))) => {
            format!(
                " Of the frozen gains looked at within its law's reach one does not hold: {reason}."
            )
        }
        (None, None) => String::new(),
    }
}

/// A number, or that it has no end.
fn decimal(value: f64, decimals: usize) -> String {
    if value.is_finite() { fixed(value, decimals) } else { "without end".to_owned() }
}

fn margins(analysis: &Analysis) -> Chapter {
    let head = [
        "controller",
        "gains",
        "gain margin [dB]",
        "phase margin [deg]",
        "delay margin [s]",
        "disk margin",
        "sensitivity peak",
        "gain crossover [rad/s]",
    ];
    let mut table = DataTable {
        caption:
            "Margins of each controller with each plant that lasts; of a self-tuning one at rest."
                .to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows: Vec::new(),
        cards: true,
    };
    for found in &analysis.loops {
        for plant in &found.plants {
            table.rows.push(row(found, plant));
        }
    }
    let items = vec![Item::Table(table)];
    Chapter { id: "margins".to_owned(), title: "Margins".to_owned(), items }
}

fn row(found: &AnalysedLoop, plant: &PlantLoop) -> Vec<Datum> {
    let name = match found.plants.len() {
        0 | 1 => found.name.clone(),
        _ => format!("{}, plant from {} s", found.name, to_six_decimals(plant.from_s)),
    };
    let gains = match &found.equilibrium {
        Equilibrium::Fixed(gains) | Equilibrium::AtRest(gains) => format!(
            "{} / {} / {}",
            significant(gains.kp, 4),
            significant(gains.ki, 4),
            significant(gains.kd, 4)
        ),
        Equilibrium::Drifts { .. } => "none".to_owned(),
    };
    let mut row = vec![Datum::Text(name), Datum::Number(gains)];
    match &plant.margins {
        Ok(margins) => row.extend(numbers(margins)),
        Err(reason) => {
            let word = plant.stability().word();
            row.push(Datum::Unmet(reason.to_string()));
            row.extend((0..5).map(|_| Datum::Absent(word.to_owned())));
        }
    }
    row
}

fn numbers(margins: &Margins) -> [Datum; 6] {
    let [low, high] = margins.gain_margin_db;
    let end = |value: f64, none: &str| {
        if value.is_finite() { format!("{value:+.2}") } else { none.to_owned() }
    };
    let number = |value: f64, decimals: usize| match value.is_finite() {
        true => Datum::Number(fixed(value, decimals)),
        false => Datum::Absent("without end".to_owned()),
    };
    [
        Datum::Number(format!("{} to {}", end(low, "\u{2212}\u{221e}"), end(high, "\u{221e}"))),
        number(margins.phase_margin_deg, 2),
        number(margins.delay_margin_s, 4),
        number(margins.disk_margin, 4),
        number(margins.sensitivity_peak, 4),
        number(margins.gain_crossover_rad_s.unwrap_or(f64::INFINITY), 3),
    ]
}

fn picture(name: &str, svg: Svg, caption: &str) -> Item {
    Item::Figure(Picture { name: name.to_owned(), svg, caption: caption.to_owned() })
}

fn responses(analysis: &Analysis) -> Option<Chapter> {
    let figures = LoopFigures::of(analysis);
    figures.any().then(|| Chapter {
        id: "responses".to_owned(),
        title: "Frequency responses".to_owned(),
        items: vec![
            picture("bode", figures.bode().render(), "Gain and phase of the open loop up to the Nyquist frequency, with the margins where they are read off."),
            picture("nyquist", figures.nyquist().render(), "The open loop near the critical point. A loop may not enter the disk of its own disk margin, and touches it."),
            picture("nichols", figures.nichols().render(), "The open loop over phase, with contours of the closed loop's gain."),
            picture("sensitivity", figures.sensitivity().render(), "Sensitivity and complementary sensitivity with their peaks."),
        ],
    })
}

fn step(study: &Study) -> Result<Chapter, SimError> {
    let responses = crate::analysis::step_responses(&study.scenario)?;
    let series = responses.into_iter().enumerate().map(|(number, answer)| Series {
        name: answer.name,
        style: SeriesStyle::Numbered(number),
        x: answer.time_s,
        // Of a loop that runs away only the beginning can be shown.
        y: answer.pitch.into_iter().map(|value| value.clamp(-RUN_AWAY, RUN_AWAY)).collect(),
        stairs: false,
    });
    let panel = LinePanel {
        y_label: "pitch per command [deg/deg]".to_owned(),
        x_label: "time [s]".to_owned(),
        series: series.collect(),
        ..LinePanel::default()
    };
    let title = "Step response of the linear loop".to_owned();
    let figure = LineFigure { title, panels: vec![panel], width_px: 720.0 };
    let caption =
        "Pitch after a step of the command, with the gains at rest, without limits and noise.";
    let items = vec![picture("step-figure", figure.render(), caption)];
    Ok(Chapter { id: "step".to_owned(), title: "Step response".to_owned(), items })
}

fn poles(found: &AnalysedLoop) -> Result<Option<Chapter>, SimError> {
    let Some(plant) = found.worst() else { return Ok(None) };
    let locus = root_locus(&found.name, plant)?.render();
    let map = pole_zero(&found.name, plant)?.render();
    let id = format!("poles-{}", found.name);
    Ok(Some(Chapter {
        id: id.clone(),
        title: format!("Poles of {}", found.name),
        items: vec![
            picture(
                &format!("{id}-locus"),
                locus,
                "Closed-loop poles while the gain of the loop is multiplied; the unit circle is the limit of stability.",
            ),
            picture(
                &format!("{id}-map"),
                map,
                "Poles and zeros of the open loop, and poles of the closed loop.",
            ),
        ],
    }))
}

/// What flights say, and the radii along the way.
fn flights(found: &AnalysedLoop) -> Option<Chapter> {
    let flights = found.flights.as_ref()?;
    let id = format!("flights-{}", found.name);
    let said = flights.lines().into_iter().map(|(label, sentence)| match label {
        "" => sentence,
        label => format!("{label}: {sentence}"),
    });
    let mut items = vec![
        Item::Text(
            "With every limit at work and gains that move; none of this is a proof.".to_owned(),
        ),
        Item::List(said.collect()),
    ];
    items.extend(flights.along.as_ref().map(|along| {
        let svg = radius_figure(&found.name, along).render();
        let caption = "Spectral radius of the loop linearised at every sample, with the gains frozen and with their derivatives. Values above 1 for a moment need not let the flight grow.";
        picture(&format!("{id}-radius"), svg, caption)
    }));
    Some(Chapter { id, title: format!("Flights of {}", found.name), items })
}

fn frozen(study: &Study, found: &AnalysedLoop) -> Option<Chapter> {
    let map = found.worst()?.map()?;
    let flown = crate::analysis::flown_inputs(study, &found.name);
    let id = format!("frozen-{}", found.name);
    let of = |quantity, what: &str| {
        let caption = format!(
            "The {what} at the {} gains on the map, each standing still; the line is the way of the flight. This is no proof about gains between them, nor about gains that move.",
            map.points.len()
        );
        let svg = gain_map(&found.name, map, quantity, flown.clone()).render();
        picture(&format!("{id}-{}", what.replace(' ', "-")), svg, &caption)
    };
    let svg = gain_surface(&found.name, map, MapQuantity::Phase).render();
    let caption = "The proportional gain that the supervisor produces over its inputs, coloured by the phase margin of the loop with the gains there.";
    let surface = picture(&format!("{id}-surface"), svg, caption);
    Some(Chapter {
        id: id.clone(),
        title: format!("Frozen gains of {}", found.name),
        items: vec![
            of(MapQuantity::Gain, "gain margin"),
            of(MapQuantity::Phase, "phase margin"),
            surface,
        ],
    })
}
