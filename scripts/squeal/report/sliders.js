"use strict";
// Sliders of a reduced model: its modes at any values of the parameters, computed in a worker of the page (dense.js, reduced.js).

// The bytes of a text that is base64 of deflated bytes
async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

// A worker that answers {p, chosen} with {modes, n, took} or {fault}: n evaluations took so many ms, several where one is too quick to be
// timed. A busy one gets the newest question when it is done
function asker(buffer, answer) {
  const code = document.getElementById("reduced-code").textContent + `
    let model = null;
    onmessage = ({data}) => {
      try {
        if (data.buffer) { model = readModel(data.buffer); return; }
        const begun = performance.now();
        let modes, n = 0;
        do { modes = modesAt(model, data.p, data.chosen); n++; } while (data.several && n < 200 && performance.now() - begun < 30);
        postMessage({p: data.p, modes, n, took: performance.now() - begun});
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

// The row of a mode: frequency, growth, error, state
function mode_row(model, mode) {
  const row = document.createElement("tr"), size = Math.hypot(mode.growth, 2 * Math.PI * mode.freq);
  const error = mode.error + model.error * size + 1e-9 * size;
  const limit = Math.max(model.limit_growth, model.limit_ratio * size);
  const state = mode.growth > Math.max(error, limit) ? "unstable" : mode.growth > error ? "neutral" : "stable";
  for (const text of [mode.freq.toFixed(3), mode.growth === 0 ? "0" : mode.growth.toPrecision(5), mode.error.toExponential(1), state]) {
    const cell = document.createElement("td");
    cell.textContent = text;
    row.append(cell);
  }
  if (state === "unstable") row.className = "unstable";
  return row;
}

async function add_sliders(place) {
  const buffer = await inflated(document.getElementById(place.dataset.source).textContent);
  const model = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 0, new Uint8Array(buffer).indexOf(10))));
  const sliders = [...place.querySelectorAll("input[type=range]")], body = place.querySelector("tbody");
  const said = place.querySelector(".said"), beyond = place.querySelector(".beyond-line"), rate = new Rate();
  const range = entry => `${Number(entry.lower.toPrecision(5))} to ${Number(entry.upper.toPrecision(5))}`;
  place.dataset.answers = 0;
  const ask = asker(buffer, ({p, modes, fault, ...effort}) => {
    if (fault) { said.textContent = `not computed: ${fault}`; return; }
    const outside = model.parameters.filter(({lower, upper}, i) => p[i] < lower || p[i] > upper);
    body.replaceChildren(...modes.map(mode => mode_row(model, mode)));
    sliders.forEach((slider, i) => slider.parentElement.classList.toggle("beyond", outside.includes(model.parameters[i])));
    beyond.textContent = outside.length ? "Outside of what the model was made for: " +
      outside.map(entry => `${entry.name}, ${range(entry)}`).join("; ") + ". It extrapolates, and its errors are not known." : "";
    rate.add(effort);
    said.textContent = `${modes.length} mode${modes.length === 1 ? "" : "s"} in the band, ${rate.text()}`;
    place.modes = modes;
    place.dataset.answers++;
    place.dataset.state = "done";
  });
  const moved = () => {
    sliders.forEach(slider => { slider.nextElementSibling.textContent = Number(slider.value).toPrecision(5); });
    ask({p: sliders.map(slider => Number(slider.value)), several: !rate.value});
  };
  for (const slider of sliders) slider.addEventListener("input", moved);
  place.querySelector("button").addEventListener("click", () => {
    sliders.forEach((slider, i) => { slider.value = model.parameters[i].value; });
    moved();
  });
  moved();
}

addEventListener("DOMContentLoaded", () => {
  for (const place of document.querySelectorAll(".sliders"))
    add_sliders(place).catch(error => { place.querySelector(".said").textContent = `not shown: ${error.message}`; });
});
