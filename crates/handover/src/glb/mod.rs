//! glTF 2.0 in one file (.glb): the scene of a run with an animation.
//!
//! Scenes have z up and glTF has y up, so that one node above all turns x, y, z into x, z, -y. Parts that bend are meshes
//! with a morph target for each mode; the weights of the targets are the modal displacements of the log, each over the
//! largest of the run.

mod container;
mod mesh;
mod model;
mod tracks;

use flexsc_core::record::foxglove::Color;
use flexsc_view::scene::{Scene, ScenePlume};
use serde_json::{Map, Value as Json, json};

use crate::error::HandoverError;
use crate::motion_rows::RunLog;
use crate::options::HandoverOptions;
use crate::placement::Placement;
use crate::scene_rows::{HubMotion, SceneRow, section_weights};
use container::{AccessorKind, BinaryData};
use model::{ModelMode, ModelNode, SceneModel};
use tracks::{Animation, ModelTracks, PlumeLevels, add_rotations, add_translations, plume_levels, rotation};

/// Longest animation at the default speed (s), and the largest rate of its key frames (1/s).
const LONGEST: f64 = 60.0;
const FRAMES: f64 = 60.0;
/// Colour of plumes, which give light.
const PLUME: Color = Color { r: 0.90, g: 0.60, b: 0.0, a: 0.75 };

/// Returns the file with the animated scene of a run.
pub fn write(run: &RunLog<'_>, options: &HandoverOptions) -> Result<Vec<u8>, HandoverError> {
    let scenario = run.scenario;
    let speed = options.speed.unwrap_or_else(|| default_speed(scenario.duration.seconds()));
    let spacing = (speed / FRAMES * 1e9 * (1.0 - 1e-9)) as u64;
    let rows = run.scene_rows(spacing)?;
    let sections = section_weights(scenario);
    let mut scene = Scene::new(scenario);
    let mut model = {
        let is_one_axis = scenario.model.one_axis().is_some();
        let still = HubMotion::OneAxis { angle: 0.0, rigid_angle: 0.0 };
        let hub = if is_one_axis { still } else { HubMotion::ThreeAxis(Placement::identity().rotation) };
        let count = rows.first().map_or(0, |row| row.modes.len());
        let angles = rows.first().map_or(0, |row| row.angles.len());
        let rest = SceneRow { time_ns: 0, hub, modes: vec![0.0; count], angles: vec![0.0; angles] };
        let reached =
            |mode: usize| rows.iter().filter_map(|row| Some(row.modes.get(mode)?.abs())).fold(0.0, f64::max);
        let largest: Vec<f64> = (0..count).map(reached).collect();
        SceneModel::new(&mut scene, &sections, &rest, &largest, options.mode_shapes)
    };
    let tracks = ModelTracks::new(&model, &mut scene, &sections, &rows, speed);
    for (index, node) in model.nodes.iter_mut().enumerate() {
        node.rest = tracks.start(index).unwrap_or(node.rest);
    }
    let plumes = plumes(run, &scene, spacing)?;
    let mut file = Document { speed, ..Document::default() };
    file.add_nodes(&model, &tracks, &plumes);
    file.add_run(&model, &tracks, &plumes);
    if options.mode_shapes {
        file.add_shapes(&model, &frequencies(run));
    }
    if file.data.overflows() {
        return Err(HandoverError::Refused("a value of the motion is too large to be drawn".to_owned()));
    }
    let magnification = scene.magnification();
    let unit = if scenario.model.one_axis().is_some() { "rad" } else { "m sqrt(kg)" };
    let modes: Vec<Json> = model
        .modes
        .iter()
        .map(|ModelMode { index, per_weight }| json!({"mode": index, "unit": unit, "per_weight": per_weight}))
        .collect();
    let about = json!({
        "scenario": scenario.name,
        "bending": magnification.bending,
        "turning": magnification.turning,
        "speed": speed,
        "modes": modes,
    });
    Ok(file.into_file(&scenario.name, &about))
}

/// Returns 1, 2 or 5 times a power of ten, at least 1, by which a run of a duration (s) is faster than real time so that
/// it lasts at most [`LONGEST`].
fn default_speed(duration: f64) -> f64 {
    let mut decade = 1.0;
    loop {
        if let Some(step) = [1.0, 2.0, 5.0].into_iter().find(|step| duration <= LONGEST * step * decade) {
            return step * decade;
        }
        decade *= 10.0;
    }
}

/// Returns the natural frequency of each mode (rad/s).
fn frequencies(run: &RunLog<'_>) -> Vec<f64> {
    let one = run.scenario.model.one_axis().into_iter().flat_map(|body| &body.modes);
    let three = run.scenario.model.three_axis().into_iter().flat_map(|body| &body.modes);
    one.map(|mode| mode.frequency.get()).chain(three.map(|mode| mode.frequency.get())).collect()
}

/// Plume of a nozzle, full, with its levels.
struct AnimatedPlume {
    nozzle: ScenePlume,
    length: f64,
    levels: PlumeLevels,
}

