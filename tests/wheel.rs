//! The wheel-controlled spacecraft: its coupled motion, drifting frequencies, the sampled PD law with its extra loop.
//!
//! Numbers of the closed loop come from `tests/golden/wheel_readings.py angles` for the constants of the scenarios, and from
//! SciPy's matrix exponential and DOP853 at rtol 1e-12 (drifting frequencies) for those of `wheel-settling-fit`.

use flexsc_core::Scenario;
use flexsc_core::record::Trace;

use crate::study::{metrics, pairs, scenario};
use crate::traces::{column, traced};
use crate::util::Dir;

/// The measured angle at the 1st, 2nd, 4th, 6th and 10th row after the start.
fn angles(scenario: &Scenario) -> [f64; 5] {
    let trace = traced(scenario);
    let angle = column(&trace, "/attitude", "angle_rad");
    [1, 2, 4, 6, 10].map(|index| angle[index])
}

/// The keys of the constants that are fitted to the settling times of the papers, as in `wheel-settling-fit`.
pub const FITTED: [(&str, &str); 4] = [
    ("actuator.wheel.gain", "5e-4"),
    ("actuator.wheel.back_emf", "1e-4"),
    ("law.pd.period", "0.3"),
    ("law.pd.differentiation", "\"raw\""),
];

/// Options for the fitted constants.
pub const FITTED_OPTIONS: &str = "--set actuator.wheel.gain=5e-4 --set actuator.wheel.back_emf=1e-4 \
                                  --set law.pd.period=0.3 --set law.pd.differentiation=raw";

/// A sensor that samples with the fitted constants.
pub const FITTED_SENSOR: (&str, &str) = ("sensor.sampled.period", "0.3");

/// The gains that `wheel-settling-fit` schedules, as a value of `law.pd.extra`.
fn fitted_schedule() -> String {
    let text = scenario("wheel-settling-fit", &[]).to_toml();
    let document: toml::Table = text.parse().expect("TOML");
    document["law"]["pd"]["extra"].to_string()
}

fn agree(name: &str, ours: &[f64], exact: &[f64], tolerance: f64) {
    let worst = pairs(ours, exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < tolerance, "{name}: {worst:e}\n{ours:?}\n{exact:?}");
}

/// All frequencies in the ratio of the first, which is this (rad/s).
fn at(frequency: f64) -> Vec<(String, String)> {
    [0.3, 0.8, 1.0, 2.0]
        .iter()
        .enumerate()
        .map(|(mode, w)| {
            (format!("body.planar.modes[{mode}].frequency"), format!("{:?}", w * frequency / 0.3))
        })
        .collect()
}

fn constant(frequency: f64, more: &[(&str, &str)]) -> Scenario {
    let frequencies = at(frequency);
    let set: Vec<(&str, &str)> =
        frequencies.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
    scenario("wheel-fast-mode", &[&set[..], more].concat())
}

#[test]
fn the_loop_at_constant_frequencies() {
    let exact = [
        (0.3, [4.907_787_277_7e-2, 2.949_055_392_2e-2, 2.914_140_398_3e-3, -2.864_929_862_2e-3]),
        (0.2, [4.878_298_817_9e-2, 2.982_193_898_2e-2, 2.920_933_282_9e-3, -2.899_708_562_7e-3]),
        (0.1, [4.946_999_507_4e-2, 2.980_133_652_4e-2, 2.843_616_385_4e-3, -3.187_526_305_2e-3]),
        (0.05, [4.506_010_638_5e-2, 3.386_489_337_5e-2, 2.175_513_072_2e-3, -4.384_263_383_5e-3]),
    ];
    for (frequency, exact) in exact {
        let run = constant(frequency, &[("log.period", "45"), ("duration", "450")]);
        agree(&frequency.to_string(), &angles(&run)[..4], &exact, 1e-9);
    }
    let extra = [
        ("log.period", "45"),
        ("duration", "450"),
        ("law.pd.extra", "{ gain = 1.2 }"),
        ("sensor", "{ sampled = { period = 4.5 } }"),
        ("estimator", "{ truth = {} }"),
    ];
    let exact = [4.910_512_460_8e-2, 2.953_883_304_0e-2, 2.911_094_163_3e-3, -2.928_669_751_8e-3];
    agree("extra loop", &angles(&constant(0.3, &extra))[..4], &exact, 1e-9);
}

