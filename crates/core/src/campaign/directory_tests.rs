//! Tests of directories: parts by any workers in any order, manifests that fit or not, locks.

use super::*;
use crate::campaign::design::{Design, DesignBlock};
use crate::campaign::{Campaign, ColumnCells, Merge};
use crate::metrics::Selection;

const SCENARIO: &str = r#"
name = "u"
seed = 7
duration = 300.0
[body.planar]
angle = 4.5e-4
rate = 2.2e-5
modes = [{ frequency = 0.44, gain = 0.0213, displacement = 2.75e-6 }]
[law.relay]
dead_zone = 5e-4
hysteresis = 1e-4
strong = 4e-5
weak = 1e-6
k_t = 0.31
[estimator.envelope]
window = 100.0
[uncertain]
"law.relay.k_t" = { normal = { mean = 0.8, sd = 0.2 } }
"body.planar.rate" = { relative_normal = 0.1 }
"#;

struct Here(PathBuf);

impl Here {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("flexsc-directory-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Here {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn campaign(design: Design) -> Campaign {
    Campaign::from_design(crate::Scenario::parse("u.toml", SCENARIO).expect("a scenario"), "u.toml", design)
        .expect("one")
}

fn manifest(runs: Range<u64>) -> Manifest {
    let mut manifest =
        Manifest::new(&campaign(Design::default()), runs, &Selection::ALL).expect("a manifest");
    manifest.part = 8;
    manifest
}

fn columns(directory: &Directory) -> Vec<Option<ColumnCells>> {
    let names: Vec<&str> = directory.work().fields().iter().map(|field| field.name.as_str()).collect();
    let names: Vec<&str> = names.into_iter().filter(|name| *name != "seconds").collect();
    directory.columns(&names).expect("read")
}

#[test]
fn parts_in_any_order_are_the_same_rows() {
    let (one, other) = (Here::new("one"), Here::new("other"));
    let one = Directory::create(&one.0, manifest(0..30), false).expect("made");
    let missing = one.missing().expect("read");
    assert_eq!(missing, [0..8, 8..16, 16..24, 24..30]);
    for runs in missing {
        one.write_part(runs, 1, ()).expect("written");
    }
    drop(Directory::create(&other.0, manifest(0..30), false).expect("made"));
    // Workers only open the directory.
    let worker = Directory::open(&other.0).expect("there");
    for runs in worker.missing().expect("read").into_iter().rev() {
        worker.write_part(runs.clone(), 3, ()).expect("written");
        let (name, bytes) = worker.work().part(runs.clone(), 2, ()).expect("made");
        assert!(name.starts_with("part-") && bytes.starts_with(b"PAR1"));
    }
    let (one, other) = (columns(&one), columns(&worker));
    assert_eq!(one, other);
    assert_eq!(one[0].as_ref().map(ColumnCells::numbers), Some((0..30).map(f64::from).collect()));
    // Some gains are not accepted: their rows have the error.
    let Some(Some(ColumnCells::Text(errors))) = one.last() else { panic!("no errors") };
    let failed = errors.iter().flatten().count();
    assert!((1..30).contains(&failed), "{failed}");
    assert!(errors.iter().flatten().all(|error| error.starts_with("u: `law.relay.k_t`")), "{errors:?}");
}

#[test]
fn the_columns_are_known_before_any_run() {
    let directory = Here::new("columns");
    let directory = Directory::create(&directory.0, manifest(0..3), false).expect("made");
    // The first run whose gain is accepted.
    let run = (0..9).find_map(|number| directory.work().campaign.run(number).ok()).expect("a run");
    let reported = Campaign::simulate(&run, ()).expect("metrics");
    let fields = directory.work().fields();
    let metrics: Vec<&str> = reported.0.iter().map(|(meaning, _)| meaning.name).collect();
    let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
    assert_eq!(names[..4], ["run", "seed", "body.planar.rate", "law.relay.k_t"]);
    assert_eq!(names[4..names.len() - 2], metrics);
    assert_eq!(names[names.len() - 2..], ["seconds", "error"]);
}

#[test]
fn directories_are_merged_if_they_agree() {
    let directories = ["m0", "m1", "m2", "m3"].map(Here::new);
    let make = |directory: &Here, runs: Range<u64>| {
        let directory = Directory::create(&directory.0, manifest(runs), false).expect("made");
        for runs in directory.missing().expect("read") {
            directory.write_part(runs, 1, ()).expect("written");
        }
        directory
    };
    let [whole, low, high, shifted] =
        [(0, 0..30), (1, 0..16), (2, 8..30), (3, 4..12)].map(|(i, r)| make(&directories[i], r));
    let into = Here::new("merged");
    let merged = Directory::create(&into.0, manifest(0..30), false).expect("made");
    // Parts that begin elsewhere, runs that several have, and parts that another one has whole.
    let all = [shifted, low, high];
    let merge = Merge::new(&all).expect("one campaign");
    assert_eq!((merge.used_counts(), merge.missing()), (vec![8, 8, 14], vec![]));
    merge.write(&merged, false).expect("written");
    assert!(merged.missing().expect("read").is_empty());
    assert_eq!(columns(&merged), columns(&whole));
    let rows = merge.rows().expect("read");
    assert_eq!(rows.columns[0].numbers(), (0..30).map(f64::from).collect::<Vec<_>>());
    // A run that is another one elsewhere.
    let tampered = Directory::open(&directories[1].0).expect("there");
    let mut other = tampered.work().make_rows(0..8, 1, ()).expect("made");
    if let Some(ColumnCells::Numbers(rates)) = other.columns.get_mut(2) {
        rates[5] *= 2.0;
    }
    tampered.write(&(0..8), &other).expect("written");
    let all = [whole, tampered];
    let refused = Merge::new(&all).expect_err("other rows").to_string();
    assert!(refused.contains("has other values of `body.planar.rate`"), "{refused}");
}

/// Single bits at 500 places of a part.
#[test]
fn no_flipped_bit_changes_a_number() {
    let workspace = Here::new("bits");
    let directory = Directory::create(&workspace.0, manifest(0..8), false).expect("made");
    let path = directory.write_part(0..8, 1, ()).expect("written");
    let (before, bytes) = (columns(&directory), fs::read(&path).expect("there"));
    let mut rng = flexsc_numerics::random::Seed { scenario: 5, run: 0 }.stream("bits");
    for _ in 0..500 {
        let (place, bit) = (rng.index(bytes.len()), rng.index(8));
        let mut flipped = bytes.clone();
        flipped[place] ^= 1 << bit;
        fs::write(&path, flipped).expect("written");
        let other = Directory::open(&workspace.0).expect("there");
        let refused = other.column("duty").expect_err("damaged").to_string();
        assert!(refused.contains("is damaged") && refused.contains("delete this file"), "{refused}");
    }
    fs::write(&path, &bytes).expect("written");
    assert_eq!(columns(&Directory::open(&workspace.0).expect("there")), before);
}

#[test]
fn what_does_not_fit_is_refused() {
    let workspace = Here::new("fits");
    let directory = Directory::create(&workspace.0, manifest(0..16), false).expect("made");
    let busy = Directory::create(&workspace.0, manifest(0..16), false).expect_err("locked");
    assert!(matches!(busy, DirectoryError::Busy { .. }), "{busy}");
    directory.write_part(0..8, 1, ()).expect("written");
    drop(directory);
    // More runs of the same campaign.
    let more = Directory::create(&workspace.0, manifest(8..40), false).expect("continued");
    assert_eq!(more.work().manifest.runs(), 0..40);
    assert_eq!(more.missing().expect("read").len(), 4);
    drop(more);
    let grid = DesignBlock::List { key: "duration".to_owned(), values: vec![100.0, 200.0] };
    let other = campaign(Design::from_blocks([grid]));
    let other = Manifest::new(&other, 0..2, &Selection::ALL).expect("a manifest");
    let refused = Directory::create(&workspace.0, other.clone(), false).expect_err("another").to_string();
    assert!(
        refused.contains("another campaign (nothing before, duration = [100.0, 200.0] now)"),
        "{refused}"
    );
    let mut seeded = manifest(0..16);
    seeded.scenario = seeded.scenario.replace("seed = 7", "seed = 8");
    assert!(Manifest::parse(&seeded.to_toml()).expect_err("changed").contains("its hash does not match"));
    // A part of another campaign under the name of a part.
    let part = fs::read(workspace.0.join("runs/part-0000000000-0000000008.parquet")).expect("there");
    drop(Directory::create(&workspace.0, other, true).expect("replaced"));
    assert!(!workspace.0.join("runs/part-0000000000-0000000008.parquet").exists());
    fs::write(workspace.0.join("runs/part-0000000000-0000000002.parquet"), part).expect("written");
    let refused =
        Directory::open(&workspace.0).expect("there").column("run").expect_err("foreign").to_string();
    assert!(refused.contains("is not a part of the campaign"), "{refused}");
}

#[test]
fn a_run_is_the_same_whichever_are_made_beside_it() {
    use crate::campaign::{KeyRange, Sampling};
    for (_, sampling) in Sampling::ALL {
        let ranges = vec![
            KeyRange { key: "law.relay.weak".to_owned(), from: 1e-6, to: 2e-6 },
            KeyRange { key: "duration".to_owned(), from: 50.0, to: 100.0 },
        ];
        let block = DesignBlock::Sample { sampling, count: 20, ranges };
        let list = DesignBlock::List { key: "law.relay.strong".to_owned(), values: vec![3e-5, 4e-5] };
        let blocks = vec![block, list];
        let design = Design { draws: sampling, hypercube: 20, replicas: 3, blocks, ..Design::default() };
        let plan = campaign(design);
        assert_eq!(plan.design().runs(), Some(120));
        let drawn: Vec<_> = (0..120).map(|number| plan.draw(number)).collect();
        for (number, values) in drawn.iter().enumerate() {
            // Replicas are one point, and the list changes from point to point.
            assert_eq!(*values, drawn[number / 3 * 3], "{sampling:?}");
            let strong = [3e-5, 4e-5][number / 3 % 2];
            assert_eq!(values[2], toml::Value::Float(strong));
            assert_eq!(values[..2], drawn[number / 6 * 6][..2]);
        }
        assert_eq!(drawn[57], plan.draw(57));
    }
}
