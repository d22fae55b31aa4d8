//! An audit for people.

use super::{Audit, Mark};
use fspid_diagnostics::lines::wrapped;

/// Longest line, in characters, where words allow it.
const WIDTH: usize = 110;

impl Audit<'_> {
    /// Every finding with its sign, chapter by chapter.
    #[must_use]
    pub fn text(&self) -> String {
        let parts = self.system.parts();
        let mut out = String::new();
        for chapter in self.chapters() {
            let gap = if out.is_empty() { "" } else { "\n" };
            out.push_str(&format!("{gap}{}\n", chapter.title));
            let width = chapter.findings.iter().map(|f| f.about.chars().count()).max().unwrap_or(0);
            for found in &chapter.findings {
                let lines = wrapped(&found.sentence, "", WIDTH.saturating_sub(width + 6));
                let indent = " ".repeat(width + 6);
                let sentence = lines.join(&format!("\n{indent}"));
                out.push_str(&format!(
                    "  {} {:width$}  {sentence}\n",
                    found.mark.sign(),
                    found.about
                ));
            }
        }
        out.push_str(&format!(
            "\n{} holds, {} worth knowing, {} probably not meant, {} not proved within the budget\n\
            {} rules, {} boxes\n",
            Mark::Holds.sign(),
            Mark::Worth.sign(),
            Mark::NotMeant.sign(),
            Mark::Open.sign(),
            parts.blocks.iter().map(|block| block.rules.len()).sum::<usize>(),
            self.surface.boxes
        ));
        out
    }
}
