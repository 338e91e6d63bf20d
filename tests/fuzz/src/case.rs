//! Input of the fuzzer: the command's arguments, and the files in its directory.

use std::fs;
use std::io;
use std::path::Path;

/// Name of the file with the messages that a viewer sends to a live run.
pub const SENT: &str = "sent";
/// Name of the file with the packets of a client to a run in lockstep.
pub const PACKETS: &str = "packets";
/// Name of the file with the calls of an importer of an FMU.
pub const CALLS: &str = "calls";
const ARGUMENTS: &str = "arguments.json";
const FILES: &str = "files";

/// Method by which a command may be stopped.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Stop {
    /// A command that reads and answers needs no stop.
    Never,
    /// A command that may take long, and finishes its files when it is asked to stop.
    Asked,
    /// A command that may take long, and simply ends.
    Ended,
}

/// Input of the fuzzer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    pub arguments: Vec<String>,
    pub files: Vec<(String, Vec<u8>)>,
}

impl Case {
    /// Creates an input of these arguments, separated by blanks.
    pub fn new(arguments: &str, files: Vec<(String, Vec<u8>)>) -> Self {
        Self { arguments: arguments.split_whitespace().map(str::to_owned).collect(), files }
    }

    /// Returns the method by which the command may be stopped.
    pub fn stop(&self) -> Stop {
        match self.arguments.first().map_or("", |verb| verb) {
            "simulate" | "sweep" | "reproduce" if !self.is_live() => Stop::Asked,
            "plan" | "tune" | "map" | "damping" | "identify" | "observer" | "cycle" => Stop::Ended,
            // For a scenario the command makes a run.
            "layout" if self.arguments.iter().any(|a| a.to_ascii_lowercase().contains(".toml")) => {
                Stop::Ended
            }
            _ => Stop::Never,
        }
    }

    /// Returns true if the input is a viewer's messages.
    pub fn is_live(&self) -> bool {
        self.file(SENT).is_some()
    }

    /// Returns the content of a file.
    pub fn file(&self, name: &str) -> Option<&[u8]> {
        self.files.iter().find(|(n, _)| n == name).map(|(_, bytes)| &bytes[..])
    }

    /// Writes the files to the directory where the command runs.
    pub fn lay_out(&self, directory: &Path) -> io::Result<()> {
        for (name, bytes) in &self.files {
            let path = directory.join(name);
            if let Some(above) = path.parent() {
                fs::create_dir_all(above)?;
            }
            fs::write(path, bytes)?;
        }
        Ok(())
    }

    /// Saves the input.
    pub fn save(&self, directory: &Path) -> io::Result<()> {
        fs::create_dir_all(directory.join(FILES))?;
        self.lay_out(&directory.join(FILES))?;
        let arguments = serde_json::to_string(&self.arguments).map_err(io::Error::other)?;
        fs::write(directory.join(ARGUMENTS), arguments + "\n")
    }

    /// Loads a saved input.
    pub fn load(directory: &Path) -> io::Result<Self> {
        let arguments =
            serde_json::from_slice(&fs::read(directory.join(ARGUMENTS))?).map_err(io::Error::other)?;
        let mut files = Vec::new();
        gather(&directory.join(FILES), "", &mut files)?;
        Ok(Self { arguments, files })
    }
}

/// Appends all files in a directory, by their relative names, sorted.
pub fn gather(directory: &Path, within: &str, files: &mut Vec<(String, Vec<u8>)>) -> io::Result<()> {
    let mut entries = fs::read_dir(directory)?.collect::<io::Result<Vec<_>>>()?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let name = format!("{within}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            gather(&entry.path(), &format!("{name}/"), files)?;
        } else {
            files.push((name, fs::read(entry.path())?));
        }
    }
    Ok(())
}
