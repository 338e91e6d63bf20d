//! Values of structs and arrays: initialisers, and copies of arrays, which C does not assign.

use syn::spanned::Spanned;
use syn::{Expr, ExprStruct, Lit, Member};

use super::error::{Outcome, refuse};
use super::expressions::{CExpression, bare};
use super::functions::FunctionBody;
use super::names::free_name;
use super::operators::POSTFIX;
use super::statements::ValueTarget;
use super::types::ValueKind;

/// Greatest length of an initialiser on one line.
const WIDTH: usize = 84;
/// Greatest number of equal elements that are written out.
const GREATEST_REPEAT: u64 = 64;

/// Array that is copied into a part of a value.
struct ArrayCopy {
    /// Fields after the value's name: `.digits`.
    path: String,
    source: String,
}

impl FunctionBody<'_> {
    /// Translates a struct within an expression.
    pub(super) fn compound_literal(&mut self, written: &Expr) -> Outcome<CExpression> {
        let Some(kind) = self.infer(written) else {
            return refuse(written.span(), "a struct from outside", "structs of the crate");
        };
        let mut copies = Vec::new();
        let text = self.initialiser(written, &kind, "", &mut copies, false)?;
        if !copies.is_empty() {
            return refuse(
                written.span(),
                "a struct that copies an array, within an expression",
                "a local that holds it first",
            );
        }
        self.needs.add_kind(&kind);
        let text = format!("({}){}", self.names.plain_type(&kind), text.unwrap_or_default());
        Ok(CExpression::value(text, POSTFIX, kind))
    }

    /// Gives a struct or an array to a target.
    pub(super) fn aggregate_into(&mut self, written: &Expr, target: &ValueTarget) -> Outcome<()> {
        let Some(kind) = target.kind().cloned() else {
            return refuse(written.span(), "a value that is lost", "a destination");
        };
        let mut copies = Vec::new();
        let layout = self.initialiser(written, &kind, "", &mut copies, true)?;
        let cast = self.names.plain_type(&kind);
        if copies.is_empty() && !matches!(kind, ValueKind::Array(..)) {
            let text = layout.unwrap_or_default();
            match target {
                ValueTarget::Assign { place, .. } => self.layout(&format!("{place} = ({cast}){text};")),
                ValueTarget::Return(_) => self.layout(&format!("return ({cast}){text};")),
                ValueTarget::Declare { name, .. } => {
                    self.has_declared = true;
                    let start = self.names.declaration(&kind, name);
                    self.layout(&format!("{start} = {text};"));
                }
                ValueTarget::Discard => {}
            }
            return Ok(());
        }
        let name = match target {
            ValueTarget::Declare { name, .. } => name.clone(),
            _ if matches!(kind, ValueKind::Array(..)) => {
                return refuse(written.span(), "an array by value", "an array as the initialiser of a `let`");
            }
            _ => self.scopes.unused_name(self.names, "built"),
        };
        self.has_declared = true;
        let start = self.names.declaration(&kind, &name);
        match layout {
            Some(text) => self.layout(&format!("{start} = {text};")),
            None => self.code.line(&format!("{start};")),
        }
        for copy in copies {
            let path = format!("{name}{}", copy.path);
            self.code.line(&format!("memcpy({path}, {}, sizeof {path});", copy.source));
        }
        match target {
            ValueTarget::Assign { place, .. } => self.code.line(&format!("{place} = {name};")),
            ValueTarget::Return(_) => self.code.line(&format!("return {name};")),
            ValueTarget::Declare { .. } | ValueTarget::Discard => {}
        }
        Ok(())
    }

    /// Writes lines that are indented relative to a statement.
    fn layout(&mut self, text: &str) {
        for line in text.lines() {
            self.code.line(line);
        }
    }

    /// Returns the initialiser of a struct or an array, or none if all of it is copied.
    fn initialiser(
        &mut self,
        written: &Expr,
        kind: &ValueKind,
        path: &str,
        copies: &mut Vec<ArrayCopy>,
        may_break: bool,
    ) -> Outcome<Option<String>> {
        match (bare(written), kind) {
            (Expr::Struct(value), _) => self.struct_initialiser(value, kind, path, copies, may_break),
            (Expr::Array(array), ValueKind::Array(element, length)) => {
                if array.elems.len() as u64 != length.count {
                    return refuse(
                        array.span(),
                        format!("{} elements", array.elems.len()),
                        length.count.to_string(),
                    );
                }
                let mut entries = Vec::new();
                for value in &array.elems {
                    entries.push(self.element(value, element)?);
                }
                Ok(Some(braced(&entries, may_break)))
            }
            (Expr::Repeat(repeat), ValueKind::Array(element, length)) => {
                let found = self.program.length(self.file, self.owner, &repeat.len)?;
                if found != *length {
                    return refuse(
                        repeat.span(),
                        format!("{} elements", found.count),
                        length.count.to_string(),
                    );
                }
                let value = self.element(&repeat.expr, element)?;
                if is_zero(&repeat.expr) {
                    return Ok(Some(format!("{{{value}}}")));
                }
                if length.count > GREATEST_REPEAT {
                    let found = format!("an array of {} equal elements", length.count);
                    return refuse(
                        repeat.span(),
                        found,
                        format!("zeros, or up to {GREATEST_REPEAT} elements; else a loop"),
                    );
                }
                Ok(Some(braced(&vec![value; length.count as usize], may_break)))
            }
            (Expr::Array(_) | Expr::Repeat(_), _) => {
                refuse(written.span(), "an array", format!("a value of the type {}", self.program.show(kind)))
            }
            (other, ValueKind::Array(..)) => {
                let value = self.expression(other, Some(kind))?;
                if !value.is_place {
                    return refuse(written.span(), "an array as a result", "a local array or a field");
                }
                copies.push(ArrayCopy { path: path.to_owned(), source: value.text });
                Ok(None)
            }
            (other, _) => Ok(Some(self.expression(other, Some(kind))?.text)),
        }
    }

    /// Returns the initialiser of an element, in which nothing is copied.
    fn element(&mut self, written: &Expr, kind: &ValueKind) -> Outcome<String> {
        let mut copies = Vec::new();
        match self.initialiser(written, kind, "", &mut copies, false)? {
            Some(text) if copies.is_empty() => Ok(text),
            _ => refuse(written.span(), "an array that is copied into an element", "elements one by one"),
        }
    }

    fn struct_initialiser(
        &mut self,
        value: &ExprStruct,
        kind: &ValueKind,
        path: &str,
        copies: &mut Vec<ArrayCopy>,
        may_break: bool,
    ) -> Outcome<Option<String>> {
        if value.rest.is_some() {
            return refuse(value.span(), "a struct with `..`", "all fields");
        }
        let index = self.program.find(self.file, self.owner, &value.path);
        let (Some(index), ValueKind::Struct(expected)) = (index, kind) else {
            return refuse(
                value.span(),
                "this struct",
                format!("a value of the type {}", self.program.show(kind)),
            );
        };
        if index != *expected {
            return refuse(
                value.span(),
                "a value of another struct",
                format!("the type {}", self.program.show(kind)),
            );
        }
        let mut entries = Vec::new();
        for field in &value.fields {
            let Member::Named(name) = &field.member else {
                return refuse(field.span(), "a field without a name", "named fields");
            };
            let Some(kind) = self.program.field_kind(index, &name.to_string())? else {
                return refuse(name.span(), format!("the field `{name}`"), "a field of the struct");
            };
            let c_name = free_name(&name.to_string());
            let inner = format!("{path}.{c_name}");
            if let Some(text) = self.initialiser(&field.expr, &kind, &inner, copies, false)? {
                entries.push(format!(".{c_name} = {text}"));
            }
        }
        Ok((!entries.is_empty()).then(|| braced(&entries, may_break)))
    }
}

/// Returns entries in braces: on one line if they are short.
fn braced(entries: &[String], may_break: bool) -> String {
    let line = format!("{{{}}}", entries.join(", "));
    if !may_break || line.len() <= WIDTH {
        return line;
    }
    let entries: String = entries.iter().flat_map(|entry| ["    ", entry, ",\n"]).collect();
    format!("{{\n{entries}}}")
}

/// True for a literal whose bits are zeros.
fn is_zero(written: &Expr) -> bool {
    match bare(written) {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Float(digits) => digits.base10_parse::<f64>().is_ok_and(|value| value == 0.0),
            Lit::Int(digits) => digits.base10_parse::<u64>().is_ok_and(|value| value == 0),
            Lit::Bool(value) => !value.value,
            _ => false,
        },
        Expr::Repeat(repeat) => is_zero(&repeat.expr),
        _ => false,
    }
}
