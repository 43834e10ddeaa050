use super::beam::{Beam, NONE, RAYS, SAME};
use super::bundle::Bundle;
use super::directed::{Directed, facing};
use super::faces::{Appearance, Faces};
use super::lists::Lists;
use super::origin::Origin;
use super::path::{self, Vertex, World};
use super::random::Random;
use super::sights::Sights;
use super::stage::Stage;
use crate::color::Coloring;
use crate::film::Rows;
use crate::light::{Arrivals, Points, SeenShading, Ways, logarithms};
use crate::scene::{Lens, Projection, Sky};
use glam::{DVec2, DVec3, Vec3A};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use terrell_geodesic::{FourVector, Lorentz, Observer};

/// Pixels of a tile's side.
pub(super) const SIDE: u32 = 8;

/// What one thread draws tiles in, used again for the next.
#[derive(Default)]
pub(super) struct Tile {
    beam: Beam,
    bundle: Bundle,
    paths: path::Scratch,
    /// First row of pixels, and column of tiles.
    top: u32,
    column: u32,
    /// Triangles of many tiles that may be seen in the row of tiles, by target and column.
    large: Vec<Vec<u32>>,
    /// Triangles of one body that may be seen in the tile.
    candidates: Vec<u32>,
    sights: Sights,
    /// Bodies that may be seen in the tile.
    met: Vec<usize>,
    /// Lines of sight in the rest frame of one of them.
    rays: Directed,
    /// Of which lines of sight the rays are.
    numbers: Vec<usize>,
    /// What of one body may be lit, and how it is lit.
    points: Points,
    ways: Ways,
    lit: Vec<u64>,
    /// What arrives of each light, by line of sight.
    arrivals: Vec<Arrivals>,
    /// Rays to each light in a band, and how many of them are blocked.
    to_lights: Vec<[u64; 2]>,
    count: Count,
}

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Rays from the camera.
    pub primary: u64,
    /// Rays from what is seen to lights.
    pub shadow: u64,
    /// Of those, how many something stood in the way of.
    pub blocked: u64,
    /// Rays through curved spacetime that met a body, where nothing is wrong with it.
    pub bodies: u64,
    /// Those that came from the sky.
    pub sky: u64,
    /// Those that came out of a black hole.
    pub hole: u64,
    /// Those that met a surface that would move faster than light there.
    pub impossible: u64,
    /// Those given up because they took too many steps.
    pub step_limit: u64,
    /// Those given up because they drifted off the light cone.
    pub drifted: u64,
    /// Those given up because the metric was none, or something no number.
    pub singular: u64,
    /// Rays of paths from surface to surface, and from there to lights.
    pub path: u64,
}

impl Count {
    /// Both together.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.blocked += other.blocked;
        self.bodies += other.bodies;
        self.sky += other.sky;
        self.hole += other.hole;
        self.impossible += other.impossible;
        self.step_limit += other.step_limit;
        self.drifted += other.drifted;
        self.singular += other.singular;
        self.path += other.path;
        self
    }

    /// Rays that were given up.
    pub fn failed(&self) -> u64 {
        self.step_limit + self.drifted + self.singular
    }
}

/// What is to be drawn.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub stage: &'a Stage,
    /// Where triangles may be seen, by target; none where trees are gone through.
    pub lists: Option<&'a [Lists]>,
    pub lens: &'a Lens,
    pub shading: &'a SeenShading<'a>,
    /// What lies behind everything, and the map from the observer to its frame.
    pub sky: Option<(&'a Sky, Lorentz<terrell_geodesic::World, Observer>)>,
    /// Of the samples, in pixels from a pixel's corner.
    pub samples: &'a [[f64; 2]],
    /// Whether AVX2 may be used.
    pub vectors: bool,
    /// Rays to each light, and how many of them are blocked.
    pub to_lights: &'a [[AtomicU64; 2]],
    /// Where light of surfaces on each other is followed.
    pub world: Option<&'a World<'a>>,
}

impl Tile {
    /// Draws some of the samples of a band of the film, [`SIDE`] rows from `top` on.
    pub fn draw_band(&mut self, job: &Job<'_>, top: u32, pass: Range<usize>, mut rows: Rows<'_>) -> Count {
        if pass.start == 0 {
            rows.clear();
        }
        self.follow_band(job, top, pass, true, |tile, faces, sample| {
            tile.develop(job, faces, sample, &mut rows)
        })
    }

    /// Only follows the band's rays.
    pub fn cast_band(&mut self, job: &Job<'_>, top: u32) -> Count {
        self.follow_band(job, top, 0..job.samples.len(), false, |_, _, _| ())
    }

