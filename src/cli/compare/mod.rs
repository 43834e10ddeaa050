mod folders;
mod methods;
mod pictures;
mod progress;
mod table;
mod told;

use super::Fault;
use super::look::{LookFlags, MomentFlags};
use super::report::ReportFlags;
use super::summary;
use clap::Args;
use folders::{Folders, check_folder, folder_names};
use methods::{Drawn, WAYS, Way};
use pictures::{Pictures, pair};
use progress::Progress;
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;
use terrell::color::Coloring;
use terrell::film::Film;
use terrell::measure::{Comparison, Corners, Faces, Known, Perceived, Reference, flip};
use terrell::picture::{self, Pending};
use terrell::plan::{Method, has_reflections, is_of_polygons};
use terrell::render::{Options, Report};
use terrell::scene::{Camera, Scene, builtin_scenes};
use terrell::tone::Development;

/// Every method on one scene: how far they are apart, and what they take
///
/// Ray tracing is what the others are compared with, or an EXR of any program: --reference. Pictures, difference
/// pictures, one composed of all (compare.png) and the numbers (compare.json) go to a folder, in it to a folder a scene
/// if there are several; nothing else in it is touched.
///
/// Silhouette pixels see another body than the reference; those beyond are more than a pixel off: what they see, the
/// reference sees in none of the nine pixels around, and (where it is traced) the pixel's corners see what its centre sees.
/// Edge pixels see another face of the same body. Distance, Doppler
/// factor: worst relative difference where both see the same face. Light: relative RMS, worst over the reference's peak,
/// and the latter where both see the same face. FLIP: mean difference an eye sees, 0 to 1, developed alike.
#[derive(Args)]
#[command(
    mut_arg("method", |flag| flag.hide(true)),
    mut_arg("raster", |flag| flag.hide(true)),
    after_help = "Examples:
  terrell compare street
  terrell compare statue.glb --beta 0.99 --methods trace,apparent -o compared
  terrell compare cube --reference other.exr --color flat
  terrell compare --all --size 1280x720 --no-pictures --markdown"
)]
pub struct Compare {
    /// Scenes: names, .toml files or meshes
    #[arg(required_unless_present = "all", value_name = "SCENE")]
    scenes: Vec<String>,
    /// Every scene that ships in which no surface is lit
    #[arg(long, conflicts_with = "scenes")]
    all: bool,
    /// Folder to write to; made if it is not there [default: the scene's name_compare; of several, compare]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Compare with this EXR instead (R, G, B; if there: body, face, distance, doppler, inner); its size is taken
    #[arg(long, value_name = "FILE")]
    reference: Option<PathBuf>,
    /// Which methods: trace, exact, apparent, painter [default: all]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = Way::named)]
    methods: Vec<&'static Way>,
    /// Times are medians of so many runs
    #[arg(long, value_name = "N", default_value = "3", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: u32,
    /// Write the films as EXR, too
    #[arg(long, conflicts_with = "no_pictures")]
    exr: bool,
    /// Only compare.json, and the table on screen
    #[arg(long)]
    no_pictures: bool,
    /// Print one table of all scenes, in Markdown
    #[arg(long)]
    markdown: bool,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    moment: MomentFlags,
    #[command(flatten)]
    report: ReportFlags,
}

/// What is known of a scene in the end.
struct Compared {
    name: String,
    /// The scene in words.
    what: String,
    size: [u32; 2],
    triangles: usize,
    options: Options,
    development: Development,
    /// With what it is compared, in words.
    against: String,
    reference_file: Option<PathBuf>,
    /// What a file has.
    known: Option<Known>,
    left_out: usize,
    repeats: u32,
    rows: Vec<Row>,
    notes: Vec<String>,
}

/// A method's line.
struct Row {
    way: &'static Way,
    /// Or why there is nothing.
    drawn: Result<Drawing, String>,
}

struct Drawing {
    way: &'static Way,
    pieces: usize,
    once: Duration,
    picture: Duration,
    /// None of the reference itself.
    found: Option<Found>,
}

