// Normal forms: quotients of polynomials over the rationals in atoms (symbols, sines, cosines, roots, exponentials,
// and what is opaque), with s^2 + c^2 = 1 and r^k = u. What has the numerator 0 is 0.

import { Interval, LONGEST, NotCovered, R0, R1, Rational, Refused, refuse } from "./numbers.mjs";
import * as tr from "./trees.mjs";

let ATOMS = [];
let BY_KEY = new Map();
let MEMO = new Map();
let work = 0;
let deadline = Infinity;
const [MOST, SECONDS] = [3000000, 2];

export function reset() {
  ATOMS = [];
  BY_KEY = new Map();
  MEMO = new Map();
}

/** Starts to count the work, and the time, of one claim. */
export function restart() {
  work = 0;
  deadline = Date.now() + SECONDS * 1000;
}

function spend(amount) {
  work += amount;
  if (work > MOST || Date.now() > deadline) throw new NotCovered("an identity is too large for this checker");
}

/** The index of an atom; `rule`: { kind: "sine", cosine } or { kind: "root", order, value }. */
function atom(key, rule = null) {
  if (!BY_KEY.has(key)) {
    BY_KEY.set(key, ATOMS.length);
    ATOMS.push({ key, rule });
  }
  return BY_KEY.get(key);
}

// -- polynomials: Map from a monomial's key to { m: [[atom, exponent], ...], c } --------------------

const keyOf = (m) => m.map(([a, e]) => `${a}^${e}`).join(" ");

function put(poly, m, c) {
  const key = keyOf(m);
  const old = poly.get(key);
  const sum = old ? old.c.add(c) : c;
  if (sum.sign) poly.set(key, { m, c: sum });
  else poly.delete(key);
}

const constant = (r) => (r.sign ? new Map([["", { m: [], c: r }]]) : new Map());

function plus(a, b) {
  const found = new Map(a);
  spend(a.size + b.size);
  for (const { m, c } of b.values()) put(found, m, c);
  return found;
}

function timesMonomial(m, n) {
  const found = [];
  let [i, j] = [0, 0];
  while (i < m.length || j < n.length) {
    if (j === n.length || (i < m.length && m[i][0] < n[j][0])) found.push(m[i++]);
    else if (i === m.length || n[j][0] < m[i][0]) found.push(n[j++]);
    else found.push([m[i][0], m[i++][1] + n[j++][1]]);
  }
  return found;
}

function times(a, b) {
  spend(a.size * b.size);
  const found = new Map();
  for (const p of a.values()) for (const q of b.values()) put(found, timesMonomial(p.m, q.m), p.c.mul(q.c));
  return found;
}

const polyKey = (p) => [...p.entries()].sort(([a], [b]) => (a < b ? -1 : 1)).map(([k, t]) => `${t.c}*${k}`).join("+");

/** The polynomial with the relations of its atoms used; roots of quotients multiply by denominators (see `clear`). */
function reducible(m) {
  return m.findIndex(([a, e]) => {
    const { rule } = ATOMS[a];
    return rule && e >= (rule.kind === "sine" ? 2 : rule.order);
  });
}

/** Uses s^2 = 1 - c^2 and r^k = u as long as they apply: a quotient. */
function reduce(p) {
  spend(p.size);
  let whole = new Map();
  let rest = null;
  for (const { m, c } of p.values()) {
    const i = reducible(m);
    if (i < 0) {
      put(whole, m, c);
      continue;
    }
    const [a, e] = m[i];
    const { rule } = ATOMS[a];
    const k = rule.kind === "sine" ? 2 : rule.order;
    const left = m.flatMap(([b, f], j) => (j !== i ? [[b, f]] : f > k ? [[b, f - k]] : []));
    const value = rule.kind === "sine" ? fraction(plus(constant(R1), new Map([[keyOf([[rule.cosine, 2]]), { m: [[rule.cosine, 2]], c: R1.neg() }]]))) : rule.value;
    const part = mulF(fraction(new Map([[keyOf(left), { m: left, c }]])), value);
    rest = rest ? addF(rest, part) : part;
  }
  if (!rest) return fraction(whole);
  return addF(fraction(whole), rest.den.size || [...rest.num.values()].some(({ m }) => reducible(m) >= 0) ? reduceF(rest) : rest);
}

// -- quotients: a numerator, and the factors of the denominator with their exponents -----------------

