//! A servo of first order with a rate limit over one sample, as the simulator passes through it.
//!
//! With a command v that is held over a sample of T and a gap $g = v - \delta$ at its beginning the deflection runs at R
//! towards v for
//!
//! $$ t_1 = \min\left(T, \max\left(0, \frac{|g|}{R} - \tau\right)\right) $$
//!
//! and follows its lag for the rest. To what states do beside a deflection that stands still, this adds a vector D(g). The
//! law changes at $t_1$ without a jump of rate, so that moving $t_1$ adds nothing of first order and only the command that
//! the lag follows counts:
//!
//! $$ D'(g) = S(T - t_1), \qquad S(t) = \int_0^t e^{A s} b \ ds $$
//!
//! D is odd, linear up to $R \tau$, constant beyond $R (\tau + T)$, and between them enclosed over pieces of $t_1$.

use fspid_numeric::scalar::Interval;

use super::cut::{Line, beside_line, is_same};
use crate::check::{ActuatorLag, IntervalMatrix, NotProved, Passed, PrintedPlant, printed};
use crate::description::LoopDescription;

/// Pieces of the time at the rate limit.
const PIECES: u32 = 8;
/// Times are taken so much wider, so that a float may stand for the gap at which a piece begins.
const WIDER: f64 = 1e-12;

/// What a gap adds to plant and deflection within a sample.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// Gaps at which a piece begins, with D there; the last is that from which D stands still.
    knots: Vec<(f64, Vec<Interval>)>,
    /// Slopes from each knot to the next.
    slopes: Vec<Vec<Interval>>,
    /// Slope up to the first knot.
    linear: Vec<Interval>,
}

impl Curve {
    /// The curve of a loop with a rate limit and a lag of first order; none without a rate limit.
    pub(super) fn of(description: &LoopDescription) -> Result<Option<Self>, NotProved> {
        let actuator = &description.actuator;
        let (Some(limit), Some(time_s)) =
            (actuator.rate_limit_rad_s(), actuator.lag().time_constant_s())
        else {
            return Ok(None);
        };
        let plant = PrintedPlant {
            numerator: &description.numerator,
            denominator: &description.denominator,
            elevator_sign: description.elevator_sign,
            lag: ActuatorLag::from(actuator.lag()),
            dt_s: description.controller.config().dt_s,
        };
        let (limit, lag_s, dt_s) = (Interval::point(limit), printed(time_s), printed(plant.dt_s));
        let at = |piece: u32| {
            dt_s * Interval::point(f64::from(piece)) / Interval::point(f64::from(PIECES))
        };
        let wider = Interval::between(1.0 - WIDER, 1.0 + WIDER);
        let mut knots = Vec::new();
        let mut slopes = Vec::new();
        for piece in 0..=PIECES {
            let (ran, left) = (at(piece), at(PIECES - piece));
            let gap = limit * (lag_s + ran);
            // The curve is Lipschitz, so that a knot may be called by a float near it.
            let slope = plant.over(left)?.by_command;
            let value = landed(&plant, [ran, left], limit, limit * lag_s)?;
            let beside = Interval::point(gap.midpoint()) - gap;
            let value = value.iter().zip(&slope).map(|(value, slope)| *value + *slope * beside);
            knots.push((gap.midpoint(), value.collect()));
            if piece > 0 {
                let left = at(PIECES - piece).hull(at(PIECES - piece + 1)) * wider;
                slopes.push(plant.over(left)?.by_command);
            }
        }
        let linear = plant.over(dt_s * wider)?.by_command;
        Ok(Some(Self { knots, slopes, linear }))
    }

    /// How many numbers D has.
    pub(super) fn size(&self) -> usize {
        self.linear.len()
    }

    /// True where the curve is linear, or stands still, over a range.
    pub(super) fn is_linear(&self, gap: Interval) -> bool {
        let first = self.knots.first().map_or(0.0, |(at, _)| *at);
        gap.magnitude() <= first * (1.0 - 1e-9)
    }

