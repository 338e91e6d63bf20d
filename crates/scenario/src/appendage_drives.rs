//! Appendage drives of a scenario: their angles over the run, known before it begins.

use std::sync::Arc;

use flexsc_control::drive_profile::{DriveProfile, DriveProfiles, SunTracking};
use flexsc_control::law::TargetFrame;
use flexsc_dynamics::three_axis::ArticulatedBody;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::time::{Instant, Span};
use flexsc_numerics::time_arcs::TimeArcs;
use flexsc_spacecraft::body::BodyModel;
use flexsc_spacecraft::body::craft::{Appendage, AppendageDrive, DrivePiece, TrackedObject};
use nalgebra::Quaternion;

use super::{ResolvedScenario, ScenarioSpec};

/// Largest change of a drive angle (rad) before the modes are replaced by those of another angle.
const APART: f64 = 1.0 / 32.0;

/// Largest number of such changes in a run.
const MOST_CHANGES: f64 = 1e6;

/// Smallest sine of the angle between the Sun and the axis of a drive that tracks it.
const ACROSS: f64 = 0.1;

/// Number of intervals of a run at whose ends the rates of Sun-tracking drives are sampled.
const LOOKS: u32 = 4096;

/// Appendage drives of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct AppendageDrives {
    /// Model of the spacecraft with appendages that rotate on drives or hinges.
    pub driven: Arc<ArticulatedBody>,
    /// Angles of the drives over time.
    pub courses: Arc<DriveProfiles>,
}

impl ResolvedScenario {
    /// Returns the drives; `None` if appendages only swing on hinges, or are fixed.
    pub fn articulation(&self) -> Option<&AppendageDrives> {
        self.drives.as_ref().filter(|drives| drives.courses.count() > 0)
    }

    /// Returns the number of appendages that swing on hinges.
    pub fn hinges(&self) -> usize {
        self.drives.as_ref().map_or(0, |drives| drives.driven.hinges())
    }
}

impl ScenarioSpec {
    /// Returns the drive angles at the start (rad), 0 for appendages without a drive.
    pub(super) fn start_angles(&self) -> Result<Vec<f64>, ConfigError> {
        let angle = |index| Ok(self.course(index)?.map_or(0.0, |course| course.at(0.0)[0]));
        (0..self.appendage.len()).map(angle).collect()
    }

    /// Returns the angle of an appendage's drive over time; `None` without a drive.
    fn course(&self, index: usize) -> Result<Option<DriveProfile>, ConfigError> {
        let appendage = &self.appendage[index];
        let Some(drive) = &appendage.drive else { return Ok(None) };
        let within = |fault: ConfigError| fault.within(&format!("appendage[{index}].drive"));
        drive.validate().map_err(within)?;
        if drive.track == Some(TrackedObject::Sun) {
            return self.following(appendage, drive).map(Some).map_err(within);
        }
        // Times are rounded to instants of the run.
        let rounded = |[from, angle, rate, acceleration]: DrivePiece| {
            [Span::from_seconds(from).seconds(), angle, rate, acceleration]
        };
        Ok(Some(DriveProfile::Pieces(drive.profile().into_iter().map(rounded).collect())))
    }

    fn following(&self, appendage: &Appendage, drive: &AppendageDrive) -> Result<DriveProfile, ConfigError> {
        let sky = self.orbit_environment();
        let Some(sun) = sky.sun().copied() else {
            return Err(ConfigError::new("track", "follows `environment.sun`, and there is none"));
        };
        let targets = self.targets();
        let known = match targets {
            [] => true,
            [only] => only.starts() == Instant::START && only.table.is_empty() && only.acceleration.is_none(),
            _ => false,
        };
        if !known {
            let why = "follows the Sun from one `[[target]]` that holds from the start on: the angle has to be known before the \
                       run; write it as a `table`";
            return Err(ConfigError::new("track", why));
        }
        let target = targets.first();
        let frame = target.map_or(TargetFrame::INERTIAL, flexsc_control::law::AttitudeTarget::target_frame);
        if frame.validate(&sky, 0.0).is_some() {
            return Err(ConfigError::new("track", "needs the axes that the target is from"));
        }
        let following = SunTracking {
            sky,
            sun,
            frame,
            attitude: target.map_or_else(Quaternion::identity, flexsc_control::law::AttitudeTarget::attitude),
            axes: appendage.turned.matrix(),
            about: drive.axis(),
            facing: drive.sun_facing(),
            arcs: TimeArcs::default(),
        };
        let least = looks(self.duration).map(|t| following.across(t)).fold(1.0, f64::min);
        if least < ACROSS {
            let why = format!(
                "cannot follow a Sun along the drive's axis: the sine of the angle between them comes down to {least:.3}, and must \
                 stay above {ACROSS}"
            );
            return Err(ConfigError::new("track", why));
        }
        Ok(DriveProfile::Sun(Box::new(following)))
    }

