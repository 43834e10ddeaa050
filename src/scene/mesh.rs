use super::{Colors, Material, Texture};
use glam::{DVec2, DVec3};

/// A triangle mesh in its rest frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// x of every vertex.
    pub x: Vec<f64>,
    /// y of every vertex.
    pub y: Vec<f64>,
    /// z of every vertex.
    pub z: Vec<f64>,
    /// Three vertex indices a triangle, in the file's order.
    pub triangles: Vec<[u32; 3]>,
    /// The mesh's own colours.
    pub paint: Paint,
    /// What its surfaces are made of; none for paint alone.
    pub materials: Vec<Material>,
    /// Index of every triangle's material; empty where all are of the first.
    pub material: Vec<u32>,
    /// Texture coordinates, one a vertex, or none.
    pub uv: Vec<[f32; 2]>,
    /// Unit normals in the rest frame, one a vertex, or none.
    pub normals: Vec<[f32; 3]>,
    /// Whether its paint stands for colours it does not have; see [`paint_as_clay`](Self::paint_as_clay).
    pub clay: bool,
}

/// Linear sRGB colours (Rec. 709 primaries, D65) of a mesh's surface; where there are materials, times theirs.
#[derive(Clone, Debug, PartialEq)]
pub enum Paint {
    /// One colour.
    Uniform([f32; 3]),
    /// One a triangle.
    Faces(Vec<[f32; 3]>),
    /// One a vertex, interpolated in the rest frame.
    Vertices(Vec<[f32; 3]>),
}

impl Default for Paint {
    fn default() -> Self {
        Self::Uniform(Self::CLAY)
    }
}

/// Why a mesh cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// There is not one triangle.
    #[error("the mesh has no triangles")]
    Empty,
    /// A coordinate is NaN, infinite or too large to square.
    #[error("vertex {vertex} is at ({position}); every coordinate must be finite and below 1e50")]
    BadVertex {
        /// Its index.
        vertex: usize,
        /// What was found.
        position: String,
    },
    /// A triangle is of a material that is not there.
    #[error("triangle {triangle} is of material {material}, but the mesh has {count}")]
    BadMaterial {
        /// The triangle.
        triangle: usize,
        /// The index it uses.
        material: u32,
        /// How many there are.
        count: usize,
    },
    /// A colour that is NaN or infinite.
    #[error("a colour is not a finite number")]
    BadColor,
    /// So small that areas vanish.
    #[error("the mesh is less than 1e-50 across; scale it up")]
    TooSmall,
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} uses vertex {vertex}, but the mesh has {count} vertices (0 to {})", .count.saturating_sub(1))]
    BadIndex {
        /// The triangle.
        triangle: usize,
        /// The index it uses.
        vertex: u32,
        /// How many there are.
        count: usize,
    },
    /// A list of attributes has the wrong length.
    #[error("{what}: {found} values where the mesh needs {needed}")]
    BadAttribute {
        /// Which.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        needed: usize,
    },
}

impl Mesh {
    /// A mesh of bare geometry.
    pub fn new(vertices: &[DVec3], triangles: Vec<[u32; 3]>) -> Self {
        Self {
            x: vertices.iter().map(|v| v.x).collect(),
            y: vertices.iter().map(|v| v.y).collect(),
            z: vertices.iter().map(|v| v.z).collect(),
            triangles,
            ..Self::default()
        }
    }

    /// How many vertices there are.
    pub fn vertex_count(&self) -> usize {
        self.x.len()
    }

