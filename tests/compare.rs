//! `terrell compare`, as its users meet it.

mod common;
#[path = "common/program.rs"]
mod program;
#[path = "common/scene_json.rs"]
mod scene_json;

use common::reference;
use program::{bad, good, pixels, terrell};
use serde_json::Value;
use std::path::Path;
use terrell::film::Film;
use terrell::picture;
use terrell::tone::Development;

const SMALL: &str = "--size=96x54";

fn files(folder: &Path) -> Vec<String> {
    let names = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn every_method_is_compared_and_all_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::create_dir(here.join("cube_compare")).unwrap();
    std::fs::write(here.join("cube_compare/mine.txt"), "mine").unwrap();
    let said = good(&["compare", "cube", SMALL, "--exr", "--json", "told.json"], here);
    for word in [
        "cube: 96x54 pinhole",
        "against ray tracing",
        "silhouette px (beyond)",
        "painter",
        "median of 3 runs",
    ] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let expected = [
        "apparent.exr",
        "apparent.png",
        "compare.json",
        "compare.png",
        "difference_apparent.png",
        "difference_exact.png",
        "difference_painter.png",
        "exact.exr",
        "exact.png",
        "mine.txt",
        "painter.exr",
        "painter.png",
        "seen_apparent.png",
        "seen_exact.png",
        "seen_painter.png",
        "trace.exr",
        "trace.png",
    ];
    let made = here.join("cube_compare");
    assert_eq!(files(&made), expected);
    assert_eq!(std::fs::read_to_string(made.join("mine.txt")).unwrap(), "mine");
    assert_eq!(json(&made.join("compare.json")), json(&here.join("told.json")));
    let told = &json(&made.join("compare.json"))["scenes"][0];
    let methods = told["methods"].as_array().unwrap();
    assert_eq!((methods.len(), &methods[0]["difference"]), (4, &Value::Null));
    let exact = &methods[1]["difference"];
    assert_eq!(
        (&exact["silhouette"]["pixels"], &exact["edges"]["pixels"]),
        (&0.into(), &0.into()),
        "{exact}"
    );
    assert_eq!(exact["radiance"]["worst_over_peak"], 0.0);
    for method in &methods[2..] {
        let found = &method["difference"];
        assert_eq!(found["silhouette"]["beyond_a_pixel"], 0, "{method}");
        assert!(found["silhouette"]["pixels"].as_u64().unwrap() > 0, "outlines within ¼ px are not the same");
        assert!(found["radiance"]["relative_rms"].as_f64().unwrap() > 1e-3);
        assert_eq!(found["radiance_same_face"]["worst_over_peak"].as_f64(), Some(0.0));
        assert!(found["flip"]["mean"].as_f64().unwrap() < 0.05);
        assert!(method["seconds"]["a_picture"].as_f64().unwrap() > 0.0);
    }
    // What is drawn is what render draws.
    good(&["render", "cube", SMALL, "-o", "r.exr", "--method", "trace"], here);
    assert_eq!(std::fs::read(here.join("r.exr")).unwrap(), std::fs::read(made.join("trace.exr")).unwrap());
    assert_eq!(pixels(made.join("seen_apparent.png")).dimensions(), (96, 54));
    assert!(pixels(made.join("compare.png")).width() > 3 * 96);
}

#[test]
fn several_scenes_have_a_folder_each_and_one_table() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let words = [
        "compare",
        "cube",
        "sphere",
        SMALL,
        "--methods",
        "apparent",
        "--repeats",
        "1",
        "--markdown",
        "-o",
        "out",
    ];
    let table = good(&words, here);
    let lines: Vec<&str> = table.lines().collect();
    assert!(lines[0].starts_with("| scene | method |") && lines[1].starts_with("|---|---|--:|"), "{table}");
    // The traced one is drawn to compare with.
    let rows: Vec<&str> = lines[2..].iter().map(|l| l.split(" | ").nth(1).unwrap()).collect();
    assert_eq!(rows, ["trace", "apparent", "trace", "apparent"]);
    let columns = |line: &str| line.matches('|').count();
    assert!(lines.iter().all(|l| columns(l) == columns(lines[0])), "{table}");
    assert_eq!(files(&here.join("out")), ["compare.json", "cube", "sphere"]);
    good(&["compare", "--all", "--size=32x18", "--repeats=1", "--no-pictures", "-q"], here);
    let told = json(&here.join("compare/compare.json"));
    let scenes: Vec<&str> =
        told["scenes"].as_array().unwrap().iter().map(|s| s["scene"].as_str().unwrap()).collect();
    assert!(scenes.contains(&"street") && !scenes.contains(&"sunlit"), "{scenes:?}");
    assert_eq!(files(&here.join("compare")), ["compare.json"]);
}

