//! Scenes as TOML.

mod animation;
mod body;
mod light;
mod source;
mod spacetime;
mod tables;

pub use source::SceneError;
pub(crate) use source::did_you_mean;

use super::import::CLAY_NOTE;
use super::{Aim, Body, LensError, Mesh, Paint, Projection, Scene, View, ViewError};
use body::Bodies;
use light::{read_light, read_material};
use source::{Source, VelocityKeys, explain, velocity_keys};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;
use tables::{CameraTable, Color, SceneFile, Vector};
use terrell_geodesic::TetradError;
use toml::Spanned;

/// Reads a scene from TOML; `path` is where it stands, for messages and for the meshes it names.
///
/// # Errors
/// With file, line, what is wrong and the nearest known name.
pub fn parse_scene(text: &str, path: &Path) -> Result<Scene, SceneError> {
    let source = Source { text, path };
    let file: SceneFile = toml::from_str(text).map_err(|e| {
        let at = e.span().map(|s| s.start);
        source.fault(at, explain(e.message(), at.map_or("", |at| source.line_at(at))))
    })?;
    let mut files = vec![path.to_owned()];
    let mut finishes = BTreeMap::new();
    for (name, table) in &file.material {
        finishes.insert(name.as_str(), read_material(&source, table, &mut files)?);
    }
    let spacetime = file.spacetime.as_ref().map(|table| spacetime::read_spacetime(&source, table));
    let spacetime = spacetime.transpose()?.unwrap_or_default();
    let sky = file.sky.as_ref().map(|table| spacetime::read_sky(&source, table, &mut files)).transpose()?;
    let read_light = |(index, table)| read_light(&source, index, table, &mut files);
    let lights: Vec<_> = file.light.iter().enumerate().map(read_light).collect::<Result<_, _>>()?;
    let mut reader = Bodies::new(&source, &finishes, files);
    let mut bodies: Vec<Body> = Vec::new();
    for (index, table) in file.body.iter().enumerate() {
        for body in reader.read(index, table)? {
            if bodies.iter().any(|b| b.name == body.name) {
                let message = format!("two bodies are called '{}'; give one another name", body.name);
                return Err(source.at(&table.mesh, message));
            }
            bodies.push(body);
        }
    }
    if bodies.is_empty() && file.sky.is_none() {
        return Err(source.fault(None, "the scene has no [[body]] and no [sky], so there is nothing to see"));
    }
    let view = match &file.camera {
        Some(table) => {
            let view = read_camera(&source, table)?;
            check_camera(&source, table, &view, &bodies)?;
            view
        }
        None => View::default(),
    };
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let Bodies { files, mut notes, .. } = reader;
    let mut plains = HashMap::new();
    for body in bodies.iter_mut().filter(|body| body.mesh.clay) {
        if lights.is_empty() {
            if !notes.iter().any(|note| note == CLAY_NOTE) {
                notes.push(CLAY_NOTE.to_owned());
            }
        } else {
            // Light shows its shape. What is shared stays so.
            let plain = || {
                let mut mesh = Mesh::clone(&body.mesh);
                mesh.repaint(Paint::CLAY);
                Arc::new(mesh)
            };
            body.mesh = plains.entry(Arc::as_ptr(&body.mesh)).or_insert_with(plain).clone();
        }
    }
    let mut scene = Scene { files, notes, lights, sky, spacetime, ..Scene::new(&name, bodies, view) };
    spacetime::check(&source, file.camera.as_ref(), &file.light, &scene)?;
    if let Some(table) = &file.animation {
        scene.animation = Some(animation::read_animation(&source, table, &scene)?);
    }
    Ok(scene)
}

fn read_camera(source: &Source<'_>, table: &CameraTable) -> Result<View, SceneError> {
    let usual = View::default();
    let projection = match &table.projection {
        None => usual.projection,
        Some(word) => parse_projection(word.get_ref()).map_err(|e| source.at(word, e))?,
    };
    let aim = read_aim(source, &table.look_at, &table.forward)?.unwrap_or(usual.aim);
    Ok(View {
        event: source.event(&table.time, &table.position)?,
        celerity: source.celerity(&velocity_keys!(table))?,
        stance: spacetime::read_stance(source, table)?,
        aim,
        up: table.up.as_ref().map_or(Ok(usual.up), |u| source.vector("up", u))?,
        projection,
        fov_deg: table.fov_deg.as_ref().map(|fov| *fov.get_ref()),
        size: table.size.as_ref().map_or(usual.size, |size| *size.get_ref()),
        nearest: table.nearest.as_ref().map(|name| name.get_ref().clone()),
    })
}

