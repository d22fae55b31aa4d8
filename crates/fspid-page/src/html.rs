//! Templates and the engine that fills them: everything is escaped unless a template says that it is markup of our
//! own.

use std::sync::OnceLock;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::Value;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, escape_formatter};

/// The values that a template is filled with, by name; anything that can be serialised.
#[macro_export]
macro_rules! context {
    () => { $crate::minijinja::value::Value::from_pairs([("", ""); 0]) };
    (@one $key:ident) => { $key };
    (@one $key:ident $value:expr) => { $value };
    ($($key:ident $(=> $value:expr)?),* $(,)?) => {
        $crate::minijinja::value::Value::from_pairs([$((
            stringify!($key),
            $crate::minijinja::value::Value::from($crate::minijinja::value::Serde(
                &$crate::context!(@one $key $($value)?),
            )),
        )),*])
    };
}

/// Templates of every page.
const SHARED: &[(&str, &str)] = &[
    ("macros", include_str!("template/macros.html")),
    ("analysis", include_str!("template/analysis.html")),
    ("campaign", include_str!("template/campaign.html")),
    ("page", include_str!("template/page.html")),
];

static OWN: Templates = Templates::new(&[]);

/// The templates of a crate by name, beside those of every page, and the engine that fills them.
#[derive(Debug)]
pub struct Templates {
    texts: &'static [(&'static str, &'static str)],
    environment: OnceLock<Environment<'static>>,
}

impl Templates {
    /// These templates: names and texts.
    #[must_use]
    pub const fn new(texts: &'static [(&'static str, &'static str)]) -> Self {
        Self { texts, environment: OnceLock::new() }
    }

    /// The template filled with the context. A template that fails leaves a visible note: tests look for it.
    pub fn render(&self, template: &str, context: Value) -> String {
        let environment = self.environment.get_or_init(|| environment(self.texts));
        environment.get_template(template).and_then(|found| found.render(context)).unwrap_or_else(
            |error| {
                format!(
                    "<p class=\"failed\">This part could not be written: {}</p>",
                    escape(&format!("{error:#}"))
                )
            },
        )
    }

    /// Why templates cannot be read, if any cannot: for tests.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let all = SHARED.iter().chain(self.texts);
        let problem = |(name, text): &(&'static str, &'static str)| {
            let error = Environment::new().add_template(name, text).err()?;
            Some(format!("{name}: {error}"))
        };
        all.filter_map(problem).collect()
    }
}

fn environment(texts: &'static [(&'static str, &'static str)]) -> Environment<'static> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_formatter(|out, state, value| match value.as_str() {
        Some(text) if text.contains(is_unwritable) => {
            let text = text.replace(is_unwritable, "\u{fffd}");
            let text =
                if value.is_safe() { Value::from_safe_string(text) } else { Value::from(text) };
            escape_formatter(out, state, &text)
        }
        _ => escape_formatter(out, state, value),
    });
    // White space around tags only matters to those who read the source.
    let mut syntax = SyntaxConfig::builder();
    if let Ok(syntax) = syntax.trim_blocks(true).lstrip_blocks(true).build() {
        environment.set_syntax(syntax);
    }
    environment.add_global("script", crate::page::SCRIPT);
    environment.add_global("policy", crate::page::policy());
    for (name, text) in SHARED.iter().chain(texts) {
        // A template with a mistake is then missing, and `render` says so.
        let _ = environment.add_template(name, text);
    }
    environment
}

/// True for a control character: no page may hold one, whoever named a scenario by it.
fn is_unwritable(c: char) -> bool {
    c.is_control() && !matches!(c, '\n' | '\t')
}

/// A template of every page, filled.
pub(crate) fn render(template: &str, context: Value) -> String {
    OWN.render(template, context)
}

/// Text as HTML.
#[must_use]
pub fn escape(text: &str) -> String {
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
        assert_eq!(OWN.problems(), Vec::<String>::new());
    }

    #[test]
    fn no_text_brings_a_control_character_into_a_page() {
        const TEXTS: &[(&str, &str)] = &[("own", "{{ text }}|{{ markup|safe }}")];
        let text = "a\u{1}\u{1b}[31m<b>\u{85}\n\tc";
        let page = Templates::new(TEXTS).render("own", context! { text, markup => "<i>\u{7}</i>" });
        assert_eq!(page, "a\u{fffd}\u{fffd}[31m&lt;b&gt;\u{fffd}\n\tc|<i>\u{fffd}</i>");
    }
}
