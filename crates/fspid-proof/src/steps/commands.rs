//! What a flight is commanded: its set-point and its loads over time, each as a share of the largest.

use fspid_numeric::scalar::Interval;
use fspid_sim::Scenario;
use fspid_sim::signal::Entry;

use crate::caps::MOST_CHANGES;

/// What changes again within so long, s, has not paused.
const PAUSE_S: f64 = 0.5;
/// Shares that are not further apart, as a part of themselves, are the same: what a quotient of another size is rounded to.
const SAME: f64 = 2.0 * f64::EPSILON;

/// What changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Along {
    /// The set-point.
    Setpoint,
    /// Loads.
    Load,
    /// Both of them.
    Both,
}

/// A signal that keeps a share of its size from sample to sample: from which sample on, and which share. Before the first it
/// is zero, after the last it stays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shares(pub Vec<(usize, f64)>);

impl Shares {
    /// Of a signal at each sample, in sizes of so much.
    fn of(values: &[f64], size: f64) -> Self {
        let mut before = 0.0_f64;
        let changes = values.iter().enumerate().filter_map(|(sample, value)| {
            let changed = (value - before) != 0.0;
            before = *value;
            // No share is a zero with a sign.
            changed.then_some((sample, value / size + 0.0))
        });
        Self(changes.collect())
    }

    /// The share from a sample on, where it changes there.
    pub(super) fn change(&self, sample: usize) -> Option<Interval> {
        let place = self.0.binary_search_by_key(&sample, |(from, _)| *from).ok()?;
        Some(self.enclosed(place))
    }

    /// The share before a sample.
    pub(super) fn before(&self, sample: usize) -> Interval {
        let passed = self.0.partition_point(|(from, _)| *from < sample);
        passed.checked_sub(1).map_or(Interval::ZERO, |place| self.enclosed(place))
    }

    /// A share with what the quotient has been rounded by.
    fn enclosed(&self, place: usize) -> Interval {
        let share = self.0.get(place).map_or(0.0, |(_, share)| *share);
        let off = SAME * share.abs();
        match share.abs() {
            0.0 | 1.0 => Interval::point(share),
            _ => Interval::between((share - off).next_down(), (share + off).next_up()),
        }
    }

    /// The largest magnitude.
    fn largest(&self) -> f64 {
        self.0.iter().map(|(_, share)| share.abs()).fold(0.0, f64::max)
    }

    /// True for the same changes, but for what shares are rounded by; none and the whole are flown without that.
    fn holds(&self, other: &Self) -> bool {
        let near = |one: f64, other: f64| match one.abs() {
            0.0 | 1.0 => (one - other) == 0.0,
            _ => (one - other).abs() <= SAME * one.abs(),
        };
        let mut pairs = self.0.iter().zip(&other.0);
        self.0.len() == other.0.len()
            && pairs
                .all(|((from, share), (other, of_other))| from == other && near(*share, *of_other))
    }

    /// Samples that rise, and shares of at most 1.
    fn is_allowed(&self) -> bool {
        let rising = self.0.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let within = self.0.iter().all(|(_, share)| share.abs() <= 1.0);
        rising && within && self.0.len() <= MOST_CHANGES
    }
}

/// A set-point and loads over time, each times any number up to its size.
#[derive(Clone, Debug, PartialEq)]
pub struct Commands {
    /// Largest set-point, rad from the trim.
    pub setpoint_rad: f64,
    /// Largest load, rad of elevator.
    pub load_rad: f64,
    /// The set-point.
    pub setpoint: Shares,
    /// Loads that are added to the servo's command.
    pub at_servo: Shares,
    /// Loads that are added to the elevator behind the servo.
    pub at_elevator: Shares,
}

