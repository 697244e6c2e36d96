// A scene's document: its canonical form and hash, its coordinates, and the scalar relations of every constraint.

import { createHash } from "node:crypto";
import { Rational, refuse } from "./numbers.mjs";
import { Names, parse, parseRelations, spelledOut } from "./grammar.mjs";
import { isZero } from "./ring.mjs";
import * as tr from "./trees.mjs";
import { add, call, isNumber, linearIn, mul, neg, number, pow, sub, substitute, symbol } from "./trees.mjs";

const NULLS = new Set([null, undefined, "", "~", "null", "Null", "NULL"]);
const SILENT = new Set(["name", "title", "source", "notes", "left_out", "expect", "picture"]);
const SIGNS = new Set(["real", "positive", "nonzero"]);
const ROLES = { 1: ["x"], 2: ["x", "y", "theta"], 3: ["x", "y", "z", "phi", "theta", "psi"] };
const VALUE = /^\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?)(?:\s*\/\s*([0-9]*[1-9][0-9]*))?\s*$/;
const isMapping = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
const empty = (value) => value === null || (Array.isArray(value) ? !value.length : isMapping(value) && !Object.keys(value).length);

function canonicalPart(given, key) {
  let value = given;
  if (key === "parameters" && Array.isArray(value)) value = Object.fromEntries(value.map((name) => [name, null]));
  if (isMapping(value)) {
    const found = {};
    for (const [name, part] of Object.entries(value)) {
      const missing = key === "parameters" ? "real" : null;
      const written = canonicalPart(NULLS.has(part) ? missing : part, name);
      if (!empty(written)) found[name] = written;
    }
    return found;
  }
  if (Array.isArray(value)) {
    const long = { particles: (name) => ({ name }), bodies: (name) => ({ name }), constraints: (text) => ({ type: "equation", text }) };
    const short = Object.hasOwn(long, key) ? long[key] : null;
    return value.map((one) => canonicalPart(short && typeof one === "string" ? short(one) : one, short ? "" : key));
  }
  if (typeof value === "boolean" || (key === "name" && typeof value === "string")) return value;
  if (NULLS.has(value)) return null;
  const match = String(value).length <= 400 ? VALUE.exec(String(value)) : null;
  if (!match) return value;
  const exact = Rational.decimal(match[1]).div(Rational.of(BigInt(match[2] ?? 1)));
  return exact.whole ? exact.n : exact.toString();
}

/** The document without what says nothing of the mathematics; whole numbers are BigInt. */
export function canonical(document) {
  refuse(!isMapping(document), "a scene is a mapping");
  const found = canonicalPart(document, "");
  return Object.fromEntries(
    Object.entries(found).filter(([key, part]) => !SILENT.has(key) && !(key === "dimension" && part === 3n) && !(key === "tolerance" && part === 0n)),
  );
}

function written(value) {
  if (typeof value === "bigint") return `${value}`;
  if (Array.isArray(value)) return `[${value.map(written).join(",")}]`;
  if (isMapping(value)) {
    const keys = Object.keys(value).sort((a, b) => (Buffer.compare(Buffer.from(a), Buffer.from(b))));
    return `{${keys.map((k) => `${JSON.stringify(k)}:${written(value[k])}`).join(",")}}`;
  }
  return JSON.stringify(value);
}

export const sha256Of = (document) => createHash("sha256").update(written(canonical(document)), "utf8").digest("hex");

// -- vectors ---------------------------------------------------------------------------------------

const ZERO = () => number(0);
const dot = (a, b) => add(...a.map((x, i) => mul(x, b[i])));
const less = (a, b) => a.map((x, i) => sub(x, b[i]));
const scaled = (k, a) => a.map((x) => mul(k, x));
const square = (a) => add(...a.map((x) => pow(x, 2)));
const cross = (a, b) => [[1, 2], [2, 0], [0, 1]].map(([i, j]) => sub(mul(a[i], b[j]), mul(a[j], b[i])));
const columns = (m) => m[0].map((_, j) => m.map((row) => row[j]));
const product = (a, b) => a.map((row) => columns(b).map((column) => dot(row, column)));

