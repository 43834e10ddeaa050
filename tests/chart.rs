//! `terrell chart`, as its users meet it.

#[path = "common/program.rs"]
mod program;

use program::{bad, good, pixels};
use serde_json::Value;
use std::path::Path;

const TINY: [&str; 5] = ["--quick", "--size=96x54", "--repeats=1", "--samples=1", "-q"];

fn chart(words: &[&str], folder: &Path) -> String {
    good(&[&["chart"], words, &TINY].concat(), folder)
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&read(path)).unwrap()
}

/// A table without quoted fields, by its header.
fn rows(csv: &str) -> Vec<Vec<(&str, &str)>> {
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &'_ str| line.split(',').count();
    assert!(csv.lines().all(|line| row(line) == header.len()), "{csv}");
    lines.map(|line| header.iter().copied().zip(line.split(',')).collect()).collect()
}

/// Every element of a document is closed in its turn, and what attributes hold is quoted.
fn assert_is_well_formed(xml: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = xml;
    while let Some(start) = rest.find('<') {
        let text = &rest[..start];
        assert!(!text.contains('>'), "a bare > in {text}");
        for entity in text.split('&').skip(1) {
            assert!(
                ["amp;", "lt;", "gt;", "quot;"].iter().any(|known| entity.starts_with(known)),
                "&{entity}"
            );
        }
        let end = start + rest[start..].find('>').expect("a tag ends");
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        match tag.as_bytes()[0] {
            b'?' => {}
            b'/' => assert_eq!(open.pop(), Some(&tag[1..])),
            _ if tag.ends_with('/') => {}
            _ => open.push(tag.split_whitespace().next().unwrap()),
        }
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?} {rest}");
}

fn texts(svg: &str) -> Vec<String> {
    let parts = svg.split("</text>").filter_map(|part| part.rsplit_once('>'));
    parts.map(|(_, text)| text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")).collect()
}

fn number(point: &Value, column: &str) -> f64 {
    point[column].as_f64().unwrap_or_else(|| panic!("{column} of {point}"))
}

#[test]
fn a_scene_is_charted_and_all_files_say_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let said = chart(&["cube", "--json", "told.json"], here);
    assert_eq!(said, "");
    let told = json(&here.join("chart.json"));
    assert_eq!(told, json(&here.join("told.json")));
    let points = told["points"].as_array().unwrap();
    let csv = read(&here.join("chart.csv"));
    let rows = rows(&csv);
    assert_eq!(rows.len(), points.len());
    for (row, point) in rows.iter().zip(points) {
        for (column, field) in row {
            match &point[column] {
                Value::Null => assert_eq!(*field, "", "{column}"),
                Value::String(text) => assert_eq!(field, text, "{column}"),
                Value::Bool(is_so) => assert_eq!(*field, is_so.to_string(), "{column}"),
                // JSON is read here to the last digit but one.
                number => {
                    let (a, b) = (field.parse::<f64>().unwrap(), number.as_f64().unwrap());
                    assert!((a - b).abs() <= 2.0 * f64::EPSILON * b.abs(), "{column}: {field} for {number}");
                }
            }
        }
        assert!(rows[0].iter().map(|(c, _)| c).eq(row.iter().map(|(c, _)| c)));
    }
    for column in
        ["frame_ms_median", "edge_displacement_px_worst", "light_rms_relative", "flip_mean", "pareto_light"]
    {
        assert!(rows[0].iter().any(|(known, _)| *known == column), "{column}");
    }
    let svg = read(&here.join("chart.svg"));
    assert_is_well_formed(&svg);
    let texts = texts(&svg);
    for text in [
        "cube, 0.9c, 96×54: outlines",
        "worst displacement, px",
        "time of a picture, ms",
        "exact",
        "trace",
        "apparent",
        "painter",
        "uncut",
        "D at vertices",
        "f32 vertices",
        "Pareto front",
        "<10⁻⁶",
    ] {
        assert!(texts.iter().any(|known| known == text), "{text} of {texts:?}");
    }
    let png = pixels(here.join("chart.png"));
    assert!(png.width() > 800 && png.pixels().any(|p| p.0 != [255; 3]));
}

