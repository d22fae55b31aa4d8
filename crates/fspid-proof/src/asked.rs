//! From a scenario to what a certificate is asked for.
//!
//! Everything of a scenario is taken apart by name here and in [`LoopDescription`], without `..`: a new
//! part does not compile until somebody has decided whether claims cover it, bound it, refuse it, or say
//! beside the verdict that they leave it out.

use fspid_sim::loop_model::Sensing;
use fspid_sim::sensor::{Sensor, SensorModel};
use fspid_sim::signal::{Disturbance, Entry};
use fspid_sim::{LinearPlant, Plant, Rest, Scenario, Steady, Surroundings, Weather};

use crate::description::LoopDescription;
use crate::scope::{Asked, LeftOut, Range};
use crate::steps::Commands;

impl Asked {
    /// What is asked of one of a scenario's loops: its set-points and loads, all that stand still at some time
    /// or are passed through.
    #[must_use]
    pub fn of(scenario: &Scenario, plant: &LinearPlant, description: &LoopDescription) -> Self {
        // The bias of the actuator is the description's.
        let steady = Steady { bias_rad: 0.0, ..scenario.steady() };
        // Of gains that move what outer loops command counts as well.
        let commanded_rad = scenario
            .commanded_rad()
            .filter(|_| Rest::depends_on_what_is_held(scenario, &description.controller))
            .map_or(0.0, |[least, most]| least.abs().max(most.abs()));
        let range = Range {
            setpoint_rad: steady.largest_setpoint_rad().max(commanded_rad),
            // What holds the trim of an aircraft that has become another is held as a load is.
            load_rad: steady.load_with_offsets_rad(plant, description.controller.config())
                + plant.held_away_rad().abs(),
        };
        Self { range, left_out: left_out_of(scenario), commands: Commands::of(scenario) }
    }
}

/// What of a scenario the claim of its loops does not speak of.
#[must_use]
pub fn left_out_of(scenario: &Scenario) -> Vec<LeftOut> {
    let Scenario {
        // A name changes nothing.
        name: _,
        plant,
        plant_changes,
        // Covered: the description has it.
        actuator: _,
        // The period is the controller's, checked when the scenario is built; a claim holds for any length.
        timing: _,
        // Bounded: the range.
        setpoint: _,
        disturbances,
        // Covered one by one.
        controllers: _,
        // Without equations, no loop of theirs is claimed.
        externals: _,
        surroundings,
        autopilot,
    } = scenario;
    let Surroundings { weather, pitch_sensor, rate_sensor } = surroundings;
    let sensors = || [pitch_sensor, rate_sensor].into_iter().flatten().map(Sensor::model);
    let noisy = sensors().any(is_noisy) || disturbances.iter().any(|one| one.is_noise());
    let present = |what: LeftOut| match what {
        LeftOut::Rounding | LeftOut::MovingSetpoint => true,
        LeftOut::NonlinearAircraft => matches!(plant, Plant::Aircraft(_) | Plant::External(_)),
        LeftOut::PlantChange => !plant_changes.is_empty(),
        LeftOut::MovingAir => weather.as_ref().is_some_and(moves),
        LeftOut::Noise => noisy,
        LeftOut::Drift => sensors().any(|model| model.drift > 0.0),
        LeftOut::BetweenSamples => {
            let part = |sensor: &Option<Sensor>| {
                Sensing::through(sensor.as_ref(), scenario.timing.dt_s()).part
            };
            part(pitch_sensor) > 0.0 || part(rate_sensor) > 0.0
        }
        LeftOut::SeenPitch => shows_wrongly(pitch_sensor, disturbances),
        LeftOut::Disturbances => disturbances.iter().any(|one| !one.is_noise()),
        // Known to the study alone.
        LeftOut::Dispersions | LeftOut::DrawnCommands | LeftOut::OtherChoices => false,
        LeftOut::OuterLoops => autopilot.is_some(),
        LeftOut::Configurations => {
            plant.aircraft().is_some_and(|plant| !plant.changing().is_still())
        }
    };
    LeftOut::ALL.into_iter().filter(|what| present(*what)).collect()
}

/// True where the pitch that is seen at rest is another than the aircraft's.
fn shows_wrongly(sensor: &Option<Sensor>, disturbances: &[Disturbance]) -> bool {
    let model = sensor.as_ref().map(Sensor::model);
    model.is_some_and(|it| it.scale_error != 0.0 || it.bias > 0.0)
        || disturbances.iter().any(|it| it.entry() == Entry::Measurement && !it.is_noise())
}

fn moves(weather: &Weather) -> bool {
    let Weather {
        // Where the air is met; without wind and turbulence it stands still.
        course: _,
        winds,
        turbulence,
    } = weather;
    !winds.is_empty() || turbulence.is_some()
}

fn is_noisy(model: &SensorModel) -> bool {
    let SensorModel {
        noise_density,
        // A constant bias is a load, see `Steady`; that it wanders is left out under its own name.
        bias: _,
        drift: _,
        drift_time_s: _,
        // Covered by the sensing of the description, or refused there.
        scale_error: _,
        resolution: _,
        period_s: _,
        delay_s: _,
        erection_rad_s: _,
    } = model;
    *noise_density > 0.0
}