    /// Lines for each number of D over a range of gaps, with the share of the linear slope that they have.
    pub(super) fn lines(&self, gap: Interval) -> (Vec<Line>, f64) {
        if let Some(constant) = self.constant(gap) {
            return (constant.iter().map(|value| Line::between(*value)).collect(), 0.0);
        }
        if !gap.is_bounded() {
            return (vec![Line::between(Interval::ENTIRE); self.size()], 0.0);
        }
        let [a, b] = [gap.lower(), gap.upper()];
        let ends = [self.value(a), self.value(b)];
        let pieces = self.pieces(a, b);
        let lines = (0..self.size()).map(|place| {
            let [from, to] = [&ends[0], &ends[1]].map(|end| end[place].midpoint());
            let slope = if is_same(a, b) { 0.0 } else { (to - from) / (b - a) };
            let offs = pieces.iter().map(|(ends, value, slopes)| {
                beside_line(*ends, value[place], slopes[place], slope)
            });
            let whole = offs.reduce(Interval::hull).unwrap_or(Interval::ENTIRE);
            Line { slope, ..Line::between(whole) }
        });
        let lines: Vec<Line> = lines.collect();
        let last = self.size() - 1;
        let share = (lines[last].slope / self.linear[last].midpoint()).clamp(0.0, 1.0);
        (lines, share)
    }

    /// The linear slopes.
    pub(super) fn linear(&self) -> &[Interval] {
        &self.linear
    }

    /// D where it stands still.
    fn constant(&self, gap: Interval) -> Option<Vec<Interval>> {
        let (at, value) = self.knots.last()?;
        let beyond = at * (1.0 + 1e-9);
        if gap.lower() >= beyond {
            return Some(value.clone());
        }
        (gap.upper() <= -beyond).then(|| value.iter().map(|value| -*value).collect())
    }

    /// D at a gap.
    fn value(&self, gap: f64) -> Vec<Interval> {
        let size = gap.abs();
        let sign = Interval::point(if gap < 0.0 { -1.0 } else { 1.0 });
        let before = self.knots.iter().rposition(|(at, _)| *at <= size);
        let value: Vec<Interval> = match before {
            None => self.linear.iter().map(|slope| *slope * Interval::point(size)).collect(),
            Some(place) => {
                let (at, value) = &self.knots[place];
                let along = Interval::point(size) - Interval::point(*at);
                let slopes = self.slopes.get(place);
                let slope = |number: usize| slopes.map_or(Interval::ZERO, |all| all[number]);
                value
                    .iter()
                    .enumerate()
                    .map(|(number, value)| *value + slope(number) * along)
                    .collect()
            }
        };
        value.into_iter().map(|value| sign * value).collect()
    }

    /// Pieces of a range in which the slopes of D are known, each with D at its beginning and its slopes.
    fn pieces(&self, a: f64, b: f64) -> Vec<([f64; 2], Vec<Interval>, Vec<Interval>)> {
        let places = self.knots.iter().flat_map(|(at, _)| [-*at, *at]);
        let mut ends: Vec<f64> = places.filter(|at| *at > a && *at < b).collect();
        ends.extend([a, b]);
        ends.sort_unstable_by(f64::total_cmp);
        let piece = |pair: &[f64]| {
            let middle = (0.5 * (pair[0] + pair[1])).abs();
            let before = self.knots.iter().rposition(|(at, _)| *at <= middle);
            let slopes = match before {
                None => self.linear.clone(),
                Some(place) => match self.slopes.get(place) {
                    Some(slopes) => slopes.clone(),
                    None => vec![Interval::ZERO; self.size()],
                },
            };
            ([pair[0], pair[1]], self.value(pair[0]), slopes)
        };
        ends.windows(2).map(piece).collect()
    }
}

/// D where the limit holds for a time and the lag follows for another.
fn landed(
    plant: &PrintedPlant<'_>,
    [ran, left]: [Interval; 2],
    limit: Interval,
    gap_left: Interval,
) -> Result<Vec<Interval>, NotProved> {
    let states = plant.over(ran)?.ramp;
    let states: Vec<[Interval; 1]> = states.into_iter().map(|value| [value * limit]).collect();
    let deflection = states.last().map_or(Interval::ZERO, |[value]| *value);
    let Passed { follow, by_command, .. } = plant.over(left)?;
    let moved = follow.product(&IntervalMatrix::from_rows(&states)?)?;
    let command = deflection + gap_left;
    Ok(moved.entries().zip(by_command).map(|(value, by)| value + by * command).collect())
}

