//! Paths: items that names stand for, through imports.

use syn::Path;

use super::error::TranslationError;
use super::items::{ItemContent, Program};

impl Program<'_> {
    /// Names the file of an error.
    pub(super) fn placed(&self, error: TranslationError, file: usize) -> TranslationError {
        error.in_file(self.files[file].path)
    }

    /// Returns the struct or enum of a name that a file uses.
    pub(super) fn type_in(&self, file: usize, name: &str) -> Option<usize> {
        self.find_words(file, None, &[name.to_owned()])
    }

    /// Returns the item of a path that a file uses; `owner` is `Self`.
    pub(super) fn find(&self, file: usize, owner: Option<usize>, path: &Path) -> Option<usize> {
        self.find_words(file, owner, &words(path))
    }

    /// Returns the enum and the position of the variant that a path names.
    pub(super) fn find_variant(
        &self,
        file: usize,
        owner: Option<usize>,
        path: &Path,
    ) -> Option<(usize, usize)> {
        let words = words(path);
        let (variant, parent) = words.split_last()?;
        let index = self.find_words(file, owner, parent)?;
        let ItemContent::Enum { variants } = &self.items[index].content else { return None };
        let position = variants.iter().position(|(name, _)| name == variant)?;
        Some((index, position))
    }

    fn find_words(&self, file: usize, owner: Option<usize>, words: &[String]) -> Option<usize> {
        let module = self.files[file].module;
        let (first, rest) = words.split_first()?;
        let joined =
            |start: String| -> String { rest.iter().fold(start, |path, word| format!("{path}::{word}")) };
        if first == "crate" {
            return self.find_absolute(&rest.join("::"));
        }
        if first == "Self" {
            return self.find_absolute(&joined(self.path(owner?)));
        }
        if self.by_path.contains_key(&format!("{module}::{first}")) {
            return self.find_absolute(&joined(format!("{module}::{first}")));
        }
        let target = self.imports.get(&(module.to_owned(), first.clone()))?;
        self.find_absolute(&joined(target.clone()))
    }

    /// Returns the item of a path from the root of the crate; imports lead on to other modules.
    pub(super) fn find_absolute(&self, path: &str) -> Option<usize> {
        let mut path = path.to_owned();
        for _ in 0..8 {
            if let Some(index) = self.by_path.get(&path) {
                return Some(*index);
            }
            let mut words = path.splitn(3, "::");
            let (module, name, rest) = (words.next()?, words.next()?, words.next());
            let target = self.imports.get(&(module.to_owned(), name.to_owned()))?;
            path = match rest {
                Some(rest) => format!("{target}::{rest}"),
                None => target.clone(),
            };
        }
        None
    }
}

/// Returns the words of a path.
pub(super) fn words(path: &Path) -> Vec<String> {
    path.segments.iter().map(|segment| segment.ident.to_string()).collect()
}

/// Returns a path as Rust writes it.
pub(super) fn show(path: &Path) -> String {
    words(path).join("::")
}
