use super::Fault;
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use terrell::color::Coloring;
use terrell::film::Film;
use terrell::picture;
use terrell::plan::cheapest;
use terrell::render::{Options, render};
use terrell::scene::{Builtin, builtin_scene, builtin_scenes};
use terrell::tone::Development;

/// List the scenes that ship, draw them all, or print one as TOML to start from
#[derive(Args)]
#[command(after_help = "Examples:
  terrell scenes
  terrell scenes cube > my.toml
  terrell scenes --thumbnails pictures")]
pub struct Scenes {
    /// Print this scene as TOML
    name: Option<String>,
    /// Draw every scene, small, to DIR/NAME.png; DIR is made if it is not there
    #[arg(long, value_name = "DIR", conflicts_with = "name")]
    thumbnails: Option<PathBuf>,
}

impl Scenes {
    pub fn run(self) -> Result<(), Fault> {
        let mut out = std::io::stdout().lock();
        if let Some(name) = self.name {
            write!(out, "{}", builtin_scene(&name)?.toml)?;
            return Ok(out.flush()?);
        }
        let drawn = self.thumbnails.map(|folder| draw_all(&folder)).transpose()?;
        for (index, scene) in builtin_scenes().iter().enumerate() {
            match &drawn {
                Some(paths) => writeln!(out, "{}", paths[index].display())?,
                None => {
                    writeln!(out, "{:<10}{}\n{:<10}terrell render {0}", scene.name, scene.about, "")?;
                }
            }
        }
        Ok(out.flush()?)
    }
}

/// A small picture of every scene; where they are.
fn draw_all(folder: &Path) -> Result<Vec<PathBuf>, Fault> {
    if folder.exists() && !folder.is_dir() {
        return Err(format!("cannot write to {}: it is not a folder", folder.display()).into());
    }
    let films = builtin_scenes().iter().map(draw).collect::<Result<Vec<_>, _>>()?;
    std::fs::create_dir_all(folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    let path = |scene: &Builtin| folder.join(format!("{}.png", scene.name));
    let paths: Vec<_> = builtin_scenes().iter().map(path).collect();
    let development = Development::default();
    let pictures = films.iter().zip(&paths);
    let pictures = pictures.map(|(film, path)| picture::prepare_picture(film, &development, path));
    // All or none.
    let pictures = pictures.collect::<Result<Vec<_>, _>>()?;
    for picture in pictures {
        picture.finish()?;
    }
    Ok(paths)
}

fn draw(scene: &Builtin) -> Result<Film, Fault> {
    let mut scene = scene.scene();
    scene.view.size = [320, 180];
    // Rays only where light is bent: light of surfaces on each other takes too long.
    let method = cheapest(&scene, Coloring::Doppler).0;
    let samples = if scene.spacetime.is_curved() { 1 } else { 9 };
    // Shapes: some are too dark to be recognised as they are seen.
    let options = Options { samples, coloring: Coloring::Geometry, method, ..Options::default() };
    Ok(render(&scene, &scene.camera()?, &options, |_| ())?.0)
}
