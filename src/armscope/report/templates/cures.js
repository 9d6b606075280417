// Try before you cure: what is ticked is taken out of the error, and the number, the histogram and the field follow.
"use strict";
(() => {
  const panel = document.getElementById("switches");
  if (panel) {
    const { before, cures, expected } = JSON.parse(panel.querySelector("script").textContent), BINS = 28;
    const unpack = ({ unit, values }) => {
      const raw = atob(values), bytes = new Uint8Array(raw.length);
      for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
      return Float32Array.from(new Int16Array(bytes.buffer), whole => unit * whole);
    };
    const start = unpack(before), moved = cures.map(unpack), count = start.length / 3;
    const boxes = [...panel.querySelectorAll("[data-cure]")], shown = document.getElementById("cured-rms"), chart = document.getElementById("cured-histogram"), here = document.getElementById("recorded-rms");
    const sizes = errors => Array.from({ length: count }, (_, row) => Math.hypot(errors[3 * row], errors[3 * row + 1], errors[3 * row + 2]));
    const end = Math.max([...sizes(start)].sort((a, b) => a - b)[Math.floor(0.99 * (count - 1))], 1e-6);
    const bins = errors => sizes(errors).reduce((sums, size) => { sums[Math.min(BINS - 1, Math.floor(size / end * BINS))]++; return sums; }, new Array(BINS).fill(0));
    const first = bins(start);
    const path = (sums, top) => "M0 100" + sums.map((sum, n) => `V${(100 - 92 * Math.sqrt(sum / top)).toFixed(1)}H${((n + 1) * 320 / BINS).toFixed(1)}`).join("") + "V100";
    const rms = errors => Math.sqrt(errors.reduce((sum, error) => sum + error * error, 0) / errors.length);
    const show = () => {
      const errors = Float32Array.from(start);
      boxes.forEach(box => { if (box.checked) moved[+box.dataset.cure].forEach((value, at) => { errors[at] -= value; }); });
      const recorded = rms(errors), told = mm => `${Number(mm.toPrecision(3))} mm`;
      shown.textContent = told(Math.sqrt(Math.max(expected[0] + expected[1] * recorded * recorded, 0)));
      if (here) here.textContent = told(recorded);
      const now = bins(errors), top = Math.max(...first, ...now);
      chart.innerHTML = `<path d="${path(now, top)}" fill="var(--after, #0072b2)"/><path d="${path(first, top)}" fill="none" stroke="var(--before, #d55e00)" stroke-width="1.5"/>`
        + `<text x="0" y="115" font-size="11" fill="var(--quiet)">0</text><text x="320" y="115" font-size="11" text-anchor="end" fill="var(--quiet)">3D error, ≥ ${Number(end.toPrecision(2))} mm</text>`;
      const field = document.getElementById("field");
      if (field && field.field) { field.field.live = errors; field.field.refresh(); }
    };
    boxes.forEach(box => box.addEventListener("change", show));
    panel.querySelectorAll("[data-all]").forEach(button => button.addEventListener("click", () => { boxes.forEach(box => { box.checked = !!button.dataset.all; }); show(); }));
    show();
  }
  const open = () => {
    const wanted = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let at = wanted; at; at = at.parentElement) if (at.tagName === "DETAILS") at.open = true;
    if (wanted) wanted.scrollIntoView();
  };
  addEventListener("hashchange", open);
  addEventListener("beforeprint", () => document.querySelectorAll("details").forEach(each => { each.open = true; }));
  if (location.hash) open();
})();
