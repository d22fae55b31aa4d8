//! Ultimate bound under persistent bounded disturbances: sensor resolution, and uncertainty of the rules in the last digit.
//!
//! With $M^T P M \prec \rho^2 P$ and $z^+ = M z + b_1 w_1 + \dots$, in the norm of P
//!
//! $$ |z^+| \le \rho |z| + \sigma, \qquad \sigma = \sum_j |b_j| W_j, \quad |w_j| \le W_j $$
//!
//! so that every motion comes, and stays, as near to $|z| \le \sigma / (1 - \rho)$ as one likes.

use core::fmt;

use fspid_lti::Matrix;
use fspid_numeric::Scalar;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::BreakPoint;

use super::{Recheck, RecheckError, malformed, points};
use crate::check::{IntervalMatrix, NotProved, reach};
use crate::gain_set::HeldGains;
use crate::remembered::Remembered;
use crate::scope::Range;

/// Motions come within so much more of what is said to remain, in finite time.
const NEARLY: f64 = 1.0 + 1e-6;
/// A claim may leave so much of the largest set-point or load that it is made for: the time in which 90 % of a
/// step are done is the coarsest that is called a response.
const OF_THE_RANGE: f64 = 0.1;
/// It may leave so many steps of the pitch sensor, where that is more. Half a step is there in the best of loops,
/// and a bound by one form is some ten times what flights show. With more it would not say where flights end.
const STEPS: f64 = 10.0;

/// What is seen, in the order of the blurs.
const SEEN: [BreakPoint; 2] = [BreakPoint::Pitch, BreakPoint::Rate];
/// Most samples that are looked at one by one, and most products that they may take.
const MOST_SAMPLES: usize = 100_000;
const MOST_PRODUCTS: usize = 100_000_000;
/// Every so many samples it is asked whether the later ones are this small a part.
const LOOKS: usize = 64;
const LATER: f64 = 0.01;

/// More may remain of every motion than a claim may leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remains {
    /// How far from rest the pitch angle may stay for all that is proved, rad.
    pub remains_rad: f64,
    /// How far it may, so that the claim says something, rad.
    pub allowed_rad: f64,
}

impl fmt::Display for Remains {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { remains_rad, allowed_rad } = self;
        write!(
            f,
            "for all that is proved the pitch angle may stay up to {:.3} deg off rest, which says nothing of a flight: allowed are {:.3} deg, the larger of a tenth of set-points and loads and ten steps of the sensor",
            remains_rad.to_degrees(),
            allowed_rad.to_degrees()
        )
    }
}

