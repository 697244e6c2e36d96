// The bench: a scene on one side, the report on it on the other, as one types.
import { editor, located, replaceText, underline } from "./editor.js";
import { Engine, Stopped } from "./engine.js";
import { packed, unpacked } from "./fragment.js";
import { element, sheet } from "./show.js";

/** Milliseconds of rest before a report begins, and of a run that a keystroke lets end: Python takes longer to start anew. */
const REST = 300;
const PATIENCE = 3000;
const FIRST = "disc-rolling-on-plane";
/** @param {string} id @returns {any} */
const at = (id) => document.getElementById(id);
const embedded = new URLSearchParams(location.search).has("embed");
document.documentElement.classList.toggle("embedded", embedded);

const state = { text: "", names: [], schema: null, leftOut: new Set(), report: null, svg: "", round: 0, drawn: "" };
/** @type {{name: string, topic: string, title: string, text: string, alternative: string, answer: any}[]} */
let catalog = [];
/** @type {import("@codemirror/view").EditorView} */
let view;
let timer = 0;

let loading = true;
const engine = new Engine((now) => {
  loading = now === "loading";
  say("");
  if (!loading) keepOffline();
});

/** @param {string} text of the line of state, if there is anything but that Python loads @param {boolean} [stoppable] */
function say(text, stoppable = false) {
  at("state").textContent = text || (loading ? "Loading Python" : "");
  at("stop").hidden = !stoppable;
}

/** Ask, unless a newer text has come meanwhile; what is stopped or outdated never settles. */
async function ask(call, ...args) {
  const round = state.round;
  try {
    const answer = await engine.ask(call, ...args);
    if (round === state.round) return answer;
  } catch (error) {
    if (!(error instanceof Stopped) && round === state.round) throw error;
  }
  return new Promise(() => {});
}

/** Faults at once, the report after a rest. */
function changed() {
  state.text = view.state.doc.toString();
  state.round += 1;
  state.leftOut.clear();
  if (engine.busy > PATIENCE) engine.replace();
  clearTimeout(timer);
  timer = window.setTimeout(report, REST);
  check();
}

async function check() {
  try {
    const { faults, names } = await ask("check", state.text);
    showFaults(faults);
    if (names) state.names = names;
  } catch (error) {
    say(String(error.message));
  }
}

function showFaults(faults) {
  const places = located(view.state.doc, faults);
  underline(view, places);
  at("faults").replaceChildren(...places.map(faultEntry));
  at("report").classList.toggle("old", faults.length > 0 && state.report);
  if (faults.length) say(state.report ? "The report is that of the last scene without faults." : "");
}

function faultEntry({ from, line, column, message, hint, mend }) {
  const go = element("button", { type: "button", className: "place", textContent: `line ${line}, column ${column}` });
  go.addEventListener("click", () => { view.dispatch({ selection: { anchor: from }, scrollIntoView: true }); view.focus(); });
  const entry = element("li", {}, go, ` ${message}`, hint ? element("small", { textContent: ` (${hint})` }) : "");
  if (mend) {
    const fix = element("button", { type: "button", textContent: `Write ${mend.insert}` });
    fix.addEventListener("click", () => { view.dispatch({ changes: mend }); view.focus(); });
    entry.append(" ", fix);
  }
  return entry;
}

async function report() {
  const text = state.text;
  const known = catalog.find((scene) => scene.text === text);
  history.replaceState(null, "", known ? `#example=${known.name}` : `#scene=${await packed(text)}`);
  at("open").href = `./${location.hash}`;
  const slow = window.setTimeout(() => engine.busy && say("Classifying", true), REST);
  try {
    // the report on an example is at hand before Python is: it was built with the site
    const answer = known && !state.leftOut.size ? known.answer : await ask("report", text, [...state.leftOut]);
    if (answer.faults.length) return showFaults(answer.faults);
    state.report = answer.report;
    showSwitches(answer.constraints);
    at("report").classList.remove("old");
    at("report").replaceChildren(...sheet(answer.sheet));
    showFaults([]);
    document.title = `${answer.sheet.title.text ?? (answer.sheet.title || answer.report.scene)} - dofkit bench`;
    clearTimeout(slow);
    say("");
    await picture(known, text);
  } catch (error) {
    say(String(error.message));
  } finally {
    clearTimeout(slow);
  }
}

/** The picture: of an example that built with the site, of any other one that Python draws. */
async function picture(known, text) {
  if (state.drawn === text) return;
  state.drawn = text;
  for (const id of ["derived", "player"]) at(id)[id === "player" ? "hidden" : "textContent"] = id === "player" ? true : "";
  if (known) {
    state.svg = await (await fetch(`pictures/${known.name}.svg`)).text();
    return showPicture(known.alternative);
  }
  state.svg = "";
  if (!at("picture").src) showNoPicture("The picture is being drawn.");
  try {
    const { svg, alternative, faults } = await ask("picture", text);
    if (faults) return showNoPicture(faults[0].message);
    state.svg = svg;
    showPicture(alternative);
  } catch (error) {
    showNoPicture(`No picture: ${error.message}`);
  }
}

function showPicture(alternative) {
  URL.revokeObjectURL(at("picture").src);
  Object.assign(at("picture"), {
    src: URL.createObjectURL(new Blob([state.svg], { type: "image/svg+xml" })), alt: alternative, hidden: false,
  });
  at("no-picture").hidden = true;
}

