//! Integrals of a mode over the solids of a structure, with the masses of the run.
//!
//! Four numbers for each node suffice: m, the integral of w dm, and s, that of r w dm, with the node's shape function
//! w.

use std::collections::BTreeMap;

use flexsc_numerics::inverse::inverse_3x3;
use nalgebra::{DMatrix, Matrix3, Vector3};

use super::deck::{Deck, HollowBeam, PointMass};
use super::element::{ElementKind, MassRule, ShapeFunctions, Values};
use super::frd::{Element, Frd};
use super::{FileMass, FileMode, FileResults, StructurePoint, lowest, tables::ParticipationTable};

/// Tolerance of the normalisation and orthogonality of shapes in the mass of the structure.
const NORMALISED: f64 = 1e-3;
/// Displacement of a node at rest, of the largest: constraints of expanded beams leave rounding.
const AT_REST: f64 = 1e-8;
/// Distance of the centre of mass from where it should be, relative to the spread of the mass, up to which the origin is the root.
const NEAR: f64 = 0.05;
/// Tolerance by which a point of an element may be outside of it, relative to the element.
const INSIDE: f64 = 1e-3;
/// Tolerance by which a point is in the middle of an element in a direction, relative to the element: positions have
/// six digits.
const MIDDLE: f64 = 1e-3;

/// Computes the modes of a file of shapes, with the masses of its deck.
///
/// # Errors
/// An inconsistency, with its line.
pub fn modes(
    mut frd: Frd,
    deck: &Deck,
    keep: Option<usize>,
    points: &[StructurePoint],
    centre: Option<[f64; 3]>,
) -> Result<FileResults, String> {
    let natural: Vec<_> = frd.shapes.iter().map(|shape| shape.natural.clone()).collect();
    if let Some(first) = natural.first().filter(|first| first.mode != 1) {
        return Err(format!("line {}: must begin with mode 1, got mode {}", first.line, first.mode));
    }
    let natural =
        lowest(natural, [&ParticipationTable::new("factors"), &ParticipationTable::new("masses")], keep)?;
    let mut shapes = Vec::with_capacity(natural.len());
    for natural in &natural {
        if let Some(index) = frd.shapes.iter().position(|shape| shape.natural.mode == natural.mode) {
            shapes.push(frd.shapes.swap_remove(index).displacements);
        }
    }
    let mut sums = Sums::new(frd.positions.len(), shapes.len());
    let mut rules = Rules::default();
    for element in &frd.elements {
        sums.add(element, &frd, deck, &mut rules, &shapes)?;
    }
    for mass in &deck.masses {
        sums.add_point(mass, &frd, deck, &mut rules, &shapes)?;
    }
    sums.are_normalised()?;
    let clamp = clamp(&frd.positions, &shapes);
    let root = centre.and_then(|centre| sums.root(&Vector3::from(centre), clamp, &frd)).unwrap_or_default();
    let place = |point: &StructurePoint| {
        let at = (Vector3::from(point.at) + root).into();
        Found::for_point(&StructurePoint { name: point.name.clone(), at }, &frd, &mut rules)
    };
    let places = points.iter().map(place).collect::<Result<Vec<_>, _>>()?;
    let modes = natural.iter().zip(&shapes).map(|(natural, shape)| {
        let scale = 1.0 / f64::sqrt(natural.generalised_mass);
        let (mut translation, mut moments) = (Vector3::zeros(), Matrix3::zeros());
        for ((mass, moment), phi) in sums.masses.iter().zip(&sums.moments).zip(shape) {
            translation += phi * (scale * mass);
            moments += moment * phi.transpose() * scale;
        }
        let n = moments - root * translation.transpose();
        let rotation = [n[(1, 2)] - n[(2, 1)], n[(2, 0)] - n[(0, 2)], n[(0, 1)] - n[(1, 0)]];
        FileMode {
            frequency: natural.frequency,
            translation: translation.into(),
            rotation,
            moments: Some(std::array::from_fn(|row| std::array::from_fn(|column| n[(row, column)]))),
            damping: None,
            shapes: places.iter().map(|place| place.shape(&frd, shape, scale)).collect(),
        }
    });
    let modes = modes.collect();
    Ok(FileResults { modes, mass: Some(sums.about(&root, clamp)) })
}

