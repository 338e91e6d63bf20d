use flexsc_core::Scenario;
use flexsc_export_c::control_system::ControlSystem;
use flexsc_export_c::vectors;
#[test]
fn try_all() {
    for entry in std::fs::read_dir("../../scenarios").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let scenario = Scenario::load(&path).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        match ControlSystem::new(&scenario) {
            Err(e) => println!("{name}: refused {e}"),
            Ok(_) => match vectors::record(&scenario, 2000) {
                Ok(v) => println!("{name}: {} calls", v.len()),
                Err(e) => println!("{name}: ERROR {e}"),
            },
        }
    }
}
