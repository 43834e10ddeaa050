//! Meshes cut for their shape in space: never off by more than asked, without cracks, and not at all at rest.

mod common;

use common::Random;
use glam::{DVec3, Vec3};
use std::collections::HashMap;
use terrell::apparent::{Cutting, CuttingError, Moment, see_vertices};
use terrell::geodesic::{Celerity, Event, Tetrad};
use terrell::relativity::{ApparentMap, Motion};
use terrell::scene::{Mesh, Paint, builtin_mesh, shapes};

fn map(celerity: DVec3, eye: DVec3) -> ApparentMap {
    let motion = Motion { celerity: Celerity::new(celerity).unwrap(), origin: Event::origin() };
    // The observer's event for which its rest-frame place is `eye`, at rest-frame time 0.
    let event =
        Event::origin() + motion.world_from_rest() * terrell::geodesic::FourVector::from_parts(0.0, eye);
    let observer = Tetrad::new(event, Celerity::at_rest(), DVec3::Y, DVec3::Z).unwrap();
    ApparentMap::new(&motion, &observer)
}

const MOST: usize = 3_000_000;

/// Greatest distance of sampled points of the flat triangles from where these are seen.
fn worst(mesh: &Mesh, cutting: &Cutting, map: &ApparentMap, steps: usize) -> f64 {
    let cut = cutting.apply(mesh);
    let (seen, _) = see_vertices(&cut, map);
    let mut worst = 0.0f64;
    for triangle in &cut.triangles {
        let [a, b, c] = triangle.map(|v| cut.vertex(v));
        let [p, q, r] = triangle.map(|v| seen[v as usize]);
        for i in 0..=steps {
            for j in 0..=steps - i {
                let (v, w) = (i as f64 / steps as f64, j as f64 / steps as f64);
                let flat = p + v * (q - p) + w * (r - p);
                let exact = map.see(a + v * (b - a) + w * (c - a)).position;
                worst = worst.max(flat.distance(exact));
            }
        }
    }
    worst
}

#[test]
fn no_point_is_off_by_more_than_asked() {
    let mut random = Random(7);
    let mut used = 0.0f64;
    for round in 0..150 {
        let corners = [0; 3].map(|_| random.point(2.0));
        let mesh = Mesh::new(&corners, vec![[0, 1, 2]]);
        let speed = [0.1, 1.0, 7.0, 100.0, 1e3][round % 5];
        let direction = random.point(1.0).normalize();
        // Also just above the triangle, and in its plane.
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let eye = match round % 3 {
            0 => random.point(3.0),
            1 => middle + random.point(0.05),
            _ => middle,
        };
        let map = map(direction * speed, eye);
        let tolerance = [0.3, 0.02][round % 2] * speed.max(1.0).sqrt();
        let cutting = Cutting::new(&[Moment { mesh: &mesh, map: &map }], tolerance, MOST).unwrap();
        let off = worst(&mesh, &cutting, &map, 12);
        // 1e-9 for what the map and the sampling round, of lengths up to 2γ·8.
        assert!(off <= tolerance + 1e-9 * speed, "round {round}: {off} for {tolerance}");
        used = used.max(off / tolerance);
    }
    assert!(used > 0.9, "the tolerance is used up: {used}");
}

/// Seen abreast, r′ is γ times the distance, and what is cut is small beside it.
#[test]
fn the_tolerance_also_holds_for_small_things_near_light_speed() {
    let mesh = builtin_mesh("cube").unwrap();
    for (gamma, tolerance) in [(1e3f64, 1e-3), (1e6, 1e-3), (1e9, 1e-2)] {
        let speed = (gamma * gamma - 1.0).sqrt();
        let map = map(DVec3::X * speed, DVec3::new(-3.0 * speed, -3.0, 0.2));
        let cutting = Cutting::new(&[Moment { mesh: &mesh, map: &map }], tolerance, MOST).unwrap();
        let off = worst(&mesh, &cutting, &map, 10);
        assert!(off <= tolerance && off > 0.3 * tolerance, "γ {gamma}: {off}");
        assert!(cutting.triangles.len() < 2000, "γ {gamma}: {}", cutting.triangles.len());
    }
}

#[test]
fn one_cutting_serves_all_moments() {
    let mesh = builtin_mesh("cube").unwrap();
    let maps: Vec<_> =
        (0..7).map(|i| map(DVec3::X * 3.0, DVec3::new(f64::from(i) - 3.0, -1.5, 0.2))).collect();
    let moments: Vec<_> = maps.iter().map(|map| Moment { mesh: &mesh, map }).collect();
    let all = Cutting::new(&moments, 0.01, MOST).unwrap();
    for moment in &moments {
        let off = worst(&mesh, &all, moment.map, 10);
        assert!(off <= 0.01, "{off}");
        let alone = Cutting::new(&[*moment], 0.01, MOST).unwrap();
        assert!(alone.triangles.len() <= all.triangles.len());
    }
}

