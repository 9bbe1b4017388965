"use strict";
// Sliders of a reduced model: its modes at any values of the parameters, computed in a worker of the page (dense.js to reduced.js). While a
// slider moves they are followed from value to value; when it rests, all are computed anew.

// The bytes of a text that is base64 of deflated bytes
async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

const REST = 250;  // ms without a move

// A worker that answers {p, moving, chosen} with {modes, followed, status, along, n, took} or {fault}: n evaluations took so many ms,
// several where one is too quick to be timed; along: which contact status holds where along each parameter. A busy one gets the newest
// question when it is done
function asker(buffer, answer) {
  const code = document.getElementById("reduced-code").textContent + `
    let model = null;
    onmessage = ({data}) => {
      try {
        if (data.buffer) { model = readModel(data.buffer); return; }
        const begun = performance.now();
        let modes, n = 0;
        do { modes = modesAt(model, data.p, data); n++; } while (data.several && n < 200 && performance.now() - begun < 30);
        const took = performance.now() - begun, {followed, status} = model;
        const along = status && data.p.map((_, i) => statusesAlong(model, data.p, i));
        postMessage({p: data.p, modes, moving: data.moving, followed, status, along, n, took});
      } catch (error) { postMessage({fault: error.message}); }
    };`;
  const worker = new Worker(URL.createObjectURL(new Blob([code], {type: "text/javascript"})));
  let busy = false, next = null;
  worker.onmessage = ({data}) => {
    busy = false;
    answer(data);
    if (next) { const question = next; next = null; ask(question); }
  };
  const ask = question => {
    if (busy) { next = question; return; }
    busy = true;
    worker.postMessage(question);
  };
  worker.postMessage({buffer}, [buffer]);
  return ask;
}

// Values a second, of evaluations that took 100 ms together
class Rate {
  constructor() { this.n = this.took = this.value = 0; }

  add({n, took}) {
    this.n += n;
    this.took += took;
    if (this.took < 100 && this.value || !this.took) return;
    this.value = 1000 * this.n / this.took;
    this.n = this.took = 0;
  }

  text() {
    return this.value ? `computed at ${this.value < 10 ? this.value.toPrecision(2) : Math.round(this.value)} values a second` :
      "computed too quickly to be timed";
  }
}

// Shapes x of the model on the bodies of a viewer (models.py), as whole numbers relative to the largest displacement, which is real
class Shapes {
  constructor(stage) {
    this.stage = stage;
    this.weights = decoded(stage.bodies.weights, Float64Array);
    this.directions = stage.bodies.directions.map(text => decoded(text, Int16Array));
  }

  // sum over the directions of (weights x) times them
  sum(x) {
    const n = this.directions[0].length, size = x.length, sum = new Float64Array(n);
    this.directions.forEach((direction, k) => {
      let weight = 0;
      for (let i = 0; i < size; i++) weight += this.weights[k * size + i] * x[i];
      for (let i = 0; i < n; i++) sum[i] += weight * direction[i];
    });
    return sum;
  }

  show({freq, growth, x}) {
    const re = this.sum(x.re), im = x.im ? this.sum(x.im) : new Float64Array(re.length), part = new Float64Array(2);
    let largest = 0;
    for (let i = 0; i < re.length; i++) {
      const size = Math.hypot(re[i], im[i]);
      if (size > largest) { largest = size; part.set([re[i] / size, im[i] / size]); }
    }
    const turned = sign => Int16Array.from(re, (value, i) =>
      Math.round(32767 / 1.7321 * (sign ? im[i] * part[0] - value * part[1] : value * part[0] + im[i] * part[1]) / (largest || 1)));
    const title = `${freq.toFixed(2)} Hz, growth ${growth.toPrecision(4)} 1/s`;
    this.stage.replace({number: 0, title, detail: title, re: turned(0), im: turned(1)});
  }
}

// What the row of a mode says: frequency, growth, error, state
function mode_texts(model, mode) {
  const size = Math.hypot(mode.growth, 2 * Math.PI * mode.freq);
  const error = mode.error + model.error * size + 1e-9 * size;
  const limit = Math.max(model.limit_growth, model.limit_ratio * size);
  const state = mode.growth > Math.max(error, limit) ? "unstable" : mode.growth > error ? "neutral" : "stable";
  const told = model.n > model.n_used ? mode.error.toExponential(1) : "not estimated";
  return [mode.freq.toFixed(3), mode.growth === 0 ? "0" : mode.growth.toPrecision(5), told, state];
}

// Rows for all modes; those that there are serve again, and only what changes is written
function show_modes(body, model, modes) {
  while (body.rows.length > modes.length) body.deleteRow(-1);
  modes.forEach((mode, k) => {
    const texts = mode_texts(model, mode), row = body.rows[k] ?? body.insertRow();
    texts.forEach((text, i) => {
      const cell = row.cells[i] ?? row.insertCell();
      if (cell.textContent !== text) cell.textContent = text;
    });
    row.classList.toggle("unstable", texts[3] === "unstable");
  });
}

const range = entry => `${Number(entry.lower.toPrecision(5))} to ${Number(entry.upper.toPrecision(5))}`;

