//! Requests of a page: check a scenario, run it, and show what is known of it and of its run.

use std::path::Path;

use flexsc_cli::{EditableStudy, RunClock, figures};
use flexsc_core::answer::{Answer, RunObserver, ScreenOptions};
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::record::{Detail, Log, LogBytes, RunEnd};
use flexsc_handover::{HandoverFormat, HandoverOptions, hand_over};
use flexsc_view::scene::Scene;
use flexsc_view::with_layout;
use serde::Deserialize;
use serde_json::{Value as Json, json};

/// Function that takes the part of a run that is done, from 0 to 1.
pub type ProgressReceiver = fn(f64);

/// Request of a page. What it asks for is of the scenario that was read last.
#[derive(Deserialize)]
#[serde(tag = "ask", rename_all = "kebab-case", deny_unknown_fields)]
enum Request {
    /// Reads a scenario: what `flexsc check --json` prints, with the ranges of the uncertain keys.
    Check { file: String, text: String },
    /// Runs it: its answer, the names of its figures, and the size of its log.
    Run,
    /// Figure of the run as SVG, whole or between two times (s).
    Figure { name: String, from: Option<f64>, to: Option<f64> },
    /// Block of the margins of a report.
    Margins,
    /// Block of the noise of a report.
    Noise,
    /// Block of the spacecraft of a report.
    Spacecraft,
    /// Style of the blocks.
    Style,
    /// Bytes of the log that `flexsc simulate` writes.
    Log,
    /// Motion of the spacecraft as a glTF model, from a run with its scene.
    Model,
    /// JSON Schema of scenarios.
    Schema,
    /// Names and texts of the example scenarios.
    Examples,
}

/// Scenario of a page, and its run.
pub struct Workbench {
    receiver: ProgressReceiver,
    study: Option<EditableStudy>,
    run: Option<FinishedRun>,
}

/// Run of the scenario.
struct FinishedRun {
    /// Bytes of the log that `flexsc simulate` writes.
    events: Vec<u8>,
    /// Log from which figures are drawn.
    full: Log,
}

/// Error of a request, in the words of the command.
type Failure = String;

impl Workbench {
    /// Returns a workbench without a scenario, with the receiver of the progress of its runs.
    pub fn new(receiver: ProgressReceiver) -> Self {
        Self { receiver, study: None, run: None }
    }

    /// Returns the result of a request: JSON, or bytes of a figure, a log or a model. `{"error": TEXT}` if it fails.
    pub fn answer(&mut self, request: &[u8]) -> Vec<u8> {
        let read = serde_json::from_slice(request).map_err(|error| error.to_string());
        read.and_then(|request| self.result(request))
            .unwrap_or_else(|why| json!({"error": why}).to_string().into_bytes())
    }

    fn result(&mut self, request: Request) -> Result<Vec<u8>, Failure> {
        Ok(match request {
            Request::Check { file, text } => self.check(&file, text).to_string().into_bytes(),
            Request::Run => self.run()?.to_string().into_bytes(),
            Request::Figure { name, from, to } => {
                let log = &self.finished()?.full;
                let figure = figures::log_figure_between(log, self.path()?, &name, [from, to])?;
                figure.svg()?.into_bytes()
            }
            Request::Margins => self.study()?.margins()?.into_bytes(),
            Request::Noise => self.study()?.noise()?.into_bytes(),
            Request::Spacecraft => self.study()?.spacecraft().into_bytes(),
            Request::Style => EditableStudy::STYLE.as_bytes().to_vec(),
            Request::Log => self.finished()?.events.clone(),
            Request::Model => self.model()?,
            Request::Schema => flexsc_core::Scenario::schema().to_string().into_bytes(),
            Request::Examples => json!(flexsc_cli::EXAMPLES).to_string().into_bytes(),
        })
    }

    fn study(&self) -> Result<&EditableStudy, Failure> {
        self.study.as_ref().ok_or_else(|| "no scenario has been accepted".to_owned())
    }

    fn finished(&self) -> Result<&FinishedRun, Failure> {
        self.run.as_ref().ok_or_else(|| "the scenario has not been run".to_owned())
    }

    fn path(&self) -> Result<&Path, Failure> {
        Ok(self.study()?.path())
    }

    fn check(&mut self, file: &str, text: String) -> Json {
        self.run = None;
        match EditableStudy::read(file, text) {
            Ok(study) => {
                let checked = study.checked();
                self.study = Some(study);
                checked
            }
            Err(refused) => {
                self.study = None;
                refused
            }
        }
    }

    fn campaign_run(&self) -> Result<CampaignRun, Failure> {
        let study = self.study()?;
        let campaign = Campaign::new(study.scenario().clone(), &study.path().to_string_lossy(), None);
        Ok(CampaignRun::new(campaign.map_err(|error| error.to_string())?.scenario().clone(), 0))
    }

    /// Returns the record that gives the progress of a run to the receiver.
    fn progress(&self, run: &CampaignRun) -> RunClock<impl FnMut(f64) + use<>> {
        let (receiver, duration) = (self.receiver, run.scenario.duration.seconds());
        RunClock::new(move |now| receiver(now / duration))
    }

