//! Papers behind the studies.

use clap::ValueEnum;

/// A paper, or two on the same spacecraft.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
pub enum Paper {
    /// Silaev: a relay law adapted to the envelope of the elastic modes
    Relay,
    /// Rotation: finite rotation with vibration suppressed at the end
    Rotation,
    /// Wheel11 and Sukhanov: wheels, drifting frequencies and a scheduled gain
    Wheel,
    /// Timakov14: a space station damped by its own thrusters
    Station,
}

impl Paper {
    /// Returns the template of the paper's page.
    pub fn template(self) -> &'static str {
        match self {
            Self::Relay => include_str!("../templates/relay.md"),
            Self::Rotation => include_str!("../templates/rotation.md"),
            Self::Wheel => include_str!("../templates/wheel.md"),
            Self::Station => include_str!("../templates/station.md"),
        }
    }

    /// Returns the paper's name on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the parts of a text between each mark `from` and the next mark `to`.
    fn between<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
        text.split(from).skip(1).filter_map(|rest| rest.split(to).next()).collect()
    }

    /// Returns a text without the parts between two marks.
    fn without(text: &str, from: &str, to: &str) -> String {
        let mut parts = text.split(from);
        let first = parts.next().unwrap_or_default().to_owned();
        parts.fold(first, |kept, part| kept + part.split_once(to).map_or("", |(_, rest)| rest))
    }

    #[test]
    fn what_a_template_computes_it_uses() {
        for paper in Paper::value_variants() {
            let template = paper.template();
            for set in between(template, "{% set ", " %}") {
                let name = set.split(" =").next().unwrap_or_default();
                let word = |c: char| c.is_alphanumeric() || c == '_';
                let uses = template.match_indices(name).filter(|(position, _)| {
                    let (before, after) = (&template[..*position], &template[position + name.len()..]);
                    !before.ends_with(|c| word(c) || c == '"') && !after.starts_with(word)
                });
                assert!(uses.count() > 1, "{}.md: `{name}` is not used", paper.name());
            }
        }
    }

    /// Checks that columns of measured results contain only computed numbers, and integers that describe the run.
    #[test]
    fn no_measured_number_is_typed() {
        let mut measured = Vec::new();
        let mut cells = 0;
        for line in Paper::value_variants().iter().flat_map(|paper| paper.template().lines()) {
            let plain = without(&without(&without(line, "{{", "}}"), "{%", "%}"), "`", "`");
            let row: Vec<&str> = plain.split('|').collect();
            let is_measured = |cell: &&str| MEASURED.contains(&cell.trim());
            let is_header = row.iter().any(is_measured);
            if is_header || row.len() < 4 {
                measured = (0..row.len()).filter(|&column| is_measured(&row[column])).collect();
            }
            for cell in measured.iter().filter(|_| !is_header).filter_map(|&column| row.get(column)) {
                cells += 1;
                let is_small =
                    |word: &str| word.contains(|c: char| c.is_ascii_digit()) && word.contains(['.', 'e']);
                let typed: Vec<&str> = cell.split_whitespace().filter(|word| is_small(word)).collect();
                let stated = typed
                    .iter()
                    .filter(|word| !GIVEN.contains(&word.trim_end_matches([',', ';', ':', '.'])))
                    .count();
                assert_eq!(stated, 0, "{typed:?} in {cell}");
            }
        }
        assert!(cells > 30, "{cells}");
    }

    /// Headers of columns of measured results.
    const MEASURED: &[&str] =
        &["we measure", "we measure: median (5 to 95 %)", "by the design condition", "by the settling times"];

    /// Numbers within those columns that describe the run and are not results.
    const GIVEN: &[&str] = &[
        "0.003", "0.02", "0.05", "0.1", "0.12", "0.15", "0.3", "0.30", "0.31", "0.2858", "0.2978", "0.3389",
        "0.35", "0.42", "0.5", "1.1", "1.2", "0.6", "0.7", "1.5", "14.5", "1e-3", "1e-4",
    ];
}
