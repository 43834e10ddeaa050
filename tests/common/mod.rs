//! Reference values, read from files beside the tests.
#![allow(dead_code, reason = "every test binary uses its own part")]

use glam::DVec3;
use serde_json::Value;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

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

/// A small, fast generator (SplitMix64), so that scenes are the same everywhere.
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In a box around the origin.
    pub fn point(&mut self, reach: f64) -> DVec3 {
        DVec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5) * 2.0 * reach
    }
}

/// Float channels by name.
pub type Channels = HashMap<String, Vec<f32>>;

/// Float channels of an EXR.
pub fn read_exr(path: &Path) -> Channels {
    use exr::prelude::*;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .unwrap();
    image
        .layer_data
        .channel_data
        .list
        .iter()
        .map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect()))
        .collect()
}
