//! Verbs in groups, each with two examples.

/// Verb with two example commands and their descriptions.
pub type Verb = (&'static str, [(&'static str, &'static str); 2]);

/// Verbs grouped by purpose. `tests/help.rs` runs every example, in this order, in one directory that holds the shipped
/// scenarios.
pub const GROUPS: [(&str, &[Verb]); 7] = [
    (
        "Begin",
        &[
            (
                "new",
                [
                    ("flexsc new my-satellite", "a commented scenario to start from"),
                    ("flexsc new mine --cubesat --size 12U --mass 20", "a CubeSat with typical values"),
                ],
            ),
            (
                "examples",
                [
                    ("flexsc examples", "all examples, one line each"),
                    ("flexsc examples wheel-ekf sun-tracking -o copies", "copies of two of them"),
                ],
            ),
            (
                "check",
                [
                    ("flexsc check my-satellite.toml", "every mistake in a scenario"),
                    ("flexsc check my-satellite.toml mine.toml --json", "the same as JSON"),
                ],
            ),
        ],
    ),
    (
        "Run",
        &[
            (
                "simulate",
                [
                    ("flexsc simulate relay-adaptive.toml", "one run, logged to relay-adaptive.mcap"),
                    (
                        "flexsc simulate earth-observer.toml --runs 20 -o monte-carlo",
                        "20 runs with different noise: a table and its statistics",
                    ),
                ],
            ),
            (
                "sweep",
                [
                    (
                        "flexsc sweep relay-fixed.toml --vary law.relay.k_t=0.28:0.40:25 -o gains",
                        "25 gains, with the metrics of each run",
                    ),
                    (
                        "flexsc sweep relay-fixed.toml --vary law.relay.k_t=0.3:0.4:5 --vary seed=1:4:4",
                        "5 gains times 4 seeds",
                    ),
                ],
            ),
            (
                "merge",
                [
                    ("flexsc merge monte-carlo -o all", "all runs of one or more directories"),
                    ("flexsc merge monte-carlo all -o once", "runs found in both are taken once"),
                ],
            ),
            (
                "top",
                [
                    ("flexsc top monte-carlo", "progress and statistics so far"),
                    ("flexsc top monte-carlo --json", "the same as JSON, once"),
                ],
            ),
            (
                "serve",
                [
                    (
                        "flexsc serve earth-observer.toml -o served",
                        "waits for a control program, and runs with it",
                    ),
                    (
                        "flexsc serve earth-observer.toml --describe > packets.xml",
                        "its packets in XTCE, for ground systems",
                    ),
                ],
            ),
        ],
    ),
    (
        "Look",
        &[
            (
                "plot",
                [
                    ("flexsc plot relay-adaptive.mcap -o figures", "all figures of the log"),
                    ("flexsc plot gains -o gains.svg", "all figures of a sweep on one sheet"),
                ],
            ),
            (
                "compare",
                [
                    (
                        "flexsc compare relay-fixed.toml relay-adaptive.toml",
                        "keys that differ, and both answers side by side",
                    ),
                    (
                        "flexsc compare relay-adaptive.mcap relay-adaptive.toml -o difference",
                        "a log beside a new run, with figures one over the other",
                    ),
                ],
            ),
            (
                "report",
                [
                    (
                        "flexsc report attitude-hold.toml -o study.html --runs 20",
                        "a page with a campaign of 20 runs",
                    ),
                    (
                        "flexsc report attitude-hold.toml -o short.html --runs 0 --set duration=60",
                        "a page without a campaign, of a shorter run",
                    ),
                ],
            ),
            (
                "export",
                [
                    ("flexsc export relay-adaptive.mcap", "the topics of a log"),
                    (
                        "flexsc export relay-adaptive.mcap --topic /command -o command.csv",
                        "one topic as a table",
                    ),
                ],
            ),
            (
                "layout",
                [
                    (
                        "flexsc layout relay-adaptive.mcap -o layout.json",
                        "a layout of this log for Foxglove and Lichtblick",
                    ),
                    (
                        "flexsc layout earth-observer.toml -o live.json",
                        "a layout for a live run of a scenario",
                    ),
                ],
            ),
            (
                "log",
                [
                    ("flexsc log answer relay-adaptive.mcap", "the answer of its run"),
                    (
                        "flexsc log recover relay-adaptive.mcap -o whole.mcap",
                        "a complete log from what a killed run left",
                    ),
                ],
            ),
        ],
    ),
    (
        "Analyse",
        &[
            (
                "modes",
                [
                    ("flexsc modes earth-observer.toml", "clamped and free frequencies, masses, influences"),
                    ("flexsc modes relay-fixed.toml --json", "the same as JSON"),
                ],
            ),
            (
                "margins",
                [
                    (
                        "flexsc margins earth-observer.toml",
                        "each command of the law with the loops of the others closed",
                    ),
                    (
                        "flexsc margins wheel-fast-mode.toml --loop measurement --json",
                        "at the measured angle and rate, as JSON",
                    ),
                ],
            ),
            (
                "spectrum",
                [
                    (
                        "flexsc spectrum attitude-hold.toml -o figures",
                        "noise of each axis by source, with its density",
                    ),
                    (
                        "flexsc spectrum wheel-run-up.toml --speeds 30:115:86",
                        "lines of unbalanced wheels over their speed",
                    ),
                ],
            ),
            (
                "budget",
                [
                    (
                        "flexsc budget slew-wheel-lqg.toml --runs 25",
                        "levels of the pointing indices over 25 runs",
                    ),
                    ("flexsc budget shaped-slew.toml --runs 1 --json", "those of one run, as JSON"),
                ],
            ),
            (
                "worst",
                [
                    (
                        "flexsc worst slew-wheel-lqg.toml --points 40 -o worst",
                        "worst case of its requirements, with figures",
                    ),
                    (
                        "flexsc worst slew-wheel-lqg.toml --margin modulus -o corner.toml",
                        "least modulus margin, and a scenario that has it",
                    ),
                ],
            ),
            (
                "bound",
                [
                    ("flexsc bound bounded-jitter.toml", "the claims of the scenario, proved"),
                    ("flexsc bound bounded-jitter.toml -o range.csv", "and the guaranteed ranges over time"),
                ],
            ),
            (
                "cycle",
                [
                    ("flexsc cycle relay-fixed.toml", "the limit cycle of the law, in closed form"),
                    ("flexsc cycle relay-fixed.toml --set law.relay.k_t=0.34", "with another gain"),
                ],
            ),
            (
                "map",
                [
                    (
                        "flexsc map wheel-fixed-gain.toml --frequency 0.5:2:12 --period 0.1:1:10 -o map.csv",
                        "spectral radius and settling time as a table",
                    ),
                    (
                        "flexsc map wheel-fixed-gain.toml --frequency 0.5:2:12 --period 0.1:1:10 --figures maps",
                        "and as figures",
                    ),
                ],
            ),
            (
                "damping",
                [
                    (
                        "flexsc damping --frequency 0.5:8:16 --acceleration 4e-5",
                        "the modes that thrusters damp, sampled every 0.2 s",
                    ),
                    (
                        "flexsc damping --frequency 0.5:8:16 --acceleration 4e-5 --delay 0.1",
                        "the same with a delay",
                    ),
                ],
            ),
            (
                "observer",
                [
                    ("flexsc observer --frequency 1.556", "the weights for which the observer converges"),
                    (
                        "flexsc observer --frequency 1.556 --weights 0.05,0.3,0.2",
                        "whether it converges for these weights",
                    ),
                ],
            ),
            (
                "identify",
                [
                    (
                        "flexsc identify --runs 20 --off 0.1",
                        "success rate of 20 runs from frequencies 10 % off",
                    ),
                    (
                        "flexsc identify --runs 20 --off 0.1 --modes 1.556:2.89,3.77:3.0",
                        "the same for two other modes",
                    ),
                ],
            ),
        ],
    ),
    (
        "Design",
        &[
            (
                "plan",
                [
                    ("flexsc plan rotation-cosine.toml", "a manoeuvre that leaves the modes at rest"),
                    (
                        "flexsc plan rotation-cosine.toml --compare",
                        "the same compared with all other commands",
                    ),
                ],
            ),
            (
                "tune",
                [
                    (
                        "flexsc tune wheel-scheduled-gain.toml",
                        "the gains that settle in time, over frequency",
                    ),
                    (
                        "flexsc tune earth-observer.toml --vary law.attitude.damping=0.4:1.5 --bandwidth 0.1",
                        "the damping with the largest modulus margin",
                    ),
                ],
            ),
        ],
    ),
    (
        "Hand over",
        &[
            (
                "export-c",
                [
                    (
                        "flexsc export-c relay-sampled.toml -o flight",
                        "the relay as C99 in the directory flight",
                    ),
                    (
                        "flexsc export-c earth-observer.toml -o flight-observer --name aocs --calls 1000",
                        "names that begin with aocs, and the first 1000 calls of the run",
                    ),
                ],
            ),
            (
                "vectors",
                [
                    ("flexsc vectors relay-sampled.toml -o vectors.bin", "every call of the relay in a run"),
                    ("flexsc vectors earth-observer.toml -o first.bin --calls 100", "the first 100 calls"),
                ],
            ),
            (
                "export-fmu",
                [
                    ("flexsc export-fmu relay-fixed.toml -o relay.fmu", "the closed loop as an FMU, FMI 3.0"),
                    (
                        "flexsc export-fmu earth-observer.toml --part plant --fmi 2 -o plant.fmu",
                        "the spacecraft alone, for importers of FMI 2.0",
                    ),
                ],
            ),
        ],
    ),
    (
        "Reference",
        &[
            (
                "schema",
                [
                    ("flexsc schema > scenario.schema.json", "the JSON Schema of scenarios, for editors"),
                    ("flexsc schema sensor.gyro", "the keys of a table with their meanings"),
                ],
            ),
            (
                "reproduce",
                [
                    ("flexsc reproduce -o papers", "every figure and number of the papers"),
                    ("flexsc reproduce wheel -o wheel", "those of one paper"),
                ],
            ),
            (
                "completions",
                [
                    ("flexsc completions bash > flexsc.bash", "completions for bash"),
                    ("flexsc completions fish > flexsc.fish", "completions for fish"),
                ],
            ),
        ],
    ),
];
