use super::SeenShading;
use super::incidence::{Incidence, NearLight};
use glam::DVec3;
use terrell_geodesic::{FourVector, Rest};

/// The most points at a time.
pub(crate) const POINTS: usize = 64;

/// Four-vectors side by side, t first: what the processor works out several at a time.
pub(crate) type Vectors = [[f64; POINTS]; 4];

/// Points of one body's surface that are seen, all in its rest frame.
#[repr(align(64))]
pub(crate) struct Points {
    /// Which there are: a bit for each. What the others are does not matter.
    pub mask: u64,
    /// Numbers of the triangles they lie on.
    pub faces: [u32; POINTS],
    /// From the observer's event to theirs.
    pub events: Vectors,
    /// On the side that is seen, of any length.
    pub(super) normals: [[f64; POINTS]; 3],
}

/// Ways from [`Points`] back to one light.
#[repr(align(64))]
pub(crate) struct Ways {
    /// Null vectors into the past, as [`Approach::back`](super::Approach::back); where nothing comes from the light, any.
    pub backs: Vectors,
    /// Where something does: a bit for each.
    pub open: u64,
    /// Where they end, in units of the vector.
    pub far: f64,
    /// ν at the surface over ν of the light; 1 where nothing comes from it.
    pub(super) dopplers: [f64; POINTS],
    /// Irradiance, were there no shift, of a surface that faces the light; 0 where nothing comes from it.
    pub(super) irradiances: [f64; POINTS],
}

impl Default for Points {
    fn default() -> Self {
        let (faces, normals) = ([0; POINTS], [[0.0; POINTS]; 3]);
        Self { mask: 0, faces, events: [[0.0; POINTS]; 4], normals }
    }
}

impl Default for Ways {
    fn default() -> Self {
        let none = [0.0; POINTS];
        Self { backs: [none; 4], open: 0, far: f64::INFINITY, dopplers: [1.0; POINTS], irradiances: none }
    }
}

impl Points {
    /// One more, at the event that is known of it, with the normal there: of any length, on the side that is seen.
    #[inline]
    pub fn add(&mut self, i: usize, face: usize, normal: DVec3) {
        self.mask |= 1 << i;
        self.faces[i] = face as u32;
        for k in 0..3 {
            self.normals[k][i] = normal[k];
        }
    }

    /// The normal of one of them, of any length.
    pub fn normal(&self, i: usize) -> DVec3 {
        DVec3::from_array(self.normals.each_ref().map(|c| c[i]))
    }

    /// From the observer's event to that of one of them.
    pub fn event(&self, i: usize) -> FourVector<Rest> {
        vector(&self.events, i)
    }
}

/// One of them.
pub(crate) fn vector(of: &Vectors, i: usize) -> FourVector<Rest> {
    FourVector::new(of[0][i], of[1][i], of[2][i], of[3][i])
}

/// A bit for each that holds.
#[inline(always)]
pub(crate) fn bits(all: &[bool; POINTS]) -> u64 {
    let mut bits = 0;
    for (eight, eighth) in all.as_chunks::<8>().0.iter().zip(0..) {
        // Bytes of 1 and 0, the first the lowest: each is brought into the highest byte, to a place of its own.
        let bytes = u64::from_le_bytes(eight.map(u8::from));
        bits |= (bytes.wrapping_mul(0x0102_0408_1020_4080) >> 56) << (8 * eighth);
    }
    bits
}

/// The numbers of the bits that are set.
#[inline]
pub(crate) fn numbers(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let number = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (number < POINTS).then_some(number)
    })
}

/// A component of what a map, by that row of it, makes of vectors.
#[inline(always)]
pub(crate) fn component(row: [f64; 4], of: &Vectors) -> [f64; POINTS] {
    let mut to = [0.0; POINTS];
    for (i, to) in to.iter_mut().enumerate() {
        *to = row[0] * of[0][i] + row[1] * of[1][i] + row[2] * of[2][i] + row[3] * of[3][i];
    }
    to
}

