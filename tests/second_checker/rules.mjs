// The rules: one function for each kind of claim. Each refuses, or returns what later claims may use.

import { NotCovered, refuse } from "./numbers.mjs";
import { isZero, rational } from "./ring.mjs";
import { nowhereZero } from "./scene.mjs";
import { isTotal } from "./evidence.mjs";
import * as tr from "./trees.mjs";
import { add, derivative, mul, number, sub, substitute, symbol } from "./trees.mjs";

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const uncovered = (why) => {
  throw new NotCovered(why);
};
const pairs = (value) => list(value).map((pair) => {
  refuse(!Array.isArray(pair) || pair.length !== 2, "a pair is needed");
  return pair;
});
const whole = (value) => Number.isInteger(value);
const list = (value) => {
  refuse(!Array.isArray(value), "a list is needed");
  return value;
};
/** A component of the exterior derivative of a form. */
const curl = (form, x, y) => sub(derivative(form.get(y), x), derivative(form.get(x), y));
const ids = (relations) => relations.map((r) => r.id);

/** One reading of the certificate (angles or Cayley parameters), and what was verified before. */
export class Rules {
  constructor(evidence, verified) {
    this.e = evidence;
    this.s = evidence.scene;
    this.verified = verified;
  }

  // -- what is asked of points -------------------------------------------------------------------------

  /** The reference configuration at t = 0; null where none is given, or one that a relation of numbers excludes. It
   *  meets the relations for all parameters. */
  get reference() {
    return this.e.once("reference", () => {
      if (!this.s.reference) return null;
      const values = new Map([...this.s.reference, ["t", number(0)]]);
      const open = (r) => r.kind === "finite" && (r.tree.functions.size || r.tree.hasAny(new Set(this.s.signs.keys())));
      const excluded = this.e.relations.filter((r) => r.kind === "finite").map((r) => substitute(r.tree, values));
      const plain = excluded.filter((tree) => !tree.symbols.size && !tree.functions.size);
      if (plain.some((tree) => tr.evaluate(tree, new Map()).nonzero)) return null;
      const missed = this.e.relations.filter(open).some((r) => !isZero(substitute(r.tree, values)));
      refuse(missed, "the reference configuration does not meet the relations");
      return values;
    });
  }

  /** What a point is to a claim: "reference", or its id where no configuration is given; refuses any other point.
   *  Angles have to be a chart of poses there. */
  place(point) {
    for (const [, tilt] of this.s.turns) {
      if (!point.balls.has(tilt)) continue;
      refuse(!this.e.at(tr.call("sin", symbol(tilt)), point).nonzero, "Euler angles are no chart there");
    }
    if (!this.reference) return point.id;
    for (const [q, value] of this.reference) {
      if (q === "t" && !point.balls.has("t")) continue;
      const met = point.exact.has(q) && isZero(substitute(sub(point.exact.get(q), value), point.exact));
      refuse(!met, `${q} is not that of the reference configuration`);
    }
    return "reference";
  }

  about(claim, point) {
    refuse(claim.about !== (this.reference ? "reference" : "component"), "about has another value");
    return this.place(point);
  }

  /** Refuses a point that does not satisfy all finite relations. */
  meets(point) {
    this.e.relations.filter((r) => r.kind === "finite").forEach((r) => this.e.needHolds(r, point));
  }

  /** Refuses where /dof was verified at another point. */
  sameplace(dof, point) {
    const place = this.place(point);
    refuse(dof.place !== null && dof.place !== place, "/dof is of another point");
  }

  before(path) {
    const found = this.verified.get(path);
    refuse(!found, `${path} was not verified before`);
    if (found.uncovered) uncovered(`${path} is not covered`);
    return found;
  }

  owned(name) {
    refuse(!this.s.owners.includes(name), `there is no constraint ${name}`);
    if (this.s.unread.includes(name)) uncovered(`the type of ${name} is not known`);
    return this.s.relations.filter((r) => r.owner === name);
  }

  /** Whether parameters or functions occur in finite relations, but for a generic symbol of its own. */
  get hasParameters() {
    const others = new Set([...this.s.signs.keys()]);
    for (const g of this.s.generic) if (this.e.relations.filter((r) => r.tree.has(g)).length > 1) others.add(g);
    return this.e.relations.some((r) => r.kind === "finite" && (r.tree.hasAny(others) || r.tree.functions.size));
  }

  /** Where finite relations hold parameters: a minor whose rows account for those of some relations. */
  parameters(said, covers, fallback, relations = this.e.relations) {
    if (!this.hasParameters) return;
    const minor = said === undefined ? fallback : this.e.minor(said);
    refuse(!minor, "a minor is needed, for parameters");
    this.e.account(minor, relations.filter((r) => r.kind === "finite"), covers);
  }

  // -- bounds --------------------------------------------------------------------------------------------

  most(bound) {
    const minor = this.e.minor(bound.minor);
    if (bound.rule === "minor") {
      refuse(minor.rows.some((r) => r.kind !== "finite"), "all rows are finite or integrals");
    } else if (bound.rule === "frobenius") this.frobenius(bound, minor);
    else uncovered(`the bound ${bound.rule}`);
    return [this.e.n - minor.rows.length, minor.point];
  }

  /** The rows' kernel is spanned by fields, and involutive. */
  frobenius(claim, minor) {
    const fields = list(claim.fields).map((id) => this.e.field(id));
    const timed = minor.rows.some((r) => r.tree.has("t") || r.tree.has("tdot"));
    refuse(fields.length !== this.e.n + (timed ? 1 : 0) - minor.rows.length, "the fields do not span the kernel");
    if (!timed) refuse(fields.some((x) => x.has("t") && !isZero(x.get("t"))), "a field moves t");
    this.e.tangent(fields, minor.rows);
    this.e.independentAt(fields, claim.columns, minor.point);
    for (let i = 0; i < fields.length; i += 1) {
      for (let j = 0; j < i; j += 1) this.e.tangent([this.e.bracket(fields[i], fields[j])], minor.rows.filter((r) => r.kind === "velocity"));
    }
  }

