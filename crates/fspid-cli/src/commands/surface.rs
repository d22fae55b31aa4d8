//! `fspid surface`: a fuzzy system, drawn.

use clap::Args;

use super::{Format, Inputs, Which, drawings, json_text};
use crate::argument::{Drawings, OutFile, count, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_scenario::count as counts;
use fspid_study::fuzzy_system::{SliceQuestion, slice};
use fspid_study::output;

/// Draw the outputs of a fuzzy system over two of its inputs, or over its only one.
///
/// An input that is given a value stays there; another one that is not drawn along stays in the middle of its range.
/// Without --out the drawing of the one output goes to standard output.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    which: Which,
    /// The input to the right; the first one if left out.
    #[arg(long, value_name = "NAME")]
    x: Option<String>,
    /// The input to the back; the next one if left out.
    #[arg(long, value_name = "NAME")]
    y: Option<String>,
    #[command(flatten)]
    inputs: Inputs,
    /// The range over which an input is drawn; that of the file if left out.
    #[arg(long, value_name = "NAME=LOWER..UPPER", allow_hyphen_values = true)]
    span: Vec<String>,
    /// The output; all of them if left out.
    #[arg(long, value_name = "NAME")]
    output: Option<String>,
    /// Nodes along each input.
    #[arg(long, value_name = "N", value_parser = count::<usize>(&counts::NODES))]
    nodes: Option<usize>,
    /// The drawing, or the folder for one drawing an output.
    #[arg(long, value_name = "FILE.svg or FOLDER")]
    out: Option<Drawings>,
    /// Write the values at all nodes to this file; `-` is standard output.
    #[arg(value_parser = written(&["csv"]), long, value_name = "FILE.csv")]
    csv: Option<OutFile>,
    /// How the answer on standard output is written where no file is named: the drawing, or the values at all nodes.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let system = arguments.which.load()?;
    let fixed = arguments.inputs.texts();
    let question = SliceQuestion {
        x: arguments.x.as_deref(),
        y: arguments.y.as_deref(),
        fixed: &fixed,
        spans: &arguments.span,
        output: arguments.output.as_deref(),
        nodes: arguments.nodes,
    };
    let slice = slice(&system, &question).map_err(Failure::input)?;
    slice.remarks().iter().for_each(|remark| note(format_args!("warning: {remark}")));
    if let Some(path) = &arguments.csv {
        output::write(path, slice.csv())?;
        wrote(path);
    }
    let figures = slice.figures();
    let named = figures.iter().map(|(name, svg)| (*name, svg.as_str()));
    if arguments.format == Format::Json {
        if let Some(path) = &arguments.out {
            drawings::write(path, named.collect())?;
        }
        return print(&json_text(&slice.json()));
    }
    match (&arguments.out, figures.as_slice()) {
        (Some(path), _) => drawings::write(path, named.collect()),
        (None, _) if arguments.csv.is_some() => Ok(()),
        (None, [(_, svg)]) => print(svg.as_str()),
        (None, _) => {
            let names: Vec<&str> = named.map(|(name, _)| name).collect();
            let names = names.join(", ");
            Err(Failure::input(format_args!(
                "there are several outputs ({names}); add --out FOLDER, or --output NAME"
            )))
        }
    }
}
