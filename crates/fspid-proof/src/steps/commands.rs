//! What a flight is commanded: its set-point and its loads over time, each as a share of the largest.

use fspid_numeric::scalar::Interval;
use fspid_sim::Scenario;
use fspid_sim::signal::Entry;

/// Most changes of a signal.
pub const MOST_CHANGES: usize = 4096;
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

    /// True for the same changes, but for what shares are rounded by.
    fn is_same(&self, other: &Self) -> bool {
        let near = |one: f64, other: f64| (one - other).abs() <= SAME * one.abs();
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

    /// True where everything that `other` commands is one of these.
    #[must_use]
    pub fn covers(&self, other: &Self) -> bool {
        let same = |own: &Shares, other: &Shares, size: f64| !(size > 0.0) || own.is_same(other);
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
