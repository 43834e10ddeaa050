//! What will be seen, by which method, and why; the latter also by `--explain`, instead of drawing.

use super::Fault;
use super::look::{LookFlags, MomentFlags};
use super::report::ReportFlags;
use super::summary;
use clap::Args;
use serde_json::{Value, json};
use terrell::explanation::{Explanation, Verdict};
use terrell::outlook::Outlook;
use terrell::render::{Options, Raster};
use terrell::scene::{Camera, Scene};

/// What will be seen of a scene and why: how fast, how large, how far, which Doppler factors, when each body passes; and the
/// method that draws it
///
/// A picture is worked out for it; nothing is written. SCENE is as for `terrell render`.
#[derive(Args)]
#[command(after_help = "Examples:
  terrell explain cube
  terrell explain street --time 40
  terrell explain statue.glb --gamma 10 --direction 1,0,0
  terrell explain shadow --json -")]
pub struct Explain {
    /// Scene: a name, a .toml file or a mesh
    scene: String,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    moment: MomentFlags,
    #[command(flatten)]
    report: ReportFlags,
}

impl Explain {
    pub fn run(self) -> Result<(), Fault> {
        let mut options = self.look.options()?;
        let mut scene = self.look.open(&self.scene, &self.moment)?;
        let why = self.look.choose(&mut options, &scene)?;
        let camera = scene.camera()?;
        scene.eye(&camera)?;
        self.report.check_json(&scene.files)?;
        scene.notes.extend(summary::scene_notes(&scene, &options));
        let outlook = Outlook::new(&scene, &camera)?;
        tell(&scene, &[&camera], &options, why, Some(&outlook), &self.report)
    }
}

#[derive(Args)]
pub struct ExplainFlag {
    /// Say what there is in the scene, which method it needs and why; draw nothing
    #[arg(long)]
    explain: bool,
}

impl ExplainFlag {
    pub fn is_asked(&self) -> bool {
        self.explain
    }
}

/// Tells how pictures of a scene would be drawn, `why`, if that was not asked for, and what is to be seen on them.
pub fn tell(
    scene: &Scene,
    cameras: &[&Camera],
    options: &Options,
    why: Option<&str>,
    outlook: Option<&Outlook>,
    report: &ReportFlags,
) -> Result<(), Fault> {
    if options.raster == Raster::Wgpu {
        // As drawing would.
        options.device(scene, cameras).map_err(|why| format!("no graphics processor draws this: {why}"))?;
    }
    let explanation = Explanation::new(scene, cameras, options);
    let Explanation { method, device, contents, methods, devices } = &explanation;
    let verdicts = |all: &[Verdict]| -> Vec<Value> {
        all.iter().map(|v| json!({ "name": v.name, "is_right": v.is_right, "reason": v.reason })).collect()
    };
    let contents: serde_json::Map<_, _> =
        contents.iter().map(|(name, what)| ((*name).to_owned(), json!(what))).collect();
    let mut summary = json!({
        "terrell": env!("CARGO_PKG_VERSION"),
        "scene": scene.name,
        "method": method.to_string(),
        "method_because": why,
        "device": device,
        "contents": contents,
        "methods": verdicts(methods),
        "devices": verdicts(devices),
        "notes": scene.notes,
    });
    let mut seen = String::new();
    if let Some(outlook) = outlook {
        summary["seen"] = seen_by(outlook);
        seen = outlook.to_string();
    }
    report.finish(Vec::new(), &scene.files, &summary)?;
    let why = why.unwrap_or("asked for");
    let notes: String = scene.notes.iter().map(|note| format!("note: {note}\n")).collect();
    let told = format!("{}: method {method} on {device} ({why})\n{seen}{explanation}{notes}", scene.name);
    report.tell(&told, &summary)
}

fn seen_by(outlook: &Outlook) -> Value {
    let bodies = outlook.prospects.iter().map(|body| {
        json!({
            "name": body.name,
            "gamma": body.celerity.map(|u| u.hypot(1.0)),
            "celerity": body.celerity,
            "part_of_picture": body.part,
            "doppler": body.doppler,
            "distance": body.distance,
            "abreast": body.passage.map(|passage| json!({
                "time": passage.time,
                "delay": passage.delay,
                "doppler": passage.doppler,
                "turn_deg": passage.turn_deg,
            })),
        })
    });
    json!({ "time": outlook.time, "bodies": bodies.collect::<Vec<_>>(), "remarks": outlook.remarks })
}