// Where along a slider a contact status holds, as parts of a bar: its own dark
function show_holds(input, along, number) {
  const low = Number(input.min), high = Number(input.max), bar = input.parentElement.querySelector(".holds");
  const part = value => (Math.min(Math.max(value, low), high) - low) / (high - low);
  bar.replaceChildren(...along.map(([from, status], k) => {
    const left = part(from), right = part(along[k + 1]?.[0] ?? Infinity), span = document.createElement("span");
    Object.assign(span.style, {left: `${100 * left}%`, width: `${100 * (right - left)}%`});
    span.classList.toggle("own", status === number);
    return span;
  }).filter(span => parseFloat(span.style.width) > 0));
}

// Sliders of one model: its elements, what was asked and answered last
class Sliders {
  constructor(place, buffer) {
    const bytes = new Uint8Array(buffer);
    Object.assign(this, {place, chosen: {freq: 0, growth: 1e9}, rates: [new Rate(), new Rate()], resting: 0});
    this.model = JSON.parse(new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(10))));
    this.inputs = [...place.querySelectorAll("input[type=range]")];
    [this.body, this.said, this.beyond, this.contact] =
      ["tbody", ".said", ".beyond-line", ".contact-line"].map(name => place.querySelector(name));
    this.shapes = place.dataset.shapes ? new Shapes(stages[place.dataset.shapes]) : null;
    place.dataset.answers = 0;
    this.ask = asker(buffer, answer => this.show(answer));
    this.listen();
    this.look(false);
  }

  listen() {
    for (const input of this.inputs) input.addEventListener("input", () => this.look(true));
    for (const button of this.place.querySelectorAll(".places button")) button.addEventListener("click", () => {
      JSON.parse(button.dataset.values).forEach((value, i) => { this.inputs[i].value = value; });
      this.look(false);
    });
    if (this.shapes) this.body.addEventListener("click", ({target}) => {
      const row = target.closest("tr");
      if (row && this.place.modes) { this.chosen = this.place.modes[row.sectionRowIndex]; this.look(false); }
    });
  }

  // Asks for the modes at what the sliders say
  look(moving) {
    const {inputs, shapes, chosen, rates} = this;
    clearTimeout(this.resting);
    if (moving) this.resting = setTimeout(() => this.look(false), REST);
    for (const input of inputs) input.nextElementSibling.textContent = Number(input.value).toPrecision(5);
    this.ask({p: inputs.map(input => Number(input.value)), moving, chosen: shapes && chosen, several: !moving && !rates[0].value});
  }

  show({p, modes, fault, moving, followed, status, along, ...effort}) {
    const {place, rates} = this, rate = rates[moving ? 1 : 0];
    if (fault) { this.said.textContent = `not computed: ${fault}`; return; }
    rate.add(effort);
    show_modes(this.body, this.model, modes);
    this.showBeyond(p);
    if (status) this.showStatus(status, along);
    this.said.textContent = `${modes.length} mode${modes.length === 1 ? "" : "s"} in the band, ` +
      `${followed ? "followed from those before until the slider rests, which may miss one that comes; " : ""}${rate.text()}`;
    this.showShape(modes);
    Object.assign(place, {modes, asked: p, status, along});
    place.dataset.moving = moving;
    place.dataset.answers++;
    place.dataset.state = "done";
  }

  // Which parameters are outside of the ranges that the model was made for
  showBeyond(p) {
    const outside = this.model.parameters.filter(({lower, upper}, i) => p[i] < lower || p[i] > upper);
    this.inputs.forEach((input, i) => input.parentElement.classList.toggle("beyond", outside.includes(this.model.parameters[i])));
    this.beyond.textContent = outside.length ? "Outside of what the model was made for: " +
      outside.map(entry => `${entry.name}, ${range(entry)}`).join("; ") + ". It extrapolates, and its errors are not known." : "";
  }

  showStatus({number, far, closed}, along) {
    const {pairs, statuses} = this.model.contact;
    this.contact.textContent = `Contact status ${number + 1} of ${statuses.length}: ${closed} of ${pairs} pairs closed, as at ` +
      (far < 1e-9 ? "this point, where it was found." : `the nearest point where one was found, ${far.toPrecision(2)} of the ranges away.`);
    this.inputs.forEach((input, i) => show_holds(input, along[i], number));
  }

  // The mode that has its vector
  showShape(modes) {
    const mode = modes.find(({x}) => x);
    if (!mode) return;
    if (this.shapes) {
      this.shapes.show(mode);
      [...this.body.rows].forEach((row, k) => row.classList.toggle("chosen", modes[k] === mode));
    }
    this.chosen = {freq: mode.freq, growth: mode.growth};
  }
}

async function add_sliders(place) {
  return new Sliders(place, await inflated(document.getElementById(place.dataset.source).textContent));
}

addEventListener("DOMContentLoaded", () => {
  for (const place of document.querySelectorAll(".sliders"))
    add_sliders(place).catch(error => { place.querySelector(".said").textContent = `not shown: ${error.message}`; });
});
