//! Colours, lights and exposures of the command, as its users meet them.

mod common;
#[path = "common/program.rs"]
mod program;

use common::read_exr;
use program::{bad, good, pixels};
use serde_json::Value;
use std::path::Path;

fn json(words: &[&str], folder: &Path) -> Value {
    serde_json::from_str(&good(&[words, &["--json", "-", "-q"]].concat(), folder)).unwrap()
}

const SMALL: &str = "--size=64x48";

#[test]
fn spectral_is_usual_and_all_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let told = json(&["render", "hot", SMALL], here);
    assert_eq!(told["color"], "spectral");
    assert_eq!(told["doppler_at"], "pixel");
    assert_eq!(told["tone"], "filmic");
    assert!(told["exposure_ev"].as_f64().unwrap() < -3.0, "{told}");
    let table = &told["spectra"][0];
    assert_eq!(
        (&table["spectrum"], &table["beyond_visible"]),
        (&"black body of 4500 K".into(), &"grey".into())
    );
    assert!(table["greatest_error"].as_f64().unwrap() <= 1e-4 && table["nodes"].as_u64().unwrap() > 20);
    let line = good(&["render", "hot", SMALL], here);
    assert!(line.contains("spectral colour at -") && line.contains("EV, filmic"), "{line}");
    let line = good(&["render", "hot", SMALL, "--color", "geometry"], here);
    assert!(line.contains("geometry colour,") && !line.contains("EV"), "{line}");
    let vertex = json(&["render", "hot", SMALL, "--doppler", "vertex"], here);
    assert_eq!(vertex["doppler_at"], "vertex");
    let lit = json(&["render", "sunlit", SMALL], here);
    assert_eq!(lit["lights"][0]["kind"], "distant");
    assert_eq!(lit["lights"][1]["kind"], "ambient");
    assert_eq!(lit["notes"], serde_json::json!([]), "nothing of it is left out");
}

/// White-hot ahead turns blue-white, behind it red: at the bottom of the picture what comes, at the top what goes.
#[test]
fn what_comes_is_blue_and_what_goes_is_red() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    good(&["render", "hot", "-o", "hot.exr", "--size=160x90"], here);
    let film = read_exr(&here.join("hot.exr"));
    let [mut coming, mut going] = [0; 2];
    for i in (0..film["body"].len()).filter(|&i| film["body"][i] >= 0.0) {
        let (d, r, b) = (film["doppler"][i], film["R"][i], film["B"][i]);
        if d > 1.6 {
            coming += 1;
            // Hotter than the white of the screen.
            assert!(b > r && r > 5.0, "{d} {r} {b}");
        }
        if d < 0.8 {
            going += 1;
            assert!(r > 1.8 * b && r < 0.5, "{d} {r} {b}");
        }
    }
    assert!(coming > 300 && going > 300, "{coming} {going}");
}

#[test]
fn exposures_are_chosen_and_exr_files_have_the_light_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let ev = |words: &[&str]| {
        let told = json(&[&["render", "lattice", SMALL, "--color", "flat"], words].concat(), here);
        told["exposure_ev"].as_f64().unwrap()
    };
    assert_eq!(ev(&["--exposure", "-2.5"]), -2.5);
    let (auto, rest) = (ev(&[]), ev(&["--exposure", "rest"]));
    assert_eq!(auto, ev(&["--exposure", "auto"]));
    // Ahead it is 4.36³ = 83 times as bright.
    assert!(auto < -2.0 && rest.abs() < 1.0, "{auto} {rest}");
    // The same picture by the number that was told.
    let words = ["render", "lattice", SMALL, "-q", "-o"];
    good(&[&words[..], &["a.png"]].concat(), here);
    let told = json(&["render", "lattice", SMALL, "-o", "a.png"], here)["exposure_ev"].to_string();
    good(&[&words[..], &["b.png", "--exposure", &told]].concat(), here);
    assert_eq!(pixels(here.join("a.png")), pixels(here.join("b.png")));
    good(&[&words[..], &["c.png", "--exposure", "3", "--tone", "linear"]].concat(), here);
    assert_ne!(pixels(here.join("a.png")), pixels(here.join("c.png")));
    for (file, exposure) in [("a.exr", "0"), ("b.exr", "7")] {
        good(&[&words[..], &[file, "--exposure", exposure]].concat(), here);
    }
    assert_eq!(std::fs::read(here.join("a.exr")).unwrap(), std::fs::read(here.join("b.exr")).unwrap());
    for exposure in ["bright", "nan", "1e9", ""] {
        let message = bad(&["render", "cube", "--exposure", exposure], here);
        assert!(message.contains("EV") && message.contains("auto"), "{message}");
    }
    let dark = good(&["render", "gate_back", SMALL], here);
    assert!(dark.contains("too dark to be seen"), "{dark}");
}

