//! Fig. 7: who resists disturbances better, over size and place of entry.
//!
//! The paper shows two pictures and no number. Fixed beforehand: the two shapes, the three places of
//! entry, the sizes, the cost, and the tuning budget. One thing was changed after a first run: abrupt
//! was a lasting step, which at the measured pitch is a bias that no controller can reject.
//!
//! - *Abrupt* is a pulse of 1 s, *continuous* a sine of 0.2 Hz to the end of the flight; both begin
//!   after 1 s at rest in a flight of 30 s with the set-point at zero.
//! - The cost is $J = \text{ITAE} + 0.3 TV$ per degree of disturbance, the time in the integral
//!   counted from the start of the disturbance.
//! - Tuned controllers had the same budget each, at a size of 1 degree.

use fspid_sim::Trace;

use fspid_scenario::file::Problems;
use fspid_scenario::units::degrees;
use fspid_study::metrics::{Absent, CommandEffort, ErrorIntegrals};
use fspid_study::simulation::Simulation;

use super::figures::Library;

/// Sizes of the disturbance that are flown, degrees.
pub const SIZES_DEG: [f64; 9] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
/// Start of the disturbance, s.
pub const START_S: f64 = 1.0;
/// Weight of the command's variation in the cost.
pub const VARIATION_WEIGHT: f64 = 0.3;
/// The shapes, as they are called in files.
pub const SHAPES: [&str; 2] = ["continuous", "abrupt"];
/// The places of entry.
pub const ENTRIES: [&str; 3] = ["servo", "elevator", "measurement"];
/// The controllers that are compared: as identified with the same nominal gains, then both tuned
/// with the same effort.
pub const CONTROLLERS: [&str; 4] = ["CPID", "FSPID", "CPID tuned", "FSPID tuned"];

/// Name of the stored scenario of a shape and place of entry.
#[must_use]
pub fn scenario_name(shape: &str, entry: &str) -> String {
    format!("disturbance/{shape}-{entry}.toml")
}

/// Costs of the four controllers over the sizes, for one shape and place of entry.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// `continuous` or `abrupt`.
    pub shape: &'static str,
    /// Where it enters.
    pub entry: &'static str,
    /// For each controller of [`CONTROLLERS`], the cost at each size of [`SIZES_DEG`], deg s² per deg.
    pub costs: [Vec<Result<f64, Absent>>; 4],
}

impl Sweep {
    /// Cost of one controller over that of another at each size; absent where either is.
    pub fn ratios(&self, of: usize, over: usize) -> impl Iterator<Item = Result<f64, Absent>> + '_ {
        self.costs[of].iter().zip(&self.costs[over]).map(|(a, b)| Ok((*a)? / (*b)?))
    }
}

/// The cost of a flight whose disturbance has this size.
///
/// # Errors
/// Why the flight has no measures: it diverged or its loop is unstable.
pub fn cost(simulation: &Simulation, controller: &str, size_deg: f64) -> Result<f64, Absent> {
    let result = simulation.result(controller).ok_or(Absent::NoStep)?;
    // The verdict first: a loop that is unstable has no cost, however short the flight.
    result.metrics.integrals?;
    Ok(flight_cost(&result.trace, size_deg))
}

/// The cost of a completed flight whose disturbance has this size.
#[must_use]
pub fn flight_cost(trace: &Trace, size_deg: f64) -> f64 {
    let dt_s = trace.time_s.get(1).copied().unwrap_or(0.0);
    let start = trace.time_s.iter().position(|&time| time >= START_S).unwrap_or(0);
    let errors = trace.setpoint_rad.iter().zip(&trace.theta_rad).map(|(r, y)| r - y);
    let itae = ErrorIntegrals::of(errors, dt_s, &[0, start]).itae_rad_s2;
    let variation = CommandEffort::of(&trace.command_rad, dt_s).variation_rad;
    (degrees(itae) + VARIATION_WEIGHT * degrees(variation)) / size_deg
}

/// Flies all sizes of all shapes at all places of entry.
///
/// # Errors
/// [`Problems`] of a stored scenario.
pub fn sweep(library: &Library) -> Result<Vec<Sweep>, Problems> {
    let mut sweeps = Vec::new();
    for shape in SHAPES {
        for entry in ENTRIES {
            let mut costs = [const { Vec::new() }; 4];
            for size_deg in SIZES_DEG {
                let amplitude = format!("disturbance[0].amplitude_deg={size_deg:?}");
                let study = library.study(&scenario_name(shape, entry), &[amplitude])?;
                let simulation = Simulation::of_window(&study);
                for (costs, controller) in costs.iter_mut().zip(CONTROLLERS) {
                    costs.push(match &simulation {
                        Ok(simulation) => cost(simulation, controller, size_deg),
                        Err(_) => Err(Absent::NotFinite),
                    });
                }
            }
            sweeps.push(Sweep { shape, entry, costs });
        }
    }
    Ok(sweeps)
}

/// How often and by how much one controller beats another over sizes and places of entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contest {
    /// Cases in which the challenger has the lower cost.
    pub won: usize,
    /// All cases.
    pub cases: usize,
    /// Lowest ratio of costs.
    pub lowest: f64,
    /// Geometric mean of the ratios.
    pub mean: f64,
    /// Highest ratio of costs.
    pub highest: f64,
}

impl Contest {
    /// The ratios of cost of controller `of` over `over` in the sweeps of a shape. A case without a
    /// value counts as lost, with no share in the ratios.
    #[must_use]
    pub fn of(sweeps: &[Sweep], shape: &str, of: usize, over: usize) -> Self {
        let ratios: Vec<Result<f64, Absent>> = sweeps
            .iter()
            .filter(|sweep| sweep.shape == shape)
            .flat_map(|sweep| sweep.ratios(of, over))
            .collect();
        let known: Vec<f64> = ratios.iter().filter_map(|ratio| ratio.ok()).collect();
        let logarithms: f64 = known.iter().map(|&ratio| libm::log(ratio)).sum();
        Self {
            won: known.iter().filter(|&&ratio| ratio < 1.0).count(),
            cases: ratios.len(),
            lowest: known.iter().copied().fold(f64::INFINITY, f64::min),
            mean: libm::exp(logarithms / known.len().max(1) as f64),
            highest: known.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}