fn read_aim(
    source: &Source<'_>,
    look_at: &Option<Vector>,
    forward: &Option<Vector>,
) -> Result<Option<Aim>, SceneError> {
    Ok(match (look_at, forward) {
        (Some(_), Some(forward)) => {
            return Err(source.at(forward, "both look_at and forward are given; one is enough"));
        }
        (Some(point), None) => Some(Aim::LookAt(source.vector("look_at", point)?)),
        (None, Some(forward)) => Some(Aim::Forward(source.vector("forward", forward)?)),
        (None, None) => None,
    })
}

/// What would fail when the camera is made, said where it stands.
fn check_camera(
    source: &Source<'_>,
    table: &CameraTable,
    view: &View,
    bodies: &[Body],
) -> Result<(), SceneError> {
    let place = |key: &'static str| {
        let span = match key {
            "fov_deg" => table.fov_deg.as_ref().map(Spanned::span),
            "size" => table.size.as_ref().map(Spanned::span),
            "up" => table.up.as_ref().map(Spanned::span),
            "look_at" => table.look_at.as_ref().map(Spanned::span),
            _ => table.forward.as_ref().map(Spanned::span),
        };
        (key, span.map(|s| s.start))
    };
    let fault =
        |(key, at): (&str, Option<usize>), e: &dyn std::fmt::Display| source.fault(at, format!("{key}: {e}"));
    if let Some(name) = &table.nearest {
        let names = || bodies.iter().map(|b| b.name.as_str());
        if !names().any(|n| n == name.get_ref()) {
            let hint = did_you_mean(name.get_ref(), names().collect::<Vec<_>>());
            return Err(source.at(name, format!("nearest: there is no body '{}'; {hint}", name.get_ref())));
        }
    }
    // At which of its moments the picture is taken matters to none of these.
    let view = View { nearest: None, ..view.clone() };
    view.camera(bodies).map(drop).map_err(|e| match &e {
        ViewError::Lens(LensError::Size(..)) => fault(place("size"), &e),
        ViewError::Lens(LensError::Field { .. }) => fault(place("fov_deg"), &e),
        ViewError::Axes(TetradError::NoForward) => fault(place("forward"), &e),
        ViewError::Axes(TetradError::NoUp) => {
            fault(place(if table.up.is_some() { "up" } else { "forward" }), &e)
        }
        _ => fault(place("look_at"), &e),
    })
}

/// The projection of that name.
pub(crate) fn parse_projection(word: &str) -> Result<Projection, String> {
    let all = [Projection::Pinhole, Projection::Fisheye, Projection::Panorama];
    let names = all.map(|p| p.to_string());
    names.iter().position(|n| n == word).map(|i| all[i]).ok_or_else(|| {
        format!("unknown projection '{word}'; {}", did_you_mean(word, names.iter().map(String::as_str)))
    })
}

