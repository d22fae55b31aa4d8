//! An FMU as a controller, or as an aircraft: a step of the standard for each sample.

use std::path::{Path, PathBuf};

use fspid_sim::core::{Faults, Gains, Sample, Step};
use fspid_sim::external::Renamed;

use crate::description::{Description, Version};
use crate::fmi::{Failure, Fmu};
use crate::library::Refusal;
use crate::variables::Variable;

/// A controller of an FMU.
pub(crate) struct FmuController {
    description: Description,
    fmu: Fmu,
    dt_s: f64,
    /// Number of the next sample.
    sample: u64,
    is_plant: bool,
}

impl FmuController {
    /// Of an FMU that is unpacked in a folder, asked once in each period.
    pub(crate) fn load(
        folder: &Path,
        dt_s: f64,
        (renamed, is_plant): (&[Renamed], bool),
    ) -> Result<Self, Refusal> {
        let text =
            std::fs::read_to_string(folder.join("modelDescription.xml")).map_err(|error| {
                (format!("its modelDescription.xml cannot be read: {error}"), "an FMU".to_owned())
            })?;
        let description = match is_plant {
            true => Description::read_plant(&text, renamed)?,
            false => Description::read(&text, renamed)?,
        };
        let library = library(folder, &description)?;
        let fmu = Fmu::load(&library, &description, folder)?;
        Ok(Self { description, fmu, dt_s, sample: 0, is_plant })
    }

    /// Its period, s; 0 where it has none.
    pub(crate) fn period_s(&self) -> f64 {
        self.description.period_s
    }

    /// The answer to a sample, or the status with which there is none.
    pub(crate) fn step(&mut self, sample: &Sample<f64>) -> Result<Step<f64>, Failure> {
        let values = [sample.setpoint_rad, sample.measurement_rad, sample.rate_rad_s];
        let looks = self.is_plant && sample.setpoint_rad.is_nan();
        for (input, value) in self.description.inputs.into_iter().zip(values) {
            if let Some(Variable { reference, unit }) = input.filter(|_| !looks) {
                self.fmu.set(reference, value / unit)?;
            }
        }
        // An aircraft is asked where it starts before it flies: with an elevator that is no number.
        if !looks {
            self.fmu.step(self.sample as f64 * self.dt_s, self.dt_s)?;
            self.sample += 1;
        }
        let Description { command, gains: [kp, ki, kd], saturated, faults, .. } = self.description;
        let mut real = |variable: Option<Variable>| {
            variable.map_or(Ok(0.0), |it| self.fmu.real(it.reference).map(|value| value * it.unit))
        };
        let command_rad = real(Some(command))?;
        let gains = Gains { kp: real(kp)?, ki: real(ki)?, kd: real(kd)? };
        let saturated = saturated.map_or(Ok(false), |it| self.fmu.truth(it.reference))?;
        let faults = faults.map_or(Ok(0), |it| self.fmu.whole(it.reference))?;
        let faults = Faults::from_bits((faults & 0xff) as u8);
        Ok(Step { command_rad, gains, saturated, faults })
    }
}

/// The library for this machine, by the names of both versions: FMI 2.0 takes those of 3.0 as well.
fn library(folder: &Path, description: &Description) -> Result<PathBuf, Refusal> {
    let (arch, ending) = (std::env::consts::ARCH, std::env::consts::DLL_SUFFIX);
    let system = if cfg!(target_os = "macos") { "darwin" } else { std::env::consts::OS };
    let mut platforms = vec![format!("{arch}-{system}")];
    if description.version == Version::Two && arch == "x86_64" {
        platforms.insert(0, format!("{system}64"));
    }
    let name = format!("{}{ending}", description.identifier);
    let path = |platform: &String| folder.join("binaries").join(platform).join(&name);
    let found = platforms.iter().map(path).find(|path| path.is_file());
    found.ok_or_else(|| {
        let (reason, allowed) = (
            format!("has no library for {}", platforms.join(" or ")),
            format!("binaries/{}/{name}", platforms[0]),
        );
        (reason, allowed)
    })
}
