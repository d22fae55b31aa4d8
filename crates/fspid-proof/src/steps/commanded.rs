//! The flights of a scenario: its set-point and loads over time, each times any number up to its size.
//!
//! They are flown in legs: a new one where, after a pause, something else changes than before. A leg begins with what the flights
//! before have come to, sets with like gains joined to one ([`super::joined`]), each divided along what changes: a step under a
//! load takes as many sets as load and step each for itself, times the groups of gains that loads leave, not their product. A
//! group that cannot be flown is halved, until its sets are flown on one by one, which then forget nothing.

use fspid_numeric::scalar::Interval;

use super::commands::{Along, Commands};
use super::crew::side_by_side;
use super::flights::{Beginning, Landed, Patch, Set, Way};
use super::joined::{Joined, narrowed};
use super::sample::{Flight, Stop};
use super::sweep::Sweep;
use super::terminal::Terminal;
use super::work::{Flights, most_checked};
use super::{Checked, Search, given_up, is_odd, sees_loads_at_once};
use crate::caps::{MOST_LEG_PARTS, MOST_LEG_SETS};
use crate::certificate::Certificate;
use crate::scope::Range;

/// The narrowest part, as a share of the whole.
const NARROWEST: f64 = 1.0 / 512.0;
/// Where a search begins: with a part of such a share of the whole.
const BEGINS: f64 = 0.125;
/// Parts of the loads where both change in a leg.
const BOTH: u8 = 8;
/// Shares of what is commanded that are tried.
const TRIED: [f64; 3] = [1.0, 0.5, 0.25];
/// How finely, one after the other: wide parts and groups are few, and narrow ones leave the next leg more.
const FINENESS: [Fineness; 3] = [
    Fineness { apart: 0.01, gains: 0.1 },
    Fineness { apart: 0.003, gains: 0.04 },
    Fineness { apart: 0.0005, gains: 0.012 },
];
/// The gains of a part of a group may be apart so much of what those of the group may.
const OF_GROUP: f64 = 0.5;

/// Flights from rest at the trim, at the controller's first sample, that end where the loop without limits does, limits acting
/// on the way.
///
/// Set-point and loads are those of [`Commands`] times a number each, either way, up to their sizes; after the last change
/// they stay.
#[derive(Clone, Debug, PartialEq)]
pub struct Commanded {
    /// What is commanded.
    pub commands: Commands,
    /// Near rest.
    pub terminal: Terminal,
    /// One after the other; the first from the first sample.
    pub legs: Vec<Leg>,
}

/// From a sample to the next leg, the last one to where the flights have landed.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// The first sample.
    pub from_sample: usize,
    /// What it is flown in; of the first leg one group of everything.
    pub groups: Vec<Group>,
}

/// Sets that are joined, and what they are divided into.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Which sets of the leg before, counted in the order of its groups, and in each set-point by set-point all loads.
    pub of: Vec<usize>,
    /// Where parts of the set-points end, from the least to the largest.
    pub setpoints_rad: Vec<f64>,
    /// Where parts of the loads end, likewise; each is flown with each of the others.
    pub loads_rad: Vec<f64>,
}

/// Proved result for the commanded flights of a scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// Largest set-point, rad.
    pub setpoint_rad: f64,
    /// Largest load, rad of elevator.
    pub load_rad: f64,
    /// Sets of flights.
    pub sets: usize,
    /// No limit acts any more after so long, s from the beginning.
    pub settled_s: f64,
    /// In some flight a limit may act.
    pub limited: bool,
}

/// All set-points and loads of what is commanded, each from its least to its largest. Of flights that mirror each other one is flown.
fn whole(commands: &Commands, odd: bool) -> Patch {
    let Commands { setpoint_rad, load_rad, .. } = commands;
    let both = |most: f64| [-most, most];
    match (odd, *setpoint_rad > 0.0) {
        (false, _) => Patch { setpoint: both(*setpoint_rad), load: both(*load_rad) },
        (true, true) => Patch { setpoint: [0.0, *setpoint_rad], load: both(*load_rad) },
        (true, false) => Patch { setpoint: [0.0; 2], load: [0.0, *load_rad] },
    }
}

impl Leg {
    /// Sets that it is flown in.
    pub(crate) fn sets(&self) -> usize {
        self.groups.iter().map(Group::sets).fold(0, usize::saturating_add)
    }
}

