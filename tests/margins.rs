//! Stability margins against independent numbers: loop transfers as sums over aliases, `disk_margins` and `linfnorm` of
//! python-control, and the poles of loops whose gain, phase or delay is off.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use flexsc_core::Scenario;
use flexsc_core::analysis::eigenvalues::eigenvalues;
use flexsc_core::analysis::linear_model::{LinearModel, Signal};
use flexsc_core::analysis::margins::{
    GainCrossing, PhaseCrossing, RootLocus, SignalMargins, StabilityMargins,
};
use flexsc_core::analysis::open_loop::sampling::SampledSystem;
use flexsc_core::analysis::open_loop::{LoopBreak, OpenLoop, TransferMatrices};
use flexsc_core::control::linear_block::LinearBlock;
use nalgebra::{DMatrix, dmatrix};

use crate::open_loops::scenario;
use crate::util::Dir;

/// The loop of `wheel-scheduled-gain` at constant frequencies, without the extra loop, and with a delay of the wheel (s).
pub fn wheel_loop(delay: f64) -> String {
    format!(
        r#"
name = "wheel"
duration = 600.0
sensor.sampled.period = 0.3

[body.planar]
angle = 0.06
modes = [
    {{ frequency = 0.3, gain = 1.44 }},
    {{ frequency = 0.8, gain = 0.21 }},
    {{ frequency = 1.0, gain = 0.165 }},
    {{ frequency = 2.0, gain = 0.72 }},
]

[actuator.wheel]
gain = 5e-4
back_emf = 1e-4
delay = {delay}

[law.pd]
k_p = 7.5
k_d = 275.0
period = 0.3
differentiation = "raw"
"#
    )
}

fn margins(opened: &OpenLoop) -> StabilityMargins {
    StabilityMargins::new(opened).expect("stable")
}

fn margins_of(text: &str) -> StabilityMargins {
    let scenario = Scenario::parse("wheel.toml", text).expect("valid");
    margins(&OpenLoop::from_scenario(&scenario, LoopBreak::Command).expect("linear"))
}

/// Asserts that two numbers agree to a fraction of the second.
fn agree(what: &str, found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{what}: {found:.15e}, expected {expected:.15e}");
}

/// Asserts the crossings of the gain: frequency (rad/s), phase (deg) and delay (s), the last to a fraction.
fn crossings_agree(found: &[GainCrossing], expected: &[(f64, f64, f64)], part: f64) {
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (crossing, (frequency, phase, delay)) in found.iter().zip(expected) {
        agree("frequency", crossing.frequency_rad_s, *frequency, 5e-13);
        agree("phase", crossing.phase_rad.to_degrees(), *phase, 1e-11);
        agree("delay", crossing.delay_s.expect("one sample"), *delay, part);
    }
}

/// Returns the frequency (rad/s) of the crossing with the gain margin above 1.
fn nearest_phase_crossing(found: &SignalMargins) -> f64 {
    let crossing = found.crossings.phase.iter().find(|crossing| Some(crossing.factor) == found.gain_above);
    crossing.expect("exists").frequency_rad_s
}