impl SeenShading<'_> {
    /// Ways from points of a body to a light, as [`approach`](Self::approach) has them one by one; with AVX2 if `vectors`
    /// and there is such.
    pub(crate) fn ways(&self, body: usize, light: usize, points: &Points, ways: &mut Ways, vectors: bool) {
        ways.open = 0;
        match self.incidence(body, light) {
            Incidence::Distant { to_light, doppler } => {
                ways.far = f64::INFINITY;
                ways.dopplers.fill(*doppler);
                ways.irradiances.fill(self.strength(light));
                let back = FourVector::<Rest>::seen_from(*to_light);
                let components = [back.t, to_light.x, to_light.y, to_light.z];
                for (to, component) in ways.backs.iter_mut().zip(components) {
                    to.fill(component);
                }
                ways.keep_facing(points, &[true; POINTS]);
            }
            Incidence::Near => {
                ways.far = 1.0;
                let strength = self.strength(light);
                match self.near(body, light) {
                    Some(near) if strength > 0.0 => near.ways(strength, points, ways, vectors),
                    _ => (ways.dopplers, ways.irradiances) = ([1.0; POINTS], [0.0; POINTS]),
                }
            }
            Incidence::Ambient { .. } => {}
        }
    }
}

impl Ways {
    /// Opens those that come to the side of the surface that is seen, of those that are `possible`.
    #[inline(always)]
    fn keep_facing(&mut self, points: &Points, possible: &[bool; POINTS]) {
        let mut facing = [false; POINTS];
        let ([_, x, y, z], [a, b, c]) = (&self.backs, &points.normals);
        for (i, facing) in facing.iter_mut().enumerate() {
            *facing = possible[i] & (a[i] * x[i] + b[i] * y[i] + c[i] * z[i] > 0.0);
        }
        self.open = points.mask & bits(&facing);
    }
}