const fraction = (num, den = new Map()) => ({ num, den });
const ZERO = () => fraction(new Map());

function expand(den, without = new Map()) {
  let found = constant(R1);
  for (const [key, { p, e }] of den) {
    for (let k = without.get(key)?.e ?? 0; k < e; k += 1) found = times(found, p);
  }
  return found;
}

function addF(a, b) {
  if (!a.num.size) return b;
  if (!b.num.size) return a;
  if (!a.den.size && !b.den.size) return fraction(plus(a.num, b.num));
  const den = new Map(a.den);
  for (const [key, { p, e }] of b.den) den.set(key, { p, e: Math.max(e, den.get(key)?.e ?? 0) });
  return fraction(plus(times(a.num, expand(den, a.den)), times(b.num, expand(den, b.den))), den);
}

function mulF(a, b) {
  const den = new Map(a.den);
  for (const [key, { p, e }] of b.den) den.set(key, { p, e: e + (den.get(key)?.e ?? 0) });
  return fraction(times(a.num, b.num), den);
}

function reduceF(a) {
  const top = reduce(a.num);
  return mulF(top, fraction(constant(R1), a.den));
}

const mulR = (a, b) => reduceF(mulF(a, b));
const one = () => fraction(constant(R1));
const scalar = (r) => fraction(constant(r));

function inverseF(a) {
  refuse(!a.num.size, "a denominator is 0");
  const top = expand(a.den);
  if (a.num.size === 1) {
    const [{ m, c }] = a.num.values();
    let den = new Map();
    for (const [i, e] of m) {
      const p = new Map([[keyOf([[i, 1]]), { m: [[i, 1]], c: R1 }]]);
      den.set(polyKey(p), { p, e });
    }
    return reduceF(fraction(times(top, constant(R1.div(c))), den));
  }
  const [lead] = [...a.num.entries()].sort(([x], [y]) => (x < y ? -1 : 1));
  const c = lead[1].c;
  const monic = times(a.num, constant(R1.div(c)));
  return fraction(times(top, constant(R1.div(c))), new Map([[polyKey(monic), { p: monic, e: 1 }]]));
}

function powF(a, k) {
  if (Math.abs(k) > LONGEST) throw new NotCovered("a power is too large");
  if (k < 0) return powF(inverseF(a), -k);
  let found = one();
  for (let i = 0; i < k; i += 1) found = mulR(found, a);
  return found;
}

const fromAtom = (i, e = 1) => fraction(new Map([[keyOf([[i, e]]), { m: [[i, e]], c: R1 }]]));
const asNumber = (f) => (f.den.size || f.num.size > 1 ? null : f.num.size ? (f.num.has("") ? f.num.get("").c : null) : R0);
const keyF = (f) => `${polyKey(f.num)}|${[...f.den].map(([k, { e }]) => `${k}^${e}`).sort().join("&")}`;

// -- functions -------------------------------------------------------------------------------------

/** The parts of an argument: [coefficient, the key of the monomial it multiplies]; null where it is a quotient. */
const partsOf = (f) => (f.den.size ? null : [...f.num.values()].map(({ m, c }) => [c, m]));
const monomial = (m, c = R1) => fraction(new Map([[keyOf(m), { m, c }]]));

/** [sin, cos] of c pi for multiples of pi/12 that are known. */
function knownAngle(c) {
  const twelfths = c.mul(Rational.of(12));
  if (!twelfths.whole) return null;
  const n = Number(((twelfths.n % 24n) + 24n) % 24n);
  const r = (value) => mulR(scalar(Rational.of(1, 2)), rootOf(scalar(Rational.of(value)), 2));
  const first = { 0: ZERO(), 2: scalar(Rational.of(1, 2)), 3: r(2), 4: r(3), 6: one() };
  const sine = (k) => {
    const q = ((k % 24) + 24) % 24;
    if (q > 12) return (v => v && mulF(scalar(R1.neg()), v))(sine(q - 12));
    return first[q <= 6 ? q : 12 - q];
  };
  const [s, co] = [sine(n), sine(n + 6)];
  return s && co ? [s, co] : null;
}

