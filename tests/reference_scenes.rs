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

    fn render(&self, method: &str, tolerance: f64) -> Channels {
        let out = self.folder.path().join("out.exr");
        Command::cargo_bin("terrell")
            .unwrap()
            .args(["render", self.scene.to_str().unwrap(), "-o", out.to_str().unwrap(), "--quiet"])
            .args(["--color", "flat", "--method", method])
            .args((method == "apparent").then(|| format!("--tolerance={tolerance}")))
            .assert()
            .success();
        read_exr(&out)
    }

    /// The polygon a triangle belongs to.
    fn polygon(&self, body: f32, face: f32) -> f32 {
        if body < 0.0 {
            return -1.0;
        }
        self.json["objects"][body as usize]["face"][face as usize].as_f64().unwrap() as f32
    }
}

/// Body and face agree on all inner pixels at the usual tolerance and finer, D to f32; returns the largest relative
/// error of the distance at each tolerance.
fn compare(name: &str) -> Vec<f64> {
    let case = Case::new(name);
    let expected = &case.expected;
    let mut errors = Vec::new();
    for tolerance in [1.0, 0.25, 1.0 / 16.0, 1.0 / 64.0, 1.0 / 256.0] {
        let got = case.render("apparent", tolerance);
        let peak = ["R", "G", "B"].iter().flat_map(|c| &expected[*c]).copied().fold(0.0, f32::max);
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
                // D³ times the surface's own colour. The sphere's polygons are of several colours; on its inner edges
                // the reference may see another.
                let right = case.polygon(body, got["face"][i]) == expected["face"][i];
                for channel in ["R", "G", "B"].into_iter().filter(|_| right) {
                    let off = got[channel][i] - expected[channel][i];
                    // Both are rounded to f32, D three times.
                    assert!(off.abs() <= 1e-6 * peak, "{at}: {off} of {peak}");
                }
            } else if body < 0.0 && got["body"][i] < 0.0 {
                assert_eq!(got["distance"][i], expected["distance"][i]);
            }
        }
        assert!(compared > 300, "{name}: only {compared} pixels compared");
        errors.push(worst);
    }
    println!(
        "{name}: worst relative error of distance {:?}",
        errors.iter().map(|e| format!("{e:.1e}")).collect::<Vec<_>>()
    );
    errors
}

/// Where a pixel sees the right triangle, its distance is exact: it is that of the triangle's own plane, whatever the
/// tolerance the outline was drawn with. 1 px is the outline's business: some inner pixels see a neighbour.
fn is_exact(name: &str) {
    let errors = compare(name);
    assert!(errors[1..].iter().all(|e| *e <= 2.0 * f64::from(f32::EPSILON)), "{name}: {errors:?}");
}

#[test]
fn cube_at_rest() {
    is_exact("cube_b000");
}

#[test]
fn cube() {
    is_exact("cube_b090");
}

#[test]
fn lattice() {
    is_exact("lattice_b090");
}

#[test]
fn gate_pinhole() {
    is_exact("gate_b099_x6.0");
}

#[test]
fn gate_panorama() {
    is_exact("gate_b099_x1.5_equirect");
}

/// Its polygons are groups of triangles not in one plane, of which a pixel on an edge inside may see another than
/// the reference: the ball is 1 across 100 pixels, so within its roundness over a pixel.
#[test]
fn sphere() {
    let errors = compare("sphere_b090");
    assert!(errors.iter().all(|e| *e < 1e-4), "{errors:?}");
}

#[test]
fn bodies_with_opposite_velocities() {
    is_exact("opposed_b090");
}

/// Lit by a lamp, at rest or in motion. Shadows are not drawn: what is in the reference's shadow is brighter here, all
/// else is as bright.
fn is_lit_right(name: &str) {
    let case = Case::new(name);
    let (expected, got) = (&case.expected, case.render("apparent", 0.25));
    let peak = expected["R"].iter().copied().fold(0.0, f32::max);
    let [mut bright, mut dark] = [0; 2];
    for i in (0..expected["body"].len()).filter(|&i| expected["inner"][i] != 0.0) {
        let at = format!("{name}, pixel {}, {}", i % 160, i / 160);
        assert_eq!(got["body"][i], expected["body"][i], "{at}");
        if expected["lit0"][i] == 0.0 {
            dark += 1;
            assert_eq!(expected["R"][i], 0.0, "{at}");
            continue;
        }
        bright += 1;
        for channel in ["R", "G", "B"] {
            let off = got[channel][i] - expected[channel][i];
            assert!(off.abs() <= 1e-6 * peak, "{at}: {off} of {peak}");
        }
    }
    assert!(bright > 5000 && dark > 100, "{bright} {dark}");
}

#[test]
fn lamp_at_rest() {
    is_lit_right("shadow_cube_b050");
}

#[test]
fn lamp_in_motion() {
    is_lit_right("shadow_lamp_on_cube_b060");
}

/// Traced, every inner pixel is as the reference has it, shadows and all. Both files are rounded to f32; light of lamps is a
/// product of some ten factors.
fn is_traced_right(name: &str, method: &str) {
    let case = Case::new(name);
    let (expected, got) = (&case.expected, case.render(method, 0.25));
    let peak = ["R", "G", "B"].iter().flat_map(|c| &expected[*c]).copied().fold(0.0, f32::max);
    let [mut compared, mut others] = [0; 2];
    for i in (0..expected["body"].len()).filter(|&i| expected["inner"][i] != 0.0) {
        let at = format!("{name}, pixel {}, {}", i % 160, i / 160);
        assert_eq!(got["body"][i], expected["body"][i], "{at}");
        if expected["body"][i] < 0.0 {
            assert_eq!(got["distance"][i], 0.0);
            continue;
        }
        compared += 1;
        for channel in ["distance", "doppler"] {
            let ratio = f64::from(got[channel][i]) / f64::from(expected[channel][i]);
            assert!((ratio - 1.0).abs() <= 2.0 * f64::from(f32::EPSILON), "{at}: {channel} {ratio}");
        }
        if case.polygon(got["body"][i], got["face"][i]) != expected["face"][i] {
            others += 1;
            continue;
        }
        for channel in ["R", "G", "B"] {
            let off = got[channel][i] - expected[channel][i];
            assert!(off.abs() <= 1e-6 * peak, "{at}: {off} of {peak}");
        }
    }
    assert!(compared > 300, "{name}: only {compared} pixels compared");
    // The sphere's polygons are several triangles, not in one plane.
    assert_eq!(others, 0, "{name}");
}

#[test]
fn traced() {
    for name in [
        "cube_b000",
        "cube_b090",
        "lattice_b090",
        "gate_b099_x6.0",
        "gate_b099_x1.5_equirect",
        "sphere_b090",
        "opposed_b090",
        "shadow_cube_b050",
        "shadow_lamp_on_cube_b060",
    ] {
        is_traced_right(name, "trace");
        is_traced_right(name, "exact");
    }
}
