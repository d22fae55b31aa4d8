//! What may be asked for. One table: the tests walk it, so that no route can be without its guard.

use std::panic::resume_unwind;
use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::extract::rejection::PathRejection;
use axum::extract::{MatchedPath, Path, Request, State};
use axum::http::{HeaderMap, Method, Response, StatusCode, Uri};
use axum::response::IntoResponse;
use axum::routing::{MethodRouter, delete, get, post, put};
use serde_json::{Value, json};

use crate::answer::{Refusal, json_answer};
use crate::app::App;
use crate::health::health;
use crate::jobs::{self, Asked};
use crate::request::object;

type Shared = State<Arc<App>>;
type Id = Result<Path<String>, PathRejection>;
type Answer = Result<Response<Body>, Refusal>;
type Row = (&'static str, &'static str, fn() -> MethodRouter<Arc<App>>);

/// Method, path, and who answers.
const ROUTES: [Row; 11] = [
    ("GET", "/api/health", || get(told_health)),
    ("GET", "/api/scenarios", || get(list)),
    ("GET", "/api/scenarios/{id}", || get(read)),
    ("PUT", "/api/scenarios/{id}", || put(save)),
    ("GET", "/api/jobs", || get(list_jobs)),
    ("POST", "/api/jobs", || post(begin)),
    ("DELETE", "/api/jobs/{id}", || delete(cancel)),
    ("GET", "/api/jobs/{id}/events", || get(follow)),
    ("GET", "/api/jobs/{id}/runs/{run}", || get(read_run)),
    ("GET", "/api/jobs/{id}/report", || get(read_report)),
    ("GET", "/api/telemetry/events", || get(watch)),
];

/// Method and path of everything below `/api`; `{id}` stands for an id, `{run}` for a number.
pub fn routes() -> impl Iterator<Item = (&'static str, &'static str)> {
    ROUTES.iter().map(|(method, path, _)| (*method, *path))
}

/// The routes of a server.
pub(crate) fn router(app: &Arc<App>) -> Router {
    let routed = |router: Router<Arc<App>>, (_, path, answers): &Row| router.route(path, answers());
    let router = ROUTES.iter().fold(Router::new(), routed);
    #[cfg(test)]
    let router = router.route("/api/panic", get(panics));
    router.method_not_allowed_fallback(other_method).fallback(page).with_state(Arc::clone(app))
}

#[cfg(test)]
async fn panics() -> Answer {
    panic!("as the test asks")
}

/// Does what waits for a disk on a thread of its own.
async fn apart<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> T {
    match tokio::task::spawn_blocking(work).await {
        Ok(done) => done,
        // It is not stopped, so that it panicked: that is told where every panic is.
        Err(error) => resume_unwind(error.into_panic()),
    }
}

/// An id as it stands in the path; what is no text there is none.
fn named(id: Id) -> Result<String, Refusal> {
    id.map(|Path(id)| id).map_err(|_| Refusal::missing("there is nothing of that name"))
}

fn done(value: &Value) -> Answer {
    Ok(json_answer(StatusCode::OK, value))
}

async fn page(State(app): Shared, method: Method, uri: Uri) -> Answer {
    let found =
        (method == Method::GET || method == Method::HEAD).then(|| app.page.file(uri.path()));
    found.flatten().ok_or_else(|| Refusal::missing("there is nothing here"))
}

/// A path that is known, asked with a method that it does not have.
async fn other_method(path: MatchedPath, method: Method) -> Refusal {
    let known: Vec<&str> =
        routes().filter(|(_, it)| *it == path.as_str()).map(|(method, _)| method).collect();
    let sentence = format!("{method} does nothing here; {} does", known.join(" or "));
    Refusal::new(StatusCode::METHOD_NOT_ALLOWED, sentence)
}

async fn told_health(State(app): Shared) -> Answer {
    done(&health(&app))
}

async fn list(State(app): Shared) -> Answer {
    let shelf = Arc::clone(&app.shelf);
    done(&apart(move || shelf.list()).await)
}

async fn read(State(app): Shared, id: Id) -> Answer {
    let shelf = Arc::clone(&app.shelf);
    let id = named(id)?;
    let found = apart(move || shelf.read(&id)).await?;
    done(&json!({ "id": found.id, "name": found.name, "text": found.text, "digest": found.digest }))
}

async fn save(State(app): Shared, id: Id, request: Request) -> Answer {
    let id = named(id)?;
    let mut fields = object(request.into_body(), &app.limits).await?;
    let (text, digest) = (fields.needed_text("text")?, fields.needed_text("digest")?);
    fields.end()?;
    let shelf = Arc::clone(&app.shelf);
    done(&apart(move || shelf.save(&id, &text, &digest)).await?)
}

async fn list_jobs(State(app): Shared) -> Answer {
    done(&app.jobs.list())
}

async fn begin(State(app): Shared, request: Request) -> Answer {
    let fields = object(request.into_body(), &app.limits).await?;
    let asked = Asked::read(fields)?;
    let (shelf, jobs) = (Arc::clone(&app.shelf), Arc::clone(&app.jobs));
    let begun = apart(move || {
        let path = shelf.path(&asked.scenario)?;
        jobs.begin(asked, path)
    });
    let job = begun.await?;
    Ok(json_answer(StatusCode::ACCEPTED, &json!({ "job": job })))
}

async fn cancel(State(app): Shared, id: Id) -> Answer {
    done(&app.jobs.cancel(&named(id)?)?)
}

async fn follow(State(app): Shared, id: Id, headers: HeaderMap) -> Answer {
    let job = app.jobs.find(&named(id)?)?;
    app.streams.of_job(job, &headers, &app.limits).map(IntoResponse::into_response)
}

async fn read_run(
    State(app): Shared,
    ids: Result<Path<(String, String)>, PathRejection>,
) -> Answer {
    let Path((id, run)) = ids.map_err(|_| Refusal::missing("there is nothing of that name"))?;
    let job = app.jobs.find(&id)?;
    done(&apart(move || jobs::run(&job, &run)).await?)
}

async fn read_report(State(app): Shared, id: Id) -> Answer {
    let job = app.jobs.find(&named(id)?)?;
    let page = apart(move || jobs::report(&job)).await?;
    Ok(json_answer(StatusCode::OK, &json!({ "html": page })))
}

async fn watch(State(app): Shared) -> Answer {
    let none = || Refusal::missing("there is no telemetry; begin with --telemetry udp:PORT");
    let telemetry = app.telemetry.as_ref().ok_or_else(none)?;
    app.streams.of_telemetry(telemetry, &app.limits)
}
