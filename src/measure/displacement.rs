use crate::apparent::{ApparentMesh, WHOLE};
use crate::film::Film;
use crate::relativity::ApparentMap;
use crate::render::SeenBody;
use crate::scene::{Camera, Lens, Mesh, Projection, Scene};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::HashSet;
use std::sync::Arc;

/// How far something is drawn from where it is seen, pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// The greatest.
    pub worst: f64,
    /// Root of the mean square: along edges, of their length in the picture; of pixels, of those there are.
    pub rms: f64,
    /// Pixels of edge that were measured, or pixels.
    pub measured: f64,
}

/// A weighted sum of squares, and the greatest.
#[derive(Clone, Copy, Default)]
struct Sum {
    worst: f64,
    squares: f64,
    weight: f64,
}

impl Sum {
    fn add(&mut self, off: f64, weight: f64) {
        self.worst = self.worst.max(off);
        self.squares += weight * off * off;
        self.weight += weight;
    }

    fn with(self, other: Self) -> Self {
        Self {
            worst: self.worst.max(other.worst),
            squares: self.squares + other.squares,
            weight: self.weight + other.weight,
        }
    }

    fn told(self) -> Displacement {
        let rms = if self.weight > 0.0 { (self.squares / self.weight).sqrt() } else { 0.0 };
        Displacement { worst: self.worst, rms, measured: self.weight }
    }
}

/// How many places of a drawn piece of an edge are measured.
const PLACES: u32 = 7;

/// How far the edges of meshes are drawn from where they are seen: of every side of every triangle that is drawn, the
/// image of its points (the map, then the lens) against the straight pieces it was cut into, as far as they are in the
/// picture, whether or not something hides them.
pub fn edge_displacement(bodies: &[SeenBody], lens: &Lens) -> Displacement {
    let of_body = |(map, mesh, seen): &SeenBody| {
        let mut known = HashSet::new();
        let sides: Vec<Side> = seen.triangles.iter().flat_map(|t| sides_of(mesh, seen, t)).collect();
        let fresh: Vec<Side> = sides.into_iter().filter(|side| known.insert(side.key())).collect();
        fresh.par_iter().map(|side| side.measure(map, lens)).reduce(Sum::default, Sum::with)
    };
    bodies.iter().map(of_body).fold(Sum::default(), Sum::with).told()
}

/// How far points that are drawn would be displaced if they were mapped in f32: rest-frame coordinates rounded, and the
/// map's own arithmetic; all vertices of the apparent meshes that are in the picture.
pub fn f32_displacement(bodies: &[SeenBody], lens: &Lens) -> Displacement {
    let of_body = |(map, _, seen): &SeenBody| {
        let off = |exact: &DVec3| {
            let (at, rounded) = (lens.pixel(*exact)?, lens.pixel(in_f32(map, *exact))?);
            is_inside(lens, at).then(|| at.distance(rounded))
        };
        let offs = seen.vertices.par_iter().filter_map(off);
        let sum = |mut sum: Sum, off| {
            sum.add(off, 1.0);
            sum
        };
        offs.fold(Sum::default, sum).reduce(Sum::default, Sum::with)
    };
    bodies.iter().map(of_body).fold(Sum::default(), Sum::with).told()
}

/// An apparent position as it comes out of the map in f32, of rest-frame coordinates in f32.
pub fn in_f32(map: &ApparentMap, apparent: DVec3) -> DVec3 {
    let (rest, _) = map.unsee(apparent);
    let (seen, ..) = map.see_f32(rest.to_array().map(|c| c as f32));
    DVec3::from_array(seen.map(f64::from))
}

/// A straight piece of a triangle's side: its ends at rest, and where they are drawn.
struct Side {
    rest: [DVec3; 2],
    seen: [DVec3; 2],
}

impl Side {
    /// The same for both triangles it belongs to.
    fn key(&self) -> [[u64; 3]; 2] {
        let bits = self.rest.map(|p| p.to_array().map(f64::to_bits));
        if bits[0] <= bits[1] { bits } else { [bits[1], bits[0]] }
    }

    fn measure(&self, map: &ApparentMap, lens: &Lens) -> Sum {
        let [from, to] = self.rest;
        let exact = |i: u32| map.see(from.lerp(to, f64::from(i) / f64::from(PLACES + 1))).position;
        let mut sum = Sum::default();
        let mut last = lens.pixel(exact(0));
        for place in 1..=PLACES {
            let direction = exact(place);
            let at = lens.pixel(direction);
            if let (Some(at), Some(last)) = (at, last)
                && is_inside(lens, at)
                && let Some(off) = off_chord(lens, self.seen, direction, at)
            {
                sum.add(off, at.distance(last));
            }
            last = at;
        }
        sum
    }
}

