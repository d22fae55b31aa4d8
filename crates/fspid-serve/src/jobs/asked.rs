//! What a job is asked to do, read from the body of a request.

use fspid_scenario::count::Count;
use serde_json::Value;

use super::campaign::Campaign;
use super::certify::Certify;
use super::check::Check;
use super::contest::Contest;
use super::tune::Tune;
use crate::answer::Refusal;
use crate::request::Fields;

/// What shall be done, and on which scenario.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    /// Id of the scenario.
    pub(crate) scenario: String,
    /// The options as they came, but for a whole certificate.
    pub(super) options: Value,
    pub(super) work: Work,
}

/// One of the kinds of long work, with its options.
#[derive(Clone, Debug)]
pub(super) enum Work {
    Tune(Tune),
    Campaign(Campaign),
    Contest(Contest),
    Certify(Certify),
    Check(Check),
}

/// Their names.
const KINDS: [&str; 5] = ["tune", "campaign", "contest", "certify", "check"];

impl Asked {
    /// Reads `{kind, id, options}`.
    pub(crate) fn read(mut fields: Fields) -> Result<Self, Refusal> {
        let (kind, scenario) = (fields.needed_text("kind")?, fields.needed_text("id")?);
        let mut options = fields.object("options")?;
        fields.end()?;
        let as_asked = options.json();
        let work = match kind.as_str() {
            "tune" => Work::Tune(Tune::read(&mut options)?),
            "campaign" => Work::Campaign(Campaign::read(&mut options)?),
            "contest" => Work::Contest(Contest::read(&mut options)?),
            "certify" => Work::Certify(Certify::read(&mut options)?),
            "check" => Work::Check(Check::read(&mut options)?),
            other => {
                let known = fspid_diagnostics::known_words(other, &KINDS);
                return Err(Refusal::wrong(format_args!("there is no job `{other}`{known}")));
            }
        };
        options.end()?;
        let options = match &work {
            Work::Check(check) => check.told(),
            _ => as_asked,
        };
        Ok(Self { scenario, options, work })
    }
}

impl Work {
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Tune(_) => "tune",
            Self::Campaign(_) => "campaign",
            Self::Contest(_) => "contest",
            Self::Certify(_) => "certify",
            Self::Check(_) => "check",
        }
    }

    /// Changes of the scenario before it is read, as `--set` takes them.
    pub(super) fn overrides(&self) -> &[String] {
        match self {
            Self::Tune(tune) => &tune.overrides,
            Self::Campaign(campaign) => &campaign.overrides,
            Self::Contest(contest) => &contest.overrides,
            Self::Certify(certify) => &certify.overrides,
            Self::Check(check) => &check.overrides,
        }
    }
}

/// A count within the limits that the program has for it.
pub(super) fn counted(
    options: &mut Fields,
    key: &'static str,
    limits: Count,
) -> Result<Option<u64>, Refusal> {
    let found = options.whole(key)?;
    found.map_or(Ok(()), |number| limits.check(number)).map_err(Refusal::wrong)?;
    Ok(found)
}