  least(bound, claim, most) {
    if (bound.rule === "regular") {
      const minor = this.e.minor(bound.minor);
      this.e.account(minor, this.e.relations, claim.covers);
      return [this.e.n - minor.rows.length, minor.point];
    }
    if (bound.rule !== "span") return uncovered(`the bound ${bound.rule}`);
    const { point, vectors, timed } = this.span(bound, this.e.relations, list(bound.words), bound.columns, claim.covers);
    this.parameters(bound.minor, claim.covers, most);
    return [vectors - (timed ? 1 : 0), point];
  }

  /** Fields tangent to rows that account for relations; words whose columns are independent at the point. */
  span(bound, relations, words, columns, covers) {
    const point = this.e.point(bound.at);
    const ids2 = list(bound.fields);
    const fields = ids2.map((id) => this.e.field(id));
    const rows = list(bound.rows).map((id) => this.e.relation(id));
    const all = this.e.closure(ids(this.e.relations), point);
    rows.forEach((r) => {
      this.e.needHolds(r, point);
      refuse(!all.has(r.id), `${r.id} does not follow from the scene`);
    });
    this.e.tangent(fields, rows);
    this.e.account({ rows, point }, relations, covers);
    relations.forEach((r) => this.e.needHolds(r, point));
    const vectors = words.map((w) => {
      refuse(list(w).some((id) => !ids2.includes(id)), "a word is of the fields");
      return this.e.word(w);
    });
    this.e.independentAt(vectors, columns, point);
    const moving = relations.some((r) => r.tree.has("t") || r.tree.has("tdot"));
    const moves = fields.some((x) => x.has("t") && !isZero(x.get("t")));
    if (moving && words.length) refuse(!fields.some((x) => x.has("t") && this.e.at(x.get("t"), point).nonzero), "no field moves t");
    return { point, vectors: vectors.length, timed: moves, moving };
  }

  // -- claims of the whole scene ---------------------------------------------------------------------------

  consistent(claim) {
    if (claim.value === false) return this.nullstellensatz(claim, this.s.relations);
    refuse(claim.value !== true, "a truth value is needed");
    return this.holdsTogether(claim, this.e.relations, this.s.relations.filter((r) => r.kind === "inequality"));
  }

  holdsTogether(claim, relations, inequalities) {
    for (const r of inequalities) {
      const at = claim.inequalities?.[r.id] ?? claim.inequalities?.[r.owner];
      this.strictAt(r, this.e.point(at));
    }
    if (claim.rule === "regular") {
      const minor = this.e.minor(claim.minor);
      this.e.account(minor, relations, claim.covers);
      return { point: minor.point.id };
    }
    refuse(claim.rule !== "point", "another rule");
    const point = this.e.point(claim.at);
    for (const r of relations) {
      refuse(r.kind !== "finite" || r.tree.has("t"), `${r.id} holds velocities or t: what stays may not satisfy it`);
      this.e.needHolds(r, point);
    }
    if (this.hasParameters) {
      const minor = this.e.minor(claim.minor);
      refuse(minor.point !== point, "the minor is at another point");
      this.e.account(minor, relations, claim.covers);
    }
    return { point: point.id };
  }

  strictAt(relation, point) {
    const ball = this.e.at(relation.tree, point);
    if (ball.positive) return;
    const open = relation.tree.functions.size || relation.tree.hasAny(new Set(this.s.signs.keys()));
    const equal = !ball.nonzero && (point.rows.includes(relation.id) || this.e.zeroAt(relation.tree, point));
    refuse(relation.strict || open || !equal, `${relation.id} does not hold`);
  }

  /** What is not 0 by itself would follow from all relations. */
  nullstellensatz(claim, relations) {
    refuse(claim.rule !== "nullstellensatz", "another rule");
    refuse(!this.e.closure(ids(relations), null).has(claim.step), "the step does not follow");
    if (relations.some((r) => r.kind !== "inequality" && !isTotal(r.tree))) uncovered("relations that may have no value somewhere");
    refuse(this.e.relation(claim.step).leaf, "an integral is not 0");
    const tree = substitute(this.e.relation(claim.step).tree, new Map([["tdot", number(1)]]));
    refuse(!nowhereZero(tree, this.s.signs), "what follows may be 0");
    return {};
  }

  conflicting() {
    return uncovered("conflicts");
  }

  feasible(claim) {
    refuse(claim.value !== true, "a truth value is needed");
    const inequalities = this.s.relations.filter((r) => r.kind === "inequality");
    refuse(!inequalities.length, "there are no inequalities");
    const found = this.holdsTogether({ ...claim, inequalities: undefined }, this.e.relations, []);
    for (const r of inequalities) {
      if (r.tree.hasAny(this.s.rates)) uncovered("inequalities of velocities");
      this.strictAt(r, this.e.point(found.point));
    }
    return {};
  }

  freedom(claim, kind) {
    refuse(!whole(claim.value) || claim.value < 0, "a number is needed");
    if (claim.rule === "everywhere") return this.everywhere(claim, kind);
    if (claim.rule === "squeeze") {
      refuse(kind !== "dof", "velocities are not squeezed");
      const most = this.most(claim.most);
      const minor = this.e.minor(claim.most.minor);
      const least = this.least(claim.least, claim, minor);
      refuse(most[1] !== least[1], "the bounds are at two points");
      refuse(most[0] !== claim.value || least[0] !== claim.value, "the bounds are others");
      return { place: this.about(claim, most[1]) };
    }
    if (claim.rule === "regular") {
      const minor = this.e.minor(claim.minor);
      refuse(kind === "dof" && minor.rows.some((r) => r.kind !== "finite"), "all rows are of one kind");
      this.e.account(minor, this.e.relations, claim.covers);
      refuse(this.e.n - minor.rows.length !== claim.value, "the number is another one");
      return { place: this.about(claim, minor.point) };
    }
    refuse(kind !== "velocity_dof" || claim.rule !== "count", "another rule");
    refuse(this.e.relations.some((r) => r.kind === "velocity"), "there are velocity relations");
    const dof = this.before("/dof");
    refuse(claim.about !== undefined && claim.about !== dof.about, "/dof is about other points");
    refuse(dof.value !== claim.value, "/dof is another number");
    return { place: dof.place };
  }