fn read_color(source: &Source<'_>, key: &str, place: &Spanned<Color>) -> Result<[f32; 3], SceneError> {
    match place.get_ref() {
        Color::Linear(c) if c.iter().all(|v| v.is_finite() && *v >= 0.0) => Ok(*c),
        Color::Linear(_) => {
            Err(source.at(place, format!("{key} must be three numbers, none of them negative")))
        }
        Color::Hex(text) => {
            let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii());
            let value = digits.and_then(|d| u32::from_str_radix(d, 16).ok());
            let value = value
                .ok_or_else(|| source.at(place, format!("{key} '{text}' is not of the form #rrggbb")))?;
            Ok([16, 8, 0].map(|shift| crate::color::linear((value >> shift & 0xff) as u8)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Paint;
    use glam::DVec3;
    use terrell_geodesic::Event;

    fn error(text: &str) -> String {
        parse_scene(text, Path::new("s.toml")).unwrap_err().to_string()
    }

    #[test]
    fn every_key_is_read() {
        let scene = parse_scene(
            r##"
            [camera]
            time = 1
            position = [0, -4, 1]
            look_at = [0, 0, 0]
            up = [0, 0, 1]
            celerity = [0.1, 0, 0]
            projection = "fisheye"
            fov_deg = 120
            size = [64, 48]
            nearest = "ball"

            [material.blue]
            color = "#0000ff"
            [material.dim]
            color = [0.1, 0.2, 0.3]

            [[body]]
            name = "ball"
            mesh = "cube"
            time = -3
            position = [0, 3, 0]
            gamma = 2
            direction = [0, 1, 0]
            rotation = { axis = [0, 0, 1], angle_deg = 90 }
            scale = [2, 1, 1]
            material = "dim"

            [[body]]
            mesh = "cube"
            velocity = [-0.6, 0, 0]
            material = "blue"
            "##,
            Path::new("dir/s.toml"),
        )
        .unwrap();
        assert_eq!(scene.name, "s");
        let ball = &scene.bodies[0];
        assert_eq!(ball.motion.origin, Event::new(-3.0, 0.0, 3.0, 0.0));
        assert!((ball.motion.celerity.vector() - DVec3::Y * 3f64.sqrt()).length() < 1e-15);
        let (low, high) = ball.mesh.bounds().unwrap();
        assert!((high - low - DVec3::new(1.0, 2.0, 1.0)).length() < 1e-14, "stretched, then turned");
        assert_eq!(ball.mesh.paint, Paint::Uniform([0.1, 0.2, 0.3]));
        assert_eq!(scene.bodies[1].name, "cube1");
        assert_eq!(scene.bodies[1].mesh.paint, Paint::Uniform([0.0, 0.0, 1.0]));
        assert_eq!(scene.view.event, Event::new(1.0, 0.0, -4.0, 1.0));
        assert_eq!(scene.view.projection, Projection::Fisheye);
        assert_eq!(scene.view.size, [64, 48]);
        assert!(scene.camera().is_ok());
    }

    #[test]
    fn errors_name_the_line_and_the_nearest_key() {
        let cube = "[[body]]\nmesh = \"cube\"\n";
        for (text, parts) in [
            (format!("{cube}velocty = [0.9, 0, 0]\n"), vec!["s.toml:3:", "'velocty'", "'velocity'"]),
            (format!("[camra]\ntime = 0\n{cube}"), vec!["s.toml:1:", "'camra'", "'camera'"]),
            (format!("{cube}velocity = [0.9, 0.9, 0]\n"), vec!["s.toml:3:", "velocity", "not below 1"]),
            (format!("{cube}gamma = 0.5\n"), vec!["s.toml:3:", "below 1"]),
            (format!("{cube}gamma = 2\nbeta = 0.5\n"), vec!["beta and gamma"]),
            (format!("{cube}direction = [1, 0, 0]\n"), vec!["s.toml:3:", "speed"]),
            (format!("{cube}position = [nan, 0, 0]\n"), vec!["s.toml:3:", "position"]),
            (format!("{cube}scale = 0\n"), vec!["s.toml:3:", "scale"]),
            (format!("{cube}material = \"red\"\n"), vec!["s.toml:3:", "material.red"]),
            (format!("{cube}{cube}{cube}"), vec![]),
            ("[[body]]\nmesh = \"cubee\"\n".into(), vec!["s.toml:2:", "'cube'"]),
            ("[[body]]\nmesh = \"none.obj\"\n".into(), vec!["s.toml:2:", "none.obj"]),
            ("[[body]]\n".into(), vec!["mesh"]),
            ("".into(), vec!["[[body]]"]),
            ("[[body]\n".into(), vec!["s.toml:1:"]),
            (format!("[camera]\nprojection = \"fish\"\n{cube}"), vec!["s.toml:2:", "'fisheye'"]),
            (
                format!("[material.a]\ncolor = \"#12\"\n{cube}material = \"a\"\n"),
                vec!["s.toml:2:", "#rrggbb"],
            ),
        ] {
            if parts.is_empty() {
                assert!(parse_scene(&text, Path::new("s.toml")).is_ok());
                continue;
            }
            let message = error(&text);
            for part in parts {
                assert!(message.contains(part), "{text}\n→ {message}\nlacks {part}");
            }
        }
    }
}
