//! Scenes: the shipped ones damaged in tokens and values, and texts made to hurt.

use super::tokens::{changed, changes};
use super::{BYTES_A_VERTEX, MOST_BYTES, TOML, cases, draw, most_vertices, peak};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use std::path::Path;
use terrell::geodesic::Celerity;
use terrell::plan::Method;
use terrell::render::{Options, render};
use terrell::scene::{Speed, builtin_mesh, builtin_meshes, builtin_scenes, parse_scene};

/// Memory that reading the meshes that ship takes, for the file only names them: once each, and a copy a body.
fn of_meshes(text: &str) -> usize {
    let size = |name: &str| {
        let once = peak(|| builtin_mesh(name)).1;
        text.matches(name).count() * once
    };
    builtin_meshes().map(size).sum()
}

/// An error that says something, or a scene that can be drawn, as it is and at 0.9c.
pub fn judge(text: &str) {
    let (read, peak) = peak(|| parse_scene(text, Path::new("a.toml")));
    match read {
        Err(e) => {
            let message = e.to_string();
            assert!(
                message.starts_with("a.toml:") && message.len() < 1000 + text.len(),
                "{} bytes",
                message.len()
            );
        }
        Ok(mut scene) => {
            scene.bodies.iter().for_each(|body| body.mesh.check().unwrap());
            if scene.camera().is_err() {
                // A moment that cannot be had, at most.
                scene.view.nearest = None;
                scene.camera().unwrap();
            }
            scene.view.size = [32, 24];
            draw(&scene);
            scene
                .set_speed(Speed::Along(Celerity::from_beta(0.9 * glam::DVec3::X).unwrap().magnitude()))
                .unwrap();
            draw(&scene);
        }
    }
    if peak > MOST_BYTES.0 * text.len() + MOST_BYTES.1 {
        let allowed = MOST_BYTES.0 * text.len() + MOST_BYTES.1 + of_meshes(text);
        assert!(peak <= allowed, "{peak} bytes of memory for {} of input, {allowed} allowed", text.len());
    }
}

const NASTY: [&str; 46] = [
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e309",
    "1e99",
    "1e-320",
    "-0",
    "-0.0",
    "0",
    "1",
    "-1",
    "0.999999999999999999",
    "1e50",
    "1e-60",
    "9223372036854775807",
    "9223372036854775808",
    "4294967296",
    "4294967295",
    "0x7fffffff",
    "0b2",
    "1_000",
    "1__0",
    "true",
    "1979-05-27",
    "\"\"",
    "\"x\"",
    "\"cube\"",
    "\"globe\"",
    "\"../a.obj\"",
    "''",
    "\"\"\"\n",
    "[]",
    "[[]]",
    "{}",
    "{ a = 1 }",
    "[1]",
    "[1, 2]",
    "[0, 0, 0]",
    "[1, 2, 3, 4]",
    "[nan, inf, 0]",
    "[1e99, -1e99, 1e-320]",
    "#",
    "=",
    "\u{feff}",
];

/// A value of any size and depth.
fn value() -> impl Strategy<Value = String> {
    let deep = |open: &'static str, inner: &'static str, close: &'static str| {
        (1usize..3000).prop_map(move |n| open.repeat(n) + inner + &close.repeat(n))
    };
    prop_oneof![
        20 => select(NASTY.to_vec()).prop_map(str::to_owned),
        10 => prop::array::uniform3(select(vec!["0", "1", "-1", "1e-9", "1e40", "-1e99", "nan", "0.999", "-0.0"]))
            .prop_map(|v| format!("[{}]", v.join(", "))),
        1 => deep("[", "", "]"),
        1 => deep("{ a = ", "1", " }"),
        1 => (1usize..5000).prop_map(|n| format!("[{}]", "0, ".repeat(n))),
        1 => (1usize..5000).prop_map(|n| format!("\"{}\"", "x".repeat(n))),
        1 => (1usize..5000).prop_map(|n| "9".repeat(n)),
    ]
}