  /** Whether a tree is analytic for all values of the coordinates; parameters are as at a point. */
  total(tree) {
    const fixed = (t) => t.functions.size === 0 && [...t.symbols].every((one) => this.s.signs.has(one));
    return fixed(tree) || isTotal(tree, fixed);
  }

  everywhere(claim, kind) {
    refuse(claim.about !== "everywhere", "about has another value");
    const forms = this.e.relations.filter((r) => r.kind === "velocity");
    const wanted = kind === "dof" ? this.e.relations.filter((r) => r.kind === "finite") : this.e.relations;
    const every = this.e.closure(ids(this.e.relations), null);
    const inScene = (id) => {
      const found = this.e.relation(id);
      refuse(found.leaf || found.assumed || !every.has(id), `${id} does not follow from the scene everywhere`);
      return found;
    };
    const order = pairs(claim.order ?? []).map(([id, q]) => [inScene(id), q]);
    const alone = claim.alone === undefined ? [] : [inScene(claim.alone)];
    const generic = pairs(claim.generic ?? []).map(([id, g]) => [inScene(id), g]);
    const bound = list(claim.gram?.forms ?? []).map(inScene);
    const placed = [...order.map(([r]) => r), ...bound, ...alone, ...generic.map(([r]) => r)];
    refuse(new Set(placed).size < placed.length, "a relation is in two places");
    const all = this.e.closure(ids(placed), null);
    const left = wanted.find((r) => !all.has(r.id));
    refuse(left, `${left?.id} is in no place`);
    const complete = this.e.relations.every((r) => all.has(r.id));
    refuse(placed.some((r) => r.kind === "inequality"), "an inequality is placed");
    refuse(placed.some((r) => r.kind === "velocity" && !this.e.form(r)), "a relation is not linear in velocities");
    const lone = placed.filter((r) => r.kind === "velocity");
    if (bound.length) this.gram(claim.gram, bound, order);
    const minor = claim.minor === undefined ? null : this.e.minor(claim.minor);
    if (minor) this.e.account(minor, placed, claim.covers);
    const steps = order.map(([r, q], i) => {
      refuse(q !== "t" && !this.s.coordinates.includes(q), `${q} is no coordinate`);
      const holds = (o) => o.tree.has(o.kind === "finite" ? q : `${q}dot`);
      refuse(order.slice(0, i).some(([o, p]) => holds(o) || p === q), `${q} occurs before`);
      let slope = r.tree;
      for (let often = 1; often <= (r.kind === "finite" ? 4 : 1); often++) {
        slope = derivative(slope, r.kind === "finite" ? q : `${q}dot`);
        const plain = [...slope.symbols].every((one) => this.s.signs.has(one)) && !slope.functions.size;
        const sure = this.e.constantNotZero(slope) || (plain && minor && isTotal(slope) && this.e.at(slope, minor.point).nonzero);
        if (sure) return often;
      }
      return refuse(true, `${r.id} does not give ${q}`);
    });
    const graph = steps.every((often) => often === 1) && !generic.length;
    // a relation that is linear in what it gives has a solution for all values of the others: the graph is one part
    const joined = !graph || order.every(([r, q]) => r.kind !== "finite" || !derivative(r.tree, q).has(q));
    refuse(alone.length && !(graph && lone.every((r) => r === alone[0])), "what is alone is beside a graph");
    const nothingElse = graph && !alone.length && !forms.length && minor;
    refuse(order.some(([, q]) => q === "t") && !nothingElse, "t is given beside others");
    const proper = graph && alone.every((r) => r.kind === "velocity");
    refuse((lone.length || kind === "velocity_dof") && !proper, "velocity relations need a graph");
    if (!graph || alone.length) {
      refuse(!minor, "a minor is needed");
      refuse(!joined, "the graph may have several parts");
      if (!placed.every((r) => this.total(r.tree))) uncovered("a relation whose analyticity is not told by its form");
    }
    for (const [r, g] of generic) {
      refuse(!this.s.signs.has(g) && !this.s.generic.includes(g), `${g} is no parameter`);
      refuse(!r.tree.has(g) || this.e.relations.some((o) => o !== r && o.tree.has(g)), `${g} is no symbol of its own`);
      if (!this.e.constantNotZero(derivative(r.tree, g))) uncovered("a generic relation with another dependence");
    }
    let rank = placed.length;
    if (minor) {
      refuse(minor.rows.length > placed.length, "more rows than relations");
      if (minor.rows.length < placed.length) {
        refuse(list(claim.covers ?? []).length !== 1, "the minor has another number of rows");
        refuse(this.e.cover(claim.covers[0]).rows.length !== placed.length, "a cover of all is needed");
        refuse(!placed.every((r) => this.e.cover(claim.covers[0]).rows.includes(r.id)), "a cover of all is needed");
      }
      rank = minor.rows.length;
    } else {
      refuse(!joined, "the graph may be empty");
      if (!placed.every((r) => this.total(r.tree))) uncovered("relations that may have no value");
    }
    if (kind === "dof" && forms.length) {
      const most = this.most(claim.most ?? {});
      const least = this.least(claim.least ?? {}, claim, this.e.minor(claim.most.minor));
      refuse(most[1] !== least[1], "the bounds are at two points");
      refuse(most[0] !== claim.value || least[0] !== claim.value, "the bounds are others");
      const finite = this.e.n - rank + lone.length;
      refuse(claim.value !== finite && !joined, "another part may be larger");
      if (claim.value !== finite && !(complete && proper && placed.every((r) => this.total(r.tree)))) uncovered("another part may be larger");
      return { place: this.place(most[1]) };
    }
    refuse(this.e.n - rank !== claim.value, "the number is another one");
    return { place: minor && this.place(minor.point) };
  }

