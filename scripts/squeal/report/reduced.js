// The reduced model of a sweep, a sample, a quiet box or a design: its pencil at any values of the parameters, all eigenvalues by the QR
// iteration, those of the band with vectors by inverse iteration on the Hessenberg form, their growth and the estimated error. It stands
// behind dense.js. No DOM: it runs in a worker of the page and in node.
//
//   Q(lambda; p) = lambda^2 M + lambda C + K,   each a sum of c_t(p) A_t, c monomials
//   undamped (M^-1 K - kappa) x = 0, kappa = -lambda^2; damped the companion form A [h x; lambda x] = lambda [h x; lambda x]
//   lambda := lambda - y'Q x / (y'Q'(lambda) x),   error |s' Q_zz^-1 r / (y'Q' x)|, r and s what vectors Z of the basis tell
"use strict";

// c(p) of a term
function coefficient(term, p) {
  let c = term.scale;
  for (const [parameter, power, absolute] of term.factors) {
    c *= Math.pow(absolute ? Math.abs(p[parameter]) : p[parameter], power);
  }
  return c;
}

// K, C, M at p on all n vectors, column-major
function pencilAt(model, p) {
  const n = model.n, pencil = model.pencil ||= {K: new Float64Array(n * n), C: new Float64Array(n * n), M: new Float64Array(n * n)};
  pencil.damped = false;
  for (const kind of ["K", "C", "M"]) pencil[kind].fill(0);
  model.terms.forEach((term, t) => {
    const c = coefficient(term, p), sum = pencil[term.kind], A = model.matrices[t];
    if (!Number.isFinite(c)) throw new Error(NOT_FINITE);
    if (c === 0) return;
    if (term.kind === "C") pencil.damped = true;
    for (let i = 0; i < n * n; i++) sum[i] += c * A[i];
  });
  return pencil;
}

// Rows first .. first + n - 1 of A, all columns, column-major
function rowsOf(model, A, first, n) {
  const N = model.n, out = new Float64Array(n * N);
  for (let j = 0; j < N; j++) out.set(A.subarray(j * N + first, j * N + first + n), j * n);
  return out;
}

// A := M^-1 A, M factored
function overMass(block, A) {
  solveReal(block.n, block.LU, block.order, A.length / block.n, A);
  return A;
}

// M_bb^-1 A_b, made once where M is the same at all values, and for all statuses
function termOver(model, block, A) {
  const key = model.made.get(A) ?? {};
  if (!model.made.has(A)) model.made.set(A, key);
  return key[block.first] ??= overMass(block, rowsOf(model, A, block.first, block.n));
}

// The vectors first .. first + n - 1: rows of the terms over their mass
function blockOf(model, pencil, first, n) {
  const fixed = model.terms.every(term => term.kind !== "M" || !term.factors.length), key = `block${first}`;
  const block = model[key] ||= {first, n, K: new Float64Array(n * model.n), C: new Float64Array(n * model.n), forms: {}};
  if (fixed && block.terms) return block;
  block.LU = rowsOf(model, pencil.M, first, n).subarray(first * n, (first + n) * n).slice();
  block.order = factorReal(n, block.LU);
  block.M = overMass(block, rowsOf(model, pencil.M, first, n));
  block.terms = fixed && model.terms.map(({kind}, t) => kind === "M" ? null : termOver(model, block, model.matrices[t]));
  // vectors of a basis that is orthonormal in M have no mass in common
  block.apart = block.M.every((value, k) => Math.abs(value) < 1e-12 || k >= first * n && k < (first + n) * n);
  return block;
}

// M^-1 K or M^-1 C at p
function sumOver(model, pencil, block, kind, p) {
  const sum = block[kind];
  if (!block.terms) { sum.set(overMass(block, rowsOf(model, pencil[kind], block.first, block.n))); return sum; }
  sum.fill(0);
  model.terms.forEach((term, t) => { if (term.kind === kind) addAt(sum.length, coefficient(term, p), block.terms[t], 0, sum, 0); });
  return sum;
}

// The block with its Hessenberg form
function formOf(model, pencil, p, first, n) {
  const block = blockOf(model, pencil, first, n), K = sumOver(model, pencil, block, "K", p), {damped} = pencil, o = first * n;
  const N = damped ? 2 * n : n, h = model.high, form = block.forms[N] ||= new Hessenberg(N), a = form.h;
  if (!damped) for (let j = 0; j < n; j++) for (let i = 0; i < n; i++) a[i * N + j] = K[o + j * n + i];
  else {
    const C = sumOver(model, pencil, block, "C", p);
    a.fill(0);
    for (let j = 0; j < n; j++) {
      a[j * N + n + j] = h;
      for (let i = 0; i < n; i++) { a[(n + i) * N + j] = -K[o + j * n + i] / h; a[(n + i) * N + n + j] = -C[o + j * n + i]; }
    }
  }
  form.reduce();
  return {form, block, n, h, damped};
}

