//! Every gain that a self-tuner can produce, as boxes over cells of the supervisor's inputs.
