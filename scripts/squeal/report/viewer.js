"use strict";
// Bodies that move: one WebGL context draws for every canvas of the page, and where there is none the quads are painted
// from the back to the front. Places are in half the largest extent: x along the circumference at the contact, y
// outward, z along the axis. A shape moves as Re((re + i im) e^(i phase)).
const VIEWS = {oblique: [0.55, 0.62], face: [0, Math.PI / 2 - 1e-3], side: [0, 0.05], along: [Math.PI / 2, 0.05]};
const DIRECTIONS = {axis: [0, 0, 1], slip: [1, 0, 0], radial: [0, 1, 0]};
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;

function decoded(text, Kind) {
  return new Kind(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
}

function rgb(text) {
  return [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16) / 255);
}

// Blue, white, red over -1 to 1; white, orange, brown over 0 to 1
const SIGNED = ["#1d4f91", "#4a90c8", "#b9d7ea", "#f4f4f2", "#f6c5a8", "#dc6f4d", "#a01c2c"].map(rgb);
const SIZED = ["#f4f4f2", "#fde3b1", "#f9b55c", "#e67a26", "#b8460e", "#7a2a05"].map(rgb);

function colour(stops, share) {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1), i = Math.min(Math.floor(at), stops.length - 2);
  return stops[i].map((value, k) => value + (stops[i + 1][k] - value) * (at - i));
}

class Bodies {
  constructor(data) {
    Object.assign(this, data);
    this.points = decoded(data.points, Float32Array);
    this.quads = decoded(data.quads, Uint32Array);
    this.edges = decoded(data.edges, Uint32Array);
    this.n = this.points.length / 3;
    this.none = new Int16Array(3 * this.n);
    this.count_cells();
  }

  // Triangles and edges of the mesh, part of each node
  count_cells() {
    const lines = new Map(), triangles = [], q = this.quads;
    this.of = new Uint8Array(this.n);
    let part = 0, left = this.counts[0];
    for (let i = 0; i < q.length; i += 4) {
      while (left === 0) left = this.counts[++part];
      left--;
      triangles.push(q[i], q[i + 1], q[i + 2], q[i], q[i + 2], q[i + 3]);
      for (let k = 0; k < 4; k++) {
        const a = q[i + k], b = q[i + (k + 1) % 4];
        this.of[a] = part;
        lines.set(Math.min(a, b) * this.n + Math.max(a, b), [a, b]);
      }
    }
    this.triangles = new Uint32Array(triangles);
    this.lines = new Uint32Array([...lines.values()].flat());
  }

  shape(i) {
    const shape = this.shapes[i];
    if (!shape) return {re: this.none, im: this.none};
    if (!(shape.re instanceof Int16Array)) {
      shape.re = decoded(shape.re, Int16Array);
      shape.im = shape.im ? decoded(shape.im, Int16Array) : this.none;
    }
    return shape;
  }

  // Largest value of a direction (or of the length) over all phases; a tenth of the largest length at least, so that
  // rounding does not show
  largest(i, kind) {
    const shape = this.shape(i), d = DIRECTIONS[kind];
    let most = 0;
    for (let n = 0; n < this.n; n++) {
      const [re, im] = [shape.re, shape.im].map(a => d ? a[3 * n] * d[0] + a[3 * n + 1] * d[1] + a[3 * n + 2] * d[2] :
        Math.hypot(a[3 * n], a[3 * n + 1], a[3 * n + 2]));
      most = Math.max(most, Math.hypot(re, im) / 32767);
    }
    return Math.max(most, 0.1);
  }
}

// Rotation by yaw about z, then by pitch towards the viewer: rows right, up, back
function rotation([yaw, pitch]) {
  const [c, s, e, f] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  return [[c, s, 0], [s * f, -c * f, e], [-s * e, c * e, f]];
}

