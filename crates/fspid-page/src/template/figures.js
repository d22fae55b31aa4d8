// Lets the figures of a report be read, enlarged and sorted. Without it every figure is complete; nothing here computes a
// result: values are read off the drawing, by its axes, and have no more digits than the drawing holds.
"use strict";
(() => {
  // A drawn line lies within 0.06 px of its data and ends at hundredths of a pixel: this is how finely it can be read, px.
  const GRAIN_PX = 0.13;
  // A curve that runs to and fro is read at its nearest point, if that is as near as this, px.
  const NEAR_PX = 24;
  const HELP = "Arrow keys move the reading, plus and minus enlarge and reduce, 0 shows all.";

  const within = (value, low, high) => Math.min(Math.max(value, low), high);
  const element = (name, attributes = {}, text = "") => {
    const made = document.createElementNS(document.querySelector("svg").namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
  };
  const signed = (text) => (Number(text) === 0 ? text.replace("-", "") : text.replace("-", "\u2212"));

  // Axes: from a part of the axis, 0 to 1, to a value and back to words.

  function axisOf(text) {
    const [low, high, log] = text.split(" ");
    return { text, low: Number(low), high: Number(high), log: log === "log" };
  }
  function valueAt(axis, part) {
    const place = axis.low + part * (axis.high - axis.low);
    return axis.log ? 10 ** place : place;
  }
  function partOf(axis, value) {
    return ((axis.log ? Math.log10(value) : value) - axis.low) / (axis.high - axis.low);
  }
  /** A value in as many digits as can be read off an axis of that length. */
  function written(axis, part, length_px) {
    const value = valueAt(axis, part);
    const grain = Math.abs(valueAt(axis, part + GRAIN_PX / length_px) - value);
    const decimals = Math.floor(-Math.log10(grain));
    if (decimals > 12 || Math.abs(value) >= 1e9) return signed(value.toExponential(2));
    if (decimals >= 0) return signed(value.toFixed(decimals));
    return signed(String(Math.round(value * 10 ** decimals) * 10 ** -decimals));
  }
  /** Values at which an axis has ticks between two of its parts, and how they are written. */
  function ticksOf(axis, from, to, count) {
    const [low, high] = [valueAt(axis, from), valueAt(axis, to)];
    const raw = (high - low) / count;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
    const decimals = within(-Math.floor(Math.log10(step) + 1e-9), 0, 12);
    const ticks = [];
    if (axis.log && high / low > 8) {
      for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); decade += 1) {
        for (const lead of [1, 2, 5]) ticks.push({ value: lead * 10 ** decade, text: String(Number((lead * 10 ** decade).toPrecision(1))) });
      }
    } else {
      for (let n = Math.ceil(low / step - 1e-9); n * step <= high + step * 1e-9; n += 1) ticks.push({ value: n * step, text: signed((n * step).toFixed(decimals)) });
    }
    return ticks.filter((tick) => tick.value >= low && tick.value <= high);
  }

  // What a drawing holds: panels with their axes, and in them the points of curves, px of the drawing.

  function runsOf(group, svg) {
    const runs = [];
    for (const path of group.querySelectorAll("path")) {
      const data = path.getAttribute("d");
      if (!/^M[^Lz]*l[^Lz]*$/.test(data)) continue;
      const shift = svg.getScreenCTM().inverse().multiply(path.getScreenCTM());
      const numbers = data.match(/-?(?:\d+\.?\d*|\.\d+)/g).map(Number);
      let [x, y] = [shift.e, shift.f];
      const run = [];
      for (let n = 0; n + 1 < numbers.length; n += 2) run.push([(x += numbers[n]), (y += numbers[n + 1])]);
      runs.push(run);
    }
    return runs;
  }
  function panelsOf(svg) {
    const middle = (text) => [Number(text.getAttribute("x")), Number(text.getAttribute("y"))];
    const labels = (axis) => [...svg.querySelectorAll(`[data-axis="${axis}"]`)].map((text) => ({ text: text.dataset.label, at: middle(text) }));
    const nearest = (found, distance) => found.sort((a, b) => distance(a.at) - distance(b.at))[0]?.text ?? "";
    const panels = [...svg.querySelectorAll("[data-panel]")].map((group) => {
      const [x, y, width, height] = group.dataset.panel.split(" ").map(Number);
      return {
        group, x, y, width, height, curves: [],
        axes: [axisOf(group.dataset.x), axisOf(group.dataset.y)],
        isAll: "all" in group.dataset,
        names: [
          nearest(labels("x").filter(({ at }) => at[1] > y + height && Math.abs(at[0] - x - width / 2) < width / 2), (at) => at[1]),
          nearest(labels("y").filter(({ at }) => at[0] < x), (at) => Math.abs(at[1] - y - height / 2) + (x - at[0]) / 9),
        ],
        view: [[0, 1], [0, 1]],
      };
    });
    for (const group of svg.querySelectorAll("[data-curve]")) {
      const runs = runsOf(group, svg);
      const point = runs[0]?.[0];
      // A curve that is cut off ends a little outside.
      const inside = (panel) => [0, 1].every((n) => point[n] >= [panel.x, panel.y][n] - 5 && point[n] <= [panel.x + panel.width, panel.y + panel.height][n] + 5);
      const panel = point && (panels.find((one) => one.group.contains(group)) ?? panels.find(inside));
      const rises = runs.every((run) => run.every((at, n) => n === 0 || at[0] >= run[n - 1][0]));
      panel?.curves.push({ group, runs, rises, key: group.dataset.curve, name: group.dataset.name });
    }
    return panels;
  }
  /** Where a curve passes an abscissa, or its point nearest to the pointer; nothing where there is none. */
  function pointOf(curve, x, y) {
    if (curve.rises) {
      for (const run of curve.runs) {
        const next = run.findIndex((at) => at[0] > x);
        const last = next < 0 ? run.length - 1 : next;
        if (last < 1 || x < run[0][0] || x > run[run.length - 1][0] + 0.01) continue;
        const [a, b] = [run[last - 1], run[last]];
        return [x, b[0] > a[0] ? a[1] + ((b[1] - a[1]) * (x - a[0])) / (b[0] - a[0]) : b[1]];
      }
      return null;
    }
    let [best, least] = [null, NEAR_PX];
    for (const run of curve.runs) {
      for (let n = 1; n < run.length; n += 1) {
        const [[ax, ay], [bx, by]] = [run[n - 1], run[n]];
        const along = within(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2 || 1), 0, 1);
        const at = [ax + along * (bx - ax), ay + along * (by - ay)];
        const distance = Math.hypot(at[0] - x, at[1] - y);
        if (distance < least) [best, least] = [at, distance];
      }
    }
    return best;
  }

  function enliven(drawing, svg) {
    const whole = svg.getAttribute("viewBox").split(" ").map(Number);
    const box = [...whole];
    let known = null;
    const panels = () => (known ??= panelsOf(svg));
    const marks = element("g", { "pointer-events": "none" });
    svg.append(marks);
    let cursor = null; // the panel, and the place in it as parts of its axes
    let drag = null;

    svg.setAttribute("role", "group");
    drawing.tabIndex = 0;
    drawing.setAttribute("role", "group");
    drawing.setAttribute("aria-label", `${svg.querySelector("title").textContent}. ${HELP}`);
    const reading = document.createElement("div");
    reading.className = "reading";
    reading.hidden = true;
    reading.setAttribute("role", "status");
    const tools = document.createElement("div");
    tools.className = "tools";
    drawing.after(tools);
    const button = (text, label, act) => {
      const made = document.createElement("button");
      Object.assign(made, { type: "button", textContent: text, title: label, onclick: act });
      made.setAttribute("aria-label", `${label}: ${svg.querySelector("title").textContent}`);
      tools.append(made);
    };

    const partOfView = ([low, high], part) => low + part * (high - low);
    /** From parts of the axes to px of the drawing as it is shown. */
    const shown = (panel, parts) => {
      const [x, y] = parts.map((part, n) => (part - panel.view[n][0]) / (panel.view[n][1] - panel.view[n][0]));
      return [panel.x + x * panel.width, panel.y + (1 - y) * panel.height];
    };
    const partsAt = (panel, [x, y]) => [partOfView(panel.view[0], (x - panel.x) / panel.width), partOfView(panel.view[1], 1 - (y - panel.y) / panel.height)];
    const place = (event) => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      return [at.x, at.y];
    };
    const panelAt = ([x, y]) => panels().find((one) => x >= one.x && x <= one.x + one.width && y >= one.y && y <= one.y + one.height);
    const nameOf = (panel, curve) => {
      const entries = [...svg.querySelectorAll(`[data-entry="${curve.key}"]`)].map((entry) => entry.querySelector("text"));
      return curve.name ?? entries.filter((text) => Number(text.getAttribute("y")) < panel.y + panel.height).pop()?.textContent ?? "";
    };

    function read() {
      marks.replaceChildren();
      reading.hidden = !cursor;
      if (!cursor) return;
      const { panel, parts } = cursor;
      const lines = [];
      const alike = panels().filter((one) => one === panel || (one.axes[0].text === panel.axes[0].text && one.x === panel.x));
      for (const one of alike) {
        const at = [one.x + parts[0] * one.width, one.y + (1 - parts[1]) * one.height];
        const found = one.curves.filter((curve) => !curve.isOff).map((curve) => ({ curve, point: pointOf(curve, ...at) })).filter(({ point }) => point);
        const values = found.map(({ curve, point }) => {
          const [x, y] = [(point[0] - one.x) / one.width, 1 - (point[1] - one.y) / one.height];
          const mark = shown(one, [x, y]);
          if (y >= one.view[1][0] && y <= one.view[1][1]) marks.append(element("circle", { cx: mark[0], cy: mark[1], r: 3.5, class: "mark" }));
          const texts = [written(one.axes[0], x, one.width), written(one.axes[1], y, one.height)];
          return `${nameOf(one, curve)} ${curve.rises ? texts[1] : `(${texts.join(", ")})`}`.trim();
        });
        const x = shown(one, parts)[0];
        marks.append(element("path", { d: `M${x} ${one.y}V${one.y + one.height}`, class: "cursor" }));
        if (values.length) lines.push([one.names[1], values.join(" \u00b7 ")]);
      }
      const name = alike.map((one) => one.names[0]).find((text) => text) ?? "";
      const rows = [[name, written(panel.axes[0], parts[0], panel.width)], ...lines];
      reading.replaceChildren(...rows.map(([label, text]) => {
        const line = document.createElement("p");
        const head = document.createElement("b");
        head.textContent = label;
        line.append(head, ` ${text}`);
        return line;
      }));
    }

    /** Puts the content, the grid and the numbers of a panel where its view is. */
    function draw(panel) {
      const { x, y, width, height, view } = panel;
      const isWhole = view.flat().join() === "0,1,0,1";
      const clip = panel.group.querySelector("g[clip-path]");
      if (!panel.content) {
        panel.content = element("g", { class: "stretched" });
        panel.content.append(...clip.childNodes);
        clip.append(panel.content);
        panel.ground = element("g", { "font-size": 11 });
        panel.group.prepend(panel.ground);
        panel.hasNumbers = Boolean(panel.group.querySelector('[data-ground] text[text-anchor="middle"]'));
      }
      const area = clip.previousElementSibling.firstElementChild;
      const [left, top] = [Number(area.getAttribute("x")), Number(area.getAttribute("y"))];
      const [sx, sy] = view.map(([low, high]) => 1 / (high - low));
      panel.content.setAttribute("transform", `matrix(${sx} 0 0 ${sy} ${left - sx * (left + view[0][0] * width)} ${top - sy * (top + (1 - view[1][1]) * height)})`);
      for (const ground of panel.group.querySelectorAll("[data-ground]")) ground.style.display = isWhole ? "" : "none";
      panel.ground.replaceChildren();
      if (isWhole) return;
      for (const n of [0, 1]) {
        for (const tick of ticksOf(panel.axes[n], ...view[n], n ? height / 34 : width / 90)) {
          const parts = [view[0][0], view[1][0]];
          parts[n] = partOf(panel.axes[n], tick.value);
          const at = shown(panel, parts);
          panel.ground.append(element("path", { class: "grid", d: n ? `M${x - 4} ${at[1]}H${x + width}` : `M${at[0]} ${y}V${y + height + 4}` }));
          if (n) panel.ground.append(element("text", { x: x - 7, y: at[1] + 4, "text-anchor": "end" }, tick.text));
          else if (panel.hasNumbers) panel.ground.append(element("text", { x: at[0], y: y + height + 15, "text-anchor": "middle" }, tick.text));
        }
      }
    }
    /** Shows these parts of the axes; panels over one abscissa stay together. Other drawings are enlarged as pictures. */
    function look(panel, view) {
      const sides = view.map(([low, high]) => [within(low, 0, 1 - 1e-6), within(high, 1e-6, 1)]);
      if (sides.some(([low, high]) => high - low < 1e-4)) return;
      if (panel.isAll) {
        for (const one of panels().filter((one) => one.isAll && one.axes[0].text === panel.axes[0].text)) {
          one.view = [sides[0], one === panel ? sides[1] : one.view[1]];
          draw(one);
        }
      } else {
        const isWhole = sides.flat().join() === "0,1,0,1";
        const [[x0, x1], [y0, y1]] = sides;
        const part = [panel.x + x0 * panel.width, panel.y + (1 - y1) * panel.height, (x1 - x0) * panel.width, (y1 - y0) * panel.height];
        panels().forEach((one) => (one.look = one === panel ? sides : null));
        (isWhole ? whole : part).forEach((value, n) => (box[n] = value));
        svg.setAttribute("viewBox", box.join(" "));
      }
      svg.toggleAttribute("data-enlarged", sides.flat().join() !== "0,1,0,1");
      read();
    }
    const viewOf = (panel) => (panel.isAll ? panel.view : panel.look ?? [[0, 1], [0, 1]]);
    function enlarge(factor, at = cursor) {
      const panel = at?.panel ?? panels()[0];
      const view = viewOf(panel);
      const parts = at?.parts ?? view.map(([low, high]) => (low + high) / 2);
      const sides = view.map(([low, high], n) => (n && panel.isAll ? [low, high] : [parts[n] - (parts[n] - low) / factor, parts[n] + (high - parts[n]) / factor]));
      look(panel, sides);
    }
    function reset() {
      for (const panel of panels()) look(panel, [[0, 1], [0, 1]]);
      svg.removeAttribute("data-enlarged");
    }
    button("+", "Enlarge", () => enlarge(1.6));
    button("\u2212", "Reduce", () => enlarge(1 / 1.6));
    button("All", "Show all", reset);
    tools.append(reading);

    svg.addEventListener("pointermove", (event) => {
      const at = place(event);
      if (drag) {
        const { panel, from } = drag;
        const to = [within(at[0], panel.x, panel.x + panel.width), within(at[1], panel.y, panel.y + panel.height)];
        drag.to = to;
        const [x, y] = [0, 1].map((n) => Math.min(from[n], to[n]));
        marks.replaceChildren(element("rect", { x, y, width: Math.abs(to[0] - from[0]), height: Math.abs(to[1] - from[1]), class: "drag" }));
        return;
      }
      const panel = panelAt(at);
      cursor = panel ? { panel, parts: partsAt(panel, at) } : null;
      reading.setAttribute("aria-live", "off");
      read();
    });
    svg.addEventListener("pointerleave", () => {
      if (!drag) cursor = null;
      read();
    });
    svg.addEventListener("pointerdown", (event) => {
      const from = place(event);
      const panel = panelAt(from);
      // A finger scrolls the page; it has the buttons.
      if (!panel || event.pointerType === "touch" || event.button !== 0 || event.target.closest("[data-entry]")) return;
      drag = { panel, from, to: from };
      svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointerup", () => {
      if (!drag) return;
      const { panel, from, to } = drag;
      drag = null;
      const ends = [from, to].map((at) => partsAt(panel, at));
      const isWide = [0, 1].map((n) => Math.abs(to[n] - from[n]) > 8);
      if (isWide[0] || isWide[1]) look(panel, [0, 1].map((n) => (isWide[n] ? [Math.min(ends[0][n], ends[1][n]), Math.max(ends[0][n], ends[1][n])] : viewOf(panel)[n])));
      else read();
    });
    svg.addEventListener("dblclick", reset);
    // The wheel scrolls the page until the figure was chosen, or Ctrl is held.
    svg.addEventListener("wheel", (event) => {
      if (!cursor || !(event.ctrlKey || document.activeElement === drawing)) return;
      event.preventDefault();
      enlarge(event.deltaY < 0 ? 1.25 : 0.8);
    }, { passive: false });
    drawing.addEventListener("keydown", (event) => {
      if (event.target !== drawing || event.ctrlKey || event.metaKey || event.altKey) return;
      const panel = cursor?.panel ?? panels()[0];
      const view = viewOf(panel);
      const parts = cursor?.parts ?? view.map(([low, high]) => (low + high) / 2);
      const far = event.shiftKey ? 0.1 : 0.01;
      const moves = { ArrowLeft: [0, -far], ArrowRight: [0, far], ArrowDown: [1, -far], ArrowUp: [1, far], Home: [0, -1], End: [0, 1] };
      const acts = { "+": () => enlarge(1.6), "=": () => enlarge(1.6), "-": () => enlarge(1 / 1.6), 0: reset, Escape: reset };
      if (!(event.key in moves) && !(event.key in acts)) return;
      event.preventDefault();
      reading.setAttribute("aria-live", "polite");
      cursor = { panel, parts };
      if (event.key in acts) return acts[event.key]();
      const [n, by] = moves[event.key];
      parts[n] = within(parts[n] + by * (view[n][1] - view[n][0]), ...view[n]);
      read();
    });
    drawing.addEventListener("blur", () => {
      cursor = null;
      read();
    });

    const switches = [...svg.querySelectorAll("[data-entry]")].map((entry) => {
      const frame = entry.getBBox();
      entry.prepend(element("rect", { x: frame.x - 3, y: frame.y - 3, width: frame.width + 6, height: frame.height + 6, fill: "transparent" }));
      const name = entry.querySelector("text").textContent;
      for (const [key, value] of Object.entries({ role: "button", tabindex: 0, "aria-label": name, "aria-pressed": true })) entry.setAttribute(key, value);
      const turn = (isOn) => {
        entry.setAttribute("aria-pressed", isOn);
        const series = `series-${(Number(entry.dataset.entry) % 7) + 1}`;
        for (const panel of panels()) {
          for (const curve of panel.curves.filter((one) => one.key === entry.dataset.entry && nameOf(panel, one) === name)) {
            curve.isOff = !isOn;
            curve.group.style.display = isOn ? "" : "none";
          }
          // Signs, disks and words that belong to the curve of an analysis.
          const others = panel.isAll ? [] : [...svg.querySelectorAll(`.s-${series},.f-${series},[data-of="${series}"]`)];
          for (const one of others.filter((one) => !one.closest("[data-entry]"))) one.style.display = isOn ? "" : "none";
        }
        read();
      };
      const toggle = () => turn(entry.getAttribute("aria-pressed") !== "true");
      entry.addEventListener("click", toggle);
      entry.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        toggle();
      });
      return turn;
    });
    // On paper a figure is complete.
    addEventListener("beforeprint", () => {
      if (svg.hasAttribute("data-enlarged")) reset();
      for (const turn of switches) turn(true);
    });
  }

  for (const svg of document.querySelectorAll(".drawing > svg")) {
    if (svg.querySelector("[data-panel]") && svg.querySelector("[data-curve]")) enliven(svg.parentElement, svg);
  }
})();
