//! Sets of flights, from a step at rest to where no limit acts any more.

use core::ops::Range;

use fspid_core::Gains;
use fspid_fuzzy::system::System;
use fspid_lti::Matrix;
use fspid_numeric::Scalar;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use super::affine::{Affine, raised};
use super::ball::{Growth, Norm};
use super::commands::Commands;
use super::flown::{around, flown};
use super::gains::Between;
use super::joined::Joined;
use super::sample::{
    FREE, Flight, Flown, Judge, LOAD, Moment, OWN, PLACES, Passage, SETPOINT, Stop,
};
use super::terminal::{NearGains, Terminal};
use super::tuned::{Tuned, Tuner};
use crate::check::{IntervalMatrix, NotProved};
use crate::description::LoopDescription;
use crate::gain_set::GainSet;

/// Unknowns that are told apart; where there are more, the smallest become a ball.
const MOST_SYMBOLS: usize = 256;
const KEPT_SYMBOLS: usize = 160;
/// The same of gains that remember, where the smallest become one for each number. The fewer, the narrower a set has to be:
/// steps of the small unmanned `uav-steps.toml` up to 5 deg take 6 sets with 640 and 4 with 1280.
const MOST_FOLLOWED: usize = 1280;
const KEPT_FOLLOWED: usize = 640;
/// Every so many samples it is asked whether the flights are near enough to rest.
const LOOKS: usize = 8;
/// Shares of all gains, around those at rest, for each of which the growth of the ball is known.
const SHARES: [f64; 7] = [0.001, 0.01, 0.05, 0.1, 0.25, 0.5, 1.0];
/// A set that is so many times as far off as its set-points and loads is given up.
const FAR: f64 = 30.0;

/// The loop made ready for sets of flights.
#[derive(Clone)]
pub(super) struct Ready<'a> {
    pub(super) flown: Flown<'a>,
    /// In which the ball is counted.
    norm: Norm,
    /// Of the form near rest.
    near: Norm,
    /// How many times the one the other is at most.
    into_near: f64,
    growth: Vec<Growth>,
    /// Root of the level within which no limit acts.
    within: f64,
    /// Gains that remember have to lie there as well.
    near_gains: Option<NearGains>,
    /// What a wrong rest may add.
    off_rest: f64,
    /// Rest by set-point and by load.
    rest: [Vec<f64>; 2],
    slew_rad: Option<f64>,
    /// Command at rest by set-point and by load.
    rest_command: [f64; 2],
    /// Boxes around the gains at rest, each within the next.
    around: Vec<[Interval; 3]>,
}

/// A box of set-points and loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Patch {
    pub(super) setpoint: [f64; 2],
    pub(super) load: [f64; 2],
}

/// A set of flights with the box that it is of.
pub(super) type Set = (Patch, Flight);

impl Patch {
    /// All of both.
    pub(super) fn hull(self, other: &Self) -> Self {
        let hull = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.min(c), b.max(d)];
        Self { setpoint: hull(self.setpoint, other.setpoint), load: hull(self.load, other.load) }
    }

    /// Set-point and load, each as its own unknown.
    pub(super) fn unknowns(&self) -> [Affine; 2] {
        [Affine::unknown(self.setpoint, SETPOINT), Affine::unknown(self.load, LOAD)]
    }
}

/// Where flights begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Beginning {
    /// At rest, at the controller's first sample.
    Controller,
    /// At rest, at any later one.
    Rest,
}

/// What a set of flights is commanded, and from where on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way<'a> {
    pub(super) commands: &'a Commands,
    pub(super) patch: Patch,
    pub(super) from: Beginning,
}

/// What came of a set of flights that ended near enough to rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Landed {
    /// Samples that were flown.
    pub(super) flown: usize,
    /// Samples from the beginning to there.
    pub(super) samples: usize,
    /// A limit may have acted.
    pub(super) limited: bool,
}

