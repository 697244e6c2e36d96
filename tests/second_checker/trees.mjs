// Expressions as trees: built, differentiated, substituted in, and evaluated in intervals as they are written.

import * as num from "./numbers.mjs";
import { Interval, NotCovered, R0, R1, Rational, refuse } from "./numbers.mjs";

const TREES = new Map();
let size = 0;
const LARGEST = 4000000;

/** heads: number, symbol, pi, sum, product, power, call (a built-in function), apply (a declared one). */
export class Tree {
  constructor(head, value, args, key) {
    this.head = head;
    this.value = value;
    this.args = args;
    this.key = key;
    this.symbols = new Set(head === "symbol" ? [value] : args.flatMap((a) => [...a.symbols]));
    this.functions = new Set([...(head === "apply" ? [value.name] : []), ...args.flatMap((a) => [...a.functions])]);
    this.memo = new Map();
  }

  has(name) {
    return this.symbols.has(name);
  }

  hasAny(names) {
    for (const name of this.symbols) if (names.has(name)) return true;
    return false;
  }
}

function make(head, value, args = []) {
  const label = head === "apply" ? `${value.name}'${value.orders}` : `${value}`;
  const key = args.length ? `${head[0]}${head[1]}(${label};${args.map((a) => a.id).join(",")})` : `${head}:${label}`;
  let found = TREES.get(key);
  if (!found) {
    size += 1 + args.length;
    if (size > LARGEST) throw new NotCovered("too many expressions");
    found = new Tree(head, value, args, key);
    found.id = TREES.size;
    TREES.set(key, found);
  }
  return found;
}

/** Forgets all expressions. */
export function reset() {
  TREES.clear();
  size = 0;
}

export const number = (value) => make("number", value instanceof Rational ? value : Rational.of(value));
export const symbol = (name) => make("symbol", name);
export const pi = () => make("pi", "pi");
export const apply = (name, orders, args) => make("apply", { name, orders }, args);
export const isNumber = (t, value) => t.head === "number" && (value === undefined || t.value.eq(Rational.of(value)));

export function add(...terms) {
  const rest = [];
  let constant = R0;
  for (const t of terms) {
    if (t.head === "number") constant = constant.add(t.value);
    else if (t.head === "sum") {
      for (const a of t.args) {
        if (a.head === "number") constant = constant.add(a.value);
        else rest.push(a);
      }
    } else rest.push(t);
  }
  if (constant.sign) rest.push(number(constant));
  return rest.length === 0 ? number(0) : rest.length === 1 ? rest[0] : make("sum", "+", rest);
}

export function mul(...factors) {
  const rest = [];
  let constant = R1;
  for (const t of factors) {
    if (t.head === "number") constant = constant.mul(t.value);
    else if (t.head === "product") {
      for (const a of t.args) {
        if (a.head === "number") constant = constant.mul(a.value);
        else rest.push(a);
      }
    } else rest.push(t);
  }
  if (!constant.sign) return number(0);
  if (!constant.eq(R1)) rest.unshift(number(constant));
  return rest.length === 0 ? number(1) : rest.length === 1 ? rest[0] : make("product", "*", rest);
}

export const neg = (a) => mul(number(-1), a);
export const sub = (a, b) => add(a, neg(b));

export function pow(base, exponent) {
  const e = typeof exponent === "number" ? number(exponent) : exponent;
  if (e.head === "number") {
    if (e.value.eq(R1)) return base;
    if (!e.value.sign) return number(1);
    if (base.head === "number" && e.value.whole) return number(base.value.pow(Number(e.value.n)));
    if (base.head === "power" && e.value.whole && base.args[1].head === "number" && base.args[1].value.whole) {
      return pow(base.args[0], number(base.args[1].value.mul(e.value)));
    }
  }
  return make("power", "^", [base, e]);
}

export const inverse = (a) => pow(a, -1);
export const call = (name, ...args) => make("call", name, args);

/** Rebuild a tree with other arguments. */
function rebuilt(tree, args) {
  if (tree.head === "sum") return add(...args);
  if (tree.head === "product") return mul(...args);
  if (tree.head === "power") return pow(...args);
  return tree.head === "call" ? call(tree.value, ...args) : apply(tree.value.name, tree.value.orders, args);
}

/** What is made of a tree from what is made of its arguments, of each node once; `done` remembers it. */
function folded(tree, make, done) {
  if (!done.has(tree)) done.set(tree, make(tree, tree.args.map((a) => folded(a, make, done))));
  return done.get(tree);
}

/** The tree with trees in the place of symbols; `functions`: name to [arguments, tree]. */
export function substitute(tree, values, functions = new Map()) {
  return folded(tree, (node, args) => {
    if (node.head === "symbol") return values.get(node.value) ?? node;
    if (node.head !== "apply" || !functions.has(node.value.name)) {
      return args.some((a, i) => a !== node.args[i]) ? rebuilt(node, args) : node;
    }
    const [names, body] = functions.get(node.value.name);
    refuse(names.length !== args.length, "a function has another number of arguments");
    let text = body;
    node.value.orders.forEach((order, i) => {
      for (let k = 0; k < order; k += 1) text = derivative(text, names[i]);
    });
    return substitute(text, new Map(names.map((n, i) => [n, args[i]])));
  }, new Map());
}

const two = () => number(2);