/// Every edge between pieces belongs to two triangles, in opposite directions, if those of the mesh do: by places,
/// so that it also holds for vertices that are not shared.
#[test]
fn there_are_no_cracks() {
    let globe = shapes::sphere(2);
    // The same without shared vertices, every other triangle beginning elsewhere.
    let mut loose = Vec::new();
    for i in 0..globe.triangles.len() {
        let mut corners = globe.corners(i);
        corners.rotate_left(i % 3);
        loose.extend(corners);
    }
    let triangles = (0..loose.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let loose = Mesh::new(&loose, triangles);
    for mesh in [globe, loose] {
        for (speed, eye) in [(7.0, DVec3::new(0.3, -1.2, 0.4)), (100.0, DVec3::new(3.0, 0.2, 0.1))] {
            let map = map(DVec3::new(1.0, 0.3, -0.2).normalize() * speed, eye);
            let cutting = Cutting::new(&[Moment { mesh: &mesh, map: &map }], 0.02, MOST).unwrap();
            assert!(cutting.triangles.len() > 2 * mesh.triangles.len());
            let cut = cutting.apply(&mesh);
            let (seen, _) = see_vertices(&cut, &map);
            // The map rounds two equal vertices alike, so places can be compared to the bit.
            let key = |v: u32| seen[v as usize].to_array().map(f64::to_bits);
            let mut edges: HashMap<_, i32> = HashMap::new();
            for [a, b, c] in &cut.triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let (from, to) = (key(*from), key(*to));
                    if from < to {
                        *edges.entry((from, to)).or_default() += 1;
                    } else {
                        *edges.entry((to, from)).or_default() -= 1;
                    }
                }
            }
            assert!(
                edges.values().all(|sum| *sum == 0),
                "{} open",
                edges.values().filter(|s| **s != 0).count()
            );
        }
    }
}

#[test]
fn at_rest_nothing_is_cut() {
    let mesh = builtin_mesh("lattice").unwrap();
    let map = map(DVec3::ZERO, DVec3::new(0.0, -9.0, 0.0));
    let cutting = Cutting::new(&[Moment { mesh: &mesh, map: &map }], 1e-9, 1).unwrap();
    assert_eq!(cutting.apply(&mesh), mesh);
}

#[test]
fn attributes_are_those_of_the_rest_frame() {
    let corners = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
    let mut mesh = Mesh::new(&corners, vec![[0, 1, 2]]);
    mesh.uv = vec![[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
    mesh.paint = Paint::Vertices(vec![[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
    mesh.normals = vec![[0.0, 0.0, 1.0]; 3];
    let map = map(DVec3::new(2.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.3));
    let cutting = Cutting::new(&[Moment { mesh: &mesh, map: &map }], 1e-3, MOST).unwrap();
    let cut = cutting.apply(&mesh);
    cut.check().unwrap();
    assert!(cut.vertex_count() > 100);
    let Paint::Vertices(colors) = &cut.paint else { panic!() };
    for (v, (uv, color)) in cut.uv.iter().zip(colors).enumerate() {
        let at = cut.vertex(v as u32).as_vec3();
        assert!((Vec3::new(uv[0], uv[1], 0.0) - at).length() < 1e-6);
        assert!((Vec3::from(*color) - at).length() < 1e-6);
        assert!((Vec3::from(cut.normals[v]) - Vec3::Z).length() < 1e-6);
    }
}

/// The derivative of the map, by differences: the normal is square to the images of two tangents.
#[test]
fn normals_are_those_of_the_apparent_surface() {
    let mut random = Random(3);
    for round in 0..200 {
        let speed = [0.5, 7.0, 100.0][round % 3];
        let map = map(random.point(1.0).normalize() * speed, random.point(2.0));
        let at = random.point(2.0);
        let (t1, t2) = (random.point(1.0).normalize(), random.point(1.0).normalize());
        let seen = map.seen_normal(at, t1.cross(t2).normalize());
        let image = |t: DVec3| {
            let step = 1e-5 * map.see(at).rest_distance;
            (map.see(at + t * step).position - map.see(at - t * step).position).normalize()
        };
        let (s1, s2) = (image(t1), image(t2));
        // Differences are good to 1e-9 or so times γ; the axes are left-handed, so the turn is the other way.
        assert!(seen.dot(s1).abs() < 1e-7 * speed && seen.dot(s2).abs() < 1e-7 * speed, "{round}");
        assert!((seen.length() - 1.0).abs() < 1e-12);
        assert!(s1.cross(s2).dot(seen) < 0.0, "{round}");
    }
}

#[test]
fn what_cannot_be_kept_is_refused() {
    let mesh = builtin_mesh("cube").unwrap();
    let map = map(DVec3::X * 1e3, DVec3::new(2.0, 0.3, 0.1));
    let moments = [Moment { mesh: &mesh, map: &map }];
    let refused = |tolerance: f64, most: usize| Cutting::new(&moments, tolerance, most).unwrap_err();
    assert!(matches!(refused(1e-2, 100), CuttingError::TooMany { most: 100, .. }));
    assert!(matches!(refused(1e-7, MOST), CuttingError::TooMany { .. }));
    assert!(matches!(refused(1e-14, MOST), CuttingError::BelowDigits { .. }));
    for tolerance in [0.0, -1.0, f64::NAN] {
        assert!(matches!(refused(tolerance, MOST), CuttingError::NoLength(_)));
    }
}
