//! Envelopes of responses: what pitch and elevator do in most flights, in all, and in the worst.

use fspid_page::analysis::{Chapter, Item, Picture};
use fspid_plot::{EnvelopeBand, EnvelopeFigure, EnvelopePanel};
use fspid_scenario::measure::Measure;

use super::reflown::{Curves, Flights, Reflown, reflown};
use super::words::{count, list, number};
use super::{Source, style};
use crate::statistics::Sorted;
use crate::statistics::quantile::quantile;
use crate::summary::{ControllerSummary, FailedRun, Severity};

/// Worst flights of each controller that are drawn.
const WORST: usize = 3;
/// Controllers in one figure, and in all of them.
const PANELS: usize = 4;
const MOST_PANELS: usize = 8;
/// Panels have one ordinate unless that of one of them is wider than its own by more than this.
const ALIKE: f64 = 4.0;
/// What lies beyond the middle nine tenths by more than this many times their width is cut.
const BEYOND: f64 = 0.75;
/// What lies beyond the nominal response by more than this many times its width is cut in any case.
const FAR_BEYOND: f64 = 6.0;

/// Bands narrower than this part of the widest are calm.
const CALM: f64 = 0.3;
/// The beginning has a figure of its own if it is shorter than this part of the flight.
const SHORT: f64 = 0.5;

/// A curve of a flight.
type Pick = fn(&Curves) -> &[f64];

pub(super) fn chapter(source: &Source<'_>) -> Chapter {
    let worst: Vec<Vec<u64>> = source.summary.controllers.iter().map(worst).collect();
    let items = match reflown(source, &worst, u64::MAX) {
        Ok(reflown) => items(source, &reflown),
        Err(reason) => vec![Item::Warning(format!(
            "Responses are not drawn, because the runs could not be flown again: {reason}."
        ))],
    };
    Chapter { id: "responses".to_owned(), title: "Responses".to_owned(), items }
}

/// What pitch does over time in the first runs of a campaign, flown again.
#[derive(Clone, Debug)]
pub struct Envelopes {
    /// How many of the first runs were looked at.
    pub runs: u64,
    /// How many of them have no curves: their numbers make no scenario, or another sample period.
    pub left_out: u64,
    /// One a controller.
    pub controllers: Vec<Envelope>,
}

/// What pitch does with one controller.
#[derive(Clone, Debug)]
pub struct Envelope {
    /// Bands from the widest to the narrowest, the median, the scenario's own response, and the worst ones.
    pub panel: EnvelopePanel,
    /// Numbers of the worst runs.
    pub worst: Vec<u64>,
    /// Flights that ended early: from then on they are in no band.
    pub ended: u64,
}

pub(super) fn envelopes(source: &Source<'_>, most: u64) -> Result<Envelopes, String> {
    let worst: Vec<Vec<u64>> = source.summary.controllers.iter().map(worst).collect();
    let reflown = reflown(source, &worst, most)?;
    let (time_s, setpoint) = (&*reflown.time_s, &*reflown.setpoint_deg);
    let shown = Quantity { time_s, setpoint, pick: |curves| &curves.pitch_deg };
    let one = |(place, flights): (usize, &Flights)| Envelope {
        panel: panel(source, place, flights, &shown),
        worst: flights.worst.iter().map(|(run, _)| *run).collect(),
        ended: flights.first.iter().filter(|it| it.pitch_deg.len() < time_s.len()).count() as u64,
    };
    let controllers = reflown.controllers.iter().enumerate().map(one).collect();
    Ok(Envelopes { runs: reflown.runs, left_out: reflown.left_out, controllers })
}