#[test]
fn the_fitted_loop_at_constant_frequencies() {
    let exact = [
        (0.3, [6.838_532_896_7e-3, -1.933_063_297_5e-2, 6.397_906_598_3e-3, -1.805_240_273_8e-3]),
        (0.2, [1.477_580_781_3e-2, -1.992_289_388_0e-2, 8.386_662_579_5e-3, -3.020_589_641_4e-3]),
        (0.1, [1.022_409_979_1e-2, -1.091_753_117_1e-2, 5.065_223_561_3e-3, -1.183_326_714_8e-3]),
        (0.05, [2.584_140_527_9e-3, 3.222_946_385_7e-3, -8.478_564_216_7e-3, 2.299_678_254_1e-3]),
    ];
    for (frequency, exact) in exact {
        let set = [&FITTED[..], &[("log.period", "30"), ("duration", "300")]].concat();
        let run = constant(frequency, &set);
        agree(&frequency.to_string(), &angles(&run)[..4], &exact, 1e-9);
    }
    let more = [
        ("log.period", "30"),
        ("duration", "300"),
        ("law.pd.extra", "{ gain = 1.2 }"),
        ("sensor", "{ sampled = { period = 0.3 } }"),
        ("estimator", "{ truth = {} }"),
    ];
    let extra = [&FITTED[..], &more].concat();
    let exact = [9.607_692_169_1e-3, -2.234_195_376_3e-2, 8.361_338_192_0e-3, -2.900_655_940_7e-3];
    agree("extra loop", &angles(&constant(0.3, &extra))[..4], &exact, 1e-9);
}

#[test]
fn the_loop_at_drifting_frequencies() {
    let exact = [
        (
            "wheel-fixed-gain",
            "1.2",
            [4.922_265_829_3e-2, 2.972_387_279_8e-2, 2.838_074_823_6e-3, -3.308_733_012_6e-3],
        ),
        (
            "wheel-fixed-gain",
            "0.0",
            [4.916_943_401_5e-2, 2.959_666_435_3e-2, 3.006_016_267_3e-3, -3.003_702_171_9e-3],
        ),
        (
            "wheel-fixed-gain",
            "-0.5",
            [4.914_420_439_4e-2, 2.953_562_269_97e-2, 3.089_766_559_7e-3, -2.888_600_882_7e-3],
        ),
        (
            "wheel-scheduled-gain",
            "",
            [4.920_814_806_4e-2, 2.967_646_239_7e-2, 3.065_116_460_7e-3, -2.838_351_966_3e-3],
        ),
    ];
    for (name, gain, exact) in exact {
        let mut set = vec![("log.period", "45"), ("duration", "450")];
        if !gain.is_empty() {
            set.push(("law.pd.extra.gain", gain));
        }
        agree(name, &angles(&scenario(name, &set))[..4], &exact, 1e-8);
    }
}

#[test]
fn the_fitted_loop_at_drifting_frequencies() {
    let exact = [
        (
            "wheel-fixed-gain",
            "1.2",
            [
                9.939_452_428_5e-3,
                -2.316_051_575_9e-2,
                1.065_338_108_9e-2,
                -5.997_956_152_7e-3,
                4.701_323_016_4e-4,
            ],
        ),
        (
            "wheel-fixed-gain",
            "0.0",
            [
                7.190_012_808_1e-3,
                -2.020_262_994_0e-2,
                7.052_515_544_4e-3,
                -2.741_209_392_4e-3,
                -1.040_365_856_5e-3,
            ],
        ),
        (
            "wheel-scheduled-gain",
            "",
            [
                1.009_862_711_3e-2,
                -2.211_871_792_2e-2,
                8.168_530_422_6e-3,
                -2.576_595_235_0e-3,
                -6.352_356_240_0e-4,
            ],
        ),
    ];
    for (name, gain, exact) in exact {
        let schedule = fitted_schedule();
        let mut set = [&FITTED[..], &[FITTED_SENSOR, ("log.period", "30"), ("duration", "300")]].concat();
        if !gain.is_empty() {
            set.push(("law.pd.extra.gain", gain));
        }
        if gain.is_empty() {
            set.push(("law.pd.extra", &schedule));
        }
        agree(name, &angles(&scenario(name, &set)), &exact, 1e-8);
    }
}

