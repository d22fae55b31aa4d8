//! FMUs: the archive, the description, and a small importer in C that plays the library.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use fspid_core::Controller;
use fspid_export::program::{Part, Precision, Program, Value};
use fspid_export::vectors::{Vector, vectors};
use fspid_export::{Angles, Request, Target, export, program};
use fspid_numeric::Real;
use proptest::prelude::*;
use roxmltree::{Document, Node};

use crate::moved::moved;
use crate::unpacked::unpacked;

const SAMPLES: usize = 240;

fn fmu(controller: &Controller<f64>, target: Target, precision: Precision) -> Vec<u8> {
    called("Pitch hold", controller, target, precision)
}

fn called(
    name: &str,
    controller: &Controller<f64>,
    target: Target,
    precision: Precision,
) -> Vec<u8> {
    let request = Request {
        name,
        target,
        precision,
        angles: Angles::Radians,
        samples: 10,
        points: fspid_export::table::POINTS,
        digest: "0",
        elevator: None,
        its_loop: None,
        evidence: false,
    };
    let exported = export(controller, &request).expect("nothing here is refused");
    assert!(
        exported.notes.iter().any(|note| note.contains("a library for")),
        "the tests need a C compiler: {:?}",
        exported.notes
    );
    let file = exported.files.into_iter().find(|file| file.name.ends_with(".fmu"));
    file.expect("the archive").bytes
}

/// The importer, built once for each version.
fn importer(target: Target) -> &'static Path {
    static BUILT: OnceLock<(tempfile::TempDir, [PathBuf; 2])> = OnceLock::new();
    let (_, [two, three]) = BUILT.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let programs = ["2", "3"].map(|version| {
            let program = folder.path().join(format!("importer{version}"));
            // As the FMU's library, so that both can be built with what looks for mistakes.
            let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
            let mut compiler = compiler.split_whitespace();
            let built = Command::new(compiler.next().unwrap_or("cc"))
                .args(compiler)
                .args(["-std=c99", "-D_GNU_SOURCE", "-O1", "-Wall", "-Wextra", "-Werror"])
                .arg(format!("-DFMI={version}"))
                .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fmu/importer.c"))
                .arg("-o")
                .arg(&program)
                .args(["-ldl", "-lm"])
                .output()
                .expect("the compiler that links Rust");
            assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
            program
        });
        (folder, programs)
    });
    if target == Target::Fmu2 { two } else { three }
}

fn text(files: &[(String, Vec<u8>)], name: &str) -> String {
    let file = files.iter().find(|(known, _)| known == name);
    String::from_utf8(file.expect("a file of the archive").1.clone()).expect("text")
}

/// The elements that are variables: name, value reference, attributes of the version.
fn variables<'a>(document: &'a Document<'a>) -> Vec<Node<'a, 'a>> {
    let all = document.descendants().find(|node| node.has_tag_name("ModelVariables"));
    all.expect("variables").children().filter(Node::is_element).collect()
}

fn reference(variables: &[Node<'_, '_>], name: &str) -> Option<u32> {
    let of = |node: &&Node<'_, '_>| node.attribute("name") == Some(name);
    let found = variables.iter().find(of)?;
    found.attribute("valueReference")?.parse().ok()
}

/// What the importer is told: names of the standard as references, samples and answers as bits.
fn words<R: Real>(
    description: &str,
    period_s: f64,
    programs: [&Program; 2],
    rows: [&[Vector<R>]; 2],
) -> String {
    let document = Document::parse(description).expect("XML");
    let variables = variables(&document);
    let root = document.root_element();
    let token = root.attribute("guid").or(root.attribute("instantiationToken"));
    let mut words = format!("{}\n", token.expect("a token"));
    let mut word = |value: u64| writeln!(words, "{value:x}").expect("a text grows");
    let at = |name: &str| u64::from(reference(&variables, name).unwrap_or_default());
    let real = |program: &Program, name: &str| {
        program.members(Part::Configuration).iter().find_map(|member| match member.value {
            Value::Real(value) if member.name == name => Some(value),
            _ => None,
        })
    };
    let [own, other] = programs;
    let inputs = own.members(Part::Sample);
    let is_parameter = |node: &&Node<'_, '_>| node.attribute("causality") == Some("parameter");
    let parameters: Vec<&str> =
        variables.iter().filter(is_parameter).filter_map(|node| node.attribute("name")).collect();
    word(period_s.to_bits());
    for count in [inputs.len(), rows[0].len(), parameters.len()] {
        word(count as u64);
    }
    inputs.iter().for_each(|input| word(at(&input.name)));
    for name in ["command_rad", "kp", "ki", "kd", "saturated", "faults", "lower_rad", "upper_rad"] {
        word(at(name));
    }
    for name in parameters {
        word(at(name));
        word(real(other, name).expect("a setting of both").to_bits());
    }
    for vector in rows.into_iter().flatten() {
        vector.sample.iter().chain(&vector.answer).for_each(|value| word(value.to_f64().to_bits()));
        vector.marks.iter().for_each(|mark| word(u64::from(*mark)));
    }
    words
}

