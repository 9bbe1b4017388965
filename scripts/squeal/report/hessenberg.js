// A = S H S^-1 as dense.js makes it, and systems with A - s, s = a + i b, each in the square of the size. Vectors are two arrays, re
// and im; im is null for real ones with a real s.
"use strict";

// (re, im)[p + i] += (f, g) l[o + i] of n numbers
function addBoth(n, f, g, l, o, re, im, p) {
  if (!im) { addAt(n, f, l, o, re, p); return; }
  for (let i = 0; i < n; i++) { const t = l[o + i]; re[p + i] += f * t; im[p + i] += g * t; }
}

// (re, im)[m] += f sum l[o + i] (re, im)[m + 1 + i]
function dotBoth(n, f, l, o, re, im, m) {
  if (!im) { re[m] += f * dotAt(n, l, o, re, m + 1); return; }
  let s = 0, t = 0, u = 0, v = 0, i = 0;
  const p = m + 1;
  for (; i < n - 1; i += 2) {
    const x = l[o + i], y = l[o + i + 1];
    s += x * re[p + i]; t += x * im[p + i]; u += y * re[p + i + 1]; v += y * im[p + i + 1];
  }
  if (i < n) { s += l[o + i] * re[p + i]; t += l[o + i] * im[p + i]; }
  re[m] += f * (s + u);
  im[m] += f * (t + v);
}

class Hessenberg {
  constructor(N) {
    this.N = N;
    this.h = new Float64Array(N * N);  // by rows
    this.l = new Float64Array(N * N);
    this.work = new Float64Array(N * N);
    this.im = new Float64Array(N * N);
    this.d = new Float64Array(N);
    this.wr = new Float64Array(N);
    this.wi = new Float64Array(N);
    this.order = new Int32Array(N);
    this.lr = new Float64Array(N);
    this.li = new Float64Array(N);
    this.swapped = new Uint8Array(N);
  }

  // Of what stands in h. The scales of the first matrix serve for all that come after it, which are much like it
  reduce() {
    const {N, h, d} = this;
    let sum = 0;
    for (let i = 0; i < N * N; i++) sum += h[i] - h[i];  // of numbers that are finite zero
    if (sum !== 0) throw new Error(NOT_FINITE);
    if (d[0] === 0) balance(N, h, d);
    else for (let i = 0; i < N; i++) for (let j = 0, f = 1 / d[i]; j < N; j++) h[i * N + j] *= f * d[j];
    eliminate(N, h, this.l, this.order);
  }

  eigenvalues() {
    this.work.set(this.h);
    hqr(this.N, this.work, this.wr, this.wi);
  }

  // Factors of H - s; a pivot that is zero becomes a tiny one, as it should be for vectors
  shift(a, b) {
    const N = this.N, u = this.work, v = this.im, tiny = 2.2e-16 * (Math.abs(a) + Math.abs(b)) || 1e-300;
    this.complex = b !== 0;
    for (let j = 0; j < N; j++) u[j] = this.h[j];
    if (this.complex) v.fill(0, 0, N);
    u[0] -= a;
    v[0] = -b;
    for (let k = 0; k < N - 1; k++) {
      const size = Math.abs(u[k * N + k]) + (this.complex ? Math.abs(v[k * N + k]) : 0), other = Math.abs(this.h[(k + 1) * N + k]);
      this.swapped[k] = other > size ? 1 : 0;
      if (Math.max(size, other) < tiny) u[k * N + k] = tiny;
      if (this.complex) this.clearComplex(k, a, b); else this.clear(k, a);
    }
    const last = N * N - 1;
    if (Math.abs(u[last]) + (this.complex ? Math.abs(v[last]) : 0) < tiny) u[last] = tiny;
  }

  // Row k + 1 of the factors from that of H - a and from row k, or with both in turn
  clear(k, a) {
    const {N, h, work: u} = this, row = k * N, next = row + N, mine = u[row + k], other = h[next + k];
    if (this.swapped[k]) {
      const f = this.lr[k] = mine / other;
      u[row + k] = other;
      for (let j = k + 1; j < N; j++) { const t = h[next + j]; u[next + j] = u[row + j] - f * t; u[row + j] = t; }
      u[row + k + 1] -= a;
      u[next + k + 1] += f * a;
    } else {
      const f = this.lr[k] = other / mine;
      for (let j = k + 1; j < N; j++) u[next + j] = h[next + j] - f * u[row + j];
      u[next + k + 1] -= a;
    }
  }

  // The same with H - a - i b
  clearComplex(k, a, b) {
    const {N, h, work: u, im: v} = this, row = k * N, next = row + N, p = u[row + k], q = v[row + k], other = h[next + k];
    if (this.swapped[k]) {
      const f = this.lr[k] = p / other, g = this.li[k] = q / other;
      u[row + k] = other;
      v[row + k] = 0;
      for (let j = k + 1; j < N; j++) {
        const t = h[next + j];
        u[next + j] = u[row + j] - f * t;
        v[next + j] = v[row + j] - g * t;
        u[row + j] = t;
        v[row + j] = 0;
      }
      u[row + k + 1] -= a;
      v[row + k + 1] = -b;
      u[next + k + 1] += f * a - g * b;
      v[next + k + 1] += g * a + f * b;
    } else {
      const d = p * p + q * q, f = this.lr[k] = other * p / d, g = this.li[k] = -other * q / d;
      for (let j = k + 1; j < N; j++) {
        const x = u[row + j], y = v[row + j];
        u[next + j] = h[next + j] - (f * x - g * y);
        v[next + j] = -(f * y + g * x);
      }
      u[next + k + 1] -= a;
      v[next + k + 1] -= b;
    }
  }

