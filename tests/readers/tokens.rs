//! Text damaged token by token.

use proptest::prelude::*;
use proptest::sample::{Index, select};

/// What happens to a token.
#[derive(Clone, Debug)]
pub enum Change {
    Delete,
    Double,
    /// Becomes another one of the same text.
    Copy(Index),
    /// Both change places.
    Swap(Index),
    /// Becomes something nasty.
    Nasty(String),
    /// Something nasty comes before it.
    Insert(String),
}

/// One to six changes, each to the token of its index.
pub fn changes(nasty: &[&'static str]) -> impl Strategy<Value = Vec<(Index, Change)>> + use<> {
    let nasty = || select(nasty.to_vec()).prop_map(str::to_owned);
    let change = prop_oneof![
        Just(Change::Delete),
        Just(Change::Double),
        any::<Index>().prop_map(Change::Copy),
        any::<Index>().prop_map(Change::Swap),
        nasty().prop_map(Change::Nasty),
        nasty().prop_map(Change::Nasty),
        nasty().prop_map(Change::Insert),
    ];
    prop::collection::vec((any::<Index>(), change), 1..=6)
}

/// Words and numbers, and every other character by itself.
fn tokens(text: &str) -> Vec<String> {
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '.' | '-' | '+' | '_');
    let mut out: Vec<String> = Vec::new();
    let mut in_word = false;
    for c in text.chars() {
        match out.last_mut() {
            Some(last) if in_word && is_word(c) => last.push(c),
            _ => out.push(c.into()),
        }
        in_word = is_word(c);
    }
    out
}

/// The text after the changes.
pub fn changed(text: &str, changes: &[(Index, Change)]) -> String {
    let mut tokens = tokens(text);
    for (index, change) in changes {
        if tokens.is_empty() {
            break;
        }
        let at = index.index(tokens.len());
        match change {
            Change::Delete => drop(tokens.remove(at)),
            Change::Double => tokens.insert(at, tokens[at].clone()),
            Change::Copy(from) => tokens[at] = from.get(&tokens).clone(),
            Change::Swap(with) => {
                let with = with.index(tokens.len());
                tokens.swap(at, with);
            }
            Change::Nasty(other) => tokens[at].clone_from(other),
            Change::Insert(other) => tokens.insert(at, other.clone()),
        }
    }
    tokens.concat()
}

#[test]
fn tokens_are_the_whole_text() {
    let text = "[[body]]\nvelocity = [0.9, -1e5, 0]  # ü\n";
    assert_eq!(changed(text, &[]), text);
    assert!(tokens(text).contains(&"-1e5".to_owned()));
}
