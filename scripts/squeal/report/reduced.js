// The reduced model of a sweep, a sample or a quiet box: its pencil at any values of the parameters, all eigenvalues by the QR
// iteration, those of the band with vectors by Newton's method, their growth and the estimated error. No DOM: it runs in a worker
// of the page and in node.
//
//   Q(lambda; p) = lambda^2 M + lambda C + K,   each a sum of c_t(p) A_t, c monomials
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
  const n = model.n, pencil = {K: new Float64Array(n * n), C: new Float64Array(n * n), M: new Float64Array(n * n), damped: false};
  model.terms.forEach((term, t) => {
    const c = coefficient(term, p), sum = pencil[term.kind], A = model.matrices[t];
    if (!Number.isFinite(c)) throw new Error("a matrix is not finite at these values");
    if (c === 0) return;
    if (term.kind === "C") pencil.damped = true;
    for (let i = 0; i < n * n; i++) sum[i] += c * A[i];
  });
  return pencil;
}

// Factors of A [n * n] (column-major) in place; the rows' order
function factorReal(n, A) {
  const order = new Int32Array(n);
  for (let k = 0; k < n; k++) {
    let best = k;
    for (let i = k + 1; i < n; i++) if (Math.abs(A[k * n + i]) > Math.abs(A[k * n + best])) best = i;
    order[k] = best;
    if (A[k * n + best] === 0) throw new Error("the mass matrix is singular");
    if (best !== k) for (let j = 0; j < n; j++) [A[j * n + k], A[j * n + best]] = [A[j * n + best], A[j * n + k]];
    for (let i = k + 1; i < n; i++) A[k * n + i] /= A[k * n + k];
    for (let j = k + 1; j < n; j++) {
      const f = A[j * n + k];
      if (f !== 0) for (let i = k + 1; i < n; i++) A[j * n + i] -= f * A[k * n + i];
    }
  }
  return order;
}

// B := A^-1 B, m columns
function solveReal(n, LU, order, m, B) {
  for (let c = 0; c < m; c++) {
    const o = c * n;
    for (let k = 0; k < n; k++) {
      if (order[k] !== k) [B[o + k], B[o + order[k]]] = [B[o + order[k]], B[o + k]];
      const f = B[o + k];
      if (f !== 0) for (let i = k + 1; i < n; i++) B[o + i] -= f * LU[k * n + i];
    }
    for (let k = n - 1; k >= 0; k--) {
      const f = (B[o + k] /= LU[k * n + k]);
      if (f !== 0) for (let i = 0; i < k; i++) B[o + i] -= f * LU[k * n + i];
    }
  }
}

// Similar to an upper Hessenberg matrix by elimination with pivots, rows r [N][N] in place (EISPACK elmhes)
function hessenberg(r) {
  const N = r.length;
  for (let m = 1; m < N - 1; m++) {
    let best = m;
    for (let i = m; i < N; i++) if (Math.abs(r[i][m - 1]) > Math.abs(r[best][m - 1])) best = i;
    if (r[best][m - 1] === 0) continue;
    if (best !== m) {
      [r[best], r[m]] = [r[m], r[best]];
      for (const row of r) [row[best], row[m]] = [row[m], row[best]];
    }
    const pivot = r[m][m - 1], top = r[m];
    const f = new Float64Array(N);
    for (let i = m + 1; i < N; i++) {
      f[i] = r[i][m - 1] / pivot;
      if (f[i] === 0) continue;
      const row = r[i], factor = f[i];
      row[m - 1] = 0;
      for (let j = m; j < N; j++) row[j] -= factor * top[j];
    }
    for (const row of r) {
      let sum = 0;
      for (let i = m + 1; i < N; i++) sum += f[i] * row[i];
      row[m] += sum;
    }
  }
}