#[test]
fn a_loop_over_four_undamped_modes() {
    let found = margins_of(&wheel_loop(0.0));
    agree("radius", found.spectral_radius, 0.998_961_065_569_073, 1e-13);
    let only = &found.loops[0];
    crossings_agree(
        &only.crossings.gain,
        &[
            (0.065_541_381_397_61, 35.113_988_522_4, 9.350_652_979_154),
            (0.273_769_195_399_7, -112.965_182_394_9, 15.748_926_492_54),
            (0.337_306_072_298, 69.456_999_526_21, 3.593_926_791_859),
            (0.796_079_450_697_5, -110.217_920_721_1, 5.476_236_941_017),
            (0.804_987_686_695_4, 69.973_539_081_6, 1.517_127_114_404),
            (0.996_942_774_941_3, -112.376_074_712, 4.335_106_198_289),
            (1.003_917_363_151, 67.814_877_964_28, 1.178_974_431_322),
            (1.986_251_854_957, -126.790_657_166_7, 2.049_221_939_645),
            (2.015_592_481_404, 53.025_928_250_62, 0.459_158_805_878_8),
        ],
        1e-11,
    );
    agree("gain", only.gain_above.expect("exists"), 42.730_629_635_69, 1e-12);
    agree("at", nearest_phase_crossing(only), 5.190_781_513_908, 1e-12);
    assert_eq!(only.gain_below, 0.0);
    agree("phase", only.phase_rad.to_degrees(), 35.113_988_522_4, 1e-11);
    agree("delay", only.delay_s.expect("exists"), 0.459_158_805_878_8, 1e-11);
    agree("modulus", only.modulus.margin, 0.601_996_503_038_2, 1e-12);
    agree("modulus at", only.modulus.frequency_rad_s, 0.067_077_54, 1e-6);
    agree("disk", only.disk.alpha, 0.610_802_655_745_0, 1e-12);
    agree("disk at", only.disk.frequency_rad_s, 0.060_113_15, 1e-6);
    // One loop alone is the whole loop.
    assert_eq!((found.modulus, found.disk), (only.modulus, only.disk));
    agree("least", only.disk.gains[0], (2.0 - 0.610_802_655_745) / (2.0 + 0.610_802_655_745), 1e-12);
    agree("disk phase", only.disk.phase_rad, 2.0 * (0.610_802_655_745_f64 / 2.0).atan(), 1e-12);
}

#[test]
fn a_wheel_without_back_emf() {
    let text = wheel_loop(0.0).replace("back_emf = 1e-4", "");
    agree("gain", margins_of(&text).loops[0].gain_above.expect("exists"), 42.727_248_515_894_8, 1e-12);
}

#[test]
fn a_delay_of_a_part_of_a_period() {
    let found = margins_of(&wheel_loop(0.12));
    agree("radius", found.spectral_radius, 0.998_989_989_89, 1e-11);
    let only = &found.loops[0];
    agree("gain", only.gain_above.expect("exists"), 25.018_444_333_4, 1e-11);
    agree("at", nearest_phase_crossing(only), 3.673_872_440_508, 1e-12);
    agree("phase", only.phase_rad.to_degrees(), 34.663_352_557_67, 1e-11);
    agree("delay", only.delay_s.expect("exists"), 0.339_124_865_650_8, 1e-11);
    agree("modulus", only.modulus.margin, 0.594_507_843_481_0, 1e-12);
    agree("disk", only.disk.alpha, 0.603_224_563_990_7, 1e-12);
}

/// Returns a loop of a body x' = a x + b u whose angles and rates, rows of `c`, pass lags of 8 rad/s, u = (.0025 angle +
/// `k_d` rate), at samples 0.2 s apart and `delay` (s) late.
fn lagged_loop(a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>, k_d: f64, delay: f64) -> LinearBlock {
    let (order, axes) = b.shape();
    let lags = 2 * axes;
    let mut whole = DMatrix::zeros(order + lags, order + lags);
    whole.view_mut((0, 0), (order, order)).copy_from(a);
    whole.view_mut((order, 0), (lags, order)).copy_from(&(c * 8.0));
    whole.view_mut((order, order), (lags, lags)).fill_diagonal(-8.0);
    let forced = b.clone().resize_vertically(order + lags, 0.0);
    let plant = SampledSystem::new(&whole, &forced, 0.2, delay);
    let mut read = DMatrix::zeros(axes, plant.a.nrows());
    for axis in 0..axes {
        (read[(axis, order + 2 * axis)], read[(axis, order + 2 * axis + 1)]) = (0.0025, k_d);
    }
    LinearBlock { a: plant.a, b: plant.b, c: read, d: DMatrix::zeros(axes, axes), states: Vec::new() }
}

