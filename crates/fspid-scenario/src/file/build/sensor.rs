//! Sensors in the feedback path.

use fspid_sim::SimError;
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorModel, SensorPreset};

use super::{judged, rad};
use crate::file::section::Section;
use fspid_diagnostics::Report;

/// Sensors of pitch and pitch rate, none where no sensor is asked for.
pub(super) type Sensors = (Option<Sensor>, Option<Sensor>);

/// The sensors of the scenario.
pub(super) fn sensors(report: &mut Report, section: &Section) -> Option<Sensors> {
    let preset = SensorPreset::from_name(section.text("preset")?)?;
    let seed = u64::try_from(section.integer("seed")?).ok()?;
    let mut channel = |name: &str, model: SensorModel, channel: u32| {
        let part = section.section(name);
        let model = part.map_or(model, |part| changed(model, part));
        let sensor: Result<Sensor, SimError> = Sensor::new(model, seed, channel);
        judged(report, (section, "preset"), sensor)
    };
    let pitch = channel("pitch", preset.pitch, PITCH)?;
    let rate = channel("rate", preset.rate, RATE)?;
    Some((Some(pitch), Some(rate)))
}

/// The model with what a channel gives in place of its own; angles in degrees, or degrees a second.
fn changed(model: SensorModel, part: &Section) -> SensorModel {
    let angle = |name: &str, own: f64| {
        let keys = [format!("{name}_deg"), format!("{name}_deg_s")];
        keys.iter().find_map(|key| part.number(key)).map_or(own, rad)
    };
    let plain = |name: &str, own: f64| part.number(name).unwrap_or(own);
    let noise = ["noise_deg_rt_hz", "noise_deg_s_rt_hz"];
    SensorModel {
        noise_density: noise
            .iter()
            .find_map(|key| part.number(key))
            .map_or(model.noise_density, rad),
        bias: angle("bias", model.bias),
        drift: angle("drift", model.drift),
        drift_time_s: plain("drift_time_s", model.drift_time_s),
        scale_error: part.number("scale_error_pct").map_or(model.scale_error, |pct| pct / 100.0),
        resolution: angle("resolution", model.resolution),
        period_s: plain("period_s", model.period_s),
        delay_s: plain("delay_s", model.delay_s),
        erection_rad_s: part
            .number("erection_deg_min")
            .map_or(model.erection_rad_s, |deg_min| rad(deg_min) / 60.0),
    }
}
