//! A document as a tree whose leaves are text: TOML and JSON are read into it and written from it, right or wrong.

use std::fmt::Write as _;

/// A part of a document.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// Text of a leaf: a number, a word, a string with its quotes.
    Leaf(String),
    Array(Vec<Node>),
    /// Keys, which may stand twice.
    Table(Vec<(String, Node)>),
}

impl From<&toml::Value> for Node {
    fn from(value: &toml::Value) -> Self {
        match value {
            toml::Value::Array(of) => Self::Array(of.iter().map(Self::from).collect()),
            toml::Value::Table(of) => {
                Self::Table(of.iter().map(|(k, v)| (k.clone(), Self::from(v))).collect())
            }
            leaf => Self::Leaf(leaf.to_string()),
        }
    }
}

impl From<&serde_json::Value> for Node {
    fn from(value: &serde_json::Value) -> Self {
        use serde_json::Value as Json;
        match value {
            Json::Array(of) => Self::Array(of.iter().map(Self::from).collect()),
            Json::Object(of) => Self::Table(of.iter().map(|(k, v)| (k.clone(), Self::from(v))).collect()),
            leaf => Self::Leaf(leaf.to_string()),
        }
    }
}

impl Node {
    /// Returns the number of nodes: this one, and all within.
    pub fn count(&self) -> usize {
        1 + self.children().map(Self::count).sum::<usize>()
    }

    /// Returns the path of places to a node, each counted before the nodes within it.
    pub fn path(&self, mut index: usize) -> Vec<usize> {
        let mut path = Vec::new();
        self.seek(&mut index, &mut path);
        path
    }

    fn seek(&self, left: &mut usize, path: &mut Vec<usize>) -> bool {
        if *left == 0 {
            return true;
        }
        *left -= 1;
        for (place, node) in self.children().enumerate() {
            path.push(place);
            if node.seek(left, path) {
                return true;
            }
            path.pop();
        }
        false
    }

    fn children(&self) -> Box<dyn Iterator<Item = &Self> + '_> {
        match self {
            Self::Leaf(_) => Box::new(std::iter::empty()),
            Self::Array(of) => Box::new(of.iter()),
            Self::Table(of) => Box::new(of.iter().map(|(_, node)| node)),
        }
    }

    /// Returns the node at a path.
    pub fn at(&mut self, path: &[usize]) -> Option<&mut Self> {
        let Some((place, rest)) = path.split_first() else { return Some(self) };
        match self {
            Self::Leaf(_) => None,
            Self::Array(of) => of.get_mut(*place)?.at(rest),
            Self::Table(of) => of.get_mut(*place)?.1.at(rest),
        }
    }

    /// Returns the node of a key, created if it does not exist.
    pub fn key(&mut self, key: &str) -> &mut Self {
        if !matches!(self, Self::Table(_)) {
            *self = Self::Table(Vec::new());
        }
        let Self::Table(of) = self else { unreachable!("it is a table") };
        let place = of.iter().position(|(k, _)| k == key).unwrap_or_else(|| {
            of.push((key.to_owned(), Self::Leaf("0".to_owned())));
            of.len() - 1
        });
        &mut of[place].1
    }

    /// Writes the document as TOML.
    pub fn toml(&self) -> String {
        let mut text = String::new();
        self.sections("", &mut text);
        text
    }

    fn sections(&self, path: &str, text: &mut String) {
        let Self::Table(of) = self else {
            self.inline(" = ", text);
            return text.push('\n');
        };
        // Tables become sections down to the second level, after the keys that stand before any.
        let deep = path.contains('.');
        for (key, node) in of {
            if deep || !matches!(node, Self::Table(_)) {
                let _ = write!(text, "{} = ", quoted(key, true));
                node.inline(" = ", text);
                text.push('\n');
            }
        }
        for (key, node) in of {
            if !deep && matches!(node, Self::Table(_)) {
                let dot = if path.is_empty() { "" } else { "." };
                let path = format!("{path}{dot}{}", quoted(key, true));
                let _ = writeln!(text, "[{path}]");
                node.sections(&path, text);
            }
        }
    }

    /// Writes the document as JSON.
    pub fn json(&self) -> String {
        let mut text = String::new();
        self.inline(": ", &mut text);
        text
    }

    fn inline(&self, equals: &str, text: &mut String) {
        let comma = |place| if place > 0 { ", " } else { "" };
        match self {
            Self::Leaf(leaf) => text.push_str(leaf),
            Self::Array(of) => {
                text.push('[');
                for (place, node) in of.iter().enumerate() {
                    text.push_str(comma(place));
                    node.inline(equals, text);
                }
                text.push(']');
            }
            Self::Table(of) => {
                text.push('{');
                for (place, (key, node)) in of.iter().enumerate() {
                    let _ = write!(text, "{}{}{equals}", comma(place), quoted(key, equals == " = "));
                    node.inline(equals, text);
                }
                text.push('}');
            }
        }
    }
}

fn quoted(key: &str, bare: bool) -> String {
    let plain = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if bare && plain { key.to_owned() } else { serde_json::Value::from(key).to_string() }
}