fn is_inside(lens: &Lens, at: DVec2) -> bool {
    let size = DVec2::new(lens.width().into(), lens.height().into());
    at.cmpge(DVec2::ZERO).all() && at.cmple(size).all()
}

/// Pixels between what is seen in a direction and the image of a straight piece.
fn off_chord(lens: &Lens, [a, b]: [DVec3; 2], direction: DVec3, at: DVec2) -> Option<f64> {
    let plane = a.cross(b);
    if lens.projection() == Projection::Pinhole {
        // The plane through observer and piece meets the picture in a line.
        let across = (plane.truncate() / lens.focal()).length();
        return (across > 0.0).then(|| (plane.dot(direction) / direction.z).abs() / across);
    }
    let normal = plane.try_normalize()?;
    let nearest = direction - direction.dot(normal) * normal;
    Some(lens.pixel(nearest)?.distance(at))
}

/// The pieces of a triangle's piece that lie on sides of the mesh's triangle.
fn sides_of<'a>(
    mesh: &'a Mesh,
    seen: &'a ApparentMesh,
    triangle: &'a crate::apparent::ApparentTriangle,
) -> impl Iterator<Item = Side> + 'a {
    // f32 keeps barycentric coordinates; what lies on a side has one that is 0 but for their rounding.
    const ON_A_SIDE: f64 = 4.0 * f32::EPSILON as f64;
    let corners = mesh.corners(triangle.face as usize);
    let weights = if triangle.piece == WHOLE {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    } else {
        seen.pieces[triangle.piece as usize]
            .map(|[v, w]| [1.0 - f64::from(v) - f64::from(w), v.into(), w.into()])
    };
    let drawn = triangle.corners.map(|v| seen.vertices[v as usize]);
    (0..3).filter_map(move |i| {
        let j = (i + 1) % 3;
        let opposite =
            (0..3).find(|&c| weights[i][c].abs() < ON_A_SIDE && weights[j][c].abs() < ON_A_SIDE)?;
        let [a, b] = [(opposite + 1) % 3, (opposite + 2) % 3];
        let rest = |at: [f64; 3]| corners[a].lerp(corners[b], at[b].clamp(0.0, 1.0));
        Some(Side { rest: [rest(weights[i]), rest(weights[j])], seen: [drawn[i], drawn[j]] })
    })
}