const VERTEX = `#version 300 es
in vec3 place, re, im, paint;
uniform mat3 turn; uniform vec3 along; uniform vec2 phase, fit, middle; uniform float scale, sized, lift;
out vec3 at, tint; out float value;
void main() {
  vec3 u = phase.x * re - phase.y * im;
  at = turn * (place + scale * u);
  value = sized > 0.5 ? length(u) : dot(along, u);
  tint = paint;
  gl_Position = vec4((at.xy - middle) * fit, -0.3 * at.z - lift, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 at, tint; in float value;
uniform vec3 signed[7], sizes[6]; uniform float sized, largest, painted; uniform vec4 line;
out vec4 ink;
vec3 step7(float x) {
  float t = clamp(0.5 + 0.5 * x, 0.0, 1.0) * 6.0; int i = min(int(t), 5);
  return mix(signed[i], signed[i + 1], t - float(i));
}
vec3 step6(float x) {
  float t = clamp(x, 0.0, 1.0) * 5.0; int i = min(int(t), 4);
  return mix(sizes[i], sizes[i + 1], t - float(i));
}
void main() {
  if (line.a > 0.0) { ink = vec4(line.rgb * line.a, line.a); return; }
  vec3 n = normalize(cross(dFdx(at), dFdy(at)));
  float light = 0.62 + 0.38 * abs(dot(n, normalize(vec3(-0.35, 0.5, 0.8))));
  vec3 base = painted > 0.5 ? tint : sized > 0.5 ? step6(value / largest) : step7(value / largest);
  ink = vec4(base * light, 1.0);
}`;

class Glass {
  constructor() {
    this.canvas = document.createElement("canvas");
    const gl = this.gl = this.canvas.getContext("webgl2", {antialias: true, premultipliedAlpha: true});
    if (!gl) return;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      this.gl = null;
      return;
    }
    gl.useProgram(program);
    this.at = name => gl.getUniformLocation(program, name);
    this.slot = name => gl.getAttribLocation(program, name);
    gl.uniform3fv(this.at("signed"), SIGNED.flat());
    gl.uniform3fv(this.at("sizes"), SIZED.flat());
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
  }

  buffer(kind, values) {
    const gl = this.gl, buffer = gl.createBuffer();
    gl.bindBuffer(kind, buffer);
    gl.bufferData(kind, values, gl.STATIC_DRAW);
    return buffer;
  }

  keep(bodies) {
    const gl = this.gl, paint = new Float32Array(3 * bodies.n);
    bodies.of.forEach((part, n) => paint.set(rgb(bodies.paint[part]), 3 * n));
    bodies.buffers = {place: this.buffer(gl.ARRAY_BUFFER, bodies.points), paint: this.buffer(gl.ARRAY_BUFFER, paint),
      none: this.buffer(gl.ARRAY_BUFFER, bodies.none)};
    for (const name of ["triangles", "lines", "edges"])
      bodies.buffers[name] = this.buffer(gl.ELEMENT_ARRAY_BUFFER, bodies[name]);
  }

  feed(name, buffer, kind) {
    const gl = this.gl, slot = this.slot(name);
    if (slot < 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, 3, kind, kind === gl.SHORT, 0, 0);
  }

  // A shape that will not be drawn again
  forget(shape) {
    for (const part of ["re", "im"]) if (shape[`${part}_buffer`]) this.gl.deleteBuffer(shape[`${part}_buffer`]);
  }

  indexed(bodies, name, mode, line) {
    const gl = this.gl;
    gl.uniform4fv(this.at("line"), line);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, bodies.buffers[name]);
    gl.drawElements(mode, bodies[name].length, gl.UNSIGNED_INT, 0);
  }

  // Draws a state into a canvas of the page
  draw(canvas, bodies, state) {
    const gl = this.gl, shape = bodies.shape(state.index);
    if (!bodies.buffers) this.keep(bodies);
    for (const part of ["re", "im"])
      if (shape[part] !== bodies.none && !shape[`${part}_buffer`])
        shape[`${part}_buffer`] = this.buffer(gl.ARRAY_BUFFER, shape[part]);
    this.canvas.width = Math.max(this.canvas.width, canvas.width);
    this.canvas.height = Math.max(this.canvas.height, canvas.height);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.feed("place", bodies.buffers.place, gl.FLOAT);
    this.feed("paint", bodies.buffers.paint, gl.FLOAT);
    for (const part of ["re", "im"]) this.feed(part, shape[`${part}_buffer`] || bodies.buffers.none, gl.SHORT);
    const rows = rotation(state.turn);
    gl.uniformMatrix3fv(this.at("turn"), false, [0, 1, 2].flatMap(k => rows.map(row => row[k])));
    gl.uniform2fv(this.at("fit"), [2 * state.fit / canvas.width, 2 * state.fit / canvas.height]);
    gl.uniform2fv(this.at("middle"), state.middle);
    gl.uniform3fv(this.at("along"), DIRECTIONS[state.colour] || [0, 0, 0]);
    gl.uniform1f(this.at("sized"), state.colour === "size" ? 1 : 0);
    gl.uniform1f(this.at("painted"), state.colour === "parts" ? 1 : 0);
    gl.uniform1f(this.at("largest"), state.largest);
    this.pass(bodies, state);
    const target = canvas.getContext("2d");
    target.clearRect(0, 0, canvas.width, canvas.height);
    const top = this.canvas.height - canvas.height;
    target.drawImage(this.canvas, 0, top, canvas.width, canvas.height, 0, 0, canvas.width, canvas.height);
  }

  // The body at rest as an outline, then what moves
  pass(bodies, state) {
    const gl = this.gl;
    gl.uniform1f(this.at("lift"), -0.002);
    if (state.index !== null && state.scale) {
      gl.uniform1f(this.at("scale"), 0);
      this.indexed(bodies, "edges", gl.LINES, [0.55, 0.55, 0.55, 0.5]);
    }
    gl.uniform1f(this.at("scale"), state.scale);
    gl.uniform2fv(this.at("phase"), [Math.cos(state.phase), Math.sin(state.phase)]);
    gl.uniform1f(this.at("lift"), 0);
    this.indexed(bodies, "triangles", gl.TRIANGLES, [0, 0, 0, 0]);
    gl.uniform1f(this.at("lift"), 0.004);
    if (state.mesh) this.indexed(bodies, "lines", gl.LINES, [0.1, 0.12, 0.15, 0.16]);
    this.indexed(bodies, "edges", gl.LINES, [0.1, 0.12, 0.15, 0.75]);
  }
}

