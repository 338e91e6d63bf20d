"""The command `flexsc`: the engine's own, called from Python, and the tutorials."""

import os
import signal
import sys

from flexsc import _native
from flexsc._fmi_library import fmi_library


def main() -> int:
    """Run the command with the arguments of this process; its exit code is returned."""
    if sys.argv[1:2] == ["tutorials"]:
        from flexsc import _tutorials

        return _tutorials.main(sys.argv[2:])
    # Python's own handler would keep Ctrl-C to itself until the engine returns.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # `--scheduler` starts Python again.
    os.environ.setdefault("FLEXSC_PYTHON", sys.executable)
    # The engine looks beside the program, which is Python here.
    os.environ.setdefault("FLEXSC_FMI_LIBRARY", str(fmi_library()))
    return _native.main(["flexsc", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
