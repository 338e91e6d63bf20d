//! Local names of a function, and their names in C.

use super::names::{Names, free_name};
use super::types::ValueKind;

/// Local variable or parameter.
#[derive(Debug, Clone)]
pub(super) struct LocalName {
    pub name: String,
    /// Name in C.
    pub c_name: String,
    /// Name in C of the length of a slice.
    pub length_name: String,
    pub kind: ValueKind,
    pub is_mutable: bool,
    pub is_used: bool,
    pub is_length_used: bool,
}

/// Names that are visible at a place, the innermost block last.
#[derive(Debug, Default)]
pub(super) struct Scopes {
    blocks: Vec<Vec<LocalName>>,
}

impl Scopes {
    /// Opens a block.
    pub(super) fn open(&mut self) {
        self.blocks.push(Vec::new());
    }

    /// Closes the innermost block.
    pub(super) fn close(&mut self) -> Vec<LocalName> {
        self.blocks.pop().unwrap_or_default()
    }

    /// Declares a name and returns its name in C, which differs from all that are visible.
    pub(super) fn declare(&mut self, names: &Names, name: &str, kind: ValueKind, is_mutable: bool) -> String {
        let c_name = self.unused_name(names, &free_name(name));
        let length_name = match kind {
            ValueKind::Slice { .. } => self.unused_name(names, &format!("{c_name}_len")),
            _ => String::new(),
        };
        let local = LocalName {
            name: name.to_owned(),
            c_name: c_name.clone(),
            length_name,
            kind,
            is_mutable,
            is_used: false,
            is_length_used: false,
        };
        if let Some(block) = self.blocks.last_mut() {
            block.push(local);
        }
        c_name
    }

    /// Hides a local until its value is computed; its name in C stays reserved.
    pub(super) fn hide(&mut self, c_name: &str) {
        self.rename(c_name, "");
    }

    /// Shows a hidden local under its name.
    pub(super) fn show(&mut self, c_name: &str, name: &str) {
        self.rename(c_name, name);
    }

    fn rename(&mut self, c_name: &str, name: &str) {
        if let Some(local) = self.blocks.iter_mut().flatten().find(|local| local.c_name == c_name) {
            name.clone_into(&mut local.name);
        }
    }

    /// Returns a name in C that is not visible.
    pub(super) fn unused_name(&self, names: &Names, start: &str) -> String {
        let mut name = start.to_owned();
        let mut count = 1;
        while names.is_taken(&name)
            || self.blocks.iter().flatten().any(|local| local.c_name == name || local.length_name == name)
        {
            count += 1;
            name = format!("{start}_{count}");
        }
        name
    }

    /// Returns the innermost local of a name.
    pub(super) fn find(&mut self, name: &str) -> Option<&mut LocalName> {
        self.blocks.iter_mut().rev().flat_map(|block| block.iter_mut().rev()).find(|local| local.name == name)
    }

    /// Returns the innermost local of a name, to read its type.
    pub(super) fn look(&self, name: &str) -> Option<&LocalName> {
        self.blocks.iter().rev().flat_map(|block| block.iter().rev()).find(|local| local.name == name)
    }

    /// Returns the outermost block: the parameters.
    pub(super) fn parameters(&self) -> &[LocalName] {
        self.blocks.first().map_or(&[], Vec::as_slice)
    }
}
