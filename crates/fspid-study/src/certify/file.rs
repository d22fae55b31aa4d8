//! Certificates as files: JSON that is complete in itself, read back bit for bit.

use fspid_lti::Matrix;
use fspid_proof::{BoundedRate, Certificate, Claim, LeftOut, LoopDescription, Range};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::controller_file::ControllerFile;
use super::loop_file::LoopFile;

/// First words of every certificate.
const KIND: &str = "fspid stability certificate";
/// Version of the shape.
const SCHEMA: u32 = 2;
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
    origin: Origin,
    #[serde(rename = "loop")]
    plant: LoopFile,
    controller: ControllerFile,
    output_factor: f64,
    divisions: usize,
    range: RangeFile,
    not_in_this_claim: Vec<String>,
    claim: ClaimFile,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    level: Option<f64>,
}

/// Constant set-points and loads of the claim.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RangeFile {
    setpoint_rad: f64,
    load_rad: f64,
}

type Rows = Vec<Vec<f64>>;

#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
enum ClaimFile {
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
        #[serde(default, skip_serializing_if = "Option::is_none")]
        inputs: Option<[f64; 2]>,
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

/// A certificate as text.
#[must_use]
pub fn to_text(certificate: &Certificate, origin: &Origin) -> String {
    let file = CertificateFile {
        kind: KIND.to_owned(),
        schema: SCHEMA,
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
        claim: claim_file(&certificate.claim),
        level: certificate.level,
    };
    let value = serde_json::to_value(&file).unwrap_or_else(|error| json!(error.to_string()));
    format!("{value:#}\n")
}

/// Reads a certificate.
///
/// # Errors
/// What is wrong, in a sentence.
pub fn from_text(text: &str) -> Result<(Certificate, Origin), String> {
    if text.len() > MOST_BYTES {
        return Err(format!("longer than {MOST_BYTES} bytes"));
    }
    let value: Value = serde_json::from_str(text).map_err(|error| format!("no JSON: {error}"))?;
    if value.get("kind").and_then(Value::as_str) != Some(KIND) {
        return Err(format!("no certificate: `kind` is not \"{KIND}\""));
    }
    if value.get("schema").and_then(Value::as_u64) != Some(u64::from(SCHEMA)) {
        let old = match value.get("schema").and_then(Value::as_u64) {
            Some(1) => {
                ": a certificate of schema 1 does not say for which set-points it is made; certify anew"
            }
            _ => "",
        };
        return Err(format!("`schema` is {}; this program reads {SCHEMA}{old}", value["schema"]));
    }
    let file: CertificateFile = serde_json::from_value(value).map_err(|error| error.to_string())?;
    let controller = file.controller.build(file.plant.sample_period_s)?;
    let description: LoopDescription = file.plant.build(controller)?;
    let certificate = Certificate {
        description,
        output_factor: file.output_factor,
        divisions: file.divisions,
        range: Range { setpoint_rad: file.range.setpoint_rad, load_rad: file.range.load_rad },
        left_out: file
            .not_in_this_claim
            .iter()
            .map(|name| left_out(name))
            .collect::<Result<_, _>>()?,
        claim: file.claim.build()?,
        level: file.level,
    };
    Ok((certificate, file.origin))
}

fn left_out(name: &str) -> Result<LeftOut, String> {
    LeftOut::named(name).ok_or_else(|| {
        let known: Vec<&str> = LeftOut::ALL.into_iter().map(LeftOut::name).collect();
        format!("not_in_this_claim: \"{name}\"; allowed are {}", known.join(", "))
    })
}

fn rows(matrix: &Matrix) -> Rows {
    matrix.data().chunks(matrix.columns().max(1)).map(<[f64]>::to_vec).collect()
}

fn matrix(rows: &Rows) -> Result<Matrix, String> {
    Matrix::from_rows(rows).map_err(|error| error.to_string())
}

fn claim_file(claim: &Claim) -> ClaimFile {
    match claim {
        Claim::AnySpeed { form, rate } => {
            ClaimFile::StableAtAnySpeed { rate: *rate, form: rows(form) }
        }
        Claim::Tied { form, rate, multipliers } => ClaimFile::StableAsTiedToTheError {
            rate: *rate,
            form: rows(form),
            multipliers: multipliers.clone(),
        },
        Claim::BoundedRate(BoundedRate { ends, changes, forms, rate, inputs }) => {
            ClaimFile::StableAtBoundedRate {
                rate: *rate,
                ends: *ends,
                changes: *changes,
                forms: forms.each_ref().map(rows),
                inputs: *inputs,
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

impl ClaimFile {
    fn build(self) -> Result<Claim, String> {
        Ok(match self {
            Self::StableAtAnySpeed { rate, form } => Claim::AnySpeed { form: matrix(&form)?, rate },
            Self::StableAsTiedToTheError { rate, form, multipliers } => {
                Claim::Tied { form: matrix(&form)?, rate, multipliers }
            }
            Self::StableAtBoundedRate { rate, ends, changes, forms, inputs } => {
                let [constant, kp, ki, kd] = &forms;
                let forms = [matrix(constant)?, matrix(kp)?, matrix(ki)?, matrix(kd)?];
                Claim::BoundedRate(BoundedRate { ends, changes, forms, rate, inputs })
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
