use crate::drawing::text;

/// Breaks a text between words so that no line is wider than `room`, if no word is.
pub(super) fn wrapped(text: &str, em: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if !line.is_empty() && text::width(&longer, em) > room {
                lines.push(std::mem::replace(&mut line, word.to_owned()));
            } else {
                line = longer;
            }
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_between_words_and_keep_them_all() {
        let text = "one two three four five six seven\neight";
        let lines = wrapped(text, 10.0, 80.0);
        assert!(lines.len() > 3 && lines.iter().all(|line| text::width(line, 10.0) <= 80.0), "{lines:?}");
        assert_eq!(lines.join(" "), text.replace('\n', " "));
        assert_eq!(lines.last().unwrap(), "eight");
        assert_eq!(wrapped("incomprehensibilities", 10.0, 20.0).len(), 1);
    }
}
