//! docs/scene-file.md has every key that a scene may have, and no other; its examples are scenes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use terrell::scene::parse_scene;

type Keys = BTreeSet<String>;

/// The document's text and its blocks of code, by turns.
fn pieces() -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene-file.md");
    let text = std::fs::read_to_string(path).unwrap();
    text.split("```").map(str::to_owned).collect()
}

/// The keys that the document gives, by section: code in the first columns of tables.
fn documented() -> BTreeMap<String, Keys> {
    let text: String = pieces().into_iter().step_by(2).collect();
    let section = |text: &str| {
        // `[[animation.key]]` is of what its table calls a key.
        let heading = text.lines().next().unwrap_or_default().trim_matches(['#', ' ', '`', '[', ']']);
        let name = heading.rsplit('.').next().unwrap_or_default().to_owned();
        let cells = text.lines().filter_map(|line| line.strip_prefix('|')?.split('|').next());
        (name, cells.flat_map(|cell| cell.split('`').skip(1).step_by(2)).map(str::to_owned).collect())
    };
    format!("\n{text}").split("\n#").map(section).collect()
}

/// The keys that the parser knows where the scene has a question mark, if a table's keys are there.
fn known(scene: &str) -> Option<Keys> {
    // So unlike all of them that none is taken for what was meant.
    const UNKNOWN: &str = "unlike_any_key_there_is";
    let scene = scene.replace('?', &format!("{UNKNOWN} = 0"));
    let message = parse_scene(&scene, Path::new("a.toml")).unwrap_err().to_string();
    let (_, keys) = message.split_once(&format!("unknown key '{UNKNOWN}'; known: "))?;
    Some(keys.split(", ").map(str::to_owned).collect())
}

/// The table whose keys are where the scene has a question mark, and those within it, with all their keys.
fn tables(name: &str, scene: &str) -> Vec<(String, Keys)> {
    let Some(keys) = known(scene) else { return Vec::new() };
    let mut found = Vec::new();
    for key in &keys {
        // What is asked for first.
        let needed = match key.as_str() {
            "body" => "mesh = 'cube', ",
            "light" => "kind = 'ambient', ",
            "sky" => "texture = 'stars', ",
            _ => "",
        };
        for (name, value) in [
            (key.as_str(), format!("{{ {needed}? }}")),
            (key.as_str(), format!("[{{ {needed}? }}]")),
            ("NAME", "{ NAME = { ? } }".to_owned()),
        ] {
            found.extend(tables(name, &scene.replace('?', &format!("{key} = {value}"))));
        }
    }
    found.push((name.to_owned(), keys));
    found
}

#[test]
fn every_key_is_in_the_section_of_its_table() {
    let (known, mut documented) = (tables("Scene files", "?"), documented());
    // All are found, at any depth: serde's, and those that are read by hand.
    for (table, key, count) in [
        ("Scene files", "body", 1),
        ("camera", "fov_deg", 1),
        ("at_infinity", "height", 1),
        ("body", "mesh", 1),
        ("rotation", "axis", 2),
        ("NAME", "color", 1),
        ("spectrum", "blackbody_k", 3),
        ("law", "cos_power", 1),
        ("gloss", "roughness", 1),
        ("light", "kind", 1),
        ("sky", "texture", 1),
        ("spacetime", "spin", 1),
        ("animation", "frames", 1),
        ("key", "time", 1),
    ] {
        let found = known.iter().filter(|(name, keys)| name == table && keys.contains(key));
        assert_eq!(found.count(), count, "{key} of {table}");
    }
    // Whatever moves has an event and these.
    let mut moves = documented.remove("Velocity").unwrap();
    moves.extend(["time", "position"].map(str::to_owned));
    assert_eq!(moves, &(&documented["camera"] & &documented["body"]) & &documented["light"]);
    for (table, keys) in &known {
        assert_eq!(documented.get(table), Some(keys), "{table}: in the document (left) and known");
    }
    documented.retain(|section, keys| !keys.is_empty() && known.iter().all(|(table, _)| table != section));
    assert!(documented.is_empty(), "of no table: {documented:?}");
}

#[test]
fn every_example_is_a_scene() {
    let pieces = pieces();
    let examples: Vec<_> =
        pieces.iter().skip(1).step_by(2).filter_map(|block| block.strip_prefix("toml")).collect();
    assert!(examples.len() >= 5, "{}", examples.len());
    for example in examples {
        match parse_scene(example, Path::new("example.toml")) {
            Ok(scene) => assert!(scene.camera().is_ok(), "{example}"),
            Err(e) => panic!("{example}\n{e}"),
        }
    }
}
