use super::lecture::{Lecture, Part, Table};
use super::lessons::Lesson;
use super::markup::{Piece, pieces};
use super::plate::{Drawn, Kind, Plate};
use crate::figure::{base64, escaped};
use std::fmt::Write;

/// How pages look: one column, black on white, on paper too.
const STYLE: &str = include_str!("page.css");

/// A lecture as a page that needs nothing else: `drawn` holds what was drawn of its plates, in their order. With neighbours'
/// names it links to their pages, and to the index.
pub fn page(lesson: &Lesson, lecture: &Lecture, drawn: &[Vec<Drawn>], course: bool) -> String {
    let mut body =
        format!("<h1>{}</h1>\n<p class=\"source\">{}</p>\n", inline(lesson.title), inline(lesson.source));
    let mut drawn = drawn.iter();
    for part in &lecture.parts {
        match part {
            Part::Heading(text) => push(&mut body, format_args!("<h2>{}</h2>\n", inline(text))),
            Part::Text(text) => push(&mut body, format_args!("<p>{}</p>\n", inline(text))),
            Part::Formula(text) => {
                push(&mut body, format_args!("<p class=\"formula\">{}</p>\n", escaped(text)));
            }
            Part::Table(table) => write_table(&mut body, table),
            Part::Plates(plates) => {
                body.push_str("<div class=\"plates\">\n");
                for plate in plates {
                    let files = drawn.next().map_or(&[][..], Vec::as_slice);
                    write_plate(&mut body, plate, files);
                }
                body.push_str("</div>\n");
            }
        }
    }
    body.push_str("<h2>Try</h2>\n<dl>\n");
    for attempt in &lecture.tries {
        let (command, shows) = (escaped(&attempt.command), inline(&attempt.shows));
        push(&mut body, format_args!("<dt><code>{command}</code></dt><dd>{shows}</dd>\n"));
    }
    let (question, answer) = (inline(&lecture.question.text), inline(&lecture.question.answer));
    push(
        &mut body,
        format_args!(
            "</dl>\n<h2>A question</h2>\n<p>{question}</p>\n\
             <details><summary>Answer</summary><p>{answer}</p></details>\n"
        ),
    );
    if course {
        body.push_str(&neighbours(lesson));
    }
    document(lesson.title, &body)
}

/// A page that leads to those of all lessons, each beside one of its pictures.
pub fn index_page(lessons: &[(&Lesson, Option<&Drawn>)]) -> String {
    let mut body = "<h1>What relativistic motion looks like</h1>\n\
         <p class=\"source\">A course made by terrell; every number and picture was worked out when it was made. \
         “The paper” is Nollert, Kraus and Ruder, <em>Visualization in Curved Spacetimes: I</em> (2000).</p>\n\
         <ol class=\"lessons\">\n"
        .to_owned();
    for (lesson, picture) in lessons {
        let picture =
            picture.map_or_else(String::new, |drawn| format!("<img alt=\"\" src=\"{}\">", data(drawn)));
        push(
            &mut body,
            format_args!(
                "<li><a href=\"{}.html\">{picture}<span><b>{}</b><br>{}</span></a></li>\n",
                lesson.name,
                inline(lesson.title),
                inline(lesson.about)
            ),
        );
    }
    body.push_str("</ol>\n");
    document("What relativistic motion looks like", &body)
}

/// Text takes whatever is written to it.
fn push(to: &mut String, what: std::fmt::Arguments<'_>) {
    let _ = to.write_fmt(what);
}

fn document(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n<main>\n{body}</main>\n</body>\n</html>\n",
        escaped(title)
    )
}

fn neighbours(lesson: &Lesson) -> String {
    let all = super::lessons();
    let at = all.iter().position(|other| other.name == lesson.name).unwrap_or(0);
    let link = |other: &Lesson, arrow: [&str; 2]| {
        format!("<a href=\"{}.html\">{}{}{}</a>", other.name, arrow[0], inline(other.title), arrow[1])
    };
    let before = at.checked_sub(1).map(|i| link(&all[i], ["← ", ""])).unwrap_or_default();
    let after = all.get(at + 1).map(|other| link(other, ["", " →"])).unwrap_or_default();
    format!("<nav><span>{before}</span><a href=\"index.html\">All lessons</a><span>{after}</span></nav>\n")
}

fn inline(text: &str) -> String {
    pieces(text)
        .into_iter()
        .map(|piece| match piece {
            Piece::Plain(text) => escaped(text),
            Piece::Emphasis(text) => format!("<em>{}</em>", escaped(text)),
            Piece::Code(text) => format!("<code>{}</code>", escaped(text)),
        })
        .collect()
}

fn write_table(to: &mut String, table: &Table) {
    let row = |cells: &[String], kind: &str| {
        let cells: String = cells.iter().map(|cell| format!("<{kind}>{}</{kind}>", inline(cell))).collect();
        format!("<tr>{cells}</tr>\n")
    };
    push(
        to,
        format_args!("<div class=\"table\"><table>\n<thead>{}</thead>\n<tbody>\n", row(&table.head, "th")),
    );
    for cells in &table.rows {
        to.push_str(&row(cells, "td"));
    }
    to.push_str("</tbody>\n</table></div>\n");
}

fn write_plate(to: &mut String, plate: &Plate, files: &[Drawn]) {
    let plain: String = pieces(&plate.caption).into_iter().map(Piece::text).collect();
    to.push_str("<figure>");
    if let Some(drawn) = files.first() {
        match drawn.kind {
            Kind::Mp4 => {
                let poster = files.iter().find(|file| file.kind == Kind::Png).map(data).unwrap_or_default();
                push(
                    to,
                    format_args!(
                        "<video controls loop muted playsinline preload=\"metadata\" poster=\"{poster}\" aria-label=\"{}\" src=\"{}\"></video>",
                        escaped(&plain),
                        data(drawn)
                    ),
                );
            }
            Kind::Png | Kind::Svg => {
                push(to, format_args!("<img alt=\"{}\" src=\"{}\">", escaped(&plain), data(drawn)));
            }
        }
    }
    push(to, format_args!("<figcaption>{}</figcaption></figure>\n", inline(&plate.caption)));
}

/// The file as an address that is the file.
fn data(drawn: &Drawn) -> String {
    format!("data:{};base64,{}", drawn.kind.media_type(), base64(&drawn.bytes))
}
