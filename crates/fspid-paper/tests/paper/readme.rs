//! What the README says of the paper, against what the program finds.

use fspid_paper::Status;

use super::paper;

fn readme() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../README.md");
    std::fs::read_to_string(path).expect("the README is part of the repository")
}

/// Count and mean of the cost of each comparison, out of "…: FSPID better in 14 of 27 cases, cost ratio … to …, mean 0.85".
fn comparisons(id: &str) -> Vec<(usize, f64)> {
    let found = paper().statements.iter().find(|judged| judged.id == id).expect("a statement");
    let part = |text: &str| -> (usize, f64) {
        let (_, rest) = text.split_once("better in ").expect("a count");
        let count = rest.split(' ').next().and_then(|it| it.parse().ok()).expect("a number");
        let (_, mean) = rest.split_once("mean ").expect("a mean");
        (count, mean.trim().parse().expect("a number"))
    };
    found.ours.split(';').map(part).collect()
}

/// "14 % lower", "8.0 times as high": the mean as the README says it, by its own number.
fn ratio(words: &str) -> f64 {
    let number: f64 = words.split(' ').next().and_then(|it| it.parse().ok()).expect("a number");
    match words {
        words if words.ends_with("times as high") => number,
        words if words.ends_with("% lower") => 1.0 - number / 100.0,
        words if words.ends_with("% higher") => 1.0 + number / 100.0,
        words => panic!("{words}"),
    }
}

/// The README used to say "with both tuned by the same effort in 18 and 4", without the cost, which is 1.87 and 4.9
/// times that of the CPID.
#[test]
fn the_readme_states_every_count_of_figure_7_beside_its_cost() {
    let readme = readme();
    let rows: Vec<Vec<&str>> = readme
        .lines()
        .filter(|line| line.starts_with("| a CPID"))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let [continuous, abrupt] = ["F7.1", "F7.2"].map(comparisons);
    assert_eq!((rows.len(), continuous.len(), abrupt.len()), (3, 3, 3), "{rows:?}");
    for (row, found) in rows.iter().zip(continuous.iter().zip(&abrupt)) {
        let [_, won, cost, won_abrupt, cost_abrupt] = row[..] else { panic!("{row:?}") };
        for (said, mean, (count, found)) in
            [(won, cost, found.0), (won_abrupt, cost_abrupt, found.1)]
        {
            assert_eq!(said, format!("{count} of 27"));
            // Both are rounded: to a hundredth, and to two digits.
            assert!((ratio(mean) - found).abs() <= 0.03 * found, "{mean} for {found}");
        }
    }
    assert_eq!(readme.matches("of 27 |").count(), 6, "a count stands elsewhere, without its cost");
}

#[test]
fn the_readme_reconciles_claims_and_numbers_as_they_are_counted() {
    let (readme, paper) = (readme(), paper());
    let (numbers, all) = (paper.claims.len(), paper.statuses().count());
    let [own, shared] = paper.numbers_reproduced();
    let sentences = paper.statements.len();
    assert_eq!(numbers + sentences, all);
    let of_all = Status::ALL.map(|status| paper.count(status));
    for said in [
        format!(
            "makes {all} claims that a flight can answer: {numbers} numbers and {sentences} sentences"
        ),
        format!("Of the numbers {own} come out"),
        format!("(of all claims: {}, {} and {})", of_all[0], of_all[1], of_all[2]),
        format!("\n{shared} come out"),
    ] {
        assert!(readme.contains(&said), "{said}");
    }
}
