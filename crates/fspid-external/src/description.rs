//! What an FMU says of itself, as far as a controller is concerned.

use fspid_sim::external::{Place, Renamed};
use roxmltree::{Document, Node};

use crate::library::Refusal;
use crate::variables::{Kind, Variable, Variables, child};

/// The version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Version {
    Two,
    Three,
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

const ALLOWED: &str = "an FMU for co-simulation with inputs setpoint_rad and measurement_rad and an output command_rad, or all in degrees, as `fspid export --to fmu2` writes it";

const ALLOWED_PLANT: &str = "an FMU for co-simulation with an input elevator_rad and outputs theta_rad and q_rad_s, or all in degrees";

impl Description {
    /// Reads that of a controller; variables that have other names than ours are named.
    pub(crate) fn read(text: &str, renamed: &[Renamed]) -> Result<Self, Refusal> {
        Self::read_as(text, renamed, false)
    }

    /// Reads that of an aircraft: its elevator is the first input, its pitch angle the command, its pitch rate the first gain.
    pub(crate) fn read_plant(text: &str, renamed: &[Renamed]) -> Result<Self, Refusal> {
        Self::read_as(text, renamed, true)
    }

    fn read_as(text: &str, renamed: &[Renamed], is_plant: bool) -> Result<Self, Refusal> {
        let allowed = if is_plant { ALLOWED_PLANT } else { ALLOWED };
        let refused = |reason: String| (reason, allowed.to_owned());
        let document = Document::parse(text)
            .map_err(|error| refused(format!("its modelDescription.xml is no XML: {error}")))?;
        let root = document.root_element();
        let (version, token) = match root.attribute("fmiVersion").unwrap_or_default() {
            found if found.starts_with("2.") => (Version::Two, "guid"),
            found if found.starts_with("3.") => (Version::Three, "instantiationToken"),
            found => return Err(refused(format!("is of FMI version {found:?}"))),
        };
        let interface = child(root, "CoSimulation");
        let identifier = interface.and_then(|node| node.attribute("modelIdentifier"));
        let identifier =
            identifier.ok_or_else(|| refused("is none for co-simulation".to_owned()))?;
        if identifier.contains(['/', '\\']) || identifier.starts_with('.') {
            return Err(refused(format!("its model identifier {identifier:?} is no name")));
        }
        let variables = Variables::of(root);
        let needed = |place| needed(&variables, place, renamed);
        let gain = |name| variables.read_if_there(name, Kind::Float64);
        if is_plant {
            return Ok(Self {
                inputs: [Some(needed(Place::Elevator)?), None, None],
                command: needed(Place::Pitch)?,
                gains: [Some(needed(Place::PitchRate)?), None, None],
                saturated: None,
                faults: None,
                token: root.attribute(token).unwrap_or_default().to_owned(),
                identifier: identifier.to_owned(),
                period_s: 0.0,
                version,
            });
        }
        let inputs = [
            Some(needed(Place::Setpoint)?),
            Some(needed(Place::Measurement)?),
            variables.at(Place::Rate, renamed)?,
        ];
        Ok(Self {
            inputs: each_once(inputs)?,
            command: needed(Place::Command)?,
            gains: ["kp", "ki", "kd"].map(gain),
            saturated: variables.read_if_there("saturated", Kind::Boolean),
            faults: variables.read_if_there("faults", Kind::Int32),
            token: root.attribute(token).unwrap_or_default().to_owned(),
            identifier: identifier.to_owned(),
            period_s: period_s(&root, child(root, "DefaultExperiment")),
            version,
        })
    }
}

/// A variable without which there is no controller, or no aircraft.
fn needed(
    variables: &Variables<'_, '_>,
    place: Place,
    renamed: &[Renamed],
) -> Result<Variable, Refusal> {
    variables.at(place, renamed)?.ok_or_else(|| {
        let (key, offered) = (place.key(false), variables.offered(place));
        let (option, kind, allowed) = match place {
            Place::Elevator => ("`inputs`", "inputs", ALLOWED_PLANT),
            Place::Pitch | Place::PitchRate => ("`outputs`", "outputs", ALLOWED_PLANT),
            Place::Command => ("--output", "outputs", ALLOWED),
            Place::Setpoint | Place::Measurement | Place::Rate => ("--input", "inputs", ALLOWED),
        };
        let way = format!("or {option} {key}=NAME with one of its {kind}: {offered}");
        (format!("has no variable {key}"), format!("{allowed}; {way}"))
    })
}

/// Refuses one variable in two places.
fn each_once(inputs: [Option<Variable>; 3]) -> Result<[Option<Variable>; 3], Refusal> {
    let [setpoint, measurement, rate] = inputs.map(|input| input.map(|it| it.reference));
    let is_twice = setpoint == measurement || rate == setpoint || rate == measurement;
    match is_twice {
        false => Ok(inputs),
        true => {
            let reason = "one of its variables stands for two inputs".to_owned();
            Err((reason, "a variable for each input".to_owned()))
        }
    }
}

