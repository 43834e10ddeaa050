use super::subdivision::WHOLE;
use glam::DVec3;

/// A body as it is seen: the paper's apparent mesh, in the observer's axes.
#[derive(Clone, Debug, Default)]
pub struct ApparentMesh {
    /// Apparent positions: the mesh's own vertices first, in their order, then those of cut edges.
    pub vertices: Vec<DVec3>,
    /// Triangles, in the order of the mesh's own.
    pub triangles: Vec<ApparentTriangle>,
    /// Barycentric coordinates (of the second and third corner of the mesh's triangle) of the three corners of
    /// each piece; see [`ApparentTriangle::piece`].
    pub pieces: Vec<[[f32; 2]; 3]>,
}

/// A triangle of an [`ApparentMesh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ApparentTriangle {
    /// Indices into the apparent vertices.
    pub corners: [u32; 3],
    /// The triangle of the mesh it is, or is a piece of.
    pub face: u32,
    /// Index into [`ApparentMesh::pieces`], or [`WHOLE`].
    pub piece: u32,
}

impl ApparentMesh {
    /// The rest-frame barycentric coordinates of a point of an apparent triangle, given its barycentric
    /// coordinates there: what colours, texture coordinates and normals are interpolated with.
    #[inline]
    pub fn rest_weights(&self, triangle: &ApparentTriangle, [u, v, w]: [f64; 3]) -> [f64; 3] {
        if triangle.piece == WHOLE {
            return [u, v, w];
        }
        let corners = self.pieces[triangle.piece as usize];
        let weight = |i: usize| {
            u * f64::from(corners[0][i]) + v * f64::from(corners[1][i]) + w * f64::from(corners[2][i])
        };
        let (second, third) = (weight(0), weight(1));
        [1.0 - second - third, second, third]
    }
}
