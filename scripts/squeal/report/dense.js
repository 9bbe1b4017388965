// Dense matrices of the page: factors, a Hessenberg form, its eigenvalues by the QR iteration. No DOM, nothing of models: hessenberg.js,
// follow.js and reduced.js come after it, in a worker of the page and in node.
//
//   A = S H S^-1,   S of scaling by powers of two and elimination (EISPACK balanc, elmhes),   H upper Hessenberg, kept by rows
"use strict";

const NOT_FINITE = "a matrix is not finite at these values";

// sum a[o + i] b[p + i] of n products, in four sums side by side
function dotAt(n, a, o, b, p) {
  let s = 0, t = 0, u = 0, v = 0, i = 0;
  for (; i < n - 3; i += 4) {
    s += a[o + i] * b[p + i];
    t += a[o + i + 1] * b[p + i + 1];
    u += a[o + i + 2] * b[p + i + 2];
    v += a[o + i + 3] * b[p + i + 3];
  }
  for (; i < n; i++) s += a[o + i] * b[p + i];
  return s + t + (u + v);
}

// b[p + i] += f a[o + i] of n numbers
function addAt(n, f, a, o, b, p) {
  let i = 0;
  if (f === 0) return;
  for (; i < n - 3; i += 4) {
    b[p + i] += f * a[o + i];
    b[p + i + 1] += f * a[o + i + 1];
    b[p + i + 2] += f * a[o + i + 2];
    b[p + i + 3] += f * a[o + i + 3];
  }
  for (; i < n; i++) b[p + i] += f * a[o + i];
}

// a[p + i] += f a[o + i] of n numbers; then sum l[o + i] a[p + i], one row of a matrix being read once
function addAndDot(n, f, a, o, p, l) {
  let s = 0, t = 0, i = 0;
  for (; i < n - 1; i += 2) {
    const x = a[p + i] + f * a[o + i], y = a[p + i + 1] + f * a[o + i + 1];
    a[p + i] = x;
    a[p + i + 1] = y;
    s += x * l[o + i];
    t += y * l[o + i + 1];
  }
  if (i < n) { a[p + i] += f * a[o + i]; s += a[p + i] * l[o + i]; }
  return s + t;
}

// Factors of A [n * n] (column-major) in place; the rows' order
function factorReal(n, A) {
  const order = new Int32Array(n);
  for (let k = 0; k < n; k++) {
    let best = k;
    for (let i = k + 1; i < n; i++) if (Math.abs(A[k * n + i]) > Math.abs(A[k * n + best])) best = i;
    order[k] = best;
    if (A[k * n + best] === 0) throw new Error("the mass matrix is singular");
    if (best !== k) for (let j = 0; j < n; j++) { const t = A[j * n + k]; A[j * n + k] = A[j * n + best]; A[j * n + best] = t; }
    for (let i = k + 1; i < n; i++) A[k * n + i] /= A[k * n + k];
    for (let j = k + 1; j < n; j++) addAt(n - k - 1, -A[j * n + k], A, k * n + k + 1, A, j * n + k + 1);
  }
  return order;
}

// B := A^-1 B, m columns
function solveReal(n, LU, order, m, B) {
  for (let c = 0; c < m; c++) {
    const o = c * n;
    for (let k = 0; k < n; k++) {
      const j = order[k], f = B[o + j];
      B[o + j] = B[o + k];
      B[o + k] = f;
      addAt(n - k - 1, -f, LU, k * n + k + 1, B, o + k + 1);
    }
    for (let k = n - 1; k >= 0; k--) {
      const f = (B[o + k] /= LU[k * n + k]);
      addAt(k, -f, LU, k * n, B, o);
    }
  }
}

// b := A^-T b
function solveTransposed(n, LU, order, b) {
  for (let k = 0; k < n; k++) b[k] = (b[k] - dotAt(k, LU, k * n, b, 0)) / LU[k * n + k];
  for (let k = n - 1; k >= 0; k--) {
    const sum = b[k] - dotAt(n - k - 1, LU, k * n + k + 1, b, k + 1);
    b[k] = b[order[k]];
    b[order[k]] = sum;
  }
}