#[test]
fn a_film_has_one_exposure_unless_asked() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let film = |words: &[&str]| {
        json(&[&["animate", "lattice", "--frames", "5", "--size=32x24"], words].concat(), here)
    };
    let told = film(&["-o", "one/"]);
    let ev = told["takes"][0]["exposure_ev"][0].as_f64().unwrap();
    // The same surface is as bright in every frame: at one EV all frames can be drawn again one by one.
    film(&["-o", "again/", "--exposure", &ev.to_string()]);
    let frame = |which: &str, i: usize| pixels(here.join(format!("{which}/frame_{i:05}.png")));
    assert!((0..5).all(|i| frame("one", i) == frame("again", i)));
    let told = film(&["-o", "each/", "--exposure", "each"]);
    assert_eq!(told["takes"][0]["exposure_ev"][0], Value::Null);
    assert!((0..5).any(|i| frame("one", i) != frame("each", i)));
    let beside = film(&["-o", "two/", "--beside-standard"]);
    assert_eq!(beside["takes"][0]["exposure_ev"].as_array().unwrap().len(), 2);
}

#[test]
fn a_legend_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (color, lower) in [("doppler", true), ("spectral", false)] {
        let words = ["render", "cube", "--size=320x180", "-q", "--color", color, "-o"];
        good(&[&words[..], &["plain.png"]].concat(), here);
        good(&[&words[..], &["legend.png", "--legend"]].concat(), here);
        let (plain, legend) = (pixels(here.join("plain.png")), pixels(here.join("legend.png")));
        let changed = |x: u32, y: u32| plain.get_pixel(x, y) != legend.get_pixel(x, y);
        let count = (0..320 * 180).filter(|i| changed(i % 320, i / 320)).count();
        assert!(count > 200, "{color}: {count}");
        assert!((0..320 * 90).all(|i| !changed(i % 320, 90 + i / 320)), "at the top");
        // The scale of false colours: blue at its right, red at its left.
        let rows = (0..60).filter(|&y| {
            let (blue, red) = (legend.get_pixel(76, y).0, legend.get_pixel(36, y).0);
            blue[2] > blue[0] + 60 && red[0] > red[2] + 60
        });
        assert_eq!(rows.count() > 3, lower, "{color}");
    }
    let message = bad(&["render", "cube", "-o", "a.exr", "--legend"], here);
    assert!(message.contains("--legend"), "{message}");
}

const CUBE: &str = "[[body]]\nmesh = \"cube\"\nposition = [0, 4, 0]\nmaterial = \"m\"\n";

