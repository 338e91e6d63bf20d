//! Sequences of calls of the fuzzer: none of them panics, hangs or breaks a state.

use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

#[path = "../../../../tests/fuzz/src/fmu_importer.rs"]
mod fmu_importer;

const CORPUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fuzz/corpus/fmus");
/// Time limit of a sequence, while other tests run.
const PATIENCE: Duration = Duration::from_secs(20);

#[test]
fn calls_of_the_fuzzer_end_with_a_status() {
    let entries = std::fs::read_dir(CORPUS).expect("the corpus");
    let inputs: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path().join("files")).collect();
    assert!(!inputs.is_empty());
    for input in inputs {
        let calls = std::fs::read_to_string(input.join("calls")).expect("calls");
        let (sender, receiver) = channel();
        let resources = input.join("resources");
        thread::spawn(move || sender.send(fmu_importer::play(&calls, Path::new(&resources))));
        let Ok(wrong) = receiver.recv_timeout(PATIENCE) else {
            panic!("{}: still there after {PATIENCE:?}", input.display());
        };
        assert_eq!(wrong, None, "{}", input.display());
    }
}
