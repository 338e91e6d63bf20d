//! Line of sight of an instrument: where it looks, how often it is recorded, and its assessment.

use flexsc_control::offers::Offers;
use flexsc_control::requirement::OFF_HUB;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_formats::reader_units::number;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Positive, Time};
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fine_mirror::FineMirror;
use super::measured_path::MeasuredPath;
use super::optics::{self, LineSensitivity, OpticalElement};

/// Part of a sample by which a rounded window may miss the next one.
const ROUNDING: f64 = 1e-9;
/// Difference of a rotation by optics from that of the body (rad/rad) from which it is remarked.
const DEVIATION: f64 = 1e-3;
/// Names of the axes.
const AXIS_NAMES: [&str; 3] = ["x", "y", "z"];

/// Line of sight of an instrument at a named point of a three-axis body, which is recorded and assessed. Nothing in the
/// control loop reads it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineOfSight {
    /// Point of the structure at which the instrument is mounted.
    pub point: String,
    /// Direction of the line of sight, of any length, in the body's axes with the structure undeformed.
    #[serde(default = "z_axis")]
    pub axis: [Finite; 3],
    /// Mirrors, lenses and detectors whose motions add up to that of the line of sight, along an axis of the body; default: it turns
    /// with `point`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub optics: Vec<OpticalElement>,
    /// Measured responses of the line of sight to forces and torques at points, in place of the model: for linear tools.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<MeasuredPath>,
    /// Mirror that turns the image back, in a loop of its own; errors of the line of sight are then those behind it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mirror: Option<FineMirror>,
    /// Period of its samples (s).
    pub period: Span,
    /// Start and end (s) of the interval in which it is assessed; default: the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<[Time; 2]>,
    /// Length (s) of the windows within which jitter is assessed, such as an exposure time: the deviation from the
    /// mean over each window. Default: no jitter is assessed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jitter_window: Option<Positive>,
}

fn z_axis() -> [Finite; 3] {
    [Finite::default(), Finite::default(), Finite::new(1.0).unwrap_or_default()]
}

impl LineOfSight {
    /// Returns the direction of the line of sight in the undeformed body, as a unit vector.
    pub fn direction(&self) -> Vector {
        // Scaled first: the squares of any length are finite then.
        let axis = vector(&self.axis);
        (axis / axis.amax()).normalize()
    }

    /// Returns two unit vectors across the line of sight: those body axes, in cyclic order, that are furthest from it, less
    /// their parts along it.
    pub fn across(&self) -> [Vector; 2] {
        let direction = self.direction();
        let along = direction.iamax();
        let [first, second] = [1, 2].map(|next| Vector::ith((along + next) % 3, 1.0));
        let first = (first - direction * direction.dot(&first)).normalize();
        let second = second - direction * direction.dot(&second);
        [first, (second - first * first.dot(&second)).normalize()]
    }

    /// Returns how far small motions of the body turn the line of sight, before its mirror.
    pub fn sensitivity(&self, body: &ThreeAxisModel) -> LineSensitivity {
        let direction = self.direction();
        if self.optics.is_empty() {
            return LineSensitivity::for_point(body, &self.point, &direction);
        }
        LineSensitivity::for_optics(body, &self.optics, self.across())
    }

    /// Returns the remark that optics turn the line of sight by another angle than the rigid body turns.
    pub(super) fn remark(&self, body: &ThreeAxisModel) -> Option<ConfigError> {
        let exact = LineSensitivity::for_point(body, &self.point, &self.direction()).rigid;
        let found = self.sensitivity(body).rigid;
        let (row, column) = (found - exact).abs().iamax_full();
        let (found, exact) = (found[(row, column)], exact[(row, column)]);
        let (about, axis) = (AXIS_NAMES[row], AXIS_NAMES[column]);
        ((found - exact).abs() > DEVIATION).then(|| {
            let why = format!(
                "turn the line of sight by {} deg about {about} where the whole body turns by 1 deg about {axis}, and a distant object \
                 needs {exact} deg: is a sign wrong?",
                number(found)
            );
            ConfigError::new("optics", why)
        })
    }

    /// Returns true if a sample at a time (s) is assessed.
    pub fn is_assessed(&self, t: f64) -> bool {
        self.window.is_none_or(|[from, to]| from.get() <= t && t <= to.get())
    }

    /// Returns the number of samples in a window of the jitter, if it is assessed.
    pub fn jitter_samples(&self) -> Option<u64> {
        self.jitter_window.map(|window| (window.get() / self.period.seconds() + ROUNDING) as u64)
    }

    /// Checks the line of sight on a three-axis body; returns the inconsistent key and the reason.
    pub(super) fn validate(&self, body: &ThreeAxisModel, offers: &Offers) -> Option<ConfigError> {
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        if body.point(&self.point).is_none() {
            let points = body.point_names();
            return at("point", format!("must be one of the body's points, {points}, got `{}`", self.point));
        }
        if !offers.body.has_motion_at(&self.point) {
            return at("point", OFF_HUB.to_owned());
        }
        if self.axis.iter().all(|part| part.get() == 0.0) {
            return at("axis", "must not be zero, got [0, 0, 0]".to_owned());
        }
        if !self.optics.is_empty() {
            let across = self.direction().abs();
            if across.sum() - across.amax() > 0.0 {
                return at("axis", "must be along x, y or z of the body with `optics`".to_owned());
            }
            if let Some(fault) = optics::fault(&self.optics, body) {
                return Some(fault);
            }
        }
        if let Some(fault) = self.mirror.as_ref().and_then(FineMirror::fault) {
            return Some(fault.within("mirror"));
        }
        if let Some(fault) = self.measured_fault(body) {
            return Some(fault);
        }
        if let Some([from, to]) = self.window.map(|window| window.map(Time::get))
            && from >= to
        {
            return at("window", format!("must be [from, to] in this order, got [{from}, {to}]"));
        }
        self.jitter_samples().filter(|samples| *samples < 2)?;
        let (window, period) = (self.jitter_window?.get(), self.period.seconds());
        let why = format!("must contain at least two samples, which are {period} s apart, got {window} s");
        at("jitter_window", why)
    }

    /// Returns the inconsistent key of a measured path, and the reason.
    fn measured_fault(&self, body: &ThreeAxisModel) -> Option<ConfigError> {
        let direction = self.direction();
        let path = |own: &MeasuredPath| (own.point.clone(), own.part(), own.about as usize);
        let fault = |(index, own): (usize, &MeasuredPath)| {
            if body.point(&own.point).is_none() {
                let why =
                    format!("must be one of the body's points, {}, got `{}`", body.point_names(), own.point);
                return Some(ConfigError::new("point", why));
            }
            if direction[own.about as usize].abs() > 1.0 - 1e-12 {
                let why = "is along the line of sight, whose rotation is no error";
                return Some(ConfigError::new("about", why));
            }
            let is_known = self.measured[..index].iter().any(|before| path(before) == path(own));
            let why =
                "has a path already, from this component of the load to the line of sight about this axis";
            own.validate().or_else(|| is_known.then(|| ConfigError::new("point", why)))
        };
        let mut all = self.measured.iter().enumerate();
        all.find_map(|(index, own)| Some(fault((index, own))?.within(&format!("measured[{index}]"))))
    }
}