    /// Follows the rays of a band, tile by tile and sample by sample; `shaded` if more than rays matters.
    fn follow_band<'a>(
        &mut self,
        job: &Job<'a>,
        top: u32,
        pass: Range<usize>,
        shaded: bool,
        mut done: impl FnMut(&mut Self, &mut Faces<'a>, usize),
    ) -> Count {
        self.count = Count::default();
        self.to_lights.clear();
        self.to_lights.resize(job.to_lights.len(), [0; 2]);
        let mut faces = Faces::default();
        self.top = top;
        let width = job.lens.width();
        let height = SIDE.min(job.lens.height() - top);
        let columns = width.div_ceil(SIDE) as usize;
        self.list_large(job, columns);
        for left in (0..width).step_by(SIDE as usize) {
            let size = [SIDE.min(width - left), height];
            let (axis, half_angle) = cone(job.lens, [left, top], size);
            self.met.clear();
            self.column = left / SIDE;
            let targets = job.stage.targets.iter().enumerate();
            let met = targets.filter(|(_, t)| t.outline.meets(axis, half_angle)).map(|(i, _)| i);
            let may_be_met = |i: &usize| match job.lists {
                None => true,
                Some(lists) => {
                    let large = &self.large[*i * columns + self.column as usize];
                    !large.is_empty() || !lists[*i].of_tile(top / SIDE, self.column).is_empty()
                }
            };
            self.met.extend(met.filter(may_be_met));
            if self.met.is_empty() && job.sky.is_none() {
                // Rays they are all the same.
                self.count.primary += pass.len() as u64 * u64::from(size[0] * size[1]);
                continue;
            }
            faces.clear();
            for number in pass.clone() {
                faces.limit();
                self.sights.aim(job.lens, [left, top], size, job.samples[number]);
                self.count.primary += self.sights.count as u64;
                self.find(job, &mut faces);
                self.light(job, &faces, shaded);
                done(self, &mut faces, number);
            }
        }
        self.count.path += std::mem::take(&mut self.paths.rays);
        for (all, of_band) in job.to_lights.iter().zip(&self.to_lights) {
            self.count.shadow += of_band[0];
            self.count.blocked += of_band[1];
            for (all, count) in all.iter().zip(of_band) {
                all.fetch_add(*count, Ordering::Relaxed);
            }
        }
        self.count
    }

    /// Sorts what is seen in many tiles into those of the row.
    fn list_large(&mut self, job: &Job<'_>, columns: usize) {
        let Some(lists) = job.lists else { return };
        self.large.iter_mut().for_each(Vec::clear);
        self.large.resize_with(lists.len() * columns, Vec::new);
        for (lists, large) in lists.iter().zip(self.large.chunks_mut(columns)) {
            for ([from, to], number) in lists.large_of_row(self.top / SIDE) {
                large[from as usize..to as usize].iter_mut().for_each(|tile| tile.push(number));
            }
        }
    }

