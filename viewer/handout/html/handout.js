
// Shows of a lesson: a control moves through the frames of its pictures, and so does dragging a handle in them.
document.addEventListener("DOMContentLoaded", () => {
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const REACH = 30; // pixels around a handle in which it can be taken

  function framesOf(element) {
    const found = new Set();
    for (const part of element.dataset.f.split(",")) {
      const [first, last] = part.split("-").map(Number);
      for (let k = first; k <= (last ?? first); k++) found.add(k);
    }
    return found;
  }

  for (const show of all(".show")) {
    const own = (selector) => all(selector, show).filter((element) => element.closest(".show") === show);
    const parts = own("[data-f]").map((element) => [element, framesOf(element)]);
    const controls = own(".control");
    const svgs = own(".canvas svg");

    function set(frame) {
      for (const [element, frames] of parts) element.classList.toggle("off", !frames.has(frame));
      for (const svg of svgs) svg.dispatchEvent(new Event("frame", { bubbles: true }));
    }

    const tell = () => svgs.forEach((svg) => svg.dispatchEvent(new Event("frame", { bubbles: true })));
    show.addEventListener("told", tell);

    for (const control of controls) {
      const input = control.querySelector("input");
      const output = control.querySelector("output");
      const said = JSON.parse(control.dataset.said);
      const first = Number(control.dataset.first);
      const say = () => {
        const words = said[input.value];
        input.setAttribute("aria-valuetext", words);
        output.textContent = control.dataset.counted ? `${+input.value + 1} of ${said.length}: ${words}` : words;
      };
      control.go = (position, isLed = false) => {
        input.value = Math.min(said.length - 1, Math.max(0, position));
        for (const other of controls) if (other !== control) other.reset();
        say();
        set(first + Number(input.value));
        if (isLed || control.dataset.name !== "sweep") return;
        // The sweep of a step moves its pictures and its live pieces together.
        const swept = all('.control[data-name="sweep"]', control.closest("section"));
        for (const other of swept) if (other !== control) other.go(Number(input.value), true);
      };
      control.reset = () => {
        input.value = control.dataset.start;
        say();
      };
      input.addEventListener("input", () => control.go(Number(input.value)));
      for (const button of all("button", control)) {
        button.addEventListener("click", () => control.go(Number(input.value) + Number(button.dataset.by)));
      }
      control.hidden = false;
      control.reset();
      if (control.dataset.asked) control.go(0); // a reveal begins with its first stage
    }

    // Handles

    for (const svg of svgs) {
      const handles = all("[data-handle]", svg);
      if (!handles.length) continue;
      svg.closest(".canvas").classList.add("drags");
      // The places of a handle: for each control, the frames that its handle is in, and where.
      const places = controls.flatMap((control) => {
        const first = Number(control.dataset.first);
        const end = first + JSON.parse(control.dataset.said).length;
        return handles.filter((h) => h.dataset.handle === control.dataset.name).flatMap((h) => {
          const holder = h.closest("[data-f]");
          const disc = h.querySelector("circle");
          const at = [Number(disc.getAttribute("cx")), Number(disc.getAttribute("cy"))];
          const frames = holder ? [...framesOf(holder)] : [first];
          return frames.filter((k) => first <= k && k < end).map((k) => ({ control, position: k - first, at }));
        });
      });
      const local = (event) => {
        const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
        return [at.x, at.y];
      };
      const away = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
      const nearest = (at, among) => among.reduce((best, p) => (away(p.at, at) < away(best.at, at) ? p : best));
      let dragged = null;
      svg.addEventListener("pointerdown", (event) => {
        const at = local(event);
        const shown = handles.filter((h) => h.getClientRects().length).map((h) => {
          const disc = h.querySelector("circle");
          return { name: h.dataset.handle, at: [Number(disc.getAttribute("cx")), Number(disc.getAttribute("cy"))] };
        });
        if (!shown.length) return;
        const near = nearest(at, shown);
        if (away(near.at, at) > REACH / svg.getScreenCTM().a) return;
        dragged = places.filter((p) => p.control.dataset.name === near.name);
        if (!dragged.length) return (dragged = null);
        event.preventDefault();
        svg.setPointerCapture(event.pointerId);
        svg.classList.add("dragging");
      });
      svg.addEventListener("pointermove", (event) => {
        if (!dragged) return;
        const place = nearest(local(event), dragged);
        place.control.go(place.position);
      });
      const drop = () => {
        dragged = null;
        svg.classList.remove("dragging");
      };
      svg.addEventListener("pointerup", drop);
      svg.addEventListener("pointercancel", drop);
    }
    tell();
  }

  for (const answer of all("details.answer")) {
    answer.addEventListener("toggle", () => all(".show", answer).forEach((s) => s.dispatchEvent(new Event("told"))));
  }
  // Paper shows the answers, and closes again those that were not asked for.
  let closed = [];
  window.addEventListener("beforeprint", () => {
    closed = all("details.answer:not([open])");
    for (const answer of closed) answer.open = true;
  });
  window.addEventListener("afterprint", () => closed.forEach((answer) => (answer.open = false)));
});
