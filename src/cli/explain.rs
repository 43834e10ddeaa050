//! `--explain`: what is chosen, and why, instead of drawing.

use super::Fault;
use super::report::ReportFlags;
use clap::Args;
use serde_json::{Value, json};
use terrell::explanation::{Explanation, Verdict};
use terrell::render::{Options, Raster};
use terrell::scene::{Camera, Scene};

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

/// Tells how pictures of a scene would be drawn; `why`, if it was not asked for.
pub fn tell(
    scene: &Scene,
    cameras: &[&Camera],
    options: &Options,
    why: Option<&str>,
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
    let summary = json!({
        "terrell": env!("CARGO_PKG_VERSION"),
        "scene": scene.name,
        "method": method.to_string(),
        "method_because": why,
        "device": device,
        "contents": contents,
        "methods": verdicts(methods),
        "devices": verdicts(devices),
    });
    report.finish(Vec::new(), &scene.files, &summary)?;
    let why = why.unwrap_or("asked for");
    report.tell(&format!("{}: method {method} on {device} ({why})\n{explanation}", scene.name), &summary)
}
