//! The answer of `certify --check` in words.

use fspid_proof::{Certificate, Claim, Kept, Rechecked};

use super::against::Comparison;
use super::checked::{Answer, CheckedFile};
use super::file::Seal;
use super::scope::Told;
use super::text::{push_claim, push_rechecked, range, refuted, sentence};
use fspid_diagnostics::lines::line;

impl CheckedFile {
    /// The answer of `certify --check`.
    #[must_use]
    pub fn text(&self) -> String {
        let (certificate, origin) = (&self.certificate, &self.origin);
        let mut out = format!(
            "{} of \"{}\": {}\n",
            origin.controller,
            origin.scenario,
            sentence(certificate)
        );
        let dt_s = certificate.description.controller.config().dt_s;
        push_claim(&mut out, certificate, self.result.as_ref().ok(), dt_s);
        if let Ok(rechecked) = &self.result {
            push_rechecked(&mut out, rechecked);
            push_kept(&mut out, certificate, rechecked);
            let [kp, ki, kd] = rechecked.bounds.map(range);
            line(&mut out, format_args!("  gains              kp {kp}, ki {ki}, kd {kd}"));
            Told::of(certificate, rechecked).push(&mut out);
        }
        push_seal(&mut out, &self.seal);
        if let Some(against) = &self.against {
            push_against(&mut out, against);
        }
        self.push_answer(&mut out);
        out
    }

    fn push_answer(&self, out: &mut String) {
        match (self.answer(), &self.result) {
            (Answer::Holds, _) => match &self.against {
                None => out.push_str("HOLDS\n"),
                Some(_) => out.push_str("HOLDS, AND IS WHAT FLIES\n"),
            },
            (Answer::Refutes(bearing), _) => {
                line(out, format_args!("{}: {bearing}", refuted(bearing)));
            }
            (Answer::SaysNothing(bearing), _) => {
                line(out, format_args!("NO PROOF OF THE FLOWN LOOP: {bearing}"));
            }
            (Answer::Edited, _) => {
                out.push_str("DOES NOT HOLD: the certificate is not as it was written\n");
            }
            (Answer::AnotherLoop, _) => {
                out.push_str(
                    "DOES NOT HOLD FOR THIS SCENARIO: what flies is not what is certified\n",
                );
            }
            (Answer::NotProved, Err(doubt)) => {
                line(out, format_args!("DOES NOT HOLD: {doubt}"));
            }
            (Answer::NotProved, Ok(_)) => out.push_str("DOES NOT HOLD\n"),
        }
    }
}

/// Whether the law of the loop keeps its gains to the rate that is claimed.
fn push_kept(out: &mut String, certificate: &Certificate, rechecked: &Rechecked) {
    if !matches!(certificate.claim, Claim::BoundedRate(_)) {
        return;
    }
    let kept = match rechecked.kept {
        Some(Kept::Everywhere) => "in every flight",
        Some(Kept::WithinLevel) => "in flights that begin near enough to rest",
        None => "not shown",
    };
    line(out, format_args!("  law keeps to this  {kept}"));
}

fn push_seal(out: &mut String, seal: &Seal) {
    match seal {
        Seal::Whole => {}
        Seal::Missing => out.push_str("  edited             it has no content_digest\n"),
        Seal::Broken { stated, content } => {
            line(
                out,
                format_args!(
                    "  edited             content_digest is {stated}, and its content gives {content}"
                ),
            );
        }
    }
}

fn push_against(out: &mut String, against: &Comparison) {
    let Comparison { scenario, differences, other_text } = against;
    match differences.len() {
        0 => line(
            out,
            format_args!("  against \"{scenario}\": every field of the loop is what flies"),
        ),
        1 => line(out, format_args!("  against \"{scenario}\": 1 field differs")),
        count => line(out, format_args!("  against \"{scenario}\": {count} fields differ")),
    }
    for it in differences {
        line(out, format_args!("    {}: certified {}, flown {}", it.path, it.certified, it.flown));
    }
    if let Some([certified, now]) = other_text {
        line(
            out,
            format_args!(
                "  the scenario's text has changed: digest certified {certified}, now {now}"
            ),
        );
    }
}