  /** Forms are independent everywhere: det(J D J^T) is as told, and positive by itself. */
  gram(told, forms, order) {
    refuse(forms.some((r) => r.kind !== "velocity"), "a relation is no form");
    refuse(forms.some((r) => order.some(([, q]) => r.tree.has(`${q}dot`))), "a form holds a velocity that is given");
    refuse(forms.length > 6, "there are too many forms");
    const scales = new Map(Object.entries(told.scales ?? {}).map(([q, text]) => [q, this.e.text(text)]));
    const value = this.e.text(told.value);
    refuse(![value, ...scales.values()].every((tree) => nowhereZero(tree, this.s.signs, true)), "it is not positive by itself");
    const rows = forms.map((r) => this.s.coordinates.map((q) => this.e.slope(r, q)));
    const entry = (a, b) => add(...this.s.coordinates.map((q, k) => mul(scales.get(q) ?? number(1), a[k], b[k])));
    const determinant = (m) =>
      m.length ? add(...m[0].map((x, j) => mul(number(j % 2 ? -1 : 1), x, determinant(m.slice(1).map((row) => row.filter((_, k) => k !== j)))))) : number(1);
    refuse(!isZero(sub(determinant(rows.map((a) => rows.map((b) => entry(a, b)))), value)), "the determinant is another one");
  }

  instantaneous(claim) {
    refuse(claim.rule !== "rank" || !whole(claim.value), "another rule");
    const point = this.e.point(claim.at);
    refuse(this.place(point) !== "reference", "there is no reference configuration");
    if (claim.minor !== undefined) {
      const minor = this.e.minor(claim.minor);
      refuse(minor.point !== point, "the minor is at another point");
      refuse(!same(ids(minor.rows).sort(), ids(this.e.relations).sort()), "the rows are not all relations");
      refuse(this.e.n - minor.rows.length !== claim.value, "the number is another one");
      return {};
    }
    const rows = this.e.relations.map((r) => {
      this.e.needHolds(r, point);
      return this.s.coordinates.map((q) => {
        const slope = this.e.slope(r, q);
        this.e.at(slope, point);
        return rational(substitute(substitute(slope, new Map(), point.functions), point.exact)) ?? uncovered("rows that are not rational");
      });
    });
    refuse(this.e.n - rankOf(rows) !== claim.value, "the rank is another one");
    return {};
  }

  singular(claim) {
    refuse(claim.rule !== "count", "another rule");
    const velocity = this.before("/velocity_dof");
    refuse(claim.value !== (this.before("/instantaneous_dof").value !== velocity.value), "the numbers say otherwise");
    return {};
  }

  /** Of all constraints: true where it is so of each, false where it is not so of one. */
  allOf(claim, field) {
    refuse(claim.rule !== "count", "another rule");
    const found = this.s.owners.map((name) => this.verified.get(`/constraints/${escaped(name)}/${field}`));
    if (claim.value === false) {
      if (found.some((one) => one?.value === false && !one.uncovered)) return {};
      if (found.some((one) => one?.uncovered)) uncovered("an entry is not covered");
      refuse(true, "no entry says so");
    }
    refuse(claim.value !== true || found.some((one) => !one || (one.value !== true && !one.uncovered)), "an entry says otherwise");
    if (found.some((one) => one.uncovered)) uncovered("an entry is not covered");
    return {};
  }

  get surplus() {
    return Math.max(0, this.e.relations.length - (this.e.n - this.before("/velocity_dof").value));
  }

  redundantEquations(claim) {
    refuse(claim.rule !== "count" || claim.value !== this.surplus, "the number is another one");
    return {};
  }

  redundancies(claim) {
    refuse(claim.rule !== "count", "another rule");
    const surplus = this.before("/redundant_equations").value;
    const owners = this.s.owners.filter((o) => this.e.relations.some((r) => r.owner === o));
    if (surplus === 0) refuse(!same(claim.value, []), "nothing is redundant");
    else if (owners.length === 1) refuse(!same(claim.value, [{ nullity: surplus, members: owners }]), "it is one constraint");
    else {
      if (claim.of !== undefined) {
        const value = list(claim.value?.[0]?.members).filter((name) => name !== claim.of);
        const equations = this.e.relations.filter((r) => r.owner === claim.of);
        const { place } = this.circuit({ ...claim, rule: "cofactors", value }, claim.of, equations, false);
        this.verified.set(`/constraints/${escaped(claim.of)}/circuit`, { value, place });
      }
      const members = this.redundantTogether(surplus, owners);
      refuse(!same(claim.value, [{ nullity: surplus, members }]), "the groups are others");
    }
    return {};
  }

  /** The one group of constraints whose equations are redundant together. */
  redundantTogether(surplus, owners) {
    const redundant = this.before("/redundant");
    if (redundant.apart) return owners;
    const circuits = owners.filter((o) => this.verified.get(`/constraints/${escaped(o)}/circuit`));
    if (surplus !== 1 || circuits.length !== 1) uncovered("redundancies between constraints");
    const circuit = this.before(`/constraints/${escaped(circuits[0])}/circuit`);
    refuse(circuit.place !== redundant.place, "the circuit is at another point");
    return owners.filter((o) => o === circuits[0] || circuit.value.includes(o));
  }

