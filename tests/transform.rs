//! `terrell transform`: what it writes is what is seen, read back by others' readers and our own.

mod common;

use assert_cmd::Command;
use glam::{DVec2, DVec3, Vec3};
use std::path::Path;
use terrell::geodesic::{Celerity, Event};
use terrell::relativity::{ApparentMap, Motion};
use terrell::scene::{Mesh, builtin_mesh, builtin_scenes, import};

fn terrell(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("terrell").unwrap().current_dir(folder).arg("transform").args(arguments).assert()
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

struct Glb {
    file: gltf::Gltf,
}

impl Glb {
    fn open(path: &Path) -> Self {
        // Opens with all checks of the reader.
        Self { file: gltf::Gltf::open(path).unwrap() }
    }

    fn bytes(&self, accessor: &gltf::Accessor<'_>) -> Vec<u8> {
        let view = accessor.view().unwrap();
        let start = view.offset() + accessor.offset();
        self.file.blob.as_ref().unwrap()[start..start + accessor.count() * accessor.size()].to_vec()
    }

    fn floats<const N: usize>(&self, accessor: &gltf::Accessor<'_>) -> Vec<[f32; N]> {
        assert_eq!(accessor.size(), 4 * N);
        let values: Vec<f32> = self
            .bytes(accessor)
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        values.chunks_exact(N).map(|c| c.try_into().unwrap()).collect()
    }

    fn primitives(&self) -> Vec<gltf::Primitive<'_>> {
        self.file.meshes().flat_map(|m| m.primitives()).collect()
    }
}

fn attribute<'a>(primitive: &gltf::Primitive<'a>, name: &str) -> gltf::Accessor<'a> {
    use gltf::Semantic;
    let named = |s: &Semantic| match s {
        Semantic::Positions => name == "POSITION",
        Semantic::Normals => name == "NORMAL",
        Semantic::TexCoords(0) => name == "TEXCOORD_0",
        Semantic::Colors(0) => name == "COLOR_0",
        Semantic::Extras(extra) => format!("_{extra}") == name,
        _ => false,
    };
    primitive.attributes().find(|(s, _)| named(s)).unwrap_or_else(|| panic!("{name}")).1
}

/// Positions, normals and Doppler factors of the cube, against the map from outside.
#[test]
fn a_glb_is_what_is_seen() {
    let folder = folder();
    terrell(folder.path(), &["cube", "-o", "a.glb"]).success();
    let glb = Glb::open(&folder.path().join("a.glb"));
    let scene = builtin_scenes()[0].scene();
    let camera = scene.camera().unwrap();
    let map = ApparentMap::new(&scene.bodies[0].motion, &camera.observer);
    let [right, up, forward] = camera.observer.axes();
    let place = camera.observer.event().position();
    let mut count = 0;
    for primitive in glb.primitives() {
        let accessor = attribute(&primitive, "POSITION");
        let positions = glb.floats::<3>(&accessor);
        let least = positions.iter().copied().map(Vec3::from).reduce(Vec3::min).unwrap();
        let greatest = positions.iter().copied().map(Vec3::from).reduce(Vec3::max).unwrap();
        let range = |value: Option<gltf::json::Value>| -> Vec<f32> {
            value.unwrap().as_array().unwrap().iter().map(|v| v.as_f64().unwrap() as f32).collect()
        };
        assert_eq!(range(accessor.min()), least.to_array());
        assert_eq!(range(accessor.max()), greatest.to_array());
        let doppler = glb.floats::<1>(&attribute(&primitive, "_DOPPLER"));
        let normals = glb.floats::<3>(&attribute(&primitive, "NORMAL"));
        for ((position, doppler), normal) in positions.iter().zip(&doppler).zip(&normals) {
            let position = DVec3::from_array(position.map(f64::from));
            let offset = position - place;
            let seen = DVec3::new(offset.dot(right), offset.dot(up), offset.dot(forward));
            let (x_rest, sight) = map.unsee(seen);
            // On the surface of the cube, to 32-bit numbers at a distance of 3.
            assert!((x_rest.abs().max_element() - 0.5).abs() < 2e-6, "{x_rest}");
            assert!((f64::from(doppler[0]) / sight.doppler - 1.0).abs() < 1e-6);
            assert!((Vec3::from(*normal).length() - 1.0).abs() < 1e-6);
            count += 1;
        }
        let indices = glb.bytes(&primitive.indices().unwrap());
        let corner = |i: usize| {
            let at = u32::from_le_bytes(indices[4 * i..4 * i + 4].try_into().unwrap()) as usize;
            (Vec3::from(positions[at]), Vec3::from(normals[at]))
        };
        for triangle in 0..indices.len() / 12 {
            let [(a, n), (b, _), (c, _)] = [0, 1, 2].map(|i| corner(3 * triangle + i));
            // Counter-clockwise from outside.
            assert!((b - a).cross(c - a).dot(n) > 0.0);
        }
    }
    assert!(count > 100);
    let asset = &glb.file.document.as_json().asset;
    assert_eq!(asset.generator.as_deref(), Some(concat!("terrell ", env!("CARGO_PKG_VERSION"))));
    let extras: serde_json::Value = serde_json::from_str(asset.extras.as_ref().unwrap().get()).unwrap();
    let gamma = extras["terrell"]["bodies"][0]["gamma_relative_to_camera"].as_f64().unwrap();
    assert!((gamma - 1.0 / (1.0f64 - 0.81).sqrt()).abs() < 1e-12);
    // The camera looks where the picture does.
    let node = glb.file.nodes().find(|n| n.camera().is_some()).unwrap();
    let matrix = node.transform().matrix();
    let ahead = -DVec3::new(matrix[2][0].into(), matrix[2][1].into(), matrix[2][2].into());
    assert!((ahead - forward).length() < 1e-6);
}

