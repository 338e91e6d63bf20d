//! Three-axis turns that are shaped for modes: residual of these after the turn.

use flexsc_core::record::{Column, Detail, Trace};
use flexsc_core::{Document, Scenario, Simulation};

use crate::util::SCENARIOS;

/// Returns the largest energy of a mode over the last part of a run (J).
fn left(changes: &[(&str, &str)], mode: usize) -> Result<f64, String> {
    let text = std::fs::read_to_string(format!("{SCENARIOS}/shaped-slew.toml")).expect("there");
    let text = changes.iter().filter(|(key, _)| key.is_empty()).fold(text, |text, (_, lines)| {
        let kept =
            text.lines().filter(|line| !line.starts_with("shaper") && !line.starts_with("acceleration"));
        let kept = kept.map(|line| if line.starts_with("rate_limit") { *lines } else { line });
        kept.collect::<Vec<_>>().join("\n")
    });
    let mut document = Document::parse("shaped-slew.toml", text).expect("a document");
    for (key, value) in changes.iter().filter(|(key, _)| !key.is_empty()) {
        document.set_text(key, value).expect("a key");
    }
    let scenario = Scenario::from_document(&document).map_err(|error| error.to_string())?;
    let mut trace = Trace::new(Detail::Full);
    Simulation::new(&scenario, 0).run(&mut trace).expect("a run");
    let Some(Column::Rows(counts, columns)) = trace.topic("/vibrations").and_then(|topic| topic.get("modes"))
    else {
        panic!("no modes")
    };
    let energies = columns.numbers("energy_j").expect("numbers");
    let modes = counts[0] as usize;
    // From 170 s on all turns are over.
    Ok(energies.iter().skip(mode).step_by(modes).skip(680).fold(0.0, |most: f64, energy| most.max(*energy)))
}

#[test]
fn a_shaped_turn_leaves_its_mode_at_rest() {
    let plain = left(&[("", "acceleration = 4e-4\nrate_limit = 8e-3")], 1).expect("a run");
    let shaped = left(&[], 1).expect("a run");
    let robust = left(&[("target[0].shaper", "{ zvdd = { modes = [1] } }")], 1).expect("a run");
    // The loop damps the mode more than it is damped: a zero of the command three times over does not mind.
    let planned = "command = { cosine = { zeros = [{ mode = 1, times = 3 }] } }\nduration = 165.0";
    let planned = left(&[("", planned)], 1).expect("a run");
    // The torque is held over each sample, the reference is not.
    assert!(plain > 1e-8, "{plain:e}");
    assert!(
        shaped < 1e-3 * plain && robust < 1e-3 * plain && planned < 1e-3 * plain,
        "{plain:e} {shaped:e} {robust:e} {planned:e}"
    );
}

#[test]
fn turns_that_cannot_be_shaped_are_refused() {
    let refused = |changes: &[(&str, &str)]| left(changes, 1).expect_err("refused");
    let beyond = refused(&[("target[0].shaper", "{ zvd = { modes = [2] } }")]);
    assert!(beyond.contains("`target[0].shaper.zvd.modes[0]`"), "{beyond}");
    let short = refused(&[("", "command = { minimum_peak = { suppress = 2 } }\nduration = 1.0")]);
    assert!(short.contains("`target[0].duration` must be longer"), "{short}");
    let fast = refused(&[("", "command = { bang_bang = {} }\nduration = 3.0")]);
    assert!(fast.contains("`target[0].duration` must be below"), "{fast}");
    let both = refused(&[("", "command = { bang_bang = {} }\nduration = 100.0\nrate_limit = 0.01")]);
    assert!(both.contains("`target[0].rate_limit` must be left out with a `command`"), "{both}");
}
