//! What a text in angle brackets is, by its first element.

/// Roots of fuzzy systems in FML, as its reader knows them.
const OF_FML: [&str; 2] = ["fuzzysystem", "fuzzycontroller"];

/// True for a text whose root is that of a fuzzy system.
pub(super) fn is_fml(text: &str) -> bool {
    root(text).is_some_and(|root| OF_FML.contains(&root.as_str()))
}

/// What a text in angle brackets that is no fuzzy system is called.
pub(super) fn called(text: &str) -> &'static str {
    match root(text).as_deref() {
        Some("html") => "HTML",
        _ => "XML",
    }
}

/// The name of the first element in small letters and without its prefix; `html` where the type of the document says so.
fn root(text: &str) -> Option<String> {
    let mut rest = text.trim_start_matches('\u{feff}').trim_start();
    loop {
        let inner = rest.strip_prefix('<')?;
        let end = match inner.starts_with("!--") {
            true => "-->",
            false if inner.starts_with(['?', '!']) => ">",
            false => break,
        };
        if inner.get(..13).is_some_and(|it| it.eq_ignore_ascii_case("!doctype html")) {
            return Some("html".to_owned());
        }
        rest = inner.split_once(end)?.1.trim_start();
    }
    let name = rest.strip_prefix('<')?;
    let name = name.split(|it: char| it.is_whitespace() || "/>".contains(it)).next()?;
    Some(name.rsplit(':').next().unwrap_or(name).to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_in_angle_brackets_is_a_fuzzy_system_only_by_its_root() {
        let header = "\u{feff}<?xml version=\"1.0\"?>\n<!-- <html> -->\n";
        for root in
            ["<fuzzySystem name=\"x\">", "<FUZZYCONTROLLER>", "<f:fuzzySystem xmlns:f=\"a\"/>"]
        {
            assert!(is_fml(&format!("{header}{root}")), "{root}");
        }
        for (text, what) in [
            ("<!DOCTYPE html>\n<html lang=\"en\">", "HTML"),
            ("<!doctype HTML>", "HTML"),
            ("<html>", "HTML"),
            ("<?xml version=\"1.0\"?><svg/>", "XML"),
            ("<!-- never ends", "XML"),
            ("<", "XML"),
        ] {
            assert!(!is_fml(text) && called(text) == what, "{text}");
        }
    }
}
