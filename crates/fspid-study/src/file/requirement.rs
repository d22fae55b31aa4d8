//! What a response must meet.

use crate::file::report::Report;
use crate::file::section::Section;
use crate::metrics::Measure;

/// An upper bound of a measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// Name of the controller it is asked of; all of them if there is none.
    pub controller: Option<String>,
    /// What is measured.
    pub measure: Measure,
    /// Largest value that meets the requirement, in the unit of the measure.
    pub most: f64,
}

/// The requirements of a scenario whose controllers have these names.
pub(crate) fn requirements(
    report: &mut Report,
    sections: &[Section],
    names: &[&str],
) -> Vec<Requirement> {
    let mut requirements = Vec::new();
    for section in sections {
        let controller = section.text("controller");
        if let Some(name) = controller
            && !names.contains(&name)
        {
            let (place, path) = (section.at("controller"), section.path("controller"));
            report.value(place, &path, "no controller has this name", names.join(", "));
            continue;
        }
        let word = section.text("measure");
        let measure = word.and_then(Measure::from_name);
        if let (Some(measure), Some(most)) = (measure, section.number("most")) {
            let controller = controller.map(str::to_owned);
            requirements.push(Requirement { controller, measure, most });
        }
    }
    requirements
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::spec::MEASURES;

    #[test]
    fn every_measure_of_the_specification_exists() {
        assert_eq!(Measure::ALL.map(Measure::name), MEASURES);
    }
}
