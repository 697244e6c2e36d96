// The grammar of texts: relations and values as people write them, read into trees.

import { NotCovered, Rational, refuse } from "./numbers.mjs";
import * as tr from "./trees.mjs";
import { add, call, mul, neg, number, pow, symbol } from "./trees.mjs";

export const FUNCTIONS = "sin cos tan cot sec csc asin acos atan atan2 sinh cosh tanh exp log sqrt abs".split(" ");
const LATIN =
  "alpha beta gamma delta epsilon zeta eta theta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi phi " +
  "chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega";
const GREEK = Object.fromEntries([..."αβγδεζηθϑικλμνξπρστυφϕχψωΓΔΘΛΞΠΣΦΨΩ"].map((c, i) => [c, LATIN.split(" ")[i]]));
const DOT = "\u0307";
const PLAIN = { "−": "-", "–": "-", "·": "*", "⋅": "*", "×": "*", "′": "'", "’": "'" };
[..."ȧḃċḋėḟġḣṁṅȯṗṙṡṫẇẋẏż"].forEach((c, i) => (PLAIN[c] = "abcdefghmnoprstwxyz"[i] + DOT));
const LETTERS = `A-Za-z${Object.keys(GREEK).join("")}`;
const TOKEN = new RegExp(
  `([ \\t\\u00a0\\u2009]*)(?:(?<word>[${LETTERS}][${LETTERS}0-9_${DOT}']*)` +
    "|(?<number>(?:[0-9]+\\.?[0-9]*|\\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?)" +
    "|(?<relation>[<>]=?|==?|[≤≥])|(?<sign>\\*\\*|[-+*/^(),])" +
    "|(?<raised>[²³])(?! *(?:[²³^]|\\*\\*))|(?<unknown>[^]))",
  "gy",
);
const BEGINNING = new Set(["value", "moving", "function", "declared", "("]);

export const spelledOut = (name) => [...name].map((c) => GREEK[c] ?? c).join("");
const own = (table, key) => (Object.hasOwn(table, key) ? table[key] : undefined);

/** What a text may mention: coordinates (a Set), values (Map of trees), functions (Map of lists of arguments). */
export class Names {
  constructor(coordinates = new Set(), values = new Map(), functions = new Map()) {
    Object.assign(this, { coordinates, values, functions });
    this.words = new Map(FUNCTIONS.map((name) => [name, { kind: "function", name }]));
    this.words.set("pi", { kind: "value", tree: tr.pi() }).set("t", { kind: "value", tree: symbol("t"), name: "t" });
    this.words.set("diff", { kind: "function", name: "diff" });
    this.words.set("dt", { kind: "moving", tree: symbol("dt"), step: true });
    for (const q of coordinates) this.words.set(spelledOut(q), { kind: "value", tree: symbol(q), name: q });
    for (const [p, tree] of values) this.words.set(spelledOut(p), { kind: "value", tree, name: p });
    for (const [f, args] of functions) {
      for (let k = 0; k <= (args.length === 1 ? 6 : 0); k += 1) {
        const orders = args.map(() => k);
        this.words.set(spelledOut(f) + "'".repeat(k), { kind: "declared", name: f, orders });
      }
    }
  }

  /** The velocity or differential of a coordinate; an index stands after the dot or before it. */
  moved(word) {
    const patterns = [
      [new RegExp(`^(.+?)(?:_?dot|['${DOT}])([_0-9].*)?$`), false],
      [/^d(.+)$/, true],
    ];
    for (const [pattern, differential] of patterns) {
      const match = pattern.exec(word);
      const base = match && this.words.get(match[1] + (match[2] ?? ""));
      if (base && this.coordinates.has(base.name)) {
        const rate = symbol(`${base.name}dot`);
        return { kind: word.includes("'") ? "value" : "moving", tree: differential ? mul(rate, symbol("dt")) : rate };
      }
    }
    return undefined;
  }

  meaning(written) {
    const word = spelledOut(written);
    const found = this.words.get(word) ?? this.moved(word);
    if (found) return found;
    refuse(word !== "E", `${word} is not declared`);
    return { kind: "value", tree: call("exp", number(1)), euler: true };
  }
}

/** Whether a tree may have no value somewhere. */
function isPartial(tree) {
  const whole = tree.head === "power" && tr.isNumber(tree.args[1]) && tree.args[1].value.whole && tree.args[1].value.sign > 0;
  const total = whole || ["number", "pi", "symbol", "sum", "product", "apply"].includes(tree.head);
  return !(total || ["exp", "sin", "cos"].includes(tree.value)) || tree.args.some(isPartial);
}

function tokensOf(text, names) {
  refuse(typeof text !== "string" && !Number.isInteger(text), "a text is needed");
  const plain = [...String(text).trim()].map((c) => own(PLAIN, c) ?? c).join("");
  refuse(plain.length > 20000, "a text is too long");
  const found = [];
  for (const match of plain.matchAll(TOKEN)) {
    const { word, number: digits, relation, sign, raised } = match.groups;
    const touching = match[1] === "";
    if (word) found.push({ ...names.meaning(word), touching });
    else if (digits) {
      const taken = [..."eE"].some((c) => digits.includes(c) && names.words.has(c));
      refuse(taken, `${digits} may be a power of ten`);
      found.push({ kind: "number", tree: number(Rational.decimal(digits)), touching });
    } else if (raised) found.push({ kind: "^" }, { kind: "number", tree: number(raised === "²" ? 2 : 3) });
    else if (relation) found.push({ kind: "relation", name: relation, touching });
    else {
      refuse(!sign, `${match.groups.unknown} cannot be read`);
      found.push({ kind: sign === "**" ? "^" : sign, touching });
    }
  }
  return [...found, { kind: "end" }];
}

