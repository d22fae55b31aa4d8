//! Numbers and sentences of the answer.

use core::mem::discriminant;

use fspid_limit::{Measure, SaidBeside, Travel};
use fspid_page::number::fixed;
use fspid_scenario::units::degrees;

use super::{Answer, Rung};

/// Digits of a bound.
const DIGITS: i32 = 4;

/// What a measure is called.
pub(super) fn called(measure: Measure) -> &'static str {
    match measure {
        Measure::Iae => "IAE",
        Measure::Ise => "ISE",
        Measure::Peak => "largest error",
    }
}

/// Its unit.
pub(super) fn unit(measure: Measure) -> &'static str {
    match measure {
        Measure::Iae => "deg s",
        Measure::Ise => "deg² s",
        Measure::Peak => "deg",
    }
}

/// A measure in that unit.
pub(super) fn in_unit(measure: Measure, value: f64) -> f64 {
    match measure {
        Measure::Ise => degrees(degrees(value)),
        Measure::Iae | Measure::Peak => degrees(value),
    }
}

/// So many digits that never say more than the number: rounded down.
pub(super) fn down(value: f64) -> String {
    rounded(value, libm::floor)
}

/// Rounded up.
pub(super) fn up(value: f64) -> String {
    rounded(value, libm::ceil)
}

fn rounded(value: f64, to: fn(f64) -> f64) -> String {
    if !(value > 0.0) {
        return "0".to_owned();
    }
    #[allow(clippy::cast_possible_truncation, reason = "an exponent of a float is small")]
    let exponent = libm::floor(libm::log10(value)) as i32;
    let decimals = (DIGITS - 1 - exponent).max(0);
    let scale = libm::pow(10.0, f64::from(decimals));
    let decimals = usize::try_from(decimals).unwrap_or(0);
    format!("{:.decimals$}", to(value * scale) / scale)
}

/// A share that is proved, %, in whole ones: never more than it is.
pub(crate) fn proved_percent(share_pct: f64) -> String {
    fixed(libm::floor(share_pct), 0)
}

/// How much of what is possible a controller reaches: a per cent, or between which two where the limit is not known closer.
pub(super) fn share(rung: &Rung, measure: f64) -> Option<String> {
    let limit = rung.limit.as_ref().ok().filter(|_| measure > 0.0)?;
    let percent = |limit: f64| 100.0 * limit / measure;
    let least = libm::floor(percent(limit.proved));
    let Some(reached) = rung.reached else { return Some(format!("at least {least:.0} %")) };
    let most = libm::ceil(percent(reached.measure.min(measure)));
    // Two apart is what rounding outwards makes of numbers that differ by little more than one.
    Some(if most - least <= 2.0 {
        format!("{least:.0} %")
    } else {
        format!("{least:.0} to {most:.0} %")
    })
}

/// Why a rung has no limit.
pub(super) fn none(rung: &Rung) -> Option<String> {
    rung.limit.as_ref().err().map(ToString::to_string)
}

/// What the flight and the question are, in a sentence.
pub(super) fn lead(answer: &Answer) -> String {
    let (end_s, dt_s) = answer.times_s;
    let options = &answer.options;
    format!(
        "The least {} that any commands reach within a given {}, over {} s at {} ms. Nobody who keeps to what is said below gets below what is proved, whatever the controller: the solver's multipliers were added up in interval arithmetic. What is reached was flown within the travel, by commands that know the whole flight before it begins or by anybody here who does not.",
        called(options.measure),
        options.travel.words(),
        short(end_s),
        short(1000.0 * dt_s),
    )
}

fn short(value: f64) -> String {
    fspid_page::number::short(value, 4)
}

/// What is said beside the answer, a sentence each.
pub(super) fn beside(answer: &Answer) -> Vec<String> {
    let mut told: Vec<String> = answer.beside.iter().map(|it| sentence(*it)).collect();
    if answer.options.travel == Travel::Command {
        told.push("The jump of the first command does not count as travel, as in reports: who knows the flight before begins wherever he likes for nothing. `--travel-of command-from-rest` counts it.".to_owned());
    }
    let unreached = |it: &&Rung| it.limit.is_ok() && it.reached.is_none();
    if all_rungs(answer).any(|it| unreached(&it)) {
        told.push("Where nothing stands as reached, nobody here kept within the travel, the commands of the programme neither: it knows what holds the elevator, or what is cut, from one side only.".to_owned());
    }
    if answer.options.causal {
        told.push(if causal_is_told(answer) {
            "Without the future: plant, past and present known, planned anew at each change of set-point or disturbance as if nothing came after it, travel at one price for the whole flight. Told is the least of what such a planner, a controller of the scenario and nobody at all reached within the travel, and no bound.".to_owned()
        } else {
            format!("Without the future nothing is told: something changes at more than {} samples, or nobody kept within any of these travels.", fspid_limit::MOST_EVENTS)
        });
    }
    told
}

