//! Broadband forces by tables of their densities, against an independent computation, in linear loops and in runs.

use serde_json::Value;

use crate::machines::{agree, bench, number};
use crate::util::Dir;

/// Measured densities of the three forces.
const TABLE: &str = r#"
[[disturbance]]
point = "rotor"
density = { table = "test.csv" }
"#;
const ROWS: &str = "frequency,fx,fy,fz\n5,1e-7,4e-7,5e-8\n40,1e-6,4e-6,5e-7\n120,1e-7,4e-7,5e-8\n";
const CORRELATION: &str = ", correlation = [[1, 0.6, -0.3], [0.6, 1, 0.2], [-0.3, 0.2, 1]] }";

/// Source: `tests/golden/table_runs.py`, an integral over frequency. A run has 1000 lines of each force between 5 and 120 Hz: some 3 in the width
/// of the mode that moves most, of 0.4 %. The rms of a run thus differs from the integral by 6 %, that of four runs by 3 %.
#[test]
fn runs_move_the_line_of_sight_as_their_tables_say() {
    let dir = Dir::new();
    dir.write("test.csv", ROWS);
    let golden =
        [(" }", [2.454_566_137e-8, 1.328_349_197e-8]), (CORRELATION, [2.431_370_255e-8, 1.220_364_031e-8])];
    for (end, expected) in golden {
        let text = bench(0.001, &TABLE.replace(" }", end)).replace("\"0.05 Hz\"", "\"0.5 Hz\"");
        dir.write("bench.toml", text.replace("period = 0.01\n", "period = 0.001\n"));
        let linear = "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --json";
        let report = dir.run(linear).exits(0).json();
        for (about, expected) in expected.into_iter().enumerate() {
            agree(end, number(&report["outputs"][about]["rms"]), expected, 1e-7);
        }
        // What the start of the load leaves has decayed after 6 s.
        let set = "--set duration=12 --set line_of_sight[0].window=[6,12]";
        let runs = dir.run(&format!("simulate bench.toml {set} --runs 4 --json")).exits(0).printed();
        let lines = runs.lines().map(|line| serde_json::from_str::<Value>(line).expect("an object"));
        let own = lines.filter(|line| line.get("run").is_some());
        let squares: Vec<f64> =
            own.map(|run| number(&run["metrics"]["line_of_sight_rms_rad"][0]).powi(2)).collect();
        assert_eq!(squares.len(), 4);
        let rms = f64::sqrt(squares.iter().sum::<f64>() / 4.0);
        agree(end, rms, expected[0].hypot(expected[1]), 0.1);
    }
}
