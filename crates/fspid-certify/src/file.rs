//! Certificates as files: JSON that is complete in itself, read back bit for bit.
//!
//! A file is asked in this order, so that a short text that names much costs nothing: how long it is, whether
//! it is JSON, the shape of every key, and only then what its numbers make.

use fspid_lti::Matrix;
use fspid_proof::{BoundedRate, Certificate, Claim, LeftOut, Range};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::commanded_file::CommandedFile;
use super::controller_file::ControllerFile;
use super::digest::digest;
use super::disturbances_file::DisturbanceFile;
use super::family_file::FamilyFile;
use super::json_text;
use super::loop_file::LoopFile;
use super::no_certificate::NoCertificate;
use super::nonlinear_file::NonlinearFile;
use super::shape::{self, CERTIFICATE, Wrong};
use super::steps_file::StepsFile;

/// First words of every certificate.
const KIND: &str = "fspid stability certificate";
/// Version of the shape of a certificate's file.
pub const SCHEMA: u32 = 2;
/// Longest certificate that is read, bytes.
pub(super) const MOST_BYTES: usize = 10 << 20;

/// Where a certificate comes from; nothing of it carries the proof.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Version of the program that wrote it.
    pub program: String,
    /// Name of the scenario.
    pub scenario: String,
    /// SHA-256 of the scenario with everything it refers to, in hexadecimal digits.
    pub digest: String,
    /// Name of the controller.
    pub controller: String,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CertificateFile {
    kind: String,
    schema: u32,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    content_digest: Option<String>,
    origin: Origin,
    #[serde(rename = "loop")]
    plant: LoopFile,
    controller: ControllerFile,
    output_factor: f64,
    divisions: usize,
    range: RangeFile,
    not_in_this_claim: Vec<String>,
    limits: LimitsFile,
    claim: ClaimFile,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    level: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    steps: Option<StepsFile>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    commanded: Option<CommandedFile>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    family: Option<FamilyFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    disturbances: Vec<DisturbanceFile>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    nonlinear: Option<NonlinearFile>,
}

/// What becomes of limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum LimitsFile {
    /// The loop has none.
    NoneAreThere,
    /// The claim is about motions in which none acts, and the level says which.
    NoneActsWithinTheLevel,
    /// The claim leaves them out.
    LeftOut,
}

impl LimitsFile {
    const fn name(self) -> &'static str {
        match self {
            Self::NoneAreThere => "none-are-there",
            Self::NoneActsWithinTheLevel => "none-acts-within-the-level",
            Self::LeftOut => "left-out",
        }
    }
}

/// Constant set-points and loads of the claim.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RangeFile {
    setpoint_rad: f64,
    load_rad: f64,
}

pub(super) type Rows = Vec<Vec<f64>>;

#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum ClaimFile {
    StableAtAnySpeed {
        rate: f64,
        form: Rows,
    },
    StableAsTiedToTheError {
        rate: f64,
        form: Rows,
        multipliers: Vec<f64>,
    },
    StableAtBoundedRate {
        rate: f64,
        ends: [[f64; 2]; 3],
        changes: [f64; 3],
        forms: [Rows; 4],
    },
    UnstableWithFrozenGains {
        input: [f64; 2],
        factor: f64,
        form: Rows,
        direction: Vec<f64>,
    },
    UnstableWithASequenceOfGains {
        inputs: Vec<[f64; 2]>,
        factor: f64,
        form: Rows,
        direction: Vec<f64>,
    },
}

/// Whether a certificate is as it was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Seal {
    /// Its digest is that of its content.
    Whole,
    /// It has no digest.
    Missing,
    /// Something was changed after it was written: any key, names and digests of the origin as well.
    Broken {
        /// The digest that it states.
        stated: String,
        /// The digest of its content.
        content: String,
    },
}

/// A certificate's file, read and not yet checked.
#[derive(Clone, Debug)]
pub(super) struct Read {
    pub(super) certificate: Certificate,
    pub(super) origin: Origin,
    pub(super) seal: Seal,
}

/// A certificate as text.
#[must_use]
pub fn to_text(certificate: &Certificate, origin: &Origin) -> String {
    let mut file = CertificateFile {
        kind: KIND.to_owned(),
        schema: SCHEMA,
        content_digest: None,
        origin: origin.clone(),
        plant: LoopFile::of(&certificate.description),
        controller: ControllerFile::of(&certificate.description.controller),
        output_factor: certificate.output_factor,
        divisions: certificate.divisions,
        range: RangeFile {
            setpoint_rad: certificate.range.setpoint_rad,
            load_rad: certificate.range.load_rad,
        },
        not_in_this_claim: certificate.left_out.iter().map(|one| one.name().to_owned()).collect(),
        limits: limits_of(certificate),
        claim: ClaimFile::of(&certificate.claim),
        level: certificate.level,
        steps: certificate.steps.as_ref().map(StepsFile::of),
        commanded: certificate.commanded.as_ref().map(CommandedFile::of),
        family: certificate.family.as_ref().map(FamilyFile::of),
        disturbances: certificate.disturbances.iter().map(DisturbanceFile::of).collect(),
        nonlinear: certificate.nonlinear.as_ref().map(NonlinearFile::of),
    };
    file.content_digest = Some(file.content());
    let value = serde_json::to_value(&file).unwrap_or_else(|error| json!(error.to_string()));
    format!("{value:#}\n")
}