#[test]
fn errors_are_as_they_have_to_be() {
    let folder = tempfile::tempdir().unwrap();
    chart(&["gate", "--beta", "0.9", "--tolerance", "2,1/8", "-o", "gate.json"], folder.path());
    let told = json(&folder.path().join("gate.json"));
    let points = told["points"].as_array().unwrap();
    let of = |series: &str| -> Vec<&Value> { points.iter().filter(|p| p["series"] == series).collect() };
    // The lines of sight of rays and of exact shading are the same: they see the same, where it is.
    for series in ["exact", "trace"] {
        let [point] = of(series)[..] else { panic!("{series}") };
        assert_eq!(number(point, "silhouette_pixels") + number(point, "edge_pixels"), 0.0, "{point}");
        assert_eq!(number(point, "light_same_rays_rms_relative"), 0.0);
        // Rounding of f64, thousandfold near what is seen edge-on.
        assert!(number(point, "displacement_px_worst") < 1e-9, "{point}");
    }
    let exact = number(of("exact")[0], "light_rms_relative");
    let [uncut] = of("uncut")[..] else { panic!() };
    let apparent: Vec<&Value> = of("apparent").into_iter().filter(|p| p["doppler_at"] == "pixel").collect();
    let worst = |p: &Value| number(p, "edge_displacement_px_worst");
    for point in &apparent {
        assert!(worst(point) <= number(point, "tolerance_px"), "{point}");
        assert!(worst(point) > number(of("exact")[0], "displacement_px_worst"));
    }
    let tolerances: Vec<f64> = apparent.iter().map(|p| number(p, "tolerance_px")).collect();
    assert!(tolerances.contains(&2.0) && tolerances.contains(&0.125), "{tolerances:?}");
    let at = |tolerance: f64| *apparent.iter().find(|p| number(p, "tolerance_px") == tolerance).unwrap();
    let (coarse, fine) = (at(2.0), at(0.125));
    assert!(worst(fine) < worst(coarse) && worst(coarse) < worst(uncut));
    for column in ["edge_displacement_px_rms", "edge_pixels", "light_same_rays_rms_relative"] {
        assert!(number(fine, column) < number(coarse, column), "{column}");
    }
    assert!(number(coarse, "light_rms_relative") > exact);
    let [f32s] = of("f32 vertices")[..] else { panic!() };
    assert!(f32s["frame_ms_median"].is_null() && f32s["precision"] == "f32");
    assert!(number(f32s, "displacement_px_worst") < 0.1 && number(f32s, "displacement_px_worst") > 0.0);
}

#[test]
fn the_front_is_one() {
    let folder = tempfile::tempdir().unwrap();
    chart(&["cube", "--methods", "exact,apparent,uncut", "-o", "cube.json"], folder.path());
    let told = json(&folder.path().join("cube.json"));
    let points = told["points"].as_array().unwrap();
    assert!(points.iter().all(|p| ["exact", "apparent", "uncut"].iter().any(|s| p["series"] == *s)));
    let cost = |p: &Value| {
        let error = number(p, "displacement_px_worst");
        // As it is drawn: less is rounding.
        (number(p, "frame_ms_median"), if error < 1e-6 { 0.0 } else { error })
    };
    for point in points {
        let (time, error) = cost(point);
        let beaten = points.iter().map(cost).any(|(t, e)| t <= time && e <= error && (t, e) != (time, error));
        assert_eq!(point["pareto_displacement"], !beaten, "{point}");
    }
}

/// What one way cannot draw is said with it; the others are charted.
#[test]
fn what_cannot_be_drawn_is_said() {
    let folder = tempfile::tempdir().unwrap();
    chart(&["shadow", "--methods", "exact,GPU exact", "-o", "shadow.json"], folder.path());
    let told = json(&folder.path().join("shadow.json"));
    let failed = |p: &Value| p["failed"].as_str().is_some_and(|why| why.contains("lights shine on"));
    let points = told["points"].as_array().unwrap();
    assert!(points.len() >= 2 && points.iter().all(|p| failed(p) == (p["series"] == "GPU exact")));
}

#[test]
fn geodesics_are_charted() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let said = good(&["chart", "--geodesics", "--quick", "--repeats", "1", "-o", "here"], here);
    assert!(said.contains("the front of speed and accuracy") && said.contains("here.svg"), "{said}");
    let told = json(&here.join("here.json"));
    let points = told["points"].as_array().unwrap();
    assert_eq!(rows(&read(&here.join("here.csv"))).len(), points.len());
    for point in points {
        assert_eq!(point["rays_lost"], 0);
        match point["sagitta_m"].as_f64() {
            Some(sagitta) => assert!(number(point, "chord_error_m_worst") <= sagitta, "{point}"),
            // As in the sweep's own test.
            None => assert!(
                number(point, "deflection_error_rad_worst") < 100.0 * number(point, "tolerance"),
                "{point}"
            ),
        }
    }
    let svg = read(&here.join("here.svg"));
    assert_is_well_formed(&svg);
    let texts = texts(&svg);
    for text in ["Schwarzschild: against the closed form", "time of a ray, µs", "by hand, DOPRI5", "10⁻¹²"]
    {
        assert!(texts.iter().any(|known| known == text), "{text} of {texts:?}");
    }
    assert!(pixels(here.join("here.png")).width() > 800);
}

#[test]
fn mistakes_are_told_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (words, told) in [
        (&["cube", "-o", "chart.pdf"][..], "unknown chart format '.pdf'"),
        (&["cube", "-o", "nowhere/chart"], "there is no folder nowhere"),
        (&["cube", "--json", "chart.json", "--quick"], "cannot be both"),
        (&["cubes"], "did you mean 'cube'"),
        (&["blackhole"], "--geodesics"),
        (&["cube", "--beta", "1.5"], "1.5"),
    ] {
        let said = bad(&[&["chart"], words].concat(), here);
        assert!(said.contains(told), "{words:?}: {said}");
    }
    for words in [
        &["chart", "cube", "--tolerance", "0"][..],
        &["chart", "cube", "--tolerance", "1/0"],
        &["chart", "cube", "--methods", "guess"],
        &["chart", "cube", "--geodesics"],
        &["chart", "--geodesics", "--beta", "0.5"],
        &["chart", "cube", "--repeats", "0"],
    ] {
        let out = program::terrell(words, here);
        assert_eq!(out.status.code(), Some(2), "{words:?}");
        assert!(!out.stderr.is_empty());
    }
    assert_eq!(std::fs::read_dir(here).unwrap().count(), 0);
}
