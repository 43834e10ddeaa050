use super::Builder;
use super::builder::shades;
use crate::scene::Mesh;
use glam::DVec2;

const CAR: f64 = 18.0;
const PITCH: f64 = 19.2;
const WIDE: f64 = 1.4;
const RED: [f32; 3] = [0.7, 0.07, 0.05];
const CREAM: [f32; 3] = [0.78, 0.72, 0.55];
const WOOD: [f32; 3] = [0.28, 0.15, 0.06];
const DARK: [f32; 3] = [0.12, 0.12, 0.14];

/// A train in metres, going along +x, wheels on z = 0.12, its middle above the origin: an engine and four cars 18
/// long and 1.2 apart. The cars' windows are open on both sides, so that what is behind shows through. Wheels do
/// not turn: the body is rigid.
pub fn train() -> Mesh {
    let mut builder = Builder::default();
    for number in 0..5 {
        let middle = PITCH * (f64::from(number) - 2.0);
        let x = [middle - 0.5 * CAR, middle + 0.5 * CAR];
        if number == 4 {
            engine(&mut builder, x);
        } else {
            car(&mut builder, x);
            builder.cuboid([x[1], -0.3, 0.8], [x[1] + PITCH - CAR, 0.3, 1.0], shades(DARK));
        }
        builder.cuboid([x[0] + 0.6, -1.0, 0.75], [x[1] - 0.6, 1.0, 1.1], shades(DARK));
        for axle in [2.0, 4.2, CAR - 4.2, CAR - 2.0] {
            for out in [-1.0, 1.0] {
                builder.wheel(DVec2::new(x[0] + axle, 0.62), 0.5, [out * 0.7, out * 1.15]);
            }
        }
    }
    builder.finish()
}

/// A hollow car: floor, roof, ends, and sides with six windows.
fn car(builder: &mut Builder, x: [f64; 2]) {
    const WINDOWS: [f64; 2] = [2.0, 3.05];
    const Z: [f64; 2] = [1.1, 3.6];
    builder.cuboid([x[0], -WIDE, Z[0]], [x[1], WIDE, Z[0] + 0.1], shades(WOOD));
    builder.cuboid([x[0], -WIDE, Z[1]], [x[1], WIDE, Z[1] + 0.15], shades([0.4, 0.4, 0.43]));
    for end in [x[0], x[1] - 0.1] {
        builder.cuboid([end, -WIDE, Z[0] + 0.1], [end + 0.1, WIDE, Z[1]], shades([0.4, 0.05, 0.04]));
    }
    for (y, inner) in [([-WIDE, -WIDE + 0.1], 3), ([WIDE - 0.1, WIDE], 2)] {
        let mut wall = |x: [f64; 2], z: [f64; 2], color| {
            let mut sides = shades(color);
            sides[inner] = WOOD;
            builder.cuboid([x[0], y[0], z[0]], [x[1], y[1], z[1]], sides);
        };
        let inside = [x[0] + 0.1, x[1] - 0.1];
        wall(inside, [Z[0] + 0.1, WINDOWS[0]], RED);
        wall(inside, [WINDOWS[1], Z[1]], CREAM);
        let pitch = (inside[1] - inside[0] - 0.9) / 6.0;
        for post in 0..7 {
            let x = inside[0] + pitch * f64::from(post);
            wall([x, x + 0.9], WINDOWS, CREAM);
        }
    }
}

/// The engine, closed, with a slanted nose.
fn engine(builder: &mut Builder, x: [f64; 2]) {
    const BLUE: [f32; 3] = [0.08, 0.2, 0.6];
    const GLASS: [f32; 3] = [0.03, 0.05, 0.09];
    let profile = |points: &[(f64, f64)]| -> Vec<DVec2> {
        points.iter().map(|&(ahead, z)| DVec2::new(x[1] + ahead, z)).collect()
    };
    let body = [(-CAR, 1.1), (0.0, 1.1), (0.2, 1.7), (-1.6, 3.5), (-2.2, 3.75), (-CAR, 3.75)];
    builder.prism(&profile(&body), [-WIDE, WIDE], shades(BLUE));
    let stripe = [(-CAR + 0.02, 1.55), (0.17, 1.55), (0.21, 1.7), (0.1, 1.85), (-CAR + 0.02, 1.85)];
    builder.prism(&profile(&stripe), [-WIDE - 0.03, WIDE + 0.03], shades([0.9, 0.75, 0.1]));
    let screen = [(-0.15, 2.15), (-0.11, 2.2), (-1.21, 3.3), (-1.25, 3.25)];
    builder.prism(&profile(&screen), [-WIDE + 0.2, WIDE - 0.2], shades(GLASS));
    let door = [(-3.0, 2.1), (-1.0, 2.1), (-1.9, 3.2), (-3.0, 3.2)];
    builder.prism(&profile(&door), [-WIDE - 0.02, WIDE + 0.02], shades(GLASS));
    for i in 0..5 {
        let back = -16.0 + 2.2 * f64::from(i);
        let grille = [(back, 2.3), (back + 1.6, 2.3), (back + 1.6, 3.1), (back, 3.1)];
        builder.prism(&profile(&grille), [-WIDE - 0.02, WIDE + 0.02], shades([0.16, 0.17, 0.2]));
    }
}
