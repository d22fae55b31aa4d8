//! Walks the autopilot's modes in order and collects which quantity each of them holds.

use fspid_aircraft::trim::Power;
use fspid_aircraft::{Trim, TrimTarget};

use super::targets::{Targets, true_ones, written};
use super::wanted::{Air, Nowhere, Seeker, There, Wanted, Way};
use super::{Place, is_same};
use crate::aircraft::{AircraftPlant, Standing, pitch_rad};
use crate::autopilot::{AtLimits, Autopilot, Mode, Moves, OuterLoop, Quantity, Side};
use crate::controller::Controller;
use crate::led::{Led, Leg};
use crate::rest::has_integral;
use crate::scenario::Scenario;

/// A way that lasts no longer is flown through, s: the time in which the airspeed of an aircraft begins to follow its path.
const LASTS_S: f64 = 30.0;

/// Lift over weight of a bank that is passed over: the airspeed that a turn takes differs by a fortieth then.
const SLIGHT_LOAD: f64 = 1.05;

/// A part of what a mode is flown through.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub(super) there: Result<There, Nowhere>,
    pub(super) leg: Leg,
    /// What is flown there, where it is not the aircraft that the mode was asked with.
    pub(super) plant: Option<AircraftPlant>,
}

impl Stretch {
    fn of(leg: Leg, there: Result<There, Nowhere>) -> Self {
        Self { there, leg, plant: None }
    }

    /// True where nothing stands at a limit.
    fn is_free(&self) -> bool {
        self.there.as_ref().is_ok_and(|it| it.at_limits == AtLimits::default())
    }
}

/// Where a mode ends in straight flight, if it does.
pub(super) fn straight(stretches: &[Stretch]) -> Option<Trim> {
    let end = stretches.iter().find(|it| it.leg == Leg::End)?;
    end.there.ok().map(|it| it.trim)
}

/// A scenario, the trim that it starts from, and what its modes are to hold.
pub(super) struct Walk<'a> {
    scenario: &'a Scenario,
    pub(super) start: Trim,
    /// Pitch that is held where no loop moves it, rad.
    base_rad: f64,
    air: Air,
    written: Vec<Targets>,
    targets: Vec<Targets>,
}

impl<'a> Walk<'a> {
    /// With the pitch, rad from the trim, that the end of the flight holds.
    pub(super) fn new(scenario: &'a Scenario, aircraft: &AircraftPlant, pitch_rad: f64) -> Self {
        let start = *aircraft.trim();
        let autopilot = scenario.autopilot.as_ref();
        Self {
            scenario,
            start,
            base_rad: crate::aircraft::pitch_rad(&start) + pitch_rad,
            air: Air::of(scenario),
            written: autopilot.map(written).unwrap_or_default(),
            targets: autopilot.map(true_ones).unwrap_or_default(),
        }
    }

    pub(super) fn modes(&self) -> usize {
        self.scenario.autopilot.as_ref().map_or(0, |it| it.modes().len())
    }

    pub(super) fn mode(&self, number: usize) -> Option<(&Autopilot, &Mode)> {
        let autopilot = self.scenario.autopilot.as_ref()?;
        Some((autopilot, autopilot.modes().get(number)?))
    }

    pub(super) fn begins_s(&self, number: usize) -> f64 {
        self.mode(number).map_or(0.0, |(_, mode)| mode.entry.at_s)
    }

    /// False for a mode that another one ends soon, whatever there is.
    fn lasts(&self, number: usize) -> bool {
        let ends_s = self
            .mode(number + 1)
            .and_then(|(_, next)| next.entry.conditions.is_empty().then_some(next.entry.at_s));
        ends_s.is_none_or(|ends_s| ends_s - self.begins_s(number) > LASTS_S)
    }