function length(a) {
  const only = a.filter((x) => !isNumber(x, 0));
  if (only.length === 1 && isNumber(only[0])) return number(only[0].value.sign < 0 ? only[0].value.neg() : only[0].value);
  return call("sqrt", square(a));
}

function rotation(d, i, j, angle) {
  const turned = angle && !isNumber(angle, 0);
  const [c, s] = turned ? [call("cos", angle), call("sin", angle)] : [number(1), ZERO()];
  const rows = Array.from({ length: d }, (_, k) => Array.from({ length: d }, (__, m) => number(k === m ? 1 : 0)));
  if (d > 1) [rows[i][i], rows[i][j], rows[j][i], rows[j][j]] = [c, neg(s), s, c];
  return rows;
}

const eulerTurn = ([phi, theta, psi]) => product(rotation(3, 0, 1, phi), product(rotation(3, 1, 2, theta), rotation(3, 0, 1, psi)));

function cayleyTurn(g) {
  const [x, y, z] = g;
  const kept = sub(number(1), square(g));
  const skew = [[ZERO(), neg(z), y], [z, ZERO(), neg(x)], [neg(y), x, ZERO()]];
  return g.map((_, i) => g.map((__, j) => add(i === j ? kept : ZERO(), mul(number(2), add(mul(g[i], g[j]), skew[i][j])))));
}

// -- points and bodies -----------------------------------------------------------------------------

/** A material point over / under; `start` is where it stands in the reference, or null. */
const material = (over, under, start) => ({ over, under, start });
const placeOf = (p) => scaled(tr.inverse(p.under), p.over);

function apart(a, b) {
  if (a.under === b.under) return [less(b.over, a.over), a.under];
  return [less(scaled(a.under, b.over), scaled(b.under, a.over)), mul(a.under, b.under)];
}

class Frame {
  constructor(name, d, reference, cayley) {
    const names = [...reference.keys()];
    const start = [...reference.values()];
    const ground = names.length === 0;
    const zeros = Array.from({ length: d }, ZERO);
    this.name = name;
    this.reference = reference;
    this.position = ground ? zeros : names.slice(0, d).map(symbol);
    this.start = ground ? zeros : start.slice(0, d);
    this.turning = names.slice(d).map(symbol);
    this.under = number(1);
    this.angle = ZERO();
    this.cayley = ground ? Array.from({ length: 3 }, ZERO) : null;
    this.turn = rotation(d, 0, 1);
    if (ground) return;
    if (cayley) {
      this.cayley = this.turning;
      this.turn = cayleyTurn(this.turning);
      this.under = add(number(1), square(this.turning));
    } else if (d === 2) {
      this.angle = sub(this.turning[0], start[2]);
      this.turn = rotation(2, 0, 1, this.angle);
    } else if (d === 3) this.turn = product(eulerTurn(this.turning), columns(eulerTurn(start.slice(3))));
  }

  carry(a) {
    return this.turn.map((row) => dot(row, a));
  }

  point(a) {
    const arm = less(a, this.start);
    if (arm.every((x) => isNumber(x, 0))) return material(this.position, number(1), a);
    const moved = this.carry(arm);
    return material(this.position.map((p, i) => add(mul(this.under, p), moved[i])), this.under, a);
  }

  /** How far a point is from a place of this body along a direction of it, times both denominators. */
  offset(point, place, u) {
    const now = dot(this.carry(u), less(point.over, scaled(point.under, this.position)));
    return sub(now, mul(this.under, point.under, dot(u, less(place, this.start))));
  }
}

// -- the scene -------------------------------------------------------------------------------------

