//! The re-check in interval arithmetic: what a certificate is believed for.
