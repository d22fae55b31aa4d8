//! A surface seen in space: parallel projection, far faces first.

use super::axis::Axis;
use super::contour::Grid;
use super::page::LABEL_PX;
use super::plot::TICK_PX;
use super::style::{Rgb, Role};
use super::svg::{Anchor, Canvas, Font, Paint, Rect, polyline_data};

/// Half the height of the room over half its width.
const RISE: f64 = 0.62;

/// How a face looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Face {
    pub(super) colour: Rgb,
    /// True for a face that is crossed out.
    pub(super) crossed: bool,
}

/// How a surface is lit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Light {
    /// From everywhere: a face has the colour of its value.
    Flat,
    /// From above and the left: faces turned away are darker.
    FromTheLeft,
}

impl Light {
    /// The colour of a face with these corners in room coordinates.
    fn on(self, [r, g, b]: Rgb, corners: &[[f64; 3]; 4]) -> Rgb {
        if self == Self::Flat {
            return [r, g, b];
        }
        let strength = 0.62 + 0.42 * lit(corners).max(0.0);
        [r, g, b].map(|channel| (f64::from(channel) * strength).round().clamp(0.0, 255.0) as u8)
    }
}

/// Cosine of the angle between the upward normal of a face and the direction of the light.
fn lit([a, b, c, d]: &[[f64; 3]; 4]) -> f64 {
    let along = |from: &[f64; 3], to: &[f64; 3]| {
        [to[0] - from[0], to[1] - from[1], (to[2] - from[2]) * RISE]
    };
    let (u, v) = (along(a, c), along(b, d));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = normal.iter().map(|part| part * part).sum::<f64>().sqrt();
    if length > 0.0 { dot(normal, LIGHT) / length * normal[2].signum() } else { 1.0 }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Towards the light: from the left and the front, 50 deg above the floor.
const LIGHT: [f64; 3] = [-0.556, -0.321, 0.766];

/// From where a surface is seen.
///
/// $$ \mathbf{n} = (\cos\epsilon\cos\alpha, \cos\epsilon\sin\alpha, \sin\epsilon) $$
///
/// points to the observer: the azimuth $\alpha$ turns from the x axis to the y axis, the elevation $\epsilon$ is counted
/// from the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    /// Sine and cosine of the azimuth.
    azimuth: (f64, f64),
    /// Sine and cosine of the elevation.
    elevation: (f64, f64),
}

impl Observer {
    /// At -60 deg from the x axis and 26 deg above the floor: x runs to the right, y to the back. Where reports stand.
    pub const USUAL: Self = Self {
        azimuth: (-0.866_025_403_784_438_6, 0.5),
        elevation: (0.438_371_146_789_077_4, 0.898_794_046_299_167),
    };

    /// At these angles, deg; nobody looks from below the floor, so that the elevation is brought into 0 to 90 deg.
    #[must_use]
    pub fn at_deg(azimuth_deg: f64, elevation_deg: f64) -> Self {
        let [azimuth, elevation] =
            [azimuth_deg, elevation_deg.clamp(0.0, 90.0)].map(f64::to_radians);
        Self {
            azimuth: (libm::sin(azimuth), libm::cos(azimuth)),
            elevation: (libm::sin(elevation), libm::cos(elevation)),
        }
    }

    /// The sides of the room, -1 or 1 along x and y, that are away from the observer.
    fn back(self) -> (f64, f64) {
        let side = |towards: f64| if towards > 0.0 { -1.0 } else { 1.0 };
        (side(self.azimuth.1), side(self.azimuth.0))
    }
}

/// A room with three axes and where its points fall on the canvas: a right-handed system, z upwards.
#[derive(Debug, Clone)]
pub(super) struct View {
    axes: [Axis; 3],
    centre: (f64, f64),
    scale: f64,
    observer: Observer,
}

/// Where ticks and labels of an axis stand.
struct Outside {
    /// Away from the middle of the room, on the canvas.
    outward: (f64, f64),
    anchor: Anchor,
    /// From the middle of the axis to that of its label.
    label: (f64, f64),
}

impl View {
    /// A room that fills `area` with space for its labels, seen as reports see it.
    pub(super) fn new(axes: [Axis; 3], area: Rect) -> Self {
        let scale = (area.width / 3.3).min(area.height / 2.75);
        let centre = (area.x + area.width * 0.55, area.y + area.height * 0.455);
        Self { axes, centre, scale, observer: Observer::USUAL }
    }

    /// The same seen from anywhere: smaller, as it needs space for its labels on every side.
    pub(super) fn from(axes: [Axis; 3], area: Rect, observer: Observer) -> Self {
        let scale = (area.width / 3.9).min(area.height / 3.5);
        let centre = (area.x + area.width * 0.52, area.y + area.height * 0.47);
        Self { axes, centre, scale, observer }
    }

