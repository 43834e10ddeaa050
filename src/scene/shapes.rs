//! The meshes that ship, as they are made; `examples/make_assets.rs` writes them to `assets/`.

use super::{Mesh, Paint};
use glam::{DVec2, DVec3};

/// Linear sRGB of a cube's sides −x, +x, −y, +y, −z, +z: the trailing side of a cube moving along +x is
/// yellow, the side towards a camera looking along +y green, as in the paper's Fig. 2.
pub const SIDE_COLORS: [[f32; 3]; 6] =
    [[0.95, 0.85, 0.1], [0.2, 0.3, 0.9], [0.1, 0.8, 0.2], [0.8, 0.1, 0.1], [0.5; 3], [0.9; 3]];

/// A mesh put together from coloured triangles.
#[derive(Default)]
struct Builder {
    triangles: Vec<[(DVec3, [f32; 3]); 3]>,
}

impl Builder {
    fn triangle(&mut self, corners: [DVec3; 3], color: [f32; 3]) {
        self.triangles.push(corners.map(|c| (c, color)));
    }

    /// Corners counter-clockwise seen from outside.
    fn quad(&mut self, [a, b, c, d]: [DVec3; 4], color: [f32; 3]) {
        self.triangle([a, b, c], color);
        self.triangle([a, c, d], color);
    }

