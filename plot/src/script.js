// Zooms the plots of the page and reads points off: drag a rectangle, or use the buttons; double click shows the whole.
// The rules by which the pictures are drawn come with the call.
((rules) => {
  "use strict";
  const { UNITS, INTERVALS, LINEAR, FEW, LARGE, SMALL } = rules, NEAR = 40;

  // An axis as the page describes it: "low high lin|log"; `part` is what of it is shown, from 0 to 1.
  const axis = (text) => {
    const [low, high, kind] = text.split(" ");
    const log = kind === "log", a = log ? Math.log(+low) : +low, b = log ? Math.log(+high) : +high;
    return {
      log,
      part: [0, 1],
      value: (place) => (log ? Math.exp(a + place * (b - a)) : a + place * (b - a)),
      place: (value) => ((log ? Math.log(value) : value) - a) / (b - a),
    };
  };

  const digitsOf = (step) => Math.max(0, Math.min(9, -Math.floor(Math.log10(step))));
  const number = (value, step) => {
    if (value === 0) return "0";
    if (Math.abs(value) >= LARGE || step < SMALL) {
      const digits = Math.floor(Math.log10(Math.abs(value))) - Math.floor(Math.log10(step));
      return value.toExponential(Math.max(0, Math.min(6, digits))).replace("+", "");
    }
    return value.toFixed(digitsOf(step));
  };

  // Round numbers in the part that is shown, with their places in it.
  const ticks = (axis) => {
    const [from, to] = axis.part, low = axis.value(from), high = axis.value(to);
    const at = (value) => (axis.place(value) - from) / (to - from);
    const decades = Math.log10(high / low), list = [];
    // As the axis of the picture has them: decades, with 2 and 5 where they are few; and as a linear axis where less than
    // one is shown.
    if (axis.log && decades >= LINEAR) {
      const few = decades < FEW, every = few ? 1 : Math.ceil(decades / INTERVALS);
      const first = Math.log10(low), begin = few ? Math.floor(first) : Math.ceil(first);
      for (let p = begin; p <= Math.log10(high); p += every) {
        for (const value of (few ? [1, 2, 5] : [1]).map((f) => f * 10 ** p)) {
          if (value >= low && value <= high) list.push(value);
        }
      }
      // All in one way of writing.
      const plain = list.every((value) => value >= SMALL && value < LARGE);
      const written = (value) => (plain ? number(value, value) : value.toExponential(0).replace("+", ""));
      return list.map((value) => [at(value), written(value)]);
    }
    const rough = (high - low) / INTERVALS, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].find((f) => f * power >= rough * (1 - 1e-9)) * power;
    for (let i = Math.ceil(low / step); i <= Math.floor(high / step); i++) {
      list.push([at(i * step), number(i * step, step)]);
    }
    return list;
  };

  const element = (name, attributes, parent) => {
    const svg = parent instanceof SVGElement;
    const made = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return parent.appendChild(made);
  };

  for (const figure of document.querySelectorAll(".plot")) {
    const area = figure.querySelector(".area"), read = figure.querySelector(".read");
    const x = axis(figure.dataset.x), y = axis(figure.dataset.y);

    // The points of a series: a path has two numbers after every M and L.
    const series = [...area.querySelectorAll(".series")].map((path) => ({
      name: path.dataset.name,
      points: [...path.getAttribute("d").matchAll(/[ML](-?[\d.]+) (-?[\d.]+)(?!V|[\d.]*V)/g)].map((m) => [m[1] / UNITS, m[2] / UNITS]),
    }));

    const draw = () => {
      const [left, right] = x.part, [low, high] = y.part;
      area.setAttribute("viewBox", [left, 1 - high, right - left, high - low].map((v) => v * UNITS).join(" "));
      let grid = "";
      const beside = figure.querySelector(".ticks.x"), along = figure.querySelector(".ticks.y");
      beside.textContent = along.textContent = "";
      for (const [place, text] of ticks(x)) {
        element("span", { style: `left:${100 * place}%` }, beside).textContent = text;
        const at = (left + place * (right - left)) * UNITS;
        grid += `M${at} ${-UNITS}V${2 * UNITS}`;
      }
      for (const [place, text] of ticks(y)) {
        element("span", { style: `top:${100 * (1 - place)}%` }, along).textContent = text;
        const at = (1 - low - place * (high - low)) * UNITS;
        grid += `M${-UNITS} ${at}H${2 * UNITS}`;
      }
      area.querySelector(".grid").setAttribute("d", grid);
    };

    // Shows a part of the axes.
    const show = (part_x, part_y) => {
      for (const [a, [from, to]] of [[x, part_x], [y, part_y]]) {
        if (to - from > 1e-4) a.part = [from, to];
      }
      draw();
    };
    const scaled = ([from, to], by) => [(from + to - (to - from) * by) / 2, (from + to + (to - from) * by) / 2];
    const inside = ([from, to]) => (to - from >= 1 ? [0, 1] : [from, to].map((v) => v - Math.min(from, 0) - Math.max(to - 1, 0)));
    const zoom = (by) => show(inside(scaled(x.part, by)), inside(scaled(y.part, by)));
    const whole = () => show([0, 1], [0, 1]);

    const tools = element("div", { class: "tools" }, figure.querySelector(".head"));
    for (const [text, says, act] of [["+", "Zoom in", () => zoom(0.5)], ["−", "Zoom out", () => zoom(2)], ["whole", "Show the whole", whole]]) {
      const button = element("button", { type: "button", title: says, "aria-label": says }, tools);
      button.textContent = text;
      button.addEventListener("click", act);
    }

    // Where a pointer is, in parts of the whole axes.
    const at = (event) => {
      const box = area.getBoundingClientRect();
      const inX = (event.clientX - box.left) / box.width, inY = 1 - (event.clientY - box.top) / box.height;
      return [x.part[0] + inX * (x.part[1] - x.part[0]), y.part[0] + inY * (y.part[1] - y.part[0])];
    };

    let found = null;
    const nearest = (event) => {
      const box = area.getBoundingClientRect(), [px, py] = at(event);
      const perX = box.width / (x.part[1] - x.part[0]), perY = box.height / (y.part[1] - y.part[0]);
      let best = null, least = NEAR;
      for (const one of series) {
        for (const [sx, sy] of one.points) {
          const off = Math.hypot((sx - px) * perX, (1 - sy - py) * perY);
          if (off < least) [best, least] = [{ name: one.name, x: sx, y: 1 - sy }, off];
        }
      }
      return best;
    };
    const tell = (event) => {
      const best = nearest(event);
      found?.remove();
      found = best && element("path", { class: "found", d: `M${best.x * UNITS} ${(1 - best.y) * UNITS}h0` }, area);
      read.textContent = best ? `${best.name}: ${x.value(best.x).toPrecision(5)}, ${y.value(best.y).toPrecision(4)}` : "";
    };

    let from = null, band = null;
    area.addEventListener("pointerdown", (event) => {
      if (event.button === 0 && event.pointerType !== "touch") from = at(event);
    });
    area.addEventListener("pointermove", (event) => {
      tell(event);
      if (!from) return;
      const to = at(event), places = [from[0], to[0], from[1], to[1]];
      band ??= element("rect", { class: "band" }, area);
      const [left, right, low, high] = [Math.min(places[0], places[1]), Math.max(places[0], places[1]), Math.min(places[2], places[3]), Math.max(places[2], places[3])];
      for (const [key, value] of Object.entries({ x: left, y: 1 - high, width: right - left, height: high - low })) band.setAttribute(key, value * UNITS);
    });
    window.addEventListener("pointerup", (event) => {
      if (!from) return;
      const [a, b] = [from, at(event)];
      from = null;
      band?.remove();
      band = null;
      const sorted = (i) => [Math.max(0, Math.min(a[i], b[i])), Math.min(1, Math.max(a[i], b[i]))];
      const far = (i, part) => Math.abs(a[i] - b[i]) > 0.01 * (part[1] - part[0]);
      if (far(0, x.part) && far(1, y.part)) show(sorted(0), sorted(1));
    });
    area.addEventListener("pointerleave", () => {
      found?.remove();
      found = null;
      read.textContent = "";
    });
    area.addEventListener("dblclick", whole);
  }
})
