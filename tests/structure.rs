//! Structures: matrices and panels become the one-axis body with modes (\[Rotation\], the example of two panels).

use std::f64::consts::PI;
use std::fmt::Write as _;

use flexsc_core::campaign::{Campaign, CampaignRun, Grid};
use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::spacecraft::body::{Body, clamped_frequencies, free_frequencies};
use flexsc_core::{Document, Scenario};

use crate::study::{close, pairs};
use crate::util::Dir;

/// Law for a body that is analysed, not controlled.
pub const RELAY: &str = "duration = 10.0\n[law.relay]\ndead_zone = 2e-3\nhysteresis = 2e-4\nstrong = 1.0\n\
                     weak = 0.02\nk_t = 0.33\n";
const PANELS: &str = "[body.panels]\nhub_inertia = 166.67\nroot = 0.5\nSET\n\
    sections = [{ length = 2.5, mass_per_length = 3, tip_mass = 5, hinge_stiffness = 3000 },\n\
    { length = 2.5, mass_per_length = 3, tip_mass = 5, hinge_stiffness = 2000 },\n\
    { length = 2.5, mass_per_length = 3, tip_mass = 5, hinge_stiffness = 2000 },\n\
    { length = 2.5, mass_per_length = 3, tip_mass = 5, hinge_stiffness = 2000 }]\n";
const MASS: [[f64; 5]; 5] = [
    [4616.67, 75.0, 137.5, 200.0, 177.5],
    [75.0, 20.0, 2.5, 0.0, 0.0],
    [137.5, 2.5, 20.0, 2.5, 0.0],
    [200.0, 0.0, 2.5, 20.0, 2.5],
    [177.5, 0.0, 0.0, 2.5, 15.0],
];
const STIFFNESS: [[f64; 5]; 5] = [
    [0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 4160.0, -2560.0, 640.0, 0.0],
    [0.0, -2560.0, 3840.0, -2560.0, 640.0],
    [0.0, 640.0, -2560.0, 3200.0, -1280.0],
    [0.0, 0.0, 640.0, -1280.0, 640.0],
];
/// Free structure by tests/golden/structure_oracle.py, 40 digits: frequency, |X_n[theta]|, X_n[theta] P_4n.
const FREE: [[f64; 3]; 4] = [
    [3.330_081_535_753_227, 0.045_157_626_359_876_61, -0.004_348_115_795_801_667],
    [7.398_419_278_191_803_4, 0.055_779_672_084_264_57, 0.000_588_937_792_420_223_5],
    [14.165_312_469_319_566, 0.023_059_210_848_757_356, -0.002_719_332_646_332_006_2],
    [22.348_647_095_581_693, 0.007_688_751_164_334_697_5, 0.000_523_340_628_034_430_7],
];
/// Structure clamped at the hub, by this oracle: frequency, |m_n|, m_n P_4n.
const CLAMPED: [[f64; 3]; 4] = [
    [0.913_857_391_138_065_3, 65.811_053_324_514_89, 1.539_638_335_597_998_8],
    [5.362_331_803_393_391, 10.289_266_343_715_62, -0.773_538_355_102_115_4],
    [13.638_952_997_537_382, 3.249_624_891_421_514, 0.321_708_658_169_003_3],
    [22.250_622_889_420_21, 1.142_620_673_806_369_8, -0.088_289_242_853_008_96],
];

fn model(dir: &Dir, body: &str) -> AxisModel {
    dir.write("study.toml", format!("duration = 10.0\n[law.open]\n{body}"));
    let scenario = Scenario::load(&dir.path("study.toml")).unwrap_or_else(|error| panic!("{error}"));
    scenario.one_angle().expect("one angle").clone()
}

fn rows(matrix: &[[f64; 5]]) -> String {
    let rows: Vec<_> = matrix.iter().map(|row| format!("{row:?}")).collect();
    format!("[{}]", rows.join(", "))
}

/// The example by its matrices, written so, with the last section's angle as output.
fn matrices(mass: &str, stiffness: &str, set: &str) -> String {
    format!(
        "[body.matrices]\nmass = {mass}\nstiffness = {stiffness}\n{set}\n\
         outputs = [{{ name = \"last\", weights = [0, 0, 0, -0.4, 0.4] }}]\n"
    )
}

