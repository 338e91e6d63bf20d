//! Solid elements: their shape functions in natural coordinates, and the quadrature points of their mass.
//!
//! Shape functions are the polynomials of a kind that are 1 at one node and 0 at the others, and follow from nodes and
//! monomials.

use flexsc_numerics::inverse::inverse;
use nalgebra::{DMatrix, Matrix3, Vector3};

/// Kinds of elements, with the order of nodes that `CalculiX` writes.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ElementKind {
    /// Brick with nodes at its corners.
    Brick8,
    /// Brick with nodes at its corners and edges.
    Brick20,
    /// Wedge with nodes at its corners.
    Wedge6,
    /// Wedge with nodes at its corners and edges.
    Wedge15,
    /// Tetrahedron with nodes at its corners.
    Tetrahedron4,
    /// Tetrahedron with nodes at its corners and edges.
    Tetrahedron10,
}

/// Quadrature rule of the mass.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MassRule {
    /// Number of points of a program's reduced integration of the element.
    Reduced,
    /// Full number of points.
    Full,
}

/// Hollow section of a beam, with the thickness of its wall, in the square or rectangle to which the beam is expanded.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum HollowSection {
    /// Tube.
    Pipe {
        /// Thickness.
        wall: f64,
    },
    /// Rectangular tube.
    Box {
        /// Thickness.
        wall: f64,
    },
}

impl HollowSection {
    /// Returns points of the wall in natural coordinates of the section from -1 to 1, whose halves have the lengths `halves`, with
    /// weights of which the whole square has 4; `None` if the wall is thicker than a half.
    pub fn points(self, halves: [f64; 2]) -> Option<Vec<([f64; 2], f64)>> {
        let (Self::Pipe { wall } | Self::Box { wall }) = self;
        let inner = halves.map(|half| 1.0 - wall / half);
        if inner.iter().any(|inner| !(0.0..1.0).contains(inner)) {
            return None;
        }
        Some(match self {
            Self::Pipe { .. } => {
                // Exact up to the seventh power: by the square of the radius, and evenly about the circle.
                let (low, high) = (inner[0] * inner[0], 1.0);
                let rings = TWO_POINTS
                    .into_iter()
                    .map(move |(at, _)| f64::sqrt(0.5 * ((high + low) + (high - low) * at)));
                let weight = std::f64::consts::PI * (high - low) / 16.0;
                let angles = (0..8).map(|k| std::f64::consts::FRAC_PI_8 * (2.0 * f64::from(k) + 1.0));
                let angles: Vec<(f64, f64)> = angles.map(|a| (libm::cos(a), libm::sin(a))).collect();
                rings
                    .flat_map(|r| {
                        angles.iter().map(move |(c, s)| ([r * c, r * s], weight)).collect::<Vec<_>>()
                    })
                    .collect()
            }
            Self::Box { .. } => {
                // The whole without its inside.
                let square = |[x, y]: [f64; 2], sign: f64| {
                    let along =
                        THREE_POINTS.into_iter().flat_map(|a| THREE_POINTS.into_iter().map(move |b| (a, b)));
                    along.map(|(a, b)| ([x * a.0, y * b.0], sign * x * y * a.1 * b.1)).collect::<Vec<_>>()
                };
                [square([1.0; 2], 1.0), square(inner, -1.0)].concat()
            }
        })
    }
}

/// Points of Gauss from -1 to 1, each with its weight.
const TWO_POINTS: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];
const THREE_POINTS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Quadrature point of an element: natural coordinates, and weight.
type QuadraturePoint = ([f64; 3], f64);

/// Shape functions of a kind of element: each is a sum of monomials.
pub struct ShapeFunctions {
    kind: ElementKind,
    monomials: Vec<[i32; 3]>,
    /// Coefficients of the monomials, one column for each function.
    coefficients: DMatrix<f64>,
}

/// Shape functions at a point, with their derivatives by natural coordinates.
pub struct Values {
    /// Values of the functions.
    pub functions: Vec<f64>,
    /// Derivatives of the functions.
    pub derivatives: Vec<Vector3<f64>>,
}

