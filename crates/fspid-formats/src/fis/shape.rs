//! Membership functions by the names that files give them: one row each.

use fspid_fuzzy::membership::ShapeKind;

/// A name of a membership function.
#[derive(Debug)]
pub(super) struct ShapeWord {
    /// As files write it.
    pub(super) name: &'static str,
    /// Which one it is.
    pub(super) kind: ShapeKind,
    /// Its parameters in the file, in words.
    pub(super) usage: &'static str,
    /// Where in the file each of our parameters stands.
    pub(super) order: &'static [usize],
    /// Positions in the file whose sign makes no difference.
    pub(super) even: &'static [usize],
    /// Whether MATLAB itself knows it.
    pub(super) matlab: bool,
}

const fn row(
    name: &'static str,
    kind: ShapeKind,
    usage: &'static str,
    order: &'static [usize],
) -> ShapeWord {
    ShapeWord { name, kind, usage, order, even: &[], matlab: true }
}

const fn foreign(
    name: &'static str,
    kind: ShapeKind,
    usage: &'static str,
    order: &'static [usize],
) -> ShapeWord {
    ShapeWord { name, kind, usage, order, even: &[], matlab: false }
}

/// Every name that is known.
pub(super) const SHAPES: &[ShapeWord] = &[
    row("trimf", ShapeKind::Triangle, "[a b c]", &[0, 1, 2]),
    row("trapmf", ShapeKind::Trapezoid, "[a b c d]", &[0, 1, 2, 3]),
    ShapeWord { even: &[0], ..row("gaussmf", ShapeKind::Gaussian, "[sigma centre]", &[1, 0]) },
    ShapeWord {
        even: &[0, 2],
        ..row("gauss2mf", ShapeKind::GaussianProduct, "[sigma1 c1 sigma2 c2]", &[1, 0, 3, 2])
    },
    row("gbellmf", ShapeKind::Bell, "[width slope centre]", &[2, 0, 1]),
    row("sigmf", ShapeKind::Sigmoid, "[slope centre]", &[1, 0]),
    row("dsigmf", ShapeKind::SigmoidDifference, "[slope1 c1 slope2 c2]", &[1, 0, 3, 2]),
    row("psigmf", ShapeKind::SigmoidProduct, "[slope1 c1 slope2 c2]", &[1, 0, 3, 2]),
    row("smf", ShapeKind::SmoothS, "[foot shoulder]", &[0, 1]),
    row("zmf", ShapeKind::SmoothZ, "[shoulder foot]", &[0, 1]),
    row("pimf", ShapeKind::Pi, "[a b c d]", &[0, 1, 2, 3]),
    row("linsmf", ShapeKind::LinearS, "[foot shoulder]", &[0, 1]),
    row("linzmf", ShapeKind::LinearZ, "[shoulder foot]", &[0, 1]),
    foreign("rampmf", ShapeKind::Ramp, "[start end]", &[0, 1]),
    foreign("rectmf", ShapeKind::Rectangle, "[start end]", &[0, 1]),
    foreign("cosinemf", ShapeKind::Cosine, "[centre width]", &[0, 1]),
    foreign("spikemf", ShapeKind::Spike, "[centre width]", &[0, 1]),
    foreign("concavemf", ShapeKind::Concave, "[inflection end]", &[0, 1]),
    foreign("binarymf", ShapeKind::Step, "[threshold direction]", &[0, 1]),
    foreign("arcmf", ShapeKind::Arc, "[start end]", &[0, 1]),
    foreign("semiellipsemf", ShapeKind::SemiEllipse, "[start end]", &[0, 1]),
    foreign("discretemf", ShapeKind::Points, "[x1 grade1 x2 grade2 …]", &[0, 1]),
];

/// The row of a name.
pub(super) fn by_name(name: &str) -> Option<&'static ShapeWord> {
    SHAPES.iter().find(|row| row.name.eq_ignore_ascii_case(name))
}

/// The row that MATLAB has for a kind.
pub(super) fn by_kind(kind: ShapeKind) -> Option<&'static ShapeWord> {
    SHAPES.iter().find(|row| row.matlab && row.kind == kind)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_says_where_each_parameter_stands() {
        for row in SHAPES {
            let mut places = row.order.to_vec();
            places.sort_unstable();
            assert_eq!(places, (0..row.kind.params().len()).collect::<Vec<_>>(), "{}", row.name);
            assert!(row.even.iter().all(|index| *index < row.order.len()), "{}", row.name);
        }
    }

    #[test]
    fn sigma_stands_before_the_centre_in_a_file_and_behind_it_here() {
        let row = by_kind(ShapeKind::Gaussian).unwrap();
        let ours: Vec<_> = row.order.iter().map(|&index| ["sigma", "centre"][index]).collect();
        assert_eq!(ours, row.kind.params().iter().map(|p| p.name).collect::<Vec<_>>());
    }
}
