use crate::scene::{Mesh, Paint};
use glam::{DVec2, DVec3};

/// A mesh put together from coloured triangles.
#[derive(Default)]
pub(super) struct Builder {
    pub triangles: Vec<[(DVec3, [f32; 3]); 3]>,
}

impl Builder {
    pub fn triangle(&mut self, corners: [DVec3; 3], color: [f32; 3]) {
        self.triangles.push(corners.map(|c| (c, color)));
    }

    /// Corners counter-clockwise seen from outside.
    pub fn quad(&mut self, [a, b, c, d]: [DVec3; 4], color: [f32; 3]) {
        self.triangle([a, b, c], color);
        self.triangle([a, c, d], color);
    }

    /// One side of the box from `low` to `high`, numbered as in [`SIDE_COLORS`](super::SIDE_COLORS); the box may
    /// be flat.
    pub fn side(&mut self, low: [f64; 3], high: [f64; 3], side: usize, color: [f32; 3]) {
        /// For every corner and axis, low or high.
        const SIDES: [[[usize; 3]; 4]; 6] = [
            [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]],
            [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
            [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
            [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]],
            [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
            [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
        ];
        let ends = [low, high];
        self.quad(SIDES[side].map(|[x, y, z]| DVec3::new(ends[x][0], ends[y][1], ends[z][2])), color);
    }

    pub fn cuboid(&mut self, low: [f64; 3], high: [f64; 3], colors: [[f32; 3]; 6]) {
        for (side, color) in colors.into_iter().enumerate() {
            self.side(low, high, side, color);
        }
    }

    /// A convex profile in x and z, counter-clockwise seen from −y, drawn out along y.
    pub fn prism(&mut self, profile: &[DVec2], y: [f64; 2], sides: [[f32; 3]; 6]) {
        let at = |p: DVec2, y: f64| DVec3::new(p.x, y, p.y);
        for (i, &a) in profile.iter().enumerate() {
            let b = profile[(i + 1) % profile.len()];
            let outward = (a - b).perp().normalize();
            let color = blend(at(outward, 0.0), sides);
            self.quad([at(a, y[0]), at(a, y[1]), at(b, y[1]), at(b, y[0])], color);
        }
        for pair in profile[1..].windows(2) {
            let [a, b, c] = [profile[0], pair[0], pair[1]];
            self.triangle([at(a, y[0]), at(b, y[0]), at(c, y[0])], sides[2]);
            self.triangle([at(a, y[1]), at(c, y[1]), at(b, y[1])], sides[3]);
        }
    }

    /// A wheel on an axle along y: a dark tyre, the outer disc (towards −y if `y` falls, +y if it rises) in
    /// sectors, so that its turning and its shape can be told.
    pub fn wheel(&mut self, hub: DVec2, radius: f64, y: [f64; 2]) {
        const SECTORS: usize = 16;
        let rim = |i: usize, r: f64, y: f64| {
            let turn = (i % SECTORS) as f64 * std::f64::consts::TAU / SECTORS as f64;
            let at = hub + r * DVec2::from_angle(turn);
            DVec3::new(at.x, y, at.y)
        };
        for i in 0..SECTORS {
            let [a, b] = [rim(i, radius, y[0]), rim(i + 1, radius, y[0])];
            let [c, d] = [rim(i, radius, y[1]), rim(i + 1, radius, y[1])];
            let tyre = if i % 2 == 0 { [0.05; 3] } else { [0.08; 3] };
            let sector = if i % 4 < 2 { [0.34; 3] } else { [0.11; 3] };
            let centre = DVec3::new(hub.x, y[1], hub.y);
            if y[1] < y[0] {
                self.quad([a, b, d, c], tyre);
                self.triangle([centre, c, d], sector);
            } else {
                self.quad([b, a, c, d], tyre);
                self.triangle([centre, d, c], sector);
            }
        }
    }

    /// Equal corners become one vertex: of equal colours too, if any triangle has several.
    pub fn finish(self) -> Mesh {
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

/// The colours of the sides a normal faces, weighed by the squares of its components.
pub(super) fn blend(normal: DVec3, sides: [[f32; 3]; 6]) -> [f32; 3] {
    let mut out = [0.0; 3];
    for (axis, component) in normal.to_array().into_iter().enumerate() {
        let side = sides[2 * axis + usize::from(component > 0.0)];
        let weight = (component * component) as f32;
        out = [0, 1, 2].map(|i| out[i] + weight * side[i]);
    }
    out
}

/// A colour in six shades for the sides −x, +x, −y, +y, −z, +z, so that a shape can be read without light.
pub(super) fn shades(color: [f32; 3]) -> [[f32; 3]; 6] {
    [0.7, 0.8, 1.0, 0.9, 0.45, 1.2].map(|shade| color.map(|c| shade * c))
}
