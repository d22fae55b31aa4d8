//! Axes, signs, and the loops as block diagrams.

use crate::report::Paper;
use crate::report::templates::render;
use fspid_page::context;
use fspid_page::page::{Figure, PageSection};
use fspid_plot::diagrams;

/// Figs 1 to 3 of the paper, redrawn with the signs that hold here.
pub(super) fn section(_: &Paper<'_>) -> PageSection {
    let figures = vec![
        Figure::new(
            "figure-1-axes",
            diagrams::aircraft_axes(),
            "Fig. 1 redrawn: body axes and signs. A positive command of a controller turns the nose up; what a \
             positive elevator does is a property of the aircraft.",
        )
        .resting_on(&["A18"]),
        Figure::new(
            "figure-2-pitch-loop",
            diagrams::pitch_loop(),
            "Fig. 2 redrawn: the pitch loop with the servo, the reversal of sign that the 747 needs, and the inner \
             rate-gyro loop that Fig. 5 has and Figs 6 to 9 do not.",
        )
        .resting_on(&["A18", "A19"]),
        Figure::new(
            "figure-3-self-tuning-pid",
            diagrams::self_tuning_pid(),
            "Fig. 3 redrawn: the fuzzy self-tuning PID. The supervisor sees the scaled error and its change and moves \
             the three gains.",
        )
        .resting_on(&["A2", "A3", "A10"]),
    ];
    PageSection::of(
        "conventions",
        "Axes, signs and loops",
        render("conventions", context! { figures }),
    )
    .with_figures(figures)
}
