//! Names in C of items, and words that C and its headers reserve.

use std::collections::HashMap;

use super::error::{Outcome, TranslationError};
use super::items::{ItemContent, Program};

/// Names in C of all items.
pub(super) struct Names {
    prefix: String,
    /// True of names in single precision.
    pub is_single: bool,
    items: Vec<String>,
}

impl Names {
    /// Names all items; two items must not share a name.
    pub(super) fn new(program: &Program<'_>, prefix: &str) -> Outcome<Self> {
        let mut names = Self { prefix: prefix.to_owned(), is_single: program.is_single, items: Vec::new() };
        let mut used: HashMap<String, String> = HashMap::new();
        for (index, item) in program.items.iter().enumerate() {
            let parent = match item.owner {
                Some(owner) => snake_case(&program.items[owner].name),
                None => program.files[item.file].module.to_owned(),
            };
            let name = match &item.content {
                _ if program.exported.contains(&index) => format!("{prefix}_{}", item.name.to_lowercase()),
                ItemContent::Struct { .. } | ItemContent::Enum { .. } => {
                    format!("{prefix}_{}", snake_case(&item.name))
                }
                ItemContent::Function { .. } => format!("{parent}_{}", item.name),
                ItemContent::Constant { .. } if program.is_size(index)? => {
                    format!("{prefix}_{parent}_{}", item.name).to_uppercase()
                }
                ItemContent::Constant { .. } => format!("{parent}_{}", item.name).to_uppercase(),
            };
            let path = program.path(index);
            let mut all = vec![name.clone()];
            if let ItemContent::Enum { variants } = &item.content {
                all.extend(variants.iter().map(|(variant, _)| variant_name(&name, variant)));
            }
            for c_name in all {
                let other = used.insert(c_name.clone(), path.clone());
                let found = match other {
                    Some(other) => format!("`{path}` and `{other}`, which both are `{c_name}` in C"),
                    None if is_of_helper(&c_name) => {
                        format!("`{path}`, which is `{c_name}` in C, as helpers are")
                    }
                    None => continue,
                };
                let error = TranslationError::at(item.span, found, "names that differ in C");
                return Err(program.placed(error, item.file));
            }
            names.items.push(name);
        }
        Ok(names)
    }

    /// Returns the name of an item.
    pub(super) fn item(&self, index: usize) -> &str {
        &self.items[index]
    }

    /// Returns the name of a variant of an enum.
    pub(super) fn variant(&self, index: usize, variant: &str) -> String {
        variant_name(&self.items[index], variant)
    }

    /// Returns the prefix of public names.
    pub(super) fn prefix(&self) -> &str {
        &self.prefix
    }

    /// True if an item has this name.
    pub(super) fn is_taken(&self, name: &str) -> bool {
        self.items.iter().any(|item| item == name)
    }
}

fn variant_name(name: &str, variant: &str) -> String {
    format!("{name}_{}", snake_case(variant)).to_uppercase()
}

/// True for names like those of helpers.
fn is_of_helper(name: &str) -> bool {
    ["f64_", "f32_", "i32_", "u32_", "i64_", "u64_", "usize_"].iter().any(|start| name.starts_with(start))
}

/// Returns a name of a type in snake case: `SinCos` is `sin_cos`.
pub(super) fn snake_case(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    let mut text = String::new();
    for (i, letter) in letters.iter().enumerate() {
        if letter.is_uppercase() && i > 0 {
            let follows = !letters[i - 1].is_uppercase();
            let starts = letters.get(i + 1).is_some_and(|next| next.is_lowercase());
            if follows || starts {
                text.push('_');
            }
        }
        text.extend(letter.to_lowercase());
    }
    text
}

/// Returns a name of a local or a field that no compiler of C or C++ reserves.
pub(super) fn free_name(name: &str) -> String {
    let name = name.strip_prefix("r#").unwrap_or(name).trim_start_matches('_');
    let name = if name.is_empty() { "unused" } else { name };
    if is_of_helper(name) {
        return format!("local_{name}");
    }
    if RESERVED.contains(&name) || name.ends_with("_t") { format!("{name}_") } else { name.to_owned() }
}

/// Words of C99 and C++, types and macros of the headers.
const RESERVED: &[&str] = &[
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "case",
    "catch",
    "char",
    "class",
    "compl",
    "complex",
    "constexpr",
    "const_cast",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "explicit",
    "export",
    "extern",
    "far",
    "float",
    "friend",
    "goto",
    "imaginary",
    "inline",
    "int",
    "linux",
    "long",
    "main",
    "memcpy",
    "mutable",
    "namespace",
    "near",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "offsetof",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "restrict",
    "short",
    "signed",
    "sizeof",
    "static_assert",
    "static_cast",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "try",
    "typedef",
    "typeid",
    "typename",
    "union",
    "unix",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "xor",
    "xor_eq",
    "const",
    "else",
    "enum",
    "false",
    "for",
    "if",
    "return",
    "static",
    "struct",
    "true",
    "while",
    "break",
    "continue",
];