impl Group {
    fn sets(&self) -> usize {
        let parts = |ends: &[f64]| ends.len().saturating_sub(1);
        parts(&self.setpoints_rad).saturating_mul(parts(&self.loads_rad))
    }

    fn patches(&self) -> Vec<Patch> {
        let loads = || self.loads_rad.windows(2).map(|pair| [pair[0], pair[1]]);
        let setpoints = self.setpoints_rad.windows(2).map(|pair| [pair[0], pair[1]]);
        setpoints.flat_map(|setpoint| loads().map(move |load| Patch { setpoint, load })).collect()
    }
}

/// Where flights of a group come from.
enum Origin {
    /// Rest at the trim, all of them.
    Rest(Flight),
    /// One set.
    Alone(Set),
    /// Everything that several sets have come to, beside one of their flights.
    Joined(Joined, Flight),
}

/// A group with its parts, and the sets that they come to before the next leg.
type Divided = (Group, Vec<Set>);

/// What a group begins with.
struct Start {
    origin: Origin,
    from: usize,
    /// The sets, and all set-points and loads of theirs.
    of: Vec<usize>,
    whole: Patch,
}

/// Sets of flights of what is commanded.
#[derive(Clone, Copy)]
struct Course<'a> {
    commands: &'a Commands,
}

impl Course<'_> {
    fn start(self, flights: &mut Flights<'_>, whole: Patch) -> Start {
        let origin = Origin::Rest(flights.begun(Beginning::Controller));
        Start { origin, from: 0, of: Vec::new(), whole }
    }

    fn begun(self, flights: &mut Flights<'_>, start: &Start, patch: Patch) -> Flight {
        flights.forget();
        match &start.origin {
            Origin::Rest(flight) => flight.clone(),
            Origin::Alone(set) => narrowed(set, patch),
            Origin::Joined(joined, like) => joined.flight(like, self.commands, patch, start.from),
        }
    }

    /// A part of a leg, up to the next.
    fn through(
        self,
        flights: &mut Flights<'_>,
        (start, patch): (&Start, Patch),
        to: usize,
    ) -> Result<Flight, Stop> {
        let way = Way { commands: self.commands, patch, from: Beginning::Controller };
        let begun = self.begun(flights, start, patch);
        flights.until(&way, begun, [start.from, to])
    }

    /// A part of the last leg, to where it has landed.
    fn until_rest(
        self,
        flights: &mut Flights<'_>,
        (start, patch): (&Start, Patch),
    ) -> Result<Landed, Stop> {
        let way = Way { commands: self.commands, patch, from: Beginning::Controller };
        let begun = self.begun(flights, start, patch);
        flights.landed(&way, begun, start.from)
    }

    /// What a group of the next leg begins with.
    fn next(flights: &Flights<'_>, sets: &[Set], of: Vec<usize>, from: usize) -> Option<Start> {
        let joined = of.iter().map(|place| sets.get(*place)).collect::<Option<Vec<&Set>>>()?;
        let (first, like) = *joined.first()?;
        let whole = joined.iter().fold(*first, |whole, (patch, _)| whole.hull(patch));
        let origin = match joined[..] {
            [set] => Origin::Alone(set.clone()),
            _ => Origin::Joined(flights.joined(&joined)?, like.clone()),
        };
        Some(Start { origin, from, of, whole })
    }

    /// Groups of sets whose gains are all within a share of what they can reach.
    fn groups(flights: &Flights<'_>, sets: &[Set], share: f64) -> Vec<Vec<usize>> {
        let gains = sets.iter().map(|(_, flight)| flights.gains_of_reach(flight));
        let gains: Vec<[Interval; 3]> = gains.collect();
        let middle = |place: &usize| gains[*place].iter().map(|it| it.midpoint()).sum::<f64>();
        let mut order: Vec<usize> = (0..sets.len()).collect();
        order.sort_by(|one, other| middle(one).total_cmp(&middle(other)).then(one.cmp(other)));
        let mut groups: Vec<(Vec<usize>, [Interval; 3])> = Vec::new();
        for place in order {
            let own = gains[place];
            let joined = groups
                .last()
                .map(|(_, all)| [0, 1, 2].map(|gain: usize| all[gain].hull(own[gain])));
            match (groups.last_mut(), joined) {
                (Some((group, all)), Some(joined))
                    if joined.iter().all(|it| it.width() <= share) =>
                {
                    group.push(place);
                    *all = joined;
                }
                _ => groups.push((vec![place], own)),
            }
        }
        groups.into_iter().map(|(group, _)| group).collect()
    }
}

