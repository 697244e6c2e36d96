// Bundles the pages' scripts: node bundle.mjs OUT.
import { build } from "esbuild";

await build({
  entryPoints: ["bench.js", "practice.js", "worker.js", "player-frame.js"],
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  external: ["./pyodide/*"],
  legalComments: "linked",
  outdir: process.argv[2],
  logLevel: "warning",
});
