//! What a scene needs and why, told before anything is drawn.

use crate::color::Coloring;
use crate::light::has_shadows;
use crate::plan::{MOST_GAMMA, Method, greatest_gamma, has_reflections};
use crate::render::{Options, Raster};
use crate::scene::{Camera, Projection, Scene};
use crate::trace::Tracer;
use std::fmt::{Display, Formatter};

/// A plan and its reasons: what is in a scene, as far as it decides, and what speaks for and against each way to draw it.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// How it is drawn.
    pub method: Method,
    /// By what.
    pub device: String,
    /// What there is: what is looked at, and what it is.
    pub contents: Vec<(&'static str, String)>,
    /// Every method, whether it is right, and why it is taken or not.
    pub methods: Vec<Verdict>,
    /// The same of what they are run on.
    pub devices: Vec<Verdict>,
}

/// Of one way to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// What it is called in commands.
    pub name: String,
    /// Whether pictures by it are what is seen: exactly, or to the tolerance.
    pub is_right: bool,
    /// What speaks for or against it.
    pub reason: String,
}

impl Explanation {
    /// Of pictures by these cameras, with these options, method included. A graphics processor is looked for where drawing would
    /// look for one.
    pub fn new(scene: &Scene, cameras: &[&Camera], options: &Options) -> Self {
        let subject = Subject { scene, cameras, options };
        let devices = subject.devices();
        let on_gpu = devices.iter().any(|device| device.name == "wgpu" && device.is_right);
        Self {
            method: options.method,
            device: if on_gpu { "the GPU" } else { "the CPU" }.to_owned(),
            contents: subject.contents(),
            methods: [Method::Exact, Method::Apparent, Method::Trace].map(|m| subject.method(m)).into(),
            devices,
        }
    }
}

/// What is explained.
struct Subject<'a> {
    scene: &'a Scene,
    cameras: &'a [&'a Camera],
    options: &'a Options,
}

