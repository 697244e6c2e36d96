// A practice sheet: under each question a field, under the field how the answer is read, and on request the judgement.
import { Engine } from "./engine.js";
import { content, element } from "./show.js";

/** Milliseconds of rest before an answer is read. */
const REST = 150;
const { language, words, declared, assignment } = JSON.parse(document.getElementById("sheet").textContent);
const KEY = `dofkit-practice ${location.pathname}`;
const state = element("p", { className: "state" });
state.setAttribute("role", "status");
const engine = new Engine((now) => { state.textContent = now === "loading" ? words.loading : ""; });
/** @type {Map<string, {problem: string, question: string, field: any, read: any, judged: any}>} */
const places = new Map();

/** The drafts that this browser keeps; a browser that keeps none has none. */
function drafts() {
  try {
    return JSON.parse(localStorage.getItem(KEY) ?? "{}");
  } catch {
    return {};
  }
}

function keep() {
  try {
    localStorage.setItem(KEY, JSON.stringify(Object.fromEntries([...places].map(([name, { field }]) => [name, field.value]))));
  } catch {
    // it is full or refused: the answers are then on this page only
  }
}

/** Put a field under the question whose name stands at its end. */
function addField(code, problem, question, draft) {
  const name = `${problem}.${question}`;
  const asked = code.parentElement;
  const label = element("div", { id: `asked ${name}`.replaceAll(" ", "-") });
  code.remove();
  label.append(...asked.childNodes);
  const field = element("textarea", { rows: 1, value: draft ?? "", spellcheck: false, autocapitalize: "off" });
  field.setAttribute("aria-labelledby", label.id);
  const read = element("div", { className: "read" });
  read.setAttribute("role", "status");
  const judged = element("div", { className: "judged" });
  judged.setAttribute("role", "status");
  const check = element("button", { type: "button", textContent: words.check });
  check.addEventListener("click", () => judge([name]));
  let timer = 0;
  field.addEventListener("input", () => {
    keep();
    judged.replaceChildren();
    clearTimeout(timer);
    timer = window.setTimeout(() => readAs(name), REST);
  });
  asked.append(label, element("div", { className: "question" }, field, read, check, judged));
  places.set(name, { problem, question, field, read, judged });
  if (draft) readAs(name);
}

/** Show how an answer is read, or where reading stops and why. @param {string} name */
async function readAs(name) {
  const { problem, question, field, read } = places.get(name);
  const text = field.value;
  if (!text.trim()) return read.replaceChildren();
  const { shown, fault, column, hint } = await engine.ask("read", JSON.stringify(declared[problem]), question, text, language);
  if (text !== field.value) return;
  if (shown !== undefined) return read.replaceChildren(`${words.read} `, content(shown));
  const line = [...text.replaceAll("\n", " ")];
  const start = Math.max(0, column - 41);
  const caret = `${line.slice(start, start + 60).join("")}\n${" ".repeat(column - 1 - start)}^`;
  read.replaceChildren(
    element("pre", { textContent: caret }), element("span", { className: "bad", textContent: fault }),
    hint ? element("small", { textContent: ` (${hint})` }) : "",
  );
}

/** Judge all answers, and show what is said of some. @param {string[]} names */
async function judge(names) {
  const answers = {};
  for (const { problem, question, field } of places.values()) {
    if (field.value.trim()) (answers[problem] ??= {})[question] = field.value;
  }
  try {
    const { items } = await engine.ask("judge", JSON.stringify(assignment), answers);
    for (const { problem, question, status, tone, points, feedback } of items) {
      const name = `${problem}.${question}`;
      if (!names.includes(name)) continue;
      const verdict = element("strong", { className: tone, textContent: `${status} (${points})` });
      places.get(name).judged.replaceChildren(verdict, ` ${feedback}`);
    }
  } catch (error) {
    state.textContent = String(error.message);
  }
}

const kept = drafts();
const main = document.querySelector("main");
main.querySelector("h1").after(element("p", { className: "note", textContent: `${words.practice} ${words.drafts}` }), state);
const asked = new Map([...main.querySelectorAll("code")].map((code) => [code.textContent, code]));
for (const [problem, { questions }] of Object.entries(declared)) {
  for (const { id } of questions) {
    const code = asked.get(`${problem}.${id}`);
    if (code) addField(code, problem, id, kept[`${problem}.${id}`]);
  }
}
const all = element("button", { type: "button", textContent: words.all });
all.addEventListener("click", () => judge([...places.keys()]));
main.querySelector("h2:last-of-type").before(all);