    /// What is asked of where a mode leads; nothing where it was asked already or is not flown with that aircraft.
    pub(super) fn place(
        &self,
        (standing_number, standing): (usize, &Standing),
        number: usize,
        stretch: Stretch,
    ) -> Option<Place> {
        let Stretch { there, leg, plant: own } = stretch;
        let plant = standing.plant.as_ref()?;
        let is_mode = self.mode(number).is_some();
        if is_mode && standing.modes(self.scenario).iter().all(|(other, _)| *other != number) {
            return None;
        }
        let led = |airspeed_m_s: Option<f64>| {
            let target = self.most_telling(number);
            is_mode.then_some(Led { mode: number, target, airspeed_m_s, leg })
        };
        let place = |led, plant, at_limits| {
            Some(Place { standing: standing_number, led, plant, at_limits })
        };
        match there {
            Ok(There { trim, at_limits })
                if own.is_none()
                    && at_limits == AtLimits::default()
                    && is_same(&trim.target, &plant.trim().target) =>
            {
                None
            }
            Ok(There { trim, at_limits }) => {
                let plant = own.as_ref().unwrap_or(plant).at(trim);
                place(led(Some(trim.target.airspeed_m_s)), Some(plant), at_limits)
            }
            Err(Nowhere::NoFlight) => place(led(None), None, AtLimits::default()),
            Err(Nowhere::NotAsked) => None,
        }
    }

    /// The target of a mode that tells most of where it leads, among those that no other loop moves.
    fn most_telling(&self, number: usize) -> Option<(Quantity, f64)> {
        use Quantity::{Airspeed, Altitude, FlightPath, VerticalSpeed};
        let targets = self.written.get(number)?;
        let (autopilot, mode) = self.mode(number)?;
        let is_moved = |quantity: Quantity| {
            let mut engaged = mode.engaged.iter().filter(|&&number| {
                autopilot.loops().get(number).is_some_and(|it| it.holds == quantity)
            });
            engaged.any(|&number| mode.moves_target(autopilot, number))
        };
        [Airspeed, VerticalSpeed, FlightPath, Altitude]
            .into_iter()
            .filter(|&quantity| !is_moved(quantity))
            .find_map(|quantity| Some((quantity, (*targets.get(quantity.place())?)?)))
    }

    /// Where a mode leads an aircraft from where the one before it led, or from the start: first where it ends if it holds what
    /// it is to hold, then where else it may come to.
    pub(super) fn leads_to(
        &self,
        standing: &Standing,
        number: usize,
        from: Option<&Trim>,
    ) -> Vec<Stretch> {
        let Some(plant) = &standing.plant else {
            return vec![Stretch::of(Leg::End, Err(Nowhere::NotAsked))];
        };
        let came = self.came(from);
        let from_m_s = came.trim.target.airspeed_m_s;
        let seeker = Seeker { plant, air: self.air, from_m_s };
        let Some((autopilot, mode)) = self.mode(number) else {
            return vec![Stretch::of(Leg::End, seeker.end(&came.untouched(&seeker)))];
        };
        let engaged = Engaged { autopilot, mode };
        let turns = engaged.turns() && self.lasts(number);
        if turns && !engaged.holds_airspeed() {
            return vec![Stretch::of(Leg::Turn, Err(Nowhere::NoFlight))];
        }
        let mut held = self.held(&engaged, number, &came, &seeker);
        held.dedup();
        let ends = held.iter().map(|wanted| Stretch::of(Leg::End, seeker.end(wanted)));
        let on_the_way = held.iter().filter_map(|wanted| {
            let there = self.on_the_way(&engaged, number, wanted, &came, &seeker)?;
            Some(Stretch::of(Leg::OnTheWay, there))
        });
        let mut all: Vec<Stretch> = ends.chain(on_the_way).collect();
        if turns {
            // What stands at a limit in straight flight may be free in the turn, which is what lasts.
            let is_straight = all.iter().all(Stretch::is_free);
            all.retain(Stretch::is_free);
            // As if every loop had an integral: what else it may be in between is more or less of the same turn.
            let turn = held.first().map(|wanted| engaged.turning(wanted, &seeker));
            all.extend(turn.filter(|turn| !(is_straight && turn.is_free())));
        }
        all
    }

    /// From where a mode is flown.
    pub(super) fn came(&self, from: Option<&Trim>) -> Came {
        let theta_rad = from.map_or(self.base_rad, pitch_rad);
        Came { trim: *from.unwrap_or(&self.start), theta_rad }
    }

