//! Body axes and signs of the aircraft.

use super::blocks::{TEXT_PX, arrow_in, note, signal};
use crate::page;
use crate::style::Role;
use crate::svg::{Anchor, Canvas, Font, Paint, Svg};

/// Pitch angle in the drawing (deg).
const PITCH_DEG: f64 = 13.0;
const PITCH: (f64, f64) = (0.224_951_054_343_865, 0.974_370_064_785_235);
/// Centre of gravity in the drawing.
const CENTRE: (f64, f64) = (222.0, 196.0);

/// Body axes, positive pitch, and the signs of elevator and command (Fig. 1).
#[must_use]
pub fn aircraft_axes() -> Svg {
    let title = "Axes and signs";
    let mut canvas = Canvas::new(760.0, 388.0);
    page::title(&mut canvas, title);
    aircraft(&mut canvas);
    angles(&mut canvas);
    let rows = [
        ("x_{b}", "forward; roll rate p, roll angle \u{3a6}"),
        ("y_{b}", "to starboard, out of the page; pitch rate q, pitch angle \u{3b8}"),
        ("z_{b}", "downwards; yaw rate r, yaw angle \u{3c8}"),
    ];
    for (n, (name, text)) in rows.iter().enumerate() {
        let y = 336.0 + n as f64 * 18.0;
        signal(&mut canvas, (24.0, y), Anchor::Start, name);
        note(&mut canvas, (48.0, y), Anchor::Start, text);
    }
    canvas.line((478.0, 48.0), (478.0, 372.0), &Paint::line(Role::Grid, 1.0));
    tail(
        &mut canvas,
        (630.0, 132.0),
        20.0,
        ["Elevator \u{3b4}_{e} > 0", "trailing edge down", "nose goes down"],
    );
    tail(
        &mut canvas,
        (630.0, 300.0),
        -20.0,
        ["Command u > 0", "trailing edge up, \u{3b4}_{e} < 0", "nose goes up"],
    );
    canvas.finish(
        title,
        "Side view of an aircraft, nose to the right and pitched up. The body axis x points forward, y to starboard out of the \
         page, z downwards; pitch angle and pitch rate are positive nose up. A positive elevator deflection is trailing edge \
         down and pitches the nose down; a positive command is nose up and moves the trailing edge up.",
    )
}

/// A point given in body axes (forward, down), turned by the pitch angle.
fn body(forward: f64, down: f64) -> (f64, f64) {
    let (s, c) = PITCH;
    (CENTRE.0 + forward * c + down * s, CENTRE.1 - forward * s + down * c)
}

/// A point at `radius` and at an angle above the horizon (deg).
fn polar(radius: f64, degrees: f64) -> (f64, f64) {
    let angle = degrees.to_radians();
    (CENTRE.0 + radius * series_cos(angle), CENTRE.1 - radius * series_sin(angle))
}

fn aircraft(canvas: &mut Canvas) {
    let ink = Paint::line(Role::Ink, 1.4).filled(Role::Face);
    canvas.begin_turn(-PITCH_DEG, CENTRE);
    canvas.begin_shift(CENTRE.0, CENTRE.1);
    // Fin, fuselage, window line, tailplane, wing and engine, in px forward and down of the centre.
    canvas.path("M-104 -19L-142 -72L-163 -72L-147 -12Z", &ink);
    canvas.path("M148 3C146 -8 126 -20 100 -21L-92 -21C-122 -19 -146 -14 -162 -9C-150 0 -112 17 -74 20L104 20C132 19 148 12 148 3Z", &ink);
    canvas.path(
        "M112 -11L127 -11L120 -17L110 -17Z",
        &Paint::line(Role::Ink, 1.0).filled(Role::Paper),
    );
    canvas.path("M92 -8L-96 -8", &Paint::line(Role::Muted, 2.4).dashed("2.4 5"));
    canvas.path("M-112 -6L-146 -13L-168 -13L-158 -8Z", &ink);
    canvas.path("M16 22C14 17 18 15 24 15L42 15C47 15 48 29 42 30L24 30C18 30 15 27 16 22Z", &ink);
    canvas.path("M48 8C44 4 36 4 28 6L-58 17L-50 19L20 15C36 14 46 12 48 8Z", &ink);
    canvas.end();
    canvas.end();
}

