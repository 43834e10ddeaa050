//! What is to be seen of a scene, body by body, told before it is drawn.

use crate::color::Coloring;
use crate::light::has_shadows;
use crate::plan::{cheapest, has_reflections};
use crate::relativity::ApparentMap;
use crate::render::{Options, RenderError, render};
use crate::scene::{Camera, Scene};
use std::fmt::{Display, Formatter};

/// What a camera sees of every body, and why it looks so.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlook {
    /// World time of the picture.
    pub time: f64,
    /// In the order of the scene's bodies.
    pub prospects: Vec<Prospect>,
    /// What there is in the scene that makes it look other than it is.
    pub remarks: Vec<&'static str>,
}

/// What is seen of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Prospect {
    /// The body's.
    pub name: String,
    /// Of its motion relative to the camera; 1 at rest, none in curved spacetime, where they are apart.
    pub gamma: Option<f64>,
    /// The part of the picture it takes, by pixels of a small one.
    pub part: f64,
    /// Least and greatest Doppler factor in these; none if there are none.
    pub doppler: Option<[f64; 2]>,
    /// Least and greatest distance, as apparent positions have it; in curved spacetime see [`Film::distance`].
    ///
    /// [`Film::distance`]: crate::film::Film::distance
    pub distance: Option<[f64; 2]>,
    /// When it passes; none in curved spacetime, or if it never does.
    pub passage: Option<Passage>,
}

/// A body's middle, seen at right angles to its motion relative to the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// World time of the picture that shows it.
    pub time: f64,
    /// How long its light was on the way then, by the camera's clock.
    pub delay: f64,
    /// Doppler factor there: 1/γ.
    pub doppler: f64,
    /// By how much a body that is small beside its distance seems turned then, in degrees: arcsin β (Nollert et al. 2000,
    /// section 2.1; Terrell 1959).
    pub turn_deg: f64,
}

/// Pixels across of the pictures by which it is told.
const ACROSS: u32 = 320;

/// The same in curved spacetime, where rays take their time.
const ACROSS_CURVED: u32 = 128;

impl Outlook {
    /// Of a scene before a camera, as a small picture by its cheapest method shows it.
    ///
    /// # Errors
    /// As [`render`].
    pub fn new(scene: &Scene, camera: &Camera) -> Result<Self, RenderError> {
        let (curved, coloring) = (scene.spacetime.is_curved(), Coloring::Doppler);
        let lens = camera.lens.within(if curved { ACROSS_CURVED } else { ACROSS });
        let options = Options { coloring, method: cheapest(scene, coloring).0, ..Options::default() };
        let (film, _) = render(scene, &Camera { lens, ..*camera }, &options, |_| ())?;
        let mut prospects: Vec<Prospect> = scene
            .bodies
            .iter()
            .map(|body| Prospect {
                name: body.name.clone(),
                gamma: (!curved).then(|| body.motion.celerity.relative_gamma(&camera.observer.celerity())),
                part: 0.0,
                doppler: None,
                distance: None,
                passage: None,
            })
            .collect();
        let pixels = film.body.len() as f64;
        for (i, body) in film.body.iter().enumerate() {
            let Some(prospect) = usize::try_from(*body).ok().and_then(|body| prospects.get_mut(body)) else {
                continue;
            };
            prospect.part += 1.0 / pixels;
            for (range, value) in
                [(&mut prospect.doppler, film.doppler[i]), (&mut prospect.distance, film.distance[i])]
            {
                let value = f64::from(value);
                let [least, greatest] = range.get_or_insert([value; 2]);
                (*least, *greatest) = (least.min(value), greatest.max(value));
            }
        }
        if !curved {
            for (prospect, body) in prospects.iter_mut().zip(&scene.bodies) {
                // One that hardly moves has no right angle to tell.
                let passed = body.motion.seen_passed(body.centre(), &camera.observer, 0.0).ok();
                prospect.passage = passed.map(|observer| {
                    let map = ApparentMap::new(&body.motion, &observer);
                    let sight = map.see(body.centre());
                    Passage {
                        time: observer.event().t(),
                        delay: sight.distance,
                        doppler: sight.doppler,
                        // β = sin of what γβ is the tangent of.
                        turn_deg: map.speed().atan().to_degrees(),
                    }
                });
            }
        }
        let remarks = remarks(scene, &prospects);
        Ok(Self { time: camera.observer.event().t(), prospects, remarks })
    }
}

fn remarks(scene: &Scene, prospects: &[Prospect]) -> Vec<&'static str> {
    let curved = scene.spacetime.is_curved();
    let moving = !curved && prospects.iter().any(|prospect| prospect.passage.is_some());
    let mut remarks = Vec::new();
    if moving {
        remarks.push("light of far parts left earlier, when they were elsewhere: that, and not contraction alone, is what is seen");
        remarks.push("lengths along the motion are seen D times as long; a flat spectrum D³ times as bright, all wavelengths together D⁴");
        remarks.push(
            "D = 1 where cos θ = −(1 − 1/γ)/β, θ from the motion to the line of sight: before it is abreast",
        );
    }
    if has_shadows(scene) && moving {
        remarks.push(
            "a shadow is of where a body was when the light passed it, and is seen when its own light is here",
        );
    }
    if has_reflections(scene) && moving {
        remarks.push(
            "light from surface to surface is shifted at every step, by their motion relative to each other",
        );
    }
    if scene.sky.is_some() && scene.view.celerity.moves() {
        remarks.push("the camera moves: the sky is drawn together ahead of it, and bluer and brighter there");
    }
    if curved {
        remarks.push(
            "light is bent: what is behind the hole is seen around it, and more than once; D is gravity's and motion's together",
        );
    }
    remarks
}