impl NearLight {
    fn ways(&self, strength: f64, points: &Points, ways: &mut Ways, vectors: bool) {
        #[cfg(target_arch = "x86_64")]
        if vectors && crate::processor::has_avx2() {
            // SAFETY: the processor has both.
            unsafe { self.ways_avx2(strength, points, ways) };
            return;
        }
        let _ = vectors;
        self.ways_with(strength, points, ways);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn ways_avx2(&self, strength: f64, points: &Points, ways: &mut Ways) {
        self.ways_with(strength, points, ways);
    }

    /// As [`at`](Self::at), all together.
    #[inline(always)]
    fn ways_with(&self, strength: f64, points: &Points, ways: &mut Ways) {
        // Loops of plain arithmetic, which compilers make vectors of.
        let rows = self.lamp_from_rest().rows();
        // From the lamp, in its frame, and how far.
        let mut way = [[0.0; POINTS]; 4];
        for k in 1..4 {
            way[k] = component(rows[k], &points.events);
            for component in &mut way[k] {
                *component += self.observer()[k - 1];
            }
        }
        let [distance, x, y, z] = &mut way;
        for (i, distance) in distance.iter_mut().enumerate() {
            *distance = (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt();
        }
        for (back, row) in ways.backs.iter_mut().zip(self.rest_from_lamp().rows()) {
            *back = component([-row[0], -row[1], -row[2], -row[3]], &way);
        }
        let mut possible = [false; POINTS];
        for (i, possible) in possible.iter_mut().enumerate() {
            let doppler = -ways.backs[0][i] / way[0][i];
            *possible = (doppler > 0.0) & (doppler < f64::INFINITY);
            ways.dopplers[i] = if *possible { doppler } else { 1.0 };
            ways.irradiances[i] = if *possible { strength / (way[0][i] * way[0][i]) } else { 0.0 };
        }
        if let Some((axis, [bright, dark])) = self.cone() {
            let inverse = 1.0 / (bright - dark).max(1e-6);
            for (i, possible) in possible.iter_mut().enumerate() {
                let along = axis.x * way[1][i] + axis.y * way[2][i] + axis.z * way[3][i];
                *possible &= along > dark * way[0][i];
                let edge = ((along / way[0][i] - dark) * inverse).clamp(0.0, 1.0);
                ways.irradiances[i] *= edge * edge;
            }
        }
        ways.keep_facing(points, &possible);
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::{Facet, Shading};
    use super::*;
    use crate::color::Coloring;
    use crate::relativity::Motion;
    use crate::scene::{Body, Light, LightKind, Mesh, Scene, View, shapes};
    use crate::spectrum::Spectrum;
    use std::ops::Range;
    use terrell_geodesic::{Celerity, Event, Tetrad};

    /// A mesh in motion in the light of two lamps, a spot, light from infinity and from everywhere, at these speeds.
    pub fn lit(mesh: Mesh, speeds: [f64; 5]) -> Scene {
        let motion = |v: f64| Motion {
            celerity: Celerity::new(DVec3::new(v, 0.2 * v, 0.0)).unwrap(),
            origin: Event::new(-1.0, 0.5, 4.0, 0.2),
        };
        let mut scene = Scene::new("s", vec![Body::new("ball", mesh, motion(1.0))], View::default());
        let position = DVec3::new(1.0, -2.0, 0.5);
        let kinds = [
            LightKind::Point { position },
            LightKind::Point { position },
            LightKind::Spot { position, direction: DVec3::Y, cone: [1.0, 2.5] },
            LightKind::Distant { direction: DVec3::new(0.6, 0.8, 0.0) },
            LightKind::Ambient,
        ];
        scene.lights.extend(kinds.into_iter().zip(speeds).map(|(kind, speed)| Light {
            name: "l".into(),
            kind,
            color: [0.9, 1.0, 0.8],
            spectrum: Spectrum::default(),
            strength: 2.0,
            motion: motion(speed),
        }));
        scene
    }

    /// Triangles from where they are seen, and a point of each.
    pub fn facets(mesh: &Mesh, of: Range<usize>) -> Vec<(Facet<'_>, DVec3)> {
        of.map(|face| {
            let corners = mesh.corners(face).map(|c| c + DVec3::new(0.3, 5.0, 0.1));
            let at = 0.2 * corners[0] + 0.5 * corners[1] + 0.3 * corners[2];
            (Facet::new(mesh, face, corners), at)
        })
        .collect()
    }

    /// Adds a point of a triangle, its normal so many times as long.
    pub fn place(points: &mut Points, i: usize, facet: &Facet<'_>, at: DVec3, length: f64) {
        points.add(i, facet.face(), length * facet.normal_seen(at));
        let event = facet.point(at).event();
        points.events[0][i] = event.t;
        (0..3).for_each(|k| points.events[k + 1][i] = event.xyz()[k]);
    }

    /// All together, with and without vectors, against one by one; lamps and bodies in motion, spots, light from infinity.
    #[test]
    fn ways_are_as_one_by_one() {
        let scene = lit(shapes::sphere(3), [0.0, 3.0, -0.5, 2.0, 0.0]);
        let observer = Tetrad::of_world(Event::origin());
        let shading = Shading::new(&scene, [&observer], Coloring::Geometry).unwrap();
        let seen = shading.seen_by(&observer);
        let mesh = &scene.bodies[0].mesh;
        let (mut points, mut ways) = (Points::default(), Ways::default());
        let mut all = [0u32; 5];
        for first in (0..mesh.triangles.len()).step_by(POINTS) {
            points.mask = 0;
            let facets = facets(mesh, first..(first + POINTS).min(mesh.triangles.len()));
            for (i, (facet, at)) in facets.iter().enumerate() {
                place(&mut points, i, facet, *at, 1.0);
            }
            for (light, vectors) in (0..5).flat_map(|l| [(l, false), (l, true)]) {
                seen.ways(0, light, &points, &mut ways, vectors);
                for (i, (facet, at)) in facets.iter().enumerate() {
                    let approach = seen.approach(0, light, &facet.point(*at));
                    assert_eq!(ways.open >> i & 1 == 1, approach.is_some());
                    let Some(approach) = approach else { continue };
                    assert_eq!(approach.ends, ways.far == 1.0);
                    let off = vector(&ways.backs, i) - approach.back;
                    assert!(off.xyz().length().max(off.t.abs()) < 1e-14 * approach.back.t.abs());
                    all[light] += 1;
                }
            }
        }
        assert!(all[..4].iter().all(|n| *n > 10) && all[4] == 0, "{all:?}");
    }
}
