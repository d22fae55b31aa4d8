//! One sample of the loop with its limits, for every flight of a set at once.
//!
//! The order is that of the simulator. The elevator is counted with the load that enters behind the servo, so that such a load
//! d moves the limits of servo and controller and nothing else: the deflection $\delta + d$ follows $v + d$ as δ follows v.

use fspid_core::{AntiWindup, PidConfig};
use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::Followers;

use super::affine::{Affine, raised};
use super::cut::Line;
use super::gains::{Between, SeenGains};
use super::servo::Curve;
use super::tuned::{Shown, Tuned, Tuner};

/// Where something may be cut: what the command becomes, what the integral takes of the error, what the servo makes of what
/// arrives, and how fast it runs.
pub(super) const PLACES: usize = 4;
const COMMAND: usize = 0;
const INTEGRAL: usize = 1;
const ARRIVAL: usize = 2;
const RATE: usize = 3;
/// Shares of what is not cut anywhere.
pub(super) const FREE: [f64; PLACES] = [1.0; PLACES];

/// Unknowns that every flight of a set has: set-point and load.
pub(super) const SETPOINT: usize = 0;
pub(super) const LOAD: usize = 1;
pub(super) const OWN: usize = 2;

/// A row of the loop, by the places of the state that count.
pub(super) type Row = Vec<(usize, Interval)>;

/// Where the parts of the state stand.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) plant: usize,
    pub(super) queue: usize,
    pub(super) pitch: usize,
    pub(super) rate: usize,
    pub(super) integral: Option<usize>,
    pub(super) derivative: Option<usize>,
    pub(super) previous: Option<usize>,
    pub(super) size: usize,
}

/// The loop as its samples are flown.
#[derive(Clone)]
pub(super) struct Flown<'a> {
    pub(super) layout: Layout,
    /// Rows of the plant over its states, with the command's entry behind.
    pub(super) plant: Vec<Vec<Interval>>,
    /// Seen pitch and seen rate.
    pub(super) seen: [Row; 2],
    pub(super) rate: Row,
    pub(super) config: PidConfig<f64>,
    pub(super) gains: SeenGains<'a>,
    /// Of a law that remembers.
    pub(super) tuner: Option<Tuner<'a>>,
    /// Where its gains are after a rest.
    pub(super) rested: [Interval; 3],
    pub(super) followers: Followers,
    pub(super) curve: Option<Curve>,
    /// Limits of the command that arrives, rad.
    pub(super) arriving: Option<(f64, f64)>,
    /// Ends of the travel, which are not modelled: no flight may meet them.
    pub(super) travel: Option<(f64, f64)>,
    /// The deflection's lag is none, one or two.
    pub(super) lag_order: usize,
    /// Largest deviation of each state on a ball of 1.
    pub(super) reach: Vec<f64>,
}

/// Everything that a set of flights may be at a sample.
#[derive(Clone, Debug)]
pub(super) struct Flight {
    pub(super) values: Vec<Affine>,
    /// The command before.
    pub(super) last: Affine,
    pub(super) setpoint: Affine,
    /// What the set-point has just changed by.
    pub(super) risen: Affine,
    /// At the elevator, behind the servo.
    pub(super) load: Affine,
    /// At the servo, added to what arrives.
    pub(super) at_servo: Affine,
    /// What a tuner remembers.
    pub(super) tuned: Option<Tuned>,
    /// Radius, in the norm of the form, of what is beside the values.
    pub(super) ball: f64,
    /// Unknowns so far.
    pub(super) symbols: usize,
    /// A limit may have acted on the way.
    pub(super) limited: bool,
}

/// Which sample it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moment {
    /// The first of a controller, and the set-point is there already.
    First,
    /// Any other.
    Later,
}

/// Why a set of flights was given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    /// The sample guard may act.
    Guard,
    /// An end of the travel may be met.
    Travel,
    /// It is not known any more where the flights are.
    Lost,
    /// All of the work that may be taken is.
    Work,
}

