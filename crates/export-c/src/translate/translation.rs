//! Translation of the items that some roots need.

use std::collections::BTreeMap;

use super::comments::comment;
use super::constants::{declare_constant, define_constant};
use super::error::{Outcome, TranslationError};
use super::functions::{TranslatedFunction, translate_function};
use super::items::{EXPORTED_MODULE, ItemContent, Program};
use super::names::{Names, free_name};
use super::order::by_module;
use super::prelude::{INCLUDES, guards};
use super::pruning::ConstantChoices;
use super::reach::{reach, refuse_recursion};
use super::writer::push;

/// File of Rust.
#[derive(Debug, Clone, Copy)]
pub struct SourceFile<'a> {
    /// Path, for messages.
    pub path: &'a str,
    /// Name of the module: the file's name without its extension.
    pub module: &'a str,
    /// Text.
    pub text: &'a str,
}

/// Translated items in C99, and their names.
#[derive(Debug, Clone, Default)]
pub struct Translation {
    /// Lines `#include <..>` that the other parts need.
    pub includes: String,
    /// Guards that stop the build under compilers that change bits, for the top of the .c file.
    pub guards: String,
    /// Sizes, enums and structs for the header, in order.
    pub declarations: String,
    /// Constants and functions of the C library, for the header.
    pub prototypes: String,
    /// Helpers, constants and functions for the .c file, in order.
    pub definitions: String,
    functions: BTreeMap<String, String>,
}

impl Translation {
    /// Returns the name in C of a reachable function `module::name` or `module::Type::name`.
    pub fn function_name(&self, path: &str) -> Option<&str> {
        self.functions.get(path).map(String::as_str)
    }
}

/// Translates the items that some roots need; all items of the files are checked.
///
/// A root is the path of a function, type or constant: `relay::Relay::decide`, `maths::sin`.
pub fn translate(
    files: &[SourceFile<'_>],
    roots: &[&str],
    prefix: &str,
) -> Result<Translation, TranslationError> {
    translate_items(files, prefix, &ConstantChoices::default(), |program| {
        let find = |root: &&str| {
            program.find_absolute(root).ok_or_else(|| {
                TranslationError::without_place(format!("the root `{root}`"), "paths `module::name` of items")
            })
        };
        roots.iter().map(find).collect()
    })
}

/// Translates the module `control_system` and what it needs, without the branches that choices which are constant never take. Its
/// public functions and constants are those of the C library.
pub fn translate_library(
    files: &[SourceFile<'_>],
    prefix: &str,
    choices: &ConstantChoices,
) -> Result<Translation, TranslationError> {
    translate_items(files, prefix, choices, |program| Ok(program.exported.clone()))
}

/// Translates the items that those need which `roots` returns; all items of the files are checked.
fn translate_items(
    files: &[SourceFile<'_>],
    prefix: &str,
    choices: &ConstantChoices,
    roots: impl FnOnce(&Program<'_>) -> Outcome<Vec<usize>>,
) -> Result<Translation, TranslationError> {
    let program = Program::collect(files, choices)?;
    let names = Names::new(&program, prefix)?;
    let functions = translate_functions(&program, &names)?;
    refuse_recursion(&program, &functions)?;
    let parts = reach(&program, &functions, &roots(&program)?)?;
    let mut translation = Translation {
        includes: INCLUDES.to_owned(),
        guards: guards(program.is_single).replace("PREFIX", names.prefix()),
        ..Translation::default()
    };
    for helper in &parts.helpers {
        translation.definitions += &helper.text(program.is_single);
        translation.definitions.push('\n');
    }
    let is_own = |index: &usize| program.files[program.items[*index].file].module == EXPORTED_MODULE;
    let mut own = Vec::new();
    for index in &parts.items {
        let text = match &program.items[*index].content {
            ItemContent::Struct { .. } | ItemContent::Enum { .. } => declare_type(&program, &names, *index)?,
            ItemContent::Constant { .. } if program.is_size(*index)? => {
                define_constant(&program, &names, *index)?
            }
            _ => continue,
        };
        if is_own(index) {
            own.push((*index, text));
        } else {
            translation.declarations += &text;
            translation.declarations.push('\n');
        }
    }
    // The flight code needs no types of the library: they follow in their order.
    own.sort_unstable();
    translation.declarations.extend(own.into_iter().map(|(_, text)| text + "\n"));
    for index in &program.exported {
        translation.prototypes += &match &functions[*index] {
            Some(function) => function.prototype.clone(),
            None => declare_constant(&program, &names, *index)?,
        };
        translation.prototypes.push('\n');
    }
    let mut module = usize::MAX;
    let mut headed = Vec::new();
    for index in by_module(&program, &functions, &parts.items)? {
        let file = program.items[index].file;
        if file != module {
            translation.definitions += &heading(&program, file, headed.contains(&file));
            headed.push(file);
            module = file;
        }
        translation.definitions += &match &functions[index] {
            Some(function) => {
                translation.functions.insert(program.path(index), names.item(index).to_owned());
                function.text.clone()
            }
            None => define_constant(&program, &names, index)?,
        };
        translation.definitions.push('\n');
    }
    Ok(translation)
}

fn translate_functions(program: &Program<'_>, names: &Names) -> Outcome<Vec<Option<TranslatedFunction>>> {
    let lines: Vec<Vec<&str>> = program.files.iter().map(|file| file.text.lines().collect()).collect();
    let mut functions = Vec::new();
    for (index, item) in program.items.iter().enumerate() {
        if let ItemContent::Struct { fields } = &item.content {
            for field in fields {
                program.field_kind(index, &field.name)?;
            }
        }
        if matches!(item.content, ItemContent::Constant { .. }) {
            define_constant(program, names, index)?;
        }
        let function = translate_function(program, names, &lines[item.file], index);
        functions.push(function.map_err(|error| program.placed(error, item.file))?);
    }
    Ok(functions)
}

/// Returns the comment of a module, with its notices of copyright where it comes first.
fn heading(program: &Program<'_>, module: usize, is_repeated: bool) -> String {
    let name = program.files[module].module;
    let lines = match program.module_docs[module].split_first() {
        Some((first, rest)) if !is_repeated => {
            let mut lines = vec![format!("Module {name}: {first}")];
            lines.extend(rest.iter().cloned());
            lines
        }
        _ => vec![format!("Module {name}, continued")],
    };
    format!("{}\n", comment(&lines, 0))
}

fn declare_type(program: &Program<'_>, names: &Names, index: usize) -> Outcome<String> {
    let item = &program.items[index];
    let name = names.item(index);
    let mut text = comment(&item.docs, 0);
    match &item.content {
        ItemContent::Struct { fields } => {
            text.push_str("typedef struct {\n");
            for field in fields {
                text += &comment(&field.docs, 4);
                if let Some(kind) = program.field_kind(index, &field.name)? {
                    push(
                        &mut text,
                        format_args!("    {};\n", names.declaration(&kind, &free_name(&field.name))),
                    );
                }
            }
        }
        ItemContent::Enum { variants } => {
            push(&mut text, format_args!("typedef enum {name} {{\n"));
            for (variant, docs) in variants {
                text += &comment(docs, 4);
                push(&mut text, format_args!("    {},\n", names.variant(index, variant)));
            }
            // C99 allows the last comma.
        }
        _ => {}
    }
    Ok(format!("{text}}} {name};\n"))
}
