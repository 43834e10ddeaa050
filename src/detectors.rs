//! Apparent shapes seen from aside: what detectors all over the camera's frame have recorded, as one solid thing.

use crate::color::Coloring;
use crate::export::Surface;
use crate::scene::{Aim, Body, Camera, Material, Mesh, Paint, Projection, Scene, Surface as Shines, View};
use crate::transform::{Axes, Observer, Options, TransformError, transform};
use glam::{DVec2, DVec3};
use terrell_geodesic::{Celerity, Event};

/// From where the usual view is: to the right, above and behind.
pub const USUAL_SIDE: DVec3 = DVec3::new(1.0, 0.45, -0.3);

/// Makes of a scene a still one of the shapes its bodies seem to have to its camera, around a small model of that camera, seen
/// from somewhere else.
///
/// Every point is where its light came from by the camera's reckoning: so far away as the light is old (Nollert et al. 2000,
/// section 2.1.2). Who stands `from` there (right, up, ahead of the camera, in lengths of the scene) sees the shape itself, and
/// no shift: colours are those that the camera sees, at the exposure `ev` (one that suits, if none is given), and shine by
/// themselves, as it is not the apparent shape that light falls on. Without `from` all of it is seen from [`USUAL_SIDE`]. The
/// field is the camera's if that is a pinhole.
///
/// # Errors
/// As [`transform`].
pub fn seen_from(
    scene: &Scene,
    camera: &Camera,
    from: Option<DVec3>,
    coloring: Coloring,
    ev: Option<f32>,
) -> Result<Scene, TransformError> {
    let options = Options { axes: Axes::Camera, coloring, ev, ..Options::default() };
    let (model, _) = transform(scene, camera, &[camera.observer], &[0.0], &options)?;
    let shapes: Vec<(String, Mesh)> = model
        .objects
        .into_iter()
        .flat_map(|object| object.surfaces.into_iter().map(move |s| (object.name.clone(), mesh(s))))
        .collect();
    let bounds = shapes.iter().filter_map(|(_, mesh)| mesh.bounds());
    let (low, high) =
        bounds.fold((DVec3::ZERO, DVec3::ZERO), |all, (low, high)| (all.0.min(low), all.1.max(high)));
    let (middle, radius) = (0.5 * (low + high), (0.5 * (high - low).length()).max(1e-30));
    let marker = marker(camera, 0.05 * radius);
    let pinhole = camera.lens.projection() == Projection::Pinhole;
    let fov_deg = if pinhole { scene.view.fov_deg } else { None }.unwrap_or(USUAL_FOV_DEG);
    let place = from.map_or_else(
        || {
            let meshes = || shapes.iter().map(|(_, mesh)| mesh).chain([&marker]);
            let points = meshes().flat_map(|mesh| (0..mesh.vertex_count() as u32).map(|v| mesh.vertex(v)));
            let aside = Observer::turned(USUAL_SIDE).normalize();
            middle + aside * distance_for(points.map(|p| p - middle), aside, scene.view.size, fov_deg)
        },
        Observer::turned,
    );
    let mut bodies = vec![still("camera", marker)];
    bodies.extend(shapes.into_iter().map(|(name, mesh)| still(&name, mesh)));
    let view = View {
        event: Event::at(0.0, place),
        celerity: Celerity::at_rest(),
        aim: Aim::LookAt(middle),
        up: if (middle - place).cross(DVec3::Y).length() > 1e-6 * radius { DVec3::Y } else { -DVec3::Z },
        projection: Projection::Pinhole,
        fov_deg: Some(fov_deg),
        nearest: None,
        ..scene.view.clone()
    };
    let mut still = Scene::new(&scene.name, bodies, view);
    still.files.clone_from(&scene.files);
    still.notes.clone_from(&scene.notes);
    Ok(still)
}

/// Degrees from the picture's lower edge to the upper, where the camera's lens does not say.
const USUAL_FOV_DEG: f64 = 50.0;

/// How far `aside` of the origin all of these points are within a picture of the origin, upright, with a margin.
fn distance_for(points: impl Iterator<Item = DVec3>, aside: DVec3, size: [u32; 2], fov_deg: f64) -> f64 {
    let right = DVec3::Y.cross(aside).normalize();
    let up = aside.cross(right);
    let high = (0.5 * fov_deg).to_radians().tan() / 1.1;
    let wide = high * f64::from(size[0]) / f64::from(size[1].max(1));
    let least = |p: DVec3| p.dot(aside) + (p.dot(right).abs() / wide).max(p.dot(up).abs() / high);
    points.map(least).fold(1e-30, f64::max)
}

