//! Set-points and disturbances.

use crate::keyed::word::{words, words_of};
use crate::keyed::{
    BOOLEAN, Key, KindOf, Range, Table, Variant, defaulted, not_negative, number, numbers,
    of_kinds, plain, positive, required, variant, whole, word,
};
use fspid_sim::signal::{Entry, Interpolation};

/// Highest frequency, Hz; far above what any sample period can show.
const FREQUENCY: KindOf<f64> = number("Hz", Range::PositiveUpTo(1e6));

/// Largest set-point and load, in degrees: a hundredth of where a flight has diverged, so that a loop that does what it is told
/// is not taken for one that runs away.
const SIGNAL_LIMIT_DEG: f64 = super::ANGLE_LIMIT_DEG / 100.0;
const SIGNAL: Range = Range::Between(-SIGNAL_LIMIT_DEG, SIGNAL_LIMIT_DEG);

pub(crate) const AMPLITUDE: Key<f64> =
    required("amplitude_deg", number("deg", SIGNAL), "Size; negative for the other way.");
pub(crate) const AT: Key<f64> = defaulted("at_s", not_negative("s"), 0.0, "Start.");

words! {
    /// How a set-point or a disturbance goes; each table has some of them.
    SignalKind {
        Step = "step",
        Square = "square",
        Doublet = "doublet",
        Pulse = "pulse",
        Ramp = "ramp",
        Sine = "sine",
        Noise = "noise",
        Table = "table",
    }
}

words_of!(Interpolation { Hold = "hold", Linear = "linear" });
words_of!(Entry { Servo = "servo", Elevator = "elevator", Measurement = "measurement" });

/// Rows that a set-point table may have.
const MOST_ROWS: usize = 1_000_000;

pub(crate) const RAMP_WIDTH_S: Key<f64> = required("width_s", positive("s"), "Length of the rise.");

/// A ramp, of the command and of a disturbance alike.
const RAMP: Variant = variant(
    SignalKind::Ramp.name(),
    plain(
        "In a straight line from 0 to the amplitude, where it stays.",
        &[&[&AMPLITUDE, &AT, &RAMP_WIDTH_S]],
    ),
);

pub(crate) const FREQUENCY_HZ: Key<f64> = required("frequency_hz", FREQUENCY, "Frequency.");

/// A sine, of the command and of a disturbance alike.
const SINE: Variant = variant(
    SignalKind::Sine.name(),
    plain("A sine wave from the start on.", &[&[&AMPLITUDE, &AT, &FREQUENCY_HZ]]),
);

pub(crate) const HALF_PERIOD_S: Key<f64> =
    required("half_period_s", positive("s"), "Length of each half.");
pub(crate) const BIPOLAR: Key<bool> =
    defaulted("bipolar", BOOLEAN, false, "Swings to minus the amplitude and not to 0.");
pub(crate) const DOUBLET_WIDTH_S: Key<f64> =
    required("width_s", positive("s"), "Length of each half.");
pub(crate) const TIME_S: Key<[f64]> = required(
    "time_s",
    numbers("s", Range::NotNegative, (1, MOST_ROWS)),
    "Times, each after the one before.",
);
pub(crate) const VALUE_DEG: Key<[f64]> =
    required("value_deg", numbers("deg", SIGNAL, (1, MOST_ROWS)), "Values, as many as times.");
pub(crate) const INTERPOLATION: Key<Interpolation> = defaulted(
    "interpolation",
    word(),
    Interpolation::Hold,
    "The last value holds, or a straight line to the next.",
);

pub(super) static SETPOINT_TABLE: Table = of_kinds(
    "The commanded pitch angle over time.",
    &[],
    &[
        variant(
            SignalKind::Step.name(),
            plain("The amplitude from the start on.", &[&[&AMPLITUDE, &AT]]),
        ),
        variant(
            SignalKind::Square.name(),
            plain(
                "The amplitude for a half period, then minus the amplitude (bipolar) or 0 for one, and so on.",
                &[&[&AMPLITUDE, &AT, &HALF_PERIOD_S, &BIPOLAR]],
            ),
        ),
        variant(
            SignalKind::Doublet.name(),
            plain(
                "The amplitude, then minus the amplitude, then 0.",
                &[&[&AMPLITUDE, &AT, &DOUBLET_WIDTH_S]],
            ),
        ),
        RAMP,
        SINE,
        variant(
            SignalKind::Table.name(),
            plain(
                "Rows of time and value; 0 before the first, the last value after the last.",
                &[&[&TIME_S, &VALUE_DEG, &INTERPOLATION]],
            ),
        ),
    ],
);

pub(crate) const ENTERS_AT: Key<Entry> = required(
    "enters_at",
    word(),
    "Added to the servo's command, to the elevator behind the servo (both nose up positive), or to the measured pitch.",
);
pub(crate) const PULSE_WIDTH_S: Key<f64> = required("width_s", positive("s"), "Length.");
pub(crate) const STANDARD_DEVIATION_DEG: Key<f64> = required(
    "standard_deviation_deg",
    number("deg", Range::UpTo(SIGNAL_LIMIT_DEG)),
    "Standard deviation.",
);
pub(crate) const SEED: Key<i64> = required(
    "seed",
    whole(0, i64::MAX),
    "The same seed gives the same number at the same sample of the loop; another period is another noise.",
);

pub(super) static DISTURBANCE_TABLE: Table = of_kinds(
    "A disturbance, held from sample to sample.",
    &[&[&ENTERS_AT]],
    &[
        variant(
            SignalKind::Step.name(),
            plain("The amplitude from the start on.", &[&[&AMPLITUDE, &AT]]),
        ),
        variant(
            SignalKind::Pulse.name(),
            plain("The amplitude for a while.", &[&[&AMPLITUDE, &AT, &PULSE_WIDTH_S]]),
        ),
        RAMP,
        SINE,
        variant(
            SignalKind::Noise.name(),
            plain(
                "White noise, a new normal number each sample.",
                &[&[&STANDARD_DEVIATION_DEG, &AT, &SEED]],
            ),
        ),
    ],
);