// Scales rows and columns of a [N * N] by powers of two to like sizes; d: the scales
function balance(N, a, d) {
  d.fill(1);
  for (let done = false; !done;) {
    done = true;
    for (let i = 0; i < N; i++) {
      let column = 0, row = 0;
      for (let j = 0; j < N; j++) if (j !== i) { column += Math.abs(a[j * N + i]); row += Math.abs(a[i * N + j]); }
      if (!(column + row < Infinity)) throw new Error(NOT_FINITE);
      if (column === 0 || row === 0) continue;
      let f = 1;
      const sum = column + row;
      while (column < row / 2) { f *= 2; column *= 4; }
      while (column >= row * 2) { f /= 2; column /= 4; }
      if ((column + row) / f >= 0.95 * sum || f === 1) continue;
      done = false;
      d[i] *= f;
      for (let j = 0; j < N; j++) a[i * N + j] /= f;
      for (let j = 0; j < N; j++) a[j * N + i] *= f;
    }
  }
}

// Eliminates below the subdiagonal of a [N * N]; row m of l has the factors, behind its place m; the rows' order
function eliminate(N, a, l, order) {
  for (let m = 1; m < N - 1; m++) {
    let best = m;
    for (let i = m + 1; i < N; i++) if (Math.abs(a[i * N + m - 1]) > Math.abs(a[best * N + m - 1])) best = i;
    order[m] = best;
    if (best !== m) {
      for (let j = m - 1; j < N; j++) { const t = a[best * N + j]; a[best * N + j] = a[m * N + j]; a[m * N + j] = t; }
      for (let i = 0; i < N; i++) { const t = a[i * N + best]; a[i * N + best] = a[i * N + m]; a[i * N + m] = t; }
    }
    const pivot = a[m * N + m - 1], top = m * N;
    l.fill(0, top + m + 1, top + N);
    if (pivot === 0) continue;
    for (let i = m + 1; i < N; i++) { l[top + i] = a[i * N + m - 1] / pivot; a[i * N + m - 1] = 0; }
    for (let i = m + 1; i < N; i++)
      a[i * N + m] += addAndDot(N - m - 1, -l[top + i], a, top + m + 1, i * N + m + 1, l) - l[top + i] * a[top + m];
    for (let i = 0; i <= m; i++) a[i * N + m] += dotAt(N - m - 1, l, top + m + 1, a, i * N + m + 1);
  }
}

// Eigenvalues wr + i wi of the Hessenberg matrix a [n * n], which is destroyed, by the QR iteration with double shifts (EISPACK hqr)
function hqr(n, a, wr, wi) {
  let norm = 0, shift = 0;
  for (let i = 0; i < n; i++) for (let j = Math.max(i - 1, 0); j < n; j++) norm += Math.abs(a[i * n + j]);
  for (let last = n - 1; last >= 0;) {
    for (let turn = 0; ; turn++) {
      let l = last;
      for (; l > 0; l--) {
        const size = Math.abs(a[(l - 1) * n + l - 1]) + Math.abs(a[l * n + l]) || norm;
        if (Math.abs(a[l * n + l - 1]) <= 2.2e-16 * size) { a[l * n + l - 1] = 0; break; }
      }
      let x = a[last * n + last];
      if (l === last) { wr[last] = x + shift; wi[last] = 0; last--; break; }
      let y = a[(last - 1) * n + last - 1], w = a[last * n + last - 1] * a[(last - 1) * n + last];
      if (l === last - 1) {
        const p = 0.5 * (y - x), q = p * p + w, root = Math.sqrt(Math.abs(q));
        x += shift;
        const z = p + (p >= 0 ? root : -root);
        wr[last - 1] = q >= 0 ? x + z : x + p;
        wr[last] = q < 0 ? x + p : z !== 0 ? x - w / z : x + z;
        wi[last - 1] = q < 0 ? root : 0;
        wi[last] = -wi[last - 1];
        last -= 2;
        break;
      }
      if (turn === 60) throw new Error("the QR iteration does not converge");
      if (turn % 10 === 9) {
        shift += x;
        for (let i = 0; i <= last; i++) a[i * n + i] -= x;
        const size = Math.abs(a[last * n + last - 1]) + Math.abs(a[(last - 1) * n + last - 2]);
        x = y = 0.75 * size;
        w = -0.4375 * size * size;
      }
      step(n, a, l, last, x, y, w);
    }
  }
}

