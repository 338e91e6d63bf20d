//! Functions: signature, documentation and body.

use syn::spanned::Spanned;
use syn::{FnArg, Pat};

use super::comments::comment;
use super::error::{Outcome, refuse};
use super::helpers::CHelper;
use super::items::{ItemContent, Program};
use super::names::Names;
use super::scopes::Scopes;
use super::statements::ValueTarget;
use super::types::ValueKind;
use super::writer::CodeWriter;

/// Items and helpers that a definition names.
#[derive(Debug, Default)]
pub(super) struct NeededParts {
    pub items: Vec<usize>,
    pub helpers: Vec<CHelper>,
}

impl NeededParts {
    /// Adds an item.
    pub(super) fn add(&mut self, index: usize) {
        if !self.items.contains(&index) {
            self.items.push(index);
        }
    }

    /// Adds the types, and the constants of lengths, that a type names.
    pub(super) fn add_kind(&mut self, kind: &ValueKind) {
        match kind {
            ValueKind::Struct(index) | ValueKind::Enum(index) => self.add(*index),
            ValueKind::Array(element, length) => {
                self.add_kind(element);
                length.constant.into_iter().for_each(|index| self.add(index));
            }
            ValueKind::Reference { target, .. } => self.add_kind(target),
            ValueKind::Slice { element, .. } => self.add_kind(element),
            _ => {}
        }
    }
}

/// Translation of a function's body, from statement to statement.
pub(super) struct FunctionBody<'p> {
    pub program: &'p Program<'p>,
    pub names: &'p Names,
    pub file: usize,
    pub owner: Option<usize>,
    pub source: &'p [&'p str],
    pub scopes: Scopes,
    pub code: CodeWriter,
    pub needs: NeededParts,
    pub result: ValueKind,
    /// True if a declaration has been written since it was last set to false.
    pub has_declared: bool,
}

/// Function in C, with what it needs.
pub(super) struct TranslatedFunction {
    pub text: String,
    /// Declaration for the header, of a function of the C library.
    pub prototype: String,
    pub needs: NeededParts,
}

/// Translates a function.
pub(super) fn translate_function(
    program: &Program<'_>,
    names: &Names,
    source: &[&str],
    index: usize,
) -> Outcome<Option<TranslatedFunction>> {
    let item = &program.items[index];
    let (ItemContent::Function { signature, block }, Some(kind)) =
        (&item.content, program.function_kind(index)?)
    else {
        return Ok(None);
    };
    let mut body = FunctionBody {
        program,
        names,
        file: item.file,
        owner: item.owner,
        source,
        scopes: Scopes::default(),
        code: CodeWriter::new(1),
        needs: NeededParts::default(),
        result: kind.result.clone(),
        has_declared: false,
    };
    body.scopes.open();
    body.needs.add_kind(&kind.result);
    let mut parameters = Vec::new();
    for ((name, kind), input) in kind.parameters.iter().zip(&signature.inputs) {
        let is_mutable = match input {
            FnArg::Receiver(receiver) => receiver.mutability.is_some(),
            FnArg::Typed(typed) => matches!(&*typed.pat, Pat::Ident(name) if name.mutability.is_some()),
        };
        if name == "self" && is_mutable {
            return refuse(input.span(), "`mut self`", "`self`, and a local that is changed");
        }
        body.needs.add_kind(kind);
        let c_name = body.scopes.declare(names, name, kind.clone(), is_mutable);
        parameters.push(names.declaration(kind, &c_name));
        if matches!(kind, ValueKind::Slice { .. })
            && let Some(local) = body.scopes.look(name)
        {
            parameters.push(format!("size_t {}", local.length_name));
        }
    }
    let target = if kind.result == ValueKind::Unit {
        ValueTarget::Discard
    } else {
        ValueTarget::Return(kind.result.clone())
    };
    body.block(block, &target)?;
    let unused: Vec<String> = body.scopes.parameters().iter().flat_map(unused_names).collect();
    for name in unused.iter().rev() {
        body.code.insert(0, &format!("(void){name};"));
    }
    let list = if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") };
    let storage = if program.exported.contains(&index) { "" } else { "static " };
    let head = |end: &str| {
        let mut head = CodeWriter::new(0);
        let declared = names.declaration(&kind.result, names.item(index));
        head.line(&format!("{storage}{declared}({list}){end}"));
        comment(&item.docs, 0) + &head.text()
    };
    let text = format!("{}{}}}\n", head(" {"), body.code.text());
    Ok(Some(TranslatedFunction { text, prototype: head(";"), needs: body.needs }))
}

fn unused_names(local: &super::scopes::LocalName) -> Vec<String> {
    let mut names = Vec::new();
    if !local.is_used {
        names.push(local.c_name.clone());
    }
    if !local.is_length_used && !local.length_name.is_empty() {
        names.push(local.length_name.clone());
    }
    names
}
