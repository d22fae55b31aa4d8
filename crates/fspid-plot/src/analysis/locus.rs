//! Closed-loop poles over the loop gain.

use super::chart::{Chart, distance};
use super::clip::Point;
use super::z_plane::{self, ZPlane};
use crate::axis::short_number;
use crate::page::{Entry, Swatch};
use crate::sign::Sign;
use crate::style::{Role, SeriesStyle};
use crate::svg::{Canvas, Svg};

/// The poles of a sampled loop in the plane of $z$ while its gain is multiplied by a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct RootLocus {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Sample period (s), for the grid of damping ratios and natural frequencies.
    pub dt_s: f64,
    /// Poles per factor, in ascending order of the factor and so dense that no pole jumps.
    pub samples: Vec<LocusSample>,
    /// Poles at factor 1: real and imaginary part.
    pub poles_at_one: Vec<(f64, f64)>,
    /// Poles of the open loop, where the lines begin.
    pub open_poles: Vec<(f64, f64)>,
    /// Zeros of the open loop, where lines end.
    pub open_zeros: Vec<(f64, f64)>,
    /// Where lines cross the unit circle; drawn with the factor.
    pub crossings: Vec<Crossing>,
}

/// The poles at one factor.
#[derive(Debug, Clone, PartialEq)]
pub struct LocusSample {
    /// What the loop gain is multiplied by.
    pub factor: f64,
    /// Real and imaginary parts, in any order.
    pub poles: Vec<(f64, f64)>,
}

/// A crossing of the unit circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// What the loop gain is multiplied by there.
    pub factor: f64,
    /// Real and imaginary part.
    pub at: (f64, f64),
}

/// A pole that moves farther than this between two samples is not joined by a line.
const JUMP: f64 = 0.25;

const BELOW: SeriesStyle = SeriesStyle::Numbered(1);
const ABOVE: SeriesStyle = SeriesStyle::Numbered(0);

impl RootLocus {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let branches = self.branches();
        let plane = ZPlane {
            title: &self.title,
            legend: entries(),
            dt_s: self.dt_s,
            poles: self.poles_at_one.clone(),
            description: self.describe(),
        };
        plane.render(|canvas, chart| self.draw(canvas, chart, &branches))
    }

    fn draw(&self, canvas: &mut Canvas, chart: &mut Chart, branches: &[Branch]) {
        for branch in branches {
            chart.curve(canvas, branch.points.iter().copied(), branch.style);
        }
        let groups = [
            (self.open_poles.as_slice(), Sign::Cross, Role::Ink),
            (self.open_zeros.as_slice(), Sign::Ring, Role::Ink),
            (self.poles_at_one.as_slice(), Sign::Square, Role::Ink),
        ];
        z_plane::signs(canvas, chart, &groups);
        for crossing in &self.crossings {
            chart.sign(canvas, crossing.at, Sign::Diamond, Role::Series(3));
        }
        for crossing in &self.crossings {
            let text = format!("\u{d7}{}", short_number(crossing.factor));
            chart.label(canvas, crossing.at, &text, Role::Ink);
        }
    }

    /// Lines of single poles: each sample's poles are joined to the nearest ones of the sample before.
    fn branches(&self) -> Vec<Branch> {
        let mut done: Vec<Branch> = Vec::new();
        let mut open: Vec<Branch> = Vec::new();
        for sample in &self.samples {
            let style = if sample.factor <= 1.0 { BELOW } else { ABOVE };
            let mut free = sample.poles.clone();
            let mut next = Vec::new();
            for (mut branch, pole) in matched(open, &mut free, &mut done) {
                branch.points.push(pole);
                if branch.style != style {
                    // The line goes on in another style from where it is.
                    next.push(Branch { style, points: vec![pole] });
                    done.push(branch);
                } else {
                    next.push(branch);
                }
            }
            next.extend(free.into_iter().map(|pole| Branch { style, points: vec![pole] }));
            open = next;
        }
        done.extend(open);
        done.retain(|branch| branch.points.len() > 1);
        done
    }

    fn describe(&self) -> String {
        let crossing = |c: &Crossing| {
            let (re, im) = (short_number(c.at.0), short_number(c.at.1));
            format!("factor {} at {re}, {im}", short_number(c.factor))
        };
        let all: Vec<String> = self.crossings.iter().map(crossing).collect();
        let crossings = if all.is_empty() { "none".to_owned() } else { all.join("; ") };
        format!(
            "Closed-loop poles in the z plane over the loop gain, {} at factor 1. Crossings of the unit circle: {crossings}.",
            self.poles_at_one.len()
        )
    }
}

