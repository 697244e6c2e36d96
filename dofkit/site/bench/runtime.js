// All that reads answers, in one script that needs no web server: it is loaded by a script tag, also from a folder.
import { content } from "./show.js";

export { content };
/** @type {Record<string, string>} the files of the worker, compressed and in base64: filled in by the build */
export const files = {};

/** Start Python in the background. @returns {Promise<(call: string, ...args: any[]) => Promise<any>>} what asks it */
export async function start() {
  const { worker: source, ...others } = files;
  const code = new Blob([await unpacked(source)], { type: "text/javascript" });
  const worker = new Worker(URL.createObjectURL(code));
  /** @type {Map<number, {resolve: (value: any) => void, reject: (error: Error) => void}>} */
  const asked = new Map();
  const ask = (message) => new Promise((resolve, reject) => {
    const id = asked.size ? Math.max(...asked.keys()) + 1 : 0;
    asked.set(id, { resolve, reject });
    worker.postMessage({ id, ...message });
  });
  worker.addEventListener("message", ({ data: { id, value, error } }) => {
    const { resolve, reject } = asked.get(id);
    asked.delete(id);
    if (error) reject(new Error(error));
    else resolve(value);
  });
  worker.addEventListener("error", ({ message }) => {
    for (const { reject } of asked.values()) reject(new Error(message || "the worker could not be started"));
    asked.clear();
  });
  await ask({ files: others });
  return (call, ...args) => ask({ call, args });
}

/** @param {string} packed */
export function unpacked(packed) {
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}
