//! The answer of `certify --check` in words.

use fspid_proof::{Certificate, Claim, Rechecked};

use super::checked::{Answer, CheckedFile};
use super::comparison::Comparison;
use super::file::Seal;
use super::scope::Told;
use super::text::{Line, claim_lines, gains_line, push_lines, rechecked_line, refuted, sentence};

impl CheckedFile {
    /// The answer of `certify --check`.
    #[must_use]
    pub fn text(&self) -> String {
        let (certificate, origin) = (&self.certificate, &self.origin);
        let claims = match self.answer() {
            // The claim may well hold of its own loop.
            Answer::AnotherLoop => "a claim that DOES NOT HOLD FOR THIS SCENARIO: ",
            answer if answer.is_refused() => "a claim that DOES NOT HOLD: ",
            _ => "",
        };
        let mut out = format!(
            "{} of \"{}\": {claims}{}\n",
            origin.controller,
            origin.scenario,
            sentence(certificate)
        );
        push_lines(&mut out, claim_lines(certificate, self.result.as_ref().ok()));
        if let Ok(rechecked) = &self.result {
            push_lines(&mut out, [rechecked_line(rechecked)]);
            push_lines(&mut out, kept(certificate, rechecked));
            push_lines(&mut out, [gains_line(rechecked.bounds, Some(rechecked))]);
            push_lines(&mut out, self.told(rechecked).sentences());
        }
        push_seal(&mut out, &self.seal);
        if let Some(against) = &self.against {
            push_against(&mut out, against);
        }
        self.push_answer(&mut out);
        out
    }

    /// What is said beside the verdict.
    pub(super) fn told(&self, rechecked: &Rechecked) -> Told {
        match self.against {
            None => Told::read(&self.certificate, rechecked),
            Some(_) => Told::of(&self.certificate, rechecked),
        }
    }

    fn push_answer(&self, out: &mut String) {
        match (self.answer(), &self.result) {
            (Answer::Holds, _) => match &self.against {
                None => out.push_str("HOLDS\n"),
                Some(_) => out.push_str("HOLDS, AND IS WHAT FLIES\n"),
            },
            (Answer::Refutes(bearing), _) => {
                out.push_str(&format!("{}: {bearing}\n", refuted(bearing)));
            }
            (Answer::SaysNothing(bearing), _) => {
                out.push_str(&format!("NO PROOF OF THE FLOWN LOOP: {bearing}\n"));
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
                out.push_str(&format!("DOES NOT HOLD: {doubt}\n"));
            }
            (Answer::NotProved, Ok(_)) => out.push_str("DOES NOT HOLD\n"),
        }
    }
}

/// Whether the law of the loop keeps its gains to the rate that is claimed.
fn kept(certificate: &Certificate, rechecked: &Rechecked) -> Option<Line> {
    let kept = if rechecked.keeps_to_the_rate { "in every flight" } else { "not shown" };
    let is_asked = matches!(certificate.claim, Claim::BoundedRate(_));
    is_asked.then(|| ("law keeps to this", kept.to_owned()))
}

fn push_seal(out: &mut String, seal: &Seal) {
    match seal {
        Seal::Whole => {}
        Seal::Missing => out.push_str("  edited             it has no content_digest\n"),
        Seal::Broken { stated, content } => {
            out.push_str(&format!(
                "  edited             content_digest is {stated}, and its content gives {content}\n"
            ));
        }
    }
}

fn push_against(out: &mut String, against: &Comparison) {
    let Comparison { scenario, differences, partly, members, other_text } = against;
    match differences.len() {
        0 => out.push_str(&format!(
            "  against \"{scenario}\": every field of the loop is what flies\n"
        )),
        1 => out.push_str(&format!("  against \"{scenario}\": 1 field differs\n")),
        count => out.push_str(&format!("  against \"{scenario}\": {count} fields differ\n")),
    }
    for it in differences {
        out.push_str(&format!("    {}: certified {}, flown {}\n", it.path, it.certified, it.flown));
    }
    for told in partly.iter().chain(members) {
        out.push_str(&format!("  {told}\n"));
    }
    if let Some([certified, now]) = other_text {
        out.push_str(&format!(
            "  the scenario's text has changed: digest certified {certified}, now {now}\n"
        ));
    }
}
