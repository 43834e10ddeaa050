//! Reference values, read from files beside the tests.
#![allow(dead_code, reason = "every test binary uses its own part")]

use glam::DVec3;
use serde_json::Value;
use std::path::PathBuf;

/// A file of tests/reference.
pub fn reference(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "reference", name].iter().collect()
}

fn json(name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(reference(name)).unwrap()).unwrap()
}

/// Values of an independent reference, 15 to 17 digits.
pub fn cases() -> Value {
    json("cases.json")
}

/// Apparent positions to 60 digits, by make_points.py.
pub fn points() -> Vec<Value> {
    json("points.json")["rows"].as_array().unwrap().clone()
}

/// A JSON array of three numbers.
pub fn vec3(value: &Value) -> DVec3 {
    let v: Vec<f64> = value.as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
    DVec3::new(v[0], v[1], v[2])
}
