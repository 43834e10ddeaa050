use crate::scene::velocity::Velocity;
use glam::DVec3;
use serde_json::Value;
use terrell_geodesic::Celerity;

/// What a node's `extras` say of its motion.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Extras {
    /// The velocity in the world.
    pub celerity: Option<Celerity>,
    /// World time at which the node is where the file puts it.
    pub time: f64,
    /// Of a camera: the body that is to be seen abreast.
    pub nearest: Option<String>,
}

impl Extras {
    /// Reads `velocity` (β) or `celerity` (γβ), three numbers each; or `beta`, `gamma` or `rapidity` with a
    /// `direction`; `time`; `nearest`. Other keys are other programs'.
    ///
    /// Vectors are in the file's axes, unless `z_up`: Blender turns a scene's axes on writing, but not what its
    /// users have written into custom properties.
    pub fn read(extras: &gltf::json::Extras, z_up: bool) -> Result<Self, String> {
        let Some(raw) = extras else { return Ok(Self::default()) };
        let Ok(Value::Object(keys)) = serde_json::from_str(raw.get()) else { return Ok(Self::default()) };
        let number = |key: &str| match keys.get(key) {
            None => Ok(None),
            Some(value) => {
                let number = value.as_f64().filter(|v| v.is_finite());
                number.map(Some).ok_or_else(|| format!("{key}: {value} is not a finite number"))
            }
        };
        let vector = |key: &str| {
            let Some(value) = keys.get(key) else { return Ok(None) };
            let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
            let numbers: Vec<f64> = list.iter().filter_map(Value::as_f64).filter(|v| v.is_finite()).collect();
            match numbers[..] {
                [x, y, z] if list.len() == 3 => {
                    Ok(Some(if z_up { DVec3::new(x, z, -y) } else { DVec3::new(x, y, z) }))
                }
                _ => Err(format!("{key}: {value} is not a list of three finite numbers")),
            }
        };
        let velocity = Velocity {
            velocity: vector("velocity")?,
            celerity: vector("celerity")?,
            beta: number("beta")?,
            gamma: number("gamma")?,
            rapidity: number("rapidity")?,
            direction: vector("direction")?,
        };
        Ok(Self {
            celerity: velocity.told().map_err(|e| e.message)?,
            time: number("time")?.unwrap_or(0.0),
            nearest: keys.get("nearest").and_then(Value::as_str).map(str::to_owned),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(json: &str, z_up: bool) -> Result<Extras, String> {
        Extras::read(&Some(serde_json::value::RawValue::from_string(json.to_owned()).unwrap()), z_up)
    }

    #[test]
    fn velocities_in_all_ways_and_axes() {
        let beta = |json, z_up| read(json, z_up).unwrap().celerity.unwrap().beta();
        assert!((beta(r#"{"velocity": [0, 0.6, 0]}"#, false) - DVec3::Y * 0.6).length() < 1e-15);
        assert!((beta(r#"{"velocity": [0, 0.6, 0]}"#, true) + DVec3::Z * 0.6).length() < 1e-15);
        assert!((beta(r#"{"velocity": [0, 0, 0.6]}"#, true) - DVec3::Y * 0.6).length() < 1e-15);
        assert!((beta(r#"{"beta": 0.6, "direction": [0, 0, -3]}"#, false) + DVec3::Z * 0.6).length() < 1e-15);
        assert!((beta(r#"{"gamma": 1.25}"#, false) - DVec3::X * 0.6).length() < 1e-15);
        assert_eq!(read(r#"{"comment": "fast", "velocities": 3}"#, false), Ok(Extras::default()));
        assert_eq!(read("[1]", false), Ok(Extras::default()));
        for bad in [
            r#"{"velocity": [1, 0, 0]}"#,
            r#"{"velocity": 0.9}"#,
            r#"{"velocity": [0, 0, "x"]}"#,
            r#"{"velocity": [0.1, 0, 0], "gamma": 2}"#,
            r#"{"velocity": [0.1, 0, 0], "direction": [1, 0, 0]}"#,
            r#"{"direction": [1, 0, 0]}"#,
            r#"{"gamma": 0.5}"#,
            r#"{"beta": 0.5, "direction": [0, 0, 0]}"#,
            r#"{"time": "now"}"#,
        ] {
            assert!(read(bad, false).is_err(), "{bad}");
        }
    }
}
