//! What shines and what is lit: materials, spectra and lights.

use super::source::{Source, VelocityKeys, did_you_mean, velocity_keys};
use super::tables::{GlossTable, LightTable, MaterialTable};
use super::{SceneError, read_color};
use crate::relativity::Motion;
use crate::scene::{EmissionLaw, Gloss, Light, LightKind, Material, Mesh, Paint, Surface, read_plain};
use crate::spectrum::{Beyond, Shape, Spectrum, Strength, Tabulated};
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;
use toml::{Spanned, Value};

/// What a `[material.NAME]` makes of a mesh's materials; what it does not say stays.
#[derive(Clone, Debug, Default)]
pub(super) struct Finish {
    color: Option<[f32; 3]>,
    emission: Option<[f32; 3]>,
    spectrum: Option<Spectrum>,
    beyond: Option<Beyond>,
    surface: Option<Surface>,
    law: Option<EmissionLaw>,
    gloss: Option<Gloss>,
}

impl Finish {
    pub fn apply(&self, mesh: &mut Mesh) {
        match self.color {
            Some(color) => mesh.repaint(color),
            // What shines or is lit needs no paint to show its shape by.
            None if mesh.clay && self.surface.is_some() => mesh.repaint(Paint::CLAY),
            None => {}
        }
        if mesh.materials.is_empty() {
            mesh.materials.push(Material::default());
        }
        for material in &mut mesh.materials {
            if let Some(emission) = self.emission {
                (material.emission, material.emission_texture) = (emission, None);
            }
            if let Some(spectrum) = &self.spectrum {
                material.spectrum = spectrum.clone();
            }
            material.spectrum.beyond = self.beyond.unwrap_or(material.spectrum.beyond);
            material.surface = self.surface.unwrap_or(material.surface);
            material.law = self.law.unwrap_or(material.law);
            material.gloss = self.gloss.unwrap_or(material.gloss);
        }
    }
}

/// One of the words, each of which stands for a value.
pub(super) fn word<T: Copy>(
    source: &Source<'_>,
    key: &str,
    place: &Spanned<String>,
    words: &[(&str, T)],
) -> Result<T, SceneError> {
    let known = words.iter().find(|(word, _)| word == place.get_ref());
    known.map(|(_, value)| *value).ok_or_else(|| {
        let hint = did_you_mean(place.get_ref(), words.iter().map(|(word, _)| *word));
        source.at(place, format!("{key} = \"{}\" is unknown; {hint}", place.get_ref()))
    })
}

pub(super) const BEYOND: [(&str, Beyond); 3] =
    [("grey", Beyond::Grey), ("edge", Beyond::Edge), ("dark", Beyond::Dark)];

/// A word, or a table of a few keys.
struct Choice<'a> {
    source: &'a Source<'a>,
    key: &'static str,
    place: &'a Spanned<Value>,
}

impl Choice<'_> {
    fn fault(&self, message: impl std::fmt::Display) -> SceneError {
        self.source.at(self.place, format!("{}: {message}", self.key))
    }

    /// The table's keys, all of them known.
    fn table(&self, known: &[&str], form: &str) -> Result<&toml::Table, SceneError> {
        let Value::Table(table) = self.place.get_ref() else {
            return Err(self.fault(format!("needs {form}")));
        };
        match table.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => {
                let hint = did_you_mean(key, known.iter().copied());
                Err(self.fault(format!("unknown key '{key}'; {hint}")))
            }
            None => Ok(table),
        }
    }

    fn number(&self, key: &str, value: &Value) -> Result<f64, SceneError> {
        let number = value.as_float().or(value.as_integer().map(|i| i as f64)).filter(|v| v.is_finite());
        number.ok_or_else(|| self.fault(format!("{key} = {value} is not a finite number")))
    }
}