impl ElementKind {
    /// Returns the kind with a number of the format.
    pub const fn from_number(number: usize) -> Option<Self> {
        Some(match number {
            1 => Self::Brick8,
            2 => Self::Wedge6,
            3 => Self::Tetrahedron4,
            4 => Self::Brick20,
            5 => Self::Wedge15,
            6 => Self::Tetrahedron10,
            _ => return None,
        })
    }

    /// Returns the number of nodes.
    pub const fn count(self) -> usize {
        match self {
            Self::Brick8 => 8,
            Self::Brick20 => 20,
            Self::Wedge6 => 6,
            Self::Wedge15 => 15,
            Self::Tetrahedron4 => 4,
            Self::Tetrahedron10 => 10,
        }
    }

    /// Returns the nodes: corners, then edges as the format orders them, for a brick or wedge bottom, upright, top.
    fn nodes(self) -> Vec<[f64; 3]> {
        let (ring, prism): (&[[f64; 2]], bool) = match self {
            Self::Brick8 | Self::Brick20 => (&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]], true),
            Self::Wedge6 | Self::Wedge15 => (&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], true),
            Self::Tetrahedron4 | Self::Tetrahedron10 => (&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], false),
        };
        let layer = |z: f64| ring.iter().map(move |[x, y]| [*x, *y, z]);
        let corners = |z: f64| {
            let after = ring.iter().cycle().skip(1);
            ring.iter()
                .zip(after)
                .map(move |(a, b)| [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1]), z])
        };
        let mut nodes: Vec<[f64; 3]> = if prism {
            let upright = layer(-1.0).map(|[x, y, _]| [x, y, 0.0]);
            layer(-1.0).chain(layer(1.0)).chain(corners(-1.0)).chain(upright).chain(corners(1.0)).collect()
        } else {
            let upright = ring.iter().map(|[x, y]| [x / 2.0, y / 2.0, 0.5]);
            layer(0.0).chain([[0.0, 0.0, 1.0]]).chain(corners(0.0)).chain(upright).collect()
        };
        nodes.truncate(self.count());
        nodes
    }

    /// Returns the monomials of which the shape functions consist.
    fn monomials(self) -> Vec<[i32; 3]> {
        let all = (0..27).map(|index| [index % 3, index / 3 % 3, index / 9]);
        let squares = |powers: &[i32; 3]| powers.iter().filter(|power| **power == 2).count();
        let fits = |powers: &[i32; 3]| {
            let [x, y, z] = *powers;
            match self {
                Self::Brick8 => squares(powers) == 0,
                // At most one square, in addition to the monomials of the corners.
                Self::Brick20 => squares(powers) <= 1,
                Self::Wedge6 => x + y <= 1 && z <= 1,
                Self::Wedge15 => x + y <= 2 && z <= 1 || x + y <= 1,
                Self::Tetrahedron4 => x + y + z <= 1,
                Self::Tetrahedron10 => x + y + z <= 2,
            }
        };
        all.filter(fits).collect()
    }

    /// Returns the quadrature points of the mass, with their weights.
    pub fn points(self, rule: MassRule) -> Vec<QuadraturePoint> {
        let line = |count: usize| -> &[(f64, f64)] {
            match count {
                1 => &[(0.0, 2.0)],
                2 => &TWO_POINTS,
                _ => &THREE_POINTS,
            }
        };
        let full = rule == MassRule::Full;
        match self {
            Self::Brick8 | Self::Brick20 => {
                let along = line(match (self, full) {
                    (Self::Brick8, false) => 1,
                    (Self::Brick20, true) => 3,
                    _ => 2,
                });
                let places = along.iter().flat_map(|x| along.iter().map(move |y| (x, y)));
                places
                    .flat_map(|(x, y)| along.iter().map(move |z| ([x.0, y.0, z.0], x.1 * y.1 * z.1)))
                    .collect()
            }
            Self::Wedge6 => line(2).iter().map(|z| ([1.0 / 3.0, 1.0 / 3.0, z.0], 0.5 * z.1)).collect(),
            Self::Wedge15 => {
                let across = [[1.0 / 6.0; 2], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0]];
                let places = across.iter().flat_map(|base| line(3).iter().map(move |z| (base, z)));
                places.map(|([x, y], z)| ([*x, *y, z.0], z.1 / 6.0)).collect()
            }
            Self::Tetrahedron4 => vec![([0.25; 3], 1.0 / 6.0)],
            // Four points, as in the program.
            Self::Tetrahedron10 => {
                let (near, far) = (0.138_196_601_125_010_5, 0.585_410_196_624_968_5);
                [[near; 3], [far, near, near], [near, far, near], [near, near, far]]
                    .map(|corner| (corner, 1.0 / 24.0))
                    .to_vec()
            }
        }
    }

    /// Returns the distance of natural coordinates from the element: 0 inside.
    pub fn outside(self, point: &Vector3<f64>) -> f64 {
        let beyond = |excess: f64| excess.max(0.0);
        match self {
            Self::Brick8 | Self::Brick20 => beyond(point.amax() - 1.0),
            Self::Wedge6 | Self::Wedge15 => {
                beyond(-point.x).max(-point.y).max(point.x + point.y - 1.0).max(point.z.abs() - 1.0)
            }
            Self::Tetrahedron4 | Self::Tetrahedron10 => beyond(-point.min()).max(point.sum() - 1.0),
        }
    }
}

