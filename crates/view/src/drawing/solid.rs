//! Box of a part of a spacecraft: that of its mass and inertia, since scenarios give no sizes.

use std::fmt::Write;

use flexsc_core::numerics::attitude::Vector;
use nalgebra::{Matrix3, SymmetricEigen};

use super::projection::Projection;

/// Thickness of a box without one, relative to its longest side.
const THIN: f64 = 0.012;
/// Density of a point mass (kg/m³), from which its size follows.
const DENSITY: f64 = 1000.0;
/// Direction of the light, and brightness of a face in the dark.
const LIGHT: [f64; 3] = [0.35, -0.55, 0.76];
const SHADE: f64 = 0.72;
/// Axes that differ from the body's by less than this are the body's.
const ALIKE: f64 = 0.2;

/// Box with its colour.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Centre (m).
    pub centre: Vector,
    /// Sides (m), and the columns of their axes.
    pub size: Vector,
    axes: Matrix3<f64>,
    colour: [f64; 3],
    /// True if it has solar cells on its large faces.
    has_cells: bool,
}

/// Visible face of a box.
struct Face {
    depth: f64,
    svg: String,
}

impl Solid {
    /// Creates the box of a mass (kg) and an inertia about its centre (kg m²), in axes that the columns of `axes` are.
    pub fn from_inertia(mass: f64, inertia: &Matrix3<f64>, centre: Vector, axes: &Matrix3<f64>) -> Self {
        let own = SymmetricEigen::new(*inertia);
        let is_diagonal = (inertia - Matrix3::from_diagonal(&inertia.diagonal())).abs().max()
            <= ALIKE * inertia.diagonal().abs().max();
        let (moments, turned) = if is_diagonal {
            (inertia.diagonal(), Matrix3::identity())
        } else {
            (own.eigenvalues, own.eigenvectors)
        };
        let size = moments.map(|moment| (6.0 * (moments.sum() - 2.0 * moment) / mass).max(0.0).sqrt());
        let size = if size.max() > 0.0 { size } else { Vector::repeat(libm::cbrt(mass / DENSITY)) };
        Self {
            centre,
            size: size.map(|side| side.max(THIN * size.max())),
            axes: axes * turned,
            colour: [214.0, 219.0, 226.0],
            has_cells: false,
        }
    }

    /// Returns the box as a panel with solar cells if it is thin.
    #[must_use]
    pub fn with_cells(mut self) -> Self {
        if self.size.min() < 0.1 * self.size.max() {
            (self.colour, self.has_cells) = ([58.0, 92.0, 148.0], true);
        }
        self
    }

    /// Returns the corners.
    pub fn corners(&self) -> Vec<Vector> {
        let corner = |index: usize| {
            let half = |axis: usize| if index >> axis & 1 == 1 { 0.5 } else { -0.5 };
            let place = Vector::new(half(0), half(1), half(2)).component_mul(&self.size);
            self.centre + self.axes * place
        };
        (0..8).map(corner).collect()
    }

    /// Returns the point of the surface on a ray from the centre.
    pub fn surface(&self, direction: &Vector) -> Vector {
        let local = self.axes.transpose() * direction;
        let reach =
            (0..3)
                .map(|axis| {
                    if local[axis] == 0.0 { f64::INFINITY } else { 0.5 * self.size[axis] / local[axis].abs() }
                })
                .fold(f64::INFINITY, f64::min);
        self.centre + direction * reach
    }

    /// Returns the point of the box that is farthest from a point, in the middle of a side.
    pub fn far_end(&self, from: &Vector) -> Vector {
        let side = self.size.imax();
        let end = |sign: f64| self.centre + self.axes.column(side) * (sign * 0.5 * self.size[side]);
        let (one, other) = (end(1.0), end(-1.0));
        if (one - from).norm() > (other - from).norm() { one } else { other }
    }

    /// Returns the colour: red, green and blue, to 255.
    pub fn colour(&self) -> [f64; 3] {
        self.colour
    }

    /// Returns the corners of each of the six faces with the direction out of it, two to each axis.
    pub fn sides(&self) -> impl Iterator<Item = ([Vector; 4], Vector)> + '_ {
        (0..6).map(|side| {
            let (axis, sign) = (side / 2, if side % 2 == 0 { 1.0 } else { -1.0 });
            let normal: Vector = self.axes.column(axis) * sign;
            let along = |axis: usize| -> Vector { self.axes.column(axis) * (0.5 * self.size[axis]) };
            let (u, v) = (along((axis + 1) % 3), along((axis + 2) % 3));
            let middle = self.centre + normal * (0.5 * self.size[axis]);
            ([middle + u + v, middle + u - v, middle - u - v, middle - u + v], normal)
        })
    }

    fn faces(&self, view: &Projection) -> Vec<Face> {
        let mut faces = Vec::new();
        for (side, (corners, normal)) in self.sides().enumerate() {
            if normal.dot(&view.eye) <= 1e-9 {
                continue;
            }
            let light = SHADE + (1.0 - SHADE) * normal.dot(&Vector::from(LIGHT)).max(0.0);
            let fill: Vec<String> =
                self.colour.iter().map(|own| format!("{:02x}", (own * light).min(255.0) as u8)).collect();
            let mut svg = format!(
                "<path d=\"M{} Z\" fill=\"#{}\" stroke=\"#1b2733\" stroke-linejoin=\"round\"/>",
                view.path(&corners),
                fill.concat()
            );
            if self.has_cells && side / 2 == self.size.imin() {
                add_cells(&mut svg, &corners, view);
            }
            faces.push(Face { depth: view.depth(&(0.5 * (corners[0] + corners[2]))), svg });
        }
        faces
    }
}

/// Adds the lines between cells to a face.
fn add_cells(svg: &mut String, corners: &[Vector; 4], view: &Projection) {
    let [a, b, c, d] = corners;
    let mut line = |from: Vector, to: Vector| {
        // Writing to a string cannot fail.
        let _ = write!(
            svg,
            "<path d=\"M{}\" stroke=\"#9db4da\" stroke-width=\".7\" fill=\"none\"/>",
            view.path(&[from, to])
        );
    };
    // The long sides have more cells.
    let is_first_long = (a - b).norm() > (b - c).norm();
    let [long, short] = if is_first_long { [4, 2] } else { [2, 4] };
    for (count, [p, q], [r, s]) in [(long, [a, b], [d, c]), (short, [b, c], [a, d])] {
        for cut in 1..count {
            let part = f64::from(cut) / f64::from(count);
            line(p + (q - p) * part, r + (s - r) * part);
        }
    }
}

/// Returns the visible faces of solids, the far ones first.
pub fn drawn(solids: &[Solid], view: &Projection) -> String {
    let mut faces: Vec<Vec<Face>> = solids.iter().map(|solid| solid.faces(view)).collect();
    // Whole solids are sorted: their faces do not pass through each other.
    faces.sort_by(|a, b| mean_depth(a).total_cmp(&mean_depth(b)));
    for own in &mut faces {
        own.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    }
    faces.into_iter().flatten().map(|face| face.svg + "\n").collect()
}

/// Returns the mean depth of faces.
fn mean_depth(faces: &[Face]) -> f64 {
    faces.iter().map(|face| face.depth).sum::<f64>() / faces.len() as f64
}
