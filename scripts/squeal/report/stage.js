"use strict";
// What surrounds the viewer: controls, dragging, small pictures of all shapes, the clock. One Stage for each .viewer.
const glass = new Glass();
const renderer = glass.gl ? glass : new Painter();
const PERIOD = 1600; // ms a turn of the phase takes
const FRAME = 30; // ms between pictures at least
const stages = {}, bodies_of = {};
const MINUS = "\u2212";

function made(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes))
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value !== null && value !== false) element.setAttribute(key, value === true ? "" : value);
  element.append(...children);
  return element;
}

class Stage {
  constructor(host) {
    this.host = host;
    this.canvas = host.querySelector("canvas");
    const source = host.dataset.source;
    this.bodies = bodies_of[source] ||= new Bodies(JSON.parse(document.getElementById(source).textContent));
    const moves = this.bodies.shapes.length > 0 && !("still" in host.dataset);
    this.state = {index: moves ? 0 : null, turn: [...VIEWS.oblique], phase: 0, scale: moves ? 0.16 : 0, zoom: 1,
      colour: moves ? "axis" : "parts", mesh: true, largest: 1};
    this.frames = Boolean(this.bodies.frames);
    this.fixed = Boolean(this.bodies.fixed);
    this.playing = moves && !still && !this.fixed;
    this.visible = true;
    if (moves) this.add_controls();
    this.add_views();
    this.listen();
    this.select(this.state.index);
  }

  add_controls() {
    const shapes = this.bodies.shapes, bar = made("div", {class: "bar"});
    this.choice = made("select", {"aria-label": "shape", onchange: () => this.select(Number(this.choice.value))},
      ...shapes.map((shape, i) => made("option", {value: i}, shape.title)));
    this.play = made("button", {type: "button", class: "play", onclick: () => this.set_playing(!this.playing)},
      "Pause");
    this.slider = made("input", {type: "range", min: 0, max: this.frames ? shapes.length - 1 : 360, value: 0, step: 1,
      "aria-label": this.frames ? "time" : "phase", oninput: () => this.seek(Number(this.slider.value))});
    this.size = made("input", {type: "range", min: 0, max: 0.5, step: 0.01, value: this.state.scale,
      "aria-label": "exaggeration", oninput: () => this.set("scale", Number(this.size.value))});
    this.paint = made("select", {"aria-label": "colour", onchange: () => this.set("colour", this.paint.value)},
      ...[["axis", "along the axis"], ["slip", "along the sliding"], ["radial", "outward"], ["size", "size"],
        ["parts", "parts"]]
        .map(([value, text]) => made("option", {value}, text)));
    const named = (text, control) => made("label", {}, made("span", {}, text), control);
    if (!this.frames && shapes.length > 1) bar.append(named("Shape", this.choice));
    if (!this.fixed) bar.append(this.play, named(this.frames ? "Time" : "Phase", this.slider));
    bar.append(named("Exaggeration", this.size), named("Colour", this.paint));
    this.host.append(bar);
    this.note = this.host.querySelector(".note") || made("p", {class: "note", "aria-live": "polite"});
    this.host.append(this.note);
    this.set_playing(this.playing);
    if (!this.frames && shapes.length > 1) this.add_gallery(shapes);
  }

  // Small pictures of all shapes at phase 0
  add_gallery(shapes) {
    this.gallery = made("div", {class: "gallery"});
    this.small = shapes.map((shape, i) => {
      const canvas = made("canvas", {width: 220, height: 150, role: "img", "aria-label": shape.title});
      this.gallery.append(made("button", {type: "button", class: shape.unstable ? "bad" : null,
        onclick: () => this.select(i)}, canvas, made("span", {}, shape.title)));
      return canvas;
    });
    this.host.append(this.gallery);
    const look = new IntersectionObserver(entries => {
      for (const entry of entries)
        if (entry.isIntersecting) {
          this.draw_small(this.small.indexOf(entry.target));
          look.unobserve(entry.target);
        }
    }, {rootMargin: "400px"});
    this.small.forEach(canvas => look.observe(canvas));
    addEventListener("beforeprint", () => this.small.forEach((_, i) => this.draw_small(i)));
  }

  draw_small(i) {
    const state = {...this.state, index: i, turn: [...VIEWS.oblique], phase: 0, scale: 0.16, colour: "axis",
      mesh: false, largest: this.bodies.largest(i, "axis")};
    this.fit_to(this.small[i], state);
    renderer.draw(this.small[i], this.bodies, state);
  }