  redundant(claim) {
    refuse(claim.rule !== "cofactors", "another rule");
    const value = list(claim.value);
    const owners = this.s.owners.filter((o) => this.e.relations.some((r) => r.owner === o));
    if (claim.without !== undefined) {
      refuse(value.length, "it names none");
      const number = this.e.relations.some((r) => r.kind === "velocity") ? "/velocity_dof" : "/dof";
      let apart = true;
      for (const name of owners) {
        const dof = this.before(number);
        const other = this.e.minor(claim.without[name]);
        this.sameplace(dof, other.point);
        const others = this.e.relations.filter((r) => r.owner !== name);
        this.e.account(other, others, claim.covers);
        this.meets(other.point);
        apart &&= same(ids(other.rows).sort(), ids(others).sort());
        refuse(this.e.n - dof.value <= other.rows.length, "without one, the others are as large");
      }
      return { apart };
    }
    const minor = this.e.minor(claim.minor);
    this.e.account(minor, this.e.relations, claim.covers);
    refuse(minor.rows.some((r) => !this.s.byId.has(r.id)), "rows are of the scene");
    refuse(new Set(value).size < value.length || value.some((name) => !owners.includes(name)), "these are no constraints");
    const [dropped, kept] = [true, false].map((named) => this.e.relations.filter((r) => value.includes(r.owner) === named));
    this.e.account({ rows: kept, point: minor.point }, dropped, claim.covers, false);
    this.dependPlainly(minor, claim);
    const place = this.place(minor.point);
    // of E equations with r independent rows E - r can be spared: so many constraints at most
    const spared = this.e.relations.length - minor.rows.length;
    const sizes = owners.map((o) => this.e.relations.filter((r) => r.owner === o).length).sort((a, b) => a - b);
    let [most, sum] = [0, 0];
    for (const size of sizes) {
      sum += size;
      if (sum <= spared) most += 1;
    }
    refuse(value.length !== most, `${most} constraints might be dropped`);
    return { place };
  }

  /** What is no row depends on rows by numbers, or is one with cofactors that are not 0, or all ranks are constant. */
  dependPlainly(minor, claim) {
    const others = this.e.relations.filter((r) => !minor.rows.includes(r));
    const linear = (r) => this.s.coordinates.every((q) => this.numeric(derivative(r.tree, q)));
    const general = (r) => linear(r) || this.s.generic.some((g) => r.tree.has(g) && this.e.relations.every((o) => o === r || !o.tree.has(g)));
    if (this.e.relations.every((r) => r.kind === "finite" && general(r))) return;
    const rows = new Set(ids(minor.rows));
    for (const s of this.e.order) if (s.by === "rate" && rows.has(s.of)) rows.add(s.id);
    for (const other of others) {
      const steps = this.e.order.filter((s) => s.by === "implied" && s.of === other.id && Object.keys(s.c ?? {}).every((id) => rows.has(id)));
      const plain = steps.filter((s) => !s.put && !s.sos && (s.power ?? 1) === 1 && this.e.usable(s, rows, minor.point));
      const texts = plain.map((s) => [s.h ?? "1", ...Object.values(s.c)].map((text) => this.e.text(text)));
      const numbers = texts.some((all) => all.every((text) => text.symbols.size === 0));
      const single = others.length === 1 && texts.some((all) => all.every((text) => this.e.at(text, minor.point).nonzero));
      if (!numbers && !single && steps.length > plain.length) uncovered("a redundant equation by other steps");
      refuse(!numbers && !single, `${other.id} does not depend on the rows by numbers`);
    }
  }

  numeric(tree) {
    return tree.symbols.size === 0 ? true : [...tree.symbols].every((one) => isZero(derivative(tree, one)));
  }

  coordinates(claim) {
    const value = list(claim.value);
    const dof = this.before("/dof");
    if (claim.rule === "count") {
      refuse(value.length || dof.value !== 0, "coordinates are needed: dof is not 0");
      return {};
    }
    const minor = this.e.minor(claim.minor);
    refuse(value.length !== dof.value || new Set(value).size < value.length, "as many coordinates as dof are needed");
    if (claim.rule === "minor") refuse(minor.rows.some((r) => r.kind !== "finite"), "all rows are finite or integrals");
    else if (claim.rule === "frobenius") this.frobenius(claim, minor);
    else if (claim.rule === "isolated") uncovered("what is isolated");
    else refuse(true, "another rule");
    const standsFor = new Map();
    for (const [body, [phi, theta, psi]] of this.s.angles) {
      const third = [phi, theta, psi].every((q) => value.includes(q)) ? "b" : "c";
      [[phi, "c"], [theta, "a"], [psi, third]].forEach(([q, g]) => standsFor.set(q, `${body}_${g}`));
    }
    const moved = value.map((q) => standsFor.get(q) ?? q);
    refuse(new Set(moved).size < moved.length, "two angles turn about one axis");
    const rest = this.s.coordinates.filter((q) => !moved.includes(q));
    refuse(!moved.every((q) => this.s.coordinates.includes(q)), "there is no such coordinate");
    refuse(!value.every((q) => this.s.written.includes(q)), "it is no coordinate of the scene");
    refuse(rest.length !== minor.columns.length || !rest.every((q) => minor.columns.includes(q)), "the columns are others");
    this.e.relations.filter((r) => r.kind === "finite").forEach((r) => this.e.needHolds(r, minor.point));
    this.sameplace(dof, minor.point);
    return {};
  }

  integrablePart(claim) {
    refuse(claim.rule !== "integrals", "another rule");
    refuse(!this.e.relations.some((r) => r.kind === "velocity"), "an integrable part is of forms");
    const dof = this.before("/dof");
    refuse(claim.value?.rank !== this.e.n - dof.value || Object.keys(claim.value).length !== 2, "the rank is another one");
    if (claim.value.basis === null) return {};
    const minor = this.e.minor(claim.minor);
    refuse(minor.rows.some((r) => r.kind !== "finite"), "rows are finite or integrals");
    this.sameplace(dof, minor.point);
    refuse(minor.rows.length !== claim.value.rank, "the rank is another one");
    const basis = list(claim.value.basis);
    const leaves = minor.rows.filter((r) => r.leaf);
    refuse(basis.length !== leaves.length || !same(ids(leaves).sort(), [...list(claim.steps)].sort()), "the basis is another one");
    basis.forEach((text, i) => {
      refuse(!this.isConstant(text, this.e.relation(claim.steps[i]), minor.point), "a text of the basis is another function");
    });
    return {};
  }

