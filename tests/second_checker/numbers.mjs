// Exact rationals (pairs of BigInt) and intervals with fixed-point ends, rounded outwards.

/** The answer of a check that fails. */
export class Refused extends Error {}
/** The answer where this checker has no rule, or cannot decide. */
export class NotCovered extends Error {}

export function refuse(condition, why) {
  if (condition) throw new Refused(why);
}

const abs = (a) => (a < 0n ? -a : a);

function gcd(a, b) {
  a = abs(a);
  b = abs(b);
  while (b) [a, b] = [b, a % b];
  return a;
}

export class Rational {
  constructor(n, d = 1n) {
    this.n = n;
    this.d = d;
  }

  static of(n, d = 1n) {
    n = BigInt(n);
    d = BigInt(d);
    refuse(d === 0n, "division by zero");
    if (d < 0n) [n, d] = [-n, -d];
    if (d !== 1n) {
      const g = gcd(n, d);
      if (g !== 1n) [n, d] = [n / g, d / g];
    }
    return new Rational(n, d);
  }

  /** A decimal such as `0.25` or `1e-30`. */
  static decimal(text) {
    const match = /^([-+]?)(\d*)\.?(\d*)(?:[eE]([-+]?\d+))?$/.exec(text);
    refuse(!match || !(match[2] + match[3]), `${text} is not a number`);
    const shift = Number(match[4] ?? 0) - match[3].length;
    const digits = BigInt(match[1] + match[2] + match[3]);
    return shift >= 0 ? Rational.of(digits * 10n ** BigInt(shift)) : Rational.of(digits, 10n ** BigInt(-shift));
  }

  add(o) {
    return this.d === 1n && o.d === 1n ? new Rational(this.n + o.n) : Rational.of(this.n * o.d + o.n * this.d, this.d * o.d);
  }

  sub(o) {
    return this.add(o.neg());
  }

  mul(o) {
    return this.d === 1n && o.d === 1n ? new Rational(this.n * o.n) : Rational.of(this.n * o.n, this.d * o.d);
  }

  div(o) {
    return Rational.of(this.n * o.d, this.d * o.n);
  }

  neg() {
    return new Rational(-this.n, this.d);
  }

  pow(k) {
    const e = BigInt(Math.abs(k));
    const bits = Math.max(this.n.toString(16).length, this.d.toString(16).length) * 4 * Math.abs(k);
    if (bits > 100000 && abs(this.n) + this.d > 2n) throw new NotCovered("a number is too large");
    return k >= 0 ? new Rational(this.n ** e, this.d ** e) : Rational.of(this.d ** e, this.n ** e);
  }

  eq(o) {
    return this.n === o.n && this.d === o.d;
  }

  get sign() {
    return this.n > 0n ? 1 : this.n < 0n ? -1 : 0;
  }

  get whole() {
    return this.d === 1n;
  }

  toString() {
    return this.d === 1n ? `${this.n}` : `${this.n}/${this.d}`;
  }
}

export const R0 = new Rational(0n);
export const R1 = new Rational(1n);

// -- intervals: both ends are multiples of 2^-BITS -------------------------------------------------

const BITS = 320n;
/** The largest power that is worked out. */
export const LONGEST = 5000;
const UNIT = 1n << BITS;
const LIMIT = 1n << 4000n;

const floorDiv = (a, b) => {
  const q = a / b;
  return a % b !== 0n && a < 0n !== b < 0n ? q - 1n : q;
};
const ceilDiv = (a, b) => -floorDiv(-a, b);
const down = (a) => a >> BITS;
const up = (a) => -(-a >> BITS);
const min = (...all) => all.reduce((a, b) => (b < a ? b : a));
const max = (...all) => all.reduce((a, b) => (b > a ? b : a));

function isqrt(n) {
  if (n < 2n) return n;
  let x = 1n << BigInt((n.toString(2).length + 1) >> 1);
  for (;;) {
    const y = (x + n / x) >> 1n;
    if (y >= x) return x;
    x = y;
  }
}

