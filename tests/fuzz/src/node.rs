//! A document as a tree whose leaves are text: TOML and JSON are read into it and written from it, right or wrong.

use std::fmt::Write as _;

/// A part of a document.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// What stands for itself: a number, a word, a string with its quotes.
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
    /// Itself and all nodes within, as paths of places.
    pub fn paths(&self) -> Vec<Vec<usize>> {
        let mut paths = vec![Vec::new()];
        for (place, node) in self.children().enumerate() {
            for mut path in node.paths() {
                path.insert(0, place);
                paths.push(path);
            }
        }
        paths
    }

    fn children(&self) -> Box<dyn Iterator<Item = &Self> + '_> {
        match self {
            Self::Leaf(_) => Box::new(std::iter::empty()),
            Self::Array(of) => Box::new(of.iter()),
            Self::Table(of) => Box::new(of.iter().map(|(_, node)| node)),
        }
    }

    /// The node at a path.
    pub fn at(&mut self, path: &[usize]) -> Option<&mut Self> {
        let Some((place, rest)) = path.split_first() else { return Some(self) };
        match self {
            Self::Leaf(_) => None,
            Self::Array(of) => of.get_mut(*place)?.at(rest),
            Self::Table(of) => of.get_mut(*place)?.1.at(rest),
        }
    }

    /// The node of a key, made if it is not there.
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

    /// As TOML.
    pub fn toml(&self) -> String {
        let mut text = String::new();
        self.sections("", &mut text);
        text
    }

    fn sections(&self, path: &str, text: &mut String) {
        let Self::Table(of) = self else {
            let _ = writeln!(text, "{}", self.inline(" = "));
            return;
        };
        // Tables become sections down to the second level, after the keys that stand before any.
        let deep = path.contains('.');
        for (key, node) in of {
            if deep || !matches!(node, Self::Table(_)) {
                let _ = writeln!(text, "{} = {}", quoted(key, true), node.inline(" = "));
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

    /// As JSON.
    pub fn json(&self) -> String {
        self.inline(": ")
    }

    fn inline(&self, equals: &str) -> String {
        let joined = |parts: Vec<String>| parts.join(", ");
        match self {
            Self::Leaf(text) => text.clone(),
            Self::Array(of) => format!("[{}]", joined(of.iter().map(|node| node.inline(equals)).collect())),
            Self::Table(of) => {
                let pair = |(key, node): &(String, Self)| {
                    format!("{}{equals}{}", quoted(key, equals == " = "), node.inline(equals))
                };
                format!("{{{}}}", joined(of.iter().map(pair).collect()))
            }
        }
    }
}

fn quoted(key: &str, bare: bool) -> String {
    let plain = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if bare && plain { key.to_owned() } else { serde_json::Value::from(key).to_string() }
}