    /// Canvas place and depth of a point whose coordinates run from -1 to 1; nearer is larger.
    fn project(&self, [x, y, z]: [f64; 3]) -> ((f64, f64), f64) {
        let Observer { azimuth: (sa, ca), elevation: (se, ce) } = self.observer;
        let z = z * RISE;
        let right = -sa * x + ca * y;
        let up = -se * ca * x - se * sa * y + ce * z;
        let near = ce * ca * x + ce * sa * y + se * z;
        ((self.centre.0 + right * self.scale, self.centre.1 - up * self.scale), near)
    }

    fn at(&self, point: [f64; 3]) -> (f64, f64) {
        self.project(point).0
    }

    /// Place on the canvas of a point in display units.
    pub(super) fn place(&self, [x, y, z]: [f64; 3]) -> (f64, f64) {
        self.at([self.inside(0, x), self.inside(1, y), self.inside(2, z)])
    }

    fn inside(&self, axis: usize, value: f64) -> f64 {
        self.axes.get(axis).map_or(0.0, |axis| axis.fraction(value) * 2.0 - 1.0)
    }

    /// Draws floor, back walls, grid, ticks and labels.
    pub(super) fn room(&self, canvas: &mut Canvas, labels: [&str; 3]) {
        let wall = Paint::line(Role::Setpoint, 0.8).filled(Role::Face);
        let (bx, by) = self.observer.back();
        for corners in [
            [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]],
            [[bx, -1.0, -1.0], [bx, 1.0, -1.0], [bx, 1.0, 1.0], [bx, -1.0, 1.0]],
            [[-1.0, by, -1.0], [1.0, by, -1.0], [1.0, by, 1.0], [-1.0, by, 1.0]],
        ] {
            canvas.polyline(&corners.map(|corner| self.at(corner)), true, &wall);
        }
        // Per axis: the edge it is written along, and for its grid lines where they start, bend and end.
        let x_path = |t: f64| [[t, -by, -1.0], [t, by, -1.0], [t, by, 1.0]];
        let y_path = |t: f64| [[-bx, t, -1.0], [bx, t, -1.0], [bx, t, 1.0]];
        // The upright axis stands at the corner that is farthest to the left.
        let ends = [(bx, -by), (-bx, by)];
        let right = |(x, y): &(f64, f64)| self.at([*x, *y, 0.0]).0;
        let [left, other] =
            if right(&ends[0]) <= right(&ends[1]) { ends } else { [ends[1], ends[0]] };
        let z_path = |t: f64| [[left.0, left.1, t], [bx, by, t], [other.0, other.1, t]];
        self.axis(canvas, 0, labels[0], &x_path);
        self.axis(canvas, 1, labels[1], &y_path);
        self.axis(canvas, 2, labels[2], &z_path);
    }

    /// Grid lines, ticks and label of one axis; ticks stand where its grid lines start.
    fn axis(
        &self,
        canvas: &mut Canvas,
        n: usize,
        label: &str,
        path: &dyn Fn(f64) -> [[f64; 3]; 3],
    ) {
        let (ends, middle) =
            ([path(-1.0)[0], path(1.0)[0]].map(|end| self.at(end)), self.at(path(0.0)[0]));
        let Outside { outward, anchor, label: offset } = self.outside(n, middle);
        for tick in self.axes.get(n).map(Axis::ticks).unwrap_or_default() {
            let points = path(tick.at * 2.0 - 1.0).map(|point| self.at(point));
            canvas.polyline(&points, false, &Paint::line(Role::Grid, 0.7));
            let (x, y) = points[0];
            canvas.line(
                (x, y),
                (x + outward.0 * 5.0, y + outward.1 * 5.0),
                &Paint::line(Role::Ink, 1.0),
            );
            let (tx, ty) =
                (x + outward.0 * 8.0, y + outward.1 * 9.0 + TICK_PX * (0.36 + 0.3 * outward.1));
            canvas.text(tx, ty, &tick.label, Font::new(TICK_PX, anchor));
        }
        canvas.line(ends[0], ends[1], &Paint::line(Role::Ink, 1.0));
        let slope = (ends[1].1 - ends[0].1).atan2(ends[1].0 - ends[0].0).to_degrees();
        let (x, y) = (middle.0 + offset.0, middle.1 + offset.1);
        let turn = if n == 2 { -90.0 } else { legible(slope) };
        canvas.text(x, y, label, Font::new(LABEL_PX, Anchor::Middle).turned(turn));
    }

    /// Where ticks and label of an axis go whose middle is there on the canvas.
    fn outside(&self, n: usize, middle: (f64, f64)) -> Outside {
        let placed = |outward, anchor, label| Outside { outward, anchor, label };
        match (n, self.observer == Observer::USUAL) {
            (0, true) => placed((-0.35, 0.94), Anchor::End, (-16.0, 42.0)),
            (1, true) => placed((0.8, 0.6), Anchor::Start, (44.0, 29.0)),
            (0 | 1, false) => {
                let floor = self.at([0.0, 0.0, -1.0]);
                let (x, y) = (middle.0 - floor.0, middle.1 - floor.1);
                let length = (x * x + y * y).sqrt().max(f64::MIN_POSITIVE);
                let outward = (x / length, y / length);
                let anchor = match outward.0 {
                    x if x < -0.3 => Anchor::End,
                    x if x > 0.3 => Anchor::Start,
                    _ => Anchor::Middle,
                };
                // Numbers beside an axis need more room than numbers below it.
                let far = 34.0 + 14.0 * outward.0.abs();
                placed(outward, anchor, (outward.0 * far, outward.1 * far + 6.0))
            }
            _ => placed((-1.0, 0.0), Anchor::End, (-40.0, 0.0)),
        }
    }

    /// Draws the faces of `grid`, whose nodes are in display units.
    pub(super) fn faces(
        &self,
        canvas: &mut Canvas,
        grid: &Grid,
        light: Light,
        colour: impl Fn(f64) -> Rgb,
    ) {
        self.faces_by(canvas, grid, light, |_, mean| Face { colour: colour(mean), crossed: false });
    }

    /// The same with a look for each face, by its row and column and the mean of its corners.
    pub(super) fn faces_by(
        &self,
        canvas: &mut Canvas,
        grid: &Grid,
        light: Light,
        look: impl Fn((usize, usize), f64) -> Face,
    ) {
        let (rows, columns) = grid.cells();
        let mut faces = Vec::new();
        for i in 0..rows {
            for j in 0..columns {
                let Some(cell) = grid.cell(i, j) else {
                    continue;
                };
                let corners =
                    cell.map(|(x, y, z)| [self.inside(0, x), self.inside(1, y), self.inside(2, z)]);
                let mean = cell.iter().map(|corner| corner.2 / 4.0).sum::<f64>();
                // Height does not decide what hides what in a surface over the floor.
                let depth: f64 =
                    corners.iter().map(|[x, y, _]| self.project([*x, *y, 0.0]).1).sum();
                let face = look((i, j), mean);
                let colour = light.on(face.colour, &corners);
                faces.push((depth, corners.map(|corner| self.at(corner)), colour, face.crossed));
            }
        }
        faces.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, corners, colour, crossed) in faces {
            let paint = Paint::line(Role::Fixed([70, 70, 70]), 0.35).filled(Role::Fixed(colour));
            canvas.polyline(&corners, true, &paint);
            if crossed {
                let [a, b, c, d] = corners;
                let both = polyline_data(&[a, c], false) + &polyline_data(&[b, d], false);
                canvas.path(&both, &Paint::line(Role::Fixed([26, 26, 26]), 1.1));
            }
        }
    }
}