pub(super) fn read_shape(
    source: &Source<'_>,
    place: &Spanned<Value>,
    files: &mut Vec<PathBuf>,
) -> Result<Shape, SceneError> {
    const FORM: &str = "\"white\", \"flat\", { blackbody_k = 6000 }, { power_law = -1 }, \
                        { line_nm = 589, width_nm = 2 } or { file = \"lamp.csv\" }";
    let choice = Choice { source, key: "spectrum", place };
    if let Value::String(text) = place.get_ref() {
        return match text.as_str() {
            "white" => Ok(Shape::White),
            "flat" => Ok(Shape::FLAT),
            other => Err(choice.fault(format!("'{other}' is unknown; it is {FORM}"))),
        };
    }
    let table = choice.table(&["blackbody_k", "power_law", "line_nm", "width_nm", "file"], FORM)?;
    let number = |key: &str| table.get(key).map(|v| choice.number(key, v)).transpose();
    let [kelvin, exponent] = [number("blackbody_k")?, number("power_law")?];
    let [centre_nm, width_nm] = [number("line_nm")?, number("width_nm")?];
    Ok(match (kelvin, exponent, centre_nm, width_nm, table.get("file")) {
        (Some(kelvin), None, None, None, None) => Shape::BlackBody { kelvin },
        (None, Some(exponent), None, None, None) => Shape::PowerLaw { exponent },
        (None, None, Some(centre_nm), width_nm, None) => {
            Shape::Line { centre_nm, width_nm: width_nm.unwrap_or(1.0) }
        }
        (None, None, None, None, Some(Value::String(name))) => {
            let path = source.path.parent().unwrap_or(std::path::Path::new("")).join(name);
            let fault = |e: &dyn std::fmt::Display| choice.fault(format!("{}: {e}", path.display()));
            let bytes = read_plain(&path).map_err(|e| fault(&e))?;
            let text = String::from_utf8(bytes).map_err(|_| fault(&"it is no text"))?;
            let table = Tabulated::parse(&text, name).map_err(|e| fault(&e))?;
            files.push(path.clone());
            Shape::Tabulated(Arc::new(table))
        }
        _ => return Err(choice.fault(format!("needs {FORM}"))),
    })
}

/// Checked, and told where it stands if it cannot be.
pub(super) fn checked<T>(
    source: &Source<'_>,
    place: &Spanned<T>,
    spectrum: Spectrum,
) -> Result<Spectrum, SceneError> {
    match spectrum.scale() {
        Ok(_) => Ok(spectrum),
        Err(e) => Err(source.at(place, e)),
    }
}

fn read_law(source: &Source<'_>, place: &Spanned<Value>) -> Result<EmissionLaw, SceneError> {
    const FORM: &str = "\"isotropic\", \"lambert\", { cos_power = 2 } or { limb_darkening = [0.6, 0] }";
    let choice = Choice { source, key: "law", place };
    if let Value::String(text) = place.get_ref() {
        return match text.as_str() {
            "isotropic" => Ok(EmissionLaw::Isotropic),
            "lambert" => Ok(EmissionLaw::Cosine { power: 1.0 }),
            other => Err(choice.fault(format!("'{other}' is unknown; it is {FORM}"))),
        };
    }
    let table = choice.table(&["cos_power", "limb_darkening"], FORM)?;
    match (table.get("cos_power"), table.get("limb_darkening")) {
        (Some(value), None) => {
            let power = choice.number("cos_power", value)?;
            if !(0.0..=1000.0).contains(&power) {
                return Err(choice.fault(format!("cos_power = {power} must lie between 0 and 1000")));
            }
            Ok(EmissionLaw::Cosine { power })
        }
        (None, Some(Value::Array(list))) if (1..=2).contains(&list.len()) => {
            let mut coefficients = [0.0; 2];
            for (to, value) in coefficients.iter_mut().zip(list) {
                *to = choice.number("limb_darkening", value)?;
                if to.abs() > 10.0 {
                    return Err(choice.fault(format!("limb_darkening: {to:e} must lie between -10 and 10")));
                }
            }
            Ok(EmissionLaw::LimbDarkening { coefficients })
        }
        _ => Err(choice.fault(format!("needs {FORM}"))),
    }
}

