//! An input: the command's arguments, and the files that lie where it runs.

use std::fs;
use std::io;
use std::path::Path;

/// The file that holds what a viewer sends to a live run.
pub const SENT: &str = "sent";
const ARGUMENTS: &str = "arguments.json";
const FILES: &str = "files";

/// How a command may be stopped.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Stop {
    /// It reads and answers: it has no need to be stopped.
    Never,
    /// It may work for long, and finishes its files when it is asked to stop.
    Asked,
    /// It may work for long, and simply ends.
    Ended,
}

/// An input.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    pub arguments: Vec<String>,
    pub files: Vec<(String, Vec<u8>)>,
}

impl Case {
    /// An input of these arguments, parted by blanks.
    pub fn new(arguments: &str, files: Vec<(String, Vec<u8>)>) -> Self {
        Self { arguments: arguments.split_whitespace().map(str::to_owned).collect(), files }
    }

    /// How its command may be stopped.
    pub fn stop(&self) -> Stop {
        match self.arguments.first().map_or("", |verb| verb) {
            "simulate" | "sweep" | "reproduce" if !self.is_live() => Stop::Asked,
            "plan" | "tune" | "map" | "damping" | "identify" | "observer" | "cycle" => Stop::Ended,
            // Of a scenario it is a run.
            "layout" if self.arguments.iter().any(|a| a.to_ascii_lowercase().contains(".toml")) => {
                Stop::Ended
            }
            _ => Stop::Never,
        }
    }

    /// Whether it is what a viewer sends.
    pub fn is_live(&self) -> bool {
        self.file(SENT).is_some()
    }

    /// What a file holds.
    pub fn file(&self, name: &str) -> Option<&[u8]> {
        self.files.iter().find(|(n, _)| n == name).map(|(_, bytes)| &bytes[..])
    }

    /// Writes the files to where the command runs.
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

    /// Keeps the input.
    pub fn save(&self, directory: &Path) -> io::Result<()> {
        fs::create_dir_all(directory.join(FILES))?;
        self.lay_out(&directory.join(FILES))?;
        let arguments = serde_json::to_string(&self.arguments).map_err(io::Error::other)?;
        fs::write(directory.join(ARGUMENTS), arguments + "\n")
    }

    /// Reads an input that was kept.
    pub fn load(directory: &Path) -> io::Result<Self> {
        let arguments =
            serde_json::from_slice(&fs::read(directory.join(ARGUMENTS))?).map_err(io::Error::other)?;
        let mut files = Vec::new();
        gather(&directory.join(FILES), "", &mut files)?;
        Ok(Self { arguments, files })
    }
}

/// All files in a directory, by their names within, sorted.
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