/// Reads a certificate; whether its claim holds is another question.
///
/// # Errors
/// Everything that is wrong with the text.
pub fn from_text(text: &str) -> Result<(Certificate, Origin), NoCertificate> {
    read(text).map(|read| (read.certificate, read.origin))
}

pub(super) fn read(text: &str) -> Result<Read, NoCertificate> {
    let whole = |what: String| NoCertificate::of(Wrong { path: String::new(), what });
    if text.len() > MOST_BYTES {
        return Err(whole(format!("longer than {MOST_BYTES} bytes")));
    }
    let (value, twice) =
        json_text::read(text).map_err(|error| whole(format!("no JSON: {error}")))?;
    if value.get("kind").and_then(Value::as_str) != Some(KIND) {
        return Err(whole(format!("no certificate: `kind` is not \"{KIND}\"")));
    }
    if value.get("schema").and_then(Value::as_u64) != Some(u64::from(SCHEMA)) {
        return Err(whole(other_schema(value.get("schema"))));
    }
    let problems = shape::problems(&CERTIFICATE, &value, &twice);
    if !problems.is_empty() {
        return Err(NoCertificate { problems });
    }
    let file: CertificateFile =
        serde_json::from_value(value).map_err(|error| whole(error.to_string()))?;
    file.build()
}

fn other_schema(found: Option<&Value>) -> String {
    let found = found.filter(|value| value.is_number()).map(Value::to_string);
    let found = found.unwrap_or_else(|| "no number".to_owned());
    let older = if found == "1" {
        "; certificates of schema 1 did not say what they cover: certify the scenario anew"
    } else {
        ""
    };
    format!("`schema` is {found}; this program reads {SCHEMA}{older}")
}

impl CertificateFile {
    /// The digest of everything that the file says but that digest.
    fn content(&self) -> String {
        let value = serde_json::to_value(self).unwrap_or(Value::Null);
        digest(&value, "content_digest")
    }

    fn seal(&self) -> Seal {
        let content = self.content();
        match &self.content_digest {
            None => Seal::Missing,
            Some(stated) if *stated == content => Seal::Whole,
            Some(stated) => Seal::Broken { stated: stated.clone(), content },
        }
    }

    /// The certificate, or everything that does not fit.
    fn build(self) -> Result<Read, NoCertificate> {
        let seal = self.seal();
        let mut problems = Vec::new();
        let dt_s = self.plant.sample_period_s;
        let controller = kept(&mut problems, "controller", self.controller.build(dt_s));
        let parts = self.plant.parts();
        let plant = parts.map_err(|wrong| problems.extend(wrong)).ok();
        let claim = kept(&mut problems, "claim", self.claim.build());
        let description = controller.zip(plant).and_then(|(controller, plant)| {
            let described = plant.with(controller).provable();
            kept(&mut problems, "loop", described.map_err(|error| error.to_string()))
        });
        let range = Range { setpoint_rad: self.range.setpoint_rad, load_rad: self.range.load_rad };
        let named = |name: &String| LeftOut::named(name).ok_or_else(|| unknown_left_out(name));
        let left_out = self.not_in_this_claim.iter().map(named).collect::<Result<Vec<_>, _>>();
        let left_out = kept(&mut problems, "not_in_this_claim", left_out);
        let steps = self.steps.as_ref().map(StepsFile::build).transpose();
        let steps = kept(&mut problems, "steps", steps);
        let commanded = self.commanded.as_ref().map(CommandedFile::build).transpose();
        let commanded = kept(&mut problems, "commanded", commanded);
        let family = kept(&mut problems, "family", self.family.map(FamilyFile::build).transpose());
        let disturbances = self.disturbances.iter().map(DisturbanceFile::build);
        let disturbances = disturbances.collect::<Result<Vec<_>, _>>();
        let disturbances = kept(&mut problems, "disturbances", disturbances);
        let nonlinear = self.nonlinear.map(NonlinearFile::build).transpose();
        let nonlinear = kept(&mut problems, "nonlinear", nonlinear);
        let more = steps.zip(commanded).zip(family).zip(disturbances.zip(nonlinear));
        let parts = description.zip(claim).zip(left_out).zip(more);
        let Some((
            ((description, claim), left_out),
            (((steps, commanded), family), (disturbances, nonlinear)),
        )) = parts
        else {
            return Err(NoCertificate { problems });
        };
        let certificate = Certificate {
            description,
            output_factor: self.output_factor,
            divisions: self.divisions,
            range,
            left_out,
            claim,
            level: self.level,
            steps,
            commanded,
            family,
            disturbances,
            nonlinear,
        };
        let stated = limits_of(&certificate);
        if self.limits != stated {
            let what =
                format!("says \"{}\" of a claim with \"{}\"", self.limits.name(), stated.name());
            return Err(NoCertificate::of(Wrong { path: "limits".to_owned(), what }));
        }
        Ok(Read { certificate, origin: self.origin, seal })
    }
}