impl ShapeFunctions {
    /// Creates the shape functions of a kind of element.
    pub fn for_kind(kind: ElementKind) -> Self {
        let (nodes, monomials) = (kind.nodes(), kind.monomials());
        let count = kind.count();
        let at_nodes = DMatrix::from_fn(count, count, |node, power| monomial(monomials[power], nodes[node]));
        // Nodes of these elements determine their polynomials.
        let coefficients = inverse(at_nodes).unwrap_or_else(|| DMatrix::zeros(count, count));
        Self { kind, monomials, coefficients }
    }

    /// Returns the kind of element.
    pub const fn kind(&self) -> ElementKind {
        self.kind
    }

    /// Returns the values of the functions at a point.
    pub fn at(&self, point: [f64; 3]) -> Values {
        let count = self.monomials.len();
        let mut values = Values { functions: vec![0.0; count], derivatives: vec![Vector3::zeros(); count] };
        for (row, powers) in self.monomials.iter().enumerate() {
            let value = monomial(*powers, point);
            let slopes: [f64; 3] = std::array::from_fn(|axis| {
                let mut lower = *powers;
                lower[axis] -= 1;
                if powers[axis] == 0 { 0.0 } else { f64::from(powers[axis]) * monomial(lower, point) }
            });
            for node in 0..count {
                let coefficient = self.coefficients[(row, node)];
                values.functions[node] += coefficient * value;
                values.derivatives[node] += Vector3::from(slopes) * coefficient;
            }
        }
        values
    }
}

fn monomial(powers: [i32; 3], point: [f64; 3]) -> f64 {
    // Powers are 0, 1 or 2.
    let one = |power: i32, x: f64| [1.0, x, x * x][power.clamp(0, 2) as usize];
    powers.iter().zip(point).map(|(power, x)| one(*power, x)).product()
}

impl Values {
    /// Interpolates vectors given at the nodes.
    pub fn interpolate(&self, nodes: impl Iterator<Item = Vector3<f64>>) -> Vector3<f64> {
        self.functions.iter().zip(nodes).map(|(function, node)| node * *function).sum()
    }

    /// Returns the derivatives of vectors interpolated from the nodes: one column for each natural coordinate.
    pub fn slopes(&self, nodes: impl Iterator<Item = Vector3<f64>>) -> Matrix3<f64> {
        self.derivatives.iter().zip(nodes).map(|(slope, node)| node * slope.transpose()).sum()
    }
}
