//! Our own documents, `docs/paper/*.md`, as parts of a page.
//!
//! Links are left out and their words kept: they lead to files that do not lie beside a report. What
//! is numbered (A3, E8) gets its number as id, and is linked wherever another text of the document
//! names it.

use pulldown_cmark::{CodeBlockKind, Event, HeadingLevel, Options, Parser, Tag, TagEnd};

use super::html::escape;

/// A document without its title, as HTML; headings of the second level become `<h3>`. Tables turn
/// into cards on a narrow screen.
pub fn html(text: &str) -> String {
    let mut writer = Writer { known: numbers(text), ..Writer::default() };
    let events = Parser::new_ext(text, Options::ENABLE_TABLES);
    for event in events {
        writer.event(event);
    }
    writer.out
}

/// Words such as A3 and E2b that the text numbers something with.
fn is_number(word: &str) -> bool {
    let mut chars = word.chars();
    let letter = chars.next().is_some_and(|c| c == 'A' || c == 'E');
    let rest = chars.as_str();
    let digits = rest.trim_end_matches(|c: char| c.is_ascii_lowercase());
    letter
        && !digits.is_empty()
        && rest.len() - digits.len() <= 1
        && digits.bytes().all(|b| b.is_ascii_digit())
}

/// The numbers that head a section, a row or a paragraph of the text.
fn numbers(text: &str) -> Vec<String> {
    let starts = ["## ", "| ", "**"];
    let word_after = |line: &str, start: &str| {
        let rest = line.strip_prefix(start)?;
        let word = rest.split(|c: char| !c.is_ascii_alphanumeric()).next()?;
        is_number(word).then(|| word.to_owned())
    };
    text.lines()
        .filter_map(|line| starts.iter().find_map(|start| word_after(line, start)))
        .collect()
}

/// Where the writer is.
#[derive(Debug, Default)]
struct Writer {
    out: String,
    /// Numbers that have an id somewhere in the document.
    known: Vec<String>,
    /// Ids already given.
    given: Vec<String>,
    /// Where the open heading, row or paragraph begins in `out`, until its id is known.
    opened: Option<usize>,
    /// The document's title is not written.
    in_title: bool,
    in_code: bool,
    in_head: bool,
    heads: Vec<String>,
    column: usize,
}

impl Writer {
    fn event(&mut self, event: Event<'_>) {
        match event {
            Event::Start(tag) => self.start(&tag),
            Event::End(tag) => self.end(tag),
            Event::Text(text) => self.text(&text),
            Event::Code(text) => {
                if self.in_head
                    && let Some(head) = self.heads.last_mut()
                {
                    head.push_str(&text);
                }
                self.push(&format!("<code>{}</code>", escape(&text)));
            }
            Event::SoftBreak => self.push(" "),
            Event::HardBreak => self.push("<br>"),
            Event::Rule => self.push("<hr>\n"),
            // Comments to editors are not for readers; other markup our documents do not use.
            _ => {}
        }
    }

    fn push(&mut self, markup: &str) {
        if !self.in_title {
            self.out.push_str(markup);
        }
    }

    /// Opens an element that may turn out to be numbered.
    fn open(&mut self, name: &str) {
        self.push(&format!("<{name}"));
        self.opened = Some(self.out.len());
        self.push(">");
    }

    fn start(&mut self, tag: &Tag<'_>) {
        match tag {
            Tag::Heading { level: HeadingLevel::H1, .. } => self.in_title = true,
            Tag::Heading { level: HeadingLevel::H2, .. } => self.open("h3"),
            Tag::Heading { .. } => self.open("h4"),
            Tag::Paragraph => self.open("p"),
            Tag::List(None) => self.push("<ul>\n"),
            Tag::List(Some(first)) => self.push(&format!("<ol start=\"{first}\">\n")),
            Tag::Item => self.push("<li>"),
            Tag::Strong => self.push("<strong>"),
            Tag::Emphasis => self.push("<em>"),
            Tag::CodeBlock(CodeBlockKind::Fenced(_) | CodeBlockKind::Indented) => {
                self.in_code = true;
                self.push("<pre><code>");
            }
            Tag::Table(_) => {
                self.heads.clear();
                self.push("<div class=\"scroll\" tabindex=\"0\"><table class=\"cards\">\n");
            }
            Tag::TableHead => {
                self.in_head = true;
                self.push("<thead><tr>");
            }
            Tag::TableRow => {
                self.column = 0;
                self.open("tr");
            }
            Tag::TableCell => self.start_cell(),
            _ => {}
        }
    }

    fn start_cell(&mut self) {
        if self.in_head {
            self.heads.push(String::new());
            self.push("<th scope=\"col\">");
        } else if self.column == 0 {
            self.push("<th scope=\"row\">");
        } else {
            let label = self.heads.get(self.column).map(|head| escape(head)).unwrap_or_default();
            self.push(&format!("<td data-label=\"{label}\">"));
        }
    }

