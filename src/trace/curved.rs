//! Tracing through curved spacetime.

use super::chord::Goal;
use super::tile::Count;
use super::tree::Part;
use crate::film::{FAILED, FLAGGED, HOLE, IMPOSSIBLE, Rows};
use crate::light::{Facet, Point, SeenShading};
use crate::scene::{EmissionLaw, Eye, Lens, Sky};
use glam::{DVec2, DVec3};
use terrell_geodesic::{End, Event, FourVector, LocalFrame, Ray, Spacetime, World};

/// What is to be drawn.
pub(super) struct Job<'a, S> {
    pub space: &'a S,
    pub goals: &'a [Goal],
    pub eye: &'a Eye,
    pub lens: &'a Lens,
    pub sky: Option<&'a Sky>,
    pub shading: &'a SeenShading<'a>,
    /// Of the samples, in pixels from a pixel's corner.
    pub samples: &'a [[f64; 2]],
}

/// What a ray comes to.
#[derive(Clone, Copy)]
enum Outcome {
    /// The lens sees nothing there, or the ray left what is described.
    Nothing,
    Sky {
        direction: DVec3,
        doppler: f64,
    },
    Hole,
    Failed,
    Impossible,
    Body(Hit),
}

#[derive(Clone, Copy)]
struct Hit {
    goal: usize,
    leaf: usize,
    event: Event<World>,
    k: FourVector<World>,
    /// In the body's coordinates.
    place: DVec3,
    doppler: f64,
    distance: f64,
}

/// What one thread draws bands in, used again for the next.
#[derive(Default)]
pub(super) struct Band {
    outcomes: Vec<Outcome>,
    stack: Vec<Part>,
}

impl Band {
    /// Draws so many rows of the film from `top` on.
    pub fn draw<S: Spacetime>(&mut self, job: &Job<'_, S>, top: u32, rows: &mut Rows<'_>) -> Count {
        let width = job.lens.width();
        let height = (rows.body.len() / width as usize) as u32;
        let mut count = Count::default();
        let weight = 1.0 / job.samples.len() as f32;
        for (number, sample) in job.samples.iter().enumerate() {
            self.outcomes.clear();
            for y in top..top + height {
                for x in 0..width {
                    let at = DVec2::new(f64::from(x), f64::from(y)) + DVec2::from_array(*sample);
                    let outcome = self.follow(job, at, &mut count);
                    self.outcomes.push(outcome);
                }
            }
            for pixel in 0..self.outcomes.len() {
                self.develop(job, pixel, weight, number == 0, rows);
            }
        }
        count
    }

    /// Follows a ray to what it meets first.
    fn follow<S: Spacetime>(&mut self, job: &Job<'_, S>, at: DVec2, count: &mut Count) -> Outcome {
        let Some((start, k)) = job.eye.ray(job.lens, at) else { return Outcome::Nothing };
        count.primary += 1;
        let mut ray = job.space.ray(start, k);
        while let Some(piece) = ray.next() {
            let mut nearest = f64::INFINITY;
            let mut found = None;
            for (index, goal) in job.goals.iter().enumerate() {
                if let Some(meeting) = goal.meet(&piece, &ray, nearest, &mut self.stack) {
                    nearest = meeting.s;
                    found = Some((index, meeting));
                }
            }
            let Some((index, meeting)) = found else { continue };
            let goal = &job.goals[index];
            let (event, k) = ray.at(meeting.s);
            // D is a quotient of products with both four-velocities; that with the observer's is 1.
            let along = goal.along();
            let norm = job.space.product(event, along, along);
            let doppler = (-norm).sqrt() / job.space.product(event, k, along);
            if !(norm < 0.0 && doppler > 0.0 && doppler.is_finite()) {
                count.impossible += 1;
                return Outcome::Impossible;
            }
            count.bodies += 1;
            return Outcome::Body(Hit {
                goal: index,
                leaf: meeting.leaf,
                event,
                k,
                place: goal.place(event),
                doppler,
                distance: job.eye.distance(start, meeting.s),
            });
        }
        match ray.end() {
            Some(End::Sky { wave_vector }) => {
                count.sky += 1;
                let direction = wave_vector.xyz().normalize_or(DVec3::Z);
                Outcome::Sky { direction, doppler: 1.0 / wave_vector.t.abs() }
            }
            Some(End::Horizon) => {
                count.hole += 1;
                Outcome::Hole
            }
            Some(End::Edge) => Outcome::Nothing,
            end => {
                match end {
                    Some(End::Drift) => count.drifted += 1,
                    Some(End::NotANumber | End::SingularMetric) => count.singular += 1,
                    _ => count.step_limit += 1,
                }
                Outcome::Failed
            }
        }
    }

