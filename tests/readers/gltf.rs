//! glTF and GLB, damaged as JSON values and as chunks.

use super::{BYTES_A_VERTEX, binary, cases, most_vertices, peak};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use serde_json::{Value, json};
use terrell::scene::import;

/// Bytes of a glTF (its buffer beside it) or GLB file: an error or what can be drawn.
pub fn judge(bytes: &[u8], as_binary: bool) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(if as_binary { "a.glb" } else { "a.gltf" });
    std::fs::write(folder.path().join("a.bin"), buffer()).unwrap();
    std::fs::write(&path, bytes).unwrap();
    super::judge(bytes.len() + buffer().len(), || import(&path));
}

/// As for the simple file, then normals, texture coordinates, a matrix, and times.
fn buffer() -> Vec<u8> {
    let mut out = binary();
    out.resize(56, 0);
    out.extend([0f32, 0., 1., 0., 0., 1., 0., 0., 1.].iter().flat_map(|f| f.to_le_bytes()));
    out.extend([0f32, 0., 1., 0., 0., 1.].iter().flat_map(|f| f.to_le_bytes()));
    out.extend([0f32; 16].iter().flat_map(|f| f.to_le_bytes()));
    out.extend([0f32, 0.5, 1.].iter().flat_map(|f| f.to_le_bytes()));
    out
}

/// A file with something of all that the format has.
fn whole(uri: Option<&str>) -> Value {
    let mut out = json!({
        "asset": {"version": "2.0", "generator": "test"},
        "extensionsUsed": ["KHR_materials_unlit", "KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "intensity": 9, "color": [1, 0.5, 0], "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}},
            {"type": "directional"}, {"type": "point", "range": 3}]}},
        "scene": 0,
        "scenes": [{"nodes": [0, 2]}, {"nodes": [3]}],
        "nodes": [
            {"children": [1], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]},
            {"mesh": 0, "rotation": [0, 0, 0, 1], "translation": [1, 2, 3], "scale": [1, 2, 1], "skin": 0, "weights": [0.5]},
            {"mesh": 1, "camera": 0, "name": "two", "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"mesh": 0}
        ],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1, "NORMAL": 3, "TEXCOORD_0": 4}, "indices": 2, "material": 0,
                "mode": 4, "targets": [{"POSITION": 0}]}], "weights": [0]},
            {"primitives": [{"attributes": {"POSITION": 5}, "mode": 5}, {"attributes": {"POSITION": 0}, "indices": 2, "mode": 6, "material": 1},
                {"attributes": {"POSITION": 0}, "mode": 1}]}
        ],
        "materials": [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": {"index": 0, "texCoord": 0}, "metallicFactor": 0},
                "emissiveFactor": [0, 0, 0], "alphaMode": "MASK", "alphaCutoff": 0.5, "normalTexture": {"index": 0, "scale": 1}},
            {"doubleSided": true, "extensions": {"KHR_materials_unlit": {}}, "extras": {"a": [1]}}
        ],
        "textures": [{"source": 0, "sampler": 0}],
        "images": [{"uri": "data:image/png;base64,iVBORw0KGgo="}, {"bufferView": 0, "mimeType": "image/png"}],
        "samplers": [{"magFilter": 9729, "wrapS": 10497}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "skins": [{"joints": [1], "inverseBindMatrices": 6}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
            "samplers": [{"input": 7, "output": 3, "interpolation": "LINEAR"}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4"},
            {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"},
            {"bufferView": 3, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 4, "componentType": 5126, "count": 3, "type": "VEC2"},
            {"componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1],
                "sparse": {"count": 3, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 0}}},
            {"bufferView": 5, "componentType": 5126, "count": 1, "type": "MAT4"},
            {"bufferView": 6, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [1]}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36, "target": 34962},
            {"buffer": 0, "byteOffset": 36, "byteLength": 12, "byteStride": 4},
            {"buffer": 0, "byteOffset": 48, "byteLength": 6},
            {"buffer": 0, "byteOffset": 56, "byteLength": 36},
            {"buffer": 0, "byteOffset": 92, "byteLength": 24},
            {"buffer": 0, "byteOffset": 116, "byteLength": 64},
            {"buffer": 0, "byteOffset": 180, "byteLength": 12}
        ],
        "buffers": [{"byteLength": buffer().len()}]
    });
    if let Some(uri) = uri {
        out["buffers"][0]["uri"] = uri.into();
    }
    out
}

