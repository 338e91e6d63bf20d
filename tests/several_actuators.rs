//! Several actuators: each executes its share of the demand about its axes, or unloads wheels, as one alone would.
//!
//! Golden numbers: tests/golden/several_oracle.py, SciPy.

use flexsc_core::control::actuator::{ActuatorKind, AssignedActuator};
use flexsc_core::control::custom::Custom;
use flexsc_core::control::one_or_many::OneOrMany;
use flexsc_core::scenario::CustomParts;
use flexsc_core::{Document, Scenario};

use crate::own_parts::servo;
use crate::study::pairs;
use crate::traces::{self, traced};
use crate::util::{Dir, SCENARIOS};

const ONE_ANGLE: &str = "duration = 100.0\nlaw = { pd = { k_p = 4.0, k_d = 30.0, period = 0.25 } }\n\
                         [body.planar]\ninertia = 100.0\nangle = 2e-3\n\
                         modes = [{ frequency = 1.3, gain = 0.2, damping = 0.02 }]\n[log]\nperiod = 0.5\n";

const THREE_AXES: &str = "duration = 40.0\nlaw = { pd = { k_p = 1.2, k_d = 9.0, period = 0.25 } }\nlog = { period = 0.25 }\n\
                          [body.spatial]\ninertia = [[30, 1, 0], [1, 40, -2], [0, -2, 35]]\nrate = [0.02, -0.03, 0.04]\n\
                          points = [{ name = \"hub\" }]\n";

