use super::Fault;
use super::velocity::of_resting;
use std::path::Path;
use terrell::geodesic::Celerity;
use terrell::scene::{
    Scene, Speed, View, authored, builtin_scene, framed, import, is_mesh_file, parse_scene, read_plain,
};

/// SCENE on the command line: the name of a scene that ships, a TOML file, or a mesh.
///
/// `lens` sets what the flags say of the lens and the size of the picture.
pub fn open(
    source: &str,
    speed: Option<Speed>,
    animation_rate: Option<f64>,
    lens: impl Fn(&mut View),
) -> Result<Scene, Fault> {
    let mut scene = read(source, speed, &lens)?;
    lens(&mut scene.view);
    if let Some(rate) = animation_rate {
        scene.set_animation_rate(rate);
    }
    scene.check_animations()?;
    Ok(scene)
}

fn read(source: &str, speed: Option<Speed>, lens: &dyn Fn(&mut View)) -> Result<Scene, Fault> {
    let missing = match builtin_scene(source) {
        Ok(builtin) => return with_speed(builtin.scene(), speed),
        Err(missing) => missing,
    };
    let path = Path::new(source);
    let is_toml = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    if is_toml {
        let text = read_plain(path).and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other));
        let text = text.map_err(|e| format!("{source}: {e}"))?;
        return with_speed(parse_scene(&text, path)?, speed);
    }
    if is_mesh_file(path) {
        let imported = import(path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let celerity = speed.map(of_resting).transpose()?;
        let mut view = View::default();
        lens(&mut view);
        if imported.moves() {
            return with_speed(authored(&name, imported, None, view), speed);
        }
        return Ok(match imported.view {
            Some(_) => authored(&name, imported, celerity, view),
            None => framed(&name, imported, celerity.unwrap_or(Celerity::at_rest()), view),
        });
    }
    let hint = missing.hint;
    Err(format!("'{source}' is no scene that ships, and no .toml, .obj, .gltf or .glb file; {hint}").into())
}

fn with_speed(mut scene: Scene, speed: Option<Speed>) -> Result<Scene, Fault> {
    if let Some(speed) = speed {
        scene.set_speed(speed)?;
    }
    Ok(scene)
}

/// The moment the flags ask for: a world time, or when a body appears abreast.
pub fn set_moment(scene: &mut Scene, time: Option<f64>, when: Option<&str>) -> Result<(), Fault> {
    let path = scene.animation.as_ref().and_then(|a| a.path.as_ref());
    match (time, path) {
        (Some(time), Some(path)) => scene.view = path.view_at_time(&scene.view, time),
        (None, Some(path)) if when.is_none() => {
            scene.view = path.view(&scene.view, path.clock_range()[0]);
            scene.notes.push("the camera is at the beginning of its path; --time says where else".into());
        }
        (Some(time), None) => scene.view.set_time(time)?,
        (None, _) => {}
    }
    if let Some(body) = when {
        scene.view.nearest = Some(body.to_owned());
    } else if is_still(scene) {
        // The scene's own moment has no meaning at rest; its time does.
        scene.view.nearest = None;
    }
    Ok(())
}

/// Whether neither bodies nor camera move.
fn is_still(scene: &Scene) -> bool {
    let moves = |c: &Celerity| c.direction().is_some();
    !moves(&scene.view.celerity) && !scene.bodies.iter().any(|b| moves(&b.motion.celerity))
}
