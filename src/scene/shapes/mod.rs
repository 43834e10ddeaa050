//! The meshes that ship, as they are made; `examples/make_assets.rs` writes them to `assets/`.

mod boulder;
mod builder;
mod gate;
mod lattice;
mod sphere;
mod station;
mod street;
mod train;
mod vehicles;

pub use boulder::boulder;
pub use gate::gate;
pub use lattice::lattice;
pub use sphere::{ball, globe, sphere};
pub use station::station;
pub use street::street;
pub use train::train;
pub use vehicles::{car, tram};

use super::Mesh;
use builder::Builder;

/// What makes a mesh.
pub type Make = fn() -> Mesh;

/// The meshes that ship: what scenes call them, and what makes them.
pub const SHIPPED: [(&str, Make); 12] = [
    ("cube", cube),
    ("gate", gate),
    ("lattice", lattice),
    ("globe", globe),
    ("ball", ball),
    ("plate", plate),
    ("street", street),
    ("tram", || tram([0.75, 0.1, 0.06])),
    ("tram_green", || tram([0.06, 0.42, 0.16])),
    ("car", car),
    ("station", station),
    ("train", train),
];

/// Linear sRGB of a cube's sides −x, +x, −y, +y, −z, +z: the trailing side of a cube moving along +x is
/// yellow, the side towards a camera looking along +y green, as in the paper's Fig. 2.
pub const SIDE_COLORS: [[f32; 3]; 6] =
    [[0.95, 0.85, 0.1], [0.2, 0.3, 0.9], [0.1, 0.8, 0.2], [0.8, 0.1, 0.1], [0.5; 3], [0.9; 3]];

/// The cube of Fig. 2: edge 1, centre at the origin, sides coloured by [`SIDE_COLORS`].
pub fn cube() -> Mesh {
    let mut builder = Builder::default();
    builder.cuboid([-0.5; 3], [0.5; 3], SIDE_COLORS);
    builder.finish()
}

/// A square of side 2 around the origin, square to z, white: floors and walls.
pub fn plate() -> Mesh {
    let mut builder = Builder::default();
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let [a, b, c, d] = corners.map(|[x, y]| glam::DVec3::new(x, y, 0.0));
    builder.triangle([a, b, c], WHITE);
    builder.triangle([a, c, d], WHITE);
    builder.finish()
}

/// As white as paper.
const WHITE: [f32; 3] = [0.8; 3];

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
        for ball in [ball, globe(), super::ball()] {
            assert!((volume(&ball) - 4.0 / 3.0 * std::f64::consts::PI).abs() < 0.02);
        }
    }

    #[test]
    fn the_meshes_that_ship_are_those_made_here() {
        assert!(crate::scene::builtin_meshes().eq(SHIPPED.map(|(name, _)| name)));
        for (name, make) in SHIPPED {
            let made = make();
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
