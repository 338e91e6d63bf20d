//! Tracks of an animation: the placement of each node and the weights of the modes at each key frame.

use flexsc_core::record::{Column, Columns};
use flexsc_view::scene::Scene;
use nalgebra::Quaternion;

use super::container::{AccessorKind, BinaryData};
use super::model::SceneModel;
use crate::placement::Placement;
use crate::scene_rows::SceneRow;
use serde_json::{Value as Json, json};

/// Change of a placement below which it is constant: of the translation relative to the size of the scene, and of the
/// components of the rotation. Scenes are rounded to single precision.
const CONSTANT: f64 = 1e-6;

/// Motion of a model at key frames.
pub struct ModelTracks {
    /// Playback times of the key frames (s).
    pub times: Vec<f32>,
    /// Placements of each node at each key frame.
    pub placements: Vec<Vec<Placement>>,
    /// Weights of the kept modes at each key frame.
    pub weights: Vec<f32>,
}

impl ModelTracks {
    /// Creates the tracks of a model for these rows, at a speed relative to real time.
    pub fn new(
        model: &SceneModel,
        scene: &mut Scene,
        sections: &[Vec<f64>],
        rows: &[SceneRow],
        speed: f64,
    ) -> Self {
        let mut tracks = Self {
            times: Vec::with_capacity(rows.len()),
            placements: model.nodes.iter().map(|_| Vec::with_capacity(rows.len())).collect(),
            weights: Vec::with_capacity(rows.len() * model.modes.len()),
        };
        let start = rows.first().map_or(0, |row| row.time_ns);
        for row in rows {
            tracks.times.push(((row.time_ns - start) as f64 / 1e9 / speed) as f32);
            let rigid = row.draw(scene, sections).transforms.clone();
            // Targets of modes bend the parts, so their frames follow drives and hinges alone.
            let unbent = row.with_modes(vec![0.0; row.modes.len()]).draw(scene, sections);
            for (node, placements) in model.nodes.iter().zip(&mut tracks.placements) {
                let frames = if node.first_section.is_some() { &unbent.transforms } else { &rigid };
                let mut placement = node.placement_in(frames);
                let before = placements.last().map_or(node.rest.rotation, |before| before.rotation);
                if placement.rotation.dot(&before) < 0.0 {
                    placement.rotation = -placement.rotation;
                }
                placements.push(placement);
            }
            let weight = |mode: &super::model::ModelMode| {
                row.modes.get(mode.index).map_or(0.0, |x| x / mode.per_weight) as f32
            };
            tracks.weights.extend(model.modes.iter().map(weight));
        }
        tracks
    }

    /// Returns the placement of a node at the start.
    pub fn start(&self, node: usize) -> Option<Placement> {
        self.placements[node].first().copied()
    }

    /// Returns true if a node moves, and true if it rotates.
    pub fn motion(&self, node: usize, size: f64) -> [bool; 2] {
        let Some(first) = self.start(node) else { return [false; 2] };
        let mut later = self.placements[node].iter();
        let turned = |q: &Quaternion<f64>| (q - first.rotation).norm() > CONSTANT;
        [
            later.clone().any(|of| (of.at - first.at).norm() > CONSTANT * size),
            later.any(|of| turned(&of.rotation)),
        ]
    }
}

/// Animation of a document: samplers and channels.
#[derive(Default)]
pub struct Animation {
    samplers: Vec<Json>,
    channels: Vec<Json>,
}

impl Animation {
    /// Adds a sampler between accessors of times and values; returns its index.
    pub fn add_sampler(&mut self, times: usize, values: usize, is_stepped: bool) -> usize {
        let kind = if is_stepped { "STEP" } else { "LINEAR" };
        self.samplers.push(json!({"input": times, "output": values, "interpolation": kind}));
        self.samplers.len() - 1
    }

    /// Adds a channel from a sampler to a property of a node.
    pub fn add_channel(&mut self, sampler: usize, node: usize, path: &str) {
        self.channels.push(json!({"sampler": sampler, "target": {"node": node, "path": path}}));
    }

    /// Returns the animation of this name; `None` if nothing moves.
    pub fn into_json(self, name: &str) -> Option<Json> {
        let Self { samplers, channels } = self;
        (!channels.is_empty()).then(|| json!({"name": name, "samplers": samplers, "channels": channels}))
    }
}

