//! The points of a cloud that span its convex hull.
//!
//! A point that is found outside of what has been spanned so far has a plane between: the point
//! furthest in its direction is a vertex and is added (Clarkson). The plane comes from the nearest
//! point of the spanned hull, which is looked for in simplices of at most four points (Gilbert,
//! Johnson and Keerthi). Flat clouds, lines and single points need no care of their own.
//!
//! # Source
//! K. L. Clarkson, *More output-sensitive geometric algorithms*, FOCS 1994, 695–702. E. G. Gilbert,
//! D. W. Johnson and S. S. Keerthi, *A fast procedure for computing the distance between complex
//! objects in three-dimensional space*, IEEE Journal on Robotics and Automation 4 (1988) 193–203.

/// Points no further outside count as inside, in halves of the cloud's extent along each axis.
const INSIDE: f64 = 1e-9;
/// Steps towards the nearest point; a handful is usual.
const STEPS: usize = 60;
/// Gram determinants below this share of their diagonal's product belong to points in one line or
/// plane; a simplex of fewer points does.
const FLAT: f64 = 1e-24;

type Point = [f64; 3];

/// Points of the cloud whose convex hull holds all others but for [`INSIDE`], or for `tolerance` if
/// that is larger.
pub(super) fn spanning(cloud: &[Point], tolerance: f64) -> Vec<Point> {
    let mut cloud = cloud.to_vec();
    cloud.sort_by(order);
    cloud.dedup_by(|one, other| order(one, other).is_eq());
    let scaled = scaled(&cloud);
    let mut span = vertices(&scaled);
    if tolerance > INSIDE {
        span = fewer(&scaled, &span, tolerance);
    }
    span.into_iter().filter_map(|index| cloud.get(index).copied()).collect()
}

fn order(one: &Point, other: &Point) -> core::cmp::Ordering {
    let pairs = one.iter().zip(other).map(|(one, other)| one.total_cmp(other));
    pairs.fold(core::cmp::Ordering::Equal, core::cmp::Ordering::then)
}

/// The cloud moved and stretched into $[-1, 1]^3$; an axis without extent becomes zero.
fn scaled(cloud: &[Point]) -> Vec<Point> {
    let axes = [0, 1, 2].map(|axis: usize| {
        let along = cloud.iter().map(|point| point[axis]);
        let least = along.clone().fold(f64::INFINITY, f64::min);
        let most = along.fold(f64::NEG_INFINITY, f64::max);
        (0.5 * least + 0.5 * most, 0.5 * most - 0.5 * least)
    });
    let place = |point: &Point| {
        [0, 1, 2].map(|axis: usize| {
            let (middle, half) = axes[axis];
            if half > 0.0 { (point[axis] - middle) / half } else { 0.0 }
        })
    };
    cloud.iter().map(place).collect()
}

/// Numbers of the points that span the cloud.
fn vertices(cloud: &[Point]) -> Vec<usize> {
    let mut span: Vec<usize> = Vec::new();
    for direction in directions() {
        span.extend(furthest(cloud, direction));
    }
    span.sort_unstable();
    span.dedup();
    let mut spanned: Vec<Point> = span.iter().map(|&index| cloud[index]).collect();
    for (index, &point) in cloud.iter().enumerate() {
        while let Some(direction) = outside(&spanned, point) {
            let vertex = furthest(cloud, direction).filter(|vertex| !span.contains(vertex));
            let vertex = vertex.unwrap_or(index);
            span.push(vertex);
            spanned.push(cloud[vertex]);
            if vertex == index {
                break;
            }
        }
    }
    span
}

