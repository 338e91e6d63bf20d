//! Branches: `if`, and `match` as `switch`, or as `if` where an arm leaves a loop.

use syn::spanned::Spanned;
use syn::{Block, Expr, ExprIf, ExprMatch, Lit, Pat, Stmt};

use super::comments::is_kept;
use super::error::{Outcome, refuse};
use super::expressions::{CExpression, bare, comparison};
use super::functions::FunctionBody;
use super::items::ItemContent;
use super::operators::POSTFIX;
use super::statements::ValueTarget;
use super::types::ValueKind;

/// Pattern of an arm.
pub(super) enum MatchPattern {
    /// Variants of an enum, or integers.
    Labels(Vec<String>),
    /// `_`
    Rest,
}

impl FunctionBody<'_> {
    /// Translates `if`.
    pub(super) fn branch(&mut self, branch: &ExprIf, target: &ValueTarget) -> Outcome<()> {
        let condition = self.expression(&branch.cond, Some(&ValueKind::Bool))?;
        self.code.line(&format!("if ({}) {{", condition.text));
        self.branches_after(branch, target)
    }

    /// Writes the blocks of an `if` whose first line has been written.
    fn branches_after(&mut self, branch: &ExprIf, target: &ValueTarget) -> Outcome<()> {
        self.inner_block(&branch.then_branch, target)?;
        let Some((_, other)) = &branch.else_branch else {
            self.code.line("}");
            return Ok(());
        };
        match bare(other) {
            Expr::If(next) => {
                let condition = self.expression(&next.cond, Some(&ValueKind::Bool))?;
                self.code.line(&format!("}} else if ({}) {{", condition.text));
                self.branches_after(next, target)
            }
            Expr::Block(block) => {
                self.code.line("} else {");
                self.inner_block(&block.block, target)?;
                self.code.line("}");
                Ok(())
            }
            other => refuse(other.span(), "this `else`", "`else { .. }` and `else if`"),
        }
    }

    /// Translates a block, indented.
    pub(super) fn inner_block(&mut self, block: &Block, target: &ValueTarget) -> Outcome<()> {
        self.code.indent();
        self.block(block, target)?;
        self.code.outdent();
        Ok(())
    }

    /// Translates `match` of an enum or an integer.
    pub(super) fn match_branch(&mut self, branch: &ExprMatch, target: &ValueTarget) -> Outcome<()> {
        let mut scrutinee = self.expression(&branch.expr, None)?;
        if !matches!(scrutinee.kind, ValueKind::Enum(_) | ValueKind::Integer(_)) {
            let found = format!("`match` of {}", self.program.show(&scrutinee.kind));
            return refuse(branch.expr.span(), found, "`match` of an enum or an integer");
        }
        let mut arms = Vec::new();
        for arm in &branch.arms {
            is_kept(&arm.attrs)?;
            arms.push((self.pattern(&arm.pat, &scrutinee.kind)?, &*arm.body));
        }
        self.check_all_variants(branch, &scrutinee.kind, &arms)?;
        if arms.iter().any(|(_, body)| leaves_loop(body)) {
            if scrutinee.level < POSTFIX || scrutinee.text.contains('(') {
                let name = self.scopes.unused_name(self.names, "selected");
                let text = self.names.declaration(&scrutinee.kind, &name);
                self.code.line(&format!("{text} = {};", scrutinee.text));
                scrutinee = CExpression::value(name, POSTFIX, scrutinee.kind);
            }
            return self.match_as_if(&scrutinee, &arms, target);
        }
        self.code.line(&format!("switch ({}) {{", scrutinee.text));
        let last = arms.len().saturating_sub(1);
        for (i, (pattern, body)) in arms.into_iter().enumerate() {
            match pattern {
                MatchPattern::Labels(labels) => {
                    for label in &labels {
                        self.code.line(&format!("case {label}:"));
                    }
                    // All variants are listed: no value is left for a compiler to warn of.
                    if i == last {
                        self.code.line("default:");
                    }
                }
                MatchPattern::Rest => self.code.line("default:"),
            }
            self.arm(body, target)?;
        }
        self.code.line("}");
        Ok(())
    }

    /// Writes the statements of an arm; those with declarations get a block.
    fn arm(&mut self, body: &Expr, target: &ValueTarget) -> Outcome<()> {
        let outer = std::mem::replace(&mut self.has_declared, false);
        let start = self.code.len();
        self.code.indent();
        self.arm_body(body, target)?;
        if !["return", "continue"].iter().any(|word| self.code.last().starts_with(word))
            || self.code.len() == start
        {
            self.code.line("break;");
        }
        self.code.outdent();
        if self.has_declared {
            self.code.append_at(start - 1, " {");
            self.code.line("}");
        }
        self.has_declared = outer || self.has_declared;
        Ok(())
    }

    fn arm_body(&mut self, body: &Expr, target: &ValueTarget) -> Outcome<()> {
        match bare(body) {
            Expr::Block(block) if block.label.is_none() => self.block(&block.block, target),
            other => self.value_into(other, target),
        }
    }

    fn match_as_if(
        &mut self,
        scrutinee: &CExpression,
        arms: &[(MatchPattern, &Expr)],
        target: &ValueTarget,
    ) -> Outcome<()> {
        for (i, (pattern, body)) in arms.iter().enumerate() {
            let is_last = i > 0 && i + 1 == arms.len();
            let word = if i == 0 { "" } else { "} else " };
            match pattern {
                MatchPattern::Labels(labels) if !is_last => {
                    let condition = comparison(scrutinee, labels);
                    self.code.line(&format!("{word}if ({condition}) {{"));
                }
                _ if i == 0 => self.code.line("{"),
                _ => self.code.line("} else {"),
            }
            self.code.indent();
            self.arm_body(body, target)?;
            self.code.outdent();
        }
        self.code.line("}");
        Ok(())
    }

    /// Translates a pattern: variants, integers, or `_`.
    pub(super) fn pattern(&mut self, pattern: &Pat, kind: &ValueKind) -> Outcome<MatchPattern> {
        const ACCEPTED: &str = "variants of the enum, literals of integers, `A | B` and `_`";
        match pattern {
            Pat::Wild(_) => Ok(MatchPattern::Rest),
            Pat::Paren(paren) => self.pattern(&paren.pat, kind),
            Pat::Or(several) => {
                let mut all = Vec::new();
                for case in &several.cases {
                    match self.pattern(case, kind)? {
                        MatchPattern::Labels(labels) => all.extend(labels),
                        MatchPattern::Rest => {
                            return refuse(case.span(), "`_` beside other patterns", ACCEPTED);
                        }
                    }
                }
                Ok(MatchPattern::Labels(all))
            }
            Pat::Path(path) => {
                let label = match (self.program.find_variant(self.file, self.owner, &path.path), kind) {
                    (Some((index, position)), ValueKind::Enum(expected)) if index == *expected => {
                        self.needs.add(index);
                        let ItemContent::Enum { variants } = &self.program.items[index].content else {
                            return refuse(pattern.span(), "this pattern", ACCEPTED);
                        };
                        self.names.variant(index, &variants[position].0)
                    }
                    _ => return refuse(pattern.span(), "a constant as a pattern", ACCEPTED),
                };
                Ok(MatchPattern::Labels(vec![label]))
            }
            Pat::Lit(literal) if matches!(literal.lit, Lit::Int(_)) => {
                let written = Expr::Lit(syn::ExprLit { attrs: Vec::new(), lit: copy_integer(&literal.lit) });
                Ok(MatchPattern::Labels(vec![self.expression(&written, Some(kind))?.text]))
            }
            Pat::Lit(_) => refuse(pattern.span(), "this literal as a pattern", ACCEPTED),
            Pat::Ident(_) => refuse(pattern.span(), "a binding in a pattern", ACCEPTED),
            Pat::Guard(_) => refuse(pattern.span(), "a guard of a pattern", ACCEPTED),
            Pat::Range(_) => refuse(pattern.span(), "a range as a pattern", ACCEPTED),
            Pat::Slice(_) => refuse(pattern.span(), "a slice as a pattern", ACCEPTED),
            Pat::Tuple(_) | Pat::TupleStruct(_) | Pat::Struct(_) => {
                refuse(pattern.span(), "a pattern with fields", ACCEPTED)
            }
            _ => refuse(pattern.span(), "this pattern", ACCEPTED),
        }
    }

    fn check_all_variants(
        &self,
        branch: &ExprMatch,
        kind: &ValueKind,
        arms: &[(MatchPattern, &Expr)],
    ) -> Outcome<()> {
        let rest = arms.iter().position(|(pattern, _)| matches!(pattern, MatchPattern::Rest));
        match rest {
            Some(position) if position + 1 == arms.len() => return Ok(()),
            Some(position) => {
                return refuse(
                    arms[position].1.span(),
                    "an arm `_` that is not the last",
                    "`_` as the last arm",
                );
            }
            None => {}
        }
        let labels: Vec<&String> = arms
            .iter()
            .flat_map(|(pattern, _)| match pattern {
                MatchPattern::Labels(labels) => labels.iter().collect(),
                MatchPattern::Rest => Vec::new(),
            })
            .collect();
        let ValueKind::Enum(index) = kind else {
            return refuse(branch.span(), "`match` of an integer without `_`", "a last arm `_`");
        };
        let ItemContent::Enum { variants } = &self.program.items[*index].content else { return Ok(()) };
        for (name, _) in variants {
            if !labels.iter().any(|label| **label == self.names.variant(*index, name)) {
                return refuse(
                    branch.span(),
                    format!("`match` without an arm of `{name}`"),
                    "arms of all variants, or `_`",
                );
            }
        }
        Ok(())
    }
}

fn copy_integer(literal: &Lit) -> Lit {
    match literal {
        Lit::Int(digits) => Lit::Int(syn::LitInt::new(&digits.token().to_string(), digits.span())),
        other => Lit::Bool(syn::LitBool::new(true, other.span())),
    }
}

/// True if an expression has a `break` of a loop around it.
fn leaves_loop(written: &Expr) -> bool {
    match bare(written) {
        Expr::Break(_) => true,
        Expr::Block(block) => block_leaves_loop(&block.block),
        Expr::If(branch) => {
            block_leaves_loop(&branch.then_branch)
                || branch.else_branch.as_ref().is_some_and(|(_, other)| leaves_loop(other))
        }
        Expr::Match(branch) => branch.arms.iter().any(|arm| leaves_loop(&arm.body)),
        _ => false,
    }
}

fn block_leaves_loop(block: &Block) -> bool {
    block.stmts.iter().any(|statement| match statement {
        Stmt::Expr(written, _) => leaves_loop(written),
        Stmt::Local(local) => local.init.as_ref().is_some_and(|init| leaves_loop(&init.expr)),
        _ => false,
    })
}
