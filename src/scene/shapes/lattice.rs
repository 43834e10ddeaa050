use super::{Builder, sphere};
use crate::scene::Mesh;
use glam::DVec3;

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
                        builder.cuboid((from - side).to_array(), (to + side).to_array(), shade(color));
                    }
                }
            }
        }
    }
    builder.finish()
}