/// How far the pixels of a picture lie outside of what they show: of every pixel whose line of sight, boosted into the rest
/// frame of the body it shows, misses the triangle it shows, the distance to that triangle's exact image. `measured`
/// counts these pixels. Any method can be asked this, and one that is exact shows none but by rounding.
pub fn beyond_faces(scene: &Scene, camera: &Camera, film: &Film) -> Displacement {
    let bodies: Vec<(ApparentMap, Arc<Mesh>)> = scene
        .bodies
        .iter()
        .map(|body| (ApparentMap::new(&body.motion, &camera.observer), body.mesh_seen(&camera.observer)))
        .collect();
    let width = film.width.max(1) as usize;
    let off = |pixel: usize| {
        let (map, mesh) = bodies.get(usize::try_from(film.body[pixel]).ok()?)?;
        let corners = mesh.corners(usize::try_from(film.face[pixel]).ok()?);
        let at = DVec2::new((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        outside(map, corners, &camera.lens, at)
    };
    let sum = |mut sum: Sum, off| {
        sum.add(off, 1.0);
        sum
    };
    let pixels = (0..film.body.len()).into_par_iter().filter_map(off);
    pixels.fold(Sum::default, sum).reduce(Sum::default, Sum::with).told()
}

/// Pixels from a point of the picture to the image of a triangle (corners at rest) it is not in; none if it is.
fn outside(map: &ApparentMap, corners: [DVec3; 3], lens: &Lens, at: DVec2) -> Option<f64> {
    let v = lens.direction(at)?;
    let v_rest = map.rotate_back(map.rest_sky().boosted_direction(v, v.length()));
    let offsets = corners.map(|corner| map.offset_rest(corner));
    let heights = [0, 1, 2].map(|i| v_rest.dot(offsets[i].cross(offsets[(i + 1) % 3])));
    let is_in = heights.iter().all(|h| *h >= 0.0) || heights.iter().all(|h| *h <= 0.0);
    if is_in {
        return None;
    }
    let to_side = |i: usize| nearest_of_side(map, [corners[i], corners[(i + 1) % 3]], lens, at);
    (0..3).map(to_side).reduce(f64::min)
}

/// The least distance of a side's image from a point of the picture: the best of some places, then thirds around it.
fn nearest_of_side(map: &ApparentMap, [from, to]: [DVec3; 2], lens: &Lens, at: DVec2) -> f64 {
    const COARSE: u32 = 64;
    let off = |t: f64| {
        let seen = lens.pixel(map.see(from.lerp(to, t)).position);
        seen.map_or(f64::INFINITY, |seen| seen.distance(at))
    };
    let places = (0..=COARSE).map(|i| f64::from(i) / f64::from(COARSE));
    let best = places.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(0.0);
    let step = 1.0 / f64::from(COARSE);
    let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(1.0));
    while high - low > 1e-13 {
        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if off(a) < off(b) {
            high = b
        } else {
            low = a
        }
        if high - low <= f64::EPSILON * high {
            break;
        }
    }
    off(0.5 * (low + high)).min(off(best))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{Options, cut};
    use crate::scene::builtin_scene;

    fn seen(scene: &Scene, camera: &Camera, tolerance: Option<f64>) -> Vec<SeenBody> {
        let options = Options { tolerance: tolerance.unwrap_or(0.25), ..Options::default() };
        let mut bodies = cut(scene, camera, &options, |_| ()).unwrap();
        if tolerance.is_none() {
            bodies.iter_mut().for_each(|(map, mesh, seen)| *seen = ApparentMesh::linear(mesh, map));
        }
        bodies
    }

    #[test]
    fn displacement_keeps_to_the_tolerance_and_falls_with_it() {
        for name in ["cube", "gate"] {
            let mut scene = builtin_scene(name).unwrap().scene();
            scene.view.size = [320, 180];
            let camera = scene.camera().unwrap();
            let of = |tolerance| edge_displacement(&seen(&scene, &camera, tolerance), &camera.lens);
            let uncut = of(None);
            let mut last = uncut;
            for tolerance in [1.0, 0.25, 0.0625] {
                let found = of(Some(tolerance));
                // The tolerance is a bound for the outline of every edge in the picture.
                assert!(found.worst <= tolerance, "{name} {tolerance}: {found:?}");
                assert!(
                    found.worst < last.worst && found.rms < last.rms && found.rms < found.worst,
                    "{name}: {found:?}"
                );
                last = found;
            }
            assert!(uncut.worst > 1.0 && uncut.measured > 100.0, "{name}: {uncut:?}");
        }
    }

    /// A pixel that shows a face whose image is so many pixels away.
    #[test]
    fn a_pixel_beyond_its_face_is_found() {
        let mut scene = builtin_scene("cube").unwrap().scene();
        scene.view.size = [320, 180];
        let camera = scene.camera().unwrap();
        let (film, _) =
            crate::render::render(&scene, &camera, &crate::render::Options::default(), |_| ()).unwrap();
        let exact = beyond_faces(&scene, &camera, &film);
        assert!(exact.worst < 1e-9, "{exact:?}");
        let row = 90 * 320;
        let first = (0..320).find(|x| film.body[row + x] >= 0).unwrap();
        let mut moved = film.clone();
        for i in 1..=5 {
            moved.body[row + first - i] = film.body[row + first];
            moved.face[row + first - i] = film.face[row + first];
        }
        let found = beyond_faces(&scene, &camera, &moved);
        // Five pixels in a row beyond an outline that is no more than half a right angle from upright.
        assert!(
            found.measured == exact.measured + 5.0 && found.worst > 2.8 && found.worst <= 5.0,
            "{found:?}"
        );
    }

    #[test]
    fn f32_is_felt_more_the_faster_the_body() {
        let mut scene = builtin_scene("cube").unwrap().scene();
        scene.view.size = [640, 360];
        let camera = scene.camera().unwrap();
        let off = f32_displacement(&seen(&scene, &camera, Some(0.25)), &camera.lens);
        // Some thousand pixels a radian, to some 10⁻⁷ of it.
        assert!(off.worst > 1e-6 && off.worst < 1e-2, "{off:?}");
    }
}