#[derive(Clone, Debug)]
enum Change {
    /// The n-th value of its kind becomes this.
    Number(Index, Value),
    Text(Index, &'static str),
    Any(Index, Value),
    /// A key of an object, or an item of an array, goes.
    Remove(Index, Index),
    /// An item of an array comes so many times more.
    Repeat(Index, Index, usize),
    Rename(Index, Index, &'static str),
    /// Becomes a copy of another value.
    Copy(Index, Index),
    /// Arrays around it.
    Nest(Index, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let numbers = [
        json!(0),
        json!(1),
        json!(2),
        json!(3),
        json!(5),
        json!(6),
        json!(-1),
        json!(1_000_000_000),
        json!(4_294_967_295u64),
        json!(4_294_967_296u64),
        json!(u64::MAX),
        json!(i64::MIN),
        json!(0.5),
        json!(1e38),
        json!(1e39),
        json!(1e308),
        json!(5120),
        json!(5121),
        json!(5122),
        json!(5123),
        json!(5125),
        json!(5126),
        json!(65536),
        json!("NaN"),
        json!("Infinity"),
        json!(null),
    ];
    let texts = [
        "",
        "NaN",
        "VEC2",
        "VEC3",
        "VEC4",
        "MAT4",
        "SCALAR",
        "LINEAR",
        "a.bin",
        "../a.bin",
        ".",
        "a.gltf",
        "%",
        "%zz.bin",
        "\u{0}",
        "data:",
        "data:;base64,",
        "data:application/octet-stream;base64,AAAA",
        "data:;base64,****",
        "2.0",
        "3.0",
        "BLEND",
        "weights",
        "KHR_texture_transform",
        "ü",
    ];
    let keys = [
        "POSITION",
        "NORMAL",
        "COLOR_0",
        "TEXCOORD_0",
        "TEXCOORD_4294967296",
        "JOINTS_0",
        "_X",
        "_",
        "indices",
        "mode",
        "sparse",
        "bufferView",
        "children",
        "x",
    ];
    let anything = [
        json!(null),
        json!([]),
        json!({}),
        json!(true),
        json!([0]),
        json!([[]]),
        json!({"a": 0}),
        json!(0),
        json!("x"),
    ];
    let at = any::<Index>;
    prop_oneof![
        6 => (at(), select(numbers.to_vec())).prop_map(|(i, v)| Change::Number(i, v)),
        2 => (at(), select(texts.to_vec())).prop_map(|(i, t)| Change::Text(i, t)),
        1 => (at(), select(anything.to_vec())).prop_map(|(i, v)| Change::Any(i, v)),
        3 => (at(), at()).prop_map(|(i, j)| Change::Remove(i, j)),
        2 => (at(), at(), 1usize..5).prop_map(|(i, j, n)| Change::Repeat(i, j, n)),
        1 => (at(), at(), select(keys.to_vec())).prop_map(|(i, j, k)| Change::Rename(i, j, k)),
        1 => (at(), at()).prop_map(|(i, j)| Change::Copy(i, j)),
        1 => (at(), 1usize..200).prop_map(|(i, n)| Change::Nest(i, n)),
    ]
}

/// Where every value is that passes.
fn places(value: &Value, passes: fn(&Value) -> bool) -> Vec<String> {
    let mut out = Vec::new();
    let mut waiting = vec![(String::new(), value)];
    while let Some((place, value)) = waiting.pop() {
        match value {
            Value::Array(items) => {
                waiting.extend(items.iter().enumerate().map(|(i, v)| (format!("{place}/{i}"), v)))
            }
            Value::Object(items) => waiting.extend(items.iter().map(|(k, v)| (format!("{place}/{k}"), v))),
            _ => {}
        }
        if passes(value) {
            out.push(place);
        }
    }
    out
}

fn at<'a>(value: &'a mut Value, index: &Index, passes: fn(&Value) -> bool) -> Option<&'a mut Value> {
    let places = places(value, passes);
    if places.is_empty() { None } else { value.pointer_mut(&places[index.index(places.len())]) }
}

fn apply(value: &mut Value, change: &Change) {
    let holds = |v: &Value| {
        v.as_array().is_some_and(|a| !a.is_empty()) || v.as_object().is_some_and(|o| !o.is_empty())
    };
    let key = |object: &serde_json::Map<String, Value>, index: &Index| {
        object.keys().nth(index.index(object.len())).unwrap().clone()
    };
    match change {
        Change::Number(i, other) => {
            if let Some(v) = at(value, i, Value::is_number) {
                *v = other.clone();
            }
        }
        Change::Text(i, other) => {
            if let Some(v) = at(value, i, Value::is_string) {
                *v = (*other).into();
            }
        }
        Change::Any(i, other) => {
            if let Some(v) = at(value, i, |_| true) {
                *v = other.clone();
            }
        }
        Change::Remove(i, j) => match at(value, i, holds) {
            Some(Value::Array(items)) => drop(items.remove(j.index(items.len()))),
            Some(Value::Object(items)) => drop(items.remove(&key(items, j))),
            _ => {}
        },
        Change::Repeat(i, j, times) => {
            if let Some(Value::Array(items)) = at(value, i, |v| v.as_array().is_some_and(|a| !a.is_empty())) {
                let again = j.get(items).clone();
                items.extend(std::iter::repeat_n(again, *times));
            }
        }
        Change::Rename(i, j, name) => {
            if let Some(Value::Object(items)) = at(value, i, |v| v.as_object().is_some_and(|o| !o.is_empty()))
            {
                let held = items.remove(&key(items, j)).unwrap();
                items.insert((*name).to_owned(), held);
            }
        }
        Change::Copy(i, j) => {
            let other = at(value, j, |_| true).map(|v| v.clone());
            if let (Some(v), Some(other)) = (at(value, i, |_| true), other) {
                *v = other;
            }
        }
        Change::Nest(i, depth) => {
            if let Some(v) = at(value, i, |_| true) {
                for _ in 0..*depth {
                    *v = json!([v.take()]);
                }
            }
        }
    }
}

/// A chunk's type and contents.
type Chunk = ([u8; 4], Vec<u8>);

/// A GLB of these chunks, its lengths true.
fn glb(chunks: &[Chunk]) -> Vec<u8> {
    let mut body = Vec::new();
    for (kind, contents) in chunks {
        let blank = if kind == b"JSON" { b' ' } else { 0 };
        let mut contents = contents.clone();
        contents.resize(contents.len().next_multiple_of(4), blank);
        body.extend((contents.len() as u32).to_le_bytes());
        body.extend(kind);
        body.extend(contents);
    }
    let mut out = b"glTF".to_vec();
    out.extend(2u32.to_le_bytes());
    out.extend((12 + body.len() as u32).to_le_bytes());
    out.extend(body);
    out
}

/// What happens to a GLB: to its chunks, then to a 32-bit word, a byte, and its length.
type Damage = (Vec<(Index, u8, Vec<u8>)>, Option<(Index, u32)>, Option<(Index, u8)>, Option<Index>);

fn damage() -> impl Strategy<Value = Damage> {
    let word = select(vec![
        0u32,
        1,
        2,
        3,
        4,
        11,
        12,
        20,
        28,
        0x7fff_ffff,
        0x8000_0000,
        0xffff_fff0,
        0xffff_ffff,
        0x4e4f_534a,
        0x004e_4942,
    ]);
    (
        prop::collection::vec((any::<Index>(), any::<u8>(), prop::collection::vec(any::<u8>(), 0..9)), 0..3),
        prop::option::of((any::<Index>(), word)),
        prop::option::of((any::<Index>(), any::<u8>())),
        prop::option::weighted(0.2, any::<Index>()),
    )
}

fn damaged(mut chunks: Vec<Chunk>, (of_chunks, word, byte, end): &Damage) -> Vec<u8> {
    for (index, what, bytes) in of_chunks {
        if chunks.is_empty() {
            break;
        }
        let at = index.index(chunks.len());
        match what % 6 {
            0 => drop(chunks.remove(at)),
            1 => chunks.insert(at, chunks[at].clone()),
            2 => chunks.reverse(),
            3 => chunks[at].0 = [bytes.first().copied().unwrap_or(0), b'I', b'N', 0],
            4 => chunks[at].1.clone_from(bytes),
            _ => chunks.insert(at, (*b"XXXX", bytes.clone())),
        }
    }
    let mut out = glb(&chunks);
    if let Some((index, word)) = word {
        let at = 4 * index.index(out.len() / 4);
        out[at..at + 4].copy_from_slice(&word.to_le_bytes());
    }
    if let Some((index, byte)) = byte {
        let at = index.index(out.len());
        out[at] = *byte;
    }
    if let Some(end) = end {
        out.truncate(end.index(out.len()));
    }
    out
}

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn other_values(changes in prop::collection::vec(change(), 1..5), as_binary: bool) {
        let mut json = whole((!as_binary).then_some("a.bin"));
        changes.iter().for_each(|change| apply(&mut json, change));
        let json = json.to_string().into_bytes();
        if as_binary {
            judge(&glb(&[(*b"JSON", json), (*b"BIN\0", buffer())]), true);
        } else {
            judge(&json, false);
        }
    }