impl Commands {
    /// What a scenario commands; nothing where it commands nothing.
    ///
    /// # Errors
    /// What in it is not flown in sets.
    pub fn of(scenario: &Scenario) -> Result<Option<Self>, &'static str> {
        // Noise, air that moves and what wanders are left out by their own names.
        let Scenario { plant_changes, autopilot, timing, .. } = scenario;
        if autopilot.is_some() {
            return Err("a set-point that an outer loop moves is not flown in sets");
        }
        if !plant_changes.is_empty() {
            return Err("a plant that changes in flight is not flown in sets");
        }
        if scenario.loads_rad(Entry::Measurement).is_some() {
            return Err("a disturbance of the measured pitch is not flown in sets");
        }
        let (setpoint, _) = scenario.setpoint.sampled(*timing);
        let loads = [Entry::Servo, Entry::Elevator]
            .map(|entry| scenario.loads_rad(entry).unwrap_or_default());
        let size = |values: &Vec<f64>| values.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        let setpoint_rad = size(&setpoint);
        let load_rad = loads.iter().map(size).fold(0.0, f64::max);
        if !(setpoint_rad > 0.0 || load_rad > 0.0) {
            return Ok(None);
        }
        // Either way: one sign stands for both, and the first change is upwards.
        let upwards = |first: Option<f64>| first.map_or(1.0, |first| 1.0_f64.copysign(first));
        let began = loads.iter().filter_map(|values| {
            values.iter().copied().enumerate().find(|(_, value)| value.abs() > 0.0)
        });
        let of_load = upwards(began.min_by_key(|(sample, _)| *sample).map(|(_, value)| value));
        let of_setpoint = upwards(setpoint.iter().copied().find(|value| value.abs() > 0.0));
        let [at_servo, at_elevator] = loads.map(|values| Shares::of(&values, of_load * load_rad));
        let setpoint = Shares::of(&setpoint, of_setpoint * setpoint_rad);
        let commands = Self { setpoint_rad, load_rad, setpoint, at_servo, at_elevator };
        if !commands.is_allowed() {
            return Err(
                "a set-point or a load that changes more than 4096 times is not flown in sets",
            );
        }
        Ok(Some(commands))
    }

    /// Set-point and load at the elevator step at the first sample; their sizes are those of who flies them.
    pub(super) fn step() -> Self {
        let step = || Shares(vec![(0, 1.0)]);
        let (setpoint, at_elevator) = (step(), step());
        Self {
            setpoint_rad: 0.0,
            load_rad: 0.0,
            setpoint,
            at_servo: Shares::default(),
            at_elevator,
        }
    }

    /// True for sizes and shares that a claim may have.
    pub(super) fn is_allowed(&self) -> bool {
        let Self { setpoint_rad, load_rad, setpoint, at_servo, at_elevator } = self;
        let sizes = [*setpoint_rad, *load_rad].into_iter();
        // A size is one that is reached, and without one nothing changes.
        let is_size = |size: f64, all: &[&Shares]| match size > 0.0 {
            true => all.iter().any(|it| it.largest() >= 1.0),
            false => all.iter().all(|it| it.0.is_empty()),
        };
        sizes.clone().all(|size| size >= 0.0 && size.is_finite())
            && sizes.sum::<f64>() > 0.0
            && [setpoint, at_servo, at_elevator].into_iter().all(Shares::is_allowed)
            && is_size(*setpoint_rad, &[setpoint])
            && is_size(*load_rad, &[at_servo, at_elevator])
    }

    /// The largest load that enters at servo and elevator together, rad.
    pub(super) fn whole_load_rad(&self) -> f64 {
        let [at_servo, at_elevator] =
            [&self.at_servo, &self.at_elevator].map(|it| Interval::point(it.largest()));
        ((at_servo + at_elevator) * Interval::point(self.load_rad)).upper()
    }

    /// The same, each up to a part of its size.
    #[must_use]
    pub fn scaled(&self, part: f64) -> Self {
        Self {
            setpoint_rad: part * self.setpoint_rad,
            load_rad: part * self.load_rad,
            ..self.clone()
        }
    }

    /// True where everything that `other` commands is one of these times some number.
    #[must_use]
    pub fn is_of_the_shape_of(&self, other: &Self) -> bool {
        let none = (other.setpoint_rad > 0.0 && !(self.setpoint_rad > 0.0))
            || (other.load_rad > 0.0 && !(self.load_rad > 0.0));
        let setpoint_rad = self.setpoint_rad.max(other.setpoint_rad);
        let load_rad = self.load_rad.max(other.load_rad);
        !none && Self { setpoint_rad, load_rad, ..self.clone() }.covers(other)
    }

    /// True where everything that `other` commands is one of these.
    #[must_use]
    pub fn covers(&self, other: &Self) -> bool {
        let same = |own: &Shares, other: &Shares, size: f64| !(size > 0.0) || own.holds(other);
        self.setpoint_rad >= other.setpoint_rad
            && self.load_rad >= other.load_rad
            && same(&self.setpoint, &other.setpoint, other.setpoint_rad)
            && same(&self.at_servo, &other.at_servo, other.load_rad)
            && same(&self.at_elevator, &other.at_elevator, other.load_rad)
    }

    /// From this sample on everything stays as it is.
    pub(super) fn last_change(&self) -> usize {
        let last = self.changes().map(|(sample, _)| sample).max();
        last.unwrap_or(0)
    }

    /// Where set-point and loads change, one after the other.
    fn changes(&self) -> impl Iterator<Item = (usize, Along)> + '_ {
        let of = |shares: &'_ Shares, along: Along| {
            shares.0.iter().map(move |(from, _)| (*from, along)).collect::<Vec<_>>()
        };
        let loads = [&self.at_servo, &self.at_elevator].into_iter();
        let loads = loads.flat_map(move |shares| of(shares, Along::Load));
        of(&self.setpoint, Along::Setpoint).into_iter().chain(loads)
    }

    /// Where legs begin, and what changes in each: a new one where after a pause something else changes than before.
    pub(super) fn legs(&self, dt_s: f64) -> Vec<(usize, Along)> {
        let mut changes: Vec<(usize, Along)> = self.changes().collect();
        changes.sort_by_key(|(from, _)| *from);
        let mut legs: Vec<(usize, Along)> = Vec::new();
        let mut before = None;
        for (from, along) in changes {
            let goes_on =
                before.is_some_and(|before: usize| ((from - before) as f64) * dt_s < PAUSE_S);
            before = Some(from);
            match legs.last_mut() {
                Some((_, of_leg)) if *of_leg == along => {}
                Some((_, of_leg)) if goes_on => *of_leg = Along::Both,
                _ => legs.push((from, along)),
            }
        }
        if let Some((from, _)) = legs.first_mut() {
            *from = 0;
        }
        legs
    }
}

