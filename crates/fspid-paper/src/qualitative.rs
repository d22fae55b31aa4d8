//! The claims of the paper that carry no number, each made into a question that a flight answers.

use fspid_core::fuzzy::{Label, Output, RuleTable};
use fspid_sim::lti::Mode;
use fspid_sim::{Controller, stability};

use super::claim::Status;
use super::disturbance::{Contest, Sweep};
use super::figures::{DAMPING, DISTURBED, Fit, FlownFigure, WEAKENED};
use fspid_scenario::units::degrees;
use fspid_study::metrics::ErrorIntegrals;
use fspid_study::simulation::{ControllerResult, Simulation};

/// A claim in words and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedStatement {
    /// Id.
    pub id: &'static str,
    /// What the paper says.
    pub paper: &'static str,
    /// What we found, with numbers.
    pub ours: String,
    /// How it stands.
    pub status: Status,
    /// Assumptions it rests on.
    pub assumptions: &'static [&'static str],
    /// How the question was put.
    pub note: &'static str,
}

/// Steps of the command, from 0, that are compared for S2: the last upward one on the old plant, and
/// the third upward one on the new.
const BEFORE_CHANGE: usize = 2;
const AFTER_CHANGE: usize = 8;

/// What the statements are judged by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Evidence<'a> {
    /// All flown figures.
    pub figures: &'a [FlownFigure],
    /// The sweeps of Fig. 7.
    pub sweeps: &'a [Sweep],
    /// The flights whose plant changes: share of the elevator's effectiveness left, and flight.
    pub long_term: &'a [(f64, Simulation)],
    /// The printed rule table.
    pub printed: &'a RuleTable,
}

