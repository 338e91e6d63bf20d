//! Model of a scene: nodes with their meshes, and parts that bend as morph targets of the modes.

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::SceneSource;
use flexsc_core::record::foxglove::{FrameTransform, SceneEntity};
use flexsc_core::record::row::LogDate;
use flexsc_view::scene::Scene;

use super::mesh::PartMesh;
use crate::placement::{BODY, Placement, in_body};
use crate::scene_rows::SceneRow;

/// Drawn displacement below which a mode is left out, relative to the size of the scene.
const LEAST: f64 = 1e-4;
/// Drawn displacements between which a shape of a mode is scaled, relative to the size of the scene.
const SHOWN: [f64; 2] = [0.08, 0.2];

/// Part of a model: a frame of the scene, or all sections of a part that bends.
pub struct ModelNode {
    /// Name of the frame, or of the part.
    pub name: String,
    /// Index of the parent; `None` for the frame without one.
    pub parent: Option<usize>,
    /// Placement in the parent at rest.
    pub rest: Placement,
    /// Triangles at rest, in the node's frame.
    pub mesh: PartMesh,
    /// Frame of the first section; `None` for a rigid part.
    pub first_section: Option<String>,
    /// Entities that the mesh draws.
    entities: Vec<SceneEntity>,
    /// Changes of the mesh's vertices by each mode that is kept.
    pub targets: Vec<Vec<VertexChange>>,
}

/// Change of a vertex: of its position (m) and of its normal.
pub type VertexChange = [Vector; 2];

/// Mode of a model: its index, and the modal displacement for a weight of 1.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ModelMode {
    /// Index of the mode, from 0.
    pub index: usize,
    /// Modal displacement for a weight of 1.
    pub per_weight: f64,
}

/// Model of a scene.
pub struct SceneModel {
    /// Parts, each after its parent.
    pub nodes: Vec<ModelNode>,
    /// Modes of the morph targets, in their order.
    pub modes: Vec<ModelMode>,
    /// Distance of the farthest vertex from the body's origin (m).
    pub size: f64,
}

/// Returns the name of the part to which a frame of a section belongs.
fn part_of_section(frame: &str) -> Option<&str> {
    let is_part = ["panel_", "boom_", "wing_"].into_iter().any(|part| frame.starts_with(part));
    frame.rsplit_once('/').filter(|_| is_part).map(|(part, _)| part)
}

impl SceneModel {
    /// Creates the model of a scene at rest, for modes with these largest displacements. With `all_modes`, each mode that
    /// bends a part has a target.
    pub fn new(
        scene: &mut Scene,
        sections: &[Vec<f64>],
        rest: &SceneRow,
        largest: &[f64],
        all_modes: bool,
    ) -> Self {
        let frames = rest.draw(scene, sections).transforms.clone();
        let mut model = Self { nodes: Vec::new(), modes: Vec::new(), size: 0.0 };
        model.add_nodes(&frames);
        model.add_meshes(scene, &frames);
        model.size = model.extent();
        for (index, reached) in largest.iter().enumerate() {
            let mut bent = |by: f64| -> [Vec<FrameTransform>; 2] {
                [by, -by].map(|x| {
                    let mut modes = vec![0.0; largest.len()];
                    modes[index] = x;
                    rest.with_modes(modes).draw(scene, sections).transforms.clone()
                })
            };
            let per_weight = if all_modes { model.shown_displacement(*reached, &mut bent) } else { *reached };
            let targets = model.targets(&bent(per_weight));
            if largest_change(&targets) > LEAST * model.size {
                model.modes.push(ModelMode { index, per_weight });
                for (node, target) in model.nodes.iter_mut().zip(targets) {
                    node.targets.extend(node.first_section.is_some().then_some(target));
                }
            }
        }
        model
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.nodes.iter().position(|node| node.name == name)
    }

    /// Adds a node for each frame, and for each part of sections.
    fn add_nodes(&mut self, frames: &[FrameTransform]) {
        for frame in frames {
            if self.nodes.is_empty() {
                self.nodes.push(ModelNode::new(&frame.parent_frame_id, None, Placement::identity(), None));
            }
            let name = &frame.child_frame_id;
            let Some(part) = part_of_section(name) else {
                let parent = self.find(&frame.parent_frame_id).unwrap_or(0);
                self.nodes.push(ModelNode::new(name, Some(parent), Placement::from_frame(frame), None));
                continue;
            };
            if self.find(part).is_none() {
                let (parent, rest) = (self.find(BODY).unwrap_or(0), in_body(frames, name));
                self.nodes.push(ModelNode::new(part, Some(parent), rest, Some(name.clone())));
            }
        }
    }

