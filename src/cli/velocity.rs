use super::Fault;
use super::values::{SpeedOrVector, number, speed_or_vector, vector};
use clap::Args;
use glam::DVec3;
use terrell::geodesic::Celerity;
use terrell::scene::Speed;

/// A velocity, in whichever way is at hand.
#[derive(Args)]
#[group(multiple = true)]
pub struct VelocityFlags {
    /// Velocity over c: one number (along the motion, or +x) or X,Y,Z
    #[arg(long, value_name = "β|X,Y,Z", value_parser = speed_or_vector, conflicts_with_all = ["gamma", "celerity", "rapidity"])]
    beta: Option<SpeedOrVector>,
    /// Lorentz factor; with --direction, or along the motion
    #[arg(long, value_name = "γ", value_parser = number, conflicts_with_all = ["celerity", "rapidity"])]
    gamma: Option<f64>,
    /// Celerity γβ: one number or X,Y,Z; exact near light speed
    #[arg(long, value_name = "γβ|X,Y,Z", value_parser = speed_or_vector, conflicts_with = "rapidity")]
    celerity: Option<SpeedOrVector>,
    /// Rapidity (artanh β)
    #[arg(long, value_name = "w", value_parser = number)]
    rapidity: Option<f64>,
    /// Direction of the motion, any length
    #[arg(long, value_name = "X,Y,Z", value_parser = vector)]
    direction: Option<DVec3>,
}

impl VelocityFlags {
    /// What is asked for, if anything.
    pub fn speed(&self) -> Result<Option<Speed>, Fault> {
        let along_x = match (self.beta, self.gamma, self.celerity, self.rapidity) {
            (Some(SpeedOrVector::Vector(v)), ..) => {
                return self.vector("--beta", Celerity::from_beta(v)?);
            }
            (_, _, Some(SpeedOrVector::Vector(v)), _) => {
                return self.vector("--celerity", Celerity::new(v)?);
            }
            (Some(SpeedOrVector::Speed(beta)), ..) => Celerity::from_beta(DVec3::X * beta)?,
            (_, Some(gamma), ..) => Celerity::from_gamma(gamma, DVec3::X)?,
            (_, _, Some(SpeedOrVector::Speed(u)), _) => Celerity::new(DVec3::X * u)?,
            (.., Some(w)) => Celerity::from_rapidity(w, DVec3::X)?,
            (None, None, None, None) if self.direction.is_some() => {
                return Err("--direction needs a speed: add --beta, --gamma, --celerity or --rapidity".into());
            }
            (None, None, None, None) => return Ok(None),
        };
        let magnitude = along_x.vector().x;
        Ok(Some(match (self.direction, self.gamma) {
            (None, _) => Speed::Along(magnitude),
            (Some(direction), Some(gamma)) => Speed::Velocity(Celerity::from_gamma(gamma, direction)?),
            // A speed along a direction: the direction at some γ has its unit vector.
            (Some(direction), None) => {
                let unit = Celerity::from_gamma(2.0, direction)?.direction().unwrap_or(DVec3::X);
                Speed::Velocity(Celerity::new(unit * magnitude)?)
            }
        }))
    }

    fn vector(&self, flag: &str, velocity: Celerity) -> Result<Option<Speed>, Fault> {
        match self.direction {
            Some(_) => {
                Err(format!("{flag} with three numbers already has a direction; remove --direction").into())
            }
            None => Ok(Some(Speed::Velocity(velocity))),
        }
    }
}

/// The velocity meant for something at rest so far.
pub fn of_resting(speed: Speed) -> Result<Celerity, Fault> {
    Ok(match speed {
        Speed::Velocity(velocity) => velocity,
        Speed::Along(magnitude) => Celerity::new(DVec3::X * magnitude)?,
    })
}