function sinCosOne(c, m) {
  if (m.length === 1 && m[0][1] === 1 && ATOMS[m[0][0]].key === "pi") {
    const found = knownAngle(c);
    if (found) return found;
  }
  const label = `${c.d}:${m.map(([a, e]) => `${ATOMS[a].key}^${e}`).join("*")}`;
  const cosine = atom(`cos ${label}`);
  const sine = atom(`sin ${label}`, { kind: "sine", cosine });
  const [s1, c1] = [fromAtom(sine), fromAtom(cosine)];
  let [s, co] = [ZERO(), one()];
  const k = c.n < 0n ? -c.n : c.n;
  if (k > 40n) throw new NotCovered("a multiple of an angle is too large");
  for (let i = 0n; i < k; i += 1n) {
    [s, co] = [addF(mulR(s, c1), mulR(co, s1)), addF(mulR(co, c1), mulF(scalar(R1.neg()), mulR(s, s1)))].map(reduceF);
  }
  return c.n < 0n ? [mulF(scalar(R1.neg()), s), co] : [s, co];
}

function sinCos(f) {
  const parts = partsOf(f);
  if (!parts) {
    const negative = [...f.num.entries()].sort(([a], [b]) => (a < b ? -1 : 1))[0]?.[1].c.sign < 0;
    const g = negative ? mulF(scalar(R1.neg()), f) : f;
    const cosine = atom(`cos(${keyF(g)})`);
    const s = fromAtom(atom(`sin(${keyF(g)})`, { kind: "sine", cosine }));
    return [negative ? mulF(scalar(R1.neg()), s) : s, fromAtom(cosine)];
  }
  let [s, c] = [ZERO(), one()];
  for (const [k, m] of parts) {
    const [s2, c2] = sinCosOne(k, m);
    [s, c] = [addF(mulR(s, c2), mulR(c, s2)), addF(mulR(c, c2), mulF(scalar(R1.neg()), mulR(s, s2)))].map(reduceF);
  }
  return [s, c];
}

function expOf(f) {
  const parts = partsOf(f);
  if (!parts) return fromAtom(atom(`exp(${keyF(f)})`));
  let found = one();
  for (const [c, m] of parts) {
    const k = Number(c.n);
    if (Math.abs(k) > 64) throw new NotCovered("an exponent is too large");
    found = mulR(found, powF(fromAtom(atom(`exp ${c.d}:${m.map(([a, e]) => `${ATOMS[a].key}^${e}`).join("*")}`)), k));
  }
  return found;
}

/** The root of order k of a value that is positive where it is used. */
function rootOf(f, k) {
  const value = asNumber(f);
  if (value) {
    refuse(value.sign < 0, "a root of a negative number");
    if (!value.sign) return ZERO();
    let found = one();
    for (const [n, sign] of [[value.n, 1], [value.d, -1]]) {
      let left = n;
      for (let p = 2n; p * p <= left && p < 5000n; p += 1n) {
        let e = 0;
        while (left % p === 0n) {
          left /= p;
          e += 1;
        }
        if (e) found = mulR(found, powF(primeRoot(p, k), sign * e));
      }
      if (left > 1n) found = mulR(found, powF(primeRoot(left, k), sign));
    }
    return found;
  }
  if (!f.den.size) {
    // the content, so that the root of 4 x is twice that of x
    let [g, l] = [0n, 1n];
    const big = (a, b) => (b ? big(b, a % b) : a < 0n ? -a : a);
    for (const { c } of f.num.values()) [g, l] = [big(g, c.n), (l / big(l, c.d)) * c.d];
    const content = Rational.of(g, l);
    if (!content.eq(R1)) return mulR(rootOf(scalar(content), k), rootOf(mulF(f, scalar(R1.div(content))), k));
  }
  return fromAtom(atom(`root ${k}(${keyF(f)})`, { kind: "root", order: k, value: f }));
}

const primeRoot = (p, k) => {
  const root = Math.round(Number(p) ** (1 / k));
  if (BigInt(root) ** BigInt(k) === p) return scalar(Rational.of(root));
  return fromAtom(atom(`root ${k}(${p})`, { kind: "root", order: k, value: scalar(Rational.of(p)) }));
};