    fn cuboid(&mut self, low: DVec3, high: DVec3, colors: [[f32; 3]; 6]) {
        let corner = |x: usize, y: usize, z: usize| {
            DVec3::new([low.x, high.x][x], [low.y, high.y][y], [low.z, high.z][z])
        };
        let sides = [
            [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
            [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
            [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
            [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
            [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
            [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
        ];
        for (side, color) in sides.into_iter().zip(colors) {
            self.quad(side.map(|(x, y, z)| corner(x, y, z)), color);
        }
    }

    /// Equal corners become one vertex: of equal colours too, if any triangle has several.
    fn finish(self) -> Mesh {
        let flat = self.triangles.iter().all(|[a, b, c]| a.1 == b.1 && b.1 == c.1);
        let mut index = std::collections::HashMap::new();
        let (mut vertices, mut colors) = (Vec::new(), Vec::new());
        let mut vertex = |(at, color): (DVec3, [f32; 3])| {
            // −0 is 0 here.
            let place = (at + DVec3::ZERO).to_array().map(f64::to_bits);
            let paint = if flat { [0; 3] } else { color.map(f32::to_bits) };
            *index.entry((place, paint)).or_insert_with(|| {
                vertices.push(at);
                colors.push(color);
                vertices.len() as u32 - 1
            })
        };
        let triangles = self.triangles.iter().map(|t| t.map(&mut vertex)).collect();
        let paint = if flat {
            Paint::Faces(self.triangles.iter().map(|t| t[0].1).collect())
        } else {
            Paint::Vertices(colors)
        };
        Mesh { paint, ..Mesh::new(&vertices, triangles) }
    }
}

/// The cube of Fig. 2: edge 1, centre at the origin, sides coloured by [`SIDE_COLORS`].
pub fn cube() -> Mesh {
    let mut builder = Builder::default();
    builder.cuboid(DVec3::splat(-0.5), DVec3::splat(0.5), SIDE_COLORS);
    builder.finish()
}

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

/// A gate in the manner of Berlin's Brandenburg Gate, of our own making, in metres, passed along x: two rows of
/// six columns joined by walls, five passages, entablature, attic and a block where the quadriga stands, on a
/// tiled floor. Fronts (−x) are sand, backs (+x) blue, sides facing −y green and +y red, tops pale, undersides
/// violet. The front columns stand at x = 0, the floor lies at z = 0.
pub fn gate() -> Mesh {
    const SAND: [f32; 3] = [0.85, 0.6, 0.28];
    const BLUE: [f32; 3] = [0.12, 0.3, 0.75];
    const GREEN: [f32; 3] = [0.18, 0.55, 0.2];
    const RED: [f32; 3] = [0.7, 0.16, 0.1];
    const VIOLET: [f32; 3] = [0.4, 0.26, 0.55];
    const PALE: [f32; 3] = [0.8, 0.8, 0.72];
    const SIDES: [[f32; 3]; 6] = [SAND, BLUE, GREEN, RED, VIOLET, PALE];
    const DARKER: [[f32; 3]; 6] = {
        let mut out = SIDES;
        let mut i = 0;
        while i < 6 {
            let [r, g, b] = out[i];
            out[i] = [0.75 * r, 0.75 * g, 0.75 * b];
            i += 1;
        }
        out
    };
    /// Middle passage 5.65 wide, the others 3.8; columns 1.74 thick.
    const COLUMNS: [f64; 6] = [-14.78, -9.24, -3.695, 3.695, 9.24, 14.78];
    const ROWS: [f64; 2] = [0.0, 11.0];
    const RADIUS: f64 = 0.87;
    const HEIGHT: f64 = 13.5;

    let mut builder = Builder::default();
    let cuboid = |builder: &mut Builder, low: [f64; 3], high: [f64; 3], colors| {
        builder.cuboid(DVec3::from_array(low), DVec3::from_array(high), colors);
    };
    for x in ROWS {
        for y in COLUMNS {
            let half = RADIUS + 0.2;
            cuboid(&mut builder, [x - half, y - half, 0.0], [x + half, y + half, 0.5], DARKER);
            column(&mut builder, DVec2::new(x, y), RADIUS, [0.5, HEIGHT - 0.6], SIDES);
            cuboid(&mut builder, [x - half, y - half, HEIGHT - 0.6], [x + half, y + half, HEIGHT], DARKER);
        }
    }
    for y in COLUMNS {
        cuboid(&mut builder, [1.6, y - 0.5, 0.0], [9.4, y + 0.5, HEIGHT], DARKER);
    }
    cuboid(&mut builder, [-1.3, -16.2, HEIGHT], [12.3, 16.2, 15.2], SIDES);
    cuboid(&mut builder, [-1.7, -16.6, 15.2], [12.7, 16.6, 16.2], DARKER);
    cuboid(&mut builder, [-0.5, -11.0, 16.2], [11.5, 11.0, 19.2], SIDES);
    cuboid(&mut builder, [0.5, -9.5, 19.2], [10.5, 9.5, 20.0], DARKER);
    cuboid(&mut builder, [2.5, -2.6, 20.0], [8.5, 2.6, 24.0], SIDES);

    // Tiles two metres square.
    for i in -8..14 {
        for j in -10..10 {
            let (x, y) = (2.0 * f64::from(i), 2.0 * f64::from(j));
            let color = if (i + j) % 2 == 0 { [0.06; 3] } else { [0.16, 0.155, 0.14] };
            let corner = |dx: f64, dy: f64| DVec3::new(x + dx, y + dy, 0.0);
            builder.quad([corner(0.0, 0.0), corner(2.0, 0.0), corner(2.0, 2.0), corner(0.0, 2.0)], color);
        }
    }
    builder.finish()
}

/// An upright round column, coloured around by the sides it faces.
fn column(builder: &mut Builder, at: DVec2, radius: f64, z: [f64; 2], sides: [[f32; 3]; 6]) {
    const AROUND: u32 = 20;
    for i in 0..AROUND {
        let angle = |i: u32| f64::from(i % AROUND) * std::f64::consts::TAU / f64::from(AROUND);
        let corner = |i: u32, z: f64| (at + radius * DVec2::from_angle(angle(i))).extend(z);
        let facing =
            DVec2::from_angle(0.5 * (angle(i) + angle(i) + std::f64::consts::TAU / f64::from(AROUND)));
        let color = blend(facing.extend(0.0), sides);
        builder.quad([corner(i, z[0]), corner(i + 1, z[0]), corner(i + 1, z[1]), corner(i, z[1])], color);
    }
}

/// The colours of the sides a normal faces, weighed by the squares of its components.
fn blend(normal: DVec3, sides: [[f32; 3]; 6]) -> [f32; 3] {
    let mut out = [0.0; 3];
    for (axis, component) in normal.to_array().into_iter().enumerate() {
        let side = sides[2 * axis + usize::from(component > 0.0)];
        let weight = (component * component) as f32;
        out = [0, 1, 2].map(|i| out[i] + weight * side[i]);
    }
    out
}

/// Part of Fig. 1's lattice: balls one apart at x = −5 … 5, y = −1 … 1, z = 0, 1, joined by rods: along x
/// orange, along y green, along z blue.
pub fn lattice() -> Mesh {
    const BALL: f64 = 0.12;
    const ROD: f64 = 0.03;
    const LOW: [i32; 3] = [-5, -1, 0];
    const HIGH: [i32; 3] = [5, 1, 1];
    let ball = sphere(2);
    let mut builder = Builder::default();
    for x in LOW[0]..=HIGH[0] {
        for y in LOW[1]..=HIGH[1] {
            for z in LOW[2]..=HIGH[2] {
                let node = [x, y, z];
                let at = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                let painted = |normal: DVec3| {
                    let light = 0.42 + 0.4 * normal.dot(DVec3::new(0.5, -0.6, -0.6)) as f32;
                    // Few digits, as the file has.
                    let light = (100.0 * light).round() / 100.0;
                    (at + BALL * normal, [light, light, 0.85 * light])
                };
                builder.triangles.extend((0..ball.triangles.len()).map(|t| ball.corners(t).map(painted)));
                for axis in 0..3 {
                    if node[axis] < HIGH[axis] {
                        let along = DVec3::AXES[axis];
                        let side = DVec3::splat(ROD) * (DVec3::ONE - along);
                        let (from, to) = (at + along * (0.9 * BALL), at + along * (1.0 - 0.9 * BALL));
                        let shade =
                            |color: [f32; 3]| [0.75, 0.9, 1.0, 0.6, 1.1, 0.7].map(|s| color.map(|c| s * c));
                        let color = [[0.85, 0.3, 0.05], [0.1, 0.6, 0.15], [0.1, 0.25, 0.85]][axis];
                        builder.cuboid(from - side, to + side, shade(color));
                    }
                }
            }
        }
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Signed volume of a closed mesh: positive where all triangles face outward.
    fn volume(mesh: &Mesh) -> f64 {
        (0..mesh.triangles.len()).map(|t| mesh.corners(t)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    #[test]
    fn shapes_face_outward() {
        assert_eq!(volume(&cube()), 1.0);
        assert_eq!(cube().vertex_count(), 8);
        assert_eq!(cube().triangles.len(), 12);
        let ball = sphere(4);
        assert_eq!(ball.triangles.len(), 20 * 256);
        assert!((volume(&ball) - 4.0 / 3.0 * std::f64::consts::PI).abs() < 0.02);
    }

    #[test]
    fn the_meshes_that_ship_are_those_made_here() {
        for (name, made) in [("cube", cube()), ("gate", gate()), ("lattice", lattice())] {
            let read = super::super::builtin_mesh(name).unwrap();
            assert_eq!(
                read.triangles.len(),
                made.triangles.len(),
                "{name}: run `cargo run --example make_assets`"
            );
            for t in 0..made.triangles.len() {
                for (a, b) in read.corners(t).into_iter().zip(made.corners(t)) {
                    assert!((a - b).length() < 1e-6, "{name}");
                }
                let color = |mesh: &Mesh| mesh.color(t, [0.0, 1.0, 0.0], |_| [1.0; 3]);
                assert!(color(&read).iter().zip(color(&made)).all(|(a, b)| (a - b).abs() < 1e-4));
            }
        }
    }
}
