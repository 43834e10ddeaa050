use super::beam::{Beam, NONE, RAYS, SAME, facing};
use super::origin::Origin;
use super::stage::{Scratch, Stage, angle};
use crate::film::Rows;
use crate::light::{Facet, Point, SeenShading};
use crate::scene::Lens;
use glam::{DVec2, DVec3};

/// Pixels of a tile's side.
pub(super) const SIDE: u32 = 8;

/// What one thread draws tiles in, used again for the next.
#[derive(Default)]
pub(super) struct Tile {
    beam: Beam,
    scratch: Scratch,
    sights: Vec<Sight>,
    rays: Vec<(usize, DVec3)>,
    lit: Vec<u64>,
    count: Count,
}

/// What was done.
#[derive(Clone, Copy, Debug, Default)]
pub struct Count {
    /// Rays from the camera.
    pub primary: u64,
    /// Rays from surfaces to lights, by light and none; of them, those that something was in the way of.
    pub shadow: u64,
    /// Of those, how many something stood in the way of.
    pub blocked: u64,
}

impl Count {
    pub(super) fn add(mut self, other: Self) -> Self {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.blocked += other.blocked;
        self
    }
}

/// A line of sight and what it meets.
#[derive(Clone, Copy)]
struct Sight {
    /// Of the pixel in the band.
    pixel: usize,
    at: DVec2,
    direction: DVec3,
    length: f64,
    /// 1/s of the nearest hit, in units of the direction; 0 for none.
    nearness: f64,
    target: usize,
    face: u32,
}

/// What is to be drawn.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub stage: &'a Stage,
    pub lens: &'a Lens,
    pub shading: &'a SeenShading<'a>,
    /// Of the samples, in pixels from a pixel's corner.
    pub samples: &'a [[f64; 2]],
    /// Whether AVX2 may be used.
    pub vectors: bool,
}

impl Tile {
    /// Draws a band of the film, [`SIDE`] rows from `top` on.
    pub fn draw_band(&mut self, job: &Job<'_>, top: u32, mut rows: Rows<'_>) -> Count {
        let weight = 1.0 / job.samples.len() as f32;
        self.follow_band(job, top, |tile, sample| tile.develop(job, weight, sample == 0, &mut rows))
    }

    /// Only follows the band's rays.
    pub fn cast_band(&mut self, job: &Job<'_>, top: u32) -> Count {
        self.follow_band(job, top, |_, _| ())
    }

    /// Follows all rays of a band, tile by tile and sample by sample.
    fn follow_band(&mut self, job: &Job<'_>, top: u32, mut done: impl FnMut(&Self, usize)) -> Count {
        self.count = Count::default();
        let width = job.lens.width();
        let height = SIDE.min(job.lens.height() - top);
        for left in (0..width).step_by(SIDE as usize) {
            for (number, sample) in job.samples.iter().enumerate() {
                self.look(job, [left, top], [SIDE.min(width - left), height], *sample);
                self.find(job);
                self.light(job);
                done(self, number);
            }
        }
        self.count
    }

    /// Lines of sight of a sample of all pixels.
    fn look(&mut self, job: &Job<'_>, [left, top]: [u32; 2], [width, height]: [u32; 2], sample: [f64; 2]) {
        self.sights.clear();
        for line in 0..height {
            for column in 0..width {
                let at =
                    DVec2::new(f64::from(left + column), f64::from(top + line)) + DVec2::from_array(sample);
                let Some(direction) = job.lens.direction(at) else { continue };
                self.sights.push(Sight {
                    pixel: (line * job.lens.width() + left + column) as usize,
                    at,
                    direction,
                    length: direction.length(),
                    nearness: 0.0,
                    target: 0,
                    face: NONE,
                });
            }
        }
        self.count.primary += self.sights.len() as u64;
    }