fn close(a: &Mesh, b: &Mesh, tolerance: f64) {
    assert_eq!(a.triangles.len(), b.triangles.len());
    for t in 0..a.triangles.len() {
        for (p, q) in a.corners(t).into_iter().zip(b.corners(t)) {
            assert!((p - q).length() <= tolerance, "triangle {t}: {p} {q}");
        }
    }
}

/// Triangles sorted, since materials gather theirs.
fn sorted(mesh: &Mesh) -> Vec<[[i64; 3]; 3]> {
    let round = |v: DVec3| (v * 1e6).round().to_array().map(|c| c as i64);
    let mut all: Vec<_> = (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(round)).collect();
    all.sort_unstable();
    all
}

#[test]
fn at_rest_a_mesh_comes_out_as_it_went_in() {
    let folder = folder();
    let cube = builtin_mesh("cube").unwrap();
    // The scene that ships puts it at (0, 3, 0).
    let placed = cube.clone().placed(&glam::DAffine3::from_translation(DVec3::Y * 3.0));
    for file in ["a.glb", "a.obj"] {
        terrell(folder.path(), &["cube", "--beta", "0", "-o", file, "-q"]).success().stdout("");
        let read = import(&folder.path().join(file)).unwrap().into_mesh();
        assert_eq!(sorted(&read), sorted(&placed), "{file}");
    }
    let text = std::fs::read_to_string(folder.path().join("a.obj")).unwrap();
    // As many as the cube's file has; the reader gives every material its own.
    assert_eq!(text.lines().filter(|l| l.starts_with("v ")).count(), 8);
    // In the camera's axes it is straight ahead.
    terrell(folder.path(), &["cube", "--beta", "0", "--frame", "camera", "-o", "c.glb"]).success();
    let read = import(&folder.path().join("c.glb")).unwrap().into_mesh();
    assert!((read.centre() - DVec3::Z * -3.0).length() < 1e-6, "{}", read.centre());
}