struct Found {
    comparison: Comparison,
    perceived: Perceived,
}

impl Compared {
    fn faces(&self) -> Option<Faces> {
        let drawn = self.rows.iter().filter_map(|row| row.drawn.as_ref().ok());
        drawn.filter_map(|drawn| drawn.found.as_ref()).map(|found| found.comparison.faces).next()
    }
}

impl Compare {
    pub fn run(self) -> Result<(), Fault> {
        self.look.check_no_method()?;
        let options = self.look.options()?;
        let reference = self.reference.as_deref().map(picture::read_reference).transpose()?;
        let mut scenes = self.open(reference.as_ref())?;
        if let Some(scene) = scenes.iter().find(|s| s.spacetime.is_curved() && reference.is_none()) {
            let why =
                "in curved spacetime rays are the only method, and there is nothing to compare them with";
            let remedy = "give another program's picture (--reference), or draw it with `terrell render`";
            return Err(format!("'{}': {why}; {remedy}", scene.name).into());
        }
        let cameras = scenes.iter().map(Scene::camera).collect::<Result<Vec<_>, _>>()?;
        if let (Some(reference), [camera], Some(path)) = (&reference, &cameras[..], &self.reference) {
            let [there, asked] =
                [[reference.film.width, reference.film.height], [camera.lens.width(), camera.lens.height()]];
            if there != asked {
                return Err(format!(
                    "{} has {}x{} pixels and --size asks for {}x{}; leave --size out to take the file's",
                    path.display(),
                    there[0],
                    there[1],
                    asked[0],
                    asked[1]
                )
                .into());
            }
        }
        let output = self.output.clone().unwrap_or_else(|| match &scenes[..] {
            [scene] => format!("{}_compare", scene.name).into(),
            _ => "compare".into(),
        });
        let mut read: Vec<PathBuf> = scenes.iter().flat_map(|scene| scene.files.clone()).collect();
        read.extend(self.reference.clone());
        check_folder(&output)?;
        self.report.check(&output, &read)?;
        let names = folder_names(&scenes)?;
        let mut folders = Folders::default();
        let (mut files, mut all) = (Vec::new(), Vec::new());
        for ((scene, camera), name) in scenes.iter_mut().zip(&cameras).zip(&names) {
            let folder = if names.len() == 1 { output.clone() } else { output.join(name) };
            let mut options = options.clone();
            self.look.set_paths(&mut options, scene);
            let (compared, made) = self.compare(scene, camera, &options, reference.as_ref(), || {
                folders.make(&output)?;
                folders.make(&folder).map(|()| folder.clone())
            })?;
            files.extend(made);
            all.push(compared);
        }
        let summary = json!({
            "terrell": env!("CARGO_PKG_VERSION"),
            "output": output,
            "scenes": all.iter().map(told::told).collect::<Vec<_>>(),
        });
        folders.make(&output)?;
        files.push(picture::prepare(&output.join("compare.json"), |to| writeln!(to, "{summary:#}"))?);
        self.report.finish(files, &read, &summary)?;
        folders.keep();
        self.report.tell(&self.said(&all, &output), &summary)
    }

    /// The scenes, with what the flags say over what they say themselves.
    fn open(&self, reference: Option<&Reference>) -> Result<Vec<Scene>, Fault> {
        let shipped = builtin_scenes().iter().filter(|scene| self.all && is_of_polygons(&scene.scene()));
        let names = self.scenes.iter().map(String::as_str).chain(shipped.map(|scene| scene.name));
        let names: Vec<&str> = names.collect();
        if reference.is_some() && names.len() != 1 {
            return Err(
                format!("--reference is a picture of one scene, and {} are given", names.len()).into()
            );
        }
        let speed = self.look.scene.velocity.speed()?;
        let open = |name: &str| {
            let mut scene = self.look.scene.open(name, speed, |view| {
                self.look.set_lens(view);
                if let Some(Reference { film, .. }) = reference {
                    view.size = [film.width, film.height];
                }
            })?;
            self.moment.set(&mut scene)?;
            Ok(scene)
        };
        names.into_iter().map(open).collect()
    }