impl<'a> Ready<'a> {
    /// The loop with a form near rest.
    pub(super) fn of(
        description: &'a LoopDescription,
        model: &LoopModel<Interval>,
        set: &GainSet,
        [terminal, common]: [&Terminal; 2],
        system: Option<&'a System>,
    ) -> Result<Option<Self>, NotProved> {
        let near = Norm::of(&terminal.form, terminal.rate);
        let norm = Norm::of(&common.form, common.rate);
        // Gains that move are proved to make the form fall where it is the claim's own.
        let falls = matches!(description.controller, Controller::Fixed(_)) || common != terminal;
        let growth = if falls { Growth::with_rate(common.rate) } else { Growth::default() };
        let mut flown = flown(description, model, set, system)?;
        flown.reach = norm.reach()?;
        let mut ready = Self {
            around: SHARES.map(|share| around(set, share)).to_vec(),
            growth: vec![growth; SHARES.len()],
            into_near: norm.factor_into(&near),
            near,
            within: Interval::point(terminal.level).sqrt().lower(),
            near_gains: terminal.gains,
            slew_rad: flown.config.slew_rad_s.map(|slew| 0.5 * slew * flown.config.dt_s),
            flown,
            norm,
            off_rest: 0.0,
            rest: [Vec::new(), Vec::new()],
            rest_command: [0.0; 2],
        };
        let at_rest = ready.flown.gains.at_rest();
        if !ready.is_the_model(model, at_rest) || !ready.find_rest(at_rest, terminal.rate) {
            return Ok(None);
        }
        Ok(Some(ready))
    }

    /// Of gains that remember, how long a rest has to last, s.
    pub(super) fn rests_s(&self) -> Option<f64> {
        self.flown.tuner.as_ref().map(Tuner::rests_s)
    }

    /// Flights at rest, before anything is commanded.
    pub(super) fn begun(&mut self, from: Beginning) -> Flight {
        self.forget();
        begun(&self.flown, from)
    }

    /// Forgets what gains of other sets were, so that a check has the numbers of the search.
    pub(super) fn forget(&mut self) {
        self.flown.gains.forget();
    }

    /// Flies on until a sample.
    ///
    /// # Errors
    /// Why it was given up, and after how many samples.
    pub(super) fn until(
        &mut self,
        way: &Way<'_>,
        mut flight: Flight,
        samples: Range<usize>,
    ) -> Result<Flight, (Stop, usize)> {
        let from = samples.start;
        for sample in samples {
            flight = self.sample(way, flight, sample).map_err(|stop| (stop, sample - from))?;
        }
        Ok(flight)
    }

    /// Flies on until the flights have landed: not before all is commanded.
    ///
    /// # Errors
    /// Why it was given up, and after how many samples.
    pub(super) fn landed(
        &mut self,
        way: &Way<'_>,
        mut flight: Flight,
        samples: Range<usize>,
    ) -> Result<Landed, (Stop, usize)> {
        let (from, most) = (samples.start, samples.len());
        let last = way.commands.last_change();
        for sample in samples {
            flight = self.sample(way, flight, sample).map_err(|stop| (stop, sample - from))?;
            let looks = sample >= last && (sample - last) % LOOKS == LOOKS - 1;
            if looks && self.is_near(&flight) {
                let Flight { limited, .. } = flight;
                return Ok(Landed { flown: sample + 1 - from, samples: sample + 1, limited });
            }
        }
        Err((Stop::Lost, most))
    }

    /// What sets at the same sample have come to, as one.
    pub(super) fn joined(&self, sets: &[&Set]) -> Option<Joined> {
        Joined::of(&self.flown, sets)
    }

    /// How far the pitch angles of a set are apart, beside what set-point and load make of them, rad.
    pub(super) fn apart_rad(&self, flight: &Flight) -> f64 {
        let mut pitch = flight.values[0].clone();
        pitch.of_ball += self.flown.reach[0] * flight.ball;
        pitch.parts = pitch.parts.each().iter().skip(OWN).copied().collect();
        pitch.radius()
    }

    /// The gains of a set, each as a share of what it can reach; where they do not remember, of none.
    pub(super) fn gains_of_reach(&self, flight: &Flight) -> [Interval; 3] {
        let reach = self.around.last().copied().unwrap_or([Interval::ENTIRE; 3]);
        let ranges = self.flown.tuner.as_ref().zip(flight.tuned.as_ref());
        let Some(ranges) = ranges.map(|(tuner, tuned)| tuner.ranges(tuned)) else {
            return [Interval::ZERO; 3];
        };
        [0, 1, 2].map(|gain: usize| {
            let width = reach[gain].width();
            if width > 0.0 { ranges[gain] / Interval::point(width) } else { Interval::ZERO }
        })
    }

