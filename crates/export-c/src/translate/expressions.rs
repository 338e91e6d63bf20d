//! Expressions: literals, names, fields, elements and casts.

use syn::spanned::Spanned;
use syn::{Expr, ExprCast, ExprLit, ExprPath, ExprUnary, Lit, Member, Pat, Token, UnOp};

use super::branches::MatchPattern;
use super::error::{Outcome, refuse};
use super::evaluation::{ConstantValue, is_open, outside_constant};
use super::functions::FunctionBody;
use super::helpers::CHelper;
use super::items::ItemContent;
use super::literals::{hexadecimal_digits, integer_literal, real_literal};
use super::operators::{POSTFIX, UNARY};
use super::paths::{show, words};
use super::refusals::describe;
use super::types::{IntegerKind, ValueKind};

/// Expression in C.
#[derive(Debug, Clone)]
pub(super) struct CExpression {
    pub text: String,
    /// Strength with which its outermost operator binds.
    pub level: u8,
    pub kind: ValueKind,
    /// True if it has an address.
    pub is_place: bool,
    /// True if C may give it a type of fewer bits than that of a `usize`.
    pub is_narrow: bool,
}

impl CExpression {
    /// Makes an expression without address.
    pub(super) fn value(text: impl Into<String>, level: u8, kind: ValueKind) -> Self {
        Self { text: text.into(), level, kind, is_place: false, is_narrow: false }
    }

    /// Returns the text, in brackets if it binds less than a level.
    pub(super) fn at_least(&self, level: u8) -> String {
        if self.level < level { format!("({})", self.text) } else { self.text.clone() }
    }
}

/// Returns an expression without its brackets.
pub(super) fn bare(written: &Expr) -> &Expr {
    match written {
        Expr::Paren(paren) => bare(&paren.expr),
        Expr::Group(group) => bare(&group.expr),
        other => other,
    }
}