    fn run(&mut self) -> Result<Json, Failure> {
        let run = self.campaign_run()?;
        let scenario = &run.scenario;
        let log = |detail: Detail| {
            let provenance = with_layout(Campaign::provenance(&run), scenario, detail);
            LogBytes::new(&provenance, detail).map_err(|error| error.to_string())
        };
        let (mut events, mut full) = (log(Detail::Events)?, log(Detail::Full)?);
        let mut observer = RunObserver::new(scenario);
        let progress = self.progress(&run);
        let records = ((&mut events, &mut full), (&mut observer, progress));
        let metrics = Campaign::simulate(&run, records).map_err(|error| error.to_string())?;
        let finished =
            |log: LogBytes| log.finish(&metrics, RunEnd::Complete).map_err(|error| error.to_string());
        let (events, full) = (finished(events)?, finished(full)?);
        let units = ReaderUnits::default();
        let answer = Answer::new(scenario, &metrics, Some(&observer.finish()), units);
        let screen = answer.screen(None, ScreenOptions { units, ..ScreenOptions::default() });
        let full = Log::read(self.path()?, full).map_err(|error| error.to_string())?;
        let result = json!({
            "answer": answer, "screen": screen, "log_bytes": events.len(),
            "figures": figures::names(&full, self.path()?, None)?,
        });
        self.run = Some(FinishedRun { events, full });
        Ok(result)
    }

    fn model(&self) -> Result<Vec<u8>, Failure> {
        let run = self.campaign_run()?;
        let provenance = with_layout(Campaign::provenance(&run), &run.scenario, Detail::Scene);
        let mut log = LogBytes::new(&provenance, Detail::Scene).map_err(|error| error.to_string())?;
        let scene = Scene::for_detail(&run.scenario, Detail::Scene);
        let progress = self.progress(&run);
        let metrics =
            Campaign::simulate(&run, ((&mut log, scene), progress)).map_err(|error| error.to_string())?;
        let bytes = log.finish(&metrics, RunEnd::Complete).map_err(|error| error.to_string())?;
        let log = Log::read(self.path()?, bytes).map_err(|error| error.to_string())?;
        hand_over(&log, HandoverFormat::Glb, &HandoverOptions::default()).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(workbench: &mut Workbench, request: &Json) -> Vec<u8> {
        workbench.answer(request.to_string().as_bytes())
    }

    fn read(workbench: &mut Workbench, text: &str) -> Json {
        let request = json!({"ask": "check", "file": "half-turn.toml", "text": text});
        serde_json::from_slice(&asked(workbench, &request)).expect("JSON")
    }

    fn example(name: &str) -> &'static str {
        flexsc_cli::EXAMPLES.iter().find(|(own, _)| *own == name).expect("an example").1
    }

    #[test]
    fn a_run_has_the_log_of_the_command_and_its_figures() {
        let mut workbench = Workbench::new(|_| ());
        let checked = read(&mut workbench, example("half-turn"));
        assert_eq!(checked["accepted"], true);
        assert!(checked["uncertain"][0]["line"].is_u64(), "{checked}");
        let result: Json =
            serde_json::from_slice(&asked(&mut workbench, &json!({"ask": "run"}))).expect("JSON");
        assert_eq!(result["answer"]["verdict"], "met");
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("half-turn.mcap");
        let run = workbench.campaign_run().expect("a run");
        flexsc_cli::simulate_to_log(&run, &path, (Detail::Events, false), ()).expect("a log");
        assert_eq!(asked(&mut workbench, &json!({"ask": "log"})), std::fs::read(path).expect("a file"));
        for name in result["figures"].as_array().expect("names") {
            let request = json!({"ask": "figure", "name": name, "from": 20.0, "to": null});
            assert!(asked(&mut workbench, &request).starts_with(b"<svg"), "{name}");
        }
        assert!(asked(&mut workbench, &json!({"ask": "model"})).starts_with(b"glTF"));
        for block in ["margins", "noise", "spacecraft"] {
            assert!(asked(&mut workbench, &json!({"ask": block})).starts_with(b"<"), "{block}");
        }
    }

    #[test]
    fn mistakes_have_lines_and_suggestions_and_end_the_last_run() {
        let mut workbench = Workbench::new(|_| ());
        read(&mut workbench, example("half-turn"));
        asked(&mut workbench, &json!({"ask": "run"}));
        let refused = read(&mut workbench, &example("half-turn").replacen("duration", "durration", 1));
        assert_eq!(refused["accepted"], false);
        let mistake = &refused["mistakes"][0];
        assert!(mistake["line"].is_u64() && mistake["suggestion"] == "duration", "{mistake}");
        let log = asked(&mut workbench, &json!({"ask": "log"}));
        assert_eq!(log, br#"{"error":"the scenario has not been run"}"#);
        let unknown = asked(&mut workbench, &json!({"ask": "nothing"}));
        assert!(unknown.starts_with(br#"{"error":"unknown variant"#));
    }
}
