//! Light that surfaces throw on each other: paths followed back in time from surface to surface.

use super::emitters::{Emitters, Shares};
use super::random::Random;
use super::stage::{Stage, Way};
use super::tree::Part;
use crate::light::gloss::{self, Chosen};
use crate::light::{Point, SeenShading, SurfaceLight, Trail};
use crate::scene::{Colors, Gloss, Sky};
use glam::DVec3;
use terrell_geodesic::{FourVector, Lorentz, Rest};

/// How paths are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Paths {
    /// From how many surfaces one after the other light comes on its way from a source; 0 for none but the one that is
    /// seen, which lights light directly.
    pub bounces: u32,
    /// Which chance.
    pub seed: u64,
}

/// A point of a surface on a path.
#[derive(Clone, Copy)]
pub(super) struct Vertex<'a> {
    pub target: usize,
    pub leaf: u32,
    pub face: u32,
    pub point: Point,
    pub colors: Colors,
    pub surface: SurfaceLight<'a>,
    /// How it reflects.
    pub gloss: Gloss,
    /// From there to the observer.
    pub doppler: f64,
}

/// What paths go through.
#[derive(Clone, Copy)]
pub(super) struct World<'a> {
    pub stage: &'a Stage,
    pub shading: &'a SeenShading<'a>,
    pub emitters: &'a Emitters,
    pub paths: Paths,
    pub sky: Option<&'a SkyAround<'a>>,
}

/// The sky, as paths end at it.
pub(super) struct SkyAround<'a> {
    pub sky: &'a Sky,
    /// From the rest frame of every target.
    pub world_from_rest: Vec<Lorentz<terrell_geodesic::World, Rest>>,
}

/// How far beside each other what is seen of the sky is averaged from surfaces that are no mirrors, radians: single stars
/// would be found by chance only.
const BLUR: f64 = 0.1;

/// Used again from path to path.
#[derive(Default)]
pub(super) struct Scratch {
    pub stack: Vec<Part>,
    pub rays: u64,
    shares: Shares,
}

/// Rays end so much before the surface they are to reach.
const BEFORE: f64 = 1e-9;

/// As smooth as this at most are surfaces that are seen from others that are no mirrors: light a mirror throws onto a wall is
/// found by chance only if it is spread a little (A. Kaplanyan and C. Dachsbacher 2013).
const CAUSTIC: f32 = 0.5;

/// What is left of light that is not followed any further.
const FAINT: f64 = 1e-6;

impl<'a> World<'a> {
    /// Linear sRGB of what reaches a surface from others, and is reflected to the observer; of one path.
    pub fn indirect(&self, first: Vertex<'a>, random: &mut Random, scratch: &mut Scratch) -> [f64; 3] {
        let mut trail = Trail::new(self.shading.coloring(), random.unit());
        let mut sum = [0.0; 3];
        let mut add = |light: [f64; 3], by: f64| sum = [0, 1, 2].map(|c| sum[c] + light[c] * by);
        let (mut here, mut matt) = (first, false);
        for _ in 0..self.paths.bounces {
            let (point, gloss) = (here.point, &here.gloss);
            let base = here.colors.base;
            self.emitters.seen_from(self.stage, here.target, point.event(), &mut scratch.shares);
            self.add_emitter(&here, &mut trail, random, scratch, &mut add);
            let by = [random.unit(), random.unit(), random.unit()];
            let Some(chosen) = gloss::choose(base, gloss, point.normal, point.to_eye, by) else { break };
            trail.meets(here.doppler, chosen.factors, here.surface.beyond());
            if trail.strength() < FAINT {
                break;
            }
            matt |= chosen.density.is_some();
            let Some(next) = self.meet(&here, &chosen, matt, scratch) else {
                // Light from everywhere.
                for light in 0..self.shading.lights() {
                    let body = self.stage.targets[here.target].body;
                    if let Some(light) = self.shading.arriving(body, light, &point, Some(chosen.to_light)) {
                        add(trail.seen(&light.source(here.doppler)), 1.0);
                    }
                }
                self.add_sky(&here, &chosen, matt, &trail, &mut add);
                break;
            };
            self.add_own(&here, &next, &chosen, &trail, &scratch.shares, &mut add);
            if !next.surface.is_lit() {
                break;
            }
            self.add_lights(&next, &mut trail, scratch, &mut add);
            here = next;
        }
        sum
    }