/// Returns the least and greatest coordinates of the nodes that are at rest in all shapes.
fn clamp(positions: &[Vector3<f64>], shapes: &[Vec<Vector3<f64>>]) -> Option<[Vector3<f64>; 2]> {
    let bounds: Vec<f64> =
        shapes.iter().map(|shape| AT_REST * shape.iter().map(Vector3::amax).fold(0.0, f64::max)).collect();
    let at_rest =
        |node: &usize| shapes.iter().zip(&bounds).all(|(shape, bound)| shape[*node].amax() <= *bound);
    let held = (0..positions.len()).filter(at_rest).map(|node| positions[node]);
    held.map(|at| [at, at]).reduce(|[low, high], [at, _]| [low.inf(&at), high.sup(&at)])
}

/// Cache of shape functions and quadrature points.
#[derive(Default)]
struct Rules {
    functions: BTreeMap<ElementKind, ShapeFunctions>,
    points: BTreeMap<(ElementKind, MassRule), Vec<(Values, f64)>>,
}

impl Rules {
    fn functions(&mut self, kind: ElementKind) -> &ShapeFunctions {
        self.functions.entry(kind).or_insert_with(|| ShapeFunctions::for_kind(kind))
    }

    fn points(&mut self, kind: ElementKind, rule: MassRule) -> &[(Values, f64)] {
        let functions = self.functions.entry(kind).or_insert_with(|| ShapeFunctions::for_kind(kind));
        self.points.entry((kind, rule)).or_insert_with(|| {
            kind.points(rule).into_iter().map(|(point, weight)| (functions.at(point), weight)).collect()
        })
    }
}

/// Sums over elements and masses.
struct Sums {
    /// Integral of each node's shape function over mass.
    masses: Vec<f64>,
    /// Integral of each node's shape function times position over mass.
    moments: Vec<Vector3<f64>>,
    /// Integrals of phi_i . phi_j over mass.
    products: DMatrix<f64>,
    /// Integral of r r' dm.
    second: Matrix3<f64>,
}

impl Sums {
    fn new(nodes: usize, modes: usize) -> Self {
        Self {
            masses: vec![0.0; nodes],
            moments: vec![Vector3::zeros(); nodes],
            products: DMatrix::zeros(modes, modes),
            second: Matrix3::zeros(),
        }
    }

    fn mass(&self) -> f64 {
        self.masses.iter().sum()
    }

    /// Returns the root from which the centre of mass is at `centre`: the origin if it is there, or a point of the clamp.
    fn root(
        &self,
        centre: &Vector3<f64>,
        clamp: Option<[Vector3<f64>; 2]>,
        frd: &Frd,
    ) -> Option<Vector3<f64>> {
        let own = self.moments.iter().sum::<Vector3<f64>>() / self.mass();
        let spread = (self.second / self.mass() - own * own.transpose()).trace() + centre.norm_squared();
        let root = own - centre;
        let [low, high] = clamp.filter(|_| root.norm_squared() > NEAR * NEAR * spread)?;
        let (least, greatest) =
            frd.positions.iter().fold((own, own), |(low, high), at| (low.inf(at), high.sup(at)));
        let margin = NEAR * (greatest - least).norm();
        (0..3).all(|axis| (low[axis] - margin..=high[axis] + margin).contains(&root[axis])).then_some(root)
    }

    /// Returns the mass about a point.
    fn about(&self, root: &Vector3<f64>, clamp: Option<[Vector3<f64>; 2]>) -> FileMass {
        let (mass, sum) = (self.mass(), self.moments.iter().sum::<Vector3<f64>>());
        let second =
            self.second - root * sum.transpose() - sum * root.transpose() + root * root.transpose() * mass;
        FileMass {
            mass,
            moment: Some((sum - root * mass).into()),
            inertia: Some(std::array::from_fn(|axis| second.trace() - second[(axis, axis)])),
            clamp: clamp.map(|corners| corners.map(|corner| (corner - root).into())),
        }
    }

    fn add(
        &mut self,
        element: &Element,
        frd: &Frd,
        deck: &Deck,
        rules: &mut Rules,
        shapes: &[Vec<Vector3<f64>>],
    ) -> Result<(), String> {
        let Element { line, number, kind, .. } = element;
        let material = frd.materials.get(&element.material).ok_or_else(|| {
            format!(
                "line {line}: element {number} must have a material of the file, got {}",
                element.material
            )
        })?;
        let density = *deck.densities.get(material).ok_or_else(|| {
            format!("line {line}: element {number} must have a *DENSITY of {material} in the deck")
        })?;
        let rule = *deck
            .rules
            .get(number)
            .ok_or_else(|| format!("line {line}: element {number} must be one of the deck"))?;
        let positions = || element.nodes.iter().map(|node| frd.positions[*node]);
        let wall;
        let points = if let Some(beam) = deck.hollow.get(number) {
            let functions = rules.functions(*kind);
            let axes = functions.at([0.0; 3]).slopes(positions());
            wall = hollow_points(beam, deck, functions, &axes).ok_or_else(|| {
                format!("line {line}: element {number} must have a wall within its section")
            })?;
            &wall[..]
        } else {
            rules.points(*kind, rule)
        };
        for (values, weight) in points {
            let volume = values.slopes(positions()).determinant();
            // What overflows is no volume either.
            if volume.is_nan() || volume <= 0.0 {
                return Err(format!(
                    "line {line}: element {number} must not be turned inside out: are its nodes in order?"
                ));
            }
            let mass = density * weight * volume;
            self.add_mass(mass, &values.interpolate(positions()), values, &element.nodes, shapes);
        }
        Ok(())
    }

