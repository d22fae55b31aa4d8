//! The grid of time that turbulence is drawn on, whatever the loop's period.

/// Period of the grid, s: 100 Hz.
///
/// Turbulence is drawn once each 10 ms, exactly as its filters have it there, and held until the next time. What is held has
/// the same variance at every instant (a straight line between would lose some in the middle), and of its spectrum
/// $(\sin x / x)^2$ with $x = \pi f / 100$ Hz is left: 99.2 % at 5 Hz, 96.7 % at 10 Hz. Airframes answer to some Hz, and the
/// rates' own lags $4 b / \pi V$ end near 1 Hz. What is held is integrated exactly, whatever the loop's period: it is the same
/// air at each. A loop of 10 ms meets the air that it met when turbulence was drawn at the samples of the loop.
pub const GRID_S: f64 = 0.01;

/// Of the grid's period: how near two times are that count as one.
const SAME: f64 = 1e-6;

/// How the samples of a loop lie on the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    dt_s: f64,
}

/// A part of a sample in which the same turbulence is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    /// Number of the turbulence.
    pub(crate) tick: usize,
    /// Time from the sample to the part, s.
    pub(crate) from_s: f64,
    /// Its length, s: no more than that of the grid.
    pub(crate) length_s: f64,
}

impl Grid {
    pub(crate) fn new(dt_s: f64) -> Self {
        Self { dt_s }
    }

    fn time_s(self, k: usize) -> f64 {
        k as f64 * self.dt_s
    }

    /// The last time of the grid at or before sample `k`.
    pub(crate) fn tick(self, k: usize) -> usize {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and the cast saturates"
        )]
        let tick = (self.time_s(k) / GRID_S + SAME).floor() as usize;
        tick
    }

    /// True where every sample lies between two times of the grid, so that its turbulence is held all through.
    pub(crate) fn holds_through_samples(self) -> bool {
        let samples = GRID_S / self.dt_s;
        (samples - samples.round()).abs() < SAME && samples.round() >= 1.0
    }

    /// The parts of the period from sample `k` on.
    pub(crate) fn pieces(self, k: usize) -> impl Iterator<Item = Piece> {
        let (begin_s, first) = (self.time_s(k), self.tick(k));
        let start_of = move |tick: usize| {
            let since_s = tick as f64 * GRID_S - begin_s;
            if tick > first { since_s } else { 0.0 }
        };
        let inside = move |tick: &usize| start_of(*tick) < self.dt_s - SAME * GRID_S;
        (first..).take_while(inside).map(move |tick| {
            let next = tick + 1;
            let to_s = if inside(&next) { start_of(next) } else { self.dt_s };
            let from_s = start_of(tick);
            Piece { tick, from_s, length_s: to_s - from_s }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pieces_of_the_samples_fill_the_time_and_never_cross_the_grid() {
        for dt_s in [0.001, 0.005, 0.01, 1.0 / 120.0, 0.02, 0.025, 0.04, 0.1] {
            let grid = Grid::new(dt_s);
            for k in [0, 1, 2, 3, 77, 5000, 123_457] {
                let pieces: Vec<Piece> = grid.pieces(k).collect();
                let sum: f64 = pieces.iter().map(|piece| piece.length_s).sum();
                assert!((sum - dt_s).abs() < 1e-15, "{dt_s} {k}");
                for piece in &pieces {
                    let middle_s = k as f64 * dt_s + piece.from_s + 0.5 * piece.length_s;
                    assert_eq!((middle_s / GRID_S).floor() as usize, piece.tick, "{dt_s} {k}");
                }
                assert_eq!(grid.tick(k), pieces[0].tick);
            }
        }
    }

    #[test]
    fn a_loop_of_the_grids_period_has_one_whole_piece_a_sample() {
        for k in 0..100_000 {
            let mut pieces = Grid::new(GRID_S).pieces(k);
            let whole = Piece { tick: k, from_s: 0.0, length_s: GRID_S };
            assert_eq!((pieces.next(), pieces.next()), (Some(whole), None));
        }
    }
}
