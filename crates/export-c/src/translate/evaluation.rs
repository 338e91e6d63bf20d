//! Values of constants, which C cannot compute from other constants.

use syn::spanned::Spanned;
use syn::{BinOp, Expr, ExprBinary, ExprCall, ExprCast, ExprLit, ExprPath, Lit, Member, UnOp};

use super::error::{Outcome, refuse};
use super::items::{ItemContent, Program};
use super::literals::{float_constant, mathematical_constant};
use super::paths::words;
use super::refusals::describe;
use super::types::{IntegerKind, ValueKind};

/// Value of a constant.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ConstantValue {
    Float(f64),
    Bool(bool),
    Integer(i128, IntegerKind),
    Variant(usize, usize),
    Array(Vec<ConstantValue>),
    Struct(Vec<(String, ConstantValue)>),
}

impl ConstantValue {
    /// Returns the value of an integer.
    pub(super) fn integer(&self) -> Option<i128> {
        match self {
            Self::Integer(value, _) => Some(*value),
            _ => None,
        }
    }
}

const ACCEPTED: &str = "literals, constants, arithmetic, casts, arrays and structs";

impl Program<'_> {
    /// True if a constant is of the type `usize`: C then has it as an enumerator, which gives lengths of arrays.
    pub(super) fn is_size(&self, index: usize) -> Outcome<bool> {
        if self.constant_kind(index)? != Some(ValueKind::USIZE) {
            return Ok(false);
        }
        let value = self.constant_value(index)?.integer();
        Ok(value.is_some_and(|value| value <= i32::MAX.into()))
    }

    /// Returns the value of a constant.
    pub(super) fn constant_value(&self, index: usize) -> Outcome<ConstantValue> {
        let item = &self.items[index];
        let ItemContent::Constant { value, .. } = &item.content else {
            return refuse(item.span, format!("`{}` as a constant", item.name), "constants");
        };
        let kind = self.constant_kind(index)?;
        self.evaluate(item.file, item.owner, value, kind.as_ref())
            .map_err(|error| self.placed(error, item.file))
    }

    /// Returns the value of a constant expression; the expected type gives untyped literals theirs.
    pub(super) fn evaluate(
        &self,
        file: usize,
        owner: Option<usize>,
        written: &Expr,
        expected: Option<&ValueKind>,
    ) -> Outcome<ConstantValue> {
        let inner =
            |written: &Expr, expected: Option<&ValueKind>| self.evaluate(file, owner, written, expected);
        match written {
            Expr::Paren(paren) => inner(&paren.expr, expected),
            Expr::Group(group) => inner(&group.expr, expected),
            Expr::Lit(literal) => literal_value(literal, expected),
            Expr::Path(path) => self.path_value(file, owner, path),
            Expr::Unary(unary) => {
                if let (UnOp::Neg(_), Expr::Lit(ExprLit { lit: Lit::Int(digits), .. })) =
                    (&unary.op, &*unary.expr)
                {
                    // The magnitude of the least integer is above the greatest one.
                    let kind = literal_kind(digits.suffix(), expected);
                    let value: i128 = digits.base10_parse().unwrap_or(i128::MAX);
                    return checked(written, -value, kind);
                }
                match (&unary.op, inner(&unary.expr, expected)?) {
                    (UnOp::Neg(_), ConstantValue::Float(value)) => Ok(ConstantValue::Float(-value)),
                    (UnOp::Neg(_), ConstantValue::Integer(value, kind)) => checked(written, -value, kind),
                    (UnOp::Not(_), ConstantValue::Bool(value)) => Ok(ConstantValue::Bool(!value)),
                    (UnOp::Not(_), ConstantValue::Integer(value, kind)) if !kind.is_signed() => {
                        Ok(ConstantValue::Integer(kind.range().1 - value, kind))
                    }
                    _ => refuse(written.span(), "this operator in a constant", ACCEPTED),
                }
            }
            Expr::Binary(binary) => self.binary_value(file, owner, binary, expected),
            Expr::Cast(cast) => self.cast_value(file, owner, cast),
            Expr::Call(call) => self.call_value(file, owner, call),
            Expr::Field(field) => {
                let Member::Named(name) = &field.member else {
                    return refuse(field.span(), "a field without a name", "named fields");
                };
                match inner(&field.base, None)? {
                    ConstantValue::Struct(fields) => {
                        match fields.into_iter().find(|(field, _)| name == field) {
                            Some((_, value)) => Ok(value),
                            None => {
                                refuse(field.span(), format!("the field `{name}`"), "a field of the struct")
                            }
                        }
                    }
                    _ => refuse(field.span(), "a field of another value", "fields of structs"),
                }
            }
            Expr::Index(index) => {
                let position = inner(&index.index, Some(&ValueKind::USIZE))?.integer().unwrap_or(-1);
                match inner(&index.expr, None)? {
                    ConstantValue::Array(mut values)
                        if position >= 0 && (position as usize) < values.len() =>
                    {
                        Ok(values.swap_remove(position as usize))
                    }
                    _ => refuse(index.span(), "an index outside an array", "elements of arrays"),
                }
            }
            Expr::Array(array) => {
                let element = element_kind(expected);
                let values = array.elems.iter().map(|value| inner(value, element)).collect::<Outcome<_>>()?;
                Ok(ConstantValue::Array(values))
            }
            Expr::Repeat(repeat) => {
                let value = inner(&repeat.expr, element_kind(expected))?;
                let count = self.length(file, owner, &repeat.len)?.count;
                Ok(ConstantValue::Array(vec![value; count as usize]))
            }
            Expr::Struct(value) if value.rest.is_none() => {
                let Some(index) = self.find(file, owner, &value.path) else {
                    return refuse(value.span(), "a struct from outside", "structs of the crate");
                };
                let mut fields = Vec::new();
                for field in &value.fields {
                    let Member::Named(name) = &field.member else { continue };
                    let kind = self.field_kind(index, &name.to_string())?;
                    fields.push((name.to_string(), inner(&field.expr, kind.as_ref())?));
                }
                Ok(ConstantValue::Struct(fields))
            }
            other => refuse(other.span(), format!("{} in a constant", describe(other)), ACCEPTED),
        }
    }

    fn path_value(&self, file: usize, owner: Option<usize>, path: &ExprPath) -> Outcome<ConstantValue> {
        if let Some((index, position)) = self.find_variant(file, owner, &path.path) {
            return Ok(ConstantValue::Variant(index, position));
        }
        if let Some(index) = self.find(file, owner, &path.path) {
            return self.constant_value(index);
        }
        if let Some(value) = outside_constant(&words(&path.path)) {
            return Ok(value);
        }
        refuse(path.span(), "an unknown name in a constant", ACCEPTED)
    }

    fn binary_value(
        &self,
        file: usize,
        owner: Option<usize>,
        binary: &ExprBinary,
        expected: Option<&ValueKind>,
    ) -> Outcome<ConstantValue> {
        let is_shift = matches!(binary.op, BinOp::Shl(_) | BinOp::Shr(_));
        let left_is_open = is_open(&binary.left);
        let mut right = None;
        let mut kind = expected.cloned();
        if left_is_open && !is_shift {
            let value = self.evaluate(file, owner, &binary.right, expected)?;
            kind = integer_kind(&value).or(kind);
            right = Some(value);
        }
        let left = self.evaluate(file, owner, &binary.left, kind.as_ref())?;
        let right = match right {
            Some(right) => right,
            None if is_shift => self.evaluate(file, owner, &binary.right, None)?,
            None => self.evaluate(file, owner, &binary.right, integer_kind(&left).as_ref())?,
        };
        match (left, right) {
            (ConstantValue::Float(a), ConstantValue::Float(b)) => Ok(ConstantValue::Float(match binary.op {
                BinOp::Add(_) => a + b,
                BinOp::Sub(_) => a - b,
                BinOp::Mul(_) => a * b,
                BinOp::Div(_) => a / b,
                _ => return refuse(binary.span(), "this operator in a constant", "`+ - * /` of floats"),
            })),
            (ConstantValue::Integer(a, kind), ConstantValue::Integer(b, _)) => {
                let value = match binary.op {
                    BinOp::Add(_) => Some(a + b),
                    BinOp::Sub(_) => Some(a - b),
                    BinOp::Mul(_) => a.checked_mul(b),
                    BinOp::Div(_) => a.checked_div(b),
                    BinOp::Rem(_) => a.checked_rem(b),
                    BinOp::BitAnd(_) => Some(a & b),
                    BinOp::BitOr(_) => Some(a | b),
                    BinOp::BitXor(_) => Some(a ^ b),
                    BinOp::Shl(_) if (0..64).contains(&b) => {
                        // Bits that leave the type are lost.
                        Some((a << b) & if kind.is_signed() { -1 } else { kind.range().1 })
                    }
                    BinOp::Shr(_) if (0..64).contains(&b) => Some(a >> b),
                    _ => None,
                };
                match value {
                    Some(value) => checked(&Expr::Lit(literal_at(binary.span())), value, kind),
                    None => refuse(binary.span(), "this operation in a constant", ACCEPTED),
                }
            }
            _ => refuse(binary.span(), "this operation in a constant", ACCEPTED),
        }
    }

    fn cast_value(&self, file: usize, owner: Option<usize>, cast: &ExprCast) -> Outcome<ConstantValue> {
        let value = self.evaluate(file, owner, &cast.expr, None)?;
        let kind = self.kind(file, owner, &cast.ty)?;
        match (value, kind) {
            (ConstantValue::Float(value), ValueKind::F64) => Ok(ConstantValue::Float(value)),
            (ConstantValue::Integer(value, IntegerKind::I32 | IntegerKind::I64), ValueKind::F64) => {
                Ok(ConstantValue::Float(value as i64 as f64))
            }
            (ConstantValue::Integer(value, _), ValueKind::F64) => {
                Ok(ConstantValue::Float(value as u64 as f64))
            }
            (ConstantValue::Integer(value, _), ValueKind::Integer(kind)) => {
                Ok(ConstantValue::Integer(wrapped(value, kind), kind))
            }
            (ConstantValue::Bool(value), ValueKind::Integer(kind)) => {
                Ok(ConstantValue::Integer(value.into(), kind))
            }
            (ConstantValue::Float(value), ValueKind::Integer(kind)) => {
                let (least, greatest) = kind.range();
                Ok(ConstantValue::Integer((value as i128).clamp(least, greatest), kind))
            }
            _ => refuse(cast.span(), "this cast in a constant", "casts of numbers and of bool"),
        }
    }

    fn call_value(&self, file: usize, owner: Option<usize>, call: &ExprCall) -> Outcome<ConstantValue> {
        let name = match &*call.func {
            Expr::Path(path) => words(&path.path).join("::"),
            _ => String::new(),
        };
        if let ("f64::from_bits", Some(bits)) = (name.as_str(), call.args.first()) {
            let kind = ValueKind::Integer(IntegerKind::U64);
            if let ConstantValue::Integer(bits, _) = self.evaluate(file, owner, bits, Some(&kind))? {
                return Ok(ConstantValue::Float(f64::from_bits(bits as u64)));
            }
        }
        refuse(call.span(), "a call in a constant", "`f64::from_bits`, literals, constants and arithmetic")
    }
}

