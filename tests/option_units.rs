//! Units in options of the command: wherever an option has a dimension, by the parser of scenarios.

use std::path::{Path, PathBuf};

use crate::util::Dir;

/// Commands with numbers in SI units, and the same with units of their own.
#[rustfmt::skip] // One command a line.
const PAIRS: &[(&str, &str)] = &[
    ("spectrum earth-observer.toml --json --window 0.01 --separation 1", "--window=10ms --separation=1s"),
    ("spectrum wheel-run-up.toml --json --speeds 10.471975511965976:104.71975511965977:3", "--speeds=100rpm:1000rpm:3"),
    ("damping --json --frequency 0.6283185307179586:6.283185307179586:4 --acceleration 1e-4 --delay 0.05 --amplitude 1e-3", "--frequency=0.1Hz:1Hz:4 --acceleration=0.1mrad/s^2 --delay=50ms --amplitude=1mrad/s"),
    ("observer --json --frequency 3.141592653589793 --period 0.2 --damping 0.005", "--frequency=0.5Hz --period=200ms --damping=0.5%"),
    ("map wheel-fixed-gain.toml --frequency 0.5:1:3 --period 0.1:0.2:2 --band 1e-3 --horizon 60", "--frequency=500mrad/s:1rad/s:3 --period=100ms:0.2s:2 --band=1mrad --horizon=1min"),
    ("plan rotation-sine.toml --json --peak-torque 500 --band 0.1", "--peak-torque=0.5kNm --band=10%"),
    ("identify --json --runs 2 --cycles 50 --modes 1.5707963267948966:2.89 --off 0.05", "--modes=0.25Hz:2.89 --off=5%"),
    ("sweep relay-fixed.toml --json --set duration=100 --vary body.planar.angle=0:1e-3:3", "--vary=body.planar.angle=0:1mrad:3"),
    ("sweep relay-fixed.toml --json --set duration=100 --vary duration=60,120", "--vary=duration=1min,120s"),
    ("tune earth-observer.toml --json --nominal --vary law.attitude.bandwidth=0.05:0.4 --bandwidth 0.06283185307179587", "--vary=law.attitude.bandwidth=50mrad/s:0.4rad/s --bandwidth=0.01Hz"),
];

#[test]
fn numbers_with_units_are_those_in_si() {
    let shipped = ["earth-observer", "wheel-run-up", "wheel-fixed-gain", "rotation-sine", "relay-fixed"];
    let dir = Dir::with(&shipped);
    for (plain, units) in PAIRS {
        let given: Vec<&str> = units.split(' ').filter_map(|unit| unit.split('=').next()).collect();
        let mut command = String::new();
        let mut words = plain.split(' ');
        while let Some(word) = words.next() {
            if given.contains(&word) {
                words.next();
            } else {
                command = format!("{command} {word}");
            }
        }
        let [si, other] = [(*plain).to_owned(), format!("{} {units}", command.trim())]
            .map(|command| dir.run(&command).exits(0).printed());
        assert_eq!(si, other, "{units}");
    }
}

#[test]
fn other_dimensions_are_refused_with_the_accepted_unit() {
    let dir = Dir::with(&["earth-observer", "relay-fixed"]);
    dir.run("simulate relay-fixed.toml --log events --set duration=50 -o run.mcap").exits(0);
    for (command, words) in [
        ("spectrum earth-observer.toml --window=10deg", ["--window <TIME>", "unit such as `s`"]),
        ("spectrum earth-observer.toml --speeds=1s:2s:3", ["--speeds <LO:HI:COUNT>", "unit such as `rad/s`"]),
        ("spectrum earth-observer.toml --window=10fortnights", ["`fortnights`, which is not known", "`s`"]),
        ("plot run.mcap --from=1kg", ["--from <TIME>", "unit such as `s`"]),
        ("plot run.mcap --width=3s", ["--width <MM>", "unit such as `mm`"]),
        ("sweep relay-fixed.toml --vary duration=1kg:2kg:3", ["`duration` has the unit `kg`", "such as `s`"]),
        ("tune earth-observer.toml --vary law.attitude.bandwidth=1s:2s", ["bandwidth", "such as `rad/s`"]),
        ("tune earth-observer.toml --vary law.attitude.damping=0.4:1 --keep settling<=3m", ["--keep", "`s`"]),
        ("top . --every=1m", ["--every <S>", "unit such as `s`"]),
    ] {
        dir.run(command).exits(2).says(&words);
    }
    dir.run("plot run.mcap --what angle --from=20s --to=0.5min -o part.svg").exits(0);
    dir.run("plot run.mcap --what angle --from 20 --to 30 -o same.svg --width 8.5cm").exits(0);
}

#[test]
fn every_number_of_an_option_is_read_with_its_unit() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = 0;
    for path in sources(&folder) {
        let text = std::fs::read_to_string(&path).expect("a source");
        for option in text.split("#[arg(").skip(1) {
            let (attribute, rest) = option.split_once(")]\n").expect("the end of an attribute");
            let kind =
                rest.lines().next().and_then(|field| field.split_once(": ")).map_or("", |field| field.1);
            if ["f64", "PositiveGrid"].iter().any(|number| kind.contains(number)) {
                let own = ["in_unit(", "grid_in(", "timeout"];
                assert!(
                    own.iter().any(|parser| attribute.contains(parser)),
                    "{}: {rest:.60}",
                    path.display()
                );
                found += 1;
            }
        }
    }
    assert!(found > 30, "{found}");
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path());
    let each = |path: PathBuf| if path.is_dir() { sources(&path) } else { vec![path] };
    entries.flat_map(each).collect()
}
