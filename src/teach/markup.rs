//! Paragraphs with `*emphasis*` and `` `code` ``.

/// A piece of a paragraph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Piece<'a> {
    Plain(&'a str),
    Emphasis(&'a str),
    Code(&'a str),
}

impl<'a> Piece<'a> {
    /// What it says.
    pub(super) fn text(self) -> &'a str {
        match self {
            Self::Plain(text) | Self::Emphasis(text) | Self::Code(text) => text,
        }
    }

    /// Another text of its kind.
    pub(super) fn of(self, text: &'a str) -> Self {
        match self {
            Self::Plain(_) => Self::Plain(text),
            Self::Emphasis(_) => Self::Emphasis(text),
            Self::Code(_) => Self::Code(text),
        }
    }
}

/// The pieces of a paragraph. A mark without another one like it stands for itself.
pub(super) fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find(['*', '`']) {
        let mark = rest.as_bytes()[at] as char;
        let Some(length) = rest[at + 1..].find(mark) else { break };
        if at > 0 {
            pieces.push(Piece::Plain(&rest[..at]));
        }
        let inside = &rest[at + 1..at + 1 + length];
        pieces.push(if mark == '*' { Piece::Emphasis(inside) } else { Piece::Code(inside) });
        rest = &rest[at + length + 2..];
    }
    if !rest.is_empty() {
        pieces.push(Piece::Plain(rest));
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_come_in_pairs() {
        use Piece::{Code, Emphasis, Plain};
        assert_eq!(
            pieces("a *b* `c*d` e"),
            [Plain("a "), Emphasis("b"), Plain(" "), Code("c*d"), Plain(" e")]
        );
        assert_eq!(pieces("2 * 3"), [Plain("2 * 3")]);
        assert_eq!(pieces(""), []);
    }
}