impl Recheck<'_> {
    /// True with a sensor that resolves in steps.
    pub(super) fn is_blurred(&self) -> bool {
        self.certificate.description.resolves_in_steps()
    }

    /// Whether so little remains that the claim says where flights end.
    pub(super) fn is_little(&self, remains_rad: f64) -> Result<(), Remains> {
        let Range { setpoint_rad, load_rad } = self.certificate.range;
        let resolution = self.certificate.description.pitch.resolution;
        let allowed_rad = (OF_THE_RANGE * setpoint_rad.max(load_rad)).max(STEPS * resolution);
        // Written so that NaN is too much.
        if remains_rad <= allowed_rad {
            return Ok(());
        }
        Err(Remains { remains_rad, allowed_rad })
    }

    /// Proves how far the pitch angle may stay from rest, rad.
    pub(super) fn remains(&self, form: &Matrix, rate: f64) -> Result<f64, RecheckError> {
        if let Some(remembered) = self.held.remembered {
            return self.remembered_remains(&remembered, form, rate);
        }
        if self.off_rad == 0.0 && !self.is_blurred() {
            return Ok(0.0);
        }
        if !(rate < 1.0) {
            return Err(malformed("without a rate below 1 nothing is known of what remains"));
        }
        let kept = Interval::ONE - Interval::point(rate);
        let norm = Interval::point(NEARLY * self.added(form)?) / kept;
        let level = (norm * norm).upper();
        if self.is_blurred() && !self.certificate.description.limits().is_empty() {
            let covered = self.certificate.level.is_some_and(|claimed| level <= claimed);
            if !covered {
                return Err(malformed(
                    "limits may act in what the resolution of the sensors leaves",
                ));
            }
        }
        let by_form = reach(form, level, &self.pitch_row())?;
        Ok(by_form.min(self.sample_by_sample(form, rate)?))
    }

    /// The same where gains remember a held command: what is not known of the rules to the last digit enters there.
    fn remembered_remains(
        &self,
        remembered: &Remembered,
        form: &Matrix,
        rate: f64,
    ) -> Result<f64, RecheckError> {
        if self.is_blurred() {
            return Err(malformed(
                "with a resolution gains that remember a held command are not covered",
            ));
        }
        if !(rate < 1.0) {
            return Err(malformed("without a rate below 1 nothing is known of what remains"));
        }
        let Controller::SelfTuning(fspid) = &self.certificate.description.controller else {
            return Err(malformed("fixed gains remember nothing"));
        };
        let own = Norm(IntervalMatrix::from(form));
        let [one, other] = remembered.entries(&self.model, fspid);
        let most = own.of(&one)?.hull(own.of(&other)?).upper();
        let added = Interval::point(NEARLY * most) * Interval::point(remembered.off);
        let norm = added / (Interval::ONE - Interval::point(rate));
        let mut pitch = self.pitch_row();
        pitch.resize(form.rows(), Interval::ZERO);
        Ok(reach(form, (norm * norm).upper(), &pitch)?)
    }

    fn pitch_row(&self) -> Vec<Interval> {
        let mut pitch = vec![Interval::ZERO; self.model.size()];
        pitch[0] = Interval::ONE;
        pitch
    }

    /// The same for gains that stand still, with what each sample leaves at all later ones; infinite for others.
    fn sample_by_sample(&self, form: &Matrix, rate: f64) -> Result<f64, RecheckError> {
        let Controller::Fixed(pid) = &self.certificate.description.controller else {
            return Ok(f64::INFINITY);
        };
        let gains = points(pid.gains());
        let ripple = Ripple {
            closed: self.model.closed(gains),
            norm: Norm(IntervalMatrix::from(form)),
            rate: Interval::point(rate),
            reach: Interval::point(reach(form, 1.0, &self.pitch_row())?),
        };
        let mut sum = Interval::ZERO;
        for (point, blur) in SEEN.into_iter().zip(self.certificate.description.blurs()) {
            if blur > 0.0 {
                let entry = self.model.by_seen(point, gains);
                sum = sum + ripple.of(&entry)? * Interval::point(blur);
            }
        }
        Ok((Interval::point(NEARLY) * sum).upper())
    }

    /// The most that a sample adds, in the norm of the form.
    fn added(&self, form: &Matrix) -> Result<f64, RecheckError> {
        let own = Norm(IntervalMatrix::from(form));
        let norm = |column: &[Interval]| own.of(column);
        let of_command = norm(&self.model.by_command())? * Interval::point(self.off_rad);
        if !self.is_blurred() {
            return Ok(of_command.upper());
        }
        let [of_pitch, of_rate] = self.certificate.description.blurs().map(Interval::point);
        let mut most = 0.0_f64;
        for (_, HeldGains { gains, change_gain, .. }) in self.held.held_corners() {
            let model = self.model.with_change_gain(Interval::point(change_gain));
            let at = points(gains);
            let by_pitch = norm(&model.by_seen(BreakPoint::Pitch, at))?;
            let by_rate = norm(&model.by_seen(BreakPoint::Rate, at))?;
            most = most.max((of_command + by_pitch * of_pitch + by_rate * of_rate).upper());
        }
        Ok(most)
    }
}

/// The norm of a form, from above.
struct Norm(IntervalMatrix);

