// The page works without this: then all figures and all numbers are below each other.
//
// Marks with the same data-ray, in any figure, are one ray. Pointing at one of them, or giving it the focus, lights up
// the ray everywhere, and shows the article that data-numbers names. A click keeps it, Escape lets it go. The Tab key
// reaches a figure once, and the keys Up and Down go from ray to ray in it.
"use strict";
document.documentElement.classList.add("js");

document.addEventListener("DOMContentLoaded", () => {
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const REACH = 12; // pixels around a line in which it can be pointed at
  const SWIPE = 50; // pixels
  const GLOW = 5; // points by which the line below a ray is wider

  // Rays

  const panel = document.querySelector(".numbers");
  const number = (button) => Number(button.dataset.ray.match(/\d+$/));
  const buttons = all("[data-ray][aria-label]").sort((a, b) => number(a) - number(b));
  const buttonIn = (figure, ray) => {
    const found = buttons.filter((b) => b.dataset.ray === ray && figure.contains(b));
    return found.find((b) => b.getClientRects().length) || found[0]; // phones have figures of their own
  };
  let kept = null;

  function light(ray) {
    document.body.classList.toggle("lit", ray !== null);
    for (const old of all(".glow")) old.remove();
    for (const mark of all("[data-ray]")) {
      const on = mark.dataset.ray === ray;
      mark.classList.toggle("on", on);
      if (on) mark.prepend(...all(':scope > path[fill="none"], :scope > rect', mark).map(glow));
    }
  }

  // A wide line below a line.
  function glow(line) {
    const below = line.cloneNode();
    below.setAttribute("stroke-width", Number(line.getAttribute("stroke-width")) + GLOW);
    below.setAttribute("class", "glow");
    return below;
  }

  function show(button) {
    light(button ? button.dataset.ray : null);
    if (!button || !button.dataset.numbers) return;
    const chosen = document.getElementById(button.dataset.numbers);
    if (chosen.hidden) panel.scrollTop = 0;
    for (const article of all("article")) article.hidden = article !== chosen;
    panel.classList.add("chosen");
    panel.querySelector(".hint").hidden = true;
  }

  function keep(button) {
    kept = button && kept !== button.dataset.ray ? button.dataset.ray : null;
    for (const b of buttons) b.setAttribute("aria-pressed", String(b.dataset.ray === kept));
    show(button);
    if (kept === null) light(null);
  }

  // The lines of a mark, as pairs of points: only lines have this kind of path without a fill.
  function segments(mark) {
    const found = [];
    for (const path of all('path[fill="none"]', mark)) {
      for (const part of path.getAttribute("d").split("M").slice(1)) {
        const n = part.match(/-?[\d.]+/g).map(Number);
        for (let k = 0; k + 3 < n.length; k += 2) found.push(n.slice(k, k + 4));
      }
    }
    return found;
  }

  function away([x0, y0, x1, y1], x, y) {
    const [dx, dy] = [x1 - x0, y1 - y0];
    const share = Math.min(1, Math.max(0, ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy || 1)));
    return Math.hypot(x0 + share * dx - x, y0 + share * dy - y);
  }

  // The ray at the pointer, or the nearest within reach.
  function rayAt(svg, event) {
    const mark = event.target.closest("[data-ray]");
    if (mark) return mark.dataset.ray;
    const scale = svg.getScreenCTM();
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(scale.inverse());
    let [ray, nearest] = [null, REACH / scale.a];
    for (const mark of all("[data-ray]", svg)) {
      for (const segment of segments(mark)) {
        const distance = away(segment, x, y);
        if (distance <= nearest) [ray, nearest] = [mark.dataset.ray, distance];
      }
    }
    return ray;
  }

  for (const svg of all(".canvas svg")) {
    svg.setAttribute("role", "group");
    const release = () => show(kept === null ? null : buttonIn(svg, kept));
    svg.addEventListener("pointermove", (event) => {
      if (event.pointerType === "touch") return;
      const ray = rayAt(svg, event);
      if (ray === null) release();
      else show(buttonIn(svg, ray));
    });
    svg.addEventListener("pointerleave", release);
    svg.addEventListener("click", (event) => {
      const ray = rayAt(svg, event);
      keep(ray === null ? null : buttonIn(svg, ray));
    });
  }
  for (const button of buttons) {
    button.setAttribute("role", "button");
    button.setAttribute("aria-pressed", "false");
    if (button.dataset.numbers) button.setAttribute("aria-details", button.dataset.numbers);
    button.addEventListener("focus", () => {
      reachable(button);
      if (button.matches(":focus-visible")) show(button);
    });
    button.addEventListener("blur", () => show(kept === null ? null : button));
    button.addEventListener("keydown", (event) => {
      if (!(event.key in { Enter: 0, " ": 0, ArrowUp: 0, ArrowDown: 0 })) return;
      event.preventDefault();
      if (!event.key.startsWith("Arrow")) return keep(button);
      const near = buttons.filter((b) => b.closest("svg") === button.closest("svg") && b.getClientRects().length);
      const next = near[near.indexOf(button) + (event.key === "ArrowUp" ? -1 : 1)];
      if (next) next.focus();
    });
  }
  function reachable(button) { // by the Tab key
    for (const b of buttons) if (b.closest("svg") === button.closest("svg")) b.tabIndex = b === button ? 0 : -1;
  }
  for (const button of [...buttons].reverse()) reachable(button);
  document.addEventListener("frame", ({ target }) => { // another state of a figure, which may not have that ray
    const near = buttons.filter((b) => target.contains(b) && b.getClientRects().length);
    if (near.length && !near.some((b) => b.tabIndex === 0)) reachable(near[0]);
  });
  for (const link of all("a[data-to]")) { // from a text to a ray of its section
    const button = () => buttonIn(link.closest("section"), link.dataset.to);
    for (const kind of ["pointerenter", "focus"]) link.addEventListener(kind, () => show(button()));
    const release = () => show(kept === null ? null : buttons.find((b) => b.dataset.ray === kept));
    for (const kind of ["pointerleave", "blur"]) link.addEventListener(kind, release);
    link.addEventListener("click", (event) => {
      event.preventDefault();
      keep(button());
    });
  }
  if (panel) {
    for (const article of all("article")) article.hidden = true;
    panel.querySelector(".hint").hidden = buttons.length === 0;
  }

  // Pages

  const pages = all(".page");
  const nav = document.querySelector("nav.position");
  let at = 0;

  function go(to, address = true) {
    const next = Math.min(pages.length - 1, Math.max(0, to));
    const focused = pages[at].contains(document.activeElement) ? document.activeElement : null;
    const moved = next !== at;
    at = next;
    pages.forEach((page, k) => (page.hidden = k !== at));
    if (!nav) return;
    nav.querySelector("[role=status]").textContent = `Position ${at + 1} of ${pages.length}`;
    for (const button of all("button", nav)) {
      const end = button.dataset.go < 0 ? 0 : pages.length - 1;
      button.setAttribute("aria-disabled", String(at === end));
    }
    if (focused && moved) (buttonIn(pages[at], focused.dataset.ray) || pages[at]).focus({ preventScroll: true });
    if (kept !== null) show(buttonIn(pages[at], kept) || null);
    if (address) history.replaceState(null, "", `#${at + 1}`);
  }

  const asked = () => pages.findIndex((page) => `#${page.id}` === location.hash);
  if (pages.length) go(asked(), false);
  if (nav) {
    nav.hidden = false;
    window.addEventListener("hashchange", () => asked() >= 0 && go(asked(), false));
    for (const button of all("button", nav)) button.addEventListener("click", () => go(at + Number(button.dataset.go)));
    const keys = {
      ArrowRight: () => at + 1, PageDown: () => at + 1, ArrowLeft: () => at - 1, PageUp: () => at - 1,
      Home: () => 0, End: () => pages.length - 1,
    };
    document.addEventListener("keydown", (event) => {
      if (!(event.key in keys) || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return;
      if (panel && panel.contains(event.target)) return; // there, the keys scroll
      event.preventDefault();
      go(keys[event.key]());
    });
    let start = null;
    for (const page of pages) {
      page.addEventListener("touchstart", (event) => {
        const large = event.target.closest(".large");
        start = event.touches.length === 1 && !large ? event.touches[0] : null;
      }, { passive: true });
      page.addEventListener("touchend", (event) => {
        if (!start) return;
        const end = event.changedTouches[0];
        const [dx, dy] = [end.clientX - start.clientX, end.clientY - start.clientY];
        if (Math.abs(dx) > SWIPE && Math.abs(dx) > 2 * Math.abs(dy)) go(at + (dx < 0 ? 1 : -1));
        start = null;
      }, { passive: true });
    }
  }
  document.addEventListener("keydown", (event) => event.key === "Escape" && keep(null));

  // On a phone, a wide figure has small text: a button makes it large, and it can be moved.
  for (const canvas of all(".canvas:not(.upright)")) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "enlarge";
    const set = (large) => {
      canvas.classList.toggle("large", large);
      button.textContent = large ? "Fit the figure to the screen" : "Enlarge the figure";
    };
    button.addEventListener("click", () => set(!canvas.classList.contains("large")));
    set(false);
    canvas.after(button);
  }
});
