//! Tables of which parts go together: laws by actuators, and for each law the estimators and sensors in words.

use std::fmt::Write as _;

use crate::kinds::{ACTUATORS, ESTIMATORS, Kind, LAWS, SENSORS};

/// Accepted sensors of each estimator.
pub type Pairs = [[bool; SENSORS.len()]; ESTIMATORS.len()];

/// Accepted pairs of estimator and sensor, by law and actuator.
pub type Accepted = [[Pairs; ACTUATORS.len()]; LAWS.len()];

/// Returns how many pairs are accepted.
fn count(pairs: &Pairs) -> usize {
    pairs.iter().flatten().filter(|accepted| **accepted).count()
}

/// Returns how many combinations are accepted on a body.
pub fn total(accepted: &Accepted) -> usize {
    accepted.iter().flatten().map(count).sum()
}

/// Returns the section of a body.
pub fn section(body: &str, accepted: &Accepted) -> String {
    let [most, actuators] = [SENSORS.len() * ESTIMATORS.len(), ACTUATORS.len()];
    let all = most * actuators * LAWS.len();
    let mut section = format!("## {body}\n\n{} of {all} combinations.\n\n", total(accepted));
    // An actuator or a law that goes with nothing has no column or row.
    let used: Vec<usize> =
        (0..actuators).filter(|actuator| accepted.iter().any(|law| count(&law[*actuator]) > 0)).collect();
    let heads = used.iter().map(|actuator| ACTUATORS[*actuator].1).collect::<Vec<_>>().join(" | ");
    let rule = ":-:|".repeat(used.len());
    write!(section, "<div class=\"matrix\" markdown>\n\n| law | {heads} |\n|---|{rule}\n").expect("a text");
    let (kept, refused): (Vec<_>, Vec<_>) =
        LAWS.iter().zip(accepted).partition(|(_, row)| row.iter().any(|pairs| count(pairs) > 0));
    for (law, row) in &kept {
        let cells = used.iter().map(|actuator| match count(&row[*actuator]) {
            0 => " |".to_owned(),
            pairs => format!(" {pairs} |"),
        });
        writeln!(section, "| {} |{}", law.1, cells.collect::<String>()).expect("a text");
    }
    section += "\n</div>\n\n";
    if !refused.is_empty() {
        let laws = refused.iter().map(|(law, _)| law.1).collect::<Vec<_>>().join(", ");
        write!(section, "Not on this body: {laws}.\n\n").expect("a text");
    }
    for (law, row) in kept {
        section += &details(law, row, used.len());
    }
    section
}

/// Returns the estimators and sensors of a law as a block to open: actuators with the same ones stand together.
/// `used` is the number of actuators in the matrix.
fn details(law: &Kind, row: &[Pairs; ACTUATORS.len()], used: usize) -> String {
    let summary = code(law.1);
    let mut block = format!("<details markdown>\n<summary>{summary}: estimators and sensors</summary>\n\n");
    for (actuators, pairs) in alike(row).into_iter().filter(|(_, pairs)| count(pairs) > 0) {
        let all = actuators.len() == used;
        let actuators = if all { "every actuator".to_owned() } else { names(&ACTUATORS, &actuators) };
        write!(block, "With {actuators}:\n\n").expect("a text");
        for (estimators, sensors) in alike(pairs) {
            let read: Vec<usize> = (0..sensors.len()).filter(|sensor| sensors[*sensor]).collect();
            if !read.is_empty() {
                let all = read.len() == sensors.len();
                let read = if all { "every sensor".to_owned() } else { names(&SENSORS, &read) };
                writeln!(block, "- {}: {read}", names(&ESTIMATORS, &estimators)).expect("a text");
            }
        }
        block.push('\n');
    }
    block + "</details>\n\n"
}

/// Returns the names of kinds at these positions.
fn names(kinds: &[Kind], positions: &[usize]) -> String {
    positions.iter().map(|position| kinds[*position].1).collect::<Vec<_>>().join(", ")
}

/// Returns the different items of a list, each with the positions that have it, in the order of their first ones.
fn alike<T: PartialEq>(items: &[T]) -> Vec<(Vec<usize>, &T)> {
    let mut groups: Vec<(Vec<usize>, &T)> = Vec::new();
    for (position, item) in items.iter().enumerate() {
        match groups.iter_mut().find(|(_, known)| *known == item) {
            Some((positions, _)) => positions.push(position),
            None => groups.push((vec![position], item)),
        }
    }
    groups
}

/// Returns a text of Markdown with its code in HTML, for a summary.
fn code(text: &str) -> String {
    let parts = text.split('`').enumerate();
    parts.map(|(i, part)| if i % 2 == 1 { format!("<code>{part}</code>") } else { part.to_owned() }).collect()
}

#[test]
fn a_section_has_a_matrix_and_words() {
    let mut accepted: Accepted = [[[[false; SENSORS.len()]; ESTIMATORS.len()]; ACTUATORS.len()]; LAWS.len()];
    // A law with three actuators: alike for two, and without a filter's sensors for the third.
    for actuator in [0, 1, 4] {
        accepted[1][actuator][0] = [true; SENSORS.len()];
    }
    accepted[1][0][2][1] = true;
    accepted[1][1][2][1] = true;
    accepted[1][0][9][1] = true;
    accepted[1][1][9][1] = true;
    assert_eq!(total(&accepted), 25);
    let section = section("A body", &accepted);
    let expected = "## A body

25 of 10780 combinations.

<div class=\"matrix\" markdown>

| law | ideal | hold | wheels |
|---|:-:|:-:|:-:|
| `pd` | 9 | 9 | 7 |

</div>

Not on this body: `relay`, `pd` with an extra loop,";
    assert!(section.starts_with(expected), "{section}");
    let expected = "<details markdown>
<summary><code>pd</code>: estimators and sensors</summary>

With ideal, hold:

- no estimator: every sensor
- `truth`, `adaptive`: sampled

With wheels:

- no estimator: every sensor

</details>

";
    assert!(section.ends_with(expected), "{section}");
}
