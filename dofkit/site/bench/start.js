// Starts Python with dofkit from one file, core.bin: the runtime, the standard library, compiled libraries, and last the
// packages. With the first two Python starts while the rest comes.
import { decompress } from "fzstd";

/** @typedef {{files: {name: string, size: number}[], packed: Uint8Array<ArrayBuffer>}} Part */

/** Yield the parts of core.bin as they come. @param {ReadableStream<Uint8Array>} stream @returns {AsyncGenerator<Part>} */
async function* parts(stream) {
  const take = reading(stream.getReader());
  const [length] = new Uint32Array((await take(4)).buffer);
  for (const { packed, files } of JSON.parse(new TextDecoder().decode(await take(length)))) {
    yield { files, packed: await take(packed) };
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

/** What Python unpacks, ten times as fast as a script does: an archive beside its packages, or one content. */
const TOOLS = `
import io, site, zipfile
from compression import zstd

[folder, *_] = site.getsitepackages()


def unpack(packed):
    zipfile.ZipFile(io.BytesIO(zstd.decompress(packed.to_bytes()))).extractall(folder)


folder, unpack, lambda packed: zstd.decompress(packed.to_bytes())
`;

/**
 * @param {(options: object) => Promise<any>} loadPyodide @param {Promise<ReadableStream<Uint8Array>>} coming core.bin
 * @param {object} options for loadPyodide
 * @returns what runs Python, and what unpacks an archive of packages
 */
export async function startPython(loadPyodide, coming, options) {
  const hand = handOver();
  /** @type {Part[]} */
  const others = [];
  const arrived = (async () => {
    for await (const part of parts(await coming)) {
      const [{ name, size }] = part.files;
      if (name in TYPES) hand(name, decompress(part.packed, new Uint8Array(size)));
      else others.push(part);
    }
  })();
  const [python] = await Promise.all([loadPyodide(options), arrived]);
  const [site, unpack, decompressed] = python.runPython(TOOLS, { globals: python.toPy({}) });
  const compiling = new Map();
  for (const { files, packed } of others) {
    if (files[0].name === "packages") unpack(packed);
    else {
      const contents = decompressed(packed).toJs();
      let start = 0;
      for (const { name, size } of files) {
        compiling.set(`${site}/${name}`, WebAssembly.compile(contents.subarray(start, start + size)));
        start += size;
      }
    }
  }
  const compiled = new Map();
  for (const [path, library] of compiling) {
    python.FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    python.FS.writeFile(path, new Uint8Array(0));
    compiled.set(path, await library);
  }
  // what loads a library takes a compiled module as well as its bytes
  const { readFile } = python.FS;
  python.FS.readFile = (path, ...rest) => compiled.get(path) ?? readFile.call(python.FS, path, ...rest);
  return { python, unpack };
}

/** Import a module, and do not look for garbage meanwhile, nor later in what was imported: there is none. */
export function imported(python, /** @type {string} */ module) {
  const gc = python.pyimport("gc");
  gc.disable();
  const found = python.pyimport(module);
  gc.freeze();
  gc.enable();
  return found;
}