class Reader {
  constructor(text, names) {
    this.names = names;
    this.tokens = tokensOf(text, names);
    this.at = 0;
    this.depth = 0;
  }

  get next() {
    return this.tokens[this.at];
  }

  take(...kinds) {
    if (!kinds.includes(this.next.kind)) return undefined;
    this.at += 1;
    return this.tokens[this.at - 1];
  }

  need(...kinds) {
    const found = this.take(...kinds);
    refuse(!found, `${this.tokens[Math.min(this.at, this.tokens.length - 1)].kind} cannot stand here`);
    return found;
  }

  sum() {
    const terms = [this.term()];
    while (["+", "-"].includes(this.next.kind)) terms.push(this.term());
    return add(...terms);
  }

  term() {
    const factors = [this.factor()];
    let quotient = false;
    while (this.next.kind === "*" || this.next.kind === "/" || BEGINNING.has(this.next.kind)) {
      refuse(quotient && BEGINNING.has(this.next.kind) && this.next.touching, "what a fraction line covers is unclear");
      const sign = this.take("*", "/")?.kind;
      const factor = this.factor();
      quotient = sign === "/" && factor !== symbol("dt");
      factors.push(sign === "/" ? this.power(factor, number(-1)) : factor);
    }
    const found = mul(...factors);
    if (tr.isNumber(found, 0) && factors.some(isPartial)) throw new NotCovered("0 times what may have no value");
    return found;
  }

  factor() {
    this.depth += 1;
    refuse(this.depth > 60, "a text is nested too deep");
    let minus = false;
    for (let sign = this.take("+", "-"); sign; sign = this.take("+", "-")) minus = minus !== (sign.kind === "-");
    let found = this.primary();
    if (this.take("^")) found = this.power(found, this.factor());
    this.depth -= 1;
    return minus ? neg(found) : found;
  }

  power(base, exponent) {
    if (base === call("exp", number(1))) return call("exp", exponent);
    if (exponent.head === "number") {
      const { n, d, whole, sign } = exponent.value;
      refuse((n < 0n ? -n : n) > 64n || d > 64n, "an exponent is too large");
      if (base.head === "number" && base.value.sign <= 0) {
        refuse(base.value.sign === 0 ? sign <= 0 : !whole, "there is no such power");
      }
    }
    return pow(base, exponent);
  }

  primary() {
    if (this.next.kind === "(") {
      const found = this.arguments();
      refuse(found.length > 1, "a comma stands in a group");
      return found[0];
    }
    const token = this.need("number", ...BEGINNING);
    if (token.kind === "function") return this.function(token);
    if (token.kind === "declared") return this.declared(token);
    const after = this.tokens.slice(this.at, this.at + 3);
    const called = token.kind !== "number" && after[0]?.kind === "(" && ["value", "number"].includes(after[1]?.kind) && after[2]?.kind === ")";
    refuse(called && (this.next.touching || after[1].tree === symbol("t")), "it may be a factor or a function");
    return token.tree;
  }

  arguments() {
    this.need("(");
    const found = [this.sum()];
    while (this.take(",")) found.push(this.sum());
    this.need(")");
    return found;
  }

  function(token) {
    if (token.name === "diff") {
      const [of, by, ...more] = this.arguments();
      refuse(of.head !== "apply" || by?.head !== "symbol" || more.length > 0, "diff has a function and a name");
      return tr.derivative(of, by.value);
    }
    const exponent = this.take("^") ? this.need("number").tree : number(1);
    const alone = this.next.kind === "value";
    const given = alone ? [this.primary()] : this.arguments();
    const longer = ["value", "number", "declared", "^", "/"].includes(this.next.kind) || (this.next.kind === "(" && this.next.touching);
    refuse(alone && longer, `where ${token.name} ends is unclear`);
    refuse(given.length !== (token.name === "atan2" ? 2 : 1), `${token.name} has ${given.length} arguments`);
    const zero = token.name === "exp" && tr.isNumber(given[0], 0);
    return this.power(zero ? number(1) : call(token.name, ...given), exponent);
  }

  declared(token) {
    const given = this.arguments();
    refuse(given.length !== token.orders.length, `${token.name} has another number of arguments`);
    return tr.apply(token.name, token.orders, given);
  }
}

/** The value that a text writes. */
export function parse(text, names) {
  const reader = new Reader(text, names);
  const found = reader.sum();
  reader.need("end");
  return found;
}

/** The relations of a text: { tree, sign: "=" or ">", strict }; a text without a sign is `= 0`, a chain is several. */
export function parseRelations(text, names) {
  const reader = new Reader(text, names);
  let left = reader.sum();
  const found = [];
  for (let sign = reader.take("relation"); sign; sign = reader.take("relation")) {
    const right = reader.sum();
    const less = "<≤".includes(sign.name[0]);
    const tree = less ? tr.sub(right, left) : tr.sub(left, right);
    found.push({ tree, sign: sign.name[0] === "=" ? "=" : ">", strict: sign.name === "<" || sign.name === ">" });
    left = right;
  }
  reader.need("end");
  return found.length ? found : [{ tree: left, sign: "=", strict: false }];
}