function showNoPicture(reason) {
  at("picture").hidden = true;
  Object.assign(at("no-picture"), { textContent: reason, hidden: false });
}

function showSwitches(names) {
  const boxes = names.map((name) => {
    const box = element("input", { type: "checkbox", checked: !state.leftOut.has(name), value: name });
    box.addEventListener("change", () => {
      if (box.checked) state.leftOut.delete(name);
      else state.leftOut.add(name);
      state.round += 1;
      report();
    });
    return element("label", {}, box, ` ${name}`);
  });
  const focused = document.activeElement?.closest("#switches") ? document.activeElement.value : null;
  at("switches").replaceChildren(element("legend", { textContent: "Constraints in use" }), ...boxes);
  at("switches").hidden = !names.length;
  boxes.find((label) => label.firstChild.value === focused)?.firstChild.focus();
}

async function derive() {
  say("Deriving the equations of motion", true);
  try {
    const { sheet: derived, faults } = await ask("equations", state.text);
    const said = faults ? [element("p", { className: "care", textContent: `${faults[0].message} (${faults[0].hint})` })]
      : sheet(derived, "Facts of the motion");
    at("derived").replaceChildren(...said);
    say("");
  } catch (error) {
    say(String(error.message));
  }
}

async function move() {
  say("Computing the motion", true);
  try {
    const answer = await ask("motion", state.text);
    if (answer.faults) return say(answer.faults[0].message);
    const asks = ({ source, data }) => {
      if (source !== at("player").contentWindow || data !== "player") return;
      source.postMessage(answer, location.origin);
      removeEventListener("message", asks);
    };
    addEventListener("message", asks);
    Object.assign(at("player"), { src: "player.html", hidden: false });
    say(answer.data.clips.length ? "" : "Nothing moves, or no motion was found that could be shown.");
  } catch (error) {
    say(`No motion: ${error.message}`);
  }
}

function save(name, type, text) {
  const link = element("a", { href: URL.createObjectURL(new Blob([text], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const EXPORTS = {
  yaml: () => save("scene.yaml", "application/yaml", state.text),
  json: async () => save("scene.json", "application/json", JSON.stringify((await ask("as_json", state.text)).scene, null, 2)),
  report: () => save("report.json", "application/json", JSON.stringify(state.report, null, 2)),
  svg: () => (state.svg ? save("picture.svg", "image/svg+xml", state.svg) : say("There is no picture to save.")),
};

function menu() {
  const words = at("search").value.toLowerCase().split(/\s+/);
  const matching = catalog.filter(({ name, title, text }) => words.every((w) => `${name} ${title} ${text}`.toLowerCase().includes(w)));
  const topics = Map.groupBy ? Map.groupBy(matching, ({ topic }) => topic) : new Map([["", matching]]);
  const groups = [...topics].map(([topic, scenes]) =>
    element("section", {}, element("h3", { textContent: topic }), element("ul", {}, ...scenes.map(example))));
  at("matching").replaceChildren(...(groups.length ? groups : [element("p", { textContent: "No example has these words." })]));
}

function example({ name, title, text }) {
  const pick = element("button", { type: "button", textContent: title });
  pick.addEventListener("click", () => { at("menu").close(); replaceText(view, text); view.focus(); });
  return element("li", {}, pick, " ", element("small", { textContent: name }));
}

/** The text that the address names: a scene, an example, or else the first example. */
async function addressed() {
  const [kind, ...rest] = location.hash.slice(1).split("=");
  const first = catalog.find(({ name }) => name === FIRST)?.text ?? "coordinates: [x, y]\n";
  if (kind === "example") return catalog.find(({ name }) => name === rest.join("="))?.text ?? first;
  if (kind !== "scene") return first;
  try {
    return await unpacked(rest.join("="));
  } catch (error) {
    return `# The link holds no scene that can be read: ${String(error.message).slice(0, 80)}.\ncoordinates: [x, y]\n`;
  }
}

let offline = false;
function keepOffline() {
  if (offline || !("serviceWorker" in navigator)) return;
  offline = true;
  navigator.serviceWorker.register("offline.js").catch(() => {});
}

async function start() {
  const [scenes, schema] = await Promise.all(["catalog.json", "schema.json"].map(async (name) => (await fetch(name)).json()));
  [catalog, state.schema] = [scenes, schema];
  view = editor(at("editor"), await addressed(), changed, () => state);
  state.text = view.state.doc.toString();
  check();
  report();
}

at("examples").addEventListener("click", () => { menu(); at("menu").showModal(); at("search").select(); });
at("search").addEventListener("input", menu);
at("search").addEventListener("keydown", (event) => {
  if (event.key !== "Enter") return;
  event.preventDefault();
  at("matching").querySelector("button")?.click();
});
at("copy").addEventListener("click", async () => {
  try {
    await navigator.clipboard.writeText(location.href.replace("?embed", ""));
    say("The link was copied.");
  } catch {
    say("The browser does not let this page copy: the link is the address of the page.");
  }
});
at("export").addEventListener("change", ({ target }) => { EXPORTS[target.value]?.(); target.value = ""; });
at("stop").addEventListener("click", () => { state.round += 1; engine.replace(); say("Stopped."); });
at("motion").addEventListener("click", move);
at("equations").addEventListener("click", derive);
addEventListener("hashchange", async () => replaceText(view, await addressed()));
start().catch((error) => say(location.protocol === "file:" ? "The bench needs a web server: python -m http.server" : error.message));
