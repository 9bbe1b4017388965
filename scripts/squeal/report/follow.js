// Modes followed from those at values of the parameters nearby, while a slider moves: no QR iteration of the whole problem. It stands
// between dense.js and reduced.js, whose forms A of the pencil and products it uses.
//
//   L'A Z c = s L'Z c                    Z, L the right and left vectors of the modes before: values to begin with
//   x := (A - s)^-1 x, w := (A - s)^-T w,   s := w'A x / w'x    until it has all its digits (A. M. Ostrowski, Arch. Rational Mech. Anal.
//                                                               3, 1959)
//
// Each mode is then as good as one of the QR iteration, but a mode that none before leads to is not seen. There is no answer where two
// meet in one, or where one jumps or does not end: the whole problem is to be solved.
"use strict";

const FOLLOW_STEPS = 5, JUMP = 0.02, MEET = 0.1, LEFT = 1e-13;  // of a frequency; of the distance of two modes before the steps; of s

// Right and left vector of A, of those of M^-1 Q
function vectorsOfForm({n, h, damped, block}, {x, w, lambda: [a, b]}) {
  if (!damped) return [x, w];
  const Cw = times(block.C, n, 0, n, true, w), z = vector(2 * n, x.im), l = vector(2 * n, x.im);
  for (let i = 0; i < n; i++) {
    const [p, q, u, v] = [x.re[i], x.im?.[i] ?? 0, w.re[i], w.im?.[i] ?? 0];
    z.re[i] = h * p;
    z.re[n + i] = a * p - b * q;
    l.re[i] = (a * u - b * v + Cw.re[i]) / h;
    l.re[n + i] = u;
    if (!x.im) continue;
    z.im[i] = h * q;
    z.im[n + i] = a * q + b * p;
    l.im[i] = (a * v + b * u + Cw.im[i]) / h;
    l.im[n + i] = v;
  }
  return [z, l];
}

// A z of a real vector
function timesForm({form: {N}, n, h, damped, block}, z) {
  const real = (A, from) => times(A, n, 0, n, false, {re: z.subarray(from, from + n), im: null}).re, Kz = real(block.K, 0);
  if (!damped) return Kz;
  const Cz = real(block.C, n), y = new Float64Array(N);
  for (let i = 0; i < n; i++) { y[i] = h * z[n + i]; y[n + i] = -Kz[i] / h - Cz[i]; }
  return y;
}

// Eigenvalues of A on the vectors Z and L of some modes
function valuesOn(model, own, pairs) {
  const {form: {N}, damped} = own, Z = [], L = [];
  for (const [z, l] of pairs) for (const part of partsIn(z)) { Z.push(z[part]); L.push(l[part]); }
  const m = Z.length, G = new Float64Array(m * m), B = new Float64Array(m * m), small = new Hessenberg(m);
  Z.forEach((z, j) => {
    const Az = timesForm(own, z);
    L.forEach((l, i) => { G[j * m + i] = dotAt(N, l, 0, z, 0); B[j * m + i] = dotAt(N, l, 0, Az, 0); });
  });
  solveReal(m, G, factorReal(m, G), m, B);
  for (let i = 0; i < m; i++) for (let j = 0; j < m; j++) small.h[i * m + j] = B[j * m + i];
  small.reduce();
  return candidates(model, {form: small, damped});
}

// s of a thousandth of the highest frequency: slower modes, rigid ones among them, are known to a part of that
const leastOf = ({h, damped}) => damped ? 1e-3 * h : 1e-6 * h * h;
const apart = (a, b) => Math.hypot(a.s[0] - b.s[0], a.s[1] - b.s[1]);

// A copy that is complex or not
const likewise = (x, complex) => ({re: x.re.slice(), im: complex ? x.im?.slice() ?? new Float64Array(x.re.length) : null});

// The mode of a value by steps from the vectors of the nearest one before, gap: the distance of the next value; null where they do not end
// near it. Of a change c of s in a step, from vectors that turned by t, about (c t)^2 / gap is left
function followOne(pencil, own, value, gap, before, pairs) {
  const size = Math.max(Math.hypot(...value.s), leastOf(own));
  let nearest = 0, mode = value, start = null;
  before.forEach((other, k) => { if (apart(other, value) < apart(before[nearest], value)) nearest = k; });
  for (let step = 0; step < FOLLOW_STEPS; step++) {
    const [x, w] = start ?? pairs[nearest], complex = mode.s[1] !== 0, last = mode;
    mode = refine(pencil, own, mode, {x: likewise(x, complex), w: likewise(w, complex)});
    if (!(apart(mode, value) < JUMP * size)) return null;
    const enough = LEFT * size * Math.min(Math.max(gap, LEFT * size), size);
    if (mode.turned < Infinity && apart(mode, last) ** 2 * mode.turned < enough) return mode;
    start = vectorsOfForm(own, mode);
  }
  return null;
}

// The modes at the values of `own` from those before, or null
function follow(model, pencil, own, before) {
  const pairs = before.map(mode => vectorsOfForm(own, mode)), modes = [];
  let values;
  try { values = valuesOn(model, own, pairs); } catch { return null; }  // L'Z is singular, or its iteration does not end
  for (const value of values) {
    const gap = Math.min(...values.map(other => other === value ? Infinity : apart(other, value)), 2 * Math.abs(value.s[1]) || Infinity);
    const mode = followOne(pencil, own, value, gap, before, pairs);
    const meet = (other, k) => apart(other, mode) < MEET * apart(values[k], value) && Math.hypot(...mode.s) > leastOf(own);
    if (!mode || modes.some(meet)) return null;
    modes.push(mode);
  }
  return modes;
}