/// A slope of a text in degrees that nobody has to stand on the head for.
fn legible(slope_deg: f64) -> f64 {
    match slope_deg {
        slope if slope > 90.0 => slope - 180.0,
        slope if slope <= -90.0 => slope + 180.0,
        slope => slope,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_are_right_handed_and_z_points_up() {
        let axis = Axis::linear(Some((0.0, 1.0)), 0.0, 5);
        let view = View::new([axis; 3], Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 });
        let origin = view.at([0.0; 3]);
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|p| {
            let at = view.at(p);
            (at.0 - origin.0, origin.1 - at.1)
        });
        assert!(z.0.abs() < 1e-9 && z.1 > 0.0);
        // Seen from above, x turns counterclockwise into y.
        assert!(x.0 * y.1 - x.1 * y.0 > 0.0);
    }

    fn room(observer: Observer) -> View {
        let axis = Axis::linear(Some((0.0, 1.0)), 0.0, 5);
        View::from([axis; 3], Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 }, observer)
    }

    #[test]
    fn the_usual_observer_stands_at_minus_60_and_26_degrees() {
        let Observer { azimuth, elevation } = Observer::at_deg(-60.0, 26.0);
        for (found, usual) in
            [(azimuth, Observer::USUAL.azimuth), (elevation, Observer::USUAL.elevation)]
        {
            assert!((found.0 - usual.0).abs() < 1e-12 && (found.1 - usual.1).abs() < 1e-12);
        }
    }

    #[test]
    fn from_wherever_it_is_seen_the_walls_are_behind_and_the_room_is_on_the_canvas() {
        for azimuth in (-180..180).step_by(15).map(f64::from) {
            for elevation in [0.0, 10.0, 45.0, 89.0, 90.0] {
                let view = room(Observer::at_deg(azimuth, elevation));
                let (bx, by) = view.observer.back();
                let depth = |x: f64, y: f64| view.project([x, y, 0.0]).1;
                for other in [(-bx, by), (bx, -by), (-bx, -by)] {
                    let here = depth(bx, by);
                    assert!(depth(other.0, other.1) >= here - 1e-12, "{azimuth} {elevation}");
                }
                for corner in 0..8 {
                    let side = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
                    let (x, y) = view.at([side(0), side(1), side(2)]);
                    let on = 0.0..=100.0;
                    assert!(on.contains(&x) && on.contains(&y), "{azimuth} {elevation}: {x} {y}");
                }
            }
        }
    }

    #[test]
    fn texts_along_an_axis_are_never_upside_down() {
        for slope in (-180..=180).map(f64::from) {
            let found = legible(slope);
            assert!((-90.0..=90.0).contains(&found) && ((found - slope) / 180.0).fract() == 0.0);
        }
    }
}