    #[test]
    fn other_chunks(damage in damage()) {
        let json = whole(None).to_string().into_bytes();
        judge(&damaged(vec![(*b"JSON", json), (*b"BIN\0", buffer())], &damage), true);
    }
}

#[test]
fn the_whole_file_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    let json = whole(None).to_string().into_bytes();
    std::fs::write(&path, glb(&[(*b"JSON", json), (*b"BIN\0", buffer())])).unwrap();
    let mesh = import(&path).unwrap().into_mesh();
    // A triangle; a strip of four; a fan of three.
    assert_eq!(mesh.triangles.len(), 1 + 2 + 1);
    assert_eq!(mesh.vertex_count(), 3 + 4 + 3);
}

/// What is named many times is kept once.
#[test]
fn however_often() {
    let mut json = whole(None);
    json["buffers"] = vec![json!({"byteLength": 1}); 2000].into();
    let bytes = glb(&[(*b"JSON", json.to_string().into_bytes()), (*b"BIN\0", vec![0; 100_000])]);
    judge(&bytes, true);
    let mut json = whole(Some("a.gltf"));
    json["buffers"] = vec![json!({"byteLength": 1, "uri": "a.gltf"}); 2000].into();
    judge(&json.to_string().into_bytes(), false);
}

/// A file whose mesh, a list of corners of triangles, is used by so many nodes; and the buffer beside it.
fn used_often(corners: usize, times: usize, strip: bool) -> (String, Vec<u8>) {
    let floats = (0..3 * corners).map(|i| (i * i % 97) as f32);
    let mut buffer: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
    let length = buffer.len();
    buffer.extend((0..corners).map(|i| (i % 251) as u8));
    let mut primitive = json!({"attributes": {"POSITION": 0}});
    if strip {
        primitive = json!({"attributes": {"POSITION": 0}, "indices": 1, "mode": 5});
    }
    let json = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": (0..times).collect::<Vec<_>>()}],
        "nodes": vec![json!({"mesh": 0}); times],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": corners, "type": "VEC3", "min": [0, 0, 0], "max": [96, 96, 96]},
            {"bufferView": 1, "componentType": 5121, "count": corners, "type": "SCALAR"}
        ],
        "bufferViews": [{"buffer": 0, "byteLength": length}, {"buffer": 0, "byteOffset": length, "byteLength": corners}],
        "buffers": [{"byteLength": buffer.len(), "uri": "a.bin"}]
    });
    (json.to_string(), buffer)
}