fn read_gloss(source: &Source<'_>, table: &GlossTable) -> Result<Gloss, SceneError> {
    let share = |key: &str, value: &Option<Spanned<f64>>, usual: f32| match value {
        None => Ok(usual),
        Some(place) => match *place.get_ref() {
            v if (0.0..=1.0).contains(&v) => Ok(v as f32),
            v => Err(source.at(place, format!("gloss: {key} = {v} must lie between 0 and 1"))),
        },
    };
    Ok(Gloss {
        reflectance: share("reflectance", &table.reflectance, 0.04)?,
        roughness: share("roughness", &table.roughness, 0.5)?,
        metallic: share("metallic", &table.metallic, 0.0)?,
    })
}

pub(super) fn read_material(
    source: &Source<'_>,
    table: &MaterialTable,
    files: &mut Vec<PathBuf>,
) -> Result<Finish, SceneError> {
    let color = |key: &str, place: &Option<_>| place.as_ref().map(|c| read_color(source, key, c)).transpose();
    let beyond = table.beyond.as_ref().map(|b| word(source, "beyond", b, &BEYOND)).transpose()?;
    let strength = match (&table.luminance, &table.radiance) {
        (Some(_), Some(radiance)) => {
            return Err(source.at(radiance, "both luminance and radiance are given; one is enough"));
        }
        (Some(v), None) => Some((v, Strength::Luminance(source.finite("luminance", v)?))),
        (None, Some(v)) => Some((v, Strength::Radiance(source.finite("radiance", v)?))),
        (None, None) => None,
    };
    let shape = table.spectrum.as_ref().map(|s| read_shape(source, s, files)).transpose()?;
    let spectrum = match (shape, strength) {
        (None, None) => None,
        (shape, strength) => {
            let usual = Spectrum::of(shape.unwrap_or(Shape::White));
            let spectrum = Spectrum {
                strength: strength.map_or(usual.strength, |(_, strength)| strength),
                beyond: beyond.unwrap_or(usual.beyond),
                shape: usual.shape,
            };
            Some(match (&table.spectrum, strength) {
                (Some(place), _) => checked(source, place, spectrum)?,
                (None, Some((place, _))) => checked(source, place, spectrum)?,
                (None, None) => spectrum,
            })
        }
    };
    let gloss = table.gloss.as_ref().map(|g| read_gloss(source, g)).transpose()?;
    const SURFACES: [(&str, Surface); 2] = [("luminous", Surface::Luminous), ("lit", Surface::Lit)];
    Ok(Finish {
        color: color("color", &table.color)?,
        emission: color("emission", &table.emission)?,
        spectrum,
        beyond,
        // What says how it shines does shine; metal that does not reflects, without lights, too.
        surface: match &table.surface {
            Some(surface) => Some(word(source, "surface", surface, &SURFACES)?),
            None if strength.is_some() || table.spectrum.is_some() || table.law.is_some() => {
                Some(Surface::Luminous)
            }
            None => gloss.filter(|gloss| gloss.metallic > 0.0).map(|_| Surface::Lit),
        },
        law: table.law.as_ref().map(|l| read_law(source, l)).transpose()?,
        gloss,
    })
}

/// Kinds of lights, before they have a place.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Distant,
    Point,
    Spot,
    Ambient,
}

