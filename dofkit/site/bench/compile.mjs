// Compiles the Python files below a folder with the runtime's own Python, and packs each sub-folder into an archive.
// node compile.mjs STAGE OUT: STAGE/NAME/... becomes OUT/NAME.zip, in which bytecode with empty docstrings stands in place
// of sources; STAGE/library and STAGE/core, with compiled libraries, become OUT/core.bin, which start.js reads.
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import binaryen from "binaryen";
import { loadPyodide } from "pyodide";

/** What the compiled libraries use of WebAssembly. */
const { Features } = binaryen;
const FEATURES = Features.BulkMemory | Features.ExceptionHandling | Features.Multivalue | Features.MutableGlobals
  | Features.NontrappingFPToInt | Features.ReferenceTypes | Features.SignExt;
const [stage, out] = process.argv.slice(2);
trimLibraries(join(stage, "core"));
const python = await loadPyodide();
python.mountNodeFS("/stage", stage);
python.mountNodeFS("/out", out);
python.runPython(`
import ast, io, json, zipfile
from compression import zstd
from importlib import _bootstrap_external as files, util
from pathlib import Path

ALWAYS = (1980, 1, 1, 0, 0, 0)
DOCUMENTED = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


def bytecode(file, name):
    """Return the bytecode of a file, whose docstrings are emptied; not removed, since SymPy splits one."""
    source = file.read_bytes()
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, DOCUMENTED | ast.Module) and ast.get_docstring(node, clean=False) is not None:
            node.body[0].value = ast.copy_location(ast.Constant(""), node.body[0].value)
    return files._code_to_hash_pyc(compile(tree, f"/lib/{name}", "exec"), util.source_hash(source), checked=False)


def pack(folder, file, method):
    """Write all of a folder but its libraries into an archive."""
    with zipfile.ZipFile(file, "w", method, compresslevel=9) as archive:
        for path in sorted(path for path in folder.rglob("*") if path.is_file() and path.suffix not in (".so", ".wasm")):
            name = path.relative_to(folder)
            if path.suffix == ".py":
                entry, content = zipfile.ZipInfo(str(name.with_suffix(".pyc")), ALWAYS), bytecode(path, name)
            else:
                entry, content = zipfile.ZipInfo(str(name), ALWAYS), path.read_bytes()
            entry.compress_type = method
            archive.writestr(entry, content)


def stored(folder):
    """Return all of a folder but its libraries as an archive that is not compressed."""
    archive = io.BytesIO()
    pack(folder, archive, zipfile.ZIP_STORED)
    return archive.getvalue()


def write_core(library, folder, file):
    """Write the parts in the order in which they are used, each compressed by itself, after their names and sizes."""
    contents = {path.name: path.read_bytes() for path in library.glob("*.wasm")}
    contents["python_stdlib.zip"] = stored(library)
    libraries = sorted(folder.rglob("*.so"), key=lambda path: -path.stat().st_size)
    contents |= {str(path.relative_to(folder)): path.read_bytes() for path in libraries}
    contents["packages"] = stored(folder)
    options = {zstd.CompressionParameter.compression_level: 19, zstd.CompressionParameter.window_log: 25}
    packed = {name: zstd.compress(content, options=options) for name, content in contents.items()}
    table = [{"name": name, "packed": len(packed[name]), "size": len(contents[name])} for name in contents]
    head = json.dumps(table).encode()
    file.write_bytes(b"".join((len(head).to_bytes(4, "little"), head, *packed.values())))


stage, out = Path("/stage"), Path("/out")
write_core(stage / "library", stage / "core", out / "core.bin")
for folder in stage.iterdir():
    if folder.name not in ("library", "core"):
        pack(folder, out / f"{folder.name}.zip", zipfile.ZIP_DEFLATED)
`);

/**
 * Take from each shared library what none of the others imports, and what only that needs: whatever is exported gets a
 * place in a table when the library is loaded, which takes longer than all else.
 */
function trimLibraries(/** @type {string} */ folder) {
  const paths = readdirSync(folder, { recursive: true, encoding: "utf8" }).filter((path) => path.endsWith(".so"));
  const libraries = new Map(paths.map((path) => [join(folder, path), readFileSync(join(folder, path))]));
  const modules = [...libraries.values()].map((bytes) => new WebAssembly.Module(bytes));
  const imported = new Set(modules.flatMap((module) => WebAssembly.Module.imports(module).map(({ name }) => name)));
  const needed = (name) => imported.has(name) || /^(__wasm|PyInit_)/.test(name);
  [...libraries].forEach(([path, bytes], k) => {
    const unused = WebAssembly.Module.exports(modules[k]).filter(({ name }) => !needed(name));
    if (!unused.length) return;
    const trimmed = binaryen.readBinary(bytes);
    trimmed.setFeatures(FEATURES);
    for (const { name } of unused) trimmed.removeExport(name);
    trimmed.runPasses(["remove-unused-module-elements"]);
    writeFileSync(path, trimmed.emitBinary());
    trimmed.dispose();
  });
}