#[test]
fn an_obj_is_read_again_as_the_glb_is() {
    let folder = folder();
    for scene in ["cube", "gate"] {
        for file in ["a.glb", "a.obj"] {
            terrell(folder.path(), &[scene, "-o", file, "--tolerance", "0.1"]).success();
        }
        let [glb, obj] = ["a.glb", "a.obj"].map(|f| import(&folder.path().join(f)).unwrap().into_mesh());
        // 32-bit numbers at distances up to 800.
        close(&glb, &obj, 5e-5);
        for t in 0..glb.triangles.len() {
            let color = |mesh: &Mesh| mesh.color(t, [1.0, 0.0, 0.0], |_| [0.0; 3]);
            let (a, b) = (Vec3::from(color(&glb)), Vec3::from(color(&obj)));
            assert!((a - b).length() < 1e-6, "{scene} {t}: {a} {b}");
        }
    }
}

/// A textured square: its texture coordinates say where in the rest frame a vertex is, so that the picture stays
/// where it was on the surface.
#[test]
fn texture_coordinates_and_pictures_are_kept() {
    let folder = folder();
    let at = folder.path();
    image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([60 * x as u8, 60 * y as u8, 7]))
        .save(at.join("p.png"))
        .unwrap();
    std::fs::write(at.join("s.mtl"), "newmtl m\nKd 1 1 1\nmap_Kd p.png\n").unwrap();
    let square = "mtllib s.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                  usemtl m\nf 1/1 2/2 3/3 4/4\n";
    std::fs::write(at.join("s.obj"), square).unwrap();
    let celerity = Celerity::from_beta(DVec3::X * 0.9).unwrap();
    for file in ["out.glb", "out.obj"] {
        terrell(at, &["s.obj", "--beta", "0.9", "-o", file]).success();
        let read = import(&at.join(file)).unwrap().into_mesh();
        let texture = read.material_of(0).unwrap().base_texture.clone().unwrap();
        assert_eq!(texture.picture.file, Some(std::fs::read(at.join("p.png")).unwrap()), "the same bytes");
        assert!(read.vertex_count() > 20);
        // The camera is at rest at the origin; where the centre is seen abreast follows from the scene's framing.
        let centre = (0..read.vertex_count())
            .min_by(|a, b| {
                let off = |i: usize| DVec2::from_array(read.uv[i].map(f64::from)).distance(DVec2::splat(0.5));
                off(*a).total_cmp(&off(*b))
            })
            .unwrap();
        let centre = read.vertex(centre as u32);
        let distance = -centre.z;
        let motion = Motion { celerity, origin: Event::new(-distance, 0.0, 0.0, -distance) };
        let observer =
            terrell::geodesic::Tetrad::new(Event::origin(), Celerity::at_rest(), -DVec3::Z, DVec3::Y)
                .unwrap();
        let map = ApparentMap::new(&motion, &observer);
        for v in 0..read.vertex_count() {
            let [u, w] = read.uv[v].map(f64::from);
            let seen = map.see(DVec3::new(2.0 * u - 1.0, 1.0 - 2.0 * w, 0.0)).position;
            let off = (seen * DVec3::new(1.0, 1.0, -1.0)).distance(read.vertex(v as u32));
            assert!(off < 1e-5, "{file} {v}: {off}");
        }
    }
}

#[test]
fn animations_are_morph_targets() {
    let folder = folder();
    let at = folder.path();
    let flags = ["cube", "--animation", "--frames", "5", "--time", "-1,1", "--fps", "10", "-o", "a.glb"];
    terrell(at, &[&flags[..], &["--color", "doppler", "--json", "a.json"]].concat()).success();
    let glb = Glb::open(&at.join("a.glb"));
    let json: serde_json::Value = serde_json::to_value(glb.file.document.as_json()).unwrap();
    assert_eq!(json["meshes"][0]["weights"].as_array().unwrap().len(), 4);
    let animation = glb.file.animations().next().unwrap();
    let channel = animation.channels().next().unwrap();
    let times = glb.floats::<1>(&channel.sampler().input());
    assert_eq!(times, [[0.0], [0.1], [0.2], [0.3], [0.4]]);
    let weights = glb.floats::<1>(&channel.sampler().output());
    assert_eq!(weights.len(), 20);
    assert_eq!(weights[8..12], [[0.0], [1.0], [0.0], [0.0]]);
    // The middle frame, alone, has its vertices on the same surfaces: compare the extent.
    terrell(at, &["cube", "--time", "0", "--tolerance", "1e-4", "-o", "b.glb"]).success();
    let alone = import(&at.join("b.glb")).unwrap().into_mesh().bounds().unwrap();
    let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
    for primitive in glb.primitives() {
        let base = glb.floats::<3>(&attribute(&primitive, "POSITION"));
        let target = primitive.morph_targets().nth(1).unwrap().positions().unwrap();
        for (base, moved) in base.iter().zip(glb.floats::<3>(&target)) {
            let at = Vec3::from(*base) + Vec3::from(moved);
            (low, high) = (low.min(at), high.max(at));
        }
    }
    assert!((low.as_dvec3() - alone.0).length() < 2e-3 && (high.as_dvec3() - alone.1).length() < 2e-3);
}