const GUARD = 0.1;  // of the highest frequency, beyond the band: modes that may come into it while a slider moves

// lambda of the band or near it, im >= 0, each with its s: the eigenvalue of the form, lambda or kappa = -lambda^2. Of a pair of complex
// kappa the one that grows and the one that decays have one s
function candidates(model, {form, damped}) {
  const {N, wr, wi} = form, found = [];
  form.eigenvalues();
  const add = (lambda, s) => {
    if (lambda[1] >= model.low - GUARD * model.high && lambda[1] <= (1 + GUARD) * model.high) found.push({lambda, s});
  };
  for (let k = 0; k < N; k++) {
    const re = wr[k], im = wi[k];
    if (im < 0) continue;
    if (damped) { add([re, im], [re, im]); continue; }
    const size = Math.hypot(re, im), b = Math.sqrt(0.5 * (size + re)), a = im === 0 && re > 0 ? 0 : Math.sqrt(0.5 * (size - re));
    add([a, im === 0 && re < 0 ? 0 : b], [re, im]);
  }
  return found;
}

// Vectors have a part im where it is not zero
const PARTS = ["re", "im"], partsIn = x => x.im ? PARTS : PARTS.slice(0, 1);
const vector = (n, complex) => ({re: new Float64Array(n), im: complex ? new Float64Array(n) : null});

// Its length before
function normalise(x) {
  let square = 0;
  for (const part of partsIn(x)) for (let i = 0, v = x[part]; i < v.length; i++) square += v[i] * v[i];
  const f = 1 / Math.sqrt(square);
  for (const part of partsIn(x)) for (let i = 0, v = x[part]; i < v.length; i++) v[i] *= f;
  return 1 / f;
}

const ENOUGH = 1e-8;  // of what rounding lets a vector grow by in a step of inverse iteration: less calls for another one

// Vectors to begin with, in those of the form
function startOf({N}, complex) {
  const x = vector(N, complex), w = vector(N, complex);
  for (let i = 0; i < N; i++) { x.re[i] = Math.cos(1 + i * i); w.re[i] = Math.sin(2 + i); }
  return {x, w};
}

// The part of y beside x, both of length 1
const beside = (x, y) => Math.sqrt(Math.max(0, 1 - Math.min(1, Math.hypot(...dot({re: x.re, im: x.im?.map(value => -value)}, y)))));

// x of s by inverse iteration, and w, M' times the left vector, both of M^-1 Q. With given vectors of the form to begin with, which it
// overwrites, it is one step; turned: what of them was not x or w, in a product
function vectorsOf({form, n, damped}, [a, b], given) {
  const {x, w} = given ?? startOf(form, b !== 0);
  if (given) { form.forth(x.re, x.im); form.forthTransposed(w.re, w.im); }
  normalise(x);
  normalise(w);
  const before = given && [likewise(x, x.im), likewise(w, w.im)];
  form.shift(a, b);
  for (let turn = 0, grown = 0; turn < (given ? 1 : 2) && grown < ENOUGH; turn++) {
    form.solve(x.re, x.im);
    form.solveTransposed(w.re, w.im);
    grown = 2.2e-16 * Math.hypot(a, b) * Math.min(normalise(x), normalise(w));
  }
  const turned = given ? beside(before[0], x) * beside(before[1], w) : 0;
  form.back(x.re, x.im);
  form.backTransposed(w.re, w.im);
  if (damped) for (const part of partsIn(x)) { x[part] = x[part].slice(0, n); w[part] = w[part].slice(n); }
  normalise(x);
  normalise(w);
  return {x, w, turned};
}

// Columns o/n .. + 3 of A, each n numbers, with x[j .. j + 3], or transposed with all of x
function fourColumns(n, A, o, x, y, j, transposed) {
  const p = o + n, q = p + n, r = q + n;
  let [s, t, u, v] = transposed ? [0, 0, 0, 0] : [x[j], x[j + 1], x[j + 2], x[j + 3]];
  if (!transposed) {
    for (let i = 0; i < n; i++) y[i] += s * A[o + i] + t * A[p + i] + u * A[q + i] + v * A[r + i];
    return;
  }
  for (let i = 0; i < n; i++) {
    const f = x[i];
    s += f * A[o + i]; t += f * A[p + i]; u += f * A[q + i]; v += f * A[r + i];
  }
  y[j] = s; y[j + 1] = t; y[j + 2] = u; y[j + 3] = v;
}

