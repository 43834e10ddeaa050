use super::Fault;
use super::velocity::of_resting;
use std::path::Path;
use terrell::geodesic::Celerity;
use terrell::scene::{Scene, Speed, builtin_scenes, framed, import, is_mesh_file, parse_scene};

/// SCENE on the command line: the name of a scene that ships, a TOML file, or a mesh.
pub fn open(source: &str, speed: Option<Speed>) -> Result<Scene, Fault> {
    if let Some(builtin) = builtin_scenes().iter().find(|b| b.name == source) {
        return with_speed(builtin.scene(), speed);
    }
    let path = Path::new(source);
    let is_toml = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    if is_toml {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{source}: {e}"))?;
        return with_speed(parse_scene(&text, path)?, speed);
    }
    if is_mesh_file(path) {
        let imported = import(path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let celerity = speed.map_or(Ok(Celerity::at_rest()), of_resting)?;
        return Ok(framed(&name, imported.mesh, celerity, imported.notes));
    }
    let names: Vec<_> = builtin_scenes().iter().map(|b| b.name).collect();
    let nearest = names.iter().min_by_key(|n| strsim_distance(source, n));
    let hint = match nearest {
        Some(name) if strsim_distance(source, name) <= 2 => format!("did you mean '{name}'?"),
        _ => format!("scenes that ship: {}", names.join(", ")),
    };
    Err(format!("'{source}' is no scene that ships, and no .toml, .obj, .gltf or .glb file; {hint}").into())
}

fn with_speed(mut scene: Scene, speed: Option<Speed>) -> Result<Scene, Fault> {
    if let Some(speed) = speed {
        scene.set_speed(speed)?;
    }
    Ok(scene)
}

fn strsim_distance(a: &str, b: &str) -> usize {
    strsim::damerau_levenshtein(a, b)
}