#[cfg(test)]
mod tests {
    use fspid_core::{Pid, PidConfig};
    use fspid_sim::Controller;
    use fspid_sim::actuator::Actuator;

    use super::*;
    use crate::rest::drawn::Dice;
    use crate::steps::tests::navion::{GAINS, navion};

    const RATE: f64 = 0.35;
    const LAG_S: f64 = 0.1;
    const DT_S: f64 = 0.05;

    /// The Navion behind a servo of 20 deg/s.
    fn limited() -> LoopDescription {
        let servo = Actuator::first_order(LAG_S).and_then(|servo| servo.with_rate_limit(RATE));
        let pid = Pid::new(GAINS, PidConfig::sampled_every(DT_S));
        navion(servo.expect("allowed"), Controller::Fixed(pid.expect("allowed")))
    }

    fn plant(description: &LoopDescription) -> PrintedPlant<'_> {
        PrintedPlant {
            numerator: &description.numerator,
            denominator: &description.denominator,
            elevator_sign: description.elevator_sign,
            lag: ActuatorLag::from(description.actuator.lag()),
            dt_s: DT_S,
        }
    }

    fn curve() -> Curve {
        Curve::of(&limited()).expect("enclosed").expect("a rate limit")
    }

    /// D at a gap, from the time at the rate limit, without pieces.
    fn exact(plant: &PrintedPlant<'_>, gap: f64) -> Vec<f64> {
        let size = gap.abs();
        let ran = (size / RATE - LAG_S).clamp(0.0, DT_S);
        let times = [ran, DT_S - ran].map(Interval::point);
        let left = Interval::point(size.min(RATE * LAG_S));
        let landed = landed(plant, times, Interval::point(RATE), left).expect("enclosed");
        landed.iter().map(|value| value.midpoint() * gap.signum()).collect()
    }

    /// A range of gaps: of the linear part, of either side, across zero, and beyond where D stands still.
    fn drawn(dice: &mut Dice) -> [f64; 2] {
        let most = 1.3 * RATE * (LAG_S + DT_S);
        let one = dice.between(-most, most);
        let other = dice.between(-most, most);
        let near = one + 0.1 * other;
        let end = if dice.part() < 0.5 { other } else { near };
        [one.min(end), one.max(end)]
    }

    #[test]
    fn what_a_gap_adds_lies_on_the_line_through_its_ends_and_no_further_than_a_piece_makes_it() {
        let (description, curve) = (limited(), curve());
        let plant = plant(&description);
        for seed in 0..150 {
            let [a, b] = drawn(&mut Dice::new(seed));
            let (lines, share) = curve.lines(Interval::between(a, b));
            let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; lines.len()];
            for step in 0..=20 {
                let gap = a + (b - a) * f64::from(step) / 20.0;
                for ((line, value), ends) in lines.iter().zip(exact(&plant, gap)).zip(&mut ends) {
                    let off = value - line.slope * gap - line.offset.midpoint();
                    assert!(off.abs() <= line.half + 1e-15, "{seed}: {off:e} {line:?}");
                    *ends = [ends[0].min(off), ends[1].max(off)];
                }
            }
            let linear = curve.linear();
            let rises =
                exact(&plant, a).into_iter().zip(exact(&plant, b)).map(|(from, to)| to - from);
            for (((line, [least, most]), linear), rise) in
                lines.iter().zip(ends).zip(linear).zip(rises)
            {
                let wide = 0.5 * (most - least);
                let more = linear.magnitude() * RATE * DT_S / f64::from(PIECES);
                assert!(line.half <= wide + more, "{seed}: {wide:e} {more:e} {line:?}");
                assert!((line.slope * (b - a) - rise).abs() <= more, "{seed}: {rise} {line:?}");
            }
            let last = lines.len() - 1;
            let of_last = lines[last].slope / linear[last].midpoint();
            assert!((share - of_last).abs() < 1e-9, "{seed}: {share} {of_last}");
        }
    }

    /// A float stands for the gap at which a piece begins, which is known to some digits; so that slopes hold a little longer.
    #[test]
    fn slopes_hold_a_little_beyond_the_times_of_their_pieces() {
        let (description, curve) = (limited(), curve());
        let plant = plant(&description);
        let over = |time_s: f64| plant.over(Interval::point(time_s)).expect("enclosed").by_command;
        let holds = |slopes: &[Interval], time_s: f64| {
            let beyond = [-0.9, 0.9].map(|part| over(time_s * (1.0 + part * WIDER)));
            beyond.iter().all(|exact| {
                slopes.iter().zip(exact).all(|(slope, exact)| slope.contains(exact.midpoint()))
            })
        };
        let piece_s = DT_S / f64::from(PIECES);
        assert!(holds(&curve.linear, DT_S));
        assert_eq!(curve.slopes.len(), PIECES as usize);
        for (place, slopes) in curve.slopes.iter().enumerate() {
            let left_s = DT_S - piece_s * place as f64;
            assert!(holds(slopes, left_s) && holds(slopes, left_s - piece_s), "{place}");
        }
        for (slope, exact) in curve.linear.iter().zip(over(DT_S)) {
            assert!(slope.width() < 1e-9 * exact.magnitude(), "{slope:?}");
        }
    }

    #[test]
    fn knots_are_the_gaps_of_even_times_with_what_they_add() {
        let (description, curve) = (limited(), curve());
        let plant = plant(&description);
        for (place, (at, value)) in curve.knots.iter().enumerate() {
            let gap = RATE * (LAG_S + DT_S * place as f64 / f64::from(PIECES));
            assert!((at - gap).abs() < 1e-15, "{place}: {at}");
            for (value, exact) in value.iter().zip(exact(&plant, *at)) {
                assert!((value.midpoint() - exact).abs() < 1e-13, "{place}: {value:?} {exact}");
                assert!(value.width() < 1e-13, "{place}: {value:?}");
            }
        }
        assert!(curve.knots.len() == PIECES as usize + 1 && curve.size() == 5);
    }

    #[test]
    fn gaps_up_to_the_first_knot_are_linear_but_for_the_last_digits() {
        let curve = curve();
        let first = RATE * LAG_S;
        for (gap, is_linear) in [(1.0 - 1e-8, true), (1.0 - 1e-10, false), (1.0 + 1e-10, false)] {
            let gap = gap * first;
            assert_eq!(curve.is_linear(Interval::between(0.0, gap)), is_linear, "{gap}");
            assert_eq!(curve.is_linear(Interval::between(-gap, 0.5 * gap)), is_linear, "{gap}");
        }
    }

    /// Beyond the last knot, however far, on either side.
    #[test]
    fn gaps_beyond_the_last_knot_add_what_it_does() {
        let (description, curve) = (limited(), curve());
        let last = RATE * (LAG_S + DT_S);
        let exact = exact(&plant(&description), last);
        let beyond = |from: f64| Interval::new(from, f64::INFINITY).unwrap();
        for (gap, sign) in [
            (beyond(last * (1.0 + 1e-8)), 1.0),
            (beyond(7.0), 1.0),
            (-beyond(last * (1.0 + 1e-8)), -1.0),
            (-beyond(7.0), -1.0),
        ] {
            let (lines, share) = curve.lines(gap);
            assert!(share.abs() <= 0.0, "{gap:?}: {share}");
            for (line, exact) in lines.iter().zip(&exact) {
                let off = line.offset.midpoint() - sign * exact;
                assert!(line.slope.abs() <= 0.0 && line.half < 1e-13, "{gap:?}: {line:?}");
                assert!(off.abs() < 1e-13, "{gap:?}: {line:?} {exact}");
            }
        }
        for gap in [beyond(last * (1.0 + 1e-10)), -beyond(last * (1.0 - 1e-10))] {
            let (lines, _) = curve.lines(gap);
            assert!(lines.iter().all(|line| line.half > 1e300), "the last digits: {gap:?}");
        }
    }

    /// A range of one gap has no slope.
    #[test]
    fn one_gap_adds_one_value() {
        let (description, curve) = (limited(), curve());
        let plant = plant(&description);
        for gap in [-0.07, -0.04, -0.01, 0.0, 0.02, 0.045, 0.051, 0.09] {
            let (lines, _) = curve.lines(Interval::point(gap));
            for (line, exact) in lines.iter().zip(exact(&plant, gap)) {
                let off = (line.offset.midpoint() - exact).abs();
                assert!(line.slope.abs() <= 0.0 && off <= line.half + 1e-15, "{gap}: {line:?}");
            }
        }
    }
}