/// How limits are judged.
#[derive(Clone, Copy, Debug)]
pub(super) enum Judge {
    /// By what may come.
    Measured,
    /// With these shares and gains, whatever comes.
    Forced([f64; PLACES], Between),
}

/// What a sample has come to.
pub(super) struct Passage {
    pub(super) flight: Flight,
    /// What each place lets through; between 0 and 1 where that is not certain.
    pub(super) shares: [f64; PLACES],
    pub(super) gains: Between,
}

struct Pass<'a, 's> {
    flown: &'a Flown<'s>,
    now: &'a Flight,
    judge: Judge,
    shares: [f64; PLACES],
    symbols: usize,
}

impl Flown<'_> {
    /// The flights a sample later.
    pub(super) fn pass(&self, now: &Flight, moment: Moment, judge: Judge) -> Result<Passage, Stop> {
        Pass { flown: self, now, judge, shares: FREE, symbols: now.symbols }.run(moment)
    }
}

fn point(value: f64) -> Interval {
    Interval::point(value)
}

/// What the controller sees and has made of it.
struct Seen {
    pitch: Affine,
    rate: Affine,
    error: Affine,
    derivative: Option<Affine>,
    gains: Between,
    /// What a tuner remembers of this sample, and the gains that answer it.
    tuned: Option<Tuned>,
}

/// What the controller answers.
struct Answered {
    command: Affine,
    integral: Option<Affine>,
}

impl Pass<'_, '_> {
    fn run(mut self, moment: Moment) -> Result<Passage, Stop> {
        let seen = self.seen(moment)?;
        let Answered { command, integral } = self.answered(&seen)?;
        let layout = &self.flown.layout;
        let arrived = if layout.queue > 0 { self.state(layout.plant) } else { command.clone() };
        let plant = self.driven(&arrived)?;
        let mut values = plant;
        let queue = (1..layout.queue).map(|place| self.now.values[layout.plant + place].clone());
        values.extend(queue);
        values.extend((layout.queue > 0).then(|| command.clone()));
        let from = values.len();
        values.extend((0..layout.pitch).map(|place| match place {
            0 => self.now.values[0].clone(),
            _ => self.now.values[from + place - 1].clone(),
        }));
        let from = values.len();
        values.extend((0..layout.rate).map(|place| match place {
            0 => self.row(&self.flown.rate),
            _ => self.now.values[from + place - 1].clone(),
        }));
        values.extend(integral.filter(|_| layout.integral.is_some()));
        values.extend(seen.derivative.clone().filter(|_| layout.derivative.is_some()));
        values.extend(layout.previous.map(|_| seen.pitch.times(-Interval::ONE)));
        let remembered = seen.tuned.iter().flat_map(Tuned::each);
        let known = values
            .iter()
            .chain([&command])
            .chain(remembered)
            .all(|value| value.magnitude().is_finite());
        if !known || values.len() != layout.size {
            return Err(Stop::Lost);
        }
        let cut = self.shares.iter().any(|share| *share < 1.0);
        let flight = Flight {
            values,
            last: command,
            setpoint: self.now.setpoint.clone(),
            risen: Affine::default(),
            load: self.now.load.clone(),
            at_servo: self.now.at_servo.clone(),
            tuned: seen.tuned,
            ball: self.now.ball,
            symbols: self.symbols,
            limited: self.now.limited || cut,
        };
        if matches!(self.judge, Judge::Measured) {
            self.flown.within_travel(&flight)?;
        }
        Ok(Passage { flight, shares: self.shares, gains: seen.gains })
    }

    /// A state with what the ball adds.
    fn state(&self, place: usize) -> Affine {
        self.row(&vec![(place, Interval::ONE)])
    }

    fn row(&self, row: &Row) -> Affine {
        let mut value = Affine::sum(row.iter().map(|(place, by)| (*by, &self.now.values[*place])));
        if self.now.ball > 0.0 {
            let sizes = row.iter().map(|(place, by)| by.magnitude() * self.flown.reach[*place]);
            value.of_ball += raised(sizes.sum::<f64>() * self.now.ball, row.len() + 2);
        }
        value
    }

