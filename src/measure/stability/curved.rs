//! Rays around black holes, by how accurately they are integrated.

use super::map::{cells, number};
use super::{Axis, Map, Planner, QUARTER_PIXEL, Resolution};
use crate::measure::schwarzschild_deflection;
use crate::render::{around, around_seen_from};
use crate::scene::Eye;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use terrell_geodesic::{
    Accuracy, BoyerLindquist, Curved, DistantCamera, End, Event, FourVector, KerrSchild, KerrSky, LocalFrame,
    Spacetime, World,
};

/// Errors allowed in a step.
const TOLERANCES: [f64; 10] = [1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4];

/// That of the rays in other coordinates which others are compared with.
const FINEST: f64 = 1e-13;

type Start = (Event<World>, FourVector<World>);

/// A ray, and two neighbours of it that begin a little beside.
struct Probe {
    hole: KerrSchild,
    start: Start,
    /// Where it comes from; none for the hole.
    sky: Option<DVec3>,
    /// By how much that turns for a small angle, or a small part of an impact parameter.
    conditioning: f64,
}

fn sky(end: End) -> Option<DVec3> {
    match end {
        End::Sky { wave_vector } => Some(wave_vector.xyz().normalize()),
        _ => None,
    }
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

impl Probe {
    /// From the ray itself and others that begin by `beside` from it.
    fn new(hole: KerrSchild, start: Start, others: [Start; 2], beside: f64) -> Self {
        let ends = KerrSky::new(hole, FINEST).trace(&[start, others[0], others[1]]);
        let [sky, first, second] = [0, 1, 2].map(|i| sky(ends[i]));
        let turned = |other: Option<DVec3>| match (sky, other) {
            (Some(a), Some(b)) => angle(a, b) / beside,
            _ => f64::INFINITY,
        };
        Self { hole, start, sky, conditioning: turned(first).max(turned(second)).max(1.0) }
    }

    /// Of impact parameters.
    fn distant(camera: &DistantCamera, hole: KerrSchild, alpha: f64, beta: f64) -> Option<Self> {
        let beside = 1e-6;
        let step = beside * alpha.hypot(beta);
        let [start, right, up] =
            [(0.0, 0.0), (step, 0.0), (0.0, step)].map(|(a, b)| camera.ray(alpha + a, beta + b).ok());
        Some(Self::new(hole, start?, [right?, up?], beside))
    }

    /// Of a direction seen in a frame.
    fn near(frame: &LocalFrame, hole: KerrSchild, direction: DVec3) -> Self {
        let beside = 1e-6;
        let n = direction.normalize();
        let other = n.any_orthonormal_vector();
        let start = |n: DVec3| (frame.event(), frame.seen_from(n.normalize()));
        Self::new(hole, start(n), [start(n + beside * other), start(n + beside * n.cross(other))], beside)
    }

    /// Whether there is an answer that does not hang on the last digits.
    fn is_settled(&self) -> bool {
        self.sky.is_some() && self.conditioning.is_finite()
    }

    /// How far a ray integrated to a tolerance comes from elsewhere, over the conditioning.
    fn error(&self, tolerance: f64) -> Off {
        let end = follow(self.hole, self.start, tolerance);
        match (self.sky, sky(end)) {
            (Some(exact), Some(found)) => Off::by(angle(exact, found) / self.conditioning),
            _ => Off::lost(end),
        }
    }
}

/// How far rays are off.
#[derive(Clone, Copy)]
struct Off {
    error: f64,
    /// Whether all that are off by much are known to have gone wrong: pictures flag them.
    flagged: bool,
}

impl Off {
    fn by(error: f64) -> Self {
        Self { error, flagged: error <= QUARTER_PIXEL }
    }

    /// Of a ray that ends otherwise.
    fn lost(end: End) -> Self {
        let flagged = !matches!(end, End::Horizon | End::Sky { .. } | End::Edge);
        Self { error: f64::INFINITY, flagged }
    }

    fn worse(self, other: Self) -> Self {
        Self { error: self.error.max(other.error), flagged: self.flagged && other.flagged }
    }
}

/// Errors of cells, and the conditioning they were divided by.
type Cells = Vec<(Off, f64)>;

/// As pictures do, but for the tolerance.
fn follow(hole: KerrSchild, (event, k): Start, tolerance: f64) -> End {
    let Accuracy { sagitta, drift, .. } = around(hole).accuracy();
    let space = Curved::new(hole).with(Accuracy { drift, ..Accuracy::new(tolerance, sagitta) });
    space.ray(event, k).follow()
}

/// Rows of errors of what a column's rays are, by tolerances.
fn table(columns: &[Vec<Probe>], tolerances: &[f64]) -> Cells {
    cells(columns, tolerances, |probes, tolerance| {
        let settled = || probes.iter().filter(|probe| probe.is_settled());
        let off = settled().map(|probe| probe.error(*tolerance)).reduce(Off::worse);
        let conditioning = settled().map(|probe| probe.conditioning).fold(1.0, f64::max);
        (off.unwrap_or(Off { error: f64::INFINITY, flagged: false }), conditioning)
    })
}

/// Deflection by a hole that does not rotate, against the closed form.
fn impact(beyond: &[f64], tolerances: &[f64]) -> Cells {
    let off = |beyond: f64, tolerance: f64| {
        let hole = KerrSchild::schwarzschild(1.0).ok()?;
        let b = 27f64.sqrt() + beyond;
        let start = DistantCamera::at_infinity(hole, FRAC_PI_2).and_then(|camera| camera.ray(b, 0.0)).ok()?;
        // By how much it changes for a part of b, from steps that are small beside what is beyond the critical one.
        let step = 1e-3 * beyond;
        let [before, expected, after] = [b - step, b, b + step].map(schwarzschild_deflection);
        let conditioning = (b * (before - after) / (2.0 * step)).max(1.0);
        let end = follow(hole, start, tolerance);
        let Some(sky) = sky(end) else { return Some((Off::lost(end), conditioning)) };
        // It comes from +x, goes by at +y, and is bent towards the hole.
        let off = sky.y.atan2(sky.x) - (PI + expected);
        let off = off - 2.0 * PI * (off / (2.0 * PI)).round();
        Some((Off::by(off.abs().max(sky.z.abs()) / conditioning), conditioning))
    };
    cells(beyond, tolerances, |beyond, tolerance| {
        off(*beyond, *tolerance).unwrap_or((Off { error: f64::INFINITY, flagged: false }, 1.0))
    })
}

/// Rays that begin or pass so near to the axis, in radians or masses.
fn near_axis(distance: f64) -> Vec<Probe> {
    let Ok(hole) = KerrSchild::new(1.0, 0.9) else { return Vec::new() };
    let [beginning, passing] =
        [distance, 1.0].map(|inclination| DistantCamera::at_distance(hole, inclination, 30.0));
    let (Ok(beginning), Ok(passing)) = (beginning, passing) else { return Vec::new() };
    let begin = [(6.5, 0.0), (0.0, 6.5), (-7.0, 3.0), (2.0, -6.5)];
    let pass = [(distance, 6.5), (distance, -7.0), (-distance, 9.0)];
    let begin = begin.into_iter().filter_map(|(a, b)| Probe::distant(&beginning, hole, a, b));
    begin.chain(pass.into_iter().filter_map(|(a, b)| Probe::distant(&passing, hole, a, b))).collect()
}

/// Who looks out from near a horizon.
#[derive(Clone, Copy)]
struct LookOut {
    spin: f64,
    /// From rest far away, or resting but for the rotation.
    falls: bool,
}

const RESTING: LookOut = LookOut { spin: 0.9, falls: false };
const FALLING: LookOut = LookOut { spin: 0.998, falls: true };

impl LookOut {
    /// So far above the horizon, in parts of its radius.
    fn at(self, above: f64) -> Option<(KerrSchild, LocalFrame)> {
        let hole = KerrSchild::new(1.0, self.spin).ok()?;
        let r = hole.horizon() * (1.0 + above);
        let event = hole.from_boyer_lindquist(BoyerLindquist { t: 0.0, r, theta: 1.1, phi: 0.3 });
        let velocity = if self.falls { hole.rain(event) } else { hole.zamo(event) }.ok()?;
        let frame = LocalFrame::new(&Curved::new(hole), event, velocity, event.position(), DVec3::Z).ok()?;
        Some((hole, frame))
    }

    /// Rays that come from the sky: into the cone that is left of it, or into nearly all directions for who falls.
    fn rays(self, above: f64) -> Vec<Probe> {
        let Some((hole, frame)) = self.at(above) else { return Vec::new() };
        let cone = if self.falls { 1.0 } else { above.sqrt().min(1.0) };
        let directions = [0.0, 0.1, 0.3, 0.6].into_iter().flat_map(|part| {
            [0.0f64, 2.0, 4.0].map(|turn| DVec3::new(part * cone * turn.cos(), part * cone * turn.sin(), 1.0))
        });
        let beside = [0.0f64, 1.3, 2.6, 3.9, 5.2].map(|turn| DVec3::new(turn.cos(), turn.sin(), 0.0));
        let beside = beside.into_iter().filter(|_| self.falls);
        directions.chain(beside).map(|n| Probe::near(&frame, hole, n)).collect()
    }

    /// What pictures are made with there.
    fn tolerance(self, above: f64) -> f64 {
        let tolerance = |(hole, frame)| around_seen_from(hole, &Eye::Near(frame)).accuracy().tolerance;
        self.at(above).map_or(f64::NAN, tolerance)
    }
}

/// Rays past a hole whose spin is so far below its mass, on both sides of it.
fn fast_spin(below: f64) -> Vec<Probe> {
    let Ok(hole) = KerrSchild::new(1.0, 1.0 - below) else { return Vec::new() };
    let Ok(camera) = DistantCamera::at_infinity(hole, 75f64.to_radians()) else { return Vec::new() };
    let places = [-8.0, -7.2, -5.0, -2.5, 0.5, 2.5, 5.0, 7.2, 8.0].into_iter();
    let all = places.flat_map(|alpha| [0.3, 2.0, -4.9].map(|beta| (alpha, beta)));
    all.filter_map(|(alpha, beta)| Probe::distant(&camera, hole, alpha, beta)).collect()
}

const BEYOND: [f64; 13] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 10.0, 100.0];
const FROM_AXIS: [f64; 11] = [1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0];
const ABOVE: [f64; 13] = [2e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 3.0];
const BELOW: [f64; 11] = [0.0, 1e-15, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0];