#[cfg(test)]
mod tests {
    use fspid_sim::Timing;
    use fspid_sim::signal::{Disturbance, Interpolation, Profile, Shape};

    use super::*;
    use crate::rest::drawn::{self, Dice};

    const DT_S: f64 = 0.01;

    fn at(sample: u8) -> f64 {
        f64::from(sample) * DT_S
    }

    /// Two seconds with the set-point and the loads of nobody.
    fn nothing() -> Scenario {
        let mut scenario = drawn::scenario(&mut Dice::new(0));
        scenario.timing = Timing::new(DT_S, 2.0).expect("allowed");
        scenario.setpoint = Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed");
        scenario.disturbances.clear();
        scenario
    }

    fn steps(rows: &[(u8, f64)]) -> Profile {
        let (times, values) = rows.iter().map(|(sample, value)| (at(*sample), *value)).unzip();
        Profile::table(times, values, Interpolation::Hold).expect("a table")
    }

    fn load(entry: Entry, size_rad: f64, from: u8, samples: u8) -> Disturbance {
        let shape = Shape::Pulse { at_s: at(from), width_s: at(samples) };
        Disturbance::new(entry, size_rad, shape).expect("allowed")
    }

    fn of(scenario: &Scenario) -> Option<Commands> {
        Commands::of(scenario).expect("flown in sets")
    }

    fn shares(all: &[(usize, f64)]) -> Shares {
        Shares(all.to_vec())
    }

    /// A set-point, and loads before and behind the servo.
    fn example() -> Commands {
        Commands {
            setpoint_rad: 0.1,
            load_rad: 0.02,
            setpoint: shares(&[(10, 1.0), (60, -0.5), (110, 0.0)]),
            at_servo: shares(&[(5, 1.0)]),
            at_elevator: shares(&[(5, -0.25), (30, 0.5)]),
        }
    }

    fn changed(change: impl FnOnce(&mut Commands)) -> Commands {
        let mut commands = example();
        change(&mut commands);
        commands
    }

    #[test]
    fn signals_are_shares_of_the_largest_and_the_first_change_is_upwards() {
        let mut scenario = nothing();
        scenario.setpoint = steps(&[(3, -0.02), (5, 0.04), (7, 0.0)]);
        let [behind, before] = [(Entry::Elevator, -0.01, 4), (Entry::Servo, 0.005, 6)]
            .map(|(entry, size_rad, from)| load(entry, size_rad, from, 5));
        scenario.disturbances = vec![behind, before];
        let found = of(&scenario).expect("something");
        let expected = Commands {
            setpoint_rad: 0.04,
            load_rad: 0.01,
            setpoint: shares(&[(3, 0.5), (5, -1.0), (7, 0.0)]),
            at_servo: shares(&[(6, -0.5), (11, 0.0)]),
            at_elevator: shares(&[(4, 1.0), (9, 0.0)]),
        };
        assert_eq!(found, expected);
        // A zero with a sign would be written as such.
        let all = [&found.setpoint, &found.at_servo, &found.at_elevator];
        let zeros = all.iter().flat_map(|it| &it.0).filter(|(_, share)| share.abs() <= 0.0);
        let signs: Vec<u64> = zeros.map(|(_, share)| share.to_bits()).collect();
        assert_eq!(signs, [0; 3]);
    }

