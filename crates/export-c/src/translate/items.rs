//! Items of all files: constants, structs, enums and functions, by module and name.

use std::collections::HashMap;

use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::{Block, Expr, Fields, Generics, ImplItem, Safety, Signature, Type, UseTree, Visibility};

use super::comments::{is_kept, read_docs};
use super::error::{Outcome, TranslationError, refuse};
use super::pruning::ConstantChoices;
use super::translation::SourceFile;
use super::types::{IntegerKind, ValueKind};

/// Field of a struct.
pub(super) struct StructField {
    pub name: String,
    pub docs: Vec<String>,
    pub kind: Type,
}

/// Content of an item.
pub(super) enum ItemContent {
    Constant { kind: Box<Type>, value: Box<Expr> },
    Struct { fields: Vec<StructField> },
    Enum { variants: Vec<(String, Vec<String>)> },
    Function { signature: Box<Signature>, block: Block },
}

/// Item that is translated.
pub(super) struct FlightItem {
    /// Index of its file.
    pub file: usize,
    /// Index of the type whose `impl` holds it.
    pub owner: Option<usize>,
    pub name: String,
    pub docs: Vec<String>,
    pub span: Span,
    pub content: ItemContent,
}

/// Module whose public functions and constants are those of the C library.
pub(super) const EXPORTED_MODULE: &str = "control_system";

/// Items of all files.
pub(super) struct Program<'a> {
    pub files: &'a [SourceFile<'a>],
    /// Text of each module's documentation.
    pub module_docs: Vec<Vec<String>>,
    pub items: Vec<FlightItem>,
    /// Index of an item by `module::name` or `module::Type::name`.
    pub by_path: HashMap<String, usize>,
    /// Path of an imported name, by module and name.
    pub imports: HashMap<(String, String), String>,
    /// Public functions and constants of the module of the control system, in their order.
    pub exported: Vec<usize>,
    /// True of a program in single precision.
    pub is_single: bool,
    choices: &'a ConstantChoices,
}