#[test]
fn settling_times_of_the_papers_figures() {
    let settling = |name: &str, set: &[(&str, &str)]| metrics(scenario(name, set)).number("settling_time_s");
    let near = |time: Option<f64>, exact: f64, within: f64| {
        let time = time.expect("a metric");
        assert!((time - exact).abs() < within, "{time} {exact}");
    };
    // Runge-Kutta steps of 0.01 s.
    near(settling("wheel-fast-mode", &[]), 179.51, 0.011);
    near(settling("wheel-slow-mode", &[]), 317.99, 0.011);
    near(settling("wheel-fixed-gain", &[]), 302.00, 0.011);
    near(settling("wheel-scheduled-gain", &[]), 180.39, 0.011);
    near(settling("wheel-fixed-gain", &[("law.pd.extra.gain", "0.0")]), 275.78, 0.011);
    near(settling("wheel-fixed-gain", &[("law.pd.extra.gain", "-0.5")]), 180.55, 0.011);
    // The fitted constants, with one decimal: a sample of 0.3 s.
    let fitted = |name: &str, more: &[(&str, &str)]| settling(name, &[&FITTED[..], more].concat());
    near(fitted("wheel-fast-mode", &[]), 180.5, 0.31);
    near(fitted("wheel-slow-mode", &[("duration", "1500")]), 1421.6, 0.31);
    near(fitted("wheel-fixed-gain", &[FITTED_SENSOR]), 354.3, 0.31);
    let schedule = fitted_schedule();
    near(fitted("wheel-scheduled-gain", &[FITTED_SENSOR, ("law.pd.extra", &schedule)]), 172.0, 0.31);
    near(fitted("wheel-fixed-gain", &[FITTED_SENSOR, ("law.pd.extra.gain", "0.0")]), 174.5, 0.31);
    near(fitted("wheel-fixed-gain", &[FITTED_SENSOR, ("law.pd.extra.gain", "-0.5")]), 134.0, 0.31);
    // A run that ends outside the band has not settled.
    assert!(settling("wheel-slow-mode", &[("duration", "150")]).expect("a metric").is_nan());
}

#[test]
fn a_wheel_without_command_takes_energy() {
    let still = [("law", "{ open = {} }"), ("body.planar.rate", "1e-3"), ("duration", "2000")];
    let energy = |trace: &Trace| -> Vec<f64> {
        let (angle, rate) = (column(trace, "/rate", "rigid_rad_s"), trace.topic("/modes").expect("modes"));
        let _ = rate;
        angle.iter().map(|rate| rate * rate).collect()
    };
    for opposes in ["body_rate", "rigid_rate"] {
        let quoted = format!("\"{opposes}\"");
        let set =
            [&still[..], &[("actuator.wheel.opposes", quoted.as_str()), ("actuator.wheel.back_emf", "1e-3")]]
                .concat();
        let energy = energy(&traced(&scenario("wheel-fast-mode", &set)));
        let (first, last) = (energy[0], energy[energy.len() - 1]);
        // exp(-2 a t) of a rigid body: the modes take little of it.
        assert!(last < 0.1 * first && last > 1e-3 * first, "{opposes}: {first:e} {last:e}");
    }
}