// Without WebGL: quads from the back to the front
class Painter {
  forget() {}

  draw(canvas, bodies, state) {
    const ink = canvas.getContext("2d"), shape = bodies.shape(state.index), rows = rotation(state.turn);
    const [c, s] = [Math.cos(state.phase), Math.sin(state.phase)], d = DIRECTIONS[state.colour];
    const at = new Float32Array(3 * bodies.n), value = new Float32Array(bodies.n), q = bodies.quads;
    for (let n = 0; n < bodies.n; n++) {
      const u = [0, 1, 2].map(k => (c * shape.re[3 * n + k] - s * shape.im[3 * n + k]) / 32767);
      const x = u.map((move, k) => bodies.points[3 * n + k] + state.scale * move);
      rows.forEach((row, k) => at[3 * n + k] = row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
      value[n] = d ? d[0] * u[0] + d[1] * u[1] + d[2] * u[2] : Math.hypot(...u);
    }
    const depth = i => at[3 * q[i] + 2] + at[3 * q[i + 1] + 2] + at[3 * q[i + 2] + 2] + at[3 * q[i + 3] + 2];
    const order = Array.from({length: q.length / 4}, (_, i) => 4 * i).sort((a, b) => depth(a) - depth(b));
    ink.clearRect(0, 0, canvas.width, canvas.height);
    for (const i of order) {
      const mean = [0, 1, 2, 3].reduce((sum, k) => sum + value[q[i + k]], 0) / 4 / state.largest;
      const base = state.colour === "parts" ? rgb(bodies.paint[bodies.of[q[i]]]) :
        state.colour === "size" ? colour(SIZED, mean) : colour(SIGNED, 0.5 + 0.5 * mean);
      ink.fillStyle = ink.strokeStyle = `rgb(${base.map(x => 255 * x)})`;
      ink.beginPath();
      for (let k = 0; k < 4; k++)
        ink.lineTo(canvas.width / 2 + state.fit * (at[3 * q[i + k]] - state.middle[0]),
          canvas.height / 2 - state.fit * (at[3 * q[i + k] + 1] - state.middle[1]));
      ink.closePath();
      ink.fill();
      if (state.mesh) ink.strokeStyle = "rgba(30, 30, 30, 0.4)";
      ink.stroke();
    }
  }
}
