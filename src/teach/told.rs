use super::lecture::{Lecture, Part, Table};
use super::lessons::Lesson;
use super::markup::{Piece, pieces};

/// Letters of a terminal: what is set apart is so by these, or not at all.
#[derive(Clone, Copy)]
struct Style {
    colored: bool,
}

/// A lecture as text of lines up to so many letters wide, coloured for terminals or not. Pictures are named as they are in
/// `folder`, if they are drawn.
pub fn told(lesson: &Lesson, lecture: &Lecture, width: usize, colored: bool, folder: Option<&str>) -> String {
    let style = Style { colored };
    let mut text = format!("{}\n", style.bold(lesson.title));
    text.push_str(&format!("{}\n", style.dim(lesson.source)));
    for part in &lecture.parts {
        text.push('\n');
        match part {
            Part::Heading(heading) => text.push_str(&format!("{}\n", style.bold(heading))),
            Part::Text(paragraph) => style.paragraph(&mut text, paragraph, width, ["", ""]),
            Part::Formula(formula) => text.push_str(&format!("    {formula}\n")),
            Part::Table(table) => style.table(&mut text, table),
            Part::Plates(plates) => {
                for plate in plates {
                    let file = folder.map(|folder| format!("`{folder}/{}-{}`: ", lesson.name, plate.name));
                    let words = format!("{}{}", file.unwrap_or_default(), plate.caption);
                    style.paragraph(&mut text, &words, width, ["  ▪ ", "    "]);
                }
            }
        }
    }
    text.push_str(&format!("\n{}\n", style.bold("Try")));
    if folder.is_none() && lecture.all_plates().next().is_some() {
        let command = format!("terrell teach {} --html -o {0}", lesson.name);
        text.push_str(&format!("  {}\n", style.code(&command)));
        style.paragraph(
            &mut text,
            "the pictures, plots and films that are named above, and a page with them",
            width,
            ["      ", "      "],
        );
    }
    for attempt in &lecture.tries {
        text.push_str(&format!("  {}\n", style.code(&attempt.command)));
        style.paragraph(&mut text, &attempt.shows, width, ["      ", "      "]);
    }
    text.push_str(&format!("\n{}\n", style.bold("A question")));
    style.paragraph(&mut text, &lecture.question.text, width, ["", ""]);
    text.push_str(&format!("  {}\n", style.code(&format!("terrell teach {} --answer", lesson.name))));
    text
}

/// What lessons there are, in lines up to so many letters wide.
pub fn listed(lessons: &[Lesson], width: usize) -> String {
    let style = Style { colored: false };
    let mut text = String::new();
    let room = " ".repeat(12);
    for Lesson { name, title, about, .. } in lessons {
        style.paragraph(&mut text, title, width, [&format!("{name:<12}"), &room]);
        style.paragraph(&mut text, about, width, [&room, &room]);
    }
    text
}

/// The answer to a lecture's question, as [`told`].
pub fn answer(lecture: &Lecture, width: usize, colored: bool) -> String {
    let style = Style { colored };
    let mut text = String::new();
    style.paragraph(&mut text, &lecture.question.text, width, ["", ""]);
    text.push('\n');
    style.paragraph(&mut text, &lecture.question.answer, width, ["", ""]);
    text
}

impl Style {
    fn set(self, code: &str, text: &str) -> String {
        if self.colored { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
    }

    fn bold(self, text: &str) -> String {
        self.set("1", text)
    }

    fn dim(self, text: &str) -> String {
        self.set("2", text)
    }

    fn code(self, text: &str) -> String {
        self.set("36", text)
    }

    /// Words in lines no longer than `width`, where words allow it; the first begins otherwise than the others.
    fn paragraph(self, to: &mut String, text: &str, width: usize, [first, other]: [&str; 2]) {
        let mut used = first.chars().count();
        to.push_str(first);
        let mut begun = false;
        for word in words(text) {
            let long: usize = word.iter().map(|piece| piece.text().chars().count()).sum();
            if begun {
                if used + 1 + long > width {
                    to.push('\n');
                    to.push_str(other);
                    used = other.chars().count();
                } else {
                    to.push(' ');
                    used += 1;
                }
            }
            for piece in word {
                to.push_str(&match piece {
                    Piece::Plain(text) => text.to_owned(),
                    Piece::Emphasis(text) => self.set("3", text),
                    Piece::Code(text) => self.code(text),
                });
            }
            (used, begun) = (used + long, true);
        }
        to.push('\n');
    }

    fn table(self, to: &mut String, table: &Table) {
        let all = || std::iter::once(&table.head).chain(&table.rows);
        let widths: Vec<usize> = (0..table.head.len())
            .map(|c| all().map(|row| row[c].chars().count()).max().unwrap_or(0))
            .collect();
        for (index, row) in all().enumerate() {
            let cells: Vec<String> = row
                .iter()
                .zip(&widths)
                .enumerate()
                .map(|(c, (cell, width))| {
                    let room = " ".repeat(width - cell.chars().count());
                    if c == 0 { format!("{cell}{room}") } else { format!("{room}{cell}") }
                })
                .collect();
            let line = format!("  {}", cells.join("   "));
            let line = line.trim_end();
            to.push_str(&if index == 0 { self.dim(line) } else { line.to_owned() });
            to.push('\n');
        }
    }
}

/// A paragraph's words, each of pieces that are not to be parted.
fn words(text: &str) -> Vec<Vec<Piece<'_>>> {
    let mut words: Vec<Vec<Piece<'_>>> = Vec::new();
    let mut open = false;
    for piece in pieces(text) {
        for (i, word) in piece.text().split(' ').enumerate() {
            if i > 0 {
                open = false;
            }
            if word.is_empty() {
                continue;
            }
            match words.last_mut().filter(|_| open) {
                Some(last) => last.push(piece.of(word)),
                None => words.push(vec![piece.of(word)]),
            }
            open = true;
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_no_wider_than_asked_and_marks_go() {
        let style = Style { colored: false };
        let mut text = String::new();
        style.paragraph(&mut text, "one *two three*, `four five` (*six*) seven", 12, ["> ", "  "]);
        assert_eq!(text, "> one two\n  three,\n  four five\n  (six)\n  seven\n");
        let mut colored = String::new();
        Style { colored: true }.paragraph(&mut colored, "a *b*.", 80, ["", ""]);
        assert_eq!(colored, "a \x1b[3mb\x1b[0m.\n");
    }

    #[test]
    fn columns_are_aligned() {
        let table = Table {
            head: vec!["β".into(), "D".into()],
            rows: vec![vec!["0.5".into(), "1.73".into()], vec!["0.99".into(), "14.1".into()]],
        };
        let mut text = String::new();
        Style { colored: false }.table(&mut text, &table);
        assert_eq!(text, "  β         D\n  0.5    1.73\n  0.99   14.1\n");
    }
}
