//! Bad scenarios of spatial bodies: each is refused with one error that names the key, what was found, what is
//! accepted.

use crate::spatial::FREE;
use crate::util::Dir;

/// Case: text that is replaced, its replacement, the line of the file that the error points at, and words of the error.
type Case = (&'static str, &'static str, usize, &'static [&'static str]);

#[rustfmt::skip] // One case a line.
const CASES: &[Case] = &[
    ("0.4, 3.0, 0.1", "0.5, 3.0, 0.1", 3, &["`body.spatial.inertia` must be symmetric", "got 0.5 and 0.4"]),
    ("3.0, 0.1]", "-3.0, 0.1]", 3, &["`body.spatial.inertia` must be positive definite"]),
    ("[[5.0, 0.4, -0.2], ", "[", 3, &["`body.spatial.inertia`", "expected an array of length 3"]),
    ("5.0, 0.4, -0.2]", "5.0, 0.4]", 3, &["`body.spatial.inertia", "expected an array of length 3"]),
    ("rate = [0.3, -0.2, 0.5]", "rate = [0.3, nan, 0.5]", 4, &["`body.spatial.rate[1]`", "must be a finite number, got NaN"]),
    ("rate = [0.3, -0.2, 0.5]", "attitude = [2, 0, 0, 0]", 4, &["`body.spatial.attitude`", "must be a unit quaternion [w, x, y, z]", "of length 2"]),
    ("rate = [0.3, -0.2, 0.5]", "attitude = [0, 0, 0, 0]", 4, &["`body.spatial.attitude`", "of length 0"]),
    ("rate = [0.3, -0.2, 0.5]", "rates = [0.3, -0.2, 0.5]", 4, &["unknown key `rates`", "`rate`"]),
    ("rate = [0.3, -0.2, 0.5]", "disturbance = { period = 0 }", 4, &["`body.spatial.disturbance.period`", "must be a positive number, got 0"]),
    ("{ name = \"hub\" }]", "{ name = \"hub\" }, { name = \"hub\" }]", 5, &["`body.spatial.points[1].name`", "got `hub` again"]),
    ("{ name = \"hub\" }]", "{ name = \"hub\" }, { name = \"tip\" }]", 9, &["`body.spatial.modes[0].shapes` must have a shape at each point, and `tip` is missing"]),
    ("frequency = 1.2566370614359172", "frequency = 0", 7, &["`body.spatial.modes[0].frequency`", "must be a natural frequency of 1e-4 to 1e4 rad/s, got 0"]),
    ("damping = 0.005", "damping = -1", 8, &["`body.spatial.modes[0].damping`", "must be a number of 0 or more, got -1"]),
    ("shapes.hub", "shapes.hab", 9, &["`body.spatial.modes[0].shapes.hab` must be one of the points, `hub`"]),
    ("translation = [1.0, 0.0, 0.0]", "translation = [1.0, 0.0]", 9, &["`body.spatial.modes[0].shapes.hub.translation`", "expected an array of length 3"]),
    ("[sensor.gyro]\npoint = \"hub\"", "[sensor.gyro]\npoint = \"hab\"", 11, &["`sensor.gyro.point` must be one of the body's points, `hub`, got `hab`"]),
    ("[sensor.gyro]\npoint = \"hub\"", "[sensor.gyro]\npoint = \"hub\"\nnoise = [0, -1, 0]", 12, &["`sensor.gyro.noise`", "must be a number of 0 or more, got -1"]),
    ("[sensor.gyro]\npoint = \"hub\"", "[sensor.sampled]\nperiod = 0.2\npoint = \"hab\"", 12, &["`sensor.sampled.point` must be one of the body's points, `hub`, got `hab`"]),
    ("[sensor.gyro]\npoint = \"hub\"", "[sensor.star_tracker]\nperiod = 1.0\nexposure = 1.5", 12, &["`sensor.star_tracker.exposure` must be at most the `period` of 1 s, got 1.5 s"]),
    ("[sensor.gyro]\npoint = \"hub\"", "[sensor.star_tracker]\nperiod = 1.0\nexposure = 0.5\nlatency = 0.2", 12, &["`sensor.star_tracker.exposure` must be at most twice the `latency` of 0.2 s, which counts from its middle, got 0.5 s"]),
    ("[sensor.gyro]\npoint = \"hub\"", "[sensor.star_tracker]\nperiod = 1.0\nexposure = -0.5", 12, &["`sensor.star_tracker.exposure`", "must be a time of 0 to 1e13 s, got -0.5"]),
    ("period = 0.2", "period = 0", 13, &["`law.phase_plane.period`", "must be a time of"]),
    ("switch_off = 1.0", "switch_off = 100.0", 17, &["`law.phase_plane.switch_off` must be below `switch_on`, 100, got 100"]),
    ("switch_off = 1.0", "switch_off = 1.0\nbraking = 1.0", 18, &["`law.phase_plane.braking`", "must be a number between 0 and 1, got 1"]),
    ("switch_off = 1.0", "switch_off = 1.0\ntargets = [{ from = 5 }, { from = 5 }]", 18, &["`law.phase_plane.targets[1].from` must be later than the one before, got 5"]),
    ("switch_off = 1.0", "switch_off = 1.0\n[estimator.rigid_rate]\ncorrection = 1.0", 19, &["`estimator.rigid_rate.correction`", "must be a number between 0 and 1, got 1"]),
    ("switch_off = 1.0", "switch_off = 1.0\n[estimator.envelope]\nwindow = 1.0\nmodes = [{ frequency = 1.0, gain = 0.1 }]", 20, &["`estimator.envelope.modes` apply only to one angle"]),
    ("switch_off = 1.0", "switch_off = 1.0\n[[target]]\nfrom = 9\n[[target]]\nfrom = 5", 21, &["`target[1].from` must be later than the one before, got 5"]),
    ("switch_off = 1.0", "switch_off = 1.0\n[manoeuvre]\nangle = 1.0\ntime = 10.0\ncommand = { bang_bang = {} }", 18, &["`manoeuvre` is for bodies with one angle", "use `[[target]]` for three axes"]),
    ("switch_off = 1.0", "switch_off = 1.0\n[[disturbance]]\ntorque = 1.0", 18, &["`disturbance[0].about` must be given for a torque on a body with three axes: `roll`, `pitch` or `yaw`"]),
    ("switch_off = 1.0", "switch_off = 1.0\n[drift.common]\nsinusoid = { amplitude = 0.5, period = 10.0 }", 19, &["`drift.common.sinusoid.amplitude` must be below 0.5"]),
    ("specific_impulse = 200.0", "specific_impulse = 0", 19, &["`actuator.jets.specific_impulse`", "must be a positive number, got 0"]),
    ("specific_impulse = 200.0", "specific_impulse = 200.0\ndelay = 2", 20, &["`actuator.jets.delay` must be 0 or 1 cycles, got 2"]),
    ("specific_impulse = 200.0", "specific_impulse = 200.0\nminimum_on = 0.3", 20, &["`actuator.jets.minimum_on` must be at most the law's period of 0.2 s, got 0.3"]),
    ("specific_impulse = 200.0", "specific_impulse = 200.0\nquantum = 0.3", 20, &["`actuator.jets.quantum` must be at most the law's period of 0.2 s, got 0.3"]),
    ("name = \"-x\"", "name = \"x\"", 22, &["`actuator.jets.thrusters[1].name` must differ", "got `x` again"]),
    ("name = \"x\", point = \"hub\"", "name = \"x\", point = \"hab\"", 21, &["`actuator.jets.thrusters[0].point` must be one of the body's points, `hub`, got `hab`"]),
    ("direction = [0.0, 0.0, 1.0]", "direction = [0.0, 0.0, 2.0]", 21, &["`actuator.jets.thrusters[0].direction` must have length 1, got 2"]),
    ("direction = [0.0, 0.0, 1.0], thrust = 1.0", "direction = [0.0, 0.0, 1.0], thrust = 0.0", 21, &["`actuator.jets.thrusters[0].thrust`", "must be a positive number, got 0"]),
    ("plus = [\"x\"]", "plus = [\"u\"]", 29, &["`actuator.jets.groups.roll.plus` must name thrusters, `x`, `-x`", "got `u`"]),
    ("plus = [\"x\"]", "plus = [\"-x\"]", 29, &["`actuator.jets.groups.roll.plus` must give a torque to plus roll, got [-1, 0, 0] N m"]),
    ("plus = [\"y\"], minus = [\"-y\"]", "plus = [\"y\"], minus = []", 30, &["`actuator.jets.groups.pitch.minus` must give a torque to minus pitch, got [0, 0, 0] N m"]),
    ("yaw = { plus", "gier = { plus", 31, &["unknown key `gier`", "`yaw`"]),
];

