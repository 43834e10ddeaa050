//! `terrell animate` as its users meet it.

#[path = "common/program.rs"]
mod program;

use program::{bad, good, pixels, terrell};

const SMALL: [&str; 4] = ["--size", "64x48", "--frames", "4"];

fn film<'a>(words: &[&'a str]) -> Vec<&'a str> {
    [&["animate"], words, &SMALL].concat()
}

#[test]
fn a_folder_goes_on_where_it_was_stopped_and_notices_what_changed() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let words = film(&["cube", "-o", "film/"]);
    assert!(good(&words, here).contains("4 frames"));
    let frame = |i: usize| here.join(format!("film/frame_{i:05}.png"));
    let written = |i: usize| frame(i).metadata().unwrap().modified().unwrap();
    let (first, lost) = (written(0), pixels(frame(2)));
    std::fs::remove_file(frame(2)).unwrap();
    assert!(good(&words, here).contains("3 frames there already"));
    assert_eq!((written(0), pixels(frame(2))), (first, lost));
    let changed = good(&film(&["cube", "--beta", "0.5", "-o", "film"]), here);
    assert!(changed.contains("changed") && changed.contains("4 frames drawn anew"), "{changed}");
    assert_ne!(written(0), first);
    // In the middle of its way the cube looks otherwise at another speed.
    let again = good(&["animate", "cube", "--size", "64x48", "--frames", "2", "--quiet", "-o", "film"], here);
    assert!(again.is_empty() && !frame(2).exists());
    std::fs::write(frame(9), "a picture of someone else").unwrap();
    assert!(bad(&words, here).contains("frame_00009.png"));
}

#[test]
fn every_format_is_written_and_nothing_is_left_of_what_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (name, start) in [("a.mp4", &b"ftyp"[..]), ("a.gif", b"GIF89a"), ("a.apng", b"\x89PNG")] {
        good(&film(&["cube", "-o", name]), here);
        let bytes = std::fs::read(here.join(name)).unwrap();
        assert!(bytes[..16].windows(start.len()).any(|w| w == start), "{name}");
    }
    let gif = std::io::BufReader::new(std::fs::File::open(here.join("a.gif")).unwrap());
    use image::AnimationDecoder;
    assert_eq!(image::codecs::gif::GifDecoder::new(gif).unwrap().into_frames().count(), 4);
    let before = std::fs::read_dir(here).unwrap().count();
    for (words, part) in [
        (film(&["cube", "-o", "b.avi"]), ".avi"),
        (film(&["cube", "-o", "no/b.mp4"]), "no folder"),
        (film(&["cube", "-o", "b.gif", "--fps", "100"]), "100"),
        (film(&["cube", "-o", "b.mp4", "--fps", "0"]), "fps"),
        (vec!["animate", "cube", "--frames", "0"], "0 frames"),
        (film(&["cube", "--beta", "0,0,0", "--time", "0,nan"]), "finite"),
        (film(&["cube", "--range", "1"]), "FROM,TO"),
        (film(&["cube", "--apparent", "tram"]), "tram"),
        (film(&["cube", "--apparent", "cube", "--time", "0,1"]), "--time"),
        (film(&["cubes"]), "'cube'"),
    ] {
        let message = terrell(&words, here);
        assert_eq!(message.status.code(), Some(2), "{words:?}");
        let message = String::from_utf8_lossy(&message.stderr).into_owned();
        assert!(message.contains(part), "{words:?}: {message}");
    }
    assert_eq!(std::fs::read_dir(here).unwrap().count(), before);
}