    /// Position of a vertex.
    #[inline]
    pub fn vertex(&self, index: u32) -> DVec3 {
        let i = index as usize;
        DVec3::new(self.x[i], self.y[i], self.z[i])
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|v| self.vertex(v))
    }

    /// What a triangle is made of; none where there is only paint.
    #[inline]
    pub fn material_of(&self, triangle: usize) -> Option<&Material> {
        self.materials.get(self.material_index(triangle))
    }

    /// Whether a triangle is seen from its front only.
    #[inline]
    pub fn is_one_sided(&self, triangle: usize) -> bool {
        self.material_of(triangle).is_some_and(|m| m.one_sided)
    }

    /// Texture coordinates of a triangle's corners.
    #[inline]
    pub fn corner_uv(&self, triangle: usize) -> Option<[DVec2; 3]> {
        let uv = |v: u32| self.uv.get(v as usize).map(|uv| DVec2::new(uv[0].into(), uv[1].into()));
        let [a, b, c] = self.triangles[triangle].map(uv);
        Some([a?, b?, c?])
    }

    /// The surface's colours at a point of a triangle, given its barycentric coordinates; `look` gives a texture's
    /// colour there.
    #[inline]
    pub fn colors(&self, triangle: usize, weights: [f64; 3], look: impl Fn(&Texture) -> [f32; 3]) -> Colors {
        let paint = self.paint.at(triangle, self.triangles[triangle], weights);
        let plain = Colors { base: paint, ..Colors::default() };
        self.material_of(triangle).map_or(plain, |m| m.colors(paint, look))
    }

    /// The colour there if it shines by itself.
    #[inline]
    pub fn color(&self, triangle: usize, weights: [f64; 3], look: impl Fn(&Texture) -> [f32; 3]) -> [f32; 3] {
        self.colors(triangle, weights, look).sum()
    }

    /// Number of a triangle's material among [`materials`](Self::materials); 0 where there is only paint.
    #[inline]
    pub fn material_index(&self, triangle: usize) -> usize {
        self.material.get(triangle).map_or(0, |m| *m as usize)
    }

    /// Gives the whole mesh one colour, in place of paint, textures and emission.
    pub fn repaint(&mut self, color: [f32; 3]) {
        self.clay = false;
        self.paint = Paint::Uniform(color);
        for material in &mut self.materials {
            *material = Material {
                base_color: [1.0; 3],
                base_texture: None,
                emission: [0.0; 3],
                emission_texture: None,
                ..std::mem::take(material)
            };
        }
    }

    /// Least and greatest coordinates; none for a mesh without vertices.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let range = |c: &[f64]| {
            c.iter().fold(None, |range: Option<(f64, f64)>, &v| {
                Some(range.map_or((v, v), |(low, high)| (low.min(v), high.max(v))))
            })
        };
        let (x, y, z) = (range(&self.x)?, range(&self.y)?, range(&self.z)?);
        Some((DVec3::new(x.0, y.0, z.0), DVec3::new(x.1, y.1, z.1)))
    }

    /// The middle of the bounding box.
    pub fn centre(&self) -> DVec3 {
        self.bounds().map_or(DVec3::ZERO, |(low, high)| 0.5 * (low + high))
    }

    /// How many times its surface goes around a point: ±1 inside a closed one, 0 outside, between for one with holes. The
    /// sum of its triangles' solid angles over 4π (van Oosterom and Strackee 1983, Eq. 8).
    pub fn winding(&self, point: DVec3) -> f64 {
        let half_angle = |triangle: usize| {
            let [a, b, c] = self.corners(triangle).map(|corner| corner - point);
            let [la, lb, lc] = [a.length(), b.length(), c.length()];
            let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            a.dot(b.cross(c)).atan2(below)
        };
        (0..self.triangles.len()).map(half_angle).sum::<f64>() / std::f64::consts::TAU
    }

    /// Every vertex moved by `place`; normals turned by its linear part.
    pub fn placed(mut self, place: &glam::DAffine3) -> Self {
        for i in 0..self.vertex_count() {
            let at = place.transform_point3(self.vertex(i as u32));
            (self.x[i], self.y[i], self.z[i]) = (at.x, at.y, at.z);
        }
        let linear = place.matrix3;
        if linear.determinant() < 0.0 {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        // Cofactors turn normals also where the map is singular.
        let cofactors = glam::DMat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        );
        for normal in &mut self.normals {
            let turned = cofactors * DVec3::from_array(normal.map(f64::from));
            *normal = turned.normalize_or_zero().as_vec3().to_array();
        }
        self
    }

    /// Paints a mesh that brings no colours so that its shape can be read: every face luminous in grey by the
    /// direction it looks in the rest frame. It is paint, not light: it moves with the body.
    pub fn paint_as_clay(&mut self) {
        const LIT_FROM: DVec3 = DVec3::new(0.41, 0.74, 0.53);
        let color = |t: usize| {
            let [a, b, c] = self.corners(t);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let shade = (0.5 + 0.5 * normal.dot(LIT_FROM)) as f32;
            Paint::CLAY.map(|v| v * (0.08 + 0.92 * shade * shade))
        };
        self.paint = Paint::Faces((0..self.triangles.len()).map(color).collect());
        self.clay = true;
    }

    /// Joins another mesh behind this one, its triangles numbered on.
    pub fn append(&mut self, other: Self) {
        let (vertices, triangles) = (self.vertex_count(), self.triangles.len());
        let paint = std::mem::take(&mut self.paint);
        if triangles == 0 {
            *self = other;
            return;
        }
        if self.materials.is_empty() && other.materials.is_empty() {
            // Of one list, still to come.
            if !(self.material.is_empty() && other.material.is_empty()) {
                self.material.resize(triangles, 0);
                self.material.extend_from_slice(&other.material);
                self.material.resize(triangles + other.triangles.len(), 0);
            }
        } else {
            let own = self.materials.len().max(1) as u32;
            self.materials.resize_with(own as usize, Material::default);
            self.materials.extend(other.materials);
            self.materials.resize_with(self.materials.len().max(own as usize + 1), Material::default);
            self.material.resize(triangles, 0);
            let theirs = |t: usize| own + other.material.get(t).copied().unwrap_or(0);
            self.material.extend((0..other.triangles.len()).map(theirs));
        }
        fill_up(&mut self.uv, vertices, &other.uv, other.x.len(), [0.0; 2]);
        fill_up(&mut self.normals, vertices, &other.normals, other.x.len(), [0.0; 3]);
        self.paint = match (paint, &other.paint) {
            (Paint::Uniform(a), Paint::Uniform(b)) if a == *b => Paint::Uniform(a),
            (a @ Paint::Vertices(_), b) | (a, b @ Paint::Vertices(_)) => {
                let mut colors = a.of_vertices(vertices, &self.triangles);
                colors.extend(b.of_vertices(other.x.len(), &other.triangles));
                Paint::Vertices(colors)
            }
            (a, b) => {
                let mut colors = a.of_faces(triangles);
                colors.extend(b.of_faces(other.triangles.len()));
                Paint::Faces(colors)
            }
        };
        self.x.extend(other.x);
        self.y.extend(other.y);
        self.z.extend(other.z);
        let shift = vertices as u32;
        self.triangles.extend(other.triangles.into_iter().map(|t| t.map(|v| v.saturating_add(shift))));
    }

    /// Checks what drawing relies on.
    ///
    /// # Errors
    /// On an empty mesh, coordinates that are not numbers, indices that lead nowhere, attributes of the wrong
    /// length.
    pub fn check(&self) -> Result<(), MeshError> {
        let count = self.vertex_count();
        if self.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        for vertex in 0..count {
            let at = self.vertex(vertex as u32);
            if !at.is_finite() || at.abs().max_element() >= 1e50 {
                let position = format!("{}, {}, {}", at.x, at.y, at.z);
                return Err(MeshError::BadVertex { vertex, position });
            }
        }
        if let Some((low, high)) = self.bounds()
            && low != high
            && (high - low).max_element() < 1e-50
        {
            return Err(MeshError::TooSmall);
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= count) {
                return Err(MeshError::BadIndex { triangle, vertex, count });
            }
        }
        let lengths = [
            ("texture coordinates", self.uv.len(), count),
            ("normals", self.normals.len(), count),
            ("materials of triangles", self.material.len(), self.triangles.len()),
        ];
        for (what, found, needed) in lengths {
            if found != 0 && found != needed {
                return Err(MeshError::BadAttribute { what, found, needed });
            }
        }
        let known = self.materials.len().max(1);
        let unknown = self.material.iter().enumerate().find(|(_, m)| **m as usize >= known);
        if let Some((triangle, &material)) = unknown {
            return Err(MeshError::BadMaterial { triangle, material, count: known });
        }
        let finite = |colors: &[[f32; 3]]| colors.iter().flatten().all(|c| c.is_finite());
        let all_finite = match &self.paint {
            Paint::Uniform(color) => finite(&[*color]),
            Paint::Faces(colors) | Paint::Vertices(colors) => finite(colors),
        };
        if !all_finite || !self.materials.iter().all(Material::is_finite) {
            return Err(MeshError::BadColor);
        }
        let (found, needed) = match &self.paint {
            Paint::Uniform(_) => (0, 0),
            Paint::Faces(colors) => (colors.len(), self.triangles.len()),
            Paint::Vertices(colors) => (colors.len(), count),
        };
        if found != needed {
            return Err(MeshError::BadAttribute { what: "colours", found, needed });
        }
        Ok(())
    }
}

