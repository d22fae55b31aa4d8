import "uplot/dist/uPlot.min.css";
import "./app.css";
import { mount } from "svelte";
import App from "./App.svelte";
import { cockpit } from "./cockpit.svelte";

const target = document.getElementById("app");

/** The worker reads its mathematics while the page is built. */
function begin(target: HTMLElement): void {
  void cockpit.begin();
  target.replaceChildren();
  mount(App, { target });
}

// What stands in the file is painted first.
if (target) requestAnimationFrame(() => setTimeout(begin, 0, target));