#[test]
fn bad_spatial_scenarios_are_refused() {
    let dir = Dir::new();
    for (from, to, line, words) in CASES {
        assert!(FREE.contains(from), "{from}");
        dir.write("bad.toml", FREE.replacen(from, to, 1));
        let place = format!("bad.toml:{line}:");
        dir.run("check bad.toml").exits(2).says(&[&place]).says(words);
    }
}

/// Parts that a one-axis body does not support, and requirements of laws on their actuators.
#[test]
fn parts_of_a_loop_fit_each_other() {
    let planar = "duration = 1\n[body.planar]\nangle = 1e-3\n";
    let law = "[law.pd]\nk_p = 1.0\nk_d = 1.0\nperiod = 0.1\n";
    let part = |from: &str, to: &str| {
        let from = FREE.find(from).expect("a part");
        let to = if to.is_empty() { FREE.len() } else { FREE.find(to).expect("a part") };
        &FREE[from..to]
    };
    let (gyro, phase_plane, jets) =
        (part("[sensor", "[law"), part("[law", "[actuator"), part("[actuator", ""));
    let dir = Dir::new();
    let spatial = "is for a body with three axes, and the body is `planar`";
    for (text, key, why) in [
        (format!("{planar}{phase_plane}"), "law.phase_plane", "needs the largest torque"),
        (format!("{planar}{law}{gyro}"), "sensor.gyro.point", spatial),
        (format!("{planar}{law}{jets}"), "actuator.jets", spatial),
        (format!("{planar}{law}[[target]]\nfrom = 1.0"), "target", spatial),
        (
            format!("{planar}{law}[[disturbance]]\nabout = \"yaw\""),
            "disturbance[0].about",
            "names one of three axes",
        ),
    ] {
        dir.write("bad.toml", text);
        dir.run("check bad.toml").exits(2).says(&[&format!("`{key}` {why}")]);
    }
    for (without, words) in
        [(phase_plane, "missing key `law`"), (jets, "`law.phase_plane` needs the largest torque")]
    {
        dir.write("bad.toml", FREE.replace(without, ""));
        dir.run("check bad.toml").exits(2).says(&[words]);
    }
}

