//! `explain` and `render --detectors`, run as their users run them.

#[path = "common/program.rs"]
mod program;

use program::{bad, good, pixels};

#[test]
fn explain_says_what_is_seen_and_draws_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let said = good(&["explain", "cube"], folder.path());
    let parts = ["method exact", "0.9 c, γ 2.294", "abreast at t = 0", "D = 0.4359", "turned by 64.2°"];
    for part in parts {
        assert!(said.contains(part), "{said}\nlacks {part}");
    }
    let json = good(&["explain", "shadow", "--json", "-", "-q"], folder.path());
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let [floor, cube] = &json["seen"]["bodies"].as_array().unwrap()[..] else { panic!("{json}") };
    assert_eq!(floor["celerity"], 0.0);
    assert!(floor["abreast"].is_null() && floor["doppler"][0] == 1.0);
    // γβ of 0.8c, and D = 1/γ.
    assert!((cube["celerity"].as_f64().unwrap() - 4.0 / 3.0).abs() < 1e-12);
    assert!((cube["abreast"]["doppler"].as_f64().unwrap() - 0.6).abs() < 1e-9);
    for words in [&["explain", "cube", "--gamma", "1e9"][..], &["explain", "cube", "--beta", "0"]] {
        let said = good(words, folder.path());
        assert!(!said.contains("NaN") && !said.contains("inf"), "{said}");
    }
    assert!(good(&["explain", "blackhole", "--size", "64x36"], folder.path()).contains("light is bent"));
    assert!(bad(&["explain", "cubes"], folder.path()).contains("cube"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    // What is read is not written to, and what cannot be written is known before.
    let toml = good(&["scenes", "cube"], folder.path());
    std::fs::write(folder.path().join("my.toml"), &toml).unwrap();
    for words in [
        &["explain", "my.toml", "--json", "my.toml"][..],
        &["render", "my.toml", "--explain", "--json", "my.toml"],
        &["animate", "my.toml", "--explain", "--json", "my.toml"],
        &["animate", "my.toml", "cube", "--explain", "--json", "a.json"],
        &["explain", "my.toml", "--json", "none/a.json"],
    ] {
        bad(words, folder.path());
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("my.toml")).unwrap(), toml);
    // What shadows need has too few digits there.
    assert!(good(&["explain", "shadow", "--gamma", "1e6"], folder.path()).contains("note: "));
}

#[test]
fn shapes_are_drawn_from_aside() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |words: &[&str]| {
        let words: Vec<_> =
            ["render"].iter().chain(words).chain(&["--size", "320x180", "-o", "a.png"]).copied().collect();
        let said = good(&words, folder.path());
        (said, pixels(folder.path().join("a.png")))
    };
    let (said, usual) = draw(&["cube", "--detectors"]);
    assert!(said.contains("apparent shapes of 1 body, γ 2.2942"), "{said}");
    let bright = |picture: &image::RgbImage| picture.pixels().filter(|p| p.0 != [0; 3]).count();
    // The cube and the model of a camera.
    assert!((500..20_000).contains(&bright(&usual)), "{}", bright(&usual));
    // Light does not matter to shapes: nothing is traced, nothing is lit.
    let (said, _) = draw(&["box", "--detectors"]);
    assert!(said.contains("exact shading"), "{said}");
    // Brightness that is asked for is that of the light.
    let light = |picture: &image::RgbImage| picture.pixels().map(|p| u64::from(p.0[0])).sum::<u64>();
    let spectral = |ev: &str| {
        let words = ["cube", "--color", "spectral", "--exposure", ev, "--detectors=2,1,1"];
        light(&draw(&words).1)
    };
    assert!(spectral("4") > spectral("2"));
    // What is said on the picture is said of the scene.
    let (_, of_scene) = draw(&["cube", "--detectors", "--caption", "{beta} {gamma}"]);
    let (_, the_same) = draw(&["cube", "--detectors", "--caption", "0.9 2.294"]);
    let (_, at_rest) = draw(&["cube", "--detectors", "--caption", "0 1"]);
    assert!(of_scene == the_same && of_scene != at_rest);
    let refused = |words: &[&str]| bad(words, folder.path());
    assert!(refused(&["render", "blackhole", "--detectors"]).contains("several places at once"));
    assert!(refused(&["render", "cube", "--detectors", "--camera", "fisheye"]).contains("--camera"));
    let words = ["render", "cube", "--detectors", "--color", "spectral", "--legend"];
    assert!(refused(&words).contains("--legend"));
}
