//! What an FMU says of itself, as far as a controller is concerned.

use roxmltree::{Document, Node};

use crate::library::Refusal;

/// The version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Version {
    Two,
    Three,
}

/// A variable that is set or asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variable {
    /// Its value reference.
    pub(crate) reference: u32,
    /// One of it in radians, seconds.
    pub(crate) unit: f64,
}

/// What is needed of `modelDescription.xml`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Description {
    pub(crate) version: Version,
    pub(crate) identifier: String,
    pub(crate) token: String,
    /// Time from sample to sample, s; 0 where nobody says that there is one.
    pub(crate) period_s: f64,
    /// Set-point, measurement, rate.
    pub(crate) inputs: [Option<Variable>; 3],
    pub(crate) command: Variable,
    pub(crate) gains: [Option<Variable>; 3],
    pub(crate) saturated: Option<Variable>,
    pub(crate) faults: Option<Variable>,
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const ALLOWED: &str = "an FMU for co-simulation with inputs setpoint_rad and measurement_rad and an output command_rad, or all in degrees, as `fspid export --to fmu2` writes it";

impl Description {
    /// Reads it.
    pub(crate) fn read(text: &str) -> Result<Self, Refusal> {
        let refused = |reason: String| (reason, ALLOWED.to_owned());
        let document = Document::parse(text)
            .map_err(|error| refused(format!("its modelDescription.xml is no XML: {error}")))?;
        let root = document.root_element();
        let (version, token) = match root.attribute("fmiVersion").unwrap_or_default() {
            found if found.starts_with("2.") => (Version::Two, "guid"),
            found if found.starts_with("3.") => (Version::Three, "instantiationToken"),
            found => return Err(refused(format!("is of FMI version {found:?}"))),
        };
        let child = |name: &str| root.children().find(|node| node.has_tag_name(name));
        let interface = child("CoSimulation");
        let identifier = interface.and_then(|node| node.attribute("modelIdentifier"));
        let identifier =
            identifier.ok_or_else(|| refused("is none for co-simulation".to_owned()))?;
        if identifier.contains(['/', '\\']) || identifier.starts_with('.') {
            return Err(refused(format!("its model identifier {identifier:?} is no name")));
        }
        let variables = Variables(child("ModelVariables"));
        let needed = |name: &str| {
            let found = variables.angle(name, "Float64");
            found.ok_or_else(|| refused(format!("has no variable {name}_rad")))
        };
        Ok(Self {
            inputs: [Some(needed("setpoint")?), Some(needed("measurement")?), variables.rate()],
            command: needed("command")?,
            gains: ["kp", "ki", "kd"].map(|name| variables.named(name, "Float64")),
            saturated: variables.named("saturated", "Boolean"),
            faults: variables.named("faults", "Int32"),
            token: root.attribute(token).unwrap_or_default().to_owned(),
            identifier: identifier.to_owned(),
            period_s: period_s(&root, child("DefaultExperiment")),
            version,
        })
    }
}

/// The step that our own exports say is their period; of others it is a proposal.
fn period_s(root: &Node<'_, '_>, experiment: Option<Node<'_, '_>>) -> f64 {
    let is_ours = root.attribute("generationTool").is_some_and(|tool| tool.starts_with("fspid "));
    let step = experiment.and_then(|node| node.attribute("stepSize")?.parse().ok());
    step.filter(|_| is_ours).unwrap_or(0.0)
}

struct Variables<'a, 'b>(Option<Node<'a, 'b>>);

impl Variables<'_, '_> {
    /// The variable of that name, if it is of that type, in the words of FMI 3.0.
    fn named(&self, name: &str, kind: &str) -> Option<Variable> {
        let all = self.0.iter().flat_map(|node| node.children()).filter(Node::is_element);
        let mut mine = all.filter(|node| node.attribute("name") == Some(name));
        let node = mine.next()?;
        let of_two = match kind {
            "Float64" => "Real",
            "Int32" => "Integer",
            same => same,
        };
        let is_kind =
            node.has_tag_name(kind) || node.children().any(|node| node.has_tag_name(of_two));
        let reference = node.attribute("valueReference")?.parse().ok()?;
        is_kind.then_some(Variable { reference, unit: 1.0 })
    }

    /// An angle, in radians or in degrees.
    fn angle(&self, name: &str, kind: &str) -> Option<Variable> {
        let in_degrees = || {
            let found = self.named(&format!("{name}_deg"), kind)?;
            Some(Variable { unit: DEGREE, ..found })
        };
        self.named(&format!("{name}_rad"), kind).or_else(in_degrees)
    }

    /// The pitch rate, which not every controller has.
    fn rate(&self) -> Option<Variable> {
        let in_degrees = || {
            let found = self.named("rate_deg_s", "Float64")?;
            Some(Variable { unit: DEGREE, ..found })
        };
        self.named("rate_rad_s", "Float64").or_else(in_degrees)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_versions_are_read_and_what_is_missing_is_named() {
        let two = |command: &str| {
            format!(
                "<fmiModelDescription fmiVersion='2.0' guid='g' generationTool='fspid 1'><CoSimulation modelIdentifier='m'/>\
                 <DefaultExperiment stepSize='0.5'/><ModelVariables>\
                 <ScalarVariable name='setpoint_deg' valueReference='1'><Real/></ScalarVariable>\
                 <ScalarVariable name='measurement_deg' valueReference='2'><Real/></ScalarVariable>\
                 <ScalarVariable name='{command}' valueReference='3'><Real/></ScalarVariable>\
                 </ModelVariables></fmiModelDescription>"
            )
        };
        let found = Description::read(&two("command_deg")).expect("an FMU");
        assert_eq!((found.version, found.period_s), (Version::Two, 0.5));
        assert_eq!(found.command, Variable { reference: 3, unit: DEGREE });
        assert_eq!(found.inputs[2], None);
        let (reason, _) = Description::read(&two("something")).expect_err("no command");
        assert_eq!(reason, "has no variable command_rad");
        assert!(Description::read("<x fmiVersion='1.0'/>").is_err());
    }
}