// A x with the m columns of A from `first` on, rows n; transposed: A' x
function times(A, n, first, m, transposed, x) {
  const y = vector(transposed ? m : n, x.im);
  for (const part of partsIn(x)) {
    const v = x[part], out = y[part];
    let j = 0;
    for (; j < m - 3; j += 4) fourColumns(n, A, (first + j) * n, v, out, j, transposed);
    for (; j < m; j++) if (transposed) out[j] = dotAt(n, A, (first + j) * n, v, 0); else addAt(n, v[j], A, (first + j) * n, out, 0);
  }
  return y;
}

// K x, C x, M x of rows of a block over its mass, on m columns: M x is x on the block's own, and nothing where it has no others
const partsOf = (pencil, block, first, m, transposed, x) => ["K", "C", "M"].map(kind =>
  kind === "C" && !pencil.damped ? null : kind !== "M" ? times(block[kind], block.n, first, m, transposed, x) :
    first === block.first ? x : block.apart ? null : times(block.M, block.n, first, m, transposed, x));

// What these are with lambda: Q x, or with derivative Q' x
function united(parts, [a, b], derivative) {
  const weights = derivative ? [[0, 0], [1, 0], [2 * a, 2 * b]] : [[1, 0], [a, b], [a * a - b * b, 2 * a * b]];
  const y = vector(parts[0].re.length, true);
  parts.forEach((part, k) => {
    const [c, s] = weights[k];
    if (part && (c !== 0 || s !== 0)) for (let i = 0; i < y.re.length; i++) {
      const re = part.re[i], im = part.im ? part.im[i] : 0;
      y.re[i] += c * re - s * im;
      y.im[i] += c * im + s * re;
    }
  });
  return y;
}

function dot(x, y) {
  let re = 0, im = 0;
  for (let i = 0; i < x.re.length; i++) re += x.re[i] * y.re[i];
  if (x.im) for (let i = 0; i < x.re.length; i++) { re -= x.im[i] * y.im[i]; im += x.re[i] * y.im[i] + x.im[i] * y.re[i]; }
  return [re, im];
}

const product = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
const quotient = ([a, b], [c, d]) => [(a * c + b * d) / (c * c + d * d), (b * c - a * d) / (c * c + d * d)];

// lambda of kappa, im >= 0, that grows (or neither)
function rootOf([re, im], given) {
  if (im === 0 && re > 0) return [0, Math.sqrt(re)];
  const size = Math.hypot(re, im);
  return [Math.sqrt(0.5 * (size - re)), given[1] === 0 ? 0 : Math.sqrt(0.5 * (size + re))];
}

// One eigenvalue to all digits with its vectors: undamped kappa := kappa + w'(M^-1 K - kappa) x / w'x; or one step to it from given vectors
function refine(pencil, own, {lambda, s}, given) {
  const found = vectorsOf(own, s, given), {x, w} = found, size = Math.hypot(...s), parts = partsOf(pencil, own.block, 0, own.n, false, x);
  const most = given ? 0.1 * Math.max(size, leastOf(own)) : 1e-4 * size;
  let turned = found.turned;
  if (pencil.damped) {
    const change = quotient(dot(w, united(parts, s, false)), dot(w, united(parts, s, true)));
    if (Math.hypot(...change) < most) lambda = s = [s[0] - change[0], s[1] - change[1]]; else turned = Infinity;
  } else {
    const mass = dot(w, x), [a, b] = quotient(dot(w, parts[0]), mass);
    if (Math.hypot(a - s[0], b - s[1]) < most) s = s[1] === 0 ? [a, 0] : [a, b]; else turned = Infinity;
    lambda = rootOf(s, lambda);
  }
  return {lambda, s, x, w, turned, slope: pencil.damped ? dot(w, united(parts, lambda, true)) : dot(w, x)};
}

