//! Contribution of self-tuning outer loops to the linearised motion: their gains vary with their error, and multiply the
//! constant that holds the target.
//!
//! Of a self-tuner that holds a target r, a part of the command is the product of a gain that moves and a constant, as of the
//! pitch loop ([`rest`](crate::rest)): $k_p (b - 1) r$, with 305 m of altitude in the place of a few degrees of pitch. Fixed
//! gains know nothing of it. What it adds to the command is added to the matrix of the fixed gains, on each side of the kinks
//! that the rules have at rest,
//!
//! $$ M' = M + b_u \left( A \frac{\partial k_p}{\partial x} + \dots \right)^T $$
//!
//! with $b_u$, what the command of the loop makes of every number, and x, what its supervisor sees of them. Both are asked of the
//! flying code: $b_u$ of the integral, and the error as what a larger kp adds, $b_u e^T$.

use fspid_core::{Gains, IntegralForm, Pid, PidConfig, SetpointWeights};
use fspid_lti::{Complex, Matrix, eigenvalues, modulus};

use super::numbers::Place;
use super::still::{at_rest, still, unlimited};
use super::{Asked, Small};
use crate::aircraft::AircraftPlant;
use crate::autopilot::{Mode, Moves, Target};
use crate::controller::Controller;
use crate::error::SimError;
use crate::rest::{Doubt, Found, Rest, Side, Stand, may_not_come_to_rest, stand_of_sides};
use crate::stability::MODE_RADIUS;

/// Most combinations of sides of several loops that are asked.
const MOST_SIDES: usize = 64;

/// What the sides of a mode say.
pub(super) struct Sides {
    pub(super) stand: Stand,
    /// Of the one matrix that there is, or of none.
    pub(super) eigenvalues: Vec<Complex>,
    pub(super) largest: f64,
}

impl Sides {
    fn undecided() -> Self {
        let stand = Stand::Undecided(Doubt::OuterGains);
        Self { stand, eigenvalues: Vec::new(), largest: f64::NAN }
    }
}

/// A loop with gains that move, at one of the targets that it may hold.
struct Acting<'a> {
    number: usize,
    controller: &'a Controller,
    gains: Gains<f64>,
    rests: Vec<Rest>,
}

/// What a loop does to the numbers of a flight: what a unit of its command makes of them, and what it sees of each as error.
struct Reach {
    by_command: Vec<f64>,
    error: Vec<f64>,
    /// Where what its integral remembers stands among them, and what a unit of that commands.
    memory: (usize, f64),
}

/// Of a mode in which outer loops are self-tuners that hold something; none where nothing is added to the matrix of the gains at
/// rest.
pub(super) fn sides(asked: &Asked<'_>, small: &Small<'_>) -> Result<Option<Sides>, SimError> {
    let Some(mode) = asked.mode() else { return Ok(None) };
    let energy = asked.autopilot.total_energy().filter(|_| mode.total_energy);
    let mut energy = energy.iter().flat_map(|total| [&total.energy, &total.distribution]);
    if energy.any(|controller| at_rest(controller).is_none()) {
        return Ok(Some(Sides::undecided()));
    }
    let mut acting = Vec::new();
    for &number in asked.autopilot.outermost_first(asked.mode) {
        match acting_loop(asked, small, mode, number) {
            None => return Ok(Some(Sides::undecided())),
            Some(it) if it.rests.iter().all(|rest| rest.adds_nothing_to(it.gains)) => {}
            Some(it) => acting.push(it),
        }
    }
    if acting.is_empty() {
        return Ok(None);
    }
    // Over several samples nothing is a sum of two matrices.
    if small.samples != 1 {
        return Ok(Some(Sides::undecided()));
    }
    let reach = acting.iter().map(|it| reach(asked, small, it));
    let reach = reach.collect::<Result<Option<Vec<Reach>>, _>>()?;
    let Some(reach) = reach else { return Ok(Some(Sides::undecided())) };
    match (acting.as_slice(), reach.as_slice()) {
        ([acting], [reach]) => of_one_loop(small, acting, reach).map(Some),
        _ => of_loops(small, &acting, &reach).map(Some),
    }
}

/// A loop with its rests; none where one is not known.
fn acting_loop<'a>(
    asked: &Asked<'a>,
    small: &Small<'_>,
    mode: &Mode,
    number: usize,
) -> Option<Acting<'a>> {
    let autopilot = asked.autopilot;
    let outer = autopilot.loops().get(number)?;
    let gains = at_rest(&outer.controller)?;
    let Controller::SelfTuning(fspid) = &outer.controller else {
        return Some(Acting { number, controller: &outer.controller, gains, rests: Vec::new() });
    };
    if may_not_come_to_rest(&outer.controller, gains) {
        return None;
    }
    let [here, command] = small.held_by(autopilot, number)?;
    // Pitch and throttle are counted from the trim of the start.
    let away = asked.scenario.plant.aircraft().map(AircraftPlant::away).unwrap_or_default();
    let command = command
        + outer.units.moved
            * match outer.moves {
                Moves::Pitch => away.pitch_rad,
                Moves::Throttle => away.throttle,
                Moves::Bank | Moves::Loop(_) => 0.0,
            };
    let mut targets = vec![here];
    if !mode.moves_target(autopilot, number) {
        // What a mode before this one held, this one may hold on.
        for earlier in autopilot.modes().iter().take(asked.mode + 1) {
            if let Target::Value(value) = earlier.target(outer.holds) {
                targets.push(outer.units.held * value);
            }
        }
    }
    let rests = targets.iter().map(|target| Rest::of_outer_loop(fspid, gains, [*target, command]));
    let rests = rests.collect::<Option<Vec<Rest>>>()?;
    Some(Acting { number, controller: &outer.controller, gains, rests })
}

