//! Whole pictures against brute force: every pixel's ray boosted into every body's rest frame (4×4 Lorentz
//! matrices, no apparent map) and tried on every triangle, for random bodies in random motion, cameras that move,
//! stand inside, or look everywhere.

mod common;

use common::Random;
use glam::{DVec2, DVec3};
use std::sync::Arc;
use terrell::film::{Film, Samples};
use terrell::geodesic::{Celerity, Event, FourVector, Lorentz, Rest, World};
use terrell::plan::Method;
use terrell::relativity::Motion;
use terrell::render::{Options, render};
use terrell::scene::{Aim, Body, Camera, Mesh, Projection, Scene, View, shapes};
use terrell::trace::{Look, Paths};

/// A body with what rays need: origin and direction maps, corners.
struct Target {
    rest_from_world: Lorentz<Rest, World>,
    observer: DVec3,
    triangles: Vec<[DVec3; 3]>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Hit {
    body: usize,
    face: usize,
    distance: f64,
    doppler: f64,
}

struct Tracer {
    world_from_observer: Lorentz<World, terrell::geodesic::Observer>,
    targets: Vec<Target>,
}

impl Tracer {
    fn new(scene: &Scene, camera: &Camera) -> Self {
        let targets = scene
            .bodies
            .iter()
            .map(|body| {
                let rest_from_world = body.motion.world_from_rest::<f64>().inverse();
                let observer = rest_from_world * (camera.observer.event() - body.motion.origin);
                Target {
                    rest_from_world,
                    observer: observer.xyz(),
                    triangles: (0..body.mesh.triangles.len()).map(|t| body.mesh.corners(t)).collect(),
                }
            })
            .collect();
        Self { world_from_observer: camera.observer.observer_from_world::<f64>().inverse(), targets }
    }

