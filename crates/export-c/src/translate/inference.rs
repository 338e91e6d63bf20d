//! Types of expressions, from the inside: none for literals of integers without a type.

use syn::{BinOp, Block, Expr, ExprMethodCall, Lit, Member, Pat, Path, Stmt, UnOp};

use super::evaluation::{ConstantValue, outside_constant};
use super::functions::FunctionBody;
use super::items::ItemContent;
use super::paths::words;
use super::types::{ArrayLength, IntegerKind, ValueKind};

impl FunctionBody<'_> {
    /// Returns the type of an expression, if it has one without its context.
    pub(super) fn infer(&mut self, written: &Expr) -> Option<ValueKind> {
        match written {
            Expr::Paren(paren) => self.infer(&paren.expr),
            Expr::Group(group) => self.infer(&group.expr),
            Expr::Lit(literal) => match &literal.lit {
                Lit::Float(_) => Some(ValueKind::F64),
                Lit::Bool(_) => Some(ValueKind::Bool),
                Lit::Int(digits) => IntegerKind::from_name(digits.suffix()).map(ValueKind::Integer),
                _ => None,
            },
            Expr::Path(path) => self.infer_path(&path.path),
            Expr::Field(field) => {
                let (ValueKind::Struct(index), Member::Named(name)) =
                    (self.infer(&field.base)?.target().clone(), &field.member)
                else {
                    return None;
                };
                self.program.field_kind(index, &name.to_string()).ok()?
            }
            Expr::Index(index) => match self.infer(&index.expr)?.target() {
                ValueKind::Array(element, _) | ValueKind::Slice { element, .. } => Some((**element).clone()),
                _ => None,
            },
            Expr::Unary(unary) => match unary.op {
                UnOp::Deref(_) => Some(self.infer(&unary.expr)?.target().clone()),
                _ => self.infer(&unary.expr),
            },
            Expr::Binary(binary) => match binary.op {
                BinOp::Eq(_)
                | BinOp::Ne(_)
                | BinOp::Lt(_)
                | BinOp::Le(_)
                | BinOp::Gt(_)
                | BinOp::Ge(_)
                | BinOp::And(_)
                | BinOp::Or(_) => Some(ValueKind::Bool),
                BinOp::Shl(_) | BinOp::Shr(_) => self.infer(&binary.left),
                _ => self.infer(&binary.left).or_else(|| self.infer(&binary.right)),
            },
            Expr::Cast(cast) => self.program.kind(self.file, self.owner, &cast.ty).ok(),
            Expr::Call(call) => {
                let Expr::Path(path) = &*call.func else { return None };
                if let Some(index) = self.program.find(self.file, self.owner, &path.path) {
                    return self.program.function_kind(index).ok()?.map(|kind| kind.result);
                }
                match words(&path.path).first()?.as_str() {
                    "f64" | "f32" => Some(ValueKind::F64),
                    name => IntegerKind::from_name(name).map(ValueKind::Integer),
                }
            }
            Expr::MethodCall(call) => self.infer_method(call),
            Expr::Struct(value) => {
                let index = self.program.find(self.file, self.owner, &value.path)?;
                self.program.type_kind(index)
            }
            Expr::Array(array) => {
                let element = array.elems.iter().find_map(|element| self.infer(element))?;
                let length = ArrayLength { count: array.elems.len() as u64, constant: None };
                Some(ValueKind::Array(Box::new(element), length))
            }
            Expr::Repeat(repeat) => {
                let element = self.infer(&repeat.expr)?;
                let length = self.program.length(self.file, self.owner, &repeat.len).ok()?;
                Some(ValueKind::Array(Box::new(element), length))
            }
            Expr::Reference(reference) => {
                let target = Box::new(self.infer(&reference.expr)?);
                Some(ValueKind::Reference { is_mutable: reference.mutability.is_some(), target })
            }
            Expr::Macro(call) if call.mac.path.is_ident("matches") => Some(ValueKind::Bool),
            Expr::If(branch) => {
                let first = self.infer_block(&branch.then_branch);
                first.or_else(|| branch.else_branch.as_ref().and_then(|(_, other)| self.infer(other)))
            }
            Expr::Match(branch) => branch.arms.iter().find_map(|arm| self.infer(&arm.body)),
            Expr::Block(block) => self.infer_block(&block.block),
            _ => None,
        }
    }

    fn infer_path(&self, path: &Path) -> Option<ValueKind> {
        if let Some(local) = path.get_ident().and_then(|name| self.scopes.look(&name.to_string())) {
            return Some(local.kind.clone());
        }
        if let Some((index, _)) = self.program.find_variant(self.file, self.owner, path) {
            return Some(ValueKind::Enum(index));
        }
        if let Some(index) = self.program.find(self.file, self.owner, path) {
            return self.program.constant_kind(index).ok()?;
        }
        match outside_constant(&words(path))? {
            ConstantValue::Integer(_, kind) => Some(ValueKind::Integer(kind)),
            _ => Some(ValueKind::F64),
        }
    }

    fn infer_method(&mut self, call: &ExprMethodCall) -> Option<ValueKind> {
        let receiver = self.infer(&call.receiver)?.target().clone();
        let method = call.method.to_string();
        match (&receiver, method.as_str()) {
            (ValueKind::Struct(index) | ValueKind::Enum(index), _) => {
                let index = self.program.method(*index, &method)?;
                self.program.function_kind(index).ok()?.map(|kind| kind.result)
            }
            (_, "is_nan" | "is_finite") => Some(ValueKind::Bool),
            (_, "to_bits") => Some(self.program.bits_kind()),
            (_, "leading_zeros") => Some(ValueKind::Integer(IntegerKind::U32)),
            (ValueKind::Array(..) | ValueKind::Slice { .. }, "len") => Some(ValueKind::USIZE),
            _ => Some(receiver),
        }
    }

    /// Returns the type of a block's last expression, which may name locals of the block.
    fn infer_block(&mut self, block: &Block) -> Option<ValueKind> {
        let (Stmt::Expr(last, None), before) = block.stmts.split_last()? else { return None };
        self.scopes.open();
        for statement in before {
            let Stmt::Local(local) = statement else { continue };
            let (pattern, kind) = match &local.pat {
                Pat::Type(typed) => (&*typed.pat, self.program.kind(self.file, self.owner, &typed.ty).ok()),
                pattern => (pattern, local.init.as_ref().and_then(|init| self.infer(&init.expr))),
            };
            if let (Pat::Ident(name), Some(kind)) = (pattern, kind) {
                self.scopes.declare(self.names, &name.ident.to_string(), kind, false);
            }
        }
        let kind = self.infer(last);
        self.scopes.close();
        kind
    }
}

impl super::items::Program<'_> {
    /// Returns the function of a type that has a name.
    pub(super) fn method(&self, owner: usize, name: &str) -> Option<usize> {
        let index = *self.by_path.get(&format!("{}::{name}", self.path(owner)))?;
        matches!(self.items[index].content, ItemContent::Function { .. }).then_some(index)
    }
}