/// How a search divides.
#[derive(Clone, Copy, Debug)]
struct Fineness {
    /// How far the flights of a part may be apart at the end of a leg, beside what set-point and load make of them, as a
    /// share of these.
    apart: f64,
    /// How far gains of a group, as a share of what they can reach.
    gains: f64,
}

/// A search for legs.
#[derive(Clone, Copy)]
struct Legs<'a> {
    course: Course<'a>,
    fineness: Fineness,
}

impl Legs<'_> {
    /// All legs; [`Stop::Work`] where their groups take too much before any is halved: finer ones would be more.
    fn found(self, flights: &mut Flights<'_>, whole: Patch, dt_s: f64) -> Result<Vec<Leg>, Stop> {
        let planned = self.course.commands.legs(dt_s);
        let mut starts = vec![self.course.start(flights, whole)];
        let (mut legs, mut before) = (Vec::new(), Vec::new());
        for (place, &(_, along)) in planned.iter().enumerate() {
            let to = planned.get(place + 1).map(|(from, _)| *from);
            let (leg, sets) = self.leg(flights, (starts, &before), along, to)?;
            legs.push(leg);
            let Some(to) = to else { break };
            let groups = Course::groups(flights, &sets, self.fineness.gains).into_iter();
            let next = groups.map(|of| Course::next(flights, &sets, of, to));
            starts = next.collect::<Option<_>>().ok_or(Stop::Lost)?;
            before = sets;
        }
        Ok(legs)
    }

    /// A leg of groups of the sets before it; one that cannot be flown is halved.
    fn leg(
        self,
        flights: &mut Flights<'_>,
        (mut starts, before): (Vec<Start>, &[Set]),
        along: Along,
        to: Option<usize>,
    ) -> Result<(Leg, Vec<Set>), Stop> {
        let from_sample = starts.first().ok_or(Stop::Lost)?.from;
        let (mut leg, mut sets) = (Leg { from_sample, groups: Vec::new() }, Vec::new());
        let mut tried = self.tried(flights, &starts, along, to)?;
        loop {
            let mut halved = Vec::new();
            for (start, divided) in starts.iter().zip(tried) {
                if let Some((group, own)) = divided {
                    leg.groups.push(group);
                    sets.extend(own);
                    continue;
                }
                for half in start.of.chunks(start.of.len().div_ceil(2)) {
                    let next = Course::next(flights, before, half.to_vec(), from_sample);
                    halved.push(next.ok_or(Stop::Lost)?);
                }
            }
            if leg.sets() > MOST_LEG_SETS {
                return Err(Stop::Lost);
            }
            if halved.is_empty() {
                return Ok((leg, sets));
            }
            starts = halved;
            // Finer groups may take less than halves do.
            tried = self.tried(flights, &starts, along, to).map_err(|_| Stop::Lost)?;
        }
    }

    /// What becomes of each start: nothing where one of several sets cannot be flown, and may be halved.
    fn tried(
        self,
        flights: &mut Flights<'_>,
        starts: &[Start],
        along: Along,
        to: Option<usize>,
    ) -> Result<Vec<Option<Divided>>, Stop> {
        side_by_side(flights, starts, |flights, start| {
            match self.divided(flights, start, along, to) {
                Err(stop) if stop != Stop::Work && start.of.len() > 1 && !flights.is_stopped() => {
                    Ok(None)
                }
                divided => divided.map(Some),
            }
        })
    }

    /// Parts of a group, each of which is flown, with the sets that they come to before the next leg.
    fn divided(
        self,
        flights: &mut Flights<'_>,
        start: &Start,
        along: Along,
        to: Option<usize>,
    ) -> Result<Divided, Stop> {
        let Patch { setpoint, load } = start.whole;
        let mut sets = Vec::new();
        let of_load = along == Along::Load;
        let others = match along {
            Along::Load => setpoint.to_vec(),
            Along::Setpoint => load.to_vec(),
            Along::Both => {
                let at =
                    |part: u8| load[0] + (load[1] - load[0]) * f64::from(part) / f64::from(BOTH);
                (0..BOTH).map(at).chain([load[1]]).collect()
            }
        };
        let ends = swept(if of_load { load } else { setpoint }, &mut |piece| {
            let mut own = Vec::new();
            for pair in others.windows(2) {
                let other = [pair[0], pair[1]];
                let patch = match of_load {
                    true => Patch { setpoint: other, load: piece },
                    false => Patch { setpoint: piece, load: other },
                };
                own.extend(self.part(flights, (start, patch), to)?);
            }
            sets.extend(own);
            Ok(())
        })?;
        let (setpoints_rad, loads_rad) = if of_load { (others, ends) } else { (ends, others) };
        Ok((Group { of: start.of.clone(), setpoints_rad, loads_rad }, sets))
    }

    /// A part of a leg; of one before the last what it comes to, where its flights are near each other.
    fn part(
        self,
        flights: &mut Flights<'_>,
        of: (&Start, Patch),
        to: Option<usize>,
    ) -> Result<Option<Set>, Stop> {
        let Some(to) = to else {
            return self.course.until_rest(flights, of).map(|_| None);
        };
        let flight = self.course.through(flights, of, to)?;
        let Commands { setpoint_rad, load_rad, .. } = self.course.commands;
        let apart_rad = self.fineness.apart * (setpoint_rad + load_rad);
        let gains = flights.gains_of_reach(&flight).map(Interval::width);
        let near = flights.apart_rad(&flight) <= apart_rad
            && gains.iter().all(|width| *width <= OF_GROUP * self.fineness.gains);
        if near { Ok(Some((of.1, flight))) } else { Err(Stop::Lost) }
    }
}