impl<'a> Program<'a> {
    /// Collects the items of all files; `impl` blocks come last, as their types may stand below them.
    pub(super) fn collect(files: &'a [SourceFile<'a>], choices: &'a ConstantChoices) -> Outcome<Self> {
        let mut program = Self {
            files,
            module_docs: Vec::new(),
            items: Vec::new(),
            by_path: HashMap::new(),
            imports: HashMap::new(),
            exported: Vec::new(),
            is_single: files.iter().any(|file| file.text.contains(": f32")),
            choices,
        };
        let mut blocks = Vec::new();
        for (index, file) in files.iter().enumerate() {
            program.collect_file(index, &mut blocks).map_err(|error| error.in_file(file.path))?;
        }
        for (index, block) in blocks {
            program.collect_impl(index, block).map_err(|error| error.in_file(files[index].path))?;
        }
        Ok(program)
    }

    /// Returns the name of the only type of floating-point numbers.
    pub(super) fn real(&self) -> &'static str {
        if self.is_single { "f32" } else { "f64" }
    }

    /// Returns the type of the bits of a number.
    pub(super) fn bits_kind(&self) -> ValueKind {
        ValueKind::Integer(if self.is_single { IntegerKind::U32 } else { IntegerKind::U64 })
    }

    fn collect_file(&mut self, file: usize, blocks: &mut Vec<(usize, syn::ItemImpl)>) -> Outcome<()> {
        let parsed = syn::parse_file(self.files[file].text)
            .map_err(|error| TranslationError::at(error.span(), error.to_string(), "Rust"))?;
        let mut docs = Vec::new();
        is_kept(&parsed.attrs)?;
        read_docs(&parsed.attrs, &mut docs);
        self.module_docs.push(docs);
        for item in parsed.items {
            let is_public = matches!(
                &item,
                syn::Item::Fn(syn::ItemFn { vis: Visibility::Public(_), .. })
                    | syn::Item::Const(syn::ItemConst { vis: Visibility::Public(_), .. })
            );
            let next = self.items.len();
            self.collect_item(file, item, blocks)?;
            if is_public && self.items.len() > next && self.files[file].module == EXPORTED_MODULE {
                self.exported.push(next);
            }
        }
        Ok(())
    }

    fn collect_item(
        &mut self,
        file: usize,
        item: syn::Item,
        blocks: &mut Vec<(usize, syn::ItemImpl)>,
    ) -> Outcome<()> {
        let span = item.span();
        match item {
            syn::Item::Use(item) => {
                if is_kept(&item.attrs)? {
                    self.collect_use(file, &item.tree, &mut Vec::new())?;
                }
                Ok(())
            }
            syn::Item::Const(item) => {
                let content = ItemContent::Constant { kind: item.ty, value: item.expr };
                self.add(file, None, &item.ident, &item.attrs, Some(&item.generics), content)
            }
            syn::Item::Struct(item) => {
                if !is_kept(&item.attrs)? {
                    return Ok(());
                }
                let content = ItemContent::Struct { fields: struct_fields(item.fields, span)? };
                self.add(file, None, &item.ident, &item.attrs, Some(&item.generics), content)
            }
            syn::Item::Enum(item) => {
                if !is_kept(&item.attrs)? {
                    return Ok(());
                }
                let mut variants = Vec::new();
                for variant in item.variants {
                    if !matches!(variant.fields, Fields::Unit) || variant.discriminant.is_some() {
                        let found = format!("the variant `{}` with data or a value", variant.ident);
                        return refuse(variant.span(), found, "variants without data and without values");
                    }
                    is_kept(&variant.attrs)?;
                    let mut docs = Vec::new();
                    read_docs(&variant.attrs, &mut docs);
                    variants.push((variant.ident.to_string(), docs));
                }
                self.add(
                    file,
                    None,
                    &item.ident,
                    &item.attrs,
                    Some(&item.generics),
                    ItemContent::Enum { variants },
                )
            }
            syn::Item::Fn(item) => {
                let mut block = *item.block;
                self.choices.prune(None, &item.sig, &mut block);
                let content = ItemContent::Function { signature: Box::new(item.sig), block };
                self.add_function(file, None, &item.attrs, content)
            }
            syn::Item::Impl(item) => {
                if !is_kept(&item.attrs)? {
                    return Ok(());
                }
                if item.trait_.is_some() || item.unsafety.is_some() {
                    return refuse(span, "an implementation of a trait", "`impl Type { .. }`");
                }
                refuse_generics(&item.generics)?;
                blocks.push((file, item));
                Ok(())
            }
            syn::Item::Mod(item) if !is_kept(&item.attrs)? => Ok(()),
            other => refuse(span, name_of_item(&other), ACCEPTED_ITEMS),
        }
    }

    /// Records the names that a `use` brings into a module.
    fn collect_use(&mut self, file: usize, tree: &UseTree, path: &mut Vec<String>) -> Outcome<()> {
        const ACCEPTED: &str = "`use crate::module::{name, Type};`";
        match tree {
            UseTree::Path(tree) => {
                if path.is_empty() && tree.ident != "crate" {
                    return refuse(tree.ident.span(), format!("an import from `{}`", tree.ident), ACCEPTED);
                }
                path.push(tree.ident.to_string());
                self.collect_use(file, &tree.tree, path)?;
                path.pop();
            }
            UseTree::Name(tree) if path.first().is_some_and(|first| first == "crate") => {
                let module = self.files[file].module.to_owned();
                let mut target = path[1..].to_vec();
                target.push(tree.ident.to_string());
                self.imports.insert((module, tree.ident.to_string()), target.join("::"));
            }
            UseTree::Group(tree) => {
                for item in &tree.items {
                    self.collect_use(file, item, path)?;
                }
            }
            other => return refuse(other.span(), "a glob, a rename or an import from outside", ACCEPTED),
        }
        Ok(())
    }

    fn collect_impl(&mut self, file: usize, block: syn::ItemImpl) -> Outcome<()> {
        let span = block.self_ty.span();
        let owner = match &*block.self_ty {
            Type::Path(path) => path.path.get_ident().and_then(|name| self.type_in(file, &name.to_string())),
            _ => None,
        };
        let Some(owner) = owner else {
            return refuse(span, "an implementation for another type", "a struct or enum of the crate");
        };
        for item in block.items {
            let span = item.span();
            match item {
                ImplItem::Const(item) => {
                    let content =
                        ItemContent::Constant { kind: Box::new(item.ty), value: Box::new(item.expr) };
                    self.add(file, Some(owner), &item.ident, &item.attrs, Some(&item.generics), content)?;
                }
                ImplItem::Fn(item) => {
                    let mut block = item.block;
                    self.choices.prune(Some(&self.items[owner].name), &item.sig, &mut block);
                    let content = ItemContent::Function { signature: Box::new(item.sig), block };
                    self.add_function(file, Some(owner), &item.attrs, content)?;
                }
                _ => return refuse(span, "this item of an `impl`", "functions and constants"),
            }
        }
        Ok(())
    }

    fn add_function(
        &mut self,
        file: usize,
        owner: Option<usize>,
        attributes: &[syn::Attribute],
        content: ItemContent,
    ) -> Outcome<()> {
        let ItemContent::Function { signature, .. } = &content else { return Ok(()) };
        if !is_kept(attributes)? {
            return Ok(());
        }
        let span = signature.span();
        if matches!(signature.safety, Safety::Unsafe(_)) {
            return refuse(span, "an unsafe function", "safe functions");
        }
        if signature.asyncness.is_some() || signature.abi.is_some() || signature.variadic.is_some() {
            return refuse(span, "an async, extern or variadic function", "plain functions");
        }
        refuse_generics(&signature.generics)?;
        let ident = signature.ident.clone();
        self.add(file, owner, &ident, attributes, None, content)
    }

    fn add(
        &mut self,
        file: usize,
        owner: Option<usize>,
        ident: &syn::Ident,
        attributes: &[syn::Attribute],
        generics: Option<&Generics>,
        content: ItemContent,
    ) -> Outcome<()> {
        if !is_kept(attributes)? {
            return Ok(());
        }
        if let Some(generics) = generics {
            refuse_generics(generics)?;
        }
        let mut docs = Vec::new();
        read_docs(attributes, &mut docs);
        let name = ident.to_string();
        let parent = match owner {
            Some(owner) => self.path(owner),
            None => self.files[file].module.to_owned(),
        };
        let path = format!("{parent}::{name}");
        if self.by_path.insert(path, self.items.len()).is_some() {
            return refuse(ident.span(), format!("a second item `{name}`"), "one item of a name in a module");
        }
        self.items.push(FlightItem { file, owner, name, docs, span: ident.span(), content });
        Ok(())
    }

    /// Returns the path `module::name` or `module::Type::name` of an item.
    pub(super) fn path(&self, index: usize) -> String {
        let item = &self.items[index];
        match item.owner {
            Some(owner) => format!("{}::{}", self.path(owner), item.name),
            None => format!("{}::{}", self.files[item.file].module, item.name),
        }
    }
}