/// Cases: content of a file of modes, and words of the error.
#[rustfmt::skip] // One case a line.
const FILES: &[(&str, &[&str])] = &[
    ("", &["must have a header"]),
    ("damping,hub.tx\n", &["line 1: must have a column `frequency`"]),
    ("frequency,hub.tx,hub.tx\n", &["line 1: must have each column once, got `hub.tx` again"]),
    ("frequency,zeta\n", &["line 1: must name columns `frequency`, `damping`", "`POINT.rz`, got `zeta`"]),
    ("frequency,hub.tw\n", &["line 1", "got `hub.tw`"]),
    ("frequency,hub.tx\n1,2\n3\n", &["line 3: must have 2 numbers, as the header, got 1"]),
    ("frequency,hub.tx\n1,x\n", &["line 2: `hub.tx` must be a number, got `x`"]),
    ("frequency,hub.tx\n1,inf\n", &["line 2: `hub.tx` must be a number, got `inf`"]),
    ("frequency,hub.tx\n0,1\n", &["line 2: `frequency` must be a natural frequency of 1e-4 to 1e4 rad/s, got 0"]),
    ("hub.tx,frequency,damping\n1,1,-1\n", &["line 2: `damping` must be a number of 0 or more, got -1"]),
];

#[test]
fn bad_files_of_modes_are_refused() {
    let (head, rest) = FREE.split_once("[[body.spatial.modes]]").expect("modes");
    let (_, tail) = rest.split_once("[sensor.gyro]").expect("a gyro");
    let with = |modes: &str| format!("{head}modes = {modes}\n[sensor.gyro]{tail}");
    let dir = Dir::holding("bad.toml", with("\"modes.csv\""));
    let refused = |words: &[&str]| {
        dir.run("check bad.toml").exits(2).says(&["bad.toml:6:", "`body.spatial.modes`"]).says(words);
    };
    refused(&["cannot be used", "modes.csv: No such file"]);
    for (csv, words) in FILES {
        dir.write("modes.csv", csv);
        refused(&["cannot be used", "modes.csv"]);
        refused(words);
    }
    dir.write("modes.csv", "frequency,hab.tx\n1,2\n");
    dir.run("check bad.toml")
        .exits(2)
        .says(&["`body.spatial.modes[0].shapes.hab` must be one of the points, `hub`"]);
    dir.write("bad.toml", with("\"modes.txt\""));
    refused(&["must be an array of modes, or the path of a .csv file", "modes.txt"]);
    dir.write("bad.toml", with("5"));
    refused(&["expected an array of modes, or the path of a .csv file"]);
}