function callOf(name, args) {
  const [f] = args;
  const halfOf = (a, b) => mulR(scalar(Rational.of(1, 2)), addF(a, b));
  const minus = (a) => mulF(scalar(R1.neg()), a);
  switch (name) {
    case "sin":
      return sinCos(f)[0];
    case "cos":
      return sinCos(f)[1];
    case "tan":
      return mulR(sinCos(f)[0], inverseF(sinCos(f)[1]));
    case "cot":
      return mulR(sinCos(f)[1], inverseF(sinCos(f)[0]));
    case "sec":
      return inverseF(sinCos(f)[1]);
    case "csc":
      return inverseF(sinCos(f)[0]);
    case "exp":
      return expOf(f);
    case "sinh":
      return halfOf(expOf(f), minus(expOf(minus(f))));
    case "cosh":
      return halfOf(expOf(f), expOf(minus(f)));
    case "tanh":
      return mulR(callOf("sinh", args), inverseF(callOf("cosh", args)));
    case "sqrt":
      return rootOf(f, 2);
    case "abs": {
      const value = asNumber(f);
      if (value) return scalar(value.sign < 0 ? value.neg() : value);
      return fromAtom(atom(`abs(${keyF(f)})`, { kind: "root", order: 2, value: mulR(f, f) }));
    }
    default: {
      const zero = args.every((a) => a.num.size === 0);
      if (zero && ["asin", "atan"].includes(name)) return ZERO();
      if (name === "atan2" && !args[0].num.size && (asNumber(args[1])?.sign ?? 0) > 0) return ZERO();
      if (name === "log" && asNumber(f)?.eq(R1)) return ZERO();
      return fromAtom(atom(`${name}(${args.map(keyF).join(",")})`));
    }
  }
}

/** The normal form of a tree. */
export function normal(tree) {
  const hit = MEMO.get(tree);
  if (hit) return hit;
  const args = tree.head === "power" ? [] : tree.args.map(normal);
  let found;
  if (tree.head === "number") found = scalar(tree.value);
  else if (tree.head === "pi") found = fromAtom(atom("pi"));
  else if (tree.head === "symbol") found = fromAtom(atom(`symbol ${tree.value}`));
  else if (tree.head === "sum") found = args.reduce(addF);
  else if (tree.head === "product") found = args.reduce(mulR);
  else if (tree.head === "call") found = callOf(tree.value, args);
  else if (tree.head === "apply") found = fromAtom(atom(`apply ${tree.value.name} ${tree.value.orders} ${args.map(keyF).join(",")}`));
  else {
    const [base, e] = tree.args;
    const k = e.head === "number" ? e.value : null;
    if (k && k.whole) found = powF(normal(base), Number(k.n));
    else if (k) found = powF(rootOf(normal(base), Number(k.d)), Number(k.n));
    else found = fromAtom(atom(`power ${keyF(normal(base))} ${keyF(normal(e))}`));
  }
  MEMO.set(tree, found);
  return found;
}

// -- tests -----------------------------------------------------------------------------------------

/** An arbitrary smooth function in the place of a declared one, to tell what is not 0. */
function arbitrary(tree) {
  const choices = new Map();
  const orders = (t) => {
    if (t.head === "apply") {
      const names = t.args.map((_, i) => `arbitrary${i}`);
      const lone = names.map((n, i) => tr.mul(tr.number(i + 2), tr.symbol(n)));
      const sum = tr.add(tr.number(1), ...lone);
      choices.set(t.value.name, [names, tr.add(sum, tr.mul(tr.number(Rational.of(1, 7)), tr.pow(sum, 7)))]);
    }
    t.args.forEach(orders);
  };
  if (tree.functions.size) orders(tree);
  return tr.substitute(tree, new Map(), choices);
}

/** Whether a tree is 0 identically: true by its normal form, false by a value; neither is not covered. */
export function isZero(tree) {
  if (tr.isNumber(tree)) return !tree.value.sign;
  let late = null;
  try {
    if (reduceF(normal(tree)).num.size === 0) return true;
  } catch (error) {
    if (!(error instanceof NotCovered) && !(error instanceof Refused)) throw error;
    late = error;
  }
  const concrete = arbitrary(tree);
  for (let k = 1; k <= 4; k += 1) {
    const values = new Map([...concrete.symbols].sort().map((s, i) => [s, Interval.of(Rational.of(((i * 37 + k * 29) % 41) + 7, 23 + k))]));
    try {
      if (tr.evaluate(concrete, values).nonzero) return false;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
    }
  }
  throw late instanceof NotCovered ? late : new NotCovered("this checker cannot decide an identity");
}

/** The rational number that a tree without symbols is, or null. */
export function rational(tree) {
  return asNumber(reduceF(normal(tree)));
}