#[test]
fn what_rests_cannot_be_filmed_unless_a_camera_goes_round_it() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let body = "[[body]]\nmesh = \"cube\"\n[camera]\nsize = [64, 48]\n";
    std::fs::write(here.join("still.toml"), body).unwrap();
    assert!(bad(&["animate", "still.toml"], here).contains("nothing moves"));
    let round = format!(
        "{body}[animation]\nframes = 3\n
        [[animation.key]]\ntime = 0\nposition = [-4, 0, 0]\nlook_at = [0, 0, 0]\n
        [[animation.key]]\ntime = 20\nposition = [0, -4, 0]\nlook_at = [0, 0, 0]\n
        [[animation.key]]\ntime = 40\nposition = [4, 0, 0]\nlook_at = [0, 0, 0]\n"
    );
    std::fs::write(here.join("round.toml"), &round).unwrap();
    good(&["animate", "round.toml", "-o", "round/", "--color", "geometry"], here);
    // Yellow, green, blue: the cube's sides.
    let middle = |i: usize| pixels(here.join(format!("round/frame_{i:05}.png"))).get_pixel(32, 24).0;
    let [a, b, c] = [0, 1, 2].map(middle);
    assert!(a[0] > 200 && a[1] > 200 && a[2] < 120, "{a:?}");
    assert!(b[1] > 200 && b[0] < 150, "{b:?}");
    assert!(c[2] > 200 && c[0] < 180, "{c:?}");
    std::fs::write(here.join("fast.toml"), round.replace("time = 20", "time = 2")).unwrap();
    let message = bad(&["animate", "fast.toml"], here);
    assert!(message.contains("fast.toml:") && message.contains("light speed"), "{message}");
}

#[test]
fn beside_the_standard_it_is_the_film_in_slow_motion() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    good(&film(&["cube", "--beside-standard", "-o", "both/"]), here);
    good(&film(&["cube", "--beta", "0", "-o", "slow/"]), here);
    good(&film(&["cube", "-o", "fast/"]), here);
    for i in 0..4 {
        let frame = |folder: &str| pixels(here.join(format!("{folder}/frame_{i:05}.png")));
        let both = frame("both");
        assert_eq!((both.width(), both.height()), (130, 48));
        let half = |x| image::imageops::crop_imm(&both, x, 0, 64, 48).to_image();
        assert_eq!(half(0), frame("slow"), "{i}");
        assert_eq!(half(66), frame("fast"), "{i}");
    }
}

#[test]
fn several_scenes_are_one_film() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let json = good(&film(&["gate", "gate_back", "-o", "g.apng", "--json", "-"]), here);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((json["frames"].as_u64(), json["takes"][1]["scene"].as_str()), (Some(8), Some("gate_back")));
    assert!(json["seconds"]["whole"].as_f64().unwrap() > 0.0);
    #[cfg(target_os = "linux")]
    assert!(json["peak_memory_bytes"].as_u64().unwrap() > 1_000_000);
    std::fs::write(here.join("s.toml"), "camera = { size = [60, 60] }\n[[body]]\nmesh = \"cube\"\nvelocity = [0.5, 0, 0]\nposition = [0, 3, 0]\n").unwrap();
    assert!(bad(&["animate", "cube", "s.toml"], here).contains("60x60"));
}

/// Ctrl-C: what there is then is whole, and goes on.
#[cfg(unix)]
#[test]
fn stopped_by_its_user_it_leaves_whole_frames() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let words = ["animate", "gate", "--size", "200x150", "--frames", "3000", "-o", "film/"];
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("terrell"))
        .args(words)
        .current_dir(here)
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    while !here.join("film/frame_00003.png").exists() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let id = child.id().to_string();
    std::process::Command::new("kill").args(["-INT", &id]).status().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let frames: Vec<_> = std::fs::read_dir(here.join("film")).unwrap().map(|f| f.unwrap().path()).collect();
    let frames: Vec<_> = frames.into_iter().filter(|f| f.extension().is_some_and(|e| e == "png")).collect();
    assert!(frames.len() >= 4 && frames.len() < 3000);
    assert!(frames.iter().all(|f| pixels(f.clone()).width() == 200));
    assert_eq!(
        std::fs::read_dir(here.join("film")).unwrap().count(),
        frames.len() + 1,
        "frames and their list"
    );
}

