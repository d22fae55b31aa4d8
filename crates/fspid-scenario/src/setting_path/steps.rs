//! The steps of a path.

/// A step of a path.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step {
    Name(String),
    Index(usize),
}

/// The steps of `controller[0].nominal.kp` or `controller."my PID".kp`.
pub(crate) fn steps(path: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    let mut rest = path.trim();
    loop {
        if let Some(quoted) = rest.strip_prefix('"') {
            let (name, after) = quoted.split_once('"')?;
            steps.push(Step::Name(name.to_owned()));
            rest = after;
        } else {
            let end = rest.find(['.', '[']).unwrap_or(rest.len());
            let (name, after) = rest.split_at(end);
            if name.trim().is_empty() {
                return None;
            }
            steps.push(Step::Name(name.trim().to_owned()));
            rest = after;
        }
        while let Some(bracket) = rest.strip_prefix('[') {
            let (index, after) = bracket.split_once(']')?;
            steps.push(Step::Index(index.trim().parse().ok()?));
            rest = after;
        }
        if rest.is_empty() {
            // As deep as a file may nest.
            return (steps.len() <= 64).then_some(steps);
        }
        rest = rest.strip_prefix('.')?;
    }
}

/// The path of the steps, as [`steps`] reads it.
pub(crate) fn path_of(steps: &[Step]) -> String {
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Index(index) => path.push_str(&format!("[{index}]")),
            Step::Name(name) if path.is_empty() => path.push_str(&bare(name)),
            Step::Name(name) => path.push_str(&format!(".{}", bare(name))),
        }
    }
    path
}

/// A name as a step of a path.
pub(crate) fn bare(name: &str) -> String {
    let is_bare = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    if is_bare && !name.is_empty() { name.to_owned() } else { format!("\"{name}\"") }
}