    /// What is held in a mode, all that it may be where loops have no integral.
    pub(super) fn held(
        &self,
        engaged: &Engaged<'_>,
        number: usize,
        came: &Came,
        seeker: &Seeker<'_>,
    ) -> Vec<Wanted> {
        let untouched = came.untouched(seeker);
        let (powers, throttle) = self.powers(engaged, number, &untouched, came.trim.target);
        let ways = self.ways(engaged, number, &untouched, came.trim.target);
        let altitude_m = self.target(number, Quantity::Altitude).unwrap_or(untouched.altitude_m);
        let ends = engaged.pitch().and_then(|it| it.ends());
        let range = ends.map(|ends| ends.map(|end| self.base_rad + end));
        let pitch_rad = range.filter(|_| engaged.holds().is_some());
        let is_gathered =
            matches!(engaged.holds(), Some(Quantity::Altitude | Quantity::GlideSlope));
        let with = |power| {
            let wanted =
                move |&way| Wanted { power, way, altitude_m, throttle, pitch_rad, is_gathered };
            ways.iter().map(wanted)
        };
        powers.into_iter().flat_map(with).collect()
    }

    /// What is written that a mode holds, as it is in truth.
    fn target(&self, number: usize, quantity: Quantity) -> Option<f64> {
        *self.targets.get(number)?.get(quantity.place())?
    }

    /// What makes the airspeed, and how far the throttle may go for it.
    fn powers(
        &self,
        engaged: &Engaged<'_>,
        number: usize,
        untouched: &Wanted,
        came: TrimTarget,
    ) -> (Vec<Power>, [f64; 2]) {
        let Some(mover) = engaged.throttle() else {
            return (vec![untouched.power], untouched.throttle);
        };
        let held = self.target(number, Quantity::Airspeed).unwrap_or(came.airspeed_m_s);
        let mut powers = vec![Power::Airspeed(held)];
        // Without an integral the airspeed ends somewhere between the one that is held and that of a throttle that stays.
        if !has_integral(mover.controller) {
            powers.push(untouched.power);
        }
        (powers, mover.within(untouched.throttle, self.start.point.throttle))
    }

    /// What makes the path.
    fn ways(
        &self,
        engaged: &Engaged<'_>,
        number: usize,
        untouched: &Wanted,
        came: TrimTarget,
    ) -> Vec<Way> {
        let written = |quantity: Quantity| self.target(number, quantity);
        let climb_m_s = came.airspeed_m_s * libm::sin(came.flight_path_rad) + self.air.up_m_s;
        let holds = engaged.holds();
        let way = match holds {
            None | Some(Quantity::Heading) => untouched.way,
            Some(Quantity::Altitude) => Way::OverGround(0.0),
            Some(Quantity::VerticalSpeed) => {
                Way::Climb(written(Quantity::VerticalSpeed).unwrap_or(climb_m_s))
            }
            Some(Quantity::FlightPath) => written(Quantity::FlightPath)
                .map_or(Way::Through(came.flight_path_rad), Way::OverGround),
            Some(Quantity::GlideSlope) => {
                let beam = engaged.autopilot.glide_slope();
                Way::OverGround(beam.map_or(0.0, |beam| -beam.angle_rad))
            }
            Some(Quantity::Airspeed) => {
                Way::Airspeed(written(Quantity::Airspeed).unwrap_or(came.airspeed_m_s))
            }
        };
        let mut ways = vec![way];
        // As of the airspeed without an integral, but for altitudes, which gather by themselves.
        let gathers = matches!(holds, Some(Quantity::Altitude | Quantity::GlideSlope));
        let outermost = engaged.outermost().filter(|_| !gathers);
        if let Some(outer) = outermost.filter(|it| !has_integral(&it.controller)) {
            ways.push(match outer.moves {
                Moves::Loop(_) => Way::Through(came.flight_path_rad),
                Moves::Pitch | Moves::Throttle | Moves::Bank => untouched.way,
            });
        }
        ways
    }

