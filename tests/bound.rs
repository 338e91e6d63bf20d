//! Guaranteed ranges against sums over steps of SciPy's exponentials and against closed forms, and the verb `bound`.

use flexsc_core::Scenario;
use flexsc_core::analysis::bound::{OutputBound, Verdict};
use flexsc_core::formats::document::Document;
use toml::Value;

use crate::util::{Dir, SCENARIOS};

fn bounds(text: &str) -> Vec<OutputBound> {
    let scenario = Scenario::parse("bound.toml", text).expect("valid");
    OutputBound::from_scenario(&scenario).expect("a modal form")
}

/// Asserts that two numbers agree to a fraction of the second.
#[track_caller]
fn agree(found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{found:.12e}, expected {expected:.12e}");
}

/// An undamped mode of 2 rad/s with gain 0.5 on a body of 4 kg m², with a claim.
fn one_mode(claim: &str) -> String {
    format!(
        "duration = 30.0\n[law.open]\n[body.planar]\ninertia = 4.0\nmodes = [{{ frequency = 2.0, gain = 0.5 }}]\n\
         [[bound]]\n{claim}\n"
    )
}

/// Shipped example with a claim's keys changed and its modes' frequencies and damping ratios multiplied.
fn example(claim: usize, changes: &[(&str, Value)], factors: [f64; 2]) -> OutputBound {
    let path = format!("{SCENARIOS}/bounded-jitter.toml");
    let mut document = Document::load(path.as_ref()).expect("shipped");
    for (key, value) in changes {
        document.set(&format!("bound[{claim}].{key}"), value.clone()).expect("a key");
    }
    for mode in 0..3 {
        for (key, factor) in ["frequency", "damping"].into_iter().zip(factors) {
            let key = format!("body.spatial.modes[{mode}].{key}");
            let modes = document.table()["body"]["spatial"]["modes"].as_array().expect("modes");
            let name = key.rsplit('.').next().expect("a key");
            let value = modes[mode][name].as_float().expect("a number");
            document.set(&key, Value::Float(value * factor)).expect("a key");
        }
    }
    let scenario = Scenario::from_document(&document).expect("valid");
    OutputBound::from_scenario(&scenario).expect("a modal form").swap_remove(claim)
}

/// Limits far below and at a number.
fn up_to(high: f64) -> Value {
    Value::Array(vec![Value::Float(-1.0), Value::Float(high)])
}

/// `tests/golden/bound_reference.py`.
#[test]
fn ranges_are_those_of_dense_sums() {
    let golden = include_str!("golden/bound.csv").lines().skip(1);
    let rows: Vec<Vec<f64>> =
        golden.map(|line| line.split(',').map(|n| n.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), 4);
    for row in &rows {
        let [claim, frequency, damping, low, high, limit, crossing] = row[..] else { panic!("{row:?}") };
        let nominal =
            [("limits", up_to(limit)), ("frequency_error", 0.0.into()), ("damping_error", 0.0.into())];
        let found = example(claim as usize, &nominal, [frequency, damping]);
        agree(found.range[0], low, 2e-7);
        agree(found.range[1], high, 2e-7);
        // Without boxes the range is attained.
        for end in 0..2 {
            agree(found.attained[end], found.range[end], 1e-9);
        }
        assert!(found.range[0] <= found.attained[0] && found.attained[1] <= found.range[1]);
        assert_eq!(found.verdict, Verdict::Violated);
        let violated = found.violated_at_s.expect("a crossing");
        agree(violated, crossing, 2e-6);
        agree(found.safe_until_s.expect("a time"), violated, 1e-8);
        let witness = found.witness.expect("a witness");
        agree(witness.value, high, 2e-7);
        agree(witness.simulated.expect("a run"), witness.value, 1e-9);
        assert!(found.rows.iter().all(|row| row.low >= found.range[0] && row.high <= found.range[1]));
    }
}

