//! A model as its file says it, before it is checked and compiled. It can also be put together without a file.

pub use crate::expression::Expression;
pub use crate::finding::Origin;

/// Everything of a file that is kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// What the model is and where it comes from.
    pub header: Header,
    /// Variables in the order of the file.
    pub variables: Vec<Variable>,
    /// Breakpoints of tables.
    pub breakpoints: Vec<Breakpoints>,
    /// Tables; those written inside a function are here too.
    pub tables: Vec<Table>,
    /// Which table makes which variable of which others.
    pub functions: Vec<TableFunction>,
    /// Check cases.
    pub shots: Vec<Shot>,
}

/// What a model is and where it comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// Name of the model.
    pub name: String,
    /// Date of the file, as written.
    pub date: String,
    /// Version of the file, as written.
    pub version: String,
    /// What the model is.
    pub description: String,
    /// Who made it.
    pub authors: Vec<Author>,
    /// Publications.
    pub references: Vec<Source>,
    /// Changes of the file.
    pub modifications: Vec<Modification>,
}

/// Who made something.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Author {
    /// Name.
    pub name: String,
    /// Organisation.
    pub organisation: String,
    /// Address for mail.
    pub email: String,
}

/// A publication that numbers come from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// Identifier.
    pub id: String,
    /// Author.
    pub author: String,
    /// Title.
    pub title: String,
    /// Number of the report or book.
    pub accession: String,
    /// Date, as written.
    pub date: String,
    /// Address on the net.
    pub address: String,
    /// What else is said of it.
    pub description: String,
}

/// A change of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Modification {
    /// Identifier.
    pub id: String,
    /// Date, as written.
    pub date: String,
    /// Who made it.
    pub authors: Vec<Author>,
    /// What was changed.
    pub description: String,
}

/// Where one part of the model comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Provenance {
    /// Who made it.
    pub authors: Vec<Author>,
    /// Date, as written.
    pub date: String,
    /// Identifiers of publications.
    pub references: Vec<String>,
    /// What else is said.
    pub description: String,
}

/// A variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variable {
    /// Identifier in the file.
    pub id: String,
    /// Name, often one of the standard.
    pub name: String,
    /// Units in the spelling of the standard, such as `ft_s` and `nd`.
    pub units: String,
    /// Sign convention, as written.
    pub sign: String,
    /// Symbol.
    pub symbol: String,
    /// What it is.
    pub description: String,
    /// Value of a constant, or of an input that is not given.
    pub initial: Option<f64>,
    /// Lower limit.
    pub min: Option<f64>,
    /// Upper limit.
    pub max: Option<f64>,
    /// What it is for.
    pub roles: Vec<Role>,
    /// How it is calculated.
    pub formula: Option<Expression>,
    /// Where it was written.
    pub origin: Origin,
}

/// What a variable is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Given from outside.
    Input,
    /// Given from outside: a control.
    Control,
    /// Given from outside: a disturbance.
    Disturbance,
    /// Given from outside: a state, integrated by whoever uses the model.
    State,
    /// An answer: the rate of a state.
    StateRate,
    /// An answer.
    Output,
    /// Named by the standard.
    Standard,
}

impl Role {
    /// Every role with the name of its element.
    pub const ALL: [(&'static str, Self); 7] = [
        ("isInput", Self::Input),
        ("isControl", Self::Control),
        ("isDisturbance", Self::Disturbance),
        ("isState", Self::State),
        ("isStateDeriv", Self::StateRate),
        ("isOutput", Self::Output),
        ("isStdAIAA", Self::Standard),
    ];

    /// The role with that element.
    #[must_use]
    pub fn named(element: &str) -> Option<Self> {
        Self::ALL.iter().find(|(name, _)| *name == element).map(|&(_, role)| role)
    }

    /// The name of its element.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, role)| *role == self).map_or("", |&(name, _)| name)
    }

    /// True for a variable that has to be given.
    #[must_use]
    pub fn is_given(self) -> bool {
        matches!(self, Self::Input | Self::Control | Self::Disturbance | Self::State)
    }

    /// True for a variable that is answered.
    #[must_use]
    pub fn is_answer(self) -> bool {
        matches!(self, Self::Output | Self::StateRate)
    }
}

/// Where the values of a table stand along one axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Breakpoints {
    /// Identifier.
    pub id: String,
    /// Name.
    pub name: String,
    /// Units.
    pub units: String,
    /// What it is.
    pub description: String,
    /// Rising numbers.
    pub values: Vec<f64>,
    /// Where they were written.
    pub origin: Origin,
}

/// A mention of something by its identifier.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mention {
    /// Identifier.
    pub id: String,
    /// Where it was written.
    pub origin: Origin,
}

/// Values on a grid; along the last axis they follow each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Identifier.
    pub id: String,
    /// Name.
    pub name: String,
    /// Units.
    pub units: String,
    /// What it is.
    pub description: String,
    /// Where it comes from.
    pub provenance: Provenance,
    /// The axes.
    pub breakpoints: Vec<Mention>,
    /// The values.
    pub values: Vec<f64>,
    /// Where it was written.
    pub origin: Origin,
}

/// A variable that is read off a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableFunction {
    /// Name.
    pub name: String,
    /// What it is.
    pub description: String,
    /// Where it comes from.
    pub provenance: Provenance,
    /// A variable for each axis of the table.
    pub inputs: Vec<FunctionInput>,
    /// The variable that is made.
    pub output: Mention,
    /// The table.
    pub table: Mention,
    /// Where it was written.
    pub origin: Origin,
}

/// A variable with which a table is entered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FunctionInput {
    /// Identifier of the variable.
    pub variable: Mention,
    /// Where the variable is held from below.
    pub min: Option<f64>,
    /// Where the variable is held from above.
    pub max: Option<f64>,
    /// What happens beyond the breakpoints.
    pub extrapolate: Extrapolate,
}

/// At which end a table goes on straight beyond its breakpoints; at the others the value at the end is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extrapolate {
    /// At none.
    #[default]
    Neither,
    /// At the lower end.
    Min,
    /// At the upper end.
    Max,
    /// At both.
    Both,
}

impl Extrapolate {
    /// Every kind with its name.
    pub const ALL: [(&'static str, Self); 4] =
        [("neither", Self::Neither), ("min", Self::Min), ("max", Self::Max), ("both", Self::Both)];

    /// The kind with that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|&(_, kind)| kind)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |&(name, _)| name)
    }
}

/// A check case: what the model answers to some inputs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shot {
    /// Name.
    pub name: String,
    /// What it checks.
    pub description: String,
    /// Inputs.
    pub inputs: Vec<Signal>,
    /// Variables on the way.
    pub internals: Vec<Signal>,
    /// Outputs.
    pub outputs: Vec<Signal>,
    /// Where it was written.
    pub origin: Origin,
}

/// A value in a check case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signal {
    /// Name or identifier of the variable, as `by_name` says.
    pub variable: String,
    /// True for a name, false for an identifier.
    pub by_name: bool,
    /// Units; empty if they are not said.
    pub units: String,
    /// Value.
    pub value: f64,
    /// How far an answer may be off.
    pub tolerance: Option<f64>,
    /// Where it was written.
    pub origin: Origin,
}