/// Huge offsets: the shape keeps its digits, in a node of its own.
#[test]
fn far_from_the_origin_the_shape_keeps_its_digits() {
    let folder = folder();
    let at = folder.path();
    let scene = "[camera]\nposition = [1e7, -3, 0]\n[[body]]\nmesh = \"cube\"\nposition = [1e7, 0, 0]\n";
    std::fs::write(at.join("far.toml"), scene).unwrap();
    terrell(at, &["far.toml", "-o", "far.glb"]).success();
    let read = import(&at.join("far.glb")).unwrap().into_mesh();
    let (low, high) = read.bounds().unwrap();
    assert!((high - low - DVec3::ONE).length() < 1e-6, "{low} {high}");
    assert!((read.centre() - DVec3::X * 1e7).length() < 1.0);
}

#[test]
fn ply_and_pov_hold_what_they_say() {
    let folder = folder();
    let at = folder.path();
    let json = |file: &str| -> serde_json::Value {
        let out = terrell(at, &["cube", "-o", file, "--json", "-"]).success().get_output().stdout.clone();
        serde_json::from_slice(&out).unwrap()
    };
    let done = json("a.ply");
    let bytes = std::fs::read(at.join("a.ply")).unwrap();
    let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let header = String::from_utf8(bytes[..end].to_vec()).unwrap();
    let (vertices, pieces) = (done["vertices"].as_u64().unwrap(), done["pieces"].as_u64().unwrap());
    assert!(header.contains(&format!("element vertex {vertices}\n")), "{header}");
    assert_eq!(bytes.len() as u64, end as u64 + vertices * 39 + pieces * 13);
    json("a.pov");
    let pov = std::fs::read_to_string(at.join("a.pov")).unwrap();
    assert!(pov.contains("assumed_gamma 1.0") && pov.contains("location <0,0,0>"));
    assert_eq!(pov.matches("mesh2 {").count(), 6);
}