/// Plays the FMU against two controllers that differ in numbers alone.
fn play<R: Real>(fmu: &[u8], target: Target, own: &Controller<R>, other: &Controller<R>) -> String {
    let files = unpacked(fmu);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let library = folder.path().join("library");
    let binary = files.iter().find(|(name, _)| name.starts_with("binaries/"));
    std::fs::write(&library, &binary.expect("a library").1).expect("a temporary file");
    let of = |controller| program(controller, Angles::Radians).expect("nothing here is refused");
    let rows = [own, other].map(|it| vectors(it, Angles::Radians, 1, SAMPLES));
    let description = text(&files, "modelDescription.xml");
    // As scenarios have it: an importer's clock has 64 bits, whatever the controller's numbers have.
    let words = words(&description, 0.01, [&of(own), &of(other)], [&rows[0], &rows[1]]);
    let said = folder.path().join("words");
    std::fs::write(&said, words).expect("a temporary file");
    let ran = Command::new(importer(target)).args([&library, &said]).output().expect("a program");
    let told = String::from_utf8_lossy(&ran.stdout).into_owned();
    if ran.status.success() { String::new() } else { format!("{:?}: {told}", ran.status) }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn the_fmu_of_any_controller_answers_as_it_and_as_another_whose_parameters_it_takes(
        controller in fspid_options::any_controller(),
        is_three in any::<bool>(),
        is_single in any::<bool>(),
    ) {
        let target = if is_three { Target::Fmu3 } else { Target::Fmu2 };
        let other = moved(&controller);
        match (is_single, controller.rounded::<f32>(), other.rounded::<f32>()) {
            (true, Ok(own), Ok(other)) => {
                let fmu = fmu(&controller, target, Precision::Single);
                prop_assert_eq!(play(&fmu, target, &own, &other), "");
            }
            _ => {
                let fmu = fmu(&controller, target, Precision::Double);
                prop_assert_eq!(play(&fmu, target, &controller, &other), "");
            }
        }
    }
}

fn paper() -> Controller<f64> {
    use fspid_core::{Fspid, Gains, Limits, PidConfig, SelfTuner, TunerSettings};
    let supervisor = fspid_options::labels(fspid_core::fuzzy::OutOfRange::Clamp);
    let nominal = Gains { kp: 1.0, ki: 0.5, kd: 0.2 };
    let tuner = SelfTuner::new(nominal, supervisor, TunerSettings::literal()).expect("allowed");
    let what = fspid_core::ControllerSetting::OutputLimits;
    let limits = Some(Limits::new(what, -0.3, 0.3).expect("in order"));
    let config = PidConfig { limits, ..PidConfig::sampled_every(0.01) };
    Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
}

/// FMUs of the same controller, FMI 2.0 and 3.0, exported once.
fn of_paper(target: Target) -> &'static [u8] {
    static EXPORTED: OnceLock<[Vec<u8>; 2]> = OnceLock::new();
    let [two, three] = EXPORTED.get_or_init(|| {
        [Target::Fmu2, Target::Fmu3].map(|target| fmu(&paper(), target, Precision::Double))
    });
    if target == Target::Fmu2 { two } else { three }
}

/// 0.01 s in 32 bits is less, so that from 447.39 s on a step of 0.01 s took two samples.
#[test]
fn an_fmu_of_single_numbers_takes_one_sample_in_each_step_for_as_long_as_it_flies() {
    let [own, other] = [paper(), moved(&paper())].map(|it| it.rounded::<f32>().expect("small"));
    for target in [Target::Fmu2, Target::Fmu3] {
        let fmu = fmu(&paper(), target, Precision::Single);
        let description = text(&unpacked(&fmu), "modelDescription.xml");
        assert!(description.contains("stepSize=\"0.01\""), "{description}");
        assert_eq!(play(&fmu, target, &own, &other), "");
    }
}

