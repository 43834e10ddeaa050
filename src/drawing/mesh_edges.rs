use crate::scene::Mesh;
use glam::DVec3;
use std::collections::HashMap;

/// Which edges of a mesh are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Edges {
    /// Where a surface ends, and where it folds by more than 25° in the rest frame.
    #[default]
    Sharp,
    /// Every side of every triangle.
    All,
}

/// What a fold must exceed to be sharp, degrees.
const SHARP_DEG: f64 = 25.0;

/// Vertices so near to each other are one, relative to the mesh's greatest coordinate: what f32 files keep.
const SAME: f64 = 1e-7;

/// Directions so near to each other (cosine) are one: the two sides of one sheet.
const SAME_DIRECTION: f64 = 1.0 - 1e-6;

/// The edges of a mesh that are drawn, each once, with the triangles it belongs to.
#[derive(Clone, Debug, Default)]
pub(super) struct MeshEdges {
    /// Vertices of the ends.
    ends: Vec<[u32; 2]>,
    /// Where each edge's triangles begin in `faces`; one more at the end.
    first: Vec<usize>,
    faces: Vec<u32>,
}

impl MeshEdges {
    /// Vertices at the same place count as one, whether or not triangles share them.
    pub fn new(mesh: &Mesh, which: Edges) -> Self {
        let welded = weld(mesh);
        let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * mesh.triangles.len());
        for (face, corners) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|v| welded[v as usize]);
            if a != b && b != c && c != a {
                sides.extend([[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], face as u32)));
            }
        }
        sides.sort_unstable();
        let mut edges = Self { first: vec![0], ..Self::default() };
        for group in sides.chunk_by(|a, b| a.0 == b.0) {
            let ends = group[0].0;
            let faces = group.iter().map(|(_, face)| *face);
            if which == Edges::All || is_sharp(mesh, &welded, ends, faces.clone()) {
                edges.ends.push(ends);
                edges.faces.extend(faces);
                edges.first.push(edges.faces.len());
            }
        }
        edges
    }

    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// The two ends, and the triangles at the edge.
    pub fn get(&self, index: usize, mesh: &Mesh) -> ([DVec3; 2], &[u32]) {
        let ends = self.ends[index].map(|v| mesh.vertex(v));
        (ends, &self.faces[self.first[index]..self.first[index + 1]])
    }
}

/// Whether the surface ends, branches or folds at an edge. Judged by where the triangles' third corners lie, since
/// files do not agree on which side of a triangle is its front.
fn is_sharp(mesh: &Mesh, welded: &[u32], ends: [u32; 2], faces: impl Iterator<Item = u32>) -> bool {
    let [a, b] = ends.map(|v| mesh.vertex(v));
    let along = (b - a).normalize_or_zero();
    let mut sheets: Vec<DVec3> = Vec::new();
    for face in faces {
        let third = mesh.triangles[face as usize].into_iter().find(|v| !ends.contains(&welded[*v as usize]));
        let Some(third) = third.map(|v| mesh.vertex(v) - a) else { continue };
        let away = third - third.dot(along) * along;
        // A triangle without area tells nothing of a fold, nor does the surface end at it.
        if away.length() <= 1e-9 * a.distance(b) {
            return false;
        }
        let away = away.normalize();
        if !sheets.iter().any(|sheet| sheet.dot(away) > SAME_DIRECTION) {
            sheets.push(away);
        }
    }
    match sheets[..] {
        [one, other] => -one.dot(other) < SHARP_DEG.to_radians().cos(),
        _ => true,
    }
}

/// For every vertex, the first one at its place.
fn weld(mesh: &Mesh) -> Vec<u32> {
    let Some((low, high)) = mesh.bounds() else { return Vec::new() };
    let near = SAME * low.abs().max(high.abs()).max_element();
    let cell = 8.0 * near;
    let mut first_in: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut welded: Vec<u32> = Vec::with_capacity(mesh.vertex_count());
    for vertex in 0..mesh.vertex_count() as u32 {
        let at = mesh.vertex(vertex);
        // The cells that hold what is near: mostly one.
        let [from, to] = [at - near, at + near].map(|p| (p / cell).floor().to_array().map(|c| c as i64));
        let range = |i: usize| from[i]..=to[i];
        let cells = range(0).flat_map(|x| range(1).flat_map(move |y| range(2).map(move |z| [x, y, z])));
        let is_here = |other: &&u32| (mesh.vertex(**other) - at).abs().max_element() <= near;
        let known = cells.filter_map(|c| first_in.get(&c)?.iter().find(is_here).copied()).min();
        welded.push(known.unwrap_or_else(|| {
            first_in.entry((at / cell).floor().to_array().map(|c| c as i64)).or_default().push(vertex);
            vertex
        }));
    }
    welded
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{builtin_mesh, shapes};

    fn count(mesh: &Mesh, which: Edges) -> usize {
        MeshEdges::new(mesh, which).len()
    }

    #[test]
    fn a_cube_has_twelve_edges_however_it_is_stored() {
        let cube = builtin_mesh("cube").unwrap();
        assert_eq!(count(&cube, Edges::Sharp), 12);
        assert_eq!(count(&cube, Edges::All), 12 + 6);
        // No vertex shared, half of the triangles turned over, every coordinate off by what f32 rounds.
        let mut soup = Mesh::default();
        for t in 0..cube.triangles.len() {
            let mut corners = cube.corners(t).map(|c| c + 0.5 + 1e-9 * (t as f64));
            if t % 2 == 0 {
                corners.reverse();
            }
            soup.append(Mesh::new(&corners, vec![[0, 1, 2]]));
        }
        assert_eq!(soup.vertex_count(), 36);
        assert_eq!(count(&soup, Edges::Sharp), 12);
        assert_eq!(count(&soup, Edges::All), 18);
        // A second sheet over the first is no fold.
        soup.append(soup.clone());
        assert_eq!(count(&soup, Edges::Sharp), 12);
    }

    #[test]
    fn what_is_round_or_flat_has_no_sharp_edges_but_its_ends() {
        assert_eq!(count(&shapes::sphere(3), Edges::Sharp), 0);
        assert_eq!(count(&shapes::sphere(3), Edges::All), 3 * shapes::sphere(3).triangles.len() / 2);
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let folded = |up: f64| {
            let mut corners = corners;
            corners[3].z = up;
            Mesh::new(&corners, vec![[0, 1, 2], [0, 2, 3]])
        };
        assert_eq!(count(&folded(0.0), Edges::Sharp), 4);
        // The diagonal is at a distance of √½ from the corner: tan 25° of that is 0.33.
        assert_eq!(count(&folded(0.32), Edges::Sharp), 4);
        assert_eq!(count(&folded(0.34), Edges::Sharp), 5);
    }

    #[test]
    fn triangles_without_area_are_no_surface() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, 0.5 * DVec3::X, DVec3::NEG_Y];
        // A T-junction closed by a triangle without area.
        let mesh = Mesh::new(&corners, vec![[0, 1, 2], [0, 3, 1], [0, 4, 3], [3, 4, 1], [2, 2, 1]]);
        let edges = MeshEdges::new(&mesh, Edges::Sharp);
        let drawn: Vec<_> = (0..edges.len()).map(|i| edges.ends[i]).collect();
        assert_eq!(drawn, [[0, 2], [0, 4], [1, 2], [1, 4]]);
    }
}
