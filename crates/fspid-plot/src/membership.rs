//! Membership functions of one linguistic variable.

use super::axis::{Axis, extent, short_number};
use super::page::{self, EDGE, LABEL_PX};
use super::plot::{self, Content, Curve, Frame};
use super::style::SeriesStyle;
use super::svg::{Anchor, Canvas, Font, Rect, Svg};

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 150.0;

/// Draws the sets of one variable with their labels above their peaks.
///
/// Each set is a label and its points (value, grade). Sets that peak left of the middle are dashed, the
/// one in the middle is dotted and those right of it are full lines, so neighbours stay apart in print.
#[must_use]
pub fn memberships(title: &str, x_label: &str, sets: Vec<(String, Vec<(f64, f64)>)>) -> Svg {
    let range = extent(sets.iter().flat_map(|set| set.1.iter().map(|point| point.0)));
    let frame = frame(title, range);
    let area = frame.area;
    let mut canvas = Canvas::new(WIDTH, area.y + HEIGHT + 48.0);
    page::title(&mut canvas, title);
    let mut content = Content::default();
    let mut described = String::from("Membership functions:");
    let mut labels = Vec::new();
    for (label, points) in sets {
        let peak = peak(&points);
        let style = style(peak, range);
        let at = short_number(peak.unwrap_or(f64::NAN));
        described.push_str(&format!(" {label} peaks at {at};"));
        labels.extend(peak.map(|x| (x, label.clone(), style)));
        let points = without_tails(points);
        content.curves.push(Curve { name: label, style, points, stairs: false, marked: false });
    }
    plot::draw(&mut canvas, &frame, &content);
    for (x, label, style) in labels {
        let font = Font::new(LABEL_PX, Anchor::Middle).bold().role(style.role());
        canvas.text(frame.place(x, 0.0).0, area.y - 5.0, &label, font);
    }
    let label_right = EDGE + page::upright_room(1) - 3.0;
    page::upright_label(&mut canvas, label_right, area.y + HEIGHT / 2.0, &["grade".to_owned()]);
    let below = (area.x + area.width / 2.0, area.y + HEIGHT + 36.0);
    page::level_label(&mut canvas, below.0, below.1, x_label);
    canvas.finish(title, &described)
}

fn frame(title: &str, range: Option<(f64, f64)>) -> Frame {
    let y = Axis::fixed(Some((0.0, 1.05)), 3).unwrap_or_else(|| Axis::linear(None, 0.0, 3));
    let left = EDGE + page::upright_room(1) + page::tick_room(&y);
    let top = page::title_height(title, WIDTH) + 16.0;
    let area = Rect { x: left, y: top, width: WIDTH - left - EDGE - 12.0, height: HEIGHT };
    Frame { area, x: Axis::linear(range, 0.0, 11), y, x_labels: true }
}

/// The style of a set by the side on which it peaks.
fn style(peak: Option<f64>, range: Option<(f64, f64)>) -> SeriesStyle {
    let (lo, hi) = range.unwrap_or((-1.0, 1.0));
    let side = peak.map_or(0.0, |x| (x - (lo / 2.0 + hi / 2.0)) / (hi - lo).max(f64::MIN_POSITIVE));
    SeriesStyle::Numbered(match side {
        side if side < -0.02 => 1,
        side if side > 0.02 => 0,
        _ => 2,
    })
}

/// The points without the ends that lie on the axis to the eye.
fn without_tails(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let seen = |point: &(f64, f64)| point.1.abs() > 0.004 || !point.1.is_finite();
    let (Some(first), Some(last)) = (points.iter().position(seen), points.iter().rposition(seen))
    else {
        return points;
    };
    points.truncate(last + 2);
    points.split_off(first.saturating_sub(1))
}

/// The middle of where the set has its largest grade.
fn peak(points: &[(f64, f64)]) -> Option<f64> {
    let finite = || points.iter().filter(|point| point.0.is_finite() && point.1.is_finite());
    let highest = finite().map(|point| point.1).fold(f64::NEG_INFINITY, f64::max);
    let (lo, hi) = extent(finite().filter(|point| point.1 >= highest).map(|point| point.0))?;
    Some((lo + hi) / 2.0)
}
