//! A grid of rules whose labels are free, within what keeps it explainable.

use fspid_fuzzy::{Grid, LABEL_COUNT, Label};

/// How labels must run from the middle of a grid outwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Monotone {
    /// Anyhow.
    No,
    /// They never fall while the error grows.
    RisingWithError,
    /// They never rise while the error grows.
    FallingWithError,
    /// They never fall while its change grows.
    RisingWithChange,
    /// They never rise while its change grows.
    FallingWithChange,
}

impl Monotone {
    /// All of them with their names in files.
    pub const NAMES: [(Self, &'static str); 5] = [
        (Self::No, "no"),
        (Self::RisingWithError, "rising-with-error"),
        (Self::FallingWithError, "falling-with-error"),
        (Self::RisingWithChange, "rising-with-change"),
        (Self::FallingWithChange, "falling-with-change"),
    ];
}

/// A free grid of rules. Its labels are whole numbers from -3 (`NB`) to 3 (`PB`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TunableGrid {
    /// The grid that a search begins from.
    pub start: Grid,
    /// How many labels a cell may move from there, 1 to 6.
    pub reach: u8,
    /// Whether opposite error and change have the same answer: cell (i, j) is cell (6 - i, 6 - j).
    pub symmetric: bool,
    /// The label of no error and no change, where it is fixed.
    pub at_rest: Option<Label>,
    /// How labels must run.
    pub monotone: Monotone,
}

const MIDDLE: usize = LABEL_COUNT / 2;
const LAST: usize = LABEL_COUNT - 1;

type Levels = [[i8; LABEL_COUNT]; LABEL_COUNT];

impl TunableGrid {
    /// Rows and columns of the cells that are chosen; the others follow from them.
    #[must_use]
    pub fn cells(&self) -> Vec<(usize, usize)> {
        let all = (0..LABEL_COUNT).flat_map(|i| (0..LABEL_COUNT).map(move |j| (i, j)));
        let is_chosen = |&(i, j): &(usize, usize)| {
            let is_first = i * LABEL_COUNT + j <= (LAST - i) * LABEL_COUNT + (LAST - j);
            let is_fixed = self.at_rest.is_some() && (i, j) == (MIDDLE, MIDDLE);
            (is_first || !self.symmetric) && !is_fixed
        };
        all.filter(is_chosen).collect()
    }

    /// The grid at these coordinates, each from 0 to 1; one half is the start's label. Labels that break
    /// the order that is asked for are raised (or lowered) to their neighbour nearer to the middle.
    #[must_use]
    pub fn at(&self, unit: &[f64]) -> Grid {
        let mut levels = levels(&self.start);
        for ((i, j), &unit) in self.cells().into_iter().zip(unit) {
            let level = self.moved(levels[i][j], unit);
            levels[i][j] = level;
            if self.symmetric {
                levels[LAST - i][LAST - j] = level;
            }
        }
        if let Some(label) = self.at_rest {
            levels[MIDDLE][MIDDLE] = label.index() as i8 - MIDDLE as i8;
        }
        self.put_in_order(&mut levels);
        grid(&levels)
    }

    /// Labels of the chosen cells, from -3 to 3.
    #[must_use]
    pub fn numbers(&self, unit: &[f64]) -> Vec<f64> {
        let levels = levels(&self.at(unit));
        self.cells().into_iter().map(|(i, j)| f64::from(levels[i][j])).collect()
    }

    /// True if the start keeps everything that is asked of the grid.
    #[must_use]
    pub fn start_is_allowed(&self) -> bool {
        self.at(&vec![0.5; self.cells().len()]) == self.start
    }

    /// A level moved by up to `reach`, each shift being as likely as the others.
    fn moved(&self, level: i8, unit: f64) -> i8 {
        let reach = f64::from(self.reach);
        let shift = (unit * (2.0 * reach + 1.0)).floor().clamp(0.0, 2.0 * reach) - reach;
        (level + shift as i8).clamp(-(MIDDLE as i8), MIDDLE as i8)
    }

