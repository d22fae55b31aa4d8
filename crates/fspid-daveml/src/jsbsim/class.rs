//! What a formula depends on, so that loads are proportional to the dynamic pressure and linear in the rate of the angle
//! of attack.

/// What a formula depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Class {
    /// True where it is the dynamic pressure times something that it does not stand in.
    pub(super) pressure: bool,
    /// How it depends on the rate of the angle of attack.
    pub(super) rate: Share,
    /// True where a surface may stand in it.
    pub(super) control: bool,
}

/// How a formula depends on the rate of the angle of attack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Share {
    /// Not at all.
    #[default]
    None,
    /// Proportional to it.
    Proportional,
    /// A part proportional to it, and another one.
    Linear,
}

/// Why formulas cannot be put together, and what can.
pub(super) type Refusal = (&'static str, &'static str);

const PRESSURE_EXPECTED: &str = "loads proportional to aero/qbar-psf";
const RATE_EXPECTED: &str =
    "loads linear in aero/alphadot-rad_sec, and no surface as a factor of it";

impl Class {
    /// Class of a product.
    pub(super) fn product(factors: &[Self]) -> Result<Self, Refusal> {
        if factors.iter().filter(|factor| factor.pressure).count() > 1 {
            return Err(("the dynamic pressure is a factor twice", PRESSURE_EXPECTED));
        }
        let rates: Vec<_> = factors.iter().filter(|factor| factor.rate != Share::None).collect();
        let steered = |except: Option<&Self>| {
            let mut others =
                factors.iter().filter(|it| except.is_none_or(|rate| !core::ptr::eq(*it, rate)));
            others.any(|it| it.control)
        };
        match rates.as_slice() {
            [] => {}
            [rate] if !steered(Some(rate)) => {}
            _ => {
                return Err((
                    "the rate of the angle of attack is a factor of itself or of a surface",
                    RATE_EXPECTED,
                ));
            }
        }
        Ok(Self {
            pressure: factors.iter().any(|factor| factor.pressure),
            rate: rates.first().map_or(Share::None, |factor| factor.rate),
            control: steered(None),
        })
    }

    /// Class of a sum or difference.
    pub(super) fn sum(terms: &[Self]) -> Result<Self, Refusal> {
        let pressure = terms.first().is_some_and(|term| term.pressure);
        if terms.iter().any(|term| term.pressure != pressure) {
            let message = "the dynamic pressure is a factor of one term and not of another";
            return Err((message, PRESSURE_EXPECTED));
        }
        let rate = terms.first().map_or(Share::None, |term| term.rate);
        let same = terms.iter().all(|term| term.rate == rate);
        Ok(Self {
            pressure,
            rate: if same { rate } else { Share::Linear },
            control: terms.iter().any(|term| term.control),
        })
    }

    /// Class of a function of operands, in which neither pressure nor rate may stand.
    pub(super) fn function(operands: &[Self]) -> Result<Self, Refusal> {
        if operands.iter().any(|it| it.pressure) {
            return Err((
                "the dynamic pressure stands inside of a function or table",
                PRESSURE_EXPECTED,
            ));
        }
        if operands.iter().any(|it| it.rate != Share::None) {
            let message = "the rate of the angle of attack stands inside of a function or table";
            return Err((message, RATE_EXPECTED));
        }
        Ok(Self { control: operands.iter().any(|it| it.control), ..Self::default() })
    }

    /// Class of a quotient.
    pub(super) fn quotient(top: Self, bottom: Self) -> Result<Self, Refusal> {
        Self::product(&[top, Self::function(&[bottom])?])
    }
}