pub(super) fn maps(resolution: Resolution) -> Vec<Map> {
    let tolerances = match resolution {
        Resolution::Usual => TOLERANCES.to_vec(),
        Resolution::Quick => vec![1e-10, 1e-8, 1e-6, 1e-4],
    };
    let few = |all: &[f64]| resolution.some(all, 4);
    let of = |columns: &[f64], probes: fn(f64) -> Vec<Probe>| {
        let columns: Vec<_> = columns.par_iter().map(|x| probes(*x)).collect();
        table(&columns, &tolerances)
    };
    let (beyond, axis, above, below) = (few(&BEYOND), few(&FROM_AXIS), few(&ABOVE), few(&BELOW));
    let usual = KerrSchild::schwarzschild(1.0).map_or(f64::NAN, |hole| around(hole).accuracy().tolerance);
    let everywhere = |columns: &[f64]| vec![usual; columns.len()];
    let looking_out = |who: LookOut| above.iter().map(|x| who.tolerance(*x)).collect();
    [
        (
            "impact",
            "Where light past a resting hole comes from",
            Axis::of("impact parameter beyond the critical one, M", beyond.clone()),
            impact(&beyond, &tolerances),
            everywhere(&beyond),
        ),
        (
            "axis",
            "Where rays near the axis come from, a = 0.9 M",
            Axis::of("distance from the axis, rad or M", axis.clone()),
            of(&axis, near_axis),
            everywhere(&axis),
        ),
        (
            "horizon",
            "Looking out from near the horizon, a = 0.9 M",
            Axis::of("height above the horizon, of its radius", above.clone()),
            of(&above, |x| RESTING.rays(x)),
            looking_out(RESTING),
        ),
        (
            "falling",
            "Falling past near the horizon, a = 0.998 M",
            Axis::of("height above the horizon, of its radius", above.clone()),
            of(&above, |x| FALLING.rays(x)),
            looking_out(FALLING),
        ),
        (
            "spin",
            "Where light past a fast hole comes from",
            Axis::of("1 − a/M", below.clone()),
            of(&below, fast_spin),
            everywhere(&below),
        ),
    ]
    .into_iter()
    .map(|(name, title, x, cells, used)| {
        let planner = (0..cells.len()).map(|cell| {
            let (column, row) = (cell % x.len(), cell / x.len());
            // The least tolerance of the map that is not below what is used.
            let enters = used[column] <= 1.001 * tolerances[row]
                && (row == 0 || used[column] > 1.001 * tolerances[row - 1]);
            let (off, _) = cells[cell];
            match enters {
                false => Planner::Avoids,
                true if off.error > QUARTER_PIXEL && off.flagged => Planner::Warns,
                true => Planner::Enters,
            }
        });
        let planner = planner.collect();
        let map = Map {
            sheet: "curved",
            name: name.to_owned(),
            title: title.to_owned(),
            x,
            y: Axis::of("error allowed in a step", tolerances.clone()),
            quantity: "error, rad, over the conditioning",
            tolerance: QUARTER_PIXEL,
            errors: cells.iter().map(|(off, _)| off.error).collect(),
            conditioning: Some(cells.iter().map(|(_, conditioning)| *conditioning).collect()),
            planner,
            words: String::new(),
        };
        let words = words(&map, usual);
        Map { words, ..map }
    })
    .collect()
}

fn words(map: &Map, usual: f64) -> String {
    let near_horizon = ["horizon", "falling"].contains(&map.name.as_str());
    let rows = (0..map.errors.len()).filter(|&c| map.fails(c)).map(|c| map.y.values[c / map.x.len()]);
    let what = match rows.reduce(f64::min) {
        Some(_) if near_horizon => "Fails the more, the nearer to the horizon".to_owned(),
        Some(tolerance) => format!("Fails in places from {} a step on", number(tolerance)),
        None => "Fails nowhere".to_owned(),
    };
    let worst = map.worst(&[Planner::Enters]).unwrap_or(f64::NAN);
    let less = if near_horizon { ", and less near the horizon" } else { "" };
    let made = format!("Pictures are made with {}{less}", number(usual));
    let warned = match map.planner.contains(&Planner::Warns) {
        true => "; nearer than that rays are known to drift, and are flagged in the picture",
        false => "",
    };
    format!("{what}. {made}: within {}{warned}.", number(worst))
}
