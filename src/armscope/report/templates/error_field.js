// The error field that a person turns: points, arrows and the arm on a 2D canvas. No library, no WebGL, no network.
// Data stand in each figure's <script type="application/json">; see armscope/report/error_field.py for what they mean.
"use strict";
(() => {
  const TURN = 0.008, STEP = Math.PI / 36, NEAR = 14, MOST_ARROWS = 1500, DEPTHS = 4096, SLOW = 30, PAUSE = 160;  // ms
  const LINE = "#3A424A", QUIET = "#8A8A8A", SUSPECT = "#D55E00", CHOSEN = "#1b1f24";
  const AXES = { "3D": "3D distance", x: "x", y: "y", z: "z" };

  const floats = text => {
    const raw = atob(text), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    return new Float32Array(bytes.buffer);
  };
  const make = (tag, properties = {}, ...children) => {
    const node = Object.assign(document.createElement(tag), properties);
    node.append(...children);
    return node;
  };
  const short = value => {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    return size === 0 ? "0" : Number(value.toPrecision(size >= 100 ? Math.ceil(Math.log10(size)) : 3)).toString().replace("-", "−");
  };
  const fine = value => value.toFixed(Math.abs(value) < 100 ? 3 : 0).replace("-", "−");  // mm, to the micrometre
  const whole = value => value.toFixed(0).replace("-", "−");
  const nice = value => {  // the largest of 1, 2, 5, 10, ... that does not exceed the value
    const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-9)));
    return [5, 2, 1].map(step => step * power).find(step => step <= value * (1 + 1e-9));
  };
  const roundUp = value => [1, 1.2, 1.6, 2, 2.4, 3, 4, 5, 6, 8, 10].map(step => step * 10 ** Math.floor(Math.log10(value))).find(step => step >= value * (1 - 1e-9));
  // 3 x 3 matrices by rows
  const times = (a, b) => [0, 3, 6].flatMap(r => [0, 1, 2].map(c => a[r] * b[c] + a[r + 1] * b[3 + c] + a[r + 2] * b[6 + c]));
  const apply = (a, v) => [0, 3, 6].map(r => a[r] * v[0] + a[r + 1] * v[1] + a[r + 2] * v[2]);
  const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

  class Field {
    constructor(figure) {
      const data = JSON.parse(figure.querySelector("script").textContent);
      Object.assign(this, { figure, data, count: data.ids.length, points: floats(data.points), angles: floats(data.angles) });
      this.fields = data.fields.map(floats);
      this.groups = Uint16Array.from(floats(data.group));
      this.suspects = new Map(data.suspects);
      this.model = 0; this.stage = 0; this.axis = "3D"; this.group = -1; this.row = data.row;
      this.options = { arrows: true, arm: true, own: false };
      this.build(); this.frame(); this.reset(); this.listen(); this.refresh();
      new ResizeObserver(() => this.later()).observe(this.canvas);
    }

    // ---- the page around the picture
    build() {
      const { data, figure } = this, id = figure.id;
      const choice = (name, label, options, start) => {
        const select = make("select", { id: `${id}-${name}` }, ...options.map(([value, text]) => make("option", { value, textContent: text })));
        select.value = start;
        select.addEventListener("change", () => { this[name] = /^-?\d+$/.test(select.value) ? +select.value : select.value; this.refresh(); });
        return make("label", { className: "field-choice" }, label, select);
      };
      const box = (name, label) => {
        const input = make("input", { type: "checkbox", id: `${id}-${name}`, checked: this.options[name] });
        input.addEventListener("change", () => { this.options[name] = input.checked; this.refresh(); });
        return make("label", { className: "field-box" }, input, label);
      };
      const button = (label, azimuth, elevation) => {
        const node = make("button", { type: "button", textContent: label });
        node.addEventListener("click", () => { this.reset(); [this.azimuth, this.elevation] = [azimuth, elevation]; this.later(); });
        return node;
      };
      const all = data.groups.length > 1 ? [[-1, `all (${this.count})`]] : [];
      const sizes = data.groups.map((name, group) => [group, `${name || "all rows"} (${this.groups.filter(g => g === group).length})`]);
      if (!all.length) this.group = 0;
      const choices = make("div", { className: "field-choices" });
      if (data.models.length > 1) choices.append(choice("model", "model", data.models.map((m, n) => [n, m.name]), 0));
      if (data.stages.length > 1) choices.append(choice("stage", "error", data.stages.map(([name], n) => [n, name]), 0));
      choices.append(choice("axis", "axis", Object.entries(AXES), "3D"));
      if (data.groups.length > 1) choices.append(choice("group", data.group_word, [...all, ...sizes], -1));
      choices.append(box("arrows", "arrows"), box("arm", "arm"), box("own", "colours to what is shown"));
      this.canvas = make("canvas", { tabIndex: 0 });
      this.canvas.setAttribute("role", "application");
      this.canvas.setAttribute("aria-label", "Error field and arm in 3D: arrow keys turn, plus and minus zoom, 0 resets, square brackets step through the rows");
      this.tip = make("div", { className: "field-tip", hidden: true });
      this.ticks = make("div", { className: "field-ticks" });
      this.ramp = make("div", { className: "field-ramp" });
      this.barName = make("div", { className: "field-name" });
      this.told = make("p", { className: "field-told" });
      this.told.setAttribute("aria-live", "polite");
      this.chosen = make("p", { className: "field-told quiet" });
      const views = make("div", { className: "field-views" }, button("turn back", data.azimuth, data.elevation), button("top", -Math.PI / 2, Math.PI / 2), button("along x", 0, 0), button("along y", -Math.PI / 2, 0));
      const stage = make("div", { className: "field-stage" }, this.canvas, this.tip, views);
      const bar = make("div", { className: "field-bar" }, this.barName, this.ramp, this.ticks);
      figure.prepend(choices, bar, stage, this.told, this.chosen);
    }

    // ---- what is shown
    get errors() { return this.live || this.fields[this.data.models[this.model].fields[this.stage]]; }  // live: put in by another script
    get before() { return this.fields[this.data.models[this.model].fields[0]]; }
    inGroup(row) { return this.group < 0 || this.groups[row] === this.group; }

    value(errors, row) {
      const at = 3 * row;
      return this.axis === "3D" ? Math.hypot(errors[at], errors[at + 1], errors[at + 2]) : errors[at + "xyz".indexOf(this.axis)];
    }

    limit(errors) {  // the size that 98 % of the rows stay below
      const sizes = [];
      for (let row = 0; row < this.count; row++) {
        const value = Math.abs(this.value(errors, row));
        if (this.inGroup(row) && Number.isFinite(value)) sizes.push(value);
      }
      sizes.sort((a, b) => a - b);
      return sizes.length ? Math.max(sizes[Math.min(sizes.length - 1, Math.floor(0.98 * sizes.length))], 1e-6) : 1;
    }

    refresh() {
      const { data } = this, signed = this.axis !== "3D", colours = signed ? data.signed : data.sizes;
      this.top = roundUp(this.limit(this.options.own ? this.errors : this.before));
      this.low = signed ? -this.top : 0;
      this.shade = new Uint8Array(this.count);
      let squares = 0, known = 0, rows = 0, largest = 0;
      for (let row = 0; row < this.count; row++) {
        if (!this.inGroup(row)) continue;
        const value = this.value(this.errors, row);
        rows++;
        this.shade[row] = Number.isFinite(value) ? Math.max(0, Math.min(colours.length - 1, Math.round((value - this.low) / (this.top - this.low) * (colours.length - 1)))) : 255;
        if (Number.isFinite(value)) { squares += value * value; known++; largest = Math.max(largest, Math.abs(value)); }
      }
      this.dots = colours.map(colour => this.dot(colour));
      this.factor = nice(0.09 * this.size / this.top);
      const what = signed ? `error along ${this.axis}` : "3D error";
      this.barName.textContent = `${what} (mm)`;
      this.ramp.style.background = `linear-gradient(90deg, ${colours.join(", ")})`;
      const parts = [0, 0.25, 0.5, 0.75, 1].map(part => this.low + part * (this.top - this.low));
      this.ticks.replaceChildren(...parts.map((value, n) => make("span", { textContent: `${n === 4 ? "≥ " : n === 0 && signed ? "≤ " : ""}${short(value)}` })));
      const model = data.models.length > 1 && this.stage > 0 ? `${data.models[this.model].name}, ` : "";
      const missing = rows - known ? ` ${rows - known} ${data.row_word}s (grey) have no number: ${data.missing}.` : "";
      const arrows = this.options.arrows ? ` Arrows are drawn ${this.factor} times as long as the error${known > MOST_ARROWS ? `, for about ${MOST_ARROWS} of the ${data.row_word}s` : ""}.` : "";
      this.told.textContent = known
        ? `${model}${data.stages[this.stage][0]} (${data.stages[this.stage][1]}): RMS ${short(Math.sqrt(squares / known))} mm${signed ? ` along ${this.axis}` : " 3D distance"}, largest ${short(largest)} mm, ${known} ${data.row_word}s.${missing}${arrows}`
        : `${model}${data.stages[this.stage][0]}: no numbers here. ${missing}`;
      this.choose(this.inGroup(this.row) ? this.row : this.groups.indexOf(this.group));
    }

    describe(row) {
      const at = 3 * row, here = this.errors.subarray(at, at + 3), where = this.points.subarray(at, at + 3);
      const error = Number.isFinite(here[0]) ? `error ${short(Math.hypot(...here))} mm (x ${fine(here[0])}, y ${fine(here[1])}, z ${fine(here[2])})` : this.data.missing;
      const name = this.data.groups[this.groups[row]];
      const bad = this.suspects.has(row) ? `; suspect: ${this.suspects.get(row)}` : "";
      return `${name ? `${name}, ` : ""}${this.data.row_word} ${this.data.ids[row]}: ${error}; at x ${whole(where[0])}, y ${whole(where[1])}, z ${whole(where[2])} mm${bad}`;
    }

    choose(row) {
      this.row = row;
      this.chosen.textContent = `The arm is drawn in the pose of ${this.describe(row)}.`;
      this.later();
    }

    // ---- where things are
    pose(row) {  // prod_j [before_j Rz(theta_j)], theta = actuation q; mm
      const { arm } = this.data, motors = arm.actuation[0].length, joints = [], bodies = [{ turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], at: [0, 0, 0] }];
      arm.before.forEach((fixed, j) => {
        const last = bodies[j], angle = arm.actuation[j].reduce((sum, share, motor) => sum + share * this.angles[row * motors + motor], 0);
        const turn = times(last.turn, fixed.turn), at = plus(last.at, apply(last.turn, fixed.at)), c = Math.cos(angle), s = Math.sin(angle);
        joints.push({ turn, at });
        bodies.push({ turn: times(turn, [c, -s, 0, s, c, 0, 0, 0, 1]), at });
      });
      return { joints, bodies };
    }

    tool(row) {
      const { bodies } = this.pose(row), last = bodies[bodies.length - 1];
      return plus(last.at, apply(last.turn, this.data.arm.tool));
    }

    frame() {  // the middle and the size of all that is drawn
      const low = [0, 0, 0], high = [0, 0, 0], { turn } = this.data;
      for (let row = 0; row < this.count; row++) {
        const p = apply(turn, this.points.subarray(3 * row, 3 * row + 3));
        for (let c = 0; c < 3; c++) { low[c] = Math.min(low[c], p[c]); high[c] = Math.max(high[c], p[c]); }
      }
      this.pose(this.row).joints.forEach(joint => { const p = apply(turn, joint.at); for (let c = 0; c < 3; c++) { low[c] = Math.min(low[c], p[c]); high[c] = Math.max(high[c], p[c]); } });
      this.middle = low.map((l, c) => (l + high[c]) / 2);
      this.floor = [low, high];
      this.size = Math.max(...low.map((l, c) => high[c] - l), 1);
      this.radius = 0.3 * this.size;
      this.heart = [0, 1, 2].map(c => turn[c] * this.middle[0] + turn[3 + c] * this.middle[1] + turn[6 + c] * this.middle[2]);  // base axes
      const back = this.middle;
      for (let row = 0; row < this.count; row++) {
        const p = apply(turn, this.points.subarray(3 * row, 3 * row + 3));
        this.radius = Math.max(this.radius, Math.hypot(p[0] - back[0], p[1] - back[1], p[2] - back[2]));
      }
    }

    reset() { this.azimuth = this.data.azimuth; this.elevation = this.data.elevation; this.zoom = 1; this.pan = [0, 0]; this.later(); }

    camera() {
      const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
      const seen = [-sa, ca, 0, -se * ca, -se * sa, ce, ce * ca, ce * sa, se];  // right, up, towards the viewer
      const { width, height } = this.canvas, scale = this.zoom * 0.5 * Math.min(width, height) / this.radius;
      const centre = apply(seen, this.middle), view = times(seen, this.data.turn);
      return { view, scale, x: width / 2 + this.pan[0] - scale * centre[0], y: height / 2 + this.pan[1] + scale * centre[1] };
    }

    flat(p, cam = this.cam) {
      const [x, y, depth] = apply(cam.view, p);
      return [cam.x + cam.scale * x, cam.y - cam.scale * y, depth];
    }

    // ---- drawing
    dot(colour) {
      const ratio = this.ratio || 1, radius = (this.count > 3000 ? 2.2 : this.count > 600 ? 3 : 4) * ratio, sprite = make("canvas", { width: 2 * radius + 2, height: 2 * radius + 2 });
      const pen = sprite.getContext("2d");
      pen.fillStyle = colour; pen.strokeStyle = "rgba(27,31,36,.55)"; pen.lineWidth = 0.6 * ratio;
      pen.beginPath(); pen.arc(radius + 1, radius + 1, radius, 0, 7); pen.fill(); pen.stroke();
      return sprite;
    }

    later() {
      if (this.asked) return;
      this.asked = true;
      requestAnimationFrame(() => { this.asked = false; this.draw(); });
    }

    move() {  // while it turns, so few points that it turns smoothly; all of them when it rests
      clearTimeout(this.resting);
      this.thin = Math.max(1, Math.ceil((this.whole || 0) / SLOW));
      if (this.thin > 1) this.resting = setTimeout(() => { this.thin = 1; this.later(); }, PAUSE);
      this.later();
    }

    draw() {
      const box = this.canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
      if (!box.width) return;
      const [width, height] = [Math.round(box.width * ratio), Math.round(box.height * ratio)];
      if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
      if (this.ratio !== ratio) { this.ratio = ratio; this.dots = (this.axis === "3D" ? this.data.sizes : this.data.signed).map(colour => this.dot(colour)); this.empty = this.dot("#DfE3E7"); }
      const pen = this.pen = this.canvas.getContext("2d"), began = performance.now();
      this.cam = this.camera();
      pen.clearRect(0, 0, width, height);
      this.drawFloor();
      const rows = this.place(), things = this.options.arm ? this.drawnArm() : [];
      things.sort((a, b) => a.depth - b.depth);
      this.drawPaths();
      this.drawArrows(rows);
      let next = 0;
      for (const row of rows) {
        while (next < things.length && things[next].depth < this.depth[row]) things[next++].draw();
        const sprite = this.shade[row] === 255 ? this.empty : this.dots[this.shade[row]];
        pen.drawImage(sprite, this.at[2 * row] - sprite.width / 2, this.at[2 * row + 1] - sprite.height / 2);
        if (this.suspects.has(row)) this.ring(row, SUSPECT, 7);
      }
      while (next < things.length) things[next++].draw();
      if (this.options.arm) this.labels();
      if (this.inGroup(this.row)) this.ring(this.row, CHOSEN, 8);
      this.compass();
      if (!(this.thin > 1)) this.whole = performance.now() - began;
    }

    place() {  // rows from the farthest to the nearest, with where they are on the picture
      const { view, scale, x, y } = this.cam, { points, count } = this;
      this.at ||= new Float32Array(2 * count); this.depth ||= new Float32Array(count);
      this.order ||= { key: new Uint16Array(count), rows: new Uint32Array(count), starts: new Uint32Array(DEPTHS + 1) };
      const { key, rows, starts } = this.order, deepest = this.radius * 1.5, middle = view.slice(6).reduce((sum, v, c) => sum + v * this.heart[c], 0);
      starts.fill(0);
      for (let row = 0, p = 0; row < count; row++, p += 3) {
        if (!this.inGroup(row) || (this.thin > 1 && row % this.thin)) continue;
        const [a, b, c] = [points[p], points[p + 1], points[p + 2]];
        this.at[2 * row] = x + scale * (view[0] * a + view[1] * b + view[2] * c);
        this.at[2 * row + 1] = y - scale * (view[3] * a + view[4] * b + view[5] * c);
        this.depth[row] = view[6] * a + view[7] * b + view[8] * c;
        key[row] = Math.max(0, Math.min(DEPTHS - 1, (0.5 + 0.5 * (this.depth[row] - middle) / deepest) * DEPTHS));
        starts[key[row] + 1]++;
      }
      for (let n = 0; n < DEPTHS; n++) starts[n + 1] += starts[n];  // a counting sort: far cheaper than comparing
      const shown = starts[DEPTHS];
      for (let row = 0; row < count; row++) if (this.inGroup(row) && !(this.thin > 1 && row % this.thin)) rows[starts[key[row]]++] = row;
      return rows.subarray(0, shown);
    }

    drawPaths() {
      this.data.paths.forEach(group => {
        if (this.group >= 0 && this.group !== group) return;
        const line = [];
        for (let row = 0; row < this.count; row++) if (this.groups[row] === group) line.push([this.at[2 * row], this.at[2 * row + 1]]);
        this.line(line, "#B9C1C8", 1.2 * this.ratio);
      });
    }

    drawArrows(rows) {
      if (!this.options.arrows) return;
      const { pen, errors, cam } = this, chosen = this.axis === "3D" ? -1 : "xyz".indexOf(this.axis);
      const colours = this.axis === "3D" ? this.data.sizes : this.data.signed, stride = Math.max(1, Math.ceil(rows.length / MOST_ARROWS));
      pen.lineWidth = 1.1 * this.ratio;
      for (const row of rows) {
        if ((stride > 1 && row % stride) || this.shade[row] === 255) continue;
        const e = [0, 1, 2].map(c => (chosen < 0 || chosen === c ? this.factor * errors[3 * row + c] : 0));
        const dx = cam.scale * (cam.view[0] * e[0] + cam.view[1] * e[1] + cam.view[2] * e[2]);
        const dy = -cam.scale * (cam.view[3] * e[0] + cam.view[4] * e[1] + cam.view[5] * e[2]);
        const length = Math.hypot(dx, dy), [x, y] = [this.at[2 * row] + dx, this.at[2 * row + 1] + dy];
        if (length < 2) continue;
        const head = Math.min(5 * this.ratio, 0.4 * length), [ux, uy] = [dx / length * head, dy / length * head];
        pen.strokeStyle = colours[this.shade[row]];
        pen.beginPath();
        pen.moveTo(this.at[2 * row], this.at[2 * row + 1]); pen.lineTo(x, y);
        pen.moveTo(x - ux - 0.5 * uy, y - uy + 0.5 * ux); pen.lineTo(x, y); pen.lineTo(x - ux + 0.5 * uy, y - uy - 0.5 * ux);
        pen.stroke();
      }
    }

    line(points, colour, width, dash = []) {
      const { pen } = this;
      pen.strokeStyle = colour; pen.lineWidth = width; pen.lineCap = pen.lineJoin = "round"; pen.setLineDash(dash);
      pen.beginPath(); points.forEach(([x, y], n) => (n ? pen.lineTo(x, y) : pen.moveTo(x, y))); pen.stroke(); pen.setLineDash([]);
    }

    fill(points, colour, outline) {
      const { pen } = this;
      pen.beginPath(); points.forEach(([x, y], n) => (n ? pen.lineTo(x, y) : pen.moveTo(x, y))); pen.closePath();
      pen.fillStyle = colour; pen.fill();
      if (outline) { pen.strokeStyle = outline; pen.lineWidth = this.ratio; pen.stroke(); }
    }

    drawFloor() {  // a grid under the arm's foot, level with the ground
      const [low, high] = this.floor, cell = nice(this.size / 5), { turn } = this.data;
      const back = [0, 3, 6, 1, 4, 7, 2, 5, 8].map(n => turn[n]), on = (x, y) => this.flat(apply(back, [x, y, 0]));
      const [x0, x1, y0, y1] = [Math.floor(low[0] / cell), Math.ceil(high[0] / cell), Math.floor(low[1] / cell), Math.ceil(high[1] / cell)].map(n => n * cell);
      for (let x = x0; x <= x1 + 1; x += cell) this.line([on(x, y0), on(x, y1)], "#E1E5E9", this.ratio);
      for (let y = y0; y <= y1 + 1; y += cell) this.line([on(x0, y), on(x1, y)], "#E1E5E9", this.ratio);
      this.cell = cell;
    }

    drawnArm() {
      const { arm } = this.data, { joints, bodies } = this.armPose = this.pose(this.row), things = [];
      const wide = (width, least = 2) => Math.max(least * this.ratio, 2 * this.cam.scale * width);
      const world = (body, p) => plus(bodies[body].at, apply(bodies[body].turn, p));
      const point = this.flat(this.points.subarray(3 * this.row, 3 * this.row + 3));  // where the tool was measured
      for (const part of arm.parts) {
        const line = part.line.map(p => this.flat(world(part.body, p)));
        if (part.ends) line[line.length - 1] = point;
        const depth = line.reduce((sum, p) => sum + p[2], 0) / line.length;
        things.push({ depth, draw: () => { this.line(line, LINE, wide(part.width) + 2 * this.ratio); this.line(line, part.colour, wide(part.width)); } });
      }
      if (arm.rod) {
        const pin = apply(bodies[3].turn, arm.rod), line = [joints[1].at, plus(joints[1].at, pin), plus(joints[2].at, pin), joints[2].at].map(p => this.flat(p));
        things.push({ depth: line[1][2], draw: () => { this.line(line, LINE, 5 * this.ratio); this.line(line, arm.rod_colour, 3 * this.ratio); } });
      }
      arm.discs.forEach((disc, j) => things.push(this.disc(disc, joints[j])));
      const tip = point, s = 6 * this.ratio;
      things.push({ depth: tip[2] + 1, draw: () => {
        this.line([[tip[0] - s, tip[1]], [tip[0] + s, tip[1]]], CHOSEN, 1.5 * this.ratio);
        this.line([[tip[0], tip[1] - s], [tip[0], tip[1] + s]], CHOSEN, 1.5 * this.ratio);
      } });
      return things;
    }

    disc(disc, joint) {  // a short cylinder about the joint's axis
      const ring = side => Array.from({ length: 24 }, (_, n) => this.flat(plus(joint.at, apply(joint.turn, [disc.at[0] + disc.radius * Math.cos(n * Math.PI / 12), disc.at[1] + disc.radius * Math.sin(n * Math.PI / 12), disc.at[2] + side * disc.half]))));
      const towards = this.cam.view[6] * joint.turn[2] + this.cam.view[7] * joint.turn[5] + this.cam.view[8] * joint.turn[8] >= 0 ? 1 : -1;
      const front = ring(towards), rear = ring(-towards);
      disc.on = this.flat(plus(joint.at, apply(joint.turn, disc.at)));
      return { depth: disc.on[2] + disc.radius, draw: () => {
        this.fill(rear, disc.side, LINE);
        for (let n = 0; n < 24; n++) { const m = (n + 1) % 24; this.fill([rear[n], rear[m], front[m], front[n]], disc.side, disc.side); }
        this.fill(front, disc.colour, LINE);
      } };
    }

    labels() {  // beside each joint, the nearer joints first; one that would lie on another goes above or below it
      const { pen } = this, high = 16 * this.ratio, taken = [];
      pen.font = `${11.5 * this.ratio}px system-ui, sans-serif`; pen.textBaseline = "middle";
      [...this.data.arm.discs].sort((a, b) => b.on[2] - a.on[2]).forEach(disc => {
        const width = pen.measureText(disc.label).width + 4 * this.ratio, left = disc.on[0] + 8 * this.ratio;
        const free = top => taken.every(other => left > other.right || left + width < other.left || Math.abs(top - other.top) >= high);
        const first = disc.on[1] - 18 * this.ratio, top = [0, -1, 1, -2, 2].map(n => first + n * high).find(free) ?? first;
        taken.push({ left, right: left + width, top });
        pen.fillStyle = "rgba(255,255,255,.82)"; pen.fillRect(left, top, width, high);
        pen.fillStyle = CHOSEN; pen.fillText(disc.label, left + 2 * this.ratio, top + high / 2);
      });
    }

    ring(row, colour, radius) {
      const { pen } = this;
      pen.strokeStyle = colour; pen.lineWidth = 1.8 * this.ratio; pen.beginPath();
      pen.arc(this.at[2 * row], this.at[2 * row + 1], radius * this.ratio, 0, 7); pen.stroke();
    }

    compass() {
      const { pen, ratio, cam } = this, length = 30 * ratio, [x, y] = [46 * ratio, this.canvas.height - 46 * ratio];
      pen.font = `${11.5 * ratio}px system-ui, sans-serif`; pen.textBaseline = "middle";
      ["x", "y", "z"].forEach((name, c) => {
        const [dx, dy] = [cam.view[c] * length, -cam.view[3 + c] * length];
        this.line([[x, y], [x + dx, y + dy]], LINE, 1.6 * ratio);
        pen.fillStyle = LINE; pen.fillText(name, x + 1.25 * dx - 3 * ratio, y + 1.25 * dy);
      });
      pen.fillStyle = QUIET;
      pen.fillText(`base axes; a square of the floor is ${this.cell} mm wide`, 92 * ratio, this.canvas.height - 14 * ratio);
    }

    // ---- hands on it
    nearest(x, y) {
      let found = -1, least = (NEAR * this.ratio) ** 2, depth = -Infinity;
      for (let row = 0; row < this.count; row++) {
        if (!this.inGroup(row)) continue;
        const far = (this.at[2 * row] - x) ** 2 + (this.at[2 * row + 1] - y) ** 2;
        if (far < least - 4 || (far < least + 4 && this.depth[row] > depth)) [found, least, depth] = [row, Math.min(far, least), this.depth[row]];
      }
      return found;
    }

    show(event) {
      const box = this.canvas.getBoundingClientRect(), [x, y] = [event.clientX - box.left, event.clientY - box.top];
      const row = this.at ? this.nearest(x * this.ratio, y * this.ratio) : -1;
      this.tip.hidden = row < 0;
      if (row < 0) return;
      this.tip.textContent = this.describe(row);
      this.tip.style.left = `${Math.max(0, Math.min(x + 14, box.width - 250))}px`;
      this.tip.style.top = `${y + 14}px`;
    }

    turnBy(dx, dy) {
      this.azimuth -= dx; this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.elevation + dy));
      this.move();
    }

    zoomBy(factor) { this.zoom = Math.max(0.3, Math.min(30, this.zoom * factor)); this.move(); }

    listen() {
      const { canvas } = this, fingers = new Map();
      let moved = 0, apart = 0;
      const spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
      canvas.addEventListener("pointerdown", event => {
        fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
        moved = fingers.size > 1 ? 99 : 0;
        if (fingers.size === 2) apart = spread();
        try { canvas.setPointerCapture(event.pointerId); } catch { /* a pointer that is gone already */ }
        canvas.focus({ preventScroll: true });
      });
      canvas.addEventListener("pointermove", event => {
        const last = fingers.get(event.pointerId);
        if (!last) { this.show(event); return; }
        const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
        fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
        moved += Math.abs(dx) + Math.abs(dy);
        this.tip.hidden = true;
        const shift = () => { this.pan = [this.pan[0] + dx * this.ratio, this.pan[1] + dy * this.ratio]; this.later(); };
        if (fingers.size > 1) { const now = spread(); if (apart > 0) this.zoomBy(now / apart); apart = now; shift(); }
        else if (event.shiftKey || event.buttons === 2) shift();
        else this.turnBy(TURN * dx, TURN * dy);
      });
      const up = event => {
        if (!fingers.delete(event.pointerId) || moved > 4 || event.type !== "pointerup") return;
        const box = canvas.getBoundingClientRect(), row = this.nearest((event.clientX - box.left) * this.ratio, (event.clientY - box.top) * this.ratio);
        if (row >= 0) { this.choose(row); this.show(event); }
      };
      ["pointerup", "pointercancel"].forEach(kind => canvas.addEventListener(kind, up));
      canvas.addEventListener("pointerleave", () => { this.tip.hidden = true; });
      canvas.addEventListener("contextmenu", event => event.preventDefault());
      canvas.addEventListener("wheel", event => {  // the page scrolls until the picture has been clicked
        if (document.activeElement !== canvas && !event.ctrlKey) return;
        event.preventDefault();
        this.zoomBy(Math.exp(-0.0015 * event.deltaY));
      }, { passive: false });
      const step = by => { let row = this.row; do row = (row + by + this.count) % this.count; while (!this.inGroup(row)); this.choose(row); };
      const keys = {
        ArrowLeft: () => this.turnBy(-STEP, 0), ArrowRight: () => this.turnBy(STEP, 0), ArrowUp: () => this.turnBy(0, -STEP), ArrowDown: () => this.turnBy(0, STEP),
        "+": () => this.zoomBy(1.2), "=": () => this.zoomBy(1.2), "-": () => this.zoomBy(1 / 1.2), 0: () => this.reset(), "[": () => step(-1), "]": () => step(1),
      };
      canvas.addEventListener("keydown", event => {
        if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        keys[event.key]();
      });
    }
  }

  document.querySelectorAll("figure.field").forEach(figure => { figure.field = new Field(figure); });
})();