pub(super) fn causal_is_told(answer: &Answer) -> bool {
    all_rungs(answer).any(|it| it.causal.is_some())
}

/// Rungs of the ladder, and those of the controllers.
fn all_rungs(answer: &Answer) -> impl Iterator<Item = &Rung> {
    let own = answer.controllers.iter().filter_map(|it| it.rung.as_ref());
    answer.rungs.iter().chain(own)
}

/// What is said beside the limits of some cases: each once, with how many it is of, and with the largest of its numbers.
pub(super) fn beside_cases(cases: &[Vec<SaidBeside>]) -> Vec<String> {
    let mut kinds: Vec<(SaidBeside, usize)> = Vec::new();
    for one in cases.iter().flatten() {
        match kinds.iter_mut().find(|(kind, _)| discriminant(kind) == discriminant(one)) {
            Some((kind, count)) => (*kind, *count) = (larger(*kind, *one), *count + 1),
            None => kinds.push((*one, 1)),
        }
    }
    let told = |(kind, count)| format!("{count} of {} cases: {}", cases.len(), in_cases(kind));
    kinds.into_iter().map(told).collect()
}

/// What leaves commands more room, of two of one kind.
fn larger(one: SaidBeside, other: SaidBeside) -> SaidBeside {
    match (one, other) {
        (SaidBeside::Within(one), SaidBeside::Within(other)) => SaidBeside::Within(one.max(other)),
        (SaidBeside::Still(one), SaidBeside::Still(other)) if other.within_rad > one.within_rad => {
            SaidBeside::Still(other)
        }
        _ => one,
    }
}

fn in_cases(beside: SaidBeside) -> String {
    match beside {
        SaidBeside::Within(within_rad) => format!(
            "The actuator has no limits: commands are taken to be within ± {} deg.",
            short(degrees(within_rad))
        ),
        SaidBeside::Still(still) => format!(
            "Until something happens commands are taken to be {}, as those of all designs here are: nobody moves for what has not happened.",
            match still.within_rad > 0.0 {
                true =>
                    format!("within ± {} deg at most", short(1.0005 * degrees(still.within_rad))),
                false => "zero".to_owned(),
            }
        ),
        other => sentence(other),
    }
}

fn sentence(beside: SaidBeside) -> String {
    match beside {
        SaidBeside::SeesEverything => "Sensors and noise of measurements do not concern who knows everything; a controller that has to live with them reaches less.".to_owned(),
        SaidBeside::Within(within_rad) => format!("The actuator has no limits: the limit is that of commands within ± {} deg, where those of all controllers here are.", short(degrees(within_rad))),
        SaidBeside::Still(still) => format!(
            "Until something happens, at {} s, commands are taken to be {}: nobody moves for what has not happened. `--anticipate` lets them.",
            short(still.until_s),
            match still.within_rad > 0.0 {
                true => format!("within ± {} deg, as those of all controllers here are", short(1.0005 * degrees(still.within_rad))),
                false => "zero, as those of all controllers here are".to_owned(),
            }
        ),
        SaidBeside::Deadband => "The deadband is left out of the command's travel, so that the limit may be lower than what is possible.".to_owned(),
        SaidBeside::ServoDisturbance => "What disturbs the servo may move a command that is cut for nothing, so that the limit may be lower than what is possible.".to_owned(),
        SaidBeside::Air => "The air is taken as the flight computes it, rounding included.".to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_proved_is_rounded_down_and_what_is_reached_up() {
        assert_eq!((down(5.899_96), up(5.899_56)), ("5.899".to_owned(), "5.900".to_owned()));
        assert_eq!(
            (down(0.000_123_49), up(123_456.2)),
            ("0.0001234".to_owned(), "123457".to_owned())
        );
        assert_eq!((down(0.0), down(f64::NAN)), ("0".to_owned(), "0".to_owned()));
    }
}
