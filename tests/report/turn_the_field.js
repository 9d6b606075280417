// Does to the figure what a person does, and leaves what was seen as JSON in the page.
const heard = [];
addEventListener("error", e => heard.push("error " + e.message));
addEventListener("securitypolicyviolation", e => heard.push("asked for " + e.blockedURI));
console.error = text => heard.push("console " + text);
const print = () => { const c = document.querySelector(".field canvas"), d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
  let sum = 0; for (let i = 0; i < d.length; i++) sum = (sum * 31 + d[i]) % 4294967291; return sum; };
addEventListener("load", () => {
  const figure = document.querySelector("figure.field"), field = figure.field, canvas = figure.querySelector("canvas"), seen = {};
  const told = () => figure.querySelector(".field-told").textContent;
  const look = name => { field.thin = 1; field.draw(); seen[name] = [print(), told()]; };
  const choose = (name, value) => { const s = document.getElementById(`field-${name}`); s.value = value; s.dispatchEvent(new Event("change")); };
  const pointer = (kind, x, y) => { const b = canvas.getBoundingClientRect(); canvas.dispatchEvent(new PointerEvent(kind, { pointerId: 1, clientX: b.left + x, clientY: b.top + y, buttons: 1 })); };
  const key = name => canvas.dispatchEvent(new KeyboardEvent("keydown", { key: name, cancelable: true }));
  look("start");
  look("again");
  choose("stage", 1); look("after");
  choose("model", 1); look("second");
  choose("stage", 2); look("compensated");
  choose("stage", 0);
  for (const axis of ["x", "y", "z"]) { choose("axis", axis); look(axis); }
  choose("axis", "3D"); choose("model", 0); look("back");
  choose("group", 1); look("path");
  choose("group", -1); field.choose(field.data.row);  // a chosen group brings its own row
  pointer("pointerdown", 200, 200); pointer("pointermove", 260, 210); pointer("pointerup", 260, 210); look("turned");
  key("0"); look("reset");
  key("ArrowLeft"); look("key");
  key("0"); key("+"); look("closer");
  key("0"); field.thin = 1; field.draw();
  const row = (field.row + 5) % field.count;
  const [x, y] = [field.at[2 * row] / field.ratio, field.at[2 * row + 1] / field.ratio];
  pointer("pointermove", x, y); const tip = figure.querySelector(".field-tip").textContent;
  const front = field.nearest(field.at[2 * row], field.at[2 * row + 1]);
  pointer("pointerdown", x, y); pointer("pointerup", x, y); look("clicked");
  const tools = Array.from({ length: field.count }, (_, n) => field.tool(n));
  const asked = performance.getEntriesByType("resource").map(e => e.name).filter(name => !name.startsWith("data:"));
  const result = { heard, seen, tip, front, chosen: field.row, tools, asked, scale: figure.querySelector(".field-ticks").textContent };
  document.body.replaceChildren(Object.assign(document.createElement("pre"), { id: "result", textContent: JSON.stringify(result) }));
});
