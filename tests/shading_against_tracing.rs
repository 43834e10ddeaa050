//! Every scene that ships and in which no surface is lit: what shading sees against what rays see.
//!
//! What disagrees must do so within a pixel of an outline; and where both see the same triangle, all else is equal.

use terrell::color::Coloring;
use terrell::film::Film;
use terrell::measure::{Comparison, Corners, Figures, Mark, Reference};
use terrell::plan::{Method, is_of_polygons};
use terrell::render::{Options, Raster, render};
use terrell::scene::{Camera, Scene, builtin_scenes};
use terrell::trace::{Look, Paths, Tracer};

const SIZE: [u32; 2] = [320, 180];

fn scenes() -> impl Iterator<Item = Scene> {
    let small = |mut scene: Scene| {
        scene.view.size = SIZE;
        scene
    };
    builtin_scenes().iter().map(|scene| scene.scene()).filter(is_of_polygons).map(small)
}

fn draw(scene: &Scene, camera: &Camera, method: Method, raster: Raster) -> Film {
    let options = Options { method, raster, ..Options::default() };
    render(scene, camera, &options, |_| ()).unwrap().0
}

/// A scene as rays see it.
struct Traced<'a> {
    scene: &'a Scene,
    camera: Camera,
    tracer: Tracer,
}

impl Traced<'_> {
    /// At so many pixels from the pixels' upper left corners.
    fn at(&self, offset: [f64; 2]) -> Film {
        let options = Options { coloring: Coloring::Doppler, ..Options::default() };
        let prepared = options.prepare(self.scene, [&self.camera]).unwrap();
        let shading = prepared.shading.seen_by(&self.camera.observer);
        let mut film = Film::new(0, 0);
        let look = Look { samples: &[offset], shading: &shading, paths: Paths::default() };
        self.tracer.trace(self.scene, &self.camera, &look, &mut film, |_, _| ());
        film
    }

    fn reference(&self) -> Reference {
        let film = draw(self.scene, &self.camera, Method::Trace, Raster::Cpu);
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|corner| self.at(corner));
        let corners = Some(Corners::new(&film, &corners));
        Reference { corners, ..Reference::from(film) }
    }

    /// How far from the centre of each pixel with a mark, in pixels, a ray sees another body than the centre's, or another
    /// face for marks of edges; rays lie on a grid of this spacing, so many each way.
    fn to_outlines(&self, reference: &Film, marks: &[Mark], step: f64, reach: i32) -> Vec<(usize, f64)> {
        let marked: Vec<usize> = (0..marks.len()).filter(|&i| marks[i] != Mark::Same).collect();
        let mut nearest = vec![f64::INFINITY; marked.len()];
        for (x, y) in (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y))) {
            let [dx, dy] = [x, y].map(|v| step * f64::from(v));
            let film = self.at([0.5 + dx, 0.5 + dy]);
            for (nearest, &i) in nearest.iter_mut().zip(&marked) {
                let other = film.body[i] != reference.body[i]
                    || (marks[i].is_same_body() && film.face[i] != reference.face[i]);
                if other {
                    *nearest = nearest.min(dx.hypot(dy));
                }
            }
        }
        marked.into_iter().zip(nearest).collect()
    }
}

/// Same face, same everything: found by another way, but from the same boost, in f64, of the same line of sight, and then
/// rounded to f32 once.
fn is_equal(figures: &Figures, what: &str) {
    for worst in [figures.distance, figures.doppler] {
        assert!(worst.unwrap().relative <= f64::from(f32::EPSILON), "{what}: {worst:?}");
    }
    // D, to be raised to its third or fourth power, may be rounded otherwise.
    let light = figures.radiance_same_face.unwrap();
    assert!(light.worst <= 1e-6, "{what}: {light:?}");
}

#[test]
fn shading_sees_what_rays_see() {
    for scene in scenes() {
        let camera = scene.camera().unwrap();
        let traced = Traced { scene: &scene, camera, tracer: Tracer::new(&scene) };
        let reference = traced.reference();
        let film = draw(&scene, &camera, Method::Apparent, Raster::Cpu);
        let found = Comparison::new(&reference, &film).unwrap();
        let (silhouette, edges) =
            (found.whole.silhouette.clone().unwrap(), found.whole.edges.clone().unwrap());
        println!(
            "{}: silhouettes {} px, {} beyond; edges {} px, {} beyond",
            scene.name, silhouette.pixels, silhouette.beyond, edges.pixels, edges.beyond
        );
        assert_eq!(silhouette.beyond, 0, "{}: {silhouette:?}", scene.name);
        assert_eq!(edges.beyond, 0, "{}: {edges:?}", scene.name);
        is_equal(&found.whole, &scene.name);
        // A pixel, and half the diagonal of the grid.
        for (i, distance) in traced.to_outlines(&reference.film, &found.marks, 0.2, 5) {
            let at = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
            let most = 1.0 + 0.2 * 0.5f64.sqrt();
            assert!(distance <= most, "{}, pixel {at:?}, {:?}: {distance}", scene.name, found.marks[i]);
        }
        // The painter orders whole triangles, so where they interlace it may show the wrong face; see its page.
        let painted = draw(&scene, &camera, Method::Apparent, Raster::Skia);
        let painted = Comparison::new(&reference, &painted).unwrap().whole;
        let silhouette = painted.silhouette.clone().unwrap();
        assert_eq!(silhouette.beyond, 0, "{}, painted: {silhouette:?}", scene.name);
        is_equal(&painted, &scene.name);
    }
}

/// Outlines are said to be within the tolerance, ¼ px, of where they belong.
#[test]
fn outlines_keep_the_tolerance() {
    let mut off = Vec::new();
    for scene in scenes() {
        let camera = scene.camera().unwrap();
        let traced = Traced { scene: &scene, camera, tracer: Tracer::new(&scene) };
        let reference = traced.reference();
        let film = draw(&scene, &camera, Method::Apparent, Raster::Cpu);
        let found = Comparison::new(&reference, &film).unwrap();
        let most = Options::default().tolerance + 0.1 * 0.5f64.sqrt();
        for (i, distance) in traced.to_outlines(&reference.film, &found.marks, 0.1, 4) {
            if distance > most {
                let at = [i as u32 % film.width, i as u32 / film.width];
                off.push(format!("{} {at:?} {:?} {distance:.2} px", scene.name, found.marks[i]));
            }
        }
    }
    assert!(off.is_empty(), "{}", off.join("\n"));
}