    fn add_meshes(&mut self, scene: &Scene, frames: &[FrameTransform]) {
        for entity in scene.parts(LogDate::default()).entities {
            let part = part_of_section(&entity.frame_id).unwrap_or(&entity.frame_id);
            if let Some(index) = self.find(part) {
                self.nodes[index].entities.push(entity);
            }
        }
        for node in &mut self.nodes {
            node.mesh = node.mesh_in(frames);
        }
    }

    /// Returns the distance of the farthest vertex from the body's origin (m).
    fn extent(&self) -> f64 {
        let of = |node: &ModelNode| {
            let far = node.mesh.vertices().map(|(at, _)| node.rest.apply(at).norm());
            far.fold(0.0, f64::max)
        };
        self.nodes.iter().map(of).fold(0.0, f64::max)
    }

    /// Returns a displacement of a mode, at least the one reached, for which its shape can be seen.
    fn shown_displacement(
        &self,
        reached: f64,
        bent: &mut impl FnMut(f64) -> [Vec<FrameTransform>; 2],
    ) -> f64 {
        const MOST_STEPS: usize = 200;
        let mut by = 1.0;
        for _ in 0..MOST_STEPS {
            let drawn = largest_change(&self.targets(&bent(by))) / self.size;
            if drawn < SHOWN[0] {
                by *= 2.0;
            } else if drawn > SHOWN[1] {
                by *= 0.5;
            } else {
                return by.max(reached);
            }
        }
        reached
    }

    /// Returns the odd part of the change of each node's vertices between a pair of opposite displacements: the linear
    /// shape, without the shortening of second order.
    fn targets(&self, bent: &[Vec<FrameTransform>; 2]) -> Vec<Vec<VertexChange>> {
        let of = |node: &ModelNode| {
            let [plus, minus] = bent.each_ref().map(|frames| node.mesh_in(frames));
            let pairs = plus.vertices().zip(minus.vertices());
            let half = |((at, normal), (opposite, other)): ((&Vector, &Vector), (&Vector, &Vector))| {
                [(at - opposite) * 0.5, (normal - other) * 0.5]
            };
            if node.first_section.is_some() { pairs.map(half).collect() } else { Vec::new() }
        };
        self.nodes.iter().map(of).collect()
    }
}

impl ModelNode {
    /// Creates a rigid part without a parent.
    pub fn plain(name: &str) -> Self {
        Self::new(name, None, Placement::identity(), None)
    }

    fn new(name: &str, parent: Option<usize>, rest: Placement, first_section: Option<String>) -> Self {
        let (mesh, entities, targets) = (PartMesh::default(), Vec::new(), Vec::new());
        Self { name: name.to_owned(), parent, rest, mesh, first_section, entities, targets }
    }

    /// Returns the triangles of the part for these frames of the scene, in the node's frame at rest.
    fn mesh_in(&self, frames: &[FrameTransform]) -> PartMesh {
        let mut mesh = PartMesh::default();
        for entity in &self.entities {
            let placement = match &self.first_section {
                Some(_) => self.rest.inverse().then(&in_body(frames, &entity.frame_id)),
                None => Placement::identity(),
            };
            mesh.add_entity(entity, &placement);
        }
        mesh
    }

    /// Returns the placement of the node in its parent for these frames of the scene; the frame without a parent rests.
    pub fn placement_in(&self, frames: &[FrameTransform]) -> Placement {
        if let Some(first) = &self.first_section {
            return in_body(frames, first);
        }
        let own = frames.iter().find(|frame| frame.child_frame_id == self.name);
        own.map_or(self.rest, Placement::from_frame)
    }
}

/// Returns the largest displacement of a vertex (m).
fn largest_change(targets: &[Vec<VertexChange>]) -> f64 {
    targets.iter().flatten().map(|[shift, _]| shift.norm()).fold(0.0, f64::max)
}
