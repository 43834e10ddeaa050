//! Eq. 1 and 3 as they are printed, and as they are computed here, in f32 and f64.

use super::map::number;
use super::wide::{Vector, cross, dot};
use super::{Axis, Map, Planner, QUARTER_PIXEL, Resolution, conditioning, seen};
use crate::relativity::{ApparentMap, Lane, MapLane, Motion, Points, PointsMut};
use glam::DVec3;
use rayon::prelude::*;
use terrell_geodesic::{Celerity, Event, Real, Tetrad, Wide, World};

/// γ of the columns.
pub(super) const GAMMAS: [f64; 22] = [
    1.0, 1.001, 1.1, 2.0, 3.2, 1e1, 3.2e1, 1e2, 3.2e2, 1e3, 3.2e3, 1e4, 3.2e4, 1e5, 3.2e5, 1e6, 3.2e6, 1e7,
    3.2e7, 1e8, 3.2e8, 1e9,
];

/// Where the point is.
#[derive(Clone, Copy)]
enum Place {
    /// At this angle to the motion in the rest frame; an angle from the axis on the approaching side, if negative.
    AtRest(f64),
    /// Seen at this angle to the motion, ten lengths away.
    Seen(f64),
    /// In the body, so near to the camera.
    Inside(f64),
}

const PLACES: &[(&str, Place)] = &[
    ("receding, on the axis", Place::AtRest(0.0)),
    ("receding, 1e-9 rad off it", Place::AtRest(1e-9)),
    ("receding, 1e-6 rad off it", Place::AtRest(1e-6)),
    ("receding, 1e-3 rad off it", Place::AtRest(1e-3)),
    ("receding, 0.1 rad off it", Place::AtRest(0.1)),
    ("seen behind, 30° off", Place::Seen(30.0)),
    ("seen beside", Place::Seen(90.0)),
    ("seen ahead, 30° off", Place::Seen(150.0)),
    ("beside, at rest", Place::AtRest(std::f64::consts::FRAC_PI_2)),
    ("coming, 0.1 rad off the axis", Place::AtRest(-0.1)),
    ("coming, 1e-3 rad off it", Place::AtRest(-1e-3)),
    ("coming, 1e-6 rad off it", Place::AtRest(-1e-6)),
    ("coming, 1e-9 rad off it", Place::AtRest(-1e-9)),
    ("coming, on the axis", Place::AtRest(-0.0)),
    ("1e-3 from the camera, in the body", Place::Inside(1e-3)),
    ("1e-6 from the camera, in the body", Place::Inside(1e-6)),
];

/// A body, an observer and a point of the body.
struct Setting {
    motion: Motion,
    observer: Event<World>,
    x_rest: DVec3,
}

/// Directions of the motion; errors of a cell are the greatest of all of them.
fn axes(resolution: Resolution) -> Vec<DVec3> {
    let all = [
        [0.36, 0.48, 0.8],
        [1.0, 0.0, 0.0],
        [-0.7, 0.1, 0.4],
        [0.2, -0.9, 0.3],
        [0.01, 0.02, -1.0],
        [0.6, -0.5, -0.7],
    ];
    resolution.some(&all.map(|v| DVec3::from_array(v).normalize()), 2)
}

fn setting(axis: DVec3, gamma: f64, place: Place) -> Setting {
    let celerity = Celerity::from_gamma(gamma, axis).unwrap_or_else(|_| Celerity::at_rest());
    let beside = axis.any_orthonormal_vector();
    let origin = Event::origin();
    match place {
        Place::AtRest(angle) => {
            let along = if angle.is_sign_negative() { -angle.abs().cos() } else { angle.cos() };
            let x_rest = along * axis + angle.abs().sin() * beside;
            Setting { motion: Motion { celerity, origin }, observer: origin, x_rest }
        }
        Place::Seen(degrees) => {
            // The light of a point of the body left there ten lengths away.
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let to = 10.0 * (cosine * axis + sine * beside);
            let motion = Motion { celerity, origin: Event::at(-9.0, to - DVec3::new(0.5, 1.0, -0.25)) };
            let map = ApparentMap::new(&motion, &Tetrad::of_world(origin));
            Setting { motion, observer: origin, x_rest: map.unsee(to).0 }
        }
        Place::Inside(distance) => {
            let at = 1.3 * axis + 0.7 * beside;
            // At the world's time 0 what is along the motion is shorter by γ.
            let observer = Event::at(0.0, 1.3 / celerity.gamma() * axis + 0.7 * beside);
            let to = (0.3 * axis + beside + axis.cross(beside)).normalize();
            Setting { motion: Motion { celerity, origin }, observer, x_rest: at + distance * to }
        }
    }
}