// Scales rows and columns by powers of two to like sizes (EISPACK balanc, without permutations)
function balance(r) {
  const N = r.length;
  for (let done = false; !done;) {
    done = true;
    for (let i = 0; i < N; i++) {
      let column = 0, row = 0;
      for (let j = 0; j < N; j++) if (j !== i) { column += Math.abs(r[j][i]); row += Math.abs(r[i][j]); }
      if (column === 0 || row === 0) continue;
      let f = 1;
      const sum = column + row;
      while (column < row / 2) { f *= 2; column *= 4; }
      while (column >= row * 2) { f /= 2; column /= 4; }
      if ((column + row) / f >= 0.95 * sum || f === 1) continue;
      done = false;
      for (let j = 0; j < N; j++) r[i][j] /= f;
      for (let j = 0; j < N; j++) r[j][i] *= f;
    }
  }
}

// Eigenvalues [re, im] of a Hessenberg matrix by the QR iteration with double shifts (EISPACK hqr)
function hqr(a) {
  const n = a.length, found = [];
  let norm = 0, shift = 0;
  for (let i = 0; i < n; i++) for (let j = Math.max(i - 1, 0); j < n; j++) norm += Math.abs(a[i][j]);
  for (let last = n - 1; last >= 0;) {
    for (let turn = 0; ; turn++) {
      let l = last;
      for (; l > 0; l--) {
        const size = Math.abs(a[l - 1][l - 1]) + Math.abs(a[l][l]) || norm;
        if (Math.abs(a[l][l - 1]) <= 2.2e-16 * size) { a[l][l - 1] = 0; break; }
      }
      let x = a[last][last];
      if (l === last) { found.push([x + shift, 0]); last--; break; }
      let y = a[last - 1][last - 1], w = a[last][last - 1] * a[last - 1][last];
      if (l === last - 1) {
        const p = 0.5 * (y - x), q = p * p + w, root = Math.sqrt(Math.abs(q));
        x += shift;
        if (q >= 0) {
          const z = p + (p >= 0 ? root : -root);
          found.push([x + z, 0], [z !== 0 ? x - w / z : x + z, 0]);
        } else found.push([x + p, root], [x + p, -root]);
        last -= 2;
        break;
      }
      if (turn === 60) throw new Error("the QR iteration does not converge");
      if (turn % 10 === 9) {
        shift += x;
        for (let i = 0; i <= last; i++) a[i][i] -= x;
        const size = Math.abs(a[last][last - 1]) + Math.abs(a[last - 1][last - 2]);
        x = y = 0.75 * size;
        w = -0.4375 * size * size;
      }
      let m = last - 2, p, q, r;
      for (; m >= l; m--) {
        const z = a[m][m], s = y - z, t = x - z;
        p = (t * s - w) / a[m + 1][m] + a[m][m + 1];
        q = a[m + 1][m + 1] - z - t - s;
        r = a[m + 2][m + 1];
        const size = Math.abs(p) + Math.abs(q) + Math.abs(r);
        p /= size; q /= size; r /= size;
        if (m === l) break;
        const u = Math.abs(a[m][m - 1]) * (Math.abs(q) + Math.abs(r));
        if (u <= 2.2e-16 * Math.abs(p) * (Math.abs(a[m - 1][m - 1]) + Math.abs(z) + Math.abs(a[m + 1][m + 1]))) break;
      }
      for (let i = m + 2; i <= last; i++) { a[i][i - 2] = 0; if (i !== m + 2) a[i][i - 3] = 0; }
      for (let k = m; k < last; k++) {
        let size = 1;
        if (k !== m) {
          p = a[k][k - 1]; q = a[k + 1][k - 1]; r = k !== last - 1 ? a[k + 2][k - 1] : 0;
          size = Math.abs(p) + Math.abs(q) + Math.abs(r);
          if (size === 0) continue;
          p /= size; q /= size; r /= size;
        }
        const s = (p >= 0 ? 1 : -1) * Math.sqrt(p * p + q * q + r * r);
        if (k === m) { if (l !== m) a[k][k - 1] = -a[k][k - 1]; } else a[k][k - 1] = -s * size;
        p += s;
        const fx = p / s, fy = q / s, fz = r / s;
        q /= p; r /= p;
        const r0 = a[k], r1 = a[k + 1], r2 = k !== last - 1 ? a[k + 2] : null;
        for (let j = k; j <= last; j++) {
          let t = r0[j] + q * r1[j];
          if (r2) { t += r * r2[j]; r2[j] -= t * fz; }
          r1[j] -= t * fy;
          r0[j] -= t * fx;
        }
        for (let i = l, end = Math.min(last, k + 3); i <= end; i++) {
          const row = a[i];
          let t = fx * row[k] + fy * row[k + 1];
          if (r2) { t += fz * row[k + 2]; row[k + 2] -= t * r; }
          row[k + 1] -= t * q;
          row[k] -= t;
        }
      }
    }
  }
  return found;
}

