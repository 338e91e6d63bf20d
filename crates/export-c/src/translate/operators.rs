//! Operators of two operands: order of evaluation as in Rust, brackets where C or its compilers' warnings need them.

use syn::spanned::Spanned;
use syn::{BinOp, ExprBinary};

use super::error::{Outcome, refuse};
use super::expressions::CExpression;
use super::functions::FunctionBody;
use super::types::{IntegerKind, ValueKind};

/// Level of names, calls, fields and elements.
pub(super) const POSTFIX: u8 = 15;
/// Level of signs and casts.
pub(super) const UNARY: u8 = 14;
const PRODUCT: u8 = 12;
const SUM: u8 = 11;
const SHIFT: u8 = 10;
const ORDER: u8 = 9;
const EQUALITY: u8 = 8;
const BIT_AND: u8 = 7;
const BIT_XOR: u8 = 6;
const BIT_OR: u8 = 5;
const AND: u8 = 4;
const OR: u8 = 3;

/// Operator in C: its sign, its level, and the least levels of its operands without brackets.
struct COperator {
    sign: &'static str,
    level: u8,
    left: u8,
    right: u8,
}

/// Returns an operator in C, with the sign of the assignment for an assigning one.
fn operator(written: &BinOp) -> Option<COperator> {
    let (sign, level, left, right) = match written {
        BinOp::Mul(_) => ("*", PRODUCT, PRODUCT, PRODUCT + 1),
        BinOp::Div(_) => ("/", PRODUCT, PRODUCT, PRODUCT + 1),
        BinOp::Rem(_) => ("%", PRODUCT, PRODUCT, PRODUCT + 1),
        BinOp::Add(_) => ("+", SUM, SUM, SUM + 1),
        BinOp::Sub(_) => ("-", SUM, SUM, SUM + 1),
        BinOp::Shl(_) => ("<<", SHIFT, UNARY, UNARY),
        BinOp::Shr(_) => (">>", SHIFT, UNARY, UNARY),
        BinOp::Lt(_) => ("<", ORDER, SUM, SUM),
        BinOp::Le(_) => ("<=", ORDER, SUM, SUM),
        BinOp::Gt(_) => (">", ORDER, SUM, SUM),
        BinOp::Ge(_) => (">=", ORDER, SUM, SUM),
        BinOp::Eq(_) => ("==", EQUALITY, SUM, SUM),
        BinOp::Ne(_) => ("!=", EQUALITY, SUM, SUM),
        BinOp::BitAnd(_) => ("&", BIT_AND, UNARY, UNARY),
        BinOp::BitXor(_) => ("^", BIT_XOR, UNARY, UNARY),
        BinOp::BitOr(_) => ("|", BIT_OR, UNARY, UNARY),
        BinOp::And(_) => ("&&", AND, EQUALITY, EQUALITY),
        BinOp::Or(_) => ("||", OR, EQUALITY, EQUALITY),
        BinOp::AddAssign(_) => ("+=", 0, 0, 0),
        BinOp::SubAssign(_) => ("-=", 0, 0, 0),
        BinOp::MulAssign(_) => ("*=", 0, 0, 0),
        BinOp::DivAssign(_) => ("/=", 0, 0, 0),
        BinOp::RemAssign(_) => ("%=", 0, 0, 0),
        BinOp::BitXorAssign(_) => ("^=", 0, 0, 0),
        BinOp::BitAndAssign(_) => ("&=", 0, 0, 0),
        BinOp::BitOrAssign(_) => ("|=", 0, 0, 0),
        BinOp::ShlAssign(_) => ("<<=", 0, 0, 0),
        BinOp::ShrAssign(_) => (">>=", 0, 0, 0),
        _ => return None,
    };
    Some(COperator { sign, level, left, right })
}

/// True for an operator that also assigns.
pub(super) fn is_assigning(written: &BinOp) -> bool {
    operator(written).is_some_and(|operator| operator.level == 0)
}

fn is_shift(written: &BinOp) -> bool {
    matches!(written, BinOp::Shl(_) | BinOp::Shr(_) | BinOp::ShlAssign(_) | BinOp::ShrAssign(_))
}