#[test]
fn wheels_have_limits() {
    let rotor = "{ inertia = 0.01, speed_limit = 0.05 }";
    let more = [("actuator.wheel.rotor", rotor), ("duration", "100"), ("log.period", "0.3")];
    let set = [&FITTED[..], &more].concat();
    let trace = traced(&scenario("wheel-fast-mode", &set));
    let speed = column(&trace, "/wheel", "speed_rad_s");
    // The limit is tested at samples: between two the wheel may go a little beyond.
    let largest = speed.iter().fold(0.0_f64, |most, speed| most.max(speed.abs()));
    assert!(largest > 0.05 && largest < 0.06, "{largest}");
    let momentum = column(&trace, "/wheel", "momentum_nm_s");
    let rigid = column(&trace, "/rate", "rigid_rad_s");
    // What the wheel has, the body has lost.
    assert!(pairs(momentum, rigid).all(|(wheel, body)| (wheel + body).abs() < 1e-15));

    let shaped = |key: &str, value: &str| {
        let set = [&FITTED[..], &[(key, value), ("duration", "60"), ("log.period", "0.3")]].concat();
        let trace = traced(&scenario("wheel-fast-mode", &set));
        let applied = column(&trace, "/torque", "applied_nm").to_vec();
        let rate = column(&trace, "/rate", "rate_rad_s");
        // The command that is left when the back-EMF is taken out.
        let commands = pairs(&applied, rate).map(|(torque, rate)| (torque + 1e-4 * rate) / 5e-4);
        commands.collect::<Vec<f64>>()
    };
    assert!(shaped("actuator.wheel.limit", "0.1").iter().all(|command| command.abs() < 0.1 + 1e-9));
    let quantised = shaped("actuator.wheel.quantum", "0.05");
    assert!(quantised.iter().all(|command| (command / 0.05 - (command / 0.05).round()).abs() < 1e-6));
    let dead = shaped("actuator.wheel.dead_zone", "0.2");
    assert!(dead.iter().all(|command| command.abs() < 1e-9 || command.abs() > 0.2 - 1e-9));
    assert!(dead.iter().any(|command| command.abs() > 0.2));
}

#[test]
fn a_delay_moves_the_command() {
    let more = [("duration", "3"), ("log.period", "0.05"), ("actuator.wheel.delay", "0.1")];
    let set = [&FITTED[..], &more].concat();
    let trace = traced(&scenario("wheel-fast-mode", &set));
    let applied = column(&trace, "/torque", "applied_nm");
    assert_eq!(applied[1], 0.0);
    assert!(applied[2] < -1e-4, "{:?}", &applied[..4]);
}

#[test]
fn what_does_not_go_with_a_wheel_is_refused() {
    let dir = Dir::with(&["wheel-fixed-gain", "relay-fixed", "relay-wheel", "rotation-sine"]);
    let cases = [
        (
            "relay-fixed",
            "actuator.wheel={gain=1.0,back_emf=1e-4}",
            "`actuator.wheel.back_emf` must be 0 with an `[estimator.envelope]`",
        ),
        (
            "relay-wheel",
            "drift.common.ramp={time=1.0,to=0.5}",
            "`law.relay` finds its crossings in closed form: with a drift it needs a `[sensor.sampled]`",
        ),
        (
            "relay-wheel",
            "actuator.wheel.rotor.speed_limit=100.0",
            "`actuator.wheel.rotor.speed_limit` is checked at the law's commands",
        ),
        (
            "rotation-sine",
            "actuator.wheel.gain=1.0",
            "`actuator.wheel` executes a `[manoeuvre]` sample by sample",
        ),
        ("rotation-sine", "drift.common.ramp={time=1.0,to=0.5}", "`drift` has no closed form"),
        ("wheel-fixed-gain", "drift={each=[]}", "must have a profile for each of 4 modes, got 0"),
        (
            "wheel-fixed-gain",
            "drift.common={table=[{time=1.0,ratio=1.0},{time=1.0,ratio=1.0}]}",
            "must be later than the one before, got 1",
        ),
        ("wheel-fixed-gain", "drift.common={sinusoid={amplitude=0.5,period=100.0}}", "must be below 0.5"),
        ("wheel-fixed-gain", "law.pd.extra={schedule=[]}", "must have at least one point"),
        ("wheel-fixed-gain", "drift.common.ramp.to=0.0", "must be a positive number, got 0"),
        (
            "wheel-fixed-gain",
            "estimator={envelope={window=1.0}}",
            "`law.pd.extra` feeds back the dominant mode",
        ),
        (
            "wheel-fixed-gain",
            "sensor.sampled.faults=[{stuck={from=9.0,to=3.0}}]",
            "`sensor.sampled.faults[0]` must have `from` before `to`",
        ),
        (
            "wheel-fixed-gain",
            "sensor.sampled.faults=[{bent={from=9.0}}]",
            "expected one of `stuck`, `silent`, `outlier`",
        ),
        ("wheel-fixed-gain", "disturbance=[{noise=1e-13}]", "`disturbance[0].period` must be given"),
    ];
    for (name, set, words) in cases {
        dir.run(&format!("check {name}.toml")).exits(0);
        dir.run(&format!("simulate {name}.toml --set {set}")).exits(2).says(&[words]);
    }
}
