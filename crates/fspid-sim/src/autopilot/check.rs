//! Whether loops and modes make sense, and in which order loops answer.

use super::error::AutopilotError;
use super::{GlideSlope, Mode, Moves, OuterLoop, Quantity, TotalEnergy};
use crate::timing::Timing;

/// What is checked together.
struct Parts<'a> {
    loops: &'a [OuterLoop],
    has_beam: bool,
}

/// The engaged loops of each mode, the outermost first.
pub(super) fn order(
    loops: &[OuterLoop],
    total_energy: Option<&TotalEnergy>,
    beam: Option<&GlideSlope>,
    modes: &[Mode],
) -> Result<Vec<Vec<usize>>, AutopilotError> {
    let parts = Parts { loops, has_beam: beam.is_some() };
    if modes.is_empty() {
        return Err(AutopilotError::NoModes);
    }
    unique(loops.iter().map(|it| &it.name))?;
    unique(modes.iter().map(|mode| &mode.name))?;
    loops.iter().try_for_each(|outer| parts.pair(outer))?;
    if let Some(first) = modes.first().filter(|mode| mode.entry != super::Entry::default()) {
        return Err(AutopilotError::FirstWaits { mode: first.name.clone() });
    }
    modes.iter().map(|mode| parts.order(mode, total_energy.is_some())).collect()
}

/// Refuses modes that could begin only after the flight.
pub(crate) fn within(modes: &[Mode], timing: Timing) -> Result<(), AutopilotError> {
    let late = modes.iter().find(|mode| timing.first_sample_at(mode.entry.at_s) >= timing.rows());
    late.map_or(Ok(()), |mode| {
        let (mode, at_s) = (mode.name.clone(), mode.entry.at_s);
        Err(AutopilotError::NeverBegins { mode, at_s, end_s: timing.end_s() })
    })
}

fn unique<'a>(names: impl Iterator<Item = &'a String>) -> Result<(), AutopilotError> {
    let mut known: Vec<&String> = Vec::new();
    for name in names {
        if known.contains(&name) {
            return Err(AutopilotError::TwoOfOneName { name: name.clone() });
        }
        known.push(name);
    }
    Ok(())
}

