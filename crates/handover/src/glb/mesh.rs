//! Meshes: triangles of the boxes, cones and arrows of a scene.

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::foxglove::{
    ArrowPrimitive, Color, CubePrimitive, CylinderPrimitive, LinePrimitive, SceneEntity,
};

use crate::placement::Placement;

/// Number of corners of a circle.
const CORNERS: usize = 24;
/// Thickness of a line relative to its length.
const THIN: f64 = 0.003;

/// Triangles of one colour.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Colour.
    pub color: Color,
    /// Positions of the vertices (m).
    pub positions: Vec<Vector>,
    /// Unit normals of the vertices.
    pub normals: Vec<Vector>,
    /// Three vertices of each triangle.
    pub indices: Vec<u32>,
}

/// Triangles of a part, by colours.
#[derive(Clone, Debug, Default)]
pub struct PartMesh {
    /// Surfaces, in the order in which their colours appear.
    pub surfaces: Vec<Surface>,
}

impl PartMesh {
    /// Adds the triangles of an entity whose frame is placed in that of the mesh. Texts have none.
    pub fn add_entity(&mut self, entity: &SceneEntity, frame: &Placement) {
        entity.cubes.iter().for_each(|cube| self.add_cube(cube, frame));
        entity.cylinders.iter().for_each(|cylinder| self.add_cylinder(cylinder, frame));
        entity.arrows.iter().for_each(|arrow| self.add_arrow(arrow, frame));
        entity.lines.iter().for_each(|line| self.add_line(line, frame));
    }

    fn surface(&mut self, color: &Color) -> &mut Surface {
        let found = self.surfaces.iter().position(|surface| surface.color == *color);
        let index = found.unwrap_or_else(|| {
            let (positions, normals, indices) = (Vec::new(), Vec::new(), Vec::new());
            self.surfaces.push(Surface { color: color.clone(), positions, normals, indices });
            self.surfaces.len() - 1
        });
        &mut self.surfaces[index]
    }

    fn add_cube(&mut self, cube: &CubePrimitive, frame: &Placement) {
        let half = 0.5 * Vector::new(cube.size.x, cube.size.y, cube.size.z);
        self.add_box(half, &frame.then(&Placement::from_pose(&cube.pose)), &cube.color);
    }

    /// Adds a box with these half edges (m).
    fn add_box(&mut self, half: Vector, placement: &Placement, color: &Color) {
        let surface = self.surface(color);
        for axis in 0..3 {
            let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
            for side in [1.0, -1.0] {
                let mut normal = Vector::zeros();
                normal[axis] = side;
                let corner = |a: f64, b: f64| {
                    let mut at = Vector::zeros();
                    (at[axis], at[right], at[up]) = (side * half[axis], a * side * half[right], b * half[up]);
                    placement.apply(&at)
                };
                let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                surface.add_polygon(&corners, placement.turn(&normal));
            }
        }
    }

    fn add_cylinder(&mut self, cylinder: &CylinderPrimitive, frame: &Placement) {
        let placement = frame.then(&Placement::from_pose(&cylinder.pose));
        let (radius, half) = (0.5 * cylinder.size.x, 0.5 * cylinder.size.z);
        let ends = [-half, half].map(|z| placement.apply(&(Vector::z() * z)));
        let radii = [cylinder.bottom_scale, cylinder.top_scale].map(|scale| scale * radius);
        // Directions of the cylinder's own: the same for every placement.
        let sides = [Vector::x(), Vector::y()].map(|side| placement.turn(&side));
        self.add_round(ends, radii, sides, &cylinder.color);
    }

    fn add_arrow(&mut self, arrow: &ArrowPrimitive, frame: &Placement) {
        let placement = frame.then(&Placement::from_pose(&arrow.pose));
        let at = |x: f64| placement.apply(&(Vector::x() * x));
        let (neck, tip) = (arrow.shaft_length, arrow.shaft_length + arrow.head_length);
        self.add_cone([at(0.0), at(neck)], [0.5 * arrow.shaft_diameter; 2], &arrow.color);
        self.add_cone([at(neck), at(tip)], [0.5 * arrow.head_diameter, 0.0], &arrow.color);
    }

    fn add_line(&mut self, line: &LinePrimitive, frame: &Placement) {
        let placement = frame.then(&Placement::from_pose(&line.pose));
        let point = |index: usize| {
            let point = &line.points[index];
            placement.apply(&Vector::new(point.x, point.y, point.z))
        };
        for index in 1..line.points.len() {
            let ends = [point(index - 1), point(index)];
            let radius = 0.5 * THIN * (ends[1] - ends[0]).norm();
            self.add_cone(ends, [radius; 2], &line.color);
        }
    }