const ACCEPTED_ITEMS: &str = "`use`, `const`, `struct`, `enum`, `impl Type` and `fn`";

fn refuse_generics(generics: &Generics) -> Outcome<()> {
    if generics.params.is_empty() && generics.where_clause.is_none() {
        return Ok(());
    }
    refuse(generics.span(), "generics or lifetimes", "items without them")
}

fn struct_fields(fields: Fields, span: Span) -> Outcome<Vec<StructField>> {
    let Fields::Named(fields) = fields else {
        return refuse(span, "a struct without named fields", "`struct Name { field: TYPE, .. }`");
    };
    let mut list = Vec::new();
    for field in fields.named {
        is_kept(&field.attrs)?;
        let mut docs = Vec::new();
        read_docs(&field.attrs, &mut docs);
        let name = field.ident.map(|name| name.to_string()).unwrap_or_default();
        list.push(StructField { name, docs, kind: field.ty });
    }
    if list.is_empty() {
        return refuse(span, "a struct without fields", "one field at least, which C needs");
    }
    Ok(list)
}

fn name_of_item(item: &syn::Item) -> &'static str {
    match item {
        syn::Item::Trait(_) | syn::Item::TraitAlias(_) => "a trait",
        syn::Item::Static(_) => "a static variable",
        syn::Item::Macro(_) => "a macro",
        syn::Item::Mod(_) => "a module within a file",
        syn::Item::Type(_) => "another name of a type",
        syn::Item::Union(_) => "a union",
        syn::Item::ExternCrate(_) | syn::Item::ForeignMod(_) => "foreign code",
        _ => "this item",
    }
}