    /// The nearest triangle of any body for every line of sight.
    fn find(&mut self, job: &Job<'_>) {
        let middle: DVec3 = self.sights.iter().map(|s| s.direction / s.length).sum();
        let axis = middle.normalize_or(DVec3::Z);
        let half_angle = self.sights.iter().map(|s| angle(axis, s.direction / s.length)).fold(0.0, f64::max);
        for (index, target) in job.stage.targets.iter().enumerate() {
            if !target.outline.meets(axis, half_angle) {
                continue;
            }
            self.rays.clear();
            let rest = |s: &Sight| target.rest_direction(s.direction, s.length);
            self.rays.extend(self.sights.iter().map(rest).enumerate());
            let origin = Origin::of_observer(&target.map);
            // Those that face the same way at a time; mostly all.
            while let Some(&(_, first)) = self.rays.first() {
                let way = facing(first);
                let alike = self.rays.iter().filter(|(_, d)| facing(*d) == way);
                let rays = alike.clone().map(|(i, d)| (*d, self.sights[*i].nearness));
                self.beam.aim(way, rays, &target.tree, &origin);
                self.beam.trace(&target.tree, &origin, job.vectors);
                for (number, (i, direction)) in alike.enumerate() {
                    let found = self.beam.found(number);
                    if found == NONE {
                        continue;
                    }
                    let leaf = &target.tree.leaves[found as usize];
                    let [a, b, c] = leaf.corners.map(|c| origin.to(c));
                    let normal = (b - a).cross(c - a);
                    let nearness = normal.dot(*direction) / normal.dot(a);
                    let sight = &mut self.sights[*i];
                    if nearness > sight.nearness * (1.0 + SAME) {
                        *sight = Sight { nearness, target: index, face: leaf.face, ..*sight };
                    }
                }
                self.rays.retain(|(_, d)| facing(*d) != way);
            }
        }
    }

    /// Which lights reach what is seen: a bit a line of sight for each.
    fn light(&mut self, job: &Job<'_>) {
        let lights = job.shading.lights();
        self.lit.clear();
        self.lit.resize(lights, !0);
        if lights == 0 {
            return;
        }
        debug_assert!(self.sights.len() <= RAYS);
        for (number, sight) in self.sights.iter().enumerate() {
            if sight.face == NONE {
                continue;
            }
            let target = &job.stage.targets[sight.target];
            if !job.shading.is_lit(target.body, target.mesh.material_index(sight.face as usize)) {
                continue;
            }
            let (facet, at) = sight.meets(job.stage);
            let point: Point = facet.point(at);
            for light in 0..lights {
                let Some(approach) = job.shading.approach(target.body, light, &point) else { continue };
                self.count.shadow += 1;
                if !job.stage.is_free(sight.target, sight.face, &point, &approach, &mut self.scratch) {
                    self.count.blocked += 1;
                    self.lit[light] &= !(1 << number);
                }
            }
        }
    }

    /// Looks up what the triangles look like.
    fn develop(&self, job: &Job<'_>, weight: f32, centre: bool, rows: &mut Rows<'_>) {
        // Each of many samples stands for a part of the pixel.
        let spread = f64::from(weight.sqrt());
        for (number, sight) in self.sights.iter().enumerate() {
            if sight.face == NONE {
                continue;
            }
            let target = &job.stage.targets[sight.target];
            let (facet, at) = sight.meets(job.stage);
            let doppler = sight.length / target.sky.boosted(sight.direction, sight.length).length;
            let sights = || {
                // A look along the line of sight itself where there is no neighbour: as sharp as can be.
                let to =
                    |step: DVec2| job.lens.direction(sight.at + step * spread).unwrap_or(sight.direction);
                [sight.direction, to(DVec2::X), to(DVec2::Y)].map(|v| target.rest_direction(v, v.length()))
            };
            let light = job.shading.radiance_with_shadows(
                target.body,
                target.mesh.material_index(facet.face()),
                doppler,
                || facet.colors(at, sights),
                || facet.point(at),
                |light| self.lit[light] >> number & 1 == 1,
            );
            let i = sight.pixel;
            let color = &mut rows.color[i];
            *color = [0, 1, 2].map(|c| color[c] + weight * light[c]);
            if centre {
                rows.distance[i] = (sight.length / sight.nearness) as f32;
                rows.doppler[i] = doppler as f32;
                rows.body[i] = target.body as i32;
                rows.face[i] = sight.face as i32;
            }
        }
    }
}

impl Sight {
    /// The triangle, and where on it, both from the observer in the rest frame.
    fn meets<'a>(&self, stage: &'a Stage) -> (Facet<'a>, DVec3) {
        let target = &stage.targets[self.target];
        let face = self.face as usize;
        let corners = target.mesh.corners(face).map(|c| target.map.offset_rest(c));
        let at = target.rest_direction(self.direction, self.length) / self.nearness;
        (Facet::new(&target.mesh, face, corners), at)
    }
}