fn opened(block: LinearBlock) -> OpenLoop {
    let names = ["roll", "pitch", "yaw"].iter().take(block.b.ncols());
    OpenLoop {
        transfer: TransferMatrices { a: block.a, b: block.b, c: block.c, d: block.d },
        states: Vec::new(),
        signals: names.map(|name| Signal { name: (*name).to_owned(), unit: "N m".to_owned() }).collect(),
        opened: LoopBreak::Command,
        period: 0.2,
        samples: 1,
    }
}

/// Returns the loop of a yaw axis with four modes, whose frequencies are off by these factors, a notch at a frequency
/// (rad/s) with poles of radius `r`, and the gain `k_d` of the rate.
pub fn yaw_axis(factors: [f64; 4], [k_d, notch_frequency, r]: [f64; 3]) -> OpenLoop {
    let frequencies = [1.5557, 3.8007, 3.8302, 4.8588];
    let influences = [2.88, 1.355, 1.613, 0.556];
    let (mut a, mut b) = (DMatrix::zeros(10, 10), DMatrix::zeros(10, 1));
    (a[(0, 1)], b[(1, 0)]) = (1.0, 1.0);
    let mut c = DMatrix::zeros(2, 10);
    (c[(0, 0)], c[(1, 1)]) = (1.0, 1.0);
    for (mode, (nominal, influence)) in frequencies.iter().zip(influences).enumerate() {
        let w = nominal * factors[mode];
        let place = 2 + 2 * mode;
        (a[(place, place + 1)], a[(place + 1, place)], a[(place + 1, place + 1)]) = (1.0, -w * w, -0.01 * w);
        b[(place + 1, 0)] = influence;
        (c[(0, place)], c[(1, place + 1)]) = (1.0, 1.0);
    }
    let cosine = (notch_frequency * 0.2_f64).cos();
    let gain = (1.0 - 2.0 * r * cosine + r * r) / (2.0 - 2.0 * cosine);
    let (b1, b2, a1, a2) = (-2.0 * cosine, 1.0, -2.0 * r * cosine, r * r);
    let notch = LinearBlock {
        a: dmatrix![-a1, 1.0; -a2, 0.0],
        b: dmatrix![b1 - a1; b2 - a2] * gain,
        c: dmatrix![1.0, 0.0],
        d: dmatrix![gain],
        states: Vec::new(),
    };
    opened(lagged_loop(&a, &b, &c, k_d, 0.14).then(notch))
}

#[test]
fn a_yaw_axis_with_lags_and_a_notch() {
    let found = margins(&yaw_axis([1.0; 4], [0.07, 1.5557, 0.9]));
    agree("radius", found.spectral_radius, 0.998_700_993_708_6, 1e-12);
    let only = &found.loops[0];
    agree("gain", only.gain_above.expect("exists"), 5.197_085_333_49, 1e-11);
    agree("at", nearest_phase_crossing(only), 5.144_947_767_881, 1e-12);
    crossings_agree(
        &only.crossings.gain,
        &[
            (0.076_545_012_142_51, 61.655_510_109_68, 14.058_286),
            (3.724_502_042_157, -161.120_984_746, 0.931_962),
            (3.922_636_113_046, 36.810_564_355_55, 0.163_784),
        ],
        1e-6,
    );
    agree("delay", only.delay_s.expect("exists"), 0.163_784_131_131_8, 1e-11);
    agree("modulus", only.modulus.margin, 0.550_988_725_078_0, 1e-12);
    agree("disk", only.disk.alpha, 0.642_916_377_534_8, 1e-12);
}

