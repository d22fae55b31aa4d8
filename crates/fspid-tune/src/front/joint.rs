//! A band along the places of a front that holds at all of them at once.
//!
//! At each place the middle is a mean to which cases, and the seeds of each controller, contribute by draws of their own. Its
//! error and degrees of freedom are those of the contest ([`TwoWay`]). How places move together is known from the same
//! values: each one's distance from its mean, times a normal number of its own, adds up to deviations with the covariance of
//! the middle along the front; over their errors, and over the root of one chi-squared number, they are like Student's
//! t along the front. The quantile of the largest of them widens the error everywhere alike.
//!
//! # What is assumed
//! Cases are like draws of those that matter, and so are seeds, near enough to normal. The least degrees of freedom of all
//! places count for all of them, which errs on the wide side.
//!
//! # Source
//! Errors as [`TwoWay`]. For the largest deviation, J. L. Montiel Olea and M. Plagborg-Møller, *Simultaneous confidence
//! bands*, Journal of Applied Econometrics 34 (2019) 1; for Student's distribution along it, C. W. Dunnett and M. Sobel, *A
//! bivariate generalization of Student's t-distribution*, Biometrika 41 (1954) 153.

/// How sure all bands together are: as sure as a contest.
pub(super) use crate::contest::CONFIDENCE;
use crate::contest::{TwoWay, beyond};
use crate::draw::Draw;

/// Places along a front.
pub(super) const PLACES: usize = 9;
/// Fewer cases say nothing.
pub(super) const FEWEST_CASES: usize = 6;
/// Fewer seeds say nothing: two of each have so few degrees of freedom that a band would be as wide as the page.
pub(super) const FEWEST_SEEDS: usize = 3;
/// How often the largest deviation is drawn.
pub(super) const DRAWS: usize = 2000;
/// Seed of the draws.
const SEED: u64 = 0x6672_6f6e_7473;

/// A value at each place.
pub(super) type Along = [f64; PLACES];

/// Lower and upper end of a band at each place.
pub(super) type Ends = [Vec<f64>; 2];

/// Means along a front, with what they are means of.
pub(super) struct Means {
    /// The middle of the band.
    pub(super) middle: Along,
    /// What was drawn apart, such as cases and the seeds of each controller: the values whose mean contributes.
    pub(super) parts: Vec<Vec<Along>>,
}

impl Means {
    /// Lower and upper ends of the band, one of so many that hold together.
    pub(super) fn ends(&self, bands: usize) -> Ends {
        let there: Vec<TwoWay> = (0..PLACES).map(|place| self.at(place)).collect();
        let errors: Vec<f64> = there.iter().map(|it| it.error.unwrap_or(0.0)).collect();
        let freedom = there.iter().map(|it| it.freedom).fold(f64::INFINITY, f64::min);
        let chance = (1.0 - CONFIDENCE) / bands.max(1) as f64;
        let reach = beyond(self.chance_of_each(&errors, freedom, chance), freedom);
        let side = |sign: f64| {
            self.middle.iter().zip(&errors).map(|(it, e)| it + sign * reach * e).collect()
        };
        [side(-1.0), side(1.0)]
    }

    /// What the contest would say at a place alone.
    pub(super) fn at(&self, place: usize) -> TwoWay {
        let columns: Vec<Vec<f64>> =
            self.parts.iter().map(|part| part.iter().map(|it| it[place]).collect()).collect();
        TwoWay::of_parts(self.middle[place], columns.iter().map(Vec::as_slice))
    }

    /// The chance to be left at each place so that all of them together are left with the given one: that at one place
    /// where all places move as one, and a ninth of it where each moves by itself.
    fn chance_of_each(&self, errors: &[f64], freedom: f64, together: f64) -> f64 {
        let drawn = self.deviations(errors, freedom);
        let mut largest: Vec<f64> =
            drawn.iter().map(|it| it.iter().fold(0.0, |most: f64, one| most.max(*one))).collect();
        largest.sort_by(f64::total_cmp);
        let beyond = together * DRAWS as f64;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and the number of draws"
        )]
        let place = DRAWS.saturating_sub(1 + libm::floor(beyond) as usize);
        let quantile = largest[place];
        // The chance at one place and not the quantile itself: what these draws have too much of, both have, so that places
        // which move as one get the contest's own interval.
        let moving = errors.iter().filter(|it| **it > 0.0).count().max(1);
        let count = drawn.iter().flatten().filter(|it| **it > quantile).count();
        let of_each = count as f64 / (moving * DRAWS) as f64;
        of_each.clamp(together / PLACES as f64, together)
    }

    /// Sizes of deviations over their errors, drawn along the front.
    fn deviations(&self, errors: &[f64], freedom: f64) -> Vec<Along> {
        let mut random = Draw::of(SEED, 0);
        let moves = self.contributions();
        (0..DRAWS)
            .map(|_| {
                let mut sum = [0.0; PLACES];
                for of_one in &moves {
                    let by = random.normal();
                    sum.iter_mut().zip(of_one).for_each(|(sum, it)| *sum += by * it);
                }
                let scale = libm::sqrt(random.chi_squared_share(freedom));
                std::array::from_fn(|place| match errors[place] > 0.0 {
                    true => sum[place].abs() / (errors[place] * scale),
                    false => 0.0,
                })
            })
            .collect()
    }

    /// Of each value that was drawn, what it moves the middle by for each standard deviation.
    fn contributions(&self) -> Vec<Along> {
        let scattering = self.parts.iter().filter(|part| part.len() > 1);
        let of_part = |part: &Vec<Along>| {
            let count = part.len() as f64;
            let mean = mean(part.iter());
            let root = libm::sqrt(count * (count - 1.0));
            let off = |it: &Along| std::array::from_fn(|place| (it[place] - mean[place]) / root);
            part.iter().map(off).collect::<Vec<Along>>()
        };
        scattering.flat_map(of_part).collect()
    }
}

/// The mean at each place.
pub(super) fn mean<'a>(values: impl Iterator<Item = &'a Along> + Clone) -> Along {
    let count = values.clone().count().max(1) as f64;
    std::array::from_fn(|place| values.clone().map(|it| it[place]).sum::<f64>() / count)
}
