//! Sections of a report: each is the output of commands of this program, which are run as a user runs them.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;
use std::{env, fs, thread};

use crate::error::CliError;
use crate::{say, stop};

/// Period at which the end of a command is looked for.
const POLL_PERIOD: Duration = Duration::from_millis(5);

/// ReportSection of a report.
pub struct ReportSection {
    /// Title of the section.
    pub title: &'static str,
    /// Paragraph under the title.
    pub intro: String,
    /// Output of a command and the figures that it drew.
    pub blocks: Vec<ReportBlock>,
}

/// Output of a command.
pub struct ReportBlock {
    /// The command as a user types it.
    pub command: String,
    /// The text that it printed.
    pub text: String,
    /// Figures, as SVG.
    pub figures: Vec<String>,
    /// True if the command ended with an error: the text is the reason.
    pub is_refused: bool,
    /// True if a requirement is not met, or a claim not proved.
    pub is_unmet: bool,
}

/// Runner of the commands of a report.
pub struct ReportRunner<'a> {
    program: Vec<OsString>,
    scenario: &'a Path,
    set: &'a [String],
    scratch: &'a Path,
}

impl ReportSection {
    /// Returns true if a command of the section found a requirement that is not met, or a claim that is not proved.
    pub fn is_unmet(&self) -> bool {
        self.blocks.iter().any(|block| block.is_unmet)
    }

    /// Returns true if a command of the section ended with an error.
    pub fn is_refused(&self) -> bool {
        self.blocks.iter().any(|block| block.is_refused)
    }
}

impl<'a> ReportRunner<'a> {
    /// Creates the runner for a scenario with keys set; commands write into a scratch directory.
    pub fn new(scenario: &'a Path, set: &'a [String], scratch: &'a Path) -> Self {
        // In a wheel, the program is a module of Python.
        let program = match env::var_os("FLEXSC_PYTHON") {
            Some(python) => vec![python, "-m".into(), "flexsc".into()],
            None => vec![env::current_exe().unwrap_or_else(|_| PathBuf::from("flexsc")).into()],
        };
        Self { program, scenario, set, scratch }
    }

    /// Returns the section of a command that prints, and draws into a directory of this name.
    pub fn printed(
        &self,
        title: &'static str,
        intro: &str,
        verb: &[&str],
        figures: Option<&str>,
    ) -> Result<ReportSection, CliError> {
        let block = self.analysis(verb, figures)?;
        Ok(ReportSection { title, intro: intro.to_owned(), blocks: vec![block] })
    }

    /// Returns the section of one run, with its figures.
    pub fn simulated(&self, title: &'static str, intro: &str) -> Result<ReportSection, CliError> {
        let log = self.scratch.join("run.mcap");
        let mut block = self.block(&["simulate"], &[], &[("-o", &log)], "-o run.mcap")?;
        block.text = without_times(&block.text, "run.mcap");
        let mut blocks = vec![block];
        if log.exists() {
            blocks.push(self.figures_of(&log, "run.mcap", "run")?);
        }
        Ok(ReportSection { title, intro: intro.to_owned(), blocks })
    }

    /// Returns the section of a campaign, with its figures.
    pub fn campaign(&self, title: &'static str, intro: &str, runs: u64) -> Result<ReportSection, CliError> {
        let directory = self.scratch.join("campaign");
        let count = runs.to_string();
        let shown = format!("--runs {runs} -o campaign");
        let hidden = ["--runs", &count];
        let mut block = self.block(&["simulate"], &hidden, &[("-o", &directory)], &shown)?;
        block.text = without_times(&block.text, "campaign");
        let mut blocks = vec![block];
        if directory.exists() {
            let mut figures = self.figures_of(&directory, "campaign", "spread")?;
            // The worst runs are listed with commands on files that the page does not have.
            figures.text = String::new();
            blocks.push(figures);
        }
        Ok(ReportSection { title, intro: intro.to_owned(), blocks })
    }

    fn analysis(&self, verb: &[&str], figures: Option<&str>) -> Result<ReportBlock, CliError> {
        let Some(name) = figures else { return self.block(verb, &[], &[], "") };
        let directory = self.scratch.join(name);
        let shown = format!("-o {name}");
        let mut block = self.block(verb, &["--format", "svg"], &[("-o", &directory)], &shown)?;
        block.figures = drawn(&directory);
        let is_file_line = |line: &&str| !line.contains(&directory.display().to_string());
        block.text = block.text.lines().filter(is_file_line).collect::<Vec<_>>().join("\n");
        Ok(block)
    }

    /// Returns the figures of a log or a campaign.
    fn figures_of(&self, source: &Path, shown: &str, name: &str) -> Result<ReportBlock, CliError> {
        let directory = self.scratch.join(name);
        let mut command = self.command();
        command.arg("plot").arg(source).arg("-o").arg(&directory).args(["--format", "svg"]);
        let output = self.output(command)?;
        let is_refused = !output.status.success();
        let text = if is_refused { text_of(&output) } else { String::new() };
        Ok(ReportBlock {
            command: format!("flexsc plot {shown} -o {name}"),
            text: text.replace(&source.display().to_string(), shown),
            figures: drawn(&directory),
            is_refused,
            is_unmet: false,
        })
    }