/// The error, if any, of a file with its buffer beside it; in memory that the bound allows.
fn read_bounded(json: &str, buffer: &[u8]) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gltf");
    std::fs::write(folder.path().join("a.bin"), buffer).unwrap();
    std::fs::write(&path, json).unwrap();
    let (read, most) = peak(|| import(&path));
    let input = json.len() + buffer.len();
    assert!(most <= most_vertices(input) * BYTES_A_VERTEX, "{most} bytes of memory for {input} of input");
    read.err().map(|e| e.to_string())
}

/// A mesh used many times is kept many times, but not any number.
#[test]
fn used_however_often() {
    // A statue, ten times.
    let (json, buffer) = used_often(300_000, 10, false);
    assert_eq!(read_bounded(&json, &buffer), None);
    for strip in [false, true] {
        let (json, buffer) = used_often(3000, 600, strip);
        assert_eq!(read_bounded(&json, &buffer), None);
        let (json, buffer) = used_often(3000, 3000, strip);
        let error = read_bounded(&json, &buffer).unwrap();
        let bytes = (json.len() + buffer.len()).to_string();
        for part in ["a.gltf: ", "vertices or triangles", &bytes, "2000000, and 16 a byte", "less often"] {
            assert!(error.contains(part), "{error}");
        }
    }
}

