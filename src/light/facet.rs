use super::Point;
use super::point::turned;
use crate::scene::{Colors, Material, Mesh};
use glam::DVec3;

/// A triangle of a mesh in its rest frame, as it is seen from one point there.
#[derive(Clone, Copy, Debug)]
pub struct Facet<'a> {
    mesh: &'a Mesh,
    face: usize,
    /// From where it is seen.
    corners: [DVec3; 3],
}

impl<'a> Facet<'a> {
    /// The triangle `face` of the mesh; `corners` from where it is seen.
    pub fn new(mesh: &'a Mesh, face: usize, corners: [DVec3; 3]) -> Self {
        Self { mesh, face, corners }
    }

    /// The mesh it is of.
    #[inline]
    pub fn mesh(&self) -> &'a Mesh {
        self.mesh
    }

    /// Its number there.
    #[inline]
    pub fn face(&self) -> usize {
        self.face
    }

    /// Its corners, from where it is seen.
    #[inline]
    pub fn corners(&self) -> [DVec3; 3] {
        self.corners
    }

    /// Its normal, of twice its area.
    #[inline]
    pub fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    /// Barycentric coordinates of a point of its plane; negative beside the triangle.
    #[inline]
    pub fn weights(&self, at: DVec3) -> [f64; 3] {
        let [a, b, c] = self.corners.map(|corner| corner - at);
        let normal = self.normal();
        let areas = [b.cross(c), c.cross(a), a.cross(b)].map(|area| area.dot(normal));
        areas.map(|area| area / normal.length_squared())
    }

    /// A point of its plane that is seen directly, with the normal there.
    #[inline]
    pub fn point(&self, at: DVec3) -> Point {
        Point::new(at, self.normal(), self.normal_at(at))
    }

    /// The mesh's normal at a point of its plane that is seen directly: of any length, on the side that is seen.
    #[inline]
    pub fn normal_seen(&self, at: DVec3) -> DVec3 {
        turned(-at, self.normal(), self.normal_at(at))
    }

    /// The mesh's normal at a point of its plane, of any length and side.
    #[inline]
    pub fn normal_at(&self, at: DVec3) -> DVec3 {
        let facing = self.normal();
        let normals = &self.mesh.normals;
        if normals.is_empty() {
            return facing;
        }
        let weights = clamped(self.weights(at));
        let corners = self.mesh.triangles[self.face];
        let normal = |v: u32| DVec3::from_array(normals[v as usize].map(f64::from));
        let normal = (0..3).map(|i| weights[i] * normal(corners[i])).sum::<DVec3>();
        if normal == DVec3::ZERO { facing } else { normal }
    }

    /// A point of its plane, the facet's corners being where they are, as it is seen along a line of sight that points away
    /// from the observer.
    pub fn seen_along(&self, at: DVec3, sight: DVec3) -> Point {
        Point::new(sight, self.normal(), self.point(at).normal)
    }

    /// The surface's colours at a point of its plane; `sights` gives the line of sight to it, and those one pixel to
    /// the right and below, of any length that is linear in the pixel.
    #[inline]
    pub fn colors(&self, at: DVec3, sights: impl FnOnce() -> [DVec3; 3]) -> Colors {
        self.colors_by(at, |weights| self.changes(weights, sights()))
    }

    /// As [`colors`](Self::colors), where lines of sight are not straight: `moves` gives the ways from the point to those
    /// seen one pixel to the right and below; what of them leaves the plane does not matter.
    #[inline]
    pub fn colors_moving(&self, at: DVec3, moves: impl FnOnce() -> [DVec3; 2]) -> Colors {
        self.colors_by(at, |weights| {
            moves().map(|step| {
                let there = self.weights(at + step);
                [0, 1, 2].map(|i| there[i] - weights[i])
            })
        })
    }

    /// The surface's colours, where they are the same all over the triangle.
    pub fn plain_colors(&self) -> Option<Colors> {
        let plain = self.mesh.paint.is_of_faces() && !self.is_textured();
        plain.then(|| self.mesh.colors(self.face, [1.0, 0.0, 0.0], |_| [1.0; 3]))
    }

    #[inline]
    fn is_textured(&self) -> bool {
        self.mesh.material_of(self.face).is_some_and(Material::is_textured)
    }

    #[inline]
    fn colors_by(&self, at: DVec3, changes: impl FnOnce([f64; 3]) -> [[f64; 3]; 2]) -> Colors {
        if let Some(colors) = self.plain_colors() {
            return colors;
        }
        let mesh = self.mesh;
        let weights = clamped(self.weights(at));
        if !self.is_textured() {
            return mesh.colors(self.face, weights, |_| [1.0; 3]);
        }
        let corner_uv = mesh.corner_uv(self.face).unwrap_or_default();
        let mix = |w: [f64; 3]| w[0] * corner_uv[0] + w[1] * corner_uv[1] + w[2] * corner_uv[2];
        let (uv, step) = (mix(weights), changes(weights).map(mix));
        mesh.colors(self.face, weights, |texture| texture.at(uv, step))
    }

    /// How barycentric coordinates change to the two neighbouring lines of sight.
    ///
    /// They are the products eᵢ·v′ with the planes through the observer and the edges, over their sum: linear
    /// in v′ up to that sum, so that the change is had without a neighbour that may miss the plane.
    fn changes(&self, weights: [f64; 3], [here, right, below]: [DVec3; 3]) -> [[f64; 3]; 2] {
        let [a, b, c] = self.corners;
        let planes = [b.cross(c), c.cross(a), a.cross(b)];
        let whole = (planes[0] + planes[1] + planes[2]).dot(here);
        [right, below].map(|neighbour| {
            let step = neighbour - here;
            let parts = planes.map(|e| e.dot(step));
            let sum = parts[0] + parts[1] + parts[2];
            [0, 1, 2].map(|i| (parts[i] - weights[i] * sum) / whole)
        })
    }
}

/// Whether a direction *on* a plane belongs to this side: of the two triangles at an edge, one.
#[inline(always)]
pub(crate) fn owns_boundary(m: DVec3) -> bool {
    (m.x > 0.0) | ((m.x == 0.0) & ((m.y > 0.0) | ((m.y == 0.0) & (m.z > 0.0))))
}

/// Barycentric coordinates of a point of the triangle near one beside it.
pub(crate) fn clamped(weights: [f64; 3]) -> [f64; 3] {
    let weights = weights.map(|w| w.max(0.0));
    let sum = weights[0] + weights[1] + weights[2];
    if sum > 0.0 { weights.map(|w| w / sum) } else { [1.0, 0.0, 0.0] }
}
