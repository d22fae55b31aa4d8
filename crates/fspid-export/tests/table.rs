//! The table of a supervisor is never further off than was proved.

use fspid_core::fuzzy::{Defuzzifier, NumberTable, OutOfRange, Supervisor};
use fspid_core::{Gains, SelfTuner, TunerSettings, paper};
use fspid_export::table::SurfaceTable;
use fspid_export::write;

fn tuner(supervisor: Supervisor<f64>) -> SelfTuner<f64> {
    let nominal = Gains { kp: 1.0, ki: 0.5, kd: 0.25 };
    SelfTuner::new(nominal, supervisor, TunerSettings::literal()).expect("plain settings")
}

fn of_the_paper() -> Supervisor<f64> {
    let built = Supervisor::new(&paper::rules(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    built.expect("the paper's rules")
}

fn exact(supervisor: &Supervisor<f64>, error: f32, change: f32) -> [f64; 3] {
    let delta = supervisor.infer(f64::from(error), f64::from(change)).expect("clamped").delta;
    [delta.kp, delta.ki, delta.kd]
}

fn refute(table: &SurfaceTable, supervisor: &Supervisor<f64>, error: f32, change: f32) {
    let exact = exact(supervisor, error, change);
    let kinds =
        [(table.single(error, change), table.single), (table.short(error, change), table.short)];
    for (answer, deviations) in kinds {
        for ((answer, exact), it) in answer.expect("finite").iter().zip(exact).zip(deviations) {
            let off = (f64::from(*answer) - exact).abs();
            assert!(off <= it.proved, "({error}, {change}): {off} > {}", it.proved);
        }
    }
}

#[test]
fn no_input_refutes_the_proved_bound_and_the_bound_is_near_what_is_seen() {
    let supervisor = of_the_paper();
    let table = SurfaceTable::of(&tuner(supervisor), 13).expect("a table");
    let mut numbers = 12345_u64;
    let mut draw = || {
        numbers =
            numbers.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((numbers >> 40) as f32 / (1_u64 << 24) as f32 - 0.5) * 11.0
    };
    for _ in 0..50_000 {
        let (error, change) = (draw(), draw());
        refute(&table, &supervisor, error, change);
    }
    for it in table.single.iter().chain(&table.short) {
        assert!(it.seen <= it.proved && it.proved < 1.1 * it.seen, "{it:?}");
    }
}

#[test]
fn the_table_in_c_answers_as_the_one_that_was_proved_without_a_warning() {
    let supervisor = of_the_paper();
    let table = SurfaceTable::of(&tuner(supervisor), 7).expect("a table");
    let angles = Some(fspid_export::Angles::Radians);
    let precision = fspid_export::program::Precision::Single;
    let heading = write::Heading { name: "pitch", digest: "0", precision, angles, elevator: None };
    let files = write::table(&table, "pitch", &heading);
    let check = write::table_harness(&table, &supervisor, "pitch", 2000);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let texts = [
        ("pitch_table.h", files.header),
        ("a.c", files.single),
        ("b.c", files.short),
        ("c.c", check),
    ];
    for (name, text) in texts {
        std::fs::write(folder.path().join(name), text).expect("a temporary file");
    }
    let plain =
        ["-std=c99", "-O1", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-ffp-contract=off"];
    let built = std::process::Command::new("cc")
        .args(plain)
        .args(["a.c", "b.c", "c.c", "-o", "check"])
        .current_dir(folder.path())
        .output()
        .expect("the compiler that links Rust");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = std::process::Command::new(folder.path().join("check")).output().expect("built");
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert_eq!(said, "2000 inputs, 0 different, 0 beyond the bound\n");
}

#[test]
fn numbers_are_in_the_table_but_for_rounding() {
    let row = [0.1, -0.7, 0.3, 0.0, 0.9, -0.2, 0.5];
    let numbers = NumberTable::new([[row; 7]; 3]).expect("finite");
    let supervisor = Supervisor::of_numbers(&numbers, 1.0, OutOfRange::Evaluate).expect("within");
    let table = SurfaceTable::of(&tuner(supervisor), 13).expect("a table");
    assert!(table.single.iter().all(|it| it.seen <= it.proved && it.proved < 2e-5));
    for k in 0..2000_u16 {
        let at = |k: u16| f32::from(k % 211) / 100.0 - 1.05;
        refute(&table, &supervisor, at(k), at(k.wrapping_mul(31)));
    }
}

#[test]
fn what_no_table_can_be_of_is_refused_by_name() {
    let refused = |supervisor, points| {
        SurfaceTable::of(&tuner(supervisor), points).expect_err("refused").to_string()
    };
    assert!(refused(of_the_paper(), 33).contains("6m + 1"));
    let policy = OutOfRange::Evaluate;
    let evaluates = Supervisor::new(&paper::rules(), 5.0, Defuzzifier::Exact, policy);
    assert!(refused(evaluates.expect("the paper's rules"), 13).contains("out_of_range"));
}
