//! From increments to gains: what the tuning laws make of them.

use fspid_core::{Law, Limits, SelfTuner};
use fspid_fuzzy::OutOfRange;
use fspid_numeric::scalar::Interval;

use super::increments::{IncrementCell, IncrementMap};
use super::reached::{Reached, Told};
use super::{EVERYWHERE, GainCell, GainSet, NAMES, NoBound, array};

/// Roundings of the accumulating law, in units of the gains and distances that they act on; see
/// [`One::accumulated`].
const STEP_ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// One of the three gains: its nominal value $k'$, factor $f s$, limits, and the leakage.
pub(super) struct One {
    nominal: f64,
    factor: Interval,
    limits: Option<Limits<f64>>,
    leakage_per_s: f64,
}

impl One {
    /// The gain of the memoryless law.
    ///
    /// Interval arithmetic holds the exact and the rounded $k' + s \Delta k$ alike.
    pub(super) fn memoryless(&self, delta: Interval) -> Interval {
        self.limited(Interval::point(self.nominal) + self.factor * delta)
    }

    /// Every gain that the accumulating law reaches from the nominal one with increments between
    /// bounds, if these are bounds.
    ///
    /// $$ x^+ = x + (s \Delta k - \lambda x) T, \qquad x = k - k', \quad x_0 = 0 $$
    ///
    /// Let $\lambda > 0$, $0 \le \lambda T \le 1$ (a controller refuses other periods) and
    /// $s \Delta k \in [\lambda L, \lambda U]$ with $L \le 0 \le U$. Then $x \in [L, U]$ makes
    /// $x^+ = (1 - \lambda T) x + \lambda T \frac{s \Delta k}{\lambda}$ a mean of two numbers of
    /// $[L, U]$, and so $x$ never leaves it.
    ///
    /// Rounded, with $\epsilon = 2^{-53}$ and $B = U - L$: where the computed slope is not positive,
    /// $k$ does not rise. Where it is, $\lambda x (1 - 2 \epsilon) < \lambda U$, so that $x$ was
    /// below $U + 3 \epsilon B$, and the step and the sum leave it below
    /// $U + 10 \epsilon B + \epsilon |k^+|$. That is no more at the thousandth sample than at the
    /// first: errors do not add up. Likewise from below. The bounds are widened by
    /// $16 \epsilon (|k'| + B)$ and, for products that underflow, by the smallest normal number.
    ///
    /// Without leakage $x$ rises for ever if $s \Delta k$ can be positive, and falls if it can be
    /// negative; only the limits then hold it.
    pub(super) fn accumulated(&self, delta: Interval) -> Interval {
        let (nominal, increment) = (Interval::point(self.nominal), self.factor * delta);
        let still = increment.lower() >= 0.0 && increment.upper() <= 0.0;
        let free = if still {
            nominal
        } else if self.leakage_per_s > 0.0 {
            let reach = increment / Interval::point(self.leakage_per_s);
            let reach = reach.hull(Interval::ZERO);
            let slack = STEP_ROUNDINGS * (self.nominal.abs() + reach.width()) + f64::MIN_POSITIVE;
            nominal + reach + Interval::between(-slack, slack)
        } else {
            nominal + drift(increment)
        };
        self.limited(free)
    }

    /// Largest magnitude of the slope $s \Delta k - \lambda x$ of the accumulating law.
    fn rate_per_s(&self, delta: Interval) -> f64 {
        let beyond = self.accumulated(delta) - Interval::point(self.nominal);
        (self.factor * delta - Interval::point(self.leakage_per_s) * beyond).magnitude()
    }

    /// Where the accumulating law tends to if the increments stay between bounds.
    fn settled(&self, delta: Interval) -> Interval {
        let (nominal, increment) = (Interval::point(self.nominal), self.factor * delta);
        let free = if self.leakage_per_s > 0.0 {
            nominal + increment / Interval::point(self.leakage_per_s)
        } else if increment.lower() > 0.0 {
            Interval::point(f64::INFINITY)
        } else if increment.upper() < 0.0 {
            Interval::point(f64::NEG_INFINITY)
        } else {
            nominal + drift(increment)
        };
        self.limited(free)
    }

    fn limited(&self, gain: Interval) -> Interval {
        self.limits.map_or(gain, |limits| {
            Interval::between(limits.clamp(gain.lower()), limits.clamp(gain.upper()))
        })
    }
}

/// Everything that numbers between bounds can be summed up to.
fn drift(increment: Interval) -> Interval {
    let lower = if increment.lower() < 0.0 { f64::NEG_INFINITY } else { 0.0 };
    let upper = if increment.upper() > 0.0 { f64::INFINITY } else { 0.0 };
    Interval::new(lower, upper).unwrap_or(Interval::ENTIRE)
}

