//! Pages as their readers see them.

/// The text of a page without escapes.
pub(crate) fn as_read(html: &str) -> String {
    let escapes =
        [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#x27;", "'"), ("&#x2f;", "/")];
    let read = escapes.iter().fold(html.to_owned(), |text, (from, to)| text.replace(from, to));
    read.replace("&amp;", "&")
}