#[track_caller]
fn is_the_free_example(body: &AxisModel) {
    let output = body.outputs.last().expect("an output");
    close(body.inertia.get(), 4616.67, 1e-14);
    assert_eq!((body.modes.len(), output.rigid.get()), (4, 0.0));
    for ((mode, weight), [frequency, participation, product]) in
        pairs(pairs(body.modes.iter(), &output.modes), FREE)
    {
        close(mode.frequency.get(), frequency, 1e-12);
        close(mode.gain.get(), 4616.67 * participation * participation, 1e-11);
        // x_n = X_n[theta] f_n: what f_n'' = X_n[theta] M gives the angle is weight k_n/J.
        close(weight.get() * mode.gain.get() / 4616.67, product, 1e-10);
    }
}

#[track_caller]
fn is_the_clamped_example(body: &AxisModel) {
    let output = body.outputs.last().expect("an output");
    close(body.inertia.get(), 4616.67, 1e-14);
    for ((mode, weight), [frequency, coupling, product]) in
        pairs(pairs(body.modes.iter(), &output.modes), CLAMPED)
    {
        close(mode.frequency.get(), frequency, 1e-12);
        close(mode.gain.get(), coupling * coupling / 4616.67, 1e-11);
        // f_n'' + w² f_n = -m_n theta''.
        close(weight.get() * mode.gain.get(), -product, 1e-10);
    }
}

#[test]
fn panels_have_the_matrices_of_the_example() {
    let scenario =
        Scenario::parse("a.toml", &format!("{RELAY}{}", PANELS.replace("SET", ""))).expect("valid");
    let Some(Body::Panels(panels)) = &scenario.body else { panic!("no panels") };
    let structure = panels.structure().expect("a structure");
    for (i, (mass, stiffness)) in MASS.iter().zip(&STIFFNESS).enumerate() {
        for j in 0..5 {
            assert!((structure.mass()[(i, j)] - mass[j]).abs() <= 1e-12 * mass[j].abs(), "mass {i} {j}");
            assert_eq!(structure.stiffness()[(i, j)], stiffness[j], "stiffness {i} {j}");
        }
    }
}

#[test]
fn panels_have_the_modes_of_the_example() {
    let dir = Dir::new();
    let free =
        model(&dir, &PANELS.replace("SET", "damping = [0.1, 0.2, 0.3, 0.4]\nangle = 0.5\nrate = 0.25"));
    is_the_free_example(&free);
    let names: Vec<_> = free.outputs.iter().map(|output| output.name.as_str()).collect();
    assert_eq!(names, ["section_1", "section_2", "section_3", "section_4"]);
    assert_eq!(free.modes.iter().map(|mode| mode.damping.get()).collect::<Vec<_>>(), [0.1, 0.2, 0.3, 0.4]);
    assert_eq!((free.angle.get(), free.rate.get()), (0.5, 0.25));
    is_the_clamped_example(&model(&dir, &PANELS.replace("SET", "drive = \"motion\"\nkeep = 4")));
    assert_eq!(model(&dir, &PANELS.replace("SET", "keep = 1")).modes.len(), 1);
}

/// Four panels of half the mass and stiffness are two panels.
#[test]
fn panels_add_up() {
    let four = PANELS
        .replace("SET", "count = 4")
        .replace("mass_per_length = 3", "mass_per_length = 1.5")
        .replace("tip_mass = 5", "tip_mass = 2.5")
        .replace("hinge_stiffness = 3000", "hinge_stiffness = 1500")
        .replace("hinge_stiffness = 2000", "hinge_stiffness = 1000");
    is_the_free_example(&model(&Dir::new(), &four));
}

