use super::{Clip, Mesh};
use crate::relativity::Motion;
use glam::DVec3;
use std::sync::Arc;
use terrell_geodesic::Tetrad;

/// A mesh in uniform motion.
#[derive(Clone, Debug)]
pub struct Body {
    /// What the scene calls it.
    pub name: String,
    /// At rest, placed by scale and rotation; of an animated body, before its clip poses it.
    pub mesh: Arc<Mesh>,
    /// How it moves.
    pub motion: Motion,
    /// How it is animated within its rest frame, if it is.
    pub clip: Option<Arc<Clip>>,
}

impl Body {
    /// A mesh in motion, not animated.
    pub fn new(name: &str, mesh: impl Into<Arc<Mesh>>, motion: Motion) -> Self {
        Self { name: name.to_owned(), mesh: mesh.into(), motion, clip: None }
    }

    /// The mesh in the rest frame as an observer sees it: of an animated body, in the pose it had when the light
    /// now seen left its middle.
    pub fn mesh_seen(&self, observer: &Tetrad) -> Arc<Mesh> {
        let Some(clip) = &self.clip else { return self.mesh.clone() };
        let rest_from_world = self.motion.world_from_rest::<f64>().inverse();
        let observer_rest = rest_from_world * observer.event().since(self.motion.origin);
        let [x, y, z] = observer_rest.space;
        let (now, from) = (observer_rest.t, DVec3::new(x, y, z));
        let middle = self.mesh.centre();
        // What moves at a tenth of c at most gains a digit each time.
        let mut sent = now;
        for _ in 0..20 {
            sent = now - clip.pose(sent).transform_point3(middle).distance(from);
        }
        Arc::new(Mesh::clone(&self.mesh).placed(&clip.pose(sent)))
    }

    /// The middle of the body in its rest frame; of an animated one, as it is at rest-frame time 0.
    pub fn centre(&self) -> DVec3 {
        let middle = self.mesh.centre();
        self.clip.as_ref().map_or(middle, |clip| clip.pose(0.0).transform_point3(middle))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Between, Joint, Track};
    use super::*;
    use terrell_geodesic::{Celerity, Event};

    /// A ball that slides along z at 0.05 in its rest frame, its body passing at 0.8 along x: the pose seen is
    /// that of the event on the past light cone, found here in world coordinates by bisection.
    #[test]
    fn the_pose_is_that_of_the_light_seen() {
        let slide = Track::new(vec![0.0, 100.0], vec![DVec3::ZERO, DVec3::Z * 5.0], Between::Linear).unwrap();
        let joint = Joint::Moving {
            translation: slide,
            rotation: Track::fixed(glam::DQuat::IDENTITY),
            scale: Track::fixed(DVec3::ONE),
        };
        let mut ball = super::super::shapes::sphere(1);
        ball.paint_as_clay();
        let celerity = Celerity::from_beta(DVec3::X * 0.8).unwrap();
        let motion = crate::relativity::Motion { celerity, origin: Event::new(-20.0, 1.0, 2.0, 0.0) };
        let body = Body {
            name: "ball".into(),
            mesh: Arc::new(ball),
            motion,
            clip: Some(Arc::new(Clip::new(vec![joint]))),
        };
        let observer = Tetrad::of_world(Event::new(30.0, 10.0, -4.0, 1.0));
        let seen = body.mesh_seen(&observer).centre().z / 0.05;
        let lateness = |t_rest: f64| {
            let rest = terrell_geodesic::FourVector::from_parts(t_rest, DVec3::Z * (0.05 * t_rest));
            let event = motion.origin + motion.world_from_rest::<f64>() * rest;
            let way = (observer.event().position() - event.position()).length();
            event.t() + way - observer.event().t()
        };
        let (mut early, mut late) = (0.0, 100.0);
        for _ in 0..60 {
            let middle = 0.5 * (early + late);
            if lateness(middle) > 0.0 { late = middle } else { early = middle }
        }
        assert!((seen - early).abs() < 1e-9, "{seen} {early}");
    }
}