    /// A sample of a set, with what is commanded there.
    fn sample(&mut self, way: &Way<'_>, mut flight: Flight, sample: usize) -> Result<Flight, Stop> {
        commanded(&self.flown, &mut flight, way, sample);
        let begins = sample == 0 && way.from == Beginning::Controller;
        let moment = if begins { Moment::First } else { Moment::Later };
        let flight = self.after(&flight, moment)?;
        let size = |[least, most]: [f64; 2]| least.abs().max(most.abs());
        let far = FAR * (size(way.patch.setpoint) + size(way.patch.load));
        let known = flight.values[0].magnitude() <= far && flight.ball.is_finite();
        if known { Ok(flight) } else { Err(Stop::Lost) }
    }

    /// A set of flights a sample later, what rounding leaves in the ball.
    fn after(&mut self, flight: &Flight, moment: Moment) -> Result<Flight, Stop> {
        let Passage { flight: mut next, shares, gains } =
            self.flown.pass(flight, moment, Judge::Measured)?;
        let off: Vec<f64> = next.values.iter().map(|value| value.off).collect();
        let grown = self.grown(shares, gains) * flight.ball;
        next.ball = raised(grown + self.norm.of_box(&off), 4);
        next.values.iter_mut().for_each(|value| (value.off, value.of_ball) = (0.0, 0.0));
        match next.tuned {
            Some(_) if next.symbols > MOST_FOLLOWED => self.gather(&mut next),
            None if next.symbols > MOST_SYMBOLS => self.absorb(&mut next),
            _ => {}
        }
        Ok(next)
    }

    fn grown(&mut self, shares: [f64; PLACES], gains: Between) -> f64 {
        let Self { growth, norm, flown, around, .. } = self;
        let size = flown.layout.size;
        let inside = |bounds: &[Interval; 3]| {
            bounds.iter().zip(gains.middle).all(|(bounds, gain)| bounds.contains(gain))
        };
        let place = match flown.tuner {
            // All of them, so that none that is reached is left out.
            Some(_) => Some(around.len() - 1),
            None => around.iter().position(inside),
        };
        let Some(place) = place else { return f64::INFINITY };
        let corners = corners(around[place]);
        growth[place].of(norm, shares, |shares| {
            let matrix = |gains: &Between| forced(flown, shares, *gains).unwrap_or(unknown(size));
            corners.iter().map(matrix).collect()
        })
    }

    /// Makes the smallest unknowns a ball.
    fn absorb(&self, flight: &mut Flight) {
        let own = OWN..flight.symbols;
        let column = |flight: &Flight, symbol: usize| -> Vec<f64> {
            flight.values.iter().map(|value| value.parts.of(symbol)).collect()
        };
        let mut sizes: Vec<(f64, usize)> =
            own.map(|symbol| (self.norm.size_of(&column(flight, symbol)), symbol)).collect();
        sizes.sort_unstable_by(|one, other| other.0.total_cmp(&one.0).then(one.1.cmp(&other.1)));
        let absorbed = sizes.split_off(sizes.len().min(KEPT_SYMBOLS));
        let sum = absorbed.iter().map(|(size, _)| size).sum::<f64>() + flight.ball;
        flight.ball = raised(sum, absorbed.len() + 2);
        let mut kept: Vec<usize> =
            (0..OWN).chain(sizes.iter().map(|(_, symbol)| *symbol)).collect();
        kept.sort_unstable();
        let gone: Vec<usize> = absorbed.iter().map(|(_, symbol)| *symbol).collect();
        let lost = gone.iter().map(|symbol| flight.last.parts.of(*symbol).abs()).sum::<f64>();
        flight.last.off = raised(flight.last.off + lost, gone.len() + 2);
        for value in flight.values.iter_mut().chain([&mut flight.last]) {
            value.parts = kept.iter().map(|symbol| value.parts.of(*symbol)).collect();
        }
        flight.symbols = kept.len();
    }

