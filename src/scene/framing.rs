use super::{Aim, Imported, Part, Projection, Scene, View};
use crate::relativity::Motion;
use glam::DVec3;
use terrell_geodesic::{Celerity, Event, FourVector};

/// A scene around one mesh: it passes a camera at rest, square to its motion, at a distance from which all of
/// it is seen, and the picture is taken when its centre appears abreast.
///
/// The camera looks along −z with y up, as glTF viewers do, or as near to that as square to the motion allows.
/// A body's bounding sphere seen abreast keeps the angular size it has at rest at that distance (Penrose), so
/// one distance serves all speeds.
///
/// `view` gives the lens and the picture's size; the rest of it is set here.
pub fn framed(name: &str, imported: Imported, celerity: Celerity, view: View) -> Scene {
    let (low, high) = bounds(&imported.parts);
    let centre = 0.5 * (low + high);
    let along = celerity.direction();
    let square = |v: DVec3| along.map_or(v, |axis| v - axis * v.dot(axis));
    let forward = [-DVec3::Z, -DVec3::X, DVec3::Y]
        .into_iter()
        .map(square)
        .find(|v| v.length() > 0.5)
        .unwrap_or(-DVec3::Z)
        .normalize();
    let up = [DVec3::Y, DVec3::Z].into_iter().find(|u| u.cross(forward).length() > 0.5).unwrap_or(DVec3::X);

    let distance = distance_for(&view, 0.5 * (high - low).length());
    let view = View { aim: Aim::Forward(forward), up, ..view };
    passing(name, imported, celerity, view, distance * forward, centre)
}

/// A scene as a file has it: its velocities, and its camera if it has one; else a camera at rest that looks along −z
/// at all of it, as it is when the light of time 0 arrives.
///
/// With a `celerity`, what the file has at rest moves with that, and is seen where the file puts it.
pub fn authored(name: &str, imported: Imported, celerity: Option<Celerity>, lens: View) -> Scene {
    let (low, high) = bounds(&imported.parts);
    let centre = 0.5 * (low + high);
    let view = imported.view.clone().unwrap_or_else(|| {
        let distance = distance_for(&lens, 0.5 * (high - low).length());
        let event = Event::at(distance, centre + DVec3::Z * distance);
        View { event, aim: Aim::Forward(-DVec3::Z), up: DVec3::Y, ..lens }
    });
    match celerity {
        Some(celerity) => {
            let from_camera = centre - view.event.position();
            passing(name, imported, celerity, view, from_camera, centre)
        }
        None => Scene {
            lights: imported.lights,
            files: imported.files,
            notes: imported.notes,
            ..Scene::new(name, imported.parts.into_iter().map(Part::into_body).collect(), view)
        },
    }
}

/// Everything in a file in motion together, its point `centre` seen at `seen` from the camera's event.
fn passing(
    name: &str,
    imported: Imported,
    celerity: Celerity,
    view: View,
    seen: DVec3,
    centre: DVec3,
) -> Scene {
    let left = view.event + FourVector::from_parts(-seen.length(), seen);
    let motion = Motion { celerity, origin: left };
    let to_centre = motion.world_from_rest::<f64>() * FourVector::from_parts(0.0, centre);
    let motion = Motion { celerity, origin: left + (-to_centre) };
    let shift = FourVector::from_parts(0.0, view.event.position() + seen - centre);
    let mut imported = imported.settled();
    // Lights stay at rest, around the place where the file's middle is seen.
    imported.lights.iter_mut().for_each(|light| light.motion.origin = light.motion.origin + shift);
    let body = |part: Part| super::Body { motion, ..part.into_body() };
    Scene {
        lights: imported.lights,
        files: imported.files,
        notes: imported.notes,
        ..Scene::new(name, imported.parts.into_iter().map(body).collect(), view)
    }
}

/// Least and greatest coordinates of all parts where the file puts them.
fn bounds(parts: &[Part]) -> (DVec3, DVec3) {
    let of = |part: &Part| {
        let at = part.motion.origin.position();
        part.bounds().map(|(low, high)| (low + at, high + at))
    };
    let both = |a: (DVec3, DVec3), b: (DVec3, DVec3)| (a.0.min(b.0), a.1.max(b.1));
    parts.iter().filter_map(of).reduce(both).unwrap_or((DVec3::ZERO, DVec3::ZERO))
}

/// How far away a ball of that radius is seen whole, with a margin.
fn distance_for(view: &View, radius: f64) -> f64 {
    // The smaller half-field, and a margin. Beyond a radian the mesh would be seen from too near.
    let fov_deg = view.fov_deg.unwrap_or(View::usual_fov_deg(view.projection));
    let half = 0.5 * fov_deg.to_radians();
    let across = f64::from(view.size[0]) / f64::from(view.size[1].max(1));
    let half = match view.projection {
        Projection::Pinhole => half.min((half.tan() * across).atan()),
        Projection::Fisheye => half.min(half * across),
        Projection::Panorama => 1.0,
    };
    // A field no lens has is refused when the camera is made.
    let half = if half > 0.0 { half.min(1.0) } else { 1.0 };
    1.1 * radius.max(1e-30) / half.sin()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relativity::ApparentMap;
    use crate::scene::Mesh;

    #[test]
    fn the_whole_mesh_is_in_the_picture_at_every_speed_and_direction() {
        let mut vertices = Vec::new();
        for i in 0..40 {
            let a = f64::from(i);
            vertices.push(
                DVec3::new(a.sin(), (1.7 * a).cos() * 3.0, (2.9 * a).sin()) * 5.0
                    + DVec3::new(100.0, 3.0, -7.0),
            );
        }
        let mesh = Mesh::new(&vertices, vec![[0, 1, 2]]);
        let imported = Imported { parts: vec![Part::still("m".into(), mesh)], ..Imported::default() };
        let views = [
            (Projection::Pinhole, None, [1280, 720]),
            (Projection::Pinhole, Some(15.0), [300, 900]),
            (Projection::Pinhole, Some(150.0), [900, 300]),
            (Projection::Fisheye, None, [400, 300]),
            (Projection::Fisheye, Some(60.0), [200, 300]),
            (Projection::Panorama, None, [400, 200]),
        ];
        for direction in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, -2.0, 0.5)] {
            for gamma in [1.0, 1.2, 5.0, 1e3, 1e6] {
                for (projection, fov_deg, size) in views {
                    let celerity = Celerity::from_gamma(gamma, direction).unwrap();
                    let view = View { projection, fov_deg, size, ..View::default() };
                    let scene = framed("m", imported.clone(), celerity, view);
                    let camera = scene.camera().unwrap();
                    let map = ApparentMap::new(&scene.bodies[0].motion, &camera.observer);
                    for v in &vertices {
                        let pixel = camera.lens.pixel(map.see(*v).position).unwrap();
                        let inside = pixel.x > 0.0 && pixel.y > 0.0;
                        let inside = inside && pixel.x < f64::from(size[0]) && pixel.y < f64::from(size[1]);
                        assert!(inside, "{direction} γ {gamma} {projection}: {pixel}");
                    }
                }
            }
        }
    }
}