/// Returns the plumes of a log with a scene; none of another log.
fn plumes(run: &RunLog<'_>, scene: &Scene, spacing: u64) -> Result<Vec<AnimatedPlume>, HandoverError> {
    let [table] = run.tables(["/plumes"])?;
    let (nozzles, length) = scene.nozzles();
    let names: Vec<&str> = nozzles.iter().map(|nozzle| nozzle.name.as_str()).collect();
    let levels = table.and_then(|table| plume_levels(&table, &names, length, spacing)).unwrap_or_default();
    let fires = |levels: &PlumeLevels| levels.iter().any(|(_, level)| *level > 0.0);
    let all = nozzles.iter().zip(levels).filter(|(_, levels)| fires(levels));
    Ok(all.map(|(nozzle, levels)| AnimatedPlume { nozzle: nozzle.clone(), length, levels }).collect())
}

/// Document under construction.
#[derive(Default)]
struct Document {
    data: BinaryData,
    nodes: Vec<Json>,
    meshes: Vec<Json>,
    materials: Vec<Json>,
    colors: Vec<Color>,
    animations: Vec<Json>,
    /// Nodes whose meshes have targets.
    bending: Vec<usize>,
    /// Speed of the run's animation relative to real time.
    speed: f64,
}

impl Document {
    /// Adds the nodes of a model, in its order, those of plumes, and the node above all.
    fn add_nodes(&mut self, model: &SceneModel, tracks: &ModelTracks, plumes: &[AnimatedPlume]) {
        for (index, node) in model.nodes.iter().enumerate() {
            let mut children: Vec<usize> =
                (0..model.nodes.len()).filter(|child| model.nodes[*child].parent == Some(index)).collect();
            let own = plumes.iter().enumerate().filter(|(_, plume)| plume.nozzle.frame == node.name);
            children.extend(own.map(|(plume, _)| model.nodes.len() + plume));
            let mut made = placed(&node.name, &node.rest);
            if !children.is_empty() {
                made["children"] = json!(children);
            }
            if let Some(mesh) = self.add_mesh(node, tracks, model.modes.len()) {
                made["mesh"] = json!(mesh);
            }
            self.nodes.push(made);
        }
        for plume in plumes {
            let at = Placement { at: plume.nozzle.at, ..Placement::identity() };
            let mut made = placed(&format!("plume_{}", plume.nozzle.name), &at);
            made["scale"] = json!([1.0, 1.0, 1.0].map(|full: f64| full * plume.levels[0].1));
            let ends =
                [flexsc_core::numerics::attitude::Vector::zeros(), plume.nozzle.direction * plume.length];
            let mut cone = ModelNode::plain(&plume.nozzle.name);
            cone.mesh.add_cone(ends, [0.03 * plume.length, 0.15 * plume.length], &PLUME);
            made["mesh"] = json!(self.add_mesh(&cone, tracks, 0));
            self.nodes.push(made);
        }
    }

    /// Adds the mesh of a node; returns its index, if it has triangles.
    fn add_mesh(&mut self, node: &ModelNode, tracks: &ModelTracks, modes: usize) -> Option<usize> {
        if node.mesh.surfaces.is_empty() {
            return None;
        }
        let mut first = 0;
        let mut primitives = Vec::new();
        for surface in &node.mesh.surfaces {
            let count = surface.positions.len();
            let floats = |of: &[flexsc_core::numerics::attitude::Vector]| -> Vec<f32> {
                of.iter().flat_map(|v| [v.x as f32, v.y as f32, v.z as f32]).collect()
            };
            let mut primitive = json!({
                "attributes": {
                    "POSITION": self.data.add_vertices(&floats(&surface.positions)),
                    "NORMAL": self.data.add_vertices(&floats(&surface.normals)),
                },
                "indices": self.data.add_indices(&surface.indices),
                "material": self.material(&surface.color),
            });
            let mut targets = Vec::new();
            for target in &node.targets {
                let own = &target[first..first + count];
                let [shifts, turns] =
                    [0, 1].map(|part| own.iter().map(|change| change[part]).collect::<Vec<_>>());
                targets.push(json!({
                    "POSITION": self.data.add_vertices(&floats(&shifts)),
                    "NORMAL": self.data.add_vertices(&floats(&turns)),
                }));
            }
            if !targets.is_empty() {
                primitive["targets"] = Json::Array(targets);
            }
            primitives.push(primitive);
            first += count;
        }
        let mut mesh = json!({"name": node.name, "primitives": primitives});
        if !node.targets.is_empty() {
            mesh["weights"] = json!(&tracks.weights[..modes]);
            self.bending.push(self.nodes.len());
        }
        self.meshes.push(mesh);
        Some(self.meshes.len() - 1)
    }

