//! What was learned, in words and for programs.

use fspid_diagnostics::lines::line;
use serde_json::{Value, json};

use super::Learned;

impl Learned {
    /// The answer of `learn --format text`.
    #[must_use]
    pub fn text(&self) -> String {
        let (done, best) = (self.history.len(), self.best());
        let first = self.history.first().copied().unwrap_or(best);
        let mut out = format!("{done} epoch(s); {}\n", self.stop);
        line(&mut out, format_args!("best epoch  {}", self.best + 1));
        line(
            &mut out,
            format_args!("training    {:.6e}, {:.6e} at first", best.training, first.training),
        );
        if let (Some(best), Some(first)) = (best.validation, first.validation) {
            line(&mut out, format_args!("validation  {best:.6e}, {first:.6e} at first"));
        }
        out.push_str("Errors are roots of the mean square over rows and outputs.\n");
        out
    }

    /// The answer of `learn --format json`.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({
            "stop": self.stop.to_string(),
            "best_epoch": self.best + 1,
            "epochs": self.history,
        })
    }
}
