//! What is there: meshes, bodies in motion, the camera; and the files they come from.

mod animation;
mod body;
mod builtin;
mod camera;
mod clip;
mod eye;
mod file;
mod fingerprint;
mod framing;
mod import;
mod light;
mod material;
mod mesh;
mod path;
mod room;
pub mod shapes;
mod sky;
mod spacetime;
mod stars;
mod texture;
mod velocity;
mod view;

pub use animation::{Animation, AnimationError, MAX_FRAMES, Pace, STANDARD_BETA};
pub use body::Body;
pub use builtin::{Builtin, NoSuchScene, builtin_mesh, builtin_meshes, builtin_scene, builtin_scenes};
pub use camera::{Camera, Lens, LensError, MAX_PIXELS, MAX_SIDE, Projection};
pub use clip::{Between, Blend, Clip, Joint, Track};
pub use eye::{DistantEye, Eye, EyeError};
pub(crate) use file::did_you_mean;
pub use file::{SceneError, parse_scene};
pub use fingerprint::Fingerprint;
pub use framing::{authored, framed};
pub use import::{
    Choice, ImportError, Imported, Part, has_scenes, import, import_choosing, import_obj, is_mesh_file,
    read_plain,
};
pub use light::{Light, LightKind};
pub use material::{Colors, EmissionLaw, Gloss, Material, Surface};
pub use mesh::{Mesh, MeshError, Paint};
pub use path::{CameraPath, Key, PathError};
pub use sky::{Sky, SkyTexture};
pub use spacetime::{Spacetime, SpacetimeError, Stance};
pub use texture::{MAX_TEXELS, Picture, Texture, Wrap};
pub use view::{Aim, View, ViewError};

use terrell_geodesic::{Celerity, CelerityError, FourVector, Tetrad, Wide};

/// Bodies and the one who looks at them.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What the scene is called.
    pub name: String,
    /// In the scene's order.
    pub bodies: Vec<Body>,
    /// What lights it; where there is nothing, surfaces shine by themselves.
    pub lights: Vec<Light>,
    /// What lies behind everything, if anything does.
    pub sky: Option<Sky>,
    /// The spacetime all of it lies in.
    pub spacetime: Spacetime,
    /// The camera, before a moment is chosen.
    pub view: View,
    /// How it is filmed, if it says so.
    pub animation: Option<Animation>,
    /// The files it was read from.
    pub files: Vec<std::path::PathBuf>,
    /// What was passed over when reading, for people to read.
    pub notes: Vec<String>,
}

/// A velocity asked for over a scene's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// Speed and direction.
    Velocity(Celerity),
    /// |γβ|; whatever moves keeps its direction (or turns round, if negative), what rests goes along +x.
    Along(f64),
}

/// An animation that is not slow against light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "'{body}' is animated with up to {speed:.3} of light speed within its rest frame; above {} no one pose can stand for it. Slow it down with an animation rate below {:.2e} (seconds of the animation in a unit of time), or stop it with 0",
    Clip::FASTEST,
    Clip::FASTEST / .speed
)]
pub struct TooFast {
    /// Which.
    pub body: String,
    /// Its greatest speed, in units of that of light, at the rate it has.
    pub speed: f64,
}

impl Scene {
    /// Bodies and a view, and nothing else.
    pub fn new(name: &str, bodies: Vec<Body>, view: View) -> Self {
        let (lights, files, notes) = (Vec::new(), Vec::new(), Vec::new());
        let (sky, spacetime, animation) = (None, Spacetime::Flat, None);
        Self { name: name.to_owned(), bodies, lights, sky, spacetime, view, animation, files, notes }
    }

    /// The camera at the moment the view asks for.
    ///
    /// # Errors
    /// If the view cannot be had; see [`ViewError`].
    pub fn camera(&self) -> Result<Camera, ViewError> {
        self.view.camera(&self.bodies)
    }

    /// The camera in the scene's spacetime, which is [`Camera::observer`] by flat spacetime's rules; none where that is all.
    ///
    /// # Errors
    /// If nobody can be there; see [`EyeError`].
    pub fn eye(&self, camera: &Camera) -> Result<Option<Eye>, EyeError> {
        Eye::new(&self.spacetime, &self.view, &camera.observer)
    }

    /// The body that a light at a place is shut in by, if any, when it is where an observer sees it: one whose surface is
    /// closed and turned the same way all around.
    pub fn body_around(&self, light: &Light, observer: &Tetrad) -> Option<&Body> {
        let (LightKind::Point { position } | LightKind::Spot { position, .. }) = light.kind else {
            return None;
        };
        let lamp_from_world = light.motion.world_from_lamp::<Wide>().inverse();
        let since = (lamp_from_world * observer.event().since::<Wide>(light.motion.origin)).rounded();
        let seen = FourVector::from_parts(since.t - since.xyz().distance(position), position).widened();
        let seen = light.motion.world_from_lamp::<Wide>() * seen;
        self.bodies.iter().find(|body| {
            let between = light.motion.origin.since::<Wide>(body.motion.origin);
            let at = body.motion.world_from_rest::<Wide>().inverse() * (between + seen);
            body.mesh.winding(at.rounded().xyz()).abs() > 1.0 - 1e-6
        })
    }

    /// How many triangles its meshes have, those of several bodies as often.
    pub fn triangle_count(&self) -> usize {
        self.bodies.iter().map(|body| body.mesh.triangles.len()).sum()
    }

    /// Sets how many seconds of their clips pass in a unit of time, for all that is animated; 0 stops it.
    pub fn set_animation_rate(&mut self, rate: f64) {
        for clip in self.bodies.iter_mut().filter_map(|b| b.clip.as_mut()) {
            std::sync::Arc::make_mut(clip).rate = rate;
        }
    }

    /// Checks that animations are slow against light.
    ///
    /// # Errors
    /// Naming the first that is not; see [`Clip`].
    pub fn check_animations(&self) -> Result<(), TooFast> {
        for body in &self.bodies {
            if let (Some(clip), Some(bounds)) = (&body.clip, body.mesh.bounds()) {
                let speed = clip.greatest_speed(bounds);
                if speed > Clip::FASTEST || speed.is_nan() {
                    return Err(TooFast { body: body.name.clone(), speed });
                }
            }
        }
        Ok(())
    }

    /// Sets the speed of whatever moves: the bodies in motion; if none is, the camera in motion; if nothing
    /// moves at all, the first body.
    ///
    /// # Errors
    /// If the speed is none.
    pub fn set_speed(&mut self, speed: Speed) -> Result<(), CelerityError> {
        let any_body = self.bodies.iter().any(|b| b.motion.celerity.moves());
        let mut motions: Vec<&mut Celerity> = if any_body {
            self.bodies.iter_mut().map(|b| &mut b.motion.celerity).filter(|c| c.moves()).collect()
        } else if self.view.celerity.moves() {
            vec![&mut self.view.celerity]
        } else {
            self.bodies.iter_mut().take(1).map(|b| &mut b.motion.celerity).collect()
        };
        for celerity in &mut motions {
            **celerity = match speed {
                Speed::Velocity(velocity) => velocity,
                Speed::Along(magnitude) => {
                    Celerity::new(celerity.direction().unwrap_or(glam::DVec3::X) * magnitude)?
                }
            };
        }
        Ok(())
    }
}