fn shipped() -> Vec<&'static str> {
    builtin_scenes().iter().map(|s| s.toml).chain([TOML]).collect()
}

/// The value of the n-th line that has one becomes another; or the line goes, or comes twice.
fn with_values(text: &str, changes: &[(Index, Option<String>, bool)]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (index, value, twice) in changes {
        let keys: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].contains('=')).collect();
        if keys.is_empty() {
            break;
        }
        let at = *index.get(&keys);
        match value {
            Some(value) => {
                let key = lines[at].split('=').next().unwrap().to_owned();
                lines[at] = format!("{key}= {value}");
            }
            None if *twice => lines.insert(at, lines[at].clone()),
            None => drop(lines.remove(at)),
        }
    }
    lines.join("\n")
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn other_tokens(scene in select(shipped()), changes in changes(&NASTY)) {
        judge(&changed(scene, &changes));
    }

    #[test]
    fn other_values(
        scene in select(shipped()),
        changes in prop::collection::vec((any::<Index>(), prop::option::weighted(0.8, value()), any::<bool>()), 1..4),
    ) {
        judge(&with_values(scene, &changes));
    }
}

/// Nesting of every kind the format has is refused before the stack ends.
#[test]
fn however_deep() {
    let body = "[[body]]\nmesh = \"cube\"\n";
    for n in [10, 100, 1000, 100_000] {
        for text in [
            format!("{body}scale = {}{}", "[".repeat(n), "]".repeat(n)),
            format!("{body}scale = {}", "[".repeat(n)),
            format!("{body}scale = {}1{}", "{a=".repeat(n), "}".repeat(n)),
            format!("{body}{}a = 1", "a.".repeat(n)),
            format!("{body}rotation = {{ {}a = 1 }}", "a.".repeat(n)),
            format!("[{}a]\n{body}", "a.".repeat(n)),
            format!("[material.{}a]\ncolor = [1, 0, 0]\n{body}", "a.".repeat(n)),
        ] {
            assert!(parse_scene(&text, Path::new("a.toml")).is_err());
            judge(&text);
        }
    }
}

/// Bodies of one mesh as it is share it.
#[test]
fn many_bodies_of_one_mesh() {
    let body = |i: usize| format!("[[body]]\nname = \"{i}\"\nmesh = \"lattice\"\nvelocity = [0.9, 0, 0]\n");
    let text: String = (0..1000).map(body).collect();
    let once = peak(|| builtin_mesh("lattice")).1;
    let (scene, most) = peak(|| parse_scene(&text, Path::new("a.toml")));
    assert_eq!(scene.unwrap().bodies.len(), 1000);
    assert!(most < 2 * once + MOST_BYTES.0 * text.len(), "{most} bytes, {once} for one mesh");
}

fn parse(text: &str) -> Result<terrell::scene::Scene, String> {
    parse_scene(text, Path::new("a.toml")).map_err(|e| e.to_string())
}

/// Bodies that look alike share a mesh.
#[test]
fn meshes_are_copied_once_a_look() {
    let red = "[material.red]\ncolor = [1, 0, 0]\n[material.blue]\ncolor = [0, 0, 1]\n";
    let looks = [
        "",
        "scale = 2\n",
        "scale = 2\nmaterial = \"red\"\n",
        "material = \"red\"\n",
        "material = \"blue\"\n",
        "rotation = { axis = [0, 0, 1], angle_deg = 30 }\n",
        "rotation = { axis = [0, 0, 1], angle_deg = 31 }\n",
    ];
    let body = |i: usize, look: &str| {
        format!("[[body]]\nname = \"{i}\"\nmesh = \"tram\"\nposition = [{i}, 0, 0]\n{look}")
    };
    let bodies: String = (0..70).map(|i| body(i, looks[i % looks.len()])).collect();
    let scene = parse(&format!("{red}{bodies}")).unwrap();
    for (i, a) in scene.bodies.iter().enumerate() {
        for (j, b) in scene.bodies.iter().enumerate() {
            assert_eq!(
                std::sync::Arc::ptr_eq(&a.mesh, &b.mesh),
                i % looks.len() == j % looks.len(),
                "{i} {j}"
            );
        }
    }
    // Other ways to say the same.
    let same = "[[body]]\nname = \"a\"\nmesh = \"tram\"\n[[body]]\nmesh = \"tram\"\nscale = [1, 1, 1]\nrotation = { axis = [1, 2, 3], angle_deg = 0 }\n";
    let scene = parse(same).unwrap();
    assert!(std::sync::Arc::ptr_eq(&scene.bodies[0].mesh, &scene.bodies[1].mesh));
}

