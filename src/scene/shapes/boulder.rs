use crate::scene::Mesh;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A wrinkled ball of radius 1 of n × n squares, cut in two: of 400, 320 000 triangles, as meshes that people download have.
pub fn boulder(n: u32) -> Mesh {
    let mut vertices = Vec::new();
    for i in 0..=n {
        for j in 0..n {
            let (theta, phi) = (PI * f64::from(i) / f64::from(n), TAU * f64::from(j) / f64::from(n));
            let out = 1.0 + 0.05 * (9.0 * theta).sin() * (11.0 * phi).cos();
            vertices.push(out * DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()));
        }
    }
    let at = |i: u32, j: u32| i * n + j % n;
    let square = |i: u32, j: u32| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let mut mesh =
        Mesh::new(&vertices, (0..n).flat_map(|i| (0..n).flat_map(move |j| square(i, j))).collect());
    mesh.paint_as_clay();
    mesh
}
