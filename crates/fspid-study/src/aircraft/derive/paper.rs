//! What the paper prints, and what comes out.

use fspid_aircraft::AircraftError;
use fspid_aircraft::data::DerivativeData;
use fspid_aircraft::derivation::{DerivationCondition, DimensionalDerivatives};
use fspid_lti::TransferFunction;
use serde_json::{Value, json};

use super::super::table::{paragraph, table};
use fspid_scenario::aircraft::number::{short, significant};
use fspid_scenario::units::{FOOT_M, POUND_FORCE_N};

/// A printed coefficient: where it stands, its value, and half of its last digit.
type Printed = (&'static str, f64, f64);

/// The short-period model; the sign of the elevator is turned in print.
const SHORT_PERIOD: [Printed; 4] = [
    ("above the line, s", 11.7304, 5e-5),
    ("above the line, 1", 22.578, 5e-4),
    ("below the line, s²", 4.9676, 5e-5),
    ("below the line, s", 12.941, 5e-4),
];

/// The full model.
const FULL: [Printed; 7] = [
    ("above the line, s²", -1.69144, 5e-6),
    ("above the line, s", -0.84341, 5e-6),
    ("above the line, 1", -0.009_909_6, 5e-8),
    ("below the line, s³", 1.17103, 5e-6),
    ("below the line, s²", 1.55405, 5e-6),
    ("below the line, s", 0.012538, 5e-7),
    ("below the line, 1", 0.007_277_1, 5e-8),
];

/// The constants with which the full model comes out, ft/s² and psf; no source has them.
const ODD_GRAVITY_FT_S2: f64 = 32.37072;
const ODD_PRESSURE_PSF: f64 = 287.4994;

/// Nelson's derivatives as rounded in his book, in feet; the airspeed belongs to them.
const ROUNDED_NAVION: DimensionalDerivatives = DimensionalDerivatives {
    x_u: -0.045,
    x_w: 0.036,
    x_elevator: 0.0,
    z_u: -0.369,
    z_w: -2.02,
    z_w_rate: 0.0,
    z_q: 0.0,
    z_elevator: -28.15,
    m_u: 0.0,
    m_w: -0.05,
    m_w_rate: -0.0051,
    m_q: -2.05,
    m_elevator: -11.874,
};
const NAVION_FT_S: f64 = 176.0;

/// Printed coefficients beside derived ones.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Comparison {
    model: &'static str,
    how: String,
    rows: Vec<ComparedNumber>,
}

#[derive(Clone, Debug, PartialEq)]
struct ComparedNumber {
    place: &'static str,
    printed: f64,
    half_digit: f64,
    derived: f64,
    /// With what the source itself says.
    plain: f64,
}

impl ComparedNumber {
    /// Distance from the printed number in units of half its last digit: up to 1 it is that number.
    fn off(&self) -> f64 {
        (self.derived - self.printed).abs() / self.half_digit
    }
}

/// The comparison for the aircraft that the paper has, by the name under which the program carries it.
pub(super) fn comparison(
    name: &str,
    data: &DerivativeData,
) -> Result<Option<Comparison>, AircraftError> {
    match name {
        "navion" => navion(data).map(Some),
        "b747-cruise-low" => b747(data).map(Some),
        _ => Ok(None),
    }
}

fn navion(data: &DerivativeData) -> Result<Comparison, AircraftError> {
    let condition = DerivationCondition::of(data);
    let plain = DimensionalDerivatives::of(&data.longitudinal, &condition);
    let plain = plain.short_period(condition.airspeed_m_s)?.negated();
    let derived = ROUNDED_NAVION.short_period(NAVION_FT_S)?.negated();
    Ok(Comparison {
        model: "short-period model",
        how: "Derived from the derivatives as Nelson rounds them (u0 176 ft/s, Zw -2.02, Mw -0.05, Mw' -0.0051, \
              Mq -2.05, Zde -28.15 ft/s², Mde -11.874 1/s²), with the sign of the elevator turned as in print. \
              The paper introduces it as the 747; it is this aircraft."
            .to_owned(),
        rows: rows(&SHORT_PERIOD, &derived, &plain),
    })
}