    /// Gives new unknowns.
    fn symbols(&mut self) -> impl FnMut() -> usize {
        || {
            self.symbols += 1;
            self.symbols - 1
        }
    }

    /// A number behind a limit.
    fn cut(&mut self, place: usize, value: &Affine, line: impl FnOnce(Interval) -> Line) -> Affine {
        let line = match self.judge {
            Judge::Measured => line(value.range()),
            Judge::Forced(shares, _) => {
                Line { slope: shares[place], offset: Interval::ZERO, half: 0.0 }
            }
        };
        if line == Line::SAME {
            return value.clone();
        }
        // A slope may be rounded to 1 where something is cut.
        self.shares[place] *= line.slope.min(1.0_f64.next_down());
        line.of(value, &mut self.symbols())
    }

    fn seen(&mut self, moment: Moment) -> Result<Seen, Stop> {
        let Flown { config, layout, gains, .. } = self.flown;
        let [pitch, rate] = [0, 1].map(|place: usize| self.row(&self.flown.seen[place]));
        let limit_rad = config.guard.limit_rad();
        let sizes = [&pitch, &rate, &self.now.setpoint].map(Affine::magnitude);
        let believed = sizes.into_iter().all(|size| size < limit_rad);
        if matches!(self.judge, Judge::Measured) && !believed {
            return Err(Stop::Guard);
        }
        let error = self.now.setpoint.less(&pitch);
        let nothing = Affine::default();
        let (of_error, of_derivative) = match (moment, layout.previous) {
            (Moment::First, _) | (_, None) => (nothing.clone(), nothing),
            (Moment::Later, Some(place)) => {
                let fallen = self.state(place).plus(&pitch);
                let change = |weight: Interval| {
                    Affine::sum([(weight, &self.now.risen), (-Interval::ONE, &fallen)])
                };
                let weight = point(config.setpoint_weights.derivative);
                (change(Interval::ONE), change(weight))
            }
        };
        let shown =
            Shown { error: &error, change: &of_error, pitch: &pitch, setpoint: &self.now.setpoint };
        let tuned = match (self.judge, &self.flown.tuner, &self.now.tuned) {
            (Judge::Measured, Some(tuner), Some(now)) => {
                Some(tuner.after(now, &shown, &mut self.symbols()))
            }
            _ => None,
        };
        let gains = match (self.judge, &self.flown.tuner, &tuned) {
            (Judge::Forced(_, gains), ..) => gains,
            (Judge::Measured, Some(tuner), Some(tuned)) => Between::holding(tuner.ranges(tuned)),
            (Judge::Measured, ..) => {
                gains.seen(error.range(), of_error.range()).ok_or(Stop::Lost)?
            }
        };
        let derivative = layout.previous.map(|_| {
            let filter = point(config.derivative.filter_s);
            let over = Interval::ONE / (filter + point(config.dt_s));
            let before = layout.derivative.map(|place| self.state(place)).unwrap_or_default();
            Affine::sum([(filter * over, &before), (over, &of_derivative)])
        });
        Ok(Seen { pitch, rate, error, derivative, gains, tuned })
    }

    /// What a gain makes of a number: the linear part, and how far it may be from that.
    fn multiplied(&self, seen: &Seen, gain: usize, of: &Affine) -> (Affine, f64) {
        if let Some(tuned) = &seen.tuned {
            return tuned.gains[gain].product(of);
        }
        let Between { middle, radius } = seen.gains;
        (of.times(point(middle[gain])), raised(radius[gain] * of.magnitude(), 2))
    }

    /// The same of the rate gain, which may follow kd.
    fn damped(&self, seen: &Seen) -> (Affine, f64) {
        let Followers { coupling, nominal } = self.flown.followers;
        let base = point(self.flown.config.rate_gain_s);
        let follows = point(coupling.rate_gain);
        if follows.magnitude() == 0.0 {
            return (seen.rate.times(base), 0.0);
        }
        let base = base - follows * point(nominal.kd);
        if let Some(tuned) = &seen.tuned {
            let constant = Affine::constant(base);
            let gain = Affine::sum([(Interval::ONE, &constant), (follows, &tuned.gains[2])]);
            return gain.product(&seen.rate);
        }
        let Between { middle: [.., kd], radius: [.., off_kd] } = seen.gains;
        let most = follows.magnitude() * off_kd * seen.rate.magnitude();
        (seen.rate.times(base + follows * point(kd)), raised(most, 3))
    }