/// What a loop does, by differences of the flying code; none where its integral does not show it.
fn reach(
    asked: &Asked<'_>,
    small: &Small<'_>,
    acting: &Acting<'_>,
) -> Result<Option<Reach>, SimError> {
    let gains = acting.gains;
    let config = acting.controller.config_at(gains);
    let command_per_memory = match config.integral {
        IntegralForm::Bumpless => 1.0,
        IntegralForm::Literal => gains.ki * config.dt_s,
    };
    let memory = asked.mode().map(|mode| {
        let before = mode.engaged.iter().filter(|&&other| other < acting.number);
        Place::Remembered(1 + before.count(), 0)
    });
    let Some(memory) = memory.filter(|_| command_per_memory != 0.0) else { return Ok(None) };
    let Some(at) = small.places.iter().position(|place| *place == memory) else { return Ok(None) };
    let mut by_command = small.column(memory).map_err(|ended| ended.of(asked.mode))?;
    for (by_command, place) in by_command.iter_mut().zip(&small.places) {
        // The integral stays as well as it acts.
        let stays = if *place == memory { 1.0 } else { 0.0 };
        *by_command = (*by_command - stays) / command_per_memory;
    }
    let more = acting.largest_more().copysign(gains.kp);
    let weight = config.setpoint_weights.proportional;
    // Of the same sign, so that their sum is no zero.
    let kp = gains.kp + more;
    let proportional = (gains.kp * weight + more) / kp;
    let setpoint_weights = SetpointWeights { proportional, ..config.setpoint_weights };
    let Controller::Fixed(fixed) = unlimited(acting.controller, gains)? else { return Ok(None) };
    let config = PidConfig { setpoint_weights, ..*fixed.config() };
    let pid = Pid::new(Gains { kp, ..gains }, config)?;
    let autopilot = asked.autopilot.with_controller(acting.number, Controller::Fixed(pid));
    let prepared = still(asked.scenario, &autopilot, asked.mode, asked.seeing)?;
    let other = asked.small(&prepared)?;
    let size: f64 = by_command.iter().map(|by| by * by).sum();
    let places = 0..small.places.len();
    let entry = |row: usize, column: usize| {
        let [more, less] = [&other.matrix, &small.matrix].map(|it| it.get(row, column));
        more.unwrap_or(0.0) - less.unwrap_or(0.0)
    };
    let error = places.clone().map(|column| {
        let along = places.clone().zip(&by_command).map(|(row, by)| by * entry(row, column));
        along.sum::<f64>() / (size * more)
    });
    let error = error.collect();
    let memory = (at, command_per_memory);
    Ok((size > 0.0).then_some(Reach { by_command, error, memory }))
}

/// One loop: at each target what its sides say together.
fn of_one_loop(small: &Small<'_>, acting: &Acting<'_>, reach: &Reach) -> Result<Sides, SimError> {
    let mut found: Option<Sides> = None;
    for rest in &acting.rests {
        let closed: Vec<Vec<Vec<f64>>> =
            rest.sides.iter().map(|side| closed(small, &[(reach, side, acting.gains)])).collect();
        let asked = closed.iter().map(|rows| radius(rows));
        let asked = asked.collect::<Result<Vec<_>, SimError>>()?;
        let largest = asked.iter().map(|(radius, _)| *radius).fold(0.0, f64::max);
        let eigenvalues = match asked.as_slice() {
            [(_, one)] => one.clone(),
            _ => Vec::new(),
        };
        let found_of: Vec<Found> = asked.iter().map(|(radius, _)| of_radius(*radius)).collect();
        let seen = seen(small, reach, rest);
        let stand = stand_of_sides(&found_of, Some(|| rest.growth_through(closed, seen)));
        let here = Sides { stand, eigenvalues, largest };
        found = Some(match found {
            Some(before) => before.and(here),
            None => here,
        });
    }
    Ok(found.unwrap_or_else(Sides::undecided))
}

