//! The autopilot from sample to sample.

pub(crate) use super::channel::Cut;
use super::channel::{Asked, Channel};
use super::glide_slope::Bearing;
use super::mode::Target;
use super::quantity::{Observed, Quantity};
use super::sample::AutopilotSample;
use super::total_energy::Rates;
use super::{Autopilot, Mode, Moves, OuterLoop, Units};
use crate::aircraft::AircraftPlant;
use crate::error::SimError;
use crate::math::turned_towards;
use crate::sensor::{Sensor, SensorState, Truth};
use crate::timing::Timing;
use fspid_aircraft::{ForceModel, Range};
use fspid_core::State;

/// What an autopilot commands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Commands {
    /// Pitch set-point, rad from the trim.
    pub(crate) pitch_rad: f64,
    /// Throttle, from the trim.
    pub(crate) throttle: f64,
    /// Bank, rad.
    pub(crate) bank_rad: f64,
    /// Aileron and rudder, rad, in place of what keeps the bank.
    pub(crate) lateral_rad: Option<[f64; 2]>,
}

/// Where an autopilot is.
#[derive(Clone, Debug)]
pub(crate) struct AutopilotState {
    mode: usize,
    /// For each loop: its controller, its sensor, and its target.
    channels: Vec<Channel>,
    sensors: Vec<Option<SensorState>>,
    targets: Vec<f64>,
    /// For each loop: what is left of the step to what it commands on a beam.
    fades: Vec<f64>,
    /// For each loop: what it sees at this sample.
    found: Vec<f64>,
    /// The heading, followed through whole turns, rad.
    heading_rad: f64,
    /// Of the throttle and of pitch by total energy.
    energy: [Channel; 2],
    /// What each quantity is held at; none before somebody holds it.
    held: [Option<f64>; Quantity::ALL.len()],
    bearing: Bearing,
    beam: [Option<SensorState>; 2],
    /// Angle above the beam, rad, and range, m, where there was one last.
    last_shown: [f64; 2],
    above_beam_m: f64,
    is_behind_beam: bool,
    commands: Commands,
    throttle: Throttle,
    /// Which way the throttle was cut by its travel.
    throttle_cut: Cut,
}

/// The throttle of an aircraft, in the measure of its data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Throttle {
    /// Where the trim has it.
    pub(crate) trim: f64,
    /// How far it goes.
    pub(crate) travel: Range,
}

impl Throttle {
    /// Of an aircraft at its trim.
    pub(crate) fn of(plant: &AircraftPlant) -> Self {
        let travel = plant.aircraft().model().travel().throttle;
        Self { trim: plant.trim().controls.throttle, travel }
    }
}

impl AutopilotState {
    /// In the first mode, nothing engaged yet.
    ///
    /// # Errors
    /// [`SimError::Number`] for sensors whose delay is too long for memory.
    pub(crate) fn start(
        autopilot: &Autopilot,
        dt_s: f64,
        throttle: Throttle,
    ) -> Result<Self, SimError> {
        let start = |sensor: &Option<Sensor>| sensor.map(|sensor| sensor.start(dt_s)).transpose();
        let beam = autopilot.glide_slope.as_ref();
        let sensors = autopilot.loops.iter().map(|outer| start(&outer.sensor));
        let mut state = Self {
            mode: 0,
            channels: vec![Channel::default(); autopilot.loops.len()],
            sensors: sensors.collect::<Result<_, _>>()?,
            targets: vec![0.0; autopilot.loops.len()],
            fades: vec![0.0; autopilot.loops.len()],
            found: vec![0.0; autopilot.loops.len()],
            heading_rad: 0.0,
            energy: [Channel::default(); 2],
            held: [None; Quantity::ALL.len()],
            bearing: Bearing::of(beam),
            beam: [
                start(&beam.and_then(|beam| beam.angle_sensor))?,
                start(&beam.and_then(|beam| beam.range_sensor))?,
            ],
            last_shown: [0.0; 2],
            above_beam_m: 0.0,
            is_behind_beam: false,
            commands: Commands::default(),
            throttle,
            throttle_cut: Cut::Not,
        };
        state.begin(autopilot);
        Ok(state)
    }

    /// What is commanded.
    pub(crate) fn commands(&self) -> Commands {
        self.commands
    }

    /// Number of the mode that has not begun yet, if there is one.
    pub(crate) fn waits_for(&self, autopilot: &Autopilot) -> Option<usize> {
        (self.mode + 1 < autopilot.modes.len()).then_some(self.mode + 1)
    }

