// A sheet's page: under each question a field, under the field how the answer is read. The answers are written to a file
// to hand in; a practice sheet judges them instead.
(() => {
  /** Milliseconds of rest before an answer is read. */
  const REST = 150;
  /** What reads and judges answers; the page works without it, but shows no readings. */
  const RUNTIME = "runtime.js";
  const { language, words, student, declared, assignment } = JSON.parse(document.getElementById("data").textContent);
  const KEY = `dofkit ${location.pathname}`;
  /** @type {Map<string, {problem: string, question: string, field: any, read: any, judged: any}>} */
  const places = new Map();
  /** @type {{ask: (call: string, ...args: any[]) => Promise<any>, content: (shown: any) => Node} | undefined} */
  let runtime;

  /** @param {string} tag @param {Record<string, any>} [fields] @param {...(Node | string)} children @returns {any} */
  function element(tag, fields = {}, ...children) {
    const made = Object.assign(document.createElement(tag), fields);
    made.append(...children);
    return made;
  }

  function status(className) {
    const made = element("div", { className });
    made.setAttribute("role", "status");
    return made;
  }

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
    const read = status("read");
    const judged = status("judged");
    let timer = 0;
    field.addEventListener("input", () => {
      keep();
      judged.replaceChildren();
      clearTimeout(timer);
      timer = window.setTimeout(() => readAs(name), REST);
    });
    asked.append(label, element("div", { className: "question" }, field, read, judged));
    if (assignment) judged.before(button(words.check, () => judge([name])));
    places.set(name, { problem, question, field, read, judged });
  }

  function button(text, act) {
    const made = element("button", { type: "button", textContent: text });
    made.addEventListener("click", act);
    return made;
  }

  /** Show how an answer is read, or where reading stops and why. @param {string} name */
  async function readAs(name) {
    const { problem, question, field, read } = places.get(name);
    const text = field.value;
    if (!text.trim() || !runtime) return read.replaceChildren();
    const { shown, fault, column, hint } = await runtime.ask("read", JSON.stringify(declared[problem]), question, text, language);
    if (text !== field.value) return;
    if (shown !== undefined) return read.replaceChildren(`${words.read} `, runtime.content(shown));
    const line = [...text.replaceAll("\n", " ")];
    const start = Math.max(0, column - 41);
    const caret = `${line.slice(start, start + 60).join("")}\n${" ".repeat(column - 1 - start)}^`;
    read.replaceChildren(
      element("pre", { textContent: caret }), element("span", { className: "bad", textContent: fault }),
      hint ? element("small", { textContent: ` (${hint})` }) : "",
    );
  }

  function given() {
    const answers = {};
    for (const { problem, question, field } of places.values()) {
      if (field.value.trim()) (answers[problem] ??= {})[question] = field.value;
    }
    return answers;
  }

  /** Judge all answers, and show what is said of some. @param {string[]} names */
  async function judge(names) {
    if (!runtime) return;
    try {
      const { items } = await runtime.ask("judge", JSON.stringify(assignment), given());
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

  /** Write the answers to a file to hand in. @param {string} named who hands it in; nothing if the page does not say */
  function save(named, said) {
    const answers = given();
    const file = `${named || "answers"}.json`;
    const text = `${JSON.stringify({ ...(named ? { student: named } : {}), answers }, null, 1)}\n`;
    const url = URL.createObjectURL(new Blob([text], { type: "application/json" }));
    element("a", { href: url, download: file }).click();
    const count = Object.values(answers).reduce((sum, asked) => sum + Object.keys(asked).length, 0);
    said.textContent = words.saved.replace("{count}", count).replace("{most}", places.size).replace("{file}", () => file);
  }

  /** The button that writes the file, with a field for the name on a page that is nobody's. */
  function handIn() {
    const said = status("said");
    if (student !== null) return [button(words.save, () => save(student, said)), said];
    const name = element("input", { type: "text", autocomplete: "name" });
    return [element("label", {}, `${words.name} `, name), button(words.save, () => save(name.value.trim(), said)), said];
  }

  async function load() {
    try {
      const { start, content } = dofkitRuntime;
      runtime = { ask: await start(), content };
      state.textContent = "";
      for (const name of places.keys()) readAs(name);
    } catch (error) {
      state.textContent = `${words.unread} (${error.message})`;
    }
  }

  const main = document.querySelector("main");
  const state = element("p", { className: "state", textContent: words.loading });
  state.setAttribute("role", "status");
  main.querySelector("h1").after(element("p", { className: "note", textContent: words.note }), state);
  const codes = main.querySelectorAll("ol > li > code:last-child, ol > li > p > code:last-child");
  const asked = new Map([...codes].map((code) => [code.textContent, code]));
  const kept = drafts();
  for (const [problem, { questions }] of Object.entries(declared)) {
    for (const { id } of questions) {
      const code = asked.get(`${problem}.${id}`);
      if (code) addField(code, problem, id, kept[`${problem}.${id}`]);
    }
  }
  const acts = assignment ? [button(words.all, () => judge([...places.keys()]))] : handIn();
  main.querySelector("h2:last-of-type").before(element("div", { className: "hand" }, ...acts));
  const script = element("script", { src: RUNTIME });
  script.addEventListener("load", load);
  script.addEventListener("error", () => { state.textContent = words.unread; });
  document.head.append(script);
})();