/// Returns a constant of `core::f64` or of a type of numbers.
pub(super) fn outside_constant(words: &[String]) -> Option<ConstantValue> {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["core" | "std", "f64" | "f32", "consts", name] => {
            mathematical_constant(name).map(ConstantValue::Float)
        }
        ["f64", name] => float_constant(name).map(ConstantValue::Float),
        ["f32", name @ ("INFINITY" | "NEG_INFINITY" | "NAN")] => {
            float_constant(name).map(ConstantValue::Float)
        }
        [kind, "MAX"] => IntegerKind::from_name(kind)
            .filter(|kind| *kind != IntegerKind::Usize)
            .map(|kind| ConstantValue::Integer(kind.range().1, kind)),
        [kind, "MIN"] => {
            IntegerKind::from_name(kind).map(|kind| ConstantValue::Integer(kind.range().0, kind))
        }
        _ => None,
    }
}

fn literal_at(span: proc_macro2::Span) -> ExprLit {
    ExprLit { attrs: Vec::new(), lit: Lit::Bool(syn::LitBool::new(true, span)) }
}

fn literal_kind(suffix: &str, expected: Option<&ValueKind>) -> IntegerKind {
    match (IntegerKind::from_name(suffix), expected) {
        (Some(kind), _) => kind,
        (None, Some(ValueKind::Integer(kind))) => *kind,
        _ => IntegerKind::I32,
    }
}