/// A ten-metre panel in twenty sections: spec by 50-digit arithmetic.
#[test]
fn a_long_chain_has_its_frequencies() {
    let section =
        |c: u32| format!("{{ length = 0.5, mass_per_length = 3, tip_mass = 1, hinge_stiffness = {c} }}, ");
    let sections = section(15000) + &section(10000).repeat(19);
    let chain =
        format!("[body.panels]\nhub_inertia = 166.67\nroot = 0.5\nkeep = 4\nsections = [{sections}]\n");
    let body = model(&Dir::new(), &chain);
    for (mode, w) in pairs(body.modes.iter(), [3.586_689_4, 9.036_270_8, 19.762_341_7, 36.958_048_5]) {
        close(mode.frequency.get(), w, 2e-8);
    }
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn matrices_are_read_from_every_kind_of_file() {
    let dir = Dir::new();
    let csv = |matrix: &[[f64; 5]]| {
        matrix.iter().fold(String::new(), |mut text, row| {
            let row: Vec<_> = row.iter().map(ToString::to_string).collect();
            let _ = writeln!(text, "{}", row.join(", "));
            text
        })
    };
    dir.write("m.csv", csv(&MASS));
    std::fs::create_dir(dir.path("model")).expect("a directory");
    dir.write("model/k.csv", csv(&STIFFNESS));
    let mtx = |matrix: &[[f64; 5]]| {
        let mut text = String::from("%%MatrixMarket matrix coordinate real symmetric\n5 5 15\n");
        for (i, row) in matrix.iter().enumerate() {
            for (j, element) in row.iter().enumerate().take(i + 1) {
                let _ = writeln!(text, "{} {} {element}", i + 1, j + 1);
            }
        }
        text
    };
    dir.write("m.mtx", mtx(&MASS));
    dir.write("k.mtx", mtx(&STIFFNESS));
    for kind in ["dense", "csr", "csc", "coo", "dia"] {
        let name = format!("structure-{kind}.npz");
        let golden = format!("{}/../../tests/golden/{name}", env!("CARGO_MANIFEST_DIR"));
        std::fs::copy(golden, dir.path(&name)).expect("golden");
    }
    let (inline_mass, inline_stiffness) = (rows(&MASS), rows(&STIFFNESS));
    let dense = "\"structure-dense.npz:K\"";
    let pairs = [
        (inline_mass.as_str(), inline_stiffness.as_str()),
        ("\"m.csv\"", "\"model/k.csv\""),
        ("\"m.mtx\"", "\"k.mtx\""),
        ("\"structure-dense.npz:M\"", dense),
        ("\"structure-csr.npz\"", dense),
        ("\"structure-csc.npz\"", dense),
        ("\"structure-coo.npz\"", dense),
        ("\"structure-dia.npz\"", dense),
    ];
    let first = model(&dir, &matrices(pairs[0].0, pairs[0].1, ""));
    for (mass, stiffness) in pairs {
        let body = model(&dir, &matrices(mass, stiffness, ""));
        is_the_free_example(&body);
        assert_eq!(body, first, "{mass}");
        is_the_clamped_example(&model(&dir, &matrices(mass, stiffness, "drive = \"motion\"")));
    }
}

/// With absolute coordinates, w_k = x_k theta + v_k, the rotation says what turns with the hub. The hub stands last.
#[test]
fn coordinates_may_turn_with_the_hub() {
    let x = [3.0, 5.5, 8.0, 10.5];
    // Order: w_1 to w_4, theta. Q = T q takes (w, theta) back to (theta, v).
    let mut transform = [[0.0; 5]; 5];
    transform[0][4] = 1.0;
    for k in 0..4 {
        transform[k + 1][k] = 1.0;
        transform[k + 1][4] = -x[k];
    }
    let changed = |matrix: &[[f64; 5]; 5]| {
        let mut new = [[0.0; 5]; 5];
        for (i, row) in new.iter_mut().enumerate() {
            for (j, element) in row.iter_mut().enumerate() {
                for a in 0..5 {
                    for b in 0..5 {
                        *element += transform[a][i] * matrix[a][b] * transform[b][j];
                    }
                }
            }
        }
        rows(&new)
    };
    let absolute = |set: &str| {
        format!(
            "[body.matrices]\nmass = {}\nstiffness = {}\nhub = 4\nrotation = [3, 5.5, 8, 10.5, 1]\n\
             coordinates = [\"a\", \"b\", \"c\", \"tip\", \"hub\"]\n{set}\n\
             outputs = [{{ name = \"bend\", unit = \"m\", weights = {{ tip = 2.0, hub = -21 }} }},\n\
             {{ name = \"tip\", weights = {{ tip = 1 }} }}, {{ name = \"hub\", weights = {{ hub = 1 }} }},\n\
             {{ name = \"last\", weights = [0, 0, -0.4, 0.4, -1] }}]\n",
            changed(&MASS),
            changed(&STIFFNESS)
        )
    };
    let dir = Dir::new();
    let free = model(&dir, &absolute(""));
    is_the_free_example(&free);
    let [bend, tip, hub, last] = &free.outputs[..] else { panic!("four outputs") };
    assert_eq!((bend.rigid.get(), tip.rigid.get(), hub.rigid.get()), (0.0, 10.5, 1.0));
    assert_eq!((bend.unit.as_str(), last.unit.as_str()), ("m", "rad"));
    for n in 0..4 {
        // Every mode shows in the hub's own angle as it is.
        close(hub.modes[n].get(), 1.0, 1e-10);
        close(2.0 * tip.modes[n].get() - 21.0, bend.modes[n].get(), 1e-8);
    }
    let clamped = model(&dir, &absolute("drive = \"motion\""));
    is_the_clamped_example(&clamped);
    for n in 0..4 {
        assert_eq!(clamped.outputs[2].modes[n].get(), 0.0);
        close(2.0 * clamped.outputs[1].modes[n].get(), clamped.outputs[0].modes[n].get(), 1e-10);
    }
}

/// A table of free modes gives the modes with the hub clamped, and conversely.
#[test]
fn free_hub_modes_determine_held_hub_modes() {
    let dir = Dir::new();
    let free = model(&dir, &PANELS.replace("SET", ""));
    let clamped = model(&dir, &PANELS.replace("SET", "drive = \"motion\""));
    let held = clamped_frequencies(&free).expect("gains of a body");
    let left = free_frequencies(&clamped).expect("gains of a body");
    for n in 0..4 {
        close(held[n], CLAMPED[n][0], 1e-11);
        close(left[n], FREE[n][0], 1e-11);
    }
    assert_eq!(clamped_frequencies(&clamped).expect("its own")[2], clamped.modes[2].frequency.get());
    let table = "[body.planar]\nmodes = [{ frequency = 1, gain = 0.5 }, { frequency = 2, gain = GAIN }]\n";
    assert_eq!(clamped_frequencies(&model(&dir, &table.replace("GAIN", "-0.1"))), None);
    let much = table.replace("GAIN", "0.5").replace("planar]", "planar]\ndrive = \"motion\"");
    assert_eq!(free_frequencies(&model(&dir, &much)), None);
}

/// A chain of equal masses m between walls that turn with the hub: w_n = 2 sqrt(k/m) sin(n pi/(2 N + 2)). Of order 60
/// it is solved by nalgebra, of order 400 by faer.
#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn large_structures_have_the_modes_of_a_uniform_chain() {
    let dir = Dir::new();
    let (mass, k) = (2.0, 3000.0);
    for order in [60_usize, 400] {
        let mut m = format!(
            "%%MatrixMarket matrix coordinate real symmetric\n{0} {0} {1}\n1 1 5e8\n",
            order + 1,
            2 * order + 1
        );
        let mut stiff = format!(
            "%%MatrixMarket matrix coordinate real symmetric\n{0} {0} {1}\n",
            order + 1,
            2 * order - 1
        );
        for i in 1..=order {
            let at = i + 1;
            let _ = writeln!(m, "{at} 1 {}\n{at} {at} {mass}", mass * i as f64);
            let _ = writeln!(stiff, "{at} {at} {}", 2.0 * k);
            if i < order {
                let _ = writeln!(stiff, "{} {at} {}", at + 1, -k);
            }
        }
        dir.write("m.mtx", m);
        dir.write("k.mtx", stiff);
        let body = "[body.matrices]\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\n";
        let exact = |n: usize| {
            let turn = PI * n as f64 / (2.0 * (order + 1) as f64);
            let w = 2.0 * (k / mass).sqrt() * turn.sin();
            let shape = |i: usize| (2.0 * turn * i as f64).sin() * (2.0 / (mass * (order + 1) as f64)).sqrt();
            let coupling: f64 = (1..=order).map(|i| mass * i as f64 * shape(i)).sum();
            (w, coupling)
        };
        let clamped = model(&dir, &format!("{body}drive = \"motion\"\n"));
        let held = clamped_frequencies(&model(&dir, body)).expect("gains of a body");
        assert_eq!(clamped.modes.len(), order);
        for (n, mode) in (1..).zip(&clamped.modes) {
            let (w, coupling) = exact(n);
            close(mode.frequency.get(), w, 1e-11);
            close(held[n - 1], w, 1e-8);
            close(mode.gain.get(), coupling * coupling / 5e8, 1e-6);
        }
        close(clamped.modes[0].gain.get(), exact(1).1.powi(2) / 5e8, 1e-10);
    }
}

