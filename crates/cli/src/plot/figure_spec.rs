//! Declaration of a figure of a log: its name, what it needs, and how it is drawn.

use flexsc_figure::Figure;

use super::cycle_data::{CycleData, RowSource};
use super::judged_run::JudgedRun;
use super::motion::MotionData;
use super::run_events::RunEvents;

/// Declaration of a figure.
pub struct FigureSpec {
    /// Name as `--what` accepts it.
    pub name: &'static str,
    /// Contents, as `--help` lists them.
    pub contents: &'static str,
    /// Rows of a three-axis run that the figure shows.
    pub rows: &'static [RowSource],
    /// Part of the motion of a one-axis run that the figure shows.
    pub motion: MotionPart,
    /// Returns true if a log has the data of the figure.
    pub is_in: fn(&RunEvents) -> bool,
    /// Draws the figure of a log.
    pub draw: fn(&RunData<'_>) -> Figure,
}

/// Part of the motion of a run.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MotionPart {
    /// None: the figure shows events and steps of the adaptation alone.
    Nothing,
    /// The whole run without a switching law; with one, its switchings suffice.
    Unswitched,
    /// The whole run without a switching law; with one, its start and its end.
    Ends,
    /// The whole run.
    All,
}

/// Rows of a run for its figures.
pub struct RunData<'a> {
    /// Scenario, switchings and steps of the adaptation.
    pub story: &'a RunEvents,
    /// Motion about one axis.
    pub motion: &'a MotionData,
    /// Rows of three axes.
    pub cycles: &'a CycleData,
    /// Signals and robustness of requirements over time.
    pub judged: &'a JudgedRun,
}