const JETS: &str = "jets = { period = 2.0, minimum_on = 0.01, specific_impulse = 220.0, thrusters = [
    { name = \"e\", point = \"hub\", offset = [0.5, 0.3, 0.0], direction = [0, 1, 0], thrust = 0.5 },
    { name = \"f\", point = \"hub\", offset = [0.5, -0.3, 0.0], direction = [0, -1, 0], thrust = 0.5 },
], groups = { yaw = { plus = [\"e\"], minus = [\"f\"] } } }\n";

const WHEELS: &str = "wheels = { arrangement = \"orthogonal\", inertia = 0.02 }\n";

/// The numbers of a column of a run's full record.
fn column(scenario: &Scenario, topic: &str, name: &str) -> Vec<f64> {
    let trace = traced(scenario);
    match name.split_once('.') {
        Some((rows, name)) => traces::within(&trace, topic, rows, name).to_vec(),
        None => traces::column(&trace, topic, name).to_vec(),
    }
}

fn scenario(text: &str) -> Scenario {
    Scenario::parse("several.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

/// The largest difference, of columns with numbers of this size.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    pairs(a, b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn shares_of_linear_actuators_make_one() {
    let alone = scenario(ONE_ANGLE);
    let expected = column(&alone, "/attitude", "angle_rad");
    for several in [
        "[[actuator]]\nideal = {}\nshare = 0.4\n[[actuator]]\nwheel = { gain = 1.0 }\nshare = 0.6\n",
        "[[actuator]]\nideal = {}\nshare = 0.3\n[[actuator]]\nideal = {}\nshare = 0.7\n",
    ] {
        let found = column(&scenario(&format!("{ONE_ANGLE}{several}")), "/attitude", "angle_rad");
        let off = difference(&expected, &found);
        assert!(off < 1e-17, "{off:e}: {several}");
    }
    // About three axes: the wheels take up what the ideal one does not, and their momentum turns with the body.
    let wheels =
        format!("{THREE_AXES}[[actuator]]\n{WHEELS}share = 0.25\n[[actuator]]\nideal = {{}}\nshare = 0.75\n");
    let wheels = scenario(&wheels);
    let momenta = column(&wheels, "/wheels", "wheels.momentum_nm_s");
    let asked = column(&wheels, "/torques", "axes.feedback_nm");
    // Of the demand, held over 0.25 s, a quarter: with the initial momentum 0.02 kg m² times the rate.
    for axis in 0..3 {
        let start = 0.02 * [0.02, -0.03, 0.04][axis];
        let rows = asked.len() / 3 - 1;
        let given: f64 = (0..rows).map(|row| 0.25 * 0.25 * asked[3 * row + axis]).sum();
        let left = start - given - momenta[3 * rows + axis];
        assert!(left.abs() < 1e-13, "{axis}: {left:e}");
    }
}

/// A manoeuvre is executed by shares too, and a failure of one of them is that of its share.
#[test]
fn shares_of_a_manoeuvre() {
    let turn = "duration = 60.0\nlaw = { pd = { k_p = 4.0, k_d = 30.0, period = 0.25 } }\n[body.planar]\ninertia = 100.0\n\
                modes = [{ frequency = 1.3, gain = 0.2, damping = 0.02 }]\n\
                [manoeuvre]\nangle = 0.1\ntime = 30.0\ncommand = { minimum_energy = {} }\n[log]\nperiod = 0.5\n";
    let angle = |actuators: &str| column(&scenario(&format!("{turn}{actuators}")), "/attitude", "angle_rad");
    let whole = angle("[actuator.hold]\nperiod = 0.5\n");
    let held = "[[actuator]]\nhold = { period = 0.5 }\nshare = 0.2\n[[actuator]]\nhold = { period = 0.5 }\nshare = 0.8\n";
    assert!(difference(&whole, &angle(held)) < 1e-14);
    let ideal = angle("");
    let two = "[[actuator]]\nideal = {}\nshare = 0.2\n[[actuator]]\nideal = {}\nshare = 0.8\n";
    assert!(difference(&ideal, &angle(two)) < 1e-14);
    let failing = "share = 0.2\n[[actuator]]\nideal = {}\nshare = 0.8\n";
    let weak =
        angle(&format!("[[actuator]]\nideal = {{ faults = [{{ dead = {{ from = 5.0 }} }}] }}\n{failing}"));
    let scaled = angle("[actuator.ideal]\nfaults = [{ scaled = { from = 5.0, factor = 0.8 } }]\n");
    let off = difference(&weak, &scaled);
    assert!(off < 1e-14 && difference(&ideal, &weak) > 1e-5, "{off:e}");
}

#[test]
fn wheels_and_jets_about_axes_of_their_own_agree_with_scipy() {
    let text = format!(
        "{THREE_AXES}[[actuator]]\n{WHEELS}axes = [\"roll\", \"pitch\"]\n[[actuator]]\n{JETS}axes = [\"yaw\"]\n"
    );
    let scenario = scenario(&text);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/several.csv");
    let text = std::fs::read_to_string(path).expect("golden numbers");
    let (head, row) = text.trim().split_once('\n').expect("a row");
    let golden: Vec<f64> = row.split(',').map(|number| number.parse().expect("a number")).collect();
    let last = |topic: &str, name: &str| *column(&scenario, topic, name).last().expect("rows");
    let wheels = column(&scenario, "/wheels", "wheels.momentum_nm_s");
    let rates = column(&scenario, "/rates", "axes.rate_rad_s");
    let (wheels, rates) = (&wheels[wheels.len() - 3..], &rates[rates.len() - 3..]);
    let fuel = last("/jets", "fuel_kg") * 220.0 * 9.806_65 / 0.5;
    let q = ["q_w", "q_x", "q_y", "q_z"].map(|name| last("/pointing", name));
    let found = [&q[..], rates, &wheels[..2], &[fuel]].concat();
    for ((name, exact), found) in pairs(pairs(head.split(','), golden), found) {
        assert!((found - exact).abs() < 1e-11, "{name}: {found:e} {exact:e}");
    }
}

#[test]
fn unloading_in_a_list_is_that_within_the_wheels() {
    for (name, within, unloads) in [
        (
            "momentum-unloading",
            "jets",
            "unloads = { above = 1.5, below = 0.1, torque = 0.02 }\n[actuator.jets]\n",
        ),
        (
            "magnetic-unloading",
            "",
            "magnetorquers = { moment = 15.0 }\nunloads = { above = 0.06, below = 0.01, gain = 2e-3, period = 10.0 }\n",
        ),
    ] {
        let text = std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("a file");
        let text = text.replacen("duration = 29000.0", "duration = 6000.0", 1);
        let nested = scenario(&text);
        let (before, rest) = text.split_once("[actuator.wheels]").expect("wheels");
        let (wheels, rest) = rest.split_once("[actuator.wheels.unloading]").expect("unloading");
        let jets = rest.split_once("[actuator.wheels.unloading.jets]").map_or("", |(_, jets)| jets);
        let own = if within == "jets" { jets } else { rest.split_once("[log]").expect("log").1 };
        let own = if within == "jets" { own.to_owned() } else { format!("[log]{own}") };
        let list = format!("{before}[[actuator]]\n[actuator.wheels]{wheels}[[actuator]]\n{unloads}{own}");
        let listed = scenario(&list);
        for topic in ["/pointing", "/rates", "/wheels", "/torques"] {
            let columns = |of: &Scenario| format!("{:?}", traced(of).topic(topic));
            assert_eq!(columns(&nested), columns(&listed), "{name}: {topic}");
        }
        let keys: Vec<_> = listed.actuator.members().into_iter().map(|member| member.key).collect();
        let kind = if within == "jets" { "jets" } else { "magnetorquers" };
        assert_eq!(keys, ["actuator[0].wheels".to_owned(), format!("actuator[1].{kind}")]);
    }
}

/// A phase moves the first period, and nothing acts before it.
#[test]
fn a_phase_says_when_an_actuator_acts_first() {
    for actuator in
        ["hold = { period = 1.0, phase = 0.4 }", "thrusters = { torque = 0.02, period = 1.0, phase = 0.4 }"]
    {
        let text = ONE_ANGLE.replacen("100.0", "3.0", 1).replace("0.5\n", "0.05\n");
        let text = format!("{text}[actuator]\n{actuator}\n");
        let applied = column(&scenario(&text), "/torque", "applied_nm");
        let first = applied.iter().position(|torque| *torque != 0.0).expect("a torque");
        let begins = if actuator.starts_with("hold") { 8 } else { 13 };
        assert!((begins..begins + 3).contains(&first), "{actuator}: {first}");
    }
}

#[test]
fn an_actuator_from_outside_has_a_place_in_a_list() {
    let text = format!(
        "{ONE_ANGLE}[[actuator]]\nideal = {{}}\nshare = 0.5\n[[actuator]]\nideal = {{}}\nshare = 0.5\n"
    );
    let plain = scenario(&text);
    let own = |place: usize| CustomParts {
        actuators: vec![(place, Custom::new(servo(1e9, 1e-300)))],
        ..CustomParts::default()
    };
    let mixed = plain.with_custom_parts(own(1)).expect("it fits");
    assert!(matches!(mixed.actuator[1].kind, ActuatorKind::Own(_)) && mixed.actuator[1].share.is_some());
    let expected = column(&plain, "/attitude", "angle_rad");
    let off = difference(&expected, &column(&mixed, "/attitude", "angle_rad"));
    assert!(off < 1e-15, "{off:e}");
    // It stays where other keys change, and stands beside the text.
    let document = Document::from_table("own.toml", mixed.table_without_custom_parts());
    assert_eq!(Scenario::from_document_with(&document, &mixed.custom_parts()).expect("a scenario"), mixed);
    let fault = plain.with_custom_parts(own(2)).expect_err("no place");
    assert!(fault.to_string().contains("actuator[2]: is not there: the scenario has 2 actuators"), "{fault}");
    let alone = plain.with(|scenario| {
        scenario.actuator =
            OneOrMany::one(AssignedActuator::from(ActuatorKind::Own(Custom::new(servo(1e9, 1e-300)))));
    });
    assert_eq!(alone.expect("it fits").custom_parts().actuators.len(), 1);
}

/// Actuators of a body with one angle or three axes, and words of the one error.
#[rustfmt::skip] // One case a line.
const BAD: &[(&str, &str, &[&str])] = &[
    (ONE_ANGLE, "[[actuator]]\nideal = {}\nshare = 0.4\n[[actuator]]\nwheel = { gain = 1.0 }\nshare = 0.5\n", &["`actuator[1].share` must sum to 1 with the others, got 0.9 (0.4 of `actuator[0].ideal`, 0.5 of `actuator[1].wheel`)"]),
    (ONE_ANGLE, "[[actuator]]\nideal = {}\n[[actuator]]\nhold = { period = 1.0 }\n", &["`actuator[1].share` must sum to 1 with the others, got 2"]),
    (ONE_ANGLE, "[[actuator]]\nideal = {}\nshare = 1.5\n", &["`actuator[0].share`", "must be a number above 0 and at most 1, got 1.5"]),
    (ONE_ANGLE, "[[actuator]]\nideal = {}\naxes = [\"yaw\"]\n", &["`actuator[0].axes` names axes of three, and the body has one angle"]),
    (ONE_ANGLE, "[[actuator]]\nideal = {}\nhold = { period = 1.0 }\n", &["`actuator[0]`: exactly one kind is accepted here, and more than one is given: `ideal`, `hold`; several are a list, [[actuator]]"]),
    (ONE_ANGLE, "[[actuator]]\nshare = 1.0\n", &["`actuator[0]`: exactly one kind is needed here, and none is given: `ideal`, `hold`"]),
    (ONE_ANGLE, "[[actuator]]\nideal = {}\nshar = 1.0\n", &["unknown key `shar`", "`share`"]),
    (ONE_ANGLE, "[[actuator]]\nwheel = { gain = 1.0, rotor = { inertia = 0.1 } }\nshare = 0.5\n[[actuator]]\nideal = {}\nshare = 0.5\n", &["`actuator[0].wheel.rotor` gets its speed from the rate of the body"]),
    (ONE_ANGLE, "[[actuator]]\nwheel = { gain = 1.0 }\nshare = 0.5\n[[actuator]]\nwheel = { gain = 2.0 }\nshare = 0.5\n", &["`actuator[1].wheel` are there already, as `actuator[0].wheel`"]),
    (ONE_ANGLE, "[[actuator]]\nhold = { period = 1.0, phase = -1.0 }\n", &["`actuator[0].hold.phase`", "must be a time of 0 to 1e13 s, got -1"]),
    (THREE_AXES, "[[actuator]]\nwheels = { arrangement = \"orthogonal\", inertia = 0.02 }\naxes = [\"roll\", \"pitch\"]\n", &["`actuator` has none that acts about yaw"]),
    (THREE_AXES, "[[actuator]]\nideal = {}\naxes = []\n", &["`actuator[0].axes` must name an axis"]),
    (THREE_AXES, "[[actuator]]\nideal = {}\naxes = [\"yaw\", \"yaw\"]\n", &["`actuator[0].axes` names `yaw` twice"]),
    (THREE_AXES, "[[actuator]]\nideal = {}\naxes = [\"gier\"]\n", &["`actuator[0].axes[0]`", "`gier`", "`yaw`"]),
    (THREE_AXES, "[[actuator]]\nideal = {}\nshare = 0.7\n[[actuator]]\nwheels = { arrangement = \"orthogonal\", inertia = 0.02 }\nshare = 0.4\n", &["`actuator[1].share` must sum to 1 with the others about roll, got 1.1"]),
    (THREE_AXES, "[[actuator]]\nwheels = { arrangement = \"orthogonal\", inertia = 0.02 }\nshare = 0.5\n[[actuator]]\nwheels = { arrangement = \"pyramid\", inertia = 0.02 }\nshare = 0.5\n", &["`actuator[1].wheels` are there already, as `actuator[0].wheels`: write all wheels in one `wheels`, by their `axes`"]),
    (THREE_AXES, "[[actuator]]\nideal = {}\n[[actuator]]\nhold = { period = 1.0 }\nunloads = { above = 1.0, below = 0.1, torque = 1.0 }\n", &["`actuator[1].unloads` is for `jets` or `magnetorquers`, which can unload `wheels` or `control_moment_gyros`, got `hold`"]),
    (THREE_AXES, "[[actuator]]\nideal = {}\n[[actuator]]\njets = { period = 1.0, specific_impulse = 200.0, thrusters = [] }\nunloads = { above = 1.0, below = 0.1, torque = 1.0 }\n", &["`actuator[1].unloads` needs `wheels` or `control_moment_gyros` in the list"]),
    (THREE_AXES, "[[actuator]]\nwheels = { arrangement = \"orthogonal\", inertia = 0.02 }\n[[actuator]]\njets = { period = 1.0, specific_impulse = 200.0, thrusters = [] }\nunloads = { above = 1.0, below = 0.1 }\n", &["`actuator[1].unloads.torque` must be given with `jets`"]),
    (THREE_AXES, "[[actuator]]\nwheels = { arrangement = \"orthogonal\", inertia = 0.02 }\n[[actuator]]\njets = { specific_impulse = 200.0, thrusters = [] }\nunloads = { above = 1.0, below = 0.1, torque = 1.0 }\n", &["`actuator[1].jets.period` must be given"]),
    (THREE_AXES, "[[actuator]]\nwheels = { arrangement = \"orthogonal\", inertia = 0.02 }\n[[actuator]]\nshare = 0.5\njets = { period = 1.0, specific_impulse = 200.0, thrusters = [] }\nunloads = { above = 1.0, below = 0.1, torque = 1.0 }\n", &["`actuator[1].share` must be left out with `unloads`"]),
    (THREE_AXES, "[[actuator]]\nwheels = { arrangement = \"orthogonal\", inertia = 0.02 }\naxes = [\"roll\", \"pitch\"]\n[[actuator]]\naxes = [\"yaw\"]\njets = { period = 1.0, specific_impulse = 200.0, thrusters = [], groups = {} }\n", &["`actuator[1].jets.groups` must have `yaw`, about which the jets act"]),
    (THREE_AXES, "[[actuator]]\nideal = { faults = [{ dead = { from = 1.0, wheel = 1 } }] }\naxes = [\"yaw\"]\n[[actuator]]\naxes = [\"roll\", \"pitch\"]\nhold = { period = 1.0 }\n", &["`actuator[0].ideal.faults[0].dead.wheel` applies only to"]),
];

#[test]
fn actuators_that_do_not_fit_are_refused() {
    let dir = Dir::new();
    for (body, actuators, words) in BAD {
        dir.write("bad.toml", format!("{body}{actuators}"));
        dir.run("check bad.toml").exits(2).says(words);
    }
}