function ownersOf(scene, key, roles, fields) {
  const found = new Map();
  for (const entry of scene[key] ?? []) {
    known(entry, fields);
    const names = entry.coordinates ?? roles.map((role) => `${role}_${entry.name.replaceAll("-", "_")}`);
    refuse(names.length !== roles.length || found.has(entry.name) || entry.name === "ground", `${key} cannot be read`);
    found.set(entry.name, names);
  }
  return found;
}

function known(entry, fields) {
  refuse(!isMapping(entry), "an entry is a mapping");
  const all = fields.split(" ");
  const other = Object.keys(entry).find((key) => !all.includes(key));
  refuse(other, `there is no ${other}`);
}

/** Whether a tree is a product of powers of numbers and of parameters that are not 0 (or positive). */
export function nowhereZero(tree, signs, positive = false) {
  if (tree.symbols.size === 0 && tree.functions.size === 0) {
    const value = tr.evaluate(tree, new Map());
    return positive ? value.positive : value.nonzero;
  }
  if (tree.head === "product") return tree.args.every((a) => nowhereZero(a, signs, positive));
  if (tree.head === "sum") return tree.args.every((a) => nowhereZero(a, signs, true));
  if (tree.head === "power") return nowhereZero(tree.args[0], signs, positive) && tree.args[1].symbols.size === 0;
  if (tree.head === "symbol") return signs.get(tree.value) === "positive" || (!positive && signs.get(tree.value) === "nonzero");
  return tree.head === "call" && tree.value === "exp";
}

export class Scene {
  /** Reads a document; the bodies in `cayley` are read with Cayley parameters. */
  constructor(document, cayley = []) {
    const scene = canonical(document);
    known(scene, "dimension parameters functions particles bodies coordinates constraints forces energies tolerance configuration");
    const d = Number(scene.dimension ?? 3);
    refuse(!ROLES[d], "a world has 1, 2 or 3 dimensions");
    const particles = ownersOf(scene, "particles", ROLES[d].slice(0, d), "name coordinates at mass");
    const bodies = ownersOf(scene, "bodies", ROLES[d], "name coordinates mass inertia");
    refuse(cayley.some((b) => !bodies.has(b)) || (cayley.length && d !== 3), "Cayley parameters are of bodies of space");
    const charts = new Map([...bodies].map(([b, names]) => [b, cayley.includes(b) ? [...names.slice(0, 3), ...[..."abc"].map((g) => `${b}_${g}`)] : names]));
    const others = scene.coordinates ?? [];
    const all = (owners) => [...owners.values()].flat();
    const inTexts = [...all(particles), ...all(bodies), ...others];
    this.d = d;
    this.document = scene;
    this.written = inTexts;
    this.coordinates = [...all(particles), ...all(charts), ...others];
    this.angles = new Map();
    this.signs = new Map();
    this.generic = [];
    this.counts = new Map();
    this.functions = new Map(Object.entries(scene.functions ?? {}));
    const values = new Map();
    for (const [name, value] of Object.entries(scene.parameters ?? {})) {
      if (SIGNS.has(value)) this.signs.set(name, value);
      values.set(name, SIGNS.has(value) ? symbol(name) : this.expression(value, [], new Names(new Set(), values)));
    }
    this.values = values;
    const taken = [...inTexts, ...values.keys(), ...this.functions.keys()].map(spelledOut);
    refuse(new Set(taken).size < taken.length, "a name is taken");
    const plain = new Names(new Set(), values);
    const given = new Map(Object.entries(scene.configuration ?? {}).map(([q, v]) => [q, this.expression(v, [], plain)]));
    refuse([...given.keys()].some((q) => !inTexts.includes(q)), "the configuration mentions what is no coordinate");
    this.names = new Names(new Set(inTexts.filter((q) => this.coordinates.includes(q))), values, this.functions);
    this.frames = new Map([["ground", new Frame("ground", d, new Map(), false)]]);
    this.drawn = new Set(["ground"]);
    this.points = new Map();
    const at = new Map((scene.particles ?? []).filter((p) => "at" in p).map((p) => [p.name, this.vector(p.at)]));
    for (const [name, chart] of particles) {
      const drawn = chart.every((q) => given.has(q)) ? chart.map((q) => given.get(q)) : null;
      this.points.set(name, material(chart.map(symbol), number(1), at.get(name) ?? drawn));
    }
    for (const [name, chart] of charts) {
      this.frames.set(name, new Frame(name, d, new Map(chart.map((q) => [q, given.get(q) ?? ZERO()])), cayley.includes(name)));
      if (bodies.get(name).some((q) => given.has(q))) this.drawn.add(name);
      const angles = bodies.get(name).slice(3);
      const straight = angles.every((q) => !given.has(q) || isZero(given.get(q)));
      if (cayley.includes(name) && straight) this.angles.set(name, angles);
    }
    this.turns = d === 3 ? [...charts.keys()].filter((b) => !cayley.includes(b)).map((b) => charts.get(b).slice(3)) : [];
    this.rates = new Set([...this.coordinates.map((q) => `${q}dot`), "tdot"]);
    this.unread = [];
    this.relations = this.readConstraints(scene.constraints ?? []);
    this.byId = new Map(this.relations.map((r) => [r.id, r]));
    refuse(this.byId.size < this.relations.length, "two relations have one name");
    this.reference = this.generic.length ? null : this.drawing(given);
    this.evidenceNames = new Names(
      new Set(this.coordinates),
      new Map([...values, ...[...this.generic, "tdot"].map((g) => [g, symbol(g)])]),
      this.functions,
    );
  }

