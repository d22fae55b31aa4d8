//! How far a reference model is from its set-point, from any sample on.

use fspid_core::equations::TunerEquations;
use fspid_core::{ModelState, ReferenceModel};
use fspid_numeric::scalar::Interval;

/// Most samples after which the reference model is asked to have come nearer.
const MOST_POWERS: usize = 100_000;
/// For the rounding of what is compared.
const ROUNDED_UP: f64 = 1.0 + 1e-9;

/// $y^+ = y + T q^+$, $q^+ = q + T (\omega^2 (r - y) - 2 \zeta \omega q)$ as rows over (y, q), the set-point at zero.
pub(crate) fn model_matrix(equations: &TunerEquations<f64>) -> [[Interval; 2]; 2] {
    let row = |pitch: f64, rate: f64| {
        let model = ReferenceModel {
            bandwidth_rad_s: Interval::point(equations.numbers.bandwidth_rad_s),
            damping: Interval::point(equations.numbers.damping),
        };
        let now =
            ModelState { pitch_rad: Interval::point(pitch), rate_rad_s: Interval::point(rate) };
        model.next(now, Interval::ZERO, Interval::point(equations.numbers.dt_s))
    };
    let [by_pitch, by_rate] = [row(1.0, 0.0), row(0.0, 1.0)];
    [[by_pitch.pitch_rad, by_rate.pitch_rad], [by_pitch.rate_rad_s, by_rate.rate_rad_s]]
}

/// Its matrix over pitch and rate, the rate in units of its bandwidth.
fn scaled(equations: &TunerEquations<f64>) -> [[Interval; 2]; 2] {
    let omega = Interval::point(equations.numbers.bandwidth_rad_s);
    let [[a, b], [c, d]] = model_matrix(equations);
    [[a, b * omega], [c / omega, d]]
}

fn product(one: &[[Interval; 2]; 2], other: &[[Interval; 2]; 2]) -> [[Interval; 2]; 2] {
    let entry =
        |row: usize, column: usize| one[row][0] * other[0][column] + one[row][1] * other[1][column];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

/// Most of the pitch of a model that begins with pitch and rate (in units of its bandwidth) within 1: the largest sum of the
/// first rows of the powers of its matrix, up to one whose rows both have a sum of at most 1 and that begins it again.
pub(crate) fn most_later(equations: &TunerEquations<f64>) -> Option<f64> {
    let step = scaled(equations);
    let size = |row: [Interval; 2]| row[0].magnitude() + row[1].magnitude();
    let (mut power, mut most) = (step, 1.0_f64);
    for _ in 0..MOST_POWERS {
        most = most.max(size(power[0]));
        if size(power[0]) < 0.999 && size(power[1]) < 0.999 {
            return Some(most * ROUNDED_UP);
        }
        power = product(&power, &step);
    }
    None
}

/// Most of the pitch of a model that begins at rest with a pitch of 1: the largest in the first column's first row of the
/// powers, up to one from which [`most_later`] leads no further.
pub(crate) fn most_from_rest(equations: &TunerEquations<f64>) -> Option<f64> {
    let (step, later) = (scaled(equations), most_later(equations)?);
    let (mut power, mut most) = (step, 1.0_f64);
    for _ in 0..MOST_POWERS {
        let [[pitch, _], [rate, _]] = power;
        most = most.max(pitch.magnitude());
        if pitch.magnitude().max(rate.magnitude()) * later * ROUNDED_UP < most {
            return Some(most * ROUNDED_UP);
        }
        power = product(&power, &step);
    }
    None
}

#[cfg(test)]
mod tests {
    use fspid_core::{Gains, SecondInput, TunerSettings};

    use super::*;

    #[test]
    fn no_model_goes_further_than_is_said_and_from_rest_none_goes_back_over_where_it_began() {
        for (bandwidth_rad_s, damping, dt_s) in
            [(0.8, 0.05, 0.02), (2.4, 0.58, 0.01), (1.0, 1.5, 0.1), (6.0, 0.7, 0.08)]
        {
            let model = ReferenceModel { bandwidth_rad_s, damping };
            let settings = TunerSettings {
                second_input: SecondInput::ModelError(model),
                ..TunerSettings::literal()
            };
            let nominal = Gains { kp: 1.0, ki: 1.0, kd: 1.0 };
            let equations = TunerEquations::new(&settings, nominal, dt_s);
            let later = most_later(&equations).expect("stable");
            let from_rest = most_from_rest(&equations).expect("stable");
            assert!(from_rest >= 1.0 && from_rest <= later && later < 3.0, "{from_rest} {later}");
            let mut most = [0.0_f64; 2];
            for rate in [0.0, -1.0, 1.0] {
                let mut now = ModelState { pitch_rad: 1.0, rate_rad_s: rate * bandwidth_rad_s };
                for _ in 0..5000 {
                    let which = usize::from(rate.abs() > 0.5);
                    most[which] = most[which].max(now.pitch_rad.abs());
                    now = model.next(now, 0.0, dt_s);
                }
            }
            assert!(most[0] <= from_rest && most[1] <= later, "{most:?} {from_rest} {later}");
            // And it is hardly more than that.
            assert!(from_rest < 1.02 * most[0] && later < 1.3 * most[1], "{most:?} {later}");
        }
    }
}
