//! `teach`, run as its users run it, and its pages.

#[path = "common/program.rs"]
mod program;

use program::{bad, good, pixels};
use terrell::teach::{What, lesson, lessons, page};
/// What is to be tried is what the command takes: it is asked how it would draw, where it can be asked.
#[test]
fn commands_to_try_are_commands() {
    let folder = tempfile::tempdir().unwrap();
    for lesson in lessons() {
        for attempt in lesson.lecture().unwrap().tries {
            let words: Vec<&str> =
                attempt.command.split_whitespace().take_while(|word| *word != ">").collect();
            assert_eq!(words[0], "terrell", "{}", attempt.command);
            if words.contains(&"your.glb") {
                continue;
            }
            let mut asked = words[1..].to_vec();
            match asked[0] {
                "render" | "animate" => asked.push("--explain"),
                "compare" => asked.extend(["--size=32x18", "--repeats=1"]),
                // A few seconds, and tested elsewhere.
                "chart" => continue,
                _ => {}
            }
            good(&asked, folder.path());
        }
    }
}

#[test]
fn pages_need_nothing_else() {
    let seeing = lesson("rods").unwrap();
    let lecture = seeing.lecture().unwrap();
    // Films take their time; this lesson has none.
    let drawn: Vec<_> = lecture.all_plates().map(|plate| plate.draw().unwrap()).collect();
    let html = page(seeing, &lecture, &drawn, true);
    let sources: Vec<&str> = html.split("src=\"").skip(1).map(|rest| &rest[..20.min(rest.len())]).collect();
    assert_eq!(sources.len(), lecture.all_plates().count());
    assert!(sources.iter().all(|source| source.starts_with("data:image/")), "{sources:?}");
    assert!(!html.contains("href=\"http") && !html.contains("<script"));
    for open in ["main", "p", "table", "figure", "figcaption", "dl", "details", "nav", "code", "em"] {
        let count = |tag: &str| html.matches(tag).count();
        let begun = count(&format!("<{open}>")) + count(&format!("<{open} "));
        assert_eq!(begun, count(&format!("</{open}>")), "{open}");
    }
    assert!(html.contains("lattice.html") && html.contains("seeing.html") && html.contains("index.html"));
    let films = lessons().iter().flat_map(|lesson| lesson.lecture().unwrap().parts).count();
    assert!(films > 8 * 6);
    let reels = |lesson: &terrell::teach::Lesson| {
        let lecture = lesson.lecture().unwrap();
        lecture.all_plates().filter(|plate| matches!(plate.what, What::Reel(_))).count()
    };
    assert!(lessons().iter().map(reels).sum::<usize>() >= 4);
}

#[test]
fn the_command_lists_tells_answers_and_draws() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let list = good(&["teach"], here);
    assert!(lessons().iter().all(|lesson| list.contains(lesson.title)), "{list}");
    let text = good(&["teach", "doppler"], here);
    assert!(
        text.contains("6.2450") && text.contains("0.1601") && text.contains("terrell teach doppler --answer")
    );
    assert!(good(&["teach", "doppler", "--answer"], here).contains("3.0000 and 0.3333"));
    assert_eq!(std::fs::read_dir(here).unwrap().count(), 0);
    good(&["teach", "doppler", "--answer", "--json", "answer.json"], here);
    assert!(std::fs::read_to_string(here.join("answer.json")).unwrap().contains("3.0000 and 0.3333"));
    let said = good(&["teach", "rods", "--html", "-o", "made", "--json", "told.json"], here);
    assert!(said.contains("open made/rods.html"), "{said}");
    for file in ["rods.html", "rods-hyperbolas.svg", "rods-hyperbolas.png", "rods-mast.png"] {
        assert!(here.join("made").join(file).is_file(), "{file}");
    }
    let mast = pixels(here.join("made/rods-mast.png"));
    assert!(mast.dimensions() == (640, 360) && mast.pixels().filter(|p| p.0 != [0; 3]).count() > 5000);
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(here.join("told.json")).unwrap()).unwrap();
    assert!(json["lessons"][0]["numbers"]["answer: coming"].as_f64().unwrap() < -11.0);
    for (arguments, part) in [
        (&["teach", "dopler"][..], "doppler"),
        (&["teach", "cube", "--html"], "--output"),
        (&["teach", "-o", "there"], "--all"),
        (&["teach", "--answer"], "--all"),
        (&["teach", "cube", "--all"], "--all"),
        (&["teach", "rods", "-o", "told.json"], "not a folder"),
    ] {
        let said = bad(arguments, here);
        assert!(said.contains(part), "{arguments:?}: {said}");
    }
    assert!(!here.join("there").exists());
}
