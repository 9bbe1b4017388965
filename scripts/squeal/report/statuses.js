// Contact statuses of a reduced model: which pairs are closed differs over the box. A place has the status of the nearest point whose own
// is known, distances in parts of the range of each parameter. It stands behind dense.js. No DOM.
//
//   K = sum_t c_t(p) A_t + sum_t c_t(p) sum_r closed_r left_r' right_r:   with the rows that are closed summed, a status is a model
//   like any other, whose matrices are made once
"use strict";

const KEPT = 4;  // models of statuses that are kept

// Places of the points in the box, and their order along each parameter
function readContact(model, contact, numbers) {
  const m = contact.points, n = model.parameters.length, wide = model.parameters.map(({lower, upper}) => upper - lower);
  const places = model.parameters.map(({lower}, i) => Float64Array.from({length: m}, (_, k) => (numbers[k * n + i] - lower) / wide[i]));
  const order = places.map(place => Array.from({length: m}, (_, k) => k).sort((a, b) => place[a] - place[b]));
  const closed = contact.statuses.map(text => Array.from(text, letter => letter === "1"));
  const count = closed.map(groups => groups.reduce((sum, there, g) => sum + (there ? contact.groups[g] : 0), contact.always));
  return {...contact, places, order, closed, count, status: Array.from(numbers.subarray(m * n, m * n + m)), models: new Map(), wide};
}

const placeOf = ({parameters, contact: {wide}}, p) => p.map((value, i) => (value - parameters[i].lower) / wide[i]);

// Square of the distance of all points but along one parameter (-1: of all)
function squares({places, points}, place, apart) {
  const sum = new Float64Array(points);
  places.forEach((along, i) => { if (i !== apart) for (let k = 0; k < points; k++) sum[k] += (along[k] - place[i]) ** 2; });
  return sum;
}

// The status of the point that is nearest to p, the first one of several, how far that is, and how many pairs it has closed
function statusAt(model, p) {
  const sum = squares(model.contact, placeOf(model, p), -1);
  let nearest = 0;
  for (let k = 1; k < sum.length; k++) if (sum[k] < sum[nearest]) nearest = k;
  const number = model.contact.status[nearest];
  return {number, far: Math.sqrt(sum[nearest]), closed: model.contact.count[number]};
}

// Where along parameter i, the others as they are, which status holds: [[from, status], ...], the first from -Infinity. The points' squares
// of distances are parabolas of one width; their lower envelope is found from left to right (P. Felzenszwalb, D. Huttenlocher, Theory of
// Computing 8, 2012)
function statusesAlong(model, p, i) {
  const {contact} = model, rest = squares(contact, placeOf(model, p), i), along = contact.places[i], hull = [];
  for (const k of contact.order[i]) {
    let from = -Infinity;
    while (hull.length) {
      const last = hull[hull.length - 1], j = last.point, wide = along[k] - along[j];
      from = wide > 0 ? 0.5 * (along[k] + along[j] + (rest[k] - rest[j]) / wide) : rest[k] < rest[j] ? -Infinity : Infinity;
      if (from > last.from) break;
      hull.pop();
    }
    if (from < Infinity || !hull.length) hull.push({point: k, from: hull.length ? from : -Infinity});
  }
  const value = place => model.parameters[i].lower + place * contact.wide[i];
  return hull.map(({point, from}) => [value(from), contact.status[point]]).filter(([, status], k, all) => !k || status !== all[k - 1][1]);
}

// left' right of the rows that are closed, n x n by columns
function rowsSummed(n, {left, right, weight}, there) {
  const A = new Float64Array(n * n), row = new Float64Array(n);
  there.forEach((is, r) => {
    if (!is) return;
    for (let i = 0; i < n; i++) row[i] = weight ? weight[r] * right[r * n + i] : left[r * n + i];
    for (let j = 0; j < n; j++) addAt(n, right[r * n + j], row, 0, A, j * n);
  });
  return A;
}

// The model of a status: its own matrices in place of rows. What is made of matrices that all statuses share is made once (`made`)
function modelOf(model, status) {
  const {models, closed} = model.contact, is = closed[status];
  let one = models.get(status);
  models.delete(status);
  one ??= {...model, contact: null, made: model.made,
           matrices: model.matrices.map(A => A.left || A.weight ? rowsSummed(model.n, A, A.closed.map(g => is[g])) : A)};
  models.set(status, one);
  if (models.size > KEPT) models.delete(models.keys().next().value);
  return one;
}