  add_views() {
    const names = {oblique: "Oblique", face: "Face", side: "Front", along: "Side"};
    const bar = made("div", {class: "views"}, ...Object.entries(names).map(([key, text]) =>
      made("button", {type: "button", onclick: () => this.look(VIEWS[key])}, text)));
    for (const [text, factor, name] of [["+", 1.25, "nearer"], [MINUS, 0.8, "farther"]])
      bar.append(made("button", {type: "button", "aria-label": name,
        onclick: () => this.set("zoom", this.state.zoom * factor)}, text));
    this.canvas.parentElement.append(bar);
  }

  look(turn) {
    this.state.turn = [...turn];
    this.set("zoom", 1);
  }

  listen() {
    let from = null;
    this.canvas.addEventListener("pointerdown", event => {
      from = [event.clientX, event.clientY];
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", event => {
      if (!from) return;
      const [dx, dy] = [event.clientX - from[0], event.clientY - from[1]];
      this.state.turn[0] -= 0.008 * dx;
      this.state.turn[1] = Math.min(Math.max(this.state.turn[1] + 0.008 * dy, -1.57), 1.57);
      from = [event.clientX, event.clientY];
      this.dirty = true;
    });
    for (const name of ["pointerup", "pointercancel"]) this.canvas.addEventListener(name, () => { from = null; });
    new IntersectionObserver(entries => { this.visible = entries[0].isIntersecting; }).observe(this.canvas);
    new ResizeObserver(() => { this.dirty = true; }).observe(this.canvas);
  }

  set(name, value) {
    this.state[name] = value;
    if (name === "colour") this.state.largest = this.bodies.largest(this.state.index, value);
    this.dirty = true;
  }

  set_playing(on) {
    this.playing = on;
    this.play.textContent = on ? "Pause" : "Play";
  }

  seek(value) {
    this.set_playing(false);
    if (this.frames) this.select(value);
    else this.set("phase", value * Math.PI / 180);
  }

  select(i) {
    this.state.index = i;
    this.dirty = true;
    if (i === null) return;
    const shape = this.bodies.shapes[i];
    this.state.largest = this.frames ? 1 : this.bodies.largest(i, this.state.colour);
    this.choice.value = i;
    this.note.textContent = shape.detail;
    if (this.frames) this.slider.value = i;
    (this.gallery ? [...this.gallery.children] : []).forEach(
      (button, k) => button.setAttribute("aria-pressed", k === i));
  }

  // Another shape in the place of the only one
  replace(shape) {
    renderer.forget(this.bodies.shapes[0]);
    this.bodies.shapes[0] = shape;
    this.select(0);
  }

  // Points of the canvas per unit and what lies in its middle, so that the body at rest has room to move
  fit_to(canvas, state) {
    const rows = rotation(state.turn), p = this.bodies.points, low = [9, 9], high = [-9, -9];
    for (let n = 0; n < p.length; n += 3)
      for (let k = 0; k < 2; k++) {
        const at = rows[k][0] * p[n] + rows[k][1] * p[n + 1] + rows[k][2] * p[n + 2];
        low[k] = Math.min(low[k], at);
        high[k] = Math.max(high[k], at);
      }
    const room = 0.05 + 0.6 * state.scale;
    state.middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    state.fit = state.zoom * Math.min(canvas.width / (high[0] - low[0] + room),
      canvas.height / (high[1] - low[1] + room));
  }

  tick(time) {
    if (this.playing && this.visible) {
      if (this.frames) {
        const i = Math.floor(time / 90) % this.bodies.shapes.length;
        if (i !== this.state.index) this.select(i);
      } else {
        this.state.phase = 2 * Math.PI * (time % PERIOD) / PERIOD;
        this.slider.value = this.state.phase * 180 / Math.PI;
        this.dirty = true;
      }
    }
    if (!this.dirty) return;
    this.dirty = false;
    const dense = Math.min(devicePixelRatio || 1, 2), box = this.canvas.getBoundingClientRect();
    const [width, height] = [box.width, box.height].map(x => Math.max(1, Math.round(dense * x)));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    this.fit_to(this.canvas, this.state);
    renderer.draw(this.canvas, this.bodies, this.state);
  }
}

// Shows a shape by its number, from a table or a chart
function show_shape(name, number) {
  const stage = stages[name], i = stage ? stage.bodies.shapes.findIndex(shape => shape.number === number) : -1;
  if (i < 0) return;
  stage.select(i);
  stage.host.scrollIntoView({behavior: still ? "auto" : "smooth", block: "nearest"});
}

addEventListener("DOMContentLoaded", () => {
  for (const host of document.querySelectorAll(".viewer")) stages[host.id] = new Stage(host);
  let last = 0;
  const turn = time => {
    if (time - last > FRAME) {
      last = time;
      Object.values(stages).forEach(stage => stage.tick(time));
    }
    requestAnimationFrame(turn);
  };
  requestAnimationFrame(turn);
});
