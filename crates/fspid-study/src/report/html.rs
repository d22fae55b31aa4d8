//! The templates and the engine that fills them: everything is escaped unless a template says that it
//! is markup of our own.

use std::sync::OnceLock;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::Value;
use minijinja::{AutoEscape, Environment, UndefinedBehavior};

/// The values that a template is filled with, by name; anything that can be serialised.
macro_rules! context {
    () => { minijinja::value::Value::from_pairs([("", ""); 0]) };
    (@one $key:ident) => { $key };
    (@one $key:ident $value:expr) => { $value };
    ($($key:ident $(=> $value:expr)?),* $(,)?) => {
        minijinja::value::Value::from_pairs([$((
            stringify!($key),
            minijinja::value::Value::from(minijinja::value::Serde(
                &$crate::report::html::context!(@one $key $($value)?),
            )),
        )),*])
    };
}
pub(super) use context;

macro_rules! templates {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("template/", $name, ".html")))),*]
    };
}

/// Every template by name.
const TEMPLATES: &[(&str, &str)] = templates![
    "macros",
    "analysis",
    "audit",
    "campaign",
    "page",
    "paper",
    "user",
    "summary",
    "conventions",
    "supervisor",
    "responses",
    "disturbances",
    "claims",
    "document",
    "identification",
    "stability",
    "variants",
    "provenance",
];

fn environment() -> &'static Environment<'static> {
    static ENVIRONMENT: OnceLock<Environment<'static>> = OnceLock::new();
    ENVIRONMENT.get_or_init(|| {
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        // White space around tags only matters to those who read the source.
        let mut syntax = SyntaxConfig::builder();
        if let Ok(syntax) = syntax.trim_blocks(true).lstrip_blocks(true).build() {
            environment.set_syntax(syntax);
        }
        for (name, text) in TEMPLATES {
            // A template with a mistake is then missing, and `render` says so.
            let _ = environment.add_template(name, text);
        }
        environment
    })
}

/// The template filled with the context. A template that fails leaves a visible note: a test looks for it.
pub(super) fn render(template: &str, context: Value) -> String {
    environment().get_template(template).and_then(|found| found.render(context)).unwrap_or_else(
        |error| {
            format!(
                "<p class=\"failed\">This part could not be written: {}</p>",
                escape(&format!("{error:#}"))
            )
        },
    )
}

/// Text as HTML.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_template_can_be_read() {
        for (name, text) in TEMPLATES {
            let mut alone = Environment::new();
            assert!(
                alone.add_template(name, text).is_ok(),
                "{name}: {:?}",
                alone.add_template(name, text).err()
            );
        }
    }
}
