//! `locate`: numbers in, numbers out, and what it refuses.

#[path = "common/assertion.rs"]
mod assertion;
mod common;

use assert_cmd::Command;
use assertion::{folder, refused, terrell};
use common::{cases, points, vec3};

fn csv(output: &[u8]) -> Vec<Vec<Option<f64>>> {
    let text = String::from_utf8(output.to_vec()).unwrap();
    let mut lines = text.lines();
    assert_eq!(
        lines.next().unwrap(),
        "x,y,z,apparent_x,apparent_y,apparent_z,distance,doppler,cos_theta_rest,cos_theta_observer,emission_time,color_temperature"
    );
    lines
        .map(|line| {
            line.split(',')
                .map(|field| if field.is_empty() { None } else { Some(field.parse().unwrap()) })
                .collect()
        })
        .collect()
}

fn list(values: &serde_json::Value) -> String {
    let numbers: Vec<String> =
        values.as_array().unwrap().iter().map(|v| format!("{:?}", v.as_f64().unwrap())).collect();
    numbers.join(",")
}

/// The face by which others check us: every reference point, as an argument and as CSV, there and back.
#[test]
fn locate_agrees_with_the_references() {
    let folder = folder();
    let all: Vec<_> =
        points().into_iter().chain(cases()["points"].as_array().unwrap().iter().cloned()).collect();
    for row in all.iter().step_by(3) {
        let base = [
            "locate",
            "--celerity",
            &list(&row["u"]),
            "--offset",
            &list(&row["A"]),
            "--observer",
            &list(&row["O"]),
        ];
        let output = terrell(folder.path(), &[&base[..], &[&list(&row["x_rest"])]].concat())
            .success()
            .get_output()
            .stdout
            .clone();
        let fields = csv(&output).remove(0);
        let number = |i: usize| fields[i].unwrap();
        let r = row["r"].as_f64().unwrap();
        let condition = row["condition"]
            .as_f64()
            .or(row["cond_1ulp"].as_f64().map(|c| c / f64::EPSILON))
            .unwrap()
            .max(1.0);
        let apparent = glam::DVec3::new(number(3), number(4), number(5));
        assert!((apparent - vec3(&row["apparent"])).length() <= 5e-16 * condition * r);
        assert!((number(6) / r - 1.0).abs() <= 5e-16 * condition);
        assert!((number(7) / row["D"].as_f64().unwrap() - 1.0).abs() <= 1e-15 * condition);
        let observer_time = row["O"][0].as_f64().unwrap();
        assert!((number(10) - (observer_time - r)).abs() <= 1e-15 * (r + observer_time.abs()) * condition);
        let direction = vec3(&row["u"]).normalize();
        assert!((number(9) - vec3(&row["apparent"]).dot(direction) / r).abs() <= 2e-15 * condition);

        let back = terrell(
            folder.path(),
            &[&base[..], &["--inverse", &format!("{:?},{:?},{:?}", number(3), number(4), number(5))]]
                .concat(),
        );
        let back = csv(&back.success().get_output().stdout).remove(0);
        let x_rest = vec3(&row["x_rest"]);
        let again = glam::DVec3::new(back[0].unwrap(), back[1].unwrap(), back[2].unwrap());
        // As the library's own test of the inverse has it.
        let (d, cos) = (number(7), number(9));
        let feels = 1.0 + d + vec3(&row["u"]).length() * d * (1.0 - cos * cos).max(0.0).sqrt();
        let off = (again - x_rest).length() / (r / d + x_rest.length());
        assert!(off <= 8.0 * f64::EPSILON * feels, "{}: {off:e}", row["kind"]);
    }
}

#[test]
fn locate_reads_csv_and_negative_numbers() {
    let folder = folder();
    let arguments = ["locate", "--beta", "-0.9,0,0", "-1,-2,3", "-.5,0,0"];
    let direct = terrell(folder.path(), &arguments).success().get_output().stdout.clone();
    let piped = Command::cargo_bin("terrell")
        .unwrap()
        .args(["locate", "--beta", "-0.9,0,0"])
        .write_stdin("x,y,z\n-1,-2,3\n\n -.5, 0, 0\r\n")
        .assert()
        .success()
        .get_output()
        .stdout
        .clone();
    assert_eq!(direct, piped);
    let rows = csv(&direct);
    assert_eq!(rows.len(), 2);
    assert!(rows[0].iter().all(Option::is_some));
    // 17 significant digits
    let text = String::from_utf8(direct).unwrap();
    let digits = text
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .nth(3)
        .unwrap()
        .split('e')
        .next()
        .unwrap()
        .chars()
        .filter(char::is_ascii_digit);
    assert_eq!(digits.count(), 17);
}

#[test]
fn fields_without_meaning_are_empty() {
    let folder = folder();
    let at = |arguments: &[&str]| {
        csv(&terrell(folder.path(), &[&["locate"], arguments].concat()).success().get_output().stdout)
            .remove(0)
    };
    let rest = at(&["--beta", "0,0,0", "1,2,2"]);
    assert_eq!(rest[3..8], [Some(1.0), Some(2.0), Some(2.0), Some(3.0), Some(1.0)]);
    assert_eq!(rest[8..], [None, None, Some(-3.0), Some(6504.0)]);
    let here = at(&["--beta", "0.5,0,0", "0,0,0"]);
    assert_eq!(here[6..], [Some(0.0), None, None, None, Some(0.0), None]);
    // Receding at 0.6c a black body of 6000 K is seen as one of 3000 K.
    let cold = at(&["--beta", "0.6,0,0", "--temperature", "6000", "5,0,0"]);
    assert!((cold[11].unwrap() - 3000.0).abs() < 1e-9, "{cold:?}");
}

#[test]
fn locate_refuses_what_makes_no_sense() {
    let folder = folder();
    for (arguments, parts) in [
        (&["locate", "1,2,3"][..], &["velocity"][..]),
        (&["locate", "--beta", "0.5,0,0", "1,2"], &["1,2", "2 numbers"]),
        (&["locate", "--beta", "0.5,0,0", "1,2,x"], &["'x'"]),
        (&["locate", "--beta", "0.5,0,0", "--offset", "1,2,3", "1,2,3"], &["T,X,Y,Z"]),
        (&["locate", "--beta", "1,0,0", "1,2,3"], &["not below 1"]),
        (&["locate", "--beta", "0.5,0,0", "1e200,2,3"], &["1e200"]),
        (&["locate", "--gamma", "2", "--celerity", "1,0,0", "1,2,3"], &["--celerity"]),
    ] {
        refused(folder.path(), arguments, parts);
    }
    for (input, part) in [
        ("", "empty"),
        ("a,b,c\n1,2,3\n", "line 1"),
        ("x,y,z\n1,2,3\n1,2\n", "line 3"),
        ("x,y,z\n1,2,inf\n", "line 2"),
    ] {
        let output = Command::cargo_bin("terrell")
            .unwrap()
            .args(["locate", "--beta", "0.5"])
            .write_stdin(input)
            .assert()
            .code(2)
            .get_output()
            .clone();
        assert!(String::from_utf8(output.stderr).unwrap().contains(part), "{input:?}");
    }
}
