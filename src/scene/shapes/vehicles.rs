use super::Builder;
use super::builder::shades;
use crate::scene::Mesh;
use glam::DVec2;

const GLASS: [f32; 3] = [0.03, 0.06, 0.11];
const CREAM: [f32; 3] = [0.72, 0.66, 0.5];
const LAMP: [f32; 3] = [1.0, 0.95, 0.6];

/// A tram in metres, 14 long, 2.4 wide and 3.3 high, going along +x on the ground z = 0, its middle above the
/// origin: `color` below, cream above, windows and doors on both sides, headlights before and red ones behind.
pub fn tram(color: [f32; 3]) -> Mesh {
    const HALF: f64 = 7.0;
    const WIDE: f64 = 1.2;
    /// Panels stand out by this much, so that nothing lies in another's plane.
    const PROUD: f64 = 0.03;
    let mut builder = Builder::default();
    builder.cuboid([-HALF, -WIDE, 0.4], [HALF, WIDE, 1.5], shades(color));
    builder.cuboid([-HALF, -WIDE, 1.5], [HALF, WIDE, 2.9], shades(CREAM));
    builder.cuboid(
        [-HALF + 0.3, -WIDE + 0.15, 2.9],
        [HALF - 0.3, WIDE - 0.15, 3.1],
        shades([0.35, 0.35, 0.37]),
    );
    builder.cuboid([-1.2, -0.7, 3.1], [1.2, 0.7, 3.3], shades([0.5, 0.5, 0.52]));
    for (side, y) in [(2, -WIDE - PROUD), (3, WIDE + PROUD)] {
        let mut panel = |x: [f64; 2], z: [f64; 2], color| {
            builder.side([x[0], y, z[0]], [x[1], y, z[1]], side, color);
        };
        for i in 0..10 {
            let x = -6.75 + 1.35 * f64::from(i);
            if i == 2 || i == 7 {
                panel([x, x + 1.2], [0.45, 2.75], [0.8, 0.55, 0.08]);
            } else {
                panel([x, x + 1.2], [1.65, 2.65], GLASS);
            }
        }
        // Panes of the doors, before the doors.
        let y = y + (y - WIDE.copysign(y));
        for i in [2, 7] {
            let x = -6.75 + 1.35 * f64::from(i);
            for x in [x + 0.1, x + 0.65] {
                builder.side([x, y, 0.7], [x + 0.45, y, 2.6], side, GLASS);
            }
        }
    }
    for (side, x, lamp) in [(0, -HALF - PROUD, [0.9, 0.02, 0.02]), (1, HALF + PROUD, LAMP)] {
        builder.side([x, -1.0, 1.6], [x, 1.0, 2.7], side, GLASS);
        for y in [-0.95, 0.6] {
            builder.side([x, y, 0.75], [x, y + 0.35, 1.1], side, lamp);
        }
    }
    for x in [-5.0, -3.4, 3.4, 5.0] {
        builder.wheel(DVec2::new(x, 0.38), 0.38, [-0.8, -WIDE + 0.08]);
        builder.wheel(DVec2::new(x, 0.38), 0.38, [0.8, WIDE - 0.08]);
    }
    builder.finish()
}

/// A blue car in metres, 4.2 long, 1.7 wide and 1.45 high, going along +x on the ground z = 0, its middle above
/// the origin.
pub fn car() -> Mesh {
    const BLUE: [f32; 3] = [0.08, 0.22, 0.75];
    const WIDE: f64 = 0.85;
    let profile =
        |points: &[(f64, f64)]| -> Vec<DVec2> { points.iter().map(|&(x, z)| DVec2::new(x, z)).collect() };
    let mut builder = Builder::default();
    let body = [(-2.1, 0.3), (2.0, 0.3), (2.1, 0.5), (2.0, 0.75), (1.0, 0.9), (-1.9, 0.9), (-2.1, 0.8)];
    builder.prism(&profile(&body), [-WIDE, WIDE], shades(BLUE));
    let cabin = [(-1.75, 0.9), (0.95, 0.9), (0.25, 1.45), (-1.25, 1.45)];
    builder.prism(&profile(&cabin), [-WIDE + 0.1, WIDE - 0.1], shades(BLUE.map(|c| 0.8 * c)));
    // Windows: a little before the cabin's sides, the windscreen and the rear window.
    for panes in [
        [(-1.5, 0.95), (-0.55, 0.95), (-0.55, 1.38), (-1.15, 1.38)],
        [(-0.45, 0.95), (0.72, 0.95), (0.18, 1.38), (-0.45, 1.38)],
    ] {
        builder.prism(&profile(&panes), [-WIDE + 0.08, WIDE - 0.08], shades(GLASS));
    }
    for screen in [
        [(0.9, 0.97), (0.95, 0.95), (0.3, 1.43), (0.28, 1.40)],
        [(-1.75, 0.95), (-1.70, 0.97), (-1.28, 1.4), (-1.3, 1.42)],
    ] {
        builder.prism(&profile(&screen), [-WIDE + 0.2, WIDE - 0.2], shades([0.1, 0.16, 0.24]));
    }
    for (side, x, lamp) in [(0, -2.13, [0.9, 0.02, 0.02]), (1, 2.13, LAMP)] {
        for y in [-0.75, 0.45] {
            builder.side([x, y, 0.5], [x, y + 0.3, 0.68], side, lamp);
        }
    }
    for x in [-1.3, 1.3] {
        builder.wheel(DVec2::new(x, 0.32), 0.32, [-0.6, -WIDE - 0.02]);
        builder.wheel(DVec2::new(x, 0.32), 0.32, [0.6, WIDE + 0.02]);
    }
    builder.finish()
}