export class Interval {
  constructor(lo, hi) {
    refuse(lo < -LIMIT || hi > LIMIT, "a value is too large");
    this.lo = lo;
    this.hi = hi;
  }

  static of(r) {
    return new Interval(floorDiv(r.n * UNIT, r.d), ceilDiv(r.n * UNIT, r.d));
  }

  /** The interval [r - e, r + e]. */
  static around(r, e) {
    return new Interval(Interval.of(r.sub(e)).lo, Interval.of(r.add(e)).hi);
  }

  add(o) {
    return new Interval(this.lo + o.lo, this.hi + o.hi);
  }

  neg() {
    return new Interval(-this.hi, -this.lo);
  }

  sub(o) {
    return new Interval(this.lo - o.hi, this.hi - o.lo);
  }

  mul(o) {
    const all = [this.lo * o.lo, this.lo * o.hi, this.hi * o.lo, this.hi * o.hi];
    return new Interval(down(min(...all)), up(max(...all)));
  }

  inverse() {
    refuse(!this.nonzero, "a value is not finite at the point");
    return new Interval(floorDiv(UNIT * UNIT, this.hi), ceilDiv(UNIT * UNIT, this.lo));
  }

  pow(k) {
    if (k < 0) return this.pow(-k).inverse();
    if (k === 0) return ONE;
    if (k % 2 === 0 && !this.nonzero) {
      const m = max(abs(this.lo), abs(this.hi));
      return new Interval(0n, new Interval(m, m).repeated(k).hi);
    }
    return this.repeated(k);
  }

  repeated(k) {
    if (k > LONGEST) throw new NotCovered("a power is too large");
    let found = this;
    for (let i = 1; i < k; i += 1) found = found.mul(this);
    return found;
  }

  /** The middle, rounded down, and what is left on either side. */
  get middle() {
    return (this.lo + this.hi) >> 1n;
  }

  get radius() {
    return this.hi - this.middle;
  }

  widened(by) {
    return new Interval(this.lo - by, this.hi + by);
  }

  sqrt() {
    refuse(this.lo <= 0n, "a root is not smooth at the point");
    return new Interval(isqrt(this.lo << BITS), isqrt(this.hi << BITS) + 1n);
  }

  get nonzero() {
    return this.lo > 0n || this.hi < 0n;
  }

  get positive() {
    return this.lo > 0n;
  }

  contains(o) {
    return this.lo < o.lo && o.hi < this.hi;
  }
}

export const ZERO = new Interval(0n, 0n);
export const ONE = new Interval(UNIT, UNIT);

// Elementary functions at one fixed-point number: a value and a bound of its error, by Taylor series with guard bits.

const GUARD = 64n;
const FINE = BITS + GUARD;
const F1 = 1n << FINE;
const ERROR = 1n << 8n;

const fmul = (a, b) => (a * b) >> FINE;

/** atan of x with |x| at most a half. */
function atanSmall(x) {
  const square = fmul(x, x);
  let term = x;
  let sum = 0n;
  for (let k = 1n; term !== 0n && term !== -1n; k += 2n) {
    sum += (k % 4n === 1n ? term : -term) / k;
    term = fmul(term, square);
  }
  return sum;
}

const PI_FINE = 4n * (4n * atanSmall(F1 / 5n) - atanSmall(F1 / 239n));

/** sin and cos of x. */
function sinCosFine(x) {
  const turns = floorDiv(2n * x + PI_FINE, 2n * PI_FINE);
  refuse(abs(turns) > 1n << 40n, "an angle is too large");
  const y = x - turns * PI_FINE;
  const square = fmul(y, y);
  let [s, c] = [0n, 0n];
  let [ts, tc] = [y, F1];
  for (let k = 1n; ts !== 0n || tc !== 0n; k += 2n) {
    s += ts;
    c += tc;
    tc = -fmul(tc, square) / (k * (k + 1n));
    ts = -fmul(ts, square) / ((k + 1n) * (k + 2n));
    if (abs(ts) <= 1n && abs(tc) <= 1n) break;
  }
  return turns % 2n ? [-s, -c] : [s, c];
}