/// Ends of parts from the least to the largest, each of which flies.
fn swept(
    [least, most]: [f64; 2],
    fly: &mut dyn FnMut([f64; 2]) -> Result<(), Stop>,
) -> Result<Vec<f64>, Stop> {
    let whole = most - least;
    let (mut ends, mut sweep) = (vec![least], Sweep::over([least, most], BEGINS));
    while !sweep.is_over() || ends.len() < 2 {
        match fly(sweep.piece()) {
            Ok(()) if ends.len() <= MOST_LEG_PARTS => ends.push(sweep.flown()),
            Ok(()) => return Err(Stop::Lost),
            Err(Stop::Work) => return Err(Stop::Work),
            Err(stop) => {
                let width = sweep.given_up();
                if !(width >= NARROWEST * whole && width > 0.0) {
                    return Err(stop);
                }
            }
        }
    }
    Ok(ends)
}

/// Loads at the elevator, which a pitch rate may show at once.
fn at_elevator_rad(commands: &Commands) -> f64 {
    if commands.at_elevator.0.is_empty() { 0.0 } else { commands.load_rad }
}

impl Search<'_> {
    /// The flights that are commanded, as large as they are found to end near their rest.
    pub(crate) fn commanded(&self, commands: &Commands) -> Option<Commanded> {
        let Self { certificate, model, set, terminal, system, stops } = self;
        let beyond = Commanded::fits_range(commands, certificate).is_err();
        if beyond || sees_loads_at_once(model, at_elevator_rad(commands)) {
            return None;
        }
        let dt_s = certificate.description.controller.config().dt_s;
        let odd = is_odd(&certificate.description);
        let most_checked = most_checked(&certificate.description);
        let part = 1.0 / (TRIED.len() * FINENESS.len()) as f64;
        for size in TRIED {
            let commands = commands.scaled(size);
            for fineness in FINENESS {
                let flights = Flights::of(certificate, model, set, terminal, system.as_ref())?;
                let mut flights = flights.searching(part, *stops);
                let legs = Legs { course: Course { commands: &commands }, fineness };
                match legs.found(&mut flights, whole(&commands, odd), dt_s) {
                    // What is found is flown again by whoever checks it.
                    Ok(legs) if flights.flown <= most_checked => {
                        return Some(Commanded { commands, terminal: terminal.clone(), legs });
                    }
                    Ok(_) | Err(Stop::Work) => break,
                    Err(_) => {}
                }
            }
        }
        None
    }
}

