// Bundles the pages' scripts: node bundle.mjs OUT.
import { build } from "esbuild";

await build({
  entryPoints: { bench: "bench.js", practice: "practice.js", "player-frame": "player-frame.js", "runtime/worker": "worker.js" },
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  external: ["./pyodide.mjs"],
  legalComments: "linked",
  outdir: process.argv[2],
  logLevel: "warning",
});
