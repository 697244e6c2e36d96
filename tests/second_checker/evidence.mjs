// What a certificate puts forward, checked where a claim uses it: steps, points, minors, fields, covers.

import { Interval, NotCovered, ONE, Rational, Refused, ZERO, refuse } from "./numbers.mjs";
import { parse } from "./grammar.mjs";
import { isZero, rational } from "./ring.mjs";
import { nowhereZero } from "./scene.mjs";
import * as tr from "./trees.mjs";
import { add, derivative, linearIn, mul, number, pow, sub, substitute, symbol } from "./trees.mjs";

const entries = (mapping) => Object.entries(mapping ?? {});

/** Whether a tree has a value and all derivatives for all values of its symbols, and is analytic. */
export function isTotal(tree, fixed = (t) => t.symbols.size === 0 && t.functions.size === 0) {
  if (fixed(tree) && tree.head !== "power" && tree.head !== "call") return true;
  const below = (t) => fixed(t) || isTotal(t, fixed);
  if (tree.head === "power") {
    const e = tree.args[1];
    if (!tr.isNumber(e)) return false;
    if (e.value.whole && e.value.sign > 0) return below(tree.args[0]);
    return tree.args[0].head === "number" && tree.args[0].value.sign > 0;
  }
  if (tree.head === "call") return ["sin", "cos", "exp", "sinh", "cosh", "tanh", "atan"].includes(tree.value) && below(tree.args[0]);
  return tree.args.every(below) && tree.head !== "apply";
}

/** The sign of the determinant of a square matrix of intervals is certain. */
export function excludesZero(matrix) {
  const m = matrix.map((row) => [...row]);
  const size = (x) => (x.nonzero ? (x.lo > 0n ? x.lo : -x.hi) : 0n);
  for (let k = 0; k < m.length; k += 1) {
    let best = k;
    for (let i = k + 1; i < m.length; i += 1) if (size(m[i][k]) > size(m[best][k])) best = i;
    if (!m[best][k].nonzero) return false;
    [m[k], m[best]] = [m[best], m[k]];
    const inverse = m[k][k].inverse();
    for (let i = k + 1; i < m.length; i += 1) {
      if (m[i][k].lo === 0n && m[i][k].hi === 0n) continue;
      const factor = m[i][k].mul(inverse);
      for (let j = k + 1; j < m.length; j += 1) {
        if (m[k][j].lo !== 0n || m[k][j].hi !== 0n) m[i][j] = m[i][j].sub(factor.mul(m[k][j]));
      }
    }
  }
  return true;
}

export class Evidence {
  constructor(scene, certificate) {
    this.scene = scene;
    this.certificate = certificate;
    this.n = scene.coordinates.length;
    this.relations = scene.relations.filter((r) => r.kind !== "inequality");
    this.velocities = new Set(scene.coordinates.map((q) => `${q}dot`));
    this.memo = new Map();
    this.known = new Map(scene.byId);
    this.order = [];
    for (const step of certificate.relations ?? []) {
      refuse(typeof step?.id !== "string", "a step has an id");
      this.order.push(step);
    }
    this.steps = new Map(this.order.map((s) => [s.id, s]));
    refuse(this.steps.size < this.order.length, "two steps have one id");
    refuse([...this.steps.keys()].some((id) => scene.byId.has(id)), "a step has the name of a relation");
  }

  once(key, make) {
    if (!this.memo.has(key)) {
      let found;
      try {
        found = { value: make() };
      } catch (error) {
        if (!(error instanceof Refused) && !(error instanceof NotCovered)) throw error;
        found = { error };
      }
      this.memo.set(key, found);
    }
    const { value, error } = this.memo.get(key);
    if (error) throw error;
    return value;
  }

  text(value) {
    return this.once(`text ${JSON.stringify(value)}`, () => parse(value, this.scene.evidenceNames));
  }

  listed(part, id) {
    refuse(typeof id !== "string", "an id is a text");
    const found = (this.certificate[part] ?? []).filter((one) => one.id === id);
    refuse(!found.length, `${id} is not one of the ${part}`);
    return found.at(-1);
  }

  // -- relations ------------------------------------------------------------------------------------