    /// The flight on the way to an altitude, where that lasts; none where no altitude is held by a path.
    fn on_the_way(
        &self,
        engaged: &Engaged<'_>,
        number: usize,
        wanted: &Wanted,
        came: &Came,
        seeker: &Seeker<'_>,
    ) -> Option<Result<There, Nowhere>> {
        let left_m = wanted.altitude_m - self.enters_at_m(number, came);
        let way = self.way_there(engaged, left_m)?;
        let airspeed_m_s = self.start.target.airspeed_m_s;
        let commanded_m_s = match way {
            Way::Climb(climb_m_s) => climb_m_s,
            Way::OverGround(path_rad) => airspeed_m_s * libm::tan(path_rad),
            Way::Pitch(theta_rad) => {
                airspeed_m_s * libm::sin(theta_rad - self.start.point.alpha_rad)
            }
            Way::Through(_) | Way::Airspeed(_) => return None,
        };
        let on_the_way = Wanted { way, is_gathered: false, ..*wanted };
        let there = seeker.end(&on_the_way).map_err(|_| Nowhere::NoFlight);
        let flown_m_s = there.as_ref().map_or(commanded_m_s, |it| seeker.climb_m_s(&it.trim));
        // Who goes the other way, as far as pitch and throttle may go, never comes there.
        let (climb_m_s, there) = match flown_m_s * left_m > 0.0 {
            true => (flown_m_s, there),
            false => (commanded_m_s, Err(Nowhere::NoFlight)),
        };
        (left_m.abs() > LASTS_S * climb_m_s.abs()).then_some(there)
    }

    /// The altitude at which a mode begins: the one that lets it begin, or where the mode before it led.
    fn enters_at_m(&self, number: usize, came: &Came) -> f64 {
        let came_m = came.trim.target.altitude_m;
        let conditions = self.mode(number).map_or(&[][..], |(_, mode)| &mode.entry.conditions);
        let of_altitude = conditions.iter().filter(|it| it.quantity == Quantity::Altitude);
        of_altitude.fold(came_m, |at_m, condition| match condition.side {
            Side::Above => at_m.max(condition.value),
            Side::Below => at_m.min(condition.value),
        })
    }

    /// How an altitude is come to that is so far: as fast as the loop that holds it commands.
    fn way_there(&self, engaged: &Engaged<'_>, left_m: f64) -> Option<Way> {
        if engaged.mode.total_energy {
            let most_rad = engaged.autopilot.total_energy()?.most_path_rad;
            return Some(Way::OverGround(most_rad.copysign(left_m)));
        }
        let outer = engaged.outermost().filter(|it| it.holds == Quantity::Altitude)?;
        let mover = Mover { controller: &outer.controller, per_unit: outer.units.moved };
        let by_gain = outer.units.held * outer.controller.nominal().kp * left_m / mover.per_unit;
        let [least, most] = mover.ends().unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let end = if left_m > 0.0 { most } else { least };
        // An integral, and gains that move, go to the end of what is allowed while the way lasts.
        let is_plain =
            matches!(outer.controller, Controller::Fixed(_)) && !has_integral(&outer.controller);
        let command = match is_plain || !end.is_finite() {
            true => by_gain.max(least).min(most),
            false => end,
        };
        match outer.moves {
            Moves::Pitch => Some(Way::Pitch(self.base_rad + command)),
            Moves::Loop(below) => match engaged.autopilot.loops().get(below)?.holds {
                Quantity::VerticalSpeed => Some(Way::Climb(command)),
                Quantity::FlightPath => Some(Way::OverGround(command)),
                _ => None,
            },
            Moves::Throttle | Moves::Bank => None,
        }
    }
}

/// From where a mode is flown.
pub(super) struct Came {
    trim: Trim,
    /// Pitch that stays where nobody moves it, rad.
    theta_rad: f64,
}

impl Came {
    /// What is held with nobody at throttle and pitch.
    fn untouched(&self, seeker: &Seeker<'_>) -> Wanted {
        Wanted {
            power: Power::Throttle(self.trim.point.throttle),
            way: Way::Pitch(self.theta_rad),
            altitude_m: self.trim.target.altitude_m,
            throttle: seeker.throttle(),
            pitch_rad: None,
            is_gathered: false,
        }
    }
}