    fn put_in_order(&self, levels: &mut Levels) {
        let pick: fn(i8, i8) -> i8 = match self.monotone {
            Monotone::No => return,
            Monotone::RisingWithError | Monotone::RisingWithChange => i8::max,
            Monotone::FallingWithError | Monotone::FallingWithChange => i8::min,
        };
        let along_rows =
            matches!(self.monotone, Monotone::RisingWithChange | Monotone::FallingWithChange);
        for line in 0..LABEL_COUNT {
            for distance in 1..=MIDDLE {
                for (at, inner) in [
                    (MIDDLE + distance, MIDDLE + distance - 1),
                    (MIDDLE - distance, MIDDLE - distance + 1),
                ] {
                    let cell = |k: usize| if along_rows { (line, k) } else { (k, line) };
                    let ((i, j), (m, n)) = (cell(at), cell(inner));
                    levels[i][j] = pick(levels[i][j], levels[m][n]);
                }
            }
        }
    }
}

fn levels(grid: &Grid) -> Levels {
    let level =
        |i: usize, j: usize| grid.at(Label::ALL[i], Label::ALL[j]).index() as i8 - MIDDLE as i8;
    std::array::from_fn(|i| std::array::from_fn(|j| level(i, j)))
}

fn grid(levels: &Levels) -> Grid {
    let label = |level: i8| Label::ALL[(level + MIDDLE as i8).clamp(0, LAST as i8) as usize];
    Grid::new(std::array::from_fn(|i| std::array::from_fn(|j| label(levels[i][j]))))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLAT: &str = "ZO ZO ZO ZO ZO ZO ZO\n";

    fn mark(monotone: Monotone, at_rest: Option<Label>) -> TunableGrid {
        let start = Grid::parse(&FLAT.repeat(7)).expect("a grid");
        TunableGrid { start, reach: 3, symmetric: true, at_rest, monotone }
    }

    /// Coordinates that look as if they were drawn.
    fn units(count: usize, seed: usize) -> Vec<f64> {
        (0..count).map(|k| ((k * 7919 + seed * 104_729) % 1000) as f64 / 999.0).collect()
    }

    #[test]
    fn a_symmetric_grid_answers_opposite_error_and_change_alike() {
        let mark = mark(Monotone::No, None);
        assert_eq!(mark.cells().len(), 25);
        let levels = levels(&mark.at(&units(25, 3)));
        for i in 0..7 {
            for j in 0..7 {
                assert_eq!(levels[i][j], levels[6 - i][6 - j]);
            }
        }
    }

    #[test]
    fn one_half_is_the_start_and_the_ends_are_its_reach() {
        let mark = mark(Monotone::No, Some(Label::ZO));
        assert_eq!(mark.cells().len(), 24);
        assert!(mark.start_is_allowed());
        let top = levels(&mark.at(&[1.0; 24]));
        assert_eq!((top[0][0], top[3][3]), (3, 0));
        assert_eq!(levels(&mark.at(&[0.0; 24]))[6][6], -3);
    }

    #[test]
    fn labels_never_fall_outwards_where_they_must_rise() {
        for (monotone, along_rows, sign) in [
            (Monotone::RisingWithError, false, 1),
            (Monotone::FallingWithError, false, -1),
            (Monotone::RisingWithChange, true, 1),
            (Monotone::FallingWithChange, true, -1),
        ] {
            for seed in 0..20 {
                let levels = levels(&mark(monotone, None).at(&units(25, seed)));
                let lines: [usize; 7] = std::array::from_fn(|line| line);
                for line in lines {
                    let at = |k: usize| {
                        sign * if along_rows { levels[line][k] } else { levels[k][line] }
                    };
                    assert!(
                        (3..6).all(|k| at(k + 1) >= at(k)) && (1..4).all(|k| at(k - 1) >= at(k))
                    );
                }
            }
        }
    }
}