fn fill_up<T: Copy>(own: &mut Vec<T>, own_count: usize, other: &[T], other_count: usize, empty: T) {
    if own.is_empty() && other.is_empty() {
        return;
    }
    own.resize(own_count, empty);
    own.extend_from_slice(other);
    own.resize(own_count + other_count, empty);
}

impl Paint {
    /// What has no colour of its own.
    pub const CLAY: [f32; 3] = [0.8; 3];

    /// Whether the colour is the same all over a triangle.
    #[inline]
    pub fn is_of_faces(&self) -> bool {
        !matches!(self, Self::Vertices(_))
    }

    /// The colour at a point of a triangle, given its barycentric coordinates.
    #[inline]
    pub fn at(&self, face: usize, corners: [u32; 3], weights: [f64; 3]) -> [f32; 3] {
        match self {
            Self::Uniform(color) => *color,
            Self::Faces(colors) => colors[face],
            Self::Vertices(colors) => {
                let [a, b, c] = corners.map(|v| colors[v as usize]);
                let [u, v, w] = weights.map(|w| w as f32);
                [0, 1, 2].map(|i| u * a[i] + v * b[i] + w * c[i])
            }
        }
    }

    fn of_faces(&self, count: usize) -> Vec<[f32; 3]> {
        match self {
            Self::Uniform(color) => vec![*color; count],
            Self::Faces(colors) => colors.clone(),
            Self::Vertices(_) => unreachable!("vertex colours are never turned into face colours"),
        }
    }