/// What a mode engages.
pub(super) struct Engaged<'a> {
    pub(super) autopilot: &'a Autopilot,
    pub(super) mode: &'a Mode,
}

/// A controller and what it answers for one SI unit of what it moves.
#[derive(Clone, Copy)]
pub(super) struct Mover<'a> {
    controller: &'a Controller,
    per_unit: f64,
}

impl Mover<'_> {
    /// Ends of its command, counted from the trim, in SI units.
    pub(super) fn ends(&self) -> Option<[f64; 2]> {
        let limits = self.controller.config().limits?;
        Some([limits.lower() / self.per_unit, limits.upper() / self.per_unit])
    }

    /// As far as it goes within a travel, counted from where the trim has what it moves.
    fn within(&self, [least, most]: [f64; 2], trim: f64) -> [f64; 2] {
        let [lower, upper] = self.ends().unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        [least.max(trim + lower), most.min(trim + upper)]
    }
}

impl Engaged<'_> {
    fn loops(&self) -> impl Iterator<Item = (usize, &OuterLoop)> {
        let loops = self.autopilot.loops();
        self.mode.engaged.iter().filter_map(|&number| Some((number, loops.get(number)?)))
    }

    /// What moves the throttle.
    fn throttle(&self) -> Option<Mover<'_>> {
        let total = self.autopilot.total_energy().filter(|_| self.mode.total_energy);
        let by_energy = total.map(|it| Mover { controller: &it.energy, per_unit: 1.0 });
        by_energy.or_else(|| self.mover(Moves::Throttle))
    }

    /// What moves pitch.
    pub(super) fn pitch(&self) -> Option<Mover<'_>> {
        let total = self.autopilot.total_energy().filter(|_| self.mode.total_energy);
        let by_energy = total.map(|it| Mover { controller: &it.distribution, per_unit: 1.0 });
        by_energy.or_else(|| self.mover(Moves::Pitch))
    }

    fn mover(&self, moves: Moves) -> Option<Mover<'_>> {
        let found = self.loops().map(|(_, it)| it).find(|it| it.moves == moves)?;
        Some(Mover { controller: &found.controller, per_unit: found.units.moved })
    }

    /// True where the airspeed is one that is held, by throttle or by pitch.
    fn holds_airspeed(&self) -> bool {
        self.throttle().is_some() || self.holds() == Some(Quantity::Airspeed)
    }

    /// True where it flies a bank that is more than slight.
    fn turns(&self) -> bool {
        self.mover(Moves::Bank).is_none() && self.load() > SLIGHT_LOAD
    }

    /// Lift over weight in its bank.
    fn load(&self) -> f64 {
        1.0 / libm::cos(self.mode.bank_rad)
    }

    /// The turn that a mode flies, as a straight flight of an aircraft that is heavier by the load, which has the drag, the angle
    /// of attack and the thrust of the turn.
    fn turning(&self, wanted: &Wanted, straight: &Seeker<'_>) -> Stretch {
        let plant = straight.plant.under_load(self.load());
        let there = match &plant {
            Some(plant) => Seeker { plant, ..*straight }.end(wanted),
            None => Err(Nowhere::NoFlight),
        };
        Stretch { there, leg: Leg::InTurn, plant }
    }

    /// What it holds by pitch, in the end.
    fn holds(&self) -> Option<Quantity> {
        match self.mode.total_energy {
            true => Some(Quantity::Altitude),
            false => self.outermost().map(|it| it.holds),
        }
    }

    /// The loop that moves pitch in the end and that no other loop moves.
    pub(super) fn outermost(&self) -> Option<&OuterLoop> {
        let is_moved = |number: usize| self.loops().any(|(_, it)| it.moves == Moves::Loop(number));
        let of_path = |it: &OuterLoop| matches!(it.moves, Moves::Pitch | Moves::Loop(_));
        let mut found = self.loops().filter(|(number, it)| of_path(it) && !is_moved(*number));
        found.next().map(|(_, it)| it)
    }
}
