//! Signs for single points that stay apart without colour.

use super::style::Role;
use super::svg::{Canvas, Paint};

/// The shape that marks a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    /// An oblique cross: an open-loop pole, an unstable point.
    Cross,
    /// An open circle: a zero.
    Ring,
    /// A small full circle: a point on a line.
    Dot,
    /// A full square: a closed-loop pole.
    Square,
    /// A full diamond: a crossing.
    Diamond,
    /// An open square: the worst of all.
    Frame,
    /// An upright cross: the critical point, the nominal gains.
    Plus,
    /// A full triangle: a peak.
    Triangle,
}

/// Colour and width (px) of a line.
#[derive(Clone, Copy)]
struct Pen {
    role: Role,
    width: f64,
}

/// Half the size of most signs (px).
const ARM: f64 = 4.2;

impl Sign {
    /// Draws the sign at `at`.
    pub(super) fn draw(self, canvas: &mut Canvas, at: (f64, f64), role: Role) {
        self.stroke(canvas, at, ARM, Pen { role, width: 1.7 });
    }

    /// Draws the sign with a light edge around it, for grounds of any colour; `arm` is half its size (px).
    pub(super) fn draw_on_data(self, canvas: &mut Canvas, at: (f64, f64), arm: f64) {
        self.stroke(canvas, at, arm, Pen { role: Role::Fixed(LIGHT), width: 4.4 });
        self.stroke(canvas, at, arm, Pen { role: Role::Fixed(DARK), width: 1.9 });
    }

    fn stroke(self, canvas: &mut Canvas, (x, y): (f64, f64), arm: f64, pen: Pen) {
        let Pen { role, width } = pen;
        let line = Paint::line(role, width);
        let solid = Paint::line(role, (width - 1.2).max(0.4)).filled(role);
        match self {
            Self::Cross => {
                let a = arm * 0.9;
                canvas.line((x - a, y - a), (x + a, y + a), &line);
                canvas.line((x - a, y + a), (x + a, y - a), &line);
            }
            Self::Plus => {
                let a = arm * 1.35;
                canvas.line((x - a, y), (x + a, y), &line);
                canvas.line((x, y - a), (x, y + a), &line);
            }
            Self::Ring => canvas.circle((x, y), arm, &line),
            Self::Dot => canvas.circle((x, y), 2.6, &solid),
            Self::Square => {
                canvas.rect(x - 0.76 * arm, y - 0.76 * arm, 1.52 * arm, 1.52 * arm, &solid)
            }
            Self::Frame => canvas.rect(x - arm, y - arm, 2.0 * arm, 2.0 * arm, &line),
            Self::Diamond => {
                let a = arm * 1.1;
                canvas.polyline(&[(x, y - a), (x + a, y), (x, y + a), (x - a, y)], true, &solid);
            }
            Self::Triangle => {
                let a = arm;
                let corners = [(x, y + 0.2 * a), (x - a, y - 1.4 * a), (x + a, y - 1.4 * a)];
                canvas.polyline(&corners, true, &solid);
            }
        }
    }
}

/// Colours of what is drawn on colours that carry data: the same in light and dark pages.
pub(super) const DARK: [u8; 3] = [26, 26, 26];
pub(super) const LIGHT: [u8; 3] = [255, 255, 255];