fn literal_value(literal: &ExprLit, expected: Option<&ValueKind>) -> Outcome<ConstantValue> {
    match &literal.lit {
        Lit::Bool(value) => Ok(ConstantValue::Bool(value.value)),
        Lit::Float(digits) if matches!(digits.suffix(), "" | "f64" | "f32") => {
            match digits.base10_parse::<f64>() {
                Ok(value) => Ok(ConstantValue::Float(value)),
                Err(_) => refuse(literal.span(), "this number", "numbers of the type f64"),
            }
        }
        Lit::Int(digits)
            if digits.suffix().is_empty() || IntegerKind::from_name(digits.suffix()).is_some() =>
        {
            let kind = literal_kind(digits.suffix(), expected);
            let value: i128 = digits.base10_parse().unwrap_or(i128::MAX);
            checked(&Expr::Lit(literal_at(literal.span())), value, kind)
        }
        _ => refuse(
            literal.span(),
            "a literal of another type",
            "literals of f64, bool, i32, u32, i64, u64 and usize",
        ),
    }
}

/// True for an integer literal whose type comes from its context.
pub(super) fn is_open(written: &Expr) -> bool {
    match written {
        Expr::Paren(paren) => is_open(&paren.expr),
        Expr::Unary(unary) => is_open(&unary.expr),
        Expr::Binary(binary) => is_open(&binary.left) && is_open(&binary.right),
        Expr::Lit(ExprLit { lit: Lit::Int(digits), .. }) => digits.suffix().is_empty(),
        _ => false,
    }
}

fn integer_kind(value: &ConstantValue) -> Option<ValueKind> {
    match value {
        ConstantValue::Integer(_, kind) => Some(ValueKind::Integer(*kind)),
        _ => None,
    }
}

fn element_kind(kind: Option<&ValueKind>) -> Option<&ValueKind> {
    match kind {
        Some(ValueKind::Array(element, _)) => Some(element),
        _ => None,
    }
}

fn checked(written: &Expr, value: i128, kind: IntegerKind) -> Outcome<ConstantValue> {
    let (least, greatest) = kind.range();
    if value < least || value > greatest {
        return refuse(
            written.span(),
            format!("the value {value}"),
            format!("values of {}", kind.rust_name()),
        );
    }
    Ok(ConstantValue::Integer(value, kind))
}

fn wrapped(value: i128, kind: IntegerKind) -> i128 {
    match kind {
        IntegerKind::I32 => (value as i32).into(),
        IntegerKind::U32 => (value as u32).into(),
        IntegerKind::I64 => (value as i64).into(),
        IntegerKind::U64 | IntegerKind::Usize => (value as u64).into(),
    }
}