/// Bodies each with a mesh of its own: as many as anyone needs, but not any number.
#[test]
fn meshes_of_their_own_are_bounded() {
    let body =
        |i: usize, scale: usize| format!("[[body]]\nname = \"{i}\"\nmesh = \"lattice\"\nscale = {scale}\n");
    let bodies =
        |count: usize, scale: fn(usize) -> usize| (0..count).map(|i| body(i, scale(i))).collect::<String>();
    assert_eq!(parse(&bodies(20, |i| i + 1)).unwrap().bodies.len(), 20);
    assert_eq!(parse(&bodies(1000, |_| 2)).unwrap().bodies.len(), 1000);
    let text = bodies(1000, |i| i + 1);
    let (read, most) = peak(|| parse(&text));
    let error = read.unwrap_err();
    for part in
        ["a.toml:", "vertices or triangles", "2000000, and 16 a byte", &text.len().to_string(), "share"]
    {
        assert!(error.contains(part), "{error}");
    }
    assert!(most <= most_vertices(text.len()) * BYTES_A_VERTEX, "{most} bytes");
}

/// What a body may have many of besides vertices: materials, and names; and long words that are almost right.
#[test]
fn much_besides_vertices_is_bounded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let parse = |text: &str| parse_scene(text, &path).map_err(|e| e.to_string());
    let library: String = (0..3000).map(|i| format!("newmtl {i}\nKd 1 0 0\n")).collect();
    std::fs::write(folder.path().join("a.mtl"), &library).unwrap();
    let object = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl 1\nf 1 2 3\n";
    std::fs::write(folder.path().join("a.obj"), object).unwrap();
    let body = |i: usize| format!("[[body]]\nname = \"{i}\"\nmesh = \"a.obj\"\nscale = {}\n", i + 1);
    let text: String = (0..3000).map(body).collect();
    let (read, most) = peak(|| parse(&text));
    assert!(read.unwrap_err().contains("vertices or triangles"));
    let input = text.len() + library.len() + object.len();
    assert!(most <= most_vertices(input) * BYTES_A_VERTEX, "{most} bytes");
    let word = "x".repeat(50_000);
    let text =
        format!("[material.{word}]\ncolor = [1, 0, 0]\n[[body]]\nmesh = \"cube\"\nmaterial = \"{word}y\"\n");
    judge(&text);
}

/// A body at rest is not cut, and may have more triangles than all together may be cut into.
#[test]
fn more_triangles_than_pieces() {
    let text =
        "[[body]]\nmesh = \"globe\"\nposition = [0, 9, 0]\n[[body]]\nmesh = \"cube\"\nposition = [0, 9, 3]\n";
    let render = |text: &str| {
        let scene = parse_scene(text, Path::new("a.toml")).unwrap();
        let options = Options { method: Method::Apparent, most_pieces: 1000, ..Options::default() };
        render(&scene, &scene.camera().unwrap(), &options, |_| ()).map(|(_, report)| report.pieces)
    };
    assert!(render(text).unwrap() > 1000);
    let error = render(&format!("{text}time = -9.5\nvelocity = [0.9, 0, 0]\n")).unwrap_err();
    assert!(error.to_string().contains("more than 1000 triangles"), "{error}");
}