  /** Whether a name means something in texts of the scene or of a certificate. */
  isTaken(name) {
    const word = spelledOut(name);
    return word === "E" || [this.names, this.evidenceNames].some((names) => names.words.has(word) || names.moved(word));
  }

  expression(value, allowed = [], names = this.names ?? new Names(new Set(), this.values)) {
    const found = parse(typeof value === "bigint" ? String(value) : value, names);
    const bad = [...found.symbols].find((s) => !this.signs.has(s) && !allowed.includes(s));
    refuse(bad, `${bad} cannot stand there`);
    return found;
  }

  moving(value) {
    return this.expression(value, ["t", ...this.names.coordinates]);
  }

  vector(values) {
    refuse(!Array.isArray(values) || values.length !== this.d, "a place has as many components as space");
    return values.map((v) => this.expression(v));
  }

  fresh(stem) {
    const name = `${stem}_c${this.index}`;
    const count = (this.counts.get(name) ?? 0) + 1;
    this.counts.set(name, count);
    this.generic.push(count > 1 ? `${name}_${count}` : name);
    return symbol(this.generic.at(-1));
  }

  place(values) {
    return values !== undefined ? this.vector(values) : Array.from({ length: this.d }, () => this.fresh("place"));
  }

  frame(name) {
    refuse(!this.frames.has(name), `there is no body ${name}`);
    return this.frames.get(name);
  }

  point(said) {
    if (isMapping(said)) {
      known(said, "on at");
      this.drawn.add(said.on);
      return this.frame(said.on).point(this.vector(said.at));
    }
    if (Array.isArray(said)) return this.frames.get("ground").point(this.vector(said));
    refuse(!this.points.has(String(said)), `there is no particle ${said}`);
    return this.points.get(String(said));
  }

  /** A direction n and d - 1 independent vectors across it. */
  direction(values) {
    const every = [...Array(this.d).keys()];
    const n = values !== undefined ? this.vector(values) : [number(1), ...every.slice(1).map(() => this.fresh("axis"))];
    const sure = every.filter((i) => nowhereZero(n[i], this.signs));
    refuse(!sure.length && (this.d === 3 || !n.some((x) => x.symbols.size)), "a direction may be 0");
    const k = sure.find((i) => isNumber(n[i])) ?? sure[0] ?? 0;
    const rows = every.filter((i) => i !== k).map((i) => every.map((j) => (j === i ? n[k] : j === k ? neg(n[i]) : ZERO())));
    return [n, rows];
  }