/// Several loops: whether every side of one beside every side of the others is stable.
fn of_loops(small: &Small<'_>, acting: &[Acting<'_>], reach: &[Reach]) -> Result<Sides, SimError> {
    let mut combined: Vec<Vec<(&Reach, &Side, Gains<f64>)>> = vec![Vec::new()];
    for (acting, reach) in acting.iter().zip(reach) {
        let sides: Vec<&Side> = acting.rests.iter().flat_map(|rest| &rest.sides).collect();
        if combined.len() * sides.len() > MOST_SIDES {
            return Ok(Sides::undecided());
        }
        combined = combined
            .iter()
            .flat_map(|before| {
                let with = |side| [&before[..], &[(reach, side, acting.gains)]].concat();
                sides.iter().copied().map(with).collect::<Vec<_>>()
            })
            .collect();
    }
    let mut largest: f64 = 0.0;
    for sides in &combined {
        let (radius, _) = radius(&closed(small, sides))?;
        if !(radius <= MODE_RADIUS) {
            return Ok(Sides::undecided());
        }
        largest = largest.max(radius);
    }
    Ok(Sides { stand: Stand::Holds, eigenvalues: Vec::new(), largest })
}

impl Sides {
    /// At another target as well. What grows at one alone is undecided: the flight tells which it holds.
    fn and(self, other: Self) -> Self {
        let largest = self.largest.max(other.largest);
        let stand = match (self.stand, other.stand) {
            (Stand::Holds, Stand::Holds) => Stand::Holds,
            (Stand::Grows { spectral_radius: one }, Stand::Grows { spectral_radius: two }) => {
                Stand::Grows { spectral_radius: one.max(two) }
            }
            _ => Sides::undecided().stand,
        };
        Self { stand, eigenvalues: Vec::new(), largest }
    }
}

impl Acting<'_> {
    /// The most that is added to kp on any side, or stands for it: differences are as exact with it as with what is asked.
    fn largest_more(&self) -> f64 {
        let sides = self.rests.iter().flat_map(|rest| &rest.sides);
        let of_side = |side: &Side| {
            let gathered = side.gathered.map_or(0.0, |it| it.by_error.abs() / (1.0 - it.keeps));
            (side.gains.kp - self.gains.kp).abs().max(side.change_gain.abs()).max(gathered)
        };
        let largest = sides.map(of_side).fold(self.gains.kp.abs(), f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }
}

/// Written so that NaN is unstable.
fn of_radius(radius: f64) -> Found {
    if radius <= MODE_RADIUS { Found::Stable } else { Found::Unstable(radius) }
}

fn radius(rows: &[Vec<f64>]) -> Result<(f64, Vec<Complex>), SimError> {
    let found = eigenvalues(&Matrix::from_rows(rows)?)?;
    Ok((found.iter().map(|z| modulus(*z)).fold(0.0, f64::max), found))
}

/// Numbers beside those of the flight for each loop: its error of the sample before, and what its gains gather.
const BESIDE: usize = 2;

/// The rows of a matrix with what these sides add to the commands of their loops, the outermost first: what is added to one that
/// moves the target of another is an error of that at the same sample.
fn closed(small: &Small<'_>, sides: &[(&Reach, &Side, Gains<f64>)]) -> Vec<Vec<f64>> {
    let count = small.places.len();
    let size = count + BESIDE * sides.len();
    let mut rows = vec![vec![0.0; size]; size];
    for (row, values) in rows.iter_mut().take(count).enumerate() {
        for (column, value) in values.iter_mut().take(count).enumerate() {
            *value = small.matrix.get(row, column).unwrap_or(0.0);
        }
    }
    let mut commands: Vec<(usize, f64, Vec<f64>)> = Vec::new();
    for (place, (reach, side, gains)) in sides.iter().enumerate() {
        let (previous, gathers) = (count + BESIDE * place, count + BESIDE * place + 1);
        let mut error = reach.error.clone();
        error.resize(size, 0.0);
        for (memory, per_memory, command) in &commands {
            let moves = reach.error[*memory] / per_memory;
            error.iter_mut().zip(command).for_each(|(error, command)| *error += moves * command);
        }
        let mut change = error.clone();
        change[previous] -= 1.0;
        let by = |of_error: f64, of_change: f64| -> Vec<f64> {
            error.iter().zip(&change).map(|(e, d)| of_error * e + of_change * d).collect()
        };
        let mut command = by(side.gains.kp - gains.kp, side.change_gain);
        if let Some(gathered) = side.gathered {
            command = by(gathered.by_error, gathered.by_change);
            command[gathers] += gathered.keeps;
            rows[gathers].clone_from(&command);
        }
        for (row, by_command) in rows.iter_mut().zip(&reach.by_command) {
            row.iter_mut()
                .zip(&command)
                .for_each(|(value, command)| *value += by_command * command);
        }
        rows[previous].clone_from(&error);
        commands.push((reach.memory.0, reach.memory.1, command));
    }
    rows
}

/// What the supervisor of one loop sees of the numbers of its sides.
fn seen(small: &Small<'_>, reach: &Reach, rest: &Rest) -> [Vec<f64>; 2] {
    let count = small.places.len();
    let mut error = reach.error.clone();
    error.resize(count + BESIDE, 0.0);
    let mut beside = error.clone();
    if rest.sees_change() {
        beside[count] -= 1.0;
    }
    [error, beside]
}

#[cfg(test)]
mod tests;