/// The step that our own exports say is their period; of others it is a proposal.
fn period_s(root: &Node<'_, '_>, experiment: Option<Node<'_, '_>>) -> f64 {
    let is_ours = root.attribute("generationTool").is_some_and(|tool| tool.starts_with("fspid "));
    let step = experiment.and_then(|node| node.attribute("stepSize")?.parse().ok());
    step.filter(|_| is_ours).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use fspid_numeric::units::DEGREE_RAD;

    use super::*;

    /// Of FMI 3.0, as another tool might write it.
    const FOREIGN: &str = "<fmiModelDescription fmiVersion='3.0' instantiationToken='t'><CoSimulation modelIdentifier='m'/>\
        <UnitDefinitions><Unit name='deg'><BaseUnit rad='1' factor='0.0174532925199433'/></Unit>\
        <Unit name='deg/s'><BaseUnit rad='1' s='-1' factor='0.0174532925199433'/></Unit>\
        <Unit name='m'><BaseUnit m='1'/></Unit><Unit name='mrad'><BaseUnit rad='1' factor='0.001'/></Unit></UnitDefinitions>\
        <TypeDefinitions><Float64Type name='Angle' unit='rad'/></TypeDefinitions><ModelVariables>\
        <Float64 name='theta_ref' causality='input' valueReference='1' unit='deg'/>\
        <Float64 name='theta' causality='input' valueReference='2' declaredType='Angle'/>\
        <Float64 name='q' causality='input' valueReference='3' unit='deg/s'/>\
        <Float64 name='height' causality='input' valueReference='4' unit='m'/>\
        <Float64 name='fine' causality='input' valueReference='5' unit='mrad'/>\
        <Float64 name='many' causality='input' valueReference='6'><Dimension start='3'/></Float64>\
        <Float64 name='delta_e' causality='output' valueReference='7'/>\
        <Int32 name='mode' causality='output' valueReference='8'/>\
        </ModelVariables></fmiModelDescription>";

    fn foreign(names: &[&str]) -> Result<Description, Refusal> {
        let renamed = |text: &&str| {
            let (key, name) = text.split_once('=').expect("a name");
            let (place, in_degrees) = Place::of_key(key).expect("a place");
            Renamed { place, in_degrees, name: name.to_owned() }
        };
        Description::read(FOREIGN, &names.iter().map(renamed).collect::<Vec<_>>())
    }

    #[test]
    fn variables_of_other_names_are_found_with_their_units_and_signs() {
        let found =
            foreign(&["setpoint_deg=theta_ref", "measurement_rad=theta", "command_rad=-delta_e"]);
        let found = found.expect("an FMU");
        let [setpoint, measurement, rate] = found.inputs;
        assert_eq!(setpoint, Some(Variable { reference: 1, unit: DEGREE_RAD }));
        assert_eq!(measurement, Some(Variable { reference: 2, unit: 1.0 }));
        assert_eq!((rate, found.command), (None, Variable { reference: 7, unit: -1.0 }));
    }

    #[test]
    fn a_name_that_does_not_fit_is_refused_with_those_that_do() {
        let (input, output) = ("theta_ref, theta, q, height, fine", "delta_e");
        let base = ["setpoint_deg=theta_ref", "measurement_rad=theta", "command_rad=delta_e"];
        for (at, name, said, offered) in [
            (
                0,
                "setpoint_deg=thetaref",
                "has no input `thetaref`, did you mean `theta_ref`",
                input,
            ),
            (0, "setpoint_deg=zzz", "has no input `zzz`", input),
            (0, "setpoint_deg=delta_e", "its variable `delta_e` is no input but output", input),
            (0, "setpoint_deg=many", "its variable `many` is an array and no number", input),
            (2, "command_rad=mode", "its variable `mode` is Int32 and no number of 64", output),
            (2, "command_rad=\u{1b}[2J", "has no output `\\u{1b}[2J`", output),
            (
                0,
                "setpoint_rad=theta_ref",
                "is in deg, not as setpoint_rad says",
                "setpoint_deg=theta_ref",
            ),
            (0, "setpoint_deg=q", "its variable `q` is in deg/s", "rad or deg"),
            (0, "setpoint_deg=height", "its variable `height` is in m", "rad or deg"),
            (0, "setpoint_rad=fine", "its variable `fine` is in mrad, not as", "rad or deg"),
            (
                0,
                "setpoint_rad=theta",
                "one of its variables stands for two inputs",
                "a variable for",
            ),
        ] {
            let mut names = base;
            names[at] = name;
            let (reason, allowed) = foreign(&names).expect_err(name);
            assert!(
                reason.contains(said) && allowed.contains(offered),
                "{name}: {reason}; {allowed}"
            );
        }
    }

    #[test]
    fn both_versions_are_read_and_what_is_missing_is_named() {
        let two = |command: &str| {
            format!(
                "<fmiModelDescription fmiVersion='2.0' guid='g' generationTool='fspid 1'><CoSimulation modelIdentifier='m'/>\
                 <DefaultExperiment stepSize='0.5'/><ModelVariables>\
                 <ScalarVariable name='setpoint_deg' causality='input' valueReference='1'><Real/></ScalarVariable>\
                 <ScalarVariable name='measurement_deg' causality='input' valueReference='2'><Real/></ScalarVariable>\
                 <ScalarVariable name='{command}' causality='output' valueReference='3'><Real/></ScalarVariable>\
                 </ModelVariables></fmiModelDescription>"
            )
        };
        let found = Description::read(&two("command_deg"), &[]).expect("an FMU");
        assert_eq!((found.version, found.period_s), (Version::Two, 0.5));
        assert_eq!(found.command, Variable { reference: 3, unit: DEGREE_RAD });
        assert_eq!(found.inputs[2], None);
        let (reason, allowed) = Description::read(&two("something"), &[]).expect_err("no command");
        assert_eq!(reason, "has no variable command_rad");
        assert!(
            allowed.ends_with("or --output command_rad=NAME with one of its outputs: something")
        );
        assert!(Description::read("<x fmiVersion='1.0'/>", &[]).is_err());
    }
}