    /// Makes the smallest unknowns one of its own for each number.
    fn gather(&self, flight: &mut Flight) {
        let size = |symbol: usize| -> f64 {
            let column: Vec<f64> =
                flight.values.iter().map(|value| value.parts.of(symbol)).collect();
            let tuned = flight.tuned.iter().flat_map(Tuned::each);
            self.near.size_of(&column)
                + tuned.map(|value| value.parts.of(symbol).abs()).sum::<f64>()
        };
        let mut sizes: Vec<(f64, usize)> =
            (OWN..flight.symbols).map(|symbol| (size(symbol), symbol)).collect();
        sizes.sort_unstable_by(|one, other| other.0.total_cmp(&one.0).then(one.1.cmp(&other.1)));
        let gone = sizes.split_off(sizes.len().min(KEPT_FOLLOWED));
        let mut kept: Vec<usize> =
            (0..OWN).chain(sizes.iter().map(|(_, symbol)| *symbol)).collect();
        kept.sort_unstable();
        let mut symbols = kept.len();
        let mut symbol = || {
            symbols += 1;
            symbols - 1
        };
        // Of the ball what it adds to each state: unknowns are followed, where a ball only grows with what moves by it.
        for (value, reach) in flight.values.iter_mut().zip(&self.flown.reach) {
            value.of_ball = raised(reach * flight.ball, 2);
        }
        flight.ball = 0.0;
        let tuned = flight.tuned.iter_mut().flat_map(Tuned::each_mut);
        for value in flight.values.iter_mut().chain([&mut flight.last]).chain(tuned) {
            let sum = gone.iter().map(|(_, symbol)| value.parts.of(*symbol).abs()).sum::<f64>();
            let sum = raised(sum + value.off + value.of_ball, gone.len() + 2);
            let parts = kept.iter().map(|symbol| value.parts.of(*symbol)).collect();
            let whole = Affine { centre: value.centre, parts, off: 0.0, of_ball: 0.0 };
            *value = whole.and_noise(sum, &mut symbol);
        }
        flight.symbols = symbols;
    }

    /// True where the gains of every flight lie where those near rest stay, and the reference model is as near.
    fn is_near_in_gains(&self, flight: &Flight) -> bool {
        match (&self.flown.tuner, &flight.tuned, &self.near_gains) {
            (None, None, None) => true,
            (Some(tuner), Some(tuned), Some(near)) => {
                // What the law reaches at all is known apart from the flights.
                let all = self.around.last().copied().unwrap_or([Interval::ENTIRE; 3]);
                let reached = tuner.ranges(tuned).into_iter().zip(all);
                let reached = reached.map(|(range, all)| range.intersection(all).unwrap_or(range));
                let mut inside = near.bounds().into_iter().zip(reached);
                inside.all(|(bounds, range)| bounds.encloses(range))
                    && tuner.model_later(tuned, &flight.setpoint) <= near.model_rad
            }
            _ => false,
        }
    }

    /// True where every flight is within the level, and its last command within a slew limit.
    fn is_near(&self, flight: &Flight) -> bool {
        // Rest is the same wherever a load enters.
        let load = flight.load.plus(&flight.at_servo);
        let away = |value: &Affine, by: [f64; 2]| {
            let terms =
                [(Interval::point(-by[0]), &flight.setpoint), (Interval::point(-by[1]), &load)];
            Affine::sum(terms.into_iter().chain([(Interval::ONE, value)]))
        };
        let values: Vec<Affine> = flight
            .values
            .iter()
            .enumerate()
            .map(|(place, value)| away(value, [self.rest[0][place], self.rest[1][place]]))
            .collect();
        if !self.is_near_in_gains(flight) {
            return false;
        }
        // A look at the largest parts first.
        let middle: Vec<f64> = values.iter().map(|value| value.centre).collect();
        let mut size = self.near.size_of(&middle) + self.into_near * flight.ball;
        let off: Vec<f64> = values.iter().map(|value| value.off).collect();
        size += self.near.of_box(&off);
        let sizes = [&flight.setpoint, &load].map(Affine::magnitude);
        size += self.off_rest * raised(sizes[0] + sizes[1], 2);
        for symbol in 0..flight.symbols {
            if size > self.within {
                return false;
            }
            let column: Vec<f64> = values.iter().map(|value| value.parts.of(symbol)).collect();
            size += self.near.size_of(&column);
        }
        let slewed = self
            .slew_rad
            .is_none_or(|most| away(&flight.last, self.rest_command).magnitude() < most);
        raised(size, flight.symbols + 8) <= self.within && slewed && self.is_clear(flight)
    }