impl Norm {
    fn of(&self, column: &[Interval]) -> Result<Interval, NotProved> {
        let rows: Vec<[Interval; 1]> = column.iter().map(|entry| [*entry]).collect();
        let column = IntervalMatrix::from_rows(&rows)?;
        let square = column.transpose().product(&self.0.product(&column)?)?.get(0, 0);
        let square = square.unwrap_or(Interval::ENTIRE);
        Ok(Interval::point(square.upper().max(0.0)).sqrt())
    }
}

/// A loop with gains that stand still.
struct Ripple {
    closed: Vec<Vec<Interval>>,
    norm: Norm,
    rate: Interval,
    /// The most that the pitch angle is off where the norm is 1.
    reach: Interval,
}

impl Ripple {
    /// A bound of $\sum_\ell |c M^\ell b|$, with c for the pitch angle.
    ///
    /// The states $x_\ell \approx M^\ell b$ are computed in ordinary arithmetic. What that leaves, $M x_\ell -
    /// x_{\ell + 1}$, is enclosed, and the form decreases along with it; so it does along with all later samples.
    fn of(&self, entry: &[Interval]) -> Result<Interval, NotProved> {
        let mut state: Vec<f64> = entry.iter().map(|value| value.midpoint()).collect();
        let mut off = self.norm.of(&beside(entry, &state))?;
        let mut sum = Interval::ZERO;
        let most = MOST_SAMPLES.min(MOST_PRODUCTS / (state.len() * state.len()).max(1));
        for sample in 0..most {
            let pitch = Interval::point(state.first().map_or(0.0, |value| value.abs()));
            sum = up(sum + pitch + self.reach * off);
            let next = self.after(&state);
            let computed: Vec<f64> = next.iter().map(|value| value.midpoint()).collect();
            off = up(self.rate * off + self.norm.of(&beside(&next, &computed))?);
            state = computed;
            if sample % LOOKS == 0 {
                let later = self.later(&state, off)?;
                if later.upper() <= LATER * sum.upper() {
                    return Ok(sum + later);
                }
            }
        }
        Ok(sum + self.later(&state, off)?)
    }

    /// All that is left from a state on.
    fn later(&self, state: &[f64], off: Interval) -> Result<Interval, NotProved> {
        let state: Vec<Interval> = state.iter().map(|value| Interval::point(*value)).collect();
        let size = self.norm.of(&state)? + off;
        Ok(self.reach * size / (Interval::ONE - self.rate))
    }

    fn after(&self, state: &[f64]) -> Vec<Interval> {
        let row = |row: &Vec<Interval>| {
            let terms = row.iter().zip(state);
            terms.fold(Interval::ZERO, |sum, (entry, value)| sum + *entry * Interval::point(*value))
        };
        self.closed.iter().map(row).collect()
    }
}

fn beside(enclosed: &[Interval], computed: &[f64]) -> Vec<Interval> {
    let pairs = enclosed.iter().zip(computed);
    pairs.map(|(enclosed, computed)| *enclosed - Interval::point(*computed)).collect()
}

