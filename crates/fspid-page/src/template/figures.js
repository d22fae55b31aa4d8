// Lets the figures of a report be read, enlarged and sorted. Without it every figure is complete; nothing here computes a
// result: values are read off the drawing, by its axes, and have no more digits than the drawing holds.
"use strict";
(() => {
  // A drawn line lies within 0.06 px of its data and ends at hundredths of a pixel: this is how finely it can be read, px.
  const GRAIN_PX = 0.13;
  // A curve that runs to and fro is read at its nearest point, if that is as near as this, px.
  const NEAR_PX = 24;
  // Signs and heads of arrows, which are moved and not stretched, are smaller than this, px.
  const SMALL_PX = 16;
  const HELP = "Arrow keys move the reading.";
  const HELP_TO_ENLARGE = " Plus and minus enlarge and reduce, 0 shows all.";

  const within = (value, low, high) => Math.min(Math.max(value, low), high);
  const element = (name, attributes = {}, text = "") => {
    const made = document.createElementNS(document.querySelector("svg").namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
  };
  /** From the place of something in the drawing to px of the drawing. */
  const shiftOf = (node, svg) => svg.getScreenCTM().inverse().multiply(node.getScreenCTM());
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
    return rounded(value, Math.abs(valueAt(axis, part + GRAIN_PX / length_px) - value));
  }
  /** A value that is known to a grain, in the digits that this leaves. */
  function rounded(value, grain) {
    const decimals = Math.floor(-Math.log10(grain));
    if (decimals > 12 || Math.abs(value) >= 1e9) return signed(value.toExponential(2));
    if (decimals >= 0) return signed(value.toFixed(decimals));
    return signed(String(Math.round(value * 10 ** decimals) * 10 ** -decimals));
  }
  const raised = (power) => String(power).replace(/./g, (digit) => (digit === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[digit]));
  /** A power of ten and its first digit, as the figures write it. */
  function powerText(lead, power) {
    if (Math.abs(power) < 5) return (lead * 10 ** power).toFixed(Math.max(0, -power));
    return `${lead === 1 ? "" : `${lead}\u00d7`}10${raised(power)}`;
  }
  /** Values at which an axis has ticks between two of its parts, and how they are written; angles go by parts of a turn. */
  function ticksOf(axis, from, to, count, isAngle = false) {
    const [low, high] = [valueAt(axis, from), valueAt(axis, to)];
    const ticks = [];
    const decades = Math.log10(high / low);
    if (axis.log && decades > 0.9) {
      const every = Math.max(1, Math.ceil(decades / count));
      const leads = 3 * decades <= 1.5 * count ? [1, 2, 5] : [1];
      for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power += 1) {
        if (power % every === 0) for (const lead of leads) ticks.push({ value: lead * 10 ** power, text: powerText(lead, power) });
      }
    } else {
      const raw = (high - low) / count;
      const power = 10 ** Math.floor(Math.log10(raw));
      const turns = isAngle && raw > 7.5 && [15, 30, 45, 90, 180, 360].find((step) => step >= raw);
      const step = turns || power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
      const decimals = within(-Math.floor(Math.log10(step) + 1e-9), 0, 12);
      for (let n = Math.ceil(low / step - 1e-9); n * step <= high + step * 1e-9; n += 1) ticks.push({ value: n * step, text: signed((n * step).toFixed(decimals)) });
    }
    return ticks.filter((tick) => tick.value >= low && tick.value <= high);
  }

  // What a drawing holds: panels with their axes, and in them the points of curves, px of the drawing.

  /** The lines of a curve, or the outlines of a band. */
  function runsOf(group, svg, isBand) {
    const runs = [];
    const known = isBand ? /^M[^Lz]*l[^Lz]*z$/ : /^M[^LzM]*l[^Lz]*$/;
    for (const path of group.querySelectorAll("path")) {
      const shift = shiftOf(path, svg);
      for (const data of path.getAttribute("d").match(/M[^M]*/g) ?? []) {
        if (!known.test(data)) continue;
        const numbers = data.match(/-?(?:\d+\.?\d*|\.\d+)/g).map(Number);
        let [x, y] = [shift.e, shift.f];
        const run = [];
        for (let n = 0; n + 1 < numbers.length; n += 2) run.push([(x += numbers[n]), (y += numbers[n + 1])]);
        runs.push(run);
      }
    }
    return runs;
  }
  /** Cells of a map or bins of a histogram: ends or nodes of columns and rows, and a word for each cell, from below. */
  function cellsOf({ columns, rows, cells, levels, quantity = "" }) {
    if (cells === undefined) return null;
    const texts = [columns, rows].map((all) => (all ? all.split(" ") : []));
    const ends = texts.map((all) => all.map((text) => Number(text.replace("\u2212", "-"))));
    let words;
    if (levels) {
      const [low, high] = levels.split(" ").map(Number);
      const grain = (high - low) / 1295;
      words = cells.match(/../g).map((two) => (two === ".." ? "no value" : rounded(low + parseInt(two, 36) * grain, grain)));
    } else {
      let last = "";
      words = cells.split(";").map((word) => (last = word || last));
    }
    // Ends are one more than what lies between them; a single row has none.
    const isEnds = words.length !== ends[0].length * (ends[1].length || 1);
    const counts = ends.map((all) => (all.length ? all.length - isEnds : 1));
    const bounds = ends.map((all) => (isEnds ? all : all.map((_, n) => (n ? (all[n - 1] + all[n]) / 2 : -Infinity)).concat(Infinity)));
    return { texts, ends, words, isEnds, counts, bounds, quantity };
  }
  /** Which column or row a value lies in; -1 for none. */
  const cellAt = ({ bounds }, n, value) => (bounds[n].length ? bounds[n].findIndex((low, at) => value >= low && value <= bounds[n][at + 1]) : 0);
  const endsText = ({ texts, isEnds }, n, at) => (isEnds ? `${texts[n][at]} to ${texts[n][at + 1]}` : texts[n][at]);

  /** Points that stand alone: where they are, whose they are, and which run each is. */
  function pointsOf(panel) {
    const points = [];
    for (const { dataset, children } of panel.querySelectorAll("[data-at], [data-points]")) {
      let at = (dataset.at ?? "").split(" ").map(Number);
      if (dataset.points) {
        const [dx, dy, strokes] = dataset.points.split(" ").map(Number);
        const corners = [...children].flatMap((path) => [...path.getAttribute("d").matchAll(/M(\S+) (-?[\d.]+)/g)]);
        at = corners.filter((_, n) => n % strokes === 0).flatMap(([, x, y]) => [Number(x) + dx, Number(y) + dy]);
      }
      let run = 0;
      const runs = dataset.runs?.split(" ").map((step) => (run += Number(step)));
      for (let n = 0; n + 1 < at.length; n += 2) points.push({ at: [at[n], at[n + 1]], name: dataset.name, run: runs?.[n / 2] });
    }
    return points;
  }
  function panelsOf(svg) {
    const middle = (text) => {
      const { e, f } = shiftOf(text.parentElement, svg);
      return [Number(text.getAttribute("x")) + e, Number(text.getAttribute("y")) + f];
    };
    const labels = (axis) => [...svg.querySelectorAll(`[data-axis="${axis}"]`)].map((text) => ({ text: text.dataset.label, at: middle(text) }));
    const nearest = (found, distance) => found.sort((a, b) => distance(a.at) - distance(b.at))[0]?.text ?? "";
    const panels = [...svg.querySelectorAll("[data-panel]")].map((group) => {
      const [left, top, width, height] = group.dataset.panel.split(" ").map(Number);
      const { e, f } = shiftOf(group, svg);
      const [x, y] = [left + e, top + f];
      const axes = [axisOf(group.dataset.x), axisOf(group.dataset.y)];
      const [across, up] = axes.map(({ low, high }, n) => [width, height][n] / (high - low));
      return {
        group, x, y, width, height, axes, curves: [],
        name: group.dataset.name ?? "",
        cells: cellsOf(group.dataset),
        points: pointsOf(group),
        isAll: "all" in group.dataset,
        // Without a ground that can be put elsewhere it is read, and not enlarged.
        isStill: !group.querySelector("[data-ground]"),
        isEqual: !axes.some(({ log }) => log) && Math.abs(across / up - 1) < 1e-3,
        names: [
          nearest(labels("x").filter(({ at }) => at[1] > y + height && Math.abs(at[0] - x - width / 2) < width / 2), (at) => at[1]),
          nearest(labels("y").filter(({ at }) => at[0] < x), (at) => Math.abs(at[1] - y - height / 2) + (x - at[0]) / 9),
        ],
        view: [[0, 1], [0, 1]],
      };
    });
    for (const group of svg.querySelectorAll("[data-curve]")) {
      const isBand = group.dataset.curve === "band";
      const runs = runsOf(group, svg, isBand);
      const point = runs[0]?.[0];
      // A curve that is cut off ends a little outside.
      const inside = (panel) => [0, 1].every((n) => point[n] >= [panel.x, panel.y][n] - 5 && point[n] <= [panel.x + panel.width, panel.y + panel.height][n] + 5);
      const panel = point && (panels.find((one) => one.group.contains(group)) ?? panels.find(inside));
      const rises = isBand || runs.every((run) => run.every((at, n) => n === 0 || at[0] >= run[n - 1][0]));
      panel?.curves.push({ group, runs, rises, isBand, key: group.dataset.curve, name: group.dataset.name });
    }
    return panels;
  }
  /** The lower and the upper end of a band at an abscissa. */
  function bandAt({ runs }, x) {
    const ends = runs.flatMap((run) => run.flatMap(([bx, by], n) => {
      const [ax, ay] = run.at(n - 1);
      return ax <= x !== bx <= x ? [ay + ((by - ay) * (x - ax)) / (bx - ax)] : [];
    }));
    return ends.length ? [x, Math.max(...ends), Math.min(...ends)] : null;
  }
  /** Where a curve passes an abscissa, or its point nearest to the pointer; nothing where there is none. */
  function pointOf(curve, x, y) {
    if (curve.isBand) return bandAt(curve, x);
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
    const isStill = !svg.querySelector("[data-panel] [data-ground]");
    let known = null;
    const panels = () => (known ??= panelsOf(svg));
    const marks = element("g", { "pointer-events": "none" });
    svg.append(marks);
    let cursor = null; // the panel, and the place in it as parts of its axes
    let drag = null;

    svg.setAttribute("role", "group");
    drawing.tabIndex = 0;
    drawing.setAttribute("role", "group");
    drawing.setAttribute("aria-label", `${svg.querySelector("title").textContent}. ${HELP}${isStill ? "" : HELP_TO_ENLARGE}`);
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
      const alike = panels().filter((one) => one === panel || (one.axes[0].text === panel.axes[0].text && one.x === panel.x));
      const rows = panel.cells ? cellRows(alike, parts) : panel.points.length ? pointRows(panel, parts) : curveRows(alike, panel, parts);
      reading.replaceChildren(...rows.map(([label, text]) => {
        const line = document.createElement("p");
        const head = document.createElement("b");
        head.textContent = label;
        line.append(head, ` ${text}`);
        return line;
      }));
    }
    const nameBelow = (alike) => alike.map((one) => one.names[0]).find((text) => text) ?? "";

    /** What curves and bands are where the cursor is, panel by panel. */
    function curveRows(alike, panel, parts) {
      const lines = [];
      for (const one of alike) {
        const at = [one.x + parts[0] * one.width, one.y + (1 - parts[1]) * one.height];
        const found = one.curves.filter((curve) => !curve.isOff).map((curve) => ({ curve, point: pointOf(curve, ...at) })).filter(({ point }) => point);
        const values = new Map();
        for (const { curve, point } of found) {
          const x = (point[0] - one.x) / one.width;
          const ys = point.slice(1).map((y) => 1 - (y - one.y) / one.height);
          for (const y of ys.filter((y) => y >= one.view[1][0] && y <= one.view[1][1])) {
            const mark = shown(one, [x, y]);
            marks.append(element("circle", { cx: mark[0], cy: mark[1], r: curve.isBand ? 2 : 3.5, class: "mark" }));
          }
          const text = ys.map((y) => written(one.axes[1], y, one.height)).join(" to ");
          const value = curve.rises ? text : `(${written(one.axes[0], x, one.width)}, ${text})`;
          const name = nameOf(one, curve);
          values.set(name, [...(values.get(name) ?? []), value]);
        }
        const x = shown(one, parts)[0];
        marks.append(element("path", { d: `M${x} ${one.y}V${one.y + one.height}`, class: "cursor" }));
        const told = [...values].map(([name, all]) => `${name} ${all.join(", ")}`.trim());
        if (told.length) lines.push([[one.name, one.names[1]].filter(Boolean).join(": "), told.join(" \u00b7 ")]);
      }
      return [[nameBelow(alike), written(panel.axes[0], parts[0], panel.width)], ...lines];
    }
    /** The cell under the cursor, of a histogram in each row. */
    function cellRows(alike, parts) {
      const rows = [];
      for (const one of alike.filter(({ cells }) => cells)) {
        const { cells, axes } = one;
        const at = [0, 1].map((n) => cellAt(cells, n, valueAt(axes[n], parts[n])));
        if (at.includes(-1)) continue;
        outline(one, at);
        const word = cells.words[at[1] * cells.counts[0] + at[0]];
        const name = [one.name, cells.quantity].filter(Boolean).join(": ");
        if (cells.ends[1].length) rows.push([one.names[0], endsText(cells, 0, at[0])], [one.names[1], endsText(cells, 1, at[1])], [name, word]);
        else rows.push([name, `${word} (${endsText(cells, 0, at[0])})`]);
      }
      return alike[0].cells.ends[1].length && rows.length ? rows : [[nameBelow(alike), written(alike[0].axes[0], parts[0], alike[0].width)], ...rows];
    }
    /** Draws the frame of a cell. */
    function outline({ x, y, width, height, cells, axes }, at) {
      const [from, to] = [0, 1].map((more) => [0, 1].map((n) => within(partOf(axes[n], cells.bounds[n][at[n] + more] ?? more * Infinity), 0, 1)));
      const rows = cells.ends[1].length ? [from[1], to[1]] : [0, 1];
      marks.append(element("rect", { x: x + from[0] * width, y: y + (1 - rows[1]) * height, width: (to[0] - from[0]) * width, height: (rows[1] - rows[0]) * height, class: "mark cell" }));
    }
    /** The point that is nearest to the cursor. */
    function pointRows(panel, parts) {
      const at = [panel.x + parts[0] * panel.width, panel.y + (1 - parts[1]) * panel.height];
      const far = (point) => Math.hypot(point.at[0] - at[0], point.at[1] - at[1]);
      const nearest = panel.points.reduce((a, b) => (far(b) < far(a) ? b : a));
      const isNear = far(nearest) < NEAR_PX;
      const told = isNear ? [(nearest.at[0] - panel.x) / panel.width, 1 - (nearest.at[1] - panel.y) / panel.height] : parts;
      if (isNear) marks.append(element("circle", { cx: nearest.at[0], cy: nearest.at[1], r: 6, class: "mark cell" }));
      const rows = [0, 1].map((n) => [panel.names[n], written(panel.axes[n], told[n], n ? panel.height : panel.width)]);
      return isNear ? [...rows, [nearest.run === undefined ? "" : `run ${nearest.run}`, nearest.name]] : rows;
    }
    /** Where an arrow key leads: on by a part of the panel, to the next cell, or to the next point. */
    function moved(panel, parts, n, by) {
      const to = [...parts];
      const way = Math.sign(by);
      if (panel.cells) {
        const { cells, axes } = panel;
        if (!cells.bounds[n].length) return to;
        const now = cellAt(cells, n, valueAt(axes[n], parts[n]));
        // From outside the way leads to the nearest cell.
        const from = now >= 0 ? now + way * (Math.abs(by) < 0.05 ? 1 : 5) : parts[n] < 0.5 ? 0 : Infinity;
        const at = Math.abs(by) === 1 ? way * Infinity : from;
        const next = within(at, 0, cells.counts[n] - 1);
        const ends = [0, 1].map((more) => within(partOf(axes[n], cells.bounds[n][next + more]), 0, 1));
        to[n] = (ends[0] + ends[1]) / 2;
      } else if (panel.points.length) {
        const places = panel.points.map(({ at }) => [(at[0] - panel.x) / panel.width, 1 - (at[1] - panel.y) / panel.height]);
        const ahead = (place) => (place[n] - parts[n]) * way || (place[1 - n] - parts[1 - n]) * way;
        const next = places.filter((place) => ahead(place) > 1e-9).sort((a, b) => ahead(a) - ahead(b));
        return (Math.abs(by) === 1 ? next.pop() : next[Math.abs(by) < 0.05 ? 0 : Math.min(9, next.length - 1)]) ?? to;
      } else {
        const view = panel.view[n];
        to[n] = within(parts[n] + by * (view[1] - view[0]), ...view);
      }
      return to;
    }

    /**
     * Finds what is drawn in a panel beside its own group: lines are stretched with the axes, signs and words stay as large
     * as they are and move with their point.
     */
    function gather(panel) {
      if (panel.pieces) return;
      panel.pieces = [];
      if (panel.isAll) return;
      const { x, y, width, height } = panel;
      const id = `${svg.id}-p${panels().indexOf(panel)}`;
      const clip = element("clipPath", { id });
      clip.append(element("rect", { x, y, width, height }));
      const layers = [0, 1].map(() => element("g", { "clip-path": `url(#${id})`, class: "stretched" }));
      const number = (node, name) => Number(node.getAttribute(name));
      const boxOf = (one) => {
        const clipped = one.matches("[clip-path]") ? one : one.querySelector("[clip-path]");
        const frame = clipped?.previousElementSibling?.firstElementChild;
        return frame ? { x: number(frame, "x"), y: number(frame, "y"), width: number(frame, "width"), height: number(frame, "height") } : one.getBBox();
      };
      const middle = (box) => [box.x + box.width / 2, box.y + box.height / 2];
      const isInside = (box) => {
        const [cx, cy] = middle(box);
        return cx >= x && cx <= x + width && cy >= y && cy <= y + height && box.width <= width + 4 && box.height <= height + 4;
      };
      const others = [...svg.children].filter((one) => one !== marks && one.matches("g,path,circle,rect,text") && !one.matches("[data-panel],[data-entry],[data-axis],.stretched"));
      const mine = others.filter((one) => isInside(boxOf(one)));
      for (const one of mine) {
        const isCurve = one.matches("[data-curve]");
        const pieces = one.matches("[data-of]") ? [one] : [one, ...one.querySelectorAll("path,circle,rect,text")].filter((piece) => piece.localName !== "g" && !piece.closest("clipPath"));
        for (const piece of pieces) {
          const box = piece.getBBox();
          const isSmall = !isCurve && (piece.matches("text,[data-of]") || Math.max(box.width, box.height) < SMALL_PX);
          const at = isSmall ? piece.dataset.anchor?.split(" ").map(Number) ?? middle(box) : null;
          panel.pieces.push({ one: piece, at, own: piece.getAttribute("transform") ?? "" });
        }
      }
      const isBehind = mine.map((one) => Boolean(one.compareDocumentPosition(panel.group) & Node.DOCUMENT_POSITION_FOLLOWING));
      mine.forEach((one, n) => layers[isBehind[n] ? 0 : 1].append(one));
      panel.group.before(clip, layers[0]);
      marks.before(layers[1]);
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
      gather(panel);
      const area = clip.previousElementSibling.firstElementChild;
      const [left, top] = [Number(area.getAttribute("x")), Number(area.getAttribute("y"))];
      const [sx, sy] = view.map(([low, high]) => 1 / (high - low));
      panel.content.setAttribute("transform", `matrix(${sx} 0 0 ${sy} ${left - sx * (left + view[0][0] * width)} ${top - sy * (top + (1 - view[1][1]) * height)})`);
      for (const ground of panel.group.querySelectorAll("[data-ground]")) ground.style.display = isWhole ? "" : "none";
      const across = `matrix(${sx} 0 0 ${sy} ${x - sx * (x + view[0][0] * width)} ${y - sy * (y + (1 - view[1][1]) * height)})`;
      for (const { one, at, own } of panel.pieces) {
        if (isWhole) one.setAttribute("transform", own);
        else if (!at) one.setAttribute("transform", across);
        else {
          const to = shown(panel, [(at[0] - x) / width, 1 - (at[1] - y) / height]);
          one.setAttribute("transform", `translate(${to[0] - at[0]} ${to[1] - at[1]}) ${own}`);
        }
      }
      panel.ground.replaceChildren();
      if (isWhole) return;
      for (const n of [0, 1]) {
        for (const tick of ticksOf(panel.axes[n], ...view[n], n ? height / 34 : width / 90, /phase/.test(panel.names[n]))) {
          const parts = [view[0][0], view[1][0]];
          parts[n] = partOf(panel.axes[n], tick.value);
          const at = shown(panel, parts);
          panel.ground.append(element("path", { class: "grid", d: n ? `M${x - 4} ${at[1]}H${x + width}` : `M${at[0]} ${y}V${y + height + 4}` }));
          if (n) panel.ground.append(element("text", { x: x - 7, y: at[1] + 4, "text-anchor": "end" }, tick.text));
          else if (panel.hasNumbers) panel.ground.append(element("text", { x: at[0], y: y + height + 15, "text-anchor": "middle" }, tick.text));
        }
      }
    }
    /** Shows these parts of the axes; panels over one abscissa stay together, and a circle stays one. */
    function look(panel, view) {
      if (panel.isStill) return;
      const sides = view.map(([low, high]) => [within(low, 0, 1 - 1e-6), within(high, 1e-6, 1)]);
      if (sides.some(([low, high]) => high - low < 1e-4)) return;
      if (panel.isEqual) {
        const half = Math.max(...sides.map(([low, high]) => high - low)) / 2;
        for (const n of [0, 1]) {
          const centre = within((sides[n][0] + sides[n][1]) / 2, half, 1 - half);
          sides[n] = [centre - half, centre + half];
        }
      }
      for (const one of together(panel)) {
        one.view = [sides[0], one === panel ? sides[1] : one.view[1]];
        draw(one);
      }
      const isEnlarged = panels().some((one) => one.view.flat().join() !== "0,1,0,1");
      svg.toggleAttribute("data-enlarged", isEnlarged);
      shows.textContent = isEnlarged ? `shows ${[0, 1].map((n) => `${n ? panel.names[1] : nameBelow(together(panel))} ${sides[n].map((part) => written(panel.axes[n], part, 60)).join(" to ")}`).join(", ")}` : "";
      read();
    }
    const together = (panel) => panels().filter((one) => one === panel || (!panel.isEqual && one.axes[0].text === panel.axes[0].text && (panel.isAll ? one.isAll : one.x === panel.x)));
    function enlarge(factor, at = cursor) {
      const panel = at?.panel ?? panels()[0];
      const { view } = panel;
      const parts = at?.parts ?? view.map(([low, high]) => (low + high) / 2);
      const isLevel = panel.isAll || together(panel).length > 1;
      look(panel, view.map(([low, high], n) => (n && isLevel ? [low, high] : [parts[n] - (parts[n] - low) / factor, parts[n] + (high - parts[n]) / factor])));
    }
    function reset() {
      for (const panel of panels()) look(panel, [[0, 1], [0, 1]]);
      svg.removeAttribute("data-enlarged");
    }
    const shows = document.createElement("output");
    if (!isStill) {
      button("+", "Enlarge", () => enlarge(1.6));
      button("\u2212", "Reduce", () => enlarge(1 / 1.6));
      button("All", "Show all", reset);
    }
    tools.append(shows, reading);

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
      if (!panel || panel.isStill || event.pointerType === "touch" || event.button !== 0 || event.target.closest("[data-entry]")) return;
      drag = { panel, from, to: from };
      svg.setPointerCapture(event.pointerId);
    });
    // A drag is no choice of text; the figure is chosen all the same.
    svg.addEventListener("mousedown", (event) => {
      if (!drag) return;
      event.preventDefault();
      drawing.focus({ preventScroll: true });
    });
    svg.addEventListener("pointerup", () => {
      if (!drag) return;
      const { panel, from, to } = drag;
      drag = null;
      const ends = [from, to].map((at) => partsAt(panel, at));
      const isWide = [0, 1].map((n) => Math.abs(to[n] - from[n]) > 8);
      if (isWide[0] || isWide[1]) look(panel, [0, 1].map((n) => (isWide[n] ? [Math.min(ends[0][n], ends[1][n]), Math.max(ends[0][n], ends[1][n])] : panel.view[n])));
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
      const { view } = panel;
      const parts = cursor?.parts ?? view.map(([low, high]) => (low + high) / 2);
      const far = event.shiftKey ? 0.1 : 0.01;
      const moves = { ArrowLeft: [0, -far], ArrowRight: [0, far], ArrowDown: [1, -far], ArrowUp: [1, far], Home: [0, -1], End: [0, 1] };
      const acts = { "+": () => enlarge(1.6), "=": () => enlarge(1.6), "-": () => enlarge(1 / 1.6), 0: reset, Escape: reset };
      if (!(event.key in moves) && !(event.key in acts)) return;
      event.preventDefault();
      reading.setAttribute("aria-live", "polite");
      cursor = { panel, parts };
      if (event.key in acts) return acts[event.key]();
      cursor.parts = moved(panel, parts, ...moves[event.key]);
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

  // So is a page: what is folded is printed, and folded again after it.
  let unfolded = [];
  addEventListener("beforeprint", () => {
    unfolded = [...unfolded, ...document.querySelectorAll("details:not([open])")];
    for (const one of unfolded) one.open = true;
  });
  addEventListener("afterprint", () => {
    for (const one of unfolded.splice(0)) one.open = false;
  });

  for (const svg of document.querySelectorAll(".drawing > svg")) {
    if (svg.querySelector("[data-panel]") && svg.querySelector("[data-curve],[data-cells],[data-points],[data-at]")) enliven(svg.parentElement, svg);
  }
})();
