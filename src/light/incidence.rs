//! Lights in the rest frame of one body.

use super::Point;
use super::ambient::{Bath, Irradiance};
use crate::relativity::Motion;
use crate::scene::{Light, LightKind};
use glam::DVec3;
use terrell_geodesic::{FourVector, Lamp, Lorentz, Rest, Tetrad, Wide};

/// How a light reaches a body, whoever looks.
#[derive(Clone, Debug)]
pub(super) enum Incidence {
    /// From one direction, with one shift.
    Distant { to_light: DVec3, doppler: f64 },
    /// From a place; which one depends on the moment.
    Near,
    /// From everywhere.
    Ambient {
        /// Unit vector of the body's motion in the light's frame, rest axes.
        axis: DVec3,
        /// Of that motion.
        rapidity: f64,
        irradiance: Irradiance,
    },
}

/// From the rest frame of a body to that of a light.
fn lamp_from_rest(light: &Motion, body: &Motion) -> Lorentz<Lamp, Rest> {
    (light.world_from_lamp::<Wide>().inverse() * body.world_from_rest::<Wide>()).rounded()
}

/// Rapidity of a body in a light's frame.
pub(super) fn rapidity(light: &Motion, body: &Motion) -> f64 {
    let u = lamp_from_rest(light, body).celerity_in_from();
    DVec3::from_array(u).length().asinh()
}

impl Incidence {
    pub fn new(light: &Light, body: &Motion) -> Self {
        match light.kind {
            LightKind::Distant { direction } => {
                let map = lamp_from_rest(&light.motion, body);
                let wave = map.inverse() * FourVector::from_parts(1.0, direction);
                Self::Distant { to_light: -wave.xyz().normalize_or(direction), doppler: wave.t }
            }
            LightKind::Point { .. } | LightKind::Spot { .. } => Self::Near,
            LightKind::Ambient => {
                let u = DVec3::from_array(lamp_from_rest(&light.motion, body).celerity_in_from());
                let bath = Bath::new(u.length().asinh());
                Self::Ambient {
                    axis: u.normalize_or(DVec3::X),
                    rapidity: bath.rapidity(),
                    irradiance: Irradiance::new(&bath),
                }
            }
        }
    }
}

/// A light at a place, as it reaches what one observer sees of a body at one moment.
#[derive(Clone, Debug)]
pub(super) struct NearLight {
    lamp_from_rest: Lorentz<Lamp, Rest>,
    rest_from_lamp: Lorentz<Rest, Lamp>,
    /// The observer's event in the light's frame, from the light.
    observer: DVec3,
    /// Unit vector of the axis, and cosines of the angles where a spot begins to darken and where it is dark.
    cone: Option<(DVec3, [f64; 2])>,
}

/// Light that arrives at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// Unit vector in the surface's rest frame.
    pub to_light: DVec3,
    /// From the surface's event to the lamp's when the light left it, in the surface's rest frame: a null vector.
    pub back: FourVector<Rest>,
    /// ν at the surface over ν of the lamp.
    pub doppler: f64,
    /// Radiant intensity over the square of the distance, both in the lamp's frame: irradiance, were there no shift.
    pub irradiance: f64,
}

impl NearLight {
    /// From the surface's rest frame to the light's.
    pub fn lamp_from_rest(&self) -> &Lorentz<Lamp, Rest> {
        &self.lamp_from_rest
    }

    /// And back.
    pub fn rest_from_lamp(&self) -> &Lorentz<Rest, Lamp> {
        &self.rest_from_lamp
    }

    /// The observer's event in the light's frame, from the light.
    pub fn observer(&self) -> DVec3 {
        self.observer
    }

    /// Unit vector of the axis, and cosines of the angles where a spot begins to darken and where it is dark.
    pub fn cone(&self) -> Option<(DVec3, [f64; 2])> {
        self.cone
    }

    /// None for light that comes from no place.
    pub fn new(light: &Light, body: &Motion, observer: &Tetrad) -> Option<Self> {
        let (position, cone) = match light.kind {
            LightKind::Point { position } => (position, None),
            LightKind::Spot { position, direction, cone } => {
                (position, Some((direction, cone.map(|angle| f64::from(angle).cos()))))
            }
            LightKind::Distant { .. } | LightKind::Ambient => return None,
        };
        let lamp_from_rest = lamp_from_rest(&light.motion, body);
        let since = light.motion.world_from_lamp::<Wide>().inverse()
            * observer.event().since::<Wide>(light.motion.origin);
        let from = [0, 1, 2].map(|i| (since.space[i] - Wide::from(position[i])).high);
        Some(Self {
            lamp_from_rest,
            rest_from_lamp: lamp_from_rest.inverse(),
            observer: DVec3::from_array(from),
            cone,
        })
    }

    /// At a point of the surface; the light that is seen to arrive there left the lamp on the point's own past light
    /// cone. None at the lamp itself.
    pub fn at(&self, light: &Light, point: &Point) -> Option<Arrival> {
        // From the observer's event to the surface's, and from the lamp to there.
        let way = self.observer + (self.lamp_from_rest * point.event()).xyz();
        let distance = way.length();
        // Where it goes, in both frames: a null vector, whose times are as the frequencies.
        let arriving = self.rest_from_lamp * FourVector::from_parts(distance, way);
        let doppler = arriving.t / distance;
        let to_light = -arriving.xyz().normalize_or_zero();
        if !(doppler > 0.0 && doppler.is_finite()) || to_light == DVec3::ZERO {
            return None;
        }
        let in_cone = self.cone.map_or(1.0, |(axis, [bright, dark])| {
            let cosine = axis.dot(way) / distance;
            // As glTF's extension has it.
            let edge = ((cosine - dark) / (bright - dark).max(1e-6)).clamp(0.0, 1.0);
            edge * edge
        });
        let irradiance = light.strength * in_cone / (distance * distance);
        Some(Arrival { to_light, back: -arriving, doppler, irradiance })
    }
}