    /// What a loop is held at, and what it commands from where it counts, both as its controller counts; none before it is
    /// engaged.
    pub(crate) fn held_by(&self, autopilot: &Autopilot, number: usize) -> Option<[f64; 2]> {
        let memory = self.channels.get(number)?.memory()?;
        let target = self.targets.get(number)?;
        Some([autopilot.loops.get(number)?.units.held * target, memory.command_rad])
    }

    /// What the engaged controllers remember.
    pub(crate) fn memories(&self) -> impl Iterator<Item = &State<f64>> {
        self.channels.iter().chain(&self.energy).filter_map(Channel::memory)
    }

    /// The same, to be moved.
    pub(crate) fn memories_mut(&mut self) -> impl Iterator<Item = &mut State<f64>> {
        self.channels.iter_mut().chain(&mut self.energy).filter_map(Channel::memory_mut)
    }

    /// What the sensors of its loops remember, each with the number of its loop, and those of its beam.
    pub(crate) fn sensors_mut(
        &mut self,
    ) -> impl Iterator<Item = (Option<usize>, &mut SensorState)> {
        let of_loops = self.sensors.iter_mut().enumerate();
        let of_loops = of_loops.filter_map(|(at, sensor)| Some((Some(at), sensor.as_mut()?)));
        of_loops.chain(self.beam.iter_mut().flatten().map(|sensor| (None, sensor)))
    }

    /// Answers a sample; `pitch_cut` says whether pitch below is cut.
    pub(crate) fn answer(
        &mut self,
        autopilot: &Autopilot,
        (k, timing): (usize, Timing),
        observed: &Observed,
        pitch_cut: Cut,
    ) -> AutopilotSample {
        self.look(autopilot, k, observed);
        self.change_mode(autopilot, (k, timing), observed);
        let Some((mode, order)) =
            autopilot.modes.get(self.mode).zip(autopilot.order.get(self.mode))
        else {
            return self.sample(autopilot, observed);
        };
        for &number in order {
            self.answer_loop(autopilot, number, observed, pitch_cut);
        }
        if mode.total_energy {
            self.answer_energy(autopilot, observed, pitch_cut);
        }
        self.limit_throttle();
        if !self.moves_bank(autopilot, mode) {
            self.commands.bank_rad = mode.bank_rad;
        }
        self.sample(autopilot, observed)
    }

    fn moves_bank(&self, autopilot: &Autopilot, mode: &Mode) -> bool {
        let engaged = mode.engaged.iter().filter_map(|&number| autopilot.loops.get(number));
        engaged.into_iter().any(|outer| outer.moves == Moves::Bank)
    }

    /// Keeps the throttle within its travel.
    fn limit_throttle(&mut self) {
        let Throttle { trim, travel } = self.throttle;
        let wanted = trim + self.commands.throttle;
        let kept = travel.clamp(wanted);
        self.throttle_cut = Cut::towards(wanted - kept);
        if self.throttle_cut != Cut::Not {
            self.commands.throttle = kept - trim;
        }
    }

    /// Reads every sensor, whoever is engaged: a sensor has to see each sample.
    fn look(&mut self, autopilot: &Autopilot, k: usize, observed: &Observed) {
        let shown =
            autopilot.glide_slope.as_ref().and_then(|beam| beam.shown(&self.bearing, observed));
        self.last_shown = shown.unwrap_or(self.last_shown);
        let ([angle, range], [angle_rad, range_m]) = (&mut self.beam, self.last_shown);
        let angle_rad = measured(angle.as_mut(), k, angle_rad);
        let range_m = measured(range.as_mut(), k, range_m);
        self.is_behind_beam = shown.is_none() && autopilot.glide_slope.is_some();
        if shown.is_some() {
            self.above_beam_m = range_m * libm::sin(angle_rad);
        }
        self.heading_rad = turned_towards(self.heading_rad, observed.heading_rad);
        let all = self.found.iter_mut().zip(&mut self.sensors).zip(&autopilot.loops);
        for ((found, sensor), outer) in all {
            // Across south a heading jumps: half way between both sides would be north, and a rate no turn flies.
            let value = outer.holds.value(observed, self.above_beam_m);
            let value = in_turn_of(outer.holds, self.heading_rad, value);
            *found = measured(sensor.as_mut(), k, value);
        }
    }

    /// Begins the next mode if everything is so.
    fn change_mode(
        &mut self,
        autopilot: &Autopilot,
        (k, timing): (usize, Timing),
        observed: &Observed,
    ) {
        let Some(next) = autopilot.modes.get(self.mode + 1).filter(|_| k > 0) else { return };
        let is_time = k >= timing.first_sample_at(next.entry.at_s);
        let value = |quantity: Quantity| quantity.value(observed, self.above_beam_m);
        if is_time && next.entry.conditions.iter().all(|it| it.is_met(value(it.quantity))) {
            self.mode += 1;
            self.begin(autopilot);
        }
    }

