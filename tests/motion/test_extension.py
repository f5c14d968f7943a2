"""A single extension module of a library: loaded without the library's packages."""

from __future__ import annotations

import subprocess
import sys

import pytest

from morfax.motion.extension import extension, folder_of


def test_an_extension_is_loaded_once() -> None:
    assert extension("scipy", "optimize._minpack") is extension("scipy", "optimize._minpack")


def test_its_package_is_not_loaded() -> None:
    code = """if True:
        import sys
        from morfax.motion.extension import extension
        minpack = extension("scipy", "optimize._minpack")
        assert "scipy.optimize" not in sys.modules
        from scipy.optimize import _minpack
        assert _minpack is minpack
        """
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize("name", ["optimize._no_such", "no_such._minpack"])
def test_one_that_is_not_there_is_told(name: str) -> None:
    with pytest.raises(ImportError, match=name):
        extension("scipy", name)
    with pytest.raises(ImportError, match="no_such"):
        folder_of("no_such")