    /// Returns all drives of the run; `None` if no appendage rotates.
    pub(super) fn drives(&self, model: &BodyModel) -> Result<Option<AppendageDrives>, ConfigError> {
        let Some(driven) = model.three_axis().and_then(|body| body.articulation.clone()) else {
            return Ok(None);
        };
        let (mut each, mut fastest, mut edges) = (Vec::new(), 0.0_f64, vec![Instant::START]);
        let end = Instant::START + self.duration;
        for index in 0..self.appendage.len() {
            let Some(course) = self.course(index)? else { continue };
            let most = match &course {
                DriveProfile::Pieces(pieces) => {
                    edges.extend(pieces.iter().map(|piece| Instant::START + Span::from_seconds(piece[0])));
                    pieces.iter().map(|piece| piece[2].abs()).fold(0.0, f64::max)
                }
                // The margin covers rates between the sampled instants.
                DriveProfile::Sun(following) => {
                    1.1 * looks(self.duration).map(|t| following.at(t)[1].abs()).fold(0.0, f64::max)
                }
            };
            self.too_fast(index, most)?;
            fastest = fastest.max(most);
            each.push(course);
        }
        edges.push(end);
        edges.retain(|edge| *edge <= end);
        edges.sort();
        edges.dedup();
        if fastest * self.duration.seconds() / APART > MOST_CHANGES {
            let why = format!(
                "turns by {:.0} rad in this run: too much to follow",
                fastest * self.duration.seconds()
            );
            return Err(ConfigError::new("appendage", why));
        }
        let mut changes = Vec::new();
        for pair in edges.windows(2) {
            let [from, to] = [pair[0].seconds(), pair[1].seconds()];
            let parts = libm::ceil(fastest * (to - from) / APART).max(1.0) as u32;
            for part in 0..parts {
                let at = |part: f64| from + (to - from) * part / f64::from(parts);
                let instant = if part == 0 {
                    pair[0]
                } else {
                    Instant::START + Span::from_seconds(at(f64::from(part)))
                };
                changes.push((instant, at(f64::from(part) + 0.5)));
            }
        }
        Ok(Some(AppendageDrives { driven, courses: Arc::new(DriveProfiles { each, fastest, changes }) }))
    }

    /// Checks that a drive is slow enough for the modes of its appendage.
    fn too_fast(&self, index: usize, most: f64) -> Result<(), ConfigError> {
        let clamped = self.appendage[index].clamped_modes();
        let factor =
            self.spacecraft.as_ref().map_or(1.0, |craft| craft.frequency_factor(&self.appendage[index]));
        let own = clamped.iter().map(|mode| mode.frequency.get());
        let limit = 0.2 * own.fold(f64::INFINITY, f64::min) * factor;
        if most <= limit {
            return Ok(());
        }
        let why = format!(
            "must be slower than {limit:.4} rad/s, a fifth of the lowest frequency with the root clamped, got {most:.4}: above it, the \
             model neglects too much"
        );
        Err(ConfigError::new(format!("appendage[{index}].drive.rate"), why))
    }
}

/// Returns evenly spaced instants of a run (s), start and end included.
fn looks(duration: Span) -> impl Iterator<Item = f64> {
    let end = duration.seconds();
    (0..=LOOKS).map(move |look| end * f64::from(look) / f64::from(LOOKS))
}

#[cfg(test)]
mod tests;
