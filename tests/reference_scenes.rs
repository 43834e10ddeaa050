//! Pictures of the public command against an independent reference: 160×120, ray traced.

mod common;
#[path = "common/scene_json.rs"]
mod scene_json;

use assert_cmd::Command;
use common::{Channels, read_exr, reference};
use serde_json::Value;

struct Case {
    json: Value,
    expected: Channels,
    folder: tempfile::TempDir,
    scene: std::path::PathBuf,
}

impl Case {
    fn new(name: &str) -> Self {
        let text = std::fs::read_to_string(reference(&format!("scenes/{name}.json"))).unwrap();
        let json: Value = serde_json::from_str(&text).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let scene = scene_json::write_scene(&json, folder.path()).unwrap();
        Self { expected: read_exr(&reference(&format!("scenes/{name}.exr"))), json, folder, scene }
    }

    fn render(&self, tolerance: f64) -> Channels {
        let out = self.folder.path().join("out.exr");
        Command::cargo_bin("terrell")
            .unwrap()
            .args(["render", self.scene.to_str().unwrap(), "-o", out.to_str().unwrap(), "--quiet"])
            .args(["--color", "geometry", "--tolerance", &tolerance.to_string()])
            .assert()
            .success();
        read_exr(&out)
    }

    /// Pixels a radian.
    fn focal(&self) -> f64 {
        let camera = &self.json["camera"];
        let number = |key: &str| camera[key].as_f64().unwrap();
        match camera["projection"].as_str().unwrap() {
            "pinhole" => 0.5 * number("height") / (0.5 * number("fov_deg").to_radians()).tan(),
            _ => number("height") / std::f64::consts::PI,
        }
    }

    fn most_doppler(&self) -> f64 {
        f64::from(self.expected["doppler"].iter().copied().fold(0.0, f32::max))
    }

    /// The polygon a triangle belongs to.
    fn polygon(&self, body: f32, face: f32) -> f32 {
        if body < 0.0 {
            return -1.0;
        }
        self.json["objects"][body as usize]["face"][face as usize].as_f64().unwrap() as f32
    }
}

/// Body and face agree on all inner pixels at the usual tolerance, D to f32, and the largest relative error of
/// distance falls with the tolerance: returns that at each tolerance.
fn compare(name: &str) -> Vec<f64> {
    let case = Case::new(name);
    let expected = &case.expected;
    let mut errors = Vec::new();
    for tolerance in [1.0, 0.25, 1.0 / 16.0, 1.0 / 64.0, 1.0 / 256.0] {
        let got = case.render(tolerance);
        let mut worst = 0f64;
        let mut compared = 0;
        for i in 0..expected["body"].len() {
            if expected["inner"][i] == 0.0 {
                continue;
            }
            let body = expected["body"][i];
            let at = format!("{name} at {tolerance} px, pixel {}, {}", i % 160, i / 160);
            if tolerance <= 0.25 {
                assert_eq!(got["body"][i], body, "{at}");
                assert_eq!(case.polygon(got["body"][i], got["face"][i]), expected["face"][i], "{at}");
            }
            if body >= 0.0 && got["body"][i] == body {
                compared += 1;
                let ratio = f64::from(got["distance"][i]) / f64::from(expected["distance"][i]);
                assert!(ratio.is_finite(), "{at}");
                worst = worst.max((ratio - 1.0).abs());
                let ratio = f64::from(got["doppler"][i]) / f64::from(expected["doppler"][i]);
                // Both are rounded to f32.
                assert!((ratio - 1.0).abs() < 2.0 * f64::from(f32::EPSILON), "{at}: {ratio}");
                let own = &case.json["objects"][body as usize]["emission"][got["face"][i] as usize];
                for (channel, value) in ["R", "G", "B"].iter().zip(own.as_array().unwrap()) {
                    let off = f64::from(got[*channel][i]) - value.as_f64().unwrap();
                    assert!(off.abs() < 1e-6, "{at}: colours are the mesh's own");
                }
            } else if body < 0.0 && got["body"][i] < 0.0 {
                assert_eq!(got["distance"][i], expected["distance"][i]);
            }
        }
        assert!(compared > 300, "{name}: only {compared} pixels compared");
        errors.push(worst);
        // What subdivision promises of a surface: 4 tolerances across the line of sight, 4/3 of it in the middle
        // of a piece, and as much along it, stretched by D where D > 1. In the limit of small pieces.
        let most = case.most_doppler().max(1.0);
        // A sphere is seen at grazing angles, where a line of sight meets a displaced surface much nearer or farther.
        if tolerance <= 0.25 && name != "sphere_b090" {
            let promised = 16.0 / 3.0 * tolerance / case.focal() * most;
            assert!(
                worst <= promised + 2.0 * f64::from(f32::EPSILON),
                "{name} at {tolerance} px: {worst} > {promised}"
            );
        }
    }
    println!(
        "{name}: worst relative error of distance {:?}",
        errors.iter().map(|e| format!("{e:.1e}")).collect::<Vec<_>>()
    );
    errors
}

/// First order in the tolerance: from ¼ px to 1/256 px the error falls 64-fold, less what is left to chance of
/// where the worst pixel lies on its piece.
fn converges(name: &str) {
    let errors = compare(name);
    assert!(errors[4] < errors[1] / 20.0 || errors[4] < 1e-6, "{name}: {errors:?}");
}

#[test]
fn cube_at_rest() {
    let errors = compare("cube_b000");
    assert!(errors.iter().all(|e| *e < 2.0 * f64::from(f32::EPSILON)), "nothing to cut: exact");
}

#[test]
fn cube() {
    converges("cube_b090");
}

#[test]
fn lattice() {
    converges("lattice_b090");
}

#[test]
fn gate_pinhole() {
    converges("gate_b099_x6.0");
}

#[test]
fn gate_panorama() {
    converges("gate_b099_x1.5_equirect");
}

/// Its triangles are small from the start, so that the first cuts come late.
#[test]
fn sphere() {
    let errors = compare("sphere_b090");
    assert!(errors.is_sorted_by(|a, b| a >= b) && errors[4] < errors[0] / 2.0, "{errors:?}");
}

#[test]
fn bodies_with_opposite_velocities() {
    converges("opposed_b090");
}