    fn answered(&mut self, seen: &Seen) -> Result<Answered, Stop> {
        let config = &self.flown.config;
        let dt_s = point(config.dt_s);
        let before = self.flown.layout.integral.map(|place| self.state(place));
        let (added, most) = self.multiplied(seen, 1, &seen.error);
        let (mut added, most) = (added.times(dt_s), raised(most * config.dt_s, 2));
        if before.is_some() {
            added = added.and_noise(most, &mut self.symbols());
        }
        let wound = before.as_ref().map(|before| before.plus(&added));
        let mut term = wound.clone();
        if let (Some(wound), AntiWindup::Clamping(limits)) = (&wound, &config.anti_windup) {
            let (lower, upper) = (limits.lower(), limits.upper());
            term = Some(self.cut(INTEGRAL, wound, |range| Line::clamped(range, lower, upper)));
        }
        let weight = point(config.setpoint_weights.proportional);
        let driven = Affine::sum([(weight, &self.now.setpoint), (-Interval::ONE, &seen.pitch)]);
        let nothing = Affine::default();
        let (proportional, by_kp) = self.multiplied(seen, 0, &driven);
        let (damping, by_rate) = self.damped(seen);
        let derivative = seen.derivative.as_ref().unwrap_or(&nothing);
        let (derivative, by_kd) = self.multiplied(seen, 2, derivative);
        let free = Affine::sum([
            (Interval::ONE, &proportional),
            (-Interval::ONE, &damping),
            (point(config.feedforward), &self.now.setpoint),
            (Interval::ONE, term.as_ref().unwrap_or(&nothing)),
            (Interval::ONE, &derivative),
        ]);
        let most = raised(by_kp + by_kd + by_rate, 4);
        let free = free.and_noise(most, &mut self.symbols());
        let command = self.limited(&free);
        let excess = (self.shares[COMMAND] < 1.0).then(|| free.less(&command));
        let integral = match (&config.anti_windup, wound, before) {
            (AntiWindup::Clamping(_), ..) => term,
            (AntiWindup::None, wound, _) => wound,
            (AntiWindup::Conditional, Some(_), Some(before)) => {
                Some(self.conditional(&before, &added, excess.as_ref()))
            }
            (AntiWindup::BackCalculation { tracking_s }, Some(wound), _) => match excess {
                None => Some(wound),
                // Nothing is pulled while the gain is zero.
                Some(_) if seen.gains.may_be_zero(1) => return Err(Stop::Lost),
                Some(excess) => {
                    let share = dt_s / point(*tracking_s);
                    Some(Affine::sum([(Interval::ONE, &wound), (-share, &excess)]))
                }
            },
            (_, wound, _) => wound,
        };
        Ok(Answered { command, integral })
    }

    /// The command behind slew limit and limits.
    fn limited(&mut self, free: &Affine) -> Affine {
        let config = &self.flown.config;
        let mut command = free.clone();
        if let Some(slew_rad_s) = config.slew_rad_s {
            let most = slew_rad_s * config.dt_s;
            let last = &self.now.last;
            let change = free.less(last);
            let within = self.cut(COMMAND, &change, |range| Line::clamped(range, -most, most));
            if self.shares[COMMAND] < 1.0 {
                // What the ball adds to the command before is no part of the ball of now.
                let of_ball = raised((1.0 - self.shares[COMMAND]) * last.of_ball, 2);
                command = last.plus(&within).and_off(of_ball);
            }
        }
        if let Some(limits) = &config.limits {
            let (lower, upper) = (limits.lower(), limits.upper());
            command = self.cut(COMMAND, &command, |range| Line::clamped(range, lower, upper));
        }
        command
    }

