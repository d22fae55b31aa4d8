//! Whether members of a family hold as they fly. What is proved of each are pitch loops about its own trim; outer loops around
//! them, roll and yaw, and where set-points lead are others in each member, and are asked of some.

use fspid_proof::{LoopDescription, MOST_PARAMETERS, NotProvable};
use fspid_scenario::file::{Study, Template};
use fspid_sim::Plant;

use super::members::{Members, place_of};
use crate::around::trouble_in_words;

/// Corners that are asked have numbers below two to this power: every one of up to four numbers that differ.
const BITS: usize = 4;

/// Which bits of a corner's number say that a number is at its upper end: there, where they have an odd sum. Each is an odd
/// number of bits, so that no two of them make a third: any three numbers are at all eight of their ends together.
const SIDES: [u32; MOST_PARAMETERS] = [1, 2, 4, 8, 7, 11, 13, 14];

/// What came of members as they fly.
#[derive(Clone, Debug, PartialEq)]
pub enum AsFlown {
    /// What flies is the loop that is proved, and nothing else.
    LoopAlone,
    /// Each member that was asked holds at rest.
    Held {
        /// How many they are.
        members: usize,
        /// What was asked of each beside the pitch loop, as a sentence without its end.
        what: &'static str,
    },
    /// A member does not, or may not.
    NotHeld {
        /// Its numbers.
        at: Vec<f64>,
        /// Why not.
        because: String,
    },
}

impl AsFlown {
    /// Asks members of the loop of a scenario, whose family is proved.
    ///
    /// # Errors
    /// [`NotProvable::Stopped`].
    pub(super) fn of(
        members: &Members,
        template: &Template,
        description: &LoopDescription,
        stops: fn() -> bool,
    ) -> Result<Self, NotProvable> {
        let Some(what) = beside_the_loop(template.study(), description) else {
            return Ok(Self::LoopAlone);
        };
        let asked = asked_members(&ends(members));
        for at in &asked {
            if stops() {
                return Err(NotProvable::Stopped);
            }
            if let Some(because) = trouble(members, template, description, at) {
                return Ok(Self::NotHeld { at: at.clone(), because });
            }
        }
        Ok(Self::Held { members: asked.len(), what })
    }

    /// Of how many members it was asked, and that it is not proved of others.
    pub(in super::super) fn not_proved_between(&self) -> Option<String> {
        let Self::Held { members, what } = self else { return None };
        Some(format!(
            "That in the family {what} was asked of {members} members, at corners of the box and in its middle, and is not proved between them."
        ))
    }
}

/// What of a scenario's flights is not in its pitch loop without limits, and is to hold; none where that is all.
fn beside_the_loop(study: &Study, description: &LoopDescription) -> Option<&'static str> {
    let has_wings = study.derivatives.as_ref().is_none_or(|it| it.data.lateral.is_some());
    match (study.scenario.autopilot.is_some(), &study.scenario.plant) {
        (true, Plant::Aircraft(_)) if has_wings => {
            Some("outer loops, roll and yaw hold at rest and no flight swings at limits")
        }
        (true, _) => Some("outer loops hold at rest and no flight swings at limits"),
        (false, Plant::Aircraft(_)) if has_wings => {
            Some("roll and yaw hold at rest and no flight swings at limits")
        }
        (false, Plant::Aircraft(_)) => {
            Some("flights hold as they are commanded and none swings at limits")
        }
        (false, _) if description.limits().is_empty() => None,
        (false, _) => Some("no flight swings at limits"),
    }
}

fn ends(members: &Members) -> Vec<[f64; 2]> {
    members.parameters().iter().map(|one| one.ends).collect()
}

/// Numbers of the members that are asked: corners of the box, each once, and its middle.
fn asked_members(ends: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let corners = 0..1_u32 << ends.len().min(BITS);
    let corner = |number: u32| -> Vec<f64> {
        let side = |bits: u32| usize::from((number & bits).count_ones() % 2 == 1);
        ends.iter().zip(SIDES).map(|(ends, bits)| ends[side(bits)]).collect()
    };
    let middle = ends.iter().map(|[from, to]| 0.5 * (from + to)).collect();
    let mut asked: Vec<Vec<f64>> = Vec::new();
    for at in corners.map(corner).chain([middle]) {
        if !asked.contains(&at) {
            asked.push(at);
        }
    }
    asked
}

/// Why a member does not hold as it flies.
fn trouble(
    members: &Members,
    template: &Template,
    description: &LoopDescription,
    at: &[f64],
) -> Option<String> {
    let study = match template.with(&members.values(at)) {
        Ok(study) => study,
        Err(problems) => {
            return Some(format!("it cannot be flown: {}", problems.first_in_a_line()));
        }
    };
    // With the controller that the scenario makes of its numbers, which families do not change.
    let place = place_of(template.study(), description);
    match place.and_then(|place| study.scenario.controllers.get(place)) {
        Some(named) => trouble_in_words(&study.scenario, named),
        None => Some("its controllers are others".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn of_up_to_four_numbers_every_corner_is_asked_and_of_more_every_corner_of_any_three() {
        let box_of = |count: usize| vec![[0.0, 1.0]; count];
        assert_eq!(asked_members(&box_of(1)), [[0.0], [1.0], [0.5]]);
        assert_eq!(asked_members(&[[2.0, 2.0]]), [[2.0]]);
        for count in 1..=MOST_PARAMETERS {
            let asked = asked_members(&box_of(count));
            assert_eq!(asked.len(), (1 << count.min(BITS)) + 1);
            let corners_of = |three: [usize; 3]| {
                let found = asked.iter().map(|at| three.map(|one| at[one].to_bits()));
                found.collect::<HashSet<_>>().len() - 1
            };
            for (i, j, k) in
                (0..count).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| (i, j, k))))
            {
                assert_eq!(corners_of([i, j, k]), 8, "{count}: {i} {j} {k}");
            }
        }
    }
}