impl Parts<'_> {
    /// Refuses a loop that cannot move what it is said to.
    fn pair(&self, outer: &OuterLoop) -> Result<(), AutopilotError> {
        use Quantity::{Airspeed, Altitude, FlightPath, GlideSlope, Heading, VerticalSpeed};
        let below = match outer.moves {
            Moves::Loop(number) => self.loops.get(number).map(|below| below.holds),
            _ => None,
        };
        let (good, allowed) = match outer.holds {
            Altitude | GlideSlope => (
                outer.moves == Moves::Pitch || matches!(below, Some(VerticalSpeed | FlightPath)),
                "pitch, or a loop that holds vertical speed or flight path",
            ),
            VerticalSpeed => (
                outer.moves == Moves::Pitch || below == Some(FlightPath),
                "pitch, or a loop that holds flight path",
            ),
            FlightPath => (outer.moves == Moves::Pitch, "pitch"),
            Airspeed => (
                matches!(outer.moves, Moves::Pitch | Moves::Throttle)
                    || matches!(below, Some(VerticalSpeed | FlightPath)),
                "throttle, pitch, or a loop that holds vertical speed or flight path",
            ),
            Heading => (outer.moves == Moves::Bank, "bank"),
        };
        if outer.holds == GlideSlope && !self.has_beam {
            return Err(AutopilotError::NoBeam { name: outer.name.clone() });
        }
        if good {
            return Ok(());
        }
        let (name, moves) = (outer.name.clone(), self.moved_in_words(outer.moves));
        Err(AutopilotError::WrongPair { name, holds: outer.holds, moves, allowed })
    }

    fn moved_in_words(&self, moves: Moves) -> String {
        match moves {
            Moves::Pitch => "pitch".to_owned(),
            Moves::Throttle => "the throttle".to_owned(),
            Moves::Bank => "the bank".to_owned(),
            Moves::Loop(number) => match self.loops.get(number) {
                Some(below) => {
                    format!("\"{}\", which holds {}", below.name, below.holds.in_words())
                }
                None => "a loop that is not there".to_owned(),
            },
        }
    }

    fn order(&self, mode: &Mode, has_total_energy: bool) -> Result<Vec<usize>, AutopilotError> {
        let engaged =
            || mode.engaged.iter().filter_map(|&number| Some((number, self.loops.get(number)?)));
        let total_energy = mode.total_energy && has_total_energy;
        self.nothing_twice(mode, total_energy)?;
        self.targets(mode, total_energy)?;
        // Pairs allow chains of at most three, and no circles.
        let mut order: Vec<(usize, usize)> = Vec::new();
        for (number, outer) in engaged() {
            order.push((self.depth(mode, outer)?, number));
        }
        order.sort_by_key(|&(depth, number)| (std::cmp::Reverse(depth), number));
        Ok(order.into_iter().map(|(_, number)| number).collect())
    }

    /// How many loops are between a loop and what is moved in the end.
    fn depth(&self, mode: &Mode, outer: &OuterLoop) -> Result<usize, AutopilotError> {
        let (mut depth, mut at) = (0, outer);
        while let Moves::Loop(number) = at.moves {
            let Some(below) = self.loops.get(number) else { break };
            if !mode.engaged.contains(&number) {
                let (mode, moves) = (mode.name.clone(), at.name.clone());
                return Err(AutopilotError::MovedNotEngaged {
                    mode,
                    moves,
                    moved: below.name.clone(),
                });
            }
            depth += 1;
            if depth > self.loops.len() {
                return Err(AutopilotError::Circle { name: outer.name.clone() });
            }
            at = below;
        }
        Ok(depth)
    }

    fn nothing_twice(&self, mode: &Mode, total_energy: bool) -> Result<(), AutopilotError> {
        let mut seen: Vec<&OuterLoop> = Vec::new();
        for outer in mode.engaged.iter().filter_map(|&number| self.loops.get(number)) {
            let taken = total_energy && matches!(outer.moves, Moves::Pitch | Moves::Throttle);
            let rival =
                seen.iter().find(|other| other.moves == outer.moves).map(|it| it.name.clone());
            if let Some(first) = rival.or_else(|| taken.then(|| "total energy".to_owned())) {
                let (mode, what) = (mode.name.clone(), self.moved_in_words(outer.moves));
                return Err(AutopilotError::TwoMove {
                    mode,
                    what,
                    loops: [first, outer.name.clone()],
                });
            }
            if seen.iter().any(|other| other.holds == outer.holds) {
                let (mode, what) = (mode.name.clone(), outer.holds);
                return Err(AutopilotError::TwoHold { mode, what });
            }
            seen.push(outer);
        }
        Ok(())
    }

    /// Refuses targets that nobody holds by himself, and numbers that are none.
    fn targets(&self, mode: &Mode, total_energy: bool) -> Result<(), AutopilotError> {
        let moved = |number: &usize| {
            let movers = mode.engaged.iter().filter_map(|&other| self.loops.get(other));
            movers.into_iter().any(|other| other.moves == Moves::Loop(*number))
        };
        let by_itself = |quantity: Quantity| {
            let both = total_energy && matches!(quantity, Quantity::Altitude | Quantity::Airspeed);
            let alone = |number: &&usize| {
                self.loops.get(**number).is_some_and(|it| it.holds == quantity) && !moved(number)
            };
            both || mode.engaged.iter().any(|number| alone(&number))
        };
        let targets = mode.targets.iter().map(|it| (it.quantity, it.target));
        let conditions = mode.entry.conditions.iter().map(|it| (it.quantity, it.value));
        if let Some((quantity, _)) =
            targets.clone().chain(conditions).find(|(_, it)| !it.is_finite())
        {
            return Err(AutopilotError::NotFinite { mode: mode.name.clone(), quantity });
        }
        if let Some((quantity, _)) = targets.clone().find(|(quantity, _)| !by_itself(*quantity)) {
            return Err(AutopilotError::NobodyHolds { mode: mode.name.clone(), quantity });
        }
        let looks = |it: &super::Condition| it.quantity == Quantity::GlideSlope;
        if !self.has_beam && mode.entry.conditions.iter().any(looks) {
            return Err(AutopilotError::NoBeam { name: mode.name.clone() });
        }
        Ok(())
    }
}