  /** Relations between letters, coordinates and time. */
  between(texts, letters) {
    refuse(!Array.isArray(texts), "a curve is a list of texts");
    const names = new Names(new Set([...this.names.coordinates, ...letters]), this.values, this.functions);
    const found = texts.flatMap((text) => parseRelations(text, names));
    const bad = found.some((r) => [...r.tree.symbols].some((s) => !names.coordinates.has(s) && !this.signs.has(s) && s !== "t"));
    refuse(bad, "a text mentions places, parameters and t");
    return found;
  }

  distance(a, b, squared) {
    let known2 = squared;
    if (!known2) known2 = a.start && b.start ? square(less(a.start, b.start)) : this.fresh("square");
    const [arm, under] = apart(a, b);
    return sub(square(arm), mul(known2, under, under));
  }

  readConstraints(entries) {
    const named = new Map();
    entries.forEach((entry, i) => {
      const name = String(entry.name ?? `c${i + 1}`);
      refuse(named.has(name), "two constraints have one name");
      named.set(name, entry);
    });
    this.joints = named;
    this.owners = [...named.keys()];
    const found = [];
    this.index = 0;
    for (const [owner, entry] of named) {
      this.index += 1;
      const type = entry.type ?? "equation";
      const rule = Object.hasOwn(TYPES, type) ? TYPES[type] : null;
      if (!rule) {
        this.unread.push(owner);
        continue;
      }
      const [read, fields, dimensions] = rule;
      known(entry, `type name ${fields}`);
      refuse(!dimensions.includes(String(this.d)), `no ${type} is defined in dimension ${this.d}`);
      const sided = read(this, entry).map((r) => (r.tree ? r : { tree: r, sign: "=", strict: false }));
      sided.forEach(({ tree, sign, strict }, i) => {
        const kind = sign !== "=" ? "inequality" : tree.hasAny(this.rates) ? "velocity" : "finite";
        found.push({ id: sided.length === 1 ? owner : `${owner}.${i + 1}`, owner, kind, tree, strict, place: found.length });
      });
    }
    return found;
  }

  /** The reference: where every body is placed and every coordinate that a relation holds is given; else null. */
  drawing(given) {
    const found = new Map(given);
    for (const p of this.points.values()) if (p.start) p.over.forEach((q, i) => found.set(q.value, p.start[i]));
    for (const f of this.frames.values()) for (const [q, v] of f.reference) found.set(q, v);
    const used = (q) => this.relations.some((r) => r.tree.has(q) || r.tree.has(`${q}dot`));
    let held = new Set(this.coordinates.filter(used));
    if (!held.size) held = new Set(this.coordinates);
    this.held = held;
    const placed = [...this.frames].every(([name, f]) => this.drawn.has(name) || ![...f.reference.keys()].some((q) => held.has(q)));
    if (!placed || [...held].some((q) => !found.has(q))) return null;
    return new Map(this.coordinates.map((q) => [q, found.get(q) ?? ZERO()]));
  }
}

// -- the constraint types --------------------------------------------------------------------------

/** A relation times the velocities that its terms are divided by, each once, so that dy/dx = f says dy = f dx. */
function cleared(tree, rates) {
  const terms = (tree.head === "sum" ? tree.args : [tree]).map((t) => (t.head === "product" ? t.args : [t]));
  const isRate = (f) => f.symbols.size > 0 && [...f.symbols].every((name) => rates.includes(name));
  const isInverse = (f) => f.head === "power" && isNumber(f.args[1], -1) && isRate(f);
  const inverses = new Set(terms.flat().filter(isInverse));
  if (terms.some((term) => new Set(term.filter(isInverse)).size < term.filter(isInverse).length)) return tree;
  const whole = (term) => [...inverses].filter((f) => !term.includes(f)).map((f) => f.args[0]);
  return add(...terms.map((term) => mul(...term.filter((f) => !inverses.has(f)), ...whole(term))));
}