    /// The nearest triangle of any body for every line of sight.
    fn find<'a>(&mut self, job: &Job<'a>, faces: &mut Faces<'a>) {
        for met in 0..self.met.len() {
            let index = self.met[met];
            let target = &job.stage.targets[index];
            if self.sights.count == 0 {
                return;
            }
            if let Some(lists) = job.lists {
                self.candidates.clear();
                let (lists, column) = (&lists[index], self.column as usize);
                self.candidates.extend_from_slice(lists.of_tile(self.top / SIDE, self.column));
                self.candidates.extend_from_slice(&self.large[index * lists.columns + column]);
            }
            self.rays.count = self.sights.count;
            self.rays.nearness = self.sights.nearness;
            target.boost(&self.sights.lines, &mut self.rays, job.vectors);
            if let Some(way) = self.rays.facing() {
                self.numbers.clear();
                self.numbers.extend(0..self.rays.count);
                self.follow(job, index, way, faces);
                continue;
            }
            // Those that face the same way at a time.
            let all = self.rays;
            for way in (0..3).flat_map(|k| [(k, false), (k, true)]) {
                self.numbers.clear();
                self.numbers.extend((0..all.count).filter(|i| facing(all.direction(*i)) == way));
                self.rays.count = 0;
                for i in &self.numbers {
                    self.rays.push_of(&all, *i);
                }
                if self.rays.count > 0 {
                    self.follow(job, index, way, faces);
                }
            }
        }
    }

    /// What of one body the rays hit, which are those of the lines of sight in `numbers`.
    fn follow<'a>(&mut self, job: &Job<'a>, index: usize, way: (usize, bool), faces: &mut Faces<'a>) {
        let target = &job.stage.targets[index];
        let origin = Origin::of_observer(&target.map);
        let leaves = job.lists.map(|_| &self.candidates[..]);
        self.beam.trace(way, &self.rays, &target.tree, leaves, &origin, job.vectors);
        let sights = &mut self.sights;
        for (number, &i) in self.numbers.iter().enumerate() {
            let found = self.beam.found(number);
            if found == NONE {
                continue;
            }
            let face = faces.number(index, target, found);
            let rest = self.rays.direction(number);
            let nearness = faces.all[face as usize].plane.dot(rest);
            if nearness > sights.nearness[i] * (1.0 + SAME) {
                (sights.nearness[i], sights.faces[i]) = (nearness, face);
                sights.dopplers[i] = self.rays.dopplers[number];
                for k in 0..3 {
                    sights.rest[k][i] = rest[k];
                }
            }
        }
    }

    /// Which lights reach what is seen, a bit a line of sight for each, and how strong they are there.
    fn light(&mut self, job: &Job<'_>, faces: &Faces<'_>, shaded: bool) {
        let lights = job.shading.lights();
        self.lit.clear();
        self.lit.resize(lights, !0);
        self.arrivals.resize_with(lights, Arrivals::default);
        if lights == 0 {
            return;
        }
        self.sights.events(&mut self.points.events);
        for met in 0..self.met.len() {
            let index = self.met[met];
            let target = &job.stage.targets[index];
            self.gather(job, index, faces);
            if self.points.mask == 0 {
                continue;
            }
            for light in 0..lights {
                let Self { points, ways, bundle, .. } = self;
                job.shading.ways(target.body, light, points, ways, job.vectors);
                if shaded {
                    let arrivals = &mut self.arrivals[light];
                    job.shading.arrivals((target.body, light), points, ways, arrivals, job.vectors);
                }
                let blocked = bundle.blocked(job.stage, index, points, ways, job.vectors);
                self.lit[light] &= !blocked;
                for (count, bits) in self.to_lights[light].iter_mut().zip([ways.open, blocked]) {
                    *count += u64::from(bits.count_ones());
                }
            }
        }
    }

    /// Points of one body that may be lit.
    fn gather(&mut self, job: &Job<'_>, index: usize, faces: &Faces<'_>) {
        self.points.mask = 0;
        let target = &job.stage.targets[index];
        // The triangle met last, if it may be lit.
        let (mut last, mut lit) = (NONE, None);
        for (i, &number) in self.sights.faces[..self.sights.count].iter().enumerate() {
            if number != last {
                last = number;
                lit = faces.all.get(number as usize).filter(|face| {
                    let material = || target.mesh.material_index(face.facet.face());
                    face.target == index && job.shading.is_lit(target.body, material())
                });
            }
            if let Some(face) = lit {
                self.points.add(i, face.facet.face(), face.normal_seen(|| self.sights.point(i)));
            }
        }
    }

    /// Looks up what the triangles look like.
    fn develop<'a>(&mut self, job: &Job<'a>, faces: &mut Faces<'a>, sample: usize, rows: &mut Rows<'_>) {
        let weight = 1.0 / job.samples.len() as f32;
        // Each of many samples stands for a part of the pixel.
        let spread = f64::from(weight.sqrt());
        let sights = &self.sights;
        let mut logs = [0.0; RAYS];
        if job.shading.coloring() == Coloring::Spectral {
            logarithms(&sights.dopplers, &mut logs, job.vectors);
        }
        for (number, &logarithm) in logs[..sights.count].iter().enumerate() {
            let pixel = sights.pixels[number] as usize;
            let Some(face) = faces.all.get_mut(sights.faces[number] as usize) else {
                if let Some((sky, world_from_observer)) = &job.sky {
                    self.see_sky(job, number, sky, world_from_observer, weight, sample == 0, rows);
                }
                continue;
            };
            let target = &job.stage.targets[face.target];
            let (index, leaf) = (face.target, face.leaf);
            let doppler = sights.dopplers[number];
            let (facet, look) = face.appearance(job.shading, target, &mut faces.tables);
            let Appearance { material, plain, glow, diffuse, tables } = look;
            let material = *material;
            let at = || sights.point(number);
            let looks = || {
                // A look along the line of sight itself where there is no neighbour: as sharp as can be.
                let here = sights.direction(number);
                let to =
                    |step: DVec2| job.lens.direction(sights.place(number) + step * spread).unwrap_or(here);
                [here, to(DVec2::X), to(DVec2::Y)].map(|v| target.rest_direction(v, v.length()))
            };
            let colors = || plain.unwrap_or_else(|| facet.colors(at(), looks));
            // Paths find out where light from everywhere comes in.
            let reaches = |light: usize| {
                self.lit[light] >> number & 1 == 1 && !(job.world.is_some() && job.shading.is_ambient(light))
            };
            let shadowed = || {
                let point = || facet.point(at());
                let shading = job.shading;
                Vec3A::from_array(shading.radiance_with_shadows(
                    target.body,
                    material,
                    doppler,
                    colors,
                    point,
                    reaches,
                ))
            };
            // In one register: put together in memory from three it would be waited for.
            let mut light = match (glow, diffuse) {
                (Some(glow), _) => Vec3A::from_array(glow.radiance(doppler, logarithm)),
                (None, Some(diffuse)) => {
                    let colors = colors();
                    if colors.emission == [0.0; 3] {
                        let kept = plain.is_some().then(|| &mut faces.tables[*tables..]);
                        let arrives = |light: usize| reaches(light).then(|| self.arrivals[light].at(number));
                        diffuse.radiance(arrives, [doppler, logarithm], colors.base, kept)
                    } else {
                        shadowed()
                    }
                }
                (None, None) => shadowed(),
            };
            if let Some(world) = job.world
                && job.shading.is_lit(target.body, material)
            {
                let surface = job.shading.surface(target.body, material);
                let vertex = Vertex {
                    target: index,
                    leaf,
                    face: facet.face() as u32,
                    point: facet.point(at()),
                    colors: colors(),
                    surface,
                    gloss: *surface.gloss(),
                    doppler,
                };
                let ordinal = u64::from(self.top) * u64::from(job.lens.width()) + pixel as u64;
                let mut random = Random::new(world.paths.seed, ordinal, sample as u64);
                let more = world.indirect(vertex, &mut random, &mut self.paths);
                light += Vec3A::from_array(more.map(|v| if v.is_finite() { v as f32 } else { 0.0 }));
            }
            let color = &mut rows.color[pixel];
            *color = (Vec3A::from_array(*color) + weight * light).to_array();
            if sample == 0 {
                rows.distance[pixel] = (sights.lines[0][number] / sights.nearness[number]) as f32;
                rows.doppler[pixel] = doppler as f32;
                rows.body[pixel] = target.body as i32;
                rows.face[pixel] = facet.face() as i32;
            }
        }
    }

    /// What of the sky is seen where nothing is in the way.
    #[expect(clippy::too_many_arguments, reason = "one call, from the one place that has all of it")]
    fn see_sky(
        &self,
        job: &Job<'_>,
        number: usize,
        sky: &Sky,
        world_from_observer: &Lorentz<terrell_geodesic::World, Observer>,
        weight: f32,
        centre: bool,
        rows: &mut Rows<'_>,
    ) {
        let (pixel, direction) = (self.sights.pixels[number] as usize, self.sights.direction(number));
        let spread = f64::from(weight.sqrt());
        let sight = |v: DVec3| *world_from_observer * FourVector::seen_from(v.normalize());
        let to = |step: DVec2| {
            let there = job.lens.direction(self.sights.place(number) + step * spread).unwrap_or(direction);
            sight(there).xyz().normalize_or(DVec3::Z)
        };
        let here = sight(direction);
        let (direction, doppler) = (here.xyz().normalize_or(DVec3::Z), 1.0 / here.t.abs());
        let steps = [DVec2::X, DVec2::Y].map(|step| to(step) - direction);
        let light = job.shading.sky(doppler, sky.color(direction, steps));
        let color = &mut rows.color[pixel];
        *color = [0, 1, 2].map(|c| color[c] + weight * light[c]);
        if centre {
            rows.doppler[pixel] = doppler as f32;
        }
    }
}

/// A circle of directions around all lines of sight of a tile.
fn cone(lens: &Lens, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> (DVec3, f64) {
    let direction = |x: f64, y: f64| {
        let at = DVec2::new(f64::from(left) + x, f64::from(top) + y);
        lens.direction(at).map(DVec3::normalize)
    };
    let (width, height) = (f64::from(width), f64::from(height));
    let Some(axis) = direction(0.5 * width, 0.5 * height) else { return (DVec3::Z, std::f64::consts::PI) };
    let mut chord = 0f64;
    // Corners, and the middles of sides that are not straight: what bulges between them is little, in pixels.
    let places: &[f64] =
        if lens.projection() == Projection::Pinhole { &[0.0, 1.0] } else { &[0.0, 0.5, 1.0] };
    for x in places {
        for y in places {
            let Some(d) = direction(x * width, y * height) else { return (DVec3::Z, std::f64::consts::PI) };
            chord = chord.max((d - axis).length());
        }
    }
    // A tile of a picture of few pixels is a large part of the sky; else angle and chord are nearly the same.
    if chord > 0.2 { (DVec3::Z, std::f64::consts::PI) } else { (axis, 1.21 * chord) }
}
