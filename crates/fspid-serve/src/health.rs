//! How the server is.

use std::sync::atomic::Ordering;

use serde_json::{Value, json};

use crate::app::App;

/// Version of the shape of answers.
pub(crate) const SCHEMA: u32 = 1;

/// What the page of health says.
pub(crate) fn health(app: &App) -> Value {
    let limits = &app.limits;
    json!({
        "schema": SCHEMA,
        "version": env!("CARGO_PKG_VERSION"),
        "page_built": app.page.is_built(),
        "connections": app.seats.count(),
        "most_connections": limits.connections,
        "streams": app.streams.count(),
        "most_streams": limits.streams,
        "jobs": app.jobs.counts(),
        "panics": app.panics.load(Ordering::Relaxed),
        "telemetry": app.telemetry.as_ref().map(|telemetry| telemetry.told()),
    })
}
