//! Every command of the README and the guide, run, and what they print compared: no document can lie.

use std::path::{Path, PathBuf};

use crate::common::{code, fspid, text};
use crate::repository::repository;

/// What the documents write before the program's own words.
const PROGRAM: &str = "cargo run --release -- ";
/// What else is run: building what the next command flies.
const COMPILER: &str = "cc -shared ";
/// Commands that are not run here, each with the reason.
const NOT_RUN: [(&str, &str); 9] = [
    ("serve", "goes on until Ctrl-C; tests of its own run it"),
    ("reproduce", "the end-to-end check runs it"),
    ("contest", "takes most of an hour"),
    ("adaptation", "takes minutes; tests of its own fly fewer"),
    ("bench", "measures"),
    ("campaign run", "ten thousand flights; the end-to-end check runs five hundred"),
    ("campaign re", "of those flights"),
    ("campaign rare", "twenty thousand flights; tests of its own fly fewer"),
    ("aircraft trim f16.toml", "NASA's files are not kept here"),
];
/// What the long checks alone run: most of a minute.
const LONG: [&str; 1] = ["campaign search"];
/// Commands that do not end with 0, and what they end with.
const CODES: [(&str, i32); 2] =
    [("aircraft trim navion --speed 60kt", 2), ("verify pitch.toml --library mine.so", 1)];

/// The list that a reader of the repository sees had half of the pages.
#[test]
fn the_guide_lists_every_page_that_it_has_as_a_book() {
    let page = |name: &str| {
        let path = repository().join("docs/guide").join(name);
        std::fs::read_to_string(path).expect("a page")
    };
    let (summary, readme) = (page("SUMMARY.md"), page("README.md"));
    let entries = |text: &str| -> Vec<String> {
        let lines = text.lines().filter(|line| line.trim_start().starts_with("- ["));
        lines.map(str::to_owned).collect()
    };
    let (of_book, of_readme) = (entries(&summary), entries(&readme));
    assert!(of_book.len() > 30 && of_readme.starts_with(&of_book), "{of_readme:#?}");
}

fn is_skipped(command: &str) -> bool {
    let is_one_of = |start: &str| command.starts_with(start);
    let is_long = LONG.into_iter().any(is_one_of);
    NOT_RUN.iter().any(|(start, _)| is_one_of(start))
        || (is_long && std::env::var_os("FSPID_LONG_TESTS").is_none())
}

/// Blocks between fences: language and lines.
fn blocks(page: &str) -> Vec<(&str, Vec<&str>)> {
    let mut found: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        match (line.strip_prefix("```"), inside) {
            (Some(language), false) => {
                found.push((language, Vec::new()));
                inside = true;
            }
            (Some(_), true) => inside = false,
            (None, true) => found.last_mut().expect("a block").1.push(line),
            (None, false) => {}
        }
    }
    found
}

/// The file that a block is, if its first line says so: of C, or a scenario.
fn named_source(line: &str) -> Option<&str> {
    let of_c = line.strip_prefix("/* ").and_then(|it| it.strip_suffix(" */"));
    let name = of_c.or_else(|| line.strip_prefix("# "))?;
    let is_name = name.ends_with(if of_c.is_some() { ".c" } else { ".toml" });
    (is_name && !name.contains(' ')).then_some(name)
}

/// Builds as a line says.
fn compile(line: &str, folder: &Path) {
    let words = line.split_whitespace().skip(1);
    let built = std::process::Command::new("cc").args(words).current_dir(folder).output();
    let built = built.expect("the compiler that links Rust");
    assert!(built.status.success(), "{line}\n{}", text(&built.stderr));
}

/// Runs the commands of a page in its order, in a folder that looks like the repository; how many.
fn run(page: &Path, folder: &Path) -> usize {
    let document = std::fs::read_to_string(page).expect("a page");
    let (mut printed, mut ran, mut skipped) = (String::new(), 0, false);
    for (language, lines) in blocks(&document) {
        if language == "text" && !skipped {
            for line in lines.iter().filter(|line| !line.is_empty() && !line.contains('→')) {
                assert!(
                    line.starts_with('#') || printed.contains(line.trim_end()),
                    "{}: not printed: {line}\n{printed}",
                    page.display()
                );
            }
        }
        if let Some(name) = lines.first().and_then(|line| named_source(line)) {
            std::fs::write(folder.join(name), lines.join("\n")).expect("written");
        }
        if language != "sh" {
            continue;
        }
        for line in lines {
            if line.starts_with(COMPILER) {
                compile(line, folder);
            }
            let Some(command) = line.strip_prefix(PROGRAM) else { continue };
            let command = command.split(" #").next().unwrap_or_default().trim();
            skipped = is_skipped(command);
            if skipped {
                continue;
            }
            // What a shell does.
            let (command, into) = command.split_once(" > ").unwrap_or((command, ""));
            let arguments: Vec<&str> = command.split_whitespace().collect();
            let output = fspid(&arguments, folder);
            let expected = CODES.iter().find(|(start, _)| command.starts_with(start));
            let (out, err) = (text(&output.stdout), text(&output.stderr));
            assert_eq!(code(&output), expected.map_or(0, |it| it.1), "{command}\n{out}\n{err}");
            if !into.is_empty() {
                std::fs::write(folder.join(into), &out).expect("written");
            }
            printed.push_str(&out);
            printed.push_str(&err);
            ran += 1;
        }
    }
    ran
}

#[test]
fn every_command_of_readme_and_guide_runs_and_prints_what_they_say() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["scenarios", "examples", "data", "crates"] {
        let from = std::fs::canonicalize(repository().join(name)).expect("a folder");
        std::os::unix::fs::symlink(from, folder.path().join(name)).expect("a link");
    }
    let mut ran = run(&repository().join("README.md"), folder.path());
    std::fs::remove_file(folder.path().join("pitch.toml")).expect("written by init");
    let guide = repository().join("docs/guide");
    let mut pages: Vec<PathBuf> =
        std::fs::read_dir(guide).expect("the guide").map(|it| it.expect("a page").path()).collect();
    // Scenarios that later pages use are written by the first.
    pages.sort_by_key(|page| (!page.ends_with("first-scenario.md"), page.clone()));
    for page in &pages {
        ran += run(page, folder.path());
    }
    assert!(ran > 40, "{ran}");
}
