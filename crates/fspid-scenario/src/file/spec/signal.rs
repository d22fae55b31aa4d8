//! Set-points and disturbances.

use fspid_sim::signal::{Entry, Interpolation};

use super::word::{Word, words, words_of};
use super::{
    ANGLE_LIMIT_DEG, Default, Key, Kind, Range, Table, Variant, angle, defaulted, not_negative,
    plain, positive, required,
};

/// Highest frequency, Hz; far above what any sample period can show.
const FREQUENCY: Kind = Kind::Number { unit: "Hz", range: Range::PositiveUpTo(1e6) };

const AMPLITUDE: Key = required("amplitude_deg", angle(), "Size; negative for the other way.");
const AT: Key = defaulted("at_s", not_negative("s"), Default::Number(0.0), "Start.");

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

/// A ramp, of the command and of a disturbance alike.
const RAMP: Variant = Variant {
    name: SignalKind::Ramp.name(),
    table: plain(
        "In a straight line from 0 to the amplitude, where it stays.",
        &[&[AMPLITUDE, AT, required("width_s", positive("s"), "Length of the rise.")]],
    ),
};

/// A sine, of the command and of a disturbance alike.
const SINE: Variant = Variant {
    name: SignalKind::Sine.name(),
    table: plain(
        "A sine wave from the start on.",
        &[&[AMPLITUDE, AT, required("frequency_hz", FREQUENCY, "Frequency.")]],
    ),
};

pub(super) static SETPOINT: Table = Table {
    doc: "The commanded pitch angle over time.",
    groups: &[],
    choices: &[],
    variants: &[
        Variant {
            name: SignalKind::Step.name(),
            table: plain("The amplitude from the start on.", &[&[AMPLITUDE, AT]]),
        },
        Variant {
            name: SignalKind::Square.name(),
            table: plain(
                "The amplitude for a half period, then minus the amplitude (bipolar) or 0 for one, and so on.",
                &[&[
                    AMPLITUDE,
                    AT,
                    required("half_period_s", positive("s"), "Length of each half."),
                    defaulted(
                        "bipolar",
                        Kind::Boolean,
                        Default::Boolean(false),
                        "Swings to minus the amplitude and not to 0.",
                    ),
                ]],
            ),
        },
        Variant {
            name: SignalKind::Doublet.name(),
            table: plain(
                "The amplitude, then minus the amplitude, then 0.",
                &[&[AMPLITUDE, AT, required("width_s", positive("s"), "Length of each half.")]],
            ),
        },
        RAMP,
        SINE,
        Variant {
            name: SignalKind::Table.name(),
            table: plain(
                "Rows of time and value; 0 before the first, the last value after the last.",
                &[&[
                    required(
                        "time_s",
                        Kind::Numbers {
                            unit: "s",
                            range: Range::NotNegative,
                            least: 1,
                            most: MOST_ROWS,
                        },
                        "Times, each after the one before.",
                    ),
                    required(
                        "value_deg",
                        Kind::Numbers {
                            unit: "deg",
                            range: Range::Between(-ANGLE_LIMIT_DEG, ANGLE_LIMIT_DEG),
                            least: 1,
                            most: MOST_ROWS,
                        },
                        "Values, as many as times.",
                    ),
                    defaulted(
                        "interpolation",
                        Kind::Word(Interpolation::WORDS),
                        Default::Word("hold"),
                        "The last value holds, or a straight line to the next.",
                    ),
                ]],
            ),
        },
    ],
};

pub(super) static DISTURBANCE: Table = Table {
    doc: "A disturbance, held from sample to sample.",
    groups: &[&[required(
        "enters_at",
        Kind::Word(Entry::WORDS),
        "Added to the servo's command, to the elevator behind the servo (both nose up positive), or to the measured pitch.",
    )]],
    choices: &[],
    variants: &[
        Variant {
            name: SignalKind::Step.name(),
            table: plain("The amplitude from the start on.", &[&[AMPLITUDE, AT]]),
        },
        Variant {
            name: SignalKind::Pulse.name(),
            table: plain(
                "The amplitude for a while.",
                &[&[AMPLITUDE, AT, required("width_s", positive("s"), "Length.")]],
            ),
        },
        RAMP,
        SINE,
        Variant {
            name: SignalKind::Noise.name(),
            table: plain(
                "White noise, a new normal number each sample.",
                &[&[
                    required(
                        "standard_deviation_deg",
                        Kind::Number { unit: "deg", range: Range::UpTo(ANGLE_LIMIT_DEG) },
                        "Standard deviation.",
                    ),
                    AT,
                    required(
                        "seed",
                        Kind::Integer { least: 0, most: i64::MAX },
                        "The same seed gives the same number at the same sample of the loop; another period is another noise.",
                    ),
                ]],
            ),
        },
    ],
};
