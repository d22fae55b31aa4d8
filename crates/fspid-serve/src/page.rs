//! The files of the page: in the program itself, so that no route reads a file by its name.

use std::borrow::Cow;

use axum::body::{Body, Bytes};
use axum::http::{Response, StatusCode};

use serde_json::json;

use crate::answer::of_kind;

include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// What is shown where the crate was built without the page.
const NOT_BUILT: &str = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>fspid</title></head><body><h1>The page was not built</h1><p>Run <code>web/build.sh</code>, which needs Node, then build fspid again. The server itself works: it answers under <code>/api</code> who has the token.</p></body></html>\n";

/// Where a scenario stands in the page as one file.
const PLACE: &str = "<!-- scenario -->";

/// The first file of the page.
const INDEX: &str = "index.html";

/// The page of the cockpit.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// Its files by their names.
    files: Vec<(String, Cow<'static, [u8]>)>,
    /// All of it in one file.
    whole: Option<Cow<'static, [u8]>>,
}

impl Page {
    /// The page that the crate was built with; one that says so where it was built without.
    #[must_use]
    pub fn built() -> Self {
        let file = |(name, bytes): &(&str, &'static [u8])| ((*name).to_owned(), (*bytes).into());
        Self { files: SITE.iter().map(file).collect(), whole: WHOLE.map(Cow::Borrowed) }
    }

    /// A page of these files, and as one file.
    #[must_use]
    pub fn of(files: &[(&str, &[u8])], whole: Option<&[u8]>) -> Self {
        let file = |(name, bytes): &(&str, &[u8])| ((*name).to_owned(), bytes.to_vec().into());
        let whole = whole.map(|bytes| Cow::Owned(bytes.to_vec()));
        Self { files: files.iter().map(file).collect(), whole }
    }

    /// All of it as one file that needs no server; none where it was not built.
    #[must_use]
    pub fn whole(&self) -> Option<&[u8]> {
        self.whole.as_deref()
    }

    /// The same with a scenario in it, which it opens first; none where it was not built, or has no place for one.
    #[must_use]
    pub fn whole_with(&self, name: &str, text: &str) -> Option<Vec<u8>> {
        let page = std::str::from_utf8(self.whole()?).ok()?;
        let (before, after) = page.split_once(PLACE)?;
        // In JSON that sign says the same written out, and nothing can end the element then.
        let scenario = json!({ "name": name, "text": text }).to_string().replace('<', "\\u003c");
        let element =
            format!("<script type=\"text/plain\" id=\"fspid-scenario\">{scenario}</script>");
        Some([before, &element, after].concat().into_bytes())
    }

    /// Whether there is one.
    #[must_use]
    pub fn is_built(&self) -> bool {
        self.files.iter().any(|(name, _)| name == INDEX)
    }

    /// The file at a path, if there is one; `/` is the first.
    pub(crate) fn file(&self, path: &str) -> Option<Response<Body>> {
        let name = path.strip_prefix('/')?;
        let name = if name.is_empty() { INDEX } else { name };
        let found = self.files.iter().find(|(known, _)| known == name);
        match found {
            Some((name, bytes)) => {
                let body = match bytes {
                    Cow::Borrowed(bytes) => Bytes::from_static(bytes),
                    Cow::Owned(bytes) => Bytes::copy_from_slice(bytes),
                };
                Some(of_kind(StatusCode::OK, kind(name), body))
            }
            None if name == INDEX => Some(of_kind(StatusCode::OK, kind(name), NOT_BUILT)),
            None => None,
        }
    }
}

/// The kind of content by the ending of a name.
fn kind(name: &str) -> &'static str {
    match name.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        "json" | "webmanifest" => "application/json",
        "txt" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scenario_in_the_page_stays_a_text_whatever_it_is_called() {
        let whole = b"<!doctype html><!-- scenario --><script>1</script>".as_slice();
        let page = Page::of(&[], Some(whole));
        let odd = "</script><script>alert(1)</script><!-- scenario -->";
        let written = page.whole_with(odd, "name = \"<\"\n").expect("it has a place");
        let written = String::from_utf8(written).expect("a text");
        assert_eq!(written.matches("<script").count(), 2, "{written}");
        let inside = written.split("id=\"fspid-scenario\">").nth(1).expect("the element");
        let inside = inside.split("</script>").next().expect("its text");
        let read: serde_json::Value = serde_json::from_str(inside).expect("JSON");
        assert_eq!(read, json!({ "name": odd, "text": "name = \"<\"\n" }));
        assert_eq!(Page::default().whole_with("a", "b"), None);
    }
}