    /// The surface's own light at the end of a ray whose direction was chosen; shared with what
    /// [`add_emitter`](Self::add_emitter) gives by which of the two would have found it more often.
    fn add_own(
        &self,
        from: &Vertex<'a>,
        at: &Vertex<'a>,
        chosen: &Chosen,
        trail: &Trail,
        shares: &Shares,
        add: &mut impl FnMut([f64; 3], f64),
    ) {
        let cosine = at.point.normal.dot(at.point.to_eye);
        let Some(source) = at.surface.source(at.colors, cosine, at.doppler) else { return };
        let share = chosen.density.map_or(1.0, |density| {
            let target = &self.stage.targets[at.target];
            let [a, b, c] = target.tree.leaf(at.leaf).corners;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let way = at.point.event() - self.stage.between(at.target, from.target) * from.point.event();
            let other = self.emitters.density(&self.stage.targets, shares, at.target, at.leaf)
                * per_solid_angle(way.xyz(), normal, from.doppler / at.doppler);
            power_share(density, other)
        });
        add(trail.seen(&source), share);
    }

    /// The sky's, where a ray leaves.
    fn add_sky(
        &self,
        from: &Vertex<'a>,
        chosen: &Chosen,
        matt: bool,
        trail: &Trail,
        add: &mut impl FnMut([f64; 3], f64),
    ) {
        let Some(around) = self.sky else { return };
        let back = around.world_from_rest[from.target] * FourVector::seen_from(chosen.to_light);
        let direction = back.xyz().normalize_or(DVec3::Z);
        let blur = if matt { BLUR } else { 0.0 };
        let (right, down) = direction.any_orthonormal_pair();
        let color = around.sky.color(direction, [right * blur, down * blur]);
        if let Some(source) = self.shading.sky_source(color, from.doppler / -back.t) {
            add(trail.seen(&source), 1.0);
        }
    }

    /// Light of a point that shines, chosen by chance among all.
    fn add_emitter(
        &self,
        at: &Vertex<'a>,
        trail: &mut Trail,
        random: &mut Random,
        scratch: &mut Scratch,
        add: &mut impl FnMut([f64; 3], f64),
    ) {
        let Some(spot) = self.emitters.choose(&self.stage.targets, &scratch.shares, random) else { return };
        let target = &self.stage.targets[spot.target];
        let leaf = target.tree.leaf(spot.leaf);
        if spot.target == at.target && leaf.face == at.face {
            return;
        }
        // From the surface's event to that of the light's emission, which was as long ago as it is far away.
        let map = self.stage.between(spot.target, at.target);
        let event = map * at.point.event();
        let way = target.map.offset_rest(spot.x_rest) - event.xyz();
        let back_there = FourVector::<Rest>::from_parts(-way.length(), way);
        let back = self.stage.between(at.target, spot.target) * back_there;
        let to_light = back.xyz().normalize_or_zero();
        // ν here over ν there.
        let doppler = -back.t / way.length();
        let (base, gloss) = (at.colors.base, &at.gloss);
        let factors = gloss::scattered(base, gloss, at.point.normal, to_light, at.point.to_eye);
        if factors == [0.0; 3] || !(doppler > 0.0 && doppler.is_finite()) {
            return;
        }
        let [a, b, c] = leaf.corners;
        let facing = (b - a).cross(c - a);
        if leaf.one_sided && facing.dot(way) > 0.0 {
            return;
        }
        let density = self.emitters.density(&self.stage.targets, &scratch.shares, spot.target, spot.leaf)
            * per_solid_angle(way, facing.normalize_or_zero(), 1.0 / doppler);
        let other = gloss::density(base, gloss, at.point.normal, to_light, at.point.to_eye);
        if !(density > 0.0 && density.is_finite()) {
            return;
        }
        if !self.is_free(at, back, true, scratch) {
            return;
        }
        let facet = target.facet(spot.leaf);
        let place = target.map.offset_rest(spot.x_rest);
        let point =
            Point::seen_from(event + back_there, -way.normalize_or_zero(), facing, facet.normal_at(place));
        let surface = self.shading.surface(target.body, target.mesh.material_index(facet.face()));
        let colors = facet.colors(place, || [way; 3]);
        let Some(source) = surface.source(colors, point.normal.dot(point.to_eye), at.doppler * doppler)
        else {
            return;
        };
        let share = power_share(density, other);
        trail.meets(at.doppler, factors.map(|f| f / density), at.surface.beyond());
        add(trail.seen(&source), share);
        trail.leave();
    }