  /** The relation of an id: of the scene, or of a step. */
  relation(id, before = null, unequal = false) {
    if (this.scene.byId.has(id)) {
      const found = this.scene.byId.get(id);
      refuse(found.kind === "inequality" && !unequal, `${id} is an inequality`);
      return found;
    }
    const step = this.steps.get(id);
    refuse(!step, `there is no relation ${id}`);
    refuse(before && this.order.indexOf(step) >= this.order.indexOf(before), `${id} comes after what uses it`);
    return this.once(`relation ${id}`, () => {
      let tree;
      if (step.by === "rate") tree = this.rateOf(this.relation(step.of, step));
      else {
        refuse(step.function === undefined, `the step ${id} is no relation`);
        tree = this.text(step.function);
      }
      const kind = tree.hasAny(this.scene.rates) || step.by === "rate" ? "velocity" : "finite";
      refuse(step.by === "integral" && kind !== "finite", "an integral holds no velocities");
      return { id, kind, tree, step, leaf: step.by === "integral", assumed: step.by === "assumed" };
    });
  }

  rateOf(relation) {
    refuse(relation.kind !== "finite", "a rate is of a finite relation");
    const terms = [...this.scene.coordinates, "t"].map((q) => mul(derivative(relation.tree, q), symbol(`${q}dot`)));
    return add(...terms);
  }

  /** The coefficients of a form by coordinate and t; null where it is not linear in velocities. */
  form(relation) {
    return this.once(`form ${relation.id}`, () => {
      if (relation.kind === "finite") {
        return new Map([...this.scene.coordinates, "t"].map((q) => [q, derivative(relation.tree, q)]));
      }
      const parts = linearIn(relation.tree, [...this.velocities, "tdot"]);
      if (!parts || !isZero(parts.rest)) return null;
      return new Map([...this.scene.coordinates, "t"].map((q) => [q, parts.slope.get(`${q}dot`) ?? number(0)]));
    });
  }

  /** The identity of a step, and what it needs at a point: { from, h, texts }. */
  identity(step) {
    return this.once(`identity ${step.id}`, () => {
      const real = step.sos !== undefined;
      const c = entries(step.c).map(([id, text]) => [this.relation(id, step, real), this.text(text)]);
      const squares = (step.sos ?? []).map(([w, a]) => [this.text(w), this.text(a)]);
      const sided = c.filter(([r]) => r.kind === "inequality").map(([, text]) => mul(number(-1), text));
      refuse(!(step.put ?? []).every((pair) => Array.isArray(pair) && pair.length === 2), "put is a list of pairs");
      const puts = (step.put ?? []).map(([id, q]) => [this.relation(id, step), q]);
      const h = this.text(step.h ?? "1");
      const positive = [...sided, ...squares.map(([w]) => w), ...(real ? [h] : [])];
      refuse(!positive.every((tree) => nowhereZero(tree, this.scene.signs, true)), "no sum of squares");
      refuse(real && step.by !== "implied", "only what is implied is a square");
      let target, goal;
      if (step.by === "integral") {
        target = this.rateOf(this.relation(step.id));
        refuse(h.hasAny(this.scene.rates), "h holds velocities");
      } else {
        refuse(step.by !== "implied", `there is no step by ${step.by}`);
        refuse(step.of !== undefined && step.function !== undefined, "a step is of a relation, or has a function");
        goal = step.of === undefined ? this.relation(step.id) : this.relation(step.of, step);
        const finite = goal.kind === "finite";
        refuse(finite && c.some(([, text]) => text.hasAny(this.scene.rates)), "a cofactor holds velocities");
        refuse((finite || real) && h.hasAny(this.scene.rates), "h holds velocities");
        target = real ? pow(goal.tree, 2) : goal.tree;
      }
      const left = add(mul(h, target), ...squares.map(([w, a]) => mul(w, pow(a, 2))));
      let difference = sub(left, add(...c.map(([r, text]) => mul(text, r.tree))));
      for (const [r, q] of puts) {
        refuse(r.kind !== "finite" || r.leaf || !this.scene.coordinates.includes(q), "what is put in is finite");
        const value = this.solved(r, q);
        difference = substitute(difference, new Map([[q, value]]));
      }
      // a relation that a step introduces is one where that step is right
      [...c.map(([r]) => r), ...puts.map(([r]) => r), ...(step.of ? [this.relation(step.of)] : [])].forEach((r) => {
        if (r.step && r.step !== step && ["implied", "integral"].includes(r.step.by)) this.identity(r.step);
      });
      difference = substitute(difference, new Map([["tdot", number(1)]]));
      refuse(!isZero(difference), `the identity of ${step.id} is not one`);
      return { from: [...c.map(([r]) => r.id), ...puts.map(([r]) => r.id)], h, texts: [...c.map(([, t]) => t), ...squares.flat(), ...(real ? [goal.tree] : [])] };
    });
  }