    /// Adds a mass at a position in an element.
    fn add_mass(
        &mut self,
        mass: f64,
        position: &Vector3<f64>,
        values: &Values,
        nodes: &[usize],
        shapes: &[Vec<Vector3<f64>>],
    ) {
        for (function, node) in values.functions.iter().zip(nodes) {
            self.masses[*node] += mass * function;
            self.moments[*node] += position * (mass * function);
        }
        self.second += position * position.transpose() * mass;
        let moved: Vec<_> =
            shapes.iter().map(|shape| values.interpolate(nodes.iter().map(|node| shape[*node]))).collect();
        for (i, one) in moved.iter().enumerate() {
            for (j, other) in moved.iter().enumerate().take(i + 1) {
                self.products[(i, j)] += mass * one.dot(other);
            }
        }
    }

    /// Adds a mass at a node: of a solid, or of a shell or beam that was expanded to solids, with which it moves.
    fn add_point(
        &mut self,
        point: &PointMass,
        frd: &Frd,
        deck: &Deck,
        rules: &mut Rules,
        shapes: &[Vec<Vector3<f64>>],
    ) -> Result<(), String> {
        if let Some(place) = frd.places.get(&point.node) {
            let single_node = Values { functions: vec![1.0], derivatives: Vec::new() };
            self.add_mass(point.mass, &frd.positions[*place], &single_node, &[*place], shapes);
            return Ok(());
        }
        let (line, node) = (point.line, point.node);
        let position = *deck
            .positions
            .get(&node)
            .ok_or_else(|| format!("line {line} of the deck: must have a node of the deck, got {node}"))?;
        let wrong = |why| format!("line {line} of the deck: {why}");
        let place = StructurePoint { name: format!("node {node}"), at: position.into() };
        let found = Found::for_point(&place, frd, rules).map_err(wrong)?;
        let part = point.mass / found.within.len() as f64;
        for within in &found.within {
            let Element { kind, nodes, .. } = &frd.elements[within.element];
            let functions = rules.functions(*kind);
            let across = within.across();
            for point in &across {
                let mass = part / across.len() as f64;
                self.add_mass(mass, &position, &functions.at(*point), nodes, shapes);
            }
        }
        Ok(())
    }

    /// Checks that the shapes are normalised by these masses.
    fn are_normalised(&self) -> Result<(), String> {
        for i in 0..self.products.nrows() {
            for j in 0..=i {
                let (found, exact) = (self.products[(i, j)], f64::from(u8::from(i == j)));
                let off = (found - exact).abs();
                if off.is_nan() || off > NORMALISED {
                    return Err(format!(
                        "must have shapes normalised by the mass of the deck, and the integral of mode {} times mode {} of \
                         the lowest is {found}, not {exact}: is it the deck of this run, with its densities and masses?",
                        i + 1,
                        j + 1
                    ));
                }
            }
        }
        Ok(())
    }
}

/// Returns the quadrature points of the wall of a hollow beam, which is expanded to a brick with these axes; `None` if its ends
/// are none of the deck, or its wall is too thick.
fn hollow_points(
    beam: &HollowBeam,
    deck: &Deck,
    functions: &ShapeFunctions,
    axes: &Matrix3<f64>,
) -> Option<Vec<(Values, f64)>> {
    let [from, to] = beam.ends;
    let along = deck.positions.get(&to)? - deck.positions.get(&from)?;
    let cosine = |axis: usize| (axes.column(axis).dot(&along) / axes.column(axis).norm()).abs();
    let axis = (0..3).max_by(|a, b| cosine(*a).total_cmp(&cosine(*b)))?;
    let across = [(axis + 1) % 3, (axis + 2) % 3];
    let wall = beam.section.points(across.map(|axis| axes.column(axis).norm()))?;
    let gauss = f64::sqrt(1.0 / 3.0);
    let points = wall.iter().flat_map(|point| [-gauss, gauss].map(|at| (at, *point)));
    let value = |(at, (place, weight)): (f64, ([f64; 2], f64))| {
        let mut natural = [0.0; 3];
        (natural[axis], natural[across[0]], natural[across[1]]) = (at, place[0], place[1]);
        (functions.at(natural), weight)
    };
    Some(points.map(value).collect())
}

