use super::canvas::{Canvas, LIGHT};
use super::{number, text};
use crate::relativity::ApparentMap;
use crate::scene::{Camera, Scene};
use glam::DVec2;

/// Text for a picture, with places for what the picture shows.
///
/// | | |
/// |---|---|
/// | `{beta}` | β of the body that moves fastest relative to the camera, so that 1 − β keeps two digits |
/// | `{gamma}` | its Lorentz factor, four digits |
/// | `{time}` | world time of the camera's event, four digits |
/// | `{scene}` | the scene's name |
/// | `{{`, `}}` | a brace |
///
/// `{time:.2}` has two decimals, always, for films; so do `{beta:.N}` and `{gamma:.N}`.
#[derive(Clone, Debug, PartialEq)]
pub struct Caption(Vec<Part>);

#[derive(Clone, Debug, PartialEq)]
enum Part {
    Text(String),
    Place(Place, Option<usize>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Beta,
    Gamma,
    Time,
    Scene,
}

const PLACES: [(&str, Place); 4] =
    [("beta", Place::Beta), ("gamma", Place::Gamma), ("time", Place::Time), ("scene", Place::Scene)];

/// More decimals than a number has.
const MOST_DECIMALS: usize = 17;

/// Why a caption cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CaptionError {
    /// A name in braces that stands for nothing.
    #[error(
        "caption: {{{0}}} stands for nothing; there is {{beta}}, {{gamma}}, {{time}} (with decimals: {{time:.2}}) and {{scene}}, and {{{{ for a brace"
    )]
    Unknown(String),
    /// A brace without its other.
    #[error("caption: a '{0}' without its other; write {0}{0} for a brace")]
    Brace(char),
    /// The font has no such character.
    #[error("caption: the font (DejaVu Sans) has no '{0}'")]
    NoGlyph(char),
}

impl Caption {
    /// Reads a caption; line ends begin new lines.
    ///
    /// # Errors
    /// On unknown places, single braces and characters the font does not have.
    pub fn parse(text: &str) -> Result<Self, CaptionError> {
        let mut parts = Vec::new();
        let mut plain = String::new();
        let mut rest = text.chars().peekable();
        while let Some(c) = rest.next() {
            match c {
                '{' | '}' if rest.peek() == Some(&c) => {
                    rest.next();
                    plain.push(c);
                }
                '{' => {
                    let mut name = String::new();
                    loop {
                        match rest.next() {
                            Some('}') => break,
                            Some(c) if c != '{' => name.push(c),
                            _ => return Err(CaptionError::Brace('{')),
                        }
                    }
                    parts.push(Part::Text(std::mem::take(&mut plain)));
                    parts.push(place(&name).ok_or(CaptionError::Unknown(name))?);
                }
                '}' => return Err(CaptionError::Brace('}')),
                '\r' => {}
                '\t' => plain.push(' '),
                c => plain.push(c),
            }
        }
        parts.push(Part::Text(plain));
        parts.retain(|part| *part != Part::Text(String::new()));
        let without = parts.iter().find_map(|part| match part {
            Part::Text(plain) => text::without_glyph(plain),
            Part::Place(..) => None,
        });
        without.map_or(Ok(Self(parts)), |c| Err(CaptionError::NoGlyph(c)))
    }

    /// The text for a scene as a camera sees it.
    pub fn text(&self, scene: &Scene, camera: &Camera) -> String {
        let fastest = || {
            let speeds = scene.bodies.iter().map(|b| ApparentMap::new(&b.motion, &camera.observer));
            speeds
                .map(|map| (map.speed(), map.gamma()))
                .fold((0.0, 1.0), |a, b| if b.0 > a.0 { b } else { a })
        };
        let written = |part: &Part| match *part {
            Part::Text(ref text) => text.clone(),
            Part::Place(Place::Scene, _) => scene.name.clone(),
            Part::Place(Place::Beta, decimals) => beta(fastest(), decimals),
            Part::Place(Place::Gamma, decimals) => plain(fastest().1, decimals),
            Part::Place(Place::Time, decimals) => plain(camera.observer.event().t(), decimals),
        };
        self.0.iter().map(written).collect()
    }
}

