//! The variables of an FMU: found by their names, and looked at before anything is set.

use fspid_diagnostics::nearest;
use fspid_numeric::units::DEGREE_RAD;
use fspid_sim::external::{Place, Renamed};
use roxmltree::Node;

use crate::library::Refusal;

/// Of a unit's factor: how far one that is written with some ten digits lies beside its own.
const SAME_UNIT: f64 = 1e-6;
/// Most names that a sentence lists.
const MOST_LISTED: usize = 20;
/// Most characters of a name in a sentence.
const MOST_SHOWN: usize = 60;

/// A variable that is set or asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variable {
    /// Its value reference.
    pub(crate) reference: u32,
    /// One of it in radians, seconds; less than 0 for one of the other sign.
    pub(crate) unit: f64,
}

/// The type of a variable, in the words of FMI 3.0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Float64,
    Int32,
    Boolean,
}

/// A variable as it is described.
#[derive(Clone, Copy)]
struct Described<'a, 'b> {
    /// What has its name.
    node: Node<'a, 'b>,
    /// What has its unit: in FMI 2.0 a part of it.
    of_type: Node<'a, 'b>,
    name: &'a str,
}

impl<'a, 'b> Described<'a, 'b> {
    fn of(node: Node<'a, 'b>) -> Option<Self> {
        let name = node.attribute("name")?;
        let is_type = |part: &Node<'_, '_>| {
            ["Real", "Integer", "Boolean"].iter().any(|tag| part.has_tag_name(*tag))
        };
        Some(Self { node, of_type: node.children().find(is_type).unwrap_or(node), name })
    }

    fn kind(&self) -> Option<Kind> {
        match self.of_type.tag_name().name() {
            "Real" | "Float64" => Some(Kind::Float64),
            "Integer" | "Int32" => Some(Kind::Int32),
            "Boolean" => Some(Kind::Boolean),
            _ => None,
        }
    }

    fn causality(&self) -> &'a str {
        self.node.attribute("causality").unwrap_or("local")
    }

    fn is_array(&self) -> bool {
        self.node.children().any(|part| part.has_tag_name("Dimension"))
    }

    fn reference(&self) -> Option<u32> {
        self.node.attribute("valueReference")?.parse().ok()
    }
}

/// All variables of a model description.
pub(crate) struct Variables<'a, 'b> {
    root: Node<'a, 'b>,
    all: Vec<Described<'a, 'b>>,
}

impl<'a, 'b> Variables<'a, 'b> {
    pub(crate) fn of(root: Node<'a, 'b>) -> Self {
        let all = child(root, "ModelVariables").into_iter().flat_map(|node| node.children());
        Self { root, all: all.filter_map(Described::of).collect() }
    }

    /// A variable that is read if it is there.
    pub(crate) fn read_if_there(&self, name: &str, kind: Kind) -> Option<Variable> {
        let found = self.named(name)?;
        let is_read = found.kind() == Some(kind) && !found.is_array();
        is_read.then_some(Variable { reference: found.reference()?, unit: 1.0 })
    }

    /// The variable of a place: the one that was named, or the one of exports in radians or in degrees, if it is there.
    pub(crate) fn at(
        &self,
        place: Place,
        renamed: &[Renamed],
    ) -> Result<Option<Variable>, Refusal> {
        if let Some(given) = renamed.iter().find(|it| it.place == place) {
            let (found, sign) = self.given(given)?;
            return self.angle(found, (place, given.in_degrees), sign).map(Some);
        }
        let ours = [false, true].map(|in_degrees| (place.key(in_degrees), in_degrees));
        for (name, in_degrees) in ours {
            if let Some(found) = self.named(name) {
                return self.angle(found, (place, in_degrees), 1.0).map(Some);
            }
        }
        Ok(None)
    }

    /// What an importer can name in a place, for people.
    pub(crate) fn offered(&self, place: Place) -> String {
        let names = self.candidates(place);
        let listed: Vec<String> = names.iter().take(MOST_LISTED).map(|name| shown(name)).collect();
        match (listed.len(), names.len() - listed.len()) {
            (0, _) => "of which it has none".to_owned(),
            (_, 0) => listed.join(", "),
            (_, more) => format!("{} and {more} more", listed.join(", ")),
        }
    }

