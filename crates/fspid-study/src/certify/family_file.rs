//! What a certificate's file says of a family: what differs, forms, and parts with their plants.

use fspid_numeric::scalar::Interval;
use fspid_proof::check::{EnclosedLag, EnclosedPlant};
use fspid_proof::{Claim, Family, FamilyPart, Parameter};
use serde::{Deserialize, Serialize};

use super::file::ClaimFile;

/// Both ends of a number.
type Ends = [f64; 2];

/// A family as written.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FamilyFile {
    parameters: Vec<ParameterFile>,
    /// Each once, whatever the number of parts that it is about.
    claims: Vec<ClaimFile>,
    parts: Vec<PartFile>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterFile {
    name: String,
    paths: Vec<String>,
    relative: bool,
    ends: Ends,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PartFile {
    ends: Vec<Ends>,
    by_states: Vec<Vec<Ends>>,
    by_elevator: Vec<Ends>,
    pitch_rate: Vec<Ends>,
    lag: LagFile,
    /// Which of the claims.
    claim: usize,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "order", rename_all = "kebab-case", deny_unknown_fields)]
enum LagFile {
    None,
    First { time_constant_s: Ends },
    Second { natural_frequency_rad_s: Ends, damping: Ends },
}

impl FamilyFile {
    pub(super) fn of(family: &Family) -> Self {
        let parameters = family.parameters.iter().map(|one| ParameterFile {
            name: one.name.clone(),
            paths: one.paths.clone(),
            relative: one.relative,
            ends: one.ends,
        });
        let mut claims: Vec<&Claim> = Vec::new();
        let mut parts = Vec::with_capacity(family.parts.len());
        for FamilyPart { ends, plant, claim } in &family.parts {
            let known = claims.iter().position(|it| *it == claim);
            let place = known.unwrap_or_else(|| {
                claims.push(claim);
                claims.len() - 1
            });
            parts.push(PartFile {
                ends: ends.clone(),
                by_states: plant.by_states.iter().map(|row| all_ends(row)).collect(),
                by_elevator: all_ends(&plant.by_elevator),
                pitch_rate: all_ends(&plant.pitch_rate),
                lag: LagFile::of(plant.lag),
                claim: place,
            });
        }
        let claims = claims.into_iter().map(ClaimFile::of).collect();
        Self { parameters: parameters.collect(), claims, parts }
    }

    pub(super) fn build(self) -> Result<Family, String> {
        let claims: Vec<Claim> =
            self.claims.into_iter().map(ClaimFile::build).collect::<Result<_, _>>()?;
        let part = |part: PartFile| {
            let claim = claims.get(part.claim).ok_or_else(|| {
                format!("a part has claim {}; there are {}, from 0", part.claim, claims.len())
            })?;
            let rows = part.by_states.iter().map(|row| intervals(row));
            Ok(FamilyPart {
                ends: part.ends,
                plant: EnclosedPlant {
                    by_states: rows.collect::<Result<_, String>>()?,
                    by_elevator: intervals(&part.by_elevator)?,
                    pitch_rate: intervals(&part.pitch_rate)?,
                    lag: part.lag.build()?,
                },
                claim: claim.clone(),
            })
        };
        let parameters = self.parameters.into_iter().map(|one| Parameter {
            name: one.name,
            paths: one.paths,
            relative: one.relative,
            ends: one.ends,
        });
        Ok(Family {
            parameters: parameters.collect(),
            parts: self.parts.into_iter().map(part).collect::<Result<_, String>>()?,
        })
    }
}

impl LagFile {
    fn of(lag: EnclosedLag) -> Self {
        match lag {
            EnclosedLag::None => Self::None,
            EnclosedLag::First(time_s) => Self::First { time_constant_s: ends(time_s) },
            EnclosedLag::Second(frequency, damping) => {
                Self::Second { natural_frequency_rad_s: ends(frequency), damping: ends(damping) }
            }
        }
    }

    fn build(self) -> Result<EnclosedLag, String> {
        let above_zero = |ends: Ends| {
            let value = interval(ends)?;
            let good = value.lower() > 0.0;
            good.then_some(value).ok_or_else(|| "a lag's numbers are above 0".to_owned())
        };
        Ok(match self {
            Self::None => EnclosedLag::None,
            Self::First { time_constant_s } => EnclosedLag::First(above_zero(time_constant_s)?),
            Self::Second { natural_frequency_rad_s, damping } => {
                EnclosedLag::Second(above_zero(natural_frequency_rad_s)?, above_zero(damping)?)
            }
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