/// Returns the loop of the station with collocated torque and gyro.
pub fn station(delay: f64) -> OpenLoop {
    let scenario = scenario("iss-ringdown");
    let body = scenario.model.three_axis().expect("three axes");
    let model = LinearModel::from_scenario(&scenario, 0.0).expect("linear");
    let order = 6 + 2 * 12;
    let a = DMatrix::from_fn(order, order, |row, column| model.a[row][column]);
    let inertia = body.inertia;
    let torque =
        DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(3, (0..3).map(|k| inertia[(k, k)])));
    let inverse = inertia.try_inverse().expect("regular");
    let mut b = DMatrix::zeros(order, 3);
    let mut c = DMatrix::zeros(6, order);
    for axis in 0..3 {
        (c[(2 * axis, axis)], c[(2 * axis + 1, 3 + axis)]) = (1.0, 1.0);
        for row in 0..3 {
            b[(3 + row, axis)] = inverse[(row, axis)];
        }
        for (mode, (_, rotation)) in body.shapes("gyro").iter().take(12).enumerate() {
            b[(7 + 2 * mode, axis)] = rotation[axis];
            (c[(2 * axis, 6 + 2 * mode)], c[(2 * axis + 1, 7 + 2 * mode)]) = (rotation[axis], rotation[axis]);
        }
    }
    opened(lagged_loop(&a, &(b * torque), &c, 0.07, delay))
}

#[test]
fn three_axes_of_a_station() {
    let found = margins(&station(0.04));
    agree("radius", found.spectral_radius, 0.999_433_537_278, 1e-11);
    agree("disk", found.disk.alpha, 0.018_304_265_891, 1e-9);
    agree("at", found.disk.frequency_rad_s, 7.397_865, 1e-6);
    agree("modulus", found.modulus.margin, 0.018_254_566_720, 1e-9);
    // Independent factors on the axes: SLICOT's AB13MD has .0183047235.
    agree("independent", found.independent_disk.expect("three signals").alpha, 0.018_304_723_5, 2e-9);
    for (one, expected) in found.loops.iter().zip([0.455_872_434_368, 0.018_306_827_217, 0.652_224_391_908]) {
        agree(&one.signal, one.disk.alpha, expected, 1e-9);
    }
}

#[test]
fn an_unstable_loop_has_no_margins() {
    let fault = StabilityMargins::new(&station(0.14)).expect_err("unstable");
    agree("radius", fault.spectral_radius, 1.0164, 1e-4);
    agree("at", fault.frequency_rad_s, 7.25, 0.02);
    assert!(fault.signal == "pitch" && fault.damping < 0.0, "{fault:?}");
    assert!(fault.to_string().contains("not stable and has no margins"), "{fault}");
}

/// Returns the spectral radius of a loop whose commands about one axis have this factor, or another phase.
fn radius_off(opened: &OpenLoop, signal: usize, factor: f64) -> f64 {
    let mut transfer = opened.transfer.clone();
    let count = opened.signals.len();
    for place in (0..transfer.b.ncols()).filter(|place| place % count == signal) {
        let mut row = transfer.c.row_mut(place);
        row *= factor;
        let mut row = transfer.d.row_mut(place);
        row *= factor;
    }
    let poles = eigenvalues(&transfer.sensitivity().expect("exists").a).expect("converges");
    poles.iter().map(|pole| pole.re.hypot(pole.im)).fold(0.0, f64::max)
}

/// Asserts that the closed loop is stable up to the gain margins of a signal, and unstable beyond.
fn gains_are_limits(opened: &OpenLoop, signal: usize, found: &SignalMargins) {
    for (factor, beyond) in [(found.gain_below, 0.999), (found.gain_above.unwrap_or(0.0), 1.001)] {
        if factor > 0.0 {
            let inside = radius_off(opened, signal, 1.0 + (factor - 1.0) * 0.999);
            let outside = radius_off(opened, signal, factor * beyond);
            assert!(inside < 1.0 && outside > 1.0, "{} {factor}: {inside} {outside}", found.signal);
        }
    }
}

