// Runs dofkit in the background: Python with the package in bytecode, and what is loaded only when it is asked for.
import { loadPyodide } from "./pyodide/pyodide.mjs";

/** Where numpy is had from; everything else comes from this folder. */
const DISTRIBUTION = "https://cdn.jsdelivr.net/pyodide/v314.0.7/full/";
/** The module of each call, and what it needs beyond the first archive: of this folder, and of the distribution. */
const CALLS = {
  check: { module: "reports" },
  report: { module: "reports" },
  as_json: { module: "reports" },
  picture: { module: "drawings", packages: ["numpy"] },
  motion: { module: "drawings", packages: ["numpy"] },
  equations: { module: "equations", archives: ["symbols"] },
  read: { module: "answers", archives: ["sheets"] },
  judge: { module: "answers", archives: ["sheets"] },
};
const loaded = new Set();
const ready = start();

/** @param {string} name an archive of this folder, without its ending */
async function archive(name) {
  const answer = await fetch(new URL(`./${name}.zip`, import.meta.url));
  if (!answer.ok) throw new Error(`${name}.zip: ${answer.status}`);
  return answer.arrayBuffer();
}

async function start() {
  const core = archive("core");
  const python = await loadPyodide({
    indexURL: new URL("./pyodide/", import.meta.url).href,
    packageBaseUrl: DISTRIBUTION,
    env: { PYTHONDONTWRITEBYTECODE: "1", HOME: "/home/pyodide" },
  });
  const site = python.runPython("import site; site.getsitepackages()[0]");
  python.unpackArchive(await core, "zip", { extractDir: site });
  const module = python.pyimport("dofkit.site.browser");
  postMessage({ ready: true });
  return { python, site, answer: module.answer };
}

/** @param {{packages?: string[], archives?: string[]}} needs @param {Awaited<ReturnType<typeof start>>} runtime */
async function provide({ packages = [], archives = [] }, { python, site }) {
  for (const name of archives.filter((name) => !loaded.has(name))) {
    python.unpackArchive(await archive(name), "zip", { extractDir: site });
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

addEventListener("message", async ({ data: { id, call, args } }) => {
  try {
    const runtime = await ready;
    await provide(CALLS[call], runtime);
    postMessage({ id, value: JSON.parse(runtime.answer(CALLS[call].module, call, JSON.stringify(args))) });
  } catch (error) {
    postMessage({ id, error: reason(error) });
  }
});
