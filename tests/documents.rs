//! Documents: what they link to is there, and the book's contents have all of them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn documents() -> Vec<PathBuf> {
    let files = |folder: PathBuf| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let all = files(root().to_owned()).chain(files(root().join("docs")));
    all.filter(|path| path.extension().is_some_and(|e| e == "md")).collect()
}

/// Text without blocks of code.
fn prose(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap().split("```").step_by(2).collect()
}

/// Where links and pictures of a text lead to.
fn links(text: &str) -> impl Iterator<Item = &str> {
    text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).filter(|link| !link.contains("://"))
}

/// As browsers name them: small letters, hyphens, nothing else.
fn anchors(path: &Path) -> BTreeSet<String> {
    let text = prose(path);
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let letter = |c: char| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
        _ => None,
    };
    headings
        .map(|line| line.trim_start_matches('#').trim().to_lowercase().chars().filter_map(letter).collect())
        .collect()
}

#[test]
fn links_lead_somewhere() {
    let mut count = 0;
    for path in documents() {
        let text = prose(&path);
        for link in links(&text) {
            let (file, anchor) = link.split_once('#').map_or((link, None), |(f, a)| (f, Some(a)));
            let target = if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            assert!(target.exists(), "{}: {link}", path.display());
            if let Some(anchor) = anchor {
                assert!(anchors(&target).contains(anchor), "{}: {link}", path.display());
            }
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

/// A table without a head is shown as it is written.
#[test]
fn tables_have_heads() {
    for path in documents() {
        let text = prose(&path);
        let mut lines = text.lines().peekable();
        let mut within = false;
        while let Some(line) = lines.next() {
            let begins = line.starts_with('|') && !within;
            within = line.starts_with('|');
            assert!(
                !begins || lines.peek().is_some_and(|next| next.starts_with("|-")),
                "{}: {line}",
                path.display()
            );
        }
    }
}

#[test]
fn the_book_has_all_pages() {
    let docs = root().join("docs");
    let contents = prose(&docs.join("SUMMARY.md"));
    let listed: BTreeSet<&str> = links(&contents).collect();
    let pages: BTreeSet<String> = documents()
        .iter()
        .filter(|path| path.parent() == Some(&docs))
        .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
        .filter(|name| name != "SUMMARY.md")
        .collect();
    assert_eq!(pages.iter().map(String::as_str).collect::<BTreeSet<_>>(), listed);
    // A book's pages cannot lead out of it.
    for page in &pages {
        let text = prose(&docs.join(page));
        assert!(links(&text).all(|link| !link.starts_with("..")), "{page}");
    }
}