/// Modes are solved once: a file that is gone is not missed by runs that leave the body as it is, nor by a log.
#[test]
fn modes_are_solved_once_and_kept_in_the_log() {
    let dir = Dir::new();
    dir.write("m.csv", rows(&MASS).replace("], [", "\n").replace(['[', ']'], ""));
    let body = matrices("\"m.csv\"", &rows(&STIFFNESS), "angle = 1e-3");
    let uncertain = "[uncertain]\n\"law.relay.weak\" = { uniform = [0.01, 0.03] }\n";
    dir.write("study.toml", format!("{RELAY}{body}{uncertain}"));
    let path = dir.path("study.toml");
    let scenario = Scenario::load(&path).expect("valid");
    std::fs::remove_file(dir.path("m.csv")).expect("there");
    let study = |grid| Campaign::new(scenario.clone(), "study.toml", grid);
    let run = study(None).expect("valid").run(3).expect("a run");
    assert_eq!(run.scenario.model, scenario.model);
    let weak = Grid::linspace("law.relay.weak".to_owned(), 0.01, 0.03, 3);
    assert!(study(Some(weak)).is_ok());
    let damping = Grid::linspace("body.matrices.damping".to_owned(), 0.0, 0.01, 3);
    let error = study(Some(damping)).expect_err("solved again").to_string();
    assert!(error.contains("`body.matrices.mass` cannot be used") && error.contains("m.csv"), "{error}");
    // What the log holds repeats alone, to the same bytes.
    let run = CampaignRun::new(scenario.clone(), 0);
    let toml = Campaign::provenance(&run).toml;
    let again = Scenario::from_document(&Document::parse("log", toml).expect("TOML")).expect("valid");
    assert_eq!(again.model, scenario.model);
    assert!(matches!(again.body, Some(Body::Planar(_))));
    let panels = format!("{RELAY}{}", PANELS.replace("SET", ""));
    let panels = Scenario::parse("panels.toml", &panels).expect("valid");
    assert_eq!(panels.self_contained(), panels.written);
}

