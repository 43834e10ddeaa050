use super::beam::{NONE, RAYS};
use super::tile::SIDE;
use crate::scene::{Lens, Projection};
use glam::{DVec2, DVec3};

/// Lines of sight of a tile and what they meet, side by side.
#[repr(align(64))]
pub(super) struct Sights {
    /// How many there are.
    pub count: usize,
    /// Numbers of the pixels in the band.
    pub pixels: [u32; RAYS],
    /// Where they go through the picture, in pixels.
    at: [[f64; RAYS]; 2],
    /// Lengths and components, observer's axes.
    pub lines: [[f64; RAYS]; 4],
    /// 1/s of the nearest hit, in units of the line; 0 for none.
    pub nearness: [f64; RAYS],
    /// What is hit, by its number among the tile's faces; [`NONE`] for nothing.
    pub faces: [u32; RAYS],
    /// The directions in the rest frame of what is hit.
    pub rest: [[f64; RAYS]; 3],
    /// Its Doppler factors.
    pub dopplers: [f64; RAYS],
}

impl Default for Sights {
    fn default() -> Self {
        Self {
            count: 0,
            pixels: [0; RAYS],
            at: [[0.0; RAYS]; 2],
            // Any that can be boosted, where there are none.
            lines: [[1.0; RAYS], [0.0; RAYS], [0.0; RAYS], [1.0; RAYS]],
            nearness: [0.0; RAYS],
            faces: [NONE; RAYS],
            rest: [[0.0; RAYS]; 3],
            dopplers: [1.0; RAYS],
        }
    }
}

impl Sights {
    /// Makes them those of a sample of all pixels of a tile, `top` in the picture; they meet nothing yet.
    pub fn aim(&mut self, lens: &Lens, [left, top]: [u32; 2], [width, height]: [u32; 2], sample: [f64; 2]) {
        const ACROSS: usize = SIDE as usize;
        let place = |from: u32, sample: f64| {
            std::array::from_fn::<f64, ACROSS, _>(|i| f64::from(from + i as u32) + sample)
        };
        let (x, y) = (place(left, sample[0]), place(top, sample[1]));
        let [width, height] = [width, height].map(|n| n as usize);
        let picture_width = lens.width() as usize;
        let pixel = |line: usize, column: usize| (line * picture_width + left as usize + column) as u32;
        if lens.projection() == Projection::Pinhole {
            // A column has one x, and a line one y.
            let direction = |x: f64, y: f64| lens.direction(DVec2::new(x, y)).unwrap_or(DVec3::Z);
            let (across, down) = (x.map(|x| direction(x, y[0]).x), y.map(|y| direction(x[0], y).y));
            self.count = width * height;
            for line in 0..height {
                let row = line * width..(line + 1) * width;
                self.lines[1][row.clone()].copy_from_slice(&across[..width]);
                self.lines[2][row.clone()].fill(down[line]);
                self.at[0][row.clone()].copy_from_slice(&x[..width]);
                self.at[1][row.clone()].fill(y[line]);
                for (column, of) in self.pixels[row].iter_mut().enumerate() {
                    *of = pixel(line, column);
                }
            }
            let [lengths, x, y, z] = &mut self.lines;
            z.fill(1.0);
            for (i, length) in lengths.iter_mut().enumerate() {
                *length = (x[i] * x[i] + y[i] * y[i] + 1.0).sqrt();
            }
        } else {
            self.count = 0;
            for (line, y) in y[..height].iter().enumerate() {
                for (column, x) in x[..width].iter().enumerate() {
                    let Some(direction) = lens.direction(DVec2::new(*x, *y)) else { continue };
                    let i = self.count;
                    self.count += 1;
                    self.pixels[i] = pixel(line, column);
                    [self.at[0][i], self.at[1][i]] = [*x, *y];
                    self.lines[0][i] = direction.length();
                    for k in 0..3 {
                        self.lines[k + 1][i] = direction[k];
                    }
                }
            }
        }
        self.nearness.fill(0.0);
        self.faces.fill(NONE);
    }

    /// Where a line of sight goes through the picture, in pixels.
    #[inline]
    pub fn place(&self, i: usize) -> DVec2 {
        DVec2::new(self.at[0][i], self.at[1][i])
    }

    /// A line of sight, observer's axes.
    #[inline]
    pub fn direction(&self, i: usize) -> DVec3 {
        DVec3::new(self.lines[1][i], self.lines[2][i], self.lines[3][i])
    }

    /// The same in the rest frame of what it meets.
    #[inline]
    pub fn rest_direction(&self, i: usize) -> DVec3 {
        DVec3::new(self.rest[0][i], self.rest[1][i], self.rest[2][i])
    }

    /// From the observer's event to those where they meet that, in its rest frame; anything where they meet nothing.
    pub fn events(&self, events: &mut [[f64; RAYS]; 4]) {
        let [t, x, y, z] = events;
        let [a, b, c] = &self.rest;
        for i in 0..RAYS {
            let s = 1.0 / self.nearness[i];
            [x[i], y[i], z[i]] = [s * a[i], s * b[i], s * c[i]];
            t[i] = -(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt();
        }
    }

    /// Where it meets that, from the observer in its rest frame.
    #[inline]
    pub fn point(&self, i: usize) -> DVec3 {
        self.rest_direction(i) / self.nearness[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// They are the lens's, of whole tiles and of parts, and none where there is no sky.
    #[test]
    fn lines_of_sight_are_those_of_the_lens() {
        let mut sights = Sights::default();
        for (projection, fov) in
            [(Projection::Pinhole, 70.0), (Projection::Fisheye, 360.0), (Projection::Panorama, 360.0)]
        {
            let lens = Lens::new(projection, fov, 21, 19).unwrap();
            let (mut count, mut expected) = (0, 0);
            for (left, top) in [(0, 0), (8, 8), (16, 16), (16, 0)] {
                let size = [8.min(21 - left), 8.min(19 - top)];
                sights.aim(&lens, [left, top], size, [0.25, 0.75]);
                for i in 0..sights.count {
                    let (x, line) = (sights.pixels[i] % 21, sights.pixels[i] / 21);
                    let at = DVec2::new(f64::from(x) + 0.25, f64::from(top + line) + 0.75);
                    assert_eq!(sights.place(i), at);
                    assert_eq!(Some(sights.direction(i)), lens.direction(at));
                    assert_eq!(sights.lines[0][i], sights.direction(i).length());
                    assert_eq!((sights.faces[i], sights.nearness[i]), (NONE, 0.0));
                }
                count += sights.count;
                let places = (0..size[0]).flat_map(|x| (0..size[1]).map(move |y| (x, y)));
                let is_sky = |(x, y): &(u32, u32)| {
                    lens.direction(DVec2::new(f64::from(left + x) + 0.25, f64::from(top + y) + 0.75))
                        .is_some()
                };
                expected += places.filter(is_sky).count();
            }
            assert_eq!(count, expected);
        }
    }
}