    fn end(&mut self, tag: TagEnd) {
        match tag {
            TagEnd::Heading(HeadingLevel::H1) => self.in_title = false,
            TagEnd::Heading(HeadingLevel::H2) => self.push("</h3>\n"),
            TagEnd::Heading(_) => self.push("</h4>\n"),
            TagEnd::Paragraph => self.push("</p>\n"),
            TagEnd::List(false) => self.push("</ul>\n"),
            TagEnd::List(true) => self.push("</ol>\n"),
            TagEnd::Item => self.push("</li>\n"),
            TagEnd::Strong => self.push("</strong>"),
            TagEnd::Emphasis => self.push("</em>"),
            TagEnd::CodeBlock => {
                self.in_code = false;
                self.push("</code></pre>\n");
            }
            TagEnd::Table => self.push("</tbody></table></div>\n"),
            TagEnd::TableHead => {
                self.in_head = false;
                self.push("</tr></thead>\n<tbody>\n");
            }
            TagEnd::TableRow => self.push("</tr>\n"),
            TagEnd::TableCell => {
                let closed = if self.in_head || self.column == 0 { "</th>" } else { "</td>" };
                self.push(closed);
                self.column += 1;
            }
            _ => {}
        }
    }

    fn text(&mut self, text: &str) {
        if self.in_head
            && let Some(head) = self.heads.last_mut()
        {
            head.push_str(text);
        }
        let first = text.split(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default();
        if let Some(at) = self.opened.take()
            && is_number(first)
            && self.known.iter().any(|known| known == first)
            && !self.given.iter().any(|given| given == first)
            && !self.in_title
        {
            self.given.push(first.to_owned());
            self.out.insert_str(at, &format!(" id=\"{first}\""));
            self.push(&escape(text));
            return;
        }
        if self.in_code || self.in_title {
            self.push(&escape(text));
        } else {
            self.push(&linked(text));
        }
    }
}

/// The text with links at every number of an assumption or erratum.
pub fn linked(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(|c: char| c.is_ascii_alphanumeric()) {
        let (before, word_on) = rest.split_at(at);
        let end = word_on.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(word_on.len());
        let (word, after) = word_on.split_at(end);
        out.push_str(&escape(before));
        if is_number(word) {
            out.push_str(&format!("<a href=\"#{word}\">{word}</a>"));
        } else if let Some((index, after)) = subscript(word, after) {
            out.push_str(&format!("{word}<sub>{}</sub>", escape(index)));
            rest = after;
            continue;
        } else {
            out.push_str(&escape(word));
        }
        rest = after;
    }
    out.push_str(&escape(rest));
    out
}

/// The index of a letter such as k_p or Z_ẇ, and what follows it; words such as error_scale have none.
fn subscript<'a>(word: &str, after: &'a str) -> Option<(&'a str, &'a str)> {
    let rest = after.strip_prefix('_').filter(|_| word.len() == 1)?;
    if let Some(braced) = rest.strip_prefix('{') {
        return braced.split_once('}');
    }
    let end = rest.find(|c: char| !c.is_alphanumeric() && c != '\u{307}').unwrap_or(rest.len());
    let (index, after) = rest.split_at(end);
    let short = (1..=3).contains(&index.chars().filter(|c| c.is_alphanumeric()).count());
    (short && !after.starts_with('_')).then_some((index, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_numbered_has_its_number_as_id_and_is_linked_elsewhere() {
        let html = html(
            "# T\n\n## A3 Factors\n\nAs A2 and E8.\n\n| no. | x |\n| --- | --- |\n| E8 | a `b` <c> |\n\n**E18.** Sums.\n",
        );
        assert!(html.contains("<h3 id=\"A3\">A3 Factors</h3>"), "{html}");
        assert!(
            html.contains(
                "<tr id=\"E8\"><th scope=\"row\">E8</th><td data-label=\"x\">a <code>b</code>"
            ),
            "{html}"
        );
        assert!(html.contains("<p id=\"E18\"><strong>E18.</strong>"), "{html}");
        assert!(
            html.contains("<a href=\"#A2\">A2</a>")
                && !html.contains("<c>")
                && !html.contains("<h1")
        );
    }

    #[test]
    fn letters_with_an_index_are_set_lower_and_names_of_keys_are_not() {
        assert_eq!(linked("e_{k\u{2212}1}"), "e<sub>k\u{2212}1</sub>");
        assert_eq!(
            linked("\u{394}k_p, Z_w\u{307}: error_scale"),
            "\u{394}k<sub>p</sub>, Z<sub>w\u{307}</sub>: error_scale"
        );
    }

    #[test]
    fn links_leave_their_words_and_no_address() {
        let html = html("see [claims](claims.md) and [x](https://example.org)");
        assert_eq!(html, "<p>see claims and x</p>\n");
    }
}
