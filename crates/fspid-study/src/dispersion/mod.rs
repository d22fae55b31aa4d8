//! What differs from run to run of a campaign: distributions of the numbers of a scenario.
