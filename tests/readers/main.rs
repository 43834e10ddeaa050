//! The readers of files meet hostile input: any bytes give an error, or what can be drawn; never a panic, nor
//! memory out of proportion to the input.
//!
//! Valid files are damaged in their bytes (here), in their tokens and values, and in their structure (`obj`,
//! `toml`, `gltf`), which reaches deeper than noise. The number of cases is bounded, so this runs everywhere;
//! PROPTEST_CASES=100000 searches longer.

mod gltf;
mod memory;
mod obj;
mod tokens;
mod toml;

use memory::peak;
use proptest::prelude::*;
use std::path::Path;
use terrell::color::Coloring;
use terrell::geodesic::{Celerity, Event, Tetrad};
use terrell::plan::Method;
use terrell::relativity::{ApparentMap, Motion};
use terrell::render::{Options, render};
use terrell::scene::{
    Imported, Lens, Projection, Scene, View, authored, framed, import, import_obj, parse_scene,
};
use terrell::spectrum::{Response, Shape, Spectrum, Tabulated};

/// Cases of a test, unless PROPTEST_CASES says otherwise.
fn cases(usual: u32) -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok());
    ProptestConfig { cases: asked.unwrap_or(usual), failure_persistence: None, ..ProptestConfig::default() }
}

const OBJ: &str = "# a comment\nmtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\ng part\nusemtl red\ns 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\nf -5 -4 -1\nf 1//1 3//1 5//1\nl 1 2\np 1\n";
const MTL: &str = "newmtl red\nKd 0.8 0.1 0.1\nKe 0 0 0\nd 1\nillum 2\n";
const TOML: &str = "[camera]\ntime = 0\nposition = [0, -3, 1]\nlook_at = [0, 0, 0]\nfov_deg = 60\nsize = [32, 24]\n[material.red]\ncolor = [1, 0, 0]\n[[body]]\nmesh = \"cube\"\nvelocity = [0.9, 0, 0]\nmaterial = \"red\"\nrotation = { axis = [0, 0, 1], angle_deg = 30 }\nscale = 2\n[[body]]\nname = \"other\"\nmesh = \"cube\"\ngamma = 3\ndirection = [0, 1, 0]\n";

fn gltf(uri: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"children":[1],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]}},{{"mesh":0,"rotation":[0,0,0,1]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"COLOR_0":1}},"indices":2,"material":0,"mode":4}}]}}],"materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[0.5,0.5,0.5,1]}}}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},{{"bufferView":1,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}},{{"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR","sparse":{{"count":1,"indices":{{"bufferView":2,"componentType":5123}},"values":{{"bufferView":2}}}}}}],"bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":12}},{{"buffer":0,"byteOffset":48,"byteLength":6}}],"buffers":[{{"byteLength":54{uri}}}]}}"#
    )
}

fn binary() -> Vec<u8> {
    let mut out: Vec<u8> =
        [0f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|f| f.to_le_bytes()).collect();
    out.extend([255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255]);
    out.extend([0u16, 1, 2].iter().flat_map(|i| i.to_le_bytes()));
    out
}