#[test]
fn a_box_contains_its_corners_and_attains_the_worst_of_them() {
    let golden: Vec<f64> = include_str!("golden/bound.csv")
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(4).expect("a column").parse().expect("a number"))
        .collect();
    let found = example(1, &[], [1.0, 1.0]);
    assert_eq!(found.verdict, Verdict::Proved);
    for corner in &golden[1..] {
        assert!(found.range[1] > *corner && found.attained[1] >= *corner * (1.0 - 2e-7), "{found:?}");
    }
    // Between what is attained and what is guaranteed, neither verdict is known.
    let between = 0.5 * (found.attained[1] + found.range[1]);
    let undecided = example(1, &[("limits", up_to(between))], [1.0, 1.0]);
    assert_eq!(undecided.verdict, Verdict::Undecided);
    agree(undecided.gap.expect("a gap"), found.range[1] - between, 1e-6);
    assert!(undecided.witness.is_none() && undecided.violated_at_s.is_none());
    let violated = example(1, &[("limits", up_to(0.99 * found.attained[1]))], [1.0, 1.0]);
    let witness = violated.witness.expect("a witness");
    assert!((witness.frequency_factor, witness.damping_factor) != (1.0, 1.0));
    agree(witness.simulated.expect("a run"), witness.value, 1e-9);
}

/// An input within +-a that is in resonance adds 2 a b/w² in each half-turn, b its acceleration of the mode.
#[test]
fn a_varying_input_in_resonance_reaches_its_closed_form() {
    let half_turns = 12.0;
    let until = half_turns * std::f64::consts::PI / 2.0;
    let text = one_mode(&format!(
        "output = \"mode0_displacement\"\nuntil = {until}\nvarying_inputs = {{ torque = [-0.3, 0.3] }}"
    ));
    let found = &bounds(&text)[0];
    // The gain of a mode is its acceleration per rigid acceleration.
    let expected = 2.0 * half_turns * 0.3 * (0.5 / 4.0) / 4.0;
    agree(found.range[1], expected, 1e-9);
    agree(-found.range[0], expected, 1e-9);
    assert!(found.range[1] >= expected, "{:e} {expected:e}", found.range[1]);
    assert_eq!(found.verdict, Verdict::Unlimited);
}

/// A constant input a displaces by a b (1 - cos w t)/w²; a state by its circle.
#[test]
fn constant_inputs_and_states_reach_their_closed_forms() {
    let text = one_mode(
        "output = \"mode0_displacement\"\nstart = { rates = [-0.02, 0.01] }\nconstant_inputs = { torque = [0.1, 0.3] }",
    );
    let found = &bounds(&text)[0];
    // The largest of 0.009375 (1 - cos p) + 0.005 |sin p| and of its parts with the other signs, over phases p.
    let (step, swing): (f64, f64) = (0.3 * (0.5 / 4.0) / 4.0, 0.02 / 2.0);
    let high = step + step.hypot(swing);
    agree(found.range[1], high, 1e-9);
    let low = 0.1 * (0.5 / 4.0) / 4.0;
    agree(found.range[0], low - f64::hypot(low, swing), 1e-9);
    assert!(found.range[1] >= high);
    agree(found.attained[1], high, 1e-9);
}

#[test]
fn a_rigid_body_is_a_double_integrator() {
    let text = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 4.0\n[[bound]]\noutput = \"angle\"\n\
                limits = [-1.0, 1.0]\nstart = { rigid_rate = [-0.01, 0.02] }\nvarying_inputs = { torque = [-0.1, 0.1] }";
    let found = &bounds(text)[0];
    agree(found.range[1], 0.02 * 10.0 + 0.5 * 0.025 * 100.0, 1e-9);
    agree(found.range[0], -0.01 * 10.0 - 0.5 * 0.025 * 100.0, 1e-9);
    // 0.02 t + 0.0125 t² = 1.
    let crossing = (-0.02 + f64::sqrt(0.0004 + 0.05)) / 0.025;
    agree(found.violated_at_s.expect("a crossing"), crossing, 1e-8);
    let witness = found.witness.as_ref().expect("a witness");
    assert_eq!((witness.time_s, witness.start.as_slice()), (10.0, &[0.0, 0.02][..]));
    agree(witness.simulated.expect("a run"), 1.45, 1e-12);
}