/// What one way makes of a point: position, distance, Doppler factor.
type Found = ([f64; 3], f64, f64);

/// Relative errors: of the direction, the distance, the Doppler factor.
fn errors(found: Found, exact: &super::Seen) -> [f64; 3] {
    let (position, distance, doppler) = found;
    let relative = |value: f64, exact: Wide| {
        let error = ((Wide::from(value) - exact) / exact).value().abs();
        if error.is_finite() { error } else { f64::INFINITY }
    };
    let position: Vector = position.map(Wide::from);
    let across = cross(position, exact.position);
    let length = dot(position, position).sqrt() * exact.distance;
    let angle =
        (dot(across, across).sqrt() / length).value().atan2((dot(position, exact.position) / length).value());
    [
        if angle.is_finite() { angle } else { f64::INFINITY },
        relative(distance, exact.distance),
        relative(doppler, exact.doppler),
    ]
}

/// Eq. 1, x = γ(x′ − βr′) along the motion, and Eq. 3, D = γ(1 − β cos θ′), as they are printed, in one kind of numbers
/// throughout, from γ and β that are right to the last digit.
fn printed<R: Lane + Into<f64>>(number: impl Fn(f64) -> R, setting: &Setting, x_rest: [R; 3]) -> Found {
    let Setting { motion, observer, .. } = setting;
    let since = *observer - motion.origin;
    let gamma = number(motion.celerity.gamma());
    let beta = number(motion.celerity.beta().length());
    let axis = motion.celerity.direction().unwrap_or(DVec3::X).to_array().map(&number);
    let one = number(1.0);
    let product = |a: [R; 3], b: [R; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    // The observer in the rest frame, by the boost.
    let (t, place) = (number(since.t), since.xyz().to_array().map(&number));
    let along = product(place, axis);
    let moved = gamma * (along - beta * t) - along;
    let offset: [R; 3] = std::array::from_fn(|i| x_rest[i] - (place[i] + moved * axis[i]));
    let rest_distance = product(offset, offset).root();
    let along = product(offset, axis);
    let seen_along = gamma * (along - beta * rest_distance);
    let position: [R; 3] = std::array::from_fn(|i| (offset[i] - along * axis[i]) + seen_along * axis[i]);
    let cosine = along / rest_distance;
    let doppler = gamma * (one - beta * cosine);
    (position.map(Into::into), product(position, position).root().into(), doppler.into())
}

/// By the apparent map, in all ways it has.
fn mapped<R: MapLane + Into<f64>>(map: &ApparentMap, zero: R, x: [R; 3]) -> [Found; 2] {
    [true, false].map(|base| {
        let mut out = [[zero]; 5];
        let [a, b, c, distance, doppler] = &mut out;
        let rest = Points { x: &x[..1], y: &x[1..2], z: &x[2..] };
        let to = PointsMut { x: a, y: b, z: c, distance, doppler };
        if base {
            map.see_all_base(rest, to)
        } else {
            map.see_all(rest, to)
        }
        let [[a], [b], [c], [distance], [doppler]] = out;
        ([a, b, c].map(Into::into), distance.into(), doppler.into())
    })
}

/// Greater of each.
fn worst(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i].max(b[i]))
}

