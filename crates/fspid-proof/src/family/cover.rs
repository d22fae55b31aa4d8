//! Coverage test: do the given boxes cover a box of parameters completely?

use crate::caps::MOST_PARTS;

/// Ends of each side.
type Ends = [[f64; 2]];

/// Most cuts that are made to find out: parts that were made by cutting ask for as many as they were made by, and others,
/// which somebody wrote, could ask for more than anybody waits for.
pub(super) const MOST_CUTS: usize = 32 * MOST_PARTS;

/// True if every point of `whole` lies in one of `parts`; ends belong to both sides of them. Not true either where more cuts
/// than allowed would have to tell.
///
/// The whole is cut along a face of a part that goes through its inside, and both halves are asked in turn; each cut takes
/// a face away, so that it ends.
pub(super) fn covers(whole: &Ends, parts: &[&Ends]) -> bool {
    covers_within(whole, parts, &mut { MOST_CUTS })
}

fn covers_within(whole: &Ends, parts: &[&Ends], cuts: &mut usize) -> bool {
    let near: Vec<&Ends> = parts.iter().filter(|part| has_inside(part, whole)).copied().collect();
    let Some(first) = near.first() else { return false };
    if near.iter().any(|part| holds_all(part, whole)) {
        return true;
    }
    let Some((side, at)) = face_within(first, whole) else { return false };
    if !may_cut(cuts) {
        return false;
    }
    [[whole[side][0], at], [at, whole[side][1]]].into_iter().all(|half| {
        let mut ends = whole.to_vec();
        ends[side] = half;
        covers_within(&ends, &near, cuts)
    })
}

/// True if one more cut is allowed, which then is one less.
pub(super) fn may_cut(cuts: &mut usize) -> bool {
    let left = cuts.checked_sub(1);
    *cuts = left.unwrap_or(0);
    left.is_some()
}

/// True if a box is within a part.
pub(super) fn holds_all(part: &Ends, whole: &Ends) -> bool {
    part.iter().zip(whole).all(|(part, whole)| holds(part, whole))
}

/// True if more than faces belong to both.
pub(super) fn has_inside(part: &Ends, whole: &Ends) -> bool {
    part.iter().zip(whole).all(meets)
}

/// True if two boxes have a point in common.
pub(super) fn touches(one: &Ends, other: &Ends) -> bool {
    one.iter().zip(other).all(|(one, other)| one[0] <= other[1] && other[0] <= one[1])
}

fn holds(part: &[f64; 2], whole: &[f64; 2]) -> bool {
    part[0] <= whole[0] && whole[1] <= part[1]
}

/// More than a face in common, or all of a side without width.
fn meets((part, whole): (&[f64; 2], &[f64; 2])) -> bool {
    let (from, to) = (part[0].max(whole[0]), part[1].min(whole[1]));
    from < to || (from <= to && whole[0] >= whole[1])
}

/// A face of a part that cuts the whole in two.
pub(super) fn face_within(part: &Ends, whole: &Ends) -> Option<(usize, f64)> {
    let sides = part.iter().zip(whole).enumerate();
    let mut faces = sides.flat_map(|(side, (part, whole))| part.map(|at| (side, at, *whole)));
    faces.find(|(_, at, whole)| whole[0] < *at && *at < whole[1]).map(|(side, at, _)| (side, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(whole: &[[f64; 2]], parts: &[Vec<[f64; 2]>]) -> bool {
        let parts: Vec<&Ends> = parts.iter().map(Vec::as_slice).collect();
        covers(whole, &parts)
    }

    #[test]
    fn parts_made_by_cutting_cover_and_without_one_of_them_they_do_not() {
        let whole = [[0.0, 1.0], [2.0, 4.0]];
        let parts = vec![
            vec![[0.0, 0.5], [2.0, 4.0]],
            vec![[0.5, 1.0], [2.0, 3.0]],
            vec![[0.5, 0.75], [3.0, 4.0]],
            vec![[0.75, 1.0], [3.0, 4.0]],
        ];
        assert!(covered(&whole, &parts));
        for left_out in 0..parts.len() {
            let mut fewer = parts.clone();
            fewer.remove(left_out);
            assert!(!covered(&whole, &fewer), "without {left_out}");
        }
    }

    #[test]
    fn a_pinwheel_that_no_single_cut_divides_is_covered_and_without_its_middle_not() {
        let whole = [[0.0, 3.0], [0.0, 3.0]];
        let middle = vec![[1.0, 2.0], [1.0, 2.0]];
        let mut parts = vec![
            vec![[0.0, 2.0], [0.0, 1.0]],
            vec![[2.0, 3.0], [0.0, 2.0]],
            vec![[1.0, 3.0], [2.0, 3.0]],
            vec![[0.0, 1.0], [1.0, 3.0]],
        ];
        assert!(!covered(&whole, &parts));
        parts.push(middle);
        assert!(covered(&whole, &parts));
    }

    #[test]
    fn a_gap_of_one_float_is_seen_and_a_side_without_width_is_no_gap() {
        let below = 0.5_f64.next_down();
        let gap = [vec![[0.0, below]], vec![[0.5, 1.0]]];
        assert!(!covered(&[[0.0, 1.0]], &gap));
        assert!(covered(&[[3.0, 3.0]], &[vec![[2.0, 3.0]]]));
        assert!(covered(&[[0.0, 1.0], [7.0, 7.0]], &[vec![[0.0, 1.0], [7.0, 7.0]]]));
        assert!(!covered(&[[0.0, 1.0]], &[]));
    }

    /// Boards of squares that meet at corners alone, each cut by the others: pieces without number.
    #[test]
    fn parts_that_were_made_to_take_for_ever_end_as_ones_that_leave_something_out() {
        let squares = |off: f64| {
            let side = |at: u32| [f64::from(at) + off, f64::from(at) + off + 1.0];
            let places = (0..50).flat_map(|x| (0..50).map(move |y| (x, y)));
            let dark = places.filter(|(x, y)| (x + y) % 2 == 0);
            dark.map(|(x, y)| vec![side(x), side(y)]).collect::<Vec<_>>()
        };
        let mut parts = [0.0, 0.3, 0.6].map(squares).concat();
        parts.push(vec![[0.0, 51.0], [0.0, 25.0]]);
        parts.push(vec![[0.0, 51.0], [25.0, 51.0]]);
        let whole = [[0.0, 51.0], [0.0, 51.0]];
        // They cover it; nobody waits to hear so.
        let _ = covered(&whole, &parts);
        parts.pop();
        assert!(!covered(&whole, &parts));
        let mut cuts = 2;
        assert!(may_cut(&mut cuts) && may_cut(&mut cuts) && !may_cut(&mut cuts));
    }
}
