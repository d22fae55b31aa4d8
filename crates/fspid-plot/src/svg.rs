//! The drawing surface: text, lines, boxes and paths become one self-contained SVG.
//!
//! Everything that a figure draws passes through [`Canvas`], so numbers are rounded, text is
//! escaped, colours follow the page and ids are unique in one place.

use std::collections::BTreeSet;
use std::fmt;

use super::style::Role;
use super::text::{escape, fingerprint, num, rich, slug, unmarked};

/// A finished figure: an SVG document that can stand alone or be put into an HTML page as it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Svg(String);

impl Svg {
    /// The text of the document.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The text of the document, owned.
    #[must_use]
    pub fn into_string(self) -> String {
        self.0
    }
}

impl fmt::Display for Svg {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// Stands for the figure's own id until the content is known. Not allowed in XML, so never in a label.
const ID: char = '\u{1}';

/// Where a text is anchored horizontally.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Font {
    pub(super) size: f64,
    pub(super) anchor: Anchor,
    pub(super) bold: bool,
    pub(super) italic: bool,
    pub(super) rotate_deg: f64,
    pub(super) role: Role,
}

impl Font {
    /// Upright ink of `size` px.
    pub(super) const fn new(size: f64, anchor: Anchor) -> Self {
        Self { size, anchor, bold: false, italic: false, rotate_deg: 0.0, role: Role::Ink }
    }

    pub(super) const fn bold(mut self) -> Self {
        self.bold = true;
        self
    }

    pub(super) const fn italic(mut self) -> Self {
        self.italic = true;
        self
    }

    pub(super) const fn turned(mut self, degrees: f64) -> Self {
        self.rotate_deg = degrees;
        self
    }

    pub(super) const fn role(mut self, role: Role) -> Self {
        self.role = role;
        self
    }
}

/// How an outline or a face is painted.
#[derive(Debug, Clone)]
pub(super) struct Paint {
    pub(super) fill: Role,
    pub(super) stroke: Role,
    pub(super) width: f64,
    pub(super) dash: String,
    pub(super) opacity: Option<f64>,
}

impl Paint {
    /// An outline of `width` px.
    pub(super) const fn line(stroke: Role, width: f64) -> Self {
        Self { fill: Role::None, stroke, width, dash: String::new(), opacity: None }
    }

    /// A face without outline.
    pub(super) const fn face(fill: Role) -> Self {
        Self { fill, stroke: Role::None, width: 0.0, dash: String::new(), opacity: None }
    }

    pub(super) fn dashed(mut self, dash: &str) -> Self {
        dash.clone_into(&mut self.dash);
        self
    }

    pub(super) const fn filled(mut self, fill: Role) -> Self {
        self.fill = fill;
        self
    }

    pub(super) const fn opacity(mut self, opacity: f64) -> Self {
        self.opacity = Some(opacity);
        self
    }
}

/// A figure being drawn; the origin is the upper left corner, units are px.
#[derive(Debug)]
pub(super) struct Canvas {
    body: String,
    clips: usize,
    width: f64,
    height: f64,
    used: BTreeSet<(bool, Role)>,
}

impl Canvas {
    /// An empty figure of that size.
    pub(super) fn new(width: f64, height: f64) -> Self {
        let mut canvas =
            Self { body: String::new(), clips: 0, width, height, used: BTreeSet::new() };
        canvas.rect(0.0, 0.0, width, height, &Paint::face(Role::Paper));
        canvas
    }

    /// Width of the figure (px).
    pub(super) const fn width(&self) -> f64 {
        self.width
    }

    /// Writes `text` with its baseline at `y`.
    pub(super) fn text(&mut self, x: f64, y: f64, text: &str, font: Font) {
        self.marked_text((x, y), text, font, "");
    }

    /// Writes the name of an axis, `"x"` or `"y"`; a line of a longer name is marked with all of it.
    pub(super) fn axis_text(
        &mut self,
        at: (f64, f64),
        text: &str,
        font: Font,
        (axis, all): (&str, &str),
    ) {
        let mark = format!(" data-axis=\"{axis}\" data-label=\"{}\"", escape(&unmarked(all)));
        self.marked_text(at, text, font, &mark);
    }

    fn marked_text(&mut self, (x, y): (f64, f64), text: &str, font: Font, mark: &str) {
        let mut tag = format!(
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\"{mark}",
            num(x),
            num(y),
            num(font.size)
        );
        match font.anchor {
            Anchor::Start => {}
            Anchor::Middle => tag.push_str(" text-anchor=\"middle\""),
            Anchor::End => tag.push_str(" text-anchor=\"end\""),
        }
        if font.bold {
            tag.push_str(" font-weight=\"600\"");
        }
        if font.italic {
            tag.push_str(" font-style=\"italic\"");
        }
        if font.rotate_deg != 0.0 {
            tag.push_str(&format!(
                " transform=\"rotate({} {} {})\"",
                num(font.rotate_deg),
                num(x),
                num(y)
            ));
        }
        self.body.push_str(&tag);
        let paint = Paint::face(font.role);
        self.paint(&paint);
        let content = rich(text);
        if content.contains("<tspan") {
            // Or some renderers drop the space before a span.
            self.body.push_str(" xml:space=\"preserve\"");
        }
        self.body.push_str(&format!(">{content}</text>\n"));
    }