fn place(name: &str) -> Option<Part> {
    let (name, decimals) = match name.split_once(":.") {
        Some((name, decimals)) => (name, Some(decimals.parse().ok().filter(|d| *d <= MOST_DECIMALS)?)),
        None => (name, None),
    };
    let (_, place) = PLACES.iter().find(|(known, _)| *known == name)?;
    (decimals.is_none() || *place != Place::Scene).then_some(Part::Place(*place, decimals))
}

fn plain(value: f64, decimals: Option<usize>) -> String {
    decimals.map_or_else(|| number::significant(value, 4), |decimals| number::fixed(value, decimals))
}

/// β of a celerity and its γ.
fn beta((speed, gamma): (f64, f64), decimals: Option<usize>) -> String {
    let beta = speed / gamma;
    if let Some(decimals) = decimals {
        return number::fixed(beta, decimals);
    }
    let missing = 1.0 / (gamma * (gamma + speed));
    if missing < 1e-7 {
        return format!("1 − {}", number::significant(missing, 2));
    }
    let decimals = 2 - missing.log10().floor() as i32;
    number::trimmed(&number::fixed(beta, decimals.max(3) as usize)).to_owned()
}

/// Lines at the lower left, no wider than `room` pixels; letters become smaller where they would be.
pub(super) fn draw(canvas: &mut Canvas, caption: &str, room: f64) {
    let lines: Vec<&str> = caption.trim_end_matches('\n').split('\n').collect();
    const LEADING: f64 = 1.3;
    let (em, margin) = (canvas.em(), canvas.margin());
    let widest = lines.iter().map(|line| text::width(line, em)).fold(0.0, f64::max);
    let high = (canvas.height() - 2.0 * margin).max(1.0) / (LEADING * em * lines.len() as f64);
    let em = em * (room.max(1.0) / widest.max(1.0)).min(high).min(1.0);
    for (below, line) in lines.iter().rev().enumerate() {
        // Room for what hangs below the line.
        let y = canvas.height() - margin - 0.24 * em - LEADING * em * below as f64;
        text::write(canvas, line, em, DVec2::new(margin, y), LIGHT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesic::Celerity;
    use crate::scene::builtin_scenes;

    fn cube(gamma: f64) -> (Scene, Camera) {
        let mut scene = builtin_scenes()[0].scene();
        scene.view.nearest = None;
        scene.bodies[0].motion.celerity = Celerity::from_gamma(gamma, glam::DVec3::X).unwrap();
        scene.view.set_time(-0.125).unwrap();
        let camera = scene.camera().unwrap();
        (scene, camera)
    }

    #[test]
    fn places_are_filled() {
        let caption = Caption::parse("{scene}: β = {beta}, γ = {gamma}\n{{t}} = {time} {time:.1}").unwrap();
        let of = |gamma| {
            let (scene, camera) = cube(gamma);
            caption.text(&scene, &camera)
        };
        assert_eq!(of(1.25), "cube: β = 0.6, γ = 1.25\n{t} = −0.125 −0.1");
        assert!(of(1.0).starts_with("cube: β = 0, γ = 1\n"));
        assert!(of(1e3).contains("β = 0.9999995, γ = 1000"), "{}", of(1e3));
        assert!(of(1e9).contains("β = 1 − 5·10⁻¹⁹, γ = 10⁹"), "{}", of(1e9));
        let (scene, camera) = cube(1.25);
        assert_eq!(Caption::parse("{beta:.3}{gamma:.0}").unwrap().text(&scene, &camera), "0.6001");
    }

    #[test]
    fn what_stands_for_nothing_is_named() {
        for (text, error) in [
            ("{speed}", CaptionError::Unknown("speed".into())),
            ("{}", CaptionError::Unknown(String::new())),
            ("{time:.99}", CaptionError::Unknown("time:.99".into())),
            ("{scene:.2}", CaptionError::Unknown("scene:.2".into())),
            ("a {beta", CaptionError::Brace('{')),
            ("a {be{ta}", CaptionError::Brace('{')),
            ("a } b", CaptionError::Brace('}')),
            ("v = 光", CaptionError::NoGlyph('光')),
        ] {
            assert_eq!(Caption::parse(text), Err(error), "{text}");
        }
        assert!(
            CaptionError::Unknown("v".into()).to_string().contains("{v} stands for nothing; there is {beta}")
        );
        assert!(CaptionError::Brace('{').to_string().contains("write {{ for a brace"));
    }
}
