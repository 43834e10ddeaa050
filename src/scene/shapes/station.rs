use super::Builder;
use super::builder::shades;
use crate::scene::Mesh;
use glam::{DVec2, DVec3};

/// Half the station, and half a bay of its arcade.
const REACH: f64 = 60.0;
const BAY: f64 = 6.0;
/// Height of the platforms.
const PLATFORM: f64 = 0.5;

/// A station in metres, along x from −60 to 60: a track (y = 0) between two platforms; on the nearer one (−y) an
/// arcade of piers six apart at y = −3, behind the farther one a tiled wall with posters at y = 6, windows above it. The foot of the
/// track lies at z = 0.
pub fn station() -> Mesh {
    const STONE: [f32; 3] = [0.55, 0.47, 0.34];
    let mut builder = Builder::default();
    let mut flat = |y: [f64; 2], z: f64, color: [f32; 3]| {
        builder.side([-REACH, y[0], z], [REACH, y[1], z], 5, color);
    };
    flat([-1.9, 1.9], 0.0, [0.1, 0.09, 0.08]);
    for y in [-0.72, 0.72] {
        flat([y - 0.06, y + 0.06], 0.12, [0.4, 0.4, 0.43]);
    }
    for (y, edge) in [([-16.0, -1.9], [-2.4, -2.2]), ([1.9, 6.0], [2.2, 2.4])] {
        flat(y, PLATFORM, [0.3, 0.29, 0.27]);
        flat(edge, PLATFORM + 0.01, [0.8, 0.7, 0.1]);
    }
    builder.side([-REACH, 1.9, 0.0], [REACH, 1.9, PLATFORM], 2, [0.2; 3]);
    builder.side([-REACH, -1.9, 0.0], [REACH, -1.9, PLATFORM], 3, [0.2; 3]);

    // The wall: tiles in columns 1.5 wide, posters in five colours on every other bay.
    const POSTERS: [[f32; 3]; 5] =
        [[0.85, 0.55, 0.05], [0.1, 0.5, 0.6], [0.6, 0.1, 0.35], [0.25, 0.55, 0.12], [0.3, 0.2, 0.65]];
    for i in 0..80 {
        let x = -REACH + 1.5 * f64::from(i);
        let color = if i % 2 == 0 { [0.5, 0.55, 0.6] } else { [0.36, 0.42, 0.5] };
        builder.side([x, 6.0, PLATFORM], [x + 1.5, 6.0, 5.6], 2, color);
    }
    builder.cuboid([-REACH, 5.8, 5.6], [REACH, 6.6, 6.2], shades(STONE));
    builder.side([-REACH, 6.0, 6.2], [REACH, 6.0, 13.0], 2, [0.3, 0.27, 0.22]);
    for i in 0..20 {
        let x = -REACH + BAY * f64::from(i) + 1.0;
        for x in [x + 0.2, x + 2.2] {
            builder.side([x, 5.95, 7.0], [x + 1.6, 5.95, 12.0], 2, [0.4, 0.58, 0.72]);
        }
        builder.side([x, 5.95, 1.9], [x + 4.0, 5.95, 4.9], 2, [0.75; 3]);
        builder.side([x + 0.15, 5.9, 2.05], [x + 3.85, 5.9, 4.75], 2, POSTERS[i as usize % 5]);
    }

    for i in 0..20 {
        let x = -REACH + BAY * f64::from(i);
        arch(&mut builder, x, STONE);
    }
    builder.finish()
}

/// One bay of the arcade: a pier around `x`, and the arch to the next.
fn arch(builder: &mut Builder, x: f64, stone: [f32; 3]) {
    const HALF: f64 = 0.4;
    const SPRING: f64 = 3.6;
    const TOP: f64 = 7.0;
    const Y: [f64; 2] = [-3.4, -2.6];
    const STEPS: u32 = 12;
    let sides = shades(stone);
    let darker = shades(stone.map(|c| 0.7 * c));
    let mut pier = |z: [f64; 2], out: f64, colors| {
        builder.cuboid([x - HALF - out, Y[0] - out, z[0]], [x + HALF + out, Y[1] + out, z[1]], colors);
    };
    pier([PLATFORM, TOP], 0.0, sides);
    pier([PLATFORM, PLATFORM + 0.5], 0.12, darker);
    pier([SPRING - 0.25, SPRING], 0.08, darker);
    let middle = DVec2::new(x + 0.5 * BAY, SPRING);
    let on_arch = |i: u32| {
        let turn = std::f64::consts::PI * (1.0 - f64::from(i) / f64::from(STEPS));
        middle + (0.5 * BAY - HALF) * DVec2::from_angle(turn)
    };
    let at = |p: DVec2, y: f64| DVec3::new(p.x, y, p.y);
    for i in 0..STEPS {
        let [a, b] = [on_arch(i), on_arch(i + 1)];
        let [c, d] = [a, b].map(|p| DVec2::new(p.x, TOP));
        builder.quad([at(a, Y[0]), at(b, Y[0]), at(d, Y[0]), at(c, Y[0])], sides[2]);
        builder.quad([at(b, Y[1]), at(a, Y[1]), at(c, Y[1]), at(d, Y[1])], sides[3]);
        // The soffit, darkest where it looks straight down.
        let turn = f64::from(i + i + 1) / f64::from(STEPS) - 1.0;
        let shade = (0.45 + 0.3 * turn * turn) as f32;
        builder.quad([at(b, Y[0]), at(a, Y[0]), at(a, Y[1]), at(b, Y[1])], stone.map(|c| shade * c));
    }
    builder.side([x + HALF, Y[0], TOP], [x + BAY - HALF, Y[1], TOP], 5, sides[5]);
}
