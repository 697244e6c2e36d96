// Starts Python with dofkit from one file, core.bin: the runtime, the standard library, compiled libraries, and last the
// packages. What of it has come is unpacked and compiled while the rest comes.
import { decompress } from "fzstd";

/** Yield the parts of core.bin as they come. @param {ReadableStream<Uint8Array>} stream */
async function* parts(stream) {
  const take = reading(stream.getReader());
  const [length] = new Uint32Array((await take(4)).buffer);
  for (const { name, packed, size } of JSON.parse(new TextDecoder().decode(await take(length)))) {
    yield { name, bytes: decompress(await take(packed), new Uint8Array(size)) };
  }
}

/** A function that waits for so many bytes. @param {ReadableStreamDefaultReader<Uint8Array>} reader */
function reading(reader) {
  let [chunk, at] = [new Uint8Array(0), 0];
  return async (/** @type {number} */ count) => {
    const taken = new Uint8Array(count);
    for (let filled = 0; filled < count; ) {
      if (at === chunk.length) {
        const { value, done } = await reader.read();
        if (done) throw new Error("core.bin ends too early");
        [chunk, at] = [value, 0];
      }
      const part = chunk.subarray(at, at + count - filled);
      taken.set(part, filled);
      [filled, at] = [filled + part.length, at + part.length];
    }
    return taken;
  };
}

/** The files that loadPyodide asks for, and their types. */
const TYPES = { "pyodide.asm.wasm": "application/wasm", "python_stdlib.zip": "application/zip" };

/** Let loadPyodide have its files from core.bin. @returns {(name: string, bytes: Uint8Array) => void} what hands one over */
function handOver() {
  const { fetch } = globalThis;
  const handed = new Map(Object.keys(TYPES).map((name) => {
    let resolve;
    const promise = new Promise((done) => { resolve = done; });
    return [name, { promise, resolve }];
  }));
  globalThis.fetch = async (address, ...rest) => {
    const name = String(address.url ?? address).split("/").pop() ?? "";
    const file = handed.get(name);
    return file ? new Response(await file.promise, { headers: { "Content-Type": TYPES[name] } }) : fetch(address, ...rest);
  };
  return (name, bytes) => handed.get(name)?.resolve(bytes);
}

/**
 * @param {(options: object) => Promise<any>} loadPyodide @param {Promise<ReadableStream<Uint8Array>>} coming core.bin
 * @param {object} options for loadPyodide
 */
export async function startPython(loadPyodide, coming, options) {
  const compiling = new Map();
  const hand = handOver();
  let packages;
  const unpacked = (async () => {
    for await (const { name, bytes } of parts(await coming)) {
      if (name.endsWith(".so")) compiling.set(name, WebAssembly.compile(bytes));
      else if (name === "packages") packages = bytes;
      else hand(name, bytes);
    }
  })();
  const [python] = await Promise.all([loadPyodide(options), unpacked]);
  const site = python.runPython("import site; site.getsitepackages()[0]");
  python.unpackArchive(packages, "zip", { extractDir: site });
  const compiled = new Map();
  for (const [name, library] of compiling) {
    const path = `${site}/${name}`;
    python.FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    python.FS.writeFile(path, new Uint8Array(0));
    compiled.set(path, await library);
  }
  // what loads a library takes a compiled module as well as its bytes
  const { readFile } = python.FS;
  python.FS.readFile = (path, ...rest) => compiled.get(path) ?? readFile.call(python.FS, path, ...rest);
  return { python, site };
}
