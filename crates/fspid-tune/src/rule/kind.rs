//! The rules by name, and what each needs and gives.

use Form::{P, Pi, Pid};

/// A classical tuning rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Ziegler and Nichols, from the ultimate gain and period.
    ZieglerNichols,
    /// Tyreus and Luyben, from the ultimate gain and period.
    TyreusLuyben,
    /// Skogestad's internal model control, from a model of first or second order.
    Simc,
    /// Lambda tuning: a closed loop of a chosen time constant.
    Lambda,
    /// Åström and Hägglund's approximation of robust loop shaping.
    Amigo,
    /// Least integral of time and absolute error.
    Itae,
    /// Dominant poles where they are asked for.
    PolePlacement,
    /// Least quadratic cost with what is measured: pitch, pitch rate and the integral of the error.
    Lqr,
    /// Ultimate point from a relay's oscillation, flown with every limit.
    AutotuneRelay,
}

/// Which terms the controller has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Proportional.
    P,
    /// Proportional and integral.
    Pi,
    /// Proportional, integral and derivative.
    Pid,
}

impl Form {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::P, Self::Pi, Self::Pid];

    /// Name in options and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::P => "p",
            Self::Pi => "pi",
            Self::Pid => "pid",
        }
    }

    /// The form with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.name() == name)
    }
}

/// What is said of a rule.
struct Facts {
    name: &'static str,
    about: &'static str,
    source: &'static str,
    /// The first is the default.
    forms: &'static [Form],
}

impl Rule {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::ZieglerNichols,
        Self::TyreusLuyben,
        Self::Simc,
        Self::Lambda,
        Self::Amigo,
        Self::Itae,
        Self::PolePlacement,
        Self::Lqr,
        Self::AutotuneRelay,
    ];

    /// Names in options and answers, in the order of [`ALL`](Self::ALL).
    pub const NAMES: [&'static str; 9] = [
        "ziegler-nichols",
        "tyreus-luyben",
        "simc",
        "lambda",
        "amigo",
        "itae",
        "pole-placement",
        "lqr",
        "autotune-relay",
    ];

    /// Name in options and answers.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.facts().name
    }

    /// The rule with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|rule| rule.name() == name)
    }

    /// What it needs and when it fits, in one line.
    #[must_use]
    pub fn about(self) -> &'static str {
        self.facts().about
    }

    /// Who published it, when and where.
    #[must_use]
    pub fn source(self) -> &'static str {
        self.facts().source
    }

    /// The forms that it is published for; the first is taken if none is asked for.
    #[must_use]
    pub fn forms(self) -> &'static [Form] {
        self.facts().forms
    }

    fn facts(self) -> Facts {
        let [zn, tl, simc, lambda, amigo, itae, place, lqr, relay] = Self::NAMES;
        let (name, about, source, forms): (_, _, _, &'static [Form]) = match self {
            Self::ZieglerNichols => (
                zn,
                "ultimate gain and period; fast and oscillatory, aims at a decay of 1 to 4 per period",
                "J. G. Ziegler and N. B. Nichols, Optimum settings for automatic controllers, Trans. ASME 64 (1942) 759",
                &[Pid, Pi, P],
            ),
            Self::TyreusLuyben => (
                tl,
                "ultimate gain and period; calmer than ziegler-nichols, made for integrating processes",
                "B. D. Tyreus and W. L. Luyben, Tuning PI controllers for integrator/dead time processes, Ind. Eng. Chem. Res. 31 (1992) 2625; PID: W. L. Luyben, Ind. Eng. Chem. Res. 35 (1996) 3480",
                &[Pid, Pi],
            ),
            Self::Simc => (
                simc,
                "a model of first (pi) or second order (pid) with dead time; smooth, one knob tau_c",
                "S. Skogestad, Simple analytic rules for model reduction and PID controller tuning, J. Process Control 13 (2003) 291",
                &[Pid, Pi],
            ),
            Self::Lambda => (
                lambda,
                "a model of first order with dead time; as slow as its one knob lambda says",
                "E. B. Dahlin, Instruments and Control Systems 41 (1968) 77; D. E. Rivera, M. Morari and S. Skogestad, Internal model control: PID controller design, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 252; integrating: I-L. Chien and P. S. Fruehauf, Chem. Eng. Prog. 86 (1990) 33",
                &[Pi, Pid],
            ),
            Self::Amigo => (
                amigo,
                "a model of first order with dead time; fitted to robust loops (Ms = Mt = 1.4) of monotone processes",
                "K. J. Åström and T. Hägglund, Revisiting the Ziegler-Nichols step response method for PID control, J. Process Control 14 (2004) 635",
                &[Pid, Pi],
            ),
            Self::Itae => (
                itae,
                "a model; lag: formulas for set-points, 0.1 <= L/T <= 1; integrating: the ITAE polynomial without dead time",
                "lag: A. A. Rovira, P. W. Murrill and C. L. Smith, Instruments and Control Systems 42 (1969) 67; integrating: D. Graham and R. C. Lathrop, The synthesis of optimum transient response, Trans. AIEE 72 (1953) 273",
                &[Pid, Pi],
            ),
            Self::PolePlacement => (
                place,
                "the exact sampled loop; puts two (pi) or three (pid) poles where they are asked for, the others fall where they fall",
                "P. Persson and K. J. Åström, Dominant pole design: a unified view of PID controller tuning, IFAC Symp. Adaptive Systems in Control and Signal Processing (1992) 377",
                &[Pid, Pi],
            ),
            Self::Lqr => (
                lqr,
                "the exact sampled loop; least quadratic cost of pi gains with a rate loop, as no other states are measured",
                "W. S. Levine and M. Athans, On the determination of the optimal constant output feedback gains, IEEE Trans. Automatic Control 15 (1970) 44; for aircraft: B. L. Stevens and F. L. Lewis, Aircraft Control and Simulation, chapter 5",
                &[Pi],
            ),
            Self::AutotuneRelay => (
                relay,
                "no model: a relay makes the flown loop oscillate, its period and amplitude give the ultimate point",
                "K. J. Åström and T. Hägglund, Automatic tuning of simple regulators with specifications on phase and amplitude margins, Automatica 20 (1984) 645",
                &[Pid, Pi, P],
            ),
        };
        Facts { name, about, source, forms }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_is_found_by_its_name() {
        for (rule, name) in Rule::ALL.into_iter().zip(Rule::NAMES) {
            assert_eq!((rule.name(), Rule::from_name(name)), (name, Some(rule)));
            assert!(!rule.forms().is_empty());
        }
        assert_eq!(Rule::from_name("Ziegler"), None);
        assert_eq!(Form::from_name("pi"), Some(Form::Pi));
    }
}
