//! Pruning of branches that a control system never takes, because a choice is the same in all of it: `if` and `match` of the choice are
//! replaced by the branch that is taken, and functions that only others call are not translated.

use std::collections::BTreeMap;

use proc_macro2::TokenStream;
use syn::{BinOp, Block, Expr, ExprBlock, ExprIf, Lit, Member, Stmt, UnOp};

use super::paths::words;

/// Choices that are constant in a control system.
#[derive(Clone, Debug, Default)]
pub struct ConstantChoices {
    /// Members and parameters that are true or false, by their names.
    pub flags: BTreeMap<&'static str, bool>,
    /// Variant of all values of an enum, by the name of the enum.
    pub variants: BTreeMap<&'static str, String>,
}

impl ConstantChoices {
    /// Adds a choice that is true or false, if all values are equal; there may be none.
    pub fn flag(&mut self, name: &'static str, values: impl IntoIterator<Item = bool>) {
        let mut values = values.into_iter();
        if let Some(first) = values.next()
            && values.all(|value| value == first)
        {
            self.flags.insert(name, first);
        }
    }

    /// Adds the variant of an enum, if all values are equal; there may be none.
    pub fn variant<T: std::fmt::Debug + PartialEq>(
        &mut self,
        name: &'static str,
        values: impl IntoIterator<Item = T>,
    ) {
        let mut values = values.into_iter();
        if let Some(first) = values.next()
            && values.all(|value| value == first)
        {
            self.variants.insert(name, format!("{first:?}"));
        }
    }

    /// Removes the branches of a function of a type that are never taken.
    pub(super) fn prune_method(&self, owner: &str, block: &mut Block) {
        let mut own = self.clone();
        if let Some(variant) = self.variants.get(owner) {
            own.variants.insert("Self", variant.clone());
        }
        own.prune(block);
    }

    /// Removes the branches of a block that are never taken; of what follows a `return` for certain, nothing is left.
    pub(super) fn prune(&self, block: &mut Block) {
        if self.flags.is_empty() && self.variants.is_empty() {
            return;
        }
        let mut kept: Vec<Stmt> = Vec::new();
        for mut statement in std::mem::take(&mut block.stmts) {
            match &mut statement {
                Stmt::Local(local) => {
                    if let Some(init) = &mut local.init {
                        self.prune_expression(&mut init.expr);
                    }
                }
                Stmt::Expr(written, _) => self.prune_expression(written),
                Stmt::Item(_) | Stmt::Macro(_) => {}
            }
            let ends = matches!(&statement, Stmt::Expr(Expr::Block(inner), _) if returns(&inner.block));
            if !is_nothing(&statement) {
                kept.push(statement);
            }
            if ends {
                break;
            }
        }
        block.stmts = kept;
    }

    fn prune_expression(&self, written: &mut Expr) {
        let whole = std::mem::replace(written, Expr::Verbatim(TokenStream::new()));
        *written = self.pruned(whole);
    }

    /// Returns an expression without the branches that are never taken.
    fn pruned(&self, mut written: Expr) -> Expr {
        match &mut written {
            Expr::Block(block) => self.prune(&mut block.block),
            Expr::ForLoop(each) => self.prune(&mut each.body),
            Expr::While(each) => self.prune(&mut each.body),
            Expr::Loop(each) => self.prune(&mut each.body),
            _ => {}
        }
        match written {
            Expr::If(branch) => self.pruned_if(branch),
            Expr::Match(mut branch) => {
                for arm in &mut branch.arms {
                    self.prune_expression(&mut arm.body);
                }
                let is_choice = matches!(&*branch.expr, Expr::Field(_) | Expr::Path(_));
                match branch.arms.iter().position(|arm| is_choice && self.is_taken(&arm.pat)) {
                    Some(taken) => *branch.arms.swap_remove(taken).body,
                    None => Expr::Match(branch),
                }
            }
            other => other,
        }
    }