    /// Looks up what is seen in a pixel.
    fn develop<S: Spacetime>(
        &self,
        job: &Job<'_, S>,
        pixel: usize,
        weight: f32,
        centre: bool,
        rows: &mut Rows<'_>,
    ) {
        let (light, body, face, doppler, distance) = match &self.outcomes[pixel] {
            Outcome::Nothing => return,
            Outcome::Hole => ([0.0; 3], HOLE, -1, 0.0, 0.0),
            Outcome::Failed => (FLAGGED, FAILED, -1, 0.0, 0.0),
            Outcome::Impossible => (FLAGGED, IMPOSSIBLE, -1, 0.0, 0.0),
            Outcome::Sky { direction, doppler } => {
                let steps = || {
                    self.steps(job, pixel, weight, *direction, |other| match other {
                        Outcome::Sky { direction, .. } => Some(*direction),
                        _ => None,
                    })
                };
                let color = job.sky.map_or([0.0; 3], |sky| sky.color(*direction, steps()));
                let doppler = if job.sky.is_some() { *doppler } else { 0.0 };
                (job.shading.sky(doppler, color), -1, -1, doppler, 0.0)
            }
            Outcome::Body(hit) => {
                let goal = &job.goals[hit.goal];
                let face = goal.tree.leaf(hit.leaf as u32).face;
                let light = self.shade(job, pixel, weight, hit, face as usize);
                (light, goal.body as i32, face as i32, hit.doppler, hit.distance)
            }
        };
        let color = &mut rows.color[pixel];
        *color = [0, 1, 2].map(|c| color[c] + weight * light[c]);
        if centre {
            rows.body[pixel] = body;
            rows.face[pixel] = face;
            rows.doppler[pixel] = doppler as f32;
            rows.distance[pixel] = distance as f32;
        }
    }

    /// Light of a point of a surface.
    fn shade<S: Spacetime>(
        &self,
        job: &Job<'_, S>,
        pixel: usize,
        weight: f32,
        hit: &Hit,
        face: usize,
    ) -> [f32; 3] {
        let goal = &job.goals[hit.goal];
        let facet = Facet::new(&goal.mesh, face, goal.mesh.corners(face));
        let moves = || {
            self.steps(job, pixel, weight, hit.place, |other| match other {
                Outcome::Body(other) if other.goal == hit.goal => Some(other.place),
                _ => None,
            })
        };
        let material = goal.mesh.material_index(face);
        let law = goal.mesh.material_of(face).map_or(EmissionLaw::default(), |m| m.law);
        let point = || match law {
            EmissionLaw::Isotropic => None,
            _ => local_point(job.space, goal, hit, &facet),
        };
        job.shading.radiance(
            goal.body,
            material,
            hit.doppler,
            || facet.colors_moving(hit.place, moves),
            || point().unwrap_or_else(|| facet.seen_along(hit.place, goal.direction(hit.k))),
        )
    }

    /// The ways to what the pixels to the right and below see, as far as `same` says it is of the same kind: from what those
    /// on the other side see, where it is not; none where neither is.
    fn steps<S: Spacetime>(
        &self,
        job: &Job<'_, S>,
        pixel: usize,
        weight: f32,
        here: DVec3,
        same: impl Fn(&Outcome) -> Option<DVec3>,
    ) -> [DVec3; 2] {
        let width = job.lens.width() as usize;
        // Each of many samples stands for a part of the pixel.
        let spread = f64::from(weight.sqrt());
        let column = pixel % width;
        let next = |after: bool, before: bool, stride: usize| {
            let after = after.then(|| same(&self.outcomes[pixel + stride])).flatten().map(|p| p - here);
            let before = before.then(|| same(&self.outcomes[pixel - stride])).flatten().map(|p| here - p);
            // Where both are there, the shorter: the other may be on the far side of an edge.
            let step = match (after, before) {
                (Some(a), Some(b)) if b.length_squared() < a.length_squared() => b,
                (Some(a), _) => a,
                (None, b) => b.unwrap_or_default(),
            };
            step * spread
        };
        [
            next(column + 1 < width, column > 0, 1),
            next(pixel + width < self.outcomes.len(), pixel >= width, width),
        ]
    }
}

/// The point with its normal and the way the light left, in a frame of the surface's own: angles are right there.
fn local_point<S: Spacetime>(space: &S, goal: &Goal, hit: &Hit, facet: &Facet<'_>) -> Option<Point> {
    let along = goal.along();
    let velocity = along * (1.0 / (-space.product(hit.event, along, along)).sqrt());
    let frame = LocalFrame::new(space, hit.event, velocity, DVec3::X, DVec3::Z).ok()?;
    let [_, right, up, forward] = frame.legs();
    // A normal is a covector: its component along a leg is that of the leg along it.
    let own = |v: DVec3| {
        let component = |leg| v.dot(goal.direction(leg));
        DVec3::new(component(right), component(up), component(forward))
    };
    let sight = frame.components(space, hit.k).xyz();
    let at_rest = facet.seen_along(hit.place, goal.direction(hit.k));
    Some(Point::new(sight, own(facet.normal()), own(at_rest.normal)))
}
