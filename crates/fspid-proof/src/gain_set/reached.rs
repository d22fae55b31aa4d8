//! The reachable set of an accumulating law's gains: a convex body, tighter than its bounding box.
//!
//! The three gains are means of three increments of the *same* inputs, each with the same weights:
//!
//! $$ k^+ = \Pi\big( (1 - \alpha) k + \alpha v \big), \qquad v = k' + \frac{s \Delta k}{\lambda}, \quad
//! \alpha = \lambda T \le 1 $$
//!
//! with $\Pi$ for the limits of each gain. Where a limit $u$ cuts a gain off, some number between $u$ and $v$ in
//! place of $v$ would have led to the limit by itself: $k \le u$ and $(1 - \alpha) k + \alpha v > u$ ask for
//! $v > u$, and $\alpha v' = u - (1 - \alpha) k$ has a solution $u \le v' \le v$. So every gain that the law comes to
//! is a mean of the nominal ones and of such $v'$, and lies within the limits:
//!
//! $$ k \in \operatorname{conv} \Big( \lbrace k' \rbrace \cup \bigcup_{\text{cells}} V' \Big) \cap L $$
//!
//! with a box $V'$ for each cell of the supervisor's inputs. The convex hull is bounded from outside by planes, whose
//! normals are small whole numbers once the gains are counted in halves of their bounds: which three planes meet in a
//! point is then no question of rounding.
//!
//! Rounding: a sample computes $k^+$ with an error of at most E, which is the same as moving $v'$ by $E / \alpha$.

use fspid_core::Limits;
use fspid_numeric::scalar::Interval;

/// Whole numbers of the planes' normals, either way.
const STEPS: i8 = 2;
/// In ordinary arithmetic a point this far beyond a plane is beyond it: numbers are below $10^3$ there.
const BEYOND: f64 = 1e-9;
/// Corners no further apart, in halves, are one.
const TOGETHER: f64 = 1e-7;
/// Most corners that a body has: planes in space have two for each, less four, and those that meet in one place may be
/// found as some more.
pub(crate) const MOST_CORNERS: u64 = 512;
/// What a sample's sums and products may be off by, as a share of the numbers in them: $32 \epsilon$.
const STEP_ROUNDINGS: f64 = 16.0 * f64::EPSILON;

/// A convex body of gains.
#[derive(Clone, Debug, PartialEq)]
pub struct Reached {
    centre: [f64; 3],
    half: [f64; 3],
    planes: Vec<Plane>,
    /// Boxes, most of them no wider than rounding, that together have a corner of the body in each.
    pub corners: Vec<[Interval; 3]>,
}

/// $a \cdot u \le$ `most`, of gains u in halves.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plane {
    normal: [i32; 3],
    most: f64,
}

/// What a gain is told of: nominal value, scaled increments over the leakage for each cell, limits, $\lambda T$.
pub(super) struct Told<'a> {
    pub(super) nominal: [f64; 3],
    /// $v$ for each cell.
    pub(super) targets: &'a [[Interval; 3]],
    pub(super) limits: [Option<Limits<f64>>; 3],
    /// $\alpha$, from below.
    pub(super) share: f64,
    /// A box that holds all gains.
    pub(super) bounds: [Interval; 3],
}

impl Reached {
    /// The body of a law; none where the planes do not say more than the box, or could not be made out.
    pub(super) fn of(told: &Told<'_>) -> Option<Self> {
        if !(told.share > 0.0) || !told.bounds.iter().all(|side| side.is_bounded()) {
            return None;
        }
        let centre = told.bounds.map(Interval::midpoint);
        let half = told.bounds.map(|side| {
            let radius = side.radius();
            // A gain that does not move has no extent to count in.
            if radius > 1e-12 * side.magnitude() { radius } else { side.magnitude().max(1e-12) }
        });
        let boxes = boxes(told);
        let mut body = Self { centre, half, planes: Vec::new(), corners: Vec::new() };
        for normal in normals() {
            let furthest = boxes.iter().map(|one| body.along(normal, one)).fold(f64::MIN, f64::max);
            let own = body.along(normal, &told.bounds);
            body.planes.push(Plane { normal, most: furthest.min(own) });
        }
        body.corners = body.met()?;
        Some(body)
    }

    fn halves(&self, gain: usize, bounds: Interval) -> Interval {
        (bounds - Interval::point(self.centre[gain])) / Interval::point(self.half[gain])
    }

    /// How far a box of gains reaches along a normal, from above.
    fn along(&self, normal: [i32; 3], gains: &[Interval; 3]) -> f64 {
        let sum = (0..3).fold(Interval::ZERO, |sum, gain| {
            sum + Interval::point(f64::from(normal[gain])) * self.halves(gain, gains[gain])
        });
        sum.upper()
    }

    /// Where three planes meet and no other is in the way.
    ///
    /// A body that is bounded is spanned by its corners, and in each corner three planes with independent normals meet.
    fn met(&self) -> Option<Vec<[Interval; 3]>> {
        let mut found: Vec<([f64; 3], [Interval; 3])> = Vec::new();
        for (third, c) in self.planes.iter().enumerate() {
            for (second, b) in self.planes.iter().enumerate().take(third) {
                let across = cross(b.normal, c.normal);
                for a in self.planes.iter().take(second) {
                    let volume = inner(a.normal, across);
                    if volume != 0 {
                        self.note(&mut found, [*a, *b, *c], volume);
                    }
                }
            }
        }
        let gains = |halves: [Interval; 3]| {
            [0, 1, 2].map(|gain: usize| {
                Interval::point(self.centre[gain]) + Interval::point(self.half[gain]) * halves[gain]
            })
        };
        let enough = !found.is_empty() && found.len() as u64 <= MOST_CORNERS;
        enough.then(|| found.into_iter().map(|(_, halves)| gains(halves)).collect())
    }

