//! The `Debug` form of a value as a tree.
//!
//! A report shows every setting that a flight had, also those that no file gave. `Debug` is derived, so
//! it lists each field of each type, and one that is added later cannot be forgotten here.

/// A value as `Debug` writes it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Node {
    /// A structure with named fields.
    Struct(String, Vec<(String, Node)>),
    /// A structure or variant with unnamed fields.
    Tuple(String, Vec<Node>),
    /// A list.
    List(Vec<Node>),
    /// Text in quotes.
    Text(String),
    /// A number or a word.
    Word(String),
}

impl Node {
    /// Of any value.
    pub(super) fn of(value: &impl std::fmt::Debug) -> Self {
        let text = format!("{value:?}");
        Reader { rest: &text }.node()
    }

    /// The field with this name.
    pub(super) fn field(&self, name: &str) -> Option<&Self> {
        match self {
            Self::Struct(_, fields) => {
                fields.iter().find(|(of, _)| of == name).map(|(_, node)| node)
            }
            _ => None,
        }
    }

    /// The fields below these names, one after the other.
    pub(super) fn at(&self, path: &[&str]) -> Option<&Self> {
        path.iter().try_fold(self, |node, name| node.inside().field(name))
    }

    /// What a `Some`, or another wrapper of one value, holds.
    pub(super) fn inside(&self) -> &Self {
        match self {
            Self::Tuple(_, fields) if fields.len() == 1 => {
                fields.first().map_or(self, Self::inside)
            }
            _ => self,
        }
    }

    /// The number that this is.
    pub(super) fn number(&self) -> Option<f64> {
        match self.inside() {
            Self::Word(word) => word.parse().ok(),
            _ => None,
        }
    }

    /// The items of a list.
    pub(super) fn items(&self) -> &[Self] {
        match self.inside() {
            Self::List(items) => items,
            _ => &[],
        }
    }
}

struct Reader<'a> {
    rest: &'a str,
}

impl Reader<'_> {
    fn skip(&mut self) {
        self.rest = self.rest.trim_start_matches([' ', ',']);
    }

    fn take(&mut self, token: char) -> bool {
        self.skip();
        let found = self.rest.strip_prefix(token);
        self.rest = found.unwrap_or(self.rest);
        found.is_some()
    }

    fn word(&mut self) -> String {
        self.skip();
        let end = self.rest.find([' ', ',', '{', '}', '(', ')', '[', ']', ':', '"']);
        let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        word.to_owned()
    }

    fn node(&mut self) -> Node {
        if self.take('[') {
            return Node::List(self.until(']'));
        }
        if self.take('"') {
            return Node::Text(self.quoted());
        }
        let name = self.word();
        if self.rest.starts_with('(') {
            self.take('(');
            return Node::Tuple(name, self.until(')'));
        }
        if !name.is_empty() && self.rest.starts_with(" {") {
            self.take('{');
            return Node::Struct(name, self.fields());
        }
        Node::Word(name)
    }

    fn until(&mut self, end: char) -> Vec<Node> {
        let mut nodes = Vec::new();
        while !self.take(end) && !self.rest.is_empty() {
            let before = self.rest.len();
            nodes.push(self.node());
            if self.rest.len() == before {
                break;
            }
        }
        nodes
    }

    fn fields(&mut self) -> Vec<(String, Node)> {
        let mut fields = Vec::new();
        while !self.take('}') && !self.rest.is_empty() {
            let (before, name) = (self.rest.len(), self.word());
            self.take(':');
            fields.push((name, self.node()));
            if self.rest.len() == before {
                break;
            }
        }
        fields
    }

    /// After the opening quote: up to the closing one.
    fn quoted(&mut self) -> String {
        let mut text = String::new();
        let mut escaped = false;
        for (at, c) in self.rest.char_indices() {
            match c {
                '"' if !escaped => {
                    self.rest = &self.rest[at + 1..];
                    return text;
                }
                '\\' if !escaped => escaped = true,
                c => {
                    text.push(c);
                    escaped = false;
                }
            }
        }
        self.rest = "";
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    #[allow(dead_code, reason = "read through Debug only")]
    struct Inner(Option<f64>);

    #[derive(Debug)]
    #[allow(dead_code, reason = "read through Debug only")]
    struct Outer {
        name: &'static str,
        list: Vec<Inner>,
        unit: (),
        empty: Vec<f64>,
        last: f64,
    }

    #[test]
    fn a_value_is_read_back_from_its_debug_form() {
        let outer = Outer {
            name: "a \"b\", {c} <script>",
            list: vec![Inner(None), Inner(Some(-1e-300))],
            unit: (),
            empty: Vec::new(),
            last: f64::INFINITY,
        };
        let node = Node::of(&outer);
        assert_eq!(node.at(&["name"]), Some(&Node::Text("a \"b\", {c} <script>".to_owned())));
        let list = node.at(&["list"]).map(Node::items).unwrap_or_default();
        assert_eq!(list.iter().map(Node::number).collect::<Vec<_>>(), [None, Some(-1e-300)]);
        assert_eq!(node.at(&["last"]).and_then(Node::number), Some(f64::INFINITY));
        assert_eq!(node.at(&["empty"]).map(|node| node.items().len()), Some(0));
    }
}