/// The rigid motion of an output is left out.
#[test]
fn an_elastic_output_has_no_rigid_motion() {
    let claim = "output = \"rate\"\nelastic = true\nconstant_inputs = { torque = [0.3, 0.3] }";
    let found = &bounds(&one_mode(claim))[0];
    agree(found.range[1], 0.3 * (0.5 / 4.0) / 2.0, 1e-9);
}

/// The free mode of a spacecraft of one appendage, and its run, which is linear to the second order.
#[test]
fn a_spacecraft_has_free_modes() {
    let text = "duration = 20.0\n[law.open]\n[spacecraft]\nmass = 300.0\n\
                inertia = [[120, 0, 0], [0, 100, 0], [0, 0, 90]]\n[[appendage]]\nname = \"boom\"\nmass = 10.0\n\
                centre = [1.5, 0.0, 0.0]\ninertia = [[0.1, 0, 0], [0, 7.5, 0], [0, 0, 7.5]]\nat = [0.5, 0.0, 0.0]\n\
                modes = [{ frequency = 1.5, damping = 0.005, translation = [0, 0, 2.476], rotation = [0, -5.396, 0] }]\n\
                [[bound]]\noutput = \"pitch\"\nlimits = [-1e-6, 1e-6]\nstart = { displacements = [-1e-3, 1e-3] }\n\
                varying_inputs = { torque_pitch = [-1e-3, 1e-3] }";
    let found = &bounds(text)[0];
    assert_eq!(found.verdict, Verdict::Violated);
    let witness = found.witness.as_ref().expect("a witness");
    agree(witness.simulated.expect("a run"), witness.value, 1e-4);
    assert_eq!(witness.states.len(), witness.start.len());
    // No key gives a free mode at the start.
    let scenario = Scenario::parse("bound.toml", text).expect("valid");
    assert_eq!(found.witness_text(&scenario), None);
    // Damping couples two free modes: runs leave it out by default, and so does the bound. A run that has it has none.
    let second = "{ frequency = 4.0, damping = 0.01, translation = [0, 0, 0.2], rotation = [0, -0.1, 0] }]";
    let two =
        text.replace("rotation = [0, -5.396, 0] }]", &format!("rotation = [0, -5.396, 0] }}, {second}"));
    let found = &bounds(&two)[0];
    let witness = found.witness.as_ref().expect("a witness");
    agree(witness.simulated.expect("a run"), witness.value, 1e-4);
    let whole =
        Scenario::parse("whole.toml", &two.replace("mass = 300.0", "mass = 300.0\nwhole_damping = true"));
    let fault = OutputBound::from_scenario(&whole.expect("valid")).expect_err("coupled").to_string();
    assert!(fault.contains("modes that do not act on each other"), "{fault}");
}

#[test]
fn the_verb_prints_verdicts_and_writes_witnesses() {
    let dir = Dir::with(&["bounded-jitter"]);
    dir.run("bound bounded-jitter.toml").exits(0).says(&[
        "2 claims",
        "roll, elastic within -1.65 to 1.65 arcsec",
        "proved",
        "guaranteed",
    ]);
    let narrow = "bound bounded-jitter.toml --set bound[0].limits=[-5e-6,5e-6]";
    dir.run(&format!("{narrow} -o witness.toml")).exits(3).says(&[
        "violated",
        "no limit is passed before",
        "witness",
        "1 of 2 claims not proved",
    ]);
    let json = dir.run(&format!("{narrow} --json")).exits(3).json();
    let bound = &json["bounds"][0];
    assert_eq!(bound["verdict"], "violated");
    assert!(bound["witness"]["inputs"][0]["times_s"].as_array().expect("times").len() > 5);
    dir.run("simulate witness.toml").exits(0);
    dir.run("bound bounded-jitter.toml -o range.csv").exits(0);
    let rows = crate::util::table(&dir, "range.csv");
    assert!(rows.len() > 100 && rows.iter().any(|row| row["claim"] == "1e0"), "{:?}", rows.first());
    dir.run("bound bounded-jitter.toml -o figures --format svg").exits(0);
    assert!(dir.text("figures/bounded-jitter-bound.svg").contains("guaranteed range"));
    dir.run("bound bounded-jitter.toml -o other.toml").exits(2).says(&["no claim is violated"]);
    assert!(!dir.has("other.toml"));
}