/// A part of a line.
struct Branch {
    style: SeriesStyle,
    points: Vec<Point>,
}

/// Pairs branches with poles, the nearest first; poles without a branch stay in `free`, branches
/// without a pole are done.
fn matched(
    open: Vec<Branch>,
    free: &mut Vec<Point>,
    done: &mut Vec<Branch>,
) -> Vec<(Branch, Point)> {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (b, branch) in open.iter().enumerate() {
        let last = branch.points.last().copied().unwrap_or((f64::NAN, f64::NAN));
        for (p, pole) in free.iter().enumerate() {
            pairs.push((distance(last, *pole), b, p));
        }
    }
    pairs.retain(|pair| pair.0 < JUMP);
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pole_of: Vec<Option<usize>> = vec![None; open.len()];
    let mut used = vec![false; free.len()];
    for (_, b, p) in pairs {
        if pole_of[b].is_none() && !used[p] {
            pole_of[b] = Some(p);
            used[p] = true;
        }
    }
    let mut found = Vec::new();
    for (branch, pole) in open.into_iter().zip(pole_of) {
        match pole.and_then(|p| free.get(p)) {
            Some(&pole) => found.push((branch, pole)),
            None => done.push(branch),
        }
    }
    let mut n = 0;
    free.retain(|_| {
        n += 1;
        !used[n - 1]
    });
    found
}

fn entries() -> Vec<Entry> {
    let line = |name: &str, style| Entry {
        name: name.to_owned(),
        swatch: Swatch::Line { style, marked: false },
    };
    let sign =
        |name: &str, sign, role| Entry { name: name.to_owned(), swatch: Swatch::Sign(sign, role) };
    vec![
        line("gain below 1", BELOW),
        line("gain above 1", ABOVE),
        sign("closed loop, gain 1", Sign::Square, Role::Ink),
        sign("open-loop poles", Sign::Cross, Role::Ink),
        sign("open-loop zeros", Sign::Ring, Role::Ink),
        sign("stability limit and its gain", Sign::Diamond, Role::Series(3)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn locus(samples: &[(f64, &[Point])]) -> RootLocus {
        let sample = |(factor, poles): &(f64, &[Point])| LocusSample {
            factor: *factor,
            poles: poles.to_vec(),
        };
        RootLocus {
            title: String::new(),
            dt_s: 0.1,
            samples: samples.iter().map(sample).collect(),
            poles_at_one: Vec::new(),
            open_poles: Vec::new(),
            open_zeros: Vec::new(),
            crossings: Vec::new(),
        }
    }

    #[test]
    fn poles_in_another_order_still_make_smooth_lines() {
        let found = locus(&[
            (0.1, &[(0.0, 0.0), (1.0, 0.0)]),
            (0.2, &[(0.9, 0.0), (0.1, 0.0)]),
            (0.3, &[(0.2, 0.0), (0.8, 0.0)]),
        ]);
        let branches = found.branches();
        assert_eq!(branches.len(), 2);
        for branch in branches {
            assert!(branch.points.windows(2).all(|pair| distance(pair[0], pair[1]) < 0.11));
        }
    }

    #[test]
    fn a_line_changes_its_style_at_factor_one_and_does_not_jump() {
        let near = locus(&[(0.9, &[(0.5, 0.0)]), (1.1, &[(0.6, 0.0)]), (1.3, &[(0.7, 0.0)])]);
        let styles: Vec<SeriesStyle> = near.branches().iter().map(|branch| branch.style).collect();
        assert_eq!(styles, [BELOW, ABOVE]);
        let far = locus(&[(0.9, &[(0.5, 0.0)]), (1.0, &[(9.0, 0.0)])]);
        assert!(far.branches().is_empty());
    }
}
