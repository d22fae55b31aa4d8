//! The levels as a figure: how likely it is to come so near to the limit, and beyond it.

use fspid_plot::{LineFigure, LinePanel, Series, SeriesStyle};

use super::answer::Rare;
use super::subset::Subset;

/// Width of the figure, px.
const WIDTH_PX: f64 = 640.0;

/// The figure as SVG; of importance sampling alone there are no levels, and it is empty.
pub(super) fn levels(rare: &Rare) -> String {
    let requirement = &rare.requirement;
    let unit = match requirement.measure.unit() {
        "" => String::new(),
        unit => format!(" [{unit}]"),
    };
    let panel = LinePanel {
        y_label: "log10 of the probability".to_owned(),
        x_label: format!("distance of {} to its limit, inside positive{unit}", requirement.id),
        series: rare.found.subset.as_ref().map(series).unwrap_or_default(),
        ..LinePanel::default()
    };
    let title = format!("{}: how likely it is to come so near to the limit", rare.controller);
    LineFigure { title, panels: vec![panel], width_px: WIDTH_PX }.render().to_string()
}

/// The mean of the teams, then each team.
fn series(subset: &Subset) -> Vec<Series> {
    let x: Vec<f64> = subset.rungs.iter().map(|rung| -rung.level).chain([0.0]).collect();
    let last = subset.teams.shares.len();
    let line = |name: &str, style: SeriesStyle, y: Vec<f64>| Series {
        name: name.to_owned(),
        style,
        x: x.clone(),
        y: y.into_iter().map(libm::log10).collect(),
        stairs: false,
    };
    let mean = (1..=last).map(|rungs| subset.reached(rungs)).collect();
    let by_team: Vec<Vec<f64>> = (1..=last).map(|rungs| subset.teams.estimates(rungs)).collect();
    let team = |number: usize| -> Vec<f64> {
        by_team.iter().filter_map(|all| all.get(number)).copied().collect()
    };
    let teams = (0..super::teams::TEAMS).map(|number| {
        let name = if number == 0 { "each of the ten teams" } else { "" };
        line(name, SeriesStyle::Setpoint, team(number))
    });
    teams.chain([line("mean", SeriesStyle::Numbered(0), mean)]).collect()
}