/// Digits that tell numbers of any size apart.
fn told(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e5).contains(&size) => {
            format!("{value:.*}", (3 - size.log10().floor() as i32).clamp(0, 6) as usize)
        }
        _ => format!("{value:.3e}"),
    }
}

impl Display for Prospect {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let range = |[a, b]: [f64; 2]| match (told(a), told(b)) {
            (a, b) if a == b => a,
            (a, b) => format!("{a} to {b}"),
        };
        match (self.doppler, self.distance) {
            (Some(doppler), Some(distance)) => {
                write!(
                    f,
                    "{:.1} % of the picture, {} away, D {}",
                    100.0 * self.part,
                    range(distance),
                    range(doppler)
                )?;
                let octaves = doppler.map(|d| 3.0 * d.log2());
                let how = match doppler {
                    [least, _] if least > 1.0 + 1e-6 => "bluer and brighter",
                    [_, greatest] if greatest < 1.0 - 1e-6 => "redder and dimmer",
                    [least, greatest] if greatest - least > 2e-6 => {
                        "bluer and brighter on one side, redder and dimmer on the other"
                    }
                    _ => return Ok(()),
                };
                write!(f, "\n{how} (D³: {:+.1} to {:+.1} EV)", octaves[0], octaves[1])
            }
            _ => f.write_str("not in the picture"),
        }
    }
}

impl Display for Passage {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { time, delay, doppler, turn_deg } = self;
        let (time, delay, doppler) = (told(*time), told(*delay), told(*doppler));
        write!(
            f,
            "seen abreast at t = {time}, by light {delay} old, with D = {doppler}, turned by {turn_deg:.1}°"
        )
    }
}

impl Display for Outlook {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "seen at world time {}", told(self.time))?;
        // Of bodies that are many the first ones.
        const MOST: usize = 12;
        for prospect in self.prospects.iter().take(MOST) {
            let moves = match prospect.gamma {
                None => String::new(),
                Some(gamma) if gamma - 1.0 <= 1e-12 => "at rest beside the camera\n".to_owned(),
                Some(gamma) if gamma < 100.0 => {
                    format!("{:.5} c, γ {}\n", (1.0 - 1.0 / (gamma * gamma)).sqrt(), told(gamma))
                }
                Some(gamma) => format!("γ {}\n", told(gamma)),
            };
            let passage = prospect.passage.map(|passage| format!("\n{passage}")).unwrap_or_default();
            let told = format!("{moves}{prospect}{passage}").replace('\n', &format!("\n    {:<12} ", ""));
            writeln!(f, "    {:<12} {told}", prospect.name)?;
        }
        if self.prospects.len() > MOST {
            writeln!(f, "    and {} bodies more, which --json tells", self.prospects.len() - MOST)?;
        }
        if !self.remarks.is_empty() {
            writeln!(f, "why it looks so")?;
        }
        self.remarks.iter().try_for_each(|remark| writeln!(f, "    {remark}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin_scene;

    #[test]
    fn a_passing_cube_is_told_as_closed_forms_have_it() {
        let scene = builtin_scene("cube").unwrap().scene();
        let camera = scene.camera().unwrap();
        let outlook = Outlook::new(&scene, &camera).unwrap();
        let [cube] = &outlook.prospects[..] else { panic!("{outlook:?}") };
        let gamma = 1.0 / 0.19f64.sqrt();
        assert!((cube.gamma.unwrap() / gamma - 1.0).abs() < 1e-12);
        let passage = cube.passage.unwrap();
        // The scene's own moment is that at which the cube is seen abreast, D = 1/γ.
        assert!((passage.time - outlook.time).abs() < 1e-9, "{passage:?}");
        assert!((passage.doppler * gamma - 1.0).abs() < 1e-9);
        assert!((passage.turn_deg - 0.9f64.asin().to_degrees()).abs() < 1e-9);
        let [least, greatest] = cube.doppler.unwrap();
        assert!(least < passage.doppler && passage.doppler < greatest);
        let [near, far] = cube.distance.unwrap();
        assert!(near < passage.delay && passage.delay < far);
        // Of side 1 and 3 away it is as wide as one turned by arcsin β; what of it is nearer is a little larger.
        let height = 6.0 * 18f64.to_radians().tan();
        let far = (0.9 + 1.0 / gamma) / (height * height * 16.0 / 9.0);
        assert!((1.0..1.2).contains(&(cube.part / far)), "{} {far}", cube.part);
    }

    #[test]
    fn all_scenes_are_told() {
        for builtin in crate::scene::builtin_scenes() {
            let mut scene = builtin.scene();
            scene.view.size = [64, 36];
            let outlook = Outlook::new(&scene, &scene.camera().unwrap()).unwrap();
            assert!(outlook.prospects.iter().any(|p| p.part > 0.0), "{}", builtin.name);
            let parts: f64 = outlook.prospects.iter().map(|p| p.part).sum();
            assert!(parts < 1.0 + 1e-9);
            assert!(!outlook.remarks.is_empty() && outlook.to_string().lines().count() > 3);
        }
    }
}
