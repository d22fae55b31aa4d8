//! Aircraft files of JSBSim as aircraft of tables.

use std::path::{Path, PathBuf};

use fspid_aircraft::atmosphere::STANDARD_GRAVITY_M_S2;
use fspid_aircraft::{ForceModel, MassProperties, Validity};
use fspid_daveml::data::write;
use fspid_daveml::jsbsim::{self, Assumptions, JsbsimAircraft, Stops};
use fspid_daveml::{Model, Port};
use serde_json::{Value, json};

use super::import::ImportFailure;
use super::load::text;
use super::table::table;
use fspid_scenario::aircraft::number::significant;
use fspid_scenario::toml_text::quoted;
use fspid_scenario::units::degrees;

/// An aircraft of JSBSim that was read.
#[derive(Clone, Debug)]
pub struct JsbsimImport {
    file: String,
    aircraft: JsbsimAircraft,
    mass: MassProperties,
    validity: Validity,
}

/// True for a text that [`import_jsbsim`] reads.
#[must_use]
pub fn is_jsbsim(text: &str) -> bool {
    jsbsim::is_aircraft(text)
}

/// Reads an aircraft file of JSBSim, with properties that are held at a value and the thrust of an engine that stands for
/// its own.
///
/// # Errors
/// [`ImportFailure`]: every problem with its line and column.
pub fn import_jsbsim(
    path: &Path,
    held: Vec<(String, f64)>,
    thrust_lbf: Option<f64>,
) -> Result<JsbsimImport, ImportFailure> {
    let file = path.display().to_string();
    let text = text(path).map_err(ImportFailure::Unreadable)?;
    let failed = |problems| ImportFailure::Problems { file: file.clone(), problems };
    let aircraft = jsbsim::read(&text, &Assumptions { held, thrust_lbf }).map_err(failed)?;
    let (body, forces) = aircraft.flies().map_err(|error| {
        let problem = fspid_daveml::Problem::whole(error.to_string(), "");
        failed(fspid_daveml::Problems::of_text(vec![problem]))
    })?;
    Ok(JsbsimImport { file, mass: body.mass, validity: *forces.validity(), aircraft })
}

impl JsbsimImport {
    /// What was assumed and left out, each with its line and column.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.aircraft.notes.iter().map(|note| match note.place {
            Some(_) => format!("{}:{note}", self.file),
            None => format!("{}: {note}", self.file),
        })
    }

    /// The aircraft file and the files of tables that it names, which go beside it.
    #[must_use]
    pub fn files(&self, out: &Path) -> Vec<(PathBuf, String)> {
        let stem = out.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
        let name = |part: &str| format!("{stem}-{part}.toml");
        let beside = |part: &str| out.with_file_name(name(part));
        let JsbsimAircraft { aerodynamics, inertia, propulsion, .. } = &self.aircraft;
        let mut files = vec![
            (beside("aerodynamics"), write(aerodynamics)),
            (beside("inertia"), write(inertia)),
        ];
        if let Some(propulsion) = propulsion {
            files.push((beside("propulsion"), write(propulsion)));
        }
        files.push((out.to_owned(), self.toml(&stem, name)));
        files
    }

    fn toml(&self, stem: &str, name: impl Fn(&str) -> String) -> String {
        let Stops { elevator, aileron, rudder } = self.aircraft.stops;
        let span = |(min, max): (f64, f64)| format!("[{min:?}, {max:?}]");
        let numbered = self.aircraft.notes.iter().enumerate();
        let assumed: String =
            numbered.map(|(index, note)| format!("# {}. {}\n", index + 1, note.message)).collect();
        let mut tables = vec![("aerodynamics", name("aerodynamics")), ("inertia", name("inertia"))];
        let engine = self.aircraft.propulsion.is_some();
        tables.extend(engine.then(|| ("propulsion", name("propulsion"))));
        let tables: String =
            tables.iter().map(|(key, file)| format!("{key} = {}\n", quoted(file))).collect();
        let engine = if engine { "\n[engine]\nangular_momentum_kg_m2_s = 0.0\n" } else { "" };
        format!(
            "# Written by `fspid aircraft import` from an aircraft file of JSBSim. Assumed:\n{assumed}\
             kind = \"tables\"\n\
             name = {}\n\
             title = {}\n\
             source = {}\n\
             \n[tables]\n{tables}\
             \n[body]\ngravity_m_s2 = {STANDARD_GRAVITY_M_S2:?}\n{engine}\
             \n[travel]\n\
             elevator_deg = {}\n\
             aileron_deg = {}\n\
             rudder_deg = {}\n",
            quoted(stem),
            quoted(&format!("{}, tables of its JSBSim file", self.title())),
            quoted(&format!("aircraft file of JSBSim: {}", self.title())),
            span(elevator),
            span(aileron),
            span(rudder),
        )
    }

    fn title(&self) -> &str {
        let name = self.aircraft.name.as_str();
        if name.is_empty() { "without a name" } else { name }
    }

    /// Ends of the tables: what, from, to, unit.
    fn box_of_tables(&self) -> [(&'static str, f64, f64, &'static str); 4] {
        let Validity { alpha_rad, beta_rad, mach, altitude_m, .. } = self.validity;
        [
            ("angle of attack", degrees(alpha_rad.min), degrees(alpha_rad.max), "deg"),
            ("angle of sideslip", degrees(beta_rad.min), degrees(beta_rad.max), "deg"),
            ("Mach number", mach.min, mach.max, ""),
            ("altitude", altitude_m.min, altitude_m.max, "m"),
        ]
    }

    /// The aircraft for people.
    #[must_use]
    pub fn text(&self) -> String {
        let models = self.models();
        let ports = |ports: Vec<&Port>| {
            let row = |port: &&Port| vec![port.id.clone(), port.units.clone(), port.name.clone()];
            table(&["variable", "unit", "name"], &ports.iter().map(row).collect::<Vec<_>>())
        };
        let inputs: String =
            models.first().map(|model| ports(model.inputs().collect())).unwrap_or_default();
        let rows = self.box_of_tables().map(|(what, from, to, unit)| {
            vec![what.to_owned(), significant(from, 4), significant(to, 4), unit.to_owned()]
        });
        let MassProperties { mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, .. } = self.mass;
        let figures = [mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2];
        let [mass, ix, iy, iz, ixz] = figures.map(|figure| significant(figure, 5));
        format!(
            "{}\n\ninputs of the aerodynamics\n{inputs}\nwhere its tables are\n{}\n\
             body: {mass} kg; Ix, Iy, Iz, Ixz: {ix}, {iy}, {iz}, {ixz} kg m2\n",
            self.title(),
            table(&["quantity", "from", "to", "unit"], &rows),
        )
    }

    fn models(&self) -> Vec<Model> {
        Model::new(&self.aircraft.aerodynamics).into_iter().collect()
    }

    /// The aircraft for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let models = self.models();
        let inputs = models.iter().flat_map(Model::inputs);
        let port = |port: &Port| json!({ "id": port.id, "name": port.name, "units": port.units });
        let finite = |value: f64| value.is_finite().then_some(value);
        let ends = |(what, from, to, unit)| json!({ "quantity": what, "from": finite(from), "to": finite(to), "unit": unit });
        json!({
            "name": self.title(),
            "inputs": inputs.map(port).collect::<Vec<_>>(),
            "tables": self.box_of_tables().map(ends),
            "mass_kg": self.mass.mass_kg,
            "has_engine": self.aircraft.propulsion.is_some(),
            "notes": self.notes().collect::<Vec<_>>(),
        })
    }
}
