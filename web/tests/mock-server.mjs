// A server as `fspid serve` is one for the page: its files under a strict policy, and the interface below `/api` with one
// scenario. For tests of the page alone.
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join } from "node:path";

const TYPES = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };
const POLICY =
  "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const FILES = ["index.html", "app.js", "app.css", "worker.js", "fspid.wasm"];

export const digestOf = (text) => createHash("sha256").update(text).digest("hex");

/** Starts it; answers its address with the token, its scenario, and what was asked. */
export async function start(site, text, token = "0123456789abcdef") {
  const state = { text, asked: [], cancelled: false };
  const server = createServer((request, response) => answer(state, { site, token }, request, response));
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  const { port } = server.address();
  return { state, address: `http://127.0.0.1:${port}/#token=${token}`, stop: () => server.close() };
}

async function answer(state, { site, token }, request, response) {
  const path = new URL(request.url, "http://localhost").pathname;
  response.setHeader("Content-Security-Policy", POLICY);
  const send = (status, body) => {
    response.writeHead(status, { "Content-Type": "application/json" });
    response.end(JSON.stringify(body));
  };
  const name = path === "/" ? "index.html" : path.slice(1);
  if (request.method === "GET" && FILES.includes(name)) {
    response.writeHead(200, { "Content-Type": TYPES[extname(name)] });
    return response.end(readFileSync(join(site, name)));
  }
  if (request.headers["x-fspid-token"] !== token) return send(403, { reason: "no token" });
  state.asked.push(`${request.method} ${path}`);
  let body = "";
  for await (const piece of request) body += piece;
  const asked = body ? JSON.parse(body) : {};
  if (path === "/api/scenarios") return send(200, [{ id: "pitch.toml", name: "pitch.toml" }]);
  if (path === "/api/scenarios/pitch.toml" && request.method === "GET") {
    return send(200, { id: "pitch.toml", name: "pitch.toml", text: state.text, digest: digestOf(state.text) });
  }
  if (path === "/api/scenarios/pitch.toml") {
    if (asked.digest !== digestOf(state.text)) return send(409, { reason: "changed" });
    state.text = asked.text;
    return send(200, { digest: digestOf(state.text) });
  }
  if (path === "/api/health") return send(200, { telemetry: null });
  if (path === "/api/jobs" && request.method === "GET") return send(200, []);
  if (path === "/api/jobs" && request.method === "POST") return send(200, { job: "7" });
  if (path === "/api/jobs/7" && request.method === "DELETE") {
    state.cancelled = true;
    return send(200, {});
  }
  if (path === "/api/jobs/7/events") return tune(state, response);
  send(404, { reason: path });
}

/** Candidates whose cost falls, in pieces that do not end where events do. */
function tune(state, response) {
  response.writeHead(200, { "Content-Type": "text/event-stream" });
  const event = (name, data) => `event: ${name}\ndata: ${JSON.stringify(data)}\n\n`;
  const trial = (cost) => ({ generation: 0, allowed: true, cost, violation: 0, values: [cost], parameters: [cost] });
  const all = Array.from({ length: 10 }, (_, at) => event("candidates", { first: at, trials: [trial(10 - at)] }) + event("progress", { done: at + 1, total: 10, text: "so many" }));
  const whole = all.join("") + event("done", { text: "ten candidates" });
  for (let at = 0; at < whole.length; at += 37) response.write(whole.slice(at, at + 37));
  response.end();
}