    /// True where no command on its way meets a limit when it arrives: the form bounds those that come after it.
    fn is_clear(&self, flight: &Flight) -> bool {
        let Flown { layout, arriving, travel, reach, .. } = &self.flown;
        let limits = [arriving, travel].into_iter().flatten();
        let on_their_way = layout.plant..layout.plant + layout.queue;
        let mut each =
            limits.flat_map(|limits| on_their_way.clone().map(move |place| (place, limits)));
        each.all(|(place, (least, most))| {
            let mut command = flight.values[place].plus(&flight.at_servo);
            command.of_ball = raised(reach[place] * flight.ball, 2);
            command.range().lower() > *least && command.range().upper() < *most
        })
    }

    /// Whether the samples that are flown are those of the model that the form is proved for.
    fn is_the_model(&self, model: &LoopModel<Interval>, gains: Between) -> bool {
        let Some(own) = forced(&self.flown, FREE, gains) else { return false };
        let [kp, ki, kd] = gains.middle.map(Interval::point);
        let rows = model.closed(Gains { kp, ki, kd });
        let Ok(matrix) = IntervalMatrix::from_rows(&rows) else { return false };
        let [own, matrix] = [own.midpoint(), matrix.midpoint()];
        let apart = own
            .data()
            .iter()
            .zip(matrix.data())
            .map(|(one, other)| (one - other).abs() / (1.0 + one.abs().max(other.abs())));
        own.data().len() == matrix.data().len() && apart.fold(0.0, f64::max) <= 1e-9
    }

    /// Rest by set-point and load, in ordinary arithmetic, and how far the true one may be from it.
    fn find_rest(&mut self, gains: Between, rate: f64) -> bool {
        let size = self.flown.layout.size;
        let Some(matrix) = forced(&self.flown, FREE, gains).map(|matrix| matrix.midpoint()) else {
            return false;
        };
        let Ok(left) = Matrix::identity(size).sum(&matrix.scaled(-1.0)) else { return false };
        let still = Between { radius: [0.0; 3], ..gains };
        let Ok(pushed) =
            self.flown.pass(&self.unit(None), Moment::Later, Judge::Forced(FREE, still))
        else {
            return false;
        };
        for symbol in [SETPOINT, LOAD] {
            let by: Vec<[f64; 1]> =
                pushed.flight.values.iter().map(|value| [value.parts.of(symbol)]).collect();
            let solved = Matrix::from_rows(&by).and_then(|right| left.solve(&right));
            let Ok(solved) = solved else { return false };
            self.rest[symbol] = solved.data().to_vec();
        }
        // What a sample still moves there, the gains at rest between their bounds.
        let Ok(moved) = self.flown.pass(
            &self.unit(Some(&self.rest)),
            Moment::Later,
            Judge::Forced(FREE, gains),
        ) else {
            return false;
        };
        let at = self.unit(Some(&self.rest));
        let off: Vec<f64> = moved
            .flight
            .values
            .iter()
            .zip(&at.values)
            .map(|(next, now)| next.less(now).magnitude())
            .collect();
        self.off_rest = (Interval::point(self.near.of_box(&off))
            / (Interval::ONE - Interval::point(rate)))
        .upper();
        let command = &moved.flight.last;
        self.rest_command = [SETPOINT, LOAD].map(|symbol| command.parts.of(symbol));
        self.off_rest.is_finite()
    }

