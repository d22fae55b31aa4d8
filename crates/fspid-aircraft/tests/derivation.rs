//! From stability derivatives to the polynomials of the paper, digit by digit.

use fspid_aircraft::derivation::{DerivationCondition, DimensionalDerivatives};
use fspid_lti::{Mode, TransferFunction};

use crate::support;

use support::{FOOT_M, POUND_FORCE_N, derivative_data};

fn coefficients(plant: &TransferFunction) -> Vec<f64> {
    let (above, below) = (plant.numerator().coefficients(), plant.denominator().coefficients());
    above.iter().chain(&below[1..]).copied().collect()
}

fn assert_digits(plant: &TransferFunction, printed: &[f64], half_digits: &[f64]) {
    let found = coefficients(plant);
    assert_eq!(found.len(), printed.len());
    for ((found, printed), half_digit) in found.iter().zip(printed).zip(half_digits) {
        assert!((found - printed).abs() <= 1.0001 * half_digit, "{found} is not {printed}");
    }
}

/// Nelson's rounded derivatives in feet; the equations do not mind.
fn rounded_navion() -> DimensionalDerivatives {
    DimensionalDerivatives {
        x_u: -0.045,
        x_w: 0.036,
        z_u: -0.369,
        z_w: -2.02,
        z_elevator: -28.15,
        m_w: -0.05,
        m_w_rate: -0.0051,
        m_q: -2.05,
        m_elevator: -11.874,
        ..DimensionalDerivatives::default()
    }
}

#[test]
fn the_papers_short_period_is_the_navion_to_every_printed_digit() {
    let plant = rounded_navion().short_period(176.0).expect("a plant");
    // The paper turns the sign of the elevator. θ/δe has one pole more than q/δe.
    assert_digits(
        &plant.negated(),
        &[11.7304, 22.578, 4.9676, 12.941, 0.0],
        &[5e-5, 5e-4, 5e-12, 5e-12, 0.0],
    );
    let exact = [-11.730435, -22.57798, 4.9676, 12.941, 0.0];
    assert_digits(&plant, &exact, &[5e-10, 5e-10, 5e-12, 5e-12, 0.0]);
    let mode = Mode::of_pole(plant.poles().expect("roots")[0]).expect("a mode");
    assert!((mode.natural_frequency_rad_s - 3.5974).abs() < 5e-5);
    assert!((mode.damping_ratio - 0.6905).abs() < 5e-5);
    assert!((plant.zeros().expect("roots")[0].re + 1.9247).abs() < 5e-5);
}

#[test]
fn the_full_navion_has_the_printed_polynomials_poles_and_zeros() {
    let plant = rounded_navion().theta_over_elevator(176.0, 32.2).expect("a plant");
    let printed = [-11.730435, -23.10585, -1.173743, 5.0126, 13.177826, 0.670174, 0.59409];
    assert_digits(&plant, &printed, &[5e-7, 5e-6, 5e-7, 5e-7, 5e-7, 5e-7, 5e-7]);
    let poles = plant.poles().expect("roots");
    let printed = [
        (-2.489251, -2.601127),
        (-2.489251, 2.601127),
        (-0.017049, -0.213405),
        (-0.017049, 0.213405),
    ];
    for (pole, (re, im)) in poles.iter().zip(printed) {
        assert!((pole.re - re).abs() < 5.01e-7 && (pole.im - im).abs() < 5.01e-7, "{pole}");
    }
    let zeros = plant.zeros().expect("roots");
    assert!((zeros[0].re + 1.917554).abs() < 5.01e-7 && (zeros[1].re + 0.052181).abs() < 5.01e-7);
}

/// 1.3: Z_w -2.0243, M_w -0.04997, M_wd -0.005165, M_q -2.0767, Z_de -28.169, M_de -11.884 in feet.
#[test]
fn raw_coefficients_give_the_navions_derivatives() {
    let data = derivative_data("navion");
    let found = DimensionalDerivatives::of(&data.longitudinal, &DerivationCondition::of(&data));
    let rows = [
        (found.z_w, -2.0243, 5e-5),
        (found.m_w * FOOT_M, -0.04997, 5e-6),
        (found.m_w_rate * FOOT_M, -0.005165, 5e-7),
        (found.m_q, -2.0767, 5e-5),
        (found.z_elevator / FOOT_M, -28.169, 5e-4),
        (found.m_elevator, -11.884, 5e-4),
    ];
    for (found, printed, half_digit) in rows {
        assert!((found - printed).abs() <= 1.0001 * half_digit, "{found} is not {printed}");
    }
}

/// The 747 of the file, with gravity in ft/s² and dynamic pressure in psf.
fn b747(gravity_ft_s2: f64, pressure_psf: f64) -> (DimensionalDerivatives, DerivationCondition) {
    let mut data = derivative_data("b747-cruise-low");
    data.reference.gravity_m_s2 = gravity_ft_s2 * FOOT_M;
    data.reference.dynamic_pressure_pa = pressure_psf * POUND_FORCE_N / (FOOT_M * FOOT_M);
    let condition = DerivationCondition::of(&data);
    (DimensionalDerivatives::of(&data.longitudinal, &condition), condition)
}

fn full(derivatives: DimensionalDerivatives, condition: &DerivationCondition) -> TransferFunction {
    derivatives
        .theta_over_elevator(condition.airspeed_m_s, condition.gravity_m_s2)
        .expect("a plant")
}

const HALF_DIGITS: [f64; 7] = [5e-7; 7];

