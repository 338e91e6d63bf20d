//! x
use flexsc_core::record::{Column, Detail, Trace};
use flexsc_core::{Scenario, Simulation};

#[test]
fn oracle() {
    for g in ["0.31", "0.3389"] {
        let text = std::fs::read_to_string("../../scenarios/relay-fixed.toml")
            .unwrap()
            .replace("k_t = 0.31 ", &format!("k_t = {g} "));
        let s = Scenario::parse("x.toml", &text).unwrap();
        let mut trace = Trace::new(Detail::Events);
        let mut sim = Simulation::new(&s, 0);
        sim.run(&mut trace).unwrap();
        let c = trace.topic("/command").unwrap();
        let t = c.numbers("time_s").unwrap();
        println!("{g}: {} events", t.len());
        let oracle = std::fs::read_to_string(format!("/work/shared/data/relay/events-{g}.csv")).unwrap();
        let mut worst: f64 = 0.0;
        for (i, line) in oracle.lines().skip(1).enumerate() {
            let o: f64 = line.split(',').nth(1).unwrap().parse().unwrap();
            worst = worst.max((o - t[i]).abs());
            if i == 49 || i == 119 {
                println!("{i} worst {worst:e}");
            }
        }
        let w = trace.topic("/envelope_mean").unwrap().numbers("mean_rad").unwrap();
        println!("{:?}", &w[..6]);
        println!("late {:e}", w[20..].iter().sum::<f64>() / 20.0);
    }
    panic!();
}