#[test]
fn materials_and_lights_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("lamp.csv"), "nm,value\n500,0\n550,1\n600,0\n").unwrap();
    let middle = |material: &str, lights: &str| {
        let text = format!(
            "[camera]\nsize = [32, 32]\nfov_deg = 20\n[material.m]\ncolor = [1, 1, 1]\n{material}\n{CUBE}{lights}"
        );
        std::fs::write(here.join("a.toml"), text).unwrap();
        good(&["render", "a.toml", "-o", "a.exr", "-q"], here);
        let film = read_exr(&here.join("a.exr"));
        ["R", "G", "B"].map(|c| film[c][16 * 32 + 16])
    };
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-4);
    assert!(near(middle("", ""), [1.0; 3]));
    // A black body of 3000 K, of luminance 1 by D65's white: as in the reference.
    let warm = middle("spectrum = { blackbody_k = 3000 }", "");
    assert!(warm[0] > 1.5 && warm[1] > 0.7 && warm[2] < 0.4, "{warm:?}");
    let half = middle("spectrum = { blackbody_k = 3000 }\nluminance = 0.5", "");
    assert!(near(half.map(|v| 2.0 * v), warm), "{half:?} {warm:?}");
    let green = middle("spectrum = { file = \"lamp.csv\" }", "");
    assert!(green[1] > 1.0 && green[0] < green[1] && green[2] < 0.1, "{green:?}");
    let line = middle("spectrum = { line_nm = 650 }\nradiance = 2", "");
    assert!(line[0] > 0.3 && line[1].abs() < 0.1 * line[0], "{line:?}");
    assert!(
        near(
            middle("spectrum = \"flat\"\nlaw = { limb_darkening = [0.5] }", "").map(|v| v / 1.0),
            middle("spectrum = \"flat\"", "")
        ),
        "seen square on"
    );
    // A sun behind the camera, of the usual strength: white.
    let sun = "[[light]]\nkind = \"distant\"\ntowards = [0, 1, 0]\n";
    assert!(near(middle("", sun), [1.0; 3]));
    assert!(near(
        middle("surface = \"luminous\"", "[[light]]\nkind = \"ambient\"\nstrength = 5\n"),
        [1.0; 3]
    ));
    assert!(near(middle("", "[[light]]\nkind = \"ambient\"\nstrength = 5\n"), [5.0; 3]));
    assert!(near(middle("emission = [0, 0.5, 0]", sun), [1.0, 1.5, 1.0]));
    let lamp = "[[light]]\nkind = \"point\"\nposition = [0, 0.5, 0]\nstrength = 18\ncolor = [1, 0.5, 0]\n";
    // 18/3² /π.
    let seen = middle("", lamp);
    let full = 2.0 / std::f32::consts::PI;
    assert!(near(seen, [full, 0.5 * full, 0.0]), "{seen:?}");
    let spot = lamp.replace("point", "spot") + "towards = [0, 1, 0]\ncone_deg = [10, 20]\n";
    assert!(near(middle("", &spot), seen));
    assert!(near(middle("", &spot.replace("[0, 1, 0]", "[1, 1, 0]")), [0.0; 3]));
    let shiny = middle("gloss = { reflectance = 0.5, roughness = 0.3 }", sun);
    assert!(shiny[0] > 2.0, "{shiny:?}");
}

