//! Polygon shading: apparent triangles to the film, by a z-buffer.
//!
//! Triangles are tested by the planes through the observer and their edges, in homogeneous form: a triangle
//! that crosses the camera plane or surrounds the camera needs no clipping, and under a fisheye or a panorama
//! its edges are as straight in space as under a pinhole. Depth is apparent depth of all bodies in the one
//! camera frame, whatever their velocities. Work is cut into bands of rows, drawn on all cores.
//!
//! `gpu`, a feature, draws the same on a graphics processor, and exact shading, too.

mod band;
mod bins;
mod bounds;
#[cfg(feature = "gpu")]
pub mod gpu;
mod order;
mod painter;
mod polygon;
mod triangle;

use crate::apparent::ApparentMesh;
use crate::film::{Film, Rows, Samples};
use crate::light::SeenShading;
use crate::relativity::ApparentMap;
use crate::scene::{Lens, Mesh};
use band::Band;
pub(crate) use bounds::{Bounder, Hull, Place, Rect, SLACK_PX, beside, most_beside};
pub use painter::{MOST_PAINTED, TooManyToPaint, paint};
use rayon::prelude::*;

/// A body ready to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Drawable<'a> {
    /// Index of the body in the scene, and in the shading.
    pub body: usize,
    /// The mesh at rest, for its colours.
    pub mesh: &'a Mesh,
    /// The map it is seen through, for its Doppler factor.
    pub map: &'a ApparentMap,
    /// The mesh as it is seen.
    pub seen: &'a ApparentMesh,
}

/// Rows drawn as one task.
const BAND: u32 = 16;