#[test]
fn the_papers_full_model_is_the_747_of_roskam_with_two_odd_constants() {
    let (derivatives, condition) = b747(32.37072, 287.4994);
    let plant = full(derivatives, &condition);
    let paper = [-1.69144, -0.84341, -0.0099096, 1.17103, 1.55405, 0.012538, 0.0072771];
    let half_digits = [5e-6, 5e-6, 5e-8, 5e-6, 5e-6, 5e-7, 5e-8].map(|half| 1.5 * half);
    assert_digits(&plant, &paper, &half_digits);
    let computed = [-1.6914439, -0.8434051, -0.0099096, 1.1710281, 1.5540490, 0.0125387, 0.0072771];
    // The handbook rounds g and Q after having fitted them.
    assert_digits(&plant, &computed, &[1e-7, 1e-7, 1e-7, 1e-7, 1e-7, 1e-7, 1e-7]);
}

#[test]
fn the_747_with_plain_constants_has_the_nominal_rows() {
    let (nominal, condition) = b747(32.2, 287.2);
    let printed = [-1.689707, -0.837298, -0.009776, 1.167111, 1.550850, 0.012426, 0.007186];
    assert_digits(&full(nominal, &condition), &printed, &HALF_DIGITS);
    let simplified = [-1.689641, -0.851223, -0.009941, 1.179222, 1.597643, 0.012751, 0.007308];
    // The last coefficient is 0.00730748; the handbook's rounding is off by 5 % of half a digit.
    let half_digits = HALF_DIGITS.map(|half| 1.06 * half);
    assert_digits(&full(nominal.simplified(), &condition), &simplified, &half_digits);
    let data = derivative_data("b747-cruise-low");
    let constant = DimensionalDerivatives::with_constant_thrust(&data.longitudinal, &condition);
    let printed = [-1.689707, -0.836295, -0.009285, 1.166517, 1.550161, 0.011512, 0.007186];
    assert_digits(&full(constant, &condition), &printed, &HALF_DIGITS);
}

#[test]
fn the_papers_printed_sign_of_mw_makes_an_unstable_aircraft() {
    let (nominal, condition) = b747(32.2, 287.2);
    let literal = DimensionalDerivatives { m_w: -nominal.m_w, ..nominal.simplified() };
    let plant = full(literal, &condition);
    let printed = [-1.689641, -0.950206, -0.010587, 1.179222, -1.007981, -0.004262, -0.006456];
    assert_digits(&plant, &printed, &HALF_DIGITS);
    let poles = plant.poles().expect("roots");
    assert!(poles.iter().any(|pole| (pole.re - 0.586).abs() < 1e-3), "{poles:?}");
    let literal = DimensionalDerivatives { m_w: 0.05, ..rounded_navion() };
    let navion = literal.theta_over_elevator(176.0, 32.2).expect("a plant");
    assert!(navion.poles().expect("roots").iter().any(|pole| (pole.re - 0.896).abs() < 1e-3));
}

#[test]
fn the_747s_dimensional_derivatives_are_those_of_the_handbook() {
    let (found, _) = b747(32.2, 287.2);
    let rows = [
        (found.x_u, -0.006529, 5e-7),
        (found.x_w, 0.023743, 5e-7),
        (found.z_u, -0.110403, 5e-7),
        (found.z_w, -0.525303, 5e-7),
        (found.z_w_rate, -0.016854, 5e-7),
        (found.z_q / FOOT_M, -10.6948, 5e-5),
        (found.z_elevator / FOOT_M, -25.5659, 5e-5),
        (found.m_u * FOOT_M, 2.5166e-5, 5e-10),
        (found.m_w * FOOT_M, -0.001_935_83, 5e-9),
        (found.m_w_rate * FOOT_M, -0.000_157_052, 5e-10),
        (found.m_q, -0.541693, 5e-7),
        (found.m_elevator, -1.693656, 5e-7),
    ];
    for (found, printed, half_digit) in rows {
        assert!((found - printed).abs() <= 1.0001 * half_digit, "{found} is not {printed}");
    }
}

#[test]
fn the_747s_own_short_period_is_that_of_the_shipped_plant() {
    let (nominal, condition) = b747(32.2, 287.2);
    let plant = nominal.short_period(condition.airspeed_m_s).expect("a plant");
    let printed = [-1.689707, -0.826265, 1.160582, 1.540694, 0.0];
    assert_digits(&plant, &printed, &[5e-7, 5e-7, 5e-7, 5e-7, 0.0]);
}

#[test]
fn the_other_conditions_of_the_747_have_the_denominators_of_the_handbook() {
    let denominators = [
        ("b747-approach", [0.950389, 0.622132, 0.035168, 0.01726], [5e-7, 5e-7, 5e-7, 5e-6]),
        ("b747-cruise-high", [1.018293, 1.824727, 0.142528, 0.0021], [5e-7, 5e-7, 5e-7, 5e-5]),
    ];
    for (name, printed, half_digits) in denominators {
        let data = derivative_data(name);
        let condition = DerivationCondition::of(&data);
        let plant = full(DimensionalDerivatives::of(&data.longitudinal, &condition), &condition);
        let found = &plant.denominator().coefficients()[1..];
        for ((found, printed), half_digit) in found.iter().zip(printed).zip(half_digits) {
            assert!(
                (found - printed).abs() <= 1.0001 * half_digit,
                "{name}: {found} is not {printed}"
            );
        }
    }
}

#[test]
fn the_cessna_has_the_polynomials_of_the_handbook() {
    let data = derivative_data("cessna-172");
    let condition = DerivationCondition::of(&data);
    let plant = full(DimensionalDerivatives::of(&data.longitudinal, &condition), &condition);
    let printed = [-34.392, -70.721, -4.2012, 8.9078, 27.962, 1.4733, 0.81049];
    assert_digits(&plant, &printed, &[5e-4, 5e-4, 5e-5, 5e-5, 5e-4, 5e-5, 5e-6]);
}