/// What hangs on much that is animated has all of that above it; channels share what they read.
#[test]
fn animated_however_deep() {
    let animated = |nodes: Vec<Value>, channels: usize, keys: usize| {
        let times = (0..keys).flat_map(|i| (i as f32).to_le_bytes());
        let mut buffer: Vec<u8> = times.collect();
        buffer.resize(buffer.len() + 12 * keys.max(3), 0);
        let channel = |i: usize| json!({"sampler": 0, "target": {"node": i, "path": "translation"}});
        let json = json!({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": nodes,
            "meshes": [{"primitives": [{"attributes": {"POSITION": 1}}]}],
            "animations": [{"samplers": [{"input": 0, "output": 2}], "channels": (0..channels).map(channel).collect::<Vec<_>>()}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": keys, "type": "SCALAR", "min": [0], "max": [keys - 1]},
                {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]},
                {"bufferView": 1, "componentType": 5126, "count": keys, "type": "VEC3"}
            ],
            "bufferViews": [{"buffer": 0, "byteLength": 4 * keys}, {"buffer": 0, "byteOffset": 4 * keys, "byteLength": 12 * keys.max(3)}],
            "buffers": [{"byteLength": buffer.len(), "uri": "a.bin"}]
        });
        read_bounded(&json.to_string(), &buffer)
    };
    // A chain of which every link has a mesh.
    let chain = |count: usize| {
        let link = |i: usize| {
            if i + 1 < count { json!({"mesh": 0, "children": [i + 1]}) } else { json!({"mesh": 0}) }
        };
        (0..count).map(link).collect::<Vec<_>>()
    };
    assert_eq!(animated(chain(100), 100, 10), None);
    assert!(animated(chain(3000), 3000, 2).unwrap().contains("vertices or triangles"));
    // Many that share a long animation.
    let many = |count: usize| {
        let children: Vec<_> = (1..count).collect();
        let first = json!({"mesh": 0, "children": children});
        std::iter::once(first).chain((1..count).map(|_| json!({"mesh": 0}))).collect::<Vec<_>>()
    };
    assert_eq!(animated(many(50), 50, 1000), None);
    assert!(animated(many(1000), 1000, 10_000).unwrap().contains("vertices or triangles"));
    // A long chain with many children, none of them animated.
    let mut nodes = chain(500);
    nodes[499]["children"] = (500..4000).collect::<Vec<_>>().into();
    nodes.extend(vec![json!({}); 3500]);
    assert_eq!(animated(nodes, 500, 2), None);
}

/// Every value of the file in turn, replaced by everything it might wrongly be, or taken out.
#[test]
fn one_thing_wrong() {
    let wrong = [
        json!(null),
        json!(0),
        json!(-1),
        json!(1_000_000_000),
        json!(4_294_967_296u64),
        json!(0.5),
        json!(1e308),
        json!(""),
        json!("x"),
        json!("NaN"),
        json!([]),
        json!({}),
        json!(true),
    ];
    for as_binary in [false, true] {
        let good = whole((!as_binary).then_some("a.bin"));
        for place in places(&good, |_| true) {
            let judge = |json: &Value| {
                let json = json.to_string().into_bytes();
                let bytes = if as_binary { glb(&[(*b"JSON", json), (*b"BIN\0", buffer())]) } else { json };
                judge(&bytes, as_binary);
            };
            for other in &wrong {
                let mut json = good.clone();
                *json.pointer_mut(&place).unwrap() = other.clone();
                judge(&json);
            }
            let Some((parent, key)) = place.rsplit_once('/') else { continue };
            let mut json = good.clone();
            match json.pointer_mut(parent).unwrap() {
                Value::Object(items) => drop(items.remove(key)),
                Value::Array(items) => drop(items.remove(key.parse::<usize>().unwrap())),
                _ => unreachable!("only these hold others"),
            }
            judge(&json);
        }
    }
}
