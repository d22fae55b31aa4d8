//! What a certificate's file says of a family: what differs, forms, and parts with their plants.

use fspid_numeric::scalar::Interval;
use fspid_proof::check::PlantSet;
use fspid_proof::{Claim, Family, FamilyPart, Pace, Parameter, Patch, ScaledSensor};
use serde::{Deserialize, Serialize};

use super::file::ClaimFile;

/// Both ends of a number.
type Ends = [f64; 2];
/// A matrix of such.
type Rows = Vec<Vec<Ends>>;

/// A family as written.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FamilyFile {
    parameters: Vec<ParameterFile>,
    /// Each once, whatever the number of parts that it is about.
    claims: Vec<ClaimFile>,
    parts: Vec<PartFile>,
    /// How fast its numbers may move; left out where they stand still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pace: Option<PaceFile>,
}

/// In what time numbers may cross their ranges, s, and patches, which overlap by a share of the whole side.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PaceFile {
    crosses_in_s: f64,
    overlap: f64,
    patches: Vec<PatchFile>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PatchFile {
    ends: Vec<Ends>,
    /// Which of the claims.
    claim: usize,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterFile {
    name: String,
    paths: Vec<String>,
    relative: bool,
    inverse: bool,
    /// Whose scale error, %, it is; left out where it is a number of plant and actuator.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    sensors: Vec<SensorWord>,
    ends: Ends,
}

/// A sensor whose scale differs.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum SensorWord {
    Pitch,
    Rate,
}

impl SensorWord {
    fn of(sensor: ScaledSensor) -> Self {
        match sensor {
            ScaledSensor::Pitch => Self::Pitch,
            ScaledSensor::Rate => Self::Rate,
        }
    }

    fn build(self) -> ScaledSensor {
        match self {
            Self::Pitch => ScaledSensor::Pitch,
            Self::Rate => ScaledSensor::Rate,
        }
    }
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PartFile {
    ends: Vec<Ends>,
    plants: PlantsFile,
    /// Which of the claims.
    claim: usize,
}

/// Plants and actuators in continuous time: rows over states and command.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlantsFile {
    middle: Rows,
    all: Rows,
    slopes: Vec<Rows>,
    reach: Vec<f64>,
    pitch_rate: Vec<Ends>,
    without_lag: bool,
}

impl FamilyFile {
    pub(super) fn of(family: &Family) -> Self {
        let parameters = family.parameters.iter().map(|one| ParameterFile {
            name: one.name.clone(),
            paths: one.paths.clone(),
            relative: one.relative,
            inverse: one.inverse,
            sensors: one.sensors.iter().copied().map(SensorWord::of).collect(),
            ends: one.ends,
        });
        let mut claims: Vec<&Claim> = Vec::new();
        let mut parts = Vec::with_capacity(family.parts.len());
        for FamilyPart { ends, plants, claim } in &family.parts {
            let claim = place_of(claim, &mut claims);
            parts.push(PartFile { ends: ends.clone(), plants: PlantsFile::of(plants), claim });
        }
        let pace = family.pace.as_ref().map(|Pace { crosses_in_s, overlap, patches }| PaceFile {
            crosses_in_s: *crosses_in_s,
            overlap: *overlap,
            patches: patches
                .iter()
                .map(|Patch { ends, claim }| PatchFile {
                    ends: ends.clone(),
                    claim: place_of(claim, &mut claims),
                })
                .collect(),
        });
        let claims = claims.into_iter().map(ClaimFile::of).collect();
        Self { parameters: parameters.collect(), claims, parts, pace }
    }

    pub(super) fn build(self) -> Result<Family, String> {
        let claims: Vec<Claim> =
            self.claims.into_iter().map(ClaimFile::build).collect::<Result<_, _>>()?;
        let claim = |place: usize| {
            let there = || format!("a part has claim {place}; there are {}, from 0", claims.len());
            claims.get(place).cloned().ok_or_else(there)
        };
        let part = |part: PartFile| {
            let claim = claim(part.claim)?;
            Ok(FamilyPart { ends: part.ends, plants: part.plants.build()?, claim })
        };
        let pace = self.pace.map(|PaceFile { crosses_in_s, overlap, patches }| {
            let patch = |it: PatchFile| Ok(Patch { ends: it.ends, claim: claim(it.claim)? });
            let patches = patches.into_iter().map(patch).collect::<Result<_, String>>()?;
            Ok::<_, String>(Pace { crosses_in_s, overlap, patches })
        });
        let parameters = self.parameters.into_iter().map(|one| Parameter {
            name: one.name,
            paths: one.paths,
            relative: one.relative,
            inverse: one.inverse,
            sensors: one.sensors.into_iter().map(SensorWord::build).collect(),
            ends: one.ends,
        });
        Ok(Family {
            parameters: parameters.collect(),
            parts: self.parts.into_iter().map(part).collect::<Result<_, String>>()?,
            pace: pace.transpose()?,
        })
    }
}

/// The place of a claim among those that are there, where it is put if it is new.
fn place_of<'a>(claim: &'a Claim, claims: &mut Vec<&'a Claim>) -> usize {
    claims.iter().position(|it| *it == claim).unwrap_or_else(|| {
        claims.push(claim);
        claims.len() - 1
    })
}

impl PlantsFile {
    fn of(plants: &PlantSet) -> Self {
        let PlantSet { middle, all, slopes, reach, pitch_rate, without_lag } = plants;
        let rows = |rows: &Vec<Vec<Interval>>| rows.iter().map(|row| all_ends(row)).collect();
        Self {
            middle: rows(middle),
            all: rows(all),
            slopes: slopes.iter().map(rows).collect(),
            reach: reach.clone(),
            pitch_rate: all_ends(pitch_rate),
            without_lag: *without_lag,
        }
    }

    fn build(self) -> Result<PlantSet, String> {
        let rows = |rows: &Rows| -> Result<Vec<Vec<Interval>>, String> {
            rows.iter().map(|row| intervals(row)).collect()
        };
        Ok(PlantSet {
            middle: rows(&self.middle)?,
            all: rows(&self.all)?,
            slopes: self.slopes.iter().map(rows).collect::<Result<_, _>>()?,
            reach: self.reach,
            pitch_rate: intervals(&self.pitch_rate)?,
            without_lag: self.without_lag,
        })
    }
}

fn ends(value: Interval) -> Ends {
    [value.lower(), value.upper()]
}

fn all_ends(values: &[Interval]) -> Vec<Ends> {
    values.iter().copied().map(ends).collect()
}

fn interval([from, to]: Ends) -> Result<Interval, String> {
    Interval::new(from, to).ok_or_else(|| format!("from {from:?} to {to:?} is no interval"))
}

fn intervals(ends: &[Ends]) -> Result<Vec<Interval>, String> {
    ends.iter().copied().map(interval).collect()
}