    /// Draws a scene by all methods, and writes what is to be seen of it to a folder.
    fn compare(
        &self,
        scene: &mut Scene,
        camera: &Camera,
        options: &Options,
        given: Option<&Reference>,
        folder: impl FnOnce() -> Result<PathBuf, Fault>,
    ) -> Result<(Compared, Vec<Pending>), Fault> {
        let coloring = options.coloring;
        let reflects = coloring != Coloring::Doppler && has_reflections(scene);
        let only = if reflects { "trace" } else { "trace and exact" };
        scene.notes.extend(
            summary::shadow_note(scene, coloring)
                .map(|note| format!("{note} but by {only}: that is in the others' light")),
        );
        let has_sky = scene.sky.is_some() && !scene.spacetime.is_curved();
        scene.notes.extend(
            has_sky.then(|| {
                "the sky is not there but by trace and exact: that is in the others' light".to_owned()
            }),
        );
        // What the others are compared with, if nothing is given.
        scene.notes.extend(summary::digit_note(scene, Method::Trace));
        let mut ways: Vec<&'static Way> = WAYS
            .iter()
            .filter(|way| self.methods.is_empty() || self.methods.iter().any(|m| m.name == way.name))
            .collect();
        // It is drawn to compare with.
        if given.is_none() && ways.first().is_none_or(|way| way.name != WAYS[0].name) {
            ways.insert(0, &WAYS[0]);
        }
        let progress = Progress::new(self.report.quiet);
        let mut drawn = Vec::with_capacity(ways.len());
        for way in ways {
            let done = way.draw(scene, camera, options, self.repeats, |run| {
                progress.show(&format!("{}: {}, run {} of {}", scene.name, way.about, run + 1, self.repeats));
            });
            if let Ok(Drawn { report: Report { rays: Some(rays), .. }, .. }) = &done {
                let dark = summary::dark_lights(&rays.to_lights, scene, &camera.observer);
                summary::check_shut_in(&dark).map_err(|why| format!("'{}': {why}", scene.name))?;
            }
            drawn.push((way, done));
        }
        progress.show(&format!("{}: comparing", scene.name));
        let own;
        let reference = match (given, drawn.first_mut()) {
            (Some(given), _) => given,
            (None, Some((_, Ok(traced)))) => {
                let film = std::mem::replace(&mut traced.film, Film::new(0, 0));
                let corners = Some(Corners::traced(scene, camera, &film)?);
                own = Reference { corners, ..Reference::from(film) };
                &own
            }
            (None, first) => {
                let fault = first.and_then(|(_, done)| done.as_ref().err().cloned());
                return Err(fault.map_or_else(|| "there is nothing to compare with".into(), Fault::from));
            }
        };
        scene.notes.extend(self.notes(reference));
        let exposure = self.look.develop.exposure(coloring, scene);
        let with = WAYS[0].options(options);
        let development =
            exposure.of_picture(self.look.develop.tone(coloring), scene, camera, &with, &reference.film)?;
        let size = [reference.film.width, reference.film.height];
        let bodies = summary::bodies_in_words(&summary::gammas(scene, camera));
        let triangles = scene.triangle_count();
        let (lens, colors) = (camera.lens.projection(), summary::colors_in_words(coloring, &development));
        let mut compared = Compared {
            name: scene.name.clone(),
            what: format!(
                "{}: {}x{} {lens}, {}, {bodies}, {triangles} triangles, {colors}",
                scene.name, size[0], size[1], scene.spacetime
            ),
            size,
            triangles,
            options: options.clone(),
            development,
            against: self
                .reference
                .as_ref()
                .map_or_else(|| WAYS[0].about.to_owned(), |f| f.display().to_string()),
            reference_file: self.reference.clone(),
            known: given.map(|given| given.known),
            left_out: reference.left_out.iter().filter(|left| **left).count(),
            repeats: self.repeats,
            rows: Vec::new(),
            notes: Vec::new(),
        };
        let place;
        let mut pictures = if self.no_pictures {
            None
        } else {
            place = folder()?;
            let title = vec![compared.what.clone(), format!("against {}", compared.against)];
            Some(Pictures::new(&place, self.exr, development, title))
        };
        let file_line = self.reference.as_ref().map(|file| format!("reference: {}", file.display()));
        if let (Some(pictures), Some(line)) = (&mut pictures, file_line) {
            pictures.add_reference(reference, vec![line, String::new()]);
        }
        for (index, (way, done)) in drawn.into_iter().enumerate() {
            let done = match done {
                Ok(done) => done,
                Err(reason) => {
                    compared.rows.push(Row { way, drawn: Err(reason.to_string()) });
                    continue;
                }
            };
            let is_reference = given.is_none() && index == 0;
            let film = if is_reference { &reference.film } else { &done.film };
            let mut drawing = Drawing {
                way,
                pieces: done.report.pieces,
                once: done.once,
                picture: done.picture,
                found: None,
            };
            if !is_reference {
                let comparison = Comparison::new(reference, film)?;
                let [expected, got] = pair(reference, film, &development);
                let perceived = flip(size, &expected, &got)?;
                drawing.found = Some(Found { comparison, perceived });
            }
            if let Some(pictures) = &mut pictures {
                pictures.add_film(way.name, film)?;
                match &drawing.found {
                    Some(found) => pictures.add_difference(&drawing, film, reference, found)?,
                    None => pictures.add_reference(
                        reference,
                        vec![
                            format!("{}: {} (reference)", way.name, way.about),
                            table::times(drawing.once, drawing.picture),
                        ],
                    ),
                }
            }
            compared.rows.push(Row { way, drawn: Ok(drawing) });
        }
        progress.clear();
        if let (Some(_), [reason, ..]) = (given, &failures(&compared.rows)[..])
            && failures(&compared.rows).len() == compared.rows.len()
        {
            return Err(reason.clone().into());
        }
        compared.notes.clone_from(&scene.notes);
        Ok((compared, pictures.map(Pictures::finish).transpose()?.unwrap_or_default()))
    }