/// Draws apparent meshes on a new film; `shading` is for the same observer.
pub fn shade(bodies: &[Drawable<'_>], lens: &Lens, samples: &Samples, shading: &SeenShading<'_>) -> Film {
    let mut film = Film::new(lens.width(), lens.height());
    draw(bodies, lens, samples, shading, &mut film);
    film
}

/// As [`shade`], on a film used before: for animations, since new memory costs as much as a simple picture.
pub fn shade_again(
    bodies: &[Drawable<'_>],
    lens: &Lens,
    samples: &Samples,
    shading: &SeenShading<'_>,
    film: &mut Film,
) {
    film.resize(lens.width(), lens.height());
    draw(bodies, lens, samples, shading, film);
}

fn draw(bodies: &[Drawable<'_>], lens: &Lens, samples: &Samples, shading: &SeenShading<'_>, film: &mut Film) {
    let bins = bins::Bins::new(bodies, lens, samples);
    each_band(film, |band, top, mut out| {
        out.clear();
        band.draw(bodies, &bins, lens, samples, shading, top, out);
    });
}

/// Has the film's rows filled, a band of them a task; with the number of its first row.
fn each_band(film: &mut Film, fill: impl Fn(&mut Band, u32, Rows<'_>) + Sync) {
    film.bands(BAND)
        .enumerate()
        .for_each_init(Band::default, |band, (index, rows)| fill(band, index as u32 * BAND, rows));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Coloring;
    use crate::film::NOTHING;
    use crate::light::Shading;
    use crate::relativity::Motion;
    use crate::scene::{Body, Paint, Projection, Scene, View};
    use glam::{DVec2, DVec3};
    use proptest::prelude::*;
    use terrell_geodesic::{Event, Tetrad};

    fn lens(which: usize) -> Lens {
        let (projection, fov) = [
            (Projection::Pinhole, 60.0),
            (Projection::Pinhole, 150.0),
            (Projection::Fisheye, 180.0),
            (Projection::Fisheye, 360.0),
            (Projection::Panorama, 360.0),
        ][which];
        Lens::new(projection, fov, 61, 43).unwrap()
    }

    /// A body at rest, in the camera's axes: what is drawn is what is there.
    fn draw_at_rest(mesh: &Mesh, lens: &Lens, samples: u32) -> Film {
        let observer = Tetrad::of_world(Event::origin());
        let map = ApparentMap::new(&Motion::at_rest(DVec3::ZERO), &observer);
        let seen = ApparentMesh::linear(mesh, &map);
        let body = Body::new("m", mesh.clone(), Motion::at_rest(DVec3::ZERO));
        let scene = Scene::new("s", vec![body; 4], View::default());
        let shading = Shading::within(&scene, 0.0, Coloring::Geometry).unwrap();
        let drawable = Drawable { body: 3, mesh, map: &map, seen: &seen };
        shade(&[drawable], lens, &Samples::new(samples), &shading.seen_by(&observer))
    }

    /// Every pixel against every triangle (Möller and Trumbore 1997), with how surely it hits or misses.
    fn cast(mesh: &Mesh, direction: DVec3) -> (Option<(f64, usize)>, bool) {
        let mut nearest: Option<(f64, usize)> = None;
        let mut clear = true;
        for t in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(t);
            let (ab, ac) = (b - a, c - a);
            let p = direction.cross(ac);
            let determinant = ab.dot(p);
            let scale = ab.length() * ac.length() * direction.length();
            if determinant.abs() < 1e-9 * scale {
                clear = false;
                continue;
            }
            let u = -a.dot(p) / determinant;
            let q = (-a).cross(ab);
            let v = direction.dot(q) / determinant;
            let at = ac.dot(q) / determinant;
            let margin = [u, v, 1.0 - u - v].into_iter().fold(f64::INFINITY, f64::min);
            clear &= margin.abs() > 1e-9 && at.abs() > 1e-9;
            if margin > 0.0 && at > 0.0 {
                if let Some((other, _)) = nearest {
                    clear &= (other / at - 1.0).abs() > 1e-5;
                }
                if nearest.is_none_or(|(other, _)| at < other) {
                    nearest = Some((at, t));
                }
            }
        }
        (nearest, clear)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// Triangles anywhere (in front, behind, across the camera plane, around the camera, over the poles
        /// and the seam) cover just the pixels whose rays hit them.
        #[test]
        fn what_is_drawn_is_what_rays_hit(
            points in prop::collection::vec(prop::array::uniform3(-3.0..3.0f64), 3..12),
            which in 0usize..5,
        ) {
            let vertices: Vec<DVec3> = points.into_iter().map(DVec3::from_array).collect();
            let triangles = (2..vertices.len() as u32).map(|i| [i - 2, i - 1, i]).collect();
            let mesh = Mesh::new(&vertices, triangles);
            let lens = lens(which);
            let film = draw_at_rest(&mesh, &lens, 1);
            for i in 0..film.body.len() {
                let pixel = DVec2::new((i % 61) as f64 + 0.5, (i / 61) as f64 + 0.5);
                let Some(direction) = lens.direction(pixel) else {
                    prop_assert_eq!(film.body[i], NOTHING);
                    continue;
                };
                let (hit, clear) = cast(&mesh, direction);
                if clear {
                    prop_assert_eq!(film.face[i], hit.map_or(NOTHING, |(_, t)| t as i32), "{}", pixel);
                    if let Some((at, _)) = hit {
                        let distance = at * direction.length();
                        prop_assert!((f64::from(film.distance[i]) / distance - 1.0).abs() < 1e-5);
                        prop_assert_eq!(film.body[i], 3);
                    }
                }
            }
        }
    }

    /// Cut any way into triangles, a surface around the camera covers every pixel once: no cracks, and (in
    /// two colours by samples) nothing twice.
    #[test]
    fn shared_edges_neither_leak_nor_overlap() {
        let mut ball = crate::scene::shapes::sphere(3);
        // Vertices on the very directions of pixels, too.
        for i in 0..ball.vertex_count() {
            let v = (ball.vertex(i as u32) * 8.0).round() / 8.0;
            (ball.x[i], ball.y[i], ball.z[i]) = (v.x, v.y, v.z);
        }
        for which in 0..5 {
            for (width, height) in [(64, 64), (65, 33)] {
                let lens = self::lens(which);
                let fov = [60.0, 150.0, 180.0, 360.0, 360.0][which];
                let lens = Lens::new(lens.projection(), fov, width, height).unwrap();
                let film = draw_at_rest(&ball, &lens, 1);
                let seen = (0..film.body.len()).filter(|&i| {
                    let at = DVec2::new((i as u32 % width) as f64 + 0.5, (i as u32 / width) as f64 + 0.5);
                    lens.direction(at).is_some()
                });
                for i in seen {
                    assert_ne!(
                        film.body[i],
                        NOTHING,
                        "{which}: a leak at {} {}",
                        i as u32 % width,
                        i as u32 / width
                    );
                }
            }
        }
    }

    #[test]
    fn the_middle_sample_is_the_centre_and_samples_average() {
        let samples = Samples::new(64);
        assert_eq!(samples.offsets()[0], [0.5, 0.5]);
        assert!(samples.offsets().iter().flatten().all(|c| (0.0..1.0).contains(c)));
        // Half the sky white: edge pixels are grey by what they cover.
        let mut mesh = Mesh::new(
            &[DVec3::new(0.013, -50.0, 1.0), DVec3::new(50.0, 0.0, 1.0), DVec3::new(0.013, 50.0, 1.0)],
            vec![[0, 1, 2]],
        );
        mesh.paint = Paint::Uniform([1.0; 3]);
        let lens = lens(0);
        let film = draw_at_rest(&mesh, &lens, 256);
        let edge = 30.5 + lens.focal().x * 0.013;
        let at = 20 * 61 + edge.floor() as usize;
        let covered = 1.0 - edge.fract();
        assert!((f64::from(film.color[at][0]) - covered).abs() < 0.02, "{:?} {covered}", film.color[at]);
        assert_eq!(film.color[at + 2], [1.0; 3]);
    }

    #[test]
    fn nearer_bodies_hide_farther_ones_at_any_order() {
        let wall = |z: f64| {
            Mesh::new(
                &[DVec3::new(-9.0, -9.0, z), DVec3::new(9.0, -9.0, z), DVec3::new(0.0, 9.0, z)],
                vec![[0, 1, 2]],
            )
        };
        let (near, far) = (wall(2.0), wall(3.0));
        let observer = Tetrad::of_world(Event::origin());
        let map = ApparentMap::new(&Motion::at_rest(DVec3::ZERO), &observer);
        let [seen_near, seen_far] = [&near, &far].map(|m| ApparentMesh::linear(m, &map));
        let near = Drawable { body: 0, mesh: &near, map: &map, seen: &seen_near };
        let far = Drawable { body: 1, mesh: &far, map: &map, seen: &seen_far };
        let body = |mesh: &Mesh| Body::new("m", mesh.clone(), Motion::at_rest(DVec3::ZERO));
        let scene = Scene::new("s", vec![body(near.mesh), body(far.mesh)], View::default());
        let shading = Shading::within(&scene, 0.0, Coloring::Geometry).unwrap();
        for order in [[near, far], [far, near]] {
            let film = shade(&order, &lens(0), &Samples::new(1), &shading.seen_by(&observer));
            assert_eq!(film.body[21 * 61 + 30], 0);
            assert_eq!(film.distance[21 * 61 + 30], 2.0);
        }
    }

    #[test]
    fn degenerate_triangles_draw_nothing() {
        let mesh = Mesh::new(
            &[DVec3::Z, DVec3::Z, DVec3::new(1.0, 0.0, 1.0), DVec3::ZERO, DVec3::new(2.0, 0.0, 2.0)],
            vec![[0, 1, 2], [3, 0, 2], [0, 2, 4], [0, 0, 0]],
        );
        for which in 0..5 {
            assert_eq!(draw_at_rest(&mesh, &lens(which), 1).covered(), 0);
        }
    }
}
