//! Additions to `--help`: the verbs in groups, and two examples of each verb.

mod synonyms;
mod verb_groups;

use std::fmt::Write as _;

use clap::Command;

pub use synonyms::suggest;
use verb_groups::GROUPS;

/// Adds the groups of verbs, and the examples of each, to the help of the command.
pub fn completed(command: Command) -> Command {
    let mut verbs = String::new();
    for (group, members) in GROUPS {
        let _ = write!(verbs, "\n{group}:\n");
        for (name, _) in members {
            let summary = command.find_subcommand(name).and_then(Command::get_about);
            let summary = summary.map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(verbs, "  {name:<12} {summary}");
        }
    }
    let hint = "Numbers of options are in SI units, or have their own: --window 0.01, --window \"10 ms\".\n\
                Run `flexsc VERB --help` for the options of a verb and two examples.";
    let template =
        format!("{{about}}\n\n{{usage-heading}} {{usage}}\n{verbs}\nOptions:\n{{options}}\n\n{hint}\n");
    command.help_template(template).mut_subcommands(|verb| {
        let mut all = GROUPS.iter().flat_map(|(_, members)| *members);
        let Some((_, examples)) = all.find(|(name, _)| *name == verb.get_name()) else { return verb };
        let reported = examples.map(|(line, purpose)| format!("  {line}\n      {purpose}")).join("\n");
        verb.after_help(format!("Examples:\n{reported}"))
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::CommandFactory;

    use super::*;
    use crate::Cli;

    #[test]
    fn every_verb_is_in_one_group() {
        let grouped: Vec<&str> =
            GROUPS.iter().flat_map(|(_, members)| *members).map(|(name, _)| *name).collect();
        let command = Cli::command();
        let verbs: BTreeSet<&str> = command.get_subcommands().map(Command::get_name).collect();
        assert_eq!(grouped.iter().copied().collect::<BTreeSet<_>>(), verbs);
        assert_eq!(grouped.len(), verbs.len());
    }

    #[test]
    fn synonyms_are_of_verbs_and_none_is_one() {
        let command = Cli::command();
        for (other, meant) in synonyms::SYNONYMS {
            let verb = meant.split(' ').next().unwrap_or(meant);
            assert!(command.find_subcommand(verb).is_some(), "{meant}");
            assert!(command.find_subcommand(other).is_none(), "{other}");
        }
    }

    #[test]
    fn a_line_of_the_overview_fits_a_terminal() {
        for verb in Cli::command().get_subcommands() {
            let summary = verb.get_about().map(ToString::to_string).unwrap_or_default();
            assert!(summary.chars().count() <= 65, "{}: {summary}", verb.get_name());
        }
    }

    /// The parser panics otherwise in a build with debug assertions.
    #[test]
    fn every_name_of_a_group_of_options_is_taken_once() {
        for verb in Cli::command().get_subcommands() {
            let mut names = BTreeSet::new();
            for group in verb.get_groups() {
                assert!(names.insert(group.get_id()), "{}: {}", verb.get_name(), group.get_id());
            }
        }
    }
}
