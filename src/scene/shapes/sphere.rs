use super::{Builder, SIDE_COLORS, WHITE};
use crate::scene::{Mesh, Paint};
use glam::{DVec2, DVec3};

/// A sphere of radius 1: an icosahedron with every triangle cut in four `levels` times (20·4ⁿ triangles).
pub fn sphere(levels: u32) -> Mesh {
    let g = 0.5 * (1.0 + 5f64.sqrt());
    let mut vertices = Vec::new();
    for a in [-1.0, 1.0] {
        for b in [-g, g] {
            vertices.extend([DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)]);
        }
    }
    let vertices: Vec<DVec3> = vertices.into_iter().map(DVec3::normalize).collect();
    // The 20 triples of mutually nearest vertices, turned outward.
    let near = |i: usize, j: usize| (vertices[i] - vertices[j]).length() < 1.1;
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let [a, b, c] = [i, j, k].map(|v| vertices[v]);
                    triangles.push(if a.dot(b.cross(c)) > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..levels {
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [a + b, b + c, c + a].map(DVec3::normalize);
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let mut builder = Builder::default();
    for triangle in triangles {
        builder.triangle(triangle, Paint::CLAY);
    }
    builder.finish()
}

/// A white sphere of radius 1 with the normals of a true one.
pub fn ball() -> Mesh {
    let mut mesh = sphere(4);
    // Few digits, as the file has.
    for coordinates in [&mut mesh.x, &mut mesh.y, &mut mesh.z] {
        coordinates.iter_mut().for_each(|c| *c = (1e6 * *c).round() / 1e6);
    }
    mesh.paint = Paint::Faces(vec![WHITE; mesh.triangles.len()]);
    mesh.normals = (0..mesh.vertex_count() as u32).map(|v| mesh.vertex(v).as_vec3().to_array()).collect();
    mesh
}

/// A sphere of radius 1 in a chequer of 16 by 8 fields along longitude and latitude (around z). The quarter
/// around each of −x, +x, −y, +y has that side's colour of [`SIDE_COLORS`], bright and dark in turn.
pub fn globe() -> Mesh {
    const FIELDS: [u32; 2] = [16, 8];
    /// Pieces along a field's side: the outline is within 0.12 % of a circle.
    const PIECES: u32 = 4;
    let around = FIELDS[0] * PIECES;
    let high = FIELDS[1] * PIECES;
    let point = |i: u32, j: u32| {
        // An eighth of a turn on, so that quarters begin with a field.
        let longitude = f64::from(i % around) / f64::from(around) - 0.125;
        let longitude = DVec2::from_angle(std::f64::consts::TAU * longitude);
        let latitude = DVec2::from_angle(std::f64::consts::PI * (f64::from(j) / f64::from(high) - 0.5));
        let at = if j == 0 || j == high {
            latitude.y * DVec3::Z
        } else {
            (latitude.x * longitude).extend(latitude.y)
        };
        // Few digits, as the file has.
        (1e4 * at).round() / 1e4
    };
    let mut builder = Builder::default();
    for column in 0..FIELDS[0] {
        let quarter = SIDE_COLORS[[1, 3, 0, 2][(column / (FIELDS[0] / 4)) as usize]];
        for row in 0..FIELDS[1] {
            let bright = (column + row) % 2 == 0;
            let color = if bright { quarter } else { quarter.map(|c| 0.3 * c) };
            for i in column * PIECES..(column + 1) * PIECES {
                for j in row * PIECES..(row + 1) * PIECES {
                    let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
                    if j > 0 {
                        builder.triangle([a, b, c], color);
                    }
                    if j + 1 < high {
                        builder.triangle([a, c, d], color);
                    }
                }
            }
        }
    }
    builder.finish()
}