/// The upper end alone.
fn up(value: Interval) -> Interval {
    Interval::point(value.upper())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(rows: &[[f64; 2]; 2]) -> Norm {
        Norm(IntervalMatrix::from(&Matrix::from_rows(rows).expect("square")))
    }

    fn around(values: [f64; 2], radius: f64) -> Vec<Interval> {
        values.map(|value| Interval::between(value - radius, value + radius)).to_vec()
    }

    #[test]
    fn the_norm_of_a_form_is_the_root_of_what_it_makes_of_a_column_and_never_less() {
        let norm = form(&[[4.0, 1.0], [1.0, 3.0]]);
        let found = norm.of(&around([1.0, -2.0], 0.0)).expect("bounded");
        let root = 12.0_f64.sqrt();
        assert!(found.upper() >= root && found.upper() <= root * (1.0 + 1e-12), "{found:?}");
        let wide = norm.of(&around([1.0, -2.0], 0.125)).expect("bounded").upper();
        // The largest of the corners, 1.125 and -2.125 without the product that is against it.
        assert!((3.55..=4.2).contains(&wide), "{wide}");
    }

    /// $M$, the form that falls along it by the rate, and what a sample adds.
    struct Case {
        closed: [[f64; 2]; 2],
        diagonal: [f64; 2],
        rate: f64,
        entry: [f64; 2],
    }

    /// The sum itself, in ordinary arithmetic, until nothing is left.
    fn summed(case: &Case) -> f64 {
        let (mut state, mut sum) = (case.entry, 0.0);
        for _ in 0..2_000_000 {
            sum += state[0].abs();
            state = case.closed.map(|row| row[0] * state[0] + row[1] * state[1]);
            if state.iter().all(|value| value.abs() < 1e-18) {
                break;
            }
        }
        sum
    }

    fn rippled(case: &Case, radius: f64) -> f64 {
        let [first, second] = case.diagonal;
        let norm = form(&[[first, 0.0], [0.0, second]]);
        let closed = case.closed.map(|row| around(row, radius * 1e-3)).to_vec();
        let reach = Interval::point(1.0) / Interval::point(first).sqrt();
        let ripple = Ripple { closed, norm, rate: Interval::point(case.rate), reach };
        ripple.of(&around(case.entry, radius)).expect("bounded").upper()
    }

    /// Each form falls: $\rho^2 P - M^T P M$ has a positive diagonal and determinant.
    #[test]
    fn what_a_sample_leaves_at_all_later_ones_is_bounded_within_a_hundredth() {
        let cases = [
            Case {
                closed: [[0.9, 0.1], [0.0, 0.5]],
                diagonal: [1.0, 4.0],
                rate: 0.95,
                entry: [1.0, 1.0],
            },
            Case {
                closed: [[-0.9, 0.1], [0.0, 0.5]],
                diagonal: [4.0, 4.0],
                rate: 0.95,
                entry: [1.0, -3.0],
            },
            Case {
                closed: [[0.6, 0.6], [-0.6, 0.6]],
                diagonal: [1.0, 1.0],
                rate: 0.86,
                entry: [0.0, 2.0],
            },
            Case {
                closed: [[0.999, 0.0], [0.0, 0.2]],
                diagonal: [0.25, 9.0],
                rate: 0.9992,
                entry: [0.5, 7.0],
            },
        ];
        for case in &cases {
            let (sum, found) = (summed(case), rippled(case, 0.0));
            assert!(found >= sum && found <= 1.011 * sum, "{sum} {found}");
            let wide = rippled(case, 1e-3);
            let more = Case { entry: case.entry.map(|it| it + 1e-3), ..*case };
            let less = Case { entry: case.entry.map(|it| it - 1e-3), ..*case };
            for sum in [summed(&more), summed(&less)] {
                assert!(wide >= sum, "{wide} {sum}");
            }
            let size = case.diagonal.map(f64::sqrt).into_iter().sum::<f64>();
            let most = 2e-3 * size / case.diagonal[0].sqrt() / (1.0 - case.rate);
            assert!(wide <= 1.02 * sum + most, "{wide} {sum} {most}");
        }
    }

    /// A mode that has not died out after the last sample that is looked at: the rest is what the form lets it be.
    #[test]
    fn of_a_mode_that_is_slower_than_all_samples_the_rest_is_bounded_by_its_rate() {
        let slow = 1.0 - 1e-6;
        let case = Case {
            closed: [[slow, 0.0], [0.0, 0.5]],
            diagonal: [1.0, 1.0],
            rate: slow,
            entry: [1.0, 0.0],
        };
        let found = rippled(&case, 0.0);
        assert!((1e6 * (1.0 - 1e-9)..=1.011e6).contains(&found), "{found}");
    }

    #[test]
    fn what_may_remain_is_told_in_degrees_with_what_is_allowed() {
        let told =
            Remains { remains_rad: 0.5_f64.to_radians(), allowed_rad: 0.25_f64.to_radians() };
        let told = told.to_string();
        assert!(told.contains("up to 0.500 deg off rest") && told.contains("0.250 deg"), "{told}");
    }
}
