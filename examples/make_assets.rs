//! Writes the meshes that ship to `assets/`: `cargo run --example make_assets`. With `-- --large FILE.obj` it writes a mesh of
//! 320 000 triangles instead, of the size people download, which is too large to ship.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use terrell::scene::{Mesh, Paint, shapes};

fn main() -> std::io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, file] = &arguments[..]
        && flag == "--large"
    {
        let file = Path::new(file);
        let name = file.file_stem().and_then(|name| name.to_str()).unwrap_or("boulder");
        return write(name, &shapes::boulder(400), file.parent().unwrap_or(Path::new("")));
    }
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    for (name, make) in shapes::SHIPPED {
        write(name, &make(), &assets)?;
    }
    Ok(())
}

fn write(name: &str, mesh: &Mesh, folder: &Path) -> std::io::Result<()> {
    let (obj, mtl) = obj(name, mesh);
    std::fs::write(folder.join(format!("{name}.obj")), obj)?;
    std::fs::write(folder.join(format!("{name}.mtl")), mtl)?;
    println!("{name}: {} vertices, {} triangles", mesh.vertex_count(), mesh.triangles.len());
    Ok(())
}

/// OBJ and MTL, a material a colour; triangles keep their order.
fn obj(name: &str, mesh: &Mesh) -> (String, String) {
    let mut obj = format!("# made by examples/make_assets.rs; CC0\nmtllib {name}.mtl\n");
    let mut mtl = String::from("# Kd: linear sRGB\n");
    let round = |c: f64, digits: f64| (c * digits).round() / digits + 0.0;
    for v in 0..mesh.vertex_count() {
        let p = mesh.vertex(v as u32).to_array().map(|c| round(c, 1e6));
        write!(obj, "v {} {} {}", p[0], p[1], p[2]).unwrap();
        if let Paint::Vertices(colors) = &mesh.paint {
            let [r, g, b] = colors[v].map(|c| round(f64::from(c), 1e4));
            write!(obj, " {r} {g} {b}").unwrap();
        }
        obj.push('\n');
    }
    for normal in &mesh.normals {
        let [x, y, z] = normal.map(|c| round(f64::from(c), 1e6));
        writeln!(obj, "vn {x} {y} {z}").unwrap();
    }
    let corner = |v: u32| if mesh.normals.is_empty() { format!("{v}") } else { format!("{v}//{v}") };
    let mut materials = BTreeMap::new();
    let mut last = usize::MAX;
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|v| corner(v + 1));
        if !mesh.paint.is_of_faces() {
            writeln!(obj, "f {a} {b} {c}").unwrap();
            continue;
        }
        let color = mesh.color(t, [1.0, 0.0, 0.0], |_| [1.0; 3]);
        let key = color.map(|c| (c * 1e4).round() as u32);
        let next = materials.len();
        let material = *materials.entry(key).or_insert_with(|| {
            let [r, g, b] = key.map(|c| f64::from(c) / 1e4);
            writeln!(mtl, "newmtl c{next}\nKd {r} {g} {b}").unwrap();
            next
        });
        if material != last {
            writeln!(obj, "usemtl c{material}").unwrap();
            last = material;
        }
        writeln!(obj, "f {a} {b} {c}").unwrap();
    }
    (obj, mtl)
}