  /** What a finite relation gives a coordinate, by a factor of numbers and parameters that is not 0. */
  solved(relation, q) {
    const parts = linearIn(relation.tree, [q]);
    refuse(!parts || !parts.slope.has(q), `${relation.id} does not give ${q}`);
    refuse(!this.constantNotZero(parts.slope.get(q)), `${relation.id} does not give ${q}`);
    return mul(number(-1), parts.rest, tr.inverse(parts.slope.get(q)));
  }

  /** Whether a factor is not 0 by itself; a sum of numbers times one product of parameters is simplified first. */
  constantNotZero(tree) {
    if (nowhereZero(tree, this.scene.signs)) return true;
    return tree.symbols.size === 0 && tree.functions.size === 0 ? false : this.simplified(tree);
  }

  simplified(tree) {
    if (![...tree.symbols].every((s) => this.scene.signs.has(s)) || tree.functions.size) return false;
    // a monomial of parameters: the tree over the product of some powers is a number
    const names = [...tree.symbols];
    const powers = names.map((s) => {
      for (let k = -4; k <= 4; k += 1) {
        if (isZero(sub(mul(symbol(s), derivative(tree, s)), mul(number(k), tree)))) return k;
      }
      return null;
    });
    if (powers.includes(null)) return false;
    return nowhereZero(mul(...names.map((s, i) => pow(symbol(s), powers[i]))), this.scene.signs) && !isZero(tree);
  }

  /** The ids of all relations that follow, near a point, from some; `covers` of the claim are added. Without `rates`:
   *  at a state alone. */
  closure(ids, point, covers = [], rates = true) {
    const found = new Set(ids);
    for (let grown = true; grown; ) {
      grown = false;
      for (const step of this.order) {
        const goal = step.by === "implied" && step.of !== undefined ? step.of : step.id;
        if (found.has(goal) || step.by === "assumed" || (step.by === "rate" && !rates)) continue;
        if (this.usable(step, found, point)) {
          found.add(goal);
          grown = true;
        }
      }
      for (const cover of covers) {
        const { minor, rows } = this.cover(cover);
        if (minor.point !== point || !minor.rows.every((r) => found.has(r.id))) continue;
        for (const id of rows) {
          if (found.has(id)) continue;
          found.add(id);
          grown = true;
        }
      }
    }
    return found;
  }

  usable(step, found, point) {
    const wanted = step.by === "rate" ? [step.of] : [...Object.keys(step.c ?? {}), ...(step.put ?? []).map(([id]) => id)];
    if (!wanted.every((id) => found.has(id))) return false;
    try {
      if (step.by === "rate") return Boolean(this.relation(step.id));
      const { h, texts } = this.identity(step);
      if (point === null) return this.constantNotZero(h) && texts.every((text) => isTotal(text));
      if (!this.at(h, point).nonzero) return false;
      if (h.hasAny(this.scene.rates) && !this.isState(point)) return false;
      texts.forEach((text) => this.at(text, point, true));
      const still = (text) => !text.hasAny(this.scene.rates);
      refuse(!texts.every((text) => still(text) || isTotal(text, still)), "velocities without a value");
      return true;
    } catch (error) {
      if (error instanceof Refused) return false;
      throw error;
    }
  }

  /** Whether all equations, and the rates of the finite ones, hold at the velocities of a point. What follows near a
   *  state is not used for this. */
  isState(point) {
    const key = `state ${point.id}`;
    if (!this.memo.has(key)) {
      this.memo.set(key, { value: false });
      const met = this.relations.filter((r) => this.zeroAtOrNot(r.tree, point)).map((r) => r.id);
      const known = this.closure([...this.held(point), ...met], point, [], false);
      const zero = (tree) => this.zeroAtOrNot(tree, point) || point.rows.some((id) => isZero(sub(this.relation(id).tree, tree)));
      const value = this.relations.every((r) => known.has(r.id) && (r.kind === "velocity" || zero(this.rateOf(r))));
      this.memo.set(key, { value });
    }
    return this.memo.get(key).value;
  }

  // -- points ----------------------------------------------------------------------------------------

