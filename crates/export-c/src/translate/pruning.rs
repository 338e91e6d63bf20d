//! Pruning of branches that a control system never takes, because a choice is the same in all of it: `if` and `match` of the choice are
//! replaced by the branch that is taken, and functions that only others call are not translated.

use std::collections::BTreeMap;

use proc_macro2::TokenStream;
use syn::{BinOp, Block, Expr, ExprBlock, ExprIf, FnArg, Lit, Member, Pat, Signature, Stmt, Type, UnOp};

use super::paths::words;

/// Choices that are constant in a control system.
#[derive(Clone, Debug, Default)]
pub struct ConstantChoices {
    /// Members of structs and parameters of functions that are true or false, by the struct or function and their names.
    pub flags: BTreeMap<(&'static str, &'static str), bool>,
    /// Variant of all values of an enum, by the name of the enum.
    pub variants: BTreeMap<&'static str, String>,
}

impl ConstantChoices {
    /// Adds a member of a struct, or a parameter of a function, that is true or false, if all values are equal; there may be none.
    pub fn flag(&mut self, place: (&'static str, &'static str), values: impl IntoIterator<Item = bool>) {
        let mut values = values.into_iter();
        if let Some(first) = values.next()
            && values.all(|value| value == first)
        {
            self.flags.insert(place, first);
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

    /// Removes the branches of a function that are never taken; `owner` is the type of a method.
    pub(super) fn prune(&self, owner: Option<&str>, signature: &Signature, block: &mut Block) {
        if self.flags.is_empty() && self.variants.is_empty() {
            return;
        }
        let types = signature.inputs.iter().filter_map(|input| match input {
            FnArg::Receiver(_) => Some(("self".to_owned(), owner?.to_owned())),
            FnArg::Typed(typed) => match &*typed.pat {
                Pat::Ident(name) => Some((name.ident.to_string(), type_name(&typed.ty, owner)?)),
                _ => None,
            },
        });
        let types = types.collect();
        Pruner { choices: self, owner, function: signature.ident.to_string(), types }.prune(block);
    }
}

/// Returns the last word of the path of a type or of what it refers to; that of `Self` is the owner.
fn type_name(written: &Type, owner: Option<&str>) -> Option<String> {
    match written {
        Type::Reference(reference) => type_name(&reference.elem, owner),
        Type::Path(path) => {
            let name = path.path.segments.last()?.ident.to_string();
            if name == "Self" { owner.map(str::to_owned) } else { Some(name) }
        }
        _ => None,
    }
}

/// Pruning of a function.
struct Pruner<'a> {
    choices: &'a ConstantChoices,
    /// Type of a method.
    owner: Option<&'a str>,
    function: String,
    /// Types of the parameters, by their names.
    types: BTreeMap<String, String>,
}

impl Pruner<'_> {
    /// Removes the branches of a block that are never taken; of what follows a `return` for certain, nothing is left.
    fn prune(&self, block: &mut Block) {
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
        let kind = if kind == "Self" { self.owner? } else { kind.as_str() };
        Some(self.choices.variants.get(kind)? == variant)
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
                Member::Named(name) => match &*field.base {
                    Expr::Path(base) => {
                        let base = self.types.get(&base.path.get_ident()?.to_string())?;
                        self.flag(base, &name.to_string())
                    }
                    _ => None,
                },
                Member::Unnamed(_) => None,
            },
            Expr::Path(path) => self.flag(&self.function, &path.path.get_ident()?.to_string()),
            _ => None,
        }
    }

    /// Returns the value of a member of a struct, or of a parameter of a function, if it is constant.
    fn flag(&self, owner: &str, name: &str) -> Option<bool> {
        let mut flags = self.choices.flags.iter();
        flags.find(|((of, own), _)| *of == owner && *own == name).map(|(_, value)| *value)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_are_those_of_their_struct_or_function() {
        let mut choices = ConstantChoices::default();
        choices.flag(("Law", "has_limit"), [true, true]);
        choices.flag(("allocate", "is_least"), [false]);
        let pruned = |owner: Option<&str>, text: &str| {
            let mut function: syn::ItemFn = syn::parse_str(text).expect("a function");
            choices.prune(owner, &function.sig, &mut function.block);
            !function.block.stmts.iter().any(|statement| matches!(statement, Stmt::Expr(Expr::If(_), _)))
        };
        let body = "-> f64 { if self.has_limit { return 1.0; } 2.0 }";
        assert!(pruned(Some("Law"), &format!("fn step(&self) {body}")));
        assert!(!pruned(Some("Other"), &format!("fn step(&self) {body}")));
        assert!(pruned(None, "fn step(law: &Law) -> f64 { if law.has_limit { return 1.0; } 2.0 }"));
        assert!(!pruned(None, "fn step(law: &Other) -> f64 { if law.has_limit { return 1.0; } 2.0 }"));
        assert!(pruned(None, "fn allocate(is_least: bool) -> f64 { if is_least { return 1.0; } 2.0 }"));
        assert!(!pruned(None, "fn other(is_least: bool) -> f64 { if is_least { return 1.0; } 2.0 }"));
    }
}
