use super::Builder;
use super::builder::blend;
use crate::scene::Mesh;
use glam::{DVec2, DVec3};

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
    for x in ROWS {
        for y in COLUMNS {
            let half = RADIUS + 0.2;
            builder.cuboid([x - half, y - half, 0.0], [x + half, y + half, 0.5], DARKER);
            column(&mut builder, DVec2::new(x, y), RADIUS, [0.5, HEIGHT - 0.6], SIDES);
            builder.cuboid([x - half, y - half, HEIGHT - 0.6], [x + half, y + half, HEIGHT], DARKER);
        }
    }
    for y in COLUMNS {
        builder.cuboid([1.6, y - 0.5, 0.0], [9.4, y + 0.5, HEIGHT], DARKER);
    }
    builder.cuboid([-1.3, -16.2, HEIGHT], [12.3, 16.2, 15.2], SIDES);
    builder.cuboid([-1.7, -16.6, 15.2], [12.7, 16.6, 16.2], DARKER);
    builder.cuboid([-0.5, -11.0, 16.2], [11.5, 11.0, 19.2], SIDES);
    builder.cuboid([0.5, -9.5, 19.2], [10.5, 9.5, 20.0], DARKER);
    builder.cuboid([2.5, -2.6, 20.0], [8.5, 2.6, 24.0], SIDES);

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
