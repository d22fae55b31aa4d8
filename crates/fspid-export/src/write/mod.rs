//! Programs as text in other languages.

mod ardupilot;
mod c;
mod c_external;
mod c_harness;
mod c_projects;
mod c_selftest;
mod csv;
mod dialect;
pub(crate) mod fmu;
mod heading;
mod lua;
mod matlab;
mod put;
mod rust;
mod rust_harness;
mod rust_rules;
mod rust_text;
mod simulink;
mod structured_text;
mod structured_text_check;
mod table;

pub use ardupilot::ardupilot;
pub use c::{CFiles, c};
pub(crate) use c::{c_expression, c_number};
pub use c_external::{EXTERNAL_HEADER, c_external};
pub use c_harness::c_harness;
pub use c_projects::{cmake, platformio, sketch};
pub use c_selftest::c_selftest;
pub use csv::csv;
pub use heading::Heading;
pub use lua::{lua, lua_harness};
pub use matlab::{matlab, matlab_harness, words};
pub use rust::rust;
pub use rust_harness::rust_harness;
pub use simulink::{simulink, simulink_build};
pub use structured_text::structured_text;
pub(crate) use structured_text_check::MOST_SAMPLES;
pub use structured_text_check::structured_text_check;
pub use table::{TableFiles, table, table_csv, table_harness};

/// Text with its indentation.
#[derive(Debug, Default)]
struct Page {
    text: String,
    depth: usize,
}

impl Page {
    fn line(&mut self, line: &str) {
        if !line.is_empty() {
            self.row(["", ""], |text| text.push_str(line));
        } else {
            self.text.push('\n');
        }
    }

    /// A line of what a function writes between a beginning and an end.
    fn row(&mut self, [begin, end]: [&str; 2], write: impl FnOnce(&mut String)) {
        (0..self.depth).for_each(|_| self.text.push_str("    "));
        self.text.push_str(begin);
        write(&mut self.text);
        self.text.push_str(end);
        self.text.push('\n');
    }

    fn inside(&mut self, write: impl FnOnce(&mut Self)) {
        self.depth += 1;
        write(self);
        self.depth -= 1;
    }
}

/// Lines of at most so many characters, broken between words; what is not seen, such as a mark that turns the text around,
/// ends a word and is left out.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let ends_a_word = |c: char| c.is_whitespace() || heading::is_unseen(c);
    for word in text.split(ends_a_word).filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if line.len() + word.len() < width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A real as the shortest decimal number that reads back as itself, with a point and perhaps an exponent.
pub(crate) fn decimal(value: f64, is_single: bool) -> String {
    let mut text = String::new();
    put::decimal(&mut text, value, is_single);
    text
}