    /// Keeps the point of three planes unless it is surely beyond another.
    fn note(&self, found: &mut Vec<([f64; 3], [Interval; 3])>, three: [Plane; 3], volume: i32) {
        let [a, b, c] = three;
        let sides =
            [cross(b.normal, c.normal), cross(c.normal, a.normal), cross(a.normal, b.normal)];
        let mosts = [a.most, b.most, c.most];
        let rough = [0, 1, 2].map(|axis: usize| {
            (0..3).map(|n| mosts[n] * f64::from(sides[n][axis])).sum::<f64>() / f64::from(volume)
        });
        let beyond = |plane: &Plane| {
            let along: f64 = (0..3).map(|axis| f64::from(plane.normal[axis]) * rough[axis]).sum();
            along > plane.most + BEYOND
        };
        if self.planes.iter().any(beyond) {
            return;
        }
        let exact = [0, 1, 2].map(|axis: usize| {
            let sum = (0..3).fold(Interval::ZERO, |sum, n| {
                sum + Interval::point(mosts[n]) * Interval::point(f64::from(sides[n][axis]))
            });
            sum / Interval::point(f64::from(volume))
        });
        let near = |place: &[f64; 3]| {
            place.iter().zip(rough).all(|(one, other)| (one - other).abs() <= TOGETHER)
        };
        match found.iter_mut().find(|(place, _)| near(place)) {
            Some((_, known)) => *known = [0, 1, 2].map(|axis: usize| known[axis].hull(exact[axis])),
            None => found.push((rough, exact)),
        }
    }

    /// A box that holds all of the body in a box; none where there is nothing of it.
    #[must_use]
    pub fn part(&self, gains: [Interval; 3]) -> Option<[Interval; 3]> {
        let mut halves = [0, 1, 2].map(|gain: usize| self.halves(gain, gains[gain]));
        for plane in &self.planes {
            let [a, b, c] = plane.normal.map(|number| Interval::point(f64::from(number)));
            let terms = [a * halves[0], b * halves[1], c * halves[2]];
            for gain in 0..3 {
                let factor = plane.normal[gain];
                if factor == 0 {
                    continue;
                }
                // What the other two leave of the plane.
                let [one, other] = [terms[(gain + 1) % 3], terms[(gain + 2) % 3]];
                let left = Interval::point(plane.most)
                    - Interval::point(one.lower())
                    - Interval::point(other.lower());
                let end = (left / Interval::point(f64::from(factor))).upper();
                let low = (left / Interval::point(f64::from(factor))).lower();
                let side = if factor > 0 {
                    Interval::new(f64::NEG_INFINITY, end)?
                } else {
                    Interval::new(low, f64::INFINITY)?
                };
                halves[gain] = halves[gain].intersection(side)?;
            }
        }
        let narrowed = [0, 1, 2].map(|gain: usize| {
            let back = Interval::point(self.centre[gain])
                + Interval::point(self.half[gain]) * halves[gain];
            back.intersection(gains[gain]).unwrap_or(gains[gain])
        });
        Some(narrowed)
    }

    /// False for gains that are surely outside.
    #[must_use]
    pub fn may_hold(&self, gains: [f64; 3]) -> bool {
        let point = gains.map(Interval::point);
        self.planes.iter().all(|plane| {
            let negative = plane.normal.map(|number| -number);
            // The least along a normal is the most along the opposite one, turned.
            -self.along(negative, &point) <= plane.most
        })
    }
}

/// A box for each cell, and the nominal gains.
fn boxes(told: &Told<'_>) -> Vec<[Interval; 3]> {
    let slack = [0, 1, 2].map(|gain: usize| {
        let size = told.bounds[gain].magnitude().max(told.nominal[gain].abs());
        let most = told.targets.iter().map(|target| target[gain].magnitude()).fold(size, f64::max);
        let off = Interval::point(STEP_ROUNDINGS) * Interval::point(most)
            + Interval::point(f64::MIN_POSITIVE);
        let slack = (off / Interval::point(told.share)).upper();
        Interval::between(-slack, slack)
    });
    let cut = |gain: usize, target: Interval| match told.limits[gain] {
        Some(limits) => target
            .hull(Interval::between(limits.clamp(target.lower()), limits.clamp(target.upper()))),
        None => target,
    };
    let cells = told
        .targets
        .iter()
        .map(|target| [0, 1, 2].map(|gain: usize| cut(gain, target[gain] + slack[gain])));
    let nominal = told.nominal.map(Interval::point);
    cells.chain([nominal]).collect()
}

/// Normals without a common divisor.
fn normals() -> Vec<[i32; 3]> {
    let steps = || (-STEPS..=STEPS).map(i32::from);
    let all = steps().flat_map(|a| steps().flat_map(move |b| steps().map(move |c| [a, b, c])));
    let divisor =
        |normal: &[i32; 3]| normal.iter().fold(0, |one, other| greatest(one, other.abs()));
    all.filter(|normal| divisor(normal) == 1).collect()
}

/// The greatest common divisor.
fn greatest(one: i32, other: i32) -> i32 {
    if other == 0 { one } else { greatest(other, one % other) }
}

fn cross([a, b, c]: [i32; 3], [x, y, z]: [i32; 3]) -> [i32; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn inner(one: [i32; 3], other: [i32; 3]) -> i32 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}