/// Point with the elements that contain it.
struct Found {
    within: Vec<Within>,
}

/// Position of a point in an element.
struct Within {
    element: usize,
    /// Natural coordinates of the point.
    natural: Vector3<f64>,
    /// Shape functions at the point.
    values: Values,
    /// Derivatives of the position by natural coordinates, one column each.
    directions: Matrix3<f64>,
}

impl Within {
    /// Returns the points whose mean represents the section of a beam or the thickness of a shell, of which this point
    /// is the middle.
    fn across(&self) -> Vec<[f64; 3]> {
        let longest = (0..3).map(|axis| self.directions.column(axis).norm()).fold(0.0, f64::max);
        let mut points = vec![self.natural];
        for axis in 0..3 {
            if self.natural[axis].abs() < MIDDLE && self.directions.column(axis).norm() < 0.5 * longest {
                let gauss = Vector3::ith(axis, f64::sqrt(1.0 / 3.0));
                points = points.iter().flat_map(|point| [point - gauss, point + gauss]).collect();
            }
        }
        points.into_iter().map(Into::into).collect()
    }
}

impl Found {
    fn for_point(point: &StructurePoint, frd: &Frd, rules: &mut Rules) -> Result<Self, String> {
        let position = Vector3::from(point.at);
        let mut within = Vec::new();
        for (index, element) in frd.elements.iter().enumerate() {
            let (mut low, mut high) = (frd.positions[element.nodes[0]], frd.positions[element.nodes[0]]);
            for node in &element.nodes {
                low = low.inf(&frd.positions[*node]);
                high = high.sup(&frd.positions[*node]);
            }
            let margin = INSIDE * (high - low).norm();
            if (0..3).all(|axis| (low[axis] - margin..=high[axis] + margin).contains(&position[axis]))
                && let Some(found) = locate(rules.functions(element.kind), (index, element), frd, &position)
            {
                within.push(found);
            }
        }
        if within.is_empty() {
            let StructurePoint { name, at: [x, y, z] } = point;
            return Err(format!("must have an element at point `{name}`, and has none at [{x}, {y}, {z}]"));
        }
        Ok(Self { within })
    }

    /// Returns displacement and rotation of a shape at the point. The rotation is weighted towards the short directions
    /// of an element: sections of a thin one turn as its nodes move, and along it shapes bend more than its functions
    /// can.
    fn shape(&self, frd: &Frd, shape: &[Vector3<f64>], scale: f64) -> [[f64; 3]; 2] {
        let (mut displacement, mut rotation) = (Vector3::zeros(), Vector3::zeros());
        let part = scale / self.within.len() as f64;
        for Within { element, values, directions, .. } in &self.within {
            let nodes = || frd.elements[*element].nodes.iter().map(|node| shape[*node]);
            displacement += values.interpolate(nodes()) * part;
            let slopes = values.slopes(nodes());
            let (mut matrix, mut side) = (Matrix3::zeros(), Vector3::zeros());
            for axis in 0..3 {
                let along = directions.column(axis).into_owned();
                let weight = 1.0 / (along.norm_squared() * along.norm_squared());
                matrix += (Matrix3::identity() * along.norm_squared() - along * along.transpose()) * weight;
                side += along.cross(&slopes.column(axis)) * weight;
            }
            rotation += inverse_3x3(matrix).unwrap_or_else(Matrix3::zeros) * side * part;
        }
        [displacement.into(), rotation.into()]
    }
}

/// Finds the natural coordinates of a position in an element by Newton's method; `None` if it is outside.
fn locate(
    functions: &ShapeFunctions,
    (index, element): (usize, &Element),
    frd: &Frd,
    position: &Vector3<f64>,
) -> Option<Within> {
    let positions = || element.nodes.iter().map(|node| frd.positions[*node]);
    let mut natural = Vector3::zeros();
    for _ in 0..20 {
        let values = functions.at(natural.into());
        let directions = values.slopes(positions());
        let step = inverse_3x3(directions)? * (position - values.interpolate(positions()));
        if step.amax() < 1e-12 {
            let inside = functions.kind().outside(&natural) < INSIDE;
            return inside.then_some(Within { element: index, natural, values, directions });
        }
        natural += step;
        if natural.amax() > 10.0 {
            break;
        }
    }
    None
}