/** A relation in velocities: without dt, and what is linear in velocities as a form with tdot. */
function inVelocities(scene, tree) {
  let degree = 0;
  if (tree.has("dt")) {
    degree = null;
    // homogeneous of degree k, by Euler's relation; a quotient of differentials is so of degree 0
    for (const k of [0, 1, 2, 3, -1, -2]) {
      if (degree === null && isZero(sub(mul(symbol("dt"), tr.derivative(tree, "dt")), mul(number(k), tree)))) degree = k;
    }
    refuse(degree === null, "differentials and finite terms are added together");
  }
  const plain = substitute(tree, new Map([["dt", number(1)]]));
  const rates = scene.coordinates.map((q) => `${q}dot`);
  const parts = linearIn(plain, rates) ?? linearIn(cleared(plain, rates), rates);
  if (!parts) return plain;
  const form = [...parts.slope].filter(([, s]) => !isNumber(s, 0)).map(([rate, s]) => mul(s, symbol(rate)));
  return form.length || degree ? add(...form, mul(parts.rest, symbol("tdot"))) : parts.rest;
}

const rename = (letters, values) => new Map([...letters].map((letter, i) => [letter, values[i]]));

function on(w, e) {
  refuse("surface" in e === "curve" in e, "either a surface or a curve is needed");
  const letters = "xyz".slice(0, w.d);
  const relations = w.between("curve" in e ? e.curve : [e.surface], letters);
  return e.members.flatMap((m) => {
    const values = rename(letters, placeOf(w.point(m)));
    return relations.map((r) => ({ ...r, tree: substitute(r.tree, values) }));
  });
}

function cam(w, e) {
  const point = w.point(e.point);
  const frame = w.frame(e.body);
  const found = w.between([e.curve], "xy");
  refuse(found.length !== 1 || found[0].sign !== "=", "a profile is one equation in x and y");
  const turn = rotation(2, 0, 1, frame.reference.size ? frame.turning[0] : undefined);
  const arm = less(placeOf(point), frame.position);
  return [substitute(found[0].tree, rename("xy", columns(turn).map((c) => dot(c, arm))))];
}

function rigid(w, e) {
  const points = e.members.map((m) => {
    refuse(!w.points.has(String(m)), `there is no particle ${m}`);
    return w.points.get(String(m));
  });
  return points.flatMap((a, i) => points.slice(i + 1).map((b) => w.distance(a, b, null)));
}

function string(w, e) {
  const points = e.along.map((p) => w.point(p));
  const pairs = points.slice(1).map((b, i) => [points[i], b]);
  const drawn = pairs.filter(([a, b]) => a.start && b.start).map(([a, b]) => length(less(b.start, a.start)));
  const given = "length" in e ? w.moving(e.length) : null;
  const total = given ?? (drawn.length === pairs.length ? add(...drawn) : w.fresh("length"));
  return [sub(add(...pairs.map(([a, b]) => length(less(placeOf(b), placeOf(a))))), total)];
}

function fixed(w, e) {
  refuse("point" in e === "body" in e, "either a point or a body is fixed");
  if ("body" in e) {
    w.drawn.add(e.body);
    return [...w.frame(e.body).reference].map(([q, value]) => sub(symbol(q), value));
  }
  const point = w.point(e.point);
  return less(point.over, scaled(point.under, point.start ?? w.place(undefined)));
}

function slot(w, e) {
  const point = w.point(e.point);
  const frame = w.frame(e.body);
  const across = w.direction(e.axis)[1];
  const place = !("at" in e) && point.start ? point.start : w.place(e.at);
  if ("at" in e || "axis" in e) w.drawn.add(frame.name);
  return across.map((u) => frame.offset(point, place, u));
}