#[test]
fn gain_margins_are_where_poles_leave_the_unit_circle() {
    let mut limits = 0;
    for name in ["earth-observer", "station-keeping", "attitude-hold", "slew-wheel-lqg", "observer-slow-gyro"]
    {
        let opened = OpenLoop::from_scenario(&scenario(name), LoopBreak::Command).expect("linear");
        for (signal, found) in margins(&opened).loops.iter().enumerate() {
            gains_are_limits(&opened, signal, found);
            limits += usize::from(found.gain_above.is_some()) + usize::from(found.gain_below > 0.0);
            assert!(found.phase_rad < PI && found.disk.alpha > 0.0, "{name}: {found:?}");
            // A disk of alpha contains the disk of half its size about -1, and the loop passes outside of both.
            assert!(found.modulus.margin <= found.disk.alpha * 1.5 + 1e-12, "{name}");
        }
    }
    assert!(limits >= 12, "{limits}");
}

/// The poles of a root locus cross the imaginary axis where the frequency response has its gain margin, at that frequency.
#[test]
fn poles_of_a_root_locus_cross_at_the_gain_margin() {
    let factors: Vec<f64> = (-136..=240).map(|step| 10_f64.powf(f64::from(step) / 160.0)).collect();
    let [least, largest] = [factors[0], factors[factors.len() - 1]];
    let mut crossings = 0;
    for name in ["earth-observer", "station-keeping", "attitude-hold", "slew-wheel-lqg", "observer-slow-gyro"]
    {
        let opened = OpenLoop::from_scenario(&scenario(name), LoopBreak::Command).expect("linear");
        for (signal, found) in margins(&opened).loops.iter().enumerate() {
            let locus = RootLocus::new(&opened, signal, &factors).expect("poles");
            let limits = [found.gain_below, found.gain_above.unwrap_or(f64::INFINITY)];
            let within = limits.into_iter().filter(|factor| (least..largest).contains(factor));
            let within: Vec<f64> = within.collect();
            assert_eq!(locus.crossings.len(), within.len(), "{name} {}: {within:?}", found.signal);
            for (crossing, factor) in locus.crossings.iter().zip(within) {
                agree("factor", crossing.factor, factor, 1e-6);
                let near = |at: &&PhaseCrossing| (at.factor / factor - 1.0).abs() < 1e-9;
                let at = found.crossings.phase.iter().find(near).expect("a crossing");
                agree("frequency", crossing.frequency_rad_s, at.frequency_rad_s, 1e-4);
                crossings += 1;
            }
        }
    }
    assert!(crossings >= 8, "{crossings}");
}

/// Modulus and disk margins by the norms of SLICOT: `tests/golden/disk_margin_reference.py`.
#[test]
fn modulus_and_disk_margins_are_norms_of_slicot() {
    for (name, rows) in golden("disk_margins") {
        let opened = OpenLoop::from_scenario(&scenario(&name), LoopBreak::Command).expect("linear");
        let all = margins(&opened);
        for row in rows {
            let one = all.loops.iter().find(|one| one.signal == row[0]);
            let (modulus, disk) = one.map_or((all.modulus, all.disk), |one| (one.modulus, one.disk));
            let what = format!("{name} {}", row[0]);
            agree(&what, modulus.margin, row[1].parse().expect("a number"), 1e-9);
            agree(&what, disk.alpha, row[2].parse().expect("a number"), 1e-9);
        }
    }
}