fn glb() -> Vec<u8> {
    let mut json = gltf("").into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = binary();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let mut out = b"glTF".to_vec();
    out.extend(2u32.to_le_bytes());
    out.extend((28 + json.len() as u32 + bin.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", bin)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

#[derive(Clone, Debug)]
enum Damage {
    Set(usize, u8),
    Cut(usize, usize),
    Double(usize, usize),
    Truncate(usize),
    /// The n-th number becomes another.
    Number(usize, &'static str),
}

fn damage() -> impl Strategy<Value = Vec<Damage>> {
    let nasty = prop::sample::select(vec![
        "-1",
        "0",
        "1",
        "2",
        "3",
        "7",
        "255",
        "65536",
        "4294967295",
        "4294967296",
        "18446744073709551615",
        "-9223372036854775808",
        "1e999",
        "nan",
        "inf",
        "0.5",
        "1e-320",
        "1e99",
        "\"x\"",
        "[]",
        "null",
        "5123",
        "5125",
        "5126",
    ]);
    let at = || 0usize..4000;
    prop::collection::vec(
        prop_oneof![
            (at(), any::<u8>()).prop_map(|(i, b)| Damage::Set(i, b)),
            (at(), 1usize..40).prop_map(|(i, n)| Damage::Cut(i, n)),
            (at(), 1usize..40).prop_map(|(i, n)| Damage::Double(i, n)),
            at().prop_map(Damage::Truncate),
            (at(), nasty.clone()).prop_map(|(i, n)| Damage::Number(i, n)),
            (at(), nasty).prop_map(|(i, n)| Damage::Number(i, n)),
        ],
        1..5,
    )
}

fn damaged(mut bytes: Vec<u8>, damages: &[Damage]) -> Vec<u8> {
    for damage in damages {
        if bytes.is_empty() {
            break;
        }
        let n = bytes.len();
        match *damage {
            Damage::Set(i, b) => bytes[i % n] = b,
            Damage::Cut(i, count) => drop(bytes.drain(i % n..(i % n + count).min(n))),
            Damage::Double(i, count) => {
                let piece = bytes[i % n..(i % n + count).min(n)].to_vec();
                bytes.splice(i % n..i % n, piece);
            }
            Damage::Truncate(i) => bytes.truncate(i % n),
            Damage::Number(which, other) => {
                let digit = |i: usize| bytes[i].is_ascii_digit();
                let starts: Vec<usize> = (0..n).filter(|&i| digit(i) && (i == 0 || !digit(i - 1))).collect();
                if let Some(&start) = starts.get(which % starts.len().max(1)) {
                    let end = (start..n).find(|&i| !digit(i)).unwrap_or(n);
                    bytes.splice(start..end, other.bytes());
                }
            }
        }
    }
    bytes
}

/// Bytes of memory a reader may take at its peak, for every byte of the input and besides. An empty line of an OBJ
/// file is kept as a string of its own, which costs 24 bytes (48 while the list grows), and a corner of a polygon,
/// `1 `, may become a triangle, with its colour and all that the parser underneath keeps.
const MOST_BYTES: (usize, usize) = (200, 100_000);

/// The most vertices, or triangles where there are more, that may be kept of so many bytes, as the docs have it.
fn most_vertices(bytes: usize) -> usize {
    2_000_000 + 16 * bytes
}

/// Bytes of memory a vertex may take with all that belongs to it, and a triangle, while lists grow.
const BYTES_A_VERTEX: usize = 250;

/// Reads a mesh: an error, or what can be drawn, in memory bounded by the input's size.
fn judge<E: std::fmt::Display>(input: usize, read: impl FnOnce() -> Result<Imported, E>) {
    let (read, peak) = peak(read);
    assert!(peak <= MOST_BYTES.0 * input + MOST_BYTES.1, "{peak} bytes of memory for {input} of input");
    match read {
        Ok(imported) => look_at(imported),
        Err(e) => assert!(!e.to_string().is_empty()),
    }
}

/// What can be read can be drawn, as the file has it and passing at 0.9c.
fn look_at(imported: Imported) {
    imported.parts.iter().for_each(|part| part.mesh.check().unwrap());
    let view = View { size: [32, 24], ..View::default() };
    draw(&authored("m", imported.clone(), None, view.clone()));
    let fast = Celerity::from_beta(0.9 * glam::DVec3::X).unwrap();
    draw(&framed("m", imported, fast, view));
}

/// An error or a picture, without what is no number. Flat: tables of spectra would take most of the time.
fn draw(scene: &Scene) {
    let _ = scene.check_animations();
    let Ok(mut camera) = scene.camera() else { return };
    camera.lens = Lens::new(Projection::Pinhole, 60.0, 32, 24).unwrap();
    for method in [Method::Exact, Method::Apparent, Method::Trace] {
        let (tolerance, most_pieces, coloring) = (1.0, 10_000, Coloring::Flat);
        let options = Options { tolerance, most_pieces, coloring, method, ..Default::default() };
        if let Ok((film, _)) = render(scene, &camera, &options, |_| ()) {
            assert!(film.distance.iter().chain(&film.doppler).all(|v| *v >= 0.0));
            assert!(film.color.iter().flatten().all(|v| v.is_finite()));
        }
    }
}

#[test]
fn the_undamaged_files_are_read() {
    import_obj(OBJ, MTL, "a.obj").unwrap();
    parse_scene(TOML, Path::new("a.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    std::fs::write(&path, glb()).unwrap();
    let mesh = import(&path).unwrap().into_mesh();
    assert_eq!(mesh.triangles.len(), 1);
    assert_eq!(mesh.corners(0)[1], glam::DVec3::new(2.0, 2.0, 3.0));
    std::fs::write(folder.path().join("a.bin"), binary()).unwrap();
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, gltf(",\"uri\":\"a.bin\"")).unwrap();
    assert_eq!(import(&path).unwrap().into_mesh(), mesh);
}

proptest! {
    #![proptest_config(cases(1000))]

    #[test]
    fn damaged_obj(damages in damage(), in_library: bool) {
        let (obj, mtl) = if in_library {
            (OBJ.to_owned(), String::from_utf8_lossy(&damaged(MTL.into(), &damages)).into_owned())
        } else {
            (String::from_utf8_lossy(&damaged(OBJ.into(), &damages)).into_owned(), MTL.to_owned())
        };
        judge(obj.len() + mtl.len(), || import_obj(&obj, &mtl, "a.obj"));
    }

    /// A table of a spectrum: an error that says something, or one that can be shifted.
    #[test]
    fn damaged_spectrum(damages in damage()) {
        let csv = "nm,value\n# a lamp\n400,0\n450.5,1e-3\n500,0.7\n560,1\n700,0.02\n";
        let text = String::from_utf8_lossy(&damaged(csv.into(), &damages)).into_owned();
        match Tabulated::parse(&text, "lamp.csv") {
            Err(e) => assert!(!e.to_string().is_empty()),
            Ok(table) => {
                let spectrum = Spectrum::of(Shape::Tabulated(std::sync::Arc::new(table)));
                if let Ok(response) = Response::of_own(&spectrum) {
                    for doppler in [1e-3, 0.5, 1.0, 3.0, 1e4] {
                        assert!(response.matrix(1.0, doppler).iter().flatten().all(|v| v.is_finite()));
                    }
                }
            }
        }
    }

    #[test]
    fn damaged_toml(damages in damage()) {
        let text = String::from_utf8_lossy(&damaged(TOML.into(), &damages)).into_owned();
        toml::judge(&text);
    }

    #[test]
    fn damaged_gltf(damages in damage(), as_binary: bool) {
        let whole = if as_binary { glb() } else { gltf(",\"uri\":\"a.bin\"").into_bytes() };
        gltf::judge(&damaged(whole, &damages), as_binary);
    }

    /// The map itself takes any numbers without complaint.
    #[test]
    fn any_numbers_can_be_mapped(x in prop::array::uniform3(any::<f64>()), u in prop::array::uniform3(any::<f64>())) {
        if let Ok(celerity) = Celerity::new(glam::DVec3::from_array(u)) {
            let map = ApparentMap::new(&Motion { celerity, origin: Event::origin() }, &Tetrad::of_world(Event::origin()));
            let _ = map.see(glam::DVec3::from_array(x));
        }
    }
}
