//! Counts followed by their nouns.

use std::fmt::Display;

/// Returns a count with its noun in the singular or the plural: `1 mode`, `2 modes`.
pub fn counted(count: impl Display, thing: &str) -> String {
    let count = count.to_string();
    let plural = if count == "1" { "" } else { "s" };
    format!("{count} {thing}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_counts_have_no_plural_s() {
        assert_eq!(counted(1, "mode"), "1 mode");
        assert_eq!(counted(1.0, "run"), "1 run");
        assert_eq!(counted(0, "mode"), "0 modes");
        assert_eq!(counted(21, "mode"), "21 modes");
    }
}
