// Compiles the Python files below a folder with the runtime's own Python, and packs each sub-folder into an archive.
// node compile.mjs STAGE OUT: STAGE/NAME/... becomes OUT/NAME.zip, in which bytecode without docstrings stands in place
// of sources; STAGE/core, with its compiled libraries, becomes OUT/core.bin, which start.js reads.
import { loadPyodide } from "pyodide";

const [stage, out] = process.argv.slice(2);
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
    """Return the bytecode of a file, without docstrings."""
    source = file.read_bytes()
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, DOCUMENTED | ast.Module) and ast.get_docstring(node, clean=False) is not None:
            node.body[:1] = [] if len(node.body) > 1 else [ast.copy_location(ast.Pass(), node.body[0])]
    return files._code_to_hash_pyc(compile(tree, f"/lib/{name}", "exec"), util.source_hash(source), checked=False)


def pack(folder, file, method):
    """Write all of a folder but its libraries into an archive."""
    with zipfile.ZipFile(file, "w", method, compresslevel=9) as archive:
        for path in sorted(path for path in folder.rglob("*") if path.is_file() and path.suffix != ".so"):
            name = path.relative_to(folder)
            if path.suffix == ".py":
                entry, content = zipfile.ZipInfo(str(name.with_suffix(".pyc")), ALWAYS), bytecode(path, name)
            else:
                entry, content = zipfile.ZipInfo(str(name), ALWAYS), path.read_bytes()
            entry.compress_type = method
            archive.writestr(entry, content)


def write_core(folder, file):
    """Write the parts, each compressed by itself, after their names and sizes in JSON."""
    libraries = sorted(folder.rglob("*.so"), key=lambda path: -path.stat().st_size)
    contents = {str(path.relative_to(folder)): path.read_bytes() for path in libraries}
    packages = io.BytesIO()
    pack(folder, packages, zipfile.ZIP_STORED)
    contents["packages"] = packages.getvalue()
    options = {zstd.CompressionParameter.compression_level: 19, zstd.CompressionParameter.window_log: 25}
    packed = {name: zstd.compress(content, options=options) for name, content in contents.items()}
    table = [{"name": name, "packed": len(packed[name]), "size": len(contents[name])} for name in contents]
    head = json.dumps(table).encode()
    file.write_bytes(b"".join((len(head).to_bytes(4, "little"), head, *packed.values())))


for folder in Path("/stage").iterdir():
    if folder.name == "core":
        write_core(folder, Path("/out/core.bin"))
    else:
        pack(folder, f"/out/{folder.name}.zip", zipfile.ZIP_DEFLATED)
`);