  /** Whether `function = C` writes the function of a step, with a value at a point. */
  isConstant(text, relation, point) {
    const match = /^([^]*)=\s*([A-Za-z_][A-Za-z0-9_]*)\s*$/.exec(text);
    if (match) this.e.at(this.e.text(match[1].trim()), point);
    return Boolean(match) && !this.s.isTaken(match[2]) && isZero(sub(this.e.text(match[1].trim()), relation.tree));
  }

  growth(claim) {
    refuse(claim.rule !== "span", "another rule");
    const forms = this.e.relations.filter((r) => r.kind === "velocity");
    refuse(!forms.length, "a growth vector is of forms");
    const value = list(claim.value);
    const spans = list(claim.spans);
    refuse(value.length !== spans.length || !value.length || !value.every(whole), "a span for each entry is needed");
    const dof = this.before("/dof");
    const minor = this.e.minor(claim.minor);
    this.e.account(minor, this.e.relations, claim.covers);
    this.sameplace(dof, minor.point);
    refuse(minor.point.id !== claim.at, "the minor is at another point");
    refuse(minor.rows.some((r) => !this.e.form(r)), "a growth vector is of forms");
    let moving = false;
    spans.forEach((span, i) => {
      const found = this.span({ ...span, at: claim.at, fields: claim.fields, rows: claim.rows }, this.e.relations, list(span.words), span.columns, claim.covers);
      refuse(span.words.some((w) => w.length > i + 1), "a word is too long");
      refuse(found.vectors !== value[i], "a span has another number");
      ({ moving } = found);
    });
    if (moving) {
      const labels = this.s.owners.flatMap((o) => ["scleronomic", "catastatic"].map((k) => this.verified.get(`/constraints/${escaped(o)}/${k}`)));
      if (labels.some((one) => one?.uncovered)) uncovered("a label of time");
      refuse(!labels.some((one) => one?.value === false), "no label says that time occurs");
    }
    const fields = this.e.n + (moving ? 1 : 0) - minor.rows.length;
    const last = dof.value + (moving ? 1 : 0);
    value.forEach((entry, k) => {
      const most = Math.min(last, [fields, (fields * (fields + 1)) / 2, last][Math.min(k, 2)]);
      refuse(entry !== most, "an entry is not the largest that its words allow");
    });
    refuse(value.at(-1) !== last && (value.length < 2 || value.at(-1) !== value.at(-2)), "the last entry is not the whole");
    return {};
  }

  // -- claims of one constraint ------------------------------------------------------------------------------

  constraint(claim, name, field) {
    const own = this.owned(name);
    refuse(!own.length, `${name} has no relations`);
    const equations = own.filter((r) => r.kind !== "inequality");
    if (field === "holonomic" || field === "holonomic_alone") return this.holonomic(claim, own, equations, field === "holonomic_alone" || claim.alone === true);
    if (field === "scleronomic" || field === "catastatic") return this.timeLabel(claim, name, own, field);
    if (field === "exact") return this.exact(claim, equations);
    if (field === "independent") return this.independent(claim, name, own, equations);
    if (field === "integral") return this.integral(claim, equations);
    if (field === "circuit") return this.circuit(claim, name, equations);
    return uncovered(`claims of ${field}`);
  }

  holonomic(claim, own, equations, alone) {
    refuse(typeof claim.value !== "boolean", "a truth value is needed");
    const relations = alone ? equations : this.e.relations;
    const { rule } = claim;
    if (rule === "inequality") refuse(claim.value || equations.length, "it has equations");
    else if (rule === "finite") {
      refuse(!claim.value || own.some((r) => r.kind !== "finite"), "a relation is not finite");
    } else if (rule === "frobenius") {
      refuse(!claim.value || equations.length < own.length, "the rule proves true");
      const minor = this.e.minor(claim.minor);
      if (!alone) this.place(minor.point);
      const all = this.e.closure(ids(relations), minor.point);
      refuse(minor.rows.some((r) => !all.has(r.id)), "a row does not follow from its relations");
      relations.filter((r) => r.kind === "finite").forEach((r) => this.e.needHolds(r, minor.point));
      this.frobenius(claim, minor);
      this.e.account(minor, equations, claim.covers, false);
    } else if (rule === "integral") {
      refuse(!claim.value || equations.length < own.length, "the rule proves true");
      const point = this.e.point(claim.at);
      if (!alone) this.place(point);
      const integrals = list(claim.integrals).map((id) => this.e.relation(id));
      refuse(integrals.some((r) => !r.leaf), "integrals are steps");
      const all = this.e.closure(ids(relations), point);
      refuse(integrals.some((r) => !all.has(r.id)), "an integral does not follow from its relations");
      const found = this.e.closure([...ids(relations.filter((r) => r.kind === "finite")), ...ids(integrals)], point);
      refuse(equations.some((r) => !found.has(r.id)), "a relation does not follow from integrals");
      if (!alone) this.e.relations.filter((r) => r.kind === "finite").forEach((r) => this.e.needHolds(r, point));
    } else if (rule === "bracket") {
      refuse(claim.value, "the rule proves false");
      const pairs = this.e.relation(claim.pairs);
      const given = [...equations, ...(alone ? [] : relations.filter((r) => r.kind === "finite"))];
      const follows = this.e.closure(ids(given), this.e.point(claim.at)).has(pairs.id);
      refuse(pairs.kind !== "velocity" || !follows, "pairs is a velocity relation that follows from the constraint");
      const columns = list(claim.fields).length;
      refuse(!columns, "fields are needed");
      const { point } = this.span({ ...claim, columns: [] }, relations, [], [], claim.covers);
      if (!alone) this.place(point);
      refuse(list(claim.word).some((id) => !claim.fields.includes(id)), "a word is of the fields");
      const value = this.e.pairing(pairs, this.e.word(claim.word));
      refuse(!this.e.at(value, point).nonzero, "the bracket may be tangent");
      if (!alone) this.parameters(claim.minor, claim.covers, null);
      else if (equations.some((r) => r.kind === "finite") && this.hasParameters) this.parameters(claim.minor, claim.covers, null, equations);
    } else if (rule === "curved") uncovered("curved velocities");
    else refuse(true, "another rule");
    return {};
  }