function expFine(x) {
  const halvings = 16n;
  const y = x >> halvings;
  let [sum, term] = [0n, F1];
  for (let k = 1n; abs(term) > 1n; k += 1n) {
    sum += term;
    term = fmul(term, y) / k;
  }
  for (let i = 0n; i < halvings; i += 1n) sum = fmul(sum, sum);
  return sum;
}

/** A value at FINE bits with an error of `error` fine units, as an interval. */
const coarse = (value, error) => new Interval((value - error) >> GUARD, -(-(value + error) >> GUARD));
const fine = (value) => value << GUARD;

export const PI = coarse(PI_FINE, ERROR);

const bounded = (interval) => {
  const one = UNIT;
  return new Interval(max(interval.lo, -one), min(interval.hi, one));
};

export function sin(a) {
  return bounded(coarse(sinCosFine(fine(a.middle))[0], 1n << 50n).widened(a.radius + 1n));
}

export function cos(a) {
  return bounded(coarse(sinCosFine(fine(a.middle))[1], 1n << 50n).widened(a.radius + 1n));
}

export function exp(a) {
  refuse(a.hi > 60n * UNIT || a.lo < -60n * UNIT, "an exponent is too large");
  const at = (x, error) => coarse(expFine(fine(x)), error);
  // 60 is below 2^6: the error of the squarings is below e^60 2^20 of the finest units
  const lo = at(a.lo, 1n << 50n).lo;
  return new Interval(max(lo - (1n << 80n), 1n), at(a.hi, 1n << 50n).hi + (1n << 80n));
}

/** The inverse of an increasing function, by bisection on its certified values. */
function inverted(f, x, lo, hi) {
  for (let i = 0n; hi - lo > 1n << 100n && i < 600n; i += 1n) {
    const m = (lo + hi) >> 1n;
    const value = f(new Interval(m, m));
    if (value.hi < x) lo = m;
    else if (value.lo > x) hi = m;
    else return new Interval(m - (1n << 160n), m + (1n << 160n));
  }
  return new Interval(lo, hi);
}

export function log(a) {
  refuse(a.lo <= 0n, "a logarithm has no value at the point");
  const one = (x) => inverted(exp, x, -50n * UNIT, 50n * UNIT);
  refuse(a.lo < UNIT >> 60n || a.hi > UNIT << 60n, "a value is too large");
  return new Interval(one(a.lo).lo, one(a.hi).hi);
}

function atanPoint(x) {
  if (abs(x) > UNIT) {
    const inner = atanPoint((UNIT * UNIT) / x).widened(4n);
    const half = new Interval(PI.lo >> 1n, (PI.hi >> 1n) + 1n);
    return (x > 0n ? half : half.neg()).sub(inner);
  }
  // atan x = 2 atan(x / (1 + sqrt(1 + x^2))), which is below a half
  const y = fine(x);
  const root = isqrt((F1 + fmul(y, y)) << FINE);
  return coarse(2n * atanSmall((y << FINE) / (F1 + root)), 1n << 40n);
}

export function atan(a) {
  return new Interval(atanPoint(a.lo).lo, atanPoint(a.hi).hi);
}

export function atan2(y, x) {
  if (x.positive) return atan(y.mul(x.inverse()));
  refuse(!y.nonzero, "an angle jumps or has no value at the point");
  const half = new Interval(PI.lo >> 1n, (PI.hi >> 1n) + 1n);
  return (y.positive ? half : half.neg()).sub(atan(x.mul(y.inverse())));
}

export { BITS, UNIT };
