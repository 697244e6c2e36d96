/* A planar scene that moves: where its carriers are at some coordinates, and the coordinates that satisfy its constraints
   with a point as near to another as it can be. Part of dofkit, under its MIT licence. */
"use strict";
function planarScene(program) {
  const slopes = {
    sin: function (u) { return [Math.sin(u), Math.cos(u)]; }, cos: function (u) { return [Math.cos(u), -Math.sin(u)]; },
    tan: function (u) { const t = Math.tan(u); return [t, 1 + t * t]; }, exp: function (u) { return [Math.exp(u), Math.exp(u)]; },
    log: function (u) { return [Math.log(u), 1 / u]; }, abs: function (u) { return [Math.abs(u), Math.sign(u)]; }
  };

  /* The values of all steps of the program, and their derivatives by the scaled coordinates. */
  function evaluate(q, wanted) {
    const values = [], gradients = [], count = wanted ? q.length : 0, zero = new Float64Array(count);
    for (const step of program.steps) {
      const [op, first] = Array.isArray(step) ? step : [null], gradient = op === null ? zero : new Float64Array(count);
      let value = op === "mul" ? 1 : 0;
      const add = function (node, factor) {
        const of = gradients[node];
        if (of === zero) { return; }
        for (let k = 0; k < count; k++) { gradient[k] += factor * of[k]; }
      };
      if (op === null) {
        value = step;
      } else if (op === "q") {
        value = q[first];
        if (count) { gradient[first] = program.scales[first]; }
      } else if (op === "add") {
        for (const node of step.slice(1)) { value += values[node]; add(node, 1); }
      } else if (op === "mul") {
        const nodes = step.slice(1);
        nodes.forEach(function (node, j) {
          value *= values[node];
          add(node, nodes.reduce(function (product, other, k) { return k === j ? product : product * values[other]; }, 1));
        });
      } else if (op === "pow") {
        value = Math.pow(values[first], step[2]);
        add(first, step[2] * Math.pow(values[first], step[2] - 1));
      } else {
        const [at, slope] = slopes[op](values[first]);
        value = at;
        add(first, slope);
      }
      values.push(value);
      gradients.push(gradient);
    }
    return { values: values, gradients: gradients };
  }

  function inner(a, b, count = a.length) {
    let sum = 0;
    for (let k = 0; k < count; k++) { sum += a[k] * b[k]; }
    return sum;
  }

  /* The shortest step whose products with the rows are the gaps (least squares where rows depend on each other). */
  function shortest(rows, gaps) {
    const lower = [], x = [], step = new Float64Array(rows.length ? rows[0].length : 0);
    rows.forEach(function (row, i) {
      lower.push([]);
      for (let j = 0; j <= i; j++) {
        const rest = inner(row, rows[j]) - inner(lower[i], lower[j], j);
        lower[i].push(i === j ? Math.sqrt(Math.max(rest, 0) + 1e-12) : rest / lower[j][j]);
      }
      x.push((gaps[i] - inner(x, lower[i])) / lower[i][i]);
    });
    for (let i = rows.length - 1; i >= 0; i--) {
      x[i] /= lower[i][i];
      for (let j = 0; j < i; j++) { x[j] -= lower[i][j] * x[i]; }
      for (let k = 0; k < step.length; k++) { step[k] += x[i] * rows[i][k]; }
    }
    return step;
  }

  /* The constraints at some coordinates: rows of length 1, gaps, and the largest gap. */
  function constraints(q, off) {
    const at = evaluate(q, true), rows = [], gaps = [];
    for (const [name, node] of program.relations) {
      const size = Math.sqrt(inner(at.gradients[node], at.gradients[node]));
      if (off.has(name) || size < 1e-9) { continue; }
      rows.push(at.gradients[node].map(function (entry) { return entry / size; }));
      gaps.push(-at.values[node] / size);
    }
    const within = program.limits.every(function (node) { return at.values[node] >= -1e-9; });
    return { at: at, rows: rows, gaps: gaps, within: within, worst: Math.max(0, ...gaps.map(Math.abs)) };
  }

  function stepped(q, step, part) { return q.map(function (x, k) { return x + part * program.scales[k] * step[k]; }); }

  /* Newton's method: the nearest coordinates that satisfy the constraints. */
  function satisfied(q, off) {
    let here = constraints(q, off);
    for (let round = 0; round < 12 && here.worst > 1e-13; round++) {
      q = stepped(q, shortest(here.rows, here.gaps), 1);
      here = constraints(q, off);
    }
    return { q: q, here: here };
  }

  /* Where a point of a carrier is, and the derivatives of its place. */
  function gripped(at, grip) {
    const [x, y, c, s] = program.poses[grip[0]], a = grip[1], b = grip[2];
    const turns = c !== undefined, zero = program.scales.map(function () { return 0; });
    function sum(of, no) {
      const cos = turns ? of[c] : no, sin = turns ? of[s] : no;
      return [[of[x], cos, sin, 1, a, -b], [of[y], sin, cos, 1, a, b]];
    }
    const place = sum(at.values, 0).map(function ([u, v, w, k, m, n]) { return k * u + m * v + n * w; });
    const slope = sum(at.gradients, zero).map(function ([u, v, w, k, m, n]) {
      return zero.map(function (_, i) { return k * u[i] + m * v[i] + n * w[i]; });
    });
    return { place: turns ? place : [place[0] + a, place[1] + b], slope: slope };
  }

  /* Gauss and Newton: coordinates that satisfy the constraints, with a point as near to a target as they can be. */
  function pulled(q, grip, target, off) {
    let now = satisfied(q, off);
    if (!(now.here.worst < 1e-9)) { return now; }
    for (let round = 0; round < 3; round++) {
      const point = gripped(now.here.at, grip), rows = now.here.rows;
      const gap = [target[0] - point.place[0], target[1] - point.place[1]];
      const free = point.slope.map(function (row) {
        const bound = shortest(rows, rows.map(function (other) { return inner(other, row); }));
        return row.map(function (entry, k) { return rows.length ? entry - bound[k] : entry; });
      });
      const wide = Math.sqrt(inner(free[0], free[0]) + inner(free[1], free[1]));
      if (wide < 1e-9) { break; }
      /* two damped equations for the two components of the gap */
      const m = inner(free[0], free[0]) + 1e-4 * wide * wide, n = inner(free[0], free[1]), o = inner(free[1], free[1]) + 1e-4 * wide * wide;
      const det = m * o - n * n, f = (o * gap[0] - n * gap[1]) / det, g = (m * gap[1] - n * gap[0]) / det;
      const step = free[0].map(function (entry, k) { return f * entry + g * free[1][k]; });
      const size = Math.max(...step.map(Math.abs));
      let better = null;
      for (let part = Math.min(1, 0.3 / Math.max(size, 1e-12)); part > 1e-3 && !better; part /= 2) {
        const next = satisfied(stepped(now.q, step, part), off), place = gripped(next.here.at, grip).place;
        const nearer = Math.hypot(target[0] - place[0], target[1] - place[1]) < Math.hypot(gap[0], gap[1]) * (1 - 1e-9);
        if (nearer && next.here.within && next.here.worst < 1e-9) { better = next; }
      }
      if (!better) { break; }
      now = better;
    }
    return now;
  }

  /* The poses of all carriers at some coordinates. */
  function placed(q) {
    const at = evaluate(q, false).values;
    return program.poses.map(function (nodes) {
      const [x, y, c, s] = nodes.map(function (node) { return at[node]; });
      return { turn: c === undefined ? [1, 0, 0, 0, 1, 0, 0, 0, 1] : [c, -s, 0, s, c, 0, 0, 0, 1], shift: [x, y, 0] };
    });
  }

  return { placed: placed, satisfied: satisfied, pulled: pulled };
}
