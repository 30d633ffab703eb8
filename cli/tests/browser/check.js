// Last in the page: looks at it as a reader would, and leaves a list of faults behind.
window.addEventListener("load", () => {
  const fault = (kind, what) => faults.push(`${kind}: ${what}`);
  const width = window.innerWidth, plots = [...document.querySelectorAll(".plot")];
  const near = (a, b, slack) => Math.abs(a - b) <= slack;
  const meets = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;

  // Offline: nothing is fetched.
  for (const one of document.querySelectorAll("[src], [href]")) {
    const target = one.getAttribute("src") ?? one.getAttribute("href");
    if (!target.startsWith("#")) fault("offline", target);
  }
  for (const one of performance.getEntriesByType("resource")) fault("offline", one.name);

  // Nothing is wider than the page, and no text is cut off or covered.
  if (document.documentElement.scrollWidth > width) fault("overflow", `${document.documentElement.scrollWidth} px`);
  const scrolls = (element) => element.closest(".wide");
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const node = walk.currentNode, parent = node.parentElement;
    if (!node.data.trim() || parent.closest("script, style, svg")) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const box of range.getClientRects()) {
      if (!scrolls(parent) && (box.left < -0.5 || box.right > width + 0.5)) fault("clipped", node.data.trim());
    }
    for (let e = parent; e && e !== document.body; e = e.parentElement) {
      const hides = getComputedStyle(e).overflowX !== "visible" || getComputedStyle(e).overflowY !== "visible";
      const scrollable = e.classList.contains("wide");
      if (hides && !scrollable && (e.scrollWidth > e.clientWidth + 1 || e.scrollHeight > e.clientHeight + 1)) fault("clipped", node.data.trim());
    }
  }
  for (const text of document.querySelectorAll("svg text")) {
    const view = text.ownerSVGElement.viewBox.baseVal, box = text.getBBox();
    if (box.x < 0 || box.y < 0 || box.x + box.width > view.width || box.y + box.height > view.height) fault("clipped", text.textContent);
  }
  for (const plot of plots) {
    const title = plot.querySelector("figcaption"), tools = plot.querySelector(".tools");
    if (tools && meets(title.getBoundingClientRect(), tools.getBoundingClientRect())) fault("clipped", title.textContent);
    for (const axis of plot.querySelectorAll(".ticks")) {
      const boxes = [...axis.children].map((c) => c.getBoundingClientRect());
      boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => meets(a, b) && fault("clipped", `numbers of ${title.textContent}`)));
    }
  }

  // Every plot is drawn.
  const numbers = (text) => (text.match(/-?\d+\.?\d*(e-?\d+)?/g) ?? []).map(Number);
  const points = (path) => [...path.getAttribute("d").matchAll(/[ML](-?[\d.]+) (-?[\d.]+)/g)].map((m) => [+m[1], +m[2]]);
  for (const plot of plots) {
    const name = plot.querySelector("figcaption").textContent, area = plot.querySelector(".area").getBoundingClientRect();
    if (area.width < 150 || area.height < 150) fault("drawn", `${name} is ${area.width} by ${area.height}`);
    for (const axis of plot.querySelectorAll(".ticks")) if (axis.children.length < 2) fault("drawn", `${name}: an axis without numbers`);
    const all = [...plot.querySelectorAll(".series")];
    if (!all.length) fault("drawn", `${name}: nothing`);
    for (const path of all) {
      const inside = points(path).filter(([x, y]) => x >= 0 && x <= 1000 && y >= 0 && y <= 1000);
      if (inside.length < 2 || /NaN|inf/i.test(path.getAttribute("d"))) fault("drawn", `${name}: ${path.dataset.name}`);
      if (getComputedStyle(path).stroke === "none") fault("drawn", `${name}: ${path.dataset.name} has no colour`);
    }
  }

  // Each can be zoomed and read off.
  for (const plot of plots) {
    const name = plot.querySelector("figcaption").textContent, area = plot.querySelector(".area");
    const box = () => area.getBoundingClientRect();
    const send = (type, x, y, target = area) => {
      const at = box(), where = { clientX: at.left + x * at.width, clientY: at.top + y * at.height };
      target.dispatchEvent(new PointerEvent(type, { ...where, bubbles: true, button: 0, pointerType: "mouse" }));
    };
    const view = () => area.getAttribute("viewBox").split(/[ ,]+/).map(Number);
    const shows = (wanted, what) => {
      if (!view().every((v, i) => near(v, wanted[i], 8))) fault("zoom", `${name}: ${what} shows ${view()}`);
    };
    const labels = () => [...plot.querySelectorAll(".ticks span")].map((s) => s.textContent).join();
    const before = labels();
    send("pointerdown", 0.25, 0.25);
    send("pointermove", 0.75, 0.5);
    send("pointerup", 0.75, 0.5, window);
    shows([250, 250, 500, 250], "a rectangle");
    if (labels() === before) fault("zoom", `${name}: the numbers stay`);
    send("dblclick", 0.5, 0.5);
    shows([0, 0, 1000, 1000], "a double click");
    const [closer, farther, whole] = plot.querySelectorAll(".tools button");
    closer?.click();
    shows([250, 250, 500, 500], "+");
    closer?.click();
    farther?.click();
    shows([250, 250, 500, 500], "−");
    whole?.click();
    shows([0, 0, 1000, 1000], "whole");

    // A point of the last series, which nothing covers: its numbers by the ends of the axes alone.
    const series = [...plot.querySelectorAll(".series")].pop(), list = points(series);
    const [x, y] = list[Math.floor(list.length / 2)];
    const value = (axis, place) => {
      const [low, high, kind] = axis.split(" "), a = +low, b = +high;
      return kind === "log" ? a * (b / a) ** place : a + place * (b - a);
    };
    const length = (axis) => { const [low, high, kind] = axis.split(" "); return kind === "log" ? Math.abs(high) : high - low; };
    send("pointermove", x / 1000, y / 1000);
    const said = plot.querySelector(".read").textContent, told = numbers(said.split(": ").pop());
    const wanted = [value(plot.dataset.x, x / 1000), value(plot.dataset.y, 1 - y / 1000)];
    const slack = [length(plot.dataset.x), length(plot.dataset.y)].map((l) => 0.01 * l);
    if (!(near(told[0], wanted[0], slack[0]) && near(told[1], wanted[1], slack[1]))) fault("read", `${name}: "${said}" is not ${wanted}`);
    send("pointerleave", 0, 0);
    if (plot.querySelector(".read").textContent) fault("read", `${name}: stays`);
  }

  const outside = window.parent.document, verdict = outside.createElement("pre");
  verdict.id = "verdict";
  verdict.textContent = JSON.stringify({ width, plots: plots.length, faults: [...new Set(faults)].slice(0, 30) }).replace(/[<>&]/g, " ");
  outside.body.append(verdict);
});