impl Evidence<'_> {
    /// Every statement, in the paper's order.
    #[must_use]
    pub(super) fn judge(&self) -> Vec<JudgedStatement> {
        vec![
            self.undamped(),
            self.disturbances(
                "F7.1",
                "continuous disturbance: FSPID better than CPID",
                "continuous",
            ),
            self.disturbances("F7.2", "abrupt disturbance: FSPID better than CPID", "abrupt"),
            self.damping(),
            self.adaptation(),
            self.pid_against_p(),
            self.rules(),
        ]
    }

    fn figure(&self, id: &str) -> Option<&FlownFigure> {
        self.figures.iter().find(|flown| flown.fit == Fit::Own && flown.figure.id == id)
    }

    fn result(&self, figure: &str, controller: &str) -> Option<&ControllerResult> {
        self.figure(figure).and_then(|flown| flown.simulation.result(controller))
    }

    /// F6.1: the proportional loop of Fig. 5 without its gyro.
    fn undamped(&self) -> JudgedStatement {
        let answer = self.figure("6").and_then(proportional_damping);
        let (status, ours) = match answer {
            Some((damping, radius)) => {
                // Undamped to the eye: less than a tenth of critical, or growing.
                let status = if damping < 0.1 { Status::Reproduced } else { Status::Contradicted };
                let way = if radius < 1.0 { "decays" } else { "grows" };
                let text = format!(
                    "the gain of Fig. 5 without the gyro oscillates with a damping ratio of \
                     {damping:.3} and {way} (spectral radius {radius:.5})"
                );
                (status, text)
            }
            None => (Status::Undetermined, "the loop could not be analysed".to_owned()),
        };
        JudgedStatement {
            id: "F6.1",
            paper: "PC without the inner loop oscillates undamped",
            ours,
            status,
            assumptions: &["A1", "A4", "A18"],
            note: "dominant pole of the sampled loop; below 0.1 counts as undamped to the eye",
        }
    }

    fn disturbances(&self, id: &'static str, paper: &'static str, shape: &str) -> JudgedStatement {
        let same = Contest::of(self.sweeps, shape, 1, 0);
        let tuned = Contest::of(self.sweeps, shape, 3, 2);
        let against_tuned = Contest::of(self.sweeps, shape, 1, 2);
        let describe = |who: &str, contest: &Contest| {
            format!(
                "{who}: FSPID better in {} of {} cases, cost ratio {:.2} to {:.2}, mean {:.2}",
                contest.won, contest.cases, contest.lowest, contest.highest, contest.mean
            )
        };
        let status = match (same.won == same.cases, 2 * same.won > same.cases) {
            (true, _) => Status::Reproduced,
            (false, true) => Status::Approached,
            (false, false) => Status::Contradicted,
        };
        let ours = [
            describe("same nominal gains", &same),
            describe("against a CPID re-tuned", &against_tuned),
            describe("both tuned with the same effort", &tuned),
        ]
        .join("; ");
        JudgedStatement {
            id,
            paper,
            ours,
            status,
            assumptions: DISTURBED,
            note: "judged with the same nominal gains over nine sizes and three places of entry: \
                   reproduced if better in all, approached in most",
        }
    }

    /// S1: without the gyro the PIDs damp the loop and the proportional controller does not.
    fn damping(&self) -> JudgedStatement {
        let settled =
            |name: &str| self.result("6", name).map(|result| result.metrics.verdict.to_string());
        let damping = self.figure("6").and_then(proportional_damping).map(|(ratio, _)| ratio);
        let overshoot = |name: &str| {
            let step = self.result("6", name)?.metrics.first_step();
            step.overshoot_pct.ok()
        };
        let (pids, fspids) = (["CPID 1", "CPID 2"], ["FSPID 1", "FSPID 2"]);
        let calm = |names: [&str; 2]| {
            names.iter().all(|name| self.result("6", name).is_some_and(oscillation_dies))
        };
        let status = match damping {
            Some(ratio) if ratio < 0.1 && calm(pids) && calm(fspids) => Status::Reproduced,
            Some(_) => Status::Contradicted,
            None => Status::Undetermined,
        };
        let list = |names: [&str; 2]| {
            names
                .map(|name| match (overshoot(name), settled(name)) {
                    (Some(overshoot), Some(verdict)) => {
                        format!("{name} overshoots {overshoot:.1} % and is {verdict}")
                    }
                    _ => format!("{name} has no measures"),
                })
                .join(", ")
        };
        JudgedStatement {
            id: "S1",
            paper: "CPID and FSPID damp the loop without the inner loop, PC does not",
            ours: format!(
                "PC: damping ratio {:.3}; {}; {}",
                damping.unwrap_or(f64::NAN),
                list(pids),
                list(fspids)
            ),
            status,
            assumptions: DAMPING,
            note: "damped: the swing in the last quarter of the window is below a tenth of the step",
        }
    }

    /// S2: after a lasting change of the plant, whose error grows less?
    fn adaptation(&self) -> JudgedStatement {
        let growth = |flight: &Simulation, name: &str| {
            let result = flight.result(name)?;
            result.metrics.integrals.ok()?;
            Some(edge_iae_deg_s(result, AFTER_CHANGE)? / edge_iae_deg_s(result, BEFORE_CHANGE)?)
        };
        let pairs: Option<Vec<(f64, f64, f64)>> = self
            .long_term
            .iter()
            .map(|(share, flight)| {
                Some((*share, growth(flight, "FSPID")?, growth(flight, "CPID")?))
            })
            .collect();
        let (status, ours) = match pairs {
            Some(pairs) => {
                let held = pairs.iter().all(|(_, fuzzy, _)| *fuzzy < 1.1);
                let better = pairs.iter().filter(|(_, fuzzy, fixed)| fuzzy < fixed).count();
                let status = match (held, 2 * better > pairs.len()) {
                    (true, _) => Status::Reproduced,
                    (false, true) => Status::Approached,
                    (false, false) => Status::Contradicted,
                };
                let list = pairs.iter().map(|(share, fuzzy, fixed)| {
                    format!("elevator times {share}: FSPID {fuzzy:.2}, CPID {fixed:.2}")
                });
                let list = list.collect::<Vec<_>>().join("; ");
                (status, format!("IAE of an upward step, after over before the change. {list}"))
            }
            None => (Status::Undetermined, "a flight has no measures".to_owned()),
        };
        JudgedStatement {
            id: "S2",
            paper: "FSPID adapts to long-term changes of system parameters, CPID does not",
            ours,
            status,
            assumptions: WEAKENED,
            note: "adapts: the error never grows by 10 % or more; approached: it grows less than the \
                   CPID's in most cases. A memoryless law remembers nothing: what it has to offer is \
                   its nonlinearity",
        }
    }

    /// S3: the CPID against the proportional controller, in the figures that show both.
    fn pid_against_p(&self) -> JudgedStatement {
        let ratio = |figure: &str, cpid: &str| {
            let iae = |name: &str| {
                let result = self.result(figure, name)?;
                result.metrics.integrals.ok().map(|integrals| integrals.itae_rad_s2)
            };
            Some(iae(cpid)? / iae("PC")?)
        };
        let ratios =
            [("5", "CPID"), ("6", "CPID 1"), ("6", "CPID 2")].map(|(f, c)| (f, c, ratio(f, c)));
        let won = ratios.iter().filter(|(.., ratio)| ratio.is_some_and(|r| r < 1.0)).count();
        let status = match won {
            3 => Status::Reproduced,
            2 => Status::Approached,
            _ => Status::Contradicted,
        };
        let text = ratios.map(|(figure, name, ratio)| match ratio {
            Some(ratio) => format!("Fig. {figure}, {name}: {ratio:.2}"),
            None => format!("Fig. {figure}, {name}: PC has no measures"),
        });
        JudgedStatement {
            id: "S3",
            paper: "CPID is better than PC",
            ours: format!("ITAE of the CPID over that of the PC: {}", text.join("; ")),
            status,
            assumptions: &["A1", "A4", "A8", "A13", "A15", "A18", "A19", "A20"],
            note: "reproduced if lower in every figure that shows both, approached in most",
        }
    }

    /// S4: what rules 1 to 3 ask of the labels, and how often Table 3 does it.
    fn rules(&self) -> JudgedStatement {
        let table = self.printed;
        let kp = rule_one(table, Output::DeltaKp, |label| label > Label::ZO);
        let ki = rule_one(table, Output::DeltaKi, |label| label < Label::ZO);
        let kd = rule_one(table, Output::DeltaKd, |label| label <= Label::ZO);
        let total = kp.0 + ki.0 + kd.0;
        let cells = kp.1 + ki.1 + kd.1;
        let status = if total == cells { Status::Reproduced } else { Status::Contradicted };
        let positive_kp = positive_error_cells(table);
        JudgedStatement {
            id: "S4",
            paper: "the tuning rules 1 to 3 of section 3.2 are what Table 3 does",
            ours: format!(
                "large error (NB and PB rows): kp raised in {} of {}, ki lowered in {} of {}, kd not \
                 raised in {} of {} cells; of the seven cells of a large positive error {positive_kp} \
                 raise kp",
                kp.0, kp.1, ki.0, ki.1, kd.0, kd.1
            ),
            status,
            assumptions: &[],
            note: "rule 1 speaks of the size of the error, Table 3 is odd in it (erratum E8); the \
                   mirrored table removes this",
        }
    }
}