#[test]
fn what_cannot_be_read_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("bad.csv"), "400,1\n300,2\n").unwrap();
    let material = |text: &str| format!("[material.m]\n{text}\n{CUBE}");
    let light = |text: &str| format!("{}[[light]]\n{text}\n", CUBE.replace("material = \"m\"\n", ""));
    for (text, parts) in [
        (material("spectrum = \"sunny\""), &["a.toml:2:", "'sunny'", "blackbody_k"][..]),
        (material("spectrum = { blackbody = 6000 }"), &["a.toml:2:", "'blackbody'", "'blackbody_k'"]),
        (material("spectrum = { blackbody_k = -1 }"), &["a.toml:2:", "blackbody_k = -1", "between"]),
        (material("spectrum = { blackbody_k = 6000, line_nm = 500 }"), &["a.toml:2:", "needs"]),
        (material("spectrum = { line_nm = 500, width_nm = 0 }"), &["a.toml:2:", "width_nm"]),
        (material("spectrum = { line_nm = 5000 }\nluminance = 1"), &["a.toml:2:", "not seen", "radiance"]),
        (material("spectrum = \"flat\"\nradiance = 1"), &["a.toml:2:", "infinite"]),
        (material("spectrum = { file = \"none.csv\" }"), &["a.toml:2:", "none.csv"]),
        (material("spectrum = { file = \"bad.csv\" }"), &["a.toml:2:", "bad.csv", "line 2"]),
        (material("luminance = 1\nradiance = 1"), &["a.toml:3:", "one is enough"]),
        (material("luminance = -1"), &["a.toml:2:", "luminance"]),
        (material("surface = \"lite\""), &["a.toml:2:", "did you mean 'lit'"]),
        (material("beyond = \"gray\""), &["a.toml:2:", "did you mean 'grey'"]),
        (material("law = { cos_power = -1 }"), &["a.toml:2:", "cos_power"]),
        (material("law = \"lamb\""), &["a.toml:2:", "'lamb'"]),
        (material("gloss = { roughness = 2 }"), &["a.toml:2:", "roughness = 2"]),
        (material("colour = [1, 1, 1]"), &["a.toml:2:", "'color'"]),
        (light("kind = \"sun\""), &["a.toml:5:", "distant"]),
        (light("kind = \"distant\""), &["a.toml:5:", "towards"]),
        (light("kind = \"distant\"\ntowards = [0, 0, 0]"), &["a.toml:6:", "zero"]),
        (light("kind = \"distant\"\ntowards = [0, 1, 0]\nposition = [1, 0, 0]"), &["a.toml:7:", "nowhere"]),
        (light("kind = \"ambient\"\ntowards = [0, 1, 0]"), &["a.toml:6:", "all directions"]),
        (light("kind = \"point\""), &["a.toml:5:", "strength"]),
        (light("kind = \"point\"\nstrength = -1"), &["a.toml:6:", "between 0"]),
        (light("kind = \"point\"\nstrength = 1\npower = 1"), &["a.toml:7:", "one is enough"]),
        (light("kind = \"point\"\nstrength = 1\nvelocity = [2, 0, 0]"), &["a.toml:7:", "velocity"]),
        (
            light("kind = \"spot\"\nstrength = 1\ntowards = [0, 1, 0]\ncone_deg = [30, 20]"),
            &["a.toml:8:", "cone_deg"],
        ),
        (light("kind = \"point\"\nstrength = 1\nspectrum = { blackbody_k = 3 }"), &["a.toml:7:", "not seen"]),
        (light("strength = 1"), &["kind"]),
        ("[light]\nkind = \"point\"\n".to_owned(), &["a.toml:1:", "[[light]]"]),
    ] {
        std::fs::write(here.join("a.toml"), &text).unwrap();
        let message = bad(&["render", "a.toml", "-o", "a.png"], here);
        for part in parts {
            assert!(message.contains(part), "{text}\n→ {message}lacks {part}");
        }
        assert!(!here.join("a.png").exists());
    }
}

