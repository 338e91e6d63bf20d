//! XML text with indented elements.

use std::fmt::Write as _;

/// Document that is written element by element.
#[derive(Debug)]
pub struct XmlWriter {
    text: String,
    open: Vec<&'static str>,
}

impl XmlWriter {
    /// Creates a document without elements.
    pub fn new() -> Self {
        Self { text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned(), open: Vec::new() }
    }

    /// Opens an element with these attributes.
    pub fn open(&mut self, name: &'static str, attributes: &[(&str, String)]) {
        self.start(name, attributes, ">");
        self.open.push(name);
    }

    /// Closes the last open element.
    pub fn close(&mut self) {
        if let Some(name) = self.open.pop() {
            // Writing to a string cannot fail.
            let _ = writeln!(self.text, "{}</{name}>", "  ".repeat(self.open.len()));
        }
    }

    /// Writes an element without content.
    pub fn empty(&mut self, name: &str, attributes: &[(&str, String)]) {
        self.start(name, attributes, "/>");
    }

    fn start(&mut self, name: &str, attributes: &[(&str, String)], end: &str) {
        let _ = write!(self.text, "{}<{name}", "  ".repeat(self.open.len()));
        for (key, value) in attributes {
            let _ = write!(self.text, " {key}=\"{}\"", escape(value));
        }
        let _ = writeln!(self.text, "{end}");
    }

    /// Returns the document, with all elements closed.
    pub fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }
}

/// Returns a text as the value of an attribute, without control characters.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            control if control.is_control() => escaped.push(' '),
            other => escaped.push(other),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_nested_and_values_escaped() {
        let mut xml = XmlWriter::new();
        xml.open("a", &[("b", "<\"&\">\n".to_owned())]);
        xml.empty("c", &[]);
        let text = xml.finish();
        assert!(text.ends_with("<a b=\"&lt;&quot;&amp;&quot;&gt; \">\n  <c/>\n</a>\n"), "{text}");
    }
}
