//! Titles of figures.

use super::run_events::RunEvents;

/// Abbreviations within names.
const ABBREVIATIONS: [&str; 9] = ["cmg", "ekf", "iss", "lqg", "lqr", "mc", "pd", "pid", "rw"];

/// Returns the title of a figure: the scenario, the content of the figure, and the run.
pub fn title(story: &RunEvents, subject: &str) -> String {
    let scenario = &story.scenario;
    let name = readable(&scenario.name);
    if !story.switches() {
        let run = if story.run == 0 { String::new() } else { format!(" (run {})", story.run) };
        return format!("{name}: {subject}{run}");
    }
    let (first, seed) = (story.start.1, scenario.seed);
    let last = story.steps.last().map_or(first, |step| step.gain);
    let moved = if last == first { String::new() } else { format!(" → {}", short(last)) };
    let run = if story.run == 0 { String::new() } else { format!(", run {}", story.run) };
    format!("{name}: {subject} ({} = {}{moved}, seed {seed}{run})", story.tunes(), short(first))
}

/// Returns the name of a scenario in words: `iss-manoeuvre` as "ISS manoeuvre".
pub fn readable(name: &str) -> String {
    let word = |(index, word): (usize, &str)| {
        let mut letters = word.chars();
        match letters.next() {
            _ if ABBREVIATIONS.contains(&word) => word.to_uppercase(),
            Some(first) if index == 0 => first.to_uppercase().chain(letters).collect(),
            _ => word.to_owned(),
        }
    };
    let words = name.split(['-', '_', ' ']).filter(|word| !word.is_empty());
    words.enumerate().map(word).collect::<Vec<_>>().join(" ")
}

/// Formats a gain with at most four decimals, or the leading digits of a small one.
pub fn short(gain: f64) -> String {
    if gain != 0.0 && gain.abs() < 1e-3 {
        return format!("{gain:.3e}");
    }
    format!("{gain:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words() {
        for (name, words) in [
            ("iss-manoeuvre", "ISS manoeuvre"),
            ("wheel-ekf", "Wheel EKF"),
            ("relay_fixed", "Relay fixed"),
            ("cube12u", "Cube12u"),
            ("Comsat A", "Comsat A"),
        ] {
            assert_eq!(readable(name), words);
        }
    }
}
