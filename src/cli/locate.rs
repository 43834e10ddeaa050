use super::Fault;
use super::values::{event, number, vector};
use super::velocity::{VelocityFlags, of_resting};
use clap::Args;
use glam::DVec3;
use std::io::{BufRead, BufWriter, Write};
use terrell::geodesic::{Event, Tetrad, World};
use terrell::relativity::{ApparentMap, Motion};

/// Where points of a moving body are seen: numbers in, CSV out
///
/// Points are rest-frame coordinates, given as arguments or, if there are none, as CSV with the header x,y,z
/// on standard input. The camera's frame is the world's, its axes x, y, z.
///
/// Columns out: x,y,z (rest frame), apparent_x,apparent_y,apparent_z (relative to the observer), distance
/// (apparent, r), doppler (D = ν observed / ν emitted), cos_theta_rest and cos_theta_observer (between the
/// velocity and observer → point, in the body's rest frame and in the observer's), emission_time (world
/// frame), color_temperature (K: a black body of --temperature is seen as one of D times that). 17 significant digits; a field without meaning (angles at rest, D of a point at the observer) is
/// empty.
#[derive(Args)]
#[command(after_help = "Examples:
  terrell locate --beta 0.9,0,0 1,2,3 -1,2,3
  terrell locate --gamma 1000 --direction 1,1,0 --offset -3,0,3,0 < points.csv
  terrell locate --celerity 2.06,0,0 --inverse 0.5,3,0")]
pub struct Locate {
    #[command(flatten)]
    velocity: VelocityFlags,
    /// Event at which the body's rest-frame origin is (at rest-frame time 0): X = L X′ + offset
    #[arg(long, value_name = "T,X,Y,Z", value_parser = event, default_value = "0,0,0,0")]
    offset: Event<World>,
    /// The observer's event
    #[arg(long, value_name = "T,X,Y,Z", value_parser = event, default_value = "0,0,0,0")]
    observer: Event<World>,
    /// Temperature of a black body at the point, K
    #[arg(long, value_name = "K", value_parser = number, default_value = "6504")]
    temperature: f64,
    /// From apparent position (relative to the observer) to rest-frame coordinates
    #[arg(long)]
    inverse: bool,
    /// Points; none to read CSV
    #[arg(value_name = "X,Y,Z", value_parser = vector)]
    points: Vec<DVec3>,
}

const HEADER: &str = "x,y,z,apparent_x,apparent_y,apparent_z,distance,doppler,cos_theta_rest,cos_theta_observer,emission_time,color_temperature";

impl Locate {
    pub fn run(self) -> Result<(), Fault> {
        if self.temperature <= 0.0 {
            return Err(format!("--temperature {} is not above 0 K", self.temperature).into());
        }
        let speed = self.velocity.speed()?;
        let speed = speed
            .ok_or("a velocity is needed: --beta, --gamma with --direction, --celerity or --rapidity")?;
        let motion = Motion { celerity: of_resting(speed)?, origin: self.offset };
        let map = ApparentMap::new(&motion, &Tetrad::of_world(self.observer));
        let mut out = BufWriter::new(std::io::stdout().lock());
        if self.points.is_empty() {
            self.rows_of_csv(&map, &mut out)?;
        } else {
            writeln!(out, "{HEADER}")?;
            for &point in &self.points {
                self.row(&map, point, &mut out)?;
            }
        }
        Ok(out.flush()?)
    }

    fn rows_of_csv(&self, map: &ApparentMap, out: &mut impl Write) -> Result<(), Fault> {
        let mut lines = std::io::stdin().lock().lines().enumerate();
        let (_, header) =
            lines.next().ok_or("standard input is empty; CSV with the header x,y,z is needed")?;
        let header = header.map_err(|e| format!("standard input, line 1: {e}"))?;
        let header: Vec<_> = header.trim_start_matches('\u{feff}').split(',').map(str::trim).collect();
        if header != ["x", "y", "z"] {
            return Err(
                format!("standard input, line 1: the header is '{}', not 'x,y,z'", header.join(",")).into()
            );
        }
        writeln!(out, "{HEADER}")?;
        for (index, line) in lines {
            let fault = |e: String| format!("standard input, line {}: {e}", index + 1);
            let line = line.map_err(|e| fault(e.to_string()))?;
            if !line.trim().is_empty() {
                self.row(map, vector(&line).map_err(fault)?, out)?;
            }
        }
        Ok(())
    }

    fn row(&self, map: &ApparentMap, point: DVec3, out: &mut impl Write) -> std::io::Result<()> {
        let (x_rest, sight) = if self.inverse { map.unsee(point) } else { (point, map.see(point)) };
        let apparent = if self.inverse { point } else { sight.position };
        let at_rest = map.speed() == 0.0;
        let cosine = |c: f64| if at_rest { f64::NAN } else { c };
        let fields = [
            x_rest.x,
            x_rest.y,
            x_rest.z,
            apparent.x,
            apparent.y,
            apparent.z,
            sight.distance,
            sight.doppler,
            cosine(sight.cos_theta_rest),
            cosine(sight.cos_theta_observer),
            self.observer.t() - sight.distance,
            sight.doppler * self.temperature,
        ];
        for (i, field) in fields.into_iter().enumerate() {
            if i > 0 {
                write!(out, ",")?;
            }
            if !field.is_nan() {
                // −0 is 0.
                write!(out, "{:.16e}", field + 0.0)?;
            }
        }
        writeln!(out)
    }
}