impl FunctionBody<'_> {
    /// Translates an expression without effects; the expected type gives untyped literals theirs, and is checked.
    pub(super) fn expression(
        &mut self,
        written: &Expr,
        expected: Option<&ValueKind>,
    ) -> Outcome<CExpression> {
        let value = match bare(written) {
            Expr::Lit(literal) => literal_expression(literal, expected, false, self.program.is_single),
            Expr::Path(path) => self.name(path),
            Expr::Field(field) => {
                let base = self.base(&field.base)?;
                let (ValueKind::Struct(index), Member::Named(name)) = (base.kind.target(), &field.member)
                else {
                    return refuse(
                        field.span(),
                        "a field of a tuple or of no struct",
                        "named fields of structs",
                    );
                };
                let Some(kind) = self.program.field_kind(*index, &name.to_string())? else {
                    return refuse(name.span(), format!("the field `{name}`"), "a field of the struct");
                };
                let arrow = if matches!(base.kind, ValueKind::Reference { .. }) { "->" } else { "." };
                let text = format!(
                    "{}{arrow}{}",
                    base.at_least(POSTFIX),
                    super::names::free_name(&name.to_string())
                );
                Ok(CExpression { is_place: true, ..CExpression::value(text, POSTFIX, kind) })
            }
            Expr::Index(index) => {
                let base = self.base(&index.expr)?;
                let kind = match base.kind.target() {
                    ValueKind::Array(element, _) | ValueKind::Slice { element, .. } => (**element).clone(),
                    _ => {
                        return refuse(
                            index.span(),
                            "an index into this value",
                            "elements of arrays and slices",
                        );
                    }
                };
                let position = self.expression(&index.index, Some(&ValueKind::USIZE))?;
                let text = format!("{}[{}]", base.at_least(POSTFIX), position.text);
                Ok(CExpression { is_place: true, ..CExpression::value(text, POSTFIX, kind) })
            }
            Expr::Unary(unary) => self.unary(unary, expected),
            Expr::Binary(binary) => self.binary(binary, expected),
            Expr::Cast(cast) => self.cast(cast),
            Expr::Call(call) => self.call(call, false),
            Expr::MethodCall(call) => self.method_call(call, false),
            Expr::Struct(_) => self.compound_literal(written),
            Expr::Macro(call) if call.mac.path.is_ident("matches") => self.matches(&call.mac),
            Expr::If(_) | Expr::Match(_) => {
                let found = format!("{} within an expression", describe(bare(written)));
                refuse(
                    written.span(),
                    found,
                    "it as the value of a `let`, an assignment, a `return` or a tail",
                )
            }
            other => refuse(other.span(), describe(other), ACCEPTED),
        }?;
        self.check_kind(written, &value.kind, expected)?;
        Ok(value)
    }

    /// Refuses a value of another type than the expected one.
    pub(super) fn check_kind(
        &self,
        written: &Expr,
        kind: &ValueKind,
        expected: Option<&ValueKind>,
    ) -> Outcome<()> {
        let Some(expected) = expected else { return Ok(()) };
        let is_equal = match (kind, expected) {
            (ValueKind::Reference { target: from, .. }, ValueKind::Reference { target: to, .. })
            | (ValueKind::Slice { element: from, .. }, ValueKind::Slice { element: to, .. }) => from == to,
            _ => kind == expected,
        };
        if is_equal {
            return Ok(());
        }
        let found = format!("a value of the type {}", self.program.show(kind));
        let mut accepted = format!("the type {}", self.program.show(expected));
        if kind.target() == expected {
            accepted += ", by `*` before the reference";
        }
        refuse(written.span(), found, accepted)
    }

    /// Translates what stands before a field or an index: `*x` there is x.
    pub(super) fn base(&mut self, written: &Expr) -> Outcome<CExpression> {
        match bare(written) {
            Expr::Unary(ExprUnary { op: UnOp::Deref(_), expr, .. }) => self.expression(expr, None),
            other => self.expression(other, None),
        }
    }

    fn name(&mut self, path: &ExprPath) -> Outcome<CExpression> {
        if let Some(local) = path.path.get_ident().and_then(|name| self.scopes.find(&name.to_string())) {
            local.is_used = true;
            let value = CExpression::value(local.c_name.clone(), POSTFIX, local.kind.clone());
            return Ok(CExpression { is_place: true, ..value });
        }
        if let Some((index, position)) = self.program.find_variant(self.file, self.owner, &path.path) {
            self.needs.add(index);
            let ItemContent::Enum { variants } = &self.program.items[index].content else {
                return refuse(path.span(), "this name", "variants of enums");
            };
            let text = self.names.variant(index, &variants[position].0);
            return Ok(CExpression::value(text, POSTFIX, ValueKind::Enum(index)));
        }
        if let Some(index) = self.program.find(self.file, self.owner, &path.path)
            && let Some(kind) = self.program.constant_kind(index)?
        {
            self.needs.add(index);
            let is_size = self.program.is_size(index)?;
            let value = CExpression::value(self.names.item(index), POSTFIX, kind);
            return Ok(CExpression { is_place: !is_size, is_narrow: is_size, ..value });
        }
        match outside_constant(&words(&path.path)) {
            Some(ConstantValue::Integer(value, kind)) => {
                Ok(CExpression::value(integer_literal(value, kind, None), POSTFIX, ValueKind::Integer(kind)))
            }
            Some(ConstantValue::Float(value)) if value.is_finite() => {
                let text = real_literal(value, self.program.is_single);
                Ok(CExpression::value(text, POSTFIX, ValueKind::F64))
            }
            Some(ConstantValue::Float(value)) => {
                let bits = if self.program.is_single {
                    format!("UINT32_C({:#x})", (value as f32).to_bits())
                } else {
                    format!("UINT64_C({:#x})", value.to_bits())
                };
                Ok(self.helper(CHelper::FromBits, &[&bits], ValueKind::F64))
            }
            _ => {
                let accepted = "locals, constants, variants of enums and `core::f64::consts::X`";
                refuse(path.span(), format!("the name `{}`", show(&path.path)), accepted)
            }
        }
    }

    fn unary(&mut self, unary: &ExprUnary, expected: Option<&ValueKind>) -> Outcome<CExpression> {
        if let (UnOp::Neg(_), Expr::Lit(literal)) = (&unary.op, bare(&unary.expr)) {
            return literal_expression(literal, expected, true, self.program.is_single);
        }
        match unary.op {
            UnOp::Deref(_) => {
                let inner = self.expression(&unary.expr, None)?;
                let ValueKind::Reference { target, .. } = &inner.kind else {
                    return refuse(unary.span(), "`*` of a value", "`*` of a parameter `&T` or `&mut T`");
                };
                if matches!(**target, ValueKind::Array(..)) {
                    let value = CExpression::value(inner.text.clone(), inner.level, (**target).clone());
                    return Ok(CExpression { is_place: true, ..value });
                }
                let value =
                    CExpression::value(format!("*{}", inner.at_least(UNARY)), UNARY, (**target).clone());
                Ok(CExpression { is_place: true, ..value })
            }
            UnOp::Neg(_) => {
                let inner = self.expression(&unary.expr, expected)?;
                if !matches!(
                    inner.kind,
                    ValueKind::F64 | ValueKind::Integer(IntegerKind::I32 | IntegerKind::I64)
                ) {
                    return refuse(unary.span(), "`-` of this type", "`-` of f64, i32 and i64");
                }
                let level = if inner.text.starts_with('-') { POSTFIX } else { UNARY };
                Ok(CExpression::value(format!("-{}", inner.at_least(level)), UNARY, inner.kind))
            }
            UnOp::Not(_) => {
                let inner = self.expression(&unary.expr, expected)?;
                let sign = match &inner.kind {
                    ValueKind::Bool => "!",
                    ValueKind::Integer(kind) if !kind.is_signed() && inner.is_narrow => "~(size_t)",
                    ValueKind::Integer(kind) if !kind.is_signed() => "~",
                    _ => {
                        return refuse(
                            unary.span(),
                            "`!` of this type",
                            "`!` of bool and of unsigned integers",
                        );
                    }
                };
                Ok(CExpression::value(format!("{sign}{}", inner.at_least(UNARY)), UNARY, inner.kind))
            }
            _ => refuse(unary.span(), "this operator", "`-`, `!` and `*`"),
        }
    }

    fn cast(&mut self, cast: &ExprCast) -> Outcome<CExpression> {
        const ACCEPTED: &str = "casts of numbers, bool and enums to f64, i32, u32, i64, u64 and usize";
        let kind = self.program.kind(self.file, self.owner, &cast.ty)?;
        let open = ValueKind::Integer(IntegerKind::I32);
        let inner = self.expression(&cast.expr, is_open(&cast.expr).then_some(&open))?;
        let is_whole = matches!(inner.kind, ValueKind::Integer(_) | ValueKind::Bool | ValueKind::Enum(_));
        match (&inner.kind, &kind) {
            (from, to) if from == to => Ok(CExpression { is_place: false, ..inner }),
            (ValueKind::F64, ValueKind::Integer(to)) => {
                let helper = match to {
                    IntegerKind::I32 => CHelper::ToI32,
                    IntegerKind::U32 => CHelper::ToU32,
                    IntegerKind::I64 => CHelper::ToI64,
                    IntegerKind::U64 => CHelper::ToU64,
                    IntegerKind::Usize => CHelper::ToUsize,
                };
                Ok(self.helper(helper, &[&inner.text], kind))
            }
            (_, ValueKind::Integer(_)) if is_whole => Ok(self.converted(&inner, kind)),
            (ValueKind::Integer(_), ValueKind::F64) => Ok(self.converted(&inner, kind)),
            _ => refuse(cast.span(), format!("a cast to {}", self.program.show(&kind)), ACCEPTED),
        }
    }

    /// Returns a value converted to a type of numbers.
    pub(super) fn converted(&self, value: &CExpression, kind: ValueKind) -> CExpression {
        CExpression::value(
            format!("({}){}", self.names.plain_type(&kind), value.at_least(UNARY)),
            UNARY,
            kind,
        )
    }

    /// Returns the call of a helper.
    pub(super) fn helper(&mut self, helper: CHelper, arguments: &[&str], kind: ValueKind) -> CExpression {
        if !self.needs.helpers.contains(&helper) {
            self.needs.helpers.push(helper);
        }
        let name = helper.name(self.program.is_single);
        CExpression::value(format!("{name}({})", arguments.join(", ")), POSTFIX, kind)
    }

    /// Translates `matches!(x, A | B)`.
    fn matches(&mut self, call: &syn::Macro) -> Outcome<CExpression> {
        let parsed = call.parse_body_with(|input: syn::parse::ParseStream<'_>| {
            let value: Expr = input.parse()?;
            input.parse::<Token![,]>()?;
            let pattern = Pat::parse_multi_with_leading_vert(input)?;
            input.parse::<Option<Token![,]>>()?;
            Ok((value, pattern))
        });
        let Ok((value, pattern)) = parsed else {
            return refuse(call.path.span(), "this use of `matches!`", "`matches!(x, A | B)`");
        };
        let scrutinee = self.expression(&value, None)?;
        let MatchPattern::Labels(labels) = self.pattern(&pattern, &scrutinee.kind)? else {
            return refuse(pattern.span(), "`_` in `matches!`", "`matches!(x, A | B)`");
        };
        Ok(CExpression::value(
            comparison(&scrutinee, &labels),
            if labels.len() > 1 { 3 } else { 8 },
            ValueKind::Bool,
        ))
    }
}