    #[test]
    fn a_set_point_alone_and_a_load_alone_are_commanded_and_nothing_is_not() {
        assert_eq!(of(&nothing()), None);
        let alone = Scenario { setpoint: steps(&[(3, -0.02)]), ..nothing() };
        let found = of(&alone).expect("something");
        assert_eq!(found.setpoint, shares(&[(3, 1.0)]));
        assert!(found.load_rad <= 0.0 && found.at_servo.0.is_empty());
        for (entry, size_rad) in [(Entry::Servo, 0.01), (Entry::Elevator, -0.01)] {
            let disturbances = vec![load(entry, size_rad, 2, 3)];
            let found = of(&Scenario { disturbances, ..nothing() }).expect("something");
            assert!(found.setpoint_rad <= 0.0 && found.setpoint.0.is_empty());
            let loads = if entry == Entry::Servo { &found.at_servo } else { &found.at_elevator };
            assert_eq!(*loads, shares(&[(2, 1.0), (5, 0.0)]));
        }
    }

    #[test]
    fn a_share_is_flown_with_all_that_is_taken_for_the_same() {
        let all = shares(&[(1, 0.0), (2, 1.0), (3, -1.0), (4, 0.3), (5, -0.7)]);
        for sample in 1..4 {
            let share = all.change(sample).expect("changes");
            assert!(share.width() <= 0.0, "{share:?}");
        }
        for (sample, share) in [(4, 0.3_f64), (5, -0.7)] {
            let flown = all.change(sample).expect("changes");
            assert!(flown.width() <= 4.0 * SAME * share.abs(), "{flown:?}");
            let near = |other: &f64| shares(&[(1, share)]).holds(&shares(&[(1, *other)]));
            let others = (-40_i8..=40).map(|part| share * (1.0 + f64::from(part) * 0.1 * SAME));
            let same: Vec<f64> = others.filter(near).collect();
            assert!(same.len() > 10, "{same:?}");
            // The quotients that were rounded to these.
            let around = same.iter().flat_map(|it| [it.next_down(), it.next_up()]);
            around.for_each(|it| assert!(flown.contains(it), "{flown:?} {it:e}"));
        }
        for share in [0.0_f64, 1.0, -1.0] {
            let holds = |other: f64| shares(&[(1, share)]).holds(&shares(&[(1, other)]));
            assert!(holds(share) && !holds(share.next_up()) && !holds(share.next_down()));
        }
        assert!(all.change(6).is_none() && all.change(0).is_none());
        assert!((all.before(3) - Interval::ONE).magnitude() <= 0.0);
    }

    #[test]
    fn commands_cover_smaller_ones_of_the_same_shape() {
        let own = example();
        assert!(own.covers(&own) && own.covers(&own.scaled(0.5)));
        // What is of no size is commanded nothing.
        let still = |it: &mut Commands| (it.setpoint_rad, it.setpoint) = (0.0, Shares::default());
        assert!(own.covers(&changed(still)));
        let free = |it: &mut Commands| {
            it.load_rad = 0.0;
            (it.at_servo, it.at_elevator) = (Shares::default(), Shares::default());
        };
        assert!(own.covers(&changed(free)));
        // A share that another size has rounded to another side.
        let rounded = changed(|it| it.setpoint.0[1].1 = (-0.5_f64).next_up());
        assert!(own.covers(&rounded) && rounded.covers(&own));
    }

    #[test]
    fn commands_cover_neither_larger_ones_nor_other_shapes_or_times() {
        let own = example();
        let others: [(&str, Commands); 13] = [
            ("larger set-point", changed(|it| it.setpoint_rad *= 1.1)),
            ("larger load", changed(|it| it.load_rad *= 1.1)),
            ("later set-point", changed(|it| it.setpoint.0[0].0 += 1)),
            ("later load at the servo", changed(|it| it.at_servo.0[0].0 += 1)),
            ("later load at the elevator", changed(|it| it.at_elevator.0[1].0 += 1)),
            ("other share", changed(|it| it.setpoint.0[1].1 = 0.5)),
            ("share that is off a little", changed(|it| it.setpoint.0[1].1 -= 2.0 * SAME)),
            ("share that is off by rounding twice", changed(|it| it.setpoint.0[1].1 += SAME)),
            ("other load at the servo", changed(|it| it.at_servo.0[0].1 = -1.0)),
            ("other load at the elevator", changed(|it| it.at_elevator.0[1].1 = 1.0)),
            ("another change", changed(|it| it.setpoint.0.push((200, 1.0)))),
            ("another load", changed(|it| it.at_servo.0.push((200, 0.0)))),
            ("one change less", changed(|it| it.at_elevator.0.truncate(1))),
        ];
        for (what, other) in others {
            assert!(!own.covers(&other), "{what}");
        }
    }

