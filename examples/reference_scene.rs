//! Turns a reference scene (JSON, see tests/reference/scenes) into OBJ, MTL and TOML that `terrell render` reads:
//!
//! `cargo run --example reference_scene tests/reference/scenes/cube_b090.json FOLDER`

#[path = "../tests/common/scene_json.rs"]
mod scene_json;

use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [json, folder] = arguments.as_slice() else {
        return Err("usage: reference_scene SCENE.json FOLDER".into());
    };
    std::fs::create_dir_all(folder)?;
    let json = serde_json::from_str(&std::fs::read_to_string(json)?)?;
    println!("{}", scene_json::write_scene(&json, Path::new(folder))?.display());
    Ok(())
}
