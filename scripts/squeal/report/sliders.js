"use strict";
// Sliders of a reduced model: its modes at any values of the parameters, computed in a worker of the page (reduced.js).

// The bytes of a text that is base64 of deflated bytes
async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

// A worker that answers {p} with {modes} or {fault}; a busy one gets the newest question when it is done
function asker(buffer, answer) {
  const code = document.getElementById("reduced-code").textContent + `
    let model = null;
    onmessage = ({data}) => {
      try {
        if (data.buffer) model = readModel(data.buffer);
        else postMessage({p: data.p, modes: modesAt(model, data.p)});
      } catch (error) { postMessage({fault: error.message}); }
    };`;
  const worker = new Worker(URL.createObjectURL(new Blob([code], {type: "text/javascript"})));
  let busy = false, next = null, begun = 0;
  const ask = p => { busy = true; begun = performance.now(); worker.postMessage({p}); };
  worker.onmessage = ({data}) => {
    busy = false;
    answer(data, performance.now() - begun);
    if (next) { const p = next; next = null; ask(p); }
  };
  worker.postMessage({buffer}, [buffer]);
  return p => { if (busy) next = p; else ask(p); };
}

// The row of a mode: frequency, growth, error, state
function mode_row(model, mode) {
  const row = document.createElement("tr"), size = Math.hypot(mode.growth, 2 * Math.PI * mode.freq);
  const error = mode.error + model.error * size + 1e-9 * size;
  const limit = Math.max(model.limit_growth, model.limit_ratio * size);
  const state = mode.growth > Math.max(error, limit) ? "unstable" : mode.growth > error ? "neutral" : "stable";
  for (const text of [mode.freq.toFixed(3), mode.growth.toPrecision(5), mode.error.toExponential(1), state]) {
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
  const said = place.querySelector(".said"), values = () => sliders.map(slider => Number(slider.value));
  const ask = asker(buffer, ({p, modes, fault}, took) => {
    if (fault) { said.textContent = `not computed: ${fault}`; return; }
    const outside = model.parameters.filter(({lower, upper}, i) => p[i] < lower || p[i] > upper).map(({name}) => name);
    body.replaceChildren(...modes.map(mode => mode_row(model, mode)));
    place.classList.toggle("outside", outside.length > 0);
    said.textContent = `${modes.length} modes, ${(1000 / took).toFixed(1)} a second` +
      (outside.length ? `; outside of what the model was made for: ${outside.join(", ")}, it extrapolates` : "");
    place.dataset.state = "done";
  });
  const moved = () => {
    sliders.forEach(slider => { slider.nextElementSibling.textContent = Number(slider.value).toPrecision(5); });
    ask(values());
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
