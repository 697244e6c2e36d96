// What Python answers as elements of a page. Texts become text nodes, formulas known elements of MathML, nothing else.

const MATHML = "http://www.w3.org/1998/Math/MathML";
const TAGS = new Set(
  "math mrow mi mn mo mtext mspace mfrac msqrt mroot msub msup msubsup munder mover munderover mtable mtr mtd mstyle".split(" "),
);
const ATTRIBUTES = new Set("stretchy fence form accent mathvariant displaystyle columnalign lspace rspace width".split(" "));

/**
 * @param {string} tag @param {Record<string, any>} [fields] properties of the element @param {...(Node | string)} children
 * @returns {any}
 */
export function element(tag, fields = {}, ...children) {
  const made = Object.assign(document.createElement(tag), fields);
  made.append(...children);
  return made;
}

/** @param {string} mathml what stands within `math` @param {string} text the same, to be read aloud */
export function mathematics(mathml, text) {
  const read = new DOMParser().parseFromString(`<math>${mathml}</math>`, "application/xml").documentElement;
  if (read.nodeName !== "math") return document.createTextNode(text);
  const made = known(read);
  made.setAttribute("displaystyle", "true");
  made.setAttribute("aria-label", text);
  return made;
}

function known(node) {
  if (node.nodeType === Node.TEXT_NODE) return document.createTextNode(node.data);
  if (!TAGS.has(node.nodeName)) return document.createTextNode(node.textContent ?? "");
  const made = document.createElementNS(MATHML, node.nodeName);
  for (const { name, value } of node.attributes) if (ATTRIBUTES.has(name)) made.setAttribute(name, value);
  made.append(...[...node.childNodes].map(known));
  return made;
}

/** @param {string | {text: string, math: string}} content */
export function content(content) {
  return typeof content === "string" ? document.createTextNode(content) : mathematics(content.math, content.text);
}

/** The elements of a printed sheet: a table of facts, called by its `label`, then its sections. */
export function sheet({ name, title, alarm, facts, sections }, label = "Facts") {
  const made = [element("h2", {}, content(title || name))];
  if (alarm) made.push(element("p", { className: `alarm ${alarm[1]}`, textContent: alarm[0] }));
  const rows = facts.map(([label, value, note, tone]) => {
    const cell = element("td", { className: tone }, content(value));
    if (note) cell.append(" ", element("small", { textContent: note }));
    return element("tr", {}, element("th", { scope: "row", textContent: label }), cell);
  });
  if (rows.length) made.push(wide(label, element("table", { className: "facts" }, element("tbody", {}, ...rows))));
  for (const section of sections) {
    made.push(element("h3", { textContent: section.heading }), ...section.parts.map((part) => shown(part, section.heading)));
    if (section.more) made.push(element("p", {}, element("small", { textContent: section.more })));
  }
  return made;
}

function shown(part, heading) {
  if (part.heads) return wide(heading, table(part));
  const made = element("p");
  const mark = typeof part.label === "string" && part.label === "!";
  if (part.label) made.append(element("strong", {}, content(part.label)), mark ? " " : ": ");
  made.append(content(part.text));
  if (part.note) made.append(" ", element("small", { textContent: `(${part.note})` }));
  return made;
}

function table({ heads, rows }) {
  const kind = (column) => ({ className: heads[column][1] ? "number" : "" });
  const head = heads.map(([text], k) => element("th", { scope: "col", textContent: text, ...kind(k) }));
  const body = rows.map(([name, ...cells]) =>
    element("tr", {}, element("th", { scope: "row" }, content(name)), ...cells.map((c, k) => element("td", kind(k + 1), content(c)))),
  );
  return element("table", {}, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...body));
}

/** A table that scrolls by itself where it is wider than the page, also by keyboard. */
function wide(label, table) {
  const box = element("div", { className: "wide", tabIndex: 0 }, table);
  box.setAttribute("role", "region");
  box.setAttribute("aria-label", label);
  return box;
}
