//! The figures that logs and campaigns have, in the order in which they are listed.

use std::sync::LazyLock;

use clap::ValueEnum;
use clap::builder::PossibleValue;

use super::figure_spec::FigureSpec;
use super::run_events::RunEvents;
use super::{
    accelerations, angle, consistency, deflection, drives, envelope, estimate, extra_loop, fine_mirror,
    flywheel, frequency, gain, gimbals, hinges, line_of_sight, magnetorquers, modes, orbit, outputs,
    phase_plane, pointing, requirement, three_axis, torque, torques,
};

/// The figures of logs, in the order in which they are listed and drawn.
const LOG_FIGURES: [&FigureSpec; 30] = [
    &phase_plane::SPEC,
    &torque::SPEC,
    &angle::SPEC,
    &outputs::SPEC,
    &envelope::SPEC,
    &gain::SPEC,
    &modes::SPEC,
    &pointing::SPEC,
    &three_axis::RATES,
    &torques::SPEC,
    &deflection::SPEC,
    &three_axis::ENERGY,
    &three_axis::POSITION,
    &three_axis::JETS,
    &three_axis::TRACKING,
    &three_axis::DAMPING,
    &flywheel::SPEC,
    &gimbals::SPEC,
    &magnetorquers::SPEC,
    &accelerations::SPEC,
    &line_of_sight::SPEC,
    &fine_mirror::SPEC,
    &orbit::SPEC,
    &drives::SPEC,
    &hinges::SPEC,
    &frequency::SPEC,
    &estimate::SPEC,
    &consistency::SPEC,
    &extra_loop::SPEC,
    &requirement::SPEC,
];

/// Figure of a campaign.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
pub enum CampaignFigure {
    /// Campaigns: histogram and empirical distribution of each metric, with median, 5 % and 95 %
    Distribution,
    /// Campaigns: each metric against the keys that were drawn
    Scatter,
    /// Campaigns with logs: median, 25 to 75 % and 5 to 95 % of the main signals over time
    Fan,
    /// Sweeps over one key: each metric over the key
    Curve,
    /// Sweeps over two keys: each metric as a map
    Region,
}

/// A figure that `--what` names.
#[derive(Copy, Clone)]
pub enum FigureKind {
    /// Figure of a log.
    Log(&'static FigureSpec),
    /// Figure of a campaign.
    Campaign(CampaignFigure),
}

/// All kinds, in the order in which they are listed.
static KINDS: LazyLock<Vec<FigureKind>> = LazyLock::new(|| {
    let of_campaigns = CampaignFigure::value_variants().iter().copied().map(FigureKind::Campaign);
    LOG_FIGURES.into_iter().map(FigureKind::Log).chain(of_campaigns).collect()
});

impl ValueEnum for FigureKind {
    fn value_variants<'a>() -> &'a [Self] {
        &KINDS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::Log(spec) => Some(PossibleValue::new(spec.name).help(spec.contents)),
            Self::Campaign(figure) => figure.to_possible_value(),
        }
    }
}

impl PartialEq for FigureKind {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for FigureKind {}

impl std::fmt::Debug for FigureKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.name())
    }
}

impl FigureKind {
    /// Returns the figures that a log has.
    pub fn all_in(story: &RunEvents) -> Vec<Self> {
        LOG_FIGURES.into_iter().filter(|spec| (spec.is_in)(story)).map(Self::Log).collect()
    }

    /// Returns the figures that are drawn if none is named: deflections in place of elastic energies, and no requirements over
    /// time, for which each run is repeated.
    pub fn usual_in(story: &RunEvents) -> Vec<Self> {
        let is_replaced = |kind: &Self| {
            let is_energy = kind.log_spec().is_some_and(|spec| spec.name == three_axis::ENERGY.name);
            let is_judged = kind.log_spec().is_some_and(|spec| spec.name == requirement::SPEC.name);
            is_judged || is_energy && (deflection::SPEC.is_in)(story) && !story.scenario.study.fires()
        };
        Self::all_in(story).into_iter().filter(|kind| !is_replaced(kind)).collect()
    }

    /// Returns the declaration of the figure of a log.
    pub fn log_spec(self) -> Option<&'static FigureSpec> {
        if let Self::Log(spec) = self { Some(spec) } else { None }
    }

    /// Returns the name of the figure as `--what` accepts it.
    pub fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
}

/// Returns the requested figures of the existing ones: all if none is requested.
pub fn select(
    requested: &[FigureKind],
    drawable: &[FigureKind],
) -> Result<Vec<FigureKind>, (String, String)> {
    match requested.iter().find(|kind| !drawable.contains(kind)) {
        Some(missing) => {
            let names: Vec<_> = drawable.iter().map(|kind| kind.name()).collect();
            Err((missing.name(), names.join(", ")))
        }
        None if requested.is_empty() => Ok(drawable.to_vec()),
        None => {
            let once =
                |(index, kind): (usize, &FigureKind)| (!requested[..index].contains(kind)).then_some(*kind);
            Ok(requested.iter().enumerate().filter_map(once).collect())
        }
    }
}
