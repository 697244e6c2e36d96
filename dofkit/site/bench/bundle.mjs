// Bundles the pages' scripts: node bundle.mjs OUT.
import { build } from "esbuild";

const common = { bundle: true, minify: true, target: "es2022", legalComments: "linked", outdir: process.argv[2], logLevel: "warning" };
const pages = { bench: "bench.js", "player-frame": "player-frame.js", "runtime/worker": "worker.js" };
await build({ ...common, format: "esm", entryPoints: pages, external: ["./pyodide.mjs"] });
await build({ ...common, format: "iife", globalName: "dofkitRuntime", entryPoints: ["runtime.js"] });
await build({
  ...common,
  format: "iife",
  entryPoints: ["runtime-worker.js"],
  external: ["node:*", "ws"],
  // a page opened from a folder can start classic workers only, which Pyodide refuses by this function
  banner: { js: "globalThis.importScripts = undefined;" },
  logOverride: { "empty-import-meta": "silent" },
});
