//! `flexsc examples` and `flexsc new`: the scenarios that are built into the command, listed and copied.

use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::Document;
use serde_json::json;

use crate::cubesat::CubesatArgs;
use crate::error::CliError;
use crate::out::{self, Out};
use crate::{files, print, say};

/// Lists shipped scenarios by their names.
macro_rules! shipped {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../scenarios/", $name, ".toml")))),+]
    };
}

/// Name and text of each shipped scenario.
pub const EXAMPLES: &[(&str, &str)] = shipped![
    "adaptive-bandwidth",
    "agile-observer",
    "attitude-hold",
    "blinded-tracker",
    "bounded-jitter",
    "canted-jets",
    "detumble-and-point",
    "earth-observer",
    "earth-observer-lqg",
    "eclipse-snap",
    "false-readings",
    "field-aligned",
    "flexible-boom",
    "four-clamped-modes",
    "four-clamped-modes-faults",
    "ground-pass",
    "half-turn",
    "iss-delay-limit",
    "iss-identification",
    "iss-manoeuvre",
    "iss-manoeuvre-off",
    "iss-mismatch",
    "iss-ringdown",
    "iss-ringdown-off",
    "magnetic-unloading",
    "molniya",
    "momentum-unloading",
    "orbit-correction",
    "panel-deployment",
    "relay-adaptive",
    "relay-fixed",
    "relay-no-freeze",
    "relay-one-sided",
    "relay-quiet",
    "relay-sampled",
    "relay-wheel",
    "relays-three-axes",
    "rotation-cosine",
    "rotation-kinematic",
    "rotation-nonlinear",
    "rotation-panel-torque",
    "rotation-robust",
    "rotation-sine",
    "rotation-spin-up",
    "rotation-thrusters",
    "safe-mode",
    "cubesat-day",
    "cubesat-faults",
    "basilisk-momentum",
    "forty-two-leo",
    "s2e-sample",
    "shaped-slew",
    "site-pass",
    "slew-wheel-lqg",
    "solar-telescope",
    "station-keeping",
    "sun-tracking",
    "thruster-phase-plane",
    "two-line-orbit",
    "wheel-ekf",
    "wheel-fast-mode",
    "wheel-fixed-gain",
    "wheel-friction",
    "wheel-robust-gain",
    "wheel-run-up",
    "wheel-scheduled-gain",
    "wheel-settling-fit",
    "wheel-slow-mode",
    "wheel-unstable-band",
    "wheels-and-jets",
];

/// Default template of a new scenario.
const START: &str = "attitude-hold";

/// Copies of examples.
#[derive(clap::Args)]
pub struct ExamplesArgs {
    /// Examples to copy [default: list all]
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Directory for the copies, created if missing, or FILE.toml for one of them; without names all are copied [default: the current
    /// directory]
    #[arg(short, long, alias = "output", value_name = "DIR|FILE")]
    out: Option<PathBuf>,
    /// Replace files of other content
    #[arg(long)]
    force: bool,
    /// Print the list as JSON to stdout
    #[arg(long)]
    json: bool,
}

/// A new scenario.
#[derive(clap::Args)]
pub struct NewArgs {
    /// Name of the scenario, or path of its file
    name: PathBuf,
    /// Example to start from
    #[arg(long, value_name = "EXAMPLE", default_value = START)]
    like: String,
    #[command(flatten)]
    cubesat: CubesatArgs,
    /// Replace a file of other content
    #[arg(long)]
    force: bool,
}

/// Returns the text of an example.
pub fn text(name: &str) -> Result<&'static str, CliError> {
    let stem = name.strip_suffix(".toml").unwrap_or(name);
    let stem = stem.strip_prefix("scenarios/").unwrap_or(stem);
    let example = EXAMPLES.iter().find(|(example, _)| *example == stem);
    example.map(|(_, text)| *text).ok_or_else(|| {
        let names: Vec<&str> = EXAMPLES.iter().map(|(name, _)| *name).collect();
        let hint = flexsc_core::nearest(name, &names).map_or_else(
            || "`flexsc examples` lists them".to_owned(),
            |nearest| format!("did you mean `{nearest}`?"),
        );
        CliError::Arguments(format!("there is no example `{name}`\n\nhint: {hint}"))
    })
}

/// Returns a hint with the command that copies an example to a path; `None` if the path has a file or not the name of an example.
pub fn copy_hint(path: &Path) -> Option<String> {
    let stem = path.file_stem()?.to_str()?;
    let is_example = EXAMPLES.iter().any(|(example, _)| *example == stem);
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let into = directory.map_or_else(String::new, |parent| format!(" -o {}", parent.display()));
    (is_example && !path.exists()).then(|| format!("`flexsc examples {stem}{into}` copies this example"))
}

pub fn run(args: &ExamplesArgs) -> Result<(), CliError> {
    let Some(directory) = args.out.as_deref().or((!args.names.is_empty()).then_some(Path::new("."))) else {
        return list(args.json);
    };
    let out = Out::new(directory, &["toml"], &[])?;
    let all = || EXAMPLES.iter().map(|(name, _)| (*name).to_owned()).collect();
    let names: Vec<String> = if args.names.is_empty() { all() } else { args.names.clone() };
    if let (Out::File(path, _), [_, _, ..]) = (&out, &names[..]) {
        let why = "cannot contain several examples\n\nhint: give a directory";
        return Err(CliError::Arguments(format!("-o {}: {why}", path.display())));
    }
    let copies = names.iter().map(|name| {
        let stem = name.strip_suffix(".toml").unwrap_or(name);
        let path = match &out {
            Out::File(path, _) => path.clone(),
            Out::Directory(path) => path.join(format!("{stem}.toml")),
        };
        Ok((path, text(name)?.as_bytes()))
    });
    let copies = copies.collect::<Result<Vec<_>, CliError>>()?;
    for (path, text) in &copies {
        files::refuse_other(path, text, args.force)?;
    }
    for (path, text) in &copies {
        files::write(path, text, args.force)?;
        say!("{}", path.display());
    }
    Ok(())
}

pub fn new(args: &NewArgs) -> Result<(), CliError> {
    let example = text(&args.like)?;
    let path = match out::ending(&args.name) {
        Some("toml") => args.name.clone(),
        Some(other) => {
            let path = args.name.display();
            return Err(CliError::Arguments(format!("{path}: a scenario ends in .toml, not in .{other}")));
        }
        None => {
            let mut name = args.name.clone().into_os_string();
            name.push(".toml");
            PathBuf::from(name)
        }
    };
    let (text, source) = if args.cubesat.cubesat {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        (args.cubesat.text(&name)?, "a CubeSat with typical values".to_owned())
    } else {
        (example.to_owned(), format!("a copy of {}", args.like))
    };
    files::write(&path, text.as_bytes(), args.force)?;
    say!("{}: {source}; next: flexsc simulate {}", path.display(), path.display());
    Ok(())
}

/// Prints the name and the description of each example.
fn list(as_json: bool) -> Result<(), CliError> {
    let mut lines = String::new();
    let widest = EXAMPLES.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let mut objects = Vec::new();
    for (name, text) in EXAMPLES {
        let document = Document::parse(name, (*text).to_owned())?;
        let description = document.text_of("about").unwrap_or_default();
        objects.push(json!({ "name": name, "about": description }));
        let _ = writeln!(lines, "{name:widest$}  {description}");
    }
    if as_json {
        return print(format!("{}\n", json!(objects)).as_bytes());
    }
    print(lines.as_bytes())
}