// One double step on rows and columns l .. last
function step(n, a, l, last, x, y, w) {
  let m = last - 2, p, q, r;
  for (; m >= l; m--) {
    const z = a[m * n + m], s = y - z, t = x - z;
    p = (t * s - w) / a[(m + 1) * n + m] + a[m * n + m + 1];
    q = a[(m + 1) * n + m + 1] - z - t - s;
    r = a[(m + 2) * n + m + 1];
    const size = Math.abs(p) + Math.abs(q) + Math.abs(r);
    p /= size; q /= size; r /= size;
    if (m === l) break;
    const u = Math.abs(a[m * n + m - 1]) * (Math.abs(q) + Math.abs(r));
    if (u <= 2.2e-16 * Math.abs(p) * (Math.abs(a[(m - 1) * n + m - 1]) + Math.abs(z) + Math.abs(a[(m + 1) * n + m + 1]))) break;
  }
  for (let i = m + 2; i <= last; i++) { a[i * n + i - 2] = 0; if (i !== m + 2) a[i * n + i - 3] = 0; }
  for (let k = m; k < last; k++) {
    const three = k !== last - 1, r0 = k * n, r1 = r0 + n, r2 = r1 + n;
    let size = 1;
    if (k !== m) {
      p = a[r0 + k - 1]; q = a[r1 + k - 1]; r = three ? a[r2 + k - 1] : 0;
      size = Math.abs(p) + Math.abs(q) + Math.abs(r);
      if (size === 0) continue;
      p /= size; q /= size; r /= size;
    }
    const s = (p >= 0 ? 1 : -1) * Math.sqrt(p * p + q * q + r * r);
    if (k === m) { if (l !== m) a[r0 + k - 1] = -a[r0 + k - 1]; } else a[r0 + k - 1] = -s * size;
    p += s;
    const fx = p / s, fy = q / s, fz = r / s;
    q /= p; r /= p;
    if (three) reflect3(n, a, k, l, last, fx, fy, fz, q, r); else reflect2(n, a, k, l, last, fx, fy, q);
  }
}

function reflect3(n, a, k, l, last, fx, fy, fz, q, r) {
  const r0 = k * n, r1 = r0 + n, r2 = r1 + n;
  for (let j = k; j <= last; j++) {
    const t = a[r0 + j] + q * a[r1 + j] + r * a[r2 + j];
    a[r0 + j] -= t * fx; a[r1 + j] -= t * fy; a[r2 + j] -= t * fz;
  }
  for (let i = l * n + k, end = Math.min(last, k + 3) * n + k; i <= end; i += n) {
    const t = fx * a[i] + fy * a[i + 1] + fz * a[i + 2];
    a[i] -= t; a[i + 1] -= t * q; a[i + 2] -= t * r;
  }
}

function reflect2(n, a, k, l, last, fx, fy, q) {
  const r0 = k * n, r1 = r0 + n;
  for (let j = k; j <= last; j++) {
    const t = a[r0 + j] + q * a[r1 + j];
    a[r0 + j] -= t * fx; a[r1 + j] -= t * fy;
  }
  for (let i = l * n + k, end = Math.min(last, k + 3) * n + k; i <= end; i += n) {
    const t = fx * a[i] + fy * a[i + 1];
    a[i] -= t; a[i + 1] -= t * q;
  }
}