/// Lamps have shadows: rays are traced, unless something else is asked for; then one line says what is not there.
#[test]
fn what_needs_ray_tracing_is_traced() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let lamp = "[[light]]\nkind = \"point\"\nposition = [0, 0, 3]\nstrength = 9\n";
    let scene = |material: &str| format!("[material.m]\n{material}\n{CUBE}{lamp}");
    std::fs::write(here.join("lit.toml"), scene("color = [1, 1, 1]")).unwrap();
    std::fs::write(here.join("luminous.toml"), scene("surface = \"luminous\"")).unwrap();
    let lit = |flags: &[&str]| good(&[&["render", "lit.toml", SMALL], flags].concat(), here);
    assert!(lit(&[]).contains("exact shading on the CPU (shadows need rays from what is seen only)"));
    for flags in [["--method", "apparent"], ["--raster", "skia"], ["--doppler", "vertex"]] {
        let told = lit(&flags);
        assert!(told.contains("apparent shading"), "{told}");
        assert_eq!(
            told.lines().filter(|l| l.contains("--method exact has what is missing")).count(),
            1,
            "{told}"
        );
    }
    assert!(lit(&["--color", "doppler"]).contains("exact shading"));
    assert!(lit(&["--bounces", "2", "--samples", "4"]).contains("of paths of 2 reflections, noise"));
    // A lamp in the middle of the cube.
    let shut = scene("color = [1, 1, 1]").replace("position = [0, 0, 3]", "position = [0, 4, 0]");
    std::fs::write(here.join("shut.toml"), shut).unwrap();
    let told = bad(&["render", "shut.toml", SMALL], here);
    assert!(told.contains("light1' reaches nothing") && told.contains("inside 'cube'"), "{told}");
    // A film may show the inside later.
    let film = ["animate", "shut.toml", SMALL, "--frames", "2", "--time=0,1", "-o", "shut.gif"];
    let told = good(&film, here);
    assert_eq!(told.matches("inside 'cube'").count(), 1, "{told}");
    std::fs::write(here.join("unlit.toml"), format!("[material.m]\nsurface = \"lit\"\n{CUBE}")).unwrap();
    assert!(good(&["render", "unlit.toml", SMALL], here).contains("nothing lights them"));
    std::fs::write(here.join("sky.toml"), "[sky]\ntexture = \"stars\"\n").unwrap();
    assert!(good(&["render", "sky.toml", SMALL], here).contains("exact shading"));
    let luminous = good(&["render", "luminous.toml", SMALL], here);
    assert!(luminous.contains("exact shading") && !luminous.contains("--method trace"), "{luminous}");
    for (flags, word) in [
        (["--method", "trace", "--raster", "skia"], "polygons"),
        (["--method", "trace", "--doppler", "vertex"], "polygons"),
        (["--method", "apparent", "--bounces", "3"], "--bounces"),
        (["--method", "trace", "--bounces", "65"], "65"),
        (["--method", "trace", "--seed", "-1"], "--seed"),
    ] {
        let message = bad(&[&["render", "lit.toml", SMALL], &flags[..]].concat(), here);
        assert!(message.contains(word), "{message}");
    }
}

/// A glTF file's own lamp lights it, at rest and in motion.
#[test]
fn lights_of_gltf_files_light() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    good(&["transform", "cube", "-o", "cube.glb", "--beta", "0", "--frame", "world", "-q"], here);
    let bytes = std::fs::read(here.join("cube.glb")).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let mut document: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    document["extensionsUsed"] = serde_json::json!(["KHR_lights_punctual"]);
    document["extensions"] = serde_json::json!({ "KHR_lights_punctual": { "lights": [
        { "type": "directional", "name": "sun", "color": [1, 1, 0], "intensity": 3 } ] } });
    for material in document["materials"].as_array_mut().unwrap() {
        material.as_object_mut().unwrap().remove("extensions");
    }
    document.as_object_mut().unwrap().remove("cameras");
    let nodes = document["nodes"].as_array_mut().unwrap();
    nodes.retain(|n| n.get("camera").is_none());
    nodes.push(serde_json::json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } }));
    let roots: Vec<usize> = (0..nodes.len()).collect();
    document["scenes"][0]["nodes"] = serde_json::json!(roots);
    document["buffers"][0]["uri"] = "cube.bin".into();
    std::fs::write(here.join("cube.bin"), &bytes[28 + length..]).unwrap();
    std::fs::write(here.join("lit.gltf"), document.to_string()).unwrap();
    for beta in ["0", "0.9"] {
        let told = json(
            &["render", "lit.gltf", "--beta", beta, SMALL, "-o", "lit.exr", "--color", "geometry"],
            here,
        );
        assert_eq!(told["lights"][0]["name"], "sun");
        let film = read_exr(&here.join("lit.exr"));
        let seen: Vec<usize> = (0..film["body"].len()).filter(|&i| film["body"][i] >= 0.0).collect();
        assert!(seen.len() > 100);
        // Yellow light: no blue at all, and something of red and green.
        assert!(seen.iter().all(|&i| film["B"][i] == 0.0));
        assert!(seen.iter().any(|&i| film["G"][i] > 0.1), "{beta}");
    }
}

