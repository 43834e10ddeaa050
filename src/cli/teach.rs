use super::progress::progress_bar;
use super::report::ReportFlags;
use super::{Fault, is_colored};
use clap::Args;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use terminal_size::terminal_size;
use terrell::picture::{self, Pending};
use terrell::teach::{Drawn, Kind, Lecture, Lesson, answer, index_page, lesson, lessons, listed, page, told};

/// Lessons on what relativistic motion looks like, with numbers, pictures and films worked out on the spot
///
/// Without a lesson they are listed. A lesson is printed; with -o its pictures, plots (SVG and PNG) and films (MP4) are written, with
/// --html a page that needs nothing else.
#[derive(Args)]
#[command(after_help = "Examples:
  terrell teach                                  which lessons there are
  terrell teach cube                             the lesson, to read here
  terrell teach cube --answer                    the answer to its question
  terrell teach cube -o cube                     its pictures and films too
  terrell teach cube --html -o cube              and a page to open in a browser
  terrell teach --all --html -o course           the whole course, with an index")]
pub struct Teach {
    /// Which lesson
    #[arg(value_name = "LESSON", conflicts_with = "all")]
    lesson: Option<String>,
    /// All lessons, one after the other
    #[arg(long)]
    all: bool,
    /// A folder for what is drawn; it is made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Write pages with everything in them, to DIR/LESSON.html; of all lessons an index, too
    #[arg(long, requires = "output")]
    html: bool,
    /// Only the answer to the lesson's question
    #[arg(long, conflicts_with_all = ["output", "html"])]
    answer: bool,
    #[command(flatten)]
    report: ReportFlags,
}

/// A lesson worked out, and what is drawn of it: a list of files for every plate.
struct Made {
    lesson: &'static Lesson,
    lecture: Lecture,
    drawn: Vec<Vec<Drawn>>,
}

impl Teach {
    pub fn run(self) -> Result<(), Fault> {
        let chosen: Vec<&Lesson> = match &self.lesson {
            Some(name) => vec![lesson(name)?],
            None if self.all => lessons().iter().collect(),
            None if self.output.is_some() || self.answer => {
                let names: Vec<_> = lessons().iter().map(|lesson| lesson.name).collect();
                return Err(format!(
                    "which lesson? Name one, or ask for --all; there is {}",
                    names.join(", ")
                )
                .into());
            }
            None => return self.list(),
        };
        if let Some(folder) = &self.output {
            if folder.exists() && !folder.is_dir() {
                return Err(format!("cannot write to {}: it is not a folder", folder.display()).into());
            }
            self.report.check(folder, &[])?;
        }
        let lectures: Vec<(&Lesson, Lecture)> =
            chosen.iter().map(|lesson| Ok((*lesson, lesson.lecture()?))).collect::<Result<_, Fault>>()?;
        let (width, colored) = (width(), is_colored(&std::io::stdout()));
        if self.answer {
            let texts = lectures.iter().map(|(_, lecture)| answer(lecture, width, colored));
            let said: String = texts.collect::<Vec<_>>().join("\n");
            return self.tell(&said, &summary(&lectures, &[]));
        }
        let mut said = String::new();
        if !self.all || self.output.is_none() {
            let folder = self.output.as_ref().map(|folder| folder.display().to_string());
            let texts = lectures
                .iter()
                .map(|(lesson, lecture)| told(lesson, lecture, width, colored, folder.as_deref()));
            said = texts.collect::<Vec<_>>().join("\n\n");
        }
        match &self.output {
            Some(folder) => {
                let written = self.write(folder, lectures, &mut said)?;
                self.report.tell(&said, &written)
            }
            None => self.tell(&said, &summary(&lectures, &[])),
        }
    }

    /// Tells what nothing is drawn of.
    fn tell(&self, said: &str, summary: &Value) -> Result<(), Fault> {
        self.report.finish(Vec::new(), &[], summary)?;
        self.report.tell(said, summary)
    }

