//! Equations of doc comments reach KaTeX as they are written: Markdown, which reads them first, must leave them alone.

use std::fs::read_to_string;

use crate::repository::{files, repository};

/// Blocks of doc comments without fenced code, each line without its prefix.
fn doc_comments(source: &str) -> Vec<String> {
    let mut blocks = vec![String::new()];
    let mut fenced = false;
    for line in source.lines() {
        let line = line.trim_start();
        match line.strip_prefix("///").or_else(|| line.strip_prefix("//!")) {
            None => blocks.push(String::new()),
            Some(text) if text.trim_start().starts_with("```") => fenced = !fenced,
            Some(text) if !fenced => blocks.last_mut().expect("one").extend([text, "\n"]),
            Some(_) => {}
        }
    }
    blocks
}

/// The equations of a block; an error where a dollar has no partner.
fn equations(block: &str) -> Result<Vec<String>, String> {
    let prose: Vec<&str> = block.split('`').step_by(2).collect();
    let prose = prose.join(" ").replace("$$", "$");
    let parts: Vec<String> = prose.split('$').map(str::to_owned).collect();
    if parts.len().is_multiple_of(2) {
        return Err(prose);
    }
    Ok(parts.into_iter().skip(1).step_by(2).collect())
}

/// What Markdown would take out of an equation, if anything.
fn taken(equation: &str) -> Option<&'static str> {
    let escape = |pair: &[u8]| pair[0] == b'\\' && pair[1].is_ascii_punctuation();
    let marker = |line: &str| ["- ", "+ ", "> ", "# "].iter().any(|it| line.starts_with(it));
    if equation.as_bytes().windows(2).any(escape) {
        Some("a backslash before punctuation")
    } else if equation.contains('*') {
        Some("an asterisk")
    } else if equation.lines().skip(1).any(|line| marker(line.trim_start())) {
        Some("a line that begins as a list")
    } else {
        None
    }
}

#[test]
fn markdown_takes_nothing_out_of_an_equation() {
    let mut found = 0;
    for source in files(&repository().join("crates"), "rs") {
        for block in doc_comments(&read_to_string(&source).expect("a source")) {
            let equations = equations(&block)
                .unwrap_or_else(|text| panic!("{}: a lone dollar in {text}", source.display()));
            for equation in equations {
                found += 1;
                let taken = taken(&equation);
                assert_eq!(taken, None, "{}: {equation}; see docs/katex", source.display());
            }
        }
    }
    assert!(found > 1000, "{found}");
}
