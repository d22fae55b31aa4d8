//! Adaptive subdivision of a range of set-points or loads: which box is propagated next, from one end to the other.

/// A box that was flown at once is followed by one so many times as wide.
const WIDER: f64 = 1.5;

/// Boxes in a row, of which each is as wide as it can be flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sweep {
    at: f64,
    to: f64,
    /// With the sign of the way.
    width: f64,
    /// The box of now is half of one that was given up.
    halved: bool,
}

impl Sweep {
    /// From one end to another, the first box of so many times the whole.
    pub(super) fn over([from, to]: [f64; 2], share: f64) -> Self {
        Self { at: from, to, width: share * (to - from), halved: false }
    }

    pub(super) fn is_over(&self) -> bool {
        (self.to - self.at).abs() <= 0.0
    }

    /// The box, from where it begins on the way.
    pub(super) fn piece(&self) -> [f64; 2] {
        let left = self.to - self.at;
        let is_last = self.width.abs() >= left.abs();
        [self.at, if is_last { self.to } else { self.at + self.width }]
    }

    /// The box is flown; answers where it ends.
    pub(super) fn flown(&mut self) -> f64 {
        let [at, next] = self.piece();
        // Twice as wide was too wide just now.
        self.width = if self.halved { next - at } else { WIDER * (next - at) };
        self.halved = false;
        self.at = next;
        next
    }

    /// The box is given up; answers how wide half of it is.
    pub(super) fn given_up(&mut self) -> f64 {
        let [at, next] = self.piece();
        self.width = 0.5 * (next - at);
        self.halved = true;
        self.width.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes no wider than a number are flown.
    fn ends(way: [f64; 2], widest: f64) -> (Vec<f64>, usize) {
        let mut sweep = Sweep::over(way, 0.25);
        let (mut ends, mut given_up) = (vec![way[0]], 0);
        while !sweep.is_over() {
            let [from, to] = sweep.piece();
            if (to - from).abs() <= widest {
                ends.push(sweep.flown());
            } else {
                sweep.given_up();
                given_up += 1;
            }
        }
        (ends, given_up)
    }

    #[test]
    fn boxes_fill_the_way_to_either_side_and_widen_until_one_is_given_up() {
        for side in [1.0, -1.0] {
            let (found, given_up) = ends([0.0, 8.0 * side], 100.0);
            assert_eq!((found, given_up), (vec![0.0, 2.0 * side, 5.0 * side, 8.0 * side], 0));
            // Two are too wide; one is as wide as can be, and the next is not tried half as wide again.
            let (found, given_up) = ends([0.0, 8.0 * side], 1.0);
            assert_eq!(found[..3], [0.0, side, 2.0 * side]);
            assert!(found.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 1.0));
            assert_eq!(found.last(), Some(&(8.0 * side)));
            assert!(given_up <= found.len() / 2 + 1, "{given_up} {found:?}");
        }
    }

    #[test]
    fn the_last_box_is_halved_as_it_is_and_not_as_it_would_have_been() {
        let mut sweep = Sweep::over([0.0, 1.0], 4.0);
        assert_eq!(sweep.piece().map(f64::to_bits), [0.0_f64, 1.0].map(f64::to_bits));
        assert!((sweep.given_up() - 0.5).abs() <= 0.0);
        assert_eq!(sweep.piece().map(f64::to_bits), [0.0_f64, 0.5].map(f64::to_bits));
    }
}