    fn candidates(&self, place: Place) -> Vec<&'a str> {
        let wanted = direction(place);
        let is_one = |it: &&Described<'_, '_>| {
            it.causality() == wanted && it.kind() == Some(Kind::Float64) && !it.is_array()
        };
        self.all.iter().filter(is_one).map(|it| it.name).collect()
    }

    fn named(&self, name: &str) -> Option<Described<'a, 'b>> {
        self.all.iter().find(|it| it.name == name).copied()
    }

    /// The variable that a user has named, and its sign.
    fn given(&self, given: &Renamed) -> Result<(Described<'a, 'b>, f64), Refusal> {
        if let Some(found) = self.named(&given.name) {
            return Ok((found, 1.0));
        }
        let bare = given.name.strip_prefix('-').unwrap_or(&given.name);
        if let Some(found) = self.named(bare) {
            return Ok((found, -1.0));
        }
        let (place, name) = (given.place, shown(bare));
        let meant = nearest(bare, &self.candidates(place));
        let meant = meant.map_or_else(String::new, |it| format!(", did you mean `{}`", shown(it)));
        let reason = format!("has no {} `{name}`{meant}", direction(place));
        Err((reason, format!("one of its {}s: {}", direction(place), self.offered(place))))
    }

    /// A variable as an angle, once everything that is said of it fits.
    fn angle(
        &self,
        found: Described<'_, '_>,
        (place, in_degrees): (Place, bool),
        sign: f64,
    ) -> Result<Variable, Refusal> {
        let (name, wanted) = (shown(found.name), direction(place));
        let refused = |what: String| {
            let offered = self.offered(place);
            Err((
                format!("its variable `{name}` {what}"),
                format!("one of its {wanted}s: {offered}"),
            ))
        };
        if found.causality() != wanted {
            return refused(format!("is no {wanted} but {}", found.causality()));
        }
        if found.kind() != Some(Kind::Float64) || found.is_array() {
            let kind = if found.is_array() { "an array" } else { found.of_type.tag_name().name() };
            return refused(format!("is {kind} and no number of 64 bits"));
        }
        let Some(reference) = found.reference() else {
            return refused("has no value reference".to_owned());
        };
        let unit = if in_degrees { DEGREE_RAD } else { 1.0 };
        match self.unit(found, place) {
            Unit::Unsaid => {}
            Unit::Angle(factor) if is_near(factor, unit) => {}
            Unit::Angle(factor) => {
                let other = [(1.0, false), (DEGREE_RAD, true)].into_iter();
                let other = other.filter(|(unit, _)| is_near(factor, *unit));
                let keys: Vec<String> = other
                    .map(|(_, in_degrees)| format!("{}={name}", place.key(in_degrees)))
                    .collect();
                let (key, declared) = (place.key(in_degrees), shown(self.declared(found)));
                let reason = format!("its variable `{name}` is in {declared}, not as {key} says");
                let allowed = keys.first().cloned();
                return Err((reason, allowed.unwrap_or_else(|| ANGLES.to_owned())));
            }
            Unit::Other => {
                let declared = shown(self.declared(found));
                return Err((format!("its variable `{name}` is in {declared}"), ANGLES.to_owned()));
            }
        }
        Ok(Variable { reference, unit: sign * unit })
    }

    /// The unit that a variable is said to have; empty for none.
    fn declared(&self, found: Described<'a, 'b>) -> &'a str {
        let of_type = || {
            let name = found.of_type.attribute("declaredType")?;
            let types = child(self.root, "TypeDefinitions")?;
            let found = types.children().find(|it| it.attribute("name") == Some(name))?;
            let real = child(found, "Real").or_else(|| child(found, "RealType"));
            real.unwrap_or(found).attribute("unit")
        };
        found.of_type.attribute("unit").or_else(of_type).unwrap_or_default()
    }

    fn unit(&self, found: Described<'a, 'b>, place: Place) -> Unit {
        let name = self.declared(found);
        if matches!(name, "" | "1" | "-") {
            return Unit::Unsaid;
        }
        let units = child(self.root, "UnitDefinitions").into_iter().flat_map(|it| it.children());
        let mut mine = units.filter(|it| it.attribute("name") == Some(name));
        match mine.next().and_then(|unit| child(unit, "BaseUnit")) {
            Some(base) => defined(base, place),
            None => by_name(name, place),
        }
    }
}

const ANGLES: &str = "a variable in rad or deg, and of a rate in rad/s or deg/s";

/// What is said of a unit.
enum Unit {
    /// Nothing: the key says it.
    Unsaid,
    /// One of it in radians, or radians per second.
    Angle(f64),
    /// No angle.
    Other,
}

fn by_name(name: &str, place: Place) -> Unit {
    let bare = match place {
        Place::Rate | Place::PitchRate => name.strip_suffix("/s"),
        _ => Some(name),
    };
    match bare {
        Some("rad") => Unit::Angle(1.0),
        Some("deg" | "°" | "degree" | "degrees") => Unit::Angle(DEGREE_RAD),
        _ => Unit::Other,
    }
}

/// A unit by its exponents of base units.
fn defined(base: Node<'_, '_>, place: Place) -> Unit {
    let number = |name: &str, default: f64| {
        base.attribute(name).map_or(Some(default), |text| text.parse::<f64>().ok())
    };
    let is =
        |name: &str, wanted: f64| number(name, 0.0).is_some_and(|it| it.total_cmp(&wanted).is_eq());
    let is_rate = matches!(place, Place::Rate | Place::PitchRate);
    let seconds = if is_rate { -1.0 } else { 0.0 };
    let others = ["kg", "m", "A", "K", "mol", "cd", "offset"];
    if !(is("s", seconds) && others.iter().all(|name| is(name, 0.0))) {
        return Unit::Other;
    }
    match (number("factor", 1.0), is("rad", 1.0), is("rad", 0.0)) {
        (Some(factor), true, _) => Unit::Angle(factor),
        // A radian is 1 where nobody counts it.
        (Some(factor), _, true) if is_near(factor, 1.0) => Unit::Unsaid,
        _ => Unit::Other,
    }
}

fn is_near(factor: f64, unit: f64) -> bool {
    (factor / unit - 1.0).abs() < SAME_UNIT
}

fn direction(place: Place) -> &'static str {
    match place {
        Place::Command | Place::Pitch | Place::PitchRate => "output",
        _ => "input",
    }
}

pub(crate) fn child<'a, 'b>(node: Node<'a, 'b>, name: &str) -> Option<Node<'a, 'b>> {
    node.children().find(|part| part.has_tag_name(name))
}

/// A name without characters that a terminal would obey, and not too long.
fn shown(name: &str) -> String {
    name.escape_debug().take(MOST_SHOWN).collect()
}
