//! Optimisers over the unit cube: one file each. An optimiser is asked for candidates and told their
//! costs, so that whoever evaluates them may do so anywhere.

mod lshade;
mod nelder_mead;
mod random;

pub use lshade::{LShade, Start};
pub use nelder_mead::NelderMead;

/// Proposes candidates in the unit cube and absorbs their costs.
pub trait Optimiser {
    /// The next candidates to be evaluated; none when there is nothing left to try.
    fn ask(&mut self) -> Vec<Vec<f64>>;

    /// Takes the costs of the candidates of the last [`ask`](Self::ask), in their order.
    fn tell(&mut self, costs: &[f64]);

    /// The best point so far and its cost; an infinite cost before the first answer.
    fn best(&self) -> (&[f64], f64);
}

/// A coordinate put back into [0, 1] by reflection at the side it left.
fn reflected(coordinate: f64) -> f64 {
    let folded = coordinate.abs() % 2.0;
    if folded > 1.0 { 2.0 - folded } else { folded }
}