    /// Sets the targets of the mode and lets go what it does not engage.
    fn begin(&mut self, autopilot: &Autopilot) {
        let Some(mode) = autopilot.modes.get(self.mode) else { return };
        let mut kept = [false; Quantity::ALL.len()];
        for (number, (channel, outer)) in self.channels.iter_mut().zip(&autopilot.loops).enumerate()
        {
            if !mode.engaged.contains(&number) {
                channel.disengage();
            } else if channel.is_engaged() {
                kept[outer.holds.place()] = true;
            }
        }
        if !mode.total_energy {
            self.energy.iter_mut().for_each(Channel::disengage);
        } else if self.energy[0].is_engaged() {
            kept[Quantity::Altitude.place()] = true;
            kept[Quantity::Airspeed.place()] = true;
        }
        for (quantity, held) in Quantity::ALL.into_iter().zip(&mut self.held) {
            match mode.target(quantity) {
                Target::Value(value) => *held = Some(value),
                Target::Hold if !kept[quantity.place()] => *held = None,
                Target::Hold => {}
            }
        }
        // A beam is held at nothing but itself.
        self.held[Quantity::GlideSlope.place()] = Some(0.0);
    }

    fn answer_loop(
        &mut self,
        autopilot: &Autopilot,
        number: usize,
        observed: &Observed,
        pitch_cut: Cut,
    ) {
        let (Some(outer), Some(&found)) = (autopilot.loops.get(number), self.found.get(number))
        else {
            return;
        };
        if !self.is_moved(autopilot, number) {
            let held = self.held[outer.holds.place()]
                .get_or_insert_with(|| in_turn_of(outer.holds, 0.0, found));
            self.targets[number] = *held;
        }
        let target = in_turn_of(outer.holds, found, self.targets[number]);
        let (sign, base) = (outer.sign(), self.base(autopilot, outer, observed));
        let current = self.current(autopilot, outer, observed);
        let base = base.map_or(0.0, |base| base + self.faded(outer, number, current - base));
        let Units { held, moved } = outer.units;
        let asked = Asked {
            target: held * target,
            measured: held * found,
            rate: held * outer.holds.rate(observed, self.bearing.tangent),
            current: moved * sign * (current - base),
            blocked: self.blocked(outer, pitch_cut).through(sign),
        };
        let answer = self.channels[number].answer(&outer.controller, &asked);
        let command = base + sign * answer / moved;
        self.move_to(outer, command);
    }

    /// What a loop of the glide slope commands on the beam: the path of the beam itself. None for every other loop.
    fn base(&self, autopilot: &Autopilot, outer: &OuterLoop, observed: &Observed) -> Option<f64> {
        let (Quantity::GlideSlope, Moves::Loop(number), Some(beam)) =
            (outer.holds, outer.moves, autopilot.glide_slope.as_ref())
        else {
            return None;
        };
        match autopilot.loops.get(number).map(|below| below.holds)? {
            Quantity::FlightPath => Some(-beam.angle_rad),
            Quantity::VerticalSpeed => Some(-observed.ground_speed_m_s * self.bearing.tangent),
            _ => None,
        }
    }

    /// What is left of the step from what was commanded to what a beam commands: it goes at the rate limit of the loop, so
    /// that no integral has to carry it.
    fn faded(&mut self, outer: &OuterLoop, number: usize, step: f64) -> f64 {
        let is_engaged = self.channels.get(number).is_some_and(Channel::is_engaged);
        let Some(fade) = self.fades.get_mut(number) else { return 0.0 };
        let config = outer.controller.config();
        let most =
            config.slew_rad_s.map_or(f64::INFINITY, |it| it * config.dt_s / outer.units.moved);
        *fade = if is_engaged { *fade - fade.clamp(-most, most) } else { step };
        *fade
    }

    /// True for a loop whose target an engaged loop moves.
    fn is_moved(&self, autopilot: &Autopilot, number: usize) -> bool {
        autopilot.modes.get(self.mode).is_some_and(|mode| mode.moves_target(autopilot, number))
    }

    /// What stands now where a loop moves.
    fn current(&self, autopilot: &Autopilot, outer: &OuterLoop, observed: &Observed) -> f64 {
        match outer.moves {
            Moves::Pitch => self.commands.pitch_rad,
            Moves::Throttle => self.commands.throttle,
            Moves::Bank => self.commands.bank_rad,
            Moves::Loop(number) => match self.channels.get(number) {
                Some(channel) if channel.is_engaged() => self.targets[number],
                _ => autopilot
                    .loops
                    .get(number)
                    .map_or(0.0, |below| below.holds.value(observed, self.above_beam_m)),
            },
        }
    }