    fn of_vertices(&self, count: usize, triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
        match self {
            Self::Uniform(color) => vec![*color; count],
            Self::Vertices(colors) => colors.clone(),
            Self::Faces(colors) => {
                // Importers keep face colours apart from vertex colours, primitive by primitive, so the
                // vertices of differently coloured faces are already separate.
                let mut out = vec![[0.0; 3]; count];
                for (corners, color) in triangles.iter().zip(colors) {
                    corners.iter().for_each(|&v| out[v as usize] = *color);
                }
                out
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        Mesh::new(&[DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])
    }

    #[test]
    fn bad_meshes_are_named() {
        assert_eq!(Mesh::default().check(), Err(MeshError::Empty));
        let mut mesh = triangle();
        mesh.y[1] = f64::NAN;
        assert!(matches!(mesh.check(), Err(MeshError::BadVertex { vertex: 1, .. })));
        mesh.y[1] = 1e200;
        assert!(matches!(mesh.check(), Err(MeshError::BadVertex { vertex: 1, .. })));
        let mut mesh = triangle();
        mesh.triangles.push([0, 1, 3]);
        assert_eq!(mesh.check(), Err(MeshError::BadIndex { triangle: 1, vertex: 3, count: 3 }));
        let mut mesh = triangle();
        mesh.paint = Paint::Faces(vec![]);
        assert!(matches!(mesh.check(), Err(MeshError::BadAttribute { .. })));
        assert_eq!(triangle().check(), Ok(()));
    }

    #[test]
    fn closed_surfaces_go_around_what_is_inside() {
        let mut cube = crate::scene::shapes::cube();
        let at = |mesh: &Mesh, x: f64| mesh.winding(DVec3::new(x, 0.2, -0.1));
        assert!((at(&cube, 0.4).abs() - 1.0).abs() < 1e-12 && at(&cube, 1.6).abs() < 1e-12);
        // Five of six sides, from the middle.
        cube.triangles.truncate(10);
        assert!((cube.winding(cube.centre()).abs() - 5.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn joined_meshes_keep_their_colours_and_numbers() {
        let mut red = triangle();
        red.paint = Paint::Uniform([1.0, 0.0, 0.0]);
        let mut both = Mesh::default();
        both.append(red.clone());
        both.append(triangle());
        assert_eq!(both.triangles, [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(both.paint, Paint::Faces(vec![[1.0, 0.0, 0.0], Paint::CLAY]));
        let mut vertices = triangle();
        vertices.paint = Paint::Vertices(vec![[0.1; 3]; 3]);
        both.append(vertices);
        assert_eq!(both.paint.at(0, [0, 1, 2], [0.2, 0.3, 0.5]), [1.0, 0.0, 0.0]);
        assert_eq!(both.check(), Ok(()));
    }

    #[test]
    fn a_mirrored_mesh_keeps_its_front() {
        let mirrored = triangle().placed(&glam::DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)));
        let [a, b, c] = mirrored.corners(0);
        assert!((b - a).cross(c - a).z > 0.0);
    }
}
