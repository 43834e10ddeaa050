use super::Fault;
use clap::{Args, ValueEnum};
use std::path::Path;
use terrell::color::Coloring;
use terrell::drawing::{Caption, Edges, Overlay, OverlayOptions, Shot};
use terrell::film::Film;
use terrell::picture::{self, Format, Pending, WriteError};
use terrell::scene::{Camera, Scene};

/// What is drawn on top of a picture.
#[derive(Args)]
#[command(next_help_heading = "Drawn on top")]
pub struct DrawingFlags {
    /// Draw the meshes' edges, as the curves they look like; hidden ones are not drawn [without a value: sharp]
    #[arg(long, value_name = "WHICH", value_enum, num_args = 0..=1, default_missing_value = "sharp")]
    edges: Option<EdgesFlag>,
    /// Draw the world's x, y, z and the bodies' motion (v) as directions in the camera's frame, in a corner
    #[arg(long)]
    axes: bool,
    /// Draw a bar of a round length, with the distance it holds for
    ///
    /// It is as long as that length is seen at right angles to the line of sight, in the middle of the picture, at
    /// the apparent distance of what is seen there; if nothing is, of the nearest body whose middle is in the
    /// picture. A panorama has none.
    #[arg(long)]
    scale_bar: bool,
    /// Write exposure and tone curve, or draw the scale of false colours, at the upper left
    #[arg(long)]
    legend: bool,
    /// Write a line at the lower left; give it again for another line
    ///
    /// {beta} and {gamma} stand for the speed and the Lorentz factor of the body that moves fastest relative to the
    /// camera, {time} for the camera's world time, {scene} for the scene's name; {time:.2} has two decimals. {{ and
    /// }} are braces.
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    caption: Vec<String>,
}

#[derive(Clone, Copy, ValueEnum)]
enum EdgesFlag {
    /// Where surfaces end, and where they fold by more than 25°
    Sharp,
    /// Every triangle's
    All,
}

impl DrawingFlags {
    /// Puts a scene's numbers into the caption, for a picture of its shapes in the colours they are seen in.
    pub fn fill_caption(&mut self, scene: &Scene, camera: &Camera, coloring: Coloring) -> Result<(), Fault> {
        if self.legend && coloring.is_beamed() {
            return Err("--legend: shapes seen from aside have colours that were exposed before; leave it out, or use --color doppler".into());
        }
        if !self.caption.is_empty() {
            let text = Caption::parse(&self.caption.join("\n"))?.text(scene, camera);
            self.caption = vec![text.replace('{', "{{").replace('}', "}}")];
        }
        Ok(())
    }

    /// What to draw on pictures of a scene; none if nothing.
    pub fn overlay(&self, scene: &Scene) -> Result<Option<Overlay>, Fault> {
        let flat =
            [(self.edges.is_some(), "--edges"), (self.axes, "--axes"), (self.scale_bar, "--scale-bar")];
        if let Some((_, flag)) = flat.iter().find(|(asked, _)| *asked && scene.spacetime.is_curved()) {
            let why = "is drawn where flat spacetime has it; leave it out in curved spacetime";
            return Err(format!("{flag} {why}").into());
        }
        let caption = (!self.caption.is_empty()).then(|| Caption::parse(&self.caption.join("\n")));
        let edges = self.edges.map(|which| match which {
            EdgesFlag::Sharp => Edges::Sharp,
            EdgesFlag::All => Edges::All,
        });
        let options = OverlayOptions {
            edges,
            axes: self.axes,
            scale_bar: self.scale_bar,
            legend: self.legend,
            caption: caption.transpose()?,
        };
        Ok(if options.is_empty() { None } else { Some(Overlay::new(scene, options)?) })
    }
}

/// An EXR file has what was seen, and nothing else.
pub fn check_format(overlay: &Option<Overlay>, output: &Path) -> Result<(), Fault> {
    if overlay.is_some() && Format::of(output)? == Format::Exr {
        return Err(format!(
            "{}: an EXR holds what was seen, and nothing can be drawn on it; write to a .png file, or leave out --edges, --axes, --scale-bar, --legend and --caption",
            output.display()
        )
        .into());
    }
    Ok(())
}

/// Writes the picture with what is drawn on it; also what could not be drawn, for people to read.
pub fn prepare(
    overlay: &Overlay,
    shot: &Shot<'_>,
    path: &Path,
) -> Result<(Pending, Vec<String>), WriteError> {
    let mut pixels = picture::pixels_srgb(shot.film, &shot.development);
    let notes = overlay.draw(&mut pixels, shot);
    let Film { width, height, .. } = *shot.film;
    let picture = picture::prepare(path, |to| picture::write_png_pixels(width, height, &pixels, to))?;
    Ok((picture, notes))
}