/// Flights that were lost, then those with the worst values of requirements and measures.
fn worst(controller: &ControllerSummary) -> Vec<u64> {
    let mut runs: Vec<u64> = Vec::new();
    let is_lost = |it: &&FailedRun| {
        matches!(
            it.severity,
            Severity::Diverged
                | Severity::HitGround
                | Severity::ControllerLost
                | Severity::PlantLost
                | Severity::Unstable
                | Severity::ModeNeverBegan
        )
    };
    let lost = controller.failed_runs.iter().filter(is_lost).map(|it| it.run);
    let required = controller.requirements.iter().filter_map(|it| it.worst).map(|it| it.run);
    let by_measure = [Measure::Overshoot, Measure::ErrorIntegral, Measure::LargestError];
    let highest = by_measure.into_iter().filter_map(|asked| {
        let measure = controller.measures.iter().find(|it| it.name == asked.name())?;
        measure.highest.first().map(|it| it.run)
    });
    for run in lost.chain(required).chain(highest) {
        if runs.len() < WORST && !runs.contains(&run) {
            runs.push(run);
        }
    }
    runs
}

fn items(source: &Source<'_>, reflown: &Reflown) -> Vec<Item> {
    let mut items = vec![Item::Text(said(source, reflown))];
    let all = reflown.controllers.len();
    let places: Vec<usize> = (0..all.min(MOST_PANELS)).collect();
    if all > places.len() {
        let words = format!("Drawn for the first {} of {all} controllers.", places.len());
        items.push(Item::Text(words));
    }
    let mut further = Vec::new();
    for (n, group) in places.chunks(PANELS).enumerate() {
        let list = if n == 0 { &mut items } else { &mut further };
        let views = group_views(source, reflown, group);
        // Of further controllers, the whole flight must do: pages shall stay small.
        let most = if n == 0 { usize::MAX } else { 1 };
        list.extend(views.into_iter().take(most).map(Item::Figures));
    }
    if !further.is_empty() {
        items.push(Item::Fold("Further controllers".to_owned(), further));
    }
    items
}

/// What the figures rest on.
fn said(source: &Source<'_>, reflown: &Reflown) -> String {
    let mut text = match reflown.runs {
        1 => "The first run, flown again for this page; it gave".to_owned(),
        runs => {
            let runs = count(runs);
            format!("The first {runs} runs, flown again for this page; the first of them gave")
        }
    };
    text.push_str(" the numbers in the file, bit for bit.");
    if reflown.left_out > 0 {
        text.push_str(&format!(
            " {} of them have no curves: their numbers make no scenario, or another sample period.",
            count(reflown.left_out)
        ));
    }
    for (n, controller) in reflown.controllers.iter().enumerate() {
        let whole = reflown.time_s.len();
        let ended = controller.first.iter().filter(|it| it.pitch_deg.len() < whole).count();
        if ended > 0 {
            text.push_str(&format!(
                " {}: {} of these flights ended early; from then on they are in no band.",
                source.name(n),
                count(ended as u64)
            ));
        }
    }
    text
}

/// Pitch and elevator of some controllers: the whole flight, and its beginning where all happens there.
fn group_views(source: &Source<'_>, reflown: &Reflown, group: &[usize]) -> Vec<Vec<Picture>> {
    let quantities: [(&str, &str, Pick); 2] = [
        ("Pitch", "pitch angle [deg]", |curves| &curves.pitch_deg),
        ("Elevator", "elevator deflection [deg]", |curves| &curves.elevator_deg),
    ];
    let panels = quantities.map(|(title, _, pick)| {
        let setpoint = if title == "Pitch" { reflown.setpoint_deg.as_slice() } else { &[] };
        let shown = Quantity { time_s: &reflown.time_s, setpoint, pick };
        let of = |place: &usize| Some((*place, reflown.controllers.get(*place)?));
        let chosen = group.iter().filter_map(of);
        let mut panels: Vec<EnvelopePanel> =
            chosen.map(|(place, flights)| panel(source, place, flights, &shown)).collect();
        scale(&mut panels);
        panels
    });
    let beginning = beginning(&reflown.time_s, panels.iter().flatten());
    let views = std::iter::once(None).chain(beginning.map(Some));
    let worst = worst_in_words(source, reflown, group);
    let view = |x_range: Option<(f64, f64)>| {
        let each = quantities.iter().zip(&panels);
        each.map(|((title, y_label, _), panels)| {
            let figure = EnvelopeFigure {
                title: match x_range {
                    Some((_, end)) => format!("{title}, first {} s", number(end)),
                    None => (*title).to_owned(),
                },
                x_label: "time [s]".to_owned(),
                y_label: (*y_label).to_owned(),
                x_range,
                panels: panels.clone(),
                width_px: 600.0,
            };
            let alike = panels.windows(2).all(|pair| pair[0].y_range == pair[1].y_range);
            let axes = if alike { "" } else { " Each panel has an ordinate of its own." };
            let caption = format!("{}. What leaves a panel is cut.{axes} {worst}", figure.title);
            let name = format!("responses-{}", title.to_lowercase());
            Picture { name, svg: figure.render(), caption }
        })
        .collect()
    };
    views.map(view).collect()
}