/// Of the points that span a cloud those that leave the others no further outside than the
/// tolerance: the one that is furthest outside first, again and again.
///
/// A gap only shrinks as points are added, so that an old one is a bound: only the largest is
/// computed anew.
fn fewer(cloud: &[Point], span: &[usize], tolerance: f64) -> Vec<usize> {
    let mut chosen: Vec<usize> = Vec::new();
    let mut spanned: Vec<Point> = Vec::new();
    let mut gaps: Vec<(usize, f64)> = span.iter().map(|&index| (index, f64::INFINITY)).collect();
    let mut fresh = usize::MAX;
    loop {
        let worst = gaps.iter_mut().max_by(|one, other| one.1.total_cmp(&other.1));
        let Some((index, gap)) = worst.filter(|(_, gap)| *gap > tolerance) else { return chosen };
        if spanned.is_empty() || fresh == *index {
            chosen.push(*index);
            spanned.push(cloud[*index]);
            (*gap, fresh) = (0.0, usize::MAX);
        } else {
            *gap = length(nearest(&spanned, cloud[*index], [tolerance, f64::INFINITY]));
            fresh = *index;
        }
    }
}

/// The sides, edges and corners of a cube seen from its middle.
fn directions() -> impl Iterator<Item = Point> {
    let signs = [-1.0, 0.0, 1.0];
    let all = (0..27_usize).map(move |n| [signs[n / 9], signs[n / 3 % 3], signs[n % 3]]);
    all.filter(|direction| dot(*direction, *direction) > 0.0)
}

/// The number of the point furthest in a direction; of equals the last, which as the points are
/// sorted is a corner of the face that they make.
fn furthest(cloud: &[Point], direction: Point) -> Option<usize> {
    let heights = cloud.iter().map(|&point| dot(point, direction)).enumerate();
    heights.max_by(|one, other| one.1.total_cmp(&other.1)).map(|(index, _)| index)
}

/// A direction in which the point is beyond all others; nothing if it is inside.
fn outside(spanned: &[Point], point: Point) -> Option<Point> {
    let nearest = nearest(spanned, point, [INSIDE; 2]);
    (length(nearest) > INSIDE).then(|| nearest.map(|x| -x))
}

/// The way from a point to a point of the hull of others: to one no further than `near`, or to one
/// beyond a plane between as soon as it is known that all are further than `far`; else to the
/// nearest.
fn nearest(spanned: &[Point], point: Point, [near, far]: [f64; 2]) -> Point {
    let Some(&first) = spanned.first() else { return [f64::INFINITY; 3] };
    let mut simplex: Vec<Point> = vec![minus(first, point)];
    let mut way = minus(first, point);
    for _ in 0..STEPS {
        let size = length(way);
        if size <= near {
            break;
        }
        let against = way.map(|x| -x);
        let Some(index) = furthest(spanned, against) else { break };
        let support = minus(spanned[index], point);
        // All of the hull is at least so far away.
        let least = dot(way, support) / size;
        if least > far || size - least <= 0.01 * near || simplex.len() > 3 {
            break;
        }
        simplex.push(support);
        let closer = shrink(&mut simplex);
        if !(length(closer) < size) {
            break;
        }
        way = closer;
    }
    way
}

/// The point of a simplex nearest to the origin; the simplex becomes the part that it lies in.
fn shrink(simplex: &mut Vec<Point>) -> Point {
    let mut best = (f64::INFINITY, [f64::INFINITY; 3], 0);
    for part in 1..1_usize << simplex.len() {
        let mut corners = chosen(simplex, part);
        let Some(foot) = corners.next().and_then(|first| foot(first, corners)) else { continue };
        let size = dot(foot, foot);
        if size < best.0 {
            best = (size, foot, part);
        }
    }
    let (_, foot, part) = best;
    *simplex = chosen(simplex, part).collect();
    foot
}

fn chosen(simplex: &[Point], part: usize) -> impl Iterator<Item = Point> {
    simplex
        .iter()
        .enumerate()
        .filter(move |(bit, _)| part >> bit & 1 == 1)
        .map(|(_, &corner)| corner)
}