/// The three gains of a tuner.
pub(super) fn each(tuner: &SelfTuner<f64>, output_factor: f64) -> [One; 3] {
    let settings = tuner.settings();
    let leakage_per_s = match settings.law {
        Law::Memoryless => 0.0,
        Law::Accumulating { leakage_per_s } => leakage_per_s,
    };
    let limits = settings.gain_limits.map(|limits| [limits.kp, limits.ki, limits.kd]);
    let [nominal, scale] = [tuner.nominal(), settings.output_scale].map(array);
    [0, 1, 2].map(|gain: usize| One {
        nominal: nominal[gain],
        factor: Interval::point(output_factor) * Interval::point(scale[gain]),
        limits: limits.map(|limits| limits[gain]),
        leakage_per_s,
    })
}

/// Bounds of the three increments over all cells.
fn hull(map: &IncrementMap) -> [Interval; 3] {
    [0, 1, 2].map(|gain: usize| {
        let cells = map.cells.iter().map(|cell| cell.delta[gain]);
        cells.reduce(Interval::hull).unwrap_or(Interval::ZERO)
    })
}

fn of_each(
    each: &[One; 3],
    delta: [Interval; 3],
    gain: fn(&One, Interval) -> Interval,
) -> [Interval; 3] {
    let [kp, ki, kd] = each;
    let [of_kp, of_ki, of_kd] = delta;
    [gain(kp, of_kp), gain(ki, of_ki), gain(kd, of_kd)]
}

/// Refuses a law under which a gain has no bounds.
pub(super) fn check(map: &IncrementMap) -> Result<(), NoBound> {
    if map.tuner.settings().law == Law::Memoryless {
        return Ok(());
    }
    let bounds = of_each(&each(&map.tuner, 1.0), hull(map), One::accumulated);
    match NAMES.into_iter().zip(bounds).find(|(_, bounds)| !bounds.is_bounded()) {
        Some((gain, _)) => Err(NoBound::Accumulating { gain }),
        None => Ok(()),
    }
}

/// The gains of a tuner with `output_factor` times its output factors.
pub(super) fn gains(map: &IncrementMap, output_factor: f64) -> GainSet {
    let each = each(&map.tuner, output_factor);
    let nominal = map.tuner.nominal();
    if map.tuner.settings().law != Law::Memoryless {
        let gains = of_each(&each, hull(map), One::accumulated);
        let rest = of_each(&each, map.rest, One::settled);
        let cell = GainCell { error: EVERYWHERE, change: EVERYWHERE, gains, change_gain: 0.0 };
        let [kp, ki, kd] = &each;
        let [of_kp, of_ki, of_kd] = hull(map);
        let rates = [kp.rate_per_s(of_kp), ki.rate_per_s(of_ki), kd.rate_per_s(of_kd)];
        let reached = reached(map, &each, gains);
        return GainSet {
            nominal,
            rest,
            cells: vec![cell],
            rate_per_s: Some(rates),
            reached,
            remembered: None,
        };
    }
    let rest = of_each(&each, map.rest, One::memoryless);
    let cells = map.cells.iter().map(|cell| GainCell {
        error: cell.error,
        change: cell.change,
        gains: of_each(&each, cell.delta, One::memoryless),
        change_gain: 0.0,
    });
    let mut cells: Vec<GainCell> = cells.collect();
    if map.tuner.supervisor().out_of_range() == OutOfRange::Error {
        hold(&mut cells, array(nominal).map(Interval::point));
    }
    GainSet { nominal, rest, cells, rate_per_s: None, reached: None, remembered: None }
}

/// The combinations of gains that an accumulating law reaches within bounds.
fn reached(map: &IncrementMap, each: &[One; 3], bounds: [Interval; 3]) -> Option<Reached> {
    let leakage = Interval::point(each[0].leakage_per_s);
    let target = |cell: &IncrementCell| {
        [0, 1, 2].map(|gain: usize| {
            let One { nominal, factor, .. } = each[gain];
            Interval::point(nominal) + factor * cell.delta[gain] / leakage
        })
    };
    let targets: Vec<[Interval; 3]> = map.cells.iter().map(target).collect();
    Reached::of(&Told {
        nominal: each.each_ref().map(|one| one.nominal),
        targets: &targets,
        limits: each.each_ref().map(|one| one.limits),
        share: (leakage * Interval::point(map.dt_s?)).lower(),
        bounds,
    })
}

/// A supervisor that refuses inputs leaves the gains as they were, at the first sample the nominal
/// ones: the gains of any cell may be in force beyond the range, and that lies on all sides.
fn hold(cells: &mut Vec<GainCell>, nominal: [Interval; 3]) {
    cells.push(GainCell {
        error: EVERYWHERE,
        change: EVERYWHERE,
        gains: nominal,
        change_gain: 0.0,
    });
    for cell in cells {
        (cell.error, cell.change) = (EVERYWHERE, EVERYWHERE);
    }
}
