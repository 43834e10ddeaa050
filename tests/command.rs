//! The command as people use it: what it writes, what it says, and what it refuses.

#[path = "common/assertion.rs"]
mod assertion;
mod common;

use assertion::{folder, refused, terrell};
use common::read_exr;
use std::path::Path;

#[test]
fn the_main_job_needs_no_file_and_no_flag() {
    let folder = folder();
    let output = terrell(folder.path(), &["render", "cube"]).success().get_output().clone();
    let line = String::from_utf8(output.stdout).unwrap();
    assert!(line.contains("cube.png") && line.contains("1280x720") && line.contains("2.2942"), "{line}");
    assert_eq!(line.lines().count(), 1);
    let picture = image::open(folder.path().join("cube.png")).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (1280, 720));
    // Seen abreast its light is shifted to the red, nowhere as bright in blue as in red, and the picture's corners are
    // empty.
    let seen: Vec<_> = picture.pixels().filter(|p| p.0 != [0; 3]).collect();
    let red = |p: &&&image::Rgb<u8>| p.0[0] > 30 && p.0[0] > p.0[2];
    assert!(seen.len() > 70_000 && seen.iter().filter(red).count() * 10 > 9 * seen.len(), "{}", seen.len());
    assert_eq!(picture.get_pixel(5, 5).0, [0, 0, 0]);
    terrell(folder.path(), &["render", "cube", "--color", "geometry", "-q"]).success();
    let picture = image::open(folder.path().join("cube.png")).unwrap().to_rgb8();
    // Fig. 2: the trailing side is seen, yellow; the near side, green.
    let count = |wanted: [u8; 3]| {
        picture.pixels().filter(|p| p.0.iter().zip(wanted).all(|(a, b)| a.abs_diff(b) < 3)).count()
    };
    assert!(count([249, 237, 89]) > 50_000, "yellow");
    assert!(count([89, 231, 124]) > 20_000, "green");
}

#[test]
fn scenes_are_listed_and_can_be_started_from() {
    let folder = folder();
    let list = terrell(folder.path(), &["scenes"]).success().get_output().stdout.clone();
    let list = String::from_utf8(list).unwrap();
    for name in ["cube", "gate", "lattice", "sphere", "street", "train"] {
        assert!(list.lines().any(|l| l.starts_with(name)));
        assert!(list.lines().any(|l| l.trim() == format!("terrell render {name}")));
        let toml = terrell(folder.path(), &["scenes", name]).success().get_output().stdout.clone();
        std::fs::write(folder.path().join("my.toml"), toml).unwrap();
        let both: Vec<Vec<u8>> = [name, "my.toml"]
            .iter()
            .map(|scene| {
                terrell(folder.path(), &["render", scene, "-o", "a.png", "--size", "80x60", "-q"])
                    .success()
                    .stdout("");
                std::fs::read(folder.path().join("a.png")).unwrap()
            })
            .collect();
        assert!(both[0] == both[1], "{name}: the same picture from its TOML");
    }
    refused(folder.path(), &["scenes", "cuve"], &["did you mean 'cube'?"]);
    refused(folder.path(), &["scenes", "sculpture"], &["street", "train"]);
}

#[test]
fn every_scene_has_a_thumbnail() {
    let folder = folder();
    let output = terrell(folder.path(), &["scenes", "--thumbnails", "some/where"]).success();
    let said = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    for name in ["cube", "gate", "lattice", "sphere", "street", "train"] {
        let path = Path::new("some/where").join(format!("{name}.png"));
        assert!(said.lines().any(|l| Path::new(l) == path), "{said}");
        let picture = image::open(folder.path().join(path)).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), (320, 180));
        let colors: std::collections::HashSet<_> = picture.pixels().collect();
        assert!(colors.len() > 10, "{name}");
    }
    let names = || std::fs::read_dir(folder.path().join("some/where")).unwrap().count();
    assert_eq!(names(), said.lines().count());
    // Once more over what is there; and where no folder can be.
    terrell(folder.path(), &["scenes", "--thumbnails", "some/where"]).success();
    assert_eq!(names(), said.lines().count());
    std::fs::write(folder.path().join("file"), "").unwrap();
    refused(folder.path(), &["scenes", "--thumbnails", "file"], &["file", "not a folder"]);
    refused(folder.path(), &["scenes", "--thumbnails", "file/under"], &["file/under"]);
    refused(folder.path(), &["scenes", "cube", "--thumbnails", "a"], &["--thumbnails"]);
}