    /// Runs a verb on the scenario with further arguments, of which the page shows `shown`.
    fn block(
        &self,
        verb: &[&str],
        hidden: &[&str],
        paths: &[(&str, &Path)],
        shown: &str,
    ) -> Result<ReportBlock, CliError> {
        let mut command = self.command();
        command.arg(verb[0]).arg(self.scenario).args(&verb[1..]).args(hidden);
        for (option, path) in paths {
            command.arg(option).arg(path);
        }
        for pair in self.set {
            command.arg("--set").arg(pair);
        }
        let name =
            self.scenario.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let rest = verb[1..].iter().map(|word| (*word).to_owned());
        let set = self.set.iter().map(|pair| format!("--set '{pair}'"));
        let words = ["flexsc".to_owned(), verb[0].to_owned(), name].into_iter().chain(rest).chain(set);
        let words: Vec<String> = words.chain((!shown.is_empty()).then(|| shown.to_owned())).collect();
        say!("  {}", words.join(" "));
        let output = self.output(command)?;
        // A requirement that is missed has an exit code of its own.
        let code = output.status.code();
        Ok(ReportBlock {
            command: words.join(" "),
            text: text_of(&output),
            figures: Vec::new(),
            is_refused: !matches!(code, Some(0 | 3)),
            is_unmet: code == Some(3),
        })
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.program[0]);
        command.args(&self.program[1..]).env("NO_COLOR", "1").env_remove("CLICOLOR_FORCE");
        // The pipe is closed by the death of this process, with which the command ends.
        command.stdin(Stdio::piped()).env(stop::UNTIL_STDIN_CLOSES, "1");
        command
    }

    /// Runs a command to its end, or stops it if the user asks for it.
    fn output(&self, mut command: Command) -> Result<Output, CliError> {
        let program = PathBuf::from(&self.program[0]);
        let failed =
            |error: io::Error| CliError::Arguments(format!("cannot run {}: {error}", program.display()));
        // Files, and not pipes, whose reader would have to wait for the end.
        let printed = ["stdout", "stderr"].map(|name| self.scratch.join(name));
        let [out, err] = [0, 1].map(|which| File::create(&printed[which]));
        command.stdout(out.map_err(failed)?).stderr(err.map_err(failed)?);
        let mut child = command.spawn().map_err(failed)?;
        let status = loop {
            match child.try_wait().map_err(failed)? {
                Some(status) => break status,
                None if stop::stop_requested() => {
                    // It may have ended in the meantime.
                    let _ = child.kill().and_then(|()| child.wait());
                    return Err(CliError::Interrupted(String::new()));
                }
                None => thread::sleep(POLL_PERIOD),
            }
        };
        let [stdout, stderr] = [0, 1].map(|which| fs::read(&printed[which]));
        Ok(Output { status, stdout: stdout.map_err(failed)?, stderr: stderr.map_err(failed)? })
    }
}

/// Returns what a command printed for people.
fn text_of(output: &Output) -> String {
    let text =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat();
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("progress:")).collect();
    lines.join("\n").trim_end().to_owned()
}

/// Returns the SVG figures in a directory, in the order of their names.
fn drawn(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut paths: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|ending| ending == "svg")).collect();
    paths.sort();
    paths.iter().filter_map(|path| fs::read_to_string(path).ok()).collect()
}

/// Returns the text of a run without what differs from one computer to the next: the time that it took, and the line of
/// its file.
fn without_times(text: &str, file: &str) -> String {
    let is_time = |text: &str| {
        let (number, unit) = text.split_once(' ').unwrap_or_default();
        number.parse::<f64>().is_ok() && ["ms", "s", "min", "h", "days"].contains(&unit)
    };
    let mut lines: Vec<String> =
        text.lines().filter(|line| !line.contains(file)).map(ToOwned::to_owned).collect();
    // A long verdict has its time in the next line.
    for line in lines.iter_mut().take(2) {
        if let Some((before, _)) = line.rsplit_once(" in ").filter(|(_, last)| is_time(last)) {
            // The gap before it is as wide as the time leaves room.
            let (left, right) = before.rsplit_once("   ").unwrap_or(("", before));
            *line = if left.trim().is_empty() {
                before.to_owned()
            } else {
                format!("{}   {right}", left.trim_end())
            };
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_left_out() {
        let text = "a   1 of 1 requirement met       300 s simulated in 74 ms\n\n  pointing  7 arcsec\n  log /tmp/x/run.mcap, 13 kB";
        let kept = "a   1 of 1 requirement met   300 s simulated\n\n  pointing  7 arcsec";
        assert_eq!(without_times(text, "run.mcap"), kept);
        assert_eq!(
            without_times("b   met\n    300 s simulated in 0.51 s", "x"),
            "b   met\n    300 s simulated"
        );
        assert_eq!(without_times("c   8 runs in 5 min", "x"), "c   8 runs");
        assert_eq!(without_times("d   missed in all", "x"), "d   missed in all");
    }
}