// All eigenvalues lambda = [re, im], im >= 0, on the leading n_used vectors
function eigenvalues(model, pencil) {
  const n = model.n_used, stride = model.n, M = new Float64Array(n * n), K = new Float64Array(n * n), C = new Float64Array(n * n);
  for (let j = 0; j < n; j++) {
    for (let i = 0; i < n; i++) {
      M[j * n + i] = pencil.M[j * stride + i]; K[j * n + i] = pencil.K[j * stride + i]; C[j * n + i] = pencil.C[j * stride + i];
    }
  }
  const order = factorReal(n, M), h = model.high, N = pencil.damped ? 2 * n : n;
  solveReal(n, M, order, n, K);
  if (pencil.damped) solveReal(n, M, order, n, C);
  const rows = Array.from({length: N}, () => new Float64Array(N));
  for (let i = 0; i < n; i++) {
    if (pencil.damped) rows[i][n + i] = h;
    for (let j = 0; j < n; j++) {
      if (!pencil.damped) rows[i][j] = K[j * n + i];
      else { rows[n + i][j] = -K[j * n + i] / h; rows[n + i][n + j] = -C[j * n + i]; }
    }
  }
  balance(rows);
  hessenberg(rows);
  const values = hqr(rows);
  if (pencil.damped) return values.filter(([, im]) => im >= 0);
  return values.filter(([, im]) => im >= 0).map(([re, im]) => {  // lambda^2 = -kappa; of a pair the one that grows
    const size = Math.hypot(re, im), a = Math.sqrt(0.5 * (size + re)), b = Math.sqrt(0.5 * (size - re));
    return [[b, a], [-b, a]].slice(0, im === 0 ? 1 : 2);
  }).flat();
}

// Complex Q(lambda) on rows and columns first .. first + n - 1: re, im column-major
function evaluate(model, pencil, [a, b], first, n) {
  const stride = model.n, re = new Float64Array(n * n), im = new Float64Array(n * n), s = a * a - b * b, t = 2 * a * b;
  for (let j = 0; j < n; j++) {
    for (let i = 0; i < n; i++) {
      const k = (first + j) * stride + first + i;
      re[j * n + i] = s * pencil.M[k] + a * pencil.C[k] + pencil.K[k];
      im[j * n + i] = t * pencil.M[k] + b * pencil.C[k];
    }
  }
  return {n, re, im};
}