  timeLabel(claim, name, own, field) {
    if (claim.rule === "timeless") {
      refuse(claim.value !== true, "the rule proves true");
      refuse(field === "catastatic" && !own.some((r) => r.kind === "velocity"), "there are no velocities");
      const equations = own.filter((r) => r.kind !== "inequality");
      const ones = field === "catastatic" ? equations : own;
      const alone = field === "scleronomic" && own.length === 1 && this.verified.get(`/constraints/${escaped(name)}/holonomic`);
      if (alone?.uncovered) uncovered("a label of the constraint");
      const factor = this.e.text(claim.factor ?? "1");
      refuse(!nowhereZero(factor, this.s.signs) || factor.hasAny(this.s.rates), "the factor may be 0, or holds velocities");
      const names = field === "catastatic" ? ["tdot"] : alone?.value === false ? ["t"] : ["t", "tdot"];
      for (const r of ones) {
        if (r.kind === "velocity" && !this.e.form(r)) uncovered("velocities that are not linear");
        refuse(names.some((t) => !isZero(derivative(mul(r.tree, tr.inverse(factor)), t))), "time occurs");
      }
      return {};
    }
    refuse(claim.rule !== "time-dependent" || claim.value !== false, "another rule");
    const point = this.e.point(claim.at);
    const r = own.find((one) => one.id === claim.relation);
    refuse(!r, "the relation is not of the constraint");
    refuse(own.length > 1 && own.some((one) => one.kind !== "finite"), "one relation, or finite ones, are needed");
    if (r.kind !== "velocity") {
      refuse(field === "catastatic", "it holds no velocities");
      if (r.kind === "finite") own.forEach((one) => this.e.needHolds(one, point));
      else this.e.needHolds(r, point);
      const slopes = [...r.tree.symbols].filter((q) => this.s.coordinates.includes(q)).map((q) => this.e.at(derivative(r.tree, q), point));
      refuse(r.kind === "finite" && !slopes.some((x) => x.nonzero), "the relation may be stationary");
      refuse(!this.e.at(derivative(r.tree, "t"), point).nonzero, "time may not enter");
      return {};
    }
    const form = this.e.form(r) ?? uncovered("velocities that are not linear");
    if (field === "catastatic") {
      refuse(!this.e.at(form.get("t"), point).nonzero, "the coefficient of tdot may be 0");
      return {};
    }
    if (claim.pair !== undefined) {
      const [[x, y]] = pairs([claim.pair]);
      refuse(!form.has(x) || !form.has(y), "two names are needed");
      const [a, b] = [form.get(x), form.get(y)];
      refuse(!this.e.at(sub(mul(a, derivative(b, "t")), mul(b, derivative(a, "t"))), point).nonzero, "the pair may be 0");
      return {};
    }
    const alone = this.verified.get(`/constraints/${escaped(name)}/holonomic_alone`);
    if (alone?.uncovered) uncovered("a label of the constraint alone");
    refuse(alone?.value !== true, "it is not shown to integrate");
    refuse(!this.e.at(form.get("t"), point).nonzero, "the coefficient of tdot may be 0");
    return {};
  }

  exact(claim, equations) {
    refuse(claim.cayley === true, "with Cayley parameters forms stand times a factor");
    const forms = equations.filter((r) => r.kind === "velocity");
    refuse(!forms.length, "there is no form");
    const all = forms.map((r) => this.e.form(r) ?? refuse(true, "it is not linear in velocities"));
    if (claim.rule === "exact") {
      refuse(claim.value !== true, "the rule proves true");
      const names = [...this.s.coordinates, "t"];
      for (const form of all) names.forEach((x, i) => names.slice(0, i).forEach((y) => refuse(!isZero(curl(form, x, y)), "a form is not closed")));
      return {};
    }
    refuse(claim.rule !== "not exact" || claim.value !== false, "another rule");
    const index = claim.relation === undefined ? 0 : forms.findIndex((r) => r.id === claim.relation);
    refuse(index < 0 || (claim.relation === undefined && forms.length > 1), "a form of the constraint is needed");
    const [[x, y]] = pairs([claim.pair]);
    refuse(!all[index].has(x) || !all[index].has(y), "two names are needed");
    refuse(!this.e.at(curl(all[index], x, y), this.e.point(claim.at)).nonzero, "the form may be closed");
    return {};
  }

  independent(claim, name, own, equations) {
    refuse(!whole(claim.value), "a number is needed");
    if (claim.rule === "inequality") {
      refuse(claim.value !== 0 || equations.length, "it has equations");
      return {};
    }
    refuse(claim.rule !== "independent", "another rule");
    refuse(!equations.length, "it has no equations");
    const minor = this.e.minor(claim.minor);
    this.place(minor.point);
    this.meets(minor.point);
    const order = [...this.e.relations].sort((x, y) => (x.kind === "velocity") - (y.kind === "velocity") || x.place - y.place);
    let added = 0;
    for (const kind of ["finite", "velocity"]) {
      const mine = order.filter((r) => r.owner === name && r.kind === kind);
      if (!mine.length) continue;
      const start = order.indexOf(mine[0]);
      const [before, upTo] = [order.slice(0, start), order.slice(0, start + mine.length)];
      const dof = claim.last !== undefined && upTo.length === order.length && kind === "finite" ? this.before("/dof") : null;
      if (dof) this.sameplace(dof, minor.point);
      const after = dof ? this.e.n - dof.value : this.rank(minor, upTo, claim.covers);
      added += Math.min(mine.length, after - this.rank(minor, before, claim.covers));
    }
    refuse(added !== claim.value, "the number is another one");
    return {};
  }

