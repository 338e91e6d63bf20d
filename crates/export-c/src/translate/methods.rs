//! Methods of numbers.

use syn::ExprMethodCall;
use syn::spanned::Spanned;

use super::error::{Outcome, refuse};
use super::expressions::CExpression;
use super::functions::FunctionBody;
use super::helpers::CHelper;
use super::operators::UNARY;
use super::types::{IntegerKind, ValueKind};

impl FunctionBody<'_> {
    /// Translates a method of a number.
    pub(super) fn number_method(&mut self, call: &ExprMethodCall, kind: &ValueKind) -> Outcome<CExpression> {
        let method = call.method.to_string();
        let mut receiver = self.expression(&call.receiver, None)?;
        if matches!(receiver.kind, ValueKind::Reference { .. }) {
            receiver = CExpression::value(format!("*{}", receiver.at_least(UNARY)), UNARY, kind.clone());
        }
        let argument = match call.args.first() {
            Some(written) => Some(self.expression(written, Some(kind))?),
            None => None,
        };
        if call.args.len() > 1 {
            return refuse(
                call.span(),
                format!("`{method}` with {} arguments", call.args.len()),
                "one or none",
            );
        }
        match (kind, argument) {
            (ValueKind::F64, None) => {
                let (helper, result) = match method.as_str() {
                    "abs" => (CHelper::Abs, ValueKind::F64),
                    "is_nan" => (CHelper::IsNan, ValueKind::Bool),
                    "is_finite" => (CHelper::IsFinite, ValueKind::Bool),
                    "to_bits" => (CHelper::ToBits, self.program.bits_kind()),
                    _ => return unknown(call, "f64", FLOAT_METHODS),
                };
                Ok(self.helper(helper, &[&receiver.text], result))
            }
            (ValueKind::F64, Some(argument)) if method == "copysign" => {
                Ok(self.helper(CHelper::Copysign, &[&receiver.text, &argument.text], ValueKind::F64))
            }
            (ValueKind::F64, Some(_)) => unknown(call, "f64", FLOAT_METHODS),
            (ValueKind::Integer(integer), None) if method == "leading_zeros" => {
                let (helper, text) = match integer {
                    IntegerKind::U32 => (CHelper::U32LeadingZeros, receiver.text),
                    IntegerKind::U64 => (CHelper::U64LeadingZeros, receiver.text),
                    IntegerKind::Usize => (CHelper::UsizeLeadingZeros, receiver.text),
                    IntegerKind::I32 => {
                        (CHelper::U32LeadingZeros, format!("(uint32_t){}", receiver.at_least(UNARY)))
                    }
                    IntegerKind::I64 => {
                        (CHelper::U64LeadingZeros, format!("(uint64_t){}", receiver.at_least(UNARY)))
                    }
                };
                Ok(self.helper(helper, &[&text], ValueKind::Integer(IntegerKind::U32)))
            }
            (ValueKind::Integer(integer), Some(argument)) => {
                self.integer_method(call, *integer, &receiver, &argument)
            }
            _ => unknown(call, &self.program.show(kind), INTEGER_METHODS),
        }
    }

    fn integer_method(
        &mut self,
        call: &ExprMethodCall,
        kind: IntegerKind,
        a: &CExpression,
        b: &CExpression,
    ) -> Outcome<CExpression> {
        let method = call.method.to_string();
        let sign = match method.as_str() {
            "wrapping_add" => "+",
            "wrapping_sub" => "-",
            "wrapping_mul" => "*",
            "div_euclid" => "/",
            "rem_euclid" => "%",
            _ => return unknown(call, kind.rust_name(), INTEGER_METHODS),
        };
        let helper = match (kind, sign) {
            (IntegerKind::I32, "+") => CHelper::I32WrappingAdd,
            (IntegerKind::I32, "-") => CHelper::I32WrappingSub,
            (IntegerKind::I32, "*") => CHelper::I32WrappingMul,
            (IntegerKind::I32, "/") => CHelper::I32DivEuclid,
            (IntegerKind::I32, _) => CHelper::I32RemEuclid,
            (IntegerKind::I64, "+") => CHelper::I64WrappingAdd,
            (IntegerKind::I64, "-") => CHelper::I64WrappingSub,
            (IntegerKind::I64, "*") => CHelper::I64WrappingMul,
            (IntegerKind::I64, "/") => CHelper::I64DivEuclid,
            (IntegerKind::I64, _) => CHelper::I64RemEuclid,
            _ => {
                // Unsigned arithmetic of C is modular.
                let first = if a.is_narrow { self.converted(a, ValueKind::USIZE) } else { a.clone() };
                let level = if matches!(sign, "+" | "-") { 11 } else { 12 };
                let text = format!("{} {sign} {}", first.at_least(level), b.at_least(level + 1));
                return Ok(CExpression::value(text, level, ValueKind::Integer(kind)));
            }
        };
        Ok(self.helper(helper, &[&a.text, &b.text], ValueKind::Integer(kind)))
    }
}

const FLOAT_METHODS: &str = "abs, copysign, is_nan, is_finite and to_bits; crate::maths has min, max, clamp and the functions of mathematics";
const INTEGER_METHODS: &str =
    "wrapping_add, wrapping_sub, wrapping_mul, div_euclid, rem_euclid and leading_zeros";

fn unknown(call: &ExprMethodCall, kind: &str, accepted: &str) -> Outcome<CExpression> {
    refuse(call.method.span(), format!("the method `{}` of {kind}", call.method), accepted)
}