    /// What a reference does not say.
    fn notes(&self, reference: &Reference) -> Vec<String> {
        let known = reference.known;
        let missing = [
            (known.body, "body"),
            (known.face, "face"),
            (known.distance, "distance"),
            (known.doppler, "doppler"),
        ];
        let missing: Vec<&str> = missing.iter().filter(|(there, _)| !there).map(|(_, name)| *name).collect();
        let mut notes = Vec::new();
        if !missing.is_empty() {
            let of_faces = if known.face { "" } else { ", and nothing is said of the same face's light" };
            notes.push(format!("the reference has no {}: not compared{of_faces}", missing.join(", ")));
        }
        match reference.left_out.iter().filter(|left| **left).count() {
            0 => {}
            1 => notes
                .push("one pixel of the reference has numbers that are not finite; it is left out".into()),
            n => notes.push(format!(
                "{n} pixels of the reference have numbers that are not finite; they are left out"
            )),
        }
        notes
    }

    /// What people are told.
    fn said(&self, all: &[Compared], output: &Path) -> String {
        if self.markdown {
            return table::markdown(all);
        }
        let mut text = String::new();
        for compared in all {
            text.push_str(&format!("{}\n{}", table::title(compared), table::plain(compared)));
            for note in &compared.notes {
                text.push_str(&format!("note: {note}\n"));
            }
            text.push('\n');
        }
        let what = if self.no_pictures {
            "compare.json"
        } else {
            "compare.png, compare.json, and a picture a method"
        };
        let times =
            format!("times: median of {} runs, {} threads", self.repeats, rayon::current_num_threads());
        text.push_str(&format!("{times}\n{}: {what}\n", output.display()));
        text
    }
}

fn failures(rows: &[Row]) -> Vec<String> {
    rows.iter().filter_map(|row| row.drawn.as_ref().err().cloned()).collect()
}
