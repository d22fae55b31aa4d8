//! $e^x$, the same as the crate's.

use fspid_numeric::Real;
use fspid_numeric::lanes;

use super::precision_of;
use crate::program::{Function, Kind, Parameter, Statement, local};
use crate::trace::{Lane, Listing, Traced};

/// The function `exponential`.
pub(crate) fn function<R: Real>() -> Function {
    let mut listing = Listing::new(precision_of::<R>());
    let x = Lane::<R>::new(Traced::read(local("x")));
    let mut body = listing.values(&[("power", lanes::exp(x).0)]);
    body.push(Statement::Return(Some(local("power"))));
    Function {
        name: "exponential",
        doc: "e to the power of x by sums and products alone, the same bits on every machine.",
        parts: &[],
        parameters: vec![Parameter { name: "x", kind: Kind::Real, written: false }],
        answers: Some(Kind::Real),
        body,
    }
}
