//! What many numbers say: quantiles, probabilities, ranks and shares, with how sure that is.
