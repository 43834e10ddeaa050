//! What is to be seen of a scene, body by body, told before it is drawn.

use crate::color::Coloring;
use crate::drawing::number::significant;
use crate::light::has_shadows;
use crate::plan::{cheapest, has_reflections};
use crate::relativity::ApparentMap;
use crate::render::{Options, RenderError, render};
use crate::scene::{Body, Camera, Scene};
use glam::DVec3;
use std::fmt::{Display, Formatter};
use terrell_geodesic::Tetrad;

/// What a camera sees of every body, and why it looks so.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlook {
    /// World time of the picture.
    pub time: f64,
    /// In the order of the scene's bodies.
    pub prospects: Vec<Prospect>,
    /// What there is in the scene that makes it look other than it is.
    pub remarks: Vec<String>,
}

/// What is seen of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Prospect {
    /// The body's.
    pub name: String,
    /// γβ of its motion relative to the camera; none in curved spacetime, where they are apart.
    pub celerity: Option<f64>,
    /// The part of the picture it takes, by pixels.
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
    /// How long its light was on the way then, by the camera's clock; so far away it is seen.
    pub delay: f64,
    /// Doppler factor there, 1/γ; none if the body flies straight at the camera.
    pub doppler: Option<f64>,
    /// By how much it seems turned then, in degrees: arcsin β (Nollert et al. 2000, section 2.1; Terrell 1959). None for
    /// bodies that are large beside their distance, which look otherwise.
    pub turn_deg: Option<f64>,
}

/// Pixels across, at most, of the pictures by which it is told.
const ACROSS: u32 = 1280;

/// The same in curved spacetime, where rays take their time.
const ACROSS_CURVED: u32 = 128;

/// γβ below which nothing is seen to pass: what is left of it is rounding.
const STILL: f64 = 1e-9;

impl Outlook {
    /// Of a scene before a camera, as a picture by its cheapest method shows it; a smaller one, if it is large.
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
                celerity: (!curved).then(|| ApparentMap::new(&body.motion, &camera.observer).speed()),
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
                if prospect.celerity.is_some_and(|celerity| celerity > STILL) {
                    let observer = body.motion.seen_abreast(body.centre(), &camera.observer).ok();
                    prospect.passage = observer.map(|observer| passage(body, &observer));
                }
            }
        }
        let remarks = remarks(scene, camera, &prospects);
        Ok(Self { time: camera.observer.event().t(), prospects, remarks })
    }
}

/// How a body is seen when its middle is abreast of this observer.
fn passage(body: &Body, observer: &Tetrad) -> Passage {
    let map = ApparentMap::new(&body.motion, observer);
    let delay = map.see(body.centre()).distance;
    let radius = body.mesh.bounds().map_or(0.0, |(low, high)| 0.5 * (high - low).length());
    Passage {
        time: observer.event().t(),
        delay,
        doppler: (delay > 1e-9 * radius).then(|| 1.0 / map.gamma()),
        // β is the sine of what γβ is the tangent of.
        turn_deg: (delay > 2.0 * radius).then(|| map.speed().atan().to_degrees()),
    }
}

fn remarks(scene: &Scene, camera: &Camera, prospects: &[Prospect]) -> Vec<String> {
    let curved = scene.spacetime.is_curved();
    let moving = prospects.iter().any(|prospect| prospect.passage.is_some());
    let mut remarks = Vec::new();
    let mut say = |remark: &str| remarks.push(remark.to_owned());
    if moving {
        say("light of far parts left earlier, when they were elsewhere: seen is that, not contraction alone");
        say("lengths along the motion are seen D times as long");
        say("a flat spectrum is seen D³ times as bright, all wavelengths together D⁴ times");
        say("D = 1 where cos θ = −(1 − 1/γ)/β, θ from the motion to the line of sight: before it is abreast");
    }
    for (body, prospect) in scene.bodies.iter().zip(prospects) {
        let eye = ApparentMap::new(&body.motion, &camera.observer).observer_rest();
        let is_within = |(low, high): (DVec3, DVec3)| eye.cmpge(low).all() && eye.cmple(high).all();
        if prospect.passage.is_some() && body.mesh.bounds().is_some_and(is_within) {
            let name = &body.name;
            say(&format!(
                "the camera is amid '{name}': what is beside it, and some of what is behind, is seen ahead"
            ));
        }
    }
    let octaves = |pick: fn(f64, f64) -> f64| {
        let ends = prospects.iter().filter_map(|p| p.doppler).flatten();
        ends.reduce(pick).map(|d| 3.0 * d.log2())
    };
    if let (Some(least), Some(greatest)) = (octaves(f64::min), octaves(f64::max)) {
        if greatest < -6.0 {
            say(&format!(
                "all of it is at least {:.0} EV dimmer than at rest: --color geometry shows shapes",
                -greatest
            ));
        } else if greatest - least > 8.0 {
            let span = greatest - least;
            say(&format!(
                "brightness spans {span:.0} EV more than at rest, which no screen has: --tone log shows it all"
            ));
        }
    }
    if has_shadows(scene) && moving {
        say("a shadow is of where a body was when the light passed it, and is seen later still");
    }
    if has_reflections(scene) && moving {
        say("light from surface to surface is shifted at every step, by their relative motion");
    }
    if scene.sky.is_some() && !curved && scene.view.celerity.moves() {
        say("the camera moves: the sky is drawn together ahead of it, and bluer and brighter there");
    }
    if curved {
        say("light is bent: what is behind the hole is seen around it, and more than once");
        say(
            "D is gravity's and motion's together; bodies pass in the scene's coordinates, not once as they are seen",
        );
    }
    remarks
}