function roll(w, e) {
  const frame = w.frame(e.body);
  const r = w.expression(e.radius);
  const rates = [...frame.reference.keys()].map((q) => symbol(`${q}dot`));
  const contact = sub(frame.position.at(-1), r);
  if (w.d === 2) return [contact, add(rates[0], mul(r, rates[2]))];
  let spin;
  if (frame.cayley) {
    const c = cross(frame.cayley, rates.slice(3));
    spin = c.map((x, i) => mul(number(2), add(rates[3 + i], x)));
  } else {
    const [phi, theta] = frame.turning;
    const [c, s, tilt] = [call("cos", phi), call("sin", phi), mul(rates[5], call("sin", theta))];
    spin = [add(mul(rates[4], c), mul(s, tilt)), sub(mul(rates[4], s), mul(c, tilt))];
  }
  return [contact, sub(mul(frame.under, rates[0]), mul(r, spin[1])), add(mul(frame.under, rates[1]), mul(r, spin[0]))];
}

function gear(w, e) {
  const arm = w.frame(e.carrier ?? "ground").angle;
  const [first, second] = e.between.map((b) => sub(w.frame(b).angle, arm));
  return [sub(second, mul(w.expression(e.ratio), first))];
}

/** What is 0 where `now` of the second body is `start`, as long, of the first, and not where it is reversed. */
function aligned(first, second, start, now, across) {
  const [g, h, moved] = [first.cayley, second.cayley, second.carry(now)];
  if (g && h && start === now) return dot(less(less(h, g), cross(g, h)), across);
  const full = mul(first.under, second.under, square(now));
  return mul(dot(first.carry(across), moved), tr.inverse(add(full, dot(first.carry(start), moved))));
}

/** The angle of the second body against the first about n. */
function turnAbout(first, second, n, [u]) {
  const now = second.carry(u);
  return call("atan2", dot(first.carry(cross(n, u)), now), mul(length(n), dot(first.carry(u), now)));
}

const displaced = (frame, point, place, n) => mul(frame.offset(point, place, n), tr.inverse(mul(frame.under, point.under, length(n))));

/** No turn of one body against the other. */
function parallel(a, b) {
  if (a.position.length === 2) return [sub(b.angle, a.angle)];
  if (a.cayley && b.cayley) return less(b.cayley, a.cayley);
  const [p, q] = [columns(a.turn), columns(b.turn)];
  const half = tr.inverse(add(mul(a.under, b.under), ...p.map((c, i) => dot(c, q[i]))));
  return [[0, 1], [1, 2], [2, 0]].map(([i, j]) => mul(half, sub(dot(p[i], q[j]), dot(p[j], q[i]))));
}

function joint(keeps) {
  const words = keeps.split(" ");
  return (w, e) => {
    const [first, second] = e.between.map((b) => w.frame(b));
    if (keeps === "turn point" || "at" in e || "axis" in e || "axes" in e) e.between.forEach((b) => w.drawn.add(b));
    const place = words.includes("turn") || words.includes("plane") ? second.start : w.place(e.at);
    const asks = words.includes("line") || (words.includes("axis") && w.d === 3);
    refuse(asks && "at" in e && !("axis" in e), "a joint with a place has an axis");
    const [n, across] = asks ? w.direction(e.axis) : [[], []];
    const moved = second.point(place);
    const equations = {
      turn: () => parallel(first, second),
      point: () => apart(first.point(place), moved)[0],
      axis: () => across.map((u) => aligned(first, second, n, n, u)),
      line: () => across.map((u) => first.offset(moved, place, u)),
      plane: () => [first.offset(moved, place, n)],
      cross: () => [dot(first.carry(w.vector(e.axes[0])), second.carry(w.vector(e.axes[1])))],
      thread: () => {
        const turns = mul(tr.inverse(mul(number(2), tr.pi())), turnAbout(first, second, n, across));
        return [sub(displaced(first, moved, place, n), mul(w.expression(e.pitch), turns))];
      },
    };
    const found = words.flatMap((word) => equations[word]());
    if ("drive" in e) {
      const law = w.expression(e.drive, ["t"]);
      if (keeps === "turn line" || keeps === "axis line") found.push(sub(displaced(first, moved, place, n), law));
      else if (!across.length) found.push(sub(sub(second.angle, first.angle), law));
      else {
        const [u, w, s, c] = [across[0], cross(n, across[0]), call("sin", law), call("cos", law)];
        const start = scaled(c, u).map((x, i) => add(x, mul(s, tr.inverse(length(n)), w[i])));
        found.push(aligned(first, second, start, u, less(scaled(c, w), scaled(mul(length(n), s), u))));
      }
    }
    return found;
  };
}

