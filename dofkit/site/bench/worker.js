// Runs dofkit in the background. A page asks by messages {id, call, args}, and is answered by {id, value} or {id, error};
// {state} comes once Python is "ready", and when it is "running" for a question, for which files may have to be loaded
// first, and then "idle". runtime.py says what is beside this file.
import { loadPyodide } from "./pyodide.mjs";
import { imported, startPython } from "./start.js";

/** Where numpy is had from; everything else comes from this folder. */
const DISTRIBUTION = "https://cdn.jsdelivr.net/pyodide/v314.0.7/full/";
/** The module of each call, and what it needs beyond the core: archives of this folder, packages of the distribution. */
const CALLS = {
  check: { module: "reports" },
  report: { module: "reports" },
  as_json: { module: "reports" },
  picture: { module: "drawings", archives: ["extras"], packages: ["numpy"] },
  motion: { module: "drawings", archives: ["extras"], packages: ["numpy"] },
  equations: { module: "equations", archives: ["extras", "symbols"] },
  read: { module: "answers", archives: ["extras", "sheets"] },
  judge: { module: "answers", archives: ["extras", "sheets"] },
};
const loaded = new Set();
const ready = start();

async function file(/** @type {string} */ name) {
  const answer = await fetch(new URL(name, import.meta.url)).catch(() => null);
  if (!answer?.ok || !answer.body) throw new Error(`${name} could not be loaded`);
  return answer;
}

async function start() {
  const core = file("core.bin").then(({ body }) => body);
  const runtime = await startPython(loadPyodide, core, {
    indexURL: new URL("./", import.meta.url).href,
    packageBaseUrl: DISTRIBUTION,
    env: { PYTHONDONTWRITEBYTECODE: "1", HOME: "/home/pyodide" },
  });
  const { answer } = runtime.python.pyimport("dofkit.site.browser");
  imported(runtime.python, "dofkit.site.browser.reports").destroy();
  postMessage({ state: "ready" });
  return { ...runtime, answer };
}

/** @param {{packages?: string[], archives?: string[]}} needs @param {Awaited<ReturnType<typeof start>>} runtime */
async function provide({ packages = [], archives = [] }, { python, unpack }) {
  for (const name of archives.filter((name) => !loaded.has(name))) {
    unpack(new Uint8Array(await (await file(`${name}.zst`)).arrayBuffer()));
    loaded.add(name);
  }
  for (const name of packages.filter((name) => !loaded.has(name))) {
    await python.loadPackage(name, { messageCallback: () => {}, errorCallback: () => {} });
    if (!(name in python.loadedPackages)) throw new Error(`${name} could not be loaded from ${DISTRIBUTION}`);
    loaded.add(name);
  }
}

/** The line of a Python traceback that says what happened, or the whole message. */
function reason(error) {
  const lines = String(error.message ?? error).trim().split("\n");
  return lines.findLast((line) => /^[\w.]*(Error|Exception)\b/.test(line)) ?? lines.at(-1);
}

/** The answer; networkx, which linkages need, and modules that are seldom used are loaded when one is found missing. */
async function answered({ module, ...needs }, call, args) {
  const runtime = await ready;
  await provide(needs, runtime);
  const ask = () => {
    postMessage({ state: "running" });
    try {
      return JSON.parse(runtime.answer(module, call, JSON.stringify(args)));
    } finally {
      postMessage({ state: "idle" });
    }
  };
  try {
    return ask();
  } catch (error) {
    if (loaded.has("extras") || !error.message.includes("No module named")) throw error;
    await provide({ archives: ["extras"] }, runtime);
    return ask();
  }
}

addEventListener("message", async ({ data: { id, call, args } }) => {
  try {
    postMessage({ id, value: await answered(CALLS[call], call, args) });
  } catch (error) {
    postMessage({ id, error: reason(error) });
  }
});