#[test]
fn what_cannot_be_bounded_is_refused() {
    let dir = Dir::with(&["bounded-jitter", "relay-fixed", "wheel-scheduled-gain"]);
    let set = |set: &str, words: &[&str]| {
        dir.run(&format!("bound bounded-jitter.toml --set {set}")).exits(2).says(words);
    };
    dir.run("bound relay-fixed.toml").exits(2).says(&["bound", "is missing"]);
    set("bound[0].output=\"rolls\"", &["bound[0].output", "`roll_rate`", "got `rolls`"]);
    set("bound[0].start.mode7_rate=[0,1]", &["bound[0].start.mode7_rate", "must be one of"]);
    set("bound[0].varying_inputs.torque=[0,1]", &["bound[0].varying_inputs.torque", "`torque_roll`"]);
    set("bound[0].limits=[1,-1]", &["bound[0].limits", "[low, high] in this order"]);
    set("bound[1].start.rates=[1,-1]", &["bound[1].start.rates", "[low, high] in this order"]);
    set("bound[1].frequency_error=1.0", &["bound[1].frequency_error", "below 1"]);
    set("body.spatial.modes[0].damping=0.9", &["bound[1].damping_error", "damping ratio below 1"]);
    set("bound[0].until=1e12", &["bound[0].until", "must be shorter"]);
    set("bound[0].until=0", &["bound[0].until", "positive"]);
    let claim = "output = \"rate\"";
    dir.write(
        "coupled.toml",
        one_mode(claim).replace("gain = 0.5 }]", "gain = 0.5 }]\ndamping_matrix = [[0.01]]"),
    );
    dir.run("bound coupled.toml").exits(0);
    let two = "modes = [{ frequency = 2.0, gain = 0.5 }, { frequency = 3.0, gain = 0.2 }]\ndamping_matrix = [[0, 0.01], [0.01, 0]]";
    dir.write("coupled.toml", one_mode(claim).replace("modes = [{ frequency = 2.0, gain = 0.5 }]", two));
    dir.run("bound coupled.toml").exits(2).says(&["do not act on each other", "`mode0_rate`"]);
}

/// After 2000 s the response has decayed below its rounding: its signs are not searched for, and the range is that of the
/// integral of |h| over all time, of a damped sine (1/w²) coth(pi zeta/(2 sqrt(1 - zeta²))).
#[test]
fn a_long_time_takes_no_longer_than_a_short_one() {
    let (frequency, damping) = (2.0_f64, 0.02_f64);
    let text = format!(
        "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 4.0\nmodes = [{{ frequency = {frequency}, gain = 0.5, damping = \
         {damping} }}]\n[[bound]]\noutput = \"angle\"\nelastic = true\nuntil = 2000.0\nvarying_inputs = {{ torque = [-1e-3, 1e-3] }}\n"
    );
    let found = &bounds(&text)[0];
    let tangent = damping / f64::sqrt(1.0 - damping * damping);
    let over_all_time = 1.0 / (0.5 * std::f64::consts::PI * tangent).tanh() / (frequency * frequency);
    agree(found.range[1], 1e-3 * (0.5 / 4.0) * over_all_time, 1e-6);
    agree(found.range[0], -found.range[1], 1e-12);
}