#[test]
fn shadows_are_spoken_of() {
    let folder = tempfile::tempdir().unwrap();
    let said = good(&["compare", "sunlit", SMALL, "--no-pictures", "--repeats=1"], folder.path());
    assert!(said.contains("note: the lights' shadows"), "{said}");
}

/// A file of ours, of another method, and one of the independent reference, which has `inner`.
#[test]
fn files_are_compared_with() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    good(&["render", "cube", SMALL, "-o", "r.exr", "-q", "--method=apparent"], here);
    let words = ["compare", "cube", "--reference", "r.exr", "--repeats=1", "-o", "out"];
    let said = good(&words, here);
    assert!(said.contains("96x54") && said.contains("against r.exr"), "{said}");
    let told = &json(&here.join("out/compare.json"))["scenes"][0];
    let apparent = &told["methods"][2];
    assert_eq!(
        (&apparent["method"], &apparent["difference"]["silhouette"]["pixels"]),
        (&"apparent".into(), &0.into())
    );
    assert_eq!(apparent["difference"]["radiance"]["worst_over_peak"], 0.0);
    assert_eq!(apparent["difference"]["faces_by"], "number");
    assert!(told["methods"][0]["difference"]["silhouette"]["pixels"].as_u64().unwrap() > 0);
}

/// Bodies as we number them, faces of polygons, and `inner`: where no outline is near, nothing differs but by rounding.
#[test]
fn the_independent_reference_is_compared_with() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for name in ["cube_b090", "opposed_b090"] {
        let text = std::fs::read_to_string(reference(&format!("scenes/{name}.json"))).unwrap();
        let scene = scene_json::write_scene(&serde_json::from_str(&text).unwrap(), here).unwrap();
        let file = reference(&format!("scenes/{name}.exr"));
        let words =
            ["compare", scene.to_str().unwrap(), "--reference", file.to_str().unwrap(), "--color=flat"];
        let said = good(&[&words[..], &["--repeats=1", "-o", name]].concat(), here);
        assert!(said.contains("160x120") && said.contains("trace, inner pixels"), "{said}");
        let told = &json(&here.join(name).join("compare.json"))["scenes"][0];
        for method in &told["methods"].as_array().unwrap()[..2] {
            let found = &method["difference"];
            assert_eq!(found["faces_by"], "what most of their pixels see");
            assert_eq!(found["silhouette"]["beyond_a_pixel"], 0);
            let inner = &found["inner"];
            assert_eq!(
                [&inner["silhouette"]["pixels"], &inner["edges"]["pixels"]],
                [0, 0],
                "{name}: {method}"
            );
            // Both are rounded to f32.
            for what in ["distance", "doppler"] {
                let worst = inner[what]["worst_relative"].as_f64().unwrap();
                assert!(worst <= 2.0 * f64::from(f32::EPSILON), "{name}, {what}: {worst}");
            }
            // So is light, D three times.
            assert!(inner["radiance"]["worst_over_peak"].as_f64().unwrap() <= 1e-6, "{name}: {inner}");
        }
    }
}

#[test]
fn what_a_reference_lacks_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let mut film = Film::new(32, 24);
    film.color.fill([0.5; 3]);
    film.color[5][1] = f32::NAN;
    picture::write(&film, &Development::default(), &here.join("nan.exr")).unwrap();
    let words = ["compare", "cube", "--reference", "nan.exr", "--repeats=1", "-o", "out"];
    let said = good(&words, here);
    assert!(said.contains("note: one pixel of the reference has numbers that are not finite"), "{said}");
    film.color.fill([f32::NAN; 3]);
    picture::write(&film, &Development::default(), &here.join("all.exr")).unwrap();
    let message = bad(&["compare", "cube", "--reference", "all.exr"], here);
    assert!(message.contains("no pixel has finite numbers"), "{message}");
}

