//! Spacetime, the sky, and how cameras are there.

use super::SceneError;
use super::body::read_rotation;
use super::light::{BEYOND, checked, read_shape, word};
use super::source::Source;
use super::tables::{CameraTable, SkyTable, SpacetimeTable};
use crate::scene::import::{decode, is_picture_file};
use crate::scene::{Scene, Sky, SkyTexture, Spacetime, Stance, read_plain};
use crate::spectrum::{Shape, Spectrum, Strength};
use glam::DMat3;
use std::path::{Path, PathBuf};
use terrell_geodesic::{KerrSchild, Sense};

pub(super) fn read_spacetime(source: &Source<'_>, table: &SpacetimeTable) -> Result<Spacetime, SceneError> {
    #[derive(Clone, Copy, PartialEq)]
    enum Metric {
        Flat,
        Schwarzschild,
        Kerr,
    }
    const METRICS: [(&str, Metric); 3] =
        [("flat", Metric::Flat), ("schwarzschild", Metric::Schwarzschild), ("kerr", Metric::Kerr)];
    let metric = word(source, "metric", &table.metric, &METRICS)?;
    if metric == Metric::Flat {
        return match [&table.mass, &table.spin].into_iter().flatten().next() {
            Some(place) => Err(source.at(place, "flat spacetime has no mass; the metric of one is \"kerr\"")),
            None => Ok(Spacetime::Flat),
        };
    }
    let mass = match &table.mass {
        None => 1.0,
        Some(place) => match *place.get_ref() {
            // Beyond, powers of it leave the range of f64.
            mass if (1e-9..=1e9).contains(&mass) => mass,
            mass => return Err(source.at(
                place,
                format!(
                    "mass = {mass:e} must lie between 1e-9 and 1e9; choose the unit of length so that it does"
                ),
            )),
        },
    };
    let spin = match (&table.spin, metric) {
        (None, Metric::Schwarzschild) => 0.0,
        (Some(place), Metric::Schwarzschild) => {
            let message = "a Schwarzschild hole has no spin; the metric of one that has is \"kerr\"";
            return Err(source.at(place, message));
        }
        (None, _) => return Err(source.at(&table.metric, "a Kerr hole needs a spin: a/M, from -1 to 1")),
        (Some(place), _) => match *place.get_ref() {
            spin if spin.abs() <= 1.0 => spin,
            spin => {
                let message = format!(
                    "spin = {spin} is a/M and must lie between -1 and 1: with more there is no horizon but a naked singularity"
                );
                return Err(source.at(place, message));
            }
        },
    };
    let hole = KerrSchild::new(mass, spin * mass).map_err(|e| source.at(&table.metric, e))?;
    Ok(Spacetime::Kerr(hole))
}

pub(super) fn read_sky(
    source: &Source<'_>,
    table: &SkyTable,
    files: &mut Vec<PathBuf>,
) -> Result<Sky, SceneError> {
    let name = table.texture.get_ref();
    let texture = match name.as_str() {
        "checker" => SkyTexture::Checker,
        "stars" => SkyTexture::Stars,
        file if is_picture_file(Path::new(file)) => {
            let path = source.path.parent().unwrap_or(Path::new("")).join(file);
            let bytes = read_plain(&path)
                .map_err(|e| source.at(&table.texture, format!("texture: {}: {e}", path.display())))?;
            files.push(path);
            SkyTexture::picture(decode(file, bytes).map_err(|e| source.at(&table.texture, e))?)
        }
        other => {
            let message = format!(
                "texture = \"{other}\" is unknown; it is \"checker\", \"stars\" or a .png, .jpg, .bmp or .tga file, equirectangular"
            );
            return Err(source.at(&table.texture, message));
        }
    };
    let shape = table.spectrum.as_ref().map_or(Ok(Shape::White), |s| read_shape(source, s, files))?;
    let own = Spectrum::of(shape);
    let strength = table.strength.as_ref().map(|v| source.finite("strength", v)).transpose()?;
    let strength = strength.map_or(own.strength, |v| match own.strength {
        Strength::Luminance(_) => Strength::Luminance(v),
        Strength::Radiance(_) => Strength::Radiance(v),
    });
    let beyond = table.beyond.as_ref().map(|b| word(source, "beyond", b, &BEYOND)).transpose()?;
    let spectrum = Spectrum { strength, beyond: beyond.unwrap_or(own.beyond), shape: own.shape };
    let spectrum = match (&table.strength, &table.spectrum) {
        (Some(place), _) => checked(source, place, spectrum)?,
        (None, Some(place)) => checked(source, place, spectrum)?,
        (None, None) => spectrum,
    };
    let rotation = table.rotation.as_ref().map(|r| read_rotation(source, r)).transpose()?;
    let rotation = rotation.map_or(DMat3::IDENTITY, DMat3::from_quat);
    Ok(Sky { texture, spectrum, rotation })
}