#[test]
fn every_way_to_say_a_velocity_says_the_same() {
    let folder = folder();
    let draw = |flags: &[&str]| {
        terrell(
            folder.path(),
            &[&["render", "cube", "-o", "a.exr", "--size", "96x64", "-q", "--color", "geometry"], flags]
                .concat(),
        )
        .success();
        std::fs::read(folder.path().join("a.exr")).unwrap()
    };
    let usual = draw(&["--beta", "0.6"]);
    for flags in [
        &["--beta", "0.6,0,0"][..],
        &["--celerity", "0.75"],
        &["--celerity", "0.75,0,0"],
        &["--gamma", "1.25"],
        &["--gamma", "1.25", "--direction", "3,0,0"],
        &["--beta=0.6", "--direction", "1,0,0"],
    ] {
        assert!(draw(flags) == usual, "{flags:?}");
    }
    assert!(draw(&["--beta", "-0.6"]) != usual);
    assert!(draw(&["--beta", "-0.6"]) == draw(&["--beta", "0.6", "--direction", "-1,0,0"]));
}

#[test]
fn a_picture_is_taken_when_asked() {
    let folder = folder();
    let json = |flags: &[&str]| -> serde_json::Value {
        let base = ["render", "cube", "-o", "a.png", "--size", "96x64", "--json", "-"];
        let output = terrell(folder.path(), &[&base, flags].concat()).success().get_output().stdout.clone();
        serde_json::from_slice(&output).unwrap()
    };
    // Abreast at a distance of 3 at time −3: seen so at 0, at every speed.
    for beta in ["0.1", "0.9", "0.999"] {
        let time = json(&["--beta", beta, "--when", "nearest cube"])["camera"]["event"][0].as_f64().unwrap();
        assert!(time.abs() < 1e-12, "{time}");
    }
    let later = json(&["--time", "2.5"]);
    assert_eq!(later["camera"]["event"][0], 2.5);
    assert_eq!(later["method"], "exact");
    assert!(later["seconds"]["whole"].as_f64().unwrap() > 0.0);
    assert!(later["pieces"].as_u64().unwrap() >= 12);
}

