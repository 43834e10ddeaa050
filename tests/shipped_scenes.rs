//! The scenes that ship show what they say they show.

use terrell::color::Coloring;
use terrell::film::Film;
use terrell::plan::cheapest;
use terrell::render::{Options, render};
use terrell::scene::{Scene, builtin_scenes};

fn scene(name: &str) -> Scene {
    builtin_scenes().iter().find(|s| s.name == name).unwrap().scene()
}

fn film(mut scene: Scene, size: [u32; 2]) -> Film {
    scene.view.size = size;
    let options = Options { method: cheapest(&scene, Coloring::Doppler).0, ..Options::default() };
    render(&scene, &scene.camera().unwrap(), &options, |_| ()).unwrap().0
}

#[test]
fn every_body_is_in_the_picture() {
    for builtin in builtin_scenes() {
        let scene = builtin.scene();
        let film = film(scene.clone(), [320, 180]);
        for (index, body) in scene.bodies.iter().enumerate() {
            let pixels = film.body.iter().filter(|&&b| b == index as i32).count();
            assert!(pixels > 200, "{}: {pixels} pixels of '{}'", builtin.name, body.name);
        }
    }
}

/// Penrose: the outline is the same circle at every speed. Here to a pixel of some 260 across.
#[test]
fn spheres_keep_their_outline() {
    let scene = scene("sphere");
    let film = film(scene.clone(), [1280, 720]);
    let outline = |body: i32| {
        let seen = (0..film.body.len()).filter(|&i| film.body[i] == body);
        let (mut low, mut high, mut count) = ([usize::MAX; 2], [0; 2], 0);
        for pixel in seen {
            let at = [pixel % 1280, pixel / 1280];
            low = [low[0].min(at[0]), low[1].min(at[1])];
            high = [high[0].max(at[0]), high[1].max(at[1])];
            count += 1;
        }
        ([high[0] - low[0] + 1, high[1] - low[1] + 1], count)
    };
    let ([width, height], resting) = outline(0);
    assert!(width.abs_diff(height) <= 1);
    let disc = 0.25 * std::f64::consts::PI * (width * height) as f64;
    assert!((f64::from(resting) / disc - 1.0).abs() < 0.01);
    for body in 1..scene.bodies.len() as i32 {
        let ([w, h], count) = outline(body);
        // Off the middle a pinhole stretches by 1/cos 5°, half a pixel more or less.
        assert!(w.abs_diff(width) <= 2 && h.abs_diff(height) <= 2, "{body}: {w} × {h}, {width} × {height}");
        assert!((f64::from(count) / f64::from(resting) - 1.0).abs() < 0.01, "{body}: {count} of {resting}");
    }
}

/// In one row of pixels piers hide the train, and the wall is seen behind it.
#[test]
fn the_train_hides_and_is_hidden() {
    let scene = scene("train");
    let [train, station] =
        ["train", "station"].map(|name| scene.bodies.iter().position(|b| b.name == name).unwrap() as i32);
    let film = film(scene, [640, 360]);
    let row = 205 * 640..206 * 640;
    let of = |body: i32| -> Vec<f32> {
        row.clone().filter(|&i| film.body[i] == body).map(|i| film.distance[i]).collect()
    };
    let (train, station) = (of(train), of(station));
    let near = train.iter().copied().fold(f32::INFINITY, f32::min);
    let far = train.iter().copied().fold(0.0, f32::max);
    assert!(train.len() > 250, "{}", train.len());
    assert!(station.iter().filter(|&&d| d < near).count() > 60, "piers before the train");
    // Through the windows.
    assert!(station.iter().any(|&d| d > near + 5.0), "the wall behind the train: {near} to {far}");
}

#[test]
fn what_moves_in_the_street_is_seen_to_pass() {
    for (name, gamma) in
        [("tram", 1.0 / 0.6), ("car", 1.0 / 0.75f64.sqrt()), ("oncoming", 1.0 / 0.19f64.sqrt())]
    {
        let mut street = scene("street");
        street.view.nearest = Some(name.into());
        let body = street.bodies.iter().position(|b| b.name == name).unwrap() as i32;
        let film = film(street, [320, 180]);
        let factors =
            (0..film.body.len()).filter(|&i| film.body[i] == body).map(|i| f64::from(film.doppler[i]));
        let (low, high) = factors.fold((f64::INFINITY, 0f64), |(l, h), d| (l.min(d), h.max(d)));
        // Abreast, D = 1/γ at the middle.
        assert!(low < 1.0 / gamma && 1.0 / gamma < high, "{name}: {low} to {high}");
    }
    let mut street = scene("street");
    street.view.nearest = Some("parked".into());
    assert!(street.camera().is_err());
}
