//! The numbers of CMA-ES that follow from dimension and population alone: Table 1 of Hansen's
//! tutorial (arXiv:1604.00772, 2016).

pub(super) struct Strategy {
    /// λ weights, those of the parents positive with sum 1, the others negative.
    pub(super) weights: Vec<f64>,
    /// μ, the candidates with positive weights.
    pub(super) parents: usize,
    /// μ_eff, the variance effective selection mass.
    pub(super) mass: f64,
    pub(super) c_sigma: f64,
    pub(super) damping: f64,
    pub(super) c_c: f64,
    pub(super) c_1: f64,
    pub(super) c_mu: f64,
    /// Expected length of a standard normal vector.
    pub(super) chi: f64,
    /// Generations between two decompositions of the covariance.
    pub(super) lazy: u64,
}

impl Strategy {
    pub(super) fn new(dimension: usize, lambda: usize) -> Self {
        let n = dimension as f64;
        let parents = lambda / 2;
        let raw: Vec<f64> = (1..=lambda)
            .map(|i| libm::log(0.5 * (lambda as f64 + 1.0)) - libm::log(i as f64))
            .collect();
        let (positive, negative) = raw.split_at(parents.min(raw.len()));
        let (mass, mass_negative) = (effective(positive), effective(negative));
        let c_sigma = (mass + 2.0) / (n + mass + 5.0);
        let excess = (((mass - 1.0) / (n + 1.0)).max(0.0).sqrt() - 1.0).max(0.0);
        let c_1 = 2.0 / ((n + 1.3) * (n + 1.3) + mass);
        let rank_mu = 2.0 * (0.25 + mass + 1.0 / mass - 2.0) / ((n + 2.0) * (n + 2.0) + mass);
        let c_mu = rank_mu.min(1.0 - c_1);
        let against = (1.0 + c_1 / c_mu)
            .min(1.0 + 2.0 * mass_negative / (mass + 2.0))
            .min((1.0 - c_1 - c_mu) / (n * c_mu));
        let (up, down) = (positive.iter().sum::<f64>(), -negative.iter().sum::<f64>());
        let weigh = |w: &f64| if *w >= 0.0 { w / up } else { against * w / down };
        Self {
            weights: raw.iter().map(weigh).collect(),
            parents,
            mass,
            c_sigma,
            damping: 1.0 + 2.0 * excess + c_sigma,
            c_c: (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n),
            c_1,
            c_mu,
            chi: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
            lazy: ((1.0 / (10.0 * n * (c_1 + c_mu))) as u64).max(1),
        }
    }
}

/// Squared sum over sum of squares.
fn effective(weights: &[f64]) -> f64 {
    let (sum, squares) = weights.iter().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
    sum * sum / squares
}
