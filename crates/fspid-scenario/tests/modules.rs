//! The top-level modules of this crate use each other without a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

type Arrows = BTreeMap<String, BTreeSet<String>>;

/// Adds what the sources in a folder say of `crate::<module>`; `module` is the one that they belong to.
fn add(arrows: &mut Arrows, folder: &Path, module: Option<&str>) {
    for entry in std::fs::read_dir(folder).expect("sources") {
        let path = entry.expect("an entry").path();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        let module = module.unwrap_or(stem);
        if path.is_dir() {
            add(arrows, &path, Some(module));
        } else {
            let text = std::fs::read_to_string(&path).expect("a source");
            assert!(!text.contains("crate::{"), "{}: one module a line", path.display());
            let is_name = |c: &char| c.is_ascii_lowercase() || *c == '_';
            let named = text.split("crate::").skip(1);
            let named = named.map(|rest| rest.chars().take_while(is_name).collect::<String>());
            let found = arrows.entry(module.to_owned()).or_default();
            found.extend(named.filter(|name| name != module));
        }
    }
}

#[test]
fn no_module_uses_one_that_uses_it() {
    let mut arrows = Arrows::new();
    add(&mut arrows, &Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), None);
    arrows.remove("lib");
    assert!(arrows.contains_key("keyed") && arrows["file"].contains("keyed"), "{arrows:?}");
    // What uses nothing that is left can be taken away; a circle stays.
    loop {
        let before = arrows.len();
        let left: BTreeSet<String> = arrows.keys().cloned().collect();
        arrows.retain(|_, uses| !uses.is_disjoint(&left));
        if arrows.len() == before {
            break;
        }
    }
    assert!(arrows.is_empty(), "a circle is in {arrows:?}");
}