/// How the camera is there.
pub(super) fn read_stance(source: &Source<'_>, table: &CameraTable) -> Result<Stance, SceneError> {
    const STANCES: [(&str, Stance); 5] = [
        ("static", Stance::Moving),
        ("zamo", Stance::Zamo),
        ("circular", Stance::Circular(Sense::Prograde)),
        ("retrograde", Stance::Circular(Sense::Retrograde)),
        ("rain", Stance::Rain),
    ];
    let vectors =
        [&table.velocity, &table.celerity, &table.direction].into_iter().flatten().map(|v| v.span());
    let numbers = [&table.beta, &table.gamma, &table.rapidity].into_iter().flatten().map(|v| v.span());
    let velocity = vectors.chain(numbers).next().map(|span| span.start);
    let looks = [&table.position, &table.look_at, &table.forward, &table.up].into_iter().flatten();
    let place = looks.map(|v| v.span().start).next();
    match (&table.observer, &table.at_infinity) {
        (None, None) => Ok(Stance::Moving),
        (Some(observer), None) => match velocity {
            Some(at) => {
                let message = "an observer has the velocity it is named for; leave one of both out";
                Err(source.fault(Some(at), message))
            }
            None => word(source, "observer", observer, &STANCES),
        },
        (Some(observer), Some(_)) => {
            Err(source.at(observer, "at infinity every observer rests; leave it out"))
        }
        (None, Some(infinity)) => {
            if let Some(at) = velocity.or(place) {
                let message = "a camera at_infinity rests and looks at the hole, the axis upward; its inclination_deg, azimuth_deg and height are all there is";
                return Err(source.fault(Some(at), message));
            }
            let table = infinity.get_ref();
            let inclination_deg = source.finite("inclination_deg", &table.inclination_deg)?;
            if !(0.0..=180.0).contains(&inclination_deg) {
                let message = format!(
                    "inclination_deg = {inclination_deg} must lie between 0 and 180, from the hole's axis"
                );
                return Err(source.at(&table.inclination_deg, message));
            }
            let azimuth_deg =
                table.azimuth_deg.as_ref().map_or(Ok(0.0), |a| source.finite("azimuth_deg", a))?;
            let height = source.finite("height", &table.height)?;
            Ok(Stance::Infinity { inclination_deg, azimuth_deg, height })
        }
    }
}

/// What would fail in the scene's spacetime, said where it stands.
pub(super) fn check(
    source: &Source<'_>,
    camera: Option<&CameraTable>,
    lights: &[super::tables::LightTable],
    scene: &Scene,
) -> Result<(), SceneError> {
    let start = |span: std::ops::Range<usize>| span.start;
    if let Err(e) = scene.check_spacetime() {
        use crate::scene::SpacetimeError as Fault;
        let at = match &e {
            Fault::Light(_) => lights.first().map(|l| l.kind.span()),
            Fault::Nearest(_) => camera.and_then(|c| c.nearest.as_ref()).map(|n| n.span()),
            Fault::Stance => camera.and_then(|c| {
                c.observer.as_ref().map(|o| o.span()).or(c.at_infinity.as_ref().map(|i| i.span()))
            }),
            Fault::Reflects(_) => None,
            // Flags may stop it.
            Fault::Animated(_) => return Ok(()),
        };
        return Err(source.fault(at.map(start), e.to_string()));
    }
    let Ok(view) = scene.camera() else { return Ok(()) };
    scene.eye(&view).map(drop).map_err(|e| {
        use crate::scene::EyeError as Fault;
        let keys = camera.map(|c| {
            let infinity = c.at_infinity.as_ref().map(|i| i.span());
            match &e {
                Fault::Frame { .. } => {
                    c.position.as_ref().map(|p| p.span()).or(c.observer.as_ref().map(|o| o.span()))
                }
                Fault::Field => c.fov_deg.as_ref().map(|f| f.span()).or(infinity),
                Fault::Projection(_) => c.projection.as_ref().map(|p| p.span()).or(infinity),
                Fault::Distant(_) | Fault::Height(_) => infinity,
            }
        });
        source.fault(keys.flatten().map(start), e.to_string())
    })
}