fn still(name: &str, mesh: Mesh) -> Body {
    Body::new(name, mesh, crate::relativity::Motion::at_rest(DVec3::ZERO))
}

/// A surface at its only time.
fn mesh(surface: Surface) -> Mesh {
    let Surface { material, triangles, uv, frames } = surface;
    let material = Material {
        surface: Shines::Luminous,
        law: Default::default(),
        gloss: Default::default(),
        ..material
    };
    let frame = frames.into_iter().next().unwrap_or_default();
    let paint =
        if frame.colors.is_empty() { Paint::Uniform([1.0; 3]) } else { Paint::Vertices(frame.colors) };
    let normals = frame.normals.iter().map(|n| n.to_array()).collect();
    Mesh { paint, materials: vec![material], uv, normals, ..Mesh::new(&frame.positions, triangles) }
}

/// A camera: a pyramid of what it sees, or, where that is no pyramid, an octahedron.
fn marker(camera: &Camera, size: f64) -> Mesh {
    let lens = camera.lens;
    let (vertices, triangles) = if lens.projection() == Projection::Pinhole {
        let [w, h] = [f64::from(lens.width()), f64::from(lens.height())];
        let corner = |x: f64, y: f64| {
            let direction = lens.direction(DVec2::new(x, y)).unwrap_or(DVec3::Z);
            Observer::turned(direction.normalize()) * size
        };
        let corners = [corner(0.0, 0.0), corner(w, 0.0), corner(w, h), corner(0.0, h)];
        let sides = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [1, 3, 2], [1, 4, 3]];
        ([&[DVec3::ZERO][..], &corners].concat(), sides.to_vec())
    } else {
        let ends = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let sides = (0..4u32).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]);
        (ends.map(|end| end * (0.4 * size)).to_vec(), sides.collect())
    };
    let material =
        Material { surface: Shines::Luminous, base_color: [0.9, 0.75, 0.1], ..Material::default() };
    Mesh { paint: Paint::Uniform([1.0; 3]), materials: vec![material], ..Mesh::new(&vertices, triangles) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relativity::ApparentMap;
    use crate::scene::builtin_scene;

    /// Every vertex of the still shapes is, by the inverse map, a point of the body's surface.
    #[test]
    fn shapes_are_those_that_are_seen() {
        let scene = builtin_scene("cube").unwrap().scene();
        let camera = scene.camera().unwrap();
        let map = ApparentMap::new(&scene.bodies[0].motion, &camera.observer);
        let still = seen_from(&scene, &camera, None, Coloring::Geometry, None).unwrap();
        let (low, high) = scene.bodies[0].mesh.bounds().unwrap();
        let mut count = 0;
        for body in still.bodies.iter().filter(|body| body.name == "cube") {
            for vertex in (0..body.mesh.vertex_count() as u32).map(|v| body.mesh.vertex(v)) {
                let (rest, _) = map.unsee(Observer::turned(vertex));
                let depth = (rest - low).min(high - rest).min_element();
                assert!(depth.abs() < 1e-12, "{rest}");
                count += 1;
            }
        }
        assert!(count > 100, "{count}");
        // And all of it is in the picture, the camera with it.
        let eye = still.camera().unwrap();
        for body in &still.bodies {
            let map = ApparentMap::new(&body.motion, &eye.observer);
            for vertex in (0..body.mesh.vertex_count() as u32).map(|v| body.mesh.vertex(v)) {
                let pixel = eye.lens.pixel(map.see(vertex).position).unwrap();
                let [w, h] = scene.view.size.map(f64::from);
                assert!((0.0..w).contains(&pixel.x) && (0.0..h).contains(&pixel.y), "{pixel}");
            }
        }
    }

    #[test]
    fn every_lens_and_moving_camera_has_a_view_from_aside() {
        for name in ["gate", "sphere", "train"] {
            for projection in [Projection::Pinhole, Projection::Fisheye, Projection::Panorama] {
                let mut scene = builtin_scene(name).unwrap().scene();
                (scene.view.projection, scene.view.fov_deg) = (projection, None);
                let camera = scene.camera().unwrap();
                let at = Some(DVec3::new(3.0, 2.0, -8.0));
                let still = seen_from(&scene, &camera, at, Coloring::Doppler, None).unwrap();
                assert_eq!(still.view.event.position(), DVec3::new(3.0, 2.0, 8.0));
                assert!(still.camera().is_ok() && still.bodies.len() > scene.bodies.len());
            }
        }
    }
}