    /// Adds a cone or a cylinder between two places (m), with its radii there (m).
    pub fn add_cone(&mut self, [from, to]: [Vector; 2], radii: [f64; 2], color: &Color) {
        let along = to - from;
        // Two directions across, from the coordinate axis that is farthest from the cone's.
        let mut across = Vector::zeros();
        across[along.iamin()] = 1.0;
        let across = along.cross(&across).normalize();
        let other = along.normalize().cross(&across);
        if along.norm_squared() > 0.0 {
            self.add_round([from, to], radii, [across, other], color);
        }
    }

    /// Adds a cone or a cylinder between two places (m), with its radii there (m) and two unit vectors across it.
    fn add_round(
        &mut self,
        [from, to]: [Vector; 2],
        [first, second]: [f64; 2],
        [across, other]: [Vector; 2],
        color: &Color,
    ) {
        let length = f64::sqrt((to - from).norm_squared());
        let along = across.cross(&other);
        let outward = |corner: usize| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * corner as f64 / CORNERS as f64);
            across * cos + other * sin
        };
        let surface = self.surface(color);
        let start = surface.positions.len() as u32;
        for corner in 0..=CORNERS {
            let outward = outward(corner);
            let normal = (outward * length + along * (first - second)).normalize();
            surface.positions.extend([from + outward * first, to + outward * second]);
            surface.normals.extend([normal; 2]);
        }
        for corner in 0..CORNERS as u32 {
            let (a, b) = (start + 2 * corner, start + 2 * corner + 1);
            if first > 0.0 {
                surface.indices.extend([a, a + 2, b]);
            }
            if second > 0.0 {
                surface.indices.extend([b, a + 2, b + 2]);
            }
        }
        for (end, radius, normal) in [(from, first, -along), (to, second, along)] {
            if radius > 0.0 {
                let is_end = normal.dot(&along) > 0.0;
                let turn = |corner: usize| if is_end { corner } else { CORNERS - corner };
                let rim: Vec<_> = (0..CORNERS).map(|corner| end + outward(turn(corner)) * radius).collect();
                surface.add_polygon(&rim, normal);
            }
        }
    }

    /// Returns the vectors of positions and normals, of all surfaces in order.
    pub fn vertices(&self) -> impl Iterator<Item = (&Vector, &Vector)> {
        self.surfaces.iter().flat_map(|surface| surface.positions.iter().zip(&surface.normals))
    }
}

impl Surface {
    /// Adds a flat convex polygon, anticlockwise around its normal.
    fn add_polygon(&mut self, corners: &[Vector], normal: Vector) {
        let start = self.positions.len() as u32;
        self.positions.extend(corners);
        self.normals.extend(corners.iter().map(|_| normal));
        for corner in 1..corners.len() as u32 - 1 {
            self.indices.extend([start, start + corner, start + corner + 1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the volume within closed triangles (m³), which is negative if they face inwards.
    fn volume(mesh: &PartMesh) -> f64 {
        let of = |surface: &Surface| -> f64 {
            let corner = |index: &u32| surface.positions[*index as usize];
            surface.indices.chunks(3).map(|t| corner(&t[0]).dot(&corner(&t[1]).cross(&corner(&t[2])))).sum()
        };
        mesh.surfaces.iter().map(of).sum::<f64>() / 6.0
    }

    #[test]
    fn bodies_are_closed_and_face_outwards() {
        let color = Color { r: 1.0, g: 1.0, b: 1.0, a: 1.0 };
        let mut mesh = PartMesh::default();
        let placed = Placement { at: Vector::new(5.0, -2.0, 1.0), ..Placement::identity() };
        mesh.add_box(Vector::new(1.0, 2.0, 3.0), &placed, &color);
        assert!((volume(&mesh) - 48.0).abs() < 1e-12);
        // Area of a regular polygon.
        let circle = 0.5 * CORNERS as f64 * (std::f64::consts::TAU / CORNERS as f64).sin();
        for (radii, shape) in [([1.0, 1.0], 3.0), ([1.0, 0.0], 1.0), ([0.0, 1.0], 1.0), ([2.0, 1.0], 7.0)] {
            for to in [Vector::z() * 3.0, Vector::new(-1.0, 2.0, -2.0), Vector::x() * -3.0] {
                let from = Vector::new(3.0, 1.0, 1.0);
                let mut mesh = PartMesh::default();
                mesh.add_cone([from, from + to], radii, &color);
                assert!((volume(&mesh) - circle * shape).abs() < 1e-11, "{radii:?} {}", volume(&mesh));
                for (_, normal) in mesh.vertices() {
                    assert!((normal.norm() - 1.0).abs() < 1e-12);
                }
            }
        }
    }
}