fn worst_in_words(source: &Source<'_>, reflown: &Reflown, group: &[usize]) -> String {
    let of = |place: &usize| Some((*place, reflown.controllers.get(*place)?));
    let named = group.iter().filter_map(of).filter(|(_, flights)| !flights.worst.is_empty());
    let words: Vec<String> = named
        .map(|(place, flights)| {
            let runs: Vec<String> = flights.worst.iter().map(|(run, _)| run.to_string()).collect();
            format!("{}: {}", source.name(place), list(&runs))
        })
        .collect();
    match words.is_empty() {
        true => String::new(),
        false => format!("Worst flights, by run: {}.", words.join("; ")),
    }
}

/// The part of the time after which flights differ little, if it is short enough for a figure of its own.
fn beginning<'a>(
    time_s: &[f64],
    panels: impl Iterator<Item = &'a EnvelopePanel>,
) -> Option<(f64, f64)> {
    let mut last = 0_usize;
    for band in panels.filter_map(|panel| panel.bands.get(1)) {
        let widths: Vec<f64> = band.upper.iter().zip(&band.lower).map(|(a, b)| a - b).collect();
        let widest = widths.iter().copied().filter(|it| it.is_finite()).fold(0.0, f64::max);
        let wide = |width: &f64| *width > CALM * widest;
        last = last.max(widths.iter().rposition(wide).unwrap_or(0));
    }
    let (start, end, calm) = (*time_s.first()?, *time_s.last()?, *time_s.get(last)?);
    // A little more, up to a whole second, or to a tenth of one where all is over sooner.
    let wanted = start + 1.2 * (calm - start);
    let shown = if wanted > 5.0 { wanted.ceil() } else { (10.0 * wanted).ceil() / 10.0 };
    let short = shown - start < SHORT * (end - start);
    (short && shown > start).then_some((start, shown))
}

/// What a panel shows over time, with its set-point where it has one.
struct Quantity<'a> {
    time_s: &'a [f64],
    setpoint: &'a [f64],
    pick: Pick,
}

fn panel(
    source: &Source<'_>,
    place: usize,
    flights: &Flights,
    shown: &Quantity<'_>,
) -> EnvelopePanel {
    let shares = [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0];
    let &Quantity { time_s, setpoint, pick } = shown;
    let mut lines: [Vec<f64>; 7] = Default::default();
    for k in 0..time_s.len() {
        let at: Vec<f64> = flights.first.iter().filter_map(|it| pick(it).get(k).copied()).collect();
        let sorted = Sorted::of(&at);
        for (line, share) in lines.iter_mut().zip(shares) {
            line.push(quantile(&sorted, share).unwrap_or(f64::NAN));
        }
    }
    let [lowest, low, quarter, median, upper, high, highest] = lines;
    let band = |name: &str, lower, upper| EnvelopeBand { name: name.to_owned(), lower, upper };
    EnvelopePanel {
        name: source.name(place),
        style: style(place),
        x: time_s.to_vec(),
        bands: vec![
            band("all", lowest, highest),
            band("5 to 95 %", low, high),
            band("25 to 75 %", quarter, upper),
        ],
        median,
        nominal: pick(&flights.nominal).to_vec(),
        worst: flights.worst.iter().map(|(_, curves)| pick(curves).to_vec()).collect(),
        setpoint: setpoint.to_vec(),
        y_range: None,
    }
}