/// Cells of the two outermost rows that do what rule 1 asks, and how many there are.
fn rule_one(table: &RuleTable, output: Output, asked: impl Fn(Label) -> bool) -> (usize, usize) {
    let cells = || {
        [Label::NB, Label::PB]
            .into_iter()
            .flat_map(|error| Label::ALL.into_iter().map(move |change| (error, change)))
    };
    let grid = table.grid(output);
    (cells().filter(|(e, c)| asked(grid.at(*e, *c))).count(), cells().count())
}

fn positive_error_cells(table: &RuleTable) -> usize {
    let grid = table.grid(Output::DeltaKp);
    Label::ALL.into_iter().filter(|change| grid.at(Label::PB, *change) > Label::ZO).count()
}

/// Damping ratio of the dominant oscillation of the proportional loop, and its spectral radius.
fn proportional_damping(flown: &FlownFigure) -> Option<(f64, f64)> {
    let scenario = &flown.study.scenario;
    let named = scenario.controllers.iter().find(|named| named.name == "PC")?;
    let Controller::Fixed(pid) = named.controller else {
        return None;
    };
    let radius = stability::loop_spectral_radius(scenario, pid.gains(), pid.config()).ok()?;
    let poles = stability::loop_poles(scenario, pid.gains(), pid.config()).ok()?;
    let dt_s = scenario.timing.dt_s();
    // The oscillation is the loop's, not the phugoid's: faster than a tenth of a radian per second.
    let damping = poles
        .iter()
        .filter_map(|&pole| Mode::of_sampled_pole(pole, dt_s).ok())
        .filter(|mode| mode.natural_frequency_rad_s > 0.1 && mode.damping_ratio < 1.0)
        .map(|mode| mode.damping_ratio)
        .fold(f64::INFINITY, f64::min);
    damping.is_finite().then_some((damping, radius))
}

/// Whether the swing in the last quarter of the window is below a tenth of the step.
fn oscillation_dies(result: &ControllerResult) -> bool {
    let theta = &result.trace.theta_rad;
    let last = theta.get(theta.len() * 3 / 4..).unwrap_or_default();
    let highest = last.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = last.iter().copied().fold(f64::INFINITY, f64::min);
    let step = result.metrics.edges.first().map_or(0.0, |edge| (edge.to_rad - edge.from_rad).abs());
    result.metrics.integrals.is_ok() && highest - lowest < 0.1 * step
}

/// Integral of the error's size over one step of the command, deg s.
fn edge_iae_deg_s(result: &ControllerResult, index: usize) -> Option<f64> {
    let edges = &result.metrics.edges;
    let edge = edges.get(index)?;
    let end_s = edges.get(index + 1).map_or(f64::INFINITY, |next| next.at_s);
    let trace = &result.trace;
    let dt_s = trace.time_s.get(1)?;
    let errors = trace
        .time_s
        .iter()
        .zip(trace.setpoint_rad.iter().zip(&trace.theta_rad))
        .filter(|(time_s, _)| **time_s >= edge.at_s && **time_s < end_s)
        .map(|(_, (r, y))| r - y);
    Some(degrees(ErrorIntegrals::of(errors, *dt_s, &[0]).iae_rad_s))
}