    /// Light of all lights that are somewhere.
    fn add_lights(
        &self,
        at: &Vertex<'a>,
        trail: &mut Trail,
        scratch: &mut Scratch,
        add: &mut impl FnMut([f64; 3], f64),
    ) {
        let body = self.stage.targets[at.target].body;
        for light in 0..self.shading.lights() {
            let Some(approach) = self.shading.approach(body, light, &at.point) else { continue };
            let Some(lighting) = self.shading.arriving(body, light, &at.point, None) else { continue };
            let (base, gloss) = (at.colors.base, &at.gloss);
            let factors = gloss::reflected(base, gloss, at.point.normal, lighting.to_light, at.point.to_eye);
            if factors == [0.0; 3] || !self.is_free(at, approach.back, approach.ends, scratch) {
                continue;
            }
            trail.meets(at.doppler, factors, at.surface.beyond());
            add(trail.seen(&lighting.source(at.doppler)), 1.0);
            trail.leave();
        }
    }

    /// Whether nothing stands in a way from a point, which ends where the vector does or nowhere.
    fn is_free(&self, at: &Vertex<'a>, back: FourVector<Rest>, ends: bool, scratch: &mut Scratch) -> bool {
        scratch.rays += 1;
        let far = if ends { 1.0 - BEFORE } else { f64::INFINITY };
        let way = Way { from: at.target, face: at.face, event: at.point.event(), back, far };
        let stack = &mut scratch.stack;
        let mut targets = self.stage.targets.iter().enumerate();
        !targets.any(|(index, target)| self.stage.ray(&way, index, target).is_blocked(&target.tree, stack))
    }

    /// The nearest surface in a direction; `matt` if the path has met one that is no mirror.
    fn meet(
        &self,
        from: &Vertex<'a>,
        chosen: &Chosen,
        matt: bool,
        scratch: &mut Scratch,
    ) -> Option<Vertex<'a>> {
        scratch.rays += 1;
        let back = FourVector::seen_from(chosen.to_light);
        let event = from.point.event();
        let mut way = Way { from: from.target, face: from.face, event, back, far: f64::INFINITY };
        let mut nearest = None;
        for (index, target) in self.stage.targets.iter().enumerate() {
            let ray = self.stage.ray(&way, index, target);
            if let Some(hit) = ray.nearest(&target.tree, &mut scratch.stack) {
                (way.far, nearest) = (hit.at, Some((index, hit)));
            }
        }
        let (index, hit) = nearest?;
        let target = &self.stage.targets[index];
        let map = self.stage.between(index, from.target);
        let back = map * back;
        let event = map * event + back * hit.at;
        let facet = target.facet(hit.leaf);
        let (at, to_eye) = (event.xyz(), -back.xyz().normalize_or(DVec3::Z));
        let surface = self.shading.surface(target.body, target.mesh.material_index(facet.face()));
        let gloss = *surface.gloss();
        let roughness = if matt { gloss.roughness.max(CAUSTIC) } else { gloss.roughness };
        Some(Vertex {
            target: index,
            leaf: hit.leaf,
            face: facet.face() as u32,
            point: Point::seen_from(event, to_eye, facet.normal(), facet.normal_at(at)),
            colors: facet.colors(at, || [back.xyz(); 3]),
            surface,
            gloss: Gloss { roughness, ..gloss },
            // ν of K is 1 where it comes from.
            doppler: from.doppler / -back.t,
        })
    }
}

/// The share of one of two ways to choose a direction, by their densities (E. Veach 1997, the power heuristic).
fn power_share(density: f64, other: f64) -> f64 {
    density * density / (density * density + other * other)
}

/// Area at rest in the frame of what shines over solid angle where it is seen from: r²/cos θ, and D² for aberration.
/// `doppler` is ν there over ν here.
fn per_solid_angle(way: DVec3, normal: DVec3, doppler: f64) -> f64 {
    let square = way.length_squared();
    let cosine = (way.dot(normal)).abs() / square.sqrt();
    // Light that is seen at D = ν here/ν there fills 1/D² of the angle it left in.
    square / cosine.max(1e-12) / (doppler * doppler)
}