/// Gives panels one ordinate, or each its own where one would hide what happens in another.
fn scale(panels: &mut [EnvelopePanel]) {
    let own: Vec<Option<(f64, f64)>> =
        panels.iter().map(|panel| range(std::slice::from_ref(panel))).collect();
    let all = range(panels);
    let width = |range: &Option<(f64, f64)>| range.map_or(0.0, |(lo, hi)| hi - lo);
    let alike = own.iter().all(|it| width(&all) <= ALIKE * width(it));
    for (panel, own) in panels.iter_mut().zip(own) {
        panel.y_range = if alike { all } else { own };
    }
}

/// Ends of the ordinate: all of most flights, and of the others what does not make them small.
fn range(panels: &[EnvelopePanel]) -> Option<(f64, f64)> {
    let nominal = ends(panels.iter().flat_map(|it| it.nominal.iter().chain(&it.setpoint)));
    let most = ends(panels.iter().flat_map(|it| {
        it.bands.iter().skip(1).flat_map(|band| band.lower.iter().chain(&band.upper))
    }));
    let all = ends(panels.iter().flat_map(|it| {
        let bands = it.bands.iter().flat_map(|band| band.lower.iter().chain(&band.upper));
        bands.chain(it.worst.iter().flatten())
    }));
    let widened = |(lo, hi): (f64, f64), by: f64| (lo - by * (hi - lo), hi + by * (hi - lo));
    let cut = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1.min(b.1));
    let join = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
    let nominal = nominal.or(most)?;
    let outermost = widened(nominal, FAR_BEYOND);
    let core = join(nominal, most.map_or(nominal, |most| cut(most, outermost)));
    let whole = join(core, all.map_or(core, |all| cut(all, widened(core, BEYOND))));
    Some(widened(whole, 0.04)).filter(|(lo, hi)| lo < hi)
}

fn ends<'a>(values: impl Iterator<Item = &'a f64>) -> Option<(f64, f64)> {
    let finite = values.copied().filter(|value| value.is_finite());
    finite.fold(None, |found, value| {
        Some(found.map_or((value, value), |(lo, hi): (f64, f64)| (lo.min(value), hi.max(value))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(width: impl Fn(f64) -> f64, time_s: &[f64]) -> EnvelopePanel {
        let band = |part: f64| EnvelopeBand {
            name: String::new(),
            lower: time_s.iter().map(|t| -part * width(*t)).collect(),
            upper: time_s.iter().map(|t| part * width(*t)).collect(),
        };
        EnvelopePanel {
            name: String::new(),
            style: style(0),
            x: time_s.to_vec(),
            bands: vec![band(1.0), band(0.9), band(0.5)],
            median: vec![0.0; time_s.len()],
            nominal: vec![0.0; time_s.len()],
            worst: Vec::new(),
            setpoint: vec![1.0; time_s.len()],
            y_range: None,
        }
    }

    fn times() -> Vec<f64> {
        (0..=500).map(|k| f64::from(k) * 0.1).collect()
    }

    #[test]
    fn the_beginning_ends_where_flights_differ_little() {
        let time_s = times();
        let calm = panel(|t| if t < 6.05 { 1.0 } else { 0.1 }, &time_s);
        assert_eq!(beginning(&time_s, [&calm].into_iter()), Some((0.0, 8.0)));
        let long = panel(|_| 1.0, &time_s);
        assert_eq!(beginning(&time_s, [&calm, &long].into_iter()), None);
        assert_eq!(beginning(&[], std::iter::empty()), None);
    }

    #[test]
    fn a_panel_that_another_would_flatten_has_an_ordinate_of_its_own() {
        let time_s = times();
        let mut panels = vec![panel(|_| 1.0, &time_s), panel(|_| 1.5, &time_s)];
        scale(&mut panels);
        assert_eq!(panels[0].y_range, panels[1].y_range);
        let mut panels = vec![panel(|_| 0.2, &time_s), panel(|_| 6.0, &time_s)];
        scale(&mut panels);
        assert_ne!(panels[0].y_range, panels[1].y_range);
    }
}