    fn pruned_if(&self, mut branch: ExprIf) -> Expr {
        self.prune(&mut branch.then_branch);
        if let Some((_, other)) = &mut branch.else_branch {
            self.prune_expression(other);
        }
        match (self.truth(&branch.cond), branch.else_branch.take()) {
            (Some(true), _) => plain(branch.then_branch),
            (Some(false), Some((_, other))) => match *other {
                Expr::Block(block) => plain(block.block),
                other => other,
            },
            (Some(false), None) => {
                branch.then_branch.stmts.clear();
                plain(branch.then_branch)
            }
            (None, other) => {
                branch.else_branch = other;
                Expr::If(branch)
            }
        }
    }

    /// Returns true if a pattern has the one variant that values of its enum have.
    fn is_taken(&self, pattern: &syn::Pat) -> bool {
        match pattern {
            syn::Pat::Path(path) => self.variant_is(&words(&path.path)) == Some(true),
            syn::Pat::Or(several) => several.cases.iter().any(|case| self.is_taken(case)),
            _ => false,
        }
    }

    /// Returns true if a path `Enum::Variant` names the one variant of its enum; `None` if there are several.
    fn variant_is(&self, path: &[String]) -> Option<bool> {
        let [kind, variant] = path else { return None };
        Some(self.variants.get(kind.as_str())? == variant)
    }

    /// Returns the value of a condition, if it is constant.
    fn truth(&self, condition: &Expr) -> Option<bool> {
        match condition {
            Expr::Paren(inner) => self.truth(&inner.expr),
            Expr::Lit(literal) => match &literal.lit {
                Lit::Bool(value) => Some(value.value),
                _ => None,
            },
            Expr::Unary(negated) if matches!(negated.op, UnOp::Not(_)) => {
                self.truth(&negated.expr).map(|value| !value)
            }
            Expr::Binary(both) => match both.op {
                BinOp::And(_) => match (self.truth(&both.left), self.truth(&both.right)) {
                    (Some(false), _) => Some(false),
                    (Some(true), right) => right,
                    (None, _) => None,
                },
                BinOp::Or(_) => match (self.truth(&both.left), self.truth(&both.right)) {
                    (Some(true), _) => Some(true),
                    (Some(false), right) => right,
                    (None, _) => None,
                },
                BinOp::Eq(_) => self.is_equal(&both.left, &both.right),
                BinOp::Ne(_) => self.is_equal(&both.left, &both.right).map(|value| !value),
                _ => None,
            },
            Expr::Field(field) => match &field.member {
                Member::Named(name) => self.flags.get(name.to_string().as_str()).copied(),
                Member::Unnamed(_) => None,
            },
            Expr::Path(path) => {
                let name = path.path.get_ident()?.to_string();
                self.flags.get(name.as_str()).copied()
            }
            _ => None,
        }
    }

    /// Returns whether a member has a variant, if that is constant.
    fn is_equal(&self, left: &Expr, right: &Expr) -> Option<bool> {
        match (left, right) {
            (Expr::Field(_), Expr::Path(path)) => self.variant_is(&words(&path.path)),
            _ => None,
        }
    }
}

/// Returns a block as an expression: its value, if it has nothing else.
fn plain(mut block: Block) -> Expr {
    if let [Stmt::Expr(_, None)] = &block.stmts[..]
        && let Some(Stmt::Expr(value, None)) = block.stmts.pop()
    {
        return value;
    }
    Expr::Block(ExprBlock { attrs: Vec::new(), label: None, block })
}

/// True for a statement that is a block without statements.
fn is_nothing(statement: &Stmt) -> bool {
    matches!(statement, Stmt::Expr(Expr::Block(block), _) if block.block.stmts.is_empty())
}

/// True if a block returns for certain.
fn returns(block: &Block) -> bool {
    matches!(block.stmts.last(), Some(Stmt::Expr(Expr::Return(_), _)))
}