pub(super) fn read_light(
    source: &Source<'_>,
    index: usize,
    table: &LightTable,
    files: &mut Vec<PathBuf>,
) -> Result<Light, SceneError> {
    const KINDS: [(&str, Kind); 4] = [
        ("distant", Kind::Distant),
        ("point", Kind::Point),
        ("spot", Kind::Spot),
        ("ambient", Kind::Ambient),
    ];
    let kind = word(source, "kind", &table.kind, &KINDS)?;
    let aimed = matches!(kind, Kind::Distant | Kind::Spot);
    let direction = match &table.towards {
        Some(towards) if !aimed => {
            return Err(source.at(towards, "towards: this kind of light shines in all directions"));
        }
        Some(towards) => match source.vector("towards", towards)?.normalize_or_zero() {
            DVec3::ZERO => return Err(source.at(towards, "towards has length zero")),
            direction => direction,
        },
        None if aimed => {
            return Err(source.at(&table.kind, "it needs towards: the direction its light goes"));
        }
        None => DVec3::Z,
    };
    let placed = matches!(kind, Kind::Point | Kind::Spot);
    if let Some(position) = table.position.as_ref().filter(|_| !placed) {
        return Err(source.at(position, "position: this kind of light is nowhere in particular"));
    }
    let cone = match &table.cone_deg {
        None => [0.0, 45f32.to_radians()],
        Some(place) if kind != Kind::Spot => {
            return Err(source.at(place, "cone_deg: only a spot has a cone"));
        }
        Some(place) => match *place.get_ref() {
            [bright, dark] if 0.0 <= bright && bright < dark && dark <= 90.0 => {
                [bright, dark].map(|angle| angle.to_radians() as f32)
            }
            [bright, dark] => {
                let message = format!(
                    "cone_deg = [{bright}, {dark}] must be two angles from the axis, the smaller first, up to 90"
                );
                return Err(source.at(place, message));
            }
        },
    };
    let usual = match kind {
        Kind::Distant => Some(std::f64::consts::PI),
        Kind::Ambient => Some(1.0),
        Kind::Point | Kind::Spot => None,
    };
    let (strength, counted) = match (&table.strength, &table.power) {
        (Some(_), Some(power)) => {
            return Err(source.at(power, "both strength and power are given; one is enough"));
        }
        (Some(v), None) => (source.finite("strength", v)?, Some(Strength::Luminance(1.0))),
        (None, Some(v)) => (source.finite("power", v)?, Some(Strength::Radiance(1.0))),
        (None, None) => {
            let missing = "it needs a strength: at the distance r a surface gets strength/r²";
            (usual.ok_or_else(|| source.at(&table.kind, missing))?, None)
        }
    };
    if !(0.0..=1e12).contains(&strength) {
        let (key, place) = match &table.power {
            Some(power) => ("power", Some(power)),
            None => ("strength", table.strength.as_ref()),
        };
        let message = format!("{key} = {strength:e} must lie between 0 and 1e12");
        return Err(source.fault(place.map(|p| p.span().start), message));
    }
    let shape = table.spectrum.as_ref().map_or(Ok(Shape::White), |s| read_shape(source, s, files))?;
    let own = Spectrum::of(shape);
    let beyond = table.beyond.as_ref().map(|b| word(source, "beyond", b, &BEYOND)).transpose()?;
    let spectrum = Spectrum {
        strength: counted.unwrap_or(own.strength),
        beyond: beyond.unwrap_or(own.beyond),
        shape: own.shape,
    };
    let spectrum = match &table.spectrum {
        Some(place) => checked(source, place, spectrum)?,
        None => checked(source, &table.kind, spectrum)?,
    };
    Ok(Light {
        name: table.name.clone().unwrap_or_else(|| format!("light{}", index + 1)),
        kind: match kind {
            Kind::Distant => LightKind::Distant { direction },
            Kind::Point => LightKind::Point { position: DVec3::ZERO },
            Kind::Spot => LightKind::Spot { position: DVec3::ZERO, direction, cone },
            Kind::Ambient => LightKind::Ambient,
        },
        color: table.color.as_ref().map_or(Ok([1.0; 3]), |c| read_color(source, "color", c))?,
        spectrum,
        strength,
        motion: Motion {
            celerity: source.celerity(&velocity_keys!(table))?,
            origin: source.event(&table.time, &table.position)?,
        },
    })
}
