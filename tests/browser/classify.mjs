// node classify.mjs RUNTIME SCENES: the reports on scenes by Python compiled for browsers, as JSON by name.
// SCENES is a JSON file of texts by name; RUNTIME is the folder from which a page runs dofkit, and has no numpy.
import { createReadStream, readFileSync } from "node:fs";
import { Readable } from "node:stream";
import { loadPyodide } from "../../dofkit/site/bench/node_modules/pyodide/pyodide.mjs";
import { startPython } from "../../dofkit/site/bench/start.js";

const [runtime, scenes] = process.argv.slice(2);
const program = `
import json, sys, time
import dofkit

reports, begun = {}, time.monotonic()
for name, text in json.loads(scenes).items():
    reports[name] = dofkit.classify(dofkit.loads(text, name=name)).model_dump(mode="json")
seconds = time.monotonic() - begun
watched = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}, budget=10)
json.dumps({
    "reports": reports, "seconds": seconds, "platform": sys.platform, "warnings": watched.warnings,
    "imported": sorted({"numpy.linalg", "resource", "dofkit.base.workers"} & sys.modules.keys()),
})
`;
try {
  const core = Readable.toWeb(createReadStream(`${runtime}/core.bin`));
  // under node Pyodide takes its compiled runtime and the standard library from its own folder
  const { python, unpack } = await startPython(loadPyodide, Promise.resolve(core), {});
  unpack(new Uint8Array(readFileSync(`${runtime}/extras.zst`)));
  python.globals.set("scenes", readFileSync(scenes, "utf8"));
  process.stdout.write(python.runPython(program));
} catch (error) {
  process.stderr.write(error.message); // an error that is not caught prints the whole runtime
  process.exitCode = 1;
}
