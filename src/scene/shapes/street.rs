use super::Builder;
use super::builder::shades;
use crate::scene::Mesh;
use glam::DVec3;

/// Plaster of the houses, in turn.
const PLASTER: [[f32; 3]; 7] = [
    [0.58, 0.2, 0.09],
    [0.62, 0.54, 0.34],
    [0.14, 0.3, 0.46],
    [0.66, 0.4, 0.07],
    [0.46, 0.13, 0.17],
    [0.24, 0.38, 0.17],
    [0.6, 0.59, 0.55],
];
/// Width of the houses, in turn; and storeys.
const HOUSES: [(f64, u32); 7] = [(9.0, 3), (7.0, 2), (11.0, 3), (8.0, 4), (10.0, 2), (7.0, 3), (12.0, 3)];
/// Half the road, and where the houses begin.
const KERB: f64 = 6.0;
const FRONT: f64 = 9.0;
const REACH: f64 = 64.0;
const STOREY: f64 = 3.0;

/// A straight street in metres, along x from −64 to 64: a road 12 wide with two tracks (y = ±1.5), pavements, and a
/// row of houses on either side, their fronts at y = ±9. The road lies at z = 0.
pub fn street() -> Mesh {
    let mut builder = Builder::default();
    let mut flat = |y: [f64; 2], z: f64, color: [f32; 3]| {
        builder.side([-REACH, y[0], z], [REACH, y[1], z], 5, color);
    };
    flat([-KERB, KERB], 0.0, [0.075, 0.075, 0.085]);
    for track in [-1.5, 1.5] {
        for rail in [-0.72, 0.72] {
            flat([track + rail - 0.05, track + rail + 0.05], 0.02, [0.4, 0.4, 0.42]);
        }
    }
    flat([KERB, FRONT + 0.2], 0.15, [0.26, 0.25, 0.23]);
    flat([-FRONT - 0.2, -KERB], 0.15, [0.26, 0.25, 0.23]);
    builder.side([-REACH, -KERB, 0.0], [REACH, -KERB, 0.15], 3, [0.4; 3]);
    builder.side([-REACH, KERB, 0.0], [REACH, KERB, 0.15], 2, [0.4; 3]);
    // Dashes three metres long between the lanes.
    for i in 0..21 {
        let x = -REACH + 1.0 + 6.0 * f64::from(i);
        for y in [-3.1, 3.1] {
            builder.side([x, y - 0.08, 0.02], [x + 3.0, y + 0.08, 0.02], 5, [0.6; 3]);
        }
    }
    for far in [true, false] {
        let mut x = -REACH;
        for i in 0.. {
            let number = if far { i } else { i + 3 };
            let (width, storeys) = HOUSES[number % HOUSES.len()];
            if x + width > REACH {
                break;
            }
            house(&mut builder, [x, x + width], far, storeys, PLASTER[(number * 3 + i / 7) % PLASTER.len()]);
            x += width;
        }
    }
    builder.finish()
}

/// A house with its front to the street, the ridge of its roof along it.
fn house(builder: &mut Builder, x: [f64; 2], far: bool, storeys: u32, plaster: [f32; 3]) {
    const DEPTH: f64 = 9.0;
    const ROOF: [f32; 3] = [0.3, 0.09, 0.06];
    let eaves = 0.6 + STOREY * f64::from(storeys);
    // Outward from the street: fronts look at −y on the far side.
    let out = if far { 1.0 } else { -1.0 };
    let (front, back) = (out * FRONT, out * (FRONT + DEPTH));
    let walls = shades(plaster);
    builder.cuboid([x[0], front.min(back), 0.0], [x[1], front.max(back), eaves], walls);

    let (ridge, top) = (0.5 * (front + back), eaves + 2.6);
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let slope = |y: f64| {
        let [a, b] = [
            at(x[0], y - 0.08 * (ridge - y).signum(), eaves - 0.05),
            at(x[1], y - 0.08 * (ridge - y).signum(), eaves - 0.05),
        ];
        let [c, d] = [at(x[1], ridge, top), at(x[0], ridge, top)];
        if y < ridge { [a, b, c, d] } else { [b, a, d, c] }
    };
    builder.quad(slope(front), ROOF);
    builder.quad(slope(back), ROOF.map(|c| 0.8 * c));
    let (low, high) = (front.min(back), front.max(back));
    builder.triangle([at(x[0], low, eaves), at(x[0], ridge, top), at(x[0], high, eaves)], walls[0]);
    builder.triangle([at(x[1], low, eaves), at(x[1], high, eaves), at(x[1], ridge, top)], walls[1]);

    let side = if far { 2 } else { 3 };
    let mut panel = |x: [f64; 2], z: [f64; 2], proud: f64, color| {
        let y = front - out * proud;
        builder.side([x[0], y, z[0]], [x[1], y, z[1]], side, color);
    };
    let across = ((x[1] - x[0]) / 2.3).floor() as u32;
    let pitch = (x[1] - x[0]) / f64::from(across);
    for storey in 0..storeys {
        for i in 0..across {
            let middle = x[0] + (f64::from(i) + 0.5) * pitch;
            let z = 0.6 + STOREY * f64::from(storey);
            if storey == 0 && i == across / 2 {
                panel([middle - 0.6, middle + 0.6], [0.15, 2.6], 0.04, [0.55, 0.5, 0.42]);
                panel([middle - 0.5, middle + 0.5], [0.15, 2.5], 0.08, plaster.map(|c| 0.35 * c));
            } else {
                panel([middle - 0.6, middle + 0.6], [z + 0.6, z + 2.3], 0.04, [0.7, 0.68, 0.62]);
                panel([middle - 0.5, middle - 0.04], [z + 0.7, z + 2.2], 0.08, [0.04, 0.06, 0.09]);
                panel([middle + 0.04, middle + 0.5], [z + 0.7, z + 2.2], 0.08, [0.04, 0.06, 0.09]);
            }
        }
    }
}
