//! Statements: declarations, assignments, returns and calls.

use proc_macro2::LineColumn;
use syn::spanned::Spanned;
use syn::{Block, Expr, ExprAssign, Local, Pat, Stmt};

use super::comments::{comment, comment_above, is_kept};
use super::error::{Outcome, refuse};
use super::evaluation::is_open;
use super::expressions::bare;
use super::functions::FunctionBody;
use super::operators::is_assigning;
use super::refusals::describe;
use super::types::ValueKind;

/// Destination of a value.
#[derive(Debug, Clone)]
pub(super) enum ValueTarget {
    /// No destination: the expression is a statement.
    Discard,
    /// Variable that is declared with the value.
    Declare { name: String, kind: ValueKind },
    /// Place that is declared already.
    Assign { place: String, kind: ValueKind },
    /// Result of the function.
    Return(ValueKind),
}

impl ValueTarget {
    /// Returns the type of the value.
    pub(super) fn kind(&self) -> Option<&ValueKind> {
        match self {
            Self::Discard => None,
            Self::Declare { kind, .. } | Self::Assign { kind, .. } | Self::Return(kind) => Some(kind),
        }
    }
}

impl FunctionBody<'_> {
    /// Translates the statements of a block; the last expression goes to the target.
    pub(super) fn block(&mut self, block: &Block, target: &ValueTarget) -> Outcome<()> {
        self.scopes.open();
        for (i, statement) in block.stmts.iter().enumerate() {
            self.comment_before(statement.span().start(), i > 0);
            match statement {
                Stmt::Local(local) => self.local(local)?,
                Stmt::Expr(written, None) if i + 1 == block.stmts.len() => {
                    self.value_into(written, target)?;
                }
                Stmt::Expr(written, _) => self.value_into(written, &ValueTarget::Discard)?,
                Stmt::Item(item) => {
                    return refuse(item.span(), "an item within a function", "items of the file");
                }
                Stmt::Macro(call) => {
                    return refuse(call.span(), "a macro", "`matches!` within an expression");
                }
            }
        }
        for local in self.scopes.close() {
            // Rust lets a name with an underscore be unused.
            if local.name.starts_with('_') && !local.is_used && !local.c_name.is_empty() {
                self.code.line(&format!("(void){};", local.c_name));
            }
        }
        Ok(())
    }

    /// Writes the comment, and a blank line, that stand above a statement.
    fn comment_before(&mut self, start: LineColumn, is_further: bool) {
        let text = self.source.get(start.line - 1).copied().unwrap_or_default();
        if !text.chars().take(start.column).all(char::is_whitespace) {
            // The line has begun with another statement.
            return;
        }
        let (lines, is_blank) = comment_above(self.source, start.line);
        if is_blank && is_further {
            self.code.blank();
        }
        let text = comment(&lines, 4 * self.code.level());
        self.code.verbatim(&text);
    }

    fn local(&mut self, local: &Local) -> Outcome<()> {
        is_kept(&local.attrs)?;
        let (pattern, written) = match &local.pat {
            Pat::Type(typed) => (&*typed.pat, Some(&*typed.ty)),
            pattern => (pattern, None),
        };
        if local.init.as_ref().is_some_and(|init| init.diverge.is_some()) {
            return refuse(local.span(), "`let .. else`", "`let name = value;`");
        }
        let init = local.init.as_ref().map(|init| &*init.expr);
        let (name, is_mutable) = match pattern {
            Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => {
                (name.ident.to_string(), name.mutability.is_some())
            }
            Pat::Wild(_) => {
                let Some(init) = init else { return Ok(()) };
                let value = self.whole(init, None)?;
                self.code.line(&format!("(void){};", value.at_least(super::operators::UNARY)));
                return Ok(());
            }
            other => return refuse(other.span(), "a pattern in a `let`", "`let name = value;`"),
        };
        let kind = match (written, init) {
            (Some(written), _) => Some(self.program.kind(self.file, self.owner, written)?),
            (None, Some(init)) => self.infer(init),
            (None, None) => None,
        };
        let Some(kind) = kind else {
            if let Some(init) = init {
                // A construct that is refused has a better message than its type.
                self.refuse_deeply(init)?;
            }
            let found = format!("`{name}`, whose type is not clear");
            return refuse(pattern.span(), found, format!("`let {name}: TYPE = ..;`"));
        };
        match &kind {
            ValueKind::Reference { .. } | ValueKind::Slice { .. } => {
                return refuse(local.span(), "a local that is a reference", "references as parameters");
            }
            ValueKind::Unit => return refuse(local.span(), "a local without value", "a statement"),
            ValueKind::Array(..)
                if init.is_none_or(|init| !matches!(bare(init), Expr::Array(_) | Expr::Repeat(_))) =>
            {
                return refuse(local.span(), "an array by value", "an initialiser `[a, b]` or `[x; N]`");
            }
            _ => {}
        }
        self.needs.add_kind(&kind);
        // The value may name an older local of this name.
        let c_name = self.scopes.declare(self.names, &name, kind.clone(), is_mutable);
        self.scopes.hide(&c_name);
        match init {
            Some(init) => self.value_into(init, &ValueTarget::Declare { name: c_name.clone(), kind })?,
            None => self.declare(&kind, &c_name),
        }
        self.scopes.show(&c_name, &name);
        Ok(())
    }

    /// Translates an expression to find what in it is refused.
    fn refuse_deeply(&mut self, written: &Expr) -> Outcome<()> {
        match bare(written) {
            literal if is_open(literal) => Ok(()),
            Expr::If(_) | Expr::Match(_) | Expr::Block(_) | Expr::Array(_) | Expr::Repeat(_) => Ok(()),
            other => self.whole(other, None).map(|_| ()),
        }
    }

    /// Declares a variable without a value.
    pub(super) fn declare(&mut self, kind: &ValueKind, name: &str) {
        self.has_declared = true;
        let text = self.names.declaration(kind, name);
        self.code.line(&format!("{text};"));
    }

    /// Writes the statements that give a value to a target.
    pub(super) fn value_into(&mut self, written: &Expr, target: &ValueTarget) -> Outcome<()> {
        match bare(written) {
            Expr::If(branch) => {
                let target = self.declared(target);
                self.branch(branch, &target)
            }
            Expr::Match(branch) => {
                let target = self.declared(target);
                self.match_branch(branch, &target)
            }
            Expr::Block(block) if block.label.is_none() => {
                let target = self.declared(target);
                self.code.line("{");
                self.code.indent();
                self.block(&block.block, &target)?;
                self.code.outdent();
                self.code.line("}");
                Ok(())
            }
            Expr::While(_) | Expr::Loop(_) | Expr::ForLoop(_) => self.repetition(bare(written)),
            Expr::Return(result) => self.return_value(result.expr.as_deref()),
            Expr::Break(stop) => {
                if stop.label.is_some() || stop.expr.is_some() {
                    return refuse(stop.span(), "`break` with a label or a value", "`break`");
                }
                self.code.line("break;");
                Ok(())
            }
            Expr::Continue(next) => {
                if next.label.is_some() {
                    return refuse(next.span(), "`continue` with a label", "`continue`");
                }
                self.code.line("continue;");
                Ok(())
            }
            Expr::Assign(assign) => self.assign(assign),
            Expr::Binary(binary) if is_assigning(&binary.op) => {
                let value = self.binary(binary, None)?;
                self.code.line(&format!("{};", value.text));
                Ok(())
            }
            Expr::Struct(_) | Expr::Array(_) | Expr::Repeat(_) if target.kind().is_some() => {
                self.aggregate_into(bare(written), target)
            }
            Expr::Call(_) | Expr::MethodCall(_) => self.plain_into(written, target),
            other if matches!(target, ValueTarget::Discard) => match other {
                Expr::Tuple(tuple) if tuple.elems.is_empty() => Ok(()),
                Expr::Macro(_)
                | Expr::Closure(_)
                | Expr::Unsafe(_)
                | Expr::Try(_)
                | Expr::Tuple(_)
                | Expr::Block(_)
                | Expr::Let(_)
                | Expr::Async(_)
                | Expr::Await(_) => refuse(other.span(), describe(other), ACCEPTED),
                _ => refuse(other.span(), "an expression whose value is lost", ACCEPTED),
            },
            _ => self.plain_into(written, target),
        }
    }

    /// Declares the variable of a target, so that branches can assign it.
    fn declared(&mut self, target: &ValueTarget) -> ValueTarget {
        let ValueTarget::Declare { name, kind } = target else { return target.clone() };
        self.declare(kind, name);
        ValueTarget::Assign { place: name.clone(), kind: kind.clone() }
    }

    fn plain_into(&mut self, written: &Expr, target: &ValueTarget) -> Outcome<()> {
        let value = self.whole(written, target.kind())?;
        if !matches!(target, ValueTarget::Discard) && !value.kind.is_plain() {
            return refuse(written.span(), "an array by value", "elements, or a struct that holds the array");
        }
        match target {
            ValueTarget::Discard if value.kind == ValueKind::Unit => {
                self.code.line(&format!("{};", value.text));
            }
            ValueTarget::Discard => {
                self.code.line(&format!("(void){};", value.at_least(super::operators::UNARY)));
            }
            ValueTarget::Declare { name, kind } => {
                self.has_declared = true;
                let start = self.names.declaration(kind, name);
                self.code.line(&format!("{start} = {};", value.text));
            }
            ValueTarget::Assign { place, .. } => self.code.line(&format!("{place} = {};", value.text)),
            ValueTarget::Return(_) => self.code.line(&format!("return {};", value.text)),
        }
        Ok(())
    }

    fn return_value(&mut self, written: Option<&Expr>) -> Outcome<()> {
        let Some(written) = written else {
            self.code.line("return;");
            return Ok(());
        };
        let kind = self.result.clone();
        self.value_into(written, &ValueTarget::Return(kind))
    }

    fn assign(&mut self, assign: &ExprAssign) -> Outcome<()> {
        let place = self.expression(&assign.left, None)?;
        if !place.is_place {
            return refuse(
                assign.left.span(),
                "an assignment to this expression",
                "names, fields and elements",
            );
        }
        if let ValueKind::Reference { .. } = place.kind {
            return refuse(assign.left.span(), "an assignment to a reference", "`*` before the reference");
        }
        if !place.kind.is_plain() {
            return refuse(assign.span(), "an assignment of a whole array", "assignments of its elements");
        }
        // Rust computes the value before the index, C in any order.
        if place.text.contains('[') && self.may_change(&assign.right) {
            let found = "an assignment of a call that changes its arguments to an element";
            return refuse(assign.span(), found, "a local that holds the value first");
        }
        self.value_into(&assign.right, &ValueTarget::Assign { place: place.text, kind: place.kind })
    }

    /// True for a call that may change its arguments.
    fn may_change(&mut self, written: &Expr) -> bool {
        matches!(bare(written), Expr::Call(_) | Expr::MethodCall(_)) && self.expression_is_refused(written)
    }

    fn expression_is_refused(&mut self, written: &Expr) -> bool {
        self.expression(written, None).is_err()
    }
}

const ACCEPTED: &str =
    "declarations, assignments, calls, `if`, `match`, loops, `break`, `continue` and `return`";