    fn list(&self) -> Result<(), Fault> {
        let said = listed(lessons(), width());
        let told: Vec<Value> =
            lessons().iter().map(|l| json!({ "name": l.name, "title": l.title, "about": l.about })).collect();
        let summary = json!({ "terrell": env!("CARGO_PKG_VERSION"), "lessons": told });
        self.tell(&said, &summary)
    }

    /// Draws everything, then writes it.
    fn write(
        &self,
        folder: &Path,
        lectures: Vec<(&'static Lesson, Lecture)>,
        said: &mut String,
    ) -> Result<Value, Fault> {
        let plates = lectures.iter().map(|(_, lecture)| lecture.all_plates().count()).sum();
        let bar = progress_bar(plates, "pictures and films", self.report.quiet);
        let mut all = Vec::new();
        for (lesson, lecture) in lectures {
            let mut drawn = Vec::new();
            for plate in lecture.all_plates() {
                drawn.push(plate.draw()?);
                bar.inc(1);
            }
            all.push(Made { lesson, lecture, drawn });
        }
        bar.finish_and_clear();
        std::fs::create_dir_all(folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
        let mut files: Vec<Pending> = Vec::new();
        let mut put = |name: String, bytes: &[u8]| -> Result<(), Fault> {
            files.push(picture::prepare(&folder.join(name), |to| to.write_all(bytes))?);
            Ok(())
        };
        for Made { lesson, lecture, drawn } in &all {
            for (plate, drawn) in lecture.all_plates().zip(drawn) {
                for Drawn { kind, bytes } in drawn {
                    put(format!("{}-{}.{}", lesson.name, plate.name, kind.ending()), bytes)?;
                }
            }
            if self.html {
                put(format!("{}.html", lesson.name), page(lesson, lecture, drawn, self.all).as_bytes())?;
            }
        }
        if self.html && self.all {
            let pictures: Vec<_> = all.iter().map(|made| (made.lesson, made.picture())).collect();
            put("index.html".to_owned(), index_page(&pictures).as_bytes())?;
        }
        let names: Vec<PathBuf> = files.iter().map(|file| file.path().to_owned()).collect();
        let lectures: Vec<_> = all.into_iter().map(|made| (made.lesson, made.lecture)).collect();
        let summary = summary(&lectures, &names);
        self.report.finish(files, &[], &summary)?;
        let first = match (self.html, self.all) {
            (true, true) => format!("; open {}", folder.join("index.html").display()),
            (true, false) => {
                format!("; open {}", folder.join(format!("{}.html", lectures[0].0.name)).display())
            }
            (false, _) => String::new(),
        };
        let _ = writeln!(
            said,
            "{}{}: {} files{first}",
            if said.is_empty() { "" } else { "\n" },
            folder.display(),
            names.len()
        );
        Ok(summary)
    }
}

impl Made {
    /// What stands for it in an index: the last picture of a scene, if there is one.
    fn picture(&self) -> Option<&Drawn> {
        let pictures = || self.drawn.iter().flatten();
        let mut only = self.drawn.iter().filter(|files| files.len() == 1).flatten();
        only.rfind(|drawn| drawn.kind == Kind::Png).or(pictures().find(|drawn| drawn.kind == Kind::Svg))
    }
}

fn summary(lectures: &[(&Lesson, Lecture)], files: &[PathBuf]) -> Value {
    let told = |(lesson, lecture): &(&Lesson, Lecture)| {
        let numbers: serde_json::Map<_, _> =
            lecture.numbers.iter().map(|number| (number.name.clone(), json!(number.value))).collect();
        json!({
            "name": lesson.name,
            "title": lesson.title,
            "numbers": numbers,
            "question": lecture.question.text,
            "answer": lecture.question.answer,
        })
    };
    json!({
        "terrell": env!("CARGO_PKG_VERSION"),
        "lessons": lectures.iter().map(told).collect::<Vec<_>>(),
        "files": files,
    })
}

/// Letters in a line that reads well.
fn width() -> usize {
    let asked = std::env::var("COLUMNS").ok().and_then(|text| text.parse().ok());
    let columns = asked.or_else(|| terminal_size().map(|(width, _)| width.0.into()));
    columns.unwrap_or(80).clamp(40, 100)
}