const MEASURES = { revolute: "angle", prismatic: "displacement", cylindrical: "", screw: "" };

/** The angle or displacement of a joint, for a coupling. */
function measured(w, said) {
  const cut = said.lastIndexOf(".");
  const [name, what] = w.joints.has(said) ? [said, ""] : [said.slice(0, cut), said.slice(cut + 1)];
  const e = w.joints.get(name);
  const only = e && MEASURES[e.type];
  refuse(only === undefined, `${said} is no joint that can be coupled`);
  const wanted = what || only;
  refuse(!["angle", "displacement"].includes(wanted) || (only && only !== wanted), `${said} is unclear`);
  const [first, second] = e.between.map((b) => w.frame(b));
  if (w.d === 2 && only === "angle") return sub(second.angle, first.angle);
  const [n, across] = w.direction(e.axis ?? []);
  if (wanted === "angle") return turnAbout(first, second, n, across);
  const place = only ? second.start : w.vector(e.at);
  return displaced(first, second.point(place), place, n);
}

function coupling(w, e) {
  const letters = Array.isArray(e.joints) ? Object.fromEntries(e.joints.map((j) => [j, j])) : e.joints;
  const values = new Map(Object.entries(letters).map(([letter, name]) => [letter, measured(w, name)]));
  return w.between([e.text], Object.keys(letters)).map((r) => ({ ...r, tree: substitute(r.tree, values) }));
}

/** Every type: its relations, the fields it has besides type and name, the dimensions in which it is defined. */
const TYPES = {
  equation: [(w, e) => parseRelations(typeof e.text === "bigint" ? String(e.text) : e.text, w.names).map((r) => ({ ...r, tree: inVelocities(w, r.tree) })), "text", "123"],
  rigid: [rigid, "members", "123"],
  fixed: [fixed, "point body", "123"],
  on: [on, "members surface curve", "123"],
  link: [(w, e) => [w.distance(...e.between.map((p) => w.point(p)), "length" in e ? pow(w.moving(e.length), 2) : null)], "between length", "123"],
  roll: [roll, "body radius", "23"],
  string: [string, "along length", "123"],
  slot: [slot, "point body at axis", "23"],
  coincident: [(w, e) => apart(...e.between.map((p) => w.point(p)))[0], "between", "123"],
  gear: [gear, "between ratio carrier", "2"],
  cam: [cam, "point body curve", "2"],
  coupling: [coupling, "joints text", "23"],
  revolute: [joint("point axis"), "between at axis drive", "23"],
  prismatic: [joint("turn line"), "between at axis drive", "23"],
  weld: [joint("turn point"), "between", "23"],
  cylindrical: [joint("axis line"), "between at axis drive", "3"],
  screw: [joint("axis line thread"), "between at axis drive pitch", "3"],
  planar: [joint("axis plane"), "between at axis", "3"],
  universal: [joint("point cross"), "between at axes", "3"],
  spherical: [joint("point"), "between at axis", "3"],
};