/// Colours at the vertices of exported shapes are those of the picture, at one exposure.
#[test]
fn exported_colours_are_those_seen() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let told = json(&["transform", "hot", "-o", "hot.ply", "--color", "spectral"], here);
    assert_eq!(told["color"], "spectral");
    let ev = told["exposure_ev"].as_f64().unwrap();
    assert!(ev < -3.0, "{ev}");
    let bytes = std::fs::read(here.join("hot.ply")).unwrap();
    let header = String::from_utf8_lossy(&bytes[..1000]).into_owned();
    let start = header.find("end_header\n").unwrap() + 11;
    let count: usize =
        header.split("element vertex ").nth(1).unwrap().split('\n').next().unwrap().parse().unwrap();
    // x y z nx ny nz u v, three bytes of colour, D.
    let row = 8 * 4 + 3 + 4;
    let [mut blue, mut red] = [0; 2];
    for vertex in bytes[start..].chunks_exact(row).take(count) {
        let [r, _, b] = [vertex[32], vertex[33], vertex[34]];
        let d = f32::from_le_bytes(vertex[35..39].try_into().unwrap());
        // Ahead, unless clipped, blue; behind red or black.
        if d > 2.0 && b < 255 {
            blue += 1;
            assert!(b > r, "{d} {r} {b}");
        }
        if d < 0.8 {
            red += 1;
            assert!(r >= b && r < 60, "{d} {r} {b}");
        }
    }
    assert!(blue > 100 && red > 100, "{blue} {red}");
    // Materials and textures of the file stay where colours are the surfaces' own.
    let told = json(&["transform", "cube", "-o", "cube.glb", "--color", "flat", "--exposure", "1"], here);
    assert_eq!(told["exposure_ev"], 1.0);
    assert_eq!(json(&["transform", "cube", "-o", "cube.glb"], here)["color"], "geometry");
}

/// What has no colours is lit as plain clay, and painted as such only where there is no light to show its shape; with a
/// spectrum it shines alike on all sides.
#[test]
fn clay_is_paint_only_in_the_dark() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("m.obj"), "v -9 0 -9\nv 9 0 -9\nv 9 0 9\nv -9 0 9\nf 1 2 3 4\n").unwrap();
    let body = "[[body]]\nmesh = \"m.obj\"\nposition = [0, 5, 0]\n";
    let seen = |text: String| {
        std::fs::write(here.join("a.toml"), text).unwrap();
        let line = good(&["render", "a.toml", "-o", "a.exr", SMALL], here);
        let film = read_exr(&here.join("a.exr"));
        (film["G"][24 * 64 + 32], line.contains("painted in clay"))
    };
    assert!(seen(body.to_owned()).1);
    let sun = "[[light]]\nkind = \"distant\"\ntowards = [0, 1, 0]\n";
    let (bright, noted) = seen(format!("{body}{sun}"));
    assert!((bright - 0.8).abs() < 1e-4 && !noted, "{bright} {noted}");
    let (bright, noted) =
        seen(format!("[material.m]\nspectrum = \"flat\"\ncolor = [1, 1, 1]\n{body}material = \"m\"\n"));
    assert!(bright > 0.9 && !noted, "{bright} {noted}");
    // Its own light is not put out by others.
    let glow = "[material.m]\ncolor = [1, 1, 1]\nluminance = 5\n";
    let (bright, _) = seen(format!("{glow}{body}material = \"m\"\n{sun}"));
    assert!((bright - 5.0).abs() < 1e-3, "{bright}");
}

/// Over all wavelengths light is as strong as it is said to be, seen or not.
#[test]
fn bolometric_counts_what_is_not_seen() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for spectrum in ["{ line_nm = 1000 }", "{ blackbody_k = 300 }", "{ line_nm = 589 }"] {
        let text = format!("[material.m]\ncolor = [1, 1, 1]\nspectrum = {spectrum}\nradiance = 2\n{CUBE}");
        std::fs::write(here.join("a.toml"), text).unwrap();
        good(&["render", "a.toml", "-o", "a.exr", SMALL, "--color", "bolometric"], here);
        let film = read_exr(&here.join("a.exr"));
        assert!((film["R"][24 * 64 + 32] - 2.0).abs() < 1e-5, "{spectrum}");
    }
}