  point(id) {
    return this.once(`point ${id}`, () => {
      const given = this.listed("points", id);
      const exact = new Map();
      const balls = new Map([["tdot", ONE]]);
      exact.set("tdot", number(1));
      const columns = given.columns ?? [];
      const radius = given.radius === undefined ? null : rational(this.text(given.radius));
      const functions = new Map();
      const allowed = new Set([...this.scene.coordinates, ...this.velocities, "t", ...this.scene.signs.keys(), ...this.scene.generic]);
      const centres = new Map();
      for (const [name, text] of entries(given.values)) {
        refuse(!allowed.has(name), `${name} has no value`);
        const tree = substitute(this.text(text), exact);
        refuse(tree.symbols.size > 0 || tree.functions.size > 0, "a value is of numbers and parameters before it");
        refuse([...this.text(text).symbols].some((s) => !this.scene.signs.has(s) && !this.scene.generic.includes(s)), "a value is of numbers and parameters");
        if (columns.includes(name)) centres.set(name, rational(tree));
        else exact.set(name, tree);
        if (!columns.includes(name)) balls.set(name, tr.evaluate(tree, new Map()));
      }
      for (const [name, sign] of this.scene.signs) {
        if (!balls.has(name) || sign === "real") continue;
        refuse(sign === "positive" ? !balls.get(name).positive : !balls.get(name).nonzero, `${name} is ${sign}`);
      }
      for (const [name, { arguments: args, text }] of entries(given.functions)) {
        refuse(!this.scene.functions.has(name) || !Array.isArray(args), `there is no function ${name}`);
        const names = new this.scene.evidenceNames.constructor(new Set(args), new Map(), new Map());
        const tree = parse(text, names);
        refuse([...tree.symbols].some((s) => !args.includes(s)), "a function is of its arguments");
        functions.set(name, [args, tree]);
      }
      const point = { id, exact, balls, functions, rows: [], box: columns.length > 0, done: new Map() };
      refuse(given.rows !== undefined && given.rows.length !== columns.length, "a box has as many rows as columns");
      if (point.box) this.checkBox(point, given, columns, centres, radius);
      return point;
    });
  }

  /** Krawczyk's test: there is one zero of the rows in the box. */
  checkBox(point, given, columns, centres, radius) {
    refuse(!radius || radius.sign <= 0 || new Set(columns).size < columns.length, "a box has a radius");
    refuse(columns.some((q) => !centres.get(q)), "a box has centres");
    const rows = given.rows.map((id) => this.relation(id, null, true));
    rows.forEach((r) => r.step && r.step.by !== "rate" && this.identity(r.step));
    const middle = { ...point, balls: new Map(point.balls), done: new Map() };
    for (const q of columns) {
      middle.balls.set(q, Interval.of(centres.get(q)));
      point.balls.set(q, Interval.around(centres.get(q), radius));
    }
    const values = rows.map((r) => this.at(r.tree, middle));
    const slopes = (p) => rows.map((r) => columns.map((q) => this.at(derivative(r.tree, q), p)));
    const inverse = approximateInverse(slopes(middle));
    const wide = slopes(point);
    const images = columns.map((q, i) => {
      let moved = ZERO;
      inverse[i].forEach((y, k) => (moved = moved.sub(y.mul(values[k]))));
      columns.forEach((p, j) => {
        let entry = i === j ? ONE : ZERO;
        inverse[i].forEach((y, k) => (entry = entry.sub(y.mul(wide[k][j]))));
        moved = moved.add(entry.mul(point.balls.get(p).sub(middle.balls.get(p))));
      });
      const image = middle.balls.get(q).add(moved);
      refuse(!point.balls.get(q).contains(image), "no zero is certain in the box");
      return image;
    });
    // the zero lies in its image, which is smaller than the box
    columns.forEach((q, i) => point.balls.set(q, images[i]));
    point.done = new Map();
    point.rows = given.rows;
  }

  /** The interval of a tree at a point; velocities that are not given are 0 where `still`. */
  at(tree, point, still = false) {
    const concrete = tree.functions.size ? substitute(tree, new Map(), point.functions) : tree;
    if (!still) return tr.evaluate(concrete, point.balls, point.done);
    const balls = new Map([...[...this.velocities].map((v) => [v, ZERO]), ...point.balls]);
    return tr.evaluate(concrete, balls);
  }

  zeroAt(tree, point) {
    return isZero(substitute(substitute(tree, new Map(), point.functions), point.exact));
  }

