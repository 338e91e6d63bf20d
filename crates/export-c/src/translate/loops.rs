//! Loops: `while`, `loop` and `for i in a..b`.

use syn::spanned::Spanned;
use syn::{Expr, ExprForLoop, ExprRange, Lit, Pat, RangeLimits};

use super::error::{Outcome, refuse};
use super::expressions::bare;
use super::functions::FunctionBody;
use super::statements::ValueTarget;
use super::types::ValueKind;

impl FunctionBody<'_> {
    /// Translates a loop.
    pub(super) fn repetition(&mut self, written: &Expr) -> Outcome<()> {
        let label = match written {
            Expr::While(repeated) => &repeated.label,
            Expr::Loop(repeated) => &repeated.label,
            Expr::ForLoop(repeated) => &repeated.label,
            _ => &None,
        };
        if label.is_some() {
            return refuse(written.span(), "a loop with a label", "loops without labels");
        }
        let block = match written {
            Expr::While(repeated) => {
                let condition = self.expression(&repeated.cond, Some(&ValueKind::Bool))?;
                self.code.line(&format!("while ({}) {{", condition.text));
                &repeated.body
            }
            Expr::Loop(repeated) => {
                self.code.line("for (;;) {");
                &repeated.body
            }
            Expr::ForLoop(repeated) => return self.count(repeated),
            _ => return refuse(written.span(), "this loop", "`while`, `loop` and `for i in a..b`"),
        };
        self.inner_block(block, &ValueTarget::Discard)?;
        self.code.line("}");
        Ok(())
    }

    /// Translates `for i in a..b`: both bounds are computed once.
    fn count(&mut self, repeated: &ExprForLoop) -> Outcome<()> {
        const ACCEPTED: &str = "`for i in a..b`";
        let Expr::Range(ExprRange {
            start: Some(start),
            limits: RangeLimits::HalfOpen(_),
            end: Some(end),
            ..
        }) = bare(&repeated.expr)
        else {
            return refuse(repeated.expr.span(), "a loop over something else than `a..b`", ACCEPTED);
        };
        let name = match &*repeated.pat {
            Pat::Ident(name)
                if name.mutability.is_none() && name.by_ref.is_none() && name.subpat.is_none() =>
            {
                name.ident.to_string()
            }
            Pat::Wild(_) => "_pass".to_owned(),
            other => return refuse(other.span(), "a pattern in a `for`", ACCEPTED),
        };
        let kind = self.infer(start).or_else(|| self.infer(end)).unwrap_or(ValueKind::USIZE);
        let ValueKind::Integer(integer) = kind else {
            return refuse(repeated.expr.span(), "a range of another type", "ranges of integers");
        };
        let first = self.expression(start, Some(&kind))?;
        let last = self.expression(end, Some(&kind))?;
        self.scopes.open();
        let c_name = self.scopes.declare(self.names, &name, kind.clone(), false);
        let mut bound = last.at_least(11);
        if !self.is_constant(end) {
            bound = self.scopes.unused_name(self.names, &format!("{c_name}_end"));
            // The name stays reserved within the loop.
            self.scopes.declare(self.names, &format!(" {bound}"), kind.clone(), false);
            self.has_declared = true;
            self.code.line(&format!("const {} {bound} = {};", integer.c_name(), last.text));
        }
        self.code.line(&format!(
            "for ({} {c_name} = {}; {c_name} < {bound}; {c_name}++) {{",
            integer.c_name(),
            first.text
        ));
        self.inner_block(&repeated.body, &ValueTarget::Discard)?;
        self.code.line("}");
        self.scopes.close();
        Ok(())
    }

    /// True for an expression that no statement changes: literals, constants, lengths and immutable locals.
    fn is_constant(&self, written: &Expr) -> bool {
        match bare(written) {
            Expr::Lit(literal) => matches!(literal.lit, Lit::Int(_)),
            Expr::Path(path) => {
                match path.path.get_ident().and_then(|name| self.scopes.look(&name.to_string())) {
                    Some(local) => !local.is_mutable,
                    None => true,
                }
            }
            Expr::MethodCall(call) => call.method == "len",
            Expr::Binary(binary) => self.is_constant(&binary.left) && self.is_constant(&binary.right),
            Expr::Cast(cast) => self.is_constant(&cast.expr),
            _ => false,
        }
    }
}