#[test]
fn an_fmu_has_the_same_bytes_each_time_and_at_most_sixty_kilobytes() {
    assert_eq!(of_paper(Target::Fmu3), fmu(&paper(), Target::Fmu3, Precision::Double));
    for target in [Target::Fmu2, Target::Fmu3] {
        let size = of_paper(target).len();
        assert!(size <= 60_000, "{size} bytes");
    }
}

#[test]
fn another_controller_has_another_token() {
    let token = |fmu: &[u8]| {
        let files = unpacked(fmu);
        let description = text(&files, "modelDescription.xml");
        let document = Document::parse(&description).expect("XML");
        document.root_element().attribute("guid").map(str::to_owned)
    };
    let other = fmu(&moved(&paper()), Target::Fmu2, Precision::Double);
    assert_ne!(token(of_paper(Target::Fmu2)), token(&other));
}

#[test]
fn a_description_names_every_output_once_each_unit_and_each_source() {
    for (target, count_from) in [(Target::Fmu2, 1), (Target::Fmu3, 0)] {
        let files = unpacked(of_paper(target));
        let description = text(&files, "modelDescription.xml");
        let document = Document::parse(&description).expect("XML");
        let variables = variables(&document);
        let references: Vec<String> = variables
            .iter()
            .map(|node| node.attribute("valueReference").unwrap_or_default().to_owned())
            .collect();
        let counted: Vec<String> = (0..variables.len()).map(|at| at.to_string()).collect();
        assert_eq!(references, counted);

        let named = |tag: &str, attribute: &str| -> Vec<String> {
            let nodes = document.descendants().filter(|node| node.has_tag_name(tag));
            nodes.filter_map(|node| node.attribute(attribute)).map(str::to_owned).collect()
        };
        let outputs: Vec<String> = (0..variables.len())
            .filter(|at| variables[*at].attribute("causality") == Some("output"))
            .map(|at| (at + count_from).to_string())
            .collect();
        let known = match target {
            Target::Fmu2 => named("Unknown", "index"),
            _ => [named("Output", "valueReference"), named("InitialUnknown", "valueReference")]
                .concat(),
        };
        assert_eq!(known, [outputs.clone(), outputs].concat());

        let units = named("Unit", "name");
        for node in document.descendants() {
            let unit = node.attribute("unit");
            assert!(unit.is_none_or(|unit| units.iter().any(|known| known == unit)), "{unit:?}");
        }
        let build = text(&files, "sources/buildDescription.xml");
        let build = Document::parse(&build).expect("XML");
        let sources = build.descendants().filter(|node| node.has_tag_name("SourceFile"));
        let sources: Vec<&str> = sources.filter_map(|node| node.attribute("name")).collect();
        assert_eq!(sources.len(), 2);
        for source in sources {
            assert!(!text(&files, &format!("sources/{source}")).is_empty());
        }
        if target == Target::Fmu2 {
            assert_eq!(named("File", "name"), ["pitch_hold.c", "fmu-2.c"]);
        }
    }
}

#[test]
fn a_description_has_strengths_of_rules_gains_and_limits_with_what_they_start_from() {
    let files = unpacked(of_paper(Target::Fmu3));
    let description = text(&files, "modelDescription.xml");
    let document = Document::parse(&description).expect("XML");
    let variables = variables(&document);
    let of = |name: &str| {
        let found = variables.iter().find(|node| node.attribute("name") == Some(name));
        *found.unwrap_or_else(|| panic!("no variable {name}"))
    };
    assert_eq!(of("upper_rad").attribute("start"), Some("0.3"));
    assert_eq!(of("upper_rad").attribute("displayUnit"), Some("deg"));
    assert_eq!(of("nominal_ki").attribute("unit"), Some("1/s"));
    assert_eq!(of("nominal_kp").attribute("variability"), Some("tunable"));
    assert_eq!(
        of("strength_R49").attribute("description"),
        Some("Strength of rule R49: error PB, change PB; 0 where nothing is inferred.")
    );
    assert!(reference(&variables, "dt_s").is_none(), "others follow from the period");
}

#[test]
fn a_controller_may_have_any_name() {
    // Names of the C around it, and what XML does not take.
    for name in ["model", "fmi3", "state", "double", "a\"<&>\u{1}*/ \u{ffff}b"] {
        let files = unpacked(&called(name, &paper(), Target::Fmu3, Precision::Double));
        let description = text(&files, "modelDescription.xml");
        let document = Document::parse(&description).expect("XML");
        let told = document.root_element().attribute("modelName").unwrap_or_default();
        assert_eq!(told, name.replace(['\u{1}', '\u{ffff}'], " "));
    }
}
