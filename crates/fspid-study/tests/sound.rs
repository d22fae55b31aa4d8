//! Whether a page is complete, self-contained and well-formed.

use std::collections::BTreeSet;

/// Every tag of a page: its name and the text of its attributes.
fn tags(html: &str) -> Vec<(String, String)> {
    let mut tags = Vec::new();
    for part in html.split('<').skip(1) {
        // No attribute of ours holds a bare `>`; text escapes it.
        let (tag, _) = part.split_once('>').expect("every tag is closed");
        let (name, attributes) = tag.split_once(' ').unwrap_or((tag, ""));
        tags.push((name.trim_end_matches('/').to_owned(), attributes.to_owned()));
    }
    tags
}

fn attributes<'a>(tags: &'a [(String, String)], name: &str) -> Vec<&'a str> {
    let start = format!("{name}=\"");
    let of = |attributes: &'a str| {
        let padded =
            attributes.find(&start).filter(|at| *at == 0 || attributes[..*at].ends_with(' '))?;
        attributes[padded + start.len()..].split('"').next()
    };
    tags.iter().filter_map(|(_, attributes)| of(attributes)).collect()
}

const VOID: [&str; 4] = ["meta", "br", "hr", "!doctype"];

/// Panics where it is not.
pub(crate) fn assert_sound(html: &str) {
    // The one script is our own, and is no markup.
    let script = format!("<script>{}</script>", fspid_page::page::SCRIPT);
    assert_eq!(html.matches(&script).count(), 1, "one script, ours");
    let html = &html.replace(&script, "");
    let tags = tags(html);
    let mut open: Vec<&str> = Vec::new();
    for (name, attributes) in &tags {
        if let Some(name) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "closed out of turn");
        } else if !VOID.contains(&name.as_str()) && !attributes.ends_with('/') {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "never closed: {open:?}");
    let ids = attributes(&tags, "id");
    let unique: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), unique.len(), "an id is given twice");
    for reference in attributes(&tags, "href") {
        let id = reference.strip_prefix('#').expect("references stay in the page");
        assert!(unique.contains(id), "nothing has the id {id}");
    }
    for name in attributes(&tags, "aria-labelledby").iter().flat_map(|names| names.split(' ')) {
        assert!(unique.contains(name), "nothing has the id {name}");
    }
    assert!(attributes(&tags, "src").is_empty(), "something is loaded");
    assert!(
        tags.iter().all(
            |(name, _)| !["script", "link", "iframe", "img", "object"].contains(&name.as_str())
        )
    );
    assert!(!html.contains("@import") && !html.contains("class=\"failed\""));
    let urls = html.match_indices("url(").filter(|(at, _)| !html[at + 4..].starts_with('#'));
    assert_eq!(urls.count(), 0, "a style refers to something outside");
    // Name spaces of SVG are names, not references.
    let outside = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    assert!(!outside.contains("http://") && !outside.contains("https://"));
    assert!(html.contains("<html lang=\"en\">") && html.contains("name=\"viewport\""));
}