/// On a fast path the standard is at the same places, and sees nothing aberrated: as a camera at rest there.
#[test]
fn the_standard_of_a_camera_path_is_slow() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let scene = |key: &str| {
        format!(
            "[camera]\nsize = [64, 48]\n[[body]]\nmesh = \"cube\"\nposition = [0, 6, 0]\n[animation]\nframes = 3\n
            [[animation.key]]\ntime = 0\nposition = [-1, 0, 0]\nforward = [0, 1, 0]\n
            [[animation.key]]\n{key}\nforward = [0, 1, 0]\n"
        )
    };
    std::fs::write(here.join("fast.toml"), scene("time = 2.5\nposition = [1, 0, 0]")).unwrap();
    good(&["animate", "fast.toml", "--beside-standard", "-o", "both/"], here);
    good(&["animate", "fast.toml", "-o", "fast/"], here);
    std::fs::write(here.join("slow.toml"), scene("time = 2500000\nposition = [1, 0, 0]")).unwrap();
    good(&["animate", "slow.toml", "-o", "slow/"], here);
    for i in 0..3 {
        let frame = |folder: &str| pixels(here.join(format!("{folder}/frame_{i:05}.png")));
        let half = |x| image::imageops::crop_imm(&frame("both"), x, 0, 64, 48).to_image();
        assert_eq!(half(0), frame("slow"), "{i}");
        assert_eq!(half(66), frame("fast"), "{i}");
        assert_ne!(half(0), half(66), "{i}");
    }
    // One picture is from the path, too.
    good(&["render", "fast.toml", "--time", "2.5", "-o", "end.png"], here);
    assert_eq!(pixels(here.join("end.png")), pixels(here.join("fast/frame_00002.png")));
}

#[test]
fn nothing_that_was_read_is_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(2, 2, image::Rgb([200, 10, 10]))
        .write_to(&mut png, image::ImageFormat::Png)
        .unwrap();
    let files: [(&str, &[u8]); 4] = [
        ("in.toml", b"[[body]]\nmesh = \"a.obj\"\nvelocity = [0.5, 0, 0]\nposition = [0, 3, 0]\n"),
        (
            "a.obj",
            b"mtllib b.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n",
        ),
        ("b.mtl", b"newmtl m\nKd 1 1 1\nmap_Kd tex.png\n"),
        ("tex.png", png.get_ref()),
    ];
    for (name, contents) in files {
        std::fs::write(here.join(name), contents).unwrap();
    }
    for words in [
        vec!["render", "in.toml", "-o", "x.png", "--json", "in.toml"],
        vec!["render", "a.obj", "--beta", "0.5", "-o", "tex.png"],
        vec!["render", "in.toml", "-o", "./tex.png"],
        vec!["animate", "in.toml", "--frames", "2", "-o", "x.mp4", "--json", "a.obj"],
        vec!["transform", "a.obj", "--beta", "0.5", "-o", "b.obj"],
        vec!["transform", "a.obj", "-o", "x.obj", "--json", "b.mtl"],
    ] {
        assert!(bad(&words, here).contains("read"), "{words:?}");
    }
    assert!(
        bad(&["animate", "cube", "--frames", "2", "-o", "q.mp4", "--json", "q.mp4"], here).contains("both")
    );
    for (name, contents) in files {
        assert_eq!(std::fs::read(here.join(name)).unwrap(), contents, "{name}");
    }
    assert_eq!(std::fs::read_dir(here).unwrap().count(), files.len());
    // What never ends is no mesh.
    #[cfg(unix)]
    {
        std::fs::write(here.join("b.mtl"), "newmtl m\nKd 1 1 1\nmap_Kd /dev/zero\n").unwrap();
        let said = good(&["render", "a.obj", "--size", "16x12", "-o", "x.png"], here);
        assert!(said.contains("no plain file"), "{said}");
    }
}

#[test]
fn films_tell_of_their_rays_and_noise() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let small = ["--size=32x18", "--frames=2", "--samples=4", "--json=told.json", "-o", "box.gif"];
    let said = good(&[&["animate", "box"], &small[..]].concat(), here);
    assert!(said.contains("noisiest frame"), "{said}");
    let told: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(here.join("told.json")).unwrap()).unwrap();
    assert_eq!(told["rays"]["from_camera"], 2 * 4 * 32 * 18, "{told:#}");
    assert!(told["rays"]["noise"].as_f64().is_some_and(|noise| noise > 0.0 && noise < 2.0), "{told:#}");
    assert_eq!(told["frames_flagged"], 0);
}
