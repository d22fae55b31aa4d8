//! Time responses as figures.

use fspid_sim::autopilot::Autopilot;
use fspid_sim::{AircraftPlant, Controller, EarlyEnd, EndCause, Outcome, Scenario, Trace};

use super::around::{self, Panel, Shown};
use super::flight_path::{self, Flown};
use crate::simulation::{ControllerResult, Simulation};
use fspid_plot::{Band, LineFigure, LinePanel, Series, SeriesStyle, Svg};
use fspid_scenario::units::degrees;

/// How a flight is drawn.
pub struct Drawing<'a> {
    /// Above the figure.
    pub title: &'a str,
    /// The scenario that was flown.
    pub scenario: &'a Scenario,
    /// What happened.
    pub simulation: &'a Simulation,
    /// Only these controllers; all of them if empty.
    pub only: &'a [&'a str],
    /// Also the elevator, and bands of 2 % about the set-points; colours by place, not by name.
    pub detailed: bool,
    /// Width, px: the narrower, the larger the letters where the figure is fitted to a column.
    pub width_px: f64,
}

/// What panels are about.
#[derive(Clone, Copy)]
enum Part {
    Angles,
    Air,
    Side,
    Loads,
    Gains,
}

/// A command beyond this many times its 99th percentile is a spike, and the panel does not show it.
const SPIKE: f64 = 3.0;
/// A pitch panel shows at most this many times the largest good excursion where a loop fails.
const HEADROOM: f64 = 1.6;

/// Colour and dashes: the same for the same kind of controller throughout the paper's figures.
fn style(name: &str, index: usize) -> SeriesStyle {
    SeriesStyle::Numbered(match name {
        "FSPID" | "FSPID 1" => 0,
        "CPID" | "CPID 1" => 1,
        "PC" => 2,
        "FSPID 2" | "FSPID tuned" => 3,
        "CPID 2" | "CPID tuned" => 4,
        _ => index,
    })
}

