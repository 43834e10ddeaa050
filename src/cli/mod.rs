//! parse → run → report; a file a subcommand.

mod animate;
mod chart;
mod compare;
mod completions;
mod drawing;
mod explain;
mod locate;
mod look;
mod progress;
mod render;
mod report;
mod scenes;
mod shooting;
mod source;
mod stop;
mod summary;
mod teach;
mod transform;
mod values;
mod velocity;

use clap::{Parser, Subcommand};
use std::io::IsTerminal;
use std::process::ExitCode;

/// See relativistic motion: any mesh as it looks at any speed.
#[derive(Parser)]
#[command(name = "terrell", version, max_term_width = 100, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "Examples:
  terrell render cube                              the cube of Fig. 2, to cube.png
  terrell render statue.glb --beta 0.9             your own mesh, passing by at 0.9c
  terrell explain street                           what will be seen, when, by which method, and why
  terrell animate gate -o gate.mp4                 flying through a gate
  terrell render gate --color doppler -o gate.exr  float channels, Doppler factor included
  terrell transform statue.glb --beta 0.9          its apparent shape, for other programs
  terrell locate --beta 0.9,0,0 1,2,3              where one point is seen
  terrell compare street                           every method on one scene: differences and times
  terrell chart gate --beta 0.5,0.9                speed against accuracy, drawn
  terrell teach cube                               a lesson; with --html -o DIR, a page with pictures and films";

#[derive(Subcommand)]
enum Command {
    Render(render::Render),
    Animate(animate::Animate),
    Transform(transform::Transform),
    Locate(locate::Locate),
    Compare(Box<compare::Compare>),
    Chart(Box<chart::Chart>),
    Explain(Box<explain::Explain>),
    Scenes(scenes::Scenes),
    Teach(teach::Teach),
    Completions(completions::Completions),
}

/// What went wrong, told to people.
pub(crate) type Fault = Box<dyn std::error::Error + Send + Sync>;

/// The user's mistakes.
const MISTAKE: u8 = 2;
/// Everything else: a closed pipe, a full disk under standard output.
const FAILURE: u8 = 1;

pub(crate) fn run() -> ExitCode {
    let cli = match Cli::try_parse_from(std::env::args_os().map(values::shield_negative)) {
        Ok(cli) => cli,
        Err(e) => {
            // Help and version are no mistakes; a closed pipe under them is nobody's.
            let code = if e.use_stderr() { MISTAKE } else { 0 };
            let _ = e.print();
            return ExitCode::from(code);
        }
    };
    stop::watch();
    let done = match cli.command {
        Command::Render(render) => render.run(),
        Command::Animate(animate) => animate.run(),
        Command::Transform(transform) => transform.run(),
        Command::Locate(locate) => locate.run(),
        Command::Compare(compare) => compare.run(),
        Command::Chart(chart) => chart.run(),
        Command::Explain(explain) => explain.run(),
        Command::Scenes(scenes) => scenes.run(),
        Command::Teach(teach) => teach.run(),
        Command::Completions(completions) => completions.run(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            let closed = fault.downcast_ref::<std::io::Error>();
            // Who has read enough has no wish to hear of it.
            if closed.is_some_and(|e| e.kind() == std::io::ErrorKind::BrokenPipe) {
                return ExitCode::from(FAILURE);
            }
            eprintln!("{} {fault}", error_mark());
            ExitCode::from(if closed.is_some() { FAILURE } else { MISTAKE })
        }
    }
}

/// "error:", in red where there are colours.
fn error_mark() -> &'static str {
    if is_colored(&std::io::stderr()) { "\x1b[1;31merror:\x1b[0m" } else { "error:" }
}

/// Whether something is a terminal that has colours and whose user has not asked for none (NO_COLOR).
fn is_colored(to: &impl IsTerminal) -> bool {
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    !dumb && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty()) && to.is_terminal()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    /// Words as a shell makes them, up to where it is told of files and other programs.
    fn words(line: &str) -> Vec<String> {
        let mut words = vec![String::new()];
        let mut quoted = false;
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ' ' if !quoted => words.push(String::new()),
                c => words.last_mut().unwrap().push(c),
            }
        }
        words.into_iter().take_while(|word| word != "<" && word != ">").collect()
    }

    #[test]
    fn every_help_has_examples_and_they_are_commands() {
        let command = Cli::command();
        for part in command.get_subcommands().chain([&command]) {
            let name = part.get_name();
            let help = part.get_after_help().map(ToString::to_string).unwrap_or_default();
            let examples = help.lines().filter_map(|line| line.strip_prefix("  terrell "));
            // What is said of them begins after two spaces.
            let examples: Vec<_> =
                examples.filter_map(|line| line.split(['|', ';']).next()?.split("  ").next()).collect();
            assert!(help.starts_with("Examples:") && !examples.is_empty(), "{name}: {help}");
            for example in examples {
                let words = words(&format!("terrell {}", example.trim_end()));
                assert!(name == "terrell" || words[1] == name, "{name}: {words:?}");
                let shielded = words.iter().map(|word| values::shield_negative(word.into()));
                if let Err(e) = Cli::try_parse_from(shielded) {
                    panic!("{words:?}\n{e}");
                }
            }
        }
    }
}
