//! OBJ and MTL written by a grammar: statements in any order, with indices and numbers as they should not be.

use super::tokens::{changed, changes};
use super::{MTL, OBJ, cases, judge};
use proptest::prelude::*;
use proptest::sample::select;
use terrell::scene::import_obj;

const NASTY: [&str; 40] = [
    "v",
    "vt",
    "vn",
    "f",
    "l",
    "p",
    "usemtl",
    "mtllib",
    "newmtl",
    "Kd",
    "map_Kd",
    "o",
    "g",
    "s",
    "vp",
    "curv",
    "#",
    "\\\n",
    "\\",
    "/",
    "//",
    "\n",
    "\r\n",
    "\r",
    "\t",
    "0",
    "-1",
    "-5",
    "-6",
    "5",
    "6",
    "4294967296",
    "18446744073709551616",
    "-9223372036854775808",
    "nan",
    "inf",
    "1e999",
    "1e99",
    "1e-320",
    "\u{feff}",
];

fn number() -> impl Strategy<Value = String> {
    let odd = vec![
        "nan", "inf", "-inf", "1e308", "1e49", "1e-60", "-0", "1e", ".", "+1", "1e-320", "x", "0x1", "1_0",
        "٣",
    ];
    prop_oneof![30 => (-9..10i32).prop_map(|n| format!("{}", 0.5 * f64::from(n))), 1 => select(odd).prop_map(str::to_owned)]
}

fn index() -> impl Strategy<Value = String> {
    let odd = vec![
        "",
        "0",
        "9",
        "-9",
        "4294967296",
        "-4294967296",
        "18446744073709551615",
        "-9223372036854775808",
        "1.0",
        "+1",
        "x",
    ];
    prop_oneof![20 => (1..5i32).prop_map(|i| i.to_string()), 10 => (-4..0i32).prop_map(|i| i.to_string()), 1 => select(odd).prop_map(str::to_owned)]
}

fn corner() -> impl Strategy<Value = String> {
    prop_oneof![
        index(),
        (index(), index()).prop_map(|(v, t)| format!("{v}/{t}")),
        (index(), index()).prop_map(|(v, n)| format!("{v}//{n}")),
        (index(), index(), index()).prop_map(|(v, t, n)| format!("{v}/{t}/{n}")),
    ]
}

fn statement() -> impl Strategy<Value = String> {
    let numbers = |most: usize| prop::collection::vec(number(), 0..=most).prop_map(|n| n.join(" "));
    let whole = |n: usize| prop::collection::vec(number(), n).prop_map(|n| n.join(" "));
    let name = || select(vec!["", "red", "blue", "a b", "ü", "\"", "a.mtl a.mtl"]);
    let keyword = select(vec![
        "usemtl",
        "mtllib",
        "o",
        "g",
        "s",
        "l",
        "p",
        "mg",
        "vp",
        "call",
        "newmtl",
        "Kd",
        "F",
        "#",
        "fo",
        "trace_obj",
    ]);
    prop_oneof![
        6 => whole(3).prop_map(|n| format!("v {n}")),
        2 => whole(6).prop_map(|n| format!("v {n}")),
        1 => numbers(9).prop_map(|n| format!("v {n}")),
        2 => whole(2).prop_map(|n| format!("vt {n}")),
        1 => numbers(4).prop_map(|n| format!("vt {n}")),
        2 => whole(3).prop_map(|n| format!("vn {n}")),
        1 => numbers(4).prop_map(|n| format!("vn {n}")),
        8 => prop::collection::vec((1..5i32).prop_map(|i| i.to_string()), 3..5).prop_map(|c| format!("f {}", c.join(" "))),
        4 => prop::collection::vec(corner(), 0..6).prop_map(|c| format!("f {}", c.join(" "))),
        1 => prop::collection::vec(1..5i32, 0..400).prop_map(|c| format!("f {}", c.iter().map(|i| format!(" {i}")).collect::<String>())),
        3 => (keyword, name()).prop_map(|(k, n)| format!("{k} {n}")),
    ]
}

/// Four vertices, texture coordinates and normals; statements; line ends and continuations as they come.
fn file() -> impl Strategy<Value = String> {
    let start = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\nvn 0 0 -1\n";
    let end = select(vec![
        "\n", "\n", "\n", "\n", "\r\n", " # why\n", " \\\n", "\\\n", "\\\r\n", "\\\n\\\n", "\r", "", "\u{b}",
    ]);
    (any::<bool>(), prop::collection::vec((statement(), end), 1..20)).prop_map(move |(started, lines)| {
        let lines = lines.into_iter().flat_map(|(line, end)| [line, end.to_owned()]);
        [if started { start } else { "" }.to_owned()].into_iter().chain(lines).collect()
    })
}

fn library() -> impl Strategy<Value = String> {
    let key = select(vec![
        "newmtl",
        "newmtl red",
        "newmtl blue",
        "newmtl red",
        "Kd",
        "Ka",
        "Ks",
        "Ke",
        "d",
        "Tr",
        "Ns",
        "Ni",
        "illum",
        "map_Kd",
        "map_Kd -s",
        "Kd spectral",
        "Kd xyz",
        "Pr",
        "bump",
        "\\",
        "#",
        "\t",
        "usemtl",
    ]);
    let line =
        (key, prop::collection::vec(number(), 0..5)).prop_map(|(k, n)| format!("{k} {}\n", n.join(" ")));
    prop::collection::vec(line, 0..12).prop_map(|lines| lines.concat())
}

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn any_statements(obj in file(), mtl in library()) {
        judge(obj.len() + mtl.len(), || import_obj(&obj, &mtl, "a.obj"));
    }

    #[test]
    fn other_tokens(changes in changes(&NASTY), in_library: bool) {
        let (obj, mtl) = if in_library { (OBJ.to_owned(), changed(MTL, &changes)) } else { (changed(OBJ, &changes), MTL.to_owned()) };
        judge(obj.len() + mtl.len(), || import_obj(&obj, &mtl, "a.obj"));
    }
}

/// What costs most for its length.
#[test]
fn however_long() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for text in [
        "\n".repeat(100_000),
        "\\\n".repeat(100_000),
        format!("{start}f{}\n", " 1 2 3".repeat(50_000)),
        format!("{start}f{}\n", " 1 2 3 1 3 2".repeat(20_000)),
        // Many, each just small enough to be cut with care.
        format!("{start}{}", format!("f{}\n", " 1 2 3".repeat(99)).repeat(10)),
        format!("{start}{}", "f 1 2 3\n".repeat(50_000)),
        format!("{start}{}", "g\nf 1 2 3\n".repeat(20_000)),
        format!("{start}{}", "usemtl a\nf 1 2 3\n".repeat(20_000)),
        format!("{start}f 1 2 {}3\n", "\\\n".repeat(50_000)),
        format!("{}f 1 2 3\n", "v 0 0 1\nv 0 1 0 0 1 0\n".repeat(20_000)),
        format!("{start}f 1 2 3\n{}", "x".repeat(300_000)),
        format!("{start}f 1 2 3\nv {}", "9".repeat(300_000)),
    ] {
        judge(text.len(), || import_obj(&text, MTL, "a.obj"));
    }
    // A library named a thousand times is still one.
    let library: String = (0..1000).map(|i| format!("newmtl m{i}\nKd 1 0 0\n")).collect();
    let text = format!("{}{start}f 1 2 3\n", "mtllib a.mtl\n".repeat(1000));
    judge(text.len() + library.len(), || import_obj(&text, &library, "a.obj"));
}
