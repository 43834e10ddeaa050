//! Where ways to compute fail, and that the planner does not go there.

mod common;

use common::{points, vec3};
use serde_json::Value;
use terrell::geodesic::{Celerity, Event, Real};
use terrell::measure::stability::{Map, Planner, Resolution, SHEETS, conditioning, seen};
use terrell::relativity::Motion;

fn sheet(name: &str) -> Vec<Map> {
    let sheet = SHEETS.iter().find(|sheet| sheet.name == name).unwrap();
    let maps = sheet.maps(Resolution::Quick);
    for map in &maps {
        let cells = map.x.len() * map.y.len();
        assert!(map.errors.len() == cells && map.planner.len() == cells, "{}", map.name);
        assert!(!map.words.is_empty());
        // What the whole is about.
        assert_eq!(map.faults(), Vec::<String>::new(), "{}", map.name);
    }
    maps
}

fn map<'a>(maps: &'a [Map], name: &str) -> &'a Map {
    maps.iter().find(|map| map.name == name).unwrap_or_else(|| panic!("{name}"))
}

#[test]
#[ignore = "prints all, for people"]
fn print() {
    for sheet in SHEETS {
        let start = std::time::Instant::now();
        let maps =
            sheet.maps(if std::env::var("QUICK").is_ok() { Resolution::Quick } else { Resolution::Usual });
        println!("=== {} {:.1} s", sheet.name, start.elapsed().as_secs_f64());
        for map in maps {
            println!("{} | {} | {}\n{}", map.name, map.title, map.quantity, map.words);
            let columns: Vec<String> = (0..map.x.len()).map(|i| format!("{:>8}", map.x.label(i))).collect();
            println!("{:>30} {}", map.x.name, columns.join(""));
            for row in (0..map.y.len()).rev() {
                let cells: Vec<String> = (0..map.x.len())
                    .map(|c| {
                        let cell = map.cell(c, row);
                        let mark = match (map.planner[cell], map.fails(cell)) {
                            (Planner::Enters, true) => "!",
                            (Planner::Enters, _) => "*",
                            (Planner::Warns, _) => "w",
                            _ => " ",
                        };
                        format!("{:>7.0e}{mark}", map.errors[cell])
                    })
                    .collect();
                println!("{:>30} {}", map.y.label(row), cells.join(""));
            }
            println!("faults: {:?}", map.faults());
        }
    }
}