fn b747(data: &DerivativeData) -> Result<Comparison, AircraftError> {
    let plain = DerivationCondition::of(data);
    let gravity_m_s2 = ODD_GRAVITY_FT_S2 * FOOT_M;
    let odd = DerivationCondition {
        gravity_m_s2,
        dynamic_pressure_pa: ODD_PRESSURE_PSF * POUND_FORCE_N / (FOOT_M * FOOT_M),
        mass_kg: data.weight_n / gravity_m_s2,
        ..plain
    };
    let plant = |condition: &DerivationCondition| {
        DimensionalDerivatives::of(&data.longitudinal, condition)
            .theta_over_elevator(condition.airspeed_m_s, condition.gravity_m_s2)
    };
    Ok(Comparison {
        model: "full model",
        how: format!(
            "Derived with two odd constants, gravity {ODD_GRAVITY_FT_S2} ft/s² and dynamic pressure {ODD_PRESSURE_PSF} psf, \
             in place of the source's 32.2 and 287.2: no source has them; they were found by fitting the printed digits, \
             and without them up to several hundred half digits are left over. The paper calls the aircraft a 747-400; \
             the data are the 747-200's."
        ),
        rows: rows(&FULL, &plant(&odd)?, &plant(&plain)?),
    })
}

fn rows(
    printed: &[Printed],
    derived: &TransferFunction,
    plain: &TransferFunction,
) -> Vec<ComparedNumber> {
    let coefficients = |plant: &TransferFunction| -> Vec<f64> {
        let below = plant.denominator().coefficients().iter().skip(1);
        plant.numerator().coefficients().iter().chain(below).copied().collect()
    };
    let found = coefficients(derived).into_iter().zip(coefficients(plain));
    let row = |(&(place, printed, half_digit), (derived, plain)): (&Printed, (f64, f64))| {
        ComparedNumber { place, printed, half_digit, derived, plain }
    };
    printed.iter().zip(found).map(row).collect()
}

impl Comparison {
    fn worst(&self) -> f64 {
        self.rows.iter().map(ComparedNumber::off).fold(0.0, f64::max)
    }

    fn verdict(&self) -> String {
        // A printed number may be the rounding of one that lies just on the edge.
        match self.worst() <= 1.0001 {
            true => "every printed digit comes out".to_owned(),
            false => format!("within {:.1} units of half the last printed digit", self.worst()),
        }
    }

    pub(super) fn text(&self) -> String {
        let cells = |row: &ComparedNumber| {
            let [derived, plain] = [row.derived, row.plain].map(|x| significant(x, 8));
            let (printed, off) = (short(row.printed, 8), format!("{:.2}", row.off()));
            vec![row.place.to_owned(), printed, derived, off, plain]
        };
        let rows: Vec<Vec<String>> = self.rows.iter().map(cells).collect();
        let headings = ["coefficient", "printed", "derived", "off, half digits", "by the source"];
        let (model, verdict) = (self.model, self.verdict());
        format!(
            "\nthe paper's {model}: {verdict}\n{}\n{}",
            table(&headings, &rows),
            paragraph(&self.how)
        )
    }

    pub(super) fn json(&self) -> Value {
        let row = |row: &ComparedNumber| {
            json!({
                "coefficient": row.place, "printed": row.printed, "derived": row.derived,
                "off_half_digits": row.off(), "by_the_source": row.plain,
            })
        };
        json!({
            "model": self.model,
            "verdict": self.verdict(),
            "worst_half_digits": self.worst(),
            "how": self.how,
            "coefficients": self.rows.iter().map(row).collect::<Vec<_>>(),
        })
    }
}
