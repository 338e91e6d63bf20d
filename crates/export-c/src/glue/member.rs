//! Members of the state: their declaration, and the statements that set them.

use std::fmt::{Debug, Write as _};

use super::text::literal;

/// Member of the state.
pub struct Member {
    about: String,
    name: String,
    /// Type of an element.
    kind: String,
    /// Values before the first call.
    values: Vec<String>,
    is_array: bool,
    /// True if a function that `init` calls sets it.
    is_started: bool,
}

impl Member {
    /// Creates a member of one value.
    pub fn new(about: &str, name: &str, kind: &str, value: String) -> Self {
        let [about, name, kind] = [about, name, kind].map(str::to_owned);
        Self { about, name, kind, values: vec![value], is_array: false, is_started: false }
    }

    /// Creates an array of these values.
    pub fn list(about: &str, name: &str, kind: &str, values: &[impl Debug]) -> Self {
        let values = values.iter().map(literal).collect();
        Self { values, is_array: true, ..Self::new(about, name, kind, String::new()) }
    }

    /// Creates an array of equal values.
    pub fn filled(about: &str, name: &str, kind: &str, value: &str, count: usize) -> Self {
        let values = vec![value.to_owned(); count];
        Self { values, is_array: true, ..Self::new(about, name, kind, String::new()) }
    }

    /// Creates a member about each axis, which is no array about one axis.
    pub fn about_axes(about: &str, name: &str, kind: &str, values: &[impl Debug]) -> Self {
        let list = Self::list(about, name, kind, values);
        Self { is_array: values.len() > 1, ..list }
    }

    /// Returns the member as one that a function sets which `init` calls.
    #[must_use]
    pub fn started(self) -> Self {
        Self { is_started: true, ..self }
    }

    /// True if several values are all equal.
    fn is_uniform(&self) -> bool {
        self.values.len() > 1 && self.values.iter().all(|value| *value == self.values[0])
    }

    /// Returns the statements that set it, in a struct with this path.
    fn set(&self, path: &str) -> String {
        let (name, count) = (&self.name, self.values.len());
        if self.is_array && self.is_uniform() {
            let value = &self.values[0];
            return format!(
                "    for index in 0..{count} {{\n        {path}.{name}[index] = {value};\n    }}\n"
            );
        }
        let each = self.values.iter().enumerate().map(|(index, value)| {
            let index = if self.is_array { format!("[{index}]") } else { String::new() };
            format!("    {path}.{name}{index} = {value};\n")
        });
        each.collect()
    }
}

/// Returns the statements that set all members which no function sets, in a struct with this path.
pub fn set_all(members: &[Member], path: &str) -> String {
    members.iter().filter(|member| !member.is_started).map(|member| member.set(path)).collect()
}

/// Returns a struct with these members.
pub fn definition(members: &[Member], about: &str, name: &str) -> String {
    let mut text = format!("/// {about}\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct {name} {{\n");
    for Member { about, name, kind, values, is_array, .. } in members {
        let kind = if *is_array { format!("[{kind}; {}]", values.len()) } else { kind.clone() };
        let _ = writeln!(text, "    /// {about}\n    pub {name}: {kind},");
    }
    text + "}\n\n"
}

/// Returns a value of the struct before the first call.
pub fn value(members: &[Member], name: &str) -> String {
    let member = |member: &Member| {
        let Member { name, values, is_array, .. } = member;
        let value = if !is_array {
            values[0].clone()
        } else if member.is_uniform() {
            format!("[{}; {}]", values[0], values.len())
        } else {
            format!("[{}]", values.join(", "))
        };
        format!("{name}: {value}")
    };
    format!("{name} {{ {} }}", members.iter().map(member).collect::<Vec<_>>().join(", "))
}