    /// Returns the index of the material of a colour.
    fn material(&mut self, color: &Color) -> usize {
        if let Some(index) = self.colors.iter().position(|own| own == color) {
            return index;
        }
        // The colours of scenes are sRGB, and those of materials linear.
        let linear = |c: f64| if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) };
        let rounded = |c: f64| libm::round(c * 1e6) / 1e6;
        let factors = [color.r, color.g, color.b].map(|c| rounded(linear(c)));
        let base = [factors[0], factors[1], factors[2], color.a];
        let mut material = json!({
            "pbrMetallicRoughness": {"baseColorFactor": base, "metallicFactor": 0.1, "roughnessFactor": 0.6}
        });
        if color.a < 1.0 {
            material["alphaMode"] = json!("BLEND");
            material["emissiveFactor"] = json!(factors);
        }
        self.materials.push(material);
        self.colors.push(color.clone());
        self.materials.len() - 1
    }

    /// Adds the animation of the run.
    fn add_run(&mut self, model: &SceneModel, tracks: &ModelTracks, plumes: &[AnimatedPlume]) {
        let mut animation = Animation::default();
        if tracks.times.len() < 2 {
            return;
        }
        let times = self.data.add_samples(&tracks.times, AccessorKind::Scalar);
        for (index, placements) in tracks.placements.iter().enumerate() {
            let [moves, rotates] = tracks.motion(index, model.size);
            if moves {
                let values = add_translations(&mut self.data, placements);
                let sampler = animation.add_sampler(times, values, false);
                animation.add_channel(sampler, index, "translation");
            }
            if rotates {
                let values = add_rotations(&mut self.data, placements);
                let sampler = animation.add_sampler(times, values, false);
                animation.add_channel(sampler, index, "rotation");
            }
        }
        if !self.bending.is_empty() {
            let values = self.data.add_samples(&tracks.weights, AccessorKind::Scalar);
            let sampler = animation.add_sampler(times, values, false);
            self.bending.iter().for_each(|node| animation.add_channel(sampler, *node, "weights"));
        }
        for (index, plume) in plumes.iter().enumerate() {
            let seconds = |(time, _): &(u64, f64)| (*time as f64 / 1e9 / self.speed) as f32;
            let times: Vec<f32> = plume.levels.iter().map(seconds).collect();
            let levels: Vec<f32> = plume.levels.iter().flat_map(|(_, level)| [*level as f32; 3]).collect();
            let times = self.data.add_samples(&times, AccessorKind::Scalar);
            let levels = self.data.add_samples(&levels, AccessorKind::Vector);
            let sampler = animation.add_sampler(times, levels, true);
            animation.add_channel(sampler, model.nodes.len() + index, "scale");
        }
        let name =
            if self.speed == 1.0 { "run".to_owned() } else { format!("run, {} times as fast", self.speed) };
        self.animations.extend(animation.into_json(&name));
    }

    /// Adds an animation of each mode's shape: one oscillation.
    fn add_shapes(&mut self, model: &SceneModel, frequencies: &[f64]) {
        const FRAMES: usize = 32;
        const PERIOD: f64 = 2.0;
        let part = |frame: usize| frame as f64 / FRAMES as f64;
        let times: Vec<f32> = (0..=FRAMES).map(|frame| (PERIOD * part(frame)) as f32).collect();
        let times = self.data.add_samples(&times, AccessorKind::Scalar);
        for (place, mode) in model.modes.iter().enumerate() {
            let mut weights = vec![0.0_f32; (FRAMES + 1) * model.modes.len()];
            for frame in 0..=FRAMES {
                let phase = std::f64::consts::TAU * part(frame);
                weights[frame * model.modes.len() + place] = libm::sin(phase) as f32;
            }
            let mut animation = Animation::default();
            let values = self.data.add_samples(&weights, AccessorKind::Scalar);
            let sampler = animation.add_sampler(times, values, false);
            self.bending.iter().for_each(|node| animation.add_channel(sampler, *node, "weights"));
            let frequency = frequencies.get(mode.index).copied().unwrap_or_default();
            let name = format!("mode {}, {} rad/s", mode.index, (frequency * 1e4).round() / 1e4);
            self.animations.extend(animation.into_json(&name));
        }
    }

    fn into_file(mut self, name: &str, about: &Json) -> Vec<u8> {
        // A quarter turn about x turns z up into y up.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let top = json!({"name": name, "rotation": [-half as f32, 0.0, 0.0, half as f32], "children": [0]});
        self.nodes.push(top);
        let root = self.nodes.len() - 1;
        let mut members = Map::new();
        let mut add = |key: &str, value: Json| members.insert(key.to_owned(), value);
        add("asset", json!({"version": "2.0", "generator": "flexsc", "extras": {"flexsc": about}}));
        add("scene", json!(0));
        add("scenes", json!([{"name": name, "nodes": [root]}]));
        add("nodes", Json::Array(self.nodes));
        add("meshes", Json::Array(self.meshes));
        add("materials", Json::Array(self.materials));
        if !self.animations.is_empty() {
            add("animations", Json::Array(self.animations));
        }
        self.data.into_file(members)
    }
}

/// Returns a node of this name and placement.
fn placed(name: &str, placement: &Placement) -> Json {
    let at = [placement.at.x, placement.at.y, placement.at.z].map(|x| x as f32);
    json!({"name": name, "translation": at, "rotation": rotation(&placement.rotation)})
}
