//! The templates of reports.

use fspid_page::html::Templates;
use fspid_page::minijinja::value::Value;

macro_rules! templates {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("template/", $name, ".html")))),*]
    };
}

static TEMPLATES: Templates = Templates::new(templates!["audit", "user",]);

/// The template filled with the context.
pub(super) fn render(template: &str, context: Value) -> String {
    TEMPLATES.render(template, context)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_template_can_be_read() {
        assert_eq!(TEMPLATES.problems(), Vec::<String>::new());
    }
}