    /// The integral that stands still while the error would drive a cut command further out.
    fn conditional(&mut self, before: &Affine, added: &Affine, excess: Option<&Affine>) -> Affine {
        let share = match (self.judge, excess) {
            (Judge::Forced(shares, _), _) => shares[INTEGRAL],
            (_, None) => 1.0,
            (_, Some(excess)) => {
                let signs = [excess.range(), added.range()].map(|range| {
                    (
                        range.lower() > 0.0,
                        range.upper() < 0.0,
                        range.lower() >= 0.0,
                        range.upper() <= 0.0,
                    )
                });
                let [(above, below, not_below, not_above), (up, down, not_down, not_up)] = signs;
                if (above && up) || (below && down) {
                    0.0
                } else if (not_below && not_up) || (not_above && not_down) {
                    1.0
                } else {
                    0.5
                }
            }
        };
        self.shares[INTEGRAL] *= share;
        let kept = Affine::sum([(Interval::ONE, before), (point(share), added)]);
        if share > 0.0 && share < 1.0 && matches!(self.judge, Judge::Measured) {
            return kept.and_noise(raised(0.5 * added.magnitude(), 2), &mut self.symbols());
        }
        kept
    }

    /// The plant a sample later.
    fn driven(&mut self, arrived: &Affine) -> Result<Vec<Affine>, Stop> {
        let flown = self.flown;
        let mut target = arrived.plus(&self.now.at_servo);
        if let Some((least, most)) = flown.arriving {
            target = self.cut(ARRIVAL, &target, |range| Line::clamped(range, least, most));
        }
        let loaded = target.plus(&self.now.load);
        let states = flown.layout.plant;
        let now = self.now;
        let values = &now.values[..states];
        let all = |row: &Vec<Interval>, command: Option<&Affine>| {
            let own = row.iter().copied().zip(values);
            let by_command = row.get(states).copied();
            Affine::sum(own.chain(by_command.zip(command)))
        };
        let free =
            |pass: &Self| pass.flown.plant.iter().map(|row| all(row, Some(&loaded))).collect();
        let Some(curve) = &flown.curve else { return Ok(free(self)) };
        let gap = loaded.less(&self.state(states - 1));
        let (lines, share) = match self.judge {
            Judge::Forced(shares, _) => {
                let linear = curve.linear().iter().map(|slope| slope.midpoint());
                let line = |slope: f64| Line {
                    slope: slope * shares[RATE],
                    offset: Interval::ZERO,
                    half: 0.0,
                };
                (linear.map(line).collect(), shares[RATE])
            }
            Judge::Measured if curve.is_linear(gap.range()) => return Ok(free(self)),
            Judge::Measured => curve.lines(gap.range()),
        };
        if matches!(self.judge, Judge::Forced(..)) && share >= 1.0 {
            return Ok(free(self));
        }
        self.shares[RATE] = share;
        let mut symbols = self.symbols();
        let rows = flown.plant.iter().zip(lines).zip(curve.linear());
        // Where the deflection stands, and beside it what the gap adds.
        let still = &values[states - 1];
        Ok(rows
            .map(|((row, line), linear)| {
                let own = all(row, None);
                let held = Affine::sum([(Interval::ONE, &own), (row[states], still)]);
                let added = line.of(&gap, &mut symbols);
                let apart = (point(line.slope) - point(share) * *linear).magnitude();
                held.plus(&added).and_off(raised(apart * gap.of_ball, 4))
            })
            .collect())
    }
}

impl Flown<'_> {
    /// Refuses flights that may meet an end of the travel: a lag of first order stays between where it is at samples.
    fn within_travel(&self, flight: &Flight) -> Result<(), Stop> {
        let Some((least, most)) = self.travel.filter(|_| self.lag_order == 1) else {
            return Ok(());
        };
        let place = self.layout.plant - 1;
        let mut deflection = flight.values[place].less(&flight.load);
        deflection.of_ball = raised(self.reach[place] * flight.ball, 2);
        let range = deflection.range();
        let inside = range.lower() > least && range.upper() < most;
        inside.then_some(()).ok_or(Stop::Travel)
    }
}

#[cfg(test)]
mod tests;
