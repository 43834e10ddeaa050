//! A spacetime of your own from its metric alone: a wormhole, and where its mouth shows the other side.
//!
//! `cargo run --release -p terrell-geodesic --example own_metric`

use glam::DVec3;
use terrell_geodesic::{Curved, End, Event, LocalFrame, Metric, Number, Spacetime, Stop, static_observer};

/// Ellis' wormhole of throat radius b: −dt² + (1 + b²/4ρ²)² (dx² + dy² + dz²); ρ < b/2 is the other side.
struct Wormhole {
    throat: f64,
}

impl Metric for Wormhole {
    fn covariant<S: Number>(&self, [_, x, y, z]: [S; 4]) -> [[S; 4]; 4] {
        let (zero, one) = (S::from(0.0), S::from(1.0));
        let stretch = (S::from(0.25 * self.throat * self.throat) / (x * x + y * y + z * z) + 1.0).squared();
        [
            [-one, zero, zero, zero],
            [zero, stretch, zero, zero],
            [zero, zero, stretch, zero],
            [zero, zero, zero, stretch],
        ]
    }

    // The other side's infinity is ρ = 0.
    fn stop(&self, [_, x, y, z]: [f64; 4]) -> Option<Stop> {
        (x * x + y * y + z * z < (0.01 * self.throat).powi(2)).then_some(Stop::Edge)
    }

    fn scale(&self) -> f64 {
        self.throat
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let space = Curved::metric(Wormhole { throat: 1.0 });
    let event = Event::new(0.0, 8.0, 0.0, 0.0);
    let frame = LocalFrame::new(&space, event, static_observer(&space, event)?, -DVec3::X, DVec3::Z)?;
    for row in -12..=12 {
        let line: String = (-24..=24)
            .map(|column| {
                let n = DVec3::new(0.5 * f64::from(column) / 24.0, -0.5 * f64::from(row) / 12.0, 1.0);
                match space.ray(event, frame.seen_from(n.normalize())).follow() {
                    // Lines of longitude, a sixth of a turn wide, as far as the wormhole bends them.
                    End::Sky { wave_vector } => {
                        let [x, y, _] = wave_vector.space;
                        if (y.atan2(x) * 6.0).sin() > 0.0 { '.' } else { ' ' }
                    }
                    End::Edge => 'o',
                    failed => {
                        eprintln!("({column}, {row}): the ray {failed}");
                        '?'
                    }
                }
            })
            .collect();
        println!("{line}");
    }
    Ok(())
}