#[test]
fn the_users_mistakes_are_explained() {
    let folder = folder();
    let at = folder.path();
    std::fs::write(at.join("empty.obj"), "").unwrap();
    std::fs::write(at.join("s.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let files = || std::fs::read_dir(at).unwrap().count();
    let before = files();
    for (arguments, part) in [
        (&["cube", "-o", "a.stl"][..], "'.stl'"),
        (&["cube", "-o", "a"], ".glb"),
        (&["cube", "-o", "no/a.glb"], "no folder no"),
        (&["cube", "-o", "."], "unknown mesh format"),
        (&["cube", "-o", "/proc/a.glb"], "/proc/a.glb"),
        (&["cube", "-o", "/proc/a.obj"], "/proc/a."),
        (&["cube", "-o", "a.glb", "--json", "no/a.json"], "no/a.json"),
        (&["cube", "-o", "a.glb", "--json", "/proc/a.json"], "/proc/a.json"),
        (&["cube", "-o", "a.glb", "--json", "./a.glb"], "both"),
        (&["cube", "-o", "a.obj", "--json", "a.mtl"], "both"),
        (&["s.obj", "-o", "./s.obj"], "what is read"),
        (&["empty.obj"], "no triangles"),
        (&["cuba"], "'cube'"),
        (&["cube", "--tolerance", "0"], "--tolerance"),
        (&["cube", "--tolerance", "-1"], "--tolerance"),
        (&["cube", "--tolerance", "1e-17"], "resolve"),
        (&["cube", "--tolerance", "1e-11"], "larger tolerance"),
        (&["cube", "--animation"], "--time"),
        (&["cube", "--animation", "--time", "1"], "T0,T1"),
        (&["cube", "--time", "0,1"], "--animation"),
        (&["cube", "--animation", "--time", "1,1"], "not before"),
        (&["cube", "--animation", "--time", "0,1", "--frames", "1"], "--frames"),
        (&["cube", "--animation", "--time", "0,1", "--fps", "0"], "--fps"),
        (&["cube", "--animation", "--time", "0,1", "-o", "a.obj"], "only .glb"),
        (&["cube", "--frames", "9"], "--animation"),
        (&["cube", "--when", "nearest dog"], "dog"),
        (&["cube", "--frame", "rest"], "camera"),
    ] {
        let output = terrell(at, arguments).code(2).get_output().clone();
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(part), "{arguments:?} says\n{message}which lacks '{part}'");
        assert!(!message.contains("panicked") && output.stdout.is_empty());
        assert_eq!(files(), before, "{arguments:?} left something behind");
    }
}

/// The validator of the format's authors, if `gltf_validator` is on the path; no errors and no warnings.
#[test]
#[ignore = "needs gltf_validator (github.com/KhronosGroup/glTF-Validator) on the path"]
fn the_validator_finds_nothing() {
    let folder = folder();
    for (scene, flags) in [
        ("cube", &[][..]),
        ("gate", &["--color", "doppler"]),
        ("lattice", &["--animation", "--frames", "4", "--time", "-1,1", "--color", "doppler"]),
    ] {
        terrell(folder.path(), &[&[scene, "-o", "a.glb"], flags].concat()).success();
        let output = std::process::Command::new("gltf_validator")
            .arg("-o")
            .arg(folder.path().join("a.glb"))
            .output()
            .unwrap();
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(
            (&report["issues"]["numErrors"], &report["issues"]["numWarnings"]),
            (&0.into(), &0.into()),
            "{scene}"
        );
    }
}

/// POV-Ray's picture of what we write is ours, away from outlines.
#[test]
#[ignore = "needs povray on the path"]
fn pov_ray_sees_what_we_see() {
    let folder = folder();
    let at = folder.path();
    for scene in ["cube", "gate"] {
        terrell(at, &[scene, "--size", "320x240", "-o", "a.pov", "--tolerance", "5e-3"]).success();
        Command::cargo_bin("terrell")
            .unwrap()
            .current_dir(at)
            .args(["render", scene, "--color", "geometry", "--size", "320x240", "-o", "ours.png"])
            .assert()
            .success();
        let flags = ["a.pov", "+W320", "+H240", "-A", "-D", "+FN8", "+Otheirs.png"];
        assert!(
            std::process::Command::new("povray")
                .current_dir(at)
                .args(flags)
                .output()
                .unwrap()
                .status
                .success()
        );
        let [ours, theirs] = ["ours.png", "theirs.png"].map(|f| image::open(at.join(f)).unwrap().to_rgb8());
        let (mut compared, mut sum) = (0u64, 0u64);
        for y in 1..239 {
            for x in 1..319 {
                let here = ours.get_pixel(x, y);
                let inner = (0..9).all(|i| ours.get_pixel(x + i % 3 - 1, y + i / 3 - 1) == here);
                if inner && here.0 != [0; 3] {
                    compared += 1;
                    sum += here
                        .0
                        .iter()
                        .zip(theirs.get_pixel(x, y).0)
                        .map(|(a, b)| u64::from(a.abs_diff(b)))
                        .max()
                        .unwrap();
                }
            }
        }
        assert!(compared > 5000 && sum < compared, "{scene}: {sum} over {compared}");
    }
}
