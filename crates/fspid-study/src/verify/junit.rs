//! The answer as JUnit XML, which continuous integration reads: a suite for the scenario, a case for each line.

use super::Verification;
use crate::judgement::Judgement;
use crate::simulation::FailedFlight;

impl Verification {
    /// JUnit XML. Every line has properties: the number, its limits, and its margin to the nearer of them. A line that is
    /// not met is a failure of type `not met`, one that could not be evaluated a failure of type `not evaluated`, a flight
    /// that fails by itself one of type `failed flight`; there are no errors, because input that cannot be used ends the
    /// program before.
    #[must_use]
    pub fn junit(&self, replays: Option<&[String]>) -> String {
        let flights = self.failed_flights.len();
        let (tests, failures) = (self.judgements.len() + flights, self.unmet() + flights);
        let name = escaped(&self.study.scenario.name);
        // No clock is read: times are 0, so that two runs write the same bytes.
        let counts = format!(
            "tests=\"{tests}\" failures=\"{failures}\" errors=\"0\" skipped=\"0\" time=\"0\""
        );
        let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
        out.push_str(&format!("<testsuites name=\"fspid verify\" {counts}>\n"));
        out.push_str(&format!("  <testsuite name=\"{name}\" {counts}>\n    <properties>\n"));
        for (key, value) in [("file", &self.path), ("digest", &self.study.digest)] {
            out.push_str(&format!(
                "      <property name=\"{key}\" value=\"{}\"/>\n",
                escaped(value)
            ));
        }
        out.push_str("    </properties>\n");
        for (index, judgement) in self.judgements.iter().enumerate() {
            let replay = replays.and_then(|replays| replays.get(index));
            out.push_str(&self.case(judgement, replay.map(String::as_str)));
        }
        for failed in &self.failed_flights {
            out.push_str(&self.flight(failed));
        }
        out.push_str("  </testsuite>\n</testsuites>\n");
        out
    }

    /// A flight that fails whatever is required of it.
    fn flight(&self, failed: &FailedFlight) -> String {
        let class = format!("{}.{}", self.study.scenario.name, failed.controller);
        let message = escaped(&failed.failures.join("; "));
        // One name each: a reader that keeps the last of two cases must not lose one.
        let name = failed.own_step_deg.map_or("flight".to_owned(), |step_deg| {
            format!(
                "flight with a step of {} deg",
                fspid_diagnostics::digits::to_digits(step_deg, 6)
            )
        });
        format!(
            "    <testcase name=\"{name}\" classname=\"{}\" time=\"0\">\n      <failure type=\"failed flight\" message=\"{message}\">{message}</failure>\n    </testcase>\n",
            escaped(&class)
        )
    }

    fn case(&self, judgement: &Judgement, replay: Option<&str>) -> String {
        let class = format!("{}.{}", self.study.scenario.name, judgement.controller);
        let head = format!(
            "    <testcase name=\"{}\" classname=\"{}\" time=\"0\"",
            escaped(&judgement.requirement.id),
            escaped(&class)
        );
        let properties = properties(judgement);
        if judgement.met {
            return format!("{head}>\n{properties}    </testcase>\n");
        }
        let kind = if judgement.found.is_ok() { "not met" } else { "not evaluated" };
        let requirement = &judgement.requirement;
        let message = format!(
            "{} of {}: {}, {}",
            requirement.measure.name(),
            judgement.controller,
            judgement.value_in_words(),
            requirement.limits_in_words()
        );
        let mut details = vec![message.clone()];
        let origin = &requirement.origin;
        details.extend(origin.source.as_ref().map(|source| {
            let confidence = origin.confidence.map(|confidence| format!(" ({confidence})"));
            format!("source: {source}{}", confidence.unwrap_or_default())
        }));
        let place = judgement.place();
        details.extend((!place.is_empty()).then(|| format!("worst case: {place}")));
        details.extend(replay.map(|replay| format!("replay: fspid verify {replay}")));
        format!(
            "{head}>\n{properties}      <failure type=\"{kind}\" message=\"{}\">{}</failure>\n    </testcase>\n",
            escaped(&message),
            escaped(&details.join("\n"))
        )
    }
}

/// The number, its limits, how far it is from the nearer one, and where it is worst.
fn properties(judgement: &Judgement) -> String {
    let requirement = &judgement.requirement;
    let number = |value: f64| format!("{value:?}");
    let value = judgement.found.as_ref().ok().map(|case| case.value);
    let own = judgement.own_step_deg.map(number);
    let place = judgement.place();
    let rows = [
        ("measure", Some(requirement.measure.name().to_owned())),
        ("unit", Some(requirement.measure.unit().to_owned()).filter(|unit| !unit.is_empty())),
        ("value", value.map(number)),
        ("least", requirement.least.map(number)),
        ("most", requirement.most.map(number)),
        // Above 0 inside of the limits, in the unit of the measure.
        ("margin", value.map(|value| number(requirement.slack(value)))),
        ("own_flight_step_deg", own),
        ("worst_case", (!place.is_empty()).then(|| place.to_string())),
    ];
    let row = |(name, value): (&str, Option<String>)| {
        let value = escaped(&value?);
        Some(format!("        <property name=\"{name}\" value=\"{value}\"/>\n"))
    };
    let rows: String = rows.into_iter().filter_map(row).collect();
    format!("      <properties>\n{rows}      </properties>\n")
}

/// A text as XML has it, in attributes and between tags; characters that no XML may hold become U+FFFD.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&apos;"),
            // As references, for attributes would turn them into blanks.
            '\n' => out.push_str("&#10;"),
            '\r' => out.push_str("&#13;"),
            '\t' => out.push_str("&#9;"),
            c if c < ' ' || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_that_means_something_to_xml_is_escaped() {
        assert_eq!(
            escaped("<a b=\"c\">&'\n\u{1}"),
            "&lt;a b=&quot;c&quot;&gt;&amp;&apos;&#10;\u{fffd}"
        );
    }
}
