//! Throughput of the apparent map, beside a plain copy of the same bytes (three arrays read, five written).
//!
//! `cargo bench --bench apparent_map`; ratios of one run are the result, not the rates.

use glam::DVec3;
use std::time::Instant;
use terrell::geodesic::{Celerity, Event, Tetrad};
use terrell::relativity::{ApparentMap, MapLane, Motion, Points, PointsMut};

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

struct Arrays<R> {
    from: [Vec<R>; 3],
    to: [Vec<R>; 5],
}

impl<R: MapLane> Arrays<R> {
    fn new(n: usize, number: fn(f64) -> R) -> Self {
        let coordinate = |k: f64| (0..n).map(|i| number((i as f64 * 0.37 + k).sin() * 3.0)).collect();
        Self {
            from: [coordinate(0.0), coordinate(1.0), coordinate(2.0)],
            to: std::array::from_fn(|_| vec![number(0.0); n]),
        }
    }

    fn copy(&mut self) {
        for (i, to) in self.to.iter_mut().enumerate() {
            to.copy_from_slice(std::hint::black_box(&self.from[i % 3]));
        }
        std::hint::black_box(&mut self.to);
    }

    fn map(&mut self, map: &ApparentMap, base: bool) {
        let rest = Points { x: &self.from[0], y: &self.from[1], z: &self.from[2] };
        let [x, y, z, distance, doppler] = &mut self.to;
        let seen = PointsMut { x, y, z, distance, doppler };
        if base {
            map.see_all_base(rest, seen)
        } else {
            map.see_all(rest, seen)
        }
        std::hint::black_box(&mut self.to);
    }
}

/// M vertices/s of copy, base and AVX2, measured in turns; every thread has its share of the vertices.
fn rates<R: MapLane>(shares: &mut [Arrays<R>], map: &ApparentMap, repeats: usize) -> [f64; 3] {
    let n: usize = shares.iter().map(|s| s.from[0].len()).sum();
    let mut times = [vec![], vec![], vec![]];
    for _ in 0..repeats {
        for (which, times) in times.iter_mut().enumerate() {
            let work = |share: &mut Arrays<R>| match which {
                0 => share.copy(),
                1 => share.map(map, true),
                _ => share.map(map, false),
            };
            let start = Instant::now();
            if let [only] = shares {
                work(only);
            } else {
                std::thread::scope(|scope| {
                    for share in shares.iter_mut() {
                        scope.spawn(move || work(share));
                    }
                });
            }
            times.push(start.elapsed().as_secs_f64());
        }
    }
    times.map(|t| n as f64 / median(t) / 1e6)
}

fn report<R: MapLane>(
    name: &str,
    (n, threads, repeats): (usize, usize, usize),
    map: &ApparentMap,
    number: fn(f64) -> R,
) {
    let mut shares: Vec<_> = (0..threads).map(|_| Arrays::new(n / threads, number)).collect();
    let [copy, base, fast] = rates(&mut shares, map, repeats);
    println!(
        "{name:<26} {n:>8} {threads:>7}   copy {copy:7.0}   base {base:6.0} ({:4.2} of copy)   avx2 {fast:6.0} ({:4.2} of copy)",
        base / copy,
        fast / copy
    );
}

fn main() {
    let map = |celerity: DVec3, observer: &Tetrad| {
        let origin = Event::new(-3.0, 0.0, 3.0, 0.0);
        ApparentMap::new(&Motion { celerity: Celerity::new(celerity).unwrap(), origin }, observer)
    };
    let world = Tetrad::of_world(Event::origin());
    let camera = Tetrad::new(Event::origin(), Celerity::at_rest(), DVec3::Y, DVec3::Z).unwrap();
    let (along_x, oblique) = (DVec3::X * 2.0, DVec3::new(2.0, 0.3, -0.1));
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    println!("M vertices/s, median; 'copy' moves the same bytes (24 → 40 f64, 12 → 20 f32)");
    println!("{:<26} {:>8} threads", "", "vertices");
    for run in [(4_000_000, all, 15), (4_000_000, 1, 9), (2_000, 1, 2001)] {
        for (motion, celerity) in [("along x", along_x), ("oblique", oblique)] {
            for (axes, observer) in [("world axes", &world), ("camera axes", &camera)] {
                let map = map(celerity, observer);
                report(&format!("f64 {motion}, {axes}"), run, &map, |v| v);
                report(&format!("f32 {motion}, {axes}"), run, &map, |v| v as f32);
            }
        }
    }
}
