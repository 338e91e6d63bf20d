//! Order of definitions: module by module, as far as C's rule that a name is declared before its use allows.

use super::error::Outcome;
use super::functions::TranslatedFunction;
use super::items::{ItemContent, Program};

/// Returns the constants and functions among reachable items, those of a module together where their needs allow it.
pub(super) fn by_module(
    program: &Program<'_>,
    functions: &[Option<TranslatedFunction>],
    reachable: &[usize],
) -> Outcome<Vec<usize>> {
    let mut remaining = Vec::new();
    for index in reachable {
        match program.items[*index].content {
            ItemContent::Function { .. } => remaining.push(*index),
            ItemContent::Constant { .. } if !program.is_size(*index)? => remaining.push(*index),
            _ => {}
        }
    }
    let mut ordered = Vec::new();
    while !remaining.is_empty() {
        let ready = ready_modules(program, functions, &remaining);
        // A module that can be ended comes first.
        let Some((_, items)) = ready.iter().find(|(is_whole, _)| *is_whole).or_else(|| ready.first()) else {
            break;
        };
        remaining.retain(|index| !items.contains(index));
        ordered.extend(items);
    }
    Ok(ordered)
}

/// Returns, for each module with ready items, whether these are all its items, and the items: constants first.
fn ready_modules(
    program: &Program<'_>,
    functions: &[Option<TranslatedFunction>],
    remaining: &[usize],
) -> Vec<(bool, Vec<usize>)> {
    let mut modules: Vec<usize> = Vec::new();
    for index in remaining {
        if !modules.contains(&program.items[*index].file) {
            modules.push(program.items[*index].file);
        }
    }
    let mut ready = Vec::new();
    for module in modules {
        let (mut constants, others): (Vec<usize>, Vec<usize>) = remaining
            .iter()
            .filter(|index| program.items[**index].file == module)
            .partition(|index| functions[**index].is_none());
        constants.sort_unstable();
        let mut taken = constants;
        let mut is_whole = true;
        for index in others {
            let is_ready = functions[index].as_ref().is_none_or(|function| {
                function
                    .needs
                    .items
                    .iter()
                    .all(|needed| !remaining.contains(needed) || taken.contains(needed))
            });
            if is_ready {
                taken.push(index);
            } else {
                is_whole = false;
            }
        }
        if !taken.is_empty() {
            ready.push((is_whole, taken));
        }
    }
    ready
}