function factorComplex(Q) {
  const {n, re, im} = Q, order = new Int32Array(n);
  for (let k = 0; k < n; k++) {
    let best = k, most = -1;
    for (let i = k; i < n; i++) {
      const size = Math.abs(re[k * n + i]) + Math.abs(im[k * n + i]);
      if (size > most) { most = size; best = i; }
    }
    order[k] = best;
    if (most === 0) { re[k * n + k] = 1e-300; continue; }
    if (best !== k) for (let j = 0; j < n; j++) {
      const o = j * n;
      [re[o + k], re[o + best]] = [re[o + best], re[o + k]];
      [im[o + k], im[o + best]] = [im[o + best], im[o + k]];
    }
    const d = re[k * n + k] ** 2 + im[k * n + k] ** 2, c = re[k * n + k] / d, s = -im[k * n + k] / d;
    for (let i = k + 1; i < n; i++) {
      const x = re[k * n + i], y = im[k * n + i];
      re[k * n + i] = x * c - y * s;
      im[k * n + i] = x * s + y * c;
    }
    for (let j = k + 1; j < n; j++) {
      const x = re[j * n + k], y = im[j * n + k];
      if (x === 0 && y === 0) continue;
      for (let i = k + 1; i < n; i++) {
        re[j * n + i] -= x * re[k * n + i] - y * im[k * n + i];
        im[j * n + i] -= x * im[k * n + i] + y * re[k * n + i];
      }
    }
  }
  Q.order = order;
  return Q;
}

// x := Q^-1 x, or Q^-T x, of one vector {re, im}
function solveComplex(Q, transposed, x) {
  const {n, re, im, order} = Q;
  const divide = (k) => {
    const d = re[k * n + k] ** 2 + im[k * n + k] ** 2, a = x.re[k], b = x.im[k];
    x.re[k] = (a * re[k * n + k] + b * im[k * n + k]) / d;
    x.im[k] = (b * re[k * n + k] - a * im[k * n + k]) / d;
  };
  const swap = (k) => {
    const j = order[k];
    [x.re[k], x.re[j]] = [x.re[j], x.re[k]];
    [x.im[k], x.im[j]] = [x.im[j], x.im[k]];
  };
  const away = (i, k, entry) => {  // x_i -= entry x_k
    x.re[i] -= re[entry] * x.re[k] - im[entry] * x.im[k];
    x.im[i] -= re[entry] * x.im[k] + im[entry] * x.re[k];
  };
  if (!transposed) {
    for (let k = 0; k < n; k++) swap(k);
    for (let k = 0; k < n; k++) for (let i = k + 1; i < n; i++) away(i, k, k * n + i);
    for (let k = n - 1; k >= 0; k--) { divide(k); for (let i = 0; i < k; i++) away(i, k, k * n + i); }
  } else {
    for (let k = 0; k < n; k++) { for (let i = 0; i < k; i++) away(k, i, k * n + i); divide(k); }
    for (let k = n - 1; k >= 0; k--) for (let i = k + 1; i < n; i++) away(k, i, k * n + i);
    for (let k = n - 1; k >= 0; k--) swap(k);
  }
}

function normalise(x) {
  let square = 0;
  for (let i = 0; i < x.re.length; i++) square += x.re[i] ** 2 + x.im[i] ** 2;
  const f = 1 / Math.sqrt(square);
  for (let i = 0; i < x.re.length; i++) { x.re[i] *= f; x.im[i] *= f; }
}

// A x, A real on rows of `to` and columns of `from` = [first, n]; transposed: A' x
function times(A, stride, to, from, transposed, x) {
  const y = {re: new Float64Array(to[1]), im: new Float64Array(to[1])};
  for (let j = 0; j < from[1]; j++) {
    for (let i = 0; i < to[1]; i++) {
      const entry = transposed ? A[(to[0] + i) * stride + from[0] + j] : A[(from[0] + j) * stride + to[0] + i];
      y.re[i] += entry * x.re[j];
      y.im[i] += entry * x.im[j];
    }
  }
  return y;
}

// sum over K, C, M of their power of lambda: Q x, or with derivative Q' x
function applied(model, pencil, [a, b], to, from, transposed, x, derivative) {
  const weights = derivative ? [[0, 0], [1, 0], [2 * a, 2 * b]] : [[1, 0], [a, b], [a * a - b * b, 2 * a * b]];
  const y = {re: new Float64Array(to[1]), im: new Float64Array(to[1])};
  ["K", "C", "M"].forEach((kind, k) => {
    const [c, s] = weights[k];
    if ((c === 0 && s === 0) || (kind === "C" && !pencil.damped)) return;
    const part = times(pencil[kind], model.n, to, from, transposed, x);
    for (let i = 0; i < to[1]; i++) {
      y.re[i] += c * part.re[i] - s * part.im[i];
      y.im[i] += c * part.im[i] + s * part.re[i];
    }
  });
  return y;
}