    /// Draws a straight line.
    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64), paint: &Paint) {
        self.body.push_str(&format!(
            "<path d=\"M{} {}L{} {}\"",
            num(from.0),
            num(from.1),
            num(to.0),
            num(to.1)
        ));
        self.paint(paint);
        self.body.push_str("/>\n");
    }

    /// Draws a rectangle.
    pub(super) fn rect(&mut self, x: f64, y: f64, width: f64, height: f64, paint: &Paint) {
        self.rounded(Rect { x, y, width, height }, 0.0, paint);
    }

    /// Draws a rectangle with rounded corners.
    pub(super) fn rounded(&mut self, r: Rect, radius: f64, paint: &Paint) {
        let (w, h) = (num(r.width.max(0.0)), num(r.height.max(0.0)));
        self.body.push_str(&format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{w}\" height=\"{h}\"",
            num(r.x),
            num(r.y)
        ));
        if radius > 0.0 {
            self.body.push_str(&format!(" rx=\"{}\"", num(radius)));
        }
        self.paint(paint);
        self.body.push_str("/>\n");
    }

    /// Draws a circle.
    pub(super) fn circle(&mut self, centre: (f64, f64), radius: f64, paint: &Paint) {
        let (x, y) = (num(centre.0), num(centre.1));
        self.body.push_str(&format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\"", num(radius)));
        self.paint(paint);
        self.body.push_str("/>\n");
    }

    /// Draws a line through points; a single point becomes a dot. `closed` joins the ends.
    pub(super) fn polyline(&mut self, points: &[(f64, f64)], closed: bool, paint: &Paint) {
        let d = polyline_data(points, closed);
        if d.contains('l') {
            self.path(&d, paint);
        } else if let Some(&point) = points.first() {
            self.circle(point, paint.width.max(1.0) * 1.2, &Paint::face(paint.stroke));
        }
    }

    /// Draws SVG path data that was made from rounded numbers.
    pub(super) fn path(&mut self, d: &str, paint: &Paint) {
        self.body.push_str("<path d=\"");
        self.body.push_str(&escape(d));
        self.body.push('"');
        self.paint(paint);
        if paint.stroke != Role::None {
            self.body.push_str(" stroke-linejoin=\"round\"");
        }
        self.body.push_str("/>\n");
    }

    /// Opens a group that hides what lies outside of `r`; close it with [`Canvas::end`].
    pub(super) fn begin_clip(&mut self, r: Rect) {
        self.clips += 1;
        let n = self.clips;
        self.body.push_str(&format!(
            "<clipPath id=\"{ID}-c{n}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\
             <g clip-path=\"url(#{ID}-c{n})\">\n",
            num(r.x),
            num(r.y),
            num(r.width),
            num(r.height)
        ));
    }

    /// Opens a group that says with `data-` attributes, written as they are, what is drawn in it; a script reads them.
    pub(super) fn begin_marked(&mut self, data: &str) {
        self.body.push_str(&format!("<g {data}>\n"));
    }

    /// Opens a group that holds a curve: the key of its style, and its name where it has one.
    pub(super) fn begin_curve(&mut self, key: &str, name: &str) {
        let name = if name.is_empty() {
            String::new()
        } else {
            format!(" data-name=\"{}\"", escape(&unmarked(name)))
        };
        self.begin_marked(&format!("data-curve=\"{key}\"{name}"));
    }

    /// Opens a group that is moved by (`dx`, `dy`).
    pub(super) fn begin_shift(&mut self, dx: f64, dy: f64) {
        self.body.push_str(&format!("<g transform=\"translate({} {})\">\n", num(dx), num(dy)));
    }

    /// Opens a group that is turned by `degrees` about `centre`.
    pub(super) fn begin_turn(&mut self, degrees: f64, centre: (f64, f64)) {
        let (a, x, y) = (num(degrees), num(centre.0), num(centre.1));
        self.body.push_str(&format!("<g transform=\"rotate({a} {x} {y})\">\n"));
    }

    /// Closes the last group.
    pub(super) fn end(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// Attributes of fill and stroke: the colour for stand-alone use and a class that follows the page.
    fn paint(&mut self, paint: &Paint) {
        let mut classes = String::new();
        for (is_stroke, role) in [(false, paint.fill), (true, paint.stroke)] {
            if is_stroke && role == Role::None {
                continue;
            }
            let attribute = if is_stroke { "stroke" } else { "fill" };
            self.body.push_str(&format!(" {attribute}=\"{}\"", role.fallback()));
            if role.variable().is_some() {
                self.used.insert((is_stroke, role));
                if !classes.is_empty() {
                    classes.push(' ');
                }
                classes.push_str(&class(is_stroke, role));
            }
        }
        if !classes.is_empty() {
            self.body.push_str(&format!(" class=\"{classes}\""));
        }
        if paint.stroke != Role::None {
            self.body.push_str(&format!(" stroke-width=\"{}\"", num(paint.width)));
            if !paint.dash.is_empty() {
                self.body.push_str(&format!(" stroke-dasharray=\"{}\"", escape(&paint.dash)));
            }
        }
        if let Some(opacity) = paint.opacity {
            self.body.push_str(&format!(" opacity=\"{}\"", num(opacity)));
        }
    }

    /// Closes the document. `description` tells a screen reader what is to be seen.
    pub(super) fn finish(self, title: &str, description: &str) -> Svg {
        let (w, h) = (num(self.width), num(self.height));
        let mut rules = String::new();
        for (is_stroke, role) in &self.used {
            let property = if *is_stroke { "stroke" } else { "fill" };
            let (name, variable) = (class(*is_stroke, *role), role.variable().unwrap_or_default());
            rules.push_str(&format!(
                "#{ID} .{name}{{{property}:var(--figure-{variable},{})}}",
                role.fallback()
            ));
        }
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"{ID}\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" \
             role=\"img\" aria-labelledby=\"{ID}-t {ID}-d\" font-family=\"Helvetica, Arial, sans-serif\" \
             style=\"max-width:100%;height:auto\">\n<title id=\"{ID}-t\">{}</title>\n<desc id=\"{ID}-d\">{}</desc>\n\
             <style>{rules}</style>\n{}</svg>\n",
            escape(&unmarked(title)),
            escape(&unmarked(description)),
            self.body
        );
        let id = format!("fig-{}-{:08x}", slug(title), fingerprint(&text));
        Svg(text.replace(ID, &id))
    }
}

