// Python for a sheet's page, from files that the page hands over: nothing is fetched.
import { loadPyodide } from "pyodide";
import createPyodideModule from "./node_modules/pyodide/pyodide.asm.mjs";
import { unpacked } from "./runtime.js";
import { imported, startPython } from "./start.js";

/** The address that Pyodide is told its files have. */
const NOWHERE = "https://runtime.invalid/";
let answer;

async function start(packed) {
  const names = Object.keys(packed);
  const files = Object.fromEntries(await Promise.all(names.map(async (name) => [name, await unpacked(packed[name])])));
  const core = Promise.resolve(new Response(files["core.bin"]).body);
  const { python, unpack } = await startPython(loadPyodide, core, {
    indexURL: NOWHERE,
    lockFileContents: new TextDecoder().decode(files["pyodide-lock.json"]),
    createPyodideModule,
    env: { PYTHONDONTWRITEBYTECODE: "1", HOME: "/home/pyodide" },
  });
  for (const name of ["extras.zst", "sheets.zst"]) unpack(new Uint8Array(files[name]));
  imported(python, "dofkit.site.browser.answers"); // now, so that the first answer is read at once
  answer = python.pyimport("dofkit.site.browser").answer;
}

addEventListener("message", async ({ data: { id, files, call, args } }) => {
  try {
    if (files) await start(files);
    postMessage({ id, value: files ? null : JSON.parse(answer("answers", call, JSON.stringify(args))) });
  } catch (error) {
    postMessage({ id, error: String(error.message ?? error).trim().split("\n").at(-1) });
  }
});