  // x := (H - s)^-1 x
  solve(re, im) {
    const N = this.N, u = this.work, v = this.im;
    if (!im) { this.solveRe(re); return; }
    for (let k = 0; k < N - 1; k++) {
      if (this.swapped[k]) { let t = re[k]; re[k] = re[k + 1]; re[k + 1] = t; t = im[k]; im[k] = im[k + 1]; im[k + 1] = t; }
      const f = this.lr[k], g = this.li[k];
      re[k + 1] -= f * re[k] - g * im[k];
      im[k + 1] -= f * im[k] + g * re[k];
    }
    for (let k = N - 1; k >= 0; k--) {
      const o = k * N;
      let x = 0, y = 0, z = 0, w = 0;
      for (let j = k + 1; j < N; j++) {
        x += u[o + j] * re[j];
        z += v[o + j] * im[j];
        y += u[o + j] * im[j];
        w += v[o + j] * re[j];
      }
      x = re[k] - (x - z);
      y = im[k] - (y + w);
      const a = u[o + k], b = v[o + k], d = a * a + b * b;
      re[k] = (x * a + y * b) / d;
      im[k] = (y * a - x * b) / d;
    }
  }

  solveRe(x) {
    const N = this.N, u = this.work;
    for (let k = 0; k < N - 1; k++) {
      if (this.swapped[k]) { const t = x[k]; x[k] = x[k + 1]; x[k + 1] = t; }
      x[k + 1] -= this.lr[k] * x[k];
    }
    for (let k = N - 1; k >= 0; k--) {
      const o = k * N;
      x[k] = (x[k] - dotAt(N - k - 1, u, o + k + 1, x, k + 1)) / u[o + k];
    }
  }

  solveTransposedRe(x) {
    const N = this.N, u = this.work;
    for (let k = 0; k < N; k++) {
      const o = k * N, f = x[k] /= u[o + k];
      addAt(N - k - 1, -f, u, o + k + 1, x, k + 1);
    }
    for (let k = N - 2; k >= 0; k--) {
      x[k] -= this.lr[k] * x[k + 1];
      if (this.swapped[k]) { const t = x[k]; x[k] = x[k + 1]; x[k + 1] = t; }
    }
  }

  // x := (H - s)^-T x
  solveTransposed(re, im) {
    const N = this.N, u = this.work, v = this.im;
    if (!im) { this.solveTransposedRe(re); return; }
    for (let k = 0; k < N; k++) {
      const o = k * N, a = u[o + k], b = v[o + k], d = a * a + b * b;
      const x = (re[k] * a + im[k] * b) / d, y = (im[k] * a - re[k] * b) / d;
      re[k] = x; im[k] = y;
      for (let j = k + 1; j < N; j++) {
        re[j] -= u[o + j] * x - v[o + j] * y;
        im[j] -= u[o + j] * y + v[o + j] * x;
      }
    }
    for (let k = N - 2; k >= 0; k--) {
      const f = this.lr[k], g = this.li[k];
      re[k] -= f * re[k + 1] - g * im[k + 1];
      im[k] -= f * im[k + 1] + g * re[k + 1];
      if (this.swapped[k]) { let t = re[k]; re[k] = re[k + 1]; re[k + 1] = t; t = im[k]; im[k] = im[k + 1]; im[k + 1] = t; }
    }
  }

  // x := S x
  back(re, im) {
    const N = this.N;
    for (let m = N - 2; m > 0; m--) {
      addBoth(N - m - 1, re[m], im && im[m], this.l, m * N + m + 1, re, im, m + 1);
      this.swap(m, re, im);
    }
    for (let i = 0; i < N; i++) { re[i] *= this.d[i]; if (im) im[i] *= this.d[i]; }
  }

  // x := S^-1 x
  forth(re, im) {
    const N = this.N;
    for (let i = 0; i < N; i++) { re[i] /= this.d[i]; if (im) im[i] /= this.d[i]; }
    for (let m = 1; m < N - 1; m++) {
      this.swap(m, re, im);
      addBoth(N - m - 1, -re[m], im && -im[m], this.l, m * N + m + 1, re, im, m + 1);
    }
  }

  // y := S^T y
  forthTransposed(re, im) {
    const N = this.N;
    for (let i = 0; i < N; i++) { re[i] *= this.d[i]; if (im) im[i] *= this.d[i]; }
    for (let m = 1; m < N - 1; m++) {
      this.swap(m, re, im);
      dotBoth(N - m - 1, 1, this.l, m * N + m + 1, re, im, m);
    }
  }

  // y := S^-T y
  backTransposed(re, im) {
    const N = this.N;
    for (let m = N - 2; m > 0; m--) {
      dotBoth(N - m - 1, -1, this.l, m * N + m + 1, re, im, m);
      this.swap(m, re, im);
    }
    for (let i = 0; i < N; i++) { re[i] /= this.d[i]; if (im) im[i] /= this.d[i]; }
  }

  swap(m, re, im) {
    const j = this.order[m];
    let t = re[m]; re[m] = re[j]; re[j] = t;
    if (im) { t = im[m]; im[m] = im[j]; im[j] = t; }
  }
}