/// Returns the rows of a golden table without their first cell, which is the scenario, for each scenario.
fn golden(table: &str) -> BTreeMap<String, Vec<Vec<String>>> {
    let path = format!("{}/../../tests/golden/{table}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("golden");
    let mut found: BTreeMap<String, Vec<Vec<String>>> = BTreeMap::new();
    for line in text.lines().skip(1) {
        let mut cells = line.split(',').map(str::to_owned);
        let name = cells.next().expect("a scenario");
        found.entry(name).or_default().push(cells.collect());
    }
    assert!(found.len() > 5, "{}", found.len());
    found
}

/// Gains and phases by the poles of loops that are off, as Python finds them: `tests/golden/open_loop_reference.py`.
#[test]
fn margins_are_those_of_the_poles_of_loops_that_are_off() {
    for (name, rows) in golden("margins") {
        let opened = OpenLoop::from_scenario(&scenario(&name), LoopBreak::Command).expect("linear");
        let all = margins(&opened);
        for row in rows {
            let found = all.loops.iter().find(|one| one.signal == row[0]).expect("a signal");
            // The search of poles ends 1e-8 from the limit, before a slow pole is on it.
            let near = |found: f64, expected: &str| {
                let expected: f64 = expected.parse().expect("a number");
                let off = (found - expected).abs();
                assert!(
                    off < 1e-4 * expected.abs() || found == expected,
                    "{name} {}: {found}, expected {expected}",
                    row[0]
                );
            };
            near(found.gain_below, &row[1]);
            near(found.gain_above.unwrap_or(f64::INFINITY), &row[2]);
            near(found.phase_rad, &row[3]);
        }
    }
}

/// A compensator without states is an attitude law of the same gains; its three equal loops have poles that are hard to compute.
#[test]
fn a_compensator_without_states_has_the_margins_of_an_attitude_law() {
    let dir = Dir::with(&["site-pass"]);
    let text = dir.text("site-pass.toml");
    let law = "law.state_space = { period = 0.25, d = [[0.04, 0.32]], command = \"acceleration\" }";
    assert!(text.contains(law));
    let other = "law.attitude = { period = 0.25, bandwidth = 0.2, damping = 0.8 }";
    dir.write("other.toml", text.replace(law, other));
    // A state that nothing reads changes no margin.
    let unread = "a = [[-1.0]], b = [[0.0, 0.0]], c = [[0.0]], d = [[0.04, 0.32]]";
    dir.write("unread.toml", text.replace("d = [[0.04, 0.32]]", unread));
    let margins = |name: &str| {
        let told = dir.run(&format!("margins {name}.toml --mode pass")).exits(0).err;
        told.replace(name, "other")
    };
    // The delay of 65.43 degrees at 0.05488 Hz.
    let told = margins("other");
    assert!(told.contains("actuators together may add: 3.312 s"), "{told}");
    // About each axis the poles 0.8363 +- 0.1002i of a period of 1 s, and no part of a bias that the filter does not learn.
    assert!(told.contains("roll 20.74 s, pitch 20.74 s, yaw 20.74 s"), "{told}");
    assert_eq!(margins("site-pass"), margins("other"));
    assert_eq!(margins("unread"), margins("other"));
}

/// A delay of reaction wheels takes as much from the delay that the loop tolerates, and no more.
#[test]
fn a_delay_of_wheels_is_taken_from_the_delay_that_is_left() {
    let dir = Dir::with(&["attitude-hold"]);
    let text = dir.text("attitude-hold.toml");
    let (before, rest) = text.split_once("[actuator.wheel]").expect("a wheel");
    let (_, after) = rest.split_once("[[disturbance]]").expect("a disturbance");
    let ran = |delay: f64| {
        let wheels =
            format!("[actuator.wheels]\narrangement = \"orthogonal\"\ninertia = 0.1\ndelay = {delay}\n");
        dir.write("late.toml", format!("{before}{wheels}[[disturbance]]{after}"));
        dir.run("margins late.toml --json")
    };
    let left = |delay: f64| {
        let json: serde_json::Value = serde_json::from_str(&ran(delay).exits(0).out).expect("an object");
        json["common_delay_s"].as_f64().expect("a delay")
    };
    let most = left(0.0);
    // Within a period, a whole one, and beyond two.
    for delay in [0.13, 0.2, 0.55] {
        let error = left(delay) - (most - delay);
        assert!(error.abs() < 1e-9, "{delay}: {error:e}");
    }
    assert!((left(most - 1e-3) - 1e-3).abs() < 1e-9);
    ran(most + 1e-3).exits(2).says(&["not stable"]);
}
