//! Sensors in the feedback path.

use fspid_sim::SimError;
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorModel, SensorPreset};

use super::{judged, rad};
use crate::file::spec::sensor::{
    self as keys, Channel, DELAY_S, DRIFT_TIME_S, PERIOD_S, SCALE_ERROR_PCT,
};
use crate::keyed::Section;
use fspid_diagnostics::Report;

/// Sensors of pitch and pitch rate, none where no sensor is asked for.
pub(super) type Sensors = (Option<Sensor>, Option<Sensor>);

/// The sensors of the scenario.
pub(super) fn sensors(report: &mut Report, section: &Section) -> Option<Sensors> {
    let preset = SensorPreset::from_name(section.get(keys::PRESET)?)?;
    let seed = u64::try_from(section.get(keys::SEED)?).ok()?;
    let mut channel = |(key, own), model: SensorModel, channel: u32| {
        let part = section.get(key);
        let model = part.map_or(model, |part| changed(model, part, own));
        let sensor: Result<Sensor, SimError> = Sensor::new(model, seed, channel);
        judged(report, (section, keys::PRESET), sensor)
    };
    let pitch = channel((keys::PITCH, keys::OF_PITCH), preset.pitch, PITCH)?;
    let rate = channel((keys::RATE, keys::OF_RATE), preset.rate, RATE)?;
    Some((Some(pitch), Some(rate)))
}

/// The model with what a channel gives in place of its own; angles in degrees, or degrees a second.
fn changed(model: SensorModel, part: &Section, keys: Channel) -> SensorModel {
    let angle = |key, own: f64| part.get(key).map_or(own, rad);
    let plain = |key, own: f64| part.get(key).unwrap_or(own);
    SensorModel {
        noise_density: angle(keys.noise, model.noise_density),
        bias: angle(keys.bias, model.bias),
        drift: angle(keys.drift, model.drift),
        drift_time_s: plain(DRIFT_TIME_S, model.drift_time_s),
        scale_error: part.get(SCALE_ERROR_PCT).map_or(model.scale_error, |pct| pct / 100.0),
        resolution: angle(keys.resolution, model.resolution),
        period_s: plain(PERIOD_S, model.period_s),
        delay_s: plain(DELAY_S, model.delay_s),
        erection_rad_s: (keys.erection.and_then(|key| part.get(key)))
            .map_or(model.erection_rad_s, |deg_min| rad(deg_min) / 60.0),
    }
}
