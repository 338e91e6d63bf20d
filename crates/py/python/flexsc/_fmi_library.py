"""The library of FMUs, which is part of the package."""

import sys
from pathlib import Path

_NAMES = {"win32": "flexsc_fmi.dll", "darwin": "libflexsc_fmi.dylib"}


def fmi_library() -> Path:
    """Return the path of the archive of the library that every exported FMU contains."""
    return Path(__file__).with_name(f"{_NAMES.get(sys.platform, 'libflexsc_fmi.so')}.zip")