fn angles(canvas: &mut Canvas) {
    let (axis, arc) = (Role::Series(0), Role::Series(1));
    let horizon = Paint::line(Role::Muted, 1.0).dashed("6 4");
    canvas.line((CENTRE.0, CENTRE.1), (CENTRE.0 + 226.0, CENTRE.1), &horizon);
    note(canvas, (CENTRE.0 + 226.0, CENTRE.1 + 15.0), Anchor::End, "horizon");
    arrow_in(canvas, &[body(0.0, 0.0), body(224.0, 0.0)], axis, 1.8);
    arrow_in(canvas, &[body(0.0, 0.0), body(0.0, 104.0)], axis, 1.8);
    canvas.circle(CENTRE, 6.5, &Paint::line(axis, 1.8).filled(Role::Face));
    canvas.circle(CENTRE, 2.2, &Paint::face(axis));
    let (x, z) = (body(224.0, 0.0), body(0.0, 104.0));
    signal(canvas, (x.0 + 4.0, x.1 - 4.0), Anchor::Start, "x_{b}");
    signal(canvas, (z.0 + 10.0, z.1), Anchor::Start, "z_{b}");
    signal(canvas, (CENTRE.0 - 12.0, CENTRE.1 + 36.0), Anchor::End, "y_{b}");
    let sweep = |radius: f64, from: f64, to: f64| -> Vec<(f64, f64)> {
        (0..=16).map(|n| polar(radius, from + (to - from) * f64::from(n) / 16.0)).collect()
    };
    arrow_in(canvas, &sweep(190.0, 0.0, PITCH_DEG - 0.6), arc, 1.6);
    let theta = polar(199.0, PITCH_DEG / 2.0);
    signal(canvas, (theta.0, theta.1 + 5.0), Anchor::Start, "\u{3b8}");
    arrow_in(canvas, &sweep(170.0, 20.0, 46.0), arc, 1.6);
    let q = polar(176.0, 46.0);
    signal(canvas, (q.0 - 4.0, q.1 - 8.0), Anchor::Middle, "q");
    note(canvas, (q.0 + 8.0, q.1 - 8.0), Anchor::Start, "positive: nose up");
}

/// A section of the tail with the elevator turned trailing edge down by `down_deg`.
fn tail(canvas: &mut Canvas, (x, y): (f64, f64), down_deg: f64, text: [&str; 3]) {
    let ink = Paint::line(Role::Ink, 1.4).filled(Role::Face);
    canvas.text(498.0, y - 62.0, text[0], Font::new(TEXT_PX, Anchor::Start).bold());
    note(canvas, (498.0, y - 45.0), Anchor::Start, text[1]);
    canvas.line((x - 112.0, y), (x + 96.0, y), &Paint::line(Role::Muted, 1.0).dashed("6 4"));
    canvas.begin_shift(x, y);
    canvas.path("M-14 -11C12 -16 74 -15 80 0C74 15 12 16 -14 11Z", &ink);
    canvas.begin_turn(-down_deg, (-14.0, 0.0));
    canvas.path("M-14 -10.5A10.5 10.5 0 0 1 -14 10.5L-96 1L-96 -1Z", &ink);
    canvas.end();
    canvas.circle((-14.0, 0.0), 2.2, &Paint::face(Role::Ink));
    // The deflection, from the chord line to the elevator.
    let side = if down_deg > 0.0 { 1.0 } else { -1.0 };
    let tip: Vec<(f64, f64)> = (0..=12)
        .map(|n| {
            let angle = f64::from(n) / 12.0 * (down_deg.abs() - 2.0);
            (
                -14.0 - 92.0 * series_cos(angle.to_radians()),
                side * 92.0 * series_sin(angle.to_radians()),
            )
        })
        .collect();
    arrow_in(canvas, &tip, Role::Series(1), 1.6);
    // The force on the tail is opposite to the deflection.
    arrow_in(canvas, &[(30.0, -side * 20.0), (30.0, -side * 52.0)], Role::Series(0), 2.2);
    canvas.end();
    note(canvas, (x + 40.0, y - side * 42.0 + 4.0), Anchor::Start, "tail force");
    note(canvas, (x + 96.0, y + side * 32.0 + 4.0), Anchor::End, text[2]);
}

/// Cosine by its series, for the same bits on every machine; good to 1e-9 below a right angle.
fn series_cos(angle: f64) -> f64 {
    let square = angle * angle;
    (1..=8).rev().fold(1.0, |sum, n| 1.0 - square * sum / f64::from((2 * n - 1) * (2 * n)))
}

/// Sine by its series; see [`series_cos`].
fn series_sin(angle: f64) -> f64 {
    let square = angle * angle;
    angle * (1..=8).rev().fold(1.0, |sum, n| 1.0 - square * sum / f64::from((2 * n) * (2 * n + 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_agree_with_the_library_functions() {
        for degrees in [0.0_f64, 1.0, 13.0, 46.0, 90.0] {
            let angle = degrees.to_radians();
            assert!((series_cos(angle) - angle.cos()).abs() < 1e-9);
            assert!((series_sin(angle) - angle.sin()).abs() < 1e-9);
        }
        assert!((PITCH.0 - PITCH_DEG.to_radians().sin()).abs() < 1e-12);
    }

    #[test]
    fn the_body_axis_points_above_the_horizon() {
        assert!(body(100.0, 0.0).1 < CENTRE.1);
        assert!(body(0.0, 100.0).1 > CENTRE.1);
    }
}
