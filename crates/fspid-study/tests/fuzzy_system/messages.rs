//! Every problem of a file at once, each at its place, with what would be right.

use fspid_scenario::fuzzy_system::parse;

use super::{EVERY_KEY, TIP};

/// The problems of the file with replacements.
fn problems(changes: &[(&str, &str)]) -> String {
    let mut text = TIP.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    parse(&text, "tip.toml").expect_err("wrong").to_string()
}

#[test]
fn all_problems_are_told_at_once_with_known_words() {
    let told = problems(&[
        ("range = [0, 10]", "rnge = [0, 10]"),
        ("shape = \"gaussian\", centre = 5", "shape = \"gausian\", centre = 5"),
        ("centre = 10, sigma = 1.5", "centre = 10, sgma = 1.5"),
        ("left_foot = 7", "left_foot = 17"),
        ("fallback = \"middle\"", "fallback = \"midle\""),
    ]);
    for part in [
        "tip.toml:8:1: input[0].rnge: unknown key; did you mean `range`?",
        "tip.toml:11:18: input[0].terms.good.shape: unknown shape; did you mean `gaussian`?",
        "tip.toml:12:48: input[0].terms.excellent.sgma: unknown key; did you mean `sigma`?",
        "input[1].terms.delicious",
        "output[0].fallback: not allowed",
        "allowed: \"none\", \"middle\" or a finite number",
        "5 problems in tip.toml",
    ] {
        assert!(told.contains(part), "{part} in\n{told}");
    }
}

#[test]
fn a_mistake_in_a_rule_is_told_at_its_word() {
    let told = problems(&[
        ("food is rancid", "food is ranzid"),
        ("average with 0.5", "avrage with 0.5"),
        ("very delicious", "vary delicious"),
    ]);
    for part in [
        "tip.toml:32:31: rules[0].lines: no term of `food` has this name\n    found: ranzid;",
        "did you mean `rancid`?",
        "tip.toml:33:32: rules[0].lines: no term of `tip` has this name",
        "tip.toml:34:36: rules[0].lines: not a hedge\n    found: vary;",
    ] {
        assert!(told.contains(part), "{part} in\n{told}");
    }
}

#[test]
fn a_mistake_in_a_formula_is_told_at_its_column() {
    let told = problems(&[(
        "{ shape = \"gaussian\", centre = 0, sigma = 1.5 }",
        "{ formula = \"1 - y / 10\" }",
    )]);
    assert!(
        told.contains("tip.toml:10:25: input[0].terms.poor.formula: in the formula:"),
        "{told}"
    );
    assert!(told.contains("found: y;"), "{told}");
}

#[test]
fn what_does_not_go_together_is_told_where_it_stands() {
    let told = problems(&[
        ("name = \"food\"", "name = \"service\""),
        ("food is rancid", "service is poor"),
        ("food is very delicious", "service is good"),
    ]);
    assert!(told.contains("twice"), "{told}");
    let told = problems(&[("fallback = \"middle\"", "defuzzifier = \"weighted-average\"")]);
    assert!(told.contains("tip.toml:26:9: output `tip`, term `cheap`: weighted-average"), "{told}");
    let told = problems(&[(
        "fallback = \"middle\"",
        "defuzzifier = \"weighted-sum\"\nsampling = \"exact\"",
    )]);
    assert!(told.contains("output[0].sampling: not together with weighted-sum"), "{told}");
    let told = problems(&[("range = [0, 30]\n", "")]);
    assert!(told.contains("output `tip`: centroid needs a universe"), "{told}");
}

#[test]
fn a_grid_tells_the_cell_that_is_wrong() {
    let grid = |cells: &str| {
        let (head, _) = TIP.split_once("lines = '''").expect("rules");
        let table = "[rules.table]\nrows = \"service\"\ncolumns = \"food\"\n[rules.table.cells]\ntip = \"\"\"\n";
        parse(&format!("{head}{table}{cells}\"\"\"\n"), "tip.toml")
            .map(|s| s.parts().blocks[0].rules.len())
    };
    assert_eq!(grid("cheap cheap\n- average\ngenerous -\n"), Ok(4));
    let told = grid("cheap cheap\n- avrage\ngenerous -\n").expect_err("wrong").to_string();
    assert!(
        told.contains(
            "tip.toml:37:3: rules[0].table.cells.tip: unknown term; did you mean `average`?"
        ),
        "{told}"
    );
    let told = grid("cheap cheap\n-\n").expect_err("wrong").to_string();
    assert!(told.contains("2 lines for 3 terms") && told.contains("1 words for 2 terms"), "{told}");
}

#[test]
fn another_kind_of_file_is_refused() {
    let told = parse("schema = 1\nname = \"a flight\"\n", "a.toml").expect_err("wrong").to_string();
    assert!(told.contains("kind: missing key\n    allowed: \"fuzzy-system\""), "{told}");
    assert!(parse("", "a.toml").is_err() && parse("[", "a.toml").is_err());
}

#[test]
fn a_damaged_file_gives_problems_with_places_and_never_a_panic() {
    let mut refused = 0;
    for cut in (0..EVERY_KEY.len()).step_by(3).filter(|at| EVERY_KEY.is_char_boundary(*at)) {
        let (before, after) = EVERY_KEY.split_at(cut);
        let damaged = [
            before.to_owned(),
            format!("{before}\u{7f}é\"{after}"),
            format!("{before}{}", after.get(1..).unwrap_or_default()),
        ];
        for text in damaged {
            if let Err(problems) = parse(&text, "a.toml") {
                refused += 1;
                assert!(
                    problems
                        .list
                        .iter()
                        .all(|found| found.place.is_none_or(|at| at.line > 0 && at.column > 0))
                );
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}