#[test]
fn the_users_mistakes_are_explained() {
    let folder = folder();
    let at = folder.path();
    let write = |name: &str, contents: &[u8]| std::fs::write(at.join(name), contents).unwrap();
    write("empty.obj", b"");
    write("half.obj", b"v 0 0 0\nv 1 0 0\nv 0 1\n");
    write("nan.obj", b"v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    write("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
    write("binary.obj", &[0u8, 159, 146, 150]);
    write("empty.glb", b"");
    write("short.glb", b"glTF\x02\x00\x00\x00");
    // A header claiming 10 GB does not fit 32 bits; this is what fits.
    write("huge.glb", b"glTF\x02\x00\x00\x00\xff\xff\xff\xff\xf0\xff\xff\xffJSON{}");
    write("huge.gltf", br#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 10000000000}]}"#);
    write("bad.gltf", b"{");
    write("key.toml", b"[[body]]\nmesh = \"cube\"\nvelocty = [0.5, 0, 0]\n");
    write("fast.toml", b"[[body]]\nmesh = \"cube\"\nvelocity = [1, 0, 0]\n");
    write("file", b"");

    for (arguments, parts) in [
        (&["render", "cube", "--beta", "1"][..], &["not below 1", "gamma"][..]),
        (&["render", "cube", "--beta", "0.8,0.8,0"], &["not below 1"]),
        (&["render", "cube", "--beta", "fast"], &["--beta", "fast"]),
        (&["render", "cube", "--beta", "nan"], &["not finite"]),
        (&["render", "cube", "--gamma", "0.5"], &["below 1"]),
        (&["render", "cube", "--gamma", "1e300"], &["beyond"]),
        (&["render", "cube", "--beta", "0.5", "--gamma", "2"], &["--gamma"]),
        (&["render", "cube", "--direction", "1,0,0"], &["speed"]),
        (&["render", "cube", "--beta", "0.5", "--direction", "0,0,0"], &["length zero"]),
        (&["render", "cube", "--size", "0x100"], &["0x100"]),
        (&["render", "cube", "--size", "99999x99999"], &["99999"]),
        (&["render", "cube", "--size", "32768x32768"], &["32768x32768"]),
        (&["render", "cube", "--time", "1e200"], &["1e200"]),
        (&["render", "cube", "--size", "big"], &["big", "1280x720"]),
        (&["render", "cube", "--fov", "200"], &["200", "fisheye"]),
        (&["render", "cube", "--fov", "0"], &["0.000001°"]),
        (&["render", "cube", "--camera", "fishey"], &["fisheye"]),
        (&["render", "cube", "--camera", "panorama", "--fov", "90"], &["360"]),
        (&["render", "cube", "--tolerance", "0"], &["--tolerance"]),
        (&["render", "cube", "--tolerance", "-1"], &["--tolerance"]),
        (&["render", "cube", "--tolerance", "1e-12"], &["tolerance"]),
        (&["render", "cube", "--samples", "0"], &["--samples"]),
        (&["render", "cube", "--when", "now"], &["nearest BODY"]),
        (&["render", "cube", "--when", "nearest dog"], &["dog", "'cube'"]),
        (&["render", "cube", "--beta", "0", "--when", "nearest cube"], &["never seen to pass"]),
        (&["render", "cube", "-o", "cube.gif"], &["'.gif'", ".png"]),
        (&["render", "cube", "-o", "cube"], &["unknown picture format"]),
        (&["render", "cube", "-o", "no/such/cube.png"], &["no/such"]),
        (&["render", "cube", "-o", "file/cube.png"], &["file"]),
        (&["render", "cube", "-o", "/proc/cube.png"], &["/proc/cube.png"]),
        (&["render", "cube", "--json", "no/such.json"], &["no/such.json"]),
        (&["render", "cube", "--json", "."], &["directory"]),
        (&["render", "cube", "--json", "/proc/a.json"], &["/proc/a.json"]),
        (&["render", "cube", "-o", "a.png", "--json", "./a.png", "--size", "8x8"], &["both"]),
        (&["render", "cub"], &["'cube'"]),
        (&["render", "no.obj"], &["no.obj"]),
        (&["render", "no.toml"], &["no.toml"]),
        (&["render", "empty.obj"], &["empty.obj", "no triangles"]),
        (&["render", "half.obj"], &["half.obj:3"]),
        (&["render", "nan.obj"], &["nan.obj", "vertex 1"]),
        (&["render", "index.obj"], &["index.obj:4"]),
        (&["render", "binary.obj"], &["binary.obj", "not text"]),
        (&["render", "empty.glb"], &["empty.glb"]),
        (&["render", "short.glb"], &["short.glb"]),
        (&["render", "huge.glb"], &["huge.glb", "whole"]),
        (&["render", "huge.gltf"], &["huge.gltf"]),
        (&["render", "bad.gltf"], &["bad.gltf"]),
        (&["render", "key.toml"], &["key.toml:3", "'velocity'"]),
        (&["render", "fast.toml"], &["fast.toml:3", "not below 1"]),
        (&["render"], &["<SCENE>"]),
        (&["rendr"], &["render"]),
    ] {
        refused(at, arguments, parts);
    }
}

/// A glTF file of a triangle at x = −1 in one scene, at x = 1 in another with two cameras.
const TWO_SCENES: &str = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0], "name": "day"}, {"nodes": [1, 2, 3], "name": "night"}],
    "nodes": [{"mesh": 0, "translation": [-1, 0, 0]}, {"mesh": 0, "translation": [1, 0, 0]},
      {"camera": 0, "translation": [1, 0, 5], "name": "far"}, {"camera": 0, "translation": [1, 0, 3], "name": "near"}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

#[test]
fn scenes_and_cameras_of_a_file_are_chosen() {
    let folder = folder();
    let at = folder.path();
    std::fs::write(at.join("a.gltf"), TWO_SCENES).unwrap();
    std::fs::write(at.join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let scene = |file_scene: &str| format!("[[body]]\nmesh = \"a.gltf\"\nfile_scene = \"{file_scene}\"\n");
    std::fs::write(at.join("night.toml"), scene("night")).unwrap();
    std::fs::write(at.join("nihgt.toml"), scene("nihgt")).unwrap();
    std::fs::write(at.join("cube.toml"), scene("night").replace("a.gltf", "cube")).unwrap();
    std::fs::write(at.join("obj.toml"), scene("night").replace("a.gltf", "a.obj")).unwrap();
    let json = |flags: &[&str]| -> serde_json::Value {
        let base = ["-o", "a.png", "--size", "64x48", "--json", "-"];
        let output = terrell(at, &[&["render"], flags, &base].concat()).success().get_output().stdout.clone();
        serde_json::from_slice(&output).unwrap()
    };
    let notes = |json: &serde_json::Value| json["notes"].to_string();
    let usual = json(&["a.gltf"]);
    assert!(notes(&usual).contains("of 2 scenes number 1 ('day') is shown; --file-scene"), "{usual}");
    let far = json(&["a.gltf", "--file-scene", "night"]);
    assert_eq!(far["camera"]["event"], serde_json::json!([0.0, 1.0, 0.0, 5.0]));
    assert!(notes(&far).contains("of 2 cameras the first with perspective is used; --file-camera"), "{far}");
    for (scene, camera) in [("night", "near"), ("2", "2")] {
        let near = json(&["a.gltf", "--file-scene", scene, "--file-camera", camera]);
        assert_eq!(near["camera"]["event"], serde_json::json!([0.0, 1.0, 0.0, 3.0]));
        assert!(!notes(&near).contains("cameras") && !notes(&near).contains("scenes"), "{near}");
    }
    let body = json(&["night.toml"]);
    assert!(!notes(&body).contains("cameras") && !notes(&body).contains("scenes"), "{body}");
    let choose = ["--file-scene", "2", "--file-camera", "near", "-q"];
    terrell(at, &[&["transform", "a.gltf"], &choose[..]].concat()).success();
    terrell(
        at,
        &[&["animate", "a.gltf", "--time", "0,1", "--frames", "2", "--size", "16x16"], &choose[..]].concat(),
    )
    .success();

    for (arguments, parts) in [
        (
            &["render", "a.gltf", "--file-scene", "nihgt"][..],
            &["a.gltf", "'nihgt'", "did you mean 'night'?"][..],
        ),
        (&["render", "a.gltf", "--file-scene", "3"], &["no scene '3'", "from 1 to 2: day, night"]),
        (&["render", "a.gltf", "--file-camera", "far"], &["no camera 'far'", "there is none"]),
        (&["render", "a.gltf", "--file-scene", "2", "--file-camera", "fat"], &["did you mean 'far'?"]),
        (&["render", "cube", "--file-scene", "1"], &["--file-scene", ".gltf", "cube"]),
        (&["transform", "a.obj", "--file-camera", "1"], &["--file-camera", ".gltf", "a.obj"]),
        (&["animate", "night.toml", "--file-scene", "1"], &["--file-scene", "night.toml", "file_scene"]),
        (&["render", "night.toml", "--file-camera", "1"], &["--file-camera", "night.toml"]),
        (&["render", "nihgt.toml"], &["nihgt.toml:3", "did you mean 'night'?"]),
        (&["render", "cube.toml"], &["cube.toml:3", "file_scene", "'cube'"]),
        (&["render", "obj.toml"], &["obj.toml:3", "file_scene", "'a.obj'"]),
    ] {
        refused(at, arguments, parts);
    }
}

/// A device stays a device, a link a link.
#[cfg(unix)]
#[test]
fn outputs_that_are_no_plain_files_are_written_to() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let folder = folder();
    let null = folder.path().join("null.png");
    symlink("/dev/null", &null).unwrap();
    terrell(folder.path(), &["render", "cube", "-o", "null.png", "--size", "8x8", "--json", "/dev/null"])
        .success();
    assert!(std::fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    std::fs::write(folder.path().join("real.exr"), "").unwrap();
    symlink("real.exr", folder.path().join("link.exr")).unwrap();
    terrell(folder.path(), &["render", "cube", "-o", "link.exr", "--size", "8x8"]).success();
    assert!(folder.path().join("link.exr").is_symlink());
    assert!(std::fs::metadata(folder.path().join("real.exr")).unwrap().len() > 100);
}

/// A poster just before a wall, a face behind another where depth is squeezed: nothing shows through.
#[test]
fn near_surfaces_hide_far_ones_however_close() {
    let folder = folder();
    let write = |name: &str, contents: &str| std::fs::write(folder.path().join(name), contents).unwrap();
    let square =
        |half: f64| format!("v {0} 0 {0}\nv -{0} 0 {0}\nv -{0} 0 -{0}\nv {0} 0 -{0}\nf 1 2 3 4\n", half);
    write("wall.obj", &square(2.0));
    write("poster.obj", &square(0.5));
    let body = |mesh: &str, depth: f64, velocity: &str| {
        format!(
            "[[body]]\nmesh = \"{mesh}.obj\"\ntime = -3\nposition = [0, {depth}, 0]\n{velocity}\nrotation = {{ axis = [0, 0, 1], angle_deg = -45 }}\n"
        )
    };
    for (number, velocity) in
        ["velocity = [0.9, 0, 0]", "velocity = [0.99, 0, 0]", "gamma = 1000"].iter().enumerate()
    {
        let scene = format!(
            "[camera]\nnearest = \"poster\"\nsize = [320, 240]\n{}{}",
            body("wall", 3.005, velocity),
            body("poster", 3.0, velocity).replace("[[body]]", "[[body]]\nname = \"poster\"")
        );
        write("a.toml", &scene);
        let film = |body: usize| {
            let out = format!("{number}{body}.exr");
            terrell(folder.path(), &["render", "a.toml", "-o", &out, "-q"]).success();
            read_exr(&folder.path().join(out))
        };
        let both = film(0);
        // The poster alone, at the same moment.
        write("a.toml", &scene.replacen(&body("wall", 3.005, velocity), "", 1));
        let alone = film(1);
        let poster = (0..320 * 240).filter(|&i| alone["body"][i] == 0.0);
        let (mut seen, mut lost) = (0, 0);
        for i in poster {
            seen += 1;
            lost += usize::from(both["body"][i] != 1.0);
        }
        assert!(seen > 100 && lost == 0, "{velocity}: {lost} of {seen} pixels of the poster show the wall");
    }
}

#[test]
fn hostile_scenes_give_pictures() {
    let folder = folder();
    let write = |name: &str, contents: &str| std::fs::write(folder.path().join(name), contents).unwrap();
    // Zero-area triangles, equal vertices, triangles through the camera, huge and tiny ones.
    write(
        "odd.obj",
        "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1 1 0\nv 1e9 1 -1e9\nv -1e9 0 1e9\nv 1e-30 0 1e-30\nf 1 1 1\nf 1 2 3\nf 1 2 4\nf 4 5 6\nf 2 7 4\n",
    );
    write(
        "around.toml",
        "[camera]\nposition = [0, 0, 0]\n[[body]]\nmesh = \"cube\"\nscale = 4\ncelerity = [1e6, 3, 0]\n",
    );
    write(
        "on.toml",
        "[camera]\nposition = [0.5, 0.5, 0.5]\n[[body]]\nmesh = \"cube\"\nvelocity = [0.99, 0, 0]\n",
    );
    write(
        "edge.toml",
        "[camera]\nposition = [0.5, 0, 0.5]\n[[body]]\nmesh = \"cube\"\nvelocity = [0.99, 0, 0]\n",
    );
    write(
        "never.toml",
        "[camera]\nposition = [0, 1e6, 0]\n[[body]]\nmesh = \"cube\"\nvelocity = [0.5, 0, 0]\n",
    );
    for scene in
        ["odd.obj", "around.toml", "on.toml", "edge.toml", "never.toml", "gate", "lattice", "street", "train"]
    {
        for camera in ["pinhole", "fisheye", "panorama"] {
            for gamma in ["1", "1.5", "1000", "1e9"] {
                let arguments = [
                    "render",
                    scene,
                    "-o",
                    "a.png",
                    "--size",
                    "64x48",
                    "--camera",
                    camera,
                    "--gamma",
                    gamma,
                    "--tolerance",
                    "1",
                ];
                let output = terrell(folder.path(), &arguments).success().get_output().clone();
                let line = String::from_utf8(output.stdout).unwrap();
                if scene == "never.toml" && camera != "panorama" && gamma == "1" {
                    assert!(line.contains("nothing is in the picture"), "{line}");
                }
            }
        }
    }
}

/// A closed pipe is an error of its own, not a panic.
#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_it_quietly() {
    let input: String = "x,y,z\n".to_owned() + &"1,2,3\n".repeat(200_000);
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("terrell"))
        .args(["locate", "--beta", "0.5"])
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    use std::io::Write;
    // It may be gone before it has read all.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(!String::from_utf8_lossy(&output.stderr).contains("panicked"));
}

/// Full channels, and what they hold where something is seen and where nothing is.
#[test]
fn an_exr_holds_what_is_seen() {
    let folder = folder();
    terrell(
        folder.path(),
        &["render", "cube", "-o", "a.exr", "--size", "96x64", "-q", "--color", "geometry"],
    )
    .success();
    let film = read_exr(&folder.path().join("a.exr"));
    let mut names: Vec<&str> = film.keys().map(String::as_str).collect();
    names.sort_unstable();
    assert_eq!(names, ["B", "G", "R", "body", "distance", "doppler", "face"]);
    let (middle, corner) = (32 * 96 + 48, 0);
    let at = |name: &str| (film[name][middle], film[name][corner]);
    assert_eq!(at("body"), (0.0, -1.0));
    assert_eq!(at("distance").1, 0.0);
    assert!((2.4..3.6).contains(&at("distance").0));
    // Seen abreast: D = 1/γ, a little more for the trailing side.
    assert!((at("doppler").0 - 0.436).abs() < 0.05);
    // The trailing side, −x, is the first two triangles.
    assert!(at("face").0 < 2.0);
    assert!((at("R").0 - 0.95).abs() < 1e-6);
}
