// Starts Python with dofkit from one file, core.bin: compiled libraries, and last the packages. What of it has come is
// unpacked and compiled while Python starts.
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

/**
 * @param {(options: object) => Promise<any>} loadPyodide @param {Promise<ReadableStream<Uint8Array>>} coming core.bin
 * @param {object} options for loadPyodide
 */
export async function startPython(loadPyodide, coming, options) {
  const compiling = new Map();
  let packages;
  const unpacked = (async () => {
    for await (const { name, bytes } of parts(await coming)) {
      if (name.endsWith(".so")) compiling.set(name, WebAssembly.compile(bytes));
      else packages = bytes;
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
