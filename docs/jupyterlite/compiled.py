"""What Python compiled of the modules that are imported, as an archive that the browser keeps for the next time."""

import io
import sys
import zipfile
from pathlib import Path

MAGIC, HEADER = 4, 16
#: Instead of the time and the size of the source: nothing is compared, since packages are unpacked anew each time.
UNCHECKED = (1).to_bytes(4, "little") + bytes(8)


def gathered() -> bytes:
    """Return an archive of the compiled modules."""
    specs = [getattr(module, "__spec__", None) for module in list(sys.modules.values())]
    paths = sorted({path for spec in specs if (path := getattr(spec, "cached", None)) and Path(path).is_file()})
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as members:
        for path in paths:
            code = Path(path).read_bytes()
            members.writestr(path.lstrip("/"), code[:MAGIC] + UNCHECKED + code[HEADER:])
    return archive.getvalue()


def restored(archive: bytes, root: str = "/") -> None:
    """Unpack an archive of an earlier session."""
    with zipfile.ZipFile(io.BytesIO(archive)) as members:
        members.extractall(root)
