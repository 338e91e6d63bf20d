//! Reachable items, in the order in which C declares them, and the refusal of recursion.

use super::error::{Outcome, refuse};
use super::functions::{NeededParts, TranslatedFunction};
use super::helpers::CHelper;
use super::items::{ItemContent, Program};

/// Items and helpers that roots need, each after those it needs itself.
#[derive(Debug, Default)]
pub(super) struct ReachableParts {
    pub items: Vec<usize>,
    pub helpers: Vec<CHelper>,
}

/// State of an item during the search.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Visit {
    New,
    Open,
    Done,
}

/// Search for the parts that roots need.
struct ReachSearch<'p> {
    program: &'p Program<'p>,
    functions: &'p [Option<TranslatedFunction>],
    visits: Vec<Visit>,
    found: ReachableParts,
}

/// Returns what some roots need.
pub(super) fn reach(
    program: &Program<'_>,
    functions: &[Option<TranslatedFunction>],
    roots: &[usize],
) -> Outcome<ReachableParts> {
    let visits = vec![Visit::New; program.items.len()];
    let mut search = ReachSearch { program, functions, visits, found: ReachableParts::default() };
    for root in roots {
        search.visit(*root)?;
    }
    search.found.helpers.sort_unstable();
    Ok(search.found)
}

/// Refuses functions that call themselves: their stack has no bound.
pub(super) fn refuse_recursion(
    program: &Program<'_>,
    functions: &[Option<TranslatedFunction>],
) -> Outcome<()> {
    let all: Vec<usize> = (0..program.items.len()).collect();
    reach(program, functions, &all).map(|_| ())
}

impl ReachSearch<'_> {
    fn visit(&mut self, index: usize) -> Outcome<()> {
        match self.visits[index] {
            Visit::Done => return Ok(()),
            Visit::Open => {
                let item = &self.program.items[index];
                return refuse(
                    item.span,
                    format!("`{}`, which needs itself", item.name),
                    "no recursion: the stack is bounded",
                )
                .map_err(|error| self.program.placed(error, item.file));
            }
            Visit::New => self.visits[index] = Visit::Open,
        }
        for needed in self.needs(index)? {
            self.visit(needed)?;
        }
        if let Some(function) = &self.functions[index] {
            for helper in &function.needs.helpers {
                self.add_helper(*helper);
            }
        }
        self.visits[index] = Visit::Done;
        self.found.items.push(index);
        Ok(())
    }

    fn add_helper(&mut self, helper: CHelper) {
        for needed in helper.needs() {
            self.add_helper(*needed);
        }
        if !self.found.helpers.contains(&helper) {
            self.found.helpers.push(helper);
        }
    }

    /// Returns the items that an item needs: constants do not need others, as their values are computed.
    fn needs(&self, index: usize) -> Outcome<Vec<usize>> {
        if let Some(function) = &self.functions[index] {
            let (mut constants, others): (Vec<usize>, Vec<usize>) =
                function.needs.items.iter().partition(|needed| {
                    matches!(self.program.items[**needed].content, ItemContent::Constant { .. })
                });
            constants.sort_unstable();
            constants.extend(others);
            return Ok(constants);
        }
        let mut needs = NeededParts::default();
        match &self.program.items[index].content {
            ItemContent::Struct { fields } => {
                for field in fields {
                    if let Some(kind) = self.program.field_kind(index, &field.name)? {
                        needs.add_kind(&kind);
                    }
                }
            }
            ItemContent::Constant { .. } => {
                if let Some(kind) = self.program.constant_kind(index)? {
                    needs.add_kind(&kind);
                }
            }
            _ => {}
        }
        Ok(needs.items)
    }
}