    #[test]
    fn commands_of_sizes_that_are_reached_and_samples_that_rise_are_allowed() {
        assert!(example().is_allowed());
        let still = |it: &mut Commands| (it.setpoint_rad, it.setpoint) = (0.0, Shares::default());
        assert!(changed(still).is_allowed());
        let behind =
            |it: &mut Commands| (it.at_servo, it.at_elevator.0[1].1) = (Shares::default(), 1.0);
        assert!(changed(behind).is_allowed());
        let many = |count: usize| Shares((0..count).map(|sample| (sample, 1.0)).collect());
        assert!(changed(|it| it.setpoint = many(MOST_CHANGES)).is_allowed());
        let refused: [(&str, Commands); 14] = [
            ("too many", changed(|it| it.setpoint = many(MOST_CHANGES + 1))),
            ("a sample twice", changed(|it| it.setpoint.0[1].0 = 10)),
            ("samples that fall", changed(|it| it.at_elevator.0[1].0 = 3)),
            ("a share above one", changed(|it| it.setpoint.0[1].1 = -1.5)),
            ("a load above one", changed(|it| it.at_elevator.0[1].1 = 1.5)),
            ("a share that is no number", changed(|it| it.at_elevator.0[1].1 = f64::NAN)),
            ("a set-point that is not reached", changed(|it| it.setpoint.0[0].1 = 0.5)),
            ("a load that is not reached", changed(|it| it.at_servo.0[0].1 = 0.5)),
            ("a set-point of no size", changed(|it| it.setpoint_rad = 0.0)),
            ("loads of no size", changed(|it| it.load_rad = 0.0)),
            (
                "a negative set-point",
                changed(|it| {
                    (it.setpoint_rad, it.setpoint) = (-0.01, Shares::default());
                }),
            ),
            ("a set-point without end", changed(|it| it.setpoint_rad = f64::INFINITY)),
            (
                "a load that is no number",
                changed(|it| {
                    it.load_rad = f64::NAN;
                    (it.at_servo, it.at_elevator) = (Shares::default(), Shares::default());
                }),
            ),
            (
                "nothing",
                Commands {
                    setpoint_rad: 0.0,
                    load_rad: 0.0,
                    setpoint: Shares::default(),
                    at_servo: Shares::default(),
                    at_elevator: Shares::default(),
                },
            ),
        ];
        for (what, commands) in refused {
            assert!(!commands.is_allowed(), "{what}");
        }
    }

    #[test]
    fn loads_at_servo_and_elevator_add_up_and_scale_with_the_set_point() {
        let own = example();
        assert!((own.whole_load_rad() - 1.5 * 0.02).abs() < 1e-15, "{}", own.whole_load_rad());
        let half = own.scaled(0.5);
        assert!((half.setpoint_rad - 0.05).abs() < 1e-15 && (half.load_rad - 0.01).abs() < 1e-15);
        assert_eq!(half.at_elevator, own.at_elevator);
    }

    #[test]
    fn a_leg_begins_where_after_a_pause_something_else_changes() {
        let legs = |setpoint: &[(usize, f64)], at_servo: &[(usize, f64)], dt_s: f64| {
            let of = |it: &mut Commands| {
                (it.setpoint, it.at_servo) = (shares(setpoint), shares(at_servo));
                it.at_elevator = Shares::default();
            };
            changed(of).legs(dt_s)
        };
        let loaded = [(20, 1.0)];
        // Half a second is a pause, and less is none; dt_s is a power of two, so that nothing is rounded.
        let dt_s = 0.0625;
        let paused = legs(&[(28, 1.0), (90, 0.0)], &loaded, dt_s);
        assert_eq!(paused, [(0, Along::Load), (28, Along::Setpoint)]);
        let both = legs(&[(27, 1.0), (90, 0.0)], &loaded, dt_s);
        assert_eq!(both, [(0, Along::Both), (90, Along::Setpoint)]);
        assert_eq!(legs(&[(28, 1.0)], &loaded, 0.5 * dt_s), [(0, Along::Both)]);
        assert_eq!(legs(&[(30, 1.0)], &loaded, 2.0), [(0, Along::Load), (30, Along::Setpoint)]);
        // The same again begins none, however long the pause.
        let again = legs(&[(50, 1.0), (500, 0.0)], &[(900, 1.0)], dt_s);
        assert_eq!(again, [(0, Along::Setpoint), (900, Along::Load)]);
    }
}
