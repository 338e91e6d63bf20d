//! Writes the functions of `flexsc-flight` in single precision: the same text with `f32` for `f64`, but for the functions of
//! mathematics in `src/single`, and the conversions of its structs and enums.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs, io};

/// Files that have a text of their own in single precision, with the name there.
const OWN: [(&str, &str); 4] = [
    ("binary64", "binary32"),
    ("inverse_trigonometry", "inverse_trigonometry"),
    ("square_root", "square_root"),
    ("trigonometry", "trigonometry"),
];

/// Files that only functions of mathematics in double precision need.
const LEFT_OUT: [&str; 6] =
    ["argument_reduction", "exponentials", "hypotenuse", "integer_square_root", "lib", "payne_hanek"];

fn main() -> io::Result<()> {
    let root = env::var("CARGO_MANIFEST_DIR").map_err(io::Error::other)?;
    let out = env::var("OUT_DIR").map_err(io::Error::other)?;
    let flight = Path::new(&root).join("../flight/src");
    println!("cargo::rerun-if-changed={}", flight.display());
    println!("cargo::rerun-if-changed=src/single");
    let mut names = Vec::new();
    for entry in fs::read_dir(&flight)? {
        let path = entry?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_file() && !LEFT_OUT.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names.sort_unstable();
    let (mut modules, mut sources, mut twins) = (String::new(), String::new(), String::new());
    for name in &names {
        let own = OWN.iter().find(|(double, _)| double == name).map(|(_, single)| *single);
        let text = match own {
            Some(single) => fs::read_to_string(Path::new(&root).join(format!("src/single/{single}.rs")))?,
            None => in_single(&fs::read_to_string(flight.join(format!("{name}.rs")))?),
        };
        if own.is_none() {
            conversions(name, &text, &mut twins);
        }
        let source = match own {
            Some(single) => format!("crates/flight-precision/src/single/{single}.rs"),
            None => format!("crates/flight/src/{name}.rs, in single precision"),
        };
        let name = own.unwrap_or(name);
        let path = Path::new(&out).join(format!("{name}.rs"));
        fs::write(&path, &text)?;
        let path = path.display().to_string();
        let _ = writeln!(modules, "#[path = {path:?}]\npub mod {name};");
        let _ = writeln!(sources, "    ({name:?}, {source:?}, include_str!({path:?})),");
    }
    let all = format!(
        "{modules}\n/// Files of the functions in single precision: names, files of the repository, and texts.\npub const SOURCES: [(&str, &str, &str); {}] = [\n{sources}];\n\n{twins}",
        names.len()
    );
    fs::write(Path::new(&out).join("functions.rs"), all)
}

/// Returns the text of a file in single precision, without its tests.
fn in_single(text: &str) -> String {
    let text = text.split("\n#[cfg(test)]").next().unwrap_or_default();
    let text = text.replace("f64::from(", "crate::binary32::single(").replace("binary64", "binary32");
    text.replace("f64", "f32") + "\n"
}

/// Writes the conversions of the public structs and enums of a file.
fn conversions(module: &str, text: &str, twins: &mut String) {
    for kind in ["struct", "enum"] {
        for item in text.split(&format!("\npub {kind} ")).skip(1) {
            let Some((name, body)) = item.split_once(" {\n") else { continue };
            let lines = body.split("\n}").next().unwrap_or_default().lines();
            let members = lines.filter_map(|line| {
                let line = line.trim();
                let member = line.strip_prefix("pub ").unwrap_or(line);
                let end = member.find([':', ',', ' ']).unwrap_or(member.len());
                let is_member = !member.starts_with("//") && !member.starts_with('#') && end > 0;
                is_member.then(|| member[..end].to_owned())
            });
            let members: Vec<String> = members.collect();
            conversion(kind, &format!("{module}::{name}"), &members, twins);
        }
    }
}

/// Writes the conversion of a struct or enum with these members or variants.
fn conversion(kind: &str, path: &str, members: &[String], twins: &mut String) {
    let each = |text: &dyn Fn(&str) -> String| members.iter().map(|member| text(member)).collect::<String>();
    let (to, from) = if kind == "struct" {
        (
            format!("crate::{path} {{ {} }}", each(&|name| format!("{name}: self.{name}.single(), "))),
            format!("Self {{ {} }}", each(&|name| format!("{name}: Twin::double(&single.{name}), "))),
        )
    } else {
        (
            format!("match self {{ {} }}", each(&|name| format!("Self::{name} => crate::{path}::{name}, "))),
            format!(
                "match single {{ {} }}",
                each(&|name| format!("crate::{path}::{name} => Self::{name}, "))
            ),
        )
    };
    let _ = writeln!(
        twins,
        "impl Twin for flexsc_flight::{path} {{\n    type Single = crate::{path};\n\n    #[inline]\n    fn single(&self) -> Self::Single {{\n        {to}\n    }}\n\n    \
         #[inline]\n    fn double(single: &Self::Single) -> Self {{\n        {from}\n    }}\n}}\n"
    );
}