impl FunctionBody<'_> {
    /// Translates an operation, or an assignment with an operation.
    pub(super) fn binary(
        &mut self,
        binary: &ExprBinary,
        expected: Option<&ValueKind>,
    ) -> Outcome<CExpression> {
        let Some(operator) = operator(&binary.op) else {
            return refuse(
                binary.span(),
                "this operator",
                "arithmetic, comparisons, `&& ||`, bit operations and shifts",
            );
        };
        let is_comparison = matches!(operator.level, ORDER | EQUALITY);
        let is_logical = matches!(operator.level, AND | OR);
        let kind = if is_logical {
            Some(ValueKind::Bool)
        } else if is_shift(&binary.op) {
            self.infer(&binary.left).or_else(|| expected.cloned())
        } else {
            let inferred = self.infer(&binary.left).or_else(|| self.infer(&binary.right));
            inferred.or_else(|| if is_comparison { None } else { expected.cloned() })
        };
        if let Some(reference @ ValueKind::Reference { .. }) = &kind {
            let found = format!("an operation with {}", self.program.show(reference));
            return refuse(binary.span(), found, "`*` before the reference");
        }
        let left = self.expression(&binary.left, kind.as_ref())?;
        let right = if is_shift(&binary.op) {
            let count = self.infer(&binary.right).unwrap_or(ValueKind::Integer(IntegerKind::I32));
            self.expression(&binary.right, Some(&count))?
        } else {
            self.expression(&binary.right, Some(&left.kind))?
        };
        self.check_operands(binary, &left.kind)?;
        let is_assigning = operator.level == 0;
        if is_assigning && !left.is_place {
            return refuse(
                binary.left.span(),
                "an assignment to this expression",
                "names, fields and elements",
            );
        }
        let is_narrow = left.is_narrow && right.is_narrow && !is_assigning;
        let mut first = left.clone();
        // C computes with literals and enumerators as with an `int`.
        if (is_narrow && !is_comparison) || (is_shift(&binary.op) && left.is_narrow && !is_assigning) {
            first = self.converted(&left, ValueKind::USIZE);
        }
        let left_text = side(&first, &operator, operator.left, true);
        let right_text = side(&right, &operator, operator.right, false);
        let kind = if is_comparison || is_logical { ValueKind::Bool } else { left.kind };
        Ok(CExpression::value(format!("{left_text} {} {right_text}", operator.sign), operator.level, kind))
    }

    fn check_operands(&self, binary: &ExprBinary, kind: &ValueKind) -> Outcome<()> {
        let is_unsigned = matches!(kind, ValueKind::Integer(integer) if !integer.is_signed());
        let accepted = match binary.op {
            BinOp::And(_) | BinOp::Or(_) if *kind != ValueKind::Bool => "`&& ||` of bool",
            BinOp::Eq(_) | BinOp::Ne(_)
                if !matches!(
                    kind,
                    ValueKind::F64 | ValueKind::Bool | ValueKind::Integer(_) | ValueKind::Enum(_)
                ) =>
            {
                "`== !=` of numbers, bool and enums"
            }
            BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_)
                if !matches!(kind, ValueKind::F64 | ValueKind::Integer(_)) =>
            {
                "`< <= > >=` of numbers"
            }
            BinOp::Shl(_) | BinOp::Shr(_) | BinOp::ShlAssign(_) | BinOp::ShrAssign(_) if !is_unsigned => {
                "shifts of unsigned integers"
            }
            BinOp::BitAnd(_)
            | BinOp::BitOr(_)
            | BinOp::BitXor(_)
            | BinOp::BitAndAssign(_)
            | BinOp::BitOrAssign(_)
            | BinOp::BitXorAssign(_)
                if !is_unsigned && *kind != ValueKind::Bool =>
            {
                "bit operations of unsigned integers and of bool"
            }
            BinOp::Rem(_) | BinOp::RemAssign(_) if !matches!(kind, ValueKind::Integer(_)) => {
                "`%` of integers"
            }
            BinOp::Add(_)
            | BinOp::Sub(_)
            | BinOp::Mul(_)
            | BinOp::Div(_)
            | BinOp::AddAssign(_)
            | BinOp::SubAssign(_)
            | BinOp::MulAssign(_)
            | BinOp::DivAssign(_)
                if !matches!(kind, ValueKind::F64 | ValueKind::Integer(_)) =>
            {
                "arithmetic of numbers"
            }
            _ => return Ok(()),
        };
        refuse(binary.span(), format!("this operator with {}", self.program.show(kind)), accepted)
    }
}

/// Returns the text of an operand.
fn side(value: &CExpression, operator: &COperator, least: u8, is_left: bool) -> String {
    // a && b && c, and a | b | c, group from the left in both languages.
    let is_chain =
        is_left && value.level == operator.level && matches!(operator.level, BIT_OR..=BIT_AND | AND | OR);
    let is_not = value.text.starts_with('!') && matches!(operator.level, ORDER | EQUALITY);
    if is_not || (value.level < least && !is_chain) {
        format!("({})", value.text)
    } else {
        value.text.clone()
    }
}