    /// The nearest hit, and the second nearest distance.
    fn cast(&self, direction: DVec3) -> (Option<Hit>, f64) {
        let n = direction.normalize();
        let world = self.world_from_observer * FourVector::seen_from(n);
        let (mut nearest, mut second): (Option<Hit>, f64) = (None, f64::INFINITY);
        for (body, target) in self.targets.iter().enumerate() {
            let k = target.rest_from_world * world;
            for (face, &[a, b, c]) in target.triangles.iter().enumerate() {
                let (ab, ac, ray) = (b - a, c - a, k.xyz());
                let p = ray.cross(ac);
                let determinant = ab.dot(p);
                let from = target.observer - a;
                let u = from.dot(p) / determinant;
                let q = from.cross(ab);
                let v = ray.dot(q) / determinant;
                // One affine parameter in all frames: the observer's distance, K being unnormalised.
                let distance = ac.dot(q) / determinant;
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 {
                    if nearest.is_none_or(|hit| distance < hit.distance) {
                        second = nearest.map_or(f64::INFINITY, |hit| hit.distance);
                        nearest = Some(Hit { body, face, distance, doppler: 1.0 / k.t.abs() });
                    } else {
                        second = second.min(distance);
                    }
                }
            }
        }
        (nearest, second)
    }
}

/// What shading says if it sees the same body there, else what the ray says.
fn film_doppler(film: &Film, i: usize, hit: Hit) -> f32 {
    if film.body[i] == hit.body as i32 { film.doppler[i] } else { hit.doppler as f32 }
}

fn cube_of(scale: f64) -> Mesh {
    shapes::cube().placed(&glam::DAffine3::from_scale(DVec3::splat(scale)))
}

fn random_scene(random: &mut Random, fastest: f64) -> Scene {
    let celerity = |random: &mut Random| {
        let u = random.point(1.0).normalize() * (fastest * random.unit().powi(2));
        Celerity::new(u).unwrap()
    };
    let bodies = (0..3)
        .map(|i| {
            let mesh = match i {
                0 => cube_of(1.0 + 2.0 * random.unit()),
                1 => shapes::sphere(1),
                _ => {
                    let vertices: Vec<DVec3> = (0..6).map(|_| random.point(4.0)).collect();
                    Mesh::new(&vertices, vec![[0, 1, 2], [2, 3, 4], [3, 4, 5]])
                }
            };
            let motion = Motion {
                celerity: celerity(random),
                origin: Event::at(random.unit() - 0.5, random.point(4.0)),
            };
            Body { name: i.to_string(), mesh: Arc::new(mesh), motion, clip: None }
        })
        .collect();
    let projection = [Projection::Pinhole, Projection::Pinhole, Projection::Fisheye, Projection::Panorama];
    let projection = projection[(4.0 * random.unit()) as usize];
    let view = View {
        event: Event::at(random.unit(), random.point(2.0)),
        celerity: celerity(random),
        stance: terrell::scene::Stance::Moving,
        aim: Aim::Forward(random.point(1.0)),
        up: random.point(1.0),
        projection,
        fov_deg: (projection == Projection::Pinhole).then(|| 40.0 + 100.0 * random.unit()),
        size: [72, 54],
        nearest: None,
    };
    Scene::new("random", bodies, view)
}

/// By exact shading, which is to see just what rays see.
fn listed(scene: &Scene, camera: &Camera, options: &Options) -> Film {
    let prepared = options.prepare(scene, [camera]).unwrap();
    let (samples, shading) = (Samples::new(options.samples), prepared.shading.seen_by(&camera.observer));
    let look = Look { samples: samples.offsets(), shading: &shading, paths: Paths::default() };
    let mut film = Film::new(0, 0);
    terrell::trace::Tracer::listing(scene).trace(scene, camera, &look, &mut film, |_, _| ());
    film
}

/// Largest γβ of a body or the camera, and how many scenes.
fn compare(seed: u64, fastest: f64, scenes: usize) {
    let apart = 1e-6 + 1e-13 * fastest.powi(4);
    let mut random = Random(seed);
    let (mut compared, mut hits, mut traced_clear) = (0, 0, 0);
    for number in 0..scenes {
        let scene = random_scene(&mut random, fastest);
        let camera = scene.camera().unwrap();
        let options = Options { method: Method::Apparent, tolerance: 0.1, ..Options::default() };
        let (film, _) = render(&scene, &camera, &options, |_| ()).unwrap();
        let options = Options { method: Method::Trace, ..options };
        let (traced, _) = render(&scene, &camera, &options, |_| ()).unwrap();
        assert!(listed(&scene, &camera, &options) == traced, "scene {number} of seed {seed}");
        let tracer = Tracer::new(&scene, &camera);
        for i in 0..film.body.len() {
            let centre = DVec2::new((i % 72) as f64 + 0.5, (i / 72) as f64 + 0.5);
            let cast = |dx: f64, dy: f64| {
                camera.lens.direction(centre + DVec2::new(dx, dy)).map(|direction| tracer.cast(direction))
            };
            let Some((hit, second)) = cast(0.0, 0.0) else { continue };
            let what = |hit: Option<Hit>| hit.map(|h| (h.body, h.face));
            let at = format!("scene {number} of seed {seed}, pixel {centre}, {:?}", camera.lens.projection());
            let numbers = hit.map_or((-1, -1), |h| (h.body as i32, h.face as i32));
            // Rays agree with rays up to an outline, where the matrices of this test have lost a part of a pixel.
            let near = 1e-6 + 1e-12 * fastest.powi(3);
            let clear = [(-near, 0.0), (near, 0.0), (0.0, -near), (0.0, near)]
                .into_iter()
                .all(|(dx, dy)| cast(dx, dy).is_some_and(|(other, _)| what(other) == what(hit)));
            if clear && hit.is_none_or(|h| second > (1.0 + apart) * h.distance) {
                traced_clear += 1;
                assert_eq!((traced.body[i], traced.face[i]), numbers, "traced, {at}");
                if let Some(hit) = hit {
                    let farther = f64::from(traced.distance[i]) / hit.distance - 1.0;
                    assert!(farther.abs() < apart, "traced, {at}: r {} {}", traced.distance[i], hit.distance);
                    assert_eq!(traced.doppler[i], film_doppler(&film, i, hit), "traced, {at}");
                }
            }
            // Half a pixel around, where outlines may be a tenth of one off. Surfaces may be as close as f32 depths
            // (and the f64 matrices of this test) can tell.
            let surely = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.25, 0.0), (0.0, -0.25)]
                .into_iter()
                .all(|(dx, dy)| cast(dx, dy).is_some_and(|(other, _)| what(other) == what(hit)));
            if !surely || hit.is_some_and(|h| second < (1.0 + apart) * h.distance) {
                continue;
            }
            compared += 1;
            assert_eq!((film.body[i], film.face[i]), numbers, "{at}");
            if let Some(hit) = hit {
                hits += 1;
                let farther = f64::from(film.distance[i]) / hit.distance - 1.0;
                assert!(farther.abs() < apart, "{at}: r {} {}", film.distance[i], hit.distance);
                let off = f64::from(film.doppler[i]) / hit.doppler - 1.0;
                // f32, and what the f64 matrices of this test lose to γ.
                assert!(
                    off.abs() < 2e-7 + 1e-13 * fastest.powi(4),
                    "{at}: D {} {}",
                    film.doppler[i],
                    hit.doppler
                );
            }
        }
    }
    println!("γβ up to {fastest}: {compared} pixels compared, {hits} hits; {traced_clear} traced");
    assert!(hits > 1000 && traced_clear > compared, "{hits} of {compared}, {traced_clear} traced");
}