  /** Whether a relation holds at a point; forms ask no velocities, integrals keep their value. */
  holds(relation, point) {
    return this.once(`holds ${relation.id} ${point.id}`, () => {
      const form = relation.kind === "velocity" ? this.form(relation) : null;
      if (form) {
        for (const c of form.values()) this.at(c, point);
        return true;
      }
      const ball = this.at(relation.tree, point);
      if (relation.leaf) return true;
      if (ball.nonzero) return false;
      if (point.rows.includes(relation.id)) return true;
      if (this.zeroAt(relation.tree, point)) return true;
      return this.closure(this.held(point), point, [], false).has(relation.id);
    });
  }

  /** The relations that hold at a point by themselves. */
  held(point) {
    const ids = [...this.known.keys()].filter((id) => this.known.get(id).kind !== "inequality");
    return [...ids.filter((id) => this.known.get(id).kind === "finite" && this.zeroAtOrNot(this.known.get(id).tree, point)), ...point.rows];
  }

  zeroAtOrNot(tree, point) {
    try {
      return !this.at(tree, point).nonzero && this.zeroAt(tree, point);
    } catch (error) {
      if (error instanceof Refused || error instanceof NotCovered) return false;
      throw error;
    }
  }

  needHolds(relation, point) {
    refuse(!this.holds(relation, point), `${relation.id} does not hold at ${point.id}`);
  }

  // -- minors, fields, covers -------------------------------------------------------------------------

  slope(relation, q) {
    return derivative(relation.tree, relation.kind === "finite" ? q : `${q}dot`);
  }

  minor(said, assumed = false) {
    return this.once(`minor ${JSON.stringify(said)} ${assumed}`, () => {
      const given = typeof said === "string" ? this.listed("minors", said) : said;
      refuse(!given || !Array.isArray(given.rows) || !Array.isArray(given.columns), "a minor has rows and columns");
      const point = this.point(given.at);
      refuse(given.rows.length !== given.columns.length, "a minor is square");
      refuse(!given.columns.every((q) => this.scene.coordinates.includes(q)), "a column is no coordinate");
      const rows = given.rows.map((id) => this.relation(id));
      refuse(new Set(given.rows).size < rows.length, "a row stands twice");
      rows.forEach((r) => this.needHolds(r, point));
      this.needState(rows, point);
      const all = this.closure(this.relations.map((r) => r.id), point);
      refuse(!assumed && !given.rows.every((id) => all.has(id)), "a row does not follow from the scene");
      const matrix = rows.map((r) => given.columns.map((q) => this.at(this.slope(r, q), point)));
      refuse(!excludesZero(matrix), "a minor may be 0");
      return { point, rows, columns: given.columns };
    });
  }

  /** Refuses unless all of some relations are rows or follow from them. */
  account(minor, relations, covers = [], state = true) {
    const found = this.closure(minor.rows.map((r) => r.id), minor.point, covers ?? []);
    const left = relations.find((r) => !found.has(r.id));
    refuse(left, `${left?.id} is no row and does not follow from rows`);
    if (state) this.needState(relations, minor.point);
  }

  /** Beside a relation that is not linear in velocities all hold of the point with its velocities, and the rates too. */
  needState(relations, point) {
    const asked = relations.filter((r) => !r.leaf);
    if (asked.every((r) => this.form(r))) return;
    const met = asked.filter((r) => r.kind === "velocity" && this.zeroAt(r.tree, point)).map((r) => r.id);
    const known = this.closure([...this.held(point), ...met], point, [], false);
    for (const r of asked) {
      const tree = r.kind === "finite" ? this.rateOf(r) : r.tree;
      const row = point.rows.some((id) => isZero(sub(this.relation(id).tree, tree)));
      const holds = r.kind === "finite" ? row || this.zeroAt(tree, point) : known.has(r.id);
      refuse(!holds || this.at(tree, point).nonzero, `${r.id} does not hold at the velocities of ${point.id}`);
    }
  }

  field(id) {
    return this.once(`field ${id}`, () => {
      const given = this.listed("fields", id);
      const names = new Set([...this.scene.coordinates, "t"]);
      return new Map(
        entries(given.components).map(([q, text]) => {
          refuse(!names.has(q), `a field has no component ${q}`);
          const tree = this.text(text);
          refuse(tree.hasAny(this.scene.rates), "a field holds no velocities");
          return [q, tree];
        }),
      );
    });
  }

  along(field, tree) {
    return add(...[...field].map(([q, x]) => mul(x, derivative(tree, q))));
  }