impl Subject<'_> {
    fn contents(&self) -> Vec<(&'static str, String)> {
        let Self { scene, cameras, options } = self;
        let triangles = scene.triangle_count();
        let yes = |is: bool, yes: &str, no: &str| if is { yes } else { no }.to_owned();
        let shadows = match (scene.lights.len(), has_shadows(scene)) {
            (0, _) => "none".to_owned(),
            (n, true) => format!("{n}; with shadows"),
            (n, false) => format!("{n}; nothing casts shadows"),
        };
        let size = cameras.first().map_or([0; 2], |c| [c.lens.width(), c.lens.height()]);
        let pictures = match cameras.len() {
            1 => "1 picture".to_owned(),
            n => format!("{n} pictures"),
        };
        vec![
            ("spacetime", scene.spacetime.to_string()),
            ("bodies", format!("{}, {triangles} triangles", scene.bodies.len())),
            ("motion", format!("γ up to {:.5} between bodies and camera", greatest_gamma(scene))),
            ("lights", shadows),
            ("reflections", yes(has_reflections(scene), "surfaces light each other", "none")),
            ("sky", yes(scene.sky.is_some(), "yes", "none")),
            ("colour", options.coloring.to_string()),
            ("work", format!("{pictures} of {}x{}, samples a pixel: {}", size[0], size[1], options.samples)),
        ]
    }

    /// What a method cannot show of the scene.
    fn lacks(&self, method: Method) -> Vec<String> {
        let Self { scene, options, .. } = self;
        let lit = options.coloring != Coloring::Doppler;
        let (curved, gamma) = (scene.spacetime.is_curved(), greatest_gamma(scene));
        if curved {
            return match method {
                Method::Trace => vec![],
                _ => vec!["light is bent, which only rays follow".into()],
            };
        }
        let mut lacks = Vec::new();
        if method != Method::Apparent && gamma > MOST_GAMMA {
            lacks.push(format!("lines of sight lose digits above γ = {MOST_GAMMA:.0e}"));
        }
        if method != Method::Trace && lit && has_reflections(scene) {
            lacks.push("it has no light of surfaces on each other".into());
        }
        if method == Method::Apparent && lit && has_shadows(scene) {
            lacks.push("it has no shadows".into());
        }
        if method == Method::Apparent && scene.sky.is_some() {
            lacks.push("it has no sky".into());
        }
        lacks
    }

    fn method(&self, method: Method) -> Verdict {
        let Self { scene, cameras, options } = self;
        let lacks = self.lacks(method);
        let name = method.to_string();
        if !lacks.is_empty() {
            return Verdict { name, is_right: false, reason: lacks.join("; ") };
        }
        let projection = cameras.first().map_or(Projection::Pinhole, |camera| camera.lens.projection());
        let is_listed = |pictures: usize| Tracer::is_listed(scene, projection, pictures);
        let reason = match method {
            Method::Exact => {
                let by = match is_listed(cameras.len()) {
                    true => "by lists of where triangles may be seen, which are many for so few pictures",
                    false if is_listed(1) => "through boxes around triangles, as pays for so many pictures",
                    false => "through boxes around triangles, which are few",
                };
                let shadows = match has_shadows(scene) && options.coloring != Coloring::Doppler {
                    true => "; shadows by rays from what is seen",
                    false => "",
                };
                format!("exact, {by}{shadows}")
            }
            Method::Apparent => format!(
                "to {} px, from cutting triangles first, which exact shading does without",
                options.tolerance
            ),
            Method::Trace if scene.spacetime.is_curved() => "the one that follows bent light".to_owned(),
            Method::Trace if self.lacks(Method::Exact).is_empty() => match is_listed(cameras.len()) {
                true => "exact, too, but it builds boxes around all triangles first",
                false if options.paths.bounces > 0 => {
                    "exact, too; there is nothing here that reflects onto anything"
                }
                false => "exact, too; without reflections, what exact shading does",
            }
            .to_owned(),
            Method::Trace if options.paths.bounces == 0 => {
                "the one that can follow light from surface to surface, which is not asked for".to_owned()
            }
            Method::Trace => "the one that follows light from surface to surface".to_owned(),
        };
        Verdict { name, is_right: true, reason }
    }

    fn devices(&self) -> Vec<Verdict> {
        let found = self.options.device(self.scene, self.cameras);
        let cpu = match found {
            Ok(_) if self.options.raster == Raster::Wgpu => "right for all scenes; the other is asked for",
            Ok(_) => "right for all scenes; the graphics processor is quicker here",
            Err(_) => "right for all scenes",
        };
        let (is_right, reason) = match found {
            Ok(name) => (true, name),
            Err(why) => (false, why.to_string()),
        };
        let gpu = Verdict { name: "wgpu".to_owned(), is_right, reason };
        vec![Verdict { name: "cpu".to_owned(), is_right: true, reason: cpu.to_owned() }, gpu]
    }
}

impl Display for Explanation {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "what there is")?;
        for (name, what) in &self.contents {
            writeln!(f, "    {name:<12} {what}")?;
        }
        let verdict = |verdict: &Verdict, chosen: bool| {
            let mark = if chosen { "  > " } else { "    " };
            let not = match (verdict.is_right, chosen) {
                (true, _) => "",
                // The least wrong, where none is right.
                (false, true) => "yet: ",
                (false, false) => "no: ",
            };
            format!("{mark}{:<12} {not}{}", verdict.name, verdict.reason)
        };
        writeln!(f, "methods")?;
        for method in &self.methods {
            writeln!(f, "{}", verdict(method, method.name == self.method.to_string()))?;
        }
        writeln!(f, "on")?;
        let last = self.devices.iter().rposition(|device| device.is_right);
        for (i, device) in self.devices.iter().enumerate() {
            writeln!(f, "{}", verdict(device, Some(i) == last))?;
        }
        Ok(())
    }
}
