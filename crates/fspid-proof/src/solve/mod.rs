//! Looking for Lyapunov functions and for growing sequences of gains, in ordinary arithmetic.
