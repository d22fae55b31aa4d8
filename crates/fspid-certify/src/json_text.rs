//! JSON as a stranger may write it: keys that stand twice are told, and only so many values are kept.

use std::cell::RefCell;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

/// Most values that a text may hold; each takes some 80 bytes, however short it is written.
const MOST_VALUES: usize = 500_000;
/// Most keys that are told to stand twice, and most characters of a key in a path: a long key above many would
/// else be written out for each.
const MOST_TWICE: usize = 100;
const MOST_OF_A_KEY: usize = 60;

/// What was met on the way.
#[derive(Default)]
struct Met {
    values: usize,
    /// Keys and indices from the root to here.
    path: String,
    twice: Vec<String>,
}

/// Reads a text; answers the value and the paths of the keys that stand more than once.
///
/// # Errors
/// What is no JSON, too deep, too much, or holds a number that is not finite.
pub(super) fn read(text: &str) -> Result<(Value, Vec<String>), String> {
    let met = RefCell::new(Met::default());
    let mut reader = serde_json::Deserializer::from_str(text);
    let value = Seed(&met).deserialize(&mut reader).map_err(|error| error.to_string())?;
    reader.end().map_err(|error| error.to_string())?;
    Ok((value, met.into_inner().twice))
}

#[derive(Clone, Copy)]
struct Seed<'a>(&'a RefCell<Met>);

impl Seed<'_> {
    /// Runs something one step further down.
    fn below<T>(self, step: &str, read: impl FnOnce() -> T) -> T {
        let length = self.0.borrow().path.len();
        self.0.borrow_mut().path.push_str(step);
        let result = read();
        self.0.borrow_mut().path.truncate(length);
        result
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        let mut met = self.0.borrow_mut();
        met.values += 1;
        if met.values > MOST_VALUES {
            return Err(D::Error::custom(format_args!("more than {MOST_VALUES} values")));
        }
        drop(met);
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        let number = Number::from_f64(value).ok_or_else(|| E::custom("a number is not finite"))?;
        Ok(Value::Number(number))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        loop {
            let step = format!("[{}]", values.len());
            match self.below(&step, || list.next_element_seed(self))? {
                Some(value) => values.push(value),
                None => return Ok(Value::Array(values)),
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut table: A) -> Result<Value, A::Error> {
        let mut values = Map::new();
        while let Some(key) = table.next_key::<String>()? {
            let dot = if self.0.borrow().path.is_empty() { "" } else { "." };
            let step: String = key.chars().take(MOST_OF_A_KEY).collect();
            let value = self.below(&format!("{dot}{step}"), || {
                let mut met = self.0.borrow_mut();
                if values.contains_key(&key) && met.twice.len() < MOST_TWICE {
                    let path = met.path.clone();
                    met.twice.push(path);
                }
                drop(met);
                table.next_value_seed(self)
            })?;
            // The first stands; that there is another is told.
            values.entry(key).or_insert(value);
        }
        Ok(Value::Object(values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_that_stand_twice_are_told_with_their_path() {
        let (value, twice) =
            read(r#"{"a": {"b": [{"c": 1, "c": 2}], "b": 3}, "d": 1}"#).expect("JSON");
        assert_eq!(twice, ["a.b[0].c", "a.b"]);
        assert_eq!(value["a"]["b"][0]["c"], 1);
    }

    #[test]
    fn a_long_key_above_many_that_stand_twice_is_not_written_out_for_each() {
        let text =
            format!("{{\"{}\": {{{}\"a\": 0}}}}", "k".repeat(100_000), "\"a\":0,".repeat(100_000));
        let used = allocation_counter::measure(|| {
            let (_, twice) = read(&text).expect("JSON");
            assert_eq!((twice.len(), twice[0].len()), (MOST_TWICE, MOST_OF_A_KEY + 2));
        });
        assert!(used.bytes_max < 1 << 20, "{used:?}");
    }

    #[test]
    fn numbers_without_bounds_and_texts_without_end_are_refused() {
        for text in ["NaN", "Infinity", "-Infinity", "1e999", "{\"a\": inf}", "[1,]", "1 2", ""] {
            assert!(read(text).is_err(), "{text}");
        }
        let deep = "[".repeat(100_000);
        assert!(read(&deep).expect_err("deep").contains("recursion limit"));
        let many = format!("[{}0]", "0,".repeat(MOST_VALUES));
        assert!(read(&many).expect_err("many").contains("more than 500000 values"));
    }
}