#[test]
fn mistakes_are_explained_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    good(&["render", "cube", "--size=32x24", "-o", "r.exr", "-q"], here);
    let whole = std::fs::read(here.join("r.exr")).unwrap();
    std::fs::write(here.join("cut.exr"), &whole[..whole.len() / 2]).unwrap();
    std::fs::write(here.join("text.exr"), "no picture").unwrap();
    std::fs::write(here.join("empty.exr"), "").unwrap();
    std::fs::write(here.join("plain"), "a file").unwrap();
    let before = files(here);
    for (words, expected) in [
        (&["cube", "--reference", "none.exr"][..], &["none.exr"][..]),
        (&["cube", "--reference", "cut.exr"], &["cut.exr", "not whole"]),
        (&["cube", "--reference", "text.exr"], &["text.exr", "not an OpenEXR file"]),
        (&["cube", "--reference", "empty.exr"], &["empty.exr", "not an OpenEXR file"]),
        (&["cube", "--reference", "."], &["it is a folder"]),
        (&["cube", "--reference", "r.exr", "--size", "64x48"], &["32x24", "64x48", "--size"]),
        (&["cube", "gate", "--reference", "r.exr"], &["one scene"]),
        (&["--all", "--reference", "r.exr"], &["one scene"]),
        (&["cube", "--methods", "trace,magic"], &["'magic'", "painter"]),
        (&["cube", "--method", "trace"], &["--methods"]),
        (&["cube", "--raster", "skia"], &["--methods"]),
        (&["cube", "-o", "plain"], &["plain", "not a folder"]),
        (&["cube", "-o", "no/such"], &["no folder no"]),
        (&["cube", "cube"], &["two scenes are called 'cube'"]),
        (&["cub"], &["did you mean 'cube'"]),
        (&["cube", "--size", "0x10"], &["0x10"]),
        (&["cube", "--tolerance", "0"], &["--tolerance"]),
    ] {
        let message = bad(&[&["compare"][..], words].concat(), here);
        for part in expected {
            assert!(message.contains(part), "{words:?}: {message}");
        }
        assert_eq!(files(here), before, "{words:?}");
    }
    for words in [&["compare"][..], &["compare", "cube", "--repeats", "0"], &["compare", "cube", "--all"]] {
        assert_eq!(terrell(words, here).status.code(), Some(2));
    }
    // What is compared with is not written over.
    std::fs::create_dir(here.join("out")).unwrap();
    std::fs::write(here.join("out/trace.exr"), &whole).unwrap();
    let message = bad(&["compare", "cube", "--reference", "out/trace.exr", "-o", "out", "--exr"], here);
    assert!(message.contains("among what is read"), "{message}");
    assert_eq!(files(&here.join("out")), ["trace.exr"]);
}

#[test]
fn a_lamp_shut_in_is_refused_and_a_missing_sky_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let cube = "[camera]\nfov_deg = 36\n[[body]]\nname = \"cube\"\nmesh = \"cube\"\nposition = [0, 3, 0]\n";
    let lamp = "[[light]]\nname = \"lamp\"\nkind = \"point\"\nposition = [0, 3, 0]\nstrength = 5\n";
    std::fs::write(here.join("shut.toml"), format!("{cube}{lamp}")).unwrap();
    let said = bad(&["compare", "shut.toml", SMALL], here);
    assert!(said.contains("'lamp'") && said.contains("inside 'cube'"), "{said}");
    assert_eq!(files(here), ["shut.toml"]);
    std::fs::write(here.join("sky.toml"), format!("{cube}[sky]\ntexture = \"checker\"\n")).unwrap();
    let said = good(&["compare", "sky.toml", SMALL, "--no-pictures", "--repeats=1"], here);
    assert!(said.contains("note: the sky is not there but by trace and exact"), "{said}");
}

#[test]
fn curved_scenes_are_compared_with_files() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    good(&["render", "blackhole", "--size=48x27", "-o", "hole.exr"], here);
    let said = good(&["compare", "blackhole", "--reference", "hole.exr", "--repeats=1", "-o", "c"], here);
    assert!(said.contains("Kerr") || said.contains("black hole"), "{said}");
    let told = json(&here.join("c/compare.json"));
    let methods = told["scenes"][0]["methods"].as_array().unwrap();
    let trace = methods.iter().find(|m| m["method"] == "trace" || m["name"] == "trace").unwrap();
    assert_eq!(trace["difference"]["silhouette"]["pixels"], 0, "{trace}");
    assert!(bad(&["compare", "blackhole"], here).contains("--reference"));
}