impl Drawing<'_> {
    /// Draws pitch, command and, for self-tuning controllers, the three gains.
    pub fn render(&self) -> Svg {
        let panels = [self.angles(), self.air(), self.gains()].concat();
        self.figure(self.title.to_owned(), panels)
    }

    /// The same as a figure for each kind, to stand side by side: what it shows, in words, and the drawing.
    pub fn parts(&self) -> Vec<(String, Svg)> {
        let parts = [
            (Part::Angles, "angles", self.angles()),
            (Part::Air, "through the air", self.air()),
            (Part::Side, "from the side", self.side_view()),
            (Part::Loads, "load factor and airspeed", self.loads()),
            (Part::Gains, "gains", self.gains()),
        ];
        let drawn = parts.into_iter().filter(|(_, _, panels)| !panels.is_empty());
        let figure = |(part, what, panels)| {
            (self.in_words(part), self.figure(format!("{}: {what}", self.title), panels))
        };
        drawn.map(figure).collect()
    }

    fn figure(&self, title: String, panels: Vec<LinePanel>) -> Svg {
        LineFigure { title, panels, width_px: self.width_px }.render()
    }

    /// The autopilot around the loop, and the first flight with it.
    fn around(&self) -> Option<(&Autopilot, &ControllerResult)> {
        let autopilot = self.scenario.autopilot.as_ref().filter(|_| self.detailed)?;
        Some((autopilot, self.flown().next()?.1))
    }

    /// When the modes of the first flight began, s, and their names.
    fn modes(&self) -> Vec<(f64, &str)> {
        let around = self.around();
        around.map_or_else(Vec::new, |(autopilot, result)| {
            around::beginnings(autopilot, self.scenario.timing, &result.trace)
        })
    }

    /// Whose modes and targets are drawn, where more than one flight is.
    fn whose(&self) -> String {
        match (self.around(), self.flown().count()) {
            (Some((_, result)), 2..) => format!(" of {}", result.name),
            _ => String::new(),
        }
    }

    fn angles(&self) -> Vec<LinePanel> {
        let mut panels =
            vec![self.pitch(), self.angle("command u [deg]", |r| &r.trace.command_rad)];
        if self.detailed {
            panels.push(self.angle("elevator [deg]", |r| &r.trace.elevator_rad));
        }
        panels
    }

    fn air(&self) -> Vec<LinePanel> {
        if !self.detailed {
            return Vec::new();
        }
        let columns = around::PANELS.iter().filter_map(|panel| self.column(panel));
        columns.chain(self.deployments()).collect()
    }

    /// Configurations that move: the same in every flight, so that those of the first are drawn.
    fn deployments(&self) -> Option<LinePanel> {
        let (plant, flights) = self.aircraft()?;
        let series = around::deployments(plant, flights.first()?.2);
        (!series.is_empty()).then(|| LinePanel {
            y_label: "share out".to_owned(),
            x_label: "time [s]".to_owned(),
            series,
            x_range: self.window(),
            y_range: Some((-0.05, 1.05)),
            ..LinePanel::default()
        })
    }

    /// The flights of a nonlinear aircraft, as they are drawn, and the aircraft.
    fn aircraft(&self) -> Option<(&AircraftPlant, Vec<Flown<'_>>)> {
        let plant = self.scenario.plant.aircraft().filter(|_| self.detailed)?;
        let flights = self.flown().map(|(index, result)| {
            (SeriesStyle::Numbered(index), result.name.as_str(), &result.trace)
        });
        Some((plant, flights.collect()))
    }

    fn side_view(&self) -> Vec<LinePanel> {
        let drawn = self
            .aircraft()
            .and_then(|(plant, flights)| flight_path::side_view(plant, &flights, self.width_px));
        drawn.into_iter().collect()
    }

    fn loads(&self) -> Vec<LinePanel> {
        let drawn =
            self.aircraft().and_then(|(plant, flights)| flight_path::loads(plant, &flights));
        drawn.into_iter().collect()
    }

    fn gains(&self) -> Vec<LinePanel> {
        if !self.flown().any(|(_, result)| self.is_tuned(&result.name)) {
            return Vec::new();
        }
        vec![
            self.gain("k_{p}", |gains| gains.kp),
            self.gain("k_{i} [1/s]", |gains| gains.ki),
            self.gain("k_{d} [s]", |gains| gains.kd),
        ]
    }

    fn flown(&self) -> impl Iterator<Item = (usize, &ControllerResult)> {
        let results = self.simulation.results.iter().enumerate();
        results
            .filter(|(_, result)| self.only.is_empty() || self.only.contains(&result.name.as_str()))
    }

    fn is_tuned(&self, name: &str) -> bool {
        let named = self.scenario.controllers.iter().find(|named| named.name == name);
        named.is_some_and(|named| matches!(named.controller, Controller::SelfTuning(_)))
    }

    fn series(&self, y: impl Fn(&ControllerResult) -> Vec<f64>, stairs: bool) -> Vec<Series> {
        let one = |(index, result): (usize, &ControllerResult)| Series {
            name: result.name.clone(),
            style: if self.detailed {
                SeriesStyle::Numbered(index)
            } else {
                style(&result.name, index)
            },
            x: shown(&result.trace, &result.trace.time_s).to_vec(),
            y: y(result),
            stairs,
        };
        self.flown().map(one).collect()
    }

    fn pitch(&self) -> LinePanel {
        let in_degrees = |values: &[f64]| values.iter().copied().map(degrees).collect::<Vec<_>>();
        // The longest trace shows the whole set-point.
        let longest =
            self.flown().map(|(_, result)| &result.trace).max_by_key(|trace| trace.rows());
        let mut series = Vec::new();
        if let Some(trace) = longest {
            series.push(Series {
                name: "set-point".to_owned(),
                style: SeriesStyle::Setpoint,
                x: shown(trace, &trace.time_s).to_vec(),
                y: in_degrees(shown(trace, &trace.setpoint_rad)),
                stairs: true,
            });
        }
        series.extend(self.series(|result| in_degrees(&result.trace.theta_rad), false));
        let y_range = self.range(&series, |r| &r.trace.theta_rad);
        LinePanel {
            y_label: "pitch angle [deg]".to_owned(),
            x_label: "time [s]".to_owned(),
            series,
            bands: if self.detailed { self.bands() } else { Vec::new() },
            x_range: self.window(),
            y_range,
            ..LinePanel::default()
        }
    }

    fn angle(&self, label: &str, of: fn(&ControllerResult) -> &Vec<f64>) -> LinePanel {
        let series = self.series(|result| of(result).iter().copied().map(degrees).collect(), true);
        let y_range = self.range(&[], of).or_else(|| self.without_spikes(of));
        let (y_label, x_label) = (label.to_owned(), "time [s]".to_owned());
        LinePanel {
            y_label,
            x_label,
            series,
            y_range,
            x_range: self.window(),
            ..LinePanel::default()
        }
    }

    /// A column that only some flights have, if these have it, with what it is to be and the beginnings of modes.
    fn column(&self, panel: &Panel) -> Option<LinePanel> {
        let around = self.around();
        let values = |trace: &Trace| {
            let values = shown(trace, trace.column(panel.column)?).iter().copied();
            Some(if panel.is_in_degrees() {
                values.map(degrees).collect()
            } else {
                values.collect::<Vec<_>>()
            })
        };
        let drawn = |values: &Vec<f64>| match panel.shown {
            Shown::Always => true,
            Shown::WhereItMoves => around::moves(values),
            Shown::WhereHeld => around.is_some_and(|(autopilot, _)| panel.is_held(autopilot)),
        };
        self.flown().filter_map(|(_, result)| values(&result.trace)).find(drawn)?;
        let target = around.and_then(|(autopilot, result)| {
            panel.target(autopilot, (&self.whose(), &result.trace))
        });
        let flown = self.series(|result| values(&result.trace).unwrap_or_default(), false);
        let first_begins = |(at_s, _): (f64, &str)| (at_s > 0.0).then_some(at_s);
        Some(LinePanel {
            y_label: panel.label.to_owned(),
            x_label: "time [s]".to_owned(),
            series: target.into_iter().chain(flown).collect(),
            x_range: self.window(),
            beginnings: self.modes().into_iter().filter_map(first_begins).collect(),
            ..LinePanel::default()
        })
    }

    /// A range without the spikes of single samples, if there are any.
    fn without_spikes(&self, of: fn(&ControllerResult) -> &Vec<f64>) -> Option<(f64, f64)> {
        let trace = |(_, result): (usize, &'_ ControllerResult)| {
            shown(&result.trace, of(result)).iter().copied().map(degrees).collect::<Vec<f64>>()
        };
        let mut values: Vec<f64> = self.flown().flat_map(trace).collect();
        values.sort_by(f64::total_cmp);
        let (low, high) =
            (*values.get(values.len() / 200)?, *values.get(values.len() * 199 / 200)?);
        let (lowest, highest) = (*values.first()?, *values.last()?);
        let usual = low.abs().max(high.abs());
        let margin = 0.15 * (high - low);
        let spiky = lowest.abs().max(highest.abs()) > SPIKE * usual && margin > 0.0;
        spiky.then_some((lowest.max(low - margin), highest.min(high + margin)))
    }

    /// What the panels of a part show, from above: only those that are drawn.
    fn in_words(&self, part: Part) -> String {
        let mut panels: Vec<String> = match part {
            Part::Angles => {
                let bands = match self.bands().is_empty() {
                    true => "",
                    false => " with bands of 2 % of the step about each level of the command",
                };
                vec![
                    format!("pitch angle{bands}"),
                    "command of the controller (positive: nose up)".to_owned(),
                    "elevator in the aircraft's own sign".to_owned(),
                ]
            }
            Part::Air => {
                let flown = around::PANELS.iter().filter(|panel| self.column(panel).is_some());
                let word = |panel: &Panel| {
                    let bare = panel.label.split(" [").next().unwrap_or(panel.label);
                    bare.replace(", downward", " moving downwards")
                };
                let moved = self.deployments().map(|_| "how far configurations are out".to_owned());
                flown.map(word).chain(moved).collect()
            }
            Part::Side => vec![
                "altitude over the way over ground, with the air that the first flight met as arrows where it moves; \
                 heights are drawn larger than ways"
                    .to_owned(),
            ],
            Part::Loads => vec![
                "load factor over true airspeed, with what the angles of attack at which the data of the aircraft end \
                 would give at the altitude and with the controls of the trim: the ends of the data, neither a stall nor \
                 a limit of the structure"
                    .to_owned(),
            ],
            Part::Gains => {
                let flown = self.flown().filter(|(_, result)| self.is_tuned(&result.name));
                let whose = if flown.count() == 1 { "controller" } else { "controllers" };
                let last = format!("kd of the self-tuning {whose}");
                vec!["the gains kp".to_owned(), "ki".to_owned(), last]
            }
        };
        let last = panels.pop().unwrap_or_default();
        let modes = match part {
            Part::Air => around::in_words(&self.whose(), &self.modes()),
            Part::Angles | Part::Side | Part::Loads | Part::Gains => String::new(),
        };
        match panels.is_empty() {
            true => format!("{}.{modes}", fspid_page::number::capital(&last)),
            false => format!("From above: {} and {last}.{modes}", panels.join(", ")),
        }
    }

    /// A sentence for the caption where the command's panel leaves spikes out.
    pub fn spikes(&self) -> String {
        let command: fn(&ControllerResult) -> &Vec<f64> = |result| &result.trace.command_rad;
        if self.range(&[], command).is_some() || self.without_spikes(command).is_none() {
            return String::new();
        }
        let largest =
            self.flown().flat_map(|(_, result)| shown(&result.trace, &result.trace.command_rad));
        let largest = largest.map(|command| degrees(command.abs())).fold(0.0, f64::max);
        format!(
            " At a step the derivative of the error moves the command by up to {} deg for a sample; the panel leaves \
             these spikes out.",
            fspid_page::number::significant(largest, 2)
        )
    }

    fn gain(&self, label: &str, of: fn(&fspid_core::Gains<f64>) -> f64) -> LinePanel {
        let mut series = self.series(|result| result.trace.gains.iter().map(of).collect(), true);
        series.retain(|series| self.is_tuned(&series.name));
        let (y_label, x_label) = (label.to_owned(), "time [s]".to_owned());
        LinePanel { y_label, x_label, series, x_range: self.window(), ..LinePanel::default() }
    }

    /// The whole flight, also where a trace ends early.
    fn window(&self) -> Option<(f64, f64)> {
        let timing = self.scenario.timing;
        let end_s = timing.time_s(timing.rows().saturating_sub(1));
        (end_s > 0.0).then_some((0.0, end_s))
    }

    /// Where a loop fails: a range in which the good ones, or at least the set-point, can be read.
    fn range(&self, and: &[Series], of: fn(&ControllerResult) -> &Vec<f64>) -> Option<(f64, f64)> {
        if !self.flown().any(|(_, result)| grows(result)) {
            return None;
        }
        let good = self.flown().filter(|(_, result)| !grows(result));
        let good = good.flat_map(|(_, result)| of(result).iter().copied().map(degrees));
        let commanded = and.iter().filter(|s| s.style == SeriesStyle::Setpoint);
        let commanded = commanded.flat_map(|series| series.y.iter().copied());
        let largest =
            good.chain(commanded).fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let bound = if largest > 0.0 { HEADROOM * largest } else { 10.0 };
        Some((-bound, bound))
    }

    /// Names of flights whose lines leave a panel, which shows the range in which others can be read.
    pub fn leaving(&self) -> Vec<&str> {
        let angles: [fn(&ControllerResult) -> &Vec<f64>; 2] =
            [|result| &result.trace.command_rad, |result| &result.trace.elevator_rad];
        let beyond = |result: &ControllerResult, of: fn(&ControllerResult) -> &Vec<f64>, range| {
            let (low, high): (f64, f64) = range;
            of(result).iter().copied().map(degrees).any(|value| !(low..=high).contains(&value))
        };
        let pitch = self.pitch().y_range;
        let leaves = |result: &ControllerResult| {
            pitch.is_some_and(|range| beyond(result, |it| &it.trace.theta_rad, range))
                || angles
                    .iter()
                    .any(|&of| self.range(&[], of).is_some_and(|range| beyond(result, of, range)))
        };
        let leaving = self.flown().filter(|(_, result)| leaves(result));
        leaving.map(|(_, result)| result.name.as_str()).collect()
    }

    /// Two per cent of the step about each level of the command.
    fn bands(&self) -> Vec<Band> {
        let Some((_, result)) = self.flown().next() else {
            return Vec::new();
        };
        let mut bands: Vec<Band> = Vec::new();
        for edge in &result.metrics.edges {
            let (level, half) =
                (degrees(edge.to_rad), 0.02 * degrees((edge.to_rad - edge.from_rad).abs()));
            let band = Band { label: String::new(), lower: level - half, upper: level + half };
            if !bands.contains(&band) {
                bands.push(band);
            }
        }
        // More levels than these are a curve, not steps.
        if bands.len() > 4 {
            return Vec::new();
        }
        if let Some(first) = bands.first_mut() {
            first.label = "\u{b1}2 % of the step".to_owned();
        }
        bands
    }
}

/// The samples that are drawn: without the last one if the command steps there, since nothing follows.
fn shown<'a, T>(trace: &Trace, column: &'a [T]) -> &'a [T] {
    let steps_at_end = match trace.setpoint_rad.as_slice() {
        [.., before, last] => before.to_bits() != last.to_bits(),
        _ => false,
    };
    let end = if steps_at_end { column.len().saturating_sub(1) } else { column.len() };
    column.get(..end).unwrap_or(column)
}

/// True for a flight that fails and may go anywhere: what comes down to the ground stays as readable as it was.
fn grows(result: &ControllerResult) -> bool {
    let hit_ground = matches!(
        result.trace.outcome,
        Outcome::EndedEarly(EarlyEnd { cause: EndCause::HitGround, .. })
    );
    fails(result) && !hit_ground
}

/// True for a flight that ended before its time.
pub fn is_cut_short(result: &ControllerResult) -> bool {
    result.trace.outcome != Outcome::Completed
}

/// True for a flight without measures.
pub fn fails(result: &ControllerResult) -> bool {
    result.metrics.verdict.is_failure() || is_cut_short(result)
}