/** The derivative of a built-in function by its argument (by each, for atan2). */
function slopes(tree) {
  const [a, b] = tree.args;
  const squared = pow(a, 2);
  const root = (u) => pow(call("sqrt", u), -1);
  const table = {
    sin: () => call("cos", a),
    cos: () => neg(call("sin", a)),
    tan: () => add(number(1), pow(tree, 2)),
    cot: () => neg(add(number(1), pow(tree, 2))),
    sec: () => mul(tree, call("tan", a)),
    csc: () => neg(mul(tree, call("cot", a))),
    asin: () => root(sub(number(1), squared)),
    acos: () => neg(root(sub(number(1), squared))),
    atan: () => inverse(add(number(1), squared)),
    sinh: () => call("cosh", a),
    cosh: () => call("sinh", a),
    tanh: () => sub(number(1), pow(tree, 2)),
    exp: () => tree,
    log: () => inverse(a),
    sqrt: () => inverse(mul(two(), tree)),
    abs: () => mul(tree, inverse(a)),
  };
  if (tree.value === "atan2") {
    const under = inverse(add(squared, pow(b, 2)));
    return [mul(b, under), neg(mul(a, under))];
  }
  return [table[tree.value]()];
}

export function derivative(tree, name) {
  if (!tree.has(name)) return number(0);
  const hit = tree.memo.get(name);
  if (hit) return hit;
  let found;
  const { args } = tree;
  if (tree.head === "symbol") found = number(1);
  else if (tree.head === "sum") found = add(...args.map((a) => derivative(a, name)));
  else if (tree.head === "product") {
    found = add(...args.map((a, i) => mul(...args.slice(0, i), derivative(a, name), ...args.slice(i + 1))));
  } else if (tree.head === "power") {
    const [base, e] = args;
    if (!e.has(name)) found = mul(e, pow(base, sub(e, number(1))), derivative(base, name));
    else found = mul(tree, add(mul(derivative(e, name), call("log", base)), mul(e, derivative(base, name), inverse(base))));
  } else if (tree.head === "call") {
    found = add(...slopes(tree).map((s, i) => mul(s, derivative(args[i], name))));
  } else {
    const { orders } = tree.value;
    const raised = (i) => apply(tree.value.name, orders.map((o, k) => o + (k === i ? 1 : 0)), args);
    found = add(...args.map((a, i) => mul(raised(i), derivative(a, name))));
  }
  tree.memo.set(name, found);
  return found;
}

const one = num.ONE;
const quotient = (a, b) => a.mul(b.inverse());
const half = Interval.of(Rational.of(1, 2));

/** Values of the built-in functions, each where it is smooth. */
const VALUES = {
  sin: num.sin,
  cos: num.cos,
  tan: (a) => quotient(num.sin(a), num.cos(a)),
  cot: (a) => quotient(num.cos(a), num.sin(a)),
  sec: (a) => num.cos(a).inverse(),
  csc: (a) => num.sin(a).inverse(),
  asin: (a) => num.atan(quotient(a, one.sub(a.pow(2)).sqrt())),
  acos: (a) => num.atan2(one.sub(a.pow(2)).sqrt(), a),
  atan: num.atan,
  atan2: num.atan2,
  sinh: (a) => num.exp(a).sub(num.exp(a.neg())).mul(half),
  cosh: (a) => num.exp(a).add(num.exp(a.neg())).mul(half),
  tanh: (a) => quotient(num.exp(a).sub(num.exp(a.neg())), num.exp(a).add(num.exp(a.neg()))),
  exp: num.exp,
  log: num.log,
  sqrt: (a) => a.sqrt(),
  abs: (a) => {
    refuse(!a.nonzero, "an absolute value is not smooth at the point");
    return a.positive ? a : a.neg();
  },
};

/** The interval of a tree, where every part of it, as written, has a value and is smooth around. */
export function evaluate(tree, values, done = new Map()) {
  return folded(tree, (node, below) => valueOf(node, values, below), done);
}

function valueOf(node, values, below) {
  const [base, exponent] = below;
  const e = node.head === "power" ? node.args[1] : null;
  switch (node.head) {
    case "number":
      return Interval.of(node.value);
    case "pi":
      return num.PI;
    case "symbol":
      refuse(!values.has(node.value), `there is no value of ${node.value}`);
      return values.get(node.value);
    case "sum":
      return below.reduce((a, b) => a.add(b));
    case "product":
      return below.reduce((a, b) => a.mul(b));
    case "power":
      if (e.head === "number" && e.value.whole) return base.pow(Number(e.value.n));
      if (e.head === "number" && e.value.d === 2n) return base.sqrt().pow(Number(e.value.n));
      refuse(!base.positive, "a power is not smooth at the point");
      return num.exp(exponent.mul(num.log(base)));
    case "call":
      return VALUES[node.value](...below);
    default:
      return refuse(true, `nothing is chosen for the function ${node.value.name}`);
  }
}

/** The slopes and the rest of a tree that is linear in some symbols, by its derivatives; null where it is not. */
export function linearIn(tree, names) {
  const wanted = new Set(names);
  const slope = new Map();
  for (const name of names) {
    if (!tree.has(name)) continue;
    const d = derivative(tree, name);
    if (d.hasAny(wanted)) return null;
    slope.set(name, d);
  }
  const rest = substitute(tree, new Map(names.map((n) => [n, number(0)])));
  return { slope, rest };
}