function dot(x, y) {
  let re = 0, im = 0;
  for (let i = 0; i < x.re.length; i++) { re += x.re[i] * y.re[i] - x.im[i] * y.im[i]; im += x.re[i] * y.im[i] + x.im[i] * y.re[i]; }
  return [re, im];
}

const quotient = ([a, b], [c, d]) => [(a * c + b * d) / (c * c + d * d), (b * c - a * d) / (c * c + d * d)];

// One eigenvalue to all digits with its vectors, and the estimated error
function refine(model, pencil, lambda) {
  const n = model.n_used, own = [0, n], x = {re: new Float64Array(n), im: new Float64Array(n)};
  for (let i = 0; i < n; i++) { x.re[i] = Math.cos(1 + i * i); x.im[i] = Math.sin(2 + i); }
  const y = {re: x.im.slice(), im: x.re.slice()};
  let step = Infinity, slope;
  for (let turn = 0; turn < 5; turn++) {
    const Q = factorComplex(evaluate(model, pencil, lambda, 0, n));
    for (let k = 0; k < (turn ? 1 : 2); k++) {
      solveComplex(Q, false, x); normalise(x);
      solveComplex(Q, true, y); normalise(y);
    }
    slope = dot(y, applied(model, pencil, lambda, own, own, false, x, true));
    const change = quotient(dot(y, applied(model, pencil, lambda, own, own, false, x, false)), slope), size = Math.hypot(...change);
    if (!(size < 0.5 * step) || !(size < 1e-4 * Math.hypot(...lambda))) break;
    lambda = [lambda[0] - change[0], lambda[1] - change[1]];
    step = size;
    if (size < 1e-14 * Math.hypot(...lambda)) break;
  }
  return {lambda, error: estimate(model, pencil, lambda, x, y, slope)};
}

function estimate(model, pencil, lambda, x, y, slope) {
  const n = model.n_used, z = [n, model.n - n];
  if (!z[1]) return 0;
  const Q = factorComplex(evaluate(model, pencil, lambda, n, z[1]));
  const r = applied(model, pencil, lambda, z, [0, n], false, x, false), s = applied(model, pencil, lambda, z, [0, n], true, y, false);
  solveComplex(Q, false, r);
  return Math.hypot(...quotient(dot(s, r), slope));
}

// Modes of the band at p, by frequency: {freq, growth, error} in Hz, 1/s, rad/s
function modesAt(model, p) {
  const pencil = pencilAt(model, p), within = (w) => w >= model.low * (1 - 1e-6) && w <= model.high * (1 + 1e-6);
  return eigenvalues(model, pencil).filter(([, w]) => within(w)).map((value) => refine(model, pencil, value))
    .filter(({lambda: [, w]}) => w >= model.low && w <= model.high)
    .map(({lambda, error}) => ({freq: lambda[1] / (2 * Math.PI), growth: lambda[0], error}))
    .sort((a, b) => a.freq - b.freq);
}

// The model of a file's bytes: a line of JSON, then the matrices as float64
function readModel(buffer) {
  const bytes = new Uint8Array(buffer), end = bytes.indexOf(10), model = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)));
  const size = model.n * model.n, numbers = new Float64Array(buffer.slice(end + 1));
  if (numbers.length !== size * model.terms.length) throw new Error("the model is not whole");
  model.matrices = model.terms.map((_, t) => numbers.subarray(t * size, (t + 1) * size));
  return model;
}

if (typeof module !== "undefined") module.exports = {readModel, modesAt, pencilAt, eigenvalues};