/// The point nearest to the origin in the plane through up to four corners, if it lies between
/// them.
///
/// $$ p_0 + \sum_i t_i d_i, \qquad d_i = p_i - p_0, \qquad
///    \sum_j (d_i \cdot d_j) t_j = -d_i \cdot p_0 $$
///
/// Edges that are not there have no part in it.
fn foot(first: Point, rest: impl Iterator<Item = Point>) -> Option<Point> {
    let mut edges = [None; 3];
    for (edge, corner) in edges.iter_mut().zip(rest) {
        *edge = Some(minus(corner, first));
    }
    let gram = |i: usize, j: usize| match (edges[i], edges[j]) {
        (Some(one), Some(other)) => dot(one, other),
        _ => f64::from(u8::from(i == j)),
    };
    let right = edges.map(|edge| edge.map_or(0.0, |edge| -dot(edge, first)));
    let rows = [0, 1, 2].map(|i| [gram(i, 0), gram(i, 1), gram(i, 2)]);
    let whole = determinant(rows);
    if !(whole > FLAT * rows[0][0] * rows[1][1] * rows[2][2]) {
        return None;
    }
    let (mut place, mut share) = (first, 1.0);
    for (i, edge) in edges.into_iter().enumerate() {
        let Some(edge) = edge else { break };
        let mut rows = rows;
        rows[i] = right;
        let t = determinant(rows) / whole;
        if !(t >= 0.0) {
            return None;
        }
        share -= t;
        place = [0, 1, 2].map(|axis: usize| place[axis] + t * edge[axis]);
    }
    (share >= 0.0).then_some(place)
}

fn determinant([a, b, c]: [Point; 3]) -> f64 {
    dot(a, cross(b, c))
}

fn cross([a, b, c]: Point, [d, e, f]: Point) -> Point {
    [b * f - c * e, c * d - a * f, a * e - b * d]
}

fn dot([a, b, c]: Point, [d, e, f]: Point) -> f64 {
    a * d + b * e + c * f
}

fn minus([a, b, c]: Point, [d, e, f]: Point) -> Point {
    [a - d, b - e, c - f]
}

fn length(point: Point) -> f64 {
    libm::sqrt(dot(point, point))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evenly spread numbers from -1 to 1.
    fn spread(index: usize, share: f64) -> f64 {
        let place = index as f64 * share + 0.3;
        2.0 * (place - libm::floor(place)) - 1.0
    }

    fn cloud(count: usize) -> impl Iterator<Item = Point> {
        // The fractional parts of the roots of 2, 3 and 5.
        let shares = [0.414_213_562_4, 0.732_050_807_6, 0.236_067_977_5];
        (0..count).map(move |index| shares.map(|share| spread(index, share)))
    }

    fn sorted(mut points: Vec<Point>) -> Vec<Point> {
        points.sort_by(order);
        points
    }

    #[test]
    fn a_cube_full_of_points_is_spanned_by_its_corners() {
        let corners: Vec<Point> =
            directions().filter(|&direction| dot(direction, direction) > 2.5).collect();
        assert_eq!(corners.len(), 8);
        let filled: Vec<Point> = corners.iter().copied().chain(cloud(500)).collect();
        assert_eq!(sorted(spanning(&filled, 0.0)), corners);
    }

    #[test]
    fn flat_clouds_lines_and_points_are_spanned_too() {
        let square: Vec<Point> = cloud(300).map(|[x, y, _]| [x, y, x + 2.0 * y]).collect();
        let corners = [[-1.0, -1.0, -3.0], [-1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 3.0]];
        let filled: Vec<Point> = square.into_iter().chain(corners).collect();
        assert_eq!(sorted(spanning(&filled, 0.0)), corners);
        let line: Vec<Point> = (0..9).map(|n| [f64::from(n), 5.0, -2.0 * f64::from(n)]).collect();
        assert_eq!(sorted(spanning(&line, 0.0)), [[0.0, 5.0, 0.0], [8.0, 5.0, -16.0]]);
        assert_eq!(spanning(&[[1.0, 2.0, 3.0]; 4], 0.0), [[1.0, 2.0, 3.0]]);
        assert_eq!(spanning(&[], 0.0), [[0.0; 3]; 0]);
    }

    #[test]
    fn every_point_of_a_sphere_is_needed_and_few_are_enough_for_most_of_it() {
        let ball: Vec<Point> = cloud(400).map(|point| point.map(|x| x / length(point))).collect();
        assert_eq!(spanning(&ball, 0.0).len(), ball.len());
        let few = spanning(&ball, 0.1);
        assert!(few.len() < 60, "{}", few.len());
        assert!(ball.iter().all(|&point| length(nearest(&few, point, [1e-9, 10.0])) < 0.11));
    }
}
