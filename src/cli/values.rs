//! What flags may hold.

use glam::DVec3;
use std::ffi::OsString;
use terrell::film::Samples;
use terrell::geodesic::{Event, World};

/// A number with a minus sign is a value, never a flag: it gets a space before it, which every parser of
/// numbers here takes off again.
pub fn shield_negative(argument: OsString) -> OsString {
    let is_number = argument
        .to_str()
        .and_then(|text| text.strip_prefix('-'))
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit() || c == '.'));
    if !is_number {
        return argument;
    }
    let mut shielded = OsString::from(" ");
    shielded.push(argument);
    shielded
}

pub fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    match text.parse::<f64>() {
        // What is larger cannot be squared and added up.
        Ok(v) if v.is_finite() && v.abs() >= 1e100 => Err(format!("'{text}' is beyond 1e100")),
        Ok(v) if v != 0.0 && v.abs() < 1e-100 => {
            Err(format!("'{text}' is so small that its square is 0; use other units"))
        }
        Ok(v) if v.is_finite() => Ok(v),
        Ok(_) => Err(format!("'{text}' is not finite")),
        Err(_) => Err(format!("'{text}' is not a number")),
    }
}

fn numbers<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    let parts = text.split(',').map(number).collect::<Result<Vec<_>, _>>()?;
    parts.try_into().map_err(|parts: Vec<f64>| format!("{} numbers where {form} is needed", parts.len()))
}

pub fn vector(text: &str) -> Result<DVec3, String> {
    numbers(text, "X,Y,Z").map(DVec3::from_array)
}

/// From and to.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    numbers(text, "FROM,TO")
}

pub fn event(text: &str) -> Result<Event<World>, String> {
    numbers(text, "T,X,Y,Z").map(|[t, x, y, z]| Event::new(t, x, y, z))
}

/// A vector, or one number along whatever direction there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpeedOrVector {
    Speed(f64),
    Vector(DVec3),
}

pub fn speed_or_vector(text: &str) -> Result<SpeedOrVector, String> {
    if text.contains(',') {
        vector(text).map(SpeedOrVector::Vector)
    } else {
        number(text).map(SpeedOrVector::Speed)
    }
}

pub fn size(text: &str) -> Result<[u32; 2], String> {
    let parts = text
        .split_once(['x', 'X', '×'])
        .and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]));
    parts.ok_or_else(|| format!("'{text}' is not of the form WIDTHxHEIGHT, such as 1280x720"))
}

/// Samples a pixel.
pub fn count(text: &str) -> Result<u32, String> {
    let most = Samples::MOST;
    let value = text.trim().parse().ok().filter(|n| (1..=most).contains(n));
    value.ok_or_else(|| format!("'{}' is not a whole number from 1 to {most}", text.trim()))
}

/// "nearest BODY".
pub fn when(text: &str) -> Result<String, String> {
    match text.trim().split_once(char::is_whitespace) {
        Some(("nearest", body)) if !body.trim().is_empty() => Ok(body.trim().to_owned()),
        _ => Err(format!("'{text}' is not of the form \"nearest BODY\"")),
    }
}