    fn blocked(&self, outer: &OuterLoop, pitch_cut: Cut) -> Cut {
        match outer.moves {
            Moves::Pitch => pitch_cut,
            Moves::Throttle => self.throttle_cut,
            Moves::Bank => Cut::Not,
            Moves::Loop(number) => self.channels.get(number).map_or(Cut::Not, |it| it.cut),
        }
    }

    fn move_to(&mut self, outer: &OuterLoop, command: f64) {
        match outer.moves {
            Moves::Pitch => self.commands.pitch_rad = command,
            Moves::Throttle => self.commands.throttle = command,
            Moves::Bank => self.commands.bank_rad = command,
            Moves::Loop(number) => {
                if let Some(target) = self.targets.get_mut(number) {
                    *target = command;
                }
            }
        }
    }

    fn answer_energy(&mut self, autopilot: &Autopilot, observed: &Observed, pitch_cut: Cut) {
        let Some(total) = autopilot.total_energy.as_ref() else { return };
        let [altitude_m, airspeed_m_s] = [
            (Quantity::Altitude, observed.altitude_m),
            (Quantity::Airspeed, observed.airspeed_m_s),
        ]
        .map(|(quantity, found)| *self.held[quantity.place()].get_or_insert(found));
        let [energy, distribution] = total.rates(observed, [altitude_m, airspeed_m_s]);
        let asked = |rates: Rates, current: f64, blocked: Cut| Asked {
            target: rates.commanded,
            measured: rates.found,
            rate: 0.0,
            current,
            blocked,
        };
        let Commands { pitch_rad, throttle, .. } = self.commands;
        let [by_throttle, by_pitch] = &mut self.energy;
        self.commands.throttle =
            by_throttle.answer(&total.energy, &asked(energy, throttle, self.throttle_cut));
        self.commands.pitch_rad =
            by_pitch.answer(&total.distribution, &asked(distribution, pitch_rad, pitch_cut));
    }

    fn sample(&self, autopilot: &Autopilot, observed: &Observed) -> AutopilotSample {
        let mut targets = Quantity::ALL.map(|quantity| quantity.value(observed, self.above_beam_m));
        let mode = autopilot.modes.get(self.mode);
        for &number in mode.iter().flat_map(|mode| &mode.engaged) {
            if let (Some(outer), Some(target)) =
                (autopilot.loops.get(number), self.targets.get(number))
            {
                targets[outer.holds.place()] = *target;
            }
        }
        for quantity in [Quantity::Altitude, Quantity::Airspeed] {
            let held = self.held[quantity.place()];
            if let (true, Some(held)) = (mode.is_some_and(|mode| mode.total_energy), held) {
                targets[quantity.place()] = held;
            }
        }
        AutopilotSample {
            // A sample that is no larger for a limit: it is copied with each.
            mode: u32::try_from(self.mode).unwrap_or(u32::MAX),
            targets,
            above_beam_m: self.above_beam_m,
            is_behind_beam: self.is_behind_beam,
            throttle: self.throttle.trim + self.commands.throttle,
            bank_rad: self.commands.bank_rad,
            is_limited: self.is_limited(autopilot, observed),
        }
    }

    fn is_limited(&self, autopilot: &Autopilot, observed: &Observed) -> bool {
        let total = autopilot.total_energy.as_ref().filter(|_| self.energy[0].is_engaged());
        let is_far = total.is_some_and(|total| total.is_limited(observed, self.held_by_energy()));
        let mut channels = self.channels.iter().chain(&self.energy);
        is_far || self.throttle_cut != Cut::Not || channels.any(Channel::is_limited)
    }

    /// Altitude, m, and airspeed, m/s, at which total energy holds; what nobody holds is no number.
    fn held_by_energy(&self) -> [f64; 2] {
        [Quantity::Altitude, Quantity::Airspeed]
            .map(|quantity| self.held[quantity.place()].unwrap_or(f64::NAN))
    }
}

fn measured(sensor: Option<&mut SensorState>, k: usize, value: f64) -> f64 {
    sensor.map_or(value, |sensor| sensor.measure(k, Truth { value, ..Truth::default() }))
}

/// A heading in the turn that is nearest to another; everything else, which has no turns, as it is.
fn in_turn_of(quantity: Quantity, other: f64, value: f64) -> f64 {
    match quantity {
        Quantity::Heading => turned_towards(other, value),
        _ => value,
    }
}
