use super::Fault;
use super::velocity::of_resting;
use std::path::Path;
use terrell::geodesic::Celerity;
use terrell::scene::{
    Choice, Scene, Speed, View, authored, builtin_scene, framed, has_scenes, import_choosing, is_mesh_file,
    parse_scene, read_plain,
};

/// SCENE on the command line: the name of a scene that ships, a TOML file, or a mesh.
///
/// `choice` is for glTF files only; `lens` sets what the flags say of the lens and the size of the picture.
pub fn open(
    source: &str,
    speed: Option<Speed>,
    choice: &Choice,
    animation_rate: Option<f64>,
    lens: impl Fn(&mut View),
) -> Result<Scene, Fault> {
    let mut scene = read(source, speed, choice, &lens)?;
    lens(&mut scene.view);
    if let Some(rate) = animation_rate {
        scene.set_animation_rate(rate);
    }
    scene.check_animations()?;
    Ok(scene)
}

fn read(
    source: &str,
    speed: Option<Speed>,
    choice: &Choice,
    lens: &dyn Fn(&mut View),
) -> Result<Scene, Fault> {
    let builtin = builtin_scene(source);
    let path = Path::new(source);
    let is_toml = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    if builtin.is_ok() || is_toml || (is_mesh_file(path) && !has_scenes(path)) {
        check_no_choice(source, is_toml, choice)?;
    }
    let missing = match builtin {
        Ok(builtin) => return with_speed(builtin.scene(), speed),
        Err(missing) => missing,
    };
    if is_toml {
        let text = read_plain(path).and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other));
        let text = text.map_err(|e| format!("{source}: {e}"))?;
        return with_speed(parse_scene(&text, path)?, speed);
    }
    if is_mesh_file(path) {
        let mut imported = import_choosing(path, choice)?;
        if imported.cameras > 1 && imported.view.is_some() && choice.camera.is_none() {
            let note = "the first with perspective is used; --file-camera takes another";
            imported.notes.push(format!("of {} cameras {note}", imported.cameras));
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let celerity = speed.map(of_resting).transpose()?;
        let mut view = View::default();
        lens(&mut view);
        if celerity.is_some_and(|c| c.moves()) && !imported.moves() && !imported.lights.is_empty() {
            imported.notes.push("the file's lights stay at rest while what they light moves; give them velocities in the file otherwise".into());
        }
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

/// Only glTF files have scenes and cameras to choose from.
fn check_no_choice(source: &str, is_toml: bool, choice: &Choice) -> Result<(), Fault> {
    let (flag, hint) = match choice {
        Choice { scene: Some(_), .. } if is_toml => {
            ("--file-scene", "; in it, a [[body]] may have a file_scene of its own")
        }
        Choice { scene: Some(_), .. } => ("--file-scene", ""),
        Choice { camera: Some(_), .. } => ("--file-camera", ""),
        Choice { scene: None, camera: None } => return Ok(()),
    };
    Err(format!("{flag} chooses within a .gltf or .glb file, and {source} is none{hint}").into())
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
    !scene.view.celerity.moves() && !scene.bodies.iter().any(|b| b.motion.celerity.moves())
}
