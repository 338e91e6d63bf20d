//! Calls of functions of the crate, and their arguments.

use syn::spanned::Spanned;
use syn::{Expr, ExprArray, ExprCall, ExprMethodCall, ExprReference};

use super::error::{Outcome, refuse};
use super::evaluation::is_open;
use super::expressions::{CExpression, bare};
use super::functions::FunctionBody;
use super::helpers::CHelper;
use super::operators::{POSTFIX, UNARY};
use super::paths::words;
use super::refusals::describe;
use super::types::{IntegerKind, ValueKind};

impl FunctionBody<'_> {
    /// Translates an expression that is a whole value: a call in it may change its arguments.
    pub(super) fn whole(&mut self, written: &Expr, expected: Option<&ValueKind>) -> Outcome<CExpression> {
        let value = match bare(written) {
            Expr::Call(call) => self.call(call, true)?,
            Expr::MethodCall(call) => self.method_call(call, true)?,
            _ => return self.expression(written, expected),
        };
        self.check_kind(written, &value.kind, expected)?;
        Ok(value)
    }

    /// Translates the call of a function by its path.
    pub(super) fn call(&mut self, call: &ExprCall, may_change: bool) -> Outcome<CExpression> {
        let Expr::Path(path) = bare(&call.func) else {
            return refuse(call.func.span(), "a call of a value", "calls of functions by their names");
        };
        if let Some(index) = self.program.find(self.file, self.owner, &path.path) {
            let arguments: Vec<&Expr> = call.args.iter().collect();
            return self.call_function(index, None, &arguments, may_change, call.span());
        }
        let name = words(&path.path).join("::");
        let Some(argument) = call.args.first().filter(|_| call.args.len() == 1) else {
            return refuse(call.span(), format!("the function `{name}`"), ACCEPTED_CALLS);
        };
        let (to, from): (ValueKind, &[&str]) = match name.as_str() {
            "f64::from_bits" | "f32::from_bits" => {
                let bits = self.expression(argument, Some(&self.program.bits_kind()))?;
                return Ok(self.helper(CHelper::FromBits, &[&bits.text], ValueKind::F64));
            }
            "f64::from" => (ValueKind::F64, &["i32", "u32"]),
            "i64::from" => (ValueKind::Integer(IntegerKind::I64), &["bool", "i32", "u32"]),
            "u64::from" => (ValueKind::Integer(IntegerKind::U64), &["bool", "u32"]),
            "usize::from" => (ValueKind::USIZE, &["bool"]),
            "i32::from" => (ValueKind::Integer(IntegerKind::I32), &["bool"]),
            "u32::from" => (ValueKind::Integer(IntegerKind::U32), &["bool"]),
            _ => return refuse(call.span(), format!("the function `{name}`"), ACCEPTED_CALLS),
        };
        let open = ValueKind::Integer(IntegerKind::I32);
        let value = self.expression(argument, is_open(argument).then_some(&open))?;
        let kind = self.program.show(&value.kind);
        if !from.contains(&kind.as_str()) {
            return refuse(
                call.span(),
                format!("`{name}` of {kind}"),
                format!("`{name}` of {}", from.join(", ")),
            );
        }
        Ok(self.converted(&value, to))
    }

    /// Translates the call of a method of a struct, an enum, an array or a number.
    pub(super) fn method_call(&mut self, call: &ExprMethodCall, may_change: bool) -> Outcome<CExpression> {
        if call.turbofish.is_some() {
            return refuse(call.span(), "generic arguments", "methods without them");
        }
        let receiver = self.infer(&call.receiver);
        let method = call.method.to_string();
        match receiver.as_ref().map(ValueKind::target) {
            Some(ValueKind::Struct(owner) | ValueKind::Enum(owner)) => {
                let Some(index) = self.program.method(*owner, &method) else {
                    let name = &self.program.items[*owner].name;
                    return refuse(
                        call.method.span(),
                        format!("the method `{method}` of {name}"),
                        "methods of its `impl`",
                    );
                };
                let arguments: Vec<&Expr> = call.args.iter().collect();
                self.call_function(index, Some(&call.receiver), &arguments, may_change, call.method.span())
            }
            Some(kind @ (ValueKind::Array(..) | ValueKind::Slice { .. })) if method == "len" => {
                let kind = kind.clone();
                self.length_of(&call.receiver, &kind)
            }
            Some(kind) => {
                let kind = kind.clone();
                self.number_method(call, &kind)
            }
            None => refuse(
                call.span(),
                format!("the method `{method}` of a value whose type is not clear"),
                "a written type",
            ),
        }
    }

    fn length_of(&mut self, written: &Expr, kind: &ValueKind) -> Outcome<CExpression> {
        if let ValueKind::Array(_, length) = kind {
            length.constant.into_iter().for_each(|index| self.needs.add(index));
            let value = CExpression::value(self.names.length(length), POSTFIX, ValueKind::USIZE);
            return Ok(CExpression { is_narrow: true, ..value });
        }
        let Expr::Path(path) = bare(written) else {
            return refuse(
                written.span(),
                "the length of this expression",
                "`x.len()` of a parameter or an array",
            );
        };
        match path.path.get_ident().and_then(|name| self.scopes.find(&name.to_string())) {
            Some(local) => {
                local.is_length_used = true;
                Ok(CExpression::value(local.length_name.clone(), POSTFIX, ValueKind::USIZE))
            }
            None => refuse(
                written.span(),
                "the length of this expression",
                "`x.len()` of a parameter or an array",
            ),
        }
    }

    fn call_function(
        &mut self,
        index: usize,
        receiver: Option<&Expr>,
        written: &[&Expr],
        may_change: bool,
        span: proc_macro2::Span,
    ) -> Outcome<CExpression> {
        let Some(kind) = self.program.function_kind(index)? else {
            return refuse(
                span,
                format!("a call of `{}`", self.program.items[index].name),
                "calls of functions",
            );
        };
        let name = &self.program.items[index].name;
        if receiver.is_some() && !kind.has_receiver {
            return refuse(span, format!("`{name}` as a method"), "methods with `self`");
        }
        let all: Vec<&Expr> = receiver.into_iter().chain(written.iter().copied()).collect();
        if all.len() != kind.parameters.len() {
            return refuse(span, format!("{} arguments", all.len()), format!("{}", kind.parameters.len()));
        }
        if !may_change && kind.parameters.iter().any(|(_, kind)| kind.is_mutable_reference()) {
            let found = format!("a call of `{name}`, which changes its arguments, within an expression");
            let accepted = "such a call as a whole statement, or as the whole value of a `let`, an assignment, a `return` or a tail";
            return refuse(span, found, accepted);
        }
        self.needs.add(index);
        let mut arguments = Vec::new();
        for (i, (argument, (_, kind))) in all.iter().zip(&kind.parameters).enumerate() {
            if i == 0 && receiver.is_some() {
                arguments.push(self.receiver(argument, kind)?);
            } else {
                arguments.push(self.argument(argument, kind)?);
            }
        }
        let text = format!("{}({})", self.names.item(index), arguments.join(", "));
        Ok(CExpression::value(text, POSTFIX, kind.result))
    }

    /// Translates what stands before a method: Rust takes its address, or its value, as the method asks.
    fn receiver(&mut self, written: &Expr, kind: &ValueKind) -> Outcome<String> {
        let value = self.expression(written, None)?;
        match (&value.kind, kind) {
            (ValueKind::Reference { .. }, ValueKind::Reference { .. }) => Ok(value.text),
            (ValueKind::Reference { .. }, _) => Ok(format!("*{}", value.at_least(UNARY))),
            (_, ValueKind::Reference { .. }) if value.is_place => Ok(address(&value)),
            (_, ValueKind::Reference { .. }) => refuse(
                written.span(),
                "a method by reference of a result",
                "a local that holds the result first",
            ),
            _ => Ok(value.text),
        }
    }

    fn argument(&mut self, written: &Expr, kind: &ValueKind) -> Outcome<String> {
        if kind.is_plain() {
            return Ok(self.expression(written, Some(kind))?.text);
        }
        let Expr::Reference(ExprReference { expr, .. }) = bare(written) else {
            // A parameter that is a reference is passed on.
            let Expr::Path(path) = bare(written) else {
                let found = format!("{} as a reference", describe(bare(written)));
                return refuse(written.span(), found, "`&x`, `&mut x`, or a parameter that is a reference");
            };
            let value = self.expression(written, None)?;
            return match (&value.kind, kind) {
                (ValueKind::Slice { element: from, .. }, ValueKind::Slice { element: to, .. })
                    if from == to =>
                {
                    let name = path.path.get_ident().map(ToString::to_string).unwrap_or_default();
                    let length = self.length_of(written, &value.kind)?.text;
                    debug_assert!(!name.is_empty(), "a slice is a parameter");
                    Ok(format!("{}, {length}", value.text))
                }
                (ValueKind::Reference { target, .. }, ValueKind::Slice { element: to, .. }) => {
                    match &**target {
                        ValueKind::Array(from, length) if from == to => {
                            length.constant.into_iter().for_each(|index| self.needs.add(index));
                            Ok(format!("{}, {}", value.text, self.names.length(length)))
                        }
                        _ => self.check_kind(written, &value.kind, Some(kind)).map(|()| value.text),
                    }
                }
                _ => self.check_kind(written, &value.kind, Some(kind)).map(|()| value.text),
            };
        };
        if let (Expr::Array(array), ValueKind::Slice { element, .. }) = (bare(expr), kind) {
            return self.list_argument(array, element);
        }
        let value = self.expression(expr, None)?;
        if !value.is_place {
            return refuse(
                written.span(),
                "a reference to a result",
                "a reference to a local, a field or an element",
            );
        }
        match (kind, &value.kind) {
            (ValueKind::Slice { is_mutable, element }, ValueKind::Array(from, length)) if from == element => {
                length.constant.into_iter().for_each(|index| self.needs.add(index));
                let text = self.array_argument(&value, *is_mutable);
                Ok(format!("{text}, {}", self.names.length(length)))
            }
            (ValueKind::Slice { element, .. }, ValueKind::Slice { element: from, .. }) if from == element => {
                let length = self.length_of(expr, &value.kind)?.text;
                Ok(format!("{}, {length}", value.text))
            }
            (ValueKind::Reference { is_mutable, target }, ValueKind::Array(..)) if **target == value.kind => {
                Ok(self.array_argument(&value, *is_mutable))
            }
            (ValueKind::Reference { target, .. }, _) if **target == value.kind => Ok(address(&value)),
            _ => {
                let found = format!("a reference to {}", self.program.show(&value.kind));
                refuse(written.span(), found, self.program.show(kind))
            }
        }
    }

    /// Returns a list that is written as an argument; C has no array without elements.
    fn list_argument(&mut self, array: &ExprArray, element: &ValueKind) -> Outcome<String> {
        let kind = self.names.plain_type(element);
        if array.elems.is_empty() {
            let is_number = *element == ValueKind::F64;
            return Ok(if is_number { format!("({kind}[1]){{0}}, 0") } else { "NULL, 0".to_owned() });
        }
        let mut entries = Vec::new();
        for entry in &array.elems {
            entries.push(self.expression(entry, Some(element))?.text);
        }
        let count = entries.len();
        Ok(format!("({kind}[{count}]){{{}}}, {count}", entries.join(", ")))
    }

    /// Returns an array as an argument; a constant array of arrays has to be cast, as C has it.
    fn array_argument(&self, value: &CExpression, is_mutable: bool) -> String {
        match &value.kind {
            ValueKind::Array(element, _) if !is_mutable && matches!(**element, ValueKind::Array(..)) => {
                format!(
                    "({} (*){}){}",
                    self.names.plain_type(element),
                    self.names.brackets(element),
                    value.text
                )
            }
            _ => value.text.clone(),
        }
    }
}

const ACCEPTED_CALLS: &str =
    "functions of the crate, `f64::from_bits`, and `from` of f64, i64, u64, usize, i32 and u32 without loss";

/// Returns the address of a place.
fn address(value: &CExpression) -> String {
    match value.text.strip_prefix('*') {
        Some(pointer) if value.level == UNARY => pointer.to_owned(),
        _ => format!("&{}", value.at_least(POSTFIX)),
    }
}