/// Levels of a plume (0 to 1) from given times on (ns).
pub type PlumeLevels = Vec<(u64, f64)>;

/// Returns the levels of each nozzle's plume from the rows of `/plumes`, in intervals of at least `spacing` (ns), each
/// with the largest level within it, so that short pulses are seen.
pub fn plume_levels(table: &Columns, names: &[&str], length: f64, spacing: u64) -> Option<Vec<PlumeLevels>> {
    let times = table.numbers("time_s")?;
    let Some(Column::Rows(counts, entities)) = table.get("entities") else { return None };
    let Some(Column::Texts(ids)) = entities.get("id") else { return None };
    let Some(Column::Rows(cones, cylinders)) = entities.get("cylinders") else { return None };
    let heights = cylinders.numbers("size.z")?;
    let mut levels: Vec<PlumeIntervals> = names.iter().map(|_| PlumeIntervals::new(spacing)).collect();
    let (mut entity, mut cone) = (0, 0);
    for (time, count) in times.iter().zip(counts) {
        let mut now = vec![0.0; names.len()];
        for _ in 0..*count {
            let cones = *cones.get(entity)? as usize;
            let height: f64 = heights.get(cone..cone + cones)?.iter().sum();
            if let Some(nozzle) = names.iter().position(|name| *name == ids[entity]) {
                now[nozzle] = (height / length).clamp(0.0, 1.0);
            }
            (entity, cone) = (entity + 1, cone + cones);
        }
        let time = crate::motion_rows::nanoseconds(*time);
        levels.iter_mut().zip(now).for_each(|(intervals, level)| intervals.add(time, level));
    }
    Some(levels.into_iter().map(PlumeIntervals::finish).collect())
}

/// Levels of a plume by intervals.
struct PlumeIntervals {
    spacing: u64,
    /// Index of the current interval, the largest level within it, and the level at its latest change.
    interval: u64,
    largest: f64,
    level: f64,
    shown: PlumeLevels,
}

impl PlumeIntervals {
    fn new(spacing: u64) -> Self {
        Self { spacing: spacing.max(1), interval: 0, largest: 0.0, level: 0.0, shown: vec![(0, 0.0)] }
    }

    fn add(&mut self, time: u64, level: f64) {
        let interval = time / self.spacing;
        if interval > self.interval {
            self.show(self.interval, self.largest);
            if interval > self.interval.saturating_add(1) {
                self.show(self.interval.saturating_add(1), self.level);
            }
            (self.interval, self.largest) = (interval, self.level);
        }
        self.level = level;
        self.largest = self.largest.max(level);
    }

    fn show(&mut self, interval: u64, level: f64) {
        let time = interval.saturating_mul(self.spacing);
        match self.shown.last_mut() {
            Some((_, last)) if *last == level => {}
            Some((at, last)) if *at == time => *last = level,
            _ => self.shown.push((time, level)),
        }
    }

    fn finish(mut self) -> PlumeLevels {
        self.show(self.interval, self.largest);
        self.show(self.interval.saturating_add(1), self.level);
        self.shown
    }
}

/// Adds the values of vectors; returns the index of their accessor.
pub fn add_translations(data: &mut BinaryData, placements: &[Placement]) -> usize {
    let values: Vec<f32> =
        placements.iter().flat_map(|of| [of.at.x, of.at.y, of.at.z]).map(|x| x as f32).collect();
    data.add_samples(&values, AccessorKind::Vector)
}

/// Adds the values of rotations; returns the index of their accessor.
pub fn add_rotations(data: &mut BinaryData, placements: &[Placement]) -> usize {
    let values: Vec<f32> = placements.iter().flat_map(|of| rotation(&of.rotation)).collect();
    data.add_samples(&values, AccessorKind::Rotation)
}

/// Returns a unit quaternion as glTF has it, scalar last.
pub fn rotation(q: &Quaternion<f64>) -> [f32; 4] {
    [q.i, q.j, q.k, q.w].map(|part| part as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_pulses_are_shown_for_one_interval() {
        let mut levels = PlumeIntervals::new(100);
        for (time, level) in [(0, 0.0), (120, 1.0), (130, 0.0), (350, 0.5), (420, 0.5), (760, 0.0)] {
            levels.add(time, level);
        }
        let shown = levels.finish();
        assert_eq!(shown, [(0, 0.0), (100, 1.0), (200, 0.0), (300, 0.5), (800, 0.0)]);
    }
}
