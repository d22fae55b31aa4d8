//! What was learned, in words and for programs.

use serde_json::{Value, json};

use super::{Epoch, Learned};

impl Learned {
    /// The answer of `learn --format text`.
    #[must_use]
    pub fn text(&self) -> String {
        let (done, best) = (self.history.len(), self.best());
        let first = self.history.first().copied().unwrap_or(best);
        let mut out = format!("{done} epoch(s); {}\n", self.stop);
        out.push_str(&format!("best epoch  {}\n", self.best + 1));
        out.push_str(&format!(
            "training    {:.6e}, {:.6e} at first\n",
            best.training, first.training
        ));
        if let (Some(best), Some(first)) = (best.validation, first.validation) {
            let first = match first.is_finite() {
                true => format!("{first:.6e}"),
                false => "beyond the range of 64-bit numbers".to_owned(),
            };
            out.push_str(&format!("validation  {best:.6e}, {first} at first\n"));
        }
        if let Some(it) = self.judges.filter(|it| it.also_learned > 0) {
            out.push_str(&format!(
                "{} of the {} rows for validation are among those learned from as well, number by number: of them the error of validation says nothing.\n",
                it.also_learned, it.rows
            ));
        }
        out.push_str("Errors are roots of the mean square over rows and outputs.\n");
        out
    }

    /// The answer of `learn --format json`.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut answer = json!({
            "stop": self.stop.to_string(),
            "best_epoch": self.best + 1,
            "epochs": self.history.iter().map(epoch).collect::<Vec<_>>(),
        });
        if let Some(judges) = self.judges {
            answer["validation_rows"] = json!(judges.rows);
            answer["validation_rows_also_learned"] = json!(judges.also_learned);
        }
        answer
    }
}

/// JSON has no infinity: an error of validation beyond all numbers is told in a word.
fn epoch(epoch: &Epoch) -> Value {
    let mut answer = json!(epoch);
    if epoch.validation.is_some_and(|error| !error.is_finite()) {
        answer["validation"] = json!("infinite");
    }
    answer
}