  /** How many rows of a minor follow from relations, which follow from them in turn. */
  rank(minor, relations, covers) {
    const known = this.e.closure(ids(relations), minor.point, covers ?? []);
    const rows = minor.rows.filter((r) => known.has(r.id) && !r.leaf);
    this.e.account({ rows, point: minor.point }, relations, covers);
    return rows.length;
  }

  integral(claim, equations) {
    refuse(claim.rule !== "integral" || typeof claim.value !== "string", "another rule");
    if (claim.integrals !== undefined || claim.minor !== undefined) uncovered("an integral beside others");
    const point = this.e.point(claim.at);
    this.place(point);
    const step = this.e.relation(claim.step);
    refuse(!step.leaf, "an integral is a step");
    refuse(!equations.some((r) => r.kind === "velocity"), "a finite relation has no integral");
    const before = [...equations, ...this.e.relations.filter((r) => r.kind === "finite")];
    refuse(!this.e.closure(ids(before), point).has(step.id), "the integral does not follow from the constraint");
    refuse(!this.isConstant(claim.value, step, point), "the value is another function");
    if (equations.length !== 1) {
      const forms = equations.filter((r) => r.kind === "velocity");
      if (forms.length !== 1) uncovered("an integral of several forms");
    }
    const finite = this.e.relations.filter((r) => r.kind === "finite");
    finite.forEach((r) => this.e.needHolds(r, point));
    const found = this.e.closure([step.id, ...ids(finite)], point);
    refuse(equations.some((r) => !found.has(r.id)), "the relation does not follow from the integral's rate");
    return {};
  }

  circuit(claim, name, equations, ordered = true) {
    refuse(claim.rule !== "cofactors", "another rule");
    const point = this.e.point(claim.at);
    const place = this.place(point);
    const members = list(claim.value);
    const written = (o) => this.s.owners.indexOf(o);
    refuse(!equations.length, "the constraint has no equations");
    refuse(members.some((m) => written(m) < 0 || (ordered && written(m) >= written(name))), "a circuit holds constraints written before");
    refuse(members.includes(name) || new Set(members).size < members.length, "members are other constraints");
    const all = members.flatMap((m) => this.owned(m).filter((r) => r.kind !== "inequality"));
    const met = this.e.relations.filter((r) => r.kind === "finite" || all.includes(r) || equations.includes(r));
    met.forEach((r) => this.e.needHolds(r, point));
    this.e.account({ rows: all, point }, equations, claim.covers);
    refuse(!same(Object.keys(claim.minimal ?? {}).sort(), [...members].sort()), "each member needs a minor");
    for (const m of members) {
      const minor = this.e.minor(claim.minimal[m].minor);
      refuse(minor.point !== point, "a minor is at another point");
      const others = all.filter((r) => r.owner !== m);
      const known = this.e.closure(ids([...others, ...equations]), point);
      refuse(minor.rows.some((r) => !known.has(r.id)), "rows are of the other members, and its own");
      refuse(this.rank(minor, others, claim.covers) >= minor.rows.length, "no row is independent of the other members");
    }
    return { place };
  }
}

const escaped = (name) => name.replaceAll("~", "~0").replaceAll("/", "~1");
const unescaped = (name) => name.replaceAll("~1", "/").replaceAll("~0", "~");

/** The rank of a matrix of rationals. */
function rankOf(rows) {
  const m = rows.map((row) => [...row]);
  let rank = 0;
  for (let j = 0; j < (m[0]?.length ?? 0) && rank < m.length; j += 1) {
    const k = m.findIndex((row, i) => i >= rank && row[j].sign);
    if (k < 0) continue;
    [m[rank], m[k]] = [m[k], m[rank]];
    for (let i = rank + 1; i < m.length; i += 1) {
      if (!m[i][j].sign) continue;
      const factor = m[i][j].div(m[rank][j]);
      m[i] = m[i].map((x, c) => x.sub(factor.mul(m[rank][c])));
    }
    rank += 1;
  }
  return rank;
}

/** Checks one claim by its path. */
export function check(rules, claim) {
  const local = /^\/(singular|holonomic|scleronomic)$|^\/constraints\//.test(claim.path);
  const wide = claim.about === "everywhere" || claim.path === "/conflicting" || claim.value === false;
  refuse(claim.cayley === true && wide && !local, "Cayley parameters are a chart of a part");
  refuse("about" in claim && !["/dof", "/velocity_dof"].includes(claim.path), "a spare about");
  for (const id of claim.covers ?? []) rules.e.cover(id);
  const parts = String(claim.path).split("/");
  const ofKind = ["finite", "inequality", "timeless", "count"].includes(claim.rule);
  refuse("tolerance" in rules.s.document && !ofKind, "what is measured up to a tolerance is not proved");
  if (rules.s.unread.length) uncovered("a constraint of a type that is not known");
  if (parts.length === 4 && parts[1] === "constraints") return rules.constraint(claim, unescaped(parts[2]), parts[3]);
  refuse(parts.length !== 2, "there is no such path");
  switch (parts[1]) {
    case "consistent":
      return rules.consistent(claim);
    case "conflicting":
      return rules.conflicting(claim);
    case "feasible":
      return rules.feasible(claim);
    case "dof":
    case "velocity_dof":
      return rules.freedom(claim, parts[1]);
    case "instantaneous_dof":
      return rules.instantaneous(claim);
    case "singular":
      return rules.singular(claim);
    case "holonomic":
    case "scleronomic":
      return rules.allOf(claim, parts[1]);
    case "redundant_equations":
      return rules.redundantEquations(claim);
    case "redundancies":
      return rules.redundancies(claim);
    case "redundant":
      return rules.redundant(claim);
    case "generalized_coordinates":
      return rules.coordinates(claim);
    case "integrable_part":
      return rules.integrablePart(claim);
    case "growth_vector":
      return rules.growth(claim);
    default:
      return uncovered(`claims of ${parts[1]}`);
  }
}