impl Commanded {
    /// Proves the claim anew.
    pub(crate) fn proved(&self, checked: Checked<'_>) -> Result<Ended, &'static str> {
        let Checked { certificate, model, set, stops } = checked;
        let Self { commands, terminal, legs } = self;
        checked.allowed(at_elevator_rad(commands))?;
        self.fits(certificate)?;
        let system = super::system(&certificate.description);
        let mut flights = Flights::of(certificate, model, set, terminal, system.as_ref())
            .ok_or("flights: the loop near rest is not enclosed")?;
        flights.stops = stops;
        let course = Course { commands };
        let whole = whole(commands, is_odd(&certificate.description));
        let mut starts = vec![course.start(&mut flights, whole)];
        let (mut worst, mut count) = (Landed::default(), 0);
        for (place, leg) in legs.iter().enumerate() {
            let mut parts = Vec::new();
            for (start, group) in starts.iter().zip(&leg.groups) {
                group.fills(start.whole)?;
                parts.extend(group.patches().into_iter().map(|patch| (start, patch)));
            }
            count += parts.len();
            let Some(next) = legs.get(place + 1) else {
                let landed = side_by_side(&mut flights, &parts, |flights, of| {
                    course.until_rest(flights, *of)
                });
                let landed = landed.map_err(given_up)?.into_iter();
                worst = landed.fold(worst, Landed::worse);
                break;
            };
            let flown = side_by_side(&mut flights, &parts, |flights, of| {
                course.through(flights, *of, next.from_sample)
            });
            let patches = parts.iter().map(|(_, patch)| *patch);
            let sets: Vec<Set> = patches.zip(flown.map_err(given_up)?).collect();
            starts = next.starts(&flights, &sets)?;
        }
        Ok(Ended {
            setpoint_rad: commands.setpoint_rad,
            load_rad: commands.load_rad,
            sets: count,
            settled_s: worst.samples as f64 * certificate.description.controller.config().dt_s,
            limited: worst.limited,
        })
    }

    /// Whether what is commanded lies in the range that the claim near rest is made for.
    fn fits_range(commands: &Commands, certificate: &Certificate) -> Result<(), &'static str> {
        let (setpoint_rad, load_rad) = (commands.setpoint_rad, commands.whole_load_rad());
        let fits =
            commands.is_allowed() && certificate.range.covers(Range { setpoint_rad, load_rad });
        fits.then_some(()).ok_or("flights: beyond the range of the claim")
    }

    /// Whether that does, and legs follow each other.
    fn fits(&self, certificate: &Certificate) -> Result<(), &'static str> {
        let Self { commands, legs, .. } = self;
        Self::fits_range(commands, certificate)?;
        let follow = legs.windows(2).all(|pair| pair[0].from_sample < pair[1].from_sample);
        let first = legs.first().is_some_and(|leg| leg.from_sample == 0 && leg.groups.len() == 1);
        if follow && first { Ok(()) } else { Err("flights: the legs do not follow each other") }
    }
}

impl Leg {
    /// What its groups begin with, each set of the leg before in one of them.
    fn starts(&self, flights: &Flights<'_>, sets: &[Set]) -> Result<Vec<Start>, &'static str> {
        let mut places: Vec<usize> = self.groups.iter().flat_map(|it| it.of.clone()).collect();
        places.sort_unstable();
        if !places.into_iter().eq(0..sets.len()) {
            return Err("flights: a set is in no group, or in two, or is not there");
        }
        let starts = self
            .groups
            .iter()
            .map(|group| Course::next(flights, sets, group.of.clone(), self.from_sample));
        starts.collect::<Option<_>>().ok_or("flights: a group of no set")
    }
}

impl Group {
    /// Whether its parts fill all that its sets are of.
    fn fills(&self, whole: Patch) -> Result<(), &'static str> {
        let fills = |ends: &[f64], [least, most]: [f64; 2]| {
            let follow = ends.windows(2).all(|pair| pair[0] <= pair[1]);
            let all = ends.first().is_some_and(|end| *end <= least)
                && ends.last().is_some_and(|end| *end >= most);
            follow && all && ends.len() >= 2
        };
        let filled =
            fills(&self.setpoints_rad, whole.setpoint) && fills(&self.loads_rad, whole.load);
        filled.then_some(()).ok_or("flights: the parts do not fill what is commanded")
    }
}

#[cfg(test)]
mod tests;
