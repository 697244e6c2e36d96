// Compiles the Python files below a folder with the runtime's own Python, and packs each sub-folder into an archive.
// node compile.mjs STAGE OUT: STAGE/NAME/... becomes OUT/NAME.zip, in which bytecode stands in place of sources.
import { loadPyodide } from "pyodide";

const [stage, out] = process.argv.slice(2);
const python = await loadPyodide();
python.mountNodeFS("/stage", stage);
python.mountNodeFS("/out", out);
python.runPython(`
import py_compile, zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

UNCHECKED = py_compile.PycInvalidationMode.UNCHECKED_HASH
ALWAYS = (1980, 1, 1, 0, 0, 0)
for folder in sorted(Path("/stage").iterdir()):
    packed = zipfile.ZipFile(f"/out/{folder.name}.zip", "w", zipfile.ZIP_DEFLATED, compresslevel=9)
    with packed as archive, TemporaryDirectory() as scratch:
        for file in sorted(path for path in folder.rglob("*") if path.is_file()):
            name = file.relative_to(folder)
            if file.suffix == ".py":
                compiled = Path(scratch, "compiled.pyc")
                py_compile.compile(file, compiled, f"/lib/{name}", doraise=True, invalidation_mode=UNCHECKED)
                file, name = compiled, name.with_suffix(".pyc")
            entry = zipfile.ZipInfo(str(name), ALWAYS)
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, file.read_bytes())
`);