/// What was built; a problem is kept with its path.
fn kept<T>(problems: &mut Vec<Wrong>, path: &str, built: Result<T, String>) -> Option<T> {
    built.map_err(|what| problems.push(Wrong { path: path.to_owned(), what })).ok()
}

fn unknown_left_out(name: &str) -> String {
    let known: Vec<&str> = LeftOut::ALL.into_iter().map(LeftOut::name).collect();
    format!("\"{name}\"; allowed are {}", known.join(", "))
}

/// What a certificate says of limits: bound to its level, so that neither can be taken away alone.
fn limits_of(certificate: &Certificate) -> LimitsFile {
    match (certificate.level, certificate.description.limits().is_empty()) {
        (Some(_), _) => LimitsFile::NoneActsWithinTheLevel,
        (None, true) => LimitsFile::NoneAreThere,
        (None, false) => LimitsFile::LeftOut,
    }
}

pub(super) fn rows(matrix: &Matrix) -> Rows {
    matrix.data().chunks(matrix.columns().max(1)).map(<[f64]>::to_vec).collect()
}

pub(super) fn matrix(rows: &Rows) -> Result<Matrix, String> {
    Matrix::from_rows(rows).map_err(|error| error.to_string())
}

impl ClaimFile {
    pub(super) fn of(claim: &Claim) -> Self {
        match claim {
            Claim::CommonQuadratic { form, rate } => {
                ClaimFile::StableAtAnySpeed { rate: *rate, form: rows(form) }
            }
            Claim::SProcedure { form, rate, multipliers } => ClaimFile::StableAsTiedToTheError {
                rate: *rate,
                form: rows(form),
                multipliers: multipliers.clone(),
            },
            Claim::BoundedRate(BoundedRate { ends, changes, forms, rate }) => {
                ClaimFile::StableAtBoundedRate {
                    rate: *rate,
                    ends: *ends,
                    changes: *changes,
                    forms: forms.each_ref().map(rows),
                }
            }
            Claim::FrozenGrowth { input, factor, form, direction } => {
                ClaimFile::UnstableWithFrozenGains {
                    input: *input,
                    factor: *factor,
                    form: rows(form),
                    direction: direction.clone(),
                }
            }
            Claim::SequenceGrowth { inputs, factor, form, direction } => {
                ClaimFile::UnstableWithASequenceOfGains {
                    inputs: inputs.clone(),
                    factor: *factor,
                    form: rows(form),
                    direction: direction.clone(),
                }
            }
        }
    }

    pub(super) fn build(self) -> Result<Claim, String> {
        Ok(match self {
            Self::StableAtAnySpeed { rate, form } => {
                Claim::CommonQuadratic { form: matrix(&form)?, rate }
            }
            Self::StableAsTiedToTheError { rate, form, multipliers } => {
                Claim::SProcedure { form: matrix(&form)?, rate, multipliers }
            }
            Self::StableAtBoundedRate { rate, ends, changes, forms } => {
                let [constant, kp, ki, kd] = &forms;
                let forms = [matrix(constant)?, matrix(kp)?, matrix(ki)?, matrix(kd)?];
                Claim::BoundedRate(BoundedRate { ends, changes, forms, rate })
            }
            Self::UnstableWithFrozenGains { input, factor, form, direction } => {
                Claim::FrozenGrowth { input, factor, form: matrix(&form)?, direction }
            }
            Self::UnstableWithASequenceOfGains { inputs, factor, form, direction } => {
                Claim::SequenceGrowth { inputs, factor, form: matrix(&form)?, direction }
            }
        })
    }
}

/// A text with the digest of its content, as somebody writes who edits with care; none for what has no shape.
#[cfg(test)]
pub(super) fn resealed(value: &Value) -> Option<String> {
    let mut file: CertificateFile = serde_json::from_value(value.clone()).ok()?;
    file.content_digest = Some(file.content());
    serde_json::to_string(&file).ok()
}