/// By way (as printed in f32, in f64, the apparent map in f32, in f64) the errors; and the conditioning.
fn cell(axes: &[DVec3], gamma: f64, place: Place) -> ([[f64; 3]; 4], f64) {
    let (mut all, mut condition) = ([[0.0; 3]; 4], 1f64);
    for &axis in axes {
        let setting = setting(axis, gamma, place);
        let Setting { motion, observer, x_rest } = &setting;
        let map = ApparentMap::new(motion, &Tetrad::of_world(*observer));
        let single = x_rest.as_vec3().to_array();
        let [exact, exact_single] =
            [*x_rest, x_rest.as_vec3().as_dvec3()].map(|x| seen(motion, *observer, x));
        let here = conditioning(motion, *observer, *x_rest).max(1.0);
        condition = condition.max(here);
        let of = |found: &[Found], exact| found.iter().map(|f| errors(*f, exact)).fold([0.0; 3], worst);
        let ways = [
            of(&[printed(|v| v as f32, &setting, single)], &exact_single),
            of(&[printed(|v| v, &setting, x_rest.to_array())], &exact),
            of(&mapped::<f32>(&map, 0.0, single), &exact_single),
            of(&mapped::<f64>(&map, 0.0, x_rest.to_array()), &exact),
        ];
        for (all, way) in all.iter_mut().zip(ways) {
            *all = worst(*all, way);
        }
    }
    (all, condition)
}

/// What is measured: name, words, unit.
const QUANTITIES: [[&str; 3]; 3] = [
    ["direction", "direction", "error of the direction, rad"],
    ["distance", "distance", "relative error of the distance"],
    ["doppler", "Doppler factor", "relative error of D"],
];

pub(super) fn maps(resolution: Resolution) -> Vec<Map> {
    let (gammas, places) = (resolution.some(&GAMMAS, 6), resolution.some(PLACES, 8));
    let axes = axes(resolution);
    let cells: Vec<_> = places
        .par_iter()
        .flat_map_iter(|(_, place)| {
            gammas.iter().map(|gamma| cell(&axes, *gamma, *place)).collect::<Vec<_>>()
        })
        .collect();
    let conditioning: Vec<f64> = cells.iter().map(|(_, condition)| *condition).collect();
    let ways = [
        ("printed_f32", "as printed, f32", Planner::Avoids),
        ("printed_f64", "as printed, f64", Planner::Avoids),
        ("map_f32", "apparent map, f32", Planner::Avoids),
        ("map_f64", "apparent map, f64", Planner::Enters),
    ];
    let mut maps = Vec::new();
    for (q, [name, title, quantity]) in QUANTITIES.into_iter().enumerate() {
        for (w, (way, how, planner)) in ways.into_iter().enumerate() {
            let map = Map {
                sheet: "place",
                name: format!("{name}_{way}"),
                title: format!("{title}: {how}"),
                x: Axis::of("γ", gammas.clone()),
                y: Axis::named("where the point is", places.iter().map(|(name, _)| *name).collect()),
                quantity,
                tolerance: QUARTER_PIXEL,
                errors: cells.iter().map(|(errors, _)| errors[w][q]).collect(),
                conditioning: Some(conditioning.clone()),
                planner: vec![planner; cells.len()],
                words: String::new(),
            };
            let words = words(&map, &places, how);
            maps.push(Map { words, ..map });
        }
    }
    maps
}

fn words(map: &Map, places: &[(&str, Place)], how: &str) -> String {
    let worst = map.errors.iter().copied().fold(0.0, f64::max);
    let failing = |is_inside: bool| {
        let is_of = |cell: &usize| matches!(places[cell / map.x.len()].1, Place::Inside(_)) == is_inside;
        let cells = (0..map.errors.len()).filter(|cell| map.fails(*cell)).filter(is_of);
        cells.map(|cell| map.x.values[cell % map.x.len()]).reduce(f64::min)
    };
    let what = match (failing(false), failing(true)) {
        (None, None) => format!("Nowhere off by more than {}", number(worst)),
        (None, Some(_)) => "Fails right before the camera".to_owned(),
        (Some(gamma), None) => format!("Fails from γ = {} on", number(gamma)),
        (Some(gamma), Some(_)) => format!("Fails from γ = {} on, and right before the camera", number(gamma)),
    };
    let done = match map.planner[0] {
        Planner::Enters => "everything moved to where it is seen goes through it",
        _ if how.starts_with("as printed") => {
            "never used: differences of large numbers cancel in it, by γ² for what recedes"
        }
        _ => "for programs whose vertices are f32; pictures are made in f64",
    };
    format!("{what}; {done}.")
}