#[test]
fn at_rest() {
    compare(1, 0.0, 30);
}

#[test]
fn at_moderate_speed() {
    compare(2, 1.5, 60);
}

#[test]
fn near_light_speed() {
    compare(3, 12.0, 60);
}

#[test]
fn at_gamma_of_hundreds() {
    compare(4, 300.0, 40);
}

/// A wall from so near that it fills half the sky or more, at speeds that squeeze its edges into a point behind or
/// spread a speck of it over everything.
#[test]
fn a_wall_close_by() {
    let mut random = Random(5);
    let wall = Arc::new(Mesh::new(
        &[
            DVec3::new(-1.0, -1.0, 0.0),
            DVec3::new(1.0, -1.0, 0.0),
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::new(-1.0, 1.0, 0.0),
        ],
        vec![[0, 1, 2], [0, 2, 3]],
    ));
    let (mut compared, mut hits) = (0, 0);
    for number in 0..150 {
        let speed = 200f64.powf(random.unit());
        let celerity = Celerity::new(random.point(1.0).normalize() * speed).unwrap();
        let height = 1e-3f64.powf(random.unit());
        // The camera, at the world's origin, is before this point of the wall in its rest frame.
        let before = DVec3::new(random.unit() - 0.5, random.unit() - 0.5, height);
        let world = Lorentz::<World, Rest>::boost(&celerity) * FourVector::from_parts(0.0, before);
        let motion = Motion { celerity, origin: Event::origin() + (-world) };
        let projection = [Projection::Pinhole, Projection::Fisheye, Projection::Panorama][number % 3];
        let view = View {
            aim: Aim::Forward(random.point(1.0)),
            up: random.point(1.0),
            projection,
            size: [32, 24],
            ..View::default()
        };
        let bodies = vec![Body { name: "wall".into(), mesh: wall.clone(), motion, clip: None }];
        let scene = Scene::new("wall", bodies, view);
        let camera = scene.camera().unwrap();
        let options = |method| Options { method, ..Options::default() };
        let (film, _) = render(&scene, &camera, &options(Method::Apparent), |_| ()).unwrap();
        let (traced, _) = render(&scene, &camera, &options(Method::Trace), |_| ()).unwrap();
        assert!(listed(&scene, &camera, &options(Method::Trace)) == traced, "{number}");
        let tracer = Tracer::new(&scene, &camera);
        for i in 0..film.body.len() {
            let centre = DVec2::new((i % 32) as f64 + 0.5, (i / 32) as f64 + 0.5);
            let hit = |dx: f64, dy: f64| {
                let direction = camera.lens.direction(centre + DVec2::new(dx, dy))?;
                Some(tracer.cast(direction).0.is_some())
            };
            let Some(expected) = hit(0.0, 0.0) else { continue };
            let around = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
            if around.into_iter().all(|(dx, dy)| hit(dx, dy) == Some(expected)) {
                compared += 1;
                hits += usize::from(expected);
                assert_eq!(
                    [film.body[i] == 0, traced.body[i] == 0],
                    [expected; 2],
                    "scene {number}, γβ {speed}, {height} away, {projection}, {centre}"
                );
            }
        }
    }
    println!("{compared} pixels compared, {hits} hits");
    assert!(hits > 10_000);
}