/// A rectangle by its upper left corner (px).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

fn class(is_stroke: bool, role: Role) -> String {
    let kind = if is_stroke { 's' } else { 'f' };
    format!("{kind}-{}", role.variable().unwrap_or_default())
}

/// Path data through points, in relative steps of a hundredth of a pixel without drift.
pub(super) fn polyline_data(points: &[(f64, f64)], closed: bool) -> String {
    let cents = |v: f64| {
        if v.is_finite() { (v.clamp(-1e7, 1e7) * 100.0).round() as i64 } else { 0 }
    };
    let mut data = String::new();
    let mut last: Option<(i64, i64)> = None;
    for &(x, y) in points {
        let now = (cents(x), cents(y));
        match last {
            None => data.push_str(&format!("M{} {}", hundredths(now.0), hundredths(now.1))),
            Some(before) if before == now => continue,
            Some(before) => {
                let (dx, dy) = (hundredths(now.0 - before.0), hundredths(now.1 - before.1));
                let gap = if dy.starts_with('-') { "" } else { " " };
                data.push_str(&format!("l{dx}{gap}{dy}"));
            }
        }
        last = Some(now);
    }
    if closed && !data.is_empty() {
        data.push('z');
    }
    data
}

/// `cents / 100` in the fewest characters.
fn hundredths(cents: i64) -> String {
    let sign = if cents < 0 { "-" } else { "" };
    let (whole, part) = (cents.unsigned_abs() / 100, cents.unsigned_abs() % 100);
    let whole_text = if whole == 0 && part != 0 { String::new() } else { whole.to_string() };
    match part {
        0 => format!("{sign}{whole_text}"),
        _ if part % 10 == 0 => format!("{sign}{whole_text}.{}", part / 10),
        _ => format!("{sign}{whole_text}.{part:02}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn path_steps_are_short_and_skip_repeated_points() {
        assert_eq!(polyline_data(&[(0.0, 0.0), (0.5, -1.0), (0.5, -1.0)], false), "M0 0l.5-1");
    }

    #[test]
    fn labels_cannot_break_out_of_the_document() {
        assert_eq!(escape("a<b>&\"\u{1}\u{0}"), "a&lt;b&gt;&amp;&quot;");
        let mut canvas = Canvas::new(10.0, 10.0);
        canvas.text(0.0, 0.0, "</text><script>\u{1}", Font::new(10.0, Anchor::Start));
        let svg = canvas.finish("<t>", "\u{1}");
        assert!(!svg.as_str().contains("<script>"));
        assert!(!svg.as_str().contains('\u{1}'));
    }
}