    /// A set-point and a load of 1, at rest or at the trim.
    fn unit(&self, at: Option<&[Vec<f64>; 2]>) -> Flight {
        let size = self.flown.layout.size;
        let mut flight = Flight {
            values: vec![Affine::default(); size],
            last: Affine::default(),
            setpoint: Affine::unknown([-1.0, 1.0], SETPOINT),
            risen: Affine::default(),
            load: Affine::unknown([-1.0, 1.0], LOAD),
            at_servo: Affine::default(),
            tuned: None,
            ball: 0.0,
            symbols: OWN,
            limited: false,
        };
        if let Some([by_setpoint, by_load]) = at {
            for (place, value) in flight.values.iter_mut().enumerate() {
                value.parts = vec![by_setpoint[place], by_load[place]].into();
            }
        }
        flight
    }
}

/// At rest, before anything is commanded.
pub(super) fn begun(flown: &Flown<'_>, from: Beginning) -> Flight {
    let begun = |tuner: &Tuner<'_>| tuner.begun(flown.rested, from == Beginning::Controller, OWN);
    let tuned = flown.tuner.as_ref().map(begun);
    let symbols = OWN + tuned.as_ref().map_or(0, |tuned| tuned.gains.len());
    Flight {
        values: vec![Affine::default(); flown.layout.size],
        last: Affine::default(),
        setpoint: Affine::default(),
        risen: Affine::default(),
        load: Affine::default(),
        at_servo: Affine::default(),
        tuned,
        ball: 0.0,
        symbols,
        limited: false,
    }
}

/// What is commanded from a sample on.
pub(super) fn commanded(flown: &Flown<'_>, flight: &mut Flight, way: &Way<'_>, sample: usize) {
    let Way { commands, patch, .. } = way;
    let [setpoint, load] = patch.unknowns();
    if let Some(to) = commands.setpoint.change(sample) {
        let to = setpoint.times(to);
        flight.risen = to.less(&flight.setpoint);
        flight.setpoint = to;
    }
    if let Some(to) = commands.at_servo.change(sample) {
        flight.at_servo = load.times(to);
    }
    if let Some(to) = commands.at_elevator.change(sample) {
        let to = load.times(to);
        // Behind the deflection there is its rate where the lag is of second order.
        let place = flown.layout.plant - if flown.lag_order == 2 { 2 } else { 1 };
        flight.values[place] = flight.values[place].plus(&to.less(&flight.load));
        flight.load = to;
    }
}

fn unknown(size: usize) -> IntervalMatrix {
    IntervalMatrix::from_rows(&vec![vec![Interval::ENTIRE; size]; size])
        .unwrap_or_else(|_| IntervalMatrix::zeros(size, size))
}

/// The matrix of a sample with these shares and gains.
fn forced(flown: &Flown<'_>, shares: [f64; PLACES], gains: Between) -> Option<IntervalMatrix> {
    let size = flown.layout.size;
    let mut flight = Flight {
        values: vec![Affine::default(); size],
        last: Affine::default(),
        setpoint: Affine::default(),
        risen: Affine::default(),
        load: Affine::default(),
        at_servo: Affine::default(),
        tuned: None,
        ball: 0.0,
        symbols: size,
        limited: false,
    };
    for (place, value) in flight.values.iter_mut().enumerate() {
        value.parts = (0..size).map(|at| if at == place { 1.0 } else { 0.0 }).collect();
    }
    let still = Between { radius: [0.0; 3], ..gains };
    let moved = flown.pass(&flight, Moment::Later, Judge::Forced(shares, still)).ok()?;
    let row = |value: &Affine| -> Vec<Interval> {
        let off = Interval::between(-value.off, value.off);
        (0..size).map(|place| Interval::point(value.parts.of(place)) + off).collect()
    };
    let rows: Vec<Vec<Interval>> = moved.flight.values.iter().map(row).collect();
    IntervalMatrix::from_rows(&rows).ok()
}

/// Corners of a box of gains.
fn corners(bounds: [Interval; 3]) -> Vec<Between> {
    let ends = |corner: usize| {
        [0, 1, 2].map(|gain: usize| match corner >> gain & 1 {
            0 => bounds[gain].lower(),
            _ => bounds[gain].upper(),
        })
    };
    let mut found: Vec<Between> = Vec::new();
    for corner in 0..8 {
        let between = Between { middle: ends(corner), radius: [0.0; 3] };
        if !found.contains(&between) {
            found.push(between);
        }
    }
    found
}

#[cfg(test)]
pub(super) mod tests;
