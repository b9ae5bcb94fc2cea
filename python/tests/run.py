"""Runs the tests of the module that a build tree holds. Usage: run.py FOLDER_OF_THE_MODULE; 77: pytest is missing."""

import pathlib
import sys

sys.path.insert(0, sys.argv[1])
try:
    import pytest
except ImportError:
    print("skipped: pytest is missing, scripts/python-peers installs it")
    sys.exit(77)
sys.exit(
    pytest.main(
        [
            "-q",
            "-p",
            "no:cacheprovider",
            "--rootdir",
            str(pathlib.Path(__file__).parent),
            str(pathlib.Path(__file__).parent),
        ]
    )
)
