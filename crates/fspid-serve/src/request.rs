//! Bodies of requests: read within a time and a size, and JSON whose keys are known.

use std::time::Duration;

use axum::body::{Body, to_bytes};
use axum::http::StatusCode;
use fspid_diagnostics::known_words;
use serde_json::{Map, Value};
use tokio::time::timeout;

use crate::answer::Refusal;
use crate::guard::too_large;
use crate::settings::Limits;

/// The JSON object of a body.
pub(crate) async fn object(body: Body, limits: &Limits) -> Result<Fields, Refusal> {
    let bytes = match timeout(limits.body, to_bytes(body, limits.body_bytes)).await {
        Ok(Ok(bytes)) => bytes,
        Ok(Err(_)) => return Err(too_large(limits.body_bytes)),
        Err(_) => return Err(too_slow(limits.body)),
    };
    match serde_json::from_slice(&bytes) {
        Ok(Value::Object(fields)) => Ok(Fields { fields, known: Vec::new() }),
        Ok(_) => Err(Refusal::wrong("the body is JSON, and no object")),
        Err(error) => Err(Refusal::wrong(format_args!("the body is no JSON: {error}"))),
    }
}

fn too_slow(most: Duration) -> Refusal {
    let sentence = format!("the body did not come within {} s", most.as_secs_f64());
    Refusal::new(StatusCode::REQUEST_TIMEOUT, sentence)
}

/// Fields of an object, each taken once; what is left in the end was not known.
#[derive(Debug)]
pub(crate) struct Fields {
    fields: Map<String, Value>,
    known: Vec<&'static str>,
}

impl Fields {
    pub(crate) fn of(fields: Map<String, Value>) -> Self {
        Self { fields, known: Vec::new() }
    }

    /// The value of a key, if it is there; `null` stands for none.
    fn take(&mut self, key: &'static str) -> Option<Value> {
        self.known.push(key);
        self.fields.remove(key).filter(|value| !value.is_null())
    }

    /// A text, if there is one.
    pub(crate) fn text(&mut self, key: &'static str) -> Result<Option<String>, Refusal> {
        match self.take(key) {
            None => Ok(None),
            Some(Value::String(text)) => Ok(Some(text)),
            Some(other) => Err(wrong(key, &other, "a text")),
        }
    }

    /// A text that has to be there.
    pub(crate) fn needed_text(&mut self, key: &'static str) -> Result<String, Refusal> {
        self.text(key)?.ok_or_else(|| Refusal::wrong(format_args!("there is no `{key}`")))
    }

    /// Texts; none where the key is not there.
    pub(crate) fn texts(&mut self, key: &'static str) -> Result<Vec<String>, Refusal> {
        let found = self.take(key);
        let texts = match &found {
            None => Some(Vec::new()),
            Some(Value::Array(items)) => {
                items.iter().map(|item| item.as_str().map(str::to_owned)).collect()
            }
            Some(_) => None,
        };
        texts.ok_or_else(|| wrong(key, &found.unwrap_or_default(), "a list of texts"))
    }

    /// A whole number, if there is one.
    pub(crate) fn whole(&mut self, key: &'static str) -> Result<Option<u64>, Refusal> {
        let found = self.take(key);
        let whole = found.as_ref().map(|value| value.as_u64().ok_or(value)).transpose();
        whole.map_err(|value| wrong(key, value, "a whole number, 0 or more"))
    }

    /// Yes or no; no where it is not said.
    pub(crate) fn flag(&mut self, key: &'static str) -> Result<bool, Refusal> {
        match self.take(key) {
            None => Ok(false),
            Some(Value::Bool(flag)) => Ok(flag),
            Some(other) => Err(wrong(key, &other, "true or false")),
        }
    }

    /// The fields of an object within; none where the key is not there.
    pub(crate) fn object(&mut self, key: &'static str) -> Result<Self, Refusal> {
        match self.take(key) {
            None => Ok(Self::of(Map::new())),
            Some(Value::Object(fields)) => Ok(Self::of(fields)),
            Some(other) => Err(wrong(key, &other, "an object")),
        }
    }

    /// What nobody has taken yet.
    pub(crate) fn json(&self) -> Value {
        Value::Object(self.fields.clone())
    }

    /// Refuses what nobody has taken.
    pub(crate) fn end(self) -> Result<(), Refusal> {
        match self.fields.keys().next() {
            None => Ok(()),
            Some(key) => {
                let known = known_words(key, &self.known);
                Err(Refusal::wrong(format_args!("there is no `{key}` here{known}")))
            }
        }
    }
}

fn wrong(key: &str, found: &Value, allowed: &str) -> Refusal {
    let found: String = found.to_string().chars().take(60).collect();
    Refusal::wrong(format_args!("`{key}` is {found}; allowed is {allowed}"))
}
