// Compiles the Python files below a folder with the runtime's own Python, and packs each sub-folder into an archive.
// node compile.mjs STAGE OUT: STAGE/NAME/... becomes OUT/NAME.zst, in which bytecode with empty docstrings stands in place
// of sources; STAGE/library and STAGE/core, with compiled libraries, become OUT/core.bin. start.js reads both.
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


def stored(folder):
    """Return all of a folder but its libraries as an archive that is not compressed."""
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as entries:
        for path in sorted(path for path in folder.rglob("*") if path.is_file() and path.suffix not in (".so", ".wasm")):
            name = path.relative_to(folder)
            if path.suffix == ".py":
                entries.writestr(zipfile.ZipInfo(str(name.with_suffix(".pyc")), ALWAYS), bytecode(path, name))
            else:
                entries.writestr(zipfile.ZipInfo(str(name), ALWAYS), path.read_bytes())
    return archive.getvalue()


def compressed(content, level):
    """Return a content compressed so far; the highest levels take a second for a megabyte."""
    options = {zstd.CompressionParameter.compression_level: level, zstd.CompressionParameter.window_log: 25}
    return zstd.compress(content, options=options)


def write_core(library, folder, file):
    """Write the parts in the order in which they are used, after a table of their sizes and of the files in each.

    The small libraries, which have much in common, are one part.
    """
    libraries = sorted(folder.rglob("*.so"), key=lambda path: -path.stat().st_size)
    contents = {str(path.relative_to(folder)): path.read_bytes() for path in libraries}
    large = [name for name, content in contents.items() if len(content) > 1_000_000]
    small = [name for name in contents if name not in large]
    contents |= {path.name: path.read_bytes() for path in library.glob("*.wasm")}
    contents |= {"python_stdlib.zip": stored(library), "packages": stored(folder)}
    parts = [["pyodide.asm.wasm"], ["python_stdlib.zip"], *([name] for name in large), small, ["packages"]]
    packed = [compressed(b"".join(contents[name] for name in names), 19) for names in parts]
    files = ([{"name": name, "size": len(contents[name])} for name in names] for names in parts)
    head = json.dumps([{"packed": len(part), "files": listed} for part, listed in zip(packed, files)]).encode()
    file.write_bytes(b"".join((len(head).to_bytes(4, "little"), head, *packed)))


stage, out = Path("/stage"), Path("/out")
write_core(stage / "library", stage / "core", out / "core.bin")
for folder in stage.iterdir():
    if folder.name not in ("library", "core"):
        (out / f"{folder.name}.zst").write_bytes(compressed(stored(folder), 12))
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
