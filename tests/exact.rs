//! Exact shading sees just what rays see: every pixel, to the bit.

use glam::DVec3;
use terrell::color::Coloring;
use terrell::film::{Film, Samples};
use terrell::geodesic::{Celerity, Event};
use terrell::relativity::Motion;
use terrell::render::Options;
use terrell::scene::{Aim, Body, Projection, Scene, Speed, View, builtin_scene, builtin_scenes, shapes};
use terrell::trace::{Look, Paths, Tracer};

fn shipped(name: &str) -> Scene {
    builtin_scene(name).unwrap().scene()
}

/// By lists, and by rays: the pixels that differ in anything, and those that show something.
fn differ(scene: &Scene, samples: u32) -> [usize; 2] {
    let camera = scene.camera().unwrap();
    let options = Options { coloring: Coloring::Geometry, ..Options::default() };
    let prepared = options.prepare(scene, [&camera]).unwrap();
    let (samples, shading) = (Samples::new(samples), prepared.shading.seen_by(&camera.observer));
    let look = Look { samples: samples.offsets(), shading: &shading, paths: Paths::default() };
    let [exact, traced] = [Tracer::listing, Tracer::new].map(|make| {
        let mut film = Film::new(0, 0);
        make(scene).trace(scene, &camera, &look, &mut film, |_, _| ());
        film
    });
    let same = |i: usize| {
        let of = |film: &Film| (film.body[i], film.face[i], film.distance[i], film.doppler[i], film.color[i]);
        of(&exact) == of(&traced)
    };
    [(0..traced.body.len()).filter(|i| !same(*i)).count(), traced.covered()]
}

/// All that ships, with every lens, from rest to 0.9999c, shadows and a sky included.
#[test]
fn scenes_that_ship() {
    let mut pixels = 0;
    for (builtin, projection) in builtin_scenes()
        .iter()
        .flat_map(|s| [Projection::Pinhole, Projection::Fisheye, Projection::Panorama].map(|p| (s, p)))
    {
        let mut scene = builtin.scene();
        if scene.spacetime.is_curved() {
            continue;
        }
        scene.view.size = [161, 91];
        scene.view.projection = projection;
        scene.view.fov_deg = (projection == Projection::Pinhole).then_some(70.0);
        for beta in [0.0f64, 0.5, 0.9, 0.9999] {
            let mut scene = scene.clone();
            // Moved for the look of it: where nothing passes, there is nothing to be abreast of.
            let speed = beta.max(1e-6);
            scene.set_speed(Speed::Along(speed / (1.0 - speed * speed).sqrt())).unwrap();
            if scene.camera().is_err() {
                continue;
            }
            let [different, shown] = differ(&scene, 1);
            assert_eq!(different, 0, "{} {projection} {beta}", builtin.name);
            pixels += shown;
        }
    }
    assert!(pixels > 400_000, "{pixels}");
}

/// Samples beside the middle are seen by the same lists.
#[test]
fn many_samples() {
    let mut scene = shipped("street");
    scene.view.size = [120, 70];
    let [different, shown] = differ(&scene, 9);
    assert!(different == 0 && shown > 1000);
}

/// A wrinkled ball of 320 000 triangles, of the size people have, from outside and from within.
#[test]
fn a_large_mesh() {
    let mesh = shapes::boulder(400);
    assert_eq!(mesh.triangles.len(), 320_000);
    for (place, projection) in [(DVec3::Y * 3.0, Projection::Pinhole), (DVec3::ZERO, Projection::Panorama)] {
        let celerity = Celerity::from_beta(DVec3::new(0.9, 0.0, 0.2)).unwrap();
        let motion = Motion { celerity, origin: Event::at(-1.0, place) };
        let view = View { aim: Aim::Forward(DVec3::Y), projection, size: [320, 180], ..View::default() };
        let scene = Scene::new("ball", vec![Body::new("ball", mesh.clone(), motion)], view);
        let [different, shown] = differ(&scene, 1);
        assert!(different == 0 && shown > 5000, "{different} {shown}");
    }
}