// s' Q_zz^-1 r, by the form of Q_zz, over y' Q' x; undamped Q' = 2 lambda M
function estimate(pencil, own, rest, {lambda, s, x, w, slope}) {
  if (!rest) return 0;
  const {form, n, h, damped} = rest;
  const apply = (block, first, m, v, transposed) => {
    const parts = partsOf(pencil, block, first, m, transposed, v);
    if (damped) return united(parts, lambda, false);
    if (parts[2]) for (let i = 0; i < n; i++) {  // (K - kappa M) v
      const re = parts[2].re[i], im = v.im ? parts[2].im[i] : 0;
      parts[0].re[i] -= s[0] * re - s[1] * im;
      if (v.im) parts[0].im[i] -= s[0] * im + s[1] * re;
    }
    return parts[0];
  };
  const r = apply(rest.block, 0, own.n, x, false), left = apply(own.block, own.n, n, w, true), v = vector(form.N, x.im);
  for (const part of partsIn(v)) {
    for (let i = 0; i < n; i++) v[part][damped ? n + i : i] = damped ? -r[part][i] : r[part][i];
  }
  form.forth(v.re, v.im);
  form.shift(...(damped ? lambda : s));
  form.solve(v.re, v.im);
  form.back(v.re, v.im);
  for (const part of partsIn(v)) {
    v[part] = v[part].slice(0, n);
    if (damped) for (let i = 0; i < n; i++) v[part][i] /= h;
  }
  const derivative = damped ? slope : product([2 * lambda[0], 2 * lambda[1]], slope);
  return Math.hypot(...quotient(dot(left, v), derivative));
}

// Modes of the band at p, by frequency: {freq, growth, error} in Hz, 1/s, rad/s; x of that nearest to {freq, growth} `chosen`. `moving`:
// followed from those before where they can be, which model.followed tells; model.status: the contact status that they are of, null
// where it is the same everywhere
function modesAt(model, p, options = {}) {
  model.status = model.contact ? statusAt(model, p) : null;
  return modesOf(model, model.status ? modelOf(model, model.status.number) : model, p, options);
}

// The same of the model of a status, `at`
function modesOf(model, at, p, {chosen = null, moving = false}) {
  const pencil = pencilAt(at, p), own = formOf(at, pencil, p, 0, model.n_used), modes = [];
  let found = moving && model.before?.length ? follow(model, pencil, own, model.before) : null;
  model.followed = found !== null;
  found ??= candidates(model, own).map(mode => refine(pencil, own, mode));
  model.before = found;
  const rest = model.n > model.n_used ? formOf(at, pencil, p, model.n_used, model.n - model.n_used) : null;
  for (const mode of found) {
    const {lambda: [a, b], x, s} = mode;
    if (b < model.low || b > model.high) continue;
    const error = estimate(pencil, own, rest, mode), freq = b / (2 * Math.PI);
    if (!pencil.damped && a > 0) {  // of kappa itself is the one that decays, of its conjugate the one that grows
      modes.push({freq, growth: -a, error, x});
      modes.push({freq, growth: a, error, x: {re: x.re, im: x.im?.map(value => -value) ?? null}});
    } else modes.push({freq, growth: a, error, x});
  }
  modes.sort((a, b) => a.freq - b.freq || b.growth - a.growth);
  const far = mode => Math.hypot(2 * Math.PI * (mode.freq - chosen.freq), mode.growth - chosen.growth);
  const nearest = chosen && modes.reduce((best, mode) => !best || far(mode) < far(best) ? mode : best, null);
  return modes.map(mode => mode === nearest ? mode : {...mode, x: undefined});
}

// A lower triangle by columns as a symmetric matrix
function whole(n, triangle) {
  const A = new Float64Array(n * n);
  for (let j = 0, at = 0; j < n; j++) for (let i = j; i < n; i++, at++) A[j * n + i] = A[i * n + j] = triangle[at];
  return A;
}

// Matrix of a term, or its rows; take(m): the next m numbers
function readTerm({n, matrices}, {symmetric, closed, along, rows}, take) {
  if (!closed) return symmetric ? whole(n, take(n * (n + 1) / 2)) : take(n * n);
  const right = rows === undefined ? take(closed.length * n) : matrices[rows].right, own = take(closed.length * (along ? 1 : n));
  return along ? {closed, right, weight: own} : {closed, right, left: own};
}

// The model of a file's bytes: a line of JSON, then float64
function readModel(buffer) {
  const bytes = new Uint8Array(buffer), end = bytes.indexOf(10), model = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)));
  const numbers = new Float64Array(buffer.slice(end + 1));
  let from = 0;
  const take = m => { from += m; return numbers.subarray(from - m, from); };
  model.matrices = [];
  for (const term of model.terms) model.matrices.push(readTerm(model, term, take));
  if (model.contact) model.contact = readContact(model, model.contact, take(model.contact.points * (model.parameters.length + 1)));
  if (from !== numbers.length) throw new Error("the model is not whole");
  model.made = new WeakMap();
  return model;
}

if (typeof module !== "undefined") module.exports = {readModel, modesAt, statusAt, statusesAlong};