/// Digits that tell numbers of any size apart.
fn told(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:.3e}")
    } else {
        significant(value, 4)
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
        let Some(doppler) = doppler else {
            return write!(f, "its middle flies straight at the camera, and is there at t = {}", told(*time));
        };
        let (time, delay, doppler) = (told(*time), told(*delay), told(*doppler));
        write!(f, "its middle is seen abreast at t = {time}, by light {delay} old, with D = {doppler}")?;
        turn_deg.map_or(Ok(()), |turn| write!(f, "\nit seems turned by {turn:.1}° then"))
    }
}

impl Display for Outlook {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "seen at world time {}", told(self.time))?;
        // Of many bodies the first ones.
        const MOST: usize = 12;
        for prospect in self.prospects.iter().take(MOST) {
            let moves = match prospect.celerity {
                None => String::new(),
                Some(u) if u <= STILL => "at rest beside the camera\n".to_owned(),
                Some(u) if u < 100.0 => {
                    let gamma = u.hypot(1.0);
                    format!("{} c, γ {}\n", significant(u / gamma, 5), told(gamma))
                }
                Some(u) => format!("γ {}\n", told(u.hypot(1.0))),
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
        assert!((cube.celerity.unwrap() / (0.9 * gamma) - 1.0).abs() < 1e-12);
        let passage = cube.passage.unwrap();
        // The scene's own moment is that at which the cube is seen abreast, D = 1/γ.
        assert!((passage.time - outlook.time).abs() < 1e-9, "{passage:?}");
        let doppler = passage.doppler.unwrap();
        assert!((doppler * gamma - 1.0).abs() < 1e-9);
        assert!((passage.turn_deg.unwrap() - 0.9f64.asin().to_degrees()).abs() < 1e-9);
        let [least, greatest] = cube.doppler.unwrap();
        assert!(least < doppler && doppler < greatest);
        let [near, far] = cube.distance.unwrap();
        assert!(near < passage.delay && passage.delay < far);
        // Of side 1 and 3 away it is as wide as one turned by arcsin β; what of it is nearer is a little larger.
        let height = 6.0 * 18f64.to_radians().tan();
        let far = (0.9 + 1.0 / gamma) / (height * height * 16.0 / 9.0);
        assert!((1.0..1.2).contains(&(cube.part / far)), "{} {far}", cube.part);
    }

    #[test]
    fn what_flies_at_the_camera_or_with_it_is_not_seen_to_pass() {
        let toml = "
            [camera]
            velocity = [0, 0.8, 0]
            [[body]]
            name = 'with'
            mesh = 'cube'
            position = [0, 5, 0]
            velocity = [0, 0.8, 0]
            [[body]]
            name = 'at'
            mesh = 'cube'
            position = [0, 20, 0]
            [[body]]
            name = 'around'
            mesh = 'gate'
            position = [0, 3, 0]";
        let scene = crate::scene::parse_scene(toml, std::path::Path::new("a.toml")).unwrap();
        let outlook = Outlook::new(&scene, &scene.camera().unwrap()).unwrap();
        let [with, at, around] = &outlook.prospects[..] else { panic!("{outlook:?}") };
        assert!(with.celerity.unwrap() < STILL && with.passage.is_none());
        // 20 at 0.8.
        let passage = at.passage.unwrap();
        assert!(
            (passage.time - 25.0).abs() < 1e-9 && passage.doppler.is_none() && passage.turn_deg.is_none()
        );
        assert!(around.passage.unwrap().turn_deg.is_none());
        let text = outlook.to_string();
        assert!(
            text.contains("flies straight at") && !text.contains("NaN") && !text.contains("inf"),
            "{text}"
        );
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
