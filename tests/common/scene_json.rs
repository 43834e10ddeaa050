//! Turns a scene of the independent reference (JSON) into what `terrell render` reads: OBJ, MTL and TOML.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

fn list(value: &Value) -> String {
    let numbers: Vec<String> =
        value.as_array().unwrap().iter().map(|v| format!("{:?}", v.as_f64().unwrap())).collect();
    format!("[{}]", numbers.join(", "))
}

/// Writes `<name>.toml` and the meshes it names into `folder`; returns the scene's path.
pub fn write_scene(json: &Value, folder: &Path) -> std::io::Result<PathBuf> {
    let camera = &json["camera"];
    let projection = match camera["projection"].as_str().unwrap() {
        "equirect" => "panorama",
        other => other,
    };
    let event = camera["event"].as_array().unwrap();
    let mut toml = format!(
        "[camera]\ntime = {:?}\nposition = {}\nforward = {}\nup = {}\nprojection = \"{projection}\"\nfov_deg = {:?}\nsize = [{}, {}]\n",
        event[0].as_f64().unwrap(),
        list(&event[1..].to_vec().into()),
        list(&camera["forward"]),
        list(&camera["up"]),
        camera["fov_deg"].as_f64().unwrap(),
        camera["width"],
        camera["height"],
    );
    for object in json["objects"].as_array().unwrap() {
        let name = object["name"].as_str().unwrap();
        let mut obj = format!("mtllib {name}.mtl\n");
        let mut mtl = String::new();
        for vertex in object["vertices"].as_array().unwrap() {
            let v: Vec<String> =
                vertex.as_array().unwrap().iter().map(|c| format!("{:?}", c.as_f64().unwrap())).collect();
            writeln!(obj, "v {}", v.join(" ")).unwrap();
        }
        let mut materials = BTreeMap::new();
        let triangles = object["triangles"].as_array().unwrap().iter();
        // What is lit has an albedo, what shines by itself an emission.
        let lit = json["lights"].as_array().is_some_and(|lights| !lights.is_empty());
        let colors = object[if lit { "albedo" } else { "emission" }].as_array().unwrap();
        for (corners, color) in triangles.zip(colors) {
            let next = materials.len();
            let material = *materials.entry(color.to_string()).or_insert_with(|| {
                let c = color.as_array().unwrap();
                writeln!(mtl, "newmtl m{next}\nKd {} {} {}", c[0], c[1], c[2]).unwrap();
                next
            });
            let corner = |i: usize| corners[i].as_u64().unwrap() + 1;
            writeln!(obj, "usemtl m{material}\nf {} {} {}", corner(0), corner(1), corner(2)).unwrap();
        }
        std::fs::write(folder.join(format!("{name}.obj")), obj)?;
        std::fs::write(folder.join(format!("{name}.mtl")), mtl)?;
        let offset = object["offset"].as_array().unwrap();
        write!(
            toml,
            "\n[[body]]\nname = \"{name}\"\nmesh = \"{name}.obj\"\ntime = {:?}\nposition = {}\ncelerity = {}\n",
            offset[0].as_f64().unwrap(),
            list(&offset[1..].to_vec().into()),
            list(&object["u"]),
        )
        .unwrap();
    }
    for light in json["lights"].as_array().into_iter().flatten() {
        assert_eq!(light["type"], "point");
        let numbers = |key: &str| -> Vec<f64> {
            light[key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
        };
        let (strength, u, at, offset) = (numbers("J")[0], numbers("u"), numbers("pos"), numbers("offset"));
        // The event of the lamp at time 0 of its own frame.
        let along: f64 = (0..3).map(|i| u[i] * at[i]).sum();
        let gamma = (1.0 + u.iter().map(|u| u * u).sum::<f64>()).sqrt();
        let place: Vec<f64> = (0..3).map(|i| offset[i + 1] + at[i] + u[i] * along / (1.0 + gamma)).collect();
        write!(
            toml,
            "\n[[light]]\nkind = \"point\"\nstrength = {strength:?}\ntime = {:?}\nposition = {place:?}\ncelerity = {u:?}\n",
            offset[0] + along,
        )
        .unwrap();
    }
    let path = folder.join(format!("{}.toml", json["name"].as_str().unwrap()));
    std::fs::write(&path, toml)?;
    Ok(path)
}