/// The command and its JSON list the modes of the example with the hub free and held.
#[test]
fn the_command_tells_of_modes() {
    let dir = Dir::holding("free.toml", format!("{RELAY}{}", PANELS.replace("SET", "")));
    dir.write(
        "held.toml",
        format!("duration = 10.0\n[law.open]\n{}", PANELS.replace("SET", "drive = \"motion\"")),
    );
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    for (name, inertia) in [("free", 0.0), ("held", 1.0)] {
        let reported = dir.run(&format!("modes {name}.toml --json")).exits(0).json();
        close(number(&reported["inertia_kg_m2"]), 4616.67, 1e-14);
        for n in 0..4 {
            close(number(&reported["free_frequencies_rad_s"][n]), FREE[n][0], 1e-11);
            close(number(&reported["clamped_frequencies_rad_s"][n]), CLAMPED[n][0], 1e-11);
            let own = if inertia == 0.0 { (4616.67 * FREE[n][1]).powi(2) } else { CLAMPED[n][1].powi(2) };
            close(number(&reported["effective_inertias_kg_m2"][n]), own, 1e-10);
        }
        assert_eq!(reported["outputs"][3]["name"], "section_4");
        assert_eq!(reported["outputs"][3]["weights"].as_array().map(Vec::len), Some(4));
    }
    dir.run("modes free.toml --units si").exits(0).says(&[
        "3.33",
        "0.9139",
        "hub free",
        "output section_4, rad",
    ]);
    let rigid = dir.run("modes free.toml --set body.panels.keep=0 --json").exits(0).json();
    assert_eq!(rigid["clamped_frequencies_rad_s"], serde_json::json!([]));
    dir.run("modes held.toml --units si").exits(0).says(&["0.9139", "3.33", "hub held"]);
}
