//! Classical tuning rules: gains from a model of the loop, or from an experiment with it, without a search.
