//! The union of many boxes as one path of bounded size.

use std::collections::BTreeSet;

use crate::svg::{Rect, polyline_data};

/// Up to so many different boxes are outlined one by one.
const MOST_BOXES: usize = 800;

/// Path data that covers all `boxes` within `area`.
///
/// Boxes that look the same are drawn once. A great many are drawn as rows of whole pixels, outwards: then the
/// covered area can seem up to a pixel larger than it is, never smaller.
pub(super) fn path(boxes: &[Rect], area: Rect) -> String {
    let inside: Vec<Rect> = boxes.iter().filter_map(|one| cut(*one, area)).collect();
    // Tenths of a pixel.
    let tenths = |v: f64| libm::round(v * 10.0) as i64;
    let key = |r: &Rect| [tenths(r.x), tenths(r.y), tenths(r.x + r.width), tenths(r.y + r.height)];
    let different: BTreeSet<[i64; 4]> = inside.iter().map(key).collect();
    if different.len() > MOST_BOXES {
        return rows(&inside, area);
    }
    different.iter().map(|edges| outline(edges.map(|edge| edge as f64 / 10.0))).collect()
}

/// The part of a box that can be seen, with a little more for its edge.
fn cut(r: Rect, area: Rect) -> Option<Rect> {
    let rim = 2.0;
    let (west, east) = (r.x.max(area.x - rim), (r.x + r.width).min(area.x + area.width + rim));
    let (north, south) = (r.y.max(area.y - rim), (r.y + r.height).min(area.y + area.height + rim));
    let seen = west <= east && north <= south;
    seen.then_some(Rect { x: west, y: north, width: east - west, height: south - north })
}

fn outline([west, north, east, south]: [f64; 4]) -> String {
    polyline_data(&[(west, north), (east, north), (east, south), (west, south)], true)
}

/// Runs of covered pixels, row by row.
fn rows(boxes: &[Rect], area: Rect) -> String {
    let (across, down) =
        (libm::ceil(area.width) as usize + 4, libm::ceil(area.height) as usize + 4);
    let pixel = |v: f64, from: f64, most: usize| ((v - from + 2.0).max(0.0) as usize).min(most);
    // Ones where boxes begin and minus ones where they end; sums over both directions count the boxes.
    let mut steps = vec![0_i32; (across + 1) * (down + 1)];
    for r in boxes {
        let (x0, x1) =
            (pixel(r.x, area.x, across), pixel(libm::ceil(r.x + r.width), area.x, across));
        let (y0, y1) = (pixel(r.y, area.y, down), pixel(libm::ceil(r.y + r.height), area.y, down));
        for (x, y, step) in [(x0, y0, 1), (x1, y0, -1), (x0, y1, -1), (x1, y1, 1)] {
            steps[y * (across + 1) + x] += step;
        }
    }
    let mut d = String::new();
    let mut above = vec![0_i32; across + 1];
    for (y, row) in steps.chunks(across + 1).enumerate() {
        let mut count = 0;
        let mut from = None;
        for (x, step) in row.iter().enumerate() {
            above[x] += step;
            count += above[x];
            match (count > 0, from) {
                (true, None) => from = Some(x),
                (false, Some(start)) => {
                    let (west, north) = (area.x - 2.0 + start as f64, area.y - 2.0 + y as f64);
                    d.push_str(&outline([west, north, west + (x - start) as f64, north + 1.0]));
                    from = None;
                }
                _ => {}
            }
        }
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rect = Rect { x: 0.0, y: 0.0, width: 100.0, height: 50.0 };

    fn boxes(count: usize) -> Vec<Rect> {
        let at =
            |n: usize| Rect { x: (n % 97) as f64, y: (n % 41) as f64, width: 3.0, height: 2.0 };
        (0..count).map(at).collect()
    }

    #[test]
    fn boxes_that_look_the_same_are_drawn_once() {
        let one = path(&boxes(1), AREA);
        assert_eq!(path(&[boxes(1), boxes(1)].concat(), AREA), one);
        assert_eq!(one, "M0 0l3 0l0 2l-3 0z");
        assert!(path(&[Rect { x: 500.0, ..AREA }], AREA).is_empty());
    }

    #[test]
    fn thousands_of_boxes_cover_their_area_in_one_small_path() {
        let d = path(&boxes(3_900), AREA);
        assert!(d.len() < 8_000, "{}", d.len());
        // Together they cover 0..99 by 0..42: one run in each of these rows.
        assert_eq!(d.matches('M').count(), 42);
        assert!(d.starts_with("M0 0l99 0l0 1l-99 0z"), "{d}");
    }

    #[test]
    fn a_hole_between_many_boxes_stays_open() {
        let left = boxes(3_900).into_iter().map(|r| Rect { x: r.x * 0.3, ..r });
        let right = boxes(3_900).into_iter().map(|r| Rect { x: 60.0 + r.x * 0.3, ..r });
        let d = path(&left.chain(right).collect::<Vec<_>>(), AREA);
        assert_eq!(d.matches('M').count(), 84);
    }
}