/// Returns the comparison of a value with each of some labels.
pub(super) fn comparison(value: &CExpression, labels: &[String]) -> String {
    let value = value.at_least(11);
    labels.iter().map(|label| format!("{value} == {label}")).collect::<Vec<_>>().join(" || ")
}

const ACCEPTED: &str = "literals, names, fields, elements, operators, casts, calls and structs";

/// Translates a literal, negated if a minus stands before it.
fn literal_expression(
    literal: &ExprLit,
    expected: Option<&ValueKind>,
    is_negative: bool,
    is_single: bool,
) -> Outcome<CExpression> {
    let level = if is_negative { UNARY } else { POSTFIX };
    match &literal.lit {
        Lit::Bool(value) if !is_negative => {
            Ok(CExpression::value(value.value.to_string(), level, ValueKind::Bool))
        }
        Lit::Float(digits) if matches!(digits.suffix(), "" | "f64" | "f32") => {
            let Ok(value) = digits.base10_parse::<f64>() else {
                return refuse(literal.span(), "this number", "numbers of the type f64");
            };
            let sign = if is_negative { "-" } else { "" };
            let text = format!("{sign}{}", real_literal(value, is_single));
            Ok(CExpression::value(text, level, ValueKind::F64))
        }
        Lit::Int(digits) => {
            let kind = match (IntegerKind::from_name(digits.suffix()), expected) {
                (Some(kind), _) => kind,
                (None, Some(ValueKind::Integer(kind))) if digits.suffix().is_empty() => *kind,
                _ => {
                    let found = format!("the integer `{}`, whose type is not clear", digits.token());
                    return refuse(
                        literal.span(),
                        found,
                        "a suffix, or a written type where it is used; floats have a point",
                    );
                }
            };
            let magnitude: i128 = digits.base10_parse().unwrap_or(i128::MAX);
            let value = if is_negative { -magnitude } else { magnitude };
            if value < kind.range().0 || value > kind.range().1 {
                return refuse(
                    literal.span(),
                    format!("the value {value}"),
                    format!("values of {}", kind.rust_name()),
                );
            }
            let text = integer_literal(
                value,
                kind,
                hexadecimal_digits(&digits.token().to_string(), digits.suffix()).as_deref(),
            );
            let level = if text.starts_with('(') && text.ends_with(')') { POSTFIX } else { level };
            let is_narrow = kind == IntegerKind::Usize && !text.starts_with('(');
            Ok(CExpression { is_narrow, ..CExpression::value(text, level, ValueKind::Integer(kind)) })
        }
        _ => refuse(
            literal.span(),
            "a literal of another type",
            "literals of f64, bool, i32, u32, i64, u64 and usize",
        ),
    }
}
