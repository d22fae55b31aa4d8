//! Poles and zeros of loops in the plane of z.

use super::chart::Chart;
use super::z_plane::{self, ZPlane};
use crate::page::{Entry, Swatch};
use crate::sign::Sign;
use crate::style::Role;
use crate::svg::{Canvas, Svg};

/// Poles and zeros of an open loop and the poles of the closed one.
#[derive(Debug, Clone, PartialEq)]
pub struct PoleZeroMap {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Sample period (s), for the grid of damping ratios and natural frequencies.
    pub dt_s: f64,
    /// Poles of the open loop: real and imaginary part.
    pub open_poles: Vec<(f64, f64)>,
    /// Zeros of the open loop.
    pub open_zeros: Vec<(f64, f64)>,
    /// Poles of the closed loop; those not inside the unit circle have a sign of their own.
    pub closed_poles: Vec<(f64, f64)>,
}

impl PoleZeroMap {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let plane = ZPlane {
            title: &self.title,
            legend: self.entries(),
            dt_s: self.dt_s,
            poles: self.closed_poles.clone(),
            description: self.describe(),
        };
        plane.render(|canvas, chart| self.draw(canvas, chart))
    }

    fn draw(&self, canvas: &mut Canvas, chart: &mut Chart) {
        let (unstable, stable): (Vec<_>, Vec<_>) =
            self.closed_poles.iter().partition(|(x, y)| !(libm::hypot(*x, *y) < 1.0));
        let groups = [
            (self.open_poles.as_slice(), Sign::Cross, Role::Ink),
            (self.open_zeros.as_slice(), Sign::Ring, Role::Ink),
            (stable.as_slice(), Sign::Square, CLOSED),
            (unstable.as_slice(), Sign::Diamond, UNSTABLE),
        ];
        z_plane::signs(canvas, chart, &groups);
    }

    fn unstable(&self) -> usize {
        self.closed_poles.iter().filter(|(x, y)| !(libm::hypot(*x, *y) < 1.0)).count()
    }

    fn entries(&self) -> Vec<Entry> {
        let entry = |name: &str, sign, role| Entry {
            name: name.to_owned(),
            swatch: Swatch::Sign(sign, role),
        };
        let mut entries = vec![
            entry("open-loop poles", Sign::Cross, Role::Ink),
            entry("open-loop zeros", Sign::Ring, Role::Ink),
            entry("closed-loop poles", Sign::Square, CLOSED),
        ];
        if self.unstable() > 0 {
            entries.push(entry("closed-loop poles, UNSTABLE", Sign::Diamond, UNSTABLE));
        }
        entries
    }

    fn describe(&self) -> String {
        format!(
            "Poles and zeros in the z plane: {} open-loop poles, {} zeros, {} closed-loop poles, {} of these not \
             inside the unit circle.",
            self.open_poles.len(),
            self.open_zeros.len(),
            self.closed_poles.len(),
            self.unstable()
        )
    }
}

const CLOSED: Role = Role::Series(0);
const UNSTABLE: Role = Role::Series(1);