  bracket(x, y) {
    const names = new Set([...x.keys(), ...y.keys()]);
    return new Map([...names].map((q) => [q, sub(this.along(x, y.get(q) ?? number(0)), this.along(y, x.get(q) ?? number(0)))]));
  }

  word(ids) {
    refuse(!Array.isArray(ids) || !ids.length || ids.length > 12, "a word is a list of fields");
    return ids.slice(1).reduce((x, id) => this.bracket(x, this.field(id)), this.field(ids[0]));
  }

  /** A relation's form on a field. */
  pairing(relation, field) {
    const form = this.form(relation);
    refuse(!form, `${relation.id} is not linear in velocities`);
    return add(...[...field].map(([q, x]) => mul(x, form.get(q))));
  }

  tangent(fields, rows) {
    for (const x of fields) for (const r of rows) refuse(!isZero(this.pairing(r, x)), `a field is not tangent to ${r.id}`);
  }

  independentAt(vectors, columns, point) {
    refuse(!Array.isArray(columns) || columns.length !== vectors.length, "as many columns as vectors are needed");
    refuse(new Set(columns).size < columns.length, "a column stands twice");
    refuse(!columns.every((q) => q === "t" || this.scene.coordinates.includes(q)), "a column is no coordinate");
    const all = vectors.map((v) => columns.map((q) => this.at(v.get(q) ?? number(0), point)));
    vectors.forEach((v) => [...v.values()].forEach((x) => this.at(x, point)));
    refuse(!excludesZero(all), "fields may be dependent");
  }

  cover(id) {
    return this.once(`cover ${id}`, () => {
      const given = this.listed("covers", id);
      const minor = this.minor(given.minor);
      const all = [];
      let sum = 0;
      for (const block of given.blocks) {
        const rows = block.rows.map((r) => this.scene.byId.get(r));
        refuse(rows.some((r) => !r || r.kind !== "finite"), "a block is of finite relations of the scene");
        refuse(new Set(block.rows).size < rows.length, "a row stands twice");
        const used = new Set(rows.flatMap((r) => [...r.tree.symbols]));
        for (const s of used) {
          const own = this.scene.generic.includes(s) && this.relations.filter((r) => r.tree.has(s)).length === 1;
          refuse(!own && !this.scene.coordinates.includes(s), `a block holds ${s}`);
        }
        refuse(rows.some((r) => r.tree.functions.size), "a block holds a function");
        const occurring = [...used].filter((s) => this.scene.coordinates.includes(s));
        const fields = block.fields.map((f) => this.field(f));
        this.tangent(fields, rows);
        refuse(!block.columns.every((q) => occurring.includes(q)), "a column does not occur");
        this.independentAt(fields, block.columns, minor.point);
        sum += Math.min(rows.length, occurring.length - fields.length);
        all.push(...block.rows);
      }
      refuse(sum !== minor.rows.length, "a cover has another rank than its minor");
      refuse(!minor.rows.every((r) => all.includes(r.id)), "a row of the minor is in no block");
      refuse(new Set(all).size < all.length, "a row is in two blocks");
      all.forEach((id2) => this.needHolds(this.scene.byId.get(id2), minor.point));
      return { minor, rows: all };
    });
  }
}

/** The inverse of a matrix of small intervals, in floating point: it only has to be near. */
function approximateInverse(matrix) {
  const n = matrix.length;
  const a = matrix.map((row, i) => [...row.map((x) => Number(x.middle >> 200n) / 2 ** 120), ...row.map((_, j) => (i === j ? 1 : 0))]);
  for (let k = 0; k < n; k += 1) {
    let best = k;
    for (let i = k + 1; i < n; i += 1) if (Math.abs(a[i][k]) > Math.abs(a[best][k])) best = i;
    refuse(a[best][k] === 0 || !Number.isFinite(a[best][k]), "the rows of a box are dependent");
    [a[k], a[best]] = [a[best], a[k]];
    const pivot = a[k][k];
    a[k] = a[k].map((x) => x / pivot);
    for (let i = 0; i < n; i += 1) {
      const factor = a[i][k];
      if (i !== k && factor) a[i] = a[i].map((x, j) => x - factor * a[k][j]);
    }
  }
  const exact = (x) => Interval.of(Rational.of(BigInt(Math.round(x * 2 ** 60)), 1n << 60n));
  refuse(a.some((row) => row.some((x) => !Number.isFinite(x))), "the rows of a box are dependent");
  return a.map((row) => row.slice(n).map(exact));
}
